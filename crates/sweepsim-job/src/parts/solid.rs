//! Parts from files, as meshes or dexels.

use crate::base::kind::Kind;
use crate::base::{JobError, check_room};
use crate::show::{CRISP, soup};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use sweepsim_dexel::{Dexels, Frame, Grid, Mesh, MeshError, Stock, Surface, TriDexels, TriangleSoup};
use sweepsim_formats::{DexelFormat, Job, TargetFaces, read_dexels_file, read_mesh_file, read_tri_dexels_file};

/// The default number of dexels along the longer side of a mesh.
const CELLS: f64 = 300.0;

/// The content of a file.
pub(crate) enum Solid {
    Mesh(Mesh),
    Dexels(Dexels),
    TriDexels(Box<TriDexels>),
}

impl Solid {
    /// Reads a mesh or dexels; tables of dexels are placed on `grid`.
    pub fn read(file: &Path, grid: Option<&Grid>) -> Result<Self, JobError> {
        match Kind::of(file)? {
            Kind::Mesh => Ok(Self::Mesh(read_mesh_file(file)?)),
            Kind::Dexels if grid.is_none() && DexelFormat::of(file) == Some(DexelFormat::Csv) => {
                Err(JobError::run(format!(
                    "{}: a table of dexels does not contain its grid: expected --grid with the job, or --area and --cells",
                    file.display()
                )))
            }
            Kind::Dexels if DexelFormat::of(file) == Some(DexelFormat::Tri) => {
                Ok(Self::TriDexels(read_tri_dexels_file(file)?.into()))
            }
            Kind::Dexels => Ok(Self::Dexels(read_dexels_file(file, grid)?)),
            Kind::Job | Kind::Tools | Kind::Path => Err(JobError::run(format!(
                "{}: expected a mesh (.stl .ply .glb .3mf .vtp .step) or dexels (dexels.csv .dexels .tridexels .npz)",
                file.display()
            ))),
        }
    }

    /// The grid of dexels.
    pub fn grid(&self) -> Option<Grid> {
        match self {
            Self::Dexels(dexels) => Some(*dexels.grid()),
            Self::TriDexels(solid) => Some(*solid.sets()[2].grid()),
            Self::Mesh(_) => None,
        }
    }

    /// The surface, with sharp edges drawn sharp.
    pub fn surface(&self) -> Result<Mesh, MeshError> {
        match self {
            Self::Dexels(dexels) => dexels.surface(),
            Self::TriDexels(solid) => solid.surface()?.crisp(CRISP),
            Self::Mesh(mesh) => mesh.crisp(CRISP),
        }
    }

    /// The surface as a file: its triangles enclose a solid.
    pub fn solid_surface(&self) -> Result<Mesh, MeshError> {
        match self {
            Self::TriDexels(solid) => solid.solid_surface()?.crisp(CRISP),
            Self::Dexels(_) | Self::Mesh(_) => self.surface(),
        }
    }

    /// The surface, to be compared: of a mesh as `triangles`, which are those of it, with its faces if they are known.
    pub fn to_compare<'a>(
        &'a self,
        triangles: &'a TriangleSoup,
        faces: Option<&'a TargetFaces>,
    ) -> Result<Surface<'a>, MeshError> {
        match (self, faces) {
            (Self::Dexels(dexels), _) => Surface::of_dexels(dexels),
            (Self::TriDexels(solid), _) => Surface::of_tri_dexels(solid),
            (Self::Mesh(_), Some(faces)) => Surface::of_faces(triangles, &faces.surfaces),
            (Self::Mesh(_), None) => Surface::of_triangles(triangles),
        }
    }

    /// The same solid, if its coordinates are those of `frame`; dexels stay as they are, as `None`.
    pub fn placed(&self, frame: &Frame) -> Option<Self> {
        let Self::Mesh(mesh) = self else { return None };
        let mut placed = mesh.clone();
        placed.vertices.iter_mut().for_each(|p| *p = frame.to_world(*p));
        for normal in &mut placed.normals {
            *normal = frame.turn_to_world(normal.map(f64::from)).map(|c| c as f32);
        }
        Some(Self::Mesh(placed))
    }

    /// A mesh as dexels on a grid; dexels are returned as they are, of three sets the one along z.
    pub fn dexels(&self, file: &Path, grid: &Grid) -> Result<Dexels, JobError> {
        check_room(grid, "")?;
        match self {
            Self::Dexels(dexels) => Ok(dexels.clone()),
            Self::TriDexels(solid) => Ok(solid.sets()[2].clone()),
            Self::Mesh(mesh) => Stock::Mesh(soup(mesh))
                .dexels(grid)
                .map_err(|error| JobError::run(format!("{}: {error}", file.display()))),
        }
    }
}

/// The grid of dexels, where their file does not contain it, or a mesh becomes dexels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct GridOptions {
    /// Uses the grid of this job or dexel file.
    pub grid: Option<PathBuf>,
    /// The area of the grid: x0, y0, x1, y1. Without one, that of the mesh, or of both meshes.
    pub area: Option<[f64; 4]>,
    /// The number of dexels. Without one, square cells, 300 along the longer side.
    pub cells: Option<[usize; 2]>,
}

impl GridOptions {
    /// The grid given by the options. Without an area, it covers `around`, if known.
    pub(crate) fn grid(&self, around: Option<[[f64; 3]; 2]>) -> Result<Option<Grid>, JobError> {
        let failed = |error| JobError::run(format!("the grid: {error}"));
        if let Some(file) = &self.grid {
            let grid = match Kind::of(file)? {
                Kind::Job => Job::read(file)?.grid,
                _ => *read_dexels_file(file, None)?.grid(),
            };
            let cells = self.cells.unwrap_or(grid.cells());
            return Grid::new(grid.min(), grid.max(), cells)
                .map(|made| Some(made.in_frame(*grid.frame())))
                .map_err(failed);
        }
        let area = match (self.area, around) {
            (Some([x0, y0, x1, y1]), _) => Some([[x0, y0], [x1, y1]]),
            (None, Some(bounds)) => Some(bounds.map(|[x, y, _]| [x, y])),
            (None, None) => None,
        };
        let Some([min, max]) = area else { return Ok(None) };
        if around.is_none() && self.cells.is_none() {
            return Err(JobError::request("area", "expected --cells beside it"));
        }
        let size = [0, 1].map(|k: usize| max[k] - min[k]);
        let step = size[0].max(size[1]) / CELLS;
        let cells = self
            .cells
            .unwrap_or_else(|| size.map(|s| (s / step).round().max(1.0) as usize));
        Grid::new(min, max, cells).map(Some).map_err(failed)
    }
}
