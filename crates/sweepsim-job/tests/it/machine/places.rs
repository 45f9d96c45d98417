//! Bodies at home, and on the ways that programs leave to the machine: to its homes, in its coordinates, to where
//! tools are changed.

use super::{Request, SIZES, run};
use sweepsim_job::dexel::Stock;
use sweepsim_job::motion::Tool;
use sweepsim_job::{Outcome, ProgramOptions, StatementState};
use sweepsim_nc::Machine;

const STOCK: [[f64; 3]; 2] = [[-40.0, -30.0, -50.0], [40.0, 30.0, 0.0]];

/// A mill with a post on its table, over whose zero the nose is at home.
fn mill(post: [[f64; 3]; 2], more: &str) -> String {
    let block = |name: &str, on: &str, [min, max]: [[f64; 3]; 2]| {
        let show = |p: [f64; 3]| format!("({}, {}, {})", p[0], p[1], p[2]);
        format!(
            r#"(name: "{name}", on: "{on}", shape: Block(min: {}, max: {}))"#,
            show(min),
            show(max)
        )
    };
    let bodies = [
        block("table", "X", [[-300.0, -200.0, -560.0], [300.0, 200.0, -500.0]]),
        block("post", "X", post),
        r#"(name: "spindle", on: "Z", shape: Cylinder(from: (0, 0, 0), to: (0, 0, 150), radius: 60))"#.to_owned(),
    ];
    format!(
        "Machine(name: \"mill\", part_zero: (0, 0, -450), tool_length: 100, rapid: Straight, bodies: [{}], \
         linear: [(letter: 'X', carries: Part, home: 0), (letter: 'Y', carries: Part, home: 0), \
         (letter: 'Z', limits: (-500, 0), home: 0)], {more})",
        bodies.join(", ")
    )
}

fn request(machine: &str, program: &str) -> Request {
    let mut options = ProgramOptions::default();
    options.dialect.machine = Some(written(machine));
    Request::from_program("ways.nc", program)
        .program(options)
        .tool(1, Tool::flat(5.0, 60.0).unwrap())
        .tool(2, Tool::flat(5.0, 60.0).unwrap())
        .stock(Stock::Block {
            min: STOCK[0],
            max: STOCK[1],
        })
        .cells([8, 8])
}

/// The name of a file with a machine.
pub fn written(machine: &str) -> String {
    let file = std::env::temp_dir().join(format!("sweepsim-{}-{:x}.ron", std::process::id(), digest(machine)));
    std::fs::write(&file, machine).unwrap();
    file.display().to_string()
}

fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

pub fn state(outcome: &Outcome) -> StatementState {
    let statements = outcome.report().statements.as_ref().expect("proofs");
    let own = statements.iter().find(|statement| statement.about == "machine");
    own.expect("bodies").state
}

/// The lines at which bodies meet, with their names.
pub fn met(outcome: &Outcome) -> Vec<(usize, String)> {
    let own = outcome.findings().iter().filter(|finding| finding.kind == "machine");
    own.map(|finding| (finding.line.expect("a line"), finding.bodies.join("-")))
        .collect()
}

/// A post as high as the nose at home, beside it, or in it.
#[test]
fn bodies_that_overlap_at_home_are_refused_with_their_depth() {
    let post = |x: f64, top: f64| [[x, -20.0, -500.0], [x + 40.0, 20.0, top]];
    let plan = |machine: &str| request(machine, "T1 M6\nG0 X0 Y0 Z100\nM30\n").plan().map(|_| ());
    assert!(plan(&mill(post(70.0, 30.0), "")).is_ok());
    let error = plan(&mill(post(30.0, 12.0), "")).unwrap_err().to_string();
    for part in [
        "post and spindle",
        "overlap, by at most 12.000 mm",
        "with all axes at home",
        "may_touch",
    ] {
        assert!(error.contains(part), "{error}");
    }
    let error = plan(&mill(post(30.0, 0.0), "")).unwrap_err().to_string();
    assert!(
        error.contains("post and spindle of the machine mill touch with"),
        "{error}"
    );
    assert!(plan(&mill(post(30.0, 12.0), "may_touch: [(\"spindle\", \"post\")]")).is_ok());
    for name in Machine::names() {
        for sizes in [
            SIZES,
            ",table=500,travel=800x700x600,zero=120,length=180",
            ",travel=400x300x250,zero=20,length=60",
        ] {
            let program = "T1 M6\nG0 X0 Y0 Z0\nM30\n";
            let made = super::planned(&format!("{name}{sizes}"), program, STOCK).map(|_| ());
            assert!(
                made.is_ok(),
                "{name}{sizes}: {:?}",
                made.err().map(|error| error.to_string())
            );
        }
    }
}

/// A post at X 200 that reaches 60 mm above the part's zero: the spindle goes around it, or through it, by ways that
/// no block has as its own end.
#[test]
fn ways_between_paths_are_looked_at() {
    let post = [[180.0, -20.0, -500.0], [220.0, 20.0, -200.0]];
    let ends = "M30\n";
    // The tip at Z 20, the nose at 120: beside the post, which reaches to 250.
    for (way, expected) in [
        // Up first, then over it.
        ("G91 G28 Z0\nG90\nG28 X0 Y0\n", None),
        // Home along X: through it.
        ("G91 G28 X0\nG90\n", Some(6)),
        ("G90\nG53 G0 X0\n", Some(7)),
        ("G90\nG53 G0 Z0\nG53 X0\n", None),
        // Tools are changed at X 0: up first.
        ("T2 M6\nG0 X10\n", None),
    ] {
        let program = format!("G21 G90\nT1 M6\nG0 X320 Y0\nG0 Z20\nS900 M3\n{way}{ends}");
        let outcome = request(&mill(post, "tool_change: [{'Z': 0}, {'X': 0}]"), &program)
            .plan()
            .unwrap()
            .run(&())
            .unwrap();
        let lines: Vec<usize> = met(&outcome).iter().map(|(line, _)| *line).collect();
        match expected {
            None => assert_eq!((state(&outcome), lines), (StatementState::Proven, vec![]), "{way}"),
            Some(line) => assert!(
                !lines.is_empty() && lines.iter().all(|own| *own == line),
                "{way}: {lines:?}"
            ),
        }
    }
    // Tools are changed at X 0, along X first: the cutter and the spindle go through the post.
    let program = "G21 G90\nT1 M6\nG0 X320 Y0\nG0 Z20\nS900 M3\nT2 M6\nG0 X10\nM30\n";
    let outcome = request(&mill(post, "tool_change: [{'X': 0}, {'Z': 0}]"), program)
        .plan()
        .unwrap()
        .run(&())
        .unwrap();
    let found = met(&outcome);
    assert!(
        !found.is_empty() && found.iter().all(|(line, _)| *line == 6),
        "{found:?}"
    );
    assert!(found.iter().any(|(_, names)| names == "post-spindle"), "{found:?}");
    // Where a tool is changed is not said: the way there is a note with its line, and no finding.
    let outcome = request(&mill(post, ""), program).plan().unwrap().run(&()).unwrap();
    assert!(met(&outcome).is_empty());
    let notes = &outcome.report().notes;
    assert!(
        notes
            .iter()
            .any(|note| note.contains("line 6") && note.contains("not looked at")),
        "{notes:?}"
    );
}

/// A rapid home whose axes arrive one after the other: straight it is free, as a dog-leg it meets a post.
#[test]
fn dog_legs_home_are_looked_at() {
    let post = [[140.0, -60.0, -500.0], [160.0, -40.0, -200.0]];
    let program = "G21 G90\nT1 M6\nG0 Y200\nG0 X320\nG0 Z20\nS900 M3\nG28 X320 Y200\nM30\n";
    for (rapid, lines) in [("Straight", vec![]), ("DogLeg", vec![7])] {
        let machine = mill(post, "").replace("rapid: Straight", &format!("rapid: {rapid}"));
        let outcome = request(&machine, program).plan().unwrap().run(&()).unwrap();
        let mut found: Vec<usize> = met(&outcome).iter().map(|(line, _)| *line).collect();
        found.dedup();
        assert_eq!(
            found,
            lines,
            "{rapid}: {:?} {:?}",
            state(&outcome),
            outcome.report().axes
        );
    }
}

/// The page and the times know the ways, too.
#[test]
fn ready_machines_go_home() {
    let program = "G21 G90\nT1 M6\nS900 M3\nG0 X30 Y20\nG0 Z200\nG91 G28 Z0\nG28 X0 Y0\nM30\n";
    let outcome = run(&format!("3-axis{SIZES}"), program, STOCK);
    assert_eq!(state(&outcome), StatementState::Proven);
    let axes = outcome.report().axes.as_ref().expect("travel");
    let range = |letter: char| axes.iter().find(|axis| axis.letter == letter).expect("an axis").range;
    // Zero is 450 below home, the tool 100 long.
    assert_eq!((range('X'), range('Z')), ([0.0, 30.0], [-150.0, 0.0]));
}

/// A path that begins beyond a limit does so at the start of its first move, with the tip where it is then.
#[test]
fn a_path_begins_beyond_a_limit() {
    let machine = "Machine(name: \"mill\", linear: [(letter: 'X', limits: (-100, 100))])";
    let program = "G21 G90\nT1 M6\nS900 M3\nG0 X-120 Y0 Z50\nG1 X20 F500\nX130\nM30\n";
    let outcome = request(machine, program).plan().unwrap().run(&()).unwrap();
    // The second move of 110 mm is beyond the limit after 80 mm.
    let expected = [(5, 0.0, -120.0), (6, 80.0 / 110.0, 100.0)];
    assert_eq!(outcome.findings().len(), expected.len());
    for (finding, (line, time, x)) in outcome.findings().iter().zip(expected) {
        assert_eq!((finding.kind.as_str(), finding.line), ("limit", Some(line)));
        assert!((finding.time.unwrap() - time).abs() < 1e-9, "{finding:?}");
        assert!((finding.place[0] - x).abs() < 1e-6, "{finding:?}");
    }
}
