//! The field's method: the tool at many places, subtracted from columns of material one place after the other.

use super::cutter::{Cutter, Place};
use super::hull::Hull;
use smallvec::SmallVec;
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::{Path, Segment};

/// How the time between two places is bridged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bridge {
    /// Not at all: the union of the placed tools.
    Union,
    /// By the convex hull of both.
    Hulls,
}

/// A move's part, with the times at which the tool is placed.
pub struct Sampled {
    segment: Segment,
    /// Number of equal steps.
    pub steps: usize,
}

impl Sampled {
    /// The parts of a path, each with so many steps that no point of the axis up to `height` moves farther than
    /// `spacing` in one.
    pub fn path(path: &Path, cutter: &Cutter, height: f64, spacing: f64) -> Vec<Self> {
        let segments = (0..path.moves()).flat_map(|number| path.segments(number, cutter.length, 1e-7));
        let mut before: Option<Segment> = None;
        segments
            .map(|segment| {
                // A tool that is not quite of revolution does not spin from one move to the next.
                let segment = before
                    .as_ref()
                    .map_or_else(|| segment.clone(), |before| segment.clone().after(before));
                before = Some(segment.clone());
                let [from, to] = [0.0, 1.0].map(|t| place(&segment, t));
                // A turn of at most 90° per segment: the chord is at least 0.9 of the way.
                let ways = [0.0, height].map(|h| (to.point(h) - from.point(h)).norm());
                let steps = (ways[0].max(ways[1]) / spacing).ceil().max(1.0) as usize;
                Self { segment, steps }
            })
            .collect()
    }

    /// The tool after so many steps.
    pub fn place(&self, step: usize) -> Place {
        place(&self.segment, step as f64 / self.steps as f64)
    }
}

fn place(segment: &Segment, t: f64) -> Place {
    let (turn, tip) = segment.at(t);
    Place {
        tip: tip.into(),
        axis: turn.column(2).normalize(),
        turn,
    }
}

type Column = SmallVec<[[f64; 2]; 2]>;

/// Columns of material on the lines of a grid.
#[derive(Clone)]
pub struct Columns {
    grid: Grid,
    columns: Vec<Column>,
}

impl Columns {
    pub fn of(stock: &Dexels) -> Self {
        let grid = *stock.grid();
        let columns = (0..grid.len()).map(|line| stock.at(line).heights().collect()).collect();
        Self { grid, columns }
    }

    /// mm³.
    pub fn volume(&self) -> f64 {
        let [dx, dy] = self.grid.spacing();
        let length: f64 = self.columns.iter().flatten().map(|[low, high]| high - low).sum();
        length * dx * dy
    }

    /// Runs a tool along its path. The number of placed tools or hulls.
    pub fn remove(&mut self, cutter: &Cutter, path: &[Sampled], bridge: Bridge) -> usize {
        let mut count = 0;
        for (number, part) in path.iter().enumerate() {
            // The end of one part is the start of the next.
            let first = usize::from(bridge == Bridge::Hulls || number > 0);
            for step in first..=part.steps {
                let place = part.place(step);
                match bridge {
                    Bridge::Union => {
                        self.over(cutter.bounds(&place), |column, line| {
                            cutter.cut(&place, line, |low, high| subtract(column, low, high));
                        });
                    }
                    Bridge::Hulls => {
                        let hull = Hull::new(cutter, &part.place(step - 1), &place);
                        self.over(hull.bounds(), |column, line| {
                            if let Some([low, high]) = hull.cut(line) {
                                subtract(column, low, high);
                            }
                        });
                    }
                }
                count += 1;
            }
        }
        count
    }

    /// Visits the columns with material in a rectangle.
    fn over(&mut self, [xs, ys]: [[f64; 2]; 2], mut visit: impl FnMut(&mut Column, [f64; 2])) {
        let (min, spacing, cells) = (self.grid.min(), self.grid.spacing(), self.grid.cells());
        let range = |k: usize, [low, high]: [f64; 2]| {
            let first = ((low - min[k]) / spacing[k] - 0.5).ceil().max(0.0) as usize;
            let end = (((high - min[k]) / spacing[k] - 0.5).floor() + 1.0).max(0.0) as usize;
            first..end.min(cells[k])
        };
        for i in range(0, xs) {
            for j in range(1, ys) {
                let Some(index) = self.grid.index(i, j) else { continue };
                let column = &mut self.columns[index];
                if !column.is_empty() {
                    visit(column, [self.grid.x(i), self.grid.y(j)]);
                }
            }
        }
    }
}

/// Removes `[low, high]` from sorted, disjoint intervals.
fn subtract(column: &mut Column, low: f64, high: f64) {
    let mut k = 0;
    while k < column.len() {
        let [from, to] = column[k];
        if to <= low {
            k += 1;
        } else if from >= high {
            return;
        } else if from < low && to > high {
            column[k] = [from, low];
            column.insert(k + 1, [high, to]);
            return;
        } else if from < low {
            column[k] = [from, low];
            k += 1;
        } else if to > high {
            column[k] = [high, to];
            return;
        } else {
            column.remove(k);
        }
    }
}
