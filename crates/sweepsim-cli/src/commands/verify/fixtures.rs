//! The fixtures of a job as dexels.

use crate::session::{Failure, JobSession};
use sweepsim_dexel::{Dexels, Grid, Operation, Stock};

/// The most lines of a grid of fixtures.
const MOST_LINES: f64 = 4e6;

/// Those of each set-up, for a stock on this grid.
pub(super) fn of_setups(session: &JobSession, stock: &Grid) -> Result<Vec<Option<Dexels>>, Failure> {
    let setups = session.job.setups.iter();
    setups.map(|setup| together(session, stock, &setup.fixtures)).collect()
}

/// Fixtures on a grid that holds all of them, with lines as far apart as the stock's.
fn together(session: &JobSession, stock: &Grid, fixtures: &[Stock]) -> Result<Option<Dexels>, Failure> {
    let frame = stock.frame();
    let corners = fixtures.iter().filter_map(|fixture| fixture.bounds());
    let corners = corners.flat_map(|[low, high]| {
        (0..8).map(move |n| frame.from_world([0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] })))
    });
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for corner in corners {
        for (range, c) in range.iter_mut().zip(corner) {
            *range = [range[0].min(c), range[1].max(c)];
        }
    }
    if range[0][0] > range[0][1] {
        return Ok(None);
    }
    let spacing = stock.spacing();
    let mut cells = [0, 1].map(|k| ((range[k][1] - range[k][0]) / spacing[k]).ceil().max(1.0));
    let too_many = (cells[0] * cells[1] / MOST_LINES).sqrt();
    if too_many > 1.0 {
        cells = cells.map(|n| (n / too_many).ceil());
    }
    let failed = |error: &dyn std::fmt::Display| session.failure(format!("fixtures: {error}"));
    let [min, max] = [0, 1].map(|end| [range[0][end], range[1][end]]);
    let grid = Grid::new(min, max, cells.map(|n| n as usize)).map_err(|error| failed(&error))?;
    let grid = grid.in_frame(*frame);
    let mut all = Dexels::empty(grid);
    for fixture in fixtures {
        let own = fixture.dexels(&grid).map_err(|error| failed(&error))?;
        all.combine(Operation::Union, &own).map_err(|error| failed(&error))?;
    }
    Ok(Some(all))
}
