//! From a job or an NC program to a verdict, in memory.
//!
//! A program in a string, judged: the tool is given in code, the stock is a block, and the part that is wanted a mesh
//! in memory.
//!
//! ```
//! use sweepsim_job::dexel::{Stock, TriangleSoup};
//! use sweepsim_job::{Request, Verdict, motion::Tool};
//!
//! // Faces a block, 2 mm deep in two passes. The second is too deep.
//! let program = "G21 G90\nT1 M6\nS8000 M3\nG0 X-8 Y5 Z5\nG0 Z-2\nG1 X48 F600\nG1 Y15 Z-2.5\nG1 X-8\nG0 Z5\nM30\n";
//! let outcome = Request::from_program("facing.nc", program)
//!     .tool(1, Tool::flat(6.0, 20.0)?)
//!     .stock(Stock::Block { min: [0.0, 0.0, -10.0], max: [40.0, 20.0, 0.0] })
//!     .target(TriangleSoup::block([0.0, 0.0, -10.0], [40.0, 20.0, -2.0]))
//!     .limits(0.05, 0.1)
//!     .cells([80, 40])
//!     .plan()?
//!     .run(&())?;
//!
//! assert_eq!(outcome.verdict(), Some(Verdict::Fail));
//! let found: Vec<String> = outcome
//!     .findings()
//!     .iter()
//!     .map(|f| format!("{:?} {} {:?} {:.2} mm", f.line, f.kind, f.text, f.depth))
//!     .collect();
//! assert_eq!(found, [r#"Some(8) gouge Some("G1 X-8") 0.50 mm"#]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Request`] says what is wanted. [`Request::plan`] reads it: the [`Plan`] has the job, what was found in the
//! program, and what nobody says and was guessed, each with its reason. [`Plan::run`] computes the [`Outcome`]:
//! verdict, findings, part, and what each tool did. [`Outcome::write`] makes meshes, pictures and the page, and passes
//! them to a folder or any other [`Sink`].
//!
//! Nothing is printed, no process is ended, and no state is shared between runs. Files are read where a request names
//! them, and written where the caller says. A [`Monitor`] is told the progress and may cancel all of it ([an
//! example](Plan::run)). The work is shared out among the threads of the current rayon pool; their number does not
//! affect the results.
//!
//! | what | how |
//! | --- | --- |
//! | simulate, verify or sweep a job or a program | [`Request::plan`], [`Plan::run`] |
//! | one shard of a run, and all of them joined | [`Plan::shard`], [`Merge`] |
//! | the section of a swept volume by a plane | [`Plan::section`] |
//! | a certificate checked | [`check`] |
//! | two parts compared | [`CompareRequest`] |
//! | a file in another format | [`ConvertRequest`] |
//! | what is in a file | [`describe`] |
//! | findings for continuous integration | [`Outcome::ci`], [`JobError::ci`] |

mod base;
mod describe;
mod frames;
mod page;
mod parts;
mod request;
mod run;
mod session;
mod shards;
mod show;
mod verify;
mod warnings;

pub use base::{Content, Folder, JobError, Memory, Sink, folder_name, output_folder, sentences, words};
pub use describe::{Description, describe, tool_in_words};
pub use parts::{
    Alignment, CompareRequest, ConvertRequest, DeviationLimits, Difference, GridOptions, Pair, Part, WritingOptions,
};
pub use request::{
    DialectOptions, Directions, Input, Judging, Output, ProgramOptions, Request, StockOption, SweepOptions, Task,
    ViewOptions,
};
pub use run::{Merge, Outcome, PlaneSection, Reused, ShardPiece, Written};
pub use session::{Guess, Plan};
pub use shards::ShardNumber;
pub use sweepsim::Monitor;
pub use sweepsim_check::Measure;
pub use sweepsim_dexel as dexel;
pub use sweepsim_formats::{
    Annotation, AnnotationLevel, CiCase, CiProgram, Job, MoveSummary, Report, ReportedFinding, Statement,
    StatementState, Verdict, to_junit, to_sarif,
};
pub use sweepsim_motion as motion;
pub use verify::{CheckedCertificate, CheckedStatement, check};
pub use warnings::is_covered;

/// The examples of the README are tested as well.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
