//! Words that shops use: in every control each of them is understood, or what is assumed or ignored is said.

use std::path::Path;

use sweepsim_nc::{Controller, NoteKind, Program, ReadOptions, read_text};

fn read(controller: Option<Controller>, name: &str, text: &str) -> Program {
    let mut options = ReadOptions::default();
    options.controller = controller;
    read_text(text, Path::new(name), &options).unwrap_or_else(|error| panic!("{controller:?}: {error}\n{text}"))
}

/// Words between two moves, and what is said of them: nothing (of what every control understands), a note, or an assumption.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Said {
    Nothing,
    Ignored,
    Assumed,
}

use Said::{Assumed, Ignored, Nothing};

#[test]
fn words_of_gcode_in_every_dialect() {
    const WORDS: [(&str, Said); 20] = [
        ("M29 S500", Nothing),
        ("G08 P1", Nothing),
        ("G187 P3 E0.01", Ignored),
        ("G05.1 Q1 R5", Ignored),
        ("G05 P10000", Ignored),
        ("G61", Nothing),
        ("G61.1", Nothing),
        ("G64", Nothing),
        ("G62", Nothing),
        ("G103 P1", Ignored),
        ("M19 R90.", Nothing),
        ("M00", Nothing),
        ("M01", Nothing),
        ("/ M08", Ignored),
        ("M88", Nothing),
        ("M140", Ignored),
        ("G22", Ignored),
        ("G13.1", Nothing),
        ("G69", Nothing),
        ("G31 Z-5. F50.", Assumed),
    ];
    let all = [
        None,
        Some(Controller::Fanuc),
        Some(Controller::Haas),
        Some(Controller::LinuxCnc),
        Some(Controller::Grbl),
        Some(Controller::Okuma),
    ];
    let mut tried = 0;
    for controller in all {
        for (words, said) in WORDS {
            // A cycle there.
            if controller == Some(Controller::Okuma) && words.starts_with("G187") {
                continue;
            }
            let text = format!(
                "%\nO1001 (PLATE)\nG21 G90 G17 G40 G49 G80\nT1 M06\nG00 X0. Y0. Z5.\n{words}\nG01 X5. Y1. Z5. F100.\nM30\n%\n"
            );
            let program = read(controller, "plate.nc", &text);
            let last = program.poses.last().unwrap().pose.tip();
            assert_eq!(last, [5.0, 1.0, 5.0], "{controller:?} {words}");
            let kinds: Vec<NoteKind> = program
                .notes
                .iter()
                .filter(|note| note.line == 6)
                .map(|note| note.kind())
                .collect();
            let found = match said {
                Nothing => kinds.is_empty(),
                // A line that is not skipped is read as such.
                Ignored => kinds
                    .iter()
                    .any(|kind| matches!(kind, NoteKind::Ignored | NoteKind::Read)),
                Assumed => kinds.contains(&NoteKind::Assumed) && program.assumptions.len() == 1,
            };
            assert!(found, "{controller:?} {words}: {:?}", program.notes);
            tried += 1;
        }
    }
    assert_eq!(tried, 119);
}

#[test]
fn words_of_siemens() {
    for (words, says) in [
        ("M19", ""),
        ("SPOS=90", ""),
        ("G64 SOFT FFWON COMPCAD", ""),
        ("CYCLE832(0.01,1,1)", ""),
        ("M29 S500", "M29 is not understood: ignored"),
        ("G60 G601", ""),
        ("M0", ""),
        ("M1", ""),
        ("/M8", "optional blocks"),
        ("STOPRE", ""),
        ("$AC_TIMER[1]=0", ""),
        ("CYCLE977(1,,1,50,,,10)", "assumed: the moves of CYCLE977"),
        ("IF $A_IN[1]==1 GOTOF A\nA:", "assumed: the value of $A_IN[1]"),
        ("L100", "assumed: the moves of L100"),
        ("TOOLCALL(1)", "assumed: the moves of TOOLCALL"),
    ] {
        let text = format!("G17 G90 G54 G71\nT=\"MILL_D6\" D1\nM6\nG0 X=0+0 Y0 Z5\n{words}\nG1 X5 Y1 Z5 F100\nM30\n");
        let program = read(None, "plate.mpf", &text);
        assert_eq!(program.controller, Some(Controller::Siemens));
        assert_eq!(program.poses.last().unwrap().pose.tip(), [5.0, 1.0, 5.0], "{words}");
        let of_line = |line: usize| line == 5;
        let notes: Vec<String> = program
            .notes
            .iter()
            .filter(|note| of_line(note.line))
            .map(|note| note.message.clone())
            .collect();
        match says {
            "" => assert!(notes.is_empty(), "{words}: {notes:?}"),
            says => assert!(notes.iter().any(|note| note.starts_with(says)), "{words}: {notes:?}"),
        }
    }
}

#[test]
fn words_of_klartext() {
    for (words, says) in [
        ("M19", ""),
        ("M29", "M29 is not understood: ignored"),
        ("M0", ""),
        ("M1", ""),
        ("/ M8", "optional blocks"),
        ("CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 90", ""),
        ("CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.01", ""),
        ("TCH PROBE 417 DATUM ~\nQ263=1", "assumed: what a probe finds"),
        (
            "TCH PROBE 0.0 REF. PLANE Q1 X-\nTCH PROBE 0.1 X+5 Y+0 Z+0",
            "assumed: what a probe finds",
        ),
        ("FUNCTION MODE MILL", ""),
        ("FUNCTION TOUCHPROBE", ""),
        ("SEL TABLE \"T.D\"", "SEL TABLE moves nothing: ignored"),
        ("DECLARE STRING QS1 = \"A\"", "DECLARE STRING moves nothing: ignored"),
        ("QS2 = \"A\" || \"B\"", "QS2 = moves nothing: ignored"),
        ("SEL PGM \"X.H\"\nCALL SELECTED PGM", ""),
        ("TRANS DATUM AXIS X+5\nTRANS DATUM RESET", ""),
        ("FN 20: WAIT FOR SYNC", "FN 20 moves nothing: ignored"),
        ("FN 9: IF +Q50 EQU +1 GOTO LBL 9", "assumed: the value of Q50"),
        ("M120 LA5", ""),
        ("CYCL DEF 440 PROBE Q1=2", "assumed: cycle 440"),
    ] {
        let text = format!(
            "BEGIN PGM A MM\nTOOL CALL 1 Z S500 F100\nL X+0 Y+0 Z+5 R0 FMAX\n;\n{words}\nL X+5 Y+1 Z+5 F100\nEND PGM A MM\n"
        );
        let program = read(None, "plate.h", &text);
        assert_eq!(program.poses.last().unwrap().pose.tip(), [5.0, 1.0, 5.0], "{words}");
        let notes: Vec<String> = program
            .notes
            .iter()
            .filter(|note| note.line == 5)
            .map(|note| note.message.clone())
            .collect();
        match says {
            "" => assert!(notes.is_empty(), "{words}: {notes:?}"),
            says => assert!(notes.iter().any(|note| note.starts_with(says)), "{words}: {notes:?}"),
        }
    }
}

#[test]
fn cycles_of_haas_whose_moves_are_not_known() {
    for (cycle, name) in [
        ("G150 P5 X1. Y1. Z-1. R1. Q0.5 I1. K0.1 D1 F100.", "the moves of G150"),
        (
            "G47 P0 (A B) X1. Y1. I0. J5. R1. Z-0.2 F50. E20.",
            "the moves of G47 (engraving)",
        ),
        ("G70 I5. J0. L6", "the moves of G70"),
    ] {
        let text = format!("T1 M06\nG00 X0. Y0. Z5.\n{cycle}\nG01 X5. Y1. Z5. F100.\n");
        let program = read(Some(Controller::Haas), "plate.nc", &text);
        assert_eq!(program.assumptions[0].what, name);
        assert!(program.assumptions[0].changes_verdict && program.poses.last().unwrap().pose.tip() == [5.0, 1.0, 5.0]);
    }
}

#[test]
fn a_thousand_problems_are_said_by_kind() {
    // Three kinds, hundreds of times each: each once, with its first line and how often.
    let block = |k: usize| match k % 3 {
        0 => format!("G01 X{k}. F100.\nM140\n"),
        1 => format!("G01 Y{k}. F100.\nG187 P1\n"),
        _ => format!("G01 Z{k}. F100.\nG65 P9811 X{k}.\n"),
    };
    let text = format!("G00 X0 Y0 Z5.\n{}", (0..1002).map(block).collect::<String>());
    let program = read(Some(Controller::Fanuc), "many.nc", &text);
    let said: Vec<String> = program.notes.iter().map(ToString::to_string).collect();
    assert_eq!(said.len(), 3, "{said:?}");
    for (line, note) in [(3, &said[0]), (5, &said[1]), (7, &said[2])] {
        assert!(
            note.starts_with(&format!("line {line}: ")) && note.contains("334 times, first here"),
            "{note}"
        );
    }
    assert_eq!((program.assumptions[0].line, program.assumptions[0].count), (7, 334));
    // As many that differ are as many notes; as many errors are the first hundred.
    let text = format!(
        "G00 X0 Y0 Z5.\n{}G01 X1. F100.\n",
        (2000..3000).map(|k| format!("M{k}\n")).collect::<String>()
    );
    assert_eq!(read(Some(Controller::Fanuc), "many.nc", &text).notes.len(), 1000);
}
