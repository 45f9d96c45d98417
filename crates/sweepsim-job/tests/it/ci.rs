//! Outcomes for continuous integration.

use crate::walls::{request, slotted};
use std::path::Path;
use sweepsim_job::dexel::Stock;
use sweepsim_job::motion::{Body, BodyKind, Profile, ProfileSegment, Tool};
use sweepsim_job::{AnnotationLevel, CiProgram, Directions, Judging, Memory, Outcome, Request};

fn root() -> &'static Path {
    Path::new("/shop")
}

fn ci(request: Request) -> (Outcome, CiProgram) {
    let outcome = request.plan().unwrap().run(&()).unwrap();
    let written = outcome.write_to(&mut Memory::default(), &[], &()).unwrap();
    let ci = outcome.ci(&written, root());
    (outcome, ci)
}

/// Each case: `gouge` with the number of its annotations, or what is needed.
fn cases(ci: &CiProgram) -> Vec<String> {
    let one = |case: &sweepsim_job::CiCase| match &case.needs {
        Some(needs) => format!("{}: needs {needs}", case.name),
        None => format!("{}: {}", case.name, case.annotations.len()),
    };
    ci.cases.iter().map(one).collect()
}

const PROGRAM: &str = "T1 M6\nS900 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX20\nG0 Y20\nG0 Z5\nM30\n";

fn program(text: &str) -> Request {
    Request::from_program("parts/slot.nc", text)
        .tool(1, Tool::flat(3.0, 20.0).unwrap())
        .cells([20, 20])
}

#[test]
fn what_was_not_looked_at_is_skipped() {
    let (_, ci) = ci(program(&PROGRAM.replace("G0 Y20\n", "")));
    assert_eq!(ci.file, Path::new("parts/slot.nc"));
    let expected = [
        "gouge: needs --target FILE",
        "excess: needs --target FILE",
        "collision: needs a library with holders (--tools), or a job with `bodies`",
        "fixture: needs a job with `fixtures`",
        "rapid: 0",
        "rapid: rapids through the real stock: it was guessed: needs --stock",
        "spindle: 0",
        "feed: 0",
        "machine: needs a machine with bodies (--machine, or `machine` in the job)",
        "limit: needs a machine with limits (--machine, or `machine` in the job)",
    ];
    assert_eq!(cases(&ci), expected);
}

#[test]
fn findings_are_at_their_lines() {
    let stock = Stock::Block {
        min: [-10.0, -10.0, -5.0],
        max: [30.0, 30.0, 0.0],
    };
    let (outcome, ci) = ci(program(PROGRAM).stock(stock));
    let rapid = ci.cases.iter().find(|case| case.name == "rapid").unwrap();
    // On the lines; between them, as what rapids remove counts as left, when the tool withdraws; and by the statement.
    let [finding, withdrawn, statement] = &rapid.annotations[..] else {
        panic!("{rapid:?}")
    };
    for one in [finding, statement] {
        assert_eq!((one.rule.as_str(), one.level), ("rapid", AnnotationLevel::Harm));
        assert_eq!((one.file.as_path(), one.line), (Path::new("parts/slot.nc"), Some(6)));
        assert_eq!(one.text.as_deref(), Some("G0 Y20"));
    }
    assert_eq!(
        (withdrawn.line, withdrawn.message.contains("seen between the lines")),
        (Some(7), true)
    );
    let expected = "Rapid move through material: cutter of tool 1, 1.00000 mm deep at ";
    assert!(finding.message.starts_with(expected), "{}", finding.message);
    assert!(
        statement.message.starts_with("A rapid goes deeper into the stock"),
        "{}",
        statement.message
    );
    assert_eq!(outcome.findings().len(), 2);
}

/// What comes after the first finding was not looked at.
#[test]
fn after_the_first_nothing_is_passed() {
    let mut judging = Judging::default();
    judging.first = true;
    let (_, ci) = ci(program(PROGRAM).judging(judging));
    let came = cases(&ci);
    assert!(came.contains(&"rapid: 1".to_owned()), "{came:?}");
    assert!(
        came.contains(&"spindle: needs a run without --first".to_owned()),
        "{came:?}"
    );
    assert!(!came.iter().any(|case| case.ends_with(": 0")), "{came:?}");
}

/// Excess is a place of the part: it has no line.
#[test]
fn a_place_without_a_line_is_about_the_program() {
    let line = |to| ProfileSegment::Line { to };
    let outline = vec![line([10.0, 30.0]), line([10.0, 60.0]), line([0.0, 60.0])];
    let holder = Tool::from_profile(Profile::new([0.0, 30.0], outline).unwrap());
    let body = Body {
        kind: BodyKind::Holder,
        solid: holder,
    };
    let (_, ci) = ci(request(slotted([15.0, 25.0], -5.0)).bodies(1, [body]));
    let of = |name: &str| ci.cases.iter().find(|case| case.name == name).unwrap();
    let excess = of("excess");
    assert!(excess.needs.is_none() && !excess.annotations.is_empty(), "{excess:?}");
    for one in &excess.annotations {
        assert_eq!((&one.file, one.line), (&ci.file, None));
        assert!(!one.message.contains("deep"), "{}", one.message);
    }
    assert!(of("collision").annotations.is_empty() && of("collision").needs.is_none());
}

/// All problems of a program, each with its columns.
#[test]
fn what_cannot_be_read_is_at_its_line() {
    let broken = "G21\nT1 M6\nG1 X=(3 F100\nG2 X5 R\nM30\n";
    let request = Request::from_program("parts/slot.nc", broken).tool(1, Tool::flat(3.0, 20.0).unwrap());
    let error = request.plan().unwrap_err();
    let ci = error.ci(Path::new("parts/slot.nc"), root());
    let [case] = &ci.cases[..] else { panic!("{ci:?}") };
    assert_eq!((case.name.as_str(), case.needs.as_ref()), ("input", None));
    let first = &case.annotations[0];
    assert_eq!((first.level, first.line), (AnnotationLevel::Input, Some(3)), "{case:?}");
    assert_eq!(first.file, Path::new("parts/slot.nc"));
    assert!(first.columns.is_some() && !first.message.contains("slot.nc"));
}

/// Pins that no line meets, in the way of a holder.
#[test]
fn between_the_lines_the_part_of_the_tool_and_the_begin_are_not_known() {
    let block = |min, max| Stock::Block { min, max };
    let body = |kind, low: f64, high: f64, radius: f64| {
        let line = |to| ProfileSegment::Line { to };
        let outline = vec![line([radius, low]), line([radius, high]), line([0.0, high])];
        let solid = Tool::from_profile(Profile::new([0.0, low], outline).unwrap());
        Body { kind, solid }
    };
    let bodies = [
        body(BodyKind::Shank, 6.0, 8.0, 2.0),
        body(BodyKind::Holder, 8.0, 20.0, 8.0),
    ];
    let program = "T1 M6\nS900 M3\nG0 X-20 Y2 Z0.2\nG1 X60 F100\nM30\n";
    let stock = Stock::Union(vec![
        block([0.0, 0.0, -10.0], [40.0, 30.0, 0.0]),
        block([20.05, 5.05, -1.0], [20.2, 5.2, 9.0]),
    ]);
    let request = Request::from_program("parts/pins.nc", program)
        .tool(1, Tool::flat(2.0, 6.0).unwrap())
        .bodies(1, bodies)
        .cells([40, 30])
        .stock(stock)
        .fixture(block([30.05, -4.45, 0.0], [30.2, -4.3, 9.0]));
    let (outcome, ci) = ci(request.directions(Directions::Z));
    let collision = ci.cases.iter().find(|case| case.name == "collision").unwrap();
    let message = &collision.annotations[0].message;
    assert!(message.starts_with("Shank or holder hits the workpiece: "), "{message}");
    assert!(message.contains("seen between the lines, at "), "{message}");
    let statements = outcome.report().statements.as_ref().unwrap();
    for (about, part) in [("collision", "shank or holder"), ("fixture", "cutter, shank or holder")] {
        let statement = statements.iter().find(|statement| statement.about == about).unwrap();
        assert_eq!(statement.witness.as_ref().unwrap().body.as_deref(), Some(part));
    }
}
