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
//! | G-code (`.nc`, `.ngc`, `.tap`, `.txt`…) | [`gcode::read`] | [`write::gcode`] |
//! | APT, CLSF, NCL (`.apt`, `.cls`, `.ncl`…) | [`apt::read`] | [`write::clsf`] |
//! | Siemens 840D (`.mpf`), Heidenhain Klartext (`.h`) | [`siemens::read`], [`heidenhain::read`] | [`write::gcode`] |
//! | tables of poses (`.csv`) | [`table::read`] | [`table::write`] |
//! | one line per move, to read | | [`write::canonical`] |
//! | any of them, by content | [`read_file`] | |
//! | tool libraries | [`tools::read_library`] | [`tools::to_ron`] |
//!
//! Nothing is silently misread: a word that could move the tool in an unknown way is an [`NcError`] with line and
//! column, and whatever is ignored or assumed is a [`Note`]. No input makes a reader panic.

pub mod apt;
mod content;
mod controls;
mod drive;
pub mod gcode;
mod machines;
mod model;
mod read;
pub mod table;
mod text;
pub mod tools;
pub mod write;

pub use controls::{heidenhain, siemens};
pub use drive::{AxesCourse, AxisFault, AxisFinding, RapidPoint, check};
pub use machines::{
    BodyDescription, BodyShape, Carries, Chain, Kinematics, LinearAxis, Machine, MachineDescription, MachineError,
    Position, Rapid, ReachError, RotaryAxis, Solutions, WorkFrame,
};
pub use model::event::{Coolant, Event, EventKind, Spindle};
pub use model::names::Format;
pub use model::poses::ProgramPoses;
pub use model::positions::ProgramPositions;
pub use model::program::{Call, FeedMode, Note, NoteKind, Program, ProgramPose, Units};
pub use model::read_options::{AxisLaw, Controller, ReadOptions, ToolOffset};
pub use model::stock::StockDescription;
pub use model::times::{CORNER_DEVIATION, MoveClock, MoveTime, RAPID_SPEED, RAPID_TURN};
pub use model::tool::{CutterKind, HolderSegment, ToolDescription};
pub use model::usage::ToolUsage;
pub use read::{read_file, read_text};
pub use sweepsim_motion::RotaryTable;
pub use text::assumption::Assumption;
pub use text::confined::is_within;
pub use text::error::{NcError, NcProblem, TextPosition, shortened};
pub use text::lines::end_lines_at_returns;
pub use text::numbers::shortest;
pub use tools::{BuiltTool, ToolProblem};
