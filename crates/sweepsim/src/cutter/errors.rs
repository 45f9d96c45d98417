//! Rounding errors of slopes, normals and moments that are computed from a patch's position.

use crate::time::pieces::Sizes;
use nalgebra::Vector3;
use sweepsim_motion::Patch;
use sweepsim_spline::Bernstein;

/// Bounds of both derivatives of `F` and of their rounding errors, from the homogeneous position about some centre.
pub(super) struct Errors {
    /// Component by component: a bound, and one of its error.
    slopes: [[[f64; 2]; 3]; 2],
    /// Bounds of the position about the centre, and of its error.
    radius: [f64; 3],
    shift: [f64; 3],
    heaviest: f64,
}

/// The factors of a component of a vector product.
const PAIRS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

impl Errors {
    /// `roundings`: of the first derivatives of all four forms, in each variable. `shift` bounds the errors of the position's coefficients themselves.
    pub fn new((position, weight): (&[Bernstein; 3], &Bernstein), roundings: [[f64; 4]; 2], shift: [f64; 3]) -> Self {
        let lightest = weight.coefficients().iter().copied().fold(f64::INFINITY, f64::min);
        let radius = position.each_ref().map(|form| form.magnitude() / lightest);
        let slopes = [0, 1].map(|axis| {
            let degree = position.iter().map(|form| form.degree(axis)).max().unwrap_or(0) as f64;
            let roundings = roundings[axis];
            let growth = weight.derivative(axis).magnitude();
            std::array::from_fn(|k| {
                let bound = (position[k].derivative(axis).magnitude() + radius[k] * growth) / lightest;
                let shifted = (2.0 * degree + growth / lightest) * shift[k];
                let error = (roundings[k] + radius[k] * roundings[3] + shifted) / lightest + 4.0 * f64::EPSILON * bound;
                [bound, error]
            })
        });
        Self {
            slopes,
            radius,
            shift: shift.map(|error| error / lightest),
            heaviest: weight.magnitude(),
        }
    }

    /// Of `F_u` and `F_v`.
    pub fn of_slopes(&self) -> Sizes {
        self.slopes.map(|slope| slope.map(|[_, error]| error))
    }

    /// Of `M` and `N = factor w⁴ (F_u × F_v)`.
    pub fn of_fields(&self, centre: &Vector3<f64>, factor: f64) -> Sizes {
        let epsilon = f64::EPSILON;
        let [u, v] = self.slopes;
        let size = factor * self.heaviest.powi(4);
        let mut normal = [[0.0; 2]; 3];
        for (k, [a, b]) in PAIRS.into_iter().enumerate() {
            let product = |p: [f64; 2], q: [f64; 2]| [p[0] * q[0], p[0] * q[1] + p[1] * q[0]];
            let (one, other) = (product(u[a], v[b]), product(u[b], v[a]));
            let bound = size * (one[0] + other[0]);
            normal[k] = [bound, size * (one[1] + other[1]) + 16.0 * epsilon * bound];
        }
        [self.of_moment(centre, normal), normal.map(|[_, error]| error)]
    }

    /// Of `M` and `N = w n`, with a bound of the weight and of its error.
    pub fn of_plane(&self, centre: &Vector3<f64>, vector: [f64; 3], [weight, error]: [f64; 2]) -> Sizes {
        // A rounding of the product here, and one of the forms' coefficients.
        let normal = vector.map(|x: f64| [x.abs() * weight, x.abs() * (error + 2.0 * f64::EPSILON * weight)]);
        [self.of_moment(centre, normal), normal.map(|[_, error]| error)]
    }

    /// Of `M`, from a bound of each component of `N` and of its error.
    fn of_moment(&self, centre: &Vector3<f64>, normal: [[f64; 2]; 3]) -> [f64; 3] {
        PAIRS.map(|[a, b]| {
            let term = |p: usize, n: usize| {
                let reach = centre[p].abs() + self.radius[p];
                reach * (normal[n][1] + 24.0 * f64::EPSILON * normal[n][0]) + self.shift[p] * normal[n][0]
            };
            term(a, b) + term(b, a)
        })
    }
}

/// The coordinate `k` of all points, if the forms of normals and moments are exactly those of a patch across that axis: where only `N_k` is not 0, nothing else has an error.
pub(super) fn flat_at(patch: &Patch, k: usize) -> Option<f64> {
    let vanish =
        |forms: &[Bernstein; 3], is_own: bool| (0..3).all(|j| (j == k) != is_own || forms[j].magnitude() == 0.0);
    let field = patch.field();
    let is_flat = vanish(field.normal(), false) && vanish(field.moment(), true);
    is_flat.then(|| patch.position()[k].coefficients()[0] / patch.weight().coefficients()[0])
}
