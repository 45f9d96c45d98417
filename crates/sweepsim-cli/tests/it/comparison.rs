//! `compare` of parts whose true deviations are known, from every file that holds a surface.

use crate::support::Workdir;
use std::fs;
use sweepsim_formats::{ComparisonReport, SurfaceDeviation};

/// The files of a part that tell its surface.
const FORMS: [&str; 3] = ["part.dexels", "part.tridexels", "part.ply"];

/// The parts, simulated on lines 0.5 mm apart.
fn simulated(parts: &[(&str, String)]) -> Workdir {
    let workdir = Workdir::new("");
    for (name, stock) in parts {
        let job = format!(
            "Job(grid: Grid(min: (-12.5, -12.5), max: (12.5, 12.5), cells: (50, 50)), stock: {stock}, tools: {{}}, paths: [])"
        );
        fs::write(workdir.path(&format!("{name}.ron")), job).unwrap();
        let file = format!("{name}.ron");
        workdir.good(&["simulate", &file, "--only", "binary,tridexels,mesh", "--out", name]);
    }
    workdir
}

fn compared(workdir: &Workdir, part: &str, target: &str) -> ComparisonReport {
    let more = ["--cells", "50x50", "--out", "cmp", "--size", "60x40", "--json"];
    let json = workdir.good(&[&["compare", part, target][..], &more].concat());
    serde_json::from_str(&json).unwrap()
}

/// Compares forms of a part with forms of its target: without dexels along z the deviation is found, with them it is in
/// the interval.
fn forms_tell(workdir: &Workdir, part: &str, target: &str, size: f64, off: f64) {
    // For a part beside itself, two pairs of files are enough.
    let pairs: &[[usize; 2]] = if part == target {
        &[[0, 2], [1, 1]]
    } else {
        &[[0, 0], [0, 2], [1, 1], [1, 2], [2, 2]]
    };

    for &[i, j] in pairs {
        let (form, other) = (FORMS[i], FORMS[j]);
        let report = compared(workdir, &format!("{part}/{form}"), &format!("{target}/{other}"));
        for SurfaceDeviation { largest, place, .. } in [&report.of_part, &report.of_target].map(Clone::clone) {
            let [least, most] = largest;
            let here = format!("{part}/{form} {target}/{other}: {largest:?} at {place:?}");
            assert!(least <= size + off && size - off <= most, "{here}");
            if i > 0 && j > 0 {
                assert!(least == most && (least - size).abs() <= off, "{here}");
            }
            assert_eq!(place.is_some(), most > 0.0, "{here}");
        }
        // The part lacks something; nothing stands out for certain.
        assert!((report.gouge.max - size).abs() <= off || i * j == 0, "{report:?}");
        assert!(report.excess.max <= off, "{report:?}");
    }
}

fn without(height: u8, cut: &str) -> String {
    format!("Difference(Block(min: (-12.1, -12.1, 0), max: (12.1, 12.1, {height})), [{cut}])")
}

#[test]
fn a_slot_and_itself() {
    let slot = |depth: f64| {
        without(
            12,
            &format!("Block(min: (-20, -4.1, {}), max: (20, 4.1, 20))", 12.0 - depth),
        )
    };
    let workdir = simulated(&[("deep", slot(5.0)), ("shallow", slot(4.9))]);
    forms_tell(&workdir, "deep", "shallow", 0.1, 1e-6);
    forms_tell(&workdir, "deep", "deep", 0.0, 1e-6);
    let said = |part: &str| {
        let part = format!("deep/{part}");
        workdir.good(&["compare", &part, "shallow/part.ply", "--out", "cmp", "--size", "60x40"])
    };
    let words = said("part.tridexels");
    assert!(words.contains("part  largest distance 0.1000"), "{words}");
    assert!(!words.contains('['), "{words}");
    // Nothing stands out, in volume neither.
    assert!(words.contains("excess  0 mm³, nothing beyond the tolerance"), "{words}");
    // The floor is certain, the walls are not.
    let words = said("part.dexels");
    assert!(
        words.contains("largest distance [0.1000") && words.contains("[a, b] is between a and b"),
        "{words}"
    );
}

#[test]
fn a_hole_too_wide() {
    let hole = |radius: f64| {
        let cylinder = format!("Cylinder(base: (0.3, -0.2, -1), radius: {radius}, height: 20)");
        without(2, &cylinder)
    };
    let workdir = simulated(&[("wide", hole(10.0)), ("narrow", hole(9.9))]);
    forms_tell(&workdir, "wide", "narrow", 0.1, 0.005);
    forms_tell(&workdir, "wide", "wide", 0.0, 0.005);
}

#[test]
fn a_wall_moved() {
    let block = |side: f64| format!("Block(min: (-11.1, -9.3, 0), max: ({side}, 9.3, 5.1))");
    let workdir = simulated(&[("short", block(8.13)), ("long", block(8.15))]);
    forms_tell(&workdir, "short", "long", 0.02, 1e-6);
}

/// What the target has beside the part was seen by no line: its volume was less than it is, and no region was missing.
#[test]
fn what_is_missing_beside_the_part_is_found() {
    let block = |name: &str, side: f64| {
        let stock = format!("Block(min: ({side}, -10, 0), max: (10, 10, 5))");
        (name.to_owned(), stock)
    };
    let [short, long] = [block("short", -10.0), block("long", -12.5)];
    let workdir = simulated(&[(&short.0, short.1), (&long.0, long.1)]);
    let [short, long] = ["short/part.ply", "long/part.ply"];
    let missing = compared(&workdir, short, long);
    assert!((missing.target_volume - 2250.0).abs() < 1e-3, "{missing:?}");
    assert!((missing.missing_volume - 250.0).abs() < 50.0, "{missing:?}");
    assert_eq!(missing.regions.len(), 1, "{missing:?}");
    assert!(missing.warnings.is_empty(), "{missing:?}");
    // Where the grid was asked for, it is said.
    let more = [
        "--area",
        "-10,-10,10,10",
        "--cells",
        "50x50",
        "--out",
        "cmp",
        "--size",
        "60x40",
    ];
    let words = workdir.good(&[&["compare", short, long][..], &more].concat());
    let warning = "warning  the target reaches 2.5 mm beyond the grid: volumes and regions leave out what is there";
    assert!(words.contains(warning), "{words}");
}

/// An area alone has square cells, 300 along its longer side.
#[test]
fn an_area_needs_no_number_of_cells() {
    let block = "Block(min: (-10, -10, 0), max: (10, 10, 5))".to_owned();
    let workdir = simulated(&[("block", block)]);
    let more = ["--area", "-10,-5,10,5", "--out", "cmp", "--size", "60x40", "--json"];
    let json = workdir.good(&[&["compare", "block/part.ply", "block/part.ply"][..], &more].concat());
    let report: ComparisonReport = serde_json::from_str(&json).unwrap();
    assert_eq!(report.cells, [300, 150]);
}

/// Regions of a job may allow more than the rest of it.
#[test]
fn limits_of_a_job_are_said_to_be_those() {
    let block = |name: &str, height: u8| {
        let stock = format!("Block(min: (-10, -10, 0), max: (10, 10, {height}))");
        (name.to_owned(), stock)
    };
    let [low, high] = [block("low", 5), block("high", 6)];
    let workdir = simulated(&[(&low.0, low.1), (&high.0, high.1)]);
    let limits = "limits: Limits(gouge: 0.1, excess: 0.1, regions: [Region(within: Block(min: (-20, -20, -9), max: (20, 20, 9)), gouge: 2, excess: 2)])";
    let job = format!("Job(stock: Block(min: (0, 0, 0), max: (1, 1, 1)), tools: {{}}, paths: [], {limits})");
    fs::write(workdir.path("limits.ron"), job).unwrap();
    let more = ["--limits", "limits.ron", "--out", "cmp", "--size", "60x40"];
    let words = workdir.good(&[&["compare", "high/part.ply", "low/part.ply"][..], &more].concat());
    let expected = "0 regions beyond the limits of limits.ron: deeper than 0.10000 or higher than 0.10000 mm where no region of it says otherwise";
    assert!(words.contains(expected), "{words}");
}
