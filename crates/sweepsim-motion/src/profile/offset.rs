//! Profiles at a distance: the outline of all points no farther than that from a solid of revolution.
//!
//! Segments move outward along their normals, and arcs join them at convex corners. At concave ones the pieces
//! intersect: they are cut there, and what is nearer to the profile than the distance is dropped (Tiller, Hanson
//! 1984, *Offsets of two-dimensional profiles*). What remains is joined from the axis to the axis. Caves that the
//! offset closes are filled.

use super::{Profile, ProfileError, ProfileSegment, Turn};
use nalgebra::Vector2;
use std::f64::consts::TAU;

type Point = Vector2<f64>;

/// Lengths below this part of the profile's size are nothing.
const NOTHING: f64 = 1e-9;

/// A line, or an arc from an angle by an angle: counter-clockwise if that is positive.
#[derive(Clone, Copy, Debug)]
enum Piece {
    Line {
        from: Point,
        to: Point,
    },
    Arc {
        centre: Point,
        radius: f64,
        from: f64,
        by: f64,
    },
}

fn on_circle(centre: Point, radius: f64, angle: f64) -> Point {
    centre + radius * Point::new(angle.cos(), angle.sin())
}

impl Piece {
    fn arc(centre: Point, from: Point, to: Point, turn: Turn) -> Self {
        let angle = |p: Point| (p.y - centre.y).atan2(p.x - centre.x);
        let around = (angle(to) - angle(from)).rem_euclid(TAU);
        let by = match turn {
            Turn::Ccw => around,
            Turn::Cw => around - TAU,
        };
        Self::Arc {
            centre,
            radius: (from - centre).norm(),
            from: angle(from),
            by,
        }
    }

    fn at(&self, s: f64) -> Point {
        match *self {
            Self::Line { from, to } => from + s * (to - from),
            Self::Arc {
                centre,
                radius,
                from,
                by,
            } => on_circle(centre, radius, from + s * by),
        }
    }

    fn direction(&self, s: f64) -> Point {
        match *self {
            Self::Line { from, to } => (to - from).normalize(),
            Self::Arc { from, by, .. } => {
                let angle = from + s * by;
                by.signum() * Point::new(-angle.sin(), angle.cos())
            }
        }
    }

    fn length(&self) -> f64 {
        match *self {
            Self::Line { from, to } => (to - from).norm(),
            Self::Arc { radius, by, .. } => radius * by.abs(),
        }
    }

    /// Moved to its right by `distance`; `None` for an arc that vanishes.
    fn moved(&self, distance: f64) -> Option<Self> {
        match *self {
            Self::Line { from, to } => {
                let way = (to - from).normalize();
                let by = distance * Point::new(way.y, -way.x);
                Some(Self::Line {
                    from: from + by,
                    to: to + by,
                })
            }
            Self::Arc {
                centre,
                radius,
                from,
                by,
            } => {
                let radius = radius + distance * by.signum();
                (radius > 0.0).then_some(Self::Arc {
                    centre,
                    radius,
                    from,
                    by,
                })
            }
        }
    }

    /// The part between two parameters.
    fn part(&self, a: f64, b: f64) -> Self {
        match *self {
            Self::Line { .. } => Self::Line {
                from: self.at(a),
                to: self.at(b),
            },
            Self::Arc {
                centre,
                radius,
                from,
                by,
            } => Self::Arc {
                centre,
                radius,
                from: from + a * by,
                by: (b - a) * by,
            },
        }
    }

    /// The parameter of a point on its line or circle.
    fn parameter(&self, p: Point) -> f64 {
        match *self {
            Self::Line { from, to } => (p - from).dot(&(to - from)) / (to - from).norm_squared(),
            Self::Arc { centre, from, by, .. } => {
                let angle = (p.y - centre.y).atan2(p.x - centre.x);
                ((angle - from) * by.signum()).rem_euclid(TAU) / by.abs()
            }
        }
    }

    fn distance(&self, p: Point) -> f64 {
        let s = self.parameter(p);
        let ends = (p - self.at(0.0)).norm().min((p - self.at(1.0)).norm());
        match *self {
            _ if !(0.0..=1.0).contains(&s) => ends,
            Self::Line { .. } => (p - self.at(s)).norm(),
            Self::Arc { centre, radius, .. } => ((p - centre).norm() - radius).abs(),
        }
    }

    /// Where the lines or circles of both intersect.
    fn crossings(&self, other: &Self) -> Vec<Point> {
        match (*self, *other) {
            (Self::Line { from, to }, Self::Line { from: a, to: b }) => {
                let (d, e) = (to - from, b - a);
                let sine = d.perp(&e);
                if sine.abs() <= f64::EPSILON * d.norm() * e.norm() {
                    return Vec::new();
                }
                vec![from + d * ((a - from).perp(&e) / sine)]
            }
            (Self::Line { from, to }, Self::Arc { centre, radius, .. }) => {
                let way = (to - from).normalize();
                let foot = from + way * way.dot(&(centre - from));
                let half = radius * radius - (foot - centre).norm_squared();
                if half < 0.0 {
                    return Vec::new();
                }
                vec![foot - way * half.sqrt(), foot + way * half.sqrt()]
            }
            (Self::Arc { .. }, Self::Line { .. }) => other.crossings(self),
            (
                Self::Arc { centre, radius, .. },
                Self::Arc {
                    centre: next,
                    radius: other,
                    ..
                },
            ) => {
                let between = next - centre;
                let apart = between.norm();
                if apart == 0.0 {
                    return Vec::new();
                }
                let along = (apart * apart + radius * radius - other * other) / (2.0 * apart);
                let half = radius * radius - along * along;
                if half < 0.0 {
                    return Vec::new();
                }
                let (way, foot) = (between / apart, centre + between * (along / apart));
                let aside = half.sqrt() * Point::new(-way.y, way.x);
                vec![foot - aside, foot + aside]
            }
        }
    }

    fn mirrored(&self) -> Self {
        let flip = |p: Point| Point::new(-p.x, p.y);
        match *self {
            Self::Line { from, to } => Self::Line {
                from: flip(from),
                to: flip(to),
            },
            Self::Arc {
                centre,
                radius,
                from,
                by,
            } => Self::Arc {
                centre: flip(centre),
                radius,
                from: TAU / 2.0 - from,
                by: -by,
            },
        }
    }
}

impl Profile {
    /// The profile of all points no farther than `distance` from the solid: exact, of lines and arcs. Profiles with
    /// splines become the offset of the cylinder that holds them, which is larger.
    ///
    /// ```
    /// use sweepsim_motion::{Profile, ProfileSegment};
    /// // A cylinder of radius 2: its offset by 1 has rounded rims.
    /// let corners = [[2.0, 0.0], [2.0, 5.0], [0.0, 5.0]];
    /// let cylinder = Profile::new([0.0, 0.0], corners.map(|to| ProfileSegment::Line { to }).into())?;
    /// let wider = cylinder.offset(1.0)?;
    /// assert_eq!((wider.start(), wider.segments().len()), ([0.0, -1.0], 5));
    /// # Ok::<(), sweepsim_motion::ProfileError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProfileError`]: `distance` is negative or not finite, or so large or small beside the profile that numbers
    /// cannot hold the result.
    pub fn offset(&self, distance: f64) -> Result<Self, ProfileError> {
        if distance == 0.0 {
            return Ok(self.clone());
        }
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(ProfileError::Offset { distance });
        }
        let own = self.outline();
        let size = own.iter().map(Piece::length).sum::<f64>() + distance;
        let all: Vec<Piece> = own.iter().flat_map(|piece| [*piece, piece.mirrored()]).collect();
        let axis = Piece::Line {
            from: Point::zeros(),
            to: Point::new(0.0, 1.0),
        };
        let moved = around(&own, distance);
        let mut kept = Vec::new();
        for piece in &moved {
            let mut cuts = vec![0.0, 1.0];
            for other in moved.iter().chain([&axis]) {
                let crossings = piece.crossings(other).into_iter().map(|p| piece.parameter(p));
                cuts.extend(crossings.filter(|s| (0.0..=1.0).contains(s)));
            }
            cuts.sort_by(f64::total_cmp);
            // Where all of what is around a cut stays, it was none: pieces that touch meet somewhere near their joint.
            let mut open: Option<[f64; 2]> = None;
            for pair in cuts.windows(2) {
                let part = piece.part(pair[0], pair[1]);
                let middle = part.at(0.5);
                let near = || all.iter().map(|own| own.distance(middle)).fold(f64::INFINITY, f64::min);
                if part.length() <= NOTHING * size {
                    continue;
                }
                if middle.x > 0.0 && near() > distance - NOTHING * size {
                    open = Some([open.map_or(pair[0], |[begin, _]| begin), pair[1]]);
                } else if let Some([begin, end]) = open.take() {
                    kept.push(piece.part(begin, end));
                }
            }
            kept.extend(open.map(|[begin, end]| piece.part(begin, end)));
        }
        chain(kept, size).ok_or(ProfileError::Offset { distance })?
    }

    /// The segments as pieces; of a profile with splines, those of the cylinder that holds it.
    fn outline(&self) -> Vec<Piece> {
        let mut from = Point::from(self.start);
        let mut all = Vec::with_capacity(self.segments.len());
        for segment in &self.segments {
            let (to, piece) = match *segment {
                ProfileSegment::Line { to } => (to, Piece::Line { from, to: to.into() }),
                ProfileSegment::Arc { to, centre, turn } => (to, Piece::arc(centre.into(), from, to.into(), turn)),
                ProfileSegment::Spline { .. } => return self.cylinder(),
            };
            all.push(piece);
            from = to.into();
        }
        all
    }

    fn cylinder(&self) -> Vec<Piece> {
        let pieces = self.pieces();
        let points = || {
            pieces
                .iter()
                .flat_map(|piece| piece.curves())
                .flat_map(|curve| curve.points)
        };
        let radius = points().map(|p| p.x).fold(0.0, f64::max);
        let low = points().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = points().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let corners = [[0.0, low], [radius, low], [radius, high], [0.0, high]].map(Point::from);
        let line = |pair: &[Point]| Piece::Line {
            from: pair[0],
            to: pair[1],
        };
        corners.windows(2).map(line).collect()
    }
}

/// The pieces moved outward, with arcs at convex corners, on the axis as well.
fn around(own: &[Piece], distance: f64) -> Vec<Piece> {
    let mut all = Vec::new();
    // The mirrored half ends as level as the profile begins, and the other way round.
    let level = [Point::new(1.0, 0.0), Point::new(-1.0, 0.0)];
    let corner = |at: Point, before: Point, after: Point, all: &mut Vec<Piece>| {
        if before.perp(&after) > f64::EPSILON {
            let normal = |way: Point| at + distance * Point::new(way.y, -way.x);
            all.push(Piece::arc(at, normal(before), normal(after), Turn::Ccw));
        }
    };
    for (number, piece) in own.iter().enumerate() {
        let before = number.checked_sub(1).map_or(level[0], |k| own[k].direction(1.0));
        corner(piece.at(0.0), before, piece.direction(0.0), &mut all);
        all.extend(piece.moved(distance));
    }
    if let Some(last) = own.last() {
        corner(last.at(1.0), last.direction(1.0), level[1], &mut all);
    }
    all
}

/// The profile that the pieces form, from the lowest point on the axis.
fn chain(mut pieces: Vec<Piece>, size: f64) -> Option<Result<Profile, ProfileError>> {
    // Cuts are accurate to the square root of a rounding where pieces touch.
    let close = 1e-6 * size;
    let first = (0..pieces.len())
        .filter(|k| pieces[*k].at(0.0).x < close)
        .min_by(|a, b| pieces[*a].at(0.0).y.total_cmp(&pieces[*b].at(0.0).y))?;
    let mut piece = pieces.swap_remove(first);
    let start = [0.0, piece.at(0.0).y];
    let mut segments = Vec::new();
    loop {
        let end = piece.at(1.0);
        let is_last = end.x < close;
        let to = [if is_last { 0.0 } else { end.x }, end.y];
        segments.push(match piece {
            Piece::Line { .. } => ProfileSegment::Line { to },
            Piece::Arc { centre, by, .. } => ProfileSegment::Arc {
                to,
                centre: centre.into(),
                turn: if by > 0.0 { Turn::Ccw } else { Turn::Cw },
            },
        });
        if is_last {
            return Some(Profile::checked(start, segments));
        }
        let gap = |k: &usize| (pieces[*k].at(0.0) - end).norm();
        let next = (0..pieces.len()).min_by(|a, b| gap(a).total_cmp(&gap(b)));
        let next = next.filter(|k| gap(k) < close)?;
        piece = pieces.swap_remove(next);
    }
}
