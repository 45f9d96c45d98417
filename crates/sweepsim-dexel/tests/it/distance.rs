use crate::common::{dot, sub};
use sweepsim_dexel::internals::nearest_on;
use sweepsim_dexel::*;
use sweepsim_props::*;

proptest! {
    /// The distance to a box has a formula.
    #[test]
    fn distances_to_a_box(p in [-4.0..7.0_f64, -4.0..7.0, -4.0..7.0]) {
        let (min, max) = ([-1.0, 0.0, 0.5], [3.0, 2.0, 4.5]);
        let near = DistanceTo::new(&TriangleSoup::block(min, max)).unwrap().nearest(p).unwrap();
        let out = [0, 1, 2].map(|k| (min[k] - p[k]).max(p[k] - max[k]));
        let beyond = out.iter().map(|c| c.max(0.0).powi(2)).sum::<f64>().sqrt();
        let within = out.iter().copied().fold(f64::NEG_INFINITY, f64::max).min(0.0);
        prop_assert!((near.distance - beyond - within).abs() < 1e-12, "{near:?}");
    }
}

/// A solid with corners of all kinds, convex and not, against all its triangles one after the other and against its
/// dexels.
#[test]
fn the_tree_finds_what_all_triangles_have() {
    let part = |min: [f64; 3], max: [f64; 3]| Stock::Block { min, max };
    let solid = Stock::Difference(
        part([-4.1; 3], [4.2; 3]).into(),
        vec![part([-1.0; 3], [5.0; 3]), part([-9.0, 1.0, -2.0], [9.0, 3.0, -1.0])],
    );
    let mesh = TriDexels::new([-5.0; 3], [5.0; 3], [20; 3], &solid)
        .unwrap()
        .surface()
        .unwrap();
    let soup = mesh.soup().unwrap();
    let tree = DistanceTo::new(&soup).unwrap();
    let (mut state, mut sides) = (9_u64, [0; 2]);
    for _ in 0..2000 {
        let p = [0; 3].map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 * 12.0 - 6.0
        });
        let near = tree.nearest(p).unwrap();
        let slow = soup.triangles.iter().map(|t| {
            let off = sub(p, nearest_on(p, *t).0);
            dot(off, off)
        });
        let slow = slow.fold(f64::INFINITY, f64::min).sqrt();
        assert!((near.distance.abs() - slow).abs() < 1e-12);
        let beside = |axis: usize, low: f64, high: f64| low < p[axis] && p[axis] < high;
        let inside = (0..3).all(|k| beside(k, -4.1, 4.2))
            && !(0..3).all(|k| p[k] > -1.0)
            && !(beside(1, 1.0, 3.0) && beside(2, -2.0, -1.0));
        assert!(
            inside == (near.distance < 0.0) || near.distance.abs() < 1e-9,
            "{p:?} {near:?}"
        );
        sides[usize::from(inside)] += 1;
    }
    assert!(sides.iter().all(|n| *n > 300), "{sides:?}");
}

#[test]
fn furthest_points_are_those_of_the_shapes() {
    let (small, large) = (
        TriangleSoup::block([0.0; 3], [4.0; 3]),
        TriangleSoup::block([0.0, 0.0, -0.5], [4.0, 4.0, 6.0]),
    );
    let (place, near) = DistanceTo::new(&small).unwrap().furthest(&large, 0.1).unwrap();
    // Samples between the corners are rounded.
    assert!(
        (place[2] - 6.0).abs() < 1e-14 && (near.distance - 2.0).abs() < 1e-14,
        "{place:?} {near:?}"
    );
    let (_, back) = DistanceTo::new(&large).unwrap().furthest(&small, 0.1).unwrap();
    // The middle of the small one's top is 2 away from the sides and from the top.
    assert!((back.distance + 2.0).abs() < 0.06, "{back:?}");
    assert!(
        DistanceTo::new(&TriangleSoup::default())
            .unwrap()
            .furthest(&small, 0.1)
            .is_none()
    );
    assert!(
        DistanceTo::new(&small)
            .unwrap()
            .furthest(&TriangleSoup::default(), 0.1)
            .is_none()
    );
    assert!(DistanceTo::new(&small).unwrap().nearest([f64::NAN; 3]).is_none());
}

#[test]
fn sides_of_a_thin_wall_are_told_apart() {
    let tree = DistanceTo::new(&TriangleSoup::block([0.0; 3], [9.0, 9.0, 0.1])).unwrap();
    let p = [4.0, 4.0, 0.3];
    assert!((tree.nearest(p).unwrap().distance - 0.2).abs() < 1e-12);
    let lower = tree.nearest_facing(p, [0.0, 0.0, -1.0], 1.0).unwrap();
    assert_eq!(lower.place[2], 0.0);
    assert!((lower.distance + 0.3).abs() < 1e-12);
    assert!(tree.nearest_facing(p, [0.0, 0.0, -1.0], 0.25).is_none());
}

/// Solids that touch, and a flap without thickness: two triangles are as near, with the same on both sides.
#[test]
fn sides_are_right_where_triangles_lie_on_each_other() {
    // Two blocks that touch in a part of a face are one solid.
    let boxes = [[[0.0; 3], [2.0, 3.0, 4.0]], [[2.0, 0.5, 0.5], [3.0, 2.5, 3.5]]];
    let mut triangles: Vec<[[f64; 3]; 3]> = boxes
        .iter()
        .flat_map(|[min, max]| TriangleSoup::block(*min, *max).triangles)
        .collect();
    // A flap upon the first.
    let flap = [[1.0, 1.0, 4.0], [1.0, 2.0, 4.0], [1.0, 1.5, 7.0]];
    triangles.extend([flap, [flap[0], flap[2], flap[1]]]);
    let tree = DistanceTo::new(&TriangleSoup { triangles }).unwrap();
    let mut counts = [0; 2];
    for n in 0..20_usize.pow(3) {
        let p = [n % 20, n / 20 % 20, n / 400].map(|k| (k as f64 - 3.3) * 0.31);
        let inside = boxes
            .iter()
            .any(|[min, max]| (0..3).all(|k| p[k] > min[k] && p[k] < max[k]));
        let near = tree.nearest(p).unwrap();
        assert_eq!(near.distance < 0.0, inside, "{p:?}: {near:?}");
        let shared = (near.place[0] - 2.0).abs() < 1e-12 || (near.place[0] - 1.0).abs() < 1e-12;
        counts[usize::from(inside)] += i32::from(shared);
    }
    assert!(counts[0] > 100 && counts[1] > 100, "{counts:?}");
}

/// A sheet without thickness that hangs from an edge of a block, into it or out of it: around its own edges, normals
/// cancel each other.
#[test]
fn folds_have_the_side_of_what_is_around_them() {
    for (tip, is_inside) in [([1.0, 1.0, 1.0], true), ([1.0, 3.0, 3.0], false)] {
        let mut soup = TriangleSoup::block([0.0; 3], [2.0; 3]);
        let [a, b] = [[0.0, 2.0, 2.0], [2.0, 2.0, 2.0]];
        soup.triangles.extend([[a, b, tip], [b, a, tip]]);
        let tree = DistanceTo::new(&soup).unwrap();
        for off in [
            [0.0, -0.1, 0.02],
            [0.11, 0.0, -0.07],
            [-0.1, 0.03, -0.1],
            [0.0, 0.1, -0.13],
        ] {
            let p = [0, 1, 2].map(|k| tip[k] + off[k]);
            let near = tree.nearest(p).unwrap();
            assert_eq!(near.distance < 0.0, is_inside, "{p:?}: {near:?}");
        }
    }
}
