//! Integration tests of `sweepsim-dexel`, in one binary: it links once.

mod changing;
mod cluster;
mod common;
mod compare;
mod decimate;
mod deviation;
mod dexels;
mod distance;
mod frames;
mod large;
mod misuse;
mod nearest;
mod state;
mod steps;
mod stock;
mod surface;
mod tri;
