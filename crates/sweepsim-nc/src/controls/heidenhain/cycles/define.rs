//! Cycles: which there are, and where they are called.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::line::Line;
use crate::controls::heidenhain::planes::is_frame_cycle;
use crate::controls::heidenhain::state::Defined;
use crate::drive::Cycle;
use crate::model::event::EventKind;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// The most places of a pattern.
const MOST_PLACES: u32 = 10_000;

impl Reader<'_> {
    pub(in crate::controls::heidenhain) fn defined<'a>(&'a self, number: u32, line: &'a Line) -> Defined<'a> {
        Defined {
            number,
            line,
            parameters: &self.parameters,
            unit: self.unit(),
        }
    }

    /// `CYCL DEF` and `CYCL CALL`.
    pub(in crate::controls::heidenhain) fn cycle_block(&mut self, line: &Line) -> Result<(), Located> {
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
    pub(in crate::controls::heidenhain) fn call_cycle(&mut self) -> Result<(), NcProblem> {
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
