//! The parts of a request: how a program is read, what is judged, how pictures are drawn.

use crate::request::by_name;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sweepsim_formats::{DraftOptions, DraftStock};
use sweepsim_nc::{Controller, Format, Machine, ReadOptions};
use sweepsim_picture::{Axis, CuttingPlane, View};

/// The stock of a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum StockOption {
    /// As the program or its project says; otherwise a block around its feed moves.
    #[default]
    Auto,
    /// A block between its lower and its upper corner, in millimetres.
    Block([[f64; 3]; 2]),
    /// A mesh.
    Mesh(PathBuf),
}

/// How a program is read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct DialectOptions {
    /// The control that it is written for: one of [`Controller::NAMES`]. Without one, as the program says.
    pub controller: Option<String>,
    /// The machine: a file, or the name of a ready one.
    pub machine: Option<String>,
    /// The format of the program: one of [`Format::NAMES`]. Without one, as its content says.
    pub format: Option<String>,
    /// Whether to go on after problems of the program, and list what was left out.
    pub lenient: bool,
    /// Whether what the program leaves to the control or to the operator is an error, instead of an assumption.
    pub strict: bool,
    /// What `D` means to cutter compensation, by number, in the program's unit.
    pub diameters: BTreeMap<u32, f64>,
    /// Where work offsets are that the program does not set, by name (`G55`), in its unit from the zero of the first.
    pub offsets: BTreeMap<String, [f64; 3]>,
    /// The folder that all files must be in that a job, a project or a program refers to, whatever links lead to.
    pub within: Option<PathBuf>,
}

/// What a job says, given with a program instead.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ProgramOptions {
    /// A tool library, a tool table, or a project.
    pub tools: Option<PathBuf>,
    /// The stock.
    pub stock: Option<StockOption>,
    /// The design part: a mesh.
    pub target: Option<PathBuf>,
    /// How the program is read.
    pub dialect: DialectOptions,
}

impl DialectOptions {
    /// How to read a program.
    ///
    /// # Errors
    /// What is wrong with the machine's file, or a control or a format that does not exist.
    pub fn reading(&self) -> Result<ReadOptions, String> {
        let mut options = ReadOptions::default();
        options.lenient = self.lenient;
        options.strict = self.strict;
        options.diameters.clone_from(&self.diameters);
        options.offsets.clone_from(&self.offsets);
        options.in_program_units = true;
        options.within.clone_from(&self.within);
        let unknown = |what: &str, name: &str, names: &[&str]| {
            format!("the {what} is {name:?}, but must be one of {}", names.join(", "))
        };
        if let Some(name) = &self.controller {
            let named = Controller::named(name);
            options.controller = Some(named.ok_or_else(|| unknown("controller", name, &Controller::NAMES))?);
        }
        if let Some(name) = &self.format {
            let named = Format::named(name);
            options.format = Some(named.ok_or_else(|| unknown("format", name, &Format::NAMES))?);
        }
        if let Some(machine) = &self.machine {
            options.machine = Machine::read_file(Path::new(machine)).map_err(|error| format!("{machine}: {error}"))?;
        }
        Ok(options)
    }
}

impl ProgramOptions {
    /// The first of these options that was given, by its name.
    pub(crate) fn first(&self) -> Option<&'static str> {
        let given = [
            ("tools", self.tools.is_some()),
            ("stock", self.stock.is_some()),
            ("target", self.target.is_some()),
            ("controller", self.dialect.controller.is_some()),
            ("machine", self.dialect.machine.is_some()),
            ("as", self.dialect.format.is_some()),
            ("lenient", self.dialect.lenient),
            ("strict", self.dialect.strict),
            ("diameters", !self.dialect.diameters.is_empty()),
            ("offset", !self.dialect.offsets.is_empty()),
        ];
        given.iter().find(|(_, given)| *given).map(|(name, _)| *name)
    }

    /// For a draft of a job in a folder.
    #[must_use]
    pub fn draft(&self, folder: &Path) -> DraftOptions {
        let mut options = DraftOptions::default();
        options.tools.clone_from(&self.tools);
        options.stock = match self.stock.clone().unwrap_or_default() {
            StockOption::Auto => DraftStock::Auto,
            StockOption::Block([min, max]) => DraftStock::Block { min, max },
            StockOption::Mesh(file) => DraftStock::Mesh(file),
        };
        options.target.clone_from(&self.target);
        options.controller.clone_from(&self.dialect.controller);
        options.machine.clone_from(&self.dialect.machine);
        options.format.clone_from(&self.dialect.format);
        options.lenient = self.dialect.lenient;
        options.strict = self.dialect.strict;
        options.diameters.clone_from(&self.dialect.diameters);
        options.offsets.clone_from(&self.dialect.offsets);
        options.folder = folder.to_owned();
        options
    }
}

/// What [`Task::Verify`](crate::Task::Verify) looks at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Judging {
    /// Whether to end at the first finding.
    pub first: bool,
    /// How near shanks and holders may come to the workpiece and to fixtures, in millimetres, instead of the job's.
    pub clearance: Option<f64>,
    /// Whether shanks and holders, cutters in rapids and cutters beside fixtures are taken larger by half the diagonal
    /// between dexels: what they touch beside a dexel is found as well.
    pub sure: bool,
    /// Whether to write `moves.csv`: what each move removes, how deep and how wide, and how long it takes.
    pub moves: bool,
    /// Whether to prove what can be proven between the lines of the dexels.
    pub proof: bool,
    /// Whether a certificate of that can be had, even if [`Output::Certificate`](crate::Output::Certificate) is not
    /// among the outputs.
    pub certificate: bool,
    /// How far the part may be from its place on the machine along x, y and z, one way or the other, in millimetres.
    pub offset_range: [f64; 3],
    /// How much longer or shorter tools may be than the machine takes them, in millimetres.
    pub length_range: f64,
    /// Whether another place of the part is looked for, if the program collides with the machine or meets a limit.
    pub place: bool,
}

impl Default for Judging {
    fn default() -> Self {
        Self {
            first: false,
            clearance: None,
            sure: false,
            moves: false,
            proof: true,
            certificate: false,
            offset_range: [0.0; 3],
            length_range: 0.0,
            place: false,
        }
    }
}

/// How pictures are drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ViewOptions {
    /// Where the viewer stands around z and above the horizon, in degrees.
    pub camera: [f64; 2],
    /// Parallel projection instead of perspective.
    pub orthographic: bool,
    /// Planes that cut the part open: across x, y or z (0, 1, 2), at a coordinate in millimetres.
    pub sections: Vec<(u8, f64)>,
    /// The width and height of pictures, in pixels.
    pub size: [usize; 2],
    /// Whether axes and a scale are drawn.
    pub axes: bool,
}

impl Default for ViewOptions {
    fn default() -> Self {
        let view = View::default();
        Self {
            camera: [view.azimuth, view.elevation],
            orthographic: view.orthographic,
            sections: Vec::new(),
            size: view.size,
            axes: view.axes,
        }
    }
}

impl ViewOptions {
    pub(crate) fn view(&self) -> View {
        let mut view = View::default();
        [view.azimuth, view.elevation] = self.camera;
        view.orthographic = self.orthographic;
        view.size = self.size;
        view.axes = self.axes;
        view
    }

    pub(crate) fn planes(&self) -> Vec<CuttingPlane> {
        let axis = |number: u8| [Axis::X, Axis::Y, Axis::Z][usize::from(number.min(2))];
        let plane = |&(number, at): &(u8, f64)| CuttingPlane { axis: axis(number), at };
        self.sections.iter().map(plane).collect()
    }
}

/// How crossings are found, and become intervals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SweepOptions {
    /// How crossings are found. All methods give the same dexels.
    #[serde(with = "by_name")]
    pub method: sweepsim::Method,
    /// How crossings become intervals.
    #[serde(with = "by_name")]
    pub boundary: sweepsim::BoundaryOperator,
    /// The largest number of dexels along the side of a tile.
    pub tile: usize,
}

impl Default for SweepOptions {
    fn default() -> Self {
        Self {
            method: sweepsim::Method::default(),
            boundary: sweepsim::BoundaryOperator::Coverage,
            tile: sweepsim::Options::TILE,
        }
    }
}
