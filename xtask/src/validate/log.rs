//! Logs of a Hurco mill as the MTConnect agent of NIST's test bed wrote them: `time|name|value`.
//!
//! `Block_Number` is the line of the program that runs, polled about six times a second, so that short blocks are
//! missing and each time is late by up to 0.17 s. `Feed_Rate` is the speed of the tool in mm/s.

use std::path::Path;

/// How often the agent looks, in seconds.
pub const POLLED: f64 = 0.17;

/// Overrides count that were logged at most so many seconds before a run.
const SINCE: f64 = 3600.0;

/// What a log says of one run of a program; times are in seconds.
#[derive(Debug, Default)]
pub struct Run {
    /// When which line began, as far as the log has them.
    pub blocks: Vec<(f64, usize)>,
    /// Speeds of the tool, in mm/s.
    pub speeds: Vec<(f64, f64)>,
    /// Rapid overrides, in percent.
    pub overrides: Vec<(f64, f64)>,
}

impl Run {
    /// The last run in a log that ends at the line `last` of its program.
    pub fn read(file: &Path, last: usize) -> Result<Self, String> {
        let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
        let mut rows: Vec<(f64, &str, f64)> = text
            .lines()
            .filter_map(|line| {
                let mut fields = line.trim().split('|');
                let (time, name, value) = (fields.next()?, fields.next()?, fields.next()?);
                Some((seconds(time)?, name, value.parse().ok()?))
            })
            .collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let of = |name: &str| {
            rows.iter()
                .filter(|row| row.1 == name)
                .map(|row| (row.0, row.2))
                .collect::<Vec<_>>()
        };
        let blocks: Vec<(f64, usize)> = of("Block_Number")
            .iter()
            .map(|(t, line)| (*t, *line as usize))
            .collect();
        let mut runs = blocks.chunk_by(|a, b| b.1 > a.1);
        let near = |run: &&[(f64, usize)]| run.last().is_some_and(|(_, line)| line.abs_diff(last) <= 1);
        let run = runs.rfind(near);
        let Some(run) = run else {
            return Err(format!("{}: no run ends at line {last}", file.display()));
        };
        let run: Vec<_> = run.iter().copied().filter(|(_, line)| *line > 0).collect();
        let span = run[0].0 - 1.0..=run[run.len() - 1].0;
        let mut overrides = of("Rapid_Override");
        // A log is of one part: what was set for parts in between is in others.
        overrides.retain(|(time, _)| (span.start() - SINCE..=*span.end()).contains(time));
        let mut speeds = of("Feed_Rate");
        speeds.retain(|(time, _)| span.contains(time));
        Ok(Self {
            blocks: run,
            speeds,
            overrides,
        })
    }

    /// The rapid override at a time, as a share; all of it before the first that is logged.
    pub fn rapid(&self, time: f64) -> f64 {
        let before = self.overrides.partition_point(|(at, _)| *at <= time);
        before
            .checked_sub(1)
            .map_or(1.0, |k| (0.01 * self.overrides[k].1).max(0.01))
    }

    /// For how long the tool stood still between two times.
    pub fn standing(&self, from: f64, to: f64) -> f64 {
        let mut still = 0.0;
        for pair in self.speeds.windows(2) {
            let (begin, end) = (pair[0].0.max(from), pair[1].0.min(to));
            if pair[0].1 == 0.0 && begin < end {
                still += end - begin;
            }
        }
        still
    }
}

/// Seconds since the beginning of the month of `2017-02-01T14:59:08.8437500Z`.
fn seconds(time: &str) -> Option<f64> {
    let (date, clock) = time.strip_suffix('Z')?.split_once('T')?;
    let day: f64 = date.rsplit('-').next()?.parse().ok()?;
    let mut parts = clock.split(':').map(|part| part.parse::<f64>().ok());
    let (hours, minutes, seconds) = (parts.next()??, parts.next()??, parts.next()??);
    Some(((day * 24.0 + hours) * 60.0 + minutes) * 60.0 + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_whole_run_counts() {
        let folder = std::env::temp_dir().join(format!("sweepsim-log-{}", std::process::id()));
        let rows = "2017-02-01T00:00:00.5Z|Block_Number|0\n2017-02-01T00:00:01.5Z|Block_Number|7\n2017-02-01T00:00:02Z|Rapid_Override|50.0\n2017\n\
            2017-02-01T00:00:03Z|Feed_Rate|0\n2017-02-01T00:00:05Z|Feed_Rate|9\n2017-02-01T00:01:00Z|Block_Number|9\n2017-02-02T00:00:00Z|Block_Number|0\n2017-02-02T00:00:01Z|Block_Number|3\n";
        std::fs::write(&folder, rows).unwrap();
        let run = Run::read(&folder, 9).unwrap();
        assert_eq!(run.blocks.iter().map(|block| block.1).collect::<Vec<_>>(), [7, 9]);
        assert_eq!(run.blocks[1].0 - run.blocks[0].0, 58.5);
        let begin = run.blocks[0].0;
        assert_eq!([run.rapid(begin), run.rapid(begin + 1.0)], [1.0, 0.5]);
        assert_eq!(run.standing(begin, begin + 2.5), 1.0);
        assert!(Run::read(&folder, 20).is_err());
        std::fs::remove_file(&folder).unwrap();
    }
}
