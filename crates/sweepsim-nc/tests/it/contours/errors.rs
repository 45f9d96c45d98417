//! What is an error, and where.

use sweepsim_nc::{heidenhain, siemens};

use super::{options, read};

#[test]
fn what_cannot_be_compensated_is_an_error() {
    let strict = || {
        let mut options = options(2.0);
        options.strict = true;
        options
    };
    let siemens_error = |text: &str| siemens::read(text, &strict()).unwrap_err().to_string();
    let mismatch =
        |found: String, expected: &str| (!found.starts_with(expected)).then(|| format!("{expected}\n    but {found}"));
    let mut wrong = Vec::new();
    let klartext_error = |text: &str| heidenhain::read(text, &strict()).unwrap_err().to_string();
    let start = "T1 D1 F9\nG0 X0 Y0 Z0\n";
    for (text, expected) in [
        (
            "G1 G41 X5\nX10\nY0.5\nX20\nG40 Y30",
            "6:1: the tool of radius 1 mm does not fit into this inside corner",
        ),
        (
            "G1 G41 X5\nX10\nG3 X11 Y0.5 CR=0.9\nX20\n",
            "5:4: the radius of this arc is 0.8999999999999998 mm, but must be more than the tool's",
        ),
        (
            "G2 G41 X5 Y5 CR=5\nG1 X9\n",
            "3:8: an arc cannot begin cutter compensation",
        ),
        (
            "G1 G41 X5\nX9\nG40 G2 X20 Y1 CR=9\n",
            "5:8: an arc right after the end of cutter compensation",
        ),
        (
            "G1 G41 X5\nX9\nTRANS X5\nX20\n",
            "5:7: another frame while cutter compensation is on is not supported yet",
        ),
        (
            "G1 G41 X5\nX9\nT2 D1 M6\nX20\n",
            "5:7: a tool change while cutter compensation is on",
        ),
        (
            "$TC_DP6[1,2]=3\nG1 G41 X5\nX9\nD2 Y20\n",
            "6:4: a change of D while cutter compensation is on",
        ),
        (
            "G1 G41 X5\nX9\nOFFN=1 Y20\n",
            "5:8: a change of OFFN while cutter compensation is on",
        ),
        (
            "G1 G41 X5\nX9\nG451 Y20\n",
            "5:6: a change of G450, G451 or DISC while cutter compensation is on",
        ),
        (
            "G1 G41 X5\nX9\nG18 X20\n",
            "5:5: a change of the plane while cutter compensation is on",
        ),
        (
            "G1 G41 X5\nY20\nKONT G40 X20 Y5\n",
            "5:10: KONT from or to a point behind the contour",
        ),
        ("G1 G41 X5\nY20\nKONT G40\nX20 Y5\n", "5:6: KONT with G40 alone is"),
        (
            "G1 G41 X5\nX9\nSUPA G0 Z9\n",
            "5:9: a move that only the machine knows while cutter compensation is on",
        ),
        (
            "SCALE X2 Y2 Z2\nG1 G41 X5\nX9\n",
            "4:1: cutter compensation in scaled coordinates",
        ),
        ("DISC=50 G1 G41 X5\nX9\n", "3:1: DISC is 50, but must be 0"),
        (
            "G1 G41 D2 X5\nX9\n",
            "3:1: the radius of T1 D2 for cutter compensation is not known",
        ),
        ("G1 G41 KONT X5 Y-5\nY5\nX20\nG40 Y30\n", ""),
        (
            "G1 G42 KONT X5 Y-5\nY5\nX20\nG40 Y30\n",
            "4:1: KONT from or to a point behind the contour",
        ),
        ("KONTC G1 G41 X5\nX9\n", "3:1: KONTC is not supported yet"),
        ("G1 X10 RND=8\nY5\n", "4:1: the radius of RND is 8, but must be smaller"),
        (
            "G1 X10 CHF=1\nG2 X20 Y10 CR=10\n",
            "4:4: CHF at an arc is not supported yet",
        ),
        ("G1 X10 RND=-1\nY10\n", "3:8: RND is -1, but must be 0 or positive"),
        ("G1 AP=30\n", "3:4: polar coordinates without AP and RP"),
        ("G1 AP=30 RP=4 X5\n", "3:15: X beside polar coordinates"),
        ("G1 X5\nCT X9\n", "4:4: CT ends straight ahead"),
    ] {
        if expected.is_empty() {
            read(&format!("{start}{text}"), false, &options(2.0));
            continue;
        }
        wrong.extend(mismatch(siemens_error(&format!("{start}{text}")), expected));
    }
    let start = "TOOL CALL 1 Z S9\nL X+0 Y+0 Z+0 R0 FMAX\n";
    for (text, expected) in [
        (
            "L X+5 RL F9\nL X+10\nL Y+0.5\nL X+20\nL Y+30 R0",
            "6:1: the tool of radius 1 mm does not fit",
        ),
        (
            "CR X+5 Y+5 R+5 DR- RL F9\n",
            "3:1: cutter compensation begins with a straight line",
        ),
        (
            "L X+5 RL F9\nL X+9\nL X+20 RR\n",
            "5:1: a change of cutter compensation without its end",
        ),
        ("L X+5 R+ F9\n", "3:7: R+: compensation along one axis"),
        ("L X+5 RL F9\nL X+9\nL Z+9 R0 FMAX M91\nL X+0 RL\n", ""),
        (
            "TOOL CALL 9 Z S9\nL X+5 RL F9\nL X+9\n",
            "4:1: the radius of tool 9 for cutter compensation is not known",
        ),
        (
            "L X+5 RL F9\nL X+9\nM128\nL X+20\n",
            "5:1: a switch of tip control while cutter compensation is on",
        ),
        (
            "L X+10 F9\nRND R2\nM5\nL Y+10\n",
            "4:1: RND before other than a feed move",
        ),
        ("L X+10 F9\nRND R2\nL Z+10\n", "5:1: RND at corners out of the plane"),
        ("CHF 2\nL Y+10\n", "3:1: CHF after other than a feed move"),
    ] {
        if expected.is_empty() {
            continue;
        }
        wrong.extend(mismatch(klartext_error(&format!("{start}{text}")), expected));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
