//! Names of formats, as users write them.

/// The format of a program's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// G-code, of any control.
    Gcode,
    /// APT, CLSF, NCL.
    Apt,
    /// A table of poses with a header.
    Table,
    /// Rows of six numbers without a header: the tip and the direction of the axis.
    Rows,
}

impl Format {
    /// The names that [`named`](Self::named) knows.
    pub const NAMES: [&str; 4] = ["gcode", "apt", "table", "rows"];

    /// The format of this name, in any case.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "gcode" | "g-code" | "nc" => Self::Gcode,
            "apt" | "clsf" | "cls" | "ncl" => Self::Apt,
            "table" | "csv" => Self::Table,
            "rows" => Self::Rows,
            _ => return None,
        })
    }
}
