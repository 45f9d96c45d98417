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
