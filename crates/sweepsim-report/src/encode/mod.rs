//! The embedded data: typed arrays, predicted, split into planes of bytes, compressed.
//!
//! `docs/report.md` in the project's repository describes the format; `assets/data.js` reads it.

mod arrays;
mod fit;
mod layers;
mod machine;
mod others;
mod surface;

pub(crate) use fit::{Embedded, embed};
