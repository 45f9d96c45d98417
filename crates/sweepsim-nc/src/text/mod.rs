//! Problems with their place in a text, its lines, and numbers as text.

pub(crate) mod assumption;
pub(crate) mod confined;
pub(crate) mod error;
pub(crate) mod kept;
pub(crate) mod lines;
pub(crate) mod numbers;
pub(crate) mod utf16;
pub(crate) mod whole;
