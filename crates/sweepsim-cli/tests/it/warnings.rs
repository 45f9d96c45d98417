//! Warnings: what is odd about a job is said, once, and nothing is said of a job that is right.

use crate::support::{Workdir, text};
use std::fs;

/// A job of which nothing is to be said.
const JOB: &str = r#"Job(
    tolerance: 1e-6,
    grid: Grid(min: (0, 0), max: (20, 10), cells: (40, 20)),
    stock: Block(min: (0, 0, 0), max: (20, 10, 6)),
    tools: { 1: Ball(radius: 2, length: 30) },
    paths: [
        Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0.5, 0, 1))]),
    ],
)"#;

const PATH: &str = "Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0.5, 0, 1))]),";
const TOOL: &str = "Ball(radius: 2, length: 30)";
const STOCK: &str = "Block(min: (0, 0, 0), max: (20, 10, 6))";

/// The warnings in the report of a command on the job with one part replaced by another.
fn warnings(command: &str, part: &str, by: &str) -> Vec<String> {
    assert!(JOB.contains(part), "{part}");
    let workdir = Workdir::new(&JOB.replace(part, by));
    in_report(&workdir, command, &[])
}

fn in_report(workdir: &Workdir, command: &str, more: &[&str]) -> Vec<String> {
    let output = workdir.run_job(command, &[&["--only", "report"], more].concat());
    assert_ne!(output.status.code(), Some(2), "{}", text(&output.stderr));
    let report = fs::read(workdir.path("out/report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    let list: Vec<String> = serde_json::from_value(report["warnings"].clone()).expect("a list");
    // The summary says the same.
    let summary = text(&output.stdout);
    for warning in &list {
        assert!(summary.contains(&format!("   warning  {warning}\n")), "{summary}");
    }
    assert_eq!(summary.matches("   warning  ").count(), list.len(), "{summary}");
    list
}

#[track_caller]
fn assert_one(found: &[String], words: &[&str]) {
    let [one] = found else { panic!("{found:?}") };
    for word in words {
        assert!(one.contains(word), "{word:?} in {one}");
    }
}

#[test]
fn a_job_that_is_right_gets_no_warning() {
    for command in ["simulate", "sweep", "verify"] {
        assert_eq!(warnings(command, "", ""), [""; 0], "{command}");
    }
    // The fixtures of the documentation.
    let fixtures = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/jobs/quickstart.ron");
    let workdir = Workdir::new(JOB);
    let out = workdir.good(&[
        "simulate", fixtures, "--out", "out", "--only", "report", "--cells", "60x50",
    ]);
    assert!(!out.contains("warning"), "{out}");
}

#[test]
fn stock_beside_the_grid() {
    let wide = "Block(min: (-90, 0, 0), max: (110, 10, 6))";
    for command in ["simulate", "verify"] {
        let words = ["neither cut nor measured", "in x", "−90 … 110", "0 … 20"];
        assert_one(&warnings(command, STOCK, wide), &words);
    }
    assert_eq!(warnings("sweep", STOCK, wide), [""; 0]);
    let workdir = Workdir::new(&JOB.replace(STOCK, wide));
    let summary = workdir.good(&["simulate", "job.ron", "--out", "out", "--only", "report"]);
    assert!(summary.contains("% of the stock on the grid"), "{summary}");
    for (solid, cause) in [
        ("Cylinder(base: (10, 5, 0), radius: 6, height: 6)", "in y"),
        ("Ball(centre: (10, 5, 0), radius: 5.1)", "in y"),
        (
            "Union([Block(min: (0, 0, 0), max: (20, 10, 6)), Block(min: (0, 0, 0), max: (20.1, 10, 6))])",
            "in x",
        ),
    ] {
        assert_one(&warnings("simulate", STOCK, solid), &["neither cut", cause]);
    }
    // What touches the border is inside.
    assert_eq!(
        warnings("simulate", STOCK, "Ball(centre: (10, 5, 3), radius: 5)"),
        [""; 0]
    );
    let beside = warnings("simulate", STOCK, "Block(min: (30, 0, 0), max: (40, 10, 6))");
    assert!(beside[0].contains("none of the stock is on the grid"), "{beside:?}");
}

#[test]
fn stock_in_the_frame_of_the_grid() {
    // A quarter turn about z: x of the frame is y of the world.
    let grid = "grid: Grid(min: (0, 0), max: (20, 10), cells: (40, 20)),";
    let turned = "grid: Grid(min: (0, -20), max: (10, 0), cells: (20, 40), frame: Frame(z: (0, 0, 1), x: (0, 1, 0))),";
    assert_eq!(warnings("simulate", grid, turned), [""; 0]);
    let short = turned.replace("(10, 0)", "(9, 0)");
    assert_one(&warnings("simulate", grid, &short), &["in x", "0 … 10", "0 … 9"]);
}

#[test]
fn paths_that_do_nothing() {
    let above = format!("{PATH} Path(tool: 1, poses: [((0, 5, 9), (0, 0, 1)), ((20, 5, 9), (0, 0, 1))]),");
    assert_one(
        &warnings("simulate", PATH, &above),
        &["1 path", "misses the stock by 2.", "path 1 of the job"],
    );
    // Judged, paths have volumes: this one touches the box of the stock only.
    let beside = format!("{PATH} Path(tool: 1, poses: [((0, 5, 3.5), (0, 0, 1)), ((20, 5, 3.5), (0, 0, 1))]),");
    assert_one(
        &warnings("verify", PATH, &beside),
        &["1 path", "removes nothing", "path 1 of the job"],
    );
    let still = format!("{PATH} Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1))]),");
    assert_one(
        &warnings("simulate", PATH, &still),
        &["1 path of a single pose removes only", "path 1"],
    );
    let only = "Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1))]),";
    assert_one(&warnings("simulate", PATH, only), &["moves nothing"]);
    let missed = "Path(tool: 1, poses: [((0, 5, 9), (0, 0, 1)), ((20, 5, 9), (0, 0, 1))]),";
    let found = warnings("simulate", PATH, missed);
    assert!(
        found
            .iter()
            .any(|warning| warning == "nothing was removed from the stock"),
        "{found:?}"
    );
}

#[test]
fn cells_and_tolerances_that_are_too_coarse() {
    assert_one(
        &warnings("simulate", "tolerance: 1e-6", "tolerance: 0.6"),
        &["tolerance of 0.6 mm", "0.5 mm"],
    );
    let thin = TOOL.replace("radius: 2", "radius: 0.4");
    for command in ["simulate", "sweep", "verify"] {
        assert_one(
            &warnings(command, TOOL, &thin),
            &["tool 1", "0.5 mm", "0.8 mm wide", "at most 0.4 mm"],
        );
    }
    // An engraver of 60°, 0.3 mm deep: 0.35 mm wide.
    let engraver = "Profile(start: (0, 0), segments: [Line((2, 3.4641016151)), Line((2, 30)), Line((0, 30))])";
    let shallow = "Path(tool: 1, poses: [((-4, 5, 5.7), (0, 0, 1)), ((24, 5, 5.7), (0, 0, 1))]),";
    let job = JOB.replace(TOOL, engraver).replace(PATH, shallow);
    let workdir = Workdir::new(&job);
    let found = in_report(&workdir, "simulate", &[]);
    // It runs between two rows of dexels.
    assert_eq!(
        found.last().map(String::as_str),
        Some("nothing was removed from the stock")
    );
    assert_one(&found[..1], &["tool 1", "0.3464", "at most 0.1732"]);
    assert_eq!(in_report(&workdir, "simulate", &["--cells", "120x60"]), [""; 0]);
}

#[test]
fn a_tool_shorter_than_its_cut_is_deep_leaves_a_roof() {
    // From −4 to 24 in x, between z = 3 and z = 5, with a millimetre above it.
    let level = "Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0, 0, 1))]),";
    let job = JOB.replace(PATH, level).replace(TOOL, "Flat(radius: 2, length: 2)");
    for command in ["simulate", "verify"] {
        let found = in_report(&Workdir::new(&job), command, &[]);
        assert_one(&found, &["tool 1 is 2 mm long", "path 0", "a roof of 80 mm²", "bodies"]);
    }
    // Just long enough.
    let long = job.replace("length: 2", "length: 3");
    assert_eq!(in_report(&Workdir::new(&long), "simulate", &[]), [""; 0]);
    // An undercut is no roof.
    let dovetail = job.replace(
        "Flat(radius: 2, length: 2)",
        "Dovetail(radius: 3, angle: 60, height: 2, neck: 1, length: 9)",
    );
    assert_eq!(in_report(&Workdir::new(&dovetail), "simulate", &[]), [""; 0]);
    // Leaning, in several moves.
    let leaning =
        "Path(tool: 1, poses: [((-4, 5, 1), (0.2, 0, 1)), ((9, 5, 1), (0.2, 0, 1)), ((24, 5, 1), (0.2, 0, 1))]),";
    let found = in_report(&Workdir::new(&job.replace(level, leaning)), "simulate", &[]);
    assert_one(&found, &["tool 1 is 2 mm long", "roof"]);
}

#[test]
fn fields_without_effect() {
    let more =
        "bodies: { 1: [Holder(Flat(radius: 1, length: 30))] },\n limits: Limits(gouge: 0.1, excess: 0.1),\n paths";
    let found = warnings("simulate", "paths", more);
    assert_one(
        &found,
        &["`simulate` does not look at `limits` and `bodies`", "`verify` does"],
    );
    assert_one(
        &warnings(
            "sweep",
            "paths",
            "fixtures: [Ball(centre: (0, 0, 0), radius: 1)], paths",
        ),
        &["`fixtures`"],
    );
    let limits = "limits: Limits(gouge: 0.1, excess: 0.1),\n paths";
    assert_one(&warnings("verify", "paths", limits), &["`limits` without a `target`"]);
    let second = format!("{TOOL}, 7: Flat(radius: 3, length: 30)");
    assert_one(&warnings("simulate", TOOL, &second), &["no path uses tool 7"]);
}

#[test]
fn numbers_of_tools_that_disagree() {
    let program = "(T5 D=6. CR=0. - ZMIN=1 - flat end mill)\nG21 G90\nT5 M6\nS900 M3\nG0 X-4 Y5 Z3\nG1 X24 F100\nM30\n";
    let notes = |job: &str| {
        let workdir = Workdir::new(job);
        fs::write(workdir.path("part.nc"), program).expect("a file");
        workdir.good(&["simulate", "job.ron", "--out", "out", "--only", "report"])
    };
    let other = notes(&JOB.replace(PATH, r#"Path(tool: 1, file: "part.nc"),"#));
    assert!(
        other.contains("the program asks for tool 5; the job's tool 1 is used throughout"),
        "{other}"
    );
    let own = JOB
        .replace(PATH, r#"Path(file: "part.nc"),"#)
        .replace("1: Ball", "5: Ball");
    let wider = notes(&own);
    assert!(
        wider.contains("tool 5 is 4.0000 mm wide in the job and 6.0000 mm in part.nc: the job's is used"),
        "{wider}"
    );
    let same = notes(&own.replace("radius: 2", "radius: 3"));
    assert!(!same.contains("mm wide in the job"), "{same}");
}

#[test]
fn empty_sections() {
    let workdir = Workdir::new(JOB);
    let found = workdir.good(&["section", "job.ron", "--plane", "z=-5", "--out", "out"]);
    assert!(found.contains("the section is empty: the plane lies at −5"), "{found}");
    let met = workdir.good(&["section", "job.ron", "--plane", "z=4", "--out", "out"]);
    assert!(!met.contains("warning"), "{met}");
    // A section of the picture is left out, and nothing is lost.
    let picture = workdir.good(&[
        "simulate",
        "job.ron",
        "--out",
        "out",
        "--section",
        "z=50",
        "--size",
        "80x60",
    ]);
    assert!(picture.contains("--section z=50 does not meet the part"), "{picture}");
    assert!(workdir.path("out/report.json").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn full_disks_have_their_own_words() {
    let full = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .expect("Linux has it");
    let workdir = Workdir::new(JOB);
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_sweepsim"))
        .args(["inspect", "job.ron"])
        .current_dir(workdir.path(""))
        .stdout(full)
        .output()
        .expect("the command starts");
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(
        message.contains("cannot write to standard output: the disk is full"),
        "{message}"
    );
}

#[cfg(unix)]
#[test]
fn signals_end_a_run_with_130() {
    use std::process::{Command, Stdio};
    // Far more than a second of work.
    let job = JOB.replace("cells: (40, 20)", "cells: (4000, 2000)");
    for signal in ["INT", "TERM", "HUP"] {
        let workdir = Workdir::new(&job);
        let mut child = Command::new(env!("CARGO_BIN_EXE_sweepsim"))
            .args(["simulate", "job.ron", "--out", "out", "--size", "4000x4000"])
            .current_dir(workdir.path(""))
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .expect("the command starts");
        // The handler is set before the output folder is there.
        while !workdir.path("out").exists() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
        let id = child.id().to_string();
        let sent = Command::new("kill").args(["-s", signal, &id]).status().expect("kill");
        assert!(sent.success());
        let mut words = String::new();
        std::io::Read::read_to_string(&mut child.stderr.take().expect("piped"), &mut words).expect("text");
        assert_eq!(child.wait().expect("it ends").code(), Some(130), "{signal}: {words}");
        assert!(words.starts_with("interrupted: "), "{words}");
        // Whole files or none.
        for name in workdir.written() {
            assert!(!name.ends_with(".part"), "{name}");
        }
    }
}

/// Interrupts a run once one of its files is there, 300 ms later: it ends within moments, with that file alone.
#[cfg(unix)]
fn interrupt(job: &str, options: &str, first: &str) {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let workdir = Workdir::new(job);
    let mut child = Command::new(env!("CARGO_BIN_EXE_sweepsim"))
        .args(["simulate", "job.ron", "--out", "out"])
        .args(options.split(' '))
        .current_dir(workdir.path(""))
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .expect("the command starts");
    while !workdir.path(&format!("out/{first}")).exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(300));
    let start = Instant::now();
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-s", "INT", &id]).status().expect("kill");
    assert!(sent.success());
    let mut words = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().expect("piped"), &mut words).expect("text");
    assert_eq!(child.wait().expect("it ends").code(), Some(130), "{words}");
    let complete = format!("interrupted: {first} is complete, nothing else was written");
    assert_eq!(words.trim_end(), complete);
    assert!(start.elapsed() < Duration::from_secs(2), "{:?}", start.elapsed());
    assert_eq!(workdir.written(), [first]);
}

/// The sweep takes a moment, the picture a minute or so.
#[cfg(unix)]
#[test]
fn a_picture_ends_with_the_run() {
    interrupt(
        JOB,
        "--size 8000x6000 --only dexels,picture --directions z",
        "dexels.csv",
    );
}

/// The surface of dexels along three axes takes ten seconds or so.
#[cfg(unix)]
#[test]
fn a_surface_ends_with_the_run() {
    let job = JOB.replace("cells: (40, 20)", "cells: (600, 300)");
    interrupt(&job, "--only binary,mesh", "part.dexels");
}

/// Whatever waits or computes outside of a run ends, too.
#[cfg(unix)]
#[test]
fn waiting_for_input_ends_with_130() {
    use std::process::{Command, Stdio};
    let workdir = Workdir::new(JOB);
    let made = Command::new("mkfifo").arg(workdir.path("pipe.nc")).status();
    assert!(made.expect("mkfifo").success());
    let child = Command::new(env!("CARGO_BIN_EXE_sweepsim"))
        .args(["inspect", "pipe.nc"])
        .current_dir(workdir.path(""))
        .stderr(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the command starts");
    std::thread::sleep(std::time::Duration::from_millis(500));
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-s", "INT", &id]).status().expect("kill");
    assert!(sent.success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(text(&output.stderr).trim_end(), "interrupted: nothing was written");
    assert_eq!(text(&output.stdout), "");
}
