//! From programmed moves to those of the tool: rounded corners and chamfers first, then cutter compensation.

use nalgebra::Vector3;

use super::circular_arc::{Arc, CircularArc};
use super::contour::{
    ArcPlane, Before, Bend, Compensation, CompensationSettings, Contour, Corner, Item, Outcome, Recording, Stroke,
    blend,
};
use super::track::Track;
use crate::model::event::EventKind;
use crate::text::error::NcProblem;

impl Track {
    /// From here on, moves are kept and not made.
    pub fn record_moves(&mut self) -> Result<(), NcProblem> {
        self.refuse_contour("a cycle on contours")?;
        let before = Before {
            xyz: self.xyz,
            feed: self.feed,
            place: self.place,
            direction: self.contour.direction,
        };
        self.xyz = self.xyz.map(|x| Some(x.unwrap_or(0.0)));
        self.recording = Some(Recording {
            before,
            ..Recording::default()
        });
        Ok(())
    }

    /// The moves since then; the tool is where it was.
    pub fn recorded(&mut self) -> Result<Recording, NcProblem> {
        let settled = self.refuse_contour("a cycle on contours");
        let recording = self.recording.take().unwrap_or_default();
        let before = recording.before;
        (self.xyz, self.feed, self.place) = (before.xyz, before.feed, before.place);
        self.contour.direction = before.direction;
        settled.map(|()| recording)
    }

    /// Whether a move of the tool is kept instead of being made.
    pub(in crate::drive) fn keeps(&mut self, stroke: &Stroke) -> bool {
        let from = self.xyz.map(|x| x.unwrap_or(0.0));
        let Some(recording) = &mut self.recording else {
            return false;
        };
        recording.strokes.push((from, *stroke));
        self.arrive(stroke.end, stroke.abc);
        true
    }

    /// Whether compensation is only noted.
    pub(in crate::drive) fn keeps_side(&mut self, left: bool) -> bool {
        let recording = self.recording.as_mut();
        recording.map(|recording| recording.left = Some(left)).is_some()
    }

    pub fn is_recording(&self) -> bool {
        self.recording.is_some()
    }

    /// Whether the next move starts beside its programmed start: after the end of cutter compensation.
    pub fn starts_beside(&self) -> bool {
        self.contour.actual.is_some() && !self.compensates()
    }

    /// Whether cutter compensation is on.
    pub fn compensates(&self) -> bool {
        self.contour.compensation.is_some()
    }

    /// What cutter compensation is on with.
    pub fn side(&self) -> Option<CompensationSettings> {
        self.contour.compensation.as_ref().map(|compensation| compensation.side)
    }

    /// The direction of the last programmed move at its end, in the frame.
    pub fn last_direction(&self) -> Option<[f64; 3]> {
        self.contour.direction
    }

    /// Switches cutter compensation on: from the next move on.
    pub fn compensate(&mut self, side: CompensationSettings, plane: ArcPlane) -> Result<(), NcProblem> {
        if self.keeps_side(side.left) {
            return Ok(());
        }
        if self.compensates() {
            return Err(NcProblem::unsupported(
                "a change of cutter compensation without its end is",
                "expected G40 or R0, and a move, between them",
            ));
        }
        let Some(at) = self.known() else {
            return Err(NcProblem::syntax(
                "cutter compensation from an unknown position: expected a move to X, Y and Z before it",
            ));
        };
        if self.frame.scale().is_none_or(|scale| (scale.abs() - 1.0).abs() > 1e-12) {
            return Err(NcProblem::unsupported(
                "cutter compensation in scaled coordinates is",
                "expected a scale of 1",
            ));
        }
        self.settle()?;
        let at = *self.contour.actual.get_or_insert(at);
        self.contour.compensation = Some(Compensation::new(side, plane, at));
        Ok(())
    }

    /// Ends cutter compensation: the next move goes straight from where the tool is. With `next`, it may not have to go
    /// round the end of the contour.
    pub fn end_compensation(&mut self, next: Option<[f64; 3]>) -> Result<(), NcProblem> {
        self.settle()?;
        if let Some(compensation) = self.contour.compensation.take() {
            let exit = next.map_or(Ok(()), |next| compensation.check_exit(next));
            let items = compensation.finish()?;
            self.emit_all(items)?;
            exit?;
            if self.contour.actual == self.known() {
                self.contour.actual = None;
            }
        }
        Ok(())
    }

    /// Makes a corner at the end of the next move.
    pub fn corner_next(&mut self, corner: Corner) {
        self.contour.next = Some(corner);
    }

    /// Before something that cannot be done beside a contour; a waiting move is not waiting any more.
    pub fn refuse_contour(&mut self, what: &str) -> Result<(), NcProblem> {
        if self.compensates() {
            return Err(NcProblem::unsupported(
                format!("{what} while cutter compensation is on is"),
                "expected its end (G40, R0) before it",
            ));
        }
        self.settle()
    }

    /// Gives out what waits, after a problem, as far as it goes.
    pub(super) fn abandon_contour(&mut self) {
        let settled = self.settle();
        if let (Ok(()), Some(compensation)) = (settled, self.contour.compensation.take()) {
            let _ = self.emit_all(compensation.abandon());
        }
        self.contour = Contour::default();
    }

    /// Takes an event that happens after moves that wait; gives it back if none does.
    pub(super) fn event_waits(&mut self, kind: EventKind) -> Option<EventKind> {
        if self.contour.waiting.is_some() {
            self.contour.events.push((kind, self.place));
            return None;
        }
        match &mut self.contour.compensation {
            Some(compensation) if !compensation.is_idle() => {
                compensation.event(kind, self.place);
                None
            }
            _ => Some(kind),
        }
    }

    /// A straight programmed move to coordinates in the frame and angles.
    pub fn line(&mut self, target: [f64; 3], abc: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        let stroke = self.stroke(target, abc, rapid, None, [0, 1, 2]);
        self.go(stroke)
    }

    /// A programmed move in the frame.
    pub fn go(&mut self, stroke: Stroke) -> Result<(), NcProblem> {
        self.leave_places(stroke.end)?;
        let from = self.known();
        match from {
            Some(from) if self.contour.is_busy() => self.programmed(from, stroke)?,
            _ => {
                self.contour.next = None;
                self.emit(&stroke)?;
            }
        }
        let [u, v, _] = stroke.plane;
        let way: Option<[f64; 3]> = match stroke.bend {
            None => from.map(|from| std::array::from_fn(|k| stroke.end[k] - from[k])),
            Some(bend) => {
                let out = [stroke.end[u] - bend.centre[0], stroke.end[v] - bend.centre[1]];
                let mut way = [0.0; 3];
                (way[u], way[v]) = (-out[1] * bend.sweep.signum(), out[0] * bend.sweep.signum());
                Some(way)
            }
        };
        if way.is_none_or(|way| way != [0.0; 3]) {
            self.contour.direction = way;
        }
        Ok(())
    }

    /// A programmed feed move along an arc in a plane of the axes, while the rotary axes turn to `abc`.
    pub fn circle(&mut self, arc: &CircularArc, abc: [f64; 3]) -> Result<(), NcProblem> {
        let bend = Bend {
            centre: arc.centre,
            sweep: arc.sweep,
        };
        let stroke = self.stroke(arc.end, abc, false, Some(bend), arc.plane);
        self.go(stroke)
    }

    /// A programmed feed move along an arc about any axis, while the rotary axes turn to `abc`.
    pub fn arc(&mut self, arc: &Arc, abc: [f64; 3]) -> Result<(), NcProblem> {
        if let Some(w) = (0..3).find(|&w| arc.normal[w].abs() == 1.0) {
            let plane @ [u, v, _] = [(w + 1) % 3, (w + 2) % 3, w];
            let bend = Bend {
                centre: [arc.centre[u], arc.centre[v]],
                sweep: arc.sweep * arc.normal[w],
            };
            let stroke = self.stroke(arc.end, abc, false, Some(bend), plane);
            return self.go(stroke);
        }
        if self.contour.is_busy() {
            return Err(NcProblem::unsupported(
                "arcs out of the plane, beside a contour or at a corner, are",
                "expected G2 or G3",
            ));
        }
        self.bend(arc, abc, None)?;
        let out = Vector3::from(arc.end) - Vector3::from(arc.centre);
        let along = Vector3::from(arc.normal).cross(&out) * arc.sweep.signum();
        self.contour.direction = Some(along.into());
        Ok(())
    }

    /// A programmed move from here, at the feed and with the stop in effect.
    pub fn stroke(&self, end: [f64; 3], abc: [f64; 3], rapid: bool, bend: Option<Bend>, plane: ArcPlane) -> Stroke {
        Stroke {
            end,
            abc,
            rapid,
            bend,
            plane,
            place: self.place,
            feed: self.feed,
            feed_mode: self.feed_mode,
            exact_stop: self.exact_stop,
        }
    }

    /// A programmed move where the tool may not follow it at once.
    fn programmed(&mut self, from: [f64; 3], mut stroke: Stroke) -> Result<(), NcProblem> {
        let corner = self.contour.next.take();
        if let (Some(_), Some(compensated)) = (stroke.bend, self.compensated_plane())
            && stroke.plane != compensated
        {
            return Err(NcProblem::unsupported(
                "arcs out of the plane of the cutter compensation are",
                "expected arcs in its plane",
            ));
        }
        let mut from = from;
        if let Some((start, first, corner)) = self.contour.waiting.take() {
            match blend(start, &first, &stroke, &corner)? {
                Outcome::Made(made) => {
                    self.give(start, made.first)?;
                    self.flush_events()?;
                    self.give(made.first.end, made.between)?;
                    (from, stroke) = (made.from, made.second);
                }
                outcome => {
                    self.give(start, first)?;
                    self.flush_events()?;
                    if outcome == Outcome::OutOfPlane {
                        self.note(format!("{} is not made: the moves leave the plane", corner.word));
                    }
                }
            }
        }
        match corner {
            Some(corner) => self.contour.waiting = Some((from, stroke, corner)),
            None => self.give(from, stroke)?,
        }
        self.arrive(stroke.end, stroke.abc);
        Ok(())
    }

    fn compensated_plane(&self) -> Option<ArcPlane> {
        self.contour.compensation.as_ref().map(Compensation::plane)
    }

    fn flush_events(&mut self) -> Result<(), NcProblem> {
        for (kind, place) in std::mem::take(&mut self.contour.events) {
            let here = std::mem::replace(&mut self.place, place);
            let result = self.event(kind);
            self.place = here;
            result?;
        }
        Ok(())
    }

    /// Gives out a move that waits for a corner, without it.
    fn settle(&mut self) -> Result<(), NcProblem> {
        self.contour.next = None;
        let Some((start, stroke, corner)) = self.contour.waiting.take() else {
            return Ok(());
        };
        let programmed = self.xyz;
        self.give(start, stroke)?;
        self.xyz = programmed;
        self.note(format!("{} is not made: no move in the plane follows", corner.word));
        self.flush_events()
    }

    /// A move of the contour, of which its corners are made.
    fn give(&mut self, from: [f64; 3], stroke: Stroke) -> Result<(), NcProblem> {
        let Some(compensation) = &mut self.contour.compensation else {
            if self.contour.actual.is_none() {
                self.contour.actual = Some(from);
            } else if stroke.bend.is_some() {
                return Err(NcProblem::syntax(
                    "an arc right after the end of cutter compensation: expected a straight move first",
                ));
            }
            return self.emit(&stroke);
        };
        if stroke.abc != self.abc {
            return Err(NcProblem::unsupported(
                "rotary moves while cutter compensation is on are",
                "expected its end (G40, R0) before them",
            ));
        }
        let mut items = Vec::new();
        let result = compensation.add(from, stroke, &mut items);
        self.emit_all(items)?;
        result
    }

    fn emit_all(&mut self, items: impl IntoIterator<Item = Item>) -> Result<(), NcProblem> {
        let programmed = self.xyz;
        for item in items {
            match item {
                Item::Stroke(stroke) => {
                    let result = self.emit(&stroke);
                    self.contour.actual = Some(stroke.end);
                    result?;
                }
                Item::Event(kind, place) => {
                    let here = std::mem::replace(&mut self.place, place);
                    let result = self.record(kind);
                    self.place = here;
                    result?;
                }
                Item::Warning(text, place) => self.notes.add(place.line, text),
            }
        }
        self.xyz = programmed;
        Ok(())
    }

    /// A move of the tool from where it is.
    fn emit(&mut self, stroke: &Stroke) -> Result<(), NcProblem> {
        if let Some(actual) = self.contour.actual.take() {
            self.xyz = actual.map(Some);
        }
        if self.keeps(stroke) {
            return Ok(());
        }
        if let Some(trace) = &mut self.trace {
            trace.stroke(stroke);
        }
        let place = std::mem::replace(&mut self.place, stroke.place);
        let feed = std::mem::replace(&mut self.feed, stroke.feed);
        let mode = std::mem::replace(&mut self.feed_mode, stroke.feed_mode);
        let exact_stop = std::mem::replace(&mut self.exact_stop, stroke.exact_stop);
        let result = match (stroke.bend, self.known()) {
            (Some(bend), Some(start)) => {
                let arc = CircularArc {
                    start,
                    end: stroke.end,
                    plane: stroke.plane,
                    centre: bend.centre,
                    sweep: bend.sweep,
                };
                self.bend(&arc.about_axis(), stroke.abc, None)
            }
            (Some(_), None) => Err(NcProblem::syntax(
                "an arc from an unknown position: expected a move before it",
            )),
            (None, _) => self.straight(stroke.end, stroke.abc, stroke.rapid),
        };
        (self.place, self.feed, self.feed_mode) = (place, feed, mode);
        self.exact_stop = exact_stop;
        result
    }
}
