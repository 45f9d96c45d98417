//! How programs are read.

use crate::machine::Machine;

/// How to read a program.
///
/// ```
/// use sweepsim_motion::RotaryTable;
/// use sweepsim_nc::{Machine, ReadOptions};
///
/// let mut options = ReadOptions::default();
/// options.machine = Machine::with_table(RotaryTable::Ac).tip_control(true);
/// options.exact_arcs = true;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// How far chords may be from an arc, in millimetres.
    pub arc_tolerance: f64,
    /// Whether lengths are in inches: those of tables, and those of programs until they say `G20` or `G21`.
    pub inch: bool,
    /// The machine that runs the program.
    pub machine: Machine,
    /// How the tool axis turns between two blocks.
    pub law: AxisLaw,
    /// Keeps arcs and helices instead of dividing them into chords. The axis then turns at constant speed along them.
    pub exact_arcs: bool,
}

impl Default for ReadOptions {
    /// Millimetres, chords within 1 µm, SLERP, rotary axes and tip control as the program implies.
    fn default() -> Self {
        Self {
            arc_tolerance: 1e-3,
            inch: false,
            machine: Machine::default(),
            law: AxisLaw::Slerp,
            exact_arcs: false,
        }
    }
}

/// How the tool axis turns between two blocks of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum AxisLaw {
    /// In the plane of the two axes, as one rational arc.
    #[default]
    Slerp,
    /// In the plane of the two axes, at constant speed.
    ConstantSpeed,
    /// As the machine turns under tip control: both rotary axes at constant speed.
    Rotary,
}
