//! Drilling cycles: `CYCLE` and the moves at each of its points.
//!
//! Depths and levels are distances from the point along the tool axis: `FEDTO` and `DEPTH` below it, whatever their sign; `RAPTO`,
//! `CLEAR`, `RTRCTO` and `RETURN` above it. With `CLEAR`, `RAPTO` is measured down from there (Creo).

use super::statement::Statement;
use crate::drive::{HoleCycle, HoleWork, Pecks};
use crate::model::program::FeedMode;
use crate::text::error::NcProblem;

/// A cycle in effect.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cycle {
    /// All but the end.
    pub hole: HoleCycle,
    /// Above the point, where the tool goes afterwards; `None` for the level where it was before the cycle.
    pub return_level: Option<f64>,
    pub feed: Option<(f64, FeedMode)>,
    /// An index of the program's calls.
    pub call: u32,
}

/// What a `CYCLE` statement does.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum CycleStatement {
    /// Ends the cycle, or prepares for one.
    Off,
    /// Resumes the last one.
    On,
    Begin(Box<Cycle>),
}

/// The most pecks at one point.
const MOST_PECKS: f64 = 10_000.0;
/// How far above the last depth a peck stops its rapid move, in mm.
const PECK_CLEARANCE: f64 = 1.0;

/// The units of feeds: words, mode, millimetres per unit (0: as the program).
pub(super) const FEED_UNITS: [(&str, FeedMode, f64); 8] = [
    ("MMPM", FeedMode::PerMinute, 1.0),
    ("IPM", FeedMode::PerMinute, 25.4),
    ("FPM", FeedMode::PerMinute, 304.8),
    ("PERMIN", FeedMode::PerMinute, 0.0),
    ("MMPR", FeedMode::PerRevolution, 1.0),
    ("IPR", FeedMode::PerRevolution, 25.4),
    ("FPR", FeedMode::PerRevolution, 304.8),
    ("PERREV", FeedMode::PerRevolution, 0.0),
];

/// Kinds that are drilled.
const KINDS: [&str; 14] = [
    "DRILL", "DEEP", "DEEP2", "BRKCHP", "THRU", "FACE", "CSINK", "TAP", "BORE", "REAM", "CBORE", "SPOTDR", "CHIP",
    "RIGID",
];

/// A feed with its unit beside it, in units of the program per minute or revolution.
pub(super) fn feed(statement: &Statement, unit: f64) -> Option<(f64, FeedMode)> {
    let items = &statement.items;
    for (index, item) in items.iter().enumerate() {
        for (word, mode, in_mm) in FEED_UNITS {
            if item.is(word) {
                let before = index.checked_sub(1).and_then(|index| items[index].number);
                let behind = items.get(index + 1).and_then(|item| item.number);
                // `MMPM, 250` or `250, MMPM`.
                let value = if belongs_to_before(statement, index) {
                    before
                } else {
                    behind.or(before)
                }?;
                let factor = if in_mm == 0.0 { 1.0 } else { in_mm / unit };
                return Some((value * factor, mode));
            }
        }
    }
    None
}

/// Whether the unit of a feed belongs to the number before it, although another one may follow: `z, f, MMPM, r` (Creo's fixed format).
fn belongs_to_before(statement: &Statement, unit: usize) -> bool {
    unit >= 2 && statement.items[unit - 2..unit].iter().all(|item| item.number.is_some())
}

impl CycleStatement {
    /// Lengths are multiplied by `unit`, in millimetres.
    pub fn of(statement: &Statement, unit: f64, call: u32) -> Result<Self, NcProblem> {
        let has = |word: &str| statement.has(word);
        let Some(first) = statement.items.first() else {
            return Ok(Self::On);
        };
        if ["OFF", "INIT", "CLEAR", "NOMORE"].iter().any(|word| first.is(word)) && statement.items.len() == 1 {
            return Ok(Self::Off);
        }
        if first.is("ON") && statement.items.len() == 1 {
            return Ok(Self::On);
        }
        if !KINDS.iter().any(|kind| first.is(kind)) {
            let found = format!("the cycle {} is", first.text);
            return Err(NcProblem::unsupported(
                found,
                format!("expected one of {}", KINDS.join(", ")),
            ));
        }
        let length = |word: &str| statement.after(word).map(|value| value * unit);
        let feed = feed(statement, unit);
        // Numbers without a word before them: depth, feed or clearance.
        let mut positional = Vec::new();
        let is_unit = |index: usize| {
            let item = statement.items.get(index);
            item.is_some_and(|item| FEED_UNITS.iter().any(|(word, ..)| item.is(word)))
        };
        let mut after_word = false;
        for (index, item) in statement.items.iter().enumerate() {
            match item.number {
                None => {
                    let own =
                        KINDS.iter().any(|kind| item.is(kind)) || is_unit(index) && belongs_to_before(statement, index);
                    after_word = !own;
                }
                Some(_) if after_word => after_word = false,
                // `f, MMPM` behind the depth.
                Some(_) if is_unit(index + 1) && belongs_to_before(statement, index + 1) => {}
                Some(value) => positional.push(value * unit),
            }
        }
        let depth = length("DEPTH")
            .or_else(|| length("FEDTO"))
            .or(positional.first().copied());
        let Some(depth) = depth.map(f64::abs) else {
            return Err(NcProblem::syntax(
                "this cycle has no depth: expected DEPTH or FEDTO with a number",
            ));
        };
        let clear = length("CLEAR").or_else(|| positional.get(1).copied());
        let rapid_level = match (clear, length("RAPTO")) {
            (Some(clear), Some(down)) => clear - down,
            (Some(level), None) | (None, Some(level)) => level,
            (None, None) => 0.0,
        };
        let return_level = match (length("RTRCTO"), length("RETURN")) {
            (Some(level), _) => Some(level),
            // 0 means the retract plane, where the tool came from.
            (None, Some(level)) if level != 0.0 => Some(level),
            (None, Some(_)) => None,
            (None, None) if has("RTRCTO") => None,
            (None, None) => Some(clear.unwrap_or(rapid_level)),
        };
        let pecks = match (length("1STPECK"), length("STEP").or_else(|| length("INCR"))) {
            (Some(first), _) => Some([first, length("SUBPECK").unwrap_or(first)]),
            (None, Some(step)) => Some([step, step]),
            (None, None) => None,
        };
        if let Some(pecks) = pecks {
            let least = pecks[0].min(pecks[1]);
            if !(least > 0.0 && depth / least <= MOST_PECKS) {
                let expected = format!("positive, and at least a {MOST_PECKS}th of the depth, {depth} mm");
                return Err(NcProblem::value("the peck of this cycle", least, expected));
            }
        }
        let work = pecks.map_or(HoleWork::Plunge, |[first, infeed]| {
            HoleWork::Pecks(Pecks {
                first: -first,
                infeed,
                rounding: 1e-12 * depth,
                clears: !has("BRKCHP") && !has("CHIP"),
                above: PECK_CLEARANCE,
                ..Pecks::default()
            })
        });
        let feeds_out = ["TAP", "BORE", "REAM", "RIGID"].iter().any(|word| has(word));
        let dwell = statement.after("DWELL").filter(|_| !has("REV"));
        let hole = HoleCycle {
            work,
            ..HoleCycle::new(rapid_level, -depth, dwell, feeds_out)
        };
        Ok(Self::Begin(Box::new(Cycle {
            hole,
            return_level,
            feed,
            call,
        })))
    }
}
