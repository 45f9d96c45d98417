//! How the sides of patches join to a closed boundary, and which joints are sharp.
//!
//! Sides are cut where corners of other patches lie on them. What is left, *stretches*, must join one to one and run opposite ways; a side
//! that joins several is a T-joint. Two stretches may run along the same curve at different paces: then the normals of the one are carried over
//! to the parameter of the other, as polynomials.
//!
//! All is within the tolerance of the tool: corners lie on sides, and sides along each other, to within it.

use crate::boundary::{Edge, NormalField, Patch};
use crate::freeform::{Side, ToolError};
use nalgebra::{DMatrix, DVector, Vector3};
use sweepsim_spline::Bernstein;

/// Places along a stretch at which two are compared.
const PLACES: usize = 17;
/// Stretches whose normals enclose no larger angle (its sine) join smoothly.
const SMOOTH: f64 = 1e-9;
/// Degree of normals that are carried over, how far they may be off, and how often the stretch is halved for that.
const CARRIED: usize = 6;
const CARRIED_ERROR: f64 = 1e-10;
const HALVINGS: usize = 8;

/// How a boundary is folded at a place of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fold {
    /// Not at all: the normals of both faces are the same there.
    Smooth,
    /// Material within less than half a turn.
    Convex,
    /// Material within more than half a turn.
    Concave,
}

impl Edge {
    /// How the boundary is folded at `r` in `[0, 1]`: an edge may change from the one to the other on its way.
    #[must_use]
    pub fn fold(&self, r: f64) -> Fold {
        let vector = |forms: &[Bernstein; 3]| Vector3::from([0, 1, 2].map(|k| forms[k].evaluate(&[r])));
        let [a, b] = [&self.before, &self.after].map(|field| vector(&field.normal));
        let slopes = [0, 1, 2].map(|k| self.position[k].derivative(0));
        let place = vector(&self.position) / self.weight.evaluate(&[r]);
        let along = vector(&slopes) - place * self.weight.derivative(0).evaluate(&[r]);
        let turn = a.cross(&b);
        if turn.norm() <= SMOOTH * a.norm() * b.norm() {
            Fold::Smooth
        } else if turn.dot(&along) < 0.0 {
            // From A to B the normal leans the way that leads from A to B.
            Fold::Convex
        } else {
            Fold::Concave
        }
    }
}

/// A side as a curve in `r` from 0 to 1, with the normals of its patch.
struct Curve {
    patch: usize,
    side: Side,
    position: [Bernstein; 3],
    weight: Bernstein,
    field: NormalField,
    places: Vec<Vector3<f64>>,
    /// A box that surely holds it: lower and upper corner.
    bounds: [Vector3<f64>; 2],
}

impl Curve {
    fn new(patches: &[Patch], patch: usize, side: Side) -> Self {
        let (axis, at, backwards) = match side {
            Side::Bottom => (1, 0.0, false),
            Side::Right => (0, 1.0, false),
            Side::Top => (1, 1.0, true),
            Side::Left => (0, 0.0, true),
        };
        let cut = |form: &Bernstein| {
            let form = form.slice(axis, at);
            let form = if backwards { form.reverse(0) } else { form };
            form.assumed_exact()
        };
        let three = |forms: &[Bernstein; 3]| [0, 1, 2].map(|k| cut(&forms[k]));
        let of = &patches[patch];
        let mut curve = Self {
            patch,
            side,
            places: Vec::new(),
            bounds: [Vector3::zeros(); 2],
            field: NormalField {
                normal: three(&of.field.normal),
                moment: three(&of.field.moment),
            },
            position: three(&of.position),
            weight: cut(&of.weight),
        };
        curve.places = (0..PLACES).map(|n| curve.at(part(n))).collect();
        // The hull of the control points.
        let weights = curve.weight.coefficients();
        let control = |i: usize| Vector3::from([0, 1, 2].map(|k| curve.position[k].coefficients()[i] / weights[i]));
        let points = || (0..weights.len()).map(control);
        curve.bounds = [
            points().fold(Vector3::repeat(f64::INFINITY), |a, b| a.inf(&b)),
            points().fold(Vector3::repeat(f64::NEG_INFINITY), |a, b| a.sup(&b)),
        ];
        curve
    }

    /// Whether it is a point.
    fn is_pole(&self, tolerance: f64) -> bool {
        self.places
            .iter()
            .all(|place| (place - self.places[0]).norm() <= tolerance)
    }

    fn at(&self, r: f64) -> Vector3<f64> {
        let w = self.weight.evaluate(&[r]);
        Vector3::from([0, 1, 2].map(|k| self.position[k].evaluate(&[r]) / w))
    }

    /// `F′` at `r`.
    fn slope(&self, r: f64) -> Vector3<f64> {
        let mut gradient = [0.0];
        let w = self.weight.evaluate_gradient(&[r], &mut gradient);
        let w_slope = gradient[0];
        Vector3::from([0, 1, 2].map(|k| {
            let p = self.position[k].evaluate_gradient(&[r], &mut gradient);
            (gradient[0] - p / w * w_slope) / w
        }))
    }

    /// The unit normal of the patch at `r`; none at a pole, where it vanishes.
    fn normal(&self, r: f64) -> Option<Vector3<f64>> {
        let normal = Vector3::from([0, 1, 2].map(|k| self.field.normal[k].evaluate(&[r])));
        normal.try_normalize(1e-12)
    }

    /// The same; at a pole that beside it.
    fn normal_or_beside(&self, r: f64) -> Vector3<f64> {
        let inside = r + (0.5 - r) * 1e-6;
        let found = self.normal(r).or_else(|| self.normal(inside));
        found.unwrap_or_else(Vector3::zeros)
    }

    /// Where between `from` and `to` it is nearest to a point, and how far that is.
    fn nearest(&self, point: &Vector3<f64>, [from, to]: [f64; 2]) -> (f64, f64) {
        const STEPS: usize = 4 * PLACES;
        let distance = |r: f64| (self.at(r) - point).norm();
        let step = (to - from) / STEPS as f64;
        let samples = (0..=STEPS).map(|n| from + step * n as f64);
        let mut best = samples
            .map(|r| (r, distance(r)))
            .fold((from, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
        let (low, high) = ((best.0 - step).max(from), (best.0 + step).min(to));
        for _ in 0..20 {
            let slope = self.slope(best.0);
            let by = (point - self.at(best.0)).dot(&slope) / slope.norm_squared();
            let next = (best.0 + by).clamp(low, high);
            let there = distance(next);
            if !(there < best.1) {
                break;
            }
            best = (next, there);
        }
        best
    }

    /// Whether a point may be within the tolerance of it.
    fn may_hold(&self, point: &Vector3<f64>, tolerance: f64) -> bool {
        let [low, high] = &self.bounds;
        (0..3).all(|k| low[k] - tolerance <= point[k] && point[k] <= high[k] + tolerance)
    }
}

fn part(n: usize) -> f64 {
    n as f64 / (PLACES - 1) as f64
}

/// A part of a side that joins one other.
struct Stretch<'a> {
    curve: &'a Curve,
    range: [f64; 2],
    ends: [Vector3<f64>; 2],
}

impl Stretch<'_> {
    fn parameter(&self, part: f64) -> f64 {
        self.range[0] * (1.0 - part) + self.range[1] * part
    }

    fn at(&self, part: f64) -> Vector3<f64> {
        self.curve.at(self.parameter(part))
    }

    /// Whether it runs along the other, the other way or the same.
    fn runs_along(&self, other: &Self, backwards: bool, tolerance: f64) -> bool {
        // Corners that cut a side are within the tolerance of it, and of the corner that is the other's end.
        let gap = |end: usize| (self.ends[end] - other.ends[if backwards { 1 - end } else { end }]).norm();
        if !(gap(0) <= 2.0 * tolerance && gap(1) <= 2.0 * tolerance) {
            return false;
        }
        let covered = |one: &Self, two: &Self| {
            (0..PLACES).all(|n| {
                let (_, distance) = two.curve.nearest(&one.at(part(n)), two.range);
                distance <= tolerance
            })
        };
        self.keeps_pace(other, backwards, tolerance) || (covered(self, other) && covered(other, self))
    }

    /// Whether they are at the same places at the same parts of their parameters.
    fn keeps_pace(&self, other: &Self, backwards: bool, tolerance: f64) -> bool {
        (0..PLACES).all(|n| {
            let there = if backwards { 1.0 - part(n) } else { part(n) };
            (self.at(part(n)) - other.at(there)).norm() <= tolerance
        })
    }

    /// Position, weight and normals between two parts of it, `from > to` for the other way.
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

    /// The sharp edges of its joint with another, which runs the other way.
    fn edges(&self, other: &Self, tolerance: f64) -> Vec<Edge> {
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

/// A polynomial through values at Chebyshev's places, and how far it is off between them.
fn fitted(value: impl Fn(f64) -> Vector3<f64>) -> ([Bernstein; 3], f64) {
    let count = CARRIED + 1;
    let node = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * (i as f64 + 0.5) / count as f64).cos();
    let binomial = |j: usize| (0..j).fold(1.0, |b, k| b * (CARRIED - k) as f64 / (k + 1) as f64);
    let basis = |j: usize, x: f64| binomial(j) * x.powi(j as i32) * (1.0 - x).powi((CARRIED - j) as i32);
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

/// The sides cut at the corners that lie on them.
fn stretches(curves: &[Curve], tolerance: f64) -> Vec<Stretch<'_>> {
    let mut stretches = Vec::with_capacity(curves.len());
    for (number, curve) in curves.iter().enumerate() {
        let ends = [curve.places[0], curve.places[PLACES - 1]];
        let mut cuts: Vec<f64> = Vec::new();
        for (_, other) in curves.iter().enumerate().filter(|(other, _)| *other != number) {
            // Every corner begins a side.
            let corner = other.places[0];
            let at_end = ends.iter().any(|end| (end - corner).norm() <= 2.0 * tolerance);
            if at_end || !curve.may_hold(&corner, tolerance) {
                continue;
            }
            let (r, distance) = curve.nearest(&corner, [0.0, 1.0]);
            let known = cuts
                .iter()
                .any(|cut| (curve.at(*cut) - corner).norm() <= 2.0 * tolerance);
            if distance <= tolerance && !known {
                cuts.push(r);
            }
        }
        cuts.sort_by(f64::total_cmp);
        let bounds: Vec<f64> = std::iter::once(0.0).chain(cuts).chain([1.0]).collect();
        stretches.extend(bounds.windows(2).map(|pair| Stretch {
            curve,
            range: [pair[0], pair[1]],
            ends: [curve.at(pair[0]), curve.at(pair[1])],
        }));
    }
    stretches
}

/// The sharp edges of a closed boundary.
///
/// # Errors
/// [`ToolError`]: it is none.
pub(crate) fn edges(patches: &[Patch], tolerance: f64) -> Result<Vec<Edge>, ToolError> {
    if patches.is_empty() {
        return Err(ToolError::Empty);
    }
    let mut curves: Vec<Curve> = (0..patches.len())
        .flat_map(|patch| {
            [Side::Bottom, Side::Right, Side::Top, Side::Left].map(|side| Curve::new(patches, patch, side))
        })
        .collect();
    curves.retain(|curve| !curve.is_pole(tolerance));
    let stretches = stretches(&curves, tolerance);
    let mut edges = Vec::new();
    for (number, stretch) in stretches.iter().enumerate() {
        let others = || stretches.iter().enumerate().filter(|(other, _)| *other != number);
        let mut joined = others().filter(|(_, other)| stretch.runs_along(other, true, tolerance));
        let (patch, side) = (stretch.curve.patch, stretch.curve.side);
        let Some((partner, other)) = joined.next() else {
            return Err(
                match others().find(|(_, other)| stretch.runs_along(other, false, tolerance)) {
                    Some((_, other)) => ToolError::Flipped {
                        patch,
                        side,
                        other: other.curve.patch,
                    },
                    None => ToolError::Open {
                        patch,
                        side,
                        place: stretch.at(0.5).into(),
                    },
                },
            );
        };
        if joined.next().is_some() {
            return Err(ToolError::Branching { patch, side });
        }
        if number < partner {
            edges.extend(stretch.edges(other, tolerance));
        }
    }
    if volume(patches) <= 0.0 {
        return Err(ToolError::InsideOut);
    }
    Ok(edges)
}

/// A multiple of the enclosed volume, by sums over each patch: for its sign alone.
fn volume(patches: &[Patch]) -> f64 {
    const STEPS: usize = 24;
    let middle = |n: usize| (n as f64 + 0.5) / STEPS as f64;
    let mut sum = 0.0;
    for patch in patches {
        for i in 0..STEPS {
            for j in 0..STEPS {
                let h = 0.5 / STEPS as f64;
                let (u, v) = (middle(i), middle(j));
                let along_u = patch.place(u + h, v) - patch.place(u - h, v);
                let along_v = patch.place(u, v + h) - patch.place(u, v - h);
                sum += patch.place(u, v).dot(&along_u.cross(&along_v));
            }
        }
    }
    sum
}
