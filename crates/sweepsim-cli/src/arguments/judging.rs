//! What `verify` looks at.

use super::values::{length, pair, triple};
use clap::{Args, ValueHint};
use std::path::PathBuf;
use sweepsim_job as job;

/// What `verify` looks at.
#[derive(Debug, Args)]
pub(crate) struct JudgeOptions {
    /// Ends at the first finding.
    #[arg(long)]
    pub first: bool,
    /// How deep gouges and how high remaining material may be, like 0.02,0.1 in millimetres, instead of the job's
    /// [default: 0.1 each].
    #[arg(long, value_name = "GOUGE,EXCESS", value_parser = pair, allow_hyphen_values = true)]
    pub limits: Option<[f64; 2]>,
    /// How near shanks and holders may come to the workpiece and to fixtures, in millimetres, instead of the job's.
    #[arg(long, value_name = "MM", value_parser = length, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Takes shanks and holders larger by half the diagonal between dexels, and cutters in rapids and beside fixtures:
    /// what they touch beside a dexel is found as well.
    #[arg(long)]
    pub sure: bool,
    /// Proves nothing between the lines of the dexels, and leaves no certificate.
    #[arg(long)]
    pub no_proof: bool,
    /// Also writes the certificate of what was proven to this file, for `check`.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["no_proof", "shard"])]
    pub certificate: Option<PathBuf>,
    /// Keeps what is found in this folder: the next run judges a changed program from the change on only, with the same
    /// results.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, conflicts_with_all = ["first", "shard"])]
    pub cache: Option<PathBuf>,
    /// Also writes moves.csv: what each move removes, how deep and how wide, and how long it takes.
    #[arg(long)]
    pub moves: bool,
    /// Judges the machine for all places of the part this far from where it is, like 5,5,2 in millimetres along x, y
    /// and z, one way or the other.
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true)]
    pub offset_range: Option<[f64; 3]>,
    /// Judges the machine for all tools this much longer or shorter than it takes them, in millimetres.
    #[arg(long, value_name = "MM", value_parser = length, allow_hyphen_values = true)]
    pub length_range: Option<f64>,
    /// Looks for another place of the part if the program collides with the machine or meets a limit: a box of offsets
    /// that is proven free. Takes as long as up to some hundred proofs.
    #[arg(long, conflicts_with = "no_proof")]
    pub place: bool,
}

impl JudgeOptions {
    pub fn given(&self) -> job::Judging {
        let mut judging = job::Judging::default();
        (judging.first, judging.clearance) = (self.first, self.clearance);
        (judging.sure, judging.moves) = (self.sure, self.moves);
        (judging.proof, judging.certificate) = (!self.no_proof, self.certificate.is_some());
        judging.offset_range = self.offset_range.unwrap_or_default();
        judging.place = self.place;
        judging.length_range = self.length_range.unwrap_or_default();
        judging
    }
}
