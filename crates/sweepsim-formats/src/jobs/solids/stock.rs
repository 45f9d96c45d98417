//! The stock of a job, and other solids from files.

use std::sync::Arc;

use sweepsim_dexel::{Grid, Stock, TriangleSoup};
use sweepsim_nc::Note;

use crate::dexels::{DexelFormat, read_dexels_file, read_tri_dexels_file};
use crate::error::{FormatError, Problem};
use crate::jobs::judging::TargetFaces;
use crate::jobs::place::Step;
use crate::jobs::read::JobReader;
use crate::jobs::schema;
use crate::meshes::{Colour, MeshFormat, read_coloured_mesh_file, read_step, read_stl};

/// Triangles, the colour of each, and the faces of a STEP file.
type FileMesh = (TriangleSoup, Vec<Option<Colour>>, Option<TargetFaces>);

impl JobReader<'_> {
    /// The stock, or a part of it, that the steps lead to.
    pub(crate) fn stock(&self, raw: &schema::Stock, at: &[Step], grid: &Grid) -> Result<Stock, FormatError> {
        let scale = |point: [f64; 3]| point.map(|c| c * self.unit);
        let steps = |name: &str, k: Option<usize>| -> Vec<Step> {
            let more = [Some(name.into()), k.map(Step::Item)].into_iter().flatten();
            at.iter().cloned().chain(more).collect()
        };
        let finite = |name: &str, point: [f64; 3]| {
            (0..3).try_for_each(|k| self.check(name, point[k], true, "finite", &steps(name, Some(k))))
        };
        // The solids of a list that is item `place` of its parent.
        let list = |parts: &[schema::Stock], place: usize| -> Result<Vec<Stock>, FormatError> {
            let each = parts.iter().enumerate().map(|(k, part)| {
                let steps: Vec<Step> = at.iter().cloned().chain([Step::Item(place), Step::Item(k)]).collect();
                self.stock(part, &steps, grid)
            });
            each.collect()
        };
        match *raw {
            schema::Stock::Block { min, max } => {
                finite("min", min)?;
                finite("max", max)?;
                for k in 0..3 {
                    let expected = format!("greater than that of min, {}", min[k]);
                    let what = format!("the {} of max", ['x', 'y', 'z'][k]);
                    self.check(&what, max[k], min[k] < max[k], &expected, &steps("max", Some(k)))?;
                }
                Ok(Stock::Block {
                    min: scale(min),
                    max: scale(max),
                })
            }
            schema::Stock::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                finite("base", base)?;
                finite("axis", axis)?;
                if axis == [0.0; 3] {
                    let problem = Problem::value("axis", "zero", "a direction, such as (0, 0, 1)");
                    return Err(self.error(problem, &steps("axis", None)));
                }
                self.check("radius", radius, radius > 0.0, "positive", &steps("radius", None))?;
                self.check("height", height, height > 0.0, "positive", &steps("height", None))?;
                Ok(Stock::Cylinder {
                    base: scale(base),
                    axis,
                    radius: radius * self.unit,
                    height: height * self.unit,
                })
            }
            schema::Stock::Ball { centre, radius } => {
                finite("centre", centre)?;
                self.check("radius", radius, radius > 0.0, "positive", &steps("radius", None))?;
                Ok(Stock::Ball {
                    centre: scale(centre),
                    radius: radius * self.unit,
                })
            }
            schema::Stock::Mesh(ref name) => Ok(Stock::Mesh(self.mesh(name, "stock", at)?.0)),
            schema::Stock::Dexels(ref name) => self.dexels(name, at, grid),
            schema::Stock::Union(ref parts) => Ok(Stock::Union(list(parts, 0)?)),
            schema::Stock::Intersection(ref parts) => Ok(Stock::Intersection(list(parts, 0)?)),
            schema::Stock::Difference(ref whole, ref parts) => {
                let steps: Vec<Step> = at.iter().cloned().chain([Step::Item(0)]).collect();
                let whole = self.stock(whole, &steps, grid)?;
                Ok(Stock::Difference(whole.into(), list(parts, 1)?))
            }
        }
    }

    /// The result of an earlier run, in millimetres like all its outputs.
    fn dexels(&self, name: &str, steps: &[Step], grid: &Grid) -> Result<Stock, FormatError> {
        let file = self.beside(name, steps)?;
        let (found, stock) = if DexelFormat::of(&file) == Some(DexelFormat::Tri) {
            let sets = self
                .named(read_tri_dexels_file(&file), &file, "stock", steps)?
                .into_sets();
            (*sets[2].grid(), Stock::TriDexels(Arc::new(sets)))
        } else {
            let dexels = self.named(read_dexels_file(&file, Some(grid)), &file, "stock", steps)?;
            (*dexels.grid(), Stock::Dexels(Arc::new(dexels)))
        };
        if found == *grid {
            return Ok(stock);
        }
        let words = |grid: &Grid| {
            let ([x0, y0], [x1, y1], [nx, ny]) = (grid.min(), grid.max(), grid.cells());
            let frame = if grid.frame().is_world() { "" } else { " in a frame" };
            format!("{nx} x {ny} dexels from ({x0}, {y0}) to ({x1}, {y1}) mm{frame}")
        };
        let what = format!("the grid of {name}");
        Err(self.error(
            Problem::value(what, words(&found), format!("that of the job, {}", words(grid))),
            steps,
        ))
    }

    /// The triangles of a file that the job names, in millimetres, and their colours.
    pub(crate) fn mesh(
        &self,
        name: &str,
        what: &'static str,
        steps: &[Step],
    ) -> Result<(TriangleSoup, Vec<Option<Colour>>), FormatError> {
        self.mesh_with_faces(name, what, steps)
            .map(|(mesh, colours, _)| (mesh, colours))
    }

    /// The same, with the faces of a STEP file.
    pub(crate) fn mesh_with_faces(
        &self,
        name: &str,
        what: &'static str,
        steps: &[Step],
    ) -> Result<FileMesh, FormatError> {
        let file = self.beside(name, steps)?;
        if MeshFormat::of(&file) == Some(MeshFormat::Step) {
            // Its unit is in the file.
            let part = self.named(read_step(&file, self.chord), &file, what, steps)?;
            let line = self.position(self.node(steps).span.clone()).line;
            let near = format!(
                "the largest distance of its triangles from its faces that was found is {:.1e} mm",
                part.deviation
            );
            let notes = std::iter::once(&near).chain(&part.notes);
            let notes = notes.map(|note| Note::new(line, format!("the {what} {name}: {note}")));
            self.read.borrow_mut().extend(notes);
            let colours = part.colours();
            let faces = TargetFaces::of(&part);
            return Ok((part.mesh.soup().unwrap_or_default(), colours, Some(faces)));
        }
        let (mesh, colours) = if MeshFormat::of(&file) == Some(MeshFormat::Stl) {
            (self.named(read_stl(&file), &file, what, steps)?, Vec::new())
        } else {
            let (mesh, colours) = self.named(read_coloured_mesh_file(&file), &file, what, steps)?;
            (mesh.soup().unwrap_or_default(), colours)
        };
        let mesh = if self.unit == 1.0 {
            mesh
        } else {
            let scaled = mesh.triangles.iter().map(|t| t.map(|p| p.map(|c| c * self.unit)));
            TriangleSoup {
                triangles: scaled.collect(),
            }
        };
        Ok((mesh, colours, None))
    }
}
