//! Tools that are known between solids of revolution only: of free-form patches, and with concave outlines.

use crate::certificates::{certified, checked};
use crate::standing::left_of;
use crate::walls::{LIFT, TIPS, extruded};
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{Path, Pose, Profile, ProfileSegment, Tool, Turn};
use sweepsim_proof::{Cutter, Limits, Target, cover_and_cores, deepest};

const LIMITS: Limits = Limits::new(0.02, 0.002, 500_000);
/// Where something is wrong, that is seen soon.
const ROUGH: Limits = Limits::new(0.02, 0.002, 50_000);
/// The stock is a slice.
const X: [f64; 2] = [-2.0, 2.0];
/// Of the concave arc, about half a micrometre from its chords.
const CHORDS: usize = 60;

/// A cutter with a neck above its flat end and a fillet above that; and the target's section, with its tip at 2.
fn filleted() -> (Tool, Vec<[f64; 2]>) {
    let line = |rho, zeta| ProfileSegment::Line { to: [rho, zeta] };
    let fillet = ProfileSegment::Arc {
        to: [5.0, 3.0],
        centre: [5.0, 1.0],
        turn: Turn::Cw,
    };
    let segments = vec![line(3.0, 0.0), line(3.0, 1.0), fillet, line(5.0, 30.0), line(0.0, 30.0)];
    let tool = Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"));
    let on_arc = |k: usize| {
        let angle = std::f64::consts::PI - std::f64::consts::FRAC_PI_2 * k as f64 / CHORDS as f64;
        [5.0 + 2.0 * angle.cos(), 3.0 + 2.0 * angle.sin()]
    };
    let mut right = vec![[3.0, 2.0]];
    right.extend((0..=CHORDS).map(on_arc));
    right.push([5.0, 10.0]);
    (tool, right)
}

/// A cutter with a reflex corner.
fn stepped() -> (Tool, Vec<[f64; 2]>) {
    let line = |[rho, zeta]: [f64; 2]| ProfileSegment::Line { to: [rho, zeta] };
    let corners = [[3.0, 0.0], [3.0, 2.0], [5.0, 4.0], [5.0, 30.0], [0.0, 30.0]];
    let segments = corners.map(line).to_vec();
    let tool = Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"));
    (tool, vec![[3.0, 2.0], [3.0, 4.0], [5.0, 6.0], [5.0, 10.0]])
}

/// The block with the slot that a cutter leaves.
fn slot(right: &[[f64; 2]]) -> TriangleSoup {
    let mut section = vec![[-20.0, -10.0], [20.0, -10.0], [20.0, 10.0]];
    section.extend(right.iter().rev());
    section.extend(right.iter().map(|[y, z]| [-y, *z]));
    section.push([-20.0, 10.0]);
    extruded(&section, X)
}

/// What is right is proven, and accepted by a checker; what is 0.1 mm too deep or too high is found.
fn judged(tool: &Tool, right: &[[f64; 2]]) {
    let target = slot(right);
    let at = |off: f64| TIPS.map(|[x, y, z]| [x, y, z + off]);
    let path = |off: f64| {
        let poses = at(off).map(|tip| Pose::new(tip, [0.0, 0.0, 1.0]).expect("a pose"));
        Path::new(poses.to_vec()).expect("a path")
    };
    let certified = certified(&target, tool, &path(0.0), &LIMITS);
    let checked = checked(&certified.scene, &certified.claim);
    assert!(checked.is_proven() && checked.bound <= LIMITS.depth, "{checked:?}");
    let (solids, low) = (cover_and_cores(tool, 0.01 * LIMITS.depth), path(-0.1));
    let solid = Target::new(&target, LIFT).expect("closed");
    let found = deepest(&solid, &[Cutter::new(&solids, &low, None)], &ROUGH, false, &()).expect("not cancelled");
    let (known, bound) = (found.deepest.map_or(0.0, |(_, deepest)| deepest.depth), found.bound);
    assert!(known > 0.097 && known <= 0.1 + 1e-6 && bound >= 0.1, "{known} {bound}");
    // The helper has each bound checked.
    let highest = |off: f64, limits: &Limits| {
        let found = left_of((X, &target), tool, &at(off), limits);
        (
            found.highest.map_or(0.0, |(_, height)| height),
            found.bound,
            found.open_count,
        )
    };
    let (known, bound, open) = highest(0.0, &LIMITS);
    assert!(
        known <= bound && bound <= LIMITS.depth && open == 0,
        "{known} {bound} {open}"
    );
    let (known, bound, _) = highest(0.1, &ROUGH);
    assert!(known > 0.097 && known <= 0.1 + 1e-6 && bound >= 0.1, "{known} {bound}");
}

#[test]
fn tools_of_patches_are_judged_as_those_of_revolution() {
    let (tool, right) = stepped();
    judged(&tool, &right);
    let patches = Tool::from_patches(tool.patches().to_vec(), 1e-9).expect("the same tool");
    assert!(patches.profile().is_none());
    judged(&patches, &right);
}

#[test]
fn what_concave_outlines_have_removed_counts() {
    let (tool, right) = filleted();
    judged(&tool, &right);
    let patches = Tool::from_patches(tool.patches().to_vec(), 1e-9).expect("the same tool");
    judged(&patches, &right);
}
