//! What a comparison reports of the distances between two surfaces.

use super::faces::by_face;
use sweepsim_dexel::{Surface, SurfaceDeviations};
use sweepsim_formats::{ComparisonReport, DeviationSummary, HistogramBar, SurfaceDeviation, TargetFaces};

/// Bars of the histogram.
const BARS: usize = 20;

/// Compares the surfaces of a part and of its target, both ways, and fills in the report; by face if the target has
/// any.
pub(super) fn describe(
    report: &mut ComparisonReport,
    [part, target]: [&Surface<'_>; 2],
    faces: Option<&TargetFaces>,
    spacing: f64,
) {
    let tolerance = report.tolerance;
    let of_part = part.deviations_from(target, spacing, tolerance);
    // A point of the target outside the part: there the part is missing.
    let of_target = target.missing_from(part, spacing, tolerance);
    let largest = |sides: [Option<sweepsim_dexel::DeviationAt>; 2]| {
        let sides = sides.into_iter().flatten();
        sides.fold([0.0_f64; 2], |[least, most], at| {
            [least.max(at.least), most.max(at.most)]
        })
    };
    report.gouge = side(&of_part, -1.0, largest([of_part.inside, of_target.outside]), tolerance);
    report.excess = side(&of_part, 1.0, largest([of_part.outside, of_target.inside]), tolerance);
    if let Some(faces) = faces {
        report.faces = by_face(target, faces, [&of_part, &of_target], tolerance);
    }
    report.histogram = histogram(&samples(&of_part));
    (report.of_part, report.of_target) = (one_way(&of_part), one_way(&of_target));
}

fn one_way(found: &SurfaceDeviations) -> SurfaceDeviation {
    let mut one = SurfaceDeviation::default();
    (one.largest, one.place) = (found.largest(), found.place());
    (one.mean, one.rms, one.area) = (found.mean, found.rms, found.area);
    one
}

/// Of each point that stands for an area, its distance nearest to 0, and the area.
fn samples(found: &SurfaceDeviations) -> Vec<(f64, f64)> {
    let points = found.points.iter().filter(|point| point.area > 0.0);
    points
        .map(|point| (point.distance.nearest_to_0(), point.area))
        .collect()
}

/// The samples on one side that are certainly beyond the tolerance.
fn side(found: &SurfaceDeviations, sign: f64, [least, most]: [f64; 2], tolerance: f64) -> DeviationSummary {
    let mut all = DeviationSummary::default();
    all.max = least;
    all.at_most = (most > least).then_some(most);
    let beyond = samples(found)
        .into_iter()
        .map(|(distance, area)| (sign * distance, area));
    for (distance, area) in beyond.filter(|(distance, _)| *distance > tolerance) {
        all.mean += area * distance;
        all.rms += area * distance * distance;
        all.area += area;
        all.count += 1;
    }
    if all.area > 0.0 {
        all.mean /= all.area;
        all.rms = (all.rms / all.area).sqrt();
    }
    all
}

/// Areas in equal ranges of distance, from the lowest to the highest.
fn histogram(samples: &[(f64, f64)]) -> Vec<HistogramBar> {
    let distances = samples.iter().map(|(distance, _)| *distance);
    let ends = distances.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], d| {
        [low.min(d), high.max(d)]
    });
    if samples.is_empty() {
        return Vec::new();
    }
    let [low, high] = ends;
    let step = (high - low) / BARS as f64;
    let limit = |k: usize| low + step * k as f64;
    let bar = |k| HistogramBar {
        from: limit(k),
        to: limit(k + 1),
        area: 0.0,
    };
    let mut bars: Vec<HistogramBar> = (0..BARS).map(bar).collect();
    for (distance, area) in samples {
        // Where all are the same, 0 / 0 is the first bar.
        let k = ((distance - low) / step) as usize;
        bars[k.min(BARS - 1)].area += area;
    }
    bars
}
