//! Cycles: which there are, and where they are called.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::planes::is_frame_cycle;
use crate::controls::heidenhain::state::Defined;
use crate::drive::Cycle;
use crate::model::event::EventKind;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// Cycles that are in effect where they are called, whether they are known here or not.
const CALLED: [u32; 60] = [
    1, 2, 3, 4, 5, 6, 15, 16, 17, 18, 21, 22, 23, 24, 25, 27, 28, 29, 39, 200, 201, 202, 203, 204, 205, 206, 207, 208,
    209, 210, 211, 212, 213, 214, 215, 225, 230, 231, 232, 233, 240, 241, 251, 252, 253, 254, 256, 257, 258, 262, 263,
    264, 265, 267, 272, 273, 274, 275, 276, 277,
];

impl Reader<'_> {
    pub(in crate::controls::heidenhain) fn defined<'a>(&'a self, number: u32, line: &'a Line) -> Defined<'a> {
        Defined {
            number,
            line,
            parameters: &self.parameters,
            unit: self.unit(),
            feed_unit: self.feed_unit(),
            speed: self.modes.speed,
            per_revolution: self.modes.per_revolution,
        }
    }

    /// `CYCL DEF` and `CYCL CALL`.
    pub(in crate::controls::heidenhain) fn cycle_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if line.word(1) == "CALL" {
            self.codes(line)?;
            return match line.word(2) {
                _ if self.cycles.program.is_some() => self.call_cycle(line),
                "PAT" => self.call_at_pattern(line),
                "POS" => self.call_at_position(line),
                _ => self.call_cycle(line),
            };
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
            // Tolerance, spindle orientation, loads: they move nothing.
            13 | 32 | 238 | 239 => {}
            // The program of 12.1.
            12 if matches!(part, "" | "0") => {}
            12 => {
                let words = line.tokens.iter().skip(3).map(|token| token.text.as_str());
                let path = words.filter(|word| *word != "PGM").collect::<String>();
                self.cycles.program = Some(path);
                self.modes.calls_after_moves = false;
            }
            19 => self.working_plane(part, line)?,
            26 => self.scale_axes(part, line)?,
            14 => self.cycles.contours.name_labels(part, line),
            20 => self.contour_data(20, line)?,
            220 | 221 => self.pattern(number, line)?,
            // Those of the machine's builder, and of its probe.
            300..=499 => {
                let what = format!("cycle {number}, of the machine's builder or its probe");
                let assumption = Assumption::new(what, "it cuts nothing: left out", "the moves written out");
                self.track.assume(assumption.harmless());
            }
            // What is in effect where it is defined may move all that follows.
            _ if !CALLED.contains(&number) => {
                let name = format!("cycle {number}");
                self.track.leave_out_cycle(&name).map_err(whole)?;
                self.cycles.cycle.get_or_insert(Cycle::Unknown(name));
            }
            _ => {
                self.cycles.cycle = Some(self.define(number, line)?);
                self.cycles.block = Some((number, line.clone()));
                self.cycles.program = None;
                self.modes.calls_after_moves = false;
            }
        }
        Ok(())
    }

    /// A cycle that is called later.
    pub(super) fn define(&mut self, number: u32, line: &Line) -> Result<Cycle, Located> {
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
    pub(in crate::controls::heidenhain) fn call_cycle(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if let Some(program) = self.cycles.program.clone() {
            return self.call_path(&program, line);
        }
        match &self.cycles.cycle {
            Some(cycle) => self
                .track
                .cycle_here(cycle, self.modes.plane, self.uncertain)
                .map_err(whole),
            None if self.uncertain => Ok(()),
            None => Err(whole(NcProblem::syntax(
                "a cycle is called, but none is defined: expected CYCL DEF before it",
            ))),
        }
    }
}
