//! The silhouette of a patch `z = h(x, y)` seen from a direction: where its normal is perpendicular to that direction,
//! one equation in the plane.
//!
//! `cargo run -p sweepsim-solve --example silhouette > silhouette.svg`

use sweepsim_solve::{Bernstein, CurveSolver, Enclosure, Picture, System};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // An egg box of degree (5, 5).
    let bump = |i: usize| [0.0, 1.0, -1.4, 1.3, -1.0, 0.2][i];
    let height = Bernstein::from_fn(&[5, 5], |i| bump(i[0]) * bump(i[1]) + 0.1 * bump(i[0]))?;
    // The normal is (−h_x, −h_y, 1); seen along (a, b, c) the silhouette is where c = a h_x + b h_y.
    let (a, b, c) = (1.0, 0.4, 0.2);
    let slopes = height.derivative(0).scale(a).add(&height.derivative(1).scale(b));
    let across = slopes.sub(&Bernstein::constant(2, c));
    let system = System::new(&[Enclosure::UNIT; 2], [across])?;
    let mut picture = Picture::new([0, 1]);
    let curves = CurveSolver::new(1e-4).solve(&system, &picture)?;
    eprintln!("{} loops, {} arcs", curves.loops().count(), curves.arcs().count());
    for curve in &curves.curves {
        let closing = curve.points.first().filter(|_| curve.ends.is_none());
        picture.line(curve.points.iter().chain(closing).map(|p| p.point.as_slice()));
    }
    assert!(!curves.curves.is_empty() && curves.singular.is_empty());
    print!("{}", picture.svg(800.0));
    Ok(())
}
