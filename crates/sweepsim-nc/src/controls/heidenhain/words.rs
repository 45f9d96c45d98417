//! The words of a move.

use super::interpreter::Reader;
use super::language::line::{self, Line};
use crate::model::program::FeedMode;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// The words of a move.
#[derive(Clone, Debug, Default)]
pub(super) struct MoveWords {
    /// X, Y, Z and A, B, C: value, and whether it is incremental.
    pub(super) axes: [Option<(f64, bool)>; 6],
    /// PR and PA.
    pub(super) polar: [Option<(f64, bool)>; 2],
    pub(super) radius: Option<f64>,
    /// `LEN` and `CCA` of `APPR` and `DEP`, in mm and degrees.
    pub(super) length: Option<f64>,
    pub(super) arc_angle: Option<f64>,
    pub(super) counter_clockwise: Option<bool>,
    pub(super) normal: [Option<f64>; 3],
    pub(super) tool: [Option<f64>; 3],
    pub(super) rapid: bool,
    /// In machine coordinates (`M91`), or from a point that only the builder knows (`M92`).
    pub(super) machine: Option<Datum>,
    /// `M140 MB`: the way back along the tool, or all of it.
    pub(super) retract: Option<Option<f64>>,
    /// Cutter compensation off, to the left, or to the right: R0, RL, RR.
    pub(super) side: Option<Option<bool>>,
}

/// What coordinates of the machine are measured from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Datum {
    Machine,
    Builder,
}

/// Whether a word belongs to the code before it: the feed of M103 and M128, the axes of M118, what M112, M120, M124 and M197 look at.
///
/// Source: *iTNC 530, Conversational Programming* (340 49x), Programming: Miscellaneous functions.
fn belongs(code: u32, word: &str) -> bool {
    let number = |name: &str| {
        word.strip_prefix(name)
            .is_some_and(|rest| rest.starts_with(|c: char| "+-.Q".contains(c) || c.is_ascii_digit()))
    };
    match code {
        103 | 128 => number("F"),
        118 => ["X", "Y", "Z", "A", "B", "C"].into_iter().any(number),
        120 => number("LA"),
        112 | 124 => number("T") || number("A"),
        197 => number("DL"),
        _ => false,
    }
}

const AXES: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

impl Reader<'_> {
    /// What a feed is in the unit of the program per minute: programs in inches have tenths.
    ///
    /// From general knowledge: posts for these controls write ten times the feed in inches.
    pub(super) fn feed_unit(&self) -> f64 {
        if self.modes.inch { 0.1 } else { 1.0 }
    }

    /// What stands behind F: a feed, per revolution after M136 or U, per tooth after Z.
    pub(super) fn feed_word(&mut self, rest: &str) -> Result<(), NcProblem> {
        let per_tooth = rest.strip_prefix('Z');
        if let Some(text) = rest.strip_prefix('U').or(per_tooth) {
            let feed = self.parameters.value(text)?;
            if per_tooth.is_some() {
                let taken = "one: the feed per tooth is that per revolution";
                let what = "the number of teeth, for FZ";
                self.track.assume(Assumption::new(what, taken, "F or FU").harmless());
            }
            (self.track.feed, self.track.feed_mode) = (Some(feed), FeedMode::PerRevolution);
            return Ok(());
        }
        if rest.starts_with('T') || rest == "MAXT" {
            let problem = format!("F{rest}: a time instead of a feed is");
            return Err(NcProblem::unsupported(problem, "expected F with a feed"));
        }
        let feed = self.parameters.value(rest)?;
        if self.modes.per_revolution {
            (self.track.feed, self.track.feed_mode) = (Some(feed), FeedMode::PerRevolution);
        } else {
            (self.track.feed, self.track.feed_mode) = (Some(feed * self.feed_unit()), FeedMode::PerMinute);
        }
        Ok(())
    }

    /// M136, and M137, which ends it: from the start of their block.
    pub(super) fn feeds_per_revolution(&mut self, on: bool) {
        self.modes.per_revolution = on;
        self.track.feed_mode = if on {
            FeedMode::PerRevolution
        } else {
            FeedMode::PerMinute
        };
    }

    /// `F AUTO`: the feed of `TOOL CALL`.
    pub(super) fn feed_of_tool(&mut self) {
        self.track.feed = self.modes.tool_feed.or(self.track.feed);
        if self.modes.tool_feed.is_some() && !self.modes.per_revolution {
            self.track.feed_mode = FeedMode::PerMinute;
        }
    }

    pub(super) fn words(&mut self, line: &Line) -> Result<MoveWords, Located> {
        let mut words = MoveWords {
            retract: (line.word(0) == "M140").then_some(None),
            ..MoveWords::default()
        };
        let mut index = 1;
        for token in &line.tokens {
            if let "M136" | "M137" = token.text.as_str() {
                self.feeds_per_revolution(token.text == "M136");
            }
        }
        // The code whose words follow.
        let mut code = 0;
        while index < line.tokens.len() {
            let token = &line.tokens[index];
            let mut text = token.text.clone();
            index += 1;
            // `F MAX`, `X +10`: a name and its value apart.
            let next = line.word(index);
            let letter_alone = text.len() <= 3
                && text.bytes().all(|b| b.is_ascii_alphabetic())
                && !matches!(text.as_str(), "RL" | "RR");
            if letter_alone
                && (next == "MAX"
                    || next == "AUTO"
                    || next.starts_with(|c: char| "+-".contains(c) || c.is_ascii_digit()))
            {
                text += next;
                index += 1;
            }
            let here = |problem| (problem, token.span.clone());
            let value = |reader: &Self, rest: &str| reader.parameters.value(rest).map_err(here);
            let (relative, name) = line::relative(&text);
            if belongs(code, name) {
                continue;
            }
            match name {
                "R0" => words.side = Some(None),
                "RL" => words.side = Some(Some(true)),
                "RR" => words.side = Some(Some(false)),
                "R+" | "R-" => {
                    return Err(here(NcProblem::unsupported(
                        format!("{name}: compensation along one axis is"),
                        "expected RL, RR or R0",
                    )));
                }
                "FMAX" => words.rapid = true,
                "FAUTO" => self.feed_of_tool(),
                "F" => {}
                "M140" => words.retract = words.retract.or(Some(None)),
                "MB" | "MBMAX" => words.retract = Some(None),
                name if name.starts_with("MB") => words.retract = Some(Some(value(self, &name[2..])? * self.unit())),
                name if name.starts_with("LEN") => {
                    words.length = Some(value(self, &name[3..])? * self.unit());
                }
                name if name.starts_with("CCA") => words.arc_angle = Some(value(self, &name[3..])?),
                "DR+" => words.counter_clockwise = Some(true),
                "DR-" => words.counter_clockwise = Some(false),
                _ => {
                    let named = |prefix: &str| name.strip_prefix(prefix).filter(|rest| !rest.is_empty());
                    let vector = ["NX", "NY", "NZ", "TX", "TY", "TZ"]
                        .iter()
                        .position(|prefix| named(prefix).is_some());
                    let polar = ["PR", "PA"].iter().position(|prefix| named(prefix).is_some());
                    let axis = AXES.iter().position(|prefix| named(prefix).is_some());
                    if let Some(k) = vector {
                        let value = value(self, &name[2..])?;
                        let place = if k < 3 {
                            &mut words.normal[k]
                        } else {
                            &mut words.tool[k - 3]
                        };
                        *place = Some(value);
                    } else if let Some(k) = polar {
                        let value = value(self, &name[2..])?;
                        words.polar[k] = Some((if k == 0 { value * self.unit() } else { value }, relative));
                    } else if let Some(k) = axis {
                        if words.axes[k].is_some() {
                            return Err(here(NcProblem::syntax(format!(
                                "a second {} in one block: expected one",
                                AXES[k]
                            ))));
                        }
                        let value = value(self, &name[1..])?;
                        words.axes[k] = Some((if k < 3 { value * self.unit() } else { value }, relative));
                    } else if let Some(rest) = named("M") {
                        code = rest.parse().unwrap_or(0);
                        words.machine = match rest {
                            "91" => Some(Datum::Machine),
                            "92" => Some(Datum::Builder),
                            _ => words.machine,
                        };
                    } else if let Some(rest) = named("F") {
                        self.feed_word(rest).map_err(here)?;
                    } else if let Some(rest) = named("R") {
                        words.radius = Some(value(self, rest)? * self.unit());
                    } else {
                        return Err(here(NcProblem::syntax(format!(
                            "{} in a move: expected axes, R0, F, M",
                            token.text
                        ))));
                    }
                }
            }
        }
        Ok(words)
    }
}
