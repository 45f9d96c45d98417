//! When, along a stretch of its path, a solid holds a point best, and whether it ever comes near it.

use crate::motion::{Placement, Stretch};
use crate::tool::Level;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// How much a place nearer to the axis counts, beside one that is deeper.
const AXIS: f64 = 0.05;
/// Steps of a search for the best time.
const STEPS: usize = 12;
/// Times at which a motion that turns or bends is looked at first.
const TIMES: usize = 4;
/// A parabola is looked at again in so much shorter a time.
const FINER: f64 = 0.125;
/// Parts of time into which a stretch is divided to tell that a point was missed.
const MOST_PARTS: usize = 500;

/// How far a point is from the axis.
pub(crate) fn from_axis(at: &Placement, point: &Vector3<f64>) -> f64 {
    let off = point - at.tip;
    (off - at.axis * off.dot(&at.axis)).norm()
}

pub(crate) fn level_at(level: &Level, at: &Placement, point: &Vector3<f64>) -> f64 {
    let off = point - at.tip;
    let along = off.dot(&at.axis);
    level.at([(off - at.axis * along).norm(), along])
}

/// Of solids that hold a point as deep, the one whose axis is nearest comes first.
pub(crate) fn order_at(level: f64, at: &Placement, point: &Vector3<f64>) -> f64 {
    level + AXIS * from_axis(at, point)
}

/// A lower bound of that for all times of a stretch: no level and no distance changes faster than the point moves
/// against the solid. Of a straight one, [`quick`] tells as soon.
pub(crate) fn least_order(level: &Level, stretch: &Stretch, point: &Vector3<f64>) -> f64 {
    if stretch.is_straight() {
        return f64::NEG_INFINITY;
    }
    let at = stretch.at(0.5);
    let far = (point - at.tip).norm();
    let travel = stretch.travel(far + stretch.travel(0.0, 0.5), 0.5);
    order_at(level_at(level, &at, point), &at, point) - (1.0 + AXIS) * travel
}

/// A time at which a point is far inside, without a search; and the level then.
pub(crate) fn quick(level: &Level, stretch: &Stretch, point: &Vector3<f64>) -> (f64, f64) {
    let of = |time: f64| (level_at(level, &stretch.at(time), point), time);
    if stretch.is_straight() {
        let [from, to] = &stretch.ends;
        let way = to.tip - from.tip;
        let across = way - from.axis * way.dot(&from.axis);
        let length = across.norm_squared();
        return of(if length > 0.0 {
            ((point - from.tip).dot(&across) / length).clamp(0.0, 1.0)
        } else {
            0.5
        });
    }
    let axis = stretch.ends[0].axis;
    // Of times at which the point is as deep, that with the axis nearest: always the deepest, if the tool moves across
    // its axis.
    let order = |time: f64| {
        if stretch.is_level() {
            let off = point - stretch.tip(time);
            return off.norm_squared() - off.dot(&axis).powi(2);
        }
        let at = stretch.at(time);
        let off = point - at.tip;
        let along = off.dot(&at.axis);
        let across = (off - at.axis * along).norm();
        level.at([across, along]) + AXIS * across
    };
    let step = 1.0 / TIMES as f64;
    let values: [f64; TIMES + 1] = std::array::from_fn(|k| order(k as f64 * step));
    let near = (0..=TIMES)
        .min_by(|a, b| values[*a].total_cmp(&values[*b]))
        .unwrap_or(0);
    let middle = near.clamp(1, TIMES - 1);
    let first = (middle as f64 + least([values[middle - 1], values[middle], values[middle + 1]])) * step;
    of(around(order, first, FINER * step))
}

/// Where, in steps from the middle one, the parabola through three values is least, not beyond the others.
fn least([a, b, c]: [f64; 3]) -> f64 {
    let bend = a - 2.0 * b + c;
    if bend > 0.0 {
        (0.5 * (a - c) / bend).clamp(-1.0, 1.0)
    } else {
        f64::from(i8::from(a > c) - i8::from(a < c))
    }
}

/// About the time at which something is least, near another.
fn around(of: impl Fn(f64) -> f64, time: f64, step: f64) -> f64 {
    let time = time.clamp(step, 1.0 - step);
    let time = time + step * least([time - step, time, time + step].map(of));
    time.clamp(0.0, 1.0)
}

/// About where a function is least that falls, and then rises.
pub(crate) fn lowest(of: impl Fn(f64) -> f64, [mut from, mut to]: [f64; 2], steps: usize) -> f64 {
    for _ in 0..steps {
        let third = (to - from) / 3.0;
        if of(from + third) < of(to - third) {
            to -= third;
        } else {
            from += third;
        }
    }
    0.5 * (from + to)
}

/// Whether a point is so far inside at some time of a straight stretch.
pub(super) fn is_inside(level: &Level, stretch: &Stretch, point: &Vector3<f64>, margin: f64) -> bool {
    let of = |time: f64| level_at(level, &stretch.at(time), point);
    let first = quick(level, stretch, point).0.min(of(0.0)).min(of(1.0));
    narrowed(of, first, STEPS, |least, _| (least <= -margin).then_some(true)).unwrap_or(false)
}

/// Narrows the times in which a convex function is least, until what is known of it will do: the least value that was
/// found, and how long the times are in which there may be a lesser one. `least`: its value at some time.
pub(crate) fn narrowed<T>(
    of: impl Fn(f64) -> f64,
    mut least: f64,
    steps: usize,
    known: impl Fn(f64, f64) -> Option<T>,
) -> Option<T> {
    let (mut from, mut to) = (0.0, 1.0);
    for _ in 0..steps {
        let answer = known(least, to - from);
        if answer.is_some() {
            return answer;
        }
        let third = (to - from) / 3.0;
        let (a, b) = (of(from + third), of(to - third));
        least = least.min(a).min(b);
        if a < b {
            to -= third;
        } else {
            from += third;
        }
    }
    known(least, to - from)
}

/// A time near another at which the outermost of some points is far inside.
pub(super) fn best_time(level: &Level, stretch: &Stretch, points: &[Vector3<f64>], near: f64) -> f64 {
    let of = &|time: f64| {
        let at = stretch.at(time);
        let levels = points.iter().map(|point| level_at(level, &at, point));
        levels.fold(f64::NEG_INFINITY, f64::max)
    };
    let step = 0.5 / TIMES as f64;
    around(of, around(of, near, step), FINER * step)
}

/// Whether a point is outside of a solid all along a stretch, up to a time: levels change no faster than the point
/// moves against it.
pub(crate) fn stays_away(level: &Level, (stretch, latest): (&Stretch, f64), point: &Vector3<f64>, margin: f64) -> bool {
    if stretch.is_straight() && latest == 1.0 {
        return stays_beside(level, stretch, point, margin);
    }
    let mut open: SmallVec<[[f64; 2]; 32]> = SmallVec::new();
    open.push([0.0, latest]);
    let mut left = MOST_PARTS;
    while let Some([from, to]) = open.pop() {
        let middle = 0.5 * (from + to);
        let at = stretch.at(middle);
        let own = level_at(level, &at, point);
        // The point moves against the solid as if it were a point of it.
        let half = 0.5 * (to - from);
        let far = (point - at.tip).norm();
        let travel = stretch.travel(far + stretch.travel(0.0, half), half);
        if own > travel + margin {
            continue;
        }
        if own <= margin || left == 0 {
            return false;
        }
        left -= 1;
        open.extend([[from, middle], [middle, to]]);
    }
    true
}

/// The same along a straight stretch. There the level is convex: its least value is in the interval that is left.
fn stays_beside(level: &Level, stretch: &Stretch, point: &Vector3<f64>, margin: f64) -> bool {
    // It is never nearer to the axis than this, and its height along it changes evenly: by little, on most stretches.
    let [start, end] = &stretch.ends;
    let (off, way) = (point - start.tip, end.tip - start.tip);
    let rise = way.dot(&start.axis);
    let [off_across, way_across] = [off, way].map(|v| v - start.axis * v.dot(&start.axis));
    let part = off_across.dot(&way_across) / way_across.norm_squared().max(f64::MIN_POSITIVE);
    let nearest = (off_across - way_across * part.clamp(0.0, 1.0)).norm();
    if level.at([nearest, off.dot(&start.axis) - 0.5 * rise]) > 0.5 * rise.abs() + margin {
        return true;
    }
    let of = |time: f64| level_at(level, &stretch.at(time), point);
    let first = quick(level, stretch, point).0;
    let known = |least: f64, times: f64| {
        let is_away = least > margin + stretch.travel(0.0, times);
        (least <= margin || is_away).then_some(is_away)
    };
    narrowed(of, first, 4 * STEPS, known).unwrap_or(false)
}
