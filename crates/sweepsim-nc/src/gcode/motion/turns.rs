//! Dividing blocks in which the rotary axes turn far.

/// The largest turn of the tool axis between two poses, in degrees.
const WIDEST: f64 = 90.0;

/// The number of equal parts into which a turn from `from` to `to` (`[tilt, c]`, degrees) must be divided so that the tool axis turns
/// by at most 90° in each. A float, as the turn may be absurdly large.
pub(crate) fn parts(from: [f64; 2], to: [f64; 2]) -> f64 {
    let (low, high) = (from[0].min(to[0]), from[0].max(to[0]));
    // The largest |sin| of the tilt during the turn: 1 if it passes 90° + k·180°.
    let passes = ((high - 90.0) / 180.0).floor() >= ((low - 90.0) / 180.0).ceil();
    let slope = if passes {
        1.0
    } else {
        let sine = |tilt: f64| tilt.to_radians().sin().abs();
        sine(low).max(sine(high))
    };
    // An upper bound of the length of the axis's curve on the sphere.
    let way = (to[0] - from[0]).hypot((to[1] - from[1]) * slope);
    (way / WIDEST - 1e-9).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_turns_divide() {
        assert_eq!(parts([0.0, 0.0], [0.0, 360.0]), 1.0, "the tool axis is at rest");
        assert_eq!(parts([0.0, 0.0], [90.0, 0.0]), 1.0);
        assert_eq!(parts([-90.0, 0.0], [90.0, 0.0]), 2.0);
        assert_eq!(parts([90.0, 0.0], [90.0, 360.0]), 4.0);
        assert_eq!(parts([80.0, 0.0], [100.0, 360.0]), 5.0);
    }
}
