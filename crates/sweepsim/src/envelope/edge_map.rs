//! Eq. 7 as a map: a sharp edge under a motion.

use crate::algebra::quad::{Quad, vector};
use crate::algebra::ranges::{envelope, envelope_coefficients, products};
use crate::algebra::table::position;
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::absent::is_absent_from_edge;
use crate::envelope::any_box::AnyBox;
use crate::envelope::enclosures::{Brick, Near, Size, envelope_error, interval, negative, plane_values, turning};
use crate::time::framed::FramedMotion;
use crate::time::pieces::Times;
use nalgebra::Vector3;
use sweepsim_solve::{Affine, ChartMap, Enclosure, Sample};

/// Additional data at a point of an edge: its height, and `g` and the normal in space for both faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnEdge {
    pub height: Near<2>,
    pub sides: [Near<2>; 2],
    pub normals: [Vector3<f64>; 2],
}

/// A sharp edge under a motion.
pub(crate) struct EdgeMap<'a> {
    pub element: &'a PatchForms,
    pub cells: &'a mut Cells,
    pub times: &'a mut Times,
    motion: FramedMotion<'a>,
    pub size: Size,
}

impl<'a> EdgeMap<'a> {
    pub fn new(element: &'a PatchForms, cells: &'a mut Cells, times: &'a mut Times, size: Size) -> Self {
        Self {
            element,
            cells,
            times,
            motion: FramedMotion::new(None),
            size,
        }
    }
}

impl ChartMap<2> for EdgeMap<'_> {
    type Cell = Brick;
    type Seen = OnEdge;

    fn bounds(&self, cell: &Brick) -> [Enclosure; 2] {
        [
            interval(self.cells.bounds(cell.0, 0)),
            interval(self.times.bounds(cell.1)),
        ]
    }

    fn values(&mut self, cell: &Brick) -> Option<[Enclosure; 2]> {
        let error = envelope_error(self.element, self.times);
        let [a, b] = [0, 1].map(|side| {
            let field = self.cells.field(self.element, cell.0, side);
            let (spins, travels) = self.times.twist(cell.1);
            negative(envelope(spins, travels, &field), error)
        });
        if a.is_some() && a == b {
            return None;
        }
        Some(plane_values(self.element, self.cells, self.times, *cell, &self.size))
    }

    fn jacobian(&mut self, cell: &Brick) -> [[Enclosure; 2]; 2] {
        self.cells.prepare(self.element, cell.0);
        let slope = self.cells.slope(self.element, cell.0, 0);
        let turning = turning(self.element, self.cells, self.times, *cell);
        [0, 1].map(|r| [interval(products(self.times.rows(cell.1, r), &slope)), turning[r]])
    }

    fn split(&mut self, cell: &Brick, axis: usize) -> [Brick; 2] {
        if axis == 1 {
            self.times.split(cell.1).map(|piece| (cell.0, piece))
        } else {
            self.cells.split(self.element, cell.0, 0).map(|part| (part, cell.1))
        }
    }

    fn sides(&self, cell: &Brick) -> Option<[Affine<2>; 2]> {
        let error = envelope_error(self.element, self.times);
        let (spins, travels) = self.times.twist(cell.1);
        Some([0, 1].map(|side| {
            let field = self.cells.field(self.element, cell.0, side);
            let coefficients = envelope_coefficients(spins, travels, &field);
            Affine::of_form(&coefficients, self.element.field_length(side), error)
        }))
    }

    fn is_absent(&mut self, cell: &Brick, line: &[f64; 2]) -> bool {
        self.cells.prepare(self.element, cell.0);
        is_absent_from_edge((self.element, self.cells), (self.times, &self.size), *cell, *line)
    }

    fn narrowed(&mut self, _: &Brick, part: &[Enclosure; 2]) -> Option<Brick> {
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

    fn evaluate(&self, x: &[f64; 2]) -> Sample<2, OnEdge> {
        let instant = self.motion.at(self.times, x[1]);
        let [position, slope] = position(&self.element.places.along::<4>(x[0]));
        let [fields, in_r] = self.element.normals.along::<12>(x[0]);
        let placing = &instant.placing;
        let (arm, slope) = (placing.turned(&position), placing.turned(&slope));
        let place: Quad = std::array::from_fn(|k| arm[k] + placing.origin[k]);
        let moving = instant.moving(&place);
        let side = |k: usize| {
            let (field, in_r) = (&fields[6 * k..6 * k + 6], &in_r[6 * k..6 * k + 6]);
            Near {
                value: instant.own.dot(field),
                slope: [instant.own.dot(in_r), instant.change.dot(field)],
            }
        };
        Sample {
            value: [place[0], place[1]],
            jacobian: [[slope[0], moving[0]], [slope[1], moving[1]]],
            seen: OnEdge {
                height: Near {
                    value: place[2],
                    slope: [slope[2], moving[2]],
                },
                sides: [side(0), side(1)],
                normals: [0, 6].map(|k| {
                    let normal = Vector3::new(fields[k], fields[k + 1], fields[k + 2]);
                    vector(&placing.turned(&normal))
                }),
            },
        }
    }

    fn scales(&self) -> [f64; 2] {
        self.size.spacing
    }

    fn rounding(&self) -> [f64; 2] {
        [self.size.system_rounding; 2]
    }
}
