//! `comparison.json`: how a part differs from its target.

use super::{DeviationSummary, ReportedRegion};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// How a part differs from its target. Lengths are in mm, areas in mm², volumes in mm³.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ComparisonReport {
    /// The file of the part.
    pub part: String,
    /// The file of its target.
    pub target: String,
    /// The number of dexels in x and y used for the comparison.
    pub cells: [usize; 2],
    /// Distances up to this count as 0.
    pub tolerance: f64,
    /// What of the request could not be done, each in one sentence.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// The duration of each phase, in order.
    pub seconds: IndexMap<String, f64>,
    /// The volume of the part.
    pub volume: f64,
    /// The volume of the target.
    pub target_volume: f64,
    /// The volume of the part outside the target.
    pub excess_volume: f64,
    /// The volume of the target missing from the part.
    pub missing_volume: f64,
    /// Where the part is inside the target, of both surfaces' points: the largest depth; the others are of the part's.
    pub gouge: DeviationSummary,
    /// Where the part is outside the target.
    pub excess: DeviationSummary,
    /// How far the part's surface is from the target's.
    pub of_part: SurfaceDeviation,
    /// How far the target's surface is from the part's: where it is missing, at most as far as the target is thick.
    pub of_target: SurfaceDeviation,
    /// The limits for gouges and for excess, outside of regions with their own.
    #[serde(default)]
    pub limits: [f64; 2],
    /// Connected pieces of material that are missing, or left, beyond their limits, the deepest first, gouges before
    /// excess.
    #[serde(default)]
    pub regions: Vec<ReportedRegion>,
    /// How the part deviates on each face of the target, if that is a STEP file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<FaceDeviation>,
    /// How the part was laid onto the target, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alignment: Option<ReportedAlignment>,
    /// The area of the part's surface by distance: that end of what it may be that is nearest to 0.
    pub histogram: Vec<HistogramBar>,
}

/// How a part deviates on a face of its target.
///
/// Points of the part count for the face whose triangle is nearest, points of the face for itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FaceDeviation {
    /// Its name, or its number in the file as `#123`.
    pub face: String,
    /// Its number in the file.
    pub entity: usize,
    /// What it is part of: `plane`, `cylinder`, `cone`, `sphere`, `torus`, or another kind of surface.
    pub kind: String,
    /// Its colour, like `#ff8000`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<String>,
    /// The area of it on which the distance is known: 0 for a face along the dexels. Mean and root mean square are over
    /// it, and if it is 0, they say nothing.
    pub area: f64,
    /// How deep the part is below it at most: what is certain.
    pub gouge: f64,
    /// How high the part is above it at most: what is certain.
    pub excess: f64,
    /// The mean over the face, positive where material is left.
    pub mean: f64,
    /// The root of the mean square over the face.
    pub rms: f64,
}

/// The rigid motion that laid a part onto its target: `p` went to `rotation · p + translation`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReportedAlignment {
    /// `best`, `features` or `datum`.
    pub kind: String,
    /// The faces of `datum`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub datums: Vec<String>,
    /// The rows of the rotation.
    pub rotation: [[f64; 3]; 3],
    /// The translation, in mm.
    pub translation: [f64; 3],
    /// The angle of the rotation, in degrees.
    pub angle: f64,
    /// What is left of the distances that were made small: the root of the mean square.
    pub rms: f64,
    /// The largest of them.
    pub largest: f64,
    /// The number of points of the part whose distances these are.
    pub points: usize,
    /// Motions that change nothing, each in words: the part was not moved along them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undetermined: Vec<String>,
    /// The target was moved onto the part instead, by the inverse: places are those of the part as it was.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub inverse: bool,
}

/// How far one surface is from another, along the normal of that.
///
/// Pairs are the least and the most that a number may be: dexels along one axis do not tell where a wall is between two
/// of their lines. Where everything is known, both are equal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SurfaceDeviation {
    /// The largest distance, to either side.
    pub largest: [f64; 2],
    /// Where the least of it is; if that is 0, where the most is. None if nothing is beyond the tolerance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<[f64; 3]>,
    /// The mean over the area, positive outside of the other solid.
    pub mean: [f64; 2],
    /// The root of the mean square.
    pub rms: [f64; 2],
    /// The area.
    pub area: f64,
}

/// The area at distances in a range. The first and the last bar include everything beyond them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HistogramBar {
    /// The lower end of the range.
    pub from: f64,
    /// The upper end of the range.
    pub to: f64,
    /// The area.
    pub area: f64,
}

impl ComparisonReport {
    /// The report as JSON. Numbers that are not finite become `null`.
    ///
    /// # Errors
    /// As [`Report::to_json`](super::Report::to_json).
    pub fn to_json(&self) -> serde_json::Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }
}
