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
mod tests;
