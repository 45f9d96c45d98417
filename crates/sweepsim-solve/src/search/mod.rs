//! Code shared by all searches: limits, counts, monitors, and open boxes.

mod cluster;
mod error;
mod limits;
mod monitor;
mod open;
mod picture;
mod spread;

pub(crate) use cluster::{Cluster, SMALL, cluster, cluster_box, clusters};
pub use error::SolveError;
pub(crate) use limits::Watch;
pub use limits::{Cause, Fate, RootCount, SolveOptions, SolveStatistics, UnresolvedBox};
pub use monitor::{CancelOnly, Monitor};
pub(crate) use open::{Open, open_box, unite};
pub use picture::Picture;
pub(crate) use spread::spread;
