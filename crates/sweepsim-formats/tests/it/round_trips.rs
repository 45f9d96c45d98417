//! Every format reads back what was written, and no reader panics on anything.

use sweepsim_dexel::{Dexels, Grid, Interval, Mesh};
use sweepsim_formats::{
    DexelRow, Fixture, Job, Report, ReportedDexel, dexels_from_rows, parse_stl, read_dexels_csv, read_ply, write_3mf,
    write_dexels_csv, write_glb, write_ply, write_stl, write_vtp,
};
use sweepsim_props::*;

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![
        -100.0..100.0,
        (-1000i32..1000).prop_map(|n| f64::from(n) * 0.1),
        Just(0.0),
        -1e-12..1e-12,
        -1e12..1e12
    ]
}

/// Dexels with 0 to 3 intervals on slopes and flats.
fn dexels() -> impl Strategy<Value = Dexels> {
    let column = collection::vec((1e-3..3.0, 1e-3..3.0), 0..4);
    let columns = collection::vec((column, 1usize..4), 1..60);
    (columns, 1usize..7, -50.0..50.0).prop_map(|(columns, ny, z)| {
        let flat: Vec<_> = columns
            .iter()
            .flat_map(|(column, count)| std::iter::repeat_n(column, *count))
            .collect();
        let nx = flat.len().div_ceil(ny);
        let grid = Grid::new([-1.0, 0.25], [2.5, 7.0], [nx, ny]).unwrap();
        let mut dexels = Dexels::empty(grid);
        for (index, column) in flat.iter().enumerate() {
            let mut at = z;
            let intervals = column.iter().map(|(gap, length)| {
                let lower = at + gap;
                at = lower + length;
                Interval::between(lower, at)
            });
            let intervals: Vec<Interval> = intervals.collect();
            dexels.set(index, &intervals).unwrap();
        }
        dexels
    })
}

fn ends(dexels: &Dexels) -> Vec<Vec<f64>> {
    let of = |index| dexels.at(index).iter().flat_map(|a| [a.lower.z, a.upper.z]).collect();
    (0..dexels.grid().len()).map(of).collect()
}

/// Texts that look like the format, with things wrong in them.
fn like(words: &'static [&'static str]) -> impl Strategy<Value = String> {
    collection::vec(
        (prop::sample::select(words), "[ \n,]|", prop::option::of(-1e3..1e3)),
        0..60,
    )
    .prop_map(|parts| {
        let word = |(word, space, number): (&str, String, Option<f64>)| match number {
            Some(number) => format!("{word}{number:.3}{space}"),
            None => format!("{word}{space}"),
        };
        parts.into_iter().map(word).collect()
    })
}

proptest! {
    #[test]
    fn dexel_csv(dexels in dexels()) {
        let mut bytes = Vec::new();
        write_dexels_csv(&dexels, &mut bytes).unwrap();
        let rows: Vec<DexelRow> = read_dexels_csv(&bytes[..]).unwrap();
        let read = dexels_from_rows(*dexels.grid(), &rows).unwrap();
        prop_assert_eq!(ends(&read), ends(&dexels));
        let mut again = Vec::new();
        write_dexels_csv(&read, &mut again).unwrap();
        prop_assert_eq!(again, bytes);
    }

    #[test]
    fn fixtures(dexels in dexels(), digits in 1i32..7) {
        let tolerance = 10.0_f64.powi(-digits);
        let fixture = Fixture::new("a job", &dexels, tolerance).unwrap();
        let read = Fixture::parse(&fixture.text()).unwrap_or_else(|error| panic!("{error}\n{}", fixture.text()));
        prop_assert_eq!(&read, &fixture);
        prop_assert_eq!(read.differences(&dexels).unwrap(), vec![]);
        for (index, ends) in ends(&dexels).iter().enumerate() {
            for (a, b) in read.ends(index).iter().zip(ends) {
                prop_assert!((a - b).abs() <= 0.0501 * tolerance);
            }
        }
    }

    #[test]
    fn ply(vertices in collection::vec(([length(), length(), length()], [-1f32..1.0, -1f32..1.0, -1f32..1.0]), 3..20), corners in collection::vec([0usize..20, 0usize..20, 0usize..20], 0..20)) {
        let count = vertices.len();
        let mesh = Mesh {
            vertices: vertices.iter().map(|v| v.0).collect(),
            normals: vertices.iter().map(|v| v.1).collect(),
            cut: vertices.iter().map(|v| v.0[0] > 0.0).collect(),
            triangles: corners.iter().map(|t| t.map(|k| (k % count) as u32)).collect(),
        };
        let mut bytes = Vec::new();
        write_ply(&mesh, &mut bytes).unwrap();
        let read = read_ply(&bytes).unwrap();
        prop_assert_eq!(read, mesh);
        let cut = bytes.len() * 2 / 3;
        prop_assert!(read_ply(&bytes[..cut]).is_err(), "a part is no mesh");
    }

    #[test]
    fn stl(triangles in collection::vec([[-1e3f32..1e3, -1e3f32..1e3, -1e3f32..1e3], [-1e3f32..1e3, -1e3f32..1e3, -1e3f32..1e3], [0f32..1.0, 0f32..1.0, 0f32..1.0]], 1..9)) {
        let triangles: Vec<[[f64; 3]; 3]> = triangles.iter().map(|t| t.map(|p| p.map(f64::from))).collect();
        let mut bytes = Vec::new();
        write_stl(&triangles, &mut bytes).unwrap();
        let soup = parse_stl(&bytes).unwrap();
        prop_assert_eq!(soup.triangles, &triangles[..]);
        prop_assert!(parse_stl(&bytes[..bytes.len() - 7]).is_err());
        let facet = |t: &[[f64; 3]; 3]| {
            let corners: String = t.iter().map(|[x, y, z]| format!("vertex {x} {y:e} {z}\n")).collect();
            format!("facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n")
        };
        let ascii: String = triangles.iter().map(facet).collect();
        let ascii = format!("solid \u{e4} b\n{ascii}endsolid\n");
        let soup = parse_stl(ascii.as_bytes()).unwrap();
        prop_assert_eq!(soup.triangles, &triangles[..]);
    }

    #[test]
    fn no_reader_panics_on_bytes(bytes in collection::vec(any::<u8>(), 0..300)) {
        let text = String::from_utf8_lossy(&bytes);
        let _ = parse_stl(&bytes);
        let _ = parse_stl(&[b"solid ", &bytes[..]].concat());
        let _ = read_ply(&bytes);
        let _ = read_ply(&[b"ply\n", &bytes[..]].concat());
        let _ = read_dexels_csv(&bytes[..]);
        let _ = Fixture::parse(&text);
        let _ = Job::parse(&text, "x.ron".as_ref());
    }

    #[test]
    fn no_reader_panics_on_what_looks_right(
        fixture in like(&["sweepsim dexels 1\njob a\ngrid 0 0 1 1 2 3\ntolerance 1e-3\n", "*3", "*", "1 0 5 ", "\n", "2 ", "-5 ", "9223372036854775807 "]),
        ply in like(&["ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n", "element face 9999999999\n", "property list uchar int vertex_indices\n", "end_header\n", "1 ", "\n"]),
        job in like(&["Job(", "grid: Grid(", "min: (", "cells: (", "stock: Block(", "tools: {", "1: Ball(", "radius: ", "paths: [", "poses: [", ")", "]", "}", ",", "\"", "//", "/*", "\n"]),
    ) {
        let _ = Fixture::parse(&fixture);
        let _ = read_ply(ply.as_bytes());
        let _ = Job::parse(&job, "x.ron".as_ref());
    }
}

#[test]
fn reports() {
    let mut report = Report::default();
    report.job = "quickstart".into();
    report.method = "charts".into();
    report.volume_removed = Some(12.5);
    report.seconds.insert("sweep".into(), 1.5);
    report.seconds.insert("audit".into(), 0.25);
    report.dexels.unresolved.push(ReportedDexel::new(3, 4, "singular"));
    let text = report.to_json().unwrap();
    assert!(text.find("sweep") < text.find("audit"), "phases in their order");
    for field in [
        "job",
        "method",
        "cells",
        "moves",
        "seconds",
        "crossings",
        "dexels",
        "covered",
        "repaired",
        "unresolved",
        "volume_removed",
    ] {
        assert!(text.contains(&format!("\"{field}\"")), "{field}");
    }
    assert!(!text.contains("gouge"), "only with verify");
    assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), report);
}

#[test]
fn fixtures_name_what_differs() {
    let grid = Grid::new([0.0; 2], [1.0; 2], [2, 2]).unwrap();
    let mut dexels = Dexels::empty(grid);
    dexels.set(1, &[Interval::between(0.0, 1.0)]).unwrap();
    let fixture = Fixture::new("job", &dexels, 1e-3).unwrap();
    dexels.set(1, &[Interval::between(0.0, 1.0019)]).unwrap();
    assert!(fixture.differences(&dexels).unwrap().is_empty());
    dexels.set(1, &[Interval::between(0.0, 1.0021)]).unwrap();
    dexels.set(2, &[Interval::between(0.0, 1.0)]).unwrap();
    let found: Vec<String> = fixture
        .differences(&dexels)
        .unwrap()
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        found,
        [
            "dexel (0, 1): stored [0.0, 1.0], found [0.0, 1.0021]",
            "dexel (1, 0): stored nothing, found [0.0, 1.0]"
        ]
    );
}

#[test]
fn a_file_is_whole_or_not_there() {
    use std::io::Write;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.ply");
    let names = || std::fs::read_dir(folder.path()).unwrap().count();
    let failed = sweepsim_formats::write_atomically(&path, |file| {
        file.write_all(b"half")?;
        Err(std::io::Error::other("no more"))
    });
    let message = failed.unwrap_err().to_string();
    assert!(
        message.ends_with("part.ply: cannot write this file: no more"),
        "{message}"
    );
    assert_eq!(names(), 0);
    for text in ["one", "two"] {
        sweepsim_formats::write_atomically(&path, |file| file.write_all(text.as_bytes())).unwrap();
        assert_eq!((std::fs::read_to_string(&path).unwrap().as_str(), names()), (text, 1));
    }
    let nowhere = sweepsim_formats::AtomicFile::create(&folder.path().join("none/part.ply")).unwrap_err();
    assert!(nowhere.to_string().contains("none/part.ply: cannot write this file"));
    assert!(sweepsim_formats::AtomicFile::create(folder.path()).is_err());
}

type Writer = fn(&Mesh, &mut Vec<u8>) -> std::io::Result<()>;

/// Numbers, among them those that nobody should use.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => -10.0..10.0_f64,
        1 => prop::sample::select(&[0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e-300][..]),
    ]
}

proptest! {
    /// Rows in any order, reversed, overlapping or not finite: dexels with exactly these intervals, or an error.
    #[test]
    fn rows_become_dexels_or_an_error(
        rows in collection::vec((0_usize..4, 0_usize..3, any_number(), any_number()), 0..6),
    ) {
        let rows: Vec<DexelRow> = rows.into_iter().map(|(i, j, z0, z1)| DexelRow { i, j, z0, z1 }).collect();
        let grid = Grid::new([0.0; 2], [1.0; 2], [3, 3]).unwrap();
        if let Ok(dexels) = dexels_from_rows(grid, &rows) {
            let found: Vec<[f64; 2]> = dexels.iter().flat_map(|(_, line)| line.heights()).collect();
            let expected: Vec<[f64; 2]> = rows.iter().map(|row| [row.z0, row.z1]).collect();
            prop_assert_eq!(found, expected);
        }
    }

    /// Meshes with missing vertices, lists of wrong lengths, and numbers that are not finite: a file or an error.
    #[test]
    fn meshes_are_written_or_refused(
        vertices in collection::vec([any_number(), any_number(), any_number()], 0..6),
        normals in 0_usize..6,
        triangles in collection::vec([0_u32..7, 0_u32..7, 0_u32..7], 0..5),
    ) {
        let whole = triangles.iter().flatten().all(|v| (*v as usize) < vertices.len());
        let mesh = Mesh { normals: vec![[f32::NAN; 3]; normals], cut: vec![true; normals], vertices, triangles };
        let mut bytes = Vec::new();
        let writers: [Writer; 4] = [write_ply, write_glb, write_3mf, write_vtp];
        for write in writers {
            bytes.clear();
            prop_assert!(write(&mesh, &mut bytes).is_err() || whole);
        }
        bytes.clear();
        if write_ply(&mesh, &mut bytes).is_ok() {
            let read = read_ply(&bytes);
            prop_assert_eq!(read.is_ok(), mesh.vertices.iter().flatten().all(|c| c.is_finite()));
        }
    }
}

/// A mesh whose indices would not fit into 32 bits.
#[test]
fn too_many_vertices_are_an_error() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4294967297\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    let error = read_ply(ply.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("the number of vertices is 4294967297"), "{error}");
}

/// A line that never ends is an error with its number, not memory without end.
#[test]
fn endless_rows() {
    use std::io::{BufReader, Read as _};
    let reader = BufReader::new((&b"i,j,z0,z1\n0,2,-1,0.5\n"[..]).chain(std::io::repeat(b'7')));
    let error = read_dexels_csv(reader).unwrap_err().to_string();
    assert!(error.starts_with("3:1: a line is longer than 4096 bytes"), "{error}");
}

/// More dexels than are made into text at a time, with gaps where a block of them begins or ends.
#[test]
fn rows_of_many_dexels_are_in_order() {
    let [nx, ny] = [411, 509];
    let grid = Grid::new([0.0, 0.0], [nx as f64, ny as f64], [nx, ny]).unwrap();
    let mut dexels = Dexels::empty(grid);
    let mut expected = Vec::new();
    for index in (0..grid.len()).filter(|index| index % 1024 > 2 && index % 7 != 0) {
        let (i, j) = grid.place(index);
        let [z0, z1] = [0.1 * index as f64, 0.1 * index as f64 + 0.3];
        dexels.set(index, &[Interval::between(z0, z1)]).unwrap();
        expected.push(DexelRow { i, j, z0, z1 });
    }
    expected.sort_by_key(|row| (row.i, row.j));
    let mut bytes = Vec::new();
    write_dexels_csv(&dexels, &mut bytes).unwrap();
    assert_eq!(read_dexels_csv(&bytes[..]).unwrap(), expected);
}
