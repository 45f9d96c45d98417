//! Tools that are shorter than their cut is deep: the material above them stays, as a roof.

use super::paths::named;
use crate::base::words::{length, point};
use std::collections::BTreeMap;
use sweepsim_dexel::{Dexels, End, Source};
use sweepsim_formats::{Job, JobPath};
use sweepsim_motion::Segment;

/// The cosine between the tool's axis and the normal of the roof is at least this: the rim of a leaning tool makes one,
/// too, but no wall beside it.
const ABOVE: f64 = 0.3;

/// A point of the tool counts as its end within this part of its reach: more than rounded times amount to.
const CLOSE: f64 = 1e-3;

/// The number of parts that times of sources are rounded to, at worst.
const TIMES: f64 = 65536.0;

/// Lower ends of material that the upper end of a tool has made, by path: the first one and their number.
pub(super) fn roofs(job: &Job, remaining: &Dexels) -> Vec<String> {
    let (grid, frame) = (remaining.grid(), remaining.grid().frame());
    let mut found: BTreeMap<u32, ([f64; 3], u64)> = BTreeMap::new();
    let mut known: Option<(u32, u32, Vec<Segment>)> = None;
    for (line, intervals) in remaining.iter() {
        let (i, j) = grid.place(line);
        for interval in intervals.iter() {
            let Source::Cut { path, segment, t } = interval.lower.source else {
                continue;
            };
            let Some(cut) = job.paths.get(path as usize) else {
                continue;
            };
            if known.as_ref().is_none_or(|(p, s, _)| (*p, *s) != (path, segment)) {
                known = Some((path, segment, segments(job, cut, segment)));
            }
            let Some((.., parts)) = &known else { continue };
            let End { z, normal, .. } = interval.lower;
            let place = frame.to_world([grid.x(i), grid.y(j), z]);
            let outward = frame.turn_to_world(normal.map(f64::from));
            if is_end(job, cut, parts, f64::from(t), (place, outward)) {
                found.entry(path).or_insert((place, 0)).1 += 1;
            }
        }
    }
    let sentence = |(path, (place, lines)): (u32, ([f64; 3], u64))| {
        let number = job.paths[path as usize].tool;
        let share = lines as f64 * grid.spacing()[0] * grid.spacing()[1];
        format!(
            "tool {number} is {} mm long, and goes deeper than that in {}: a roof of {} mm² stays above it, at {} for one; give it its whole length, or describe its shank among `bodies` and run `verify`",
            length(job.tools[&number].bounding_cylinder().z[1]),
            named(job, path as usize),
            length(share),
            point(place)
        )
    };
    found.into_iter().map(sentence).collect()
}

fn segments(job: &Job, path: &JobPath, number: u32) -> Vec<Segment> {
    let tool = &job.tools[&path.tool];
    if number as usize >= path.path.moves() {
        return Vec::new();
    }
    // Enough to tell the end of the tool from its sides.
    let deviation = 0.1 * CLOSE * tool.reach();
    path.path.segments(number as usize, tool.reach(), deviation)
}

/// Whether the upper end of the tool touches a point of the surface of the material, whose outward normal is given, at
/// a time of a move.
fn is_end(job: &Job, path: &JobPath, parts: &[Segment], time: f64, (place, outward): ([f64; 3], [f64; 3])) -> bool {
    let tool = &job.tools[&path.tool];
    let scaled = time * parts.len() as f64;
    let Some(part) = parts.get((scaled as usize).min(parts.len().saturating_sub(1))) else {
        return false;
    };
    let local = (scaled - (scaled.floor()).min(parts.len() as f64 - 1.0)).clamp(0.0, 1.0);
    let Some((turn, tip)) = part.try_at(part.at_time(local)) else {
        return false;
    };
    let along = |v: [f64; 3]| (0..3).map(|k| turn[(k, 2)] * v[k]).sum::<f64>();
    let [from, to] = part.tips();
    let length = (0..3).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt();
    let close = CLOSE * tool.reach() + length / TIMES;
    let height = along([0, 1, 2].map(|k| place[k] - tip[k]));
    let away = along(outward);
    away < -ABOVE && height > tool.bounding_cylinder().z[1] - close
}
