//! What a solid sweeps along very many stretches, as a tree of boxes in short numbers.

use super::Stretch;
use super::run::{Bounds, swept};
use crate::tool::Convex;
use nalgebra::Vector3;
use smallvec::SmallVec;
use std::ops::Range;

/// Boxes around what is swept in some consecutive stretches, by their lower and upper corners: first of all stretches,
/// then all boxes of the first half, then those of the second.
pub(crate) struct Boxes {
    all: Vec<[f32; 6]>,
    stretches: usize,
}

impl Boxes {
    /// `slack`: boxes are so much larger, for rounding.
    pub fn new(solid: &Convex, stretches: &[Stretch], slack: f64) -> Self {
        let mut boxes = Self {
            all: vec![[0.0; 6]; (2 * stretches.len()).saturating_sub(1)],
            stretches: stretches.len(),
        };
        if !stretches.is_empty() {
            build(solid, stretches, slack, &mut boxes.all);
        }
        boxes
    }

    /// Visits the numbers of stretches whose boxes meet a box, until one of the visits says no; whether none did.
    pub fn around(&self, low: &Vector3<f64>, high: &Vector3<f64>, visit: &mut dyn FnMut(usize) -> bool) -> bool {
        self.around_first(self.stretches, (low, high), visit)
    }

    /// The same for the first stretches, so many.
    pub fn around_first(
        &self,
        before: usize,
        around: (&Vector3<f64>, &Vector3<f64>),
        visit: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        self.each(before, around, |stretch, _| visit(stretch))
    }

    /// Boxes around what is swept in some consecutive stretches each, of all.
    pub fn hulls(&self, blocks: &[Range<usize>]) -> Vec<[f32; 6]> {
        let none = [
            f32::INFINITY,
            f32::INFINITY,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NEG_INFINITY,
            f32::NEG_INFINITY,
        ];
        let mut all = vec![none; blocks.len()];
        let mut present = 0;
        let everywhere = Vector3::repeat(f64::INFINITY);
        self.each(self.stretches, (&-everywhere, &everywhere), |stretch, own| {
            present += usize::from(stretch >= blocks[present].end);
            let hull = &mut all[present];
            for k in 0..3 {
                (hull[k], hull[k + 3]) = (hull[k].min(own[k]), hull[k + 3].max(own[k + 3]));
            }
            true
        });
        all
    }

    /// The numbers of stretches whose boxes meet a box, at most so many: those in the middle of whose boxes it is.
    pub fn most_central(&self, low: &Vector3<f64>, high: &Vector3<f64>, most: usize) -> Vec<usize> {
        let middle = (low + high).map(|c| c as f32);
        let mut all: Vec<(f32, usize)> = Vec::new();
        self.each(self.stretches, (low, high), |stretch, own| {
            let part = |k: usize| (middle[k] - own[k] - own[k + 3]) / (own[k + 3] - own[k]);
            all.push(((0..3).map(|k| part(k) * part(k)).sum(), stretch));
            true
        });
        if all.len() > most {
            all.select_nth_unstable_by(most, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            all.truncate(most);
        }
        all.into_iter().map(|(_, stretch)| stretch).collect()
    }

    /// Visits the first stretches whose boxes meet a box, with these.
    fn each(
        &self,
        before: usize,
        (low, high): (&Vector3<f64>, &Vector3<f64>),
        mut visit: impl FnMut(usize, &[f32; 6]) -> bool,
    ) -> bool {
        let low = low.map(|c| (c as f32).next_down());
        let high = high.map(|c| (c as f32).next_up());
        // A box, the first of its stretches, and how many.
        let mut open: SmallVec<[(usize, usize, usize); 64]> = SmallVec::new();
        if self.stretches > 0 {
            open.push((0, 0, self.stretches));
        }
        while let Some((number, first, count)) = open.pop() {
            let own = &self.all[number];
            if first >= before || (0..3).any(|k| high[k] < own[k] || low[k] > own[k + 3]) {
                continue;
            }
            if count > 1 {
                let half = count / 2;
                open.push((number + 2 * half, first + half, count - half));
                open.push((number + 1, first, half));
            } else if !visit(first, own) {
                return false;
            }
        }
        true
    }
}

fn build(solid: &Convex, stretches: &[Stretch], slack: f64, all: &mut [[f32; 6]]) {
    if let [stretch] = stretches {
        let axis = stretch.keeps_axis().then_some(stretch.ends[0].axis);
        let bend = stretch.bend(solid.reach(), 1.0);
        let Bounds { low, high } = swept(solid, &stretch.ends, axis, bend + slack);
        for k in 0..3 {
            (all[0][k], all[0][k + 3]) = ((low[k] as f32).next_down(), (high[k] as f32).next_up());
        }
        return;
    }
    let half = stretches.len() / 2;
    let (whole, parts) = all.split_at_mut(1);
    let (first, second) = parts.split_at_mut(2 * half - 1);
    rayon::join(
        || build(solid, &stretches[..half], slack, first),
        || build(solid, &stretches[half..], slack, second),
    );
    for k in 0..3 {
        whole[0][k] = first[0][k].min(second[0][k]);
        whole[0][k + 3] = first[0][k + 3].max(second[0][k + 3]);
    }
}
