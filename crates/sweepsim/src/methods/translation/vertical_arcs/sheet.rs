//! A stretch of a cone or torus about the dexels' direction with one height at each radius, and the curves parallel to its sections.

use super::roots::{self, Bounds, Curve};
use crate::cutter::outline::{Monotone, Piece, Shape};

/// Cones are left to charts that are flatter or steeper than this.
const FLATTEST: f64 = 1e-6;
/// So are arcs of the meridian over a smaller angle.
const SHORTEST: f64 = 1e-6;
/// Parts of the meridian beyond its vertical tangents that are smaller than this have no width.
const SLIVER: f64 = 1e-8;
/// A vanishing distance is beyond doubt from so many times its error on.
const CERTAIN: f64 = 64.0;

/// The meridian over a range of radii.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    /// Ascending.
    pub radii: [f64; 2],
    pub curve: Meridian,
    /// The sign of the vertical part of `(e, f)`.
    pub up: f64,
    /// 1 if `(e, f)` is the outward normal, otherwise −1.
    pub out: f64,
}

/// With the unit normal `(e, f)`: of a torus the direction from the centre of its tube.
#[derive(Clone, Copy, Debug)]
pub(super) enum Meridian {
    Cone {
        normal: [f64; 2],
        /// A point, and the height for each radius.
        from: [f64; 2],
        rate: f64,
    },
    Torus {
        centre: [f64; 2],
        tube: f64,
        /// `1/tube`.
        bend: f64,
    },
}

/// A curve parallel to the section of a sheet by a plane, over the half of it ahead of the axis: `Q(v) = v + side r ν(v)`, where `ν = e v/√D`, `D = v² + f² p²`, is the part of
/// the section's unit normal ahead.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parallel<'a> {
    pub sheet: &'a Sheet,
    /// The distance of the plane from the axis.
    pub p: f64,
    pub r: f64,
    pub side: f64,
    /// The rounding error of coordinates.
    pub slack: f64,
}

/// A point of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SheetPoint {
    /// The unknown.
    pub x: f64,
    pub v: f64,
    pub rho: f64,
    pub e: f64,
    /// `f²`.
    pub square: f64,
    pub nu: f64,
    /// `Q`.
    pub q: f64,
    /// `D`.
    pub norm_sq: f64,
}

impl Sheet {
    /// The sheets of a cone or a torus, in any order. `None` for other pieces, and for those that almost have no width.
    pub fn all(piece: &Piece, slack: f64) -> Option<Vec<Self>> {
        let ends = [piece.from[0], piece.to[0]].map(|rho| rho.max(0.0));
        let sorted = |[a, b]: [f64; 2]| [a.min(b), a.max(b)];
        match piece.shape {
            Shape::Line { normal } => normal.iter().all(|c| c.abs() > FLATTEST).then(|| {
                let rate = (piece.to[1] - piece.from[1]) / (piece.to[0] - piece.from[0]);
                vec![Self {
                    radii: sorted(ends),
                    curve: Meridian::Cone {
                        normal,
                        from: piece.from,
                        rate,
                    },
                    up: 1.0_f64.copysign(normal[1]),
                    out: 1.0,
                }]
            }),
            Shape::Arc {
                centre,
                radius,
                angles: [first, last],
                out,
            } => {
                if !(last - first > SHORTEST && radius * SHORTEST > slack) {
                    return None;
                }
                let curve = Meridian::Torus {
                    centre,
                    tube: radius,
                    bend: radius.recip(),
                };
                let sheet = |[(from, [a, _]), (to, [b, _])]: [(f64, [f64; 2]); 2]| {
                    (to - from > SLIVER).then(|| Self {
                        radii: sorted([a, b].map(|rho| rho.max(0.0))),
                        curve,
                        up: 1.0_f64.copysign((0.5 * (from + to)).sin()),
                        out,
                    })
                };
                Some(piece.monotone(Monotone::Radius).into_iter().filter_map(sheet).collect())
            }
        }
    }

    /// `e`, and `f²`.
    #[inline]
    fn normal(&self, rho: f64) -> [f64; 2] {
        match self.curve {
            Meridian::Cone { normal: [e, f], .. } => [e, f * f],
            Meridian::Torus { centre, bend, .. } => {
                let e = (rho - centre[0]) * bend;
                [e, ((1.0 - e) * (1.0 + e)).max(0.0)]
            }
        }
    }

    /// The curvature of the meridian.
    #[inline]
    pub fn bend(&self) -> f64 {
        match self.curve {
            Meridian::Cone { .. } => 0.0,
            Meridian::Torus { bend, .. } => bend,
        }
    }

    /// The signs of `e`: whether it is nowhere negative, and nowhere positive.
    pub fn sides(&self) -> [bool; 2] {
        let [a, b] = self.radii.map(|rho| self.normal(rho)[0]);
        [a >= 0.0, b <= 0.0]
    }

    pub fn height(&self, point: &SheetPoint) -> f64 {
        match self.curve {
            Meridian::Cone { from, rate, .. } => from[1] + rate * (point.rho - from[0]),
            Meridian::Torus { centre, tube, .. } => centre[1] + self.up * tube * point.square.sqrt(),
        }
    }
}

impl roots::CurvePoint for SheetPoint {
    fn unknown(&self) -> f64 {
        self.x
    }

    fn value(&self) -> f64 {
        self.q
    }
}

impl Curve for Parallel<'_> {
    type Point = SheetPoint;

    #[inline]
    fn at(&self, v: f64) -> SheetPoint {
        let rho = (v * v + self.p * self.p).sqrt();
        let [e, square] = self.sheet.normal(rho);
        let norm_sq = v * v + square * self.p * self.p;
        // At a tip, where there is no normal.
        let nu = if norm_sq > 0.0 { e * v / norm_sq.sqrt() } else { 0.0 };
        SheetPoint {
            x: v,
            v,
            rho,
            e,
            square,
            nu,
            q: v + self.side * self.r * nu,
            norm_sq,
        }
    }

    #[inline]
    fn slope(&self, at: &SheetPoint) -> f64 {
        self.growth(at)
    }

    /// Not negative places.
    fn bounds(&self, [a, b]: [&SheetPoint; 2]) -> Bounds {
        match self.growths([a, b]) {
            Some((slope, norm_sq)) => Bounds {
                slope,
                error: self.error([b.v, b.rho], norm_sq),
            },
            None => Bounds::UNKNOWN,
        }
    }

    fn error_at(&self, at: &SheetPoint) -> f64 {
        self.error([at.v, at.rho], at.norm_sq)
    }

    fn is_axis(&self, at: &SheetPoint) -> bool {
        at.v == 0.0
    }

    fn slack(&self) -> f64 {
        self.slack
    }
}

impl Parallel<'_> {
    /// `Q′`: `ν′ = (v² ρ w + e f² p²)/D^(3/2)` with the curvature `w` of the meridian.
    #[inline]
    pub fn growth(&self, at: &SheetPoint) -> f64 {
        let top = at.v * at.v * at.rho * self.sheet.bend() + at.e * at.square * self.p * self.p;
        1.0 + self.side * self.r * top / (at.norm_sq * at.norm_sq.sqrt())
    }

    /// By how much `Q` is off: where `|∂ν/∂p|` and the error of `e` count. Infinite where that is not known.
    fn error(&self, [v, rho]: [f64; 2], norm_sq: f64) -> f64 {
        let bend = self.sheet.bend();
        if !self.known(rho, norm_sq) {
            return f64::INFINITY;
        }
        self.slack * (8.0 + 4.0 * self.r * v * (self.p.abs() + 2.0 * rho * rho * bend) / (norm_sq * norm_sq.sqrt()))
    }

    /// Whether `D` is beyond its error.
    pub fn known(&self, rho: f64, norm_sq: f64) -> bool {
        norm_sq > CERTAIN * self.doubt(rho)
    }

    /// By how much `D` is off.
    fn doubt(&self, rho: f64) -> f64 {
        8.0 * self.slack * rho * (1.0 + rho * self.sheet.bend())
    }

    /// The range of `Q′` between two places in the order of `v`, and the least `D`. `None` if it is not known.
    pub fn growths(&self, [a, b]: [&SheetPoint; 2]) -> Option<([f64; 2], f64)> {
        let [least, most] = if a.e * b.e >= 0.0 {
            [a.square.min(b.square), a.square.max(b.square)]
        } else {
            [a.square.min(b.square), 1.0]
        };
        let across = self.p * self.p;
        let bend = self.sheet.bend();
        let norm_sq = [a.v * a.v + least * across, b.v * b.v + most * across];
        if !self.known(b.rho, norm_sq[0]) {
            return None;
        }
        let doubt = self.doubt(b.rho);
        // `e` grows along a torus.
        let low = a.e * if a.e < 0.0 { most } else { least };
        let high = b.e * if b.e > 0.0 { most } else { least };
        let top = [
            a.v * a.v * a.rho * bend + low * across - doubt,
            b.v * b.v * b.rho * bend + high * across + doubt,
        ];
        let cubes = [norm_sq[0] - doubt, norm_sq[1] + doubt].map(|norm_sq| norm_sq * norm_sq.sqrt());
        let below = top[0] / if top[0] < 0.0 { cubes[0] } else { cubes[1] };
        let above = top[1] / if top[1] > 0.0 { cubes[0] } else { cubes[1] };
        let ends = [below, above].map(|rate| self.side * self.r * rate);
        let margin = 1e-12 * (1.0 + ends[0].abs().max(ends[1].abs()));
        Some((
            [1.0 + ends[0].min(ends[1]) - margin, 1.0 + ends[0].max(ends[1]) + margin],
            norm_sq[0],
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use sweepsim_props::*;

    fn sheets() -> impl Strategy<Value = Sheet> {
        let torus = (-4.0..4.0_f64, 0.1..4.0_f64, any::<bool>()).prop_map(|(centre, tube, up)| Sheet {
            radii: [(centre - tube).max(0.0), centre + tube],
            curve: Meridian::Torus {
                centre: [centre, 0.0],
                tube,
                bend: tube.recip(),
            },
            up: if up { 1.0 } else { -1.0 },
            out: 1.0,
        });
        let cone = (-PI..PI, 0.0..2.0_f64, 2.0..4.0_f64).prop_map(|(angle, a, b)| Sheet {
            radii: [a, b],
            curve: Meridian::Cone {
                normal: [angle.cos(), angle.sin()],
                from: [a, 0.0],
                rate: -angle.cos() / angle.sin(),
            },
            up: 1.0_f64.copysign(angle.sin()),
            out: 1.0,
        });
        prop_oneof![torus, cone]
    }

    proptest! {
        /// `Q′` is the derivative, `ν` the normal, and both are within their bounds.
        #[test]
        fn bounds_hold(sheet in sheets(), share in 0.0..1.0_f64, r in 0.1..9.0_f64, positive in any::<bool>(), ends in [0.0..1.0_f64, 0.0..1.0]) {
            prop_assume!(sheet.radii[1] > sheet.radii[0] + 0.01);
            let p = sheet.radii[1] * share;
            let side = if positive { 1.0 } else { -1.0 };
            let parallel = Parallel { sheet: &sheet, p, r, side, slack: 1e-14 };
            let [low, high] = sheet.radii.map(|rho| (rho * rho - p * p).max(0.0).sqrt());
            let place = |share: f64| low + (high - low) * (0.001 + 0.998 * share);
            let [a, b] = [place(ends[0].min(ends[1])), place(ends[0].max(ends[1]))];
            let bounds = parallel.bounds([&parallel.at(a), &parallel.at(b)]);
            for n in 0..=40 {
                let at = parallel.at(a + (b - a) * f64::from(n) / 40.0);
                let slope = parallel.slope(&at);
                prop_assert!(slope >= bounds.slope[0] && slope <= bounds.slope[1], "{slope} {bounds:?}");
                let h = 1e-6 * at.v.min(0.1);
                let [before, after] = [at.v - h, at.v + h].map(|v| parallel.at(v));
                if at.square > 1e-3 && at.norm_sq > 1e-3 && at.v > 1e-2 {
                    let found = (after.q - before.q) / (2.0 * h);
                    prop_assert!((found - slope).abs() < 1e-4 * (1.0 + slope.abs() + r / at.norm_sq), "{found} {slope}");
                    let rise = (sheet.height(&after) - sheet.height(&before)) / (2.0 * h);
                    let flat = -sheet.up * rise / (1.0 + rise * rise).sqrt();
                    prop_assert!((flat - at.nu).abs() < 1e-4 / at.square / at.norm_sq, "{flat} {}", at.nu);
                }
            }
        }
    }
}
