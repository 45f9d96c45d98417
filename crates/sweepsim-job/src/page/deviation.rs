//! The distance of the part's surface from the target.

use rayon::prelude::*;
use sweepsim::verify::Target;
use sweepsim_dexel::Dexels;
use sweepsim_formats::Report;
use sweepsim_report::{Bar, Histogram, measure};

/// Bars of the histogram.
const BARS: usize = 48;
/// The histogram reaches as far as so many times the limits.
const REACH: f64 = 6.0;

/// The distances of all ends.
pub(super) struct Deviated {
    /// Of each interval in the order of the lines: below and above; negative inside the target.
    pub ends: Vec<[f32; 2]>,
    /// Area and distance of each end.
    areas: Vec<[f64; 2]>,
    limits: [f64; 2],
}

impl Deviated {
    pub fn new(dexels: &Dexels, target: &Target) -> Self {
        let grid = *dexels.grid();
        let [dx, dy] = grid.spacing();
        let lines: Vec<usize> = dexels.iter().map(|(line, _)| line).collect();
        let found: Vec<Vec<[(f64, f64); 2]>> = lines
            .par_iter()
            .map(|line| {
                let (i, j) = grid.place(*line);
                let distance = |end: sweepsim_dexel::End| {
                    let place = grid.frame().to_world([grid.x(i), grid.y(j), end.z]);
                    let near = target.distance().nearest(place).map_or(f64::NAN, |near| near.distance);
                    // Of a steep wall, at most a thousand cells.
                    (near, dx * dy / f64::from(end.normal[2].abs()).max(1e-3))
                };
                let pieces = dexels.at(*line);
                pieces
                    .iter()
                    .map(|piece| [distance(piece.lower), distance(piece.upper)])
                    .collect()
            })
            .collect();
        let ends = found.iter().flatten().map(|ends| ends.map(|(near, _)| near as f32));
        let areas = found.iter().flatten().flatten().map(|(near, area)| [*near, *area]);
        Self {
            ends: ends.collect(),
            areas: areas.collect(),
            limits: target.limits(),
        }
    }

    /// The area by deviation.
    pub fn histogram(&self, report: &Report) -> Option<Histogram> {
        let known = || self.areas.iter().filter(|[near, _]| near.is_finite());
        let [least, greatest] = known().fold([0.0_f64; 2], |[a, b], [near, _]| [a.min(*near), b.max(*near)]);
        let [gouge, excess] = self.limits;
        // Beyond the limits, as far as there is something, but not too far.
        let from = least.clamp(-REACH * gouge, -1.5 * gouge);
        let to = greatest.clamp(1.5 * excess, REACH * excess);
        let width = (to - from) / BARS as f64;
        if width.is_nan() || width <= 0.0 {
            return None;
        }
        let mut bars: Vec<Bar> = (0..BARS)
            .map(|n| Bar {
                from: from + n as f64 * width,
                to: from + (n + 1) as f64 * width,
                area: 0.0,
            })
            .collect();
        for [near, area] in known() {
            // A cast of a negative number gives 0.
            let bar = ((near - from) / width) as usize;
            bars[bar.min(BARS - 1)].area += area;
        }
        let beyond = [report.gouge, report.excess].map(|side| side.map_or(0.0, |side| side.area));
        let note = format!(
            "Beyond the limits: {} mm² too deep, {} mm² too high.",
            measure(beyond[0]),
            measure(beyond[1])
        );
        Some(Histogram {
            bars,
            limits: self.limits,
            note,
        })
    }
}
