//! The grazing curve of a torus (an arc of the meridian about a point off the axis), for a tool that leans.
//!
//! Let `A` be the tool's axis, `E` the direction of travel across it and `F` the one to the left of both, `d = a E + κ A` the direction of the move. The normal `n` of
//! the tube, from its circle of centres, runs along the great circle perpendicular to `d`:
//!
//! ```text
//! n = g cos δ (a A − κ E) ± sin δ F,      h = −g κ cos δ E ± sin δ F,      |h|² = κ² cos² δ + sin² δ,
//! X = ζ_c A + r n + σ ρ_c h/|h|
//! ```
//!
//! with the part `h` of `n` across the axis, `σ` the sign of `ρ − ρ_c` and `g` that of `ζ − ζ_c`; so `0 ≤ δ ≤ π/2` is a quarter of the circle, at `|e| = |h|`
//! with the normal `(e, f)` of the meridian. Differentiated, and with `n × n′ = ± d`,
//!
//! ```text
//! X′ = (r + σ ρ_c κ²/|h|³) n′ + d σ ρ_c κ g a sin δ/|h|³
//! ```
//!
//! so `p`, across `d`, is extreme where `n` is horizontal and perpendicular to `d`, and where the first factor is 0: cusps, at the |h| of a cube root. Its sign
//! times `σ` is that of the surface's curvature along `d`, which decides whether the coverage count rises or falls.
//!
//! Where a move is nearly perpendicular to the axis, `h` turns fast while `δ` is as small as `κ`: there its azimuth `ψ`, `tan δ = |κ| tan ψ`, takes the place of `δ`.

use super::Local;
use super::graph::{Graph, GraphCrossing, GraphPoint};
use super::newton::newton;

/// A step of Newton's method after which `p` is accurate to rounding: its second derivative is below the inverse of the square root of this.
const LAST: f64 = 1e-10;
/// Where `q` changes faster than this, relative to `p`, each value is looked at by itself.
const STEEPEST: f64 = 1e9;

/// A quarter of the great circle, or a part of it over which `p` is monotone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oblique {
    /// `g (a A − κ E)` and `± F`: `n = cos δ first + sin δ second`.
    pub(super) first: Local,
    pub(super) second: Local,
    /// `h/|h| = cos ψ ahead + sin ψ second`.
    pub(super) ahead: Local,
    /// `ζ_c A`.
    pub(super) centre: Local,
    /// The direction of the move.
    pub(super) way: Local,
    /// `|κ|`.
    pub(super) slope: f64,
    /// `κ g a`.
    pub(super) drift: f64,
    pub(super) radius: f64,
    /// `σ ρ_c`.
    pub(super) offset: f64,
    /// Whether the parameter is `tan ψ/2` instead of `tan δ/2`.
    pub(super) turning: bool,
    /// The parameter at the smaller and the larger `p`.
    pub(super) ends: [f64; 2],
    /// Whether `p` is extreme there.
    pub(super) extreme: [bool; 2],
    pub(super) span: [f64; 2],
    pub(super) margins: [f64; 2],
    pub(super) jump: i8,
    pub(super) out: f64,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    /// Cosine and sine of `δ` and of `ψ`.
    delta: [f64; 2],
    psi: [f64; 2],
    /// `|h|`.
    across: f64,
}

impl Oblique {
    /// The parameter at `δ`.
    pub(super) fn parameter(&self, delta: f64) -> f64 {
        let angle = if self.turning {
            let (s, c) = delta.sin_cos();
            s.atan2(self.slope * c)
        } else {
            delta
        };
        (0.5 * angle).tan()
    }

    #[inline]
    pub(super) fn site(&self, s: f64) -> Site {
        let inverse = 1.0 / (1.0 + s * s);
        let own = [(1.0 - s) * (1.0 + s) * inverse, 2.0 * s * inverse];
        let kappa = self.slope;
        if self.turning {
            let [c, s] = own;
            let length = (c * c + kappa * kappa * s * s).sqrt();
            Site {
                delta: [c / length, kappa * s / length],
                psi: own,
                across: kappa / length,
            }
        } else {
            let [c, s] = own;
            let across = (kappa * kappa * c * c + s * s).sqrt();
            let psi = if across > 0.0 {
                [kappa * c / across, s / across]
            } else {
                [0.0, 1.0]
            };
            Site {
                delta: own,
                psi,
                across,
            }
        }
    }

    #[inline]
    pub(super) fn normal(&self, site: &Site) -> Local {
        let [c, s] = site.delta;
        [0, 1, 2].map(|k| c * self.first[k] + s * self.second[k])
    }

    #[inline]
    pub(super) fn place(&self, site: &Site) -> Local {
        let ([c, s], [cp, sp]) = (site.delta, site.psi);
        [0, 1, 2].map(|k| {
            let tube = self.radius * (c * self.first[k] + s * self.second[k]);
            self.centre[k] + tube + self.offset * (cp * self.ahead[k] + sp * self.second[k])
        })
    }

    /// `n′`, in `(q, p)`.
    #[inline]
    fn turn(&self, site: &Site) -> [f64; 2] {
        let [c, s] = site.delta;
        [0, 1].map(|k| c * self.second[k] - s * self.first[k])
    }

    /// `r |h|³ + σ ρ_c κ²`.
    #[inline]
    pub(super) fn cubic(&self, site: &Site) -> f64 {
        let h = site.across;
        self.radius * h * h * h + self.offset * self.slope * self.slope
    }

    /// `dp/dδ`.
    pub(super) fn rate(&self, site: &Site) -> f64 {
        let h = site.across.max(f64::MIN_POSITIVE.cbrt());
        self.turn(site)[1] * self.cubic(site) / (h * h * h)
    }

    /// `p` at a parameter, and its derivative.
    #[inline]
    fn across(&self, s: f64) -> [f64; 2] {
        let site = self.site(s);
        let ([c, sine], [cp, sp]) = (site.delta, site.psi);
        let [first, second] = [self.first[1], self.second[1]];
        let place = self.centre[1]
            + self.radius * (c * first + sine * second)
            + self.offset * (cp * self.ahead[1] + sp * second);
        let turn = (c * second - sine * first) * 2.0 / (1.0 + s * s);
        let kappa = self.slope;
        let rate = if self.turning {
            // dδ/dψ = κ/D with D = cos² ψ + κ² sin² ψ = κ²/|h|².
            let root = kappa / site.across;
            self.radius * kappa / (root * root) + self.offset * root
        } else if kappa > 0.0 {
            let inverse = 1.0 / site.across;
            self.radius + self.offset * kappa * kappa * (inverse * inverse * inverse)
        } else {
            self.radius
        };
        [place, turn * rate]
    }

    /// `dq/dp`.
    #[inline]
    fn slant(&self, site: &Site) -> f64 {
        let [q, p] = self.turn(site);
        let cubic = self.cubic(site);
        let drift = self.way[0] * self.offset * self.drift * site.delta[1];
        if self.drift == 0.0 {
            q / p
        } else {
            (q * cubic + drift) / (p * cubic)
        }
    }

    /// The parameter where `p` has this value, from a guess. `None` if Newton's method does not converge.
    fn invert(&self, p: f64, guess: f64) -> Option<f64> {
        let [low, high] = self.ends;
        let rising = high > low;
        let (first, last) = (low.min(high), low.max(high));
        let at = |s: f64| {
            let [place, rate] = self.across(s);
            let value = place - p;
            (value, value / rate, ())
        };
        let done = |s: f64, step: f64, (), [a, b]: [f64; 2]| {
            let next = s - step;
            if (next - s).abs() <= LAST {
                return Some(next.max(first).min(last));
            }
            (b - a <= 2.0 * f64::EPSILON).then_some(s)
        };
        newton([first, last], (rising, guess), |a, b| 0.5 * (a + b), at, done)
    }

    /// A guess: `p` is about linear in the parameter, or quadratic next to an end at which it is extreme.
    fn guess(&self, p: f64) -> f64 {
        let [low, high] = self.span;
        let share = ((p - low) / (high - low)).clamp(0.0, 1.0);
        let share = match self.extreme {
            [true, false] => share.sqrt(),
            [false, true] => 1.0 - (1.0 - share).sqrt(),
            _ => share,
        };
        self.ends[0] + share * (self.ends[1] - self.ends[0])
    }

    /// The point at `p`.
    fn found(&self, p: f64) -> Option<Site> {
        Some(self.site(self.invert(p, self.guess(p))?))
    }
}

/// The range of `x cos + y sin` between two angles of the first quarter.
fn range(x: f64, y: f64, ends: [[f64; 2]; 2]) -> [f64; 2] {
    let values = ends.map(|[c, s]| c * x + s * y);
    let rates = ends.map(|[c, s]| c * y - s * x);
    let mut range = [values[0].min(values[1]), values[0].max(values[1])];
    if rates[0] * rates[1] <= 0.0 {
        let size = x.hypot(y);
        if values[0] + values[1] > 0.0 {
            range[1] = size;
        } else {
            range[0] = -size;
        }
    }
    range
}

impl Graph for Oblique {
    fn at(&self, p: f64) -> GraphPoint {
        let found = self.found(p);
        let certain = found.is_some();
        let site = found.unwrap_or_else(|| self.site(self.ends[0]));
        let [q, _, z] = self.place(&site);
        GraphPoint {
            q,
            z,
            slope: self.slant(&site),
            jump: self.jump,
            normal: self.normal(&site).map(|c| self.out * c),
            certain,
        }
    }

    fn span(&self) -> [f64; 2] {
        self.span
    }

    fn margins(&self) -> [f64; 2] {
        self.margins
    }

    fn part(&self, share: f64) -> f64 {
        let [low, high] = self.ends;
        let p = self.place(&self.site(low + share * (high - low)))[1];
        p.clamp(self.span[0], self.span[1])
    }

    fn reach(&self) -> [f64; 2] {
        self.over(self.ends.map(|s| self.site(s)))
    }

    /// Of `q` as a sum of two circles' each.
    fn between(&self, between: [f64; 2]) -> [f64; 2] {
        let [a, b] = between.map(|p| self.found(p));
        match (a, b) {
            (Some(a), Some(b)) => self.over([a, b]),
            _ => self.reach(),
        }
    }

    fn jump(&self, _: [f64; 2]) -> Option<i8> {
        Some(self.jump)
    }

    /// The sum of the extremes of both terms, each with the extremes of its factors.
    fn steepest(&self, between: [f64; 2]) -> Option<f64> {
        let [a, b] = between.map(|p| self.found(p));
        let sites = [a?, b?];
        let turns = sites.map(|site| self.turn(&site));
        // The quotient is that of a sine and a cosine of one angle, the second term's factors are monotone.
        let across = turns.map(|[q, p]| (q / p).abs());
        let cubics = sites.map(|site| self.cubic(&site));
        let sine = sites[0].delta[1].max(sites[1].delta[1]);
        let least = cubics[0].abs().min(cubics[1].abs()) * turns[0][1].abs().min(turns[1][1].abs());
        let drift = (self.way[0] * self.offset * self.drift).abs() * sine;
        let second = if drift > 0.0 { drift / least } else { 0.0 };
        let bound = across[0].max(across[1]) + second;
        // NaN is no bound.
        (turns[0][1] * turns[1][1] > 0.0 && (drift == 0.0 || cubics[0] * cubics[1] > 0.0) && bound < STEEPEST)
            .then_some(1.1 * bound)
    }

    fn many_q(&self, p: &[f64], q: &mut [f64], own: &mut [f64]) {
        // Lines of a row are evenly spaced, so the next parameter is guessed from the last two; the first from the row before, if it is of this curve.
        let [low, high] = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        let mut last: Option<(f64, f64)> = None;
        for ((p, q), own) in p.iter().zip(q).zip(own) {
            if !(*p >= self.span[0] && *p <= self.span[1]) {
                // As at the end, for the comparison with the way.
                let end = self.ends[usize::from(*p > self.span[1])];
                (*q, *own) = (self.place(&self.site(end))[0], end);
                last = None;
                continue;
            }
            let guess = match last {
                Some((s, step)) => s + step,
                None if *own > low && *own < high => *own,
                None => self.guess(*p),
            };
            match self.invert(*p, guess) {
                Some(s) => {
                    last = Some((s, last.map_or(0.0, |(before, _)| s - before)));
                    (*q, *own) = (self.place(&self.site(s))[0], s);
                }
                None => {
                    last = None;
                    (*q, *own) = (f64::NAN, f64::NAN);
                }
            }
        }
    }

    fn many(&self, _: &[f64], own: &[f64], points: &mut [GraphCrossing]) {
        for (s, point) in own.iter().zip(points) {
            let site = self.site(*s);
            *point = GraphCrossing {
                z: self.place(&site)[2],
                normal: self.normal(&site).map(|c| self.out * c),
            };
        }
    }
}

impl Oblique {
    /// A range of `q` between two points.
    fn over(&self, sites: [Site; 2]) -> [f64; 2] {
        let tube = range(
            self.radius * self.first[0],
            self.radius * self.second[0],
            sites.map(|site| site.delta),
        );
        let circle = range(
            self.offset * self.ahead[0],
            self.offset * self.second[0],
            sites.map(|site| site.psi),
        );
        [0, 1].map(|k| self.centre[0] + tube[k] + circle[k])
    }
}
