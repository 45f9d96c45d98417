//! Where the labels and numbers of blocks are.

use std::collections::BTreeMap;

/// Labels with their lines. Numbers of blocks, which most lines have, take eight bytes each.
#[derive(Default)]
pub(super) struct Labels {
    named: BTreeMap<String, Vec<u32>>,
    /// Numbers of blocks, as [`number`] writes them, with their lines, sorted.
    numbered: Vec<(u32, u32)>,
}

/// The digits of `N100` as a number with a 1 before them, so that zeros in front count; if there are few enough.
fn number(label: &str) -> Option<u32> {
    let digits = label.strip_prefix('N')?;
    if !(1..=9).contains(&digits.len()) || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    Some(10_u32.pow(digits.len() as u32) + digits.parse::<u32>().ok()?)
}

impl Labels {
    pub fn add(&mut self, label: String, line: usize) {
        // No text that fits in memory has more lines.
        let Ok(line) = u32::try_from(line) else { return };
        match number(&label) {
            Some(number) => self.numbered.push((number, line)),
            None => self.named.entry(label).or_default().push(line),
        }
    }

    /// After the last has been added.
    pub fn finish(&mut self) {
        self.numbered.sort_unstable();
        self.numbered.shrink_to_fit();
    }

    /// The lines of a label, from the first to the last.
    pub fn of(&self, label: &str) -> impl DoubleEndedIterator<Item = usize> {
        let named = self.named.get(label).map_or(&[][..], Vec::as_slice);
        let numbered = number(label).map_or(&[][..], |number| {
            let begin = self.numbered.partition_point(|(other, _)| *other < number);
            let rest = &self.numbered[begin..];
            &rest[..rest.partition_point(|(other, _)| *other == number)]
        });
        let lines = named.iter().chain(numbered.iter().map(|(_, line)| line));
        lines.map(|line| *line as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_found_by_all_their_letters() {
        let mut labels = Labels::default();
        let all = [
            "N10",
            "N010",
            "N10",
            "START",
            "N",
            "N10A",
            "N1234567890",
            "N999999999",
            "N1",
        ];
        for (line, label) in all.iter().enumerate().rev() {
            labels.add((*label).to_owned(), line);
        }
        labels.finish();
        for label in all {
            let mut expected: Vec<usize> = (0..all.len()).filter(|line| all[*line] == label).collect();
            expected.sort_unstable();
            assert_eq!(labels.of(label).collect::<Vec<_>>(), expected, "{label}");
        }
        assert_eq!(labels.of("N2").count(), 0);
    }
}
