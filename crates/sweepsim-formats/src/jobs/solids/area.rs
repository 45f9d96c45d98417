//! The grid of a job, which covers the stock unless the job says otherwise.

use sweepsim_dexel::{Grid, Stock};

use crate::error::{FormatError, Problem};
use crate::jobs::place::Step;
use crate::jobs::read::JobReader;
use crate::jobs::schema;
use crate::jobs::setups::has_dexels;

/// The default number of dexels along the longer side.
const CELLS: f64 = 300.0;

/// Lower and upper corner of a solid.
type Bounds = [[f64; 3]; 2];

impl JobReader<'_> {
    /// The grid and the stock.
    pub(crate) fn grid_and_stock(&self, raw: &schema::Job) -> Result<(Grid, Stock), FormatError> {
        let given = raw.grid.as_ref();
        if let Some(schema::Grid {
            min: Some(min),
            max: Some(max),
            ..
        }) = given
        {
            let grid = self.grid(given.unwrap_or(&schema::Grid::default()), *min, *max)?;
            let stock = self.stock(&raw.stock, &["stock".into()], &grid)?;
            return Ok((grid, stock));
        }
        if let Some(grid) = given {
            let odd = grid.min.is_some() || grid.max.is_some();
            if odd || grid.frame.is_some() {
                let field = if odd { "min" } else { "frame" };
                let problem = Problem::syntax(
                    "a grid with only one corner, or with a frame but no corners: expected `min` and `max`",
                );
                return Err(self.error(problem, &["grid".into(), field.into()]));
            }
        }
        if has_dexels(&raw.stock) {
            let problem =
                Problem::syntax("stock from dexels without the corners of the grid: expected those of its file");
            return Err(self.error(problem, &["stock".into()]));
        }
        // Only stock from dexels depends on the grid.
        let any = Grid::new([0.0; 2], [1.0; 2], [1, 1])
            .map_err(|error| self.error(Problem::Grid(error), &["stock".into()]))?;
        let stock = self.stock(&raw.stock, &["stock".into()], &any)?;
        let Some([low, high]) = bounds(&stock).filter(|[low, high]| (0..2).all(|k| low[k] < high[k])) else {
            let problem =
                Problem::syntax("the stock is empty: expected one with a volume, or a grid with `min` and `max`");
            return Err(self.error(problem, &["stock".into()]));
        };
        let in_units = |corner: [f64; 3]| [corner[0] / self.unit, corner[1] / self.unit];
        let grid = self.grid(given.unwrap_or(&schema::Grid::default()), in_units(low), in_units(high))?;
        Ok((grid, stock))
    }

    fn grid(&self, raw: &schema::Grid, min: [f64; 2], max: [f64; 2]) -> Result<Grid, FormatError> {
        let scale = |corner: [f64; 2]| corner.map(|c| c * self.unit);
        let size = [max[0] - min[0], max[1] - min[1]];
        let given = match (raw.cells, raw.cell) {
            (Some(_), Some(_)) => {
                let problem = Problem::syntax("both `cells` and `cell` in one grid: expected one of them");
                return Err(self.error(problem, &["grid".into(), "cell".into()]));
            }
            (Some(cells), None) => cells,
            (None, cell) => {
                if let Some(cell) = cell {
                    self.check(
                        "cell",
                        cell,
                        cell > 0.0,
                        "a positive length",
                        &["grid".into(), "cell".into()],
                    )?;
                }
                let cell = cell.unwrap_or(size[0].max(size[1]) / CELLS);
                // Too many cells are reported by the grid.
                size.map(|side| (side / cell).round().clamp(1.0, 1e9) as i64)
            }
        };
        let mut cells = [0; 2];
        for (k, cell) in cells.iter_mut().enumerate() {
            *cell = usize::try_from(given[k]).ok().filter(|&n| n > 0).ok_or_else(|| {
                let problem = Problem::value("a number of cells", given[k], "a positive whole number");
                self.error(problem, &["grid".into(), "cells".into(), Step::Item(k)])
            })?;
        }
        for (name, corner) in [("min", min), ("max", max)] {
            for (k, value) in corner.into_iter().enumerate() {
                let steps = ["grid".into(), name.into(), Step::Item(k)];
                self.check("a corner of the grid", value, true, "finite", &steps)?;
            }
        }
        let grid = Grid::new(scale(min), scale(max), cells).map_err(|error| {
            let ordered = (0..2).all(|k| min[k] < max[k]);
            let field = if ordered { "cells" } else { "min" };
            self.error(Problem::Grid(error), &["grid".into(), field.into()])
        })?;
        Ok(grid.in_frame(self.frame(raw.frame.as_ref(), &["grid".into()])?))
    }
}

/// A box around a solid, if it is not empty.
fn bounds(stock: &Stock) -> Option<Bounds> {
    match stock {
        Stock::Block { min, max } => Some([*min, *max]),
        Stock::Cylinder {
            base,
            axis,
            radius,
            height,
        } => {
            let length = axis[0].hypot(axis[1]).hypot(axis[2]);
            let axis = axis.map(|c| c / length);
            let side = |k: usize| radius * (1.0 - axis[k] * axis[k]).max(0.0).sqrt();
            let end = [0, 1, 2].map(|k| base[k] + height * axis[k]);
            Some([
                [0, 1, 2].map(|k| base[k].min(end[k]) - side(k)),
                [0, 1, 2].map(|k| base[k].max(end[k]) + side(k)),
            ])
        }
        Stock::Ball { centre, radius } => Some([centre.map(|c| c - radius), centre.map(|c| c + radius)]),
        Stock::Mesh(soup) => {
            let corners = soup.triangles.iter().flatten().copied();
            corners.map(|corner| [corner, corner]).reduce(around)
        }
        Stock::Union(parts) => parts.iter().filter_map(bounds).reduce(around),
        Stock::Intersection(parts) => parts.first().and_then(bounds),
        Stock::Difference(whole, _) => bounds(whole),
        _ => None,
    }
}

fn around([a, b]: Bounds, [c, d]: Bounds) -> Bounds {
    [
        [0, 1, 2].map(|k| f64::min(a[k], c[k])),
        [0, 1, 2].map(|k| f64::max(b[k], d[k])),
    ]
}
