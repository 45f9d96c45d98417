//! Moves without rotation that go on in the direction of the one before, joined to one: each of them would be solved for the same lines again.

use crate::time::path_parts::{PartKind, PathPart};
use nalgebra::Vector3;

/// A part of a path among those that are joined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    /// The tip at its end.
    tip: Vector3<f64>,
    /// How much of the joined way lies before its end.
    until: f64,
    /// As of [`PathPart`].
    number: u32,
    start: f32,
    share: f32,
}

impl Stretch {
    fn of(part: &PathPart, tip: Vector3<f64>) -> Self {
        Self {
            tip,
            until: 1.0,
            number: part.number,
            start: part.start,
            share: part.share,
        }
    }
}

/// Divides joined moves behind the first `after` of them, at least one and not all. Also how much of the way lies before.
pub(crate) fn divided(joined: &[Stretch], after: usize) -> (f64, [Vec<Stretch>; 2]) {
    let at = joined[after - 1].until;
    let [mut before, mut behind] = [&joined[..after], &joined[after..]].map(<[Stretch]>::to_vec);
    before.iter_mut().for_each(|stretch| stretch.until /= at);
    behind
        .iter_mut()
        .for_each(|stretch| stretch.until = (stretch.until - at) / (1.0 - at));
    (at, [before, behind])
}

/// The most parts that are joined: each further one is compared with all tips before.
const MOST: usize = 64;

/// Appends a part of a path, joined to the last one if the tips between the ends are within `deviation` of the straight way.
pub(crate) fn push_joined(parts: &mut Vec<PathPart>, next: PathPart, deviation: f64) {
    let joined = parts.last_mut().is_some_and(|last| join(last, &next, deviation));
    if !joined {
        parts.push(next);
    }
}

fn join(last: &mut PathPart, next: &PathPart, deviation: f64) -> bool {
    let (PartKind::Joins(joined), PartKind::Joins(_)) = (&last.kind, &next.kind) else {
        return false;
    };
    if joined.len() >= MOST || last.segment.turns() != next.segment.turns() {
        return false;
    }
    let [[from, between], [again, to]] = [&last.segment, &next.segment].map(|s| s.tips().map(Vector3::from));
    if between != again {
        return false;
    }
    let (way, length) = (to - from, (to - from).norm());
    let ahead = way / length;
    // All tips between are near the way, in their order.
    let mut reached = 0.0;
    let mut passes = |tip: &Vector3<f64>| {
        let along = (tip - from).dot(&ahead);
        let goes_on = along > reached && along < length;
        reached = along;
        goes_on && (tip - from - ahead * along).norm() <= deviation
    };
    // The last one of these is the tip between.
    let own = [Stretch::of(last, between)];
    let before = if joined.is_empty() { &own[..] } else { joined };
    if !before.iter().all(|stretch| passes(&stretch.tip)) {
        return false;
    }
    let mut joined = [before, &[Stretch::of(next, to)]].concat();
    for stretch in &mut joined {
        stretch.until = (stretch.tip - from).dot(&ahead) / length;
    }
    last.kind = PartKind::Joins(joined);
    last.segment = last.segment.clone().with_tips([from, to]);
    true
}

impl PathPart {
    /// Those that it consists of, if they are several.
    pub(crate) fn joined(&self) -> &[Stretch] {
        match &self.kind {
            PartKind::Joins(joined) => joined,
            _ => &[],
        }
    }

    /// The move, and the fraction of it, after a share of the time of this part.
    pub fn place(&self, share: f64) -> (u32, f32) {
        let joined = self.joined();
        let Some(last) = joined.len().checked_sub(1) else {
            return (self.number, self.start + self.share * share as f32);
        };
        let at = joined[..last].partition_point(|stretch| stretch.until < share);
        let begun = at.checked_sub(1).map_or(0.0, |before| joined[before].until);
        let stretch = &joined[at];
        let own = ((share - begun) / (stretch.until - begun)).clamp(0.0, 1.0);
        (stretch.number, stretch.start + stretch.share * own as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::path_parts::parts;
    use crate::tolerances::Tolerances;
    use sweepsim_motion::{Path, Pose};

    /// The parts of a path through these tips, joined.
    fn joined(tips: &[[f64; 3]], axes: [[f64; 3]; 2]) -> Vec<PathPart> {
        let tolerances = Tolerances::new(1e-6, 100.0).unwrap();
        let last = tips.len() - 1;
        let pose = |(n, tip): (usize, &[f64; 3])| Pose::new(*tip, axes[usize::from(n == last)]).unwrap();
        let path = Path::new(tips.iter().enumerate().map(pose).collect()).unwrap();
        let whole = (&path, 0..path.moves());
        let all = parts(
            whole,
            &sweepsim_dexel::Frame::WORLD,
            crate::time::path_parts::Kind {
                symmetric: true,
                closed: false,
            },
            40.0,
            &tolerances,
        );
        let mut made = Vec::new();
        all.into_iter()
            .for_each(|part| push_joined(&mut made, part, tolerances.joint_deviation()));
        made
    }

    /// The numbers of moves from `tips[k]` to `tips[k + 1]` in each joined part.
    fn counts(parts: &[PathPart]) -> Vec<usize> {
        parts.iter().map(|part| part.joined().len().max(1)).collect()
    }

    const UP: [[f64; 3]; 2] = [[0.0, 0.0, 1.0]; 2];

    #[test]
    fn moves_in_one_direction_are_one() {
        let ahead = |k: i32| [0.1 * f64::from(k * k), 0.3, 2.0];
        let tips: Vec<_> = (0..40).map(ahead).collect();
        assert_eq!(counts(&joined(&tips, UP)), [39]);
        // Those at which displacements start anew stay as they are.
        let many: Vec<_> = (0..150).map(ahead).collect();
        assert_eq!(counts(&joined(&many, UP)), [60, 1, 60, 1, 27]);
        // A corner, a way back, and a tip that is a little beside.
        let corner = [tips[..9].to_vec(), vec![[6.4, 5.0, 2.0], [6.4, 7.0, 2.0]]].concat();
        assert_eq!(counts(&joined(&corner, UP)), [8, 2]);
        let back = [tips[..9].to_vec(), tips[..8].iter().rev().copied().collect()].concat();
        assert_eq!(counts(&joined(&back, UP)), [8, 8]);
        for (aside, expected) in [(5e-9, vec![2]), (5e-8, vec![1, 1])] {
            let bent = [[0.0, 0.0, 0.0], [4.0, aside, 0.0], [9.0, 0.0, 0.0]];
            assert_eq!(counts(&joined(&bent, UP)), expected);
        }
        // A curve that leaves the direction by little from move to move.
        let curve: Vec<_> = (0..40).map(|k| [f64::from(k), 1e-8 * f64::from(k * k), 0.0]).collect();
        assert!(counts(&joined(&curve, UP)).into_iter().all(|count| count < 4));
        // Another tilt, or a turn in the last move.
        assert_eq!(counts(&joined(&tips, [UP[0], [0.1, 0.0, 1.0]])), [38, 1]);
    }

    #[test]
    fn places_are_in_the_moves() {
        let tips: Vec<_> = (0..40)
            .map(|k| [0.1 * f64::from(k * k), -0.2 * f64::from(k * k), 2.0])
            .collect();
        let parts = joined(&tips, UP);
        let whole = tips[39][0];
        for k in 0..=1_000 {
            let share = f64::from(k) / 1_000.0;
            let (number, t) = parts[0].place(share);
            let [from, to] = [tips[number as usize][0], tips[number as usize + 1][0]];
            assert!((from + f64::from(t) * (to - from) - share * whole).abs() < 1e-4);
        }
    }
}
