//! Consecutive stretches as a tree of boxes.

use super::{Placement, Stretch};
use crate::tool::Convex;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub low: Vector3<f64>,
    pub high: Vector3<f64>,
}

impl Bounds {
    pub fn join(&self, other: &Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    pub fn size(&self) -> f64 {
        (self.high - self.low).norm()
    }

    /// Whether a cube has no point with it in common.
    pub fn misses(&self, centre: &Vector3<f64>, half: f64) -> bool {
        (0..3).any(|k| self.low[k] > centre[k] + half || self.high[k] < centre[k] - half)
    }
}

/// Some consecutive stretches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub first: usize,
    pub last: usize,
    /// Of what the solid sweeps.
    pub swept: Bounds,
    /// Of the tip's way.
    pub tips: Bounds,
    /// The axis, if it is the same all the way.
    pub axis: Option<Vector3<f64>>,
    /// By how much a point may go beyond the hull of where it is at the ends of the stretches.
    pub bend: f64,
    /// The two halves, if there is more than one stretch.
    pub halves: Option<[usize; 2]>,
}

/// A solid along consecutive stretches.
pub(crate) struct Run<'a> {
    pub solid: &'a Convex,
    pub stretches: &'a [Stretch],
    /// Where each stretch begins and ends.
    pub ends: Vec<Placement>,
    /// The root is the last one.
    pub nodes: Vec<Node>,
    pub reach: f64,
    slack: f64,
}

impl<'a> Run<'a> {
    /// `slack`: boxes are so much larger, for rounding.
    pub fn new(solid: &'a Convex, stretches: &'a [Stretch], slack: f64) -> Self {
        let mut run = Self {
            solid,
            stretches,
            ends: stretches.iter().flat_map(|stretch| stretch.ends).collect(),
            nodes: Vec::with_capacity(2 * stretches.len()),
            reach: solid.reach(),
            slack,
        };
        if !stretches.is_empty() {
            run.build(0, stretches.len());
        }
        run
    }

    fn build(&mut self, first: usize, last: usize) -> usize {
        let node = if last == first + 1 {
            let stretch = &self.stretches[first];
            let tips = Bounds {
                low: stretch.low,
                high: stretch.high,
            };
            let axis = stretch.keeps_axis().then_some(stretch.ends[0].axis);
            let bend = stretch.bend(self.reach, 1.0);
            Node {
                first,
                last,
                swept: swept(self.solid, &stretch.ends, axis, bend + self.slack),
                tips,
                axis,
                bend,
                halves: None,
            }
        } else {
            let middle = usize::midpoint(first, last);
            let halves = [self.build(first, middle), self.build(middle, last)];
            let [a, b] = halves.map(|half| self.nodes[half]);
            Node {
                first,
                last,
                swept: a.swept.join(&b.swept),
                tips: a.tips.join(&b.tips),
                axis: a.axis.filter(|axis| b.axis == Some(*axis)),
                bend: a.bend.max(b.bend),
                halves: Some(halves),
            }
        };
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Visits the first `count` stretches whose swept boxes meet a box, by their numbers, until one of the visits
    /// says no; whether none did.
    pub fn around_first(
        &self,
        count: usize,
        (low, high): (&Vector3<f64>, &Vector3<f64>),
        visit: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        let mut open: SmallVec<[usize; 64]> = self.nodes.len().checked_sub(1).into_iter().collect();
        while let Some(number) = open.pop() {
            let node = &self.nodes[number];
            let Bounds { low: from, high: to } = &node.swept;
            if node.first >= count || (0..3).any(|k| high[k] < from[k] || low[k] > to[k]) {
                continue;
            }
            match node.halves {
                Some([first, second]) => open.extend([second, first]),
                None => {
                    if !visit(node.first) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// How far the solid reaches in a direction at some placements, and at which of them. `axis`: of all of them.
    pub fn reaches(&self, ends: &[Placement], axis: Option<Vector3<f64>>, direction: &Vector3<f64>) -> (f64, usize) {
        reaches(self.solid, ends, axis, direction)
    }

    /// The point of the solid at a placement that reaches farthest.
    pub fn farthest(&self, end: &Placement, direction: &Vector3<f64>) -> Vector3<f64> {
        end.tip + self.solid.farthest(direction, &end.axis)
    }
}

/// How far a solid reaches in a direction at some placements, and at which of them.
fn reaches(solid: &Convex, ends: &[Placement], axis: Option<Vector3<f64>>, direction: &Vector3<f64>) -> (f64, usize) {
    let mut best = (f64::NEG_INFINITY, 0);
    for (number, end) in ends.iter().enumerate() {
        let own = if axis.is_some() {
            0.0
        } else {
            solid.support(direction, &end.axis)
        };
        let value = direction.dot(&end.tip) + own;
        if value > best.0 {
            best = (value, number);
        }
    }
    best.0 += axis.map_or(0.0, |axis| solid.support(direction, &axis));
    best
}

/// What a solid sweeps between placements, if no point goes farther than `bend` beyond the hull of where it is at
/// these.
pub(super) fn swept(solid: &Convex, ends: &[Placement], axis: Option<Vector3<f64>>, bend: f64) -> Bounds {
    let mut bounds = Bounds {
        low: Vector3::zeros(),
        high: Vector3::zeros(),
    };
    for k in 0..3 {
        let direction = Vector3::ith(k, 1.0);
        bounds.high[k] = reaches(solid, ends, axis, &direction).0 + bend;
        bounds.low[k] = -reaches(solid, ends, axis, &-direction).0 - bend;
    }
    bounds
}
