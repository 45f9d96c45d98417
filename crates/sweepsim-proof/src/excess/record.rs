//! What a search leaves behind for a checker: of each patch of the surface, a tree.
//!
//! A node is a byte, and what belongs to it; both parts of a division, or all of them, follow.
//!
//! | byte | node |
//! | --- | --- |
//! | 0 | Nothing is there: an edge or a corner that turns inwards, or none. |
//! | 1 | Outside of the stock. |
//! | 2 | Nearer to a triangle: its number. |
//! | 3 | Removed: the numbers of what moves, of its solid, and of the stretch; the time, an `f32`, if that is not straight. |
//! | 4 | Inside of the solid, all of a ball around its middle. |
//! | 10, 11, 12 | Parted between the corners 0 and 1, 0 and 2, or 1 and 2: at which part of the way, an `f32`. |
//! | 13, 14, 15 | Halved between two normals. |
//! | 16 | In all directions, between the axes. |
//! | 17 | For any two of its normals and the first. |

use super::patch::{Halved, Patch, Patches};
use super::removed::Holder;
use super::surface::Surface;
use crate::numbers::write_number;
use rayon::prelude::*;
use smallvec::SmallVec;
use std::ops::Range;

/// The trees of some patches of the surface: the first, how many, and the bytes.
pub type PatchTrees = (usize, usize, Vec<u8>);

/// The patches of so many triangles and corners have their trees together.
const TOGETHER: usize = 4096;

/// A step of a tree whose parts are searched for themselves.
#[derive(Clone, Copy)]
enum Step {
    /// A patch of the surface begins.
    Begin,
    Byte(u8),
    Halved(Halved),
    /// The tree of a part follows: its number among those that lie together.
    Part(usize),
}

/// The tree of a part.
#[derive(Clone, Debug, Default)]
pub(super) struct Record(Vec<u8>);

impl Record {
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    pub fn of_bytes(bytes: Vec<u8>) -> Self {
        Self(bytes)
    }

    pub fn clear(&mut self) {
        self.0 = Vec::new();
    }

    pub fn outside(&mut self) {
        self.0.push(1);
    }

    pub fn near(&mut self, triangle: u32) {
        self.0.push(2);
        write_number(&mut self.0, triangle as usize);
    }

    pub fn removed(&mut self, holder: Holder) {
        self.0.push(3);
        for number in [holder.course, holder.solid, holder.stretch] {
            write_number(&mut self.0, number);
        }
        self.0.extend(holder.time.iter().flat_map(|time| time.to_le_bytes()));
    }

    pub fn inside(&mut self) {
        self.0.push(4);
    }

    pub fn halved(&mut self, halved: Halved) {
        self.0.extend(bytes_of(halved));
    }
}

fn bytes_of(halved: Halved) -> SmallVec<[u8; 5]> {
    let byte = |first: u8, [i, j]: [usize; 2]| first + (i + j - 1) as u8;
    match halved {
        Halved::Corners(pair, part) => std::iter::once(byte(10, pair)).chain(part.to_le_bytes()).collect(),
        Halved::Normals(pair) => SmallVec::from_slice(&[byte(13, pair)]),
    }
}

/// The patches of a surface in parts, some of which lie together.
pub(super) struct Parts {
    some: Vec<Vec<Patch>>,
    /// How they make up the surface, if that is to be recorded.
    steps: Vec<Vec<Step>>,
    /// How many there are before each of these, and in all.
    before: Vec<usize>,
}

impl Parts {
    pub fn len(&self) -> usize {
        self.before.last().copied().unwrap_or_default()
    }

    pub fn get(&self, number: usize) -> &Patch {
        let own = self.before.partition_point(|before| *before <= number) - 1;
        &self.some[own][number - self.before[own]]
    }
}

/// The patches of a surface in parts, those longer than some length halved.
pub(super) fn parts(surface: &Surface, longest: f64, recorded: bool) -> Parts {
    let sites: Vec<Range<usize>> = (0..surface.sites())
        .step_by(TOGETHER)
        .map(|first| first..surface.sites().min(first + TOGETHER))
        .collect();
    let made = sites
        .into_par_iter()
        .map(|sites| parts_of(surface, sites, longest, recorded));
    let (some, steps): (Vec<Vec<Patch>>, Vec<Vec<Step>>) = made.unzip();
    let mut before = vec![0];
    before.extend(some.iter().scan(0, |count, own| {
        *count += own.len();
        Some(*count)
    }));
    Parts { some, steps, before }
}

fn parts_of(surface: &Surface, sites: Range<usize>, longest: f64, recorded: bool) -> (Vec<Patch>, Vec<Step>) {
    let (mut parts, mut steps) = (Vec::with_capacity(2 * sites.len()), Vec::new());
    let mut step = |step| {
        if recorded {
            steps.push(step);
        }
    };
    let mut open = Vec::new();
    let mut add = |own: Patches| {
        step(Step::Begin);
        match &own[..] {
            [] => step(Step::Byte(0)),
            [_] => {}
            [a, b, ..] => step(Step::Byte(if a.normals[0] == b.normals[0] { 17 } else { 16 })),
        }
        open.extend(own.into_iter().rev());
        while let Some(patch) = open.pop() {
            let is_long = patch.length() > longest;
            let halves = is_long.then(|| patch.halves(0.0, f64::MIN_POSITIVE, None)).flatten();
            if let Some((halved, [first, second])) = halves {
                step(Step::Halved(halved));
                open.extend([second, first]);
            } else {
                step(Step::Part(parts.len()));
                parts.push(patch);
            }
        }
    };
    sites.for_each(|site| surface.patches(site, &mut add));
    // There may be many of both, for as long as the search takes.
    parts.shrink_to_fit();
    steps.shrink_to_fit();
    (parts, steps)
}

/// The trees of all patches.
pub(super) fn trees(parts: &Parts, records: &[Record]) -> Vec<PatchTrees> {
    let mut all = Vec::with_capacity(parts.steps.len());
    let mut first = 0;
    for (steps, before) in parts.steps.iter().zip(&parts.before) {
        let (mut count, mut bytes) = (0, Vec::new());
        for step in steps {
            match step {
                Step::Begin => count += 1,
                Step::Byte(byte) => bytes.push(*byte),
                Step::Halved(halved) => bytes.extend(bytes_of(*halved)),
                Step::Part(part) => bytes.extend_from_slice(&records[before + part].0),
            }
        }
        all.push((first, count, bytes));
        first += count;
    }
    all
}

/// Where a triangle of a surface is among all, by its corners.
pub(super) fn key(corners: &[[f64; 3]; 3]) -> [u64; 9] {
    std::array::from_fn(|k| (corners[k / 3][k % 3] + 0.0).to_bits())
}
