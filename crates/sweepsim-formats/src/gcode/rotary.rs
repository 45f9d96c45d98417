//! From the angles of a rotary table to the tool's axis in the part's frame, and how a block divides when they turn far.

use std::str::FromStr;

/// Which rotary axes the machine's table has, and so what angles mean. With tip control the program's `xyz` is the tip
/// in the part's frame, and the axis from the tip to the holder is
///
/// | table | axis |
/// | --- | --- |
/// | `A/C` | `(sin C sin A, cos C sin A, cos A)` |
/// | `B/C` | `(−cos C sin B, sin C sin B, cos B)` |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotaryTable {
    /// Tilting about X, turning about Z.
    Ac,
    /// Tilting about Y, turning about Z.
    Bc,
}

impl FromStr for RotaryTable {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.to_ascii_lowercase().as_str() {
            "ac" => Ok(Self::Ac),
            "bc" => Ok(Self::Bc),
            _ => Err(format!("{text:?} is no rotary table: expected AC or BC")),
        }
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90°.
pub(crate) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quadrant = (turn / 90.0).round();
    let (s, c) = (turn - 90.0 * quadrant).to_radians().sin_cos();
    // `+ 0.0` makes -0 to 0.
    match quadrant as u8 % 4 {
        0 => (s, c),
        1 => (c, -s + 0.0),
        2 => (-s + 0.0, -c),
        _ => (-c, s),
    }
}

/// The axis at the angles `[tilt, c]`, in degrees.
pub(crate) fn axis(table: RotaryTable, [tilt, c]: [f64; 2]) -> [f64; 3] {
    let (sin_tilt, cos_tilt) = sin_cos_degrees(tilt);
    let (sin_c, cos_c) = sin_cos_degrees(c);
    match table {
        RotaryTable::Ac => [sin_c * sin_tilt, cos_c * sin_tilt, cos_tilt],
        RotaryTable::Bc => [-cos_c * sin_tilt + 0.0, sin_c * sin_tilt, cos_tilt],
    }
}

/// How far the axis may turn between two poses, in degrees.
const WIDEST: f64 = 90.0;

/// Into how many equal parts the turn from `from` to `to` (`[tilt, c]`, degrees) divides so that the axis turns by no
/// more than 90° in each. Not an integer type: the turn may be absurd.
pub(crate) fn parts(from: [f64; 2], to: [f64; 2]) -> f64 {
    let (low, high) = (from[0].min(to[0]), from[0].max(to[0]));
    // The largest |sin| of the tilt on the way: 1 when it passes 90° + k·180°.
    let passes = ((high - 90.0) / 180.0).floor() >= ((low - 90.0) / 180.0).ceil();
    let slope = if passes {
        1.0
    } else {
        let sine = |tilt: f64| sin_cos_degrees(tilt).0.abs();
        sine(low).max(sine(high))
    };
    // An upper bound of the way of the axis on the sphere.
    let way = (to[0] - from[0]).hypot((to[1] - from[1]) * slope);
    (way / WIDEST - 1e-9).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for k in -9..9 {
            let exact = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][i32::rem_euclid(k, 4) as usize];
            assert_eq!(sin_cos_degrees(90.0 * f64::from(k)), exact);
        }
        for degrees in [-719.5, -45.0, 1e-9, 30.0, 44.9, 45.1, 137.0, 225.0, 359.0] {
            let (s, c) = sin_cos_degrees(degrees);
            let (s1, c1) = f64::to_radians(degrees).sin_cos();
            assert!((s - s1).abs() < 1e-14 && (c - c1).abs() < 1e-14, "{degrees}");
        }
    }

    #[test]
    fn axes_of_the_two_tables() {
        assert_eq!(axis(RotaryTable::Ac, [90.0, 90.0]), [1.0, 0.0, 0.0]);
        assert_eq!(axis(RotaryTable::Ac, [-90.0, 0.0]), [0.0, -1.0, 0.0]);
        assert_eq!(axis(RotaryTable::Bc, [90.0, 0.0]), [-1.0, 0.0, 0.0]);
        assert_eq!(axis(RotaryTable::Bc, [90.0, 90.0]), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn wide_turns_divide() {
        assert_eq!(parts([0.0, 0.0], [0.0, 360.0]), 1.0, "the axis stands");
        assert_eq!(parts([0.0, 0.0], [90.0, 0.0]), 1.0);
        assert_eq!(parts([-90.0, 0.0], [90.0, 0.0]), 2.0);
        assert_eq!(parts([90.0, 0.0], [90.0, 360.0]), 4.0);
        assert_eq!(parts([80.0, 0.0], [100.0, 360.0]), 5.0);
    }
}
