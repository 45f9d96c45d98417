//! Loops in the parameters of a surface: simple, and one around the others.

use crate::chart::{Chart, wrapped};
use crate::edges::Placed;
use crate::parts::Use;
use crate::surface::Surface;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The most points of a face whose loops are looked at for crossings.
const MOST: usize = 60_000;

/// Where edges of a face cross, if that is why there is none.
pub(super) type Crossing = Option<Vector3<f64>>;

/// A point of a loop in parameters, and in space.
type Point = ([f64; 2], Vector3<f64>);

/// The order of the loops with the outer one first, and the range of each parameter.
///
/// # Errors
/// They do not bound one face.
pub(super) fn outer_first(
    chart: &Chart,
    outward: bool,
    loops: &[Vec<Use>],
    placed: &Placed,
) -> Result<(Vec<usize>, [[f64; 2]; 2]), Crossing> {
    let mut polygons: Vec<Vec<[f64; 2]>> = Vec::with_capacity(loops.len());
    let mut places: Vec<Vector3<f64>> = Vec::new();
    for own in loops {
        let points = polygon(chart, own, placed).ok_or(None)?;
        places.extend(points.iter().map(|(_, place)| *place));
        polygons.push(points.into_iter().map(|(uv, _)| uv).collect());
    }
    // All in the turn of the first.
    let periodic = chart.periodic();
    for k in 0..2 {
        if !periodic[k] {
            continue;
        }
        let middle = |polygon: &[[f64; 2]]| polygon.iter().map(|p| p[k]).sum::<f64>() / polygon.len() as f64;
        let largest = polygons
            .iter()
            .max_by(|a, b| spread(a, k).total_cmp(&spread(b, k)))
            .ok_or(None)?;
        let about = middle(largest);
        for polygon in &mut polygons {
            let own = middle(polygon);
            let shift = wrapped(own - about) - (own - about);
            polygon.iter_mut().for_each(|p| p[k] += shift);
        }
    }
    let sign = if outward { 1.0 } else { -1.0 };
    let areas: Vec<f64> = polygons.iter().map(|polygon| sign * area(polygon)).collect();
    let outer: Vec<usize> = (0..areas.len()).filter(|k| areas[*k] > 0.0).collect();
    let [outer] = outer[..] else { return Err(None) };
    let scale = chart.scale();
    let scaled: Vec<Vec<[f64; 2]>> = polygons
        .iter()
        .map(|polygon| polygon.iter().map(|p| [p[0] * scale[0], p[1] * scale[1]]).collect())
        .collect();
    if let Some(side) = crosses(&scaled) {
        return Err(Some(places[side]));
    }
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for p in polygons.iter().flatten() {
        for k in 0..2 {
            range[k] = [range[k][0].min(p[k]), range[k][1].max(p[k])];
        }
    }
    if (0..2).any(|k| periodic[k] && range[k][1] - range[k][0] >= 2.0 * PI) {
        return Err(None);
    }
    let inner = (0..loops.len()).filter(|k| *k != outer);
    Ok(([outer].into_iter().chain(inner).collect(), range))
}

fn spread(polygon: &[[f64; 2]], k: usize) -> f64 {
    let range = polygon
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
            [low.min(p[k]), high.max(p[k])]
        });
    range[1] - range[0]
}

/// A loop in parameters that do not jump; `None` if it does not come back to itself.
fn polygon(chart: &Chart, own: &[Use], placed: &Placed) -> Option<Vec<Point>> {
    let mut points = Vec::new();
    for (edge, forward) in own {
        let edge = placed.edges[*edge as usize].as_ref()?;
        let mut samples = edge.samples();
        if !forward {
            samples.push(edge.ends[1]);
            samples.reverse();
            samples.pop();
        }
        points.extend(samples.into_iter().map(|p| (chart.uv(p), p)));
    }
    let pointed = matches!(chart.surface, Surface::Analytic(_));
    if !pointed && points.iter().any(|(uv, _)| uv[0].is_none()) {
        return None;
    }
    // Beginning after a point without an angle, such as the tip of a cone, which then closes the loop.
    if let Some(tip) = points.iter().position(|(uv, _)| uv[0].is_none()) {
        points.rotate_left(tip + 1);
    }
    let periodic = chart.periodic();
    let mut last: [Option<f64>; 2] = [None; 2];
    let mut polygon: Vec<Point> = Vec::with_capacity(points.len());
    for (p, place) in &points {
        let mut own = [0.0; 2];
        for k in 0..2 {
            own[k] = match (p[k], last[k]) {
                (Some(value), Some(before)) if periodic[k] => before + wrapped(value - before),
                (Some(value), _) => value,
                (None, Some(before)) => before,
                (None, None) => 0.0,
            };
            last[k] = Some(own[k]);
        }
        polygon.push((own, *place));
    }
    let ((first, _), (last, _)) = (polygon.first()?, polygon.last()?);
    // At the tip of a cone, angles end and begin again.
    let closes = (0..2).all(|k| {
        points.last().is_some_and(|(uv, _)| uv[k].is_none()) || (first[k] - last[k]).abs() < PI || !periodic[k]
    });
    closes.then_some(polygon)
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let [x, y] = polygon[0];
    let pairs = (1..polygon.len()).map(|k| (polygon[k - 1], polygon[k]));
    0.5 * pairs
        .map(|(a, b)| (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y))
        .sum::<f64>()
}

/// A side of the polygons that another crosses, counted through all of them.
fn crosses(polygons: &[Vec<[f64; 2]>]) -> Option<usize> {
    let mut sides: Vec<([f64; 2], [f64; 2], usize)> = Vec::new();
    for polygon in polygons {
        let next = polygon.iter().cycle().skip(1);
        let before = sides.len();
        let pairs = polygon.iter().zip(next).enumerate();
        sides.extend(pairs.map(|(k, (from, to))| (*from, *to, before + k)));
    }
    if sides.len() > MOST {
        return None;
    }
    let low = |side: &([f64; 2], [f64; 2], usize)| side.0[0].min(side.1[0]);
    let high = |side: &([f64; 2], [f64; 2], usize)| side.0[0].max(side.1[0]);
    sides.sort_by(|a, b| low(a).total_cmp(&low(b)));
    for (k, one) in sides.iter().enumerate() {
        for two in &sides[k + 1..] {
            if low(two) > high(one) {
                break;
            }
            let outside =
                one.0[1].max(one.1[1]) < two.0[1].min(two.1[1]) || two.0[1].max(two.1[1]) < one.0[1].min(one.1[1]);
            if !outside && cross((one.0, one.1), (two.0, two.1)) {
                return Some(one.2);
            }
        }
    }
    None
}

/// Whether two sides cross in the inside of both.
fn cross((a, b): ([f64; 2], [f64; 2]), (c, d): ([f64; 2], [f64; 2])) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let size = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).abs() + (q[1] - p[1]).abs();
    // Below rounding of points that are made in different ways, they touch.
    let least = 1e-9 * size(a, b) * size(c, d) + 1e-14;
    let [x, y] = [side(a, b, c), side(a, b, d)];
    let [z, w] = [side(c, d, a), side(c, d, b)];
    let opposite = |s: f64, t: f64| s.abs() > least && t.abs() > least && (s > 0.0) != (t > 0.0);
    opposite(x, y) && opposite(z, w)
}
