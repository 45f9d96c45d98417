//! What crosses crates: conformance of the algorithms, oracles, end to end.

pub mod oracle;
pub mod tools;
