//! What a request has in memory instead of in files.

use crate::base::JobError;
use serde::ser::Error as _;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sweepsim_dexel::{Stock, TriangleSoup};
use sweepsim_motion::{Body, Tool};

/// Where a request comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Input {
    /// The file of a job or a program.
    File(PathBuf),
    /// The text of a program.
    Program {
        /// Its name, with an extension that a file of its kind would have.
        name: PathBuf,
        /// Its lines.
        text: String,
    },
    /// The text of a job. Files that it refers to are read, relative to the folder of its name.
    Job {
        /// Its name.
        name: PathBuf,
        /// The text, in RON.
        text: String,
    },
}

impl Input {
    /// The file, or what it would be called.
    #[must_use]
    pub fn name(&self) -> &Path {
        match self {
            Self::File(name) | Self::Program { name, .. } | Self::Job { name, .. } => name,
        }
    }
}

/// Whether all corners of a stock's triangles are finite: nothing could be guessed from their box otherwise.
pub(super) fn check_corners(stock: &Stock) -> Result<(), JobError> {
    match stock {
        Stock::Mesh(soup) => {
            let corners = soup.triangles.iter().flatten().enumerate();
            let mut all = corners.flat_map(|(n, corner)| corner.iter().zip(["x", "y", "z"]).map(move |own| (n, own)));
            let Some((n, (value, axis))) = all.find(|(_, (value, _))| !value.is_finite()) else {
                return Ok(());
            };
            let (triangle, corner) = (n / 3, n % 3);
            let why = format!(
                "corner {corner} of triangle {triangle} of the mesh has a coordinate that is not finite: {axis} = {value}"
            );
            Err(JobError::request("stock", why))
        }
        Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().try_for_each(check_corners),
        Stock::Difference(whole, parts) => {
            check_corners(whole)?;
            parts.iter().try_for_each(check_corners)
        }
        _ => Ok(()),
    }
}

/// Solids given in code.
#[derive(Clone, Debug, Default)]
pub(crate) struct Given {
    pub tools: BTreeMap<u32, Tool>,
    pub bodies: BTreeMap<u32, Vec<Body>>,
    pub stock: Option<Stock>,
    pub fixtures: Vec<Stock>,
    pub target: Option<TriangleSoup>,
}

impl Given {
    pub fn is_empty(&self) -> bool {
        let Self {
            tools,
            bodies,
            stock,
            fixtures,
            target,
        } = self;
        tools.is_empty() && bodies.is_empty() && stock.is_none() && fixtures.is_empty() && target.is_none()
    }

    /// Solids have no notation: a request with some cannot be written, rather than lose them.
    pub fn refuse<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.is_empty() {
            serializer.serialize_unit()
        } else {
            Err(S::Error::custom(
                "a request with tools, stock, fixtures or target given in code cannot be written: expected files",
            ))
        }
    }
}
