//! A stretch of a cone, a torus or a cylinder with one radius at each height and, but for cylinders, one height at each
//! radius.

use crate::cutter::outline::{Piece, Shape};
use crate::methods::sheets::intervals::{Range, hull, scaled};

/// Cones are left to charts that are flatter than this,
const FLATTEST: f64 = 1e-6;
/// and where walls have no closed form, those that are steeper.
pub(super) const STEEPEST: f64 = 1e-6;
/// An arc is flat where its normal is nearer to the axis than 90° less this angle.
const FLAT: f64 = 1.52;
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

/// The circle at a height.
pub(super) struct Ring {
    pub radius: f64,
    /// How far off it may be, for each unit of the height's error.
    pub rate: f64,
    /// The same for the slope of the normal, `n_ζ/n_ρ`.
    pub turn: f64,
    pub normal: [f64; 2],
}

/// A range of heights.
pub(super) struct HeightRange {
    /// The first one counts, the last one does not.
    pub heights: Range,
    /// At both ends, if the arc is flat nowhere between.
    pub normals: Option<[[f64; 2]; 2]>,
}

impl Quarter {
    /// Those of a piece, in any order. `None` for discs and for what is almost one, or almost nothing. Left out is what
    /// is at most an end of its neighbour, by its radii if they are what tells, or by its heights.
    pub fn all(piece: &Piece, slack: f64, by_radius: bool) -> Option<Vec<Self>> {
        let counts = |own: &Self| {
            let [low, high] = if by_radius { own.radii } else { own.ends };
            high - low > slack
        };
        let quarters = Self::of(piece, slack)?;
        Some(quarters.into_iter().filter(counts).collect())
    }

    fn of(piece: &Piece, slack: f64) -> Option<Vec<Self>> {
        match piece.shape {
            Shape::Line { normal } => {
                let cone = |radii: Range, ends: Range, _| Profile::Cone {
                    normal,
                    rate: (radii[1] - radii[0]) / (ends[1] - ends[0]),
                };
                let own = Self::new([piece.from, piece.to], (normal, 1.0, 0.0), cone);
                (own.ends[0] < own.ends[1] && normal[0].abs() > FLATTEST).then(|| vec![own])
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
                piece.quarters().into_iter().map(quarter).collect()
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

    /// Ascending.
    pub fn heights(&self) -> Range {
        scaled(self.climb, self.ends)
    }

    /// `None` where it is almost perpendicular to the axis.
    #[inline]
    pub fn ring(&self, height: f64, slack: f64) -> Option<Ring> {
        let x = self.climb * height;
        let MeridianPoint { rho, e, square } = self.at_height(x);
        let (rate, turn, f) = match self.profile {
            Profile::Cone { normal: [e, f], .. } => ((f / e).abs(), 0.0, f),
            Profile::Torus { level, tube, .. } => {
                let wide = (e * tube).abs();
                if !(wide * wide > 512.0 * slack * (tube + slack)) {
                    return None;
                }
                let turn = tube * tube / (wide * wide * wide);
                ((x - level).abs() / wide, turn, self.signs[1] * square.sqrt())
            }
        };
        Some(Ring {
            radius: rho,
            rate,
            turn,
            normal: [self.out * e, self.out * f],
        })
    }

    /// Its parts by height, ascending and without gaps: where an arc is not [`FLAT`], with the normals at the ends of
    /// the part.
    pub fn parts(&self) -> Vec<HeightRange> {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let part = |heights, normals| HeightRange { heights, normals };
        let [low, high] = self.heights();
        let [side, up] = self.signs;
        let (centre, tube) = match self.profile {
            Profile::Cone { normal, .. } => return vec![part(all, Some([normal; 2]))],
            Profile::Torus { level, tube, .. } => (self.climb * level, tube),
        };
        let (rise, wide) = FLAT.sin_cos();
        let normal = |height: f64| {
            let f = ((height - centre) / tube).clamp(-rise, rise);
            let e = (1.0 - f * f).sqrt().max(wide);
            [self.out * side * e, self.out * f]
        };
        let normals = |a: f64, b: f64| Some([normal(a), normal(b)]);
        // From there on to the end where `f` is `up`.
        let flat = centre + up * tube * rise;
        let [steep, flats] = if up > 0.0 {
            [[all[0], flat], [flat, all[1]]]
        } else {
            [[flat, all[1]], [all[0], flat]]
        };
        match (up * (low - flat) < 0.0, up * (high - flat) < 0.0) {
            (true, true) => vec![part(all, normals(low, high))],
            (false, false) => vec![part(all, None)],
            _ => vec![
                part(steep, normals(low.max(steep[0]), high.min(steep[1]))),
                part(flats, None),
            ],
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
