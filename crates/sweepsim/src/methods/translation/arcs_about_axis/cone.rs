//! A cone or a cylinder along an arc about its axis: the cones with the radius `R ± ρ` about the arc's axis.

use super::roots::{Arch, Open};
use super::{AXIS, Along, EnvelopePoint, Orbit, Sector, View, between, length, products};
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::Piece;
use sweepsim_dexel::Source;

/// Cones that are flatter than this are left to charts.
const FLAT: f64 = 1e-3;

/// One of the cones about the arc's axis.
struct Cone {
    /// The signed radius where `z = 0`, and how it grows with `z`.
    radius: f64,
    growth: f64,
    /// Whether it is the part with negative radii, on the other side of the axis.
    beyond: bool,
    /// 1 on the outer side of the tool, −1 on the inner one.
    side: f64,
    /// Of the meridian.
    normal: [f64; 2],
    heights: [f64; 2],
    /// The greatest radius.
    reach: f64,
}

impl<S: Fn(f64) -> Source> Orbit<'_, '_, S> {
    pub(super) fn cone(&mut self, piece: &Piece, normal: [f64; 2]) -> Option<()> {
        let ([n, m], big) = (normal, self.arc.radius);
        let [from, to] = [piece.from, piece.to];
        let widest = from[0].max(to[0]);
        if n.abs() < FLAT || !self.is_straight(widest, self.slope * m / n) {
            return None;
        }
        let heights = [from[1].min(to[1]), from[1].max(to[1])];
        let weight = n * from[0] + m * from[1];
        for side in [1.0, -1.0] {
            let radii = [big + side * from[0], big + side * to[0]];
            let [low, high] = [radii[0].min(radii[1]), radii[0].max(radii[1])];
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
                let cone = Cone {
                    radius: sign * (big + side * weight / n),
                    growth: -sign * side * m / n,
                    beyond,
                    side,
                    normal,
                    heights,
                    reach: low.abs().max(high.abs()),
                };
                for (sector, [x, y]) in self.parts() {
                    let area = [products(range, x), products(range, y), heights];
                    self.each(area, |own, view| {
                        if own.on_cone(view, sector, &cone).is_err() {
                            own.open(view);
                        }
                    });
                }
            }
        }
        Some(())
    }

    /// A line and one of the cones.
    fn on_cone(&mut self, view: &View, sector: Sector, cone: &Cone) -> Result<(), Open> {
        let (y, mark) = (view.y, self.lines.mark());
        let Along {
            x: across, z: along, ..
        } = self.along;
        if !(y.abs() > AXIS * self.slack) {
            return Err(Open);
        }
        let far = cone.reach + 4.0 * self.coarse + 1e-3 * cone.reach;
        let [mut a, mut b] = between(view.x, across, [-far, far]);
        let doubt = 4.0 * self.coarse * (1.0 + cone.growth.abs());
        let mut ends = [doubt; 2];
        if along == 0.0 {
            match certainly_within(view.z, cone.heights, self.coarse) {
                Some(false) => return Ok(()),
                None => return Err(Open),
                Some(true) => {}
            }
        } else {
            let [low, high] = between(view.z, along, cone.heights);
            let blur = doubt + self.coarse * (self.along.shear() + cone.growth.abs());
            if low > a {
                (a, ends[0]) = (low, blur);
            }
            if high < b {
                (b, ends[1]) = (high, blur);
            }
        }
        let growth = cone.growth * along;
        let value = |w: f64, lift: f64| {
            let x = view.x + across * w;
            let rho = length(x, y);
            [
                rho - cone.radius - cone.growth * (view.z + along * w - lift),
                across * x / rho - growth,
            ]
        };
        let arch = Arch {
            function: |w| value(w, 0.0),
            ends: [a, b],
            convex: true,
            doubt: [ends[0], ends[1], doubt],
            enough: 1e-6 * far,
        };
        let found = arch.zeros(|w| self.point_of_cone(view, sector, cone, (w, doubt), &value));
        if found.is_err() {
            self.lines.forget(mark);
        }
        found
    }

    fn point_of_cone(
        &mut self,
        view: &View,
        sector: Sector,
        cone: &Cone,
        (w, doubt): (f64, f64),
        value: &impl Fn(f64, f64) -> [f64; 2],
    ) -> Result<(), Open> {
        let sign = if cone.beyond { -1.0 } else { 1.0 };
        let (y, across) = (view.y, self.along.x);
        let tip = |w: f64| [sign * (view.x + across * w), sign * y];
        let (w, [slope, step, _]) = self.zero((w, y), tip, value);
        let x = view.x + across * w;
        let rho = length(x, y);
        let bend = (across * y).powi(2) / (rho * rho * rho);
        let error = self.fine * (1.0 + cone.growth.abs()) / slope.abs();
        if !(slope * slope > 16.0 * bend * doubt && step.abs() <= error) {
            return Err(Open);
        }
        let [n, m] = cone.normal;
        let offset = (rho - sign * self.arc.radius).abs() * (self.slope * m / n).abs();
        let lean = self.arc.tilt;
        // Along the dexels.
        let up = lean[1] * m + lean[0] * cone.side * n * sign * x / rho;
        let falls = (n > 0.0) != cone.beyond;
        let point = EnvelopePoint {
            w,
            error,
            tip: tip(w),
            askew: (self.fine + 2.0 * across.abs() * error + 2.0 * offset) / rho,
            normal: [cone.side * n, 0.0, m],
            jump: if (up > 0.0) == falls { -1 } else { 1 },
        };
        self.settle(view, sector, &point)
    }
}
