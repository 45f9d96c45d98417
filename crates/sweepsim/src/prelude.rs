//! The items that most programs need: `use sweepsim::prelude::*;`

pub use crate::{Cut, Method, Monitor, Options, simulate, sweep};
pub use sweepsim_dexel::{Dexels, Grid, Stock};
pub use sweepsim_motion::{Path, Pose, Tool};
