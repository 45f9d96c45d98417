//! What crosses crates: conformance of the algorithms, oracles, end to end.
