//! Contours: cutter compensation, rounded corners and chamfers, polar coordinates.

use super::interpreter::Reader;
use super::language::expression::Value;
use super::state::{Motion, PoleFrom};
use super::words::{Action, Meaning, Words};
use crate::drive::{CompensationSettings, Corner, CornerShape, Corners, DiameterAsked, end_at_angle};
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// `G41` and `G42`, and `G40` in a block that does not move in the part's frame.
    pub(super) fn switch_compensation(&mut self, action: &Action, words: &Words) -> Result<(), Located> {
        let whole = |problem| (problem, words.whole());
        let Some(side) = action.side else { return Ok(()) };
        let Some(left) = side else {
            if action.home.is_some() || action.machine || self.without_length() {
                self.track.end_compensation(None).map_err(whole)?;
            }
            return Ok(());
        };
        if self.uncertain && self.track.known().is_none() {
            return Ok(());
        }
        let radius = self.cutter_radius(0.0).map_err(whole)?;
        if self.modes.corners == Corners::Arcs && self.modes.distortion != 0.0 {
            return Err(whole(NcProblem::value(
                "DISC",
                self.modes.distortion,
                "0: other corners than arcs are not read",
            )));
        }
        let side = CompensationSettings {
            left: left == (radius >= 0.0),
            radius: radius.abs(),
            corners: self.modes.corners,
            beside_next: true,
            round_ends: self.modes.round_ends,
            tangent: 1e-6,
        };
        // Beside a contour the last move ends at right angles, and this one begins as if compensation had been off.
        self.track.end_compensation(None).map_err(whole)?;
        self.modes.compensated = Some(self.modes.compensation());
        self.track.compensate(side, self.modes.plane).map_err(whole)
    }

    /// Refuses to go on beside a contour in another way than it began.
    pub(super) fn check_compensation(&self) -> Result<(), NcProblem> {
        let Some(began) = self.modes.compensated.filter(|_| self.track.compensates()) else {
            return Ok(());
        };
        let now = self.modes.compensation();
        let what = match () {
            () if now.plane != began.plane => "the plane",
            () if now.edge != began.edge => "D",
            () if now.allowance != began.allowance => "OFFN",
            () if now != began => "G450, G451 or DISC",
            () => return Ok(()),
        };
        Err(NcProblem::unsupported(
            format!("a change of {what} while cutter compensation is on is"),
            "expected G40 before it, or G41 or G42 again with it",
        ))
    }

    /// The radius of the tool's edge, with its allowance. `unknown`: its diameter where nobody tells it, in mm.
    pub(super) fn cutter_radius(&mut self, unknown: f64) -> Result<f64, NcProblem> {
        let edge = self.modes.edge;
        if edge == 0 {
            return Ok(self.modes.allowance);
        }
        let tool = match self.track.tool {
            None if self.track.strict() => {
                let problem = "cutter compensation without a tool: expected T before it";
                return Err(NcProblem::syntax(problem));
            }
            tool => tool.unwrap_or(0),
        };
        let own = self.globals.get(&format!("$TC_DP6[{tool}][{edge}]")).cloned();
        let table = self.options.tool_offsets.get(&tool).map(|offset| offset.diameter);
        let table = table
            .or(self.options.diameters.get(&tool).copied())
            .filter(|_| edge == 1);
        let radius = match (own, table) {
            (Some(Value::Number(radius)), _) => Some(radius),
            (_, Some(diameter)) => Some(0.5 * diameter),
            _ => {
                let asked = DiameterAsked {
                    register: &format!("the radius of T{tool} D{edge}"),
                    option: &format!("D{tool}"),
                    unit: self.modes.unit(),
                    wear: self.options.wear_registers && unknown == 0.0,
                    unknown,
                };
                self.track.assume_diameter(&asked).map(|diameter| 0.5 * diameter)
            }
        };
        let radius = radius.ok_or_else(|| {
            NcProblem::syntax(format!(
                "the radius of T{tool} D{edge} for cutter compensation is not known: expected it in the tool table (in a job: `diameters`), or \
                 $TC_DP6[{tool},{edge}]= before it"
            ))
        })?;
        Ok(radius + self.modes.allowance)
    }

    /// Words of corners.
    pub(super) fn corner_words(&mut self, words: &Words, action: &mut Action) -> Result<(), Located> {
        let unit = self.modes.unit();
        for word in &words.0 {
            let size = word.value * unit;
            let feed = Some(word.value).filter(|feed| *feed > 0.0);
            let mut made = None;
            match word.name.as_str() {
                "RND" => made = Some(("RND", CornerShape::Round(size))),
                "CHR" => made = Some(("CHR", CornerShape::Cut(size))),
                "CHF" => made = Some(("CHF", CornerShape::Edge(size))),
                "RNDM" => self.modes.rounding = (size > 0.0).then_some(size),
                "FRC" => action.corner_feed = feed,
                "FRCM" => self.modes.corner_feed = feed,
                "DISC" => self.modes.distortion = word.value,
                "ANG" if words.any(&["X", "Y", "Z"]).is_none() => {
                    let problem =
                        NcProblem::unsupported("ANG without an end is", "expected one coordinate of the plane with it");
                    return Err((problem, word.span.clone()));
                }
                _ => continue,
            }
            if size < 0.0 {
                return Err((
                    NcProblem::value(word.name.clone(), word.value, "0 or positive"),
                    word.span.clone(),
                ));
            }
            if let Some(made) = made.filter(|_| size > 0.0) {
                action.corner = Some(made);
            }
        }
        Ok(())
    }

    /// The coordinate of the plane that `ANG` leaves to the angle of the line.
    pub(super) fn along_angle(&self, words: &Words, to: &mut [Option<f64>; 3]) -> Result<(), Located> {
        let Some(word) = words.get("ANG") else { return Ok(()) };
        let fail = |problem| Err((problem, word.span.clone()));
        let [u, v, _] = self.modes.plane;
        let given = [u, v].map(|k| words.get(["X", "Y", "Z"][k]).is_some());
        if given[0] == given[1] || !matches!(self.modes.motion, Motion::Rapid | Motion::Feed) {
            let problem =
                "ANG beside both coordinates of the plane, or neither, or in an arc: expected a line and one of them";
            return fail(NcProblem::syntax(problem));
        }
        let here = self.track.xyz;
        let ([Some(a), Some(b)], [Some(x), Some(y)]) = ([u, v].map(|k| here[k]), [u, v].map(|k| to[k])) else {
            return Ok(());
        };
        let end = end_at_angle([a, b], [x, y], given[0], word.value.to_radians());
        let Some([a, b]) = end else {
            return fail(NcProblem::value(
                "ANG",
                word.value,
                "an angle at which the line gets there",
            ));
        };
        (to[u], to[v]) = (Some(a), Some(b));
        Ok(())
    }

    /// The corner at the end of the move of this block, if it has one.
    pub(super) fn corner_at_end(&mut self, action: &Action) {
        let modal = self.modes.rounding.map(|radius| ("RNDM", CornerShape::Round(radius)));
        let Some((word, shape)) = action.corner.or(modal.filter(|_| self.modes.motion != Motion::Rapid)) else {
            return;
        };
        self.track.corner_next(Corner {
            shape,
            plane: self.modes.plane,
            place: self.track.place,
            feed: action.corner_feed.or(self.modes.corner_feed),
            word,
            strict: false,
        });
    }

    /// `G110`, `G111` and `G112`: the pole, in Cartesian or polar coordinates.
    pub(super) fn set_pole(&mut self, from: PoleFrom, words: &Words) -> Result<(), Located> {
        let [u, v, _] = self.modes.plane;
        let unit = self.modes.unit();
        let base = match (from, self.track.xyz[u], self.track.xyz[v]) {
            (PoleFrom::Position, Some(a), Some(b)) => [a, b],
            (PoleFrom::Position, ..) if self.uncertain => return Ok(()),
            (PoleFrom::Position, ..) => {
                let problem = NcProblem::syntax("G110 at an unknown position: expected a move before it");
                return Err((problem, words.whole()));
            }
            (PoleFrom::Zero, ..) => [0.0; 2],
            (PoleFrom::Pole, ..) => self.modes.pole,
        };
        let by = match (words.plain("AP"), words.plain("RP")) {
            (Some(angle), Some(radius)) => {
                let (sin, cos) = angle.to_radians().sin_cos();
                [radius * unit * cos, radius * unit * sin]
            }
            (None, None) => [u, v].map(|k| words.plain(["X", "Y", "Z"][k]).unwrap_or(0.0) * unit),
            _ => {
                let problem = NcProblem::syntax("a pole by AP or RP alone: expected both");
                return Err((problem, words.whole()));
            }
        };
        self.modes.pole = [base[0] + by[0], base[1] + by[1]];
        (self.modes.polar_angle, self.modes.polar_radius) = (None, None);
        Ok(())
    }

    /// The coordinates in the plane that `AP` and `RP` give. Both keep their values from block to block.
    pub(super) fn polar(&mut self, words: &Words) -> Result<[Option<f64>; 3], Located> {
        let (angle, radius) = (words.get("AP"), words.get("RP"));
        let Some(first) = angle.or(radius) else {
            return Ok([None; 3]);
        };
        let span = first.span.clone();
        let [u, v, _] = self.modes.plane;
        if let Some(word) = [u, v].iter().find_map(|&k| words.get(["X", "Y", "Z"][k])) {
            let problem = NcProblem::syntax(format!(
                "{} beside polar coordinates: expected only the axis across the plane with them",
                word.name
            ));
            return Err((problem, word.span.clone()));
        }
        if let Some(word) = angle {
            self.modes.polar_angle = Some(match self.modes.polar_angle {
                Some(before) if self.relative(word) => before + word.value,
                None if self.relative(word) => {
                    let problem = NcProblem::syntax("an incremental AP without an angle before it: expected AP=AC(…)");
                    return Err((problem, span));
                }
                _ => word.value,
            });
        }
        if let Some(word) = radius {
            let value = word.value * self.modes.unit();
            let before = self.modes.polar_radius.filter(|_| word.meaning == Meaning::Incremental);
            self.modes.polar_radius = Some(before.unwrap_or(0.0) + value);
        }
        let (Some(angle), Some(radius)) = (self.modes.polar_angle, self.modes.polar_radius) else {
            let problem = NcProblem::syntax("polar coordinates without AP and RP: expected both since the last pole");
            return Err((problem, span));
        };
        let (sin, cos) = angle.to_radians().sin_cos();
        let mut xyz = [None; 3];
        xyz[u] = Some(self.modes.pole[0] + radius * cos);
        xyz[v] = Some(self.modes.pole[1] + radius * sin);
        Ok(xyz)
    }
}
