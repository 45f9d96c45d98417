//! Splines of a profile: rational Bézier curves in `(ρ, ζ)`, and their invariants.
//!
//! With positive weights, the direction of travel is a sum of the legs of the control polygon with nonnegative factors
//! (Floater, *Derivatives of rational Bézier curves*, CAGD 9, 1991). So a curve whose legs lie in an open half-plane
//! neither stops nor meets itself, and neither do two joined curves whose legs together lie in one. Curves that fail
//! this are halved.

use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;
use sweepsim_spline::kernel;

/// A rational Bézier curve. Invariants: as many points as positive weights, at least two; the first and the last weight
/// are 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bezier {
    pub points: Vec<Vector2<f64>>,
    pub weights: Vec<f64>,
}

/// A leg at an end of a curve is at least this part of the longest, or the curve stops there.
const STOPS: f64 = 1e-6;

impl Bezier {
    /// In standard form: a change of the parameter makes both end weights 1 (Farin, *Curves and Surfaces for CAGD*,
    /// §13.5).
    pub(super) fn standard(rho: &[f64], zeta: &[f64], weight: &[f64]) -> Self {
        let n = weight.len() - 1;
        let points = (0..=n).map(|i| Vector2::new(rho[i] / weight[i], zeta[i] / weight[i]));
        let pace = (weight[0] / weight[n]).powf(1.0 / n as f64);
        let mut weights: Vec<f64> = (0..=n).map(|i| weight[i] / weight[0] * pace.powi(i as i32)).collect();
        weights[n] = 1.0;
        Self {
            points: points.collect(),
            weights,
        }
    }

    pub fn line(from: Vector2<f64>, to: Vector2<f64>) -> Self {
        Self {
            points: vec![from, to],
            weights: vec![1.0; 2],
        }
    }

    /// Whether all weights are 1.
    pub fn is_polynomial(&self) -> bool {
        self.weights.iter().all(|w| *w == 1.0)
    }

    /// Points times weights, and weights.
    fn homogeneous(&self) -> Vec<Vector3<f64>> {
        let both = self.points.iter().zip(&self.weights);
        both.map(|(p, w)| Vector3::new(p.x * w, p.y * w, *w)).collect()
    }

    /// Both halves. Their weights are not in standard form.
    pub fn halves(&self) -> (Self, Self) {
        let mut high = self.homogeneous();
        let mut low = high.clone();
        kernel::split_line(&mut high, &mut low, 0.5, 0.5);
        let made = |list: Vec<Vector3<f64>>| Self {
            points: list.iter().map(|p| p.xy() / p.z).collect(),
            weights: list.into_iter().map(|p| p.z).collect(),
        };
        let (mut low, mut high) = (made(low), made(high));
        low.points[0] = self.points[0];
        let end = self.points.len() - 1;
        high.points[end] = self.points[end];
        (low, high)
    }

    pub fn at(&self, s: f64) -> Vector2<f64> {
        let point = kernel::evaluate(&mut self.homogeneous(), s).unwrap_or_else(Vector3::z);
        point.xy() / point.z
    }

    pub(super) fn legs(&self) -> impl Iterator<Item = Vector2<f64>> + '_ {
        self.points.windows(2).map(|p| p[1] - p[0])
    }

    /// The unit direction of travel where it begins or ends.
    pub fn direction(&self, end: bool) -> Vector2<f64> {
        let n = self.points.len();
        let (a, b) = if end { (n - 2, n - 1) } else { (0, 1) };
        (self.points[b] - self.points[a]).normalize()
    }

    /// How far rounding of the control points (a few steps of knot insertion each) may turn that direction.
    pub fn direction_error(&self, end: bool) -> f64 {
        let n = self.points.len();
        let (a, b) = if end { (n - 2, n - 1) } else { (0, 1) };
        let size = self.points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        16.0 * f64::EPSILON * size / (self.points[b] - self.points[a]).norm()
    }

    /// Length of the control polygon, at least that of the curve.
    pub fn length(&self) -> f64 {
        self.legs().map(|leg| leg.norm()).sum()
    }

    /// The smallest radius, if some point between the ends reaches the axis, or an end that should not lie on it.
    pub fn reaches_axis(&self, from_axis: bool, to_axis: bool) -> Option<f64> {
        const DEPTH: usize = 48;
        let mut stack = vec![(self.clone(), from_axis, to_axis, 0)];
        while let Some((curve, from, to, depth)) = stack.pop() {
            let end = curve.points.len() - 1;
            let rho = |i: usize| curve.points[i].x;
            let ends = [(rho(0), from), (rho(end), to)];
            if let Some((rho, _)) = ends.iter().find(|(rho, axis)| !axis && *rho <= 0.0) {
                return Some(*rho);
            }
            let least = (0..=end).map(rho).fold(f64::INFINITY, f64::min);
            if least >= 0.0 && (0..=end).any(|i| rho(i) > 0.0) {
                continue;
            }
            if depth == DEPTH {
                return Some(least);
            }
            let (low, high) = curve.halves();
            stack.push((low, from, false, depth + 1));
            stack.push((high, false, to, depth + 1));
        }
        None
    }

    /// Whether it stops at neither end and its legs lie in an open half-plane.
    fn is_direct(&self) -> bool {
        let legs: Vec<f64> = self.legs().map(|leg| leg.norm()).collect();
        let longest = legs.iter().copied().fold(0.0, f64::max);
        legs[0] > STOPS * longest && legs[legs.len() - 1] > STOPS * longest && one_way(self.legs())
    }

    /// Adds parts that are direct.
    ///
    /// # Errors
    /// The parameter where the curve stops or turns more sharply than `grain`.
    pub(super) fn direct_parts(&self, range: [f64; 2], grain: f64, parts: &mut Vec<Self>) -> Result<(), f64> {
        if self.is_direct() && self.length() > grain {
            parts.push(self.clone());
            return Ok(());
        }
        let middle = 0.5 * (range[0] + range[1]);
        if self.length().is_nan() || self.length() <= grain || range[1] - range[0] < 1e-12 {
            return Err(middle);
        }
        let (low, high) = self.halves();
        low.direct_parts([range[0], middle], grain, parts)?;
        high.direct_parts([middle, range[1]], grain, parts)
    }

    pub(super) fn bounds(&self) -> [Vector2<f64>; 2] {
        let first = self.points[0];
        let fold = |[low, high]: [Vector2<f64>; 2], p: &Vector2<f64>| [low.inf(p), high.sup(p)];
        self.points.iter().fold([first, first], fold)
    }
}

/// Whether all nonzero vectors lie in an open half-plane.
pub(super) fn one_way(vectors: impl Iterator<Item = Vector2<f64>>) -> bool {
    let mut first = None;
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for v in vectors.filter(|v| v.norm() > 0.0) {
        let reference: &Vector2<f64> = first.get_or_insert(v);
        let angle = reference.perp(&v).atan2(reference.dot(&v));
        (low, high) = (low.min(angle), high.max(angle));
    }
    // The angles are accurate to a few roundings.
    high - low < PI - 1e-12
}

pub(super) fn apart(a: [Vector2<f64>; 2], b: [Vector2<f64>; 2], near: f64) -> bool {
    (0..2).any(|k| a[0][k] > b[1][k] + near || b[0][k] > a[1][k] + near)
}
