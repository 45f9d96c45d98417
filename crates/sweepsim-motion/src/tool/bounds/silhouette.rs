//! How wide a surface is at some heights.

use super::slivers::Sliver;

/// The radii at a height between which the surface is, about.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub height: f64,
    pub near: f64,
    pub far: f64,
}

/// A surface is looked at in about so many heights, evenly spaced; and in, above and below as many ends of its parts.
const SAMPLES: usize = 512;

/// Samples from below. What is higher by a `unit` is above.
pub(super) fn silhouette(surface: &[Sliver], unit: f64) -> Vec<Sample> {
    let mut ends: Vec<f64> = surface.iter().flat_map(Sliver::heights).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let (Some(low), Some(high)) = (ends.first().copied(), ends.last().copied()) else {
        return Vec::new();
    };
    let even = (1..SAMPLES).map(|k| low + (high - low) * k as f64 / SAMPLES as f64);
    let some = ends.iter().step_by(ends.len().div_ceil(SAMPLES));
    let around = some.flat_map(|end| [end - unit, *end, end + unit]);
    let mut heights: Vec<f64> = even.chain(around).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let none = |height: f64| Sample {
        height,
        near: f64::INFINITY,
        far: f64::NEG_INFINITY,
    };
    let mut all: Vec<Sample> = heights.into_iter().map(none).collect();
    // What is level has two radii, and is no wall.
    for own in surface.iter().filter(|own| own.heights()[0] < own.heights()[1]) {
        let [from, to] = own.heights();
        let first = all.partition_point(|sample| sample.height < from);
        for sample in all[first..].iter_mut().take_while(|sample| sample.height <= to) {
            let at = [sample.height; 2];
            sample.near = own.near_between(at).map(|p| p[0]).fold(sample.near, f64::min);
            sample.far = own.far_between(at).map(|p| p[0]).fold(sample.far, f64::max);
        }
    }
    all.retain(|sample| sample.near.is_finite());
    all
}
