//! The part that is wanted, and how far it may be cut into.

use std::sync::Arc;
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
    shape: TargetShape,
}

/// What of a target does not depend on the grid.
#[derive(Clone, Debug)]
pub struct TargetShape(Arc<Shape>);

#[derive(Debug)]
struct Shape {
    mesh: TriangleSoup,
    distance: DistanceTo,
    /// The surface outside all regions, then that of each region.
    parts: Vec<TargetRegion>,
    /// From each of them; none if there are no regions.
    distances: Vec<DistanceTo>,
}

/// A region of a target's surface with limits of its own.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TargetRegion {
    /// Its part of the surface. It need not be closed.
    pub surface: TriangleSoup,
    /// The limits for gouges and for excess.
    pub limits: [f64; 2],
}

impl TargetRegion {
    /// A part of the surface, and its limits for gouges and for excess.
    #[must_use]
    pub fn new(surface: TriangleSoup, limits: [f64; 2]) -> Self {
        Self { surface, limits }
    }
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

impl TargetShape {
    /// That of [`Target::with_regions`].
    ///
    /// # Errors
    /// Those of it that do not depend on the grid.
    pub fn new(mesh: &TriangleSoup, rest: TargetRegion, regions: &[TargetRegion]) -> Result<Self, TargetError> {
        let all = || std::iter::once(&rest).chain(regions);
        for (name, value) in all().flat_map(|part| [("gouges", part.limits[0]), ("excess", part.limits[1])]) {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(TargetError::Limit { name, value });
            }
        }
        let parts: Vec<TargetRegion> = all().cloned().collect();
        let distances = parts.iter().filter(|_| !regions.is_empty());
        let distances = distances.map(|part| DistanceTo::new(&part.surface));
        let shape = Shape {
            distance: DistanceTo::new(mesh)?,
            distances: distances.collect::<Result<_, MeshError>>()?,
            mesh: mesh.clone(),
            parts,
        };
        Ok(Self(Arc::new(shape)))
    }

    /// The target on the lines of a grid.
    ///
    /// # Errors
    /// Those of [`Target::new`].
    pub fn on(&self, grid: &Grid) -> Result<Target, TargetError> {
        let shape = &self.0;
        let solid = Stock::Mesh(shape.mesh.clone()).dexels(grid)?;
        let (mut core, mut allowed) = (solid.clone(), solid.clone());
        for part in &shape.parts {
            let [gouge, excess] = part.limits;
            if gouge > 0.0 {
                core.combine(Operation::Difference, &part.surface.thickened(grid, gouge))?;
            }
            if excess > 0.0 {
                allowed.combine(Operation::Union, &part.surface.thickened(grid, excess))?;
            }
        }
        self.known([solid, core, allowed])
    }

    /// The target on the lines of a grid if what is there is known: [`Target::solid`], [`Target::core`] and [`Target::allowed`] as they were made before. Nothing is computed anew.
    ///
    /// # Errors
    /// [`TargetError::Grid`] if the three have different grids.
    pub fn known(&self, [solid, core, allowed]: [Dexels; 3]) -> Result<Target, TargetError> {
        if solid.grid() != core.grid() || solid.grid() != allowed.grid() {
            return Err(GridMismatch.into());
        }
        Ok(Target {
            solid,
            core,
            allowed,
            shape: self.clone(),
        })
    }
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
        Self::with_regions(mesh, grid, TargetRegion::new(mesh.clone(), [gouge, excess]), &[])
    }

    /// A closed mesh as a target, some regions of which have limits of their own. `rest` is what of its surface is in no region.
    ///
    /// Each limit holds about its own part of the surface: what is allowed is the union of all balls about points of the surface, each with the radius of the part to which the point
    /// belongs. So along the border of a region, up to the larger of both limits away from it, the larger one holds.
    ///
    /// # Errors
    /// [`TargetError`]
    pub fn with_regions(
        mesh: &TriangleSoup,
        grid: &Grid,
        rest: TargetRegion,
        regions: &[TargetRegion],
    ) -> Result<Self, TargetError> {
        TargetShape::new(mesh, rest, regions)?.on(grid)
    }

    /// The same target on another grid, such as a tile.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn on(&self, grid: &Grid) -> Result<Self, TargetError> {
        self.shape.on(grid)
    }

    /// The same on a tile of its grid: what [`on`](Self::on) would compute. `None` if it is none.
    #[must_use]
    pub fn tile(&self, tile: &Grid) -> Option<Self> {
        Some(Self {
            solid: self.solid.tile(tile)?,
            core: self.core.tile(tile)?,
            allowed: self.allowed.tile(tile)?,
            shape: self.shape.clone(),
        })
    }

    /// Whether a point at a (signed) distance from the surface is beyond the limit, which is that of any part of the surface.
    pub(super) fn is_beyond(&self, place: [f64; 3], distance: f64) -> bool {
        let side = usize::from(distance >= 0.0);
        let Shape { parts, distances, .. } = &*self.shape.0;
        if distances.is_empty() {
            return distance.abs() > parts[0].limits[side];
        }
        let within = |(part, to): (&TargetRegion, &DistanceTo)| {
            let near = to.nearest(place);
            near.is_some_and(|near| near.distance.abs() <= part.limits[side])
        };
        !parts.iter().zip(distances).any(within)
    }

    /// The part of the surface nearest to a point: 0 outside all regions, or 1 plus the number of a region.
    pub(super) fn part_at(&self, place: [f64; 3]) -> usize {
        let mut best = (f64::INFINITY, 0);
        for (number, to) in self.shape.0.distances.iter().enumerate() {
            let near = to.nearest(place).map_or(f64::INFINITY, |near| near.distance.abs());
            if near < best.0 {
                best = (near, number);
            }
        }
        best.1
    }

    /// What does not depend on the grid.
    #[must_use]
    pub fn shape(&self) -> &TargetShape {
        &self.shape
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

    /// The limits for gouges and for excess, outside all regions.
    #[must_use]
    pub fn limits(&self) -> [f64; 2] {
        self.shape.0.parts[0].limits
    }

    /// Distances from its surface.
    #[must_use]
    pub fn distance(&self) -> &DistanceTo {
        &self.shape.0.distance
    }
}
