//! Colours of meshes, and limits by region.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use sweepsim_formats::{Job, RegionPlace, read_coloured_mesh_file};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const RED: [u8; 3] = [255, 0, 0];
const ORANGE: [u8; 3] = [255, 128, 0];

/// A closed tetrahedron: the first face orange, the second red.
const PLY_FACES: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
element face 4\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n\
0 0 0\n8 0 0\n0 8 0\n0 0 8\n3 0 2 1 255 128 0\n3 0 1 3 255 0 0\n3 0 3 2 1 2 3\n3 1 2 3 9 9 9\n";

fn colours(folder: &Path, name: &str, bytes: &[u8]) -> Vec<Option<[u8; 3]>> {
    fs::write(folder.join(name), bytes).unwrap();
    let (mesh, colours) = read_coloured_mesh_file(&folder.join(name)).unwrap();
    assert_eq!(mesh.triangles.len(), colours.len(), "{name}");
    colours
}

fn three_mf(resources: &str, triangles: &str) -> Vec<u8> {
    let text = format!(
        "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"><resources>{resources}\
         <object id=\"9\" pid=\"1\" pindex=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"8\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"8\" z=\"0\"/></vertices>\
         <triangles>{triangles}</triangles></mesh></object></resources><build><item objectid=\"9\"/></build></model>"
    );
    let mut file = Cursor::new(Vec::new());
    let mut writer = ZipWriter::new(&mut file);
    writer
        .start_file("3D/3dmodel.model", SimpleFileOptions::default())
        .unwrap();
    writer.write_all(text.as_bytes()).unwrap();
    writer.finish().unwrap();
    file.into_inner()
}

fn glb(materials: &str, primitives: &[Option<usize>]) -> Vec<u8> {
    let primitive = |material: &Option<usize>| {
        let material = material.map_or(String::new(), |n| format!(",\"material\":{n}"));
        format!("{{\"attributes\":{{\"POSITION\":0}},\"indices\":1{material}}}")
    };
    let primitives: Vec<String> = primitives.iter().map(primitive).collect();
    let mut text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"materials\":{materials},\"meshes\":[{{\"primitives\":[{}]}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}},{{\"bufferView\":1,\"componentType\":5125,\"count\":3,\"type\":\"SCALAR\"}}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":36}},{{\"buffer\":0,\"byteOffset\":36,\"byteLength\":12}}],\"buffers\":[{{\"byteLength\":48}}]}}",
        primitives.join(",")
    );
    while text.len() % 4 != 0 {
        text.push(' ');
    }
    let mut data: Vec<u8> = [0.0_f32, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0, 8.0, 0.0]
        .iter()
        .flat_map(|c| c.to_le_bytes())
        .collect();
    data.extend([0_u32, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + text.len() as u32 + 48).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text.as_bytes()), (b"BIN\0", &data)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

#[test]
fn files_have_colours_by_face_corner_or_material() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, bytes: &[u8]| colours(folder.path(), name, bytes);
    assert_eq!(
        read("faces.ply", PLY_FACES.as_bytes()),
        [Some(ORANGE), Some(RED), Some([1, 2, 3]), Some([9; 3])]
    );
    // Corners as fractions: a face has a colour if all of its own agree.
    let corners = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float red\nproperty float green\n\
        property float blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0\n8 0 0 1 0 0\n0 8 0 1 0 0\n0 0 8 0 1 0\n3 0 2 1\n3 0 1 3\n";
    assert_eq!(read("corners.ply", corners.as_bytes()), [Some(RED), None]);
    let resources = "<basematerials id=\"1\"><base name=\"a\" displaycolor=\"#FF8000FF\"/><base name=\"b\" displaycolor=\"#FF0000\"/></basematerials>\
        <m:colorgroup id=\"2\"><m:color color=\"#010203\"/></m:colorgroup>";
    let triangles = "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/><triangle v1=\"0\" v2=\"1\" v3=\"2\" p1=\"0\"/><triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"2\" p1=\"0\" p2=\"0\" p3=\"0\"/>\
        <triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"1\" p1=\"0\" p2=\"1\" p3=\"0\"/><triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"7\" p1=\"5\"/>";
    let found = read("a.3mf", &three_mf(resources, triangles));
    assert_eq!(found, [Some(RED), Some(ORANGE), Some([1, 2, 3]), None, None]);
    assert_eq!(read("b.3mf", &three_mf("", triangles)), [None; 5]);
    // Linear 0.2158605 is 128 in sRGB.
    let materials = "[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.2158605,0,1]}},{}]";
    assert_eq!(
        read("a.glb", &glb(materials, &[Some(0), Some(1), None, Some(8)])),
        [Some(ORANGE), None, None, None]
    );
}

#[test]
fn regions_of_a_target_by_colour_and_box() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.ply"), PLY_FACES).unwrap();
    let job = |regions: &str| {
        let text = format!(
            "Job(\n    stock: Block(min: (0, 0, 0), max: (8, 8, 8)),\n    tools: {{}},\n    paths: [],\n    target: Mesh(\"part.ply\"),\n    \
             limits: Limits(gouge: 0.02, excess: 0.1, regions: [{regions}]),\n)"
        );
        Job::parse(&text, &folder.path().join("job.ron"))
    };
    let read = job(
        "Region(colour: \"#ff8000\", gouge: 0.5, excess: 0.6), Region(name: \"low\", within: Block(min: (-1, -1, -1), max: (9, 9, 2)), gouge: 0, excess: 0.01)",
    )
    .unwrap();
    let limits = read.limits.unwrap();
    assert_eq!((limits.gouge, limits.excess), (0.02, 0.1));
    assert_eq!(limits.regions[0].place, RegionPlace::Colour(ORANGE));
    let names: Vec<&str> = limits.regions.iter().map(|region| region.name.as_str()).collect();
    assert_eq!(names, ["1", "low"]);
    let parts = read.target.unwrap().by_region(&limits);
    // The bottom is orange; of each wall, the part below 2 is in the box.
    assert_eq!(parts.len(), 3);
    assert_eq!(parts[1].triangles.len(), 1);
    let heights = |n: usize| parts[n].triangles.iter().flatten().map(|p| p[2]);
    assert!(heights(0).all(|z| z >= 2.0) && heights(2).all(|z| z <= 2.0));
    for (regions, message) in [
        ("Region(gouge: 0, excess: 0)", "job.ron:6:56: a region has one place"),
        (
            "Region(colour: \"red\", gouge: 0, excess: 0)",
            "job.ron:6:71: the colour of a region is \"red\"",
        ),
        (
            "Region(colour: \"#123456\", gouge: 0, excess: 0)",
            "job.ron:6:56: no surface of the target is left for region 1",
        ),
        (
            "Region(colour: \"#ff0000\", gouge: -1, excess: 0)",
            "job.ron:6:89: gouge is -1",
        ),
        (
            "Region(within: Block(min: (0, 0, 0), max: (1, 0, 1)), gouge: 0, excess: 0)",
            "the y of max is 0, but must be greater",
        ),
    ] {
        let found = job(regions).expect_err(regions).to_string();
        assert!(found.contains(message), "{found}\n{message}");
    }
}
