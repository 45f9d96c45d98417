//! Where the paper's boundary operator errs: dexels of one row as an SVG drawing, `cargo run -p sweepsim --example
//! boundary_operators > operators.svg`.
//!
//! A cutter with three fins tilts as it moves. What the count gives is blue; what the paper's Algorithm 2 takes for
//! gaps in it, red.

use std::fmt::Write as _;
use sweepsim::dexel::Grid;
use sweepsim::motion::{Path, Pose, Profile, ProfileSegment, Tool};
use sweepsim::{BoundaryOperator, Options, sweep};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let line = |rho: f64, zeta: f64| ProfileSegment::Line { to: [rho, zeta] };
    let mut outline = vec![line(2.0, 0.0)];
    for fin in 0..3 {
        let foot = 1.6 * f64::from(fin);
        outline.extend([
            line(2.0, foot + 0.6),
            line(0.5, foot + 0.6),
            line(0.5, foot + 1.6),
            line(2.0, foot + 1.6),
        ]);
    }
    outline.extend([line(2.0, 5.4), line(0.0, 5.4)]);
    let tool = Tool::from_profile(Profile::new([0.0, 0.0], outline)?);
    let path = Path::new(vec![
        Pose::new([0.0, 0.0, 3.0], [1.2, 0.0, 1.0])?,
        Pose::new([1.5, 0.2, -1.0], [0.06, 0.17, 1.0])?,
    ])?;
    let (min, max) = ([-3.0, -0.1], [7.0, 0.1]);
    let grid = Grid::new(min, max, [160, 1])?;
    let run = |boundary| sweep(&tool, &path, &grid, &Options::new(1e-6).boundary(boundary), &());
    let (counted, paper) = (
        run(BoundaryOperator::Coverage)?.volume,
        run(BoundaryOperator::Paper)?.volume,
    );
    let scale = 80.0;
    let (mut blue, mut red) = (String::new(), String::new());
    for i in 0..160 {
        let x = scale * (grid.x(i) - min[0]);
        let place = |z: f64| scale * (8.0 - z);
        for interval in counted.intervals(i, 0) {
            write!(
                blue,
                "M{x:.1} {:.1}V{:.1}",
                place(interval.lower.z),
                place(interval.upper.z)
            )?;
            // What of it the paper's intervals leave out.
            let mut from = interval.lower.z;
            for part in paper.intervals(i, 0) {
                if part.lower.z > from + 1e-5 && part.lower.z < interval.upper.z {
                    write!(red, "M{x:.1} {:.1}V{:.1}", place(from), place(part.lower.z))?;
                }
                from = from.max(part.upper.z);
            }
            if from < interval.upper.z - 1e-5 {
                write!(red, "M{x:.1} {:.1}V{:.1}", place(from), place(interval.upper.z))?;
            }
        }
    }
    println!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 720\"><rect width=\"800\" height=\"720\" fill=\"#fbfaf7\"/>"
    );
    println!(
        "<path d=\"{blue}\" stroke=\"#7fa8c4\" stroke-width=\"3.2\"/><path d=\"{red}\" stroke=\"#b3402f\" stroke-width=\"3.2\"/></svg>"
    );
    Ok(())
}
