//! Normals from the position's own derivatives, where their forms have many times its degree.
//!
//! `N = s w⁴ (F_u × F_v)` and `M = F × N` with their derivatives take the second-order jet of `F`, of 16 control points for a bicubic patch, where the forms
//! of `N` and `M` have 81 coefficients each. Both are the same function, which the forms bound over boxes. On a flat patch `N = w n` with a constant vector `n`, near poles
//! and elsewhere.

use crate::algebra::quad::{Quad, add, cross, dot, mix, quad};
use crate::algebra::table::Table;
use crate::cutter::errors::{Errors, flat_at};
use crate::cutter::places::Places;
use crate::time::pieces::Sizes;
use crate::time::placement::Twisted;
use nalgebra::Vector3;
use sweepsim_motion::Patch;
use sweepsim_spline::Bernstein;

/// A patch whose normals are products of its derivatives, or those of a plane.
#[derive(Clone, Debug)]
pub(crate) struct Direct {
    /// The homogeneous position relative to `centre`, so that its derivatives are differences of small numbers.
    places: Places,
    centre: Vector3<f64>,
    normals: Normals,
    /// The weight, if it is constant.
    constant: Option<f64>,
    /// For each variable, whether `N` is divided by the distance from its lower and its upper side.
    sides: [[bool; 2]; 2],
    /// Bounds of the rounding errors of `M` and `N`.
    pub rounding: Sizes,
    /// Those of `F_u` and `F_v`.
    pub of_slopes: Sizes,
}

/// What `N` is.
#[derive(Clone, Copy, Debug)]
enum Normals {
    /// `s`.
    Product(f64),
    /// `n`.
    Plane(Quad),
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
    /// What changes in `N` as in the product of the slopes is this many times that product, and the relative change of the rest in `u` and in `v`.
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
    /// The weight.
    weight: f64,
}

fn scaled(a: &Quad, factor: f64) -> Quad {
    a.map(|x| factor * x)
}

impl Direct {
    /// `None` if the normals have another form.
    pub fn new(patch: &Patch) -> Option<Self> {
        let normals = match (patch.product(), patch.plane()) {
            (Some(factor), _) => Normals::Product(factor),
            (None, Some([x, y, z])) => Normals::Plane([x, y, z, 0.0]),
            (None, None) => return None,
        };
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
        let sides = match normals {
            Normals::Product(_) => patch.shrunk_sides(),
            Normals::Plane(_) => [[false; 2]; 2],
        };
        let divisions = sides.as_flattened().iter().filter(|side| **side).count();
        let growth = POLE.recip().powi(divisions as i32) * (1.0 + 4.0 * f64::EPSILON);
        let table = Table::new(&[x, y, z, raised(weight)], degrees);
        let places = Places::new(table);
        let magnitudes = [0, 1, 2, 3].map(|k| shifted.get(k).unwrap_or(weight).magnitude());
        let of_slopes = [[1, 0], [0, 1]].map(|orders| places.roundings(orders, magnitudes));
        let errors = Errors::new((&shifted, weight), of_slopes, shift);
        let rounding = match normals {
            Normals::Product(factor) => errors
                .of_fields(&centre, factor)
                .map(|sizes| sizes.map(|size| growth * size)),
            Normals::Plane([x, y, z, _]) => {
                let weights = match constant {
                    Some(_) => [1.0, 0.0],
                    None => [weight.magnitude(), places.roundings([0, 0], magnitudes)[3]],
                };
                errors.of_plane(&centre, [x, y, z], weights)
            }
        };
        Some(Self {
            sides,
            places,
            centre,
            normals,
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

    /// The position about the centre, and both slopes, from values and first derivatives of the forms.
    #[inline(always)]
    fn first(&self, [p, pu, pv]: [&Quad; 3]) -> First {
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
        First {
            f,
            slopes,
            inverse,
            weight,
        }
    }

    /// `N`, and how many times the product of the slopes it is, if it is that.
    #[inline(always)]
    fn normal(&self, at: [f64; 2], first: &First) -> (Quad, f64) {
        match &self.normals {
            Normals::Product(factor) => {
                let square = first.weight * first.weight;
                let mut size = factor * square * square;
                if self.has_poles() {
                    size /= self.divisor(at).0;
                }
                let [fu, fv] = &first.slopes;
                (scaled(&cross(fu, fv), size), size)
            }
            Normals::Plane(vector) if self.constant.is_some() => (*vector, 0.0),
            Normals::Plane(vector) => (scaled(vector, first.weight), 0.0),
        }
    }

    fn has_poles(&self) -> bool {
        self.sides != [[false; 2]; 2]
    }

    /// The point at `(u, v)` relative to the tool, both slopes, and `N`.
    #[inline]
    pub fn tangent(&self, at: [f64; 2]) -> (Quad, [Quad; 2], Quad) {
        let [p, pu, pv] = self.places.slopes(at);
        let first = self.first([&p, &pu, &pv]);
        let (normal, _) = self.normal(at, &first);
        (add(&first.f, &quad(&self.centre)), first.slopes, normal)
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
        let first = self.first([p, pu, pv]);
        let (normal, size) = self.normal(at, &first);
        let First {
            f,
            slopes: [fu, fv],
            inverse,
            ..
        } = first;
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
            let power = match self.normals {
                Normals::Product(_) => 4.0,
                Normals::Plane(_) => 1.0,
            };
            grown = [power * wu * inverse, power * wv * inverse];
        }
        if self.has_poles() {
            let (_, slopes) = self.divisor(at);
            grown = [grown[0] - slopes[0], grown[1] - slopes[1]];
        }
        Site {
            place: add(&f, &quad(&self.centre)),
            normal,
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

        /// The same on flat patches, anywhere: at poles as well, where nothing is divided.
        #[test]
        fn flat_normals_are_those_of_the_forms(
            degrees in prop_oneof![Just([3, 3]), [1_usize..5, 1_usize..5]], rational in any::<bool>(), has_pole in any::<bool>(), weights in proptest::collection::vec(0.6..1.6, 25),
            at in [0.0..=1.0, 0.0..=1.0], on_side in any::<bool>(), centre in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
            tilt in (0_usize..3, -1.0..1.0, -1.0..1.0),
        ) {
            let [p, q] = degrees;
            let at = if on_side { [at[0], 0.0] } else { at };
            let tilt = [if tilt.0 > 1 { tilt.1 } else { 0.0 }, if tilt.0 > 0 { tilt.2 } else { 0.0 }];
            let y = |i: usize| (i / (p + 1)) as f64 / q as f64;
            let x = |i: usize| (i % (p + 1)) as f64 / p as f64 * if has_pole { y(i) } else { 1.0 };
            let weight = |i: usize| if rational { weights[i] } else { 2.0 };
            let position = [
                form(degrees, &|i| weight(i) * (centre[0] + 3.0 * x(i))),
                form(degrees, &|i| weight(i) * (centre[1] + y(i))),
                form(degrees, &|i| weight(i) * (centre[2] + tilt[0] * x(i) + tilt[1] * y(i))),
            ];
            let patch = Patch::new(position, form(degrees, &weight)).unwrap();
            prop_assert!(patch.plane().is_some());
            prop_assert_eq!(patch.shrunk_sides(), [[false; 2], [has_pole, false]]);
            let direct = Direct::new(&patch).unwrap();
            prop_assert!(direct.covers(at));
            let lists = lists(&direct, at);
            let forms: Vec<&Bernstein> = patch.field().normal().iter().chain(patch.field().moment()).collect();
            for (k, form) in forms.iter().enumerate() {
                let rounding = direct.rounding[1 - k / 3][k % 3];
                let error = rounding + 64.0 * f64::EPSILON * form.magnitude();
                let value = form.evaluate(&at);
                prop_assert!((lists[0][k] - value).abs() <= error, "{k}: {} {value} {error}", lists[0][k]);
                for axis in 0..2 {
                    let slope = form.derivative(axis).evaluate(&at);
                    prop_assert!((lists[1 + axis][k] - slope).abs() <= 1e3 * error + 1e-12);
                }
                // Where the plane is parallel to an axis, nothing is left of the component.
                if k < 3 && patch.plane().unwrap()[k] == 0.0 {
                    prop_assert!(value == 0.0 && lists[0][k] == 0.0 && rounding == 0.0);
                }
            }
            let (_, most) = range_of(direct.rounding[1]);
            prop_assert!(most < 300.0 * f64::EPSILON, "{most}");
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
