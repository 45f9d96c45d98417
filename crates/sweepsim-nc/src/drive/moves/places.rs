//! Moves to places that the machine knows: in its own coordinates, to its homes, and to where tools are changed.
//!
//! The axes go there by rapids of their own, whatever the frame of the program is. A program begins with all axes at home, and a tool where it was changed.

use crate::drive::driver::Coordinates;
use crate::drive::track::Track;
use crate::machines::{Position, WorkFrame};
use crate::text::error::NcProblem;
use sweepsim_motion::Move;

/// A coordinate that is as near as this to a place of the machine is there, in mm.
const SAME: f64 = 1e-9;

/// Places of X, Y, Z in machine coordinates of the spindle's nose, and of A, B, C in degrees.
pub(crate) type Goal = [Option<f64>; 6];

const LETTERS: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

impl Track {
    /// Has a tool in the spindle from now on.
    pub fn take_tool(&mut self, tool: Option<u32>) {
        // Where the machine stands, the tip of another tool is elsewhere.
        let nose = self.nose().filter(|_| self.places.stands);
        self.tool = tool;
        self.driver.change_tool(tool);
        if let Some(nose) = nose {
            self.stand(nose);
        }
    }

    /// The position of the machine's axes at coordinates of its present kind.
    pub(in crate::drive) fn axes_of(&self, at: &Position) -> Option<Position> {
        match self.coordinates {
            Coordinates::Axes => Some(*at),
            Coordinates::Tip => Some(Position::new(self.driver.axes_at(at.xyz, at.abc)?, at.abc)),
        }
    }

    /// The position of the axes, in machine coordinates of the spindle's nose.
    pub(in crate::drive) fn nose(&self) -> Option<Position> {
        let at = Position::new(self.frame.point(self.known()?), self.abc);
        let offset = self.driver.to_machine()?;
        let at = self.axes_of(&at)?;
        Some(Position::new(std::array::from_fn(|k| at.xyz[k] + offset[k]), at.abc))
    }

    /// Which of X, Y and Z are where the machine's own coordinates say.
    pub(in crate::drive) fn fixed_at(&self, at: &Position) -> [bool; 3] {
        let offset = self.driver.to_machine().unwrap_or_default();
        std::array::from_fn(|k| self.places.fixed[k].is_some_and(|fixed| (at.xyz[k] + offset[k] - fixed).abs() < SAME))
    }

    /// Takes the tool to be where the spindle's nose is at this place of the machine.
    pub(in crate::drive) fn stand(&mut self, nose: Position) {
        let Some(offset) = self.driver.to_machine() else {
            return;
        };
        let at = Position::new(std::array::from_fn(|k| nose.xyz[k] - offset[k]), nose.abc);
        self.abc = nose.abc;
        let point = match self.coordinates {
            Coordinates::Axes => Some(at.xyz),
            Coordinates::Tip => self.driver.tip(&at).ok(),
        };
        let xyz = point.and_then(|point| self.frame.inverse_point(point));
        self.xyz = xyz.map_or([None; 3], |xyz| xyz.map(Some));
        (self.places.stands, self.joined) = (xyz.is_some(), false);
        self.lost = [false; 3];
    }

    /// At the start, all axes are at home, if all linear ones have one.
    pub(in crate::drive) fn stand_at_home(&mut self) {
        let Some(machine) = self.driver.kinematics().filter(|_| self.known().is_none()) else {
            return;
        };
        let home = LETTERS.map(|letter| machine.home(letter, false));
        if let [Some(x), Some(y), Some(z), abc @ ..] = home {
            let start = machine.start(0.0).abc;
            let abc = std::array::from_fn(|k| abc[k].unwrap_or(start[k]));
            self.places.fixed = [Some(x), Some(y), Some(z)];
            self.stand(Position::new([x, y, z], abc));
        }
    }

    /// Before the first move, the program says where the tool is: it is not at home.
    pub fn is_placed(&mut self) {
        if std::mem::take(&mut self.places.stands) && !self.has_moved() {
            self.xyz = [None; 3];
        }
    }

    /// The path begins where the tool stands, if it does.
    pub(in crate::drive) fn set_out(&mut self) -> Result<(), NcProblem> {
        if let Some(xyz) = self.known().filter(|_| std::mem::take(&mut self.places.stands)) {
            self.joined = false;
            self.push(Position::new(self.frame.point(xyz), self.abc), Move::default(), true)?;
        }
        Ok(())
    }

    /// Before a move of the program to coordinates in its frame: the axes that it names, or else moves, leave the places of the machine.
    pub(in crate::drive) fn leave_places(&mut self, end: [f64; 3]) -> Result<(), NcProblem> {
        let named = self.places.named.take();
        if self.places.fixed == [None; 3] {
            return Ok(());
        }
        // The path begins there.
        self.set_out()?;
        let moves = |k: usize| match named {
            Some(named) => named[k],
            None => self.xyz[k] != Some(end[k]),
        };
        let moves = [0, 1, 2].map(moves);
        // In a turned frame each axis depends on all coordinates.
        let any = moves.contains(&true) && !self.frame.is_shift();
        for k in (0..3).filter(|&k| moves[k] || any) {
            self.places.fixed[k] = None;
        }
        Ok(())
    }

    /// Goes to places of the machine, along the axes that are named. Whether these are known: else nothing is done.
    pub fn go_to_machine(&mut self, goal: Goal, rapid: bool) -> Result<bool, NcProblem> {
        let knows = self.driver.kinematics().is_some_and(|machine| machine.has_places());
        if !knows || self.elsewhere.is_some() {
            return Ok(false);
        }
        // From where the tool is, if cutter compensation has left it beside its contour.
        if let Some(actual) = self.contour.actual.take() {
            self.xyz = actual.map(Some);
        }
        let Some(nose) = self.nose() else { return Ok(false) };
        self.refuse_contour("a move in machine coordinates")?;
        let to = Position::new(
            std::array::from_fn(|k| goal[k].unwrap_or(nose.xyz[k])),
            std::array::from_fn(|k| goal[3 + k].unwrap_or(nose.abc[k])),
        );
        for k in 0..3 {
            self.places.fixed[k] = goal[k].or(self.places.fixed[k]);
        }
        if self.tool.is_none() && !self.has_moved() {
            // No tool is on its way yet.
            self.stand(to);
            return Ok(true);
        }
        let here = (self.coordinates, self.frame);
        let offset = self.driver.to_machine().unwrap_or_default();
        let at = |nose: [f64; 3]| std::array::from_fn(|k| nose[k] - offset[k]);
        // The axes are moved, whatever the program's coordinates are.
        self.set_out()?;
        (self.coordinates, self.frame) = (Coordinates::Axes, WorkFrame::default());
        self.xyz = at(nose.xyz).map(Some);
        let moved = self.straight(at(to.xyz), to.abc, rapid);
        (self.coordinates, self.frame) = here;
        let joined = self.joined;
        self.stand(to);
        (self.joined, self.places.stands) = (joined, false);
        moved.map(|()| true)
    }

    /// Goes to the homes of the axes that are named, or to their second homes. Whether it knows all of these: else nothing is done.
    pub fn go_home(&mut self, second: bool, named: impl Fn(char) -> bool) -> Result<bool, NcProblem> {
        let Some(machine) = self.driver.kinematics() else {
            return Ok(false);
        };
        let homes = LETTERS.map(|letter| machine.home(letter, second));
        let own: Vec<char> = machine.rotary().map(|axis| axis.letter).collect();
        let there = |letter: &char| "XYZ".contains(*letter) || own.contains(letter);
        let asked = LETTERS.map(|letter| there(&letter) && named(letter));
        if (0..6).any(|k| asked[k] && homes[k].is_none()) {
            return Ok(false);
        }
        self.go_to_machine(std::array::from_fn(|k| homes[k].filter(|_| asked[k])), true)
    }

    /// Where the axes are in machine coordinates, and how far the tip is from the spindle's nose. `None` if that is not known.
    pub fn machine_place(&self) -> Option<([f64; 6], f64)> {
        let machine = self.driver.kinematics().filter(|machine| machine.has_places())?;
        let nose = self.nose()?;
        let ([x, y, z], [a, b, c]) = (nose.xyz, nose.abc);
        Some(([x, y, z, a, b, c], machine.tool_length(self.tool)))
    }

    /// Goes to where tools are changed, and stands there.
    pub fn go_to_change(&mut self) -> Result<(), NcProblem> {
        let Some(machine) = self.driver.kinematics() else {
            return Ok(());
        };
        let steps = machine.description().tool_change.clone();
        if steps.is_empty() {
            if machine.has_places() && self.has_moved() {
                self.note("the way to where tools are changed is not known, and not looked at: `tool_change` of the machine is missing");
            }
            return Ok(());
        }
        let mut nose = self.nose().filter(|_| !self.has_moved());
        for step in steps {
            if let Some(nose) = &mut nose {
                // The first tool has been nowhere else.
                for k in 0..3 {
                    nose.xyz[k] = step.get(&LETTERS[k]).copied().unwrap_or(nose.xyz[k]);
                    nose.abc[k] = step.get(&LETTERS[3 + k]).copied().unwrap_or(nose.abc[k]);
                }
                continue;
            }
            let goal = LETTERS.map(|letter| step.get(&letter).copied());
            if !self.go_to_machine(goal, true)? {
                self.note("the way to where tools are changed is not known, and not looked at");
                return Ok(());
            }
        }
        if let Some(nose) = nose {
            self.places.fixed = nose.xyz.map(Some);
            self.stand(nose);
        }
        self.places.stands = true;
        Ok(())
    }
}
