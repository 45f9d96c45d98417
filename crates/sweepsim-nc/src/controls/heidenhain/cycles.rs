//! Drilling cycles.

use super::interpreter::Reader;
use super::line::{Line, Located};
use super::planes::is_frame_cycle;
use crate::model::event::EventKind;
use crate::text::error::NcProblem;

/// The most infeeds of one hole.
const MOST_PECKS: usize = 10_000;

/// A drilling cycle, in millimetres along the tool's axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cycle {
    surface: f64,
    clearance: f64,
    second: f64,
    depth: f64,
    infeed: Option<f64>,
    decrement: f64,
    feed: Option<f64>,
    /// The feed out of the hole; without it, a rapid.
    out: Option<f64>,
    feeds_out: bool,
    dwell: f64,
}

impl Reader<'_> {
    /// `CYCL DEF` and `CYCL CALL`.
    pub(super) fn cycle_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if line.word(1) == "CALL" {
            match line.word(2) {
                "PAT" | "POS" => {
                    let problem = NcProblem::unsupported(
                        format!("CYCL CALL {} is", line.word(2)),
                        "expected L with M99 at each hole",
                    );
                    return Err(whole(problem));
                }
                _ => {}
            }
            self.codes(line)?;
            return self.drill().map_err(whole);
        }
        let name = line.word(2);
        let (number, part) = name.split_once('.').unwrap_or((name, ""));
        let Ok(number) = number.parse::<u32>() else {
            return Err(whole(NcProblem::syntax(
                "CYCL DEF without its number: expected such as CYCL DEF 200",
            )));
        };
        if is_frame_cycle(number) {
            return self.frame_cycle(number, part, line);
        }
        match number {
            // Dwell.
            9 => {
                let text = line.tokens.iter().skip(3).find_map(|token| {
                    ["V.ZEIT", "DWELL", "V.TIME"]
                        .iter()
                        .find_map(|name| token.text.strip_prefix(name).map(str::to_owned))
                });
                let last = line.tokens.last().map(|token| token.text.clone());
                if part == "1"
                    && let Some(text) = text.filter(|text| !text.is_empty()).or(last)
                    && let Ok(seconds) = self.parameters.value(&text)
                {
                    self.event(EventKind::Dwell { seconds }, line)?;
                }
                Ok(())
            }
            // Tolerance, spindle orientation, patterns' reference: they move nothing.
            13 | 32 => Ok(()),
            200 | 201 | 203 | 205 | 206 | 207 | 209 => {
                self.cycle = Some(self.define(number, line)?);
                Ok(())
            }
            _ => {
                let problem = NcProblem::unsupported(
                    format!("cycle {number} is"),
                    "expected 7, 8, 9, 10, 11, 200, 201, 203, 205, 206, 207, 209 or 247, or the moves that it makes",
                );
                Err(whole(problem))
            }
        }
    }

    fn define(&self, number: u32, line: &Line) -> Result<Cycle, Located> {
        let find = |parameter: u32| -> Result<Option<f64>, Located> {
            let name = format!("Q{parameter}=");
            for (index, token) in line.tokens.iter().enumerate() {
                if let Some(rest) = token.text.strip_prefix(&name) {
                    let text = if rest.is_empty() { line.word(index + 1) } else { rest };
                    return match self.parameters.value(text) {
                        Ok(value) => Ok(Some(value)),
                        // FMAX, FAUTO.
                        Err(_) if text.starts_with('F') || matches!(text, "MAX" | "AUTO") => Ok(None),
                        Err(problem) => Err((problem, token.span.clone())),
                    };
                }
            }
            Ok(None)
        };
        let unit = self.unit();
        let length = |parameter: u32| Ok::<Option<f64>, Located>(find(parameter)?.map(|value| value * unit));
        let need = |parameter: u32| {
            length(parameter)?.ok_or_else(|| {
                let problem = NcProblem::syntax(format!(
                    "cycle {number} without Q{parameter}: expected Q{parameter}= a number"
                ));
                (problem, line.all())
            })
        };
        let clearance = need(200)?.abs();
        let depth = need(201)?;
        if depth >= 0.0 {
            return Err((
                NcProblem::value(format!("the depth Q201 of cycle {number}"), depth, "negative"),
                line.all(),
            ));
        }
        let pecks = matches!(number, 200 | 203 | 205);
        let tapping = matches!(number, 206 | 207 | 209);
        Ok(Cycle {
            surface: length(203)?.unwrap_or(0.0),
            clearance,
            second: length(204)?.unwrap_or(0.0),
            depth,
            infeed: if pecks {
                length(202)?.filter(|infeed| *infeed > 0.0)
            } else {
                None
            },
            decrement: if pecks {
                length(212)?.unwrap_or(0.0).max(0.0)
            } else {
                0.0
            },
            feed: find(206)?,
            out: find(208)?.filter(|feed| *feed > 0.0),
            feeds_out: tapping || number == 201,
            dwell: find(211)?.unwrap_or(0.0).max(0.0),
        })
    }

    /// Calls the cycle at the current place.
    pub(super) fn drill(&mut self) -> Result<(), NcProblem> {
        let Some(cycle) = self.cycle.clone() else {
            if self.uncertain {
                return Ok(());
            }
            return Err(NcProblem::syntax(
                "a cycle is called, but none is defined: expected CYCL DEF before it",
            ));
        };
        let Some(here) = self.track.known() else {
            if self.uncertain {
                return Ok(());
            }
            return Err(NcProblem::syntax(
                "a cycle at an unknown position: expected a move to X, Y and Z before it",
            ));
        };
        let (w, abc) = (self.plane[2], self.track.abc);
        let modal = self.track.feed;
        self.track.calls()?;
        let go = |reader: &mut Self, height: f64, feed: Option<Option<f64>>| {
            let mut target = here;
            target[w] = height;
            if let Some(feed) = feed {
                reader.track.feed = feed.or(modal);
            }
            reader.track.line(target, abc, feed.is_none())
        };
        let above = cycle.surface + cycle.clearance;
        let bottom = cycle.surface + cycle.depth;
        go(self, above, None)?;
        let mut infeed = cycle.infeed.unwrap_or(-cycle.depth);
        let mut at = cycle.surface;
        let mut pecks = 0;
        loop {
            at = (at - infeed).max(bottom);
            go(self, at, Some(cycle.feed))?;
            pecks += 1;
            if at <= bottom {
                break;
            }
            if pecks >= MOST_PECKS {
                return Err(NcProblem::value("the number of infeeds of one hole", pecks, "smaller"));
            }
            go(self, above, None)?;
            go(self, (at + cycle.clearance.min(1.0)).min(above), None)?;
            infeed = (infeed - cycle.decrement).max(1e-3);
        }
        if cycle.dwell > 0.0 {
            self.track.event(EventKind::Dwell { seconds: cycle.dwell })?;
        }
        if cycle.feeds_out {
            go(self, above, Some(cycle.out.or(cycle.feed)))?;
        } else {
            go(self, above, None)?;
        }
        let second = cycle.surface + cycle.second;
        if second > above {
            go(self, second, None)?;
        }
        self.track.feed = modal;
        self.track.returns();
        Ok(())
    }
}
