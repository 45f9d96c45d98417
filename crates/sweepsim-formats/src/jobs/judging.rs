//! What the result of a job is compared with, and what may differ.

use std::path::PathBuf;

use sweepsim_dexel::{FaceSurfaces, Grid, TriangleSoup};

use super::place::Step;
use super::read::JobReader;
use super::schema;
use crate::dexels::{DexelFormat, read_dexels_file, read_tri_dexels_file};
use crate::error::{FormatError, Problem};
use crate::meshes::{Colour, StepFace, StepPart, parsed_colour};

/// The corners of a triangle.
type Corners = [[f64; 3]; 3];

/// The design part of a job.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Target {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub mesh: TriangleSoup,
    /// The colour of each triangle, if it has one.
    pub colours: Vec<Option<Colour>>,
    /// The faces of a STEP file.
    pub faces: Option<TargetFaces>,
}

/// The faces of a target that is a STEP file.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TargetFaces {
    /// The faces, with their names and colours.
    pub faces: Vec<StepFace>,
    /// Which triangles are theirs, and what they approximate.
    pub surfaces: FaceSurfaces,
}

impl TargetFaces {
    /// Those of a file.
    #[must_use]
    pub fn of(part: &StepPart) -> Self {
        Self {
            faces: part.faces.clone(),
            surfaces: part.surfaces(),
        }
    }

    /// The face of a triangle.
    #[must_use]
    pub fn of_triangle(&self, triangle: usize) -> Option<&StepFace> {
        let face = *self.surfaces.face_of.get(triangle)? as usize;
        self.faces.get(face)
    }
}

/// How far a part may deviate from its target, in millimetres.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// The permitted depth of gouges.
    pub gouge: f64,
    /// The permitted height of remaining material.
    pub excess: f64,
    /// Regions with other limits. A place belongs to the first that holds it.
    pub regions: Vec<LimitRegion>,
}

impl Limits {
    /// The same limits everywhere.
    #[must_use]
    pub fn new(gouge: f64, excess: f64) -> Self {
        let regions = Vec::new();
        Self { gouge, excess, regions }
    }
}

/// A region of the target's surface with limits of its own.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LimitRegion {
    /// Its name: as given, or its number from 1.
    pub name: String,
    /// Which part of the surface it is.
    pub place: RegionPlace,
    /// The permitted depth of gouges.
    pub gouge: f64,
    /// The permitted height of remaining material.
    pub excess: f64,
}

/// A part of a surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RegionPlace {
    /// What is in a box along the axes.
    Box {
        /// Its lower corner.
        min: [f64; 3],
        /// Its upper corner.
        max: [f64; 3],
    },
    /// What has this colour.
    Colour(Colour),
    /// The faces of a STEP file with this name, or the one with this number, as `#123`.
    Face(String),
}

impl Target {
    /// A target from a file that has been read; `colours` may be shorter than there are triangles.
    #[must_use]
    pub fn new(file: PathBuf, mesh: TriangleSoup, colours: Vec<Option<Colour>>) -> Self {
        Self {
            file,
            mesh,
            colours,
            faces: None,
        }
    }

    /// The same with the faces of its STEP file.
    #[must_use]
    pub fn with_faces(mut self, faces: Option<TargetFaces>) -> Self {
        self.faces = faces;
        self
    }

    /// The surface by region: first what is in none, then each region. Triangles that cross the sides of a box are cut.
    #[must_use]
    pub fn by_region(&self, limits: &Limits) -> Vec<TriangleSoup> {
        // What is in no region yet, each with the number of its triangle.
        let mut rest: Vec<(usize, Corners)> = self.mesh.triangles.iter().copied().enumerate().collect();
        let mut parts = Vec::with_capacity(limits.regions.len() + 1);
        for region in &limits.regions {
            let (mut own, mut other) = (TriangleSoup::default(), Vec::with_capacity(rest.len()));
            for (number, triangle) in rest {
                let is_all = match &region.place {
                    RegionPlace::Colour(wanted) => self.colours.get(number) == Some(&Some(*wanted)),
                    RegionPlace::Face(wanted) => self.face(number).is_some_and(|face| face.is_called(wanted)),
                    RegionPlace::Box { min, max } => {
                        let one = TriangleSoup {
                            triangles: vec![triangle],
                        };
                        let [mut inside, outside] = one.split_by_box(*min, *max);
                        own.triangles.append(&mut inside.triangles);
                        other.extend(outside.triangles.into_iter().map(|triangle| (number, triangle)));
                        continue;
                    }
                };
                if is_all {
                    own.triangles.push(triangle);
                } else {
                    other.push((number, triangle));
                }
            }
            rest = other;
            parts.push(own);
        }
        let rest = TriangleSoup {
            triangles: rest.into_iter().map(|(_, triangle)| triangle).collect(),
        };
        parts.insert(0, rest);
        parts
    }
}

impl Target {
    /// The face of a triangle, if the target is a STEP file.
    #[must_use]
    pub fn face(&self, triangle: usize) -> Option<&StepFace> {
        self.faces.as_ref()?.of_triangle(triangle)
    }
}

impl JobReader<'_> {
    pub(super) fn target(&self, raw: &schema::Job, grid: &Grid) -> Result<Option<Target>, FormatError> {
        Ok(match &raw.target {
            None => None,
            Some(schema::Target::Mesh(name)) => {
                let (mesh, colours, faces) = self.mesh_with_faces(name, "target", &["target".into()])?;
                let file = self.beside(name, &["target".into()])?;
                Some(Target::new(file, mesh, colours).with_faces(faces))
            }
            Some(schema::Target::Dexels(name)) => Some(self.target_of_dexels(name, grid)?),
        })
    }

    /// The surface of the result of an earlier run, in millimetres like all its outputs.
    fn target_of_dexels(&self, name: &str, grid: &Grid) -> Result<Target, FormatError> {
        let steps = ["target".into()];
        let file = self.beside(name, &steps)?;
        let surface = if DexelFormat::of(&file) == Some(DexelFormat::Tri) {
            self.named(read_tri_dexels_file(&file), &file, "target", &steps)?
                .surface()
        } else {
            self.named(read_dexels_file(&file, Some(grid)), &file, "target", &steps)?
                .surface()
        };
        let surface = surface.map_err(|error| self.error(Problem::syntax(format!("{name}: {error}")), &steps))?;
        Ok(Target::new(file, surface.soup().unwrap_or_default(), Vec::new()))
    }

    /// The limits, for this target.
    pub(super) fn limits(&self, raw: &schema::Job, target: Option<&Target>) -> Result<Option<Limits>, FormatError> {
        let Some(limits) = &raw.limits else { return Ok(None) };
        let at: [Step; 1] = ["limits".into()];
        let [gouge, excess] = self.pair([limits.gouge, limits.excess], &at)?;
        let mut regions = Vec::with_capacity(limits.regions.len());
        for (number, raw) in limits.regions.iter().enumerate() {
            let at = [at[0].clone(), "regions".into(), Step::Item(number)];
            let [gouge, excess] = self.pair([raw.gouge, raw.excess], &at)?;
            let place = self.region_place(raw, &at)?;
            let name = raw.name.clone().unwrap_or_else(|| (number + 1).to_string());
            regions.push(LimitRegion {
                name,
                place,
                gouge,
                excess,
            });
        }
        let limits = Limits { gouge, excess, regions };
        // A region without surface would be a limit that is never looked at.
        if let Some(target) = target {
            let parts = target.by_region(&limits);
            let empty = parts.iter().skip(1).position(|part| part.triangles.is_empty());
            if let Some(number) = empty {
                let problem = Problem::syntax(format!(
                    "no surface of the target is left for region {}: expected a box, a colour or a face of it",
                    limits.regions[number].name
                ));
                return Err(self.error(problem, &[at[0].clone(), "regions".into(), Step::Item(number)]));
            }
        }
        Ok(Some(limits))
    }

    /// Gouge and excess, in millimetres.
    fn pair(&self, values: [f64; 2], at: &[Step]) -> Result<[f64; 2], FormatError> {
        for (name, value) in ["gouge", "excess"].into_iter().zip(values) {
            let steps: Vec<Step> = at.iter().cloned().chain([name.into()]).collect();
            self.check(name, value, value >= 0.0, "0 or greater", &steps)?;
        }
        Ok(values.map(|value| value * self.unit))
    }

    fn region_place(&self, raw: &schema::LimitRegion, at: &[Step]) -> Result<RegionPlace, FormatError> {
        let steps = |name: &str| -> Vec<Step> { at.iter().cloned().chain([name.into()]).collect() };
        match (&raw.within, &raw.colour, &raw.face) {
            (Some(schema::RegionBox::Block { min, max }), None, None) => {
                for k in 0..3 {
                    let expected = format!("greater than that of min, {}", min[k]);
                    let what = format!("the {} of max", ['x', 'y', 'z'][k]);
                    let good = min[k] < max[k] && (min[k] * self.unit).is_finite();
                    self.check(&what, max[k], good, &expected, &steps("within"))?;
                }
                let [min, max] = [min, max].map(|corner| corner.map(|c| c * self.unit));
                Ok(RegionPlace::Box { min, max })
            }
            (None, None, Some(name)) => Ok(RegionPlace::Face(name.clone())),
            (None, Some(text), None) => parsed_colour(text).map(RegionPlace::Colour).ok_or_else(|| {
                let problem = Problem::value("the colour of a region", format!("{text:?}"), "one like \"#ff8000\"");
                self.error(problem, &steps("colour"))
            }),
            _ => {
                let problem = Problem::syntax("a region has one place: expected `within`, `colour` or `face`");
                Err(self.error(problem, at))
            }
        }
    }
}
