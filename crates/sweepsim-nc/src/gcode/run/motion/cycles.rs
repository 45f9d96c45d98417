//! Drilling cycles: G73, G74, G76 and G81 to G89.
//!
//! Sources: *LinuxCNC G-code reference, Canned Cycles*; Fanuc B-63944EN, *Canned cycle for drilling*.

use crate::drive::{HoleCycle, HolePlace, HoleWork, Pecks, WayOut};
use crate::gcode::codes::{MotionMode, SpindleTurning};
use crate::gcode::modes::{CycleWords, Level};
use crate::gcode::run::interpreter::Reader;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::expression::Variables;
use crate::model::event::{EventKind, Spindle};
use crate::model::read_options::Controller;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

/// How far from the last depth G83 returns in rapid, and how far G73 retracts, in mm: LinuxCNC's 0.010 inch. Fanuc and Haas keep it in a
/// setting; it concerns moves where the tool has been before.
const PECK_CLEARANCE: f64 = 0.254;
/// Repeats of one block, at most.
const MOST_REPEATS: u32 = 1_000_000;

impl Reader {
    /// A cycle begins. Of the one before, the height it started from stays; on Fanuc, all of its words do until the cycles end.
    pub(crate) fn begin_cycle(&mut self) {
        let before = match self.modes.motion {
            Some(MotionMode::Cycle(_)) => self.modes.cycle,
            _ => CycleWords::default(),
        };
        self.modes.cycle = match self.rules.controller {
            Some(Controller::Fanuc) => before,
            _ => CycleWords {
                initial: before.initial,
                ..CycleWords::default()
            },
        };
    }

    /// A block in a cycle.
    pub(crate) fn cycle(&mut self, cycle: u8, block: &Block) -> Result<(), NcProblem> {
        let name = format!("G{cycle}");
        let haas = self.rules.controller == Some(Controller::Haas);
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
        let linuxcnc = self.rules.controller == Some(Controller::LinuxCnc);
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
        let absolute = self.modes.absolute;
        let level = |value| Level {
            value,
            incremental: !absolute,
        };
        let dwell = self.dwell_word(block);
        let sticky = &mut self.modes.cycle;
        sticky.plane = length('R').map(level).or(sticky.plane);
        sticky.bottom = words[w].map(level).or(sticky.bottom);
        sticky.peck = length('Q').or(sticky.peck);
        sticky.dwell = dwell.or(sticky.dwell);
        if block.has('I') || block.has('J') {
            sticky.shift = Some([length('I').unwrap_or(0.0), length('J').unwrap_or(0.0)]);
        }
        let sticky = *sticky;
        let assumes_plane = sticky.plane.is_none() && self.starts_in_rapid() && !self.seen.uncertain;
        let height = self.track.xyz[w].filter(|_| assumes_plane);
        if height.is_some() {
            let what = format!("the plane R of {name}");
            let taken = "where the tool is: the cycle does not say it";
            self.track
                .assume(Assumption::new(what, taken, format!("R with {name}")));
        }
        let plane = sticky.plane.or(height.map(|value| Level {
            value,
            incremental: false,
        }));
        let (Some(plane), Some(bottom)) = (plane, sticky.bottom) else {
            let missing = if plane.is_none() { 'R' } else { letter };
            return Err(NcProblem::syntax(format!(
                "{name} without {missing}: expected R, the plane to drill from, and {letter}, the bottom"
            )));
        };
        let repeats = block.get('L').or(block.get('K')).unwrap_or(1.0);
        let repeats = NcProblem::whole(
            "the number of repeats",
            repeats,
            0..=MOST_REPEATS,
            "a whole number from 0 on",
        )?;
        if repeats == 0 {
            // Only the words are kept.
            return Ok(());
        }
        let Some(mut at) = self.cycle_start(words, plane)? else {
            return Ok(());
        };
        let initial = *self.modes.cycle.initial.get_or_insert(at[w]);
        let [plane, bottom] = self.cycle_levels(&name, [plane, bottom], [initial, at[w]])?;
        let back = cycle == 87;
        let hole = if back {
            self.back_boring([at[w], plane, bottom], &sticky)?
        } else if bottom <= plane {
            let clear = match (self.modes.retract_to_plane, self.modes.return_level) {
                (true, _) => plane,
                (false, None) if self.fanuc() => initial,
                (false, level) => level.unwrap_or(initial).max(plane),
            };
            self.hole(cycle, [plane, bottom, clear], &sticky)?
        } else {
            return Err(NcProblem::value(
                format!("the plane R of {name}"),
                plane / unit,
                format!("above the bottom, {} in {letter}", bottom / unit),
            ));
        };
        // Fanuc goes across at the height where the tool is, and then to the plane.
        if at[w] < plane && !back && !self.fanuc() {
            if self.rules.controller.is_none() {
                let what = format!("how {name} begins below its plane R");
                let taken = "up to the plane, then across, as LinuxCNC does: Fanuc goes across first";
                self.left_to_control(what, taken, "--controller")?;
            }
            at[w] = plane;
            self.give(self.stroke_to(at, self.track.abc, true))?;
        }
        for repeat in 0..repeats {
            for k in [u, v] {
                match words[k] {
                    Some(word) if !absolute => at[k] += word,
                    Some(word) if repeat == 0 => at[k] = word,
                    _ => {}
                }
            }
            self.give(self.stroke_to(at, self.track.abc, true))?;
            if back {
                self.turn_spindle(SpindleTurning::Stopped)?;
            }
            self.track.hole(&hole, HolePlace::in_plane(self.modes.plane, at))?;
            if matches!(cycle, 76 | 86..=88) {
                self.turn_spindle(self.modes.spindle)?;
            }
            at[w] = hole.end;
        }
        Ok(())
    }

    /// The plane R and the bottom. Heights are relative if the block that gave them was, and to where the cycles began
    /// (Fanuc, Haas); on LinuxCNC the block that drills decides, and they are relative to where the tool is.
    fn cycle_levels(&mut self, name: &str, levels: [Level; 2], [initial, at]: [f64; 2]) -> Result<[f64; 2], NcProblem> {
        let absolute = self.modes.absolute;
        let [plane, bottom] = levels;
        let kept = plane.from(initial);
        let kept = [kept, bottom.from(kept)];
        let [plane, bottom] = levels.map(|level| Level {
            incremental: !absolute,
            ..level
        });
        let read_anew = plane.from(at);
        let read_anew = [read_anew, bottom.from(read_anew)];
        match self.rules.controller {
            Some(Controller::LinuxCnc) => Ok(read_anew),
            None if kept != read_anew => {
                let what = format!("the heights R and Z of {name} in or after G91");
                let taken =
                    "as Fanuc reads them: each is relative only if its own block is, and R to where the cycles began";
                self.left_to_control(what, taken, "--controller")?;
                Ok(kept)
            }
            _ => Ok(kept),
        }
    }

    /// Where the tool is when the cycle begins; `None` if a problem before has made that unknown.
    fn cycle_start(&mut self, words: [Option<f64>; 3], plane: Level) -> Result<Option<[f64; 3]>, NcProblem> {
        if let Some(at) = self.track.known() {
            return Ok(Some(at));
        }
        let [u, v, w] = self.modes.plane;
        if self.seen.uncertain {
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
            self.track.xyz[w] = Some(if plane.incremental { 0.0 } else { plane.value });
        }
        Ok(self.track.known())
    }

    /// Back boring: down to R beside the axis of the hole, across, up to Z, and out again.
    ///
    /// Sources: Fanuc B-63944EN, *Back boring cycle (G87)*, and *Shift specification by I_J_* (Series 15i, bit SIJ); Haas 96-8000, G77; Weihong's G87 has the same order.
    fn back_boring(&self, [initial, deep, up]: [f64; 3], words: &CycleWords) -> Result<HoleCycle, NcProblem> {
        let Some(aside) = words.shift else {
            return Err(NcProblem::unsupported(
                "back boring with a shift by Q is",
                "its direction is a setting of the machine; expected the shift by I and J",
            ));
        };
        if up < deep {
            return Err(NcProblem::value(
                "the plane R of a back boring",
                deep / self.unit(),
                format!("below Z, {}", up / self.unit()),
            ));
        }
        let stop = self.spindle(SpindleTurning::Stopped);
        Ok(HoleCycle {
            start: initial,
            bottom: deep,
            end: initial,
            work: HoleWork::Back {
                up,
                feed: None,
                rapid: true,
            },
            aside,
            at_bottom: vec![Self::dwell_of(words), stop],
            at_return: vec![self.spindle(SpindleTurning::Clockwise)],
            ..HoleCycle::default()
        })
    }

    /// A hole from the plane R.
    fn hole(
        &mut self,
        cycle: u8,
        [plane, bottom, clear]: [f64; 3],
        words: &CycleWords,
    ) -> Result<HoleCycle, NcProblem> {
        let mut hole = HoleCycle {
            start: plane,
            bottom,
            end: clear,
            ..HoleCycle::default()
        };
        let (stop, dwell) = (self.spindle(SpindleTurning::Stopped), Self::dwell_of(words));
        match cycle {
            73 | 83 => {
                let Some(peck) = words.peck.map(f64::abs) else {
                    return Err(NcProblem::syntax(format!(
                        "G{cycle} without Q: expected the depth of a peck"
                    )));
                };
                if !(peck > 0.0) {
                    let what = format!("the depth Q of a peck of G{cycle}");
                    return Err(NcProblem::value(what, peck, "more than 0"));
                }
                hole.work = HoleWork::Pecks(Pecks {
                    first: plane - peck,
                    infeed: peck,
                    clears: cycle == 83,
                    above: PECK_CLEARANCE,
                    ..Pecks::default()
                });
            }
            74 | 84 => {
                let turning = self.modes.spindle;
                let other = match turning {
                    SpindleTurning::CounterClockwise => SpindleTurning::Clockwise,
                    _ => SpindleTurning::CounterClockwise,
                };
                hole.at_bottom = vec![stop.clone(), self.spindle(other), dwell];
                hole.at_return = vec![stop, self.spindle(turning)];
                hole.out = WayOut::FeedToStart(None);
            }
            76 => {
                if words.shift.is_none() && words.peck.is_some() {
                    self.track
                        .note("the direction of G76's shift Q is a setting of the machine: read as no shift");
                }
                hole.aside = words.shift.unwrap_or_default();
                hole.at_bottom = vec![dwell, stop];
            }
            82 => hole.at_bottom = vec![dwell],
            85 | 89 => {
                if cycle == 89 {
                    hole.at_bottom = vec![dwell];
                }
                hole.out = match self.fanuc() {
                    true => WayOut::FeedToStart(None),
                    false => WayOut::Feed,
                };
            }
            86 => hole.at_bottom = vec![dwell, stop],
            88 => hole.at_bottom = vec![dwell, stop, EventKind::Stop],
            _ => {}
        }
        Ok(hole)
    }

    fn dwell_of(words: &CycleWords) -> EventKind {
        EventKind::Dwell {
            seconds: words.dwell.unwrap_or(0.0),
        }
    }

    fn spindle(&self, turning: SpindleTurning) -> EventKind {
        let rpm = self.modes.speed;
        EventKind::Spindle(match turning {
            SpindleTurning::Stopped => Spindle::Stopped,
            SpindleTurning::Clockwise => Spindle::Clockwise { rpm },
            SpindleTurning::CounterClockwise => Spindle::CounterClockwise { rpm },
        })
    }

    pub(crate) fn turn_spindle(&mut self, turning: SpindleTurning) -> Result<(), NcProblem> {
        self.track.event(self.spindle(turning))
    }
}
