//! What a run computes, in a few words and in a digest: pieces fit together only if these are equal.

use super::piece::Identity;
use super::tiling::Tiling;
use crate::arguments::RunOptions;
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

/// The identity of a run. `arguments`: the command line without what does not matter.
///
/// The digest is of all values of the job as it was read, so of the content of every file that it refers to. Their notation is that of this version of
/// the program, which is compared as well.
pub(crate) fn identity(
    command: &'static str,
    job: &Job,
    options: &RunOptions,
    tiling: &Tiling,
    arguments: Vec<String>,
) -> Identity {
    let mut digest = Digesting(Sha256::new());
    let grids: Vec<_> = tiling.sets.iter().map(|set| set.grid).collect();
    // Writing to a digest does not fail.
    let _ = write!(digest, "{command} {job:?} {grids:?} {arguments:?}");
    Identity {
        program: env!("CARGO_PKG_VERSION").to_owned(),
        command: command.to_owned(),
        job: job.name.clone(),
        cells: job.grid.cells(),
        tile: options.tile,
        tolerance: job.tolerance,
        method: options.method.to_string(),
        digest: hexadecimal(&digest.0.finalize()),
        arguments,
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
