//! Motions along B-splines: in the solver's form, and for brute force, which evaluates the splines by de Boor's
//! algorithm.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::sync::Arc;
use sweepsim_motion::{Path, SplineMotion};
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};
use sweepsim_tests::oracle::{Motion, Place, Placement};

/// A tip and quaternions `(w, x, y, z)` over one range.
#[derive(Clone, Debug)]
pub struct Splines {
    pub tip_knots: Vec<f64>,
    pub tips: Vec<[f64; 3]>,
    pub weights: Vec<f64>,
    pub turn_knots: Vec<f64>,
    pub turns: Vec<[f64; 4]>,
}

/// De Boor's algorithm.
fn at<const N: usize>(knots: &[f64], points: &[[f64; N]], x: f64) -> [f64; N] {
    let degree = knots.len() - points.len() - 1;
    let span = (degree..points.len())
        .rfind(|&k| knots[k] <= x && knots[k] < knots[k + 1])
        .expect("a parameter of the domain");
    let mut row: Vec<[f64; N]> = points[span - degree..=span].to_vec();
    for level in 1..=degree {
        for j in (level..=degree).rev() {
            let i = span - degree + j;
            let s = (x - knots[i]) / (knots[i + degree + 1 - level] - knots[i]);
            row[j] = std::array::from_fn(|k| row[j - 1][k] * (1.0 - s) + row[j][k] * s);
        }
    }
    row[degree]
}

impl Splines {
    fn placement(&self, x: f64) -> Placement {
        let homogeneous: Vec<[f64; 4]> = self
            .tips
            .iter()
            .zip(&self.weights)
            .map(|(p, w)| [p[0] * w, p[1] * w, p[2] * w, *w])
            .collect();
        let [px, py, pz, w] = at(&self.tip_knots, &homogeneous, x);
        let [q0, q1, q2, q3] = at(&self.turn_knots, &self.turns, x);
        Placement {
            tip: Vector3::new(px, py, pz) / w,
            axis: UnitQuaternion::from_quaternion(Quaternion::new(q0, q1, q2, q3)) * Vector3::z(),
        }
    }

    /// All different knots of either curve: between each two there is one move.
    fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = self.tip_knots.iter().chain(&self.turn_knots).copied().collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// In the form of brute force.
    pub fn motion(&self) -> Motion {
        let place = |pair: &[f64]| {
            let (from, to, splines) = (pair[0], pair[1], self.clone());
            // The end belongs to the last piece before it.
            let last = to - 1e-15 * (1.0 + to.abs());
            let place: Place = Arc::new(move |t| splines.placement((from + (to - from) * t).min(last)));
            let steps = 2000;
            // Speeds by differences, with a margin of one half.
            let speed = |of: &dyn Fn(&Placement) -> Vector3<f64>| {
                let value = |k: usize| of(&place(k as f64 / steps as f64));
                let step = |k: usize| (value(k + 1) - value(k)).norm() * steps as f64;
                1.5 * (0..steps).map(step).fold(0.0, f64::max)
            };
            let speeds = (speed(&|p| p.tip), speed(&|p| p.axis));
            (place, speeds.0, speeds.1)
        };
        Motion::of_functions(self.breaks().windows(2).map(place).collect())
    }

    /// In the form of the solver.
    pub fn solved(&self) -> SplineMotion {
        let knots = |list: &[f64], points: usize| {
            KnotVector::new(list.len() - points - 1, list.to_vec()).expect("knots of a curve")
        };
        let turn = BSpline::new(vec![knots(&self.turn_knots, self.turns.len())], 4, self.turns.concat());
        let tip_knots = vec![knots(&self.tip_knots, self.tips.len())];
        let tip = RationalSpline::new(tip_knots, 3, &self.tips.concat(), &self.weights);
        SplineMotion::from_quaternions(&turn.expect("a curve"), &tip.expect("a curve")).expect("a motion")
    }

    pub fn path(&self) -> Path {
        Path::along(self.solved())
    }

    /// The reverse motion.
    pub fn reversed(&self) -> Self {
        let mut back = self.clone();
        let ends = self.tip_knots[0] + self.tip_knots[self.tip_knots.len() - 1];
        for knots in [&mut back.tip_knots, &mut back.turn_knots] {
            knots.reverse();
            knots.iter_mut().for_each(|knot| *knot = ends - *knot);
        }
        back.tips.reverse();
        back.weights.reverse();
        back.turns.reverse();
        back
    }

    /// The same, with a move more: a knot of the orientation where there was none, by Boehm's insertion.
    pub fn cut(&self, x: f64) -> Self {
        let mut cut = self.clone();
        let degree = self.turn_knots.len() - self.turns.len() - 1;
        let knots = &self.turn_knots;
        let span = (degree..self.turns.len()).rfind(|&k| knots[k] <= x).expect("inside");
        cut.turns = (0..=self.turns.len())
            .map(|i| {
                let part = if i + degree <= span {
                    1.0
                } else if i > span {
                    0.0
                } else {
                    (x - knots[i]) / (knots[i + degree] - knots[i])
                };
                let (a, b) = (self.turns[i.saturating_sub(1)], self.turns[i.min(self.turns.len() - 1)]);
                std::array::from_fn(|k| a[k] * (1.0 - part) + b[k] * part)
            })
            .collect();
        cut.turn_knots.insert(span + 1, x);
        cut
    }
}
