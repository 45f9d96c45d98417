//! Parts from files, as meshes or dexels, and pictures of them.

use super::words::length;
use super::{Failure, check_room};
use crate::arguments::{GridOptions, ViewOptions};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::Path;
use sweepsim_dexel::{Dexels, Grid, Mesh, MeshError, Stock, TriDexels, TriangleSoup};
use sweepsim_formats::{
    DexelFormat, Job, MeshFormat, is_dexels_csv, read_dexels_file, read_mesh_file, read_tri_dexels_file,
};
use sweepsim_picture::{CuttingPlane, Drawing, Image, View, legend};

/// The default number of dexels along the longer side of a mesh.
const CELLS: f64 = 300.0;
/// Cosine of 40°: sharper edges of meshes from files, or of tri-dexels, are drawn sharp.
pub(crate) const CRISP: f64 = 0.766;

/// The content of a file.
pub(crate) enum Solid {
    Mesh(Mesh),
    Dexels(Dexels),
    TriDexels(Box<TriDexels>),
}

/// The kind of a file by its extension, and by its first line for tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Job,
    Mesh,
    Dexels,
    /// Tools of CAM systems and controls.
    Tools,
    /// A path, or anything else, which the path reader then reports.
    Path,
}

impl Kind {
    /// The kind of a file.
    pub fn of(file: &Path) -> Result<Self, Failure> {
        let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        if extension.as_deref() == Some("ron") {
            return Ok(Self::Job);
        }
        if matches!(
            extension.as_deref(),
            Some("json" | "fctb" | "fctl" | "tbl" | "camotics")
        ) {
            return Ok(Self::Tools);
        }
        if MeshFormat::of(file).is_some() {
            return Ok(Self::Mesh);
        }
        Ok(match DexelFormat::of(file) {
            Some(DexelFormat::Csv) if !is_dexels_csv(file)? => Self::Path,
            Some(_) => Self::Dexels,
            None => Self::Path,
        })
    }
}

impl Solid {
    /// Reads a mesh or dexels; tables of dexels are placed on `grid`.
    pub fn read(file: &Path, grid: Option<&Grid>) -> Result<Self, Failure> {
        match Kind::of(file)? {
            Kind::Mesh => Ok(Self::Mesh(read_mesh_file(file)?)),
            Kind::Dexels if grid.is_none() && DexelFormat::of(file) == Some(DexelFormat::Csv) => {
                Err(Failure::message(format!(
                    "{}: a table of dexels does not contain its grid: expected --grid with the job, or --area and --cells",
                    file.display()
                )))
            }
            Kind::Dexels if DexelFormat::of(file) == Some(DexelFormat::Tri) => {
                Ok(Self::TriDexels(read_tri_dexels_file(file)?.into()))
            }
            Kind::Dexels => Ok(Self::Dexels(read_dexels_file(file, grid)?)),
            // Says what to do about STEP files.
            Kind::Path if is_step(file) => Ok(Self::Mesh(read_mesh_file(file)?)),
            Kind::Job | Kind::Tools | Kind::Path => Err(Failure::message(format!(
                "{}: expected a mesh (.stl .ply .glb .3mf .vtp) or dexels (dexels.csv .dexels .tridexels .npz)",
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

    /// A mesh as dexels on a grid; dexels are returned as they are, of three sets the one along z.
    pub fn dexels(&self, file: &Path, grid: &Grid) -> Result<Dexels, Failure> {
        check_room(grid, "")?;
        match self {
            Self::Dexels(dexels) => Ok(dexels.clone()),
            Self::TriDexels(solid) => Ok(solid.sets()[2].clone()),
            Self::Mesh(mesh) => Stock::Mesh(soup(mesh))
                .dexels(grid)
                .map_err(|error| Failure::message(format!("{}: {error}", file.display()))),
        }
    }
}

/// A mesh of fewer triangles, nowhere further than `deviation` from this one; the same mesh without one. A note says if none was found.
pub(crate) fn decimated(mesh: &Mesh, deviation: Option<f64>) -> Result<(Cow<'_, Mesh>, Option<String>), MeshError> {
    let Some(deviation) = deviation else {
        return Ok((Cow::Borrowed(mesh), None));
    };
    let small = mesh.decimated(deviation)?;
    let note = (small.triangles.len() >= mesh.triangles.len()).then(|| {
        format!("--decimate: no smaller mesh within {deviation} mm of the surface was found: all triangles are kept")
    });
    Ok((Cow::Owned(small.crisp(CRISP)?), note))
}

fn is_step(file: &Path) -> bool {
    let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    matches!(extension.as_deref(), Some("step" | "stp"))
}

/// The triangles of a mesh; readers have checked that their vertices exist.
pub(crate) fn soup(mesh: &Mesh) -> TriangleSoup {
    mesh.soup().unwrap_or_default()
}

/// The lower and upper corners of a mesh's bounding box, unless it is empty.
pub(crate) fn bounds(mesh: &Mesh) -> Option<[[f64; 3]; 2]> {
    let corners = mesh
        .triangles
        .iter()
        .flatten()
        .filter_map(|v| mesh.vertices.get(*v as usize));
    corners.fold(None, |range, p| {
        let [low, high] = range.unwrap_or([*p; 2]);
        Some([
            [0, 1, 2].map(|k| low[k].min(p[k])),
            [0, 1, 2].map(|k| high[k].max(p[k])),
        ])
    })
}

impl GridOptions {
    /// The grid given by the options. Without an area, it covers `around`, if known.
    pub fn grid(&self, around: Option<[[f64; 3]; 2]>) -> Result<Option<Grid>, Failure> {
        let failed = |error| Failure::message(format!("the grid: {error}"));
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
            return Err(Failure::message("--area: expected --cells beside it"));
        }
        let size = [0, 1].map(|k: usize| max[k] - min[k]);
        let step = size[0].max(size[1]) / CELLS;
        let cells = self
            .cells
            .unwrap_or_else(|| size.map(|s| (s / step).round().max(1.0) as usize));
        Grid::new(min, max, cells).map(Some).map_err(failed)
    }
}

/// The picture of a part as PNG: coloured by what made its faces, or by a value per vertex on a scale of plus and minus a range.
///
/// A section that does not meet the part is left out, and said in the list. The picture is given up, as an interruption, if `go_on`
/// breaks.
pub(crate) fn picture(
    options: &ViewOptions,
    mesh: &Mesh,
    values: Option<(&[f32], f64)>,
    go_on: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
) -> Result<(Vec<u8>, Vec<String>), Failure> {
    let (sections, missed) = meeting(&options.section, bounds(mesh));
    let mut view = view(options);
    let mut drawing = Drawing::new(mesh).sections(&sections);
    if let Some((values, range)) = values {
        view.legend = legend::WIDTH;
        drawing = drawing.values(values, range as f32);
    }
    let mut image = view.draw_while(&drawing, go_on).ok_or_else(Failure::interrupted)?;
    if let Some((_, range)) = values {
        legend::draw(&mut image, range as f32);
    }
    Ok((png(&image)?, missed))
}

/// The picture of a part and perhaps a tool as PNG, from where the box `whole` fills the image.
pub(crate) fn frame_picture(
    options: &ViewOptions,
    mesh: &Mesh,
    tool: Option<&Mesh>,
    whole: [[f64; 3]; 2],
    go_on: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
) -> Result<Vec<u8>, Failure> {
    let (sections, _) = meeting(&options.section, Some(whole));
    let drawing = Drawing::new(mesh).sections(&sections).within(whole);
    let drawing = match tool {
        Some(tool) => drawing.tool(tool),
        None => drawing,
    };
    let image = view(options).draw_while(&drawing, go_on);
    png(&image.ok_or_else(Failure::interrupted)?)
}

fn view(options: &ViewOptions) -> View {
    let mut view = options.camera;
    view.size = options.size;
    view.axes = !options.no_axes;
    view
}

fn png(image: &Image) -> Result<Vec<u8>, Failure> {
    let png = image.png();
    png.map_err(|error| Failure::message(format!("cannot make the picture: {error}")))
}

/// The sections that meet a part with these corners, and what is to be said of the others.
fn meeting(sections: &[CuttingPlane], part: Option<[[f64; 3]; 2]>) -> (Vec<CuttingPlane>, Vec<String>) {
    let Some([low, high]) = part else {
        return (sections.to_vec(), Vec::new());
    };
    let (mut all, mut missed) = (Vec::new(), Vec::new());
    for section in sections {
        let (from, to) = (low[section.axis.index()], high[section.axis.index()]);
        if from < section.at && section.at < to {
            all.push(*section);
        } else {
            let axis = ["x", "y", "z"][section.axis.index()];
            let [at, from, to] = [section.at, from, to].map(length);
            missed.push(format!(
                "--section {axis}={at} does not meet the part, which is from {from} to {to}: the picture is without it"
            ));
        }
    }
    (all, missed)
}
