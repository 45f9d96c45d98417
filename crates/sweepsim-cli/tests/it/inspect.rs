//! `inspect` of programs, to the letter.

use crate::support::Workdir;

const PLATE: &str = r#"%
O0012 (PLATE)
(T1 D=6. CR=3. - ball end mill)
(T2 D=10. CR=0. TAPER=118deg - drill)
(stockMin:-10mm, -10mm, -12mm)
(stockMax:60mm, 40mm, 0mm)
G21 G90 G17 G40
T1 M6
S8000 M3
G54 G0 X0 Y0
G43 H1 Z5 M8
G1 Z-2 F300
G3 X20 Y0 I10 F600
G64 P0.02
M777
G0 Z30
M0 (TURN IT)
(MSG, CHANGE THE CLAMP)
T2 M6
S2000 M3
G0 X10 Y10 Z5
G83 Z-12 R1 Q5 F120
X20
G80
M30
%
"#;

const PLATE_SAID: &str = r#"   program  G-code, of any control, in millimetres
     title  PLATE
     moves  8 feed moves (1 arc) and 14 rapids, in 2 pieces
    extent  (0, −10.000, −12.000) … (20.000, 10.000, 30.000) mm
   cutting  (0, −10.000, −12.000) … (20.000, 10.000, 5.0000) mm
 tool axis  z all along
      time  18.9 s: 18.0 s of cutting, 858 ms of rapids at 10 m/min
      tool  1: ball end mill, diameter 6.0000, corner 3.0000, "ball end mill" — the flute length is missing
            2 feed moves, 38.416 mm, 4.5 s; 1 rapid, 32.000 mm
            z −2.0000 … 5.0000 mm, 8,000.0 rpm, 300.00 … 600.00 mm/min
      tool  2: drill, diameter 10.000, point 118.00°, "drill" — the flute length is missing
            6 feed moves, 27.016 mm, 13.5 s; 13 rapids, 110.98 mm
            z −12.000 … 1.0000 mm, 2,000.0 rpm, 120.00 mm/min
     stock  block (−10.000, −10.000, −12.000) … (60.000, 40.000, 0) mm
     stops  1: line 17
   message  line 18: "CHANGE THE CLAMP"
      note  line 14: G64 P0.02: corners may be rounded by as much; the path is read as programmed
   ignored  line 15: M777 is not understood: ignored
understood  all but 1 of 18 blocks that were executed
"#;

const TILTED: &str = r#"BEGIN PGM TILTED MM
BLK FORM 0.1 Z X-50 Y-50 Z-20
BLK FORM 0.2 X+50 Y+50 Z+0
TOOL CALL 5 Z S3000
L Z+50 R0 FMAX M3
L X+0 Y+0 R0 FMAX
L Z-1 F200
PLANE SPATIAL SPA+30 SPB+0 SPC+0 TURN
L X+0 Y+0 Z+5 R0 FMAX
L Z-1 F200
L X+10
PLANE RESET TURN
M30
END PGM TILTED MM
"#;

const TILTED_SAID: &str = r#"   program  Heidenhain Klartext, in millimetres
     title  TILTED
     moves  3 feed moves and 0 rapids, in 2 pieces
    extent  (0, −2.5000, −1.0000) … (10.000, 0.50000, 50.000) mm
   cutting  (0, −2.5000, −1.0000) … (10.000, 0.50000, 50.000) mm
 tool axis  2 directions while cutting: z, (0, −0.50000, 0.86603)
      time  20.1 s: 20.1 s of cutting
      tool  5: not described
            3 feed moves, 67.000 mm, 20.1 s
            z −1.0000 … 50.000 mm, 3,000.0 rpm, 200.00 mm/min
     stock  block (−50.000, −50.000, −20.000) … (50.000, 50.000, 0) mm
   warning  line 8: PLANE turns the rotary axes: the path breaks here (2 times, first here)
understood  all but 2 of 13 blocks that were executed
"#;

/// A table whose tool turns while it cuts.
const WAVE: &str = "x,y,z,i,j,k,rapid,feed,tool\n0,0,5,0,0,1,1,,3\n0,0,0,0,0,1,0,100,3\n10,0,0,0.6,0,0.8,0,100,3\n";

const WAVE_SAID: &str = r#"   program  table of poses, in millimetres
     moves  2 feed moves and 0 rapids, in 1 piece
    extent  (0, 0, 0) … (10.000, 0, 5.0000) mm
   cutting  (0, 0, 0) … (10.000, 0, 5.0000) mm
 tool axis  turns while cutting, up to 36.870 degrees from z
      time  9.0 s: 9.0 s of cutting
      tool  3: not described
            2 feed moves, 15.000 mm, 9.0 s
            z 0 … 5.0000 mm, 100.00 mm/min
"#;

#[test]
fn programs_in_words() {
    let folder = Workdir::new("");
    for (file, text, said) in [
        ("plate.nc", PLATE, PLATE_SAID),
        ("tilted.h", TILTED, TILTED_SAID),
        ("wave.csv", WAVE, WAVE_SAID),
    ] {
        std::fs::write(folder.path(file), text).unwrap();
        let found = folder.good(&["inspect", file]);
        assert_eq!(found, said, "{found}");
    }
    // The machine's own speed of rapids, and the control by name.
    let known = folder.good(&["inspect", "plate.nc", "--machine", "3-axis", "--controller", "haas"]);
    assert!(
        known.contains("G-code of Haas") && !known.contains("at 10 m/min"),
        "{known}"
    );
}

/// What a shop's program leaves open: said by `inspect` and by the report of `verify`, settled by options, refused by
/// `--strict`.
#[test]
fn what_programs_leave_open() {
    let folder = Workdir::new("");
    let shop = "%\nO0000(BRACKET)\n( 1/4\" DIA. 2 FLUTE E.M. )\nT3 M6\nG20 G90 G54 G0 X-1. Y0 Z.5 S9000 M3\nG1 Z-.1 F20.\nG41 D3 X0 Y0\nY1.\nX2.\nY0\nX0\n\
                G40 X-1.\nG0 Z.5\nG90 G58 X12. Y20.\nM30\n%\n";
    std::fs::write(folder.path("shop.nc"), shop).unwrap();
    let said = folder.good(&["inspect", "shop.nc"]);
    let tail: Vec<&str> = said.lines().rev().take(5).collect();
    let expected = [
        "understood  all but 2 of 12 blocks that were executed",
        "            to settle it: --offset G58=X,Y,Z, from the zero of the first work offset (in a job: offsets: {\"G58\": (X, Y, Z)})",
        "   assumed  line 14: the place of G58: not known; its rapids are left out",
        "            to settle it: --diameters D3=… (in a job: diameters), 0 if it is only the tool's wear: the tool is then 0.125 nearer to the contour",
        "   assumed  line 7: D3: the size of tool 3, 0.25 across",
    ];
    assert_eq!(tail, expected, "{said}");
    assert!(said.contains("tool  3: flat end mill, diameter 6.3500"), "{said}");
    let strict = folder.bad(&["inspect", "shop.nc", "--strict"]);
    assert!(strict.contains("the diameter D3"), "{strict}");
    let settled = folder.good(&["inspect", "shop.nc", "--diameters", "D3=0.25", "--offset", "G58=0,0,5"]);
    assert!(!settled.contains("assumed"), "{settled}");
    // The verdict of the bare program says it too, and so does a job that is made from it.
    folder.good(&[
        "verify", "shop.nc", "--cells", "40x40", "--only", "report", "--out", "out", "--quiet",
    ]);
    let report = std::fs::read_to_string(folder.path("out/report.json")).unwrap();
    assert!(report.contains("line 7: assumed: D3: the size of tool 3"), "{report}");
    folder.good(&[
        "new",
        "shop.nc",
        "--diameters",
        "D3=0.2",
        "--offset",
        "G58=0,0,5",
        "--quiet",
    ]);
    let job = std::fs::read_to_string(folder.path("shop.ron")).unwrap();
    assert!(
        job.contains("diameters: { 3: 5.08 }") && job.contains("offsets: { \"G58\": (0, 0, 127) }"),
        "{job}"
    );
}
