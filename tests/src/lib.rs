//! What crosses crates: conformance of the algorithms, oracles, end to end.

pub mod oracle;
pub mod tools;

/// The example of the project's README.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
