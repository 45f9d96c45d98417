//! Drilling cycles.

use super::interpreter::Reader;
use super::line::Line;
use super::planes::is_frame_cycle;
use crate::drive::{Cycle, HoleCycle, HoleWork, Pecks, Pocket, WayOut};
use crate::model::event::EventKind;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// By how much cycle 202 leaves the wall, in mm.
const FROM_THE_WALL: f64 = 0.2;

impl Reader<'_> {
    /// `CYCL DEF` and `CYCL CALL`.
    pub(super) fn cycle_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if line.word(1) == "CALL" {
            if let word @ ("PAT" | "POS") = line.word(2) {
                let found = format!("CYCL CALL {word} is");
                return Err(whole(NcProblem::unsupported(found, "expected L with M99 at each hole")));
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
            200..=209 | 240 | 241 | 262 => {
                self.cycle = Some(Cycle::Hole(self.define(number, line)?));
                Ok(())
            }
            251..=253 | 256 | 257 => {
                let pocket = self.pocket(number, line)?;
                self.cycle = Some(Cycle::Pocket(format!("cycle {number}"), Box::new(pocket)));
                Ok(())
            }
            // Those of the machine's builder, and of its probe.
            300..=499 => {
                let what = format!("cycle {number}, of the machine's builder or its probe");
                let assumption = Assumption::new(what, "it cuts nothing: left out", "the moves written out");
                self.track.assume(assumption.harmless());
                Ok(())
            }
            _ => {
                let problem = NcProblem::unsupported(
                    format!("cycle {number} is"),
                    "expected 7, 8, 9, 10, 11, 200 to 209, 240, 241, 247, 251 to 253, 256, 257 or 262, or the moves that it makes",
                );
                Err(whole(problem))
            }
        }
    }

    /// A parameter of a cycle, if it is there and a number.
    fn parameter(&self, line: &Line, parameter: u32) -> Result<Option<f64>, Located> {
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
    }

    /// Pockets (251, 252), slots (253) and studs (256, 257).
    ///
    /// Source: *TNC 620, Cycle Programming* (340 56x-02), 5.2 to 5.7.
    fn pocket(&mut self, number: u32, line: &Line) -> Result<Pocket, Located> {
        let fail = |problem| (problem, line.all());
        let tool = self.cutter_radius().ok_or_else(|| {
            fail(NcProblem::syntax(format!(
                "the radius of the tool of cycle {number} is not known: expected --diameters (in a job: `diameters`), or TOOL DEF … R"
            )))
        })?;
        let find = |parameter: u32| self.parameter(line, parameter);
        let unit = self.unit();
        let length = |parameter: u32| Ok::<Option<f64>, Located>(find(parameter)?.map(|value| value * unit));
        let need = |parameter: u32| {
            let problem = || {
                NcProblem::syntax(format!(
                    "cycle {number} without Q{parameter}: expected Q{parameter}= a number"
                ))
            };
            length(parameter)?.ok_or_else(|| fail(problem()))
        };
        let (half, corner, raw) = match number {
            251 => ([0.5 * need(218)?, 0.5 * need(219)?], length(220)?.unwrap_or(0.0), None),
            252 => ([0.5 * need(223)?; 2], 0.5 * need(223)?, None),
            253 => ([0.5 * need(218)?, 0.5 * need(219)?], 0.5 * need(219)?, None),
            256 => {
                let raw = [0.5 * need(424)?, 0.5 * need(425)?];
                (
                    [0.5 * need(218)?, 0.5 * need(219)?],
                    length(220)?.unwrap_or(0.0),
                    Some(raw),
                )
            }
            _ => ([0.5 * need(223)?; 2], 0.5 * need(223)?, Some([0.5 * need(222)?; 2])),
        };
        let [x, y] = half;
        let aside = match (number, find(367)?.unwrap_or(0.0)) {
            (253, 1.0) => [x, 0.0],
            (253, 2.0) => [x - corner, 0.0],
            (253, 3.0) => [corner - x, 0.0],
            (253, 4.0) => [-x, 0.0],
            (251 | 256, 1.0) => [x, y],
            (251 | 256, 2.0) => [-x, y],
            (251 | 256, 3.0) => [-x, -y],
            (251 | 256, 4.0) => [x, -y],
            _ => [0.0; 2],
        };
        let surface = length(203)?.unwrap_or(0.0);
        let start = surface + need(200)?.abs();
        let depth = need(201)?;
        if depth >= 0.0 {
            return Err(fail(NcProblem::value(
                format!("the depth Q201 of cycle {number}"),
                depth,
                "negative",
            )));
        }
        // Roughing alone leaves what is left for finishing.
        let kind = find(215)?.unwrap_or(0.0);
        let left = if kind == 1.0 {
            [length(368)?.unwrap_or(0.0), length(369)?.unwrap_or(0.0)]
        } else {
            [0.0; 2]
        };
        let infeed = if kind == 2.0 { length(338)? } else { length(202)? };
        let climbs = find(351)? != Some(-1.0);
        Ok(Pocket {
            half,
            corner,
            raw,
            aside,
            turn: find(if number == 253 { 374 } else { 224 })?.unwrap_or(0.0),
            start,
            surface,
            bottom: surface + depth,
            end: start.max(surface + length(204)?.unwrap_or(0.0)),
            infeed: infeed.unwrap_or(0.0),
            left,
            rim_alone: kind == 2.0,
            tool,
            step: tool * find(370)?.filter(|overlap| *overlap > 0.0).unwrap_or(1.0),
            feed: find(207)?,
            plunge: find(206)?,
            clockwise: climbs == raw.is_some(),
        })
    }

    fn define(&mut self, number: u32, line: &Line) -> Result<HoleCycle, Located> {
        let tool = if matches!(number, 208 | 262) {
            self.cutter_radius()
        } else {
            None
        };
        let find = |parameter: u32| self.parameter(line, parameter);
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
        let surface = length(203)?.unwrap_or(0.0);
        let start = surface + clearance;
        let dwell = match number {
            204 => find(255)?,
            208 => None,
            _ => find(211)?,
        };
        // The bottom is given below.
        let mut hole = HoleCycle::new(start, start, dwell, false);
        hole.end = start.max(surface + length(204)?.unwrap_or(0.0));
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
            hole.bottom = surface + (-thickness - clearance - edge);
            hole.feed = find(253)?;
            hole.aside = aside.map(|c| c * off);
            hole.work = HoleWork::Back {
                up: surface + (-thickness + depth - edge),
                feed: find(254)?,
                rapid: false,
            };
            return Ok(hole);
        }
        let depth = match number {
            // As deep as the cone of a point of 90 degrees is wide.
            240 if find(343)? == Some(1.0) => -0.5 * need(344)?.abs(),
            _ => need(201)?,
        };
        if depth >= 0.0 {
            return Err((
                NcProblem::value(format!("the depth Q201 of cycle {number}"), depth, "negative"),
                line.all(),
            ));
        }
        hole.bottom = surface + depth;
        hole.feed = find(206)?;
        hole.out = WayOut::RapidToStart;
        match number {
            200 | 203 | 205 => {
                if let Some(infeed) = length(202)?.filter(|infeed| *infeed > 0.0) {
                    hole.work = HoleWork::Pecks(Pecks {
                        first: surface - infeed,
                        infeed,
                        decrease: length(212)?.unwrap_or(0.0).max(0.0),
                        least: 1e-3,
                        clears: true,
                        above: clearance.min(1.0),
                        ..Pecks::default()
                    });
                }
            }
            208 | 262 => {
                let (diameter, pitch) = (need(335)?, need(if number == 208 { 334 } else { 239 })?.abs());
                let Some(tool) = tool else {
                    let problem = NcProblem::syntax(format!(
                        "the radius of the tool of cycle {number} is not known: expected it in the tool table, or TOOL DEF … R"
                    ));
                    return Err(fail(problem));
                };
                let radius = 0.5 * diameter - tool;
                if !(radius > 0.0 && pitch > 0.0) {
                    let problem = NcProblem::value(
                        format!("the hole of cycle {number}"),
                        format!("{diameter} mm wide, with an infeed of {pitch} mm"),
                        format!("wider than the tool, {} mm, with a positive infeed", 2.0 * tool),
                    );
                    return Err(fail(problem));
                }
                let sense = if find(351)? == Some(-1.0) { -1.0 } else { 1.0 };
                let turns = sense * ((start - hole.bottom) / pitch);
                hole.work = HoleWork::Helix { radius, turns };
            }
            // Boring, reaming and tapping.
            _ => {
                let out = find(208)?.filter(|feed| *feed > 0.0);
                hole.out = WayOut::FeedToStart(out);
                if number == 202 {
                    hole.aside = aside.unwrap_or_default().map(|c| c * FROM_THE_WALL);
                }
            }
        }
        Ok(hole)
    }

    /// Calls the cycle at the current place.
    pub(super) fn drill(&mut self) -> Result<(), NcProblem> {
        match &self.cycle {
            Some(cycle) => self.track.cycle_here(cycle, self.modes.plane, self.uncertain),
            None if self.uncertain => Ok(()),
            None => Err(NcProblem::syntax(
                "a cycle is called, but none is defined: expected CYCL DEF before it",
            )),
        }
    }
}
