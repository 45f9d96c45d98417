//! PLY: vertices with normals and a flag for those that a tool cut, and triangles.
//!
//! Written as binary little-endian; positions are `double`, so that a mesh is read back exactly, and normals are
//! `float`. The reader also accepts the other usual forms: ASCII or binary of either byte order, further elements and
//! properties, polygons.

use std::io::Write;

use sweepsim_dexel::Mesh;

use super::colours::{Colour, Colours};
use crate::error::{FormatError, Problem};

/// Writes a mesh.
///
/// # Errors
/// Those of the writer; a triangle with missing vertices.
pub fn write_ply(mesh: &Mesh, writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
    super::check_triangles(mesh)?;
    let with_normals = mesh.normals.len() == mesh.vertices.len();
    let with_cut = mesh.cut.len() == mesh.vertices.len();
    write!(
        writer,
        "ply\nformat binary_little_endian 1.0\ncomment lengths in mm\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\n",
        mesh.vertices.len()
    )?;
    if with_normals {
        writer.write_all(b"property float nx\nproperty float ny\nproperty float nz\n")?;
    }
    if with_cut {
        writer.write_all(b"property uchar cut\n")?;
    }
    write!(
        writer,
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.triangles.len()
    )?;
    for (index, vertex) in mesh.vertices.iter().enumerate() {
        for coordinate in vertex {
            writer.write_all(&coordinate.to_le_bytes())?;
        }
        if with_normals {
            for coordinate in mesh.normals[index] {
                writer.write_all(&coordinate.to_le_bytes())?;
            }
        }
        if with_cut {
            writer.write_all(&[u8::from(mesh.cut[index])])?;
        }
    }
    for triangle in &mesh.triangles {
        writer.write_all(&[3])?;
        for corner in triangle {
            writer.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}

/// The scalar types of PLY.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The value of little-endian bytes: as many as `size`, then zeros.
    fn value(self, b: [u8; 8]) -> f64 {
        match self {
            Self::I8 => f64::from(b[0] as i8),
            Self::U8 => f64::from(b[0]),
            Self::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Self::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Self::I32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F64 => f64::from_le_bytes(b),
        }
    }
}

struct Property {
    name: String,
    scalar: Scalar,
    /// The type of a list's count.
    count: Option<Scalar>,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

fn fail<T>(message: impl Into<String>) -> Result<T, FormatError> {
    Err(FormatError::new(Problem::syntax(message), None))
}

/// The rest of the body of a file.
struct Body<'a> {
    bytes: &'a [u8],
    ascii: bool,
    big_endian: bool,
}

impl Body<'_> {
    fn number(&mut self, scalar: Scalar) -> Result<f64, FormatError> {
        if self.ascii {
            let rest = self.bytes.trim_ascii_start();
            let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
            let (word, rest) = rest.split_at(length);
            self.bytes = rest;
            let value = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
            return match value {
                Some(value) => Ok(value),
                None => fail(format!(
                    "found `{}` in the PLY's data: expected a number",
                    String::from_utf8_lossy(word)
                )),
            };
        }
        let Some((front, rest)) = self.bytes.split_at_checked(scalar.size()) else {
            return fail("this PLY is truncated: its header says that there is more data");
        };
        self.bytes = rest;
        let mut bytes = [0; 8];
        bytes[..front.len()].copy_from_slice(front);
        if self.big_endian {
            bytes[..front.len()].reverse();
        }
        Ok(scalar.value(bytes))
    }
}

/// Reads a mesh. Polygons become fans of triangles; normals and flags of cut vertices are read if the file has them.
///
/// # Errors
/// [`FormatError`]: not a PLY file, or a truncated one; faces with missing vertices; coordinates that are not finite.
pub fn read_ply(bytes: &[u8]) -> Result<Mesh, FormatError> {
    coloured_ply(bytes).map(|(mesh, _)| mesh)
}

/// Reads a mesh with the colour of each triangle: that of its face, or of its corners if they agree.
pub(crate) fn coloured_ply(bytes: &[u8]) -> Result<(Mesh, Colours), FormatError> {
    let (elements, mut body) = header(bytes)?;
    let mut mesh = Mesh::default();
    let (mut of_corners, mut colours): (Vec<Option<Colour>>, Colours) = Default::default();
    for element in &elements {
        // A huge count of an element without data would take forever.
        if element.properties.is_empty() && element.count > 0 {
            return fail(format!("the element {} has no property", element.name));
        }
        if element.name == "vertex" {
            super::check_count(mesh.vertices.len().saturating_add(element.count))?;
        }
        let place = |name: &str| {
            element
                .properties
                .iter()
                .position(|p| p.count.is_none() && p.name == name)
        };
        let position = [place("x"), place("y"), place("z")];
        let normal = [place("nx"), place("ny"), place("nz")];
        let cut = place("cut");
        let channels = [place("red"), place("green"), place("blue")];
        let mut scalars = vec![0.0; element.properties.len()];
        for number in 0..element.count {
            let (mut corners, mut is_face) = (Vec::<f64>::new(), false);
            for (index, property) in element.properties.iter().enumerate() {
                match property.count {
                    None => scalars[index] = body.number(property.scalar)?,
                    Some(count) => {
                        let count = body.number(count)?;
                        if !(count >= 0.0 && count.fract() == 0.0) {
                            return fail(format!(
                                "a list of {count} values in this PLY: expected a whole number from 0 on"
                            ));
                        }
                        let keep = matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
                        is_face |= keep;
                        let mut left = count;
                        while left >= 1.0 {
                            let value = body.number(property.scalar)?;
                            if keep {
                                corners.push(value);
                            }
                            left -= 1.0;
                        }
                    }
                }
            }
            let colour = colour(element, channels, &scalars);
            if element.name == "vertex" {
                of_corners.push(colour);
                let [Some(x), Some(y), Some(z)] = position else {
                    return fail("the vertices of this PLY have no x, y, z");
                };
                let vertex = [scalars[x], scalars[y], scalars[z]];
                if !vertex.iter().all(|c| c.is_finite()) {
                    return fail(format!("vertex {} is not finite", mesh.vertices.len()));
                }
                mesh.vertices.push(vertex);
                if let [Some(x), Some(y), Some(z)] = normal {
                    mesh.normals
                        .push([scalars[x] as f32, scalars[y] as f32, scalars[z] as f32]);
                }
                mesh.cut.extend(cut.map(|at| scalars[at] != 0.0));
            }
            if is_face && corners.len() < 3 {
                let found = corners.len();
                return fail(format!(
                    "face {number} of this PLY has {found} corners: expected at least 3"
                ));
            }
            for k in 2..corners.len() {
                let corner = |value: f64| match value {
                    v if v >= 0.0 && v < mesh.vertices.len() as f64 && v.fract() == 0.0 => Ok(v as u32),
                    v => fail(format!(
                        "a face of this PLY names vertex {v} of {}",
                        mesh.vertices.len()
                    )),
                };
                let triangle = [corner(corners[0])?, corner(corners[k - 1])?, corner(corners[k])?];
                mesh.triangles.push(triangle);
                let [a, b, c] = triangle.map(|v| of_corners.get(v as usize).copied().flatten());
                colours.push(colour.or(a.filter(|_| a == b && b == c)));
            }
        }
    }
    let rest = body.bytes.trim_ascii();
    if !rest.is_empty() {
        let rest = rest.len();
        return fail(format!(
            "{rest} bytes follow the data that the header of this PLY announces: expected none"
        ));
    }
    Ok((mesh, colours))
}

/// The colour of an element: whole numbers up to 255, or fractions.
fn colour(element: &Element, channels: [Option<usize>; 3], scalars: &[f64]) -> Option<Colour> {
    let [Some(red), Some(green), Some(blue)] = channels else {
        return None;
    };
    Some([red, green, blue].map(|at| {
        let real = matches!(element.properties[at].scalar, Scalar::F32 | Scalar::F64);
        // A cast of what is out of range saturates.
        (scalars[at] * if real { 255.0 } else { 1.0 }).round() as u8
    }))
}

fn header(bytes: &[u8]) -> Result<(Vec<Element>, Body<'_>), FormatError> {
    let mut elements: Vec<Element> = Vec::new();
    let mut format = None;
    let mut rest = bytes;
    for number in 1.. {
        let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
            return fail("this is not a PLY file: expected a header from `ply` to `end_header`");
        };
        let line = String::from_utf8_lossy(&rest[..length]);
        rest = &rest[length + 1..];
        let words: Vec<&str> = line.split_whitespace().collect();
        let scalar = |name: &str| match Scalar::named(name) {
            Some(scalar) => Ok(scalar),
            None => fail(format!("line {number} of the PLY's header: unknown type `{name}`")),
        };
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return fail("this is not a PLY file: expected `ply` in the first line"),
            ["format", name, _] => format = Some(name.to_owned()),
            ["comment" | "obj_info", ..] | [] => {}
            ["element", name, count] => match count.parse() {
                Ok(count) => elements.push(Element {
                    name: name.to_owned(),
                    count,
                    properties: Vec::new(),
                }),
                Err(_) => return fail(format!("line {number} of the PLY's header: invalid count `{count}`")),
            },
            ["property", ref words @ ..] => {
                let (count, kind, name) = match *words {
                    ["list", count, kind, name] => (Some(scalar(count)?), kind, name),
                    [kind, name] => (None, kind, name),
                    _ => return fail(format!("line {number} of the PLY's header: expected a type and a name")),
                };
                let property = Property {
                    name: name.to_owned(),
                    scalar: scalar(kind)?,
                    count,
                };
                match elements.last_mut() {
                    Some(element) => element.properties.push(property),
                    None => {
                        return fail(format!(
                            "line {number} of the PLY's header: a property before an element"
                        ));
                    }
                }
            }
            ["end_header"] => break,
            _ => {
                return fail(format!(
                    "line {number} of the PLY's header is not understood: `{}`",
                    line.trim()
                ));
            }
        }
    }
    let (ascii, big_endian) = match format.as_deref() {
        Some("ascii") => (true, false),
        Some("binary_little_endian") => (false, false),
        Some("binary_big_endian") => (false, true),
        _ => return fail("this PLY has no known format: expected ascii, binary_little_endian or binary_big_endian"),
    };
    Ok((
        elements,
        Body {
            bytes: rest,
            ascii,
            big_endian,
        },
    ))
}
