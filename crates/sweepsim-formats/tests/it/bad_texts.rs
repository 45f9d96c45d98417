//! Texts that are no jobs.

use std::path::Path;

use proptest::prelude::*;
use sweepsim_formats::Job;

use crate::support::{GOOD, message};

#[test]
fn files_that_are_no_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let missing = Job::read(&folder.path().join("none.ron")).unwrap_err().to_string();
    assert!(missing.contains("none.ron: cannot read this file"), "{missing}");
    assert!(message("", folder.path()).starts_with("job.ron:1:1: "));
    assert!(message("Job(", folder.path()).starts_with("job.ron:1:"));
    let file = folder.path().join("bytes.ron");
    std::fs::write(&file, b"Job(\n name: \"\xff\"").unwrap();
    let error = Job::read(&file).unwrap_err().to_string();
    assert!(error.contains("bytes.ron:2:9: this is not a text file"), "{error}");
    // Deeper than any job: an error, not an overflow.
    assert!(message(&"(".repeat(100_000), folder.path()).starts_with("job.ron:1:"));
}

#[test]
fn rendered_with_the_line() {
    let text = GOOD.replace("radius: 2.0", "radius: -2.0");
    let error = Job::parse(&text, Path::new("jobs/part.ron")).unwrap_err();
    let expected = "\
error: tool 1: radius is -2, but must be positive
 --> jobs/part.ron:7:25
  |
7 |         1: Ball(radius: -2.0, length: 30.0),
  |                         ^^^^";
    assert_eq!(error.render(false), expected);
    assert!(error.render(true).contains("\u{1b}["));
}

proptest! {
    /// Whatever is changed: a job, or an error with its place in the text.
    #[test]
    fn changes_are_read_or_refused_with_a_place(
        at in any::<prop::sample::Index>(),
        length in 0usize..6,
        with in prop::sample::select(&["", "(", ")", "]", "}", "\"", ",", ":", "-", "0", "9e999", "inf", "NaN", "x", "\n", "/*", "//", "'", "r#", "é", "Some(", "tool: "][..]),
    ) {
        let at = at.index(GOOD.len());
        let end = (at + length).min(GOOD.len());
        let text = format!("{}{with}{}", &GOOD[..at], &GOOD[end..]);
        if let Err(error) = Job::parse(&text, Path::new("job.ron")) {
            let place = error.position();
            prop_assert!(place.is_some(), "{error}");
            let lines = text.lines().count() + 1;
            prop_assert!(place.is_some_and(|place| (1..=lines).contains(&place.line) && place.column >= 1));
            let _ = error.render(true);
        }
    }
}
