//! The arguments of cycles.

use crate::controls::siemens::language::expression::Value;
use crate::text::error::NcProblem;

/// The arguments of a cycle.
pub(in crate::controls::siemens) struct Arguments<'a> {
    pub name: &'a str,
    pub values: &'a [Option<Value>],
    /// Millimetres per unit of length.
    pub unit: f64,
    /// Revolutions per minute, if they are known.
    pub speed: Option<f64>,
}

/// Where modes of newer lists of parameters are: VARI, GMODE and AMODE.
const MODES: [(&str, [usize; 3]); 12] = [
    ("CYCLE81", [NONE, 6, 8]),
    ("CYCLE82", [NONE, 6, 8]),
    ("CYCLE83", [NONE, 17, 19]),
    ("POCKET3", [16, 26, 28]),
    ("POCKET4", [13, 22, 24]),
    ("CYCLE76", [17, 22, 24]),
    ("CYCLE77", [14, 18, 20]),
    ("CYCLE61", [NONE, NONE, 15]),
    ("SLOT1", [18, NONE, NONE]),
    ("SLOT2", [18, NONE, NONE]),
    ("CYCLE72", [10, NONE, NONE]),
    ("CYCLE63", [1, NONE, NONE]),
];
const NONE: usize = usize::MAX;

impl Arguments<'_> {
    /// A number, if it is there.
    pub fn get(&self, index: usize) -> Option<f64> {
        match self.values.get(index)? {
            Some(Value::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// A text in capitals, if it is there.
    pub fn text(&self, index: usize) -> Option<String> {
        match self.values.get(index)? {
            Some(Value::Text(text)) if !text.is_empty() => Some(text.to_ascii_uppercase()),
            _ => None,
        }
    }

    /// A digit of one of the [modes](MODES), from the last one on.
    fn digit(&self, mode: usize, place: u32) -> u32 {
        let indices = MODES.iter().find(|(name, _)| *name == self.name);
        let mode = indices.and_then(|(_, indices)| self.get(indices[mode])).unwrap_or(0.0);
        (mode.abs() as u32) / 10_u32.pow(place) % 10
    }

    /// Whether the depth is relative to the surface (AMODE).
    pub fn is_relative(&self) -> bool {
        self.digit(2, 0) == 1
    }

    /// Whether it is a kind whose moves are not known: chamfers, depths of a diameter or of the shank, places of a corner.
    ///
    /// From general knowledge: no manual with these lists of parameters was at hand.
    pub fn is_unknown_kind(&self) -> bool {
        let hole = matches!(self.name, "CYCLE81" | "CYCLE82" | "CYCLE83");
        self.digit(0, 0) == 5 || hole && self.digit(1, 1) != 0 || !hole && self.digit(1, 3) > 1
    }

    /// Seconds of a dwell, whose turns are negative.
    pub fn dwell(&self, index: usize) -> Option<f64> {
        match self.get(index)? {
            turns if turns < 0.0 => Some(-60.0 * turns / self.speed.filter(|speed| *speed > 0.0)?),
            seconds => Some(seconds),
        }
    }

    /// A length in mm, or 0.
    pub fn length(&self, index: usize) -> f64 {
        self.get(index).unwrap_or(0.0) * self.unit
    }

    /// A length in mm.
    pub fn need(&self, index: usize, parameter: &str) -> Result<f64, NcProblem> {
        let name = self.name;
        let problem = || NcProblem::syntax(format!("{name} without {parameter}: expected a number"));
        self.get(index).map(|value| value * self.unit).ok_or_else(problem)
    }

    /// A feed, if it is above 0.
    pub fn feed(&self, index: usize) -> Option<f64> {
        self.get(index).filter(|feed| *feed > 0.0)
    }

    /// Where the tool is at last, where it begins, the surface and the bottom: RTP, RFP, SDIS, DP and, with `relative`, DPR.
    pub fn levels(&self, relative: Option<usize>) -> Result<[f64; 4], NcProblem> {
        let (retract, surface) = (self.need(0, "RTP")?, self.need(1, "RFP")?);
        let bottom = match relative.and_then(|index| self.get(index)) {
            Some(depth) if depth != 0.0 => surface - depth.abs() * self.unit,
            _ if self.is_relative() => surface - self.need(3, "DP")?.abs(),
            _ => self.need(3, "DP")?,
        };
        Ok([retract, surface + self.length(2).abs(), surface, bottom])
    }

    /// Whether finishing takes the floor too: if something was left there, and not of the edge alone (4).
    pub fn finishes_floor(&self, index: usize, left: usize) -> bool {
        self.get(index).is_some_and(|kind| kind % 10.0 == 2.0) && self.length(left) != 0.0
    }

    /// Whether the last digit of a way of machining asks for finishing alone.
    pub fn finishes(&self, index: usize) -> bool {
        self.get(index).is_some_and(|kind| kind % 10.0 >= 2.0)
    }
}
