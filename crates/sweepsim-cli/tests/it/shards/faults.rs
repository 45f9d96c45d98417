//! Pieces that do not belong together, or are not whole: each is named.

use super::{JOB, SMALL};
use crate::support::Workdir;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const PIECE: &str = "pieces/shard-1-of-3.piece";

/// A folder with three pieces.
fn with_pieces() -> Workdir {
    let workdir = Workdir::new(JOB);
    for shard in ["0/3", "1/3", "2/3"] {
        simulate(&workdir, &["--shard", shard, "--out", "pieces"]);
    }
    workdir
}

fn simulate(workdir: &Workdir, more: &[&str]) {
    let arguments = [&["simulate", "job.ron", "--only", "dexels"][..], &SMALL, more].concat();
    workdir.good(&arguments);
}

/// The message of a merge that must fail, which names a file, if one is to blame, and leaves nothing behind.
fn refused(workdir: &Workdir, folders: &[&str], named: &str) -> String {
    let arguments = [&["merge"][..], folders, &["--out", "merged"]].concat();
    let message = workdir.bad(&arguments);
    assert!(message.contains(named), "{message}");
    assert!(!workdir.path("merged/dexels.csv").exists());
    message
}

#[test]
fn missing_and_doubled_pieces_are_named() {
    let workdir = with_pieces();
    fs::create_dir(workdir.path("more")).unwrap();
    fs::copy(workdir.path(PIECE), workdir.path("more/again.piece")).unwrap();
    let message = refused(&workdir, &["pieces", "more"], "more/again.piece");
    assert!(
        message.contains("shard 1 comes twice") && message.contains(PIECE),
        "{message}"
    );
    fs::remove_file(workdir.path(PIECE)).unwrap();
    let message = refused(&workdir, &["pieces"], "--shard 1/3");
    assert!(message.contains("1 of 3 pieces are missing"), "{message}");
    fs::create_dir(workdir.path("empty")).unwrap();
    assert!(refused(&workdir, &["empty"], "empty").contains("no pieces"));
    refused(&workdir, &["nowhere"], "nowhere");
    // Only the missing one is run again.
    simulate(&workdir, &["--shard", "1/3", "--out", "pieces"]);
    workdir.good(&["merge", "pieces", "--out", "merged"]);
}

#[test]
fn pieces_that_are_not_whole_are_named() {
    let workdir = with_pieces();
    let whole = fs::read(workdir.path(PIECE)).unwrap();
    let put = |bytes: &[u8]| fs::write(workdir.path(PIECE), bytes).unwrap();
    for length in [0, 5, 20, 40, whole.len() / 2, whole.len() - 1] {
        put(&whole[..length]);
        let message = refused(&workdir, &["pieces"], PIECE);
        assert!(message.contains("truncated"), "{length}: {message}");
    }
    // One bit of the manifest, of the dexels, of the checksum.
    for at in [60, whole.len() * 3 / 4, whole.len() - 10] {
        let mut other = whole.clone();
        other[at] ^= 4;
        put(&other);
        let message = refused(&workdir, &["pieces"], PIECE);
        assert!(message.contains("damaged"), "{at}: {message}");
    }
    put(&[&whole[..], b"more"].concat());
    assert!(refused(&workdir, &["pieces"], PIECE).contains("damaged"));
    // Lengths that would overflow.
    let mut other = whole.clone();
    other[16..32].fill(0xFF);
    put(&other);
    refused(&workdir, &["pieces"], PIECE);
    let mut other = whole.clone();
    other[8] = 9;
    put(&other);
    assert!(refused(&workdir, &["pieces"], PIECE).contains("version 9"));
    put(b"i,j,z0,z1\n");
    assert!(refused(&workdir, &["pieces"], PIECE).contains("is not a piece"));
    put(&whole);
    workdir.good(&["merge", "pieces", "--out", "merged"]);
}

#[test]
fn pieces_of_other_runs_are_named() {
    let workdir = with_pieces();
    let job = |text: &str| fs::write(workdir.path("job.ron"), text).unwrap();
    // Another tolerance, other cells, another size of tiles, another method.
    for (option, value, told) in [
        ("--tolerance", "1e-4", "its tolerance is 0.0001, not 0.00001"),
        ("--cells", "12x8", "its number of dexels"),
        ("--method", "planes", "its method is planes, not charts"),
    ] {
        simulate(&workdir, &["--shard", "1/3", "--out", "pieces", option, value]);
        let message = refused(&workdir, &["pieces"], PIECE);
        assert!(message.contains(told), "{message}");
    }
    // One coordinate of a path.
    job(&JOB.replace("(12, 9, 4)", "(12, 9, 4.001)"));
    simulate(&workdir, &["--shard", "1/3", "--out", "pieces"]);
    assert!(refused(&workdir, &["pieces"], PIECE).contains("other tools, paths, stock"));
    // Another number of shards.
    job(JOB);
    simulate(&workdir, &["--shard", "1/4", "--out", "pieces"]);
    simulate(&workdir, &["--shard", "1/3", "--out", "pieces"]);
    let message = refused(&workdir, &["pieces"], "shard-1-of-4.piece");
    assert!(message.contains("one of 4"), "{message}");
    fs::remove_file(workdir.path("pieces/shard-1-of-4.piece")).unwrap();
    // All of one run, but the job has changed since.
    job(&JOB.replace("radius: 1.5", "radius: 1.6"));
    assert!(refused(&workdir, &["pieces"], "pieces/shard-0-of-3.piece").contains("stale"));
    job(JOB);
    workdir.good(&["merge", "pieces", "--out", "merged"]);
}

#[test]
fn files_that_the_job_refers_to_count() {
    let path = "x,y,z,i,j,k\n-3,3,5,0,0,1\n27,13,6,0,0,1\n";
    let text = "Job(
        grid: Grid(min: (0, 0), max: (24, 16), cells: (36, 24)),
        stock: Block(min: (0, 0, 0), max: (24, 16, 8)),
        tools: { 1: Ball(radius: 2, length: 30) },
        paths: [ Path(tool: 1, file: \"path.csv\") ],
    )";
    let workdir = Workdir::new(text);
    fs::write(workdir.path("path.csv"), path).unwrap();
    simulate(&workdir, &["--shard", "0/1", "--out", "pieces"]);
    fs::write(workdir.path("path.csv"), path.replace("27,13", "27,12")).unwrap();
    assert!(refused(&workdir, &["pieces"], "shard-0-of-1.piece").contains("stale"));
    fs::write(workdir.path("path.csv"), path).unwrap();
    workdir.good(&["merge", "pieces", "--out", "merged"]);
}

#[test]
fn a_killed_shard_leaves_nothing_and_is_run_again() {
    let workdir = with_pieces();
    // Far more work than a moment's.
    let pieces = |name: &str| -> Vec<PathBuf> {
        let entries = fs::read_dir(workdir.path(name)).into_iter().flatten();
        entries
            .map(|entry| entry.unwrap().path())
            .filter(|file| file.extension().is_some_and(|e| e == "piece"))
            .collect()
    };
    let mut child = Command::new(env!("CARGO_BIN_EXE_sweepsim"))
        .args([
            "simulate",
            "job.ron",
            "--shard",
            "1/3",
            "--out",
            "killed",
            "--cells",
            "3600x2400",
            "--only",
            "dexels",
            "--quiet",
        ])
        .current_dir(workdir.path(""))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    while !workdir.path("killed").exists() && begin.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    // By the signal, and not by an error of its own.
    assert_eq!(child.wait().unwrap().code(), None);
    assert!(pieces("killed").is_empty());
    fs::remove_file(workdir.path(PIECE)).unwrap();
    refused(&workdir, &["pieces", "killed"], "killed");
    refused(&workdir, &["pieces"], "--shard 1/3");
    simulate(&workdir, &["--shard", "1/3", "--out", "pieces", "--resume"]);
    workdir.good(&["merge", "pieces", "--out", "merged"]);
}

#[test]
fn shards_are_for_what_they_can_divide() {
    let workdir = Workdir::new(JOB);
    let message = workdir.bad(&["sweep", "job.ron", "--shard", "0/2", "--out", "p"]);
    assert!(message.contains("--shard is for `simulate` and `verify`"), "{message}");
    for bad in ["2/2", "x", "0/0", "auto"] {
        workdir.bad(&["simulate", "job.ron", "--shard", bad]);
    }
    workdir.bad(&["simulate", "job.ron", "--resume"]);
    workdir.bad(&["simulate", "job.ron", "--tile", "4"]);
    workdir.bad(&["merge"]);
    assert!(!workdir.path("p").exists());
}
