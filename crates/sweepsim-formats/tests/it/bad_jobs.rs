//! Jobs with one fault: each gives one line that names the file, the line and the column, and what was expected.

use std::path::Path;

use sweepsim_formats::Job;

use crate::support::{GOOD, check, message};

#[test]
fn the_good_one_is_good() {
    let job = Job::parse(GOOD, Path::new("fixtures/good.ron")).unwrap();
    assert_eq!(
        (job.name.as_str(), job.moves(), job.paths[0].rapid.len()),
        ("good", 1, 1)
    );
}

#[test]
fn one_message_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    file(
        "text.stl",
        "this is a text, long enough to have a header of eighty-four bytes, but it is no STL file at all",
    );
    file("short.stl", "no");
    file(
        "broken.stl",
        "solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 nan\n",
    );
    file("bad.csv", "x,y,z,i,j,k\n0,0,0,0,0,1\n0,0,0,0,zero,1\n");
    file("axis.csv", "x,y,z,i,j,k\n0,0,0,0,0,0\n");
    file("turn.csv", "x,y,z,i,j,k\n0,0,0,0,0,1\n0,0,0,0,0,-1\n");
    file("bad.ngc", "G0 X0 Y0 Z5\nG1 Z-1\nG60 X1\n");
    file("two.ngc", "T7 M6\nG0 X0 Y0 Z5\nG1 Z-1\n");
    file("path.xyz", "");
    let stock = "Block(min: (0, 0, 0), max: (10, 10, 5))";
    let tool = "Ball(radius: 2.0, length: 30.0)";
    let grid = "Grid(min: (0, 0), max: (10, 10), cells: (4, 5))";
    let poses = "poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]";
    let profile = |segments: &str| format!("Profile(start: (0, 0), segments: [{segments}])");
    let cases: Vec<(&str, String, &str)> = vec![
        // Grammar.
        ("units: Mm", "units: Furlong".into(), "job.ron:2:12: Unexpected"),
        (
            "units: Mm",
            "unit: Mm".into(),
            "job.ron:2:5: Unexpected field named `unit`",
        ),
        ("units: Mm,", "units: Mm".into(), "job.ron:3:5: Expected comma"),
        ("1e-6", "\"small\"".into(), "job.ron:3:16: Expected float"),
        (tool, "Ball(radius: 2.0)".into(), "job.ron:7:"),
        (
            tool,
            "Ball(radius: 2.0, lenght: 30.0)".into(),
            "job.ron:7:30: Unexpected field named `lenght`",
        ),
        (
            tool,
            "Cone(radius: 2.0)".into(),
            "job.ron:7:12: Unexpected variant named `Cone`",
        ),
        ("    ],\n)", "    ],".into(), "job.ron:11:7: Unexpected end of RON"),
        // Sizes.
        (
            tool,
            profile(&"Line((1, 1)), ".repeat(2049)),
            "job.ron:7:45: tool 1: the profile has 2049 segments, counting the points of splines, but at most 2048 are supported",
        ),
        // Values.
        (
            "1e-6",
            "0".into(),
            "job.ron:3:16: tolerance is 0, but must be a positive number",
        ),
        ("1e-6", "NaN".into(), "job.ron:3:16: tolerance is NaN"),
        (
            grid,
            grid.replace("(4, 5)", "(4, 0)"),
            "job.ron:4:55: a number of cells is 0",
        ),
        (
            grid,
            grid.replace("(4, 5)", "(1000000, 1000000)"),
            "job.ron:4:51: the grid has 1000000 x 1000000 cells",
        ),
        (
            grid,
            grid.replace("(4, 5)", "(1000000000000, 5)"),
            "job.ron:4:51: the grid has 1000000000000 x 5 cells",
        ),
        (
            grid,
            grid.replace("(4, 5)", "(-4, 5)"),
            "job.ron:4:52: a number of cells is -4",
        ),
        (
            grid,
            grid.replace("max: (10, 10)", "max: (10, inf)"),
            "job.ron:4:39: a corner of the grid is too large, but must be finite, and at most 1e12",
        ),
        (
            grid,
            grid.replace("max: (10, 10)", "max: (10, -10)"),
            "job.ron:4:21: the grid's area from (0, 0) to (10, -10) is empty",
        ),
        (
            stock,
            stock.replace("max: (10, 10, 5)", "max: (10, 10, 0)"),
            "job.ron:5:48: the z of max is 0",
        ),
        (
            stock,
            stock.replace("(0, 0, 0)", "(0, NaN, 0)"),
            "job.ron:5:27: min is NaN",
        ),
        (
            stock,
            "Cylinder(radius: -1, height: 5)".into(),
            "job.ron:5:29: radius is -1, but must be positive",
        ),
        (
            stock,
            "Cylinder(radius: 1e400, height: 5)".into(),
            "job.ron:5:29: radius is too large, but must be positive, and at most 1e12",
        ),
        (
            stock,
            "Cylinder(axis: (0, 0, 0), radius: 1, height: 5)".into(),
            "job.ron:5:27: axis is zero",
        ),
        (
            stock,
            "Mesh(\"none.stl\")".into(),
            "job.ron:5:12: cannot read the stock file none.stl: ",
        ),
        (stock, "Mesh(\"text.stl\")".into(), "text.stl: this is not an STL file"),
        (
            stock,
            "Mesh(\"text.obj\")".into(),
            "text.obj: the extension of this mesh file is .obj, but must be .stl, .ply, .glb, .3mf, .vtp, .step",
        ),
        (
            stock,
            "Mesh(\"short.stl\")".into(),
            "short.stl: this is not an STL file",
        ),
        (
            stock,
            "Mesh(\"broken.stl\")".into(),
            "broken.stl:4:1: `vertex 0 0 nan`: expected",
        ),
        // Tools.
        (
            tool,
            tool.replace("2.0", "-2.0"),
            "job.ron:7:25: tool 1: radius is -2, but must be positive",
        ),
        (tool, tool.replace("2.0", "NaN"), "job.ron:7:25: tool 1: radius is NaN"),
        (tool, tool.replace("30.0", "1.0"), "job.ron:7:38: tool 1: length is 1"),
        (
            tool,
            profile("Line((2, 0)), Line((2, 9))"),
            "job.ron:7:60: tool 1: the profile is open",
        ),
        (
            tool,
            profile("Line((4, 0)), Line((4, 4)), Line((1, 4)), Line((6, 2)), Line((6, 9)), Line((0, 9))"),
            "job.ron:7:88: tool 1: the profile crosses or touches itself: segments 1 and 3",
        ),
        (
            tool,
            profile(
                "Line((2, 0)), Spline(degree: 2, points: [(2, 0), (3, 4), (2, 9)], weights: Some([1, 0, 1])), Line((0, 9))",
            ),
            "job.ron:7:121: tool 1: profile segment 1: weight 1 of the spline is 0",
        ),
        (
            tool,
            profile("Line((2, 0)), Spline(degree: 2, points: [(1, 0), (3, 4), (2, 9)]), Line((0, 9))"),
            "job.ron:7:87: tool 1: profile segment 1: the spline begins at (1, 0), but the profile is at (2, 0)",
        ),
        (
            tool,
            profile("Line((2, 0)), Spline(degree: 3, points: [(2, 0), (3, 4), (2, 9)]), Line((0, 9))"),
            "job.ron:7:86: tool 1: profile segment 1: the spline has 3 points, but its degree needs at least 4",
        ),
        (
            tool,
            profile("Arc(to: (2, 3), centre: (0, 2), turn: Ccw), Line((0, 9))"),
            "job.ron:7:46: tool 1: profile segment 0 is not an arc",
        ),
        (
            tool,
            profile("Line((2, inf)), Line((0, 9))"),
            "job.ron:7:46: tool 1: profile segment 0 has a number that is not finite",
        ),
        (
            tool,
            "Surface(\"x.ron\")".into(),
            "job.ron:7:12: cannot read the tool file",
        ),
        (
            tool,
            "Apt(d: 10, r: -1, e: 4, f: 1, a: 0, b: 0, h: 30)".into(),
            "job.ron:7:26: `r` of the APT cutter is -1",
        ),
        (
            tool,
            "Oval(radius: 4, tip: 5, flank: 85, length: 30)".into(),
            "job.ron:7:33: tool 1: tip is 5, but must be positive and less than the radius",
        ),
        (
            tool,
            "Taper(radius: 4, tip: 1, flank: 85, angle: 95, length: 30)".into(),
            "job.ron:7:55: tool 1: angle is 95",
        ),
        (
            tool,
            "Barrel(radius: 4, flank: 40, height: 10, corner: 5, length: 30)".into(),
            "job.ron:7:61: tool 1: corner is 5, but must be 0 for a sharp rim, or positive and less than half the height",
        ),
        (
            tool,
            "Lens(radius: 4, bottom: 20, corner: -1, length: 30)".into(),
            "job.ron:7:48: tool 1: corner is -1",
        ),
        (tool, format!("{tool}, 1: {tool}"), "job.ron:7:48: a second tool 1"),
        (
            "    paths:",
            format!("    bodies: {{ 1: [Holder({tool})], 1: [Shank({tool})] }},\n    paths:"),
            "job.ron:9:64: a second list of bodies for tool 1: expected each once",
        ),
        // Paths.
        (
            "tool: 1",
            "tool: 3".into(),
            "job.ron:10:20: there is no tool 3 in this job; it has 1",
        ),
        ("tool: 1, ", String::new(), "job.ron:10:9: this path has no tool"),
        (
            poses,
            "poses: []".into(),
            "job.ron:10:30: a path needs at least one pose",
        ),
        (
            poses,
            poses.replace("(1, 0, 1)", "(0, 0, 0)"),
            "job.ron:10:67: the axis (0, 0, 0) has no direction",
        ),
        (
            poses,
            poses.replace("(9, 9, 3)", "(9, NaN, 3)"),
            "job.ron:10:56: the tip (9, NaN, 3) is not finite",
        ),
        (
            poses,
            poses.replace("(1, 0, 1)", "(0, 0, -1)"),
            "job.ron:10:67: the axes of poses 0 and 1",
        ),
        (
            poses,
            format!("{poses}, file: \"bad.csv\""),
            "job.ron:10:86: both `poses` and `file`",
        ),
        (
            ", poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]",
            String::new(),
            "job.ron:10:9: this path has no poses",
        ),
        (
            poses,
            "file: \"none.ngc\"".into(),
            "job.ron:10:29: cannot read the path file none.ngc: ",
        ),
        (
            poses,
            "file: \"path.xyz\"".into(),
            "path.xyz: the content of this path file is not recognised",
        ),
        (
            poses,
            "file: \"bad.csv\"".into(),
            "bad.csv:3:9: j is \"zero\", but must be a number",
        ),
        (
            poses,
            "file: \"axis.csv\"".into(),
            "axis.csv:2:1: the axis (0, 0, 0) has no direction",
        ),
        (
            poses,
            "file: \"turn.csv\"".into(),
            "turn.csv:3:1: the axes of poses 0 and 1",
        ),
        (
            poses,
            "file: \"bad.ngc\"".into(),
            "bad.ngc:3:1: G60: single-direction positioning is not supported yet",
        ),
        (
            poses,
            "file: \"bad.ngc\", arc_tolerance: -1".into(),
            "job.ron:10:55: arc_tolerance is -1",
        ),
        // What says how a program is read.
        (
            "tool: 1, ",
            "tool: 1, machine: \"trunnion-ac\", ".into(),
            "job.ron:10:32: `machine` without a program: it says how a program is read, expected it beside its `file`",
        ),
        (
            "tool: 1, ",
            "tool: 1, offsets: {\"G55\": (1, 2, 3)}, ".into(),
            "job.ron:10:32: `offsets` without a program",
        ),
        (
            poses,
            "file: \"sweep.ron\", tip_control: true".into(),
            "job.ron:10:55: `tip_control` without a program",
        ),
        (
            poses,
            "file: \"two.ngc\", offsets: {\"G55\": (1, 2, 3), \"G55\": (4, 5, 6)}".into(),
            "job.ron:10:75: a second work offset \"G55\": expected each once",
        ),
        // Target and limits.
        (
            "    ],\n)",
            "    ],\n    target: Some(Mesh(\"none.stl\")),\n)".into(),
            "job.ron:12:13: cannot read the target file none.stl",
        ),
        (
            "    ],\n)",
            "    ],\n    limits: Some(Limits(gouge: -1, excess: 0)),\n)".into(),
            "job.ron:12:32: gouge is -1",
        ),
        (
            "    ],\n)",
            "    ],\n    target: Mesh(\"part.STEP\"),\n)".into(),
            "job.ron:12:13: cannot read the target file part.STEP: there is no such file",
        ),
        // Set-ups.
        (
            "    paths: [",
            "    setups: [], paths: [".into(),
            "job.ron:9:24: `paths` beside `setups`",
        ),
        (
            "    ],\n)",
            "    ],\n    setups: [Setup(paths: [])],\n)".into(),
            "job.ron:9:12: `paths` beside `setups`",
        ),
        (
            "    paths: [\n        Path(tool: 1, poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]),\n    ],\n",
            String::new(),
            "job.ron:1:1: this job has no paths: expected `paths` or `setups`",
        ),
        (
            "Path(tool: 1, ",
            "Path(tool: 1, frame: Frame(z: (1, 0, 0)), ".into(),
            "job.ron:10:30: the frame's x is zero or parallel",
        ),
        (
            "    paths: [\n        Path(tool: 1, poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]),\n    ],\n",
            "    setups: [Setup(frame: Frame(origin: (inf, 0, 0)), paths: [])],\n".into(),
            "job.ron:9:27: the frame is not finite",
        ),
        (
            "    paths: [\n        Path(tool: 1, poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]),\n    ],\n",
            "    setups: [Setup(paths: [Path(tool: 3, poses: [])])],\n".into(),
            "job.ron:9:39: there is no tool 3",
        ),
        (
            "    paths: [\n        Path(tool: 1, poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]),\n    ],\n",
            "    setups: [Setup(paths: [], fixtures: [Union([Dexels(\"part.dexels\")])])],\n".into(),
            "job.ron:9:42: a fixture cannot be dexels",
        ),
    ];
    check(&cases, folder.path());
    let text = GOOD.replace(poses, "file: \"two.ngc\"").replace("tool: 1, ", "");
    assert!(message(&text, folder.path()).starts_with("two.ngc:2:1: there is no tool 7 in this job"));
}
