//! Work offsets: from the coordinates of a program to the one frame of its poses.
//!
//! A frame that the program itself places (`G10 L2`) lies there. One that it does not place is the part's frame as it stands: then it
//! must be the only one in use, since how far apart two such frames are only the machine knows.

use crate::error::Problem;

fn describe(frame: Option<usize>) -> String {
    match frame {
        Some(index) => format!("a move in {}, which the program does not place,", name(index)),
        None => "one in a frame that it places".into(),
    }
}

/// The offsets of G54 … G59.3, and the shifts on top of them. Millimetres.
#[derive(Clone, Debug, Default)]
pub(crate) struct Offsets {
    /// Which one holds: 0 for G54.
    pub active: usize,
    placed: [Option<[f64; 3]>; 9],
    /// The frame of the moves so far: which one, when nothing has placed it; `None` for all that are placed.
    used: Option<Option<usize>>,
    /// By G92,
    shift: [f64; 3],
    /// before it was cancelled,
    shift_saved: [f64; 3],
    /// by G52.
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

    /// Makes sure that the frame in use has a known place with regard to those before.
    pub fn use_active(&mut self) -> Result<(), Problem> {
        let frame = self.placed[self.active].is_none().then_some(self.active);
        let before = *self.used.get_or_insert(frame);
        if before == frame {
            return Ok(());
        }
        Err(Problem::unsupported(
            format!("{} after {} is", describe(frame), describe(before)),
            "how far apart they are only the machine knows; expected one work offset, or G10 L2 for each before its first move",
        ))
    }

    fn index(&self, p: f64) -> Result<usize, Problem> {
        if p.fract() != 0.0 || !(0.0..=9.0).contains(&p) {
            return Err(Problem::value("P of G10", p, "a whole number from 0 to 9"));
        }
        Ok(if p == 0.0 { self.active } else { p as usize - 1 })
    }

    /// `G10 L2`.
    pub fn set(&mut self, p: f64, words: [Option<f64>; 3]) -> Result<(), Problem> {
        let index = self.index(p)?;
        let before = self.placed[index].unwrap_or_default();
        self.placed[index] = Some(std::array::from_fn(|k| words[k].unwrap_or(before[k])));
        Ok(())
    }

    /// `G10 L20`: so that the machine's place has the given coordinates.
    pub fn set_here(&mut self, p: f64, words: [Option<f64>; 3], here: [Option<f64>; 3]) -> Result<(), Problem> {
        let index = self.index(p)?;
        let mut placed = self.placed[index].unwrap_or_default();
        for k in 0..3 {
            if let Some(word) = words[k] {
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

    /// `G92`: so that the machine's place has the given coordinates.
    pub fn shift_here(&mut self, words: [Option<f64>; 3], here: [Option<f64>; 3]) -> Result<(), Problem> {
        for k in 0..3 {
            if let Some(word) = words[k] {
                self.shift[k] += known(here[k])? - word - self.total()[k];
            }
        }
        Ok(())
    }

    /// `G92.1` and `G92.2`.
    pub fn cancel_shift(&mut self, forget: bool) {
        self.shift_saved = if forget { [0.0; 3] } else { self.shift };
        self.shift = [0.0; 3];
    }

    /// `G92.3`.
    pub fn restore_shift(&mut self) {
        self.shift = self.shift_saved;
    }
}

fn known(coordinate: Option<f64>) -> Result<f64, Problem> {
    coordinate.ok_or_else(|| {
        Problem::syntax(
            "this makes the machine's place to the given one, but that is not known yet: expected a move before",
        )
    })
}
