//! What a verification finds.

use std::collections::BTreeMap;

/// What is wrong with a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// The courses of a rapid on which this happens, if it has [another course](sweepsim_motion::OtherCourse). Time, place, depth and volume are those of the
    /// straight one, unless nothing happens there.
    pub courses: Option<RapidCourses>,
}

impl Finding {
    /// The harm it tells of: that of one kind that a move does with its cutter, or with a body.
    pub(super) fn harm(&self) -> (usize, usize, FindingKind, Option<usize>) {
        (self.path, self.number, self.kind, self.body)
    }

    /// Takes what another finding of the same harm knows better.
    fn learn(&mut self, other: &Self) {
        // What touches says more than what only comes near.
        let better = (other.near, other.time) < (self.near, self.time);
        if better {
            (self.near, self.time, self.place) = (other.near, other.time, other.place);
        }
        self.depth = self.depth.max(other.depth);
        self.volume = self.volume.max(other.volume);
        self.courses = match (self.courses, other.courses) {
            (Some(a), Some(b)) if a != b => Some(RapidCourses::Both),
            (own, other) => own.or(other),
        };
    }
}

/// The findings of one program on dexels of several directions, as one list in the order of the program.
///
/// Harm that was found along several directions is one finding: with the earliest time and the place that belongs to it, and with the greatest depth and volume of all of them.
#[must_use]
pub fn joined(directions: impl IntoIterator<Item = Vec<Finding>>) -> Vec<Finding> {
    let mut all: BTreeMap<_, Finding> = BTreeMap::new();
    for finding in directions.into_iter().flatten() {
        all.entry(finding.harm())
            .and_modify(|known| known.learn(&finding))
            .or_insert(finding);
    }
    in_order(all.into_values())
}

/// In the order of the program, of findings that are sorted by harm.
pub(super) fn in_order(findings: impl Iterator<Item = Finding>) -> Vec<Finding> {
    let mut all: Vec<Finding> = findings.collect();
    // A stable sort: at one time in the order of kinds.
    all.sort_by(|a, b| {
        (a.path, a.number)
            .cmp(&(b.path, b.number))
            .then(a.time.total_cmp(&b.time))
    });
    all
}

/// Courses of a rapid move, where it is not known which of them the machine takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(number: usize, time: f64, depth: f64, near: bool) -> Finding {
        Finding {
            kind: FindingKind::Rapid,
            path: 0,
            number,
            body: None,
            time,
            place: [time, depth, 0.0],
            depth,
            volume: 10.0 * depth,
            near,
            courses: None,
        }
    }

    #[test]
    fn harm_seen_from_several_directions_is_one_finding() {
        let mut collision = finding(4, 0.5, 3.0, false);
        (collision.kind, collision.body) = (FindingKind::Collision, Some(0));
        let along_z = vec![finding(4, 0.3, 1.0, false), finding(7, 0.1, 2.0, true)];
        let along_x = vec![
            finding(2, 0.9, 0.5, false),
            collision,
            finding(4, 0.2, 0.25, false),
            finding(7, 0.6, 1.0, false),
        ];
        let all = joined([along_z, along_x]);
        let told: Vec<_> = all
            .iter()
            .map(|f| (f.number, f.kind, f.time, f.depth, f.near))
            .collect();
        assert_eq!(
            told,
            [
                (2, FindingKind::Rapid, 0.9, 0.5, false),
                (4, FindingKind::Rapid, 0.2, 1.0, false),
                (4, FindingKind::Collision, 0.5, 3.0, false),
                (7, FindingKind::Rapid, 0.6, 2.0, false),
            ]
        );
        // The place belongs to the time.
        assert_eq!(all[1].place, [0.2, 0.25, 0.0]);
        assert_eq!(joined([all.clone(), Vec::new()]), all);
    }

    #[test]
    fn courses_of_several_directions_come_together() {
        let mut own = finding(1, 0.5, 1.0, false);
        own.courses = Some(RapidCourses::Own);
        let mut other = own;
        other.courses = Some(RapidCourses::Other);
        assert_eq!(joined([vec![own], vec![other]])[0].courses, Some(RapidCourses::Both));
        assert_eq!(joined([vec![own], vec![own]])[0].courses, Some(RapidCourses::Own));
    }
}
