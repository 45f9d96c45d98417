//! Integration tests of `sweepsim`, in one binary: it links once.

mod frames;
mod freeform;
mod joints;
mod methods;
mod misuse;
mod near_degenerate;
mod sections;
mod spline_profiles;
mod surfaces;
