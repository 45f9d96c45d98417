//! Archives as other programs write them: compressed, with ZIP64 fields, with other names inside; and archives that
//! mean harm.

use std::io::{Cursor, Read, Write};

use sweepsim_dexel::{Dexels, Grid, Mesh, Stock, TriDexels};
use sweepsim_formats::{read_3mf, read_dexels_npz, write_3mf, write_dexels_npz};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

fn dexels() -> Dexels {
    let grid = Grid::new([-6.0, -6.0], [6.0, 6.0], [24, 24]).unwrap();
    let ball = Stock::Ball {
        centre: [0.0; 3],
        radius: 5.0,
    };
    ball.dexels(&grid).unwrap()
}

fn mesh() -> Mesh {
    let ball = Stock::Ball {
        centre: [0.0; 3],
        radius: 5.0,
    };
    TriDexels::new([-6.0; 3], [6.0; 3], [12; 3], &ball)
        .unwrap()
        .surface()
        .unwrap()
}

fn archive<'a>(entries: impl IntoIterator<Item = (&'a str, Vec<u8>)>) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = ZipWriter::new(&mut file);
    // As `numpy.savez_compressed` writes: deflated, with 64-bit sizes.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .large_file(true);
    for (name, bytes) in entries {
        writer.start_file(name, options).unwrap();
        writer.write_all(&bytes).unwrap();
    }
    writer.finish().unwrap();
    file.into_inner()
}

fn entries(file: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(file)).unwrap();
    let read = |index| {
        let mut entry = archive.by_index(index).unwrap();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        (entry.name().unwrap().into_owned(), bytes)
    };
    (0..ZipArchive::new(Cursor::new(file)).unwrap().len())
        .map(read)
        .collect()
}

fn compressed(file: &[u8]) -> Vec<u8> {
    let entries = entries(file);
    let small = archive(entries.iter().map(|(name, bytes)| (name.as_str(), bytes.clone())));
    assert!(small.len() < file.len(), "compression changes something");
    small
}

fn model(text: &str) -> Vec<u8> {
    archive([("3D/3dmodel.model", text.as_bytes().to_vec())])
}

#[test]
fn compressed_arrays_are_read() {
    let mut file = Vec::new();
    write_dexels_npz(&dexels(), &mut file).unwrap();
    assert_eq!(read_dexels_npz(&compressed(&file)).unwrap(), dexels());
}

#[test]
fn compressed_models_are_read() {
    let mut file = Vec::new();
    write_3mf(&mesh(), &mut file).unwrap();
    let read = read_3mf(&compressed(&file)).unwrap();
    assert_eq!((read.vertices, read.triangles), (mesh().vertices, mesh().triangles));
}

const TETRAHEDRON: &str = r#"<?xml version="1.0"?>
<!-- <vertex x="9" y="9" z="9"/> -->
<m:model unit='inch' xmlns:m="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><m:resources>
<m:object id="7"><m:mesh><m:vertices>
<m:vertex x = "0" y="0" z="0"></m:vertex><m:vertex x="1" y="0" z="0" /><m:vertex z="0" y="1" x="0"/><m:vertex x="0" y="0" z="&#49;"/>
</m:vertices><m:triangles>
<m:triangle v1="0" v2="2" v3="1"/><m:triangle v1="0" v2="1" v3="3"/><m:triangle v1="0" v2="3" v3="2"/><m:triangle v1="1" v2="2" v3="3"/>
</m:triangles></m:mesh></m:object></m:resources><m:build><m:item objectid="7"/></m:build></m:model>"#;

/// What a search for `<vertex` would get wrong: comments, prefixes, spaces, quotes, entities, units, and where the
/// model is.
#[test]
fn models_are_xml() {
    let read = read_3mf(&model(TETRAHEDRON)).unwrap();
    assert_eq!(
        read.vertices,
        [[0.0; 3], [25.4, 0.0, 0.0], [0.0, 25.4, 0.0], [0.0, 0.0, 25.4]]
    );
    assert_eq!(read.triangles.len(), 4);
    let relations = r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/thumbnail.png" Id="a" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
<Relationship Target="/part/body.model" Id="b" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
    let elsewhere = archive([
        ("_rels/.rels", relations.as_bytes().to_vec()),
        ("part/body.model", TETRAHEDRON.as_bytes().to_vec()),
    ]);
    assert_eq!(read_3mf(&elsewhere).unwrap().vertices, read.vertices);
}

#[test]
fn what_is_wrong_with_a_model_is_said() {
    for (from, to, expected) in [
        ("unit='inch'", "unit='mile'", "the unit of this 3MF is \"mile\""),
        ("v3=\"1\"", "v3=\"4\"", "missing vertex"),
        ("x=\"1\"", "x=\"NaN\"", "three finite coordinates"),
        ("x=\"1\"", "", "three finite coordinates"),
        ("</m:triangles>", "", "XML"),
        ("</m:build></m:model>", "", "one complete object"),
        (
            "objectid=\"7\"",
            "objectid=\"7\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"",
            "transformations",
        ),
        ("<m:mesh>", "<m:components/><m:mesh>", "components"),
        (
            "<m:object id=\"7\">",
            "<m:object id=\"8\"/><m:object id=\"7\">",
            "one complete object",
        ),
    ] {
        assert!(TETRAHEDRON.contains(from), "{from}");
        let error = read_3mf(&model(&TETRAHEDRON.replacen(from, to, 1)))
            .expect_err(to)
            .to_string();
        assert!(error.contains(expected), "{to}: {error}");
    }
    let error = read_3mf(&archive([("a", vec![0; 9])])).unwrap_err().to_string();
    assert!(error.contains("no entry `3D/3dmodel.model`"), "{error}");
}

/// 400 MB of zeros in 400 kB: refused before they fill the memory.
#[test]
fn decompression_bombs_are_refused() {
    let zeros = vec![0_u8; 400 << 20];
    let bomb = archive([("3D/3dmodel.model", zeros)]);
    assert!(bomb.len() < 1 << 20);
    let error = read_3mf(&bomb).unwrap_err().to_string();
    assert!(error.contains("more than 100 times its size"), "{error}");
}
