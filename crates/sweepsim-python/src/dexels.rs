//! Material on lines, as arrays.

use crate::arrays::{MeshArrays, arrays, read, rows};
use crate::errors::{of_file, raised, wrong};
use crate::watch::watched;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;
use sweepsim_formats::{read_dexels_file, write_dexels_file};
use sweepsim_job::dexel::{self, Grid, Interval, Line, Source};
use sweepsim_job::{JobError, Outcome};

type Point = (f64, f64, f64);

/// Who owns the dexels.
enum Owner {
    Dexels(Box<dexel::Dexels>),
    /// They are the part.
    Outcome(Arc<Outcome>),
}

/// Material on the lines of a grid: intervals, each with the normals of its ends and the moves that made them.
///
/// Lines run along z, through the centres of the cells: line (i, j) is at
/// ``min + (i + 1/2, j + 1/2) * spacing``. Arrays have a row for each interval, sorted by i, j and height.
/// They are made anew whenever they are asked for, and belong to the caller.
#[pyclass(frozen, module = "sweepsim")]
pub(crate) struct Dexels(Owner);

impl From<dexel::Dexels> for Dexels {
    fn from(dexels: dexel::Dexels) -> Self {
        Self(Owner::Dexels(dexels.into()))
    }
}

impl Dexels {
    /// The part of an outcome.
    pub fn part(outcome: Arc<Outcome>) -> Self {
        Self(Owner::Outcome(outcome))
    }

    pub fn get(&self) -> &dexel::Dexels {
        match &self.0 {
            Owner::Dexels(dexels) => dexels,
            Owner::Outcome(outcome) => outcome.part(),
        }
    }

    /// Two values for each interval, of its lower and its upper end.
    fn by_end<T: Copy + Send + Sync>(
        &self,
        py: Python<'_>,
        zero: T,
        one: impl Fn(dexel::End) -> T + Sync,
    ) -> Vec<[T; 2]> {
        let both = |interval: Interval| [one(interval.lower), one(interval.upper)];
        py.detach(|| gathered(self.get(), [zero; 2], |_, line| line.iter().map(both)))
    }
}

/// Lines that one thread goes through at a time.
const BLOCK: usize = 1 << 14;

/// A value for each interval, in the order of the lines; `of_line` makes those of one. `zero` is any value.
fn gathered<'a, T: Copy + Send + Sync, I: Iterator<Item = T>>(
    dexels: &'a dexel::Dexels,
    zero: T,
    of_line: impl Fn(usize, Line<'a>) -> I + Sync,
) -> Vec<T> {
    let lines = dexels.grid().len();
    let starts: Vec<usize> = (0..lines).step_by(BLOCK).collect();
    let block = |start: usize| start..lines.min(start + BLOCK);
    let count = |start: &usize| block(*start).map(|index| dexels.at(index).len()).sum();
    let counts: Vec<usize> = starts.par_iter().map(count).collect();
    let mut all = vec![zero; counts.iter().sum()];
    let (mut rest, mut places) = (&mut all[..], Vec::with_capacity(counts.len()));
    for count in counts {
        let (own, after) = rest.split_at_mut(count);
        places.push(own);
        rest = after;
    }
    starts.into_par_iter().zip(places).for_each(|(start, own)| {
        let mut own = own.iter_mut();
        for index in block(start) {
            // Values first: a place that has no value is not passed over.
            for (value, place) in of_line(index, dexels.at(index)).zip(own.by_ref()) {
                *place = value;
            }
        }
    });
    all
}

#[pymethods]
impl Dexels {
    #[new]
    #[pyo3(signature = (min, max, cells, lines, intervals))]
    fn new(
        py: Python<'_>,
        min: [f64; 2],
        max: [f64; 2],
        cells: [usize; 2],
        lines: PyReadonlyArray2<'_, u32>,
        intervals: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let grid = Grid::new(min, max, cells).map_err(|error| wrong(py, error))?;
        let (lines, intervals) = (read::<_, 2>(&lines, "lines")?, read::<_, 2>(&intervals, "intervals")?);
        if lines.len() != intervals.len() {
            let (lines, intervals) = (lines.len(), intervals.len());
            return Err(wrong(
                py,
                format!("{lines} lines and {intervals} intervals: expected one of each"),
            ));
        }
        let mut of_line: Vec<Vec<Interval>> = vec![Vec::new(); grid.len()];
        for ([i, j], [low, high]) in lines.into_iter().zip(intervals) {
            let index = grid.index(i as usize, j as usize);
            let index = index.ok_or_else(|| wrong(py, format!("line ({i}, {j}) is beyond the grid")))?;
            of_line[index].push(Interval::between(low, high));
        }
        let made = dexel::Dexels::from_fn(grid, |index, line| line.extend_from_slice(&of_line[index]));
        Ok(made.map_err(|error| wrong(py, error))?.into())
    }

    /// Reads ``.dexels`` or ``.npz``.
    #[staticmethod]
    fn read(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let read = py.detach(|| read_dexels_file(&file, None));
        Ok(read.map_err(|error| of_file(py, &error))?.into())
    }

    /// Writes ``.csv``, ``.dexels``, ``.npz`` or ``.vtu``, as the name says: completely, or not at all.
    fn write(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        let written = py.detach(|| write_dexels_file(self.get(), &file));
        written.map_err(|error| of_file(py, &error))
    }

    /// The lower corner of the grid, in millimetres.
    #[getter]
    fn min(&self) -> (f64, f64) {
        self.get().grid().min().into()
    }

    /// The upper corner of the grid, in millimetres.
    #[getter]
    fn max(&self) -> (f64, f64) {
        self.get().grid().max().into()
    }

    /// The number of lines along x and along y.
    #[getter]
    fn cells(&self) -> (usize, usize) {
        self.get().grid().cells().into()
    }

    /// The distance of the lines along x and along y, in millimetres.
    #[getter]
    fn spacing(&self) -> (f64, f64) {
        self.get().grid().spacing().into()
    }

    /// The origin and the axes of the grid: those of the part, unless the grid of a job has a frame.
    #[getter]
    fn frame(&self) -> (Point, [Point; 3]) {
        let frame = self.get().grid().frame();
        (frame.origin().into(), frame.axes().map(Point::from))
    }

    /// The length of all intervals times the area of a cell, in cubic millimetres.
    #[getter]
    fn volume(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.get().volume())
    }

    /// The number of intervals.
    fn __len__(&self) -> usize {
        self.get().count()
    }

    /// The line of each interval: i and j (n × 2).
    #[getter]
    fn lines<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let grid = *self.get().grid();
        let place = |index: usize, line: Line<'_>| {
            let (i, j) = grid.place(index);
            std::iter::repeat_n([i as u32, j as u32], line.len())
        };
        rows(py, py.detach(|| gathered(self.get(), [0; 2], place)))
    }

    /// The lower and the upper end of each interval, in millimetres (n × 2). Exact.
    #[getter]
    fn intervals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(
            py,
            py.detach(|| gathered(self.get(), [0.0; 2], |_, line| line.heights())),
        )
    }

    /// The unit normals at both ends, out of the material (n × 2 × 3), to within 6.5e-5.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let normals = self.by_end(py, [0.0; 3], |end| end.normal);
        let count = normals.len();
        let numbers = normals.into_flattened().into_flattened();
        numbers.into_pyarray(py).reshape([count, 2, 3])
    }

    /// The path and the move that made each end, from 0 (n × 2 × 2); -1 where the stock was not cut.
    #[getter]
    fn moves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<i64>>> {
        let cut = |end: dexel::End| match end.source {
            Source::Cut { path, segment, .. } => [i64::from(path), i64::from(segment)],
            Source::Stock => [-1; 2],
        };
        let moves = self.by_end(py, [0; 2], cut);
        let count = moves.len();
        let numbers = moves.into_flattened().into_flattened();
        numbers.into_pyarray(py).reshape([count, 2, 2])
    }

    /// The number of intervals of each line, as an image (columns × rows).
    #[getter]
    fn counts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let dexels = self.get();
        let lines = dexels.grid().len();
        let count = |index| dexels.at(index).len() as u32;
        let counts: Vec<u32> = py.detach(|| (0..lines).into_par_iter().with_min_len(BLOCK).map(count).collect());
        let counts: Bound<'_, PyArray1<u32>> = counts.into_pyarray(py);
        counts.reshape(dexels.grid().cells())
    }

    /// The closed surface: vertices, triangles and normals. On sharp edges each side has vertices of its own.
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<MeshArrays<'py>> {
        let mesh = watched(py, None, |_| self.get().surface())?;
        arrays(py, mesh.map_err(|error| raised(py, &JobError::from(error)))?)
    }
}
