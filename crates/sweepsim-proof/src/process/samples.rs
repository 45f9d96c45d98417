//! Circles and points that bound a zone of a moving solid.

use super::ring::{Ring, across};
use crate::motion::{Placement, Stretch};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Angles around the axis of a tool on a stretch, from a direction that turns with it.
pub(super) struct Turned<'a> {
    pub stretch: &'a Stretch,
    from: Vector3<f64>,
}

/// A tool that turns by more in a stretch has no angles.
const MOST_TURNED: f64 = 1.8;
/// The direction from which angles are measured turns about the axis by no more than so many times as the axis turns.
///
/// It is that of a fixed vector, less its part along the axis `a`. At the middle that is nothing, so it is at most
/// `s = sin(MOST_TURNED/2)` at other times; and the direction turns at the rate `|a′| s/√(1 − s²)`.
const SPIN: f64 = 1.3;

impl<'a> Turned<'a> {
    pub fn new(stretch: &'a Stretch) -> Self {
        Self {
            stretch,
            from: across(&stretch.at(0.5).axis),
        }
    }

    pub fn has_angles(&self) -> bool {
        self.stretch.turning() <= MOST_TURNED
    }

    /// By how much a point of the tool may leave its angle in a time.
    pub fn spin(&self, duration: f64) -> f64 {
        SPIN * self.stretch.turning() * duration
    }

    pub fn point(&self, at: &Placement, [radius, height]: [f64; 2], angle: f64) -> Vector3<f64> {
        let x = (self.from - at.axis * self.from.dot(&at.axis)).normalize();
        let (sin, cos) = angle.sin_cos();
        at.tip + at.axis * height + (x * cos + at.axis.cross(&x) * sin) * radius
    }
}

/// Rings whose hull holds a zone.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples {
    pub rings: SmallVec<[Ring; 16]>,
    /// How many are at the same height, one after the other: the first two at the ends of an angle.
    pub across: usize,
    /// How many are at the first of two times; 0 if that is not known.
    pub first: usize,
}

impl Samples {
    pub fn of_points(points: &[Vector3<f64>]) -> Self {
        Self {
            rings: points.iter().map(|point| Ring::point(*point)).collect(),
            ..Self::default()
        }
    }

    /// Whether of two rings that differ by time, by height or by angle alone, one is held and the other is not.
    pub fn mixed(&self, held: &[bool]) -> [bool; 3] {
        let each = if self.first > 0 { self.first } else { held.len() };
        let differ = |a: usize, b: usize| b < held.len() && held[a] != held[b];
        let mut mixed = [false; 3];
        for k in 0..held.len() {
            mixed[0] |= differ(k, k + each);
            mixed[1] |= k % each + self.across < each && differ(k, k + self.across);
            mixed[2] |= self.across > 1 && k % self.across == 0 && differ(k, k + 1);
        }
        mixed
    }

    /// Whether all rings are points.
    pub fn are_points(&self) -> bool {
        self.across > 1
    }

    /// The rings at the first and the last time.
    pub fn ends(&self) -> Option<[&[Ring]; 2]> {
        let (first, last) = self.rings.split_at(self.first);
        (!first.is_empty() && !last.is_empty()).then_some([first, last])
    }

    pub fn middle(&self) -> Vector3<f64> {
        self.rings.iter().map(|ring| ring.centre).sum::<Vector3<f64>>() / self.rings.len() as f64
    }

    pub fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let (low, high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        self.rings.iter().fold((low, high), |(low, high), ring| {
            let extent = ring.extent();
            (low.inf(&(ring.centre - extent)), high.sup(&(ring.centre + extent)))
        })
    }

    /// How far a point of the hull may be from another point.
    pub fn extent(&self, from: &Vector3<f64>) -> f64 {
        let own = self
            .rings
            .iter()
            .map(|ring| (ring.centre - from).norm() + ring.radius + ring.thick);
        own.fold(0.0, f64::max)
    }

    pub fn corners(&self) -> SmallVec<[Vector3<f64>; 12]> {
        let mut corners = SmallVec::new();
        self.rings.iter().for_each(|ring| ring.corners(&mut corners));
        corners
    }
}
