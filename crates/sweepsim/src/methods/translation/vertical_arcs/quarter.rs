//! A stretch of a cone or torus with one height at each radius and one radius at each height.

use crate::cutter::outline::{Monotone, Piece, Shape};
use crate::methods::sheets::intervals::{Range, hull};

/// Cones are left to charts that are flatter or steeper than this.
const FLATTEST: f64 = 1e-6;
/// So are tori that are smaller than so many rounding errors.
const SMALLEST: f64 = 1e6;

#[derive(Clone, Copy, Debug)]
pub(super) struct Quarter {
    /// Ascending.
    pub radii: Range,
    /// Heights with the sign with which they grow with the radius, ascending.
    pub ends: Range,
    pub climb: f64,
    /// The signs of the unit normal `(e, f)`. On a torus, this is the direction from the centre of its tube.
    pub signs: [f64; 2],
    /// 1 if `(e, f)` is the outward normal, otherwise −1.
    pub out: f64,
    /// The curvature of the meridian.
    pub bend: f64,
    pub profile: Profile,
}

/// The meridian, by heights with the sign.
#[derive(Clone, Copy, Debug)]
pub(super) enum Profile {
    /// The normal, and how fast the radius grows with the height.
    Cone { normal: [f64; 2], rate: f64 },
    /// The centre and the radius of the tube.
    Torus { middle: f64, level: f64, tube: f64 },
}

/// The radius at a place, with `e` and `f²`.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeridianPoint {
    pub rho: f64,
    pub e: f64,
    pub square: f64,
}

impl Quarter {
    /// Those of a cone or a torus, in any order. `None` for other pieces, and for those that almost have no width.
    pub fn all(piece: &Piece, slack: f64) -> Option<Vec<Self>> {
        match piece.shape {
            Shape::Line { normal } => {
                let cone = |radii: Range, ends: Range, _| Profile::Cone {
                    normal,
                    rate: (radii[1] - radii[0]) / (ends[1] - ends[0]),
                };
                let own = Self::new([piece.from, piece.to], (normal, 1.0, 0.0), cone);
                let wide = [own.radii, own.ends].iter().all(|[low, high]| low < high);
                (wide && normal.iter().all(|c| c.abs() > FLATTEST)).then(|| vec![own])
            }
            Shape::Arc {
                centre, radius, out, ..
            } => (radius > SMALLEST * slack).then(|| {
                let torus = |_, _, climb| Profile::Torus {
                    middle: centre[0],
                    level: climb * centre[1],
                    tube: radius,
                };
                let quarter = |[(from, a), (to, b)]: [(f64, [f64; 2]); 2]| {
                    let (f, e) = (0.5 * (from + to)).sin_cos();
                    Self::new([a, b], ([e, f], out, radius.recip()), torus)
                };
                piece.monotone(Monotone::Both).into_iter().map(quarter).collect()
            }),
        }
    }

    fn new(
        ends: [[f64; 2]; 2],
        (normal, out, bend): ([f64; 2], f64, f64),
        profile: impl Fn(Range, Range, f64) -> Profile,
    ) -> Self {
        let signs = normal.map(|c| 1.0_f64.copysign(c));
        let climb = -signs[0] * signs[1];
        let [[a, low], [b, high]] = ends;
        let (radii, ends) = (hull(a.max(0.0), b.max(0.0)), hull(climb * low, climb * high));
        Self {
            radii,
            ends,
            climb,
            signs,
            out,
            bend,
            profile: profile(radii, ends, climb),
        }
    }

    /// The rounding error of its coordinates, at least.
    pub fn rounding(&self) -> f64 {
        let own = match self.profile {
            Profile::Cone { .. } => 0.0,
            Profile::Torus { middle, level, tube } => middle.abs() + level.abs() + tube,
        };
        16.0 * f64::EPSILON * (own + self.radii[1] + self.ends[0].abs().max(self.ends[1].abs()))
    }

    /// By the radius.
    #[inline]
    pub fn at_radius(&self, rho: f64) -> MeridianPoint {
        let (e, square) = match self.profile {
            Profile::Cone { normal: [e, f], .. } => (e, f * f),
            Profile::Torus { middle, .. } => {
                let e = (rho - middle) * self.bend;
                (e, ((1.0 - e) * (1.0 + e)).max(0.0))
            }
        };
        MeridianPoint { rho, e, square }
    }

    /// By the height with its sign.
    #[inline]
    pub fn at_height(&self, x: f64) -> MeridianPoint {
        match self.profile {
            Profile::Cone { normal: [e, f], rate } => MeridianPoint {
                rho: self.radii[0] + rate * (x - self.ends[0]),
                e,
                square: f * f,
            },
            Profile::Torus { middle, level, tube } => {
                let k = x - level;
                let e = self.signs[0] * ((tube - k) * (tube + k)).max(0.0).sqrt() / tube;
                MeridianPoint {
                    rho: middle + e * tube,
                    e,
                    square: (k / tube) * (k / tube),
                }
            }
        }
    }

    /// The height at a place.
    pub fn height(&self, at: &MeridianPoint) -> f64 {
        match self.profile {
            Profile::Cone { rate, .. } => self.climb * (self.ends[0] + (at.rho - self.radii[0]) / rate),
            Profile::Torus { level, tube, .. } => self.climb * level + self.signs[1] * tube * at.square.sqrt(),
        }
    }

    /// Where it is at least as wide as `p`: the range of the place from which on it is. `None` if it is nowhere.
    pub fn from(&self, p: f64, slack: f64) -> Option<Range> {
        let [[thin, wide], [low, high]] = [self.radii, self.ends];
        let (p, doubt) = (p.abs(), 8.0 * slack);
        if p < thin - doubt {
            return Some([low; 2]);
        }
        if p > wide + doubt {
            return None;
        }
        let range = match self.profile {
            Profile::Cone { rate, .. } => {
                let (place, off) = (low + (p - thin) / rate, doubt * (1.0 + 1.0 / rate));
                [place - off, place + off]
            }
            Profile::Torus { middle, level, tube } => {
                let half_chord_sq = (tube - (p - middle)) * (tube + (p - middle));
                let doubt = 4.0 * doubt * tube;
                let [near, far] = [half_chord_sq - doubt, half_chord_sq + doubt].map(|square| square.max(0.0).sqrt());
                if self.signs[0] > 0.0 {
                    [level - far, level - near]
                } else {
                    [level + near, level + far]
                }
            }
        };
        Some([range[0].max(low), range[1].min(high).max(low)])
    }
}
