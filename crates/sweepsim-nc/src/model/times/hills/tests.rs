//! Courses of random paths against those without a bound of the jerk, and lines in parts.

use super::*;
use sweepsim_props::*;

fn stretch() -> impl Strategy<Value = Stretch> {
    let corner = prop_oneof![1 => Just(0.0), 4 => 0.0..1e4_f64, 9 => Just(f64::INFINITY)];
    let acceleration = prop_oneof![5 => Just(500.0), 5 => 10.0..4e3_f64, 1 => Just(f64::INFINITY)];
    let speed = prop_oneof![Just(80.0), 1.0..200.0_f64];
    (-3.0..2.0_f64, speed, corner, acceleration, 2.0..6.0_f64).prop_map(|(size, speed, corner, acceleration, jerk)| {
        let length = 10.0_f64.powf(size);
        Stretch {
            length,
            speed,
            corner,
            acceleration,
            jerk: 10.0_f64.powf(jerk),
            full: [length / speed, 0.0],
        }
    })
}

/// The squares of the speeds at the ends without a bound of the jerk.
fn squares(stretches: &[Stretch]) -> Vec<f64> {
    let mut squares = vec![0.0; stretches.len() + 1];
    for (k, stretch) in stretches.iter().enumerate().skip(1).rev() {
        let speed = stretches[k - 1].speed.min(stretch.speed);
        squares[k] = stretch.corner.min(speed * speed).min(squares[k + 1] + stretch.gain());
    }
    for (k, stretch) in stretches.iter().enumerate() {
        squares[k + 1] = squares[k + 1].min(squares[k] + stretch.gain());
    }
    squares
}

fn total(passed: &[Passed]) -> f64 {
    passed.iter().map(|passed| passed.seconds).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Nowhere faster than without a bound of the jerk, but as fast with a large one; faster than with a rest at each joint.
    #[test]
    fn the_course_is_below_that_without_a_bound(stretches in collection::vec(stretch(), 1..40)) {
        let squares = squares(&stretches);
        let found = passed(&stretches, &squares);
        prop_assert_eq!(found.len(), stretches.len());
        let mut times = [0.0; 2];
        for (k, (passed, stretch)) in found.iter().zip(&stretches).enumerate() {
            let ends = [squares[k], squares[k + 1]];
            prop_assert!(passed.start <= squares[k].sqrt() * (1.0 + 1e-9), "{k} {passed:?}");
            prop_assert!(passed.peak <= stretch.peak(ends) * (1.0 + 1e-9), "{k} {passed:?}");
            prop_assert!(passed.seconds >= stretch.length / passed.peak * (1.0 - 1e-6), "{k} {passed:?}");
            times[0] += passed.seconds;
            times[1] += stretch.seconds(ends);
        }
        prop_assert!(times[0] >= times[1] * (1.0 - 1e-9), "{times:?}");
        let rests = stretches.iter().map(|stretch| {
            let Stretch { acceleration, jerk, .. } = *stretch;
            Leg::new([0.0; 2], stretch.speed, stretch.length, [Limits { acceleration, jerk }; 2]).seconds()
        });
        prop_assert!(times[0] <= rests.sum::<f64>() * (1.0 + 1e-9));
        let hard: Vec<_> = stretches.iter().map(|stretch| Stretch { jerk: 1e18, ..*stretch }).collect();
        let hard = passed(&hard, &squares);
        for (k, (passed, stretch)) in hard.iter().zip(&stretches).enumerate() {
            prop_assert!(passed.peak <= stretch.peak([squares[k], squares[k + 1]]) * (1.0 + 1e-9), "{k} {passed:?}");
        }
        prop_assert!((total(&hard) - times[1]).abs() <= 1e-3 * times[1] + 1e-6, "{hard:?} {times:?}");
    }

    /// A line takes the same time in one stretch or in several, to the place on it.
    #[test]
    fn a_line_in_parts_is_a_line(whole in stretch(), shares in collection::vec(0.01..1.0_f64, 1..30)) {
        let sum: f64 = shares.iter().sum();
        let part = |share: &f64| Stretch { length: whole.length * share / sum, corner: f64::INFINITY, ..whole };
        let parts: Vec<_> = shares.iter().map(part).collect();
        let found = passed(&parts, &squares(&parts));
        let Stretch { acceleration, jerk, .. } = whole;
        let line = Leg::new([0.0; 2], whole.speed, whole.length, [Limits { acceleration, jerk }; 2]);
        let (mut way, mut time) = (0.0, 0.0);
        for (passed, part) in found.iter().zip(&parts) {
            (way, time) = (way + part.length, time + passed.seconds);
            let expected = if way < whole.length * (1.0 - 1e-9) { line.at(way).0 } else { line.seconds() };
            prop_assert!((time - expected).abs() <= 1e-6 * line.seconds(), "{time} {expected}");
        }
    }
}

/// A curve of many short chords whose speed rises with its radius: with an acceleration that joins would each let rise from 0 again, it would take far longer.
#[test]
fn legs_go_on_over_the_joints_of_chords() {
    let chord = |k: usize| {
        let speed = 20.0 + 0.1 * (k as f64);
        Stretch {
            length: 0.1,
            speed: 200.0,
            corner: speed * speed,
            acceleration: 400.0,
            jerk: 10_000.0,
            full: [0.0; 2],
        }
    };
    let chords: Vec<_> = (0..400).map(chord).collect();
    let squares = squares(&chords);
    let found = total(&passed(&chords, &squares));
    let pairs = chords.iter().zip(squares.windows(2));
    let without: f64 = pairs.map(|(chord, ends)| chord.seconds([ends[0], ends[1]])).sum();
    // Up to 60 mm/s: some 40 mm at 40 mm/s.
    assert!(without > 1.0 && without < 1.3, "{without}");
    assert!(found > without && found < 1.2 * without, "{found} {without}");
    let path = Path::new(&chords, &squares);
    let singles: Vec<_> = (0..400).map(|k| path.section(k..k + 1)).collect();
    let mut ends = path.speeds.clone();
    path.lower(&singles, &mut ends);
    let apart = seconds(&legs(&singles, &ends));
    assert!(apart > 1.2 * found, "{apart} {found}");
}
