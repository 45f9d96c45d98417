//! Dexels.

mod binary;
mod binary_read;
mod binary_write;
mod csv;
mod files;
mod fixture;
mod fixture_text;
mod npz;
mod tri;
mod vtu;

pub use binary_read::read_dexels_binary;
pub use binary_write::write_dexels_binary;
pub use csv::{DexelRow, dexels_from_rows, read_dexels_csv, write_dexels_csv};
pub use files::{DexelFormat, is_dexels_csv, read_dexels_file, read_tri_dexels_file, write_dexels, write_dexels_file};
pub use fixture::{Fixture, FixtureDifference};
pub use npz::{read_dexels_npz, write_dexels_npz};
pub use tri::{read_tri_dexels, write_tri_dexels};
pub use vtu::write_dexels_vtu;
