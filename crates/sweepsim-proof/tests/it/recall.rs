//! Answers that are known from earlier work.

use crate::walls::LIFT;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Mutex;
use sweepsim_dexel::{Stock, TriangleSoup};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{
    Convex, Cutter, Limits, Movers, QuestionDigest, Recall, Room, Target, Work, closest_from, cover, deepest_from,
    highest_from, touched_from,
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

/// What the four searches find, each as text.
fn found(recall: &dyn Recall, tips: &[[f64; 3]]) -> [String; 4] {
    let up = [0.0, 0.0, 1.0];
    let path = Path::new(tips.iter().map(|tip| Pose::new(*tip, up).unwrap()).collect()).unwrap();
    let (cutter, body): (Vec<Convex>, Vec<Convex>) = (
        cover(&Tool::ball(3.0, 12.0).unwrap(), 1e-4),
        cover(&Tool::flat(4.0, 12.0).unwrap(), 1e-4),
    );
    let target = || Target::new(&TriangleSoup::block([-20.0, -12.0, -6.0], [20.0, 12.0, 2.0]), LIFT).unwrap();
    let stock = Stock::Block {
        min: [-20.0, -12.0, -6.0],
        max: [20.0, 12.0, 4.0],
    };
    let is_rapid = |number: usize| tips[number][2] == 6.0 || tips[number + 1][2] == 6.0;
    let work = [Work {
        cutter: Cutter::new(&cutter, &path, None),
        bodies: &body,
        is_rapid: &is_rapid,
    }];
    let room = Room {
        distance: -1e-3,
        deviation: 1e-6,
        zones: 20_000,
    };
    let (own, shank) = ([Cutter::new(&cutter, &path, None)], [Cutter::new(&body, &path, None)]);
    let limits = |limit: f64| Limits::new(limit, 0.1 * limit, 400_000);
    [
        format!(
            "{:?}",
            deepest_from(recall, &target(), &own, &limits(0.02), true, &()).unwrap()
        ),
        format!(
            "{:?}",
            closest_from(recall, &target(), &shank, &limits(0.04), true, &()).unwrap()
        ),
        format!("{:?}", {
            let left = highest_from(recall, (&target(), &stock), &own, &limits(0.4), true, &());
            left.unwrap().unwrap()
        }),
        format!(
            "{:?}",
            touched_from(recall, &stock, &work, Movers::Rapids, &room, &())
                .unwrap()
                .unwrap()
        ),
    ]
}

/// A change of a program.
type Change<'a> = &'a dyn Fn(&mut Vec<[f64; 3]>);

/// After changes of all kinds the answers are those without any knowledge; after late ones few are looked for again.
#[test]
fn what_is_known_changes_no_answer() {
    let mut tips = raster();
    assert!(tips.len() > 4_900);
    let memory = Memory::default();
    assert_eq!(found(&memory, &tips), found(&(), &tips));
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
        let again = found(&memory, &tips);
        let [known, searched] = memory.counts();
        assert_eq!(again, found(&(), &tips), "{what}");
        match what {
            "nothing" => assert_eq!(searched, 0),
            "an early move" => assert!(known > 0),
            _ => assert!(searched > 0 && 2 * searched < first, "{what}: {searched} of {first}"),
        }
    }
}
