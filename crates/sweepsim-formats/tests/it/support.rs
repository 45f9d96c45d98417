//! A job without a fault, and what is said of jobs with one.

use std::path::Path;

use sweepsim_formats::Job;

/// A job without a fault, with marks to put one in.
pub const GOOD: &str = "\
Job(
    units: Mm,
    tolerance: 1e-6,
    grid: Grid(min: (0, 0), max: (10, 10), cells: (4, 5)),
    stock: Block(min: (0, 0, 0), max: (10, 10, 5)),
    tools: {
        1: Ball(radius: 2.0, length: 30.0),
    },
    paths: [
        Path(tool: 1, poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]),
    ],
)
";

/// The message for a job in a folder.
pub fn message(text: &str, folder: &Path) -> String {
    let file = folder.join("job.ron");
    std::fs::write(&file, text).unwrap();
    let error = Job::read(&file).expect_err(text);
    let rendered = error.render(false);
    assert!(rendered.contains(&error.problem().to_string()), "{rendered}");
    let message = error.to_string();
    assert!(!message.contains('\n'), "one line: {message}");
    message.replace(&format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR), "")
}

/// Replaces a text of the good job by another one, and compares the beginning of the message.
pub fn check(cases: &[(&str, String, &str)], folder: &Path) {
    let mut wrong = String::new();
    for (from, to, expected) in cases {
        assert!(GOOD.contains(from), "{from}");
        let found = message(&GOOD.replace(from, to), folder);
        if !found.starts_with(expected) {
            wrong += &format!("{to}\n  expected {expected}\n  found    {found}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
