//! The course of a program in the joints of a machine, and boxes around its parts.

use crate::joint::{JOINTS, Span, Values};

/// What all joints do: one move after the other.
pub trait Course: Sync {
    /// The number of moves.
    fn moves(&self) -> usize;

    /// Where the joints are in a move, at a time from 0 to 1.
    fn at(&self, number: usize, time: f64) -> Values;

    /// No second derivative of a joint's value by the time is larger in a move: 0 where it moves at constant speed.
    fn bend(&self, number: usize) -> Values;

    /// Whether a move begins where the one before it ends.
    fn joined(&self, number: usize) -> bool;
}

/// Moves in one box.
const BLOCK: usize = 16;

/// A part of the course.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Interval {
    /// Moves from the first to before the last, in a box of this level.
    Run { level: usize, index: usize },
    /// A move between two times.
    Part { number: usize, from: f64, to: f64 },
}

/// Boxes around all runs of moves.
pub(crate) struct Runs<'a> {
    course: &'a dyn Course,
    /// By level: of 16 moves, of 32, and so on.
    boxes: Vec<Vec<[Values; 2]>>,
    /// What each joint may be beside the course.
    slack: Values,
}

fn around(a: &[Values; 2], b: &[Values; 2]) -> [Values; 2] {
    [
        std::array::from_fn(|k| a[0][k].min(b[0][k])),
        std::array::from_fn(|k| a[1][k].max(b[1][k])),
    ]
}

impl<'a> Runs<'a> {
    pub fn new(course: &'a dyn Course, slack: Values) -> Self {
        let of_move = |number: usize| {
            let (bend, ends) = (course.bend(number), [0.0, 1.0].map(|time| course.at(number, time)));
            let beyond = bend.map(|bend| bend / 8.0);
            let [low, high] = around(&[ends[0]; 2], &[ends[1]; 2]);
            [
                std::array::from_fn(|k| low[k] - beyond[k]),
                std::array::from_fn(|k| high[k] + beyond[k]),
            ]
        };
        let moves: Vec<usize> = (0..course.moves()).collect();
        let of_block = |block: &[usize]| block.iter().map(|n| of_move(*n)).reduce(|a, b| around(&a, &b));
        let mut boxes: Vec<Vec<[Values; 2]>> = vec![moves.chunks(BLOCK).filter_map(of_block).collect()];
        while let Some(last) = boxes.last().filter(|last| last.len() > 1) {
            let pair = |pair: &[[Values; 2]]| pair.iter().copied().reduce(|a, b| around(&a, &b));
            let next = last.chunks(2).filter_map(pair).collect();
            boxes.push(next);
        }
        Self { course, boxes, slack }
    }

    /// The whole course; `None` without moves.
    pub fn all(&self) -> Option<Interval> {
        let level = self.boxes.len().checked_sub(1)?;
        (!self.boxes[level].is_empty()).then_some(Interval::Run { level, index: 0 })
    }

    /// Moves of an interval.
    pub fn moves(&self, interval: &Interval) -> std::ops::Range<usize> {
        match *interval {
            Interval::Run { level, index } => {
                let size = BLOCK << level;
                size * index..(size * (index + 1)).min(self.course.moves())
            }
            Interval::Part { number, .. } => number..number + 1,
        }
    }

    /// The parts of an interval, the earliest first.
    pub fn parts(&self, interval: &Interval) -> Vec<Interval> {
        match *interval {
            Interval::Run { level: 0, .. } => {
                let part = |number| Interval::Part {
                    number,
                    from: 0.0,
                    to: 1.0,
                };
                self.moves(interval).map(part).collect()
            }
            Interval::Run { level, index } => {
                let below = self.boxes[level - 1].len();
                let halves = (2 * index..(2 * index + 2).min(below)).map(|index| Interval::Run {
                    level: level - 1,
                    index,
                });
                halves.collect()
            }
            Interval::Part { number, from, to } => {
                let middle = 0.5 * (from + to);
                [(from, middle), (middle, to)]
                    .map(|(from, to)| Interval::Part { number, from, to })
                    .to_vec()
            }
        }
    }

    /// Where the joints are in an interval.
    pub fn span(&self, interval: &Interval) -> Span {
        match *interval {
            Interval::Run { level, index } => {
                let [low, high] = &self.boxes[level][index];
                Span {
                    middle: std::array::from_fn(|k| 0.5 * (low[k] + high[k])),
                    way: [0.0; JOINTS],
                    spread: std::array::from_fn(|k| 0.5 * (high[k] - low[k]) + self.slack[k]),
                }
            }
            Interval::Part { number, from, to } => {
                let [a, b] = [from, to].map(|time| self.course.at(number, time));
                let bend = self.course.bend(number);
                let width = to - from;
                Span {
                    middle: std::array::from_fn(|k| 0.5 * (a[k] + b[k])),
                    way: std::array::from_fn(|k| 0.5 * (b[k] - a[k])),
                    spread: std::array::from_fn(|k| bend[k] * width * width / 8.0 + self.slack[k]),
                }
            }
        }
    }
}

/// When an interval begins, in its first move.
pub(crate) fn begin(interval: &Interval) -> f64 {
    match interval {
        Interval::Run { .. } => 0.0,
        Interval::Part { from, .. } => *from,
    }
}
