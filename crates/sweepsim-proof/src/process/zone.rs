//! Zones: parts of the surface of a moving solid of revolution, and times.

use super::ring::Ring;
use super::samples::{Samples, Turned};
use crate::tool::Convex;
use nalgebra::Vector3;
use smallvec::{SmallVec, smallvec};
use std::f64::consts::{FRAC_PI_2, TAU};

/// An arc of an outline: its centre, its radius, and the angles of its ends as seen from there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    centre: [f64; 2],
    radius: f64,
    angles: [f64; 2],
}

/// A stretch of the outline of a solid, `(ρ, ζ)`.
#[derive(Clone, Copy, Debug)]
pub(super) enum Outline {
    Whole,
    Line([[f64; 2]; 2]),
    Arc(Arc),
}

/// What of a solid is looked at, and when.
#[derive(Clone, Debug)]
pub(super) struct Zone {
    pub outline: Outline,
    /// Around the axis, from [an arbitrary direction](Turned); all around if none.
    pub angles: Option<[f64; 2]>,
    /// With all that is between it and the axis.
    pub is_filled: bool,
    pub times: [f64; 2],
    /// What is higher above the tip is left out.
    pub top: f64,
}

/// A zone of which one end is held and the other is not is divided between them, unless it is so much longer otherwise.
const MIXED: f64 = 16.0;
/// Wider sectors are taken as the whole ring.
const WIDEST: f64 = 2.0;

impl Zone {
    /// All of a solid between two times.
    pub fn whole(times: [f64; 2], is_filled: bool) -> Self {
        Self {
            outline: Outline::Whole,
            angles: None,
            is_filled,
            times,
            top: f64::INFINITY,
        }
    }

    /// Circles of the outline, each with the radius of a ball around its points, whose hull with the axis holds it.
    pub fn profile(&self, solid: &Convex) -> SmallVec<[([f64; 2], f64); 8]> {
        match &self.outline {
            Outline::Whole => {
                let lines = edges(solid).filter_map(|line| self.below(line));
                let corners = lines.flatten().map(|corner| (corner, 0.0));
                let arcs = solid.arcs().map(|(centre, radius, _)| (centre, radius));
                corners
                    .chain(arcs.filter(|(centre, radius)| centre[1] - radius < self.top))
                    .collect()
            }
            Outline::Line(ends) => self.below(*ends).into_iter().flatten().map(|end| (end, 0.0)).collect(),
            // Both ends, and where their tangents meet.
            Outline::Arc(arc) => {
                let half = 0.5 * (arc.angles[1] - arc.angles[0]);
                let top = arc.at(0.5, arc.radius / half.cos());
                smallvec![
                    (arc.at(0.0, arc.radius), 0.0),
                    (top, 0.0),
                    (arc.at(1.0, arc.radius), 0.0)
                ]
            }
        }
    }

    /// Rings whose hull holds the zone at its first and last time; and so at all times between them, but for the
    /// [bend](Stretch::bend).
    pub fn samples(&self, solid: &Convex, turned: &Turned) -> Samples {
        let mut samples = Samples::default();
        let profile = self.profile(solid);
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
        let (place, normal) = match &self.outline {
            Outline::Whole => return None,
            Outline::Line([a, b]) => {
                let way = [b[0] - a[0], b[1] - a[1]];
                let length = way[0].hypot(way[1]).max(f64::MIN_POSITIVE);
                ([0, 1].map(|k| 0.5 * (a[k] + b[k])), [way[1] / length, -way[0] / length])
            }
            Outline::Arc(arc) => {
                let place = arc.at(0.5, arc.radius);
                (place, [0, 1].map(|k| (place[k] - arc.centre[k]) / arc.radius))
            }
        };
        let angle = self.angles.map_or(0.0, |[a, b]| 0.5 * (a + b));
        let time = 0.5 * (self.times[0] + self.times[1]);
        let at = turned.stretch.at(time);
        let point = turned.point(&at, place, angle);
        let beyond = turned.point(&at, [place[0] + normal[0], place[1] + normal[1]], angle);
        Some((time, point, beyond - point))
    }

    /// Smaller zones of it, or nothing if it is smaller than `least`.
    ///
    /// `mixed`: whether of its [samples](Samples::mixed) some are held and others are not, along each dimension: it is
    /// divided there first. `bends`: whether it must be shorter.
    pub fn divided(&self, solid: &Convex, turned: &Turned, mixed: [bool; 3], (least, bends): (f64, bool)) -> Vec<Self> {
        let travel = turned.stretch.travel(solid.reach(), self.times[1] - self.times[0]);
        if matches!(self.outline, Outline::Whole) {
            let far = if mixed[0] { 0.25 } else { 2.0 };
            if travel > least && (bends || travel > far * solid.reach()) {
                return self.halves_of_time();
            }
            return self.stretches(solid);
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
            return Vec::new();
        }
        let weight = |k: usize| match k {
            0 if bends && travel > 0.0 => f64::INFINITY,
            _ if mixed[k] => MIXED * lengths[k],
            _ => lengths[k],
        };
        match (0..3).max_by(|a, b| weight(*a).total_cmp(&weight(*b))) {
            Some(0) => self.halves_of_time(),
            Some(1) => self.halves_of_height(),
            _ => self.sectors(),
        }
    }

    /// What of a line is below the top.
    fn below(&self, [a, b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let at_top = |from: [f64; 2], to: [f64; 2]| {
            let share = (self.top - from[1]) / (to[1] - from[1]);
            [from[0] + (to[0] - from[0]) * share, self.top]
        };
        match [a[1] > self.top, b[1] > self.top] {
            [true, true] => None,
            [true, false] => Some([at_top(b, a), b]),
            [false, true] => Some([a, at_top(a, b)]),
            [false, false] => Some([a, b]),
        }
    }

    fn halves_of_time(&self) -> Vec<Self> {
        let [from, to] = self.times;
        let middle = 0.5 * (from + to);
        let half = |times| Self { times, ..self.clone() };
        vec![half([from, middle]), half([middle, to])]
    }

    fn with(&self, outline: Outline) -> Self {
        Self {
            outline,
            ..self.clone()
        }
    }

    /// The lines and arcs of the outline, from the axis to the axis.
    fn stretches(&self, solid: &Convex) -> Vec<Self> {
        let lines = edges(solid).filter_map(|line| self.below(line));
        let lines = lines.map(|line| self.with(Outline::Line(line)));
        let arcs = solid.arcs().filter(|(centre, radius, _)| centre[1] - radius < self.top);
        let arcs = arcs.map(|(centre, radius, normals)| {
            let [from, to] = normals.map(|n| n[1].atan2(n[0]));
            let to = from + (to - from).rem_euclid(TAU);
            self.with(Outline::Arc(Arc {
                centre,
                radius,
                angles: [from, to.min(from + FRAC_PI_2)],
            }))
        });
        // Tangents of a quarter meet far outside.
        let arcs = arcs.flat_map(|arc| arc.halves_of_height());
        lines.chain(arcs).collect()
    }

    fn halves_of_height(&self) -> Vec<Self> {
        match &self.outline {
            Outline::Whole => Vec::new(),
            Outline::Line([a, b]) => {
                let middle = [0, 1].map(|k| 0.5 * (a[k] + b[k]));
                vec![
                    self.with(Outline::Line([*a, middle])),
                    self.with(Outline::Line([middle, *b])),
                ]
            }
            Outline::Arc(arc) => {
                let [from, to] = arc.angles;
                let middle = 0.5 * (from + to);
                let zone = |angles| self.with(Outline::Arc(Arc { angles, ..*arc }));
                vec![zone([from, middle]), zone([middle, to])]
            }
        }
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

    /// How long it is along the outline, and around the axis.
    fn size(&self) -> (f64, f64) {
        let (height, radius) = match &self.outline {
            Outline::Whole => (0.0, 0.0),
            Outline::Line([a, b]) => ((b[0] - a[0]).hypot(b[1] - a[1]), a[0].max(b[0])),
            Outline::Arc(arc) => (arc.radius * (arc.angles[1] - arc.angles[0]), arc.centre[0] + arc.radius),
        };
        (height, radius * self.angles.map_or(TAU, |[a, b]| b - a))
    }
}

/// The sides of a solid, but for the axis.
fn edges(solid: &Convex) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let corners = solid.corners();
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).filter(|(a, b)| a[0] > 0.0 || b[0] > 0.0);
    sides.map(|(a, b)| [*a, *b])
}

impl Arc {
    /// At a share of its angle, and a distance from the centre.
    fn at(&self, share: f64, distance: f64) -> [f64; 2] {
        let [from, to] = self.angles;
        let (sin, cos) = (from + (to - from) * share).sin_cos();
        [self.centre[0] + distance * cos, self.centre[1] + distance * sin]
    }
}
