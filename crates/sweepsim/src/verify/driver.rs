//! A program in its order: runs of moves, one after the other.

use super::finding::Finding;
use super::scene::{PathRemoval, Scene, ToolPath, Verification, VerifyOptions};
use super::solid::MovingSolid;
use super::target::Target;
use crate::error::SweepError;
use crate::sweep::heights::HeightMap;
use crate::sweep::{CHUNK, Options};
use std::ops::{ControlFlow, Range};
use sweepsim_dexel::Dexels;
use sweepsim_motion::{Assembly, Path};
use sweepsim_solve::Monitor;

/// The state between two runs.
pub(super) struct Work<'a> {
    pub(super) remaining: Dexels,
    pub(super) heights: HeightMap,
    pub(super) fixtures: Option<(&'a Dexels, HeightMap)>,
    pub(super) target: Option<&'a Target>,
    /// Options of the sweeps; the path number is that of the present toolpath.
    pub(super) options: Options,
    pub(super) each_move: bool,
    pub(super) monitor: &'a dyn Monitor,
    pub(super) done: Verification,
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
    let grid = *scene.stock.grid();
    let other = |dexels: &Dexels| dexels.grid().frame() != grid.frame();
    let mut fixtures = program
        .iter()
        .filter_map(|toolpath| toolpath.fixtures)
        .chain(scene.fixtures);
    if fixtures.any(other) || scene.target.is_some_and(|t| *t.solid().grid() != grid) {
        return Err(SweepError::Grid);
    }
    let mut work = Work {
        heights: HeightMap::new(&scene.stock),
        fixtures: None,
        target: scene.target,
        options: options.sweep.clone(),
        each_move: options.each_move,
        monitor,
        done: Verification {
            remaining: Dexels::empty(grid),
            findings: Vec::new(),
            paths: vec![PathRemoval::default(); program.len()],
            moves: Vec::new(),
            crossings: 0,
            unresolved: Vec::new(),
            undecided: Vec::new(),
            stopped: false,
        },
        remaining: scene.stock,
    };
    let total = program.iter().map(|tool| tool.path.moves()).sum();
    let mut before = 0;
    for (number, toolpath) in program.iter().enumerate() {
        if work.done.stopped {
            break;
        }
        work.options = options
            .sweep
            .clone()
            .path_number(u32::try_from(number).unwrap_or(u32::MAX));
        work.set_fixtures(toolpath.fixtures.or(scene.fixtures));
        let solids = Solids::new(toolpath, toolpath.path, &work)?;
        for moves in runs(toolpath) {
            let seen = work.done.findings.len();
            work.run(number, toolpath, &solids, moves.clone())?;
            monitor.advance(before + moves.end, total);
            work.done.findings[seen..].sort_by(|a, b| {
                (a.number, a.time, a.kind)
                    .partial_cmp(&(b.number, b.time, b.kind))
                    .unwrap_or(std::cmp::Ordering::Equal)
            });
            let mut found = work.done.findings[seen..].iter();
            if let Some(last) = found.position(|finding| receive(finding).is_break()) {
                work.done.findings.truncate(seen + last + 1);
                work.done.stopped = true;
                break;
            }
        }
        before += toolpath.path.moves();
    }
    let Work {
        remaining, mut done, ..
    } = work;
    done.unresolved.sort_by_key(|open| (open.i, open.j));
    done.unresolved.dedup_by_key(|open| (open.i, open.j));
    done.undecided.dedup();
    Ok(Verification { remaining, ..done })
}

/// A cutter and its bodies, prepared.
pub(super) struct Solids<'a> {
    pub(super) cutter: MovingSolid<'a>,
    pub(super) bodies: Vec<MovingSolid<'a>>,
    /// The same taken larger, if they are.
    pub(super) larger: Option<Box<Self>>,
}

impl<'a> Solids<'a> {
    /// Along a path, which is the toolpath's or another course of one of its moves.
    pub(super) fn new(toolpath: &ToolPath<'a>, path: &Path, work: &Work) -> Result<Self, SweepError> {
        let mut grids = vec![work.remaining.grid()];
        grids.extend(work.fixtures.iter().map(|(dexels, _)| dexels.grid()));
        let solid = |tool| MovingSolid::new(tool, path, &grids, &work.options);
        let solids = |assembly: &'a Assembly| -> Result<Self, SweepError> {
            let bodies = assembly.bodies().iter();
            Ok(Self {
                cutter: solid(assembly.cutter())?,
                bodies: bodies.map(|body| solid(&body.solid)).collect::<Result<_, _>>()?,
                larger: None,
            })
        };
        let larger = toolpath.larger.map(solids).transpose()?;
        Ok(Self {
            larger: larger.map(Box::new),
            ..solids(toolpath.assembly)?
        })
    }

    /// The cutter, and the bodies by their numbers: each as it is looked for, and itself if that is a larger one.
    pub(super) fn probes(&self) -> impl Iterator<Item = (Option<usize>, &MovingSolid<'a>, Option<&MovingSolid<'a>>)> {
        let bodies = self.bodies.iter().enumerate();
        let own = std::iter::once((None, &self.cutter)).chain(bodies.map(|(n, body)| (Some(n), body)));
        own.map(|(number, itself)| {
            let larger = self.larger.as_ref().and_then(|larger| match number {
                None => Some(&larger.cutter),
                Some(n) => larger.bodies.get(n),
            });
            match larger {
                Some(larger) => (number, larger, Some(itself)),
                None => (number, itself, None),
            }
        })
    }
}

/// Runs of consecutive moves in one state, none longer than a chunk.
fn runs(toolpath: &ToolPath) -> Vec<Range<usize>> {
    // A path of one pose has no move, but its tool removes what it covers.
    let count = toolpath.path.moves().max(1);
    let mut runs: Vec<Range<usize>> = Vec::new();
    for number in 0..count {
        match runs.last_mut() {
            Some(run) if run.len() < CHUNK && toolpath.state(run.start) == toolpath.state(number) => run.end += 1,
            _ => runs.push(number..number + 1),
        }
    }
    runs
}

impl<'a> Work<'a> {
    fn set_fixtures(&mut self, fixtures: Option<&'a Dexels>) {
        let now = self.fixtures.as_ref().map(|(dexels, _)| std::ptr::from_ref(*dexels));
        if now != fixtures.map(std::ptr::from_ref) {
            self.fixtures = fixtures.map(|dexels| (dexels, HeightMap::new(dexels)));
        }
    }
}
