//! How programs are read.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::machines::Machine;
use crate::model::names::Format;
use crate::text::error::{NcError, NcProblem};

/// How to read a program.
///
/// ```
/// use sweepsim_motion::RotaryTable;
/// use sweepsim_nc::{Machine, ReadOptions};
///
/// let mut options = ReadOptions::default();
/// options.machine = Machine::with_table(RotaryTable::Ac).tip_control(true);
/// options.exact_arcs = true;
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// How far chords may be from an arc, in millimetres.
    pub arc_tolerance: f64,
    /// Whether lengths are in inches: those of tables, and those of programs until they say `G20` or `G21`.
    pub inch: bool,
    /// The machine that runs the program.
    pub machine: Machine,
    /// How the tool axis turns between two blocks.
    pub law: AxisLaw,
    /// Keeps arcs and helices instead of dividing them into chords. The axis then turns at constant speed along them.
    pub exact_arcs: bool,
    /// Keeps those arcs and helices that turn about z while the tool stands along it, and whose ends are equally far from the centre: they are cheaper
    /// than their chords. Others, and those of a radius of more than 10 m, are divided unless [`exact_arcs`](Self::exact_arcs) keeps them.
    pub level_arcs: bool,
    /// Keeps, on the same terms, arcs in planes along z (`G18`, `G19`) that do not leave their plane, where they would take 8 chords or more.
    pub upright_arcs: bool,
    /// Keeps, on the same terms, arcs about the axis of a tool that leans, as those in tilted planes are, where they would take 30 chords or more.
    ///
    /// If any of these four is set, a block without tip control in which a table turns the part is one move, too, not chords.
    pub tilted_arcs: bool,
    /// The format of the file. `None`: as its content says.
    pub format: Option<Format>,
    /// The control that the program is written for. `None`: as the text says.
    pub controller: Option<Controller>,
    /// Whether to go on after problems, and to list what was left out as notes instead of rejecting the program.
    pub lenient: bool,
    /// Whether blocks that begin with `/` are skipped.
    pub block_delete: bool,
    /// The control's table of tool lengths and diameters, by number: what `H` and `D` mean.
    pub tool_offsets: BTreeMap<u32, ToolOffset>,
    /// Diameters that `D` means, by number, in millimetres, where the table has no row of it: without one, nothing is known of a length, but the
    /// contour can be compensated. In Siemens's and Heidenhain's programs the number is the tool's.
    pub diameters: BTreeMap<u32, f64>,
    /// Diameters of the tools themselves, by number, in millimetres, as a job or a library describes them: what `D` is assumed to mean where nothing says it.
    pub cutters: BTreeMap<u32, f64>,
    /// Where work offsets are that the program does not set, by name (`G55`, `G54.1P3`, `G505`, `preset2`), in millimetres from the zero of the first one that
    /// it uses.
    pub offsets: BTreeMap<String, [f64; 3]>,
    /// Whether [`diameters`](Self::diameters) and [`offsets`](Self::offsets) are in the program's unit instead of millimetres.
    pub in_program_units: bool,
    /// Whether what a program leaves to the control or to the operator is an error, instead of an [`Assumption`](crate::Assumption).
    pub strict: bool,
    /// Whether registers of diameters that nothing sets hold the wear of their tools, 0, rather than their sizes.
    pub wear_registers: bool,
    /// The control's numbered variables when the program starts, as in LinuxCNC's `.var` file: work offsets from `#5221`, homes from `#5161`.
    /// With them, positions in machine coordinates are known, and work offsets that the program does not set.
    pub variables: BTreeMap<u32, f64>,
    /// Folders with files of subprograms, in addition to the program's own.
    pub subprograms: Vec<PathBuf>,
    /// The folder that files of subprograms must be in, whatever links lead to: those elsewhere are missing.
    pub within: Option<PathBuf>,
    /// How many blocks may be executed: bounds the time that loops can take.
    pub most_blocks: u64,
    /// How many poses and events there may be: bounds the memory that a file of a few bytes can demand.
    pub most_poses: usize,
    /// Where the tool's tip is when the program starts, in millimetres in the frame of the first work offset, if that is known.
    pub start: Option<[f64; 3]>,
}

impl Default for ReadOptions {
    /// Millimetres, chords within 1 µm, SLERP, rotary axes and tip control as the program implies.
    fn default() -> Self {
        Self {
            arc_tolerance: 1e-3,
            inch: false,
            machine: Machine::default(),
            law: AxisLaw::Slerp,
            exact_arcs: false,
            level_arcs: false,
            upright_arcs: false,
            tilted_arcs: false,
            format: None,
            controller: None,
            lenient: false,
            block_delete: false,
            tool_offsets: BTreeMap::new(),
            diameters: BTreeMap::new(),
            cutters: BTreeMap::new(),
            offsets: BTreeMap::new(),
            in_program_units: false,
            strict: false,
            wear_registers: false,
            variables: BTreeMap::new(),
            subprograms: Vec::new(),
            within: None,
            most_blocks: 20_000_000,
            most_poses: 20_000_000,
            start: None,
        }
    }
}

/// Whether the lengths of a program are in inches, by its first word that says so.
fn is_in_inches(text: &str) -> Option<bool> {
    const WORDS: [(&str, bool); 6] = [
        ("G20", true),
        ("G21", false),
        ("G70", true),
        ("G71", false),
        ("G700", true),
        ("G710", false),
    ];
    for line in text.lines() {
        let upper = line.split(['(', ';']).next().unwrap_or("").trim().to_ascii_uppercase();
        if upper.contains("BEGIN PGM") {
            return Some(upper.ends_with("INCH"));
        }
        let said = upper.match_indices('G').find_map(|(at, _)| {
            let digits = upper[at + 1..]
                .bytes()
                .take_while(|b| b.is_ascii_digit() || *b == b'.')
                .count();
            let code = &upper[at..=at + digits];
            WORDS.iter().find(|(word, _)| *word == code)
        });
        if let Some((_, inch)) = said {
            return Some(*inch);
        }
    }
    None
}

impl ReadOptions {
    /// Those given in a program's unit in millimetres.
    pub(crate) fn in_mm(&self, text: &str) -> Self {
        let unit = if is_in_inches(text).unwrap_or(self.inch) {
            25.4
        } else {
            1.0
        };
        let mut options = self.clone();
        options.in_program_units = false;
        options.diameters.values_mut().for_each(|diameter| *diameter *= unit);
        options.offsets.values_mut().flatten().for_each(|x| *x *= unit);
        options
    }

    /// Whether programs can be read so.
    pub(crate) fn check(&self) -> Result<(), NcError> {
        if self.arc_tolerance > 0.0 && self.arc_tolerance.is_finite() {
            return Ok(());
        }
        let problem = NcProblem::value("the arc tolerance", self.arc_tolerance, "a positive number of mm");
        Err(NcError::new(problem, None))
    }
}

/// How the tool axis turns between two blocks of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum AxisLaw {
    /// In the plane of the two axes, as one rational arc.
    #[default]
    Slerp,
    /// In the plane of the two axes, at constant speed.
    ConstantSpeed,
    /// As the machine turns under tip control: both rotary axes at constant speed.
    Rotary,
}

/// A control, with its dialect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Controller {
    /// LinuxCNC, and others that follow RS-274/NGC.
    LinuxCnc,
    /// Fanuc, and others that follow it.
    Fanuc,
    /// Haas.
    Haas,
    /// Siemens Sinumerik 840D.
    Siemens,
    /// Heidenhain's Klartext.
    Heidenhain,
    /// Grbl and TinyG.
    Grbl,
    /// Okuma OSP, milling.
    Okuma,
}

impl Controller {
    /// The names that [`named`](Self::named) knows.
    pub const NAMES: [&str; 7] = ["linuxcnc", "fanuc", "haas", "siemens", "heidenhain", "grbl", "okuma"];

    /// Its name.
    ///
    /// ```
    /// assert_eq!(sweepsim_nc::Controller::Haas.name(), "haas");
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LinuxCnc => "linuxcnc",
            Self::Fanuc => "fanuc",
            Self::Haas => "haas",
            Self::Siemens => "siemens",
            Self::Heidenhain => "heidenhain",
            Self::Grbl => "grbl",
            Self::Okuma => "okuma",
        }
    }

    /// The control of this name, in any case.
    ///
    /// ```
    /// use sweepsim_nc::Controller;
    /// assert_eq!(Controller::named("Fanuc"), Some(Controller::Fanuc));
    /// assert_eq!(Controller::named("abacus"), None);
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "linuxcnc" | "rs274" => Self::LinuxCnc,
            "fanuc" => Self::Fanuc,
            "haas" => Self::Haas,
            "siemens" | "sinumerik" | "840d" => Self::Siemens,
            "heidenhain" | "klartext" => Self::Heidenhain,
            "grbl" | "tinyg" => Self::Grbl,
            "okuma" | "osp" => Self::Okuma,
            _ => return None,
        })
    }
}

/// A row of a control's tool table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToolOffset {
    /// The tool's length from the spindle's nose, in millimetres.
    pub length: f64,
    /// The tool's diameter, in millimetres.
    pub diameter: f64,
}
