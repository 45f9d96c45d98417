//! Tools, stock and M codes.

use super::interpreter::Reader;
use super::language::line::{self, Line};
use crate::drive::Coordinates;
use crate::model::event::{Coolant, EventKind, Spindle};
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// `BLK FORM 0.1 Z X-50 Y-50 Z-20`, `BLK FORM 0.2 X+50 Y+50 Z+0`.
    pub(super) fn stock_corner(&mut self, line: &Line) -> Result<(), Located> {
        let corner = match line.word(2) {
            "0.1" => 0,
            "0.2" => 1,
            _ => {
                self.track.note("a stock other than a block is left out");
                return Ok(());
            }
        };
        for token in &line.tokens[3..] {
            let (relative, rest) = line::relative(&token.text);
            let Some(k) = ["X", "Y", "Z"].iter().position(|axis| rest.starts_with(axis)) else {
                continue;
            };
            if rest.len() == 1 {
                // The axis of the spindle.
                continue;
            }
            let value = self
                .parameters
                .value(&rest[1..])
                .map_err(|problem| (problem, token.span.clone()))?;
            let base = if relative { self.stock[0][k].unwrap_or(0.0) } else { 0.0 };
            self.stock[corner][k] = Some(base + value * self.unit());
        }
        Ok(())
    }

    /// `TOOL CALL 5 Z S3000 F500`, `TOOL CALL "MILL" Z S3000`, `TOOL CALL Z S3000`.
    pub(super) fn tool_call(&mut self, line: &Line) -> Result<(), Located> {
        let mut tool = None;
        let (mut longer, mut larger, mut rounder) = (None, None, 0.0);
        for (position, token) in line.tokens[2..].iter().enumerate() {
            let here = |problem| (problem, token.span.clone());
            let text = token.text.as_str();
            match text {
                "X" | "Y" | "Z" => {
                    self.modes.plane = match text {
                        "X" => [1, 2, 0],
                        "Y" => [2, 0, 1],
                        _ => [0, 1, 2],
                    };
                }
                _ if position == 0 && text.starts_with('"') => {
                    let name = text.trim_matches('"').to_owned();
                    let next = self.tools.values().max().map_or(1, |most| most + 1);
                    let number = *self.tools.entry(text.to_owned()).or_insert(next);
                    if number == next {
                        self.track.note(format!("tool {name:?} is taken as T{number}"));
                    }
                    tool = Some(number);
                }
                _ if position == 0 && text.starts_with(|c: char| c.is_ascii_digit() || c == 'Q') => {
                    let value = self.parameters.value(text).map_err(here)?;
                    if !(0.0..=f64::from(u32::MAX)).contains(&value) {
                        return Err(here(NcProblem::value("a tool number", value, "a whole number")));
                    }
                    // 5.1 is the first indexed offset of tool 5.
                    tool = Some(value as u32);
                }
                _ if text.starts_with('S') => self.modes.speed = Some(self.parameters.value(&text[1..]).map_err(here)?),
                _ if text.starts_with('F') && text.len() > 1 => {
                    self.feed_word(&text[1..]).map_err(here)?;
                    self.modes.tool_feed = self.track.feed;
                }
                _ if text.starts_with("DL") || text.starts_with("DR") => {
                    let rest = text[2..].trim_start_matches(':').trim_start_matches('=');
                    // DR2 is the oversize of a corner radius: it moves nothing but LN with normals.
                    let corner = rest
                        .strip_prefix('2')
                        .filter(|rest| rest.starts_with([':', '=', '+', '-']));
                    let rest = corner.map_or(rest, |rest| rest.trim_start_matches([':', '=']));
                    let value = self.parameters.value(rest).map_err(here)? * self.unit();
                    match (corner, text.starts_with("DL")) {
                        (Some(_), _) => rounder = value,
                        (None, true) => longer = Some(value),
                        (None, false) => larger = Some(value),
                    }
                }
                _ => {
                    let problem =
                        NcProblem::syntax(format!("{text} in TOOL CALL: expected the tool, its axis, S and F"));
                    return Err(here(problem));
                }
            }
        }
        let whole = |problem| (problem, line.all());
        // Another speed alone is in effect at once: it is said with the next codes, which may turn the spindle the other way.
        self.modes.other_speed |= tool.is_none();
        self.track.change_tool(tool.filter(|tool| *tool > 0)).map_err(whole)?;
        // Q108 is the radius of the tool.
        if let Some(radius) = self.known_radius() {
            self.parameters.set("Q108", radius / self.unit()).map_err(whole)?;
        }
        // Oversizes last until the next call of a tool, and are 0 there unless it says otherwise.
        if tool.is_some() || longer.is_some() {
            self.track.lengthen(longer.unwrap_or(0.0)).map_err(whole)?;
        }
        if tool.is_some() || larger.is_some() {
            self.modes.oversize = larger.unwrap_or(0.0);
            self.modes.corner_oversize = rounder;
        }
        Ok(())
    }

    /// `TOOL DEF 5 L+10 R+5`: the tool's measures, if it has them.
    pub(super) fn tool_definition(&mut self, line: &Line) -> Result<(), Located> {
        let Some(number) = line.word(2).parse::<u32>().ok() else {
            return Ok(());
        };
        for token in line.tokens.iter().skip(3) {
            if let Some(radius) = token.text.strip_prefix('R') {
                let radius = self
                    .parameters
                    .value(radius)
                    .map_err(|problem| (problem, token.span.clone()))?;
                let radius = radius * self.unit();
                self.modes.radii.insert(number, radius);
            }
        }
        Ok(())
    }

    /// The M codes of a block. Whether the cycle is called (M99).
    pub(super) fn codes(&mut self, line: &Line) -> Result<bool, Located> {
        let mut calls = false;
        for token in &line.tokens {
            let Some(code) = token
                .text
                .strip_prefix('M')
                .and_then(|digits| digits.parse::<u32>().ok())
            else {
                continue;
            };
            let rpm = self.modes.speed;
            match code {
                0 => self.at_end.push(EventKind::Stop),
                1 => self.at_end.push(EventKind::OptionalStop),
                2 | 30 => self.ended = true,
                3 | 13 => self.turn_spindle(Spindle::Clockwise { rpm }, line)?,
                4 | 14 => self.turn_spindle(Spindle::CounterClockwise { rpm }, line)?,
                5 => self.at_end.push(EventKind::Spindle(Spindle::Stopped)),
                6 | 19 => {}
                7 => self.event(EventKind::Coolant(Coolant::Mist), line)?,
                8 => self.event(EventKind::Coolant(Coolant::Flood), line)?,
                9 => self.at_end.push(EventKind::Coolant(Coolant::Off)),
                89 => (calls, self.modes.calls_after_moves) = (true, true),
                99 => (calls, self.modes.calls_after_moves) = (true, false),
                126 => self.modes.shortest = true,
                127 => self.modes.shortest = false,
                128 => self.control(true).map_err(|problem| (problem, token.span.clone()))?,
                129 => self.control(false).map_err(|problem| (problem, token.span.clone()))?,
                94 => {
                    let reduced = self.track.abc.map(|angle| angle % 360.0);
                    self.track.abc = reduced;
                }
                103 => self.track.note("M103: the feed of plunging moves is that of others"),
                136 | 137 => self.feeds_per_revolution(code == 136),
                97 | 98 | 104 | 130 | 138 => {
                    let problem =
                        NcProblem::unsupported(format!("M{code} is"), "the path of the tool would be unknown");
                    return Err((problem, token.span.clone()));
                }
                // Machine coordinates are read with the move; others change no geometry.
                90..=92 | 101 | 102 | 107..=118 | 120 | 124 | 134 | 135 | 140 | 141 | 144 | 145 | 148 | 149 | 197 => {}
                _ => self.track.note(format!("M{code} is not understood: ignored")),
            }
            if matches!(code, 13 | 14) {
                self.event(EventKind::Coolant(Coolant::Flood), line)?;
            }
        }
        if std::mem::take(&mut self.modes.other_speed) {
            let rpm = self.modes.speed;
            match self.modes.spindle {
                Spindle::Clockwise { .. } => self.turn_spindle(Spindle::Clockwise { rpm }, line)?,
                Spindle::CounterClockwise { .. } => self.turn_spindle(Spindle::CounterClockwise { rpm }, line)?,
                _ => {}
            }
        }
        Ok(calls)
    }

    /// What the codes of a block do at its end: stops, M5 and M9.
    pub(super) fn end_codes(&mut self, line: &Line) -> Result<(), Located> {
        for event in std::mem::take(&mut self.at_end) {
            match event {
                EventKind::Spindle(spindle) => self.turn_spindle(spindle, line)?,
                event => self.event(event, line)?,
            }
        }
        Ok(())
    }

    pub(super) fn turn_spindle(&mut self, spindle: Spindle, line: &Line) -> Result<(), Located> {
        if spindle == self.modes.spindle {
            return Ok(());
        }
        self.modes.spindle = spindle;
        self.event(EventKind::Spindle(spindle), line)
    }

    pub(super) fn control(&mut self, on: bool) -> Result<(), NcProblem> {
        self.modes.tip_control = on;
        let tip = on || self.frames.tilted();
        self.track
            .set_coordinates(if tip { Coordinates::Tip } else { Coordinates::Axes })
    }

    pub(super) fn function_block(&mut self, line: &Line) -> Result<(), Located> {
        match (line.word(1), line.word(2)) {
            ("TCPM", _) => self.control(true).map_err(|problem| (problem, line.all()))?,
            ("RESET", "TCPM") => self.control(false).map_err(|problem| (problem, line.all()))?,
            // X is a diameter there.
            ("MODE", "TURN") => {
                let problem = NcProblem::unsupported("FUNCTION MODE TURN is", "expected FUNCTION MODE MILL");
                return Err((problem, line.all()));
            }
            ("MODE" | "FEED" | "DWELL" | "S-PULSE" | "SPINDLE" | "TOUCHPROBE", _) => {}
            // Whether contours are those of the tool or of the part matters to paths in space alone.
            ("PROG", "PATH") => self
                .track
                .note("FUNCTION PROG PATH is ignored: contours are taken as programmed"),
            (word, _) => {
                let problem = NcProblem::unsupported(
                    format!("FUNCTION {word} is"),
                    "expected FUNCTION TCPM or FUNCTION RESET TCPM",
                );
                return Err((problem, line.all()));
            }
        }
        Ok(())
    }
}
