//! The inner loop: the motion at one time, in the frame of a patch.

use crate::algebra::quad::{Quad, add, blend, cross, mix, quad, quadratics, sub};
use crate::time::arc::ArcTimes;
use crate::time::moment::Moment;
use crate::time::pieces::Times;
use crate::time::placement::{LocalFrame, Placing, Twisted};
use nalgebra::{Matrix3, Vector3};
use std::cell::OnceCell;

/// The motion at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub placing: Placing,
    /// The angular velocity in space, about the pivot, and the pivot's velocity.
    spin: Quad,
    pivot: Quad,
    velocity: Quad,
    /// In the frame, with the derivative in `t`.
    pub own: Twisted,
    pub change: Twisted,
}

impl Instant {
    fn of(moment: &Moment, frame: Option<&LocalFrame>) -> Self {
        let zero = Vector3::zeros();
        let spin_slope = moment.own_spin_slope.unwrap_or(zero);
        Self {
            placing: Placing::new(&moment.turn, &moment.tip, frame),
            spin: quad(&moment.spin),
            pivot: quad(&moment.tip),
            velocity: quad(&moment.velocity),
            own: Twisted::new(&moment.own_spin, &moment.travel, frame),
            change: Twisted::new(&spin_slope, &moment.travel_slope, frame),
        }
    }

    /// The velocity of the point at `place`.
    pub fn moving(&self, place: &Quad) -> Quad {
        add(&cross(&self.spin, &sub(place, &self.pivot)), &self.velocity)
    }
}

/// A motion, in a frame fixed to the tool, or in the tool's own.
pub(crate) struct FramedMotion<'a> {
    frame: Option<&'a LocalFrame>,
    /// An arc in the lowest degrees, from the first evaluation on: most patches are settled without any.
    arc: OnceCell<Box<FramedArc>>,
}

/// An arc with a straight tip, in a frame.
pub(crate) struct FramedArc {
    /// For a translation, constant except for the origin.
    still: Option<Instant>,
    /// Coefficients: the columns of the turn and the origin's arm, both times the weight; `b′` in the frame; the weight.
    c: [[f64; 16]; 3],
    tip: Quad,
    velocity: Quad,
    pace: Quad,
    spin: Quad,
}

const ARM: usize = 9;
const TRAVEL: usize = 12;
const WEIGHT: usize = 15;

impl<'a> FramedMotion<'a> {
    pub fn new(frame: Option<&'a LocalFrame>) -> Self {
        Self {
            frame,
            arc: OnceCell::new(),
        }
    }

    /// The motion at `t`, always of the same pieces. Callers that need only some of it do not pay for the rest.
    #[inline]
    pub fn at(&self, times: &Times, t: f64) -> Instant {
        match times {
            Times::Arc(arc) => self.arc.get_or_init(|| Box::new(FramedArc::new(arc, self.frame))).at(t),
            Times::Curve(_) => Instant::of(&times.at(t), self.frame),
        }
    }
}

impl FramedArc {
    #[cold]
    fn new(arc: &ArcTimes, frame: Option<&LocalFrame>) -> Self {
        let still = (arc.count == 1).then(|| Instant::of(&arc.at(0.0), frame));
        let mut c = [[0.0; 16]; 3];
        for (c, (turn, weight, travel)) in c.iter_mut().zip(arc.coefficients()) {
            let (own, shift) = frame.copied().unwrap_or((Matrix3::identity(), Vector3::zeros()));
            let seen = Twisted::new(&Vector3::from(arc.spin[0]), &travel, frame).travel;
            c[..ARM].copy_from_slice((turn * own).as_slice());
            c[ARM..TRAVEL].copy_from_slice((turn * shift).as_slice());
            c[TRAVEL..WEIGHT].copy_from_slice(&seen[..3]);
            c[WEIGHT] = weight;
        }
        Self {
            still,
            c,
            tip: quad(&arc.tips[0]),
            velocity: quad(&arc.velocity),
            pace: quad(&arc.pace()),
            spin: Twisted::new(&Vector3::from(arc.spin[0]), &Vector3::zeros(), frame).spin,
        }
    }

    #[inline]
    fn at(&self, t: f64) -> Instant {
        let pivot = mix(1.0, &self.tip, t, &self.velocity);
        if let Some(mut instant) = self.still {
            instant.placing.origin = mix(1.0, &instant.placing.origin, t, &self.velocity);
            instant.pivot = pivot;
            return instant;
        }
        let [values, slopes] = quadratics(t);
        let c = blend(&values, &self.c);
        let pace = 1.0 / c[WEIGHT];
        let over = |k: usize| [pace * c[k], pace * c[k + 1], pace * c[k + 2], 0.0];
        let slope = |k: usize| slopes[0] * self.c[0][k] + slopes[1] * self.c[1][k] + slopes[2] * self.c[2][k];
        Instant {
            placing: Placing {
                turn: [over(0), over(3), over(6)],
                origin: add(&pivot, &over(ARM)),
            },
            spin: self.pace.map(|x| x * pace),
            pivot,
            velocity: self.velocity,
            own: Twisted {
                spin: self.spin,
                travel: [c[TRAVEL], c[TRAVEL + 1], c[TRAVEL + 2], 0.0],
            },
            change: Twisted {
                spin: [0.0; 4],
                travel: [slope(TRAVEL), slope(TRAVEL + 1), slope(TRAVEL + 2), 0.0],
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::path_parts::parts;
    use crate::tolerances::Tolerances;
    use nalgebra::Rotation3;
    use sweepsim_motion::{Path, Pose};
    use sweepsim_props::*;

    fn near(a: &Quad, b: &Quad, error: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= error)
    }

    proptest! {
        /// The motion of an arc agrees with its table of coefficients; velocities agree with finite differences.
        #[test]
        fn arcs_agree_with_their_moments(t in 0.01..0.99, from in [-0.5..0.5, -0.5..0.5], to in [-0.5..0.5, -0.5..0.5], still in any::<bool>()) {
            let pose = |tip: [f64; 3], lean: [f64; 2]| Pose::new(tip, [lean[0], lean[1], 1.0]).unwrap();
            let path = Path::new(vec![pose([0.0, 1.0, 2.0], from), pose([30.0, -10.0, 5.0], if still { from } else { to })]).unwrap();
            let own: LocalFrame = (Rotation3::new(Vector3::new(0.3, -0.7, 0.2)).into_inner(), Vector3::new(0.0, 0.0, 5.0));
            for part in parts((&path, 0..path.moves()), &sweepsim_dexel::Frame::WORLD, crate::time::path_parts::Kind { symmetric: true, closed: false }, 40.0, &Tolerances::new(1e-6, 100.0).unwrap()) {
                let times = Times::new(&part.segment);
                for frame in [None, Some(&own)] {
                    let (motion, expected) = (FramedMotion::new(frame), Instant::of(&times.at(t), frame));
                    let found = motion.at(&times, t);
                    for k in 0..3 {
                        prop_assert!(near(&found.placing.turn[k], &expected.placing.turn[k], 1e-14));
                    }
                    prop_assert!(near(&found.placing.origin, &expected.placing.origin, 1e-13));
                    for (a, b) in [(found.own, expected.own), (found.change, expected.change)] {
                        prop_assert!(near(&a.spin, &b.spin, 1e-13) && near(&a.travel, &b.travel, 1e-12));
                    }
                    let point = Vector3::new(3.0, -4.0, 7.0);
                    let place = |t: f64| {
                        let placing = motion.at(&times, t).placing;
                        add(&placing.turned(&point), &placing.origin)
                    };
                    let h = 1e-5;
                    let difference = sub(&place(t + h), &place(t - h)).map(|x| x / (2.0 * h));
                    prop_assert!(near(&found.moving(&place(t)), &difference, 1e-6));
                }
            }
        }
    }
}
