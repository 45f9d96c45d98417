//! What tools and moves do, and for how long.

use serde::{Deserialize, Serialize};
use std::io::Write;
use sweepsim_nc::shortest;

/// What some moves do together. Lengths are in mm, volumes in mm³, durations in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct WorkSummary {
    /// The number of moves,
    pub moves: usize,
    /// and of rapids among them.
    pub rapid_moves: usize,
    /// The duration of feed moves, as far as it is known.
    pub seconds: f64,
    /// The duration of rapids.
    pub rapid_seconds: f64,
    /// The duration of dwells.
    pub dwell_seconds: f64,
    /// The number of feed moves of unknown duration.
    pub untimed: usize,
    /// The length of the tip's way in feed moves,
    pub length: f64,
    /// and in rapids.
    pub rapid_length: f64,
    /// The volume removed.
    pub removed: f64,
    /// The volume removed per minute of feed moves, in mm³/min, if all their durations are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// The number of feed moves that remove nothing, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub idle_moves: Option<usize>,
    /// The greatest axial depth of a move, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
    /// The greatest radial width of a move, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// The greatest rate of a move, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_rate: Option<f64>,
}

/// What a tool does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ToolSummary {
    /// Its number.
    pub tool: u32,
    /// All its moves.
    #[serde(flatten)]
    pub work: WorkSummary,
}

/// What is done in a set-up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SetupSummary {
    /// Its name: that of the job, or its number from 1.
    pub name: String,
    /// The origin of its coordinates in those of the part.
    pub origin: [f64; 3],
    /// The directions of its x, y and z in the coordinates of the part.
    pub axes: [[f64; 3]; 3],
    /// The numbers of its tools, in the order in which they are first used.
    pub tools: Vec<u32>,
    /// All its moves (`verify`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<WorkSummary>,
}

/// What a move does: a row of `moves.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MoveSummary {
    /// The path of the job, from 0.
    pub path: usize,
    /// The move of the path, from 0.
    pub number: usize,
    /// The program's file,
    pub file: Option<String>,
    /// and its line, from 1.
    pub line: Option<usize>,
    /// The tool's number.
    pub tool: u32,
    /// Whether the move is a rapid.
    pub rapid: bool,
    /// How long it takes, in seconds, if that is known.
    pub seconds: Option<f64>,
    /// The length of the tip's way, in mm.
    pub length: f64,
    /// The volume removed, in mm³,
    pub removed: f64,
    /// with its axial depth
    pub depth: f64,
    /// and its radial width, in mm.
    pub width: f64,
}

impl MoveSummary {
    /// The volume removed per minute, in mm³/min, if the duration is known.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        let seconds = self.seconds.filter(|seconds| *seconds > 0.0)?;
        Some(60.0 * self.removed / seconds)
    }
}

impl WorkSummary {
    /// Adds a move of this duration and length.
    pub fn add_move(&mut self, rapid: bool, seconds: Option<f64>, length: f64) {
        self.moves += 1;
        if rapid {
            self.rapid_moves += 1;
            self.rapid_seconds += seconds.unwrap_or_default();
            self.rapid_length += length;
        } else {
            self.seconds += seconds.unwrap_or_default();
            self.untimed += usize::from(seconds.is_none());
            self.length += length;
        }
    }

    /// Adds what a move removes, and how it engages.
    pub fn add_engagement(&mut self, row: &MoveSummary) {
        let idle = self.idle_moves.get_or_insert(0);
        *idle += usize::from(!row.rapid && row.removed == 0.0);
        let largest = |held: &mut Option<f64>, value: f64| *held = Some(held.unwrap_or(0.0).max(value));
        largest(&mut self.depth, row.depth);
        largest(&mut self.width, row.width);
        if let Some(rate) = row.rate().filter(|_| !row.rapid) {
            largest(&mut self.largest_rate, rate);
        }
    }

    /// Adds all the work of another.
    pub fn add(&mut self, other: &Self) {
        self.moves += other.moves;
        self.rapid_moves += other.rapid_moves;
        self.seconds += other.seconds;
        self.rapid_seconds += other.rapid_seconds;
        self.dwell_seconds += other.dwell_seconds;
        self.untimed += other.untimed;
        self.length += other.length;
        self.rapid_length += other.rapid_length;
        self.removed += other.removed;
        let both = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (one, other) => one.or(other),
        };
        self.depth = both(self.depth, other.depth);
        self.width = both(self.width, other.width);
        self.largest_rate = both(self.largest_rate, other.largest_rate);
        if let Some(idle) = other.idle_moves {
            *self.idle_moves.get_or_insert(0) += idle;
        }
    }

    /// Sets the mean rate, once all moves are added.
    pub fn finish(&mut self) {
        let known = self.untimed == 0 && self.seconds > 0.0;
        self.rate = known.then(|| 60.0 * self.removed / self.seconds);
    }

    /// Feed moves, rapids and dwells together, in seconds.
    #[must_use]
    pub fn total_seconds(&self) -> f64 {
        self.seconds + self.rapid_seconds + self.dwell_seconds
    }
}

/// Writes `moves.csv`: a header, and one row for each move; unknown values are empty.
///
/// # Errors
/// Those of the writer.
pub fn write_moves_csv(rows: &[MoveSummary], writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
    writeln!(
        writer,
        "path,move,file,line,tool,rapid,seconds,length,removed,depth,width,rate"
    )?;
    let optional = |value: Option<f64>| value.map(shortest).unwrap_or_default();
    for row in rows {
        // RFC 4180.
        let file = row.file.as_deref().unwrap_or_default();
        let file = if file.contains([',', '"', '\n', '\r']) {
            format!("\"{}\"", file.replace('"', "\"\""))
        } else {
            file.to_owned()
        };
        let line = row.line.map(|line| line.to_string()).unwrap_or_default();
        writeln!(
            writer,
            "{},{},{file},{line},{},{},{},{},{},{},{},{}",
            row.path,
            row.number,
            row.tool,
            u8::from(row.rapid),
            optional(row.seconds),
            shortest(row.length),
            shortest(row.removed),
            shortest(row.depth),
            shortest(row.width),
            optional(row.rate()),
        )?;
    }
    Ok(())
}
