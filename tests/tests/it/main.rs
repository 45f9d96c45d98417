//! What crosses crates, in one binary.

mod brute_force;
mod router_bit;
mod shared_data;
mod tidy;
