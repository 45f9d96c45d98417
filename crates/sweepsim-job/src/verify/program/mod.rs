//! A program as it is judged: its tools with their bodies, its moves with the state of the machine, and the tiles on
//! which they are judged.

mod kept;
mod runs;
pub(super) mod slivers;

use super::{fixtures, targets};
use crate::base::cache::{Digest, Key, RunCache};
use crate::base::{JobError, words};
use crate::request::Judging;
use crate::session::Session;
use crate::shards::{Purpose, TilingSet};
use kept::KeptStates;
use rayon::prelude::*;
use runs::RunKeys;
use std::collections::BTreeMap;
use sweepsim::motion::{Assembly, Tool};
use sweepsim::verify::{
    AreaShare, Checkpoints, MoveState, Scene, Target, TileDeviation, TileVerification, ToolPath, VerifyOptions,
    verify_tiles_from,
};
use sweepsim_dexel::{Dexels, StockError};
use sweepsim_formats::{Job, JobPath, Report};

/// What is found on a tile, and how what is left there differs from the target.
pub(crate) type JudgedTile = (TileVerification, Option<TileDeviation>);

/// The program of a job.
pub(super) struct JudgedProgram<'a> {
    session: Session<'a>,
    assemblies: BTreeMap<u32, Assembly>,
    /// As large as what must stay clear.
    larger: Option<BTreeMap<u32, Assembly>>,
    /// Of each path.
    states: Vec<Vec<MoveState>>,
    options: VerifyOptions,
}

impl<'a> JudgedProgram<'a> {
    pub fn new(session: Session<'a>) -> Result<Self, JobError> {
        let (job, judging) = (session.job, &session.request.judging);
        let margins = margins(job, judging);
        let larger = (margins != [0.0; 2]).then(|| assemblies(session, margins));
        Ok(Self {
            session,
            assemblies: assemblies(session, [0.0; 2])?,
            larger: larger.transpose()?,
            states: job.paths.iter().map(states).collect(),
            options: VerifyOptions::new(session.request.sweep_options(job)).first(judging.first),
        })
    }

    /// The toolpaths of one set-up, or all of them, and their numbers.
    fn toolpaths(&self, setup: Option<usize>) -> (Vec<usize>, Vec<ToolPath<'_>>) {
        let paths = self.session.job.paths.iter().enumerate();
        let own = paths.filter(|(_, path)| setup.is_none_or(|setup| path.setup == setup));
        let toolpath = |(number, path): (usize, &'a JobPath)| {
            let toolpath = ToolPath::new(&self.assemblies[&path.tool], &path.path)
                .with_states(&self.states[number])
                .with_other_courses(&path.other_courses);
            let toolpath = match &self.larger {
                Some(larger) => toolpath.with_larger(&larger[&path.tool]),
                None => toolpath,
            };
            (number, toolpath)
        };
        own.map(toolpath).unzip()
    }

    /// Judges the program on some tiles. `target`: the same on any other grid, if it is known; `stock`: on the whole
    /// grid, likewise. `until`: the last move that matters.
    pub fn judge(
        &self,
        set: &TilingSet,
        tiles: &[usize],
        (stock, target): (Option<&Dexels>, Option<&Target>),
        until: Option<(usize, usize)>,
    ) -> Result<Vec<JudgedTile>, JobError> {
        let job = self.session.job;
        let failed = |what: &'static str| move |error: &dyn std::fmt::Display| format!("{what}: {error}");
        let failure = |text: String| self.session.failure(text);
        let options = self.options.clone().until(until);
        match set.purpose {
            Purpose::Cut => Ok(Vec::new()),
            Purpose::Judge { each_move, compare } => {
                let on_tile = |tile: &usize| match stock {
                    Some(whole) => Ok(whole.tile(&set.tiles[*tile]).expect("a tile of the stock's grid")),
                    None => set.stock(&job.stock, *tile),
                };
                let stock = tiles
                    .par_iter()
                    .with_max_len(1)
                    .map(on_tile)
                    .collect::<Result<Vec<_>, _>>();
                let stock = stock.map_err(|error| failure(failed("stock")(&error)))?;
                let targets = self.targets(set, tiles, target)?;
                let scenes = stock.into_iter().zip(&targets);
                let scenes = scenes.map(|(stock, target)| match target {
                    Some(target) => Scene::new(stock).with_target(target),
                    None => Scene::new(stock),
                });
                let (_, toolpaths) = self.toolpaths(None);
                let options = options.each_move(each_move);
                let base = || self.base(set, &options);
                let done = self.judged(scenes.collect(), &toolpaths, &options, &base)?;
                // Computed again: to keep all of it would take twice the memory.
                let compared = |((tile, target), done): ((&usize, &Option<Target>), TileVerification)| {
                    let differs = |(target, share): (&Target, AreaShare)| {
                        let compared = || {
                            let before = on_tile(tile)?;
                            let remaining = slivers::without(&done.remaining, job.tolerance);
                            Ok::<_, StockError>(TileDeviation::new(&before, &remaining, target, share))
                        };
                        match self.session.cache() {
                            Some(cache) => known_deviation(cache, base(), &done.remaining, compared),
                            None => compared(),
                        }
                    };
                    let deviation = target.as_ref().zip(compare).map(differs).transpose()?;
                    Ok((done, deviation))
                };
                let tiles = tiles.par_iter().zip(&targets).zip(done).with_max_len(1);
                let done = tiles.map(compared).collect::<Result<_, StockError>>();
                done.map_err(|error| failure(failed("stock")(&error)))
            }
            Purpose::Fixtures(setup) => {
                let fixtures = tiles
                    .par_iter()
                    .map(|tile| fixtures::on(&set.tiles[*tile], &job.setups[setup].fixtures));
                let fixtures = fixtures.collect::<Result<Vec<_>, _>>();
                let fixtures = fixtures.map_err(|error| failure(failed("fixtures")(&error)))?;
                // Nothing is there but the fixtures.
                let scenes = fixtures
                    .iter()
                    .map(|own| Scene::new(Dexels::empty(*own.grid())).with_fixtures(own));
                let (numbers, toolpaths) = self.toolpaths(Some(setup));
                let base = || self.base(set, &options);
                let mut done = self.judged(scenes.collect(), &toolpaths, &options, &base)?;
                for tile in &mut done {
                    tile.record = std::mem::take(&mut tile.record).renumbered(&numbers, job.paths.len());
                }
                Ok(done.into_iter().map(|tile| (tile, None)).collect())
            }
        }
    }

    /// What is found on some tiles; as far as it is known, without looking again.
    fn judged(
        &self,
        scenes: Vec<Scene>,
        toolpaths: &[ToolPath],
        options: &VerifyOptions,
        base: &dyn Fn() -> Key,
    ) -> Result<Vec<TileVerification>, JobError> {
        let monitor = self.session.monitor;
        let keys;
        let kept = match self.session.cache() {
            Some(cache) => {
                keys = RunKeys::new(toolpaths);
                let tiles = scenes.iter().map(|scene| *scene.stock.grid()).collect();
                let kept = KeptStates::new(cache, base(), &keys, tiles);
                cache.judged(kept.again());
                Some(kept)
            }
            None => None,
        };
        let checkpoints: &dyn Checkpoints = match &kept {
            Some(kept) => kept,
            None => &(),
        };
        let done = verify_tiles_from(scenes, toolpaths, options, checkpoints, monitor);
        done.map_err(|error| self.session.failed(error))
    }

    /// What is found on the tiles of a set follows from this and from the toolpaths.
    fn base(&self, set: &TilingSet, options: &VerifyOptions) -> Key {
        let job = self.session.job;
        let own = Digest::of("tiles").value(&set.purpose).value(&set.grid).value(options);
        let own = match &set.within {
            Some(within) => own.stock(within),
            None => own.number(0),
        };
        match set.purpose {
            Purpose::Cut => own,
            Purpose::Judge { .. } => {
                let (stock, target) = self.session.digests();
                own.bytes(&stock).bytes(&target)
            }
            Purpose::Fixtures(setup) => {
                let fixtures = &job.setups[setup].fixtures;
                fixtures.iter().fold(own.number(fixtures.len()), Digest::stock)
            }
        }
        .key()
    }

    /// The target on some tiles.
    fn targets(
        &self,
        set: &TilingSet,
        tiles: &[usize],
        known: Option<&Target>,
    ) -> Result<Vec<Option<Target>>, JobError> {
        let job = self.session.job;
        let Some(first) = tiles.first().filter(|_| job.target.is_some()) else {
            return Ok(vec![None; tiles.len()]);
        };
        let made;
        let failed = |error| self.session.failure(format!("target: {error}"));
        let known = match known {
            Some(known) => Some(known),
            None => {
                made = targets::of_job(self.session, &set.tiles[*first]).map_err(failed)?;
                made.as_ref()
            }
        };
        let on = |tile: &usize| {
            let tile = &set.tiles[*tile];
            known
                .map(|known| {
                    known
                        .tile(tile)
                        .map_or_else(|| targets::on(self.session, known, tile), Ok)
                })
                .transpose()
        };
        tiles.par_iter().map(on).collect::<Result<_, _>>().map_err(failed)
    }
}

/// How a tile differs from the target, if it was compared before.
fn known_deviation(
    cache: &RunCache,
    base: Key,
    remaining: &Dexels,
    compared: impl FnOnce() -> Result<TileDeviation, StockError>,
) -> Result<TileDeviation, StockError> {
    let key = Digest::of("deviation").bytes(&base).value(remaining.grid());
    let key = key.bytes(&remaining.state()).key();
    let known = cache.get(&key).map(serde_json::from_slice);
    if let Some(Ok(known)) = known {
        return Ok(known);
    }
    if known.is_some() {
        cache.spoilt();
    }
    let found = compared()?;
    if let Ok(text) = serde_json::to_vec(&found) {
        cache.put(key, text);
    }
    Ok(found)
}

/// The cutters, each with its bodies, all round larger by these margins.
fn assemblies(session: Session, [cutter, body]: [f64; 2]) -> Result<BTreeMap<u32, Assembly>, JobError> {
    let job = session.job;
    let mut all = BTreeMap::new();
    for (number, tool) in &job.tools {
        let taken = |solid: &Tool, larger: f64, name: &str| {
            let taken = solid.offset(larger);
            taken.map_err(|error| session.failure(format!("{name} of tool {number}: {error}")))
        };
        let mut whole = Assembly::new(taken(tool, cutter, "the cutter")?);
        for own in job.bodies.get(number).into_iter().flatten() {
            whole = whole.with(own.kind, taken(&own.solid, body, "a body")?);
        }
        all.insert(*number, whole);
    }
    Ok(all)
}

/// By how much cutters beside material, and bodies, are taken larger.
fn margins(job: &Job, judging: &Judging) -> [f64; 2] {
    let [clearance, between] = reasons(job, judging);
    [between, clearance + between]
}

/// The clearance of bodies, and half the diagonal between dexels if they are to be looked between.
fn reasons(job: &Job, judging: &Judging) -> [f64; 2] {
    let [dx, dy] = job.grid.spacing();
    let between = if judging.sure { 0.5 * dx.hypot(dy) } else { 0.0 };
    [judging.clearance.unwrap_or(job.clearance), between]
}

/// Notes by how much cutters and bodies are taken larger, and why.
pub(super) fn note_margins(job: &Job, judging: &Judging, report: &mut Report) {
    let [clearance, between] = reasons(job, judging);
    let reasons = [
        (clearance, "for their clearance"),
        (between, "for what may hide between dexels"),
    ];
    let reasons = reasons.iter().filter(|(by, _)| *by > 0.0);
    let reasons: Vec<String> = reasons
        .map(|(by, why)| format!("{} mm {why}", words::length(*by)))
        .collect();
    if !reasons.is_empty() && !job.bodies.is_empty() {
        report.notes.push(format!(
            "shanks and holders are taken larger all round, by {}: findings say what touches and what only comes near",
            reasons.join(" and ")
        ));
    }
    if between > 0.0 {
        let between = words::length(between);
        report.notes.push(format!(
            "so are cutters in rapids and beside fixtures, by {between} mm; gouges are those on the dexels"
        ));
    }
}

fn states(path: &JobPath) -> Vec<MoveState> {
    let state = |(number, rapid): (usize, bool)| {
        let state = if rapid { MoveState::RAPID } else { MoveState::FEED };
        state
            .with_spindle_stopped(path.spindle_stopped.get(number))
            .with_no_feed(path.no_feed.get(number))
    };
    path.rapid.iter().enumerate().map(state).collect()
}
