//! The surface of dexels along one axis: where it is known, and where it may be.
//!
//! On a face that runs from one line to the next, it is that of the triangles. On a wall it is, at each height, on the
//! segment from a line with material to one without, and between two such segments within the squares of the grid on
//! both sides of them.

use super::DistanceRange;
use super::samples::{SampleDeviation, SurfaceSample, end_in_world};
use crate::dexels::Dexels;
use crate::mesh::{DistanceTo, MeshError, TriangleSoup};
use crate::surface::{Step, steps};
use crate::vector::{length, sub};
use rayon::prelude::*;
use smallvec::{SmallVec, smallvec};
use std::collections::HashMap;

/// How far, in cells, a wall may bulge between two lines of the same side, unseen by both: an arc of radius `r` through
/// lines `d` apart rises by `d² / 8 r`, so this is that of walls with a radius of at least a cell.
const BULGE: f64 = 0.125;
/// Points on a segment between two lines.
const POINTS: usize = 5;
/// The most heights of a wall between two lines.
const HEIGHTS: f64 = 4096.0;
/// The cosine of an end from which on the face beside it is not a step.
const FLAT: f64 = 0.3;

/// The surface of dexels along one axis. Trees are in the frame of the grid.
#[derive(Debug)]
pub(super) struct LineSurface<'a> {
    dexels: &'a Dexels,
    steps: Vec<Step>,
    /// Triangles of faces that run from line to line.
    known: DistanceTo,
    /// Boxes outside of which the surface is known.
    boxes: DistanceTo,
    /// The boxes' heights by square.
    ranges: HashMap<[usize; 2], SmallVec<[[f64; 2]; 2]>>,
    /// The rectangles between two lines, at the heights of each step.
    rectangles: DistanceTo,
}

impl<'a> LineSurface<'a> {
    /// Also the tree of the whole surface of triangles, in the world.
    pub fn new(dexels: &'a Dexels) -> Result<(Self, DistanceTo), MeshError> {
        let grid = dexels.grid();
        let steps = steps(dexels);
        let mut ranges: HashMap<[usize; 2], SmallVec<[[f64; 2]; 2]>> = HashMap::new();
        for step in &steps {
            let [low, high] = step.heights;
            for square in step.squares {
                ranges
                    .entry(square)
                    .or_default()
                    .push([low - step.beyond, high + step.beyond]);
            }
        }
        ranges.values_mut().for_each(merge);
        let (spacing, min) = (grid.spacing(), grid.min());
        let mut boxes = TriangleSoup::default();
        // In a fixed order, so that trees are the same in every run.
        let mut squares: Vec<_> = ranges.iter().collect();
        squares.sort_unstable_by_key(|(square, _)| **square);
        for (square, heights) in squares {
            let at = |k: usize, off: f64| min[k] + (square[k] as f64 + off) * spacing[k];
            for [low, high] in heights {
                let corners = [(-0.5 - BULGE, *low), (0.5 + BULGE, *high)].map(|(off, z)| [at(0, off), at(1, off), z]);
                boxes
                    .triangles
                    .extend(TriangleSoup::block(corners[0], corners[1]).triangles);
            }
        }
        let rectangles = TriangleSoup {
            triangles: steps.iter().flat_map(rectangle).collect(),
        };
        let whole = dexels.surface()?.soup().unwrap_or_default();
        let mut surface = Self {
            dexels,
            steps,
            known: DistanceTo::new(&TriangleSoup::default())?,
            boxes: DistanceTo::new(&boxes)?,
            ranges,
            rectangles: DistanceTo::new(&rectangles)?,
        };
        let local = whole.seen_from(grid.frame());
        let known = local.triangles.iter().filter(|corners| surface.is_known(corners));
        surface.known = DistanceTo::new(&TriangleSoup {
            triangles: known.copied().collect(),
        })?;
        Ok((surface, DistanceTo::new(&whole)?))
    }

    /// Whether a triangle, in the frame of the grid, belongs to a face that runs from line to line.
    fn is_known(&self, corners: &[[f64; 3]; 3]) -> bool {
        let middle = [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0);
        let (low, high) = corners
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                (low.min(p[2]), high.max(p[2]))
            });
        let ranges = self.ranges.get(&self.square(middle));
        !ranges.is_some_and(|ranges| ranges.iter().any(|[from, to]| low <= *to && high >= *from))
    }

    /// The square around a point; none that there is for a point before the first.
    fn square(&self, p: [f64; 2]) -> [usize; 2] {
        let grid = self.dexels.grid();
        [0, 1].map(|k| {
            let at = (p[k] - grid.min()[k]) / grid.spacing()[k] + 0.5;
            if at < 0.0 { usize::MAX } else { at as usize }
        })
    }

    /// Whether a point is in one of the boxes.
    fn is_open(&self, p: [f64; 3]) -> bool {
        let spacing = self.dexels.grid().spacing();
        let offs = [-BULGE, 0.0, BULGE];
        let squares = offs
            .iter()
            .flat_map(|a| offs.map(|b| [p[0] + a * spacing[0], p[1] + b * spacing[1]]));
        let ranges = squares.filter_map(|p| self.ranges.get(&self.square(p)));
        ranges.flatten().any(|[low, high]| *low <= p[2] && p[2] <= *high)
    }

    /// The distance of a point of the world, which is on one side of the surface of triangles.
    pub fn distance(&self, p: [f64; 3], near: f64) -> Option<DistanceRange> {
        let p = self.dexels.grid().frame().from_world(p);
        let away = |tree: &DistanceTo| tree.nearest_triangle(p).map_or(f64::INFINITY, |near| near.distance);
        let known = away(&self.known);
        // On a segment from a line with material to one without is a point of the wall.
        let wall = self.rectangles.nearest_triangle(p).map_or(f64::INFINITY, |near| {
            let [low, high] = near
                .corners
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| {
                    [low.min(c[2]), high.max(c[2])]
                });
            let z = p[2].max(low).min(high);
            let far = near.corners.iter().map(|c| length(sub(p, [c[0], c[1], z])));
            far.fold(0.0, f64::max)
        });
        let most = known.min(wall).min(self.near_end(p));
        let is_open = self.is_open(p);
        let least = if is_open {
            0.0
        } else {
            known.min(away(&self.boxes)).min(most)
        };
        let [low, high] = match (is_open, near >= 0.0) {
            (true, _) => [-most, most],
            (false, true) => [least, most],
            (false, false) => [-most, -least],
        };
        most.is_finite().then_some(DistanceRange { low, high })
    }

    /// How far it is from a point to the nearest end on the lines around it.
    fn near_end(&self, p: [f64; 3]) -> f64 {
        let grid = self.dexels.grid();
        let home = self.square([p[0], p[1]]);
        let range = |k: usize| home[k].saturating_sub(1)..home[k].saturating_add(1).min(grid.cells()[k]);
        let lines = range(0).flat_map(|i| range(1).map(move |j| (i, j)));
        let ends = lines.flat_map(|(i, j)| {
            let heights = self.dexels.intervals(i, j).heights().flatten();
            heights.map(move |z| length(sub(p, [grid.x(i), grid.y(j), z])))
        });
        ends.fold(f64::INFINITY, f64::min)
    }

    /// At all ends, and on all walls, from line to line. An end stands for its cell divided by the cosine of its slope,
    /// where the face beside it is not a step.
    pub fn samples(&self, of: impl Fn(&SurfaceSample) -> Option<SampleDeviation> + Sync) -> Vec<SampleDeviation> {
        let grid = self.dexels.grid();
        let (frame, [dx, dy]) = (grid.frame(), grid.spacing());
        let of_line = |line: &usize| {
            let (i, j) = grid.place(*line);
            let ends = self
                .dexels
                .at(*line)
                .iter()
                .flat_map(|interval| [interval.lower, interval.upper]);
            let found = ends.filter_map(|end| {
                let (place, normal) = end_in_world(frame, [grid.x(i), grid.y(j)], &end);
                let cosine = f64::from(end.normal[2].abs());
                of(&SurfaceSample {
                    places: smallvec![place],
                    normal,
                    area: dx * dy / if cosine > FLAT { cosine } else { 1.0 },
                })
            });
            found.collect::<Vec<_>>()
        };
        let of_step = |step: &Step| {
            let ([[a, b], [c, d]], [low, high]) = (step.lines, step.heights);
            let [run, width] = if a == c { [dy, dx] } else { [dx, dy] };
            let count = ((high - low) / run).ceil().clamp(1.0, HEIGHTS);
            let sample = |k: usize| {
                let part = if k == 0 || k == count as usize { 0.5 } else { 1.0 };
                let z = low + (high - low) * k as f64 / count;
                let place = |n: usize| {
                    let s = n as f64 / (POINTS - 1) as f64;
                    frame.to_world([a + s * (c - a), b + s * (d - b), z])
                };
                of(&SurfaceSample {
                    places: (0..POINTS).map(place).collect(),
                    normal: frame.turn_to_world([(c - a) / run, (d - b) / run, 0.0]),
                    // The mean of |cos| + |sin|, which is how often a wall meets segments along both axes, is 4 / π.
                    area: std::f64::consts::FRAC_PI_4 * part * width * (high - low) / count,
                })
            };
            (0..=count as usize).filter_map(sample).collect::<Vec<_>>()
        };
        let lines: Vec<usize> = self.dexels.iter().map(|(line, _)| line).collect();
        let mut found: Vec<SampleDeviation> = lines.par_iter().flat_map_iter(of_line).collect();
        let walls: Vec<SampleDeviation> = self.steps.par_iter().flat_map_iter(of_step).collect();
        found.extend(walls);
        found
    }
}

/// Joins ranges that overlap.
fn merge(ranges: &mut SmallVec<[[f64; 2]; 2]>) {
    ranges.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    ranges.dedup_by(|next, last| {
        let overlap = next[0] <= last[1];
        if overlap {
            last[1] = last[1].max(next[1]);
        }
        overlap
    });
}

/// The rectangle between both lines of a step.
fn rectangle(step: &Step) -> [[[f64; 3]; 3]; 2] {
    let ([[a, b], [c, d]], [low, high]) = (step.lines, step.heights);
    let corners = [[a, b, low], [c, d, low], [c, d, high], [a, b, high]];
    [
        [corners[0], corners[1], corners[2]],
        [corners[0], corners[2], corners[3]],
    ]
}
