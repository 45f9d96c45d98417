//! The tool at rest between two motions, of which one turns: where a line meets it, and the signs of `g` before and
//! after.

use super::Searching;
use super::axis_motion::Moment;
use super::shell::Shell;
use crate::algebra::certain::certainly_within;
use crate::methods::harvest::{Collector, unit};
use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::intervals::{Range, Sign};
use crate::methods::sheets::search_lines;
use sweepsim_dexel::Source;

/// The tool at rest, seen from one side.
#[derive(Clone, Copy, Debug)]
pub(super) enum RestingSide {
    Moving(Moment),
    /// Beyond an end of the path; whether that counts as moving inwards.
    Beyond(bool),
}

/// A placement of the tool.
pub(super) struct Resting<'a> {
    /// Without a motion.
    pub pose: Moment,
    pub sides: &'a [RestingSide; 2],
    pub source: Source,
}

/// Both motions, as a surface needs them.
type Motions<S> = [Option<(<S as Shell>::Posed, <S as Shell>::Limits)>; 2];

impl Resting<'_> {
    /// `None` if it is left to charts.
    pub fn shell<S: Shell>(&self, shell: &S, searching: &mut Searching) -> Option<()> {
        let slack = searching.accuracy.slack;
        let (pose, _) = shell.at_rest(&self.pose, slack)?;
        let motions = self.sides.map(|side| match side {
            RestingSide::Moving(moment) => shell.at_rest(&moment, slack),
            RestingSide::Beyond(_) => None,
        });
        let wanted = |block: [Range; 2]| {
            let signs = |side: usize| match (&self.sides[side], &motions[side]) {
                (_, Some((posed, limits))) => shell.signs(limits, [posed; 2], block, 0.0),
                (RestingSide::Beyond(true), _) => [Sign::Negative; 2],
                _ => [Sign::Positive; 2],
            };
            let (before, after) = (signs(0), signs(1));
            let sheets = [0, 1].map(|sheet| {
                let pair = [before[sheet], after[sheet]];
                !pair.contains(&Sign::Absent) && (pair[0] != pair[1] || pair[0] == Sign::Unknown)
            });
            (sheets[0] || sheets[1]).then_some(sheets)
        };
        let area = shell.area(&pose, slack);
        search_lines(searching.collector, area, wanted, |collector, number, line, sheets| {
            self.line(shell, (&pose, &motions), (number, line, sheets), (collector, slack))
        });
        Some(())
    }

    fn line<S: Shell>(
        &self,
        shell: &S,
        (pose, motions): (&S::Posed, &Motions<S>),
        (number, line, sheets): (usize, [f64; 2], [bool; 2]),
        (collector, slack): (&mut Collector, f64),
    ) -> Result<(), Undecided> {
        let own = shell.meet(pose, line);
        if own.half_chord_sq <= 0.0 {
            return Ok(());
        }
        // The signs of `g` seen from a side, where they are certain.
        let view = |side: usize| match (&motions[side], &self.sides[side]) {
            (Some((posed, limits)), _) => {
                let meeting = shell.meet(posed, line);
                [0, 1].map(|sheet| (!shell.doubtful(limits, &meeting, sheet)).then_some(meeting.g[sheet] < 0.0))
            }
            (None, RestingSide::Beyond(negative)) => [Some(*negative); 2],
            (None, RestingSide::Moving(_)) => [None; 2],
        };
        let views = [view(0), view(1)];
        for sheet in 0..2 {
            let signs = views.map(|view| view[sheet]);
            if !sheets[sheet] || signs[0].is_some() && signs[0] == signs[1] {
                continue;
            }
            let point = shell.point(pose, &own, (sheet, 0.0, 0.0), slack);
            let inside = certainly_within(point.along, shell.ends(), point.error);
            if inside == Some(false) {
                continue;
            }
            let (Some(before), Some(after), Some(true)) = (signs[0], signs[1], inside) else {
                return Err(Close);
            };
            let change = i8::from(after) - i8::from(before);
            let jump = if sheet == 1 { -change } else { change };
            collector.crossing(number, point.height, jump, unit(point.normal), self.source);
        }
        Ok(())
    }
}
