//! How long moves take on controls that average speeds, and rapids with an acceleration of their own: by hand.

use sweepsim_nc::{CORNER_DEVIATION, Machine, ReadOptions, gcode};

use crate::accelerations::{mill, near, options, times};

#[test]
fn speeds_that_are_averaged_take_longer_where_they_dip() {
    let [plain, smooth] = ["", "smoothing: 0.08"].map(|more| mill([1000.0; 3], more));
    // From rest to rest, once; whether in one block or in several.
    near(&times("G1 X100 F6000\n", &smooth), &[1.1 + 0.08]);
    near(&times("G1 X50 F6000\nX100\n", &smooth), &[0.55 + 0.08, 0.55]);
    // Up or down from one feed to another is no dip.
    let ramps = "G1 X100 F6000\nX200 F3000\nX300 F6000\n";
    let (without, with) = (times(ramps, &plain), times(ramps, &smooth));
    near(&with, &[without[0] + 0.08, without[1], without[2]]);
    // A corner is: the larger, the slower it is.
    let corner = "G1 X100 F6000\nX200 Y10\n";
    let (without, with) = (times(corner, &plain), times(corner, &smooth));
    let half = 0.5 * 0.1_f64.atan();
    let speed = (1000.0 * CORNER_DEVIATION * half.cos() / (1.0 - half.cos())).sqrt();
    // The axes share the acceleration towards the inside of the corner.
    let bent = with[1] - without[1];
    assert!((with[0] - without[0] - 0.08).abs() < 1e-12);
    assert!(
        (bent - 0.08 * (1.0 - speed / 100.0)).abs() < 1e-3 && bent > 0.005,
        "{bent} {speed}"
    );
    // A rapid is from rest to rest.
    let rapid = |options: &ReadOptions| {
        let program = gcode::read("G21\nG0 X0 Y0 Z0\nG0 X100\n", options).unwrap();
        program.times()[1].seconds.unwrap()
    };
    near(&[rapid(&smooth) - rapid(&plain)], &[0.08]);
    // With an acceleration of its own: 100 mm of X at 100 mm/s.
    let own = |more: &str| {
        options(&format!(
            "Machine(name: \"mill\", linear: [(letter: 'X', speed: 6000, acceleration: 1000{more})])"
        ))
    };
    near(&[rapid(&own(""))], &[1.1]);
    near(&[rapid(&own(", rapid_acceleration: 500"))], &[1.2]);
    near(&times("G1 X100 F6000\n", &own(", rapid_acceleration: 500")), &[1.1]);
    let wrong = Machine::read("Machine(name: \"\", linear: [(letter: 'X', rapid_acceleration: 0)])");
    assert!(wrong.unwrap_err().to_string().contains("the rapid_acceleration of X"));
    // Without accelerations there is nothing to average.
    let bare = options("Machine(name: \"mill\", linear: [(letter: 'X')], smoothing: 0.08)");
    near(&times("G1 X100 F6000\n", &bare), &[1.0]);
    for wrong in ["-0.1", "inf", "NaN"] {
        assert!(
            Machine::read(&format!("Machine(name: \"\", smoothing: {wrong})")).is_err(),
            "{wrong}"
        );
    }
}
