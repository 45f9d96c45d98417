//! Statements that do not move the tool: feeds, units, frames, tools, spindle, coolant and texts.

use super::cycles::feed;
use super::frames::frame;
use super::reader::Reader;
use super::statement::{Item, Statement};
use crate::machines::WorkFrame;
use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{FeedMode, Units};
use crate::model::stock::StockDescription;
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// Comments of Creo.
    pub fn meaningful_comment(&mut self, statement: &Statement) -> Result<(), Located> {
        let whole = |problem| (problem, statement.bytes.clone());
        if statement.is("CUTTER") {
            let note = self.tools.describe(statement, self.unit).map_err(whole)?;
            if let Some(note) = note {
                self.track.note(note);
            }
        } else if statement.is("CSYS") {
            let numbers: Option<[f64; 12]> = statement.numbers().try_into().ok();
            if numbers.is_some_and(|numbers| !is_identity(&numbers)) {
                let note = "$$-> CSYS: the coordinates are those of the machine coordinate system, as Creo writes them";
                self.track.note(note);
            }
        }
        Ok(())
    }

    pub fn fedrat(&mut self, statement: &Statement) {
        if statement.has("INVERS") || statement.has("INVERSE") {
            self.track.feed_mode = FeedMode::InverseTime;
            self.track.feed = statement.number();
        } else if let Some((value, mode)) = feed(statement, self.unit) {
            (self.track.feed, self.track.feed_mode) = (Some(value), mode);
        } else if let Some(value) = statement.number() {
            self.track.feed = Some(value);
        }
    }

    pub fn set_unit(&mut self, statement: &Statement) -> Result<(), NcProblem> {
        let word = statement.items.first().map_or("", |item| item.text);
        self.unit = match word.to_ascii_uppercase().as_str() {
            "MM" | "MILLIMETER" | "MILLIMETERS" => 1.0,
            "IN" | "INCH" | "INCHES" => 25.4,
            "CM" => 10.0,
            "FT" | "FEET" => 304.8,
            "M" | "METER" => 1000.0,
            _ => {
                return Err(NcProblem::value(
                    "the unit",
                    format!("{word:?}"),
                    "MM, INCHES, CM, FEET or METER",
                ));
            }
        };
        let units = if self.unit == 25.4 { Units::Inch } else { Units::Mm };
        if !self.track.has_moved() {
            self.units = Some(units);
        }
        Ok(())
    }

    pub fn load(&mut self, statement: &Statement) -> Result<(), NcProblem> {
        let named = |item: &&Item| item.number.is_none() && !item.is("TOOL") && !item.is("MILL");
        let number = |value| NcProblem::whole("a tool number", value, 0..=u32::MAX, "a whole number");
        let number = statement.number().map(number).transpose()?;
        let name = statement.items.iter().find(named).map(|item| item.text);
        let (number, note) = self.tools.load(number, name);
        if let Some(note) = note {
            self.track.note(note);
        }
        self.track.joined = false;
        self.track.event(EventKind::ToolChange(number))
    }

    pub fn msys(&mut self, statement: &Statement) -> Result<(), NcProblem> {
        let numbers: [f64; 9] = statement.numbers().try_into().map_err(|list: Vec<f64>| {
            let expected = "9: the origin, the x axis and the y axis";
            NcProblem::value("the number of numbers in MSYS", list.len(), expected)
        })?;
        let [ox, oy, oz, a, b, c, d, e, f] = numbers;
        let frame = frame([ox, oy, oz].map(|c| c * self.unit), [a, b, c], [d, e, f])?;
        let first = *self.first_frame.get_or_insert(frame);
        let relative = if frame == first {
            WorkFrame::default()
        } else {
            first.inverse().unwrap_or_default().then(&frame)
        };
        if relative != self.frame && frame != first {
            self.track
                .note("another MSYS: coordinates are converted to that of the first one");
        }
        self.frame = relative;
        Ok(())
    }

    /// `CSYS` says where the frame of an operation is, `TRNTYP` in which frame the coordinates are.
    pub fn frame_of_coordinates(&mut self, statement: &Statement) -> Result<(), NcProblem> {
        if statement.is("CSYS") {
            self.csys = statement.numbers().try_into().ok();
        } else {
            self.world = Some(statement.has("WORLD"));
        }
        let moved = self.csys.is_some_and(|numbers| !is_identity(&numbers));
        match self.world {
            Some(false) if moved => {
                let what = "coordinates in the frame of CSYS (TRNTYP other than WORLD) are";
                return Err(NcProblem::unsupported(what, "expected TRNTYP/WORLD"));
            }
            None if moved => {
                let note = "CSYS without TRNTYP: the coordinates are taken as those of the part, not of CSYS";
                self.track.note(note);
            }
            _ => {}
        }
        Ok(())
    }

    pub fn spindle(&mut self, statement: &Statement) -> Result<(), NcProblem> {
        let rpm = statement.number();
        let spindle = if statement.has("OFF") {
            Spindle::Stopped
        } else if statement.has("CCLW") {
            Spindle::CounterClockwise { rpm }
        } else {
            Spindle::Clockwise { rpm }
        };
        self.track.event(EventKind::Spindle(spindle))
    }

    pub fn coolant(&mut self, statement: &Statement) -> Result<(), NcProblem> {
        let coolant = if statement.has("OFF") {
            Coolant::Off
        } else if statement.has("MIST") {
            Coolant::Mist
        } else if statement.has("THRU") || statement.has("TOOL") {
            Coolant::Through
        } else {
            Coolant::Flood
        };
        self.track.event(EventKind::Coolant(coolant))
    }

    /// `INSERT` carries the stock and the name of the next tool (SolidWorks).
    pub fn insert(&mut self, statement: &Statement) {
        let text = statement.rest;
        let stock = text
            .get(.."Stock Size".len())
            .filter(|front| front.eq_ignore_ascii_case("Stock Size"));
        if stock.is_some() {
            let side = |letter: char| {
                let word = text.split_whitespace().find_map(|word| word.strip_prefix(letter))?;
                word.parse::<f64>().ok().filter(|side| *side > 0.0 && side.is_finite())
            };
            if let (Some(x), Some(y), Some(z)) = (side('X'), side('Y'), side('Z')) {
                self.track.program.stock = Some(StockDescription::Size([x, y, z].map(|c| c * self.unit)));
            }
        } else {
            self.tools.name(text);
        }
    }
}

fn is_identity(rows: &[f64; 12]) -> bool {
    const IDENTITY: [f64; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    rows.iter()
        .zip(IDENTITY)
        .all(|(found, expected)| (found - expected).abs() < 1e-9)
}
