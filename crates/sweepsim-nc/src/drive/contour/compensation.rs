//! Cutter compensation (G41, G42): the tool's centre beside the programmed contour, at the distance of its radius.
//!
//! Each programmed line or arc is offset exactly: lines to lines, arcs to concentric arcs. At outside corners the tool goes round the corner
//! on an arc, as on LinuxCNC, Heidenhain and Siemens (`G450`), on straight lines to the meeting of the offsets and no farther than one radius
//! beyond the corner's normals, as on Fanuc, or to the meeting itself (Siemens's `G451`). At inside corners both offsets end where they meet. So each move can be given out only when the next one is
//! known. The tool's centre is checked against neighbouring moves only, as controls do: a slot narrower than the tool is not noticed where
//! more than two moves make it.
//!
//! The rules at the ends are LinuxCNC's (*LinuxCNC G-code reference, Cutter Compensation*): the entry move ends beside its own end, a
//! lead-in arc is fitted between its start and its offset end; after G40, the tool moves straight to the next programmed point. On
//! Fanuc, Siemens and Heidenhain, the entry move ends beside the start of the next move.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use super::corner::{Curve, Flat, arc_tangent, cross, dot, length, minus, plus};
use super::narrow::{Narrow, TooNarrow};
use super::stroke::{ArcPlane, Bend, CompensationSettings, Item, ProgramPlace, Stroke, flat, set};
use crate::model::event::EventKind;
use crate::text::error::NcProblem;

/// What is said of a place that is too narrow.
pub(crate) const NARROW: &str = "does not fit between the moves";

/// Compensation while it is on.
#[derive(Clone, Debug)]
pub(crate) struct Compensation {
    pub side: CompensationSettings,
    pub(super) plane: ArcPlane,
    /// No move has been compensated yet.
    first: bool,
    /// The waiting move is the entry: its end is still free.
    pub(super) entry: bool,
    /// The waiting move begins before its programmed start, where an outside corner extends it.
    extended: bool,
    /// Where the waiting moves start,
    pub(super) start: [f64; 3],
    /// and where the tool is after them.
    pub(super) current: [f64; 3],
    /// The direction of the last move at its programmed end.
    pub(super) tangent: Flat,
    /// Its curvature there, positive to the left.
    pub(super) curvature: f64,
    /// The curve that the last move lies on.
    pub(super) curve: Curve,
    waiting: VecDeque<Item>,
    narrow: Narrow,
    /// Where the last move that was given out ended.
    given: [f64; 3],
}

impl Compensation {
    pub(crate) fn new(side: CompensationSettings, plane: ArcPlane, at: [f64; 3]) -> Self {
        Self {
            side,
            plane,
            first: true,
            entry: false,
            extended: false,
            start: at,
            current: at,
            tangent: [1.0, 0.0],
            curvature: 0.0,
            curve: Curve::Line {
                point: [0.0; 2],
                direction: [1.0, 0.0],
            },
            waiting: VecDeque::new(),
            narrow: Narrow::default(),
            given: at,
        }
    }

    /// Something that happens after the waiting moves.
    pub(crate) fn event(&mut self, kind: EventKind, place: ProgramPlace) {
        self.waiting.push_back(Item::Event(kind, place));
    }

    /// The plane of the contour.
    pub(crate) fn plane(&self) -> ArcPlane {
        self.plane
    }

    /// Whether nothing waits.
    pub(crate) fn is_idle(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Checks that the tool gets to `target` from the end of the contour without going round it (Siemens's `KONT`).
    pub(crate) fn check_exit(&self, target: [f64; 3]) -> Result<(), NcProblem> {
        if self.first || self.side.radius == 0.0 {
            return Ok(());
        }
        let at = plus(
            flat(self.plane, self.current),
            -self.side.radius,
            self.normal(self.tangent),
        );
        self.check_front(at, self.tangent, flat(self.plane, target))
    }

    /// Whether `point` is on the tool's side of the contour at `at`, along `t`. From there `KONT` moves straight, as `NORM` does.
    pub(super) fn check_front(&self, at: Flat, t: Flat, point: Flat) -> Result<(), NcProblem> {
        if dot(self.normal(t), minus(point, at)) < -1e-9 {
            return Err(NcProblem::unsupported(
                "KONT from or to a point behind the contour is",
                "expected NORM, or a point on the tool's side of the contour",
            ));
        }
        Ok(())
    }

    /// What still waits, at the end.
    pub(crate) fn finish(mut self) -> Result<Vec<Item>, NcProblem> {
        let mut out = Vec::new();
        self.flush(&mut out)?;
        self.check_given(0, true, &mut out);
        Ok(out)
    }

    /// What still waits, as it is, after a problem.
    pub(crate) fn abandon(self) -> VecDeque<Item> {
        self.waiting
    }

    /// The unit normal towards the tool of a direction.
    fn normal(&self, [x, y]: Flat) -> Flat {
        if self.side.left { [-y, x] } else { [y, -x] }
    }

    /// A programmed move from `from`. What is then certain goes to `out`.
    pub(crate) fn add(&mut self, from: [f64; 3], stroke: Stroke, out: &mut Vec<Item>) -> Result<(), NcProblem> {
        let radius = self.side.radius;
        let moves = stroke.bend.is_some() || flat(self.plane, from) != flat(self.plane, stroke.end);
        if radius > 0.0 && moves {
            let found = self.narrow.contour(self.plane, from, &stroke, radius);
            out.extend(found.map(|found| self.warning(found, stroke.place)));
        }
        let before = out.len();
        let result = self.offset(from, stroke, out);
        if radius > 0.0 {
            self.check_given(before, false, out);
        }
        result
    }

    /// Looks for slots that the moves given out do not fit into.
    fn check_given(&mut self, before: usize, ends: bool, out: &mut Vec<Item>) {
        let mut warnings = Vec::new();
        for item in &out[before..] {
            let Item::Stroke(stroke) = item else { continue };
            let from = std::mem::replace(&mut self.given, stroke.end);
            let found = self.narrow.tool(self.plane, from, stroke, ends, self.side.radius);
            warnings.extend(found.map(|found| self.warning(found, stroke.place)));
        }
        out.extend(warnings);
    }

    fn warning(&self, found: TooNarrow, place: ProgramPlace) -> Item {
        let [a, b] = found.lines;
        let text = format!(
            "the tool of radius {} mm {NARROW} of lines {} and {}: it goes {:.3} mm into the contour",
            self.side.radius,
            a.min(b),
            a.max(b),
            found.depth
        );
        Item::Warning(text, place)
    }

    fn offset(&mut self, from: [f64; 3], stroke: Stroke, out: &mut Vec<Item>) -> Result<(), NcProblem> {
        let (p, q) = (flat(self.plane, from), flat(self.plane, stroke.end));
        let radius = self.side.radius;
        if radius == 0.0 {
            self.current = stroke.end;
            out.push(Item::Stroke(stroke));
            return Ok(());
        }
        let Some(bend) = stroke.bend else {
            let d = minus(q, p);
            let distance = length(d);
            if distance == 0.0 {
                self.across(stroke, out);
                return Ok(());
            }
            let t = [d[0] / distance, d[1] / distance];
            let n = self.normal(t);
            let end = plus(q, radius, n);
            if self.first {
                if distance <= radius && !self.side.beside_next {
                    return Err(NcProblem::value(
                        "the length of the move that begins the cutter compensation",
                        format!("{distance} mm"),
                        format!("more than the tool's radius, {radius} mm"),
                    ));
                }
                self.entry = self.side.beside_next;
            } else {
                let start = plus(p, radius, n);
                let curve = Curve::Line {
                    point: start,
                    direction: t,
                };
                self.join(p, start, t, &curve, &stroke, out)?;
            }
            self.first = false;
            self.tangent = t;
            self.curvature = 0.0;
            self.curve = Curve::Line {
                point: end,
                direction: t,
            };
            self.give(stroke, end);
            return Ok(());
        };
        let counter_clockwise = bend.sweep > 0.0;
        // Where the ends' radii differ a little, that of the end counts, as on LinuxCNC.
        let arc_radius = length(minus(q, bend.centre));
        let inside = self.side.left == counter_clockwise;
        let offset_radius = if inside {
            arc_radius - radius
        } else {
            arc_radius + radius
        };
        if offset_radius <= 1e-9 {
            return Err(NcProblem::value(
                "the radius of this arc",
                format!("{arc_radius} mm"),
                format!("more than the tool's, {radius} mm: the tool does not fit into it"),
            ));
        }
        let (t, last) = (
            arc_tangent(p, bend.centre, counter_clockwise),
            arc_tangent(q, bend.centre, counter_clockwise),
        );
        let end = plus(q, radius, self.normal(last));
        let mut bend = bend;
        if self.first {
            bend = self.lead_in(p, end, last, counter_clockwise)?;
        } else {
            let start = plus(p, radius, self.normal(t));
            let curve = Curve::Circle {
                centre: bend.centre,
                radius: offset_radius,
                counter_clockwise,
            };
            self.join(p, start, t, &curve, &stroke, out)?;
        }
        self.first = false;
        self.tangent = last;
        self.curvature = bend.sweep.signum() / arc_radius;
        self.curve = Curve::Circle {
            centre: bend.centre,
            radius: length(minus(end, bend.centre)),
            counter_clockwise,
        };
        let bent = Stroke {
            bend: Some(bend),
            ..stroke
        };
        self.give(bent, end);
        Ok(())
    }

    /// A move along the plane's axis only: it waits with the move before it, if there is one.
    fn across(&mut self, stroke: Stroke, out: &mut Vec<Item>) {
        let mut end = stroke.end;
        set(self.plane, &mut end, flat(self.plane, self.current));
        self.wait(Stroke { end, ..stroke });
        if self.first {
            out.extend(self.waiting.drain(..));
            self.start = end;
        }
    }

    /// The arc from `start`, uncompensated, that ends in `end` along `last`.
    fn lead_in(&self, start: Flat, end: Flat, last: Flat, counter_clockwise: bool) -> Result<Bend, NcProblem> {
        if self.side.beside_next {
            return Err(NcProblem::syntax(
                "an arc cannot begin cutter compensation on this control: expected a straight move",
            ));
        }
        let left = [-last[1], last[0]];
        let chord = minus(start, end);
        let (along, square) = (dot(chord, left), dot(chord, chord));
        // The centre is at `end + s left`, as far from `start` as from `end`.
        let s = 0.5 * square / along;
        if !s.is_finite() || s.abs() > 1e7 || (s > 0.0) != counter_clockwise || s.abs() <= 1e-9 {
            return Err(NcProblem::syntax(
                "no arc from here ends beside the end of this one: cutter compensation needs a longer or straight move to begin with",
            ));
        }
        let centre = plus(end, s, left);
        let (a, b) = (minus(start, centre), minus(end, centre));
        let mut sweep = cross(a, b).atan2(dot(a, b));
        if counter_clockwise && sweep <= 0.0 {
            sweep += TAU;
        } else if !counter_clockwise && sweep >= 0.0 {
            sweep -= TAU;
        }
        Ok(Bend { centre, sweep })
    }

    /// Lets a move wait; `at` is its compensated end.
    fn give(&mut self, stroke: Stroke, at: Flat) {
        let mut end = stroke.end;
        set(self.plane, &mut end, at);
        self.wait(Stroke { end, ..stroke });
    }

    fn wait(&mut self, stroke: Stroke) {
        self.current = stroke.end;
        self.waiting.push_back(Item::Stroke(stroke));
    }

    /// Gives out what waits.
    pub(super) fn flush(&mut self, out: &mut Vec<Item>) -> Result<(), NcProblem> {
        let end = flat(self.plane, self.current);
        self.flush_to(end, false, out)
    }

    /// Gives out what waits, with its end moved. Moves may become longer only where they are to be extended.
    pub(super) fn flush_to(&mut self, at: Flat, extends: bool, out: &mut Vec<Item>) -> Result<(), NcProblem> {
        let plane = self.plane;
        let (start, direction) = (flat(plane, self.start), self.tangent);
        // Those after the first are across the plane.
        let mut is_first = true;
        for item in &mut self.waiting {
            let Item::Stroke(stroke) = item else { continue };
            let checks = std::mem::take(&mut is_first) && !self.entry;
            let too_far = match &mut stroke.bend {
                None if !checks => false,
                None => dot(direction, minus(at, start)) < -1e-9,
                Some(bend) => {
                    let (a, b) = (minus(start, bend.centre), minus(at, bend.centre));
                    let angle = cross(a, b).atan2(dot(a, b));
                    // The turn that differs least from the programmed one.
                    let sweep = angle + TAU * ((bend.sweep - angle) / TAU).round();
                    let reversed = sweep * bend.sweep < 0.0 && sweep.abs() * length(b) > 1e-6;
                    // Corners that count as none leave a gap of so much.
                    let gap = self.side.tangent * self.side.radius;
                    let longer = (sweep.abs() - bend.sweep.abs()) * length(b) > gap.max(0.0254);
                    bend.sweep = sweep;
                    reversed || longer && !extends && !self.extended
                }
            };
            if too_far {
                return Err(NcProblem::syntax(format!(
                    "the tool of radius {} mm does not fit into this inside corner: it would gouge the move before",
                    self.side.radius
                )));
            }
            set(plane, &mut stroke.end, at);
        }
        set(plane, &mut self.current, at);
        self.entry = false;
        self.extended = extends;
        out.extend(self.waiting.drain(..));
        self.start = self.current;
        Ok(())
    }
}
