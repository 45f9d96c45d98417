//! What the axes of a machine do on a path, at every time of each move.

use std::sync::Arc;

use nalgebra::Vector3;
use sweepsim_machine::{Course, JOINTS, Values};
use sweepsim_motion::{Pose, TipArc, TipCourse};

use crate::machines::{Chain, Kinematics, Position, Rapid};
use crate::model::pose::ProgramPose;

/// The course of the joints of a machine along a path: of each move, and where a rapid may be made in two ways, of both.
#[derive(Clone, Debug)]
pub struct AxesCourse {
    pub(super) machine: Arc<Kinematics>,
    pub(super) chain: Chain,
    pub(super) tool_length: f64,
    pub(super) pieces: Vec<Piece>,
    /// Of the last pose: [`ProgramPose::fixed`].
    pub(super) fixed: [bool; 3],
}

/// A part of a move in which the joints go straight, or the tip goes its own way.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub from: Values,
    pub to: Values,
    /// The move, and whether it is the dog-leg that the move may be.
    pub number: u32,
    pub other: bool,
    pub joined: bool,
    /// Whether it begins at a corner of a dog-leg.
    pub corner: bool,
    /// Times of the move that it begins and ends at.
    pub share: [f64; 2],
    /// Whether X, Y and Z are where the machine's own coordinates say, at the start and at the end.
    pub fixed: [[bool; 3]; 2],
    pub bent: Option<Box<Bent>>,
}

/// The tip on its way while the rotary axes turn evenly.
#[derive(Clone, Debug)]
pub(super) struct Bent {
    tips: [[f64; 3]; 2],
    arc: Option<TipArc>,
    from: Position,
    to: Position,
    tool_length: f64,
    /// No second derivative of X, Y, Z is larger.
    bound: [f64; 3],
}

impl AxesCourse {
    /// The course on a path that begins at a position.
    #[must_use]
    pub fn new(machine: Arc<Kinematics>, start: &ProgramPose, at: &Position) -> Self {
        let chain = machine.chain();
        let tool_length = machine.tool_length(start.tool);
        let values = chain.values(&machine, at, tool_length);
        let still = Piece {
            from: values,
            to: values,
            number: 0,
            other: false,
            joined: false,
            corner: false,
            share: [0.0; 2],
            fixed: [start.fixed; 2],
            bent: None,
        };
        Self {
            machine,
            chain,
            tool_length,
            pieces: vec![still],
            fixed: start.fixed,
        }
    }

    /// The chain of its joints.
    #[must_use]
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Kinematics {
        &self.machine
    }

    /// From the spindle's nose to the tip, as the path's first pose has it.
    #[must_use]
    pub fn tool_length(&self) -> f64 {
        self.tool_length
    }

    /// Adds the move from one pose and position to another one, which is the move `number` of the path.
    pub fn push(&mut self, (start, from): (&Pose, &Position), (end, to): (&ProgramPose, &Position), number: usize) {
        let length = self.machine.tool_length(end.tool);
        let values = |at: &Position| self.chain.values(&self.machine, at, length);
        let turns = from.abc != to.abc;
        let arc = match end.way().course {
            TipCourse::Arc(arc) => Some(arc),
            TipCourse::Straight | TipCourse::Carried(_) => None,
        };
        let even = !end.tip_control && arc.is_none();
        let bent = (arc.is_some() || turns && !even).then(|| Bent::new(&self.machine, (start, from), (end, to), arc));
        let fixed = [std::mem::replace(&mut self.fixed, end.fixed), end.fixed];
        let piece = |from, to, other, joined, share, bent| Piece {
            fixed,
            from,
            to,
            number: number as u32,
            other,
            joined,
            corner: false,
            share,
            bent,
        };
        let kind = self.machine.rapid();
        // One that turns without tip control may be a dog-leg from the start of its block to the end.
        let of_block = turns && kind == Rapid::Unknown;
        let corners = match end.rapid && bent.is_none() && !of_block {
            true => self.machine.dog_leg(from, to),
            false => Vec::new(),
        };
        let mut added = Vec::new();
        if corners.is_empty() || kind != Rapid::DogLeg {
            added.push(piece(
                values(from),
                values(to),
                false,
                true,
                [0.0, 1.0],
                bent.map(Box::new),
            ));
        }
        if !corners.is_empty() && kind != Rapid::Straight {
            let is_other = kind == Rapid::Unknown;
            let ends = std::iter::once((0.0, *from)).chain(corners).chain([(1.0, *to)]);
            let ends: Vec<(f64, Position)> = ends.collect();
            added.extend(ends.windows(2).enumerate().map(|(k, pair)| {
                let [(t, a), (u, b)] = [pair[0], pair[1]];
                let mut piece = piece(values(&a), values(&b), is_other, k > 0 || !is_other, [t, u], None);
                piece.corner = k > 0;
                piece.fixed = [&a, &b].map(|at| fixed_at(fixed, (from, to), at));
                if !is_other {
                    // The path has its corners, too.
                    (piece.number, piece.share) = ((number + k) as u32, [0.0, 1.0]);
                }
                piece
            }));
        }
        self.pieces.extend(added);
    }

    /// Adds what the last moves of the path may be, which are one rapid that turns axes without tip control: a dog-leg
    /// between its ends.
    pub fn push_dog_leg(&mut self, [from, to]: [&Position; 2], moves: usize) {
        let Some(first) = self.pieces.len().checked_sub(moves) else {
            return;
        };
        let (Some(begin), Some(end)) = (self.pieces.get(first), self.pieces.last()) else {
            return;
        };
        let (fixed, number) = ([begin.fixed[0], end.fixed[1]], end.number);
        let corners = self.machine.dog_leg(from, to);
        if corners.is_empty() {
            return;
        }
        let ends = std::iter::once((0.0, *from)).chain(corners).chain([(1.0, *to)]);
        let ends: Vec<(f64, Position)> = ends.collect();
        for (k, pair) in ends.windows(2).enumerate() {
            let [(t, a), (u, b)] = [pair[0], pair[1]];
            let values = |at: &Position| self.chain.values(&self.machine, at, self.tool_length);
            let piece = Piece {
                fixed: [&a, &b].map(|at| fixed_at(fixed, (from, to), at)),
                from: values(&a),
                to: values(&b),
                number,
                other: true,
                joined: k > 0,
                corner: k > 0,
                share: [t, u],
                bent: None,
            };
            self.pieces.push(piece);
        }
    }

    /// Where the joints are in a move of the path, at a time from 0 to 1.
    #[must_use]
    pub fn during(&self, number: usize, time: f64) -> Values {
        let first = self.pieces.partition_point(|piece| (piece.number as usize) < number);
        let own = self.pieces[first..].iter().enumerate();
        let own = own.take_while(|(_, piece)| piece.number as usize == number);
        let mut own = own.filter(|(_, piece)| !piece.other && piece.share[1] > piece.share[0]);
        match own.find(|(_, piece)| time <= piece.share[1]) {
            Some((piece, Piece { share: [from, to], .. })) => self.at(first + piece, (time - from) / (to - from)),
            None => self.at(self.pieces.len() - 1, 1.0),
        }
    }

    /// Whether the tool goes the same way on the part in a piece, wherever the part is: no axis is at a place of the machine, and none turns without tip
    /// control.
    #[must_use]
    pub fn follows_part(&self, piece: usize) -> bool {
        let piece = &self.pieces[piece];
        let turns = self.chain.letters().iter().zip(piece.from).zip(piece.to);
        let turns = turns
            .into_iter()
            .any(|((letter, from), to)| ('A'..='C').contains(letter) && from != to);
        let is_fixed = piece.fixed.iter().flatten().any(|fixed| *fixed);
        !is_fixed && (piece.bent.is_some() || !turns)
    }

    /// The limits of an axis.
    #[must_use]
    pub fn limits(&self, letter: char) -> Option<[f64; 2]> {
        let linear = self.machine.linear().iter().find(|axis| axis.letter == letter);
        let rotary = || self.machine.rotary().find(|axis| axis.letter == letter);
        linear.map_or_else(|| rotary()?.limits, |axis| axis.limits)
    }

    /// Whether X, Y or Z is where the machine's own coordinates say, wherever the part is: at the start of a piece, and at its end.
    #[must_use]
    pub fn fixed(&self, piece: usize, letter: char) -> [bool; 2] {
        let k = ['X', 'Y', 'Z'].iter().position(|own| *own == letter);
        self.pieces[piece].fixed.map(|fixed| k.is_some_and(|k| fixed[k]))
    }

    /// The move of the path that a piece is of, the time in it, and whether it is so only if a rapid is a dog-leg.
    #[must_use]
    pub fn place(&self, piece: usize, time: f64) -> (usize, f64, bool) {
        let piece = &self.pieces[piece];
        let [from, to] = piece.share;
        (piece.number as usize, from + time * (to - from), piece.other)
    }
}

/// Which of X, Y and Z are fixed at a corner of a dog-leg between two positions: those that are where they are so.
pub(super) fn fixed_at(fixed: [[bool; 3]; 2], (from, to): (&Position, &Position), at: &Position) -> [bool; 3] {
    let is_there = |k: usize, end: &Position| at.xyz[k] == end.xyz[k];
    std::array::from_fn(|k| fixed[0][k] && is_there(k, from) || fixed[1][k] && is_there(k, to))
}

impl Bent {
    fn new(
        machine: &Kinematics,
        (start, from): (&Pose, &Position),
        (end, to): (&ProgramPose, &Position),
        arc: Option<TipArc>,
    ) -> Self {
        let bent = Self {
            tips: [start.tip(), end.pose.tip()],
            arc,
            from: *from,
            to: *to,
            tool_length: machine.tool_length(end.tool),
            bound: [0.0; 3],
        };
        bent.on(machine)
    }

    /// The same way of the tip on a machine.
    pub fn on(&self, machine: &Kinematics) -> Self {
        let (from, to) = (&self.from, &self.to);
        let mut bound = machine.bend(self.tips, from.abc, to.abc, self.tool_length);
        if let Some(arc) = self.arc {
            let normal = Vector3::from(arc.normal());
            let out = Vector3::from(self.tips[0]) - Vector3::from(arc.centre());
            let radius = normal.cross(&out).norm();
            // What an arc adds to a straight tip: it is off by a diameter at most, faster by the arc, and bent itself.
            let turn: f64 = (0..3).map(|k| (to.abc[k] - from.abc[k]).abs().to_radians()).sum();
            let speed = radius * arc.angle().abs();
            let more = speed * arc.angle().abs() + 2.0 * turn * speed + 2.0 * turn * turn * radius;
            let [_, inverse] = machine.directions();
            bound = std::array::from_fn(|k| bound[k] + more * inverse.row(k).norm());
        }
        Self { bound, ..self.clone() }
    }

    fn at(&self, machine: &Kinematics, time: f64) -> Position {
        let course = self.arc.map_or(TipCourse::Straight, TipCourse::Arc);
        let tip = course.tip(self.tips, time);
        let abc = self.from.towards(&self.to, time).abc;
        Position::new(machine.linear_at(tip, abc, self.tool_length), abc)
    }
}

impl Course for AxesCourse {
    fn moves(&self) -> usize {
        self.pieces.len()
    }

    fn at(&self, number: usize, time: f64) -> Values {
        let piece = &self.pieces[number];
        match &piece.bent {
            None => std::array::from_fn(|k| piece.from[k] + time * (piece.to[k] - piece.from[k])),
            Some(bent) => {
                let at = bent.at(&self.machine, time);
                self.chain.values(&self.machine, &at, bent.tool_length)
            }
        }
    }

    fn bend(&self, number: usize) -> Values {
        let mut values = [0.0; JOINTS];
        if let Some(bent) = &self.pieces[number].bent {
            for (value, letter) in values.iter_mut().zip(self.chain.letters()) {
                if let Some(k) = ['X', 'Y', 'Z'].iter().position(|own| own == letter) {
                    *value = bent.bound[k];
                }
            }
        }
        values
    }

    fn joined(&self, number: usize) -> bool {
        self.pieces[number].joined
    }
}
