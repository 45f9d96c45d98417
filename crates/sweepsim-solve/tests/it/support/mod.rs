//! What the tests share: expressions with exact rational arithmetic and Bernstein forms of them.

#![allow(dead_code, reason = "each test file uses a part")]

pub mod audit;
pub mod expression;
pub mod planted;
pub mod targets;
pub mod taylor;
