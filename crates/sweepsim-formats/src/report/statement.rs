//! Statements that hold everywhere, or do not, or are open.

use serde::{Deserialize, Serialize};

/// Something that was asked for at every time of the program and in every place. Lengths are in mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Statement {
    /// What may not happen, deeper than the limit:
    ///
    /// - `gouge`: a cutter in the target; `holder`: a shank or holder in it; `fixture`: any of these in a fixture;
    /// - `collision`: a shank or holder in the stock as it is at that time; `rapid`: a cutter in it in a rapid, or in
    ///   another move that must not cut;
    /// - `excess`: material that hangs together with the target, above it;
    /// - `machine`: bodies of the machine nearer to each other, to the tool or to the raw stock, always with
    ///   [`Measure::Distance`].
    ///
    /// Of fixtures, holders and collisions with [`Measure::Distance`]: a shank or holder that comes nearer.
    pub about: String,
    /// What is measured.
    #[serde(default, skip_serializing_if = "Measure::is_depth")]
    pub measure: Measure,
    /// The limit.
    pub limit: f64,
    /// The largest depth or height, or the smallest distance, lies between these. One is attained at the witness: the
    /// first, or the second of a distance. The other is proven: if nothing is known, it is the largest number there is,
    /// or 0 of a distance.
    pub enclosure: [f64; 2],
    /// Whether the statement holds.
    pub state: StatementState,
    /// Where the lower end of the enclosure is attained; none if nothing goes below the surface.
    pub witness: Option<StatementWitness>,
    /// Where it is not known whether the statement holds; at most 100 of them.
    pub open: Vec<OpenPlace>,
    /// How many these are.
    pub open_count: usize,
    /// Why it is open, if not for its places.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl Statement {
    /// An open statement about something, with its limit.
    #[must_use]
    pub fn new(about: impl Into<String>, limit: f64) -> Self {
        Self {
            about: about.into(),
            measure: Measure::Depth,
            limit,
            enclosure: [0.0, f64::MAX],
            state: StatementState::Open,
            witness: None,
            open: Vec::new(),
            open_count: 0,
            reason: None,
        }
    }
}

/// What a statement bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Measure {
    /// How deep something goes, from above.
    #[default]
    Depth,
    /// How high something stands, from above.
    Height,
    /// How far something keeps away, from below.
    Distance,
}

impl Measure {
    fn is_depth(&self) -> bool {
        *self == Self::Depth
    }
}

/// Whether a statement holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StatementState {
    /// It holds everywhere.
    Proven,
    /// It does not: the witness shows it.
    Refuted,
    /// It is not known.
    Open,
}

/// Where the lower end of an enclosure is attained.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StatementWitness {
    /// The path of the job, from 0; none for what is left standing.
    pub path: Option<usize>,
    /// The move of the path, from 0.
    pub r#move: Option<usize>,
    /// The program's file.
    pub file: Option<String>,
    /// The line of the file, from 1.
    pub line: Option<usize>,
    /// The text of the line.
    pub text: Option<String>,
    /// When, as a fraction of the move.
    pub time: f64,
    /// Where.
    pub place: [f64; 3],
    /// The part of the tool, if it is not the cutter; all that it may be, as `shank or holder`, if that is not known.
    pub body: Option<String>,
}

/// Where it is not known whether a statement holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OpenPlace {
    /// The path of the job, from 0; none for what is left standing.
    pub path: Option<usize>,
    /// The first of the moves, from 0.
    pub r#move: Option<usize>,
    /// The program's file.
    pub file: Option<String>,
    /// The line of the file, from 1.
    pub line: Option<usize>,
    /// From when to when, as fractions of the first and of the last move.
    pub time: [f64; 2],
    /// The box: its lower and its upper corner.
    pub r#box: [f64; 6],
}
