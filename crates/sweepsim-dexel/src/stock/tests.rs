use super::*;

fn grid() -> Grid {
    Grid::new([-10.0, -10.0], [10.0, 10.0], [100, 100]).unwrap()
}

/// A box as 12 triangles, facing outwards.
fn cube(min: [f64; 3], max: [f64; 3]) -> TriangleSoup {
    let p = |k: usize| [0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] });
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .iter()
        .flat_map(|q| [[p(q[0]), p(q[1]), p(q[2])], [p(q[0]), p(q[2]), p(q[3])]])
        .collect();
    TriangleSoup { triangles }
}

#[test]
fn a_block_and_its_mesh_are_the_same() {
    let (min, max) = ([-5.0, -4.0, 0.0], [5.0, 4.0, 2.5]);
    let block = Stock::Block { min, max }.dexels(&grid()).unwrap();
    let mesh = Stock::Mesh(cube(min, max)).dexels(&grid()).unwrap();
    assert_eq!(block.volume(), mesh.volume());
    // 50 × 40 cells of 0.2.
    assert!((block.volume() - 200.0).abs() < 1e-9);
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
    let mut open = cube([0.0; 3], [1.0; 3]);
    open.triangles.pop();
    assert!(matches!(
        Stock::Mesh(open).dexels(&grid()),
        Err(StockError::Mesh(MeshError::Open { edges: 3, .. }))
    ));
    let mut inside_out = cube([-5.0; 3], [5.0; 3]);
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
