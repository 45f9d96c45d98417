//! Memory that is not in use, to be used again.

use crate::methods::harvest::Numbered;
use crate::methods::workspace::Workspace;
use std::sync::{Arc, Mutex};

/// Workspaces of one tool, for any tolerances.
pub(crate) type Spaces = Arc<Mutex<Vec<Workspace>>>;

/// Lists of crossings, empty.
pub(crate) type SpareLists = Arc<Mutex<Vec<Vec<Numbered>>>>;
