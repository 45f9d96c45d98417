//! The boundary of a tool: patches, their normals, and the sharp edges between them.

mod edge;
mod error;
mod joints;
mod meridian;
mod normals;
mod patch;
mod plane;
mod recognised;
mod revolution;
mod revolved;
mod side_curve;
mod stretch;

pub use edge::{Edge, Fold};
pub use error::{PatchError, Side, ToolError};
pub(crate) use joints::edges as edges_of_patches;
pub use normals::NormalField;
pub use patch::Patch;
pub(crate) use revolution::{edges as edges_of_profile, joins_smoothly, of_piece, patches as patches_of_profile};
pub use revolved::Revolved;
