//! A shop's programs, as they came from its CAM system: read without options, with the tools that their comments say.

use super::folder;
use sweepsim_nc::{CutterKind, Program, ReadOptions, Units, read_file};

const INCH: f64 = 25.4;

fn read(name: &str) -> Program {
    let file = folder().join("shop/nist_smstestbed").join(name);
    read_file(&file, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The sizes and kinds of the tools that cut, by number.
fn tools(program: &Program) -> Vec<(u32, f64, &str)> {
    let mut used: Vec<u32> = program.poses.in_order().filter_map(|pose| pose.tool).collect();
    used.sort_unstable();
    used.dedup();
    let row = |number: u32| {
        let tool = program.tools.get(&number)?;
        Some((number, tool.diameter?, tool.kind.as_ref().map_or("", CutterKind::name)))
    };
    used.into_iter()
        .map(|number| row(number).unwrap_or((number, 0.0, "")))
        .collect()
}

#[track_caller]
fn same(found: &[(u32, f64, &str)], expected: &[(u32, f64, &str)]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!(
            a.0 == b.0 && (a.1 - b.1).abs() < 1e-9 && a.2 == b.2,
            "{a:?} instead of {b:?}"
        );
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn seven_programs_without_options() {
    let all = [
        ("box-rev-a-op1-bottom.nc", "NIST_MTC_CRADA_BOX_REV-A OP1"),
        ("box-rev-a-op2-front.nc", "NIST_MTC_CRADA_BOX_REV-A OP2"),
        ("box-rev-a-op3-back.nc", "NIST_MTC_CRADA_BOX_REV-A OP3"),
        ("box-rev-a-op5-cavity.nc", "NIST_MTC_CRADA_BOX_REV-A OP5"),
        ("cover-rev-a.nc", "NIST_MTC_CRADA_COVER_REV-A"),
        ("plate-1.nc", "NIST_MTC_CRADA_PLATE"),
        ("plate-4.nc", "NIST_MTC_CRADA_PLATE-4"),
    ];
    let mut tools_seen = 0;
    for (name, title) in all {
        let program = read(name);
        assert_eq!(
            (program.title.as_deref(), program.units),
            (Some(title), Units::Inch),
            "{name}"
        );
        // Each parks in G58, and that is all that is assumed.
        let [parking] = &program.assumptions[..] else {
            panic!("{name}: {:?}", program.assumptions)
        };
        assert!(
            parking.what == "the place of G58" && !parking.changes_verdict,
            "{name}: {parking}"
        );
        for (number, diameter, kind) in tools(&program) {
            assert!(diameter > 0.0 && !kind.is_empty(), "{name}: tool {number}");
            tools_seen += 1;
        }
    }
    assert_eq!(tools_seen, 32);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn tools_of_the_plate_and_of_the_cavity() {
    let flat = "flat end mill";
    same(
        &tools(&read("plate-1.nc")),
        &[
            (1, 0.093 * INCH, flat),
            (3, 0.5 * INCH, flat),
            (4, 0.25 * INCH, flat),
            (5, 0.125 * INCH, flat),
            (7, 0.5 * INCH, "drill"),
            (15, 3.0 * INCH, flat),
            (23, 0.125 * INCH, "drill"),
        ],
    );
    let cavity = read("box-rev-a-op5-cavity.nc");
    same(
        &tools(&cavity),
        &[
            (1, 0.75 * INCH, flat),
            (2, 0.5 * INCH, flat),
            (3, 0.5 * INCH, "bull-nose end mill"),
            (5, 0.113 * INCH, "drill"),
            (7, 0.375 * INCH, "drill"),
            (8, 4.0, "tap"),
            (9, 6.0, "ball end mill"),
            (10, 6.0, flat),
            (12, 0.0625 * INCH, flat),
            (13, 0.125 * INCH, flat),
            (21, 0.125 * INCH, "drill"),
            (24, 2.0 * INCH, flat),
        ],
    );
    assert_eq!(cavity.tools[&3].corner_radius, Some(0.125 * INCH));
}
