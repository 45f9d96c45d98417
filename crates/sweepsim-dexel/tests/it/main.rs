//! Integration tests of `sweepsim-dexel`, in one binary: it links once.

mod deviation;
mod frames;
mod large;
mod misuse;
