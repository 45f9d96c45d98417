//! From a line to its words.

pub(crate) mod block;
pub(crate) mod cursor;
pub(crate) mod expression;
pub(crate) mod functions;
pub(crate) mod title;
pub(crate) mod user_task;
pub(crate) mod words;
