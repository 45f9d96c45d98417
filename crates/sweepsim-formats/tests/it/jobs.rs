//! Jobs that are right.

use std::path::Path;

use sweepsim_dexel::Stock;
use sweepsim_formats::{Job, Units};

#[test]
fn everything_that_a_job_may_have() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &[u8]| std::fs::write(folder.path().join(name), text).unwrap();
    let mut stl = Vec::new();
    sweepsim_formats::write_stl(&[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]], &mut stl).unwrap();
    write("part.stl", &stl);
    write(
        "a.csv",
        b"x,y,z,i,j,k,rapid,tool\n0,0,1,0,0,1,1,1\n1,0,0,0,0,1,0,1\n2,0,0,0,0,1,0,2\n3,0,0,0,1,0,0,2\n",
    );
    write(
        "motion.ron",
        b"Motion(tip: Curve(degree: 1, points: [(0, 0, 0), (1, 0, 0)], weights: [1, 2]))",
    );
    write("b.tap", b"G90\nT2 M6\nM428\nG0 X0 Y0 Z1 A0 C0\nG1 Z0\nX1 A90\n");
    let text = r#"
Job(
    units: Inch,
    tolerance: 1e-6,
    grid: Grid(min: (-1, -1), max: (1, 1), cells: (20, 10)),
    stock: Cylinder(base: (0, 0, -1), radius: 1.0, height: 2.0),
    tools: {
        1: Ball(radius: 5.0, length: 30.0),
        2: Flat(radius: 5.0, length: 30.0),
        3: Bull(radius: 5.0, corner: 1.0, length: 30.0),
        4: Apt(d: 10.0, r: 1.0, e: 4.0, f: 1.0, a: 0.0, b: 0.0, h: 30.0),
        5: Profile(start: (0.0, 0.0), segments: [
               Line((2.0, 0.0)), Line((2.0, 2.0)), Arc(to: (8.0, 8.0), centre: (8.0, 2.0), turn: Cw), Line((8.0, 30.0)), Line((0.0, 30.0)) ]),
        6: Profile(start: (0.0, 0.0), segments: [
               Spline(degree: 3, points: [(0, 0), (3, 0), (5, 2), (4, 6), (6, 9)], knots: Some([0, 0, 0, 0, 1, 2, 2, 2, 2])),
               Spline(degree: 2, points: [(6, 9), (8, 9), (8, 11)], weights: Some([1.0, 0.7071067811865476, 1.0])), Line((8, 30)), Line((0, 30)) ]),
        7: Oval(radius: 4, tip: 1, flank: 85, length: 40),
        8: Taper(radius: 4, tip: 1, flank: 85, angle: 10, length: 40),
        9: Barrel(radius: 4, flank: 40, height: 20, corner: 0.5, length: 40),
        10: Lens(radius: 4, bottom: 20, corner: 0.5, length: 40),
        11: Apt(d: 12, r: 20, e: -14, f: 10, a: 0, b: 0, h: 40),
    },
    paths: [
        Path(tool: 4, poses: [ ((-20.0, -10.0, 0.0), (0.0, 0.0, 1.0)), ((20.0, 10.0, 8.0), (0.1, 0.0, 1.0)) ]),
        Path(file: "a.csv"),
        Path(tool: 2, file: "b.tap", table: AC, arc_tolerance: 0.001),
        Path(tool: 1, motion: Motion(
            tip: Curve(degree: 2, points: [(0, 0, 5), (1, 1, 5), (2, 0, 5), (3, 0, 5)], knots: [0, 0, 0, 1, 4, 4, 4]),
            orientation: Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0, 0, 0.1)]),
        )),
        Path(tool: 1, file: "motion.ron"),
    ],
    target: Some(Mesh("part.stl")),
    limits: Some(Limits(gouge: 0.02, excess: 0.1)),
)"#;
    write("all.ron", text.as_bytes());
    let job = Job::read(&folder.path().join("all.ron")).unwrap_or_else(|error| panic!("{}", error.render(false)));
    assert_eq!((job.name.as_str(), job.units), ("all", Units::Inch));
    assert_eq!(job.tolerance, 1e-6 * 25.4);
    assert_eq!(job.grid.max(), [25.4, 25.4]);
    assert!(matches!(
        job.stock,
        Stock::Cylinder {
            axis: [0.0, 0.0, 1.0],
            radius: 25.4,
            ..
        }
    ));
    assert_eq!(job.tools.len(), 11);
    let notes: Vec<String> = job.notes.iter().map(ToString::to_string).collect();
    assert!(
        matches!(&notes[..], [one] if one.starts_with("line 21: tool 11: the corner (r, e, f) is not tangent to the bottom line, which passes its centre at 10:")),
        "{notes:?}"
    );
    // The path of the table divides where its tool changes.
    let tools: Vec<u32> = job.paths.iter().map(|path| path.tool).collect();
    assert_eq!(tools, [4, 1, 2, 2, 1, 1]);
    // The motion has a move between each two knots; the orientation's are over the range of the tip's.
    assert_eq!(job.moves(), 1 + 1 + 1 + 2 + 2 + 1);
    let knot = &job.paths[4].path.poses()[1];
    assert!((knot.tip()[0] - 1.25 * 25.4).abs() < 1e-12, "{knot:?}");
    assert_eq!(job.paths[5].path.poses()[1].tip()[0], 25.4);
    assert_eq!(
        job.paths[0].path.poses()[1].tip(),
        [20.0 * 25.4, 10.0 * 25.4, 8.0 * 25.4]
    );
    let last = &job.paths[3];
    let lines: Vec<usize> = last.origins.iter().map(|origin| origin.line).collect();
    assert_eq!(lines, [4, 5, 6]);
    assert_eq!(last.path.poses()[2].axis(), [0.0, 1.0, 0.0]);
    assert_eq!(
        last.path.poses()[2].tip()[0],
        25.4,
        "the job's units hold for programs that say none"
    );
    assert_eq!(job.limits.unwrap().gouge, 0.02 * 25.4);
    assert_eq!(job.target.unwrap().mesh.triangles[0][1][0], 25.4);
}

/// The jobs of the project itself.
#[test]
fn fixtures() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/jobs");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        if file.extension().is_some_and(|extension| extension == "ron") {
            let job = Job::read(&file).unwrap_or_else(|error| panic!("{}", error.render(false)));
            assert!(job.moves() > 0);
            count += 1;
        }
    }
    assert!(count >= 3);
}

/// All coordinates become those of the part, program by program.
#[test]
fn set_ups_are_in_the_coordinates_of_the_part() {
    let text = r#"Job(
    units: Inch,
    stock: Block(min: (0, 0, 0), max: (4, 2, 1)),
    tools: { 1: Flat(radius: 0.1, length: 1), 2: Ball(radius: 0.1, length: 1) },
    setups: [
        Setup(paths: [Path(tool: 1, poses: [((1, 1, 2), (0, 0, 1)), ((3, 1, 2), (0, 0, 1))])]),
        Setup(
            name: "bottom",
            // Upside down: turned about x; zero is at the far lower corner of the bottom.
            frame: Frame(origin: (0, 2, 0), z: (0, 0, -1), x: (1, 0, 0)),
            fixtures: [Block(min: (0, 0, -1), max: (4, 0.5, 0))],
            paths: [
                Path(tool: 2, poses: [((1, 0.5, 0.25), (0, 0, 1))]),
                Path(tool: 1, frame: Frame(origin: (1, 0, 0), x: (0, 1, 0)), poses: [((0.5, 0, 0.25), (0, 0.6, 0.8))]),
            ],
        ),
    ],
)"#;
    let job = Job::parse(text, Path::new("part.ron")).unwrap();
    assert!(job.has_setups);
    let names: Vec<Option<String>> = (0..3).map(|number| job.setup_name(number)).collect();
    assert_eq!(names, [Some("1".to_owned()), Some("bottom".to_owned()), None]);
    let setups: Vec<(usize, u32)> = job.paths.iter().map(|path| (path.setup, path.tool)).collect();
    assert_eq!(setups, [(0, 1), (1, 2), (1, 1)]);
    let pose = |path: usize| job.paths[path].path.poses()[0];
    let inches = |p: [f64; 3]| p.map(|c| (c / 25.4 * 1e9).round() / 1e9);
    assert_eq!(inches(pose(0).tip()), [1.0, 1.0, 2.0]);
    assert_eq!(
        (inches(pose(1).tip()), pose(1).axis()),
        ([1.0, 1.5, -0.25], [0.0, 0.0, -1.0])
    );
    // The path's y is its set-up's −x.
    assert_eq!(inches(pose(2).tip()), [1.0, 1.5, -0.25]);
    let axis = pose(2).axis();
    assert!(
        (0..3).all(|k| (axis[k] - [-0.6, 0.0, -0.8][k]).abs() < 1e-15),
        "{axis:?}"
    );
    let fixture = Stock::Block {
        min: [0.0, 1.5 * 25.4, 0.0],
        max: [4.0 * 25.4, 2.0 * 25.4, 25.4],
    };
    assert_eq!(job.setups[1].fixtures, [fixture]);
    assert!(job.setups[0].fixtures.is_empty());
    // A grid from the stock, since stock and grid are the part's.
    assert_eq!(job.grid.max(), [4.0 * 25.4, 2.0 * 25.4]);

    let plain = Job::parse(crate::support::GOOD, Path::new("good.ron")).unwrap();
    assert_eq!(
        (plain.setups.len(), plain.has_setups, plain.setup_name(0)),
        (1, false, None)
    );
}

#[test]
fn paths_in_the_job_have_times_and_rapids() {
    let text = r#"Job(
    units: Inch,
    stock: Block(min: (0, 0, 0), max: (4, 2, 1)),
    tools: { 1: Flat(radius: 0.1, length: 1) },
    paths: [
        Path(tool: 1, feed: 30, moves: [
            Start(((0, 0, 2), (0, 0, 1))),
            Rapid(((3, 4, 2), (0, 0, 1))),
            Rapid(((3, 4, 2), (1, 0, 0))),
            Line(((3, 4, 1), (1, 0, 0))),
            Line(((3, 4, 1), (0, 0, 1))),
            Line(((3, 4, 1), (0, 0, 1))),
            Arc(to: ((3, 4, 1), (0, 0, 1)), centre: (2, 4, 0), turn: Ccw),
        ]),
        Path(tool: 1, poses: [((0, 0, 2), (0, 0, 1)), ((3, 4, 2), (0, 0, 1))]),
    ],
)"#;
    let job = Job::parse(text, Path::new("part.ron")).unwrap();
    let path = &job.paths[0];
    assert!(path.rapid.iter().eq([true, true, false, false, false, false]));
    assert!(path.assumed_rapids && !job.paths[1].assumed_rapids);
    // 5 inches at 10 m/min; a quarter turn at 7,200 degrees per minute; an inch at 30 inches per minute; a turn in
    // place; nothing; a circle.
    let expected = [
        Some(60.0 * 5.0 * 25.4 / 10_000.0),
        Some(60.0 * 90.0 / 7200.0),
        Some(2.0),
        None,
        Some(0.0),
        Some(2.0 * std::f64::consts::TAU),
    ];
    for (found, expected) in path.seconds.iter().zip(expected) {
        let same = match (found, expected) {
            (Some(found), Some(expected)) => (found - expected).abs() < 1e-9,
            (found, expected) => found == expected,
        };
        assert!(same, "{:?}", path.seconds);
    }
    assert!(job.paths[1].seconds.is_empty() && job.paths[1].rapid.iter().eq([false]));
    for (from, to, message) in [
        (
            "feed: 30",
            "feed: 0",
            "part.ron:6:29: feed is 0, but must be a positive number",
        ),
        (
            "Start(((0",
            "Rapid(((0",
            "expected `Start(..)` as the first of the moves",
        ),
        (
            "feed: 30, moves",
            "feed: 30, file: \"a.nc\", moves",
            "part.ron:6:29: `feed` with `file`",
        ),
    ] {
        let error = Job::parse(&text.replacen(from, to, 1), Path::new("part.ron"))
            .unwrap_err()
            .to_string();
        assert!(error.contains(message), "{error}");
    }
}

/// A contour along y = 1 (inches), compensated to the left, by three controls: D is 1, 7 or the tool's own.
#[test]
fn a_job_says_what_d_means() {
    let folder = tempfile::tempdir().unwrap();
    let fanuc = "G20 G90 G17\nT1 M6\nS900 M3\nG0 X-1 Y1 Z0\nG41 D7 G1 X0 Y1 F10\nX2\nG40 X3\nM30\n";
    let siemens = "G70 G90 G17\nT1 D1\nM6\nS900 M3\nG0 X-1 Y1 Z0\nG41 G1 X0 Y1 F10\nX2\nG40 X3\nM30\n";
    let klartext = "0 BEGIN PGM A INCH\n1 TOOL CALL 1 Z S900\n2 L X-1 Y+1 Z+0 R0 FMAX M3\n3 L X+0 Y+1 RL F10\n4 L X+2\n5 L X+3 R0\n6 END PGM A INCH\n";
    for (name, text, number, control) in [
        ("a.nc", fanuc, 7, "fanuc"),
        ("a.mpf", siemens, 1, "siemens"),
        ("a.h", klartext, 1, "heidenhain"),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
        let job = |more: &str| {
            let text = format!(
                r#"Job(units: Inch, grid: Grid(min: (-2, -2), max: (4, 4), cells: (6, 6)), stock: Block(min: (0, 0, -1), max: (2, 2, 0)),
                tools: {{ 1: Flat(radius: 0.25, length: 2) }}, paths: [Path(file: "{name}", controller: "{control}"{more})])"#
            );
            Job::parse(&text, &folder.path().join("job.ron"))
        };
        let message = job(", strict: true").unwrap_err().to_string();
        assert!(
            message.contains("compensation") || message.contains("radius"),
            "{message}"
        );
        // Without it, it is the size of the job's tool, which a note says.
        let assumed = job("").unwrap();
        let mut notes = assumed.paths.iter().flat_map(|path| &path.notes);
        assert!(
            notes.any(|note| note.message.contains("the size of tool 1, 0.5 across")),
            "{control}"
        );
        for diameter in [0.5, 0.0] {
            let read = job(&format!(", diameters: {{{number}: {diameter:?}}}")).unwrap();
            let tips = read
                .paths
                .iter()
                .flat_map(|path| path.path.poses())
                .map(|pose| pose.tip());
            let highest = tips.map(|tip| tip[1]).fold(f64::MIN, f64::max);
            assert!(
                (highest - 25.4 * (1.0 + 0.5 * diameter)).abs() < 1e-9,
                "{control}: {highest}"
            );
        }
        let message = job(&format!(", diameters: {{{number}: -1}}")).unwrap_err().to_string();
        assert!(
            message.contains("a diameter is -1, but must be a positive number, or 0"),
            "{message}"
        );
    }
}

#[test]
fn a_job_places_work_offsets() {
    let folder = tempfile::tempdir().unwrap();
    let text = "G20 G54 G0 X0 Y0 Z1.\nG1 Z0. F10.\nG55 G0 X0 Y0 Z1.\nG1 Z0.\n";
    std::fs::write(folder.path().join("a.nc"), text).unwrap();
    let job = |more: &str| {
        let text = format!(
            r#"Job(units: Inch, grid: Grid(min: (-2, -2), max: (9, 4), cells: (6, 6)), stock: Block(min: (0, 0, -1), max: (2, 2, 0)),
            tools: {{ 1: Flat(radius: 0.25, length: 2) }}, paths: [Path(tool: 1, file: "a.nc"{more})])"#
        );
        Job::parse(&text, &folder.path().join("job.ron"))
    };
    let ends = |more: &str| -> Vec<f64> {
        let read = job(more).unwrap();
        let tips = read
            .paths
            .iter()
            .flat_map(|path| path.path.poses())
            .map(|pose| pose.tip());
        tips.map(|tip| tip[0]).collect()
    };
    // In inches, as the job is.
    assert_eq!(ends(", offsets: {\"G55\": (5, 0, 0)}"), [0.0, 0.0, 127.0, 127.0]);
    assert_eq!(ends(""), [0.0, 0.0]);
    let said = job("").unwrap();
    assert!(
        said.paths[0]
            .notes
            .iter()
            .any(|note| note.message.contains("the place of G55"))
    );
    let refused = job(", strict: true").unwrap_err().to_string();
    assert!(refused.contains("a move in G55"), "{refused}");
    let bad = job(", offsets: {\"G55\": (inf, 0, 0)}").unwrap_err().to_string();
    assert!(bad.contains("a work offset is inf, but must be three numbers"), "{bad}");
}

/// A machine says whether its programs begin under tip control; a path may say otherwise.
#[test]
fn tip_control_is_that_of_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let machine = |on: bool| {
        let table = "table: [(letter: 'A', axis: (1, 0, 0), pivot: (0, 0, -50))]";
        format!("Machine(name: \"m\", {table}, tip_control: {on})")
    };
    std::fs::write(folder.path().join("on.ron"), machine(true)).unwrap();
    std::fs::write(folder.path().join("off.ron"), machine(false)).unwrap();
    std::fs::write(folder.path().join("a.nc"), "G21 G0 X0 Y0 Z0 A90\nG1 X10 F100\n").unwrap();
    let tip = |fields: &str| {
        let text = format!(
            r#"Job(grid: Grid(min: (-2, -2), max: (9, 4), cells: (6, 6)), stock: Block(min: (0, 0, -1), max: (2, 2, 0)),
            tools: {{ 1: Flat(radius: 0.25, length: 2) }}, paths: [Path(tool: 1, file: "a.nc", {fields})])"#
        );
        let job = Job::parse(&text, &folder.path().join("job.ron")).unwrap();
        job.paths[0].path.poses()[0].tip()
    };
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    // Without tip control, the zero point goes by a quarter turn about a point 50 mm below it.
    let turned = [0.0, -50.0, -50.0];
    for (fields, expected) in [
        ("machine: \"on.ron\"", [0.0; 3]),
        ("machine: \"on.ron\", tip_control: false", turned),
        ("machine: \"off.ron\"", turned),
        ("machine: \"off.ron\", tip_control: true", [0.0; 3]),
    ] {
        let found = tip(fields);
        assert!(near(found, expected), "{fields}: {found:?}");
    }
}

/// A rapid that turns an axis without tip control may be a dog-leg from its start to its end, if the machine does not
/// say: one course, whose corner is where the first axis arrives.
#[test]
fn a_rapid_that_turns_may_be_one_dog_leg() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "Machine(name: \"m\", linear: [(letter: 'X', speed: 10000)], table: [(letter: 'A', axis: (1, 0, 0), \
                   pivot: (0, 0, -50), speed: 3600)])";
    std::fs::write(folder.path().join("m.ron"), machine).unwrap();
    std::fs::write(
        folder.path().join("a.nc"),
        "G21 G0 X0 Y0 Z0\nX50 A90\nX0 A0\nG1 X1 F100\n",
    )
    .unwrap();
    let text = r#"Job(grid: Grid(min: (-2, -2), max: (9, 4), cells: (6, 6)), stock: Block(min: (0, 0, -1), max: (2, 2, 0)),
        tools: { 1: Flat(radius: 0.25, length: 2) }, paths: [Path(tool: 1, file: "a.nc", machine: "m.ron")])"#;
    let job = Job::parse(text, &folder.path().join("job.ron")).unwrap();
    let path = &job.paths[0];
    let courses: Vec<_> = path.other_courses.of(0..path.path.moves()).collect();
    assert_eq!(courses.len(), 2, "one for each block");
    // X arrives after 0.3 s, when A is at 18°: the tip has gone by as much about a point 50 mm below it.
    let (sine, cosine) = 18.0_f64.to_radians().sin_cos();
    let corner = [50.0, -50.0 * sine, 50.0 * cosine - 50.0];
    let near = |tip: [f64; 3]| tip.iter().zip(corner).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(
        courses[0].path.poses().iter().any(|pose| near(pose.tip())),
        "{:?}",
        courses[0]
    );
    assert!(!path.path.poses().iter().any(|pose| near(pose.tip())));
}
