use super::*;
use crate::methods::harvest::Harvest;
use crate::methods::lattice::Lattice;
use crate::methods::turning::axis_motion::sample_paths;
use std::cell::Cell;
use std::collections::BTreeMap;
use sweepsim_dexel::Grid;
use sweepsim_motion::Tool;
use sweepsim_props::test_runner::{Config, TestRunner};
use sweepsim_props::*;

const SAMPLES: u32 = 800;
/// So many kinds of moves go from one pose to another.
const JOINED: usize = 4;

/// How often a line is covered at the height of a ceiling, by samples; `None` where it is close.
fn sampled(ceiling: &LeaningCeiling, parts: &[PathPart], line: [f64; 2]) -> Option<i32> {
    let (mut count, mut before, mut closest) = (0, false, f64::INFINITY);
    for part in parts {
        let motion = motion(&part.segment).expect("a motion of this kind");
        for n in 0..=SAMPLES {
            let value = ceiling
                .section(motion.at(f64::from(n) / f64::from(SAMPLES)))
                .value(line);
            closest = closest.min(value.abs());
            count += i32::from(value < 0.0 && !before);
            before = value < 0.0;
        }
    }
    // Between samples, lines that are only touched stay in doubt.
    (closest > 1e-4).then_some(count)
}

type Place = [f64; 3];

/// Whether there was a ceiling, and on how many lines a count was compared that is not 0.
fn counted(
    ball: bool,
    (kind, tips): (usize, &[Place]),
    leans: &[[f64; 2]; 6],
    turns: bool,
) -> Result<(bool, usize), TestCaseError> {
    let tool = if ball {
        Tool::ball(1.5, 30.0)
    } else {
        Tool::flat(1.5, 30.0)
    }
    .expect("a tool");
    let outline = Outline::new(&tool).expect("a profile");
    let pose = |(n, tip): (usize, &Place)| {
        // Too much of a turn, and there is no ceiling.
        let turn = if turns { 0.3 } else { 0.0 };
        let [u, v] = [0, 1].map(|k| leans[0][k] + turn * (leans[n][k] - leans[0][k]));
        (*tip, [u, v, 1.0])
    };
    let poses: Vec<_> = tips.iter().enumerate().map(pose).collect();
    let moves = poses
        .windows(2)
        .filter_map(|pair| sample_paths::path(kind, [pair[0], pair[1]]));
    let segments = moves.flat_map(|path| path.segments(0, 31.5, 1e-3));
    let parts: Vec<PathPart> = segments.map(|segment| PathPart::new(segment, 0, [0.0, 1.0])).collect();
    if parts.is_empty() {
        return Ok((false, 0));
    }
    let Some(own) = LeaningCeiling::new(&outline, 31.5, &parts, 1.0) else {
        return Ok((false, 0));
    };
    prop_assert!(own.z > 1.0);
    let grid = Grid::new([-9.0; 2], [9.0; 2], [30, 30]).expect("a grid");
    let lattice = Lattice::all(&grid, [1e-9; 2]);
    let mut harvest = Harvest::default();
    let mut collector = Collector {
        lines: &lattice,
        harvest: &mut harvest,
    };
    let counts = own.counts(&parts, 1e-12, &mut collector).expect("some lines");
    counts.close(own.z, &mut collector);
    let mut found: BTreeMap<u32, i32> = BTreeMap::new();
    for (line, crossing) in &harvest.crossings {
        *found.entry(*line).or_default() -= i32::from(crossing.jump);
    }
    let mut covered = 0;
    for (i, j) in (0..30).flat_map(|i| (0..30).map(move |j| (i, j))) {
        let line = lattice.line(i, j) as u32;
        let place = [lattice.coordinate(0, i), lattice.coordinate(1, j)];
        if let Some(count) = sampled(&own, &parts, place) {
            prop_assert_eq!(found.get(&line).copied().unwrap_or(0), count, "{:?}", place);
            prop_assert!(harvest.open.iter().all(|(open, _)| *open != line));
            covered += usize::from(count > 0);
        }
    }
    Ok((true, covered))
}

/// Counts are those of samples, on leaning tools that turn or do not.
#[test]
fn counts_are_those_of_samples() {
    let seen = Cell::new([[0; 2]; 2 * JOINED]);
    let lean = || [-0.5..0.5_f64, -0.5..0.5];
    let cases = (
        (any::<bool>(), 0..JOINED),
        collection::vec([-3.0..3.0_f64, -3.0..3.0, -1.5..0.5], 2..6),
        [lean(), lean(), lean(), lean(), lean(), lean()],
        any::<bool>(),
    );
    run(512, &cases, |((ball, kind), tips, leans, turns)| {
        let (ceiling, covered) = counted(ball, (kind, &tips), &leans, turns)?;
        let mut all = seen.get();
        let of = 2 * kind + usize::from(turns);
        all[of][0] += usize::from(ceiling);
        all[of][1] += covered;
        seen.set(all);
        Ok(())
    });
    let seen = seen.get();
    assert!(
        // An arc without a turn is not solved here.
        (0..2 * JOINED).all(|of| of == 6 || seen[of][0] > 2 && seen[of][1] > 150),
        "{seen:?}"
    );
}

/// Whether it is said that `E` is convex for a line that is covered at some time: then it is, at all times.
fn convex(
    (ball, kind): (bool, usize),
    (tips, leans): ([Place; 2], [[f64; 2]; 2]),
    [from, length]: [f64; 2],
    at: Place,
) -> Result<bool, TestCaseError> {
    let pose = |n: usize| (tips[n], [leans[n][0], leans[n][1], 1.0]);
    let ceiling = LeaningCeiling {
        z: 6.0,
        radius: 1.5,
        centre: if ball { 1.5 } else { f64::NEG_INFINITY },
        highest: Vec::new(),
        spans: Vec::new(),
    };
    let mut is_tried = false;
    let path = sample_paths::path(kind, [pose(0), pose(1)]);
    for segment in path.iter().flat_map(|path| path.segments(0, 10.0, 1e-2)) {
        let Some(motion) = motion(&segment) else { continue };
        let ends = [motion.at(from), motion.at(from + length)];
        let ends = [&ends[0], &ends[1]];
        if !ceiling.is_convex(ends, &motion.bounds(ends)) {
            continue;
        }
        // A line about the axis at some time.
        let moment = motion.at(from + length * at[0]);
        let share = (ceiling.z - moment.tip.z) / moment.axis.z;
        let line = [0, 1].map(|k| moment.tip[k] + moment.axis[k] * share + 1.5 * at[k + 1]);
        if ceiling.section(moment).value(line) >= 0.0 {
            continue;
        }
        is_tried = true;
        let value = |t: f64| ceiling.section(motion.at(t)).value(line);
        for n in 1..200 {
            let (t, step) = (from + length * f64::from(n) / 200.0, length / 200.0);
            let [a, b, c] = [value(t - step), value(t), value(t + step)];
            prop_assert!(a + c - 2.0 * b > -1e-9, "{t} {a} {b} {c}");
            let slope = ceiling.section(motion.at(t)).slope(line);
            let near = (value(t + 1e-6) - value(t - 1e-6)) / 2e-6;
            prop_assert!((slope - near).abs() < 1e-4 * (1.0 + slope.abs()));
        }
    }
    Ok(is_tried)
}

#[test]
fn covered_once() {
    let tried = Cell::new([[0; 2]; sample_paths::KINDS]);
    let tip = || [-5.0..5.0_f64, -5.0..5.0, -2.0..2.0];
    let lean = || [-1.0..1.0_f64, -1.0..1.0];
    let cases = (
        (any::<bool>(), 0..sample_paths::KINDS),
        ([tip(), tip()], [lean(), lean()]),
        [0.0..0.9_f64, 0.01..0.2],
        [0.0..1.0_f64, -1.0..1.0, -1.0..1.0],
    );
    run(6000, &cases, |((ball, kind), poses, span, at)| {
        let mut all = tried.get();
        all[kind][usize::from(ball)] += usize::from(convex((ball, kind), poses, span, at)?);
        tried.set(all);
        Ok(())
    });
    let tried = tried.get();
    assert!(tried.iter().flatten().all(|tried| *tried > 5), "{tried:?}");
}

fn run<S: Strategy>(count: u32, strategy: &S, check: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        ..Config::with_cases(count)
    });
    let found = runner.run(strategy, check);
    found.unwrap_or_else(|error| panic!("{error}"));
}
