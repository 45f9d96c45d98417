//! Tool libraries and projects.

use std::path::Path;

use sweepsim_nc::{ReadOptions, gcode, tools};
use sweepsim_props::*;

use super::{Random, number, seeds};

fn try_text(text: &str) -> bool {
    let found = tools::parse(text, Path::new("/no/such/folder/t.json"), false);
    if let Ok(library) = &found {
        for tool in library.tools.values() {
            let _ = tool.build();
            let _ = tool.seven_parameters();
        }
        let _ = tools::to_ron(&library.tools);
    }
    found.is_ok()
}

proptest! {
    #[test]
    fn no_tool_file_panics(noise in ".{0,60}", keys in collection::vec(0..12_usize, 0..12), value in -1e3..1e3_f64) {
        let names = ["data", "tools", "parameter", "geometry", "DC", "LCF", "type", "shape", "units", "length", "diameter", "post-process"];
        let fields: Vec<String> = keys.iter().map(|&k| format!("{:?}: {}", names[k], if k < 4 { "[{}]".into() } else { value.to_string() })).collect();
        for text in [noise.clone(), format!("T1 {noise}"), format!("{{{}}}", fields.join(", ")), format!("{{\"data\": [{{{}}}]}}", fields.join(", "))] {
            try_text(&text);
        }
    }
}

/// Libraries that are mutated: Fusion 360, FreeCAD, CAMotics, LinuxCNC.
const SEEDS: [&str; 6] = [
    r#"{"data": [{"type": "bull nose end mill", "unit": "inches", "geometry": {"DC": 0.5, "RE": 0.03, "LCF": 1, "shoulder-length": 1.25, "shoulder-diameter": 0.4, "SFDM": 0.5, "LB": 2, "OAL": 3}, "expressions": {"tool_fluteLength": "30 mm"}, "holder": {"unit": "millimeters", "segments": [{"height": 20, "lower-diameter": 40, "upper-diameter": 50}]}, "post-process": {"number": 7}}], "version": 36}"#,
    r#"{"data": [{"type": "chamfer mill", "unit": "millimeters", "geometry": {"DC": 10, "TA": 45, "tip-diameter": 2, "LCF": 8}, "post-process": {"number": 3}}, {"type": "drill", "geometry": {"DC": 5, "SIG": 118, "LCF": 40}}]}"#,
    r#"{"version": 2, "name": "x", "shape": "bullnose.fcstd", "shape-type": "Bullnose", "parameter": {"Diameter": "5.00 mm", "CornerRadius": "1.5 mm", "CuttingEdgeHeight": "30.0 mm", "Length": "50 mm", "ShankDiameter": "3 mm"}}"#,
    r#"{"units": "metric", "tools": {"1": {"units": "imperial", "shape": "ballnose", "length": 1, "diameter": 0.125}, "2": {"shape": "conical", "length": 3, "diameter": 4}}, "workpiece": {"automatic": false, "bounds": {"min": [0, 0, -20], "max": [80, 80, 0]}}, "files": ["a.nc"]}"#,
    "T1 P1 Z0 D1 ;end mill\nT2 P2 Z15.5 D8 ;end mill\nT3 P3 Z-1e-3 D4.2 X0 I0 J0 Q0;#7 tap drill\n",
    r#"{"tools": [{"nr": 1, "path": "a.fctb"}, {"nr": 2, "path": "../b.fctb"}], "version": 1}"#,
];

/// Comments of programs that describe tools and stock.
const COMMENTS: [&str; 4] = [
    "(T1 D=6. CR=3. - ZMIN=-12. - ball end mill)\n(T2 D=10. CR=0. TAPER=45deg - ZMIN=-2. - chamfer mill)\nG0 X0 Y0 Z0\n",
    "(TOOL/MILL,6,0,20,0)\n(STOCK/BLOCK,100,50,20,0,0,20)\nT1 M6\nG0 X0 Y0 Z0\n",
    "(TOOL/DRILL,5,118,40)\n(TOOL/CHAMFER,6,45,20,1)\n(FROM/0,0,50)\nT2 M6\nG0 X0 Y0 Z0\n",
    "; T1 D=3mm\n(STOCK/CYLINDER,20,30)\n(T5 D=1/4 flat)\nG0 X0 Y0 Z0\n",
];

const CHARACTERS: &str = "{}[]\":,.-0123456789eEDTPZ \nntrfalsu/()=";

/// A library with other values: still well-formed, for the most part.
fn other_values(random: &mut Random) -> String {
    let mut text = random.one(&SEEDS).to_owned();
    for _ in 0..=random.below(5) {
        let digits: Vec<usize> = text
            .match_indices(|c: char| c.is_ascii_digit())
            .map(|(at, _)| at)
            .collect();
        let Some(&at) = digits.get(random.below(digits.len())) else {
            break;
        };
        let value = random.one(&[
            "0", "9", "12", "1e9", "1e308", "1e-300", "0.5", "0e0", "null", "\"x\"", "[]", "{}",
        ]);
        text.replace_range(at..=at, value);
    }
    text
}

fn run(from: u64, count: u64) -> u64 {
    let real = seeds(&["tbl", "fctb", "fctl", "camotics", "json"]);
    let mut read = 0;
    for seed in from..from + count {
        let mut random = Random::new(seed);
        if random.below(4) == 0 {
            let text = random.mutated(&COMMENTS, &[], CHARACTERS);
            if let Ok(program) = gcode::read(&String::from_utf8_lossy(&text), &ReadOptions::default()) {
                for tool in program.tools.values() {
                    let _ = tool.build();
                }
                read += 1;
            }
        } else {
            let text = if random.below(2) == 0 {
                other_values(&mut random)
            } else {
                String::from_utf8_lossy(&random.mutated(&SEEDS, &real, CHARACTERS)).into_owned()
            };
            read += u64::from(try_text(&text));
        }
    }
    read
}

#[test]
fn no_tool_file_breaks_its_reader() {
    let read = run(0, 2000);
    assert!((400..1900).contains(&read), "{read} of 2000 are read");
}

/// `cargo test -p sweepsim-nc --test it ten_million_tool_files -- --ignored --nocapture`; see [`super::number`].
#[test]
#[ignore = "takes minutes"]
fn ten_million_tool_files() {
    let (from, count) = (number("FUZZ_FROM", 0), number("FUZZ_COUNT", 10_000_000));
    let start = std::time::Instant::now();
    let read = run(from, count);
    println!("{count} files from {from}: {read} read, {:?}", start.elapsed());
}
