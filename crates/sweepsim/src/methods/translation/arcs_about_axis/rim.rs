//! A sharp edge along an arc about its axis, which stays in its plane but for the rise.

use super::roots::Open;
use super::{AXIS, Along, ArcPlace, EnvelopePoint, Orbit, Sector, View, length, products};
use crate::cutter::outline::{Rim, fan_normal};
use sweepsim_dexel::Source;

/// An angle whose cosine is closer to 1 than this many errors is in doubt.
const GRAZING: f64 = 64.0;
/// Edges are solved here if those of their lines whose angle is in doubt are fewer than one in thirty.
const CLEAR: f64 = 64.0;

impl<S: Fn(f64) -> Source> Orbit<'_, '_, S> {
    pub(super) fn rim(&mut self, rim: &Rim) -> Option<()> {
        if !self.tells_angles(rim.radius, None) {
            return None;
        }
        self.edge(rim, None);
        Some(())
    }

    /// By how much a line may miss its place in the plane of an edge.
    fn blur(&self) -> f64 {
        4.0 * (self.fine + self.coarse * self.along.shear())
    }

    /// Whether most lines tell the angle at which an edge of this radius passes them, next to a torus with a tube of radius `level`. Those within `δ` of where it reaches farthest in or out pass it less than `√(2 ρ δ)` ahead of the
    /// tip, and have a certain angle where that is more than `2 √(GRAZING ε R)`, with places off by `ε`: next to a torus by [`bent`](Self::bent) there. Lines that are almost parallel to its plane tell nothing; but hardly any meet
    /// it, so they may be open.
    pub(super) fn tells_angles(&self, radius: f64, level: Option<f64>) -> bool {
        let big = self.arc.radius;
        let bent = level.map_or(0.0, |tube| {
            let least = 8.0 * GRAZING * big * tube * self.slope.abs() / (radius * radius);
            self.bent(tube, least.cbrt())
        });
        let beside = (big + radius) * self.along.z.abs() + 4.0 * self.coarse;
        beside * CLEAR < self.lines.lines.spacing() || (self.blur() + bent) * big < (radius / CLEAR).powi(2)
    }

    /// How far the curve in which a torus touches its envelope may be from the circle on which its normal is along the axis, where that is so far ahead of the tip, as a share of its radius: it leaves the circle where the
    /// normal leans by the rise over that share. Nearer to the place where the circle reaches farthest the curve is on the torus beyond doubt, and met as a tube.
    fn bent(&self, tube: f64, ahead: f64) -> f64 {
        let slope = self.slope.abs();
        tube * (2.0 * slope / ahead).min(slope.sqrt())
    }

    /// An edge; or the circle on which a torus with a tube of this radius has a normal along the axis, up or down: the curve in which it touches its envelope is
    /// that close to it.
    pub(super) fn edge(&mut self, rim: &Rim, level: Option<(f64, f64)>) {
        let radii = [self.arc.radius, rim.radius];
        for (sector, [x, y]) in self.parts() {
            let wide = |[low, high]: [f64; 2]| [low - radii[1], high + radii[1]];
            let [x, y] = [x, y].map(|range| wide(products([radii[0]; 2], range)));
            self.each([x, y, [rim.height; 2]], |own, view| {
                let mark = own.lines.mark();
                if own.on_edge(view, sector, rim, level).is_err() {
                    own.lines.forget(mark);
                    own.open(view);
                }
            });
        }
    }

    fn on_edge(&mut self, view: &View, sector: Sector, rim: &Rim, level: Option<(f64, f64)>) -> Result<(), Open> {
        let (y, big) = (view.y, self.arc.radius);
        let Along {
            x: across, z: along, ..
        } = self.along;
        let rho = rim.radius;
        if along == 0.0 {
            // In its plane all along.
            let off = (view.z - rim.height).abs() > 2.0 * self.coarse;
            return if off { Ok(()) } else { Err(Open) };
        }
        let start = view.x + across * ((rim.height - view.z) / along);
        let blur = self.blur();
        let far = length(start, y);
        if far > big + rho + blur || far < (big - rho).abs() - blur {
            return Ok(());
        }
        if !(y.abs() > AXIS * self.slack && far > 16.0 * blur) {
            return Err(Open);
        }
        let cosine = |far: f64| (far * far + (big - rho) * (big + rho)) / (2.0 * big * far);
        let c = cosine(far);
        let ahead = ((1.0 - c) * (1.0 + c)).max(0.0).sqrt() * far / rho;
        let bent = level.map_or(0.0, |(_, tube)| self.bent(tube, ahead));
        let doubt = 2.0 * (blur + bent) * (far + rho + big) / (big * far);
        if !((1.0 - c) * (1.0 + c) > GRAZING * doubt) {
            if c.abs() > 1.0 + doubt {
                return Ok(());
            }
            // Cosine and angle are this far from their extremes at most.
            let wide = (2.0 * (GRAZING + 2.0) * doubt).sqrt().min(1.5);
            let sign = 1.0_f64.copysign(c);
            return match self.place([sign * start, sign * y], wide) {
                ArcPlace::Outside => Ok(()),
                _ => Err(Open),
            };
        }
        // The sine of the angle between line and tip, and the tip, which is behind the line or ahead of it.
        let around = |x: f64, far: f64, turn: f64| {
            let c = cosine(far);
            let sine = ((1.0 - c) * (1.0 + c)).sqrt();
            (sine, [x * c + turn * y * sine, y * c - turn * x * sine])
        };
        for turn in [1.0, -1.0] {
            let (sine, tip) = around(start, far, turn);
            // The tip moves by no more than the doubt in the cosine, over the sine; next to a torus, doubts are looked at below.
            if level.is_none() && matches!(self.place(tip, 4.0 * doubt / sine), ArcPlace::Outside) {
                continue;
            }
            // From here to there, how far the tool has risen changes by a tiny part of its rise, which is itself no more than a hundredth of the tolerance.
            let w = (rim.height + self.lift(tip) - view.z) / along;
            let x = view.x + across * w;
            let (sine, tip) = around(x, length(x, y), turn);
            self.pass(view, sector, (rim, level), (w, tip, turn * sine, blur))?;
        }
        Ok(())
    }

    /// Where an edge passes a line. `sine`: of the angle from the tip to the line.
    fn pass(
        &mut self,
        view: &View,
        sector: Sector,
        (rim, level): (&Rim, Option<(f64, f64)>),
        (w, tip, sine, blur): (f64, [f64; 2], f64, f64),
    ) -> Result<(), Open> {
        let x = view.x + self.along.x * w;
        let (big, rho) = (self.arc.radius, rim.radius);
        let far = length(x, view.y);
        // Of the line from the tool's axis: ahead, and away from the arc's axis.
        let ahead = self.arc.side() * far * sine / rho;
        let out =
            (far * (1.0 - sine * sine).max(0.0).sqrt() * 1.0_f64.copysign(tip[0] * x + tip[1] * view.y) - big) / rho;
        // The sine is off by the cosine's error over it.
        let own = 2.0 * blur * (far + rho + big) / (big * far);
        let mut askew = 4.0 * own / sine.abs();
        let mut error = 4.0 * far / rho * own / sine.abs() + 8.0 * f64::EPSILON;
        let mut height_error = self.fine * (1.0 + self.along.z.abs().recip());
        if let Some((_, radius)) = level {
            if !(ahead.abs() > 4.0 * self.slope.abs().sqrt() + error) {
                // Whatever the signs are; but not if it is not on the arc.
                return match self.place(tip, askew + 8.0 * self.slope.abs().sqrt() * (1.0 + radius / far)) {
                    ArcPlace::Outside => Ok(()),
                    _ => Err(Open),
                };
            }
            let off = radius * self.slope.abs() / ahead.abs();
            let own = 2.0 * off * (far + rho + big) / (big * far);
            askew += 4.0 * own / sine.abs();
            error += 4.0 * far / rho * own / sine.abs();
            height_error += self.fine;
        }
        let g = |[n, m]: [f64; 2]| (n * ahead + m * self.slope, n.abs() * error);
        let [(a, a_error), (b, b_error)] = rim.normals.map(g);
        if !((a.abs() > a_error || a_error == 0.0) && (b.abs() > b_error || b_error == 0.0)) {
            return match self.place(tip, askew) {
                ArcPlace::Outside => Ok(()),
                _ => Err(Open),
            };
        }
        if (a < 0.0) == (b < 0.0) {
            return Ok(());
        }
        let inwards = ahead > 0.0;
        let orientation = if (self.arc.tilt[1] > 0.0) == inwards { -1 } else { 1 };
        let [radial, along] = fan_normal(&rim.normals, [a, b]);
        let normal = match level {
            Some((up, _)) => [0.0, 0.0, up],
            None => [radial * out, radial * ahead * self.arc.side(), along],
        };
        let point = EnvelopePoint {
            w,
            error: height_error,
            tip,
            askew,
            normal,
            jump: if a < 0.0 { -orientation } else { orientation },
        };
        self.settle(view, sector, &point)
    }
}
