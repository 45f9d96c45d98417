//! Mesh files, by extension.

use std::fmt;
use std::io;
use std::path::Path;

use sweepsim_dexel::Mesh;

use super::glb::{read_glb, write_glb};
use super::ply::{read_ply, write_ply};
use super::step::{STEP_CHORD, read_step};
use super::stl::{read_stl, write_stl};
use super::threemf::{read_3mf, write_3mf};
use super::vtp::{read_vtp, write_vtp};
use crate::atomic::write_atomically;
use crate::error::{FormatError, Problem};
use crate::extension::{extension, unknown};
use crate::text::whole;

/// The extensions of [`MeshFormat`], for messages.
const MESHES: &str = ".stl, .ply, .glb, .3mf, .vtp, .step";
/// Those that are written, for messages.
const WRITTEN: &str = ".stl, .ply, .glb, .3mf, .vtp";

/// A format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshFormat {
    /// `.stl`: loose triangles.
    Stl,
    /// `.ply`: with normals.
    Ply,
    /// `.glb`: glTF 2.0, for viewers.
    Glb,
    /// `.3mf`: for 3D printers.
    ThreeMf,
    /// `.vtp`: for ParaView.
    Vtp,
    /// `.step`, `.stp`, `.p21`: boundary representations, which become triangles. Only read.
    Step,
}

impl MeshFormat {
    /// The format of a file, by its extension.
    #[must_use]
    pub fn of(file: &Path) -> Option<Self> {
        Some(match extension(file).as_str() {
            "stl" => Self::Stl,
            "ply" => Self::Ply,
            "glb" => Self::Glb,
            "3mf" => Self::ThreeMf,
            "vtp" => Self::Vtp,
            "step" | "stp" | "p21" => Self::Step,
            _ => return None,
        })
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::Glb => "GLB",
            Self::ThreeMf => "3MF",
            Self::Vtp => "VTP",
            Self::Step => "STEP",
        })
    }
}

/// Reads a mesh: `.stl`, `.ply`, `.glb`, `.3mf`, `.vtp` or `.step`. Identical corners of an STL become one vertex; the
/// solids of a STEP file become triangles by [`STEP_CHORD`].
///
/// # Errors
/// [`FormatError`] with the file's name: the file cannot be read, has more than 2 GiB, its extension is unknown, or
/// its content is invalid.
pub fn read_mesh_file(file: &Path) -> Result<Mesh, FormatError> {
    let Some(format) = MeshFormat::of(file) else {
        return Err(unknown(file, "mesh", MESHES));
    };
    if format == MeshFormat::Stl {
        let mesh = read_stl(file)?.indexed();
        return mesh.map_err(|error| FormatError::new(Problem::syntax(error.to_string()), None).in_file(file));
    }
    if format == MeshFormat::Step {
        return Ok(read_step(file, STEP_CHORD)?.mesh);
    }
    let bytes = whole::read(file, whole::DATA)?;
    match format {
        MeshFormat::Stl | MeshFormat::Step | MeshFormat::Ply => read_ply(&bytes),
        MeshFormat::Glb => read_glb(&bytes),
        MeshFormat::ThreeMf => read_3mf(&bytes),
        MeshFormat::Vtp => read_vtp(&bytes),
    }
    .map_err(|error| error.in_file(file))
}

/// Writes a mesh, completely or not at all: `.stl`, `.ply`, `.glb`, `.3mf` or `.vtp`.
///
/// # Errors
/// [`FormatError`] with the file's name: the extension is unknown or that of STEP files, or the data cannot be
/// written.
pub fn write_mesh_file(mesh: &Mesh, file: &Path) -> Result<(), FormatError> {
    let Some(format) = MeshFormat::of(file).filter(|format| *format != MeshFormat::Step) else {
        return Err(unknown(file, "mesh", WRITTEN));
    };
    write_atomically(file, |out| write_mesh(mesh, format, out))
}

/// Writes a mesh in a format.
///
/// # Errors
/// Those of the writer; a triangle of the mesh has missing vertices; [`MeshFormat::Step`], which is only read.
pub fn write_mesh(mesh: &Mesh, format: MeshFormat, out: &mut (impl io::Write + ?Sized)) -> io::Result<()> {
    match format {
        MeshFormat::Stl => match mesh.soup() {
            Some(soup) => write_stl(&soup.triangles, out),
            None => Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "a triangle with missing vertices",
            )),
        },
        MeshFormat::Ply => write_ply(mesh, out),
        MeshFormat::Glb => write_glb(mesh, out),
        MeshFormat::ThreeMf => write_3mf(mesh, out),
        MeshFormat::Vtp => write_vtp(mesh, out),
        MeshFormat::Step => Err(io::Error::new(
            io::ErrorKind::Unsupported,
            format!("STEP files are not written: expected {WRITTEN}"),
        )),
    }
}
