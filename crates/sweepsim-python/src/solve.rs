//! Systems of equations.

use crate::arrays::rows_of;
use crate::errors::wrong;
use crate::watch::watched;
use numpy::PyArray2;
use pyo3::prelude::*;
use sweepsim_solve::{Enclosure, PointSolver, SolveOptions, System};

/// Lower and upper corners of boxes.
type Corners<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);
/// Roots (n × d), lower and upper corners of their enclosures, and the same of the boxes that could not be resolved.
type Roots<'py> = (Bound<'py, PyArray2<f64>>, Corners<'py>, Corners<'py>);

/// Finds all roots of equations in a box.
#[pyfunction]
#[pyo3(signature = (equations, variables, domain, boxes=None))]
pub(crate) fn solve_system<'py>(
    py: Python<'py>,
    equations: Vec<String>,
    variables: Vec<String>,
    domain: Vec<[f64; 2]>,
    boxes: Option<u64>,
) -> PyResult<Roots<'py>> {
    let bounds = |[low, high]: &[f64; 2]| Enclosure::new(*low, *high);
    let bounds: Result<Vec<Enclosure>, _> = domain.iter().map(bounds).collect();
    let bounds = bounds.map_err(|error| wrong(py, error))?;
    let [equations, variables] =
        [&equations, &variables].map(|texts| texts.iter().map(String::as_str).collect::<Vec<_>>());
    let system = System::parse(&equations, &variables, &bounds).map_err(|error| wrong(py, error))?;
    let mut options = SolveOptions::default();
    options.boxes = boxes.unwrap_or(options.boxes);
    let found = watched(py, None, |monitor| PointSolver::new(options).solve(&system, &monitor))?;
    let found = found.map_err(|error| wrong(py, error))?;
    let width = variables.len();
    let corners = |boxes: &[&[Enclosure]], corner: fn(&Enclosure) -> f64| {
        let numbers = boxes.iter().flat_map(|all| all.iter().map(corner)).collect();
        rows_of(py, numbers, width)
    };
    let both = |boxes: Vec<&[Enclosure]>| -> PyResult<_> {
        Ok((corners(&boxes, |side| side.lo())?, corners(&boxes, |side| side.hi())?))
    };
    let points: Vec<f64> = found.roots.iter().flat_map(|root| root.point.iter().copied()).collect();
    Ok((
        rows_of(py, points, width)?,
        both(found.roots.iter().map(|root| &root.enclosure[..]).collect())?,
        both(found.unresolved.iter().map(|open| &open.bounds[..]).collect())?,
    ))
}
