//! Paths in the workspace.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The root of the workspace, from cargo's path of this package; without cargo, the current folder.
pub fn root() -> PathBuf {
    env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("."), |folder| PathBuf::from(folder).join(".."))
}

/// `fixtures/`.
pub fn fixtures() -> PathBuf {
    root().join("fixtures")
}

/// The fixture jobs, sorted.
pub fn jobs() -> Result<Vec<PathBuf>, String> {
    listed(&fixtures().join("jobs"), "ron")
}

/// The files of a folder with the extension, sorted.
pub fn listed(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    let failed = |error: io::Error| format!("{}: {error}", folder.display());
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.extension().is_some_and(|found| found == extension) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// The name of a job or of its stored dexels, from the file.
pub fn name_of(job: &Path) -> String {
    job.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
