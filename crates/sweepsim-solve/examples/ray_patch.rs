//! Where does a ray meet a bicubic patch? Two planes through the ray make two equations in the patch's two parameters.
//!
//! `cargo run -p sweepsim-solve --example ray_patch`

use sweepsim_solve::{Interval, PointSolver, System};
use sweepsim_spline::Bernstein;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A wavy patch over the unit square.
    let coordinate = |f: fn(f64, f64) -> f64| Bernstein::from_fn(&[3, 3], |i| f(i[0] as f64 / 3.0, i[1] as f64 / 3.0));
    let patch = [
        coordinate(|u, _| u)?,
        coordinate(|_, v| v)?,
        coordinate(|u, v| 4.0 * (u - 0.5) * (u - 0.2) * (u - 0.9) * 6.0 + 0.3 * v)?,
    ];
    // The ray (0, 0.4, 0.1) + s (1, 0.1, 0.05), as two planes: n · (p − origin) = 0.
    let origin = [0.0, 0.4, 0.1];
    let normals = [[-0.1, 1.0, 0.0], [-0.05, 0.0, 1.0]];
    let planes = normals.map(|n| {
        (0..3).fold(Bernstein::constant(2, 0.0), |sum, k| {
            let part = patch[k].sub(&Bernstein::constant(2, origin[k])).scale(n[k]);
            sum.add(&part)
        })
    });
    let system = System::new(&[Interval::new(0.0, 1.0); 2], &planes)?;
    let points = PointSolver::default().solve(&system, &mut ())?;
    for root in &points.roots {
        let hit: Vec<f64> = patch.iter().map(|c| c.evaluate(&root.point)).collect();
        println!(
            "(u, v) = {:?} at {hit:?}, crossing {}",
            root.point,
            if root.orientation > 0 { "out" } else { "in" }
        );
    }
    assert!(points.unresolved.is_empty());
    Ok(())
}
