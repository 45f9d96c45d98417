//! `report.json`: what a run did, or how two parts differ, for scripts.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// A run in numbers. Lengths in mm, volumes in mm³. What is `None` is not in the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The name of the job.
    pub job: String,
    /// `charts`, `lines`, …
    pub method: String,
    /// Dexels in x and y.
    pub cells: [usize; 2],
    /// Moves of all paths.
    pub moves: usize,
    /// By phase, in order.
    pub seconds: IndexMap<String, f64>,
    /// Crossings of lines and envelopes that were found.
    pub crossings: u64,
    /// What became of the dexels.
    pub dexels: DexelCounts,
    /// What the tools took out of the stock (`simulate`, `verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume_removed: Option<f64>,
    /// What is in the result: the swept volume or the remaining part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<f64>,
    /// Where too much was taken (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gouge: Option<Deviation>,
    /// Where too little was taken (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excess: Option<Deviation>,
    /// Where the tool met what it must not (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collisions: Option<Vec<Collision>>,
    /// What was ignored or decided for the user on reading.
    pub notes: Vec<String>,
}

/// The dexels of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DexelCounts {
    /// With material in the result.
    pub covered: usize,
    /// Whose audit failed at first and was mended.
    pub repaired: usize,
    /// Whose intervals are not certain.
    pub unresolved: Vec<UnresolvedDexel>,
}

/// A dexel whose intervals are not certain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnresolvedDexel {
    /// Which one, in x,
    pub i: usize,
    /// and in y.
    pub j: usize,
    /// Why.
    pub reason: String,
}

/// A deviation from the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// The largest.
    pub max: f64,
    /// The mean over the places that deviate.
    pub mean: f64,
    /// Its root mean square.
    pub rms: f64,
    /// At how many places.
    pub count: usize,
    /// The area of them, mm².
    pub area: f64,
}

/// The tool in what it must not touch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Collision {
    /// Which path of the job, from 0.
    pub path: usize,
    /// Which move of it, from 0.
    pub r#move: usize,
    /// Where.
    pub place: [f64; 3],
    /// How deep.
    pub depth: f64,
}

/// How a part differs from its target, in numbers. Lengths in mm, areas in mm², volumes in mm³.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ComparisonReport {
    /// The file of the part.
    pub part: String,
    /// The file of its target.
    pub target: String,
    /// Dexels in x and y that they are compared on.
    pub cells: [usize; 2],
    /// Distances up to this count as none.
    pub tolerance: f64,
    /// By phase, in order.
    pub seconds: IndexMap<String, f64>,
    /// Of the part.
    pub volume: f64,
    /// Of the target.
    pub target_volume: f64,
    /// Of the part, outside of the target.
    pub excess_volume: f64,
    /// Of the target, missing in the part.
    pub missing_volume: f64,
    /// Of the part's surface that has a counterpart.
    pub area: f64,
    /// Ends of intervals without a counterpart.
    pub unmatched: usize,
    /// Mean distance over the area; positive is outside of the target.
    pub mean: f64,
    /// Root of the mean square of the distance over the area.
    pub rms: f64,
    /// Where the part is inside of the target: depths, as positive numbers.
    pub gouge: Deviation,
    /// Where it is outside.
    pub excess: Deviation,
    /// The furthest point of the part's surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub furthest_of_part: Option<Furthest>,
    /// The furthest point of the target's surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub furthest_of_target: Option<Furthest>,
    /// Areas by distance.
    pub histogram: Vec<HistogramBar>,
}

/// A point of one surface that is furthest from the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Furthest {
    /// Where.
    pub place: [f64; 3],
    /// How far outside of the other surface: negative inside.
    pub distance: f64,
}

/// The area at distances in a range. The first and the last bar have all beyond them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HistogramBar {
    /// From here,
    pub from: f64,
    /// to here.
    pub to: f64,
    /// How much.
    pub area: f64,
}

impl ComparisonReport {
    /// The text of its `report.json`. Numbers that JSON cannot say (not finite) become `null`.
    ///
    /// # Errors
    /// As [`Report::to_json`].
    pub fn to_json(&self) -> serde_json::Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }
}

impl Report {
    /// The text of `report.json`. Numbers that JSON cannot say (not finite) become `null`.
    ///
    /// # Errors
    /// What the serialiser says; with strings for keys and plain data it has no reason to.
    pub fn to_json(&self) -> serde_json::Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }
}
