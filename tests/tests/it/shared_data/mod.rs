//! Files that nobody here wrote: `../shared/data` beside the project. Where it is absent, these tests are listed as
//! ignored.

mod by_their_numbers;
mod cl_files;
mod conformance;
mod curves;
mod impeller;
mod meshes;
mod points;
mod programs;
mod shop;
mod siemens;
mod splines;
mod stored;
mod surfaces;

#[path = "../../../../crates/sweepsim-solve/tests/it/support/mod.rs"]
mod solver_support;

use std::path::{Path, PathBuf};

/// The folder of the shared data.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data")
}
