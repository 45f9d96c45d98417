//! Fields of surface normals: how they are computed from a surface, and their invariants.

use super::PatchError;
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// Highest degree of a patch or an edge.
pub(super) const MOST: usize = 7;

/// Highest degree of normals and moments: four times that of patches.
const MOST_OF_NORMALS: usize = 4 * MOST;

/// The number of roundings of the largest coefficients allowed in normals and moments computed by a caller.
const ROUNDINGS: f64 = 64.0;

/// A field of surface normals `N` and their moments `M = F × N`, as Bernstein forms with one common positive factor.
///
/// Invariants: six finite forms in the same one or two variables, of degrees that can be evaluated accurately. Whether
/// they belong to a surface is checked when they are combined with it: by
/// [`Patch::with_normals`](crate::Patch::with_normals) and [`Edge::new`](crate::Edge::new).
#[derive(Clone, Debug)]
pub struct NormalField {
    pub(super) normal: [Bernstein; 3],
    pub(super) moment: [Bernstein; 3],
}

impl NormalField {
    /// Creates a field of these normals and moments.
    ///
    /// # Errors
    /// [`PatchError`]: forms that are not in one or two variables, or not all in the same number, a degree above 28,
    /// coefficients that are not finite, normals that are 0.
    pub fn new(normal: [Bernstein; 3], moment: [Bernstein; 3]) -> Result<Self, PatchError> {
        let expected = normal[0].variables().clamp(1, 2);
        for (form, what) in normal
            .iter()
            .map(|form| (form, "the normal"))
            .chain(moment.iter().map(|form| (form, "the moment")))
        {
            check_form(form, what, expected, MOST_OF_NORMALS)?;
        }
        if normal.iter().all(|form| form.magnitude() == 0.0) {
            return Err(PatchError::NoNormal { u: 0.5, v: 0.5 });
        }
        Ok(Self { normal, moment })
    }

    /// `N`, pointing out of the tool.
    #[must_use]
    pub fn normal(&self) -> &[Bernstein; 3] {
        &self.normal
    }

    /// `M = F × N`.
    #[must_use]
    pub fn moment(&self) -> &[Bernstein; 3] {
        &self.moment
    }

    /// Whether the field is normal to `position / weight` and its moments are `F × N`, up to rounding.
    ///
    /// With `P` the position and `w` the weight, `w M − P × N`, and `w ⟨N, P′⟩ − w′ ⟨N, P⟩` for each variable, are 0.
    /// Their coefficients are computed with a bound of their rounding errors; the caller's own roundings add `64 ε` of
    /// the largest coefficients.
    pub(super) fn check(&self, position: &[Bernstein; 3], weight: &Bernstein) -> Result<(), PatchError> {
        let largest = |forms: &[Bernstein; 3]| forms.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
        let (p, n, m, w) = (
            largest(position),
            largest(&self.normal),
            largest(&self.moment),
            weight.magnitude(),
        );
        let crossed = cross(position, &self.normal);
        for (moment, crossed) in self.moment.iter().zip(&crossed) {
            let rest = weight.mul(moment).sub(crossed);
            let allowed = rest.error() + ROUNDINGS * f64::EPSILON * (w * m + 2.0 * p * n);
            let off = rest.magnitude();
            if !(off <= allowed) {
                return Err(PatchError::Moment { off, allowed });
            }
        }
        for axis in 0..weight.variables() {
            let slopes = [0, 1, 2].map(|k| position[k].derivative(axis));
            let along = weight.mul(&dot(&self.normal, &slopes));
            let rest = along.sub(&weight.derivative(axis).mul(&dot(&self.normal, position)));
            let degree =
                (position.iter().map(|form| form.degree(axis)).max().unwrap_or(0)).max(weight.degree(axis)) as f64;
            // A derivative has coefficients up to twice its degree times as large.
            let allowed = rest.error() + ROUNDINGS * f64::EPSILON * 12.0 * degree * w * p * n;
            let off = rest.magnitude();
            if !(off <= allowed) {
                return Err(PatchError::NotNormal { axis, off, allowed });
            }
        }
        Ok(())
    }
}

/// Checks that forms are finite, in `expected` variables, and of an admissible degree.
pub(super) fn check_form(form: &Bernstein, what: &'static str, expected: usize, most: usize) -> Result<(), PatchError> {
    let found = form.variables();
    if found != expected {
        return Err(PatchError::Variables { what, expected, found });
    }
    if let Some(&degree) = form.degrees().iter().find(|degree| **degree > most) {
        return Err(PatchError::Degree { degree, most });
    }
    if !form.coefficients().iter().all(|c| c.is_finite()) {
        return Err(PatchError::NotFinite { what });
    }
    Ok(())
}

/// Position and weight of a patch or an edge.
pub(super) fn check_place(position: &[Bernstein; 3], weight: &Bernstein, variables: usize) -> Result<(), PatchError> {
    for (form, what) in position.iter().zip(["x", "y", "z"]).chain([(weight, "the weight")]) {
        check_form(form, what, variables, MOST)?;
    }
    match weight.coefficients().iter().enumerate().find(|(_, w)| **w <= 0.0) {
        Some((index, &value)) => Err(PatchError::Weight { index, value }),
        None => Ok(()),
    }
}

pub(super) fn cross(a: &[Bernstein; 3], b: &[Bernstein; 3]) -> [Bernstein; 3] {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i].mul(&b[j]).sub(&a[j].mul(&b[i]))
    })
}

pub(super) fn scaled(forms: &[Bernstein; 3], factor: f64) -> [Bernstein; 3] {
    [0, 1, 2].map(|k| forms[k].scale(factor).assumed_exact())
}

/// The value of a weight that is constant.
pub(super) fn constant(weight: &Bernstein) -> Option<f64> {
    let first = weight.coefficients()[0];
    weight.coefficients().iter().all(|w| *w == first).then_some(first)
}

/// For each variable, whether the lower and the upper side of a patch is meant.
pub(super) type Sides = [[bool; 2]; 2];

/// The normals `F_u × F_v` of any patch, times a power of its weight, and their moments, with the sides whose factors
/// were left out: see [`without_sides`].
pub(super) fn normals(position: &[Bernstein; 3], weight: &Bernstein) -> (NormalField, Sides) {
    let polynomial = constant(weight);
    let (pu, pv) = (
        [0, 1, 2].map(|k| position[k].derivative(0)),
        [0, 1, 2].map(|k| position[k].derivative(1)),
    );
    let both = cross(&pu, &pv);
    let origin = position;
    let (normal, moment) = if let Some(first) = polynomial {
        // F = P / w with a constant weight: the moment of F is that of P over it.
        let moment = cross(position, &both).map(|form| form.scale(1.0 / first));
        (both, moment)
    } else {
        let (wu, wv) = (weight.derivative(0), weight.derivative(1));
        // The normals do not depend on the origin. About a pole or a level they vanish there without rounding, however
        // far it is.
        let shifted = about_levels(position, weight);
        let (position, pu, pv, both) = match &shifted {
            None => (position, pu, pv, both),
            Some(shifted) => {
                let [pu, pv] = [0, 1].map(|axis| shifted.each_ref().map(|form| form.derivative(axis)));
                let both = cross(&pu, &pv);
                (shifted, pu, pv, both)
            }
        };
        let (with_u, with_v) = (cross(position, &pu), cross(position, &pv));
        let hat = [0, 1, 2].map(|k| {
            let sum = weight.mul(&both[k]).add(&wv.mul(&with_u[k]));
            sum.sub(&wu.mul(&with_v[k]))
        });
        let moment = cross(origin, &hat);
        (hat.map(|form| weight.mul(&form)), moment)
    };
    without_sides(normal, moment)
}

/// The control points of a patch, with coordinates `points[k][i]`, and its forms of common degrees.
pub(super) struct ControlPoints {
    pub degrees: [usize; 2],
    pub forms: [Bernstein; 3],
    pub weight: Bernstein,
    pub points: [Vec<f64>; 3],
    /// How far rounding may have moved a coordinate.
    pub off: f64,
}

impl ControlPoints {
    pub fn new(position: &[Bernstein; 3], weight: &Bernstein) -> Self {
        let degrees = [0, 1].map(|axis| {
            let own = position.iter().map(|form| form.degree(axis)).max().unwrap_or(0);
            own.max(weight.degree(axis))
        });
        let raised = |form: &Bernstein| form.elevated_to(&degrees);
        let (forms, weight) = (position.each_ref().map(raised), raised(weight));
        let points = forms.each_ref().map(|form| -> Vec<f64> {
            let pairs = form.coefficients().iter().zip(weight.coefficients());
            pairs.map(|(x, w)| x / w).collect()
        });
        let size = points.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        // Halves of a rounding: one of each product with a weight, as many as a sum has terms when a B-spline is
        // divided into patches, of both form and weight and along both axes, and one of the quotient.
        let halves = 2 * (degrees[0] + degrees[1] + 3);
        Self {
            degrees,
            forms,
            weight,
            points,
            off: 0.5 * halves as f64 * f64::EPSILON * size,
        }
    }
}

/// `P − w c`, where coordinates of control points that are those of `c` up to rounding become exactly 0, as they would
/// be if no product with a weight were rounded: `c` is a point that a side of the patch has shrunk to or, coordinate by
/// coordinate, what most control points share. `None` if there is neither.
fn about_levels(position: &[Bernstein; 3], weight: &Bernstein) -> Option<[Bernstein; 3]> {
    let ControlPoints {
        degrees,
        forms,
        weight,
        points,
        off,
    } = ControlPoints::new(position, weight);
    let weights = weight.coefficients();
    // Two points are compared.
    let is_same = |a: f64, b: f64| (a - b).abs() <= 2.0 * off;
    let sides = [(0, false), (0, true), (1, false), (1, true)];
    let pole = sides
        .into_iter()
        .filter(|(axis, _)| degrees[1 - axis] > 0)
        .find_map(|(axis, upper)| {
            let on_side = || side_indices(degrees, axis, upper);
            let first = on_side().next()?;
            let is_one = points.iter().all(|x| on_side().all(|at| is_same(x[at], x[first])));
            is_one.then(|| points.each_ref().map(|x| x[first]))
        });
    let shared = |x: &Vec<f64>| {
        let count = |at: &f64| x.iter().filter(|other| is_same(**other, *at)).count();
        // The first of those that as many share.
        let most = x.iter().rev().max_by_key(|at| count(at)).copied();
        most.filter(|at| count(at) > 1)
    };
    let levels = match pole {
        Some(pole) => pole.map(Some),
        None => points.each_ref().map(shared),
    };
    if levels.iter().all(Option::is_none) {
        return None;
    }
    let about = |k: usize| {
        let level = levels[k].unwrap_or(0.0);
        let all = forms[k].coefficients().iter().zip(weights).zip(&points[k]);
        let shifted = all.map(|((x, w), point)| if is_same(*point, level) { 0.0 } else { x - w * level });
        Bernstein::new(&degrees, shifted.collect()).ok()
    };
    Some([about(0)?, about(1)?, about(2)?])
}

/// Roundings of coefficients that count as 0 on the side of a patch that has shrunk to a point.
pub(super) const POLE: f64 = 16.0;

/// The same without the factors `u`, `1 − u`, `v` and `1 − v` that all normals have where a side has shrunk to a point,
/// a pole. What remains points in a definite direction there, and bounds of it need not hold 0.
fn without_sides(mut normal: [Bernstein; 3], mut moment: [Bernstein; 3]) -> (NormalField, Sides) {
    let mut sides = Sides::default();
    let largest = |forms: &[Bernstein; 3]| forms.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
    for axis in 0..2 {
        for upper in [false, true] {
            let vanishes = |forms: &[Bernstein; 3]| {
                let allowed = POLE * f64::EPSILON * largest(forms);
                forms
                    .iter()
                    .all(|form| side(form, axis, upper).all(|c| c.abs() <= allowed))
            };
            if vanishes(&normal) && vanishes(&moment) {
                let shorter = [&normal, &moment].map(|forms| forms.each_ref().map(|form| over_side(form, axis, upper)));
                let [[Some(a), Some(b), Some(c)], [Some(d), Some(e), Some(f)]] = shorter else {
                    continue;
                };
                (normal, moment) = ([a, b, c], [d, e, f]);
                sides[axis][usize::from(upper)] = true;
            }
        }
    }
    (NormalField { normal, moment }, sides)
}

/// The coefficients of a form in two variables on one of its sides.
fn side(form: &Bernstein, axis: usize, upper: bool) -> impl Iterator<Item = f64> {
    side_indices([form.degree(0), form.degree(1)], axis, upper).map(|at| form.coefficients()[at])
}

/// Where these are.
fn side_indices([p, q]: [usize; 2], axis: usize, upper: bool) -> impl Iterator<Item = usize> {
    let fixed = if upper { [p, q][axis] } else { 0 };
    let count = if axis == 0 { q } else { p };
    (0..=count).map(move |k| {
        let [i, j] = if axis == 0 { [fixed, k] } else { [k, fixed] };
        i + (p + 1) * j
    })
}

/// A form whose coefficients on one side are 0, divided by the distance from that side: with
/// `B(n, k) = n/k · x B(n − 1, k − 1)`.
fn over_side(form: &Bernstein, axis: usize, upper: bool) -> Option<Bernstein> {
    let degrees = [form.degree(0), form.degree(1)];
    let n = degrees[axis];
    let mut lower = degrees;
    lower[axis] = n.checked_sub(1)?;
    Bernstein::from_fn(&lower, |index| {
        let mut of = [index[0], index[1]];
        let k = of[axis];
        let factor = if upper {
            n as f64 / (n - k) as f64
        } else {
            of[axis] += 1;
            n as f64 / (k + 1) as f64
        };
        factor * form.coefficients()[of[0] + (degrees[0] + 1) * of[1]]
    })
    .ok()
}

fn dot(a: &[Bernstein; 3], b: &[Bernstein; 3]) -> Bernstein {
    a[0].mul(&b[0]).add(&a[1].mul(&b[1])).add(&a[2].mul(&b[2]))
}

/// Whether normals in one or two variables vanish nowhere in the interior. Interior boxes are cut until the normals of
/// each lie in a half-space; boxes at the sides may stay undecided.
pub(super) fn check_normals(normal: &[Bernstein; 3]) -> Result<(), PatchError> {
    const DEPTH: usize = 14;
    let mut stack = vec![(normal.clone(), [[0.0, 1.0]; 2], 0)];
    while let Some((forms, sides, depth)) = stack.pop() {
        let count = forms[0].coefficients().len();
        let vector = |i: usize| Vector3::from([0, 1, 2].map(|k| forms[k].coefficients()[i]));
        let mean: Vector3<f64> = (0..count).map(vector).sum();
        if (0..count).all(|i| vector(i).dot(&mean) > 0.0) {
            continue;
        }
        if depth == DEPTH {
            let at_a_side = sides.iter().any(|side| side[0] == 0.0 || side[1] == 1.0);
            if at_a_side {
                continue;
            }
            let [u, v] = sides.map(|side| 0.5 * (side[0] + side[1]));
            return Err(PatchError::NoNormal { u, v });
        }
        let axis = depth % normal[0].variables().max(1);
        let halves = [0, 1, 2].map(|k| forms[k].split(axis, 0.5));
        let [a, b, c] = halves;
        let middle = 0.5 * (sides[axis][0] + sides[axis][1]);
        let (mut low, mut high) = (sides, sides);
        low[axis][1] = middle;
        high[axis][0] = middle;
        stack.push(([a.0, b.0, c.0], low, depth + 1));
        stack.push(([a.1, b.1, c.1], high, depth + 1));
    }
    Ok(())
}
