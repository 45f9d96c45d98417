//! A closed surface that a line enters and leaves, in the course of time: how its two sheets over a line move, and where they turn.
//!
//! On each sheet, `g` has the sign of the speed at which the surface moves outwards. A sheet that begins (the line comes under the surface from the side) begins
//! with `g > 0`, one that ends does so with `g < 0`. Where `g` falls whenever it is 0, a sheet that exists without interruption therefore has at most one zero, and
//! has one if `g > 0` at its beginning and `g < 0` at its end: the signs at the ends of a span decide.

use super::blocks::blocks;
use super::course::{Course, Moment};
use super::intervals::{Range, Sign};
use super::spans::{Span, Verdict};
use super::zero::{Known, Sample, Turn, zero};
use super::{Leftover, Searching};
use crate::methods::harvest::unit;
use nalgebra::Vector3;
use std::cell::Cell;
use sweepsim_dexel::Source;

/// A span of one line is halved this many times at most, one half after the other,
const DEEPEST: u32 = 12;
/// and in all: where a tool turns about a point of its axis, no half tells more than the whole.
const HALVINGS: u32 = 40;
/// So many lines of a span may be left to charts in any case.
const FEW: usize = 12;

/// Where a line meets the surface at a time. The rest is 0 if it does not.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Meeting {
    /// The square of `half`; the line is beside the surface if it is not positive.
    pub room: f64,
    /// Half of what is between the sheets, in the measure of the surface.
    pub half: f64,
    pub place: [f64; 2],
    /// `g` times a positive constant, below and above.
    pub g: [f64; 2],
}

impl Meeting {
    pub fn beside(room: f64, place: [f64; 2]) -> Self {
        Self {
            room,
            place,
            ..Self::default()
        }
    }
}

/// How a line passes under a surface during a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    Beside,
    Inside,
    Enters,
    Leaves,
    /// It may be inside in between.
    Through,
    /// It may enter or leave more than once.
    Unknown,
}

/// Whether `g` falls on a sheet whenever it is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Falls {
    Always,
    /// The sheet is beyond the ends of the piece.
    Beyond,
    Unknown,
}

/// A point of a sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub height: f64,
    /// Of any length.
    pub normal: Vector3<f64>,
    /// On the tool's axis, as the ends of the piece are.
    pub along: f64,
    /// Of `along`.
    pub error: f64,
}

/// The range of a piece on the tool's axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    range: [f64; 2],
}

impl Ends {
    pub fn new(range: [f64; 2]) -> Self {
        Self { range }
    }

    /// Whether a point lies between them, if that is certain.
    pub fn hold(&self, along: f64, error: f64) -> Option<bool> {
        let [low, high] = self.range;
        if along > low + error && along < high - error {
            Some(true)
        } else if along < low - error || along > high + error {
            Some(false)
        } else {
            None
        }
    }
}

/// A closed surface of the tool, extended beyond the ends of its piece. Sheets: 0 is below, 1 above.
pub(super) trait Shell {
    /// What it needs to know of a moment.
    type Posed: Copy;
    /// What it knows about a span.
    type Limits;

    fn at(&self, moment: &Moment) -> Self::Posed;

    fn meet(&self, at: &Self::Posed, line: [f64; 2]) -> Meeting;

    /// Between two times that are this far apart, within the span.
    fn passage(&self, limits: &Self::Limits, ends: [&Meeting; 2], length: f64) -> Passage;

    /// Whether `g` falls on a sheet whenever it is 0 between two times.
    fn falls(&self, limits: &Self::Limits, ends: [(&Self::Posed, &Meeting); 2], length: f64, sheet: usize) -> Falls;

    /// The signs of `g` on both sheets over a block of lines, at all times between two.
    fn signs(&self, limits: &Self::Limits, poses: [&Self::Posed; 2], block: [Range; 2], length: f64) -> [Sign; 2];

    /// Whether the sign of `g` may be that of a rounding error.
    fn doubtful(&self, limits: &Self::Limits, meeting: &Meeting, sheet: usize) -> bool;

    /// The derivative of `g`, and that of the height, along the line.
    fn slope(&self, at: &Self::Posed, meeting: &Meeting, sheet: usize) -> [f64; 2];

    /// The derivatives of `g` along x and y, at one time.
    fn gradient(&self, at: &Self::Posed, meeting: &Meeting, sheet: usize) -> [f64; 2];

    fn spot(&self, at: &Self::Posed, meeting: &Meeting, sheet: usize, slack: f64) -> Spot;

    /// How fast points of the surface move.
    fn speed(&self, at: &Self::Posed) -> f64;

    fn ends(&self) -> Ends;

    /// The share of a span after which a line is probably inside that is beside the surface at both ends.
    fn nearest(&self, ends: [&Meeting; 2]) -> f64;

    /// Whether a sheet is certain to be beyond the ends of the piece over a line: worth asking where many are.
    fn misses(&self, _: &Self::Limits, _: [&Self::Posed; 2], _line: ([f64; 2], f64), _sheet: usize) -> bool {
        false
    }
}

/// A line at one time.
pub(super) type View<P> = (f64, P, Meeting);

/// A search of a shell along one span of a course.
pub(super) struct ShellSearch<'a, S: Shell, F> {
    pub shell: &'a S,
    pub course: &'a Course,
    pub limits: &'a S::Limits,
    pub source: F,
    /// Lines that are left to charts.
    pub left: &'a mut Leftover,
    /// How often the span of the line may still be halved.
    halvings: u32,
    /// Of each sheet, what was found last.
    last: [Option<Known>; 2],
}

/// What is not decided about a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Undecided {
    /// Closer than rounding errors: it has to be displaced.
    Close,
    /// Charts can tell.
    Intricate,
}

impl<'a, S: Shell, F: Fn(f64) -> Source> ShellSearch<'a, S, F> {
    pub fn new((shell, limits): (&'a S, &'a S::Limits), course: &'a Course, source: F, left: &'a mut Leftover) -> Self {
        Self {
            shell,
            course,
            limits,
            source,
            left,
            halvings: HALVINGS,
            last: [None; 2],
        }
    }

    /// The crossings of the lines of a box in a span.
    pub fn lines(&mut self, searching: &mut Searching, span: &Span, area: [Range; 2]) -> Verdict {
        let (shell, limits) = (self.shell, self.limits);
        let [a, b] = [&span.from, &span.to].map(|moment| shell.at(moment));
        let lines = searching.collector.lines;
        let (length, mark) = (span.bounds.length, searching.collector.mark());
        // If most lines are intricate, charts may as well have all of them.
        let hopeless = Cell::new(false);
        let mut visited = 0;
        blocks(
            lines,
            area,
            |block| hopeless.get() || !shell.signs(limits, [&a, &b], block, length).contains(&Sign::Unknown),
            |place, line| {
                if hopeless.get() {
                    return;
                }
                let views = [
                    (span.from.t, a, shell.meet(&a, line)),
                    (span.to.t, b, shell.meet(&b, line)),
                ];
                self.line(searching, place, line, [&views[0], &views[1]]);
                visited += 1;
                let left = self.left.lines.len();
                hopeless.set(left > FEW && 2 * left > visited);
            },
        );
        if hopeless.get() {
            searching.collector.forget(mark);
            self.left.lines.clear();
            return Verdict::Intricate;
        }
        Verdict::Settled
    }

    /// The crossings of a line between two times.
    #[inline]
    fn line(&mut self, searching: &mut Searching, (i, j): (usize, usize), line: [f64; 2], ends: [&View<S::Posed>; 2]) {
        let mark = searching.collector.mark();
        self.halvings = HALVINGS;
        if let Err(undecided) = self.between(searching, (i, j), line, ends, 0) {
            searching.collector.forget(mark);
            if !searching.collector.lines.asks(i, j) {
                return;
            }
            let number = searching.collector.lines.line(i, j);
            match undecided {
                Undecided::Close => searching.collector.open(number),
                Undecided::Intricate => self.left.lines.push(number as u32),
            }
        }
    }

    fn between(
        &mut self,
        searching: &mut Searching,
        place: (usize, usize),
        line: [f64; 2],
        [from, to]: [&View<S::Posed>; 2],
        depth: u32,
    ) -> Result<(), Undecided> {
        let length = to.0 - from.0;
        let passage = self.shell.passage(self.limits, [&from.2, &to.2], length);
        let sheets = match passage {
            Passage::Beside => return Ok(()),
            Passage::Through | Passage::Unknown => [Falls::Unknown; 2],
            Passage::Inside | Passage::Enters | Passage::Leaves => {
                let ends = [(&from.1, &from.2), (&to.1, &to.2)];
                [0, 1].map(|sheet| self.shell.falls(self.limits, ends, length, sheet))
            }
        };
        if sheets.contains(&Falls::Unknown) {
            if depth == DEEPEST || self.halvings == 0 {
                return Err(Undecided::Intricate);
            }
            self.halvings -= 1;
            let share = match passage {
                Passage::Through => self.shell.nearest([&from.2, &to.2]),
                _ => 0.5,
            };
            let t = from.0 + share * length;
            let posed = self.shell.at(&self.course.at(t));
            let middle = (t, posed, self.shell.meet(&posed, line));
            self.between(searching, place, line, [from, &middle], depth + 1)?;
            return self.between(searching, place, line, [&middle, to], depth + 1);
        }
        for sheet in (0..2).filter(|sheet| sheets[*sheet] == Falls::Always) {
            let outwards = |view: &View<S::Posed>, there: bool| {
                if there {
                    view.2.g[sheet] >= 0.0
                } else {
                    view.0 == from.0
                }
            };
            let there = [passage != Passage::Enters, passage != Passage::Leaves];
            for (view, there) in [from, to].into_iter().zip(there) {
                if there && self.shell.doubtful(self.limits, &view.2, sheet) {
                    return Err(Undecided::Close);
                }
            }
            match (outwards(from, there[0]), outwards(to, there[1])) {
                (true, false) => self.turn(searching, place, line, ([from, to], there), sheet)?,
                (false, true) => return Err(Undecided::Intricate),
                _ => {}
            }
        }
        Ok(())
    }

    /// The place where a sheet turns, of which there is exactly one: Newton's method in a bracket.
    fn turn(
        &mut self,
        searching: &mut Searching,
        (i, j): (usize, usize),
        line: [f64; 2],
        ([from, to], there): ([&View<S::Posed>; 2], [bool; 2]),
        sheet: usize,
    ) -> Result<(), Undecided> {
        let (shell, course) = (self.shell, self.course);
        if shell.misses(self.limits, [&from.1, &to.1], (line, to.0 - from.0), sheet) {
            return Ok(());
        }
        let known = |view: &View<S::Posed>, there: bool| {
            there.then(|| [view.2.g[sheet], shell.slope(&view.1, &view.2, sheet)[0]])
        };
        let (ends, slack) = (shell.ends(), searching.slack);
        let found = zero(
            [from.0, to.0],
            (
                [known(from, there[0]), known(to, there[1])],
                self.last[sheet].map(|last| last.over(line)),
            ),
            searching.near,
            |t| {
                let posed = shell.at(&course.at(t));
                let meeting = shell.meet(&posed, line);
                (meeting.room > 0.0).then(|| {
                    let [slope, rise] = shell.slope(&posed, &meeting, sheet);
                    Sample {
                        value: meeting.g[sheet],
                        slope,
                        rise,
                        state: (posed, meeting),
                    }
                })
            },
            |t, step, sample| {
                let (posed, meeting) = &sample.state;
                let spot = shell.spot(posed, meeting, sheet, slack);
                let error = spot.error * (1.0 + shell.speed(posed) * step.abs() / slack);
                let inside = ends.hold(spot.along, error)?;
                // The height is extreme at the zero: to second order, half a step at the slope here.
                let turn = Turn {
                    t,
                    height: spot.height + 0.5 * sample.rise * step,
                    normal: spot.normal,
                };
                let gradient = shell.gradient(posed, meeting, sheet);
                Some((inside.then_some(turn), Known::new(line, t, gradient, sample.slope)))
            },
        )?;
        let (found, last) = found;
        self.last[sheet] = Some(last);
        if let Some(Turn { t, height, normal }) = found
            && searching.collector.lines.asks(i, j)
        {
            let jump = if sheet == 0 { 1 } else { -1 };
            let number = searching.collector.lines.line(i, j);
            let source = (self.source)(t);
            searching.collector.crossing(number, height, jump, unit(normal), source);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
