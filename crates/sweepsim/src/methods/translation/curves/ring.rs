//! Circles: sharp edges, and the grazing curve of a ball.

use super::graph::{End, Graph, GraphPoint, Turned};
use super::{Heading, Local, along, dot};
use crate::cutter::outline::{Rim, fan_normal};
use std::f64::consts::PI;

/// A circle that is seen from the side, narrower than this part of its radius, is left to the general method.
const NARROW: f64 = 1e-6;
/// The same for circles that are nearly tangent to an end of their ball (by the squared sine of the angle at which they meet), or whose intersection
/// with it is known to no better angle than this.
const TANGENT: f64 = 1e-5;
const BLURRED: f64 = 1e-2;

/// What a circle bounds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Role {
    /// A ball about the circle's centre.
    Ball { jump: i8, out: f64 },
    /// An edge between two faces.
    Rim {
        /// `cos φ` for the cosine and sine of the ring's own angle.
        azimuth: [f64; 2],
        /// Of both faces: `n_ρ d_⊥` and `n_ζ d_a`, so that `g = a cos φ + b`.
        rates: [[f64; 2]; 2],
        normals: [[f64; 2]; 2],
        radius: f64,
        speed: f64,
        axis: Local,
    },
}

/// A part of the circle `centre + cos θ first + sin θ second`, where `p` is that of the centre plus `width cos θ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring {
    centre: Local,
    first: Local,
    pub(super) second: Local,
    pub(super) width: f64,
    /// The sign of `sin θ`.
    pub(super) half: f64,
    span: [f64; 2],
    margins: [f64; 2],
    angles: [f64; 2],
    /// How far off these may be.
    errors: [f64; 2],
    slack: f64,
    pub(super) role: Role,
}

/// The circle about `centre` with these two perpendicular radii, turned such that `p` is extreme at its first.
struct Circle {
    centre: Local,
    first: Local,
    second: Local,
    width: f64,
    /// Cosine and sine of the angle from the first given radius.
    turn: [f64; 2],
}

impl Circle {
    fn new(centre: Local, a: Local, b: Local) -> Self {
        let width = a[1].hypot(b[1]);
        let [c, s] = [a[1] / width, b[1] / width];
        let mut first = [0, 1, 2].map(|k| c * a[k] + s * b[k]);
        let mut second = [0, 1, 2].map(|k| c * b[k] - s * a[k]);
        (first[1], second[1]) = (width, 0.0);
        Self {
            centre,
            first,
            second,
            width,
            turn: [c, s],
        }
    }

    /// The parts between these cuts and where `p` or `q` is extreme. `keep` tells of each, by its middle, whether it is wanted.
    /// Cuts come with the rounding error of their angle.
    fn parts(
        &self,
        slack: f64,
        cuts: &[(f64, f64)],
        keep: impl Fn(f64) -> bool,
        role: impl Fn(f64) -> Role,
        out: &mut Vec<Ring>,
    ) {
        let extreme = self.second[0].atan2(self.first[0]);
        let mut angles: Vec<(f64, f64)> = [-PI, 0.0, PI].map(|angle| (angle, 0.0)).into();
        // Turned into (-π, π].
        let inner = [extreme, extreme + PI].map(|angle| (angle, 0.0));
        for (angle, error) in inner.into_iter().chain(cuts.iter().copied()) {
            angles.push((angle - 2.0 * PI * (angle / (2.0 * PI)).round(), error));
        }
        angles.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in angles.windows(2) {
            let [(a, a_error), (b, b_error)] = [pair[0], pair[1]];
            let middle = 0.5 * (a + b);
            if !(b > a) || !keep(middle) {
                continue;
            }
            let half = if middle > 0.0 { 1.0 } else { -1.0 };
            let end = |angle: f64, error: f64| {
                (
                    self.width * angle.cos(),
                    slack + self.width * (angle.sin().abs() + error) * error,
                )
            };
            let (mut low, mut high) = (end(a, a_error), end(b, b_error));
            let (mut own, mut errors) = ([a, b], [a_error, b_error]);
            if low.0 > high.0 {
                std::mem::swap(&mut low, &mut high);
                own.swap(0, 1);
                errors.swap(0, 1);
            }
            out.push(Ring {
                centre: self.centre,
                first: self.first,
                second: self.second,
                width: self.width,
                half,
                span: [self.centre[1] + low.0, self.centre[1] + high.0],
                margins: [2.0 * low.1, 2.0 * high.1],
                angles: own,
                errors,
                slack,
                role: role(half),
            });
        }
    }
}

/// The circle of an edge. `None` if it is seen from the side.
pub(crate) fn rim(heading: &Heading, rim: &Rim) -> Option<Vec<Ring>> {
    let [e, f, a] = &heading.axes;
    let scaled = |v: &Local| v.map(|c| c * rim.radius);
    let circle = Circle::new(a.map(|c| c * rim.height), scaled(e), scaled(f));
    if !(circle.width > NARROW * rim.radius) {
        return None;
    }
    let [c, s] = circle.turn;
    // φ = θ + ψ, where ψ is the turn.
    let role = |_| Role::Rim {
        azimuth: [c, -s],
        rates: rim.normals.map(|[n, m]| [n * heading.across, m * heading.along]),
        normals: rim.normals,
        radius: rim.radius,
        speed: heading.speed,
        axis: *a,
    };
    let forward = s.atan2(c);
    let mut rings = Vec::with_capacity(8);
    let cuts = [(-forward, 0.0), (PI - forward, 0.0)];
    circle.parts(heading.slack, &cuts, |_| true, role, &mut rings);
    Some(rings)
}

/// The grazing circle of a ball about the axis, on the side of the two ends of its arc. `None` if rounding blurs it.
pub(crate) fn ball(
    heading: &Heading,
    [height, radius]: [f64; 2],
    angles: [f64; 2],
    poles: [bool; 2],
    out: f64,
) -> Option<Vec<Ring>> {
    let axis = &heading.axes[2];
    let way = heading.local_way();
    // Perpendicular to the way: across it, and in the vertical plane of it.
    let side = [0.0, radius, 0.0];
    let below = [way[2], 0.0, -way[0]].map(|c| c * radius / heading.speed);
    let circle = Circle::new(axis.map(|c| c * height), side, below);
    // The height above the centre, as a cosine of the angle from its highest point.
    let heights = [dot(axis, &circle.first), dot(axis, &circle.second)];
    let most = heights[0].hypot(heights[1]);
    let top = heights[1].atan2(heights[0]);
    let mut cuts = Vec::with_capacity(4);
    let mut limits = [-f64::INFINITY, f64::INFINITY];
    for (k, (angle, pole)) in angles.into_iter().zip(poles).enumerate() {
        if pole {
            continue;
        }
        let limit = radius * angle.sin();
        limits[k] = limit;
        let cosine = limit / most;
        let square = (1.0 - cosine) * (1.0 + cosine);
        let error = heading.slack / (most * square.abs().sqrt());
        // NaN is refused, too.
        if !(square.abs() > TANGENT && error < BLURRED) {
            return None;
        }
        if square > 0.0 {
            let from_top = cosine.acos();
            cuts.extend([(top + from_top, error), (top - from_top, error)]);
        }
    }
    let keep = |angle: f64| {
        let own = heights[0] * angle.cos() + heights[1] * angle.sin();
        own > limits[0] && own < limits[1]
    };
    let role = |half: f64| {
        // Below the way the count grows, above it falls.
        let below = half * (circle.second[0] * way[2] - circle.second[2] * way[0]) > 0.0;
        Role::Ball {
            jump: if below { 1 } else { -1 },
            out: out / radius,
        }
    };
    let mut rings = Vec::with_capacity(8);
    circle.parts(heading.slack, &cuts, keep, role, &mut rings);
    Some(rings)
}

impl Ring {
    #[inline]
    fn turn(&self, p: f64) -> [f64; 2] {
        let c = ((p - self.centre[1]) / self.width).clamp(-1.0, 1.0);
        [c, self.half * ((1.0 - c) * (1.0 + c)).sqrt()]
    }

    /// `dq/dp`.
    #[inline]
    fn slope(&self, [c, s]: [f64; 2]) -> f64 {
        (self.first[0] - self.second[0] * c / s) / self.width
    }

    /// By how much the count changes at an edge, by `g` on both faces.
    fn change(&self, [a, b]: [f64; 2]) -> i8 {
        match (a < 0.0, b < 0.0) {
            (true, false) => -self.half as i8,
            (false, true) => self.half as i8,
            _ => 0,
        }
    }

    /// How far off the angle may be, where it follows from `p`: near the extremes of `p`, it grows with the square root.
    fn blur(&self, s: f64) -> f64 {
        let blur = self.slack / self.width;
        2.0 * (blur / s.abs()).min((2.0 * blur).sqrt()) + 16.0 * f64::EPSILON
    }

    /// The signs of `g` on both faces of an edge, and whether they are certain if the angle may be off by `error`.
    fn sides(&self, [c, s]: [f64; 2], error: f64) -> ([f64; 2], bool) {
        let Role::Rim {
            azimuth, rates, speed, ..
        } = &self.role
        else {
            return ([0.0; 2], true);
        };
        let cosine = azimuth[0] * c + azimuth[1] * s;
        let mut certain = true;
        let sides = rates.map(|[ahead, up]| {
            let g = ahead * cosine + up;
            // Where the normal is along the axis, g is a product of one rounding.
            certain &= ahead == 0.0 || g.abs() > error * (ahead.abs() + 16.0 * f64::EPSILON * speed);
            g
        });
        (sides, certain)
    }
}

impl Ring {
    /// The point at an angle, which may be off by `error`.
    #[inline]
    pub(super) fn point(&self, [c, s]: [f64; 2], error: f64) -> GraphPoint {
        let arm = along(&self.first.map(|x| c * x), s, &self.second);
        let slope = self.slope([c, s]);
        let (jump, normal, certain) = match &self.role {
            Role::Ball { jump, out } => (*jump, arm.map(|x| out * x), true),
            Role::Rim {
                normals, radius, axis, ..
            } => {
                let ([a, b], certain) = self.sides([c, s], error);
                let jump = self.change([a, b]);
                let [n, m] = fan_normal(normals, [a, b]);
                (jump, along(&arm.map(|x| x * n / radius), m, axis), certain)
            }
        };
        GraphPoint {
            q: self.centre[0] + arm[0],
            z: self.centre[2] + arm[2],
            slope,
            jump,
            normal,
            certain,
        }
    }
}

impl Graph for Ring {
    #[inline]
    fn at(&self, p: f64) -> GraphPoint {
        let turn = self.turn(p);
        self.point(turn, self.blur(turn[1]))
    }

    fn span(&self) -> [f64; 2] {
        self.span
    }

    fn margins(&self) -> [f64; 2] {
        self.margins
    }

    fn part(&self, share: f64) -> f64 {
        let [a, b] = self.angles;
        self.centre[1] + self.width * (a + share * (b - a)).cos()
    }

    fn reach(&self) -> [f64; 2] {
        let [a, b] = self.angles.map(|angle| {
            let (s, c) = angle.sin_cos();
            self.centre[0] + c * self.first[0] + s * self.second[0]
        });
        [a.min(b), a.max(b)]
    }

    /// `g` of each face is monotone along the part.
    fn jump(&self, between: [f64; 2]) -> Option<i8> {
        if let Role::Ball { jump, .. } = self.role {
            return Some(jump);
        }
        let [(a, a_sure), (b, b_sure)] = between.map(|p| {
            let turn = self.turn(p);
            self.sides(turn, self.blur(turn[1]))
        });
        let negative = |sides: [f64; 2]| sides.map(|g| g < 0.0);
        (a_sure && b_sure && negative(a) == negative(b)).then(|| self.change(a))
    }

    /// It changes with the angle in one direction.
    fn steepest(&self, between: [f64; 2]) -> Option<f64> {
        let [a, b] = between.map(|p| self.slope(self.turn(p)).abs());
        Some(a.max(b))
    }

    fn many_q(&self, p: &[f64], q: &mut [f64], own: &mut [f64]) {
        // By value: nothing that is written here can change it.
        let ring = *self;
        for ((p, q), own) in p.iter().zip(q).zip(own) {
            let [c, s] = ring.turn(*p);
            *q = ring.centre[0] + (c * ring.first[0] + s * ring.second[0]);
            *own = s;
        }
    }

    fn many(&self, p: &[f64], own: &[f64], z: &mut [f64], [q, left, up]: [&mut [f64]; 3]) {
        let ring = *self;
        let points = z.iter_mut().zip(q).zip(left).zip(up);
        let values = p.iter().zip(own).zip(points);
        let arm = |p: f64, s: f64| {
            let c = ((p - ring.centre[1]) / ring.width).clamp(-1.0, 1.0);
            ([c, s], along(&ring.first.map(|x| c * x), s, &ring.second))
        };
        match ring.role {
            Role::Ball { out, .. } => {
                for ((p, s), (((z, q), left), up)) in values {
                    let (_, arm) = arm(*p, *s);
                    *z = ring.centre[2] + arm[2];
                    [*q, *left, *up] = arm.map(|x| out * x);
                }
            }
            Role::Rim {
                azimuth,
                rates,
                normals,
                radius,
                axis,
                ..
            } => {
                for ((p, s), (((z, q), left), up)) in values {
                    let ([c, s], arm) = arm(*p, *s);
                    let cosine = azimuth[0] * c + azimuth[1] * s;
                    let [a, b] = rates.map(|[ahead, up]| ahead * cosine + up);
                    let [n, m] = fan_normal(&normals, [a, b]);
                    *z = ring.centre[2] + arm[2];
                    [*q, *left, *up] = along(&arm.map(|x| x * n / radius), m, &axis);
                }
            }
        }
    }
}

impl Turned for Ring {
    fn ends(&self) -> [End; 2] {
        [0, 1].map(|k| {
            let (s, c) = self.angles[k].sin_cos();
            let length = self.first[0].abs() + self.second[0].abs() + self.width;
            End {
                q: self.centre[0] + c * self.first[0] + s * self.second[0],
                blur: Some(length * self.errors[k]),
            }
        })
    }
}
