//! What everything else uses: errors, words for people, and where outputs go.

pub(crate) mod cache;
mod error;
pub(crate) mod kind;
mod memory;
mod numbers;
pub mod sentences;
mod sink;
pub mod words;

pub use error::JobError;
pub(crate) use memory::check_room;
pub use memory::least_memory;
pub use sink::{Content, Folder, Memory, Sink, folder_name, output_folder};
