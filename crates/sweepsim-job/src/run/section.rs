//! The curves in which a plane cuts what the tools of a job sweep.

use crate::base::{JobError, Sink, words};
use crate::session::{Plan, Session};
use std::fmt::Write as _;
use sweepsim::systems::Plane;
use sweepsim::{BoundaryPiece, Monitor, Section, section as cut_by_plane};

/// The section of what a job's tools sweep.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PlaneSection {
    /// The curves.
    pub section: Section,
    /// What is odd about the job or the plane, in words.
    pub warnings: Vec<String>,
    /// Notes of the job and of the files that it refers to.
    pub notes: Vec<String>,
}

impl Plan {
    /// Cuts the swept volume by a plane. Polylines are nowhere further than `chord` from the curves, in millimetres.
    ///
    /// # Errors
    /// [`JobError`]: a sweep fails, or [`JobError::Cancelled`].
    pub fn section(&self, plane: &Plane, chord: f64, monitor: &dyn Monitor) -> Result<PlaneSection, JobError> {
        let session = Session::new(self, monitor);
        session.phase("section");
        let sweeping = sweepsim::Options::new(self.job.tolerance);
        let section = cut_by_plane(&session.cuts(), plane, chord, &sweeping, monitor);
        let section = section.map_err(|error| session.failed(error))?;
        let mut warnings = self.warnings();
        warnings.extend(missed(plane, &section, session));
        let notes = self.notes();
        Ok(PlaneSection {
            section,
            warnings,
            notes,
        })
    }
}

impl PlaneSection {
    /// Whether every piece of the curves was found.
    #[must_use]
    pub fn is_certified(&self) -> bool {
        self.section.open.is_empty()
    }

    /// What is missing, in words.
    pub fn unresolved(&self) -> impl Iterator<Item = String> {
        let open = self.section.open.iter();
        open.map(|(path, piece, number)| format!("path {path}, move {number}: {}", name(*piece)))
    }

    /// Passes `section.svg` and `section.csv` to a sink.
    ///
    /// # Errors
    /// [`JobError`] of the sink.
    pub fn write_to(&self, sink: &mut dyn Sink) -> Result<(), JobError> {
        sink.write("section.svg", &mut |file| file.write_all(self.section.svg().as_bytes()))?;
        sink.write("section.csv", &mut |file| {
            file.write_all(table(&self.section).as_bytes())
        })
    }
}

/// A plane that does not meet what the tools sweep, and where that is.
fn missed(plane: &Plane, section: &Section, session: Session) -> Option<String> {
    if !section.curves.is_empty() {
        return None;
    }
    let normal = plane.normal();
    let boxes = session.cuts().into_iter().filter_map(|cut| cut.bounds());
    // The range of ⟨p, normal⟩ over a box.
    let ranges = boxes.map(|[low, high]| {
        let ends = [0, 1, 2].map(|k| [normal[k] * low[k], normal[k] * high[k]]);
        let sum = |pick: fn(f64, f64) -> f64| ends.iter().map(|[a, b]| pick(*a, *b)).sum::<f64>();
        [sum(f64::min), sum(f64::max)]
    });
    let [from, to] = ranges.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    let [x, y, z] = normal.map(words::length);
    Some(format!(
        "the section is empty: the plane lies at {}, what the tools sweep at {} … {} along ({x}, {y}, {z})",
        words::length(plane.offset()),
        words::length(from),
        words::length(to),
    ))
}

/// The name of a piece in `section.csv`.
fn name(piece: BoundaryPiece) -> String {
    match piece {
        BoundaryPiece::Patch(k) => format!("patch {k}"),
        BoundaryPiece::Edge(k) => format!("edge {k}"),
        BoundaryPiece::Placed(k) => format!("placed {k}"),
        BoundaryPiece::Last(k) => format!("last {k}"),
        _ => "other".to_owned(),
    }
}

/// One row per point, with numbers in the shortest form that reads back exactly.
fn table(section: &Section) -> String {
    let mut text = String::from("curve,path,move,t,piece,outer,x,y,z\n");
    for (number, curve) in section.curves.iter().enumerate() {
        for (point, outer) in curve.points.iter().zip(&curve.outer) {
            let [x, y, z] = point.position;
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{number},{},{},{},{},{},{x},{y},{z}",
                curve.cut,
                curve.segment,
                point.t,
                name(curve.piece),
                u8::from(*outer),
            );
        }
    }
    text
}
