//! Where an outline of curves meets itself.

use super::bezier::{Bezier, apart, one_way};
use super::spline_spans::NEAR;
use super::{ProfileError, SplineFault};
use nalgebra::Vector2;
use std::ops::Range;

/// An outline of curves: where it meets itself.
pub(super) struct Outline {
    /// Direct parts in order, each with the number of its segment.
    parts: Vec<(usize, Bezier)>,
    near: f64,
}

impl Outline {
    /// Creates an outline from curves in order, with the numbers of their segments.
    ///
    /// # Errors
    /// [`ProfileError::Spline`] where a curve stops.
    pub fn new(curves: impl Iterator<Item = (usize, Bezier)>, length: f64) -> Result<Self, ProfileError> {
        let near = NEAR * length;
        let mut parts = Vec::new();
        for (segment, curve) in curves {
            let mut own = Vec::new();
            curve
                .direct_parts([0.0, 1.0], near, &mut own)
                .map_err(|_| ProfileError::Spline {
                    segment,
                    fault: SplineFault::Stops {
                        near: curve.at(0.5).into(),
                    },
                })?;
            parts.extend(own.into_iter().map(|part| (segment, part)));
        }
        Ok(Self { parts, near })
    }

    /// Two segments (or the same one twice) that cross or touch.
    pub fn crossing(&self) -> Option<(usize, usize)> {
        self.within(0..self.parts.len())
    }

    fn within(&self, range: Range<usize>) -> Option<(usize, usize)> {
        if range.len() < 2 {
            return None;
        }
        let middle = range.start + range.len() / 2;
        self.within(range.start..middle)
            .or_else(|| self.within(middle..range.end))
            .or_else(|| self.between(range.start..middle, middle..range.end))
    }

    fn bounds(&self, range: Range<usize>) -> [Vector2<f64>; 2] {
        let boxes = self.parts[range].iter().map(|(_, part)| part.bounds());
        boxes
            .reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])])
            .unwrap_or_default()
    }

    fn between(&self, a: Range<usize>, b: Range<usize>) -> Option<(usize, usize)> {
        if apart(self.bounds(a.clone()), self.bounds(b.clone()), self.near) {
            return None;
        }
        if a.len() == 1 && b.len() == 1 {
            let ((first, p), (second, q)) = (&self.parts[a.start], &self.parts[b.start]);
            let good = if a.start + 1 == b.start {
                self.join(p, q)
            } else {
                self.clear(p, q)
            };
            return (!good).then_some((*first, *second));
        }
        if a.len() >= b.len() {
            let middle = a.start + a.len() / 2;
            self.between(a.start..middle, b.clone())
                .or_else(|| self.between(middle..a.end, b))
        } else {
            let middle = b.start + b.len() / 2;
            self.between(a.clone(), b.start..middle)
                .or_else(|| self.between(a, middle..b.end))
        }
    }

    /// Whether two curves, of which the second begins where the first ends, have only that point in common.
    fn join(&self, a: &Bezier, b: &Bezier) -> bool {
        if one_way(a.legs().chain(b.legs())) {
            return true;
        }
        if a.length() <= self.near || b.length() <= self.near {
            return false;
        }
        let ((a0, a1), (b0, b1)) = (a.halves(), b.halves());
        self.join(&a1, &b0) && self.clear(&a0, &b0) && self.clear(&a0, &b1) && self.clear(&a1, &b1)
    }

    /// Whether two curves are apart: the longer one is halved until their boxes are.
    fn clear(&self, a: &Bezier, b: &Bezier) -> bool {
        if apart(a.bounds(), b.bounds(), self.near) {
            return true;
        }
        let (la, lb) = (a.length(), b.length());
        if la.max(lb) <= self.near {
            return false;
        }
        let (cut, other) = if la >= lb { (a, b) } else { (b, a) };
        let (low, high) = cut.halves();
        self.clear(&low, other) && self.clear(&high, other)
    }
}
