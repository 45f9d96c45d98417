//! What the result of a job is compared with, and what may differ.

use std::path::PathBuf;

use sweepsim_dexel::{Grid, TriangleSoup};

use super::place::Step;
use super::read::JobReader;
use super::schema;
use crate::dexels::{DexelFormat, read_dexels_file, read_tri_dexels_file};
use crate::error::{FormatError, Problem};
use crate::meshes::{Colour, parsed_colour};

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
#[derive(Clone, Copy, Debug, PartialEq)]
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
}

impl Target {
    /// A target from a file that has been read; `colours` may be shorter than there are triangles.
    #[must_use]
    pub fn new(file: PathBuf, mesh: TriangleSoup, colours: Vec<Option<Colour>>) -> Self {
        Self { file, mesh, colours }
    }

    /// The surface by region: first what is in none, then each region. Triangles that cross the sides of a box are cut.
    #[must_use]
    pub fn by_region(&self, limits: &Limits) -> Vec<TriangleSoup> {
        let mut rest = self.mesh.clone();
        let mut colours = self.colours.clone();
        let mut parts = Vec::with_capacity(limits.regions.len() + 1);
        for region in &limits.regions {
            let mut own = TriangleSoup::default();
            let (mut other, mut other_colours) = (TriangleSoup::default(), Vec::new());
            for (number, triangle) in rest.triangles.iter().enumerate() {
                let colour = colours.get(number).copied().flatten();
                let [mut inside, mut outside] = match region.place {
                    RegionPlace::Colour(wanted) => {
                        let one = TriangleSoup {
                            triangles: vec![*triangle],
                        };
                        let none = TriangleSoup::default();
                        if colour == Some(wanted) {
                            [one, none]
                        } else {
                            [none, one]
                        }
                    }
                    RegionPlace::Box { min, max } => {
                        let one = TriangleSoup {
                            triangles: vec![*triangle],
                        };
                        one.split_by_box(min, max)
                    }
                };
                own.triangles.append(&mut inside.triangles);
                other_colours.extend(outside.triangles.iter().map(|_| colour));
                other.triangles.append(&mut outside.triangles);
            }
            (rest, colours) = (other, other_colours);
            parts.push(own);
        }
        parts.insert(0, rest);
        parts
    }
}

impl JobReader<'_> {
    pub(super) fn target(&self, raw: &schema::Job, grid: &Grid) -> Result<Option<Target>, FormatError> {
        Ok(match &raw.target {
            None => None,
            Some(schema::Target::Mesh(name)) => {
                let (mesh, colours) = self.mesh(name, "target", &["target".into()])?;
                let file = self.beside(name, &["target".into()])?;
                Some(Target { file, mesh, colours })
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
        Ok(Target {
            file,
            mesh: surface.soup().unwrap_or_default(),
            colours: Vec::new(),
        })
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
                    "no surface of the target is left for region {}: expected a box or a colour of it",
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
        match (&raw.within, &raw.colour) {
            (Some(schema::RegionBox::Block { min, max }), None) => {
                for k in 0..3 {
                    let expected = format!("greater than that of min, {}", min[k]);
                    let what = format!("the {} of max", ['x', 'y', 'z'][k]);
                    let good = min[k] < max[k] && (min[k] * self.unit).is_finite();
                    self.check(&what, max[k], good, &expected, &steps("within"))?;
                }
                let [min, max] = [min, max].map(|corner| corner.map(|c| c * self.unit));
                Ok(RegionPlace::Box { min, max })
            }
            (None, Some(text)) => parsed_colour(text).map(RegionPlace::Colour).ok_or_else(|| {
                let problem = Problem::value("the colour of a region", format!("{text:?}"), "one like \"#ff8000\"");
                self.error(problem, &steps("colour"))
            }),
            _ => {
                let problem = Problem::syntax("a region has one place: expected `within` or `colour`");
                Err(self.error(problem, at))
            }
        }
    }
}
