//! `cargo xtask cluster`: the files of fixtures/cluster on a Slurm of one node on loopback, for `simulate` and for
//! `verify`. One task is killed on its way, and what the merges leave is compared with one run each.

#[cfg(test)]
mod kubernetes;
mod measure;
mod slurm;

use crate::workspace;
pub use measure::run as measure;
use slurm::Slurm;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// What is submitted.
struct Trial {
    command: &'static str,
    job: &'static str,
    shards: usize,
    /// The task that is killed.
    victim: Option<usize>,
    options: &'static [&'static str],
    /// What the merge leaves, but for report.json.
    files: &'static [&'static str],
}

/// A job of which each shard takes a second or so, and options that keep the rest short; and a program with faults.
const TRIALS: [Trial; 2] = [
    Trial {
        command: "simulate",
        job: "jobs/teapot-interior.ron",
        shards: 8,
        victim: Some(1),
        options: &[
            "--cells",
            "240x144",
            "--tile",
            "48",
            "--size",
            "400x300",
            "--moments",
            "0",
            "--only",
            "dexels,mesh,picture,report",
        ],
        files: &["dexels.csv", "part.ply", "part.png"],
    },
    Trial {
        command: "verify",
        job: "verify/bracket-faulty.ron",
        shards: 4,
        victim: None,
        options: &["--tile", "32", "--moments", "0", "--moves", "--only", "dexels,report"],
        files: &["dexels.csv", "moves.csv"],
    },
];
/// How long all may take.
const PATIENCE: Duration = Duration::from_secs(300);

/// Runs it; `false` if something differs.
pub fn run() -> Result<bool, String> {
    let programs = slurm::Programs::find()?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace::root().join("target"), PathBuf::from);
    let folder = std::path::absolute(target.join("cluster")).map_err(|error| error.to_string())?;
    let fixtures = fs::canonicalize(workspace::fixtures()).map_err(|error| format!("fixtures: {error}"))?;
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let sweepsim = sweepsim()?;
    let begin = Instant::now();
    let log = |text: &str| println!("{:>7.2} s  {text}", begin.elapsed().as_secs_f64());
    let slurm = Slurm::start(&programs, &folder, &sweepsim)?;
    log("munged, slurmctld and slurmd are up");
    let mut same = true;
    for trial in &TRIALS {
        same &= trial.run(&slurm, &sweepsim, &folder, &fixtures, &log)?;
    }
    Ok(same)
}

impl Trial {
    /// Submits it, and compares with one run.
    fn run(
        &self,
        slurm: &Slurm,
        sweepsim: &Path,
        folder: &Path,
        fixtures: &Path,
        log: &dyn Fn(&str),
    ) -> Result<bool, String> {
        let (job, out) = (fixtures.join(self.job), folder.join(self.command));
        let mut submit = slurm.command(&fixtures.join("cluster/slurm-submit.sh"));
        // Without a command, it is `simulate`.
        submit.args(Some(self.command).filter(|command| *command != "simulate"));
        submit
            .arg(&job)
            .arg(self.shards.to_string())
            .arg(&out)
            .args(self.options);
        let told = slurm::output(&mut submit)?;
        log(&format!("{}: {}", self.command, told.trim()));
        let array = told
            .split([' ', ','])
            .nth(1)
            .ok_or("no number of the array")?
            .to_owned();
        let killed = self.watch(slurm, &array, &out, log)?;
        for number in 0..self.shards {
            let text = fs::read_to_string(out.join(format!("log/{array}_{number}.txt"))).unwrap_or_default();
            text.lines().for_each(|line| log(&format!("task {number}: {line}")));
        }
        let merged = fs::read_to_string(out.join("log/merge.txt")).unwrap_or_default();
        merged.lines().for_each(|line| log(&format!("merge: {line}")));
        if let (Some(victim), false) = (self.victim, killed) {
            return Err(format!("task {victim} ended before it could be killed"));
        }
        let whole = folder.join(format!("{}-whole", self.command));
        let mut command = Command::new(sweepsim);
        command.arg(self.command).arg(&job).args(self.options);
        let status = command.arg("--quiet").arg("--out").arg(&whole).status();
        let status = status.map_err(|error| format!("{}: {error}", sweepsim.display()))?;
        // 1: faults are found, as they should be.
        let expected = i32::from(self.command == "verify");
        if status.code() != Some(expected) {
            return Err(format!("one run of {}: {status}, expected {expected}", self.command));
        }
        log("one run of the same");
        let same = compare(&whole, &out, self.files)?;
        for (name, same) in &same {
            log(&format!("{name} {}", if *same { "is the same" } else { "DIFFERS" }));
        }
        Ok(same.iter().all(|(_, same)| *same))
    }

    /// Follows the array and the merge to their end, and kills one task; whether it could be killed.
    fn watch(&self, slurm: &Slurm, array: &str, out: &Path, log: &dyn Fn(&str)) -> Result<bool, String> {
        let begin = Instant::now();
        let victim = self.victim.map(|victim| {
            (
                victim,
                out.join(format!("pieces/shard-{victim}-of-{}.piece", self.shards)),
            )
        });
        let (mut before, mut killed) = (String::new(), false);
        loop {
            let queue = slurm.query(&["squeue", "-h", "-r", "-S", "i", "-o", "%i %T"])?;
            if let (Some((victim, piece)), false) = (&victim, killed)
                && queue
                    .lines()
                    .any(|line| line.trim() == format!("{array}_{victim} RUNNING"))
            {
                slurm.query(&["scontrol", "requeue", &format!("{array}_{victim}")])?;
                killed = !piece.exists();
                log(&format!(
                    "task {victim} is killed and queued again; its piece is {}there",
                    if killed { "not " } else { "" }
                ));
            }
            let states = states(&queue);
            if states != before {
                log(&states);
                before = states;
            }
            if queue.trim().is_empty() {
                return Ok(killed);
            }
            if begin.elapsed() > PATIENCE {
                return Err(format!("not done after {} s: {queue}", PATIENCE.as_secs()));
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }
}

/// How many tasks are in each state.
fn states(queue: &str) -> String {
    let mut counts = std::collections::BTreeMap::new();
    for state in queue.lines().filter_map(|line| line.split_whitespace().nth(1)) {
        *counts.entry(state).or_insert(0) += 1;
    }
    if counts.is_empty() {
        return "queue: empty".to_owned();
    }
    let words: Vec<String> = counts
        .iter()
        .map(|(state, count)| format!("{count} {}", state.to_lowercase()))
        .collect();
    format!("queue: {}", words.join(", "))
}

/// The command, beside this program or built.
fn sweepsim() -> Result<PathBuf, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let file = own.with_file_name("sweepsim");
    if !file.is_file() {
        let mut cargo = Command::new(env!("CARGO"));
        cargo
            .current_dir(workspace::root())
            .args(["build", "--quiet", "--package", "sweepsim-cli"]);
        if !cfg!(debug_assertions) {
            cargo.arg("--release");
        }
        slurm::output(&mut cargo)?;
    }
    fs::canonicalize(&file).map_err(|error| format!("{}: {error}", file.display()))
}

/// What one run and the merge left: whether each file is the same.
fn compare(whole: &Path, merged: &Path, files: &[&'static str]) -> Result<Vec<(&'static str, bool)>, String> {
    let read = |folder: &Path, name: &str| fs::read(folder.join(name)).map_err(|error| format!("{name}: {error}"));
    let mut all = Vec::new();
    for name in files {
        all.push((*name, read(whole, name)? == read(merged, name)?));
    }
    let report = |folder: &Path| -> Result<serde_json::Value, String> {
        let text = read(folder, "report.json")?;
        let mut report: serde_json::Value = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
        report.as_object_mut().map(|fields| fields.remove("seconds"));
        Ok(report)
    };
    all.push(("report.json (but for seconds)", report(whole)? == report(merged)?));
    Ok(all)
}
