//! Harm to what stands between the dexels along z.

use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::{Report, ReportedFinding};

/// A web 0.2 thick between two dexels along z, which are 1 apart. A rapid goes through it, and a feed move through a
/// plate as thin that is clamped there.
const JOB: &str = r#"Job(
    grid: Grid(min: (0, 0), max: (30, 20), cells: (30, 20)),
    stock: Union([Block(min: (0, 0, 0), max: (30, 20, 4)), Block(min: (12.9, 0, 0), max: (13.1, 20, 12))]),
    tools: { 1: Flat(radius: 1.5, length: 6) },
    bodies: { 1: [Holder(Profile(start: (0, 7), segments: [Line((4, 7)), Line((4, 20)), Line((0, 20))]))] },
    fixtures: [Block(min: (24.9, 4, 4), max: (25.1, 16, 10))],
    paths: [Path(tool: 1, moves: [
        Start(((4, 10.2, 15), (0, 0, 1))),
        Line(((4, 10.2, 6), (0, 0, 1))),
        Rapid(((20, 10.2, 6), (0, 0, 1))),
        Line(((28, 10.2, 6), (0, 0, 1))),
    ])],
)"#;

fn findings(workdir: &Workdir, more: &[&str]) -> (Option<i32>, Vec<ReportedFinding>) {
    let output = workdir.run_job("verify", &[&["--only", "report"], more].concat());
    let report = fs::read(workdir.path("out/report.json")).unwrap_or_else(|_| panic!("{}", text(&output.stderr)));
    let report: Report = serde_json::from_slice(&report).expect("a report");
    (output.status.code(), report.findings.expect("findings"))
}

#[test]
fn what_stands_between_dexels_is_found_along_the_others() {
    let workdir = Workdir::new(JOB);
    // The fixtures' dexels begin where they do, so the plate is seen along z; the web is not.
    let (code, along_z) = findings(&workdir, &["--no-proof"]);
    assert_eq!((code, along_z.len()), (Some(1), 1), "{along_z:?}");
    assert_eq!(along_z[0].kind, "fixture");
    // What is proven needs no lines.
    let (code, between) = findings(&workdir, &[]);
    assert_eq!((code, between.len()), (Some(1), 2), "{between:?}");
    let web = &between[0];
    assert!(web.between && web.kind == "rapid" && web.r#move == Some(1), "{web:?}");
    assert!((12.9..13.1).contains(&web.place[0]) && web.depth < 0.1, "{web:?}");
    let (code, all) = findings(&workdir, &["--directions", "xyz"]);
    assert_eq!(code, Some(1));
    let told: Vec<(&str, Option<usize>, Option<&str>)> = all
        .iter()
        .map(|finding| (finding.kind.as_str(), finding.r#move, finding.body.as_deref()))
        .collect();
    let expected = [("rapid", Some(1), None), ("fixture", Some(2), None)];
    assert_eq!(told, expected, "{all:?}");
    // The wall of the cutter reaches the web at x = 12.9 after (12.9 − 1.5 − 4) of 16, the plate at 24.9 after (24.9 −
    // 1.5 − 20) of 8: on the line through the axis at once, on those beside it later. Lines along x are 1 apart.
    for (finding, time, plate) in [(&all[0], 7.4 / 16.0, 12.9), (&all[1], 3.4 / 8.0, 24.9)] {
        let late = finding.time.expect("a time") - time;
        let length = if finding.kind == "rapid" { 16.0 } else { 8.0 };
        assert!((-1e-4..0.1 / length).contains(&late), "{late}");
        assert!((finding.place[0] - plate).abs() < 1e-3, "{:?}", finding.place);
    }
    // The web is as thick as it is along x, and no dexel along y meets it; of the plate the cutter covers 4 along z.
    let depths = [&all[0], &all[1]].map(|finding| finding.depth);
    assert!(
        (depths[0] - 0.2).abs() < 1e-3 && (depths[1] - 4.0).abs() < 1e-3,
        "{depths:?}"
    );
    // The first alone.
    let (code, first) = findings(&workdir, &["--directions", "xyz", "--first"]);
    assert_eq!(code, Some(1));
    assert_eq!(first.len(), 1);
    assert_eq!(first[0].kind, "rapid");
}

#[test]
fn harm_along_several_directions_is_told_once() {
    // A block that all directions see.
    let job = JOB.replace("max: (13.1, 20, 12)", "max: (16, 20, 12)");
    let workdir = Workdir::new(&job);
    let (_, along_z) = findings(&workdir, &[]);
    let (_, all) = findings(&workdir, &["--directions", "xyz"]);
    let rapids = |of: &[ReportedFinding]| of.iter().filter(|f| f.kind == "rapid").cloned().collect::<Vec<_>>();
    let ([z], [xyz]) = (&rapids(&along_z)[..], &rapids(&all)[..]) else {
        panic!("{along_z:?} {all:?}");
    };
    assert!(xyz.time <= z.time, "{:?} {:?}", xyz.time, z.time);
    assert!(xyz.depth >= z.depth && xyz.volume >= z.volume);
}
