//! Mutated programs of Siemens and Heidenhain, and random words of them: no panic, no hang, bounded memory.

use sweepsim_nc::{Machine, ReadOptions, heidenhain, siemens};

struct Random(u64);

impl Random {
    fn next(&mut self, below: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % below.max(1)
    }

    fn of<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.next(list.len())]
    }
}

const SIEMENS: [&str; 8] = [
    "N10 G54 G90 G17\nN20 T=\"MILL\" M6\nR1=3\nTRAORI\nG0 X0 Y0 Z=R1*2 B30 C40\nAROT Y90\nG1 X=IC(3) F100\nTRAFOOF\nM30\n",
    "G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0\nG2 X10 Y0 CR=10 TURN=2\nCIP X0 Y10 I1=7 J1=7\n",
    "G0 X0 Y0 Z20 F10\nMCALL CYCLE83(10,1,2,,15,,5,1,0,,,1)\nX5\nMCALL\nCYCLE800(0,\"\",0,57,0,0,0,30,40,50,0,0,0,1)\nG0 X1 Y2 Z3\n",
    "R1=0\nLOOP\nR1=R1+1\nG1 X=R1 Y0 Z0\nIF R1>8 GOTOF OUT\nENDLOOP\nOUT: X0\nFOR R2=1 TO 3\nX=R2\nENDFOR\nREPEAT OUT P=2\n",
    "%_N_A_MPF\nG0 X0 Y0 Z0\nB(1,2) P3\nM30\n%_N_B_SPF\nPROC B(REAL D, REAL E)\nG91 X=D Y=E\nG90\nRET\n",
    "X1 Y1 Z1\n",
    "SUPA G0 Z=5 D0\nG0 X1 Y1 Z1 D1\nMIRROR X0\nSCALE X2 Y2 Z2\nG2 X5 I2 J0\n",
    "TRAORI\nG1 X0 Y0 Z0 A3=0 B3=0 C3=1 F9\nX9 A3=1 C3=1\n",
];
const HEIDENHAIN: [&str; 5] = [
    "0 BEGIN PGM A MM\nBLK FORM 0.1 Z X-5 Y-5 Z-5\nTOOL CALL 3 Z S99\nL X+0 Y+0 Z+5 R0 FMAX M3\nL X+10 F9\nRND R2\nL Y+10\nEND PGM A MM\n",
    "L X+10 Y+0 Z+0 FMAX\nCC X+0 Y+0\nC X+0 Y+10 DR+\nCP IPA+700 IZ-5 DR+\nCR X+10 Y+0 R+9 DR-\nCT X+30 Y+3\nLP PR+3 PA+9\n",
    "L X+0 Y+0 Z+9 FMAX\nLBL 1\nL IX+2 F9\nFN 1: Q1 = +3 + +4\nQ2 = Q1 * SIN 30\nCALL LBL 1 REP 2\nFN 9: IF +Q2 EQU +1 GOTO LBL 1\n",
    "L X+0 Y+0 Z+9 FMAX\nCYCL DEF 200 ~\nQ200=2 ~\nQ201=-9 ~\nQ202=2\nL X+1 M99\nCYCL DEF 7.0\nCYCL DEF 7.1 X+4\nCYCL DEF 11.0\nCYCL DEF 11.1 SCL 2\n",
    "M128\nL X+0 Y+0 Z+0 B+9 C+8 FMAX\nLN X+1 TX+1 TY+0 TZ+1\nPLANE SPATIAL SPA+9 SPB+8 SPC+7 TURN\nL X+1 Y+1 Z+1\nPLANE RESET TURN\nM129\n",
];
const PIECES: [&str; 36] = [
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

fn inputs(seed: u64, count: usize) {
    let mut random = Random(seed);
    let mut options = ReadOptions::default();
    options.arc_tolerance = 0.5;
    options.most_blocks = 2_000;
    options.most_poses = 100_000;
    let mut with_machine = options.clone();
    with_machine.machine = Machine::named("nutating-head-bc").unwrap();
    let (mut read, mut refused) = (0, 0);
    for _ in 0..count {
        let heidenhain_text = random.next(2) == 0;
        let mut text = if heidenhain_text {
            random.of(&HEIDENHAIN)
        } else {
            random.of(&SIEMENS)
        }
        .to_owned();
        for _ in 0..random.next(6) {
            let mut at = random.next(text.len() + 1);
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            match random.next(4) {
                0 => text.insert_str(at, random.of(&PIECES)),
                1 => text.truncate(at),
                2 => {
                    let lines: Vec<&str> = text.lines().collect();
                    if !lines.is_empty() {
                        let line = format!("{}\n", lines[random.next(lines.len())]);
                        text.push_str(&line);
                    }
                }
                _ => {
                    if let Some(c) = text[at..].chars().next() {
                        text.replace_range(at..at + c.len_utf8(), random.of(&PIECES));
                    }
                }
            }
        }
        let options = if random.next(3) == 0 { &with_machine } else { &options };
        let found = if heidenhain_text {
            heidenhain::read(&text, options)
        } else {
            siemens::read(&text, options)
        };
        match found {
            Ok(program) => {
                read += 1;
                for pose in &program.poses {
                    assert!(
                        pose.pose.tip().iter().chain(&pose.pose.axis()).all(|c| c.is_finite()),
                        "{text}"
                    );
                    assert!(pose.line >= 1 && pose.line <= text.lines().count(), "{text}");
                }
            }
            Err(error) => {
                refused += 1;
                assert!(error.position().is_some() && !error.to_string().is_empty(), "{text}");
            }
        }
    }
    println!("{read} read, {refused} refused");
    assert!(
        read * 10 > count && refused * 20 > count,
        "{read} read, {refused} refused"
    );
}

#[test]
fn a_few() {
    inputs(7, 600);
}

/// Ten million inputs: some hours. `SEED` and `COUNT` in the environment make it another run.
#[test]
#[ignore = "takes hours"]
fn many() {
    let number = |name: &str, other: u64| {
        std::env::var(name)
            .ok()
            .and_then(|text| text.parse().ok())
            .unwrap_or(other)
    };
    inputs(number("SEED", 1), number("COUNT", 10_000_000) as usize);
}
