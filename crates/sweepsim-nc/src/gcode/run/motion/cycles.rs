//! Drilling cycles: G73, G74, G76 and G81 to G89.
//!
//! Sources: *LinuxCNC G-code reference, Canned Cycles*; Fanuc B-63944EN, *Canned cycle for drilling*. Each is expanded into the moves that
//! the control makes.

use crate::gcode::codes::{MotionMode, SpindleTurning};
use crate::gcode::modes::CycleWords;
use crate::gcode::run::interpreter::Reader;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::expression::Variables;
use crate::model::event::{EventKind, Spindle};
use crate::model::read_options::Controller;
use crate::text::error::NcProblem;

/// How far from the last depth G83 returns in rapid, and how far G73 retracts, in mm: LinuxCNC's 0.010 inch. Fanuc and Haas keep it in a
/// setting; it concerns moves where the tool has been before.
const PECK_CLEARANCE: f64 = 0.254;
/// Pecks of one hole, at most.
const MOST_PECKS: f64 = 1e5;
/// Repeats of one block, at most.
const MOST_REPEATS: f64 = 1e6;

/// One hole, in the program's coordinates along the axis of the tool.
#[derive(Clone, Copy)]
struct Hole {
    /// The place in the plane, with any coordinate along the axis.
    place: [f64; 3],
    plane: f64,
    bottom: f64,
    clear: f64,
}

impl Reader {
    /// A cycle begins: nothing of the one before stays, but the height it started from.
    pub(crate) fn begin_cycle(&mut self) {
        let initial = match self.modes.motion {
            Some(MotionMode::Cycle(_)) => self.modes.cycle.initial,
            _ => None,
        };
        self.modes.cycle = CycleWords {
            initial,
            ..CycleWords::default()
        };
    }

    /// A block in a cycle.
    pub(crate) fn cycle(&mut self, cycle: u8, block: &Block) -> Result<(), NcProblem> {
        let name = format!("G{cycle}");
        let haas = self.controller == Some(Controller::Haas);
        // Haas's G77 is Fanuc's G87; its G87 leaves the retraction to the operator, as G88 does.
        let cycle = match cycle {
            77 if haas => 87,
            87 if haas => 88,
            cycle => cycle,
        };
        self.refuse_compensation("a drilling cycle")?;
        for (angle, letter) in self.track.abc.into_iter().zip(['A', 'B', 'C']) {
            if block.get(letter).is_some_and(|value| value != angle) {
                return Err(NcProblem::syntax(format!(
                    "{letter} in a drilling cycle: expected G80 before it"
                )));
            }
        }
        let linuxcnc = self.controller == Some(Controller::LinuxCnc);
        if cycle == 77 || linuxcnc && matches!(cycle, 76 | 87) {
            let what = match cycle {
                76 => "threading cycles of lathes are",
                77 => "cycles of lathes are",
                _ => "back boring is, which this control has not:",
            };
            return Err(NcProblem::unsupported(
                format!("{name}: {what}"),
                "expected G73, G74 or G81 to G89, or the moves written out",
            ));
        }
        let [u, v, w] = self.modes.plane;
        let words = self.polar(self.lengths(block, ['X', 'Y', 'Z']))?;
        let unit = self.unit();
        let length = |letter| block.get(letter).map(|value| value * unit);
        let letter = ['X', 'Y', 'Z'][w];
        let sticky = &mut self.modes.cycle;
        sticky.plane = length('R').or(sticky.plane);
        sticky.bottom = words[w].or(sticky.bottom);
        sticky.peck = length('Q').or(sticky.peck);
        sticky.dwell = block.get('P').or(sticky.dwell);
        if block.has('I') || block.has('J') {
            sticky.shift = Some([length('I').unwrap_or(0.0), length('J').unwrap_or(0.0)]);
        }
        let sticky = *sticky;
        let (Some(plane), Some(bottom)) = (sticky.plane, sticky.bottom) else {
            let missing = if sticky.plane.is_none() { 'R' } else { letter };
            return Err(NcProblem::syntax(format!(
                "{name} without {missing}: expected R, the plane to drill from, and {letter}, the bottom"
            )));
        };
        let repeats = block.get('L').or(block.get('K')).unwrap_or(1.0);
        if repeats.fract() != 0.0 || !(0.0..=MOST_REPEATS).contains(&repeats) {
            return Err(NcProblem::value(
                "the number of repeats",
                repeats,
                "a whole number from 0 on",
            ));
        }
        if repeats == 0.0 {
            // Only the words are kept.
            return Ok(());
        }
        let Some(mut at) = self.cycle_start(words, plane)? else {
            return Ok(());
        };
        let absolute = self.modes.absolute;
        let initial = *self.modes.cycle.initial.get_or_insert(at[w]);
        let plane = if absolute { plane } else { at[w] + plane };
        let bottom = if absolute { bottom } else { plane + bottom };
        if cycle == 87 {
            return self.back_bore(at, words, [plane, bottom], &sticky, repeats as u32);
        }
        if bottom > plane {
            return Err(NcProblem::value(
                format!("the plane R of {name}"),
                plane / unit,
                format!("above the bottom, {} in {letter}", bottom / unit),
            ));
        }
        let clear = if self.modes.retract_to_plane {
            plane
        } else {
            initial.max(plane)
        };
        if at[w] < plane {
            at[w] = plane;
            self.straight(at, true)?;
        }
        for repeat in 0..repeats as u32 {
            for k in [u, v] {
                match words[k] {
                    Some(word) if !absolute => at[k] += word,
                    Some(word) if repeat == 0 => at[k] = word,
                    _ => {}
                }
            }
            self.straight(at, true)?;
            if at[w] != plane {
                at[w] = plane;
                self.straight(at, true)?;
            }
            let hole = Hole {
                place: at,
                plane,
                bottom,
                clear,
            };
            self.hole(cycle, hole, &sticky)?;
            at[w] = clear;
        }
        Ok(())
    }

    /// Where the tool is when the cycle begins; `None` if a problem before has made that unknown.
    fn cycle_start(&mut self, words: [Option<f64>; 3], plane: f64) -> Result<Option<[f64; 3]>, NcProblem> {
        if let Some(at) = self.track.known() {
            return Ok(Some(at));
        }
        let [u, v, w] = self.modes.plane;
        if self.uncertain {
            for k in [u, v] {
                self.track.xyz[k] = words[k].filter(|_| self.modes.absolute);
            }
            return Ok(None);
        }
        for k in 0..3 {
            self.offsets.know(k)?;
        }
        let axis = |k: usize| ['X', 'Y', 'Z'][k];
        for k in [u, v] {
            if self.track.xyz[k].is_none() {
                let known = words[k].filter(|_| self.modes.absolute);
                if known.is_none() {
                    self.track.note(format!("{} is not known here: taken as 0", axis(k)));
                }
                self.track.xyz[k] = Some(known.unwrap_or(0.0));
            }
        }
        if self.track.xyz[w].is_none() {
            self.track.note(format!(
                "{} is not known before this cycle: taken as that of its plane R",
                axis(w)
            ));
            self.track.xyz[w] = Some(if self.modes.absolute { plane } else { 0.0 });
        }
        Ok(self.track.known())
    }

    /// Back boring: down to R beside the axis of the hole, across, up to Z, and out again.
    ///
    /// Sources: Fanuc B-63944EN, *Back boring cycle (G87)*, and *Shift specification by I_J_* (Series 15i, bit SIJ); Haas 96-8000, G77; Weihong's G87 has the same order.
    fn back_bore(
        &mut self,
        mut at: [f64; 3],
        words: [Option<f64>; 3],
        [deep, top]: [f64; 2],
        sticky: &CycleWords,
        repeats: u32,
    ) -> Result<(), NcProblem> {
        let [u, v, w] = self.modes.plane;
        let Some(shift) = sticky.shift else {
            return Err(NcProblem::unsupported(
                "back boring with a shift by Q is",
                "its direction is a setting of the machine; expected the shift by I and J",
            ));
        };
        let unit = self.unit();
        if top < deep {
            return Err(NcProblem::value(
                "the plane R of a back boring",
                deep / unit,
                format!("below Z, {}", top / unit),
            ));
        }
        let initial = at[w];
        for repeat in 0..repeats {
            for k in [u, v] {
                match words[k] {
                    Some(word) if !self.modes.absolute => at[k] += word,
                    Some(word) if repeat == 0 => at[k] = word,
                    _ => {}
                }
            }
            let place = |height: f64, aside: bool| {
                let mut point = at;
                point[w] = height;
                if aside {
                    point[u] += shift[0];
                    point[v] += shift[1];
                }
                point
            };
            self.straight(place(initial, false), true)?;
            self.turn_spindle(SpindleTurning::Stopped)?;
            self.straight(place(initial, true), false)?;
            self.straight(place(deep, true), true)?;
            self.straight(place(deep, false), false)?;
            self.turn_spindle(SpindleTurning::Clockwise)?;
            self.straight(place(top, false), false)?;
            self.rest_for(sticky.dwell.unwrap_or(0.0))?;
            self.turn_spindle(SpindleTurning::Stopped)?;
            self.straight(place(top, true), false)?;
            self.straight(place(initial, true), true)?;
            self.straight(place(initial, false), false)?;
            self.turn_spindle(self.modes.spindle)?;
        }
        Ok(())
    }

    fn straight(&mut self, end: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        let stroke = self.stroke_to(end, self.track.abc, rapid);
        self.give(stroke)
    }

    /// One hole, from the plane R.
    fn hole(&mut self, cycle: u8, hole: Hole, words: &CycleWords) -> Result<(), NcProblem> {
        let w = self.modes.plane[2];
        let at = |height: f64| {
            let mut point = hole.place;
            point[w] = height;
            point
        };
        let (bottom, clear, plane) = (at(hole.bottom), at(hole.clear), at(hole.plane));
        match cycle {
            73 | 83 => {
                let peck = words.peck.unwrap_or(0.0);
                let Some(peck) = Some(peck.abs()).filter(|peck| *peck > 0.0) else {
                    return Err(NcProblem::syntax(format!(
                        "G{cycle} without Q: expected the depth of a peck"
                    )));
                };
                if (hole.plane - hole.bottom) / peck > MOST_PECKS {
                    return Err(NcProblem::value(
                        "the number of pecks",
                        (hole.plane - hole.bottom) / peck,
                        "at most 100000",
                    ));
                }
                let mut depth = hole.plane - peck;
                while depth > hole.bottom {
                    self.straight(at(depth), false)?;
                    if cycle == 83 {
                        self.straight(plane, true)?;
                    }
                    self.straight(at((depth + PECK_CLEARANCE).min(hole.plane)), true)?;
                    depth -= peck;
                }
                self.straight(bottom, false)?;
                self.straight(clear, true)
            }
            74 | 84 => {
                self.straight(bottom, false)?;
                let turning = self.modes.spindle;
                self.turn_spindle(SpindleTurning::Stopped)?;
                self.turn_spindle(match turning {
                    SpindleTurning::CounterClockwise => SpindleTurning::Clockwise,
                    _ => SpindleTurning::CounterClockwise,
                })?;
                self.rest_for(words.dwell.unwrap_or(0.0))?;
                self.straight(plane, false)?;
                self.turn_spindle(SpindleTurning::Stopped)?;
                self.turn_spindle(turning)?;
                if hole.clear == hole.plane {
                    Ok(())
                } else {
                    self.straight(clear, true)
                }
            }
            85 | 89 => {
                self.straight(bottom, false)?;
                if cycle == 89 {
                    self.rest_for(words.dwell.unwrap_or(0.0))?;
                }
                if self.fanuc() && hole.clear != hole.plane {
                    self.straight(plane, false)?;
                    return self.straight(clear, true);
                }
                self.straight(clear, false)
            }
            76 => {
                self.straight(bottom, false)?;
                self.rest_for(words.dwell.unwrap_or(0.0))?;
                self.turn_spindle(SpindleTurning::Stopped)?;
                let [u, v, _] = self.modes.plane;
                let shift = words.shift.unwrap_or_default();
                if words.shift.is_none() && words.peck.is_some() {
                    self.track
                        .note("the direction of G76's shift Q is a setting of the machine: read as no shift");
                }
                let aside = |mut point: [f64; 3]| {
                    point[u] += shift[0];
                    point[v] += shift[1];
                    point
                };
                if shift != [0.0; 2] {
                    self.straight(aside(bottom), false)?;
                }
                self.straight(aside(clear), true)?;
                if shift != [0.0; 2] {
                    self.straight(clear, true)?;
                }
                self.turn_spindle(self.modes.spindle)
            }
            _ => {
                self.straight(bottom, false)?;
                if matches!(cycle, 82 | 86 | 88) {
                    self.rest_for(words.dwell.unwrap_or(0.0))?;
                }
                if matches!(cycle, 86 | 88) {
                    self.turn_spindle(SpindleTurning::Stopped)?;
                }
                if cycle == 88 {
                    self.track.event(EventKind::Stop)?;
                }
                self.straight(clear, true)?;
                if matches!(cycle, 86 | 88) {
                    self.turn_spindle(self.modes.spindle)?;
                }
                Ok(())
            }
        }
    }

    /// P of cycles: seconds, but milliseconds on Fanuc and Haas.
    fn rest_for(&mut self, p: f64) -> Result<(), NcProblem> {
        self.rest(if self.fanuc() { p / 1000.0 } else { p })
    }

    pub(crate) fn turn_spindle(&mut self, turning: SpindleTurning) -> Result<(), NcProblem> {
        let rpm = self.modes.speed;
        self.track.event(EventKind::Spindle(match turning {
            SpindleTurning::Stopped => Spindle::Stopped,
            SpindleTurning::Clockwise => Spindle::Clockwise { rpm },
            SpindleTurning::CounterClockwise => Spindle::CounterClockwise { rpm },
        }))
    }
}
