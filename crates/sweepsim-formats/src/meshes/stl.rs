//! STL, binary and ASCII, without trusting what the file claims about itself.
//!
//! We do not use a library, so that ASCII coordinates are read as `f64` and errors give the line.

use std::io::Write;
use std::path::Path;

use sweepsim_dexel::TriangleSoup;
use sweepsim_nc::shortened;

use crate::error::{FormatError, Problem, TextPosition};
use crate::text::whole;

/// Bytes before the first triangle of a binary file: 80 arbitrary ones, and the number of triangles.
const HEADER: usize = 84;
/// The most characters of a line that a message shows.
const SHOWN: usize = 80;
/// Bytes per triangle: normal, three corners, two more.
const TRIANGLE: usize = 50;

type Triangle = [[f64; 3]; 3];

/// Reads the triangles of an STL file, in its own units.
///
/// # Errors
/// [`FormatError`]: the file cannot be read, or is not STL (with the line of an ASCII file); coordinates that are not
/// finite.
pub fn read_stl(file: &Path) -> Result<TriangleSoup, FormatError> {
    let bytes = whole::read(file, whole::DATA)?;
    parse_stl(&bytes).map_err(|error| error.in_file(file))
}

/// Reads the triangles of an STL file in memory.
///
/// # Errors
/// As [`read_stl`], without the file's name.
pub fn parse_stl(bytes: &[u8]) -> Result<TriangleSoup, FormatError> {
    let triangles = match binary_count(bytes) {
        // The size decides, as binary files may begin with `solid` too.
        Some(count) if bytes.len() as u64 == HEADER as u64 + TRIANGLE as u64 * u64::from(count) => binary(bytes)?,
        _ if bytes.trim_ascii_start().starts_with(b"solid") => ascii(bytes)?,
        Some(count) => {
            let message = format!(
                "this is not an STL file: it does not begin with `solid`, and as a binary file of {count} triangles it would have {} bytes, but it has {}",
                HEADER as u64 + TRIANGLE as u64 * u64::from(count),
                bytes.len()
            );
            return Err(FormatError::new(Problem::syntax(message), None));
        }
        None => {
            let message = format!(
                "this is not an STL file: it does not begin with `solid`, and {} bytes are too few for a binary file (at least {HEADER})",
                bytes.len()
            );
            return Err(FormatError::new(Problem::syntax(message), None));
        }
    };
    if triangles.is_empty() {
        let problem = Problem::syntax("this STL has no triangles: expected at least one");
        return Err(FormatError::new(problem, None));
    }
    Ok(TriangleSoup { triangles })
}

fn binary_count(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

fn binary(bytes: &[u8]) -> Result<Vec<Triangle>, FormatError> {
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE);
    triangles
        .enumerate()
        .map(|(index, record)| {
            let mut numbers = record[12..48]
                .chunks_exact(4)
                .map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
            let triangle: Triangle =
                std::array::from_fn(|_| std::array::from_fn(|_| numbers.next().map_or(f64::NAN, f64::from)));
            match triangle.iter().flatten().find(|value| !value.is_finite()) {
                None => Ok(triangle),
                Some(value) => {
                    let what = format!("a coordinate of triangle {index} (counted from 0)");
                    Err(FormatError::new(Problem::value(what, value, "finite"), None))
                }
            }
        })
        .collect()
}

/// ASCII: `facet`, `outer loop`, three times `vertex x y z`, and their ends.
fn ascii(bytes: &[u8]) -> Result<Vec<Triangle>, FormatError> {
    // Names after `solid` come in all encodings.
    let text = String::from_utf8_lossy(bytes);
    let mut triangles = Vec::new();
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut ended = false;
    for (index, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let fail = |message: String| {
            let place = TextPosition::in_line(index + 1, line, 1, line.chars().count());
            Err(FormatError::new(Problem::syntax(message), Some(place)))
        };
        let keyword = words.first().map(|word| word.to_ascii_lowercase());
        match keyword.as_deref() {
            None => {}
            Some("solid") => ended = false,
            Some("facet" | "outer") => corners.clear(),
            Some("endfacet") => {}
            Some("vertex") => {
                let numbers: Vec<f64> = words[1..].iter().filter_map(|word| word.parse().ok()).collect();
                match numbers[..] {
                    [x, y, z] if words.len() == 4 && [x, y, z].iter().all(|c| c.is_finite()) => {
                        corners.push([x, y, z]);
                    }
                    _ => {
                        let found = shortened(line.trim().to_owned(), SHOWN);
                        return fail(format!("`{found}`: expected `vertex` and three finite numbers"));
                    }
                }
            }
            Some("endloop") => match corners[..] {
                [a, b, c] => triangles.push([a, b, c]),
                _ => return fail(format!("a facet with {} corners: expected 3", corners.len())),
            },
            Some("endsolid") => ended = true,
            Some(_) => {
                return fail(format!(
                    "this is not an STL file: found `{}`, but expected facet, outer loop, vertex, endloop, endfacet or endsolid",
                    line.trim().chars().take(40).collect::<String>()
                ));
            }
        }
    }
    if ended {
        Ok(triangles)
    } else {
        let place = TextPosition::in_line(text.lines().count().max(1), "", 1, 1);
        let problem = Problem::syntax("this STL is truncated: expected `endsolid`");
        Err(FormatError::new(problem, Some(place)))
    }
}

/// Writes binary STL. Coordinates are rounded to `f32`; triangles without area have a zero normal.
///
/// # Errors
/// Those of the writer; more than 2³² triangles.
pub fn write_stl(triangles: &[Triangle], writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
    let count = u32::try_from(triangles.len())
        .map_err(|_| std::io::Error::new(std::io::ErrorKind::InvalidInput, "too many triangles for STL"))?;
    let mut header = [0_u8; HEADER];
    let title = b"sweepsim";
    header[..title.len()].copy_from_slice(title);
    header[HEADER - 4..].copy_from_slice(&count.to_le_bytes());
    writer.write_all(&header)?;
    for triangle in triangles {
        let [a, b, c] = triangle.map(nalgebra::Vector3::from);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        let numbers = normal.iter().chain(triangle.iter().flatten());
        for &number in numbers {
            writer.write_all(&(number as f32).to_le_bytes())?;
        }
        writer.write_all(&[0, 0])?;
    }
    Ok(())
}
