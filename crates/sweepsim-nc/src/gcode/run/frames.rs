//! Where the tool is, in the program's, the poses' and the machine's coordinates.

use super::interpreter::Reader;
use crate::gcode::motion::map::Map;
use crate::gcode::trace::Canonical;
use crate::text::error::NcProblem;

/// Millimetres per inch.
const INCH: f64 = 25.4;

impl Reader {
    /// Millimetres per unit of the program.
    pub(crate) fn unit(&self) -> f64 {
        if self.modes.inch { INCH } else { 1.0 }
    }

    /// The programmed position, in the program's coordinates (mm).
    pub(crate) fn current(&self) -> [Option<f64>; 3] {
        self.at
    }

    /// The programmed position, if all of it is known.
    pub(crate) fn known_position(&self) -> Option<[f64; 3]> {
        match self.at {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        }
    }

    /// From the program's coordinates to those of the active work offset, without length offsets.
    pub(crate) fn frame_map(&self) -> Map {
        let local = self.modes.local_map();
        let offsets = self.offsets.map();
        if local == Map::default() {
            offsets
        } else {
            offsets.after(&local)
        }
    }

    /// The position of the machine that the control counts: the tip's plus the length offset.
    pub(crate) fn control_position(&self) -> [Option<f64>; 3] {
        let there = self.frame_map().partial(self.at);
        std::array::from_fn(|k| there[k].map(|at| at + self.length[k]))
    }

    /// The position in machine coordinates, if those are known.
    pub(crate) fn machine_position(&self) -> [Option<f64>; 3] {
        if self.machine_known || self.offsets.active_is_placed() {
            self.control_position()
        } else {
            [None; 3]
        }
    }

    /// What the length offset in effect moves the tip by, if that is known: its length less the tool's own.
    fn tip_shift(&self) -> f64 {
        let own = self.state.tool.and_then(|tool| self.tools.get(tool));
        match own {
            Some(own) if self.uses_length && (self.length_known || self.length == [0.0; 3]) => {
                self.length[2] - own.offset[2]
            }
            // Programs are written for the tip.
            _ => 0.0,
        }
    }

    /// Brings the map from the program's coordinates to the tip up to date.
    pub(crate) fn update_map(&mut self) {
        let mut map = self.frame_map();
        map.add[2] += self.tip_shift();
        self.map = map;
    }

    /// Changes offsets; the machine stays where it is.
    pub(crate) fn reframe(&mut self, change: impl FnOnce(&mut Self) -> Result<(), NcProblem>) -> Result<(), NcProblem> {
        let (before, length) = (self.frame_map(), self.length);
        change(self)?;
        let after = self.frame_map();
        if before != after || length != self.length {
            self.refuse_compensation("a change of coordinates")?;
            if before.is_shift() && after.is_shift() {
                for k in 0..3 {
                    let by = before.add[k] - after.add[k] + length[k] - self.length[k];
                    self.at[k] = self.at[k].map(|at| at + by);
                }
            } else {
                let Some(inverse) = after.inverse() else {
                    return Err(NcProblem::syntax("these coordinates have no inverse: a scale is 0"));
                };
                let there = before.partial(self.at);
                let there = std::array::from_fn(|k| there[k].map(|at| at + length[k] - self.length[k]));
                self.at = inverse.partial(there);
            }
        }
        self.update_map();
        // Where lengths become known, the tip may turn out to be elsewhere.
        let tip = self.map.partial(self.at);
        let elsewhere = |k: usize| match (tip[k], self.state.xyz[k]) {
            (Some(a), Some(b)) => (a - b).abs() > 1e-9 * (1.0 + a.abs()),
            _ => true,
        };
        if (0..3).any(elsewhere) && !self.straight_next {
            if self.state.known().is_some() && tip != self.state.xyz {
                self.state.leave();
            }
            self.state.xyz = tip;
        }
        Ok(())
    }

    /// Refuses what cannot happen while cutter compensation is on.
    pub(crate) fn refuse_compensation(&self, what: &str) -> Result<(), NcProblem> {
        if self.compensation.is_none() {
            return Ok(());
        }
        Err(NcProblem::syntax(format!(
            "{what} while cutter compensation is on: expected G40 before it"
        )))
    }

    pub(crate) fn trace_offsets(&mut self) {
        let unit = self.unit();
        let placed = self.offsets.placed(self.offsets.active).unwrap_or_default();
        let index = self.offsets.active + 1;
        let shift = self.offsets.shift.map(|x| x / unit);
        if let Some(trace) = &mut self.trace {
            trace.push(Canonical::WorkOffset {
                index,
                origin: placed.origin.map(|x| x / unit),
            });
            trace.push(Canonical::Shift(shift));
            trace.push(Canonical::Rotation(placed.turn));
        }
    }

    pub(crate) fn trace_tool_offset(&mut self) {
        let length = self.length.map(|x| x / self.unit());
        if let Some(trace) = &mut self.trace {
            trace.push(Canonical::ToolOffset(length));
        }
    }
}
