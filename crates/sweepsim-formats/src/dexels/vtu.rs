//! Dexels for ParaView: VTK's XML files of cells (`.vtu`).

use std::io::{self, Write};

use sweepsim_dexel::{Dexels, End};

use super::binary::{has_wide_paths, source_numbers};
use crate::vtk::Document;

/// VTK's number for a line.
const LINE: u8 = 3;

/// Writes dexels for ParaView (`.vtu`): each interval is a line, with its cell `i`, `j`; its ends have `normal`, `path`
/// (65535 for no tool, 4294967295 where there are more paths), `segment` and `t`.
///
/// # Errors
/// Those of the writer.
pub fn write_dexels_vtu(dexels: &Dexels, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let grid = dexels.grid();
    let count = dexels.count();
    let lines = || {
        dexels
            .iter()
            .flat_map(|(index, line)| line.iter().map(move |_| grid.place(index)))
    };
    let ends = || {
        dexels.iter().flat_map(|(index, line)| {
            let (i, j) = grid.place(index);
            let both = line.iter().flat_map(|interval| [interval.lower, interval.upper]);
            both.map(move |end| (grid.frame().to_world([grid.x(i), grid.y(j), end.z]), end))
        })
    };
    let of_ends = |bytes: fn(&End) -> Vec<u8>| ends().flat_map(move |(_, end)| bytes(&end));
    let piece = format!("NumberOfPoints=\"{}\" NumberOfCells=\"{count}\"", 2 * count);
    let mut document = Document::new("UnstructuredGrid", &piece);
    document.open("PointData Normals=\"normal\"");
    let world = |end: &End| grid.frame().turn_to_world(end.normal.map(f64::from)).map(|c| c as f32);
    let normals = ends().flat_map(|(_, end)| world(&end)).flat_map(f32::to_le_bytes);
    document.array("normal", "Float32", 3, normals);
    if has_wide_paths(dexels) {
        let path = |end: &End| source_numbers(end.source).0.to_le_bytes().into();
        document.array("path", "UInt32", 1, of_ends(path));
    } else {
        let path = |end: &End| (source_numbers(end.source).0 as u16).to_le_bytes().into();
        document.array("path", "UInt16", 1, of_ends(path));
    }
    document.array(
        "segment",
        "UInt32",
        1,
        of_ends(|end| source_numbers(end.source).1.to_le_bytes().into()),
    );
    document.array(
        "t",
        "Float32",
        1,
        of_ends(|end| source_numbers(end.source).2.to_le_bytes().into()),
    );
    document.open("/PointData");
    document.open("CellData");
    document.array("i", "UInt32", 1, lines().flat_map(|(i, _)| (i as u32).to_le_bytes()));
    document.array("j", "UInt32", 1, lines().flat_map(|(_, j)| (j as u32).to_le_bytes()));
    document.open("/CellData");
    document.open("Points");
    let places = ends().flat_map(|(place, _)| place).flat_map(f64::to_le_bytes);
    document.array("places", "Float64", 3, places);
    document.open("/Points");
    document.open("Cells");
    let corners = (0..2 * count as i64).flat_map(i64::to_le_bytes);
    document.array("connectivity", "Int64", 1, corners);
    let offsets = (1..=count as i64).flat_map(|n| (2 * n).to_le_bytes());
    document.array("offsets", "Int64", 1, offsets);
    document.array("types", "UInt8", 1, std::iter::repeat_n(LINE, count));
    document.open("/Cells");
    document.finish("UnstructuredGrid", writer)
}
