//! Stock that the grid does not cover.

use crate::base::words::length;
use sweepsim_dexel::{Frame, Stock};
use sweepsim_formats::Job;

/// A box: its lowest and highest corner.
type Corners = [[f64; 3]; 2];

/// Stock may reach out of the grid by this part of its size: rounding.
const ROUNDING: f64 = 1e-9;

/// Whether the grid covers the whole stock.
#[must_use]
pub fn is_covered(job: &Job) -> bool {
    uncovered(job).is_none()
}

/// Whether none of the stock is on the grid.
pub(crate) fn is_beside(job: &Job) -> bool {
    let grid = &job.grid;
    let (min, max) = (grid.min(), grid.max());
    let beyond = |[low, high]: Corners| (0..2).any(|k| high[k] <= min[k] || low[k] >= max[k]);
    within(&job.stock, grid.frame()).is_some_and(beyond)
}

/// Stock beside the grid: it is neither cut nor measured.
pub(super) fn uncovered(job: &Job) -> Option<String> {
    let grid = &job.grid;
    let [low, high] = within(&job.stock, grid.frame())?;
    let (min, max) = (grid.min(), grid.max());
    // The corners of dexels' cells, and not their material, are what is known of stock from dexels.
    let slack = |k: usize| {
        let of_cells = if has_dexels(&job.stock) { grid.spacing()[k] } else { 0.0 };
        of_cells.max(ROUNDING * (high[k] - low[k]))
    };
    let out = |k: usize| low[k] < min[k] - slack(k) || high[k] > max[k] + slack(k);
    if !out(0) && !out(1) {
        return None;
    }
    let range = |low: f64, high: f64| format!("{} … {}", length(low), length(high));
    let extents = ["x", "y"].iter().enumerate().filter(|&(k, _)| out(k)).map(|(k, axis)| {
        format!(
            "in {axis} the stock lies at {} and the grid at {}",
            range(low[k], high[k]),
            range(min[k], max[k])
        )
    });
    let extents: Vec<String> = extents.collect();
    let what = if is_beside(job) {
        "none of the stock is on the grid"
    } else {
        "the grid does not cover the stock: what lies beside it is neither cut nor measured"
    };
    Some(format!("{what}; {}", extents.join(", ")))
}

fn has_dexels(stock: &Stock) -> bool {
    match stock {
        Stock::Dexels(_) | Stock::TriDexels(_) => true,
        Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().any(has_dexels),
        Stock::Difference(whole, _) => has_dexels(whole),
        _ => false,
    }
}

/// A box in the frame of a grid that holds the stock. It is the smallest for blocks, cylinders, balls and meshes.
pub(super) fn within(stock: &Stock, frame: &Frame) -> Option<Corners> {
    if frame.is_world() {
        return stock.bounds();
    }
    match stock {
        Stock::Cylinder {
            base,
            axis,
            radius,
            height,
        } => {
            let turned = Stock::Cylinder {
                base: frame.from_world(*base),
                axis: frame.turn_from_world(*axis),
                radius: *radius,
                height: *height,
            };
            turned.bounds()
        }
        Stock::Ball { centre, radius } => {
            let centre = frame.from_world(*centre);
            Stock::Ball {
                centre,
                radius: *radius,
            }
            .bounds()
        }
        Stock::Mesh(soup) => hull(soup.triangles.iter().flatten().map(|p| frame.from_world(*p))),
        Stock::Union(parts) => hull(parts.iter().filter_map(|part| within(part, frame)).flatten()),
        Stock::Difference(whole, _) => within(whole, frame),
        _ => {
            let [low, high] = stock.bounds()?;
            let corner = |n: usize| [0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] });
            hull((0..8).map(|n| frame.from_world(corner(n))))
        }
    }
}

fn hull(points: impl Iterator<Item = [f64; 3]>) -> Option<Corners> {
    points.map(|p| [p, p]).reduce(|[a, b], [c, d]| {
        [
            [0, 1, 2].map(|k| f64::min(a[k], c[k])),
            [0, 1, 2].map(|k| f64::max(b[k], d[k])),
        ]
    })
}
