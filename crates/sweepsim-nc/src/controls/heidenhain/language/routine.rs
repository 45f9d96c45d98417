//! Programs as blocks.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::line::{self, Line};
use crate::controls::recent::Recent;
use crate::text::kept::KeptText;

/// A program's text, block by block.
pub(in crate::controls::heidenhain) struct Routine {
    pub(in crate::controls::heidenhain) file: usize,
    text: KeptText,
    recent: Recent<Line>,
    /// Blocks that go on in the lines below: the first line of each and the last, in order.
    joined: Vec<(usize, usize)>,
    pub(in crate::controls::heidenhain) labels: BTreeMap<String, usize>,
}

impl Routine {
    /// Blocks are read here for their labels and continuations, and again when they run: kept as read, they would take many times their text.
    pub fn new(file: usize, text: Rc<String>) -> Self {
        let text = KeptText::new(text);
        let mut labels = BTreeMap::new();
        let mut joined: Vec<(usize, usize)> = Vec::new();
        let mut continues: Option<usize> = None;
        // The cycle whose parameters may follow.
        let mut cycle: Option<usize> = None;
        for index in 0..text.len() {
            let (own, goes_on) = own(&text, index);
            // Parameters of a cycle: with `~`, or on lines of their own.
            let first = continues.or(cycle.filter(|_| own.word(0).starts_with('Q')));
            cycle = first.and(cycle);
            if let Some(first) = first {
                match joined.last_mut() {
                    Some((same, last)) if *same == first => *last = index,
                    _ => joined.push((first, index)),
                }
                continues = goes_on.then_some(first);
                continue;
            }
            continues = goes_on.then_some(index);
            cycle = (own.begins(&["CYCL", "DEF"]) && !own.word(2).contains('.')).then_some(index);
            if own.word(0) == "LBL" && own.word(1) != "0" {
                labels.entry(own.word(1).to_owned()).or_insert(index);
            }
        }
        Self {
            file,
            text,
            recent: Recent::default(),
            joined,
            labels,
        }
    }

    /// The number of lines.
    pub fn len(&self) -> usize {
        self.text.len()
    }

    /// The text of a line.
    pub fn text(&self, index: usize) -> &str {
        self.text.line(index)
    }

    /// The block that begins on a line; without words on a line that belongs to the block before.
    pub fn block(&self, index: usize) -> Rc<Line> {
        let read = || Ok::<_, std::convert::Infallible>(self.read(index));
        match self.recent.get(index, read) {
            Ok(block) => block,
            Err(never) => match never {},
        }
    }

    fn read(&self, index: usize) -> Line {
        // The last that begins here or above.
        let at = self.joined.partition_point(|(first, _)| *first <= index);
        let last = match at.checked_sub(1).map(|at| self.joined[at]) {
            Some((first, last)) if first == index => last,
            Some((_, last)) if index <= last => return Line::default(),
            _ => index,
        };
        let (mut block, _) = own(&self.text, index);
        // A comment may go on below.
        let comment = |c: char| c.is_ascii_digit() || c.is_whitespace();
        if self.text(index).trim_start_matches(comment).starts_with(';') {
            return block;
        }
        for below in index + 1..=last {
            let (more, _) = own(&self.text, below);
            block.tokens.extend(more.tokens.into_iter().map(|mut token| {
                // Places are of the first line.
                token.span = 0..self.text(index).len();
                token
            }));
        }
        block
    }
}

/// The words of a line, and whether its block goes on below.
fn own(text: &KeptText, index: usize) -> (Line, bool) {
    let trimmed = text.line(index).trim_end();
    (line::line(trimmed.trim_end_matches('~')), trimmed.ends_with('~'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    /// The blocks as they come to be when all lines are read in order: lines that belong to the block above have no words.
    fn in_order(lines: &[&str]) -> Vec<Vec<String>> {
        let mut blocks: Vec<Vec<String>> = Vec::new();
        // Where the last block began, whether it goes on, and whether parameters may follow.
        let mut last: Option<(usize, bool, bool)> = None;
        for (index, line) in lines.iter().enumerate() {
            let goes_on = line.ends_with('~');
            let own = line::line(line.trim_end_matches('~'));
            let words = own.tokens.iter().map(|token| token.text.clone());
            match last {
                Some((first, open, cycle)) if open || cycle && line.starts_with('Q') => {
                    blocks[first].extend(words);
                    blocks.push(Vec::new());
                    last = Some((first, goes_on, cycle));
                }
                _ => {
                    blocks.push(words.collect());
                    last = Some((index, goes_on, line.starts_with("CYCL DEF 20")));
                }
            }
        }
        blocks
    }

    proptest! {
        #[test]
        fn blocks_read_one_by_one_are_those_read_in_order(
            lines in collection::vec(prop::sample::select(vec![
                "L X+1 ~", "L Y+2", "Q200=2 ~", "Q201=-15", "CYCL DEF 200 DRILLING ~", "CYCL DEF 203 Q1=2", "~", "",
                "; a comment", "CYCL DEF 7.0 DATUM", "LBL 1", "Q5=3 ~",
            ]), 0..40),
            from in collection::vec(0..40_usize, 40),
        ) {
            let text = lines.iter().map(|line| format!("{line}\n")).collect();
            let routine = Routine::new(0, Rc::new(text));
            let expected = in_order(&lines);
            prop_assert_eq!(routine.len(), lines.len());
            for index in from.into_iter().filter(|index| *index < lines.len()) {
                let block = routine.block(index);
                let words: Vec<&str> = block.tokens.iter().map(|token| token.text.as_str()).collect();
                prop_assert_eq!(&words, &expected[index], "{}", index);
            }
        }
    }
}
