//! Where `E` is said to be convex, against samples.

use super::super::axis_motion::sample_paths;
use super::*;
use std::cell::Cell;
use sweepsim_props::test_runner::TestRunner;
use sweepsim_props::*;

/// Whether `E` of a line over the disc, `share` of the span after its start, is said to be convex: then it is.
fn convex(
    motion: &AxisMotion,
    [radius, height]: [f64; 2],
    [from, to]: [f64; 2],
    (share, at): (f64, [f64; 2]),
) -> Result<bool, TestCaseError> {
    let ends = [motion.at(from), motion.at(to)];
    let ends = [&ends[0], &ends[1]];
    let placed = |t: f64| Placed::new(&motion.at(t), height);
    let middle = placed(from + share * (to - from));
    let line = [0, 1].map(|k| middle.centre[k] + radius * at[k]);
    if middle.arm(line).norm() > radius || !is_simple([radius, height], ends, &motion.bounds(ends)) {
        return Ok(false);
    }
    let value = |t: f64| placed(t).arm(line).norm_squared();
    let step = (to - from) / 200.0;
    for n in 1..200 {
        let t = from + step * f64::from(n);
        let [low, own, high] = [value(t - step), value(t), value(t + step)];
        prop_assert!(low + high - 2.0 * own > -1e-12, "{t} {low} {own} {high}");
    }
    Ok(true)
}

#[test]
fn convex_where_it_is_said() {
    let tried = [const { Cell::new(0) }; sample_paths::KINDS];
    let tip = || [-4.0..4.0_f64, -4.0..4.0, -4.0..4.0];
    let axis = || [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0];
    let cases = (
        0..sample_paths::KINDS,
        ([tip(), tip()], [axis(), axis()], 0.01..1.0_f64),
        ([0.2..3.0_f64, -2.0..8.0], [0.0..1.0_f64, 0.01..0.6]),
        (0.0..1.0_f64, [-1.0..1.0_f64, -1.0..1.0]),
    );
    let mut runner = TestRunner::new(ProptestConfig::with_cases(4096));
    let ran = runner.run(&cases, |(kind, (tips, axes, near), (circle, [from, length]), line)| {
        let last = [0, 1, 2].map(|k| axes[0][k] + near * (axes[1][k] - axes[0][k]));
        let path = sample_paths::path(kind, [(tips[0], axes[0]), (tips[1], last)]);
        for segment in path.iter().flat_map(|path| path.segments(0, 10.0, 1e-2)) {
            let Some(motion) = AxisMotion::new(&segment) else {
                continue;
            };
            let span = [from, (from + length).min(1.0)];
            tried[kind].set(tried[kind].get() + usize::from(convex(&motion, circle, span, line)?));
        }
        Ok(())
    });
    ran.unwrap_or_else(|error| panic!("{error}"));
    let tried = tried.map(Cell::into_inner);
    assert!(tried.iter().all(|tried| *tried > 5), "{tried:?}");
}
