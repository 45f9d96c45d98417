//! Readers and writers for milling simulation: jobs, NC programs, meshes, dexels, reports.
//!
//! ```no_run
//! use std::path::Path;
//! use sweepsim_formats::Job;
//!
//! let job = match Job::read(Path::new("fixtures/jobs/quickstart.ron")) {
//!     Ok(job) => job,
//!     Err(error) => {
//!         eprintln!("{}", error.render(true));
//!         std::process::exit(2);
//!     }
//! };
//! println!("{} moves", job.moves());
//! ```
//!
//! | what | read | write |
//! | --- | --- | --- |
//! | jobs (RON) | [`Job::read`] | |
//! | tools of B-spline surfaces, motions of B-splines (RON) | with the job | |
//! | paths as tables (`.csv`) | [`csv::read_path`] | [`csv::write_path`] |
//! | paths as programs (`.nc`, `.ngc`, …) | [`gcode::read`] | |
//! | either, by extension | [`read_path_file`] | |
//! | triangles (STL) | [`read_stl`] | [`write_stl`] |
//! | meshes with normals (PLY) | [`read_ply`] | [`write_ply`] |
//! | meshes for viewers (GLB) | [`read_glb`] | [`write_glb`] |
//! | meshes for printers (3MF) | [`read_3mf`] | [`write_3mf`] |
//! | dexels (`dexels.csv`) | [`read_dexels_csv`] | [`write_dexels_csv`] |
//! | dexels to the bit, compact (`.dexels`) | [`read_dexels_binary`] | [`write_dexels_binary`] |
//! | dexels as NumPy arrays (`.npz`) | [`read_dexels_npz`] | [`write_dexels_npz`] |
//! | meshes for ParaView (`.vtp`) | [`read_vtp`] | [`write_vtp`] |
//! | dexels for ParaView (`.vtu`) | | [`write_dexels_vtu`] |
//! | any of these meshes, by extension | [`read_mesh_file`] | [`write_mesh_file`] |
//! | any of these dexels, by extension | [`read_dexels_file`] | [`write_dexels_file`] |
//! | dexels, small and to a tolerance | [`Fixture::parse`] | [`Fixture::text`] |
//! | reports (`report.json`) | serde | [`Report::to_json`] |
//!
//! What is wrong with a file is a [`FormatError`]: one message with file, line, column, and what was expected. Files are
//! written whole or not at all ([`AtomicFile`]). No input makes a reader panic.

mod atomic;
mod checksum;
pub mod csv;
mod dexels_binary;
mod dexels_csv;
mod error;
mod files;
mod fixtures;
pub mod gcode;
mod glb;
mod job;
mod locate;
mod motion;
mod npz;
mod numbers;
mod paths;
mod ply;
mod program;
mod raw;
mod read_job;
mod report;
mod stl;
mod surface_tool;
mod text;
mod threemf;
mod tools;
mod vtk;
mod zip;

pub use atomic::{AtomicFile, write_atomically};
pub use dexels_binary::{read_dexels_binary, write_dexels_binary};
pub use dexels_csv::{DexelRow, dexels_from_rows, read_dexels_csv, write_dexels_csv};
pub use error::{FormatError, Place, Problem};
pub use files::{
    DexelFormat, MeshFormat, is_dexels_csv, read_dexels_file, read_mesh_file, write_dexels_file, write_mesh_file,
};
pub use fixtures::{Difference, Fixture};
pub use glb::{read_glb, write_glb};
pub use job::{Job, Limits, Target, Units};
pub use npz::{read_dexels_npz, write_dexels_npz};
pub use numbers::shortest;
pub use paths::{JobPath, PathOptions, read_path_file};
pub use ply::{read_ply, write_ply};
pub use program::{Note, Program, ProgramPose};
pub use report::{
    Collision, ComparisonReport, Deviation, DexelCounts, Furthest, HistogramBar, Report, UnresolvedDexel,
};
pub use stl::{parse_stl, read_stl, write_stl};
pub use threemf::{read_3mf, write_3mf};
pub use vtk::{read_vtp, write_dexels_vtu, write_vtp};
