//! Readers and writers for milling simulation: jobs, meshes, dexels, reports.
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
//! | jobs (RON) | [`Job::read`] | [`draft`], for a program |
//! | tools made of B-spline surfaces, motions along B-splines (RON) | with the job | |
//! | paths as programs and tables | with the job, by [`sweepsim_nc`] | |
//! | triangles (STL) | [`read_stl`] | [`write_stl`] |
//! | meshes with normals (PLY) | [`read_ply`] | [`write_ply`] |
//! | meshes for viewers (GLB) | [`read_glb`] | [`write_glb`] |
//! | meshes for 3D printers (3MF) | [`read_3mf`] | [`write_3mf`] |
//! | dexels (`dexels.csv`) | [`read_dexels_csv`] | [`write_dexels_csv`] |
//! | dexels, compact and exact (`.dexels`) | [`read_dexels_binary`] | [`write_dexels_binary`] |
//! | dexels along three axes (`.tridexels`) | [`read_tri_dexels`] | [`write_tri_dexels`] |
//! | dexels as NumPy arrays (`.npz`) | [`read_dexels_npz`] | [`write_dexels_npz`] |
//! | solids (STEP), with the feature `step` | [`read_step`] | |
//! | meshes for ParaView (`.vtp`) | [`read_vtp`] | [`write_vtp`] |
//! | dexels for ParaView (`.vtu`) | | [`write_dexels_vtu`] |
//! | any of these meshes, by extension | [`read_mesh_file`] | [`write_mesh_file`] |
//! | any of these dexels, by extension | [`read_dexels_file`] | [`write_dexels_file`] |
//! | dexels for regression tests, small and to a tolerance | [`Fixture::parse`] | [`Fixture::text`] |
//! | reports (`report.json`) | serde | [`Report::to_json`] |
//! | findings for continuous integration (SARIF, JUnit) | | [`to_sarif`], [`to_junit`] |
//!
//! Errors are [`FormatError`]s: one message with file, line, column, and what was expected. Files are written
//! completely or not at all ([`AtomicFile`]). No input makes a reader panic.

mod archive;
mod atomic;
mod checksum;
mod dexels;
mod drafts;
mod error;
mod extension;
mod jobs;
mod meshes;
mod report;
mod text;
mod vtk;

pub use atomic::{AtomicFile, write_atomically};
pub use dexels::{
    DexelFormat, DexelRow, Fixture, FixtureDifference, dexels_from_rows, is_dexels_csv, read_dexels_binary,
    read_dexels_csv, read_dexels_file, read_dexels_npz, read_tri_dexels, read_tri_dexels_file, write_dexels,
    write_dexels_binary, write_dexels_csv, write_dexels_file, write_dexels_npz, write_dexels_vtu, write_tri_dexels,
};
pub use drafts::{Draft, DraftFault, DraftOptions, DraftStock, Guess, draft, draft_of};
pub use error::{FormatError, Problem, TextPosition, io_reason};
pub use jobs::{
    AsWear, Flags, Job, JobPath, LimitRegion, Limits, OnMachine, Origin, Origins, Provided, RegionPlace, Seconds,
    Setup, Target, TargetFaces, Units, may_touch, must_stay_apart,
};
pub use meshes::{
    Colour, MeshFormat, STEP_CHORD, STEP_SHARE, STEP_THREAD, StepBody, StepFace, StepPart, parse_step, parse_stl,
    read_3mf, read_coloured_mesh_file, read_glb, read_mesh_file, read_ply, read_step, read_stl, read_vtp, write_3mf,
    write_glb, write_mesh, write_mesh_file, write_ply, write_stl, write_vtp,
};
pub use report::{
    Annotation, AnnotationLevel, AxisTravel, CiCase, CiProgram, ComparisonReport, DeviationSummary, DexelCounts,
    FaceDeviation, HistogramBar, Measure, MoveSummary, NotLookedAt, OpenPlace, PathSummary, Report, ReportedAlignment,
    ReportedDexel, ReportedFinding, ReportedRegion, Scope, ScopeLines, SetupSummary, Statement, StatementState,
    StatementWitness, SurfaceDeviation, ToolSummary, Verdict, WorkSummary, to_junit, to_sarif, write_moves_csv,
};
pub use sweepsim_nc::shortest;
