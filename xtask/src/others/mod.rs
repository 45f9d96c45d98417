//! Comparisons with what others do: with other programs, and with the way in which they work.

pub mod peers;
pub mod study;
