//! What crosses crates, in one binary.

mod brute_force;
mod real_programs;
mod router_bit;
mod tidy;
