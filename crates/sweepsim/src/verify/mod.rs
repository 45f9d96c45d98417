//! Whether a program may be run: every move that does harm, in the order of the program.
//!
//! The stock before each move is that which the moves before it have left, so a collision is judged against the workpiece as it is at that moment, and
//! not as it is at the end. [`verify`] removes what each run of moves sweeps and looks for
//!
//! | finding | what overlaps |
//! | --- | --- |
//! | [`Collision`](FindingKind::Collision) | a body, at some time, and the workpiece at that time |
//! | [`Rapid`](FindingKind::Rapid), [`Spindle`](FindingKind::Spindle), [`Feed`](FindingKind::Feed) | the cutter in a move that must not cut, and the workpiece |
//! | [`Fixture`](FindingKind::Fixture) | the cutter or a body, and a fixture |
//! | [`Gouge`](FindingKind::Gouge) | the cutter, the workpiece, and the target farther below its surface than the limit |
//!
//! What is left at the end is compared with the target by [`deviations`].
//!
//! No such move is missed on the lines of the grid; what is narrower than their distance may hide between them. Grids in [frames](sweepsim_dexel::Frame) look along other directions;
//! [`joined`] makes one list of what is found along several. [`verify_tiles`] judges parts of a grid by themselves, in other processes if need be.

mod depth;
mod deviation;
mod driver;
mod finding;
mod lines;
mod record;
mod regions;
mod run;
mod scene;
mod search;
pub(crate) mod solid;
mod target;

pub use deviation::{
    AreaShare, Deviation, DeviationKind, Deviations, Look, Region, TileDeviation, deviations, deviations_along,
};
pub use driver::{
    Checkpoints, RunOfMoves, TileNotes, TileState, TileVerification, runs_of, verify, verify_tiles, verify_tiles_from,
};
pub use finding::{Finding, FindingKind, MoveState, RapidCourses, joined};
pub use record::{Judgement, TileRecord};
pub use scene::{MoveRemoval, PathRemoval, Scene, ToolPath, Verification, VerifyOptions};
pub use target::{Target, TargetError, TargetRegion, TargetShape};
