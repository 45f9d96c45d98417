//! No text makes the reader panic, hang, or take memory without bound.

use sweepsim_nc::{ReadOptions, apt};
use sweepsim_props::*;

use super::{Random, number, seeds};

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
    fn no_text_panics(from in collection::vec(any::<u8>(), 0..120), noise in ".{0,40}") {
        let text = text(&from);
        try_all(&text);
        try_all(&format!("{noise}{text}"));
    }
}

/// Programs that are mutated.
const SEEDS: [&str; 5] = [
    "PARTNO A\nUNITS/MM\nCUTTER/12.,0,6.,0,0,0,63.\nLOADTL/1\nSPINDL/RPM,900,CLW\nRAPID\nGOTO/0,0,5\nFEDRAT/100,MMPM\nGOTO/0,0,-1\nCIRCLE/5,0,-1,0,0,1,5\nGOTO/10,0,-1\nFINI\n",
    "TOOL PATH/A,TOOL,B\nTLDATA/MILL,10.0,1.0,50.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\n$$ comment\nLOAD/TOOL,2,ADJUST,2\nFROM/0,0,50,0,0,1\nGOTO/1,2,3,0.6,0,0.8\nGODLTA/1,1,$\n1\nEND-OF-PATH\n",
    "CYCLE/DRILL,DEPTH,3.5,CLEAR,1.,MMPM,50.\nGOTO/0,0,0\nGOTO/5,0,0\nCYCLE/OFF\nCYCLE/DEEP,RAPTO,3.0,FEDTO,-9.0,STEP,2.,RTRCTO,AUTO,MMPM,250.\nGOTO/1,1,0\nCYCLE/OFF\n",
    "GOTO/0,0,0\nNURBS\nKNOT/0,0,0,0,1,1,1,1\nCNTRL/0,0,0\nCNTRL/1,0,0\nCNTRL/2,1,0\nCNTRL/3,1,0\nMOVARC/0,1,0,0,0,1,3,ANGLE,720\nTRNTYP/WORLD\nCSYS/1,0,0,0,0,1,0,0,0,0,1,0\n",
    "$$-> CUTTER / 3.000000\nINSERT/Stock Size X10. Y20. Z5.\nCSI_SET_FLUTE_LENGTH/4.\nCSI_SET_EXTENSION_LENGTH/31.5\nCUTCOM/LEFT,XYPLAN\nDELAY/2\nGOHOME\nMULTAX/ON\nGOTO/1,1,1,0,1,0\n",
];

const CHARACTERS: &str = "GOT/,.$-\n 0123456789eE=()ACDILMNRSUY";

/// `cargo test -p sweepsim-nc --test it ten_million_cl_files -- --ignored --nocapture`; see [`super::number`].
#[test]
#[ignore = "takes minutes"]
fn ten_million_cl_files() {
    let (from, count) = (number("FUZZ_FROM", 0), number("FUZZ_COUNT", 10_000_000));
    let real = seeds(&["apt", "cls", "ncl"]);
    let start = std::time::Instant::now();
    for seed in from..from + count {
        let mut random = Random::new(seed);
        if random.below(2) == 0 {
            let length = 2 * random.below(24);
            let bytes: Vec<u8> = (0..length).map(|_| (random.next() >> 8) as u8).collect();
            try_all(&text(&bytes));
        } else {
            try_all(&String::from_utf8_lossy(&random.mutated(&SEEDS, &real, CHARACTERS)));
        }
    }
    println!("{count} programs from {from}: {:?}", start.elapsed());
}
