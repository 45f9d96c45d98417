//! What a piece of a tool of revolution leaves while the tool moves and turns: a part of the envelope.
//!
//! At each time t a point has a signed distance F from the piece. Where t is such that F is least, F is the distance
//! from the envelope, and grows in the same direction, since ∂F/∂t is 0 there. So distances are exact, whatever the
//! motion; parameters are an angle or a place along the piece, and the time.

mod motion;
mod place;
#[cfg(test)]
mod tests;

use motion::{Motion, Moving, ROOM};
use nalgebra::Vector3;
use std::sync::Arc;

/// Times between which the distance is looked at for a minimum, and steps to it.
const TIMES: usize = 32;
const STEPS: usize = 60;
/// How far beyond its ends a piece is looked at, in parts of its length.
const BEYOND: f64 = 0.1;
/// Sines below which directions do not tell a normal.
const PARALLEL: f64 = 1e-6;

/// A piece of the outline of a tool of revolution, by distances from its axis and heights above its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SweptPiece {
    /// A line, which leaves a surface on each side of its way.
    Line {
        /// Where it begins.
        from: [f64; 2],
        /// Where it ends.
        to: [f64; 2],
        /// On the left, seen along the axis of the tool.
        left: bool,
    },
    /// The ball about a point of the axis.
    Ball {
        /// The height of the centre.
        height: f64,
        /// Its radius.
        radius: f64,
    },
    /// The torus around a circle about the axis, or the circle itself for `tube` 0.
    Circle {
        /// The radius of the circle and its height.
        at: [f64; 2],
        /// The radius of the torus.
        tube: f64,
        /// On which side of what the circle sweeps.
        upper: bool,
    },
}

/// The surface that a piece leaves.
#[derive(Clone, Debug)]
pub struct SweptSheet {
    motion: Arc<Motion>,
    piece: SweptPiece,
    /// Times with the places of the tool.
    times: Arc<Vec<(f64, Moving)>>,
    /// The direction that angles begin at.
    towards: Vector3<f64>,
    /// Whether the first parameter is turned round, so that normals point away from the tool.
    turned: bool,
}

impl PartialEq for SweptSheet {
    fn eq(&self, other: &Self) -> bool {
        self.piece == other.piece && (Arc::ptr_eq(&self.motion, &other.motion) || self.motion == other.motion)
    }
}

/// The point of a sheet that is nearest to another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    pub time: f64,
    pub distance: f64,
    pub grows: Vector3<f64>,
}

impl SweptSheet {
    /// The sheets that pieces leave on a motion: the tip and the axis at a time, smooth from somewhat before 0 to
    /// somewhat after 1. None if it is not as smooth as a polynomial, or a piece does not move.
    #[must_use]
    pub fn all(at: &dyn Fn(f64) -> ([f64; 3], [f64; 3]), pieces: &[SweptPiece]) -> Vec<Self> {
        let Some(motion) = Motion::new(at).map(Arc::new) else {
            return Vec::new();
        };
        let step = (1.0 + 2.0 * ROOM) / TIMES as f64;
        let times: Arc<Vec<_>> = Arc::new(
            (0..=TIMES)
                .map(|k| {
                    let t = k as f64 * step - ROOM;
                    (t, motion.at(t))
                })
                .collect(),
        );
        let one = |piece: &SweptPiece| {
            let mut sheet = Self {
                motion: motion.clone(),
                piece: *piece,
                times: times.clone(),
                towards: Vector3::x(),
                turned: false,
            };
            sheet.towards = sheet.across_all()?;
            sheet.turned = !sheet.is_right_handed()?;
            Some(sheet)
        };
        pieces.iter().filter_map(one).collect()
    }

    /// The axis of coordinates that is farthest from the direction about which angles are, at all times.
    fn across_all(&self) -> Option<Vector3<f64>> {
        let mut best = (0.05, None);
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let sines = self
                .times
                .iter()
                .map(|(_, at)| Some(self.pole(at)?.cross(&axis).norm()));
            let least = sines.collect::<Option<Vec<f64>>>()?.into_iter().fold(1.0, f64::min);
            if least > best.0 {
                best = (least, Some(axis));
            }
        }
        best.1
    }

    /// Whether the first parameter, the second and the outward normal are a right-handed system, where they are one.
    fn is_right_handed(&self) -> Option<bool> {
        let tried = [0.5, 0.25, 0.75, 0.1, 0.9]
            .into_iter()
            .flat_map(|t| [0.5, 2.0, -1.0, -2.5].map(|u| (u, t)));
        let found = tried.filter_map(|(u, t)| {
            let u = match self.piece {
                SweptPiece::Line { .. } => self.length() * (0.5 + 0.1 * u),
                _ => u,
            };
            let [_, by_u, by_t, _] = self.derivatives(u, t)?;
            let foot = self
                .foot(self.point(u, t)?)
                .filter(|foot| (foot.time - t).abs() < 1e-3)?;
            let volume = by_u.cross(&by_t).dot(&foot.grows);
            (volume.abs() > 1e-3 * by_u.norm() * by_t.norm()).then_some(volume > 0.0)
        });
        let found: Vec<bool> = found.collect();
        let right = found.iter().filter(|right| **right).count();
        (!found.is_empty()).then_some(2 * right > found.len())
    }

    /// The length of a line.
    fn length(&self) -> f64 {
        match self.piece {
            SweptPiece::Line { from, to, .. } => (to[0] - from[0]).hypot(to[1] - from[1]),
            _ => 1.0,
        }
    }

    /// Whether the first parameter is an angle.
    pub(crate) fn is_round(&self) -> bool {
        !matches!(self.piece, SweptPiece::Line { .. })
    }

    /// The length of a unit of each parameter, about.
    pub(crate) fn scale(&self) -> [f64; 2] {
        let [start, end] = [0, TIMES].map(|k| self.times[k].1.tip);
        let radius = match self.piece {
            SweptPiece::Line { .. } => 1.0,
            SweptPiece::Ball { radius, .. } => radius,
            SweptPiece::Circle { at, tube, .. } => at[0] + tube,
        };
        [radius, (end - start).norm().max(radius)]
    }

    /// The nearest point of the sheet.
    pub(crate) fn foot(&self, p: Vector3<f64>) -> Option<Foot> {
        let slopes: Vec<f64> = self.times.iter().map(|(_, at)| self.slope(p, at)).collect();
        let mut best: Option<Foot> = None;
        for k in 0..TIMES {
            // Where it begins to grow: a minimum.
            if !(slopes[k] <= 0.0 && slopes[k + 1] > 0.0) {
                continue;
            }
            let time = self.root([self.times[k].0, self.times[k + 1].0], [slopes[k], slopes[k + 1]], p);
            let Some((distance, grows)) = self.distance(p, &self.motion.at(time)) else {
                continue;
            };
            if best.is_none_or(|best| distance.abs() < best.distance.abs()) {
                best = Some(Foot { time, distance, grows });
            }
        }
        best
    }

    /// The time between two at which the slope is 0, by the Illinois method.
    fn root(&self, [mut a, mut b]: [f64; 2], [mut low, mut high]: [f64; 2], p: Vector3<f64>) -> f64 {
        let mut before = 0.0;
        for _ in 0..STEPS {
            let t = (a * high - b * low) / (high - low);
            let slope = self.slope(p, &self.motion.at(t));
            let shorter = if slope > 0.0 { b - t } else { t - a };
            if slope == 0.0 || shorter < 1e-15 {
                return t;
            }
            // An end that stays twice counts for half.
            let again = slope * before > 0.0;
            if slope > 0.0 {
                (b, high) = (t, slope);
                low *= if again { 0.5 } else { 1.0 };
            } else {
                (a, low) = (t, slope);
                high *= if again { 0.5 } else { 1.0 };
            }
            before = slope;
        }
        0.5 * (a + b)
    }

    /// The signed distance and its direction; as of Surface.
    pub(crate) fn at(&self, p: Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
        self.foot(p).map(|foot| (foot.distance, foot.grows))
    }

    /// The parameters of the nearest point.
    pub(crate) fn uv(&self, p: Vector3<f64>) -> Option<[f64; 2]> {
        let foot = self.foot(p)?;
        let u = self.parameter(p, &self.motion.at(foot.time))?;
        Some([if self.turned { -u } else { u }, foot.time])
    }

    /// The point with these parameters.
    pub(crate) fn place(&self, [u, t]: [f64; 2]) -> Option<Vector3<f64>> {
        self.point(if self.turned { -u } else { u }, t)
    }

    /// The point with these parameters, and its derivatives by the first, the second and both.
    pub(crate) fn jet(&self, [u, t]: [f64; 2]) -> Option<[Vector3<f64>; 4]> {
        if !self.turned {
            return self.derivatives(u, t);
        }
        let [p, by_u, by_t, by_both] = self.derivatives(-u, t)?;
        Some([p, -by_u, by_t, -by_both])
    }

    /// All its numbers.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let piece = match self.piece {
            SweptPiece::Line { from, to, left } => [from[0], from[1], to[0], to[1], f64::from(u8::from(left))],
            SweptPiece::Ball { height, radius } => [height, radius, 0.0, 0.0, 2.0],
            SweptPiece::Circle { at, tube, upper } => [at[0], at[1], tube, 0.0, 3.0 + f64::from(u8::from(upper))],
        };
        piece.into_iter().chain(self.motion.numbers()).collect()
    }

    /// A point in the middle.
    pub(crate) fn middle(&self) -> Vector3<f64> {
        self.motion.at(0.5).tip
    }
}
