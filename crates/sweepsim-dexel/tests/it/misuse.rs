//! Misuse of public constructors and operations: errors, never a panic, and nothing that is not sorted and disjoint.

use sweepsim_dexel::{
    Crossing, Dexels, DexelsBuilder, DistanceTo, End, Frame, Grid, Interval, IntervalError, IntervalSet, Mesh,
    Operation, Source, Stock, TriDexels, TriangleSoup, compare, compare_with_mesh, cover,
};
use sweepsim_props::*;

/// Any number, the odd ones often.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(0.0),
        1 => Just(f64::MAX),
        1 => Just(5e-324),
        6 => -3.0..3.0_f64,
        1 => any::<f64>(),
    ]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

/// Limits and cells of a grid, mostly one that can be made.
fn area() -> impl Strategy<Value = ([f64; 2], [f64; 2], [usize; 2])> {
    let any = ([number(), number()], [number(), number()], [0..5_usize, 0..5_usize]);
    let good = (
        [-3.0..3.0_f64, -3.0..3.0],
        [0.1..5.0_f64, 0.1..5.0],
        [1..5_usize, 1..5_usize],
    )
        .prop_map(|(min, size, cells)| (min, [min[0] + size[0], min[1] + size[1]], cells));
    prop_oneof![1 => any, 2 => good]
}

fn end() -> impl Strategy<Value = End> {
    (number(), vector(), any::<Option<(u32, u32)>>(), number()).prop_map(|(z, normal, cut, t)| End {
        z,
        normal: normal.map(|c| c as f32),
        source: cut.map_or(Source::Stock, |(path, segment)| {
            let t = t as f32;
            Source::Cut { path, segment, t }
        }),
    })
}

fn intervals() -> impl Strategy<Value = Vec<Interval>> {
    let interval = (end(), end()).prop_map(|(lower, upper)| Interval { lower, upper });
    let up = (-3.0..3.0_f64, 0.0..1.0_f64).prop_map(|(z, length)| Interval::between(z, z + length));
    collection::vec(prop_oneof![1 => interval, 3 => up], 0..4)
}

fn sorted(dexels: &Dexels) -> bool {
    dexels.iter().all(|(_, line)| {
        let heights: Vec<f64> = line.heights().flatten().collect();
        heights.windows(2).all(|w| w[0] < w[1])
    })
}

fn lengths_are_positive(intervals: &[Interval]) -> bool {
    intervals.iter().all(|i| i.lower.z < i.upper.z)
}

fn in_order(intervals: &[Interval]) -> bool {
    lengths_are_positive(intervals) && intervals.windows(2).all(|w| w[0].upper.z < w[1].lower.z)
}

fn stock() -> impl Strategy<Value = Stock> {
    let triangles = collection::vec([vector(), vector(), vector()], 0..5);
    let leaf = prop_oneof![
        (vector(), vector()).prop_map(|(min, max)| Stock::Block { min, max }),
        (vector(), number()).prop_map(|(centre, radius)| Stock::Ball { centre, radius }),
        (vector(), vector(), number(), number()).prop_map(|(base, axis, radius, height)| Stock::Cylinder {
            base,
            axis,
            radius,
            height
        }),
        triangles.prop_map(|triangles| Stock::Mesh(TriangleSoup { triangles })),
    ];
    leaf.prop_recursive(2, 6, 3, |inner| {
        let list = collection::vec(inner.clone(), 0..3);
        prop_oneof![
            list.clone().prop_map(Stock::Union),
            (inner, list.clone()).prop_map(|(first, others)| Stock::Difference(Box::new(first), others)),
            list.prop_map(Stock::Intersection),
        ]
    })
}

proptest! {
    #[test]
    fn lines_take_nothing_but_intervals(first in intervals(), more in intervals(), line in 0..12_usize, kind in 0..6_usize) {
        let grid = Grid::new([0.0; 2], [3.0, 3.0], [3, 3]).unwrap();
        let mut dexels = Dexels::empty(grid);
        let set = dexels.set(4, &first);
        prop_assert_eq!(set.is_ok(), lengths_are_positive(&first));
        prop_assert!(sorted(&dexels));
        let before = dexels.clone();
        let (done, good) = match kind {
            0 => (dexels.unite(line, &more), in_order(&more)),
            1 => (dexels.subtract(line, &more), in_order(&more)),
            2 => (dexels.intersect(line, &more), in_order(&more)),
            3 => (dexels.set(line, &more), lengths_are_positive(&more)),
            _ => {
                let numbered: Vec<(u32, Interval)> = more.iter().map(|i| (line as u32, *i)).collect();
                let operation = if kind == 4 { Operation::Union } else { Operation::Difference };
                (dexels.update(operation, &numbered), lengths_are_positive(&more))
            }
        };
        let on_grid = line < grid.len() || (kind > 3 && more.is_empty());
        prop_assert_eq!(done.is_ok(), good && on_grid, "{:?}", done);
        if done.is_err() {
            prop_assert_eq!(&dexels, &before);
        }
        prop_assert!(sorted(&dexels));
    }

    #[test]
    fn sets_take_nothing_but_intervals(pieces in collection::vec([number(), number()], 0..5), at in number(), tolerance in number()) {
        let good = pieces.iter().all(|[a, b]| a < b);
        let list = pieces.iter().map(|[lower, upper]| Interval { lower: *lower, upper: *upper });
        match IntervalSet::from_intervals(list) {
            Ok(set) => {
                prop_assert!(good);
                let heights: Vec<f64> = set.pieces().iter().flat_map(|i| [i.lower, i.upper]).collect();
                prop_assert!(heights.windows(2).all(|w| w[0] < w[1]));
                let _ = (set.contains(at), set.merged(tolerance));
            }
            Err(error) => {
                prop_assert!(!good, "{error}");
            }
        }
    }

    #[test]
    fn builders_take_nothing_but_intervals(lines in collection::vec((0..5_usize, intervals()), 0..5)) {
        let grid = Grid::new([0.0; 2], [2.0, 3.0], [2, 3]).unwrap();
        let mut builder = DexelsBuilder::new(grid);
        for (skip, line) in &lines {
            builder.skip(*skip);
            let full = builder.lines() >= grid.len();
            prop_assert_eq!(builder.push(line).is_ok(), lengths_are_positive(line) && !full);
        }
        prop_assert!(sorted(&builder.finish()));
        let all = Dexels::from_fn(grid, |index, out| {
            if let Some((_, line)) = lines.get(index) {
                out.extend(line);
            }
        });
        prop_assert_eq!(all.is_ok(), lines.iter().all(|(_, line)| lengths_are_positive(line)));
    }

    #[test]
    fn crossings_of_anything_are_counted_or_refused(
        heights in collection::vec((number(), -2..3_i8), 0..6), same in number(), line in 0..20_u32,
    ) {
        let crossings: Vec<Crossing> = heights
            .iter()
            .map(|(z, jump)| Crossing { z: *z, jump: *jump, normal: [0.0, 0.0, 1.0], source: Source::Stock })
            .collect();
        let mut intervals = Vec::new();
        if cover(&mut crossings.clone(), same, &mut intervals).is_ok() {
            prop_assert!(heights.iter().all(|(z, _)| z.is_finite()));
        }
        let mut dexels = Dexels::empty(Grid::new([0.0; 2], [3.0, 3.0], [3, 3]).unwrap());
        let numbered: Vec<(u32, Crossing)> = crossings.iter().map(|c| (line, *c)).collect();
        dexels.update_by_crossings(Operation::Union, &numbered, same);
        prop_assert!(sorted(&dexels));
    }

    #[test]
    fn grids_and_frames_of_anything_are_made_or_refused(
        (min, max, cells) in area(),
        origin in vector(), z in vector(), x in vector(), y in vector(),
        (i, j) in (any::<usize>(), any::<usize>()), stock in stock(), point in vector(),
    ) {
        let frames = [Frame::new(origin, z, x).ok(), Frame::from_axes(origin, [x, y, z]).ok(), Some(Frame::WORLD)];
        let grid = Grid::new(min, max, cells);
        // Not even these: no cells, and limits that are no numbers or in the wrong order.
        let good = cells.iter().all(|n| *n > 0) && (0..2).all(|k| min[k] < max[k] && (max[k] - min[k]).is_finite());
        prop_assert!(good || grid.is_err());
        let Ok(grid) = grid else { return Err(TestCaseError::reject("no grid")) };
        for frame in frames.into_iter().flatten() {
            let grid = grid.in_frame(frame);
            let inside = i < grid.cells()[0] && j < grid.cells()[1];
            prop_assert_eq!(grid.index(i, j).is_some(), inside);
            prop_assert_eq!(grid.index(i % 5, j % 5).is_some(), i % 5 < grid.cells()[0] && j % 5 < grid.cells()[1]);
            let _ = Dexels::empty(grid).intervals(i, j).len();
            if let Ok(dexels) = stock.dexels(&grid) {
                prop_assert!(sorted(&dexels));
                let _ = (dexels.nearest_end(point), dexels.source_at(point, point[0]));
                let _ = compare(&dexels, &dexels, point[1]);
            }
        }
    }

    #[test]
    fn solids_of_anything_are_made_or_refused(
        min in vector(), max in vector(), cells in [0..5_usize, 0..5_usize, 0..5_usize], stock in stock(),
    ) {
        if let Ok(solid) = TriDexels::new(min, max, cells, &stock) {
            let _ = (solid.volume(), solid.disagreements(), solid.surface());
        }
        let _ = TriDexels::empty(min, max, cells);
    }

    #[test]
    fn meshes_of_anything_are_used_or_refused(
        // Six are enough for all triangles.
        vertices in prop_oneof![collection::vec(vector(), 0..5), collection::vec(vector(), 6)],
        triangles in collection::vec(any::<[u8; 3]>(), 0..5),
        cosine in number(), point in vector(), reach in number(), spacing in 0.1..9.0_f64,
    ) {
        let mut mesh = Mesh::default();
        mesh.vertices.extend(vertices);
        mesh.triangles.extend(triangles.iter().map(|t| t.map(|v| u32::from(v % 6))));
        let _ = mesh.crisp(cosine);
        let Some(soup) = mesh.soup() else { return Err(TestCaseError::reject("a triangle without its corners")) };
        let _ = (soup.volume(), soup.check_closed(), soup.indexed());
        let distance = DistanceTo::new(&soup).unwrap();
        let _ = (distance.nearest(point), distance.nearest_facing(point, point, reach));
        if soup.triangles.iter().flatten().flatten().all(|c| c.abs() < 10.0) {
            let _ = distance.furthest(&soup, spacing);
        }
        let grid = Grid::new([0.0; 2], [3.0, 3.0], [3, 3]).unwrap();
        let _ = compare_with_mesh(&Dexels::empty(grid), &soup);
    }
}

#[test]
fn reversed_unsorted_and_overlapping_intervals_are_refused() {
    let grid = Grid::new([0.0; 2], [1.0, 1.0], [1, 1]).unwrap();
    let mut dexels = Dexels::empty(grid);
    let reversed = [Interval::between(3.0, 2.0)];
    let unsorted = [Interval::between(4.0, 5.0), Interval::between(1.0, 2.0)];
    let overlapping = [Interval::between(1.0, 3.0), Interval::between(2.0, 4.0)];
    let unknown = [Interval::between(f64::NAN, 1.0)];
    type Change = fn(&mut Dexels, usize, &[Interval]) -> Result<(), IntervalError>;
    let changes: [Change; 3] = [Dexels::unite, Dexels::subtract, Dexels::intersect];
    for change in changes {
        for wrong in [&reversed[..], &unsorted, &overlapping, &unknown] {
            assert!(change(&mut dexels, 0, wrong).is_err(), "{wrong:?}");
        }
        assert_eq!(
            change(&mut dexels, 1, &[]),
            Err(IntervalError::Line { line: 1, lines: 1 })
        );
    }
    assert_eq!(dexels.count(), 0);
    assert_eq!(grid.index(1, 0), None);
    assert_eq!(grid.index(0, usize::MAX), None);
}

/// Of what is 1e300 wide the squares and volumes are infinite, and their differences no numbers.
#[test]
fn a_stock_of_any_size_is_refused_before_its_volume_is_infinite() {
    let grid = Grid::new([0.0; 2], [1.0, 1.0], [2, 2]).unwrap();
    let triangles = |size: f64| {
        let [o, x, y, z] = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
        TriangleSoup {
            triangles: vec![[o, y, x], [o, x, z], [o, z, y], [x, y, z]],
        }
    };
    for size in [1.0, 1e3, 1e12, 1.1e12, 1e160, 1e300, f64::INFINITY] {
        let stocks = [
            Stock::Ball {
                centre: [0.0; 3],
                radius: size,
            },
            Stock::Block {
                min: [-size; 3],
                max: [1.0; 3],
            },
            Stock::Cylinder {
                base: [0.0, 0.0, -size],
                axis: [0.0, 0.0, 1.0],
                radius: 5.0,
                height: size,
            },
            Stock::Cylinder {
                base: [0.0; 3],
                axis: [0.0, 0.0, 1.0],
                radius: size,
                height: 1.0,
            },
            Stock::Mesh(triangles(size)),
        ];
        for stock in stocks {
            match stock.dexels(&grid) {
                Ok(dexels) => assert!(size <= 1e12 && dexels.volume().is_finite(), "{stock:?}"),
                Err(error) => assert!(
                    size > 1e12 && error.to_string().contains(if size.is_finite() { "1e12" } else { "" }),
                    "{error}"
                ),
            }
        }
    }
}
