//! Where does a ray meet a bicubic B-spline patch? Two planes through the ray make two equations in the patch's two
//! parameters.
//!
//! `cargo run -p sweepsim-solve --example ray_patch`

use sweepsim_solve::{BSpline, KnotVector, Pieces, PointSolver};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A wavy patch over the unit square: 7 × 7 control points, 4 × 4 polynomial pieces.
    let knots = [
        KnotVector::uniform(3, 4, 0.0, 1.0)?,
        KnotVector::uniform(3, 4, 0.0, 1.0)?,
    ];
    let control: Vec<[f64; 3]> = knots[1]
        .greville()
        .iter()
        .flat_map(|v| {
            let row = |u: &f64| [*u, *v, 0.4 * (9.0 * u).sin() + 0.3 * v];
            knots[0].greville().iter().map(row).collect::<Vec<_>>()
        })
        .collect();
    let patch = BSpline::new(knots.to_vec(), 3, control.as_flattened().to_vec())?;
    let spline = |values: Vec<f64>| BSpline::new(knots.to_vec(), 1, values);
    // The ray (0, 0.4, 0.1) + s (1, 0.1, 0.05), as two planes: n · (p − origin) = 0. A plane's equation is a spline
    // whose coefficients are the control points' values.
    let origin = [0.0, 0.4, 0.1];
    let normals = [[-0.1, 1.0, 0.0], [-0.05, 0.0, 1.0]];
    let planes = normals.map(|n| {
        let value = |p: &[f64; 3]| (0..3).map(|k| n[k] * (p[k] - origin[k])).sum();
        spline(control.iter().map(value).collect())
    });
    let [first, second] = planes;
    let points = PointSolver::default().solve_pieces(&Pieces::new(&[first?, second?])?, &())?;
    for root in &points.roots {
        println!(
            "(u, v) = {:?} at {:?}, crossing {}",
            root.point,
            patch.evaluate(&root.point),
            if root.orientation > 0 { "out" } else { "in" }
        );
    }
    assert!(!points.roots.is_empty() && points.unresolved.is_empty());
    Ok(())
}
