//! Machines: their rotary axes, and the meaning of a program's coordinates on them.

use sweepsim_motion::RotaryTable;

/// A machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Machine {
    /// The rotary axes of the table. `None` if there are none, or if they follow from the letters that a program uses.
    pub table: Option<RotaryTable>,
    /// Whether coordinates are those of the tip in the part's frame from the start, without a code in the program (`M428`, `M128`,
    /// `G43.4`).
    pub tip_control: bool,
}

impl Machine {
    /// A machine with two rotary axes in its table.
    #[must_use]
    pub fn with_table(table: RotaryTable) -> Self {
        Self {
            table: Some(table),
            tip_control: false,
        }
    }

    /// Sets whether coordinates are those of the tip from the start.
    #[must_use]
    pub fn tip_control(self, on: bool) -> Self {
        Self {
            tip_control: on,
            ..self
        }
    }
}
