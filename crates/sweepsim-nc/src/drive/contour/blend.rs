//! Rounded corners and chamfers between two moves of a contour.

use std::f64::consts::TAU;

use super::corner::{Curve, Flat, arc_tangent, cross, dot, length, meetings, minus, plus};
use super::stroke::{ArcPlane, Bend, ProgramPlace, Stroke};
use crate::text::error::NcProblem;

/// The sine of the turn, one degree, up to which a corner has no length (*Sinumerik ISO Milling*, Optional chamfering and
/// corner rounding, as on Fanuc): moves that are meant to be tangential are that only up to rounded numbers.
const TANGENTIAL: f64 = 0.017_452;

/// What is made of a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CornerShape {
    /// An arc of this radius, tangential to both moves.
    Round(f64),
    /// A line that cuts this much off each of two lines.
    Cut(f64),
    /// A line of this length, that cuts as much off each of two lines.
    Edge(f64),
}

/// A corner at the end of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub shape: CornerShape,
    pub plane: ArcPlane,
    pub place: ProgramPlace,
    /// The feed along it, if not that of the next move.
    pub feed: Option<f64>,
    /// Its word, for messages.
    pub word: &'static str,
    /// Whether a corner that cannot be made is an error, rather than left as it is.
    pub strict: bool,
}

/// A corner between two moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Blend {
    /// The first move, up to the corner.
    pub first: Stroke,
    /// The arc or line between the moves.
    pub between: Stroke,
    /// Where the second move starts, and what it is from there.
    pub from: [f64; 3],
    pub second: Stroke,
}

/// What becomes of a corner.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outcome {
    Made(Box<Blend>),
    /// Both moves are in line: there is no corner.
    InLine,
    /// A move leaves the plane, and a corner that is not [`strict`](Corner::strict) stays as it is.
    OutOfPlane,
}

/// A move in the plane of its corner.
struct CornerSide {
    curve: Curve,
    start: Flat,
    end: Flat,
    sweep: f64,
    length: f64,
}

impl CornerSide {
    fn new([u, v, _]: ArcPlane, from: [f64; 3], stroke: &Stroke) -> Self {
        let (start, end) = ([from[u], from[v]], [stroke.end[u], stroke.end[v]]);
        match stroke.bend {
            None => {
                let way = minus(end, start);
                let size = length(way);
                Self {
                    curve: Curve::Line {
                        point: start,
                        direction: [way[0] / size, way[1] / size],
                    },
                    start,
                    end,
                    sweep: 0.0,
                    length: size,
                }
            }
            Some(Bend { centre, sweep }) => {
                let radius = length(minus(end, centre));
                Self {
                    curve: Curve::Circle {
                        centre,
                        radius,
                        counter_clockwise: sweep > 0.0,
                    },
                    start,
                    end,
                    sweep,
                    length: radius * sweep.abs(),
                }
            }
        }
    }

    /// The direction at one of its points.
    fn direction(&self, at: Flat) -> Flat {
        match self.curve {
            Curve::Line { direction, .. } => direction,
            Curve::Circle {
                centre,
                counter_clockwise,
                ..
            } => arc_tangent(at, centre, counter_clockwise),
        }
    }

    /// The curve at the distance `by` to the left; `None` where it has no radius left.
    fn offset(&self, by: f64) -> Option<Curve> {
        match self.curve {
            Curve::Line { point, direction } => Some(Curve::Line {
                point: plus(point, by, [-direction[1], direction[0]]),
                direction,
            }),
            Curve::Circle {
                centre,
                radius,
                counter_clockwise,
            } => {
                let radius = if counter_clockwise { radius - by } else { radius + by };
                (radius > 0.0).then_some(Curve::Circle {
                    centre,
                    radius,
                    counter_clockwise,
                })
            }
        }
    }

    /// Its point nearest to `centre`.
    fn foot(&self, centre: Flat) -> Flat {
        match self.curve {
            Curve::Line { point, direction } => plus(point, dot(minus(centre, point), direction), direction),
            Curve::Circle {
                centre: about, radius, ..
            } => {
                let out = minus(centre, about);
                plus(about, radius / length(out), out)
            }
        }
    }

    /// Which share of it is before a point of its curve: negative or above 1 outside of it.
    fn share(&self, at: Flat) -> f64 {
        match self.curve {
            Curve::Line { direction, .. } => dot(minus(at, self.start), direction) / self.length,
            Curve::Circle { centre, .. } => {
                let (a, b) = (minus(self.start, centre), minus(at, centre));
                let angle = cross(a, b).atan2(dot(a, b)) * self.sweep.signum();
                let rounding = 1e-9;
                let angle = if angle < -rounding { angle + TAU } else { angle };
                angle / self.sweep.abs()
            }
        }
    }
}

/// The corner between the move from `start` and the next one.
///
/// # Errors
/// What the corner cannot be made for.
pub(crate) fn blend(start: [f64; 3], first: &Stroke, second: &Stroke, corner: &Corner) -> Result<Outcome, NcProblem> {
    let plane = corner.plane;
    let [u, v, w] = plane;
    let refuse = |what: String, expected: &str| Err(NcProblem::unsupported(what, expected.to_owned()));
    let p = first.end;
    let leaves = |stroke: &Stroke| stroke.bend.is_some() && stroke.plane != plane;
    if start[w] != p[w] || second.end[w] != p[w] || leaves(first) || leaves(second) {
        if !corner.strict {
            return Ok(Outcome::OutOfPlane);
        }
        return refuse(
            format!("{} at corners out of the plane are", corner.word),
            "expected both moves in the plane",
        );
    }
    // Siemens: "F, FRC and FRCM are not active when a chamfer is traversed with G0".
    if corner.strict && (first.rapid || second.rapid) {
        return refuse(
            format!("{} at a rapid is", corner.word),
            "expected it between two feed moves",
        );
    }
    if first.abc != second.abc {
        return refuse(
            format!("{} where rotary axes turn is", corner.word),
            "expected a corner of moves in the plane",
        );
    }
    let (a, b) = (CornerSide::new(plane, start, first), CornerSide::new(plane, p, second));
    if !(a.length > 0.0 && b.length > 0.0) {
        return Ok(Outcome::InLine);
    }
    let (ta, tb) = (a.direction(a.end), b.direction(b.start));
    let turn = cross(ta, tb);
    if turn.abs() <= TANGENTIAL && dot(ta, tb) > 0.0 {
        return Ok(Outcome::InLine);
    }
    let too_large = |size: f64, takes: f64| {
        let what = match corner.shape {
            CornerShape::Round(_) => format!("the radius of {}", corner.word),
            _ => format!("the length of {}", corner.word),
        };
        NcProblem::value(
            what,
            size,
            format!(
                "smaller: its corner takes {takes} mm of moves of {} and {} mm",
                a.length, b.length
            ),
        )
    };
    let slack = 1e-12;
    let (one, two, bend) = match corner.shape {
        CornerShape::Round(radius) => {
            let left = turn.signum();
            let (Some(inner), Some(outer)) = (a.offset(left * radius), b.offset(left * radius)) else {
                return Err(too_large(radius, radius));
            };
            let corner_at = a.end;
            let fits = |centre: &Flat| {
                let (one, two) = (a.foot(*centre), b.foot(*centre));
                (a.share(one), b.share(two))
            };
            let found = meetings(&inner, &outer)
                .into_iter()
                .min_by(|m, n| length(minus(*m, corner_at)).total_cmp(&length(minus(*n, corner_at))));
            let Some(centre) = found else {
                return Err(too_large(radius, radius));
            };
            let (before, after) = fits(&centre);
            if !(before >= -slack && before <= 1.0 + 1e-9 && after >= -1e-9 && after <= 1.0 + slack) {
                let takes = ((1.0 - before) * a.length).max(after * b.length);
                return Err(too_large(radius, takes));
            }
            let (one, two) = (a.foot(centre), b.foot(centre));
            let (from, to) = (minus(one, centre), minus(two, centre));
            let sweep = left * (left * cross(from, to)).atan2(dot(from, to)).rem_euclid(TAU);
            (one, two, Some(Bend { centre, sweep }))
        }
        CornerShape::Cut(size) | CornerShape::Edge(size) => {
            if first.bend.is_some() || second.bend.is_some() {
                return refuse(
                    format!("{} at an arc is", corner.word),
                    "expected it between two lines, or the contour with it",
                );
            }
            // Half of the angle between both lines.
            let half = 0.5 * turn.abs().atan2(-dot(ta, tb));
            let cut = match corner.shape {
                CornerShape::Edge(_) => 0.5 * size / half.sin(),
                _ => size,
            };
            if !(cut <= a.length * (1.0 + slack) && cut <= b.length * (1.0 + slack)) {
                return Err(too_large(size, cut));
            }
            (plus(a.end, -cut, ta), plus(b.start, cut, tb), None)
        }
    };
    let at = |point: Flat| {
        let mut xyz = p;
        xyz[u] = point[0];
        xyz[v] = point[1];
        xyz
    };
    let part = |stroke: &Stroke, share: f64| {
        stroke.bend.map(|bend| Bend {
            sweep: bend.sweep * share,
            ..bend
        })
    };
    Ok(Outcome::Made(Box::new(Blend {
        first: Stroke {
            end: at(one),
            bend: part(first, a.share(one)),
            ..*first
        },
        between: Stroke {
            end: at(two),
            bend,
            plane,
            place: corner.place,
            feed: corner.feed.or(second.feed),
            ..*second
        },
        from: at(two),
        second: Stroke {
            bend: part(second, 1.0 - b.share(two)),
            ..*second
        },
    })))
}
