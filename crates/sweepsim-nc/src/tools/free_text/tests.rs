//! Comments of many hands, and the tools that they mean. The sizes are from the standards, not from the code.

use super::*;

/// The number, the kind, the diameter in mm, and a corner or an angle.
type Expected = (Option<u32>, &'static str, f64, Option<f64>);

fn check(unit: f64, cases: &[(&str, Expected)]) {
    for (comment, (number, kind, diameter, further)) in cases {
        let found = read(comment, unit).unwrap_or_else(|| panic!("{comment}: nothing"));
        let tool = &found.tool;
        let extra = tool.corner_radius.or(tool.point_angle).or(tool.taper_angle);
        assert_eq!(found.number, *number, "{comment}");
        assert_eq!(tool.kind.as_ref().map_or("", CutterKind::name), *kind, "{comment}");
        let size = tool.diameter.unwrap();
        assert!(
            (size - diameter).abs() < 1e-9,
            "{comment}: {size} instead of {diameter}"
        );
        match (extra, further) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-9, "{comment}: {a} instead of {b}"),
            (a, b) => assert_eq!(a, *b, "{comment}"),
        }
    }
}

const FLAT: &str = "flat end mill";
const BALL: &str = "ball end mill";
const BULL: &str = "bull-nose end mill";

#[test]
fn inch_programs() {
    check(
        25.4,
        &[
            (
                "T3| 1/2 FLAT ENDMILL|H0|XY STOCK TO LEAVE - -.001",
                (Some(3), FLAT, 12.7, None),
            ),
            ("T2| 1/2 BULL ENDMILL 0.125 RAD|H0", (Some(2), BULL, 12.7, Some(3.175))),
            ("T10|   6. FLAT ENDMILL CRB|H33", (Some(10), FLAT, 6.0, None)),
            ("T9| 6. BALL ENDMILL|H47", (Some(9), BALL, 6.0, None)),
            ("T7|6MM EM|H0", (Some(7), FLAT, 6.0, None)),
            ("T1|.093 FLAT ENDMILL|H0", (Some(1), FLAT, 2.3622, None)),
            ("T15|3\" FACE MILL|H313", (Some(15), FLAT, 76.2, None)),
            ("T16|3. FACE MILL|H313", (Some(16), FLAT, 76.2, None)),
            ("T21| 1/8 SPOTDRILL|H0", (Some(21), "drill", 3.175, Some(90.0))),
            ("T5| NO. 33 DRILL|H0", (Some(5), "drill", 2.8702, None)),
            ("T6| LET. B DRILL|H0", (Some(6), "drill", 6.0452, None)),
            ("T8|  4.00-0.7 TAP RH|H0", (Some(8), "tap", 4.0, None)),
            ("T4 - 1/4\"-20 TAP", (Some(4), "tap", 6.35, None)),
            ("T4 10-32 TAP", (Some(4), "tap", 4.826, None)),
            ("T4 #6-32 SPIRAL POINT TAP", (Some(4), "tap", 3.5052, None)),
            ("T4 M6X1.0 TAP", (Some(4), "tap", 6.0, None)),
            (" 1/4\" DIA. 2 FLUTE CARBIDE E.M. ", (None, FLAT, 6.35, None)),
            ("1/2 DIA 4FL .030R ENDMILL", (None, BULL, 12.7, Some(0.762))),
            ("TOOL #12 - 3/8 BALL NOSE END MILL", (Some(12), BALL, 9.525, None)),
            ("TOOL NO. 5 .2505 REAMER", (Some(5), FLAT, 6.3627, None)),
            (
                "3/8 EM TOOL - 3 DIA. OFF. - 33 LEN. - 3 DIA. - .375",
                (Some(3), FLAT, 9.525, None),
            ),
            ("T11 = 1-1/4 SHELL MILL", (Some(11), FLAT, 31.75, None)),
            (
                "T12: 1/2 X 90 DEG CHAMFER MILL",
                (Some(12), "chamfer mill", 12.7, Some(45.0)),
            ),
            (
                "T12: 3/8 82 DEG COUNTERSINK",
                (Some(12), "chamfer mill", 9.525, Some(41.0)),
            ),
            ("T13 #7 (.201) DRILL", (Some(13), "drill", 5.1054, None)),
            ("T14 F DRILL 118 DEG", (Some(14), "drill", 6.5278, Some(118.0))),
            ("T17 .500 X 1.25 LOC X 3 OAL ENDMILL", (Some(17), FLAT, 12.7, None)),
            ("T30 RENISHAW PROBE D=.2362", (Some(30), "probe", 5.99948, None)),
        ],
    );
    let with_flutes = read("T17 .500 X 1.25 LOC X 3 OAL ENDMILL", 25.4).unwrap();
    assert!((with_flutes.tool.flute_length.unwrap() - 31.75).abs() < 1e-9);
    assert!(read("T10|   6. FLAT ENDMILL|H33", 25.4).unwrap().tool.notes[0].contains("millimetres"));
}

#[test]
fn millimetre_programs() {
    check(
        1.0,
        &[
            ("T1 END MILL D10", (Some(1), FLAT, 10.0, None)),
            ("TOOL 2: BULLNOSE D=12 R=1.5", (Some(2), BULL, 12.0, Some(1.5))),
            ("TOOL: MILL_D10_R0.5 TOOL 4", (Some(4), BULL, 10.0, Some(0.5))),
            ("T5 SCHAFTFRAESER D8", (Some(5), FLAT, 8.0, None)),
            ("T6 SPIRALBOHRER D6.8", (Some(6), "drill", 6.8, None)),
            ("T7 KUGELFRAESER DURCHMESSER 6", (Some(7), BALL, 6.0, None)),
            ("T8 1/2 END MILL", (Some(8), FLAT, 12.7, None)),
            ("T9 10MM SPOT DRILL 120 DEG", (Some(9), "drill", 10.0, Some(120.0))),
            ("T10 CENTER DRILL 3.15", (Some(10), "drill", 3.15, Some(60.0))),
            ("6H7 REAMER", (None, FLAT, 6.0, None)),
            ("T11 DIA 63 FACE MILL 5 INSERTS", (Some(11), FLAT, 63.0, None)),
            ("T12 Ø16 ENDMILL Z4", (Some(12), FLAT, 16.0, None)),
            ("#3 D=10 - ZMIN=-4.5 - flat end mill", (None, FLAT, 10.0, None)),
            ("T0 SCHAFT_D12_N_AP30", (Some(0), FLAT, 12.0, None)),
            ("T0 PLAN_D50_N_AP4", (Some(0), FLAT, 50.0, None)),
            ("T0 ENTFRAESER_D8_N_90GRAD", (Some(0), "chamfer mill", 8.0, Some(45.0))),
            ("T0 BOHRER_D3.3_VHM", (Some(0), "drill", 3.3, None)),
            ("T17 MILL-8 DM=8 CR=0 TL=357", (Some(17), FLAT, 8.0, None)),
        ],
    );
}

#[test]
fn prose_says_nothing_of_a_tool() {
    for comment in [
        "DRILL 4 HOLES",
        "MILL POCKET 2",
        "FACE PART",
        "ROUGH 1",
        "T3",
        "TOOL 5",
        "T2 OP 20",
        "OPERATION 2 FLAT",
        "SPOT DRILL",
        "USE 1/2 ENDMILL",
        "D=5",
        "DRILL 4",
        "X 5. TOOL",
        "2023-04-05",
        "STOCK 100 X 50 MILL",
    ] {
        assert!(read(comment, 1.0).is_none(), "{comment}");
    }
}
