//! The fixture jobs in 1, 2, 7 and 64 shards.

use super::{OUTPUTS, SMALL, assert_same, run_shards};
use crate::support::Workdir;
use std::fs;
use std::path::Path;

/// Runs a command on a fixture job whole and in shards, and compares all that they leave.
fn compare([command, name]: [&str; 2], more: &[&str], counts: &[usize]) {
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures").join(name);
    let job = fs::canonicalize(job).unwrap();
    let job = job.to_str().unwrap();
    let workdir = Workdir::new("");
    let more = [more, &["--only", OUTPUTS]].concat();
    let whole = workdir.run(&[&[command, job, "--out", "whole"][..], &more].concat());
    for count in counts {
        let merged = format!("merged-{count}");
        let status = run_shards(&workdir, [command, job], &more, *count, &merged);
        assert_eq!(status, whole.status.code(), "{name}");
        assert_same(&workdir, "whole", &merged);
    }
}

/// All jobs in a folder of fixtures.
fn jobs(folder: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures")
        .join(folder);
    let names = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name());
    let names = names.map(|name| format!("{folder}/{}", name.into_string().unwrap()));
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".ron")).collect();
    names.sort();
    names
}

#[test]
fn fixture_jobs_on_small_grids_are_the_same_in_shards() {
    let small = |cells: &'static str| [&SMALL[..], &["--cells", cells]].concat();
    compare(["simulate", "jobs/quickstart.ron"], &small("30x20"), &[5]);
    compare(["verify", "verify/bracket-faulty.ron"], &small("25x15"), &[3]);
}

/// Tiles so small that each of 64 shards has some.
const TILES: [&str; 6] = ["--tile", "24", "--size", "400x300", "--moments", "0"];

#[test]
#[ignore = "takes many minutes: each fixture job five times, in 74 processes"]
fn every_fixture_job_is_the_same_in_shards() {
    let names = jobs("jobs");
    assert!(names.len() >= 7);
    for name in names {
        compare(["simulate", &name], &TILES, &[1, 2, 7, 64]);
    }
}

#[test]
#[ignore = "takes many minutes: each fixture job five times, in 74 processes"]
fn every_fixture_job_is_verified_the_same_in_shards() {
    let names = [jobs("verify"), jobs("jobs")].concat();
    assert!(names.len() >= 9);
    for name in names {
        compare(["verify", &name], &TILES, &[1, 2, 7, 64]);
    }
}
