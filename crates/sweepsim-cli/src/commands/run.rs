//! `simulate` and `sweep`, whole or in shards, and `merge`; and what they share with `verify`.

use super::summary::{json, summary};
use crate::arguments::{JobOptions, MergeOptions, RunOptions};
use crate::session::{Failure, Lines, Outputs, Progress, print};
use std::path::{Path, PathBuf, absolute};
use std::process::ExitCode;
use std::time::Instant;
use sweepsim_formats::{Verdict, io_reason};
use sweepsim_job::{JobError, Merge, Outcome, Plan, Reused, ShardNumber, Sink, Task, Written, output_folder, words};

/// How the process works, whatever it does.
pub(super) struct Process {
    pub start: Instant,
    threads: Option<u16>,
    pub quiet: bool,
    json: bool,
}

impl Process {
    fn pool(&self) -> Result<rayon::ThreadPool, JobError> {
        let mut builder = rayon::ThreadPoolBuilder::new();
        if let Some(threads) = self.threads {
            builder = builder.num_threads(usize::from(threads));
        }
        builder
            .build()
            .map_err(|error| JobError::Run(format!("cannot start the threads: {error}")))
    }
}

/// Runs a job, or one shard of it, and writes its outputs.
pub(crate) fn run(task: Task, options: &JobOptions) -> Result<ExitCode, Failure> {
    let process = Process::of(&options.run);
    let plan = options.run.request(&options.job, task).plan()?;
    match options.run.shard {
        Some(number) => shard(&plan, number, &options.run, &process),
        None => whole(plan, options.run.out.as_deref(), &process),
    }
}

/// Carries out a plan, writes its outputs, and says what was found.
fn whole(plan: Plan, out: Option<&Path>, process: &Process) -> Result<ExitCode, Failure> {
    let folder = output_folder(out, &plan.job().name);
    let done = process.carry_out(plan, folder, None)?;
    process.say(&done)?;
    Ok(ExitCode::from(done.status()))
}

/// What a run left.
pub(super) struct Done {
    pub outcome: Outcome,
    pub written: Written,
    pub outputs: Outputs,
    threads: usize,
}

impl Done {
    /// The exit status.
    pub fn status(&self) -> u8 {
        match self.written.report.verdict {
            Some(Verdict::Fail) => 1,
            Some(Verdict::Undecided) => 3,
            _ if self.written.certified => 0,
            _ => 3,
        }
    }
}

impl Process {
    pub fn of(options: &RunOptions) -> Self {
        Self {
            start: Instant::now(),
            threads: options.threads,
            quiet: options.quiet,
            json: options.json,
        }
    }

    /// Carries out a plan, and writes its outputs to a folder, and a certificate where one is wanted.
    pub fn carry_out(&self, plan: Plan, folder: PathBuf, certificate: Option<&Path>) -> Result<Done, JobError> {
        plan.check_room()?;
        let mut outputs = Outputs::new(folder)?;
        let pool = self.pool()?;
        let progress = Progress::new(plan.job().moves(), self.quiet);
        let done = pool.install(|| {
            let (outcome, written) = plan.run_to(&mut outputs, &progress)?;
            if let Some(file) = certificate {
                let none = "there is nothing to certify: nothing was decided, or a proof was too long";
                let none = || JobError::Request {
                    field: "certificate",
                    why: none.to_owned(),
                };
                let text = outcome.certificate()?.ok_or_else(none)?;
                let name = file.to_string_lossy();
                Outputs::anywhere().write(&name, &mut |file| file.write_all(text.as_bytes()))?;
            }
            Ok::<_, JobError>((outcome, written))
        });
        progress.finish();
        let (outcome, written) = done?;
        Ok(Done {
            outcome,
            written,
            outputs,
            threads: pool.current_num_threads(),
        })
    }

    /// Prints what was found.
    pub fn say(&self, done: &Done) -> Result<(), Failure> {
        let report = &done.written.report;
        if self.json {
            print(&json(report)?)
        } else if !self.quiet {
            let total = self.start.elapsed().as_secs_f64();
            summary(done.outcome.plan(), report, &done.outputs, done.threads, total).print()?;
            done.outcome
                .reused()
                .map_or(Ok(()), |reused| reused_lines(&reused).print())
        } else {
            Ok(())
        }
    }
}

/// What was known from earlier runs.
fn reused_lines(reused: &Reused) -> Lines {
    let mut lines = Lines::default();
    let [again, moves] = [reused.again, reused.moves].map(|count| words::count(count as u64));
    let file = reused.file.display();
    lines.line("cache", &format!("{again} of {moves} moves judged again ({file})"));
    reused.notes.iter().for_each(|note| lines.line("", note));
    lines
}

/// Computes a shard, and writes its piece.
pub(super) fn shard(
    plan: &Plan,
    number: ShardNumber,
    options: &RunOptions,
    process: &Process,
) -> Result<ExitCode, Failure> {
    plan.check_shards()?;
    let folder = output_folder(options.out.as_deref(), &plan.job().name);
    let file = folder.join(Plan::piece_name(number));
    if options.resume && plan.is_shard_done(number, &file)? {
        if !process.quiet {
            print(&format!("{} is done: nothing to do\n", file.display()))?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let mut outputs = Outputs::new(folder)?;
    let progress = Progress::new(plan.job().moves(), process.quiet);
    let piece = process.pool()?.install(|| plan.shard(number, &progress));
    progress.finish();
    let piece = piece?;
    piece.write_to(&mut outputs)?;
    if !process.quiet {
        print(&format!(
            "shard {number}: {}, {}; {} ({})\n",
            words::counted(piece.tiles() as u64, "tile"),
            words::counted(piece.dexels() as u64, "dexel"),
            file.display(),
            words::bytes(piece.size() as u64)
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Joins the pieces of all shards of a run.
pub(crate) fn merge(options: &MergeOptions) -> Result<ExitCode, Failure> {
    let process = Process {
        start: Instant::now(),
        threads: options.threads,
        quiet: options.quiet,
        json: options.json,
    };
    let merge = Merge::read(&options.pieces)?;
    let out = output_folder(options.out.as_deref(), merge.job());
    let out = absolute(&out).map_err(|error| Failure::message(format!("{}: {}", out.display(), io_reason(&error))))?;
    // Names of files are as they were given there. Where that folder does not exist, as in another container, they are
    // taken from here.
    let there = merge.folder();
    if there.is_dir() && std::env::set_current_dir(there).is_err() {
        return Err(Failure::message(format!(
            "{}: cannot change to the folder of its run, {}",
            merge.piece().display(),
            there.display()
        )));
    }
    whole(merge.plan()?, Some(&out), &process)
}
