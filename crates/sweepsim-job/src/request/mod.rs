//! What is asked for: a job or a program, and what to do with it.

mod by_name;
mod given;
mod options;
mod task;

pub(crate) use given::Given;
pub use given::Input;
pub use options::{DialectOptions, Judging, ProgramOptions, StockOption, SweepOptions, ViewOptions};
pub use task::{Directions, Output, Task};

use crate::base::JobError;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use sweepsim::Options;
use sweepsim_dexel::{Stock, TriangleSoup};
use sweepsim_formats::Job;
use sweepsim_motion::{Body, Tool};

/// A request: a job or a program, and what to do with it. [`Request::plan`] reads it.
///
/// It is plain data with a notation (serde) as far as it refers to files. Solids given in code have none: such a
/// request works in this process only.
///
/// ```
/// use sweepsim_job::{Output, Request, Task};
///
/// let request = Request::from_file("part.ron").task(Task::Simulate).cells([300, 200]).outputs([Output::Dexels]);
/// let text = serde_json::to_string(&request)?;
/// let same: Request = serde_json::from_str(&text)?;
/// assert_eq!(serde_json::to_string(&same)?, text);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    pub(crate) input: Input,
    pub(crate) task: Task,
    #[serde(default)]
    pub(crate) program: ProgramOptions,
    #[serde(default)]
    pub(crate) limits: Option<[f64; 2]>,
    #[serde(default)]
    pub(crate) outputs: Vec<Output>,
    #[serde(default)]
    pub(crate) sweeping: SweepOptions,
    #[serde(default)]
    pub(crate) cells: Option<[usize; 2]>,
    #[serde(default)]
    pub(crate) cell: Option<f64>,
    #[serde(default)]
    pub(crate) tolerance: Option<f64>,
    #[serde(default)]
    pub(crate) directions: Option<Directions>,
    #[serde(default)]
    pub(crate) decimate: Option<f64>,
    #[serde(default)]
    pub(crate) frames: Option<u16>,
    #[serde(default)]
    pub(crate) no_tool: bool,
    #[serde(default)]
    pub(crate) moments: Option<u16>,
    #[serde(default)]
    pub(crate) view: ViewOptions,
    #[serde(default)]
    pub(crate) judging: Judging,
    /// The folder of the cache: no result depends on it.
    #[serde(skip)]
    pub(crate) cache: Option<PathBuf>,
    #[serde(
        default,
        skip_deserializing,
        skip_serializing_if = "Given::is_empty",
        serialize_with = "Given::refuse"
    )]
    pub(crate) given: Given,
}

impl Request {
    fn new(input: Input) -> Self {
        Self {
            input,
            task: Task::Verify,
            program: ProgramOptions::default(),
            limits: None,
            outputs: Vec::new(),
            sweeping: SweepOptions::default(),
            cells: None,
            cell: None,
            tolerance: None,
            directions: None,
            decimate: None,
            frames: None,
            no_tool: false,
            moments: None,
            view: ViewOptions::default(),
            judging: Judging::default(),
            cache: None,
            given: Given::default(),
        }
    }

    /// To verify the job (`.ron`) or the program in a file.
    #[must_use]
    pub fn from_file(file: impl Into<PathBuf>) -> Self {
        Self::new(Input::File(file.into()))
    }

    /// To verify a program given as text. Its name tells its format, as the extension of a file does, and is what
    /// findings call it. The text is complete: programs that it calls are not looked for in files.
    #[must_use]
    pub fn from_program(name: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        let (name, text) = (name.into(), text.into());
        Self::new(Input::Program { name, text })
    }

    /// To verify a job given as text. Its name tells the folder of the files that it refers to.
    #[must_use]
    pub fn from_job(name: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        let (name, text) = (name.into(), text.into());
        Self::new(Input::Job { name, text })
    }

    /// What to do instead of verifying.
    #[must_use]
    pub fn task(self, task: Task) -> Self {
        Self { task, ..self }
    }

    /// What a job says, for a program: tool library, stock, target, and how it is read.
    #[must_use]
    pub fn program(self, program: ProgramOptions) -> Self {
        Self { program, ..self }
    }

    /// Gives the tool of a number.
    #[must_use]
    pub fn tool(mut self, number: u32, tool: Tool) -> Self {
        self.given.tools.insert(number, tool);
        self
    }

    /// Gives shank and holder of a tool that is given by [`Request::tool`], in the frame of the tool.
    #[must_use]
    pub fn bodies(mut self, number: u32, bodies: impl IntoIterator<Item = Body>) -> Self {
        self.given.bodies.insert(number, bodies.into_iter().collect());
        self
    }

    /// Gives the stock.
    #[must_use]
    pub fn stock(mut self, stock: Stock) -> Self {
        self.given.stock = Some(stock);
        self
    }

    /// Adds a fixture, in the coordinates of the part: nothing may touch it, in any set-up.
    #[must_use]
    pub fn fixture(mut self, fixture: Stock) -> Self {
        self.given.fixtures.push(fixture);
        self
    }

    /// Gives the design part, as a closed mesh.
    #[must_use]
    pub fn target(mut self, mesh: TriangleSoup) -> Self {
        self.given.target = Some(mesh);
        self
    }

    /// How deep gouges and how high remaining material may be, in millimetres.
    #[must_use]
    pub fn limits(self, gouge: f64, excess: f64) -> Self {
        let limits = Some([gouge, excess]);
        Self { limits, ..self }
    }

    /// What will be written; without this, [`Output::DEFAULT`]. The page's plots and what a certificate holds cost
    /// time: without a report or a certificate, they are not computed. See also [`Judging::certificate`].
    #[must_use]
    pub fn outputs(self, outputs: impl IntoIterator<Item = Output>) -> Self {
        let outputs = outputs.into_iter().collect();
        Self { outputs, ..self }
    }

    /// How crossings are found.
    #[must_use]
    pub fn sweeping(self, sweeping: SweepOptions) -> Self {
        Self { sweeping, ..self }
    }

    /// The number of dexels, instead of the job's.
    #[must_use]
    pub fn cells(self, cells: impl Into<Option<[usize; 2]>>) -> Self {
        let cells = cells.into();
        Self { cells, ..self }
    }

    /// The side of the cells in millimetres, or nearly so, instead of the job's: a whole number of them covers the
    /// grid.
    #[must_use]
    pub fn cell(self, side: impl Into<Option<f64>>) -> Self {
        let cell = side.into();
        Self { cell, ..self }
    }

    /// The tolerance of interval ends in millimetres, instead of the job's.
    #[must_use]
    pub fn tolerance(self, tolerance: impl Into<Option<f64>>) -> Self {
        let tolerance = tolerance.into();
        Self { tolerance, ..self }
    }

    /// The directions of the dexels that meshes and pictures are made of. If they are asked for, moves are judged along
    /// all of them.
    #[must_use]
    pub fn directions(self, directions: impl Into<Option<Directions>>) -> Self {
        let directions = directions.into();
        Self { directions, ..self }
    }

    /// Meshes of fewer triangles, nowhere further than this from the others, in millimetres.
    #[must_use]
    pub fn decimate(self, deviation: impl Into<Option<f64>>) -> Self {
        let decimate = deviation.into();
        Self { decimate, ..self }
    }

    /// So many pictures of the workpiece while it is cut, with or without the tool.
    #[must_use]
    pub fn frames(self, frames: impl Into<Option<u16>>, tool: bool) -> Self {
        let (frames, no_tool) = (frames.into(), !tool);
        Self {
            frames,
            no_tool,
            ..self
        }
    }

    /// The number of moments at which the page shows the workpiece.
    #[must_use]
    pub fn moments(self, moments: impl Into<Option<u16>>) -> Self {
        let moments = moments.into();
        Self { moments, ..self }
    }

    /// How pictures are drawn.
    #[must_use]
    pub fn view(self, view: ViewOptions) -> Self {
        Self { view, ..self }
    }

    /// What [`Task::Verify`] looks at.
    #[must_use]
    pub fn judging(self, judging: Judging) -> Self {
        Self { judging, ..self }
    }

    /// A folder where runs of [`Task::Verify`] keep what they find, so that the next run of the same request judges a
    /// changed program from the change on only. Results are the same to the byte; [`Outcome::reused`](crate::Outcome)
    /// tells what was judged again. The folder is no part of the notation.
    #[must_use]
    pub fn cache(self, folder: impl Into<Option<PathBuf>>) -> Self {
        let cache = folder.into();
        Self { cache, ..self }
    }

    /// The file of the job or the program, or its name.
    #[must_use]
    pub fn input(&self) -> &Input {
        &self.input
    }

    /// The task.
    #[must_use]
    pub fn asks_for(&self) -> Task {
        self.task
    }

    /// The outputs that are wanted.
    #[must_use]
    pub fn wanted(&self) -> &[Output] {
        match &self.outputs[..] {
            [] => &Output::DEFAULT,
            some => some,
        }
    }

    pub(crate) fn wants(&self, output: Output) -> bool {
        self.wanted().contains(&output)
    }

    /// Whether what is proven is recorded for a certificate.
    pub(crate) fn wants_certificate(&self) -> bool {
        self.judging.certificate || self.wants(Output::Certificate)
    }

    /// An output that needs dexels along x, y and z: its file, and what asks for it.
    pub(crate) fn needs_three_axes(&self) -> Option<(&'static str, &'static str)> {
        let asked = |output| self.outputs.contains(&output);
        if asked(Output::Tridexels) {
            return Some(("part.tridexels", "only tridexels"));
        }
        asked(Output::Step).then_some(("part.step", "only step"))
    }

    /// The files that it names, but for its input.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let mut request = self.clone();
        let machine = self.program.dialect.machine.as_ref().map(PathBuf::from);
        request
            .files_mut()
            .into_iter()
            .map(|file| file.clone())
            .chain(machine)
            .collect()
    }

    fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        let program = &mut self.program;
        let mut files: Vec<&mut PathBuf> = program.tools.iter_mut().chain(&mut program.target).collect();
        if let Some(StockOption::Mesh(file)) = &mut program.stock {
            files.push(file);
        }
        files
    }

    /// The same request, where relative names of files refer to a folder.
    pub(crate) fn within(mut self, folder: &Path) -> Self {
        for file in self.files_mut() {
            *file = folder.join(&*file);
        }
        if let Input::File(file) = &mut self.input {
            *file = folder.join(&*file);
        }
        // A machine is a file, or the name of a ready one.
        let machine = &mut self.program.dialect.machine;
        let file = machine
            .as_ref()
            .map(|name| folder.join(name))
            .filter(|file| file.is_file());
        if let Some(file) = file {
            *machine = Some(file.display().to_string());
        }
        self
    }

    /// The options of the sweep.
    pub(crate) fn sweep_options(&self, job: &Job) -> Options {
        Options::new(job.tolerance)
            .method(self.sweeping.method)
            .boundary(self.sweeping.boundary)
            .tile(self.sweeping.tile)
    }

    /// What can be said before anything is read.
    pub(crate) fn check(&self) -> Result<(), JobError> {
        if self.cell.is_some() && self.cells.is_some() {
            return Err(JobError::request("cell", "expected it or `cells`, not both"));
        }
        let positive = [
            ("cell", self.cell),
            ("tolerance", self.tolerance),
            ("decimate", self.decimate),
        ];
        for (field, value) in positive {
            if value.is_some_and(|value| !(value > 0.0 && value.is_finite())) {
                return Err(JobError::request(field, "expected a positive number of millimetres"));
            }
        }
        self.given.stock.as_ref().map_or(Ok(()), given::check_corners)?;
        let [gouge, excess] = self.limits.unwrap_or_default();
        let judging = &self.judging;
        let mut lengths = vec![
            ("limits", gouge),
            ("limits", excess),
            ("length range", judging.length_range),
        ];
        lengths.extend(judging.clearance.map(|clearance| ("clearance", clearance)));
        lengths.extend(judging.offset_range.map(|offset| ("offset range", offset)));
        for (field, value) in lengths {
            if !(value >= 0.0 && value.is_finite()) {
                let why = "expected a number of millimetres, 0 or greater";
                return Err(JobError::request(field, why));
            }
        }
        if self.cache.is_some() && (self.task != Task::Verify || self.judging.first) {
            let why = "is for `verify` of whole programs: leave out `first`, or the cache";
            return Err(JobError::request("cache", why));
        }
        if !(8..=4096).contains(&self.sweeping.tile) {
            return Err(JobError::request("tile", "expected a whole number from 8 to 4096"));
        }
        task::check_outputs(self.task, &self.outputs, self.judging.proof)
    }
}
