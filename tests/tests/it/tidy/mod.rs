//! House rules that no lint knows.

mod links;
mod siblings;
mod structure;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Longer files hold more than one story.
const LONGEST: usize = 400;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All files with the extension below the folders; build output, version control and results left out.
fn files(folders: &[&str], extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open: Vec<PathBuf> = folders.iter().map(|folder| root().join(folder)).collect();
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).expect("folders of the workspace can be read") {
            let path = entry.expect("and so can their entries").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !name.starts_with('.') && name != "target" && name != "out" {
                open.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    assert!(!found.is_empty(), "no .{extension} below {folders:?}");
    found.sort();
    found
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).expect("text files are UTF-8")
}

/// Lines that break a rule, as `file:line: text`.
fn offences(files: &[PathBuf], offends: impl Fn(&str) -> bool) -> Vec<String> {
    let offending = |path: &PathBuf| -> Vec<String> {
        text(path)
            .lines()
            .enumerate()
            .filter(|(_, line)| offends(line))
            .map(|(number, line)| format!("{}:{}: {}", path.display(), number + 1, line.trim()))
            .collect()
    };
    files.iter().flat_map(offending).collect()
}

fn assert_none(offences: &[String], rule: &str) {
    assert!(offences.is_empty(), "{rule}:\n{}", offences.join("\n"));
}

/// What is known to break a rule, one a line in a file beside this one, is what was found: nothing is added, and what
/// has been put right leaves the list.
fn ratchet(list: &str, found: &BTreeSet<String>) {
    let known = text(&root().join("tests/tests/it/tidy").join(list));
    let known: BTreeSet<String> = known
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(String::from)
        .collect();
    let lines = |these: &BTreeSet<String>, those: &BTreeSet<String>| -> String {
        let lines: Vec<&str> = these.difference(those).map(String::as_str).collect();
        lines.join("\n")
    };
    let (new, gone) = (lines(found, &known), lines(&known, found));
    assert!(
        new.is_empty() && gone.is_empty(),
        "{list}: against the rule and not known:\n{new}\nno longer true, and to be taken out:\n{gone}"
    );
}

/// Longer lines of comments cannot be read beside the code.
const WIDEST: usize = 120;

/// Lines of comments that could be narrower, as `file:line: text`. Tables and examples cannot be broken anywhere.
fn wide_comments(path: &Path) -> Vec<String> {
    let (mut wide, mut example) = (Vec::new(), false);
    for (number, line) in text(path).lines().enumerate() {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            example = false;
            continue;
        };
        let words = comment.trim_start_matches(['/', '!']).trim_start();
        example ^= words.starts_with("```");
        if !example && !words.starts_with('|') && line.chars().count() > WIDEST {
            wide.push(format!("{}:{}: {words}", path.display(), number + 1));
        }
    }
    wide
}

#[test]
fn comments_are_as_narrow_as_code() {
    let (mut wide, mut found) = (BTreeSet::new(), Vec::new());
    let known = text(&root().join("tests/tests/it/tidy/wide_comments.txt"));
    for path in files(&["crates", "xtask", "tests"], "rs") {
        let offences = wide_comments(&path);
        let inner = path.strip_prefix(root()).expect("within the workspace");
        let parts: Vec<_> = inner.iter().take(3).map(|part| part.to_string_lossy()).collect();
        let folder = parts.join("/");
        if !offences.is_empty() {
            if !known.lines().any(|line| line == folder) {
                found.extend(offences);
            }
            wide.insert(folder);
        }
    }
    assert_none(&found, "comments of at most 120 columns");
    ratchet("wide_comments.txt", &wide);
}

#[test]
fn files_are_short() {
    let long: Vec<String> = files(&["crates", "xtask", "tests"], "rs")
        .iter()
        .map(|path| (path, text(path).lines().count()))
        .filter(|(_, lines)| *lines > LONGEST)
        .map(|(path, lines)| format!("{}: {lines} lines", path.display()))
        .collect();
    assert_none(&long, "a file tells one story");
}

#[test]
fn nothing_is_left_to_do() {
    // Put together here, so that this file does not offend.
    let marks = ["todo", "unimplemented", "dbg"].map(|name| format!("{name}!("));
    let found = offences(&files(&["crates", "xtask", "tests"], "rs"), |line| {
        marks.iter().any(|mark| line.contains(mark))
    });
    assert_none(&found, "no stubs");
}

#[test]
fn only_the_command_prints() {
    let marks = ["println!(", "print!(", "process::exit("];
    let libraries = files(&["crates"], "rs").into_iter().filter(|path| {
        let has = |name: &str| path.components().any(|part| part.as_os_str() == name);
        has("src") && !has("sweepsim-cli") && !has("tests.rs") && !has("tests")
    });
    let mut found = Vec::new();
    for path in libraries {
        let text = text(&path);
        // Unit tests, which stand last, may print.
        let lines = text.lines().enumerate();
        let lines = lines.take_while(|(_, line)| *line != "#[cfg(test)]");
        let prints = lines
            .filter(|(_, line)| !line.trim_start().starts_with("//") && marks.iter().any(|mark| line.contains(mark)));
        found.extend(prints.map(|(number, line)| format!("{}:{}: {}", path.display(), number + 1, line.trim())));
    }
    assert_none(&found, "libraries return errors and take a monitor");
}

#[test]
fn every_folder_of_fixtures_says_where_it_comes_from() {
    let missing: Vec<String> = fs::read_dir(root().join("fixtures"))
        .expect("there are fixtures")
        .map(|entry| entry.expect("that can be read").path())
        .filter(|path| path.is_dir() && !path.join("README.md").is_file())
        .map(|path| path.display().to_string())
        .collect();
    assert_none(&missing, "a README for each");
}
