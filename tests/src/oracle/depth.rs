//! The signed distance of a point from a swept volume: `D(P) = min over t of d(t, P)`.
//!
//! `d(t, ·)`, the signed distance from the tool at an instant, is 1-Lipschitz in space; so is `D`. Outside, `D` is the
//! distance from the swept volume. Inside, `−D` is the radius of the largest ball about `P` that one placement holds:
//! at most the distance from the boundary. Hence, where every tool point and line moves by at most `ε`, `D` changes by
//! at most `ε`; and the boundary has `D = 0`.

use super::minimum::minimise;
use super::motion::Motion;
use super::outline::Outline;
use nalgebra::Vector3;

/// Pieces of each arc's time to begin with, and how often they are halved where they may still hold the minimum.
const PIECES: usize = 32;
const HALVINGS: usize = 7;
/// How many of the remaining local minima are refined.
const REFINED: usize = 6;

/// The signed distance from what a tool sweeps.
#[derive(Clone, Debug)]
pub struct Depth<'a> {
    outline: &'a Outline,
    motion: &'a Motion,
}

/// The instant at which the tool is nearest to a point (or holds it deepest).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Signed distance, negative inside.
    pub distance: f64,
    /// The move, from 0.
    pub segment: usize,
    /// The time in the move, in `[0, 1]`.
    pub time: f64,
}

#[derive(Clone, Copy)]
struct Stretch {
    arc: usize,
    time: [f64; 2],
    distance: [f64; 2],
    /// Lipschitz constant of the distance in this arc's time.
    speed: f64,
}

impl Stretch {
    /// No instant of the stretch comes nearer than this.
    fn bound(&self) -> f64 {
        0.5 * (self.distance[0] + self.distance[1] - self.speed * (self.time[1] - self.time[0]))
    }

    fn least(&self) -> f64 {
        self.distance[0].min(self.distance[1])
    }
}

impl<'a> Depth<'a> {
    /// The distance from what the tool with this outline sweeps in this motion.
    #[must_use]
    pub fn new(outline: &'a Outline, motion: &'a Motion) -> Self {
        Self { outline, motion }
    }

    fn instant(&self, arc: usize, t: f64, p: &Vector3<f64>) -> f64 {
        self.placed(&self.motion.arcs()[arc].at(t), p)
    }

    fn placed(&self, placement: &super::Placement, p: &Vector3<f64>) -> f64 {
        let r = p - placement.tip;
        self.outline
            .signed_distance(r.cross(&placement.axis).norm(), r.dot(&placement.axis))
    }

    /// The signed distance from the tool at time `t` of move `segment`.
    ///
    /// # Panics
    /// When there is no such move.
    #[must_use]
    pub fn at_time(&self, segment: usize, t: f64, p: [f64; 3]) -> f64 {
        self.placed(&self.motion.at(segment, t), &p.into())
    }

    /// The signed distance of `p` from the swept volume: branch and bound in time by the Lipschitz constant, then local
    /// refinement.
    #[must_use]
    pub fn at(&self, p: [f64; 3]) -> Nearest {
        let p = Vector3::from(p);
        let mut stretches: Vec<Stretch> = Vec::new();
        for (arc, moving) in self.motion.arcs().iter().enumerate() {
            let (count, speed) = if moving.rests() {
                (1, 0.0)
            } else {
                (PIECES, moving.speed_bound(&p))
            };
            let times: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
            let distances: Vec<f64> = times.iter().map(|&t| self.instant(arc, t, &p)).collect();
            stretches.extend((0..count).map(|i| Stretch {
                arc,
                time: [times[i], times[i + 1]],
                distance: [distances[i], distances[i + 1]],
                speed,
            }));
        }
        let mut best = stretches.iter().map(Stretch::least).fold(f64::INFINITY, f64::min);
        for _ in 0..HALVINGS {
            // The one with the best sample stays, whatever the rounding of its bound.
            stretches.retain(|stretch| stretch.bound() < best || stretch.least() <= best);
            let mut halves = Vec::with_capacity(2 * stretches.len());
            for stretch in &stretches {
                let t = 0.5 * (stretch.time[0] + stretch.time[1]);
                let distance = self.instant(stretch.arc, t, &p);
                best = best.min(distance);
                let mut half = *stretch;
                (half.time[1], half.distance[1]) = (t, distance);
                halves.push(half);
                half = *stretch;
                (half.time[0], half.distance[0]) = (t, distance);
                halves.push(half);
            }
            stretches = halves;
        }
        // Neighbours that share the least sample are refined together: one stretch to either side of it.
        stretches.sort_by(|a, b| a.least().total_cmp(&b.least()));
        let mut nearest = Nearest {
            distance: f64::INFINITY,
            segment: 0,
            time: 0.0,
        };
        let mut refined: Vec<(usize, f64)> = Vec::new();
        for stretch in &stretches {
            let width = stretch.time[1] - stretch.time[0];
            let at = stretch.time[usize::from(stretch.distance[1] < stretch.distance[0])];
            let known = refined
                .iter()
                .any(|&(arc, t)| arc == stretch.arc && (t - at).abs() < 1.5 * width);
            if known || (stretch.bound() >= nearest.distance && !refined.is_empty()) {
                continue;
            }
            if refined.len() == REFINED {
                break;
            }
            refined.push((stretch.arc, at));
            let (from, to) = ((at - width).max(0.0), (at + width).min(1.0));
            let found = minimise(|t| self.instant(stretch.arc, t, &p), from, to, 1e-13);
            if found.value < nearest.distance {
                let arc = &self.motion.arcs()[stretch.arc];
                nearest = Nearest {
                    distance: found.value,
                    segment: arc.segment,
                    time: arc.time_at(found.at),
                };
            }
        }
        nearest
    }

    /// The direction in which the distance grows fastest at `p`: the outward normal near the boundary. `None` where it
    /// is not smooth on the scale `h` (a corner, a seam).
    #[must_use]
    pub fn gradient(&self, p: [f64; 3], h: f64) -> Option<[f64; 3]> {
        let at = |axis: usize, step: f64| {
            let mut q = p;
            q[axis] += step;
            self.at(q).distance
        };
        let centre = self.at(p).distance;
        let mut gradient = [0.0; 3];
        for axis in 0..3 {
            let (ahead, behind) = (at(axis, h) - centre, centre - at(axis, -h));
            if (ahead - behind).abs() > 0.05 * h {
                return None;
            }
            gradient[axis] = (ahead + behind) / (2.0 * h);
        }
        Some(gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools;
    use sweepsim_motion::{Pose, Tool};

    fn motion(poses: &[([f64; 3], [f64; 3])]) -> Motion {
        let poses: Vec<Pose> = poses.iter().map(|p| Pose::new(p.0, p.1).unwrap()).collect();
        Motion::new(&poses)
    }

    const UP: [f64; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn the_distance_from_a_capsule() {
        let outline = Outline::new(
            Tool::ball(3.0, 500.0)
                .unwrap()
                .profile()
                .expect("a solid of revolution"),
        );
        let (from, to) = (Vector3::new(0.0, 0.0, 0.0), Vector3::new(20.0, 4.0, -10.0));
        let motion = motion(&[(from.into(), UP), (to.into(), UP)]);
        let depth = Depth::new(&outline, &motion);
        let d = to - from;
        for p in [
            [5.0, 9.0, -8.0],
            [10.0, 2.0, -9.0],
            [-7.0, 0.5, 2.0],
            [24.0, 8.0, -9.0],
            [9.0, 2.0, -4.0],
        ] {
            let q = Vector3::from(p) - Vector3::new(0.0, 0.0, 3.0);
            let foot = (q.dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
            let to_centres = q - d * foot;
            if to_centres.z > 0.0 {
                continue; // nearest to the shank
            }
            let found = depth.at(p);
            assert!(
                (found.distance - (to_centres.norm() - 3.0)).abs() < 1e-12,
                "{p:?} {found:?}"
            );
            assert!((found.time - foot).abs() < 1e-5);
        }
    }

    #[test]
    fn it_is_lipschitz_and_zero_on_the_ends_of_the_swept_lines() {
        let motion = motion(&[
            ([0.0, 0.0, 0.0], [0.1, 0.2, 1.0]),
            ([9.0, 5.0, -3.0], [0.7, -0.4, 0.6]),
            ([9.0, 5.0, -3.0], [-0.7, 0.4, 0.2]),
        ]);
        let mut ends = 0;
        for tool in tools::zoo() {
            let outline = Outline::new(tool.profile().expect("a solid of revolution"));
            let depth = Depth::new(&outline, &motion);
            for k in 0..25 {
                let (x, y) = (-8.0 + 5.17 * f64::from(k % 5), -8.0 + 4.03 * f64::from(k / 5));
                let line = crate::oracle::swept_line(&outline, &motion, x, y, crate::oracle::Sampling::number(200));
                if line.ambiguous {
                    continue;
                }
                for span in &line.spans {
                    for (z, out) in [(span.low, -1.0), (span.high, 1.0)] {
                        ends += 1;
                        let at = |step: f64| depth.at([x, y, z + out * step]).distance;
                        let error = span.error[usize::from(out > 0.0)] + 1e-9;
                        assert!(at(0.0).abs() < error, "({x}, {y}, {z}): {} {line:?}", at(0.0));
                        assert!(at(1e-3) > 0.0 && at(-1e-3) < 0.0, "({x}, {y}, {z})");
                        assert!((at(0.1) - at(0.0)).abs() <= 0.1 + 1e-12);
                    }
                }
            }
        }
        assert!(ends > 100, "{ends}");
    }

    #[test]
    fn the_gradient_is_the_normal_of_a_wall() {
        let outline = Outline::new(Tool::ball(3.0, 50.0).unwrap().profile().expect("a solid of revolution"));
        let motion = motion(&[([0.0; 3], UP), ([20.0, 0.0, 0.0], UP)]);
        let depth = Depth::new(&outline, &motion);
        let (s, c) = 25.0_f64.to_radians().sin_cos();
        let found = depth.gradient([10.0, 3.0 * s, 3.0 - 3.0 * c], 1e-5).unwrap();
        assert!((Vector3::from(found) - Vector3::new(0.0, s, -c)).norm() < 1e-5);
        assert_eq!(depth.gradient([10.0, 3.0, 50.0], 1e-5), None, "a corner has no normal");
    }
}
