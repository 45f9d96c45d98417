//! Eq. 6 as a map: a patch under a motion.

use crate::algebra::quad::vector;
use crate::algebra::ranges::{envelope, products};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::about_a_line::{about_a_line, turn_back};
use crate::envelope::absent::is_absent;
use crate::envelope::any_box::AnyBox;
use crate::envelope::clipped::clipped;
use crate::envelope::enclosures::{
    Brick, Near, Size, envelope_error, envelope_error_in, envelope_size, interval, largest, plane_values, product_size,
    speeds, turning, widened,
};
use crate::envelope::poles::{at_pole, with_zeros};
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
    motion: FramedMotion<'a>,
    pub size: Size,
}

fn pair(range: Enclosure) -> (f64, f64) {
    (range.lo(), range.hi())
}

impl<'a> PatchMap<'a> {
    pub fn new(element: &'a PatchForms, cells: &'a mut Cells, times: &'a mut Times, size: Size) -> Self {
        Self {
            element,
            cells,
            times,
            motion: FramedMotion::new(element.frame()),
            size,
        }
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
        let speeds = speeds(spins, travels, &self.times.sizes());
        let missing = product_size(&speeds, &self.cells.missing(cell.0).value);
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
        let (spins, travels) = self.times.twist(cell.1);
        let speeds = speeds(spins, travels, &self.times.sizes());
        for axis in 0..2 {
            for (r, row) in jacobian.iter_mut().enumerate().take(2) {
                let rows = self.times.rows(cell.1, r);
                row[axis] = interval(self.cells.slope_products(self.element, cell.0, axis, rows));
            }
            let slopes = self.cells.field_slope(cell.0, 0, axis);
            let error = product_size(&speeds, &missing.slopes[axis]);
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
            (lower[axis], upper[axis]) = with_zeros((start, end), pair(values[2]), pair(jacobian[2][axis]));
            is_small |= upper[axis] - lower[axis] < SMALL * (end - start);
        }
        is_small.then(|| (self.cells.place(self.element, lower, upper), cell.1))
    }

    fn remainder(
        &mut self,
        cell: &Brick,
        values: &[Enclosure; 3],
        jacobian: &[[Enclosure; 3]; 3],
    ) -> Option<[Enclosure; 3]> {
        let slopes = |jacobian: &[[Enclosure; 3]; 3]| [pair(jacobian[2][0]), pair(jacobian[2][1])];
        let sides = [0, 1].map(|axis| self.cells.bounds(cell.0, axis));
        let known = (pair(values[2]), slopes(jacobian));
        let [u, v] = at_pole(&self.element.poles, sides, known, |[u, v]| {
            let own = (self.cells.place(self.element, [u.0, v.0], [u.1, v.1]), cell.1);
            let found = self
                .values(&own)
                .map(|values| (pair(values[2]), slopes(&self.jacobian(&own))));
            self.drop_part(own);
            found
        })?;
        Some([interval(u), interval(v), interval(self.times.bounds(cell.1))])
    }

    fn drop_part(&mut self, (cell, _): Brick) {
        self.cells.release(cell as usize);
    }

    fn clipped(&mut self, cell: &Brick, range: &[Enclosure; 3]) -> Option<[Enclosure; 3]> {
        let lines = [0, 1].map(|k| (range[k].lo(), range[k].hi()));
        let [u, v] = clipped((self.element, self.cells), (self.times, &self.size), *cell, lines)?.map(interval);
        Some([u, v, interval(self.times.bounds(cell.1))])
    }

    fn jacobian_about(&mut self, cell: &Brick, target: &[f64; 3], at: &[f64; 3]) -> Option<[[Enclosure; 3]; 3]> {
        let [_, _, of_g] = self.jacobian(cell);
        let [x, y, _] = *target;
        let [of_x, of_y] = about_a_line(
            (self.element, self.cells),
            (self.times, &self.size),
            *cell,
            [x, y],
            at[2],
        )?;
        Some([of_x, of_y, of_g])
    }

    fn evaluate_about(&self, x: &[f64; 3], target: &[f64; 3], at: &[f64; 3]) -> Sample<3, OnPatch> {
        let mut sample = self.evaluate(x);
        turn_back(&mut sample, self.times, [x[2], at[2]], target);
        sample
    }

    fn narrowed(&mut self, _: &Brick, part: &[Enclosure; 3]) -> Option<Brick> {
        Some(self.place(part))
    }

    fn drop_narrowed(&mut self, (cell, piece): Brick) {
        self.release([cell as usize, piece as usize]);
    }

    fn begin(&mut self) {
        self.cells.begin();
        self.times.begin();
    }

    fn is_full(&self) -> bool {
        self.cells.is_full() || self.times.is_full()
    }

    fn keep(&mut self, bricks: &mut [Brick]) {
        self.cells.keep(bricks.iter_mut().map(|brick| &mut brick.0));
        self.times.keep(bricks.iter_mut().map(|brick| &mut brick.1));
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
        let (point, [g, g_u, g_v], g_t) = match &self.element.revolution {
            Some(revolution) => {
                let turned = revolution.at(&instant.placing, [x[0], x[1]]);
                let g_t = turned.envelope(&instant.change);
                (turned.point(), turned.envelopes(&instant.own), g_t)
            }
            None => {
                let (point, fields) = self.element.point(&instant.placing, [x[0], x[1]]);
                (point, fields.envelopes(&instant.own), fields.envelope(&instant.change))
            }
        };
        let moving = instant.moving(&point.place);
        let [in_u, in_v] = &point.slopes;
        Sample {
            value: [point.place[0], point.place[1], g],
            jacobian: [
                [in_u[0], in_v[0], moving[0]],
                [in_u[1], in_v[1], moving[1]],
                [g_u, g_v, g_t],
            ],
            seen: OnPatch {
                height: Near {
                    value: point.place[2],
                    slope: [in_u[2], in_v[2], moving[2]],
                },
                normal: vector(&point.normal),
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
        let rounding = self.size.system_rounding;
        [rounding, rounding, envelope_error(self.element, self.times)]
    }

    fn rounding_in(&self, cell: &Brick) -> [f64; 3] {
        let rounding = self.size.system_rounding;
        [
            rounding,
            rounding,
            envelope_error_in(self.element, self.cells, self.times, cell.0),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::{Law, Patch, Path, Pose, Segment, Tool};
    use sweepsim_props::*;
    use sweepsim_spline::Bernstein;

    const SIZE: Size = Size {
        spacing: [0.1; 2],
        system_rounding: 64.0 * f64::EPSILON * 50.0,
    };

    /// A smooth tip, a quarter of the way round: the side `v = 0` is a point, the tangent plane there is level.
    fn tip(numbers: &[f64]) -> Patch {
        let form = |value: &dyn Fn(f64, usize, f64) -> f64| {
            let each = (0..16).map(|k| value((k % 4) as f64 / 3.0, k / 4, numbers[k]));
            Bernstein::new(&[3, 3], each.collect()).unwrap()
        };
        let far = |row: usize| row as f64 / 3.0;
        let x = form(&|u, row, bump| far(row) * (3.0 * (1.5 * u).cos() + 0.1 * bump));
        let y = form(&|u, row, bump| far(row) * (2.0 * (1.5 * u).sin() - 0.1 * bump));
        let z = form(&|_, row, bump| if row < 2 { 0.0 } else { far(row) * (1.0 + 0.2 * bump) });
        let one = form(&|_, _, _| 1.0);
        Patch::new([x, y, z], one).unwrap()
    }

    fn straight(way: [f64; 3]) -> Segment {
        let poses = [-1.0, 1.0].map(|side| Pose::new(way.map(|x| side * x), [0.0, 0.0, 1.0]).unwrap());
        Path::with_law(poses.into(), Law::Slerp)
            .unwrap()
            .segments(0, 10.0, 1e-6)
            .remove(0)
    }

    proptest! {
        /// What is left of a cell at a pole holds each point of it with `g = 0`.
        #[test]
        fn remainders_at_poles_hold_all_zeros(
            numbers in collection::vec(-1.0..1.0, 16), angle in 0.0..6.3_f64, digits in 0.0..12.0_f64, falls in any::<bool>(),
            place in 0.0..1.0_f64, share in 0.0..1.0_f64, width in 0.0..6.0_f64, larger in 0.0..4.0_f64,
        ) {
            let patches = [tip(&numbers)];
            let elements = PatchForms::of_patches(&patches);
            let element = &elements[0];
            prop_assert!(element.poles == [[false; 2], [true, false]]);
            let sign = if falls { -1.0 } else { 1.0 };
            let rise = sign * 10_f64.powf(-digits);
            let segment = straight([f64::cos(angle), f64::sin(angle), rise]);
            let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
            let mut map = PatchMap::new(element, &mut cells, &mut times, SIZE);
            let negative = |map: &PatchMap, v: f64| map.evaluate(&[place, v, 0.5]).value[2] < 0.0;
            let (mut low, mut high) = (0.0, 1.0);
            let at_pole = negative(&map, low);
            if at_pole == negative(&map, high) {
                return Ok(());
            }
            while high - low > 1e-16 + 1e-9 * low {
                let middle = 0.5 * (low + high);
                *(if negative(&map, middle) == at_pole { &mut low } else { &mut high }) = middle;
            }
            let width = 10_f64.powf(-width);
            let start = (place - share * width).max(0.0);
            let end = (1.000_001 * high * 10_f64.powf(larger)).min(1.0);
            let cell = map.place(&[Enclosure::hull(start, (start + width).min(1.0)), Enclosure::hull(0.0, end), Enclosure::UNIT]);
            let values = map.values(&cell).unwrap();
            let jacobian = map.jacobian(&cell);
            if let Some(part) = map.remainder(&cell, &values, &jacobian) {
                prop_assert!(part[1].lo() <= low && high <= part[1].hi() && 2.0 * part[1].radius() <= 0.126 * end, "{low} {high} {part:?}");
            }
        }

        /// Where a tip that moves level is steep across its way, next to nothing but the pole is left.
        #[test]
        fn poles_alone_remain_where_a_level_tip_is_steep(numbers in collection::vec(-1.0..1.0, 16), start in 0.0..0.2_f64) {
            let patches = [tip(&numbers)];
            let elements = PatchForms::of_patches(&patches);
            let element = &elements[0];
            let segment = straight([1.0, 0.0, 0.0]);
            let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
            let mut map = PatchMap::new(element, &mut cells, &mut times, SIZE);
            let cell = map.place(&[Enclosure::hull(start, start + 0.1), Enclosure::hull(0.0, 0.1), Enclosure::UNIT]);
            let values = map.values(&cell).unwrap();
            let jacobian = map.jacobian(&cell);
            let part = map.remainder(&cell, &values, &jacobian);
            prop_assert!(part.is_some_and(|part| part[1].hi() < 1e-11), "{part:?}");
        }

        /// The part of a box where `g` can vanish, on a wall that moves sideways, shrinks with the square of the box about the ruling where it does.
        #[test]
        fn parts_of_walls_shrink_with_the_square_of_the_box(size in 1..5_i32, angle in 0.0..6.2, share in 0.0..1.0) {
            let (s, c) = f64::sin_cos(angle);
            let poses = [-2.0, 2.0].map(|at| Pose::new([at * c, at * s, 0.0], [0.0, 0.0, 1.0]).unwrap());
            let segment = Path::with_law(poses.into(), Law::Slerp).unwrap().segments(0, 10.0, 1e-6).remove(0);
            let width = 0.1_f64.powi(size);
            for element in &PatchForms::all(&Tool::flat(2.0, 7.0).unwrap()).0 {
                let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
                let mut map = PatchMap::new(element, &mut cells, &mut times, SIZE);
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
