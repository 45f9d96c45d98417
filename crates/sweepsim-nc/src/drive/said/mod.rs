//! What is kept of a program besides its moves: events and calls, assumptions.

mod assumed;
mod recorded;
