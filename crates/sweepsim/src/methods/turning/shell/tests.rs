//! What is said to be certain of a line during a span, and slopes and gradients, against samples.

use super::super::axis_motion::sample_paths;
use super::super::cylinder::Cylinder;
use super::super::disc::Disc;
use super::*;
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::Ball;
use std::cell::Cell;
use sweepsim_props::test_runner::TestRunner;
use sweepsim_props::*;

/// What is said of a line during a span, against samples of the span; whether it meets the piece at any of them.
fn agrees<S: Shell>(
    shell: &S,
    limits: &S::Limits,
    motion: &AxisMotion,
    [a, b]: [f64; 2],
    (line, sheets): ([f64; 2], &[usize]),
) -> Result<bool, TestCaseError> {
    let view = |t: f64| {
        let posed = shell.at(&motion.at(t));
        (t, posed, shell.meet(&posed, line))
    };
    let ([from, to], length) = ([view(a), view(b)], b - a);
    let samples: Vec<_> = (0..=200).map(|n| view(a + length * f64::from(n) / 200.0)).collect();
    let inside: Vec<bool> = samples
        .iter()
        .map(|(_, _, meeting)| meeting.half_chord_sq > 0.0)
        .collect();
    let passage = shell.passage(limits, [&from.2, &to.2], length);
    let changes = inside.windows(2).filter(|pair| pair[0] != pair[1]).count();
    match passage {
        Passage::Beside => prop_assert!(!inside.contains(&true)),
        Passage::Inside => prop_assert!(!inside.contains(&false)),
        Passage::Enters => prop_assert!(!inside[0] && inside[200] && changes == 1),
        Passage::Leaves => prop_assert!(inside[0] && !inside[200] && changes == 1),
        Passage::Through | Passage::Unknown => {}
    }
    let signs = shell.signs(limits, [&from.1, &to.1], line.map(|at| [at; 2]), length);
    let held = |posed: &S::Posed, meeting: &Meeting, sheet: usize| {
        let point = shell.point(posed, meeting, (sheet, 0.0, 0.0), 1e-14);
        certainly_within(point.along, shell.ends(), 1e-9) == Some(true)
    };
    let mut meets = false;
    for &sheet in sheets {
        let meets_now =
            |(_, posed, meeting): &(f64, S::Posed, Meeting)| meeting.half_chord_sq > 0.0 && held(posed, meeting, sheet);
        if !samples.iter().any(meets_now) {
            continue;
        }
        meets = true;
        let ends = [(&from.1, &from.2), (&to.1, &to.2)];
        let falls = shell.falls(limits, ends, length, sheet);
        let beyond = shell.is_beyond(limits, ends, sheet);
        let mut before: Option<f64> = None;
        for (t, posed, meeting) in &samples {
            if meeting.half_chord_sq <= 0.0 {
                before = None;
                continue;
            }
            let g = meeting.g[sheet];
            if held(posed, meeting, sheet) {
                prop_assert!(signs[sheet] != Sign::Absent && falls != Falls::Beyond && !beyond);
                prop_assert!(signs[sheet] != Sign::Positive || g > 0.0);
                prop_assert!(signs[sheet] != Sign::Negative || g < 0.0);
            }
            if passage == Passage::Inside && falls == Falls::Always {
                prop_assert!(!before.is_some_and(|before| before < 0.0 && g > 0.0), "rises at {t}");
            }
            if passage == Passage::Inside && falls == Falls::Never {
                prop_assert!(!before.is_some_and(|before| before > 0.0 && g < 0.0), "falls at {t}");
            }
            before = Some(g);
            // The slope along the line, of `g` and of the height.
            let h = 1e-6;
            let [low, high] = [view(t - h), view(t + h)];
            if low.2.half > 0.5 && high.2.half > 0.5 {
                let [slope, rise] = shell.slope(posed, meeting, sheet);
                let difference = (high.2.g[sheet] - low.2.g[sheet]) / (2.0 * h);
                prop_assert!(
                    (slope - difference).abs() <= 1e-4 * (1.0 + slope.abs()),
                    "{slope} {difference}"
                );
                let gradient = shell.gradient(posed, meeting, sheet);
                for k in 0..2 {
                    let aside = |h: f64| {
                        let mut other = line;
                        other[k] += h;
                        shell.meet(posed, other).g[sheet]
                    };
                    let difference = (aside(h) - aside(-h)) / (2.0 * h);
                    prop_assert!(
                        (gradient[k] - difference).abs() <= 1e-4 * (1.0 + difference.abs()),
                        "{gradient:?} {difference}"
                    );
                }
                let height = |(_, posed, meeting): &(f64, S::Posed, Meeting)| {
                    shell.point(posed, meeting, (sheet, 0.0, 0.0), 1e-14).height
                };
                let difference = (height(&high) - height(&low)) / (2.0 * h);
                prop_assert!(
                    (rise - difference).abs() <= 1e-4 * (1.0 + rise.abs()),
                    "{rise} {difference}"
                );
            }
        }
    }
    Ok(meets)
}

/// How many lines beside the tip meet a ball, a cylinder and a disc whose conditions hold along one span of a motion.
fn tried(motion: &AxisMotion, span: [f64; 2], up: bool, lines: &[[f64; 2]]) -> Result<[usize; 3], TestCaseError> {
    let moments = span.map(|t| motion.at(t));
    let ends = [&moments[0], &moments[1]];
    let bounds = motion.bounds(ends);
    let ball = Ball {
        centre: 2.0,
        radius: 2.0,
        ends: [f64::NEG_INFINITY, 0.3],
    };
    let cylinder = Cylinder {
        radius: 1.5,
        ends: [1.0, 9.0],
    };
    let disc = Disc {
        height: 1.0,
        radii: [0.0, 1.5],
        up: if up { 1.0 } else { -1.0 },
    };
    let [from, to] = moments;
    let accuracy = Accuracy {
        slack: 1e-14,
        height_tolerance: 1e-9,
    };
    let on_disc = disc.along(
        &Span {
            from,
            to,
            bounds,
            last: true,
        },
        accuracy,
        1.0,
    );
    let mut tried = [0; 3];
    for aside in lines {
        let line = [0, 1].map(|k| from.tip[k] + aside[k]);
        if let Some(limits) = ball.limits(ends, &bounds, 1e-14) {
            tried[0] += usize::from(agrees(&ball, &limits, motion, span, (line, &[0, 1]))?);
        }
        if let Some(limits) = cylinder.limits(ends, &bounds, 1e-14) {
            let meets = agrees(&cylinder, &limits, motion, span, (line, &[0, 1]))?;
            tried[1] += usize::from(meets && limits.pivot != Some([f64::NEG_INFINITY, f64::INFINITY]));
        }
        if let Ok((limits, _)) = &on_disc {
            tried[2] += usize::from(agrees(&disc, limits, motion, span, (line, &[usize::from(up)]))?);
        }
    }
    Ok(tried)
}

#[test]
fn what_is_certain_is_so() {
    let seen = [const { Cell::new([0; 3]) }; sample_paths::KINDS];
    let tip = || [-4.0..4.0_f64, -4.0..4.0, -4.0..4.0];
    let axis = || [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0];
    let cases = (
        (0..sample_paths::KINDS, any::<bool>()),
        ([tip(), tip()], [axis(), axis()], 0.01..1.0_f64),
        [0.0..1.0_f64, 0.01..0.6],
        collection::vec([-3.0..3.0_f64, -3.0..3.0], 1..8),
    );
    let mut runner = TestRunner::new(ProptestConfig::with_cases(4096));
    let ran = runner.run(&cases, |((kind, up), (tips, axes, near), [from, length], lines)| {
        let last = [0, 1, 2].map(|k| axes[0][k] + near * (axes[1][k] - axes[0][k]));
        let path = sample_paths::path(kind, [(tips[0], axes[0]), (tips[1], last)]);
        for segment in path.iter().flat_map(|path| path.segments(0, 10.0, 1e-2)) {
            let Some(motion) = AxisMotion::new(&segment) else {
                continue;
            };
            let tried = tried(&motion, [from, (from + length).min(1.0)], up, &lines)?;
            let all = seen[kind].get();
            seen[kind].set([0, 1, 2].map(|k| all[k] + tried[k]));
        }
        Ok(())
    });
    ran.unwrap_or_else(|error| panic!("{error}"));
    let seen = seen.map(Cell::into_inner);
    assert!(seen.iter().flatten().all(|tried| *tried > 0), "{seen:?}");
}
