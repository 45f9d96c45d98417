//! How far the axes of a machine go.

use serde::{Deserialize, Serialize};

/// The travel of an axis over all paths: millimetres of the spindle's nose in machine coordinates, or degrees.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AxisTravel {
    /// Its letter.
    pub letter: char,
    /// The least and the largest value.
    pub range: [f64; 2],
    /// Its limits, if they are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// The least room that is left to a limit; negative beyond it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub room: Option<f64>,
    /// The program's file where that is; without limits, where the axis goes farthest from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The line of the file, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
}
