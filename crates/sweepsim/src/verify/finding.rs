//! What a verification finds.

/// What is wrong with a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum FindingKind {
    /// A shank, holder or other body touches the workpiece.
    Collision,
    /// A rapid move goes through material.
    Rapid,
    /// The cutter or a body touches a fixture.
    Fixture,
    /// The cutter removes material that belongs to the target.
    Gouge,
    /// The cutter removes material while the spindle stands still.
    Spindle,
    /// The cutter removes material before the program has set a feed.
    Feed,
}

impl FindingKind {
    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Collision => "collision",
            Self::Rapid => "rapid",
            Self::Fixture => "fixture",
            Self::Gouge => "gouge",
            Self::Spindle => "spindle",
            Self::Feed => "feed",
        }
    }
}

/// A move that does harm: when, where, and how much.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// What is wrong.
    pub kind: FindingKind,
    /// The toolpath, from 0.
    pub path: usize,
    /// The move of its path, from 0.
    pub number: usize,
    /// The body that touches, by its number in the assembly; `None` for the cutter.
    pub body: Option<usize>,
    /// When it begins, as a fraction of the move's time. Until then, what touches has moved by less than the tolerance.
    pub time: f64,
    /// A point that is touched first, in the world.
    pub place: [f64; 3],
    /// The greatest length, on any line of the grid, of what the move harms; for gouges, the greatest depth below the target's surface.
    pub depth: f64,
    /// The volume that the move harms: the lengths on all lines, times the area of a cell.
    pub volume: f64,
    /// Nothing is touched: it only comes within what the solid [is taken larger](crate::verify::ToolPath::with_larger) by. Time, place, depth and volume are
    /// those of the larger solid.
    pub near: bool,
    /// The courses of a rapid on which this happens, if it has [another course](crate::verify::OtherCourse). Time, place, depth and volume are those of the
    /// straight one, unless nothing happens there.
    pub courses: Option<RapidCourses>,
}

/// Courses of a rapid move, where it is not known which of them the machine takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum RapidCourses {
    /// The path's own.
    Own,
    /// The other one.
    Other,
    /// Both.
    Both,
}

/// The state of the machine during a move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MoveState {
    /// The move is a rapid.
    pub rapid: bool,
    /// The spindle stands still.
    pub spindle_stopped: bool,
    /// The program has set no feed yet.
    pub no_feed: bool,
}

impl MoveState {
    /// A feed move with the spindle turning.
    pub const FEED: Self = Self {
        rapid: false,
        spindle_stopped: false,
        no_feed: false,
    };
    /// A rapid move with the spindle turning.
    pub const RAPID: Self = Self {
        rapid: true,
        spindle_stopped: false,
        no_feed: false,
    };

    /// The same with the spindle at rest, or not.
    #[must_use]
    pub fn with_spindle_stopped(self, stopped: bool) -> Self {
        Self {
            spindle_stopped: stopped,
            ..self
        }
    }

    /// The same before the first feed, or after it.
    #[must_use]
    pub fn with_no_feed(self, missing: bool) -> Self {
        Self {
            no_feed: missing,
            ..self
        }
    }

    /// What it means if the cutter removes material in such a move.
    pub(super) fn forbids_cutting(self) -> Option<FindingKind> {
        match self {
            Self { rapid: true, .. } => Some(FindingKind::Rapid),
            Self {
                spindle_stopped: true, ..
            } => Some(FindingKind::Spindle),
            Self { no_feed: true, .. } => Some(FindingKind::Feed),
            _ => None,
        }
    }
}
