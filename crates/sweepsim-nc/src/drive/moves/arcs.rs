//! Arcs of the tip, in any frame.

use sweepsim_motion::{Move, TipArc, TipCourse, Turning};

use crate::drive::circular_arc::Arc;
use crate::drive::driver::Coordinates;
use crate::drive::track::Track;
use crate::machines::Position;
use crate::model::program::FeedMode;
use crate::text::error::NcProblem;

impl Track {
    /// A feed move of the tool along an arc from where it is, while it turns into a direction of the part's frame.
    pub fn arc_towards(&mut self, arc: &Arc, direction: [f64; 3]) -> Result<(), NcProblem> {
        self.bend(arc, self.abc, Some(direction))
    }

    /// A feed move of the tool along an arc from where it is, while the rotary axes turn to `abc` or the tool into a direction.
    pub(in crate::drive) fn bend(
        &mut self,
        arc: &Arc,
        abc: [f64; 3],
        direction: Option<[f64; 3]>,
    ) -> Result<(), NcProblem> {
        let Some(scale) = self.frame.scale() else {
            return Err(NcProblem::unsupported(
                "arcs in coordinates with unequal scales are",
                "expected the same scale for all axes",
            ));
        };
        self.begin(false)?;
        let target = Position::new(self.frame.point(arc.end), abc);
        if !self.kept_arcs.none() && !self.turns_by_axes(abc) {
            let above = std::array::from_fn(|k| arc.centre[k] + arc.normal[k]);
            let [from, to, centre, above] = self.tips([arc.start, arc.end, arc.centre, above])?;
            let normal = match self.coordinates {
                Coordinates::Tip => self.frame.direction(arc.normal),
                Coordinates::Axes => std::array::from_fn(|k| above[k] - centre[k]),
            };
            let exact = TipArc::new(centre, normal, arc.sweep.copysign(arc.sweep * scale))
                .map_err(|error| NcProblem::syntax(error.to_string()))?
                .through(from, to);
            let turns = abc != self.abc || direction.is_some() && direction != self.direct;
            let steady = if turns { None } else { Some(self.direction()?) };
            if self.kept_arcs.keep(&exact, [from, to], steady) {
                let turning = match self.driver.turning(self.abc, abc, self.coordinates)? {
                    Turning::Slerp => Turning::Even,
                    other => other,
                };
                if turns {
                    self.direct = direction;
                }
                let course = TipCourse::Arc(exact);
                self.push(target, Move { course, turning }, false)?;
                self.arrive(arc.end, abc);
                return Ok(());
            }
        }
        let chords = arc
            .chords(self.arc_tolerance / scale.abs())
            .map_err(NcProblem::syntax)?;
        self.notes.add_str(self.place.line, &self.chord_note);
        let from = Position::new([0.0; 3], self.abc);
        let to = Position::new([0.0; 3], abc);
        let directions = self.direct.zip(direction).filter(|(from, to)| from != to);
        self.in_pieces(chords, |own| {
            for chord in 1..chords {
                let s = chord as f64 / chords as f64;
                if let Some((from, to)) = directions {
                    own.direct = Some(std::array::from_fn(|k| from[k] * (1.0 - s) + s * to[k]));
                }
                own.straight(arc.at(s), from.towards(&to, s).abc, false)?;
            }
            own.direct = direction.or(own.direct);
            own.straight(arc.end, abc, false)
        })
    }

    /// Makes a move as several ones: a feed in inverse time is that of all of them.
    pub(in crate::drive) fn in_pieces(
        &mut self,
        count: usize,
        make: impl FnOnce(&mut Self) -> Result<(), NcProblem>,
    ) -> Result<(), NcProblem> {
        let outer = self.pieces;
        self.pieces *= count;
        let made = make(self);
        self.pieces = outer;
        made
    }

    /// The feed of each of the moves that the one that is made becomes.
    pub(in crate::drive) fn feed_of_piece(&mut self) -> Option<f64> {
        if !self.of_poses && self.feed.is_some_and(|feed| feed <= 0.0) {
            let note = "the feed is not above 0: the control stops here, and the time of the move is not known";
            self.notes.add_str(self.place.line, note);
        }
        let shares = match self.feed_mode {
            FeedMode::InverseTime => self.pieces,
            FeedMode::PerMinute | FeedMode::PerRevolution => 1,
        };
        self.feed.map(|feed| feed * shares as f64)
    }

    /// Where the tip is when the program says that the tool is at these points.
    fn tips<const N: usize>(&mut self, points: [[f64; 3]; N]) -> Result<[[f64; 3]; N], NcProblem> {
        let (abc, frame) = (self.abc, self.frame);
        let shift = self.direction().map(|axis| self.driver.to_tip(axis))?;
        let mut tips = points;
        for tip in &mut tips {
            let place = match self.coordinates {
                Coordinates::Tip => frame.point(*tip),
                Coordinates::Axes => self.driver.tip(&Position::new(frame.point(*tip), abc))?,
            };
            *tip = std::array::from_fn(|k| place[k] + shift[k]);
        }
        Ok(tips)
    }

    /// Whether a move of the axes is not the same as one of the tip.
    fn turns_by_axes(&self, abc: [f64; 3]) -> bool {
        self.coordinates == Coordinates::Axes && self.driver.kinematics().is_some() && abc != self.abc
    }
}
