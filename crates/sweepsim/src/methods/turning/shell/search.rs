//! The search of a shell along a span, line by line.

use super::{Falls, Meeting, Passage, Shell};
use crate::algebra::certain::certainly_within;
use crate::methods::harvest::{Collector, unit};
use crate::methods::sheets::Undecided::{self, Close, Intricate};
use crate::methods::sheets::intervals::{Range, Sign};
use crate::methods::sheets::search_lines;
use crate::methods::turning::axis_motion::AxisMotion;
use crate::methods::turning::spans::{Span, Verdict};
use crate::methods::turning::zero::{Known, Sample, Turn, start, zero};
use crate::methods::turning::{Accuracy, Searching};
use std::cell::Cell;
use sweepsim_dexel::Source;

/// A span of one line is halved this many times at most, one half after the other,
const DEEPEST: u32 = 12;
/// and in all: where a tool turns about a point of its axis, no half tells more than the whole.
const HALVINGS: u32 = 40;
/// So many lines of a span may be left to charts in any case.
const FEW: usize = 12;
/// The last step of Newton's method may turn a normal by so much: corrected to first order, that leaves its square.
const TURNED: f64 = 1e-3;

/// A line at one time.
struct View<'p, P> {
    t: f64,
    at: &'p P,
    meeting: Meeting,
}

/// A search of a shell along one span of a motion.
struct ShellSearch<'a, S: Shell, F> {
    shell: &'a S,
    limits: &'a S::Limits,
    motion: &'a AxisMotion,
    accuracy: Accuracy,
    source: F,
    /// How often the span of the line may still be halved.
    halvings: u32,
    /// Of each sheet, what was found last.
    last: [Option<Known>; 2],
}

/// Settles one span of a motion, unless it is too long.
pub(in crate::methods::turning) fn settle_shell<S: Shell>(
    shell: &S,
    (motion, span): (&AxisMotion, &Span),
    searching: &mut Searching,
    source: impl Fn(f64) -> Source,
) -> Verdict {
    let (accuracy, spacing) = (searching.accuracy, searching.collector.lines.spacing());
    match shell.along(span, accuracy, spacing) {
        Ok((limits, area)) => {
            let mut search = ShellSearch {
                shell,
                limits: &limits,
                motion,
                accuracy,
                source,
                halvings: HALVINGS,
                last: [None; 2],
            };
            search.lines(searching.collector, span, area)
        }
        Err(verdict) => verdict,
    }
}

/// A line: its number, its place, and the sheets of it that may turn in the span.
#[derive(Clone, Copy)]
struct Line {
    number: usize,
    at: [f64; 2],
    sheets: [bool; 2],
}

impl<S: Shell, F: Fn(f64) -> Source> ShellSearch<'_, S, F> {
    /// The crossings of the lines of an area in a span.
    fn lines(&mut self, collector: &mut Collector, span: &Span, area: [Range; 2]) -> Verdict {
        let (shell, limits) = (self.shell, self.limits);
        let [a, b] = [&span.from, &span.to].map(|moment| shell.at(moment));
        let (length, mark) = (span.bounds.length, collector.mark());
        // If most lines are intricate, charts may as well have all of them.
        let hopeless = Cell::new(false);
        let [mut visited, mut intricate] = [0; 2];
        let left = search_lines(
            collector,
            area,
            |block| {
                if hopeless.get() {
                    return None;
                }
                let [below, above] = shell.signs(limits, [&a, &b], block, length);
                let sheets = [below == Sign::Unknown, above == Sign::Unknown];
                (sheets[0] || sheets[1]).then_some(sheets)
            },
            |collector, number, at, sheets| {
                if hopeless.get() {
                    return Ok(());
                }
                let view = |t: f64, posed| View {
                    t,
                    at: posed,
                    meeting: shell.meet(posed, at),
                };
                let ends = [&view(span.from.t, &a), &view(span.to.t, &b)];
                let met = ends.map(|end| (end.at, &end.meeting));
                let sheets = [0, 1].map(|sheet| sheets[sheet] && !shell.is_beyond(limits, met, sheet));
                if sheets == [false; 2] {
                    return Ok(());
                }
                if self.stays(ends, sheets) {
                    visited += 1;
                    return Ok(());
                }
                self.halvings = HALVINGS;
                let found = self.between(collector, Line { number, at, sheets }, ends, 0);
                visited += 1;
                intricate += usize::from(found == Err(Intricate));
                hopeless.set(intricate > FEW && 2 * intricate > visited);
                found
            },
        );
        if hopeless.get() {
            collector.forget(mark);
            return Verdict::Intricate;
        }
        Verdict::Settled(left)
    }

    /// Whether a line is certain to be inside all the time, and no sheet turns: so for most lines that are visited.
    #[inline]
    fn stays(&self, [from, to]: [&View<S::Posed>; 2], sheets: [bool; 2]) -> bool {
        let (shell, limits, length) = (self.shell, self.limits, to.t - from.t);
        let (a, b) = (&from.meeting, &to.meeting);
        let same_sign = |sheet: usize| {
            (a.g[sheet] >= 0.0) == (b.g[sheet] >= 0.0)
                && !shell.doubtful(limits, a, sheet)
                && !shell.doubtful(limits, b, sheet)
                && shell.falls(limits, [(from.at, a), (to.at, b)], length, sheet) != Falls::Unknown
        };
        (0..2).all(|sheet| !sheets[sheet] || same_sign(sheet))
            && shell.passage(limits, [a, b], length) == Passage::Inside
    }

    fn between(
        &mut self,
        collector: &mut Collector,
        line: Line,
        [from, to]: [&View<S::Posed>; 2],
        depth: u32,
    ) -> Result<(), Undecided> {
        let length = to.t - from.t;
        let passage = self.shell.passage(self.limits, [&from.meeting, &to.meeting], length);
        let whole = match passage {
            Passage::Beside => return Ok(()),
            Passage::Through | Passage::Unknown => false,
            Passage::Inside | Passage::Enters | Passage::Leaves => true,
        };
        let ends = [(from.at, &from.meeting), (to.at, &to.meeting)];
        let mut falls = [Falls::Beyond; 2];
        for sheet in 0..2 {
            if line.sheets[sheet] {
                falls[sheet] = if whole {
                    self.shell.falls(self.limits, ends, length, sheet)
                } else {
                    Falls::Unknown
                };
            }
        }
        if falls.contains(&Falls::Unknown) {
            if depth == DEEPEST || self.halvings == 0 {
                return Err(Intricate);
            }
            self.halvings -= 1;
            let share = match passage {
                Passage::Through => self.shell.nearest([&from.meeting, &to.meeting]),
                _ => 0.5,
            };
            let t = from.t + share * length;
            let posed = self.shell.pose(self.motion, t);
            let middle = View {
                t,
                at: &posed,
                meeting: self.shell.meet(&posed, line.at),
            };
            self.between(collector, line, [from, &middle], depth + 1)?;
            return self.between(collector, line, [&middle, to], depth + 1);
        }
        let there = [passage != Passage::Enters, passage != Passage::Leaves];
        for sheet in 0..2 {
            let falling = match falls[sheet] {
                Falls::Always => true,
                Falls::Never => false,
                Falls::Beyond | Falls::Unknown => continue,
            };
            // A sheet begins with `g > 0`, and ends with `g < 0`.
            let mut outwards = [true, false];
            for (end, view) in [from, to].into_iter().enumerate() {
                if there[end] {
                    if self.shell.doubtful(self.limits, &view.meeting, sheet) {
                        return Err(Close);
                    }
                    outwards[end] = view.meeting.g[sheet] >= 0.0;
                }
            }
            if outwards[0] != outwards[1] {
                if outwards[0] != falling {
                    return Err(Intricate);
                }
                self.turn(collector, line, ([from, to], there), (sheet, falling))?;
            }
        }
        Ok(())
    }

    /// The place where a sheet turns, of which there is exactly one, where `g` falls or rises: Newton's method in a
    /// bracket.
    fn turn(
        &mut self,
        collector: &mut Collector,
        line: Line,
        ([from, to], there): ([&View<S::Posed>; 2], [bool; 2]),
        (sheet, falling): (usize, bool),
    ) -> Result<(), Undecided> {
        let (shell, motion, limits) = (self.shell, self.motion, self.limits);
        let (
            ends,
            Accuracy {
                slack,
                height_tolerance,
            },
        ) = (shell.ends(), self.accuracy);
        let last = self.last[sheet].as_ref();
        let bracket = [from.t, to.t];
        // So that the function falls.
        let side = if falling { 1.0 } else { -1.0 };
        let first = match last.map(|last| last.over(line.at)) {
            Some(t) if t > from.t && t < to.t => t,
            _ => {
                if shell.misses(limits, [from.at, to.at], (line.at, to.t - from.t), sheet) {
                    return Ok(());
                }
                let known = |view: &View<S::Posed>, there: bool| {
                    there.then(|| {
                        [
                            side * view.meeting.g[sheet],
                            side * shell.slope(view.at, &view.meeting, sheet)[0],
                        ]
                    })
                };
                start(bracket, [known(from, there[0]), known(to, there[1])])
            }
        };
        let (found, known) = zero(
            bracket,
            (there, first),
            |t| {
                let posed = shell.pose(motion, t);
                let meeting = shell.meet(&posed, line.at);
                (meeting.half_chord_sq > 0.0).then(|| {
                    let [slope, rise] = shell.slope(&posed, &meeting, sheet);
                    Sample {
                        value: side * meeting.g[sheet],
                        slope: side * slope,
                        rise,
                        state: (posed, meeting),
                    }
                })
            },
            |t, step, sample| {
                let (posed, meeting) = &sample.state;
                let [speed, pace] = shell.pace(limits, posed, meeting, sample.slope);
                let turned = pace * step.abs();
                // So that the zero is no farther than two steps from here.
                if !(turned < 0.125) {
                    return None;
                }
                let point = shell.point(posed, meeting, (sheet, sample.rise, step), slack);
                let way = (speed + sample.rise.abs()) * step.abs();
                let inside = certainly_within(point.along, ends, point.error + 2.0 * way)?;
                // The height is extreme at the zero. With the next step it is expanded to second order; the rest is of
                // third.
                if inside && !(turned <= TURNED && 2.0 * turned * (sample.rise * step).abs() <= height_tolerance) {
                    return None;
                }
                let gradient = shell.gradient(posed, meeting, sheet);
                let known = Known::new(line.at, t, (gradient, side * sample.slope), last);
                let turn = Turn {
                    t,
                    height: point.height,
                    normal: point.normal,
                };
                Some((inside.then_some(turn), known))
            },
        )?;
        self.last[sheet] = Some(known);
        if let Some(Turn { t, height, normal }) = found {
            let jump = if (sheet == 0) == falling { 1 } else { -1 };
            let source = (self.source)(t);
            collector.crossing(line.number, height, jump, unit(normal), source);
        }
        Ok(())
    }
}
