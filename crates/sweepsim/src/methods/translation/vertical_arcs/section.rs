//! Cones and tori along an arc, of a tool whose axis is upright or lies in the arc's plane: the curves parallel to
//! their sections by the planes of lines, at the distance of the arc's radius.
//!
//! In such a plane at the distance `p` from the axis, the section is `(v, ζ)` with `v² = ρ² − p²`. With the unit normal
//! `(e, f)` of the meridian and `D = v² + f² p²`, that of the section is `(e v, f ρ)/√D`. The unknown is what is
//! horizontal: `v`, ahead of the axis of an upright tool or, mirrored, behind it; or the height along the axis of one
//! that lies, whose section has two halves, mirror images of each other.

use super::roots::{Bounds, Curve, CurvePoint, Root, Search};
use super::{ROUNDING, Rolling};
use crate::methods::sheets::Undecided;
use crate::methods::sheets::intervals::{Range, hull, scaled};
use crate::methods::translation::quarter::{MeridianPoint, Quarter};
use sweepsim_dexel::Source;

/// A vanishing distance is beyond doubt from so many times its error on.
const CERTAIN: f64 = 64.0;
/// Directions of the arc that are this close to level may be on the other side.
const LEVEL: f64 = 1e-6;

/// A curve parallel to a section, by its horizontal coordinate: `Q(x) = x + side r ν(x)` with the part `ν` of the
/// normal along `x`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section<'a> {
    quarter: &'a Quarter,
    /// The distance of the plane from the axis.
    p: f64,
    r: f64,
    side: f64,
    /// The rounding error of coordinates.
    slack: f64,
    /// Whether the axis lies: the unknown is the height then, with its sign, otherwise `v`.
    lying: bool,
}

/// A point of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SectionPoint {
    /// The unknown.
    x: f64,
    v: f64,
    at: MeridianPoint,
    nu: f64,
    /// `Q`.
    q: f64,
    /// `D`.
    norm_sq: f64,
}

impl CurvePoint for SectionPoint {
    fn unknown(&self) -> f64 {
        self.x
    }

    fn value(&self) -> f64 {
        self.q
    }
}

impl Section<'_> {
    /// The ranges of the ends of the section; `None` where there is none.
    fn ends(&self) -> Option<[Range; 2]> {
        let Self { quarter, p, slack, .. } = *self;
        if self.lying {
            return Some([quarter.from(p, slack)?, [quarter.ends[1]; 2]]);
        }
        let doubt = 8.0 * slack * (quarter.radii[1] + slack);
        let end = |rho: f64| {
            let square = (rho - p) * (rho + p);
            [square - doubt, square + doubt].map(|square| square.max(0.0).sqrt())
        };
        let [inner, outer] = quarter.radii;
        let from = if inner == 0.0 { [0.0; 2] } else { end(inner) };
        ((outer - p) * (outer + p) >= -doubt).then(|| [from, end(outer)])
    }

    /// The sign of `ν`.
    fn sign(&self) -> f64 {
        let [e, _] = self.quarter.signs;
        if self.lying { -e } else { e }
    }

    /// By how much `Q` is off: where the derivatives of `ν` and the error of `e` count. Infinite where that is not
    /// known.
    fn error(&self, [v, rho]: [f64; 2], square: f64, norm_sq: f64) -> f64 {
        let (p, bend) = (self.p.abs(), self.quarter.bend);
        if !self.known(rho, norm_sq) {
            return f64::INFINITY;
        }
        let top = if self.lying {
            rho * v * v * bend + square * p * p + 2.0 * square.sqrt() * p * rho
        } else {
            v * (p + 2.0 * rho * rho * bend)
        };
        self.slack * (8.0 + 4.0 * self.r * top / (norm_sq * norm_sq.sqrt()))
    }

    /// Whether `D` is beyond its error.
    fn known(&self, rho: f64, norm_sq: f64) -> bool {
        norm_sq > CERTAIN * self.doubt(rho)
    }

    /// By how much `D` is off.
    fn doubt(&self, rho: f64) -> f64 {
        8.0 * self.slack * rho * (1.0 + rho * self.quarter.bend)
    }
}

impl Curve for Section<'_> {
    type Point = SectionPoint;

    #[inline]
    fn at(&self, x: f64) -> SectionPoint {
        let (quarter, p) = (self.quarter, self.p);
        let (at, v) = if self.lying {
            let at = quarter.at_height(x);
            (at, ((at.rho - p) * (at.rho + p)).max(0.0).sqrt())
        } else {
            (quarter.at_radius((x * x + p * p).sqrt()), x)
        };
        let norm_sq = v * v + at.square * p * p;
        // At a tip, where there is no normal.
        let nu = if !(norm_sq > 0.0) {
            0.0
        } else if self.lying {
            self.sign() * at.rho * (at.square / norm_sq).sqrt()
        } else {
            at.e * v / norm_sq.sqrt()
        };
        SectionPoint {
            x,
            v,
            at,
            nu,
            q: x + self.side * self.r * nu,
            norm_sq,
        }
    }

    /// `ν′ = (v² ρ w + e f² p²)/D^(3/2)` is the curvature of the section, with that of the meridian, `w`.
    #[inline]
    fn slope(&self, point: &SectionPoint) -> f64 {
        let MeridianPoint { rho, e, square } = point.at;
        let top = point.v * point.v * rho * self.quarter.bend + e * square * self.p * self.p;
        1.0 + self.side * self.r * top / (point.norm_sq * point.norm_sq.sqrt())
    }

    fn bounds(&self, [a, b]: [&SectionPoint; 2]) -> Bounds {
        let [least, most] = hull(a.at.square, b.at.square);
        let across = self.p * self.p;
        let bend = self.quarter.bend;
        let norm_sq = [a.v * a.v + least * across, b.v * b.v + most * across];
        if !self.known(b.at.rho, norm_sq[0]) {
            return Bounds::UNKNOWN;
        }
        let doubt = self.doubt(b.at.rho);
        // `e` grows along a torus.
        let low = a.at.e * if a.at.e < 0.0 { most } else { least };
        let high = b.at.e * if b.at.e > 0.0 { most } else { least };
        let top = [
            a.v * a.v * a.at.rho * bend + low * across - doubt,
            b.v * b.v * b.at.rho * bend + high * across + doubt,
        ];
        let cubes = [norm_sq[0] - doubt, norm_sq[1] + doubt].map(|norm_sq| norm_sq * norm_sq.sqrt());
        let below = top[0] / if top[0] < 0.0 { cubes[0] } else { cubes[1] };
        let above = top[1] / if top[1] > 0.0 { cubes[0] } else { cubes[1] };
        let [low, high] = scaled(self.side * self.r, [below, above]);
        let margin = 1e-12 * (1.0 + low.abs().max(high.abs()));
        Bounds {
            slope: [1.0 + low - margin, 1.0 + high + margin],
            error: self.error([b.v, b.at.rho], most, norm_sq[0]),
        }
    }

    fn error_at(&self, point: &SectionPoint) -> f64 {
        self.error([point.v, point.at.rho], point.at.square, point.norm_sq)
    }

    fn is_axis(&self, point: &SectionPoint) -> bool {
        !self.lying && point.v == 0.0
    }

    fn slack(&self) -> f64 {
        self.slack
    }
}

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// The lines that a cone or a torus passes.
    pub(super) fn quarter(&mut self, quarter: &Quarter, lying: bool) {
        let (arc, outer) = (self.arc, quarter.radii[1]);
        let [low, high] = self.directions[0].map(|cosine| arc.radius * cosine);
        let [from, to] = if lying {
            scaled(quarter.climb * self.axis[0], quarter.ends)
        } else {
            [-outer, outer]
        };
        let [_, sines] = self.directions;
        // `(cos α, sin α)` is the normal of the section, or its opposite.
        let faces = |side: f64| match side * quarter.signs[1] {
            _ if lying => true,
            up if up > 0.0 => sines[1] > -LEVEL,
            _ => sines[0] < LEVEL,
        };
        let ranges = [[-outer, outer], [from + low, to + high]];
        let slack = self.slack.max(quarter.rounding());
        self.each(arc.centre, ranges, |own, line, [q, p]| {
            for side in [1.0, -1.0].into_iter().filter(|side| faces(*side)) {
                let section = Section {
                    quarter,
                    p,
                    r: arc.radius,
                    side,
                    slack,
                    lying,
                };
                own.over(section, q, line)?;
            }
            Ok(())
        });
    }

    #[inline]
    fn over(&mut self, section: Section, q: f64, line: usize) -> Result<(), Undecided> {
        let Section {
            quarter,
            r,
            side,
            slack,
            lying,
            ..
        } = section;
        let Some([from, to]) = section.ends() else {
            return Ok(());
        };
        let normals = if side * section.sign() > 0.0 {
            [0.0, 1.0]
        } else {
            [-1.0, 0.0]
        };
        let margin = 8.0 * slack + ROUNDING * r;
        let mirrors = [quarter.climb * self.axis[0], 1.0, -1.0];
        for &mirror in if lying { &mirrors[..1] } else { &mirrors[1..] } {
            // Of `side ν`, which is `mirror cos α`.
            let cosines = scaled(mirror, self.directions[0]);
            let [low, high] = [cosines[0].max(normals[0]), cosines[1].min(normals[1])];
            let y = mirror * q;
            let clip = [y - r * high - margin, y - r * low + margin];
            if !(low <= high + ROUNDING) || clip[1] < from[0] || clip[0] > to[1] {
                continue;
            }
            let curve = section;
            let search = Search { curve, y, mirror };
            search.roots([from, to], clip, |root| self.met(&search, root, line))?;
        }
        Ok(())
    }

    /// Where a line is met, on both halves of the section of a tool that lies.
    fn met(&mut self, search: &Search<Section>, root: Root<SectionPoint>, line: usize) -> Result<(), Undecided> {
        let Search { curve, y, mirror } = search;
        let Section {
            quarter, p, r, side, ..
        } = *curve;
        let Root { at, error, grows } = root;
        let SectionPoint { v, at: place, .. } = at;
        let cosine = mirror * side * at.nu;
        let off = (at.q - y).abs() + 2.0 * curve.slack + error;
        let Some((sine, error)) = self.other(0, cosine, off / r)? else {
            return Ok(());
        };
        let [out, up] = quarter.signs;
        let radial = quarter.out * place.e / place.rho;
        let axial = quarter.out * up * place.square.sqrt();
        let halves: &[f64] = if curve.lying { &[out, -out] } else { &[up] };
        for half in halves {
            let sine = half * side * sine;
            let Some(share) = self.share([cosine, sine], error)? else {
                continue;
            };
            let (height, normal) = if curve.lying {
                let v = half * out * v;
                (v, [self.axis[0] * axial, radial * p, radial * v])
            } else {
                (quarter.height(&place), [radial * mirror * v, radial * p, axial])
            };
            let jump = if (sine > 0.0) == grows { -1 } else { 1 };
            let z = self.arc.centre[2] + r * sine + height;
            self.crossing(line, z, jump, normal, share);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cutter::outline::{Piece, Shape};
    use std::f64::consts::PI;
    use sweepsim_props::*;

    fn pieces() -> impl Strategy<Value = Piece> {
        let shape = (-1.0..4.0_f64, 0.1..4.0_f64, -PI..PI, 0.1..6.0_f64).prop_map(|(centre, tube, from, angle)| {
            let at = |angle: f64| [centre + tube * angle.cos(), 0.5 + tube * angle.sin()];
            Piece {
                from: at(from),
                to: at(from + angle),
                shape: Shape::Arc {
                    centre: [centre, 0.5],
                    radius: tube,
                    angles: [from, from + angle],
                    out: 1.0,
                },
                patches: 0..0,
            }
        });
        let cone = (-PI..PI, 0.0..2.0_f64, 0.1..4.0_f64).prop_map(|(angle, a, length)| Piece {
            from: [a, 0.0],
            to: [a - length * angle.sin(), length * angle.cos()],
            shape: Shape::Line {
                normal: [angle.cos(), angle.sin()],
            },
            patches: 0..0,
        });
        // On one side of the axis.
        prop_oneof![shape, cone].prop_filter("a meridian", |piece| match piece.shape {
            Shape::Line { .. } => piece.to[0] > 0.0,
            Shape::Arc {
                centre,
                radius,
                angles: [from, to],
                ..
            } => (0..=1000).all(|n| centre[0] + radius * (from + (to - from) * f64::from(n) / 1000.0).cos() > 1e-3),
        })
    }

    proptest! {
        /// `Q′` is the derivative, `ν` the normal, and both are within their bounds; the section starts where it is
        /// said to.
        #[test]
        fn bounds_hold(piece in pieces(), share in 0.01..1.0_f64, r in 0.1..9.0_f64, positive in any::<bool>(), places in [0.0..1.0_f64, 0.0..1.0], lying in any::<bool>()) {
            for quarter in &Quarter::all(&piece, 1e-14, !lying).unwrap_or_default() {
                let Quarter { ends, climb, .. } = *quarter;
                let p = quarter.radii[1] * share;
                let side = if positive { 1.0 } else { -1.0 };
                let curve = Section { quarter, p, r, side, slack: 1e-14, lying };
                let Some([[_, from], [to, _]]) = curve.ends() else { continue };
                let start = curve.at(from);
                if lying {
                    prop_assert!(from >= ends[0] && from <= ends[1]);
                    prop_assert!(start.at.rho > p - 1e-9 && (from - ends[0] < 1e-11 || start.at.rho < p + 1e-5), "{start:?} {p}");
                }
                prop_assume!(to - from > 1e-3);
                let place = |share: f64| from + (to - from) * (0.001 + 0.998 * share);
                let [a, b] = hull(places[0], places[1]).map(place);
                let bounds = curve.bounds([&curve.at(a), &curve.at(b)]);
                for n in 0..=40 {
                    let at = curve.at(a + (b - a) * f64::from(n) / 40.0);
                    let slope = curve.slope(&at);
                    prop_assert!(slope >= bounds.slope[0] && slope <= bounds.slope[1], "{slope} {bounds:?}");
                    let h = 1e-6 * (at.x - from).min(to - at.x).min(0.1);
                    let [before, after] = [at.x - h, at.x + h].map(|x| curve.at(x));
                    let height = |point: &SectionPoint| climb * quarter.height(&point.at);
                    let MeridianPoint { e, square, .. } = at.at;
                    prop_assert!(!lying || (height(&at) - at.x).abs() < 1e-9 + 1e-7 / square, "{at:?}");
                    // The unknown moves along a section that is nowhere too steep there.
                    let steep = if lying { e.abs() } else { square };
                    if at.norm_sq > 1e-2 && at.v > 1e-2 && steep > 1e-2 && h > 1e-9 {
                        let found = (after.q - before.q) / (2.0 * h);
                        prop_assert!((found - slope).abs() < 1e-4 * (1.0 + slope.abs() + r / at.norm_sq) / steep, "{found} {slope}");
                        // The section is the graph of `v`, or of the height.
                        let of = |point: &SectionPoint| if lying { point.v } else { height(point) };
                        let rise = (of(&after) - of(&before)) / (2.0 * h);
                        let along = curve.sign() * rise.abs() / (1.0 + rise * rise).sqrt();
                        prop_assert!((along - at.nu).abs() < 1e-3 / at.norm_sq / steep, "{along} {}", at.nu);
                    }
                }
            }
        }
    }
}
