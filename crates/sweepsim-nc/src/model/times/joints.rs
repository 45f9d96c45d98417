//! Moves that start and end at rest together: rapids divided into chords, and feed moves of axes that accelerate.

use nalgebra::Vector6;

use super::accelerations::Accelerating;
use super::{Axes, MoveTime};
use crate::machines::{Kinematics, Position};
use crate::model::program::{Program, ProgramPose};

/// Takes the times of moves in order, as they would be from rest to rest or at full speed, and gives them as they are. Those of feed moves without a rest that
/// later ones may still slow down are in `accelerating`; then there are no others.
pub(super) struct Joints<'a, F> {
    machine: Option<&'a Kinematics>,
    accelerating: Option<Accelerating<'a>>,
    rapid: Option<Chords>,
    /// Not given yet; the last ones belong to the rapid.
    kept: Vec<MoveTime>,
    last: Option<(ProgramPose, Option<Position>)>,
    each: F,
}

impl<'a, F: FnMut(MoveTime)> Joints<'a, F> {
    /// Without a machine, moves rest at their ends.
    pub fn new(program: &'a Program, machine: Option<&'a Kinematics>, each: F) -> Self {
        Self {
            machine,
            accelerating: machine.and_then(|machine| Accelerating::new(program, machine)),
            rapid: None,
            kept: Vec::new(),
            last: None,
            each,
        }
    }

    /// The next pose, and the time of the move to it.
    pub fn push(&mut self, time: MoveTime, pose: ProgramPose, position: Option<Position>) {
        let last = self.last.replace((pose.clone(), position));
        let (Some(machine), Some((from, Some(start))), Some(end)) = (self.machine, last, position) else {
            (self.each)(time);
            return;
        };
        let goes_on = self.rapid.as_mut().is_some_and(|rapid| rapid.goes_on(&pose, &end));
        if !goes_on && let Some(rapid) = self.rapid.take() {
            rapid.share_time(machine, &mut self.kept);
        }
        let way = self
            .accelerating
            .as_mut()
            .and_then(|feed| feed.begin([&from, &pose], [&start, &end], &time, &mut self.each));
        let moves_on = self.accelerating.as_ref().is_some_and(Accelerating::is_moving);
        if !goes_on && !moves_on {
            self.kept.drain(..).for_each(&mut self.each);
        }
        if let (Some(feed), Some(way)) = (&mut self.accelerating, way) {
            feed.push(&way, &time, &mut self.each);
            return;
        }
        self.kept.push(time);
        if !goes_on {
            self.rapid = Chords::starting(&pose, [start, end]);
        }
    }

    /// After the last pose.
    pub fn finish(mut self) {
        if let (Some(machine), Some(rapid)) = (self.machine, self.rapid.take()) {
            rapid.share_time(machine, &mut self.kept);
        }
        if let Some(feed) = &mut self.accelerating {
            feed.rest(&mut self.each);
        }
        self.kept.drain(..).for_each(&mut self.each);
    }
}

/// The chords of a rapid in one block: it rests at its ends only, and its time is shared among them by their ways.
struct Chords {
    file: usize,
    line: usize,
    call: Option<u32>,
    /// The first one's way.
    first: Vector6<f64>,
    ends: [Position; 2],
    lengths: Vec<f64>,
}

impl Chords {
    fn starting(pose: &ProgramPose, ends: [Position; 2]) -> Option<Self> {
        let first = change(&ends[0], &ends[1]);
        let length = first.norm();
        (pose.joined && pose.rapid && length > 0.0).then(|| Self {
            file: pose.file,
            line: pose.line,
            call: pose.call,
            first,
            ends,
            lengths: vec![length],
        })
    }

    /// Takes the next move if it is a chord of the same rapid: in the same block, with all axes going on in the same direction.
    fn goes_on(&mut self, pose: &ProgramPose, end: &Position) -> bool {
        if !(pose.joined && pose.rapid && (pose.file, pose.line, pose.call) == (self.file, self.line, self.call)) {
            return false;
        }
        let next = change(&self.ends[1], end);
        let along = next.dot(&self.first) / self.first.norm();
        if along <= 0.0 || (next - self.first * (along / self.first.norm())).norm() > 1e-6 * next.norm() {
            return false;
        }
        self.ends[1] = *end;
        self.lengths.push(next.norm());
        true
    }

    /// The last ones of `times` are its own.
    fn share_time(self, machine: &Kinematics, times: &mut [MoveTime]) {
        let count = self.lengths.len();
        if count == 1 {
            return;
        }
        let (seconds, _) = Axes::new(machine, &self.ends[0], &self.ends[1]).rapid();
        let total: f64 = self.lengths.iter().sum();
        let own = times.len() - count;
        for (time, length) in times[own..].iter_mut().zip(&self.lengths) {
            time.seconds = Some(seconds * length / total);
        }
    }
}

fn change(from: &Position, to: &Position) -> Vector6<f64> {
    Vector6::from_fn(|k, _| {
        if k < 3 {
            to.xyz[k] - from.xyz[k]
        } else {
            to.abc[k - 3] - from.abc[k - 3]
        }
    })
}
