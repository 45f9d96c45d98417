//! Answers that are known from earlier work.

use crate::walls::LIFT;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Mutex;
use sweepsim_dexel::{Stock, TriangleSoup};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{
    Convex, Cutter, Limits, Movers, QuestionDigest, Recall, Room, Target, Work, closest_from, cover_and_cores,
    deepest_from, highest_from, touched_from,
};

/// Keeps all answers, and counts those that were known and those that were not.
#[derive(Default)]
struct Memory {
    answers: Mutex<HashMap<QuestionDigest, Vec<u8>>>,
    counts: Mutex<[usize; 2]>,
}

impl Memory {
    /// Known, not known; since the last time.
    fn counts(&self) -> [usize; 2] {
        std::mem::take(&mut self.counts.lock().unwrap())
    }
}

impl Recall for Memory {
    fn keeps(&self) -> bool {
        true
    }

    fn digest(&self, question: &[u8]) -> QuestionDigest {
        let mut digest = QuestionDigest::default();
        for (k, part) in digest.chunks_mut(8).enumerate() {
            let mut hasher = DefaultHasher::new();
            (k, question).hash(&mut hasher);
            part.copy_from_slice(&hasher.finish().to_le_bytes());
        }
        digest
    }

    fn recall(&self, question: &QuestionDigest) -> Option<Vec<u8>> {
        let known = self.answers.lock().unwrap().get(question).cloned();
        self.counts.lock().unwrap()[usize::from(known.is_none())] += 1;
        known
    }

    fn keep(&self, question: &QuestionDigest, answer: Vec<u8>) {
        self.answers.lock().unwrap().insert(*question, answer);
    }
}

/// A raster of short moves over the top of a block, from −20 to 20, with rapids to its next pass.
fn raster() -> Vec<[f64; 3]> {
    let mut tips = Vec::new();
    for pass in 0..60 {
        let y = -10.0 + f64::from(pass) / 3.0;
        tips.push([-26.0, y, 6.0]);
        tips.extend((0..=80).map(|k| [-24.0 + 0.6 * f64::from(k), y, 2.05 + 0.04 * f64::from(k % 3)]));
        tips.push([26.0, y, 6.0]);
    }
    tips
}

fn path(tips: &[[f64; 3]]) -> Path {
    let pose = |tip: &[f64; 3]| Pose::new(*tip, [0.0, 0.0, 1.0]).unwrap();
    Path::new(tips.iter().map(pose).collect()).unwrap()
}

fn cutter() -> Vec<Convex> {
    cover_and_cores(&Tool::ball(3.0, 12.0).unwrap(), 1e-4)
}

fn shank() -> Vec<Convex> {
    cover_and_cores(&Tool::flat(4.0, 12.0).unwrap(), 1e-4)
}

const STOCK: Stock = Stock::Block {
    min: [-20.0, -12.0, -6.0],
    max: [20.0, 12.0, 4.0],
};

/// What the three searches find that ask for moves wherever they are, each as text; with trees, if they are wanted.
fn found(recall: &dyn Recall, tips: &[[f64; 3]], recorded: bool) -> [String; 3] {
    let (path, cutter, shank) = (path(tips), cutter(), shank());
    let target = || Target::new(&TriangleSoup::block([-20.0, -12.0, -6.0], [20.0, 12.0, 2.0]), LIFT).unwrap();
    let (own, shank) = ([Cutter::new(&cutter, &path, None)], [Cutter::new(&shank, &path, None)]);
    let limits = |limit: f64| Limits::new(limit, 0.1 * limit, 400_000);
    let deepest = deepest_from(recall, &target(), &own, &limits(0.02), recorded, &());
    let closest = closest_from(recall, &target(), &shank, &limits(0.04), recorded, &());
    let highest = highest_from(recall, (&target(), &STOCK), &own, &limits(0.4), recorded, &());
    [
        format!("{:?}", deepest.unwrap()),
        format!("{:?}", closest.unwrap()),
        format!("{:?}", highest.unwrap().unwrap()),
    ]
}

/// Which rapids, and which moves of the shank, touch what is still there: that depends on all moves before.
fn touched(recall: &dyn Recall, tips: &[[f64; 3]]) -> String {
    let (path, cutter, shank) = (path(tips), cutter(), shank());
    let is_rapid = |number: usize| tips[number][2] == 6.0 || tips[number + 1][2] == 6.0;
    let work = [Work {
        cutter: Cutter::new(&cutter, &path, None),
        bodies: &shank,
        is_rapid: &is_rapid,
    }];
    let room = Room {
        distance: -1e-3,
        deviation: 1e-6,
        zones: 20_000,
    };
    let touched = touched_from(recall, &STOCK, &work, Movers::Rapids, &room, &());
    format!("{:?}", touched.unwrap().unwrap())
}

/// A change of a program.
type Change<'a> = &'a dyn Fn(&mut Vec<[f64; 3]>);

/// After changes of all kinds the answers are those without any knowledge; after late ones few are looked for again.
#[test]
fn what_is_known_changes_no_answer() {
    let mut tips = raster();
    assert!(tips.len() > 4_900);
    let memory = Memory::default();
    let all = |recall: &dyn Recall, tips: &[[f64; 3]]| (found(recall, tips, true), touched(recall, tips));
    assert_eq!(all(&memory, &tips), all(&(), &tips));
    let [known, first] = memory.counts();
    assert!(known < first / 4 && first > 60, "{known} {first}");
    let late = tips.len() - 120;
    let changes: [(&str, Change); 6] = [
        ("nothing", &|_| {}),
        ("a gouge", &|tips| tips[late][2] = 1.9),
        ("one more move", &|tips| tips.insert(late + 9, [3.0, 9.0, 2.5])),
        ("a move less", &|tips| {
            tips.remove(late - 50);
        }),
        ("a rapid that is too low", &|tips| tips.push([0.0, 0.0, 1.0])),
        ("an early move", &|tips| tips[100][2] += 0.2),
    ];
    for (what, change) in changes {
        change(&mut tips);
        let again = all(&memory, &tips);
        let [known, searched] = memory.counts();
        assert_eq!(again, all(&(), &tips), "{what}");
        match what {
            "nothing" => assert_eq!(searched, 0),
            "an early move" => assert!(known > 0),
            _ => assert!(searched > 0 && 2 * searched < first, "{what}: {searched} of {first}"),
        }
    }
}

/// What comes after a move that was put in, or left out, is the same moves with other numbers.
#[test]
fn later_moves_are_known_by_what_they_are() {
    let mut tips = raster();
    let memory = Memory::default();
    found(&memory, &tips, false);
    let [_, first] = memory.counts();
    let changes: [(&str, Change); 2] = [
        ("one more move", &|tips| tips.insert(1_000, [3.0, -4.0, 2.5])),
        ("a move less", &|tips| {
            tips.remove(2_000);
        }),
    ];
    for (what, change) in changes {
        change(&mut tips);
        let again = found(&memory, &tips, false);
        let [known, searched] = memory.counts();
        assert!(known > 0 && 8 * searched < first, "{what}: {searched} of {first}");
        assert_eq!(again, found(&(), &tips, false), "{what}");
    }
}
