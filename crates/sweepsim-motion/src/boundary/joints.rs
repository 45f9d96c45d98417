//! How the sides of patches join into a closed boundary, and which joints are sharp.
//!
//! Sides are cut where corners of other patches lie on them. The resulting *stretches* must join in pairs and run in opposite directions; a side
//! that joins several others is a T-joint. Two stretches may have different parametrisations of the same curve: then the normals of one are converted
//! to the parameter of the other, as polynomials.
//!
//! Corners lie on sides, and sides along each other, to within the tolerance of the tool.

use super::side_curve::{PLACES, SideCurve};
use super::stretch::JointStretch;
use super::{Edge, Patch, Side, ToolError};
use nalgebra::Vector3;

/// The sides cut at the corners that lie on them.
fn stretches(curves: &[SideCurve], tolerance: f64) -> Vec<JointStretch<'_>> {
    let mut stretches = Vec::with_capacity(curves.len());
    for (number, curve) in curves.iter().enumerate() {
        let ends = [curve.places[0], curve.places[PLACES - 1]];
        let mut cuts: Vec<f64> = Vec::new();
        for (_, other) in curves.iter().enumerate().filter(|(other, _)| *other != number) {
            // Every corner begins a side.
            let corner = other.places[0];
            let at_end = ends.iter().any(|end| (end - corner).norm() <= 2.0 * tolerance);
            if at_end || !curve.may_hold(&corner, tolerance) {
                continue;
            }
            let (r, distance) = curve.nearest(&corner, [0.0, 1.0]);
            let known = cuts
                .iter()
                .any(|cut| (curve.at(*cut) - corner).norm() <= 2.0 * tolerance);
            if distance <= tolerance && !known {
                cuts.push(r);
            }
        }
        cuts.sort_by(f64::total_cmp);
        let bounds: Vec<f64> = std::iter::once(0.0).chain(cuts).chain([1.0]).collect();
        stretches.extend(bounds.windows(2).map(|pair| JointStretch {
            curve,
            range: [pair[0], pair[1]],
            ends: [curve.at(pair[0]), curve.at(pair[1])],
        }));
    }
    stretches
}

/// The sharp edges of a closed boundary.
///
/// # Errors
/// [`ToolError`]: it is not closed, or not consistently oriented.
pub(crate) fn edges(patches: &[Patch], tolerance: f64) -> Result<Vec<Edge>, ToolError> {
    if patches.is_empty() {
        return Err(ToolError::Empty);
    }
    let mut curves: Vec<SideCurve> = (0..patches.len())
        .flat_map(|patch| {
            [Side::Bottom, Side::Right, Side::Top, Side::Left].map(|side| SideCurve::new(patches, patch, side))
        })
        .collect();
    curves.retain(|curve| !curve.is_pole(tolerance));
    let stretches = stretches(&curves, tolerance);
    let mut edges = Vec::new();
    for (number, stretch) in stretches.iter().enumerate() {
        let others = || stretches.iter().enumerate().filter(|(other, _)| *other != number);
        let mut joined = others().filter(|(_, other)| stretch.runs_along(other, true, tolerance));
        let (patch, side) = (stretch.curve.patch, stretch.curve.side);
        let Some((partner, other)) = joined.next() else {
            return Err(
                match others().find(|(_, other)| stretch.runs_along(other, false, tolerance)) {
                    Some((_, other)) => ToolError::Flipped {
                        patch,
                        side,
                        other: other.curve.patch,
                    },
                    None => ToolError::Open {
                        patch,
                        side,
                        place: stretch.at(0.5).into(),
                    },
                },
            );
        };
        if joined.next().is_some() {
            return Err(ToolError::Branching { patch, side });
        }
        if number < partner {
            edges.extend(stretch.edges(other, tolerance));
        }
    }
    if volume(patches) <= 0.0 {
        return Err(ToolError::InsideOut);
    }
    Ok(edges)
}

/// A multiple of the enclosed volume, by sums over each patch; only its sign matters, so that few points do where they leave no doubt.
fn volume(patches: &[Patch]) -> f64 {
    const FEW: usize = 6;
    const MANY: usize = 24;
    let (sum, sizes) = volume_by(patches, FEW);
    if sum.abs() > 0.25 * sizes {
        return sum;
    }
    volume_by(patches, MANY).0
}

/// The sum over `steps`² points of each patch, and that of the terms' absolute values.
fn volume_by(patches: &[Patch], steps: usize) -> (f64, f64) {
    let middle = |n: usize| (n as f64 + 0.5) / steps as f64;
    let h = 0.5 / steps as f64;
    let (mut sum, mut sizes) = (0.0, 0.0_f64);
    for patch in patches {
        for i in 0..steps {
            for j in 0..steps {
                let (u, v) = (middle(i), middle(j));
                let at = |u: f64, v: f64| Vector3::from(patch.point(u, v));
                let along_u = at(u + h, v) - at(u - h, v);
                let along_v = at(u, v + h) - at(u, v - h);
                let term = at(u, v).dot(&along_u.cross(&along_v));
                sum += term;
                sizes += term.abs();
            }
        }
    }
    (sum, sizes)
}
