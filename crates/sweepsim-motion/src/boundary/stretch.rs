//! Parts of sides that join one to one, and the sharp edges of their joints.

use super::edge::SMOOTH;
use super::side_curve::{PLACES, SideCurve, part};
use super::{Edge, NormalField};
use nalgebra::{DMatrix, DVector, Vector3};
use sweepsim_spline::Bernstein;
use sweepsim_spline::kernel::binomial;

/// The degree of converted normals, their permitted error, and how often the stretch is halved to meet it.
const CARRIED: usize = 6;
const CARRIED_ERROR: f64 = 1e-10;
const HALVINGS: usize = 8;

/// A part of a side that joins one other.
pub(super) struct JointStretch<'a> {
    pub(super) curve: &'a SideCurve,
    pub(super) range: [f64; 2],
    /// Points at equal steps of the parameter.
    places: Vec<Vector3<f64>>,
}

impl<'a> JointStretch<'a> {
    pub(super) fn new(curve: &'a SideCurve, [from, to]: [f64; 2]) -> Self {
        let mut stretch = Self {
            curve,
            range: [from, to],
            places: curve.places.clone(),
        };
        if [from, to] != [0.0, 1.0] {
            stretch.places = (0..PLACES).map(|n| stretch.at(part(n))).collect();
        }
        stretch
    }

    /// Its start and its end.
    pub(super) fn ends(&self) -> [Vector3<f64>; 2] {
        [self.places[0], self.places[PLACES - 1]]
    }

    fn parameter(&self, part: f64) -> f64 {
        self.range[0] * (1.0 - part) + self.range[1] * part
    }

    pub(super) fn at(&self, part: f64) -> Vector3<f64> {
        self.curve.at(self.parameter(part))
    }

    /// Whether it runs along the other, in the opposite or in the same direction.
    pub(super) fn runs_along(&self, other: &Self, backwards: bool, tolerance: f64) -> bool {
        // Corners that cut a side are within the tolerance of it, and of the corner that is the other's end.
        let (own, others) = (self.ends(), other.ends());
        let gap = |end: usize| (own[end] - others[if backwards { 1 - end } else { end }]).norm();
        if !(gap(0) <= 2.0 * tolerance && gap(1) <= 2.0 * tolerance) {
            return false;
        }
        let covered = |one: &Self, two: &Self| {
            one.places.iter().all(|place| {
                let (_, distance) = two.curve.nearest(place, two.range);
                distance <= tolerance
            })
        };
        self.keeps_pace(other, backwards, tolerance) || (covered(self, other) && covered(other, self))
    }

    /// Whether they have the same parametrisation: the same points at the same fractions of their parameters.
    fn keeps_pace(&self, other: &Self, backwards: bool, tolerance: f64) -> bool {
        (0..PLACES).all(|n| {
            let there = if backwards { PLACES - 1 - n } else { n };
            (self.places[n] - other.places[there]).norm() <= tolerance
        })
    }

    /// Position, weight and normals between two fractions of it; `from > to` reverses the direction.
    fn forms(&self, from: f64, to: f64) -> ([Bernstein; 3], Bernstein, NormalField) {
        let [from, to] = [from, to].map(|part| self.parameter(part));
        let cut = |form: &Bernstein| form.restrict(0, from, to).assumed_exact();
        let three = |forms: &[Bernstein; 3]| [0, 1, 2].map(|k| cut(&forms[k]));
        let field = NormalField {
            normal: three(&self.curve.field.normal),
            moment: three(&self.curve.field.moment),
        };
        (three(&self.curve.position), cut(&self.curve.weight), field)
    }

    /// The sharp edges of its joint with another, which runs in the opposite direction.
    pub(super) fn edges(&self, other: &Self, tolerance: f64) -> Vec<Edge> {
        let pace = self.keeps_pace(other, true, tolerance);
        let there = |part: f64| {
            if pace {
                other.parameter(1.0 - part)
            } else {
                other.curve.nearest(&self.at(part), other.range).0
            }
        };
        let normals = |part: f64| {
            Some((
                self.curve.normal(self.parameter(part))?,
                other.curve.normal(there(part))?,
            ))
        };
        let smooth = (0..PLACES).all(|n| match normals(part(n)) {
            Some((a, b)) => a.cross(&b).norm() <= SMOOTH && a.dot(&b) > 0.0,
            // At a pole a normal may vanish.
            None => true,
        });
        if smooth {
            return Vec::new();
        }
        // Along this side its own patch is to the left; the edge's direction has face B there.
        if pace {
            let (position, weight, after) = self.forms(0.0, 1.0);
            let (.., before) = other.forms(1.0, 0.0);
            return vec![Edge {
                position,
                weight,
                before,
                after,
            }];
        }
        let mut edges = Vec::new();
        let mut open = vec![([0.0, 1.0], 0)];
        while let Some(([from, to], depth)) = open.pop() {
            let normal = |part: f64| other.curve.normal_or_beside(there(from + (to - from) * part));
            let (carried, error) = fitted(normal);
            if error > CARRIED_ERROR && depth < HALVINGS {
                let middle = 0.5 * (from + to);
                open.push(([middle, to], depth + 1));
                open.push(([from, middle], depth + 1));
                continue;
            }
            let (position, weight, after) = self.forms(from, to);
            let cross = |k: usize| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                position[i].mul(&carried[j]).sub(&position[j].mul(&carried[i]))
            };
            // F × N and N, both times the weight.
            let before = NormalField {
                normal: [0, 1, 2].map(|k| weight.mul(&carried[k]).assumed_exact()),
                moment: [0, 1, 2].map(|k| cross(k).assumed_exact()),
            };
            edges.push(Edge {
                position,
                weight,
                before,
                after,
            });
        }
        edges
    }
}

/// A polynomial through values at Chebyshev points, and its error between them.
fn fitted(value: impl Fn(f64) -> Vector3<f64>) -> ([Bernstein; 3], f64) {
    let count = CARRIED + 1;
    let node = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * (i as f64 + 0.5) / count as f64).cos();
    let basis = |j: usize, x: f64| binomial(CARRIED, j) * x.powi(j as i32) * (1.0 - x).powi((CARRIED - j) as i32);
    let system = DMatrix::from_fn(count, count, |i, j| basis(j, node(i))).lu();
    let values: Vec<Vector3<f64>> = (0..count).map(|i| value(node(i))).collect();
    let forms = [0, 1, 2].map(|k| {
        let side = DVector::from_fn(count, |i, _| values[i][k]);
        let coefficients = system.solve(&side).expect("Bernstein polynomials are independent");
        Bernstein::new(&[CARRIED], coefficients.as_slice().to_vec()).expect("finite values of unit normals")
    });
    let between = (0..=2 * count).map(|i| i as f64 / (2 * count) as f64);
    let error = between
        .map(|x| (Vector3::from([0, 1, 2].map(|k| forms[k].evaluate(&[x]))) - value(x)).norm())
        .fold(0.0, f64::max);
    (forms, error)
}
