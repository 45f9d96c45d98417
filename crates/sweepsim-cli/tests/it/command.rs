//! The command as a process: what it writes, what it prints, how it ends.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

const JOB: &str = r#"Job(
    grid: Grid(min: (0, 0), max: (20, 10), cells: (40, 20)),
    stock: Block(min: (0, 0, 0), max: (20, 10, 6)),
    tools: { 1: Ball(radius: 2, length: 30), 2: Flat(radius: 1, length: 30) },
    paths: [
        Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0.5, 0, 1))]),
        Path(tool: 2, poses: [((10, -3, 2), (0, 0, 1)), ((10, 13, 2), (0, 0, 1))]),
    ],
)"#;

const SECOND: &str = "poses: [((10, -3, 2), (0, 0, 1)), ((10, 13, 2), (0, 0, 1))]";
const STOCK: &str = "Block(min: (0, 0, 0), max: (20, 10, 6))";
const FLAT: &str = "Flat(radius: 1, length: 30)";

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sweepsim"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A folder with a job in it.
struct Place(TempDir);

impl Place {
    fn new(job: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("job.ron"), job).expect("a file");
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs `command job.ron --out out` with more arguments.
    fn run(&self, command: &str, more: &[&str]) -> Output {
        let (job, out) = (self.path("job.ron"), self.path("out"));
        let mut arguments = vec![command, job.to_str().unwrap(), "--out", out.to_str().unwrap()];
        arguments.extend(more);
        run(&arguments)
    }

    fn inspect(&self, name: &str) -> Output {
        run(&["inspect", self.path(name).to_str().unwrap()])
    }

    fn report(&self) -> serde_json::Value {
        serde_json::from_slice(&fs::read(self.path("out/report.json")).unwrap()).unwrap()
    }

    fn written(&self) -> Vec<String> {
        listed(&self.path("out"))
    }
}

fn listed(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    names
}

const ALL: [&str; 5] = ["dexels.csv", "part.ply", "part.png", "report.html", "report.json"];

#[test]
fn simulate_writes_everything() {
    let place = Place::new(JOB);
    let output = place.run("simulate", &[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(place.written(), ALL);
    assert!(output.stderr.is_empty(), "no progress without a terminal");
    let summary = text(&output.stdout);
    assert!(summary.contains("2 moves of 2 tools on 40 × 20 dexels"), "{summary}");
    let report = place.report();
    assert_eq!(report["job"], "job");
    assert_eq!(report["method"], "charts");
    assert_eq!(report["cells"], serde_json::json!([40, 20]));
    assert_eq!(report["moves"], 2);
    assert_eq!(report["dexels"]["unresolved"], serde_json::json!([]));
    let number = |name: &str| report[name].as_f64().unwrap();
    let (removed, left) = (number("volume_removed"), number("volume"));
    assert!((removed + left - 20.0 * 10.0 * 6.0).abs() < 1e-9, "{removed} + {left}");
    for phase in ["read", "stock", "sweep", "mesh", "picture"] {
        assert!(report["seconds"][phase].as_f64().is_some(), "{phase}");
    }
    // The rows add up to what the report says.
    let table = fs::read_to_string(place.path("out/dexels.csv")).unwrap();
    let length = |row: &str| {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        cells[3] - cells[2]
    };
    let sum: f64 = table.lines().skip(1).map(length).sum();
    assert!((sum * 0.25 - left).abs() < 1e-9);
    assert!(fs::read(place.path("out/part.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(fs::read(place.path("out/part.ply")).unwrap().starts_with(b"ply\n"));
}

#[test]
fn sweep_needs_no_stock() {
    let place = Place::new(JOB);
    let output = place.run("sweep", &["--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(place.written(), ALL);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("only the report on standard output");
    assert!(report["volume"].as_f64().unwrap() > 0.0);
    assert!(report.get("volume_removed").is_none());
}

#[test]
fn options_do_what_they_say() {
    let place = Place::new(JOB);
    let output = place.run(
        "simulate",
        &[
            "--only",
            "dexels,report",
            "--quiet",
            "--cells",
            "10x5",
            "--tolerance",
            "1e-4",
        ],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
    assert_eq!(place.written(), ["dexels.csv", "report.html", "report.json"]);
    assert_eq!(place.report()["cells"], serde_json::json!([10, 5]));
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let place = Place::new(JOB);
    let mut before = Vec::new();
    for threads in ["1", "2", "5"] {
        let output = place.run("simulate", &["--quiet", "--threads", threads]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let read = |name: &&str| fs::read(place.path("out").join(name)).unwrap();
        let files: Vec<Vec<u8>> = ALL[..3].iter().map(read).collect();
        assert!(before.is_empty() || before == files, "{threads} threads");
        before = files;
    }
}

#[test]
fn the_methods_agree() {
    let place = Place::new(JOB);
    let mut tables: Vec<Vec<Vec<f64>>> = Vec::new();
    for method in ["charts", "planes", "lines", "surface"] {
        let output = place.run("simulate", &["--quiet", "--only", "dexels", "--method", method]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let table = fs::read_to_string(place.path("out/dexels.csv")).unwrap();
        let row = |row: &str| row.split(',').map(|cell| cell.parse().unwrap()).collect();
        tables.push(table.lines().skip(1).map(row).collect());
    }
    for other in &tables[1..] {
        assert_eq!(tables[0].len(), other.len());
        for (a, b) in tables[0].iter().zip(other) {
            assert_eq!(a[..2], b[..2]);
            assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() <= 2e-6), "{a:?} {b:?}");
        }
    }
}

/// A motion of B-splines in the job or in a file of its own, by every command that sweeps.
#[test]
fn motions_of_splines_are_simulated_swept_and_cut() {
    let motion = "tip: Curve(degree: 2, points: [(10, -4, 3), (6, 5, 2), (10, 14, 3)]), \
                  orientation: Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0.3, 0, 0)])";
    let place = Place::new(&JOB.replace(SECOND, &format!("motion: Motion({motion})")));
    let volume = |command: &str| {
        let output = place.run(command, &["--quiet"]);
        assert!(output.status.success(), "{command}: {}", text(&output.stderr));
        place.report()["volume"].as_f64().expect("a number")
    };
    let (left, swept) = (volume("simulate"), volume("sweep"));
    assert!(left < 20.0 * 10.0 * 6.0 && swept > 100.0, "{left} {swept}");
    let output = place.run("section", &["--plane", "z=4"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let inspected = text(&place.inspect("job.ron").stdout);
    assert!(inspected.contains("1 move of tool 2"), "{inspected}");
    // From a file the same, to the bit.
    fs::write(place.path("way.ron"), format!("Motion({motion})")).expect("a file");
    fs::write(place.path("job.ron"), JOB.replace(SECOND, "file: \"way.ron\"")).expect("a file");
    assert_eq!((volume("simulate"), volume("sweep")), (left, swept));
    let place = Place::new(&JOB.replace(SECOND, "file: \"way.ron\""));
    let bad = format!("Motion({})", motion.replace("0.3, 0, 0", "NaN, 0, 0"));
    fs::write(place.path("way.ron"), bad).expect("a file");
    assert_bad(
        &place,
        &place.run("simulate", &[]),
        &["way.ron:1:", "point 1 of the orientation"],
    );
}

/// A corner that cuts the lines beside it instead of touching them is a tool, but not without a word.
#[test]
fn a_corner_that_is_not_tangent_is_said_by_every_command() {
    let good = "Apt(d: 4, r: 1, e: 1, f: 1, a: 0, b: 0, h: 30)";
    let odd = good.replace("r: 1,", "r: 1.25,");
    let place = Place::new(&JOB.replace("Ball(radius: 2, length: 30)", &odd));
    let words = [
        "line 4: tool 1: the corner (r, e, f) is not tangent to the bottom line",
        "side line",
    ];
    let said = |output: &Output| {
        assert!(output.status.success(), "{}", text(&output.stderr));
        let said = text(&output.stdout);
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    said(&place.run("simulate", &[]));
    let notes = place.report()["notes"].as_array().expect("a list").len();
    assert_eq!(notes, 2);
    said(&place.run("sweep", &[]));
    said(&place.run("section", &["--plane", "z=4"]));
    said(&place.inspect("job.ron"));
    fs::write(place.path("job.ron"), JOB.replace("Ball(radius: 2, length: 30)", good)).expect("a file");
    assert!(!text(&place.inspect("job.ron").stdout).contains("tangent"));
}

#[test]
fn inspect_tells_what_is_there() {
    let place = Place::new(JOB);
    let job = place.inspect("job.ron");
    assert!(job.status.success(), "{}", text(&job.stderr));
    let said = text(&job.stdout);
    assert!(said.contains("radius 2.0000, length 30.000 mm"), "{said}");
    assert!(place.run("simulate", &["--quiet"]).status.success());
    for name in ["out/dexels.csv", "out/part.ply"] {
        let output = place.inspect(name);
        assert!(
            output.status.success() && !output.stdout.is_empty(),
            "{name}: {}",
            text(&output.stderr)
        );
    }
    fs::write(place.path("a.nc"), "G21 G90\nG0 X0 Y0 Z5\nG1 Z1 F100\nM999\nX10\nM30\n").unwrap();
    let output = place.inspect("a.nc");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("M999"),
        "not understood, so said: {}",
        text(&output.stdout)
    );
}

/// Exit 2, one message that has all of `words`, nothing on standard output, nothing written.
fn assert_bad(place: &Place, output: &Output, words: &[&str]) {
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty());
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(message.matches("error:").count(), 1, "{message}");
    for word in words {
        assert!(message.contains(word), "no `{word}` in: {message}");
    }
    assert_eq!(place.written(), Vec::<String>::new());
}

#[test]
fn bad_jobs_are_errors_with_a_place() {
    let bad = |from: &str, to: &str, words: &[&str]| {
        assert!(JOB.contains(from), "{from}");
        let place = Place::new(&JOB.replacen(from, to, 1));
        assert_bad(&place, &place.run("simulate", &[]), words);
    };
    bad("Path(tool: 2", "Path(tool: 2,,", &["job.ron:7:"]);
    bad("stock:", "stokc:", &["job.ron:3:5", "stokc"]);
    bad("radius: 2", "radius: -2", &["job.ron:4:", "radius", "-2"]);
    let open = "Profile(start: (0, 0), segments: [Line((3, 0)), Line((3, 9))])";
    bad(FLAT, open, &["job.ron:4:"]);
    let crossing = "Profile(start: (0, 0), segments: [Line((5, 5)), Line((5, 0)), Line((2, 9)), Line((0, 9))])";
    bad(FLAT, crossing, &["job.ron:4:"]);
    bad("(0.5, 0, 1)", "(0, 0, 0)", &["job.ron:6:", "axis"]);
    bad("(0.5, 0, 1)", "(0, 0, -1)", &["job.ron:6:", "opposite"]);
    bad("(0.5, 0, 1)", "(NaN, 0, 1)", &["job.ron:6:"]);
    bad("cells: (40, 20)", "cells: (0, 20)", &["job.ron:2:", "0"]);
    bad("cells: (40, 20)", "cells: (1000000, 1000000)", &["job.ron:2:"]);
    bad(STOCK, "Mesh(\"no.stl\")", &["job.ron:3:", "no.stl"]);
    bad(SECOND, "file: \"no.csv\"", &["job.ron:7:", "no.csv"]);
    bad("tool: 2, poses", "tool: 3, poses", &["job.ron:7:", "3"]);
}

#[test]
fn bad_files_are_errors() {
    let place = Place::new(JOB);
    let missing = run(&["simulate", place.path("none.ron").to_str().unwrap()]);
    assert_bad(&place, &missing, &["none.ron"]);
    let place = Place::new(&JOB.replace(STOCK, "Mesh(\"bad.stl\")"));
    fs::write(place.path("bad.stl"), "this is no STL").unwrap();
    assert_bad(&place, &place.run("simulate", &[]), &["bad.stl", "STL"]);
    // One triangle encloses nothing.
    let one = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid a\n";
    fs::write(place.path("bad.stl"), one).unwrap();
    assert_bad(&place, &place.run("simulate", &[]), &["job.ron", "not closed"]);
    let place = Place::new(&JOB.replace(SECOND, "file: \"bad.ngc\""));
    fs::write(place.path("bad.ngc"), "G21\nG1 X1 Y1 Z1\nG1 X1 Y= Z3\n").unwrap();
    assert_bad(&place, &place.run("simulate", &[]), &["bad.ngc:3:"]);
}

#[test]
fn bad_usage_is_an_error() {
    let place = Place::new(JOB);
    for more in [
        &["--cells", "0x10"][..],
        &["--cells", "1000000x1000000"],
        &["--cells", "many"],
        &["--tolerance", "0"],
        &["--tolerance", "NaN"],
        &["--tolerance", "1e-300"],
        &["--threads", "0"],
        &["--method", "guess"],
        &["--only", "everything"],
    ] {
        let output = place.run("simulate", more);
        assert_bad(&place, &output, &[more[0].trim_start_matches('-')]);
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_found_before_the_work() {
    let place = Place::new(JOB);
    fs::write(place.path("out"), "a file has this name").unwrap();
    let output = place.run("simulate", &[]);
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(message.contains("out") && !message.contains("panicked"), "{message}");
    assert_eq!(fs::read(place.path("out")).unwrap(), b"a file has this name");
    // A folder in the place of one of the files.
    let place = Place::new(JOB);
    fs::create_dir_all(place.path("out/dexels.csv")).unwrap();
    let output = place.run("simulate", &[]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("dexels.csv"));
    assert_eq!(
        place.written(),
        ["dexels.csv"],
        "nothing else, and nothing half-written"
    );
}
