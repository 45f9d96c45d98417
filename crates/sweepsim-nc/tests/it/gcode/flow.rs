//! Subprograms, loops, branches and variables, and what moves remember of them.

use sweepsim_nc::{Controller, ReadOptions, gcode, read_file};

use super::{assert_near, options, program, program_with, tips};

#[test]
fn linuxcnc_loops() {
    let xs = |text: &str| -> Vec<f64> { tips(&program(text)).iter().map(|tip| tip[0]).collect() };
    let start = "F100\nG0 X0 Y0 Z0\n#1=0\n";
    assert_eq!(
        xs(&format!(
            "{start}o1 while [#1 lt 3]\n#1=[#1+1]\nG1 X#1\no1 endwhile\nX9"
        )),
        [0.0, 1.0, 2.0, 3.0, 9.0]
    );
    assert_eq!(
        xs(&format!("{start}o1 do\n#1=[#1+1]\nG1 X#1\no1 while [#1 lt 3]\nX9")),
        [0.0, 1.0, 2.0, 3.0, 9.0]
    );
    assert_eq!(
        xs(&format!("{start}o1 repeat [3]\n#1=[#1+1]\nG1 X#1\no1 endrepeat\nX9")),
        [0.0, 1.0, 2.0, 3.0, 9.0]
    );
    assert_eq!(
        xs(&format!(
            "{start}o1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 elseif [#1 eq 5]\no1 break\no2 else\nG1 X#1\no2 endif\no1 endwhile\nX9"
        )),
        [0.0, 1.0, 3.0, 4.0, 9.0]
    );
    assert_eq!(
        xs(&format!("{start}o1 repeat [0]\nG1 X1\no1 endrepeat\nG1 X9")),
        [0.0, 9.0]
    );
}

#[test]
fn fanuc_loops() {
    let fanuc = options(Controller::Fanuc);
    let xs = |text: &str| -> Vec<f64> { tips(&program_with(text, &fanuc)).iter().map(|tip| tip[0]).collect() };
    let start = "O1\nF100\nG0 X0 Y0 Z0\n#100=0\n";
    assert_eq!(
        xs(&format!(
            "{start}WHILE [#100 LT 3] DO1\n#100=#100+1\nG1 X#100\nEND1\nX9.\nM30"
        )),
        [0.0, 1.0, 2.0, 3.0, 9.0]
    );
    assert_eq!(
        xs(&format!(
            "{start}N10 #100=#100+1\nG1 X#100\nIF [#100 LT 3] GOTO 10\nX9.\nM30"
        )),
        [0.0, 1.0, 2.0, 3.0, 9.0]
    );
    assert_eq!(
        xs(&format!(
            "{start}IF [#100 EQ 0] THEN #101=7\nG1 X#101\nGOTO 5\nX8.\nN5 X9."
        )),
        [0.0, 7.0, 9.0]
    );
    // Nested loops; a variable without a value leaves its word out; #0 is no number.
    assert_eq!(
        xs(&format!(
            "{start}WHILE[#100LT2]DO1\n#101=0\nWHILE[#101LT2]DO2\nG1 X[10*#100+#101+1] Y#500\n#101=#101+1\nEND2\n#100=#100+1\nEND1\nIF[#500 EQ #0]THEN X99."
        )),
        [0.0, 1.0, 2.0, 11.0, 12.0, 99.0]
    );
    // Precedence: AND binds like a product, on bits.
    assert_eq!(xs(&format!("{start}#1=6 AND 3+1\nG1 X#1")), [0.0, 3.0]);
}

#[test]
fn calls_keep_the_lines_that_led_to_a_move() {
    let text = "F100\nG0 X0 Y0 Z0\nM98 P10 L2\nG1 X9\nM30\nO10\nG91 G1 X1\nM98 P20\nG90\nM99\nO20\nY1\nM99\n";
    let found = program(text);
    assert_near(
        &tips(&found),
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [2.0, 1.0, 0.0],
            [2.0, 2.0, 0.0],
            [9.0, 2.0, 0.0],
        ],
    );
    let stacks: Vec<Vec<usize>> = found
        .poses
        .iter()
        .map(|pose| {
            let calls = found.calls_of(pose.call).map(|call| call.line);
            std::iter::once(pose.line).chain(calls).collect()
        })
        .collect();
    assert_eq!(
        stacks,
        [vec![2], vec![7, 3], vec![12, 8, 3], vec![7, 3], vec![12, 8, 3], vec![4]]
    );
    assert_eq!(found.calls.len(), 2, "each call once");
}

#[test]
fn macro_arguments() {
    let fanuc = options(Controller::Fanuc);
    let text = "F100\nG0 X0 Y0 Z0\n#1=5\nG65 P9 L2 A7. X8. I3.\nG1 X#1\nM30\nO9\nG1 X#1 Y#24 Z#4\n#1=99\nX#1\nM99";
    let found = program_with(text, &fanuc);
    // The second time, #1 is what the first has left.
    assert_near(
        &tips(&found)[1..],
        &[[7.0, 8.0, 3.0], [99.0, 8.0, 3.0], [5.0, 8.0, 3.0]],
    );
    let text = "F100\nG0 X0 Y0 Z0\nG65 P9 A1. I2. J3. I4. K5.\nM30\nO9\nG1 X#4 Y#7 Z#9\nM99";
    assert_near(&tips(&program_with(text, &fanuc))[1..], &[[2.0, 4.0, 5.0]]);
    // Both kinds of arguments in one call: the last word of a variable counts.
    let text = "F100\nG0 X0 Y0 Z0\nG65 P9 A1. I2. J3. I4. D5. X6. H7.\nM30\nO9\nG1 X#1 Y#7 Z#24\nX#4 Y#5 Z#11\nM99";
    assert_near(
        &tips(&program_with(text, &fanuc))[1..],
        &[[1.0, 5.0, 6.0], [2.0, 3.0, 7.0]],
    );
    // Haas: a part of the same program, and the short form of repeats.
    let haas = options(Controller::Haas);
    let text = "F100\nG0 X0 Y0 Z0\nM97 P100 L2\nM30\nN100 G91 G1 X1.\nM99";
    assert_eq!(tips(&program_with(text, &haas)).len(), 3);
    let text = "F100\nG0 X0 Y0 Z0\nM98 P30009\nM30\nO0009\nG91 G1 X1.\nM99";
    assert_eq!(tips(&program_with(text, &fanuc)).len(), 4);
    // M99 P returns elsewhere.
    let text = "F100\nG0 X0 Y0 Z0\nM98 P9\nX1.\nN7 G1 X2.\nM30\nO9\nY1.\nM99 P7";
    assert_near(
        &tips(&program_with(text, &fanuc))[1..],
        &[[0.0, 1.0, 0.0], [2.0, 1.0, 0.0]],
    );
}

#[test]
fn rounding_and_angles_of_fanuc() {
    let fanuc = options(Controller::Fanuc);
    // In a word, ROUND is to the least increment; elsewhere to whole numbers.
    let text = "F100\nG0 X0 Y0 Z0\n#1=1.23456\n#2=ROUND[2.5]\nG1 X[ROUND[#1]+ROUND[2.5]] Y#2 Z-ROUND[#[ROUND[1.2]]]\nG20\nX[ROUND[#1]]";
    assert_near(
        &tips(&program_with(text, &fanuc))[1..],
        &[[3.735, 3.0, -1.235], [1.2346 * 25.4, 3.0, -1.235]],
    );
    let linuxcnc = options(Controller::LinuxCnc);
    let found = program_with("F100\nG0 X0 Y0 Z0\nG1 X[ROUND[1.2]]", &linuxcnc);
    assert_near(&tips(&found)[1..], &[[1.0, 0.0, 0.0]]);
    // Angles of two arguments are from 0 to 360.
    let text = "F100\nG0 X0 Y0 Z0\nG1 X[ATAN[-1]/[-1]] Y[ATAN[1]/[-1]] Z[ATAN[-1]]";
    assert_near(&tips(&program_with(text, &fanuc))[1..], &[[225.0, 135.0, -45.0]]);
    let text = text.replace("Z[ATAN[-1]]", "");
    assert_near(&tips(&program_with(&text, &linuxcnc))[1..], &[[-135.0, 135.0, 0.0]]);
}

#[test]
fn subprograms_in_files() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("main.ngc", "F100\nG0 X0 Y0 Z0\no<pocket> call [3]\nM98 P77\nM2\n");
    write("pocket.ngc", "o<pocket> sub\nG1 X#1\no<pocket> endsub\nM2\n");
    write("O0077.nc", "%\nO0077\nG1 Y5\nM99\n%\n");
    let found = read_file(&folder.path().join("main.ngc"), &ReadOptions::default()).unwrap();
    assert_near(&tips(&found), &[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 5.0, 0.0]]);
    let names: Vec<String> = found
        .files
        .iter()
        .map(|file| file.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(names, ["main.ngc", "pocket.ngc", "O0077.nc"]);
    assert_eq!(
        found.file_of(&found.poses[1]).unwrap(),
        folder.path().join("pocket.ngc")
    );
    assert_eq!(
        (
            found.poses[1].line,
            found.calls_of(found.poses[1].call).next().unwrap().line
        ),
        (2, 3)
    );
    // Problems name the file that they are in.
    write("pocket.ngc", "o<pocket> sub\nG1 X#1\nG5 X1\no<pocket> endsub\n");
    let error = read_file(&folder.path().join("main.ngc"), &ReadOptions::default()).unwrap_err();
    assert!(error.file().unwrap().ends_with("pocket.ngc"), "{error}");
    assert_eq!(error.position().unwrap().line, 3);
    // Names lead nowhere else.
    let error = gcode::read("o<../main> call\nG0 X0 Y0 Z0", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("is missing"), "{error}");
}

#[test]
fn loops_end_by_a_budget() {
    let mut limited = ReadOptions::default();
    limited.most_blocks = 10_000;
    for (text, line) in [
        ("G0 X0 Y0 Z0\no1 while [1]\nG1 X1\no1 endwhile\n", 2),
        ("G0 X0 Y0 Z0\n#1=1\nN5 G1 X#1\n#1=#1+1\nGOTO 5\n", 3),
        ("#1=0\nG0 X0 Y0 Z0\nWHILE [1 EQ 1] DO1\n#1=#1+1\nEND1", 3),
    ] {
        let error = gcode::read(text, &limited).unwrap_err();
        assert_eq!(error.position().unwrap().line, line, "{error}");
        assert!(
            error
                .to_string()
                .contains("the number of executed blocks is 10000, but must be smaller: the loop that begins here"),
            "{error}"
        );
    }
    let error = gcode::read("G0 X0 Y0 Z0\nM98 P5\nM30\nO5\nM98 P5\nM99", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("calls within calls"), "{error}");
    limited.most_poses = 100;
    let error = gcode::read(
        "G0 X0 Y0 Z0\n#1=0\no1 while [1]\n#1=[#1+1]\nG1 X#1\no1 endwhile\n",
        &limited,
    )
    .unwrap_err();
    assert!(
        error.to_string().contains("the number of poses and events is 100"),
        "{error}"
    );
}

#[test]
fn variables_without_a_value() {
    let text = "G0 X0 Y0 Z0\nG1 X#100";
    assert!(
        gcode::read(text, &ReadOptions::default())
            .unwrap_err()
            .to_string()
            .contains("#100 has no value here")
    );
    // LinuxCNC's variables all have one; Fanuc leaves out the word.
    assert_eq!(
        program_with(&format!("F1\n{text}"), &options(Controller::LinuxCnc))
            .poses
            .len(),
        1
    );
    assert_eq!(
        program_with(&format!("{text} Y1."), &options(Controller::Fanuc)).poses[1]
            .pose
            .tip(),
        [0.0, 1.0, 0.0]
    );
    let mut given = options(Controller::Fanuc);
    given.variables.insert(100, 4.0);
    assert_eq!(program_with(text, &given).poses[1].pose.tip(), [4.0, 0.0, 0.0]);
    // All variables of a block are read before any is set.
    let found = program("#1=1 #2=2\n#1=#2 #2=#1\nG0 X#1 Y#2 Z0");
    assert_eq!(found.poses[0].pose.tip(), [2.0, 1.0, 0.0]);
    let found = program("#1=2 #2=3 #3=4\nG0 X##1 Y#[#1+1] Z0");
    assert_eq!(found.poses[0].pose.tip(), [3.0, 4.0, 0.0]);
}

#[test]
fn modal_macros_are_called_after_each_move() {
    let text = "O1 (MAIN)\nG90 G0 X0 Y0 Z5\nG66 P9 Z-2. R1.\nG0 X10\nX20\nG67\nX30\nM30\nO9\nG0 Z#18\nG1 Z#26 F100\nG0 Z5\nM99\n";
    let found = program_with(text, &options(Controller::Fanuc));
    let expected: Vec<[f64; 3]> = [
        [0.0, 0.0, 5.0],
        [10.0, 0.0, 5.0],
        [10.0, 0.0, 1.0],
        [10.0, 0.0, -2.0],
        [10.0, 0.0, 5.0],
        [20.0, 0.0, 5.0],
        [20.0, 0.0, 1.0],
        [20.0, 0.0, -2.0],
        [20.0, 0.0, 5.0],
        [30.0, 0.0, 5.0],
    ]
    .into();
    assert_near(&tips(&found), &expected);
    let error = |text: &str| gcode::read(text, &options(Controller::Fanuc)).unwrap_err().to_string();
    assert!(error("G0 X0 Y0 Z0\nG66 Z1\nX1").starts_with("2:1: G66 without the number of a program"));
    assert!(
        error("O1\nG0 X0 Y0 Z0\nG66 P2\nG66 P2\nX1\nM30\nO2\nM99")
            .starts_with("4:1: a modal macro call within another one")
    );
    let missing = gcode::read("O1\nG0 X0 Y0 Z0\nG66 P7\nX1\nM30\n", &options(Controller::Fanuc)).unwrap();
    assert!(missing.assumptions[0].what.contains("O7"));
}

/// Each turn of a loop looks through those that are open.
#[test]
fn loops_within_loops_without_end_are_refused() {
    let nested = |deep: usize| {
        let opened: String = (1..=deep).map(|k| format!("WHILE [#1 LT 1] DO {k}\n")).collect();
        let closed: String = (1..=deep).rev().map(|k| format!("END {k}\n")).collect();
        format!("G0 X0 Y0 Z0\n#1=0\n{opened}#1=1\nG1 X5 F100\n{closed}")
    };
    let read = |deep| gcode::read(&nested(deep), &ReadOptions::default());
    assert_eq!(read(100).unwrap().poses.len(), 2);
    let error = read(100_000).unwrap_err().to_string();
    assert_eq!(
        error,
        "103:1: loops within loops are more than 100 deep: Fanuc allows 3"
    );
}
