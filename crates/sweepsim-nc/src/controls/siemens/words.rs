//! The words of a block: codes, tools, and what they set.

use std::ops::Range;

use super::interpreter::Reader;
use super::language::expression::{self, Expression, Kind, Value};
use super::language::structures::Item;
use super::state::{Operation, PoleFrom};
use crate::drive::CornerShape;
use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{FeedMode, Units};
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// How a value is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Plain,
    Absolute,
    Incremental,
    /// A rotary axis the shortest way, or in one sense.
    Shortest,
    Positive,
    Negative,
}

/// A word with its value.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub name: String,
    pub value: f64,
    pub meaning: Meaning,
    pub span: Range<usize>,
}

/// The words of a block.
#[derive(Clone, Debug, Default)]
pub(super) struct Words(pub Vec<Word>);

impl Words {
    pub fn get(&self, name: &str) -> Option<&Word> {
        self.0.iter().find(|word| word.name == name)
    }

    pub fn plain(&self, name: &str) -> Option<f64> {
        self.get(name).map(|word| word.value)
    }

    pub fn span(&self, name: &str) -> Range<usize> {
        self.get(name).map_or(0..0, |word| word.span.clone())
    }

    /// The first word with one of these names.
    pub fn any(&self, names: &[&str]) -> Option<&Word> {
        self.0.iter().find(|word| names.contains(&word.name.as_str()))
    }

    pub fn whole(&self) -> Range<usize> {
        match (self.0.first(), self.0.last()) {
            (Some(first), Some(last)) => first.span.start..last.span.end,
            _ => 0..0,
        }
    }
}

/// What a block does besides setting modes.
#[derive(Default)]
pub(super) struct Action {
    pub operation: Option<(Operation, Range<usize>)>,
    /// In machine coordinates: SUPA, G53, G153.
    pub machine: bool,
    /// To the reference point (G74), or to a fixed point (G75): `true`.
    pub home: Option<bool>,
    /// The number of the fixed point: FP.
    pub fixed_point: Option<f64>,
    pub dwell: bool,
    /// Words that are no coordinates: G25, G26, oriented spindle stops.
    pub other: bool,
    pub tool_change: bool,
    /// Cutter compensation off, to the left, or to the right: G40, G41, G42.
    pub side: Option<Option<bool>>,
    /// A new pole: G110, G111, G112.
    pub pole: Option<PoleFrom>,
    /// The corner at the end of the move, with its word, and its feed.
    pub corner: Option<(&'static str, CornerShape)>,
    pub corner_feed: Option<f64>,
    /// Stops after the move: M0 and M1.
    pub stops: Vec<(EventKind, Range<usize>)>,
}

/// The number of the spindle of `S1=` or `M1=`.
fn spindle(name: &str) -> Option<u32> {
    let digits = name.strip_prefix(['S', 'M'])?;
    (digits.len() == 1).then(|| digits.parse().ok()).flatten()
}

/// Whether a name that gets a value may be that of an axis: a letter with a digit, as C1.
fn is_axis(name: &str) -> bool {
    matches!(name.as_bytes(), [letter, digit] if letter.is_ascii_uppercase() && *letter != b'R' && digit.is_ascii_digit())
}

pub(super) fn unknown_axis(name: &str) -> NcProblem {
    NcProblem::unsupported(
        format!("{name}= is"),
        "it may be an axis; expected X, Y, Z, A, B or C, or DEF before it",
    )
}

impl Reader<'_> {
    pub(super) fn block(&mut self, items: &[Item]) -> Result<(), Located> {
        let mut words = Words::default();
        let mut action = Action::default();
        self.track.exact_stop = self.modes.exact_stop;
        let mut tool_name = None;
        for item in items {
            match item {
                Item::Set {
                    name,
                    indices,
                    value,
                    span,
                } => {
                    let key = expression::key(name, indices, &|name| self.lookup(name))?;
                    let value = value.value(&|name| self.lookup(name))?;
                    if let ("OFFN", Value::Number(allowance)) = (name.as_str(), &value) {
                        self.modes.allowance = allowance * self.modes.unit();
                        continue;
                    }
                    if let ("FZ", Value::Number(feed)) = (name.as_str(), &value) {
                        self.feed_per_tooth(*feed);
                        continue;
                    }
                    if let ("FP", Value::Number(number)) = (name.as_str(), &value) {
                        action.fixed_point = Some(*number);
                        continue;
                    }
                    if matches!(
                        name.as_str(),
                        "FA" | "ACC" | "OVRA" | "VELOLIM" | "JERKLIM" | "FGREF" | "FXST"
                    ) {
                        continue;
                    }
                    if matches!(name.as_str(), "POS" | "POSA" | "POSP" | "FOC" | "AX" | "IP" | "G") {
                        let problem = NcProblem::unsupported(
                            format!("{name} is"),
                            "expected axes by their letters, and G with its number",
                        );
                        return Err((problem, span.clone()));
                    }
                    if indices.is_empty() && is_axis(name) && !self.is_variable(name) {
                        return Err((unknown_axis(name), span.clone()));
                    }
                    self.assign(key, value).map_err(|problem| (problem, span.clone()))?;
                }
                Item::Word { name, value, span } => match (self.of_master(name), self.value_of(value)?) {
                    ("T", (Value::Text(text), _)) => tool_name = Some((text, span.clone())),
                    (_, (Value::Text(text), _)) => {
                        let problem = NcProblem::value(format!("the word {name}"), format!("{text:?}"), "a number");
                        return Err((problem, span.clone()));
                    }
                    (name, (Value::Number(value), meaning)) => {
                        let repeatable = matches!(name, "G" | "M" | "H" | "S");
                        if !repeatable && words.get(name).is_some() {
                            let problem = NcProblem::syntax(format!("a second {name} in one block: expected one"));
                            return Err((problem, span.clone()));
                        }
                        words.0.push(Word {
                            name: name.to_owned(),
                            value,
                            meaning,
                            span: span.clone(),
                        });
                    }
                },
                Item::Key { .. } => {}
            }
        }
        for word in words.0.iter().filter(|word| word.name == "G") {
            self.code(word.value, &mut action)
                .map_err(|problem| (problem, word.span.clone()))?;
        }
        for item in items {
            if let Item::Key { name, arguments, span } = item {
                self.keyword(name, arguments.as_deref(), &words, &mut action, span)?;
            }
        }
        if let Some((text, span)) = tool_name {
            let number = self.tool_number(&text);
            self.select(number).map_err(|problem| (problem, span))?;
        }
        let ends = self.settings(&words, &mut action)?;
        let modal_feed = self.track.feed;
        if let Some(feed) = words.plain("FB") {
            self.track.feed = Some(self.feed(feed));
        }
        if let Some((operation, _)) = action.operation {
            self.operate(operation, &words)?;
        } else if action.dwell {
            let seconds = match (words.plain("F"), words.plain("S"), self.modes.speed) {
                (Some(seconds), _, _) => seconds,
                (None, Some(turns), Some(speed)) if speed > 0.0 => 60.0 * turns / speed,
                _ => 0.0,
            };
            self.event(EventKind::Dwell { seconds }, words.whole())?;
        } else if !action.other {
            self.moves(&words, &action)?;
        }
        self.track.feed = modal_feed;
        for (kind, span) in action.stops {
            self.event(kind, span)?;
        }
        if ends {
            self.back();
            // M2 and M30 end the main program from wherever they are.
            if words
                .0
                .iter()
                .any(|word| word.name == "M" && matches!(word.value, 2.0 | 30.0))
            {
                self.ended = true;
            }
        }
        Ok(())
    }

    /// `S1=` and `M1=` of the master spindle are S and M; those of others are ignored.
    fn of_master<'a>(&mut self, name: &'a str) -> &'a str {
        match spindle(name) {
            Some(number) if number == self.modes.master => &name[..1],
            Some(_) => {
                self.track
                    .note(format!("{name}=, of another spindle than the master, is ignored"));
                name
            }
            None => name,
        }
    }

    /// The value of a word, and how it is meant.
    fn value_of(&self, value: &Expression) -> Result<(Value, Meaning), Located> {
        if let Kind::Call(name, arguments) = &value.kind {
            let meaning = match name.as_str() {
                "AC" => Some(Meaning::Absolute),
                "IC" => Some(Meaning::Incremental),
                "DC" => Some(Meaning::Shortest),
                "ACP" => Some(Meaning::Positive),
                "ACN" => Some(Meaning::Negative),
                _ => None,
            };
            if let (Some(meaning), [inner]) = (meaning, &arguments[..]) {
                return Ok((Value::Number(self.number(inner)?), meaning));
            }
        }
        Ok((value.value(&|name| self.lookup(name))?, Meaning::Plain))
    }

    pub(super) fn event(&mut self, kind: EventKind, span: Range<usize>) -> Result<(), Located> {
        self.track.event(kind).map_err(|problem| (problem, span))
    }

    /// The number of a tool that has a name: in the order of their first use.
    fn tool_number(&mut self, name: &str) -> u32 {
        let name = name.trim().to_owned();
        if let Some(&number) = self.modes.tools.get(&name) {
            return number;
        }
        let number = self.modes.tools.len() as u32 + 1;
        self.track.note(format!("tool {name:?} is taken as T{number}"));
        self.modes.tools.insert(name, number);
        number
    }

    /// Another tool comes into the spindle, with its first edge, as machines are delivered.
    fn insert(&mut self, tool: Option<u32>) -> Result<(), NcProblem> {
        if tool.is_some() && tool != self.track.tool {
            self.select_edge(1.0);
        }
        self.track.change_tool(tool)
    }

    fn select_edge(&mut self, edge: f64) {
        self.modes.without_length = edge == 0.0;
        self.modes.edge = edge as u32;
    }

    fn select(&mut self, number: u32) -> Result<(), NcProblem> {
        self.modes.selected = Some(number);
        // Programs without M6 change their tools by T alone; so does the first T of others, which may lie in the spindle.
        let first = self.track.tool.is_none();
        if number == 0 || !first && self.modes.changes_by_m6 {
            return Ok(());
        }
        if !first && self.track.tool != Some(number) {
            let taken = "at once: the program has no M6";
            let what = "when T changes the tool";
            self.track.assume(Assumption::new(what, taken, "M6 where it changes"));
        }
        self.insert(Some(number))?;
        Ok(())
    }

    /// `FZ=`, in `G95`.
    fn feed_per_tooth(&mut self, feed: f64) {
        let taken = "one: the feed per tooth is that per revolution";
        let what = "the number of teeth, for FZ";
        self.track.assume(Assumption::new(what, taken, "F in G95").harmless());
        self.track.feed_mode = FeedMode::PerRevolution;
        self.track.feed = Some(self.feed(feed));
    }

    /// A feed in the unit of the program.
    fn feed(&self, feed: f64) -> f64 {
        match self.track.feed_mode {
            FeedMode::InverseTime => feed,
            FeedMode::PerMinute | FeedMode::PerRevolution => {
                feed * (self.modes.unit() / self.track.program.units.in_mm())
            }
        }
    }

    /// F, S, T, D and M words. Whether the program ends.
    fn settings(&mut self, words: &Words, action: &mut Action) -> Result<bool, Located> {
        if self.track.program.poses.is_empty() {
            self.track.program.units = if self.modes.inch { Units::Inch } else { Units::Mm };
        }
        if !action.dwell
            && let Some(feed) = words.plain("F")
        {
            self.track.feed = Some(self.feed(feed));
            if self.modes.inch && !self.modes.inch_feeds && self.track.feed_mode != FeedMode::InverseTime {
                let taken = "inches, as on a control whose own unit that is";
                let what = "the unit of feeds after G70";
                self.track.assume(Assumption::new(what, taken, "G700").harmless());
            }
        }
        if let Some(word) = words.get("T") {
            NcProblem::whole("a tool number", word.value, 0..=u32::MAX, "a whole number")
                .and_then(|tool| self.select(tool))
                .map_err(|problem| (problem, word.span.clone()))?;
        }
        if let Some(offset) = words.plain("D") {
            self.select_edge(offset);
        }
        self.corner_words(words, action)?;
        if let Some(speed) = words.get("S").filter(|_| !action.dwell) {
            self.modes.speed = Some(speed.value);
        }
        let mut ends = false;
        let mut spindle = None;
        for word in words.0.iter().filter(|word| word.name == "M") {
            let rpm = self.modes.speed;
            match word.value {
                0.0 => action.stops.push((EventKind::Stop, word.span.clone())),
                1.0 => action.stops.push((EventKind::OptionalStop, word.span.clone())),
                2.0 | 17.0 | 30.0 => ends = true,
                3.0 => spindle = Some(Spindle::Clockwise { rpm }),
                4.0 => spindle = Some(Spindle::CounterClockwise { rpm }),
                5.0 => spindle = Some(Spindle::Stopped),
                19.0 => {}
                6.0 => {
                    action.tool_change = true;
                    let tool = self.modes.selected.filter(|tool| *tool > 0);
                    self.insert(tool).map_err(|problem| (problem, word.span.clone()))?;
                    if let Some(edge) = words.plain("D") {
                        self.select_edge(edge);
                    }
                }
                7.0 => self.event(EventKind::Coolant(Coolant::Mist), word.span.clone())?,
                8.0 => self.event(EventKind::Coolant(Coolant::Flood), word.span.clone())?,
                9.0 => self.event(EventKind::Coolant(Coolant::Off), word.span.clone())?,
                code => self.track.note(format!("M{code} is not understood: ignored")),
            }
        }
        if spindle.is_none() && words.get("S").is_some() && !action.dwell {
            spindle = match self.modes.spindle {
                Spindle::Clockwise { .. } => Some(Spindle::Clockwise { rpm: self.modes.speed }),
                Spindle::CounterClockwise { .. } => Some(Spindle::CounterClockwise { rpm: self.modes.speed }),
                _ => None,
            };
        }
        if let Some(spindle) = spindle
            && spindle != self.modes.spindle
        {
            self.modes.spindle = spindle;
            self.event(EventKind::Spindle(spindle), words.whole())?;
        }
        Ok(ends)
    }

    pub(super) fn without_length(&self) -> bool {
        self.modes.without_length
    }
}
