//! Tests of what is not public.

use crate::depth::Cell;
use crate::height::Patch;
use crate::scene::Curve;
use crate::surface::Surface;
use crate::tool::{Body, bodies, bridged, cores};
use crate::vector::{dot, unit};
use std::f64::consts::FRAC_PI_2;
use std::sync::atomic::Ordering;

#[test]
fn a_tetrahedron_has_an_inside() {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let triangles = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
    let surface = Surface::new(&triangles).expect("closed");
    assert_eq!(surface.is_outside(&[0.1, 0.1, 0.1]), Some(false));
    assert_eq!(surface.is_outside(&[0.5, 0.5, 0.5]), Some(true));
    assert_eq!(surface.is_outside(&[-0.1, 0.1, 0.1]), Some(true));
    let (distance, near, _) = surface.nearest(&[0.1, 0.2, 0.3]);
    assert!(distance <= 0.1 && distance > 0.1 - 1e-14 && near == [0.0, 0.2, 0.3]);
    assert!(Surface::new(&triangles[1..]).is_err());
    // Inside out: nothing is inside.
    let surface = Surface::new(&triangles.map(|[a, b, c]| [a, c, b])).expect("closed");
    assert_eq!(surface.is_outside(&[0.1, 0.1, 0.1]), Some(true));
}

/// A block of 8 with a thin notch that leans: its edge is the nearest of what is below it, and what is beyond that is
/// inside, too.
#[test]
fn depths_end_in_notches_that_lean() {
    let outline = [
        [-4.0, -4.0],
        [4.0, -4.0],
        [4.0, 4.0],
        [3.05, 4.0],
        [0.0, 0.0],
        [3.0, 4.0],
        [-4.0, 4.0],
    ];
    let at = |k: usize, y: f64| [outline[k % 7][0], y, outline[k % 7][1]];
    let mut triangles = Vec::new();
    for k in 0..7 {
        let [a, b, c, d] = [at(k, -4.0), at(k + 1, -4.0), at(k + 1, 4.0), at(k, 4.0)];
        triangles.extend([[a, c, b], [a, d, c]]);
        if ![3, 4].contains(&k) {
            triangles.extend([[at(4, -4.0), a, b], [at(4, 4.0), c, d]]);
        }
    }
    let surface = Surface::new(&triangles).expect("closed");
    let middle = [-1.0, 0.0, 0.2];
    assert_eq!(surface.is_outside(&middle), Some(false));
    let cell = Cell::root(middle, 0.125, 0.1, &surface);
    let depth = 1.04_f64.sqrt();
    let bound = cell.depth_by_middle(&surface) - 3_f64.sqrt() * 0.125;
    assert!(depth <= bound && bound < depth + 1e-6, "{bound}");
}

/// Memory is for what cells hold: of a double pyramid of 800 triangles, no eighth holds all.
#[test]
fn cells_cost_what_they_hold() {
    let count = 400;
    let at = |k: usize| {
        let (sin, cos) = (4.0 * FRAC_PI_2 * (k % count) as f64 / count as f64).sin_cos();
        [cos, sin, 0.0]
    };
    let sides = (0..count).flat_map(|k| {
        let (a, b) = (at(k), at(k + 1));
        [[a, b, [0.0, 0.0, 1.0]], [b, a, [0.0, 0.0, -1.0]]]
    });
    let surface = Surface::new(&sides.collect::<Vec<_>>()).expect("closed");
    let left = || surface.cells_left.load(Ordering::Relaxed);
    // Off its axis, at which all triangles meet.
    let (before, root) = (left(), Cell::root([0.5, 0.25, 0.125], 2.0, 0.01, &surface));
    for octant in 0..8 {
        let _ = root.child(octant, &surface).expect("a cell");
    }
    // Sixteen corners count as a cell: as if each eighth held all 2,400 corners, it would be 1,208 of them.
    let taken = before - left();
    assert!((8..604).contains(&taken), "{taken}");
    // No more is taken where nothing is made.
    let _ = root.child(3, &surface).expect("a cell");
    assert_eq!(before - left(), taken);
    surface.cells_left.store(0, Ordering::Relaxed);
    assert!(root.child(3, &surface).is_ok());
    let child = root.child(3, &surface).expect("a cell");
    assert_eq!(child.child(0, &surface).err(), Some("the proof takes too many cells"));
}

/// Between two opposite normals, nobody knows where the middle is. Those of a thin wedge are divided beyond its edge.
#[test]
fn opposite_normals_are_not_divided() {
    let normal = unit(&[0.6, 0.64, 0.48]).expect("a direction");
    let third = unit(&[0.3, -0.5, 0.2]).expect("a direction");
    for off in [0.0, 1e-14, 1e-9, 1e-7] {
        let opposite = unit(&[-normal[0] + off, -normal[1], -normal[2] - off]).expect("a direction");
        let beyond = unit(&[0, 1, 2].map(|k| normal[k] + opposite[k])).filter(|_| off > 1e-12);
        for normals in [vec![normal, opposite], vec![normal, opposite, third]] {
            let patch = Patch {
                corners: vec![[1.0, 2.0, 3.0]],
                normals: normals.clone(),
                is_flat: false,
            };
            let halves = patch.halves(None, [0, 1]).map(|halves| halves.map(|half| half.normals));
            let parted = beyond.map(|middle| {
                [0, 1].map(|end| {
                    let mut own = normals.clone();
                    own[end] = middle;
                    own
                })
            });
            assert_eq!(halves, parted);
        }
    }
}

/// Every direction is between three of the axes.
#[test]
fn patches_all_around_leave_nothing_out() {
    let patch = Patch {
        corners: vec![[1.0, 2.0, 3.0]],
        normals: Vec::new(),
        is_flat: false,
    };
    let all = patch.all_around();
    assert_eq!(all.len(), 8);
    for signs in 0..8 {
        let direction = [0, 1, 2].map(|k| if signs >> k & 1 == 0 { 0.3 } else { -0.4 });
        let is_between = |part: &&Patch| part.normals.iter().all(|n| dot(n, &direction) > 0.0);
        assert_eq!(all.iter().filter(is_between).count(), 1);
    }
}

fn line(from: [f64; 2], to: [f64; 2]) -> Curve {
    Curve::Bezier(vec![(from, 1.0), (to, 1.0)])
}

/// A bull nose of radius 3 with a corner of 1, 10 high.
fn bull() -> Body {
    let corner = Curve::Arc {
        centre: [2.0, 1.0],
        radius: 1.0,
        angles: [-FRAC_PI_2, 0.0],
    };
    let outline = vec![
        line([0.0, 0.0], [2.0, 0.0]),
        corner,
        line([3.0, 1.0], [3.0, 10.0]),
        line([3.0, 10.0], [0.0, 10.0]),
    ];
    bodies(&outline, &[[4, 1]]).expect("a tool").remove(0)
}

#[test]
fn levels_are_distances_from_a_bull_nose() {
    let (bull, mut counts) = (bull(), [0; 2]);
    for i in 0..90 {
        for j in 0..150 {
            // Also along lines on which sides and corners meet.
            let [rho, zeta] = [f64::from(i) * 0.05, f64::from(j) * 0.1 - 2.0];
            let [right, down] = [rho - 2.0, 1.0 - zeta];
            let own = if right > 0.0 && down > 0.0 {
                right.hypot(down) - 1.0
            } else {
                let [out, up] = [rho - 3.0, (zeta - 10.0).max(-zeta)];
                match out > 0.0 && up > 0.0 {
                    true => out.hypot(up),
                    false => out.max(up),
                }
            };
            let level = bull.level([rho, zeta]).expect("part of a tool");
            assert!((level - own).abs() < 1e-12, "({rho}, {zeta}): {level} {own}");
            counts[usize::from(own > 0.0)] += 1;
        }
    }
    assert!(counts[0] > 5000 && counts[1] > 5000, "{counts:?}");
}

#[test]
fn a_hull_is_not_cut_and_removes_nothing() {
    let hull = vec![Curve::Hull(vec![[1.0, 0.0], [4.0, 2.0], [1.0, 3.0]])];
    let all = bodies(&hull, &[[1, 1]]).expect("a tool");
    assert!(all.len() == 1 && all[0].level([0.0, 1.0]).is_none() && all[0].reach > 4.0);
    assert!(bodies(&hull, &[[1, 2]]).is_err());
    // Nor does what is concave, or falls.
    let hollow = vec![
        line([0.0, 0.0], [1.0, 0.0]),
        line([1.0, 0.0], [0.5, 2.0]),
        line([0.5, 2.0], [2.0, 4.0]),
    ];
    let all = bodies(&hollow, &[[3, 1]]).expect("a tool");
    assert!(all[0].level([0.0, 1.0]).is_none());
}

/// A core holds what is beside it, and nothing leads from it into another.
#[test]
fn a_core_is_convex_and_ends_on_the_axis() {
    let good = vec![[0.0, 0.0], [3.0, 1.0], [3.0, 5.0], [1.0, 6.0], [0.0, 6.0]];
    let all = bridged(cores(&[good.clone(), good.clone()]).expect("cores"));
    assert_eq!(all.len(), 2);
    let level = |rho, zeta| all[0].level([rho, zeta]).expect("a part of the tool");
    assert!((level(2.0, 3.0) + 1.0).abs() < 1e-12 && (level(4.0, 3.0) - 1.0).abs() < 1e-12);
    assert!(level(2.9, 0.9) > 0.0 && level(2.9, 5.3) > 0.0);
    let with = |k: usize, corner: [f64; 2]| {
        let mut bad = good.clone();
        bad[k] = corner;
        cores(&[bad]).is_err()
    };
    // Off the axis, hollow, falling.
    assert!(with(0, [1.0, 0.0]) && with(4, [0.5, 6.0]));
    assert!(with(2, [2.0, 3.0]) && with(1, [3.0, -0.5]) && with(3, [1.0, 4.5]));
    assert!(cores(&[vec![]]).is_err() && cores(&[vec![[0.0, 1.0]]]).is_err());
}

/// What leads from one solid of a tool into the next is a part of the tool, and as wide as it is between them.
#[test]
fn cylinders_between_solids_are_parts_of_the_tool() {
    // A cone on a neck, whose lower end is wider than it (where the cut is) or not; and a disc below it.
    for (neck, wide) in [(3.0, 4.0), (3.0, 3.0), (2.0, 6.0)] {
        let outline = vec![
            line([0.0, 0.0], [6.0, 0.0]),
            line([6.0, 0.0], [wide, 4.0]),
            line([wide, 4.0], [neck, 4.0]),
            line([neck, 4.0], [neck, 9.0]),
            line([neck, 9.0], [5.0, 14.0]),
            line([5.0, 14.0], [0.0, 14.0]),
        ];
        let outline: Vec<Curve> = if wide == neck {
            [&outline[..2], &outline[3..]].concat()
        } else {
            outline
        };
        let below = outline.len() - 3;
        let all = bridged(bodies(&outline, &[[below, 1], [1, 1], [2, 1]]).expect("a tool"));
        assert_eq!(all.len(), 5);
        let radius = |z: f64| match z {
            ..0.0 | 14.0.. => f64::NEG_INFINITY,
            ..4.0 => 6.0 + (wide - 6.0) * z / 4.0,
            ..9.0 => neck,
            _ => neck + (5.0 - neck) * (z - 9.0) / 5.0,
        };
        let mut across = [0; 2];
        for i in 0..70 {
            for j in -10..160 {
                let (rho, z) = (0.1003 * f64::from(i), 0.1007 * f64::from(j));
                let held: Vec<bool> = all
                    .iter()
                    .map(|body| body.level([rho, z]).expect("a part") <= 0.0)
                    .collect();
                assert!(!held.contains(&true) || rho <= radius(z), "{rho} {z} {held:?}");
                for (k, seam) in [4.0, 9.0].into_iter().enumerate() {
                    let is_near = rho < neck - 1e-6 && (z - seam).abs() < 2.0;
                    assert!(!is_near || held[3 + k], "{rho} {z}");
                    across[k] += usize::from(is_near);
                }
            }
        }
        assert!(across.iter().all(|count| *count > 500), "{across:?}");
    }
}
