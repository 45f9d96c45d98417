//! `verify`: what is wrong with a program, and how far its result is from the target.

mod asked;
mod axes;
mod certificate;
mod directions;
mod findings;
mod fixtures;
mod program;
mod proof;
mod scope;
pub(crate) mod targets;
mod texts;
mod work;

pub(crate) use certificate::text;
pub use certificate::{CheckedCertificate, CheckedStatement, check};
pub(crate) use directions::judges_solid;
pub(crate) use proof::Certified;
pub(crate) use work::setups;

use crate::base::{JobError, words};
use crate::request::Output;
use crate::session::{Session, phase, reported};
use crate::shards::{Gathered, Purpose, TilingSet};
use program::{JudgedProgram, JudgedTile, slivers};
use std::borrow::Cow;
use std::collections::BTreeMap;
use sweepsim::verify::{AreaShare, Deviations, Judgement, Look, Target, TileDeviation, deviations_along, joined};
use sweepsim_dexel::{Dexels, End, Grid, Source};
use sweepsim_formats::{MoveSummary, Report, ReportedDexel, Verdict};

/// Longer programs are judged move by move only if that is asked for: each move takes a sweep of its own.
const PLOTTED: usize = 1000;

/// What remains of the stock.
pub(crate) struct Verified {
    pub remaining: Dexels,
    /// Whether the program was followed to its first finding only.
    pub stopped: bool,
    /// The same along x and y, where the whole program was judged on the lines that a solid is made of.
    pub aside: Option<Aside>,
    pub crossings: u64,
    pub unresolved: Vec<ReportedDexel>,
    pub volume_removed: f64,
    /// The number of uncertified dexels along x and y, and of fixtures.
    pub uncertified: usize,
    pub target: Option<Target>,
    /// What each move does, if asked for.
    pub moves: Vec<MoveSummary>,
    /// What was proven, for a checker.
    pub certified: Option<Certified>,
}

/// What remains along x and y, and the number of uncertified dexels there.
pub(crate) struct Aside {
    pub sets: [Dexels; 2],
    pub uncertified: usize,
}

impl From<[Gathered; 2]> for Aside {
    fn from(looks: [Gathered; 2]) -> Self {
        Self {
            uncertified: looks.iter().map(|look| look.unresolved.len()).sum(),
            sets: looks.map(|look| look.dexels),
        }
    }
}

impl Aside {
    /// Drops what is thinner than the tolerance between two cuts. Moves that are swept together leave nothing there,
    /// but each run is swept by itself.
    fn drop_slivers(&mut self, tolerance: f64) {
        let is_cut = |end: End| end.source != Source::Stock;
        for set in &mut self.sets {
            slivers::drop_where(set, tolerance, |own| is_cut(own.lower) && is_cut(own.upper));
        }
    }
}

/// The tiles on which a program is judged: along z first, along x and y if asked for or if there are walls, then the
/// fixtures of each set-up as seen along each of these; and what is to be said of the directions.
pub(crate) fn sets(session: Session) -> Result<(Vec<TilingSet>, Option<String>), JobError> {
    let (job, request) = (session.job, session.request);
    let (judging, tile) = (&request.judging, request.sweeping.tile);
    // The page plots what each move does, where that costs little.
    let plotted = request.wants(Output::Report) && job.moves() <= PLOTTED;
    let each_move = judging.moves || plotted;
    let along_z = |share| Purpose::Judge {
        each_move,
        compare: directions::compared(session).then_some(share),
    };
    let whole = TilingSet::new("verify", job.grid, None, tile);
    let mut sets = vec![whole.to(along_z(AreaShare::Whole))];
    let aside = directions::aside(session, &sets[0])?;
    if let Some(grids) = &aside.grids {
        sets[0].purpose = along_z(AreaShare::OfThree);
        sets.extend(directions::sets(session, grids));
    }
    let grids: Vec<Grid> = sets.iter().map(|set| set.grid).collect();
    for grid in grids {
        for (number, setup) in job.setups.iter().enumerate() {
            let fixtures = fixtures::grid(session, &grid, &setup.fixtures)?;
            let set = fixtures.map(|grid| TilingSet::new("fixtures", grid, None, tile));
            sets.extend(set.map(|set| set.to(Purpose::Fixtures(number))));
        }
    }
    Ok((sets, aside.note))
}

/// Judges some tiles of a set, for a shard.
pub(crate) fn judged_tiles(session: Session, set: &TilingSet, tiles: &[usize]) -> Result<Vec<JudgedTile>, JobError> {
    JudgedProgram::new(session)?.judge(set, tiles, (None, None), None)
}

/// Verifies the job of a session, and describes the findings in the report.
pub(crate) fn verified(session: Session, report: &mut Report) -> Result<Verified, JobError> {
    let judging = &session.request.judging;
    let (sets, note) = sets(session)?;
    report.notes.extend(note);
    let program = JudgedProgram::new(session)?;
    let before = Before::new(session, report)?;
    let mut order: Vec<usize> = (0..sets.len()).collect();
    // The first finding ends it all: fixtures cost least.
    if judging.first {
        order.sort_by_key(|number| !matches!(sets[*number].purpose, Purpose::Fixtures(_)));
    }
    let mut until = None;
    let mut looks = BTreeMap::new();
    for number in order {
        let set = &sets[number];
        session.phase(set.name);
        let all: Vec<usize> = (0..set.tiles.len()).collect();
        let stock = Some(&before.stock).filter(|_| number == 0);
        let known = (stock, before.target.as_ref());
        let done = phase(report, "sweep", || program.judge(set, &all, known, until))?;
        if judging.first {
            let first = done.iter().filter_map(|(tile, _)| tile.record.first()).min();
            until = [until, first].into_iter().flatten().min();
        }
        looks.insert(number, joined_tiles(set, done)?);
    }
    before.concluded(session, &sets, looks.into_values().collect(), report)
}

/// The same of what shards have found on all tiles of these sets.
pub(crate) fn merged(
    session: Session,
    sets: &[TilingSet],
    looks: Vec<Gathered>,
    report: &mut Report,
) -> Result<Verified, JobError> {
    Before::new(session, report)?.concluded(session, sets, looks, report)
}

/// What the tiles of a set find together.
fn joined_tiles(set: &TilingSet, done: Vec<JudgedTile>) -> Result<Gathered, JobError> {
    let mut all = Gathered::empty(set);
    let mut remaining = Vec::with_capacity(done.len());
    for (tile, deviation) in done {
        all.deviations.extend(deviation);
        all.crossings += tile.crossings;
        all.unresolved.extend(reported(&tile.unresolved));
        all.records.push(tile.record);
        remaining.push(tile.remaining);
    }
    all.unresolved.sort_by_key(|dexel| (dexel.i, dexel.j));
    let wrong = |error| JobError::run(format!("the tiles do not make up the grid: {error}"));
    all.dexels = Dexels::from_tiles(set.grid, remaining).map_err(wrong)?;
    Ok(all)
}

/// The stock before the first move, and the target, on the lines along z.
struct Before {
    stock: Dexels,
    target: Option<Target>,
}

impl Before {
    fn new(session: Session, report: &mut Report) -> Result<Self, JobError> {
        let job = session.job;
        session.phase("stock");
        let stock = phase(report, "stock", || job.stock.dexels(&job.grid));
        let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
        session.phase("target");
        let target = phase(report, "target", || targets::of_job(session, &job.grid));
        let target = target.map_err(|error| session.failure(format!("target: {error}")))?;
        Ok(Self { stock, target })
    }

    /// Describes what was found in the report.
    fn concluded(
        self,
        session: Session,
        sets: &[TilingSet],
        looks: Vec<Gathered>,
        report: &mut Report,
    ) -> Result<Verified, JobError> {
        let Self { stock, target } = self;
        program::note_margins(session.job, &session.request.judging, report);
        let (mut done, mut findings, mut uncertified) = (Judgement::default(), Vec::new(), 0);
        for (number, look) in looks.iter().enumerate() {
            let mut own = Judgement::of_tiles(&look.records);
            findings.push(std::mem::take(&mut own.findings));
            if number == 0 {
                done = own;
                continue;
            }
            done.undecided.append(&mut own.undecided);
            done.stopped |= own.stopped;
            uncertified += look.unresolved.len();
        }
        done.findings = joined(findings);
        done.undecided.sort_unstable();
        done.undecided.dedup();
        if uncertified > 0 {
            let lines = words::counted(uncertified as u64, "dexel");
            report.notes.push(format!(
                "{lines} along x or y, or of fixtures, could not be certified: what touches there may be missing"
            ));
        }
        session.phase("deviation");
        let found = match &target {
            Some(target) if !done.stopped => {
                let differ = || deviating(session, (&stock, target), sets, &looks);
                Some(phase(report, "deviation", differ)?)
            }
            _ => None,
        };
        let distance = target.as_ref().map(Target::distance);
        let certified = findings::describe(report, session, &done, found.as_ref(), distance)?;
        proof::compare_registers(session, report)?;
        let mut scope = scope::scope(session, sets, done.stopped);
        scope.unmet = scope::unmet(session, &stock, sets)?;
        if scope.unmet.is_some() && report.verdict == Some(Verdict::Pass) {
            report.verdict = Some(Verdict::Undecided);
        }
        report.scope = Some(scope);
        axes::describe(report, session);
        let mut looks = looks.into_iter();
        let along_z = looks.next();
        let along_z = along_z.ok_or_else(|| JobError::run("nothing was judged"))?;
        let aside = match [looks.next(), looks.next()] {
            [Some(along_x), Some(along_y)] if !done.stopped && judges_solid(session, sets) => {
                let mut aside = Aside::from([along_x, along_y]);
                aside.drop_slivers(session.job.tolerance);
                Some(aside)
            }
            _ => None,
        };
        Ok(Verified {
            volume_removed: stock.volume() - along_z.dexels.volume(),
            moves: work::describe(report, session, &done),
            remaining: along_z.dexels,
            stopped: done.stopped,
            aside,
            crossings: along_z.crossings,
            unresolved: along_z.unresolved,
            uncertified,
            target,
            certified,
        })
    }
}

/// How the part differs from the target, on the lines along all directions on which it was compared. Known: the stock
/// and the target along z.
fn deviating(
    session: Session,
    (stock, target): (&Dexels, &Target),
    sets: &[TilingSet],
    looks: &[Gathered],
) -> Result<Deviations, JobError> {
    let job = session.job;
    let remaining: Vec<_> = looks
        .iter()
        .map(|look| slivers::without(&look.dexels, job.tolerance))
        .collect();
    let first = session.request.judging.first;
    let aside = sets.iter().zip(looks.iter().zip(&remaining)).skip(1);
    let aside = aside.filter(|(set, _)| match set.purpose {
        Purpose::Judge { compare, .. } => compare.is_some() || first,
        _ => false,
    });
    let known = |(set, (look, remaining)): (&TilingSet, (_, _))| {
        let stock = set.whole_stock(&job.stock);
        let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
        let target = targets::on(session, target, &set.grid);
        let target = target.map_err(|error| session.failure(format!("target: {error}")))?;
        Ok((stock, target, look, remaining))
    };
    let aside: Vec<(Dexels, Target, &Gathered, &Cow<Dexels>)> = aside.map(known).collect::<Result<_, JobError>>()?;
    let mut seen = vec![(stock, &looks[0], &remaining[0], target)];
    seen.extend(
        aside
            .iter()
            .map(|(stock, target, look, remaining)| (stock, *look, *remaining, target)),
    );
    // Where the first finding was looked for, nothing is known of them yet.
    let share = if seen.len() > 1 {
        AreaShare::OfThree
    } else {
        AreaShare::Whole
    };
    let own: Vec<Vec<TileDeviation>> = seen
        .iter()
        .map(
            |&(stock, look, remaining, target)| match first && look.deviations.is_empty() {
                true => vec![TileDeviation::new(stock, remaining, target, share)],
                false => Vec::new(),
            },
        )
        .collect();
    let all: Vec<Look> = seen
        .into_iter()
        .zip(&own)
        .map(|((stock, look, remaining, target), own)| Look {
            tiles: if own.is_empty() { &look.deviations } else { own },
            stock,
            remaining,
            target,
        })
        .collect();
    Ok(deviations_along(&all))
}
