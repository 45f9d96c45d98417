//! The envelope systems of a tool under a motion, named as in the paper, as exact Bernstein forms.
//!
//! | of | unknowns | surface | section by a plane | points on a line | the same as a map, for charts |
//! | --- | --- | --- | --- | --- | --- |
//! | a patch | `u, v, t` | Eq. 2, [`envelope`](PatchMotion::envelope) | Eq. 4, [`section`](PatchMotion::section) | Eq. 6, [`line`](PatchMotion::line) | `PatchMap` in `patch_map.rs`: `(X, Y, g)` |
//! | a sharp edge | `r, t` | Eq. 3: no equation | Eq. 5, [`section`](EdgeMotion::section) | Eq. 7, [`line`](EdgeMotion::line) | `EdgeMap` in `edge_map.rs`: `(X, Y)`, and both `g` |
//! | a placed patch (cap, kink) | `u, v` | no equation | [`section`](PlacedPatch::section) | [`line`](PlacedPatch::line) | `PlacedMap` in `placed_map.rs`: `(X, Y)`, and `g` before and after |
//!
//! All rational forms have a common positive weight, which is cleared: `⟨F, n⟩ = d` becomes `⟨F̂, n⟩ − d W = 0`. The envelope
//! condition has the lowest possible degree: `w g = ⟨M, κ A₀ᵀk⟩ + ⟨N, Âᵀ b′⟩`, of degree 2 in `t` (see the project's
//! `docs/algorithms/charts.md`).
//!
//! The default method does not build these systems. It bounds and evaluates the same functions `X`, `Y` and `g` as maps, from cells of the patch and
//! pieces of the motion, and solves Eq. 6 and 7 for all lines at once: a line is a value of the map. The maps are in the same folder,
//! `envelope/`; `methods/search.rs` sets up each equation once for all methods, and a unit test compares every map with its system.

pub use crate::envelope::plane::{Plane, PlaneError};
use crate::time::over::DyadicInterval;
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Edge, NormalField, Patch, Segment};
use sweepsim_solve::{Enclosure, Equation, System, SystemError};
use sweepsim_spline::Bernstein;

/// A moving point: homogeneous coordinates over one weight.
#[derive(Clone, Debug)]
struct MovingPoint {
    numerators: [Bernstein; 3],
    weight: Bernstein,
}

impl MovingPoint {
    /// `⟨p, n⟩ = d`, with the weight cleared.
    fn plane(&self, plane: &Plane) -> Bernstein {
        let [a, b, c] = plane.normal();
        let along = |k: usize, factor: f64| (factor != 0.0).then(|| self.numerators[k].scale(factor));
        [along(0, a), along(1, b), along(2, c)]
            .into_iter()
            .flatten()
            .fold(self.weight.scale(-plane.offset()), |sum, form| sum.add(&form))
    }
}

/// The motion's forms in `t`.
struct MotionForms {
    turns: Vec<Matrix3<f64>>,
    /// The rotation, times the factor that makes its weight that of the tip.
    factor: Option<Bernstein>,
    weight: Bernstein,
    /// `b`, over the weight.
    tips: [Bernstein; 3],
    spins: Vec<Vector3<f64>>,
    travels: Vec<Vector3<f64>>,
    /// Whether the travel is turned back with twice the digits, as it is on a straight way without rotation. Where a face slides along itself, a tiny component of
    /// it decides alone.
    is_exact: bool,
    /// The part of the motion over which the forms of this, and those made of it, are.
    part: DyadicInterval,
}

/// A form in `t`, over a part of the motion.
fn in_part(part: &DyadicInterval, coefficients: Vec<f64>, error: f64) -> Bernstein {
    let whole = in_time(coefficients, error);
    if part.is_whole() {
        whole
    } else {
        whole.restrict(0, part.from, part.to())
    }
}

/// A form in one variable.
fn in_time(coefficients: Vec<f64>, error: f64) -> Bernstein {
    let degree = coefficients.len() - 1;
    Bernstein::with_error(&[degree], coefficients, error).expect("finite coefficients of one degree")
}

impl MotionForms {
    fn new(segment: &Segment, part: DyadicInterval) -> Self {
        let in_time = |coefficients: Vec<f64>, error: f64| in_part(&part, coefficients, error);
        let own = in_time(segment.weights().to_vec(), 0.0);
        let (points, weights) = segment.points();
        let points = [0, 1, 2].map(|k| in_time(points.iter().map(|p| p[k]).collect(), 0.0));
        let (factor, tips, weight) = if weights == segment.weights() {
            (None, points, own)
        } else if weights.iter().all(|w| *w == 1.0) {
            (None, points.map(|point| point.mul(&own)), own)
        } else {
            let weights = in_time(weights, 0.0);
            let both = own.mul(&weights);
            (Some(weights), points.map(|point| point.mul(&own)), both)
        };
        let (spins, travels) = segment.twist();
        Self {
            turns: segment.turns().to_vec(),
            factor,
            weight,
            tips,
            spins,
            travels,
            is_exact: segment.is_arc() && segment.turns().len() == 1,
            part,
        }
    }

    /// The position of `(f̂, ω)` under the motion.
    fn place(&self, position: &[Bernstein; 3], omega: &Bernstein) -> MovingPoint {
        let numerators = [0, 1, 2].map(|r| {
            (0..3).fold(omega.tensor_product(&self.tips[r]), |sum, k| {
                let entry = in_part(&self.part, self.turns.iter().map(|m| m[(r, k)]).collect(), 0.0);
                let entry = self.factor.as_ref().map_or(entry.clone(), |factor| entry.mul(factor));
                sum.add(&position[k].tensor_product(&entry))
            })
        });
        MovingPoint {
            numerators,
            weight: omega.tensor_product(&self.weight),
        }
    }

    /// `g` of a field of normals, times a positive function of `t`.
    fn envelope(&self, field: &NormalField) -> Bernstein {
        // Products of three terms: at most four roundings of the sum of their sizes, or of the component alone.
        let rounding = |list: &[Vector3<f64>], k: usize| {
            let all = |v: &Vector3<f64>| v.iter().map(|x| x.abs()).sum::<f64>();
            let size = |v: &Vector3<f64>| if self.is_exact { v[k].abs() } else { all(v) };
            8.0 * f64::EPSILON * list.iter().map(size).fold(0.0, f64::max)
        };
        let along = |list: &[Vector3<f64>], forms: &[Bernstein; 3]| {
            let term = |k: usize| {
                let components = list.iter().map(|v| v[k]).collect();
                forms[k].tensor_product(&in_part(&self.part, components, rounding(list, k)))
            };
            term(0).add(&term(1)).add(&term(2))
        };
        let travelling = along(&self.travels, field.normal());
        if self.spins.iter().all(|spin| *spin == Vector3::zeros()) {
            return travelling;
        }
        travelling.add(&along(&self.spins, field.moment()))
    }
}

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

fn system(n: usize, equations: Vec<Bernstein>) -> Result<System, SystemError> {
    System::new(&unit(n), equations.into_iter().map(Equation::from))
}

/// A patch under a motion: unknowns `u, v, t` in `[0, 1]³`.
#[derive(Clone, Debug)]
pub struct PatchMotion {
    place: MovingPoint,
    envelope: Bernstein,
}

impl PatchMotion {
    /// The forms of a patch moved by a segment.
    #[must_use]
    pub fn new(patch: &Patch, segment: &Segment) -> Self {
        Self::over(patch, segment, [DyadicInterval::WHOLE; 3])
    }

    /// The same over a part of the patch and of the motion, as forms of its own.
    pub(crate) fn over(patch: &Patch, segment: &Segment, [u, v, time]: [DyadicInterval; 3]) -> Self {
        let motion = MotionForms::new(segment, time);
        let restricted = |form: Bernstein| {
            let parts = [u, v].into_iter().enumerate().filter(|(_, part)| !part.is_whole());
            parts.fold(form, |form, (axis, part)| form.restrict(axis, part.from, part.to()))
        };
        let MovingPoint { numerators, weight } = motion.place(patch.position(), patch.weight());
        Self {
            place: MovingPoint {
                numerators: numerators.map(restricted),
                weight: restricted(weight),
            },
            envelope: restricted(motion.envelope(patch.field())),
        }
    }

    /// Numerators of the position `(X, Y, Z)` in space, and their weight.
    #[must_use]
    pub fn position(&self) -> (&[Bernstein; 3], &Bernstein) {
        (&self.place.numerators, &self.place.weight)
    }

    /// `g`: positive where the boundary moves outwards, times a positive function of `t`.
    #[must_use]
    pub fn condition(&self) -> &Bernstein {
        &self.envelope
    }

    /// Eq. 2: the envelope, a surface in `u, v, t`.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn envelope(&self) -> Result<System, SystemError> {
        system(3, vec![self.envelope.clone()])
    }

    /// Eq. 4: the envelope's section by a plane, curves in `u, v, t`.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn section(&self, plane: &Plane) -> Result<System, SystemError> {
        system(3, vec![self.place.plane(plane), self.envelope.clone()])
    }

    /// Eq. 6: the envelope's points on the line of two planes.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn line(&self, [first, second]: [&Plane; 2]) -> Result<System, SystemError> {
        let (first, second) = (self.place.plane(first), self.place.plane(second));
        system(3, vec![first, second, self.envelope.clone()])
    }
}

/// A sharp edge under a motion: unknowns `r, t` in `[0, 1]²`. It lies on the envelope where exactly one of its two
/// [conditions](EdgeMotion::conditions) is negative.
#[derive(Clone, Debug)]
pub struct EdgeMotion {
    place: MovingPoint,
    conditions: [Bernstein; 2],
}

impl EdgeMotion {
    /// The forms of an edge moved by a segment.
    #[must_use]
    pub fn new(edge: &Edge, segment: &Segment) -> Self {
        Self::over(edge, segment, DyadicInterval::WHOLE)
    }

    /// The same over a part of the motion, as forms of its own.
    pub(crate) fn over(edge: &Edge, segment: &Segment, part: DyadicInterval) -> Self {
        let motion = MotionForms::new(segment, part);
        Self {
            place: motion.place(edge.position(), edge.weight()),
            conditions: [motion.envelope(edge.before()), motion.envelope(edge.after())],
        }
    }

    /// Numerators of the position `(X, Y, Z)` in space, and their weight: Eq. 3, a surface without any condition.
    #[must_use]
    pub fn position(&self) -> (&[Bernstein; 3], &Bernstein) {
        (&self.place.numerators, &self.place.weight)
    }

    /// `g` of the face before and of the face after the edge, times a positive function of `t`.
    #[must_use]
    pub fn conditions(&self) -> &[Bernstein; 2] {
        &self.conditions
    }

    /// Eq. 5: the section by a plane, curves in `r, t`.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn section(&self, plane: &Plane) -> Result<System, SystemError> {
        system(2, vec![self.place.plane(plane)])
    }

    /// Eq. 7: the points on the line of two planes.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn line(&self, [first, second]: [&Plane; 2]) -> Result<System, SystemError> {
        system(2, vec![self.place.plane(first), self.place.plane(second)])
    }
}

/// A patch at rest: unknowns `u, v` in `[0, 1]²`. Caps are the part of it that moves inwards (at the start) or outwards (at the
/// end), kinks the part whose direction changes between before and after.
#[derive(Clone, Debug)]
pub struct PlacedPatch {
    place: MovingPoint,
}

impl PlacedPatch {
    /// The forms of a patch turned by `turn`, with the tool's tip at `tip`.
    #[must_use]
    pub fn new(patch: &Patch, turn: &Matrix3<f64>, tip: &Vector3<f64>) -> Self {
        let numerators = [0, 1, 2].map(|r| {
            (0..3).fold(patch.weight().scale(tip[r]), |sum, k| {
                sum.add(&patch.position()[k].scale(turn[(r, k)]))
            })
        });
        Self {
            place: MovingPoint {
                numerators,
                weight: patch.weight().clone(),
            },
        }
    }

    /// Numerators of the position `(X, Y, Z)` in space, and their weight.
    #[must_use]
    pub fn position(&self) -> (&[Bernstein; 3], &Bernstein) {
        (&self.place.numerators, &self.place.weight)
    }

    /// The section by a plane, curves in `u, v`.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn section(&self, plane: &Plane) -> Result<System, SystemError> {
        system(2, vec![self.place.plane(plane)])
    }

    /// The points on the line of two planes.
    ///
    /// # Errors
    ///
    /// Those of [`System::new`].
    pub fn line(&self, [first, second]: [&Plane; 2]) -> Result<System, SystemError> {
        system(2, vec![self.place.plane(first), self.place.plane(second)])
    }
}
