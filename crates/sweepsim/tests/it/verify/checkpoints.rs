//! Verifications that go on from states between two runs.

use super::tiles::Program;
use std::collections::BTreeMap;
use std::sync::Mutex;
use sweepsim::prelude::*;
use sweepsim::verify::{
    Checkpoints, Target, TileNotes, TileState, TileVerification, ToolPath, VerifyOptions, runs_of, verify_tiles_from,
};
use sweepsim_dexel::Dexels;

/// What remains, and what was found.
type State = (Vec<u8>, TileNotes);

/// Keeps every state, and begins with one.
#[derive(Default)]
struct Kept {
    states: Mutex<BTreeMap<(usize, usize), State>>,
    start: Option<(usize, Vec<TileState>)>,
}

impl Checkpoints for Kept {
    fn start(&self) -> Option<(usize, Vec<TileState>)> {
        self.start.clone()
    }

    fn wants(&self, _: usize) -> bool {
        true
    }

    fn keep(&self, (tile, runs): (usize, usize), remaining: &Dexels, notes: &TileNotes, _: u64) {
        let state = (remaining.state(), notes.clone());
        self.states.lock().unwrap().insert((runs, tile), state);
    }
}

const SIDE: usize = 23;

fn verified(program: &Program, path: &Path, kept: &Kept) -> Vec<TileVerification> {
    let tiles = program.case.grid().tiles(SIDE);
    let target = |tile| Target::new(&program.target, tile, 0.01, 0.01).unwrap();
    let targets: Vec<Target> = tiles.iter().map(target).collect();
    let scenes = tiles
        .iter()
        .zip(&targets)
        .map(|(tile, target)| program.scene(tile, target));
    let toolpath = [ToolPath::new(&program.assembly, path).with_states(&program.case.states)];
    let options = VerifyOptions::default().each_move(true);
    verify_tiles_from(scenes.collect(), &toolpath, &options, kept, &()).unwrap()
}

/// The same bits, from any state; and what comes before it is not even looked at.
#[test]
fn what_goes_on_from_a_state_ends_the_same() {
    let mut resumed = 0;
    for seed in 0..4 {
        let program = Program::new(900 + seed);
        let all = Kept::default();
        let whole = verified(&program, &program.path, &all);
        let tiles = program.case.grid().tiles(SIDE);
        assert!(whole.iter().all(|tile| tile.unresolved.is_empty()));
        let toolpath = [ToolPath::new(&program.assembly, &program.path).with_states(&program.case.states)];
        let runs = runs_of(&toolpath);
        assert!(runs.len() >= 8 && runs.last().unwrap().ends_stretch, "{}", runs.len());
        let states = all.states.into_inner().unwrap();
        assert_eq!(states.len(), runs.len() * tiles.len());
        for known in (1..=runs.len()).step_by(2) {
            let state = |(number, tile): (usize, &_)| {
                let (bytes, notes) = &states[&(known, number)];
                TileState::new(Dexels::from_state(*tile, bytes).unwrap(), notes.clone())
            };
            let start = Some((known, tiles.iter().enumerate().map(state).collect()));
            let again = Kept {
                start,
                ..Kept::default()
            };
            // Other moves before, no larger, but for the last one.
            let mut poses = program.path.poses().to_vec();
            let last = runs[known - 1].moves.end - 1;
            for pose in &mut poses[1..last.max(1)] {
                *pose = Pose::new([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]).unwrap();
            }
            let other = Path::new(poses).unwrap();
            assert!(known < 4 || other != program.path);
            if other.size() != program.path.size() {
                continue;
            }
            resumed += 1;
            let found = verified(&program, &other, &again);
            for (a, b) in found.iter().zip(&whole) {
                assert_eq!(a.record, b.record, "seed {seed}, from {known}");
                assert_eq!((a.crossings, &a.unresolved), (b.crossings, &b.unresolved));
                assert_eq!(a.remaining.state(), b.remaining.state(), "seed {seed}, from {known}");
            }
            let later = again.states.into_inner().unwrap();
            assert_eq!(later.len(), (runs.len() - known) * tiles.len());
            assert!(
                later.iter().all(|(key, state)| states[key] == *state),
                "seed {seed}, from {known}"
            );
        }
    }
    assert!(resumed >= 12, "{resumed}");
}
