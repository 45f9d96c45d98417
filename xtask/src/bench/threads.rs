//! Two threads against one.

use super::records::{Records, heading};
use super::{Clock, on, programs, shortest_by, three_axis};
use crate::workspace;
use sweepsim_formats::Job;

/// What is wanted of two threads.
const WANTED: f64 = 1.85;
const JOBS: [&str; 4] = ["impeller", "impeller-blade", "teapot-exterior", "teapot-interior"];
/// Times that both are measured, one after the other, so that a disturbance meets both.
const ROUNDS: usize = 3;

/// One piece of work on one thread and on two. The shortest of both, and whether the results agree.
pub fn pair(run: &(dyn Fn() -> Result<u64, String> + Sync)) -> Result<[f64; 2], String> {
    let mut best = [f64::INFINITY; 2];
    let mut found = None;
    for _ in 0..ROUNDS {
        for (threads, best) in [1, 2].into_iter().zip(&mut best) {
            let seconds = on(threads, || {
                shortest_by(Clock::wall, || {
                    let crossings = run()?;
                    match found {
                        Some(before) if before != crossings => {
                            Err(format!("{threads} threads: {crossings} crossings, not {before}"))
                        }
                        _ => Ok(()),
                    }
                })
            })??;
            *best = best.min(seconds);
        }
        found = Some(run()?);
    }
    Ok(best)
}

/// Programs on one thread and on two, by the clock: the ratio is that of a quiet machine only if two cores are free.
pub fn threads() -> Result<(), String> {
    let mut records = Records::open();
    heading("Threads: by the clock, so two free cores are needed");
    println!(
        "{:<28} {:>9} {:>9} {:>7} {:>7} {:>7}",
        "work", "1, s", "2, s", "ratio", "wanted", "before"
    );
    let mut row = |name: &str, run: &(dyn Fn() -> Result<u64, String> + Sync)| -> Result<(), String> {
        let [one, two] = pair(run)?;
        let before = records.note(&format!("threads/{name}"), one / two);
        println!(
            "{name:<28} {one:>9.3} {two:>9.3} {:>7.2} {WANTED:>7.2} {before:>7}",
            one / two
        );
        Ok(())
    };
    for name in JOBS {
        let file = workspace::fixtures().join("jobs").join(name).with_extension("ron");
        let job = Job::read(&file).map_err(|error| error.to_string())?;
        row(name, &|| programs::once(&job).map(|statistics| statistics.crossings))?;
    }
    for tool in ["flat", "ball"] {
        row(&format!("three-axis-{tool}, cut"), &|| three_axis::cut(tool, 1000))?;
    }
    records.save()
}
