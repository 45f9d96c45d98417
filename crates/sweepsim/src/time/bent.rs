//! Straight moves bent in the middle, for lines that are not settled however they are displaced.
//!
//! Where a tool moves along its own axis, its wall slides along itself, and the displacement of tips alone decides where `g` vanishes on it: at a ruling, which
//! stays where it is along the whole move. For a line that passes within roundings of it, a curved face that meets the wall smoothly has its solution nearer to the joint than
//! rounding. Displacing the line by a part of the tolerance does not take it out of there; but the direction in which the tip is displaced turns the ruling about the tool. A turn by a trillionth
//! makes no difference to that.

use crate::time::joined::divided;
use crate::time::path_parts::{PartKind, PathPart};
use crate::tolerances::Tolerances;
use nalgebra::Vector3;
use std::borrow::Cow;

/// The parts of a path as they are searched at an attempt: with all straight moves [bent](Tolerances::bend), if that is due.
pub(crate) fn bent<'a>(parts: &'a [PathPart], tolerances: &Tolerances, attempt: usize) -> Cow<'a, [PathPart]> {
    let mut all = Vec::new();
    for (at, part) in parts.iter().enumerate() {
        match part.halves(tolerances, attempt) {
            Some(halves) => {
                if all.is_empty() {
                    all.extend_from_slice(&parts[..at]);
                }
                all.extend(halves);
            }
            None if all.is_empty() => {}
            None => all.push(part.clone()),
        }
    }
    if all.is_empty() {
        Cow::Borrowed(parts)
    } else {
        Cow::Owned(all)
    }
}

impl PathPart {
    /// A straight move as two, by way of a point beside its middle; `None` for other moves, and for turns whose halves would have clocks of their own.
    fn halves(&self, tolerances: &Tolerances, attempt: usize) -> Option<[Self; 2]> {
        let is_straight = self.segment.is_arc() && self.segment.time(0.25) == 0.25;
        if !is_straight || matches!(self.kind, PartKind::LevelArc(_) | PartKind::VerticalArc(_)) {
            return None;
        }
        let [from, to] = self.segment.tips().map(Vector3::from);
        let axis = self.segment.start().column(2).into_owned();
        let aside = tolerances.bend(attempt, to - from, axis)?;
        let (at, kinds) = match self.joined() {
            [] => (0.5, [self.kind.clone(), self.kind.clone()]),
            // Joined moves are bent where one of them ends.
            joined => {
                let (at, joined) = divided(joined, joined.len() / 2);
                (at, joined.map(PartKind::Joins))
            }
        };
        let half = |[from, to]: [Vector3<f64>; 2], [begin, end]: [f64; 2], kind: PartKind| Self {
            segment: self.segment.part(begin, end).with_tips([from, to]),
            start: self.start + self.share * begin as f32,
            share: self.share * (end - begin) as f32,
            kind,
            number: self.number,
        };
        let middle = from + (to - from) * at + aside;
        let [first, second] = kinds;
        Some([
            half([from, middle], [0.0, at], first),
            half([middle, to], [at, 1.0], second),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::joined::push_joined;
    use crate::time::path_parts::{Kind, parts};
    use sweepsim_dexel::Frame;
    use sweepsim_motion::{Path, Pose};
    use sweepsim_props::*;

    const TOLERANCE: f64 = 1e-6;

    /// The parts of a path through tips a few steps along its direction each, with the same axis but for turns, and with straight moves joined.
    fn path(moves: &[(u8, bool, bool)], way: [f64; 3], axis: [f64; 3]) -> Vec<PathPart> {
        let (mut tip, mut own) = (Vector3::new(5.0, -3.0, 8.0), axis);
        let mut poses = vec![Pose::new(tip.into(), own).unwrap()];
        for (steps, turns, back) in moves {
            tip += Vector3::from(way) * (f64::from(*steps) * if *back { -0.7 } else { 1.0 });
            if *turns {
                own[0] += 0.1;
            }
            poses.push(Pose::new(tip.into(), own).unwrap());
        }
        let path = Path::new(poses).unwrap();
        let kind = Kind {
            symmetric: true,
            closed: true,
        };
        let tolerances = Tolerances::new(TOLERANCE, 1e3).unwrap();
        let mut made = Vec::new();
        for part in parts((&path, 0..path.moves()), &Frame::WORLD, kind, 40.0, &tolerances) {
            push_joined(&mut made, part, tolerances.joint_deviation());
        }
        made
    }

    proptest! {
        /// Bent parts follow each other as before, within the tolerance for a bend, at the same times of the same moves.
        #[test]
        fn bent_parts_are_near_the_path(
            moves in collection::vec((1..4_u8, prop::bool::weighted(0.2), prop::bool::weighted(0.2)), 1..12),
            way in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
            axis in [-1.0..1.0, -1.0..1.0, 0.2..1.0],
            along in any::<bool>(),
        ) {
            let parts = path(&moves, if along { axis } else { way }, axis);
            let tolerances = Tolerances::new(TOLERANCE, 1e3).unwrap();
            for attempt in 0..=Tolerances::REPAIRS {
                let made = bent(&parts, &tolerances, attempt);
                if attempt < 4 {
                    prop_assert!(matches!(made, Cow::Borrowed(_)), "{attempt}");
                    continue;
                }
                for pair in made.windows(2) {
                    prop_assert_eq!(pair[0].segment.tips()[1], pair[1].segment.tips()[0]);
                }
                let mut left = &made[..];
                for part in &parts {
                    let straight = part.segment.is_arc();
                    let (own, rest) = left.split_at(if straight { 2 } else { 1 });
                    left = rest;
                    let [from, to] = part.segment.tips().map(Vector3::from);
                    prop_assert_eq!(own[0].segment.tips()[0], part.segment.tips()[0]);
                    prop_assert_eq!(own[own.len() - 1].segment.tips()[1], part.segment.tips()[1]);
                    let mut before = (0, 0.0);
                    for half in own {
                        for k in 0..=20 {
                            let share = f64::from(k) / 20.0;
                            let at = Vector3::from(half.segment.at(share).1);
                            let time = ((at - from).dot(&(to - from)) / (to - from).norm_squared()).clamp(0.0, 1.0);
                            if straight {
                                let aside = (at - from - (to - from) * time).norm();
                                prop_assert!(aside <= 0.01 * TOLERANCE * (1.0 + 1e-6), "{aside}");
                            }
                            // The end of a move is the start of the next.
                            let [(number, t), (other, s)] = [half.place(share), part.place(time)];
                            let [own, other] = [(number, t), (other, s)].map(|(number, t)| number as f32 + t);
                            prop_assert!(!straight || (own - other).abs() < 1e-4, "{own} {other}");
                            prop_assert!(before <= (number, t));
                            before = (number, t - 1e-6);
                        }
                    }
                }
                prop_assert!(left.is_empty());
            }
        }
    }
}
