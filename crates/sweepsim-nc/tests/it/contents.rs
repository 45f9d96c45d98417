//! The content of a file decides its format where the extension does not.

use sweepsim_nc::{Program, ReadOptions, read_file};
use sweepsim_props::*;

/// Reads `text` from a file of that name: the program, or the error after the folder's name.
fn read(name: &str, text: &[u8]) -> Result<Program, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    std::fs::write(&file, text).unwrap();
    read_file(&file, &ReadOptions::default()).map_err(|error| {
        let message = error.to_string();
        message[folder.path().to_str().unwrap().len() + 1..].to_owned()
    })
}

const NAMES: [&str; 10] = [
    "a.nc", "a.txt", "a.NCD", "a.tap", "a.h", "a.mpf", "a.cls", "a.ncl.8", "a", "O1000",
];

#[test]
fn gcode_and_tables_by_any_name() {
    for name in NAMES {
        let program = read(name, b"%\nO1000 (part)\nG21\nG0 X0 Y0 Z5\nG1 Z0\n").unwrap();
        assert_eq!(program.poses[1].pose.tip(), [0.0, 0.0, 0.0], "{name}");
        for text in [
            &b"x,y,z,i,j,k\n1,2,3,0,0,1\n"[..],
            b"$$ by hand\nPARTNO/1\nGOTO/1,2,3\n",
            b"\nTOOL PATH/MILL,TOOL,D10\nGOTO/1,2,3,0,0,1\n",
        ] {
            let program = read(name, text).unwrap();
            assert_eq!(program.poses[0].pose.tip(), [1.0, 2.0, 3.0], "{name}");
        }
    }
    assert!(read("a.csv", b"G0 X0 Y0 Z5\n").is_err(), "a .csv is a table");
}

#[test]
fn rows_of_six_numbers_are_poses() {
    let program = read("a.txt", b"\n1 2 3 0 0 1\n1;2;3;0;0;2\n4, 5, 6, 0.1, 0, 1\n").unwrap();
    let lines: Vec<usize> = program.poses.iter().map(|pose| pose.line).collect();
    assert_eq!(lines, [2, 4]);
    assert!(
        program.notes[0]
            .message
            .starts_with("rows of six numbers without a header")
    );
    assert_eq!(
        read("a.txt", b"1 2 3 0 0 1\n1 2 3 0 0\n").unwrap_err(),
        "a.txt:2:1: a row is \"1 2 3 0 0\", but must be six numbers, as in the first row"
    );
    assert_eq!(
        read("a.txt", b"1 2 3 0 0 0\n").unwrap_err(),
        "a.txt:1:1: the axis (0, 0, 0) has no direction"
    );
}

#[test]
fn klartext_is_read_whatever_the_extension() {
    for name in NAMES {
        assert_eq!(
            read(name, b"0 BEGIN PGM 12 MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n").unwrap_err(),
            format!("{name}:2:1: this program has no move: expected at least one with X, Y and Z known")
        );
        assert!(read(name, b"0 BEGIN PGM 12 MM\n1 L X+0 Y+0 Z+5 FMAX\n").is_ok());
    }
}

#[test]
fn what_is_not_recognised() {
    let expected = "but must be G-code, a program of Siemens or Heidenhain, APT or CLSF, or a table of poses with the columns x,y,z,i,j,k";
    assert_eq!(
        read("a.txt", b"-20.1 -18.5 1.6 0 0 1 7\n").unwrap_err(),
        format!(
            "a.txt:1:1: the content of this path file is rows of numbers without a header, and not six in each, {expected}"
        )
    );
    for content in [&b""[..], b"dear all\n", b"\0\x01\x02", b"{\"version\": 36}"] {
        assert_eq!(
            read("a.txt", content).unwrap_err(),
            format!("a.txt: the content of this path file is not recognised, {expected}")
        );
    }
    // The extension says G-code: its reader says what is wrong, and where.
    assert_eq!(
        read("a.nc", b"dear all\n").unwrap_err(),
        "a.nc:1:1: statements like `dear` are not supported yet: expected RS-274 words, a letter and a number each (Siemens and macro \
         programs: post-process them first)"
    );
    // Siemens's words are those of another reader.
    assert!(
        read("a.txt", b"N10 DEF REAL _x\n")
            .unwrap_err()
            .starts_with("a.txt:1:1: this program has no move")
    );
}

fn words() -> impl Strategy<Value = String> {
    let words = [
        "G0 ",
        "G1",
        "G2",
        "G5 ",
        "G5.1",
        "G64",
        "G70",
        "G92",
        "G92.1",
        "G92.2",
        "G92.3",
        "G52",
        "G10 L20",
        "G255",
        "M99",
        "M6",
        "O",
        "O1 T",
        "<",
        ">",
        "%",
        ":1",
        "P10000",
        "P0",
        "Q1",
        "X1",
        "Y",
        "Z0",
        "I1",
        "J-1",
        "K2",
        "R2",
        "A90",
        "GOTO/",
        "$$",
        "BEGIN PGM",
        "x,y,z,i,j,k",
        "1.5 ",
        "\n",
        "\n",
        "\n",
        "é",
        "\0",
    ];
    collection::vec(prop_oneof![8 => prop::sample::select(words.to_vec()).prop_map(str::to_owned), 1 => any::<char>().prop_map(String::from)], 0..60)
        .prop_map(|parts| parts.concat())
}

proptest! {
    #[test]
    fn garbage_never_panics(text in words(), name in prop::sample::select(NAMES.to_vec()), moved in any::<bool>()) {
        let text = if moved { format!("G0 X0 Y0 Z0\n{text}") } else { text };
        let _ = read(name, text.as_bytes());
    }

    #[test]
    fn bytes_never_panic(bytes in collection::vec(any::<u8>(), 0..200), name in prop::sample::select(NAMES.to_vec())) {
        let _ = read(name, &bytes);
    }
}

#[test]
fn a_return_by_itself_ends_a_line() {
    let lines = [
        ("a.nc", "G21 G90 ; first~G0 X0 Y0 Z5~G1 X1 F100 ; on~G1 X2~Y2~M30~"),
        ("a.mpf", "G710 G90 ; first~G0 X0 Y0 Z5~G1 X1 F100 ;on~G1 X2~Y2~M30~"),
        (
            "a.h",
            "BEGIN PGM A MM~L X+0 Y+0 Z+5 R0 FMAX~L X+1 ~~ F100 ;on~L X+2~L Y+2~END PGM A MM~",
        ),
        (
            "a.cls",
            "PARTNO A~UNITS/MM~GOTO/0,0,5~PPRINT on~GOTO/1,$~0,5~GOTO/2,0,5~GOTO/2,2,5~FINI~",
        ),
        ("a.csv", "x,y,z,i,j,k~0,0,5,0,0,1~1,0,5,0,0,1~2,0,5,0,0,1~2,2,5,0,0,1~"),
    ];
    for (name, text) in lines {
        // Klartext continues a line by `~` itself.
        let ended = |end: &str| {
            text.replace("~~", "\0")
                .replace('~', end)
                .replace('\0', &format!("~{end}"))
        };
        let read = |text: String| {
            let program = read(name, text.as_bytes()).unwrap_or_else(|error| panic!("{text:?}: {error}"));
            let poses: Vec<_> = program.poses.iter().map(|pose| (pose.pose.tip(), pose.line)).collect();
            poses
        };
        let expected = read(ended("\n"));
        let tips: Vec<_> = expected.iter().map(|(tip, _)| *tip).collect();
        assert_eq!(
            tips,
            [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [2.0, 0.0, 5.0], [2.0, 2.0, 5.0]],
            "{name}"
        );
        for end in ["\r\n", "\r"] {
            assert_eq!(read(ended(end)), expected, "{name} {end:?}");
        }
        // Among other ends, too.
        let mixed = ended("\n").replacen('\n', "\r", 3);
        assert_eq!(read(mixed), expected, "{name}");
    }
    // What belongs to the end of a line does not end another.
    let program = read("a.nc", b"G21\r\r\nG0 X0 Y0 Z5\n\rG0 X1\r\r\n").unwrap();
    assert_eq!(program.poses.last().unwrap().line, 3);
}

/// A text in UTF-16 of either order, with its mark.
fn utf16(text: &str) -> [Vec<u8>; 2] {
    let units = || "\u{feff}".encode_utf16().chain(text.encode_utf16());
    [
        units().flat_map(u16::to_le_bytes).collect(),
        units().flat_map(u16::to_be_bytes).collect(),
    ]
}

/// As Windows' editors and PowerShell write them.
#[test]
fn programs_in_utf16_are_read_as_in_utf8() {
    for text in [
        "%\r\nO1000 (Größe 😀)\r\nG21\r\nG0 X0 Y0 Z5\r\nG1 Z0 F500\r\nM30\r\n",
        "O1000\rG21\rG0 X0 Y0 Z5\rG1 Z0 (\u{a0d}\u{d0a})\rM30",
        "0 BEGIN PGM A MM\n1 L X+0 Y+0 Z+5 R0 FMAX\n2 L Z+0 F500\n3 END PGM A MM\n",
        "TOOL PATH/MILL,TOOL,D10\nGOTO/1,2,3,0,0,1\nGOTO/1,2,0,0,0,1\n",
        "1 2 3 0 0 1\n4 5 6 0 0 1\n",
    ] {
        let expected = read("a.txt", text.as_bytes()).unwrap();
        for bytes in utf16(text) {
            let program = read("a.txt", &bytes).unwrap();
            assert_eq!(program.poses, expected.poses, "{text}");
            assert_eq!(program.poses.len(), 2, "{text}");
        }
    }
    // Where a line is wrong it is named; what is cut off within a character is no character.
    for bytes in utf16("G21\nG0 X0 Y0 Z5\nG1 Z0 !\n") {
        let error = read("a.nc", &bytes).unwrap_err();
        assert!(error.starts_with("a.nc:3:7: "), "{error}");
    }
    let [mut bytes, _] = utf16("G21\nG0 X0 Y0 Z5\nG1 Z0\nX1");
    bytes.pop();
    let error = read("a.nc", &bytes).unwrap_err();
    assert!(error.starts_with("a.nc:4:1: expected a number after `X`"), "{error}");
    for bytes in utf16("x,y,z,i,j,k\n1,2,3,0,0,1\n") {
        let error = read("a.csv", &bytes).unwrap_err();
        assert!(
            error.starts_with("a.csv:1:1: this table is in UTF-16: expected UTF-8"),
            "{error}"
        );
    }
}
