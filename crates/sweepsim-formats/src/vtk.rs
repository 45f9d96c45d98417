//! VTK's XML files, for ParaView: meshes as `.vtp`, dexels as lines in `.vtu`.
//!
//! The data follow the description uncompressed (`appended`, `raw`), each array after its length in bytes;
//! little-endian.

use std::fmt::Write as _;
use std::io::{self, Write};

/// The description and the data of a file.
pub(crate) struct Document {
    xml: String,
    data: Vec<u8>,
}

impl Document {
    pub fn new(kind: &str, piece: &str) -> Self {
        let xml = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <{kind}>\n<Piece {piece}>\n"
        );
        Self { xml, data: Vec::new() }
    }

    pub fn open(&mut self, tag: &str) {
        let _ = writeln!(self.xml, "<{tag}>");
    }

    /// An array of rows of `width` numbers.
    pub fn array(&mut self, name: &str, kind: &str, width: usize, bytes: impl IntoIterator<Item = u8>) {
        let at = self.data.len();
        let _ = writeln!(
            self.xml,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"appended\" offset=\"{at}\"/>"
        );
        self.data.extend([0; 8]);
        self.data.extend(bytes);
        let length = (self.data.len() - at - 8) as u64;
        self.data[at..at + 8].copy_from_slice(&length.to_le_bytes());
    }

    pub fn finish(self, kind: &str, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
        write!(
            writer,
            "{}</Piece>\n</{kind}>\n<AppendedData encoding=\"raw\">\n_",
            self.xml
        )?;
        writer.write_all(&self.data)?;
        writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}
