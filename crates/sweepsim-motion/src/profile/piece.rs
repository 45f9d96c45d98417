//! The segments of a profile with their starts, with splines cut at their knots: the basis of its geometry.

use super::{Bezier, ProfileError, ProfileSegment, Turn, spline_spans};
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A part of a segment with its start, ready for geometry.
#[derive(Clone, Debug)]
pub(crate) struct OutlinePiece {
    /// The segment that it belongs to.
    pub segment: usize,
    pub from: Vector2<f64>,
    pub to: Vector2<f64>,
    pub shape: Shape,
    /// Whether it continues the previous piece smoothly because of a spline's knots.
    pub smooth: bool,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Line,
    Arc(OutlineArc),
    /// A piece between knots, of degree 2 or more.
    Bezier(Bezier),
}

/// Centre, radius, start angle and signed sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutlineArc {
    pub centre: Vector2<f64>,
    pub radius: f64,
    pub start: f64,
    pub sweep: f64,
}

/// Segments and radii shorter than this have no direction in `f64`, since squares of lengths underflow.
const LEAST: f64 = 1e-100;

/// The distances of an arc's two ends from its centre may differ by this fraction of the radius.
const ARC_SLACK: f64 = 1e-6;

/// Points this close, in parts of the profile's size or of a segment's parameter, count as one: far above rounding, far
/// below what a profile means.
const NEAR: f64 = 1e-9;
/// Lines with a smaller sine between them are parallel: rounding alone would move their intersection by more than
/// [`NEAR`].
const PARALLEL: f64 = 1e-12;
/// Around a tangent joint, intersections this close to it, in parts of the shorter piece, are the joint itself: a
/// double intersection is resolved only to the square root of the rounding error.
const AT_JOINT: f64 = 1e-4;

impl OutlinePiece {
    /// Adds the pieces of a segment.
    pub(super) fn add(
        index: usize,
        from: Vector2<f64>,
        segment: &ProfileSegment,
        pieces: &mut Vec<Self>,
    ) -> Result<(), ProfileError> {
        let not_finite = ProfileError::NotFinite { segment: index };
        let simple = |to: Vector2<f64>, shape: Shape| Self {
            segment: index,
            from,
            to,
            shape,
            smooth: false,
        };
        let finite = |p: Vector2<f64>| p.iter().all(|c| c.is_finite() && c.abs() < 1e100);
        match *segment {
            ProfileSegment::Line { to } => {
                let to = Vector2::from(to);
                if !finite(from) || !finite(to) {
                    return Err(not_finite);
                }
                if !((to - from).norm() > LEAST) {
                    return Err(ProfileError::NoLength { segment: index });
                }
                pieces.push(simple(to, Shape::Line));
            }
            ProfileSegment::Arc { to, centre, turn } => {
                let (to, centre) = (Vector2::from(to), Vector2::from(centre));
                if !finite(from) || !finite(to) || !finite(centre) {
                    return Err(not_finite);
                }
                let (a, b) = (from - centre, to - centre);
                let (ra, rb) = (a.norm(), b.norm());
                if !((to - from).norm() > LEAST && ra > LEAST) {
                    return Err(ProfileError::NoLength { segment: index });
                }
                if (ra - rb).abs() > ARC_SLACK * ra.max(rb) {
                    return Err(ProfileError::NoArc {
                        segment: index,
                        from: ra,
                        to: rb,
                    });
                }
                // Files have few digits, so the centre is moved to the bisector of the ends, which then lie exactly on
                // one circle.
                let chord = (to - from).normalize();
                let centre = centre + chord * (from + (to - from) * 0.5 - centre).dot(&chord);
                let (a, b) = (from - centre, to - centre);
                let (ra, rb) = (a.norm(), b.norm());
                let start = a.y.atan2(a.x);
                let mut sweep = a.perp(&b).atan2(a.dot(&b));
                match turn {
                    Turn::Ccw if sweep <= 0.0 => sweep += TAU,
                    Turn::Cw if sweep >= 0.0 => sweep -= TAU,
                    _ => {}
                }
                let radius = 0.5 * (ra + rb);
                pieces.push(simple(
                    to,
                    Shape::Arc(OutlineArc {
                        centre,
                        radius,
                        start,
                        sweep,
                    }),
                ));
            }
            ProfileSegment::Spline {
                degree,
                ref knots,
                ref points,
                ref weights,
            } => {
                if !finite(from) {
                    return Err(not_finite);
                }
                for span in spline_spans::spans(index, from, degree, knots.as_deref(), points, weights.as_deref())? {
                    let curve = span.curve;
                    let (from, to) = (curve.points[0], curve.points[curve.points.len() - 1]);
                    if degree == 1 && !((to - from).norm() > LEAST) {
                        return Err(ProfileError::NoLength { segment: index });
                    }
                    pieces.push(Self {
                        segment: index,
                        from,
                        to,
                        shape: if degree == 1 { Shape::Line } else { Shape::Bezier(curve) },
                        smooth: span.smooth,
                    });
                }
            }
        }
        Ok(())
    }

    pub(super) fn arc(&self) -> Option<OutlineArc> {
        match self.shape {
            Shape::Arc(arc) => Some(arc),
            Shape::Line | Shape::Bezier(_) => None,
        }
    }

    /// The same as curves, with arcs in parts of at most a quarter.
    pub(crate) fn curves(&self) -> Vec<Bezier> {
        match &self.shape {
            Shape::Line => vec![Bezier::line(self.from, self.to)],
            Shape::Bezier(curve) => vec![curve.clone()],
            Shape::Arc(arc) => {
                let count = (arc.sweep.abs() / FRAC_PI_2).ceil().max(1.0);
                let half = 0.5 * arc.sweep / count;
                let on = |angle: f64, radius: f64| arc.centre + Vector2::new(angle.cos(), angle.sin()) * radius;
                (0..count as usize)
                    .map(|part| {
                        let middle = arc.start + half * (2 * part + 1) as f64;
                        let ends = [part as f64, (part + 1) as f64].map(|k| self.at(k / count));
                        Bezier {
                            points: vec![ends[0], on(middle, arc.radius / half.cos()), ends[1]],
                            weights: vec![1.0, half.cos(), 1.0],
                        }
                    })
                    .collect()
            }
        }
    }

    /// The point at `s` in `[0, 1]`.
    pub(crate) fn at(&self, s: f64) -> Vector2<f64> {
        match &self.shape {
            Shape::Line => self.from + (self.to - self.from) * s,
            Shape::Bezier(curve) => curve.at(s),
            Shape::Arc(arc) => {
                let angle = arc.start + s * arc.sweep;
                arc.centre + Vector2::new(angle.cos(), angle.sin()) * arc.radius
            }
        }
    }

    /// The unit direction of travel where it begins or ends.
    pub(crate) fn direction(&self, end: bool) -> Vector2<f64> {
        match &self.shape {
            Shape::Line => (self.to - self.from).normalize(),
            Shape::Bezier(curve) => curve.direction(end),
            Shape::Arc(arc) => {
                let angle = if end { arc.start + arc.sweep } else { arc.start };
                Vector2::new(-angle.sin(), angle.cos()) * arc.sweep.signum()
            }
        }
    }

    /// How far rounding may have turned that direction.
    pub(crate) fn direction_error(&self, end: bool) -> f64 {
        match &self.shape {
            Shape::Line | Shape::Arc(_) => 0.0,
            Shape::Bezier(curve) => curve.direction_error(end),
        }
    }

    /// The parameters in `(0, 1)` at which the arc's direction from its centre is `angle`.
    fn arc_parameter(arc: &OutlineArc, angle: f64) -> f64 {
        let turn = if arc.sweep > 0.0 {
            angle - arc.start
        } else {
            arc.start - angle
        };
        turn.rem_euclid(TAU) / arc.sweep.abs()
    }

    pub(super) fn smallest_rho(&self) -> f64 {
        let mut rho = self.from.x.min(self.to.x);
        if let Some(arc) = self.arc()
            && Self::arc_parameter(&arc, std::f64::consts::PI) < 1.0
        {
            rho = rho.min(arc.centre.x - arc.radius);
        }
        rho
    }

    pub(super) fn length(&self) -> f64 {
        match &self.shape {
            Shape::Line => (self.to - self.from).norm(),
            Shape::Arc(arc) => arc.radius * arc.sweep.abs(),
            Shape::Bezier(curve) => curve.length(),
        }
    }
}

/// Whether two lines or arcs have a point in common (other than the one where `consecutive` ones join).
pub(super) fn crosses(a: &OutlinePiece, b: &OutlinePiece, consecutive: bool, scale: f64) -> bool {
    let near = NEAR * scale;
    let on = |piece: &OutlinePiece, p: Vector2<f64>| -> bool {
        match piece.arc() {
            None => {
                let d = piece.to - piece.from;
                let s = (p - piece.from).dot(&d) / d.norm_squared();
                (-NEAR..=1.0 + NEAR).contains(&s)
            }
            Some(arc) => {
                let d = p - arc.centre;
                let s = OutlinePiece::arc_parameter(&arc, d.y.atan2(d.x));
                let full = TAU / arc.sweep.abs();
                s <= 1.0 + NEAR || s >= full - NEAR
            }
        }
    };
    let mut meets: Vec<Vector2<f64>> = Vec::new();
    match (a.arc(), b.arc()) {
        (None, None) => {
            let (d, e) = (a.to - a.from, b.to - b.from);
            let det = d.perp(&e);
            if det.abs() > PARALLEL * d.norm() * e.norm() {
                meets.push(a.from + d * ((b.from - a.from).perp(&e) / det));
            } else if (b.from - a.from).perp(&d).abs() <= near * d.norm() {
                // Collinear segments that overlap have an end of one inside the other.
                meets.extend([a.from, a.to, b.from, b.to]);
            }
        }
        (Some(arc), None) | (None, Some(arc)) => {
            let line = if a.arc().is_some() { b } else { a };
            let d = (line.to - line.from).normalize();
            let foot = line.from + d * (arc.centre - line.from).dot(&d);
            let height = (foot - arc.centre).norm();
            let square = arc.radius * arc.radius - height * height;
            if square > -near * arc.radius {
                let half = square.max(0.0).sqrt();
                meets.extend([foot - d * half, foot + d * half]);
            }
        }
        (Some(p), Some(q)) => {
            let d = q.centre - p.centre;
            let distance = d.norm();
            if distance <= near {
                if (p.radius - q.radius).abs() <= near {
                    meets.extend([a.from, a.to, b.from, b.to]);
                }
            } else {
                let along = (distance * distance + p.radius * p.radius - q.radius * q.radius) / (2.0 * distance);
                let square = p.radius * p.radius - along * along;
                if square > -near * p.radius {
                    let half = square.max(0.0).sqrt();
                    let e = d / distance;
                    let normal = Vector2::new(-e.y, e.x);
                    meets.extend([
                        p.centre + e * along + normal * half,
                        p.centre + e * along - normal * half,
                    ]);
                }
            }
        }
    }
    meets
        .into_iter()
        .any(|p| on(a, p) && on(b, p) && !(consecutive && (p - a.to).norm() <= AT_JOINT * a.length().min(b.length())))
}
