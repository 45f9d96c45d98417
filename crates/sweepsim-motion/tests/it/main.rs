//! Integration tests of `sweepsim-motion`, in one binary: it links once.

mod below;
mod boundary;
mod bounds;
mod carried;
mod checked_boundary;
mod misuse;
mod motions;
mod offsets;
mod packed;
mod parts;
mod placed;
mod rigid;
mod spline_profiles;
