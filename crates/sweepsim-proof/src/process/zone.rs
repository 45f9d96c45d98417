//! Zones: parts of the surface of a moving solid of revolution, and times.

use super::record::Bytes;
use super::ring::Ring;
use super::samples::{Samples, Turned};
use crate::tool::{Convex, Piece};
use nalgebra::Vector3;
use smallvec::{SmallVec, smallvec};
use std::f64::consts::{FRAC_PI_2, TAU};

/// What of a solid is looked at, and when.
#[derive(Clone, Debug)]
pub(super) struct Zone {
    /// Parts of its outline.
    pub pieces: SmallVec<[Piece; 1]>,
    /// Before they are looked at one by one: arcs count as the balls that they are part of.
    pub is_whole: bool,
    /// Around the axis, from [an arbitrary direction](Turned); all around if none.
    pub angles: Option<[f64; 2]>,
    /// With all that is between it and the axis.
    pub is_filled: bool,
    pub times: [f64; 2],
}

/// A zone of which one end is held and the other is not is divided between them, unless it is so much longer otherwise.
const MIXED: f64 = 16.0;
/// Wider sectors are taken as the whole ring.
const WIDEST: f64 = 2.0;
/// How zones are divided, in a [record](super::record).
const TIME: u8 = 10;
const PIECES: u8 = 11;
const HEIGHT: u8 = 12;
const ANGLES: u8 = 13;
const CUT: u8 = 14;

impl Zone {
    /// All of the surface of a solid all along a stretch, or all of the solid where it begins.
    pub fn whole(solid: &Convex, is_filled: bool) -> Self {
        Self {
            pieces: solid.pieces().iter().cloned().collect(),
            is_whole: true,
            angles: None,
            is_filled,
            times: [0.0, if is_filled { 0.0 } else { 1.0 }],
        }
    }

    /// Circles of the outline, each with the radius of a ball around its points, whose hull with the axis holds it.
    pub fn profile(&self) -> SmallVec<[([f64; 2], f64); 8]> {
        let mut all = SmallVec::new();
        for piece in &self.pieces {
            let own: SmallVec<[([f64; 2], f64); 8]> = match piece {
                Piece::Line(ends) => ends.iter().map(|end| (*end, 0.0)).collect(),
                Piece::Points(points) => points.iter().map(|point| (*point, 0.0)).collect(),
                // Its ends are in the ball, but count for where the middle of the zone is.
                Piece::Arc { centre, radius, angles } if self.is_whole => {
                    let [first, last] = angles.map(|angle| (at(*centre, angle, *radius), 0.0));
                    smallvec![first, (*centre, *radius), last]
                }
                // Both ends, and where their tangents meet.
                Piece::Arc { centre, radius, angles } => {
                    let half = 0.5 * (angles[1] - angles[0]);
                    smallvec![
                        (at(*centre, angles[0], *radius), 0.0),
                        (at(*centre, angles[0] + half, radius / half.cos()), 0.0),
                        (at(*centre, angles[1], *radius), 0.0)
                    ]
                }
            };
            all.extend(own);
        }
        // Where lines meet.
        if self.is_whole {
            all.dedup();
        }
        all
    }

    /// Below a height that a record can name, and above it, if there is something; and how a record says so.
    pub fn cut(&self, height: f64) -> Option<(Bytes, [Self; 2])> {
        let height = (height as f32).next_up();
        if !height.is_finite() {
            return None;
        }
        let own = f64::from(height);
        let reaches = |side: f64| {
            self.profile()
                .iter()
                .any(|(p, thick)| side * (p[1] - own) + thick > 0.0)
        };
        let part = |side: f64| Self {
            pieces: { self.pieces.iter() }
                .filter_map(|piece| beyond(piece, own, side))
                .collect(),
            ..self.clone()
        };
        (reaches(-1.0) && reaches(1.0)).then(|| {
            let bytes = [CUT].into_iter().chain(height.to_le_bytes()).collect();
            (bytes, [part(-1.0), part(1.0)])
        })
    }

    /// Rings whose hull holds the zone at its first and last time; and so at all times between them, but for the
    /// [bend](Stretch::bend).
    pub fn samples(&self, turned: &Turned) -> Samples {
        let mut samples = Samples::default();
        let profile = self.profile();
        let [from, to] = self.times;
        let spin = turned.spin(to - from);
        let angles = self.angles.map(|[a, b]| [a - spin, b + spin]);
        let angles = angles.filter(|[a, b]| b - a <= WIDEST);
        let ends: &[f64] = if to > from { &[from, to] } else { &[from] };
        for time in ends {
            let at = turned.stretch.at(*time);
            match angles {
                None => samples
                    .rings
                    .extend(profile.iter().map(|([radius, height], thick)| Ring {
                        centre: at.tip + at.axis * *height,
                        axis: at.axis,
                        radius: radius.max(0.0),
                        thick: *thick,
                    })),
                Some([a, b]) => {
                    let half = 0.5 * (b - a);
                    for ([radius, height], _) in &profile {
                        let mut add = |radius: f64, angle: f64| {
                            let point = turned.point(&at, [radius, *height], angle);
                            samples.rings.push(Ring::point(point));
                        };
                        add(*radius, a);
                        add(*radius, b);
                        // Where the tangents meet.
                        add(*radius / half.cos(), a + half);
                        if self.is_filled {
                            add(0.0, a);
                        }
                    }
                }
            }
            if samples.first == 0 && to > from {
                samples.first = samples.rings.len();
            }
        }
        samples.across = match angles {
            None => 1,
            Some(_) if self.is_filled => 4,
            Some(_) => 3,
        };
        samples
    }

    /// A point in the middle of it, and the normal there; none of a whole solid.
    pub fn middle(&self, turned: &Turned) -> Option<(f64, Vector3<f64>, Vector3<f64>)> {
        let (place, normal) = match &self.pieces[..] {
            [Piece::Arc { centre, radius, angles }] if !self.is_whole => {
                let middle = 0.5 * (angles[0] + angles[1]);
                (at(*centre, middle, *radius), at([0.0; 2], middle, 1.0))
            }
            [piece] if !self.is_whole => {
                let points = match piece {
                    Piece::Line(ends) => &ends[..],
                    Piece::Points(points) => points,
                    Piece::Arc { .. } => return None,
                };
                let ([.., b], [a, ..]) = (points, points) else {
                    return None;
                };
                let way = [b[0] - a[0], b[1] - a[1]];
                let length = way[0].hypot(way[1]).max(f64::MIN_POSITIVE);
                ([0, 1].map(|k| 0.5 * (a[k] + b[k])), [way[1] / length, -way[0] / length])
            }
            _ => return None,
        };
        let angle = self.angles.map_or(0.0, |[a, b]| 0.5 * (a + b));
        let time = 0.5 * (self.times[0] + self.times[1]);
        let at = turned.stretch.at(time);
        let point = turned.point(&at, place, angle);
        let beyond = turned.point(&at, [place[0] + normal[0], place[1] + normal[1]], angle);
        Some((time, point, beyond - point))
    }

    /// Smaller zones of it, or nothing if it is smaller than `least`; and how a record says so.
    ///
    /// `mixed`: whether of its [samples](Samples::mixed) some are held and others are not, along each dimension: it is
    /// divided there first. `bends`: whether it must be shorter.
    pub fn divided(
        &self,
        solid: &Convex,
        turned: &Turned,
        mixed: [bool; 3],
        (least, bends): (f64, bool),
    ) -> (u8, Vec<Self>) {
        let travel = turned.stretch.travel(solid.reach(), self.times[1] - self.times[0]);
        if self.is_whole {
            let far = if mixed[0] { 0.25 } else { 2.0 };
            if travel > least && (bends || travel > far * solid.reach()) {
                return (TIME, self.halves_of_time());
            }
            let one = |piece: &Piece| Self {
                pieces: smallvec![piece.clone()],
                is_whole: false,
                ..self.clone()
            };
            return (PIECES, self.pieces.iter().map(one).collect());
        }
        let (height, width) = self.size();
        let width = match self.angles {
            None if !turned.has_angles() => 0.0,
            // All around, rings bound as well as points.
            None => width / MIXED,
            Some(_) => width,
        };
        let lengths = [travel, height, width];
        if lengths.iter().all(|length| *length <= least) {
            return (0, Vec::new());
        }
        let weight = |k: usize| match k {
            0 if bends && travel > 0.0 => f64::INFINITY,
            _ if mixed[k] => MIXED * lengths[k],
            _ => lengths[k],
        };
        match (0..3).max_by(|a, b| weight(*a).total_cmp(&weight(*b))) {
            Some(0) => (TIME, self.halves_of_time()),
            Some(1) => (HEIGHT, self.halves_of_height()),
            _ => (ANGLES, self.sectors()),
        }
    }

    fn halves_of_time(&self) -> Vec<Self> {
        let [from, to] = self.times;
        let middle = 0.5 * (from + to);
        let half = |times| Self { times, ..self.clone() };
        vec![half([from, middle]), half([middle, to])]
    }

    fn halves_of_height(&self) -> Vec<Self> {
        let halves = match &self.pieces[..] {
            [Piece::Line([a, b])] => {
                let middle = [0, 1].map(|k| 0.5 * (a[k] + b[k]));
                [Piece::Line([*a, middle]), Piece::Line([middle, *b])]
            }
            [
                Piece::Arc {
                    centre,
                    radius,
                    angles: [from, to],
                },
            ] => {
                let middle = 0.5 * (from + to);
                [[*from, middle], [middle, *to]].map(|angles| Piece::Arc {
                    centre: *centre,
                    radius: *radius,
                    angles,
                })
            }
            _ => return Vec::new(),
        };
        let half = |piece| Self {
            pieces: smallvec![piece],
            ..self.clone()
        };
        halves.map(half).to_vec()
    }

    fn sectors(&self) -> Vec<Self> {
        let zone = |angles| Self {
            angles: Some(angles),
            ..self.clone()
        };
        match self.angles {
            None => (0..4)
                .map(|k| zone([k, k + 1].map(|k| FRAC_PI_2 * f64::from(k))))
                .collect(),
            Some([a, b]) => vec![zone([a, 0.5 * (a + b)]), zone([0.5 * (a + b), b])],
        }
    }

    /// How long it is along the outline, as far as it can be divided there, and around the axis.
    fn size(&self) -> (f64, f64) {
        let (height, radius) = match &self.pieces[..] {
            [Piece::Line([a, b])] => ((b[0] - a[0]).hypot(b[1] - a[1]), a[0].max(b[0])),
            [Piece::Arc { centre, radius, angles }] => (radius * (angles[1] - angles[0]), centre[0] + radius),
            _ => (
                0.0,
                self.profile().iter().map(|(place, _)| place[0]).fold(0.0, f64::max),
            ),
        };
        (height, radius * self.angles.map_or(TAU, |[a, b]| b - a))
    }
}

/// At an angle around a centre, and a distance from it.
fn at(centre: [f64; 2], angle: f64, distance: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [centre[0] + distance * cos, centre[1] + distance * sin]
}

/// What of a piece is above a height, or below it for a `side` of −1; of what is no line, all if some of it may be.
fn beyond(piece: &Piece, height: f64, side: f64) -> Option<Piece> {
    let over = |zeta: f64| side * (zeta - height);
    match piece {
        Piece::Line([a, b]) => {
            let cut = || {
                let share = (height - a[1]) / (b[1] - a[1]);
                [a[0] + (b[0] - a[0]) * share, height]
            };
            match [a, b].map(|p| over(p[1]) >= 0.0) {
                [true, true] => Some(piece.clone()),
                [true, false] => Some(Piece::Line([*a, cut()])),
                [false, true] => Some(Piece::Line([cut(), *b])),
                [false, false] => None,
            }
        }
        Piece::Arc { centre, radius, .. } => (over(centre[1]) + radius >= 0.0).then(|| piece.clone()),
        Piece::Points(points) => points.iter().any(|p| over(p[1]) >= 0.0).then(|| piece.clone()),
    }
}
