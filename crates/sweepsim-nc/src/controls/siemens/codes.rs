//! G codes and keywords.

use std::ops::Range;

use super::cycles::{Arguments, CONTOURS, HOLES, MILLING, PATTERNS, UNCHECKED, hole_cycle, thread, workpiece};
use super::interpreter::Reader;
use super::language::expression::{Expression, Value};
use super::language::structures::Call;
use super::state::{Modal, Motion, Operation, PoleFrom};
use super::words::{Action, Words};
use crate::drive::{Coordinates, Corners, Cycle, UNKNOWN_TOOL};
use crate::model::event::EventKind;
use crate::model::program::FeedMode;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// A G code.
    pub(super) fn code(&mut self, value: f64, action: &mut Action) -> Result<(), NcProblem> {
        let refuse = |what: &str| {
            Err(NcProblem::unsupported(
                format!("G{value}: {what}"),
                "the path of the tool would be unknown; expected G0, G1, G2 or G3",
            ))
        };
        if value.fract() != 0.0 || !(0.0..=9999.0).contains(&value) {
            return refuse("this code is");
        }
        match value as u32 {
            0 => self.modes.motion = Motion::Rapid,
            1 => self.modes.motion = Motion::Feed,
            code @ (2 | 3) => {
                let counter_clockwise = code == 3;
                self.modes.motion = Motion::Arc { counter_clockwise };
            }
            4 => action.dwell = true,
            17 => self.modes.plane = [0, 1, 2],
            18 => self.modes.plane = [2, 0, 1],
            19 => self.modes.plane = [1, 2, 0],
            25 | 26 => action.other = true,
            53 | 153 => action.machine = true,
            54..=57 => return self.select_offset(value as u32 - 53),
            500 => return self.select_offset(0),
            505..=599 => return self.select_offset(value as u32 - 500),
            code @ (70 | 700) => (self.modes.inch, self.modes.inch_feeds) = (true, code == 700),
            71 | 710 => self.modes.inch = false,
            code @ (74 | 75) => action.home = Some(code == 75),
            90 => self.modes.absolute = true,
            91 => self.modes.absolute = false,
            93 => self.track.feed_mode = FeedMode::InverseTime,
            94 => self.track.feed_mode = FeedMode::PerMinute,
            95 => self.track.feed_mode = FeedMode::PerRevolution,
            40 => action.side = Some(None),
            41 => action.side = Some(Some(true)),
            42 => action.side = Some(Some(false)),
            450 => self.modes.corners = Corners::Arcs,
            451 => self.modes.corners = Corners::Meetings,
            33..=35 | 63 | 331 | 332 => return refuse("threading is"),
            58 | 59 => return refuse("shifting frames axis by axis is"),
            110 => action.pole = Some(PoleFrom::Position),
            111 => action.pole = Some(PoleFrom::Zero),
            112 => action.pole = Some(PoleFrom::Pole),
            9 => self.track.exact_stop = true,
            60 => (self.modes.exact_stop, self.track.exact_stop) = (true, true),
            64 | 641..=645 => (self.modes.exact_stop, self.track.exact_stop) = (false, false),
            // Kinds of exact stops, corner feeds, approach behind the contour, speeds.
            96 | 97 | 452 | 453 | 458..=461 | 601..=603 | 621 | 961 | 962 | 971..=973 => {}
            140..=143 | 147 | 148 | 247 | 248 | 340 | 341 | 347 | 348 => {
                return refuse("smooth approach and retraction are");
            }
            _ => return refuse("this code is"),
        }
        Ok(())
    }

    pub(super) fn keyword(
        &mut self,
        name: &str,
        arguments: Option<&[Option<Expression>]>,
        words: &Words,
        action: &mut Action,
        span: &Range<usize>,
    ) -> Result<(), Located> {
        let here = |problem: NcProblem| (problem, span.clone());
        if let Some(operation) = Operation::named(name) {
            action.operation = Some((operation, span.clone()));
            return Ok(());
        }
        match name {
            "SUPA" => action.machine = true,
            "TRAORI" => {
                self.modes.tip_control = true;
                self.track.set_coordinates(Coordinates::Tip).map_err(here)?;
            }
            "TRAFOOF" => {
                self.modes.tip_control = false;
                self.plane_coordinates().map_err(here)?;
            }
            "NORM" => self.modes.round_ends = false,
            "KONT" => self.modes.round_ends = true,
            "CIP" => self.modes.motion = Motion::Through,
            "CT" => self.modes.motion = Motion::Tangential,
            "MSG" => {
                let text = self.values(arguments)?.into_iter().next().flatten();
                let text = text.map_or_else(String::new, |text| text.text());
                self.event(EventKind::Message(text), span.clone())?;
            }
            "RET" => self.back(),
            "MCALL" => self.modes.modal_call = None,
            "CYCLE800" => {
                // Names of swivel data are texts.
                let number = |value: Value| match value {
                    Value::Number(number) => number,
                    Value::Text(_) => 0.0,
                };
                let values = self.values(arguments)?;
                let values: Vec<_> = values.into_iter().map(|value| value.map(number)).collect();
                self.swivel(&values).map_err(here)?;
            }
            "WORKPIECE" => {
                let values = self.values(arguments)?;
                self.track.program.stock = workpiece(&values, self.modes.unit());
                if self.track.program.stock.is_none() {
                    self.track
                        .note("a WORKPIECE other than a BOX with absolute sides (112) is left out");
                }
            }
            "SETMS" => {
                let number = self.values(arguments)?.into_iter().next().flatten();
                self.modes.master = match number {
                    Some(Value::Number(number)) => number as u32,
                    _ => 1,
                };
            }
            "DIAMON" | "DIAM90" => {
                let taken = "no: a mill's X";
                let what = format!("whether X is a diameter ({name})");
                self.track.assume(Assumption::new(what, taken, "DIAMOF"));
            }
            "CYCLE832" | "STOPRE" => {}
            _ if HARMLESS.split(' ').any(|word| word == name) => {}
            _ if REFUSED.contains(&name) => {
                let instead = "the path of the tool would be unknown; expected G0, G1, G2, G3 or CIP";
                return Err(here(NcProblem::unsupported(format!("{name} is"), instead)));
            }
            _ => return self.call_or_cycle(name, arguments, words, span),
        }
        Ok(())
    }

    /// The values of arguments, as far as they are given.
    fn values(&self, arguments: Option<&[Option<Expression>]>) -> Result<Vec<Option<Value>>, Located> {
        let value = |argument: &Expression| argument.value(&|name| self.lookup(name));
        let all = arguments.unwrap_or(&[]).iter();
        all.map(|argument| argument.as_ref().map(value).transpose()).collect()
    }

    /// A cycle, a subprogram, or nothing known.
    pub(super) fn call_or_cycle(
        &mut self,
        name: &str,
        arguments: Option<&[Option<Expression>]>,
        words: &Words,
        span: &Range<usize>,
    ) -> Result<(), Located> {
        let here = |problem: NcProblem| (problem, span.clone());
        let (name, given) = match self.named_call(name, arguments).map_err(here)? {
            Some(called) => (called, None),
            None => (name.to_owned(), arguments),
        };
        let (name, modal) = (name.as_str(), self.modal_word(span));
        let values = self.values(given)?;
        let known = self.knows(name);
        let unit = self.modes.unit();
        let cycle = Arguments {
            name,
            values: &values,
            unit,
            speed: self.modes.speed,
        };
        if !known && UNCHECKED.contains(&name) {
            self.unchecked(name).map_err(here)?;
        }
        if !known && name != "CYCLE62" && CONTOURS.contains(&name) && cycle.is_unknown_kind() {
            return self.track.leave_out_cycle(name).map_err(here);
        }
        if !known && CONTOURS.contains(&name) {
            self.track.use_offset(&mut self.frames.work).map_err(here)?;
            return self.contour_cycle(&cycle).map_err(here);
        }
        if !known && (name.starts_with("CYCLE") || MILLING.contains(&name) || PATTERNS.contains(&name)) {
            self.track.use_offset(&mut self.frames.work).map_err(here)?;
            if self.places(&cycle).map_err(here)? || self.mill(&cycle).map_err(here)? {
                return Ok(());
            }
            let arguments = cycle;
            let cycle = match name {
                _ if arguments.is_unknown_kind() => Cycle::Unknown(name.to_owned()),
                _ if HOLES.contains(&name) => {
                    let mut hole = hole_cycle(&arguments).map_err(here)?;
                    hole.feed = hole.feed.or(self.tapping_feed(&arguments));
                    Cycle::Holes(vec![hole])
                }
                "CYCLE70" | "CYCLE78" => {
                    let tool = self.cutter_radius(UNKNOWN_TOOL).map_err(here)?;
                    Cycle::Holes(thread(&arguments, tool).map_err(here)?)
                }
                _ => Cycle::Unknown(name.to_owned()),
            };
            if name == "CYCLE70" && !modal {
                let place = [12, 13].map(|index| arguments.length(index));
                self.go_to_place(place, f64::NEG_INFINITY).map_err(here)?;
            }
            if modal {
                self.call_modally(Modal::Cycle(cycle));
                return Ok(());
            }
            return self
                .track
                .cycle_here(&cycle, self.modes.plane, self.uncertain)
                .map_err(here);
        }
        if !known {
            // A cycle of the machine's builder or of ShopMill has arguments; a subprogram may have, too.
            return match given {
                Some(_) => self.track.leave_out_cycle(name),
                None => self.track.leave_out_program(name, &format!("{name}.SPF")),
            }
            .map_err(here);
        }
        let values: Vec<Value> = values
            .into_iter()
            .map(|value| value.unwrap_or(Value::Number(0.0)))
            .collect();
        let times = if modal { 1.0 } else { words.plain("P").unwrap_or(1.0) };
        let expected = "a whole number from 1 to 9999";
        let times = NcProblem::whole("the number of calls P", times, 1..=9999, expected)
            .map_err(|problem| (problem, words.span("P")))?;
        let call = Call {
            name: name.to_owned(),
            values,
            variables: self.variables_among(given)?,
            times: times as usize,
            modally: modal,
        };
        if modal {
            self.call_modally(Modal::Program(call));
        } else {
            self.pending = Some(call);
        }
        Ok(())
    }

    /// The feed of `CYCLE84`, by its pitch in mm and its speed.
    fn tapping_feed(&self, arguments: &Arguments) -> Option<f64> {
        let metric = arguments.get(13).is_none_or(|unit| unit <= 1.0);
        let pitch = arguments.get(8).filter(|pitch| *pitch != 0.0 && metric)?.abs();
        let speed = arguments.get(10).filter(|speed| *speed > 0.0).or(self.modes.speed);
        if arguments.name != "CYCLE84" {
            return None;
        }
        let pitch = pitch / self.track.program.units.in_mm();
        match self.track.feed_mode {
            FeedMode::PerRevolution => Some(pitch),
            FeedMode::PerMinute => Some(pitch * speed?),
            FeedMode::InverseTime => None,
        }
    }

    /// The program that `CALL` or `EXTCALL` names, wherever the control has it.
    fn named_call(&self, name: &str, arguments: Option<&[Option<Expression>]>) -> Result<Option<String>, NcProblem> {
        let text = match (name, arguments) {
            ("CALL" | "EXTCALL", Some([Some(text)])) => text.value(&|name| self.lookup(name)),
            ("CALL" | "EXTCALL" | "PCALL", _) => {
                return Err(NcProblem::unsupported(
                    format!("{name} is"),
                    "expected the name of the subprogram alone",
                ));
            }
            _ => return Ok(None),
        };
        let text = text.map_err(|(problem, _)| problem)?.text().to_ascii_uppercase();
        let text = text.rsplit(['/', '\\', ':']).next().unwrap_or_default();
        let text = text.trim_start_matches("_N_");
        let ends = ["_SPF", "_MPF", ".SPF", ".MPF"];
        let text = ends.iter().find_map(|end| text.strip_suffix(end)).unwrap_or(text);
        Ok(Some(text.to_owned()))
    }

    /// Says that a cycle may be read wrongly.
    fn unchecked(&mut self, name: &str) -> Result<(), NcProblem> {
        if self.track.strict() {
            let expected = "no manual was at hand for the order of its parameters; expected its moves written out";
            return Err(NcProblem::unsupported(format!("{name} is"), expected));
        }
        let what = format!("the order of the parameters of {name}");
        let taken = "as posts write it: no manual was at hand";
        self.track.assume(Assumption::new(what, taken, "the moves written out"));
        Ok(())
    }

    /// Whether this call follows `MCALL`, which stands right before it.
    pub(super) fn modal_word(&self, span: &Range<usize>) -> bool {
        let before = self
            .current_text()
            .get(..span.start)
            .unwrap_or("")
            .trim_end()
            .to_ascii_uppercase();
        before.ends_with("MCALL")
    }
}

/// Keywords that change no programmed point.
const HARMLESS: &str = "FNORM FLIN FCUB COMPOF COMPON COMPCURV COMPCAD COMPSURF SOFT BRISK DRIVE FFWON FFWOF DIAMOF STOPRE \
    ORIWKS ORIMKS ORIAXES ORIVECT ORIPLANE ORIROTA ORIC ORID ORISON ORISOF OSC OSD OSOF OSS OSSE UPATH SPATH \
    DISPLON DISPLOF SAVE SBLON SBLOF WALIMON WALIMOF STARTFIFO STOPFIFO FIFOCTRL CFC CFTCP CFIN CDON CDOF CDOF2 \
    RTLION RTLIOF FENDNORM G1COMP OEMIPO1 TOWSTD CP EXECUTE PAROTOF TOROTOF";
/// Keywords that change the path.
const REFUSED: [&str; 26] = [
    "ASPLINE", "BSPLINE", "CSPLINE", "POLY", "INVCW", "INVCCW", "TRACYL", "TRANSMIT", "TRAANG", "TCARR", "TCOABS",
    "TCOFR", "PAROT", "TOROT", "TOROTX", "TOROTY", "TOFRAME", "PTP", "PTPG0", "CUT3DC", "CONTPRON", "KONTC", "KONTT",
    "ROTS", "AROTS", "CROTS",
];
