//! How tools turn and go round in jobs and programs.

use std::f64::consts::{PI, TAU};
use std::path::Path as FilePath;
use sweepsim_formats::{FormatError, Job};
use sweepsim_motion::{RotaryTable, TipCourse, Turning};

fn job(path: &str) -> Result<Job, FormatError> {
    let text = format!(
        "Job(grid: Grid(min: (0, 0), max: (20, 10), cells: (20, 10)), stock: Block(min: (0, 0, 0), max: (20, 10, 5)),\n\
         tools: {{ 1: Ball(radius: 2, length: 30) }}, paths: [\n{path}\n])"
    );
    Job::parse(&text, FilePath::new("part.ron"))
}

fn message(path: &str) -> String {
    match job(path) {
        Ok(_) => panic!("{path} is no error"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn laws_of_poses() {
    let with = |law: &str| {
        let text = format!("Path(tool: 1, law: {law}, poses: [((0, 5, 3), (0, 1, 1)), ((20, 5, 3), (1, 0, 1))])");
        job(&text).unwrap().paths[0].path.way(0).turning
    };
    assert_eq!(with("Slerp"), Turning::Slerp);
    assert_eq!(with("ConstantSpeed"), Turning::Even);
    match with("Rotary(AC)") {
        Turning::Rotary { table, from, to } => {
            assert_eq!(table, RotaryTable::Ac);
            let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-12;
            assert!(near(from, [45.0, 0.0]) && near(to, [45.0, 90.0]), "{from:?} {to:?}");
        }
        other => panic!("{other:?}"),
    }
    assert!(message("Path(tool: 1, law: Sideways, poses: [((0, 5, 3), (0, 1, 1))])").contains("Sideways"));
}

#[test]
fn whole_orientations() {
    let path = "Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1), (1, 1, 0)), ((20, 5, 3), (0, 0, 1), (0, 1, 0))])";
    let job = job(path).unwrap();
    let pose = job.paths[0].path.poses()[0];
    assert!((pose.side().unwrap()[0] - 0.5_f64.sqrt()).abs() < 1e-15);
    let mixed = message("Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1), (1, 1, 0)), ((20, 5, 3), (0, 0, 1))])");
    assert!(mixed.contains("fixes the spin"), "{mixed}");
    let along = message("Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1),\n(0, 0, 2))])");
    assert!(along.starts_with("part.ron:4:1") && along.contains("side"), "{along}");
    let long = message("Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1), (1, 0, 0), (1, 0, 0))])");
    assert!(long.starts_with("part.ron:3:"), "{long}");
    let short = message("Path(tool: 1, poses: [((0, 5, 3),)])");
    assert!(short.contains("pose"), "{short}");
}

#[test]
fn arcs_and_helices() {
    let path = "Path(tool: 1, law: ConstantSpeed, moves: [
        Start(((5, 0, 0), (0, 0, 1))),
        Line(((6, 0, 0), (0, 0, 1))),
        Arc(to: ((2, 0, 1), (0, 0, 1)), centre: (4, 0, 0), turn: Cw, turns: 2),
        Arc(to: ((2, 0, 5), (0, 0, 1)), centre: (2, 0, 3), normal: (0, 1, 0), turn: Ccw),
    ])";
    let job = job(path).unwrap();
    let path = &job.paths[0].path;
    assert_eq!(path.moves(), 3);
    let angle = |index: usize| match path.way(index).course {
        TipCourse::Arc(arc) => arc.angle(),
        _ => 0.0,
    };
    assert_eq!(angle(0), 0.0);
    assert!((angle(1) + TAU + PI).abs() < 1e-12 && (angle(2) - PI).abs() < 1e-12);
    let radii = message(
        "Path(tool: 1, moves: [Start(((5, 0, 0), (0, 0, 1))),\nArc(to: ((2, 0, 1), (0, 0, 1)), centre: (4, 0, 0), turn: Cw)])",
    );
    assert!(
        radii.starts_with("part.ron:4:") && radii.contains("two radii"),
        "{radii}"
    );
    let start = message("Path(tool: 1, moves: [Line(((5, 0, 0), (0, 0, 1)))])");
    assert!(start.contains("Start"), "{start}");
    let both = message("Path(tool: 1, file: \"a.nc\", moves: [Start(((5, 0, 0), (0, 0, 1)))])");
    assert!(both.contains("one of them"), "{both}");
}

#[test]
fn tools_by_name_and_their_holders() {
    let with = |tools: &str| {
        let text = format!(
            "Job(units: Inch, grid: Grid(min: (0, 0), max: (20, 10), cells: (20, 10)), stock: Block(min: (0, 0, 0), max: (20, 10, 5)),\n\
             {tools},\n paths: [Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1))])])"
        );
        Job::parse(&text, FilePath::new("part.ron"))
    };
    let job = with(
        "tools: { 1: Lollipop(radius: 2, neck: 1, length: 9), 2: Dovetail(radius: 3, angle: 60, height: 2, neck: 1, length: 9),\n\
         3: Barrel(radius: 2, flank: 20, height: 6, length: 9), 4: Lens(radius: 2, bottom: 6, length: 9) },\n\
         bodies: { 1: [Shank(Flat(radius: 1, length: 12)), Holder(Profile(start: (0, 12), segments: [Line((5, 12)), Line((5, 20)), Line((0, 20))]))] }",
    )
    .unwrap();
    let tops: Vec<f64> = job.tools.values().map(|tool| tool.reach() / 25.4).collect();
    assert!(tops.iter().all(|reach| (9.0..9.5).contains(reach)), "{tops:?}");
    let holder = &job.bodies[&1][1];
    assert_eq!(holder.kind, sweepsim_motion::BodyKind::Holder);
    assert_eq!(holder.solid.profile().unwrap().start(), [0.0, 12.0 * 25.4]);
    let wrong = |tools: &str, place: &str, word: &str| {
        let error = with(tools).unwrap_err().to_string();
        assert!(error.starts_with(place) && error.contains(word), "{error}");
    };
    wrong(
        "tools: { 1: Lollipop(radius: 2,\nneck: 3, length: 9) }",
        "part.ron:3:",
        "neck is",
    );
    wrong(
        "tools: { 1: Dovetail(radius: 3,\nangle: 95, height: 2, neck: 1, length: 9) }",
        "part.ron:3:",
        "angle is 95,",
    );
    wrong(
        "tools: { 1: Barrel(radius: 2,\nflank: 2, height: 6, length: 9) }",
        "part.ron:3:",
        "half the height",
    );
    wrong(
        "tools: { 1: Lens(radius: 2,\nbottom: 1, length: 9) }",
        "part.ron:3:",
        "greater than the radius",
    );
    wrong(
        "tools: { 1: Flat(radius: 2, length: 9) },\nbodies: { 2: [Holder(Flat(radius: 1, length: 2))] }",
        "part.ron:3:",
        "2",
    );
    wrong(
        "tools: { 1: Flat(radius: 2, length: 9) },\nbodies: { 1: [Holder(Flat(radius: 1,\nlength: -2))] }",
        "part.ron:4:",
        "length",
    );
}
