//! The sides of patches as curves.

use super::{NormalField, Patch, Side};
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// The number of points at which two stretches are compared.
pub(super) const PLACES: usize = 17;
/// A side as a curve in `r` from 0 to 1, with the normals of its patch.
pub(super) struct SideCurve {
    pub(super) patch: usize,
    pub(super) side: Side,
    pub(super) position: [Bernstein; 3],
    pub(super) weight: Bernstein,
    pub(super) field: NormalField,
    pub(super) places: Vec<Vector3<f64>>,
    /// A box that is certain to contain it: lower and upper corner.
    pub(super) bounds: [Vector3<f64>; 2],
}

impl SideCurve {
    pub(super) fn new(patches: &[Patch], patch: usize, side: Side) -> Self {
        let (axis, at, backwards) = match side {
            Side::Bottom => (1, 0.0, false),
            Side::Right => (0, 1.0, false),
            Side::Top => (1, 1.0, true),
            Side::Left => (0, 0.0, true),
        };
        let cut = |form: &Bernstein| {
            let form = form.slice(axis, at);
            let form = if backwards { form.reverse(0) } else { form };
            form.assumed_exact()
        };
        let three = |forms: &[Bernstein; 3]| [0, 1, 2].map(|k| cut(&forms[k]));
        let of = &patches[patch];
        let mut curve = Self {
            patch,
            side,
            places: Vec::new(),
            bounds: [Vector3::zeros(); 2],
            field: NormalField {
                normal: three(&of.field.normal),
                moment: three(&of.field.moment),
            },
            position: three(&of.position),
            weight: cut(&of.weight),
        };
        curve.places = (0..PLACES).map(|n| curve.at(part(n))).collect();
        // The hull of the control points.
        let weights = curve.weight.coefficients();
        let control = |i: usize| Vector3::from([0, 1, 2].map(|k| curve.position[k].coefficients()[i] / weights[i]));
        let points = || (0..weights.len()).map(control);
        curve.bounds = [
            points().fold(Vector3::repeat(f64::INFINITY), |a, b| a.inf(&b)),
            points().fold(Vector3::repeat(f64::NEG_INFINITY), |a, b| a.sup(&b)),
        ];
        curve
    }

    /// Whether it is a point.
    pub(super) fn is_pole(&self, tolerance: f64) -> bool {
        self.places
            .iter()
            .all(|place| (place - self.places[0]).norm() <= tolerance)
    }

    pub(super) fn at(&self, r: f64) -> Vector3<f64> {
        let w = self.weight.evaluate(&[r]);
        Vector3::from([0, 1, 2].map(|k| self.position[k].evaluate(&[r]) / w))
    }

    /// `F′` at `r`.
    pub(super) fn slope(&self, r: f64) -> Vector3<f64> {
        let mut gradient = [0.0];
        let w = self.weight.evaluate_gradient(&[r], &mut gradient);
        let w_slope = gradient[0];
        Vector3::from([0, 1, 2].map(|k| {
            let p = self.position[k].evaluate_gradient(&[r], &mut gradient);
            (gradient[0] - p / w * w_slope) / w
        }))
    }

    /// The unit normal of the patch at `r`; `None` at a pole, where it vanishes.
    pub(super) fn normal(&self, r: f64) -> Option<Vector3<f64>> {
        let normal = Vector3::from([0, 1, 2].map(|k| self.field.normal[k].evaluate(&[r])));
        normal.try_normalize(1e-12)
    }

    /// The same; at a pole, the normal beside it.
    pub(super) fn normal_or_beside(&self, r: f64) -> Vector3<f64> {
        let inside = r + (0.5 - r) * 1e-6;
        let found = self.normal(r).or_else(|| self.normal(inside));
        found.unwrap_or_else(Vector3::zeros)
    }

    /// The parameter between `from` and `to` nearest to a point, and the distance.
    pub(super) fn nearest(&self, point: &Vector3<f64>, [from, to]: [f64; 2]) -> (f64, f64) {
        const STEPS: usize = 4 * PLACES;
        let distance = |r: f64| (self.at(r) - point).norm();
        let step = (to - from) / STEPS as f64;
        let samples = (0..=STEPS).map(|n| from + step * n as f64);
        let mut best = samples
            .map(|r| (r, distance(r)))
            .fold((from, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
        let (low, high) = ((best.0 - step).max(from), (best.0 + step).min(to));
        for _ in 0..20 {
            let slope = self.slope(best.0);
            let by = (point - self.at(best.0)).dot(&slope) / slope.norm_squared();
            let next = (best.0 + by).clamp(low, high);
            let there = distance(next);
            if !(there < best.1) {
                break;
            }
            best = (next, there);
        }
        best
    }

    /// Whether a point may be within the tolerance of it.
    pub(super) fn may_hold(&self, point: &Vector3<f64>, tolerance: f64) -> bool {
        let [low, high] = &self.bounds;
        (0..3).all(|k| low[k] - tolerance <= point[k] && point[k] <= high[k] + tolerance)
    }
}

pub(super) fn part(n: usize) -> f64 {
    n as f64 / (PLACES - 1) as f64
}
