//! How parts differ.

use crate::errors::{argument, raised};
use crate::solids::{Solid, mesh};
use crate::watch::watched;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sweepsim_job::{CompareRequest, Part};

/// Compares two parts by a request in its notation as JSON, where parts in memory take the place of files. Returns the
/// report as JSON, and the picture as PNG.
#[pyfunction]
#[pyo3(signature = (request, part=None, target=None, progress=None))]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    request: &str,
    part: Option<Solid<'_>>,
    target: Option<Solid<'_>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Bound<'py, PyBytes>)> {
    let mut request: CompareRequest = serde_json::from_str(request).map_err(|error| argument(py, request, &error))?;
    let given = |solid: Solid<'_>| match solid {
        Solid::Dexels(dexels) => Ok::<_, PyErr>(Part::Dexels(dexels.get().clone())),
        Solid::Mesh(vertices, triangles) => Ok(Part::Mesh(mesh(&vertices, &triangles)?)),
    };
    if let Some(part) = part {
        request = request.with_part(given(part)?);
    }
    if let Some(target) = target {
        request = request.with_target(given(target)?);
    }
    let found = watched(py, progress, |monitor| {
        let found = request.read()?.compare(monitor)?;
        found.json().map(|json| (json, found.picture))
    })?;
    let (json, picture) = found.map_err(|error| raised(py, &error))?;
    Ok((json, PyBytes::new(py, &picture)))
}
