//! Integration tests of `sweepsim-cli`, in one binary: it links once.

mod ci;
mod command;
mod comparison;
mod directions;
mod exchange;
mod frames;
mod inspect;
mod library;
#[cfg(feature = "mcp")]
mod mcp;
mod page;
mod programs;
mod setups;
mod shards;
mod step;
mod support;
mod verify;
mod warnings;
