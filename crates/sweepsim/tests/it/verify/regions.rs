//! Limits by region, against distances by brute force.

use super::Random;
use nalgebra::Vector3;
use sweepsim::prelude::*;
use sweepsim::verify::{DeviationKind, Target, TargetRegion, deviations};
use sweepsim_dexel::TriangleSoup;

type Triangle = [[f64; 3]; 3];

/// A block as 12 triangles, facing outwards.
fn block(min: [f64; 3], max: [f64; 3]) -> TriangleSoup {
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
        .flat_map(|q| [[p(q[0]), p(q[1]), p(q[2])], [p(q[0]), p(q[2]), p(q[3])]]);
    TriangleSoup {
        triangles: triangles.collect(),
    }
}

/// The distance of a point from a triangle: from its plane if it is above it, otherwise from its edges.
fn distance(p: [f64; 3], triangle: &Triangle) -> f64 {
    let p = Vector3::from(p);
    let corners = triangle.map(Vector3::from);
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    let edge = |k: usize| (corners[k], corners[(k + 1) % 3]);
    let above = (0..3).all(|k| {
        let (a, b) = edge(k);
        (b - a).cross(&(p - a)).dot(&normal) >= 0.0
    });
    if above {
        return ((p - corners[0]).dot(&normal) / normal.norm()).abs();
    }
    let to_edge = |k: usize| {
        let (a, b) = edge(k);
        let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (a + (b - a) * t - p).norm()
    };
    (0..3).map(to_edge).fold(f64::INFINITY, f64::min)
}

#[test]
fn what_is_allowed_is_near_a_part_by_the_limit_of_that_part() {
    let mut random = Random::new(7);
    let (mut inside, mut near) = (0, 0);
    for _ in 0..12 {
        let [min, max] = [[-6.03, -5.01, 0.02], [6.07, 4.99, 5.03]];
        let mesh = block(min, max);
        let corner = [0, 1, 2].map(|k| random.within(min[k] - 1.0, max[k]));
        let far = [0, 1, 2].map(|k| corner[k] + random.within(1.0, 8.0));
        let [own, rest] = mesh.split_by_box(corner, far);
        if own.triangles.is_empty() || rest.triangles.is_empty() {
            continue;
        }
        let limits = [0, 1].map(|_| [random.within(0.05, 1.5), random.within(0.05, 1.5)]);
        let parts = [(rest, limits[0]), (own, limits[1])];
        let grid = Grid::new([-8.0, -8.0], [8.0, 8.0], [23, 23]).unwrap();
        let regions = parts
            .clone()
            .map(|(surface, limits)| TargetRegion::new(surface, limits));
        let target = Target::with_regions(&mesh, &grid, regions[0].clone(), &regions[1..]).unwrap();
        assert_eq!(target.limits(), limits[0]);
        for i in 0..23 {
            for j in 0..23 {
                for k in 0..60 {
                    let p = [grid.x(i), grid.y(j), -2.0 + 0.15 * f64::from(k) + 0.0073];
                    // How much nearer to a part it is than that part's limit allows, at most.
                    let spare = |side: usize| {
                        let of = |(part, limits): &(TriangleSoup, [f64; 2])| {
                            let near = part
                                .triangles
                                .iter()
                                .map(|t| distance(p, t))
                                .fold(f64::INFINITY, f64::min);
                            limits[side] - near
                        };
                        parts.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
                    };
                    let within = (0..3).all(|k| min[k] < p[k] && p[k] < max[k]);
                    let has = |dexels: &Dexels| {
                        dexels
                            .intervals(i, j)
                            .heights()
                            .any(|[low, high]| low < p[2] && p[2] < high)
                    };
                    let (gouge, excess) = (spare(0), spare(1));
                    if gouge.abs() > 1e-7 {
                        assert_eq!(has(target.core()), within && gouge < 0.0, "{p:?}");
                        inside += usize::from(within && gouge < 0.0);
                    }
                    if excess.abs() > 1e-7 {
                        assert_eq!(has(target.allowed()), within || excess > 0.0, "{p:?}");
                        near += usize::from(!within && excess > 0.0);
                    }
                }
            }
        }
    }
    assert!(inside > 1000 && near > 1000, "{inside} {near}");
}

/// A block 0.2 too high: more than its left half may be, less than its right half may.
#[test]
fn deviations_go_by_the_limits_of_their_region() {
    let grid = Grid::new([-10.0, -5.0], [10.0, 5.0], [80, 40]).unwrap();
    let mesh = block([-8.0, -4.0, 0.0], [8.0, 4.0, 6.0]);
    let made = Stock::Block {
        min: [-8.0, -4.0, 0.0],
        max: [8.0, 4.0, 6.2],
    }
    .dexels(&grid)
    .unwrap();
    let [left, rest] = mesh.split_by_box([-9.0, -5.0, -1.0], [0.0, 5.0, 7.0]);
    let target = |limits: [f64; 2]| {
        let parts = [
            TargetRegion::new(rest.clone(), [0.5; 2]),
            TargetRegion::new(left.clone(), limits),
        ];
        Target::with_regions(&mesh, &grid, parts[0].clone(), &parts[1..]).unwrap()
    };
    let found = deviations(&made, &made, &target([0.1, 0.1]));
    assert_eq!(found.regions.len(), 1);
    let region = &found.regions[0];
    assert_eq!((region.kind, region.part), (DeviationKind::Excess, 1));
    assert!((region.depth - 0.2).abs() < 1e-6 && region.place[0] < 0.0, "{region:?}");
    // The half, less what is within 0.5 of the right half's surface.
    let expected = 8.0 * (8.0 - (0.25_f64 - 0.04).sqrt());
    assert!(
        (region.area - expected).abs() < 8.0 * 0.25,
        "{} {expected}",
        region.area
    );
    assert_eq!(found.excess.count as f64 * 0.0625, region.area);
    assert!(deviations(&made, &made, &target([0.1, 0.3])).regions.is_empty());
    // The other way round, it is the right half.
    let parts = [
        TargetRegion::new(rest.clone(), [0.1; 2]),
        TargetRegion::new(left.clone(), [0.5; 2]),
    ];
    let other = Target::with_regions(&mesh, &grid, parts[0].clone(), &parts[1..]).unwrap();
    let found = deviations(&made, &made, &other);
    assert_eq!((found.regions.len(), found.regions[0].part), (1, 0));
    assert!(found.regions[0].place[0] > 0.0);
}
