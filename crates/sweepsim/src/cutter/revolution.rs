//! Surfaces of revolution as products of a circle and a meridian, which are faster to evaluate.

use crate::algebra::quad::{Quad, add, blend, mix, quadratics};
use crate::time::placement::{Placing, Twisted};
use sweepsim_motion::Revolved;

/// A surface of revolution, with its forms side by side for each polynomial.
#[derive(Clone, Debug)]
pub(crate) struct Revolution {
    /// Cosine, sine and weight.
    circle: [[f64; 4]; 3],
    /// As in [`Revolved`].
    meridian: [[f64; 6]; 3],
}

impl Revolution {
    pub fn new(revolved: &Revolved) -> Self {
        let [c, s, w] = revolved.circle();
        Self {
            circle: [0, 1, 2].map(|i| [c[i], s[i], w[i], 0.0]),
            meridian: [0, 1, 2].map(|i| revolved.meridian().map(|form| form[i])),
        }
    }

    /// The products with a placing, at `(u, v)`.
    pub fn at<'a>(&self, placing: &'a Placing, [u, v]: [f64; 2]) -> Turned<'a> {
        let ([in_u, slopes_u], [in_v, slopes_v]) = (quadratics(u), quadratics(v));
        Turned {
            placing,
            circle: [blend(&in_u, &self.circle), blend(&slopes_u, &self.circle)],
            meridian: [blend(&in_v, &self.meridian), blend(&slopes_v, &self.meridian)],
        }
    }
}

/// A point of a patch in space: position, both derivatives, normal.
pub(crate) struct PatchPoint {
    pub place: Quad,
    pub slopes: [Quad; 2],
    pub normal: Quad,
}

/// Values and derivatives of the forms of a surface of revolution.
pub(crate) struct Turned<'a> {
    placing: &'a Placing,
    circle: [[f64; 4]; 2],
    meridian: [[f64; 6]; 2],
}

impl Turned<'_> {
    /// `T F + o = (ρ (c T₁ + s T₂) + ζ w T₃)/(w ω) + o`.
    pub fn point(&self) -> PatchPoint {
        let [a, b, third] = &self.placing.turn;
        let [[c, s, w, _], [dc, ds, dw, _]] = self.circle;
        let [[rho, zeta, omega, n_rho, n_zeta, _], [d_rho, d_zeta, d_omega, ..]] = self.meridian;
        let inverse = 1.0 / (w * omega);
        let (out, out_u) = (mix(c, a, s, b), mix(dc, a, ds, b));
        let (p, q) = (rho * inverse, zeta * inverse);
        let arm = mix(p, &out, q * w, third);
        let along_u = mix(p, &out_u, q * dw, third);
        let along_v = mix(d_rho * inverse, &out, d_zeta * inverse * w, third);
        let (by_u, by_v) = (dw * omega * inverse, w * d_omega * inverse);
        PatchPoint {
            place: add(&arm, &self.placing.origin),
            slopes: [mix(1.0, &along_u, -by_u, &arm), mix(1.0, &along_v, -by_v, &arm)],
            normal: mix(n_rho, &out, n_zeta * w, third),
        }
    }

    /// The effect of a velocity on the circle or its derivative, to be multiplied by `n_ρ`, `n_ζ` and `m`.
    fn parts(&self, twist: &Twisted, d: usize) -> [f64; 3] {
        let [c, s, w, _] = self.circle[d];
        let [a, b, z, _] = twist.travel;
        [a * c + b * s, z * w, twist.spin[1] * c - twist.spin[0] * s]
    }

    fn sum(&self, [out, up, turn]: [f64; 3], d: usize) -> f64 {
        let [_, _, _, n_rho, n_zeta, m] = self.meridian[d];
        n_rho * out + n_zeta * up + m * turn
    }

    /// `⟨spin, M⟩ + ⟨travel, N⟩` of a velocity.
    pub fn envelope(&self, twist: &Twisted) -> f64 {
        self.sum(self.parts(twist, 0), 0)
    }

    /// The same, and its derivatives in `u` and in `v`.
    pub fn envelopes(&self, twist: &Twisted) -> [f64; 3] {
        let own = self.parts(twist, 0);
        [self.sum(own, 0), self.sum(self.parts(twist, 1), 0), self.sum(own, 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::quad::vector;
    use crate::cutter::patch_forms::PatchForms;
    use nalgebra::{Rotation3, Vector3};
    use sweepsim_motion::Tool;
    use sweepsim_props::*;

    fn near(a: &Quad, b: &Quad, error: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= error)
    }

    proptest! {
        /// Three evaluations of surfaces of revolution agree: products of circle and meridian in their own frame, tensors, and
        /// the original patch, with finite differences for its derivatives.
        #[test]
        fn products_agree_with_tensors(
            at in [0.01..0.99, 0.01..0.99], radius in 0.5..20.0, turn in [-3.0..3.0, -3.0..3.0, -3.0..3.0],
            tip in [-50.0..50.0, -50.0..50.0, -50.0..50.0], spin in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
        ) {
            let turn = Rotation3::new(Vector3::from(turn)).into_inner();
            let (tip, spin) = (Vector3::from(tip), Vector3::from(spin));
            let travel = Vector3::new(spin.z, 1.0 - spin.x, spin.y);
            for tool in [Tool::ball(radius, 3.0 * radius), Tool::bull(radius, 0.3 * radius, 2.0 * radius)] {
                let tool = tool.unwrap();
                for (element, patch) in PatchForms::all(&tool).0.iter().zip(tool.patches()) {
                    let own = Placing::new(&turn, &tip, None);
                    let (point, fields) = element.point(&own, at);
                    let g = fields.envelopes(&Twisted::new(&spin, &travel, None));
                    // A few dozen roundings of numbers of the size of the place, of the tool, and of normals of size 1 with their slopes.
                    let size = 100.0 + 10.0 * radius;
                    if let Some(revolution) = &element.revolution {
                        let frame = element.frame();
                        let placing = Placing::new(&turn, &tip, frame);
                        let turned = revolution.at(&placing, at);
                        let short = turned.point();
                        prop_assert!(near(&short.place, &point.place, 1e-14 * size));
                        for axis in 0..2 {
                            prop_assert!(near(&short.slopes[axis], &point.slopes[axis], 1e-13 * size));
                        }
                        prop_assert!(near(&short.normal, &point.normal, 1e-13));
                        let twist = Twisted::new(&spin, &travel, frame);
                        let both = turned.envelopes(&twist);
                        for d in 0..3 {
                            prop_assert!((both[d] - g[d]).abs() <= 1e-13 * size, "{d}: {} {}", both[d], g[d]);
                        }
                        prop_assert_eq!(turned.envelope(&twist), both[0]);
                    }
                    let written = |u: f64, v: f64| turn * Vector3::from(patch.point(u, v)) + tip;
                    let [u, v] = at;
                    prop_assert!((vector(&point.place) - written(u, v)).amax() <= 1e-13 * size);
                    let h = 1e-5;
                    let differences = [
                        (written(u + h, v) - written(u - h, v)) / (2.0 * h),
                        (written(u, v + h) - written(u, v - h)) / (2.0 * h),
                    ];
                    for axis in 0..2 {
                        // Third derivatives are below 100 times the radius.
                        prop_assert!((vector(&point.slopes[axis]) - differences[axis]).amax() <= 1e-7 * size);
                    }
                }
            }
        }
    }
}
