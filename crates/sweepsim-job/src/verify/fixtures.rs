//! The fixtures of a job as dexels.

use crate::base::JobError;
use crate::session::Session;
use sweepsim_dexel::{Dexels, Grid, Operation, Stock, StockError};

/// The most lines of a grid of fixtures.
const MOST_LINES: f64 = 4e6;

/// A grid that holds fixtures, in the frame of the stock's and with lines as far apart; `None` if there are none.
pub(super) fn grid(session: Session, stock: &Grid, fixtures: &[Stock]) -> Result<Option<Grid>, JobError> {
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
    let [min, max] = [0, 1].map(|end| [range[0][end], range[1][end]]);
    let grid = Grid::new(min, max, cells.map(|n| n as usize));
    let grid = grid.map_err(|error| session.failure(format!("fixtures: {error}")))?;
    Ok(Some(grid.in_frame(*frame)))
}

/// Fixtures on such a grid, or a tile of it.
pub(super) fn on(grid: &Grid, fixtures: &[Stock]) -> Result<Dexels, StockError> {
    let mut all = Dexels::empty(*grid);
    for fixture in fixtures {
        all.combine(Operation::Union, &fixture.dexels(grid)?)?;
    }
    Ok(all)
}
