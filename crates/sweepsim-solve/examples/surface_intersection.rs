//! Where do two bicubic patches meet? Three equations in the four parameters give one or more arcs, in both parameter
//! planes and in space.
//!
//! `cargo run -p sweepsim-solve --example surface_intersection`

use sweepsim_solve::{Bernstein, CurveSolver, Enclosure, Equation, System};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A wavy patch over the unit square, and one that stands across it.
    let form = |f: fn(f64, f64) -> f64| Bernstein::from_fn(&[3, 3], |i| f(i[0] as f64 / 3.0, i[1] as f64 / 3.0));
    let first = [
        form(|u, _| u)?,
        form(|_, v| v)?,
        form(|u, v| 0.8 * (u - 0.3) * (v - 0.6) + 0.4)?,
    ];
    let second = [
        form(|s, t| 0.3 + 0.4 * s + 0.2 * (t - 0.5) * (t - 0.5))?,
        form(|s, _| 0.1 + 0.8 * s)?,
        form(|_, t| t)?,
    ];
    // Variables u, v, s, t. The two sides depend on different ones, so each equation is a sum of two small forms.
    let equations = (0..3).map(|k| -> Result<Equation, Box<dyn std::error::Error>> {
        let own = first[k].extend(4, &[0, 1])?;
        let other = second[k].extend(4, &[2, 3])?.scale(-1.0).assumed_exact();
        Ok(Equation::sum(vec![own, other]))
    });
    let equations = equations.collect::<Result<Vec<_>, _>>()?;
    let system = System::new(&[Enclosure::UNIT; 4], equations)?;
    let curves = CurveSolver::new(1e-3).solve(&system, &())?;
    println!("{} arcs, {} loops", curves.arcs().count(), curves.loops().count());
    for curve in &curves.curves {
        for point in [&curve.points[0], &curve.points[curve.points.len() - 1]] {
            let place: Vec<f64> = first.iter().map(|c| c.evaluate(&point.point[..2])).collect();
            println!("  end at {place:.6?}, parameters {:.6?}", point.point);
        }
        for point in &curve.points {
            for k in 0..3 {
                let gap = first[k].evaluate(&point.point[..2]) - second[k].evaluate(&point.point[2..]);
                assert!(gap.abs() < 1e-13);
            }
        }
        println!("  {} vertices", curve.points.len());
    }
    assert!(curves.singular.is_empty());
    Ok(())
}
