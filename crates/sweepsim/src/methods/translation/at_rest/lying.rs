//! A torus at rest whose axis is perpendicular to the dexels: a line is at one height along the axis, where the torus
//! has a circle or two.

use super::super::quarter::{HeightRange, Quarter};
use super::cone_sign_changes::{Wedge, wedges_between};
use super::leaning::{Leaning, LeaningPoint, Points};
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::Piece;

/// A vanishing distance is beyond doubt from so many times its error on.
const CERTAIN: f64 = 64.0;

/// Azimuths are this accurate at least, well within the margins of wedges.
const AZIMUTH: f64 = 1e-7;

impl Leaning<'_, '_> {
    /// `None` if there is no closed form.
    pub(super) fn lying(&mut self, piece: &Piece) -> Option<()> {
        for quarter in Quarter::all(piece, self.floor.rounding, false)? {
            for part in quarter.parts() {
                let Some(normals) = part.normals else {
                    self.rings(&quarter, &part, None);
                    continue;
                };
                let wedges = wedges_between(normals, &self.sides);
                for wedge in &wedges {
                    self.rings(&quarter, &part, Some((wedge, wedges.len() > 1)));
                }
            }
        }
        Some(())
    }

    /// A part of a quarter, within a wedge if there is one, which may be one of many.
    fn rings(&mut self, quarter: &Quarter, part: &HeightRange, wedge: Option<(&Wedge, bool)>) {
        let ([s, _], slack) = (self.tilt, self.floor.rounding);
        let (heights, reach) = (quarter.heights(), quarter.radii[1]);
        let across = wedge.map_or([-reach, reach], |(wedge, _)| wedge.across(quarter.radii));
        let [low, high] = [0, 1].map(|k| s * heights[k].clamp(part.heights[0], part.heights[1]));
        self.visit([across, [low, high]], |q, b| {
            let height = q / s;
            let inside = certainly_within(height, heights, 8.0 * slack);
            let here = height >= part.heights[0] && height < part.heights[1];
            if inside == Some(false) || !here {
                return Points::Two([None, None]);
            }
            let Some(ring) = quarter.ring(height, slack) else {
                return Points::Tangent;
            };
            let rho = ring.radius;
            let off = 2.0 * slack * (2.0 + ring.rate);
            let (square, doubt) = ((rho - b) * (rho + b), 4.0 * off * (rho.abs() + off));
            if square < -doubt {
                return Points::Two([None, None]);
            }
            let half = square.sqrt();
            // NaN is a tangent, too.
            if !(square > CERTAIN * doubt) || (wedge.is_some() && 2.0 * off > AZIMUTH * half) {
                return Points::Tangent;
            }
            // Divided by its part across the axis, which may be small and inexact: of its sign nothing else depends on
            // that.
            let [n, m] = [1.0_f64.copysign(ring.normal[0]), ring.normal[1] / ring.normal[0].abs()];
            let error = [2.0 * doubt / (half * rho), 4.0 * slack * ring.turn];
            Points::Two([-half, half].map(|a| {
                let held = wedge.is_none_or(|(wedge, many)| !many || wedge.holds(a / rho, b / rho));
                held.then_some(LeaningPoint {
                    height: a * s,
                    normal: [n * a / rho, n * b / rho, m],
                    error,
                    inside,
                })
            }))
        });
    }
}
