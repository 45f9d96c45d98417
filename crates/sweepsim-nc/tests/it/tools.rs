//! Tool libraries.

use std::path::Path;
use sweepsim_motion::ProfileSegment;
use sweepsim_nc::tools::ToolLibrary;
use sweepsim_nc::{CutterKind, HolderSegment, NcError, StockDescription, ToolDescription, tools};

fn parse(text: &str) -> Result<ToolLibrary, NcError> {
    tools::parse(text, Path::new("/no/such/folder/Library/tools"), false)
}

const FUSION: &str = r#"{"data": [
    {"type": "bull nose end mill", "unit": "inches", "description": "1/2 bull",
     "geometry": {"DC": 0.5, "RE": 0.03, "LCF": 1, "shoulder-length": 1.25, "shoulder-diameter": 0.4, "SFDM": 0.5, "LB": 2, "OAL": 3},
     "expressions": {"tool_fluteLength": "30 mm", "tool_bodyLength": "tool_diameter * 4"},
     "holder": {"unit": "millimeters", "description": "ER32", "segments": [
        {"height": 20, "lower-diameter": 40, "upper-diameter": 50}, {"height": 10, "lower-diameter": 63, "upper-diameter": 63}]},
     "post-process": {"number": 7}},
    {"type": "drill", "unit": "millimeters", "geometry": {"DC": 5, "SIG": 118, "LCF": 40}, "post-process": {"number": 2}},
    {"type": "chamfer mill", "unit": "millimeters", "geometry": {"DC": 10, "TA": 45, "tip-diameter": 2, "LCF": 8}, "post-process": {"number": 3}},
    {"type": "tap right hand", "unit": "millimeters", "geometry": {"DC": 5}, "post-process": {"number": 4}},
    {"type": "face mill", "unit": "millimeters", "geometry": {"DC": 50, "RE": 0, "LCF": 6}, "post-process": {"number": 5}},
    {"type": "holder", "segments": []},
    {"type": "ball end mill", "unit": "millimeters", "geometry": {"DC": 6, "LCF": 20}},
    {"type": "ball end mill", "unit": "millimeters", "geometry": {"DC": 6}, "post-process": {"number": 2}}
], "version": 36}"#;

#[test]
fn fusion() {
    let library = parse(FUSION).unwrap();
    assert_eq!(library.tools.keys().copied().collect::<Vec<_>>(), [2, 3, 4, 5, 7]);
    let bull = &library.tools[&7];
    assert_eq!((bull.diameter, bull.stick_out), (Some(12.7), Some(50.8)));
    assert_eq!(bull.flute_length, Some(30.0), "the expression overrides the number");
    assert_eq!(
        bull.holder,
        [
            HolderSegment {
                height: 20.0,
                lower_diameter: 40.0,
                upper_diameter: 50.0
            },
            HolderSegment {
                height: 10.0,
                lower_diameter: 63.0,
                upper_diameter: 63.0
            }
        ]
    );
    // Neck and shank below the holder, two segments above it.
    let built = bull.build().unwrap();
    assert_eq!(built.bodies.len(), 4);
    let ends: Vec<[f64; 2]> = built
        .bodies
        .iter()
        .map(|body| match body.solid.profile().unwrap().segments()[1] {
            ProfileSegment::Line { to } => to,
            _ => panic!("a line"),
        })
        .collect();
    let by_hand = [[5.08, 31.75], [6.35, 50.8], [25.0, 70.8], [31.5, 80.8]];
    for (found, expected) in ends.iter().zip(by_hand) {
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
            "{found:?} {expected:?}"
        );
    }
    let messages: Vec<_> = library.notes.iter().map(|note| note.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "the expression \"tool_diameter * 4\" is not evaluated: the library's number is used",
            "entry 7 of the library has no tool number: ignored",
            "a second tool 2: ignored",
        ]
    );
    // A tap is what its threads turn within.
    let mut tap = library.tools[&4].clone();
    assert_eq!(tap.build().unwrap_err().to_string(), "the flute length is missing");
    tap.flute_length = Some(12.0);
    let built = tap.build().unwrap();
    assert_eq!(built.cutter.bounding_cylinder().radius, 2.5);
    assert_eq!(built.notes, ["a tap right hand: the solid is its envelope"]);
    tap.kind = Some(CutterKind::Other("form mill".into()));
    assert_eq!(
        tap.build().unwrap_err().to_string(),
        "the shape of this tool, \"form mill\", is not supported: describe it in a job with `Profile`"
    );
    // A cone from radius 1 to 5 over 4, and a cylinder up to 8.
    assert_eq!(
        library.tools[&3].cutter_ron().unwrap(),
        "Profile(start: (0.0, 0.0), segments: [Line((1.0, 0.0)), Line((5.0, 4.0)), Line((5.0, 8.0)), Line((0.0, 8.0))])"
            .replace("4.0)), Line((5.0, 8", &format!("{})), Line((5.0, 8", 4.0 / 45_f64.to_radians().tan()))
    );
}

#[test]
fn freecad() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("Library");
    let bits = folder.path().join("Bit");
    std::fs::create_dir_all(&library).unwrap();
    std::fs::create_dir_all(&bits).unwrap();
    let bit = r#"{"version": 2, "name": "mill", "shape": "endmill.fcstd",
        "parameter": {"CuttingEdgeHeight": "30.0000 mm", "Diameter": "0.25 in", "Length": "50 mm", "ShankDiameter": "3.0000 mm"}}"#;
    std::fs::write(bits.join("a.fctb"), bit).unwrap();
    std::fs::write(
        library.join("x.fctl"),
        r#"{"tools": [{"nr": 4, "path": "a.fctb"}], "version": 1}"#,
    )
    .unwrap();
    let read = tools::read_library(&library.join("x.fctl"), false).unwrap();
    let tool = &read.tools[&4];
    assert_eq!(
        (tool.diameter, tool.flute_length, tool.overall_length),
        (Some(6.35), Some(30.0), Some(50.0))
    );
    assert_eq!(tool.build().unwrap().bodies.len(), 1);
    assert_eq!(
        tools::read_library(&bits.join("a.fctb"), false).unwrap().tools[&1].kind,
        Some(CutterKind::Flat)
    );
    std::fs::remove_file(bits.join("a.fctb")).unwrap();
    let message = tools::read_library(&library.join("x.fctl"), false)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("the file of tool 4 is \"a.fctb\", but must be a file in"),
        "{message}"
    );
}

#[test]
fn tables_of_linuxcnc() {
    let text = "; a table\nT1 P1 D10.0 ;10mm end mill\nT2 P2 Z+0.511 D-0.5\n\nT99999 P99999 Z+0.1 ;big\n";
    let library = parse(text).unwrap();
    assert_eq!(library.tools.len(), 3);
    assert_eq!(
        (library.tools[&1].diameter, library.tools[&1].name.as_deref()),
        (Some(10.0), Some("10mm end mill"))
    );
    assert_eq!((library.offsets[&2].length, library.offsets[&2].diameter), (0.511, 0.5));
    assert_eq!(
        library.tools[&1].build().unwrap_err().to_string(),
        "the shape is missing"
    );
    let inch = tools::parse("T1 D1", Path::new("t"), true).unwrap();
    assert_eq!(inch.tools[&1].diameter, Some(25.4));
}

#[test]
fn projects_of_camotics() {
    let text = r#"{"units": "metric", "tools": {
        "1": {"units": "imperial", "shape": "ballnose", "length": 1, "diameter": 0.125},
        "30": {"units": "metric", "shape": "conical", "length": 5, "diameter": 10},
        "5": {"units": "metric", "shape": "snubnose", "length": 20, "diameter": 10, "snub_diameter": 2}},
        "workpiece": {"bounds": {"min": [0, 0, -20], "max": [80, 80, 0]}}, "files": ["bear.nc"]}"#;
    let library = parse(text).unwrap();
    assert_eq!(
        (library.tools[&1].diameter, library.tools[&1].flute_length),
        (Some(3.175), Some(25.4))
    );
    assert_eq!(
        library.tools[&30].cutter_ron().unwrap(),
        "Profile(start: (0.0, 0.0), segments: [Line((5.0, 5.0)), Line((0.0, 5.0))])"
    );
    assert!(library.tools[&5].build().is_ok());
    assert_eq!(
        library.stock,
        Some(StockDescription::Block {
            min: [0.0, 0.0, -20.0],
            max: [80.0, 80.0, 0.0]
        })
    );
    assert_eq!(library.programs, ["bear.nc"]);
}

#[test]
fn messages() {
    let expected = "a tool library of Fusion 360 (.json), a library or bit of FreeCAD (.fctl, .fctb), a tool table of LinuxCNC (.tbl) \
                    or a project of CAMotics (.camotics)";
    for (text, message) in [
        (
            "",
            format!("the content of this tool file is not recognised, but must be {expected}"),
        ),
        (
            "{}",
            format!("the content of this tool file is JSON without tools, but must be {expected}"),
        ),
        (
            "{\"a\": }",
            "1:7: this is not JSON: expected value at line 1 column 7".to_owned(),
        ),
        (
            "T1 P1\nP2 D5\n",
            "2:1: a line of the tool table without T: expected the tool's number".to_owned(),
        ),
        (
            "T1 D5mm\n",
            "1:1: a word of the tool table is \"D5mm\", but must be like T1, P1, Z12.5 or D6".to_owned(),
        ),
        (
            r#"{"tools": [{"nr": 4, "path": "a.fctb"}]}"#,
            "the file of tool 4 is \"a.fctb\", but must be a file in /no/such/folder/Library or /no/such/folder/Bit"
                .to_owned(),
        ),
    ] {
        assert_eq!(parse(text).unwrap_err().to_string(), message, "{text}");
    }
}

#[test]
fn what_is_missing_is_named() {
    let missing = |tool: &ToolDescription| tool.build().unwrap_err().to_string();
    let mut tool = ToolDescription::default();
    assert_eq!(missing(&tool), "the shape is missing");
    tool.kind = Some(CutterKind::Drill);
    assert_eq!(missing(&tool), "the diameter is missing");
    tool.diameter = Some(10.0);
    assert_eq!(missing(&tool), "the point angle is missing");
    tool.point_angle = Some(200.0);
    assert_eq!(
        missing(&tool),
        "the point angle is 200, but must be between 0 and 180 degrees"
    );
    tool.point_angle = Some(118.0);
    assert_eq!(missing(&tool), "the flute length is missing");
    tool.flute_length = Some(60.0);
    assert!(tool.build().is_ok());
    for (kind, expected) in [
        (CutterKind::Bull, "the corner radius is missing"),
        (CutterKind::Chamfer, "the taper angle is missing"),
        (CutterKind::Tapered, "the taper angle is missing"),
        (CutterKind::Lollipop, "the neck diameter is missing"),
        (CutterKind::Dovetail, "the taper angle is missing"),
    ] {
        tool.kind = Some(kind);
        assert_eq!(missing(&tool), expected);
    }
    tool.kind = Some(CutterKind::Ball);
    tool.diameter = Some(-1.0);
    assert_eq!(missing(&tool), "the diameter is -1, but must be a positive number");
    // A description fills in another one's gaps, but shapes are not mixed.
    let mut known = ToolDescription::new(CutterKind::Bull);
    known.diameter = Some(10.0);
    let mut other = ToolDescription::new(CutterKind::Ball);
    (other.diameter, other.corner_radius, other.flute_length) = (Some(8.0), Some(4.0), Some(30.0));
    let both = known.or(&other);
    assert_eq!(
        (both.diameter, both.corner_radius, both.flute_length),
        (Some(10.0), None, Some(30.0))
    );
}

#[test]
fn a_taper_that_is_not_looked_at_is_a_note() {
    let geometry = r#""geometry": {"DC": 50, "LCF": 6, "TA": 45}"#;
    let library = parse(&format!(
        r#"{{"data": [{{"type": "face mill", {geometry}, "post-process": {{"number": 1}}}}], "version": 36}}"#
    ));
    let notes: Vec<_> = library.unwrap().notes.into_iter().map(|note| note.message).collect();
    let expected = "its taper angle of 45 degrees is not looked at: taken as a cylinder";
    assert_eq!(notes, [expected]);
}

#[test]
fn tapered_mills() {
    let mut tool = ToolDescription::new(CutterKind::Tapered);
    (tool.diameter, tool.taper_angle, tool.flute_length) = (Some(2.0), Some(10.0), Some(20.0));
    assert!(tool.build().is_ok());
    // A ball at the tip touches the flank.
    tool.corner_radius = Some(0.8);
    let built = tool.build().unwrap();
    let segments = built.cutter.profile().unwrap().segments().to_vec();
    assert_eq!(segments.len(), 4);
    let ProfileSegment::Arc { to, centre, .. } = segments[1] else {
        panic!("an arc")
    };
    let radial = [to[0] - centre[0], to[1] - centre[1]];
    let ProfileSegment::Line { to: top } = segments[2] else {
        panic!("a line")
    };
    let flank = [top[0] - to[0], top[1] - to[1]];
    assert!((radial[0] * flank[0] + radial[1] * flank[1]).abs() < 1e-12, "tangent");
    assert!((flank[0] / flank[1] - 10_f64.to_radians().tan()).abs() < 1e-12);
    // The flank meets the bottom at the radius of the tip.
    let at_bottom = to[0] - to[1] * 10_f64.to_radians().tan();
    assert!((at_bottom - 1.0).abs() < 1e-12, "{at_bottom}");
    // A corner as large as the tip is a ball on the axis.
    tool.corner_radius = Some(1.0);
    let built = tool.build().unwrap();
    let ProfileSegment::Arc { to, centre, .. } = built.cutter.profile().unwrap().segments()[0] else {
        panic!("an arc from the tip")
    };
    assert_eq!(centre, [0.0, 1.0]);
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    assert!((to[0] - cos).abs() < 1e-12 && (to[1] - (1.0 - sin)).abs() < 1e-12);
    tool.corner_radius = Some(3.0);
    assert!(
        tool.build()
            .unwrap_err()
            .to_string()
            .starts_with("the corner radius is 3")
    );
}

/// A file of a hole as large as can be takes no room on the disk, and none in memory.
#[test]
fn libraries_and_machines_without_end_are_errors() {
    let folder = std::env::temp_dir().join(format!("sweepsim-endless-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (name, begin) in [
        ("tools.json", "{\"data\": ["),
        ("tools.tbl", "T1 P1 D6\n"),
        ("machine.ron", "Machine("),
    ] {
        let file = folder.join(name);
        std::fs::write(&file, begin).unwrap();
        std::fs::File::options()
            .append(true)
            .open(&file)
            .unwrap()
            .set_len(1 << 40)
            .unwrap();
        let told = if name == "machine.ron" {
            sweepsim_nc::Machine::read_file(&file).unwrap_err().to_string()
        } else {
            tools::read_library(&file, false).unwrap_err().to_string()
        };
        assert!(told.contains("larger than 67108864 bytes"), "{told}");
    }
    // A line without end, which no size tells.
    let file = folder.join("part.nc");
    std::fs::write(&file, "G21 G90\nG0 X0 Y0 Z5\nG1 ").unwrap();
    std::fs::File::options()
        .append(true)
        .open(&file)
        .unwrap()
        .set_len(1 << 40)
        .unwrap();
    let told = sweepsim_nc::read_file(&file, &sweepsim_nc::ReadOptions::default())
        .unwrap_err()
        .to_string();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(
        told.contains("part.nc:3:1: this line is longer than 65536 bytes"),
        "{told}"
    );
}

/// What a library says twice, or in a unit of its own, is said where the tool is used.
#[test]
fn what_was_taken_from_a_library_is_said_with_the_tool() {
    let entry = |unit: &str, diameter: f64| {
        format!(
            r#"{{"type": "flat end mill", "unit": "{unit}", "geometry": {{"DC": {diameter}, "LCF": 20}}, "post-process": {{"number": 1}},
                 "expressions": {{"tool_fluteLength": "2 * x"}}}}"#
        )
    };
    let text = format!(r#"{{"data": [{}, {}]}}"#, entry("parsecs", 6.0), entry("inches", 8.0));
    let library = tools::parse(&text, Path::new("t.json"), false).unwrap();
    let expected = [
        "the unit \"parsecs\" is not known: taken as millimeters",
        "the expression \"2 * x\" is not evaluated: the library's number is used",
        "described again in the same file: the first description is used",
    ];
    assert_eq!(library.tools[&1].build().unwrap().notes, expected);
    let library = tools::parse("T1 P1 D6\nT1 P2 D8\nT2 D3\n", Path::new("t.tbl"), false).unwrap();
    assert_eq!(library.tools[&1].notes, expected[2..]);
    // The first one counts for the control, too.
    assert_eq!(
        (library.offsets[&1].diameter, library.tools[&1].diameter),
        (6.0, Some(6.0))
    );
    assert_eq!(library.tools[&2].notes, [""; 0]);
}
