//! Where things are in the workspace.

use std::env;
use std::path::PathBuf;

/// The folder of the workspace: cargo tells where this package is; without cargo, the current folder.
pub fn root() -> PathBuf {
    env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("."), |folder| PathBuf::from(folder).join(".."))
}

/// `fixtures/`.
pub fn fixtures() -> PathBuf {
    root().join("fixtures")
}
