use std::sync::Arc;
use sweepsim_dexel::*;

fn grid() -> Grid {
    Grid::new([-10.0, -10.0], [10.0, 10.0], [100, 100]).unwrap()
}

#[test]
fn a_block_and_its_mesh_are_the_same() {
    let (min, max) = ([-5.0, -4.0, 0.0], [5.0, 4.0, 2.5]);
    let block = Stock::Block { min, max }.dexels(&grid()).unwrap();
    let mesh = Stock::Mesh(TriangleSoup::block(min, max)).dexels(&grid()).unwrap();
    assert_eq!(block.volume(), mesh.volume());
    // 50 × 40 cells of 0.2.
    assert!((block.volume() - 200.0).abs() < 1e-9);
}

#[test]
fn the_axis_of_a_cylinder_may_have_any_length() {
    let cylinder = |length: f64| Stock::Cylinder {
        base: [0.0; 3],
        axis: [0.0, length, length],
        radius: 1.0,
        height: 2.0,
    };
    let dexels = cylinder(1.0).dexels(&grid()).unwrap();
    for length in [5e-324, 1e-300, 1e-160, 1e160, 1e300] {
        assert_eq!(cylinder(length).dexels(&grid()).unwrap(), dexels, "{length}");
        assert_eq!(cylinder(length).bounds(), cylinder(1.0).bounds(), "{length}");
    }
    assert!(cylinder(0.0).bounds().is_none() && cylinder(0.0).dexels(&grid()).is_err());
}

#[test]
fn cylinders_of_all_directions_have_their_volume() {
    for axis in [
        [0.0, 0.0, 2.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.3, -0.4, 0.5],
        [0.3, 0.9, -1e-3],
    ] {
        let length = f64::sqrt(axis.iter().map(|c| c * c).sum());
        // Centred at the origin.
        let base = axis.map(|c| -c / length * 3.0);
        let dexels = Stock::Cylinder {
            base,
            axis,
            radius: 2.0,
            height: 6.0,
        }
        .dexels(&grid())
        .unwrap();
        let exact = std::f64::consts::PI * 4.0 * 6.0;
        // The midpoint rule on cells of 0.2, for a height that ends like a square root: under 2 %.
        assert!(
            (dexels.volume() - exact).abs() < 0.02 * exact,
            "{axis:?}: {}",
            dexels.volume()
        );
        for (_, line) in dexels.iter() {
            for interval in line {
                assert!(interval.lower.normal[2] <= 0.0 && interval.upper.normal[2] >= 0.0);
            }
        }
    }
}

#[test]
fn stock_is_put_together() {
    let block = |min, max| Stock::Block { min, max };
    let (a, b) = (block([-5.0; 3], [5.0; 3]), block([0.0; 3], [7.0; 3]));
    let volume = |stock: &Stock| stock.dexels(&grid()).unwrap().volume();
    let close = |stock: Stock, expected: f64| assert!((volume(&stock) - expected).abs() < 1e-9, "{stock:?}");
    close(Stock::Union(vec![a.clone(), b.clone()]), 1000.0 + 343.0 - 125.0);
    close(Stock::Intersection(vec![a.clone(), b.clone()]), 125.0);
    close(
        Stock::Difference(Box::new(a.clone()), vec![b.clone(), b.clone()]),
        875.0,
    );
    close(Stock::Union(Vec::new()), 0.0);
    close(Stock::Intersection(Vec::new()), 0.0);
    let earlier = Stock::Dexels(Arc::new(a.dexels(&grid()).unwrap()));
    close(Stock::Difference(Box::new(earlier.clone()), vec![b]), 875.0);
    let other = Grid::new([0.0; 2], [1.0; 2], [3, 3]).unwrap();
    assert_eq!(earlier.dexels(&other), Err(StockError::Grid(GridMismatch)));
}

#[test]
fn bad_stock_is_refused() {
    let bad = Stock::Block {
        min: [0.0; 3],
        max: [1.0, 0.0, 1.0],
    }
    .dexels(&grid());
    assert!(matches!(bad, Err(StockError::Block { .. })));
    let mut open = TriangleSoup::block([0.0; 3], [1.0; 3]);
    open.triangles.pop();
    assert!(matches!(
        Stock::Mesh(open).dexels(&grid()),
        Err(StockError::Mesh(MeshError::Open { edges: 3, .. }))
    ));
    let mut inside_out = TriangleSoup::block([-5.0; 3], [5.0; 3]);
    for corners in &mut inside_out.triangles {
        corners.swap(0, 1);
    }
    assert!(matches!(
        Stock::Mesh(inside_out).dexels(&grid()),
        Err(StockError::Tangled { .. })
    ));
    let nothing = Stock::Cylinder {
        base: [0.0; 3],
        axis: [0.0; 3],
        radius: 1.0,
        height: 1.0,
    }
    .dexels(&grid());
    assert!(matches!(nothing, Err(StockError::Cylinder { .. })));
}

/// On the lines of any grid, a placed solid is where its own solid is, seen from the frame.
#[test]
fn placed_solids_are_where_the_frame_puts_them() {
    let frames = [
        Frame::new([1.0, -2.0, 3.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap(),
        Frame::new([1.0, -2.0, 3.0], [0.3, -0.5, 1.0], [1.0, 0.2, 0.1]).unwrap(),
    ];
    let block = |min, max| Stock::Block { min, max };
    let solid = Stock::Difference(
        Stock::Union(vec![
            block([-6.0, -5.0, -3.0], [6.0, 5.0, 2.0]),
            Stock::Mesh(TriangleSoup::block([4.0, 3.0, 1.0], [7.0, 6.0, 4.0])),
        ])
        .into(),
        vec![
            Stock::Cylinder {
                base: [-2.0, 0.0, -9.0],
                axis: [0.2, 0.0, 3.0],
                radius: 1.5,
                height: 20.0,
            },
            Stock::Ball {
                centre: [3.0, -3.0, 2.0],
                radius: 2.0,
            },
            Stock::Intersection(vec![
                block([-9.0, -9.0, 0.0], [0.0, 9.0, 9.0]),
                block([-9.0, 2.0, -9.0], [9.0, 9.0, 9.0]),
            ]),
        ],
    );
    let inside = |[x, y, z]: [f64; 3]| {
        let within = |min: [f64; 3], max: [f64; 3]| {
            [x, y, z]
                .iter()
                .zip(min.iter().zip(max))
                .all(|(c, (a, b))| a < c && *c < b)
        };
        let whole = within([-6.0, -5.0, -3.0], [6.0, 5.0, 2.0]) || within([4.0, 3.0, 1.0], [7.0, 6.0, 4.0]);
        // The distance from a line through (−2, 0, −9) along (0.2, 0, 3); its disks are far away.
        let along = (0.2 * (x + 2.0) + 3.0 * (z + 9.0)) / (0.04 + 9.0);
        let drilled = (x + 2.0 - 0.2 * along).hypot(y).hypot(z + 9.0 - 3.0 * along) < 1.5;
        let scooped = (x - 3.0).hypot(y + 3.0).hypot(z - 2.0) < 2.0;
        let notched = x < 0.0 && z > 0.0 && y > 2.0;
        whole && !drilled && !scooped && !notched
    };
    // No line in a wall.
    let grid = Grid::new([-10.013, -9.987], [10.009, 10.017], [30, 30]).unwrap();
    for frame in frames {
        let dexels = solid.placed(&frame).unwrap().dexels(&grid).unwrap();
        assert!(dexels.volume() > 100.0);
        for i in 0..30 {
            for j in 0..30 {
                for k in -100..100 {
                    let z = 0.137 * f64::from(k) + 0.011;
                    let found = dexels.intervals(i, j).heights().any(|[low, high]| low < z && z < high);
                    let own = frame.from_world([grid.x(i), grid.y(j), z]);
                    assert_eq!(found, inside(own), "{own:?}");
                }
            }
        }
    }
    let dexels = Stock::Dexels(block([0.0; 3], [1.0; 3]).dexels(&grid).unwrap().into());
    assert_eq!(dexels.placed(&frames[0]), None);
    assert_eq!(dexels.placed(&Frame::WORLD), Some(dexels));
}
