//! Bad programs, with the exact message that each gets.

use sweepsim_nc::{Controller, ReadOptions, gcode};

/// Text, controller, message.
const BAD: [(&str, Option<Controller>, &str); 53] = [
    (
        "G0 X0 Y0 Z0\nG1 F9 G68.2 P4 I9",
        None,
        "2:7: tilted planes by projection angles (G68.2 P4) are not supported yet: expected P0 to P3",
    ),
    (
        "G0 X0 Y0 Z0\nF9 G150 P1000",
        None,
        "2:4: G150 is not supported yet: its moves are not known; expected them written out",
    ),
    (
        "G0 X0 Y0 Z0\nG13 D0 F9",
        Some(Controller::Haas),
        "2:1: G13 without I: expected the radius of the first circle",
    ),
    (
        "G0 X0 Y0 Z0\nG33 Z-9",
        Some(Controller::Fanuc),
        "2:1: a thread without its pitch: expected F, the way in one revolution",
    ),
    (
        "G0 X0 Y0 Z0\nF9 G76 Z-9 R1",
        Some(Controller::LinuxCnc),
        "2:1: G76: threading cycles of lathes are not supported yet: expected G73, G74 or G81 to G89, or the moves written out",
    ),
    (
        "G0 X0 Y0 Z0\nF9 G5.2 X1",
        None,
        "2:1: a control point without X, Y or P: expected all of them",
    ),
    (
        "G0 X0 Y0 Z0\nG1 X#1",
        None,
        "2:5: #1 has no value here: LinuxCNC takes 0, Fanuc leaves out its word; expected `#1 = …` before, or the name of the control",
    ),
    (
        "G0 X0 Y0 Z0\nG1 X#<a>",
        None,
        "2:5: #<a> has no value here: expected `#<a> = …` before",
    ),
    ("G0 X[1+", None, "1:7: the line ends here, but expected a number"),
    ("G0 X[1 2]", None, "1:8: found '2', but expected an operator or `]`"),
    ("G0 X[1/0]", None, "1:7: this divides by zero"),
    ("G0 X SQRT[-4]", None, "1:6: SQRT of -4 has no value"),
    (
        "G0 X FOO[1]",
        None,
        "1:6: the function FOO is not supported yet: expected one of ABS, ACOS, ASIN, ATAN, COS, EXISTS, EXP, FIX, FUP, LN, POW, ROUND, SIN, SQRT, TAN",
    ),
    (
        "G0 X ATAN[1]",
        None,
        "1:6: ATAN has one argument: expected two, ATAN[a]/[b]",
    ),
    (
        "#1 5",
        None,
        "1:4: found '5', but expected `=` after a variable at the beginning of a block",
    ),
    (
        "#[1.5]=2",
        None,
        "1:1: the number of a variable is 1.5, but must be a whole number from 0 to 99999",
    ),
    ("G0 X1.2.3 Y0 Z0", None, "1:4: expected a number after `X`"),
    (
        "G0 (open",
        None,
        "1:4: this comment is not closed: expected `)` on the same line",
    ),
    (
        "G0 X1 & Y2",
        None,
        "1:7: found '&', but expected a letter with a number",
    ),
    ("G0 X0 X1", None, "1:7: a second X in one block: expected one"),
    (
        "G0 G1 X0",
        None,
        "1:4: a second motion code in one block: expected one of G0, G1, G2 and G3",
    ),
    (
        "X1 Y1 Z1",
        None,
        "1:1: X without a motion code: expected G0, G1, G2 or G3 here or before",
    ),
    (
        "G0 X0 Y0 Z0\nG200 X1",
        None,
        "2:1: G200 is not supported yet: it could move the tool; expected a code of RS-274",
    ),
    (
        "G0 X0 Y0 Z0\nG0 U1",
        None,
        "2:4: the axis U is not supported yet: expected X Y Z A B C",
    ),
    (
        "G0 X0 Y0 Z0\nG38.2 Z-5",
        None,
        "2:1: G38.2: probing is not supported yet: the path of the tool would be unknown; expected G0, G1, G2 or G3",
    ),
    (
        "G0 X0 Y0 Z0\nG2 X1",
        None,
        "2:1: this arc has no centre: expected I and J, or R",
    ),
    (
        "G0 X0 Y0 Z0\nG2 X5 R1",
        None,
        "2:1: the arc's radius 1 mm is too small: its ends are 5 mm apart",
    ),
    (
        "G0 X0 Y0 Z0\nG3 R5",
        None,
        "2:1: an arc with R cannot end where it starts (a full circle needs its centre: I, J, K)",
    ),
    (
        "G0 X0 Y0 Z0\nG2 X2 R1 I1",
        None,
        "2:1: an arc with both R and a centre: expected R, or I, J, K",
    ),
    (
        "G0 X0 Y0 Z0\nG2 X2 I1 P1.5",
        None,
        "2:1: the number of turns P is 1.5, but must be a whole number from 1 on",
    ),
    (
        "G0 X0 Y0 Z0\nG1 X1 I5",
        None,
        "2:1: I, J, K or R outside an arc: expected G2 or G3 with them",
    ),
    (
        "G0 X0 Y0 Z9\nG81 X1 R1",
        None,
        "2:1: G81 without Z: expected R, the plane to drill from, and Z, the bottom",
    ),
    (
        "G0 X0 Y0 Z9\nG81 X1 Z5 R1",
        None,
        "2:1: the plane R of G81 is 1, but must be above the bottom, 5 in Z",
    ),
    (
        "G0 X0 Y0 Z9\nG83 X1 Z-5 R1",
        None,
        "2:1: G83 without Q: expected the depth of a peck",
    ),
    (
        "G0 X0 Y0 Z9\nG83 X1 Z-5 R1 Q0",
        None,
        "2:1: the depth Q of a peck of G83 is 0, but must be more than 0",
    ),
    (
        "G0 X0 Y0 Z9\nG81 X1 Z-5 R1 L1.5",
        None,
        "2:1: the number of repeats is 1.5, but must be a whole number from 0 on",
    ),
    (
        "G0 X0 Y0 Z0\nG41 D3 G1 X5",
        None,
        "2:1: the diameter D3 for cutter compensation is not known: expected --diameters D3=… (in a job: `diameters`), a tool table, or G41.1 D with the diameter",
    ),
    (
        "G0 X0 Y0 Z0\nG41.1 D10\nG1 X3",
        None,
        "3:1: the length of the move that begins the cutter compensation is 3 mm, but must be more than the tool's radius, 5 mm",
    ),
    (
        "G0 X0 Y0 Z0\nG41.1 D4\nG1 X9\nG3 X9 Y2 J1",
        None,
        "4:1: the radius of this arc is 1 mm, but must be more than the tool's, 2 mm: the tool does not fit into it",
    ),
    (
        "G0 X0 Y0 Z0\nG41.1 D2\nG1 X9\nG1 X18\nG1 Y0.5\nG1 X9",
        None,
        "6:1: the tool of radius 1 mm does not fit into this inside corner: it would gouge the move before",
    ),
    (
        "G0 X0 Y0 Z0\nG41.1 D2\nG1 X9\nG55 X0",
        None,
        "4:1: a change of the work offset while cutter compensation is on: expected G40 before it",
    ),
    (
        "G0 X0 Y0 Z0\nG41.1 D2\nG1 X9\nT1 M6",
        None,
        "4:4: a tool change while cutter compensation is on: expected G40 before it",
    ),
    (
        "o1 sub\nG0 X0\n",
        None,
        "1:1: there is no `O1 endsub` after the line where it begins",
    ),
    (
        "G0 X0 Y0 Z0\no1 endwhile",
        None,
        "2:1: `O1 endwhile` without `O1 while` before it",
    ),
    (
        "G0 X0 Y0 Z0\no1 if [1] \no1 else",
        None,
        "3:1: there is no `O1 endif` after this line",
    ),
    (
        "G0 X0 Y0 Z0\no1 return",
        None,
        "2:1: this ends a subroutine that was not called by `O… call`: a subprogram called by M98 ends with M99",
    ),
    (
        "G0 X0 Y0 Z0\nM98",
        None,
        "2:1: M98 without P: expected the number of a subprogram",
    ),
    (
        "G0 X0 Y0 Z0\nM98 P7\nM30\nO7 sub\nO7 endsub",
        None,
        "2:1: `O7 sub` begins a subroutine of LinuxCNC: expected `O7 call`",
    ),
    (
        "G0 X0 Y0 Z0\nO7 call\nM30\nO7\nM99",
        None,
        "2:1: O7 is a subprogram without `sub`: expected M98 P to call it",
    ),
    ("G0 X0 Y0 Z0\nGOTO 7", None, "2:6: there is no block N7 to go to"),
    ("G0 X0 Y0 Z0\nEND1", None, "2:1: END1 without WHILE … DO1 before it"),
    (
        "G0 X0 Y0 Z0\nG65 A1",
        None,
        "2:1: G65 without the number of a program: expected P",
    ),
    (
        "G0 X0 Y0 Z0\n#2001=5",
        Some(Controller::Fanuc),
        "2:1: setting the control's own variable #2001 is not supported yet: expected a variable below #1000, or a work offset from #5221 on",
    ),
];

#[test]
fn forty_bad_programs() {
    let mut wrong = Vec::new();
    for (text, controller, message) in BAD {
        let mut options = ReadOptions::default();
        (options.controller, options.strict) = (controller, true);
        match gcode::read(text, &options) {
            Ok(_) => wrong.push(format!("{text:?} was read")),
            Err(error) if error.to_string() == message => {}
            Err(error) => wrong.push(format!("{text:?}\n    {error}\n    {message}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn positions_are_within_their_lines() {
    for (text, controller, _) in BAD {
        let mut options = ReadOptions::default();
        options.controller = controller;
        let Err(error) = gcode::read(text, &options) else {
            continue;
        };
        for error in std::iter::once(&error).chain(error.further()) {
            let position = error.position().expect("a position");
            let line = text.lines().nth(position.line - 1).unwrap_or("");
            assert_eq!(position.excerpt, line);
            assert!(position.column <= line.chars().count().max(1) + 1, "{text:?}: {error}");
        }
    }
}
