//! APT, CLSF and NCL: the path of the tool as CAM systems write it before post-processing.
//!
//! Supported: `GOTO` with and without the tool axis (which is modal), `GODLTA`, `FROM`, `GOHOME`, `RAPID` (for one move), `FEDRAT`,
//! `CIRCLE` and `MOVARC`, drilling cycles (`CYCLE`) with their points, curves (`NURBS`, `KNOT`, `CNTRL`), `MSYS`, `CSYS` with
//! `TRNTYP/WORLD`, `UNITS`, tools (`CUTTER`, `TLDATA`, `LOAD`, `LOADTL`), `SPINDL`, `COOLNT`, `DELAY`, `STOP`, texts, continuation by `$`,
//! and Creo's comments `$$-> CUTTER`.
//!
//! - Coordinates are in the frame of the first `MSYS`; those of others are converted to it.
//! - An arc turns right-handed about its normal. The next `GOTO` is its end; if that is where it starts, it is a full turn. `MOVARC`
//!   with `ANGLE` needs no end.
//! - Depths and levels of a cycle are measured along the tool axis from its point: `FEDTO` and `DEPTH` below it, whatever their sign,
//!   `RAPTO`, `CLEAR`, `RTRCTO` and `RETURN` above it. With `CLEAR`, `RAPTO` is measured down from there. The moves of a cycle have the
//!   line of their point, and a [`Call`](crate::Call) with the line of the cycle.
//! - Tools that the file describes are in [`Program::tools`], so that a CL file alone is enough for a simulation.
//! - Feeds are in units of the file per minute.
//!
//! Part programs, whose path an APT processor computes from geometry (`PL1=PLANE/…`, `GOFWD/…`), are errors, as is everything that could
//! move the tool in an unknown way.

mod arc_moves;
mod arcs;
mod cutters;
mod cycles;
mod frames;
mod loaded;
mod motion;
mod nurbs;
mod reader;
mod settings;
mod statement;
mod words;

use crate::model::program::Program;
use crate::model::read_options::ReadOptions;
use crate::text::error::NcError;
use crate::text::lines;

/// Reads a CL file.
///
/// # Errors
/// [`NcError`] with line and column of the first statement that is invalid or not supported; [`NcError::further`] has the others.
///
/// ```
/// use sweepsim_nc::{ReadOptions, apt};
/// let text = "UNITS/MM\nCUTTER/10,0,5,0,0,0,40\nLOAD/TOOL,3\nRAPID\nGOTO/0,0,5\nFEDRAT/200,MMPM\nGOTO/0,0,-1\n\
///             CIRCLE/0,10,-1,0,0,1\nGOTO/0,0,-1\nFINI";
/// let mut options = ReadOptions::default();
/// options.exact_arcs = true;
/// let program = apt::read(text, &options)?;
/// assert_eq!(program.poses.len(), 3);
/// assert!(program.poses[0].rapid && program.poses[1].feed == Some(200.0));
/// assert_eq!(program.tools[&3].diameter, Some(10.0));
///
/// let error = apt::read("GOTO/1,2\n", &options).unwrap_err();
/// assert!(error.to_string().starts_with("1:1: the number of coordinates of GOTO is 2"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(text: &str, options: &ReadOptions) -> Result<Program, NcError> {
    reader::read(&lines::kept(text), options)
}
