//! A request carried out.

use crate::arrays::{MeshArrays, arrays};
use crate::dexels::Dexels;
use crate::errors::{argument, raised, wrong};
use crate::solids::{Solid, soup};
use crate::tools::Tool;
use crate::watch::watched;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use sweepsim_job::dexel::Stock;
use sweepsim_job::{Folder, JobError, Memory, Output, Plan, Request, words};

/// What a run found.
#[pyclass(frozen, module = "sweepsim._sweepsim")]
pub(crate) struct Outcome(Arc<sweepsim_job::Outcome>);

/// Carries out a request, in its notation as JSON, with what is given in memory.
#[pyfunction]
#[pyo3(signature = (request, tools, stock=None, target=None, cache=None, progress=None))]
pub(crate) fn run(
    py: Python<'_>,
    request: &str,
    tools: BTreeMap<u32, PyRef<'_, Tool>>,
    stock: Option<Solid<'_>>,
    target: Option<Solid<'_>>,
    cache: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let mut request: Request = serde_json::from_str(request).map_err(|error| argument(py, request, &error))?;
    request = request.cache(cache);
    for (number, tool) in tools {
        request = request.tool(number, tool.tool.clone());
    }
    match stock {
        Some(Solid::Dexels(dexels)) => request = request.stock(Stock::Dexels(dexels.get().clone().into())),
        Some(Solid::Mesh(vertices, triangles)) => request = request.stock(Stock::Mesh(soup(&vertices, &triangles)?)),
        None => {}
    }
    match target {
        Some(Solid::Dexels(_)) => {
            return Err(wrong(
                py,
                "target: dexels: expected a closed mesh, such as that of `mesh()`",
            ));
        }
        Some(Solid::Mesh(vertices, triangles)) => request = request.target(soup(&vertices, &triangles)?),
        None => {}
    }
    let done = watched(py, progress, |monitor| {
        request.plan().and_then(|plan: Plan| plan.run(monitor))
    })?;
    Ok(Outcome(Arc::new(done.map_err(|error| raised(py, &error))?)))
}

#[pymethods]
impl Outcome {
    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        self.0.report().to_json().map_err(|error| wrong(py, error))
    }

    /// The verdict in one line.
    fn answer(&self) -> Option<String> {
        words::answer(self.0.report())
    }

    /// What was found in the program, and what was guessed.
    fn notes(&self) -> (Vec<String>, Vec<String>) {
        let plan = self.0.plan();
        let guessed = plan.guessed().iter().map(ToString::to_string);
        (plan.found().to_vec(), guessed.collect())
    }

    /// How many moves were judged again, of how many, and what is wrong with the cache; if there was one.
    fn reused(&self) -> Option<(usize, usize, Vec<String>)> {
        let reused = self.0.reused()?;
        Some((reused.again, reused.moves, reused.notes))
    }

    fn certified(&self) -> bool {
        self.0.is_certified()
    }

    fn part(&self) -> Dexels {
        Dexels::part(Arc::clone(&self.0))
    }

    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<MeshArrays<'py>> {
        let mesh = watched(py, None, |monitor| self.0.mesh(monitor))?;
        arrays(py, mesh.map_err(|error| raised(py, &error))?)
    }

    fn certificate(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.0.certificate().map_err(|error| raised(py, &error))
    }

    /// The picture of the part, as PNG.
    fn picture<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let drawn = watched(py, None, |monitor| {
            let mut memory = Memory::default();
            self.0.write_to(&mut memory, &[Output::Picture], monitor)?;
            Ok::<_, JobError>(memory.0.remove("part.png").unwrap_or_default())
        })?;
        Ok(PyBytes::new(py, &drawn.map_err(|error| raised(py, &error))?))
    }

    /// Writes outputs to a folder, and returns the names of their files.
    #[pyo3(signature = (folder, outputs, progress=None))]
    fn save(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        outputs: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<String>> {
        let outputs: Vec<Output> = serde_json::from_str(outputs).map_err(|error| wrong(py, error))?;
        let mut folder = Folder::create(folder).map_err(|error| PyOSError::new_err(error.to_string()))?;
        let written = watched(py, progress, |monitor| {
            self.0.write_to(&mut folder, &outputs, monitor)?;
            Ok::<_, JobError>(folder.written().iter().map(|(name, _)| name.clone()).collect())
        })?;
        written.map_err(|error| raised(py, &error))
    }
}
