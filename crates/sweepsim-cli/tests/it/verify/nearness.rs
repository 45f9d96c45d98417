//! What only comes near, and rapids that may take two courses.

use super::verified;
use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::Report;

#[test]
fn rapids_go_as_the_machine_makes_them() {
    // From (-20, -20) to (20, 0): straight past a post at (0, 0), or first along the diagonal into it.
    let machine =
        "Machine(name: \"mill\", linear: [(letter: 'X', speed: 6000), (letter: 'Y', speed: 6000)], rapid: DogLeg)";
    let program = "G21 G90 G17\nT1 M6\nS900 M3\nG0 X-20 Y-20 Z5\nX20 Y0\nM30\n";
    let job = r#"Job(
        grid: Grid(min: (-30, -30), max: (30, 30), cells: (60, 60)),
        stock: Block(min: (-30, -30, -10), max: (30, 30, 0)),
        tools: { 1: Flat(radius: 2, length: 30) },
        fixtures: [Cylinder(base: (-5, -5, 0), axis: (0, 0, 1), radius: 1, height: 20)],
        paths: [Path(file: "part.nc", machine: "mill.ron", controller: "fanuc")],
    )"#;
    let workdir = Workdir::new(job);
    fs::write(workdir.path("mill.ron"), machine).expect("a file");
    fs::write(workdir.path("part.nc"), program).expect("a file");
    let run = || {
        let output = workdir.run_job("verify", &["--only", "report"]);
        (output.status.code(), text(&output.stdout))
    };
    let (code, summary) = run();
    assert_eq!(code, Some(1), "{summary}");
    assert!(summary.contains("part.nc:5: cutter of tool 1"), "{summary}");
    assert!(summary.contains("| X20 Y0"), "{summary}");
    fs::write(workdir.path("mill.ron"), machine.replace("DogLeg", "Straight")).expect("a file");
    let (code, summary) = run();
    assert_eq!(code, Some(0), "{summary}");
    // A machine that does not say which: the dog-leg collides.
    let silent = machine.replace(", rapid: DogLeg", "");
    fs::write(workdir.path("mill.ron"), silent).expect("a file");
    let (code, summary) = run();
    assert_eq!(code, Some(1), "{summary}");
    assert!(summary.contains("part.nc:5: cutter of tool 1"), "{summary}");
    assert!(summary.contains("if the rapid is a dog-leg"), "{summary}");
    // No machine at all, and a post on both courses, on the straight one, and on neither.
    for (post, said) in [
        ("(-20, -20, 0)", Some("both")),
        ("(0, -10, 0)", Some("straight")),
        ("(-5, -5, 0)", Some("dog-leg")),
        ("(10, 10, 0)", None),
    ] {
        let job = job.replace("machine: \"mill.ron\", ", "").replace("(-5, -5, 0)", post);
        fs::write(workdir.path("job.ron"), job).expect("a file");
        let output = workdir.run_job("verify", &["--only", "report"]);
        let report = fs::read(workdir.path("out/report.json")).expect("a report");
        let report: Report = serde_json::from_slice(&report).expect("a report");
        let findings = report.findings.expect("findings");
        let courses: Vec<Option<&str>> = findings.iter().map(|finding| finding.courses.as_deref()).collect();
        let expected: Vec<Option<&str>> = said.map(Some).into_iter().collect();
        assert_eq!(courses, expected, "{post}: {}", text(&output.stdout));
        assert!(
            findings
                .iter()
                .all(|f| f.kind == "fixture" && f.line == Some(5) && !f.near)
        );
    }
}

/// Half a diagonal of cells of 0.5 mm is 0.354 mm.
#[test]
fn cutters_are_taken_larger_to_be_sure() {
    let job = r#"Job(
        grid: Grid(min: (-20, -20), max: (20, 20), cells: (80, 80)),
        stock: Union([Block(min: (-20, -20, -10), max: (20, 20, 0)), Block(min: (-20, 2.2, -10), max: (20, 20, 3))]),
        tools: { 1: Flat(radius: 2, length: 30) },
        fixtures: [CLAMP],
        paths: [Path(file: "part.nc", controller: "fanuc")],
    )"#;
    // A slot and a withdrawal from it; a rapid beside a step at y = 2.2.
    let slot = "G21 G90 G17\nT1 M6\nS900 M3\nG0 X-10 Y-10 Z5\nG1 Z-3 F300\nX10\nG0 Z5\nM30\n";
    let beside = "G21 G90 G17\nT1 M6\nS900 M3\nG0 X-10 Y0 Z5\nZ1\nX10\nM30\n";
    let far = "Block(min: (30, 0, 0), max: (31, 1, 1))";
    let workdir = Workdir::new(job);
    for (program, clamp, expected) in [
        (slot, far, &[][..]),
        (beside, far, &[("rapid", 5), ("rapid", 6)][..]),
        // 0.1 mm beside the slot's end; the clamp's first lines are 0.24 mm inside.
        (
            slot,
            "Block(min: (12.1, -11, 0), max: (14, -9, 1))",
            &[("fixture", 6), ("fixture", 7)],
        ),
        (slot, "Block(min: (12.4, -11, 0), max: (14, -9, 1))", &[]),
    ] {
        fs::write(workdir.path("part.nc"), program).expect("a file");
        fs::write(workdir.path("job.ron"), job.replace("CLAMP", clamp)).expect("a file");
        let (_, findings) = verified(&workdir, 0, &[]);
        assert_eq!(findings, []);
        let (_, findings) = verified(&workdir, i32::from(!expected.is_empty()), &["--sure"]);
        let found: Vec<(&str, usize)> = findings.iter().map(|f| (f.kind.as_str(), f.line.unwrap())).collect();
        assert_eq!(found, expected, "{program} {clamp} {findings:#?}");
        assert!(findings.iter().all(|finding| finding.near));
    }
}

#[test]
fn clearances_of_holders() {
    // The holder's end, of radius 10, is 4 mm above the block, and 2 mm beside a wall of 20 mm at y = 12.
    let job = r#"Job(
        grid: Grid(min: (-20, -20), max: (20, 20), cells: (80, 80)),
        stock: Union([Block(min: (-20, -20, -10), max: (20, 20, 0)), Block(min: (-20, 12, -10), max: (20, 20, 20))]),
        tools: { 1: Flat(radius: 2, length: 5) },
        bodies: { 1: [Holder(Profile(start: (0, 5), segments: [Line((10, 5)), Line((10, 30)), Line((0, 30))]))] },
        paths: [Path(tool: 1, poses: [((-8, 0, -1), (0, 0, 1)), ((8, 0, -1), (0, 0, 1))])],
    )"#;
    let workdir = Workdir::new(job);
    let run = |more: &[&str]| {
        let output = workdir.run_job("verify", &[&["--only", "report"], more].concat());
        (output.status.code(), text(&output.stdout))
    };
    for (more, code) in [
        (&[][..], 0),
        (&["--clearance", "1.9"], 0),
        (&["--clearance", "2.3"], 1),
        (&["--sure"], 0),
        // Half a diagonal of cells of 0.5 mm is 0.354 mm.
        (&["--sure", "--clearance", "1.5"], 0),
        (&["--sure", "--clearance", "1.95"], 1),
    ] {
        let (found, summary) = run(more);
        assert_eq!(found, Some(code), "{more:?}: {summary}");
        let near = summary.contains("FAIL: 1 move nearer than it should be");
        assert_eq!(near, code == 1, "{more:?}: {summary}");
        assert_eq!(summary.contains("too near at"), code == 1, "{more:?}: {summary}");
    }
    let (_, summary) = run(&["--sure", "--clearance", "1.5"]);
    assert!(
        summary.contains("by 1.5 mm for their clearance and 0.35355 mm for what may hide between dexels"),
        "{summary}"
    );
    // A holder that does touch says so, with the depth of what it touches and not of its clearance.
    fs::write(workdir.path("job.ron"), job.replace("((8, 0, -1)", "((8, 3, -1)")).expect("a file");
    for more in [&[][..], &["--clearance", "2.3"], &["--sure"]] {
        let (code, summary) = run(more);
        assert_eq!(code, Some(1));
        assert!(
            summary.contains("FAIL: 1 collision") && summary.contains("16.000 mm deep"),
            "{summary}"
        );
    }
    // In the job.
    let own = job.replace("Job(", "Job( clearance: 2.3,");
    fs::write(workdir.path("job.ron"), own).expect("a file");
    assert_eq!(run(&[]).0, Some(1));
    fs::write(workdir.path("job.ron"), job.replace("Job(", "Job( clearance: -1,")).expect("a file");
    let bad = workdir.bad(&["verify", "job.ron", "--out", "out"]);
    assert!(bad.contains("clearance is -1, but must be 0 or greater"), "{bad}");
}

/// A rapid that turns a table is divided into chords: what happens on any of them does so if the rapid is straight.
#[test]
fn all_chords_of_a_rapid_may_be_on_another_course() {
    // The radius of the tip goes from 50 to 10 mm while the table turns, or within 14 degrees.
    let job = r#"Job(
        grid: Grid(min: (-60, -60), max: (60, 60), cells: (60, 60)),
        stock: Block(min: (-60, -60, -10), max: (60, 60, 0)),
        tools: { 1: Flat(radius: 2, length: 30) },
        fixtures: [Cylinder(base: (21.2, 21.2, 0), axis: (0, 0, 1), radius: 1, height: 20),
            Cylinder(base: (21.2, -21.2, 0), axis: (0, 0, 1), radius: 1, height: 20)],
        paths: [Path(file: "part.nc", machine: "mill.ron")],
    )"#;
    let machine = "Machine(name: \"mill\", linear: [(letter: 'X', speed: 10000)], \
                   table: [(letter: 'C', axis: (0, 0, 1), speed: 3600)])";
    let workdir = Workdir::new(job);
    fs::write(workdir.path("mill.ron"), machine).expect("a file");
    fs::write(
        workdir.path("part.nc"),
        "G21 G90\nT1 M6\nS900 M3\nG0 X50 Y0 Z5\nX10 C90\nM30\n",
    )
    .expect("a file");
    let output = workdir.run_job("verify", &["--no-proof", "--only", "report"]);
    let report = fs::read(workdir.path("out/report.json")).expect("a report");
    let report: Report = serde_json::from_slice(&report).expect("a report");
    let findings = report.findings.expect("findings");
    assert!(!findings.is_empty(), "{}", text(&output.stdout));
    for finding in &findings {
        assert_eq!(finding.courses.as_deref(), Some("straight"), "{}", text(&output.stdout));
    }
}
