//! The half outline of a tool of revolution: lines, arcs and splines in the `(ρ, ζ)` half-plane.

use crate::bezier::{self, Bezier, Outline};
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, TAU};
use sweepsim_spline::{KnotError, SplineError};
use thiserror::Error;

/// Which way round an arc runs, seen with `ρ` to the right and `ζ` up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Clockwise.
    Cw,
    /// Counter-clockwise.
    Ccw,
}

/// One piece of a [`Profile`], from where the one before ended. Lengths in `(ρ, ζ)`.
#[derive(Clone, Debug, PartialEq)]
pub enum ProfileSegment {
    /// A straight line.
    Line {
        /// Where it ends.
        to: [f64; 2],
    },
    /// A circular arc of less than a full turn.
    Arc {
        /// Where it ends.
        to: [f64; 2],
        /// Centre of its circle.
        centre: [f64; 2],
        /// Which way round.
        turn: Turn,
    },
    /// A B-spline curve, rational when it has weights.
    Spline {
        /// Its degree, from 1 to 7.
        degree: usize,
        /// `degree + 1` more than points, clamped: the first and the last occur `degree + 1` times. `None` spaces them evenly.
        knots: Option<Vec<f64>>,
        /// Control points: the first is where the segment before ended, the last where this one ends.
        points: Vec<[f64; 2]>,
        /// One for each point, positive. `None` are all 1.
        weights: Option<Vec<f64>>,
    },
}

/// The outline of a solid of revolution, from the tip on the axis to the top on the axis, with the material on its left:
/// what makes a tool of lines, arcs and splines.
///
/// Invariants: finite; `ρ ≥ 0`, and `ρ = 0` at the two ends and nowhere else; starts below where it ends; no segment
/// degenerate; does not cross or touch itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    start: [f64; 2],
    segments: Vec<ProfileSegment>,
}

/// Why a list of segments is no profile. `segment` counts from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ProfileError {
    /// There is no segment.
    #[error("a profile needs at least one segment")]
    Empty,
    /// A number is not finite.
    #[error("profile segment {segment} has a number that is not finite")]
    NotFinite {
        /// Which segment.
        segment: usize,
    },
    /// It does not begin or end on the axis.
    #[error("the profile is open: it must begin and end on the axis (rho = 0), but {which} is at rho = {rho}")]
    Open {
        /// `"its start"` or `"its end"`.
        which: &'static str,
        /// The radius there.
        rho: f64,
    },
    /// It ends below or at its start.
    #[error(
        "the profile must run upwards along the axis, from the tip at zeta = {start} to a top above it, but ends at zeta = {end}"
    )]
    UpsideDown {
        /// `ζ` of the start.
        start: f64,
        /// `ζ` of the end.
        end: f64,
    },
    /// A segment reaches the axis between the two ends, or crosses it.
    #[error("profile segment {segment} reaches the axis (rho = {rho}) between the tip and the top")]
    AcrossAxis {
        /// Which segment.
        segment: usize,
        /// The smallest radius.
        rho: f64,
    },
    /// A segment has no length.
    #[error("profile segment {segment} has no length")]
    NoLength {
        /// Which segment.
        segment: usize,
    },
    /// The two ends of an arc lie at different distances from its centre.
    #[error("profile segment {segment} is no arc: its ends are {from} and {to} away from its centre")]
    NoArc {
        /// Which segment.
        segment: usize,
        /// Distance of the start from the centre.
        from: f64,
        /// Distance of the end from the centre.
        to: f64,
    },
    /// A spline that is none, or not one of an outline.
    #[error("profile segment {segment}: {fault}")]
    Spline {
        /// Which segment.
        segment: usize,
        /// What is wrong.
        fault: SplineFault,
    },
    /// Two segments cross or touch other than at their common end. A spline may do so with itself.
    #[error("the profile crosses or touches itself: segments {first} and {second}")]
    SelfCrossing {
        /// The one segment.
        first: usize,
        /// The other.
        second: usize,
    },
    /// A measure of a built-in tool is not positive, or does not fit another.
    #[error("{what} is {value}, but must be {expected}")]
    Measure {
        /// Which measure.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
}

/// Why a spline is no segment of a profile. Points, weights and knots count from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SplineFault {
    /// The degree is 0 or too high.
    #[error("degree {degree} of a spline must be from 1 to {most}")]
    Degree {
        /// The degree.
        degree: usize,
        /// What is possible.
        most: usize,
    },
    /// Fewer points than the degree needs.
    #[error("the spline has {found} points, but its degree needs at least {least}")]
    Points {
        /// How many there must be.
        least: usize,
        /// How many there are.
        found: usize,
    },
    /// Not one weight for each point.
    #[error("the spline has {found} weights for {expected} points")]
    Weights {
        /// How many points there are.
        expected: usize,
        /// How many weights there are.
        found: usize,
    },
    /// A weight is not positive, or so small that the normals would be lost in rounding.
    #[error("weight {index} of the spline is {value}, but must be positive and at least 1e-4 of the largest")]
    Weight {
        /// Which weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Not as many knots as points and degree need.
    #[error("the spline has {found} knots, but needs {expected}: its points, its degree and one more")]
    KnotCount {
        /// How many there must be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// The knots are none.
    #[error("the spline's knots: {0}")]
    Knots(KnotError),
    /// The first or last knot does not occur often enough.
    #[error(
        "the spline's first and last knot must each occur once more than its degree, so that it begins and ends at its points"
    )]
    Clamped,
    /// The curve jumps at a knot.
    #[error("the spline jumps at knot {knot}: it occurs more often than the degree")]
    Jump {
        /// Where.
        knot: f64,
    },
    /// It begins elsewhere than the segment before ended.
    #[error("the spline begins at ({}, {}), but the profile is at ({}, {}) there", .found[0], .found[1], .expected[0], .expected[1])]
    Start {
        /// Its first point.
        found: [f64; 2],
        /// Where the segment before ended.
        expected: [f64; 2],
    },
    /// A cusp, a fold, or control points so close together that the curve has no direction.
    #[error("the spline has no direction or turns back somewhere near ({}, {})", .near[0], .near[1])]
    Stops {
        /// The middle of the piece between knots.
        near: [f64; 2],
    },
    /// The spline cannot be taken apart.
    #[error("the spline: {0}")]
    Other(SplineError),
}

/// A part of a segment with its start, ready for geometry.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The segment it is of.
    pub segment: usize,
    pub from: Vector2<f64>,
    pub to: Vector2<f64>,
    pub shape: Shape,
    /// It goes on smoothly from the one before because a spline's knots say so.
    pub smooth: bool,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Line,
    Arc(Arc),
    /// A piece between knots, of degree 2 or more.
    Bezier(Bezier),
}

/// Centre, radius, start angle and signed sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    pub centre: Vector2<f64>,
    pub radius: f64,
    pub start: f64,
    pub sweep: f64,
}

/// The distances of an arc's two ends from its centre may differ by this part of the radius.
const ARC_SLACK: f64 = 1e-6;

impl Piece {
    /// Adds the pieces of a segment.
    fn add(
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
                if from == to {
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
                if from == to || ra == 0.0 {
                    return Err(ProfileError::NoLength { segment: index });
                }
                if (ra - rb).abs() > ARC_SLACK * ra.max(rb) {
                    return Err(ProfileError::NoArc {
                        segment: index,
                        from: ra,
                        to: rb,
                    });
                }
                // Files give few digits: the centre is moved along its bisector, so that both ends lie on one circle exactly.
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
                    Shape::Arc(Arc {
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
                for span in bezier::spans(index, from, degree, knots.as_deref(), points, weights.as_deref())? {
                    let curve = span.curve;
                    let (from, to) = (curve.points[0], curve.points[curve.points.len() - 1]);
                    if degree == 1 && from == to {
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

    fn arc(&self) -> Option<Arc> {
        match self.shape {
            Shape::Arc(arc) => Some(arc),
            Shape::Line | Shape::Bezier(_) => None,
        }
    }

    /// The same as curves, arcs in parts of at most a quarter.
    fn curves(&self) -> Vec<Bezier> {
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
    fn arc_parameter(arc: &Arc, angle: f64) -> f64 {
        let turn = if arc.sweep > 0.0 {
            angle - arc.start
        } else {
            arc.start - angle
        };
        turn.rem_euclid(TAU) / arc.sweep.abs()
    }

    fn smallest_rho(&self) -> f64 {
        let mut rho = self.from.x.min(self.to.x);
        if let Some(arc) = self.arc()
            && Self::arc_parameter(&arc, std::f64::consts::PI) < 1.0
        {
            rho = rho.min(arc.centre.x - arc.radius);
        }
        rho
    }

    fn length(&self) -> f64 {
        match &self.shape {
            Shape::Line => (self.to - self.from).norm(),
            Shape::Arc(arc) => arc.radius * arc.sweep.abs(),
            Shape::Bezier(curve) => curve.length(),
        }
    }
}

impl Profile {
    /// A profile from `start` on the axis, through `segments`, to the top on the axis.
    ///
    /// # Errors
    /// [`ProfileError`]: open, upside down, across the axis, crossing itself, or a segment that is none.
    pub fn new(start: [f64; 2], segments: Vec<ProfileSegment>) -> Result<Self, ProfileError> {
        let profile = Self { start, segments };
        let pieces = profile.try_pieces()?;
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else {
            return Err(ProfileError::Empty);
        };
        if first.from.x != 0.0 {
            return Err(ProfileError::Open {
                which: "its start",
                rho: first.from.x,
            });
        }
        if last.to.x != 0.0 {
            return Err(ProfileError::Open {
                which: "its end",
                rho: last.to.x,
            });
        }
        if last.to.y <= first.from.y {
            return Err(ProfileError::UpsideDown {
                start: first.from.y,
                end: last.to.y,
            });
        }
        let scale = pieces.iter().map(Piece::length).sum::<f64>();
        for (number, piece) in pieces.iter().enumerate() {
            let segment = piece.segment;
            if let Shape::Bezier(curve) = &piece.shape {
                if let Some(rho) = curve.reaches_axis(number == 0, number + 1 == pieces.len()) {
                    return Err(ProfileError::AcrossAxis { segment, rho });
                }
                continue;
            }
            // Away from the two ends the axis must stay clear; near them the piece must leave it.
            let inner = (number > 0 || piece.at(0.5).x <= 0.0, number + 1 < pieces.len());
            let rho = piece.smallest_rho();
            let touches = (inner.0 && number > 0 && piece.from.x <= 0.0) || (inner.1 && piece.to.x <= 0.0);
            if rho < -1e-12 * scale || touches || piece.at(0.5).x <= 0.0 {
                return Err(ProfileError::AcrossAxis { segment, rho });
            }
        }
        if pieces.iter().any(|piece| matches!(piece.shape, Shape::Bezier(_))) {
            let curves = pieces
                .iter()
                .flat_map(|piece| piece.curves().into_iter().map(|curve| (piece.segment, curve)));
            if let Some((first, second)) = Outline::new(curves, scale)?.crossing() {
                return Err(ProfileError::SelfCrossing { first, second });
            }
            return Ok(profile);
        }
        for second in 0..pieces.len() {
            for first in 0..second {
                if crosses(&pieces[first], &pieces[second], second == first + 1, scale) {
                    return Err(ProfileError::SelfCrossing {
                        first: pieces[first].segment,
                        second: pieces[second].segment,
                    });
                }
            }
        }
        Ok(profile)
    }

    /// Where the outline begins: the tip, `(0, ζ)`.
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// The segments, from the tip to the top.
    #[must_use]
    pub fn segments(&self) -> &[ProfileSegment] {
        &self.segments
    }

    fn try_pieces(&self) -> Result<Vec<Piece>, ProfileError> {
        let mut from = Vector2::from(self.start);
        let mut pieces = Vec::with_capacity(self.segments.len());
        for (index, segment) in self.segments.iter().enumerate() {
            Piece::add(index, from, segment, &mut pieces)?;
            from = pieces.last().map_or(from, |piece| piece.to);
        }
        Ok(pieces)
    }

    /// The segments with their starts.
    pub(crate) fn pieces(&self) -> Vec<Piece> {
        self.try_pieces().expect("a profile was checked when it was made")
    }
}

/// Whether two lines or arcs have a point in common (other than the one where `consecutive` ones join).
fn crosses(a: &Piece, b: &Piece, consecutive: bool, scale: f64) -> bool {
    let near = 1e-9 * scale;
    let on = |piece: &Piece, p: Vector2<f64>| -> bool {
        match piece.arc() {
            None => {
                let d = piece.to - piece.from;
                let s = (p - piece.from).dot(&d) / d.norm_squared();
                (-1e-9..=1.0 + 1e-9).contains(&s)
            }
            Some(arc) => {
                let d = p - arc.centre;
                let s = Piece::arc_parameter(&arc, d.y.atan2(d.x));
                let full = TAU / arc.sweep.abs();
                s <= 1.0 + 1e-9 || s >= full - 1e-9
            }
        }
    };
    let mut meets: Vec<Vector2<f64>> = Vec::new();
    match (a.arc(), b.arc()) {
        (None, None) => {
            let (d, e) = (a.to - a.from, b.to - b.from);
            let det = d.perp(&e);
            if det.abs() > 1e-12 * d.norm() * e.norm() {
                meets.push(a.from + d * ((b.from - a.from).perp(&e) / det));
            } else if (b.from - a.from).perp(&d).abs() <= near * d.norm() {
                // Collinear: overlapping parts show at an end of one inside the other.
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
    // A tangent joint resolves its double meeting point only to the square root of the rounding.
    meets
        .into_iter()
        .any(|p| on(a, p) && on(b, p) && !(consecutive && (p - a.to).norm() <= 1e-4 * a.length().min(b.length())))
}
