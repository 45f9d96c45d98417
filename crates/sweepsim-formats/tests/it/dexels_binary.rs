//! The binary form of dexels: what is written is read, and nothing else.

use sweepsim_dexel::{Dexels, Frame, Grid, Interval, Source};
use sweepsim_formats::{read_dexels_binary, read_dexels_npz, write_dexels_binary, write_dexels_npz};
use sweepsim_props::*;

/// Any dexels on a few hundred lines.
fn dexels() -> impl Strategy<Value = Dexels> {
    let gap = prop_oneof![Just(1.0), 1e-9..10.0_f64];
    let piece = (
        gap.clone(),
        gap,
        [-1.0..1.0_f32, -1.0..1.0, -1.0..1.0],
        0..9_u32,
        0.0..=1.0_f32,
    );
    let line = prop_oneof![3 => Just(Vec::new()), 2 => collection::vec(piece, 1..5)];
    let vector = || [-9.0..9.0_f64, -9.0..9.0, -9.0..9.0];
    let frame = (vector(), vector(), vector()).prop_map(|(o, z, x)| Frame::new(o, z, x).unwrap_or_default());
    let frame = prop_oneof![Just(Frame::WORLD), frame];
    (1..30_usize, collection::vec(line, 1..20), frame).prop_map(|(columns, lines, frame)| {
        let rows = lines.len();
        let grid = Grid::new([-1.0, 0.5], [1.0, 2.5], [columns, rows])
            .unwrap()
            .in_frame(frame);
        Dexels::from_fn(grid, |index, out| {
            let mut z = -3.0;
            for (gap, length, normal, segment, t) in &lines[index % rows] {
                let mut interval = Interval::between(z + gap, z + gap + length);
                z = interval.upper.z;
                if *segment > 2 {
                    interval.upper.normal = *normal;
                    let segment = segment * 1000 + (index % 7) as u32;
                    interval.upper.source = Source::Cut {
                        path: 2,
                        segment,
                        t: *t,
                    };
                }
                out.push(interval);
            }
        })
        .unwrap()
    })
}

fn written(dexels: &Dexels) -> Vec<u8> {
    let mut file = Vec::new();
    write_dexels_binary(dexels, &mut file).unwrap();
    file
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]
    #[test]
    fn what_is_written_is_read(dexels in dexels(), tail in collection::vec(any::<u8>(), 0..4)) {
        let mut file = written(&dexels);
        let length = file.len();
        file.extend(&tail);
        let mut reader = &file[..];
        let read = read_dexels_binary(&mut reader).unwrap();
        prop_assert_eq!(&read, &dexels);
        prop_assert_eq!(reader.len(), tail.len());
        prop_assert_eq!(written(&read), &file[..length]);
    }

    #[test]
    fn cut_off_anywhere_is_an_error(dexels in dexels(), part in 0.0..1.0_f64) {
        let file = written(&dexels);
        let length = (file.len() as f64 * part) as usize;
        let error = read_dexels_binary(&mut &file[..length]).unwrap_err().to_string();
        prop_assert!(error.contains("truncated") || length < 70 + 96, "{}", error);
    }

    #[test]
    fn a_flipped_bit_is_found(dexels in dexels(), part in 0.0..1.0_f64, bit in 0..8_u32) {
        let mut file = written(&dexels);
        let place = (file.len() as f64 * part) as usize;
        file[place] ^= 1_u8 << bit;
        prop_assert!(read_dexels_binary(&mut &file[..]).is_err());
    }

    /// Blocks of anything with checksums that are right.
    #[test]
    fn nonsense_is_an_error_at_most(
        cells in [0..1_u64 << 40, 0..1_u64 << 40],
        first in prop_oneof![Just(0), Just(u64::MAX), any::<u64>()],
        lines in prop_oneof![0..5000_u32, any::<u32>()],
        length in prop_oneof![Just(None), any::<u32>().prop_map(Some)],
        payload in collection::vec(prop_oneof![0..4_u8, any::<u8>()], 0..300),
        small in any::<bool>(),
    ) {
        let cells = if small { [64, 64] } else { cells };
        let mut header = b"sweepdxl\x01\0\0\0\0\0\0\0".to_vec();
        for number in [0.0, 0.0, 1.0, 1.0_f64] {
            header.extend(number.to_le_bytes());
        }
        cells.iter().for_each(|number| header.extend(number.to_le_bytes()));
        let mut block = first.to_le_bytes().to_vec();
        block.extend(lines.to_le_bytes());
        block.extend(length.unwrap_or(payload.len() as u32).to_le_bytes());
        block.extend(&payload);
        let mut file = header.clone();
        file.extend(crc32(&header).to_le_bytes());
        file.extend(&block);
        file.extend(crc32(&block).to_le_bytes());
        prop_assert!(read_dexels_binary(&mut &file[..]).is_err());
        prop_assert!(read_dexels_binary(&mut &payload[..]).is_err());
    }
}

/// The slow way, so that the fast one is checked.
fn crc32(bytes: &[u8]) -> u32 {
    let mut rest = u32::MAX;
    for byte in bytes {
        rest ^= u32::from(*byte);
        for _ in 0..8 {
            rest = if rest & 1 == 1 {
                rest >> 1 ^ 0xEDB8_8320
            } else {
                rest >> 1
            };
        }
    }
    !rest
}

#[test]
fn other_files_and_versions_are_named() {
    let grid = Grid::new([0.0; 2], [1.0; 2], [2, 2]).unwrap();
    let mut file = written(&Dexels::empty(grid));
    let error = |file: &[u8]| read_dexels_binary(&mut &*file).unwrap_err().to_string();
    assert!(error(b"i,j,z0,z1\n").contains("not a dexel file"));
    assert!(error(&[b'x'; 100]).contains("not a dexel file"));
    file[8] = 7;
    assert_eq!(error(&file), "the version of this file is 7, but must be 1 or 2");
}

#[test]
fn large_dexels_have_many_blocks() {
    let grid = Grid::new([0.0; 2], [1.0; 2], [300, 300]).unwrap();
    let slope = Dexels::from_fn(grid, |index, line| {
        let (i, j) = grid.place(index);
        for k in 0..(i + j) % 4 {
            let z = (i as f64).sqrt() + k as f64;
            line.push(Interval::between(z, z + 0.4 + (j as f64).sin() * 0.1));
        }
    })
    .unwrap();
    let file = written(&slope);
    assert!(file.len() < 20 * slope.count(), "{} bytes", file.len());
    assert_eq!(read_dexels_binary(&mut &file[..]).unwrap(), slope);
}

/// Cuts of paths with these numbers on four lines each, and stock beside them.
fn cut_by(paths: &[u32]) -> Dexels {
    let grid = Grid::new([0.0; 2], [paths.len() as f64, 4.0], [paths.len(), 4]).unwrap();
    Dexels::from_fn(grid, |index, out| {
        let (i, j) = grid.place(index);
        let path = paths[i];
        let mut interval = Interval::between(0.0, 1.0 + j as f64);
        // The second one once looked like the stock.
        interval.upper.source = Source::Cut {
            path,
            segment: j as u32,
            t: 0.25 * j as f32,
        };
        out.push(interval);
    })
    .unwrap()
}

#[test]
fn every_number_of_a_path_is_read_again() {
    let version = |file: &[u8]| u32::from_le_bytes([file[8], file[9], file[10], file[11]]);
    for (paths, expected) in [
        (vec![0, 1, 65_533, 65_534], 1),
        (vec![65_534, 65_535, 65_536, 100_000], 2),
        (vec![u32::MAX - 1, u32::MAX], 2),
    ] {
        let dexels = cut_by(&paths);
        assert_eq!(dexels.highest_path(), paths.iter().copied().max());
        let mut file = Vec::new();
        write_dexels_binary(&dexels, &mut file).unwrap();
        assert_eq!(version(&file), expected, "{paths:?}");
        assert_eq!(read_dexels_binary(&mut file.as_slice()).unwrap(), dexels, "{paths:?}");
        let mut arrays = Vec::new();
        if paths.contains(&u32::MAX) {
            assert!(write_dexels_npz(&dexels, &mut arrays).is_err());
        } else {
            write_dexels_npz(&dexels, &mut arrays).unwrap();
            assert_eq!(read_dexels_npz(&arrays).unwrap(), dexels, "{paths:?}");
        }
    }
}
