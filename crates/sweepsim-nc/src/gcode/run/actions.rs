//! Codes that set coordinates instead of moving to them.

use super::interpreter::Reader;
use crate::drive::{Placed, WorkOffset};
use crate::gcode::codes::{Code, MotionMode};
use crate::gcode::offsets::{EXTENDED, known};
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::expression::Variables;
use crate::machines::WorkFrame;
use crate::model::read_options::Controller;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

/// Whether a block has a rotary word other than 0.
fn turns(block: &Block) -> bool {
    ['A', 'B', 'C']
        .into_iter()
        .any(|letter| block.get(letter).is_some_and(|value| value != 0.0))
}

impl Reader {
    /// Words in millimetres, as written.
    pub(crate) fn lengths(&self, block: &Block, letters: [char; 3]) -> [Option<f64>; 3] {
        letters.map(|letter| block.get(letter).map(|value| value * self.unit()))
    }

    pub(crate) fn act(&mut self, code: Code, block: &Block) -> Result<(), NcProblem> {
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let here_unknown = (0..3).any(|k| words[k].is_some() && self.track.xyz[k].is_none());
        match code {
            // An earlier problem has made the position unknown; see `Reader::go_on`.
            Code::SetOffsets | Code::ShiftHere if self.seen.uncertain && here_unknown => {}
            Code::RestoreShift if self.seen.uncertain => {}
            Code::Ignored(note) => self.track.note(note),
            Code::UnknownCycle(name) => self.track.leave_out_cycle(name)?,
            Code::Length(code) => self.set_length(code, block)?,
            Code::EndCurve => self.end_curve()?,
            Code::CircularPocket { counter_clockwise } => self.circular_pocket(counter_clockwise, block)?,
            Code::Stretch(code) => self.stretch(code, block)?,
            Code::WorkOffset(index) => self.select(index)?,
            Code::WorkOffsetByWord => match block.get('P') {
                Some(p) => {
                    let p = NcProblem::whole("P of a work offset", p, 1..=999, "a whole number from 1 on")?;
                    self.select(EXTENDED + p)?;
                }
                // G54.1 is G54 on some controls.
                None => self.select(0)?,
            },
            Code::Home { second } => self.home(usize::from(second), block)?,
            Code::SetHome { second } => {
                if let [Some(x), Some(y), Some(z)] = self.machine_position() {
                    self.offsets.homes[usize::from(second)] = Some([x, y, z]);
                }
            }
            Code::SetOffsets => self.set_offsets(block, words)?,
            Code::ReturnLevel => self.modes.return_level = words[2],
            Code::Probe if words.iter().all(Option::is_none) => {
                return Err(NcProblem::syntax("probing without an axis: expected X, Y or Z"));
            }
            Code::Probe => self.probe(words.map(|word| word.is_some())),
            Code::LocalShift => {
                if turns(block) {
                    return Err(NcProblem::unsupported("work offsets that turn are", "expected X, Y, Z"));
                }
                self.reframe(|reader| {
                    if reader.rules.controller == Some(Controller::LinuxCnc) {
                        let shift = reader.offsets.shift;
                        let shift = std::array::from_fn(|k| words[k].unwrap_or(shift[k]));
                        reader.offsets.set_shift(shift);
                    } else {
                        for k in 0..3 {
                            reader.offsets.local[k] = words[k].unwrap_or(reader.offsets.local[k]);
                        }
                    }
                })?;
                self.trace_offsets();
            }
            Code::ShiftHere => {
                self.check_angles(block, "G92")?;
                self.refuse_compensation("G92")?;
                if self.modes.local_map() != WorkFrame::default() {
                    return Err(NcProblem::unsupported(
                        "G92 in scaled or turned coordinates is",
                        "expected G50, G69 or G50.1 before it",
                    ));
                }
                let fresh = !self.track.has_moved();
                self.track.is_placed();
                let before = self.track.xyz;
                self.offsets.shift_here(words, &mut self.track.xyz, fresh)?;
                self.update_frame();
                if (0..3).any(|k| before[k].is_none() && self.track.xyz[k].is_some()) {
                    self.track
                        .note("G92 before the first move: the tool is taken to be there, in the part's frame");
                }
                self.trace_offsets();
            }
            Code::CancelShift { forget } => {
                if let Some(word) = block.first("XYZABC").filter(|word| !forget || word.value != 0.0) {
                    return Err(NcProblem::syntax(format!(
                        "{} next to a code that ends a G92: expected none{}",
                        word.name(),
                        if forget { ", or 0" } else { "" }
                    )));
                }
                // Fanuc names the axes: G92.1 X0.
                let any = block.first("XYZABC").is_some();
                let axes = words.map(|word| !any || word.is_some());
                let fresh = !self.track.has_moved();
                let mut unknown = [false; 3];
                self.reframe(|reader| unknown = reader.offsets.cancel_shift(forget, axes, fresh))?;
                for k in (0..3).filter(|&k| unknown[k]) {
                    self.track.xyz[k] = None;
                }
                self.trace_offsets();
            }
            Code::RestoreShift => {
                if let Some(word) = block.first("XYZABC") {
                    return Err(NcProblem::syntax(format!(
                        "{} next to G92.3: expected none",
                        word.letter
                    )));
                }
                let mut restored = Ok(());
                self.reframe(|reader| restored = reader.offsets.restore_shift())?;
                restored?;
                self.trace_offsets();
            }
            code => self.transform(code, block)?,
        }
        Ok(())
    }

    /// Probing goes to where the part is: nothing is cut, and where it ends only the machine knows.
    fn probe(&mut self, axes: [bool; 3]) {
        let taken = "left out; where the tool is then is known again from the next move that gives its axes";
        self.track
            .assume(Assumption::new("what a probe finds", taken, "a program without probing").harmless());
        self.track.leave(axes);
    }

    pub(super) fn select(&mut self, index: WorkOffset) -> Result<(), NcProblem> {
        if index != self.offsets.work.active {
            self.refuse_compensation("a change of the work offset")?;
        }
        self.reframe(|reader| reader.offsets.work.active = index)?;
        self.trace_offsets();
        Ok(())
    }

    /// G10.
    fn set_offsets(&mut self, block: &Block, words: [Option<f64>; 3]) -> Result<(), NcProblem> {
        let p = block.get('P').unwrap_or(0.0);
        let fanuc = self.fanuc();
        let l = block.get('L').unwrap_or(0.0);
        let l = NcProblem::whole("L of G10", l, 0..=99, "a whole number from 0 to 99")?;
        match l {
            2 | 20 => {
                let most = if fanuc { 300 } else { 9 };
                let p = NcProblem::whole("P of G10", p, 0..=most, "a whole number from 0 to 9")?;
                if l == 20 && !fanuc {
                    self.check_angles(block, "G10 L20")?;
                    return self.place_here(p, words);
                }
                if turns(block) || fanuc && block.has('R') {
                    return Err(NcProblem::unsupported("work offsets that turn are", "expected X, Y, Z"));
                }
                let turn = block.get('R');
                self.reframe(|reader| {
                    let added = |old: f64, word: Option<f64>| match word {
                        Some(word) if fanuc && !reader.modes.absolute => old + word,
                        Some(word) => word,
                        None => old,
                    };
                    if fanuc && l == 2 && p == 0 {
                        let external = reader.offsets.external;
                        reader.offsets.external = std::array::from_fn(|k| added(external[k], words[k]));
                        return;
                    }
                    let index = match (p, l) {
                        (p, 20) => EXTENDED + p,
                        (0, _) => reader.offsets.work.active,
                        (p, _) => p - 1,
                    };
                    let before = reader.offsets.work.placed(index).unwrap_or_default();
                    let placed = Placed {
                        origin: std::array::from_fn(|k| added(before.origin[k], words[k])),
                        turn: turn.unwrap_or(before.turn),
                    };
                    reader.offsets.work.place(index, placed);
                })?;
                self.trace_offsets();
                Ok(())
            }
            1 | 10..=13 => self.set_tool(l, block),
            _ => {
                self.track
                    .note(format!("G10 L{l} sets the control's own data: ignored"));
                Ok(())
            }
        }
    }

    /// G10 L20: gives the current position the given coordinates in a work offset.
    fn place_here(&mut self, p: u32, words: [Option<f64>; 3]) -> Result<(), NcProblem> {
        let index = if p == 0 { self.offsets.work.active } else { p - 1 };
        let mut placed = self.offsets.work.placed(index).unwrap_or_default();
        let local = self.modes.local_map();
        if local != WorkFrame::default() {
            return Err(NcProblem::unsupported(
                "G10 L20 in scaled or turned coordinates is",
                "expected G50, G69 or G50.1 before it",
            ));
        }
        let here = self.frame_map().partial(self.track.xyz);
        let shift: [f64; 3] = std::array::from_fn(|k| self.offsets.shift[k] + self.offsets.local[k]);
        if placed.turn == 0.0 {
            for k in 0..3 {
                if let Some(word) = words[k] {
                    self.offsets.know(k)?;
                    placed.origin[k] = known(here[k])? - word - shift[k] - self.offsets.external[k];
                }
            }
        } else {
            // The coordinates that are not given stay as they are in that offset.
            let turn = WorkFrame::turned(2, placed.turn);
            let there = WorkFrame::shifted(placed.origin)
                .then(&turn)
                .then(&WorkFrame::shifted(shift));
            let now = there.inverse().unwrap_or_default().partial(here);
            let mut wanted = [0.0; 3];
            for k in 0..3 {
                wanted[k] = match words[k] {
                    Some(word) => word,
                    None => known(now[k])?,
                };
            }
            let from = turn.point(std::array::from_fn(|k| wanted[k] + shift[k]));
            for k in 0..3 {
                placed.origin[k] = known(here[k])? - from[k];
            }
        }
        self.reframe(|reader| reader.offsets.work.place(index, placed))?;
        self.trace_offsets();
        Ok(())
    }

    /// Rotary words of a code that sets coordinates: allowed where they change nothing.
    fn check_angles(&self, block: &Block, code: &str) -> Result<(), NcProblem> {
        for (angle, letter) in self.track.abc.into_iter().zip(['A', 'B', 'C']) {
            if block.get(letter).is_some_and(|value| value != angle) {
                return Err(NcProblem::unsupported(
                    format!("{code} with {letter} other than the current {angle} degrees is"),
                    "expected X, Y, Z",
                ));
            }
        }
        Ok(())
    }

    /// G68, G51, G51.1 and their ends.
    fn transform(&mut self, code: Code, block: &Block) -> Result<(), NcProblem> {
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        // Where the tool is stays where it is, if no centre is given.
        let about = |given: WorkFrame, here: WorkFrame| -> [f64; 3] {
            let (given, here) = (given.partial(words), here.partial(self.track.xyz));
            std::array::from_fn(|k| given[k].or(here[k]).unwrap_or(0.0))
        };
        let change: Box<dyn FnOnce(&mut Self)> = match code {
            Code::Rotate => {
                let Some(angle) = block.get('R') else {
                    return Err(NcProblem::syntax("G68 without R: expected the angle"));
                };
                // A centre is scaled and mirrored as other points are (Fanuc B-63944EN, *Coordinate system rotation*).
                let unturned = self.modes.unturned_map();
                let here = self.modes.rotation.as_ref().map(|turn| turn.then(&unturned));
                let centre = about(unturned, here.unwrap_or(unturned));
                let angle = angle + self.turned_before()?;
                let map = WorkFrame::turned(self.modes.plane[2], angle).about(centre);
                Box::new(move |reader| {
                    reader.modes.rotation = Some(map);
                    reader.modes.turned_by = angle;
                })
            }
            Code::CancelRotation => {
                self.set_tilt(None)?;
                Box::new(|reader| {
                    reader.modes.rotation = None;
                    reader.modes.turned_by = 0.0;
                })
            }
            Code::Scale => {
                // Scales may be in thousandths: without a decimal point they are on Fanuc.
                let factor = |letter| {
                    let word = block.word(letter)?;
                    let thousandths = self.fanuc() && word.whole;
                    Some(if thousandths { word.value / 1000.0 } else { word.value })
                };
                let all = factor('P');
                let factors = ['I', 'J', 'K'].map(|letter| factor(letter).or(all).unwrap_or(1.0));
                if factors.contains(&0.0) {
                    return Err(NcProblem::value("the scale of G51", 0, "a number other than 0"));
                }
                let map = WorkFrame::scaled(factors).about(about(WorkFrame::default(), self.modes.unturned_map()));
                Box::new(move |reader| reader.modes.scaling = Some(map))
            }
            Code::CancelScale => Box::new(|reader| reader.modes.scaling = None),
            Code::Mirror => Box::new(move |reader| {
                for k in 0..3 {
                    reader.modes.mirror[k] = words[k].or(reader.modes.mirror[k]);
                }
            }),
            Code::CancelMirror => {
                let all = words.iter().all(Option::is_none);
                Box::new(move |reader| {
                    for k in 0..3 {
                        reader.modes.mirror[k] = reader.modes.mirror[k].filter(|_| !all && words[k].is_none());
                    }
                })
            }
            _ => return Ok(()),
        };
        self.reframe(change)
    }

    /// The angle to which that of a G68 adds. In G91 it adds to the one before on Haas; on Fanuc a parameter decides.
    fn turned_before(&mut self) -> Result<f64, NcProblem> {
        if self.modes.absolute || self.modes.turned_by == 0.0 {
            return Ok(0.0);
        }
        if self.rules.controller == Some(Controller::Haas) {
            return Ok(self.modes.turned_by);
        }
        let what = "whether the angle of a G68 in G91 adds to the one before".to_owned();
        let taken = "it does not, as on Fanuc with bit 0 of parameter 5400 at 0";
        self.left_to_control(what, taken, "G90 with G68")?;
        Ok(0.0)
    }

    /// G28 and G30: over the programmed point to the machine's home.
    fn home(&mut self, which: usize, block: &Block) -> Result<(), NcProblem> {
        self.refuse_compensation("a move to the machine's home")?;
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let any = block.first("XYZABC").is_some();
        let known = (0..3).all(|k| words[k].is_none() || self.modes.absolute || self.track.xyz[k].is_some());
        if (any || self.track.trace.is_some()) && known && !self.seen.uncertain {
            self.track.use_offset(&mut self.offsets.work)?;
            self.go(MotionMode::Rapid, block)?;
        }
        let named = |k: usize| !any || words[k].is_some();
        if self.track.go_home(which == 1, |letter| !any || block.has(letter))? {
            return Ok(());
        }
        for (angle, letter) in self.track.abc.iter_mut().zip(['A', 'B', 'C']) {
            if !any || block.has(letter) {
                *angle = 0.0;
            }
        }
        let assumed = (which == 0 && self.offsets.work.is_placed()).then_some([0.0; 3]);
        if let (Some(home), true, [Some(x), Some(y), Some(z)]) = (
            self.offsets.homes[which].or(assumed),
            self.offsets.knows_machine(),
            self.control_position(),
        ) {
            if self.offsets.homes[which].is_none() {
                self.track.assume(Assumption::new(
                    "the machine's home (G28)",
                    "the zero of its coordinates",
                    "the control's variables from #5161",
                ));
            }
            self.track.use_offset(&mut self.offsets.work)?;
            let now = [x, y, z];
            return self.go_to_control(std::array::from_fn(|k| if named(k) { home[k] } else { now[k] }), true);
        }
        self.track
            .note("moves to the machine's home are left out: the path breaks here");
        self.track.leave([0, 1, 2].map(named));
        Ok(())
    }
}
