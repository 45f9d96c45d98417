use sweepsim_dexel::*;
use sweepsim_props::*;

fn grid(cells: [usize; 2]) -> Grid {
    Grid::new([0.0, 0.0], [cells[0] as f64, cells[1] as f64], cells).unwrap()
}

/// Intervals on numbered lines, in any order, overlapping.
fn pieces(lines: u32) -> impl Strategy<Value = Vec<(u32, Interval)>> {
    let piece = (0..lines, 0..40i32, 0..9i32, 0..700u32, 0.0..=1.0_f32);
    collection::vec(piece, 0..90).prop_map(|pieces| {
        let made = |(line, z, length, segment, t): (u32, i32, i32, u32, f32)| {
            let mut interval = Interval::between(f64::from(z), f64::from(z + length));
            interval.upper.source = Source::Cut { path: 3, segment, t };
            (line, interval)
        };
        pieces.into_iter().map(made).collect()
    })
}

const LINES_IN_TEST: u32 = 150;

/// Whether unit cell `k` of a line is covered.
fn covered(pieces: &[(u32, Interval)], line: u32, k: i32) -> bool {
    let z = f64::from(k) + 0.5;
    pieces
        .iter()
        .any(|(at, i)| *at == line && i.lower.z < z && z < i.upper.z)
}

fn inside(dexels: &Dexels, line: u32, k: i32) -> bool {
    let z = f64::from(k) + 0.5;
    dexels
        .at(line as usize)
        .heights()
        .any(|[lower, upper]| lower < z && z < upper)
}

fn apply(operation: Operation, a: bool, b: bool) -> bool {
    match operation {
        Operation::Union => a || b,
        Operation::Difference => a && !b,
        Operation::Intersection => a && b,
    }
}

const OPERATIONS: [Operation; 3] = [Operation::Union, Operation::Difference, Operation::Intersection];

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
    /// All ways to change dexels agree with the model and with each other.
    #[test]
    fn updates_agree_with_the_model(a in pieces(LINES_IN_TEST), b in pieces(LINES_IN_TEST), kind in 0..3usize) {
        let operation = OPERATIONS[kind];
        let grid = grid([15, 10]);
        let filled = |pieces: &[(u32, Interval)]| Dexels::from_fn(grid, |index, line| {
            let own = pieces.iter().filter(|(at, i)| *at as usize == index && i.length() > 0.0);
            line.extend(own.map(|(_, i)| *i));
        }).unwrap();
        let (first, second) = (filled(&a), filled(&b));
        let mut combined = first.clone();
        combined.combine(operation, &second).unwrap();
        let mut updated = first.clone();
        let longer: Vec<(u32, Interval)> = b.iter().copied().filter(|(_, i)| i.length() > 0.0).collect();
        updated.update(operation, &longer).unwrap();
        let mut one_by_one = first.clone();
        for index in 0..grid.len() {
            let line = second.at(index).to_vec();
            match operation {
                Operation::Union => one_by_one.unite(index, &line),
                Operation::Difference => one_by_one.subtract(index, &line),
                Operation::Intersection => one_by_one.intersect(index, &line),
            }
            .unwrap();
        }
        for line in 0..LINES_IN_TEST {
            for k in 0..50 {
                let expected = apply(operation, covered(&a, line, k), covered(&b, line, k));
                prop_assert_eq!(inside(&combined, line, k), expected, "line {} cell {}", line, k);
            }
        }
        prop_assert_eq!(&combined, &updated);
        prop_assert_eq!(&combined, &one_by_one);
        let mut set = Dexels::empty(grid);
        for index in 0..grid.len() {
            set.set(index, &combined.at(index).to_vec()).unwrap();
        }
        prop_assert_eq!(&set, &combined);
        prop_assert_eq!(combined.iter().map(|(_, line)| line.len()).sum::<usize>(), combined.count());
        set.shrink();
        prop_assert_eq!(&set, &combined);
        // Crossings of the same intervals: the same again.
        let crossings: Vec<(u32, Crossing)> = b.iter().filter(|(_, i)| i.length() > 0.0).flat_map(|(line, i)| {
            [(i.lower, 1), (i.upper, -1)].map(|(end, jump)| {
                (*line, Crossing { z: end.z, jump, normal: end.normal, source: end.source })
            })
        }).collect();
        let mut counted = first.clone();
        prop_assert!(counted.update_by_crossings(operation, &crossings, 0.0).is_empty());
        let heights = |dexels: &Dexels| -> Vec<Vec<[f64; 2]>> {
            (0..grid.len()).map(|index| dexels.at(index).heights().collect()).collect()
        };
        prop_assert_eq!(heights(&counted), heights(&combined));
    }
}

#[test]
fn the_same_at_any_thread_count() {
    let grid = grid([40, 40]);
    let many: Vec<(u32, Interval)> = (0..20_000_u32)
        .map(|k| {
            let z = f64::from(k.wrapping_mul(2_654_435_761) >> 20) * 0.01;
            let mut interval = Interval::between(z, z + 0.7);
            interval.lower.source = Source::Cut {
                path: 0,
                segment: k % 3000,
                t: 0.3,
            };
            (k.wrapping_mul(40_503) % 1600, interval)
        })
        .collect();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut dexels = Dexels::empty(grid);
            dexels.update(Operation::Union, &many).unwrap();
            dexels
        })
    };
    assert!(run(1).count() > 1600);
    assert_eq!(run(1), run(3));
}

#[test]
fn beyond_the_grid_there_is_nothing() {
    let mut dexels = Dexels::empty(grid([3, 3]));
    let piece = Interval::between(0.0, 1.0);
    for index in [9, 63, 64, usize::MAX] {
        let wrong = Err(IntervalError::Line { line: index, lines: 9 });
        assert_eq!(dexels.set(index, &[piece]), wrong);
        assert_eq!(dexels.unite(index, &[piece]), wrong);
        assert_eq!(dexels.subtract(index, &[piece]), wrong);
        assert!(dexels.at(index).is_empty());
    }
    for line in [9, u32::MAX] {
        let wrong = dexels.update(Operation::Union, &[(0, piece), (line, piece)]);
        assert!(matches!(wrong, Err(IntervalError::Line { lines: 9, .. })));
    }
    assert_eq!(dexels, Dexels::empty(grid([3, 3])));
    assert_eq!(
        dexels.combine(Operation::Union, &Dexels::empty(grid([3, 2]))),
        Err(GridMismatch)
    );
}

/// The audit names lines whose crossings do not add up, and leaves them.
#[test]
fn failures_are_named() {
    let mut dexels = Dexels::empty(grid([10, 10]));
    let crossing = |z, jump| Crossing {
        z,
        jump,
        normal: [0.0, 0.0, 1.0],
        source: Source::Stock,
    };
    let all = vec![
        (7, crossing(0.0, 1)),
        (3, crossing(1.0, 1)),
        (7, crossing(2.0, -1)),
        (99, crossing(1.0, -1)),
    ];
    let failures = dexels.update_by_crossings(Operation::Union, &all, 0.0);
    assert_eq!(
        failures.iter().map(|(line, f)| (*line, f.sum)).collect::<Vec<_>>(),
        [(3, 1), (99, -1)]
    );
    assert_eq!((dexels.covered(), dexels.volume()), (1, 2.0));
}

#[test]
fn memory_is_as_promised() {
    let grid = grid([2000, 2000]);
    let lines = grid.len();
    let empty = Dexels::empty(grid).bytes();
    assert!(empty <= lines / 4, "{empty} bytes for {lines} lines");
    let block = Stock::Block {
        min: [0.0; 3],
        max: [2000.0, 2000.0, 5.0],
    };
    let dexels = block.dexels(&grid).unwrap();
    assert_eq!(dexels.count(), lines);
    let per_line = dexels.bytes() as f64 / lines as f64;
    println!(
        "a dexel of a block takes {per_line:.2} bytes, an empty one {:.3}",
        empty as f64 / lines as f64
    );
    assert!(per_line <= 32.0 + 5.25, "{per_line}");
    // 10,000 × 10,000 of them.
    assert!(per_line * 1e8 <= 6.0 * 1024.0_f64.powi(3));
    // Lines without material among others.
    let mut half = dexels;
    for index in (0..lines).step_by(2) {
        half.set(index, &[]).unwrap();
    }
    half.shrink();
    assert!(half.bytes() <= lines / 2 * 32 + 21 * lines / 4, "{}", half.bytes());
    // Growing one by one wastes little.
    let mut grown = Dexels::empty(*half.grid());
    for index in 0..lines {
        grown.set(index, &[Interval::between(0.0, 1.0)]).unwrap();
    }
    assert!(grown.bytes() <= lines * (32 + 5 + 4), "{}", grown.bytes());
}

#[test]
fn a_removal_that_takes_nothing_leaves_faces_what_they_are() {
    let grid = grid([3, 1]);
    let block = |height: f64| {
        let mut piece = Interval::between(0.0, height);
        piece.upper.normal = [0.6, 0.0, 0.8];
        piece
    };
    let stock = Dexels::from_fn(grid, |_, line| line.extend([block(5.0), Interval::between(7.0, 8.0)])).unwrap();
    let cut = |from: f64, to: f64| {
        let mut piece = Interval::between(from, to);
        let source = Source::Cut {
            path: 1,
            segment: 2,
            t: 0.5,
        };
        (piece.lower.source, piece.upper.source) = (source, source);
        piece
    };
    // Along both faces of the gap and a hair beyond; deeper than the tolerance; a slot in the middle.
    let cuts = [
        (0, cut(5.0 - 1e-7, 7.0 + 1e-7)),
        (1, cut(5.0 - 1e-5, 7.0 + 1e-5)),
        (2, cut(2.0, 3.0)),
    ];
    let mut plain = stock.clone();
    plain.update(Operation::Difference, &cuts).unwrap();
    let mut removed = stock.clone();
    removed.remove(&cuts, 1e-6).unwrap();
    let other = Dexels::from_fn(grid, |index, line| line.push(cuts[index].1)).unwrap();
    let mut all = stock.clone();
    all.remove_all(&other, 1e-6).unwrap();
    assert_eq!(all, removed);
    for line in 0..3 {
        // The heights are those of the cut all the same.
        assert!(removed.at(line).heights().eq(plain.at(line).heights()));
    }
    let kept = removed.at(0).to_vec();
    assert_eq!(kept[0].upper.source, Source::Stock);
    assert_eq!(kept[0].upper.normal, stock.at(0).to_vec()[0].upper.normal);
    assert_eq!(kept[1].lower.source, Source::Stock);
    assert!(plain.at(0).to_vec()[0].upper.source.is_cut());
    let deeper = removed.at(1).to_vec();
    assert!(deeper[0].upper.source.is_cut() && deeper[1].lower.source.is_cut());
    let slot = removed.at(2).to_vec();
    assert_eq!(slot.len(), 3);
    assert!(slot[0].upper.source.is_cut() && slot[1].lower.source.is_cut());
    assert_eq!(slot[1].upper.source, Source::Stock);
    // Without a tolerance, faces that are met exactly stay.
    let mut exact = stock.clone();
    exact.remove(&[(0, cut(5.0, 7.0))], 0.0).unwrap();
    assert_eq!(exact, stock);
}
