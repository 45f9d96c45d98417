//! Where the machine stands, and the poses it has gone through.
//!
//! Coordinates are millimetres and degrees in the frame of the first work offset; `None` where the program has not said them.

use sweepsim_motion::{Course, Move, Pose, RotaryTable, TipArc, Turning};

use super::rotary;
use super::{AxisLaw, Options};
use crate::error::Problem;
use crate::program::{Notes, Program, ProgramPose};

/// Poses of one program, at most: a bound of the memory that a file of a few bytes can ask for.
const MOST_POSES: usize = 20_000_000;

/// A place to go to: the coordinates, and the rotary angles A, B, C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Target {
    pub xyz: [f64; 3],
    pub abc: [f64; 3],
}

/// The angles `[tilt, C]` of a table.
fn angles(table: RotaryTable, [a, b, c]: [f64; 3]) -> [f64; 2] {
    match table {
        RotaryTable::Ac => [a, c],
        RotaryTable::Bc => [b, c],
    }
}

/// The machine.
pub(crate) struct Machine {
    pub xyz: [Option<f64>; 3],
    pub abc: [f64; 3],
    pub tip_control: bool,
    pub tool: Option<u32>,
    pub feed: Option<f64>,
    pub notes: Notes,
    table: Option<RotaryTable>,
    table_given: bool,
    poses: Vec<ProgramPose>,
    /// Whether the next pose follows from the last one.
    joined: bool,
    law: AxisLaw,
}

impl Machine {
    pub fn new(options: &Options) -> Self {
        Self {
            xyz: [None; 3],
            abc: [0.0; 3],
            tip_control: options.tip_control,
            tool: None,
            feed: None,
            notes: Notes::default(),
            table: options.table,
            table_given: options.table.is_some(),
            poses: Vec::new(),
            joined: false,
            law: options.law,
        }
    }

    pub fn finish(self) -> Program {
        Program {
            poses: self.poses,
            notes: self.notes.finish(),
        }
    }

    /// Whether there has been a pose.
    pub fn has_moved(&self) -> bool {
        !self.poses.is_empty()
    }

    /// The path breaks here: the next pose does not follow from the last one.
    pub fn leave(&mut self) {
        self.joined = false;
    }

    /// All coordinates, when they are known.
    pub fn known(&self) -> Option<[f64; 3]> {
        match self.xyz {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        }
    }

    /// Takes coordinates that are not known as 0: before a move that needs them.
    pub fn assume(&mut self, line: usize, xyz: impl Fn(usize) -> bool) {
        for k in 0..3 {
            if self.xyz[k].is_none() && xyz(k) {
                let axis = ['X', 'Y', 'Z'][k];
                self.notes.add(line, format!("{axis} is not known here: taken as 0"));
                self.xyz[k] = Some(0.0);
            }
        }
    }

    /// Puts the place where a cutting move starts in front of it, when the path does not come from there already.
    pub fn start_here(&mut self, line: usize) -> Result<(), Problem> {
        if let (false, Some(xyz)) = (self.joined, self.known()) {
            self.push(Target { xyz, abc: self.abc }, Move::default(), true, line)?;
        }
        Ok(())
    }

    /// A straight move. Divides it where the axis turns far.
    pub fn line_to(&mut self, target: Target, rapid: bool, line: usize) -> Result<(), Problem> {
        let from = self.abc;
        if self.joined && target.abc != from && self.law != AxisLaw::Rotary {
            let table = self.table(target.abc)?;
            let tilt = |abc: [f64; 3]| match table {
                Some(table) => angles(table, abc),
                None => [0.0, abc[2]],
            };
            let parts = rotary::parts(tilt(from), tilt(target.abc));
            if parts > 1e4 {
                return Err(Problem::value(
                    "the turn of the rotary axes in one block",
                    format!("{} degrees", parts * 90.0),
                    "less than 900000 degrees",
                ));
            }
            if let (true, Some(start)) = (parts > 1.0, self.known()) {
                self.notes.add(
                    line,
                    "the axis turns by more than 90 degrees in one block: poses on the rotary axes' way put in",
                );
                for part in 1..parts as usize {
                    let s = part as f64 / parts;
                    let mix = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| a[k] + s * (b[k] - a[k]));
                    let between = Target {
                        xyz: mix(start, target.xyz),
                        abc: mix(from, target.abc),
                    };
                    let way = Move::straight(self.turning(from, between.abc)?);
                    self.push(between, way, rapid, line)?;
                }
            }
        }
        let way = Move::straight(self.turning(from, target.abc)?);
        self.push(target, way, rapid, line)?;
        self.xyz = target.xyz.map(Some);
        self.abc = target.abc;
        Ok(())
    }

    /// Cuts along an arc to `target`.
    pub fn arc_to(&mut self, target: Target, arc: TipArc, line: usize) -> Result<(), Problem> {
        let turning = match self.turning(self.abc, target.abc)? {
            Turning::Slerp => Turning::Even,
            other => other,
        };
        let way = Move {
            course: Course::Arc(arc),
            turning,
        };
        self.push(target, way, false, line)?;
        self.xyz = target.xyz.map(Some);
        self.abc = target.abc;
        Ok(())
    }

    /// How the axis turns between two places of the rotary axes.
    fn turning(&mut self, from: [f64; 3], to: [f64; 3]) -> Result<Turning, Problem> {
        Ok(match (self.law, self.table(to)?) {
            (AxisLaw::ConstantSpeed, _) => Turning::Even,
            (AxisLaw::Rotary, Some(table)) if from != to => Turning::Rotary {
                table,
                from: angles(table, from),
                to: angles(table, to),
            },
            _ => Turning::Slerp,
        })
    }

    /// The rotary table, given or by the letters that have been other than 0.
    fn table(&mut self, [a, b, _]: [f64; 3]) -> Result<Option<RotaryTable>, Problem> {
        let used = match (a != 0.0, b != 0.0) {
            (false, false) => return Ok(self.table),
            (true, false) => RotaryTable::Ac,
            (false, true) => RotaryTable::Bc,
            (true, true) => {
                return Err(Problem::unsupported(
                    "machines with both A and B axes are",
                    "expected A and C, or B and C",
                ));
            }
        };
        match self.table {
            Some(table) if table != used => Err(Problem::value(
                "the rotary word",
                if used == RotaryTable::Ac { "A" } else { "B" },
                match (table, self.table_given) {
                    (RotaryTable::Ac, true) => "A or C: the table is given as A/C",
                    (RotaryTable::Bc, true) => "B or C: the table is given as B/C",
                    (RotaryTable::Ac, false) => "A or C, as before",
                    (RotaryTable::Bc, false) => "B or C, as before",
                },
            )),
            _ => {
                self.table = Some(used);
                Ok(self.table)
            }
        }
    }

    fn push(&mut self, target: Target, way: Move, rapid: bool, line: usize) -> Result<(), Problem> {
        if !self.tip_control && target.abc != [0.0; 3] {
            return Err(Problem::value(
                "a move with the rotary axes turned",
                "without tip control",
                "after M428, M128 or G43.4 (or read with `tip_control: true` when the coordinates are the tip in the part's frame)",
            ));
        }
        let axis = match self.table(target.abc)? {
            Some(table) => table.axis(angles(table, target.abc)),
            None => [0.0, 0.0, 1.0],
        };
        let pose = Pose::new(target.xyz, axis).map_err(Problem::Pose)?;
        let moves = matches!(way.course, Course::Arc(_)) || matches!(way.turning, Turning::Rotary { .. });
        let same = !moves && self.joined && self.poses.last().is_some_and(|last| last.pose == pose);
        if !same {
            if self.poses.len() >= MOST_POSES {
                return Err(Problem::value(
                    "the number of poses",
                    self.poses.len(),
                    "smaller: divide the program, or allow a larger arc tolerance",
                ));
            }
            self.poses.push(ProgramPose {
                pose,
                rapid,
                line,
                joined: self.joined,
                tool: self.tool,
                feed: if rapid { None } else { self.feed },
                way,
            });
        }
        self.joined = true;
        Ok(())
    }
}
