//! Predicted times of blocks against the logs of a machine.

use super::log::{POLLED, Run};
use super::model::{Blocks, Fit, MACHINE, WAITS, wait};
use crate::plot::{Axis, Panel, Series, figure};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// A log, the program that it ran, and what to call it.
const LOGS: [(&str, &str, &str); 4] = [
    ("Plate-Hurco04-05of20.txt", "plate-1.nc", "plate, part 5"),
    ("Plate-Hurco04-02of20.txt", "plate-1.nc", "plate, part 2"),
    ("Cover-Hurco04-02of20.txt", "cover-rev-a.nc", "cover, part 2"),
    ("Cover-Hurco04-05of20.txt", "cover-rev-a.nc", "cover, part 5"),
];
/// Moves are fitted over so many seconds at once: twenty times as long as the log is uncertain.
const WINDOW: f64 = 20.0 * POLLED;
/// Where fits start: accelerations in mm/s², corners in mm, smoothing in s.
const STARTS: [(f64, f64, f64); 3] = [(1000.0, 0.01, 0.02), (400.0, 0.003, 0.06), (2000.0, 0.003, 0.1)];
/// Blocks that are judged one by one last longer, in seconds.
const LONG: f64 = 1.0;

/// A stretch of blocks between two that the log has.
struct Row {
    begun: f64,
    line: usize,
    single: bool,
    logged: f64,
    predicted: f64,
    cutting: bool,
    /// For how long the tool stood still beyond what was predicted.
    standing: f64,
}

impl Row {
    /// Whether the operator held it: the tool stood still for more than two seconds longer than predicted.
    fn held(&self) -> bool {
        self.standing > 2.0
    }
}

/// The text of a program as the shop ran it. The logs of the plate say that the spot drill came first: T7 is in the
/// spindle during blocks 12 to 22, where the file has it after T1.
fn blocks(folder: &Path, name: &str) -> Result<Blocks, String> {
    let text = std::fs::read_to_string(folder.join(name)).map_err(|error| format!("{name}: {error}"))?;
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let change = |lines: &[String], tool: &str| lines.iter().position(|line| line.ends_with(tool));
    if let (Some(first), Some(drill), Some(after)) =
        (change(&lines, "T15M6"), change(&lines, "T7M6"), change(&lines, "T23M6"))
        && first < drill
    {
        lines[first..after].rotate_right(after - drill);
    }
    Ok(Blocks { lines })
}

struct Case {
    name: &'static str,
    blocks: Blocks,
    run: Run,
    feeds: BTreeMap<usize, f64>,
}

impl Case {
    fn read(folder: &Path, (log, program, name): (&str, &str, &'static str)) -> Result<Self, String> {
        let blocks = blocks(folder, program)?;
        let run = Run::read(&folder.join(log), blocks.lines.len())?;
        let start = Fit {
            acceleration: 1e6,
            rapid_acceleration: 1e6,
            corner: 10.0,
            smoothing: 0.0,
            waits: [0.0; WAITS.len()],
        };
        let ideal = blocks.moves(&start, &BTreeMap::new(), 1.0)?;
        let ideal = ideal.into_iter().map(|(line, [feed, _])| (line, feed)).collect();
        let feeds = blocks.overrides(&run, &ideal);
        Ok(Self {
            name,
            blocks,
            run,
            feeds,
        })
    }

    fn seconds_of_wait(&self, fit: &Fit, kind: usize, time: f64) -> f64 {
        fit.waits[kind] / if WAITS[kind].1 { self.run.rapid(time) } else { 1.0 }
    }

    fn rows(&self, fit: &Fit) -> Result<Vec<Row>, String> {
        // The times of rapids at each override that was logged.
        let mut at: BTreeMap<u32, BTreeMap<usize, [f64; 2]>> = BTreeMap::new();
        let percent = |time: f64| (100.0 * self.run.rapid(time)).round() as u32;
        for (time, _) in &self.run.blocks {
            if let std::collections::btree_map::Entry::Vacant(entry) = at.entry(percent(*time)) {
                let share = 0.01 * f64::from(*entry.key());
                entry.insert(self.blocks.moves(fit, &self.feeds, share)?);
            }
        }
        let feeds = self.blocks.moves(fit, &self.feeds, 1.0)?;
        let seconds = |line: usize, time: f64| {
            let feed = feeds.get(&line).map_or(0.0, |[feed, _]| *feed);
            let rapid = at[&percent(time)].get(&line).map_or(0.0, |[_, rapid]| *rapid);
            feed + rapid + wait(&self.blocks.lines[line - 1]).map_or(0.0, |k| self.seconds_of_wait(fit, k, time))
        };
        let rows = self.run.blocks.windows(2).map(|pair| {
            let ((from, line), (to, next)) = (pair[0], pair[1]);
            let predicted = (line..next).map(|line| seconds(line, from)).sum::<f64>();
            let cutting = (line..next).all(|line| wait(&self.blocks.lines[line - 1]).is_none());
            let still = self.run.standing(from, to);
            Row {
                begun: from,
                line,
                single: next == line + 1,
                logged: to - from,
                predicted,
                cutting,
                standing: still.min(to - from - predicted),
            }
        });
        Ok(rows.collect())
    }
}

/// The best fit that steps of each of the four lead to.
fn descended(mut fit: Fit, wrong: &impl Fn(&Fit) -> Result<f64, String>) -> Result<(f64, Fit), String> {
    let mut least = wrong(&fit)?;
    for step in [2.0, 1.4, 1.15, 1.05_f64] {
        let mut better = true;
        while better {
            better = false;
            for (k, factor) in [0, 1, 2, 3].into_iter().flat_map(|k| [(k, step), (k, 1.0 / step)]) {
                let of = |own: usize| if own == k { factor } else { 1.0 };
                let other = Fit {
                    acceleration: (fit.acceleration * of(0)).clamp(10.0, 20_000.0),
                    corner: (fit.corner * of(1)).clamp(1e-5, 1.0),
                    smoothing: (fit.smoothing * of(2)).clamp(1e-3, 0.5),
                    rapid_acceleration: (fit.rapid_acceleration * of(3)).clamp(10.0, 20_000.0),
                    ..fit
                };
                let found = wrong(&other)?;
                if found < 0.999 * least {
                    (fit, least, better) = (other, found, true);
                }
            }
        }
    }
    println!("fitted to a sum of {least:.1} s: {}", fit.text());
    Ok((least, fit))
}

/// Fits accelerations, corners and smoothing to the moves.
fn fitted(case: &Case) -> Result<Fit, String> {
    let wrong = |fit: &Fit| -> Result<f64, String> {
        let rows = case.rows(fit)?;
        // Over some seconds, so that polling counts for little, and every short block counts.
        let (mut sum, mut seconds, mut off) = (0.0, 0.0, 0.0_f64);
        for row in rows.iter().filter(|row| row.cutting) {
            seconds += row.logged;
            off += row.predicted - row.logged;
            if seconds > WINDOW {
                sum += off.abs();
                (seconds, off) = (0.0, 0.0);
            }
        }
        Ok(sum)
    };
    // The sum has several valleys.
    let mut best: Option<(f64, Fit)> = None;
    for (acceleration, corner, smoothing) in STARTS {
        let start = Fit {
            acceleration,
            rapid_acceleration: 2.0 * acceleration,
            corner,
            smoothing,
            waits: [0.0; WAITS.len()],
        };
        let (sum, fit) = descended(start, &wrong)?;
        if best.as_ref().is_none_or(|(least, _)| sum < *least) {
            best = Some((sum, fit));
        }
    }
    best.map(|(_, fit)| fit).ok_or_else(|| "no start".into())
}

/// With the seconds of what is no move, by what the moves leave of a log.
fn with_waits(mut fit: Fit, case: &Case) -> Result<Fit, String> {
    let rows = case.rows(&fit)?;
    for kind in 0..fit.waits.len() {
        let own = rows
            .iter()
            .filter(|row| row.single && wait(&case.blocks.lines[row.line - 1]) == Some(kind));
        let share = |row: &Row| if WAITS[kind].1 { case.run.rapid(row.begun) } else { 1.0 };
        let mut left: Vec<f64> = own
            .map(|row| (row.logged - row.predicted).max(0.0) * share(row))
            .collect();
        left.sort_by(f64::total_cmp);
        fit.waits[kind] = left.get(left.len() / 2).copied().unwrap_or(0.0);
    }
    Ok(fit)
}

/// What was reached on a log.
struct Score {
    logged: f64,
    predicted: f64,
    /// Of single blocks beyond a second that were not held: how many, and the 50th and 90th percentile of the relative
    /// error.
    long: usize,
    percentiles: [f64; 2],
    held: Vec<(usize, f64)>,
}

fn score(rows: &[Row]) -> Score {
    let sum = |of: fn(&Row) -> f64| rows.iter().map(of).sum::<f64>();
    let long = rows.iter().filter(|row| row.single && row.logged > LONG && !row.held());
    let mut errors: Vec<f64> = long
        .map(|row| (row.predicted - row.logged).abs() / row.logged)
        .collect();
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors.get(((errors.len() as f64 * share) as usize).min(errors.len().saturating_sub(1)));
    Score {
        logged: sum(|row| row.logged),
        predicted: sum(|row| row.predicted),
        long: errors.len(),
        percentiles: [0.5, 0.9].map(|share| at(share).copied().unwrap_or(f64::NAN)),
        held: rows
            .iter()
            .filter(|row| row.held())
            .map(|row| (row.line, row.standing))
            .collect(),
    }
}

/// Fits the ready machine's accelerations, corners and smoothing to the first log anew. Returns them, and those that it
/// has.
pub fn fit(folder: &Path) -> Result<String, String> {
    let found = fitted(&Case::read(folder, LOGS[0])?)?;
    Ok(format!("{MACHINE}: {}\nfitted: {}", Fit::ready()?.text(), found.text()))
}

/// Judges the ready machine on all logs, with the waits of the first one. Returns the table and the plot.
pub fn run(folder: &Path) -> Result<(String, String), String> {
    let cases: Vec<Case> = LOGS
        .iter()
        .map(|log| Case::read(folder, *log))
        .collect::<Result<_, _>>()?;
    let fit = with_waits(Fit::ready()?, &cases[0])?;
    let mut text = format!("{MACHINE}: {}\n\n", fit.text());
    for ((name, _), seconds) in WAITS.iter().zip(fit.waits) {
        let _ = write!(text, "{name} {seconds:.2} s, ");
    }
    text += "\n\n| log | logged s | predicted s | off | blocks > 1 s | median off | 90th percentile off | held |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    let mut panels = Vec::new();
    let mut held = String::new();
    for case in &cases {
        let rows = case.rows(&fit)?;
        let found = score(&rows);
        let standing: f64 = found.held.iter().map(|(_, seconds)| seconds).sum();
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let _ = writeln!(
            text,
            "| {} | {:.1} | {:.1} | {} | {} | {} | {} | {} blocks, {standing:.0} s |",
            case.name,
            found.logged,
            found.predicted,
            percent(found.predicted / found.logged - 1.0),
            found.long,
            percent(found.percentiles[0]),
            percent(found.percentiles[1]),
            found.held.len(),
        );
        let overrides: Vec<String> = case
            .feeds
            .iter()
            .map(|(line, share)| format!("{:.0} % from {line}", 100.0 * share))
            .collect();
        let _ = writeln!(held, "- {}: feed override {}", case.name, overrides.join(", "));
        for (line, seconds) in &found.held {
            let _ = writeln!(
                held,
                "  - held {seconds:.1} s in block {line}: `{}`",
                case.blocks.lines[line - 1]
            );
        }
        panels.push(panel(case.name, &rows));
    }
    let text = format!("{text}\n{held}");
    let plot = figure(
        &panels,
        2,
        "Predicted against logged times of blocks, for four logs: most points lie along the diagonal.",
    );
    Ok((text, plot))
}

fn panel(name: &str, rows: &[Row]) -> Panel {
    let axis = |label: &str| Axis {
        label: label.into(),
        logarithmic: true,
        range: Some([0.1, 30.0]),
    };
    let points = |wanted: fn(&Row) -> bool| {
        let some = rows
            .iter()
            .filter(|row| row.logged > 0.1 && row.predicted > 0.1 && wanted(row));
        some.map(|row| [row.logged, row.predicted]).collect::<Vec<_>>()
    };
    let series = |name: &str, colour: usize, points: Vec<[f64; 2]>| Series {
        name: name.into(),
        colour,
        dashed: false,
        joined: name == "equal",
        points,
    };
    Panel {
        title: name.into(),
        axes: [axis("logged, s"), axis("predicted, s")],
        series: vec![
            series("equal", 3, vec![[0.1, 0.1], [30.0, 30.0]]),
            series("moves", 0, points(|row| row.cutting && !row.held())),
            series("other blocks", 2, points(|row| !row.cutting && !row.held())),
            series("held", 1, points(Row::held)),
        ],
    }
}
