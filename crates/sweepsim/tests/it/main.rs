//! Integration tests of `sweepsim`, in one binary: it links once.

mod arcs_along_dexels;
mod arcs_in_closed_form;
mod arcs_of_lying_axes;
mod arcs_of_lying_tools;
mod cancelling;
mod faces;
mod far_and_fine;
mod frames;
mod freeform;
mod grazing_curves;
mod joined_moves;
mod joints;
mod long_paths;
mod loops;
mod methods;
mod misuse;
mod near_degenerate;
mod near_material;
mod rays;
mod sections;
mod spline_profiles;
mod surfaces;
mod tiles;
mod translations;
mod turning;
mod verify;
