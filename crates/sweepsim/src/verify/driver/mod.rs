//! A program in its order: runs of moves, one after the other.

mod checkpoints;
mod runs;
mod solids;

pub use checkpoints::{Checkpoints, TileNotes, TileState};
pub use runs::{RunOfMoves, runs_of};
pub(super) use solids::Solids;

use crate::error::SweepError;
use crate::sweep::heights::HeightMap;
use crate::sweep::{Options, STRETCH, UnresolvedDexel};
use crate::verify::finding::Finding;
use crate::verify::record::{Judgement, TileFinding, TileRecord};
use crate::verify::scene::{Scene, ToolPath, Verification, VerifyOptions};
use crate::verify::target::Target;
use rayon::prelude::*;
use runs::{before, runs, stretches};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_dexel::Dexels;
use sweepsim_solve::Monitor;

/// The state between two runs, on one grid or tile.
pub(in crate::verify) struct Work<'a> {
    pub(in crate::verify) remaining: Dexels,
    pub(in crate::verify) heights: HeightMap,
    /// The scene's own fixtures.
    own_fixtures: Option<&'a Dexels>,
    pub(in crate::verify) fixtures: Option<(&'a Dexels, HeightMap)>,
    pub(in crate::verify) target: Option<&'a Target>,
    /// Options of the sweeps; the path number is that of the present toolpath.
    pub(in crate::verify) options: Options,
    pub(in crate::verify) each_move: bool,
    pub(in crate::verify) monitor: &'a dyn Monitor,
    pub(in crate::verify) done: TileRecord,
    pub(in crate::verify) crossings: u64,
    pub(in crate::verify) unresolved: Vec<UnresolvedDexel>,
    /// How often something was removed.
    pub(in crate::verify) changes: u64,
}

/// Judges the moves of a program in their order, and removes what they cut.
///
/// Findings are passed to `receive` as they are found, sorted within each run of at most 256 moves; it may end the verification.
///
/// # Errors
/// Those of [`sweep`](fn@crate::sweep), and [`SweepError::Grid`] if target or fixtures are on other lines than the stock.
///
/// ```
/// use std::ops::ControlFlow;
/// use sweepsim::prelude::*;
/// use sweepsim::motion::Assembly;
/// use sweepsim::verify::{FindingKind, MoveState, Scene, ToolPath, VerifyOptions, verify};
///
/// let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [40, 40])?;
/// let stock = Stock::Block { min: [-10.0, -10.0, 0.0], max: [10.0, 10.0, 8.0] }.dexels(&grid)?;
/// let cutter = Assembly::new(Tool::flat(3.0, 20.0)?);
/// let at = |x: f64, z: f64| Pose::new([x, 0.0, z], [0.0, 0.0, 1.0]);
/// // Cuts a slot 3 deep, and returns by a rapid that is too low.
/// let path = Path::new(vec![at(-20.0, 5.0)?, at(20.0, 5.0)?, at(20.0, 4.0)?, at(-20.0, 4.0)?])?;
/// let states = [MoveState::FEED, MoveState::RAPID, MoveState::RAPID];
/// let program = [ToolPath::new(&cutter, &path).with_states(&states)];
/// let result = verify(Scene::new(stock), &program, &VerifyOptions::default(), &mut |_| ControlFlow::Continue(()), &())?;
/// assert_eq!(result.findings.len(), 1);
/// let rapid = &result.findings[0];
/// assert_eq!((rapid.kind, rapid.number), (FindingKind::Rapid, 2));
/// assert!((rapid.depth - 1.0).abs() < 1e-6);
/// // The cutter's rim first meets the last column of lines, a quarter of a millimetre inside the block's wall.
/// assert!((rapid.place[0] - 9.75).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify(
    scene: Scene,
    program: &[ToolPath],
    options: &VerifyOptions,
    receive: &mut dyn FnMut(&Finding) -> ControlFlow<()>,
    monitor: &dyn Monitor,
) -> Result<Verification, SweepError> {
    let mut works = [Work::new(scene, program, options, monitor)?];
    let mut seen = 0;
    drive(&mut works, program, options, (1, &()), &mut |works| {
        let work = &mut works[0];
        work.done.findings[seen..].sort_by(|a, b| {
            let key = |own: &TileFinding| (own.finding.number, own.finding.time, own.finding.kind);
            key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut found = work.done.findings[seen..].iter();
        let last = found.position(|own| receive(&own.finding).is_break());
        if let Some(last) = last {
            work.done.findings.truncate(seen + last + 1);
            return ControlFlow::Break(());
        }
        seen = work.done.findings.len();
        ControlFlow::Continue(())
    })?;
    let [work] = works;
    let tile = work.finish();
    let Judgement {
        findings,
        paths,
        moves,
        undecided,
        stopped,
    } = Judgement::of_tiles(&[tile.record]);
    Ok(Verification {
        remaining: tile.remaining,
        findings,
        paths,
        moves,
        crossings: tile.crossings,
        unresolved: tile.unresolved,
        undecided,
        stopped,
    })
}

/// What is found on a tile, and what remains of it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TileVerification {
    /// What remains of the stock on the tile.
    pub remaining: Dexels,
    /// What is found, to be joined with what other tiles find by [`Judgement::of_tiles`].
    pub record: TileRecord,
    /// Crossings found, but for those of the search within runs.
    pub crossings: u64,
    /// Dexels of sweeps that could not be certified, numbered in the whole grid. Those of fixtures are numbered in their grid.
    pub unresolved: Vec<UnresolvedDexel>,
}

/// Judges a program on some [tiles](sweepsim_dexel::Grid::tile) of a grid, each by itself; what is found on a tile depends on no other, unless the verification ends
/// [at the first finding](VerifyOptions::first). [`Judgement::of_tiles`] joins what is found.
///
/// # Errors
/// Those of [`verify`], and [`SweepError::Tiles`] if the scenes are not on tiles of one grid.
///
/// ```
/// use std::ops::ControlFlow;
/// use sweepsim::prelude::*;
/// use sweepsim::motion::Assembly;
/// use sweepsim::verify::{Judgement, MoveState, Scene, ToolPath, VerifyOptions, verify, verify_tiles};
///
/// let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [40, 40])?;
/// let stock = Stock::Block { min: [-10.0, -10.0, 0.0], max: [10.0, 10.0, 8.0] };
/// let cutter = Assembly::new(Tool::flat(3.0, 20.0)?);
/// let at = |x: f64, z: f64| Pose::new([x, 0.0, z], [0.0, 0.0, 1.0]);
/// let path = Path::new(vec![at(-20.0, 5.0)?, at(20.0, 5.0)?])?;
/// let program = [ToolPath::new(&cutter, &path).with_states(&[MoveState::RAPID])];
/// let options = VerifyOptions::default();
/// let mut records = Vec::new();
/// for tile in grid.tiles(20) {
///     let scene = Scene::new(stock.dexels(&tile)?);
///     records.extend(verify_tiles(vec![scene], &program, &options, &())?.into_iter().map(|tile| tile.record));
/// }
/// let joined = Judgement::of_tiles(&records);
/// let whole = verify(Scene::new(stock.dexels(&grid)?), &program, &options, &mut |_| ControlFlow::Continue(()), &())?;
/// let ([joined], [whole]) = (&joined.findings[..], &whole.findings[..]) else { panic!("one finding") };
/// assert_eq!((joined.kind, joined.number, joined.depth), (whole.kind, whole.number, whole.depth));
/// assert!((joined.volume - whole.volume).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify_tiles(
    scenes: Vec<Scene>,
    program: &[ToolPath],
    options: &VerifyOptions,
    monitor: &dyn Monitor,
) -> Result<Vec<TileVerification>, SweepError> {
    verify_tiles_from(scenes, program, options, &(), monitor)
}

/// The same, beginning where states of all tiles are [known](Checkpoints::start), and leaving others on the way. The result is the same to the bit.
///
/// # Errors
/// Those of [`verify_tiles`], and [`SweepError::Tiles`] if the states are not of these tiles.
pub fn verify_tiles_from(
    scenes: Vec<Scene>,
    program: &[ToolPath],
    options: &VerifyOptions,
    checkpoints: &dyn Checkpoints,
    monitor: &dyn Monitor,
) -> Result<Vec<TileVerification>, SweepError> {
    let mut wholes = scenes.iter().map(|scene| scene.stock.grid().whole());
    if let Some(first) = wholes.next()
        && wholes.any(|other| other != first)
    {
        return Err(SweepError::Tiles);
    }
    let works = scenes.into_par_iter().with_max_len(1);
    let works = works.map(|scene| Work::new(scene, program, options, monitor));
    let mut works = works.collect::<Result<Vec<_>, _>>()?;
    let step = if options.first { 1 } else { usize::MAX };
    drive(&mut works, program, options, (step, checkpoints), &mut |works| {
        if options.first && works.iter().any(|work| !work.done.findings.is_empty()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })?;
    Ok(works.into_iter().map(Work::finish).collect())
}

/// Judges all runs of a program, on tiles of one grid: `step` runs of a toolpath at a time, after which `after` may end it. Runs whose outcome is known are left out.
fn drive<'a>(
    works: &mut [Work<'a>],
    program: &[ToolPath<'a>],
    options: &VerifyOptions,
    (step, checkpoints): (usize, &dyn Checkpoints),
    after: &mut dyn FnMut(&mut [Work<'a>]) -> ControlFlow<()>,
) -> Result<(), SweepError> {
    let total = program.iter().map(|tool| tool.path.moves()).sum();
    let known = match checkpoints.start() {
        Some((known, states)) => {
            restore(works, states)?;
            known
        }
        None => 0,
    };
    // Moves and runs of the paths before.
    let (mut moves_before, mut runs_before) = (0, 0);
    for (number, toolpath) in program.iter().enumerate() {
        for work in works.iter_mut() {
            let path_number = u32::try_from(number).unwrap_or(u32::MAX);
            work.options = options.sweep.clone().path_number(path_number);
            work.set_fixtures(toolpath.fixtures);
        }
        let Some(first) = works.first() else { return Ok(()) };
        let (monitor, count) = (first.monitor, works.len());
        let mut runs = runs(toolpath);
        let last = options.until.filter(|(path, _)| *path == number);
        if let Some((_, last)) = last {
            runs.truncate(runs.partition_point(|run| run.start <= last).max(1));
        }
        let known = known.saturating_sub(runs_before).min(runs.len());
        let mut first = 0;
        let mut stop = ControlFlow::Continue(());
        for stretch in stretches(&runs, STRETCH / Solids::count(toolpath)) {
            let begin = first;
            first += stretch.len();
            let left = &stretch[known.saturating_sub(begin).min(stretch.len())..];
            let Some(moves) = left.first() else { continue };
            let moves = before(toolpath, stretch[0].start, moves.start)..stretch[stretch.len() - 1].end;
            // The same for all tiles: they see the extent of the whole grid.
            let solids = Solids::new(toolpath, moves, &works[0])?;
            let mut done = runs_before + first - left.len();
            for batch in left.chunks(step) {
                let judged = AtomicUsize::new(0);
                let tiles = works.par_iter_mut().enumerate().with_max_len(1);
                tiles.try_for_each(|(tile, work)| {
                    batch.iter().zip(done + 1..).try_for_each(|(moves, runs)| {
                        work.run(number, toolpath, &solids, moves.clone())?;
                        if checkpoints.wants(runs) {
                            work.keep(tile, runs, checkpoints);
                        }
                        let judged = judged.fetch_add(moves.len(), Ordering::Relaxed) + moves.len();
                        monitor.advance(moves_before + batch[0].start + judged / count, total);
                        Ok(())
                    })
                })?;
                done += batch.len();
                stop = after(works);
                if stop.is_break() {
                    break;
                }
            }
            if stop.is_break() {
                break;
            }
        }
        if stop.is_break() || last.is_some() {
            works.iter_mut().for_each(|work| work.done.stopped = true);
            break;
        }
        moves_before += toolpath.path.moves();
        runs_before += runs.len();
    }
    Ok(())
}

/// The states of all tiles after some runs.
fn restore(works: &mut [Work], states: Vec<TileState>) -> Result<(), SweepError> {
    let is_of = |(work, state): (&Work, &TileState)| work.remaining.grid() == state.remaining.grid();
    if works.len() != states.len() || !works.iter().zip(&states).all(is_of) {
        return Err(SweepError::Tiles);
    }
    works
        .par_iter_mut()
        .with_max_len(1)
        .zip(states)
        .for_each(|(work, state)| work.restore(state));
    Ok(())
}

impl<'a> Work<'a> {
    /// No material is higher.
    pub(in crate::verify) fn top(&self) -> f64 {
        let fixtures = self.fixtures.as_ref().map(|(_, heights)| heights.top());
        self.heights.top().max(fixtures.unwrap_or(f64::NEG_INFINITY))
    }

    fn new(
        scene: Scene<'a>,
        program: &[ToolPath<'a>],
        options: &VerifyOptions,
        monitor: &'a dyn Monitor,
    ) -> Result<Self, SweepError> {
        let grid = *scene.stock.grid();
        let other = |dexels: &Dexels| dexels.grid().frame() != grid.frame();
        let mut fixtures = program
            .iter()
            .filter_map(|toolpath| toolpath.fixtures)
            .chain(scene.fixtures);
        if fixtures.any(other) || scene.target.is_some_and(|t| *t.solid().grid() != grid) {
            return Err(SweepError::Grid);
        }
        Ok(Self {
            heights: HeightMap::new(&scene.stock),
            own_fixtures: scene.fixtures,
            fixtures: None,
            target: scene.target,
            options: options.sweep.clone(),
            each_move: options.each_move,
            monitor,
            done: TileRecord::new(program.len()),
            crossings: 0,
            unresolved: Vec::new(),
            changes: 0,
            remaining: scene.stock,
        })
    }

    fn finish(mut self) -> TileVerification {
        let [i, j] = self.remaining.grid().first();
        for open in &mut self.unresolved {
            (open.i, open.j) = (open.i + i, open.j + j);
        }
        self.unresolved.sort_by_key(|open| (open.i, open.j));
        self.unresolved.dedup_by_key(|open| (open.i, open.j));
        self.done.undecided.dedup();
        TileVerification {
            remaining: self.remaining,
            record: self.done,
            crossings: self.crossings,
            unresolved: self.unresolved,
        }
    }

    /// Those of a toolpath, or of the scene.
    fn set_fixtures(&mut self, fixtures: Option<&'a Dexels>) {
        let fixtures = fixtures.or(self.own_fixtures);
        let now = self.fixtures.as_ref().map(|(dexels, _)| std::ptr::from_ref(*dexels));
        if now != fixtures.map(std::ptr::from_ref) {
            self.fixtures = fixtures.map(|dexels| (dexels, HeightMap::new(dexels)));
        }
    }
}
