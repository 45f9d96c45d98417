//! Dexels along other directions than z, and meshes of dexels along all three, as a process.

use crate::support::Workdir;
use std::fs;
use sweepsim_dexel::Dexels;
use sweepsim_formats::{read_dexels_file, read_mesh_file, read_tri_dexels_file};

/// A groove 4 wide and 3.1 deep, whose walls lie between lines: lines are half a millimetre apart.
const JOB: &str = r#"Job(
    grid: Grid(min: (-1, -1), max: (21, 11), cells: (44, 24)),
    stock: Block(min: (0, 0, 0), max: (20, 10, 6)),
    tools: { 1: Flat(radius: 2, length: 30) },
    paths: [Path(tool: 1, poses: [((-4, 5.13, 2.9), (0, 0, 1)), ((24, 5.13, 2.9), (0, 0, 1))])],
)"#;
const GRID: &str = "Grid(min: (-1, -1), max: (21, 11), cells: (44, 24))";
const STOCK: &str = "Block(min: (0, 0, 0), max: (20, 10, 6))";
const REMOVED: f64 = 20.0 * 4.0 * 3.1;

/// Runs `simulate` into a folder; what it prints on standard error, if it fails.
fn simulate(workdir: &Workdir, out: &str, more: &[&str]) -> Result<(), String> {
    let arguments = [&["simulate", "job.ron", "--out", out], more].concat();
    let output = workdir.run(&arguments);
    if output.status.success() {
        return Ok(());
    }
    assert_eq!(output.status.code(), Some(2));
    assert!(!workdir.path(out).exists(), "nothing is left behind");
    Err(String::from_utf8_lossy(&output.stderr).into_owned())
}

fn volume(workdir: &Workdir, mesh: &str) -> f64 {
    let soup = read_mesh_file(&workdir.path(mesh)).unwrap().soup().unwrap();
    soup.check_closed().unwrap();
    soup.volume()
}

#[test]
fn walls_between_lines_are_where_they_are() {
    let workdir = Workdir::new(JOB);
    simulate(&workdir, "z", &["--directions", "z", "--only", "dexels,mesh"]).unwrap();
    simulate(&workdir, "tri", &["--only", "dexels,mesh,picture"]).unwrap();
    let dexels = |out: &str| fs::read(workdir.path(&format!("{out}/dexels.csv"))).unwrap();
    assert_eq!(dexels("z"), dexels("tri"));
    let exact = 20.0 * 10.0 * 6.0 - REMOVED;
    let off = (volume(&workdir, "tri/part.ply") - exact).abs();
    assert!(off < 1e-3 * exact, "{off}");
    // Along z a wall is known to half the distance of lines; along y to where the line meets it, and its plane as well
    // as normals are kept, to 6.5e-5.
    for (mesh, least, most) in [("z/part.ply", 0.1, 0.25), ("tri/part.ply", 0.0, 1e-4)] {
        let mesh = read_mesh_file(&workdir.path(mesh)).unwrap();
        let faces = mesh.vertices.iter().zip(&mesh.normals);
        let wall = faces.filter(|(v, n)| (v[1] - 5.13).abs() < 3.0 && n[1].abs() > 0.99);
        let off: Vec<f64> = wall.map(|(v, _)| ((v[1] - 5.13).abs() - 2.0).abs()).collect();
        assert!(
            off.len() > 40 && off.iter().all(|d| (least..=most).contains(d)),
            "{off:?}"
        );
    }
    assert!(fs::read(workdir.path("tri/part.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_swept_volume_along_three_axes_needs_no_stock() {
    let workdir = Workdir::new(JOB);
    let arguments = ["sweep", "job.ron", "--out", "out", "--only", "mesh"];
    assert!(workdir.run(&arguments).status.success());
    // The box of the lines cuts it off: 22 along x.
    let (volume, exact) = (volume(&workdir, "out/part.ply"), 22.0 * 4.0 * 30.0);
    assert!((volume - exact).abs() < 1e-2 * exact, "{volume}");
}

#[test]
fn dexels_stand_along_the_frame() {
    // Lines along x, seen from the right: their x is the world's y, their y its z.
    let frame = "Grid(min: (-1, -1), max: (11, 7), cells: (24, 16), frame: Frame(origin: (0, 0, 0), z: (1, 0, 0), x: (0, 1, 0)))";
    let workdir = Workdir::new(&JOB.replace(GRID, frame));
    simulate(&workdir, "out", &["--only", "dexels,mesh,binary"]).unwrap();
    let dexels = read_dexels_file(&workdir.path("out/part.dexels"), None).unwrap();
    assert_eq!(dexels.grid().frame().axes()[2], [1.0, 0.0, 0.0]);
    for (index, line) in dexels.iter() {
        let (i, j) = dexels.grid().place(index);
        let (y, z) = (dexels.grid().x(i), dexels.grid().y(j));
        assert!(line.iter().all(|piece| (piece.lower.z, piece.upper.z) == (0.0, 20.0)));
        assert!((y - 5.13).abs() > 2.0 || z < 2.9);
    }
    // Half a millimetre of lines, 20 long.
    let exact = 20.0 * 10.0 * 6.0 - REMOVED;
    assert!((dexels.volume() - exact).abs() < 0.05 * exact);
    for file in ["job.ron", "out/part.dexels"] {
        let said = String::from_utf8(workdir.run(&["inspect", file]).stdout).unwrap();
        assert!(
            said.contains("frame  origin (0, 0, 0), dexels along (1.0000, 0, 0)"),
            "{said}"
        );
    }
    let mesh = read_mesh_file(&workdir.path("out/part.ply")).unwrap();
    let most = [0, 1, 2].map(|k| mesh.vertices.iter().map(|v| v[k]).fold(f64::MIN, f64::max));
    assert!(
        (most[0] - 20.0).abs() < 1e-9 && (most[1] - 10.0).abs() < 0.3 && (most[2] - 6.0).abs() < 0.3,
        "{most:?}"
    );
    // A later job goes on where this one ended, on the same grid only.
    let later = JOB.replace(STOCK, "Dexels(\"out/part.dexels\")");
    fs::write(workdir.path("job.ron"), later.replace(GRID, frame)).unwrap();
    simulate(&workdir, "again", &["--only", "dexels"]).unwrap();
    let table = |out: &str| fs::read(workdir.path(&format!("{out}/dexels.csv"))).unwrap();
    assert_eq!(table("out"), table("again"));
    fs::write(workdir.path("job.ron"), later).unwrap();
    let message = simulate(&workdir, "other", &[]).unwrap_err();
    assert!(message.contains("in a frame"), "{message}");
}

#[test]
fn what_has_no_three_axes_is_said() {
    let framed = GRID.replace(
        "cells: (44, 24)",
        "cells: (44, 24), frame: Frame(z: (1, 0, 0), x: (0, 1, 0))",
    );
    let workdir = Workdir::new(&JOB.replace(GRID, &framed));
    let message = simulate(&workdir, "out", &["--directions", "xyz"]).unwrap_err();
    assert!(
        message.contains("--directions xyz: expected a grid without a frame"),
        "{message}"
    );
    // Unless asked for, they are left out, and that is said.
    let report = |out: &str| fs::read_to_string(workdir.path(&format!("{out}/report.json"))).unwrap();
    simulate(&workdir, "framed", &["--only", "mesh,report"]).unwrap();
    let words = "mesh and picture are made of dexels along z only: x and y would need a grid without a frame";
    assert!(report("framed").contains(words), "{}", report("framed"));
    let bad = framed.replace("x: (0, 1, 0)", "x: (2, 0, 0)");
    fs::write(workdir.path("job.ron"), JOB.replace(GRID, &bad)).unwrap();
    let message = simulate(&workdir, "out", &[]).unwrap_err();
    assert!(
        message.contains("job.ron:2:") && message.contains("parallel"),
        "{message}"
    );
    fs::write(workdir.path("job.ron"), JOB).unwrap();
    simulate(&workdir, "first", &["--only", "binary"]).unwrap();
    fs::write(
        workdir.path("job.ron"),
        JOB.replace(STOCK, "Union([Dexels(\"first/part.dexels\")])"),
    )
    .unwrap();
    let message = simulate(&workdir, "out", &["--directions", "xyz"]).unwrap_err();
    assert!(
        message.contains("--directions xyz: expected a stock without dexels"),
        "{message}"
    );
    simulate(&workdir, "again", &["--only", "mesh,report"]).unwrap();
    assert!(report("again").contains("dexels along z only: x and y would need a stock without dexels"));
    // A needle: a thousand times as tall as its dexels are apart.
    let needle = r#"Job(
        grid: Grid(min: (0, 0), max: (0.4, 0.4), cells: (8, 8)),
        stock: Block(min: (0, 0, 0), max: (0.4, 0.4, 50)),
        tools: { 1: Flat(radius: 2, length: 30) },
        paths: [Path(tool: 1, poses: [((-4, 0, 49.9), (0, 0, 1)), ((4, 0, 49.9), (0, 0, 1))])],
    )"#;
    fs::write(workdir.path("job.ron"), needle).unwrap();
    simulate(&workdir, "needle", &["--only", "mesh,report"]).unwrap();
    assert!(report("needle").contains("must be asked for"), "{}", report("needle"));
    simulate(&workdir, "asked", &["--only", "mesh,report", "--directions", "xyz"]).unwrap();
    assert!(!report("asked").contains("along z only"));
}

/// A second groove, across the first, in a later job.
const LATER: &str = "((10.17, -4, 1.7), (0, 0, 1)), ((10.17, 14, 1.7), (0, 0, 1))";
const FIRST: &str = "((-4, 5.13, 2.9), (0, 0, 1)), ((24, 5.13, 2.9), (0, 0, 1))";

#[test]
fn a_later_run_goes_on_with_sharp_walls() {
    let both = JOB.replace(FIRST, &format!("{FIRST}]), Path(tool: 1, poses: [{LATER}"));
    let workdir = Workdir::new(&both);
    let only = ["--only", "tridexels,dexels,mesh,picture", "--size", "320x240"];
    simulate(&workdir, "whole", &only).unwrap();
    fs::write(workdir.path("job.ron"), JOB).unwrap();
    simulate(&workdir, "first", &only).unwrap();
    let stock = JOB.replace(STOCK, "Dexels(\"first/part.tridexels\")");
    fs::write(workdir.path("job.ron"), stock.replace(FIRST, LATER)).unwrap();
    simulate(&workdir, "second", &only).unwrap();
    let read = |out: &str, file: &str| fs::read(workdir.path(&format!("{out}/{file}"))).unwrap();
    for file in ["dexels.csv", "part.png"] {
        assert!(read("whole", file) == read("second", file), "{file}");
    }
    let solid = |out: &str| read_tri_dexels_file(&workdir.path(&format!("{out}/part.tridexels"))).unwrap();
    // The same heights; sources count paths anew.
    for (whole, second) in solid("whole").sets().iter().zip(solid("second").sets()) {
        assert_eq!(whole.grid(), second.grid());
        let ends = |set: &Dexels| -> Vec<[f64; 2]> { set.iter().flat_map(|(_, line)| line.heights()).collect() };
        assert_eq!(ends(whole), ends(second));
    }
    // 3.1 and 4.3 deep, where they cross the deeper.
    let exact = 1200.0 - REMOVED - 10.0 * 4.0 * 4.3 + 4.0 * 4.0 * 3.1;
    let off = (volume(&workdir, "second/part.ply") - exact).abs();
    assert!(off < 1e-3 * exact, "{off}");
    // An earlier run along z only cannot go on so.
    fs::write(workdir.path("job.ron"), JOB).unwrap();
    simulate(&workdir, "z", &["--only", "binary"]).unwrap();
    let stock = JOB.replace(STOCK, "Dexels(\"z/part.dexels\")");
    fs::write(workdir.path("job.ron"), &stock).unwrap();
    let message = simulate(&workdir, "none", &["--only", "tridexels"]).unwrap_err();
    assert!(
        message.contains("--only tridexels: expected a stock without dexels of an earlier run along z only"),
        "{message}"
    );
    let higher = "Union([Dexels(\"first/part.tridexels\"), Block(min: (0, 0, 5), max: (3, 3, 12))])";
    fs::write(workdir.path("job.ron"), JOB.replace(STOCK, higher)).unwrap();
    let message = simulate(&workdir, "none", &["--only", "tridexels"]).unwrap_err();
    assert!(message.contains("no lower or higher than the box"), "{message}");
    // Its mesh is made along z, and says so.
    simulate(&workdir, "higher", &["--only", "mesh,report"]).unwrap();
    assert!(
        String::from_utf8(read("higher", "report.json"))
            .unwrap()
            .contains("no lower or higher than the box")
    );
    let message = simulate(&workdir, "none", &["--only", "tridexels", "--directions", "z"]).unwrap_err();
    assert!(message.contains("expected --directions xyz"), "{message}");
}

#[test]
fn dexels_along_three_axes_are_inspected_compared_and_converted() {
    let workdir = Workdir::new(JOB);
    simulate(&workdir, "out", &["--only", "tridexels,mesh"]).unwrap();
    let run = |arguments: &[&str]| {
        let output = workdir.run(arguments);
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout) + &text(output.stderr))
    };
    let (code, said) = run(&["inspect", "out/part.tridexels"]);
    assert!(
        code == Some(0) && said.contains("44 × 24 × ") && said.contains("along x"),
        "{said}"
    );
    // A wall moved by 0.1 along y, which no dexel along z can see.
    fs::write(workdir.path("job.ron"), JOB.replace("5.13", "5.23")).unwrap();
    simulate(&workdir, "moved", &["--only", "tridexels"]).unwrap();
    let (code, said) = run(&["compare", "moved/part.tridexels", "out/part.ply", "--out", "c"]);
    assert_eq!(code, Some(0), "{said}");
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(workdir.path("c/comparison.json")).unwrap()).unwrap();
    for side in ["gouge", "excess"] {
        let most = report[side]["max"].as_f64().unwrap();
        assert!((most - 0.1).abs() < 1e-3, "{side}: {most}");
    }
    // As along z, and as a mesh; a mesh as dexels along three axes; but not those along z.
    for out in ["a.dexels", "a.npz", "a.stl", "a.png", "a.3mf"] {
        let (code, said) = run(&["convert", "out/part.tridexels", out, "--size", "160x120"]);
        assert_eq!(code, Some(0), "{said}");
    }
    let along_z = read_dexels_file(&workdir.path("a.dexels"), None).unwrap();
    assert_eq!(
        &along_z,
        &read_tri_dexels_file(&workdir.path("out/part.tridexels"))
            .unwrap()
            .sets()[2]
    );
    let (code, said) = run(&["convert", "out/part.ply", "b.tridexels", "--cells", "40x20"]);
    assert!(code == Some(0) && said.contains("40 × 20 × "), "{said}");
    // Along z, a wall between lines may be off by half their distance.
    let back = read_tri_dexels_file(&workdir.path("b.tridexels")).unwrap();
    assert!((back.volume() - (1200.0 - REMOVED)).abs() < 10.0, "{}", back.volume());
    let (code, said) = run(&["convert", "a.dexels", "c.tridexels"]);
    assert!(code == Some(2) && said.contains("along z only"), "{said}");
    // Fewer triangles, from a run and from a file: a box with a groove has 16 corners.
    simulate(&workdir, "few", &["--only", "mesh", "--decimate", "0.01"]).unwrap();
    let (code, said) = run(&["convert", "moved/part.tridexels", "few.stl", "--decimate", "0.01"]);
    assert_eq!(code, Some(0), "{said}");
    for few in ["few/part.ply", "few.stl"] {
        let triangles = read_mesh_file(&workdir.path(few)).unwrap().triangles.len();
        assert!((28..100).contains(&triangles), "{few}: {triangles}");
        assert!((volume(&workdir, few) - (1200.0 - REMOVED)).abs() < 2.0);
    }
    let (code, said) = run(&["convert", "moved/part.tridexels", "all.stl", "--decimate", "1e-15"]);
    assert!(code == Some(0) && said.contains("all triangles are kept"), "{said}");
    let (code, said) = run(&["convert", "moved/part.tridexels", "few.stl", "--decimate", "0"]);
    assert!(code == Some(2) && said.contains("--decimate"), "{said}");
    // Damaged anywhere, it is refused.
    let whole = fs::read(workdir.path("out/part.tridexels")).unwrap();
    for at in (0..whole.len()).step_by(97).chain([8, 12, whole.len() - 1]) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        fs::write(workdir.path("d.tridexels"), bytes).unwrap();
        assert!(read_tri_dexels_file(&workdir.path("d.tridexels")).is_err(), "{at}");
    }
}
