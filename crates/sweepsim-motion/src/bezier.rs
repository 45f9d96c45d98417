//! Splines of a profile: rational Bézier curves in `(ρ, ζ)`, and what must hold of them.
//!
//! With positive weights the direction of travel is a sum of the legs of the control polygon with factors that are not negative (Floater, *Derivatives of
//! rational Bézier curves*, CAGD 9, 1991). So a curve whose legs lie in an open half-plane neither stops nor meets itself, and neither do two that join
//! where the legs of both lie in one: what is not so is halved.

use crate::profile::{ProfileError, SplineFault};
use nalgebra::Vector2;
use std::f64::consts::PI;
use std::ops::Range;
use sweepsim_spline::{KnotVector, RationalSpline, SplineError};

/// A rational Bézier curve. Invariants: as many points as positive weights, at least two; the first and the last weight are 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bezier {
    pub points: Vec<Vector2<f64>>,
    pub weights: Vec<f64>,
}

/// A piece between knots, and whether the direction goes on smoothly where it begins because the knots say so.
pub(crate) struct Span {
    pub curve: Bezier,
    pub smooth: bool,
}

/// Highest degree: that of the patches of other tools.
const MOST: usize = 7;
/// The normal has the weight's third power as a factor: with a smaller weight (of the largest) it would be lost in rounding.
const LEAST_WEIGHT: f64 = 1e-4;
/// Parts of the outline that are nearer than this part of its length touch.
pub(crate) const NEAR: f64 = 1e-9;
/// A leg at an end of a curve is at least this part of the longest, or the curve stops there.
const STOPS: f64 = 1e-6;

/// The pieces between knots of a spline that begins at `from`.
pub(crate) fn spans(
    segment: usize,
    from: Vector2<f64>,
    degree: usize,
    knots: Option<&[f64]>,
    points: &[[f64; 2]],
    weights: Option<&[f64]>,
) -> Result<Vec<Span>, ProfileError> {
    let fault = |fault| ProfileError::Spline { segment, fault };
    if !(1..=MOST).contains(&degree) {
        return Err(fault(SplineFault::Degree { degree, most: MOST }));
    }
    if points.len() <= degree {
        return Err(fault(SplineFault::Points {
            least: degree + 1,
            found: points.len(),
        }));
    }
    let good = |c: &f64| c.is_finite() && c.abs() < 1e100;
    if !points.iter().flatten().all(good) {
        return Err(ProfileError::NotFinite { segment });
    }
    let ones = vec![1.0; points.len()];
    let weights = weights.unwrap_or(&ones);
    if weights.len() != points.len() {
        return Err(fault(SplineFault::Weights {
            expected: points.len(),
            found: weights.len(),
        }));
    }
    let largest = weights.iter().copied().fold(0.0, f64::max);
    if let Some(index) = weights
        .iter()
        .position(|w| !(w.is_finite() && largest.is_finite() && *w > 0.0 && *w >= LEAST_WEIGHT * largest))
    {
        return Err(fault(SplineFault::Weight {
            index,
            value: weights[index],
        }));
    }
    let knots = match knots {
        Some(knots) if knots.len() != points.len() + degree + 1 => {
            return Err(fault(SplineFault::KnotCount {
                expected: points.len() + degree + 1,
                found: knots.len(),
            }));
        }
        Some(knots) => KnotVector::new(degree, knots.to_vec()),
        None => KnotVector::uniform(degree, points.len() - degree, 0.0, 1.0),
    };
    let knots = knots.map_err(|error| fault(SplineFault::Knots(error)))?;
    let (first, last) = knots.domain();
    let all = knots.knots();
    if all[0] != first || all[all.len() - 1] != last {
        return Err(fault(SplineFault::Clamped));
    }
    let inner: Vec<f64> = knots
        .breakpoints()
        .into_iter()
        .filter(|t| first < *t && *t < last)
        .collect();
    if let Some(&knot) = inner.iter().find(|t| knots.multiplicity(**t) > degree) {
        return Err(fault(SplineFault::Jump { knot }));
    }
    let length: f64 = points
        .windows(2)
        .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]))
        .sum();
    let start = Vector2::from(points[0]);
    if (start - from).norm() > NEAR * length {
        return Err(fault(SplineFault::Start {
            found: points[0],
            expected: from.into(),
        }));
    }
    let flat: Vec<f64> = points.iter().flatten().copied().collect();
    let scaled: Vec<f64> = weights.iter().map(|w| w / largest).collect();
    let smooth: Vec<bool> = inner.iter().map(|t| knots.multiplicity(*t) < degree).collect();
    let not_made = |error: SplineError| fault(SplineFault::Other(error));
    let pieces = RationalSpline::new(vec![knots], 2, &flat, &scaled)
        .and_then(|spline| spline.pieces())
        .map_err(not_made)?;
    let count = pieces.len();
    let (mut at, end) = (from, Vector2::from(points[points.len() - 1]));
    let mut spans = Vec::with_capacity(count);
    for (number, piece) in pieces.into_iter().enumerate() {
        let [rho, zeta] = [0, 1].map(|k| piece.map.numerators()[k].coefficients());
        let weight = piece.map.weight().coefficients();
        let mut curve = Bezier::standard(rho, zeta, weight);
        // Neighbours meet to the bit.
        curve.points[0] = at;
        if number + 1 == count {
            curve.points[degree] = end;
        }
        at = curve.points[degree];
        spans.push(Span {
            curve,
            smooth: number > 0 && smooth.get(number - 1) == Some(&true),
        });
    }
    Ok(spans)
}

impl Bezier {
    /// In standard form: a change of the parameter makes both end weights 1 (Farin, *Curves and Surfaces for CAGD*, §13.5).
    fn standard(rho: &[f64], zeta: &[f64], weight: &[f64]) -> Self {
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

    /// Both halves, by de Casteljau. Their weights are not in standard form.
    fn halves(&self) -> (Self, Self) {
        let mut row: Vec<_> = self
            .points
            .iter()
            .zip(&self.weights)
            .map(|(p, w)| (p * *w, *w))
            .collect();
        let (mut low, mut high) = (vec![row[0]], vec![row[row.len() - 1]]);
        while row.len() > 1 {
            row = row
                .windows(2)
                .map(|p| ((p[0].0 + p[1].0) * 0.5, 0.5 * (p[0].1 + p[1].1)))
                .collect();
            low.push(row[0]);
            high.push(row[row.len() - 1]);
        }
        high.reverse();
        let made = |list: Vec<(Vector2<f64>, f64)>| Self {
            points: list.iter().map(|(p, w)| p / *w).collect(),
            weights: list.into_iter().map(|(_, w)| w).collect(),
        };
        let (mut low, mut high) = (made(low), made(high));
        low.points[0] = self.points[0];
        let end = self.points.len() - 1;
        high.points[end] = self.points[end];
        (low, high)
    }

    pub fn at(&self, s: f64) -> Vector2<f64> {
        let mut row: Vec<_> = self
            .points
            .iter()
            .zip(&self.weights)
            .map(|(p, w)| (p * *w, *w))
            .collect();
        while row.len() > 1 {
            let mix = |p: &[(Vector2<f64>, f64)]| (p[0].0 * (1.0 - s) + p[1].0 * s, p[0].1 * (1.0 - s) + p[1].1 * s);
            row = row.windows(2).map(mix).collect();
        }
        row[0].0 / row[0].1
    }

    fn legs(&self) -> impl Iterator<Item = Vector2<f64>> + '_ {
        self.points.windows(2).map(|p| p[1] - p[0])
    }

    /// The unit direction of travel where it begins or ends.
    pub fn direction(&self, end: bool) -> Vector2<f64> {
        let n = self.points.len();
        let (a, b) = if end { (n - 2, n - 1) } else { (0, 1) };
        (self.points[b] - self.points[a]).normalize()
    }

    /// How far rounding of the control points (some steps of knot insertion each) may turn that direction.
    pub fn direction_error(&self, end: bool) -> f64 {
        let n = self.points.len();
        let (a, b) = if end { (n - 2, n - 1) } else { (0, 1) };
        let size = self.points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        16.0 * f64::EPSILON * size / (self.points[b] - self.points[a]).norm()
    }

    /// Length of the control polygon: no less than the curve's.
    pub fn length(&self) -> f64 {
        self.legs().map(|leg| leg.norm()).sum()
    }

    /// The smallest radius if some point between the ends reaches the axis, or an end that is not said to lie on it.
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
    fn direct_parts(&self, range: [f64; 2], grain: f64, parts: &mut Vec<Self>) -> Result<(), f64> {
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

    fn bounds(&self) -> [Vector2<f64>; 2] {
        let first = self.points[0];
        let fold = |[low, high]: [Vector2<f64>; 2], p: &Vector2<f64>| [low.inf(p), high.sup(p)];
        self.points.iter().fold([first, first], fold)
    }
}

/// Whether vectors (but those that are 0) lie in an open half-plane.
fn one_way(vectors: impl Iterator<Item = Vector2<f64>>) -> bool {
    let mut first = None;
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for v in vectors.filter(|v| v.norm() > 0.0) {
        let reference: &Vector2<f64> = first.get_or_insert(v);
        let angle = reference.perp(&v).atan2(reference.dot(&v));
        (low, high) = (low.min(angle), high.max(angle));
    }
    // The angles are good to a few roundings.
    high - low < PI - 1e-12
}

fn apart(a: [Vector2<f64>; 2], b: [Vector2<f64>; 2], near: f64) -> bool {
    (0..2).any(|k| a[0][k] > b[1][k] + near || b[0][k] > a[1][k] + near)
}

/// An outline of curves: where it meets itself.
pub(crate) struct Outline {
    /// Direct parts in order, each with the number of its segment.
    parts: Vec<(usize, Bezier)>,
    near: f64,
}

impl Outline {
    /// From curves in order, with the numbers of their segments.
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

    /// Two segments (or one twice) that cross or touch.
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
