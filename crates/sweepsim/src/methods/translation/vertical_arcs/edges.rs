//! Sharp edges along an arc: a line passes a circle about the tool's axis where it meets its plane at the radius from
//! its centre.

use super::{Chord, Rolling};
use crate::cutter::outline::Rim;
use crate::methods::sheets::Undecided::{self, Close};
use sweepsim_dexel::Source;

/// A place on a sharp edge.
struct EdgePoint {
    /// From the centre of the edge, `(q, p, z)`, and how far off it may be.
    arm: [f64; 3],
    off: f64,
    /// Whether its parts are beyond their errors.
    certain: bool,
    /// The direction from the centre of the arc, and the error of its angle.
    direction: [f64; 2],
    error: f64,
    z: f64,
}

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// Of an upright tool.
    pub(super) fn upright_edge(&mut self, rim: &Rim) {
        let [x, y, z] = self.arc.centre;
        let (r, big, slack) = (self.arc.radius, rim.radius, self.slack);
        let [low, high] = self.directions[0].map(|cosine| r * cosine);
        let level = z + rim.height;
        let ranges = [[-big, big], [low - big, high + big]];
        self.each([x, y, level], ranges, |own, line, [q, p]| {
            let Some(Chord { half, off, certain }) = own.chord(big, p, slack) else {
                return Ok(());
            };
            for ahead in [half, -half] {
                let cosine = (q - ahead) / r;
                let Some((sine, error)) = own.other(0, cosine, (2.0 * slack + off) / r)? else {
                    continue;
                };
                for sine in [sine, -sine] {
                    let point = EdgePoint {
                        arm: [ahead, p, 0.0],
                        off,
                        certain,
                        direction: [cosine, sine],
                        error,
                        z: level + r * sine,
                    };
                    own.edge(rim, line, &point)?;
                }
            }
            Ok(())
        });
    }

    /// Of a tool whose axis lies in the arc's plane.
    pub(super) fn lying_edge(&mut self, rim: &Rim) {
        let (r, big, slack) = (self.arc.radius, rim.radius, self.slack);
        let place = self.axis[0] * rim.height;
        let range = self.directions[0].map(|cosine| place + r * cosine);
        self.each(self.arc.centre, [[-big, big], range], |own, line, [q, p]| {
            let cosine = (q - place) / r;
            let Some(Chord { half, off, certain }) = own.chord(big, p, slack) else {
                return Ok(());
            };
            let Some((sine, error)) = own.other(0, cosine, 4.0 * slack / r)? else {
                return Ok(());
            };
            for sine in [sine, -sine] {
                for up in [half, -half] {
                    let point = EdgePoint {
                        arm: [0.0, p, up],
                        off,
                        certain,
                        direction: [cosine, sine],
                        error,
                        z: own.arc.centre[2] + r * sine + up,
                    };
                    own.edge(rim, line, &point)?;
                }
            }
            Ok(())
        });
    }

    /// On an arc across the dexels.
    pub(super) fn level_edge(&mut self, rim: &Rim) {
        let (r, big, slack) = (self.arc.radius, rim.radius, self.slack);
        self.each_level(big, [rim.height; 2], |own, line, [q, p]| {
            let sine = (p - rim.height) / r;
            let Some((cosine, error)) = own.other(1, sine, 4.0 * slack / r)? else {
                return Ok(());
            };
            for cosine in [cosine, -cosine] {
                let (x, off) = (q - r * cosine, 2.0 * slack + r * error);
                let Some(Chord { half, certain, .. }) = own.chord(big, x, 0.5 * off) else {
                    continue;
                };
                for up in [half, -half] {
                    let point = EdgePoint {
                        arm: [x, 0.0, up],
                        off,
                        certain,
                        direction: [cosine, sine],
                        error,
                        z: own.arc.centre[2] + up,
                    };
                    own.edge(rim, line, &point)?;
                }
            }
            Ok(())
        });
    }

    #[inline]
    fn edge(&mut self, rim: &Rim, line: usize, point: &EdgePoint) -> Result<(), Undecided> {
        let EdgePoint {
            arm,
            off,
            direction: [c, s],
            error,
            ..
        } = *point;
        let Some(share) = self.share([c, s], error)? else {
            return Ok(());
        };
        if !point.certain {
            return Err(Close);
        }
        let side = self.arc.side();
        let velocity = if self.arc.level {
            [-side * s, side * c, 0.0]
        } else {
            [-side * s, 0.0, side * c]
        };
        let axis = self.axis;
        let along_velocity = |a: [f64; 3]| a[0] * velocity[0] + a[1] * velocity[1] + a[2] * velocity[2];
        let (out, along) = (along_velocity(arm) / rim.radius, along_velocity(axis));
        let doubt = 2.0 * (off / rim.radius + error) + 16.0 * f64::EPSILON;
        let Some(([radial, axial], first)) = rim.envelope([out, along], doubt).ok_or(Close)? else {
            return Ok(());
        };
        // That of the edge, the velocity and the dexels.
        let orientation = along * arm[2] - axis[2] * out * rim.radius;
        let jump = if first == (orientation > 0.0) { -1 } else { 1 };
        let normal = [0, 1, 2].map(|k| radial / rim.radius * arm[k] + axial * axis[k]);
        self.crossing(line, point.z, jump, normal, share);
        Ok(())
    }
}
