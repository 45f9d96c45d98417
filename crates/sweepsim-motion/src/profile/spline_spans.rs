//! Splines of a profile: checked, and cut at their knots.

use super::{Bezier, ProfileError, SplineFault};
use nalgebra::Vector2;
use sweepsim_spline::{KnotVector, RationalSpline, SplineError};

/// A piece between knots, and whether the knots make its direction continue smoothly from the previous piece.
pub(super) struct OutlineSpan {
    pub curve: Bezier,
    pub smooth: bool,
}

/// Highest degree: that of the patches of other tools.
const MOST: usize = 7;
/// The normal has the third power of the weight as a factor; with a smaller weight (relative to the largest), it would
/// be lost in rounding.
const LEAST_WEIGHT: f64 = 1e-4;
/// Parts of the outline closer than this fraction of its length count as touching.
pub(super) const NEAR: f64 = 1e-9;
/// The pieces between knots of a spline that begins at `from`.
pub(super) fn spans(
    segment: usize,
    from: Vector2<f64>,
    degree: usize,
    knots: Option<&[f64]>,
    points: &[[f64; 2]],
    weights: Option<&[f64]>,
) -> Result<Vec<OutlineSpan>, ProfileError> {
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
        // Neighbours meet exactly.
        curve.points[0] = at;
        if number + 1 == count {
            curve.points[degree] = end;
        }
        at = curve.points[degree];
        spans.push(OutlineSpan {
            curve,
            smooth: number > 0 && smooth.get(number - 1) == Some(&true),
        });
    }
    Ok(spans)
}
