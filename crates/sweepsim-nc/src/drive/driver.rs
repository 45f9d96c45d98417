//! The meaning of a block's coordinates on a machine: poses, and how the tool gets from one to the next.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Move, Pose, RotaryTable, TipCourse, Turning};

use crate::machines::{Kinematics, Machine, Position, Rotaries};
use crate::model::kept_arcs::KeptArcs;
use crate::model::read_options::{AxisLaw, ReadOptions, ToolOffset};
use crate::text::error::NcProblem;

/// What coordinates are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coordinates {
    /// Of the tip in the part's frame, whatever the rotary axes do.
    Tip,
    /// Of the machine's axes.
    Axes,
}

/// The signs of rotary axes if no machine is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sense {
    /// A table's axes turn the part by the right-hand rule, as LinuxCNC's do unless told otherwise.
    Part,
    /// Axes turn the tool relative to the part by the right-hand rule (ISO 841).
    Tool,
}

/// The reach of a tool from its tip, in mm, for which turns are divided where no law of motion is exact.
const REACH: f64 = 100.0;
/// The largest turn of the tool axis between two poses, in radians.
const WIDEST: f64 = std::f64::consts::FRAC_PI_2;
/// The most parts of one block.
const MOST_PARTS: f64 = 1e6;

/// A machine that runs a program.
#[derive(Clone, Debug)]
pub(crate) struct Driver {
    kinematics: Option<Arc<Kinematics>>,
    /// The rotary axes, as given or as implied by the letters so far.
    rotaries: Option<Rotaries>,
    given: bool,
    /// The letter of the tilting axis that was implied.
    implied: Option<usize>,
    sense: Sense,
    law: AxisLaw,
    /// Whether moves of a part that turns under the tool are kept as such, not as chords.
    carries: bool,
    tolerance: f64,
    tool: Option<u32>,
    tool_length: f64,
    /// By how much the control takes the tool for longer than it is.
    oversize: f64,
    /// The control's table of tools.
    lengths: BTreeMap<u32, ToolOffset>,
}

impl Driver {
    pub fn new(options: &ReadOptions, sense: Sense) -> Self {
        let machine: &Machine = &options.machine;
        let given = match (&machine.kinematics, machine.table) {
            (Some(kinematics), _) => Some(kinematics.rotaries().clone()),
            (None, Some(table)) => Some(Rotaries::of_table(table)),
            (None, None) => None,
        };
        Self {
            kinematics: machine.kinematics.clone(),
            given: given.is_some(),
            rotaries: given,
            implied: None,
            sense,
            law: options.law,
            carries: !KeptArcs::new(options).none(),
            tolerance: options.arc_tolerance,
            tool_length: machine
                .kinematics
                .as_ref()
                .map_or(0.0, |kinematics| kinematics.tool_length(None)),
            tool: None,
            oversize: 0.0,
            lengths: options.tool_offsets.clone(),
        }
    }

    pub fn kinematics(&self) -> Option<&Kinematics> {
        self.kinematics.as_deref()
    }

    /// Takes the signs of axes that no machine gives, from now on.
    pub fn prefer(&mut self, sense: Sense) {
        if sense != self.sense && self.implied.is_some() {
            self.rotaries = self.rotaries.take().map(Rotaries::reversed);
        }
        self.sense = sense;
    }

    /// The table that the letters of the program imply, if its signs are those of [`RotaryTable`].
    pub fn implied_table(&self) -> Option<RotaryTable> {
        match (self.sense, self.implied) {
            (Sense::Part, Some(0)) => Some(RotaryTable::Ac),
            (Sense::Part, Some(_)) => Some(RotaryTable::Bc),
            _ => None,
        }
    }

    /// From the tool's to the part's directions.
    pub fn orientation(&mut self, abc: [f64; 3]) -> Result<Matrix3<f64>, NcProblem> {
        Ok(self.rotaries(abc)?.orientation(abc))
    }

    /// Whether the rotary axes are known: given, or implied by letters so far.
    pub fn knows_rotaries(&self) -> bool {
        self.rotaries
            .as_ref()
            .is_some_and(|rotaries| *rotaries != Rotaries::default())
            || self.kinematics.is_some()
    }

    /// Takes the length of a new tool from the machine.
    pub fn change_tool(&mut self, tool: Option<u32>) {
        if tool == self.tool {
            return;
        }
        self.tool = tool;
        if let Some(kinematics) = &self.kinematics {
            self.tool_length = kinematics.tool_length(tool);
            let own = tool.filter(|tool| !kinematics.description().tool_lengths.contains_key(tool));
            if let Some(offset) = own.and_then(|tool| self.lengths.get(&tool)) {
                self.tool_length = offset.length;
            }
        }
    }

    /// What machine coordinates of the spindle's nose are more than a program's, with this tool.
    pub fn to_machine(&self) -> Option<[f64; 3]> {
        let machine = self.kinematics()?;
        Some(machine.to_machine(machine.tool_length(self.tool)).into())
    }

    /// Takes the tool for longer than it is.
    pub fn lengthen(&mut self, oversize: f64) {
        self.oversize = oversize;
    }

    /// From where the control takes the tip to be to where it is: along the tool.
    pub fn to_tip(&self, axis: [f64; 3]) -> [f64; 3] {
        axis.map(|c| self.oversize * c)
    }

    /// The length that the control computes with.
    fn length(&self) -> f64 {
        self.tool_length + self.oversize
    }

    /// The rotary axes for these angles: given, or those that their letters imply.
    pub fn rotaries(&mut self, abc: [f64; 3]) -> Result<&Rotaries, NcProblem> {
        const LETTERS: [&str; 3] = ["A", "B", "C"];
        let turned = |letter: usize| abc[letter] != 0.0;
        if let (true, Some(rotaries)) = (self.given, &self.rotaries) {
            if let Some(letter) = (0..3).find(|&letter| turned(letter) && !rotaries.has(letter)) {
                let known: Vec<&str> = (0..3)
                    .filter(|&letter| rotaries.has(letter))
                    .map(|letter| LETTERS[letter])
                    .collect();
                let expected = match known[..] {
                    [] => "none: the machine has no rotary axes".to_owned(),
                    _ if self.kinematics.is_none() => {
                        format!("{}: the table is given as {}", known.join(" or "), known.join("/"))
                    }
                    _ => format!("{}: the machine has no other rotary axes", known.join(" or ")),
                };
                return Err(NcProblem::value("the rotary word", LETTERS[letter], expected));
            }
        } else if let Some(tilting) = (0..2).find(|&letter| turned(letter)) {
            if let Some(before) = self.implied.filter(|before| *before != tilting && !turned(*before)) {
                let expected = format!("{} or C, as before", LETTERS[before]);
                return Err(NcProblem::value("the rotary word", LETTERS[tilting], expected));
            }
            if turned(0) && turned(1) {
                return Err(NcProblem::unsupported(
                    "programs with both A and B axes are, without their machine,",
                    "give a machine whose axes have these letters",
                ));
            }
            if self.implied.is_none() {
                self.implied = Some(tilting);
                let conventional = Rotaries::conventional(tilting);
                self.rotaries = Some(match self.sense {
                    Sense::Tool => conventional,
                    Sense::Part => conventional.reversed(),
                });
            }
        }
        Ok(self.rotaries.get_or_insert_with(Rotaries::default))
    }

    /// The direction from the tip to the holder.
    pub fn axis(&mut self, abc: [f64; 3]) -> Result<[f64; 3], NcProblem> {
        Ok(self.rotaries(abc)?.axis(abc).into())
    }

    /// The angles nearest to `near` at which the tool points along `direction`.
    pub fn angles(&mut self, direction: [f64; 3], near: [f64; 3]) -> Result<[f64; 3], NcProblem> {
        let unreachable = |degrees: f64| {
            let [x, y, z] = direction;
            NcProblem::value(
                "the direction of the tool",
                format!("({x}, {y}, {z})"),
                format!("one that the rotary axes reach: they come within {degrees} degrees"),
            )
        };
        if let Some(kinematics) = self.kinematics() {
            let pose = Pose::new([0.0; 3], direction).map_err(NcProblem::Pose)?;
            return match kinematics.nearest_angles(&pose, near) {
                Ok(abc) => Ok(abc),
                Err(error) => Err(NcProblem::syntax(error.to_string())),
            };
        }
        let rotaries = self.rotaries(near)?;
        let found = rotaries
            .angles(&Vector3::from(direction), near)
            .map_err(|off| unreachable(off.to_degrees()))?;
        let turned = |mut abc: [f64; 3]| {
            for (angle, near) in abc.iter_mut().zip(near) {
                *angle += 360.0 * ((near - *angle) / 360.0).round();
            }
            abc
        };
        let solutions = found.solutions.into_iter().map(turned);
        let travel = |abc: &[f64; 3]| rotaries.travel(near, *abc);
        Ok(solutions.min_by(|a, b| travel(a).total_cmp(&travel(b))).unwrap_or(near))
    }

    /// The pose at a position.
    pub fn pose(&mut self, at: &Position, coordinates: Coordinates) -> Result<Pose, NcProblem> {
        let axis = self.axis(at.abc)?;
        let tip = match coordinates {
            Coordinates::Tip => at.xyz,
            Coordinates::Axes => self.tip(at)?,
        };
        let shift = self.to_tip(axis);
        Pose::new(std::array::from_fn(|k| tip[k] + shift[k]), axis).map_err(NcProblem::Pose)
    }

    /// The tip in the part's frame at a position of the machine's axes.
    pub fn tip(&self, at: &Position) -> Result<[f64; 3], NcProblem> {
        if at.abc == [0.0; 3] && self.kinematics.is_none() {
            return Ok(at.xyz);
        }
        let kinematics = self.kinematics.as_ref().ok_or_else(|| {
            NcProblem::value(
                "a move with the rotary axes turned",
                "without tip control",
                "after M428, M128, G43.4 or TRAORI, or on a machine whose pivots are known (`machine:`; or `tip_control: true` when the \
                 coordinates are the tip in the part's frame)",
            )
        })?;
        Ok(kinematics.tip(at, self.length()).into())
    }

    /// X, Y, Z of the machine's axes at a tip, if they are known.
    pub fn axes_at(&self, tip: [f64; 3], abc: [f64; 3]) -> Option<[f64; 3]> {
        match &self.kinematics {
            Some(kinematics) => Some(kinematics.linear_at(tip, abc, self.length())),
            None => (abc == [0.0; 3]).then_some(tip),
        }
    }

    /// Into how many equal parts a move must be divided for the turn of the tool, whose path then has chords.
    fn division(&mut self, from: &Position, to: &Position, coordinates: Coordinates) -> Result<usize, NcProblem> {
        if from.abc == to.abc {
            return Ok(1);
        }
        let (law, tolerance, length) = (self.law, self.tolerance, self.length());
        self.rotaries(from.abc)?;
        let rotaries = self.rotaries(to.abc)?;
        let travel = rotaries.travel_of_tool(from.abc, to.abc);
        let exact = rotaries.turning(from.abc, to.abc).is_some();
        let as_machine = coordinates == Coordinates::Axes || law == AxisLaw::Rotary;
        // Two turns through the same ends, each within (h²/8) of the chord at equal times, where h is the travel of a part.
        let fine = travel * (REACH / (2.0 * tolerance)).sqrt();
        let mut parts = match (as_machine, exact) {
            (true, true) => 1.0,
            (true, false) => fine.max(1.0),
            (false, _) => travel / WIDEST - 1e-9,
        };
        if let (Coordinates::Axes, Some(kinematics)) = (coordinates, &self.kinematics) {
            let share = if exact { 1.0 } else { 0.5 };
            parts = parts.max(kinematics.chords(from, to, length, share * tolerance));
        }
        let parts = parts.ceil().max(1.0);
        if parts > MOST_PARTS {
            return Err(NcProblem::value(
                "the turn of the rotary axes in one block",
                format!("so large that it takes {parts:.0} parts"),
                format!("smaller: at most {MOST_PARTS} parts"),
            ));
        }
        Ok(parts as usize)
    }

    /// The positions along a straight move, to its end, with the move to each: those that divide it for the turn of the
    /// tool, and the corners of a rapid in which axes turn without tip control.
    pub fn course(
        &mut self,
        from: &Position,
        to: &Position,
        rapid: bool,
        coordinates: Coordinates,
    ) -> Result<Vec<(Position, Move)>, NcProblem> {
        let turns = rapid && coordinates == Coordinates::Axes && from.abc != to.abc;
        let legs = match self.kinematics.as_deref().filter(|_| turns) {
            Some(machine) => machine
                .rapid_path(from, to)
                .into_iter()
                .skip(1)
                .map(|point| point.position)
                .collect(),
            None => vec![*to],
        };
        let (mut course, mut last) = (Vec::new(), *from);
        for end in legs {
            if let Some(carried) = self.carried(last.abc, end.abc, coordinates)? {
                course.push((end, carried));
                last = end;
                continue;
            }
            let parts = self.division(&last, &end, coordinates)?;
            let mut before = last.abc;
            for part in 1..=parts {
                let at = if part == parts {
                    end
                } else {
                    last.towards(&end, part as f64 / parts as f64)
                };
                course.push((at, Move::straight(self.turning(before, at.abc, coordinates)?)));
                before = at.abc;
            }
            last = end;
        }
        Ok(course)
    }

    /// The move of a tool that goes straight while the table turns the part.
    fn carried(&mut self, from: [f64; 3], to: [f64; 3], coordinates: Coordinates) -> Result<Option<Move>, NcProblem> {
        let turns = match (coordinates, &self.kinematics) {
            (Coordinates::Axes, Some(kinematics)) if self.carries => kinematics.carries(from, to),
            _ => None,
        };
        let rotaries = self.rotaries(to)?;
        // A tool along the axis of the turn keeps its direction: chords of its path are solved faster.
        let turning = rotaries
            .turning(from, to)
            .filter(|_| rotaries.travel_of_tool(from, to) > 0.0);
        Ok(turns.zip(turning).map(|(turns, turning)| Move {
            course: TipCourse::Carried(turns),
            turning,
        }))
    }

    /// How the tool turns in a part of a move.
    pub fn turning(&mut self, from: [f64; 3], to: [f64; 3], coordinates: Coordinates) -> Result<Turning, NcProblem> {
        if from == to {
            return Ok(match self.law {
                AxisLaw::ConstantSpeed => Turning::Even,
                _ => Turning::Slerp,
            });
        }
        let law = self.law;
        let rotaries = self.rotaries(to)?;
        let as_machine = coordinates == Coordinates::Axes || law == AxisLaw::Rotary;
        let still =
            Vector3::from(rotaries.axis(from)) == Vector3::from(rotaries.axis(to)) && coordinates == Coordinates::Axes;
        Ok(match rotaries.turning(from, to) {
            // A tool of revolution that turns about itself does not move.
            _ if still => Turning::Slerp,
            Some(turning) if as_machine => turning,
            None if as_machine => Turning::Even,
            _ if law == AxisLaw::ConstantSpeed => Turning::Even,
            _ => Turning::Slerp,
        })
    }
}
