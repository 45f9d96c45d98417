//! Places in the text of a job.

use crate::error::Problem;
use crate::text::SpanTree;

/// A problem with a tool or a motion, and the steps from there to the field at fault.
pub(crate) struct Fault {
    pub problem: Problem,
    pub field: Vec<Step>,
}

/// A step from a value of the job's text to one inside it.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    Key(String),
    Item(usize),
}

impl Step {
    /// The span that the step leads to.
    pub fn of<'n>(&self, node: &'n SpanTree) -> &'n SpanTree {
        match self {
            Self::Key(key) => node.key(key),
            Self::Item(index) => node.item(*index),
        }
    }
}

impl From<&str> for Step {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}
