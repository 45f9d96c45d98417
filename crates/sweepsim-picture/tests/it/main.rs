//! Integration tests of `sweepsim-picture`, in one binary: it links once.

mod misuse;
mod picture;
mod tools;
