//! Eq. 6 as a map: a patch under a motion.

use crate::algebra::quad::vector;
use crate::algebra::ranges::{envelope, products};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::absent::is_absent;
use crate::envelope::enclosures::{
    Brick, Near, Size, envelope_error, envelope_size, interval, largest, plane_values, product_size, turning, widened,
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

impl PatchMap<'_> {
    /// The part of a cell outside which `g` has a sign, if it is a small one at a corner from which `g` grows, or falls, in both directions.
    fn part_with_zeros(&mut self, brick: &Brick) -> Option<[[f64; 2]; 2]> {
        /// Of the cell's sides.
        const SMALL: f64 = 0.25;
        /// Of the domain's: far below what matters, far above rounding.
        const LEAST: f64 = 1e-13;
        let [_, _, g] = self.values(brick)?;
        let [_, _, slopes] = self.jacobian(brick);
        // From the corner where g is least, then from the one where it is largest.
        [(true, -g.lo()), (false, g.hi())]
            .into_iter()
            .find_map(|(least, distance)| {
                let (mut lower, mut upper) = ([0.0; 2], [0.0; 2]);
                for axis in 0..2 {
                    let (start, end) = self.cells.bounds(brick.0, axis);
                    let slope = slopes[axis];
                    let steepness = slope.lo().max(-slope.hi());
                    let reach = f64::max(distance / steepness, LEAST);
                    if !(steepness > 0.0 && reach < SMALL * (end - start)) {
                        return None;
                    }
                    let at_start = (slope.lo() > 0.0) == least;
                    (lower[axis], upper[axis]) = if at_start {
                        (start, start + reach)
                    } else {
                        (end - reach, end)
                    };
                }
                Some([lower, upper])
            })
    }
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
        let error = envelope_error(self.element, self.times);
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
            let slope = self.cells.slope(self.element, cell.0, axis);
            for r in 0..2 {
                jacobian[r][axis] = interval(products(self.times.rows(cell.1, r), &slope));
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
            || self.part_with_zeros(cell).is_some_and(|[lower, upper]| {
                let mark = self.cells.mark();
                let part = (self.cells.place(self.element, lower, upper), cell.1);
                let values = self.values(&part);
                self.cells.release(mark);
                values.is_none_or(|values| !(values[0].contains(x) && values[1].contains(y)))
            })
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
}
