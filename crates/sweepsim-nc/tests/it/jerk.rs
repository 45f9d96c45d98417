//! How long moves take on axes with a bounded jerk: by hand.

use sweepsim_nc::{Machine, ReadOptions, gcode};

use crate::accelerations::{mill, near, options, times};

/// X, Y and Z with 1000 mm/s² and these jerks.
fn jerky([x, y, z]: [f64; 3], more: &str) -> ReadOptions {
    let axis = |letter: char, jerk: f64| format!("(letter: '{letter}', acceleration: 1000, jerk: {jerk:?}{more})");
    options(&format!(
        "Machine(name: \"mill\", linear: [{}, {}, {}])",
        axis('X', x),
        axis('Y', y),
        axis('Z', z)
    ))
}

#[test]
fn from_rest_to_rest() {
    let even = jerky([2e4; 3], "");
    // 100 mm/s after 0.1 + 0.05 s and 7.5 mm, 85 mm at that speed.
    near(&times("G1 X100 F6000\n", &even), &[0.3 + 0.85]);
    // 20 mm/s after 2 √(20 / 20,000) s, before the acceleration is reached.
    near(&times("G1 X100 F1200\n", &even), &[5.0 + 2.0 * 1e-3_f64.sqrt()]);
    // 15 mm reach the acceleration, not the speed; 0.32 mm neither.
    near(&times("G1 X15 F60000\n", &even), &[0.3]);
    near(&times("G1 X0.32 F60000\n", &even), &[0.08]);
    // One move in several blocks, none of which the axes could start or end at rest as fast.
    let parts = times("G1 X2 F6000\nX4\nX9.7\nX96\nX100\n", &even);
    near(&[parts.iter().sum()], &[0.3 + 0.85]);
    // Exact stops: from rest to rest.
    near(&times("G61 G1 X15 F60000\nX15.32\n", &even), &[0.3, 0.08]);
}

#[test]
fn the_weakest_axis_bounds_the_path() {
    // Y has a share of 0.6 in the direction, X one of 0.8: 1000/0.8 mm/s², and Y's 6000/0.6 mm/s³.
    let uneven = jerky([2e4, 6e3, 1.0], "");
    let (a, jerk) = (1250.0_f64, 1e4_f64);
    let ramp = 100.0 / a + a / jerk;
    // 100 mm/s is not enough to reach 1250 mm/s²: a²/j is 156 mm/s.
    assert!(a * a / jerk > 100.0 && ramp > 2.0 * (100.0 / jerk).sqrt());
    near(
        &times("G1 X80 Y60 F6000\n", &uneven),
        &[1.0 + 2.0 * (100.0 / jerk).sqrt()],
    );
    // An axis that stands still bounds nothing.
    near(&times("G1 X100 F6000\n", &uneven), &[1.15]);
    // Rapids: each axis by itself, and the last to arrive counts. Y: 4 ∛(l / 2j).
    let rapid = |text: &str, more: &str| {
        let program = gcode::read(&format!("G21\nG0 X0 Y0 Z0\n{text}"), &jerky([2e4, 6e3, 1.0], more)).unwrap();
        program.times()[1].seconds.unwrap()
    };
    near(&[rapid("G0 X100 Y0.012\n", ", speed: 6000")], &[1.15]);
    near(&[rapid("G0 X0.32 Y0.012\n", ", speed: 6000")], &[0.08]);
    near(&[rapid("G0 X0.32 Y0.324\n", ", speed: 6000")], &[0.12]);
}

#[test]
fn corners_and_curves_are_between_stops_and_jumps() {
    let plain = mill([1000.0; 3], "");
    let sum = |text: &str, options: &ReadOptions| times(text, options).iter().sum::<f64>();
    for text in [
        "G1 X100 F6000\nY100\nX90\nX89.9 Y99.8\nX0\n",
        "G1 X10 F3000\nX100 F6000\nX101 F300\n",
        "G1 X50 F6000\nG3 X50 Y40 I0 J20\nG1 X0\n",
    ] {
        let mut last = f64::INFINITY;
        let without = sum(text, &plain);
        for jerk in [1e3, 1e4, 1e5, 1e6, 1e9] {
            let found = sum(text, &jerky([jerk; 3], ""));
            assert!(found >= without && found < last, "{text} {jerk} {found} {last}");
            last = found;
        }
        assert!(last < without * (1.0 + 1e-4), "{last} {without}");
        let stops = sum(&format!("G61 {text}"), &jerky([1e4; 3], ""));
        assert!(sum(text, &jerky([1e4; 3], "")) < stops);
    }
    // A turn of the table: 90 degrees at 10 degrees/s, which it reaches after 0.2 + 0.1 s.
    let table =
        "Machine(name: \"t\", table: [(letter: 'C', axis: (0, 0, 1), speed: 600, acceleration: 50, jerk: 500)])";
    let program = gcode::read("G21\nG0 X10 Y0 Z0 C0\nG0 C90\n", &options(table)).unwrap();
    near(
        &[program.times()[1..].iter().filter_map(|time| time.seconds).sum()],
        &[9.3],
    );
    for (wrong, message) in [
        (
            "acceleration: 9, jerk: 0",
            "the jerk of X is 0, but must be a positive number",
        ),
        ("jerk: 5", "the jerk of X is 5, but must be beside an acceleration"),
    ] {
        let error = Machine::read(&format!("Machine(name: \"\", linear: [(letter: 'X', {wrong})])"));
        assert_eq!(error.unwrap_err().to_string(), message);
    }
}
