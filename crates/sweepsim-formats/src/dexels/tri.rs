//! Dexels along three axes in one file (`.tridexels`), bit for bit, with normals and sources.
//!
//! | part | content |
//! | --- | --- |
//! | header | `sweep3dx`; version `u32` (1); checksum `u32`, the CRC-32 of both |
//! | sets | the dexels along x, along y and along z, each as a whole [`.dexels`](super::binary) file in the frame of [`Frame::cyclic`](sweepsim_dexel::Frame::cyclic) |

use std::io::{Read, Write};

use sweepsim_dexel::TriDexels;

use super::binary_read::read_dexels_binary;
use super::binary_write::write_dexels_binary;
use crate::checksum::crc32;
use crate::error::{FormatError, Problem};

pub(crate) const MAGIC: &[u8; 8] = b"sweep3dx";
const VERSION: u32 = 1;

/// Writes dexels along three axes.
///
/// # Errors
/// Those of the writer.
pub fn write_tri_dexels(dexels: &TriDexels, writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
    let mut header = Vec::with_capacity(12);
    header.extend_from_slice(MAGIC);
    header.extend_from_slice(&VERSION.to_le_bytes());
    writer.write_all(&header)?;
    writer.write_all(&crc32(&[&header]).to_le_bytes())?;
    dexels
        .sets()
        .iter()
        .try_for_each(|set| write_dexels_binary(set, writer))
}

/// Reads dexels along three axes; anything after them is left in the reader.
///
/// # Errors
/// [`FormatError`]: not such a file, another version, truncated or damaged, or three sets that are not those of one
/// box. Memory is in proportion to the length of the file, whatever it contains.
///
/// ```
/// use sweepsim_dexel::{Stock, TriDexels};
/// use sweepsim_formats::{read_tri_dexels, write_tri_dexels};
/// let ball = Stock::Ball { centre: [0.0; 3], radius: 4.0 };
/// let solid = TriDexels::new([-5.0; 3], [5.0; 3], [50; 3], &ball)?;
/// let mut file = Vec::new();
/// write_tri_dexels(&solid, &mut file)?;
/// assert_eq!(read_tri_dexels(&mut &file[..])?, solid);
/// let error = read_tri_dexels(&mut &file[..file.len() - 1]).unwrap_err();
/// assert_eq!(error.to_string(), "along z: this file is truncated after 2500 of 2500 dexels");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_tri_dexels(reader: &mut impl Read) -> Result<TriDexels, FormatError> {
    let problem = |message: String| FormatError::new(Problem::syntax(message), None);
    let mut header = Vec::with_capacity(16);
    let read = reader.take(16).read_to_end(&mut header);
    read.map_err(|error| FormatError::new(Problem::Read(error), None))?;
    if !header.starts_with(MAGIC) {
        let message = "this is not a file of dexels along three axes: expected `sweep3dx` at its beginning";
        return Err(problem(message.to_owned()));
    }
    let ([version, sum], []) = header[8..].as_chunks::<4>() else {
        return Err(problem("this file is truncated in its header".to_owned()));
    };
    let version = u32::from_le_bytes(*version);
    if u32::from_le_bytes(*sum) != crc32(&[&header[..12]]) {
        return Err(problem(
            "this file is damaged: the checksum of its header is wrong".to_owned(),
        ));
    }
    if version != VERSION {
        let problem = Problem::value("the version of this file", version, VERSION.to_string());
        return Err(FormatError::new(problem, None));
    }
    let mut set = |axis: char| {
        let set = read_dexels_binary(reader);
        set.map_err(|error| match error.problem() {
            Problem::Syntax { message } => problem(format!("along {axis}: {message}")),
            _ => error,
        })
    };
    let sets = [set('x')?, set('y')?, set('z')?];
    TriDexels::from_sets(sets).map_err(|error| problem(format!("this file is inconsistent: {error}")))
}
