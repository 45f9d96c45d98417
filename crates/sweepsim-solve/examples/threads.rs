//! How much faster curves and surfaces are on two threads than on one:
//!
//! `cargo run --release -p sweepsim-solve --features rayon --example threads -- 3`
//!
//! In time on a processor, as Linux counts it for each thread, so that other work on the machine does not count: that
//! of one thread alone, and of the busier one of two, which is how long the work takes if neither waits for a
//! processor.

use sweepsim_solve::{CurveSolver, Enclosure, SurfaceSolver, System};

/// A named piece of work, and how large its result is.
type Work<'a> = (
    &'a str,
    Box<dyn Fn() -> Result<usize, sweepsim_solve::SolveError> + Send + Sync + 'a>,
);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let runs: usize = std::env::args().nth(1).map_or(Ok(5), |t| t.parse())?;
    let side = |reach: f64| Enclosure::new(-reach, reach + 0.01);
    // A level set with many loops, an intersection of two surfaces, a curve with functions, and two surfaces.
    let product = "(x^2 + y^2 - 1)*((x - 1)^2 + y^2 - 2)*(x^2 + (y + 1)^2 - 3)*(x*y - 1/3) = 1/50";
    let plane = System::parse(&[product], &["x", "y"], &[side(3.0)?; 2])?;
    let names = ["x", "y", "z"];
    let torus = "(x^2 + y^2 + z^2 + 3)^2 = 16*(x^2 + y^2)";
    let space = System::parse(&[torus, "x^4 + y^4 + z^4 = 12*x*y*z + 2"], &names, &[side(3.5)?; 3])?;
    let waves = System::parse(&["sin(3*x)*cos(2*y) + sin(x*y) = 1/5"], &["x", "y"], &[side(4.0)?; 2])?;
    let ring = System::parse(&[torus], &names, &[side(3.5)?; 3])?;
    let quartic = "x^4 + y^4 + z^4 - 5*(x^2 + y^2 + z^2) + 11.8 = 0";
    let tangle = System::parse(&[quartic], &names, &[side(3.0)?; 3])?;
    let curve = |system, tolerance: f64| {
        move || {
            let curves = CurveSolver::new(tolerance).solve_parallel(system, &())?;
            Ok(curves.curves.iter().map(|c| c.points.len()).sum())
        }
    };
    let surface = |system, tolerance: f64| {
        move || {
            let surface = SurfaceSolver::new(tolerance).solve_parallel(system, &())?;
            Ok(surface.triangles.len())
        }
    };
    let all: [Work<'_>; 5] = [
        ("level set, chords of 1e-7", Box::new(curve(&plane, 1e-7))),
        ("intersection, chords of 1e-7", Box::new(curve(&space, 1e-7))),
        ("functions, chords of 1e-6", Box::new(curve(&waves, 1e-6))),
        ("torus, mesh of 2e-3", Box::new(surface(&ring, 2e-3))),
        ("tangle cube, mesh of 2e-3", Box::new(surface(&tangle, 2e-3))),
    ];
    println!(
        "{:<30} {:>9} {:>8} {:>8} {:>7}",
        "work", "vertices", "1: ms", "2: ms", "ratio"
    );
    for (name, work) in &all {
        let mut best = [f64::INFINITY; 2];
        let mut size = 0;
        for _ in 0..runs {
            for (threads, best) in (1..).zip(&mut best) {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
                // A first task starts the threads.
                pool.broadcast(|_| ());
                let before = pool.broadcast(|_| on_processor());
                size = pool.install(work)?;
                let after = pool.broadcast(|_| on_processor());
                let busiest = before.iter().zip(&after).map(|(b, a)| a - b).fold(0.0, f64::max);
                *best = best.min(busiest);
            }
        }
        let [one, two] = best;
        println!("{name:<30} {size:>9} {one:>8.0} {two:>8.0} {:>7.2}", one / two);
    }
    Ok(())
}

/// This thread's time on a processor, in milliseconds; 0 where the system does not tell.
fn on_processor() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split_whitespace().next().and_then(|n| n.parse::<f64>().ok());
    nanoseconds.unwrap_or(0.0) * 1e-6
}
