//! The file: JSON, with the trees deflated and in base64, and the digest of all that comes before it at its end.

use crate::scene::hexadecimal;
use crate::solid::Solid;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use thiserror::Error;

/// What a certificate says that it is.
const FORMAT: &str = "sweepsim certificate";
/// Certificates of other versions are refused.
const VERSION: u32 = 1;
/// The last field of the file.
const DIGEST: &str = ",\"digest\":\"";
/// Trees of more bytes are not taken.
const MOST_BYTES: usize = 1 << 31;
/// Digits of a digest.
const DIGITS: usize = 64;

/// A certificate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Certificate {
    format: String,
    version: u32,
    /// The program that wrote it, with its version.
    pub made_by: String,
    /// What was asked for, in the notation of that program.
    pub request: serde_json::Value,
    /// The files that the request names.
    pub files: Vec<FileDigest>,
    /// The [digest](crate::Scene::digest) of target, tools and paths.
    pub scene: String,
    /// What is claimed.
    pub statement: Vec<Claim>,
}

/// A file, and its SHA-256 in hexadecimal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileDigest {
    /// The file, as the request names it.
    pub file: String,
    /// Its digest.
    pub sha256: String,
}

/// A statement with its proof.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// `gouge`: the depth of cutters in the target.
    pub about: String,
    /// How deep they may go.
    pub limit: f64,
    /// The largest depth is between these.
    pub enclosure: [f64; 2],
    /// Where the lower one is attained.
    pub witness: Option<Witness>,
    /// The cube that is divided: its centre, and half of its size.
    pub root: ([f64; 3], f64),
    /// Convex solids that cover each tool.
    pub tools: BTreeMap<u32, Vec<Solid>>,
    /// The [trees](trees), deflated, in base64.
    pub trees: String,
}

/// Where a depth is attained.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// The path.
    pub path: usize,
    /// The move.
    pub number: usize,
    /// The first move, and the number of moves, of the tree that it is in.
    pub moves: [usize; 2],
    /// Which of the pieces of these moves, and the parameter in it.
    pub piece: (usize, f64),
    /// Where.
    pub place: [f64; 3],
}

/// Why something is not a certificate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NoCertificate {
    /// It does not end as a certificate does.
    #[error("not a certificate, or cut short: expected a file that ends with its digest")]
    End,
    /// A byte was changed.
    #[error("the certificate was changed: its digest is not that of its content")]
    Changed,
    /// It is of another version.
    #[error("the certificate is of version {0}: expected {VERSION}")]
    Version(u32),
    /// It is JSON of something else.
    #[error("not a certificate: {0}")]
    Other(#[from] serde_json::Error),
}

#[derive(Deserialize)]
struct Header {
    format: String,
    version: u32,
}

impl Certificate {
    /// A certificate of version 1.
    #[must_use]
    pub fn new(
        made_by: String,
        request: serde_json::Value,
        files: Vec<FileDigest>,
        scene: String,
        statement: Vec<Claim>,
    ) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            made_by,
            request,
            files,
            scene,
            statement,
        }
    }

    /// The text of its file.
    ///
    /// # Errors
    /// A number that has no notation.
    pub fn written(&self) -> Result<String, serde_json::Error> {
        let mut text = serde_json::to_string(self)?;
        // The last brace closes it again after the digest.
        text.pop();
        let digest = digest_of(text.as_bytes());
        text.push_str(&format!("{DIGEST}{digest}\"}}\n"));
        Ok(text)
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`NoCertificate`].
    pub fn read(text: &[u8]) -> Result<Self, NoCertificate> {
        let end = DIGEST.len() + DIGITS + "\"}\n".len();
        let (content, end) = text
            .split_at_checked(text.len().saturating_sub(end))
            .ok_or(NoCertificate::End)?;
        let digest = end
            .strip_prefix(DIGEST.as_bytes())
            .and_then(|end| end.strip_suffix(b"\"}\n"))
            .ok_or(NoCertificate::End)?;
        if digest != digest_of(content).as_bytes() {
            return Err(NoCertificate::Changed);
        }
        let whole = [content, b"}"].concat();
        let header: Header = serde_json::from_slice(&whole)?;
        if header.format != FORMAT {
            return Err(NoCertificate::End);
        }
        if header.version != VERSION {
            return Err(NoCertificate::Version(header.version));
        }
        Ok(serde_json::from_slice(&whole)?)
    }
}

/// The SHA-256 of bytes, in hexadecimal.
#[must_use]
pub fn digest_of(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// A tree that is to be written.
#[derive(Clone, Copy, Debug)]
pub struct TreePart<'a> {
    /// The path.
    pub path: usize,
    /// The first move, and how many.
    pub moves: [usize; 2],
    /// Which of the solids of the tool.
    pub solid: usize,
    /// The tree.
    pub bytes: &'a [u8],
}

/// Trees, deflated and in base64: each after five numbers: path, first move, moves, solid, and bytes. Those of
/// a path and a solid are in the order of moves.
#[must_use]
pub fn trees<'a>(parts: impl IntoIterator<Item = TreePart<'a>>) -> String {
    let mut all = Vec::new();
    let number = |mut number: usize, all: &mut Vec<u8>| {
        while number > 0x7f {
            all.push(number as u8 | 0x80);
            number >>= 7;
        }
        all.push(number as u8);
    };
    for part in parts {
        let [first, count] = part.moves;
        for own in [part.path, first, count, part.solid, part.bytes.len()] {
            number(own, &mut all);
        }
        all.extend_from_slice(part.bytes);
    }
    STANDARD.encode(compress_to_vec(&all, 6))
}

impl Claim {
    pub(crate) fn bytes(&self) -> Option<Vec<u8>> {
        let packed = STANDARD.decode(&self.trees).ok()?;
        decompress_to_vec_with_limit(&packed, MOST_BYTES).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_versions_and_other_files_are_refused() {
        let empty = || serde_json::Value::Null;
        let certificate = Certificate::new("a test".into(), empty(), Vec::new(), String::new(), Vec::new());
        let text = certificate.written().expect("a notation");
        assert_eq!(Certificate::read(text.as_bytes()).expect("a certificate"), certificate);
        let later = Certificate {
            version: 2,
            ..certificate.clone()
        };
        let text = later.written().expect("a notation");
        assert!(matches!(
            Certificate::read(text.as_bytes()),
            Err(NoCertificate::Version(2))
        ));
        let other = Certificate {
            format: "a shopping list".into(),
            ..certificate
        };
        let text = other.written().expect("a notation");
        assert!(matches!(Certificate::read(text.as_bytes()), Err(NoCertificate::End)));
    }
}
