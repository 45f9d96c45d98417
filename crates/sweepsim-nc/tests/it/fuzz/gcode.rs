//! Mutated and grammar-made programs: none panics, hangs, or takes more memory than it may.

use sweepsim_nc::{Controller, ReadOptions, ToolOffset, gcode, write};

use super::{Random, number, seeds};

/// Programs that are mutated.
const SEEDS: [&str; 12] = [
    "G0 X0 Y0 Z0\nF9\nG5.2 P1 L4\nX1 Y1 P2\nX2 Y0 P.5\nX3 Y3 P1\nX4 Y0 P1\nG5.3\nG18 G5.2 X1 Z1 P1\nX2 Z3 P1\nG5.3\nG33 Z-3 K1\nG33.1 Z-1 K1\n",
    "G0 X0 Y0 Z0\nG68.2 P1 Q312 X1 I9 J8 K7\nG53.1\nG1 X1 F9\nG69\nG68.2 P2 Q0 X1\nG68.2 P2 Q1\nG68.2 P2 Q2 X1\nG68.2 P2 Q3 Y1 Z1\nG68.4 P3 Q1 I1\nG68.4 P3 Q2 J1\nG53.1\nG0 Z9\nG69\n",
    "M3 S9 G0 X0 Y0 Z5\nG87 X1 Z-2 R-5 I1 F9\nG77 X2 Z-2 R-5 J1\nG80 G0 Z0\nG13 I9 K21 Q5 D1 Z-1\nG12 I9 D0\nG91 G45 X4 D1\nG48 Y-0 D1\nG90 G41 D1 G1 X0\nX20\nY2\nY4\nX0\nG40 X-9\n",
    "O1\nG0 X0 Y0 Z0\nG66 P2 A1 Z-2.\nX1\nX2 L2\nG67\nX3\nM30\nO2\nG1 Z#26 F9\nX#1\nM99\n",
    "%\nO1000 (PART)\nG21 G90 G17 G40 G49 G80\nT1 M6\nS8000 M3\nG54 G0 X0 Y0\nG43 H1 Z5\nG1 Z-1 F200\nG3 X5 Y5 I0 J5\nG2 X0 Y0 R10\nM5\nM30\n%\n",
    "#1=0\no1 while [#1 lt 5]\n#1=[#1+1]\nG1 X#1 F100\no1 endwhile\no2 sub\nG1 Y#1\no2 endsub [#1]\no2 call [1] [2]\nM2\n",
    "O1\nWHILE [#100 LT 3] DO1\n#100=#100+1\nG65 P2 A#100 B2.\nEND1\nIF [#100 EQ 3] GOTO 9\nM98 P2 L3\nN9 M30\nO2\nG1 X#1\nM99\n",
    "G0 X-10 Y0 Z0\nG41.1 D2\nG1 X0 Y0 F9\nX10\nG2 X12 Y2 R2\nY10\nG3 X10 Y12 I-2\nX0\nY0\nG40\nG0 X-10\n",
    "G98 G81 X1 Y1 Z-5 R1 F100\nG91 X1 L3\nG83 Z-3 Q0.5 R-1\nG84 X2\nG80\nG76 X1 Y1 Z-1 R2 I1\nG18 G82 X1 Z1 Y-1 R2\n",
    "G10 L2 P1 X1 Y2 Z3 R10\nG55 G92 X1\nG52 X5\nG92.2\nG92.3\nG68 X0 Y0 R30\nG51 P2\nG51.1 X1\nG16 X5 Y30\nG15 G69 G50 G50.1 G28 Z0\nG53 G0 Z0\n",
    "M428\nG93 G1 X1 Y2 Z3 A10 C20 F5\nA-90 C400\nG43.4 H1\nG94 G95\nM429\nM70\nM72\nG4 P1\n(DEBUG, %f #1 #<_x>)\n(PRINT, #5420)\n/G1 X1\n",
    "N10 #<a>=[SIN[30]*2**3 MOD 5]\nX[ATAN[1]/[2]] Y##1 Z#[1+2]\n#1=EXISTS[#<a>]\nG1 X-#<a> F-1\n(MSG, x)\n$H\n{\"a\":1}\n",
];

const WORDS: [&str; 78] = [
    "G5.2 P1",
    "X1 Y2 P1",
    "G5.3",
    "G5 I1 J1 P1 Q1",
    "G68.2 P1 I9 J8",
    "G68.2 P2 Q1",
    "G68.2 P2 Q2 X1",
    "G68.2 P2 Q3 Y1",
    "G68.4 K9",
    "G53.1",
    "G87 Z-1 R-2 I1",
    "G13 I9 D1",
    "G46 D1",
    "G33 K1",
    "G0",
    "G1",
    "G2",
    "G3",
    "G17",
    "G18",
    "G19",
    "G20",
    "G21",
    "G28",
    "G30",
    "G40",
    "G41.1 D1",
    "G42.1 D2",
    "G43 H1",
    "G49",
    "G52",
    "G53",
    "G54",
    "G55",
    "G68 R30",
    "G69",
    "G80",
    "G81 Z-1 R1",
    "G83 Z-1 R1 Q.1",
    "G90",
    "G91",
    "G92",
    "G92.1",
    "G98",
    "G99",
    "G10 L2 P1",
    "G10 L20 P1",
    "M98 P1",
    "M99",
    "M3 S100",
    "M6 T1",
    "M70",
    "M72",
    "M30",
    "X1",
    "Y-2.5",
    "Z3",
    "I1",
    "J-1",
    "K.5",
    "R2",
    "F100",
    "P2",
    "Q1",
    "L3",
    "A10",
    "B5",
    "C-20",
    "#1=[#1+1]",
    "X#1",
    "Y[#2*2]",
    "o1 while [#1 lt 3]",
    "o1 endwhile",
    "o2 sub",
    "o2 endsub",
    "o2 call [1]",
    "IF [#1 LT 9] GOTO 5",
    "N5",
];

fn made(random: &mut Random) -> Vec<u8> {
    let mut text = String::new();
    for _ in 0..random.below(14) {
        for _ in 0..=random.below(4) {
            text += random.one(&WORDS);
            text.push(' ');
        }
        text.push('\n');
    }
    text.into_bytes()
}

const CHARACTERS: &str = "GXYZMOo#[]<>()/%;:\n 0123456789.-+*";

fn run(from: u64, count: u64) -> (u64, u64) {
    let real = seeds(&["nc", "ngc", "gcode"]);
    let (mut read, mut poses) = (0, 0);
    let controllers = [
        None,
        Some(Controller::LinuxCnc),
        Some(Controller::Fanuc),
        Some(Controller::Haas),
        Some(Controller::Grbl),
    ];
    for seed in from..from + count {
        let mut random = Random::new(seed);
        let bytes = if random.below(2) == 0 {
            random.mutated(&SEEDS, &real, CHARACTERS)
        } else {
            made(&mut random)
        };
        let text = String::from_utf8_lossy(&bytes);
        let mut options = ReadOptions::default();
        options.controller = controllers[random.below(controllers.len())];
        options.lenient = random.below(3) == 0;
        options.exact_arcs = random.below(2) == 0;
        options.arc_tolerance = 0.1;
        options.most_blocks = 2000;
        options.most_poses = 5000;
        let offset = ToolOffset {
            length: 9.0,
            diameter: 3.0,
        };
        options.tool_offsets.insert(1, offset);
        match gcode::read(&text, &options) {
            Ok(program) => {
                read += 1;
                if seed % 8 == 0 {
                    let mut writing = write::GcodeOptions::default();
                    writing.dialect =
                        [Controller::LinuxCnc, Controller::Siemens, Controller::Heidenhain][random.below(3)];
                    writing.arc_tolerance = 0.1;
                    let _ = write::gcode(&program, &writing);
                }
                poses += program.poses.len() as u64;
                assert!(program.poses.len() <= options.most_poses, "{text}");
                assert!(program.events.iter().all(|event| event.pose <= program.poses.len()));
                assert!(
                    program
                        .poses
                        .iter()
                        .all(|pose| pose.call.is_none_or(|call| (call as usize) < program.calls.len()))
                );
                assert!(
                    program
                        .poses
                        .iter()
                        .all(|pose| pose.pose.tip().iter().all(|x: &f64| x.is_finite()))
                );
            }
            Err(error) => assert!(error.further().len() <= 101),
        }
    }
    (read, poses)
}

#[test]
fn no_program_breaks_the_reader() {
    let (read, poses) = run(0, 4000);
    assert!(
        read > 400 && poses > 1000,
        "{read} of 4000 are read: the generator makes too much nonsense"
    );
}

/// `cargo test -p sweepsim-nc --test it ten_million_programs -- --ignored --nocapture`; see [`super::number`].
#[test]
#[ignore = "takes minutes"]
fn ten_million_programs() {
    let (from, count) = (number("FUZZ_FROM", 0), number("FUZZ_COUNT", 10_000_000));
    let start = std::time::Instant::now();
    let (read, poses) = run(from, count);
    println!(
        "{count} programs from {from}: {read} read, {poses} poses, {:?}",
        start.elapsed()
    );
}
