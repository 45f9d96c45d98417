//! What a file is.

use crate::base::JobError;
use std::path::Path;
use sweepsim_formats::{DexelFormat, MeshFormat, is_dexels_csv};

/// The kind of a file by its extension, and by its first line for tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Job,
    Mesh,
    Dexels,
    /// Tools of CAM systems and controls.
    Tools,
    /// A path, or anything else, which the path reader then reports.
    Path,
}

impl Kind {
    /// The kind of a file.
    pub fn of(file: &Path) -> Result<Self, JobError> {
        let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        if extension.as_deref() == Some("ron") {
            return Ok(Self::Job);
        }
        if matches!(
            extension.as_deref(),
            Some("json" | "fctb" | "fctl" | "tbl" | "camotics")
        ) {
            return Ok(Self::Tools);
        }
        if MeshFormat::of(file).is_some() {
            return Ok(Self::Mesh);
        }
        Ok(match DexelFormat::of(file) {
            Some(DexelFormat::Csv) if !is_dexels_csv(file)? => Self::Path,
            Some(_) => Self::Dexels,
            None => Self::Path,
        })
    }
}
