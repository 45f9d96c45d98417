//! The fixture jobs.

use super::records::{Records, heading};
use super::{Clock, on, shortest_by};
use crate::workspace;
use sweepsim::{Options, Statistics, sweep};
use sweepsim_formats::Job;

/// The fixture jobs, on one thread and on all.
pub fn programs() -> Result<(), String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut records = Records::open();
    heading("Programs: the fixture jobs, swept, by the clock");
    println!(
        "{:<18} {:>7} {:>9} {:>11} {:>9} {:>9} {:>9} {:>7} {:>7}",
        "job",
        "moves",
        "cells",
        "crossings",
        "1, s",
        format!("{all}, s"),
        "moves/s",
        "1 / all",
        "before"
    );
    for file in workspace::jobs()? {
        let job = Job::read(&file).map_err(|error| error.to_string())?;
        let timed = |threads| on(threads, || shortest_by(Clock::wall, || once(&job).map(drop)))?;
        let statistics = once(&job)?;
        let (one, many) = (timed(1)?, timed(all)?);
        let [nx, ny] = job.grid.cells();
        let name = workspace::name_of(&file);
        let before = records.note(&format!("programs/{name}"), many);
        println!(
            "{name:<18} {:>7} {:>9} {:>11} {one:>9.3} {many:>9.3} {:>9.0} {:>7.2} {before:>7}",
            statistics.moves,
            format!("{nx}x{ny}"),
            statistics.crossings,
            statistics.moves as f64 / many,
            one / many
        );
    }
    records.save()
}

/// Sweeps every path of a job.
pub fn once(job: &Job) -> Result<Statistics, String> {
    let mut statistics = Statistics::default();
    for cut in &job.paths {
        let options = Options::new(job.tolerance);
        let swept = sweep(&job.tools[&cut.tool], &cut.path, &job.grid, &options, &());
        statistics.merge(&swept.map_err(|error| error.to_string())?.statistics);
    }
    Ok(statistics)
}
