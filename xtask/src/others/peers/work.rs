//! The work that all do, and how far their answers are from the exact dexels.

use crate::bench::raster;
use nalgebra::Vector3;
use std::fmt::Write as _;
use sweepsim::{Cut, Options, simulate};
use sweepsim_dexel::{Dexels, DistanceTo, Stock, TriangleSoup};
use sweepsim_motion::{Path, Pose, Tool};

/// The tool, in mm.
pub const RADIUS: f64 = 3.0;
const LENGTH: f64 = 30.0;
/// The block, seen from the side.
const BOTTOM: f64 = -10.0;
const TOP: f64 = 5.0;
/// Errors are measured on lines within so much of the side from the middle: away from where the raster ends.
const INNER: f64 = 0.38;
/// The largest lean of the axis in five axes, in radians, is about this.
const LEAN: f64 = 0.5;

/// A program to mill.
pub struct Work {
    pub ball: bool,
    pub cells: usize,
    path: Path,
}

/// What a peer's answer is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// The top of each column.
    Columns,
    /// The corners of triangles.
    Triangles,
}

/// Distances from the exact surface, in mm.
pub struct Errors {
    pub max: f64,
    pub p99: f64,
}

impl Work {
    /// 3,049 moves without a turn.
    pub fn three_axis(ball: bool) -> Result<Self, String> {
        let path = Path::new(raster::poses([50, 60], raster::SIDE, 0.0)?).map_err(|error| error.to_string())?;
        Ok(Self {
            ball,
            cells: 1000,
            path,
        })
    }

    /// 315 moves, the first of them a plunge, in each of which the axis turns by a few degrees.
    pub fn five_axis(ball: bool) -> Result<Self, String> {
        let mut poses = raster::poses([21, 14], raster::SIDE, LEAN)?;
        let ([x, y, _], axis) = (poses[0].tip(), poses[0].axis());
        poses.insert(
            0,
            Pose::new([x, y, TOP + 1.0], axis).map_err(|error| error.to_string())?,
        );
        let path = Path::new(poses).map_err(|error| error.to_string())?;
        Ok(Self { ball, cells: 200, path })
    }

    pub fn moves(&self) -> usize {
        self.path.moves()
    }

    fn corners() -> [[f64; 3]; 2] {
        let half = 0.5 * raster::SIDE;
        [[-half, -half, BOTTOM], [half, half, TOP]]
    }

    /// As a file for the peers' programs.
    pub fn file(&self) -> String {
        let [[x, y, z], [u, v, w]] = Self::corners();
        let tool = if self.ball { "ball" } else { "flat" };
        let mut text = format!(
            "{tool},{RADIUS},{LENGTH}\nblock,{x},{y},{z},{u},{v},{w}\ncells,{}\n",
            self.cells
        );
        for pose in self.path.poses() {
            let ([x, y, z], [i, j, k]) = (pose.tip(), pose.axis());
            let _ = writeln!(text, "pose,{x:?},{y:?},{z:?},{i:?},{j:?},{k:?}");
        }
        text
    }

    /// The block.
    pub fn stock(&self) -> Result<Dexels, String> {
        let [min, max] = Self::corners();
        let grid = raster::grid(self.cells)?;
        Stock::Block { min, max }
            .dexels(&grid)
            .map_err(|error| error.to_string())
    }

    /// Removes the program from the block, exactly.
    pub fn simulate(&self, stock: Dexels) -> Result<Dexels, String> {
        let tool = if self.ball {
            Tool::ball(RADIUS, LENGTH)
        } else {
            Tool::flat(RADIUS, LENGTH)
        };
        let tool = tool.map_err(|error| error.to_string())?;
        let done = simulate(stock, &[Cut::new(&tool, &self.path)], &Options::new(1e-6), &());
        done.map(|done| done.remaining).map_err(|error| error.to_string())
    }
}

/// How far a peer's answer is from the exact surface, at the highest ends of the inner lines that a tool made.
pub fn errors(exact: &Dexels, answer: Answer, numbers: &[f64]) -> Result<Errors, String> {
    let grid = exact.grid();
    let [nx, ny] = grid.cells();
    let inner = INNER * raster::SIDE;
    let distance = match answer {
        Answer::Columns if numbers.len() != nx * ny => {
            return Err(format!("{} columns instead of {}", numbers.len(), nx * ny));
        }
        Answer::Columns => None,
        Answer::Triangles => {
            let corner = |c: &[f64]| [c[0], c[1], c[2]];
            let triangle = |t: &[f64]| [corner(&t[..3]), corner(&t[3..6]), corner(&t[6..])];
            let triangles: Vec<[[f64; 3]; 3]> = numbers.chunks_exact(9).map(triangle).collect();
            Some(DistanceTo::new(&TriangleSoup { triangles }).map_err(|error| error.to_string())?)
        }
    };
    let mut all = Vec::new();
    for (line, pieces) in exact.iter() {
        let (i, j) = grid.place(line);
        let (x, y) = (grid.x(i), grid.y(j));
        let Some(end) = pieces.last().map(|piece| piece.upper) else {
            continue;
        };
        if x.abs() > inner || y.abs() > inner || !end.source.is_cut() {
            continue;
        }
        all.push(match &distance {
            // At a right angle to the surface, to first order. A column without material misses all of it.
            None if numbers[j * nx + i].is_nan() => end.z - BOTTOM,
            None => (numbers[j * nx + i] - end.z).abs() * f64::from(end.normal[2].abs()),
            Some(surface) => surface
                .nearest(Vector3::new(x, y, end.z).into())
                .map_or(f64::INFINITY, |near| near.distance.abs()),
        });
    }
    all.sort_by(f64::total_cmp);
    match all.last() {
        Some(max) => Ok(Errors {
            max: *max,
            p99: all[all.len() * 99 / 100],
        }),
        None => Err("no inner line has an end that a tool made".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_displaced_answer_is_off_by_as_much() {
        let work = Work {
            cells: 60,
            ..Work::five_axis(true).unwrap()
        };
        assert_eq!(work.moves(), 315);
        assert_eq!(work.file().lines().count(), 3 + 316);
        let exact = work.simulate(work.stock().unwrap()).unwrap();
        let top = |line: usize| exact.at(line).last().map_or(f64::NAN, |piece| piece.upper.z);
        // Rows along x, while the grid counts along y first or last as it likes.
        let tops: Vec<f64> = (0..3600)
            .map(|n| top(exact.grid().index(n % 60, n / 60).unwrap()))
            .collect();
        assert!(errors(&exact, Answer::Columns, &tops).unwrap().max < 1e-12);
        let lifted: Vec<f64> = tops.iter().map(|z| z + 0.1).collect();
        let off = errors(&exact, Answer::Columns, &lifted).unwrap();
        assert!(off.max <= 0.1 + 1e-12 && off.p99 > 0.09);
        assert!(errors(&exact, Answer::Columns, &tops[1..]).is_err());
        // A level square far below: as far away as the highest point.
        let low = [
            -50.0, -50.0, -10.0, 50.0, -50.0, -10.0, 50.0, 50.0, -10.0, -50.0, -50.0, -10.0, 50.0, 50.0, -10.0, -50.0,
            50.0, -10.0,
        ];
        assert!(errors(&exact, Answer::Triangles, &low).unwrap().max > 9.0);
    }
}
