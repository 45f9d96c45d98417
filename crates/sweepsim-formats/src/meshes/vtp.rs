//! Meshes for ParaView: VTK's XML files of polygons (`.vtp`).

use std::io::{self, Write};

use sweepsim_dexel::Mesh;

use crate::error::{FormatError, Problem};
use crate::vtk::Document;

/// Writes a mesh for ParaView (`.vtp`): exact positions, normals, and flags of vertices that a tool cut.
///
/// # Errors
/// Those of the writer; a triangle with missing vertices.
pub fn write_vtp(mesh: &Mesh, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
    super::check_triangles(mesh)?;
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    let piece = format!(
        "NumberOfPoints=\"{vertices}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{triangles}\""
    );
    let mut document = Document::new("PolyData", &piece);
    document.open("PointData Normals=\"normal\"");
    if mesh.normals.len() == vertices {
        let normals = mesh.normals.iter().flatten().flat_map(|c| c.to_le_bytes());
        document.array("normal", "Float32", 3, normals);
    }
    if mesh.cut.len() == vertices {
        document.array("cut", "UInt8", 1, mesh.cut.iter().map(|cut| u8::from(*cut)));
    }
    document.open("/PointData");
    document.open("Points");
    let places = mesh.vertices.iter().flatten().flat_map(|c| c.to_le_bytes());
    document.array("places", "Float64", 3, places);
    document.open("/Points");
    document.open("Polys");
    let corners = mesh.triangles.iter().flatten();
    document.array(
        "connectivity",
        "Int64",
        1,
        corners.flat_map(|v| i64::from(*v).to_le_bytes()),
    );
    let ends = (1..=triangles).flat_map(|n| (3 * n as i64).to_le_bytes());
    document.array("offsets", "Int64", 1, ends);
    document.open("/Polys");
    document.finish("PolyData", writer)
}

fn problem(message: impl Into<String>) -> FormatError {
    FormatError::new(Problem::syntax(message), None)
}

/// The value of an attribute in a tag.
fn attribute<'a>(tag: &'a str, key: &str) -> Option<&'a str> {
    let start = tag.find(&format!(" {key}=\""))? + key.len() + 3;
    tag[start..].split('"').next()
}

/// The array that a tag describes, with the name of its type.
fn array<'a>(tag: &'a str, data: &'a [u8]) -> Option<(&'a str, &'a [u8])> {
    if attribute(tag, "format") != Some("appended") {
        return None;
    }
    let at: usize = attribute(tag, "offset")?.parse().ok()?;
    let (length, rest) = data.get(at..)?.split_first_chunk::<8>()?;
    let bytes = rest.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    Some((attribute(tag, "type")?, bytes))
}

fn reals((kind, bytes): (&str, &[u8])) -> Option<Vec<f64>> {
    match kind {
        "Float64" => Some(bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect()),
        "Float32" => Some(
            bytes
                .as_chunks()
                .0
                .iter()
                .map(|b| f32::from_le_bytes(*b).into())
                .collect(),
        ),
        _ => None,
    }
}

fn whole((kind, bytes): (&str, &[u8])) -> Option<Vec<i64>> {
    match kind {
        "Int64" => Some(bytes.as_chunks().0.iter().map(|b| i64::from_le_bytes(*b)).collect()),
        "Int32" => Some(
            bytes
                .as_chunks()
                .0
                .iter()
                .map(|b| i32::from_le_bytes(*b).into())
                .collect(),
        ),
        _ => None,
    }
}

/// Reads a `.vtp` with raw appended data, as [`write_vtp`] writes it, and ParaView with `raw` and without compression:
/// one piece, with nothing but triangles.
///
/// # Errors
/// [`FormatError`]: not a VTP file; data elsewhere or compressed; several pieces; polygons that are not triangles;
/// triangles with missing vertices; coordinates that are not finite.
pub fn read_vtp(bytes: &[u8]) -> Result<Mesh, FormatError> {
    const MARK: &[u8] = b"<AppendedData encoding=\"raw\">";
    let wrong = |what: &str| problem(format!("this VTP cannot be read: expected {what}"));
    let end = bytes
        .windows(MARK.len())
        .position(|window| window == MARK)
        .ok_or_else(|| wrong("an XML file with raw appended data"))?;
    let xml = std::str::from_utf8(&bytes[..end]).map_err(|_| wrong("a description in UTF-8"))?;
    let data = bytes[end + MARK.len()..].trim_ascii_start();
    let data = data.strip_prefix(b"_").ok_or_else(|| wrong("`_` before its data"))?;
    let tags = || xml.split('<').skip(1).filter_map(|rest| rest.split('>').next());
    let head = tags().find(|tag| tag.starts_with("VTKFile ")).unwrap_or_default();
    let plain = [
        ("type", "PolyData"),
        ("byte_order", "LittleEndian"),
        ("header_type", "UInt64"),
    ];
    if plain.iter().any(|(key, value)| attribute(head, key) != Some(value)) || attribute(head, "compressor").is_some() {
        return Err(wrong("PolyData, little-endian, lengths of 64 bits, no compression"));
    }
    let mut pieces = tags().filter(|tag| tag.starts_with("Piece "));
    let (Some(piece), None) = (pieces.next(), pieces.next()) else {
        return Err(wrong("one piece"));
    };
    let count = |key: &str| attribute(piece, key).and_then(|n| n.parse::<usize>().ok());
    let (Some(points), Some(polygons)) = (count("NumberOfPoints"), count("NumberOfPolys")) else {
        return Err(wrong("the numbers of points and polygons"));
    };
    // The arrays of a section by name; the array of points may have any name.
    let find = |section: &str, name: Option<&str>| {
        let mut inside = false;
        let tag = tags().find(|tag| {
            if tag.split_whitespace().next() == Some(section) {
                inside = true;
            } else if tag.strip_prefix('/') == Some(section) {
                inside = false;
            }
            inside && tag.starts_with("DataArray ") && name.is_none_or(|name| attribute(tag, "Name") == Some(name))
        })?;
        array(tag, data)
    };
    let places = find("Points", None).and_then(reals).ok_or_else(|| wrong("points"))?;
    let corners = find("Polys", Some("connectivity")).and_then(whole);
    let ends = find("Polys", Some("offsets")).and_then(whole);
    let (Some(corners), Some(ends)) = (corners, ends) else {
        return Err(wrong("the corners of polygons"));
    };
    let triangles = ends.iter().enumerate().all(|(k, end)| *end == 3 * (k as i64 + 1));
    let lengths = [Some(places.len()), Some(corners.len()), Some(ends.len())];
    if !triangles || lengths != [points.checked_mul(3), polygons.checked_mul(3), Some(polygons)] {
        return Err(wrong("only triangles, as many as it says"));
    }
    if !places.iter().all(|c| c.is_finite()) {
        return Err(problem("a point of this VTP is not finite"));
    }
    let known = |v: i64| u32::try_from(v).ok().filter(|v| (*v as usize) < points);
    let triangles = corners.as_chunks::<3>().0.iter().map(|t| {
        let [a, b, c] = t.map(known);
        Some([a?, b?, c?])
    });
    let triangles: Option<Vec<[u32; 3]>> = triangles.collect();
    let mut mesh = Mesh {
        vertices: places.as_chunks::<3>().0.to_vec(),
        triangles: triangles.ok_or_else(|| problem("a triangle of this VTP names a point that it does not have"))?,
        ..Mesh::default()
    };
    if let Some(normals) = find("PointData", Some("normal")).and_then(reals)
        && normals.len() == 3 * points
    {
        let normals = normals.as_chunks::<3>().0.iter();
        mesh.normals = normals.map(|n| n.map(|c| c as f32)).collect();
    }
    if let Some(("UInt8", cut)) = find("PointData", Some("cut"))
        && cut.len() == points
    {
        mesh.cut = cut.iter().map(|cut| *cut != 0).collect();
    }
    Ok(mesh)
}
