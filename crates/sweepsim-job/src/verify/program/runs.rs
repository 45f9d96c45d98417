//! Digests of the runs of a program.

use crate::base::cache::{Digest, Key};
use std::borrow::Cow;
use std::ops::Range;
use sweepsim::verify::{RunOfMoves, ToolPath, runs_of};
use sweepsim_motion::{Move, Path};

/// What is known of a program after so many runs, by digests of all up to there.
pub(super) struct RunKeys {
    /// After each number of runs.
    keys: Vec<Key>,
    /// How many moves are done by then.
    moves: Vec<usize>,
    /// The moves of each path.
    of_paths: Vec<usize>,
}

impl RunKeys {
    pub fn new(program: &[ToolPath]) -> Self {
        let mut digest = Digest::of("runs");
        let (mut keys, mut moves) = (vec![digest.clone().key()], vec![0]);
        let mut present = None;
        for run in runs_of(program) {
            let toolpath = &program[run.path];
            let mut path = match present.take() {
                Some((number, path)) if number == run.path => path,
                _ => {
                    digest = with_tool(digest.number(run.path), toolpath);
                    Unpacked::new(toolpath.path)
                }
            };
            digest = with_moves(digest, toolpath, (&mut path, &run));
            keys.push(after(digest.clone(), (&mut path, &run)).key());
            present = Some((run.path, path));
            moves.push(moves[moves.len() - 1] + run.moves.len());
        }
        let of_paths = program.iter().map(|toolpath| toolpath.path.moves()).collect();
        Self { keys, moves, of_paths }
    }

    /// The number of runs.
    pub fn count(&self) -> usize {
        self.keys.len() - 1
    }

    pub fn after(&self, runs: usize) -> &Key {
        &self.keys[runs]
    }

    pub fn moves(&self, runs: usize) -> usize {
        self.moves[runs]
    }

    pub fn of_paths(&self) -> &[usize] {
        &self.of_paths
    }
}

/// The tool, and how large the whole path is: tolerances follow from that.
fn with_tool(digest: Digest, toolpath: &ToolPath) -> Digest {
    let digest = digest.value(toolpath.assembly).value(&toolpath.larger);
    digest.floats(&[toolpath.path.size()])
}

/// So many moves are unpacked at a time.
const UNPACKED: usize = 4096;

/// Some moves of a path.
struct Unpacked<'a> {
    path: &'a Path,
    part: Cow<'a, Path>,
    first: usize,
    moves: Range<usize>,
}

impl<'a> Unpacked<'a> {
    fn new(path: &'a Path) -> Self {
        let moves = 0..path.moves().min(UNPACKED);
        let (part, first) = path.unpacked(moves.clone());
        Self {
            path,
            part,
            first,
            moves,
        }
    }

    /// A path with a move, and the number of the move there.
    fn with(&mut self, number: usize) -> (&Path, usize) {
        if !self.moves.contains(&number) && number < self.path.moves() {
            self.moves = number..self.path.moves().min(number + UNPACKED);
            (self.part, self.first) = self.path.unpacked(self.moves.clone());
        }
        (&self.part, number - self.first)
    }
}

/// The moves of a run, with the poses at both ends.
fn with_moves(mut digest: Digest, toolpath: &ToolPath, (path, run): (&mut Unpacked, &RunOfMoves)) -> Digest {
    let state = toolpath.states.get(run.moves.start).copied().unwrap_or_default();
    digest = digest.number(run.moves.start).number(run.moves.end).value(&state);
    let (part, own) = path.with(run.moves.start);
    digest = digest.pose(&part.pose(own));
    for number in run.moves.start..run.moves.end.min(toolpath.path.moves()) {
        let (part, own) = path.with(number);
        digest = digest.pose(&part.pose(own + 1));
        let way = part.way(own);
        if way != Move::default() {
            digest = digest.number(number).value(&way);
        }
    }
    for other in toolpath.other_courses.iter().flat_map(|all| all.of(run.moves.clone())) {
        digest = digest.value(&other);
    }
    digest
}

/// What is after a run, as far as its last move depends on that: the moves up to the first in which the tool does not
/// rest, and whether others are prepared with it.
fn after(mut digest: Digest, (path, run): (&mut Unpacked, &RunOfMoves)) -> Digest {
    digest = digest.value(&run.ends_stretch);
    for number in run.moves.end..path.path.moves() {
        let (part, own) = path.with(number);
        digest = digest.pose(&part.pose(own + 1)).value(&part.way(own));
        if !part.rests(own, own + 1) {
            return digest;
        }
    }
    digest.number(0)
}
