//! The tables of the study.

use super::errors::Errors;
use super::{Bridge, Row, Study};
use crate::workspace;
use std::fmt::Write as _;
use std::fs;

impl Bridge {
    pub fn name(self) -> &'static str {
        match self {
            Self::Union => "placed tools",
            Self::Hulls => "hulls of pairs",
        }
    }
}

/// Which error.
pub type Measure = fn(&Row) -> f64;

impl Study {
    /// The error at this many seconds, on straight lines between the runs in logarithms; `None` beyond the runs.
    pub fn at(&self, bridge: Bridge, seconds: f64, measure: Measure) -> Option<f64> {
        let rows: Vec<&Row> = self.of(bridge).collect();
        let pair = rows
            .windows(2)
            .find(|pair| (pair[0].seconds..=pair[1].seconds).contains(&seconds))?;
        let share = (seconds / pair[0].seconds).ln() / (pair[1].seconds / pair[0].seconds).ln();
        let [a, b] = [measure(pair[0]), measure(pair[1])].map(f64::ln);
        Some((a + share * (b - a)).exp())
    }

    /// How many times as long as the exact simulation sampling takes to err by no more than this: `None` if no run did.
    pub fn times_for(&self, bridge: Bridge, error: f64, measure: Measure) -> Option<f64> {
        let row = self.of(bridge).find(|row| measure(row) <= error)?;
        Some(row.seconds / self.seconds)
    }
}

pub fn print(study: &Study) {
    let [nx, ny] = study.cells;
    println!(
        "{}: {} moves, {nx} × {ny} dexels, {:.0} mm³ removed; exact in {:.3} s on one thread; errors at {} ends of dexels",
        study.name, study.moves, study.removed, study.seconds, study.points
    );
    println!(
        "{:<16} {:>10} {:>10} {:>9} {:>9} {:>10} {:>10} {:>10} {:>10}",
        "method", "spacing", "places", "s", "/ exact", "max, mm", "p99, mm", "RMS, mm", "left, mm³"
    );
    for row in &study.rows {
        println!(
            "{:<16} {:>10.6} {:>10} {:>9.3} {:>9.2} {:>10.2e} {:>10.2e} {:>10.2e} {:>10.3}",
            row.bridge.name(),
            row.spacing,
            row.places,
            row.seconds,
            row.seconds / study.seconds,
            row.errors.max,
            row.errors.p99,
            row.errors.rms,
            row.left
        );
    }
    for bridge in [Bridge::Union, Bridge::Hulls] {
        let measures: [(&str, Measure); 3] = [
            ("max", |row| row.errors.max),
            ("p99", |row| row.errors.p99),
            ("RMS", |row| row.errors.rms),
        ];
        for (name, measure) in measures {
            let Some(error) = study.at(bridge, study.seconds, measure) else {
                continue;
            };
            println!(
                "{}, in the time of the exact simulation: {name} {error:.1e} mm",
                bridge.name()
            );
        }
        for error in [1e-2, 1e-3, 1e-4, 1e-5] {
            if let Some(times) = study.times_for(bridge, error, |row| row.errors.max) {
                println!(
                    "{}, max {error:.0e} mm everywhere: {times:.1} times as long as exact",
                    bridge.name()
                );
            }
        }
    }
}

/// The studies of `docs/accuracy.csv`: all that pictures need.
pub fn stored() -> Result<Vec<Study>, String> {
    let file = workspace::root().join("docs/accuracy.csv");
    let text = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    let mut studies: Vec<Study> = Vec::new();
    for (number, line) in text.lines().enumerate().skip(1) {
        let (study, row) =
            parsed(line).ok_or_else(|| format!("{}: line {} is not a row", file.display(), number + 1))?;
        match studies.iter_mut().find(|known| known.name == study.name) {
            Some(known) => known.rows.push(row),
            None => studies.push(Study {
                rows: vec![row],
                ..study
            }),
        }
    }
    Ok(studies)
}

fn parsed(line: &str) -> Option<(Study, Row)> {
    let words: Vec<&str> = line.split(',').collect();
    let (name, title) = *super::EXAMPLES.iter().find(|(name, _)| Some(name) == words.first())?;
    let bridge = [Bridge::Union, Bridge::Hulls]
        .into_iter()
        .find(|bridge| Some(&bridge.name()) == words.get(1))?;
    let numbers: Vec<f64> = words[2..].iter().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let [spacing, places, seconds, exact, max, p99, rms, left, removed] = numbers[..] else {
        return None;
    };
    let errors = Errors { max, p99, rms };
    let row = Row {
        bridge,
        spacing,
        places: places as usize,
        seconds,
        errors,
        left,
    };
    let study = Study {
        name,
        title,
        moves: 0,
        cells: [0; 2],
        seconds: exact,
        removed,
        points: 0,
        rows: Vec::new(),
    };
    Some((study, row))
}

/// Writes `docs/accuracy.csv`.
pub fn store(studies: &[Study]) -> Result<(), String> {
    let mut text = String::from(
        "example,method,spacing_mm,places,seconds,exact_seconds,max_mm,p99_mm,rms_mm,left_mm3,removed_mm3\n",
    );
    for study in studies {
        for row in &study.rows {
            let Errors { max, p99, rms } = row.errors;
            let _ = writeln!(
                text,
                "{},{},{},{},{:.4},{:.4},{max:.4e},{p99:.4e},{rms:.4e},{:.4},{:.3}",
                study.name,
                row.bridge.name(),
                row.spacing,
                row.places,
                row.seconds,
                study.seconds,
                row.left,
                study.removed
            );
        }
    }
    let file = workspace::root().join("docs/accuracy.csv");
    fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))
}
