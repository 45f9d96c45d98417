//! Files and tools in words.

mod file;
mod program;
mod step;
mod tool;

pub use file::describe;
pub(crate) use tool::described_tool;
pub use tool::tool_in_words;

/// Labelled lines of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Description(Vec<(String, String)>);

impl Description {
    /// Adds a line; without a label it goes on with the one before.
    pub fn line(&mut self, label: &str, value: &str) {
        self.0.push((label.to_owned(), value.to_owned()));
    }

    /// Labels and texts, in their order.
    #[must_use]
    pub fn lines(&self) -> &[(String, String)] {
        &self.0
    }
}
