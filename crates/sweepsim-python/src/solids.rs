//! Solids that Python gives.

use crate::arrays::read;
use crate::dexels::Dexels;
use crate::errors::wrong;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use sweepsim_job::dexel::{Mesh, TriangleSoup};

/// Dexels, or a mesh.
#[derive(FromPyObject)]
pub(crate) enum Solid<'py> {
    Dexels(PyRef<'py, Dexels>),
    Mesh(PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, u32>),
}

/// A mesh of its vertices and triangles, without normals.
pub(crate) fn mesh(vertices: &PyReadonlyArray2<'_, f64>, triangles: &PyReadonlyArray2<'_, u32>) -> PyResult<Mesh> {
    let mut mesh = Mesh::default();
    mesh.vertices = read(vertices, "vertices")?;
    mesh.triangles = read(triangles, "triangles")?;
    mesh.normals = vec![[0.0; 3]; mesh.vertices.len()];
    mesh.cut = vec![false; mesh.vertices.len()];
    Ok(mesh)
}

/// The triangles of a mesh.
pub(crate) fn soup(
    vertices: &PyReadonlyArray2<'_, f64>,
    triangles: &PyReadonlyArray2<'_, u32>,
) -> PyResult<TriangleSoup> {
    let mesh = mesh(vertices, triangles)?;
    mesh.soup().ok_or_else(|| {
        let count = mesh.vertices.len();
        wrong(
            vertices.py(),
            format!("triangles: a number of a vertex beyond the last of {count}"),
        )
    })
}
