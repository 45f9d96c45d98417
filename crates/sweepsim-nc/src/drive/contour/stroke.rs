//! Moves in the program's coordinates, and what waits with them.

use super::corner::Flat;
use crate::model::event::EventKind;
use crate::model::program::FeedMode;

/// A place in the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ProgramPlace {
    pub file: usize,
    pub line: usize,
    pub call: Option<u32>,
}

/// The plane of a contour: its axes `[u, v, w]` as indices of XYZ, such that a counter-clockwise turn goes from u to v.
pub(crate) type ArcPlane = [usize; 3];

/// A circular arc in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    pub centre: Flat,
    /// Signed, in radians: positive counter-clockwise.
    pub sweep: f64,
}

/// A move in the program's coordinates, from where the last one ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub end: [f64; 3],
    pub abc: [f64; 3],
    pub rapid: bool,
    pub bend: Option<Bend>,
    pub plane: ArcPlane,
    pub place: ProgramPlace,
    pub feed: Option<f64>,
    pub feed_mode: FeedMode,
    pub exact_stop: bool,
}

impl Stroke {
    /// This move as one of so many that share the time of their block, which a feed in inverse time is.
    pub fn share_of(mut self, count: usize) -> Self {
        if self.feed_mode == FeedMode::InverseTime {
            self.feed = self.feed.map(|feed| feed * count as f64);
        }
        self
    }
}

/// What waits for the next move.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Stroke(Stroke),
    Event(EventKind, ProgramPlace),
    /// Something to note.
    Warning(String, ProgramPlace),
}

/// How the tool goes round outside corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Corners {
    /// On an arc about the corner.
    #[default]
    Arcs,
    /// On straight lines, no farther than a radius beyond the corner's normals (Fanuc).
    Lines,
    /// To the point where both offsets meet, and on an arc at corners of more than 100° (Siemens's `G451`).
    Meetings,
}

/// What compensation is switched on with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CompensationSettings {
    pub left: bool,
    /// The tool's radius, at least 0.
    pub radius: f64,
    pub corners: Corners,
    /// The entry move ends beside the start of the next one (Fanuc, Siemens, Heidenhain), rather than beside its own end.
    pub beside_next: bool,
    /// The tool may have to go round the first and the last point of the contour (Siemens's `KONT`).
    pub round_ends: bool,
    /// The angle, in radians, up to which a corner counts as none.
    pub tangent: f64,
}

/// A point's coordinates in the plane.
pub(super) fn flat(plane: ArcPlane, point: [f64; 3]) -> Flat {
    [point[plane[0]], point[plane[1]]]
}

/// Changes a point's coordinates in the plane.
pub(super) fn set(plane: ArcPlane, point: &mut [f64; 3], at: Flat) {
    point[plane[0]] = at[0];
    point[plane[1]] = at[1];
}
