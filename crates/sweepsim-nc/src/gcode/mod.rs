//! G-code (RS-274): what the tool does in the part's frame.
//!
//! For LinuxCNC, Fanuc, Haas and Grbl: motion, offsets, cutter compensation, drilling cycles, subprograms, loops, variables and expressions.
//! The guide (`docs/programs.md`) lists the words.
//!
//! Each of these decisions is reported as a [`Note`](crate::Note):
//!
//! - Arcs are divided into chords within [`ReadOptions::arc_tolerance`], unless [`ReadOptions::exact_arcs`] keeps them.
//! - Between two blocks the tip moves straight, and the axis turns according to [`ReadOptions::law`]: by default by SLERP, whatever the
//!   machine's rotary axes do in between. Intermediate poses of the rotary axes are inserted only where the axis turns by more than
//!   90° in one block.
//! - A move in machine coordinates (`G53`, `G28`, `G30`) leaves the part's frame, unless [`ReadOptions::variables`] tells where that is: the path
//!   breaks there and resumes once all coordinates are known.
//! - If a feed move comes before X, Y and Z are all known, the unknown ones are taken as 0.
//! - Unknown words and codes are ignored if they cannot move the tool.
//!
//! - `G92` before the first move gives the tool's position in the part's frame. Without its shift (`G92.1`, `G92.2`), only the machine knows
//!   where absolute coordinates are, so they are errors.
//! - `K` in a helix of `G17` (`J` in `G18`, `I` in `G19`) must agree with its end, as pitch or as rise.
//!
//! Anything that could move the tool in a way that is not supported is an error with its position.

mod codes;
mod dialect;
mod flow;
mod modes;
mod offsets;
mod okuma;
mod run;
mod syntax;

use std::path::Path;
use std::rc::Rc;

pub(crate) use self::dialect::okuma_title;
use self::run::interpreter::{self, Input};
use crate::model::program::Program;
use crate::model::read_options::ReadOptions;
use crate::text::error::NcError;
use crate::text::lines;
use crate::tools::comments;

/// Reads a program.
///
/// # Errors
/// [`NcError`] with line and column at the first block that is invalid or ambiguous; [`NcError::further`] has the others.
///
/// ```
/// use sweepsim_nc::{ReadOptions, gcode};
/// let text = "G21 G90 M428\nG0 X0 Y0 Z5 A0 C90\nG1 Z-1 F200\nX10 A90\n";
/// let program = gcode::read(text, &ReadOptions::default())?;
/// assert_eq!(program.poses.len(), 3);
/// assert!(program.poses[0].rapid && !program.poses[2].rapid);
/// assert_eq!(program.poses[2].pose.axis(), [1.0, 0.0, 0.0]);
///
/// let error = gcode::read("G0 X0 Y0 Z5\nG60 X1", &ReadOptions::default()).unwrap_err();
/// assert!(error.to_string().starts_with("2:1: G60"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(text: &str, options: &ReadOptions) -> Result<Program, NcError> {
    read_at(&lines::kept(text), None, options)
}

/// Reads the text of a file; subprograms may be in files beside it.
pub(crate) fn read_at(text: &Rc<String>, file: Option<&Path>, options: &ReadOptions) -> Result<Program, NcError> {
    let mut program = interpreter::read(&Input { text, file }, options, false).program?;
    let comments = comments::read(text, program.units.in_mm());
    program.tools = comments.tools;
    program.stock = comments.stock;
    Ok(program)
}

/// The canonical commands of a program: what it makes the machine do, as LinuxCNC's stand-alone interpreter writes it, one command each.
///
/// Moves (`STRAIGHT_TRAVERSE`, `STRAIGHT_FEED`, `ARC_FEED`) are in the program's units and coordinates, beside the programmed contour where
/// cutter compensation is on. Besides, there are offsets, dwells and the texts of `(DEBUG,…)` and `(PRINT,…)`. The commands up to a problem
/// come with it. `file` is where the text comes from; subprograms may be in files beside it.
///
/// ```
/// use sweepsim_nc::{ReadOptions, gcode};
/// let (commands, problem) = gcode::canonical("G20\nG0 X1 Y0 Z0.5\n", None, &ReadOptions::default());
/// assert_eq!(commands, ["STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.5000, 0.0000, 0.0000, 0.0000)"]);
/// assert!(problem.is_none());
/// ```
#[must_use]
pub fn canonical(text: &str, file: Option<&Path>, options: &ReadOptions) -> (Vec<String>, Option<NcError>) {
    let text = &lines::kept(text);
    let outcome = interpreter::read(&Input { text, file }, options, true);
    let commands = outcome.trace.iter().map(ToString::to_string).collect();
    (commands, outcome.program.err())
}

/// Whether a line begins a subroutine or loop, or sets a variable.
pub(crate) fn is_subroutine_or_variable(line: &str) -> bool {
    let rest = line.trim_start_matches(['O', 'o']);
    rest.starts_with(['#', '<']) && (rest.len() < line.len() || line.contains('='))
}

/// Whether a line is a block with a code or a coordinate.
pub(crate) fn is_block(line: &str) -> bool {
    syntax::words::plain(line).is_ok_and(|block| block.words().iter().any(|word| "GMXYZT".contains(word.letter)))
}
