//! Eq. 6 as a map: a patch under a motion.

use crate::algebra::quad::vector;
use crate::algebra::ranges::{envelope, products};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::absent::is_absent;
use crate::envelope::any_box::AnyBox;
use crate::envelope::clipped::clipped;
use crate::envelope::enclosures::{
    Brick, Near, Size, envelope_error, envelope_error_in, envelope_size, interval, largest, plane_values, product_size,
    turning, widened,
};
use crate::time::framed::FramedMotion;
use crate::time::pieces::Times;
use nalgebra::Vector3;
use sweepsim_solve::{ChartMap, Enclosure, Sample};

/// Additional data at a point of a patch: its height, and the normal in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnPatch {
    pub height: Near<3>,
    pub normal: Vector3<f64>,
}

/// A patch under a motion.
pub(crate) struct PatchMap<'a> {
    pub element: &'a PatchForms,
    pub cells: &'a mut Cells,
    pub times: &'a mut Times,
    pub motion: FramedMotion<'a>,
    pub size: Size,
}

/// The part of the side of a box outside which a function has a sign, if it is steep along the side: it is at least `lo` at one end and at most `hi` at the other,
/// and changes at least as `slope` says.
fn with_zeros((start, end): (f64, f64), values: Enclosure, slope: Enclosure) -> (f64, f64) {
    /// Of the domain's sides: far below what matters, far above rounding.
    const LEAST: f64 = 1e-13;
    let steepness = slope.lo().max(-slope.hi());
    if !(steepness > 0.0) {
        return (start, end);
    }
    let reach = |value: f64| value / steepness + LEAST;
    // Where it grows, from the start it takes at most this to grow from its least value to 0, and from 0 to its largest to the end.
    let [near, far] = if slope.lo() > 0.0 {
        [-values.lo(), values.hi()]
    } else {
        [values.hi(), -values.lo()]
    };
    let (lower, upper) = ((end - reach(far)).max(start), (start + reach(near)).min(end));
    // NaN, or no zero, which rounding may hide.
    if lower < upper { (lower, upper) } else { (start, end) }
}

impl ChartMap<3> for PatchMap<'_> {
    type Cell = Brick;
    type Seen = OnPatch;

    fn bounds(&self, cell: &Brick) -> [Enclosure; 3] {
        let of = |axis| interval(self.cells.bounds(cell.0, axis));
        [of(0), of(1), interval(self.times.bounds(cell.1))]
    }

    fn values(&mut self, cell: &Brick) -> Option<[Enclosure; 3]> {
        let field = self.cells.field(self.element, cell.0, 0);
        let (spins, travels) = self.times.twist(cell.1);
        let missing = product_size(&self.times.sizes(), &self.cells.missing(cell.0).value);
        let g = widened(envelope(spins, travels, &field), missing);
        let error = envelope_error_in(self.element, self.cells, self.times, cell.0);
        if g.0 > error || g.1 < -error || (g.0 == 0.0 && g.1 == 0.0) {
            return None;
        }
        let [x, y] = plane_values(self.element, self.cells, self.times, *cell, &self.size);
        Some([x, y, Enclosure::hull(g.0 - error, g.1 + error)])
    }

    fn jacobian(&mut self, cell: &Brick) -> [[Enclosure; 3]; 3] {
        self.cells.prepare(self.element, cell.0);
        let zero = Enclosure::hull(0.0, 0.0);
        let mut jacobian = [[zero; 3]; 3];
        let missing = self.cells.missing(cell.0);
        let sizes = self.times.sizes();
        for axis in 0..2 {
            for (r, row) in jacobian.iter_mut().enumerate().take(2) {
                let rows = self.times.rows(cell.1, r);
                row[axis] = interval(self.cells.slope_products(self.element, cell.0, axis, rows));
            }
            let slopes = self.cells.field_slope(cell.0, 0, axis);
            let (spins, travels) = self.times.twist(cell.1);
            let error = product_size(&sizes, &missing.slopes[axis]);
            jacobian[2][axis] = interval(widened(envelope(spins, travels, &slopes), error));
        }
        let turning = turning(self.element, self.cells, self.times, *cell);
        for r in 0..2 {
            jacobian[r][2] = turning[r];
        }
        let (spins, travels) = self.times.twist_slope(cell.1);
        if !travels.is_empty() {
            let field = self.cells.field(self.element, cell.0, 0);
            let range = if spins.is_empty() {
                products(travels, &field[0])
            } else {
                envelope(spins, travels, &field)
            };
            let error = product_size(&[largest(spins), largest(travels)], &missing.value);
            jacobian[2][2] = interval(widened(range, error));
        }
        jacobian
    }

    fn split(&mut self, cell: &Brick, axis: usize) -> [Brick; 2] {
        if axis == 2 {
            self.times.split(cell.1).map(|piece| (cell.0, piece))
        } else {
            self.cells.split(self.element, cell.0, axis).map(|part| (part, cell.1))
        }
    }

    fn is_absent(&mut self, cell: &Brick, line: &[f64; 3]) -> bool {
        let [x, y, _] = *line;
        is_absent((self.element, self.cells), (self.times, &self.size), *cell, [x, y])
    }

    fn part(&mut self, cell: &Brick, values: &[Enclosure; 3], jacobian: &[[Enclosure; 3]; 3]) -> Option<Brick> {
        /// Of the cell's side.
        const SMALL: f64 = 0.25;
        let (mut lower, mut upper) = ([0.0; 2], [0.0; 2]);
        let mut is_small = false;
        for axis in 0..2 {
            let (start, end) = self.cells.bounds(cell.0, axis);
            (lower[axis], upper[axis]) = with_zeros((start, end), values[2], jacobian[2][axis]);
            is_small |= upper[axis] - lower[axis] < SMALL * (end - start);
        }
        is_small.then(|| (self.cells.place(self.element, lower, upper), cell.1))
    }

    fn drop_part(&mut self, (cell, _): Brick) {
        self.cells.release(cell as usize);
    }

    fn clipped(&mut self, cell: &Brick, range: &[Enclosure; 3]) -> Option<[Enclosure; 3]> {
        let lines = [0, 1].map(|k| (range[k].lo(), range[k].hi()));
        let [u, v] = clipped((self.element, self.cells), (self.times, &self.size), *cell, lines)?.map(interval);
        Some([u, v, interval(self.times.bounds(cell.1))])
    }

    fn narrowed(&mut self, _: &Brick, part: &[Enclosure; 3]) -> Option<Brick> {
        Some(self.place(part))
    }

    fn drop_narrowed(&mut self, (cell, piece): Brick) {
        self.release([cell as usize, piece as usize]);
    }

    fn value(&self, x: &[f64; 3]) -> Option<[f64; 3]> {
        if self.element.revolution.is_some() {
            return None;
        }
        let instant = self.motion.at(self.times, x[2]);
        let (place, g) = self.element.value(&instant.placing, &instant.own, [x[0], x[1]])?;
        Some([place[0], place[1], g])
    }

    fn evaluate(&self, x: &[f64; 3]) -> Sample<3, OnPatch> {
        let instant = self.motion.at(self.times, x[2]);
        let (spot, [g, g_u, g_v], g_t) = match &self.element.revolution {
            Some(revolution) => {
                let turned = revolution.at(&instant.placing, [x[0], x[1]]);
                let g_t = turned.envelope(&instant.change);
                (turned.spot(), turned.envelopes(&instant.own), g_t)
            }
            None => {
                let (spot, fields) = self.element.spot(&instant.placing, [x[0], x[1]]);
                (spot, fields.envelopes(&instant.own), fields.envelope(&instant.change))
            }
        };
        let moving = instant.moving(&spot.place);
        let [in_u, in_v] = &spot.slopes;
        Sample {
            value: [spot.place[0], spot.place[1], g],
            jacobian: [
                [in_u[0], in_v[0], moving[0]],
                [in_u[1], in_v[1], moving[1]],
                [g_u, g_v, g_t],
            ],
            seen: OnPatch {
                height: Near {
                    value: spot.place[2],
                    slope: [in_u[2], in_v[2], moving[2]],
                },
                normal: vector(&spot.normal),
            },
        }
    }

    fn scales(&self) -> [f64; 3] {
        let [x, y] = self.size.spacing;
        [
            x,
            y,
            0.25 * envelope_size(self.element, self.times).max(f64::MIN_POSITIVE),
        ]
    }

    fn rounding(&self) -> [f64; 3] {
        let slack = self.size.slack;
        [slack, slack, envelope_error(self.element, self.times)]
    }

    fn rounding_in(&self, cell: &Brick) -> [f64; 3] {
        let slack = self.size.slack;
        [
            slack,
            slack,
            envelope_error_in(self.element, self.cells, self.times, cell.0),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sweepsim_motion::{Law, Path, Pose, Tool};

    const SIZE: Size = Size {
        spacing: [0.1; 2],
        slack: 64.0 * f64::EPSILON * 50.0,
    };

    proptest! {
        /// The part of a box where `g` can vanish, on a wall that moves sideways, shrinks with the square of the box about the ruling where it does.
        #[test]
        fn parts_of_walls_shrink_with_the_square_of_the_box(size in 1..5_i32, angle in 0.0..6.2, share in 0.0..1.0) {
            let (s, c) = f64::sin_cos(angle);
            let poses = [-2.0, 2.0].map(|at| Pose::new([at * c, at * s, 0.0], [0.0, 0.0, 1.0]).unwrap());
            let segment = Path::with_law(poses.into(), Law::Slerp).unwrap().segments(0, 10.0, 1e-6).remove(0);
            let width = 0.1_f64.powi(size);
            for element in &PatchForms::all(&Tool::flat(2.0, 7.0).unwrap()).0 {
                let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
                let mut map = PatchMap {
                    motion: FramedMotion::new(&times, element.frame()),
                    element,
                    cells: &mut cells,
                    times: &mut times,
                    size: SIZE,
                };
                let g = |map: &PatchMap, u: f64| map.evaluate(&[u, 0.5, 0.5]).value[2];
                let (mut low, mut high) = (0.1, 0.9);
                if g(&map, low) * g(&map, high) >= 0.0 {
                    continue;
                }
                let falls = g(&map, high) < 0.0;
                while high - low > 1e-15 {
                    let middle = 0.5 * (low + high);
                    *(if (g(&map, middle) < 0.0) == falls { &mut high } else { &mut low }) = middle;
                }
                let start = low - share * width;
                let cell = map.place(&[Enclosure::hull(start, start + width), Enclosure::UNIT, Enclosure::UNIT]);
                let values = map.values(&cell).unwrap();
                let jacobian = map.jacobian(&cell);
                let Some(part) = map.part(&cell, &values, &jacobian) else {
                    prop_assert!(width > 0.05);
                    continue;
                };
                let side = map.bounds(&part)[0];
                prop_assert!(side.contains(low) && side.radius() < 2.0 * width * width + 1e-12, "{side:?}");
            }
        }
    }
}
