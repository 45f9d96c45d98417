//! `verify` in shards: findings of all kinds, joined to what one run finds.

use super::{SMALL, assert_same};
use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::Report;

/// Two pockets: the second too deep, left by a rapid through the stock. Shank and holder reach the stock, and a clamp
/// is in the way.
const PROGRAM: &str = "G21 G90 G17
T1 M6
S8000 M3
G0 X-19 Y-6 Z10
G0 Z5.5
G1 X16 F400
Z3
X-19
G0 Z12
G0 X-16 Y5
G1 Z3
X4
Z2
X16
G0 X-3 Y7
G0 Z20
G0 X-2 Y8
G2 X6 Y8 Z4 I4 J0
G0 Z20
M30
";

/// In tiles of 8, the clamp and the holder reach over several.
fn job(reach: f64) -> String {
    format!(
        "Job(
    grid: Grid(min: (-15, -12), max: (15, 12), cells: (30, 24)),
    stock: Block(min: (-15, -12, 0), max: (15, 12, 8)),
    tools: {{ 1: Flat(radius: 2.5, length: 9) }},
    bodies: {{ 1: [
        Shank(Profile(start: (0, {reach}), segments: [Line((2.8, {reach})), Line((2.8, 20)), Line((0, 20))])),
        Holder(Profile(start: (0, 4.6), segments: [Line((8, 4.6)), Line((8, 40)), Line((0, 40))])),
    ] }},
    fixtures: [Block(min: (-15, 9, 8), max: (13, 11, 12)), Block(min: (14, -8, 8), max: (16, -4, 9))],
    paths: [Path(file: \"part.nc\")],
    target: Mesh(\"part.ply\"),
    limits: Limits(gouge: 0.02, excess: 0.05),
)"
    )
}

/// Writes a program without faults but for shank, holder and clamps.
fn good(folder: &Workdir) {
    let program = PROGRAM.replace("\nZ2\n", "\n").replace("G0 X-3 Y7\n", "");
    fs::write(folder.path("part.nc"), program).unwrap();
}

/// A folder with the faulty program, and what a good one makes as the target.
fn faulty() -> Workdir {
    let folder = Workdir::new(&job(4.2).replace("    target: Mesh(\"part.ply\"),\n", ""));
    good(&folder);
    folder.good(&["simulate", "job.ron", "--only", "mesh", "--out", "."]);
    fs::write(folder.path("job.ron"), job(4.2)).unwrap();
    fs::write(folder.path("part.nc"), PROGRAM).unwrap();
    folder
}

fn verify(folder: &Workdir, more: &[&str]) -> Option<i32> {
    let output = folder.run(&[&["verify", "job.ron"][..], &SMALL, more].concat());
    output.status.code()
}

/// Verifies whole and in shards, and compares all that is left; the report.
fn compare(folder: &Workdir, more: &[&str], counts: &[usize], status: i32) -> Report {
    assert_eq!(verify(folder, &[&["--out", "whole"], more].concat()), Some(status));
    for count in counts {
        let [pieces, merged] = ["pieces", "merged"].map(|name| format!("{name}-{count}"));
        for index in 0..*count {
            let shard = format!("{index}/{count}");
            let own = ["--out", &pieces, "--shard", &shard];
            assert_eq!(
                verify(folder, &[&own, more].concat()),
                Some(0),
                "a shard does not judge the whole"
            );
        }
        let output = folder.run(&["merge", &pieces, "--out", &merged]);
        assert_eq!(output.status.code(), Some(status), "{}", text(&output.stderr));
        assert_same(folder, "whole", &merged);
    }
    serde_json::from_slice(&fs::read(folder.path("whole/report.json")).unwrap()).unwrap()
}

#[test]
fn shards_find_what_one_run_finds() {
    let folder = faulty();
    let more = ["--moves", "--only", "dexels,mesh,picture,report,binary,certificate"];
    let report = compare(&folder, &more, &[4], 1);
    let findings = report.findings.unwrap();
    for (kind, body) in [
        ("rapid", None),
        ("gouge", None),
        ("fixture", None),
        ("fixture", Some("holder")),
        ("collision", Some("holder")),
        ("collision", Some("shank")),
    ] {
        let found = findings.iter().any(|f| f.kind == kind && f.body.as_deref() == body);
        assert!(found, "no {kind} of {body:?}: {findings:?}");
    }
    assert!(!report.regions.unwrap().is_empty());
    // One move and body is one finding, whatever number of tiles it was seen on.
    for (n, finding) in findings.iter().enumerate() {
        let same = |other: &&sweepsim_formats::ReportedFinding| {
            (&other.kind, &other.body, other.r#move) == (&finding.kind, &finding.body, finding.r#move)
        };
        assert!(
            finding.kind == "excess" || findings[..n].iter().find(same).is_none(),
            "{finding:?}"
        );
    }
}

#[test]
fn clearances_and_other_directions_are_the_same_in_shards() {
    let folder = faulty();
    // That proofs are the same is shown by what is found in shards.
    let only = ["--no-proof", "--only", "dexels,report"];
    let near = compare(
        &folder,
        &[&["--clearance", "0.3", "--sure"], &only[..]].concat(),
        &[2],
        1,
    );
    assert!(near.findings.unwrap().iter().any(|finding| finding.near));
    let folder = faulty();
    // The solid is made of what was judged along x and y.
    let aside = [
        "--directions",
        "xyz",
        "--no-proof",
        "--only",
        "dexels,tridexels,mesh,report",
    ];
    let aside = compare(&folder, &aside, &[3], 1);
    assert!(!aside.findings.unwrap().is_empty());
}

#[test]
fn a_good_program_passes_in_shards() {
    let folder = faulty();
    good(&folder);
    let alone = job(4.2);
    let from = alone.find("    bodies").unwrap();
    let to = alone.find("    paths").unwrap();
    let alone = format!("{}{}", &alone[..from], &alone[to..]);
    fs::write(
        folder.path("job.ron"),
        alone.replace("    target: Mesh(\"part.ply\"),\n", ""),
    )
    .unwrap();
    let report = compare(&folder, &["--only", "dexels,report"], &[2], 0);
    assert!(report.findings.unwrap().is_empty());
}

#[test]
fn the_first_finding_is_for_one_run() {
    let folder = faulty();
    assert_eq!(
        verify(&folder, &["--first", "--only", "report", "--out", "first"]),
        Some(1)
    );
    let message = folder.bad(&["verify", "job.ron", "--first", "--shard", "0/2", "--out", "p"]);
    assert!(message.contains("--first with --shard"), "{message}");
    assert!(!folder.path("p").exists());
}

const PIECE: &str = "p/shard-1-of-3.piece";

/// The message of a merge that must fail, and leaves nothing behind.
fn refused(folder: &Workdir) -> String {
    let message = folder.bad(&["merge", "p", "--out", "merged"]);
    assert!(!folder.path("merged/report.json").exists());
    message
}

#[test]
fn pieces_of_verify_are_checked() {
    let folder = faulty();
    let only = ["--no-proof", "--only", "report"];
    let shard = |number: &str, more: &[&str]| {
        let own = ["--out", "p", "--shard", number];
        assert_eq!(verify(&folder, &[&own, &only[..], more].concat()), Some(0));
    };
    for number in ["0/3", "1/3", "2/3"] {
        shard(number, &[]);
    }
    let whole = fs::read(folder.path(PIECE)).unwrap();
    // What is there and whole is not done again.
    let again = [
        &["verify", "job.ron", "--out", "p", "--shard", "1/3", "--resume"][..],
        &SMALL,
        &only,
    ]
    .concat();
    assert!(folder.good(&again).contains("nothing to do"));
    // Missing, doubled, truncated, damaged.
    fs::remove_file(folder.path(PIECE)).unwrap();
    assert!(refused(&folder).contains("1 of 3 pieces are missing: run again with --shard 1/3"));
    fs::write(folder.path(PIECE), &whole).unwrap();
    fs::write(folder.path("p/other.piece"), &whole).unwrap();
    assert!(refused(&folder).contains("shard 1 comes twice"));
    fs::remove_file(folder.path("p/other.piece")).unwrap();
    fs::write(folder.path(PIECE), &whole[..whole.len() / 2]).unwrap();
    assert!(refused(&folder).contains("truncated"));
    let mut other = whole.clone();
    other[300] ^= 1;
    fs::write(folder.path(PIECE), other).unwrap();
    assert!(refused(&folder).contains("damaged"));
    // Of `simulate`, and of other options.
    folder.good(
        &[
            &["simulate", "job.ron", "--out", "p", "--shard", "1/3"][..],
            &SMALL,
            &only[1..],
        ]
        .concat(),
    );
    let message = refused(&folder);
    assert!(message.contains("its command is simulate, not verify"), "{message}");
    shard("1/3", &["--clearance", "1"]);
    assert!(refused(&folder).contains("its request is"));
    // The target has changed since.
    fs::write(folder.path(PIECE), &whole).unwrap();
    let target = fs::read(folder.path("part.ply")).unwrap();
    folder.good(&["simulate", "job.ron", "--only", "mesh", "--out", "."]);
    let message = refused(&folder);
    assert!(message.contains("stale"), "{message}");
    fs::write(folder.path("part.ply"), target).unwrap();
    let merged = folder.run(&["merge", "p", "--out", "merged"]);
    assert_eq!(merged.status.code(), Some(1), "{}", text(&merged.stderr));
}

/// Shards that meet no material are as undecided as one run is.
#[test]
fn shards_without_material_decide_nothing() {
    let folder = Workdir::new(
        "Job(
    grid: Grid(min: (50, -12), max: (80, 12), cells: (30, 24)),
    stock: Block(min: (-15, -12, 0), max: (15, 12, 8)),
    tools: { 1: Flat(radius: 2.5, length: 9) },
    paths: [Path(file: \"part.nc\")],
)",
    );
    fs::write(folder.path("part.nc"), PROGRAM).unwrap();
    let report = compare(&folder, &["--no-proof", "--only", "report"], &[2], 3);
    assert_eq!(report.verdict, Some(sweepsim_formats::Verdict::Undecided));
}
