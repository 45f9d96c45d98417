//! G-code, in the words of a control.

mod arcs;
mod comments;
mod klartext;
mod plan;
mod steps;
mod words;

use thiserror::Error;

use crate::machines::{Machine, ReachError};
use crate::model::program::Program;
use crate::model::read_options::Controller;

use klartext::Klartext;
use plan::Plan;
use words::Words;

/// How to write a program as G-code.
///
/// ```
/// use sweepsim_nc::{Controller, Machine, write::GcodeOptions};
///
/// let mut options = GcodeOptions::default();
/// options.dialect = Controller::Fanuc;
/// options.decimals = 4;
/// let posted = GcodeOptions::for_machine(Machine::named("head-bc").unwrap(), true);
/// assert!(posted.tip_control);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct GcodeOptions {
    /// The control that the program is for.
    pub dialect: Controller,
    /// The machine that it is for: directions of the tool become angles of its rotary axes. Without a machine, they are vectors, if the control has them.
    pub machine: Option<Machine>,
    /// Whether coordinates on that machine are those of the tip in the part's frame (tip control: `G43.4` and its kin) or those of its axes.
    pub tip_control: bool,
    /// The most decimals of a number, in millimetres and degrees.
    pub decimals: usize,
    /// How far chords may be from an arc that the program cannot keep, in millimetres.
    pub arc_tolerance: f64,
}

impl Default for GcodeOptions {
    /// RS-274 as LinuxCNC has it, without a machine, with 12 decimals, chords within 1 µm.
    fn default() -> Self {
        Self {
            dialect: Controller::LinuxCnc,
            machine: None,
            tip_control: true,
            decimals: 12,
            arc_tolerance: 1e-3,
        }
    }
}

impl GcodeOptions {
    /// For a machine, with or without tip control.
    #[must_use]
    pub fn for_machine(machine: Machine, tip_control: bool) -> Self {
        Self {
            machine: Some(machine),
            tip_control,
            ..Self::default()
        }
    }
}

/// Why a program cannot be written as G-code.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GcodeError {
    /// Programs of this control are read, not written.
    #[error("programs for {control} are not written: expected another dialect")]
    Dialect {
        /// The control.
        control: &'static str,
    },
    /// A pose that the machine does not reach.
    #[error("line {line}: {error}")]
    Reach {
        /// The index of the pose.
        pose: usize,
        /// Its line in the program that it was read from.
        line: usize,
        /// Why.
        error: ReachError,
    },
    /// The tool is tilted, which the control can only say by the axes of a machine.
    #[error(
        "line {line}: the tool is tilted, and {control} has no tool vectors: expected a machine, or the control fanuc, siemens or heidenhain"
    )]
    Tilted {
        /// The index of the pose.
        pose: usize,
        /// Its line in the program that it was read from.
        line: usize,
        /// The name of the control.
        control: &'static str,
    },
    /// The control has no tip control.
    #[error("{control} has no tip control: expected the coordinates of the machine's axes")]
    TipControl {
        /// The name of the control.
        control: &'static str,
    },
    /// The machine's pivots are not known.
    #[error("the axes of this machine are not known: expected one with all its axes")]
    NoAxes,
}

/// A program as G-code.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct GcodeText {
    /// The text.
    pub text: String,
    /// What it cannot say.
    pub lost: Vec<String>,
}

/// Writes a program as G-code in millimetres: moves, arcs and helices in the planes of the axes, feeds, spindle, coolant, dwells, stops and tool
/// changes. Other arcs become chords. Where the path breaks, the tool goes up to the machine's zero first.
///
/// Poses are what is kept. Between them the axes of a machine move in their own way: the axis of the tool as
/// [`AxisLaw::Rotary`](crate::AxisLaw) has it, and without tip control the tip leaves the straight line. Feeds without tip control are in inverse
/// time (`G93`) where a rotary axis turns.
///
/// # Errors
/// [`GcodeError`]: a pose that the machine does not reach, or a tilted tool where the control has no words for it.
///
/// ```
/// use sweepsim_nc::{Machine, ReadOptions, gcode, write};
/// let mut reading = ReadOptions::default();
/// reading.exact_arcs = true;
/// let program = gcode::read("T1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F200\nG2 X4 I2", &reading)?;
/// let written = write::gcode(&program, &write::GcodeOptions::default())?;
/// assert!(written.text.ends_with("G0 X0 Y0\nG43 H1 Z5\nG1 Z-1 F200\nG2 X4 Y0 Z-1 I2 J0\nM30\n%\n"), "{}", written.text);
///
/// let path = gcode::read("M428 G0 X0 Y0 Z5 B0 C0\nG1 X10 B30 C45 F500", &ReadOptions::default())?;
/// let machine = Machine::named("head-bc").ok_or("no such machine")?;
/// let written = write::gcode(&path, &write::GcodeOptions::for_machine(machine, false))?;
/// // The pivot is 150 mm above the tip: the axes move further than the tip, and the feed becomes a duration.
/// assert!(written.text.contains("G0 X0 Y0 Z5 B0 C0\nG93\nG1 X-43.033"), "{}", written.text);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn gcode(program: &Program, options: &GcodeOptions) -> Result<GcodeText, GcodeError> {
    let mut plan = Plan::new(program, options)?;
    let text = if options.dialect == Controller::Heidenhain {
        let mut klartext = Klartext::new(program, options);
        plan.run(&mut klartext)?;
        klartext.finish()
    } else {
        let mut words = Words::new(program, options);
        plan.run(&mut words)?;
        words.finish()
    };
    Ok(GcodeText { text, lost: plan.lost })
}

/// No number has more decimals.
const MOST_DECIMALS: usize = 1_074;

/// A number with at most this many decimals, without exponent.
fn number(value: f64, decimals: usize) -> String {
    let decimals = decimals.min(MOST_DECIMALS);
    let mut text = format!("{value:.decimals$}");
    if text.contains('.') {
        let end = text.trim_end_matches('0').trim_end_matches('.').len();
        text.truncate(end);
    }
    if text == "-0" { "0".to_owned() } else { text }
}

/// Which of A, B and C the machine has.
fn letters(options: &GcodeOptions) -> [bool; 3] {
    let machine = options
        .machine
        .as_ref()
        .and_then(|machine| machine.kinematics.as_deref());
    std::array::from_fn(|k| machine.is_some_and(|machine| machine.rotaries().has(k)))
}
