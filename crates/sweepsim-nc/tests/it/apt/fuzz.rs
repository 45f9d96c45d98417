//! No text makes the reader panic, hang, or take memory without bound.

use proptest::prelude::*;
use sweepsim_nc::{ReadOptions, apt, tools};

/// Words of the language, in any order.
const WORDS: [&str; 64] = [
    "GOTO",
    "GODLTA",
    "FROM",
    "RAPID",
    "FEDRAT",
    "CIRCLE",
    "MOVARC",
    "CYCLE",
    "CUTTER",
    "TLDATA",
    "LOAD",
    "LOADTL",
    "MSYS",
    "CSYS",
    "TRNTYP",
    "UNITS",
    "NURBS",
    "KNOT",
    "CNTRL",
    "INSERT",
    "PARTNO",
    "PPRINT",
    "GOHOME",
    "FINI",
    "$$->",
    "$$",
    "$",
    "/",
    ",",
    "\n",
    "TOOL",
    "DRILL",
    "DEEP",
    "MILL",
    "DEPTH",
    "FEDTO",
    "STEP",
    "CLEAR",
    "RAPTO",
    "RTRCTO",
    "AUTO",
    "MMPM",
    "IPM",
    "ANGLE",
    "OFF",
    "ON",
    "INIT",
    "WORLD",
    "MM",
    "INCHES",
    "Stock Size X1 Y2 Z3",
    "0",
    "1",
    "-1",
    "0.5",
    "1e9",
    "1e-9",
    "1e308",
    "nan",
    "TIMES",
    "é",
    "=",
    "1STPECK",
    "CSI_SET_FLUTE_LENGTH",
];

fn text(from: &[u8]) -> String {
    let mut text = String::from("GOTO/0,0,0\n");
    for pair in from.chunks(2) {
        text.push_str(WORDS[usize::from(pair[0]) % WORDS.len()]);
        text.push_str(["/", ",", "\n", " "][usize::from(pair.get(1).copied().unwrap_or(0)) % 4]);
    }
    text
}

fn try_all(text: &str) {
    let mut options = ReadOptions::default();
    options.arc_tolerance = 0.1;
    for lenient in [false, true] {
        options.lenient = lenient;
        options.exact_arcs = lenient;
        if let Ok(program) = apt::read(text, &options) {
            for tool in program.tools.values() {
                let _ = tool.build();
            }
            for pose in &program.poses {
                assert!(pose.pose.tip().iter().all(|c| c.is_finite()));
            }
        }
    }
}

proptest! {
    #[test]
    fn no_text_panics(from in prop::collection::vec(any::<u8>(), 0..120), noise in ".{0,40}") {
        let text = text(&from);
        try_all(&text);
        try_all(&format!("{noise}{text}"));
    }

    #[test]
    fn no_tool_file_panics(noise in ".{0,60}", keys in prop::collection::vec(0..12_usize, 0..12), value in -1e3..1e3_f64) {
        let names = ["data", "tools", "parameter", "geometry", "DC", "LCF", "type", "shape", "units", "length", "diameter", "post-process"];
        let fields: Vec<String> = keys.iter().map(|&k| format!("{:?}: {}", names[k], if k < 4 { "[{}]".into() } else { value.to_string() })).collect();
        for text in [noise.clone(), format!("T1 {noise}"), format!("{{{}}}", fields.join(", ")), format!("{{\"data\": [{{{}}}]}}", fields.join(", "))] {
            let _ = tools::parse(&text, std::path::Path::new("t.json"), false);
        }
    }
}

/// A small generator: no input is the same, and each can be made again.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        // xorshift64* (Vigna 2016).
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }
}

/// Ten million inputs: `cargo test -p sweepsim-nc --release --test it ten_million_cl -- --ignored`.
#[test]
#[ignore = "minutes"]
fn ten_million_cl_files() {
    let mut random = Random(0x5eed);
    for _ in 0..10_000_000_u64 {
        let length = 2 * (random.next() % 24) as usize;
        let bytes: Vec<u8> = (0..length).map(|_| (random.next() >> 32) as u8).collect();
        try_all(&text(&bytes));
    }
}
