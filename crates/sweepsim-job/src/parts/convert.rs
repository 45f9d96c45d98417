//! `convert`: from one format to another.

use super::solid::{GridOptions, Solid};
use crate::base::kind::Kind;
use crate::base::{JobError, Sink, words};
use crate::describe::Description;
use crate::request::{DialectOptions, ViewOptions};
use crate::session::lattice;
use crate::show::{bounds, decimated, picture, soup};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use sweepsim_dexel::{Dexels, Grid, Stock, TriDexels};
use sweepsim_formats::{DexelFormat, MeshFormat, STEP_CHORD, read_step, write_dexels, write_mesh, write_tri_dexels};
use sweepsim_nc::tools::{read_library, to_ron};
use sweepsim_nc::write::GcodeOptions;
use sweepsim_nc::{Controller, Machine, Program, read_file, table, write};

/// How G-code is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct WritingOptions {
    /// The control that it is for: one of [`Controller::NAMES`]. Without one, it follows from the extension.
    pub dialect: Option<String>,
    /// The machine that it is for: a file, or the name of a ready one. Without one, tilted tools are vectors, where the
    /// control has them.
    pub machine: Option<String>,
    /// Whether the coordinates of that machine's axes are written, without tip control.
    pub axes: bool,
    /// The most decimals of a number.
    pub decimals: u8,
}

impl Default for WritingOptions {
    fn default() -> Self {
        Self {
            dialect: None,
            machine: None,
            axes: false,
            decimals: 12,
        }
    }
}

impl WritingOptions {
    /// How to write a file with this extension.
    fn options(&self, extension: &str) -> Result<GcodeOptions, JobError> {
        let mut options = GcodeOptions::default();
        options.dialect = match (self.dialect.as_deref().and_then(Controller::named), extension) {
            (Some(dialect), _) => dialect,
            (None, "mpf" | "spf") => Controller::Siemens,
            (None, "h") => Controller::Heidenhain,
            _ => options.dialect,
        };
        if let Some(machine) = &self.machine {
            let read = Machine::read_file(Path::new(machine));
            options.machine = Some(read.map_err(|error| JobError::run(format!("{machine}: {error}")))?);
            options.tip_control = !self.axes;
        }
        options.decimals = usize::from(self.decimals);
        Ok(options)
    }
}

/// A request to convert one file to another, by the extensions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ConvertRequest {
    /// The input file: a program, tool library, mesh or dexels.
    pub input: PathBuf,
    /// The output file.
    pub output: PathBuf,
    /// How a program is read.
    pub dialect: DialectOptions,
    /// How G-code is written.
    pub writing: WritingOptions,
    /// The grid, where dexels need one.
    pub grid: GridOptions,
    /// How a picture is drawn.
    pub view: ViewOptions,
    /// Meshes of fewer triangles, nowhere further than this from the others, in millimetres.
    pub decimate: Option<f64>,
}

impl ConvertRequest {
    /// To convert one file to another.
    #[must_use]
    pub fn new(input: impl Into<PathBuf>, output: impl Into<PathBuf>) -> Self {
        Self {
            input: input.into(),
            output: output.into(),
            dialect: DialectOptions::default(),
            writing: WritingOptions::default(),
            grid: GridOptions::default(),
            view: ViewOptions::default(),
            decimate: None,
        }
    }

    /// The output as a sink calls it.
    fn name(&self) -> String {
        self.output.to_string_lossy().into_owned()
    }

    fn extension(&self) -> String {
        let extension = self.output.extension();
        extension.map_or(String::new(), |e| e.to_string_lossy().to_ascii_lowercase())
    }

    /// Converts it, passes the output to a sink under its path, and says what it holds and what was lost.
    ///
    /// # Errors
    /// [`JobError`]: the input cannot be read, or not be converted to such an output.
    pub fn write_to(&self, sink: &mut dyn Sink) -> Result<Description, JobError> {
        let input = &self.input;
        let mut text = Description::default();
        match Kind::of(input)? {
            Kind::Job => {
                let why = "jobs cannot be converted: use `simulate` or `sweep` to get dexels and meshes";
                return Err(JobError::file(input, why));
            }
            Kind::Path => {
                let extension = self.extension();
                let program = read_program(self, &extension)?;
                let lost = path(&program, self, &extension, sink)?;
                text.line("path", &words::counted(program.poses.len() as u64, "pose"));
                lost.iter()
                    .for_each(|what| text.line("note", &format!("not written: {what}")));
                let notes = program.notes.iter();
                notes.for_each(|note| text.line("note", &note.to_string()));
            }
            Kind::Tools => tools(self, sink, &mut text)?,
            Kind::Mesh | Kind::Dexels => {
                let grid = self.grid.grid(None);
                // The mesh provides the area, so the number of cells is enough.
                let known = if Kind::of(input)? == Kind::Dexels { grid? } else { None };
                let solid = if MeshFormat::of(input) == Some(MeshFormat::Step) {
                    let part = read_step(input, STEP_CHORD)?;
                    part.notes.iter().for_each(|note| text.line("note", note));
                    Solid::Mesh(part.mesh)
                } else {
                    Solid::read(input, known.as_ref())?
                };
                write_solid(&solid, self, sink, &mut text)?;
            }
        }
        Ok(text)
    }
}

fn write_solid(
    solid: &Solid,
    options: &ConvertRequest,
    sink: &mut dyn Sink,
    text: &mut Description,
) -> Result<(), JobError> {
    let (input, output, name) = (&options.input, &options.output, options.name());
    if options.extension() == "png" {
        let (png, missed) = picture(&options.view, &solid.surface()?, None, &|_| ControlFlow::Continue(()))?;
        if let Some(first) = missed.into_iter().next() {
            return Err(JobError::Run(first));
        }
        return sink.write(&name, &mut |file| file.write_all(&png));
    }
    if let Some(format) = MeshFormat::of(output).filter(|format| *format != MeshFormat::Step) {
        let surface = match solid {
            Solid::Mesh(mesh) => mesh.clone(),
            Solid::Dexels(_) | Solid::TriDexels(_) => solid.solid_surface()?,
        };
        let (mut mesh, note) = decimated(&surface, options.decimate)?;
        if let Some(note) = note {
            text.line("note", &note);
        }
        // 3D printers need triangles that share vertices.
        if format == MeshFormat::ThreeMf && !matches!(solid, Solid::Mesh(_)) {
            mesh = Cow::Owned(soup(&mesh).indexed()?);
        }
        text.line("triangles", &words::count(mesh.triangles.len() as u64));
        if format == MeshFormat::Stl || format == MeshFormat::Glb {
            text.line(
                "note",
                &format!("{format} stores coordinates as 32-bit floats: they are rounded"),
            );
        }
        return sink.write(&name, &mut |file| write_mesh(&mesh, format, file));
    }
    let Some(format) = DexelFormat::of(output) else {
        return Err(JobError::run(format!(
            "{}: unknown extension: expected .stl, .ply, .glb, .3mf, .vtp, .csv, .dexels, .tridexels, .npz, .vtu or .png",
            output.display()
        )));
    };
    let grid = match solid {
        Solid::Dexels(dexels) => *dexels.grid(),
        Solid::TriDexels(solid) => *solid.sets()[2].grid(),
        Solid::Mesh(mesh) => options
            .grid
            .grid(bounds(mesh))?
            .ok_or_else(|| JobError::run(format!("{}: this mesh has no triangles", input.display())))?,
    };
    if format == DexelFormat::Tri {
        return write_tri(solid, &grid, options, sink, text);
    }
    let dexels = solid.dexels(input, &grid)?;
    let [nx, ny] = grid.cells().map(|n| words::count(n as u64));
    let intervals = words::counted(dexels.count() as u64, "interval");
    text.line("dexels", &format!("{nx} × {ny}, {intervals}"));
    if format == DexelFormat::Csv {
        text.line("note", "a table contains neither the grid nor normals and sources");
    }
    sink.write(&name, &mut |file| write_dexels(&dexels, format, file))
}

/// Writes dexels along three axes.
fn write_tri(
    solid: &Solid,
    grid: &Grid,
    options: &ConvertRequest,
    sink: &mut dyn Sink,
    text: &mut Description,
) -> Result<(), JobError> {
    let failed = |error: &dyn std::error::Error| JobError::file(&options.input, error);
    let made = match solid {
        Solid::TriDexels(solid) => TriDexels::clone(solid),
        Solid::Mesh(mesh) => {
            let heights = bounds(mesh).map_or([0.0; 2], |[low, high]| [low[2], high[2]]);
            let (min, max, cells) = lattice(grid, heights);
            TriDexels::new(min, max, cells, &Stock::Mesh(soup(mesh))).map_err(|error| failed(&error))?
        }
        Solid::Dexels(_) => {
            let why = "these dexels are along z only: expected .tridexels (--only tridexels) or a mesh";
            return Err(JobError::file(&options.input, why));
        }
    };
    let intervals: usize = made.sets().iter().map(Dexels::count).sum();
    let [nx, ny, nz] = made.cells().map(|n| words::count(n as u64));
    let intervals = words::counted(intervals as u64, "interval");
    text.line("dexels", &format!("{nx} × {ny} × {nz}, {intervals}"));
    sink.write(&options.name(), &mut |out| write_tri_dexels(&made, out))
}

/// Reads a program as its output needs it: tables have no arcs.
fn read_program(options: &ConvertRequest, extension: &str) -> Result<Program, JobError> {
    let mut reading = options.dialect.reading().map_err(JobError::Run)?;
    reading.exact_arcs = extension != "csv";
    Ok(read_file(&options.input, &reading)?)
}

/// Writes a program, and returns what the format cannot say.
fn path(
    program: &Program,
    options: &ConvertRequest,
    extension: &str,
    sink: &mut dyn Sink,
) -> Result<Vec<String>, JobError> {
    let (output, name) = (&*options.output, options.name());
    let mut lost = Vec::new();
    match extension {
        "csv" => sink.write(&name, &mut |mut file| {
            lost = table::write_program(program, &mut file)?;
            Ok(())
        })?,
        "cls" | "clsf" | "apt" | "ncl" => sink.write(&name, &mut |mut file| {
            lost = write::clsf(program, &mut file)?;
            Ok(())
        })?,
        "txt" => sink.write(&name, &mut |mut file| write::canonical(program, &mut file))?,
        "nc" | "ngc" | "tap" | "gcode" | "mpf" | "spf" | "h" => {
            let writing = options.writing.options(extension)?;
            let written = write::gcode(program, &writing).map_err(JobError::run)?;
            sink.write(&name, &mut |file| file.write_all(written.text.as_bytes()))?;
            lost = written.lost;
        }
        _ => {
            return Err(JobError::run(format!(
                "{}: programs can be written as G-code (.nc, .ngc, .tap, .mpf, .h), CLSF (.cls, .apt), tables (.csv) and text (.txt): expected one of them",
                output.display()
            )));
        }
    }
    Ok(lost)
}

/// Writes tools as fields of a job.
fn tools(options: &ConvertRequest, sink: &mut dyn Sink, text: &mut Description) -> Result<(), JobError> {
    let (input, output) = (&options.input, &options.output);
    if output
        .extension()
        .is_none_or(|extension| !extension.eq_ignore_ascii_case("ron"))
    {
        let message = format!(
            "{}: tools can be written as those of a job: expected .ron",
            output.display()
        );
        return Err(JobError::run(message));
    }
    let library = read_library(input, false)?;
    let (notation, problems) = to_ron(&library.tools);
    if problems.len() == library.tools.len() {
        let first = problems
            .first()
            .map(|(number, problem)| format!("tool {number}: {problem}"));
        let reason = first.unwrap_or_else(|| "it has no tool".to_owned());
        return Err(JobError::run(format!(
            "{}: no tool of it can be written: {reason}",
            input.display()
        )));
    }
    sink.write(&options.name(), &mut |file| file.write_all(notation.as_bytes()))?;
    text.line("tools", &words::count((library.tools.len() - problems.len()) as u64));
    for (number, problem) in problems {
        text.line("note", &format!("tool {number} is left out: {problem}"));
    }
    library.notes.iter().for_each(|note| text.line("note", &note.message));
    Ok(())
}
