//! The file of a cache.
//!
//! | part | content |
//! | --- | --- |
//! | header | `sweepcch`; the program that made it, 32 bytes; the number of entries `u64`; all numbers are little-endian |
//! | index | of each entry, by key: 32 bytes, and the number of its bytes `u64` |
//! | entries | their bytes, one after the other |
//! | end | CRC-32 of all that is before it |

use super::digest::{Digest, Key};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::ops::Range;
use std::path::Path;
use sweepsim_formats::io_reason;

const MAGIC: &[u8; 8] = b"sweepcch";
const ROW: usize = 40;
const HEADER: usize = 48;
const END: usize = 4;

/// The program: results may differ from those of any other.
fn program() -> Key {
    let version = [env!("CARGO_PKG_VERSION"), env!("SWEEPSIM_SOURCES")];
    Digest::of("program").value(&version).key()
}

/// Why nothing of a file can be used.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unfit {
    Missing,
    Unreadable(String),
    Foreign,
    Version,
    Damaged,
}

impl std::fmt::Display for Unfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Missing => f.write_str("does not exist"),
            Self::Unreadable(why) => write!(f, "cannot be read ({why})"),
            Self::Foreign => f.write_str("is no cache"),
            Self::Version => f.write_str("was made by another version of sweepsim"),
            Self::Damaged => f.write_str("is damaged"),
        }
    }
}

/// The entries of a file.
#[derive(Debug, Default)]
pub(super) struct Entries {
    bytes: Vec<u8>,
    index: BTreeMap<Key, Range<usize>>,
}

impl Entries {
    pub fn read(file: &Path) -> Result<Self, Unfit> {
        let bytes = fs::read(file).map_err(|error| match error.kind() {
            ErrorKind::NotFound => Unfit::Missing,
            _ => Unfit::Unreadable(io_reason(&error)),
        })?;
        if !bytes.starts_with(MAGIC) {
            return Err(if MAGIC.starts_with(&bytes) {
                Unfit::Damaged
            } else {
                Unfit::Foreign
            });
        }
        let content = bytes.len().checked_sub(END).filter(|content| *content >= HEADER);
        let content = content.ok_or(Unfit::Damaged)?;
        if bytes[8..40] != program() {
            return Err(Unfit::Version);
        }
        if crc32fast::hash(&bytes[..content]).to_le_bytes() != bytes[content..] {
            return Err(Unfit::Damaged);
        }
        let index = index(&bytes[..content]).ok_or(Unfit::Damaged)?;
        Ok(Self { bytes, index })
    }

    pub fn get(&self, key: &Key) -> Option<&[u8]> {
        Some(&self.bytes[self.index.get(key)?.clone()])
    }
}

fn index(content: &[u8]) -> Option<BTreeMap<Key, Range<usize>>> {
    let number = |at: usize| Some(u64::from_le_bytes(content.get(at..at + 8)?.try_into().ok()?));
    let count = usize::try_from(number(40)?).ok()?;
    let mut at = count.checked_mul(ROW)?.checked_add(HEADER)?;
    let mut index = BTreeMap::new();
    for row in content.get(HEADER..at)?.chunks_exact(ROW) {
        let length = usize::try_from(u64::from_le_bytes(row[32..].try_into().ok()?)).ok()?;
        let end = at.checked_add(length).filter(|end| *end <= content.len())?;
        index.insert(row[..32].try_into().ok()?, at..end);
        at = end;
    }
    (at == content.len()).then_some(index)
}

pub(super) fn write(entries: &BTreeMap<&Key, &[u8]>, to: &mut impl Write) -> io::Result<()> {
    let mut sum = crc32fast::Hasher::new();
    let mut put = |bytes: &[u8]| {
        sum.update(bytes);
        to.write_all(bytes)
    };
    put(MAGIC)?;
    put(&program())?;
    put(&(entries.len() as u64).to_le_bytes())?;
    for (key, bytes) in entries {
        put(*key)?;
        put(&(bytes.len() as u64).to_le_bytes())?;
    }
    for bytes in entries.values() {
        put(bytes)?;
    }
    to.write_all(&sum.finalize().to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written() -> Vec<u8> {
        let keys: Vec<Key> = (0..5).map(|k| Digest::of("test").number(k).key()).collect();
        let values: Vec<Vec<u8>> = (0..5).map(|k| vec![k as u8; 7 * k]).collect();
        let entries = keys.iter().zip(values.iter().map(Vec::as_slice)).collect();
        let mut bytes = Vec::new();
        write(&entries, &mut bytes).unwrap();
        bytes
    }

    #[test]
    fn whatever_is_changed_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("own.sweepcache");
        assert_eq!(Entries::read(&file).unwrap_err(), Unfit::Missing);
        let bytes = written();
        fs::write(&file, &bytes).unwrap();
        let whole = Entries::read(&file).unwrap();
        for k in 0..5 {
            let key = Digest::of("test").number(k).key();
            assert_eq!(whole.get(&key), Some(&vec![k as u8; 7 * k][..]));
        }
        assert_eq!(whole.get(&Digest::of("other").key()), None);
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 1 << (at % 8);
            fs::write(&file, &changed).unwrap();
            let expected = match at {
                0..8 => Unfit::Foreign,
                8..40 => Unfit::Version,
                _ => Unfit::Damaged,
            };
            assert_eq!(Entries::read(&file).unwrap_err(), expected, "byte {at}");
            fs::write(&file, &bytes[..at]).unwrap();
            assert_eq!(Entries::read(&file).unwrap_err(), Unfit::Damaged, "{at} bytes");
        }
        fs::write(&file, "something else").unwrap();
        assert_eq!(Entries::read(&file).unwrap_err(), Unfit::Foreign);
        fs::remove_file(&file).unwrap();
        fs::create_dir(&file).unwrap();
        assert!(matches!(Entries::read(&file), Err(Unfit::Unreadable(_))));
    }
}
