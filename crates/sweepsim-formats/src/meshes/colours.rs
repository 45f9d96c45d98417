//! Colours of meshes: one for each triangle, as far as a file has them.

use std::path::Path;

use sweepsim_dexel::Mesh;

use super::files::{MeshFormat, read_mesh_file};
use super::glb::coloured_glb;
use super::ply::coloured_ply;
use super::step::{STEP_CHORD, read_step};
use super::threemf::coloured_3mf;
use crate::error::FormatError;
use crate::text::whole;

/// Red, green and blue, in sRGB.
pub type Colour = [u8; 3];

/// The colour of each triangle, if it has one.
pub(crate) type Colours = Vec<Option<Colour>>;

/// A colour like `#ff8000`; the opacity that may follow is ignored.
pub(crate) fn parsed(text: &str) -> Option<Colour> {
    let digits = text.trim().strip_prefix('#')?;
    if !matches!(digits.len(), 6 | 8) || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |k: usize| u8::from_str_radix(&digits[2 * k..2 * k + 2], 16).ok();
    Some([channel(0)?, channel(1)?, channel(2)?])
}

/// Reads a mesh with the colour of each triangle, if it has one: `.ply` (of its face, or of its corners if they
/// agree),
/// `.glb` (of its material), `.3mf` (of its material or colour group) and `.step` (of its face, or of the body). Other
/// formats have no colours.
///
/// # Errors
/// Those of [`read_mesh_file`].
pub fn read_coloured_mesh_file(file: &Path) -> Result<(Mesh, Vec<Option<Colour>>), FormatError> {
    let bytes = || whole::read(file, whole::DATA);
    match MeshFormat::of(file) {
        Some(MeshFormat::Ply) => coloured_ply(&bytes()?),
        Some(MeshFormat::Glb) => coloured_glb(&bytes()?),
        Some(MeshFormat::ThreeMf) => coloured_3mf(&bytes()?),
        Some(MeshFormat::Step) => {
            let part = read_step(file, STEP_CHORD)?;
            let colours = part.colours();
            Ok((part.mesh, colours))
        }
        _ => {
            let mesh = read_mesh_file(file)?;
            let none = vec![None; mesh.triangles.len()];
            Ok((mesh, none))
        }
    }
    .map_err(|error| error.in_file(file))
}
