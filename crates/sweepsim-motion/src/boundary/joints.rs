//! How the sides of patches join into a closed boundary, and which joints are sharp.
//!
//! Sides are cut where corners of other patches lie on them. The resulting *stretches* must join in pairs and run in
//! opposite directions; a side that joins several others is a T-joint. Two stretches may have different
//! parametrisations of the same curve: then the normals of one are converted to the parameter of the other, as
//! polynomials.
//!
//! Corners lie on sides, and sides along each other, to within the tolerance of the tool.

use super::side_curve::{PLACES, SideCurve};
use super::stretch::JointStretch;
use super::{Edge, Patch, Side, ToolError};
use nalgebra::Vector3;

/// Places in the order of `x`, so that few are compared with each other.
struct InOrder(Vec<(f64, usize)>);

impl InOrder {
    fn new(places: impl Iterator<Item = Vector3<f64>>) -> Self {
        let mut order: Vec<(f64, usize)> = places.enumerate().map(|(number, place)| (place.x, number)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self(order)
    }

    /// The numbers of the places with `low ≤ x ≤ high`, in order.
    fn between(&self, low: f64, high: f64) -> Vec<usize> {
        let from = self.0.partition_point(|(x, _)| *x < low);
        let within = self.0[from..].iter().take_while(|(x, _)| *x <= high);
        let mut numbers: Vec<usize> = within.map(|(_, number)| *number).collect();
        numbers.sort_unstable();
        numbers
    }
}

/// The sides cut at the corners that lie on them.
fn stretches(curves: &[SideCurve], tolerance: f64) -> Vec<JointStretch<'_>> {
    // Every corner begins a side.
    let corners = InOrder::new(curves.iter().map(|curve| curve.places[0]));
    let mut stretches = Vec::with_capacity(curves.len());
    for (number, curve) in curves.iter().enumerate() {
        let ends = [curve.places[0], curve.places[PLACES - 1]];
        let mut cuts: Vec<f64> = Vec::new();
        let [low, high] = curve.bounds.map(|corner| corner.x);
        for other in corners.between(low - tolerance, high + tolerance) {
            if other == number {
                continue;
            }
            let corner = curves[other].places[0];
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
        stretches.extend(
            bounds
                .windows(2)
                .map(|pair| JointStretch::new(curve, [pair[0], pair[1]])),
        );
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
    let starts = InOrder::new(stretches.iter().map(|stretch| stretch.ends()[0]));
    let mut edges = Vec::new();
    for (number, stretch) in stretches.iter().enumerate() {
        // Those that begin where this one ends or, if not backwards, begins.
        let others = |backwards: bool| {
            let start = stretch.ends()[usize::from(backwards)].x;
            let near = starts.between(start - 3.0 * tolerance, start + 3.0 * tolerance);
            let near = near.into_iter().filter(|other| *other != number);
            let stretches = &stretches;
            near.filter(move |other| stretch.runs_along(&stretches[*other], backwards, tolerance))
        };
        let mut joined = others(true);
        let (patch, side) = (stretch.curve.patch, stretch.curve.side);
        let Some(partner) = joined.next() else {
            return Err(match others(false).next() {
                Some(other) => ToolError::Flipped {
                    patch,
                    side,
                    other: stretches[other].curve.patch,
                },
                None => ToolError::Open {
                    patch,
                    side,
                    place: stretch.at(0.5).into(),
                },
            });
        };
        if joined.next().is_some() {
            return Err(ToolError::Branching { patch, side });
        }
        if number < partner {
            edges.extend(stretch.edges(&stretches[partner], tolerance));
        }
    }
    if volume(patches) <= 0.0 {
        return Err(ToolError::InsideOut);
    }
    Ok(edges)
}

/// A multiple of the enclosed volume, by sums over each patch; only its sign matters, so that few points do where they
/// leave no doubt.
fn volume(patches: &[Patch]) -> f64 {
    const FEW: usize = 6;
    const MANY: usize = 24;
    let (sum, sizes) = volume_by(patches, FEW);
    if sum.abs() > 0.25 * sizes {
        return sum;
    }
    volume_by(patches, MANY).0
}

/// The sum over `steps`² quadrangles of each patch, and that of the terms' absolute values.
fn volume_by(patches: &[Patch], steps: usize) -> (f64, f64) {
    let part = |n: usize| n as f64 / steps as f64;
    let (mut sum, mut sizes) = (0.0, 0.0_f64);
    let (mut before, mut row) = (Vec::new(), Vec::new());
    for patch in patches {
        for i in 0..=steps {
            row.clear();
            row.extend((0..=steps).map(|j| Vector3::from(patch.point(part(i), part(j)))));
            if i > 0 {
                for (lower, upper) in before.windows(2).zip(row.windows(2)) {
                    let [a, d, b, c]: [Vector3<f64>; 4] = [lower[0], lower[1], upper[0], upper[1]];
                    let term = (a + b + c + d).dot(&(c - a).cross(&(d - b)));
                    sum += term;
                    sizes += term.abs();
                }
            }
            std::mem::swap(&mut before, &mut row);
        }
    }
    (sum, sizes)
}
