//! Registration: the rigid motion that lays a part onto its target.
//!
//! ```text
//! mesh of the part ──samples──▶ points with normals ──best──▶ least squares of distances ──┐
//!                                      └──datum──▶ three planes, one after another ─────────┴──▶ Registration
//! ```

mod best;
mod datum;
mod motion;
mod samples;
#[cfg(test)]
mod tests;

use crate::base::JobError;
use best::{Counted, Fit, Target};
use datum::Datum;
use nalgebra::{Isometry3, Point3, Vector3};
use rayon::prelude::*;
use samples::Sample;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use sweepsim_dexel::{AnalyticSurface, DistanceTo, Frame, Mesh};
use sweepsim_formats::{ReportedAlignment, StepFace, TargetFaces};

/// Points of the part that are fitted.
const SAMPLES: usize = 20_000;
/// Points of dexels along one axis count where their faces are less steep than this: they do not tell where walls are.
const FLAT: f64 = 0.5;

/// How a part is laid onto its target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Alignment {
    /// The least squares of the distances of the part's surface from the target's.
    Best,
    /// The same of the part's points on planes and cylinders of the target, a STEP file, whatever the radii are.
    Features,
    /// Three-two-one by the names of three plane faces of the target, a STEP file.
    Datum([String; 3]),
}

impl FromStr for Alignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = |list: &str| -> Vec<String> { list.split(',').map(|name| name.trim().to_owned()).collect() };
        match (text, text.strip_prefix("datum=").map(names)) {
            ("best", _) => Ok(Self::Best),
            ("features", _) => Ok(Self::Features),
            (_, Some(names)) if names.iter().all(|name| !name.is_empty()) => {
                let names = <[String; 3]>::try_from(names);
                names
                    .map(Self::Datum)
                    .map_err(|names| format!("datum has {} faces: expected three", names.len()))
            }
            _ => Err("expected best, features, or datum=FACE,FACE,FACE".to_owned()),
        }
    }
}

/// Where a part lies on its target.
#[derive(Clone, Debug)]
pub(super) struct Registration {
    pub motion: Isometry3<f64>,
    pub report: ReportedAlignment,
}

impl Registration {
    /// The motion of the target onto the part.
    pub fn inverse(&self) -> Self {
        Self {
            motion: self.motion.inverse(),
            report: self.report.clone(),
        }
    }

    /// The frame whose coordinates are those of the part as it was.
    pub fn frame(&self) -> Result<Frame, JobError> {
        let axis = |axis: Vector3<f64>| (self.motion * axis).into();
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()].map(axis);
        let frame = Frame::from_axes((self.motion * Point3::origin()).coords.into(), axes);
        frame.map_err(|error| JobError::run(format!("the alignment: {error}")))
    }
}

/// Finds the motion from a part onto its target. `walls` says whether the part knows where its walls are.
pub(super) fn register(
    alignment: &Alignment,
    [part, goal]: [&Mesh; 2],
    walls: bool,
    faces: Option<&TargetFaces>,
) -> Result<Registration, JobError> {
    let wanted = |normal: &Vector3<f64>| walls || normal.z.abs() > FLAT;
    let samples = samples::spread(part, SAMPLES, wanted);
    if samples.len() < 3 {
        return Err(JobError::run("nothing of the part can be aligned: expected a surface"));
    }
    let tree = DistanceTo::new(&goal.soup().unwrap_or_default())?;
    let tree = match faces {
        Some(faces) => tree.with_surfaces(faces.surfaces.clone()),
        None => tree,
    };
    let needs = |what: &str| {
        faces.ok_or_else(|| {
            JobError::request(
                "align",
                format!("{what} needs the faces of a STEP file: the target is none"),
            )
        })
    };
    let best = || best::best(&tree, &samples, &samples::spread(goal, SAMPLES / 10, |_| true));
    let (kind, fit, datums) = match alignment {
        Alignment::Best => ("best", best(), Vec::new()),
        Alignment::Features => {
            let counted = Counted::Features(&needs("features")?.surfaces);
            let start = best();
            let fit = Target { tree: &tree, counted }.fit(&samples, start.motion, best::LAST);
            if fit.count < 3 {
                return Err(JobError::request(
                    "align",
                    "no plane or cylinder of the target is near the part: expected some",
                ));
            }
            ("features", fit, Vec::new())
        }
        Alignment::Datum(names) => {
            let start = best().motion;
            let planes = planes(needs("datum")?, names)?;
            let near = |motion: &Isometry3<f64>| {
                let datums = near_planes(&samples, motion, &tree, &planes, needs("datum")?);
                datum::check(&datums).map_err(|why| JobError::request("align", why))?;
                Ok::<_, JobError>(datums)
            };
            // Which points belong to which plane may change once they lie on them.
            let motion = datum::lay(&near(&start)?) * start;
            let datums = near(&motion)?;
            let step = datum::lay(&datums);
            let left = datum::left(&datums, step);
            let motion = step * motion;
            ("datum", Fit { motion, ..left }, names.to_vec())
        }
    };
    Ok(Registration {
        motion: fit.motion,
        report: reported(kind, &fit, datums),
    })
}

/// A plane of the target: what it is called, which faces are in it, a point of it and its normal.
struct Plane {
    name: String,
    faces: Vec<u32>,
    origin: Point3<f64>,
    normal: Vector3<f64>,
}

/// The planes of three faces. A name may be that of several faces if they are in one plane.
fn planes(faces: &TargetFaces, names: &[String; 3]) -> Result<[Plane; 3], JobError> {
    let refuse = |why: String| JobError::request("align", why);
    let plane = |name: &String| {
        let own = faces.faces.iter().enumerate().filter(|(_, face)| face.is_called(name));
        let own: Vec<(u32, &StepFace)> = own.map(|(number, face)| (number as u32, face)).collect();
        let Some((_, first)) = own.first() else {
            let mut known: Vec<String> = faces
                .faces
                .iter()
                .filter(|face| face.kind == "plane")
                .map(StepFace::label)
                .collect();
            known.truncate(NAMED);
            return Err(refuse(format!(
                "the target has no face {name}: expected one like {}",
                known.join(", ")
            )));
        };
        let Some(AnalyticSurface::Plane { origin, normal }) = first.surface else {
            return Err(refuse(format!("face {name} is a {}: expected a plane", first.kind)));
        };
        let (origin, normal) = (Point3::from(origin), Vector3::from(normal));
        let is_in = |face: &StepFace| match face.surface {
            Some(AnalyticSurface::Plane { origin: o, normal: n }) => {
                let off = normal.dot(&(Point3::from(o) - origin)).abs();
                off <= ONE_PLANE && normal.cross(&Vector3::from(n)).norm() <= ONE_PLANE
            }
            _ => false,
        };
        if !own.iter().all(|(_, face)| is_in(face)) {
            let numbers: Vec<String> = own.iter().map(|(_, face)| format!("#{}", face.entity)).collect();
            let numbers = numbers.join(", ");
            return Err(refuse(format!(
                "{} faces are called {name}, in several planes: expected one of {numbers}",
                own.len()
            )));
        }
        Ok(Plane {
            name: name.clone(),
            faces: own.iter().map(|(number, _)| *number).collect(),
            origin,
            normal,
        })
    };
    let [a, b, c] = names;
    Ok([plane(a)?, plane(b)?, plane(c)?])
}

/// The planes with the points of the part that are nearest to their faces, where a motion takes these.
fn near_planes(
    samples: &[Sample],
    motion: &Isometry3<f64>,
    tree: &DistanceTo,
    planes: &[Plane; 3],
    faces: &TargetFaces,
) -> [Datum; 3] {
    let near = |sample: &Sample| -> Option<(Sample, u32, Vector3<f64>)> {
        let (place, normal) = (motion * sample.place, motion * sample.normal);
        let near = tree.nearest_facing(place.coords.into(), normal.into(), f64::INFINITY)?;
        let outwards = Vector3::from(near.normal);
        // A point beside the edge of a face is none of it.
        let beside = (Point3::from(near.place) - place).cross(&outwards).norm() > 1e-6 * (1.0 + place.coords.amax());
        let face = *faces.surfaces.face_of.get(near.triangle)?;
        (normal.dot(&outwards) > best::FACING && !beside).then_some((Sample { place, normal }, face, outwards))
    };
    let found: Vec<(Sample, u32, Vector3<f64>)> = samples.par_iter().filter_map(near).collect();
    planes.each_ref().map(|plane| {
        let own = || found.iter().filter(|(_, face, _)| plane.faces.contains(face));
        // Out of the material, as its triangles look.
        let sign = own()
            .next()
            .map_or(1.0, |(_, _, outwards)| plane.normal.dot(outwards).signum());
        Datum {
            name: plane.name.clone(),
            origin: plane.origin,
            normal: plane.normal * sign,
            samples: own().map(|(sample, ..)| *sample).collect(),
        }
    })
}

/// The most faces that an error names; and how near planes are to be one, in mm and as a sine.
const NAMED: usize = 12;
const ONE_PLANE: f64 = 1e-6;
fn reported(kind: &str, fit: &Fit, datums: Vec<String>) -> ReportedAlignment {
    let turn = fit.motion.rotation.to_rotation_matrix();
    let mut report = ReportedAlignment::default();
    report.kind = kind.to_owned();
    report.datums = datums;
    report.rotation = [0, 1, 2].map(|row| [0, 1, 2].map(|column| turn[(row, column)]));
    report.translation = fit.motion.translation.vector.into();
    report.angle = fit.motion.rotation.angle().to_degrees();
    (report.rms, report.largest, report.points) = (fit.rms, fit.largest, fit.count);
    report.undetermined.clone_from(&fit.free);
    report
}
