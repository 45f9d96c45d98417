//! A tool from user-defined B-spline patches: a cutter with a rounded square section, rotated by a quarter turn along
//! its path.

use sweepsim::dexel::Grid;
use sweepsim::motion::{Path, Pose, Tool};
use sweepsim::spline::{KnotVector, RationalSpline};
use sweepsim::{Options, sweep};

/// A B-spline surface of degrees 3 around and 1 up, closed around, from rings of control points.
fn surface(rings: [Vec<[f64; 3]>; 2]) -> Result<RationalSpline, Box<dyn std::error::Error>> {
    let around = rings[0].len();
    // Clamped uniform knots: as many pieces as there are points less the degree.
    let inner = (1..around - 3).map(|k| k as f64 / (around - 3) as f64);
    let mut knots = vec![0.0; 4];
    knots.extend(inner);
    knots.extend([1.0; 4]);
    let bases = vec![
        KnotVector::new(3, knots)?,
        KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0])?,
    ];
    let points: Vec<f64> = rings.iter().flatten().flatten().copied().collect();
    Ok(RationalSpline::new(bases, 3, &points, &vec![1.0; 2 * around])?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A closed ring through a rounded square: it begins and ends in the middle of a side.
    let ring = |radius: f64, z: f64| -> Vec<[f64; 3]> {
        let corners = [
            [1.0, 0.0],
            [1.0, 0.5],
            [1.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, -0.5],
            [1.0, 0.0],
        ];
        corners.iter().map(|[x, y]| [radius * x, radius * y, z]).collect()
    };
    let wall = surface([ring(2.0, 0.0), ring(2.0, 12.0)])?;
    let bottom = surface([ring(0.0, 0.0), ring(2.0, 0.0)])?;
    let top = surface([ring(2.0, 12.0), ring(0.0, 12.0)])?;
    let tool = Tool::from_surfaces(&[wall, bottom, top], 1e-9)?;
    println!("{} patches, {} sharp edges", tool.patches().len(), tool.edges().len());

    // Poses with a side say how a tool without symmetry turns about its axis.
    let up = [0.0, 0.0, 1.0];
    let path = Path::new(vec![
        Pose::with_side([-6.0, 0.0, 0.0], up, [1.0, 0.0, 0.0])?,
        Pose::with_side([6.0, 0.0, 0.0], up, [0.0, 1.0, 0.0])?,
    ])?;
    let grid = Grid::new([-10.0, -5.0], [10.0, 5.0], [200, 100])?;
    let swept = sweep(&tool, &path, &grid, &Options::new(1e-6), &())?;
    println!(
        "swept {:.2} mm³, {} unresolved",
        swept.volume.volume(),
        swept.statistics.unresolved.len()
    );
    Ok(())
}
