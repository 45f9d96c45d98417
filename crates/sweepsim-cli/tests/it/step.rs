//! STEP files, as a process.

use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::read_mesh_file;

/// A tetrahedron in centimetres, as a STEP file: what is in it, and its triangles. A damaged one is an error.
#[test]
fn step_files_are_described_and_become_meshes() {
    let workdir = Workdir::new("");
    let text = tetrahedron();
    fs::write(workdir.path("part.step"), &text).unwrap();
    let seen = workdir.good(&["inspect", "part.step"]);
    for words in [
        "AUTOMOTIVE_DESIGN",
        "10 mm",
        "#60 tip: 4 planes, 166.67 mm³",
        "closed  yes",
        "4 faces",
    ] {
        assert!(seen.contains(words), "{words}: {seen}");
    }
    workdir.good(&["convert", "part.step", "part.stl"]);
    let soup = read_mesh_file(&workdir.path("part.stl")).unwrap().soup().unwrap();
    soup.check_closed().unwrap();
    assert!((soup.volume() - 1000.0 / 6.0).abs() < 1e-3);
    fs::write(
        workdir.path("bad.step"),
        text.replace("#60=MANIFOLD_SOLID_BREP('tip',#59)", "#60=MANIFOLD_SOLID_BREP('')"),
    )
    .unwrap();
    let told = workdir.bad(&["inspect", "bad.step"]);
    assert!(
        told.contains("the reader of STEP files failed at this one") && !told.contains("panicked"),
        "{told}"
    );
}

/// A part that is 0.2 mm too high on the slope of the tetrahedron, displaced: three-two-one by the other faces brings
/// it back, and the table says which face is off. Faces that do not exist are errors.
#[test]
fn deviations_are_told_by_face_after_three_two_one() {
    let workdir = Workdir::new("");
    fs::write(workdir.path("goal.step"), tetrahedron()).unwrap();
    // The slope of the part is 0.2 mm further out, the other faces are where they should be.
    let far = 10.0 + 0.2 * 3.0_f64.sqrt();
    let (sine, cosine) = 0.05_f64.sin_cos();
    let moved = |[x, y, z]: [f64; 3]| [cosine * x - sine * y + 0.4, sine * x + cosine * y - 0.3, z + 0.2];
    let corners = [[0.0; 3], [far, 0.0, 0.0], [0.0, far, 0.0], [0.0, 0.0, far]].map(moved);
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mut text = String::from("solid part\n");
    for face in faces {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face.map(|k: usize| corners[k]) {
            text += &format!("vertex {x:?} {y:?} {z:?}\n");
        }
        text += "endloop\nendfacet\n";
    }
    fs::write(workdir.path("part.stl"), text + "endsolid part\n").unwrap();
    let options = [
        "compare",
        "part.stl",
        "goal.step",
        "--cells",
        "40x40",
        "--size",
        "200x150",
        "--align",
    ];
    let told = workdir.good(&[&options[..], &["datum=#50,#51,#52", "--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&told).unwrap();
    let alignment = &report["alignment"];
    assert_eq!(alignment["datums"], serde_json::json!(["#50", "#51", "#52"]));
    // Coordinates of STL files have seven digits.
    assert!(alignment["rms"].as_f64() < Some(1e-6), "{alignment}");
    assert!(
        (alignment["angle"].as_f64().unwrap() - 0.05_f64.to_degrees()).abs() < 1e-5,
        "{alignment}"
    );
    for (face, excess) in [("#50", 0.0), ("#51", 0.0), ("#52", 0.0), ("#53", 0.2)] {
        let own = report["faces"]
            .as_array()
            .unwrap()
            .iter()
            .find(|own| own["face"] == face)
            .unwrap();
        assert_eq!(own["kind"], "plane");
        let number = |name: &str| own[name].as_f64().unwrap();
        // Beside an edge, the other face of the part is nearer.
        let is_near = |name: &str| number(name) <= excess + 2e-6 && number(name) >= 0.9 * excess - 2e-6;
        assert!(number("gouge") == 0.0 && is_near("mean") && is_near("rms"), "{own}");
        // On the others, the part reaches beyond the edges of the face.
        let most = if face == "#53" { 0.2 } else { 0.36 };
        assert!(
            number("excess") <= most + 2e-6 && number("excess") >= excess - 2e-6,
            "{own}"
        );
    }
    let region = &report["regions"][0];
    assert!(region["kind"] == "excess" && region["face"] == "#53", "{region}");
    let told = workdir.good(&[&options[..], &["datum=#50,#51,#52"]].concat());
    for words in [
        "aligned  by the faces #50, #51, #52",
        "on face #53",
        "face  #53 (plane): gouge 0, excess",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let told = workdir.good(&[&options[..], &["best"]].concat());
    assert!(told.contains("aligned  by best: turned by "), "{told}");
    for (how, words) in [
        (
            "datum=#50,#51,#54",
            "the target has no face #54: expected one like #50, #51, #52, #53",
        ),
        ("datum=#50,#51", "datum has 2 faces: expected three"),
        ("somehow", "expected best, features, or datum=FACE,FACE,FACE"),
    ] {
        let told = workdir.bad(&[&options[..], &[how]].concat());
        assert!(told.contains(words), "{words}: {told}");
    }
}

/// A hole that cuts too deep into a face of a STEP target.
const TIP: &str = "Job(
    name: \"tip\",
    grid: Grid(min: (-1, -1), max: (11, 11), cells: (24, 24)),
    stock: Block(min: (0, 0, 0), max: (10, 10, 10)),
    tools: { 1: Flat(radius: 1, length: 20) },
    paths: [Path(tool: 1, poses: [((3, 3, 12), (0, 0, 1)), ((3, 3, 3.5), (0, 0, 1))])],
    target: Mesh(\"tip.step\"),
    limits: Limits(gouge: 0.05, excess: 20),
)";

/// A program that cuts too deep into a face of a STEP target: the finding, the table and the page name the face.
#[test]
fn findings_of_verify_name_the_face() {
    // The slope is x + y + z = 10; a hole in it, level at 3.5 mm, is deepest below it where x + y is least: 6 − √2.
    let workdir = Workdir::new(TIP);
    fs::write(
        workdir.path("tip.step"),
        tetrahedron().replace("#53=ADVANCED_FACE(''", "#53=ADVANCED_FACE('slope'"),
    )
    .unwrap();
    let output = workdir.run_job("verify", &["--no-proof", "--only", "report", "--moments", "0"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let told = text(&output.stdout);
    assert!(
        told.contains(" on face slope") && told.contains("face  slope (plane): gouge "),
        "{told}"
    );
    let report: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(workdir.path("out/report.json")).unwrap()).unwrap();
    assert_eq!(report["findings"][0]["face"], "slope");
    assert_eq!(report["regions"][0]["face"], "slope");
    let face = report["faces"]
        .as_array()
        .unwrap()
        .iter()
        .find(|face| face["face"] == "slope")
        .unwrap();
    let most = (10.0 - (6.0 - 2.0_f64.sqrt()) - 3.5) / 3.0_f64.sqrt();
    let gouge = face["gouge"].as_f64().unwrap();
    assert!(gouge > most - 0.3 && gouge < most + 1e-6, "{gouge} of {most}");
    let page = fs::read_to_string(workdir.path("out/report.html")).unwrap();
    assert!(page.contains("Deviations by face of the target") && page.contains("<td>slope</td>"));
}

/// Deviations by face are those of the solid, where the program was judged on its lines, whatever is written.
#[test]
fn deviations_by_face_do_not_depend_on_outputs() {
    let workdir = Workdir::new(TIP);
    fs::write(workdir.path("tip.step"), tetrahedron()).unwrap();
    let faces = |directions: &str, outputs: &str| {
        let options = [
            "--no-proof",
            "--moments",
            "0",
            "--directions",
            directions,
            "--only",
            outputs,
        ];
        let output = workdir.run_job("verify", &options);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
        let report = fs::read_to_string(workdir.path("out/report.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&report).unwrap()["faces"].clone()
    };
    let of_solid = faces("xyz", "report,mesh");
    assert!(of_solid.as_array().is_some_and(|faces| faces.len() == 4), "{of_solid}");
    assert_eq!(faces("xyz", "report"), of_solid);
    let of_lines = faces("z", "report");
    assert_ne!(of_lines, of_solid, "those of the lines along z");
    // Of the walls x = 0 and y = 0, lines along z know nothing; of the slope, a part that is not beside its edges.
    let area = |faces: &serde_json::Value, name: &str| {
        let mut all = faces.as_array().unwrap().iter();
        all.find(|face| face["face"] == name).unwrap()["area"].as_f64().unwrap()
    };
    for wall in ["#51", "#52"] {
        assert!((area(&of_solid, wall) - 50.0).abs() < 1e-9, "{of_solid}");
        assert_eq!(area(&of_lines, wall), 0.0, "{of_lines}");
    }
    let slope = area(&of_lines, "#53") / area(&of_solid, "#53");
    assert!(slope > 0.2 && slope < 1.0, "{slope}");
    let page = fs::read_to_string(workdir.path("out/report.html")).unwrap();
    let row = |face: &str| {
        page.split("<tr>")
            .find(|row| row.contains(face))
            .map(str::to_owned)
            .unwrap()
    };
    let cells = row("<td>#51</td>");
    assert!(cells.contains("≥ 8.372") && cells.matches('–').count() == 3, "{cells}");
    assert!(!row("<td>#53</td>").contains('≥'), "{}", row("<td>#53</td>"));
    let output = workdir.run_job("verify", &["--no-proof", "--directions", "z", "--only", "report"]);
    let told = text(&output.stdout);
    let words = "#51 (plane): gouge at least 0, excess at least 8.3722 mm; no mean, as it is along the dexels";
    assert!(told.contains(words), "{told}");
}

/// Limits by face follow the names of the file, whatever a cache knows of the same triangles.
#[test]
fn a_cache_knows_the_names_of_faces() {
    let workdir = Workdir::new(
        "Job(
    grid: Grid(min: (-1, -1), max: (11, 11), cells: (24, 24)),
    stock: Block(min: (0, 0, 0), max: (10, 10, 10)),
    tools: { 1: Flat(radius: 1, length: 20) },
    paths: [Path(tool: 1, poses: [((3, 3, 12), (0, 0, 1)), ((3, 3, 3.5), (0, 0, 1))])],
    target: Mesh(\"tip.step\"),
    limits: Limits(gouge: 0.05, excess: 20, regions: [Region(face: \"slope\", gouge: 1, excess: 20)]),
)",
    );
    for (face, status) in [("#53", 0), ("#50", 1), ("#53", 0)] {
        let (plain, named) = (
            format!("{face}=ADVANCED_FACE(''"),
            format!("{face}=ADVANCED_FACE('slope'"),
        );
        fs::write(workdir.path("tip.step"), tetrahedron().replace(&plain, &named)).unwrap();
        let options = ["--no-proof", "--only", "report", "--moments", "0", "--cache", "cache"];
        let output = workdir.run_job("verify", &options);
        assert_eq!(output.status.code(), Some(status), "{face}: {}", text(&output.stdout));
    }
}

/// The corner of a cube of one centimetre.
fn tetrahedron() -> String {
    let corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let edges = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let faces = [
        ([0, 2, 1], [0, 0, -1]),
        ([0, 1, 3], [0, -1, 0]),
        ([0, 3, 2], [-1, 0, 0]),
        ([1, 2, 3], [1, 1, 1]),
    ];
    let mut data = String::from(
        "#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.));\n\
         #2=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#1))REPRESENTATION_CONTEXT('',''));\n",
    );
    for (k, [x, y, z]) in corners.iter().enumerate() {
        data += &format!(
            "#{}=CARTESIAN_POINT('',({x}.,{y}.,{z}.));\n#{}=VERTEX_POINT('',#{});\n",
            100 + k,
            10 + k,
            100 + k
        );
    }
    for (k, [a, b]) in edges.iter().enumerate() {
        let way = [0, 1, 2].map(|axis| corners[*b][axis] - corners[*a][axis]);
        data += &format!(
            "#{}=DIRECTION('',({}.,{}.,{}.));\n#{}=VECTOR('',#{},1.);\n#{}=LINE('',#{},#{});\n#{}=EDGE_CURVE('',#{},#{},#{},.T.);\n",
            110 + k,
            way[0],
            way[1],
            way[2],
            120 + k,
            110 + k,
            130 + k,
            100 + a,
            120 + k,
            20 + k,
            10 + a,
            10 + b,
            130 + k
        );
    }
    for (k, (ring, [x, y, z])) in faces.iter().enumerate() {
        for n in 0..3 {
            let (a, b) = (ring[n], ring[(n + 1) % 3]);
            let edge = edges.iter().position(|edge| *edge == [a.min(b), a.max(b)]).unwrap();
            let along = if a < b { ".T." } else { ".F." };
            data += &format!("#{}=ORIENTED_EDGE('',*,*,#{},{along});\n", 140 + 3 * k + n, 20 + edge);
        }
        let across = [0, 1, 2].map(|axis| corners[ring[1]][axis] - corners[ring[0]][axis]);
        let first = 140 + 3 * k;
        data += &format!("#{}=EDGE_LOOP('',(#{first},#{},#{}));\n", 160 + k, first + 1, first + 2);
        data += &format!(
            "#{}=FACE_OUTER_BOUND('',#{},.T.);\n#{}=DIRECTION('',({x}.,{y}.,{z}.));\n",
            165 + k,
            160 + k,
            170 + k
        );
        data += &format!(
            "#{}=DIRECTION('',({}.,{}.,{}.));\n",
            175 + k,
            across[0],
            across[1],
            across[2]
        );
        data += &format!(
            "#{}=AXIS2_PLACEMENT_3D('',#{},#{},#{});\n",
            180 + k,
            100 + ring[0],
            170 + k,
            175 + k
        );
        data += &format!(
            "#{}=PLANE('',#{});\n#{}=ADVANCED_FACE('',(#{}),#{},.T.);\n",
            185 + k,
            180 + k,
            50 + k,
            165 + k,
            185 + k
        );
    }
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n{data}#59=CLOSED_SHELL('',(#50,#51,#52,#53));\n\
         #60=MANIFOLD_SOLID_BREP('tip',#59);\nENDSEC;\nEND-ISO-10303-21;\n"
    )
}
