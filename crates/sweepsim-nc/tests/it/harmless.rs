//! Codes that change no geometry are accepted, with a note where something is ignored; what only looks like them is refused.

use sweepsim_nc::gcode::read;
use sweepsim_nc::{Program, ReadOptions};

use crate::found::tips;

fn program(text: &str) -> Program {
    read(text, &ReadOptions::default()).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

fn error(text: &str) -> String {
    read(text, &ReadOptions::default()).expect_err(text).to_string()
}

/// `text` between two moves: the poses are those of the moves alone, and the notes are `notes`.
#[track_caller]
fn harmless(text: &str, notes: &[&str]) {
    let found = program(&format!("G0 X0 Y0 Z5\n{text}\nG1 X10 F100\n"));
    assert_eq!(tips(&found), [[0.0, 0.0, 5.0], [10.0, 0.0, 5.0]], "{text}");
    assert_eq!(found.sections().count(), 1, "{text}");
    let said: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(said, notes, "{text}");
}

/// The error of `text` after a move.
#[track_caller]
fn refused(text: &str, message: &str) {
    assert_eq!(error(&format!("G0 X0 Y0 Z5\n{text}\nX10\n")), format!("2:{message}"));
}

const HIGH_SPEED: &str = "line 2: high-speed modes (G5 P10000, G5.1 Q1) change no programmed point: ignored";
const PATH: &str = "the path of the tool would be unknown; expected G0, G1, G2 or G3";

#[test]
fn high_speed_modes() {
    for text in ["G05 P10000", "G05 P0", "G5.1 Q1", "G05.1 Q0", "N20 G05.1 Q1 R5"] {
        harmless(text, &[HIGH_SPEED]);
    }
    harmless("G08 P1", &[]);
    harmless(
        "G187 P3 E0.01",
        &["line 2: smoothness (G187) changes no programmed point: ignored"],
    );
    // Splines, cycles and smoothing move the tool.
    refused(
        "G5 P0 X1",
        "1: a spline without its control points: expected I and J (unless it goes on from another one), P and Q",
    );
    refused(
        "G5",
        &format!("1: G5: splines without X and Y are not supported yet: {PATH}"),
    );
    refused(
        "G05 P10001 L2",
        &format!("1: G5: high-speed modes other than P0, P1, P2 and P10000 are not supported yet: {PATH}"),
    );
    refused(
        "G5.1 Q2",
        &format!("1: G5.1: high-speed modes other than Q0 and Q1 are not supported yet: {PATH}"),
    );
}

#[test]
fn blending() {
    harmless("G64", &[]);
    harmless("G61", &[]);
    harmless(
        "G64 P0.05",
        &["line 2: G64 P0.05: corners may be rounded by as much; the path is read as programmed"],
    );
}

#[test]
fn speeds_and_coolant() {
    for text in ["M3 S1000", "M8", "M7", "M9", "M88 (no)", "T1 M6", "M0", "M1"] {
        let found = program(&format!("T1 M6\nG0 X0 Y0 Z5\n{text}\nG1 X10\n"));
        assert_eq!(tips(&found), [[0.0, 0.0, 5.0], [10.0, 0.0, 5.0]], "{text}");
    }
    harmless("G255", &[]);
    harmless("G10 L1 P1 R5 Z2", &[]);
    harmless("G10 L50", &["line 2: G10 L50 sets the control's own data: ignored"]);
    harmless("G69", &[]);
    // The axes are not turned: the frame is the part's.
    harmless("G254", &[]);
    refused(
        "M198 P1",
        "1: M198: these subprograms are not supported yet: expected a program without them",
    );
    harmless("M73", &[]);
    refused("M72", "1: M72 without M70 before it: there are no saved modes");
}

#[test]
fn units_by_g70() {
    let found = program("G70\nG0 X1 Y0 Z0\nG71\nG1 X1");
    assert_eq!(tips(&found), [[25.4, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    assert_eq!(
        found.notes[0].to_string(),
        "line 1: G70 and G71 are taken as inches and millimetres (2 times, first here)"
    );
    assert_eq!(
        tips(&program("G700 G0 X1 Y0 Z0\nG710 X1")),
        [[25.4, 0.0, 0.0], [1.0, 0.0, 0.0]]
    );
    // A bolt circle of Haas is left out; roughing on a lathe is refused.
    assert!(program("G0 X0 Y0 Z5\nG70 I5 J0 L6\nX10\n").assumptions[0].changes_verdict);
    refused("G71 P10 Q20", &format!("1: G71: cycles are not supported yet: {PATH}"));
}

#[test]
fn m99_ends_a_main_program() {
    let found = program("G0 X0 Y0 Z5\nG1 X1\nX2 M99\nX9");
    assert_eq!(tips(&found), [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [2.0, 0.0, 5.0]]);
    assert_eq!(
        found.notes[0].to_string(),
        "line 3: M99 ends the program here; a machine may start it again"
    );
    refused("M99 P10", "1: M99 P10: there is no block N10 to return to");
}

#[test]
fn titles_and_tapes() {
    let poses = [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0]];
    let moves = "G0 X0 Y0 Z5\nG1 X1\n";
    for (head, title) in [
        ("%\nOFinal ToolPath\n", Some("Final ToolPath")),
        ("O1000 BRACKET\n", Some("BRACKET")),
        ("<BRACKET>\n", Some("BRACKET")),
        (":1000\n", Some("O1000")),
        ("%\nO1000 (BRACKET)\n", Some("BRACKET")),
        ("%\nO0000(PLATE REV-A)\n", Some("PLATE REV-A")),
        ("O1000 ()\n", Some("O1000")),
        ("BRACKET OF 12 PARTS\n%\n", None),
    ] {
        let found = program(&format!("{head}{moves}%\nG1 X9\n"));
        if head.contains('%') {
            assert_eq!(tips(&found), poses, "{head}");
        }
        assert_eq!(found.title.as_deref(), title);
    }
    let found = program(&format!("BRACKET OF 12 PARTS\n%\n{moves}"));
    assert_eq!(found.notes[0].to_string(), "line 1: text before the first `%`: ignored");
    assert!(error(&format!("{moves}O1000 BRACKET\n")).starts_with("3:7: "));
    assert!(error(&format!("BRACKET OF 12 PARTS\n{moves}")).starts_with("1:1: statements like `BRACKET`"));
}

#[test]
fn unclosed_subroutines() {
    for (text, message) in [
        (
            "O100 sub",
            "1:1: there is no `O100 endsub` after the line where it begins",
        ),
        ("o100 if [1 gt 2]", "1:1: there is no `O100 endif` after this line"),
        (
            "o<a> call",
            "1:1: the subprogram O<a> is missing: expected it in this program, or in a file of its name beside it",
        ),
    ] {
        assert_eq!(error(&format!("{text}\nG0 X0 Y0 Z5\n")), message);
    }
}

#[test]
fn g92_before_the_first_move() {
    let found = program("G92 X0 Y0 Z0\nG1 X10 F100\nZ-1");
    assert_eq!(tips(&found), [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 0.0, -1.0]]);
    assert_eq!(
        found.notes[0].to_string(),
        "line 1: G92 before the first move: the tool is taken to be there, in the part's frame"
    );
    // In inches, with an axis that the program places itself, and as Fanuc's old programs name the tool change point.
    assert_eq!(tips(&program("G20\nG92 X1 Y0 Z0\nG0 X2"))[0], [50.8, 0.0, 0.0]);
    assert_eq!(
        tips(&program("G0 Z5\nG92 X1 Y2 Z0\nG91 G1 X1 Z-1")),
        [[1.0, 2.0, 5.0], [2.0, 2.0, 4.0]]
    );
    // Rotary words that change nothing.
    assert_eq!(tips(&program("G92 X0 Y0 Z0 A0\nG1 X1")).len(), 2);
    assert_eq!(
        error("G92 X0 A90\n"),
        "1:1: G92 with A other than the current 0 degrees is not supported yet: expected X, Y, Z"
    );
    // After a move to a place that only the machine knows it is an error, as before.
    assert!(error("G0 X0 Y0 Z0\nG28\nG92 X0").starts_with("3:1: this sets the coordinates of the current position"));
}

#[test]
fn the_end_of_a_g92() {
    // At the end of the program it is harmless; absolute coordinates after it are where only the machine knows.
    let start = "G92 X0 Y0 Z0\nG1 X10 F100\n";
    for end in ["G92.1", "G92.2", "G92.1 X0"] {
        assert_eq!(tips(&program(&format!("{start}{end}\nM30"))).len(), 2, "{end}");
        assert_eq!(
            error(&format!("{start}{end}\nG1 X1")),
            "4:1: an absolute X after the end of a G92 which stood before the first move is not supported yet: only the machine knows \
             the distance between the two frames; expected no G92.1 or G92.2 before it"
        );
        assert!(
            error(&format!("{start}{end}\nG90.1 G2 Y0 I5 J0")).starts_with("4:1: an absolute"),
            "{end}"
        );
        // Steps go on from where the tool is.
        assert_eq!(
            tips(&program(&format!("{start}{end}\nG91 X1")))[2],
            [11.0, 0.0, 0.0],
            "{end}"
        );
    }
    assert_eq!(
        tips(&program(&format!("{start}G92.1 X0\nY5")))[2],
        [10.0, 5.0, 0.0],
        "the others stay"
    );
    // Before any move the frame is the machine's again; a new G92 places the tool anew; G92.3 restores.
    assert_eq!(tips(&program("G92 X0 Y0 Z0\nG92.1\nG0 X1 Y2 Z3")), [[1.0, 2.0, 3.0]]);
    assert_eq!(
        tips(&program(&format!("{start}G92.1\nG92 X5\nX6")))[2],
        [11.0, 0.0, 0.0]
    );
    assert_eq!(tips(&program(&format!("{start}G92.2\nG92.3\nX6")))[2], [6.0, 0.0, 0.0]);
}

#[test]
fn g92_remembers_as_linuxcnc_does() {
    let start = "G0 X5 Y0 Z0\nG92 X0\n";
    let last = |text: &str| tips(&program(&format!("{start}{text}"))).pop().unwrap()[0];
    assert_eq!(last("G1 X1"), 6.0);
    assert_eq!(last("G92.1\nG1 X1"), 1.0);
    assert_eq!(last("G92.2\nG1 X1"), 1.0);
    assert_eq!(last("G92.2\nG92.3\nG1 X1"), 6.0);
    assert_eq!(
        last("G92.2\nG92.2\nG92.3\nG1 X1"),
        6.0,
        "a second G92.2 forgets nothing"
    );
    assert_eq!(last("G92.3\nG1 X1"), 6.0, "G92 alone is remembered");
    assert_eq!(last("G92.1\nG92.3\nG1 X1"), 1.0, "G92.1 forgets");
    refused(
        "G92.3",
        "1: G92.3 before any G92 is not supported yet: it restores what the machine remembers of an earlier program; expected G92 or \
         G92.1 before it",
    );
    refused("G92.1 X5", "1: X5 next to a code that ends a G92: expected none, or 0");
    refused("G92.2 X0", "1: X0 next to a code that ends a G92: expected none");
    refused("G92.3 X0", "1: X next to G92.3: expected none");
    assert!(error("M428\nG0 X0 Y0 Z0 A30\nG10 L20 P1 A0").contains("3:1: G10 L20 with A other than the current 30"));
    assert!(error("G52 X1 C5").contains("work offsets that turn"));
}

#[test]
fn the_third_word_of_a_helix() {
    let start = "G0 X10 Y0 Z0\n";
    let plain = program(&format!("{start}G17 G2 X10 Y0 Z-4 I-10 J0 P2"));
    // The pitch (with either sign), the rise, and nothing.
    for k in ["K-2", "K2", "K-4", "K0"] {
        let found = program(&format!("{start}G17 G2 X10 Y0 Z-4 I-10 J0 {k} P2"));
        assert_eq!(tips(&found), tips(&plain), "{k}");
    }
    let absolute = program(&format!("{start}G90.1 G2 X10 Y0 Z-4 I0 J0 K-4 P2"));
    assert_eq!(tips(&absolute), tips(&plain));
    let error = |text: &str| error(&format!("{start}{text}"));
    assert_eq!(
        error("G2 X10 Y0 Z-4 I-10 J0 K3 P2"),
        "2:1: K is 3 mm, but Z changes by -4 mm in 2.0000 turns: expected none, the pitch -2.0000 or the rise -4"
    );
    assert_eq!(
        error("G2 X10 Y0 I-10 J0 K3"),
        "2:1: K is 3 mm, but Z does not change along this arc: expected none, or its end in Z"
    );
    assert!(error("G18 G2 X10 Z0 I-10 J3").contains("J is 3 mm, but Y does not change"));
    // Turns and spirals of other controls.
    assert_eq!(
        error("G2 X10 Y0 Z-4 I-10 J0 L2"),
        "2:1: L in an arc (turns, repeats or a spiral) is not supported yet: expected P for further turns"
    );
    assert!(error("G2 X10 Y0 I-10 J0 Q1").contains("Q in an arc"));
}

/// All problems: lines and messages up to the reason.
fn problems(text: &str) -> Vec<String> {
    let error = read(text, &ReadOptions::default()).expect_err(text);
    std::iter::once(&error)
        .chain(error.further())
        .map(|error| error.to_string().split(" not supported").next().unwrap().to_owned())
        .collect()
}

#[test]
fn all_problems_at_once() {
    assert_eq!(
        problems("G0 X0 Y0 Z5\nG81 X1 Z-1 R1 F100\nX2\nG80\nG1 X#1\nG41 D1 X5\nG81 X3\nM98 P5\nG2 X5 I1\nM30\nG42"),
        [
            "5:5: #1 has no value here: LinuxCNC takes 0, Fanuc leaves out its word; expected `#1 = …` before, or the name of the control",
            "7:1: G81 without R: expected R, the plane to drill from, and Z, the bottom"
        ],
        "each once, and none that follows from another"
    );
    assert_eq!(problems("G0 X0 Y0 Z5\nG1 X#1\nG92 X0\nG92.3\nG10 L20 P1 X0").len(), 1);
    // A full position makes the following blocks certain again.
    assert_eq!(
        problems("G0 X0 Y0 Z5\nG1 X#1\nG0 X1 Y1 Z1\nG2 X9 I1"),
        [
            "2:5: #1 has no value here: LinuxCNC takes 0, Fanuc leaves out its word; expected `#1 = …` before, or the name of the control",
            "4:1: the arc has two radii: its start is 1 mm and its end 7 mm from its centre, expected the same"
        ]
    );
    assert!(problems("G1 X0 Y0 Z5\nX1 Y1\nX2 &")[0].starts_with("3:4: found '&'"));
    let many: String = (0..1000).map(|k| format!("G{}\n", 1000 + k)).collect();
    assert_eq!(problems(&many).len(), 101);
}
