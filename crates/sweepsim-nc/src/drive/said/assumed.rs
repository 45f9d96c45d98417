//! What is assumed while a program is read: moves in offsets that only the machine knows, coordinates, registers.

use sweepsim_motion::Move;

use crate::drive::track::Track;
use crate::drive::unknowns::{Elsewhere, Frame, LeftOut, WorkOffsets};
use crate::machines::Position;
use crate::model::poses::ProgramPoses;
use crate::model::positions::ProgramPositions;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

impl Track {
    /// Before a move in the active work offset: it must be known relative to those before, or the move is left out.
    pub fn use_offset(&mut self, offsets: &mut WorkOffsets) -> Result<(), NcProblem> {
        let frame = offsets.active_frame();
        let before = *self.used.get_or_insert(frame);
        let agree = match (before, frame) {
            (Frame::Part(None), Frame::Part(Some(_))) => {
                self.used = Some(frame);
                true
            }
            (Frame::Part(_), Frame::Part(None)) => true,
            (before, frame) => before == frame,
        };
        if agree {
            self.return_from_elsewhere();
            return Ok(());
        }
        if self.strict {
            return Err(NcProblem::unsupported(
                format!("{} after {} is", offsets.describe(frame), offsets.describe(before)),
                "only the machine knows the distance between them; expected one work offset, or G10 L2 for each before its first move",
            ));
        }
        let before = match before {
            Frame::Part(Some(number)) => Some((offsets.name)(number)),
            _ => None,
        };
        self.go_elsewhere((offsets.name)(offsets.active), frame, before);
        Ok(())
    }

    /// The start of a feed move, if the path does not lead there.
    pub fn begin(&mut self, rapid: bool) -> Result<(), NcProblem> {
        self.set_out()?;
        if !rapid {
            self.cut_here();
        }
        if rapid || self.joined || self.of_poses {
            return Ok(());
        }
        match self.known() {
            Some(xyz) => self.push(Position::new(self.frame().point(xyz), self.abc), Move::default(), true),
            None => {
                self.note("the start of this feed move is unknown: the path begins at its end");
                Ok(())
            }
        }
    }

    /// Before a feed move: the part is where something is cut first. Rapids before in another offset that only the machine knows are left out.
    fn cut_here(&mut self) {
        if std::mem::replace(&mut self.has_fed, true) {
            return;
        }
        let Some(Elsewhere {
            name,
            frame,
            before: Some(before),
            ..
        }) = self.elsewhere.clone()
        else {
            return;
        };
        self.used = Some(frame);
        self.elsewhere = None;
        self.left_out.remove(&name);
        let first = self.program.poses.in_order().next();
        let first = first.map_or((self.place.file, self.place.line), |pose| (pose.file, pose.line));
        self.left_out.entry(before).or_insert(LeftOut {
            first,
            ..LeftOut::default()
        });
        self.program.poses = ProgramPoses::default();
        self.program.positions = ProgramPositions::default();
        self.program.events.iter_mut().for_each(|event| event.pose = 0);
        self.joined = false;
    }

    fn go_elsewhere(&mut self, name: String, frame: Frame, before: Option<String>) {
        if self.elsewhere.as_ref().is_some_and(|elsewhere| elsewhere.name == name) {
            return;
        }
        let kept = self.kept_position();
        let place = (self.place.file, self.place.line);
        let left = LeftOut {
            first: place,
            ..LeftOut::default()
        };
        self.left_out.entry(name.clone()).or_insert(left);
        self.doubt();
        self.elsewhere = Some(Elsewhere {
            name,
            frame,
            before,
            kept,
        });
        self.xyz = [None; 3];
        (self.joined, self.places.stands) = (false, false);
    }

    /// Where the tool is in the frame of the moves, as far as that is known.
    fn kept_position(&self) -> [Option<f64>; 3] {
        match &self.elsewhere {
            Some(elsewhere) => std::array::from_fn(|k| elsewhere.kept[k].filter(|_| self.xyz[k].is_none())),
            None => self.frame().partial(self.xyz),
        }
    }

    fn return_from_elsewhere(&mut self) {
        if self.elsewhere.is_none() {
            return;
        }
        let kept = self.kept_position();
        self.elsewhere = None;
        self.xyz = self
            .frame()
            .inverse()
            .map_or([None; 3], |inverse| inverse.partial(kept));
        self.lost = self.xyz.map(|x| x.is_none());
    }

    /// Counts a move that is left out, if the moves are elsewhere now.
    pub(in crate::drive) fn leaves_out(&mut self, rapid: bool) -> bool {
        let Some(elsewhere) = &self.elsewhere else { return false };
        let place = (self.place.file, self.place.line);
        let left = self.left_out.get_mut(&elsewhere.name);
        if let Some(left) = left.filter(|left| !rapid && left.last != place) {
            left.last = place;
            left.feeds += 1;
        }
        self.joined = false;
        true
    }

    /// What is assumed of offsets that only the machine knows.
    pub(in crate::drive) fn assume_offsets(&mut self) {
        for (name, left) in std::mem::take(&mut self.left_out) {
            let key = name.replace(' ', "");
            let what = format!("the place of {name}");
            let settle = format!(
                "--offset {key}=X,Y,Z, from the zero of the first work offset (in a job: offsets: {{\"{key}\": (X, Y, Z)}})"
            );
            let (taken, harmless) = match left.feeds {
                0 => ("not known; its rapids are left out".to_owned(), true),
                feeds => (
                    format!(
                        "not known: what it cuts is a set-up of its own; its blocks with {feeds} feed moves are left out"
                    ),
                    false,
                ),
            };
            let assumption = Assumption::new(what, taken, settle);
            let assumption = if harmless { assumption.harmless() } else { assumption };
            self.assumptions.add(left.first, assumption);
        }
    }

    /// Takes coordinates that a move needs, and nothing has given yet, as 0. Whether all are known then: not where the program gave them, and a move that
    /// only the machine knows has lost them; the move has to be left out.
    pub fn complete(&mut self, needed: impl Fn(usize) -> bool) -> bool {
        let missing = [0, 1, 2].map(|k| self.xyz[k].is_none() && needed(k));
        let elsewhere = self.elsewhere.is_some();
        if let Some(k) = (0..3).find(|&k| missing[k] && self.lost[k] && !elsewhere && self.has_moved()) {
            let axis = ['X', 'Y', 'Z'][k];
            self.assume(Assumption::new(
                format!("{axis} after a move that only the machine knows"),
                "feed moves are left out until the program gives it",
                "the work offset in machine coordinates, by G10 L2 or the control's variables",
            ));
            return false;
        }
        for k in (0..3).filter(|&k| missing[k]) {
            if !elsewhere {
                self.note(format!("{} is not known here: taken as 0", ['X', 'Y', 'Z'][k]));
            }
            self.xyz[k] = Some(0.0);
        }
        true
    }

    /// Whether what a program leaves to the control is an error.
    pub fn strict(&self) -> bool {
        self.strict
    }

    /// Whether anything was assumed about blocks so far.
    pub fn assumes(&self) -> bool {
        !self.assumptions.is_empty()
    }

    /// An assumption about the block that is read.
    pub fn assume(&mut self, assumption: Assumption) {
        self.doubt();
        self.assumptions.add((self.place.file, self.place.line), assumption);
    }
}
