//! Formats of other programs: what is written is read; damage is an error, or changes nothing that is read.

use proptest::prelude::*;
use sweepsim_dexel::{Dexels, Grid, Interval, Mesh, Source, Stock, TriDexels};
use sweepsim_formats::{read_3mf, read_dexels_npz, read_glb, write_3mf, write_dexels_npz, write_glb};

fn mesh() -> Mesh {
    let ball = Stock::Ball {
        centre: [0.3, -0.2, 0.1],
        radius: 3.0,
    };
    TriDexels::new([-4.0; 3], [4.0; 3], [7; 3], &ball).unwrap().surface()
}

fn dexels() -> Dexels {
    let grid = Grid::new([0.0; 2], [7.0, 9.0], [7, 9]).unwrap();
    Dexels::from_fn(grid, |index, line| {
        for k in 0..index % 4 {
            let mut interval = Interval::between(k as f64 + 0.1, k as f64 + 0.9);
            interval.upper.normal = [0.6, 0.0, 0.8];
            interval.upper.source = Source {
                path: 3,
                segment: index as u32,
                t: 0.25,
            };
            line.push(interval);
        }
    })
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
    let model = read_3mf(&written(|file| write_3mf(&mesh, file))).unwrap();
    assert_eq!((&model.vertices, &model.triangles), (&mesh.vertices, &mesh.triangles));
    let seen = read_glb(&written(|file| write_glb(&mesh, file))).unwrap();
    assert_eq!((&seen.normals, &seen.triangles), (&mesh.normals, &mesh.triangles));
    let rounded: Vec<[f64; 3]> = mesh.vertices.iter().map(|v| v.map(|c| f64::from(c as f32))).collect();
    assert_eq!(seen.vertices, rounded);
    let bad = Mesh {
        triangles: vec![[0, 1, 9]],
        ..Mesh::default()
    };
    assert!(write_glb(&bad, &mut Vec::new()).is_err() && write_3mf(&bad, &mut Vec::new()).is_err());
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
    fn nonsense_is_an_error(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        for magic in [&b"PK\x03\x04"[..], b"glTF\x02\0\0\0", b""] {
            let file = [magic, &bytes].concat();
            prop_assert!(read_dexels_npz(&file).is_err() && read_3mf(&file).is_err() && read_glb(&file).is_err());
        }
    }
}
