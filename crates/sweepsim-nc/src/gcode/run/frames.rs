//! Where the tool is, in the program's, the poses' and the machine's coordinates.

use super::interpreter::Reader;
use crate::drive::Canonical;
use crate::machines::WorkFrame;
use crate::model::program::{FeedMode, Units};
use crate::text::error::NcProblem;

/// Millimetres per inch.
const INCH: f64 = 25.4;

impl Reader {
    /// Millimetres per unit of the program.
    pub(crate) fn unit(&self) -> f64 {
        if self.modes.inch { INCH } else { 1.0 }
    }

    /// The feed in effect, in the units of the program.
    pub(crate) fn feed(&self) -> Option<f64> {
        let units = if self.modes.feed_in_inches {
            Units::Inch
        } else {
            Units::Mm
        };
        let scale = match self.modes.feed_mode {
            FeedMode::InverseTime => 1.0,
            FeedMode::PerMinute | FeedMode::PerRevolution => units.in_mm() / self.program_unit(),
        };
        self.modes.feed.map(|feed| scale * feed)
    }

    /// Millimetres per unit of the program's first move, which its feeds are in.
    pub(crate) fn program_unit(&self) -> f64 {
        self.seen.units.map_or(self.unit(), Units::in_mm)
    }

    /// From the program's coordinates to those of the active work offset, without length offsets.
    pub(crate) fn frame_map(&self) -> WorkFrame {
        self.offsets.map().then(&self.modes.local_map())
    }

    /// The position of the machine that the control counts: the tip's plus the length offset.
    pub(crate) fn control_position(&self) -> [Option<f64>; 3] {
        let there = self.frame_map().partial(self.track.xyz);
        std::array::from_fn(|k| there[k].map(|at| at + self.tools.length.offset[k]))
    }

    /// The position in machine coordinates, if those are known.
    pub(crate) fn machine_position(&self) -> [Option<f64>; 3] {
        if self.offsets.knows_machine() {
            self.control_position()
        } else {
            [None; 3]
        }
    }

    /// What the length offset in effect moves the tip by, if that is known: its length less the tool's own.
    fn tip_shift(&self) -> f64 {
        let own = self.track.tool.and_then(|tool| self.tools.get(tool));
        match own {
            Some(own)
                if self.tools.length.used && (self.tools.length.known || self.tools.length.offset == [0.0; 3]) =>
            {
                self.tools.length.offset[2] - own.offset[2]
            }
            // Programs are written for the tip.
            _ => 0.0,
        }
    }

    /// The frame of the program's coordinates now, in which the poses are.
    fn frame_now(&self) -> WorkFrame {
        WorkFrame::shifted([0.0, 0.0, self.tip_shift()]).then(&self.frame_map())
    }

    /// Brings the frame up to date; coordinates stay as they are.
    pub(crate) fn update_frame(&mut self) {
        self.track.rename(self.frame_now(), self.track.xyz);
    }

    /// Changes offsets; the machine stays where it is.
    pub(crate) fn reframe(&mut self, change: impl FnOnce(&mut Self)) -> Result<(), NcProblem> {
        let (before, length) = (self.frame_map(), self.tools.length.offset);
        change(self);
        let after = self.frame_map();
        let mut xyz = self.track.xyz;
        if before != after || length != self.tools.length.offset {
            self.refuse_compensation("a change of coordinates")?;
            let Some(inverse) = after.inverse() else {
                return Err(NcProblem::syntax("these coordinates have no inverse: a scale is 0"));
            };
            let there = before.partial(xyz);
            xyz = inverse.partial(std::array::from_fn(|k| {
                there[k].map(|at| at + length[k] - self.tools.length.offset[k])
            }));
        }
        // Where lengths become known, the tip may turn out to be elsewhere.
        self.track.enter(self.frame_now(), xyz);
        Ok(())
    }

    /// Refuses what cannot happen while cutter compensation is on.
    pub(crate) fn refuse_compensation(&self, what: &str) -> Result<(), NcProblem> {
        if !self.track.compensates() {
            return Ok(());
        }
        Err(NcProblem::syntax(format!(
            "{what} while cutter compensation is on: expected G40 before it"
        )))
    }

    /// Commands besides moves, if they are traced.
    pub(crate) fn trace(&mut self, commands: impl IntoIterator<Item = Canonical>) {
        if let Some(trace) = &mut self.track.trace {
            trace.commands.extend(commands);
        }
    }

    pub(crate) fn trace_offsets(&mut self) {
        let unit = self.unit();
        let placed = self.offsets.work.placed(self.offsets.work.active).unwrap_or_default();
        self.trace([
            Canonical::WorkOffset {
                index: self.offsets.work.active + 1,
                origin: placed.origin.map(|x| x / unit),
            },
            Canonical::Shift(self.offsets.shift.map(|x| x / unit)),
            Canonical::Rotation(placed.turn),
        ]);
    }
}
