//! Sweeps a ball end along an arc while its axis turns, and weighs what it cuts out of a block.

use sweepsim::dexel::{Grid, Stock};
use sweepsim::motion::{Move, Path, Pose, TipArc, Tool};
use sweepsim::{Cut, Options, simulate, sweep};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let tool = Tool::ball(3.0, 30.0)?;
    // Three quarters of a circle of radius 12 about the origin, and 2 mm down on the way.
    let (from, to) = ([12.0, 0.0, 1.0], [0.0, -12.0, -1.0]);
    let arc = TipArc::between(from, to, [0.0; 3], [0.0, 0.0, 1.0], 1)?;
    let poses = vec![Pose::new(from, [0.3, 0.0, 1.0])?, Pose::new(to, [0.0, -0.2, 1.0])?];
    let path = Path::with_moves(poses, vec![Move::arc(arc)])?;

    let grid = Grid::new([-20.0, -20.0], [20.0, 20.0], [400, 400])?;
    let swept = sweep(&tool, &path, &grid, &Options::new(1e-6), &())?;
    println!(
        "swept {:.1} mm³ on {} dexels: {} crossings, {} unresolved",
        swept.volume.volume(),
        swept.statistics.covered,
        swept.statistics.crossings,
        swept.statistics.unresolved.len()
    );

    let block = Stock::Block {
        min: [-18.0, -18.0, -6.0],
        max: [18.0, 18.0, 4.0],
    };
    let stock = block.dexels(&grid)?;
    let before = stock.volume();
    let cut = Cut::new(&tool, &path);
    let part = simulate(stock, &[cut], &Options::new(1e-6), &())?;
    println!("cut {:.1} mm³ out of the block", before - part.remaining.volume());
    Ok(())
}
