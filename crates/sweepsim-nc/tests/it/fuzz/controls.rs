//! Mutated programs of Siemens and Heidenhain, and random words of them: no panic, no hang, bounded memory.

use sweepsim_nc::{Machine, ReadOptions, ToolOffset, heidenhain, siemens};

use super::{Random, number, seeds};

const SIEMENS: [&str; 11] = [
    "T1 D1 F9\nG0 X-9 Y0 Z0\nG451 G1 G41 X0 Y0\nX10 RND=2\nG2 X12 Y2 CR=2\nG1 Y10\nX0 CHF=1\nY0\nG40 X-9\n",
    "T2 F9 KONT OFFN=0.5 RNDM=1\nG0 X9 Y0 Z0\nG1 G42 X0 Y0\nZ-1\nX-9\nCT Y9 X-5\nM8\nG3 X0 Y9 I2 J2\nG40 X5\n",
    "G111 X5 Y5\nG0 AP=30 RP=4 Z0\nG3 AP=90\nG110 AP=9 RP=3\nG112 X1\nG1 AP=IC(20) RP=7 F9\nCT X9 Y9\n",
    "N10 G54 G90 G17\nN20 T=\"MILL\" M6\nR1=3\nTRAORI\nG0 X0 Y0 Z=R1*2 B30 C40\nAROT Y90\nG1 X=IC(3) F100\nTRAFOOF\nM30\n",
    "G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0\nG2 X10 Y0 CR=10 TURN=2\nCIP X0 Y10 I1=7 J1=7\n",
    "G0 X0 Y0 Z20 F10\nMCALL CYCLE83(10,1,2,,15,,5,1,0,,,1)\nX5\nMCALL\nCYCLE800(0,\"\",0,57,0,0,0,30,40,50,0,0,0,1)\nG0 X1 Y2 Z3\n",
    "R1=0\nLOOP\nR1=R1+1\nG1 X=R1 Y0 Z0\nIF R1>8 GOTOF OUT\nENDLOOP\nOUT: X0\nFOR R2=1 TO 3\nX=R2\nENDFOR\nREPEAT OUT P=2\n",
    "%_N_A_MPF\nG0 X0 Y0 Z0\nB(1,2) P3\nM30\n%_N_B_SPF\nPROC B(REAL D, REAL E)\nG91 X=D Y=E\nG90\nRET\n",
    "X1 Y1 Z1\n",
    "SUPA G0 Z=5 D0\nG0 X1 Y1 Z1 D1\nMIRROR X0\nSCALE X2 Y2 Z2\nG2 X5 I2 J0\n",
    "TRAORI\nG1 X0 Y0 Z0 A3=0 B3=0 C3=1 F9\nX9 A3=1 C3=1\n",
];
const HEIDENHAIN: [&str; 10] = [
    "TOOL DEF 1 R+3\nTOOL CALL 1 Z S9\nL X+0 Y+0 Z+50 FMAX\nCYCL DEF 208 Q200=2 Q201=-9 Q334=5 Q335=16\nL X+1 M99\nCYCL DEF 204 Q200=2 Q249=5 Q250=20 Q251=3 Q252=15 Q214=1\nCYCL CALL\nCYCL DEF 202 Q200=2 Q201=-9 Q214=2\nCYCL CALL\n",
    "TOOL DEF 3 L+9 R+1\nTOOL CALL 3 Z S9 DL+1 DR-0.2\nL X-9 Y+0 Z+5 R0 FMAX\nL X+0 RL F9\nL X+10\nRND R2 F5\nCC X+10 Y+5\nC X+10 Y+10 DR+\nL X+0\nL Y-9 R0\n",
    "TOOL CALL 2 Y\nL X+0 Y+0 Z+0 FMAX\nL X+5 RR F9\nCR X+9 Z+4 R+4 DR-\nRND R1\nCT X+20 Z+9\nL IX+4\nCHF 2\nL IZ-9\nM5\nL X+0 R0\n",
    "0 BEGIN PGM A MM\nBLK FORM 0.1 Z X-5 Y-5 Z-5\nTOOL CALL 3 Z S99\nL X+0 Y+0 Z+5 R0 FMAX M3\nL X+10 F9\nRND R2\nL Y+10\nEND PGM A MM\n",
    "L X+10 Y+0 Z+0 FMAX\nCC X+0 Y+0\nC X+0 Y+10 DR+\nCP IPA+700 IZ-5 DR+\nCR X+10 Y+0 R+9 DR-\nCT X+30 Y+3\nLP PR+3 PA+9\n",
    "L X+0 Y+0 Z+9 FMAX\nLBL 1\nL IX+2 F9\nFN 1: Q1 = +3 + +4\nQ2 = Q1 * SIN 30\nCALL LBL 1 REP 2\nFN 9: IF +Q2 EQU +1 GOTO LBL 1\n",
    "L X+0 Y+0 Z+9 FMAX\nCYCL DEF 200 ~\nQ200=2 ~\nQ201=-9 ~\nQ202=2\nL X+1 M99\nCYCL DEF 7.0\nCYCL DEF 7.1 X+4\nCYCL DEF 11.0\nCYCL DEF 11.1 SCL 2\n",
    "L X-10 Y+0 Z+0 R0 FMAX\n9 FC DR+ R10 CLSD+ CCX+0 CCY+0\n10 FCT DR- R15\nFCT DR+ R8 CCX+30 CCY+0\nFSELECT 2\nFPOL X+5 Y+5\nFL AN+90 PDX+5 PDY+5 D3\n14 FL PR+9 PA+30 PAR 10 DP 4\nRND R1\nFLT IX+3 RX9 LEN 5\nFCT DR+ R10 CLSD- CCX+0 CCY+0\n",
    "L X+0 Y+0 Z+9 FMAX\nPATTERN DEF POS1 (X+1 Y+2 Z+3) ROW1 (X+1 Y+2 D+8 NUM5 ROT+9 Z+0)\nCYCL DEF 200 Q200=2 Q201=-9 Q202=2 Q203=1\nCYCL CALL PAT F99 M3\nPATTERN DEF PAT1 (X+1 Y+1 DX+8 DY+9 NUMX9 NUMY4) CIRC1 (X+1 Y+3 D80 START+45 NUM8)\nCYCL CALL PAT\nCYCL CALL POS X+1 Y+2 Z+3\n",
    "M128\nL X+0 Y+0 Z+0 B+9 C+8 FMAX\nLN X+1 TX+1 TY+0 TZ+1\nPLANE SPATIAL SPA+9 SPB+8 SPC+7 TURN\nL X+1 Y+1 Z+1\nPLANE RESET TURN\nM129\n",
];
const PIECES: [&str; 51] = [
    "FLT\n",
    "FCT DR+ R5\n",
    "FL AN+90\n",
    " CCX+4 CCY-3",
    " LEN 4",
    " PAR 9 DP 2",
    "CYCL CALL PAT\n",
    "G41 ",
    "G40 ",
    " RL ",
    " R0 ",
    "RND R1\n",
    " RND=1",
    " DR+0.1",
    "CT ",
    "X",
    "Y",
    "Z",
    "B",
    "C",
    "+1e9",
    "-0.5",
    "9999999",
    "=",
    "(",
    ")",
    "[",
    "]",
    "\n",
    " ",
    "G1 ",
    "G2 ",
    "G3 ",
    "R1",
    "Q1",
    "LBL 1\n",
    "CALL LBL 1 REP 9\n",
    "GOTOB ",
    "IF ",
    "WHILE 1\n",
    "ENDWHILE\n",
    "LOOP\n",
    "ENDLOOP\n",
    "\"",
    "~\n",
    "IPA+99999",
    "TURN=999",
    "ROT Z",
    "SCALE X0",
    "\u{d8}",
    "FN 12: ",
];

const CHARACTERS: &str = "XYZIJKGMTFSRLQCNBAPD=+-.0123456789 \n()[]\"~;:/";

/// A `\r` ends a line, too, unless it is beside a `\n`.
fn lines_of(text: &str) -> usize {
    let mut bytes = text.as_bytes().to_vec();
    sweepsim_nc::end_lines_at_returns(&mut bytes);
    let ends = bytes.iter().filter(|byte| **byte == b'\n').count();
    ends + usize::from(bytes.last().is_some_and(|last| *last != b'\n'))
}

fn inputs(siemens_text: bool, from: u64, count: u64) -> u64 {
    let (texts, real): (&[&str], _) = if siemens_text {
        (&SIEMENS, seeds(&["mpf", "spf"]))
    } else {
        (&HEIDENHAIN, seeds(&["h", "H"]))
    };
    let mut options = ReadOptions::default();
    options.arc_tolerance = 0.5;
    options.most_blocks = 2_000;
    options.most_poses = 20_000;
    for tool in 1..9 {
        let diameter = 0.5 * f64::from(tool);
        options.tool_offsets.insert(tool, ToolOffset { length: 0.0, diameter });
    }
    let mut with_machine = options.clone();
    with_machine.machine = Machine::named("nutating-head-bc").unwrap();
    let (mut read, mut refused) = (0, 0);
    for seed in from..from + count {
        let mut random = Random::new(seed);
        let mut text = match random.below(4) {
            0 => {
                let mut text = String::new();
                for _ in 0..random.below(40) {
                    text += random.one(&PIECES);
                }
                text
            }
            1 => String::from_utf8_lossy(&random.mutated(texts, &real, CHARACTERS)).into_owned(),
            _ => random.one(texts).to_owned(),
        };
        for _ in 0..random.below(6) {
            let mut at = random.below(text.len() + 1);
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            match random.below(4) {
                0 => text.insert_str(at, random.one(&PIECES)),
                1 => text.truncate(at),
                2 => {
                    let lines: Vec<&str> = text.lines().collect();
                    if !lines.is_empty() {
                        let line = format!("{}\n", lines[random.below(lines.len())]);
                        text.push_str(&line);
                    }
                }
                _ => {
                    if let Some(c) = text[at..].chars().next() {
                        text.replace_range(at..at + c.len_utf8(), random.one(&PIECES));
                    }
                }
            }
        }
        let options = if random.below(3) == 0 { &with_machine } else { &options };
        let mut options = options.clone();
        options.lenient = random.below(4) == 0;
        options.exact_arcs = random.below(2) == 0;
        let found = if siemens_text {
            siemens::read(&text, &options)
        } else {
            heidenhain::read(&text, &options)
        };
        match found {
            Ok(program) => {
                read += 1;
                assert!(program.poses.len() <= options.most_poses, "{text}");
                for pose in &program.poses {
                    assert!(
                        pose.pose.tip().iter().chain(&pose.pose.axis()).all(|c| c.is_finite()),
                        "{text}"
                    );
                    assert!((1..=lines_of(&text)).contains(&pose.line), "{} {text:?}", pose.line);
                }
            }
            Err(error) => {
                refused += 1;
                assert!(error.position().is_some() && !error.to_string().is_empty(), "{text}");
            }
        }
    }
    assert!(
        read * 10 > count && refused * 20 > count,
        "{read} read, {refused} refused"
    );
    read
}

#[test]
fn no_siemens_program_breaks_the_reader() {
    inputs(true, 0, 600);
}

#[test]
fn no_klartext_breaks_the_reader() {
    inputs(false, 0, 600);
}

fn ten_million(siemens_text: bool) {
    let (from, count) = (number("FUZZ_FROM", 0), number("FUZZ_COUNT", 10_000_000));
    let start = std::time::Instant::now();
    let read = inputs(siemens_text, from, count);
    println!("{count} programs from {from}: {read} read, {:?}", start.elapsed());
}

/// `cargo test -p sweepsim-nc --test it ten_million_siemens -- --ignored --nocapture`; see [`super::number`].
#[test]
#[ignore = "takes an hour"]
fn ten_million_siemens_programs() {
    ten_million(true);
}

/// `cargo test -p sweepsim-nc --test it ten_million_klartext -- --ignored --nocapture`; see [`super::number`].
#[test]
#[ignore = "takes an hour"]
fn ten_million_klartext_programs() {
    ten_million(false);
}
