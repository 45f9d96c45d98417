//! Cuts in tri-dexels: for walls of any direction, the lines of one set meet them at a steep angle.

use super::simulate::{Cut, Simulation, simulate};
use crate::error::SweepError;
use crate::sweep::options::Options;
use crate::sweep::report::Statistics;
use sweepsim_dexel::{Dexels, TriDexels};
use sweepsim_solve::Monitor;

/// The remaining stock, along all three axes.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TriSimulation {
    /// The remaining material.
    pub remaining: TriDexels,
    /// Statistics along `x`, `y` and `z`.
    pub statistics: [Statistics; 3],
}

/// Monitors one of three passes over all moves.
struct Pass<'a> {
    monitor: &'a dyn Monitor,
    number: usize,
}

impl Monitor for Pass<'_> {
    fn advance(&self, done: usize, total: usize) {
        self.monitor.advance(self.number * total + done, 3 * total);
    }

    fn cancelled(&self) -> bool {
        self.monitor.cancelled()
    }
}

/// Removes the volumes that the cuts sweep from `stock`, as [`simulate`](fn@simulate) does, on the lines along each axis.
///
/// # Errors
/// Those of [`sweep`](crate::sweep).
///
/// ```
/// use sweepsim::{Cut, Options, simulate_tri};
/// use sweepsim_dexel::{Stock, TriDexels};
/// use sweepsim_motion::{Path, Pose, Tool};
///
/// let (min, max) = ([0.1, 0.1, -0.3], [19.9, 9.9, 5.3]);
/// let block = Stock::Block { min: [1.0, 1.0, 0.0], max: [19.0, 9.0, 5.0] };
/// let stock = TriDexels::new(min, max, [99, 49, 28], &block)?;
/// let tool = Tool::flat(2.0, 20.0)?;
/// let up = [0.0, 0.0, 1.0];
/// let path = Path::new(vec![Pose::new([-5.0, 5.0, 3.0], up)?, Pose::new([25.0, 5.0, 3.0], up)?])?;
/// let part = simulate_tri(stock, &[Cut::new(&tool, &path)], &Options::default(), &())?.remaining;
/// // A groove 4 wide and 2 deep, whose walls and edges do not snap to the nearest line.
/// let mesh = part.surface()?;
/// let volume = mesh.soup().ok_or("no mesh")?.volume();
/// assert!((volume - 18.0 * (8.0 * 5.0 - 4.0 * 2.0)).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate_tri(
    stock: TriDexels,
    cuts: &[Cut],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<TriSimulation, SweepError> {
    let pass = |(number, set): (usize, Dexels)| simulate(set, cuts, options, &Pass { monitor, number });
    let mut done = Vec::with_capacity(3);
    for set in stock.into_sets().into_iter().enumerate() {
        done.push(pass(set)?);
    }
    let [x, y, z] = <[Simulation; 3]>::try_from(done).expect("three passes");
    let statistics = [x.statistics, y.statistics, z.statistics];
    let remaining =
        TriDexels::from_sets([x.remaining, y.remaining, z.remaining]).expect("their grids are those of the stock");
    Ok(TriSimulation { remaining, statistics })
}
