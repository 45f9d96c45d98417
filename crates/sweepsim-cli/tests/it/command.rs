//! The command as a process: what it writes, what it prints, how it ends.

use crate::support::{Workdir, text};
use std::fs;
use std::process::Output;

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

fn report(workdir: &Workdir) -> serde_json::Value {
    serde_json::from_slice(&fs::read(workdir.path("out/report.json")).unwrap()).unwrap()
}

fn inspect(workdir: &Workdir, name: &str) -> Output {
    workdir.run(&["inspect", name])
}

const ALL: [&str; 5] = ["dexels.csv", "part.ply", "part.png", "report.html", "report.json"];

#[test]
fn simulate_writes_everything() {
    let workdir = Workdir::new(JOB);
    let output = workdir.run_job("simulate", &[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(workdir.written(), ALL);
    assert!(output.stderr.is_empty(), "no progress without a terminal");
    let summary = text(&output.stdout);
    assert!(summary.contains("2 moves of 2 tools on 40 × 20 dexels"), "{summary}");
    let report = report(&workdir);
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
    let table = fs::read_to_string(workdir.path("out/dexels.csv")).unwrap();
    let length = |row: &str| {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        cells[3] - cells[2]
    };
    let sum: f64 = table.lines().skip(1).map(length).sum();
    assert!((sum * 0.25 - left).abs() < 1e-9);
    assert!(fs::read(workdir.path("out/part.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(fs::read(workdir.path("out/part.ply")).unwrap().starts_with(b"ply\n"));
}

#[test]
fn sweep_needs_no_stock() {
    let workdir = Workdir::new(JOB);
    let output = workdir.run_job("sweep", &["--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(workdir.written(), ALL);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("only the report on standard output");
    assert!(report["volume"].as_f64().unwrap() > 0.0);
    assert!(report.get("volume_removed").is_none());
}

#[test]
fn options_do_what_they_say() {
    let workdir = Workdir::new(JOB);
    let output = workdir.run_job(
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
    assert_eq!(workdir.written(), ["dexels.csv", "report.html", "report.json"]);
    assert_eq!(report(&workdir)["cells"], serde_json::json!([10, 5]));
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let workdir = Workdir::new(JOB);
    let mut before = Vec::new();
    for threads in ["1", "2", "5"] {
        let output = workdir.run_job("simulate", &["--quiet", "--threads", threads, "--size", "320x240"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let read = |name: &&str| fs::read(workdir.path("out").join(name)).unwrap();
        let files: Vec<Vec<u8>> = ALL[..3].iter().map(read).collect();
        assert!(before.is_empty() || before == files, "{threads} threads");
        before = files;
    }
}

#[test]
fn the_methods_agree() {
    let workdir = Workdir::new(JOB);
    let mut tables: Vec<Vec<Vec<f64>>> = Vec::new();
    for method in ["charts", "general", "planes", "lines", "surface"] {
        let output = workdir.run_job("simulate", &["--quiet", "--only", "dexels", "--method", method]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let table = fs::read_to_string(workdir.path("out/dexels.csv")).unwrap();
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

/// A motion along B-splines, in the job or in a separate file, with every command that sweeps.
#[test]
fn motions_of_splines_are_simulated_swept_and_cut() {
    let motion = "tip: Curve(degree: 2, points: [(10, -4, 3), (6, 5, 2), (10, 14, 3)]), \
                  orientation: Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0.3, 0, 0)])";
    let workdir = Workdir::new(&JOB.replace(SECOND, &format!("motion: Motion({motion})")));
    let volume = |command: &str| {
        let output = workdir.run_job(command, &["--quiet", "--size", "160x120"]);
        assert!(output.status.success(), "{command}: {}", text(&output.stderr));
        report(&workdir)["volume"].as_f64().expect("a number")
    };
    let (left, swept) = (volume("simulate"), volume("sweep"));
    assert!(left < 20.0 * 10.0 * 6.0 && swept > 100.0, "{left} {swept}");
    let output = workdir.run_job("section", &["--plane", "z=4"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let inspected = text(&inspect(&workdir, "job.ron").stdout);
    assert!(inspected.contains("1 move of tool 2"), "{inspected}");
    // From a file the same, to the bit.
    fs::write(workdir.path("way.ron"), format!("Motion({motion})")).expect("a file");
    fs::write(workdir.path("job.ron"), JOB.replace(SECOND, "file: \"way.ron\"")).expect("a file");
    assert_eq!((volume("simulate"), volume("sweep")), (left, swept));
    let workdir = Workdir::new(&JOB.replace(SECOND, "file: \"way.ron\""));
    let bad = format!("Motion({})", motion.replace("0.3, 0, 0", "NaN, 0, 0"));
    fs::write(workdir.path("way.ron"), bad).expect("a file");
    assert_bad(
        &workdir,
        &workdir.run_job("simulate", &[]),
        &["way.ron:1:", "point 1 of the orientation"],
    );
}

/// A corner that cuts the lines beside it instead of touching them is a tool, but not without a word.
#[test]
fn a_corner_that_is_not_tangent_is_said_by_every_command() {
    let good = "Apt(d: 4, r: 1, e: 1, f: 1, a: 0, b: 0, h: 30)";
    let odd = good.replace("r: 1,", "r: 1.25,");
    let workdir = Workdir::new(&JOB.replace("Ball(radius: 2, length: 30)", &odd));
    let words = [
        "line 4: tool 1: the corner (r, e, f) is not tangent to the bottom line",
        "side line",
    ];
    let said = |output: &Output| {
        assert!(output.status.success(), "{}", text(&output.stderr));
        let said = text(&output.stdout);
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    said(&workdir.run_job("simulate", &["--size", "160x120"]));
    let notes = report(&workdir)["notes"].as_array().expect("a list").len();
    assert_eq!(notes, 2);
    said(&workdir.run_job("sweep", &["--size", "160x120"]));
    said(&workdir.run_job("section", &["--plane", "z=4"]));
    said(&inspect(&workdir, "job.ron"));
    fs::write(
        workdir.path("job.ron"),
        JOB.replace("Ball(radius: 2, length: 30)", good),
    )
    .expect("a file");
    assert!(!text(&inspect(&workdir, "job.ron").stdout).contains("tangent"));
}

#[test]
fn inspect_tells_what_is_there() {
    let workdir = Workdir::new(JOB);
    let job = inspect(&workdir, "job.ron");
    assert!(job.status.success(), "{}", text(&job.stderr));
    let said = text(&job.stdout);
    assert!(said.contains("radius 2.0000, length 30.000 mm"), "{said}");
    let small = ["--quiet", "--size", "160x120"];
    assert!(workdir.run_job("simulate", &small).status.success());
    for name in ["out/dexels.csv", "out/part.ply"] {
        let output = inspect(&workdir, name);
        assert!(
            output.status.success() && !output.stdout.is_empty(),
            "{name}: {}",
            text(&output.stderr)
        );
    }
    fs::write(
        workdir.path("a.nc"),
        "G21 G90\nG0 X0 Y0 Z5\nG1 Z1 F100\nM999\nX10\nM30\n",
    )
    .unwrap();
    let output = inspect(&workdir, "a.nc");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("M999"),
        "not understood, so said: {}",
        text(&output.stdout)
    );
    // By its content, whatever its name; and all that is wrong with it.
    fs::write(workdir.path("O1000"), "G0 X0 Y0 Z5\nG60 X1\nG200 X1\n").unwrap();
    let output = inspect(&workdir, "O1000");
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    for place in ["O1000:2:1", "O1000:3:1"] {
        assert!(said.contains(place), "{said}");
    }
    assert!(
        said.contains("G60: single-direction positioning is") && said.contains("G200 is not supported"),
        "{said}"
    );
    // Programs that are missing are said, and what is there is read.
    fs::write(workdir.path("O1000"), "G0 X0 Y0 Z5\nM98 P4\nG0 X1 Y1 Z5\nG1 Z1 F100\n").unwrap();
    let output = inspect(&workdir, "O1000");
    let said = text(&output.stdout);
    assert!(
        output.status.success() && said.contains("assumed  line 2: the moves of O4, a program that is missing"),
        "{said}"
    );
}

/// Exit 2, one message that has all of `words`, nothing on standard output, nothing written.
fn assert_bad(workdir: &Workdir, output: &Output, words: &[&str]) {
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty());
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(message.matches("error:").count(), 1, "{message}");
    for word in words {
        assert!(message.contains(word), "no `{word}` in: {message}");
    }
    assert_eq!(workdir.written(), Vec::<String>::new());
}

#[test]
fn bad_jobs_are_errors_with_a_place() {
    let bad = |from: &str, to: &str, words: &[&str]| {
        assert!(JOB.contains(from), "{from}");
        let workdir = Workdir::new(&JOB.replacen(from, to, 1));
        assert_bad(&workdir, &workdir.run_job("simulate", &[]), words);
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
    let workdir = Workdir::new(JOB);
    let missing = workdir.run(&["simulate", "none.ron"]);
    assert_bad(&workdir, &missing, &["none.ron"]);
    let workdir = Workdir::new(&JOB.replace(STOCK, "Mesh(\"bad.stl\")"));
    fs::write(workdir.path("bad.stl"), "this is not an STL file").unwrap();
    assert_bad(&workdir, &workdir.run_job("simulate", &[]), &["bad.stl", "STL"]);
    // One triangle encloses nothing.
    let one = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid a\n";
    fs::write(workdir.path("bad.stl"), one).unwrap();
    assert_bad(&workdir, &workdir.run_job("simulate", &[]), &["job.ron", "not closed"]);
    let workdir = Workdir::new(&JOB.replace(SECOND, "file: \"bad.ngc\""));
    fs::write(workdir.path("bad.ngc"), "G21\nG1 X1 Y1 Z1\nG1 X1 Y= Z3\n").unwrap();
    assert_bad(&workdir, &workdir.run_job("simulate", &[]), &["bad.ngc:3:"]);
}

#[test]
fn bad_usage_is_an_error() {
    let workdir = Workdir::new(JOB);
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
        let output = workdir.run_job("simulate", more);
        assert_bad(&workdir, &output, &[more[0].trim_start_matches('-')]);
    }
}

/// A minus sign was taken for another option, even where it is right.
#[test]
fn values_may_begin_with_a_minus_sign() {
    let workdir = Workdir::new(JOB);
    workdir.good(&["section", "job.ron", "--plane", "-1,0,0=-3", "--out", "out", "--quiet"]);
    let said = workdir.bad(&["verify", "job.ron", "--clearance", "-1"]);
    assert!(
        said.contains("expected a number of millimetres, 0 or greater"),
        "{said}"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_found_before_the_work() {
    let workdir = Workdir::new(JOB);
    fs::write(workdir.path("out"), "a file has this name").unwrap();
    let output = workdir.run_job("simulate", &[]);
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(message.contains("out") && !message.contains("panicked"), "{message}");
    assert_eq!(fs::read(workdir.path("out")).unwrap(), b"a file has this name");
    // A folder in the workdir of one of the files.
    let workdir = Workdir::new(JOB);
    fs::create_dir_all(workdir.path("out/dexels.csv")).unwrap();
    let output = workdir.run_job("simulate", &[]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("dexels.csv"));
    assert_eq!(
        workdir.written(),
        ["dexels.csv"],
        "nothing else, and nothing half-written"
    );
}

/// The system would end the process, without a word.
#[cfg(target_os = "linux")]
#[test]
fn a_grid_that_does_not_fit_into_memory_is_refused() {
    let workdir = Workdir::new("Job(stock: Block(min: (0, 0, 0), max: (1, 1, 1)), tools: {}, paths: [])");
    let limited = |command: &str| {
        let script = format!("ulimit -v 4000000; exec {} {command}", env!("CARGO_BIN_EXE_sweepsim"));
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", &script]).current_dir(workdir.path(""));
        let output = shell.output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let error = limited("simulate job.ron --cells 60000x60000");
    let message = "a grid of 60000 x 60000 dexels takes at least 86.4 GB, but ";
    assert!(
        error.contains(message) && error.contains("or a run in parts (--shard)"),
        "{error}"
    );
    let mesh = "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    fs::write(workdir.path("a.stl"), mesh).unwrap();
    let error = limited("convert a.stl a.dexels --cells 60000x60000");
    assert!(
        error.contains(message) && error.contains("expected fewer cells"),
        "{error}"
    );
}

#[test]
fn only_verify_writes_certificates() {
    let workdir = Workdir::new(JOB);
    for more in [
        &["simulate", "job.ron"][..],
        &["sweep", "job.ron"],
        &["simulate", "job.ron", "--shard", "0/2"],
    ] {
        let message = workdir.bad(&[more, &["--only", "dexels,certificate", "--out", "out"]].concat());
        assert!(
            message.contains("--only certificate: expected dexels, mesh, picture") && message.contains("`verify`"),
            "{message}"
        );
        assert!(workdir.written().is_empty());
    }
}
