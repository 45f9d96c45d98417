//! A plane curve with two ovals and its subdivision, as SVG on the standard output.
//!
//! `cargo run -p sweepsim-solve --example curve_picture > curve.svg`

use sweepsim_solve::{Bernstein, CurveSolver, Enclosure, Picture, System};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let x = |axis| {
        Bernstein::variable(2, axis)
            .scale(4.0)
            .sub(&Bernstein::constant(2, 2.0))
    };
    let constant = |value| Bernstein::constant(2, value);
    // Cassini: ((x − 1)² + y²) ((x + 1)² + y²) = b⁴, here with b a little below 1: two ovals.
    let around = |centre: f64| {
        let shifted = x(0).sub(&constant(centre));
        shifted.mul(&shifted).add(&x(1).mul(&x(1)))
    };
    let cassini = around(1.0).mul(&around(-1.0)).sub(&constant(0.97));
    let system = System::mapped(&[Enclosure::new(-2.0, 2.0).unwrap(); 2], [&cassini])?;
    let mut picture = Picture::new([0, 1]);
    let curves = CurveSolver::new(1e-3).solve(&system, &picture)?;
    eprintln!(
        "{} loops, {} arcs, {:?}",
        curves.loops().count(),
        curves.arcs().count(),
        curves.statistics
    );
    for curve in &curves.curves {
        let closing = curve.points.first().filter(|_| curve.ends.is_none());
        picture.line(curve.points.iter().chain(closing).map(|p| p.point.as_slice()));
    }
    print!("{}", picture.svg(800.0));
    Ok(())
}
