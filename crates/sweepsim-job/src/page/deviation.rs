//! The distance of the part's surface from the target.

use crate::base::cache::Digest;
use crate::session::Session;
use rayon::prelude::*;
use sweepsim::verify::Target;
use sweepsim_dexel::{Dexels, End};
use sweepsim_formats::Report;
use sweepsim_report::{Bar, Histogram, measure};

/// Bars of the histogram.
const BARS: usize = 48;
/// The histogram reaches as far as so many times the limits.
const REACH: f64 = 6.0;

/// So many lines are known together to a later run.
const TOGETHER: usize = 512;

/// Distances that were kept.
fn read(bytes: &[u8]) -> Vec<f64> {
    let all = bytes.as_chunks().0.iter();
    all.map(|own| f64::from_le_bytes(*own)).collect()
}

/// The distances of all ends.
pub(super) struct Deviated {
    /// Of each interval in the order of the lines: below and above; negative inside the target.
    pub ends: Vec<[f32; 2]>,
    /// Area and distance of each end.
    areas: Vec<[f64; 2]>,
    limits: [f64; 2],
}

impl Deviated {
    pub fn new(session: Session, dexels: &Dexels, target: &Target) -> Self {
        let grid = *dexels.grid();
        let [dx, dy] = grid.spacing();
        let lines: Vec<usize> = dexels.iter().map(|(line, _)| line).collect();
        let ends = |line: usize| {
            let pieces = dexels.at(line);
            let ends = pieces.iter().flat_map(|piece| [piece.lower, piece.upper]);
            ends.collect::<Vec<End>>()
        };
        let measured = |lines: &[usize]| -> Vec<f64> {
            let all = lines.iter().flat_map(|line| {
                let (i, j) = grid.place(*line);
                ends(*line).into_iter().map(move |end| {
                    let place = grid.frame().to_world([grid.x(i), grid.y(j), end.z]);
                    target.distance().nearest(place).map_or(f64::NAN, |near| near.distance)
                })
            });
            all.collect()
        };
        let of = |lines: &[usize]| {
            let Some(cache) = session.cache() else {
                return measured(lines);
            };
            let (mut digest, mut count) = (Digest::of("deviation").bytes(&session.digests().1).value(&grid), 0);
            for line in lines {
                let heights: Vec<f64> = ends(*line).iter().map(|end| end.z).collect();
                count += heights.len();
                digest = digest.number(*line).number(heights.len()).floats(&heights);
            }
            let key = digest.key();
            let known = cache.get(&key).map(read);
            known.filter(|known| known.len() == count).unwrap_or_else(|| {
                let found = measured(lines);
                cache.put(key, found.iter().flat_map(|near| near.to_le_bytes()).collect());
                found
            })
        };
        let found: Vec<Vec<f64>> = lines.par_chunks(TOGETHER).map(of).collect();
        // Of a steep wall, at most a thousand cells.
        let area = |end: End| dx * dy / f64::from(end.normal[2].abs()).max(1e-3);
        let areas = lines.iter().flat_map(|line| ends(*line)).map(area);
        let near = || found.iter().flatten().copied();
        let pairs: Vec<f32> = near().map(|near| near as f32).collect();
        Self {
            ends: pairs.as_chunks().0.to_vec(),
            areas: near().zip(areas).map(|(near, area)| [near, area]).collect(),
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
