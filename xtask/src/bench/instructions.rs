//! Instructions instead of seconds: they hardly differ from run to run, however busy the machine is.

use super::records::ratio;
use super::{on, programs, table1, three_axis};
use crate::others::peers::Work;
use crate::workspace;
use std::collections::BTreeMap;
use std::fs;
use std::process::Command;
use sweepsim::Method;
use sweepsim_formats::Job;

/// Fixture jobs that are counted; the others take long under valgrind.
const JOBS: [&str; 2] = ["quickstart", "motions"];
/// Ends of the tools that mill in five axes.
const ENDS: [&str; 2] = ["flat", "ball"];
/// Cells of Table 1 that are counted.
const CELLS: usize = 200;
const METHODS: [Method; 5] = [
    Method::Mixed,
    Method::General,
    Method::Planes,
    Method::Lines,
    Method::Surface,
];

/// Counts of the last stored version: they depend on the compiler, but not on the machine.
const STORED: &str = "xtask/instructions.csv";

/// Counts the instructions of every piece of work by valgrind's callgrind, each in a separate process, and compares
/// with the stored counts.
///
/// `filter`: only pieces of work whose names contain it. `store`: stores these counts, and leaves the others as they
/// are.
pub fn instructions(filter: Option<&str>, store: bool) -> Result<(), String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let file = workspace::root().join(STORED);
    let mut stored: BTreeMap<String, f64> = BTreeMap::new();
    for line in fs::read_to_string(&file).unwrap_or_default().lines() {
        if let Some((name, Ok(millions))) = line.split_once(',').map(|(name, number)| (name, number.parse())) {
            stored.insert(name.to_owned(), millions);
        }
    }
    // The cost of a process that does nothing.
    let nothing = count(&own, "nothing")?;
    println!("\nInstructions, one thread, in millions; `stored`: ratio to {STORED}");
    println!("{:<28} {:>12} {:>7}", "work", "Mio. instr.", "stored");
    for name in names() {
        if filter.is_none_or(|filter| name.contains(filter)) {
            let millions = (count(&own, &name)?.saturating_sub(nothing)) as f64 * 1e-6;
            println!(
                "{name:<28} {millions:>12.2} {:>7}",
                ratio(millions, stored.get(&name).copied())
            );
            stored.insert(name, millions);
        }
    }
    if store {
        let lines = stored.iter().map(|(name, millions)| format!("{name},{millions:.2}\n"));
        let text = format!("work,millions\n{}", lines.collect::<String>());
        fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}

/// Those of Table 1, and one of rational patches.
fn cutters() -> impl Iterator<Item = &'static str> {
    table1::CUTTERS.into_iter().chain(["rational"])
}

fn names() -> Vec<String> {
    let mut names = Vec::new();
    for cutter in cutters() {
        for sweep in 1..=2 {
            let name = |method| format!("{cutter}-sweep{sweep}-{method}");
            // Tools of patches by charts: the others take minutes.
            let methods = match cutter {
                "form" => &METHODS[..2],
                "rational" => &METHODS[1..2],
                _ => &METHODS,
            };
            names.extend(methods.iter().map(name));
        }
    }
    names.extend(three_axis::TOOLS.map(|tool| format!("three-axis-{tool}")));
    names.extend(ENDS.map(|end| format!("five-axis-{end}")));
    names.extend(JOBS.map(String::from));
    names
}

fn count(own: &std::path::Path, name: &str) -> Result<u64, String> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(own)
        .args(["work", name])
        .output()
        .map_err(|error| format!("valgrind: {error} (install it to count instructions)"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(format!("{name}: {text}"));
    }
    let collected = text.lines().find_map(|line| line.split_once("Collected :"));
    let number = collected.and_then(|(_, number)| number.trim().parse().ok());
    number.ok_or_else(|| format!("{name}: no count in what valgrind printed: {text}"))
}

/// Does one piece of work, once, on one thread.
pub fn work(name: &str) -> Result<(), String> {
    on(1, || here(name))?
}

fn here(name: &str) -> Result<(), String> {
    if name == "nothing" {
        return Ok(());
    }
    if let Some(tool) = name.strip_prefix("three-axis-") {
        return three_axis::once(tool, CELLS, Method::default()).map(drop);
    }
    if let Some(end) = name.strip_prefix("five-axis-") {
        let work = Work::five_axis(end == "ball")?;
        return work.simulate(work.stock()?).map(drop);
    }
    if JOBS.contains(&name) {
        let file = workspace::fixtures().join("jobs").join(name).with_extension("ron");
        let job = Job::read(&file).map_err(|error| error.to_string())?;
        return programs::once(&job).map(drop);
    }
    for cutter in cutters() {
        for which in 0..2 {
            for method in METHODS {
                if name == format!("{cutter}-sweep{}-{method}", which + 1) {
                    return table1::cutter(cutter)?.entry(which, CELLS)?.run(method);
                }
            }
        }
    }
    Err(format!("no piece of work has the name {name}"))
}
