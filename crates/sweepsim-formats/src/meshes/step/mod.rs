//! STEP files (ISO 10303-21): boundary representations as triangles.
//!
//! ```text
//! text ──scan──▶ entities, their places ──rewritten──▶ library ──▶ faces, edges ──seams, build──▶ triangles per face
//!                     └──audit, copies, styles──▶ units, placements, bodies, colours ──┘──kernel──▶ StepPart
//! ```
//!
//! The library (kentron) reads geometry and topology, and triangulates each face between edges that its neighbours
//! share, so that solids close to the bit. What it passes over without a word is found here, by `audit`, `units` and
//! `kernel`.

#[cfg(feature = "step")]
mod audit;
#[cfg(feature = "step")]
mod build;
#[cfg(feature = "step")]
mod copies;
#[cfg(feature = "step")]
mod deviation;
#[cfg(feature = "step")]
mod fill;
#[cfg(feature = "step")]
mod kernel;
#[cfg(feature = "step")]
mod scan;
#[cfg(feature = "step")]
mod seams;
#[cfg(feature = "step")]
mod styles;
#[cfg(feature = "step")]
mod tori;
#[cfg(feature = "step")]
mod units;

use std::collections::BTreeMap;
use std::path::Path;

use sweepsim_dexel::{AnalyticSurface, FaceSurfaces, Mesh};

use crate::error::{FormatError, Problem};
use crate::meshes::Colour;
use crate::text::whole;

/// The chord error of a file that is read without limits, in millimetres: a twentieth of 0.1 mm.
pub const STEP_CHORD: f64 = 0.005;
/// The share of a limit that triangles may be from the surfaces of a file.
pub const STEP_SHARE: f64 = 0.05;
/// The name of the thread that reads: programs may keep its panics, which become errors, off the screen.
pub const THREAD: &str = "step";

/// The largest file, in bytes.
#[cfg(feature = "step")]
const LARGEST: u64 = 512 << 20;
/// The smallest chord error, in millimetres.
#[cfg(feature = "step")]
const FINEST: f64 = 1e-6;

/// What is in a STEP file.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct StepPart {
    /// All solids in their places, or all sheets if there is no solid, in millimetres.
    pub mesh: Mesh,
    /// For each triangle, the place of its face in `faces`.
    pub face_of: Vec<u32>,
    /// The faces of the mesh.
    pub faces: Vec<StepFace>,
    /// The bodies of the file, as often as they are placed.
    pub bodies: Vec<StepBody>,
    /// The schemas that the header names.
    pub schemas: Vec<String>,
    /// Millimetres per unit of length of the file.
    pub unit: f64,
    /// The chord error that was asked for, in millimetres.
    pub chord: f64,
    /// The largest distance found between triangles and surfaces, in millimetres.
    pub deviation: f64,
    /// What was left out, or is not as asked.
    pub notes: Vec<String>,
}

/// A face of a STEP file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepFace {
    /// Its number in the file.
    pub entity: usize,
    /// The place of its body in the list of bodies.
    pub body: usize,
    /// Its name, if it has one: names need not be unique.
    pub name: Option<String>,
    /// What it is part of: `plane`, `cylinder`, `cone`, `sphere`, `torus`, or another kind of surface.
    pub kind: &'static str,
    /// That surface, if it is one of the first five.
    pub surface: Option<AnalyticSurface>,
    /// Its colour, or that of its shell or body.
    pub colour: Option<Colour>,
}

/// A body of a STEP file, as it is placed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepBody {
    /// The names of the products that lead to it, and its own, joined by `/`.
    pub name: String,
    /// Its number in the file.
    pub entity: usize,
    /// Whether it is a solid; otherwise a sheet.
    pub solid: bool,
    /// The volume of a solid, from its surfaces, in cubic millimetres.
    pub volume: Option<f64>,
    /// How many faces of each kind.
    pub faces: BTreeMap<&'static str, usize>,
}

impl StepFace {
    /// A face of the first body, without a colour.
    #[must_use]
    pub fn new(entity: usize, name: Option<String>, kind: &'static str, surface: Option<AnalyticSurface>) -> Self {
        Self {
            entity,
            body: 0,
            name,
            kind,
            surface,
            colour: None,
        }
    }

    /// Whether this is its name, or its number in the file, as `#123`.
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        self.name.as_deref() == Some(name) || name.strip_prefix('#') == Some(&self.entity.to_string())
    }

    /// What it is called: by its name, or by its number in the file, as `#123`.
    #[must_use]
    pub fn label(&self) -> String {
        self.name.clone().unwrap_or_else(|| format!("#{}", self.entity))
    }
}

impl StepPart {
    /// The faces of the triangles with their surfaces.
    #[must_use]
    pub fn surfaces(&self) -> FaceSurfaces {
        let surfaces = self.faces.iter().map(|face| face.surface).collect();
        FaceSurfaces::new(self.face_of.clone(), surfaces, self.deviation.max(self.chord))
    }

    /// The colour of each triangle, if it has one.
    #[must_use]
    pub fn colours(&self) -> Vec<Option<Colour>> {
        self.face_of
            .iter()
            .map(|face| self.faces[*face as usize].colour)
            .collect()
    }
}

/// Reads the solids of a STEP file (AP203, AP214, AP242) as triangles that are within about `chord` millimetres of its
/// surfaces: [`StepPart::deviation`] says what was found. Each solid is closed.
///
/// # Errors
/// [`FormatError`] with the file's name, and the entity where there is one: the file cannot be read, has more than
/// 512 MiB, is incomplete, or has something that is not read; a solid does not close; this library was built without
/// its feature `step`.
pub fn read_step(file: &Path, chord: f64) -> Result<StepPart, FormatError> {
    #[cfg(feature = "step")]
    let read = whole::read(file, LARGEST).and_then(|text| parse_step(&text, chord));
    #[cfg(not(feature = "step"))]
    let read = whole::read(file, 0).and(parse_step(&[], chord));
    read.map_err(|error| error.in_file(file))
}

/// Reads the text of a STEP file; see [`read_step`].
///
/// # Errors
/// Those of [`read_step`], without the name.
pub fn parse_step(text: &[u8], chord: f64) -> Result<StepPart, FormatError> {
    #[cfg(feature = "step")]
    if chord >= FINEST {
        kernel::parse(text, chord)
    } else {
        let expected = format!("at least {FINEST} mm");
        Err(FormatError::new(
            Problem::value("the chord error of a STEP file", chord, expected),
            None,
        ))
    }
    #[cfg(not(feature = "step"))]
    {
        let _ = (text, chord);
        let instead = "build sweepsim with its feature `step`, or export a closed mesh";
        Err(FormatError::new(Problem::unsupported("STEP files are", instead), None))
    }
}
