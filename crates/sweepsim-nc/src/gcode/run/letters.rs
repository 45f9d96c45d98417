//! Which letters a block may have.

use super::interpreter::Reader;
use crate::drive::WorkOffset;
use crate::gcode::codes::MotionMode;
use crate::gcode::offsets::{FADAL, MOST_OF_FADAL};
use crate::gcode::syntax::block::Block;
use crate::model::read_options::Controller;
use crate::text::error::{Located, NcProblem};

impl Reader {
    /// Each letter at most once, and none that could move the tool in an unknown way.
    pub(super) fn check_letters(&mut self, block: &Block) -> Result<(), Located> {
        let changes = block.words().iter().any(|w| (w.letter, w.value) == ('M', 6.0));
        if block.twice.is_some_and(|word| word.letter == 'T' && changes) {
            self.track
                .note("the second T of a change of tools is taken for the next tool, as on Mazak's controls");
        } else if let Some(word) = block.twice {
            let problem = NcProblem::syntax(format!("a second {} in one block: expected one", word.letter));
            return Err((problem, word.span()));
        }
        for word in block.words() {
            let fail = |problem| Err((problem, word.span()));
            match word.letter {
                'G' | 'M' | 'N' | 'A' | 'B' | 'C' | 'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'S' | 'T' | 'P'
                | 'Q' | 'L' | 'H' | 'D' => {}
                'U' | 'V' | 'W' => {
                    return fail(NcProblem::unsupported(
                        format!("the axis {} is", word.letter),
                        "expected X Y Z A B C",
                    ));
                }
                'E' if block.words().iter().any(|w| {
                    (w.letter == 'M' && (62.0..=68.0).contains(&w.value))
                        || (w.letter == 'G' && matches!(w.value, 47.0 | 187.0))
                }) => {}
                'E' if self.fixture_offset(block).is_some() => {}
                'E' => {
                    return fail(NcProblem::unsupported(
                        "E words are",
                        "it could be an exponent or an extruder; expected numbers without exponent",
                    ));
                }
                'O' => {
                    return fail(NcProblem::syntax(
                        "O within a block: expected it at the beginning of a line",
                    ));
                }
                letter => self.track.note(format!("{letter} words are not understood: ignored")),
            }
            if word.whole && self.rules.fanuc() && "XYZIJKR".contains(word.letter) && word.value != 0.0 {
                self.track.note(
                    "lengths without a decimal point are taken as whole units; without its calculator mode, the control takes them in its smallest increment",
                );
            }
        }
        self.check_spare_words(block)
    }

    /// The work offset that `E1` means on Fadal's controls: a whole number in a block that feeds nowhere. Elsewhere E
    /// is what is extruded, or an exponent.
    pub(super) fn fixture_offset(&self, block: &Block) -> Option<WorkOffset> {
        let words = block.words();
        let at = words.iter().position(|word| word.letter == 'E')?;
        let word = words[at];
        let is_number = word.whole && (0.0..=f64::from(MOST_OF_FADAL)).contains(&word.value);
        // X1E2 is a number with an exponent.
        let apart = at.checked_sub(1).is_none_or(|before| {
            let before = words[before];
            before.span().end < word.span().start || matches!(before.letter, 'N' | 'G' | 'M')
        });
        let code = |codes: &[f64]| {
            words
                .iter()
                .any(|word| word.letter == 'G' && codes.contains(&word.value))
        };
        let moves = block.first("XYZABC").is_some();
        let feeds = code(&[1.0, 2.0, 3.0, 92.0])
            || moves && !code(&[0.0]) && matches!(self.modes.motion, Some(motion) if motion != MotionMode::Rapid);
        (is_number && apart && !feeds && !block.has('F')).then_some(FADAL + word.value as WorkOffset)
    }

    /// LinuxCNC rejects words that no code of their block uses.
    fn check_spare_words(&self, block: &Block) -> Result<(), Located> {
        if !self.rules.strict || self.rules.controller != Some(Controller::LinuxCnc) || !block.has('R') {
            return Ok(());
        }
        let is = |letter: char, value: f64| block.words().iter().any(|w| w.letter == letter && w.value == value);
        let fail = |text: &str| Err((NcProblem::syntax(text.to_owned()), block.span('R')));
        if is('G', 64.0) && is('M', 19.0) {
            return fail("R belongs to both G64 and M19 here: expected them in blocks of their own");
        }
        let motion_ends = is('G', 61.0) || is('G', 80.0);
        let moves = block.first("XYZABC").is_some();
        if motion_ends && !moves && !is('M', 19.0) && !is('G', 10.0) {
            return fail("no code of this block uses R: expected an arc or a cycle");
        }
        Ok(())
    }
}
