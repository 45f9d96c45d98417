//! How far a part deviates on each face of a target that is a STEP file.

use rayon::prelude::*;
use sweepsim::verify::Target;
use sweepsim_dexel::{Dexels, DistanceRange, MeshError, Surface, SurfaceDeviations, TriDexels};
use sweepsim_formats::{FaceDeviation, Report, StepFace, Target as Goal, TargetFaces};

/// What the face of a target nearest to a place is called, if its file has faces. `shape` is the target, prepared.
pub(crate) fn face_at(target: &Goal, shape: &Target, place: [f64; 3]) -> Option<String> {
    target.faces.as_ref()?;
    let near = shape.distance().nearest(place)?;
    target.face(near.triangle).map(StepFace::label)
}

/// Says of the findings and regions of a verification on which faces they are.
pub(crate) fn name_faces(report: &mut Report, target: &Goal, shape: &Target) {
    for finding in report.findings.iter_mut().flatten() {
        if matches!(finding.kind.as_str(), "gouge" | "excess") {
            finding.face = face_at(target, shape, finding.place);
        }
    }
    for region in report.regions.iter_mut().flatten() {
        region.face = face_at(target, shape, region.place);
    }
}

/// The deviations of a part by face: of its surface along three axes, if that is known, or of its dexels.
///
/// # Errors
/// [`MeshError`]: too many vertices.
pub(crate) fn of_part(
    target: &Goal,
    dexels: &Dexels,
    solid: Option<&TriDexels>,
    tolerance: f64,
) -> Result<Option<Vec<FaceDeviation>>, MeshError> {
    let Some(faces) = &target.faces else { return Ok(None) };
    let goal = Surface::of_faces(&target.mesh, &faces.surfaces)?;
    let part = match solid {
        Some(solid) => Surface::of_tri_dexels(solid)?,
        None => Surface::of_dexels(dexels)?,
    };
    let [dx, dy] = dexels.grid().spacing();
    let spacing = dx.min(dy);
    let of_part = part.deviations_from(&goal, spacing, tolerance);
    let of_target = goal.missing_from(&part, spacing, tolerance);
    Ok(Some(by_face(&goal, faces, [&of_part, &of_target], tolerance)))
}

/// What is summed over a face.
#[derive(Clone, Copy, Default)]
struct Sums {
    gouge: f64,
    excess: f64,
    area: f64,
    mean: f64,
    square: f64,
}

impl Sums {
    /// Takes the distance of a point, positive where material is left, if it is beyond the tolerance.
    fn take(&mut self, DistanceRange { low, high }: DistanceRange, tolerance: f64) {
        if low > tolerance {
            self.excess = self.excess.max(low);
        }
        if -high > tolerance {
            self.gouge = self.gouge.max(-high);
        }
    }
}

/// The deviations by face, in the order of the file: of the part's points on the face that is nearest to them, and of
/// the points of the target on their own. Areas, means and mean squares are of what is known. `target` is the surface
/// of `faces`.
pub(crate) fn by_face(
    target: &Surface<'_>,
    faces: &TargetFaces,
    [of_part, of_target]: [&SurfaceDeviations; 2],
    tolerance: f64,
) -> Vec<FaceDeviation> {
    let mut sums = vec![Sums::default(); faces.faces.len()];
    let face_of = |place: [f64; 3]| {
        let triangle = target.nearest_triangle(place)?;
        faces.surfaces.face_of.get(triangle).map(|face| *face as usize)
    };
    let nearest = |found: &SurfaceDeviations| -> Vec<Option<usize>> {
        found.points.par_iter().map(|point| face_of(point.place)).collect()
    };
    for (point, face) in of_part.points.iter().zip(nearest(of_part)) {
        if let Some(own) = face.and_then(|face| sums.get_mut(face)) {
            own.take(point.distance, tolerance);
        }
    }
    for (point, face) in of_target.points.iter().zip(nearest(of_target)) {
        let Some(own) = face.and_then(|face| sums.get_mut(face)) else {
            continue;
        };
        // A point of the target outside of the part: there the part is missing.
        let DistanceRange { low, high } = point.distance;
        let seen = DistanceRange { low: -high, high: -low };
        own.take(seen, tolerance);
        // A wall along dexels of one direction is anywhere between two of them: nothing is known of its mean.
        if high - low > tolerance {
            continue;
        }
        own.area += point.area;
        own.mean += point.area * seen.nearest_to_0();
        own.square += point.area * seen.nearest_to_0() * seen.nearest_to_0();
    }
    let each = faces.faces.iter().zip(sums).map(|(face, sums)| {
        let mut found = FaceDeviation::default();
        (found.face, found.entity, found.kind) = (face.label(), face.entity, face.kind.to_owned());
        found.colour = face.colour.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        (found.gouge, found.excess, found.area) = (sums.gouge, sums.excess, sums.area);
        let area = sums.area.max(f64::MIN_POSITIVE);
        (found.mean, found.rms) = (sums.mean / area, (sums.square / area).sqrt());
        found
    });
    each.collect()
}
