//! Klartext as CAM systems write it, in words of our own.

use sweepsim_nc::{CutterKind, Program, ReadOptions, heidenhain};

use crate::found::rounded_tips;

fn read(text: &str) -> Program {
    heidenhain::read(text, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn back_along_the_tool() {
    let start = "L X+0 Y+0 Z+5 FMAX\nL Z-1 F100\n";
    assert_eq!(
        *rounded_tips(&read(&format!("{start}L M140 MB50 FMAX"))).last().unwrap(),
        [0.0, 0.0, 49.0]
    );
    // In a tilted plane the tool's axis is its z.
    let tilted = format!("PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN FMAX\n{start}L M140 MB+10 F500\n");
    let program = read(&tilted);
    assert_eq!(*rounded_tips(&program).last().unwrap(), [9.0, 0.0, 0.0]);
    assert!(!program.poses.last().unwrap().rapid);
    // To the end of the travel: where that is, only the machine knows.
    let program = read(&format!(
        "{start}M140 MB MAX\nL X+9 Y+9 R0 FMAX\nL Z+5 FMAX\nL Z-1 F100\n"
    ));
    assert_eq!(rounded_tips(&program)[2..], [[9.0, 9.0, 5.0], [9.0, 9.0, -1.0]]);
    let [assumed] = &program.assumptions[..] else {
        panic!("{:?}", program.assumptions)
    };
    assert!(assumed.what.contains("M140") && assumed.line == 3 && !assumed.changes_verdict);
}

#[test]
fn angles_that_a_plane_needs() {
    let text = "L X+0 Y+0 Z+50 FMAX\nPLANE SPATIAL SPA90 SPB0 SPC180 STAY SEQ- TABLE ROT\nL A+Q120 C+Q122 FMAX\nL X+0 Y+0 Z+5 FMAX\nL Z+1 F100\n";
    let program = read(text);
    let last = program.poses.last().unwrap();
    // Turned by 90° about X, then by 180° about Z: z is the part's +y.
    let axis = last.pose.axis();
    assert!((axis[1] - 1.0).abs() < 1e-9, "{axis:?}");
    assert_eq!(rounded_tips(&program).last().unwrap(), &[0.0, 1.0, 0.0]);
    let [assumed] = &program.assumptions[..] else {
        panic!("{:?}", program.assumptions)
    };
    assert!(assumed.settle == "--machine" && assumed.taken.contains("trunnion-ac") && assumed.changes_verdict);
    let mut given = ReadOptions::default();
    given.machine = sweepsim_nc::Machine::named("trunnion-ac").unwrap();
    let known = heidenhain::read(text, &given).unwrap();
    assert!(known.assumptions.is_empty());
    let end = known.poses.last().unwrap().pose;
    assert!((end.axis()[1] - 1.0).abs() < 1e-9 && (end.tip()[1] - 1.0).abs() < 1e-9);
    // SEQ- wants a negative angle of the tilting axis.
    let turn = known.positions.last().unwrap().abc;
    assert!((turn[0] + 90.0).abs() < 1e-9, "{turn:?}");
}

#[test]
fn tools_of_comments_and_their_names() {
    let text = "0 BEGIN PGM P1 MM\n1 ;T2 D=+4 CR=+0 - ZMIN=-15 - flat end mill\n2 ;  #3 D=10 - ZMIN=-4.5 - flat end mill\n\
                3 ; T17 | MILL-8 / DM=8 CR=0 TL=357\n4 TOOL CALL \"MILL-8\" Z S9000\n5 L X+0 Y+0 Z+5 FMAX\n6 L Z-1 F100\n7 END PGM P1 MM\n";
    let program = read(text);
    assert_eq!(program.poses[0].tool, Some(17));
    let sizes: Vec<_> = program
        .tools
        .iter()
        .map(|(number, tool)| (*number, tool.diameter, tool.kind.clone()))
        .collect();
    assert_eq!(
        sizes[..2],
        [
            (2, Some(4.0), Some(CutterKind::Flat)),
            (3, Some(10.0), Some(CutterKind::Flat))
        ]
    );
    assert_eq!((sizes[2].0, sizes[2].1), (17, Some(8.0)));
}

#[test]
fn cycles_of_builders_and_probes() {
    let text = "L X+0 Y+0 Z+5 FMAX\nCYCL DEF 392 ATC~\nQ240=+1 ;MODE~\nQ241=+3 ;WEIGHT\nTCH PROBE 412 DATUM INSIDE CIRCLE~\nQ321=+0 ;CENTRE\nCYCL DEF 240 CENTERING~\nQ200=+2~\nQ343=+1~\nQ201=-9~\nQ344=-6~\nQ206=+100~\nQ203=+0~\nQ204=+50\nCYCL CALL\n";
    let program = read(text);
    // A point of 90 degrees is 3 mm deep where it is 6 mm wide.
    assert!(rounded_tips(&program).contains(&[0.0, 0.0, -3.0]));
    let what: Vec<&str> = program.assumptions.iter().map(|one| one.what.as_str()).collect();
    assert_eq!(
        what,
        ["cycle 392, of the machine's builder or its probe", "what a probe finds"]
    );
    let deep = read(
        "CYCL DEF 241 Q200=2 Q201=-40 Q206=100 Q211=0 Q203=0 Q204=50 Q379=5 Q253=750 Q208=1000\nL X+1 Y+2 Z+50 FMAX M99\n",
    );
    assert!(rounded_tips(&deep).contains(&[1.0, 2.0, -40.0]));
}
