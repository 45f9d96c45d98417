//! Real programs against their own numbers, read here word by word: the end of every block, and where the tool points
//! there.

use super::folder;
use std::collections::BTreeMap;
use sweepsim_motion::Pose;
use sweepsim_nc::{Program, ReadOptions, read_file};

/// The end of a block: X, Y, Z in millimetres and A, B, C.
type End = ([f64; 3], [f64; 3]);

/// The ends of the blocks of a program that has no offsets of tools, no cycles, variables or subprograms, by line.
/// `None`: it has some.
fn ends(text: &str) -> Option<BTreeMap<usize, End>> {
    let mut found = BTreeMap::new();
    let (mut at, mut absolute, mut unit, mut moving) = ([None::<f64>; 3], true, 1.0, false);
    let mut turned = [0.0; 3];
    let (mut zeros, mut zero) = ([[0.0; 3]; 2], 0);
    for (index, line) in text.lines().enumerate() {
        let mut code = String::new();
        let mut comment = false;
        for c in line.chars() {
            match c {
                '(' => comment = true,
                ')' => comment = false,
                ';' if !comment => break,
                c if !comment && !c.is_whitespace() => code.push(c.to_ascii_uppercase()),
                _ => {}
            }
        }
        if code.contains(['#', '[', 'O', '<']) && !code.starts_with('%') {
            return None;
        }
        if code.starts_with('%') {
            continue;
        }
        let starts: Vec<usize> = code
            .match_indices(|c: char| c.is_ascii_alphabetic())
            .map(|(at, _)| at)
            .collect();
        let words: Vec<(char, f64)> = starts
            .iter()
            .enumerate()
            .filter_map(|(k, &start)| {
                let end = starts.get(k + 1).copied().unwrap_or(code.len());
                Some((code[start..].chars().next()?, code[start + 1..end].parse().ok()?))
            })
            .collect();
        let before = (at, turned);
        let (mut by_machine, mut sets) = (false, false);
        for (letter, value) in &words {
            match (letter, (value * 10.0).round() as i64) {
                ('G', 0 | 10 | 20 | 30) => moving = true,
                ('G', 200 | 700) => unit = 25.4,
                ('G', 210 | 710) => unit = 1.0,
                ('G', 900) => absolute = true,
                ('G', 910) => absolute = false,
                // Where that is only the machine knows.
                ('G', 530) => by_machine = true,
                ('G', 100) => sets = true,
                ('G', 540) => zero = 0,
                ('G', 550) => zero = 1,
                ('G', 40 | 170 | 400 | 430 | 490 | 610 | 611 | 640 | 800 | 930 | 940 | 980 | 911) => {}
                ('G', 180 | 190) => {}
                ('G', _) | ('U' | 'V' | 'W', _) => return None,
                _ => {}
            }
        }
        if sets {
            // G10 L2 P: where the zero of a work offset is.
            let word = |wanted: char| words.iter().find(|(letter, _)| *letter == wanted).map(|word| word.1);
            let (Some(2.0), Some(number @ (1.0 | 2.0)), None) = (word('L'), word('P'), word('R')) else {
                return None;
            };
            zeros[number as usize - 1] = ['X', 'Y', 'Z'].map(|axis| word(axis).unwrap_or(0.0) * unit);
            continue;
        }
        for (letter, value) in words {
            if let Some(k) = "ABC".find(letter) {
                turned[k] = value;
            }
            if let Some(k) = "XYZ".find(letter) {
                at[k] = match at[k] {
                    _ if by_machine => None,
                    _ if absolute => Some(value * unit + zeros[zero][k]),
                    Some(now) => Some(now + value * unit),
                    None => return None,
                };
            }
        }
        if let ([Some(x), Some(y), Some(z)], true) = (at, moving && (at, turned) != before) {
            found.insert(index + 1, ([x, y, z], turned));
        }
    }
    Some(found)
}

fn last_by_line(program: &Program) -> BTreeMap<usize, Pose> {
    program.poses.iter().map(|pose| (pose.line, pose.pose)).collect()
}

/// Where the tool points in the part of LinuxCNC's rotary tables, whose positive angles turn the part as the letters
/// say, with A or B below C.
fn axis([a, b, c]: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = [a, b, c].map(f64::to_radians);
    let tilt = a + b;
    let across = if b == 0.0 { [0.0, a.sin()] } else { [-b.sin(), 0.0] };
    [
        c.cos() * across[0] + c.sin() * across[1],
        c.cos() * across[1] - c.sin() * across[0],
        tilt.cos(),
    ]
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn the_end_of_every_block() {
    let mut options = ReadOptions::default();
    options.arc_tolerance = 0.1;
    let mut checked = BTreeMap::new();
    let mut wrong: Vec<String> = Vec::new();
    for part in ["3axis/linuxcnc", "3axis/camotics", "5axis/linuxcnc"] {
        for entry in std::fs::read_dir(folder().join(part)).expect("a folder") {
            let file = entry.expect("a file").path();
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if !["nc", "ngc", "gcode"]
                .iter()
                .any(|extension| name.ends_with(&format!(".{extension}")))
            {
                continue;
            }
            let text = String::from_utf8_lossy(&std::fs::read(&file).expect("bytes")).into_owned();
            let Some(expected) = ends(&text) else {
                println!("{name}: has more than moves");
                continue;
            };
            let program = read_file(&file, &options).unwrap_or_else(|error| panic!("{error}"));
            let found = last_by_line(&program);
            for (line, (end, angles)) in &expected {
                // Where the tool already is, at the start, there is no move.
                let Some(pose) = found.get(line) else {
                    if program.poses[0].line > *line || program.poses[0].pose.tip() == *end {
                        continue;
                    }
                    wrong.push(format!("{name}:{line}: no move to {end:?}"));
                    continue;
                };
                let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
                if apart(pose.tip(), *end) > 1e-9 || apart(pose.axis(), axis(*angles)) > 1e-12 {
                    wrong.push(format!("{name}:{line}: {pose:?}, but the file says {end:?} {angles:?}"));
                }
            }
            // Once all coordinates are known, no other block moves, but for full circles, whose end is their start.
            let known = expected.keys().next().copied().unwrap_or(0);
            for line in found
                .keys()
                .filter(|line| **line > known && !expected.contains_key(line))
            {
                let text = text.lines().nth(*line - 1).unwrap_or("").to_ascii_uppercase();
                if !text.contains(['I', 'J', 'K']) {
                    wrong.push(format!("{name}:{line}: {text:?} moves"));
                }
            }
            checked.insert(name, expected.len());
        }
    }
    println!("{checked:#?}");
    assert!(
        wrong.is_empty(),
        "{} wrong: {:#?}",
        wrong.len(),
        &wrong[..wrong.len().min(20)]
    );
    // 29 programs for three axes, two boats and an impeller.
    assert_eq!(checked.len(), 32);
    assert!(checked.values().sum::<usize>() > 380_000);
}
