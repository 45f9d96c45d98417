//! The part that is wanted, and how far it may be cut into.

use sweepsim_dexel::{Dexels, DistanceTo, Grid, GridMismatch, MeshError, Operation, Stock, StockError, TriangleSoup};
use thiserror::Error;

/// The part that is wanted, on the lines of a grid.
#[derive(Clone, Debug)]
pub struct Target {
    /// The part.
    solid: Dexels,
    /// What is deeper in the part than the limit for gouges.
    core: Dexels,
    /// The part, and what is nearer to it than the limit for excess.
    allowed: Dexels,
    distance: DistanceTo,
    /// For gouges and for excess.
    limits: [f64; 2],
}

/// Why a target is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TargetError {
    /// The triangles do not enclose a solid.
    #[error(transparent)]
    Solid(#[from] StockError),
    /// The triangles are invalid.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A limit is negative or not finite.
    #[error("the limit for {name} is {value}, but must be a finite number, zero or above")]
    Limit {
        /// Which limit.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// Grids differ.
    #[error(transparent)]
    Grid(#[from] GridMismatch),
}

impl Target {
    /// A closed mesh as a target. The limits are distances from its surface: material deeper inside than `gouge` must stay, material farther outside than
    /// `excess` must go. What the limits allow is exact on each line: the union of all balls of that radius about points of the surface.
    ///
    /// # Errors
    /// [`TargetError`]
    ///
    /// ```
    /// use sweepsim::dexel::{Grid, TriangleSoup};
    /// use sweepsim::verify::Target;
    /// let p = [[0.0; 3], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
    /// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v| p[v])).to_vec();
    /// let grid = Grid::new([-1.0, -1.0], [7.0, 7.0], [16, 16])?;
    /// let target = Target::new(&TriangleSoup { triangles }, &grid, 0.1, 0.2)?;
    /// assert!(target.core().volume() < target.solid().volume());
    /// assert!(target.solid().volume() < target.allowed().volume());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(mesh: &TriangleSoup, grid: &Grid, gouge: f64, excess: f64) -> Result<Self, TargetError> {
        for (name, value) in [("gouges", gouge), ("excess", excess)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(TargetError::Limit { name, value });
            }
        }
        let solid = Stock::Mesh(mesh.clone()).dexels(grid)?;
        let mut core = solid.clone();
        if gouge > 0.0 {
            core.combine(Operation::Difference, &mesh.thickened(grid, gouge))?;
        }
        let mut allowed = solid.clone();
        if excess > 0.0 {
            allowed.combine(Operation::Union, &mesh.thickened(grid, excess))?;
        }
        Ok(Self {
            solid,
            core,
            allowed,
            distance: DistanceTo::new(mesh)?,
            limits: [gouge, excess],
        })
    }

    /// The part.
    #[must_use]
    pub fn solid(&self) -> &Dexels {
        &self.solid
    }

    /// What is deeper in the part than the limit for gouges.
    #[must_use]
    pub fn core(&self) -> &Dexels {
        &self.core
    }

    /// The part, and what is nearer to it than the limit for excess.
    #[must_use]
    pub fn allowed(&self) -> &Dexels {
        &self.allowed
    }

    /// The limits for gouges and for excess.
    #[must_use]
    pub fn limits(&self) -> [f64; 2] {
        self.limits
    }

    /// Distances from its surface.
    #[must_use]
    pub fn distance(&self) -> &DistanceTo {
        &self.distance
    }
}
