//! Programs of Heidenhain's controls in Klartext.
//!
//! Read: `BEGIN PGM … MM|INCH`, `BLK FORM` of blocks (the stock), `TOOL CALL` by number or name, `L LP LN C CC CP CR CT CTP` in Cartesian and polar,
//! absolute and incremental coordinates, cutter compensation (`RL RR R0`), `RND`, `CHF` between lines, `FMAX`, labels with calls and repeats, `CALL PGM`, `Q` parameters with
//! `FN 0` to `FN 14` and formulas, datum shift, mirror, rotation, scale and presets (cycles 7, 8, 10, 11, 26, 247), dwell (9), programs (12), drilling and milling cycles
//! 200 to 209, 240, 241, 251 to 253, 256, 257 and 262 by `CYCL CALL`, `M99` or `M89`, `PLANE SPATIAL | EULER | VECTOR | RELATIV | RESET`, and tip control (`M128`, `FUNCTION TCPM`)
//! with rotary axes or with tool vectors `TX TY TZ`. Moves with `M91` are left out where the machine does not know the place, and so are all with `M92`.
//!
//! Rotary axes turn the tool relative to the part by the right-hand rule, unless a machine is given. Other cycles are errors
//! with their position.

mod calls;
mod contours;
mod cycles;
mod frames;
mod interpreter;
mod language;
mod moves;
mod planes;
mod settings;
mod state;
mod words;

pub use super::run::Library;
pub(crate) use interpreter::read as read_kept;

use crate::model::program::Program;
use crate::model::read_options::ReadOptions;
use crate::text::error::NcError;
use crate::text::lines;

/// Reads a program without programs that it calls.
///
/// # Errors
/// [`NcError`] with line and column at the first problem; [`NcError::further`] has the others.
///
/// ```
/// use sweepsim_nc::{ReadOptions, heidenhain};
/// let text = "0 BEGIN PGM 1 MM\n1 TOOL CALL 3 Z S2000\n2 L X+0 Y+0 Z+5 R0 FMAX\n3 PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN FMAX\n\
///             4 L X+1 Y+2 Z+3 FMAX\n5 END PGM 1 MM";
/// let program = heidenhain::read(text, &ReadOptions::default())?;
/// let last = program.poses.last().ok_or("no pose")?;
/// // The plane's z is the part's x.
/// assert_eq!((last.pose.tip(), last.pose.axis()), ([3.0, 2.0, -1.0], [1.0, 0.0, 0.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(text: &str, options: &ReadOptions) -> Result<Program, NcError> {
    read_with(text, options, &|_| None)
}

/// Reads a program; `library` finds those that it calls by their names in capitals, without `.H`.
///
/// # Errors
/// As [`read`].
pub fn read_with(text: &str, options: &ReadOptions, library: Library) -> Result<Program, NcError> {
    read_kept(&lines::kept(text), options, library)
}
