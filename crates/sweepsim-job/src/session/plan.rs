//! What will be done: the request with everything read, found or guessed.

use super::check;
use crate::base::cache::{Digest, RunCache};
use crate::base::kind::Kind;
use crate::base::{JobError, check_room, folder_name, least_memory};
use crate::request::{Directions, Given, Input, ProgramOptions, Request, Task};
use crate::shards::PieceFile;
use crate::warnings;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};
use sweepsim_dexel::{Grid, Stock};
pub use sweepsim_formats::Guess;
use sweepsim_formats::{Draft, Job, Limits, Provided, draft_of};

/// A request that can be carried out: the job, what was found in a program, and what had to be guessed.
///
/// Nothing has been computed yet. [`Plan::run`] computes it.
#[derive(Debug)]
pub struct Plan {
    pub(crate) request: Request,
    pub(crate) job: Job,
    pub(crate) found: Vec<String>,
    pub(crate) guessed: Vec<Guess>,
    /// When the reading began, and how long it took.
    pub(crate) began: Instant,
    pub(crate) reading: Duration,
    /// What shards have computed of it.
    pub(crate) pieces: Option<Pieces>,
    /// What earlier runs have found.
    pub(crate) cache: Option<RunCache>,
}

/// The pieces of all shards of a run.
#[derive(Debug)]
pub(crate) struct Pieces {
    pub files: Vec<(PathBuf, PieceFile)>,
}

impl Request {
    /// Reads all that the request refers to, and checks that it can be carried out.
    ///
    /// # Errors
    /// [`JobError`]: a file with line and column, a field of the request, or too little memory for the dexels.
    pub fn plan(self) -> Result<Plan, JobError> {
        let began = Instant::now();
        self.check()?;
        // One reads, the other computes.
        let (cache, job) = thread::scope(|scope| {
            let cache = scope.spawn(|| known(&self));
            let job = read(&self);
            (cache.join().unwrap_or_else(|panic| resume_unwind(panic)), job)
        });
        let (mut job, found, mut guessed) = job?;
        let asked = match self.cell {
            Some(side) => Some(("cell", covering(&job.grid, side))),
            None => self.cells.map(|cells| ("cells", cells)),
        };
        if let Some((field, cells)) = asked {
            job.grid = Grid::new(job.grid.min(), job.grid.max(), cells)
                .map(|grid| grid.in_frame(*job.grid.frame()))
                .map_err(|error| JobError::request(field, error.to_string()))?;
            guessed.retain(|guess| guess.about != "grid");
        }
        job.tolerance = self.tolerance.unwrap_or(job.tolerance);
        if let Some([gouge, excess]) = self.limits {
            job.limits = Some(Limits::new(gouge, excess));
        }
        let plan = Plan {
            request: self,
            job,
            found,
            guessed,
            began,
            reading: began.elapsed(),
            pieces: None,
            cache,
        };
        if plan.request.task != Task::Section {
            plan.check_directions()?;
            if plan.request.frames.is_some() && plan.request.task == Task::Sweep {
                return Err(JobError::request("frames", "expected `simulate` or `verify`"));
            }
        }
        Ok(plan)
    }
}

/// What earlier runs of a request have found, if that is to be used.
fn known(request: &Request) -> Option<RunCache> {
    let folder = request.cache.as_ref()?;
    let name = request.input.name();
    // Of a text, its name: it is what changes.
    let named = Request {
        input: Input::File(name.to_owned()),
        given: Given::default(),
        ..request.clone()
    };
    let notation = serde_json::to_string(&named).unwrap_or_default();
    let key = Digest::of("request").bytes(notation.as_bytes()).key();
    let number = key[..8].iter().fold(0_u64, |all, byte| all << 8 | u64::from(*byte));
    let stem = name.file_stem().unwrap_or_default();
    let name = folder_name(&stem.to_string_lossy());
    Some(RunCache::open(folder, &format!("{}-{number:016x}", name.display())))
}

/// How many cells of nearly this side cover a grid. The grid itself refuses too many.
fn covering(grid: &Grid, side: f64) -> [usize; 2] {
    [0, 1].map(|k| {
        let across = (grid.max()[k] - grid.min()[k]) / side;
        across.round().clamp(1.0, 1e9) as usize
    })
}

/// The job of a request, and what was found and guessed if it was made for a program.
fn read(request: &Request) -> Result<(Job, Vec<String>, Vec<Guess>), JobError> {
    let options = &request.program;
    let given = Provided {
        text: None,
        tools: request.given.tools.clone(),
        bodies: request.given.bodies.clone(),
        within: options.dialect.within.clone(),
    };
    let mut is_job = false;
    let (mut job, found, guessed) = match &request.input {
        Input::File(file) => match Kind::of(file)? {
            Kind::Job => {
                is_job = true;
                refuse_options(options, &file.display().to_string())?;
                (Job::read_with(file, &given)?, Vec::new(), Vec::new())
            }
            Kind::Path => of_program(file, request, given)?,
            Kind::Tools if is_project(file) => of_program(file, request, given)?,
            Kind::Mesh | Kind::Dexels | Kind::Tools => {
                return Err(JobError::file(file, "expected a job (.ron) or a program (.nc .cls …)"));
            }
        },
        Input::Job { name, text } => {
            is_job = true;
            refuse_options(options, &name.display().to_string())?;
            (Job::parse_with(text, name, &given)?, Vec::new(), Vec::new())
        }
        Input::Program { name, text } => {
            let text = Some(text.clone());
            of_program(name, request, Provided { text, ..given })?
        }
    };
    let given = &request.given;
    if let Some(stock) = &given.stock {
        // A program has no grid of its own: it goes on with that of the program before.
        if let (Stock::Dexels(dexels), false) = (stock, is_job) {
            job.grid = *dexels.grid();
        }
        job.stock = stock.clone();
    }
    for setup in &mut job.setups {
        setup.fixtures.extend(given.fixtures.iter().cloned());
    }
    if let Some(mesh) = &given.target {
        let target = sweepsim_formats::Target::new("target".into(), mesh.clone(), Vec::new());
        job.target = Some(target);
    }
    Ok((job, found, guessed))
}

fn is_project(file: &Path) -> bool {
    file.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("camotics"))
}

/// A job says itself what options say of a program.
fn refuse_options(options: &ProgramOptions, job: &str) -> Result<(), JobError> {
    match options.first() {
        Some(field) => Err(JobError::request(
            field,
            format!("is for programs: {job} is a job, which says it itself"),
        )),
        None => Ok(()),
    }
}

fn of_program(file: &Path, request: &Request, given: Provided) -> Result<(Job, Vec<String>, Vec<Guess>), JobError> {
    let mut options = request.program.draft(file.parent().unwrap_or(Path::new("")));
    options.cells = request.cells;
    if let Some(corners) = request.given.stock.as_ref().and_then(|stock| stock.bounds()) {
        let [min, max] = corners;
        options.stock = sweepsim_formats::DraftStock::Block { min, max };
    }
    let draft: Draft = draft_of(file, &options, &given)?;
    let job = draft.job(&draft.program, &given)?;
    Ok((job, draft.found, draft.guessed))
}

impl Plan {
    /// The job as it will be run.
    #[must_use]
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// The request.
    #[must_use]
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// What was found in a program, its project or its tool library, in words.
    #[must_use]
    pub fn found(&self) -> &[String] {
        &self.found
    }

    /// What nobody says, and was guessed.
    #[must_use]
    pub fn guessed(&self) -> &[Guess] {
        &self.guessed
    }

    /// What is odd about the job although it can be run, in words.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        warnings::before(&self.job, self.request.task.uses())
    }

    /// The guesses, and the notes of the job and of the files that it refers to.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let file = self.request.input.name().display();
        let guessed = self.guessed.iter().map(|guess| format!("guessed: {guess}"));
        let own = self.job.notes.iter().map(|note| format!("{file}: {note}"));
        let paths = self.job.paths.iter();
        let of_paths = paths.flat_map(|path| path.notes.iter().map(|note| format!("{}: {note}", path.source)));
        guessed.chain(own).chain(of_paths).collect()
    }

    /// The least memory in bytes that the dexels along z take: runs take several times as much.
    #[must_use]
    pub fn memory(&self) -> u64 {
        least_memory(&self.job.grid)
    }

    /// Refuses a grid for whose dexels there is no room in memory; shards need less of it.
    ///
    /// # Errors
    /// [`JobError`] with both sizes, where the system tells how much memory is left.
    pub fn check_room(&self) -> Result<(), JobError> {
        let advice = match self.request.task {
            Task::Sweep => "",
            _ => ", or a run in parts (--shard)",
        };
        check_room(&self.job.grid, advice)
    }

    /// The directions that were asked for must be possible.
    fn check_directions(&self) -> Result<(), JobError> {
        let three = self.request.needs_three_axes();
        let asked = match (self.request.directions, three) {
            (Some(Directions::Z), Some((file, _))) => {
                let why = format!("{file} is made of dexels along x, y and z: expected --directions xyz");
                return Err(JobError::request("directions z", why));
            }
            (_, Some((_, asked))) => asked,
            (Some(Directions::Xyz), _) => "directions xyz",
            _ => return Ok(()),
        };
        check(&self.job).map_err(|what| JobError::request(asked, format!("expected {what}")))
    }
}
