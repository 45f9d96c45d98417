//! What is on both sides of where a tool was cut into convex solids.

use super::convex::{Convex, Piece};
use super::level::Level;

/// A cylinder is narrower than the tool at the cut by this part, so that rounding does not decide.
const NARROWER: f64 = 1e-9;
/// It leads into a solid by its height, or half, a quarter, and so on: as many are tried.
const STEPS: i32 = 16;

/// Cylinders from one of the solids that cover a tool into the next, where both are parts of it: what is partly in one
/// and partly in the other may be in such a cylinder, which is convex.
pub(crate) fn bridges(solids: &[Convex]) -> Vec<Convex> {
    solids
        .windows(2)
        .filter_map(|pair| bridge(&pair[0], &pair[1]))
        .collect()
}

fn bridge(below: &Convex, above: &Convex) -> Option<Convex> {
    let [rho, seam] = above.pieces.first().map(start)?;
    let radius = rho * (1.0 - NARROWER);
    let [bottom, top] = [below.heights()[0], above.heights()[1]];
    let end = |solid: &Convex, far: f64| {
        let level = Level::new(solid);
        let holds = |z: &f64| solid.exact && level.at([radius, *z]) <= 0.0;
        let mut ends = (0..STEPS).map(|k| seam + (far - seam) * 0.5_f64.powi(k));
        holds(&seam).then(|| ends.find(holds)).flatten()
    };
    let (low, high) = (end(below, bottom)?, end(above, top)?);
    Some(Convex {
        corners: vec![[0.0, low], [radius, low], [radius, high], [0.0, high]],
        exact: true,
        ..Convex::default()
    })
}

fn start(piece: &Piece) -> [f64; 2] {
    match piece {
        Piece::Line([from, _]) => *from,
        Piece::Arc { centre, radius, angles } => {
            let (sine, cosine) = angles[0].sin_cos();
            [centre[0] + radius * cosine, centre[1] + radius * sine]
        }
        Piece::Points(points) => points[0],
    }
}
