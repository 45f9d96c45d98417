//! Stretches of a meridian over which the radius is monotone, and what a tool that stands along the dexels has there over a line.

use super::placed::Neighbour;

/// A stretch of the meridian over which the radius is monotone.
#[derive(Clone, Copy, Debug)]
pub(super) enum Radial {
    /// `ζ` at the smaller radius, its slope, the normal.
    Line { height: f64, slope: f64, normal: [f64; 2] },
    Arc {
        centre: [f64; 2],
        radius: f64,
        /// The sign of `ζ − ζ_c`.
        half: f64,
        out: f64,
    },
}

/// A stretch, its least and greatest radius, and how far a line may be off.
pub(super) struct Stretch<'a> {
    pub radial: &'a Radial,
    /// Negative without a hole.
    pub inner: f64,
    pub outer: f64,
    pub line_error: f64,
    /// Both moves, each with a bound of the error in [`same`](Self::same).
    ways: Option<[([f64; 3], f64); 2]>,
}

impl<'a> Stretch<'a> {
    pub fn new(radial: &'a Radial, [inner, outer]: [f64; 2], line_error: f64, sides: &[Neighbour; 2]) -> Self {
        // Of the normal, times the distance from the axis; see `change`.
        let off = line_error
            * match radial {
                Radial::Line { normal, .. } => normal[0].abs(),
                Radial::Arc { radius, .. } => 1.0 + outer / radius,
            };
        let rounding = 8.0 * f64::EPSILON * outer;
        let way = |side: &Neighbour| match side {
            Neighbour::Beyond(_) => None,
            Neighbour::Along(d) => Some((*d, d.iter().map(|c| c.abs()).sum::<f64>() * (off + rounding))),
        };
        Self {
            radial,
            inner,
            outer,
            line_error,
            ways: way(&sides[0])
                .zip(way(&sides[1]))
                .map(|(before, after)| [before, after]),
        }
    }

    /// Whether both signs of `g` are the same beyond doubt: by `g ρ |n_ζ|` on an arc, without a division.
    #[inline]
    pub fn same(&self, [x, y]: [f64; 2], rho: f64) -> bool {
        let Some(ways) = &self.ways else { return false };
        let ([out, up], weight) = match *self.radial {
            Radial::Line { normal, .. } => (normal, 1.0),
            Radial::Arc {
                centre, radius, half, ..
            } => {
                let e = (rho - centre[0]) / radius;
                let f = ((1.0 - e) * (1.0 + e)).max(0.0).sqrt();
                ([e, half * f], f)
            }
        };
        let sign = |([dx, dy, dz], error): &([f64; 3], f64)| {
            let g = weight * (out * (x * dx + y * dy) + up * dz * rho);
            (g, g.abs() > *error)
        };
        let [(g, sure), (h, certain)] = [sign(&ways[0]), sign(&ways[1])];
        sure & certain & ((g < 0.0) == (h < 0.0))
    }

    #[inline]
    pub fn at(&self, rho: f64) -> StretchPoint {
        self.radial.at(rho, [self.inner.max(0.0), self.outer])
    }
}

/// A point of a stretch.
pub(super) struct StretchPoint {
    pub height: f64,
    pub normal: [f64; 2],
    /// How fast the normal turns with the radius.
    pub bend: f64,
}

impl Radial {
    #[inline]
    fn at(&self, rho: f64, [inner, outer]: [f64; 2]) -> StretchPoint {
        match *self {
            Self::Line { height, slope, normal } => StretchPoint {
                height: height + (rho.clamp(inner, outer) - inner) * slope,
                normal,
                bend: 0.0,
            },
            Self::Arc {
                centre,
                radius,
                half,
                out,
            } => {
                let e = ((rho - centre[0]) / radius).clamp(-1.0, 1.0);
                let f = half * ((1.0 - e) * (1.0 + e)).sqrt();
                StretchPoint {
                    height: centre[1] + radius * f,
                    normal: [out * e, out * f],
                    bend: 1.0 / (radius * f.abs()),
                }
            }
        }
    }
}

/// The length of a vector, without care for overflow: coordinates are bounded.
pub(super) trait Hypot {
    fn hypot_fast(self, other: Self) -> Self;
}

impl Hypot for f64 {
    #[inline]
    fn hypot_fast(self, other: Self) -> Self {
        (self * self + other * other).sqrt()
    }
}
