//! Rotary axes and the directions that they give a tool.

use nalgebra::{Matrix3, Unit, Vector3};
use sweepsim_motion::{RotaryTable, Turning};

/// Directions that differ by less than this, in radians, count as equal.
pub(crate) const SAME_DIRECTION: f64 = 1e-12;

/// Sine and cosine of an angle in degrees, exact at multiples of 90°.
pub(crate) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quadrant = (turn / 90.0).round();
    let (s, c) = (turn - 90.0 * quadrant).to_radians().sin_cos();
    // `+ 0.0` turns -0 into 0.
    match quadrant as u8 % 4 {
        0 => (s, c),
        1 => (c, -s + 0.0),
        2 => (-s + 0.0, -c),
        _ => (-c, s),
    }
}

/// The right-handed turn by an angle in degrees about a unit vector; about coordinate axes with exact zeros and ones.
pub(crate) fn rotation(axis: &Unit<Vector3<f64>>, degrees: f64) -> Matrix3<f64> {
    let (s, c) = sin_cos_degrees(degrees);
    if let Some(k) = (0..3).find(|&k| axis[k].abs() == 1.0) {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let mut turn = Matrix3::identity();
        let s = s * axis[k];
        (turn[(i, i)], turn[(j, j)], turn[(i, j)], turn[(j, i)]) = (c, c, -s, s);
        return turn;
    }
    let k = axis.into_inner();
    Matrix3::identity() * c + k * k.transpose() * (1.0 - c) + k.cross_matrix() * s
}

/// The turn about coordinate axis 0, 1 or 2.
pub(crate) fn about(axis: usize, degrees: f64) -> Matrix3<f64> {
    rotation(
        &[Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()][axis],
        degrees,
    )
}

/// The angle between two vectors, accurate at both ends.
pub(crate) fn angle_between(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// The angle about `k` from `from` to `to`, seen along it.
fn angle_about(k: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    k.dot(&from.cross(to)).atan2(from.dot(to) - k.dot(from) * k.dot(to))
}

/// At most two rotary axes in their order from the part to the tool, each with the index of its letter among A, B, C. A positive angle
/// turns the tool relative to the part by the right-hand rule.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Rotaries(Vec<(usize, Unit<Vector3<f64>>)>);

/// The angles at which the tool points in a direction, in degrees.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Angles {
    /// One or two solutions, each within a turn from 0; letters without an axis are 0.
    pub solutions: Vec<[f64; 3]>,
    /// The letter whose angle is arbitrary: here the one that was given.
    pub free: Option<usize>,
}

impl Rotaries {
    pub fn new(axes: impl IntoIterator<Item = (usize, Unit<Vector3<f64>>)>) -> Self {
        Self(axes.into_iter().collect())
    }

    /// Two axes that turn about Z and about X or Y, as their letters' convention has it: `axis = Rz(C) Rx(A) z`, or `Ry(B)`.
    pub fn conventional(tilting: usize) -> Self {
        let tilt = [Vector3::x_axis(), Vector3::y_axis()][tilting];
        Self(vec![(2, Vector3::z_axis()), (tilting, tilt)])
    }

    /// Those of a table whose signs are LinuxCNC's.
    pub fn of_table(table: RotaryTable) -> Self {
        Self::conventional(match table {
            RotaryTable::Ac => 0,
            RotaryTable::Bc => 1,
        })
        .reversed()
    }

    /// The same axes turning the other way.
    pub fn reversed(self) -> Self {
        Self(self.0.into_iter().map(|(letter, axis)| (letter, -axis)).collect())
    }

    /// From tool to part coordinates.
    pub fn orientation(&self, abc: [f64; 3]) -> Matrix3<f64> {
        let turns = self.0.iter().map(|(letter, axis)| rotation(axis, abc[*letter]));
        turns.fold(Matrix3::identity(), |product, turn| product * turn)
    }

    /// The direction from the tip to the holder.
    pub fn axis(&self, abc: [f64; 3]) -> Vector3<f64> {
        self.0
            .iter()
            .rev()
            .fold(Vector3::z(), |v, (letter, axis)| rotation(axis, abc[*letter]) * v)
    }

    pub fn has(&self, letter: usize) -> bool {
        self.0.iter().any(|(own, _)| *own == letter)
    }

    /// The angles for a direction; `near` gives those that are arbitrary. The error is how far the direction is from one that these axes
    /// reach, in radians.
    pub fn angles(&self, direction: &Vector3<f64>, near: [f64; 3]) -> Result<Angles, f64> {
        let z = Vector3::z();
        let a = direction.normalize();
        let one = |abc: [f64; 3], free| Angles {
            solutions: vec![abc],
            free,
        };
        match self.0[..] {
            [] => match angle_between(&a, &z) {
                off if off <= REACHED => Ok(one([0.0; 3], None)),
                off => Err(off),
            },
            [(letter, k)] => {
                let off = (angle_between(&k, &a) - angle_between(&k, &z)).abs();
                if off > REACHED {
                    return Err(off);
                }
                let free = k.cross(&z).norm() <= SAME_DIRECTION;
                let mut abc = [0.0; 3];
                abc[letter] = if free {
                    near[letter]
                } else {
                    angle_about(&k, &z, &a).to_degrees()
                };
                Ok(one(abc, free.then_some(letter)))
            }
            [(first, k1), (second, k2), ..] => {
                // The spherical triangle of both axes and the tool: its sides are α = ∠(k1, k2), β = ∠(k2, z) and φ = ∠(k1, a), and Δ is
                // its angle at k2. Half-angle formulas, which lose no digits where solutions meet.
                let (alpha, beta, phi) = (angle_between(&k1, &k2), angle_between(&k2, &z), angle_between(&k1, &a));
                let (least, most) = (
                    (alpha - beta).abs(),
                    (alpha + beta).min(std::f64::consts::TAU - alpha - beta),
                );
                let off = (least - phi).max(phi - most);
                if off > REACHED {
                    return Err(off);
                }
                let half = |x: f64| (0.5 * x).sin();
                let sine = (half(phi - alpha + beta) * half(phi + alpha - beta)).max(0.0).sqrt();
                let cosine = (half(alpha + beta + phi) * half(alpha + beta - phi)).max(0.0).sqrt();
                let apex = 2.0 * sine.atan2(cosine);
                let base = angle_about(&k2, &z, &k1);
                let mut solutions = Vec::new();
                let mut free = None;
                for inner in [base + apex, base - apex] {
                    let mut abc = [0.0; 3];
                    abc[second] = inner.to_degrees();
                    let tool = rotation(&k2, abc[second]) * z;
                    if k1.cross(&tool).norm() <= SAME_DIRECTION {
                        abc[first] = near[first];
                        free = Some(first);
                    } else {
                        abc[first] = angle_about(&k1, &tool, &a).to_degrees();
                    }
                    solutions.push(abc);
                }
                // At the rim of what they reach, both solutions are one.
                if free.is_some() || sine == 0.0 || cosine == 0.0 {
                    solutions.truncate(1);
                }
                Ok(Angles { solutions, free })
            }
        }
    }

    /// How the tool turns while all angles change at constant speed, if [`Turning::Rotary`] can say it.
    pub fn turning(&self, from: [f64; 3], to: [f64; 3]) -> Option<Turning> {
        // The angles of a table that turns the tool by Rz(−C) R(−tilt).
        let mut c: Option<(usize, f64)> = None;
        let mut tilt: Option<(usize, f64)> = None;
        let mut table = RotaryTable::Ac;
        for &(letter, axis) in &self.0 {
            let along = (0..3).find(|&k| axis[k].abs() == 1.0)?;
            let sign = -axis[along];
            match along {
                2 if tilt.is_none() && c.is_none() => c = Some((letter, sign)),
                0 | 1 if tilt.is_none() => {
                    tilt = Some((letter, sign));
                    table = [RotaryTable::Ac, RotaryTable::Bc][along];
                }
                _ => return None,
            }
        }
        let pair = |abc: [f64; 3]| [tilt, c].map(|axis| axis.map_or(0.0, |(letter, sign)| sign * abc[letter]));
        Some(Turning::Rotary {
            table,
            from: pair(from),
            to: pair(to),
        })
    }

    /// How far the tool's axis turns while all angles change at constant speed, at most, in radians.
    pub fn travel_of_tool(&self, from: [f64; 3], to: [f64; 3]) -> f64 {
        let rate = |letter: usize| (to[letter] - from[letter]).abs().to_radians();
        let slope = |a: &Vector3<f64>, b: &Vector3<f64>| a.cross(b).norm();
        match self.0[..] {
            [] => 0.0,
            [(letter, k)] => rate(letter) * slope(&k, &Vector3::z()),
            [(first, k1), (second, k2), ..] => {
                let inner = rate(second) * slope(&k2, &Vector3::z());
                // The tool is this far from the first axis at most: as in the middle, and half of what the second turns it.
                let middle = rotation(&k2, 0.5 * (from[second] + to[second])) * Vector3::z();
                let away = angle_between(&k1, &middle);
                let (low, high) = (away - 0.5 * inner, away + 0.5 * inner);
                let quarter = std::f64::consts::FRAC_PI_2;
                let steepest = if low < quarter && high > quarter {
                    1.0
                } else {
                    low.sin().abs().max(high.sin().abs())
                };
                // Where the range covers a pole or more, the sine at its ends bounds nothing.
                let steepest = if low < 0.0 || high > 2.0 * quarter {
                    steepest.max(inner.min(1.0))
                } else {
                    steepest
                };
                (rate(first) * steepest).hypot(inner)
            }
        }
    }

    /// The sum of the turns of all axes between two positions, in radians: the tool turns by no more.
    pub fn travel(&self, from: [f64; 3], to: [f64; 3]) -> f64 {
        self.0
            .iter()
            .map(|(letter, _)| (to[*letter] - from[*letter]).abs().to_radians())
            .sum()
    }
}

/// Directions that are reached within this, in radians, count as reached.
const REACHED: f64 = 1e-10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conventions() {
        // Haas's page for a UMC: (sinB cosC, sinB sinC, cosB).
        let bc = Rotaries::conventional(1);
        let (b, c) = (30_f64.to_radians(), 70_f64.to_radians());
        let axis = bc.axis([0.0, 30.0, 70.0]);
        assert!((axis - Vector3::new(b.sin() * c.cos(), b.sin() * c.sin(), b.cos())).norm() < 1e-15);
        for table in [RotaryTable::Ac, RotaryTable::Bc] {
            let own = Rotaries::of_table(table);
            let abc = match table {
                RotaryTable::Ac => [30.0, 0.0, 70.0],
                RotaryTable::Bc => [0.0, 30.0, 70.0],
            };
            assert!((own.axis(abc) - Vector3::from(table.axis([30.0, 70.0]))).norm() < 1e-15);
            let Some(Turning::Rotary { table: found, from, .. }) = own.turning(abc, abc) else {
                panic!()
            };
            assert_eq!((found, from), (table, [30.0, 70.0]));
        }
    }

    #[test]
    fn turns_that_a_table_makes() {
        for axes in [
            vec![(2, Vector3::z_axis()), (0, -Vector3::x_axis())],
            vec![(2, -Vector3::z_axis()), (1, Vector3::y_axis())],
            vec![(1, -Vector3::y_axis())],
            vec![(2, Vector3::z_axis())],
        ] {
            let rotaries = Rotaries::new(axes);
            let abc = [20.0, -50.0, 130.0];
            let Some(Turning::Rotary { table, from, .. }) = rotaries.turning(abc, abc) else {
                panic!()
            };
            assert!((table.orientation(from) - rotaries.orientation(abc)).norm() < 1e-15);
        }
        let nutating = Unit::new_normalize(Vector3::new(0.0, 1.0, 1.0));
        let others = [
            vec![(2, Vector3::z_axis()), (1, nutating)],
            vec![(1, Vector3::y_axis()), (0, Vector3::x_axis())],
            vec![(0, Vector3::x_axis()), (2, Vector3::z_axis())],
        ];
        for axes in others {
            assert_eq!(Rotaries::new(axes).turning([0.0; 3], [0.0; 3]), None);
        }
    }
}
