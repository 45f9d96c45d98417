//! What a run computes, in a few words and in a digest: pieces fit together only if these are equal.

use super::piece::Identity;
use super::tiling::Tiling;
use crate::base::JobError;
use crate::request::Request;
use sha2::{Digest, Sha256};
use std::fmt::{self, Write};
use sweepsim_formats::Job;

/// A digest that is written to.
struct Digesting(Sha256);

impl Write for Digesting {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// The identity of a run.
///
/// The digest is of all values of the job as it was read, so of the content of every file that it refers to. Their
/// notation is that of this version of the program, which is compared as well.
///
/// # Errors
/// [`JobError`] if the request has no notation.
pub(crate) fn identity(request: &Request, job: &Job, tiling: &Tiling) -> Result<Identity, JobError> {
    let command = request.task.name();
    let notation = serde_json::to_string(request);
    let notation = notation.map_err(|error| JobError::request("shard", error.to_string()))?;
    let mut digest = Digesting(Sha256::new());
    let grids: Vec<_> = tiling.sets.iter().map(|set| set.grid).collect();
    // Writing to a digest does not fail.
    let _ = write!(digest, "{command} {job:?} {grids:?} {notation}");
    Ok(Identity {
        program: env!("CARGO_PKG_VERSION").to_owned(),
        command: command.to_owned(),
        job: job.name.clone(),
        cells: job.grid.cells(),
        tile: request.sweeping.tile,
        tolerance: job.tolerance,
        method: request.sweeping.method.to_string(),
        digest: hexadecimal(&digest.0.finalize()),
        request: request.clone(),
    })
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
