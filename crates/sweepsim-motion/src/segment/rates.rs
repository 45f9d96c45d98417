//! Velocities: of the tip, of the orientation, and in the tool's frame.

use super::compensated::turned_back;
use super::forms::{product, raised, wronskian};
use super::{Kind, Segment, SegmentCurve, SegmentEnd};
use nalgebra::{Matrix3, Vector3};
use sweepsim_spline::kernel;

impl Segment {
    /// Numerators of `b′`, and the same number of positive denominators.
    #[must_use]
    pub fn tip_rate(&self) -> (Vec<Vector3<f64>>, Vec<f64>) {
        match &self.kind {
            Kind::Arc(_) => (vec![self.travel_vector()], vec![1.0]),
            Kind::Curve(curve) => {
                let (rate, factor) = curve.rate();
                let degree = rate.len().max(factor.len()) - 1;
                (raised(&rate, degree), raised(&factor, degree))
            }
        }
    }

    /// Numerators of `A′`, and the same number of positive denominators.
    #[must_use]
    pub fn turn_rate(&self) -> (Vec<Matrix3<f64>>, Vec<f64>) {
        let (turns, weights) = (&self.turns, &self.weights);
        let degree = turns.len() - 1;
        if degree == 0 {
            return (vec![Matrix3::zeros()], vec![1.0]);
        }
        let rate = wronskian(degree, |i, j| turns[j] * weights[i] - turns[i] * weights[j]);
        (raised(&rate, 2 * degree), product(weights, weights, |a, b| a * b))
    }

    /// The velocity in the tool's frame: Bernstein coefficients of `Ω` and of `Aᵀ b′`, both times a common positive
    /// factor. The first has a single coefficient if it is constant; otherwise both have the same degree.
    ///
    /// With a surface normal `N` and its moment `M`, `⟨Ω, M⟩ + ⟨Aᵀ b′, N⟩` is the envelope function times that factor.
    #[must_use]
    pub fn twist(&self) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let curve = match &self.kind {
            Kind::Arc(spin) => {
                let travel = self.travel_vector();
                let back = |turn: &Matrix3<f64>| turned_back(turn, &travel);
                return (vec![self.start().tr_mul(spin)], self.turns.iter().map(back).collect());
            }
            Kind::Curve(curve) => curve,
        };
        // With b′ = B/f and Ω = S/σ the factor is f σ: f S and (σ/ŵ) Âᵀ B.
        let (rate, factor) = curve.rate();
        let mut travel = product(&self.turns, &rate, turned_back);
        if curve.squared {
            travel = product(&self.weights, &travel, |weight, travel| travel * *weight);
        }
        let spin = product(&factor, &curve.spins, |factor, spin| spin * *factor);
        if spin.len() == 1 {
            return (spin, travel);
        }
        let degree = spin.len().max(travel.len()) - 1;
        (raised(&spin, degree), raised(&travel, degree))
    }

    /// The angular velocity and the velocity of the tip at one end, in space, both times a common positive factor.
    #[must_use]
    pub fn velocity(&self, end: SegmentEnd) -> [[f64; 3]; 2] {
        if let Kind::Arc(spin) = &self.kind {
            // The weight is 1 at both ends of a whole arc, but not of its parts.
            let weight = match end {
                SegmentEnd::Start => self.weights[0],
                SegmentEnd::Finish => self.weights[self.weights.len() - 1],
            };
            return [*spin / weight, self.travel_vector()].map(Into::into);
        }
        let (spins, travels) = self.twist();
        match end {
            SegmentEnd::Start => [spins[0], travels[0]].map(|own| (self.start() * own).into()),
            SegmentEnd::Finish => {
                [spins[spins.len() - 1], travels[travels.len() - 1]].map(|own| (self.end() * own).into())
            }
        }
    }
}

impl SegmentCurve {
    /// `B` and `f` with `b′ = B/f`.
    fn rate(&self) -> (Vec<Vector3<f64>>, Vec<f64>) {
        let (points, weights) = (&self.points, &self.point_weights);
        if weights.is_empty() {
            return (kernel::derivative(points).collect(), vec![1.0]);
        }
        let rate = wronskian(points.len() - 1, |i, j| points[j] * weights[i] - points[i] * weights[j]);
        (rate, product(weights, weights, |a, b| a * b))
    }
}

/// Coefficients of `ŵ² Ω` of a rational matrix: the antisymmetric part of `Âᵀ Â′`.
pub(crate) fn spins(turns: &[Matrix3<f64>]) -> Vec<Vector3<f64>> {
    let antisymmetric = |i: usize, j: usize| {
        let m = turns[i].tr_mul(&turns[j]);
        Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5
    };
    match turns.len() {
        1 => vec![Vector3::zeros()],
        n => wronskian(n - 1, antisymmetric),
    }
}
