//! Caps and kinks as a map: a patch at rest between two motions.

use crate::algebra::quad::vector;
use crate::algebra::ranges::{Triples, envelope, envelope_coefficients, products};
use crate::algebra::separate::is_separate;
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::cutter::reduced::Missing;
use crate::envelope::any_box::AnyBox;
use crate::envelope::enclosures::{Near, ROUNDING, Size, interval, negative, product_size, speeds, widened};
use crate::time::pieces::Sizes;
use crate::time::placement::{LocalFrame, Placing, Twisted};
use nalgebra::{Matrix3, Vector3};
use sweepsim_solve::{Affine, ChartMap, Enclosure, Sample};

/// Additional data at a point of a placed patch: its height, `g` before and after, and the normal in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnPlaced {
    pub height: Near<2>,
    pub before: Near<2>,
    pub after: Near<2>,
    pub normal: Vector3<f64>,
}

/// The tool's velocity just before or after a pose, in the tool's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twist {
    pub spin: [f64; 3],
    pub travel: [f64; 3],
    /// Bounds of what the roundings of the components of both are relative to, and of the components themselves.
    pub sizes: Sizes,
}

impl Twist {
    /// Bounds of the components of both.
    fn speeds(&self) -> Sizes {
        speeds(&[self.spin], &[self.travel], &self.sizes)
    }
}

/// A side of a joint: the motion there, or none at the end of a path. The sign of `g` is then fixed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum JointSide {
    Moving(Twist),
    /// Beyond the end: `true` counts as `g < 0`.
    Beyond(bool),
}

impl JointSide {
    fn negative(&self, field: &[Triples; 2], missing: &Missing, element: &PatchForms) -> Option<bool> {
        match self {
            Self::Beyond(negative) => Some(*negative),
            Self::Moving(twist) => {
                let g = envelope(&[twist.spin], &[twist.travel], field);
                let error = ROUNDING * product_size(&twist.sizes, &element.rounding);
                negative(widened(g, product_size(&twist.speeds(), &missing.value)), error)
            }
        }
    }

    /// Over a cell, `length` coefficients of the field in a row.
    fn affine(&self, (field, length): (&[Triples; 2], usize), missing: &Missing, element: &PatchForms) -> Affine<2> {
        match self {
            Self::Beyond(negative) => Affine {
                value: if *negative { -1.0 } else { 1.0 },
                slope: [0.0; 2],
                error: 0.0,
            },
            Self::Moving(twist) => {
                let rounding = ROUNDING * product_size(&twist.sizes, &element.rounding);
                let error = rounding + product_size(&twist.speeds(), &missing.value);
                let coefficients = envelope_coefficients(&[twist.spin], &[twist.travel], field);
                Affine::of_form(&coefficients, length, error)
            }
        }
    }

    fn seen(&self, frame: Option<&LocalFrame>) -> FramedSide {
        match self {
            Self::Beyond(negative) => FramedSide::Beyond(*negative),
            Self::Moving(twist) => FramedSide::Moving(Twisted::new(&twist.spin.into(), &twist.travel.into(), frame)),
        }
    }
}

/// A side of a joint, in the frame of a patch.
enum FramedSide {
    Moving(Twisted),
    Beyond(bool),
}

/// A placed patch between two motions: a kink of the path, or a cap at its start or end.
pub(crate) struct PlacedMap<'a> {
    pub element: &'a PatchForms,
    pub cells: &'a mut Cells,
    turn: Matrix3<f64>,
    tip: Vector3<f64>,
    before: JointSide,
    after: JointSide,
    size: Size,
    placing: Placing,
    seen: [FramedSide; 2],
}

impl<'a> PlacedMap<'a> {
    /// A patch turned by `turn`, its tip at `tip`.
    pub fn new(
        element: &'a PatchForms,
        cells: &'a mut Cells,
        (turn, tip): (Matrix3<f64>, Vector3<f64>),
        [before, after]: [JointSide; 2],
        size: Size,
    ) -> Self {
        let frame = element.frame();
        Self {
            placing: Placing::new(&turn, &tip, frame),
            seen: [before.seen(frame), after.seen(frame)],
            element,
            cells,
            turn,
            tip,
            before,
            after,
            size,
        }
    }

    /// The ranges of `X` and `Y` over a cell, from the tip.
    pub fn ranges(&self, cell: u32) -> [(f64, f64); 2] {
        let position = self.cells.position(self.element, cell);
        [0, 1].map(|r| {
            let (lo, hi) = products(&self.row(r), &position);
            (lo - self.size.system_rounding, hi + self.size.system_rounding)
        })
    }

    fn row(&self, r: usize) -> [[f64; 3]; 1] {
        [[self.turn[(r, 0)], self.turn[(r, 1)], self.turn[(r, 2)]]]
    }
}

impl ChartMap<2> for PlacedMap<'_> {
    type Cell = u32;
    type Seen = OnPlaced;

    fn bounds(&self, cell: &u32) -> [Enclosure; 2] {
        [0, 1].map(|axis| interval(self.cells.bounds(*cell, axis)))
    }

    fn values(&mut self, cell: &u32) -> Option<[Enclosure; 2]> {
        let field = self.cells.field(self.element, *cell, 0);
        let missing = self.cells.missing(*cell);
        let before = self.before.negative(&field, missing, self.element);
        if before.is_some() && before == self.after.negative(&field, missing, self.element) {
            return None;
        }
        let ranges = self.ranges(*cell);
        Some([0, 1].map(|r| Enclosure::hull(ranges[r].0 + self.tip[r], ranges[r].1 + self.tip[r])))
    }

    fn jacobian(&mut self, cell: &u32) -> [[Enclosure; 2]; 2] {
        self.cells.prepare(self.element, *cell);
        [0, 1].map(|r| [0, 1].map(|axis| interval(self.cells.slope_products(self.element, *cell, axis, &self.row(r)))))
    }

    fn split(&mut self, cell: &u32, axis: usize) -> [u32; 2] {
        self.cells.split(self.element, *cell, axis)
    }

    fn sides(&self, cell: &u32) -> Option<[Affine<2>; 2]> {
        let field = self.cells.field(self.element, *cell, 0);
        let (length, missing) = (self.element.field_length(0), self.cells.missing(*cell));
        Some([&self.before, &self.after].map(|side| side.affine((&field, length), missing, self.element)))
    }

    fn is_absent(&mut self, cell: &u32, line: &[f64; 2]) -> bool {
        let position = self.cells.position(self.element, *cell);
        let from = [line[0] - self.tip[0], line[1] - self.tip[1]];
        let rows = [self.row(0), self.row(1)];
        is_separate(
            rows.each_ref().map(|row| &row[..]),
            &position,
            &[from],
            [2.0 * self.size.system_rounding; 2],
        )
    }

    fn combined_jacobian(&mut self, cell: &u32, matrix: &[[f64; 2]; 2]) -> Option<[[Enclosure; 2]; 2]> {
        self.cells.prepare(self.element, *cell);
        let [[x], [y]] = [self.row(0), self.row(1)];
        Some(matrix.map(|[a, b]| {
            let row: [f64; 3] = std::array::from_fn(|i| a * x[i] + b * y[i]);
            [0, 1].map(|axis| interval(self.cells.slope_products(self.element, *cell, axis, &[row])))
        }))
    }

    fn narrowed(&mut self, _: &u32, part: &[Enclosure; 2]) -> Option<u32> {
        Some(self.place(part))
    }

    fn drop_narrowed(&mut self, cell: u32) {
        self.release([cell as usize, 0]);
    }

    fn begin(&mut self) {
        self.cells.begin();
    }

    fn is_full(&self) -> bool {
        self.cells.is_full()
    }

    fn keep(&mut self, cells: &mut [u32]) {
        self.cells.keep(cells.iter_mut());
    }

    fn value(&self, x: &[f64; 2]) -> Option<[f64; 2]> {
        if self.element.revolution.is_some() {
            return None;
        }
        let place = self.element.place(&self.placing, *x)?;
        Some([place[0], place[1]])
    }

    fn evaluate(&self, x: &[f64; 2]) -> Sample<2, OnPlaced> {
        let near = |side: &FramedSide, envelopes: &dyn Fn(&Twisted) -> [f64; 3]| match side {
            FramedSide::Moving(twist) => {
                let [value, in_u, in_v] = envelopes(twist);
                Near {
                    value,
                    slope: [in_u, in_v],
                }
            }
            FramedSide::Beyond(negative) => Near {
                value: if *negative { -1.0 } else { 1.0 },
                slope: [0.0; 2],
            },
        };
        let (point, [before, after]) = match &self.element.revolution {
            Some(revolution) => {
                let turned = revolution.at(&self.placing, *x);
                let sides = self
                    .seen
                    .each_ref()
                    .map(|side| near(side, &|twist| turned.envelopes(twist)));
                (turned.point(), sides)
            }
            None => {
                let (point, fields) = self.element.point(&self.placing, *x);
                let envelopes = |twist: &Twisted| fields.envelopes(twist);
                (point, self.seen.each_ref().map(|side| near(side, &envelopes)))
            }
        };
        let [in_u, in_v] = &point.slopes;
        Sample {
            value: [point.place[0], point.place[1]],
            jacobian: [[in_u[0], in_v[0]], [in_u[1], in_v[1]]],
            seen: OnPlaced {
                height: Near {
                    value: point.place[2],
                    slope: [in_u[2], in_v[2]],
                },
                before,
                after,
                normal: vector(&point.normal),
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
