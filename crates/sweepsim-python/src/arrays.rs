//! Arrays of rows, and meshes as such.

use crate::errors::wrong;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use sweepsim_job::dexel::Mesh;

/// Vertices (n × 3), triangles (m × 3), and normals at the vertices (n × 3).
pub(crate) type MeshArrays<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<u32>>,
    Bound<'py, PyArray2<f32>>,
);

/// The numbers of rows become an array, without a copy.
pub(crate) fn rows<'py, T: numpy::Element, const N: usize>(
    py: Python<'py>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    rows_of(py, rows.into_flattened(), N)
}

/// Numbers become an array with rows of this width, without a copy.
pub(crate) fn rows_of<T: numpy::Element>(
    py: Python<'_>,
    numbers: Vec<T>,
    width: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = numbers.len() / width.max(1);
    numbers.into_pyarray(py).reshape([count, width])
}

/// A mesh, without a copy.
pub(crate) fn arrays(py: Python<'_>, mesh: Mesh) -> PyResult<MeshArrays<'_>> {
    Ok((
        rows(py, mesh.vertices)?,
        rows(py, mesh.triangles)?,
        rows(py, mesh.normals)?,
    ))
}

/// The rows of an array, each of this many numbers.
pub(crate) fn read<T: numpy::Element + Copy, const N: usize>(
    array: &PyReadonlyArray2<'_, T>,
    what: &str,
) -> PyResult<Vec<[T; N]>> {
    let [count, width] = [array.shape()[0], array.shape()[1]];
    let numbers = array
        .as_slice()
        .map_err(|_| wrong(array.py(), format!("{what}: expected a contiguous array")))?;
    let (read, rest) = numbers.as_chunks::<N>();
    if width == N && rest.is_empty() {
        return Ok(read.to_vec());
    }
    Err(wrong(
        array.py(),
        format!("{what}: an array of {count} × {width} numbers: expected rows of {N}"),
    ))
}
