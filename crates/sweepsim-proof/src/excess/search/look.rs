//! The search in one patch.

use super::super::found::Found;
use super::super::patch::{Around, Halved, Patch};
use super::super::record::{Record, key};
use super::super::removed::{Holder, Known};
use super::{FINEST, MOST_OPEN, SHARE, STEPS, Scene};
use crate::motion::Bounds;
use nalgebra::Vector3;

/// The search in a patch.
pub(super) struct Search<'a> {
    pub scene: &'a Scene<'a>,
    pub distance: f64,
    pub known: f64,
    /// Places that are not higher by so much are not looked for.
    pub finer: f64,
    pub found: Found,
    /// What held the patch before.
    pub recent: Option<Holder>,
    /// A box around all points about which it was asked whether they were removed.
    pub around: Bounds,
}

/// Why points are not at a distance from the target, on the outside.
enum ByTheTarget {
    /// They are nearer to this triangle.
    Near([[f64; 3]; 3]),
    /// They are in it, as no surface is around them.
    Inside,
}

impl Search<'_> {
    pub fn look(&mut self, patch: Patch, most: usize) {
        let mut open = vec![patch];
        while let Some(patch) = open.pop() {
            let Some((whole, middle)) = patch.points(self.distance) else {
                self.found.patches += 1;
                match patch.halves(self.distance, 0.0, None) {
                    Some(halves) if self.found.patches < most => self.halve(halves, &mut open),
                    _ => self.leave(&patch.corners),
                }
                continue;
            };
            self.found.patches += 1;
            let scene = self.scene;
            let points = scene.before.within(&whole, &middle);
            if points.is_empty() {
                self.record(Record::outside);
                continue;
            }
            self.asks(&points);
            let mut known = scene.removed.held(&points, &middle, self.recent);
            if self.is_removed(&known) {
                continue;
            }
            match self.by_the_target(&whole, &middle) {
                Some(ByTheTarget::Near(corners)) => {
                    self.record(|record| record.near(scene.numbers.get(&key(&corners)).copied().unwrap_or(u32::MAX)));
                    continue;
                }
                Some(ByTheTarget::Inside) => {
                    self.record(Record::inside);
                    continue;
                }
                None => {}
            }
            if !known.is_removed && self.is_left(&middle) {
                let height = scene.height(&middle) - scene.removed.margin;
                self.found.take(middle, height);
                // Else the middle is not of the surface.
                if height > self.distance * (1.0 - SHARE) {
                    self.found.is_left = true;
                    self.rise(&patch);
                    continue;
                }
            } else if !known.is_removed
                && let Some(other) = scene.removed.held_anywhere(&points, &middle)
            {
                if self.is_removed(&other) {
                    continue;
                }
                known = other;
            }
            let nearest = known.nearest;
            let is_free = |point: &Vector3<f64>| {
                let is_held = nearest.is_some_and(|nearest| scene.removed.holds(nearest, point));
                is_held || !scene.before.holds_around(point, 2.0 * scene.removed.margin)
            };
            let apart = |ends: [&Vector3<f64>; 2]| nearest.map_or(0.0, |nearest| scene.removed.apart(nearest, ends));
            let around = Around {
                is_free: &is_free,
                apart: &apart,
            };
            match patch.halves(self.distance, FINEST * self.distance, Some(around)) {
                Some(halves) if self.found.patches < most => self.halve(halves, &mut open),
                _ => self.leave(&points),
            }
        }
    }

    /// Whether one solid is known to have removed a whole patch: noted.
    fn is_removed(&mut self, known: &Known) -> bool {
        if let Some(holder) = known.holder {
            self.recent = Some(holder);
            self.record(|record| record.removed(holder));
        }
        known.holder.is_some()
    }

    fn halve(&mut self, (halved, [first, second]): (Halved, [Patch; 2]), open: &mut Vec<Patch>) {
        self.record(|record| record.halved(halved));
        open.extend([second, first]);
    }

    fn record(&mut self, write: impl FnOnce(&mut Record)) {
        // What is not finished is of no use.
        if self.scene.recorded && self.found.open_count == 0 && !self.found.is_left {
            write(&mut self.found.record);
        } else {
            self.found.record.clear();
        }
    }

    /// Why the hull of some points has nothing that is outside of the target, at the distance from it.
    fn by_the_target(&self, points: &[Vector3<f64>], middle: &Vector3<f64>) -> Option<ByTheTarget> {
        let (target, margin) = (self.scene.target, self.scene.removed.margin);
        let triangle = target.distance.nearest_triangle((*middle).into())?;
        let least = self.distance - margin;
        let mut all = points.iter().map(|point| triangle.distance_of((*point).into()));
        if triangle.distance < least && all.all(|distance| distance < least) {
            return Some(ByTheTarget::Near(triangle.corners));
        }
        let far = points.iter().map(|point| (point - middle).norm()).fold(0.0, f64::max);
        let is_inside = far + margin < triangle.distance && target.depth((*middle).into()) > 0.0;
        is_inside.then_some(ByTheTarget::Inside)
    }

    /// Notes that it matters what was removed around some points.
    fn asks(&mut self, points: &[Vector3<f64>]) {
        for point in points {
            self.around.low = self.around.low.inf(point);
            self.around.high = self.around.high.sup(point);
        }
    }

    fn is_left(&mut self, point: &Vector3<f64>) -> bool {
        self.asks(&[*point]);
        self.scene.is_left(point)
    }

    /// Looks how far what is left reaches, above a place where something is left.
    fn rise(&mut self, patch: &Patch) {
        let scene = self.scene;
        let (from, up) = patch.middle();
        // Only if it is higher than what is known.
        let known = self.known.max(self.found.height());
        let at = |height: f64| from + up * height;
        let mut low = known.max(self.distance) + self.finer;
        if !self.is_left(&at(low)) {
            return;
        }
        let mut high = 2.0 * low;
        while self.is_left(&at(high)) {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if self.is_left(&at(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.found.take(at(low), scene.height(&at(low)) - scene.removed.margin);
    }

    fn leave(&mut self, points: &[Vector3<f64>]) {
        self.found.open_count += 1;
        if self.found.open.len() < MOST_OPEN {
            let low = points.iter().fold(points[0], |low, point| low.inf(point));
            let high = points.iter().fold(points[0], |high, point| high.sup(point));
            self.found.open.push([low.into(), high.into()]);
        }
    }
}
