//! Frames: datum shifts, rotation, scale, mirror and tilted planes.

use nalgebra::{Matrix3, Vector3};

use super::interpreter::Reader;
use super::language::line::{self, Line};
use crate::machines::WorkFrame;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// The cycles of frames, by their first part (`7.1` is part 1 of 7).
pub(super) fn is_frame_cycle(number: u32) -> bool {
    matches!(number, 7 | 8 | 10 | 11 | 247)
}

impl Reader<'_> {
    fn apply_frames(&mut self) -> Result<(), NcProblem> {
        self.frames.order_unknown &= self.frames.transformed();
        // Centres are of the old frame.
        self.modes.centre = None;
        self.track.set_frame(self.frames.total(self.modes.plane))
    }

    pub(super) fn frame_cycle(&mut self, number: u32, part: &str, line: &Line) -> Result<(), Located> {
        let words = line.tokens.get(3..).unwrap_or(&[]);
        if part == "0" {
            return Ok(());
        }
        match number {
            7 => {
                for token in words {
                    let here = |problem| (problem, token.span.clone());
                    let (relative, rest) = line::relative(&token.text);
                    let Some(k) = ["X", "Y", "Z"].iter().position(|axis| rest.starts_with(axis)) else {
                        let problem = NcProblem::unsupported(
                            format!("{} in a datum shift is", token.text),
                            "expected X, Y or Z with a value",
                        );
                        return Err(here(problem));
                    };
                    let value = self.parameters.value(&rest[1..]).map_err(here)? * self.unit();
                    let shift = if self.frames.tilted() {
                        &mut self.frames.tilted_shift[k]
                    } else {
                        &mut self.frames.shift[k]
                    };
                    let before = *shift;
                    *shift = if relative { before + value } else { value };
                    self.frames.order_unknown |= *shift != before;
                }
            }
            8 => {
                self.frames.mirror = [false; 3];
                for token in words {
                    match ["X", "Y", "Z"].iter().position(|axis| token.text == *axis) {
                        Some(k) => self.frames.mirror[k] = true,
                        None => {
                            let problem = NcProblem::value("a mirrored axis", &token.text, "X, Y or Z");
                            return Err((problem, token.span.clone()));
                        }
                    }
                }
            }
            10 => {
                for token in words {
                    let here = |problem| (problem, token.span.clone());
                    let (relative, rest) = line::relative(&token.text);
                    let Some(angle) = rest.strip_prefix("ROT") else {
                        return Err(here(NcProblem::syntax(format!(
                            "{} here: expected ROT with an angle",
                            token.text
                        ))));
                    };
                    let angle = self.parameters.value(angle).map_err(here)?;
                    self.frames.rotation = if relative { self.frames.rotation + angle } else { angle };
                }
            }
            11 => {
                // `SCL0.99` and `SCL 0.99`.
                let text: String = words.iter().map(|token| token.text.as_str()).collect();
                let whole = |problem| (problem, line.all());
                let Some(factor) = text.strip_prefix("SCL") else {
                    return Err(whole(NcProblem::syntax(format!(
                        "{text:?} here: expected SCL with a factor"
                    ))));
                };
                let factor = self.parameters.value(factor).map_err(whole)?;
                if !(factor > 0.0 && factor < 100.0) {
                    return Err(whole(NcProblem::value("SCL", factor, "above 0 and below 100")));
                }
                self.frames.scale = Some(factor);
            }
            _ => {
                let preset = line
                    .tokens
                    .iter()
                    .find_map(|token| token.text.strip_prefix("Q339=").map(str::to_owned));
                let whole = |problem| (problem, line.all());
                let number = match preset {
                    Some(text) => self.parameters.value(&text).map_err(whole)?,
                    None => {
                        return Err(whole(NcProblem::syntax(
                            "cycle 247 without Q339: expected the number of the preset",
                        )));
                    }
                };
                let expected = "a whole number from 0 to 999";
                self.frames.work.active = NcProblem::whole("Q339", number, 0..=999, expected).map_err(whole)?;
            }
        }
        self.apply_frames().map_err(|problem| (problem, line.all()))
    }

    /// `TRANS DATUM AXIS X+5`, `TRANS DATUM RESET`: as cycle 7.
    pub(super) fn datum_block(&mut self, line: &Line) -> Result<(), Located> {
        match line.word(2) {
            "AXIS" => self.frame_cycle(7, "1", line),
            "RESET" => {
                (self.frames.shift, self.frames.tilted_shift) = ([0.0; 3], [0.0; 3]);
                self.apply_frames().map_err(|problem| (problem, line.all()))
            }
            word => {
                let problem = NcProblem::unsupported(format!("TRANS DATUM {word} is"), "expected AXIS or RESET");
                Err((problem, line.all()))
            }
        }
    }

    /// `STAY`: the angles that turn the tool to the plane are in Q120 to Q122 for the blocks that follow.
    fn keep_angles(&mut self, normal: [f64; 3], line: &Line) -> Result<(), NcProblem> {
        /// How many blocks behind it are looked at for the letters of the axes.
        const AHEAD: usize = 12;
        let uses = |name: &str| {
            let letter = if name == "Q121" { 'B' } else { 'A' };
            let ahead = (0..AHEAD).filter_map(|skipped| self.following_after(skipped));
            let uses = |line: &Line| {
                let mut words = line.tokens.iter().map(|token| &token.text);
                words.any(|word| word.starts_with(letter) && word.ends_with(name))
            };
            ahead.take_while(|line| line.word(0) != "PLANE").any(|line| uses(&line))
        };
        let tilting = match (uses("Q120"), uses("Q121")) {
            (false, false) => return Ok(()),
            (true, _) => 0,
            (false, true) => 1,
        };
        if !self.track.driver.knows_rotaries() {
            let mut abc = [0.0; 3];
            abc[tilting] = 1.0;
            self.track.driver.rotaries(abc)?;
            let (name, ready) = if tilting == 0 {
                ("A and C", "trunnion-ac")
            } else {
                ("B and C", "trunnion-bc")
            };
            self.track.assume(Assumption::new(
                "the machine's rotary axes, for Q120 to Q122 after PLANE … STAY",
                format!("{name}, as those of {ready}"),
                "--machine",
            ));
        }
        let positive = ["SEQ+", "SEQ-"].map(|word| line.tokens.iter().any(|token| token.text == word));
        let near = |sign: f64| {
            let mut near = self.track.abc;
            near[tilting] = sign * 90.0;
            near
        };
        let near = match positive {
            [true, _] => near(1.0),
            [_, true] => near(-1.0),
            _ => self.track.abc,
        };
        let abc = self.track.driver.angles(normal, near)?;
        for (parameter, angle) in ["Q120", "Q121", "Q122"].into_iter().zip(abc) {
            self.parameters.set(parameter, angle)?;
        }
        Ok(())
    }

    /// `PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX`, `PLANE EULER`, `PLANE VECTOR`, `PLANE RESET`.
    pub(super) fn plane_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let named = |reader: &Self, name: &str| -> Result<f64, Located> {
            let token = line.tokens.iter().find(|token| {
                token
                    .text
                    .strip_prefix(name)
                    .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || "+-Q.".contains(c)))
            });
            let Some(token) = token else {
                return Err(whole(NcProblem::syntax(format!(
                    "PLANE {} without {name}: expected {name} with a number",
                    line.word(1)
                ))));
            };
            reader
                .parameters
                .value(&token.text[name.len()..])
                .map_err(|problem| (problem, token.span.clone()))
        };
        let three = |reader: &Self, names: [&str; 3]| -> Result<[f64; 3], Located> {
            let [x, y, z] = names.map(|name| named(reader, name));
            Ok([x?, y?, z?])
        };
        let tilt = match line.word(1) {
            "SPATIAL" => Some(WorkFrame::spatial(three(self, ["SPA", "SPB", "SPC"])?)),
            "EULER" => Some(WorkFrame::euler_zxz(
                [0.0; 3],
                three(self, ["EULPR", "EULNU", "EULROT"])?,
            )),
            "VECTOR" => {
                let base = Vector3::from(three(self, ["BX", "BY", "BZ"])?);
                let normal = Vector3::from(three(self, ["NX", "NY", "NZ"])?);
                // The base vector is turned into the plane, if it is not quite there.
                let y = normal.cross(&base);
                if !(y.norm() > 1e-9 * normal.norm() * base.norm()) {
                    return Err(whole(NcProblem::syntax(
                        "the base vector and the normal are parallel, or 0: expected two directions",
                    )));
                }
                let (y, z) = (y.normalize(), normal.normalize());
                Some(WorkFrame::with_matrix(
                    Matrix3::from_columns(&[y.cross(&z), y, z]),
                    Vector3::zeros(),
                ))
            }
            "RELATIV" => {
                let before = self.frames.tilt.unwrap_or_default();
                let before = before.then(&WorkFrame::shifted(std::mem::take(&mut self.frames.tilted_shift)));
                let names = ["SPA", "SPB", "SPC"];
                let given = |name: &str| line.tokens.iter().any(|token| token.text.starts_with(name));
                let mut angles = [0.0; 3];
                for (angle, name) in angles.iter_mut().zip(names).filter(|(_, name)| given(name)) {
                    *angle = named(self, name)?;
                }
                Some(before.then(&WorkFrame::spatial(angles)))
            }
            "RESET" => None,
            word => {
                let problem = NcProblem::unsupported(
                    format!("PLANE {word} is"),
                    "expected PLANE SPATIAL, EULER, VECTOR, RELATIV or RESET",
                );
                return Err((problem, line.span(1)));
            }
        };
        let has = |word: &str| line.tokens.iter().any(|token| token.text == word);
        let turns = has("TURN") || has("MOVE");
        // MOVE moves the linear axes too, by a distance that the machine knows.
        let turn = has("TURN").then(|| has("FMAX") || has("MAX"));
        self.set_plane(tilt, turns, turn, line)
    }

    /// `CYCL DEF 19.1 A+0 B+30 C+0`: a plane by angles, without turning an axis.
    ///
    /// Source: *TNC 320, Cycle Programming* (340 55x-04), 11.9 Working plane: the angles are those of turns in the order A, B, C about the machine's axes, or of the rotary axes.
    pub(super) fn working_plane(&mut self, part: &str, line: &Line) -> Result<(), Located> {
        if matches!(part, "" | "0") {
            return Ok(());
        }
        let mut angles = [0.0; 3];
        for token in line.tokens.get(3..).unwrap_or(&[]) {
            let Some(k) = ["A", "B", "C"].iter().position(|axis| token.text.starts_with(axis)) else {
                continue;
            };
            // ABST is a distance.
            if !token.text[1..].starts_with(|c: char| "+-.Q".contains(c) || c.is_ascii_digit()) {
                continue;
            }
            let angle = self.parameters.value(&token.text[1..]);
            angles[k] = angle.map_err(|problem| (problem, token.span.clone()))?;
        }
        let tilt = (angles != [0.0; 3]).then(|| WorkFrame::spatial(angles));
        if tilt.is_some() {
            let what = "whether the angles of cycle 19 are those of the plane or of the rotary axes";
            let taken = "of the plane, turned about A, B and C in this order";
            self.track.assume(Assumption::new(what, taken, "PLANE SPATIAL"));
        }
        self.set_plane(tilt, false, None, line)
    }

    /// `CYCL DEF 26.1 X1.5 Y0.9 CCX+10 CCY+5`: scales of the axes, about a point.
    pub(super) fn scale_axes(&mut self, part: &str, line: &Line) -> Result<(), Located> {
        if matches!(part, "" | "0") {
            return Ok(());
        }
        for token in line.tokens.get(3..).unwrap_or(&[]) {
            let here = |problem| (problem, token.span.clone());
            let (centre, rest) = match token.text.strip_prefix("CC") {
                Some(rest) => (true, rest),
                None => (false, token.text.as_str()),
            };
            let Some(k) = ["X", "Y", "Z"].iter().position(|axis| rest.starts_with(axis)) else {
                let problem = format!("{} in cycle 26: expected such as X1.5 CCX+10", token.text);
                return Err(here(NcProblem::syntax(problem)));
            };
            let value = self.parameters.value(&rest[1..]).map_err(here)?;
            if centre {
                self.frames.fixed[k] = value * self.unit();
            } else if value > 0.0 && value < 100.0 {
                self.frames.axis_scales[k] = value;
            } else {
                return Err(here(NcProblem::value("a scale", value, "above 0 and below 100")));
            }
        }
        self.apply_frames().map_err(|problem| (problem, line.all()))
    }

    /// Tilts the plane, or ends that: `turns` the tool to it, by a move (`turn`: whether in rapid), or not.
    fn set_plane(
        &mut self,
        tilt: Option<WorkFrame>,
        turns: bool,
        turn: Option<bool>,
        line: &Line,
    ) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if self.frames.tilted_shift != [0.0; 3] {
            let taken = "it ends with its plane";
            let what = "a datum shift in a plane, where another plane comes or it is reset";
            let settle = "cycle 7 with 0 before it";
            self.track.assume(Assumption::new(what, taken, settle));
        }
        self.frames.order_unknown |= tilt.is_some();
        self.frames.tilted_shift = [0.0; 3];
        self.frames.tilt = tilt;
        let mut normal = [0.0, 0.0, 1.0];
        if tilt.is_some() {
            // Coordinates become the tip's first: the frame is the part's.
            self.control(self.modes.tip_control).map_err(whole)?;
            normal = self.frames.total(self.modes.plane).direction(normal);
        }
        self.apply_frames().map_err(whole)?;
        if turns && self.track.turn_to(normal, turn).map_err(whole)? {
            self.track.note("PLANE turns the rotary axes: the path breaks here");
        }
        if tilt.is_none() {
            self.control(self.modes.tip_control).map_err(whole)?;
        } else if !turns {
            self.keep_angles(normal, line).map_err(whole)?;
            self.track
                .note("PLANE … STAY turns no axis: the tool keeps its direction");
        }
        Ok(())
    }
}
