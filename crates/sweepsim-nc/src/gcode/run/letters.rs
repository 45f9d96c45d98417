//! Which letters a block may have.

use super::interpreter::Reader;
use crate::gcode::syntax::block::Block;
use crate::model::read_options::Controller;
use crate::text::error::{Located, NcProblem};

impl Reader {
    /// Each letter at most once, and none that could move the tool in an unknown way.
    pub(super) fn check_letters(&mut self, block: &Block) -> Result<(), Located> {
        if let Some(word) = block.twice {
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
