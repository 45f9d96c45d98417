//! Triangle meshes.

mod files;
mod glb;
mod ply;
mod stl;
mod threemf;
mod vtp;

pub use files::{MeshFormat, read_mesh_file, write_mesh_file};
pub use glb::{read_glb, write_glb};
pub use ply::{read_ply, write_ply};
pub use stl::{parse_stl, read_stl, write_stl};
pub use threemf::{read_3mf, write_3mf};
pub use vtp::{read_vtp, write_vtp};
