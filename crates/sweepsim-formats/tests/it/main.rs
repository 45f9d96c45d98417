//! Integration tests of `sweepsim-formats`, in one binary: it links once.

mod archives;
mod bad_jobs;
mod bad_motions;
mod bad_texts;
mod colours;
mod dexels_binary;
mod drafts;
mod exchange;
mod guide;
mod jobs;
mod motions;
mod round_trips;
#[cfg(feature = "step")]
mod step;
mod support;
