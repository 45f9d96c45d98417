//! Work offsets, and the shifts on top of them: from the coordinates of a program to the common frame of its poses.

use crate::drive::{Placed, WorkOffset, WorkOffsets};
use crate::machines::WorkFrame;
use crate::model::read_options::ReadOptions;
use crate::text::error::NcProblem;

/// Where G54.1 P1 and its kin begin: 0 … 8 are G54 … G59.3, 100 + P is G54.1 P.
pub(crate) const EXTENDED: WorkOffset = 100;
/// Where those of Okuma begin: `G15 H1`.
pub(crate) const OKUMA: WorkOffset = EXTENDED + 1000;
/// Where those of Fadal begin: `E1`.
pub(crate) const FADAL: WorkOffset = OKUMA + 1000;
/// The last of Fadal's.
pub(crate) const MOST_OF_FADAL: u32 = 48;
/// Above all of them.
const MOST: WorkOffset = FADAL + MOST_OF_FADAL + 1;

/// The work offsets, and the shifts on top of them. Millimetres.
#[derive(Clone, Debug)]
pub(crate) struct Offsets {
    pub work: WorkOffsets,
    /// Fanuc's external offset, which is added to all.
    pub external: [f64; 3],
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
        FADAL.. => format!("E{}", index - FADAL),
        OKUMA.. => format!("G15 H{}", index - OKUMA),
        _ => format!("G54.1 P{}", index.saturating_sub(EXTENDED)),
    }
}

impl Offsets {
    /// Those that the control's variables give, or the user.
    pub(crate) fn new(options: &ReadOptions) -> Self {
        let (variables, unit) = (&options.variables, if options.inch { 25.4 } else { 1.0 });
        let value = |index: u32| variables.get(&index).map(|value| value * unit);
        let point = |first: u32| [0, 1, 2].map(|k| value(first + k));
        let home = |first: u32| match point(first) {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        };
        let mut work = WorkOffsets::new(name, MOST, options);
        for offset in 0..9 {
            let first = 5221 + 20 * offset;
            let given = point(first);
            if given.iter().any(Option::is_some) {
                let turn = variables.get(&(first + 9)).copied().unwrap_or(0.0);
                let origin = given.map(|x| x.unwrap_or(0.0));
                work.place(offset, Placed { origin, turn });
            }
        }
        Self {
            work,
            external: [0.0; 3],
            shift: [0.0; 3],
            shift_saved: None,
            shifted: false,
            placed_by_shift: [false; 3],
            lost: [false; 3],
            local: [0.0; 3],
            machine_known: !variables.is_empty(),
            homes: [home(5161), home(5181)],
        }
    }

    /// From coordinates after scaling and rotation (G51, G68) to the frame of the poses.
    pub(crate) fn map(&self) -> WorkFrame {
        let shift = WorkFrame::shifted(std::array::from_fn(|k| self.shift[k] + self.local[k]));
        WorkFrame::shifted(self.external).then(&self.work.frame().then(&shift))
    }

    /// Whether positions in machine coordinates are known now.
    pub(crate) fn knows_machine(&self) -> bool {
        self.machine_known || self.work.is_placed()
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
