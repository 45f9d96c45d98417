//! Work offsets: from the coordinates of a program to the common frame of its poses.
//!
//! A work offset that the program sets itself (`G10 L2`) is applied. One that it does not set is taken as the part's frame; it must then
//! be the only one in use, since only the machine knows the distance between two of them.

use crate::text::error::NcProblem;

fn describe(frame: Option<usize>) -> String {
    match frame {
        Some(index) => format!("a move in {}, which the program does not set,", name(index)),
        None => "one in an offset that it sets".into(),
    }
}

/// The offsets of G54 … G59.3, and the shifts on top of them. Millimetres.
#[derive(Clone, Debug, Default)]
pub(crate) struct Offsets {
    /// The active one: 0 for G54.
    pub active: usize,
    placed: [Option<[f64; 3]>; 9],
    /// The frame of the moves so far: the index of an offset that the program does not set, `None` for those that it sets.
    used: Option<Option<usize>>,
    /// Set by G92. Where that came before any position was known, relative to the frame that it made.
    shift: [f64; 3],
    /// What G92.3 restores; `None` until the program has set it: the machine remembers it from the last program.
    shift_saved: Option<[f64; 3]>,
    /// The axes whose first G92 came before the position was known.
    placed_by_shift: [bool; 3],
    /// Those of them whose shift has ended: only the machine knows where their coordinates are now.
    lost: [bool; 3],
    /// Set by G52.
    local: [f64; 3],
}

fn name(index: usize) -> String {
    match index {
        0..=5 => format!("G{}", 54 + index),
        _ => format!("G59.{}", index - 5),
    }
}

impl Offsets {
    /// What to add to a program's coordinates.
    pub fn total(&self) -> [f64; 3] {
        let placed = self.placed[self.active].unwrap_or_default();
        std::array::from_fn(|k| placed[k] + self.shift[k] + self.local[k])
    }

    /// Checks that coordinates along axis `k` are known relative to those before.
    pub fn know(&self, k: usize) -> Result<(), NcProblem> {
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
    pub fn made_by_shift(&self) -> bool {
        self.placed_by_shift.contains(&true)
    }

    /// Checks that the active offset is known relative to those used before.
    pub fn use_active(&mut self) -> Result<(), NcProblem> {
        let frame = self.placed[self.active].is_none().then_some(self.active);
        let before = *self.used.get_or_insert(frame);
        if before == frame {
            return Ok(());
        }
        Err(NcProblem::unsupported(
            format!("{} after {} is", describe(frame), describe(before)),
            "only the machine knows the distance between them; expected one work offset, or G10 L2 for each before its first move",
        ))
    }

    fn index(&self, p: f64) -> Result<usize, NcProblem> {
        if p.fract() != 0.0 || !(0.0..=9.0).contains(&p) {
            return Err(NcProblem::value("P of G10", p, "a whole number from 0 to 9"));
        }
        Ok(if p == 0.0 { self.active } else { p as usize - 1 })
    }

    /// `G10 L2`.
    pub fn set(&mut self, p: f64, words: [Option<f64>; 3]) -> Result<(), NcProblem> {
        let index = self.index(p)?;
        let before = self.placed[index].unwrap_or_default();
        self.placed[index] = Some(std::array::from_fn(|k| words[k].unwrap_or(before[k])));
        Ok(())
    }

    /// `G10 L20`: gives the current position the given coordinates.
    pub fn set_here(&mut self, p: f64, words: [Option<f64>; 3], here: [Option<f64>; 3]) -> Result<(), NcProblem> {
        let index = self.index(p)?;
        let mut placed = self.placed[index].unwrap_or_default();
        for k in 0..3 {
            if let Some(word) = words[k] {
                self.know(k)?;
                placed[k] = known(here[k])? - word - self.shift[k] - self.local[k];
            }
        }
        self.placed[index] = Some(placed);
        Ok(())
    }

    /// `G52`.
    pub fn set_local(&mut self, words: [Option<f64>; 3]) {
        for k in 0..3 {
            self.local[k] = words[k].unwrap_or(self.local[k]);
        }
    }

    /// `G92`: gives the current position `here` the given coordinates. Before the first move (`fresh`) an unknown position becomes known
    /// by it, in the frame that it makes.
    pub fn shift_here(
        &mut self,
        words: [Option<f64>; 3],
        here: &mut [Option<f64>; 3],
        fresh: bool,
    ) -> Result<(), NcProblem> {
        for k in 0..3 {
            let Some(word) = words[k] else { continue };
            if here[k].is_none() && fresh {
                here[k] = Some(word + self.total()[k]);
                self.placed_by_shift[k] = true;
            } else {
                self.shift[k] += known(here[k])? - word - self.total()[k];
            }
            self.lost[k] = false;
        }
        if words.iter().any(Option::is_some) {
            self.shift_saved = Some(self.shift);
        }
        Ok(())
    }

    /// `G92.1` (`forget`) and `G92.2`, for the given axes.
    pub fn cancel_shift(&mut self, forget: bool, axes: [bool; 3], here: &mut [Option<f64>; 3], fresh: bool) {
        for k in (0..3).filter(|&k| axes[k]) {
            self.shift[k] = 0.0;
            if self.placed_by_shift[k] && fresh {
                // No move has used the frame: that of the machine takes its place.
                here[k] = None;
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
    }

    /// `G92.3`.
    pub fn restore_shift(&mut self) -> Result<(), NcProblem> {
        self.shift = self.shift_saved.ok_or_else(|| {
            NcProblem::unsupported(
                "G92.3 before any G92 is",
                "it restores what the machine remembers of an earlier program; expected G92 or G92.1 before it",
            )
        })?;
        self.lost = [false; 3];
        Ok(())
    }
}

fn known(coordinate: Option<f64>) -> Result<f64, NcProblem> {
    coordinate.ok_or_else(|| {
        NcProblem::syntax(
            "this sets the coordinates of the current position, which is not known yet: expected a move before it",
        )
    })
}
