//! Options about programs.

use super::values::{diameter, offset, stock};
use clap::Args;
use clap::ValueHint;
use std::path::PathBuf;
use sweepsim_job::StockOption;
use sweepsim_nc::{Controller, Format};

/// How a program is read.
#[derive(Debug, Args)]
#[command(next_help_heading = "Programs")]
pub(crate) struct DialectOptions {
    /// The control that the program is written for: linuxcnc, fanuc, haas, siemens, heidenhain, grbl or okuma [default:
    /// as the program says].
    #[arg(long, value_name = "NAME", value_parser = known(|name| Controller::named(name).is_some(), &Controller::NAMES))]
    pub controller: Option<String>,
    /// The machine: a machine.ron, or the name of a ready one, like trunnion-ac.
    #[arg(long, value_name = "FILE")]
    pub machine: Option<String>,
    /// The format of the program: gcode, apt, table or rows [default: as its content says].
    #[arg(long = "as", value_name = "FORMAT", value_parser = known(|name| Format::named(name).is_some(), &Format::NAMES))]
    pub format: Option<String>,
    /// Goes on after problems of the program, and lists what was left out.
    #[arg(long, conflicts_with = "strict")]
    pub lenient: bool,
    /// Refuses what the program leaves to the control or to the operator, instead of assuming it.
    #[arg(long)]
    pub strict: bool,
    /// What D means to cutter compensation, in the program's unit, like D3=0.25,D4=0 [default: the size of the tool in
    /// the spindle, which is an assumption].
    #[arg(long, value_name = "D3=SIZE,…", value_parser = diameter, value_delimiter = ',')]
    pub diameters: Vec<(u32, f64)>,
    /// Where a work offset is that the program does not set, in its unit from the zero of the first one that it uses,
    /// like G55=100,0,0; may be given several times.
    #[arg(long, value_name = "G55=X,Y,Z", value_parser = offset, allow_hyphen_values = true)]
    pub offset: Vec<(String, [f64; 3])>,
}

/// How G-code is written.
#[derive(Debug, Args)]
#[command(next_help_heading = "G-code that is written")]
pub(crate) struct WritingOptions {
    /// The control that it is for: linuxcnc, fanuc, haas, siemens, heidenhain or grbl [default: siemens for
    /// .mpf, heidenhain for .h, else linuxcnc].
    #[arg(long, value_name = "NAME", value_parser = known(|name| Controller::named(name).is_some(), &Controller::NAMES))]
    pub dialect: Option<String>,
    /// The machine that it is for: a machine.ron, or the name of a ready one [default: none; tilted tools are vectors,
    /// where the control has them].
    #[arg(long, value_name = "FILE")]
    pub for_machine: Option<String>,
    /// Writes the coordinates of that machine's axes, without tip control.
    #[arg(long, requires = "for_machine")]
    pub axes: bool,
    /// The most decimals of a number.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u8).range(0..=15))]
    pub decimals: u8,
}

/// What a job says, given with a program instead.
#[derive(Debug, Args)]
#[command(next_help_heading = "Programs")]
pub(crate) struct ProgramOptions {
    /// The tools: a library of Fusion 360 (.json) or FreeCAD (.fctl), a tool table (.tbl), or a project of CAMotics.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub tools: Option<PathBuf>,
    /// The stock: auto, block:X0,Y0,Z0,X1,Y1,Z1, or a mesh [default: auto, as the program says or a block around its
    /// path].
    #[arg(long, value_name = "STOCK", value_parser = stock, allow_hyphen_values = true)]
    pub stock: Option<StockOption>,
    /// The design part: a mesh.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub target: Option<PathBuf>,
    #[command(flatten)]
    pub dialect: DialectOptions,
}

#[derive(Debug, Args)]
pub(crate) struct NewOptions {
    /// The program (.nc .cls …), or a project of CAMotics.
    #[arg(value_hint = ValueHint::FilePath)]
    pub program: PathBuf,
    /// The folder of the job [default: that of the program].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub options: ProgramOptions,
    /// The number of dexels, like 300x200 [default: from the smallest tool and the size of the stock].
    #[arg(long, value_name = "NXxNY", value_parser = super::values::cells)]
    pub cells: Option<[usize; 2]>,
    /// Overwrites the job if there is one.
    #[arg(long)]
    pub force: bool,
    /// Prints no summary.
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct InspectOptions {
    /// A job (.ron), program (.nc .cls .csv …), tool library (.json .fctl .tbl), mesh (.stl .ply .glb .3mf .vtp .step)
    /// or dexels (dexels.csv .dexels .npz).
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    #[command(flatten)]
    pub dialect: DialectOptions,
}

/// Accepts the names that a function knows.
fn known(knows: fn(&str) -> bool, names: &'static [&'static str]) -> impl Fn(&str) -> Result<String, String> + Clone {
    move |name| {
        if knows(name) {
            Ok(name.to_owned())
        } else {
            Err(format!("expected one of {}", names.join(", ")))
        }
    }
}
