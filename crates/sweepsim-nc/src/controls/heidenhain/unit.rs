//! Programs as blocks.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::line::{self, Line};

/// A program's text, block by block.
pub(super) struct Unit {
    pub(super) file: usize,
    pub(super) texts: Vec<String>,
    /// Without continuations, which belong to the block before.
    pub(super) lines: Vec<Rc<Line>>,
    pub(super) labels: BTreeMap<String, usize>,
}

impl Unit {
    pub fn new(file: usize, text: &str) -> Self {
        let texts: Vec<String> = text.lines().map(str::to_owned).collect();
        let mut lines: Vec<Rc<Line>> = Vec::with_capacity(texts.len());
        let mut labels = BTreeMap::new();
        let mut continues: Option<usize> = None;
        // The cycle whose parameters may follow.
        let mut cycle: Option<usize> = None;
        for (index, text) in texts.iter().enumerate() {
            let trimmed = text.trim_end();
            let goes_on = trimmed.ends_with('~');
            let own = line::line(trimmed.trim_end_matches('~'));
            // Parameters of a cycle: with `~`, or on lines of their own.
            let first = continues.or(cycle.filter(|_| own.word(0).starts_with('Q')));
            cycle = first.and(cycle);
            if let Some(first) = first {
                let tokens = own.tokens.into_iter().map(|mut token| {
                    // Places are of the first line.
                    token.span = 0..texts[first].len();
                    token
                });
                Rc::make_mut(&mut lines[first]).tokens.extend(tokens);
                lines.push(Rc::new(Line::default()));
                continues = goes_on.then_some(first);
                continue;
            }
            continues = goes_on.then_some(index);
            cycle = (own.begins(&["CYCL", "DEF"]) && !own.word(2).contains('.')).then_some(index);
            if own.word(0) == "LBL" && own.word(1) != "0" {
                labels.entry(own.word(1).to_owned()).or_insert(index);
            }
            lines.push(Rc::new(own));
        }
        Self {
            file,
            texts,
            lines,
            labels,
        }
    }
}
