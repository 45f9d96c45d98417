//! GLB: glTF 2.0 in one file, for viewers.
//!
//! Positions and normals are `f32`. The mesh keeps its coordinates; its node turns z up and scales millimetres to
//! metres, as glTF requires.

use std::io::{self, Write};

use serde_json::{Value, json};
use sweepsim_dexel::Mesh;

use super::colours::{Colour, Colours};
use crate::error::{FormatError, Problem};

const FLOAT: u64 = 5126;
const U32: u64 = 5125;

/// Writes a mesh.
///
/// # Errors
/// Those of the writer; a mesh without triangles, triangles with missing vertices, more than 4 GiB.
pub fn write_glb(mesh: &Mesh, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let invalid = |message| io::Error::new(io::ErrorKind::InvalidInput, message);
    let count = mesh.vertices.len();
    super::check_triangles(mesh)?;
    if mesh.triangles.is_empty() {
        return Err(invalid("a mesh without triangles, which glTF does not allow"));
    }
    let places = || mesh.vertices.iter().map(|v| v.map(|c| c as f32));
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for place in places() {
        for k in 0..3 {
            (low[k], high[k]) = (low[k].min(place[k]), high[k].max(place[k]));
        }
    }
    if !low.iter().chain(&high).all(|c| c.is_finite()) {
        return Err(invalid("vertices that are not finite"));
    }
    let mut data: Vec<u8> = places().flatten().flat_map(f32::to_le_bytes).collect();
    let with_normals = mesh.normals.len() == count;
    let mut views = vec![json!({"buffer": 0, "byteOffset": 0, "byteLength": 12 * count, "target": 34962})];
    let mut accessors =
        vec![json!({"bufferView": 0, "componentType": FLOAT, "count": count, "type": "VEC3", "min": low, "max": high})];
    let mut attributes = json!({"POSITION": 0});
    if with_normals {
        views.push(json!({"buffer": 0, "byteOffset": data.len(), "byteLength": 12 * count, "target": 34962}));
        accessors.push(json!({"bufferView": 1, "componentType": FLOAT, "count": count, "type": "VEC3"}));
        attributes["NORMAL"] = json!(1);
        data.extend(mesh.normals.iter().flatten().flat_map(|c| c.to_le_bytes()));
    }
    let (indices, size) = (3 * mesh.triangles.len(), 12 * mesh.triangles.len());
    views.push(json!({"buffer": 0, "byteOffset": data.len(), "byteLength": size, "target": 34963}));
    accessors.push(json!({"bufferView": views.len() - 1, "componentType": U32, "count": indices, "type": "SCALAR"}));
    data.extend(mesh.triangles.iter().flatten().flat_map(|v| v.to_le_bytes()));
    let half = 0.5_f64.sqrt();
    let primitive = json!({"attributes": attributes, "indices": accessors.len() - 1, "mode": 4});
    let document = json!({
        "asset": {"version": "2.0", "generator": "sweepsim"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "rotation": [-half, 0.0, 0.0, half], "scale": [0.001, 0.001, 0.001]}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": data.len()}],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let size = |bytes: usize| u32::try_from(bytes).map_err(|_| invalid("more than 4 GiB do not fit into GLB"));
    writer.write_all(b"glTF\x02\0\0\0")?;
    writer.write_all(&size(28 + text.len() + data.len())?.to_le_bytes())?;
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &data)] {
        writer.write_all(&size(chunk.len())?.to_le_bytes())?;
        writer.write_all(kind)?;
        writer.write_all(chunk)?;
    }
    Ok(())
}

fn problem(message: impl Into<String>) -> FormatError {
    FormatError::new(Problem::syntax(message), None)
}

/// The next chunk, if it is of this kind.
fn chunk<'a>(bytes: &mut &'a [u8], kind: &[u8; 4]) -> Option<&'a [u8]> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let (content, after) = rest
        .strip_prefix(kind)?
        .split_at_checked(u32::from_le_bytes(*length) as usize)?;
    *bytes = after;
    Some(content)
}

/// Reads the triangles of all meshes of a file as one mesh, each in its own coordinates.
///
/// # Errors
/// [`FormatError`]: not a GLB file, or a truncated one; a mesh that is not made of triangles, or whose data are not in
/// the file.
pub fn read_glb(bytes: &[u8]) -> Result<Mesh, FormatError> {
    coloured_glb(bytes).map(|(mesh, _)| mesh)
}

/// Reads a mesh with the colour of each triangle: the base colour of its material.
pub(crate) fn coloured_glb(bytes: &[u8]) -> Result<(Mesh, Colours), FormatError> {
    let mut rest = bytes
        .strip_prefix(b"glTF\x02\0\0\0")
        .and_then(|rest| rest.get(4..))
        .ok_or_else(|| problem("this is not a GLB file: expected `glTF` and version 2 at its beginning"))?;
    let cut_off = || problem("this GLB is damaged or truncated");
    let text = chunk(&mut rest, b"JSON").ok_or_else(cut_off)?;
    let data = chunk(&mut rest, b"BIN\0").ok_or_else(cut_off)?;
    let document: Value =
        serde_json::from_slice(text).map_err(|error| problem(format!("the description in this GLB: {error}")))?;
    let (mut mesh, mut colours) = (Mesh::default(), Colours::new());
    let mut bare = false;
    for primitive in list(&document["meshes"])
        .iter()
        .flat_map(|mesh| list(&mesh["primitives"]))
    {
        let wrong = || {
            problem("a mesh of this GLB is not made of triangles, or its positions and indices are not in this file")
        };
        if primitive["mode"].as_u64().unwrap_or(4) != 4 {
            return Err(wrong());
        }
        let read = |which: &Value, width: usize| numbers(&document, data, which, width);
        let places = read(&primitive["attributes"]["POSITION"], 3).ok_or_else(wrong)?;
        let first = mesh.vertices.len();
        mesh.vertices.extend(places.as_chunks::<3>().0);
        super::check_count(mesh.vertices.len())?;
        match read(&primitive["attributes"]["NORMAL"], 3) {
            Some(normals) if normals.len() == places.len() => {
                mesh.normals
                    .extend(normals.as_chunks::<3>().0.iter().map(|n| n.map(|c| c as f32)));
            }
            _ => bare = true,
        }
        let colour = base_colour(&document, &primitive["material"]);
        let corners = read(&primitive["indices"], 1).ok_or_else(wrong)?;
        for corners in corners.as_chunks::<3>().0 {
            if corners.iter().any(|v| *v as usize >= places.len() / 3) {
                return Err(wrong());
            }
            // Indices are `u32`; more vertices than they can number are an error above.
            mesh.triangles.push(corners.map(|v| (first + v as usize) as u32));
            colours.push(colour);
        }
    }
    if bare {
        mesh.normals.clear();
    }
    if !mesh.vertices.iter().flatten().all(|c| c.is_finite()) {
        return Err(problem("a vertex of this GLB is not finite"));
    }
    Ok((mesh, colours))
}

/// The base colour of a material, from linear light to sRGB (IEC 61966-2-1), as it is shown on screens.
fn base_colour(document: &Value, material: &Value) -> Option<Colour> {
    let material = list(&document["materials"]).get(material.as_u64()? as usize)?;
    let factors = list(&material["pbrMetallicRoughness"]["baseColorFactor"]);
    let channel = |k: usize| {
        let linear = factors.get(k)?.as_f64()?;
        let curved = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        Some((255.0 * curved).round() as u8)
    };
    Some([channel(0)?, channel(1)?, channel(2)?])
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// The numbers of an accessor, `width` per element.
fn numbers(document: &Value, data: &[u8], which: &Value, width: usize) -> Option<Vec<f64>> {
    let accessor = list(&document["accessors"]).get(which.as_u64()? as usize)?;
    let view = list(&document["bufferViews"]).get(accessor["bufferView"].as_u64()? as usize)?;
    let whole = |value: &Value| usize::try_from(value.as_u64().unwrap_or(0)).ok();
    let kind = accessor["componentType"].as_u64()?;
    let (size, name) = match (kind, width) {
        (FLOAT, 3) => (4, "VEC3"),
        (U32, 1) => (4, "SCALAR"),
        (5123, 1) => (2, "SCALAR"),
        (5121, 1) => (1, "SCALAR"),
        _ => return None,
    };
    if accessor["type"] != name || view["buffer"].as_u64() != Some(0) || !accessor["sparse"].is_null() {
        return None;
    }
    let from = whole(&view["byteOffset"])?;
    let view_data = data.get(from..from.checked_add(whole(&view["byteLength"])?)?)?;
    let view_data = view_data.get(whole(&accessor["byteOffset"])?..)?;
    let count = whole(&accessor["count"])?;
    let stride = match whole(&view["byteStride"])? {
        0 => size * width,
        stride => stride,
    };
    // The last element need not fill its stride.
    let needed = count.checked_sub(1)?.checked_mul(stride)?.checked_add(size * width)?;
    if needed > view_data.len() || stride < size * width {
        return None;
    }
    let elements = (0..count).flat_map(|n| view_data[n * stride..n * stride + size * width].chunks_exact(size));
    Some(
        elements
            .map(|b| match *b {
                [a, b, c, d] if kind == FLOAT => f32::from_le_bytes([a, b, c, d]).into(),
                [a, b, c, d] => u32::from_le_bytes([a, b, c, d]).into(),
                [a, b] => u16::from_le_bytes([a, b]).into(),
                _ => b.first().copied().unwrap_or(0).into(),
            })
            .collect(),
    )
}
