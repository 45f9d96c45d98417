//! Arcs, rounded corners and chamfers.

use std::f64::consts::TAU;

use crate::controls::heidenhain::contours::free::is_free;
use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::words::MoveWords;
use crate::drive::{CircularArc, Corner, CornerShape, ProgramPlace};
use crate::text::error::{Located, NcProblem};

/// Whether a block moves along the contour.
fn is_contour(word: &str) -> bool {
    matches!(word, "L" | "LP" | "C" | "CP" | "CR" | "CT" | "CTP") || is_free(word)
}

impl Reader<'_> {
    /// `RND R5`, `CHF 2`: made with the move before it.
    pub(in crate::controls::heidenhain) fn corner_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        self.corner_of(line)?;
        let refuse = |side: &str| {
            whole(NcProblem::unsupported(
                format!("{} {side} other than a feed move is", line.word(0)),
                "expected it between two moves of a contour",
            ))
        };
        if std::mem::take(&mut self.rounded) {
            let mut next = self.following();
            // CC moves nothing.
            if next.as_ref().is_some_and(|next| next.word(0) == "CC") {
                next = self.following_after(1);
            }
            if next.is_some_and(|next| is_contour(next.word(0))) {
                return Ok(());
            }
            return Err(refuse("before"));
        }
        if self.uncertain { Ok(()) } else { Err(refuse("after")) }
    }

    /// The corner of `RND` or `CHF`.
    fn corner_of(&self, line: &Line) -> Result<Corner, Located> {
        let whole = |problem| (problem, line.all());
        let rounds = line.word(0).starts_with("RND");
        let (word, name) = if rounds {
            ("RND", "the radius of RND")
        } else {
            ("CHF", "the length of CHF")
        };
        let text = line.word(1).trim_start_matches('R').to_owned();
        let size = self.parameters.value(&text).map_err(whole)? * self.unit();
        if !(size > 0.0) {
            return Err(whole(NcProblem::value(name, size, "positive")));
        }
        let mut feed = None;
        for token in line.tokens.iter().skip(2) {
            match token.text.strip_prefix('F') {
                Some("AUTO") => feed = self.modes.tool_feed,
                Some("") => {}
                Some(value) => {
                    let value = self.parameters.value(value);
                    feed = Some(value.map_err(|problem| (problem, token.span.clone()))? * self.feed_unit());
                }
                None if token.text.starts_with('M') || token.text.parse::<f64>().is_ok() => {}
                None => {
                    let problem = NcProblem::syntax(format!("{} in {word}: expected F or M", token.text));
                    return Err((problem, token.span.clone()));
                }
            }
        }
        Ok(Corner {
            shape: if rounds {
                CornerShape::Round(size)
            } else {
                CornerShape::Cut(size)
            },
            plane: self.modes.plane,
            place: ProgramPlace::default(),
            feed,
            word,
            strict: true,
        })
    }

    /// The corner that the next block makes at the end of this move.
    pub(in crate::controls::heidenhain) fn corner_ahead(&mut self, rapid: bool, abc: [f64; 3]) -> Result<(), Located> {
        let Some((next, place)) = self.following_with_place() else {
            return Ok(());
        };
        let corner_block = next.word(0).starts_with("RND") || next.word(0).starts_with("CHF");
        if !corner_block || rapid || self.track.known().is_none() {
            return Ok(());
        }
        // A bad corner is reported at its own block.
        if let Ok(corner) = self.corner_of(&next) {
            if abc != self.track.abc {
                return Err((
                    NcProblem::unsupported("rounding where rotary axes turn is", "expected a corner of lines"),
                    next.all(),
                ));
            }
            self.rounded = true;
            self.track.corner_next(Corner { place, ..corner });
        }
        Ok(())
    }

    pub(in crate::controls::heidenhain) fn arc_block(
        &mut self,
        kind: &str,
        words: &MoveWords,
        target: [f64; 3],
        abc: [f64; 3],
    ) -> Result<(), NcProblem> {
        let Some(start) = self.track.known() else { return Ok(()) };
        let plane = self.modes.plane;
        let [u, v, _] = plane;
        let ends = (start, target);
        let sense = words.counter_clockwise;
        let need_sense = || NcProblem::syntax("an arc without its sense: expected DR+ or DR-");
        let need_centre = || NcProblem::syntax("an arc without a centre: expected CC before it");
        let arc = match kind {
            "C" => CircularArc::about(
                ends,
                plane,
                self.modes.centre.ok_or_else(need_centre)?,
                sense.ok_or_else(need_sense)?,
                1.0,
            ),
            "CP" => {
                let centre = self.modes.centre.ok_or_else(need_centre)?;
                let counter_clockwise = sense.ok_or_else(need_sense)?;
                // An incremental angle may be more than a turn, IPA+1080 with IZ is a thread, and is the turn whatever its ends are.
                let swept = match words.polar[1] {
                    Some((angle, true)) if (angle > 0.0) != counter_clockwise => {
                        return Err(NcProblem::value("IPA", angle, "of the sign of DR"));
                    }
                    Some((angle, true)) => Some(angle.to_radians()),
                    _ => None,
                };
                let turns = swept.map_or(1.0, |sweep| sweep.abs() / TAU);
                if turns > 1e4 {
                    return Err(NcProblem::value(
                        "the number of turns of an arc",
                        turns,
                        "at most 10000",
                    ));
                }
                CircularArc::about(ends, plane, centre, counter_clockwise, 1.0).map(|arc| CircularArc {
                    sweep: swept.unwrap_or(arc.sweep),
                    ..arc
                })
            }
            "CR" => {
                let radius = words
                    .radius
                    .ok_or_else(|| NcProblem::syntax("CR without R: expected the radius"))?;
                CircularArc::with_radius(ends, plane, radius, sense.ok_or_else(need_sense)?, 1.0)
            }
            _ => {
                let way = self.track.last_direction().map(|way| [way[u], way[v]]);
                CircularArc::tangential(ends, plane, way.filter(|way| *way != [0.0; 2]), "CT")
            }
        }
        .map_err(NcProblem::syntax)?;
        self.track.circle(&arc, abc)
    }
}
