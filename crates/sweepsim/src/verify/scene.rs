//! What is verified, and the result.

use super::finding::{Finding, MoveState};
use super::target::Target;
use crate::sweep::{Options, UnresolvedDexel};
use sweepsim_dexel::Dexels;
use sweepsim_motion::{Assembly, OtherCourses, Path};

/// A cutter with its bodies, a path, and the state of the machine in each move.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ToolPath<'a> {
    /// The cutter and the bodies that move with it.
    pub assembly: &'a Assembly,
    /// The path.
    pub path: &'a Path,
    /// The state in each move; [`MoveState::FEED`] in moves beyond the end of the list.
    pub states: &'a [MoveState],
    /// The same cutter and bodies, each as large as what must stay clear.
    pub larger: Option<&'a Assembly>,
    /// Other courses that moves may take.
    pub other_courses: Option<&'a OtherCourses>,
    /// What nothing must touch along this path, on a grid of its own in the frame of the stock's grid: the fixtures of its set-up. `None`: those of the [`Scene`].
    pub fixtures: Option<&'a Dexels>,
}

impl<'a> ToolPath<'a> {
    /// Feed moves with the spindle turning.
    #[must_use]
    pub fn new(assembly: &'a Assembly, path: &'a Path) -> Self {
        Self {
            assembly,
            path,
            states: &[],
            larger: None,
            other_courses: None,
            fixtures: None,
        }
    }

    /// With fixtures of its own, in place of those of the scene: each set-up has others. The part stays where it is, so paths and fixtures of all set-ups are in the frame of
    /// the part (see [`Path::moved`]).
    #[must_use]
    pub fn with_fixtures(self, fixtures: &'a Dexels) -> Self {
        let fixtures = Some(fixtures);
        Self { fixtures, ..self }
    }

    /// Sets the state of the machine in each move.
    #[must_use]
    pub fn with_states(self, states: &'a [MoveState]) -> Self {
        Self { states, ..self }
    }

    /// Looks for what larger solids touch: the same cutter and bodies in the same order, each holding its own. A [`Finding`] tells whether the solid itself
    /// touches or only [comes near](Finding::near). Removal and gouges are those of the assembly's own cutter.
    ///
    /// A rapid that withdraws the cutter along its axis, away from where it has cut, is not near the walls there.
    #[must_use]
    pub fn with_larger(self, larger: &'a Assembly) -> Self {
        let larger = Some(larger);
        Self { larger, ..self }
    }

    /// Also judges moves on other courses, which may meet the stock before their run.
    #[must_use]
    pub fn with_other_courses(self, other_courses: &'a OtherCourses) -> Self {
        let other_courses = Some(other_courses);
        Self { other_courses, ..self }
    }

    pub(super) fn state(&self, number: usize) -> MoveState {
        self.states.get(number).copied().unwrap_or_default()
    }
}

/// What the tools move in.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Scene<'a> {
    /// The workpiece before the first move.
    pub stock: Dexels,
    /// What nothing must touch, on a grid of its own in the frame of the stock's grid.
    pub fixtures: Option<&'a Dexels>,
    /// The part that is wanted, on the stock's grid.
    pub target: Option<&'a Target>,
}

impl<'a> Scene<'a> {
    /// A workpiece alone.
    #[must_use]
    pub fn new(stock: Dexels) -> Self {
        Self {
            stock,
            fixtures: None,
            target: None,
        }
    }

    /// With fixtures.
    #[must_use]
    pub fn with_fixtures(self, fixtures: &'a Dexels) -> Self {
        let fixtures = Some(fixtures);
        Self { fixtures, ..self }
    }

    /// With the part that is wanted.
    #[must_use]
    pub fn with_target(self, target: &'a Target) -> Self {
        let target = Some(target);
        Self { target, ..self }
    }
}

/// Options of [`verify`](fn@crate::verify::verify).
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct VerifyOptions {
    /// Options of the sweeps. Their method is charts, whatever is chosen here.
    pub sweep: Options,
    /// Whether to find what each single move removes. It takes a sweep of each.
    pub each_move: bool,
    /// For [`verify_tiles`](super::verify_tiles): whether all tiles end after the run of at most 256 moves in which the first finding is.
    pub first: bool,
    /// The last move to judge, by path and number: what is left of its run of at most 256 moves is judged as well.
    pub until: Option<(usize, usize)>,
}

impl VerifyOptions {
    /// These options of the sweeps.
    #[must_use]
    pub fn new(sweep: Options) -> Self {
        Self {
            sweep,
            ..Self::default()
        }
    }

    /// Also finds what each single move removes.
    #[must_use]
    pub fn each_move(self, wanted: bool) -> Self {
        Self {
            each_move: wanted,
            ..self
        }
    }

    /// Ends at the first finding.
    #[must_use]
    pub fn first(self, wanted: bool) -> Self {
        Self { first: wanted, ..self }
    }

    /// Ends after the run with this move of this path.
    #[must_use]
    pub fn until(self, last: Option<(usize, usize)>) -> Self {
        Self { until: last, ..self }
    }
}

/// What a toolpath removes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PathRemoval {
    /// Its volume.
    pub volume: f64,
}

/// What a move removes, and how its cutter engages.
///
/// Each point that is removed is seen from the tool at the time of the move at which the tool's axis is nearest to it, the earliest of them: so many
/// millimetres above the tip along the axis, and so many across the feed, which is the way of the axis's nearest point. In moves without turns
/// these are exact on the lines of the grid; in others the tool is placed at 128 times, and so many points of each interval are looked at as there
/// are cells along it, at most 17.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MoveRemoval {
    /// The toolpath.
    pub path: usize,
    /// The move of its path.
    pub number: usize,
    /// The volume; 0 for moves that remove nothing.
    pub volume: f64,
    /// The axial depth: between the lowest and the highest point above the tip. In a plunge that is the depth of what is drilled.
    pub depth: f64,
    /// The radial width: between the farthest points on both sides of the axis, across the feed. In a plunge, which feeds along the axis, the
    /// larger of two widths at right angles.
    pub width: f64,
}

/// The result of [`verify`](fn@crate::verify::verify).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Verification {
    /// What remains of the stock.
    pub remaining: Dexels,
    /// All findings, in the order of the program.
    pub findings: Vec<Finding>,
    /// What each toolpath removes.
    pub paths: Vec<PathRemoval>,
    /// What each move removes, if [asked for](VerifyOptions::each_move).
    pub moves: Vec<MoveRemoval>,
    /// Crossings found, but for those of the search within runs.
    pub crossings: u64,
    /// Dexels of sweeps that could not be certified.
    pub unresolved: Vec<UnresolvedDexel>,
    /// Moves, by path and number, in which a body follows its cutter so closely that it is not known whether it touches.
    pub undecided: Vec<(usize, usize)>,
    /// Whether the receiver of the findings, or [`VerifyOptions::until`], ended the verification early.
    pub stopped: bool,
}
