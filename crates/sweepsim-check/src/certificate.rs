//! The file: JSON, with the trees deflated and in base64, and the digest of all that comes before it at its end.

use crate::scene::hexadecimal;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

/// What a certificate says that it is.
const FORMAT: &str = "sweepsim certificate";
/// Certificates of other versions are refused.
const VERSION: u32 = 7;
/// The last field of the file.
const DIGEST: &str = ",\"digest\":\"";
/// Trees of more bytes are not taken.
const MOST_BYTES: usize = 1 << 28;
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
    /// The [digest](crate::Scene::digest) of all that is asked.
    pub scene: String,
    /// An answer to each of its questions; none where nothing can be checked.
    pub claims: Vec<Option<Claim>>,
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

/// An answer with its proof.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The name of the question.
    pub about: String,
    /// What is measured is no more.
    pub bound: f64,
    /// A place where a depth is attained.
    pub witness: Option<Witness>,
    /// For depths, the cube that is divided: its centre, and half of its size.
    pub root: ([f64; 3], f64),
    /// For depths, how far what moves is lifted off what is near a cell, about.
    pub lift: f64,
    /// For each mover, and then for each cutter, of which curves its solids are: so many together, or one in so many
    /// parts.
    pub covers: Vec<Vec<[usize; 2]>>,
    /// The proof.
    pub trees: Vec<Tree>,
}

/// Where a depth is attained.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// The path of what goes so deep.
    pub path: usize,
    /// The number of the motion on it.
    pub motion: usize,
    /// The time in it.
    pub time: f64,
    /// Where.
    pub place: [f64; 3],
    /// How deep.
    pub depth: f64,
}

/// A part of a proof.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tree {
    /// What of the question's moves; of heights, 0.
    pub mover: usize,
    /// Which of its solids; of heights, 0.
    pub solid: usize,
    /// The first motion or patch.
    pub first: usize,
    /// How many motions or patches.
    pub count: usize,
    /// The tree, or the trees of patches one after the other, [packed].
    pub bytes: String,
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
    /// A certificate of this version.
    #[must_use]
    pub fn new(
        made_by: String,
        request: serde_json::Value,
        files: Vec<FileDigest>,
        scene: String,
        claims: Vec<Option<Claim>>,
    ) -> Self {
        let (format, version) = (FORMAT.to_owned(), VERSION);
        Self {
            format,
            version,
            made_by,
            request,
            files,
            scene,
            claims,
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
        let parts = text.split_at_checked(text.len().saturating_sub(end));
        let (content, end) = parts.ok_or(NoCertificate::End)?;
        let digest = end
            .strip_prefix(DIGEST.as_bytes())
            .and_then(|end| end.strip_suffix(b"\"}\n"));
        if digest.ok_or(NoCertificate::End)? != digest_of(content).as_bytes() {
            return Err(NoCertificate::Changed);
        }
        let whole = [content, b"}"].concat();
        let header: Header = serde_json::from_slice(&whole)?;
        match (header.format == FORMAT, header.version) {
            (false, _) => Err(NoCertificate::End),
            (true, VERSION) => Ok(serde_json::from_slice(&whole)?),
            (true, version) => Err(NoCertificate::Version(version)),
        }
    }
}

/// The SHA-256 of bytes, in hexadecimal.
#[must_use]
pub fn digest_of(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// The bytes of a tree, deflated and in base64.
#[must_use]
pub fn packed(bytes: &[u8]) -> String {
    STANDARD.encode(compress_to_vec(bytes, 6))
}

pub(crate) fn unpacked(text: &str) -> Option<Vec<u8>> {
    decompress_to_vec_with_limit(&STANDARD.decode(text).ok()?, MOST_BYTES).ok()
}
