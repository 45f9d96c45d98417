//! Work offsets: from the coordinates of a program to the common frame of its poses.
//!
//! A work offset that the program sets itself (`G10 L2`), or that the control's variables give, is applied. One that is not known is
//! taken as the part's frame; it must then be the only one in use, since only the machine knows the distance between two of them.

use std::collections::BTreeMap;

use crate::machines::WorkFrame;
use crate::text::error::NcProblem;

/// The number of a work offset: 0 … 8 for G54 … G59.3, 100 + P for G54.1 P.
pub(crate) type WorkOffset = u32;

/// Where G54.1 P1 and its kin begin.
pub(crate) const EXTENDED: WorkOffset = 100;

/// The place of a work offset.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Placed {
    pub origin: [f64; 3],
    /// Degrees about Z.
    pub turn: f64,
}

/// The work offsets, and the shifts on top of them. Millimetres.
#[derive(Clone, Debug, Default)]
pub(crate) struct Offsets {
    /// The active one.
    pub active: WorkOffset,
    placed: BTreeMap<WorkOffset, Placed>,
    /// Fanuc's external offset, which is added to all.
    pub external: [f64; 3],
    /// The frame of the moves so far: an offset that the program does not set, `None` for those that it sets.
    used: Option<Option<WorkOffset>>,
    /// Set by G92. Where that came before any position was known, relative to the frame that it made.
    pub shift: [f64; 3],
    /// What G92.3 restores; `None` until the program has set it: the machine remembers it from the last program.
    shift_saved: Option<[f64; 3]>,
    /// Whether LinuxCNC's #5210 is set.
    pub shifted: bool,
    /// The axes whose first G92 came before the position was known.
    placed_by_shift: [bool; 3],
    /// Those of them whose shift has ended: only the machine knows where their coordinates are now.
    lost: [bool; 3],
    /// Set by G52.
    pub local: [f64; 3],
    /// Whether positions in machine coordinates are known: the control's variables were given.
    pub machine_known: bool,
    /// The homes of G28 and G30 in machine coordinates, as far as they are known.
    pub homes: [Option<[f64; 3]>; 2],
}

/// The name of a work offset in a program.
pub(crate) fn name(index: WorkOffset) -> String {
    match index {
        0..=5 => format!("G{}", 54 + index),
        6..=8 => format!("G59.{}", index - 5),
        _ => format!("G54.1 P{}", index.saturating_sub(EXTENDED)),
    }
}

fn describe(frame: Option<WorkOffset>) -> String {
    match frame {
        Some(index) => format!("a move in {}, which the program does not set,", name(index)),
        None => "one in an offset that it sets".into(),
    }
}

impl Offsets {
    /// Those that the control's variables give, in units of so many millimetres.
    pub(crate) fn new(variables: &BTreeMap<u32, f64>, unit: f64) -> Self {
        let value = |index: u32| variables.get(&index).map(|value| value * unit);
        let point = |first: u32| [0, 1, 2].map(|k| value(first + k));
        let placed = |offset: u32| {
            let first = 5221 + 20 * offset;
            let given = point(first);
            let turn = variables.get(&(first + 9)).copied().unwrap_or(0.0);
            let origin = given.map(|x| x.unwrap_or(0.0));
            given
                .iter()
                .any(Option::is_some)
                .then_some((offset, Placed { origin, turn }))
        };
        let home = |first: u32| match point(first) {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        };
        Self {
            placed: (0..9).filter_map(placed).collect(),
            machine_known: !variables.is_empty(),
            homes: [home(5161), home(5181)],
            ..Self::default()
        }
    }

    /// From coordinates after scaling and rotation (G51, G68) to the frame of the poses.
    pub(crate) fn map(&self) -> WorkFrame {
        let Placed { origin, turn } = self.placed(self.active).unwrap_or_default();
        let shift = WorkFrame::shifted(std::array::from_fn(|k| self.shift[k] + self.local[k]));
        let outer = WorkFrame::shifted(std::array::from_fn(|k| origin[k] + self.external[k]));
        outer.then(&WorkFrame::turned(2, turn).then(&shift))
    }

    pub(crate) fn placed(&self, index: WorkOffset) -> Option<Placed> {
        self.placed.get(&index).copied()
    }

    pub(crate) fn place(&mut self, index: WorkOffset, placed: Placed) {
        self.placed.insert(index, placed);
    }

    /// Whether the frame of the active offset is known to the machine.
    pub(crate) fn active_is_placed(&self) -> bool {
        self.placed.contains_key(&self.active)
    }

    /// Checks that coordinates along axis `k` are known relative to those before.
    pub(crate) fn know(&self, k: usize) -> Result<(), NcProblem> {
        if !self.lost[k] {
            return Ok(());
        }
        Err(NcProblem::unsupported(
            format!(
                "an absolute {} after the end of a G92 which stood before the first move is",
                ['X', 'Y', 'Z'][k]
            ),
            "only the machine knows the distance between the two frames; expected no G92.1 or G92.2 before it",
        ))
    }

    /// Whether a G92 before the first move has made the frame.
    pub(crate) fn made_by_shift(&self) -> bool {
        self.placed_by_shift.contains(&true)
    }

    /// Checks that the active offset is known relative to those used before.
    pub(crate) fn use_active(&mut self) -> Result<(), NcProblem> {
        let frame = (!self.active_is_placed()).then_some(self.active);
        let before = *self.used.get_or_insert(frame);
        if before == frame {
            return Ok(());
        }
        Err(NcProblem::unsupported(
            format!("{} after {} is", describe(frame), describe(before)),
            "only the machine knows the distance between them; expected one work offset, or G10 L2 for each before its first move",
        ))
    }

    /// `G92`: gives the current position `here` (in the program's coordinates) the given coordinates. Before the first move (`fresh`) an
    /// unknown position becomes known by it, in the frame that it makes.
    pub(crate) fn shift_here(
        &mut self,
        words: [Option<f64>; 3],
        here: &mut [Option<f64>; 3],
        fresh: bool,
    ) -> Result<(), NcProblem> {
        for k in 0..3 {
            let Some(word) = words[k] else { continue };
            match here[k] {
                None if fresh => self.placed_by_shift[k] = true,
                now => self.shift[k] += known(now)? - word,
            }
            here[k] = Some(word);
            self.lost[k] = false;
        }
        if words.iter().any(Option::is_some) {
            self.shift_saved = Some(self.shift);
            self.shifted = true;
        }
        Ok(())
    }

    /// `G92.1` (`forget`) and `G92.2`, for the given axes. Whether the position along each is unknown from now on.
    pub(crate) fn cancel_shift(&mut self, forget: bool, axes: [bool; 3], fresh: bool) -> [bool; 3] {
        let mut unknown = [false; 3];
        for k in (0..3).filter(|&k| axes[k]) {
            self.shift[k] = 0.0;
            if self.placed_by_shift[k] && fresh {
                // No move has used the frame: that of the machine takes its place.
                unknown[k] = true;
                self.placed_by_shift[k] = false;
                self.lost[k] = false;
            } else {
                self.lost[k] = self.placed_by_shift[k];
            }
            if let (true, Some(saved)) = (forget, &mut self.shift_saved) {
                saved[k] = 0.0;
            }
        }
        if forget && axes == [true; 3] {
            self.shift_saved = Some([0.0; 3]);
        }
        self.shifted = false;
        unknown
    }

    /// What G92.3 restores.
    pub(crate) fn saved_shift(&self) -> [f64; 3] {
        self.shift_saved.unwrap_or_default()
    }

    /// On LinuxCNC, G52 and G92 set the same offset.
    pub(crate) fn set_shift(&mut self, shift: [f64; 3]) {
        self.shift = shift;
        self.shift_saved = Some(shift);
        self.shifted = true;
    }

    /// `G92.3`.
    pub(crate) fn restore_shift(&mut self) -> Result<(), NcProblem> {
        self.shift = self.shift_saved.ok_or_else(|| {
            NcProblem::unsupported(
                "G92.3 before any G92 is",
                "it restores what the machine remembers of an earlier program; expected G92 or G92.1 before it",
            )
        })?;
        self.lost = [false; 3];
        self.shifted = true;
        Ok(())
    }
}

/// A coordinate of the current position, where a code needs it.
pub(crate) fn known(coordinate: Option<f64>) -> Result<f64, NcProblem> {
    coordinate.ok_or_else(|| {
        NcProblem::syntax(
            "this sets the coordinates of the current position, which is not known yet: expected a move before it",
        )
    })
}
