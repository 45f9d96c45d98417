//! A ball or a torus along an arc about its axis: tubes about circles about the arc's axis.

use super::roots::{Arch, Open};
use super::{AXIS, Along, EnvelopePoint, Orbit, Sector, View, between, length, products};
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::{Piece, Rim, Shape};
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim_dexel::Source;

/// At an end of a meridian where its normal is parallel to the axis, but for this angle, it is.
const FLAT: f64 = 1e-9;

/// What of a tube belongs to the tool.
#[derive(Clone, Copy)]
enum TubePart {
    /// Of a ball, heights from its centre.
    Heights([f64; 2]),
    /// Angles about the circle of centres: the middle, and how far they reach; and whether the tube's normal is parallel to the axis somewhere.
    Angles([f64; 2], bool),
}

/// The tube on one side of the tool, and of the arc's axis.
struct Tube {
    /// `R′`.
    centres: f64,
    radius: f64,
    height: f64,
    /// 1 where the normal points away from the centre, −1 where it points to it.
    out: f64,
    side: f64,
    beyond: bool,
    part: TubePart,
}

impl<S: Fn(f64) -> Source> Orbit<'_, '_, S> {
    pub(super) fn tube(&mut self, piece: &Piece) -> Option<()> {
        let Shape::Arc {
            centre: [centre, height],
            radius,
            angles,
            out,
        } = piece.shape
        else {
            return None;
        };
        if !self.is_straight(radius, self.slope) {
            return None;
        }
        let ball = centre == 0.0;
        // Next to where the normal is parallel to the axis, the tube touches its envelope along half a circle.
        let blunt = 4.0 * self.slope.abs().sqrt();
        let (mut levels, mut flat) = (Vec::new(), false);
        for quarter in -8..=8_i32 {
            let level = FRAC_PI_2 + f64::from(quarter) * PI;
            if ball || level < angles[0] - 2.0 * blunt || level > angles[1] + 2.0 * blunt {
                continue;
            }
            let apart = angles.map(|end| (end - level).abs());
            let at = apart.map(|apart| apart <= FLAT);
            if !(at[0] || at[1]) && apart[0].min(apart[1]) <= 2.0 * blunt {
                return None;
            }
            flat = true;
            levels.push((level, at));
        }
        let whole = levels.iter().any(|(_, ends)| *ends != [true; 2]);
        if flat && !(radius * self.slope.abs() <= self.height_tolerance)
            || whole && !self.tells_angles(centre, Some(radius))
        {
            return None;
        }
        let part = match piece.ball() {
            Some(ball) => TubePart::Heights(ball.ends),
            // A hollow ball.
            None if ball => return None,
            None => TubePart::Angles([0.5 * (angles[0] + angles[1]), 0.5 * (angles[1] - angles[0])], flat),
        };
        let range = super::cosines(angles).map(|cosine| centre + radius * cosine);
        let radii = if ball { [0.0, range[1].max(0.0)] } else { range };
        for side in [1.0, -1.0] {
            if ball && side < 0.0 {
                continue;
            }
            let signed = [self.arc.radius + side * radii[0], self.arc.radius + side * radii[1]];
            let [mut low, high] = [signed[0].min(signed[1]), signed[0].max(signed[1])];
            if ball {
                low = self.arc.radius - radii[1];
            }
            for beyond in [false, true] {
                let sign = if beyond { -1.0 } else { 1.0 };
                let range = if beyond {
                    [low, high.min(0.0)]
                } else {
                    [low.max(0.0), high]
                };
                if !(range[0] <= range[1]) {
                    continue;
                }
                let tube = Tube {
                    centres: sign * (self.arc.radius + side * centre),
                    radius,
                    height,
                    out,
                    side,
                    beyond,
                    part,
                };
                for (sector, [x, y]) in self.parts() {
                    let area = [products(range, x), products(range, y), piece.heights()];
                    self.each(area, |own, view| {
                        if own.on_tube(view, sector, &tube).is_err() {
                            own.open(view);
                        }
                    });
                }
            }
        }
        for (level, at) in levels {
            self.levels(level, at, (centre, height, radius, out));
        }
        Some(())
    }

    /// The circle on which the normal of a torus is parallel to the axis, as an edge between the surface beside it and a disc: on both sides, but for one on which the torus ends.
    fn levels(&mut self, level: f64, at: [bool; 2], (centre, height, radius, out): (f64, f64, f64, f64)) {
        let up = out * level.sin().signum();
        // The normals before and after, in the sense of the meridian: it ascends where the normal points outwards.
        let beside = |before: bool| {
            let ascending = before == (out > 0.0);
            let angle = if ascending { level - 0.5 } else { level + 0.5 };
            [(out * angle.cos()).signum(), 0.0]
        };
        let flat = [0.0, up];
        let ends = if out > 0.0 { at } else { [at[1], at[0]] };
        for (skipped, normals) in [(ends[0], [beside(true), flat]), (ends[1], [flat, beside(false)])] {
            if !skipped {
                let rim = Rim {
                    radius: centre,
                    height: height + radius * level.sin().signum(),
                    normals,
                    edges: 0..0,
                };
                self.edge(&rim, Some((up, radius)));
            }
        }
    }

    /// A line and one of the tubes.
    fn on_tube(&mut self, view: &View, sector: Sector, tube: &Tube) -> Result<(), Open> {
        let (y, mark) = (view.y, self.lines.mark());
        let Along {
            x: across, z: along, ..
        } = self.along;
        if !(y.abs() > AXIS * self.slack) {
            return Err(Open);
        }
        let (r, centres) = (tube.radius, tube.centres);
        let value = |w: f64, lift: f64| {
            let x = view.x + across * w;
            let rho = length(x, y);
            let (out, up) = (rho - centres, view.z + along * w - lift - tube.height);
            [out * out + up * up - r * r, 2.0 * (out * across * x / rho + along * up)]
        };
        // Beyond the tube.
        let far = centres.abs() + 2.0 * r;
        let [mut a, mut b] = between(view.x, across, [-far, far]);
        if along != 0.0 {
            let [low, high] = between(view.z, along, [tube.height - 2.0 * r, tube.height + 2.0 * r]);
            (a, b) = (a.max(low), b.min(high));
        }
        if !(a < b) {
            return Ok(());
        }
        let doubt = 8.0 * self.coarse * (r + self.coarse);
        // Where it is concave.
        let share = across * across / (across * across + along * along);
        let square = (centres.max(0.0) * y * y * share).cbrt().powi(2) - y * y;
        let inner = if square > 0.0 { square.sqrt() } else { 0.0 };
        let [low, high] = between(view.x, across, [-inner, inner]).map(|w| w.clamp(a, b));
        let spans = if inner > 0.0 && low < high {
            [([a, low], true), ([low, high], false), ([high, b], true)]
        } else {
            [([a, b], true), ([b, b], true), ([b, b], true)]
        };
        for (ends, convex) in spans {
            let arch = Arch {
                function: |w| value(w, 0.0),
                ends,
                convex,
                doubt: [doubt; 3],
                enough: 1e-6 * r,
            };
            let found = arch.zeros(|w| self.point_of_tube(view, sector, tube, (w, doubt), &value));
            if found.is_err() {
                self.lines.forget(mark);
                return found;
            }
        }
        Ok(())
    }

    fn point_of_tube(
        &mut self,
        view: &View,
        sector: Sector,
        tube: &Tube,
        (w, doubt): (f64, f64),
        value: &impl Fn(f64, f64) -> [f64; 2],
    ) -> Result<(), Open> {
        let (y, r) = (view.y, tube.radius);
        let Along {
            x: across, z: along, ..
        } = self.along;
        let sign = if tube.beyond { -1.0 } else { 1.0 };
        let tip = |w: f64| [sign * (view.x + across * w), sign * y];
        let (w, [slope, step, lift]) = self.zero((w, y), tip, value);
        let x = view.x + across * w;
        let rho = length(x, y);
        let bend = 2.0 * (along * along + across * across * (1.0 + tube.centres.abs() * y * y / (rho * rho * rho)));
        let error = 2.0 * self.fine * r / slope.abs();
        if !(slope * slope > 16.0 * bend * doubt && step.abs() <= error) {
            return Err(Open);
        }
        // From the tube's centre: away from the arc's axis in the direction of the tip, and along it.
        let (out, up) = (sign * (rho - tube.centres), view.z + along * w - lift - tube.height);
        let off = 4.0 * (error * (across.abs() + along.abs()) + self.coarse);
        let inside = match tube.part {
            TubePart::Heights(ends) => certainly_within(up, ends, off),
            TubePart::Angles([middle, half], flat) => {
                let (s, c) = middle.sin_cos();
                let (a, b) = (tube.side * out, up);
                let apart = (b * c - a * s).atan2(a * c + b * s).abs();
                let inside = certainly_within(apart, [-1.0, half], off / r + 8.0 * f64::EPSILON);
                // Beyond half a turn from the middle there is nothing.
                let inside = if half >= PI { Some(true) } else { inside };
                match inside {
                    Some(true) if flat && !(out.abs() > 4.0 * self.slope.abs().sqrt() * r) => None,
                    inside => inside,
                }
            }
        };
        match inside {
            Some(false) => return Ok(()),
            None => return Err(Open),
            Some(true) => {}
        }
        let normal = [tube.out * out / r, tube.out * up / r];
        // Of the meridian, `n_ρ`: that of a ball is never negative.
        let inwards = match tube.part {
            TubePart::Heights(_) => false,
            TubePart::Angles(..) => tube.side * normal[0] < 0.0,
        };
        let lean = self.arc.tilt;
        let rises = lean[1] * normal[1] + lean[0] * normal[0] * sign * x / rho;
        let falls = inwards == tube.beyond;
        let point = EnvelopePoint {
            w,
            error,
            tip: tip(w),
            askew: (self.fine + 2.0 * across.abs() * error + 2.0 * r * self.slope.abs()) / rho,
            normal: [normal[0], 0.0, normal[1]],
            jump: if (rises > 0.0) == falls { -1 } else { 1 },
        };
        self.settle(view, sector, &point)
    }
}
