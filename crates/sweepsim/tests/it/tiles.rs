//! Grids in tiles: what is found on a line depends on no other tile, and on the division only within the tolerance.

use sweepsim::prelude::*;
use sweepsim::{Method, Simulation, simulate_tiles};
use sweepsim_dexel::{Dexels, Frame, Grid, TilesError};
use sweepsim_props::*;

const TOLERANCE: f64 = 1e-5;

fn paths(seed: &[(f64, f64, f64)]) -> Path {
    let pose = |(k, (a, b, c)): (usize, &(f64, f64, f64))| {
        // Every third move is a translation.
        let lean = if k % 3 == 2 { [0.0; 2] } else { [0.4 * a, 0.4 * b] };
        Pose::new([14.0 * a, 10.0 * b, 3.0 + 2.5 * c], [lean[0], lean[1], 1.0]).unwrap()
    };
    Path::new(seed.iter().enumerate().map(pose).collect()).unwrap()
}

fn stock() -> Stock {
    let block = Stock::Block {
        min: [-10.0, -7.0, 0.0],
        max: [10.0, 7.0, 5.0],
    };
    let hole = Stock::Ball {
        centre: [2.0, 1.0, 0.0],
        radius: 3.0,
    };
    Stock::Difference(block.into(), vec![hole])
}

/// One tile after the other, in an order of its own, on one thread.
fn one_by_one(grid: &Grid, cuts: &[Cut], options: &Options, turn: usize) -> Vec<Simulation> {
    let mut tiles = grid.tiles(options.tile);
    let turn = turn % tiles.len();
    tiles.rotate_left(turn);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let one = |tile: &Grid| simulate_tiles(vec![stock().dexels(tile).unwrap()], cuts, options, &()).unwrap();
    pool.install(|| tiles.iter().flat_map(one).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn tiles_do_not_know_of_each_other(
        seed in collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64), 3..9),
        tool in 0..3_usize,
        method in 0..3_usize,
        framed in any::<bool>(),
        turn in 0..50_usize,
    ) {
        let tools = [Tool::ball(1.5, 12.0), Tool::flat(1.5, 12.0), Tool::bull(1.5, 0.5, 12.0)];
        let tool = tools[tool].clone().unwrap();
        let path = paths(&seed);
        let split = seed.len() / 2;
        let second = paths(&seed[split..]);
        let cuts = [Cut::new(&tool, &path), Cut::new(&tool, &second)];
        let method = [Method::Mixed, Method::Lines, Method::Planes][method];
        let options = Options::new(TOLERANCE).method(method).tile(13);
        let mut grid = Grid::new([-11.0, -8.0], [11.0, 8.0], [44, 32]).unwrap();
        if framed {
            grid = grid.in_frame(Frame::new([0.3, 0.2, 0.1], [0.2, 0.1, 1.0], [1.0, 0.0, 0.0]).unwrap());
        }
        let whole = simulate(stock().dexels(&grid).unwrap(), &cuts, &options, &()).unwrap();
        let parts = one_by_one(&grid, &cuts, &options, turn);
        prop_assert_eq!(parts.iter().map(|part| part.statistics.crossings).sum::<u64>(), whole.statistics.crossings);
        let mut open: Vec<_> = parts.iter().flat_map(|part| part.statistics.unresolved.clone()).collect();
        open.sort_by_key(|open| (open.i, open.j));
        prop_assert_eq!(open, whole.statistics.unresolved.clone());
        let joined = Dexels::from_tiles(grid, parts.into_iter().map(|part| part.remaining).collect()).unwrap();
        // Every bit: heights, normals, sources.
        prop_assert_eq!(&joined, &whole.remaining);
        // The division itself changes nothing beyond the tolerance.
        let undivided = simulate(stock().dexels(&grid).unwrap(), &cuts, &options.clone().tile(1000), &()).unwrap();
        let mut cut = 0;
        for line in 0..grid.len() {
            let (a, b) = (whole.remaining.at(line).to_vec(), undivided.remaining.at(line).to_vec());
            prop_assert_eq!(a.len(), b.len(), "line {}", line);
            for (a, b) in a.iter().zip(&b) {
                prop_assert!((a.lower.z - b.lower.z).abs() <= TOLERANCE && (a.upper.z - b.upper.z).abs() <= TOLERANCE);
                cut += usize::from(a.upper.source != sweepsim_dexel::Source::Stock);
            }
        }
        // Nothing cut would prove nothing.
        prop_assume!(cut > 20);
    }
}

/// Between two posts there is no material: some methods work column by column.
#[test]
fn columns_without_material_are_left_out_by_every_method() {
    let post = |x: f64| Stock::Block {
        min: [x, -3.0, 0.0],
        max: [x + 2.0, 3.0, 5.0],
    };
    let grid = Grid::new([-8.0, -4.0], [8.0, 4.0], [32, 16]).unwrap();
    let stock = Stock::Union(vec![post(-6.0), post(2.0)]).dexels(&grid).unwrap();
    let at = |x: f64, y: f64| Pose::new([x, y, 3.0], [0.2, 0.1, 1.0]).unwrap();
    let path = Path::new(vec![at(-7.0, -1.0), at(7.0, 1.0)]).unwrap();
    let tool = Tool::ball(1.5, 12.0).unwrap();
    let run = |method| {
        let options = Options::new(TOLERANCE).method(method);
        simulate(stock.clone(), &[Cut::new(&tool, &path)], &options, &())
            .unwrap()
            .remaining
    };
    let charts = run(Method::Mixed);
    assert!(stock.volume() - charts.volume() > 10.0);
    for method in [Method::Planes, Method::Lines, Method::Surface, Method::General] {
        assert!((run(method).volume() - charts.volume()).abs() < 1e-3, "{method}");
    }
}

#[test]
fn tiles_of_a_grid_are_joined_only_if_they_are_all_there() {
    let grid = Grid::new([0.0; 2], [5.0, 4.0], [50, 40]).unwrap();
    let tiles: Vec<Dexels> = grid.tiles(16).into_iter().map(Dexels::empty).collect();
    assert_eq!(tiles.len(), 12);
    assert!(Dexels::from_tiles(grid, tiles.clone()).is_ok());
    let mut missing = tiles.clone();
    missing.remove(4);
    assert_eq!(
        Dexels::from_tiles(grid, missing).unwrap_err(),
        TilesError::Missing { i: 12, j: 13 }
    );
    let mut doubled = tiles.clone();
    doubled.push(tiles[4].clone());
    assert_eq!(
        Dexels::from_tiles(grid, doubled).unwrap_err(),
        TilesError::Doubled { i: 12, j: 13 }
    );
    let other = Grid::new([0.0; 2], [5.0, 4.1], [50, 40]).unwrap();
    let mut foreign = tiles.clone();
    foreign[0] = Dexels::empty(other.tile(0..12, 0..13).unwrap());
    assert_eq!(
        Dexels::from_tiles(grid, foreign).unwrap_err(),
        TilesError::Foreign { first: [0, 0] }
    );
    let mixed = vec![tiles[0].clone(), Dexels::empty(other)];
    assert_eq!(
        simulate_tiles(mixed, &[], &Options::default(), &()).unwrap_err(),
        sweepsim::SweepError::Tiles
    );
}
