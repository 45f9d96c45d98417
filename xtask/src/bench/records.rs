//! Figures of earlier runs, so that each is printed beside the one before.

use super::clock::load;
use crate::workspace;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

/// Days of which each figure is kept.
const KEPT: usize = 10;

/// Figures by name and day. Those of this machine are in a file in cargo's target folder.
pub struct Records {
    file: PathBuf,
    today: u64,
    figures: BTreeMap<String, BTreeMap<u64, f64>>,
}

impl Records {
    /// The figures of this machine; none if there is no file yet.
    pub fn open() -> Self {
        let target = std::env::current_exe()
            .ok()
            .and_then(|file| Some(file.parent()?.parent()?.to_owned()));
        let file = target
            .unwrap_or_else(|| workspace::root().join("target"))
            .join("bench.csv");
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let mut figures: BTreeMap<String, BTreeMap<u64, f64>> = BTreeMap::new();
        for line in fs::read_to_string(&file).unwrap_or_default().lines().skip(1) {
            let words: Vec<&str> = line.split(',').collect();
            if let [name, day, value] = words[..]
                && let (Ok(day), Ok(value)) = (day.parse(), value.parse())
            {
                figures.entry(name.to_owned()).or_default().insert(day, value);
            }
        }
        Self {
            file,
            today: now.as_secs() / 86_400,
            figures,
        }
    }

    /// Notes a figure. Its ratio to that of the last day before today, or else to today's last; a dash if there is
    /// none.
    pub fn note(&mut self, name: &str, value: f64) -> String {
        let days = self.figures.entry(name.to_owned()).or_default();
        let before = days
            .range(..self.today)
            .next_back()
            .or_else(|| days.range(self.today..).next());
        let before = before.map(|(_, before)| *before);
        days.insert(self.today, value);
        while days.len() > KEPT {
            days.pop_first();
        }
        ratio(value, before)
    }

    /// Writes them.
    pub fn save(&self) -> Result<(), String> {
        let mut text = String::from("figure,day,value\n");
        for (name, days) in &self.figures {
            for (day, value) in days {
                let _ = writeln!(text, "{name},{day},{value:e}");
            }
        }
        fs::write(&self.file, text).map_err(|error| format!("{}: {error}", self.file.display()))
    }
}

/// A figure divided by the one before.
pub fn ratio(value: f64, before: Option<f64>) -> String {
    before.map_or_else(|| "-".to_owned(), |before| format!("{:.2}", value / before))
}

/// What to know about the figures of a table: printed above it.
pub fn heading(title: &str) {
    let load = load().map_or_else(|| "unknown".to_owned(), |load| format!("{load:.1}"));
    println!(
        "\n{title} (load of the last minute: {load}; `before`: ratio to the last day's figure, or else to the last)"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_compared_with_the_last_day_before() {
        let mut records = Records {
            file: PathBuf::new(),
            today: 7,
            figures: BTreeMap::new(),
        };
        assert_eq!(records.note("a", 2.0), "-");
        // The same day, again: there is nothing older.
        assert_eq!(records.note("a", 3.0), "1.50");
        records.today = 8;
        assert_eq!(records.note("a", 6.0), "2.00");
        assert_eq!(records.note("a", 1.5), "0.50", "still with the day before");
        records.today = 30;
        assert_eq!(records.note("a", 3.0), "2.00", "with the last of that day");
    }
}
