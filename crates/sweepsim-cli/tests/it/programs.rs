//! Programs in place of jobs.

use crate::support::{Workdir, text};
use std::fs;

const CL: &str = "PARTNO plate\nUNITS/MM\nINSERT/Stock Size X30. Y20. Z6.\nINSERT/10MM MILL\nCUTTER/10,0,5,0,0,0,60\nLOAD/TOOL,3\n\
CSI_SET_FLUTE_LENGTH/25\nSPINDL/3000,RPM,CLW\nRAPID\nGOTO/-10,10,5\nFEDRAT/500,MMPM\nGOTO/-10,10,-2\nGOTO/40,10,-2\nRAPID\nGOTO/40,10,20\nFINI\n";

const GCODE: &str = "G21 G90\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F300\nX20\nG3 X20 Y10 J5\nG0 Z5\nM30\n";

fn folder() -> Workdir {
    let folder = Workdir::new("");
    fs::write(folder.path("plate.cls"), CL).unwrap();
    fs::write(folder.path("slot.nc"), GCODE).unwrap();
    folder
}

#[test]
fn a_cl_file_alone_is_simulated() {
    let folder = folder();
    let report = folder.good(&[
        "simulate",
        "plate.cls",
        "--cells",
        "60x40",
        "--only",
        "report,mesh",
        "--out",
        "out",
        "--json",
    ]);
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    // A slot of 10 x 2 mm, through the whole length of the stock.
    let removed = report["volume_removed"].as_f64().unwrap();
    assert!((removed - 30.0 * 10.0 * 2.0).abs() < 1e-6, "{removed}");
    assert_eq!(
        (report["moves"].as_u64(), report["rapid_moves"].as_u64()),
        (Some(3), Some(1))
    );
    assert_eq!(report["cells"], serde_json::json!([60, 40]));
    let notes = report["notes"].to_string();
    assert!(
        notes.contains("guessed: stock: the zero of the program is at the lower left corner of its top"),
        "{notes}"
    );
    assert_eq!(folder.written(), ["part.ply", "report.html", "report.json"]);
}

#[test]
fn new_writes_the_job_that_simulate_runs() {
    let folder = folder();
    let said = folder.good(&["new", "plate.cls"]);
    for line in [
        "tool 3: APT cutter, 10 mm, \"10MM MILL\"",
        "stock: a block of 30 x 20 x 6 mm",
        "grid: cells of 0.3 mm",
    ] {
        assert!(said.contains(line), "{said}");
    }
    let job = fs::read_to_string(folder.path("plate.ron")).unwrap();
    assert!(
        job.contains("// guessed: grid") && job.contains("Path(file: \"plate.cls\")"),
        "{job}"
    );
    let volume = |file: &str| {
        let report = folder.good(&["simulate", file, "--cells", "30x20", "--only", "report", "--json"]);
        serde_json::from_str::<serde_json::Value>(&report).unwrap()["volume"].clone()
    };
    assert_eq!(volume("plate.ron"), volume("plate.cls"));
    assert!(
        folder
            .bad(&["new", "plate.cls"])
            .contains("plate.ron: there is such a file already; expected --force to overwrite it")
    );
    folder.good(&["new", "plate.cls", "--force", "--quiet"]);
    folder.good(&["new", "plate.cls", "--out", "jobs", "--quiet"]);
    let elsewhere = fs::read_to_string(folder.path("jobs/plate.ron")).unwrap();
    assert!(
        elsewhere.contains(&format!("{}", folder.path("plate.cls").display())),
        "{elsewhere}"
    );
}

#[test]
fn tools_stock_and_dialect_are_options() {
    let folder = folder();
    let message = folder.bad(&["simulate", "slot.nc"]);
    assert!(
        message.contains(
            "tool 1: nothing is known of it: expected a tool library (`--tools`) or comments in the program that say it"
        ),
        "{message}"
    );
    fs::write(
        folder.path("tools.json"),
        r#"{"data": [{"type": "flat end mill", "unit": "millimeters", "geometry": {"DC": 4, "LCF": 12}, "post-process": {"number": 1}}]}"#,
    )
    .unwrap();
    let run = |more: &[&str]| {
        let arguments = [
            &[
                "simulate",
                "slot.nc",
                "--tools",
                "tools.json",
                "--only",
                "report",
                "--json",
                "--cells",
                "80x60",
            ],
            more,
        ]
        .concat();
        let report = folder.good(&arguments);
        serde_json::from_str::<serde_json::Value>(&report).unwrap()
    };
    let auto = run(&["--controller", "linuxcnc", "--as", "gcode"]);
    let block = run(&["--stock", "block:-5,-5,-4,30,15,0"]);
    // The slot lies within both: 2 mm deep, its outline from the way's length and half circles at its ends.
    let way = 20.0 + std::f64::consts::PI * 5.0;
    let expected = 2.0 * (4.0 * way + std::f64::consts::PI * 4.0);
    for report in [&auto, &block] {
        let removed = report["volume_removed"].as_f64().unwrap();
        assert!((removed - expected).abs() < 0.01 * expected, "{removed} {expected}");
    }
    assert!(
        auto["notes"]
            .to_string()
            .contains("stock: a block around the feed moves")
    );
    assert!(!block["notes"].to_string().contains("guessed: stock"));
    for (option, value, message) in [
        (
            "--stock",
            "block:1,2,3",
            "expected the lower and the upper corner in millimetres, like block:0,0,-20,60,40,0",
        ),
        (
            "--controller",
            "abacus",
            "expected one of linuxcnc, fanuc, haas, siemens, heidenhain, grbl",
        ),
        ("--as", "pdf", "expected one of gcode, apt, table, rows"),
        ("--stock", "no.stl", "cannot read this file"),
        ("--machine", "no.ron", "no.ron"),
    ] {
        let said = folder.bad(&["simulate", "slot.nc", "--tools", "tools.json", option, value]);
        assert!(said.contains(message), "{said}");
    }
    // A job says these things itself.
    folder.good(&["new", "slot.nc", "--tools", "tools.json", "--quiet"]);
    let said = folder.bad(&["simulate", "slot.ron", "--tools", "tools.json"]);
    assert!(
        said.contains("--tools is for programs: slot.ron is a job, which says it itself"),
        "{said}"
    );
}

#[test]
fn inspect_says_what_a_program_does() {
    let folder = folder();
    let said = folder.good(&["inspect", "plate.cls"]);
    for line in [
        "title  plate",
        "program  APT or CLSF, in millimetres",
        "moves  2 feed moves and 1 rapid, in 1 piece",
        "tool axis  z all along",
        "tool  3: APT cutter, diameter 10.000, flutes 25.000, shank 10.000, \"10MM MILL\"",
        "2 feed moves, 57.000 mm, 6.8 s; 1 rapid, 22.000 mm",
        "stock  block of 30.000 × 20.000 × 6.0000 mm",
    ] {
        assert!(said.contains(line), "{line}\n{said}");
    }
    let said = folder.good(&["inspect", "slot.nc"]);
    assert!(said.contains("tool  1: not described"), "{said}");
    fs::write(folder.path("t.tbl"), "T1 P1 D6 ;mill\n").unwrap();
    let said = folder.good(&["inspect", "t.tbl"]);
    assert!(
        said.contains("tool  1: tool, diameter 6.0000, \"mill\" — the shape is missing"),
        "{said}"
    );
}

#[test]
fn convert_writes_programs_and_tools() {
    let folder = folder();
    for (output, begin) in [
        ("a.csv", "x,y,z,i,j,k,rapid,feed,tool\n"),
        ("a.cls", "PARTNO plate\nUNITS/MM\n"),
        ("a.txt", "# plate\ntool 3"),
    ] {
        folder.good(&["convert", "plate.cls", output, "--quiet"]);
        let written = fs::read_to_string(folder.path(output)).unwrap();
        assert!(written.starts_with(begin), "{written}");
    }
    // CLSF holds what the program says: converting it again changes nothing.
    folder.good(&["convert", "a.cls", "b.cls", "--quiet"]);
    let read = |name: &str| fs::read_to_string(folder.path(name)).unwrap();
    assert_eq!(read("a.cls"), read("b.cls"));
    let said = folder.good(&["convert", "slot.nc", "s.cls"]);
    assert!(said.contains("not written: tool 1 is not described"), "{said}");
    fs::write(
        folder.path("p.camotics"),
        r#"{"tools": {"1": {"units": "metric", "shape": "cylindrical", "length": 9, "diameter": 3}, "2": {"shape": "blob"}}, "files": ["slot.nc"]}"#,
    )
    .unwrap();
    let said = folder.good(&["convert", "p.camotics", "t.ron"]);
    assert!(
        said.contains("tool 2 is left out: the shape of this tool, \"blob\", is not supported"),
        "{said}"
    );
    assert!(read("t.ron").contains("1: Flat(radius: 1.5, length: 9.0),"));
    // The project is a program with tools.
    folder.good(&[
        "simulate",
        "p.camotics",
        "--cells",
        "20x20",
        "--only",
        "report",
        "--quiet",
    ]);
    for (arguments, message) in [
        (
            ["convert", "slot.nc", "a.stl"],
            "programs can be written as G-code (.nc, .ngc, .tap, .mpf, .h), CLSF (.cls, .apt), tables (.csv) and text (.txt)",
        ),
        (
            ["convert", "p.camotics", "a.csv"],
            "tools can be written as those of a job: expected .ron",
        ),
    ] {
        let output = folder.run(&arguments);
        assert!(text(&output.stderr).contains(message), "{}", text(&output.stderr));
    }
}

/// G-code of each control holds the same moves as the CLSF it was made from.
#[test]
fn convert_writes_gcode() {
    let folder = folder();
    let read = |name: &str| fs::read_to_string(folder.path(name)).unwrap();
    folder.good(&["convert", "plate.cls", "plate.csv", "--quiet"]);
    let moves = |table: &str| -> Vec<String> {
        let rows = read(table);
        let rows = rows.lines().map(str::to_owned);
        rows.map(|row| row.rsplit_once(',').unwrap().0.replace(",1,", ",,"))
            .collect()
    };
    for (output, more, words) in [
        ("a.nc", &[][..], "G43 H3 Z5\nG1 Z-2 F500\nX40\nG0 Z20\nM30\n%\n"),
        ("b.nc", &["--dialect", "fanuc"], "G1 Z-2. F500.\nX40.\n"),
        ("c.mpf", &[], "T3 M6\nD1\n"),
        ("d.h", &[], "L X+40 R0\nL Z+20 R0 FMAX\n"),
        ("e.nc", &["--for-machine", "head-bc", "--axes"], "X-10 Y10 Z5 B0 C0\n"),
        ("f.nc", &["--for-machine", "head-bc", "--dialect", "haas"], "G234 H3\n"),
    ] {
        let said = folder.good(&[&["convert", "plate.cls", output], more].concat());
        assert!(!said.contains("not written"), "{said}");
        assert!(read(output).contains(words), "{}", read(output));
        let control = match output {
            "c.mpf" => &["--controller", "siemens"][..],
            _ => &[],
        };
        folder.good(&[&["convert", output, "again.csv", "--quiet"], control].concat());
        assert_eq!(moves("again.csv")[2..], moves("plate.csv")[2..], "{}", read(output));
    }
    fs::write(
        folder.path("tilted.cls"),
        "UNITS/MM\nGOTO/0,0,0,0,0,1\nGOTO/1,2,3,0.6,0,0.8\n",
    )
    .unwrap();
    let said = folder.bad(&["convert", "tilted.cls", "tilted.nc"]);
    assert!(
        said.contains("line 3: the tool is tilted, and linuxcnc has no tool vectors"),
        "{said}"
    );
    folder.bad(&["convert", "plate.cls", "x.nc", "--axes"]);
}

#[test]
fn all_problems_of_a_program_in_a_job_are_reported() {
    let folder = Workdir::new(
        "Job(tolerance: 1e-6, grid: Grid(min: (-5, -5), max: (5, 5), cells: (10, 10)), stock: Block(min: (-5, -5, -5), max: (5, 5, 0)), \
         tools: {1: Flat(radius: 1, length: 9)}, paths: [Path(tool: 1, file: \"bad.nc\")])",
    );
    fs::write(folder.path("bad.nc"), "G0 X0 Y0 Z0\nG12 X5\nG1 X1 F9\nG60 X5\n").unwrap();
    let (in_job, alone) = (folder.bad(&["simulate", "job.ron"]), folder.bad(&["inspect", "bad.nc"]));
    for message in [&in_job, &alone] {
        assert_eq!(message.matches("error").count(), 2, "{message}");
        assert!(
            message.contains("bad.nc:2:1") && message.contains("bad.nc:4:1"),
            "{message}"
        );
    }
}

/// Old controls end lines by a return alone: comments end there, too, and findings show the line that they are about.
#[test]
fn lines_may_end_with_a_return_alone() {
    let program = "G21 G90 ; first\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100 ; down\nG1 X10\nG0 X20\nG0 Z5\nM30\n";
    let workdir = Workdir::new("");
    fs::write(workdir.path("tools.tbl"), "T1 D6\n").unwrap();
    let run = |name: &str, text: &str| {
        fs::write(workdir.path(name), text).unwrap();
        let stock = "block:-10,-10,-5,30,10,0";
        let options = [
            "--cells",
            "40x20",
            "--directions",
            "z",
            "--only",
            "dexels,report",
            "--out",
            "out",
        ];
        let output = workdir.run(
            &[
                &["verify", name, "--tools", "tools.tbl", "--stock", stock],
                &options[..],
            ]
            .concat(),
        );
        assert_eq!(output.status.code(), Some(1), "{name}");
        let report = fs::read_to_string(workdir.path("out/report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let finding = &report["findings"][0];
        (
            fs::read(workdir.path("out/dexels.csv")).unwrap(),
            finding["line"].clone(),
            finding["text"].clone(),
        )
    };
    let expected = run("a.nc", program);
    assert_eq!((&expected.1, &expected.2), (&6.into(), &"G0 X20".into()));
    assert_eq!(run("b.nc", &program.replace('\n', "\r")), expected);
    assert_eq!(run("c.nc", &program.replacen('\n', "\r", 4)), expected);
}

#[test]
fn what_was_ignored_in_a_library_is_said_where_its_tool_is_used() {
    let workdir = Workdir::new("");
    fs::write(
        workdir.path("a.nc"),
        "G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX10\nM30\n",
    )
    .unwrap();
    let tool = |unit: &str| {
        format!(
            r#"{{"type": "flat end mill", "unit": "{unit}", "geometry": {{"DC": 6, "LCF": 20}}, "post-process": {{"number": 1}}}}"#
        )
    };
    let library = format!(r#"{{"data": [{}, {}]}}"#, tool("parsecs"), tool("inches"));
    fs::write(workdir.path("tools.json"), library).unwrap();
    let options = [
        "--tools",
        "tools.json",
        "--cells",
        "20x20",
        "--directions",
        "z",
        "--only",
        "dexels",
    ];
    let said = workdir.good(&[&["simulate", "a.nc"], &options[..]].concat());
    for note in [
        "the unit \"parsecs\" is not known: taken as millimeters",
        "tool 1: described again in the same file: the first description is used",
    ] {
        assert!(said.contains(note), "{said}");
    }
}

/// The job made of a program is not seen: its lines are not those of the program.
#[test]
fn faults_of_options_name_the_option() {
    let folder = folder();
    for (option, value, expected) in [
        ("--cells", "0x0", "error: --cells: a number of cells is 0"),
        ("--stock", "block:0,0,0,1e300,9,9", "error: --stock: max is 1"),
        (
            "--target",
            "no.stl",
            "error: --target: cannot read the target file no.stl: there is no such file",
        ),
    ] {
        for command in ["simulate", "new"] {
            let message = folder.bad(&[command, "plate.cls", option, value]);
            assert!(message.contains(expected) && !message.contains("plate"), "{message}");
        }
    }
    // Not a thousandth of a millimetre of what is given is lost.
    folder.good(&["new", "plate.cls", "--stock", "block:0,0,-1,1e-5,2e-5,0"]);
}
