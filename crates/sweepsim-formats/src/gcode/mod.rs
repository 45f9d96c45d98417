//! NC programs in RS-274 (G-code): what the tool does in the part's frame.
//!
//! Understood: `G0 G1 G2 G3` (arcs and helices in `G17 G18 G19`, by centre or radius, with `P` turns), `G90 G91`,
//! `G90.1 G91.1`, `G20 G21`, work offsets (`G54`…`G59.3`, `G10 L2/L20`, `G52`, `G92`), tip control (`M428`, `M128`, `G43.4`; off with
//! `M429`, `M129`, `G49`) for tables with A/C or B/C axes ([`RotaryTable`]), tool changes, comments, block numbers, `%`,
//! `/`, `M2 M30`. Feeds, speeds, coolant and dwell leave the geometry as it is.
//!
//! Decisions, each made known as a [`Note`](crate::Note):
//!
//! - Arcs become chords within [`Options::arc_tolerance`], or stay arcs and helices with [`Options::exact_arcs`].
//! - Between two blocks the tip goes straight and the axis as [`Options::law`] says: by default by SLERP, whatever the machine's
//!   rotary axes do in between. Only when the axis turns by more than 90° in one block, poses on the rotary axes' way are put in.
//! - A move in machine coordinates (`G53`, `G28`, `G30`) leaves the part's frame: the path breaks there, and begins
//!   again where all coordinates are known.
//! - Where a cutting move comes before all of XYZ are known, those that are not are taken as 0.
//! - Words and codes without a known meaning are ignored when they cannot move the tool.
//!
//! What could move the tool in a way not known here (`G5`, cycles, cutter compensation, rotated frames, subroutines, variables)
//! is an error with its place. Nothing is left out silently.

mod arc;
mod codes;
mod lexer;
mod machine;
mod moves;
mod offsets;
mod program;
mod rotary;

pub use sweepsim_motion::RotaryTable;

use crate::error::FormatError;
use crate::program::Program;

/// How to read a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How far chords may be from an arc, in millimetres.
    pub arc_tolerance: f64,
    /// Whether lengths are inches until the program says `G20` or `G21`.
    pub inch: bool,
    /// The machine's rotary axes; `None`: by the letters that the program uses.
    pub table: Option<RotaryTable>,
    /// Whether the coordinates are the tip in the part's frame from the start, without a word in the program.
    pub tip_control: bool,
    /// How the axis turns between two blocks.
    pub law: AxisLaw,
    /// Whether arcs stay arcs, and helices helices, instead of chords. The axis then turns evenly along them.
    pub exact_arcs: bool,
}

/// How the tool's axis turns between two blocks of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisLaw {
    /// In the plane of the two axes, as one rational arc.
    #[default]
    Slerp,
    /// In the plane of the two axes, at constant speed.
    ConstantSpeed,
    /// As the machine does under tip control: both rotary axes at constant speed.
    Rotary,
}

impl Default for Options {
    /// Chords within 1 µm, millimetres, table by letters, tip control by the program, SLERP.
    fn default() -> Self {
        Self {
            arc_tolerance: 1e-3,
            inch: false,
            table: None,
            tip_control: false,
            law: AxisLaw::Slerp,
            exact_arcs: false,
        }
    }
}

/// Reads a program.
///
/// # Errors
/// [`FormatError`] with line and column at the first block that cannot be understood for sure.
///
/// ```
/// use sweepsim_formats::gcode;
/// let text = "G21 G90 M428\nG0 X0 Y0 Z5 A0 C90\nG1 Z-1 F200\nX10 A90\n";
/// let program = gcode::read(text, &gcode::Options::default())?;
/// assert_eq!(program.poses.len(), 3);
/// assert!(program.poses[0].rapid && !program.poses[2].rapid);
/// assert_eq!(program.poses[2].pose.axis().as_slice(), [1.0, 0.0, 0.0]);
///
/// let error = gcode::read("G0 X0 Y0 Z5\nG5 X1", &gcode::Options::default()).unwrap_err();
/// assert!(error.to_string().starts_with("2:1: G5"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(text: &str, options: &Options) -> Result<Program, FormatError> {
    program::read(text, options)
}
