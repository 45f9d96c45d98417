//! The dexels along z, and what is said of them.

use crate::base::JobError;
use crate::parts;
use crate::request::Task;
use crate::session::{Session, TriSolid, joined, phase, reported};
use crate::verify::{Aside, Certified, Verified, setups, verified};
use crate::warnings;
use sweepsim::verify::Target;
use sweepsim::{BoundaryOperator, Statistics, simulate, sweep_all};
use sweepsim_dexel::Dexels;
use sweepsim_formats::{JobPath, MoveSummary, Report, ReportedDexel};

/// What is left, or was swept.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "a run has one part")]
pub(super) enum Part {
    AlongZ(Dexels),
    Solid(TriSolid),
}

impl Part {
    /// Of dexels along z, and those along x and y, if they are known.
    pub fn new(along_z: Dexels, aside: Option<Aside>) -> Result<Self, JobError> {
        let Some(aside) = aside else {
            return Ok(Self::AlongZ(along_z));
        };
        let [along_x, along_y] = aside.sets;
        Ok(Self::Solid(TriSolid {
            solid: joined([along_x, along_y, along_z])?,
            uncertified: aside.uncertified,
        }))
    }
}

/// What was computed.
#[derive(Debug)]
pub(super) struct Computed {
    pub part: Part,
    /// Whether a program was followed to its first finding only, along z.
    pub stopped: bool,
    pub crossings: u64,
    pub repaired: usize,
    pub unresolved: Vec<ReportedDexel>,
    pub volume_removed: Option<f64>,
    /// The number of uncertified dexels along x and y, and of fixtures.
    pub uncertified: usize,
    /// The target that the result was compared with.
    pub target: Option<Target>,
    /// What each move does, if asked for.
    pub moves: Vec<MoveSummary>,
    /// What was proven, for a checker.
    pub certified: Option<Certified>,
}

impl Computed {
    fn new(dexels: Dexels, statistics: &Statistics) -> Self {
        Self {
            part: Part::AlongZ(dexels),
            stopped: false,
            crossings: statistics.crossings,
            repaired: statistics.repaired,
            unresolved: reported(&statistics.unresolved),
            volume_removed: None,
            uncertified: 0,
            target: None,
            moves: Vec::new(),
            certified: None,
        }
    }

    /// The dexels along z.
    pub fn dexels(&self) -> &Dexels {
        match &self.part {
            Part::AlongZ(dexels) => dexels,
            Part::Solid(own) => &own.solid.sets()[2],
        }
    }
}

impl TryFrom<Verified> for Computed {
    type Error = JobError;

    fn try_from(done: Verified) -> Result<Self, JobError> {
        Ok(Self {
            part: Part::new(done.remaining, done.aside)?,
            stopped: done.stopped,
            crossings: done.crossings,
            repaired: 0,
            unresolved: done.unresolved,
            volume_removed: Some(done.volume_removed),
            uncertified: done.uncertified,
            target: done.target,
            moves: done.moves,
            certified: done.certified,
        })
    }
}

/// Computes the dexels along z.
pub(super) fn compute(session: Session, report: &mut Report) -> Result<Computed, JobError> {
    let job = session.job;
    let cuts = session.cuts();
    let sweeping = session.request.sweep_options(job);
    let failed = |error| session.failed(error);
    match session.request.task {
        Task::Simulate => {
            session.phase("stock");
            let stock = phase(report, "stock", || job.stock.dexels(&job.grid));
            let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
            let before = stock.volume();
            session.phase("cut");
            let done = phase(report, "sweep", || simulate(stock, &cuts, &sweeping, session.monitor));
            let done = done.map_err(failed)?;
            Ok(Computed {
                volume_removed: Some(before - done.remaining.volume()),
                ..Computed::new(done.remaining, &done.statistics)
            })
        }
        Task::Verify => verified(session, report)?.try_into(),
        Task::Sweep | Task::Section => {
            session.phase("sweep");
            let done = phase(report, "sweep", || {
                sweep_all(&cuts, &job.grid, &sweeping, session.monitor)
            });
            let done = done.map_err(failed)?;
            Ok(Computed::new(done.volume, &done.statistics))
        }
    }
}

/// Describes the result in the report.
pub(super) fn describe(session: Session, done: &Computed, report: &mut Report) {
    let (job, request) = (session.job, session.request);
    report.job.clone_from(&job.name);
    report.method = request.sweeping.method.to_string();
    report.cells = job.grid.cells();
    report.moves = job.moves();
    report.rapid_moves = job.paths.iter().map(JobPath::rapid_moves).sum();
    report.crossings = done.crossings;
    report.dexels.covered = done.dexels().covered();
    report.dexels.repaired = done.repaired;
    report.dexels.unresolved.clone_from(&done.unresolved);
    report.volume_removed = done.volume_removed;
    report.volume = Some(done.dexels().volume());
    if let (Some(target), Some(shape)) = (&job.target, &done.target) {
        parts::name_faces(report, target, shape);
    }
    report.setups = report.setups.take().or_else(|| setups(job));
    report.notes.splice(0..0, session.plan.notes());
    report.warnings.splice(0..0, session.plan.warnings());
    if request.task != Task::Sweep {
        // Of a run that ended early it is not known what the later ones would remove.
        let paths = report.paths.as_ref().filter(|_| !done.stopped);
        let removed: Option<Vec<f64>> = paths.map(|paths| paths.iter().map(|path| path.removed).collect());
        let more = warnings::after(job, done.dexels(), report.volume_removed, removed.as_deref());
        report.warnings.extend(more);
    }
    if request.sweeping.boundary == BoundaryOperator::Paper {
        let note = "intervals were found by the paper's boundary operator, which fails where a sweep overlaps itself; nothing was audited";
        report.notes.push(note.to_owned());
    }
}
