//! A certificate that nobody's prover makes.

use crate::certificates::certified;
use crate::walls::LIMITS;
use sweepsim_check::packed;
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{Move, Path, Pose, TipArc, Tool};

/// A disc in the middle of a plate is 0.58 mm deep. Far from all of the surface, it could pass as far above it.
#[test]
fn what_is_deep_inside_is_not_far_above() {
    let plate = TriangleSoup::block([-4.0, -4.0, -1.2], [4.0, 4.0, 0.0]);
    let tool = Tool::flat(0.4, 0.04).expect("a tool");
    let poses = [-0.1, 0.1].map(|x| Pose::new([x, 0.0, -0.62], [0.0, 0.0, 1.0]).expect("a pose"));
    // Along an arc, which is followed within a deviation.
    let arc = TipArc::new([0.0, 0.0, -0.62], [0.0, 0.0, 1.0], std::f64::consts::PI).expect("half a circle");
    let path = Path::with_moves(poses.to_vec(), vec![Move::arc(arc)]).expect("a path");
    let mut certified = certified(&plate, &tool, &path, &LIMITS);
    certified.check(0.58);
    let (centre, half) = certified.claim.root;
    let (mut bytes, mut leaves) = (Vec::new(), 0);
    // Each cell that the disc may reach is said to be below it.
    forge(centre, half, &mut bytes, &mut leaves);
    assert!(leaves > 8);
    certified.claim.trees[0].bytes = packed(&bytes);
    certified.claim.witness = None;
    for bound in [0.0, 1e-9, 1e-6, 1e-3, 0.5] {
        certified.claim.bound = bound;
        let checked = certified.checked();
        assert!(!checked.is_proven() && checked.nodes > leaves, "{bound}: {checked:?}");
    }
}

/// A tree of cells, down to where only one side of the plate is near: all that the disc may reach are lifted up.
fn forge(centre: [f64; 3], half: f64, bytes: &mut Vec<u8>, leaves: &mut usize) {
    if half < 0.26 {
        *leaves += 1;
        bytes.extend([6, 0]);
        bytes.extend(
            [0.0_f32, 0.0, if centre[2] < -0.6 { 1.0 } else { -1.0 }]
                .iter()
                .flat_map(|c| c.to_le_bytes()),
        );
        return;
    }
    let parts = (0..8).map(|octant: usize| {
        let of = |k: usize| centre[k] + if octant >> k & 1 == 0 { -0.5 * half } else { 0.5 * half };
        [of(0), of(1), of(2)]
    });
    let disc = [[-1.0, 1.0], [-1.0, 1.0], [-0.63, -0.57]];
    let reached = |c: &[f64; 3]| (0..3).all(|k| c[k] - 0.5 * half <= disc[k][1] && c[k] + 0.5 * half >= disc[k][0]);
    let all: Vec<[f64; 3]> = parts.collect();
    let mask = (0..8).filter(|k| reached(&all[*k])).fold(0_u8, |mask, k| mask | 1 << k);
    bytes.extend([1, mask]);
    for part in all.iter().filter(|part| reached(part)) {
        forge(*part, 0.5 * half, bytes, leaves);
    }
}
