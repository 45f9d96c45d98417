//! Tool tables of LinuxCNC: `T2 P2 Z0.7 D0.125 ;comment`. They give lengths and diameters, but no shape.

use std::collections::BTreeMap;

use super::library::ToolLibrary;
use crate::model::program::Note;
use crate::model::read_options::ToolOffset;
use crate::model::tool::ToolDescription;
use crate::text::error::{NcError, NcProblem, TextPosition};

pub(super) fn read(text: &str, unit: f64) -> Result<ToolLibrary, NcError> {
    let mut library = ToolLibrary::default();
    let mut offsets = BTreeMap::new();
    for (index, line) in text.lines().enumerate() {
        let (words, comment) = match line.find([';', '(']) {
            Some(at) => (&line[..at], line[at + 1..].trim().trim_end_matches(')').trim()),
            None => (line, ""),
        };
        if words.trim().is_empty() {
            continue;
        }
        let fail = |problem| {
            let position = TextPosition::in_line(index + 1, line, 1, words.trim_end().chars().count());
            Err(NcError::new(problem, Some(position)))
        };
        let (mut number, mut offset) = (None, ToolOffset::default());
        for word in words.split_whitespace() {
            let mut characters = word.chars();
            let letter = characters.next().map(|c| c.to_ascii_uppercase());
            let value = characters
                .as_str()
                .parse::<f64>()
                .ok()
                .filter(|value| value.is_finite());
            match (letter, value) {
                (Some('T'), Some(value)) if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) => {
                    number = Some(value as u32);
                }
                (Some('Z'), Some(value)) => offset.length = value * unit,
                (Some('D'), Some(value)) => offset.diameter = value.abs() * unit,
                (Some('P' | 'X' | 'Y' | 'A' | 'B' | 'C' | 'U' | 'V' | 'W' | 'I' | 'J' | 'Q'), Some(_)) => {}
                _ => {
                    let found = format!("{word:?}");
                    return fail(NcProblem::value(
                        "a word of the tool table",
                        found,
                        "like T1, P1, Z12.5 or D6",
                    ));
                }
            }
        }
        let Some(number) = number else {
            return fail(NcProblem::syntax(
                "a line of the tool table without T: expected the tool's number",
            ));
        };
        let mut tool = ToolDescription {
            name: (!comment.is_empty()).then(|| comment.to_owned()),
            line: index + 1,
            ..ToolDescription::default()
        };
        tool.diameter = (offset.diameter > 0.0).then_some(offset.diameter);
        offsets.entry(number).or_insert(offset);
        library.add(number, tool);
    }
    library.offsets = offsets;
    if !library.tools.is_empty() {
        library.notes.push(Note::new(
            1,
            "a tool table of LinuxCNC gives diameters and lengths, but no shapes",
        ));
    }
    Ok(library)
}
