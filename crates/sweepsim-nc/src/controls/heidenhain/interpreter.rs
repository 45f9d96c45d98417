//! Runs a program: blocks in order, labels, calls and jumps.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::rc::Rc;

use super::cycles::Cycle;
use super::line::{self, Line, Located};
use super::moves::Corner;
use super::planes::Frames;
use super::values::Parameters;
use crate::drive::{Coordinates, Sense, Track};
use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{Program, Units};
use crate::model::read_options::ReadOptions;
use crate::model::stock::StockDescription;
use crate::text::error::{NcError, NcProblem, TextPosition};

/// The most problems after the first one.
const MOST_FURTHER: usize = 100;
/// The most blocks that a program runs, repeats included, and more for each of its lines.
const MOST_BLOCKS: usize = 1_000_000;
const BLOCKS_PER_LINE: usize = 10;
/// The most calls within each other.
const DEEPEST_CALL: usize = 32;

/// Finds the text of a program by its name, with the file it came from.
pub type Library<'a> = &'a dyn Fn(&str) -> Option<(PathBuf, String)>;

/// A program's text, block by block.
struct Unit {
    file: usize,
    texts: Vec<String>,
    /// Without continuations, which belong to the block before.
    lines: Vec<Rc<Line>>,
    labels: BTreeMap<String, usize>,
}

impl Unit {
    fn new(file: usize, text: &str) -> Self {
        let texts: Vec<String> = text.lines().map(str::to_owned).collect();
        let mut lines: Vec<Rc<Line>> = Vec::with_capacity(texts.len());
        let mut labels = BTreeMap::new();
        let mut continues: Option<usize> = None;
        // The cycle whose parameters may follow.
        let mut cycle: Option<usize> = None;
        for (index, text) in texts.iter().enumerate() {
            let trimmed = text.trim_end();
            let goes_on = trimmed.ends_with('~');
            let own = line::line(trimmed.trim_end_matches('~'));
            // Parameters of a cycle: with `~`, or on lines of their own.
            let first = continues.or(cycle.filter(|_| own.word(0).starts_with('Q')));
            cycle = first.and(cycle);
            if let Some(first) = first {
                let tokens = own.tokens.into_iter().map(|mut token| {
                    // Places are of the first line.
                    token.span = 0..texts[first].len();
                    token
                });
                Rc::make_mut(&mut lines[first]).tokens.extend(tokens);
                lines.push(Rc::new(Line::default()));
                continues = goes_on.then_some(first);
                continue;
            }
            continues = goes_on.then_some(index);
            cycle = (own.begins(&["CYCL", "DEF"]) && !own.word(2).contains('.')).then_some(index);
            if own.word(0) == "LBL" && own.word(1) != "0" {
                labels.entry(own.word(1).to_owned()).or_insert(index);
            }
            lines.push(Rc::new(own));
        }
        Self {
            file,
            texts,
            lines,
            labels,
        }
    }
}

/// A program, subprogram or repeated section on its way.
struct Level {
    unit: usize,
    next: usize,
    kind: LevelKind,
}

enum LevelKind {
    Program,
    /// Until LBL 0.
    Subprogram,
    /// From `from` to before `end`, this many more times.
    Section {
        from: usize,
        end: usize,
        times: usize,
    },
}

pub(super) struct Reader<'a> {
    pub track: Track,
    pub parameters: Parameters,
    pub frames: Frames,
    pub inch: bool,
    pub plane: [usize; 3],
    pub tip_control: bool,
    pub shortest: bool,
    /// The centre of CC, in the frame.
    pub centre: Option<[f64; 2]>,
    /// The direction of the last move in the plane, at its end.
    pub direction: Option<[f64; 2]>,
    pub corner: Option<Corner>,
    pub cycle: Option<Cycle>,
    pub uncertain: bool,
    library: Library<'a>,
    options: &'a ReadOptions,
    units: Vec<Unit>,
    names: BTreeMap<String, usize>,
    stack: Vec<Level>,
    ended: bool,
    tools: BTreeMap<String, u32>,
    speed: Option<f64>,
    spindle: Spindle,
    stock: [[Option<f64>; 3]; 2],
}

pub(super) fn read(text: &str, options: &ReadOptions, library: Library) -> Result<Program, NcError> {
    if !(options.arc_tolerance > 0.0 && options.arc_tolerance.is_finite()) {
        let problem = NcProblem::value("the arc tolerance", options.arc_tolerance, "a positive number of mm");
        return Err(NcError::new(problem, None));
    }
    let mut reader = Reader {
        track: Track::new(options, Sense::Tool),
        parameters: Parameters::default(),
        frames: Frames::default(),
        inch: options.inch,
        plane: [0, 1, 2],
        tip_control: options.machine.tip_control,
        shortest: false,
        centre: None,
        direction: None,
        corner: None,
        cycle: None,
        uncertain: false,
        library,
        options,
        units: vec![Unit::new(0, text)],
        names: BTreeMap::new(),
        stack: vec![Level {
            unit: 0,
            next: 0,
            kind: LevelKind::Program,
        }],
        ended: false,
        tools: BTreeMap::new(),
        speed: None,
        spindle: Spindle::Stopped,
        stock: [[None; 3]; 2],
    };
    let mut errors: Vec<NcError> = Vec::new();
    let mut messages = BTreeSet::new();
    let most_blocks = usize::try_from(options.most_blocks)
        .unwrap_or(usize::MAX)
        .min(MOST_BLOCKS + BLOCKS_PER_LINE * text.lines().count());
    let mut blocks = 0;
    while !reader.ended && errors.len() <= MOST_FURTHER {
        let Some((unit, index)) = reader.advance() else { break };
        let line = Rc::clone(&reader.units[unit].lines[index]);
        blocks += 1;
        let result = if blocks > most_blocks {
            reader.ended = true;
            let found = format!("over {most_blocks}");
            let problem = NcProblem::value(
                "the number of blocks that this program runs",
                found,
                "smaller: it may never end",
            );
            Err((problem, line.all()))
        } else {
            reader.block(&line, unit, index)
        };
        if let Err((problem, span)) = result {
            reader.uncertain = true;
            reader.corner = None;
            reader.track.leave([true; 3]);
            let message = problem.to_string();
            if messages.insert(message.clone()) {
                if options.lenient {
                    reader.track.note(format!("left out: {message}"));
                } else {
                    errors.push(reader.located(unit, index, problem, span));
                }
            }
        }
    }
    if let Some(error) = NcError::all(errors) {
        return Err(error);
    }
    if reader.track.program.poses.is_empty() {
        let line = text.lines().count().max(1);
        let problem = NcProblem::syntax("this program has no move: expected at least one with X, Y and Z known");
        return Err(NcError::new(problem, Some(TextPosition::in_line(line, "", 1, 1))));
    }
    Ok(reader.finish())
}

impl Reader<'_> {
    fn finish(mut self) -> Program {
        if let [[Some(x0), Some(y0), Some(z0)], [Some(x1), Some(y1), Some(z1)]] = self.stock {
            self.track.program.stock = Some(StockDescription::Block {
                min: [x0.min(x1), y0.min(y1), z0.min(z1)],
                max: [x0.max(x1), y0.max(y1), z0.max(z1)],
            });
        }
        self.track.program.units = if self.inch { Units::Inch } else { Units::Mm };
        self.track.finish()
    }

    fn located(&self, unit: usize, index: usize, problem: NcProblem, span: std::ops::Range<usize>) -> NcError {
        let unit = &self.units[unit];
        let text = &unit.texts[index];
        let floor = |mut byte: usize| {
            byte = byte.min(text.len());
            while !text.is_char_boundary(byte) {
                byte -= 1;
            }
            byte
        };
        let (start, end) = (floor(span.start), floor(span.end.max(span.start)));
        let column = 1 + text[..start].chars().count();
        let position = TextPosition::in_line(index + 1, text, column, text[start..end].chars().count());
        let error = NcError::new(problem, Some(position));
        match self.track.program.files.get(unit.file).filter(|_| unit.file > 0) {
            Some(file) => error.in_file(file),
            None => error,
        }
    }

    /// The next block, back to the caller where a program ends.
    fn advance(&mut self) -> Option<(usize, usize)> {
        loop {
            let level = self.stack.last_mut()?;
            if let LevelKind::Section { from, end, times } = &mut level.kind
                && level.next >= *end
            {
                *times -= 1;
                if *times > 0 {
                    level.next = *from;
                } else {
                    self.back();
                    continue;
                }
            }
            if level.next >= self.units[level.unit].lines.len() {
                self.back();
                continue;
            }
            let index = level.next;
            level.next += 1;
            let unit = level.unit;
            self.track.place.file = self.units[unit].file;
            self.track.place.line = index + 1;
            if !self.units[unit].lines[index].tokens.is_empty() {
                return Some((unit, index));
            }
        }
    }

    fn back(&mut self) {
        self.stack.pop();
        if self.stack.is_empty() {
            self.ended = true;
        } else {
            self.track.returns();
        }
    }

    /// The block after this one, without empty ones.
    pub(super) fn following(&self) -> Option<&Line> {
        let level = self.stack.last()?;
        let lines = &self.units[level.unit].lines;
        lines
            .get(level.next..)?
            .iter()
            .find(|line| !line.tokens.is_empty())
            .map(Rc::as_ref)
    }

    /// Millimetres per unit of length.
    pub(super) fn unit(&self) -> f64 {
        if self.inch { 25.4 } else { 1.0 }
    }

    fn block(&mut self, line: &Line, unit: usize, index: usize) -> Result<(), Located> {
        if line.skipped {
            if self.options.block_delete {
                return Ok(());
            }
            self.track.note("optional blocks (`/`) are executed");
        }
        let whole = |problem| (problem, line.all());
        match line.word(0) {
            "BEGIN" if line.word(1) == "PGM" => {
                if self.stack.len() == 1 {
                    self.inch = line.tokens.last().is_some_and(|token| token.text == "INCH");
                    self.track.program.title = line
                        .tokens
                        .get(2)
                        .map(|token| self.units[unit].texts[index][token.span.clone()].to_owned());
                }
            }
            "END" if line.word(1) == "PGM" => self.back(),
            "BLK" => self.stock_corner(line)?,
            "TOOL" if line.word(1) == "CALL" => self.tool_call(line)?,
            "TOOL" if line.word(1) == "DEF" => {}
            "L" | "LP" | "LN" | "C" | "CP" | "CR" | "CT" | "CC" | "RND" | "CHF" => self.path(line)?,
            "LBL" if line.word(1) == "0" => {
                if matches!(
                    self.stack.last(),
                    Some(Level {
                        kind: LevelKind::Subprogram,
                        ..
                    })
                ) {
                    self.back();
                }
            }
            "LBL" => {}
            "CALL" if line.word(1) == "LBL" => self.call_label(line, unit, index)?,
            "CALL" if line.word(1) == "PGM" => self.call_program(line)?,
            "FN" => {
                if let Some(label) = self.parameters.function(line)? {
                    self.jump(&label, unit).map_err(whole)?;
                }
            }
            word if word.starts_with("FN") => {
                // FN0: is FN 0:.
                let mut apart = line.clone();
                let rest = word[2..].to_owned();
                apart.tokens[0].text = "FN".into();
                apart.tokens.insert(
                    1,
                    line::Token {
                        text: rest,
                        span: line.span(0),
                    },
                );
                if let Some(label) = self.parameters.function(&apart)? {
                    self.jump(&label, unit).map_err(whole)?;
                }
            }
            word if word.starts_with('Q') => self.parameters.formula(line)?,
            "CYCL" => self.cycle_block(line)?,
            "PLANE" => self.plane_block(line)?,
            "FUNCTION" => self.function_block(line)?,
            "STOP" => {
                self.event(EventKind::Stop, line)?;
                self.codes(line)?;
            }
            word if word.starts_with('M') && word[1..].bytes().all(|b| b.is_ascii_digit()) => {
                self.codes(line)?;
            }
            // A comment or structure item.
            word if word.starts_with('*') => {}
            word => {
                let problem = NcProblem::unsupported(
                    format!("{word} is"),
                    "expected L, C, CC, CR, CT, CP, LP, LN, RND, CHF, TOOL CALL, LBL, CALL, FN, Q, CYCL or PLANE",
                );
                return Err((problem, line.span(0)));
            }
        }
        Ok(())
    }

    pub(super) fn event(&mut self, kind: EventKind, line: &Line) -> Result<(), Located> {
        self.track.event(kind).map_err(|problem| (problem, line.all()))
    }

    /// `BLK FORM 0.1 Z X-50 Y-50 Z-20`, `BLK FORM 0.2 X+50 Y+50 Z+0`.
    fn stock_corner(&mut self, line: &Line) -> Result<(), Located> {
        let corner = match line.word(2) {
            "0.1" => 0,
            "0.2" => 1,
            _ => {
                self.track.note("a stock other than a block is left out");
                return Ok(());
            }
        };
        for token in &line.tokens[3..] {
            let (relative, rest) = match token.text.strip_prefix('I') {
                Some(rest) => (true, rest),
                None => (false, token.text.as_str()),
            };
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
    fn tool_call(&mut self, line: &Line) -> Result<(), Located> {
        let mut tool = None;
        for (position, token) in line.tokens[2..].iter().enumerate() {
            let here = |problem| (problem, token.span.clone());
            let text = token.text.as_str();
            match text {
                "X" | "Y" | "Z" => {
                    self.plane = match text {
                        "X" => [1, 2, 0],
                        "Y" => [2, 0, 1],
                        _ => [0, 1, 2],
                    };
                }
                _ if position == 0 && text.starts_with('"') => {
                    let name = text.trim_matches('"').to_owned();
                    let next = self.tools.len() as u32 + 1;
                    let number = *self.tools.entry(name.clone()).or_insert(next);
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
                _ if text.starts_with('S') => self.speed = Some(self.parameters.value(&text[1..]).map_err(here)?),
                _ if text.starts_with('F') && text.len() > 1 => {
                    if let Ok(feed) = self.parameters.value(&text[1..]) {
                        self.track.feed = Some(feed);
                    }
                }
                _ if text.starts_with("DL") || text.starts_with("DR") => {
                    let value = self.parameters.value(&text[2..]).map_err(here)?;
                    if value != 0.0 {
                        self.track.note(
                            "oversizes of tools (DL, DR) are left out: the path is that of the tip as programmed",
                        );
                    }
                }
                _ => {
                    let problem =
                        NcProblem::syntax(format!("{text} in TOOL CALL: expected the tool, its axis, S and F"));
                    return Err(here(problem));
                }
            }
        }
        self.track
            .change_tool(tool.filter(|tool| *tool > 0))
            .map_err(|problem| (problem, line.all()))
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
            let rpm = self.speed;
            match code {
                0 | 1 => self.event(
                    if code == 0 {
                        EventKind::Stop
                    } else {
                        EventKind::OptionalStop
                    },
                    line,
                )?,
                2 | 30 => self.ended = true,
                3 | 13 => self.turn_spindle(Spindle::Clockwise { rpm }, line)?,
                4 | 14 => self.turn_spindle(Spindle::CounterClockwise { rpm }, line)?,
                5 => self.turn_spindle(Spindle::Stopped, line)?,
                6 => {}
                7 => self.event(EventKind::Coolant(Coolant::Mist), line)?,
                8 => self.event(EventKind::Coolant(Coolant::Flood), line)?,
                9 => self.event(EventKind::Coolant(Coolant::Off), line)?,
                99 => calls = true,
                126 => self.shortest = true,
                127 => self.shortest = false,
                128 => self.control(true),
                129 => self.control(false),
                94 => {
                    let reduced = self.track.abc.map(|angle| angle % 360.0);
                    self.track.abc = reduced;
                }
                89 | 97 | 98 | 101..=104 | 107 | 108 | 130 | 138 | 140 | 141 => {
                    let problem =
                        NcProblem::unsupported(format!("M{code} is"), "the path of the tool would be unknown");
                    return Err((problem, token.span.clone()));
                }
                // Machine coordinates are read with the move; others change no geometry.
                90..=92 | 109..=118 | 120 | 124 | 134..=137 | 144 | 145 | 148 | 149 | 197 => {}
                _ => self.track.note(format!("M{code} is not understood: ignored")),
            }
            if matches!(code, 13 | 14) {
                self.event(EventKind::Coolant(Coolant::Flood), line)?;
            }
        }
        Ok(calls)
    }

    fn turn_spindle(&mut self, spindle: Spindle, line: &Line) -> Result<(), Located> {
        if spindle == self.spindle {
            return Ok(());
        }
        self.spindle = spindle;
        self.event(EventKind::Spindle(spindle), line)
    }

    pub(super) fn control(&mut self, on: bool) {
        self.tip_control = on;
        let tip = on || self.frames.tilted();
        self.track
            .set_coordinates(if tip { Coordinates::Tip } else { Coordinates::Axes });
    }

    fn function_block(&mut self, line: &Line) -> Result<(), Located> {
        match (line.word(1), line.word(2)) {
            ("TCPM", _) => self.control(true),
            ("RESET", "TCPM") => self.control(false),
            ("MODE" | "FEED" | "DWELL" | "S-PULSE", _) => {}
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

    fn push(&mut self, level: Level, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if self.stack.len() > DEEPEST_CALL {
            return Err(whole(NcProblem::syntax(format!(
                "calls within calls: nested too deeply, expected at most {DEEPEST_CALL}"
            ))));
        }
        self.track.calls().map_err(whole)?;
        self.stack.push(level);
        Ok(())
    }

    /// `CALL LBL 1`, `CALL LBL 1 REP 2`.
    fn call_label(&mut self, line: &Line, unit: usize, index: usize) -> Result<(), Located> {
        let label = line.word(2).to_owned();
        let from = self.units[unit].labels.get(&label).copied().ok_or_else(|| {
            (
                NcProblem::syntax(format!("there is no LBL {label} in this program")),
                line.span(2),
            )
        })?;
        let repeats = match line.word(3) {
            "" => None,
            "REP" => Some(line.word(4).split('/').next().unwrap_or("")),
            word => Some(word.strip_prefix("REP").unwrap_or(word).split('/').next().unwrap_or("")),
        };
        let kind = match repeats {
            None => LevelKind::Subprogram,
            Some(text) => {
                let times = self.parameters.value(text).map_err(|problem| (problem, line.all()))?;
                if !(0.0..=65_534.0).contains(&times) || times.fract() != 0.0 {
                    return Err((
                        NcProblem::value("REP", times, "a whole number from 0 to 65534"),
                        line.all(),
                    ));
                }
                if times == 0.0 || from >= index {
                    return Ok(());
                }
                LevelKind::Section {
                    from,
                    end: index,
                    times: times as usize,
                }
            }
        };
        self.push(Level { unit, next: from, kind }, line)
    }

    fn call_program(&mut self, line: &Line) -> Result<(), Located> {
        let name = line.word(2).trim_matches('"').trim_end_matches(".H").to_owned();
        let unit = match self.names.get(&name) {
            Some(&unit) => unit,
            None => {
                let Some((file, text)) = (self.library)(&name) else {
                    let problem = NcProblem::unsupported(
                        format!("CALL PGM {name} is"),
                        format!("there is no {name}.H beside this file"),
                    );
                    return Err((problem, line.all()));
                };
                let files = &mut self.track.program.files;
                if files.is_empty() {
                    files.push(PathBuf::new());
                }
                files.push(file);
                let unit = Unit::new(files.len() - 1, &text);
                self.units.push(unit);
                self.names.insert(name, self.units.len() - 1);
                self.units.len() - 1
            }
        };
        let level = Level {
            unit,
            next: 0,
            kind: LevelKind::Program,
        };
        self.push(level, line)
    }

    fn jump(&mut self, label: &str, unit: usize) -> Result<(), NcProblem> {
        let to = self.units[unit].labels.get(label).copied();
        let to = to.ok_or_else(|| NcProblem::syntax(format!("there is no LBL {label} in this program")))?;
        // A jump out of a repeated section ends it.
        while let Some(Level {
            kind: LevelKind::Section { from, end, .. },
            ..
        }) = self.stack.last()
            && !(*from..*end).contains(&to)
        {
            self.back();
        }
        if let Some(level) = self.stack.last_mut() {
            level.next = to;
        }
        Ok(())
    }
}
