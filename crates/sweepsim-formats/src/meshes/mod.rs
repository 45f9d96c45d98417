//! Triangle meshes.

mod colours;
mod files;
mod glb;
mod ply;
mod step;
mod stl;
mod threemf;
mod vtp;

use std::io;

use sweepsim_dexel::Mesh;

use crate::error::{FormatError, Problem};

pub(crate) use colours::parsed as parsed_colour;
pub use colours::{Colour, read_coloured_mesh_file};
pub use files::{MeshFormat, read_mesh_file, write_mesh, write_mesh_file};
pub use glb::{read_glb, write_glb};
pub use ply::{read_ply, write_ply};
pub use step::{STEP_CHORD, STEP_SHARE, StepBody, StepFace, StepPart, THREAD as STEP_THREAD, parse_step, read_step};
pub use stl::{parse_stl, read_stl, write_stl};
pub use threemf::{read_3mf, write_3mf};
pub use vtp::{read_vtp, write_vtp};

/// The most vertices of a mesh, whose indices are `u32`.
const MOST_VERTICES: u64 = 1 << 32;

/// Refuses meshes with more vertices than their indices can number.
fn check_count(vertices: usize) -> Result<(), FormatError> {
    if vertices as u64 <= MOST_VERTICES {
        Ok(())
    } else {
        let problem = Problem::value("the number of vertices", vertices, format!("at most {MOST_VERTICES}"));
        Err(FormatError::new(problem, None))
    }
}

/// Refuses to write meshes whose triangles have missing vertices.
fn check_triangles(mesh: &Mesh) -> io::Result<()> {
    let count = mesh.vertices.len();
    if mesh.triangles.iter().flatten().all(|v| (*v as usize) < count) {
        Ok(())
    } else {
        Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "a triangle with missing vertices",
        ))
    }
}
