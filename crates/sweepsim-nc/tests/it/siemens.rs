//! Programs of Siemens controls, against poses worked out by hand.

use std::path::PathBuf;

use sweepsim_nc::{EventKind, Program, ReadOptions, Units, siemens};

use crate::found::{near, tips};

fn read(text: &str) -> Program {
    siemens::read(text, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn exact(text: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    siemens::read(text, &options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn error(text: &str) -> String {
    let mut strict = ReadOptions::default();
    strict.strict = true;
    siemens::read(text, &strict).unwrap_err().to_string()
}

#[track_caller]
fn ends_at(text: &str, tip: [f64; 3]) {
    near(*tips(&exact(text)).last().unwrap(), tip);
}

#[test]
fn words_variables_and_expressions() {
    ends_at("R1=3 R2=R1*2\nG0 X=R1+2 Y=R2 Z=-R1", [5.0, 6.0, -3.0]);
    ends_at("DEF REAL _a=2, _b\n_b=_A*SIN(30)\nX=_b Y=_a/4 Z0", [1.0, 0.5, 0.0]);
    ends_at("DEF REAL L[3]\nL[1]=4 R[7]=1\nX=L[1] Y=L[2] Z=R7", [4.0, 0.0, 1.0]);
    ends_at("X1 Y2 Z3\nG91 X1\nG90 Y=IC(-1)\nG91 Z=AC(9)", [2.0, 1.0, 9.0]);
    ends_at("G700 X1 Y0 Z0\nG71 Y5", [25.4, 5.0, 0.0]);
    ends_at("N10 START: G0 X1 Y2 Z3 ; a comment\n/N20 X4", [4.0, 2.0, 3.0]);
    ends_at("X=1EX1 Y.5 Z-.25", [10.0, 0.5, -0.25]);
}

#[test]
fn arcs() {
    let start = "G17 G0 X10 Y0 Z0 F100\n";
    // A quarter about the origin, in all ways of saying it.
    for arc in [
        "G3 X0 Y10 I-10 J0",
        "G3 X0 Y10 I=AC(0) J=AC(0)",
        "G3 X0 Y10 CR=10",
        "G3 AR=90 I-10 J0",
        "G3 X0 Y10 AR=90",
        "CIP X0 Y10 I1=10*COS(30) J1=10*SIN(30)",
    ] {
        let program = exact(&format!("{start}{arc}\n"));
        let last = program.poses.last().unwrap();
        near(last.pose.tip(), [0.0, 10.0, 0.0]);
        let sweepsim_motion::TipCourse::Arc(found) = last.way().course else {
            panic!("{arc}")
        };
        near(found.centre(), [0.0; 3]);
        assert!(
            (found.angle() - 90_f64.to_radians()).abs() < 1e-9,
            "{arc}: {}",
            found.angle()
        );
    }
    // A helix of two further turns, and a full circle.
    for (arc, turns, z) in [("G2 X10 Y0 Z-6 I-10 J0 TURN=2", -3.0, -6.0), ("G3 I-10 J0", 1.0, 0.0)] {
        let program = exact(&format!("{start}{arc}\n"));
        let last = program.poses.last().unwrap();
        near(last.pose.tip(), [10.0, 0.0, z]);
        let sweepsim_motion::TipCourse::Arc(found) = last.way().course else {
            panic!("{arc}")
        };
        assert!((found.angle() / std::f64::consts::TAU - turns).abs() < 1e-12);
    }
    // As chords every point is within the tolerance.
    let chords = read(&format!("{start}G18 G2 X0 Z10 CR=10"));
    for tip in tips(&chords) {
        assert!((tip[0].hypot(tip[2]) - 10.0).abs() < 1e-9 && tip[1] == 0.0);
    }
}

#[test]
fn frames() {
    ends_at("TRANS X10 Y20\nG0 X1 Y2 Z3", [11.0, 22.0, 3.0]);
    ends_at("TRANS X10\nATRANS Y5\nG0 X1 Y2 Z3\nTRANS\nX0", [0.0, 7.0, 3.0]);
    ends_at("ROT Z90\nG0 X1 Y0 Z3", [0.0, 1.0, 3.0]);
    ends_at("TRANS X10\nAROT RPL=90\nG0 X1 Y0 Z3", [10.0, 1.0, 3.0]);
    // About Z, then about the new Y: the new x points to −Z after 90° about Y.
    ends_at("ROT Y90 Z90\nG0 X1 Y0 Z0", [0.0, 0.0, -1.0]);
    ends_at("SCALE X2 Y2 Z2\nG0 X1 Y1 Z1", [2.0, 2.0, 2.0]);
    ends_at("MIRROR X0\nG0 X1 Y1 Z1", [-1.0, 1.0, 1.0]);
    // A mirrored arc turns the other way: it still ends where it should, about the mirrored centre.
    let program = exact("MIRROR X0\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0");
    let sweepsim_motion::TipCourse::Arc(arc) = program.poses.last().unwrap().way().course else {
        panic!()
    };
    let signed = arc.angle() * arc.normal()[2];
    assert!((signed + 90_f64.to_radians()).abs() < 1e-12, "{signed}");
    // The tool stays where it is when the frame changes: G91 goes on from there.
    ends_at("G0 X1 Y2 Z3\nTRANS X100\nG91 Y1", [1.0, 3.0, 3.0]);
    ends_at("G0 X1 Y2 Z3\nROT Z90\nG91 X1", [1.0, 3.0, 3.0]);
}

#[test]
fn tip_control_and_swivelled_planes() {
    // The tool leans as the letters' convention has it: Rz(C) Ry(B) z.
    let program = read("TRAORI\nG0 X0 Y0 Z0 B90 C90\nG1 X5 F100");
    near(program.poses[1].pose.axis(), [0.0, 1.0, 0.0]);
    let program = read("TRAORI\nG0 X0 Y0 Z0 A90 C0");
    near(program.poses[0].pose.axis(), [0.0, -1.0, 0.0]);
    // Tool vectors, with and without axes that are known.
    let program = read("TRAORI\nG1 X0 Y0 Z0 A3=0 B3=0 C3=1 F100\nX9 A3=1 C3=1");
    let half = 0.5_f64.sqrt();
    near(program.poses[1].pose.axis(), [half, 0.0, half]);
    let mut options = ReadOptions::default();
    options.machine = sweepsim_nc::Machine::named("trunnion-bc").unwrap();
    let program = siemens::read("TRAORI\nG1 X0 Y0 Z0 A3=0 B3=0 C3=1 F100\nX9 A3=1 C3=1", &options).unwrap();
    near(program.poses[1].pose.axis(), [half, 0.0, half]);
    assert!((program.positions[1].abc[1] - 45.0).abs() < 1e-9);
    // A plane turned by 90° about X: its z is −Y of the part; the tool is turned into it.
    let text = "G0 X0 Y0 Z0\nCYCLE800(1,\"TC1\",0,57,10,0,0,90,0,0,0,0,0,1)\nG0 X1 Y2 Z3\nG1 Z0 F100";
    let program = read(text);
    let last = program.poses.last().unwrap();
    near(last.pose.tip(), [11.0, 0.0, 2.0]);
    near(last.pose.axis(), [0.0, -1.0, 0.0]);
    // Three angles about turned axes: Rx(30) Ry(40) Rz(50).
    let program = read("CYCLE800(0,\"\",0,57,0,0,0,30,40,50,0,0,0,1)\nG0 X1 Y2 Z3");
    let (x, y) = (30_f64.to_radians(), 40_f64.to_radians());
    near(
        program.poses[0].pose.axis(),
        [y.sin(), -x.sin() * y.cos(), x.cos() * y.cos()],
    );
}

#[test]
fn control_structures() {
    for (text, x) in [
        ("R1=0\nLOOP1: R1=R1+1\nIF R1<5 GOTOB LOOP1\nG0 X=R1 Y0 Z0", 5.0),
        ("G0 Y0 Z0 X1\nGOTOF N100\nX2\nN100 G91 X5", 6.0),
        ("R1=2\nIF R1==2\nG0 X1 Y0 Z0\nELSE\nG0 X2 Y0 Z0\nENDIF", 1.0),
        ("R1=3\nIF R1==2\nG0 X1 Y0 Z0\nELSE\nG0 X2 Y0 Z0\nENDIF", 2.0),
        ("R1=0\nWHILE R1<7\nR1=R1+2\nENDWHILE\nG0 X=R1 Y0 Z0", 8.0),
        ("R2=0\nFOR R1=1 TO 4\nR2=R2+R1\nENDFOR\nG0 X=R2 Y0 Z0", 10.0),
        ("R2=7\nFOR R1=1 TO 0\nR2=R2+R1\nENDFOR\nG0 X=R2 Y0 Z0", 7.0),
        ("R1=0\nREPEAT\nR1=R1+1\nUNTIL R1>=3\nG0 X=R1 Y0 Z0", 3.0),
        (
            "R1=0\nLOOP\nR1=R1+1\nIF R1>8 GOTOF OUT\nENDLOOP\nOUT: G0 X=R1 Y0 Z0",
            9.0,
        ),
        ("G0 X0 Y0 Z0\nSTEP: G91 X1\nG90\nREPEAT STEP P=4", 5.0),
        ("G0 X0 Y0 Z0\nA: G91 X1\nB: X10\nX100\nREPEAT A B P=2\nREPEATB B", 143.0),
    ] {
        ends_at(text, [x, 0.0, 0.0]);
    }
}

#[test]
fn subprograms() {
    let archive = "%_N_MAIN_MPF\nG0 X0 Y0 Z0\nSTEP(5, 2) \nSTEP(1,0) P3\nL10\nM30\n%_N_STEP_SPF\nPROC STEP(REAL DX, REAL DY)\nG91 X=DX Y=DY\nG90\nRET\n%_N_L10_SPF\nZ9\nM17\n";
    let program = read(archive);
    near(*tips(&program).last().unwrap(), [8.0, 2.0, 9.0]);
    // Moves keep their line and the calls that led to them.
    let step = &program.poses[1];
    assert_eq!(
        (
            step.line,
            program.calls_of(step.call).map(|call| call.line).collect::<Vec<_>>()
        ),
        (9, vec![3])
    );
    // From a library.
    let library =
        |name: &str| (name == "POCKET1").then(|| (PathBuf::from("POCKET1.SPF"), "G1 Z-1 F50\nG0 Z1\nM17".to_owned()));
    let text = "G0 X0 Y0 Z1\nMCALL POCKET1\nX10\nX20\nMCALL\nX30";
    let program = siemens::read_with(text, &ReadOptions::default(), &library).unwrap();
    assert_eq!(
        program.poses.iter().filter(|pose| pose.pose.tip()[2] == -1.0).count(),
        2
    );
    assert_eq!(program.files.last().unwrap(), &PathBuf::from("POCKET1.SPF"));
    assert!(error("G0 X0 Y0 Z1\nPOCKET1").contains("2:1: the call of POCKET1 is not supported yet: it is missing"));
    assert!(error("%_N_A_MPF\nG0 X0 Y0 Z0\nB\n%_N_B_SPF\nB\nM17").contains("called within itself"));
}

#[test]
fn drilling() {
    let program = read("G0 X5 Y6 Z20 F100\nMCALL CYCLE82(10,0,2,-8,,0.5)\nX7\nMCALL\nX0");
    let expected = [
        [5.0, 6.0, 20.0],
        [7.0, 6.0, 20.0],
        [7.0, 6.0, 2.0],
        [7.0, 6.0, -8.0],
        [7.0, 6.0, 10.0],
        [0.0, 6.0, 10.0],
    ];
    assert_eq!(tips(&program), expected);
    let rapid: Vec<bool> = program.poses.iter().map(|pose| pose.rapid).collect();
    assert_eq!(rapid, [true, true, true, false, true, true]);
    assert!(
        program
            .events
            .iter()
            .any(|event| event.kind == EventKind::Dwell { seconds: 0.5 })
    );
    // Relative depth; infeeds of 5, 4, 3, and the rest, with the chip removed each time.
    let program = read("G0 X0 Y0 Z20 F100\nCYCLE83(10,1,2,,15,,5,1,0,,,1)");
    let depths: Vec<f64> = program
        .poses
        .iter()
        .filter(|pose| !pose.rapid)
        .map(|pose| pose.pose.tip()[2])
        .collect();
    assert_eq!(depths, [-4.0, -8.0, -11.0, -13.0, -14.0]);
}

#[test]
fn tools_events_and_machine_moves() {
    let program = read(
        "T=\"MILL\"\nM6\nS5000 M3 M8\nG54 G0 X1 Y2 Z3\nMSG(\"go; on\")\nSUPA G0 Z500 D0\nT=\"DRILL\" M6\nD1 G0 X4 Y5 Z6\nM30\nX9",
    );
    let tools: Vec<_> = program.poses.iter().map(|pose| (pose.tool, pose.joined)).collect();
    assert_eq!(tools, [(Some(1), false), (Some(2), false)]);
    assert!(
        program
            .events
            .iter()
            .any(|event| event.kind == EventKind::Message("go; on".into()))
    );
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.message.contains("\"DRILL\" is taken as T2"))
    );
    assert!(
        error("G54 G0 X0 Y0 Z0\nG55 X1")
            .starts_with("2:5: a move in G55, which the program does not set, after a move in G54")
    );
}

#[test]
fn bad_programs_say_where_and_what() {
    for (text, message) in [
        (
            "G0 X0 Y0 Z0\nG41 X5",
            "2:1: cutter compensation without a tool: expected T before it",
        ),
        (
            "G0 X0 Y0 Z0\nX=_B",
            "2:3: the variable _B has no value here: expected DEF and a value before it",
        ),
        ("G0 X0 Y0 Z0\nX=1/0", "2:3: a division by 0"),
        ("G0 X0 Y0 Z0\nX5 X6", "2:4: a second X in one block: expected one"),
        (
            "G0 X0 Y0 Z0\nBSPLINE X5",
            "2:1: BSPLINE is not supported yet: the path of the tool would be unknown; expected G0, G1, G2, G3 or CIP",
        ),
        ("G0 X0 Y0 Z0\nG1 X=(1", "2:8: the end of the block here: expected `)`"),
        (
            "G0 X0 Y0 Z0\nGOTOF NOWHERE",
            "2:1: there is no label NOWHERE after this block",
        ),
        (
            "G0 X0 Y0 Z0\nIF 1==1\nX5",
            "2:1: a control structure that is not closed: expected ENDIF",
        ),
        (
            "G0 X0 Y0 Z0\nG2 X5",
            "2:4: this arc has no centre: expected I and J, CR= or AR=",
        ),
        (
            "G0 X0 Y0 Z0\nCYCLE81(5,0,1)",
            "2:1: CYCLE81 without DP or DPR: expected the depth",
        ),
        (
            "G0 X0 Y0 Z0\nX5 B45\n",
            "2:1: a move with the rotary axes turned is without tip control, but must be after M428, M128, G43.4 or TRAORI, or on a machine whose pivots are known (`machine:`; or `tip_control: true` when the coordinates are the tip in the part's frame)",
        ),
        (
            "G0 X0 Y0 Z0\nX=$AA_IM[X]",
            "2:3: the system variable $AA_IM[X] is not supported yet: only the control knows it; expected a number",
        ),
        (
            "MSG(\"only\")",
            "1:1: this program has no move: expected at least one with X, Y and Z known",
        ),
        ("A: G0 X0 Y0 Z0\nGOTOB A", "the number of blocks"),
    ] {
        let found = error(text);
        if text.starts_with("A:") {
            assert!(found.contains(message), "{found}");
        } else {
            assert_eq!(found, message, "{text}");
        }
    }
}

#[test]
fn long_loops_and_archives_run_as_if_written_out() {
    let block = |k: usize, z: usize| format!("G1 X{}.5 Y{} Z{z}\n", k % 7, k % 11);
    let blocks = |z: usize| (0..1500).map(|k| block(k, z)).collect::<String>();
    let written_out: String = (1..4).map(blocks).collect();
    let numbered: String = (0..1500)
        .map(|k| format!("N{k} {}", block(k, 0).replace("Z0", "Z=R1")))
        .collect();
    let looped = format!("FOR R1=1 TO 3\n{numbered}ENDFOR\n");
    let jumped = format!("R1=1\nN0010 R2=0\n{numbered}R1=R1+1\nIF R1<4 GOTOB N0010\n");
    let archive = format!(
        "%_N_MAIN_MPF\n;$PATH=/_N_MPF_DIR\nG0 X0 Y0 Z0\nPART(1)\nPART(2)\nPART(3)\nM30\n%_N_PART_SPF\nPROC PART(REAL DEPTH)\n{}M17\n",
        numbered.replace("R1", "DEPTH").replace("N", "N00")
    );
    let start = "G0 X0 Y0 Z0\n";
    let expected = tips(&read(&format!("{start}{written_out}")));
    assert_eq!(expected.len(), 4501);
    assert_eq!(tips(&read(&format!("{start}{looped}"))), expected);
    assert_eq!(tips(&read(&format!("{start}{jumped}"))), expected);
    assert_eq!(tips(&read(&archive)), expected);
    let wrong = archive.replace("N00700 ", "N00700 ?");
    assert!(error(&wrong).starts_with("710:8:"), "{}", error(&wrong));
}

/// They were left out, or rounded, and the second vector gave a tip that was no number.
#[test]
fn repeats_and_vectors_that_mean_nothing_are_refused() {
    let repeated = |times: &str| format!("G0 X0 Y0 Z0\nA:\nG91 G1 X1 F100\nREPEAT A P={times}\n");
    assert_eq!(tips(&read(&repeated("2"))).len(), 4);
    assert_eq!(tips(&read(&repeated("0"))).len(), 2);
    for times in ["-1", "2.5"] {
        let message = format!("the number of repeats P is {times}, but must be a whole number from 0 on");
        assert!(
            error(&repeated(times)).contains(&message),
            "{}",
            error(&repeated(times))
        );
    }
    for vector in ["A3=0 B3=0 C3=0", "A3=1EX-300"] {
        let found = error(&format!("TRAORI\nG0 X0 Y0 Z0\nG1 X1 {vector} F100\n"));
        assert!(
            found.ends_with("the tool vector is (0, 0, 0): expected a direction"),
            "{found}"
        );
    }
}

/// The units are those of the first move, and feeds are in them; they were millimetres whatever the program said.
#[test]
fn programs_in_inches_have_feeds_in_inches() {
    let found = read("G700\nT1\nG0 X0 Y0 Z0\nG1 X1 F10\nG710 X50.8 F254\nG93 X60 F2\n");
    assert_eq!(found.units, Units::Inch);
    let feeds: Vec<f64> = found.poses.iter().filter_map(|pose| pose.feed).collect();
    assert_eq!(feeds, [10.0, 254.0 * (1.0 / 25.4), 2.0]);
    let seconds: Vec<f64> = found.times().iter().filter_map(|time| time.seconds).collect();
    assert!(
        (seconds[0] - 6.0).abs() < 1e-9 && (seconds[1] - 6.0).abs() < 1e-9,
        "{seconds:?}"
    );
    assert_eq!(read("G71 G0 X0 Y0 Z0\nG1 X1 F10\n").units, Units::Mm);
}
