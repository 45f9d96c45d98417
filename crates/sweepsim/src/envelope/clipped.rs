//! The part of a cell where some lines can be, where lines that nearly touch the face stay where they are in the tool.
//!
//! If a tool turns about a line that touches it, halving a cell about the point of contact takes as many steps as the distance of the line from there has bits. But in
//! a direction `n` that is fixed in the tool and across the line, `⟨n, F⟩ = ⟨A n, D⟩` (see [`absent`](super::absent)) has a small range whatever the height: with weights
//! `w`, the form `w⟨n, F⟩` less `w` times the upper end of the range is not positive, nor is its counterpart for the lower end. The smallest coefficients in each
//! row of such a form are those of a polynomial in one variable that is nowhere larger, and where this one is positive the line is absent. So a few steps
//! lead to the scale of the distance: to its square root along the line where it touches, and to the distance itself across it.

use crate::algebra::ranges::products;
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::absent::{Range, arm, middle_normal, seen};
use crate::envelope::enclosures::{Brick, Size};
use crate::time::pieces::Times;
use nalgebra::Vector3;
use smallvec::SmallVec;
use sweepsim_spline::kernel::restrict_rectangle;

type Form = SmallVec<[f64; 16]>;

/// A part is wider than the rounding of coordinates by this factor.
const ROUNDINGS: f64 = 1024.0;
/// Its new faces are farther out by this share of it.
const MARGIN: f64 = 1e-3;
/// Rounds of all directions and sides.
const ROUNDS: usize = 4;
/// The next round is worth it if one has left at most this share.
const PROGRESS: f64 = 0.5;

/// The sides of the part of a cell outside which no point is on any of the lines, whose coordinates have these ranges.
pub(super) fn clipped(
    (element, cells): (&PatchForms, &Cells),
    (times, size): (&Times, &Size),
    (cell, piece): Brick,
    lines: [Range; 2],
) -> Option<[Range; 2]> {
    let points = cells.position(element, cell);
    let upright = times.rows(piece, 2);
    let along = Vector3::from(upright[upright.len() / 2]).try_normalize(0.0)?;
    let normal = Vector3::from(middle_normal(element, cells, cell)?);
    let across = (normal - along * normal.dot(&along)).try_normalize(1e-3)?;
    let arm = arm(&points, (times, size), piece, lines);
    let margin = ROUNDINGS * size.system_rounding;
    let bands: [Option<Band>; 2] = [across, along.cross(&across)].map(|direction| {
        let direction = direction.into();
        let (own, (lo, hi)) = (products(&[direction], &points), seen(times, piece, &arm, &direction));
        let range = (lo - margin, hi + margin);
        // Otherwise nothing can be left out.
        (range.0 > own.0 || range.1 < own.1).then(|| Band {
            form: (0..points.len()).map(|j| points.dot(&direction, j)).collect(),
            range,
        })
    });
    if bands.iter().all(Option::is_none) {
        return None;
    }
    let (weights, degrees) = cells.weights(element, cell);
    let mut part = [(0.0, 1.0); 2];
    for _ in 0..ROUNDS {
        let area = |part: &[Range; 2]| part.iter().map(|(lo, hi)| hi - lo).product::<f64>();
        let before = area(&part);
        for band in bands.iter().flatten() {
            for axis in [1, 0] {
                for lower in [true, false] {
                    let least = band.least(weights, degrees, &part, (axis, lower));
                    let ((start, end), (lo, hi)) = (part[axis], not_positive(&least));
                    let at = |x: f64| start + x * (end - start);
                    part[axis] = (at(lo), at(hi));
                }
            }
        }
        if area(&part) > PROGRESS * before {
            break;
        }
    }
    Some([0, 1].map(|axis| {
        let ((start, end), (lo, hi)) = (cells.bounds(cell, axis), part[axis]);
        let margin = MARGIN * (hi - lo);
        let at = |x: f64| (start + x * (end - start)).clamp(start, end);
        // A face of the cell stays one.
        let lower = if lo > margin { at(lo - margin) } else { start };
        let upper = if hi + margin < 1.0 { at(hi + margin) } else { end };
        (lower, upper)
    }))
}

/// `⟨n, F⟩` by its control values, and the range that it has on the lines.
struct Band {
    form: Form,
    range: Range,
}

impl Band {
    /// A polynomial along one side of a part of the cell that is positive only where no point is above the lower end of the range, or none below the upper one.
    fn least(&self, weights: &[f64], degrees: [usize; 2], part: &[Range; 2], (axis, lower): (usize, bool)) -> Form {
        let (lo, hi) = self.range;
        let excess = |value: &f64| if lower { lo - value } else { value - hi };
        let whole: Form = self
            .form
            .iter()
            .zip(weights)
            .map(|(value, w)| w * excess(value))
            .collect();
        let mut own: Form = SmallVec::from_elem(0.0, whole.len());
        let [(u, to_u), (v, to_v)] = *part;
        restrict_rectangle(&whole, degrees, [u, v], [to_u, to_v], &mut own);
        let row = degrees[0] + 1;
        let mut least: Form = SmallVec::from_elem(f64::INFINITY, degrees[axis] + 1);
        for (j, c) in own.iter().enumerate() {
            let own = &mut least[if axis == 0 { j % row } else { j / row }];
            // NaN stays.
            *own = if *c >= *own { *own } else { *c };
        }
        least
    }
}

/// The part of `[0, 1]` outside which a polynomial is positive, by its Bernstein coefficients: halves and quarters at both ends are left out as long as they can be.
fn not_positive(coefficients: &[f64]) -> Range {
    const STEPS: usize = 64;
    const ENDS: [Range; 4] = [(0.5, 1.0), (0.0, 0.5), (0.75, 1.0), (0.0, 0.25)];
    let degree = coefficients.len() - 1;
    let mut own: Form = SmallVec::from_elem(0.0, coefficients.len());
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..STEPS {
        let at = |x: f64| lo + x * (hi - lo);
        let found = ENDS.into_iter().find(|(from, to)| {
            restrict_rectangle(coefficients, [degree, 0], [at(*from), 0.0], [at(*to), 1.0], &mut own);
            own.iter().all(|c| *c > 0.0)
        });
        match found {
            Some((0.0, to)) => lo = at(to),
            Some((from, _)) => hi = at(from),
            None => break,
        }
    }
    (lo, hi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::envelope::{AnyBox, PatchMap};
    use sweepsim_motion::{Law, Path, Pose, Tool};
    use sweepsim_props::*;
    use sweepsim_solve::{ChartMap, Enclosure};
    use sweepsim_spline::Bernstein;

    proptest! {
        /// Nothing is left out where the polynomial is not positive, and what is kept ends near such a place.
        #[test]
        fn kept_parts_hold_all_that_is_not_positive(coefficients in collection::vec(-1.0..3.0, 1..7), at in 0.0..1.0) {
            let (lo, hi) = not_positive(&coefficients);
            let form = Bernstein::new(&[coefficients.len() - 1], coefficients).unwrap();
            prop_assert!((lo..=hi).contains(&at) || form.evaluate(&[at]) > -1e-14);
        }

        /// About a double zero at an end, the part has the size of the zeros next to it.
        #[test]
        fn scales_are_found_at_once(size in -14.0..-1.0_f64) {
            let root = 10.0_f64.powf(size);
            let (lo, hi) = not_positive(&[-root * root, -root * root, 1.0 - root * root]);
            prop_assert!(lo == 0.0 && hi >= root && hi < 2.0 * root, "{hi}");
            let (lo, hi) = not_positive(&[1.0 - root * root, -root * root, -root * root]);
            prop_assert!(hi == 1.0 && 1.0 - lo >= root && 1.0 - lo < 2.0 * root, "{lo}");
        }

        /// A ball end that turns about a line which touches it at its tip: for all times, a few steps leave only the part of a cell that is as far from the tip
        /// as a line's distance allows, and each holds the point through which the line has been chosen.
        #[test]
        fn cells_about_a_point_of_contact_shrink_to_the_scale_of_the_distance(size in -8.0..-1.0, way in [0.0..1.0, 0.0..1.0], t in 0.0..1.0) {
            const ROUNDING: f64 = 64.0 * f64::EPSILON * 10.0;
            const STEPS: usize = 6;
            let poses = [0.3, -0.2].map(|side| Pose::new([0.0, 0.0, 5.0 * side], [side, 1.0, 0.0]).unwrap());
            let segment = Path::with_law(poses.into(), Law::Slerp).unwrap().segments(0, 10.0, 1e-6).remove(0);
            let mut tips = 0;
            for element in &PatchForms::all(&Tool::ball(2.0, 7.0).unwrap()).0 {
                let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
                let mut map = PatchMap::new(element, &mut cells, &mut times, Size { spacing: [0.1; 2], system_rounding: ROUNDING });
                for tip in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                    let from_line = |map: &PatchMap, at: [f64; 2]| {
                        let [x, y, _] = map.evaluate(&[at[0], at[1], t]).value;
                        ([x, y], x.hypot(y))
                    };
                    if from_line(&map, tip).1 > 1e-3 {
                        continue;
                    }
                    tips += 1;
                    let inwards = |k: usize, by: f64| (tip[k] - by).abs();
                    let place = [0, 1].map(|k| inwards(k, way[k] * 10.0_f64.powf(size)));
                    let (line, distance) = from_line(&map, place);
                    let [u, v] = [0, 1].map(|k| Enclosure::hull(tip[k], inwards(k, 0.5)));
                    let mut part = [u, v, Enclosure::UNIT];
                    // Each cell's normal is nearer that at the tip than the last one's.
                    for _ in 0..STEPS {
                        let cell = map.place(&part);
                        let left = map.clipped(&cell, &[line[0], line[1], 0.0].map(|q| Enclosure::hull(q, q)));
                        part = left.unwrap_or(part);
                        prop_assert!((0..2).all(|k| part[k].contains(place[k])));
                    }
                    let reach = 16.0 * (distance + 2.0 * ROUNDINGS * ROUNDING).sqrt();
                    let far = |k: usize| (part[k].lo() - tip[k]).abs().max((part[k].hi() - tip[k]).abs());
                    prop_assert!((0..2).all(|k| far(k) < reach), "{part:?} {reach}");
                }
            }
            prop_assert!(tips > 0);
        }
    }
}
