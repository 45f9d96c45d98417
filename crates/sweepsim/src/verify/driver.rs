//! A program in its order: runs of moves, one after the other.

use super::depth::{Side, greatest};
use super::finding::{Finding, FindingKind};
use super::heights::HeightMap;
use super::lines::Lines;
use super::scene::{PathRemoval, Scene, ToolPath, Verification, VerifyOptions};
use super::search::{Arena, Touch, Touching};
use super::solid::MovingSolid;
use super::target::Target;
use crate::error::SweepError;
use crate::sweep::{CHUNK, Options};
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};
use sweepsim_dexel::{Dexels, Grid, Interval};
use sweepsim_solve::Monitor;

/// The state between two runs.
pub(super) struct Work<'a> {
    pub(super) remaining: Dexels,
    pub(super) heights: HeightMap,
    fixtures: Option<(&'a Dexels, HeightMap)>,
    target: Option<&'a Target>,
    /// Options of the sweeps; the path number is that of the present toolpath.
    pub(super) options: Options,
    each_move: bool,
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
        let solids = Solids::new(toolpath, &work)?;
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
    bodies: Vec<MovingSolid<'a>>,
}

impl<'a> Solids<'a> {
    fn new(toolpath: &ToolPath<'a>, work: &Work) -> Result<Self, SweepError> {
        let mut grids = vec![work.remaining.grid()];
        grids.extend(work.fixtures.iter().map(|(dexels, _)| dexels.grid()));
        let solid = |tool| MovingSolid::new(tool, toolpath.path, &grids, &work.options);
        let bodies = toolpath.assembly.bodies().iter();
        Ok(Self {
            cutter: solid(toolpath.assembly.cutter())?,
            bodies: bodies.map(|body| solid(&body.solid)).collect::<Result<_, _>>()?,
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

    /// Judges a run of moves, then removes what it cuts.
    fn run(
        &mut self,
        path: usize,
        toolpath: &ToolPath,
        solids: &Solids,
        moves: Range<usize>,
    ) -> Result<(), SweepError> {
        self.judge_fixtures(path, solids, moves.clone())?;
        for (number, body) in solids.bodies.iter().enumerate() {
            let met = self.sweep_near_stock(body, moves.clone())?;
            let touching = Touching {
                probe: body,
                eater: Some(&solids.cutter),
                own: false,
                strict: true,
            };
            self.judge(path, FindingKind::Collision, Some(number), touching, moves.clone(), met)?;
        }
        let cut = self.sweep_near_stock(&solids.cutter, moves.clone())?;
        let cutting = |strict| Touching {
            probe: &solids.cutter,
            eater: Some(&solids.cutter),
            own: true,
            strict,
        };
        if let Some(kind) = toolpath.state(moves.start).forbids_cutting() {
            self.judge(path, kind, None, cutting(true), moves.clone(), cut.clone())?;
        }
        if let Some(target) = self.target {
            // Only where the target's core is, and where there still is material.
            let stock = Lines::of(&self.remaining, cut.iter().map(|(line, _)| *line));
            let core = Lines::of(target.core(), stock.numbers());
            let material = stock.intersection(&core, self.options.tolerance);
            let met = material.common(&cut, self.options.tolerance);
            let material = material.on_lines_of(&met);
            self.locate(path, FindingKind::Gouge, None, cutting(false), moves.clone(), &material)?;
        }
        if self.each_move {
            self.each_move(path, solids, moves, &cut)?;
        }
        self.remove(path, &cut);
        Ok(())
    }

    /// What a solid sweeps of the lines whose material it comes near.
    fn sweep_near_stock(
        &mut self,
        solid: &MovingSolid,
        moves: Range<usize>,
    ) -> Result<Vec<(u32, Vec<Interval>)>, SweepError> {
        let grid = *self.remaining.grid();
        let swept = solid.swept_near(moves, &grid, &self.heights, &self.options, self.monitor)?;
        self.done.unresolved.extend(swept.unresolved);
        self.done.crossings += swept.crossings;
        Ok(swept.lines)
    }

    fn judge_fixtures(&mut self, path: usize, solids: &Solids, moves: Range<usize>) -> Result<(), SweepError> {
        let Some((fixtures, heights)) = &self.fixtures else {
            return Ok(());
        };
        let fixtures = *fixtures;
        let grid = *fixtures.grid();
        let all =
            std::iter::once((None, &solids.cutter)).chain(solids.bodies.iter().enumerate().map(|(n, b)| (Some(n), b)));
        let mut met = Vec::new();
        for (body, solid) in all {
            let swept = solid.swept_near(moves.clone(), &grid, heights, &self.options, self.monitor)?;
            met.push((body, solid, swept));
        }
        for (body, probe, swept) in met {
            self.done.unresolved.extend(swept.unresolved);
            let material = Lines::of(fixtures, swept.lines.iter().map(|(line, _)| *line));
            let touched = material.common(&swept.lines, self.options.tolerance);
            let touching = Touching {
                probe,
                eater: None,
                own: false,
                strict: true,
            };
            let material = material.on_lines_of(&touched);
            self.locate_on(
                &grid,
                path,
                FindingKind::Fixture,
                body,
                touching,
                moves.clone(),
                &material,
            )?;
        }
        Ok(())
    }

    /// Looks for the moves in which what a run sweeps meets the stock.
    fn judge(
        &mut self,
        path: usize,
        kind: FindingKind,
        body: Option<usize>,
        touching: Touching,
        moves: Range<usize>,
        swept: Vec<(u32, Vec<Interval>)>,
    ) -> Result<(), SweepError> {
        let stock = Lines::of(&self.remaining, swept.iter().map(|(line, _)| *line));
        let material = stock.on_lines_of(&stock.common(&swept, self.options.tolerance));
        self.locate(path, kind, body, touching, moves, &material)
    }

    fn locate(
        &mut self,
        path: usize,
        kind: FindingKind,
        body: Option<usize>,
        touching: Touching,
        moves: Range<usize>,
        material: &Lines,
    ) -> Result<(), SweepError> {
        let grid = *self.remaining.grid();
        self.locate_on(&grid, path, kind, body, touching, moves, material)
    }

    /// Finds the moves that touch `material`, all there is on some lines.
    #[allow(clippy::too_many_arguments)]
    fn locate_on(
        &mut self,
        grid: &Grid,
        path: usize,
        kind: FindingKind,
        body: Option<usize>,
        touching: Touching,
        moves: Range<usize>,
        material: &Lines,
    ) -> Result<(), SweepError> {
        if material.is_empty() {
            return Ok(());
        }
        let mut arena = Arena::new(grid, &self.options, self.monitor);
        let mut suspects = Vec::new();
        arena.touches(touching, moves, material, &mut suspects)?;
        self.done.unresolved.extend(arena.unresolved);
        // Each on its own, in any order.
        let judged: Vec<_> = suspects
            .into_par_iter()
            .map(|suspect| {
                let mut arena = Arena::new(grid, &self.options, self.monitor);
                let touch = arena.judged(touching, suspect)?;
                Ok((touch, arena.unresolved, arena.undecided))
            })
            .collect::<Result<_, SweepError>>()?;
        let mut touches = Vec::with_capacity(judged.len());
        for (touch, unresolved, undecided) in judged {
            touches.extend(touch);
            self.done.unresolved.extend(unresolved);
            let undecided = undecided.into_iter().map(|number| (path, number));
            self.done.undecided.extend(undecided);
        }
        let found: Vec<Finding> = touches
            .par_iter()
            .map(|touch| self.finding(grid, path, kind, body, touch))
            .collect();
        self.done.findings.extend(found);
        Ok(())
    }

    fn finding(&self, grid: &Grid, path: usize, kind: FindingKind, body: Option<usize>, touch: &Touch) -> Finding {
        let [dx, dy] = grid.spacing();
        let (line, heights) = touch.first.longest().unwrap_or((0, [0.0; 2]));
        let (i, j) = grid.place(line as usize);
        let middle = 0.5 * (heights[0] + heights[1]);
        let depth = match (kind, self.target) {
            (FindingKind::Gouge, Some(target)) => greatest(&touch.all, grid, target.distance(), Side::Inside).0,
            _ => touch.all.longest().map_or(0.0, |(_, [lower, upper])| upper - lower),
        };
        Finding {
            kind,
            path,
            number: touch.number,
            body,
            time: touch.time,
            place: grid.frame().to_world([grid.x(i), grid.y(j), middle]),
            depth,
            volume: touch.all.length() * dx * dy,
        }
    }
}
