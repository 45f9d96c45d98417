//! Reads NC programs into canonical moves: poses in the part's frame, each with the way the tool gets there and its file and line.
//! The crate knows nothing of stock or sweeps; use it alone to convert, check or plot programs.
//!
//! ```
//! use sweepsim_nc::{ReadOptions, gcode};
//!
//! let text = "G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F200\nX10\n";
//! let program = gcode::read(text, &ReadOptions::default())?;
//! let lines: Vec<usize> = program.poses.iter().map(|pose| pose.line).collect();
//! assert_eq!(lines, [3, 4, 5]);
//! assert!(program.poses[0].rapid);
//! assert_eq!((program.poses[2].tool, program.poses[2].feed), (Some(1), Some(200.0)));
//! # Ok::<(), sweepsim_nc::NcError>(())
//! ```
//!
//! | format | read | write |
//! | --- | --- | --- |
//! | G-code (`.nc`, `.ngc`, `.tap`, `.txt`…) | [`gcode::read`] | |
//! | tables of poses (`.csv`) | [`table::read`] | [`table::write`] |
//! | either, by content | [`read_file`] | |
//!
//! Nothing is silently misread: a word that could move the tool in an unknown way is an [`NcError`] with line and
//! column, and whatever is ignored or assumed is a [`Note`]. No input makes a reader panic.

mod content;
mod error;
pub mod gcode;
mod machine;
mod numbers;
mod program;
mod read;
mod read_options;
pub mod table;

pub use error::{NcError, NcProblem, TextPosition};
pub use machine::Machine;
pub use numbers::shortest;
pub use program::{Note, Program, ProgramPose};
pub use read::read_file;
pub use read_options::{AxisLaw, ReadOptions};
pub use sweepsim_motion::RotaryTable;
