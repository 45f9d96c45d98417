//! Certificates of what touches no material, and whatever may be done to them.

use crate::certificates::checked;
use crate::process::{ROOM, Scene as Program, block, slot};
use sweepsim_check::{Checked, Claim, Course, Curve, Measure, Question, Scene, Tree, packed};
use sweepsim_dexel::Stock;
use sweepsim_motion::{Path, Pose};
use sweepsim_proof::{Cutter, Movers, Room, Touched, cover_and_cores, material_claim, motions, outline, regions};

/// What is claimed, and what it is about.
pub(crate) struct Certified {
    scene: Scene,
    claim: Claim,
    /// The trees of its solids, one after the other.
    bytes: Vec<u8>,
}

impl Certified {
    pub fn checked(&self) -> Checked {
        checked(&self.scene, &self.claim)
    }

    /// Whether it is proven with other bytes in the tree of one solid.
    fn with(&self, bytes: &[u8]) -> bool {
        let mut claim = self.claim.clone();
        claim.trees[0].bytes = packed(bytes);
        checked(&self.scene, &claim).is_proven()
    }

    /// Whether it is proven in another scene.
    fn within(&self, change: impl Fn(&mut Scene)) -> bool {
        let mut scene = self.scene.clone();
        change(&mut scene);
        assert_ne!(scene, self.scene);
        checked(&scene, &self.claim).is_proven()
    }
}

/// A question about a program in a stock.
fn asked(program: &Program, stock: &Stock, movers: Movers, room: &Room) -> Scene {
    let tools = [&program.cutter, &program.body];
    let solids = tools.map(|tool| cover_and_cores(tool, 1e-4)).concat();
    let cutter = Cutter::new(&solids, &program.path, None);
    let (measure, own) = match movers {
        Movers::Bodies => (Measure::Material, 1),
        Movers::Rapids => (Measure::MaterialInRapids, 0),
    };
    Scene {
        outlines: tools.map(|tool| outline(tool, true)).to_vec(),
        paths: vec![motions(&cutter, room.deviation, &|number| {
            program.rapids.contains(&number)
        })],
        deviation: room.deviation,
        stock: regions(stock, 0.0).expect("no mesh"),
        questions: vec![Question {
            about: "a test".into(),
            measure,
            limit: -room.distance,
            solid: 0,
            movers: vec![(0, own)],
            cutters: vec![(0, 0)],
        }],
        ..Scene::default()
    }
}

/// What is claimed of a program of which nothing was found to touch material.
pub(crate) fn certified(program: &Program, stock: &Stock, movers: Movers, room: &Room, found: &Touched) -> Certified {
    let scene = asked(program, stock, movers, room);
    let [cutter, body] = [&program.cutter, &program.body].map(|tool| cover_and_cores(tool, 1e-4));
    let [cutter, body] = [&cutter, &body].map(|solids| [(0, Cutter::new(solids, &program.path, None))]);
    let own = match movers {
        Movers::Bodies => &body,
        Movers::Rapids => &cutter,
    };
    let claim = material_claim(&scene, &scene.questions[0], [own, &cutter], -room.distance, found);
    let trees = found.trees.iter().flatten();
    Certified {
        claim: claim.expect("recorded"),
        scene,
        bytes: trees.flat_map(|tree| tree.bytes.clone()).collect(),
    }
}

fn proven(program: &Program, movers: Movers) -> Certified {
    let found = program.touched_in(&block(), movers, &ROOM);
    certified(program, &block(), movers, &ROOM, &found)
}

/// A claim with one tree of a solid that is about all of a path.
fn by_hand(program: &Program, movers: Movers, bytes: &[u8]) -> Certified {
    let scene = asked(program, &block(), movers, &ROOM);
    let count = scene.paths[0].len();
    let claim = Claim {
        about: "a test".into(),
        bound: 1e-3,
        covers: vec![vec![[3, 1]]; 2],
        trees: vec![Tree {
            count,
            bytes: packed(bytes),
            ..Tree::default()
        }],
        ..Claim::default()
    };
    let bytes = bytes.to_vec();
    Certified { scene, claim, bytes }
}

/// Along a slot, and back.
fn there_and_back(rapids: &[usize]) -> Program {
    let tips = [[-40.0, 0.0, -4.0], [40.0, 0.0, -4.0], [-40.0, 0.0, -4.0]];
    let mut program = Program::new(&tips, 15.0, 5.0);
    program.rapids = rapids.to_vec();
    program
}

/// All of it is in the first cut.
const CUT: [u8; 4] = [3, 0, 0, 0];

#[test]
fn only_what_was_cut_before_counts() {
    let accepted = |rapids: &[usize], bytes: &[u8]| {
        let own = by_hand(&there_and_back(rapids), Movers::Rapids, bytes);
        own.checked().is_proven()
    };
    // The way back is a rapid: its tool where it begins, and its surface all along it.
    assert!(accepted(&[1], &[CUT, CUT].concat()));
    // Both are needed, and nothing else is.
    assert!(!accepted(&[1], &CUT));
    assert!(!accepted(&[1], &[CUT, CUT, CUT].concat()));
    // Nor is it cut by a second move, or another tool or solid.
    for number in 1..4 {
        let mut other = CUT;
        other[number] = 1;
        assert!(!accepted(&[1], &[CUT, other].concat()));
        assert!(!accepted(&[1], &[other, CUT].concat()));
    }
    // The way there is the rapid: what cuts comes later.
    assert!(!accepted(&[0], &[CUT, CUT].concat()));
    // Both are rapids: what the first removes is not cut.
    assert!(!accepted(&[0, 1], &[CUT, CUT, CUT].concat()));
    assert!(!accepted(&[0, 1], &[CUT, CUT].concat()));
    // Another course that the rapid may take begins where it does; one from elsewhere has to be looked at there.
    let other = |from: f64, leaves: usize| {
        let mut own = by_hand(&there_and_back(&[1]), Movers::Rapids, &CUT.repeat(leaves));
        let mut other = own.scene.paths[0][1].clone();
        other.possible = true;
        let Course::Linear(poses) = &mut other.course else {
            panic!("linear")
        };
        poses[0][0][0] = from;
        own.scene.paths[0].push(other);
        own.claim.trees[0].count = 3;
        own.checked().is_proven()
    };
    assert!(other(40.0, 3) && !other(40.0, 2) && !other(40.0, 4));
    assert!(other(39.0, 4) && !other(39.0, 3));
    // Of a later path, nothing counts; of an earlier one, all.
    let later = |numbers: [usize; 2], bytes: &[u8]| {
        let mut own = by_hand(&there_and_back(&[0, 1]), Movers::Rapids, bytes);
        let mut cuts = own.scene.paths[0].clone();
        cuts.iter_mut().for_each(|motion| motion.idle = false);
        own.scene.paths.insert(numbers[1], cuts);
        own.scene.questions[0].movers = vec![(numbers[0], 0)];
        own.scene.questions[0].cutters = vec![(0, 0), (1, 0)];
        own.claim.covers.push(vec![[3, 1]]);
        own.checked().is_proven()
    };
    let by = |path: u8| [3, path, 0, 0].repeat(3);
    assert!(later([1, 0], &by(0)));
    assert!(!later([0, 1], &by(1)));
}

#[test]
fn a_move_does_not_make_way_for_itself() {
    // A body beside its cutter, as wide as it.
    let mut program = there_and_back(&[]);
    program.body = program.cutter.clone();
    let accepted = |bytes: &[u8]| by_hand(&program, Movers::Bodies, bytes).checked().is_proven();
    // Before the first move, it is in the cutter; so it is in both of them, all the time.
    let own = [5, 0];
    assert!(accepted(&[&own[..], &own, &own].concat()));
    // In the second, it is in what the first has cut. The first has cut nothing ahead of the cutter.
    assert!(accepted(&[&own[..], &own, &CUT].concat()));
    assert!(!accepted(&[&own[..], &CUT, &own].concat()));
    // In rapids, it cuts nothing.
    program.rapids = vec![0, 1];
    let accepted = |bytes: &[u8]| by_hand(&program, Movers::Bodies, bytes).checked().is_proven();
    assert!(!accepted(&[&own[..], &own, &own].concat()));
}

/// A shank as wide as its cutter, in a slot of three steps.
fn shank(by: f64) -> Program {
    Program::new(&slot(4.0, 12.0), 5.0, 5.0 + by)
}

#[test]
fn no_zone_may_be_left_out_or_changed() {
    let own = proven(&shank(0.0), Movers::Bodies);
    let bytes = own.bytes.clone();
    assert!(
        own.with(&bytes) && own.checked().nodes >= 12 && bytes.len() > 40,
        "{bytes:?}"
    );
    // It is about material that was cut before, and time and outline are divided for it.
    assert!(bytes.windows(3).any(|leaf| leaf == [3, 0, 0]));
    for end in 0..bytes.len() {
        assert!(
            !own.with(&bytes[..end]) && !own.with(&bytes[bytes.len() - end..]),
            "{end}"
        );
    }
    // A wider shank is in the wall. The same tree does not hold, nor does any other with one byte changed.
    let wide = shank(0.01);
    let wide = Certified {
        scene: asked(&wide, &block(), Movers::Bodies, &ROOM),
        claim: own.claim.clone(),
        bytes: Vec::new(),
    };
    for number in 0..bytes.len() {
        for by in [0, 1, 2, 3, 4, 8, 15, 0x80] {
            let mut changed = bytes.clone();
            changed[number] ^= by;
            assert!(!wide.with(&changed), "byte {number}");
        }
    }
    // Without some motions, twice, or of another solid.
    let refused = |change: &dyn Fn(&mut Claim)| {
        let mut claim = own.claim.clone();
        change(&mut claim);
        assert!(!checked(&own.scene, &claim).is_proven());
    };
    refused(&|claim| claim.trees.clear());
    refused(&|claim| claim.trees[0].count -= 1);
    refused(&|claim| claim.trees[0].count = usize::MAX);
    refused(&|claim| claim.trees[0].first = 1);
    refused(&|claim| claim.trees[0].solid = 1);
    refused(&|claim| claim.trees[0].mover = 1);
    refused(&|claim| claim.trees.push(claim.trees[0].clone()));
    refused(&|claim| claim.covers.truncate(1));
    refused(&|claim| claim.covers[0] = vec![[2, 1]]);
    refused(&|claim| claim.bound = 0.0);
    refused(&|claim| claim.bound = f64::NAN);
    refused(&|claim| claim.about = "another".into());
}

#[test]
fn other_programs_tools_and_stocks_are_refused() {
    let tips = {
        let mut tips = slot(4.0, 8.0);
        let [x, _, z] = tips[tips.len() - 1];
        tips.extend([
            [x, 0.0, 5.0],
            [0.0, 0.0, 5.0],
            [0.0, 0.0, z],
            [12.0, 0.0, z],
            [12.0, 0.0, 5.0],
        ]);
        tips
    };
    let mut program = Program::new(&tips, 15.0, 5.0);
    let first = tips.len() - 6;
    program.rapids = (first..tips.len() - 1).collect();
    let own = proven(&program, Movers::Rapids);
    assert!(own.checked().nodes >= 5);
    let moved = |scene: &mut Scene, number: usize, by: [f64; 3]| {
        for (motion, end) in [(number, 1), (number + 1, 0)] {
            let Course::Linear(poses) = &mut scene.paths[0][motion].course else {
                panic!("linear")
            };
            (0..3).for_each(|k| poses[end][0][k] += by[k]);
        }
    };
    // Deeper than the slot, or into its wall.
    assert!(!own.within(|scene| moved(scene, first + 2, [0.0, 0.0, -0.01])));
    assert!(!own.within(|scene| moved(scene, first + 3, [0.0, 0.01, 0.0])));
    // The slot is less deep, or is not cut.
    assert!(!own.within(|scene| moved(scene, first - 2, [0.0, 0.0, 0.01])));
    assert!(!own.within(|scene| scene.paths[0][first - 1].idle = true));
    assert!(!own.within(|scene| scene.paths[0][first - 1].possible = true));
    // There is more material.
    assert!(!own.within(|scene| scene.stock[0][4].1 += 6.0));
    assert!(!own.within(|scene| scene.skin = 6.0));
    assert!(!own.within(|scene| scene.stock.push(scene.stock[0].clone())));
    // What it does not say is not needed: another rapid in the air.
    assert!(own.within(|scene| moved(scene, first, [0.0, 0.0, 1.0])));
    let larger = |scene: &mut Scene| {
        for curve in &mut scene.outlines[0].curves {
            if let Curve::Bezier(ends) = curve {
                ends.iter_mut().for_each(|(end, _)| end[0] *= 1.001);
            }
        }
    };
    // A larger tool has cut a wider slot.
    assert!(own.within(larger));
}

/// Cylinders and balls are known by many planes; and edges, between two of them.
#[test]
fn round_stocks_are_known_by_their_planes() {
    let stocks = [
        Stock::Cylinder {
            base: [0.0, 0.0, -28.0],
            axis: [0.2, 0.1, 1.0],
            radius: 25.0,
            height: 20.0,
        },
        Stock::Ball {
            centre: [0.0, 0.0, -25.0],
            radius: 25.0,
        },
        Stock::Union(vec![
            block(),
            Stock::Block {
                min: [-60.0, -60.0, -60.0],
                max: [60.0, 60.0, -30.0],
            },
        ]),
    ];
    for stock in &stocks {
        let program = shank(0.0);
        let found = program.touched_in(stock, Movers::Bodies, &ROOM);
        assert!(found.moves.is_empty() && found.open_count == 0, "{stock:?}: {found:?}");
        assert!(
            certified(&program, stock, Movers::Bodies, &ROOM, &found)
                .checked()
                .nodes
                > 5
        );
    }
    // Along an edge of a block, tilted by 45°: no side of the block has all of the holder beyond it.
    let mut program = Program::new(&slot(4.0, 4.0), 1.0, 6.0);
    let pose = |y: f64| Pose::new([30.3, y, 0.3], [1.0, 0.0, 1.0]).expect("a pose");
    program.path = Path::new(vec![pose(-10.0), pose(10.0)]).expect("a path");
    let own = proven(&program, Movers::Bodies);
    // What is high above is beside one plane; the rest beside the sum of two, with weights.
    assert_eq!(own.bytes.len(), 2 * 20, "{:?}", own.bytes);
    let is_sum = |tree: &[u8]| tree[0] == 14 && tree[5..8] == [1, 2, 4] && tree[12] == 0;
    assert!(own.bytes.chunks(20).all(is_sum));
    // Without one of them, or its weight, it is not.
    for number in [6, 7, 11, 12, 16] {
        let mut changed = own.bytes.clone();
        changed[number] = 1;
        assert!(!own.with(&changed), "byte {number}");
    }
}

/// Where two regions meet there is no gap, though what is there is deep in neither.
#[test]
fn between_two_regions_is_material() {
    let region = |[low, high]: [f64; 2]| Stock::Block {
        min: [-30.0, -20.0, low],
        max: [30.0, 20.0, high],
    };
    let stock = Stock::Union(vec![region([-20.0, -4.0]), region([-4.0, 0.0])]);
    // A thin disc, in both by less than is allowed.
    let mut program = Program::new(&[[-8.0, 0.0, -4.000_25], [8.0, 0.0, -4.000_25]], 5e-4, 1.0);
    program.rapids = vec![0];
    let leaf = [1, 1, 4, 1, 5].repeat(2);
    let mut own = by_hand(&program, Movers::Rapids, &leaf);
    own.scene.stock = regions(&stock, 0.0).expect("no mesh");
    assert!(!own.checked().is_proven());
    let found = program.touched_in(&stock, Movers::Rapids, &Room { zones: 2000, ..ROOM });
    assert!(found.trees.is_none());
    // On top of both, side by side, or of one of them, it is.
    own.scene.stock.truncate(1);
    assert!(own.with(&[1, 1, 4].repeat(2)));
    let turned = |region: &[([f64; 3], f64)]| -> Vec<_> {
        let beside = region
            .iter()
            .map(|(n, c)| if n[0] < 0.0 { (*n, 0.0) } else { (*n, *c) });
        beside.collect()
    };
    own.scene.stock.push(turned(&own.scene.stock[0]));
    assert!(own.with(&[1, 1, 4, 1, 4].repeat(2)));
    assert!(!own.with(&[1, 1, 4, 1, 1].repeat(2)));
}
