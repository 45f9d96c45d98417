//! What each bad file is told.

use super::error;
use sweepsim_nc::{ReadOptions, apt};

#[test]
fn messages() {
    let part = "APT part programs, whose path follows from geometry, are not supported yet: expected a CL file, as APT processors and \
                CAM systems write it, in which GOTO gives every point";
    let unknown = "not supported yet: the path of the tool would be unknown; expected GOTO, CIRCLE or CYCLE";
    for (text, expected) in [
        ("PARTNO x\nFINI\n", "2:1: this program has no move: expected at least one GOTO".to_owned()),
        ("GOTO/1,2\n", "1:1: the number of coordinates of GOTO is 2, but must be 3 (x, y, z) or 6 (with the tool axis)".to_owned()),
        ("GOTO/1,2,3,4,5,6,7,8,9\n", "1:1: the number of coordinates of GOTO is 9, but must be 3 (x, y, z) or 6 (with the tool axis)".to_owned()),
        ("GOTO/1,2,z\n", "1:10: GOTO to a named point is not supported yet: expected a CL file, in which GOTO has coordinates".to_owned()),
        ("GOTO/1,2,1e999\n", "1:10: a number of GOTO is \"1e999\", but must be a number".to_owned()),
        ("\nGOTO/1,2,3,0,0,0\n", "2:1: the tool axis is (0, 0, 0), but must be a direction".to_owned()),
        ("GOTO/0,0,0\nGOTO/0,0,1,0,0,-1\n", "2:1: the tool axis is the opposite of the one before, but must be less than half a turn away".to_owned()),
        ("PL1=PLANE/0,0,1,0\n", format!("1:1: {part}")),
        ("GOTO/0,0,0\nTLLFT,GOFWD/PL5,ON,PL1\n", format!("2:1: {part}")),
        ("GOTO/0,0,0\nlp)loopst\n", format!("2:1: {part}")),
        ("GOTO/0,0,0\nCOPY/1,SAME,3\n", format!("2:1: copies of the path are {unknown}")),
        ("GOTO/0,0,0\nTRANS/1,0,0\n", format!("2:1: shifts of the path are {unknown}")),
        ("GOTO/0,0,0\nCALSUB/A\n", format!("2:1: subprograms are {unknown}")),
        ("CIRCLE/0,0,0,0,0,1\nGOTO/1,0,0\n", "2:1: an arc without a start: expected a GOTO before it".to_owned()),
        ("GOTO/1,0,0\nCIRCLE/0,0,0,0,0,1\nFINI\n", "2:1: an arc without an end: expected a GOTO after CIRCLE".to_owned()),
        ("GOTO/1,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,2,0\n", "3:1: the arc has two radii: its start is 1 mm and its end 2 mm from its axis, expected the same".to_owned()),
        ("GOTO/1,0,0\nCIRCLE/0,0,0,0,0,1,3\nGOTO/0,1,0\n", "3:1: the arc's radius is 3 mm, but its start is 1 mm from its axis".to_owned()),
        ("GOTO/0,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,0,0\n", "3:1: the arc has no radius: its ends are 0 and 0 mm from its axis".to_owned()),
        ("GOTO/1,0,0\nCIRCLE/0,0,0,0,0,0\nGOTO/0,1,0\n", "2:1: the normal of this arc is (0, 0, 0), but must be a direction".to_owned()),
        ("GOTO/1,0,0\nCIRCLE/0,0,0\nGOTO/0,1,0\n", "2:1: the number of numbers of CIRCLE is 3, but must be 6 (centre and normal), 7 (and the radius), or 4 (centre and radius)".to_owned()),
        ("GOTO/1,0,0\nMOVARC/0,0,0\n", "2:1: MOVARC without centre and normal: expected x, y, z, i, j, k, radius, ANGLE, a".to_owned()),
        ("GOTO/1,0,0\nMOVARC/0,0,0,0,0,1,1,ANGLE,0\n", "2:1: the angle of this arc is 0, but must be not 0, and at most 500000 degrees".to_owned()),
        ("CYCLE/DRILL,RAPTO,3\nGOTO/0,0,0\n", "1:1: this cycle has no depth: expected DEPTH or FEDTO with a number".to_owned()),
        ("CYCLE/DEEP,DEPTH,5,STEP,0\nGOTO/0,0,0\n", "1:1: the peck of this cycle is 0, but must be positive, and at least a 10000th of the depth, 5 mm".to_owned()),
        ("CYCLE/WIBBLE,DEPTH,5\n", "1:1: the cycle WIBBLE is not supported yet: expected one of DRILL, DEEP, DEEP2, BRKCHP, THRU, FACE, CSINK, TAP, BORE, REAM, CBORE, SPOTDR, CHIP, RIGID".to_owned()),
        ("CUTTER/\nGOTO/0,0,0\n", "1:1: CUTTER without numbers: expected d, r, e, f, a, b, h".to_owned()),
        ("CUTTER/-5\nGOTO/0,0,0\n", "1:1: a length of CUTTER is -5, but must be 0 or greater".to_owned()),
        ("CUTTER/5,0,0,0,31\nGOTO/0,0,0\n", "1:1: CUTTER with an angle but without a height: expected d, r, e, f, a, b, h".to_owned()),
        ("TLDATA/MILL,5\nGOTO/0,0,0\n", "1:1: TLDATA/MILL without its measures: expected diameter, lower radius, length, taper and tip angle".to_owned()),
        ("LOAD/TOOL,1.5\n", "1:1: a tool number is 1.5, but must be a whole number".to_owned()),
        ("UNITS/FURLONG\n", "1:1: the unit is \"FURLONG\", but must be MM, INCHES, CM, FEET or METER".to_owned()),
        ("MSYS/0,0,0,1,0,0\n", "1:1: the number of numbers in MSYS is 6, but must be 9: the origin, the x axis and the y axis".to_owned()),
        ("MSYS/0,0,0,1,0,0,1,0,0\n", "1:1: the axes of MSYS have lengths 1 and 1 and the scalar product 1: expected perpendicular unit vectors".to_owned()),
        ("CSYS/1,0,0,5,0,1,0,0,0,0,1,0\nTRNTYP/LOCAL\nGOTO/0,0,0\n", "2:1: coordinates in the frame of CSYS (TRNTYP other than WORLD) are not supported yet: expected TRNTYP/WORLD".to_owned()),
        ("GODLTA/1,0,0\n", "1:1: GODLTA without a start: expected a GOTO before it".to_owned()),
        ("GOTO/0,0,0\nGODLTA/1,0\n", "2:1: the number of numbers of GODLTA is 2, but must be 1 (along the tool axis) or 3".to_owned()),
        ("FROM/SETPT\nGOTO/0,0,0\n", "1:1: FROM without coordinates: expected x, y, z, and perhaps the tool axis".to_owned()),
        ("NURBS/\nKNOT/0,1\nCNTRL/0,0,0\nGOTO/0,0,0\n", "1:1: a curve with 2 knots and 1 control points: expected 2 to 10 more knots than points".to_owned()),
        ("KNOT/0,1\nCNTRL/0,0\nGOTO/0,0,0\n", "2:1: the number of numbers of CNTRL is 2, but must be a multiple of 3: the coordinates of control points".to_owned()),
    ] {
        assert_eq!(error(text), expected, "{text}");
    }
}

#[test]
fn all_problems_at_once() {
    let text = "GOTO/0,0\nCOPY/1\nGOTO/1,1,1\nTRANS/1,0,0\nCOPY/2\n";
    let error = apt::read(text, &ReadOptions::default()).unwrap_err();
    let lines = |error: &sweepsim_nc::NcError| error.position().unwrap().line;
    let further: Vec<_> = error.further().iter().map(lines).collect();
    assert_eq!((lines(&error), further), (1, vec![2, 4]), "each message once");
    let mut options = ReadOptions::default();
    options.arc_tolerance = f64::NAN;
    assert!(apt::read("GOTO/0,0,0", &options).is_err());
}

#[test]
fn poses_and_events_have_a_limit() {
    let mut options = ReadOptions::default();
    options.most_poses = 3;
    let moves = "GOTO/0,0,0\nGOTO/1,0,0\nGOTO/2,0,0\n";
    assert_eq!(
        apt::read(&format!("UNITS/MM\n{moves}FINI\n"), &options)
            .unwrap()
            .poses
            .len(),
        3
    );
    let error = apt::read(&format!("UNITS/MM\n{moves}GOTO/3,0,0\nFINI\n"), &options).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("5:1: the number of poses and events is 3"),
        "{error}"
    );
    let error = apt::read(&format!("UNITS/MM\n{moves}STOP\nSTOP\nSTOP\nOPSTOP\nFINI\n"), &options).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("8:1: the number of poses and events is 3"),
        "{error}"
    );
}
