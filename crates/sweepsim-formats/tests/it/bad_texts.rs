//! Texts that are no jobs.

use std::path::Path;

use sweepsim_formats::Job;
use sweepsim_props::*;

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

/// The mark of Unicode that some editors write first is no part of a job; numbers whose squares or volumes are infinite
/// are refused where they are.
#[test]
fn marks_and_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        Job::read(&file).map_err(|error| {
            let message = error.to_string();
            message[folder.path().to_str().unwrap().len() + 1..].to_owned()
        })
    };
    let job = |stock: &str| {
        format!("Job(grid: Grid(min: (0, 0), max: (1, 1), cells: (2, 2)),\nstock: {stock},\ntools: {{}}, paths: [])")
    };
    let good = job("Ball(centre: (0, 0, 0), radius: 1e12)");
    assert!(read("good.ron", &good).is_ok());
    assert!(read("mark.ron", &format!("\u{feff}{good}")).is_ok());
    for (stock, message) in [
        (
            "Ball(centre: (0, 0, 0), radius: 1.5e12)",
            "large.ron:2:40: radius is 1500000000000, but must be positive, and at most 1e12",
        ),
        (
            "Block(min: (0, 0, -1e300), max: (1, 1, 1))",
            "but must be finite, and at most 1e12",
        ),
    ] {
        let error = read("large.ron", &job(stock)).unwrap_err();
        assert!(error.ends_with(message), "{error}");
    }
}
