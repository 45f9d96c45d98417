//! The tool at rest between two motions, of which one turns: where a line meets it, and the signs of `g` before and after.

use super::Searching;
use super::axis_motion::Moment;
use super::blocks::{around, blocks, distance};
use super::cylinder::Cylinder;
use super::disc::{Disc, Placed};
use crate::methods::sheets::intervals::{Range, Sign};
use super::lean::Lean;
use super::shell::Shell;
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::Ball;
use crate::methods::harvest::unit;
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
    /// A line over a ball or a cylinder.
    fn shell<S: Shell>(
        &self,
        shell: &S,
        (pose, motions): (&S::Posed, &Motions<S>),
        (place, line): ((usize, usize), [f64; 2]),
        searching: &mut Searching,
    ) {
        let own = shell.meet(pose, line);
        if own.half_chord_sq <= 0.0 {
            return;
        }
        // The sign of `g` seen from a side, and whether it is certain.
        let view = |side: usize| match (&motions[side], &self.sides[side]) {
            (Some((posed, limits)), _) => {
                let meeting = shell.meet(posed, line);
                let sign = |sheet: usize| (meeting.g[sheet] < 0.0, !shell.doubtful(limits, &meeting, sheet));
                [sign(0), sign(1)]
            }
            (None, RestingSide::Beyond(negative)) => [(*negative, true); 2],
            (None, RestingSide::Moving(_)) => [(false, false); 2],
        };
        let views = [view(0), view(1)];
        for sheet in 0..2 {
            let (before, after) = (views[0][sheet], views[1][sheet]);
            if before.1 && after.1 && before.0 == after.0 {
                continue;
            }
            let point = shell.point(pose, &own, (sheet, 0.0, 0.0), searching.slack);
            let inside = certainly_within(point.along, shell.ends(), point.error);
            if inside == Some(false) || !searching.collector.lines.asks(place.0, place.1) {
                continue;
            }
            let number = searching.collector.lines.line(place.0, place.1);
            if inside.is_none() || !before.1 || !after.1 {
                searching.collector.open(number);
                continue;
            }
            let change = i8::from(after.0) - i8::from(before.0);
            let jump = if sheet == 1 { -change } else { change };
            searching
                .collector
                .crossing(number, point.height, jump, unit(point.normal), self.source);
        }
    }

    /// The lines of a box.
    fn lines<S: Shell>(
        &self,
        shell: &S,
        (pose, motions): (&S::Posed, &Motions<S>),
        area: [Range; 2],
        searching: &mut Searching,
    ) {
        let lines = searching.collector.lines;
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
        blocks(lines, area, wanted, |place, line, ()| {
            self.shell(shell, (pose, motions), (place, line), searching);
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
                (centre, ball.at_rest(&centre, searching.slack))
            })
        });
        let pose = ball.at(&self.pose);
        let area = around(&[pose.level()], ball.radius + searching.slack);
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
                (posed, cylinder.at_rest((moment, &posed), searching.slack))
            })
        });
        let area = around(&pose.corners(cylinder.radius, cylinder.ends), searching.slack);
        self.lines(cylinder, (&pose, &motions), area, searching);
        true
    }

    /// `false` if it is left to charts.
    pub fn disc(&self, disc: &Disc, searching: &mut Searching) -> bool {
        let placed = Placed::new(&self.pose, disc.height);
        if placed.axis.z.abs() < STEEP {
            return false;
        }
        let slack = searching.slack;
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
        let lines = searching.collector.lines;
        let normal: Vector3<f64> = placed.axis * disc.up;
        let error = 8.0 * slack * (1.0 + placed.axis.z.recip().abs());
        let reach = disc.radii[1] + slack;
        let over = |block: [Range; 2]| (distance(block, [centre; 2]) <= reach).then_some(());
        blocks(lines, around(&[centre], reach), over, |(i, j), line, ()| {
            let arm = placed.arm(line);
            let radius = arm.norm();
            let [inner, outer] = disc.radii;
            let inner = if inner == 0.0 { -1.0 } else { inner };
            if radius > outer + error || radius < inner - error {
                return;
            }
            let sign = |n: usize| match (&self.sides[n], &posed[n]) {
                (RestingSide::Moving(_), Some(side)) => {
                    let f = side.along(&arm);
                    // Without a turn it is a product.
                    let doubt = (error + 16.0 * slack) * side.rate.norm()
                        + if side.rate.norm() == 0.0 {
                            0.0
                        } else {
                            16.0 * f64::EPSILON * side.travel.norm()
                        };
                    (f * disc.up < 0.0, side.rate.norm() == 0.0 || f.abs() > doubt)
                }
                (RestingSide::Beyond(negative), _) => (*negative, true),
                _ => (false, false),
            };
            let signs = [sign(0), sign(1)];
            if signs[0].1 && signs[1].1 && signs[0].0 == signs[1].0 {
                return;
            }
            if !lines.asks(i, j) {
                return;
            }
            let number = lines.line(i, j);
            let inside = radius < outer - error && radius > inner + error;
            if !inside || !signs[0].1 || !signs[1].1 {
                searching.collector.open(number);
                return;
            }
            let change = i8::from(signs[1].0) - i8::from(signs[0].0);
            let jump = if normal.z > 0.0 { -change } else { change };
            let height = placed.centre.z + arm.z;
            searching
                .collector
                .crossing(number, height, jump, unit(normal), self.source);
        });
        true
    }
}
