//! Dexel files, by extension.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, Write};
use std::path::Path;

use sweepsim_dexel::{Dexels, Grid, TriDexels};

use super::binary_read::read_dexels_binary;
use super::binary_write::write_dexels_binary;
use super::csv::{HEADER, dexels_from_rows, read_dexels_csv, write_dexels_csv};
use super::fixture::Fixture;
use super::npz::{read_dexels_npz, write_dexels_npz};
use super::tri::read_tri_dexels;
use super::vtu::write_dexels_vtu;
use crate::atomic::write_atomically;
use crate::error::{FormatError, Problem};
use crate::extension::{extension, unknown};
use crate::text::whole;

/// The extensions of [`DexelFormat`] that are read, for messages.
const DEXELS: &str = ".csv, .dexels, .tridexels, .npz";

/// A format of dexels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DexelFormat {
    /// `.csv`: one row per interval, without grid, normals and sources.
    Csv,
    /// `.dexels`: everything, bit for bit.
    Binary,
    /// `.tridexels`: dexels along three axes; read as those along z where one set is wanted, and written by
    /// [`write_tri_dexels`](super::write_tri_dexels) only.
    Tri,
    /// `.npz`: NumPy arrays.
    Npz,
    /// `.vtu`: lines for ParaView; written only.
    Vtu,
}

impl DexelFormat {
    /// The format of a file, by its extension. Tables of poses share theirs with [`DexelFormat::Csv`].
    #[must_use]
    pub fn of(file: &Path) -> Option<Self> {
        Some(match extension(file).as_str() {
            "csv" => Self::Csv,
            "dexels" => Self::Binary,
            "tridexels" => Self::Tri,
            "npz" => Self::Npz,
            "vtu" => Self::Vtu,
            _ => return None,
        })
    }
}

/// Whether a table contains dexels, by its header.
///
/// # Errors
/// [`Problem::Read`] with the name of the file.
pub fn is_dexels_csv(file: &Path) -> Result<bool, FormatError> {
    let read = || -> io::Result<bool> {
        let mut header = Vec::new();
        // No header is longer; a file without line breaks is not read completely.
        let limit = HEADER.len() as u64 + 3;
        BufReader::new(File::open(file)?)
            .take(limit)
            .read_until(b'\n', &mut header)?;
        Ok(header.trim_ascii() == HEADER.as_bytes())
    };
    read().map_err(|error| FormatError::new(Problem::Read(error), None).in_file(file))
}

/// Reads dexels: `.csv`, `.dexels`, `.tridexels` (those along z) or `.npz`. Tables do not contain their grid, and need
/// `grid`; the others have their own.
///
/// # Errors
/// [`FormatError`] with the file's name: the file cannot be read, its extension is unknown, its content is invalid, or
/// a table comes without a grid.
pub fn read_dexels_file(file: &Path, grid: Option<&Grid>) -> Result<Dexels, FormatError> {
    let failed = |error: io::Error| FormatError::new(Problem::Read(error), None);
    let read = |format| -> Result<Dexels, FormatError> {
        let mut reader = BufReader::new(File::open(file).map_err(failed)?);
        match format {
            DexelFormat::Csv => {
                let grid = grid.ok_or_else(|| {
                    FormatError::new(
                        Problem::syntax("a table of dexels does not contain its grid: a grid is needed to read it"),
                        None,
                    )
                })?;
                dexels_from_rows(*grid, &read_dexels_csv(reader)?)
            }
            DexelFormat::Npz => {
                let bytes = whole::at_most(reader.into_inner(), whole::DATA).map_err(failed)?;
                read_dexels_npz(&bytes)
            }
            DexelFormat::Binary if starts_with(&mut reader, b"sweepsim dexels ").map_err(failed)? => {
                let bytes = whole::at_most(reader.into_inner(), whole::DATA).map_err(failed)?;
                let text = String::from_utf8(bytes);
                let text = text.map_err(|error| failed(io::Error::new(io::ErrorKind::InvalidData, error)))?;
                Ok(Fixture::parse(&text)?.dexels())
            }
            DexelFormat::Binary => read_dexels_binary(&mut reader),
            DexelFormat::Tri => {
                let [_, _, along_z] = read_tri_dexels(&mut reader)?.into_sets();
                Ok(along_z)
            }
            DexelFormat::Vtu => Err(unknown(file, "dexel", format!("{DEXELS}, as .vtu is only written"))),
        }
    };
    let format = DexelFormat::of(file).ok_or_else(|| unknown(file, "dexel", DEXELS))?;
    read(format).map_err(|error| error.in_file(file))
}

fn starts_with(reader: &mut BufReader<File>, magic: &[u8]) -> io::Result<bool> {
    let mut bytes = Vec::new();
    reader.by_ref().take(magic.len() as u64).read_to_end(&mut bytes)?;
    reader.rewind()?;
    Ok(bytes == magic)
}

/// Reads dexels along three axes.
///
/// # Errors
/// [`FormatError`] with the file's name: the file cannot be read, or its content is invalid.
pub fn read_tri_dexels_file(file: &Path) -> Result<TriDexels, FormatError> {
    let open = File::open(file).map_err(|error| FormatError::new(Problem::Read(error), None));
    open.and_then(|file| read_tri_dexels(&mut BufReader::new(file)))
        .map_err(|error| error.in_file(file))
}

/// Writes dexels, completely or not at all: `.csv`, `.dexels`, `.npz` or `.vtu`.
///
/// # Errors
/// [`FormatError`] with the file's name: the extension is unknown, or the data cannot be written.
pub fn write_dexels_file(dexels: &Dexels, file: &Path) -> Result<(), FormatError> {
    let format = DexelFormat::of(file).filter(|format| *format != DexelFormat::Tri);
    let Some(format) = format else {
        return Err(unknown(file, "dexel", ".csv, .dexels, .npz, .vtu"));
    };
    write_atomically(file, |out| write_dexels(dexels, format, out))
}

/// Writes dexels along z in a format. One set is not three: [`DexelFormat::Tri`] is refused.
///
/// # Errors
/// Those of the writer, and [`io::ErrorKind::InvalidInput`].
pub fn write_dexels(dexels: &Dexels, format: DexelFormat, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    match format {
        DexelFormat::Csv => write_dexels_csv(dexels, &mut *out),
        DexelFormat::Binary => write_dexels_binary(dexels, &mut *out),
        DexelFormat::Npz => write_dexels_npz(dexels, &mut *out),
        DexelFormat::Vtu => write_dexels_vtu(dexels, &mut *out),
        DexelFormat::Tri => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "dexels along three axes cannot be made of those along z",
        )),
    }?;
    out.flush()
}
