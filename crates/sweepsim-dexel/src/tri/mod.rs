//! Dexels along all three axes.

mod cell;
mod changing;
pub mod contour;
mod ends;
mod held;
mod lattice;
mod plane;

use crate::dexels::{Dexels, GridMismatch, Operation};
use crate::grid::Frame;
use crate::grid::{Grid, GridError};
use crate::intervals::Source;
use crate::mesh::{MOST_VERTICES, Mesh, MeshError};
use crate::stock::{Stock, StockError};
use crate::surface::sources_in;
pub use changing::{ChangingSurface, TimedMesh};
pub use ends::{SurfaceEnd, SurfaceEnds};
use thiserror::Error;

/// Three sets of dexels, along `x`, `y` and `z`, whose lines meet at the centres of `cells[0] × cells[1] × cells[2]`
/// boxes.
///
/// Dexels along an axis have the [frame](Grid::frame) of [`Frame::cyclic`]: their `x`, `y` and `z` are the axes
/// `axis + 1`, `axis + 2` and `axis` (mod 3), and so are the coordinates of their normals. What is steep for one set is
/// flat for another, so every face is met by lines of at least one set at less than 55° from its normal.
#[derive(Clone, Debug, PartialEq)]
pub struct TriDexels {
    min: [f64; 3],
    max: [f64; 3],
    cells: [usize; 3],
    sets: [Dexels; 3],
}

/// Why tri-dexels are invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TriDexelsError {
    /// The box is invalid, or has too many cells.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The lines of the three sets do not meet.
    #[error("the lines of the three sets of dexels do not meet")]
    Mismatch,
    /// The stock is invalid.
    #[error(transparent)]
    Stock(#[from] StockError),
}

impl TriDexels {
    /// An empty box from `min` to `max`, without material.
    ///
    /// # Errors
    /// [`TriDexelsError::Grid`]: an empty box, no cells, or more than [`Grid::MOST`] in all.
    pub fn empty(min: [f64; 3], max: [f64; 3], cells: [usize; 3]) -> Result<Self, TriDexelsError> {
        Self::grids(min, max, cells).map(|grids| Self {
            min,
            max,
            cells,
            sets: grids.map(Dexels::empty),
        })
    }

    fn grids(min: [f64; 3], max: [f64; 3], cells: [usize; 3]) -> Result<[Grid; 3], TriDexelsError> {
        let along = |axis: usize| {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            Grid::new([min[u], min[v]], [max[u], max[v]], [cells[u], cells[v]])
                .map(|grid| grid.in_frame(Frame::cyclic(axis)))
        };
        let grids = [along(0)?, along(1)?, along(2)?];
        // Leaves room for a rim.
        let padded = cells
            .iter()
            .try_fold(1_usize, |all, n| all.checked_mul(n.checked_add(2)?));
        match padded {
            Some(all) if all <= Grid::MOST => Ok(grids),
            _ => Err(GridError::Cells([cells[0].saturating_mul(cells[1]), cells[2]]).into()),
        }
    }

    /// The part of a stock that lies inside a box.
    ///
    /// # Errors
    /// [`TriDexelsError`]: the box or the stock is invalid. Dexels of an earlier run can be part of the stock only if
    /// they run along all three axes ([`Stock::TriDexels`]), in the same box.
    ///
    /// ```
    /// use sweepsim_dexel::{Stock, TriDexels};
    /// let ball = Stock::Ball { centre: [0.0; 3], radius: 4.0 };
    /// let solid = TriDexels::new([-5.0; 3], [5.0; 3], [50; 3], &ball)?;
    /// assert!((solid.volume() - 268.08).abs() < 1.0);
    /// assert_eq!(solid.disagreements(), 0);
    /// let mesh = solid.surface()?;
    /// assert!(mesh.vertices.iter().all(|v| (v[0].hypot(v[1]).hypot(v[2]) - 4.0).abs() < 0.01));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(min: [f64; 3], max: [f64; 3], cells: [usize; 3], stock: &Stock) -> Result<Self, TriDexelsError> {
        let [x, y, z] = Self::grids(min, max, cells)?;
        let whole = Stock::Block { min, max };
        let set = |grid: Grid| -> Result<Dexels, StockError> {
            let mut set = stock.dexels(&grid)?;
            set.intersect_all(&whole.dexels(&grid)?)?;
            Ok(set)
        };
        let sets = [set(x)?, set(y)?, set(z)?];
        Ok(Self { min, max, cells, sets })
    }

    /// Combines sets along `x`, `y` and `z`, whose grids are in the frames of [`Frame::cyclic`].
    ///
    /// # Errors
    /// [`TriDexelsError::Mismatch`]: their grids are not those of one box.
    pub fn from_sets(sets: [Dexels; 3]) -> Result<Self, TriDexelsError> {
        let [x, y, _] = &sets;
        let pick = |of: fn(&Grid) -> [f64; 2]| [of(y.grid())[1], of(x.grid())[0], of(x.grid())[1]];
        let (min, max) = (pick(Grid::min), pick(Grid::max));
        let cells = [y.grid().cells()[1], x.grid().cells()[0], x.grid().cells()[1]];
        let grids = Self::grids(min, max, cells)?;
        let fits = grids.iter().zip(&sets).all(|(grid, set)| grid == set.grid());
        fits.then_some(Self { min, max, cells, sets })
            .ok_or(TriDexelsError::Mismatch)
    }

    /// Lower corner of the box.
    #[must_use]
    pub fn min(&self) -> [f64; 3] {
        self.min
    }

    /// Upper corner of the box.
    #[must_use]
    pub fn max(&self) -> [f64; 3] {
        self.max
    }

    /// Cells along the axes.
    #[must_use]
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// The distances of lines along the axes.
    #[must_use]
    pub fn spacing(&self) -> [f64; 3] {
        [0, 1, 2].map(|c| (self.max[c] - self.min[c]) / self.cells[c] as f64)
    }

    /// The sets along `x`, `y` and `z`.
    #[must_use]
    pub fn sets(&self) -> &[Dexels; 3] {
        &self.sets
    }

    /// The three sets, as [`from_sets`](Self::from_sets) takes them.
    #[must_use]
    pub fn into_sets(self) -> [Dexels; 3] {
        self.sets
    }

    /// Combines the material with that of `other`.
    ///
    /// # Errors
    /// [`GridMismatch`] if the boxes or cells differ; nothing is changed then.
    pub fn combine(&mut self, operation: Operation, other: &Self) -> Result<(), GridMismatch> {
        if self.sets.iter().zip(&other.sets).any(|(a, b)| a.grid() != b.grid()) {
            return Err(GridMismatch);
        }
        let both = self.sets.iter_mut().zip(&other.sets);
        both.into_iter().try_for_each(|(a, b)| a.combine(operation, b))
    }

    /// The volume: the mean of the three sets' volumes.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.sets.iter().map(Dexels::volume).sum::<f64>() / 3.0
    }

    /// The number of line crossings where the three sets disagree on whether there is material: 0, except for points on
    /// the surface itself. The [surface](Self::surface) follows the majority.
    #[must_use]
    pub fn disagreements(&self) -> usize {
        contour::disagreements(self)
    }

    /// A closed surface with sharp edges and corners, by dual contouring. `docs/algorithms/tri-dexels.md` describes the
    /// algorithm.
    ///
    /// Every edge has two triangles and every vertex one fan of them. Vertices are shared and have mean normals; see
    /// [`Mesh::crisp`] for pictures. Features thinner than the spacing of the lines may be missing. Material beyond the
    /// box is cut off. The mesh is the same for any number of threads.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn surface(&self) -> Result<Mesh, MeshError> {
        contour::contour(self, MOST_VERTICES)
    }

    /// The same, with triangles that do not cross, so that they enclose a solid. Where those of the
    /// [surface](Self::surface) cross, mostly beside sharp edges, vertices are held in their cells, which may chamfer
    /// the edge there by up to half a diagonal of a cell. It takes a few times as long. Of 20,000 random solids none
    /// had crossings left; whether one has, [`TriangleSoup::faults`](crate::TriangleSoup::faults) tells.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    ///
    /// ```
    /// use sweepsim_dexel::{Stock, TriDexels};
    /// let [base, axis] = [[-5.0, -3.0, -4.0], [3.0, 2.0, 2.5]];
    /// let bar = Stock::Cylinder { base, axis, radius: 4.0, height: 11.0 };
    /// let solid = TriDexels::new([-10.0; 3], [10.0; 3], [60; 3], &bar)?;
    /// let crossings = |mesh: sweepsim_dexel::Mesh| mesh.soup().map(|soup| soup.faults(100).len());
    /// assert_ne!(crossings(solid.surface()?), Some(0));
    /// assert_eq!(crossings(solid.solid_surface()?), Some(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn solid_surface(&self) -> Result<Mesh, MeshError> {
        contour::uncrossed(self, MOST_VERTICES)
    }

    /// The [surface](Self::surface), and the interval end that each of its triangles was made for: a triangle is no
    /// farther than about a cell from its end, and where the end has a smooth surface, it approximates that one.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    ///
    /// ```
    /// use sweepsim_dexel::{Stock, TriDexels};
    /// let ball = Stock::Ball { centre: [0.0; 3], radius: 4.0 };
    /// let solid = TriDexels::new([-5.0; 3], [5.0; 3], [20; 3], &ball)?;
    /// let (mesh, ends) = solid.surface_with_ends()?;
    /// assert_eq!(ends.of_triangle.len(), mesh.triangles.len());
    /// assert!(ends.ends.iter().all(|end| (end.place.map(|c| c * c).iter().sum::<f64>() - 16.0).abs() < 1e-9));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn surface_with_ends(&self) -> Result<(Mesh, SurfaceEnds), MeshError> {
        contour::contour_with_ends(self, MOST_VERTICES)
    }

    /// For each vertex of a mesh of this material, the source of the surface there: for vertices marked as cut, the
    /// source of the nearest interval end in the three sets that a tool made; for the others, the stock.
    #[must_use]
    pub fn sources(&self, mesh: &Mesh) -> Vec<Source> {
        let [x, y, z] = &self.sets;
        sources_in(&[x, y, z], mesh)
    }

    /// The source of the surface at or near a point of the world: that of the nearest interval end in the three sets,
    /// if one is within `reach`.
    #[must_use]
    pub fn source_at(&self, point: impl Into<[f64; 3]>, reach: f64) -> Option<Source> {
        let point = point.into();
        let ends = self.sets.iter().filter_map(|set| set.nearest_end(point));
        let nearest = ends.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        (nearest.distance <= reach).then_some(nearest.end.source)
    }
}
