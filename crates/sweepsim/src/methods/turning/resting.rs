//! The tool at rest between two motions, of which one turns: where a line meets it, and the signs of `g` before and after.

use super::Searching;
use super::axis_motion::Moment;
use super::cylinder::Cylinder;
use super::disc::{Disc, Placed};
use super::lean::Lean;
use super::shell::Shell;
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::Ball;
use crate::methods::harvest::{Collector, unit};
use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::intervals::{Range, Sign};
use crate::methods::sheets::{around, distance, search_lines};
use nalgebra::Vector3;
use sweepsim_dexel::Source;

/// An axis that leans less than this is left to charts, unless it is upright, and a plane that is steeper than this.
const UPRIGHT: f64 = 0.02;
const STEEP: f64 = 1e-3;

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
    /// The jump at a place on the upper side: where the signs of `g` seen from both sides differ, as far as these and whether it is on the piece are certain.
    fn jump(&self, signs: [Option<bool>; 2], inside: Option<bool>) -> Result<Option<i8>, Undecided> {
        if inside == Some(false) || signs[0].is_some() && signs[0] == signs[1] {
            return Ok(None);
        }
        let (Some(before), Some(after), Some(true)) = (signs[0], signs[1], inside) else {
            return Err(Close);
        };
        Ok(Some(i8::from(before) - i8::from(after)))
    }

    /// A line over a ball or a cylinder.
    fn shell<S: Shell>(
        &self,
        shell: &S,
        (pose, motions): (&S::Posed, &Motions<S>),
        (number, line): (usize, [f64; 2]),
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
            if signs[0].is_some() && signs[0] == signs[1] {
                continue;
            }
            let point = shell.point(pose, &own, (sheet, 0.0, 0.0), slack);
            let inside = certainly_within(point.along, shell.ends(), point.error);
            if let Some(jump) = self.jump(signs, inside)? {
                let jump = if sheet == 1 { jump } else { -jump };
                collector.crossing(number, point.height, jump, unit(point.normal), self.source);
            }
        }
        Ok(())
    }

    /// The lines of a box.
    fn lines<S: Shell>(
        &self,
        shell: &S,
        (pose, motions): (&S::Posed, &Motions<S>),
        area: [Range; 2],
        searching: &mut Searching,
    ) {
        let slack = searching.accuracy.slack;
        let wanted = |block: [Range; 2]| {
            let signs = |side: usize| match (&self.sides[side], &motions[side]) {
                (_, Some((posed, limits))) => shell.signs(limits, [posed; 2], block, 0.0),
                (RestingSide::Beyond(true), _) => [Sign::Negative; 2],
                _ => [Sign::Positive; 2],
            };
            let (before, after) = (signs(0), signs(1));
            let excluded = (0..2).all(|sheet| {
                let pair = [before[sheet], after[sheet]];
                pair.contains(&Sign::Absent) || pair[0] == pair[1] && pair[0] != Sign::Unknown
            });
            (!excluded).then_some(())
        };
        search_lines(searching.collector, area, wanted, |collector, number, line, ()| {
            self.shell(shell, (pose, motions), (number, line), (collector, slack))
        });
    }

    fn moving(&self) -> [Option<&Moment>; 2] {
        [0, 1].map(|n| match &self.sides[n] {
            RestingSide::Moving(moment) => Some(moment),
            RestingSide::Beyond(_) => None,
        })
    }

    pub fn ball(&self, ball: &Ball, searching: &mut Searching) {
        let motions = self.moving().map(|side| {
            side.map(|moment| {
                let centre = ball.at(moment);
                (centre, ball.at_rest(&centre, searching.accuracy.slack))
            })
        });
        let pose = ball.at(&self.pose);
        let area = around(&[pose.level()], ball.radius + searching.accuracy.slack);
        self.lines(ball, (&pose, &motions), area, searching);
    }

    /// `false` if it is left to charts.
    pub fn cylinder(&self, cylinder: &Cylinder, searching: &mut Searching) -> bool {
        let lean = self.pose.lean();
        if lean == 0.0 {
            // No line meets the wall of an upright tool at rest.
            return true;
        }
        let Some(pose) = Lean::new(&self.pose).filter(|_| lean > UPRIGHT) else {
            return false;
        };
        let motions = self.moving().map(|side| {
            side.map(|moment| {
                let posed = cylinder.at(moment);
                (posed, cylinder.at_rest((moment, &posed), searching.accuracy.slack))
            })
        });
        let area = around(&pose.corners(cylinder.radius, cylinder.ends), searching.accuracy.slack);
        self.lines(cylinder, (&pose, &motions), area, searching);
        true
    }

    /// `false` if it is left to charts.
    pub fn disc(&self, disc: &Disc, searching: &mut Searching) -> bool {
        let placed = Placed::new(&self.pose, disc.height);
        if placed.axis.z.abs() < STEEP {
            return false;
        }
        let slack = searching.accuracy.slack;
        let posed = self
            .moving()
            .map(|side| side.map(|moment| Placed::new(moment, disc.height)));
        // No line at all where both signs are certain to be equal all over it.
        let [before, after] = [0, 1].map(|n| match (&self.sides[n], &posed[n]) {
            (RestingSide::Beyond(negative), _) => Some(*negative),
            (_, Some(side)) => {
                let turning = side.rate.norm() * disc.radii[1] * (1.0 + 1e-9);
                let error = 16.0 * (side.travel.norm() * f64::EPSILON + slack * side.rate.norm());
                (side.along.abs() > turning + error).then_some(side.along * disc.up < 0.0)
            }
            _ => None,
        });
        if before.is_some() && before == after {
            return true;
        }
        let centre = [placed.centre.x, placed.centre.y];
        let normal: Vector3<f64> = placed.axis * disc.up;
        let error = 8.0 * slack * (1.0 + placed.axis.z.recip().abs());
        let reach = disc.radii[1] + slack;
        let over = |block: [Range; 2]| (distance(block, [centre; 2]) <= reach).then_some(());
        let visit = |collector: &mut Collector, number, line, ()| {
            let arm = placed.arm(line);
            let sign = |n: usize| match (&self.sides[n], &posed[n]) {
                (RestingSide::Moving(_), Some(side)) => {
                    let (f, rate) = (side.along(&arm), side.rate.norm());
                    let doubt = (error + 16.0 * slack) * rate + 16.0 * f64::EPSILON * side.travel.norm();
                    // Without a turn it is a product.
                    (rate == 0.0 || f.abs() > doubt).then_some(f * disc.up < 0.0)
                }
                (RestingSide::Beyond(negative), _) => Some(*negative),
                _ => None,
            };
            let inside = disc.holds(arm.norm(), error);
            if inside != Some(false)
                && let Some(jump) = self.jump([sign(0), sign(1)], inside)?
            {
                let jump = if normal.z > 0.0 { jump } else { -jump };
                let height = placed.centre.z + arm.z;
                collector.crossing(number, height, jump, unit(normal), self.source);
            }
            Ok(())
        };
        search_lines(searching.collector, around(&[centre], reach), over, visit);
        true
    }
}
