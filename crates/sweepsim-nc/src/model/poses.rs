//! The poses of a program, in little memory.

use std::ops::Deref;
use std::sync::OnceLock;

use sweepsim_motion::{Move, PackedMoves, PackedPoses, PackedRows, Pose};

use super::pose::{FeedMode, ProgramPose};

/// Shorter programs are kept as they are.
const SHORT: usize = 1 << 12;
/// So many poses have one entry in the index of moves that are not straight.
const INDEXED: usize = 64;

const RAPID: u32 = 1;
const JOINED: u32 = 2;
const TIP_CONTROL: u32 = 4;
const EXACT_STOP: u32 = 8;
const WAY: u32 = 16;
const FEED: u32 = 32;
const PER_REVOLUTION: u32 = 64;
const INVERSE_TIME: u32 = 128;
const FIXED: [u32; 3] = [256, 512, 1024];

/// The poses of a program in order, as a slice of [`ProgramPose`]s.
///
/// Those of a long program are packed: they take a few bytes each. They are unpacked when they are first used as a slice, and take 160 bytes each from then on;
/// [`in_order`](Self::in_order) and iteration by value do without.
///
/// ```
/// use sweepsim_nc::{ReadOptions, gcode};
/// let program = gcode::read("G21 G90\nG0 X0 Y0 Z5\nG1 X40 F200\nM30\n", &ReadOptions::default())?;
/// assert_eq!(program.poses[1].pose.tip(), [40.0, 0.0, 5.0]);
/// assert!(program.poses.in_order().eq(program.poses.iter().cloned()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Default)]
pub struct ProgramPoses {
    plain: Vec<ProgramPose>,
    packed: Option<Box<Packed>>,
    unpacked: OnceLock<Vec<ProgramPose>>,
}

#[derive(Clone, Default)]
struct Packed {
    poses: PackedPoses,
    /// Flags, file, line, tool and call (each 0 if there is none, otherwise one more), feed (the last one, where there is none).
    rows: PackedRows<6>,
    /// Moves that are not straight, by SLERP.
    ways: PackedMoves,
    /// How many of them come before every 64th pose.
    ways_before: Vec<u32>,
    last: Option<ProgramPose>,
    feed: f64,
}

impl Packed {
    fn push(&mut self, pose: ProgramPose) {
        if self.rows.len().is_multiple_of(INDEXED) {
            self.ways_before.push(self.ways.len() as u32);
        }
        let flag = |is: bool, flag: u32| if is { flag } else { 0 };
        let mut flags = flag(pose.rapid, RAPID)
            | flag(pose.joined, JOINED)
            | flag(pose.tip_control, TIP_CONTROL)
            | flag(pose.exact_stop, EXACT_STOP)
            | flag(pose.feed.is_some(), FEED)
            | (0..3).map(|k| flag(pose.fixed[k], FIXED[k])).sum::<u32>()
            | match pose.feed_mode {
                FeedMode::PerMinute => 0,
                FeedMode::PerRevolution => PER_REVOLUTION,
                FeedMode::InverseTime => INVERSE_TIME,
            };
        let way = pose.way();
        if way != Move::default() {
            flags |= WAY;
            self.ways.push(&way);
        }
        self.feed = pose.feed.unwrap_or(self.feed);
        let number = |number: Option<u32>| number.map_or(0.0, |number| f64::from(number) + 1.0);
        let (file, line) = (pose.file as f64, pose.line as f64);
        let (tool, call) = (number(pose.tool), number(pose.call));
        self.poses.push(&pose.pose);
        self.rows.push([f64::from(flags), file, line, tool, call, self.feed]);
        self.last = Some(pose);
    }

    fn in_order(&self, first: usize) -> impl Iterator<Item = ProgramPose> + '_ {
        // From the indexed pose before the first one.
        let from = first - first % INDEXED;
        let before = self.ways_before.get(from / INDEXED).copied().unwrap_or_default() as usize;
        let mut ways = self.ways.range(before..self.ways.len());
        let end = self.rows.len();
        let rows = self.poses.range(from..end).zip(self.rows.range(from..end));
        let poses = rows.map(move |(pose, row)| of_row(pose, &row, || ways.next()));
        poses.skip(first - from)
    }
}

fn of_row(pose: Pose, row: &[f64; 6], way: impl FnOnce() -> Option<Move>) -> ProgramPose {
    let [flags, file, line, tool, call, feed] = *row;
    let flags = flags as u32;
    let is = |flag: u32| flags & flag != 0;
    let number = |number: f64| (number > 0.0).then_some((number - 1.0) as u32);
    let mut pose = ProgramPose::new(pose, line as usize);
    pose.rapid = is(RAPID);
    pose.file = file as usize;
    pose.joined = is(JOINED);
    pose.tool = number(tool);
    pose.feed = is(FEED).then_some(feed);
    pose.feed_mode = match (is(PER_REVOLUTION), is(INVERSE_TIME)) {
        (true, _) => FeedMode::PerRevolution,
        (_, true) => FeedMode::InverseTime,
        _ => FeedMode::PerMinute,
    };
    pose.call = number(call);
    pose.tip_control = is(TIP_CONTROL);
    pose.exact_stop = is(EXACT_STOP);
    pose.fixed = FIXED.map(is);
    if is(WAY) {
        pose.set_way(way().unwrap_or_default());
    }
    pose
}

impl ProgramPoses {
    /// Appends a pose.
    pub fn push(&mut self, pose: ProgramPose) {
        self.unpacked = OnceLock::new();
        match &mut self.packed {
            Some(packed) => packed.push(pose),
            None => {
                self.plain.push(pose);
                if self.plain.len() == SHORT {
                    let mut packed = Box::<Packed>::default();
                    std::mem::take(&mut self.plain)
                        .into_iter()
                        .for_each(|pose| packed.push(pose));
                    self.packed = Some(packed);
                }
            }
        }
    }

    /// The number of poses.
    #[must_use]
    pub fn len(&self) -> usize {
        self.packed
            .as_ref()
            .map_or(self.plain.len(), |packed| packed.rows.len())
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The last pose.
    #[must_use]
    pub fn last(&self) -> Option<&ProgramPose> {
        match &self.packed {
            Some(packed) => packed.last.as_ref(),
            None => self.plain.last(),
        }
    }

    /// The poses one after the other, without unpacking all of them.
    pub fn in_order(&self) -> impl Iterator<Item = ProgramPose> + '_ {
        let packed = self.packed.iter().flat_map(|packed| packed.in_order(0));
        self.plain.iter().cloned().chain(packed)
    }

    /// A pose, without unpacking all of them; `None` beyond the last.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<ProgramPose> {
        match &self.packed {
            Some(packed) if index < packed.rows.len() => packed.in_order(index).next(),
            Some(_) => None,
            None => self.plain.get(index).cloned(),
        }
    }
}

/// Gives up the memory of the poses as they are taken.
impl IntoIterator for ProgramPoses {
    type Item = ProgramPose;
    type IntoIter = Box<dyn Iterator<Item = ProgramPose>>;

    fn into_iter(self) -> Self::IntoIter {
        match self.packed {
            Some(packed) => {
                let mut ways = packed.ways.into_iter();
                let rows = packed.poses.into_iter().zip(packed.rows);
                Box::new(rows.map(move |(pose, row)| of_row(pose, &row, || ways.next())))
            }
            None => Box::new(self.plain.into_iter()),
        }
    }
}

impl<'a> IntoIterator for &'a ProgramPoses {
    type Item = &'a ProgramPose;
    type IntoIter = std::slice::Iter<'a, ProgramPose>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Deref for ProgramPoses {
    type Target = [ProgramPose];

    fn deref(&self) -> &[ProgramPose] {
        match &self.packed {
            Some(_) => self.unpacked.get_or_init(|| self.in_order().collect()),
            None => &self.plain,
        }
    }
}

impl FromIterator<ProgramPose> for ProgramPoses {
    fn from_iter<I: IntoIterator<Item = ProgramPose>>(poses: I) -> Self {
        let mut made = Self::default();
        poses.into_iter().for_each(|pose| made.push(pose));
        made
    }
}

impl From<Vec<ProgramPose>> for ProgramPoses {
    fn from(poses: Vec<ProgramPose>) -> Self {
        poses.into_iter().collect()
    }
}

impl PartialEq for ProgramPoses {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.in_order().eq(other.in_order())
    }
}

impl std::fmt::Debug for ProgramPoses {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.in_order()).finish()
    }
}
