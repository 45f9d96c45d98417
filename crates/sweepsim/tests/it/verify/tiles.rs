//! Tiles that are judged by themselves.

use super::by_force::Case;
use super::{Random, clean};
use std::ops::ControlFlow;
use sweepsim::SweepError;
use sweepsim::prelude::*;
use sweepsim::verify::{
    AreaShare, FindingKind, Judgement, Look, MoveState, Scene, Target, TileDeviation, TileRecord, TileVerification,
    ToolPath, Verification, VerifyOptions, deviations, deviations_along, verify, verify_tiles,
};
use sweepsim_dexel::{Grid, TriangleSoup};
use sweepsim_motion::{Assembly, BodyKind};

/// A raster with a holder that drags through the stock, rapids that are too low, and a target that is cut into.
pub(super) struct Program {
    pub case: Case,
    pub assembly: Assembly,
    pub path: Path,
    pub target: TriangleSoup,
}

/// A box as a mesh.
fn block([low, high]: [[f64; 3]; 2]) -> TriangleSoup {
    let corner = |n: usize| [0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] });
    let squares = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = squares.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    let triangles = triangles.map(|triangle| triangle.map(corner)).collect();
    TriangleSoup { triangles }
}

impl Program {
    pub fn new(seed: u64) -> Self {
        let random = &mut Random::new(seed);
        let mut case = clean(random);
        for (n, pose) in case.poses.iter_mut().enumerate() {
            if n % 7 == 3 {
                let [x, y, z] = pose.tip();
                *pose = Pose::new([x, y, z.min(0.0) - random.within(0.0, 2.0)], pose.axis()).unwrap();
            }
        }
        case.holder.z[0] = random.within(1.0, 6.0);
        let [low, high] = case.stock;
        let target = block([low, [high[0], high[1], high[2] - random.within(0.5, 2.5)]]);
        Self {
            assembly: Assembly::new(case.cutter.tool()).with(BodyKind::Holder, case.holder.tool()),
            path: case.path(),
            case,
            target,
        }
    }

    pub fn scene<'a>(&self, tile: &Grid, target: &'a Target) -> Scene<'a> {
        let [min, max] = self.case.stock;
        Scene::new(Stock::Block { min, max }.dexels(tile).unwrap()).with_target(target)
    }

    fn whole(&self, options: &VerifyOptions) -> Verification {
        let grid = self.case.grid();
        let target = Target::new(&self.target, &grid, 0.01, 0.01).unwrap();
        let program = [ToolPath::new(&self.assembly, &self.path).with_states(&self.case.states)];
        let go_on = &mut |_: &_| ControlFlow::Continue(());
        verify(self.scene(&grid, &target), &program, options, go_on, &()).unwrap()
    }

    /// Some tiles, by their numbers.
    fn tiles(&self, side: usize, numbers: &[usize], options: &VerifyOptions) -> Vec<TileVerification> {
        let tiles = self.case.grid().tiles(side);
        let target = |number: &usize| Target::new(&self.target, &tiles[*number], 0.01, 0.01).unwrap();
        let targets: Vec<Target> = numbers.iter().map(target).collect();
        let scenes = numbers.iter().zip(&targets);
        let scenes = scenes
            .map(|(number, target)| self.scene(&tiles[*number], target))
            .collect();
        let program = [ToolPath::new(&self.assembly, &self.path).with_states(&self.case.states)];
        verify_tiles(scenes, &program, options, &()).unwrap()
    }
}

fn records(tiles: Vec<TileVerification>) -> Vec<TileRecord> {
    tiles.into_iter().map(|tile| tile.record).collect()
}

#[test]
fn any_division_gives_the_same_bits() {
    for seed in 0..4 {
        let program = Program::new(900 + seed);
        let options = VerifyOptions::default().each_move(true);
        let count = program.case.grid().tiles(17).len();
        let all: Vec<usize> = (0..count).collect();
        let together = program.tiles(17, &all, &options);
        // One by one, from the last to the first.
        let mut single: Vec<_> = all
            .iter()
            .rev()
            .flat_map(|n| program.tiles(17, &[*n], &options))
            .collect();
        single.reverse();
        for (a, b) in together.iter().zip(&single) {
            assert!(a.remaining == b.remaining && a.record == b.record && a.crossings == b.crossings);
            assert_eq!(a.unresolved, b.unresolved);
        }
        let (a, b) = (
            Judgement::of_tiles(&records(together)),
            Judgement::of_tiles(&records(single)),
        );
        assert!(!a.findings.is_empty());
        assert_eq!(a, b);
    }
}

#[test]
fn tiles_find_what_the_whole_grid_finds() {
    let (mut kinds, mut bodies) = (Vec::new(), 0);
    for seed in 0..6 {
        let program = Program::new(900 + seed);
        let options = VerifyOptions::default().each_move(true);
        let whole = program.whole(&options);
        for side in [64, 23, 9] {
            let all: Vec<usize> = (0..program.case.grid().tiles(side).len()).collect();
            let tiles = program.tiles(side, &all, &options);
            let remaining = tiles.iter().map(|tile| tile.remaining.clone()).collect();
            let remaining = Dexels::from_tiles(program.case.grid(), remaining).unwrap();
            assert!((remaining.volume() - whole.remaining.volume()).abs() < 1e-6);
            let joined = Judgement::of_tiles(&records(tiles));
            let harms = |findings: &[sweepsim::verify::Finding]| -> Vec<_> {
                findings
                    .iter()
                    .map(|f| (f.path, f.number, f.kind, f.body, f.near))
                    .collect()
            };
            let sorted = |mut harms: Vec<(usize, usize, FindingKind, Option<usize>, bool)>| {
                harms.sort_unstable();
                harms
            };
            assert_eq!(
                sorted(harms(&joined.findings)),
                sorted(harms(&whole.findings)),
                "seed {seed}, {side}"
            );
            for own in &joined.findings {
                let other = whole
                    .findings
                    .iter()
                    .find(|f| (f.number, f.kind, f.body) == (own.number, own.kind, own.body));
                let other = other.unwrap();
                assert!((own.time - other.time).abs() < 1e-4, "{own:?} {other:?}");
                assert!(
                    (own.depth - other.depth).abs() <= 1e-3 * other.depth + 1e-5,
                    "{own:?} {other:?}"
                );
                assert!(
                    (own.volume - other.volume).abs() <= 1e-4 * other.volume + 1e-4,
                    "{own:?} {other:?}"
                );
                kinds.push(own.kind);
                bodies += usize::from(own.body.is_some());
            }
            assert_eq!(joined.moves.len(), whole.moves.len());
            for (a, b) in joined.moves.iter().zip(&whole.moves) {
                assert_eq!((a.path, a.number), (b.path, b.number));
                assert!((a.volume - b.volume).abs() < 1e-5);
                assert!(
                    (a.depth - b.depth).abs() < 1e-5 && (a.width - b.width).abs() < 1e-5,
                    "{a:?} {b:?}"
                );
            }
            assert_eq!(joined.undecided, whole.undecided);
        }
    }
    for kind in [FindingKind::Collision, FindingKind::Rapid, FindingKind::Gouge] {
        assert!(kinds.contains(&kind), "{kind:?} was not tried");
    }
    assert!(bodies > 0);
}

#[test]
fn the_first_finding_ends_all_tiles_after_the_same_run() {
    let program = Program::new(900);
    let whole = program.whole(&VerifyOptions::default());
    let all: Vec<usize> = (0..program.case.grid().tiles(20).len()).collect();
    let tiles = program.tiles(20, &all, &VerifyOptions::default().first(true));
    let first = Judgement::of_tiles(&records(tiles.clone()));
    assert!(first.stopped);
    let key = |f: &sweepsim::verify::Finding| (f.number, f.kind, f.body);
    assert_eq!(key(&first.findings[0]), key(&whole.findings[0]));
    // Told where to end, they end there without a finding of their own.
    let until = tiles.iter().filter_map(|tile| tile.record.first()).min();
    assert_eq!(until, Some((0, first.findings[0].number)));
    let told = program.tiles(20, &all, &VerifyOptions::default().until(until));
    for (a, b) in tiles.iter().zip(&told) {
        assert!(a.remaining == b.remaining && a.record == b.record);
    }
    let states = &program.case.states;
    assert!(states.contains(&MoveState::RAPID));
}

#[test]
fn targets_on_tiles_are_parts_of_the_whole() {
    let program = Program::new(901);
    let grid = program.case.grid();
    let whole = Target::new(&program.target, &grid, 0.3, 0.2).unwrap();
    for tile in grid.tiles(11) {
        let (own, part) = (whole.on(&tile).unwrap(), whole.tile(&tile).unwrap());
        assert!(own.solid() == part.solid() && own.core() == part.core() && own.allowed() == part.allowed());
    }
    assert!(whole.tile(&Grid::new([0.0; 2], [1.0; 2], [4, 4]).unwrap()).is_none());
}

#[test]
fn deviations_of_tiles_are_those_of_the_whole() {
    let program = Program::new(903);
    let grid = program.case.grid();
    let done = program.whole(&VerifyOptions::default());
    let [min, max] = program.case.stock;
    let stock = Stock::Block { min, max }.dexels(&grid).unwrap();
    let target = Target::new(&program.target, &grid, 0.3, 0.2).unwrap();
    let whole = deviations(&stock, &done.remaining, &target);
    assert!(whole.gouge.count > 0 && whole.excess.count > 0 && !whole.regions.is_empty());
    for side in [13, 40] {
        let on = |tile: &Grid| {
            let part = |dexels: &Dexels| dexels.tile(tile).unwrap();
            TileDeviation::new(
                &part(&stock),
                &part(&done.remaining),
                &target.tile(tile).unwrap(),
                AreaShare::Whole,
            )
        };
        let tiles: Vec<TileDeviation> = grid.tiles(side).iter().map(on).collect();
        let joined = deviations_along(&[Look {
            tiles: &tiles,
            stock: &stock,
            remaining: &done.remaining,
            target: &target,
        }]);
        assert_eq!(joined.regions, whole.regions);
        for (a, b) in [(joined.gouge, whole.gouge), (joined.excess, whole.excess)] {
            assert_eq!(a.count, b.count);
            // The search for the greatest ends within a ten-thousandth.
            assert!((a.max - b.max).abs() <= 1e-4 * b.max, "{a:?} {b:?}");
            for (a, b) in [(a.mean, b.mean), (a.rms, b.rms), (a.area, b.area)] {
                assert!((a - b).abs() <= 1e-12 * b, "{a} {b}");
            }
        }
    }
}

#[test]
fn tiles_of_other_grids_are_errors() {
    let stock = Stock::Block {
        min: [0.0; 3],
        max: [8.0; 3],
    };
    let on = |size: f64| Scene::new(stock.dexels(&Grid::new([0.0; 2], [size; 2], [8, 8]).unwrap()).unwrap());
    let found = verify_tiles(vec![on(8.0), on(7.0)], &[], &VerifyOptions::default(), &());
    assert!(matches!(found, Err(SweepError::Tiles)));
    assert!(
        verify_tiles(Vec::new(), &[], &VerifyOptions::default(), &())
            .unwrap()
            .is_empty()
    );
}
