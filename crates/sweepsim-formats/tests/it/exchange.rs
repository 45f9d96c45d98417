//! Formats of other programs: what is written is read; damage is an error, or changes nothing that is read.

use std::path::Path;
use sweepsim_dexel::{Dexels, Frame, Grid, Interval, Mesh, Source, Stock, TriDexels};
use sweepsim_formats::{
    Fixture, parse_stl, read_3mf, read_dexels_csv, read_dexels_file, read_dexels_npz, read_glb, read_mesh_file,
    read_ply, read_vtp, write_3mf, write_dexels_csv, write_dexels_file, write_dexels_npz, write_dexels_vtu, write_glb,
    write_mesh_file, write_ply, write_stl, write_vtp,
};
use sweepsim_props::*;

fn mesh() -> Mesh {
    let ball = Stock::Ball {
        centre: [0.3, -0.2, 0.1],
        radius: 3.0,
    };
    TriDexels::new([-4.0; 3], [4.0; 3], [7; 3], &ball)
        .unwrap()
        .surface()
        .unwrap()
}

fn dexels() -> Dexels {
    let grid = Grid::new([0.0; 2], [7.0, 9.0], [7, 9]).unwrap();
    Dexels::from_fn(grid, |index, line| {
        for k in 0..index % 4 {
            let mut interval = Interval::between(k as f64 + 0.1, k as f64 + 0.9);
            interval.upper.normal = [0.6, 0.0, 0.8];
            interval.upper.source = Source::Cut {
                path: 3,
                segment: index as u32,
                t: 0.25,
            };
            line.push(interval);
        }
    })
    .unwrap()
}

fn written(write: impl Fn(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<u8> {
    let mut file = Vec::new();
    write(&mut file).unwrap();
    file
}

#[test]
fn what_is_written_is_read() {
    let (mesh, dexels) = (mesh(), dexels());
    assert!(mesh.triangles.len() > 100);
    let npz = written(|file| write_dexels_npz(&dexels, file));
    assert_eq!(read_dexels_npz(&npz).unwrap(), dexels);
    let side = Frame::new([1.0, 2.0, 3.0], [1.0, 0.2, 0.1], [0.0, 0.0, 1.0]).unwrap();
    let framed = Dexels::from_fn(dexels.grid().in_frame(side), |index, line| {
        line.extend(dexels.at(index))
    })
    .unwrap();
    let npz = written(|file| write_dexels_npz(&framed, file));
    assert_eq!(read_dexels_npz(&npz).unwrap(), framed);
    let model = read_3mf(&written(|file| write_3mf(&mesh, file))).unwrap();
    assert_eq!((&model.vertices, &model.triangles), (&mesh.vertices, &mesh.triangles));
    let seen = read_glb(&written(|file| write_glb(&mesh, file))).unwrap();
    assert_eq!((&seen.normals, &seen.triangles), (&mesh.normals, &mesh.triangles));
    assert_eq!(read_vtp(&written(|file| write_vtp(&mesh, file))).unwrap(), mesh);
    let rounded: Vec<[f64; 3]> = mesh.vertices.iter().map(|v| v.map(|c| f64::from(c as f32))).collect();
    assert_eq!(seen.vertices, rounded);
    let bad = Mesh {
        triangles: vec![[0, 1, 9]],
        ..Mesh::default()
    };
    assert!(write_glb(&bad, &mut Vec::new()).is_err() && write_3mf(&bad, &mut Vec::new()).is_err());
}

#[test]
fn extensions_say_the_format() {
    let folder = tempfile::tempdir().unwrap();
    let (mesh, dexels) = (mesh(), dexels());
    for name in ["a.stl", "a.PLY", "a.glb", "a.3mf", "a.vtp"] {
        let file = folder.path().join(name);
        write_mesh_file(&mesh, &file).unwrap();
        let read = read_mesh_file(&file).unwrap();
        assert_eq!(
            (read.vertices.len(), read.triangles.len()),
            (mesh.vertices.len(), mesh.triangles.len())
        );
        let volume = |mesh: &Mesh| mesh.soup().unwrap().volume();
        assert!((volume(&read) - volume(&mesh)).abs() < 1e-4, "{name}");
    }
    for name in ["a.csv", "a.dexels", "a.npz"] {
        let file = folder.path().join(name);
        write_dexels_file(&dexels, &file).unwrap();
        let read = read_dexels_file(&file, Some(dexels.grid())).unwrap();
        assert_eq!((read.count(), read.volume()), (dexels.count(), dexels.volume()));
        assert!(read == dexels || name == "a.csv");
    }
    // The extension of the small texts is the same.
    let fixture = Fixture::new("job", &dexels, 1e-6).unwrap();
    let file = folder.path().join("b.dexels");
    std::fs::write(&file, fixture.text()).unwrap();
    let read = read_dexels_file(&file, None).unwrap();
    assert_eq!(read.count(), dexels.count());
    assert!((read.volume() - dexels.volume()).abs() < 1e-6);
    let error = |result: Result<Dexels, sweepsim_formats::FormatError>| result.unwrap_err().to_string();
    assert!(error(read_dexels_file(&folder.path().join("a.csv"), None)).contains("a grid is needed"));
    assert!(
        error(read_dexels_file(Path::new("a.stl"), None)).contains("a.stl: the extension of this dexel file is .stl")
    );
    assert!(
        read_mesh_file(Path::new("a"))
            .unwrap_err()
            .to_string()
            .contains("is missing")
    );
    assert!(write_mesh_file(&mesh, &folder.path().join("a.obj")).is_err());
    assert!(!folder.path().join("a.obj").exists());
}

/// What ParaView's reader wants of the description: arrays that lie one behind the other, each as long as its numbers
/// need.
#[test]
fn lines_for_paraview_are_whole() {
    let dexels = dexels();
    let file = written(|file| write_dexels_vtu(&dexels, file));
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = file.windows(mark.len()).position(|w| w == mark).unwrap();
    let (xml, data) = (std::str::from_utf8(&file[..at]).unwrap(), &file[at + mark.len()..]);
    let n = dexels.count();
    assert!(n > 50 && xml.contains(&format!("NumberOfPoints=\"{}\" NumberOfCells=\"{n}\"", 2 * n)));
    let mut next = 0;
    let mut arrays = 0;
    for tag in xml.split('<').filter(|tag| tag.starts_with("DataArray ")) {
        let value = |key: &str| {
            tag.split_once(&format!(" {key}=\""))
                .unwrap()
                .1
                .split('"')
                .next()
                .unwrap()
        };
        assert_eq!(value("offset").parse::<usize>().unwrap(), next);
        let length = u64::from_le_bytes(data[next..next + 8].try_into().unwrap()) as usize;
        let size = match value("type") {
            "Float64" | "Int64" => 8,
            "Float32" | "UInt32" => 4,
            "UInt16" => 2,
            _ => 1,
        };
        let rows = match value("Name") {
            "normal" | "path" | "segment" | "t" | "places" | "connectivity" => 2 * n,
            _ => n,
        };
        assert_eq!(
            length,
            rows * size * value("NumberOfComponents").parse::<usize>().unwrap(),
            "{tag}"
        );
        next += 8 + length;
        arrays += 1;
    }
    assert_eq!(arrays, 10);
    assert!(data[next..].starts_with(b"\n</AppendedData>"));
}

/// A reader: whether it takes the bytes.
type Reader = fn(&[u8]) -> bool;

/// Files of formats that have no checksum, and their readers.
fn bare() -> Vec<(Vec<u8>, Reader)> {
    let (mesh, dexels) = (mesh(), dexels());
    let soup = mesh.soup().unwrap();
    let ascii = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\nendsolid a";
    let polygons = b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    vec![
        (written(|file| write_ply(&mesh, file)), |b| read_ply(b).is_ok()),
        (polygons.to_vec(), |b| read_ply(b).is_ok()),
        (written(|file| write_stl(&soup.triangles, file)), |b| {
            parse_stl(b).is_ok()
        }),
        (ascii.to_vec(), |b| parse_stl(b).is_ok()),
        (written(|file| write_vtp(&mesh, file)), |b| read_vtp(b).is_ok()),
        (written(|file| write_dexels_csv(&dexels, file)), |b| {
            read_dexels_csv(b).is_ok()
        }),
        (Fixture::new("job", &dexels, 1e-6).unwrap().text().into_bytes(), |b| {
            std::str::from_utf8(b).is_ok_and(|text| Fixture::parse(text).is_ok())
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]
    /// Cut off, with flipped bits, and with words of its head changed to large numbers: an error or a mesh, never a
    /// panic, and never an allocation that the file does not pay for (the test would be killed).
    #[test]
    fn damage_of_bare_formats_is_no_panic(
        cut in 0.0..1.0_f64,
        flips in collection::vec((0.0..1.0_f64, 0..8_u32), 1..4),
        digits in 0..300_usize,
    ) {
        for (file, read) in bare() {
            prop_assert!(read(&file));
            read(&file[..(file.len() as f64 * cut) as usize]);
            let mut damaged = file.clone();
            for (place, bit) in &flips {
                damaged[(file.len() as f64 * place) as usize] ^= 1 << bit;
            }
            read(&damaged);
            // In the head, where counts and offsets stand: each number in turn is made huge.
            let head = &file[..file.len().min(1500)];
            let numbers: Vec<usize> = (0..head.len()).filter(|k| head[*k].is_ascii_digit()).collect();
            if let Some(at) = numbers.get(digits % numbers.len().max(1)) {
                let mut grown = file[..*at].to_vec();
                grown.extend(b"9999999999");
                grown.extend(&file[*at..]);
                read(&grown);
            }
            let mut grown = file.clone();
            let at = digits % (head.len() - 4);
            grown[at..at + 4].fill(0xFF);
            read(&grown);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]
    #[test]
    fn damage_is_no_panic(place in 0.0..1.0_f64, value in any::<u8>(), cut in 0.0..1.0_f64) {
        let (mesh, dexels) = (mesh(), dexels());
        let files = [
            written(|file| write_dexels_npz(&dexels, file)),
            written(|file| write_3mf(&mesh, file)),
            written(|file| write_glb(&mesh, file)),
        ];
        for (kind, file) in files.iter().enumerate() {
            let part = &file[..(file.len() as f64 * cut) as usize];
            let read = [read_dexels_npz(part).is_ok(), read_3mf(part).is_ok(), read_glb(part).is_ok()];
            prop_assert_eq!(read, [false; 3]);
            let mut damaged = file.clone();
            damaged[(file.len() as f64 * place) as usize] = value;
            match kind {
                0 => prop_assert!(read_dexels_npz(&damaged).is_ok_and(|read| read == dexels) || read_dexels_npz(&damaged).is_err()),
                1 => prop_assert!(read_3mf(&damaged).is_ok_and(|read| read.vertices == mesh.vertices) || read_3mf(&damaged).is_err()),
                // Without a checksum: anything but a panic.
                _ => drop(read_glb(&damaged)),
            }
        }
    }

    #[test]
    fn nonsense_is_an_error(bytes in collection::vec(any::<u8>(), 0..200)) {
        for magic in [&b"PK\x03\x04"[..], b"glTF\x02\0\0\0", b""] {
            let file = [magic, &bytes].concat();
            prop_assert!(read_dexels_npz(&file).is_err() && read_3mf(&file).is_err() && read_glb(&file).is_err());
        }
    }
}

/// A PLY file whose faces or lists are not what its header says: nothing of it is left out.
#[test]
fn what_a_ply_cannot_mean_is_refused() {
    let ply = |count: &str, faces: usize, lines: &str| {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face {faces}\n\
             property list {count} int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n{lines}"
        );
        read_ply(text.as_bytes())
            .map(|mesh| mesh.triangles.len())
            .map_err(|error| error.to_string())
    };
    assert_eq!(ply("uchar", 1, "3 0 1 2\n \n"), Ok(1));
    for (count, faces, lines, message) in [
        (
            "uchar",
            1,
            "3 0 1 2\n3 2 1 0\n",
            "7 bytes follow the data that the header of this PLY announces: expected none",
        ),
        (
            "uchar",
            2,
            "3 0 1 2\n2 0 1\n",
            "face 1 of this PLY has 2 corners: expected at least 3",
        ),
        (
            "char",
            2,
            "3 0 1 2\n-3\n",
            "a list of -3 values in this PLY: expected a whole number from 0 on",
        ),
        (
            "float",
            1,
            "NaN 0 1 2\n",
            "a list of NaN values in this PLY: expected a whole number from 0 on",
        ),
        (
            "float",
            1,
            "3.5 0 1 2\n",
            "a list of 3.5 values in this PLY: expected a whole number from 0 on",
        ),
    ] {
        assert_eq!(ply(count, faces, lines), Err(message.to_owned()), "{lines}");
    }
}

#[test]
fn a_long_line_of_an_stl_is_not_shown_whole() {
    let text = format!(
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3{}\n",
        " 4".repeat(100_000)
    );
    let error = parse_stl(text.as_bytes()).unwrap_err();
    assert!(
        error.to_string().starts_with("4:1: `vertex 1 2 3 4") && error.to_string().len() < 200,
        "{error}"
    );
}
