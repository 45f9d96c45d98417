//! Cycles: which there are, and where they are called.

use super::contour_cycles::ContourData;
use super::interpreter::Reader;
use super::line::Line;
use super::planes::is_frame_cycle;
use super::values::Parameters;
use crate::drive::Cycle;
use crate::model::event::EventKind;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// The most places of a pattern.
const MOST_PLACES: u32 = 10_000;

/// The cycle that `CYCL CALL` and `M99` call, and what cycles on contours share.
#[derive(Default)]
pub(super) struct Cycles {
    pub(super) cycle: Option<Cycle>,
    /// Its number and its block, which patterns take with other levels.
    block: Option<(u32, Line)>,
    pub(super) contours: ContourData,
}

/// The block that defines a cycle.
pub(super) struct Defined<'a> {
    pub number: u32,
    line: &'a Line,
    parameters: &'a Parameters,
    unit: f64,
}

impl Defined<'_> {
    /// A parameter, if it is there and a number.
    pub fn find(&self, parameter: u32) -> Result<Option<f64>, Located> {
        let name = format!("Q{parameter}=");
        for (index, token) in self.line.tokens.iter().enumerate() {
            if let Some(rest) = token.text.strip_prefix(&name) {
                let text = if rest.is_empty() {
                    self.line.word(index + 1)
                } else {
                    rest
                };
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

    /// A number, or 0.
    pub fn number(&self, parameter: u32) -> Result<f64, Located> {
        Ok(self.find(parameter)?.unwrap_or(0.0))
    }

    /// A length in mm, if it is there.
    pub fn length(&self, parameter: u32) -> Result<Option<f64>, Located> {
        Ok(self.find(parameter)?.map(|value| value * self.unit))
    }

    /// A length in mm, or 0.
    pub fn span(&self, parameter: u32) -> Result<f64, Located> {
        Ok(self.length(parameter)?.unwrap_or(0.0))
    }

    pub fn need(&self, parameter: u32) -> Result<f64, Located> {
        let number = self.number;
        let problem = || {
            NcProblem::syntax(format!(
                "cycle {number} without Q{parameter}: expected Q{parameter}= a number"
            ))
        };
        self.length(parameter)?.ok_or_else(|| self.fail(problem()))
    }

    /// A depth in mm, below 0.
    pub fn depth(&self, parameter: u32) -> Result<f64, Located> {
        let depth = self.need(parameter)?;
        if depth >= 0.0 {
            let what = format!("the depth Q{parameter} of cycle {}", self.number);
            return Err(self.fail(NcProblem::value(what, depth, "negative")));
        }
        Ok(depth)
    }

    pub fn fail(&self, problem: NcProblem) -> Located {
        (problem, self.line.all())
    }
}

impl Reader<'_> {
    pub(super) fn defined<'a>(&'a self, number: u32, line: &'a Line) -> Defined<'a> {
        Defined {
            number,
            line,
            parameters: &self.parameters,
            unit: self.unit(),
        }
    }

    /// `CYCL DEF` and `CYCL CALL`.
    pub(super) fn cycle_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if line.word(1) == "CALL" {
            if let word @ ("PAT" | "POS") = line.word(2) {
                let found = format!("CYCL CALL {word} is");
                return Err(whole(NcProblem::unsupported(found, "expected L with M99 at each hole")));
            }
            self.codes(line)?;
            return self.call_cycle().map_err(whole);
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
            9 => self.dwell_cycle(part, line)?,
            // Tolerance, spindle orientation: they move nothing.
            13 | 32 => {}
            14 => self.cycles.contours.name_labels(part, line),
            20 => self.contour_data(20, line)?,
            220 | 221 => self.pattern(number, line)?,
            // Those of the machine's builder, and of its probe.
            300..=499 => {
                let what = format!("cycle {number}, of the machine's builder or its probe");
                let assumption = Assumption::new(what, "it cuts nothing: left out", "the moves written out");
                self.track.assume(assumption.harmless());
            }
            _ => {
                self.cycles.cycle = Some(self.define(number, line)?);
                self.cycles.block = Some((number, line.clone()));
            }
        }
        Ok(())
    }

    /// A cycle that is called later.
    fn define(&mut self, number: u32, line: &Line) -> Result<Cycle, Located> {
        Ok(match number {
            200..=209 | 240 | 241 | 262..=265 | 267 => Cycle::Holes(self.holes(number, line)?),
            230 | 232 | 233 | 251..=254 | 256 | 257 => self.shape(number, line)?,
            22..=25 => self.contour_cycle(number, line)?,
            _ => Cycle::Unknown(format!("cycle {number}")),
        })
    }

    /// Cycle 9.
    fn dwell_cycle(&mut self, part: &str, line: &Line) -> Result<(), Located> {
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

    /// Calls the cycle at the current place.
    pub(super) fn call_cycle(&mut self) -> Result<(), NcProblem> {
        match &self.cycles.cycle {
            Some(cycle) => self.track.cycle_here(cycle, self.modes.plane, self.uncertain),
            None if self.uncertain => Ok(()),
            None => Err(NcProblem::syntax(
                "a cycle is called, but none is defined: expected CYCL DEF before it",
            )),
        }
    }

    /// Cycles 220 and 221: the cycle before at places on a circle or in rows, with the levels that they say.
    fn pattern(&mut self, number: u32, line: &Line) -> Result<(), Located> {
        let defined = self.defined(number, line);
        let count = |parameter: u32| {
            let count = defined.find(parameter)?.unwrap_or(1.0);
            let expected = "a whole number from 1 on";
            NcProblem::whole(format!("Q{parameter}"), count, 1..=MOST_PLACES, expected)
                .map_err(|problem| defined.fail(problem))
        };
        let turned = |[x, y]: [f64; 2], angle: f64, [a, b]: [f64; 2]| {
            let (sin, cos) = angle.to_radians().sin_cos();
            [x + a * cos - b * sin, y + a * sin + b * cos]
        };
        let places: Vec<[f64; 2]> = if number == 220 {
            let (count, middle) = (count(241)?, [defined.span(216)?, defined.span(217)?]);
            let (radius, first) = (0.5 * defined.need(244)?, defined.number(245)?);
            let stop = defined.find(246)?.unwrap_or(first + 360.0);
            let full = ((stop - first).abs() - 360.0).abs() < 1e-9 || stop == first;
            let gaps = if full { count } else { (count - 1).max(1) };
            let spread = if stop == first { 360.0 } else { stop - first };
            let step = defined.find(247)?.filter(|step| *step != 0.0);
            let step = step.unwrap_or(spread / f64::from(gaps));
            (0..count)
                .map(|k| turned(middle, first + f64::from(k) * step, [radius, 0.0]))
                .collect()
        } else {
            let (columns, rows) = (count(242)?, count(243)?);
            if columns.saturating_mul(rows) > MOST_PLACES {
                let problem = NcProblem::value("the number of places of cycle 221", columns * rows, "at most 10000");
                return Err(defined.fail(problem));
            }
            let (start, angle) = ([defined.span(225)?, defined.span(226)?], defined.number(224)?);
            let apart = [defined.span(237)?, defined.span(238)?];
            (0..columns * rows)
                .map(|k| {
                    let (row, column) = (k / columns, k % columns);
                    let column = if row % 2 == 0 { column } else { columns - 1 - column };
                    turned(start, angle, [f64::from(column) * apart[0], f64::from(row) * apart[1]])
                })
                .collect()
        };
        let cycle = match self.cycles.block.clone() {
            Some((number, mut block)) => {
                // The first of two is the one that counts.
                block.tokens.splice(3..3, line.tokens.iter().skip(3).cloned());
                self.define(number, &block)?
            }
            None => return Err((NcProblem::syntax("a pattern without a cycle before it"), line.all())),
        };
        let whole = |problem| (problem, line.all());
        let [u, v, _] = self.modes.plane;
        for [a, b] in places {
            self.track.use_offset(&mut self.frames.work).map_err(whole)?;
            match self.track.known() {
                Some(mut at) => {
                    (at[u], at[v]) = (a, b);
                    self.track.line(at, self.track.abc, true).map_err(whole)?;
                }
                None => (self.track.xyz[u], self.track.xyz[v]) = (Some(a), Some(b)),
            }
            self.track
                .cycle_here(&cycle, self.modes.plane, self.uncertain)
                .map_err(whole)?;
        }
        Ok(())
    }
}
