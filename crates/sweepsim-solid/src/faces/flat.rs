//! Faces without width, whose edges take the place of one another.

use crate::edges::{Curve, Edge, Placed};
use crate::parts::{SolidOptions, Use};
use nalgebra::Vector3;

/// Triangles lower than this, in cells, have no width, unless it is more than edges may be from faces.
const LOW: f64 = 2e-3;
/// Places along an edge that are compared, and chords of the other.
const COMPARED: usize = 8;
const CHORDS: usize = 64;

/// Where an edge begins in a loop.
pub(super) fn start((edge, forward): &Use, placed: &Placed) -> Option<Vector3<f64>> {
    let edge = placed.edges[*edge as usize].as_ref()?;
    Some(edge.ends[usize::from(!forward)])
}

/// For each edge those that take its place.
pub(super) struct Flat<'a> {
    placed: &'a Placed,
    instead: Vec<Vec<Use>>,
    width: f64,
    low: f64,
}

impl<'a> Flat<'a> {
    pub fn new(placed: &'a Placed, options: SolidOptions) -> Self {
        Self {
            placed,
            instead: (0..placed.edges.len() as u32).map(|edge| vec![(edge, true)]).collect(),
            width: 4.0 * options.tolerance,
            low: (LOW * options.cell).min(options.chord),
        }
    }

    /// A loop with the edges that are kept; empty if nothing is left of it.
    pub fn replaced(&self, own: &[Use]) -> Vec<Use> {
        let mut all: Vec<Use> = Vec::with_capacity(own.len());
        let mut next: Vec<Use> = own.iter().rev().copied().collect();
        while let Some((edge, forward)) = next.pop() {
            let instead = &self.instead[edge as usize];
            if instead[..] == [(edge, true)] {
                // There and back again is nowhere.
                if all.last() == Some(&(edge, !forward)) {
                    all.pop();
                } else {
                    all.push((edge, forward));
                }
            } else if forward {
                next.extend(instead.iter().rev());
            } else {
                next.extend(instead.iter().map(|(edge, way)| (*edge, !way)));
            }
        }
        while let ([(a, x), .., (b, y)], true) = (&all[..], all.len() > 1) {
            if a != b || x == y {
                break;
            }
            all.pop();
            all.remove(0);
        }
        all
    }

    /// Makes one edge of the two of a face whose edges lie on each other.
    pub fn lens(&mut self, loops: &[Vec<Use>]) {
        let [only] = loops else { return };
        let only = self.replaced(only);
        let [(a, forward), (b, backward)] = only[..] else {
            return;
        };
        let (Some(one), Some(two)) = (&self.placed.edges[a as usize], &self.placed.edges[b as usize]) else {
            return;
        };
        if a == b || one.vertices[0] == one.vertices[1] {
            return;
        }
        let near = (1..COMPARED).all(|k| distance(one.at(k as f64 / COMPARED as f64), two) <= self.width);
        if near {
            // Both from the same vertex to the same.
            let same = forward != backward;
            self.instead[a.max(b) as usize] = vec![(a.min(b), same)];
        }
    }

    /// The two shorter edges of a triangle without width take the place of the longest.
    pub fn triangle(&mut self, loops: &[Vec<Use>]) {
        let [only] = loops else { return };
        let only = self.replaced(only);
        let places: Vec<Vector3<f64>> = only.iter().filter_map(|used| start(used, self.placed)).collect();
        let ([first, second, third], [a, b, c]) = (&only[..], &places[..]) else {
            return self.lens(loops);
        };
        let lines = only.iter().all(|(edge, _)| {
            let edge = self.placed.edges[*edge as usize].as_ref();
            edge.is_some_and(|edge| edge.curve == Curve::Line)
        });
        let sides = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
        let longest = (0..3).fold(0, |best, k| if sides[k] > sides[best] { k } else { best });
        let area = (b - a).cross(&(c - a)).norm();
        if !lines || area > self.low * sides[longest] {
            return;
        }
        let own = [*first, *second, *third];
        let ((edge, forward), next, last) = (own[longest], own[(longest + 1) % 3], own[(longest + 2) % 3]);
        // Back along the other two.
        let flipped = |(edge, way): Use| (edge, !way);
        self.instead[edge as usize] = if forward {
            vec![flipped(last), flipped(next)]
        } else {
            vec![next, last]
        };
    }
}

/// The distance of a point from an edge, by its chords.
fn distance(p: Vector3<f64>, edge: &Edge) -> f64 {
    let mut least = f64::INFINITY;
    let mut from = edge.at(0.0);
    for k in 1..=CHORDS {
        let to = edge.at(k as f64 / CHORDS as f64);
        let way = to - from;
        let t = (way.dot(&(p - from)) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        least = least.min((p - from - way * t).norm());
        from = to;
    }
    least
}
