//! What the tests share: expressions with exact rational arithmetic, Bernstein forms of them, and the stored systems.

#![allow(dead_code, reason = "each test file uses a part")]

pub mod expression;
pub mod planted;
pub mod stored;
pub mod taylor;
