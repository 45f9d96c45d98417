//! Tools of CL files.

use super::{notes, read};
use sweepsim_motion::{Apt, Tool};
use sweepsim_nc::CutterKind;

#[test]
fn described_before_they_are_loaded() {
    let text = "UNIT/MM\nINSERT/[HOLDER=C40-M12EM2] 12MM CRB 2FL 25 LOC\nCUTTER/12.,0,6.,0,0,0,74.\nLOAD/TOOL,3\n\
                CSI_SET_FLUTE_LENGTH/25.\nCSI_SET_EXTENSION_LENGTH/50.\nSELECT/TOOL,1\nRAPID/\nGOTO/0,0,5\n\
                CUTTER/6.,0,3.,1.802582,31.,0,102.\nLOAD/TOOL,16\nCSI_SET_FLUTE_LENGTH/70.\nGOTO/0,0,0\n";
    let program = read(text);
    let mill = &program.tools[&3];
    assert_eq!(mill.name.as_deref(), Some("12MM CRB 2FL 25 LOC"));
    assert_eq!(mill.holder_name.as_deref(), Some("C40-M12EM2"));
    assert_eq!(
        (mill.diameter, mill.flute_length, mill.stick_out),
        (Some(12.0), Some(25.0), Some(50.0))
    );
    let built = mill.build().unwrap();
    // The flutes cut; between them and the holder there is a shank.
    assert_eq!(
        mill.cutter_ron().unwrap(),
        "Apt(d: 12.0, r: 0.0, e: 6.0, f: 0.0, a: 0.0, b: 0.0, h: 25.0)"
    );
    assert_eq!(
        mill.bodies_ron().unwrap(),
        ["Shank(Profile(start: (0.0, 25.0), segments: [Line((6.0, 25.0)), Line((6.0, 50.0)), Line((0.0, 50.0))]))"]
    );
    assert_eq!(built.bodies.len(), 1);
    let drill = &program.tools[&16];
    let CutterKind::Apt(apt) = drill.kind.clone().unwrap() else {
        panic!("seven parameters")
    };
    assert_eq!((apt.a, apt.h, drill.flute_length), (31.0, 102.0, Some(70.0)));
    let tools: Vec<_> = program.poses.iter().map(|pose| pose.tool).collect();
    assert_eq!(tools, [Some(3), Some(16)]);
    assert_eq!(program.sections().count(), 2);
}

#[test]
fn described_after_they_are_loaded() {
    let text =
        "LOADTL / 1\n$$-> CUTTER / 3.000000\nGOTO/0,0,0\nLOADTL / 2, OSETNO, 2\n$$-> CUTTER / 10.0, 2.0\nGOTO/0,0,1\n";
    let program = read(text);
    assert_eq!(program.tools[&1].kind, Some(CutterKind::Flat));
    assert_eq!(
        (program.tools[&2].kind.clone(), program.tools[&2].corner_radius),
        (Some(CutterKind::Bull), Some(2.0))
    );
    assert_eq!(
        program.tools[&1].build().unwrap_err().to_string(),
        "the flute length is missing"
    );
}

#[test]
fn tool_data_of_nx() {
    let text = "TOOL PATH/A,TOOL,A\nTLDATA/MILL,32.0000,5.0000,75.0000,0.0000,0.0000\nLOAD/TOOL,1,ADJUST,1\nGOTO/0,0,0\n\
                TLDATA/MILL,6.,3.,40.,0.,0.\nLOAD/TOOL,2\nGOTO/1,0,0\nTLDATA/DRILL,MILL,10.0,0.0,80.0,118.0,35.0\nLOAD/TOOL,3\nGOTO/2,0,0\n\
                TLDATA/MILL,8.0,1.0,30.0,10.0,0.0\nLOAD/TOOL,4\nGOTO/3,0,0\nTLDATA/TCUTTER,20,0,50\nLOAD/TOOL,5\nGOTO/4,0,0\n";
    let program = read(text);
    let kinds: Vec<_> = program
        .tools
        .values()
        .map(|tool| tool.kind.as_ref().unwrap().name())
        .collect();
    assert_eq!(
        kinds,
        [
            "bull-nose end mill",
            "ball end mill",
            "drill",
            "APT cutter",
            "TLDATA/TCUTTER"
        ]
    );
    let drill = &program.tools[&3];
    assert_eq!(
        (drill.point_angle, drill.flute_length, drill.overall_length),
        (Some(118.0), Some(35.0), Some(80.0))
    );
    assert_eq!(
        program.tools[&5].build().unwrap_err().to_string(),
        "the shape of this tool, \"TLDATA/TCUTTER\", is not supported: describe it in a job with `Profile`"
    );
}

/// The corner of a tapered mill touches the bottom and the flank.
#[test]
fn tapered_mills_are_tangent() {
    for (d, r, l, taper, tip) in [
        (8.0, 1.0, 30.0, 10.0, 0.0),
        (20.0, 2.0, 50.0, 3.0, 5.0),
        (12.0, 0.5, 20.0, -5.0, 0.0),
    ] {
        let program = read(&format!(
            "TLDATA/MILL,{d},{r},{l},{taper},{tip}\nLOAD/TOOL,1\nGOTO/0,0,0\n"
        ));
        let Some(CutterKind::Apt(apt)) = program.tools[&1].kind.clone() else {
            panic!("seven parameters")
        };
        assert_eq!((apt.d, apt.r, apt.a, apt.b, apt.h), (d, r, tip, taper, l));
        let (_, warnings) = Tool::apt(&apt).unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
        let off = Tool::apt(&Apt { e: apt.e - 0.1, ..apt });
        assert!(
            off.is_err() || !off.unwrap().1.is_empty(),
            "another corner is not tangent"
        );
    }
}

#[test]
fn tools_without_a_number_get_one() {
    let program = read(
        "CUTTER/10,0,5,0,0,0,30\nGOTO/0,0,0\nCUTTER/6,3,0,3,0,0,30\nGOTO/1,0,0\nCUTTER/10,0,5,0,0,0,30\nGOTO/2,0,0\n",
    );
    let tools: Vec<_> = program.poses.iter().map(|pose| pose.tool).collect();
    assert_eq!(tools, [Some(1), Some(2), Some(1)]);
    assert_eq!(program.sections().count(), 3);
    assert_eq!(
        notes(&program),
        [
            "a tool is described but not loaded: taken as tool 1",
            "a tool is described but not loaded: taken as tool 2"
        ]
    );
    // Nothing is overwritten in silence.
    let program =
        read("CUTTER/10,0,5,0,0,0,30\nLOAD/TOOL,1\nGOTO/0,0,0\nCUTTER/6,0,3,0,0,0,30\nLOAD/TOOL,1\nGOTO/1,0,0\n");
    assert_eq!(program.poses[1].tool, Some(2));
    assert_eq!(
        notes(&program),
        ["tool 1 is described a second time, as another cutter: taken as tool 2"]
    );
}
