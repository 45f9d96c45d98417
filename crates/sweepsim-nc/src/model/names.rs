//! Names of controls and formats, as users write them.

use crate::model::read_options::Controller;

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

impl Controller {
    /// The names that [`named`](Self::named) knows.
    pub const NAMES: [&str; 6] = ["linuxcnc", "fanuc", "haas", "siemens", "heidenhain", "grbl"];

    /// Its name.
    ///
    /// ```
    /// assert_eq!(sweepsim_nc::Controller::Haas.name(), "haas");
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LinuxCnc => "linuxcnc",
            Self::Fanuc => "fanuc",
            Self::Haas => "haas",
            Self::Siemens => "siemens",
            Self::Heidenhain => "heidenhain",
            Self::Grbl => "grbl",
        }
    }

    /// The control of this name, in any case.
    ///
    /// ```
    /// use sweepsim_nc::Controller;
    /// assert_eq!(Controller::named("Fanuc"), Some(Controller::Fanuc));
    /// assert_eq!(Controller::named("abacus"), None);
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "linuxcnc" | "rs274" => Self::LinuxCnc,
            "fanuc" => Self::Fanuc,
            "haas" => Self::Haas,
            "siemens" | "sinumerik" | "840d" => Self::Siemens,
            "heidenhain" | "klartext" => Self::Heidenhain,
            "grbl" | "tinyg" => Self::Grbl,
            _ => return None,
        })
    }
}
