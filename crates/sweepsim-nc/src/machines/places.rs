//! Places of a machine's axes that the machine knows, and programs go to: its homes, and where tools are changed.

use super::description::{MachineDescription, RotaryAxis, check};
use super::error::MachineError;
use super::kinematics::Kinematics;

impl MachineDescription {
    /// Whether the places of its axes are known: machine coordinates of programs mean something.
    pub(super) fn has_places(&self) -> bool {
        let linear = self.linear.iter().any(|axis| axis.home.is_some());
        let rotary = self.table.iter().chain(&self.head).any(|axis| axis.home.is_some());
        linear || rotary || !self.tool_change.is_empty() || !self.bodies.is_empty()
    }

    /// Whether places are of axes that there are, and within their limits.
    pub(super) fn check_places(&self) -> Result<(), MachineError> {
        let linear = ['X', 'Y', 'Z'].map(|letter| {
            let own = self.linear.iter().find(|axis| axis.letter == letter);
            let places = own.map_or([None; 2], |axis| [axis.home, axis.second_home]);
            (letter, own.and_then(|axis| axis.limits), places)
        });
        let rotary = self.table.iter().chain(&self.head);
        let rotary = rotary.map(|axis| (axis.letter, axis.limits, [axis.home, axis.second_home]));
        let axes: Vec<_> = linear.into_iter().chain(rotary).collect();
        let within = |what: String, value: f64, limits: Option<[f64; 2]>| {
            let good = value.is_finite() && limits.is_none_or(|[least, largest]| (least..=largest).contains(&value));
            check(|| what.clone(), value, good, "a number within the limits of the axis")
        };
        for (letter, limits, places) in &axes {
            for (place, name) in places.iter().zip(["home", "second_home"]) {
                place.map_or(Ok(()), |place| {
                    within(format!("the {name} of {letter}"), place, *limits)
                })?;
            }
        }
        for (letter, value) in self.tool_change.iter().flatten() {
            let Some((_, limits, _)) = axes.iter().find(|axis| axis.0 == *letter) else {
                return Err(MachineError::Value {
                    what: "an axis in tool_change".into(),
                    found: format!("{letter:?}"),
                    expected: "the letter of one of its axes",
                });
            };
            within(format!("{letter} in tool_change"), *value, *limits)?;
        }
        Ok(())
    }
}

impl Kinematics {
    /// Whether the places of its axes are known: machine coordinates of programs mean something.
    pub(crate) fn has_places(&self) -> bool {
        self.description().has_places()
    }

    /// Where `G28`, or `G30` if `second`, takes an axis.
    pub(crate) fn home(&self, letter: char, second: bool) -> Option<f64> {
        let own = |[first, other]: [Option<f64>; 2]| if second { other } else { first };
        let linear = self.linear().iter().find(|axis| axis.letter == letter);
        let rotary = || {
            self.rotary()
                .find(|axis| axis.letter == letter)
                .map(|axis| [axis.home, axis.second_home])
        };
        own(linear.map(|axis| [axis.home, axis.second_home]).or_else(rotary)?)
    }

    /// Where an axis stands before the program: at its home, or where it starts, as near as its limits let it.
    pub(super) fn at_home(&self, letter: char) -> f64 {
        let rotary = |axis: &RotaryAxis| (axis.start, axis.limits);
        let linear = self.linear().iter().find(|axis| axis.letter == letter);
        let own = linear.map(|axis| (axis.start, axis.limits));
        let own = own.or_else(|| self.rotary().find(|axis| axis.letter == letter).map(rotary));
        let (start, limits) = own.unwrap_or_default();
        let start = limits.map_or(start, |[least, largest]| start.clamp(least, largest));
        self.home(letter, false).unwrap_or(start)
    }
}
