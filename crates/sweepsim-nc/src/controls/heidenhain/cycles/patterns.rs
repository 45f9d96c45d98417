//! Places where a cycle is called: the patterns of cycles 220 and 221, `PATTERN DEF` with `CYCL CALL PAT`, and `CYCL
//! CALL POS`.
//!
//! Source: *TNC 640, Cycle Programming* (892903), 2.3 Pattern definition, 2.2 Calling cycles. The coordinate of a place
//! along the tool is added to the surface that the cycle has.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::state::{CyclePlace, Pattern};
use crate::drive::Cycle;
use crate::text::error::{Located, NcProblem};

/// The most places of a pattern.
const MOST_PLACES: u32 = 10_000;

/// `point` of a frame that begins at a place, with its axes at these angles.
fn placed([x, y]: [f64; 2], [first, second]: [f64; 2], [a, b]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = first.to_radians().sin_cos();
    let (s, c) = second.to_radians().sin_cos();
    [x + a * cos - b * s, y + a * sin + b * c]
}

impl Reader<'_> {
    /// Cycles 220 and 221: the cycle before at places on a circle or in rows, with the levels that they say.
    pub(super) fn pattern(&mut self, number: u32, line: &Line) -> Result<(), Located> {
        let defined = self.defined(number, line);
        let count = |parameter: u32| {
            let count = defined.find(parameter)?.unwrap_or(1.0);
            let expected = "a whole number from 1 on";
            NcProblem::whole(format!("Q{parameter}"), count, 1..=MOST_PLACES, expected)
                .map_err(|problem| defined.fail(problem))
        };
        let turned = |at: [f64; 2], angle: f64, point: [f64; 2]| placed(at, [angle; 2], point);
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
        let to = |[a, b]: [f64; 2]| CyclePlace { at: [a, b], above: 0.0 };
        places
            .into_iter()
            .try_for_each(|place| self.call_at(&cycle, to(place), true, None))
            .map_err(|problem| (problem, line.all()))
    }

    /// Goes over a place, not below a level, and calls a cycle there.
    fn call_at(&mut self, cycle: &Cycle, place: CyclePlace, rapid: bool, level: Option<f64>) -> Result<(), NcProblem> {
        let [u, v, w] = self.modes.plane;
        let [a, b] = place.at;
        self.track.use_offset(&mut self.frames.work)?;
        match self.track.known() {
            Some(mut at) => {
                if let Some(level) = level.filter(|level| at[w] < *level) {
                    at[w] = level;
                    self.track.line(at, self.track.abc, true)?;
                }
                (at[u], at[v]) = (a, b);
                self.track.line(at, self.track.abc, rapid)?;
            }
            None => (self.track.xyz[u], self.track.xyz[v]) = (Some(a), Some(b)),
        }
        self.track.cycle_here(cycle, self.modes.plane, self.uncertain)
    }

    /// The cycle as it is with its surface so much higher.
    fn raised(&mut self, above: f64, line: &Line) -> Result<Cycle, Located> {
        let Some((number, mut block)) = self.cycles.block.clone() else {
            let problem = "a cycle is called, but none is defined: expected CYCL DEF before it";
            return Err((NcProblem::syntax(problem), line.all()));
        };
        if above != 0.0 {
            let surface = self.defined(number, &block).find(203)?;
            let Some(surface) = surface else {
                let found = format!("a place at another height for cycle {number}, which has no surface Q203, is");
                return Err((NcProblem::unsupported(found, "expected Z+0"), line.all()));
            };
            let raised = surface + above / self.unit();
            let token = crate::controls::heidenhain::language::line::Token {
                text: format!("Q203={raised}"),
                span: line.all(),
            };
            // The first of two is the one that counts.
            block.tokens.insert(3, token);
        }
        self.define(number, &block)
    }

    /// `CYCL CALL PAT`.
    pub(super) fn call_at_pattern(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let places = match &self.cycles.pattern {
            Pattern::Places(places) => places.clone(),
            Pattern::Table(name) => {
                let what = format!("the cycle at the points of {name}");
                return self.track.leave_out_cycle(&what).map_err(whole);
            }
            Pattern::None if self.uncertain => return Ok(()),
            Pattern::None => {
                let problem = "CYCL CALL PAT without places: expected PATTERN DEF before it";
                return Err(whole(NcProblem::syntax(problem)));
            }
        };
        let rapid = self.feed_of_call(line)?;
        // Between places the tool is no lower than where it is called.
        let level = self.track.xyz[self.modes.plane[2]];
        let mut last: Option<(f64, Cycle)> = None;
        for place in places {
            let cycle = match &last {
                Some((above, cycle)) if *above == place.above => cycle.clone(),
                _ => self.raised(place.above, line)?,
            };
            self.call_at(&cycle, place, rapid, level).map_err(whole)?;
            last = Some((place.above, cycle));
        }
        Ok(())
    }

    /// Whether a call goes to its places in rapid; otherwise at the feed that it has, or that was last.
    fn feed_of_call(&mut self, line: &Line) -> Result<bool, Located> {
        for (index, token) in line.tokens.iter().enumerate().skip(3) {
            match token.text.strip_prefix('F') {
                Some("MAX") => return Ok(true),
                Some("") if line.word(index + 1) == "MAX" => return Ok(true),
                Some(value) if !matches!(value, "" | "AUTO") => {
                    let feed = self.feed_word(value);
                    feed.map_err(|problem| (problem, token.span.clone()))?;
                }
                _ => {}
            }
        }
        Ok(self.track.feed.is_none())
    }

    /// `CYCL CALL POS X Y Z`: the third coordinate raises the surface.
    pub(super) fn call_at_position(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let mut rest = line.clone();
        rest.tokens.drain(1..3);
        let words = self.words(&rest)?;
        let [u, v, w] = self.modes.plane;
        let at = |reader: &Self, k: usize| match words.axes[k] {
            Some((value, false)) => Some(value),
            Some((value, true)) => reader.track.xyz[k].map(|now| now + value),
            None => reader.track.xyz[k],
        };
        let (Some(a), Some(b)) = (at(self, u), at(self, v)) else {
            if self.uncertain {
                return Ok(());
            }
            let problem = "CYCL CALL POS without its place: expected X, Y and Z";
            return Err(whole(NcProblem::syntax(problem)));
        };
        let above = words.axes[w].map_or(0.0, |(value, _)| value);
        let cycle = self.raised(above, line)?;
        let place = CyclePlace { at: [a, b], above };
        let rapid = words.rapid || self.track.feed.is_none();
        self.call_at(&cycle, place, rapid, None).map_err(whole)
    }

    /// `PATTERN DEF POS1 (X… Y… Z…)`, `ROW1`, `PAT1`, `FRAME1`, `CIRC1`, `PITCHCIRC1`.
    pub(in crate::controls::heidenhain) fn pattern_block(&mut self, line: &Line) -> Result<(), Located> {
        let fail = |problem| (problem, line.all());
        let words: Vec<&str> = line.tokens.iter().skip(2).map(|token| token.text.as_str()).collect();
        let text = words.join(" ");
        let mut places = Vec::new();
        for part in text.split(')').map(str::trim).filter(|part| !part.is_empty()) {
            let (name, inside) = part.split_once('(').ok_or_else(|| {
                fail(NcProblem::syntax(format!(
                    "{part} in PATTERN DEF: expected such as POS1 (X+10 Y+10 Z+0)"
                )))
            })?;
            let kind = name.trim().trim_end_matches(|c: char| c.is_ascii_digit());
            let inside: Vec<&str> = inside.split_whitespace().collect();
            places.extend(self.places_of(kind, &inside).map_err(fail)?);
            if places.len() > MOST_PLACES as usize {
                let problem = NcProblem::value("the number of places of a pattern", places.len(), "at most 10000");
                return Err(fail(problem));
            }
        }
        self.cycles.pattern = Pattern::Places(places);
        Ok(())
    }

    fn places_of(&self, kind: &str, words: &[&str]) -> Result<Vec<CyclePlace>, NcProblem> {
        let find = |name: &str| {
            let mut named = words.iter().enumerate();
            named.find_map(|(k, word)| {
                let rest = word.strip_prefix(name)?;
                match rest {
                    // Its value apart.
                    "" => words.get(k + 1).copied(),
                    rest if rest.starts_with(|c: char| "+-.Q".contains(c) || c.is_ascii_digit()) => Some(rest),
                    _ => None,
                }
            })
        };
        let number = |name: &str| find(name).map(|text| self.parameters.value(text)).transpose();
        let need = |name: &str| {
            let missing = || NcProblem::syntax(format!("{kind} of PATTERN DEF without {name}: expected a number"));
            number(name)?.ok_or_else(missing)
        };
        let unit = self.unit();
        let length = |name: &str| Ok::<_, NcProblem>(need(name)? * unit);
        let angle = |name: &str| Ok::<_, NcProblem>(number(name)?.unwrap_or(0.0));
        let count = |name: &str| {
            let what = format!("{name} of PATTERN DEF");
            NcProblem::whole(what, need(name)?, 1..=MOST_PLACES, "a whole number from 1 on")
        };
        let start = [length("X")?, length("Y")?];
        let turned = |rotation: f64| -> Result<[f64; 2], NcProblem> {
            Ok([rotation + angle("ROTX")?, rotation + angle("ROTY")?])
        };
        let points: Vec<[f64; 2]> = match kind {
            "POS" => vec![start],
            "ROW" => {
                let (step, axes) = (length("D")?, turned(angle("ROT")?)?);
                (0..count("NUM")?)
                    .map(|k| placed(start, axes, [f64::from(k) * step, 0.0]))
                    .collect()
            }
            "PAT" | "FRAME" => {
                let (step, axes) = ([length("DX")?, length("DY")?], turned(angle("ROT")?)?);
                let (columns, rows) = (count("NUMX")?, count("NUMY")?);
                if columns.saturating_mul(rows) > MOST_PLACES {
                    let found = columns.saturating_mul(rows);
                    return Err(NcProblem::value(
                        "the number of places of a pattern",
                        found,
                        "at most 10000",
                    ));
                }
                let cells = if kind == "PAT" {
                    to_and_fro(columns, rows)
                } else {
                    around(columns, rows)
                };
                let point = |[i, j]: [u32; 2]| placed(start, axes, [f64::from(i) * step[0], f64::from(j) * step[1]]);
                cells.into_iter().map(point).collect()
            }
            "CIRC" | "PITCHCIRC" => {
                let (radius, first, count) = (0.5 * length("D")?, angle("START")?, count("NUM")?);
                let gaps = f64::from(count.max(2) - 1);
                let step = match (kind, number("STEP")?, number("END")?) {
                    ("CIRC", ..) => 360.0 / f64::from(count),
                    (_, Some(step), _) => step,
                    (_, None, Some(end)) => (end - first) / gaps,
                    _ => need("STEP")?,
                };
                (0..count)
                    .map(|k| placed(start, [first + f64::from(k) * step; 2], [radius, 0.0]))
                    .collect()
            }
            other => {
                let expected = "POS, ROW, PAT, FRAME, CIRC or PITCHCIRC";
                return Err(NcProblem::value("a pattern", other.to_owned(), expected));
            }
        };
        let above = number("Z")?.unwrap_or(0.0) * unit;
        Ok(points.into_iter().map(|at| CyclePlace { at, above }).collect())
    }
}

/// All cells of a grid, row by row.
fn to_and_fro(columns: u32, rows: u32) -> Vec<[u32; 2]> {
    let cell = |k: u32| {
        let (row, column) = (k / columns, k % columns);
        [if row % 2 == 0 { column } else { columns - 1 - column }, row]
    };
    (0..columns * rows).map(cell).collect()
}

/// The cells on the border of a grid, around.
fn around(columns: u32, rows: u32) -> Vec<[u32; 2]> {
    if columns == 1 || rows == 1 {
        return to_and_fro(columns, rows);
    }
    let (last, top) = (columns - 1, rows - 1);
    let mut cells: Vec<[u32; 2]> = (0..last).map(|i| [i, 0]).collect();
    cells.extend((0..top).map(|j| [last, j]));
    cells.extend((0..last).map(|i| [last - i, top]));
    cells.extend((0..top).map(|j| [0, top - j]));
    cells
}
