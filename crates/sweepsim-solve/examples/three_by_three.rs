//! All roots of three equations in three unknowns: where three quadrics meet. Also shows what multiple roots look like.
//!
//! `cargo run -p sweepsim-solve --example three_by_three`

use sweepsim_solve::{Bernstein, Enclosure, PointSolver, System};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bounds = [Enclosure::new(-2.0, 2.0).unwrap(); 3];
    // x = −2 + 4 u on the domain.
    let x = |axis| {
        Bernstein::variable(3, axis)
            .scale(4.0)
            .sub(&Bernstein::constant(3, 2.0))
    };
    let constant = |value| Bernstein::constant(3, value);
    let square = |axis: usize| x(axis).mul(&x(axis));
    let sphere = square(0).add(&square(1)).add(&square(2)).sub(&constant(1.0));
    let cylinder = square(0).add(&square(1)).sub(&x(0));
    let mut solver = PointSolver::default();
    for height in [0.3, 0.0] {
        // z = height: at 0 the plane touches the window of Viviani where it crosses itself.
        let plane = x(2).sub(&constant(height));
        let system = System::mapped(&bounds, [&sphere, &cylinder, &plane])?;
        let points = solver.solve(&system, &())?;
        println!("z = {height}: {} certified roots", points.roots.len());
        for root in &points.roots {
            println!("  {:?} ± {:.1e}", root.point, root.enclosure[0].radius());
        }
        for open in &points.unresolved {
            println!(
                "  open near {:?}: {}",
                open.bounds.iter().map(|b| b.mid()).collect::<Vec<_>>(),
                open.cause
            );
        }
    }
    Ok(())
}
