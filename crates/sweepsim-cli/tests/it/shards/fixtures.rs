//! The fixture jobs in 1, 2, 7 and 64 shards.

use super::{OUTPUTS, SMALL, assert_same, run_shards};
use crate::support::Workdir;
use std::fs;
use std::path::Path;

/// Runs a fixture job whole and in shards, and compares all that they leave.
fn compare(name: &str, more: &[&str], counts: &[usize]) {
    let job = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/jobs")
        .join(name);
    let job = fs::canonicalize(job).unwrap();
    let job = job.to_str().unwrap();
    let workdir = Workdir::new("");
    let more = [more, &["--only", OUTPUTS]].concat();
    let whole = workdir.run(&[&["simulate", job, "--out", "whole"][..], &more].concat());
    for count in counts {
        let merged = format!("merged-{count}");
        let status = run_shards(&workdir, job, &more, *count, &merged);
        assert_eq!(status, whole.status.code(), "{name}");
        assert_same(&workdir, "whole", &merged);
    }
}

#[test]
fn a_fixture_job_on_a_small_grid_is_the_same_in_shards() {
    let more = [&SMALL[..], &["--cells", "30x20"]].concat();
    compare("quickstart.ron", &more, &[5]);
}

#[test]
#[ignore = "takes minutes: each fixture job five times, in 74 processes"]
fn every_fixture_job_is_the_same_in_shards() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/jobs");
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".ron"))
        .collect();
    names.sort();
    assert!(names.len() >= 7);
    for name in names {
        // Tiles so small that each of 64 shards has some.
        let more = ["--tile", "24", "--size", "400x300", "--moments", "0"];
        compare(&name, &more, &[1, 2, 7, 64]);
    }
}
