//! Programs of Siemens Sinumerik 840D.
//!
//! Read: `G0 G1 G2 G3` and `CIP` (centres `I J K`, also `AC(…)`; `CR=`, `AR=`, `TURN=`), `G17 G18 G19`, `G90 G91` with `AC IC DC ACP ACN`,
//! `G70 G71 G700 G710`, work offsets (`G54`…`G57`, `G505`…, `G500`), `SUPA G53 G153 G74 G75` (left out where the machine does not know the place), programmable frames
//! (`TRANS ROT SCALE MIRROR` and those with `A`), `CYCLE800` axis by axis, `TRAORI`/`TRAFOOF`, tool vectors `A3= B3= C3=`, drilling cycles
//! `CYCLE81`…`89`, `840` alone or after `MCALL`, patterns and milling cycles, cutter compensation (`G41 G42 G40`, `G450 G451`, `NORM KONT`, `OFFN`), `RND RNDM CHF CHR`,
//! `CT`, polar coordinates (`G110 G111 G112`, `AP RP`), tools by number or name, `R` parameters, `DEF`, expressions, jumps, `CASE IF WHILE FOR
//! LOOP REPEAT`, and subprograms with parameters, by name from the same archive or from a file beside.
//!
//! Rotary axes turn the tool relative to the part by the right-hand rule, as their letters' convention has it, unless a machine is given.
//! Splines, synchronous actions and other cycles are errors with their position.

mod arcs;
mod codes;
mod contours;
mod cycles;
mod frames;
mod interpreter;
mod language;
mod moves;
mod places;
mod state;
mod variables;
mod words;

pub use super::run::Library;
pub(crate) use interpreter::read as read_kept;

use crate::model::program::Program;
use crate::model::read_options::ReadOptions;
use crate::text::error::NcError;
use crate::text::lines;

/// Reads a program without subprograms in other files.
///
/// # Errors
/// [`NcError`] with line and column at the first problem; [`NcError::further`] has the others.
///
/// ```
/// use sweepsim_nc::{ReadOptions, siemens};
/// let text = "R1=5\nG0 X0 Y0 Z=R1*2\nTRAORI\nG1 X10 B90 C0 F500\nAROT Y90\nG1 Z=IC(3)\nM30";
/// let program = siemens::read(text, &ReadOptions::default())?;
/// let last = program.poses.last().ok_or("no pose")?;
/// // The frame's z is the part's x.
/// assert_eq!((last.pose.tip(), last.pose.axis()), ([13.0, 0.0, 10.0], [1.0, 0.0, 0.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(text: &str, options: &ReadOptions) -> Result<Program, NcError> {
    read_with(text, options, &|_| None)
}

/// Reads a program whose subprograms `library` finds by their names in capitals.
///
/// # Errors
/// As [`read`].
pub fn read_with(text: &str, options: &ReadOptions, library: Library) -> Result<Program, NcError> {
    read_kept(&lines::kept(text), options, library)
}
