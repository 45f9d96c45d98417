//! Words of Heidenhain programs that once were read as something else, against poses worked out by hand.

use std::path::PathBuf;

use sweepsim_nc::{EventKind, FeedMode, NcError, Program, ReadOptions, Spindle, heidenhain};

use crate::found;

const START: &str = "TOOL CALL 1 Z S1000 F300\nL X+0 Y+0 Z+0 R0 FMAX M3\n";

fn attempt(text: &str) -> Result<Program, NcError> {
    let called = |name: &str| {
        let text = match name {
            "LOCAL" => "QL1 = QL1 + 7\nQ1 = QL1\nL IZ+1 FMAX\n",
            "INCHES" => "BEGIN PGM INCHES INCH\nL X+1\nEND PGM INCHES INCH\n",
            _ => return None,
        };
        Some((PathBuf::from(format!("{name}.H")), text.to_owned()))
    };
    heidenhain::read_with(&format!("{START}{text}"), &ReadOptions::default(), &called)
}

fn read(text: &str) -> Program {
    attempt(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn error(text: &str) -> String {
    attempt(text).unwrap_err().to_string()
}

fn tips(text: &str) -> Vec<[f64; 3]> {
    found::tips(&read(text))
}

#[track_caller]
fn ends_at(text: &str, tip: [f64; 3]) {
    found::near(*tips(text).last().unwrap(), tip);
}

fn assumes(text: &str, what: &str) -> bool {
    read(text)
        .assumptions
        .iter()
        .any(|assumption| assumption.what.contains(what))
}

fn feeds(text: &str) -> Vec<(f64, FeedMode)> {
    let program = read(text);
    program
        .poses
        .iter()
        .skip(1)
        .filter_map(|pose| Some((pose.feed?, pose.feed_mode)))
        .collect()
}

#[test]
fn scales_of_axes() {
    ends_at(
        "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X2 Y0.5\nL X+10 Y+10",
        [20.0, 5.0, 0.0],
    );
    ends_at(
        "CYCL DEF 26.1 X2 CCX+10 CCY+5\nL X+10 Y+5\nL X+12 Y+6",
        [14.0, 6.0, 0.0],
    );
    ends_at("CYCL DEF 26.1 X2 Y2\nCYCL DEF 26.1 X1\nL X+10 Y+10", [10.0, 20.0, 0.0]);
    // Arcs need the same factor in all axes.
    let arc = "\nL X+10\nCC X+0 Y+0\nC X+0 Y+10 DR+";
    ends_at(&format!("CYCL DEF 26.1 X2 Y2 Z2{arc}"), [0.0, 20.0, 0.0]);
    assert!(attempt(&format!("CYCL DEF 26.1 X2{arc}")).is_err());
}

#[test]
fn planes_of_cycle_19() {
    let text = "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+90 C+0 F1000 ABST 50\nL X+1 Y+2 Z+3";
    ends_at(text, [3.0, 2.0, -1.0]);
    assert!(assumes(text, "cycle 19"));
    ends_at(
        &format!("{text}\nCYCL DEF 19.1 A+0 B+0 C+0\nCYCL DEF 19.1\nL X+1 Y+2 Z+3"),
        [1.0, 2.0, 3.0],
    );
}

#[test]
fn planes_upon_planes() {
    let turned = "PLANE SPATIAL SPA+0 SPB+0 SPC+90 STAY\n";
    ends_at(
        &format!("{turned}PLANE RELATIV SPB+90 STAY\nL X+1 Y+2 Z+3"),
        [-2.0, 3.0, -1.0],
    );
    ends_at(
        &format!("{turned}CYCL DEF 7.1 X+5\nPLANE RELATIV SPC-90 STAY\nL X+1 Y+2 Z+3"),
        [1.0, 7.0, 3.0],
    );
    let reset = format!("{turned}CYCL DEF 7.1 X+5\nPLANE RESET STAY\nL X+1 Y+2 Z+3");
    ends_at(&reset, [1.0, 2.0, 3.0]);
    assert!(assumes(&reset, "datum shift in a plane"));
}

#[test]
fn other_cycles_that_are_in_effect_at_once_are_said() {
    assert!(assumes("CYCL DEF 285 GEAR Q551=0\nL X+1", "cycle 285"));
    assert!(read("CYCL DEF 239 LOAD Q570=0\nL X+1").assumptions.is_empty());
    // One that is called is said where it is called.
    assert!(read("CYCL DEF 3.0 SLOT\nL X+1").assumptions.is_empty());
}

#[test]
fn the_order_of_transformations() {
    let what = "the order of a shift or a plane";
    let rotated = "CYCL DEF 10.1 ROT+90\nCYCL DEF 7.1 X+10\n";
    assert!(assumes(&format!("{rotated}L X+1"), what));
    ends_at(&format!("{rotated}L X+1 Y+0"), [10.0, 1.0, 0.0]);
    assert!(!assumes(&format!("{rotated}CYCL DEF 10.1 ROT+0\nL X+1"), what));
    assert!(!assumes("CYCL DEF 7.1 X+10\nCYCL DEF 10.1 ROT+90\nL X+1", what));
    assert!(assumes(
        "CYCL DEF 8.1 X\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY\nL X+1",
        what
    ));
    assert!(!assumes(
        "PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY\nCYCL DEF 8.1 X\nL X+1",
        what
    ));
}

#[test]
fn words_behind_codes_are_theirs() {
    use FeedMode::PerMinute;
    let text = "L X+1 F500 M103 F20\nL X+2\nL X+3 F400 M128 F1000\nL X+4";
    assert_eq!(
        feeds(text),
        [
            (500.0, PerMinute),
            (500.0, PerMinute),
            (400.0, PerMinute),
            (400.0, PerMinute)
        ]
    );
    ends_at(
        "L X+5 F100 M118 Y1 Z1\nL X+6 M120 LA10\nL X+7 M124 T0.01",
        [7.0, 0.0, 0.0],
    );
    ends_at("L X+5 F100 M107\nL X+6 M101\nM102\nL X+7 M141", [7.0, 0.0, 0.0]);
}

#[test]
fn feeds_of_tools_revolutions_and_inches() {
    use FeedMode::{PerMinute, PerRevolution};
    let text = "L X+1 F500\nL X+2 F AUTO\nL X+3 F500\nL X+4 FAUTO";
    assert_eq!(feeds(text), [500.0, 300.0, 500.0, 300.0].map(|feed| (feed, PerMinute)));
    let text = "L X+1 F0.2 M136\nL X+2\nL X+3 F500 M137\nL X+4 FU0.3\nL X+5 F100";
    let found = feeds(text);
    assert_eq!(found[1..3], [(0.2, PerRevolution), (500.0, PerMinute)]);
    assert_eq!(found[3..], [(0.3, PerRevolution), (100.0, PerMinute)]);
    assert!(assumes("L X+1 FZ0.05", "number of teeth"));
    assert!(error("L X+1 FT5").contains("a time instead of a feed"));
    // Programs in inches have tenths of them per minute, in cycles too.
    let cycle = "CYCL DEF 200 DRILLING ~\nQ200=0.1 ~\nQ201=-0.5 ~\nQ206=50 ~\nQ202=1 ~\nQ203=+0 ~\nQ204=1";
    let text = format!(
        "BEGIN PGM A INCH\nTOOL CALL 1 Z S1000 F300\nL X+0 Y+0 Z+2 FMAX\nL X+1 F400\nL X+2 F AUTO\n{cycle}\nCYCL CALL"
    );
    let program = heidenhain::read(&text, &ReadOptions::default()).unwrap();
    let feeds: Vec<f64> = program.poses.iter().filter_map(|pose| pose.feed).collect();
    assert_eq!(feeds, [40.0, 30.0, 5.0]);
}

#[test]
fn codes_at_the_end_of_blocks() {
    let at = |text: &str, wanted: EventKind| {
        let program = read(text);
        program.events.iter().find(|event| event.kind == wanted).unwrap().pose
    };
    let stopped = EventKind::Spindle(Spindle::Stopped);
    assert_eq!(at("L X+1 F100\nL X+2 M5\nL X+3", stopped), 3);
    assert_eq!(at("L X+1 F100\nL X+2 M0\nL X+3", EventKind::Stop), 3);
    let faster = EventKind::Spindle(Spindle::Clockwise { rpm: Some(5000.0) });
    assert_eq!(at("L X+1 F100\nTOOL CALL S5000\nL X+2", faster), 2);
}

#[test]
fn functions_and_formulas() {
    ends_at("FN 13: Q1 = -1 ANG -1\nL X+Q1", [225.0, 0.0, 0.0]);
    ends_at("FN 13: Q1 = +1 ANG -1\nL X+Q1", [135.0, 0.0, 0.0]);
    ends_at("Q1 = 400 % 360 + 1\nL X+Q1", [41.0, 0.0, 0.0]);
    let text = "L X+1\nFN 9: IF +0 EQU +0 GOTO LBL 9\nL X+2\nLBL 9\nFN 14: ERROR = 1000\nL X+3";
    ends_at(text, [1.0, 0.0, 0.0]);
    assert!(assumes(text, "the error 1000"));
}

#[test]
fn normals_with_oversizes_are_errors_with_and_without_tool_vectors() {
    for text in [
        "LN X+1 Y+0 Z+0 NX+0 NY+0 NZ+1 F100",
        "LN X+1 Y+0 Z+0 NX+0 NY+0 NZ+1 TX+0 TY+0 TZ+1 F100 M128",
    ] {
        for oversize in ["DR+0.5", "DR2+0.5"] {
            let text = format!("TOOL CALL 2 Z S1000 {oversize}\nL X+0 Y+0 Z+5 FMAX\n{text}");
            assert!(error(&text).contains("LN with surface normals"), "{text}");
        }
        ends_at(text, [1.0, 0.0, 0.0]);
    }
}

#[test]
fn turning_is_an_error() {
    assert!(error("FUNCTION MODE TURN\nL X+5").contains("FUNCTION MODE TURN is not supported"));
    ends_at("FUNCTION MODE MILL\nL X+5", [5.0, 0.0, 0.0]);
}

#[test]
fn programs_that_are_called() {
    // QL are each program's own.
    let text = "QL1 = 5\nCALL PGM LOCAL\nL X+QL1 Y+Q1\nCALL PGM LOCAL\nL Y+Q1";
    ends_at(text, [5.0, 7.0, 2.0]);
    assert!(error("CALL PGM INCHES").contains("in other units"));
    // Cycle 12 is called.
    let define = "CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM TNC:\\DIR\\LOCAL.H\n";
    ends_at(&format!("{define}L X+1\nCYCL CALL\nL Y+1 M99"), [1.0, 1.0, 2.0]);
    ends_at(&format!("{define}L X+1"), [1.0, 0.0, 0.0]);
}

#[test]
fn cycles_after_each_move() {
    let define = "CYCL DEF 200 DRILLING Q200=2 Q201=-5 Q206=100 Q202=5 Q203=+0 Q204=10\n";
    let holes = |text: &str| -> Vec<f64> {
        let found = tips(&format!("{define}{text}"));
        found.iter().filter(|tip| tip[2] == -5.0).map(|tip| tip[0]).collect()
    };
    assert_eq!(
        holes("L X+1 FMAX M89\nL X+2 FMAX\nL X+3 FMAX M99\nL X+4 FMAX"),
        [1.0, 2.0, 3.0]
    );
    assert_eq!(holes(&format!("L X+1 FMAX M89\n{define}L X+2 FMAX")), [1.0]);
}

#[test]
fn polar_arcs_that_are_tangential() {
    ends_at("CC X+0 Y+10\nL X+10 F100\nCTP PR+10 PA+0", [10.0, 10.0, 0.0]);
    let program = {
        let mut options = ReadOptions::default();
        options.exact_arcs = true;
        heidenhain::read(&format!("{START}CC X+0 Y+10\nL X+10 F100\nCTP PR+10 PA+0"), &options).unwrap()
    };
    assert!(matches!(
        program.poses.last().unwrap().way().course,
        sweepsim_motion::TipCourse::Arc(_)
    ));
}

#[test]
fn depths_feeds_and_finishing_of_cycles() {
    let drill = "CYCL DEF 200 DRILLING Q200=2 Q201=-5 Q206=100 Q202=5 Q203=+0 Q204=10";
    assert!(assumes(&format!("{drill} Q395=1\nCYCL CALL"), "the point of the drill"));
    assert!(!assumes(
        &format!("{drill} Q395=0\nCYCL CALL"),
        "the point of the drill"
    ));
    // Centring comes out in rapid, and pecks do not shrink to nothing.
    let feeds = |text: &str| read(text).poses.iter().filter(|pose| pose.feed.is_some()).count();
    assert_eq!(
        feeds("CYCL DEF 240 CENTERING Q200=2 Q201=-2 Q206=80 Q203=+0 Q204=10\nCYCL CALL"),
        1
    );
    let pecks = "CYCL DEF 203 DRILLING Q200=2 Q201=-5 Q206=80 Q202=1 Q203=+0 Q204=10 Q212=0.3 Q205=0\nCYCL CALL";
    // 1, 0.7, 0.4, and nine of 0.3 with what is left.
    assert_eq!(feeds(pecks), 13);
    // Tapping feeds by its pitch.
    let tapped = read("CYCL DEF 207 RIGID TAPPING Q200=2 Q201=-5 Q239=+1.5 Q203=+0 Q204=10\nCYCL CALL");
    assert_eq!(tapped.poses.iter().find_map(|pose| pose.feed), Some(1500.0));
    // Finishing takes the floor if something was left there.
    let bottom = |left: f64| {
        let text = format!(
            "TOOL DEF 1 L+0 R+2\nCYCL DEF 251 POCKET Q215=2 Q218=30 Q219=20 Q220=5 Q368=0.2 Q224=0 Q367=0 Q207=500 Q351=+1 Q201=-6 Q202=3 Q369={left} Q206=150 Q338=0 Q200=2 Q203=+0 Q204=10 Q370=1\nCYCL CALL"
        );
        tips(&text).iter().filter(|tip| tip[2] == -6.0).count()
    };
    assert!(bottom(0.5) > bottom(0.0) + 4);
}
