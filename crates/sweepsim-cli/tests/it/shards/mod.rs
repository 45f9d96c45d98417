//! Shards and their merge, each as a process.

mod faults;
mod fixtures;
mod judged;

use crate::support::{Workdir, text};
use std::fs;
use std::path::Path;

/// A slot that turns, and a groove across it: three directions of dexels, in tiles of 8.
const JOB: &str = r#"Job(
    tolerance: 1e-5,
    grid: Grid(min: (0, 0), max: (24, 16), cells: (36, 24)),
    stock: Difference(Block(min: (0, 0, 0), max: (24, 16, 8)), [Ball(centre: (12, 8, 0), radius: 4)]),
    tools: { 1: Ball(radius: 2, length: 30), 2: Flat(radius: 1.5, length: 30) },
    paths: [
        Path(tool: 1, poses: [((-3, 3, 5), (0.3, 0, 1)), ((12, 9, 4), (0, 0.4, 1)), ((27, 13, 6), (-0.3, 0, 1))]),
        Path(tool: 2, poses: [((4, -3, 6), (0, 0, 1)), ((4, 19, 6), (0, 0, 1)), ((20, 19, 5), (0, 0, 1)), ((20, -3, 5), (0, 0, 1))]),
    ],
)"#;

/// Small enough to be drawn soon.
const SMALL: [&str; 6] = ["--tile", "8", "--size", "64x48", "--moments", "0"];
const OUTPUTS: &str = "dexels,mesh,picture,report,binary";

/// The page without its table of computing times.
pub fn timeless(html: &str) -> String {
    let (before, rest) = html.split_once("<h2>Computing time</h2>").expect("such a table");
    let (_, after) = rest.split_once("</table>").expect("the end of a table");
    before.to_owned() + after
}

/// All files that one run and a merge leave are the same, but for times.
fn assert_same(folder: &Workdir, whole: &str, merged: &str) {
    let names = |of: &str| -> Vec<String> {
        let entries = fs::read_dir(folder.path(of)).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    assert_eq!(names(whole), names(merged));
    let read = |of: &str, name: &str| fs::read(folder.path(of).join(name)).unwrap();
    for name in names(whole) {
        let [a, b] = [whole, merged].map(|of| read(of, &name));
        match Path::new(&name).extension().and_then(|e| e.to_str()) {
            Some("json") if name != "certificate.json" => {
                let report = |bytes: &[u8]| {
                    let mut report: serde_json::Value = serde_json::from_slice(bytes).unwrap();
                    assert!(report.as_object_mut().unwrap().remove("seconds").is_some());
                    report
                };
                assert_eq!(report(&a), report(&b), "{merged}");
            }
            Some("html") => assert!(timeless(&text(&a)) == timeless(&text(&b)), "{merged}: {name} differs"),
            _ => assert!(a == b, "{merged}: {name} differs"),
        }
    }
}

/// Runs all shards into a folder of pieces, and merges them; the exit status of merge.
fn run_shards(workdir: &Workdir, [command, job]: [&str; 2], more: &[&str], count: usize, merged: &str) -> Option<i32> {
    let pieces = format!("pieces-{count}");
    for index in 0..count {
        let shard = format!("{index}/{count}");
        let arguments = [&[command, job, "--shard", &shard, "--out", &pieces][..], more].concat();
        workdir.good(&arguments);
    }
    let output = workdir.run(&["merge", &pieces, "--out", merged]);
    assert!(text(&output.stderr).is_empty(), "{}", text(&output.stderr));
    output.status.code()
}

#[test]
fn shards_give_what_one_run_gives() {
    let workdir = Workdir::new(JOB);
    let more = [&SMALL[..], &["--only", OUTPUTS]].concat();
    let arguments = [&["simulate", "job.ron", "--out", "whole"][..], &more].concat();
    workdir.good(&arguments);
    for count in [1, 2, 7] {
        let merged = format!("merged-{count}");
        assert_eq!(
            run_shards(&workdir, ["simulate", "job.ron"], &more, count, &merged),
            Some(0)
        );
        assert_same(&workdir, "whole", &merged);
    }
    // Nothing but pieces is left by shards, and none is empty: there are tiles enough.
    let pieces: Vec<_> = fs::read_dir(workdir.path("pieces-7"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    assert_eq!(pieces.len(), 7);
    assert!(
        pieces
            .iter()
            .all(|file| file.extension().is_some_and(|e| e == "piece") && size(file) > 2000)
    );
}

fn size(file: &Path) -> u64 {
    fs::metadata(file).unwrap().len()
}

#[test]
fn pieces_come_from_any_folders_in_any_order() {
    let workdir = Workdir::new(JOB);
    let more = [&SMALL[..], &["--only", "dexels"]].concat();
    workdir.good(&[&["simulate", "job.ron", "--out", "whole"][..], &more].concat());
    // Options that concern one process only do not matter, nor how they are written.
    workdir.good(
        &[
            &["simulate", "--shard=2/3", "job.ron", "--out=c", "--threads", "1"][..],
            &more,
        ]
        .concat(),
    );
    workdir.good(
        &[
            &["simulate", "job.ron", "--quiet", "--out", "a", "--shard", "0/3"][..],
            &more,
        ]
        .concat(),
    );
    workdir.good(
        &[
            &["simulate", "job.ron", "--out", "b", "--shard", "1/3", "--json"][..],
            &more,
        ]
        .concat(),
    );
    workdir.good(&[
        "merge",
        "c",
        "a",
        "b/shard-1-of-3.piece",
        "--out",
        "merged",
        "--threads",
        "2",
    ]);
    let read = |folder: &str| fs::read(workdir.path(folder).join("dexels.csv")).unwrap();
    assert!(read("whole") == read("merged"));
}

#[test]
fn what_is_done_is_not_done_again() {
    let workdir = Workdir::new(JOB);
    let shard = |more: &[&str]| {
        workdir.good(
            &[
                &[
                    "simulate", "job.ron", "--out", "p", "--only", "dexels", "--shard", "0/2",
                ][..],
                more,
            ]
            .concat(),
        )
    };
    let piece = workdir.path("p/shard-0-of-2.piece");
    // Nothing is there yet.
    assert!(shard(&["--resume"]).contains("shard 0/2"));
    let first = fs::read(&piece).unwrap();
    assert!(shard(&["--resume"]).contains("nothing to do"));
    // A file that is not whole is made again, and so is one of another run.
    fs::write(&piece, &first[..first.len() / 2]).unwrap();
    assert!(shard(&["--resume"]).contains("shard 0/2"));
    assert!(fs::read(&piece).unwrap() == first);
    assert!(shard(&["--resume", "--cells", "30x20"]).contains("shard 0/2"));
    assert!(fs::read(&piece).unwrap() != first);
    // Without the option, it is always made.
    assert!(!shard(&[]).contains("nothing to do"));
}

#[test]
fn schedulers_give_the_number_of_a_shard() {
    let workdir = Workdir::new(JOB);
    let run = |shard: &str, variables: &[(&str, &str)]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_sweepsim"));
        command.args([
            "simulate", "job.ron", "--out", "p", "--only", "dexels", "--shard", shard,
        ]);
        command.envs(variables.iter().copied()).current_dir(workdir.path(""));
        command.output().unwrap()
    };
    assert!(run("auto/5", &[("SLURM_ARRAY_TASK_ID", "3")]).status.success());
    assert!(run("auto/5", &[("JOB_COMPLETION_INDEX", "4")]).status.success());
    let array = [("AWS_BATCH_JOB_ARRAY_INDEX", "1"), ("AWS_BATCH_JOB_ARRAY_SIZE", "5")];
    assert!(run("auto", &array).status.success());
    for shard in [1, 3, 4] {
        assert!(workdir.path(&format!("p/shard-{shard}-of-5.piece")).exists());
    }
    let without = run("auto/5", &[]);
    assert_eq!(without.status.code(), Some(2));
    assert!(text(&without.stderr).contains("JOB_COMPLETION_INDEX"));
}
