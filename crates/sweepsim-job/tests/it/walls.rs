//! A slot between lines 1 mm apart: faults of its walls are narrower than that, and found all the same.

use sweepsim_job::dexel::{Stock, TriangleSoup};
use sweepsim_job::motion::Tool;
use sweepsim_job::{Directions, Judging, Outcome, Request, StatementState, Verdict};

/// A slot along x, 10 mm wide about y = 20 and 4 mm deep, by an end mill of 10 mm.
pub const PROGRAM: &str = "G21 G90\nT1 M6\nS6000 M3\nG0 X-8 Y20 Z5\nG0 Z-4\nG1 X68 F500\nG0 Z5\nM30\n";
const LIMIT: f64 = 0.02;

/// A block of 60 × 40 × 10 mm with a slot along x: its sides and its floor.
pub fn slotted([near, far]: [f64; 2], floor: f64) -> TriangleSoup {
    let outline = [
        [0.0, -10.0],
        [40.0, -10.0],
        [40.0, 0.0],
        [far, 0.0],
        [far, floor],
        [near, floor],
        [near, 0.0],
        [0.0, 0.0],
    ];
    let caps = [[1, 2, 3], [1, 3, 4], [1, 4, 5], [1, 5, 0], [0, 5, 6], [0, 6, 7]];
    let at = |x: f64, n: usize| [x, outline[n][0], outline[n][1]];
    let mut triangles = Vec::new();
    for [a, b, c] in caps {
        triangles.push([at(60.0, a), at(60.0, b), at(60.0, c)]);
        triangles.push([at(0.0, a), at(0.0, c), at(0.0, b)]);
    }
    for n in 0..8 {
        let m = (n + 1) % 8;
        triangles.push([at(0.0, n), at(0.0, m), at(60.0, m)]);
        triangles.push([at(0.0, n), at(60.0, m), at(60.0, n)]);
    }
    let soup = TriangleSoup { triangles };
    assert_eq!(soup.check_closed(), Ok(()));
    soup
}

pub fn request(target: TriangleSoup) -> Request {
    complete(Request::from_program("slot.nc", PROGRAM), target)
}

/// With tool, stock, target and limits.
pub fn complete(request: Request, target: TriangleSoup) -> Request {
    request
        .tool(1, Tool::flat(5.0, 30.0).unwrap())
        .stock(Stock::Block {
            min: [0.0, 0.0, -10.0],
            max: [60.0, 40.0, 0.0],
        })
        .target(target)
        .limits(LIMIT, LIMIT)
        .cells([60, 40])
}

fn judged(target: TriangleSoup) -> Outcome {
    request(target).plan().unwrap().run(&()).unwrap()
}

/// The kinds of the findings with their lines, and the largest gouge and excess.
fn found(outcome: &Outcome) -> (Vec<(String, Option<usize>)>, [f64; 2]) {
    let findings = outcome.findings().iter();
    let report = outcome.report();
    let largest = [report.gouge, report.excess].map(|side| side.unwrap().max);
    (
        findings.map(|found| (found.kind.clone(), found.line)).collect(),
        largest,
    )
}

/// A gouge in the only feed move.
fn gouge() -> Vec<(String, Option<usize>)> {
    vec![("gouge".to_owned(), Some(6))]
}

/// Enclosures are no wider than a tenth of the limit.
const NARROW: f64 = 0.1 * LIMIT;

/// The state of what is said of excess everywhere: the height is in its enclosure.
fn left(outcome: &Outcome, height: f64) -> StatementState {
    let statements = outcome.report().statements.as_deref().expect("statements");
    let statement = &statements[1];
    let [least, most] = statement.enclosure;
    assert_eq!((statement.about.as_str(), statement.limit), ("excess", LIMIT));
    assert!(least <= height && height <= most, "{height} in {least} … {most}");
    assert!(most - least <= NARROW + EXACT, "{least} … {most}");
    statement.state
}

/// The state of what is said of gouges everywhere: the depth is in its enclosure, no wider than this.
fn proven(outcome: &Outcome, depth: f64, width: f64) -> StatementState {
    let statements = outcome.report().statements.as_deref().expect("statements");
    let abouts: Vec<&str> = statements.iter().map(|statement| &statement.about[..]).collect();
    assert_eq!(abouts, ["gouge", "excess", "rapid"]);
    assert_eq!(statements[2].state, StatementState::Proven);
    let statement = &statements[0];
    let [least, most] = statement.enclosure;
    assert!(least <= depth && depth <= most, "{depth} in {least} … {most}");
    assert!(most - least <= width, "{least} … {most}");
    assert_eq!((statement.about.as_str(), statement.limit), ("gouge", LIMIT));
    if least > 0.0 {
        let witness = statement.witness.as_ref().expect("a witness");
        assert_eq!(witness.line, Some(6));
        assert_eq!(witness.text.as_deref(), Some("G1 X68 F500"));
    }
    statement.state
}

/// Ends of lines are exact to the job's tolerance, and walls are planes: rounding is all that is left.
const EXACT: f64 = 1e-5;

#[test]
fn the_right_slot_passes() {
    let outcome = judged(slotted([15.0, 25.0], -4.0));
    let (findings, largest) = found(&outcome);
    assert_eq!(findings, []);
    assert_eq!(outcome.verdict(), Some(Verdict::Pass));
    assert!(largest.iter().all(|largest| *largest < EXACT), "{largest:?}");
    assert_eq!(proven(&outcome, 0.0, NARROW), StatementState::Proven);
    assert_eq!(left(&outcome, 0.0), StatementState::Proven);
}

#[test]
fn faults_of_walls_and_floors_are_found() {
    for (sides, floor, depth) in [
        ([15.1, 25.0], -4.0, 0.1),
        ([15.0, 24.9], -4.0, 0.1),
        ([15.021, 25.0], -4.0, 0.021),
        ([15.0, 25.0], -3.95, 0.05),
        ([15.0, 25.0], -3.979, 0.021),
    ] {
        let outcome = judged(slotted(sides, floor));
        let (findings, [deepest, highest]) = found(&outcome);
        assert_eq!(findings, gouge(), "{sides:?} {floor}");
        assert!((deepest - depth).abs() < EXACT, "{deepest} instead of {depth}");
        assert!(highest < EXACT, "{highest}");
        assert_eq!(proven(&outcome, depth, NARROW), StatementState::Refuted);
        assert_eq!(left(&outcome, 0.0), StatementState::Proven);
    }
    // Within the limits.
    for (sides, floor) in [([15.019, 25.0], -4.0), ([15.0, 25.0], -3.981)] {
        let outcome = judged(slotted(sides, floor));
        let (findings, [deepest, _]) = found(&outcome);
        assert_eq!(findings, [], "{sides:?} {floor}");
        assert!((deepest - 0.019).abs() < EXACT, "{deepest}");
        assert_eq!(proven(&outcome, 0.019, NARROW), StatementState::Proven);
    }
}

#[test]
fn what_is_left_standing_along_a_wall_is_found() {
    let outcome = judged(slotted([14.9, 25.0], -4.0));
    let (findings, [deepest, highest]) = found(&outcome);
    assert_eq!(findings, [("excess".to_owned(), None)]);
    assert!((highest - 0.1).abs() < EXACT && deepest < EXACT, "{deepest} {highest}");
    assert_eq!(outcome.verdict(), Some(Verdict::Fail));
    // One region, whatever directions see it: the wall, as thick as it is beyond the limit.
    let regions = outcome.report().regions.as_ref().unwrap();
    assert_eq!(regions.len(), 1);
    let volume = regions[0].volume;
    assert!((volume - 60.0 * 4.0 * 0.08).abs() < 1e-3, "{volume}");
    assert_eq!(left(&outcome, 0.1), StatementState::Refuted);
    // Along z alone no line is in it: the proof finds it.
    for (off, state) in [(0.1, StatementState::Refuted), (0.019, StatementState::Proven)] {
        let along_z = request(slotted([15.0 - off, 25.0], -4.0)).directions(Directions::Z);
        let outcome = along_z.plan().unwrap().run(&()).unwrap();
        assert_eq!(left(&outcome, off), state);
        let (findings, _) = found(&outcome);
        let own = (state == StatementState::Refuted).then(|| ("excess".to_owned(), None));
        assert_eq!(findings, own.into_iter().collect::<Vec<_>>());
        assert!(outcome.findings().iter().all(|finding| finding.between));
    }
}

#[test]
fn a_rib_that_is_milled_away_is_found() {
    let mut target = slotted([15.0, 25.0], -4.0);
    let rib = TriangleSoup::block([30.2, 16.0, -4.0], [30.3, 24.0, 0.0]);
    target.triangles.extend(rib.triangles);
    let outcome = judged(target.clone());
    let (findings, [deepest, _]) = found(&outcome);
    assert_eq!(findings, gouge());
    // As deep as it is thick, or half of that at its middle.
    assert!((0.05 - EXACT..0.1 + EXACT).contains(&deepest), "{deepest}");
    assert_eq!(proven(&outcome, 0.05, LIMIT), StatementState::Refuted);
    // Along z alone no line meets it: the other directions found it, and so does the proof.
    let along_z = |proof: bool| {
        let mut judging = Judging::default();
        judging.proof = proof;
        let request = request(target.clone()).directions(Directions::Z).judging(judging);
        request.plan().unwrap().run(&()).unwrap()
    };
    assert_eq!(along_z(false).verdict(), Some(Verdict::Pass));
    assert_eq!(along_z(false).report().statements, None);
    let outcome = along_z(true);
    assert_eq!(found(&outcome).0, gouge());
    assert!(outcome.findings()[0].between);
    assert_eq!(proven(&outcome, 0.05, LIMIT), StatementState::Refuted);
}

/// A slot 10 mm wide and 4 mm deep, with limits of 0.02 mm but in a region.
fn slot_with(region: &str) -> String {
    format!(
        "Job(
        grid: Grid(cells: (60, 40)),
        stock: Block(min: (0, 0, -10), max: (60, 40, 0)),
        tools: {{1: Flat(radius: 5, length: 30)}},
        paths: [Path(tool: 1, moves: [Start(((-8, 20, -4), (0, 0, 1))), Line(((68, 20, -4), (0, 0, 1)))])],
        limits: Limits(gouge: 0.02, excess: 0.02, regions: [{region}]),
    )"
    )
}

#[test]
fn the_deepest_place_is_as_deep_as_is_said_where_limits_differ() {
    let job = slot_with("Region(within: Block(min: (0, 0, -10), max: (30, 40, 0)), gouge: 0.2, excess: 0.02)");
    let request = Request::from_job("slot.ron", job).target(slotted([15.0, 25.0], -3.9));
    let outcome = request.plan().unwrap().run(&()).unwrap();
    let statement = &outcome.report().statements.as_ref().unwrap()[0];
    assert_eq!(statement.state, StatementState::Refuted);
    let depth = -3.9 - statement.witness.as_ref().unwrap().place[2];
    assert!((depth - statement.enclosure[0]).abs() < 1e-5, "{depth} {statement:?}");
}

#[test]
fn nothing_is_proven_of_a_target_that_crosses_itself() {
    let mut target = slotted([15.0, 25.0], -4.0);
    // Into the floor, well beside the dexels' lines.
    let peg = TriangleSoup::block([30.2, 30.2, -5.0], [30.3, 30.3, 1.0]);
    target.triangles.extend(peg.triangles);
    let outcome = judged(target);
    let statements = outcome.report().statements.as_deref().expect("statements");
    assert_eq!(statements[0].state, StatementState::Open);
    let reason = statements[0].reason.as_deref().expect("a reason");
    assert!(reason.starts_with("the target intersects itself at (30."), "{reason}");
    assert_eq!(outcome.verdict(), Some(Verdict::Undecided));
}

/// What nobody asks for is not made: the arcs of a hundred circles would fill the memory.
#[test]
fn without_a_target_nothing_is_kept_for_a_checker() {
    let circle = "G1 X40 Y20 Z-2 F500\nG2 I-10 J0\n";
    let program = format!(
        "G21 G90\nT1 M6\nS6000 M3\nG0 X40 Y20 Z5\n{}G0 Z5\nM30\n",
        circle.repeat(100)
    );
    let request = Request::from_program("circles.nc", &program)
        .tool(1, Tool::flat(5.0, 30.0).unwrap())
        .stock(Stock::Block {
            min: [0.0, 0.0, -10.0],
            max: [60.0, 40.0, 0.0],
        })
        .cells([30, 20]);
    let outcome = request.plan().unwrap().run(&()).unwrap();
    let statements = outcome.report().statements.as_deref().expect("statements");
    let [rapid] = statements else { panic!("{statements:?}") };
    assert_eq!(
        (&rapid.about[..], rapid.state),
        ("rapid", StatementState::Proven),
        "{rapid:?}"
    );
}

/// Rounding leaves skins of 2e-10 mm on the sides of the stock and between passes, as high as the cut is deep: they
/// were excess.
#[test]
fn cuts_that_touch_the_sides_or_each_other_leave_nothing() {
    let judged = |text: &str, width: f64| {
        let (low, high) = ([0.0, 2.0, -10.0], |z| [40.0, 2.0 + width, z]);
        let request = Request::from_program("step.nc", format!("T1 M6\nS900 M3\n{text}G0 Z5\nM30\n"))
            .tool(1, Tool::flat(3.0, 20.0).unwrap())
            .stock(Stock::Block {
                min: low,
                max: high(0.0),
            })
            .target(TriangleSoup::block(low, high(-2.0)))
            .limits(0.05, 0.1)
            .cells([80, 2 * width as usize])
            .directions(Directions::Xyz);
        request.plan().unwrap().run(&()).unwrap()
    };
    let pass = |y: f64| format!("G0 X-8 Y{y} Z5\nG0 Z-2\nG1 X48 F600\nG0 Z5\n");
    let one = judged(&pass(5.0), 6.0);
    let report = one.report();
    assert_eq!(one.verdict(), Some(Verdict::Pass), "{:?}", report.findings);
    assert!(report.excess.as_ref().unwrap().max < 1e-6, "{:?}", report.excess);
    // Whether nothing at all is left between the passes is not known.
    let two = judged(&(pass(5.0) + &pass(11.0)), 12.0);
    assert!(two.findings().is_empty(), "{:?}", two.report().findings);
}

/// Beside the stock there is no line: a part that is longer than its stock passed without a word.
#[test]
fn targets_beyond_the_grid_are_named() {
    let longer = |end: f64| {
        let low = [0.0, 0.0, -10.0];
        let request = Request::from_program(
            "face.nc",
            "T1 M6\nS900 M3\nG0 X-30 Y20 Z5\nG0 Z-2\nG1 X90 F600\nG0 Z5\nM30\n",
        )
        .tool(1, Tool::flat(25.0, 20.0).unwrap())
        .stock(Stock::Block {
            min: low,
            max: [60.0, 40.0, 0.0],
        })
        .target(TriangleSoup::block(low, [end, 40.0, -2.0]))
        .limits(0.05, 0.1)
        .cells([60, 40]);
        let outcome = request.plan().unwrap().run(&()).unwrap();
        outcome.report().notes.join("\n")
    };
    let note = "the target reaches 5 mm beyond the grid: what is missing there is not seen";
    assert!(longer(65.0).contains(note), "{}", longer(65.0));
    assert!(!longer(60.0).contains("beyond the grid"));
}

/// A depth and a height within the limits of their own region, but not within the smallest: what is open, and why.
#[test]
fn limits_that_differ_are_named_where_a_statement_is_open() {
    let job = slot_with("Region(within: Block(min: (-1, 14, -10), max: (61, 26, 1)), gouge: 0.25, excess: 0.25)");
    for (about, floor, words) in [("gouge", -3.9, " mm deep"), ("excess", -4.1, " mm high")] {
        let request = Request::from_job("slot.ron", job.as_str()).target(slotted([15.0, 25.0], floor));
        let outcome = request.plan().unwrap().run(&()).unwrap();
        assert_eq!(outcome.verdict(), Some(Verdict::Undecided));
        let mut all = outcome.report().statements.iter().flatten();
        let statement = all.find(|statement| statement.about == about).unwrap();
        assert_eq!(statement.state, StatementState::Open);
        let told = sweepsim_job::words::proven(statement);
        let limits = "the limits differ from region to region, from 0.02 to 0.25 mm";
        assert!(told.contains(limits) && told.contains(words), "{told}");
        assert!(
            told.contains("only the lines tell whether that is within its own region's limit"),
            "{told}"
        );
    }
}
