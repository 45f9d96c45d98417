//! `verify`: one program, or several one after the other; and what continuous integration gets of them.

use super::run::{Done, Process, shard};
use crate::arguments::VerifyOptions;
use crate::session::{Failure, Lines, Outputs, print};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use sweepsim_formats::{AtomicFile, io_reason};
use sweepsim_job::{CiProgram, JobError, Request, Sink as _, folder_name, output_folder, to_junit, to_sarif, words};

/// Exit statuses, the worst first.
const WORST_FIRST: [u8; 4] = [2, 1, 3, 0];

/// Judges programs, each into a folder, and says what was found.
pub(crate) fn verify(options: &VerifyOptions) -> Result<ExitCode, Failure> {
    let requests = options.requests()?;
    let is_single = options.batch.is_none() && requests.len() == 1;
    if !is_single {
        refuse_of_several(options)?;
    }
    let root = std::env::current_dir();
    let root = root.map_err(|error| Failure::message(format!("the current folder: {}", io_reason(&error))))?;
    for file in options.sarif.iter().chain(&options.junit) {
        // Dropped without a commit, it leaves no file: nobody should wait for what cannot be written.
        drop(AtomicFile::create(file)?);
    }
    let process = Process::of(&options.run);
    if let (true, Some(number)) = (is_single, options.run.shard) {
        let [request] = requests
            .try_into()
            .map_err(|_| Failure::message("expected one program"))?;
        return shard(&request.plan()?, number, &options.run, &process);
    }
    let folders = match is_single {
        true => vec![None],
        false => folders(options.run.out.as_deref(), &requests)
            .into_iter()
            .map(Some)
            .collect(),
    };
    let (mut programs, mut rows) = (Vec::new(), Vec::new());
    for (request, folder) in requests.into_iter().zip(folders) {
        let input = request.input().name().to_owned();
        if !is_single && !process.quiet {
            print(&format!("{}\n", input.display()))?;
        }
        let (out, certificate) = (options.run.out.as_deref(), options.judging.certificate.as_deref());
        let judged = request.plan().and_then(|plan| {
            let folder = folder.unwrap_or_else(|| output_folder(out, &plan.job().name));
            process.carry_out(plan, folder, certificate)
        });
        match judged {
            Ok(done) => {
                programs.push(done.outcome.ci(&done.written, &root));
                process.say(&done)?;
                rows.push(Row::of(&input, &done));
            }
            Err(JobError::Cancelled) => return Err(JobError::Cancelled.into()),
            Err(error) => {
                programs.push(error.ci(&input, &root));
                rows.push(Row::broken(&input, &error));
                anstream::eprintln!("{}", Failure::from(error));
            }
        }
    }
    write_ci(options, &programs)?;
    if !is_single && !process.quiet {
        table(&rows, process.start.elapsed().as_secs_f64()).print()?;
    }
    let worst = WORST_FIRST
        .into_iter()
        .find(|status| rows.iter().any(|row| row.status == *status));
    Ok(ExitCode::from(worst.unwrap_or_default()))
}

/// Options that name one file, or one report.
fn refuse_of_several(options: &VerifyOptions) -> Result<(), Failure> {
    let (run, judging) = (&options.run, &options.judging);
    let refused = [
        (
            "certificate",
            judging.certificate.is_some(),
            "each has certificate.json in its folder",
        ),
        ("json", run.json, "each has report.json in its folder"),
        ("shard", run.shard.is_some(), "expected one program"),
    ];
    match refused.iter().find(|(_, given, _)| *given) {
        Some((name, _, why)) => Err(Failure::message(format!("--{name} is for one program: {why}"))),
        None => Ok(()),
    }
}

/// A folder for each program, called like it: a further program of the same name gets a number.
fn folders(out: Option<&Path>, requests: &[Request]) -> Vec<PathBuf> {
    let (mut taken, out) = (BTreeSet::new(), out.unwrap_or(Path::new("out")));
    let mut own = |request: &Request| {
        let stem = request.input().name().file_stem().unwrap_or_default();
        let name = folder_name(&stem.to_string_lossy()).display().to_string();
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        // Some disks do not tell capital letters from small ones.
        let free = std::iter::once(name.clone())
            .chain(numbered)
            .find(|name| taken.insert(name.to_lowercase()));
        out.join(free.unwrap_or(name))
    };
    requests.iter().map(&mut own).collect()
}

fn write_ci(options: &VerifyOptions, programs: &[CiProgram]) -> Result<(), Failure> {
    let cannot = |error: &dyn std::fmt::Display| Failure::message(format!("cannot make the list of findings: {error}"));
    let write = |file: &Path, text: String| {
        let name = file.to_string_lossy();
        Outputs::anywhere().write(&name, &mut |file| file.write_all(text.as_bytes()))
    };
    if let Some(file) = &options.sarif {
        write(file, to_sarif(programs).map_err(|error| cannot(&error))?)?;
    }
    if let Some(file) = &options.junit {
        write(file, to_junit(programs).map_err(|error| cannot(&error))?)?;
    }
    Ok(())
}

/// A program in the table at the end.
struct Row {
    status: u8,
    program: String,
    answer: String,
}

impl Row {
    fn of(input: &Path, done: &Done) -> Self {
        let report = &done.written.report;
        let mut answer = words::answer(report).unwrap_or_default();
        if !done.written.certified {
            answer += "; some dexels are UNRESOLVED";
        }
        Self {
            status: done.status(),
            program: input.display().to_string(),
            answer: format!("{answer} ({})", done.outputs.folder().display()),
        }
    }

    fn broken(input: &Path, error: &JobError) -> Self {
        Self {
            status: 2,
            program: input.display().to_string(),
            answer: format!("BROKEN: {error}"),
        }
    }
}

/// The programs with their exit statuses and verdicts.
fn table(rows: &[Row], seconds: f64) -> Lines {
    let mut lines = Lines::default();
    let width = rows
        .iter()
        .map(|row| row.program.chars().count())
        .max()
        .unwrap_or_default();
    lines.line("status", &format!("{:width$}  verdict", "program"));
    for row in rows {
        lines.line(
            &row.status.to_string(),
            &format!("{:width$}  {}", row.program, row.answer),
        );
    }
    let total = words::counted(rows.len() as u64, "program");
    lines.line("time", &format!("{total} in {}", words::seconds(seconds)));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_programs_share_a_folder() {
        let requests = ["a/part.nc", "b/Part.nc", "part.ron", "part-2.nc", "c.nc"].map(Request::from_file);
        let found = folders(Some(Path::new("o")), &requests);
        let expected = ["o/part", "o/Part-2", "o/part-3", "o/part-2-2", "o/c"];
        assert_eq!(found, expected.map(PathBuf::from));
        assert_eq!(folders(None, &requests[4..]), [PathBuf::from("out/c")]);
    }
}
