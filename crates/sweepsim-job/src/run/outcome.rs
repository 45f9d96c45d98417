//! What a run found, and its outputs.

use super::compute::{Computed, Part, compute, describe};
use super::merge::gathered;
use super::{envelope, files};
use crate::base::cache::RunCache;
use crate::base::{Folder, JobError, Sink};
use crate::frames;
use crate::page::{self, PageSource};
use crate::parts;
use crate::request::{Output, Task};
use crate::session::{self, Plan, Session};
use crate::verify;
use std::path::{Path, PathBuf};
use sweepsim::{Method, Monitor};
use sweepsim_dexel::{Dexels, Mesh};
use sweepsim_formats::{MoveSummary, Report, ReportedFinding, Verdict, write_moves_csv};

/// What a run found: verdict and findings, the part, and what each tool did.
///
/// Meshes, pictures and the page are made when they are asked for, or written.
#[derive(Debug)]
pub struct Outcome {
    plan: Plan,
    report: Report,
    done: Computed,
}

/// What of a run was known from earlier ones.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Reused {
    /// The file that it is kept in.
    pub file: PathBuf,
    /// Moves that were judged again: the most along one direction of dexels, or beside fixtures.
    pub again: usize,
    /// All moves.
    pub moves: usize,
    /// What is wrong with the cache, if anything: it was then done without.
    pub notes: Vec<String>,
}

/// What was written.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Written {
    /// The report as in `report.json`, with what is said of the files.
    pub report: Report,
    /// Whether every dexel that an output is made of is certified.
    pub certified: bool,
}

impl Plan {
    /// Carries out the plan. Cancelling ends it soon.
    ///
    /// ```
    /// # let job = "Job(stock: Block(min: (0, 0, 0), max: (9, 9, 5)), tools: {1: Ball(radius: 2, length: 9)}, paths: [Path(tool: 1, poses: [((0, 4, 3), (0, 0, 1)), ((9, 4, 3), (0, 0, 1))])])";
    /// use std::sync::atomic::{AtomicBool, Ordering};
    /// use sweepsim_job::{JobError, Monitor, Request};
    ///
    /// /// Prints what is done, and ends when told to.
    /// struct Watch {
    ///     stop: AtomicBool,
    /// }
    ///
    /// impl Monitor for Watch {
    ///     fn phase(&self, name: &'static str) {
    ///         println!("{name}");
    ///     }
    ///     fn advance(&self, done: usize, total: usize) {
    ///         println!("{done} of {total}");
    ///     }
    ///     fn cancelled(&self) -> bool {
    ///         self.stop.load(Ordering::Relaxed)
    ///     }
    /// }
    ///
    /// let watch = Watch { stop: AtomicBool::new(false) };
    /// let plan = Request::from_job("slot.ron", job).cells([30, 30]).plan()?;
    /// let outcome = plan.run(&watch)?;
    /// assert!(outcome.report().volume_removed > Some(20.0));
    ///
    /// watch.stop.store(true, Ordering::Relaxed);
    /// let plan = Request::from_job("slot.ron", job).cells([30, 30]).plan()?;
    /// assert!(matches!(plan.run(&watch), Err(JobError::Cancelled)));
    /// # Ok::<(), JobError>(())
    /// ```
    ///
    /// # Errors
    /// [`JobError`]: too little memory, a stock or target that cannot be made, a sweep that fails, or
    /// [`JobError::Cancelled`].
    pub fn run(self, monitor: &dyn Monitor) -> Result<Outcome, JobError> {
        let outcome = self.computed(monitor)?;
        outcome.save();
        Ok(outcome)
    }

    /// [`run`](Self::run), then [`write_to`](Outcome::write_to) of all that the request wants: a
    /// [cache](crate::Request::cache) is written meanwhile.
    ///
    /// # Errors
    /// Those of both.
    pub fn run_to(self, sink: &mut dyn Sink, monitor: &dyn Monitor) -> Result<(Outcome, Written), JobError> {
        let outcome = self.computed(monitor)?;
        let written = outcome.write_to(sink, outcome.plan.request.wanted(), monitor);
        outcome.save();
        Ok((outcome, written?))
    }

    fn computed(mut self, monitor: &dyn Monitor) -> Result<Outcome, JobError> {
        self.check_room()?;
        let mut report = Report::default();
        report.seconds.insert("read".to_owned(), self.reading.as_secs_f64());
        let pieces = self.pieces.take();
        let session = Session::new(&self, monitor);
        let done = match pieces {
            Some(pieces) => gathered(session, pieces, &mut report)?,
            None => compute(session, &mut report)?,
        };
        describe(session, &done, &mut report);
        let plan = self;
        Ok(Outcome { plan, report, done })
    }
}

impl Outcome {
    /// Keeps what was found for later runs, if that has not been done yet.
    fn save(&self) {
        self.plan.cache.iter().for_each(RunCache::save);
    }

    /// The plan that was carried out.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The report: statistics by tool, regions of deviation, warnings and notes, but for those about outputs.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Whether the program may be run as it is; `None` if that was not the task.
    #[must_use]
    pub fn verdict(&self) -> Option<Verdict> {
        self.report.verdict
    }

    /// What of the run was known from earlier ones, if a [cache](crate::Request::cache) was asked for.
    #[must_use]
    pub fn reused(&self) -> Option<Reused> {
        let cache = self.plan.cache.as_ref()?;
        let [again, moves] = cache.moves().unwrap_or_default();
        Some(Reused {
            file: cache.file().to_owned(),
            again,
            moves,
            notes: cache.notes(),
        })
    }

    /// What is wrong with the program, in its order, each with file, line and text.
    #[must_use]
    pub fn findings(&self) -> &[ReportedFinding] {
        self.report.findings.as_deref().unwrap_or_default()
    }

    /// The part: what is left of the stock, or the swept volume; on the lines along z.
    #[must_use]
    pub fn part(&self) -> &Dexels {
        self.done.dexels()
    }

    /// What each move does, if the request asks for it or the program is short.
    #[must_use]
    pub fn moves(&self) -> &[MoveSummary] {
        &self.done.moves
    }

    /// Whether every dexel is certified: along z, and along all other lines that were judged.
    #[must_use]
    pub fn is_certified(&self) -> bool {
        self.done.unresolved.is_empty() && self.done.uncertified == 0
    }

    /// What was proven, as the text of `certificate.json`, for [`check`](crate::check). `None` if nothing was, or the
    /// request wants none or has no notation.
    ///
    /// # Errors
    /// [`JobError`]: a file of the request cannot be read any more.
    pub fn certificate(&self) -> Result<Option<String>, JobError> {
        verify::text(&self.plan, self.done.certified.as_ref())
    }

    /// The surface of the part, with sharp edges.
    ///
    /// # Errors
    /// [`JobError`]: the dexels along x and y cannot be made, or [`JobError::Cancelled`].
    pub fn mesh(&self, monitor: &dyn Monitor) -> Result<Mesh, JobError> {
        let (session, mut report) = (Session::new(&self.plan, monitor), self.report.clone());
        let solid = files::solid(session, &self.done, &mut report)?;
        files::mesh(solid.as_deref(), session, &self.done, &mut report)
    }

    /// Writes outputs to a folder, which is made if it does not exist.
    ///
    /// # Errors
    /// As [`Outcome::write_to`].
    pub fn write(&self, folder: &Path, outputs: &[Output]) -> Result<Written, JobError> {
        self.write_to(&mut Folder::create(folder)?, outputs, &())
    }

    /// Makes outputs and passes them to a sink, each as soon as it is made; frames and `moves.csv` if the request asks
    /// for them. The report comes last.
    ///
    /// # Errors
    /// [`JobError`]: the sink refuses an output, one cannot be made, or [`JobError::Cancelled`]. What the sink has
    /// taken by then is complete.
    pub fn write_to(
        &self,
        sink: &mut dyn Sink,
        outputs: &[Output],
        monitor: &dyn Monitor,
    ) -> Result<Written, JobError> {
        let (session, mut report) = (Session::new(&self.plan, monitor), self.report.clone());
        let (request, done) = (session.request, &self.done);
        let wants = |output| outputs.contains(&output);
        files::write_dexels(done, session, outputs, sink, &mut report)?;
        if request.judging.moves {
            sink.write("moves.csv", &mut |file| write_moves_csv(&done.moves, file))?;
        }
        let (mut picture, mut solid, mut mesh) = (None, None, None);
        let surface = wants(Output::Mesh) || wants(Output::Picture);
        // The page is not worth a simulation of its own.
        let shown = wants(Output::Report) && matches!(done.part, Part::Solid(_));
        if surface || shown || wants(Output::Tridexels) || wants(Output::Step) {
            solid = files::solid(session, done, &mut report)?;
        }
        if let (Some(own), true) = (&solid, wants(Output::Tridexels)) {
            files::write_tri(&own.solid, session, sink, &mut report)?;
        }
        if let (Some(own), true) = (&solid, wants(Output::Step)) {
            super::solid::write(&own.solid, session, sink, &mut report)?;
        }
        if surface || (wants(Output::Report) && solid.is_some()) {
            let made = files::mesh(solid.as_deref(), session, done, &mut report)?;
            picture = files::write_mesh(&made, session, outputs, sink, &mut report)?;
            mesh = wants(Output::Report).then_some(made);
        }
        let uncertified = solid.as_ref().map_or(0, |own| own.uncertified);
        let solid = solid.filter(|_| wants(Output::Report));
        let sharp = solid.as_ref().map(|own| &own.solid);
        if let (Some(target), true) = (&session.job.target, done.target.is_some() && wants(Output::Report)) {
            let found = session::phase(&mut report, "faces", || {
                parts::of_part(target, done.dexels(), sharp, session.job.tolerance)
            });
            report.faces = found.map_err(|error| session.failure(format!("target: {error}")))?;
        }
        if let Some(count) = request.frames {
            let stock = session::stock(session)?;
            frames::write(session, count, stock, sink, &mut report)?;
        }
        if request.task == Task::Sweep && request.sweeping.method == Method::Surface && wants(Output::Mesh) {
            envelope::write(session, sink, &mut report)?;
        }
        if wants(Output::Certificate) {
            match self.certificate()? {
                Some(text) => sink.write("certificate.json", &mut |file| file.write_all(text.as_bytes()))?,
                // That of an earlier run is none of this one.
                None => {
                    sink.remove("certificate.json");
                    if request.outputs.contains(&Output::Certificate) {
                        let why = "there is no certificate.json: nothing was decided that it could be about";
                        report.notes.push(why.to_owned());
                    }
                }
            }
        }
        if wants(Output::Report) {
            let source = PageSource {
                session,
                report: &report,
                dexels: done.dexels(),
                solid: sharp.zip(mesh.as_ref()),
                target: done.target.as_ref(),
                moves: &done.moves,
                threads: rayon::current_num_threads(),
                total: self.plan.began.elapsed().as_secs_f64(),
                picture: picture.as_deref(),
            };
            session.phase("page");
            let html = page::html(&source, || self.save())?;
            sink.write("report.html", &mut |file| file.write_all(html.as_bytes()))?;
            let text = json(&report)?;
            sink.write("report.json", &mut |file| file.write_all(text.as_bytes()))?;
        }
        self.save();
        let certified = self.is_certified() && uncertified == 0;
        Ok(Written { report, certified })
    }
}

/// A report as JSON.
fn json(report: &Report) -> Result<String, JobError> {
    let text = report.to_json();
    text.map_err(|error| JobError::run(format!("cannot make the report: {error}")))
}
