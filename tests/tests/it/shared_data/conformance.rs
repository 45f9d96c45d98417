//! LinuxCNC's own tests of its interpreter: the canonical commands that it expects.
//!
//! Compared are moves, dwells, length offsets and the texts of `(DEBUG,…)` and `(PRINT,…)`, with the last decimal
//! printed. Not compared is what has no geometry: comments, the spindle, coolant, overrides, resets, the tool table,
//! and offsets, which the moves after them show.

use std::path::{Path, PathBuf};

use sweepsim_nc::{Controller, Machine, ReadOptions, ToolOffset, gcode};

use super::folder;

/// What the comparison keeps.
const COMPARED: [&str; 6] = [
    "STRAIGHT_TRAVERSE(",
    "STRAIGHT_FEED(",
    "ARC_FEED(",
    "DWELL(",
    "MESSAGE(",
    "USE_TOOL_LENGTH_OFFSET(",
];

fn one_space(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The commands of a file of expected output.
fn expected(text: &str) -> Vec<String> {
    let mut commands = Vec::new();
    for line in text.lines() {
        match line.split_once("N.....") {
            Some((_, command)) => {
                let command = one_space(command).replace("(\" ", "(\"");
                if COMPARED.iter().any(|kept| command.starts_with(kept)) {
                    commands.push(command);
                }
            }
            None => commands.push(one_space(line)),
        }
    }
    commands.retain(|command| !command.is_empty() && command != "executing");
    commands
}

fn found(commands: &[String]) -> Vec<String> {
    let canonical = |command: &str| command.contains('(') && command.starts_with(|c: char| c.is_ascii_uppercase());
    commands
        .iter()
        .map(|command| {
            one_space(command)
                .replace("(\" ", "(\"")
                .replace("-0.000000", "0.000000")
        })
        .filter(|command| {
            let name = command.split('(').next().unwrap_or("");
            let known = ["SET_G5X_OFFSET", "SET_G92_OFFSET", "SET_XY_ROTATION"];
            !(canonical(command) && known.contains(&name))
        })
        .collect()
}

/// Whether two commands differ by no more than the last decimal.
fn same(a: &str, b: &str) -> bool {
    let parts = |text: &str| -> Vec<String> {
        text.split(|c: char| " ,()\"".contains(c))
            .filter(|part| !part.is_empty())
            .map(String::from)
            .collect()
    };
    let (a, mut b) = (parts(a), parts(b));
    // The scripts drop the first word of what is printed.
    if b.len() == a.len() + 1 {
        b.remove(0);
    }
    a.len() == b.len()
        && a.iter()
            .zip(&b)
            .all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) => (a - b).abs() < 1.5e-4,
                _ => a == b,
            })
}

/// LinuxCNC's tool table: `T1 P1 Z0.5 D0.125`, in inches.
fn tool_table(text: &str) -> Vec<(u32, ToolOffset)> {
    text.lines()
        .filter_map(|line| {
            let words: Vec<&str> = line.split(';').next()?.split_whitespace().collect();
            let get = |letter: char| {
                words
                    .iter()
                    .find_map(|word| word.strip_prefix([letter, letter.to_ascii_lowercase()]))
            };
            let number = get('T')?.parse().ok()?;
            let length = |letter| get(letter).and_then(|value| value.parse::<f64>().ok()).unwrap_or(0.0);
            let tool = ToolOffset {
                length: 25.4 * length('Z'),
                diameter: 25.4 * length('D'),
            };
            Some((number, tool))
        })
        .collect()
}

/// LinuxCNC, standing at 0 with no offsets set.
pub(super) fn stand_alone() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.controller = Some(Controller::LinuxCnc);
    for first in [5161, 5181] {
        options.variables.extend((first..first + 3).map(|index| (index, 0.0)));
    }
    for offset in 0..9 {
        let first = 5221 + 20 * offset;
        options.variables.extend((first..first + 10).map(|index| (index, 0.0)));
    }
    options.start = Some([0.0; 3]);
    // Rotary axes are only counted.
    options.machine = Machine::default().tip_control(true);
    options
}

fn tests_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    if entries.iter().any(|entry| entry.ends_with("expected")) {
        found.push(folder.to_owned());
    }
    for entry in entries.iter().filter(|entry| entry.is_dir()) {
        tests_below(entry, found);
    }
}

fn canonical(test: &Path, program: &Path) -> (Vec<String>, bool) {
    let mut options = stand_alone();
    options.subprograms = vec![test.join("subs")];
    if let Ok(table) = std::fs::read_to_string(test.join("test.tbl")) {
        options.tool_offsets = tool_table(&table).into_iter().collect();
    }
    let text = std::fs::read_to_string(program).unwrap();
    let (commands, problem) = gcode::canonical(&text, Some(program), &options);
    // A program without a move is none to this crate.
    let refused = problem.is_some_and(|problem| !problem.to_string().contains("this program has no move"));
    (found(&commands), refused)
}

/// The first difference, if there is one.
fn difference(test: &Path) -> Option<String> {
    let mut programs: Vec<PathBuf> = std::fs::read_dir(test)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ngc"))
        .collect();
    programs.sort();
    let script = std::fs::read_to_string(test.join("test.sh")).unwrap();
    // Where an error is expected, its text is LinuxCNC's own.
    if script
        .lines()
        .any(|line| line.starts_with("! ") || line.starts_with("if !"))
    {
        return programs
            .iter()
            .find(|program| !canonical(test, program).1)
            .map(|program| format!("{} was not refused", program.display()));
    }
    let program = programs.first()?;
    let (mut found, _) = canonical(test, program);
    if script.contains("/MESSAGE/") {
        found.retain(|command| command.starts_with("MESSAGE"));
    }
    let expected = expected(&std::fs::read_to_string(test.join("expected")).unwrap());
    for k in 0..expected.len().max(found.len()) {
        match (expected.get(k), found.get(k)) {
            (Some(a), Some(b)) if same(a, b) => {}
            (a, b) => return Some(format!("{k}: expected {a:?}, found {b:?}")),
        }
    }
    None
}

/// What differs, and why.
const DIFFERENT: [(&str, &str); 7] = [
    (
        "interp/g52/g92-offset-persistence",
        "the .var and .ini files with the offsets are not among the data",
    ),
    ("interp/g84/g18/g98", "LinuxCNC 2.10 taps along the wrong axis in G18"),
    ("interp/g84/g19/g98", "LinuxCNC 2.10 taps along the wrong axis in G19"),
    ("interp/g84/g19/g99", "LinuxCNC 2.10 taps along the wrong axis in G19"),
    (
        "interp/m98m99/09-disable-fanuc-subs",
        "six runs with .ini files that are not among the data",
    ),
    (
        "interp/nested-sub-in-file-error",
        "calls a subroutine that is defined farther down, which this reader finds",
    ),
    (
        "interp/oword-unwind",
        "goes on after errors, where this reader stops tracing; one of its programs is not among the data",
    ),
];

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn canonical_commands() {
    let root = folder().join("conformance/linuxcnc");
    let mut tests = Vec::new();
    tests_below(&root, &mut tests);
    let mut different = Vec::new();
    for test in &tests {
        let name = test.strip_prefix(&root).unwrap().display().to_string();
        if let Some(difference) = difference(test) {
            println!("{name}: {difference}");
            different.push(name);
        }
    }
    let known: Vec<&str> = DIFFERENT.iter().map(|(name, _)| *name).collect();
    assert_eq!(different, known, "shorten the list when one of them passes");
    println!("{} of {} pass", tests.len() - different.len(), tests.len());
    assert_eq!(tests.len(), 45);
}

/// LinuxCNC's own programs that must be refused.
#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn bad_programs_are_refused() {
    let bad = folder().join("conformance/linuxcnc/interp/bad");
    let mut count = 0;
    for entry in std::fs::read_dir(&bad).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "ngc") {
            let text = std::fs::read_to_string(&path).unwrap();
            let (_, problem) = gcode::canonical(&text, Some(&path), &stand_alone());
            let problem = problem.unwrap_or_else(|| panic!("{} was read", path.display()));
            assert!(problem.position().is_some(), "{problem}");
            assert!(
                !problem.to_string().contains("has no move"),
                "{}: {problem}",
                path.display()
            );
            count += 1;
        }
    }
    assert_eq!(count, 23);
}
