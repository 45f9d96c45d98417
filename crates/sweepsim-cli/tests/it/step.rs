//! STEP files, as a process.

use crate::support::Workdir;
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
