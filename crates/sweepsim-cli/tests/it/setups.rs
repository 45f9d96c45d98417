//! Jobs with set-ups, from the file to the findings and the page.

use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::Report;

/// A pocket from the top, the same from the bottom; in both, zero is in the middle of the upper face.
const POCKET: &str = "G21 G90 G17
T1 M6
S8000 M3
G0 X-10 Y0 Z20
Z2
G1 Z-3 F300
X10
G0 Z20
M30
";

fn job(clamps: [&str; 2]) -> String {
    format!(
        "Job(
    grid: Grid(min: (-20, -15), max: (20, 15), cells: (80, 60)),
    stock: Block(min: (-20, -15, -12), max: (20, 15, 0)),
    tools: {{ 1: Flat(radius: 3, length: 20) }},
    setups: [
        Setup(name: \"top\", paths: [Path(file: \"top.nc\")], fixtures: [{}]),
        Setup(
            frame: Frame(origin: (0, 0, -12), z: (0, 0, -1), x: (1, 0, 0)),
            paths: [Path(file: \"bottom.nc\")],
            fixtures: [{}],
        ),
    ],
)",
        clamps[0], clamps[1]
    )
}

/// In the way of the pocket, on the upper face.
const CLAMP: &str = "Block(min: (-4, -15, 0), max: (4, 15, 5))";
/// Below the part.
const TABLE: &str = "Block(min: (-30, -30, -20), max: (30, 30, -12))";

fn workdir(clamps: [&str; 2]) -> Workdir {
    let folder = Workdir::new(&job(clamps));
    for name in ["top.nc", "bottom.nc"] {
        fs::write(folder.path(name), POCKET).unwrap();
    }
    folder
}

fn verified(folder: &Workdir, code: i32) -> Report {
    let output = folder.run_job("verify", &["--only", "report,dexels"]);
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    serde_json::from_slice(&fs::read(folder.path("out/report.json")).unwrap()).unwrap()
}

#[test]
fn a_part_milled_from_two_sides() {
    let folder = workdir([TABLE, TABLE]);
    let report = verified(&folder, 0);
    // A slot of 6 × 20 mm with round ends, 3 mm deep; the second is the first upside down, line by line.
    let setups = report.setups.as_ref().unwrap();
    let removed: Vec<f64> = setups.iter().map(|setup| setup.work.unwrap().removed).collect();
    assert!(
        (removed[0] - removed[1]).abs() < 1e-6 && (removed[0] - 3.0 * 148.3).abs() < 3.0,
        "{removed:?}"
    );
    assert_eq!((setups[0].name.as_str(), setups[1].name.as_str()), ("top", "2"));
    assert_eq!(
        (setups[1].origin, setups[1].axes[2]),
        ([0.0, 0.0, -12.0], [0.0, 0.0, -1.0])
    );
    assert_eq!(setups[0].work.unwrap().seconds, setups[1].work.unwrap().seconds);
    let rows = fs::read_to_string(folder.path("out/dexels.csv")).unwrap();
    // The line at (0.25, 0.25) is in both slots.
    let row = rows.lines().find_map(|row| row.strip_prefix("40,30,")).unwrap();
    let ends: Vec<f64> = row.split(',').map(|end| end.parse().unwrap()).collect();
    // To the tolerance.
    assert!((ends[0] + 9.0).abs() < 1e-6 && (ends[1] + 3.0).abs() < 1e-6, "{ends:?}");
    let simulated = folder.run_job("simulate", &["--only", "dexels"]);
    assert!(simulated.status.success());
    assert_eq!(fs::read_to_string(folder.path("out/dexels.csv")).unwrap(), rows);
    let page = fs::read_to_string({
        verified(&folder, 0);
        folder.path("out/report.html")
    })
    .unwrap();
    for words in [
        "<h2>Set-up top</h2>",
        "<h2>Set-up 2</h2>",
        "−Z and +X of the part",
        "X middle, Y middle, Z upper side",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn fixtures_count_in_their_set_up() {
    let report = verified(&workdir([TABLE, CLAMP]), 1);
    let findings = report.findings.unwrap();
    let found: Vec<_> = findings
        .iter()
        .map(|found| (found.kind.as_str(), found.setup, found.file.as_deref(), found.line))
        .collect();
    let bottom = |line| ("fixture", Some(1), Some("bottom.nc"), Some(line));
    assert_eq!(found, [bottom(7)], "{findings:?}");
    // The clamp is below the part as the part lies in the job.
    assert!(findings[0].place[2] < -12.0, "{:?}", findings[0].place);
    let output = workdir([CLAMP, TABLE]).run_job("verify", &["--only", "dexels"]);
    let words = text(&output.stdout);
    assert!(words.contains("top.nc:7: set-up top, cutter of tool 1"), "{words}");
}

#[test]
fn inspect_shows_programs_in_their_own_coordinates() {
    let words = workdir([TABLE, CLAMP]).good(&["inspect", "job.ron"]);
    let wanted = |line: &&str| line.starts_with("set-up") || line.starts_with("bounds");
    let lines: Vec<&str> = words.lines().map(str::trim).filter(wanted).collect();
    assert_eq!(lines.len(), 4, "{words}");
    assert!(lines[0].ends_with("top: as the part"), "{words}");
    assert!(
        lines[2].contains("2: zero at (0, 0, −12.000) of the part, whose −Z is up and +X to the right"),
        "{words}"
    );
    assert_eq!(lines[1], lines[3]);
}
