//! What was read, beside what was expected.

use sweepsim_nc::Program;

pub fn tips(program: &Program) -> Vec<[f64; 3]> {
    program.poses.iter().map(|pose| pose.pose.tip()).collect()
}

/// The same, to nine digits behind the point.
pub fn rounded_tips(program: &Program) -> Vec<[f64; 3]> {
    let round = |c: f64| (c * 1e9).round() / 1e9 + 0.0;
    tips(program).into_iter().map(|tip| tip.map(round)).collect()
}

#[track_caller]
pub fn near(found: [f64; 3], expected: [f64; 3]) {
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    assert!(off.sqrt() < 1e-9, "{found:?}, expected {expected:?}");
}

#[track_caller]
pub fn assert_near(found: &[[f64; 3]], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        near(*found, *expected);
    }
}
