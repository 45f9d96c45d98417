//! What a verdict says that it is about.

use crate::walls::{request, slotted};
use sweepsim_formats::{Scope, ScopeLines};
use sweepsim_job::dexel::Stock;
use sweepsim_job::motion::{Body, BodyKind, Profile, ProfileSegment, Tool};
use sweepsim_job::{Directions, Judging, Memory, Outcome, Output, Request, Verdict, words};

fn run(request: Request) -> Outcome {
    request.plan().unwrap().run(&()).unwrap()
}

/// What was not looked at.
fn not_at(outcome: &Outcome) -> Vec<&str> {
    let scope = outcome.report().scope.as_ref().unwrap();
    scope.not_looked_at.iter().map(|missing| &missing.about[..]).collect()
}

fn page(outcome: &Outcome) -> String {
    let mut made = Memory::default();
    outcome.write_to(&mut made, &[Output::Report], &()).unwrap();
    String::from_utf8(made.0["report.html"].clone()).unwrap()
}

/// A holder above the stock, and a clamp beside the path.
fn complete(request: Request) -> Request {
    let line = |to| ProfileSegment::Line { to };
    let outline = vec![line([10.0, 30.0]), line([10.0, 60.0]), line([0.0, 60.0])];
    let holder = Tool::from_profile(Profile::new([0.0, 30.0], outline).unwrap());
    request
        .bodies(
            1,
            [Body {
                kind: BodyKind::Holder,
                solid: holder,
            }],
        )
        .fixture(Stock::Block {
            min: [0.0, 45.0, -10.0],
            max: [60.0, 50.0, 5.0],
        })
}

#[test]
fn what_nobody_asked_for_is_named() {
    let bare = Request::from_program("slot.nc", "T1 M6\nS900 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX20\nG0 Z5\nM30\n");
    let bare = run(bare.tool(1, Tool::flat(3.0, 20.0).unwrap()).cells([20, 10]));
    assert_eq!(bare.verdict(), Some(Verdict::Pass));
    let expected = [
        "gouges and excess",
        "shanks and holders",
        "fixtures",
        "rapids through the real stock: it was guessed",
    ];
    assert_eq!(not_at(&bare), expected);
    let page = page(&bare);
    assert!(page.contains("class=\"verdict partial\""), "not green");
    assert!(page.contains("not everything was looked at"));
    for about in expected {
        assert!(page.contains(&format!("not looked at: {about}")), "{about}");
    }
    assert!(!page.contains("May be run"));
}

#[test]
fn all_that_was_asked_for_is_green() {
    let complete = || complete(request(slotted([15.0, 25.0], -4.0)));
    let mut judging = Judging::default();
    judging.proof = false;
    let on_lines = run(complete().judging(judging));
    assert_eq!(on_lines.verdict(), Some(Verdict::Pass));
    assert_eq!(on_lines.report().scope.as_ref().unwrap().extent, "lines");
    assert!(page(&on_lines).contains("on the lines that were looked at"));
    let outcome = run(complete());
    assert_eq!(outcome.verdict(), Some(Verdict::Pass));
    assert_eq!(not_at(&outcome), [""; 0]);
    let scope = outcome.report().scope.as_ref().unwrap();
    assert_eq!(scope.extent, "everywhere");
    let along: Vec<&str> = scope.lines.iter().map(|lines| &lines.along[..]).collect();
    assert_eq!(along, ["z", "x", "y"]);
    let page = page(&outcome);
    assert!(page.contains("class=\"verdict good\""));
    assert!(page.contains("proven everywhere"));
    assert!(page.contains("1 mm apart; between them, gouges"), "{:?}", scope.lines);
}

/// A tool that no path uses needs no holder; one that is used is named.
#[test]
fn only_tools_that_are_used_are_missed() {
    for (tools, expected) in [
        (vec![1], None),
        (vec![1, 2], Some("shank and holder of the tool 2")),
        (vec![1, 2, 3], Some("shanks and holders of the tools 2, 3")),
        (vec![2, 3], Some("shanks and holders")),
    ] {
        let path = |tool: i32| {
            format!(
                "Path(tool: {tool}, poses: [((0.0, 0.0, 3.0), (0.0, 0.0, 1.0)), ((9.0, 0.0, 3.0), (0.0, 0.0, 1.0))]), "
            )
        };
        let paths: String = tools.into_iter().map(path).collect();
        let text = format!(
            "Job(
                tolerance: 1e-4,
                grid: Grid(min: (0.0, 0.0), max: (10.0, 10.0), cells: (10, 10)),
                stock: Block(min: (0.0, 0.0, 0.0), max: (10.0, 10.0, 5.0)),
                tools: {{ 1: Flat(radius: 2.0, length: 20.0), 2: Ball(radius: 2.0, length: 20.0), 3: Ball(radius: 1.0, length: 20.0) }},
                bodies: {{ 1: [ Holder(Profile(start: (0.0, 20.0), segments: [ Line((5.0, 20.0)), Line((5.0, 30.0)), Line((0.0, 30.0)) ])) ] }},
                paths: [ {paths} ],
            )"
        );
        let outcome = run(Request::from_job("job.ron", text));
        let named = not_at(&outcome).into_iter().find(|about| about.starts_with("shank"));
        assert_eq!(named, expected);
    }
}

#[test]
fn directions_are_those_that_were_looked_along() {
    let along = |request: Request| {
        let outcome = run(request);
        let scope = outcome.report().scope.clone().unwrap();
        scope.lines.into_iter().map(|lines| lines.along).collect::<String>()
    };
    let walls = || request(slotted([15.0, 25.0], -4.0));
    assert_eq!(along(walls()), "zxy");
    assert_eq!(along(walls().directions(Directions::Z)), "z");
    assert_eq!(along(walls().directions(Directions::Xyz)), "zxy");
}

/// Lines whose spacings differ by rounding are named together.
#[test]
fn lines_equally_far_apart_are_named_together() {
    let mut scope = Scope::default();
    let spacings = [("z", [0.4, 0.4]), ("x", [0.4 + 1e-15, 0.4]), ("y", [0.4, 0.4 - 1e-15])];
    for (along, spacing) in spacings {
        let mut lines = ScopeLines::default();
        (lines.along, lines.spacing) = (along.to_owned(), spacing);
        scope.lines.push(lines);
    }
    assert_eq!(words::looked_at(&scope), "along z, x and y 0.4 mm apart");
}

/// Cells that are given, by their number or by their side, are not said to be guessed.
#[test]
fn cells_that_are_given_are_no_guess() {
    let program = || {
        let text = "T1 M6\nS900 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX20\nG0 Z5\nM30\n";
        Request::from_program("slot.nc", text).tool(1, Tool::flat(3.0, 20.0).unwrap())
    };
    let guessed = |request: Request| -> Vec<String> {
        let plan = request.plan().unwrap();
        plan.guessed().iter().map(|guess| guess.about.clone()).collect()
    };
    assert_eq!(guessed(program()), ["stock", "grid"]);
    assert_eq!(guessed(program().cells([20, 10])), ["stock"]);
    assert_eq!(guessed(program().cell(2.0)), ["stock"]);
}

/// Of a program that is judged on no material, nothing is decided: whether the grid is beside the stock, or the stock
/// between the lines.
#[test]
fn without_material_on_any_line_nothing_is_decided() {
    let along = |[from, to]: [f64; 2], stock: &str, directions| {
        let job = format!(
            "Job(
                grid: Grid(min: ({from}, 0), max: ({to}, 40), cells: (20, 40)),
                stock: {stock},
                tools: {{1: Flat(radius: 5, length: 30)}},
                paths: [Path(tool: 1, moves: [Start(((-8, 20, -4), (0, 0, 1))), Line(((68, 20, -4), (0, 0, 1)))])],
            )"
        );
        run(Request::from_job("slot.ron", job).directions(directions))
    };
    let block = "Block(min: (0, 0, -10), max: (60, 40, 0))";
    let plate = "Block(min: (30.6, 0, -10), max: (30.9, 40, 0))";
    let told = |outcome: &Outcome| words::answer(outcome.report()).unwrap();
    let beside = along([100.0, 120.0], block, Directions::Z);
    let between = along([20.0, 40.0], plate, Directions::Z);
    for (outcome, why) in [
        (&beside, "none of the stock is on the grid"),
        (&between, "no line of the dexels meets the stock"),
    ] {
        assert_eq!(outcome.verdict(), Some(Verdict::Undecided));
        let said = told(outcome);
        assert_eq!(said, format!("UNDECIDED: nothing was looked at, since {why}"));
        let page = page(outcome);
        assert!(
            page.contains(&format!("Not decided: nothing was looked at, since {why}.")),
            "{why}"
        );
        let mut made = Memory::default();
        let written = outcome.write_to(&mut made, &[], &()).unwrap();
        let ci = outcome.ci(&written, std::path::Path::new(""));
        let needs = |kind: &str| ci.cases.iter().find(|case| case.name == kind).unwrap().needs.is_some();
        assert!(needs("rapid") && needs("collision"), "{:?}", ci.cases);
        let open = ci.cases.iter().flat_map(|case| &case.annotations);
        let open: Vec<_> = open.map(|one| (&one.rule[..], &one.message[..])).collect();
        assert_eq!(
            open,
            [(
                "unresolved",
                &words::capital(&format!("nothing was looked at, since {why}"))[..]
            )]
        );
    }
    // On lines along x there is some of the plate, and of the block on a part of the grid.
    for outcome in [
        along([20.0, 40.0], plate, Directions::Xyz),
        along([50.0, 70.0], block, Directions::Z),
    ] {
        assert_eq!(outcome.verdict(), Some(Verdict::Pass), "{}", told(&outcome));
    }
}

/// A run that looks for the first finding and finds none compares the whole part, along all its directions.
#[test]
fn without_a_first_finding_the_part_is_compared() {
    let first = |walls: [f64; 2]| {
        let mut judging = Judging::default();
        (judging.first, judging.proof) = (true, false);
        request(slotted(walls, -4.0)).judging(judging)
    };
    let run = |walls: [f64; 2], directions: Directions| run(first(walls).directions(directions));
    // 0.1 mm is left on each wall, between the lines along z.
    let left = run([14.9, 25.1], Directions::Xyz);
    assert_eq!(left.verdict(), Some(Verdict::Fail));
    assert!(left.findings().iter().all(|found| found.kind == "excess"));
    assert!((left.report().excess.unwrap().max - 0.1).abs() < 1e-6);
    assert!(not_at(&left).iter().all(|about| !about.starts_with("excess")));
    let along_z = run([14.9, 25.1], Directions::Z);
    assert_eq!(along_z.verdict(), Some(Verdict::Pass));
    let lines = |outcome: &Outcome| outcome.report().scope.as_ref().unwrap().lines.len();
    assert_eq!([lines(&left), lines(&along_z)], [3, 1]);
    // Without directions it is said that walls were not looked at.
    let unasked = first([14.9, 25.1]).plan().unwrap().run(&()).unwrap();
    assert_eq!(unasked.verdict(), Some(Verdict::Pass));
    assert_eq!(lines(&unasked), 1);
    assert!(not_at(&unasked).contains(&"excess on walls"));
    // What is left is not known if a gouge ends the run.
    let gouged = run([15.1, 24.9], Directions::Xyz);
    assert!(gouged.findings().iter().all(|found| found.kind == "gouge"));
    assert!(not_at(&gouged).contains(&"excess"));
}
