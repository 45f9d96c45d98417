//! The control's tool table: lengths and diameters by number.

use std::collections::BTreeMap;

use super::interpreter::Reader;
use crate::drive::{Canonical, NARROW};
use crate::gcode::codes::LengthCode;
use crate::gcode::offsets::known;
use crate::gcode::syntax::block::Block;
use crate::machines::WorkFrame;
use crate::model::event::EventKind;
use crate::model::program::{Note, Program};
use crate::model::read_options::{Controller, ReadOptions, ToolOffset};
use crate::text::error::NcProblem;

/// A row of the table, in millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ToolRow {
    pub offset: [f64; 3],
    pub diameter: f64,
}

/// The length offset in effect.
#[derive(Clone, Debug, Default)]
pub(crate) struct LengthOffset {
    pub offset: [f64; 3],
    /// Whether it is a known one.
    pub known: bool,
    /// Whether the program uses length offsets at all; otherwise its coordinates are those of the tip.
    pub used: bool,
}

/// The table, and what of it is in effect.
#[derive(Clone, Debug, Default)]
pub(crate) struct ToolTable {
    /// Each as measured, and its wear.
    rows: BTreeMap<u32, [ToolRow; 2]>,
    /// Diameters of numbers without a row.
    diameters: BTreeMap<u32, f64>,
    /// Registers D that nothing sets are 0, not the radius of the tool.
    pub wear_alone: bool,
    pub length: LengthOffset,
    /// By a T word, not yet in the spindle.
    pub selected: Option<u32>,
    pub changed: bool,
}

impl ToolTable {
    pub(crate) fn new(options: &ReadOptions, text: &str) -> Self {
        let row = |tool: &ToolOffset| {
            let measured = ToolRow {
                offset: [0.0, 0.0, tool.length],
                diameter: tool.diameter,
            };
            [measured, ToolRow::default()]
        };
        let rows = options.tool_offsets.iter().map(|(&number, tool)| (number, row(tool)));
        let used = text.contains("G43") || text.contains("g43");
        Self {
            rows: rows.collect(),
            diameters: options.diameters.clone(),
            length: LengthOffset {
                used,
                ..LengthOffset::default()
            },
            ..Self::default()
        }
    }

    pub(crate) fn get(&self, number: u32) -> Option<ToolRow> {
        let [measured, wear] = self.rows.get(&number)?;
        Some(ToolRow {
            offset: std::array::from_fn(|k| measured.offset[k] + wear.offset[k]),
            diameter: measured.diameter + wear.diameter,
        })
    }

    /// What is known of a tool without a row.
    pub(crate) fn diameter(&self, number: u32) -> Option<f64> {
        self.diameters.get(&number).copied()
    }
}

impl Reader {
    /// A tool's number.
    pub(crate) fn tool_number(value: f64) -> Result<u32, NcProblem> {
        NcProblem::whole("a tool number", value, 0..=u32::MAX, "a whole number")
    }

    /// The new tool continues from the current position, on a separate path.
    pub(crate) fn change_tool(&mut self, tool: Option<u32>) -> Result<(), NcProblem> {
        self.refuse_compensation("a tool change")?;
        let Some(tool) = tool else { return Ok(()) };
        if Some(tool) == self.track.tool && !self.tools.changed {
            self.track.go_to_change()?;
            self.track.event(EventKind::ToolChange(tool))?;
        }
        self.tools.changed = true;
        self.track.change_tool(Some(tool))?;
        self.update_frame();
        Ok(())
    }

    /// G43 and its kin.
    pub(crate) fn set_length(&mut self, code: LengthCode, block: &Block) -> Result<(), NcProblem> {
        self.refuse_compensation("a change of the length offset")?;
        let table = matches!(code, LengthCode::Table | LengthCode::Opposite | LengthCode::Add);
        let mut offset = if code == LengthCode::Add {
            self.tools.length.offset
        } else {
            [0.0; 3]
        };
        if table && (block.has('H') || code != LengthCode::Add) {
            let number = match block.get('H') {
                Some(h) => Self::tool_number(h)?,
                None => self.track.tool.unwrap_or(0),
            };
            let row = match self.tools.get(number) {
                Some(row) => row,
                None => {
                    if number != 0 && !self.tools.rows.is_empty() {
                        self.track.note(format!(
                            "the length of tool offset H{number} is not in the table: taken as that of the tool"
                        ));
                    }
                    ToolRow::default()
                }
            };
            let sign = if code == LengthCode::Opposite { -1.0 } else { 1.0 };
            for k in 0..3 {
                offset[k] += sign * row.offset[k];
            }
            // A length that is not known is that of the tool.
            self.tools.length.known = self.tools.get(number).is_some();
        } else {
            let words = self.lengths(block, ['X', 'Y', 'Z']);
            for k in 0..3 {
                match (words[k], code) {
                    (Some(word), LengthCode::Add) => offset[k] += word,
                    (Some(word), _) => offset[k] = word,
                    (None, LengthCode::Add) => {}
                    // G43.1 leaves the axes that it does not name.
                    (None, _) => offset[k] = self.tools.length.offset[k],
                }
            }
            self.tools.length.known = true;
        }
        self.use_length(offset)
    }

    /// Puts a length offset into effect: the machine stays where it is.
    pub(crate) fn use_length(&mut self, offset: [f64; 3]) -> Result<(), NcProblem> {
        self.reframe(|reader| reader.tools.length.offset = offset)?;
        let length = self.tools.length.offset.map(|x| x / self.unit());
        self.trace([Canonical::ToolOffset(length)]);
        Ok(())
    }

    /// G10 L1, L10, L11 (LinuxCNC), L10 to L13 with R alone (Fanuc): rows of the table.
    pub(crate) fn set_tool(&mut self, l: u32, block: &Block) -> Result<(), NcProblem> {
        let number = match block.get('P') {
            Some(p) => Self::tool_number(p)?,
            None => {
                return Err(NcProblem::syntax(format!(
                    "G10 L{l} without P: expected the number of a tool"
                )));
            }
        };
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let [mut row, mut wear] = self.tools.rows.get(&number).copied().unwrap_or_default();
        let r = block.get('R').map(|r| r * self.unit());
        let fanuc = words.iter().all(Option::is_none) && r.is_some() && l >= 10;
        if fanuc {
            // In G91 it adds, as G10 L2 does there.
            let adds = !self.modes.absolute && self.rules.controller != Some(Controller::LinuxCnc);
            let set = |place: &mut f64, value: f64| *place = if adds { *place + value } else { value };
            let r = r.unwrap_or(0.0);
            match l {
                10 => set(&mut row.offset[2], r),
                12 => set(&mut row.diameter, 2.0 * r),
                11 => set(&mut wear.offset[2], r),
                _ => set(&mut wear.diameter, 2.0 * r),
            }
        } else {
            if l >= 12 {
                return Err(NcProblem::syntax(format!(
                    "G10 L{l} without R: expected the tool's length or radius"
                )));
            }
            if let Some(r) = r {
                row.diameter = 2.0 * r;
            }
            match l {
                1 => {
                    for k in 0..3 {
                        row.offset[k] = words[k].unwrap_or(row.offset[k]);
                    }
                }
                _ => self.measure_tool(l == 11, words, &mut row)?,
            }
        }
        self.tools.rows.insert(number, [row, wear]);
        self.update_frame();
        Ok(())
    }

    /// Sets a tool's offset so that the current position has the given coordinates: in the active work offset (L10), or in G59.3 without
    /// shifts and turns (L11).
    fn measure_tool(&self, fixture: bool, words: [Option<f64>; 3], row: &mut ToolRow) -> Result<(), NcProblem> {
        let mut frame = self.frame_map();
        if fixture {
            let placed = self.offsets.work.placed(8).unwrap_or_default();
            frame = WorkFrame::shifted(placed.origin);
        }
        let control = self.control_position();
        // Where the tip is in the frame's own directions, with the offset of the table.
        let inverse = frame.inverse().unwrap_or_default();
        let now: [Option<f64>; 3] = std::array::from_fn(|k| control[k].map(|at| at - row.offset[k]));
        let there = inverse.partial(now);
        let mut wanted = [0.0; 3];
        for k in 0..3 {
            wanted[k] = match (words[k], there[k]) {
                (Some(word), _) => word,
                (None, Some(there)) => there,
                // Nothing turns this axis, or the position would have to be known.
                (None, None) => 0.0,
            };
        }
        let tip = frame.point(wanted);
        for k in 0..3 {
            if words[k].is_some() || !frame.is_shift() && k < 2 {
                row.offset[k] = known(control[k])? - tip[k];
            }
        }
        Ok(())
    }
}

/// Warns where registers D that were taken for the sizes of their tools make these go into their own contours, and as wear they do not.
pub(super) fn compare_registers(program: &mut Program, as_wear: impl FnOnce() -> Option<Program>) {
    let narrow = |program: &Program| {
        let notes = program.notes.iter().filter(|note| note.message.contains(NARROW));
        let lines: Vec<usize> = notes.map(|note| note.line).collect();
        (lines.first().copied(), lines.len())
    };
    let (Some(line), count) = narrow(program) else { return };
    let registers: Vec<&str> = program
        .assumptions
        .iter()
        .filter(|one| one.size_of.is_some())
        .map(|one| one.what.as_str())
        .collect();
    if registers.is_empty() || as_wear().is_none_or(|other| narrow(&other).1 >= count) {
        return;
    }
    let (places, registers) = (if count == 1 { "a place" } else { "places" }, registers.join(", "));
    let message = format!(
        "as the size of its tool, a register ({registers}) has {places} where the tool does not fit into its own contour, as its wear, 0, fewer or none: \
         say by --diameters what it is, and compare"
    );
    program.notes.push(Note::new(line, message));
    program.notes.sort_by_key(|note| note.line);
}
