//! Arcs.

use nalgebra::Vector3;

use super::interpreter::Reader;
use super::state::Motion;
use super::words::{Meaning, Words};
use crate::drive::{Arc, CircularArc};
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    pub(super) fn arc(&mut self, words: &Words, target: [f64; 3], abc: [f64; 3]) -> Result<(), Located> {
        let whole = words
            .any(&["X", "Y", "Z", "I", "J", "K", "CR", "AR", "I1", "AP", "RP"])
            .map_or(0..0, |word| word.span.clone());
        let fail = |message: String| (NcProblem::syntax(message), whole.clone());
        let Some(start) = self.track.known() else { return Ok(()) };
        let plane = self.modes.plane;
        let [u, v, _] = plane;
        let unit = self.modes.unit();
        let turns = words.plain("TURN").unwrap_or(0.0);
        NcProblem::whole("TURN", turns, 0..=999, "a whole number from 0 to 999")
            .map_err(|problem| (problem, words.span("TURN")))?;
        let ends = (start, target);
        let Motion::Arc { counter_clockwise } = self.modes.motion else {
            if self.modes.motion == Motion::Tangential {
                let way = self.track.last_direction().map(|way| [way[u], way[v]]);
                let arc =
                    CircularArc::tangential(ends, plane, way.filter(|way| *way != [0.0; 2]), "CT").map_err(fail)?;
                return self.go_along(&arc, abc, whole);
            }
            return self.through(words, start, target, abc, whole);
        };
        let centre_words = ["I", "J", "K"];
        let centre = |k: usize| {
            words.get(centre_words[k]).map(|word| {
                let value = word.value * unit;
                // Centres are from the start, also in G90.
                if word.meaning == Meaning::Absolute {
                    value
                } else {
                    start[k] + value
                }
            })
        };
        let opening = words.plain("AR").filter(|_| words.plain("CR").is_none());
        if let Some(angle) = opening.filter(|angle| !(*angle > 0.0 && *angle < 360.0)) {
            return Err((NcProblem::value("AR", angle, "between 0 and 360"), words.span("AR")));
        }
        let arc = if let Some(radius) = words.plain("CR") {
            CircularArc::with_radius(ends, plane, radius * unit, counter_clockwise, 1.0 + turns)
        } else if words.any(&centre_words).is_some() {
            let at = [centre(u).unwrap_or(start[u]), centre(v).unwrap_or(start[v])];
            if let Some(angle) = opening {
                // An opening angle with a centre gives the end.
                let sweep = if counter_clockwise { angle } else { -angle }.to_radians();
                let (sin, cos) = sweep.sin_cos();
                let from = [start[u] - at[0], start[v] - at[1]];
                let mut end = target;
                end[u] = at[0] + cos * from[0] - sin * from[1];
                end[v] = at[1] + sin * from[0] + cos * from[1];
                CircularArc::about((start, end), plane, at, counter_clockwise, 1.0 + turns)
            } else {
                CircularArc::about(ends, plane, at, counter_clockwise, 1.0 + turns)
            }
        } else if let Some(angle) = opening {
            let chord = (target[u] - start[u]).hypot(target[v] - start[v]);
            let radius = 0.5 * chord / (0.5 * angle.to_radians()).sin();
            let signed = if angle > 180.0 { -radius } else { radius };
            CircularArc::with_radius(ends, plane, signed, counter_clockwise, 1.0 + turns)
        } else if words.any(&["AP", "RP"]).is_some() {
            CircularArc::about(ends, plane, self.modes.pole, counter_clockwise, 1.0 + turns)
        } else {
            return Err(fail(format!(
                "this arc has no centre: expected {} and {}, CR= or AR=",
                centre_words[u], centre_words[v]
            )));
        }
        .map_err(fail)?;
        self.go_along(&arc, abc, whole)
    }

    fn go_along(&mut self, arc: &CircularArc, abc: [f64; 3], whole: std::ops::Range<usize>) -> Result<(), Located> {
        self.track.circle(arc, abc).map_err(|problem| (problem, whole))
    }

    /// An arc through an intermediate point (`CIP` with `I1`, `J1`, `K1`), in any plane.
    fn through(
        &mut self,
        words: &Words,
        start: [f64; 3],
        end: [f64; 3],
        abc: [f64; 3],
        whole: std::ops::Range<usize>,
    ) -> Result<(), Located> {
        let unit = self.modes.unit();
        let middle: [f64; 3] = std::array::from_fn(|k| match words.get(["I1", "J1", "K1"][k]) {
            Some(word) if self.relative(word) => start[k] + word.value * unit,
            Some(word) => word.value * unit,
            None => start[k],
        });
        let (a, b, c) = (Vector3::from(start), Vector3::from(middle), Vector3::from(end));
        let (p, q) = (b - a, c - a);
        let normal = p.cross(&q);
        let size = normal.norm();
        if !(size > 1e-9 * p.norm() * q.norm()) {
            let problem =
                NcProblem::syntax("the three points of CIP lie on a line: expected an intermediate point beside it");
            return Err((problem, whole));
        }
        // The circumcentre of the triangle.
        let to_centre = (q * p.norm_squared() - p * q.norm_squared()).cross(&normal) / (2.0 * size * size);
        let centre = a + to_centre;
        let unit_normal = normal / size;
        let (from, to) = (a - centre, c - centre);
        let sweep = unit_normal
            .dot(&from.cross(&to))
            .atan2(from.dot(&to))
            .rem_euclid(std::f64::consts::TAU);
        let arc = Arc {
            start,
            end,
            centre: centre.into(),
            normal: unit_normal.into(),
            sweep,
        };
        self.track.arc(&arc, abc).map_err(|problem| (problem, whole))
    }
}
