//! `verify`: verdicts, findings with their lines, exit status.

mod bracket;
mod certificates;
mod directions;
mod nearness;
mod planted;
mod shapes;

use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::{ComparisonReport, Report, ReportedFinding, Verdict};

/// A slot 5 mm deep, in two passes, and a hole.
const PROGRAM: &str = "G21 G90 G17
T1 M6
S8000 M3
G0 X-20 Y0 Z10
G0 Z5.5
G1 X20 F400
Z3
X-20
G0 Z20
M30
";

fn job(fixture: &str, reach: f64, limits: &str) -> String {
    format!(
        "Job(
    grid: Grid(min: (-15, -15), max: (15, 15), cells: (60, 60)),
    stock: Block(min: (-15, -15, 0), max: (15, 15, 8)),
    tools: {{ 1: Flat(radius: 3, length: 12) }},
    bodies: {{ 1: [Holder(Profile(start: (0, {reach}), segments: [Line((10, {reach})), Line((10, 60)), Line((0, 60))]))] }},
    fixtures: [{fixture}],
    paths: [Path(file: \"part.nc\")],
    target: Mesh(\"part.ply\"),
    limits: {limits},
)"
    )
}

const CLAMP: &str = "Block(min: (-15, 14, 0), max: (15, 20, 9))";
const LIMITS: &str = "Limits(gouge: 0.02, excess: 0.05)";

/// A folder with the program, and the part that it makes as the target.
fn workdir(job: &str) -> Workdir {
    let folder = Workdir::new(&self::job("", 12.0, LIMITS).replace("    target: Mesh(\"part.ply\"),\n", ""));
    fs::write(folder.path("part.nc"), PROGRAM).unwrap();
    folder.good(&["simulate", "job.ron", "--only", "mesh", "--out", "."]);
    fs::write(folder.path("job.ron"), job).unwrap();
    folder
}

pub fn verified(folder: &Workdir, code: i32, more: &[&str]) -> (Report, Vec<ReportedFinding>) {
    let output = folder.run_job("verify", &[&["--only", "report"], more].concat());
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    let report: Report = serde_json::from_slice(&fs::read(folder.path("out/report.json")).unwrap()).unwrap();
    let findings = report.findings.clone().unwrap();
    (report, findings)
}

#[test]
fn a_good_program_passes() {
    let folder = workdir(&job(CLAMP, 12.0, LIMITS));
    let (report, findings) = verified(&folder, 0, &[]);
    assert_eq!((report.verdict, findings), (Some(Verdict::Pass), Vec::new()));
    // The target is a mesh of the same part: flat faces agree.
    assert!(report.gouge.unwrap().max < 0.02 && report.excess.unwrap().max < 0.02);
    let output = folder.run_job("verify", &["--only", "report"]);
    assert!(
        text(&output.stdout).contains("verdict  PASS"),
        "{}",
        text(&output.stdout)
    );
}

#[test]
fn faults_are_named_by_their_lines() {
    // The second pass too low by a digit, and back to the start by a rapid through the block.
    let folder = workdir(&job(CLAMP, 12.0, LIMITS));
    let wrong = PROGRAM.replace("\nZ3\nX-20\n", "\nZ2\nX-20\nG0 X20 Y7\n");
    fs::write(folder.path("part.nc"), wrong).unwrap();
    let (report, findings) = verified(&folder, 1, &[]);
    assert_eq!(report.verdict, Some(Verdict::Fail));
    let kinds: Vec<(&str, Option<usize>)> = findings.iter().map(|f| (f.kind.as_str(), f.line)).collect();
    assert_eq!(
        kinds,
        [("gouge", Some(8)), ("gouge", Some(9)), ("rapid", Some(9))],
        "{findings:?}"
    );
    let gouge = &findings[0];
    assert_eq!(
        (gouge.file.as_deref(), gouge.text.as_deref()),
        (Some("part.nc"), Some("X-20"))
    );
    assert_eq!((gouge.tool, &gouge.body), (Some(1), &None));
    assert!((gouge.depth - 1.0).abs() < 0.01, "{gouge:?}");
    assert!(gouge.time.unwrap() > 0.0 && gouge.time.unwrap() < 0.1);
    let regions = report.regions.unwrap();
    assert!(regions.iter().all(|region| region.kind == "gouge") && !regions.is_empty());
    let (_, first) = verified(&folder, 1, &["--first"]);
    assert_eq!(first.len(), 1);
}

/// Times and lengths were those of the whole program, and paths that were not followed removed nothing.
#[test]
fn what_comes_after_the_first_finding_counts_nowhere() {
    let paths = |ends: [f64; 2]| {
        ends.map(|y| {
            format!(
                "Path(tool: 1, feed: 600, moves: [Start(((-9, {y}, -1), (0, 0, 1))), Line(((69, {y}, -1), (0, 0, 1))), Line(((69, {y}, -2), (0, 0, 1))), Line(((-9, {y}, -2), (0, 0, 1)))])"
            )
        })
        .join(", ")
    };
    let job = format!(
        "Job(grid: Grid(cells: (60, 40)), stock: Block(min: (0, 0, -10), max: (60, 40, 0)), tools: {{ 1: Flat(radius: 4, length: 30) }}, paths: [{}], fixtures: [Block(min: (-2, 12, -10), max: (-1, 15, 5))])",
        paths([10.0, 30.0])
    );
    let folder = workdir(&job);
    let (report, _) = verified(&folder, 1, &["--first"]);
    let work = report.work.unwrap();
    assert!(
        (work.length - 78.0).abs() < 1e-9 && (work.seconds - 7.8).abs() < 1e-9,
        "{work:?}"
    );
    // On 8 lines, 1 mm deep.
    assert!((work.removed - 480.0).abs() < 1e-3, "{work:?}");
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    let one = job.replace(
        "paths: [Path(",
        "paths: [Path(tool: 1, poses: [((0, 0, 90), (0, 0, 1)), ((0, 0, 99), (0, 0, 1))]), Path(",
    );
    fs::write(folder.path("job.ron"), one).unwrap();
    let words = folder.run_job("verify", &["--first", "--moves", "--only", "report"]);
    let words = text(&words.stdout);
    assert!(words.contains("1 feed move that removes nothing"), "{words}");
}

#[test]
fn holders_and_clamps() {
    // A holder that reaches down to 4.5 mm above the tip meets the block's top in the second pass, 5 mm deep.
    let folder = workdir(&job("", 4.5, LIMITS));
    let (_, findings) = verified(&folder, 1, &["--no-proof"]);
    let found: Vec<_> = findings
        .iter()
        .map(|f| (f.kind.as_str(), f.line, f.body.as_deref()))
        .collect();
    assert!(found.contains(&("collision", Some(8), Some("holder"))), "{found:?}");
    assert!(
        found
            .iter()
            .all(|(kind, line, _)| *kind == "collision" && *line >= Some(7)),
        "{found:?}"
    );
    // A clamp in the way of the cutter, beside the grid.
    let folder = workdir(&job("Block(min: (16, -2, 0), max: (18, 2, 7))", 12.0, LIMITS));
    let (_, findings) = verified(&folder, 1, &[]);
    assert!(findings.iter().all(|f| f.kind == "fixture"), "{findings:?}");
    let lines: Vec<usize> = findings.iter().filter_map(|f| f.line).collect();
    assert_eq!(lines, [6, 7, 8]);
}

#[test]
fn too_little_is_found_as_well() {
    let folder = workdir(&job("", 12.0, LIMITS));
    fs::write(folder.path("part.nc"), PROGRAM.replace("\nZ3\n", "\nZ3.2\n")).unwrap();
    let (report, findings) = verified(&folder, 1, &[]);
    let [excess] = &findings[..] else {
        panic!("{findings:?}")
    };
    assert_eq!((excess.kind.as_str(), excess.line), ("excess", None));
    assert!((excess.depth - 0.2).abs() < 1e-3 && (report.excess.unwrap().max - 0.2).abs() < 1e-3);
}

#[test]
fn cuts_with_a_stopped_spindle_or_without_a_feed() {
    let folder = workdir(&job("", 12.0, LIMITS));
    let lines = |program: String| -> Vec<(String, Option<usize>)> {
        fs::write(folder.path("part.nc"), program).unwrap();
        let (_, findings) = verified(&folder, 1, &[]);
        findings.into_iter().map(|f| (f.kind, f.line)).collect()
    };
    let spindle = |line| ("spindle".to_owned(), Some(line));
    // Stopped after the first pass.
    assert_eq!(lines(PROGRAM.replace("\nZ3\n", "\nZ3 M5\n")), [spindle(8)]);
    // It starts too late: when it has cut already.
    let late = PROGRAM.replace("S8000 M3\n", "").replace("\nZ3\n", "\nZ3 S8000 M3\n");
    assert_eq!(lines(late), [spindle(5)]);
    // A program that never mentions it does not control it.
    let silent = PROGRAM.replace("S8000 M3\n", "");
    fs::write(folder.path("part.nc"), silent).unwrap();
    assert_eq!(verified(&folder, 0, &[]).1, []);
}

#[test]
fn what_each_move_does() {
    let folder = workdir(&job("", 12.0, LIMITS));
    let (report, _) = verified(&folder, 0, &["--moves"]);
    let work = report.work.unwrap();
    // 40 + 2.5 + 40 mm at 400 mm/min; 4.5 + 17 mm at the assumed 10 m/min.
    assert!((work.seconds - 82.5 / 400.0 * 60.0).abs() < 1e-9, "{work:?}");
    assert!((work.rapid_seconds - 21.5 / 10_000.0 * 60.0).abs() < 1e-9, "{work:?}");
    assert_eq!(
        (work.length, work.rapid_length, work.moves, work.rapid_moves),
        (82.5, 21.5, 5, 2)
    );
    assert_eq!((work.untimed, work.idle_moves), (0, Some(1)));
    assert!((work.removed - report.volume_removed.unwrap()).abs() < 1e-6, "{work:?}");
    assert!((work.rate.unwrap() - work.removed / work.seconds * 60.0).abs() < 1e-9);
    let tools = report.tools.unwrap();
    assert_eq!((tools.len(), tools[0].tool, tools[0].work), (1, 1, work));
    let text = fs::read_to_string(folder.path("out/moves.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        rows[0].join(","),
        "path,move,file,line,tool,rapid,seconds,length,removed,depth,width,rate"
    );
    assert!(!text.contains(",-0"), "{text}");
    let lines: Vec<&str> = rows[1..].iter().map(|row| row[3]).collect();
    assert_eq!(lines, ["5", "6", "7", "8", "9"]);
    // The first pass: 2.5 deep, and 6 wide but for half a cell on both sides.
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    assert!(
        (number(2, 9) - 2.5).abs() < 1e-6 && (number(2, 10) - 5.5).abs() < 1e-6,
        "{text}"
    );
    assert!(
        (number(2, 11) - number(2, 8) * 10.0).abs() < 1e-6,
        "six seconds: {text}"
    );
    let total: f64 = (1..rows.len()).map(|row| number(row, 8)).sum();
    assert!((total - work.removed).abs() < 1e-6, "{total}");
}

#[test]
fn axes_beyond_their_limits_are_findings() {
    let machine = "Machine(name: \"mill\", linear: [(letter: 'X', limits: (-40, 40), speed: 600), (letter: 'Z', limits: (-50, 200))], tool_length: 50)";
    // X reaches 45 in the middle of the half circle.
    let program = "G21 G90 G17\nT1 M6\nS900 M3\nG0 X0 Y-20 Z20\nG1 X25 F500\nG3 X25 Y20 R20\nG1 X0\nF2000 X-30\nM30\n";
    let job = r#"Job(
        grid: Grid(min: (-50, -50), max: (50, 50), cells: (20, 20)),
        stock: Block(min: (-50, -50, -10), max: (50, 50, 0)),
        tools: { 1: Ball(radius: 2, length: 30) },
        paths: [Path(file: "part.nc", machine: "mill.ron", controller: "fanuc")],
    )"#;
    let workdir = Workdir::new(job);
    fs::write(workdir.path("mill.ron"), machine).expect("a file");
    fs::write(workdir.path("part.nc"), program).expect("a file");
    let output = workdir.run_job("verify", &["--only", "report"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(workdir.path("out/report.json")).unwrap()).unwrap();
    let findings = report["findings"].as_array().unwrap();
    assert_eq!(findings.len(), 1, "{findings:?}");
    let found = &findings[0];
    assert_eq!((&found["kind"], &found["line"]), (&"limit".into(), &6.into()));
    assert_eq!(found["text"], "G3 X25 Y20 R20");
    assert_eq!(found["detail"], "X at 45, outside of −40 … 40");
    // One block of many chords, beyond from X 40 on, and by 5 mm at most, up to the chords' 1e-5 mm.
    assert!((found["place"][0].as_f64().unwrap() - 40.0).abs() < 0.01, "{found}");
    assert!(found["place"][1].as_f64().unwrap() < 0.0, "{found}");
    assert!((found["depth"].as_f64().unwrap() - 5.0).abs() < 1e-4, "{found}");
    let summary = text(&output.stdout);
    assert!(
        summary.contains("FAIL: 1 move beyond the machine's limits"),
        "{summary}"
    );
    assert!(
        summary.contains("part.nc:6: tool 1, X at 45, outside of −40 … 40"),
        "{summary}"
    );
    assert!(summary.contains("1 move faster than the axes can be"), "{summary}");
    // Within the limits there is nothing.
    fs::write(workdir.path("mill.ron"), machine.replace("(-40, 40)", "(-60, 60)")).expect("a file");
    let output = workdir.run_job("verify", &["--only", "report"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
}

#[test]
fn the_result_of_a_run_is_a_target() {
    let job = r#"Job(
        grid: Grid(min: (0, 0), max: (20, 10), cells: (80, 40)),
        stock: Block(min: (0, 0, 0), max: (20, 10, 6)),
        tools: { 1: Ball(radius: 2, length: 30) },
        paths: [Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0, 0, 1))])],
    )"#;
    let workdir = Workdir::new(job);
    workdir.good(&["simulate", "job.ron", "--out", "wanted", "--only", "binary"]);
    let with = "limits: Limits(gouge: 0.05, excess: 0.05), target: Dexels(\"wanted/part.dexels\"), paths";
    let verify = |from: &str, to: &str| {
        fs::write(workdir.path("job.ron"), job.replace("paths", with).replace(from, to)).expect("a file");
        let output = workdir.run_job("verify", &["--only", "report"]);
        (output.status.code(), text(&output.stdout))
    };
    let (code, summary) = verify("", "");
    assert_eq!(code, Some(0), "{summary}");
    let (code, summary) = verify("5, 3)", "5, 2.8)");
    assert_eq!(code, Some(1), "{summary}");
    assert!(summary.contains("FAIL: 1 gouging move"), "{summary}");
    let (code, summary) = verify("5, 3)", "5, 3.2)");
    assert_eq!(code, Some(1), "{summary}");
    assert!(summary.contains("with material left"), "{summary}");
    let (code, _) = verify("wanted/part", "nowhere/part");
    assert_eq!(code, Some(2));
}

/// The shipped faulty bracket with its circle a little narrower or wider: bisection cuts the level arc into parts of
/// less than a micrometre.
#[test]
fn level_arcs_leave_nothing_unresolved() {
    let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/verify");
    let job = fs::read_to_string(fixtures.join("bracket-faulty.ron")).unwrap();
    let program = fs::read_to_string(fixtures.join("bracket-faulty.nc")).unwrap();
    let folder = Workdir::new(&job.replace("cells: (200, 120)", "cells: (100, 60)"));
    fs::copy(fixtures.join("bracket.stl"), folder.path("bracket.stl")).unwrap();
    for wider in ["I-10.5", "I-10.7"] {
        assert!(program.contains("I-10.6"));
        fs::write(folder.path("bracket-faulty.nc"), program.replace("I-10.6", wider)).unwrap();
        let (report, findings) = verified(&folder, 1, &[]);
        assert_eq!(report.dexels.unresolved, [], "{wider}");
        let circle = program.lines().position(|line| line.contains("I-10.6")).unwrap() + 1;
        let gouge = findings.iter().find(|f| f.line == Some(circle)).unwrap();
        assert_eq!(gouge.kind, "gouge");
        let numbers = gouge
            .place
            .into_iter()
            .chain([gouge.depth, gouge.volume, gouge.time.unwrap()]);
        assert!(numbers.into_iter().all(f64::is_finite), "{gouge:?}");
    }
}

/// A pass that is 0.06 too high, which only the floor's region forbids; and a comparison by the same limits.
#[test]
fn limits_by_region() {
    let region = "Limits(gouge: 0.02, excess: 0.1, regions: [Region(name: \"floor\", within: Block(min: (-16, -3.5, 2.9), max: (16, 3.5, 3.1)), gouge: 0.02, excess: 0.03)])";
    let loose = "Limits(gouge: 0.02, excess: 0.1)";
    for (limits, code) in [(loose, 0), (region, 1)] {
        let folder = workdir(&job("", 12.0, limits));
        fs::write(folder.path("part.nc"), PROGRAM.replace("Z3\n", "Z3.06\n")).unwrap();
        let (report, findings) = verified(&folder, code, &[]);
        let found: Vec<_> = findings
            .iter()
            .map(|found| (found.kind.as_str(), found.region.as_deref()))
            .collect();
        let expected: &[_] = if code == 1 { &[("excess", Some("floor"))] } else { &[] };
        assert_eq!(found, expected);
        let page = fs::read_to_string(folder.path("out/report.html")).unwrap();
        assert_eq!(page.contains("<dd>region floor</dd>"), code == 1);
        if code == 0 {
            continue;
        }
        // The same of the part as dexels.
        folder.good(&["simulate", "job.ron", "--only", "binary", "--out", "made"]);
        let json = folder.good(&[
            "compare",
            "made/part.dexels",
            "part.ply",
            "--limits",
            "job.ron",
            "--out",
            "cmp",
            "--size",
            "60x40",
            "--json",
        ]);
        let compared: ComparisonReport = serde_json::from_str(&json).unwrap();
        let own = report.regions.unwrap();
        assert_eq!(compared.regions, own);
        assert_eq!(own.len(), expected.len());
        for region in own {
            assert_eq!(
                (region.kind.as_str(), region.region.as_deref()),
                ("excess", Some("floor"))
            );
            // On the floor of 30 × 6 mm.
            assert!(
                (region.depth - 0.06).abs() < 1e-3 && (region.area - 180.0).abs() < 35.0,
                "{region:?}"
            );
        }
        let words = folder.good(&[
            "compare",
            "made/part.dexels",
            "part.ply",
            "--limits",
            "0.01,0.05",
            "--out",
            "cmp",
            "--size",
            "60x40",
        ]);
        assert!(
            words.contains("limits  1 region deeper than 0.010000 or higher than 0.050000 mm"),
            "{words}"
        );
    }
}
