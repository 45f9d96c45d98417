//! The coefficients of a system: their layout, how boxes are cut, and what can be read off them.

mod blend;
mod enclose;
mod functions;
mod layout;
mod models;
#[cfg(test)]
mod models_test;
mod range;
mod stack;
mod subdivide;
mod summand;
mod tape;
pub(crate) mod tensor;

pub(crate) use blend::Blend;
pub(crate) use enclose::PartRanges;
pub(crate) use functions::{Function, value_range};
pub use layout::MAX_DEGREE;
pub(crate) use layout::{Affine, Axis, Cell, Layout, Slopes, Summand};
pub(crate) use stack::{excluded, pop, push, within_domain};
pub(crate) use tape::{Model, Step, Tape};
