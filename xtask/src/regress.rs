//! `cargo xtask regress` and `bless`: the fixture jobs must give the stored dexels.

use crate::stored::{Stored, Totals, read_totals, write_totals};
use crate::workspace::{self, jobs, listed, name_of};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;
use std::{fs, io};
use sweepsim::{Cut, Options, simulate};
use sweepsim_formats::{Fixture, Job};

/// How many differences of a job are printed.
const SHOWN: usize = 20;

/// What to do about a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Fail.
    Regress,
    /// Print it, and store what was found.
    Bless,
}

/// Runs the jobs named in `only`, or all. `true` when all is as stored (or has been blessed).
pub fn run(mode: Mode, only: &[String]) -> Result<bool, String> {
    let jobs = jobs()?;
    if let Some(unknown) = only.iter().find(|name| !jobs.iter().any(|job| name_of(job) == **name)) {
        return Err(format!("there is no job fixtures/jobs/{unknown}.ron"));
    }
    let file = folder().join("totals.txt");
    let old = read(&file)?.map_or(Ok(BTreeMap::new()), |text| read_totals(&text));
    let mut totals = old.map_err(|error| about(&file, error))?;
    let mut good = orphans(&jobs, &mut totals, mode)?;
    for job in jobs
        .iter()
        .filter(|job| only.is_empty() || only.contains(&name_of(job)))
    {
        good &= check(job, &mut totals, mode)?;
    }
    if mode == Mode::Bless {
        write(&file, &write_totals(&totals))?;
    }
    Ok(good)
}

fn folder() -> PathBuf {
    workspace::fixtures().join("dexels")
}

fn about(path: &Path, error: impl std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

/// The text of a file, `None` when there is no such file.
fn read(path: &Path) -> Result<Option<String>, String> {
    match fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(about(path, error)),
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| about(path, error))
}

/// Stored dexels without a job: wrong, or removed when blessing.
fn orphans(jobs: &[PathBuf], totals: &mut BTreeMap<String, Totals>, mode: Mode) -> Result<bool, String> {
    let known = |name: &str| jobs.iter().any(|job| name_of(job) == name);
    let mut good = true;
    for file in listed(&folder(), "dexels")? {
        if !known(&name_of(&file)) {
            println!("{}: there is no such job", file.display());
            good = false;
            if mode == Mode::Bless {
                fs::remove_file(&file).map_err(|error| about(&file, error))?;
            }
        }
    }
    for name in totals.keys().filter(|name| !known(name)) {
        println!("totals.txt: there is no job {name}");
        good = false;
    }
    if mode == Mode::Bless {
        totals.retain(|name, _| known(name));
    }
    Ok(good || mode == Mode::Bless)
}

/// Runs one job and compares.
fn check(path: &Path, totals: &mut BTreeMap<String, Totals>, mode: Mode) -> Result<bool, String> {
    let name = name_of(path);
    let start = Instant::now();
    let outcome = run_job(path)?;
    let seconds = start.elapsed().as_secs_f64();
    let found = &outcome.found;
    println!("{name}: {}, {seconds:.1} s", found.totals);
    print_some("unresolved ", &outcome.unresolved);
    let file = folder().join(format!("{name}.dexels"));
    let differences = match read(&file)? {
        Some(text) => {
            let stored = Fixture::parse(&text).map_err(|error| about(&file, error))?;
            let compared = found.differences(&stored, totals.get(&name));
            // A different grid is a difference like any other.
            compared.unwrap_or_else(|error| vec![error])
        }
        None => vec!["nothing is stored yet".to_owned()],
    };
    print_some("", &differences);
    if mode == Mode::Bless && !differences.is_empty() {
        let fixture = Fixture::new(&name, &found.sample, outcome.tolerance).map_err(|error| about(path, error))?;
        write(&file, &fixture.text())?;
        totals.insert(name, found.totals);
        println!("  blessed");
    }
    Ok(outcome.unresolved.is_empty() && (differences.is_empty() || mode == Mode::Bless))
}

fn print_some(what: &str, lines: &[String]) {
    for line in lines.iter().take(SHOWN) {
        println!("  {what}{line}");
    }
    if lines.len() > SHOWN {
        println!("  … and {} more", lines.len() - SHOWN);
    }
}

/// The result of a job.
struct Outcome {
    found: Stored,
    tolerance: f64,
    /// Uncertified dexels.
    unresolved: Vec<String>,
}

/// Sweeps the paths of a job one after the other, and removes the swept volumes from the stock.
fn run_job(path: &Path) -> Result<Outcome, String> {
    let job = Job::read(path).map_err(|error| error.to_string())?;
    let stock = job.stock.dexels(&job.grid).map_err(|error| about(path, error))?;
    let cuts: Vec<Cut> = job
        .paths
        .iter()
        .map(|cut| Cut::new(&job.tools[&cut.tool], &cut.path))
        .collect();
    let done = simulate(stock, &cuts, &Options::new(job.tolerance), &()).map_err(|error| about(path, error))?;
    let open = done.statistics.unresolved.iter();
    let unresolved = open.map(|dexel| format!("dexel ({}, {}): {}", dexel.i, dexel.j, dexel.reason));
    Ok(Outcome {
        found: Stored::of(&done.remaining).map_err(|error| about(path, error))?,
        tolerance: job.tolerance,
        unresolved: unresolved.collect(),
    })
}
