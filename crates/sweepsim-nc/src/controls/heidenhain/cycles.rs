//! Drilling cycles.

use std::f64::consts::TAU;

use super::interpreter::Reader;
use super::line::Line;
use super::planes::is_frame_cycle;
use crate::drive::CircularArc;
use crate::model::event::EventKind;
use crate::text::error::{Located, NcProblem};

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
    kind: Kind,
}

/// What a cycle does besides going down and up.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Drill,
    /// 202: away from the wall by 0.2 mm before it goes up, in one of the plane's directions.
    Bore {
        aside: Option<[f64; 2]>,
    },
    /// 204: through the hole beside its middle, and up from below.
    Back {
        /// By how much, in which direction.
        aside: [f64; 2],
        /// The lower end of the counterbore's stroke below the surface, and its upper end.
        below: f64,
        up: f64,
        feed: Option<f64>,
    },
    /// 208: a helix of this radius and pitch, counter-clockwise or clockwise.
    Helix {
        radius: f64,
        pitch: f64,
        counter_clockwise: bool,
    },
}

/// By how much cycle 202 leaves the wall, in mm.
const FROM_THE_WALL: f64 = 0.2;

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
            200..=209 => {
                self.cycle = Some(self.define(number, line)?);
                Ok(())
            }
            _ => {
                let problem = NcProblem::unsupported(
                    format!("cycle {number} is"),
                    "expected 7, 8, 9, 10, 11, 200 to 209 or 247, or the moves that it makes",
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
        let fail = |problem| (problem, line.all());
        let aside = match find(214)?.unwrap_or(0.0) {
            0.0 => None,
            1.0 => Some([-1.0, 0.0]),
            2.0 => Some([0.0, -1.0]),
            3.0 => Some([1.0, 0.0]),
            4.0 => Some([0.0, 1.0]),
            other => {
                return Err(fail(NcProblem::value(
                    format!("Q214 of cycle {number}"),
                    other,
                    "0, 1, 2, 3 or 4",
                )));
            }
        };
        if number == 204 {
            let Some(aside) = aside else {
                let problem =
                    NcProblem::syntax("cycle 204 without a direction beside the middle: expected Q214=1, 2, 3 or 4");
                return Err(fail(problem));
            };
            let (depth, thickness, off, edge) = (need(249)?, need(250)?, need(251)?, need(252)?);
            if !(depth > 0.0 && thickness > 0.0) {
                return Err(fail(NcProblem::value(
                    "Q249 and Q250 of cycle 204",
                    format!("{depth} and {thickness}"),
                    "positive",
                )));
            }
            return Ok(Cycle {
                surface: length(203)?.unwrap_or(0.0),
                clearance,
                second: length(204)?.unwrap_or(0.0),
                depth: -thickness,
                infeed: None,
                decrement: 0.0,
                feed: find(253)?,
                out: None,
                feeds_out: false,
                dwell: find(255)?.unwrap_or(0.0).max(0.0),
                kind: Kind::Back {
                    aside: aside.map(|c| c * off),
                    below: -thickness - clearance - edge,
                    up: -thickness + depth - edge,
                    feed: find(254)?,
                },
            });
        }
        let depth = need(201)?;
        if depth >= 0.0 {
            return Err((
                NcProblem::value(format!("the depth Q201 of cycle {number}"), depth, "negative"),
                line.all(),
            ));
        }
        let kind = match number {
            202 => Kind::Bore {
                aside: aside.map(|c| c.map(|c| c * FROM_THE_WALL)),
            },
            208 => {
                let (diameter, pitch) = (need(335)?, need(334)?);
                let Some(tool) = self.cutter_radius() else {
                    let problem = NcProblem::syntax(
                        "the radius of the tool of cycle 208 is not known: expected it in the tool table, or TOOL DEF … R",
                    );
                    return Err(fail(problem));
                };
                let radius = 0.5 * diameter - tool;
                if !(radius > 0.0 && pitch > 0.0) {
                    let problem = NcProblem::value(
                        "the hole of cycle 208",
                        format!("{diameter} mm wide, with an infeed of {pitch} mm"),
                        format!("wider than the tool, {} mm, with a positive infeed", 2.0 * tool),
                    );
                    return Err(fail(problem));
                }
                Kind::Helix {
                    radius,
                    pitch,
                    counter_clockwise: find(351)? != Some(-1.0),
                }
            }
            _ => Kind::Drill,
        };
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
            feeds_out: tapping || matches!(number, 201 | 202),
            dwell: find(211)?.unwrap_or(0.0).max(0.0),
            kind,
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
        let (w, abc) = (self.modes.plane[2], self.track.abc);
        let modal = self.track.feed;
        self.track.calls()?;
        let [u, v, _] = self.modes.plane;
        let mut aside = [0.0; 2];
        let go = |reader: &mut Self, aside: [f64; 2], height: f64, feed: Option<Option<f64>>| {
            let mut target = here;
            target[u] += aside[0];
            target[v] += aside[1];
            target[w] = height;
            if let Some(feed) = feed {
                reader.track.feed = feed.or(modal);
            }
            reader.track.line(target, abc, feed.is_none())
        };
        let above = cycle.surface + cycle.clearance;
        let bottom = cycle.surface + cycle.depth;
        go(self, aside, above, None)?;
        let rest = |reader: &mut Self| match cycle.dwell > 0.0 {
            true => reader.track.event(EventKind::Dwell { seconds: cycle.dwell }),
            false => Ok(()),
        };
        let into = Some(cycle.feed);
        match cycle.kind {
            Kind::Back {
                aside: beside,
                below,
                up,
                feed,
            } => {
                let (below, up) = (cycle.surface + below, cycle.surface + up);
                go(self, beside, above, into)?;
                go(self, beside, below, into)?;
                go(self, [0.0; 2], below, into)?;
                go(self, [0.0; 2], up, Some(feed))?;
                rest(self)?;
                go(self, [0.0; 2], below, into)?;
                go(self, beside, below, into)?;
                go(self, beside, above, into)?;
            }
            Kind::Helix {
                radius,
                pitch,
                counter_clockwise,
            } => {
                // To the wall above the surface, down in whole turns and a part of one, once more around at the bottom.
                self.track.feed = cycle.feed.or(modal);
                go(self, [radius, 0.0], above, into)?;
                let turns = (above - bottom) / pitch;
                if !(turns <= MOST_PECKS as f64) {
                    return Err(NcProblem::value("the number of turns of one hole", turns, "smaller"));
                }
                let sense = if counter_clockwise { 1.0 } else { -1.0 };
                let (sin, cos) = (sense * turns * TAU).sin_cos();
                let mut end = here;
                end[u] += radius * cos;
                end[v] += radius * sin;
                end[w] = bottom;
                for (turns, height) in [(turns, above), (1.0, bottom)] {
                    let mut start = here;
                    start[w] = height;
                    let arc = CircularArc {
                        start,
                        end,
                        plane: self.modes.plane,
                        centre: [here[u], here[v]],
                        sweep: sense * turns * TAU,
                    };
                    self.track.circle(&arc, abc)?;
                }
                go(self, [0.0; 2], bottom, into)?;
            }
            Kind::Drill | Kind::Bore { .. } => {
                let mut infeed = cycle.infeed.unwrap_or(-cycle.depth);
                let mut at = cycle.surface;
                let mut pecks = 0;
                loop {
                    at = (at - infeed).max(bottom);
                    go(self, aside, at, into)?;
                    pecks += 1;
                    if at <= bottom {
                        break;
                    }
                    if pecks >= MOST_PECKS {
                        return Err(NcProblem::value("the number of infeeds of one hole", pecks, "smaller"));
                    }
                    go(self, aside, above, None)?;
                    go(self, aside, (at + cycle.clearance.min(1.0)).min(above), None)?;
                    infeed = (infeed - cycle.decrement).max(1e-3);
                }
                rest(self)?;
                if let Kind::Bore { aside: Some(away) } = cycle.kind {
                    aside = away;
                    go(self, aside, bottom, into)?;
                }
            }
        }
        if cycle.feeds_out {
            go(self, aside, above, Some(cycle.out.or(cycle.feed)))?;
        } else if !matches!(cycle.kind, Kind::Back { .. }) {
            go(self, aside, above, None)?;
        }
        go(self, [0.0; 2], above, None)?;
        let second = cycle.surface + cycle.second;
        if second > above {
            go(self, [0.0; 2], second, None)?;
        }
        self.track.feed = modal;
        self.track.returns();
        Ok(())
    }
}
