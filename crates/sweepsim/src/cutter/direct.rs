//! Normals from the position's own derivatives, where their forms have many times its degree.
//!
//! `N = s w⁴ (F_u × F_v)` and `M = F × N` with their derivatives take the second-order jet of `F`, of 16 control points for a bicubic patch, where the forms
//! of `N` and `M` have 81 coefficients each. Both are the same function, which the forms bound over boxes.

use crate::algebra::quad::{Quad, add, cross, dot, mix, quad};
use crate::algebra::table::Table;
use crate::cutter::errors::{Errors, flat_at};
use crate::cutter::places::Places;
use crate::time::pieces::Sizes;
use crate::time::placement::Twisted;
use nalgebra::Vector3;
use sweepsim_motion::Patch;
use sweepsim_spline::Bernstein;

/// A patch whose normals are products of its derivatives.
#[derive(Clone, Debug)]
pub(crate) struct Direct {
    /// The homogeneous position relative to `centre`, so that its derivatives are differences of small numbers.
    places: Places,
    centre: Vector3<f64>,
    /// `s`.
    factor: f64,
    /// The weight, if it is constant.
    constant: Option<f64>,
    /// For each variable, whether `N` is divided by the distance from its lower and its upper side.
    sides: [[bool; 2]; 2],
    /// Bounds of the rounding errors of `M` and `N`.
    pub rounding: Sizes,
    /// Those of `F_u` and `F_v`.
    pub of_slopes: Sizes,
}

/// Nearer to a pole, normals are left to their forms: divided by the distance, the rounding errors of their products would be too large.
const POLE: f64 = 1.0 / 16.0;

/// A point relative to the tool, its derivatives, and `N`.
pub(crate) struct Site {
    pub place: Quad,
    pub slopes: [Quad; 2],
    pub normal: Quad,
    /// Derivatives in `uu`, `uv` and `vv`.
    second: [Quad; 3],
    /// `N` is this many times the product of the slopes, and the relative change of that factor in `u` and in `v`.
    size: f64,
    grown: [f64; 2],
}

/// What all evaluations of a point begin with.
struct First {
    /// The position about the centre.
    f: Quad,
    slopes: [Quad; 2],
    /// One over the weight.
    inverse: f64,
    /// As in [`Site`].
    size: f64,
}

fn scaled(a: &Quad, factor: f64) -> Quad {
    a.map(|x| factor * x)
}

impl Direct {
    /// `None` if the normals have another form.
    pub fn new(patch: &Patch) -> Option<Self> {
        let factor = patch.product()?;
        let weight = patch.weight();
        let first = weight.coefficients()[0];
        let constant = weight.coefficients().iter().all(|w| *w == first).then_some(first);
        let degrees = [0, 1].map(|axis| {
            let own = patch.position().iter().map(|form| form.degree(axis)).max();
            own.unwrap_or(0).max(weight.degree(axis))
        });
        let middle = patch.point(0.5, 0.5);
        let flat = [0, 1, 2].map(|k| flat_at(patch, k));
        let centre = Vector3::from_fn(|k, _| flat[k].unwrap_or(middle[k]));
        let raised = |form: &Bernstein| form.elevated_to(&degrees);
        let shifted = [0, 1, 2].map(|k| match flat[k] {
            Some(_) => raised(&Bernstein::constant(2, 0.0)),
            None => raised(&patch.position()[k]).sub(&raised(&weight.scale(centre[k]))),
        });
        let [x, y, z] = shifted.clone();
        // Of the shift, whose terms are as large as the distance from the origin: of a product, and four of each raise of a degree.
        let shift = std::array::from_fn(|k| {
            if flat[k].is_some() {
                return 0.0;
            }
            let form = &patch.position()[k];
            let raises = [form, weight].map(|form| [0, 1].map(|axis| degrees[axis] - form.degree(axis)));
            let roundings = 1 + 4 * raises.map(|[u, v]| u + v).into_iter().max().unwrap_or(0);
            roundings as f64 * f64::EPSILON * (form.magnitude() + centre[k].abs() * weight.magnitude())
        });
        let sides = patch.shrunk_sides();
        let divisions = sides.as_flattened().iter().filter(|side| **side).count();
        let growth = POLE.recip().powi(divisions as i32) * (1.0 + 4.0 * f64::EPSILON);
        let table = Table::new(&[x, y, z, raised(weight)], degrees);
        let places = Places::new(table);
        let magnitudes = [0, 1, 2, 3].map(|k| shifted.get(k).unwrap_or(weight).magnitude());
        let errors = Errors::new((&shifted, weight), places.roundings(magnitudes), shift);
        let rounding = errors
            .of_fields(&centre, factor)
            .map(|sizes| sizes.map(|size| growth * size));
        Some(Self {
            sides,
            places,
            centre,
            factor,
            constant,
            rounding,
            of_slopes: errors.of_slopes(),
        })
    }

    /// The point that the position is taken about, near the middle of the patch.
    pub fn centre(&self) -> &Vector3<f64> {
        &self.centre
    }

    /// Whether `(u, v)` is not close to a pole.
    #[inline]
    pub fn covers(&self, at: [f64; 2]) -> bool {
        let far = |axis: usize| {
            let [lower, upper] = self.sides[axis];
            (!lower || at[axis] >= POLE) && (!upper || at[axis] <= 1.0 - POLE)
        };
        far(0) && far(1)
    }

    /// Whether no point of a cell is [covered](Self::covers), nor any one a little outside it.
    pub fn is_at_pole(&self, lower: [f64; 2], upper: [f64; 2]) -> bool {
        let close = |axis: usize| {
            let [at_lower, at_upper] = self.sides[axis];
            (at_lower && upper[axis] < 0.5 * POLE) || (at_upper && lower[axis] > 1.0 - 0.5 * POLE)
        };
        close(0) || close(1)
    }

    /// The product of the distances by which `N` is divided, and the quotients of its derivatives and itself.
    #[inline]
    fn divisor(&self, at: [f64; 2]) -> (f64, [f64; 2]) {
        let (mut product, mut slopes) = (1.0, [0.0; 2]);
        for axis in 0..2 {
            let [lower, upper] = self.sides[axis];
            if lower {
                product *= at[axis];
                slopes[axis] += 1.0 / at[axis];
            }
            if upper {
                product *= 1.0 - at[axis];
                slopes[axis] -= 1.0 / (1.0 - at[axis]);
            }
        }
        (product, slopes)
    }

    /// The position about the centre, both slopes, and how many times their product is `N`, from values and first derivatives of the forms.
    #[inline(always)]
    fn first(&self, at: [f64; 2], [p, pu, pv]: [&Quad; 3]) -> First {
        let plain = |[x, y, z, _]: &Quad| [*x, *y, *z, 0.0];
        let weight = self.constant.unwrap_or(p[3]);
        let inverse = 1.0 / weight;
        let f = scaled(&plain(p), inverse);
        let slopes = if self.constant.is_some() {
            [pu, pv].map(|p| scaled(&plain(p), inverse))
        } else {
            // The quotient rule, solved for the highest derivative.
            [pu, pv].map(|p| scaled(&mix(1.0, &plain(p), -p[3], &f), inverse))
        };
        let mut size = self.factor * (weight * weight) * (weight * weight);
        if self.has_poles() {
            size /= self.divisor(at).0;
        }
        First {
            f,
            slopes,
            inverse,
            size,
        }
    }

    fn has_poles(&self) -> bool {
        self.sides != [[false; 2]; 2]
    }

    /// The point at `(u, v)` relative to the tool, both slopes, and `N`.
    #[inline]
    pub fn tangent(&self, at: [f64; 2]) -> (Quad, [Quad; 2], Quad) {
        let [p, pu, pv] = self.places.slopes(at);
        let First { f, slopes, size, .. } = self.first(at, [&p, &pu, &pv]);
        let [fu, fv] = &slopes;
        let normal = scaled(&cross(fu, fv), size);
        (add(&f, &quad(&self.centre)), slopes, normal)
    }

    /// The point at `(u, v)` relative to the tool, and `⟨spin, M⟩ + ⟨travel, N⟩` there, as [`at`](Self::at) computes them; `None` if it has to be used.
    #[inline]
    pub fn value(&self, at: [f64; 2], twist: &Twisted) -> Option<(Quad, f64)> {
        let Places::Bicubic(_) = &self.places else {
            return None;
        };
        let (place, _, normal) = self.tangent(at);
        Some((place, dot(&normal, &velocity(&place, twist))))
    }

    /// The place of that point alone.
    #[inline]
    pub fn place(&self, at: [f64; 2]) -> Option<Quad> {
        let Places::Bicubic(_) = &self.places else {
            return None;
        };
        Some(self.tangent(at).0)
    }

    /// The point at `(u, v)`, if it is [covered](Self::covers).
    pub fn at(&self, at: [f64; 2]) -> Site {
        let jet = self.places.jet(at);
        let [p, pu, pv, puu, puv, pvv] = &jet;
        let First {
            f,
            slopes: [fu, fv],
            inverse,
            size,
        } = self.first(at, [p, pu, pv]);
        let (second, mut grown);
        if self.constant.is_some() {
            second = [puu, puv, pvv].map(|[x, y, z, _]| scaled(&[*x, *y, *z, 0.0], inverse));
            grown = [0.0; 2];
        } else {
            let [wu, wv] = [pu[3], pv[3]];
            let curvature = |p: &Quad, [a, b]: [f64; 2]| {
                let rest = mix(1.0, &mix(1.0, p, -p[3], &f), -1.0, &mix(a, &fv, b, &fu));
                scaled(&[rest[0], rest[1], rest[2], 0.0], inverse)
            };
            second = [
                curvature(puu, [0.0, 2.0 * wu]),
                curvature(puv, [wu, wv]),
                curvature(pvv, [2.0 * wv, 0.0]),
            ];
            grown = [4.0 * wu * inverse, 4.0 * wv * inverse];
        }
        if self.has_poles() {
            let (_, slopes) = self.divisor(at);
            grown = [grown[0] - slopes[0], grown[1] - slopes[1]];
        }
        Site {
            place: add(&f, &quad(&self.centre)),
            normal: scaled(&cross(&fu, &fv), size),
            slopes: [fu, fv],
            second,
            size,
            grown,
        }
    }
}

/// `travel + spin × F`.
#[inline]
fn velocity(place: &Quad, twist: &Twisted) -> Quad {
    add(&twist.travel, &cross(&twist.spin, place))
}

/// `⟨spin, M⟩ + ⟨travel, N⟩ = ⟨N, V⟩`, with the velocity `V = travel + spin × F`: the forms of `M` are needed for bounds, not for values. Rounding errors are those of
/// `M = F × N`, in another order.
impl Site {
    /// `⟨spin, M⟩ + ⟨travel, N⟩`.
    pub fn envelope(&self, twist: &Twisted) -> f64 {
        dot(&self.normal, &velocity(&self.place, twist))
    }

    /// The same, and its derivatives in `u` and in `v`.
    pub fn envelopes(&self, twist: &Twisted) -> [f64; 3] {
        let velocity = velocity(&self.place, twist);
        let [fu, fv] = &self.slopes;
        let [fuu, fuv, fvv] = &self.second;
        let g = dot(&self.normal, &velocity);
        // ⟨F_uu × F_v, V⟩ = ⟨F_uu, F_v × V⟩, and so on.
        let (with_u, with_v) = (cross(fv, &velocity), cross(&velocity, fu));
        let turned = cross(&self.normal, &twist.spin);
        let slope = |in_u: &Quad, in_v: &Quad, own: &Quad, grown: f64| {
            self.size * (dot(in_u, &with_u) + dot(in_v, &with_v)) + grown * g + dot(&turned, own)
        };
        [
            g,
            slope(fuu, fuv, fu, self.grown[0]),
            slope(fuv, fvv, fv, self.grown[1]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::ranges::range_of;
    use proptest::prelude::*;

    /// `N` and `M` one after the other, and their derivatives: what a velocity along an axis, or a turn about it, makes of them.
    fn lists(direct: &Direct, at: [f64; 2]) -> [[f64; 6]; 3] {
        let site = direct.at(at);
        let unit = |k: usize| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
        let zero = [0.0; 4];
        let twist = |k: usize| Twisted {
            travel: if k < 3 { unit(k) } else { zero },
            spin: if k < 3 { zero } else { unit(k - 3) },
        };
        let all: [[f64; 3]; 6] = std::array::from_fn(|k| site.envelopes(&twist(k)));
        assert!((0..6).all(|k| site.envelope(&twist(k)) == all[k][0]));
        if let Some((place, g)) = direct.value(at, &twist(4)) {
            assert_eq!((place, g), (site.place, all[4][0]));
        }
        std::array::from_fn(|d| std::array::from_fn(|k| all[k][d]))
    }

    fn form(degrees: [usize; 2], value: &dyn Fn(usize) -> f64) -> Bernstein {
        let count = (degrees[0] + 1) * (degrees[1] + 1);
        Bernstein::new(&degrees, (0..count).map(value).collect()).unwrap()
    }

    proptest! {
        /// Normals and moments from derivatives are those of the patch's own forms, within the bound of their rounding.
        #[test]
        fn products_of_derivatives_are_the_normals(
            degrees in prop_oneof![Just([3, 3]), [1_usize..5, 1_usize..5]], rational in any::<bool>(), at in [0.0..=1.0, 0.0..=1.0],
            bumps in proptest::collection::vec(-0.08..0.08, 25), weights in proptest::collection::vec(0.6..1.6, 25),
            centre in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
        ) {
            let [p, q] = degrees;
            let (x, y) = (|i: usize| (i % (p + 1)) as f64 / p as f64, |i: usize| (i / (p + 1)) as f64 / q as f64);
            let weight = |i: usize| if rational { weights[i] } else { 2.0 };
            let position = [
                form(degrees, &|i| weight(i) * (centre[0] + 3.0 * x(i))),
                form(degrees, &|i| weight(i) * (centre[1] + y(i))),
                form(degrees, &|i| weight(i) * (centre[2] + bumps[i])),
            ];
            // Bumps may make a fold, which is no patch.
            let Ok(patch) = Patch::new(position, form(degrees, &weight)) else { return Ok(()) };
            let direct = Direct::new(&patch).unwrap();
            let site = direct.at(at);
            let place = patch.point(at[0], at[1]);
            for k in 0..3 {
                prop_assert!((site.place[k] - place[k]).abs() <= 1e-12);
            }
            let forms: Vec<&Bernstein> = patch.field().normal().iter().chain(patch.field().moment()).collect();
            for (k, form) in forms.iter().enumerate() {
                let error = direct.rounding[1 - k / 3][k % 3] + 64.0 * f64::EPSILON * form.magnitude();
                let lists = lists(&direct, at);
                let value = form.evaluate(&at);
                prop_assert!((lists[0][k] - value).abs() <= error, "{k}: {} {value} {error}", lists[0][k]);
                for axis in 0..2 {
                    let slope = form.derivative(axis).evaluate(&at);
                    prop_assert!((lists[1 + axis][k] - slope).abs() <= 1e3 * error + 1e-9);
                }
            }
            // The bound is no more than what a thousand roundings of the coordinates make, along slopes of at most 4 · 3 · 1.6 / 0.6 each way.
            let (_, most) = range_of(direct.rounding[1]);
            let farthest = centre.iter().fold(0.0_f64, |most, c: &f64| most.max(c.abs())) + 3.0;
            prop_assert!(most < 1e3 * f64::EPSILON * farthest * 2.0 * 32.0, "{most}");
        }

        /// The same where a side has shrunk to a point, and the normals are divided by the distance from it.
        #[test]
        fn normals_near_a_pole_are_those_of_the_forms(
            upper in any::<bool>(), bumps in proptest::collection::vec(-0.08..0.08, 16), at in [0.0..=1.0, 0.0..=1.0],
            rational in any::<bool>(), weights in proptest::collection::vec(0.9..1.1, 16), pole in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
        ) {
            // A sector about a line along z: v is the distance from the pole, or 1 less it. The pole may be far from the origin.
            let far = |i: usize| (if upper { 3 - i / 4 } else { i / 4 }) as f64 / 3.0;
            let angle = |i: usize| (i % 4) as f64 / 3.0 * if upper { -1.0 } else { 1.0 };
            let weight = |i: usize| if rational { weights[i] } else { 1.0 };
            let pole = if rational { pole } else { [0.0; 3] };
            let position = [
                form([3, 3], &|i| weight(i) * (pole[0] + far(i) * f64::cos(angle(i)))),
                form([3, 3], &|i| weight(i) * (pole[1] + far(i) * f64::sin(angle(i)))),
                form([3, 3], &|i| weight(i) * (pole[2] + far(i) * (1.0 + bumps[i]))),
            ];
            let patch = Patch::new(position, form([3, 3], &weight)).unwrap();
            prop_assert_eq!(patch.shrunk_sides(), [[false; 2], [!upper, upper]]);
            let direct = Direct::new(&patch).unwrap();
            prop_assume!(direct.covers(at));
            let lists = lists(&direct, at);
            let forms: Vec<&Bernstein> = patch.field().normal().iter().chain(patch.field().moment()).collect();
            for (k, form) in forms.iter().enumerate() {
                let error = direct.rounding[1 - k / 3][k % 3] + 64.0 * f64::EPSILON * form.magnitude();
                let value = form.evaluate(&at);
                prop_assert!((lists[0][k] - value).abs() <= error, "{k}: {} {value} {error}", lists[0][k]);
                for axis in 0..2 {
                    let slope = form.derivative(axis).evaluate(&at);
                    prop_assert!((lists[1 + axis][k] - slope).abs() <= 1e3 * error + 1e-9);
                }
            }
        }
    }
}
