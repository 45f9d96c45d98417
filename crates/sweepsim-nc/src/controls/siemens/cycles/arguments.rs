//! The arguments of cycles.

use crate::controls::siemens::language::expression::Value;
use crate::text::error::NcProblem;

/// The arguments of a cycle.
pub(in crate::controls::siemens) struct Arguments<'a> {
    pub name: &'a str,
    pub values: &'a [Option<Value>],
    /// Millimetres per unit of length.
    pub unit: f64,
}

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
            _ => self.need(3, "DP")?,
        };
        Ok([retract, surface + self.length(2).abs(), surface, bottom])
    }

    /// Whether the last digit of a way of machining asks for finishing alone.
    pub fn finishes(&self, index: usize) -> bool {
        self.get(index).is_some_and(|kind| kind % 10.0 >= 2.0)
    }
}
