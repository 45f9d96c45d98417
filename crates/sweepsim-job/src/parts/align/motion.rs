//! Small rigid motions as six numbers, and which of them a surface does not determine.

use nalgebra::{Isometry3, Matrix3, Matrix6, Point3, Rotation3, SymmetricEigen, Translation3, Vector3, Vector6};

/// The share of a motion that must change distances, squared and in the mean: less than 2 % of it is none.
const LEAST: f64 = 5e-4;

/// A least-squares problem in a small motion: a turn about `centre`, times `size`, and a shift.
pub(super) struct NormalEquations {
    centre: Point3<f64>,
    size: f64,
    matrix: Matrix6<f64>,
    side: Vector6<f64>,
    weight: f64,
}

/// What solves it, and the motions along which nothing changes.
pub(super) struct Solution {
    pub motion: Isometry3<f64>,
    /// How far points move, roughly.
    pub step: f64,
    pub free: Vec<Vector6<f64>>,
}

impl NormalEquations {
    /// Of turns about a centre; points are about `size` from it.
    pub fn about(centre: Point3<f64>, size: f64) -> Self {
        Self {
            centre,
            size,
            matrix: Matrix6::zeros(),
            side: Vector6::zeros(),
            weight: 0.0,
        }
    }

    /// How the distance of a point changes with the motion, if it grows in a direction.
    pub fn row(&self, place: &Point3<f64>, grows: &Vector3<f64>) -> Vector6<f64> {
        let turn = (place - self.centre).cross(grows) / self.size;
        Vector6::new(turn.x, turn.y, turn.z, grows.x, grows.y, grows.z)
    }

    pub fn add(&mut self, row: &Vector6<f64>, distance: f64, weight: f64) {
        self.matrix += row * row.transpose() * weight;
        self.side -= row * (distance * weight);
        self.weight += weight;
    }

    /// The motion with the least sum of squares, without any part along free motions.
    pub fn solve(&self) -> Solution {
        let eigen = SymmetricEigen::new(self.matrix / self.weight.max(f64::MIN_POSITIVE));
        let side = self.side / self.weight.max(f64::MIN_POSITIVE);
        let (mut step, mut free) = (Vector6::zeros(), Vec::new());
        for (k, value) in eigen.eigenvalues.iter().enumerate() {
            let along = eigen.eigenvectors.column(k).into_owned();
            if *value >= LEAST {
                step += along * (along.dot(&side) / value);
            } else {
                free.push(along);
            }
        }
        let turn = Rotation3::new(step.fixed_rows::<3>(0) / self.size);
        let shift = Translation3::from(step.fixed_rows::<3>(3).into_owned());
        let about = Translation3::from(self.centre.coords);
        Solution {
            motion: shift * about * Isometry3::from_parts(Translation3::identity(), turn.into()) * about.inverse(),
            step: step.norm(),
            free,
        }
    }

    /// Free motions in words: shifts first, then turns.
    pub fn words(&self, free: &[Vector6<f64>]) -> Vec<String> {
        let mut words = Vec::new();
        if free.is_empty() {
            return words;
        }
        // Combinations without a turn are shifts.
        let turns: Matrix3<f64> = free.iter().map(turn_of).map(|v| v * v.transpose()).sum();
        let turns = SymmetricEigen::new(turns);
        let all: Matrix6<f64> = free.iter().map(|v| v * v.transpose()).sum();
        let axes: Vec<Vector3<f64>> = (0..3)
            .filter(|k| turns.eigenvalues[*k] > SHARE)
            .map(|k| turns.eigenvectors.column(k).into_owned())
            .collect();
        let shifts = free.len() - axes.len().min(free.len());
        if shifts > 0 {
            // Of the motions without a turn: what is left of shifts after those that come with turns.
            let mut shift = all.fixed_view::<3, 3>(3, 3).into_owned();
            for axis in &axes {
                let with = with_turn(&all, axis);
                shift -= with * with.transpose();
            }
            let shift = SymmetricEigen::new(shift);
            let mut order = [0, 1, 2];
            order.sort_by(|a, b| shift.eigenvalues[*b].total_cmp(&shift.eigenvalues[*a]));
            let [first, _, last] = order.map(|k| shift.eigenvectors.column(k).into_owned());
            words.push(match shifts {
                1 => format!("a shift along {}", direction(&first)),
                2 => format!("shifts across {}", direction(&last)),
                _ => "any shift".to_owned(),
            });
        }
        for axis in &axes {
            // Of a turn about an axis beside the centre, the shift says where that is.
            let with = with_turn(&all, axis);
            let square = axis.dot(&turn_of_all(&all, axis));
            let off = if square > 0.0 {
                axis.cross(&(with / square.sqrt())) / square.sqrt() * self.size
            } else {
                Vector3::zeros()
            };
            let through = self.centre + off;
            words.push(format!(
                "a turn about {} through ({})",
                direction(axis),
                through.coords.iter().map(|c| short(*c)).collect::<Vec<_>>().join(", ")
            ));
        }
        words
    }
}

/// The least part of a motion that is a turn.
const SHARE: f64 = 1e-3;

fn turn_of(motion: &Vector6<f64>) -> Vector3<f64> {
    motion.fixed_rows::<3>(0).into_owned()
}

/// The turns of the motions that a matrix projects on, along an axis.
fn turn_of_all(all: &Matrix6<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
    all.fixed_view::<3, 3>(0, 0) * axis
}

/// The shift that comes with a turn about an axis, of a motion of length 1.
fn with_turn(all: &Matrix6<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
    let shift = all.fixed_view::<3, 3>(3, 0) * axis;
    let turn = axis.dot(&turn_of_all(all, axis));
    if turn > 0.0 { shift / turn.sqrt() } else { shift }
}

/// Numbers that people read.
fn short(value: f64) -> String {
    let rounded = (1e3 * value).round() / 1e3;
    format!("{}", rounded + 0.0)
}

/// A direction; of both ways the one whose largest coordinate is positive.
fn direction(v: &Vector3<f64>) -> String {
    let sign = v[v.iamax()].signum();
    let [x, y, z] = [0, 1, 2].map(|k| short(sign * v[k]));
    format!("({x}, {y}, {z})")
}
