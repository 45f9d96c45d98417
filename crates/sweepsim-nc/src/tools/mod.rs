//! Tools: libraries of CAM systems and controls, and tools and stock in the comments of programs.
//!
//! | source | what it gives |
//! | --- | --- |
//! | Fusion 360, HSM (`.json`) | cutter, flutes, shoulder, shank, stick-out, holder |
//! | FreeCAD (`.fctb`, `.fctl`) | cutter, flutes, shank |
//! | LinuxCNC (`.tbl`) | diameters and lengths for the control, no shapes |
//! | CAMotics (`.camotics`) | cutter, flutes, and the stock |
//! | comments (Fusion's posts, CutViewer, Carbide Create) | cutter, sometimes flutes, sometimes the stock |
//! | APT and CLSF ([`apt`](crate::apt)) | the seven parameters, flutes, stick-out |
//!
//! Nothing is guessed: [`ToolDescription::build`](crate::ToolDescription::build) names the measure that is missing.

mod bodies;
mod build;
mod camotics;
pub(crate) mod comments;
mod freecad;
mod fusion;
mod json;
mod library;
mod linuxcnc;
mod ron;

pub use build::{BuiltTool, ToolProblem};
pub use library::{ToolLibrary, parse, read_library};
pub use ron::to_ron;
