//! `convert`, `compare` and `inspect` of meshes and dexels, and stock from an earlier run, as a process.

use crate::support::Workdir;
use std::fs;
use sweepsim_formats::{read_dexels_file, read_mesh_file};

const JOB: &str = r#"Job(
    grid: Grid(min: (0, 0), max: (20, 10), cells: (40, 20)),
    stock: Block(min: (0, 0, 0), max: (20, 10, 6)),
    tools: { 1: Ball(radius: 2, length: 30) },
    paths: [Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0.5, 0, 1))])],
)"#;

/// A folder with `job.ron` and the results of `simulate` in `out`.
fn simulated() -> Workdir {
    let workdir = Workdir::new(JOB);
    workdir.good(&["simulate", "job.ron", "--out", "out", "--only", "dexels,binary"]);
    workdir
}

#[test]
fn dexels_go_around_all_formats() {
    let workdir = simulated();
    let first = read_dexels_file(&workdir.path("out/part.dexels"), None).unwrap();
    assert!(first.count() > 700 && first.volume() < 1200.0);
    workdir.good(&["convert", "out/part.dexels", "a.npz"]);
    workdir.good(&["convert", "a.npz", "b.dexels"]);
    assert_eq!(read_dexels_file(&workdir.path("b.dexels"), None).unwrap(), first);
    workdir.good(&["convert", "b.dexels", "c.csv"]);
    let table = |name: &str| fs::read_to_string(workdir.path(name)).unwrap();
    assert_eq!(table("c.csv"), table("out/dexels.csv"));
    // A table needs a grid: of the job, of other dexels, or by numbers.
    assert!(workdir.bad(&["convert", "c.csv", "d.npz"]).contains("expected --grid"));
    for grid in [
        &["--grid", "job.ron"][..],
        &["--grid", "a.npz"],
        &["--area", "0,0,20,10", "--cells", "40x20"],
    ] {
        workdir.good(&[&["convert", "c.csv", "d.npz"], grid].concat());
        let back = read_dexels_file(&workdir.path("d.npz"), None).unwrap();
        assert_eq!((back.grid(), back.volume()), (first.grid(), first.volume()));
    }
    let wrong = workdir.bad(&["convert", "c.csv", "d.npz", "--area", "0,0,20,10", "--cells", "4x4"]);
    assert!(wrong.contains("on the grid of 4 x 4"), "{wrong}");
    workdir.good(&["convert", "b.dexels", "lines.vtu"]);
    assert!(fs::read(workdir.path("lines.vtu")).unwrap().starts_with(b"<?xml"));
    let seen = workdir.good(&["inspect", "b.dexels"]);
    assert!(seen.contains("40 × 20 dexels") && seen.contains("volume"), "{seen}");
    assert!(workdir.good(&["inspect", "a.npz"]).contains("ends"));
}

#[test]
fn meshes_go_around_all_formats() {
    let workdir = simulated();
    let mut before = "out/part.dexels".to_owned();
    // The surface is that of the dexels, except for rounded edges.
    let volume = read_dexels_file(&workdir.path(&before), None).unwrap().volume();
    let near = |found: f64| (found - volume).abs() < 0.01 * volume;
    for name in ["m.ply", "m.vtp", "m.3mf", "m.glb", "m.stl", "n.ply"] {
        workdir.good(&["convert", &before, name]);
        let mesh = read_mesh_file(&workdir.path(name)).unwrap();
        assert!(mesh.triangles.len() > 1000);
        let soup = mesh.soup().unwrap();
        soup.check_closed().unwrap();
        assert!(near(soup.volume()), "{name}: {}", soup.volume());
        let seen = workdir.good(&["inspect", name]);
        assert!(seen.contains("closed  yes"), "{name}: {seen}");
        before = name.to_owned();
    }
    // And back to dexels: on the mesh's own area, or another.
    workdir.good(&["convert", "n.ply", "n.dexels", "--cells", "40x20"]);
    let dexels = read_dexels_file(&workdir.path("n.dexels"), None).unwrap();
    assert_eq!(dexels.grid().cells(), [40, 20]);
    assert!(near(dexels.volume()), "{}", dexels.volume());
    workdir.good(&[
        "convert",
        "n.ply",
        "n.png",
        "--size",
        "80x60",
        "--section",
        "y=5",
        "--camera",
        "top,orthographic",
    ]);
    assert!(fs::read(workdir.path("n.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn paths_become_tables() {
    let workdir = simulated();
    fs::write(
        workdir.path("p.ngc"),
        "G21 G90 G17\nT1 M6\nG0 X0 Y0 Z5\nG1 X10 F100\nG1 Y4\nM2\n",
    )
    .unwrap();
    workdir.good(&["convert", "p.ngc", "p.csv"]);
    let table = fs::read_to_string(workdir.path("p.csv")).unwrap();
    assert!(
        table.starts_with("x,y,z,i,j,k") && table.lines().count() >= 3,
        "{table}"
    );
    assert!(
        workdir
            .bad(&["convert", "p.ngc", "p.stl"])
            .contains("programs can be written as G-code (.nc, .ngc, .tap, .mpf, .h), CLSF (.cls, .apt), tables (.csv) and text (.txt)")
    );
}

#[test]
fn what_cannot_be_converted_is_said() {
    let workdir = simulated();
    fs::write(workdir.path("text.stl"), "no mesh").unwrap();
    fs::write(
        workdir.path("cut.dexels"),
        &fs::read(workdir.path("out/part.dexels")).unwrap()[..900],
    )
    .unwrap();
    for (arguments, message) in [
        (["convert", "job.ron", "x.ply"], "jobs cannot be converted"),
        (["convert", "text.stl", "x.ply"], "this is not an STL file"),
        (["convert", "cut.dexels", "x.ply"], "truncated"),
        (["convert", "none.npz", "x.ply"], "cannot read this file"),
        (["convert", "out/part.dexels", "x.step"], "unknown extension"),
        (["convert", "out/part.dexels", "x"], "unknown extension"),
        (["convert", "x.vtu", "x.ply"], "cannot read this file"),
    ] {
        let found = workdir.bad(&arguments);
        assert!(found.contains(message), "{arguments:?}: {found}");
    }
    let nowhere = workdir.bad(&["convert", "out/part.dexels", "x.png", "--section", "z=60"]);
    assert!(nowhere.contains("does not meet the part"), "{nowhere}");
    for name in ["x.ply", "x.step", "x", "x.png"] {
        assert!(!workdir.path(name).exists(), "{name}");
    }
}

/// A slot in a block, a web that is missing, holes of two radii: the worst is the worst, and nothing drops out.
#[test]
fn comparison_tells_the_worst() {
    let job = |stock: &str, cells: usize| {
        format!(
            "Job(grid: Grid(min: (-12.5, -12.5), max: (12.5, 12.5), cells: ({cells}, {cells})), stock: {stock}, tools: {{}}, paths: [])"
        )
    };
    let less =
        |height: u8, parts: &str| format!("Difference(Block(min: (-12, -12, 0), max: (12, 12, {height})), [{parts}])");
    let hole = |radius: f64| {
        less(
            2,
            &format!("Cylinder(base: (0.3, -0.2, -1), radius: {radius}, height: 20)"),
        )
    };
    let web = "Block(min: (-8, -8, 7), max: (8, 8, 20)), Block(min: (-8, -8, -5), max: (8, 8, 5))";
    let solids = [
        ("block", less(12, ""), 41),
        ("slot", less(12, "Block(min: (-20, -4, 7), max: (20, 4, 20))"), 41),
        ("web", less(12, web), 41),
        ("through", less(12, "Block(min: (-8, -8, -5), max: (8, 8, 20))"), 41),
        ("wide", hole(10.0), 161),
        ("narrow", hole(9.9), 161),
    ];
    let workdir = Workdir::new("");
    for (name, stock, cells) in &solids {
        fs::write(workdir.path(&format!("{name}.ron")), job(stock, *cells)).unwrap();
        workdir.good(&["simulate", &format!("{name}.ron"), "--only", "mesh", "--out", name]);
    }
    let compared = |part: &str, target: &str| -> [f64; 2] {
        let [part, target] = [part, target].map(|name| format!("{name}/part.ply"));
        let json = workdir.good(&[
            "compare", &part, &target, "--out", "cmp", "--cells", "60x60", "--size", "60x40", "--json",
        ]);
        let report: serde_json::Value = serde_json::from_str(&json).unwrap();
        ["gouge", "excess"].map(|side| report[side]["max"].as_f64().unwrap())
    };
    let cases = [
        ("slot", "block", [5.0, 0.0]),
        ("block", "slot", [0.0, 5.0]),
        ("block", "block", [0.0, 0.0]),
        ("through", "web", [2.0, 0.0]),
        ("wide", "narrow", [0.1, 0.0]),
        ("narrow", "wide", [0.0, 0.1]),
    ];
    for (part, target, expected) in cases {
        let found = compared(part, target);
        for k in 0..2 {
            assert!((found[k] - expected[k]).abs() < 1e-3, "{part} {target}: {found:?}");
        }
    }
}

#[test]
fn comparison_finds_what_was_cut() {
    let workdir = simulated();
    let job = JOB.replace(
        "paths: [Path(tool: 1, poses: [((-4, 5, 3), (0, 0, 1)), ((24, 5, 3), (0.5, 0, 1))])]",
        "paths: []",
    );
    fs::write(workdir.path("block.ron"), job).unwrap();
    workdir.good(&["simulate", "block.ron", "--out", "block", "--only", "binary,mesh"]);
    let compared = |target: &str| -> serde_json::Value {
        let json = workdir.good(&[
            "compare",
            "out/part.dexels",
            target,
            "--out",
            "cmp",
            "--size",
            "100x80",
            "--json",
        ]);
        serde_json::from_str(&json).unwrap()
    };
    // The same with dexels and with a mesh as target.
    for target in ["block/part.dexels", "block/part.ply"] {
        let report = compared(target);
        let number = |name: &str| report[name].as_f64().unwrap();
        let pair = |way: &str, name: &str| [0, 1].map(|k| report[way][name][k].as_f64().unwrap());
        assert!((number("target_volume") - 1200.0).abs() < 1e-9, "{target}");
        let missing = number("missing_volume");
        assert!((missing - (1200.0 - number("volume"))).abs() < 1e-9 && number("excess_volume") < 1e-9);
        assert!(missing > 150.0, "{missing}");
        // The groove is 3 deep, and nothing stands out.
        // The floor is 3 below the top of the block; its middle is 2 from the walls of the groove, wherever they are.
        let [least, most] = pair("of_part", "largest");
        assert!(
            (2.7..3.01).contains(&least) && least <= most && most < 3.6,
            "{least} {most}"
        );
        let [least, most] = pair("of_target", "largest");
        assert!(
            (1.4..=2.01).contains(&least) && (1.99..2.6).contains(&most),
            "{least} {most}"
        );
        assert_eq!(report["excess"]["count"], 0);
        assert!((report["gouge"]["max"].as_f64().unwrap() - 3.0).abs() < 0.31);
        let area: f64 = report["histogram"]
            .as_array()
            .unwrap()
            .iter()
            .map(|bar| bar["area"].as_f64().unwrap())
            .sum();
        assert!((area - report["of_part"]["area"].as_f64().unwrap()).abs() < 1e-6 * area);
    }
    for name in ["comparison.png", "comparison.json"] {
        assert!(workdir.path("cmp").join(name).exists());
    }
    let same = workdir.good(&[
        "compare",
        "out/dexels.csv",
        "out/part.dexels",
        "--out",
        "cmp",
        "--size",
        "60x40",
    ]);
    assert!(
        same.contains("part  largest distance [0, ") && same.contains("[a, b] is between a and b"),
        "{same}"
    );
    assert!(
        workdir
            .bad(&["compare", "job.ron", "out/part.dexels"])
            .contains("expected a mesh")
    );
}

#[test]
fn later_runs_begin_with_earlier_ones() {
    let workdir = simulated();
    let job = |stock: &str| JOB.replace("Block(min: (0, 0, 0), max: (20, 10, 6))", stock);
    let volume = |stock: &str| -> f64 {
        fs::write(workdir.path("later.ron"), job(stock)).unwrap();
        let json = workdir.good(&["simulate", "later.ron", "--out", "later", "--only", "binary", "--json"]);
        let report: serde_json::Value = serde_json::from_str(&json).unwrap();
        report["volume"].as_f64().unwrap()
    };
    let left = read_dexels_file(&workdir.path("out/part.dexels"), None)
        .unwrap()
        .volume();
    for earlier in ["out/part.dexels", "out/dexels.csv"] {
        // The same path again finds nothing more to cut.
        assert!((volume(&format!("Dexels(\"{earlier}\")")) - left).abs() < 1e-9);
    }
    // A block on top, where the tool does not come, and a corner off.
    let part = "Union([Dexels(\"out/part.dexels\"), Block(min: (0, 0, 6), max: (20, 2, 8))])";
    assert!((volume(part) - left - 80.0).abs() < 1e-9);
    let part = "Difference(Dexels(\"out/part.dexels\"), [Block(min: (-1, -1, -1), max: (2, 2, 1))])";
    assert!((volume(part) - left + 4.0).abs() < 1e-9);
    let part = "Intersection([Dexels(\"out/part.dexels\"), Ball(centre: (10, 5, -100), radius: 101)])";
    assert!(volume(part) < 0.3 * left);
    for (stock, message) in [
        (
            "Dexels(\"none.dexels\")",
            "later.ron:3:12: cannot read the stock file none.dexels",
        ),
        (
            "Union([Dexels(\"later.ron\")])",
            "later.ron: the extension of this dexel file is .ron",
        ),
        (
            "Union([Ball(centre: (0, 0, 0), radius: -1)])",
            "later.ron:3:51: radius is -1",
        ),
        (
            "Difference(Ball(centre: (0, 0, NaN), radius: 1), [])",
            "later.ron:3:43: centre is NaN",
        ),
    ] {
        fs::write(workdir.path("later.ron"), job(stock)).unwrap();
        let found = workdir.bad(&["inspect", "later.ron"]);
        let plain: String = found
            .split('\u{1b}')
            .enumerate()
            .map(|(k, part)| {
                if k == 0 {
                    part
                } else {
                    part.split_once('m').map_or("", |p| p.1)
                }
            })
            .collect();
        let (place_of, what) = message.split_once(": ").unwrap();
        assert!(plain.contains(what) && plain.contains(place_of), "{stock}: {plain}");
    }
    let other = job("Dexels(\"out/part.dexels\")").replace("cells: (40, 20)", "cells: (41, 20)");
    fs::write(workdir.path("later.ron"), other).unwrap();
    let found = workdir.bad(&["simulate", "later.ron", "--out", "later"]);
    assert!(found.contains("40 x 20 dexels from (0, 0) to (20, 10) mm"), "{found}");
}
