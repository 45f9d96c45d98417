//! What crosses crates, in one binary.

mod brute_force;
mod dependencies;
mod known_gaps;
mod railing;
mod router_bit;
mod same_part;
mod shared_data;
mod solids;
mod tidy;
