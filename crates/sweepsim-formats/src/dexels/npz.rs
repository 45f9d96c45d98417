//! Dexels as NumPy arrays (`.npz`).
//!
//! | array | shape and type | content |
//! | --- | --- | --- |
//! | `area` | (2, 2) `<f8` | min x, y; max x, y |
//! | `cells` | (2,) `<u8` | cells in x and y |
//! | `frame` | (4, 3) `<f8` | only if the grid has a frame: its origin and its axes x, y, z in world coordinates |
//! | `line` | (n,) `<u4` | the line of each interval, `i · cells[1] + j`, never less than the one before |
//! | `z` | (n, 2) `<f8` | the ends of each interval |
//! | `normal` | (n, 2, 3) `<f4` | their normals |
//! | `path`, `segment`, `t` | (n, 2) `<u2`, `<u4`, `<f4` | their sources: path 65535 for no tool; with more paths, `path` is `<u4` and 4294967295 stands for no tool |

use std::io::Write;

use sweepsim_dexel::{Dexels, DexelsBuilder, End, Grid, Interval, Source};

use super::binary::{framed_numbers, has_wide_paths, in_frame, source_numbers};
use crate::archive::{self, Archive};
use crate::error::{FormatError, Problem};

/// The most dexels that are read: each takes an eighth of a byte, even if the file has no intervals.
const MOST: usize = 1 << 30;

fn npy(kind: &str, shape: &[usize], data: impl IntoIterator<Item = u8>) -> Vec<u8> {
    let list: String = shape.iter().map(|n| format!("{n},")).collect();
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({list}), }}");
    // The data must begin at a multiple of 64.
    while (header.len() + 11) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

/// Writes dexels as NumPy arrays: `numpy.load(file)["z"]` are the ends of all intervals.
///
/// # Errors
/// Those of the writer; a path numbered `u32::MAX`.
pub fn write_dexels_npz(dexels: &Dexels, writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
    let grid = dexels.grid();
    let intervals = || {
        dexels
            .iter()
            .flat_map(|(line, intervals)| intervals.iter().map(move |i| (line, i)))
    };
    let ends = || intervals().flat_map(|(_, i)| [i.lower, i.upper]);
    let n = dexels.count();
    let area = grid.min().into_iter().chain(grid.max()).flat_map(f64::to_le_bytes);
    let cells = grid.cells().into_iter().flat_map(|n| (n as u64).to_le_bytes());
    let frame = framed_numbers(grid.frame()).flat_map(f64::to_le_bytes);
    let frame = ("frame.npy", npy("<f8", &[4, 3], frame));
    let sources = || ends().map(|end| source_numbers(end.source));
    let paths = if has_wide_paths(dexels) {
        if dexels.highest_path() == Some(u32::MAX) {
            let message = "NumPy arrays have no room for a path with the number 4294967295";
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, message));
        }
        npy("<u4", &[n, 2], sources().flat_map(|(path, ..)| path.to_le_bytes()))
    } else {
        // The stock's number keeps its lower half.
        npy(
            "<u2",
            &[n, 2],
            sources().flat_map(|(path, ..)| (path as u16).to_le_bytes()),
        )
    };
    let mut entries = vec![
        ("area.npy", npy("<f8", &[2, 2], area)),
        ("cells.npy", npy("<u8", &[2], cells)),
        (
            "line.npy",
            npy(
                "<u4",
                &[n],
                intervals().flat_map(|(line, _)| (line as u32).to_le_bytes()),
            ),
        ),
        ("z.npy", npy("<f8", &[n, 2], ends().flat_map(|e| e.z.to_le_bytes()))),
        (
            "normal.npy",
            npy(
                "<f4",
                &[n, 2, 3],
                ends().flat_map(|e| e.normal).flat_map(f32::to_le_bytes),
            ),
        ),
        ("path.npy", paths),
        (
            "segment.npy",
            npy(
                "<u4",
                &[n, 2],
                sources().flat_map(|(_, segment, _)| segment.to_le_bytes()),
            ),
        ),
        (
            "t.npy",
            npy("<f4", &[n, 2], sources().flat_map(|(_, _, t)| t.to_le_bytes())),
        ),
    ];
    if !grid.frame().is_world() {
        entries.push(frame);
    }
    archive::write(&entries, writer)
}

fn problem(message: String) -> FormatError {
    FormatError::new(Problem::syntax(message), None)
}

/// The numbers of an array, whose type has `N` bytes and whose rows have the shape `row`.
fn array<const N: usize>(
    archive: &mut Archive<'_>,
    name: &str,
    kind: &str,
    row: &[usize],
) -> Result<Vec<[u8; N]>, FormatError> {
    let bytes = archive.entry(&format!("{name}.npy"))?;
    let wrong = || {
        let row: String = row.iter().map(|n| format!(", {n}")).collect();
        problem(format!(
            "the array `{name}` must have the type {kind} and the shape (n{row})"
        ))
    };
    let rest = bytes.strip_prefix(b"\x93NUMPY\x01\x00").ok_or_else(wrong)?;
    let (length, rest) = rest.split_first_chunk::<2>().ok_or_else(wrong)?;
    let (header, data) = rest
        .split_at_checked(u16::from_le_bytes(*length).into())
        .ok_or_else(wrong)?;
    let header: String = String::from_utf8_lossy(header).split_whitespace().collect();
    let shape = header
        .strip_prefix(&format!("{{'descr':'{kind}','fortran_order':False,'shape':("))
        .and_then(|rest| rest.split(')').next())
        .ok_or_else(wrong)?;
    let shape: Result<Vec<usize>, _> = shape
        .split(',')
        .filter(|word| !word.is_empty())
        .map(str::parse)
        .collect();
    let (numbers, tail) = data.as_chunks::<N>();
    match shape.as_deref() {
        Ok([n, rest @ ..])
            if rest == row
                && tail.is_empty()
                && row.iter().try_fold(*n, |all, k| all.checked_mul(*k)) == Some(numbers.len()) =>
        {
            Ok(numbers.to_vec())
        }
        _ => Err(wrong()),
    }
}

/// Reads dexels that [`write_dexels_npz`] wrote, or `numpy.savez` or `numpy.savez_compressed` with the same arrays.
///
/// # Errors
/// [`FormatError`]: not an archive, arrays of other types or shapes, intervals out of order.
pub fn read_dexels_npz(bytes: &[u8]) -> Result<Dexels, FormatError> {
    let mut archive = Archive::read(bytes)?;
    let area: Vec<f64> = array(&mut archive, "area", "<f8", &[2])?
        .iter()
        .map(|b| f64::from_le_bytes(*b))
        .collect();
    let cells: Vec<usize> = array(&mut archive, "cells", "<u8", &[])?
        .iter()
        .map(|b| usize::try_from(u64::from_le_bytes(*b)).unwrap_or(usize::MAX))
        .collect();
    let (&[x0, y0, x1, y1], &[nx, ny]) = (&area[..], &cells[..]) else {
        return Err(problem(
            "the arrays `area` and `cells` have other shapes than (2, 2) and (2,)".to_owned(),
        ));
    };
    let grid = Grid::new([x0, y0], [x1, y1], [nx, ny]).map_err(|error| FormatError::new(Problem::Grid(error), None))?;
    let grid = if archive.has("frame.npy") {
        in_frame(grid, &array(&mut archive, "frame", "<f8", &[3])?)?
    } else {
        grid
    };
    if grid.len() > MOST {
        return Err(problem(format!(
            "{} dexels are too many: expected at most {MOST}",
            grid.len()
        )));
    }
    let lines = array::<4>(&mut archive, "line", "<u4", &[])?;
    let z = array::<8>(&mut archive, "z", "<f8", &[2])?;
    let normals = array::<4>(&mut archive, "normal", "<f4", &[2, 3])?;
    let narrow = array::<2>(&mut archive, "path", "<u2", &[2]).map(|paths| {
        let number = |path: &[u8; 2]| Some(u16::from_le_bytes(*path)).filter(|path| *path < u16::MAX);
        paths.iter().map(|path| number(path).map(u32::from)).collect()
    });
    let paths: Vec<Option<u32>> = match narrow {
        Ok(paths) => paths,
        Err(error) => match array::<4>(&mut archive, "path", "<u4", &[2]) {
            Ok(paths) => {
                let number = |path: &[u8; 4]| Some(u32::from_le_bytes(*path)).filter(|path| *path < u32::MAX);
                paths.iter().map(number).collect()
            }
            Err(_) => return Err(error),
        },
    };
    let segments = array::<4>(&mut archive, "segment", "<u4", &[2])?;
    let times = array::<4>(&mut archive, "t", "<f4", &[2])?;
    if [z.len(), normals.len() / 3, paths.len(), segments.len(), times.len()] != [2 * lines.len(); 5] {
        return Err(problem("the arrays of this file have different lengths".to_owned()));
    }
    let end = |k: usize| End {
        z: f64::from_le_bytes(z[k]),
        normal: [0, 1, 2].map(|c| f32::from_le_bytes(normals[3 * k + c])),
        source: paths[k].map_or(Source::Stock, |path| Source::Cut {
            path,
            segment: u32::from_le_bytes(segments[k]),
            t: f32::from_le_bytes(times[k]),
        }),
    };
    let mut builder = DexelsBuilder::new(grid);
    let mut line: Vec<Interval> = Vec::new();
    for k in 0..lines.len() {
        let (number, next) = (u32::from_le_bytes(lines[k]) as usize, lines.get(k + 1));
        let interval = Interval {
            lower: end(2 * k),
            upper: end(2 * k + 1),
        };
        let above = line.last().is_none_or(|last| last.upper.z < interval.lower.z);
        let whole = interval.lower.z < interval.upper.z;
        if number >= grid.len() || number < builder.lines() || !above || !whole {
            return Err(problem(format!(
                "interval {k} (from 0) is out of order, empty, or not on the grid"
            )));
        }
        line.push(interval);
        if next.is_none_or(|next| u32::from_le_bytes(*next) as usize != number) {
            builder.skip(number - builder.lines());
            builder.push(&line).map_err(|error| problem(error.to_string()))?;
            line.clear();
        }
    }
    Ok(builder.finish())
}
