//! The words of one line.

use std::ops::Range;

use crate::text::error::{Located, NcProblem};

/// A letter and its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Word {
    /// In upper case.
    pub letter: char,
    pub value: f64,
    /// Whether the number is plain digits, without a decimal point.
    pub whole: bool,
    start: u32,
    end: u32,
}

impl Word {
    pub(crate) fn new(letter: char, value: f64, span: Range<usize>) -> Self {
        Self {
            letter,
            value,
            whole: false,
            start: span.start as u32,
            end: span.end as u32,
        }
    }

    /// Bytes of the line.
    pub(crate) fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// The word as it appears in messages: `G5.1`, `M98`.
    pub(crate) fn name(&self) -> String {
        format!("{}{}", self.letter, self.value)
    }
}

/// What an assignment sets.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Target {
    Number(u32),
    Name(String),
}

/// One line.
#[derive(Clone, Debug, Default)]
pub(crate) struct Block {
    words: Vec<Word>,
    /// For each letter, the index of its first word, plus 1.
    first: [u8; 26],
    /// The second word of a letter other than G and M, with another value.
    pub twice: Option<Word>,
    /// `,R` or `,C`: a corner at the end of the move.
    pub corner: Option<Word>,
    /// `,A`: the angle of the line.
    pub angle: Option<Word>,
    /// The values of the words of variables that have none: Fanuc ignores such words.
    pub assignments: Vec<(Target, Option<f64>)>,
    /// Began with `/`.
    pub optional: bool,
    /// Was a `%`.
    pub tape: bool,
    /// The bytes of a comment that says something to the operator: `MSG,…`, `DEBUG,…`, `PRINT,…`.
    pub message: Option<Range<usize>>,
}

/// More words are an error: it bounds the work of one line.
const MOST_WORDS: usize = 200;

impl Block {
    pub(crate) fn clear(&mut self) {
        self.words.clear();
        self.first = [0; 26];
        self.twice = None;
        (self.corner, self.angle) = (None, None);
        self.assignments.clear();
        self.optional = false;
        self.tape = false;
        self.message = None;
    }

    pub(crate) fn push(&mut self, word: Word) -> Result<(), Located> {
        if self.words.len() >= MOST_WORDS {
            let problem = NcProblem::syntax(format!("more than {MOST_WORDS} words in one block"));
            return Err((problem, word.span()));
        }
        let first = &mut self.first[slot(word.letter)];
        if *first == 0 {
            *first = self.words.len() as u8 + 1;
        } else if !matches!(word.letter, 'G' | 'M')
            && self.twice.is_none()
            && self.words[usize::from(*first) - 1].value != word.value
        {
            self.twice = Some(word);
        }
        self.words.push(word);
        Ok(())
    }

    pub(crate) fn words(&self) -> &[Word] {
        &self.words
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.words.is_empty() && self.after_comma().is_none()
    }

    pub(crate) fn word(&self, letter: char) -> Option<&Word> {
        match self.first[slot(letter)] {
            0 => None,
            index => self.words.get(index as usize - 1),
        }
    }

    pub(crate) fn get(&self, letter: char) -> Option<f64> {
        self.word(letter).map(|word| word.value)
    }

    pub(crate) fn has(&self, letter: char) -> bool {
        self.first[slot(letter)] != 0
    }

    pub(crate) fn span(&self, letter: char) -> Range<usize> {
        self.word(letter).map_or_else(|| self.all(), Word::span)
    }

    /// A word that begins with a comma.
    pub(crate) fn after_comma(&self) -> Option<&Word> {
        self.corner.as_ref().or(self.angle.as_ref())
    }

    /// The first word with one of these letters.
    pub(crate) fn first(&self, letters: &str) -> Option<&Word> {
        letters
            .chars()
            .filter_map(|letter| self.word(letter))
            .min_by_key(|word| word.start)
    }

    /// The bytes from the first word to the last.
    pub(crate) fn all(&self) -> Range<usize> {
        match (self.words.first(), self.words.last()) {
            (Some(first), Some(last)) => first.start as usize..last.end as usize,
            _ => 0..0,
        }
    }
}

fn slot(letter: char) -> usize {
    (letter as usize).wrapping_sub('A' as usize).min(25)
}
