//! The guide to jobs (`docs/jobs.md`): every example is read, and every field has one.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use sweepsim_formats::{Job, write_dexels_file, write_stl};

const CUBE: [[[f64; 3]; 3]; 12] = {
    const P: [[f64; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [9.0, 0.0, 0.0],
        [9.0, 9.0, 0.0],
        [0.0, 9.0, 0.0],
        [0.0, 0.0, 9.0],
        [9.0, 0.0, 9.0],
        [9.0, 9.0, 9.0],
        [0.0, 9.0, 9.0],
    ];
    [
        [P[0], P[2], P[1]],
        [P[0], P[3], P[2]],
        [P[4], P[5], P[6]],
        [P[4], P[6], P[7]],
        [P[0], P[1], P[5]],
        [P[0], P[5], P[4]],
        [P[1], P[2], P[6]],
        [P[1], P[6], P[5]],
        [P[2], P[3], P[7]],
        [P[2], P[7], P[6]],
        [P[3], P[0], P[4]],
        [P[3], P[4], P[7]],
    ]
};

fn guide() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/jobs.md")).unwrap()
}

/// The blocks of a language.
fn blocks<'a>(guide: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let parts = guide.split(fence.as_str()).skip(1);
    parts.filter_map(|rest| rest.split("\n```").next()).collect()
}

/// A whole job from a block that may have some of its fields only.
fn whole(block: &str) -> String {
    if block.starts_with("Job(") {
        return block.to_owned();
    }
    let has = |name: &str| block.lines().any(|line| line.starts_with(&format!("{name}:")));
    let others = [
        ("grid", "grid: Grid(min: (0, 0), max: (60, 40), cells: (30, 20)),"),
        ("stock", "stock: Block(min: (0, 0, 0), max: (60, 40, 20)),"),
        ("tools", "tools: { 1: Ball(radius: 3, length: 30) },"),
        ("paths", "paths: [],"),
    ];
    let missing: Vec<&str> = others
        .iter()
        .filter(|(name, _)| !(has(name) || *name == "paths" && has("setups")))
        .map(|(_, text)| *text)
        .collect();
    format!("Job(\n{}\n{block}\n)", missing.join("\n"))
}

#[test]
fn every_example_is_read() {
    let guide = guide();
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["stock.stl", "part.stl", "clamp.stl"] {
        let mut stl = Vec::new();
        write_stl(&CUBE, &mut stl).unwrap();
        fs::write(path(name), stl).unwrap();
    }
    // A cube, whose bottom is orange.
    let corners = [
        [0, 0, 0],
        [60, 0, 0],
        [60, 40, 0],
        [0, 40, 0],
        [0, 0, 20],
        [60, 0, 20],
        [60, 40, 20],
        [0, 40, 20],
    ];
    let faces = [
        "0 3 2 1 255 128 0",
        "4 5 6 7 9 9 9",
        "0 1 5 4 9 9 9",
        "1 2 6 5 9 9 9",
        "2 3 7 6 9 9 9",
        "3 0 4 7 9 9 9",
    ];
    let mut ply = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n\
        property list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
        .to_owned();
    corners.iter().for_each(|[x, y, z]| ply += &format!("{x} {y} {z}\n"));
    faces.iter().for_each(|face| ply += &format!("4 {face}\n"));
    fs::write(path("part.ply"), ply).unwrap();
    fs::write(path("finish.csv"), blocks(&guide, "csv")[0]).unwrap();
    fs::write(path("roughing.nc"), blocks(&guide, "gcode")[0]).unwrap();
    fs::write(path("tools.json"), blocks(&guide, "json")[0]).unwrap();
    fs::write(path("five-axis.nc"), "G0 X0 Y0 Z5 A0 C0\nG1 X10 A30 C45 F200\n").unwrap();
    let examples = blocks(&guide, "ron");
    let one = |begin: &str| {
        let found: Vec<&&str> = examples.iter().filter(|block| block.starts_with(begin)).collect();
        assert_eq!(found.len(), 1, "{begin}");
        *found[0]
    };
    fs::write(path("sweep.ron"), one("Motion(")).unwrap();
    fs::write(path("cutter.ron"), one("Surfaces(")).unwrap();
    let plain = Job::parse(&whole(""), &path("job.ron")).unwrap();
    fs::create_dir_all(path("out/roughing")).unwrap();
    write_dexels_file(
        &plain.stock.dexels(&plain.grid).unwrap(),
        &path("out/roughing/part.dexels"),
    )
    .unwrap();
    let mut jobs = 0;
    for block in &examples {
        if block.starts_with("Motion(") || block.starts_with("Surfaces(") {
            continue;
        }
        let job = Job::parse(&whole(block), &path("job.ron"));
        let job = job.unwrap_or_else(|error| panic!("{block}\n{}", error.render(false)));
        job.stock.dexels(&job.grid).unwrap();
        jobs += 1;
    }
    assert!(jobs >= 20, "{jobs}");
}

/// The names of fields and variants in the schemas of jobs, of motions, and of tools of surfaces.
fn names() -> BTreeSet<String> {
    let schemas = [
        include_str!("../../src/jobs/schema.rs"),
        include_str!("../../src/jobs/tools/surface_tool.rs"),
    ];
    let word = |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !text.is_empty();
    let mut names = BTreeSet::new();
    for block in schemas.iter().flat_map(|schema| schema.split("Deserialize)]").skip(1)) {
        let body = block
            .split_once('{')
            .and_then(|(_, rest)| rest.split("\n}").next())
            .unwrap_or_default();
        let mut renamed = None;
        for line in body.lines().map(str::trim) {
            if let Some(name) = line.strip_prefix("#[serde(rename = \"") {
                renamed = name.split('"').next().map(str::to_owned);
                continue;
            }
            let line = line.strip_prefix("pub ").unwrap_or(line);
            let name = line.split([':', ',', '(', ' ']).next().unwrap_or_default();
            let known = word(name) && !line.starts_with("//") && line.len() > name.len();
            if known {
                names.insert(renamed.take().unwrap_or_else(|| name.to_owned()));
            }
        }
    }
    names
}

#[test]
fn every_field_has_an_example() {
    let guide = guide();
    let text = blocks(&guide, "ron").join("\n");
    let words: BTreeSet<&str> = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).collect();
    let names = names();
    assert!(names.len() > 80, "{names:?}");
    for known in [
        "arc_tolerance",
        "tip_control",
        "Lollipop",
        "turns",
        "AC",
        "degrees",
        "excess",
    ] {
        assert!(names.contains(known), "{known}: {names:?}");
    }
    // `Mm` is the default, and described in the table of fields; `face` needs a STEP file, which nobody writes here.
    let missing: Vec<&String> = names
        .iter()
        .filter(|name| !words.contains(name.as_str()) && *name != "Mm" && *name != "face")
        .collect();
    assert!(missing.is_empty(), "no example has {missing:?}");
}
