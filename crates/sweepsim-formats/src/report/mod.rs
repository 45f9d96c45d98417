//! `report.json`: the results of a run, or of a comparison, for scripts.

mod axes;
mod ci;
mod comparison;
mod junit;
mod sarif;
mod statement;
mod work;

pub use axes::AxisTravel;
pub use ci::{Annotation, AnnotationLevel, CiCase, CiProgram};
pub use comparison::{ComparisonReport, FaceDeviation, HistogramBar, ReportedAlignment, SurfaceDeviation};
pub use junit::to_junit;
pub use sarif::to_sarif;
pub use statement::{Measure, OpenPlace, Statement, StatementState, StatementWitness};
pub use work::{MoveSummary, SetupSummary, ToolSummary, WorkSummary, write_moves_csv};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// The results of a run. Lengths are in mm, volumes in mm³. Fields that are `None` are not written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Report {
    /// The name of the job.
    pub job: String,
    /// The method: `charts`, `lines`, …
    pub method: String,
    /// The number of dexels in x and y.
    pub cells: [usize; 2],
    /// The number of moves of all paths.
    pub moves: usize,
    /// How many of them are rapids.
    #[serde(default)]
    pub rapid_moves: usize,
    /// The duration of each phase, in order.
    pub seconds: IndexMap<String, f64>,
    /// The number of crossings of dexels and envelopes.
    pub crossings: u64,
    /// Counts of dexels.
    pub dexels: DexelCounts,
    /// The volume removed from the stock (`simulate`, `verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume_removed: Option<f64>,
    /// The volume of the result: the swept volume, or the remaining part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<f64>,
    /// Where too much was removed (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gouge: Option<DeviationSummary>,
    /// Where too little was removed (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excess: Option<DeviationSummary>,
    /// `pass`, `fail` or `undecided` (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// What was looked at, and what was not (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scope: Option<Scope>,
    /// What was asked for everywhere, and how far it is proven (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statements: Option<Vec<Statement>>,
    /// The moves that do harm, in the program's order, then the places where too much is left (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub findings: Option<Vec<ReportedFinding>>,
    /// Where the result deviates from the target by more than its limits (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub regions: Option<Vec<ReportedRegion>>,
    /// How the result deviates on each face of the target, if that is a STEP file (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<Vec<FaceDeviation>>,
    /// What each path removes (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paths: Option<Vec<PathSummary>>,
    /// What each tool does, in the order of the tools' numbers (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tools: Option<Vec<ToolSummary>>,
    /// What each set-up does, in their order; none in a job without set-ups.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub setups: Option<Vec<SetupSummary>>,
    /// How far the axes of the machine go, by letter, if one with limits or bodies is known (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<Vec<AxisTravel>>,
    /// A box of offsets of the part, in the machine's directions, for which nothing collides and no limit is met: the
    /// least and the largest of X, Y and Z. If the program collides with the machine or meets a limit, and one was
    /// found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_place: Option<[[f64; 3]; 2]>,
    /// What all tools do (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<WorkSummary>,
    /// What is odd about the job although it could be run: each in one sentence.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// What was ignored or decided while reading the job and its files.
    pub notes: Vec<String>,
}

/// The dexels of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct DexelCounts {
    /// Dexels with material in the result.
    pub covered: usize,
    /// Dexels whose audit failed at first, and which were repaired.
    pub repaired: usize,
    /// Dexels whose intervals are not certified.
    pub unresolved: Vec<ReportedDexel>,
}

/// A dexel whose intervals are not certified.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReportedDexel {
    /// Its cell in x.
    pub i: usize,
    /// Its cell in y.
    pub j: usize,
    /// The reason.
    pub reason: String,
}

impl ReportedDexel {
    /// A dexel by its cell, and the reason.
    #[must_use]
    pub fn new(i: usize, j: usize, reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self { i, j, reason }
    }
}

/// A deviation from the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct DeviationSummary {
    /// The largest that was found: no bound of what is between the dexels.
    pub max: f64,
    /// What the largest may be at most, where the files leave open where a wall is (`compare`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// The mean over the samples that deviate.
    pub mean: f64,
    /// The root mean square over these samples.
    pub rms: f64,
    /// The number of samples that deviate.
    pub count: usize,
    /// Their area, in mm².
    pub area: f64,
}

/// Whether a program may be run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Nothing was found, and the result is within its limits.
    Pass,
    /// Something was found.
    Fail,
    /// Nothing was found, but something that was asked for could not be proven.
    Undecided,
}

/// What a verdict is about: it says nothing of anything else.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Scope {
    /// Where harm was looked for: `lines`, on the lines of the dexels, and between them only what the statements are
    /// about; or `everywhere`, if there is a statement about each kind of harm that was looked for.
    pub extent: String,
    /// The lines, by direction.
    pub lines: Vec<ScopeLines>,
    /// Why there was nothing to look at on the lines, if none of them meets material before the first move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unmet: Option<String>,
    /// What nobody asked for, or could not be looked at.
    pub not_looked_at: Vec<NotLookedAt>,
}

/// Parallel lines on which harm was looked for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ScopeLines {
    /// Their direction: `x`, `y` or `z`, in the frame of the grid.
    pub along: String,
    /// How far apart they are, both ways, in mm.
    pub spacing: [f64; 2],
}

/// Something that was not looked at.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct NotLookedAt {
    /// What: `gouges and excess`, `fixtures`, …
    pub about: String,
    /// What it needs.
    pub needs: String,
    /// The kinds of findings that it would make.
    #[serde(default)]
    pub kinds: Vec<String>,
    /// Whether some of these kinds was looked at all the same.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub partly: bool,
}

impl NotLookedAt {
    /// Something, what it needs, and the kinds of findings that it would make.
    #[must_use]
    pub fn new(about: impl Into<String>, needs: impl Into<String>, kinds: &[&str]) -> Self {
        Self {
            about: about.into(),
            needs: needs.into(),
            kinds: kinds.iter().map(|kind| (*kind).to_owned()).collect(),
            partly: false,
        }
    }

    /// The same where only a part was not looked at.
    #[must_use]
    pub fn partly(self, partly: bool) -> Self {
        Self { partly, ..self }
    }
}

/// A move that does harm, or a place where too much is left.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReportedFinding {
    /// `collision`, `rapid`, `fixture`, `gouge`, `excess`, `spindle`, `feed`, `machine` or `limit`.
    pub kind: String,
    /// The tool's number; none for an excess.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool: Option<u32>,
    /// The part of the tool that touches, if it is not the cutter; all that it may be, as `shank or holder`, if that is
    /// not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// The two bodies that meet (`machine`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<String>,
    /// The path of the job, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<usize>,
    /// The set-up, from 0; none in a job without set-ups.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub setup: Option<usize>,
    /// The move of the path, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub r#move: Option<usize>,
    /// Nothing is touched: it only comes nearer than it should.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub near: bool,
    /// The courses of a rapid on which this happens, where it is not known how the machine makes them: `straight`,
    /// `dog-leg` or `both`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub courses: Option<String>,
    /// The program's file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The line of the file, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// The text of the line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// The region of the limits that it exceeds (`excess`); none for the limits of the whole part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<String>,
    /// The face of the target on which it is, if that is a STEP file: its name, or its number as `#123`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub face: Option<String>,
    /// It was found between the lines of the dexels, by the proof of a statement.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub between: bool,
    /// What is beyond which limit (`limit`), or which bodies meet (`machine`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
    /// When it begins, as a fraction of the move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Where: for a limit or a machine's bodies, the tool's tip.
    pub place: [f64; 3],
    /// The depth, in mm; for a limit, how far the axis is beyond it, in mm or degrees.
    pub depth: f64,
    /// The volume, in mm³.
    pub volume: f64,
}

/// A connected piece of material that is missing, or left, beyond its limit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReportedRegion {
    /// `gouge` or `excess`.
    pub kind: String,
    /// The region of the limits that it exceeds; none for the limits of the whole part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<String>,
    /// The face of the target on which it is, if that is a STEP file: its name, or its number as `#123`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub face: Option<String>,
    /// The point farthest from the target's surface.
    pub place: [f64; 3],
    /// How far that is, in mm.
    pub depth: f64,
    /// The area as seen along the dexels, in mm².
    pub area: f64,
    /// The volume beyond the limit, in mm³.
    pub volume: f64,
}

/// What a path removes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PathSummary {
    /// The tool's number.
    pub tool: u32,
    /// The set-up, from 0; none in a job without set-ups.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub setup: Option<usize>,
    /// The moves of the path.
    pub moves: usize,
    /// The volume, in mm³.
    pub removed: f64,
}

impl Report {
    /// The report as JSON. Numbers that are not finite become `null`.
    ///
    /// # Errors
    /// Those of the serialiser; none are known for this data.
    pub fn to_json(&self) -> serde_json::Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }
}
