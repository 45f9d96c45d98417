//! Judges every dexel of a sweep by brute force.

use crate::brute_force::cases::Case;
use crate::brute_force::sample::times;
use rayon::prelude::*;
use std::sync::Mutex;
use sweepsim::{Method, Options, Sweep, sweep};
use sweepsim_dexel::{End, Grid, Interval, Source};
use sweepsim_motion::{Path, Pose, Profile, Tool};
use sweepsim_props::test_runner::{Config, RngSeed, TestCaseError, TestRunner};
use sweepsim_props::*;
use sweepsim_tests::oracle::{Depth, Motion, Outline, Sampling, Span, SweptLine, Verdict, compare, swept_line};

/// The default tolerance of a sweep.
pub const TOLERANCE: f64 = 1e-6;
/// The oracle's initial number of instants per move.
const DENSITY: usize = 300;

/// Counts of the cases seen, so that a test can check that it tested something.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Lines judged, and those that the tool touches.
    pub lines: usize,
    pub covered: usize,
    /// Lines with more than one interval.
    pub split: usize,
    /// Lines that differ only within the tolerance of the boundary.
    pub film: usize,
    /// Lines where the distance shows that the sweep is right and the sampling was not.
    pub better: usize,
    /// Ends whose normal was compared, and those more than 1.8° off.
    pub normals: usize,
    pub askew: usize,
    /// Dexels that the sweep had to repair.
    pub repaired: usize,
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.lines += other.lines;
        self.covered += other.covered;
        self.split += other.split;
        self.film += other.film;
        self.better += other.better;
        self.normals += other.normals;
        self.askew += other.askew;
        self.repaired += other.repaired;
    }
}

/// Draws `cases` random cases (times the factor of `cargo xtask brute-force`) and checks each.
pub fn for_all(
    cases: u32,
    strategy: impl Strategy<Value = Case>,
    check: impl Fn(&Case) -> Result<Tally, String>,
) -> Tally {
    let config = Config {
        cases: cases * times(),
        rng_seed: RngSeed::Fixed(0x5eed),
        failure_persistence: None,
        max_shrink_iters: 60,
        ..Config::default()
    };
    let total = Mutex::new(Tally::default());
    let checked = |case: Case| {
        let tally = check(&case).map_err(TestCaseError::fail)?;
        total.lock().expect("no panic while adding").add(&tally);
        Ok(())
    };
    if let Err(error) = TestRunner::new(config).run(&strategy, checked) {
        panic!("{error}");
    }
    let tally = *total.lock().expect("no panic while adding");
    println!("{tally:?}");
    tally
}

/// The sweep, which must leave nothing unresolved.
pub fn swept(case: &Case, poses: &[Pose], grid: &Grid, method: Method) -> Result<Sweep, String> {
    let path = Path::new(poses.to_vec()).map_err(|error| error.to_string())?;
    swept_along(&case.cutter.tool, &path, grid, method)
}

/// The sweep along any path, which must leave nothing unresolved.
pub fn swept_along(tool: &Tool, path: &Path, grid: &Grid, method: Method) -> Result<Sweep, String> {
    let options = Options::new(TOLERANCE).method(method);
    let sweep = sweep(tool, path, grid, &options, &()).map_err(|error| error.to_string())?;
    if let Some(unresolved) = sweep.statistics.unresolved.first() {
        return Err(format!(
            "{method}: {} unresolved, the first {unresolved:?}",
            sweep.statistics.unresolved.len()
        ));
    }
    Ok(sweep)
}

/// Sweeps the case by one method and judges all lines.
pub fn judge(case: &Case, method: Method) -> Result<Tally, String> {
    let grid = case.grid();
    let sweep = swept(case, &case.poses, &grid, method)?;
    let profile = case.cutter.tool.profile().expect("a solid of revolution");
    judge_sweep(&sweep, profile, &Motion::new(&case.poses), &grid, method)
}

/// Judges all lines of a sweep.
pub fn judge_sweep(
    sweep: &Sweep,
    profile: &Profile,
    motion: &Motion,
    grid: &Grid,
    method: Method,
) -> Result<Tally, String> {
    let outline = Outline::new(profile);
    let depth = Depth::new(&outline, motion);
    let judged: Result<Vec<Tally>, String> = (0..grid.len())
        .into_par_iter()
        .map(|index| {
            let (i, j) = grid.place(index);
            let place = [grid.x(i), grid.y(j)];
            let intervals = &sweep.volume.intervals(i, j).to_vec();
            let mut tally = judge_line(intervals, &outline, motion, place, DENSITY)
                .and_then(|tally| judge_ends(intervals, &depth, motion, place, (7 * i + 3 * j) % 11 == 0, tally))
                .map_err(|what| format!("{method}: dexel ({i}, {j}) at {place:?}: {what}"))?;
            tally.lines = 1;
            Ok(tally)
        })
        .collect();
    let mut total = Tally {
        repaired: sweep.statistics.repaired,
        ..Tally::default()
    };
    judged?.iter().for_each(|tally| total.add(tally));
    Ok(total)
}

fn ends(intervals: &[Interval]) -> Vec<[f64; 2]> {
    intervals
        .iter()
        .map(|interval| [interval.lower.z, interval.upper.z])
        .collect()
}

/// Judges the intervals of one line: their number and their ends.
fn judge_line(
    intervals: &[Interval],
    outline: &Outline,
    motion: &Motion,
    [x, y]: [f64; 2],
    density: usize,
) -> Result<Tally, String> {
    let found = ends(intervals);
    let ordered = found.iter().flatten().is_sorted_by(|a, b| a <= b);
    if !ordered || !found.iter().flatten().all(|z| z.is_finite()) {
        return Err(format!("the ends are not ascending: {found:?}"));
    }
    let line = swept_line(outline, motion, x, y, Sampling::number(density));
    let depth = Depth::new(outline, motion);
    let mut tally = Tally::default();
    match compare(&found, &line, &depth, [x, y], TOLERANCE) {
        Verdict::Same => {}
        Verdict::Film => tally.film += 1,
        // The sampling was too coarse here: once more, much finer, before it counts.
        Verdict::Better => {
            let line = swept_line(outline, motion, x, y, Sampling::number(20 * density));
            tally.better += usize::from(compare(&found, &line, &depth, [x, y], TOLERANCE) == Verdict::Better);
        }
        Verdict::Wrong(point) => {
            let expected: Vec<[f64; 2]> = line.spans.iter().map(|span| [span.low, span.high]).collect();
            return Err(format!(
                "found {found:?}, expected {expected:?}; at z = {} the signed distance is {:e}",
                point.z, point.distance
            ));
        }
    }
    // Whatever the sampling says: the middles of intervals are tool, the middles of gaps are air.
    let limit = TOLERANCE + 1e-8;
    for interval in &found {
        let z = 0.5 * (interval[0] + interval[1]);
        if depth.at([x, y, z]).distance > limit {
            return Err(format!("z = {z} in the middle of an interval is air: {found:?}"));
        }
    }
    for gap in found.windows(2) {
        let z = 0.5 * (gap[0][1] + gap[1][0]);
        if depth.at([x, y, z]).distance < -limit {
            return Err(format!("z = {z} in the middle of a gap is tool: {found:?}"));
        }
    }
    tally.covered = usize::from(!found.is_empty());
    tally.split = usize::from(found.len() > 1);
    Ok(tally)
}

/// Judges the data of the ends of one line: the source of each, and the normals of those on chosen lines.
fn judge_ends(
    intervals: &[Interval],
    depth: &Depth<'_>,
    motion: &Motion,
    [x, y]: [f64; 2],
    normals: bool,
    mut tally: Tally,
) -> Result<Tally, String> {
    for end in intervals.iter().flat_map(|interval| [&interval.lower, &interval.upper]) {
        judge_source(end, depth, motion, [x, y])?;
        let normal = end.normal.map(f64::from);
        let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        // Three components in f32 are each off by half a unit in the last place, 6e-8.
        if (length - 1.0).abs() > 1e-6 {
            return Err(format!("the normal {normal:?} at z = {} is no unit vector", end.z));
        }
        if !normals {
            continue;
        }
        // Just outside: there the distance grows along the normal also before a sharp edge.
        let step = 1e-5;
        let outside = [
            x + 3.0 * step * normal[0],
            y + 3.0 * step * normal[1],
            end.z + 3.0 * step * normal[2],
        ];
        if let Some(gradient) = depth.gradient(outside, step) {
            let cosine: f64 = gradient.iter().zip(normal).map(|(a, b)| a * b).sum();
            tally.normals += 1;
            tally.askew += usize::from(cosine < 0.9995);
        }
    }
    Ok(tally)
}

/// At the time that an end names as its source the tool's boundary must pass through it.
fn judge_source(end: &End, depth: &Depth<'_>, motion: &Motion, [x, y]: [f64; 2]) -> Result<(), String> {
    let source = end.source;
    let Source::Cut { path, segment, t } = source else {
        return Err(format!("no tool made the end at z = {}", end.z));
    };
    let (segment, t) = (segment as usize, f64::from(t));
    let arcs = motion.arcs().iter().filter(|arc| arc.segment == segment);
    let point = [x, y, end.z];
    let speed = arcs
        .map(|arc| arc.speed_bound(&point.into()) / (arc.time[1] - arc.time[0]))
        .fold(f64::NAN, f64::max);
    if path != 0 || speed.is_nan() || !(0.0..=1.0).contains(&t) {
        return Err(format!("the end at z = {} has no move: {source:?}", end.z));
    }
    // The time is an f32: half a unit in the last place is 6e-8 at most. The end itself is good to the tolerance.
    let limit = TOLERANCE + 1e-8 + 1.2e-7 * speed;
    let distance = depth.at_time(segment, t, point);
    if distance.abs() > limit {
        return Err(format!(
            "the end at z = {} is {distance:e} away from the tool at its source {source:?}",
            end.z
        ));
    }
    Ok(())
}

/// Two sweeps of the same volume must agree within both their tolerances; `case` says which volume.
pub fn same_volume(case: &Case, grid: &Grid, one: &Sweep, other: &Sweep) -> Result<Tally, String> {
    let profile = case.cutter.tool.profile().expect("a solid of revolution");
    same_sweeps(profile, &Motion::new(&case.poses), grid, one, other)
}

/// Gaps shorter than the tolerance may be extra: where a line is hardly beside a wall, an exit and an entry at a joint
/// that are one are as far apart along it.
fn without_short_gaps(intervals: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut joined: Vec<[f64; 2]> = Vec::with_capacity(intervals.len());
    for next in intervals {
        match joined.last_mut() {
            Some(last) if next[0] - last[1] < TOLERANCE => last[1] = next[1],
            _ => joined.push(next),
        }
    }
    joined
}

/// As [`same_volume`], for the volume of this outline along this motion.
pub fn same_sweeps(
    profile: &Profile,
    motion: &Motion,
    grid: &Grid,
    one: &Sweep,
    other: &Sweep,
) -> Result<Tally, String> {
    let outline = Outline::new(profile);
    let depth = Depth::new(&outline, motion);
    let mut tally = Tally::default();
    for index in 0..grid.len() {
        let (i, j) = grid.place(index);
        let place = [grid.x(i), grid.y(j)];
        let [a, b] = [one, other].map(|found| without_short_gaps(ends(&found.volume.intervals(i, j).to_vec())));
        let error = [TOLERANCE; 2];
        let spans = b.iter().map(|&[low, high]| Span { low, high, error }).collect();
        let line = SweptLine {
            spans,
            ambiguous: false,
        };
        tally.lines += 1;
        tally.covered += usize::from(!a.is_empty());
        tally.split += usize::from(a.len() > 1);
        match compare(&a, &line, &depth, place, TOLERANCE) {
            Verdict::Same => {}
            Verdict::Film => tally.film += 1,
            verdict => {
                return Err(format!("dexel ({i}, {j}) at {place:?}: {a:?} and {b:?}: {verdict:?}"));
            }
        }
    }
    Ok(tally)
}
