//! Deviations against planted defects.

use super::by_force::box_mesh;
use sweepsim::verify::{DeviationKind, Deviations, Target, deviations};
use sweepsim_dexel::{Dexels, Grid, Stock, TriangleSoup};

const BLOCK: [[f64; 3]; 2] = [[-12.0, -12.0, 0.0], [12.0, 12.0, 12.0]];

fn block() -> Stock {
    let [min, max] = BLOCK;
    Stock::Block { min, max }
}

fn cylinder(radius: f64) -> Stock {
    Stock::Cylinder {
        base: [0.3, -0.2, -1.0],
        axis: [0.0, 0.0, 1.0],
        radius,
        height: 20.0,
    }
}

/// The block with a hole through it, of many sides about a circle.
fn holed(radius: f64, sides: usize) -> TriangleSoup {
    let [min, max] = BLOCK;
    // Polygons of equal area.
    let part = std::f64::consts::TAU / sides as f64;
    let out = radius * (part / part.sin()).sqrt();
    let ring: Vec<[f64; 2]> = (0..sides)
        .map(|n| {
            [
                0.3 + out * (part * n as f64).cos(),
                -0.2 + out * (part * n as f64).sin(),
            ]
        })
        .collect();
    let corners = [[max[0], max[1]], [min[0], max[1]], [min[0], min[1]], [max[0], min[1]]];
    let mut triangles = Vec::new();
    let at = |p: [f64; 2], z: f64| [p[0], p[1], z];
    let mut flat = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        triangles.push([at(a, max[2]), at(b, max[2]), at(c, max[2])]);
        triangles.push([at(a, min[2]), at(c, min[2]), at(b, min[2])]);
    };
    // Each quarter of the ring looks at one corner.
    let quarter = |n: usize| corners[(n % sides) * 4 / sides];
    for n in 0..sides {
        let (a, b) = (ring[n], ring[(n + 1) % sides]);
        flat(a, quarter(n), b);
        if quarter(n) != quarter(n + 1) {
            flat(b, quarter(n), quarter(n + 1));
        }
    }
    for n in 0..sides {
        let (a, b) = (ring[n], ring[(n + 1) % sides]);
        triangles.push([at(a, min[2]), at(a, max[2]), at(b, max[2])]);
        triangles.push([at(a, min[2]), at(b, max[2]), at(b, min[2])]);
    }
    for n in 0..4 {
        let (a, b) = (corners[n], corners[(n + 1) % 4]);
        triangles.push([at(a, min[2]), at(b, max[2]), at(a, max[2])]);
        triangles.push([at(a, min[2]), at(b, min[2]), at(b, max[2])]);
    }
    TriangleSoup { triangles }
}

fn found(part: &Stock, target: &TriangleSoup, cells: usize, limit: f64) -> Deviations {
    let [min, max] = BLOCK;
    let grid = Grid::new([min[0], min[1]], [max[0], max[1]], [cells, cells]).unwrap();
    let dexels = |stock: &Stock| -> Dexels { stock.dexels(&grid).unwrap() };
    let target = Target::new(target, &grid, limit, limit).unwrap();
    deviations(&dexels(&block()), &dexels(part), &target)
}

#[test]
fn holes_of_different_radii() {
    let part = |radius| Stock::Difference(block().into(), vec![cylinder(radius)]);
    // A ring thinner than the distance of lines may come in pieces.
    let wide = found(&part(10.0), &holed(9.9, 720), 241, 0.02);
    assert!((wide.gouge.max - 0.1).abs() < 1e-3, "{:?}", wide.gouge);
    assert!(
        wide.excess.max < 1e-4 && (1..=8).contains(&wide.regions.len()),
        "{wide:?}"
    );
    let narrow = found(&part(9.9), &holed(10.0, 720), 241, 0.02);
    assert!((narrow.excess.max - 0.1).abs() < 1e-3, "{:?}", narrow.excess);
    assert!(
        narrow.gouge.max < 1e-4 && (1..=8).contains(&narrow.regions.len()),
        "{narrow:?}"
    );
    let same = found(&part(10.0), &holed(10.0, 720), 101, 0.02);
    assert!(
        same.gouge.max < 1e-4 && same.excess.max < 1e-4 && same.regions.is_empty(),
        "{same:?}"
    );
}

#[test]
fn slots_webs_and_the_target_itself() {
    let boxed = |min, max| Stock::Block { min, max };
    let slot = boxed([-30.0, -4.0, 7.0], [30.0, 4.0, 20.0]);
    let slotted = Stock::Difference(block().into(), vec![slot]);
    // A slot where none is wanted, and one that is missing.
    let deep = found(&slotted, &box_mesh(BLOCK), 80, 0.05);
    assert!((deep.gouge.max - 5.0).abs() < 1e-3, "{:?}", deep.gouge);
    assert_eq!(deep.regions.len(), 1);
    let region = &deep.regions[0];
    assert!(
        (region.depth - 5.0).abs() < 1e-3 && (region.place[2] - 7.0).abs() < 1e-3,
        "{region:?}"
    );
    assert!(
        (region.volume - 23.9 * 8.0 * 4.95).abs() < 0.03 * region.volume,
        "{region:?}"
    );
    assert!(deep.excess.max < 1e-9);
    // The target itself.
    let itself = found(&block(), &box_mesh(BLOCK), 80, 0.05);
    assert!(
        itself.gouge.max < 1e-9 && itself.excess.max < 1e-9 && itself.regions.is_empty(),
        "{itself:?}"
    );
    // A web of thickness 2 between two pockets: there in the target, cut through in the part.
    let pockets = [
        boxed([-10.0, -10.0, 7.0], [10.0, 10.0, 20.0]),
        boxed([-10.0, -10.0, -9.0], [10.0, 10.0, 5.0]),
    ];
    let webbed = Stock::Difference(block().into(), pockets.to_vec());
    let through = Stock::Difference(block().into(), vec![boxed([-10.0, -10.0, -9.0], [10.0, 10.0, 20.0])]);
    let grid = Grid::new([-12.0, -12.0], [12.0, 12.0], [80, 80]).unwrap();
    let mesh = webbed.dexels(&grid).unwrap().surface().unwrap();
    let target = mesh.soup().unwrap();
    let cut = found(&through, &target, 80, 0.05);
    let web = &cut.regions[0];
    assert_eq!((web.kind, cut.regions.len()), (DeviationKind::Gouge, 1));
    assert!((web.depth - 2.0).abs() < 1e-3, "{web:?}");
    assert!((cut.gouge.max - 2.0).abs() < 1e-3);
}
