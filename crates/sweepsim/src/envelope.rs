//! The envelope systems as charts: one map per kind of boundary point of the sweep over a dexel line.
//!
//! | map | the paper | unknowns | values | jump going up |
//! | --- | --- | --- | --- | --- |
//! | [`Face`] | Eq. 6 | `u, v, t` | `X, Y, g` | `sign det ∂(X, Y, g)` |
//! | [`Rim`] | Eq. 7 | `r, t` | `X, Y` | `−sign(g_B − g_A) · sign det ∂(X, Y)` where just one of `g_A, g_B` is negative |
//! | [`Joint`] | caps and kinks | `u, v` | `X, Y` | `−sign N_z · ([g₊ < 0] − [g₋ < 0])` |
//!
//! `X = ⟨row of A(t), F(u, v)⟩ + b(t)` is bounded by the dot products of control rows and control points, which are its
//! control values (coefficient over weight); likewise its derivatives. `g = ⟨Ω, M⟩ + ⟨Aᵀb′, N⟩`, times a positive factor, is
//! polynomial in `t` (of degree 2 for an arc: `⟨κ A₀ᵀk, M⟩ + ⟨Âᵀb′, N⟩`), and of the degree of `N` in `(u, v)`. `g = 0` counts as `g ≥ 0`
//! everywhere.

use crate::element::{Cells, Element, Triples};
use crate::instant::{Frame, Motion, Placing, Quad, Twisted, position, vector};
use crate::ranges::{envelope, products, shifted_products};
use crate::time::Times;
use nalgebra::{Matrix3, Vector3};
use sweepsim_solve::{ChartMap, Interval, Sample};

/// Sums of products of a few numbers are right to within this part of the sum of their absolute values.
pub(crate) const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// `[lo, hi] · [a, b]` for `0 < a ≤ b`.
fn scaled((lo, hi): (f64, f64), (a, b): (f64, f64)) -> (f64, f64) {
    (
        if lo < 0.0 { lo * b } else { lo * a },
        if hi > 0.0 { hi * b } else { hi * a },
    )
}

fn interval((lo, hi): (f64, f64)) -> Interval {
    Interval::new(lo, hi)
}

/// The size of things: what differences count as large, and how far rounding reaches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    /// Distance of neighbouring lines.
    pub spacing: [f64; 2],
    /// Rounding of a coordinate.
    pub slack: f64,
}

/// A function near a point: its value and its derivatives there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near<const N: usize> {
    value: f64,
    slope: [f64; N],
}

impl<const N: usize> Near<N> {
    /// The value at `x`, to first order from the point `from`.
    pub fn at(&self, x: &[f64; N], from: &[f64; N]) -> f64 {
        (0..N).fold(self.value, |sum, k| sum + self.slope[k] * (x[k] - from[k]))
    }
}

/// What is seen on a patch: height, and the normal in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnFace {
    pub height: Near<3>,
    pub normal: Vector3<f64>,
}

/// What is seen on an edge: height, and of both faces `g` and the normal in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnRim {
    pub height: Near<2>,
    pub sides: [Near<2>; 2],
    pub normals: [Vector3<f64>; 2],
}

/// What is seen on a placed patch: height, `g` before and after, and the normal in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnJoint {
    pub height: Near<2>,
    pub before: Near<2>,
    pub after: Near<2>,
    pub normal: Vector3<f64>,
}

/// A patch under a motion.
pub(crate) struct Face<'a> {
    pub element: &'a Element,
    pub cells: &'a mut Cells,
    pub times: &'a mut Times,
    pub motion: Motion<'a>,
    pub size: Size,
}

/// A cell of an element in a piece of time.
pub(crate) type Brick = (u32, u32);

pub(crate) const ROOT: Brick = (0, 0);

/// A bound of `|g|`, and so of its rounding.
fn envelope_size(element: &Element, times: &Times) -> f64 {
    let [spin, travel] = times.sizes();
    spin * element.largest_moment + travel * element.largest_normal
}

impl ChartMap<3> for Face<'_> {
    type Cell = Brick;
    type Seen = OnFace;

    fn bounds(&self, cell: &Brick) -> [Interval; 3] {
        let of = |axis| interval(self.cells.bounds(cell.0, axis));
        [of(0), of(1), interval(self.times.bounds(cell.1))]
    }

    fn values(&mut self, cell: &Brick) -> Option<[Interval; 3]> {
        let field = self.cells.field(self.element, cell.0, 0);
        let (spins, travels) = self.times.twist(cell.1);
        let g = envelope(spins, travels, &field);
        let error = ROUNDING * envelope_size(self.element, self.times);
        if g.0 > error || g.1 < -error || (g.0 == 0.0 && g.1 == 0.0) {
            return None;
        }
        let [x, y] = plane_values(self.element, self.cells, self.times, *cell, &self.size);
        Some([x, y, Interval::new(g.0 - error, g.1 + error)])
    }

    fn jacobian(&mut self, cell: &Brick) -> [[Interval; 3]; 3] {
        let zero = Interval::new(0.0, 0.0);
        let mut jacobian = [[zero; 3]; 3];
        for axis in 0..2 {
            let slope = self.cells.slope(self.element, cell.0, axis);
            for r in 0..2 {
                jacobian[r][axis] = interval(products(self.times.rows(cell.1, r), &slope));
            }
            let slopes = self.cells.field_slope(cell.0, 0, axis);
            let (spins, travels) = self.times.twist(cell.1);
            jacobian[2][axis] = interval(envelope(spins, travels, &slopes));
        }
        let turning = turning(self.element, self.cells, self.times, *cell);
        for r in 0..2 {
            jacobian[r][2] = turning[r];
        }
        let (spins, travels) = self.times.twist_slope(cell.1);
        if !travels.is_empty() {
            let field = self.cells.field(self.element, cell.0, 0);
            jacobian[2][2] = interval(if spins.is_empty() {
                products(travels, &field[0])
            } else {
                envelope(spins, travels, &field)
            });
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

    fn evaluate(&self, x: &[f64; 3]) -> Sample<3, OnFace> {
        let instant = self.motion.at(self.times, x[2]);
        let (spot, [g, g_u, g_v], g_t) = match &self.element.revolution {
            Some(revolution) => {
                let turned = revolution.at(&instant.placing, [x[0], x[1]]);
                let g_t = turned.envelope(&instant.change);
                (turned.spot(), turned.envelopes(&instant.own), g_t)
            }
            None => {
                let (spot, fields) = instant.placing.spot(self.element, [x[0], x[1]]);
                let g = fields.map(|field| instant.own.dot(&field));
                (spot, g, instant.change.dot(&fields[0]))
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
            seen: OnFace {
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
        [slack, slack, ROUNDING * envelope_size(self.element, self.times)]
    }
}

/// Ranges of X and Y.
fn plane_values(element: &Element, cells: &Cells, times: &Times, (cell, piece): Brick, size: &Size) -> [Interval; 2] {
    let position = cells.position(element, cell);
    [0, 1].map(|r| {
        if let Some([offsets, _]) = times.offsets(piece, r) {
            let (lo, hi) = shifted_products(times.rows(piece, r), offsets, &position);
            return Interval::new(lo - size.slack, hi + size.slack);
        }
        let (lo, hi) = products(times.rows(piece, r), &position);
        let (a, b) = times.tip(piece, r);
        Interval::new(lo + a - size.slack, hi + b + size.slack)
    })
}

/// Ranges of `∂X/∂t` and `∂Y/∂t`: `b′ + A′ F`.
fn turning(element: &Element, cells: &Cells, times: &Times, (cell, piece): Brick) -> [Interval; 2] {
    let position = cells.position(element, cell);
    [0, 1].map(|r| {
        let (rows, pace) = times.spin_rows(piece, r);
        if let Some([_, offsets]) = times.offsets(piece, r) {
            return interval(shifted_products(rows, offsets, &position));
        }
        let (lo, hi) = scaled(products(rows, &position), pace);
        let (slowest, fastest) = times.velocity(piece, r);
        Interval::new(lo + slowest, hi + fastest)
    })
}

/// A sharp edge under a motion.
pub(crate) struct Rim<'a> {
    pub element: &'a Element,
    pub cells: &'a mut Cells,
    pub times: &'a mut Times,
    pub motion: Motion<'a>,
    pub size: Size,
}

/// The sign of `g` over a cell: `Some(true)` negative, `Some(false)` not negative, `None` both or unclear.
fn negative((lo, hi): (f64, f64), error: f64) -> Option<bool> {
    if hi < -error {
        Some(true)
    } else if lo > error || (lo == 0.0 && hi == 0.0) {
        Some(false)
    } else {
        None
    }
}

impl ChartMap<2> for Rim<'_> {
    type Cell = Brick;
    type Seen = OnRim;

    fn bounds(&self, cell: &Brick) -> [Interval; 2] {
        [
            interval(self.cells.bounds(cell.0, 0)),
            interval(self.times.bounds(cell.1)),
        ]
    }

    fn values(&mut self, cell: &Brick) -> Option<[Interval; 2]> {
        let error = ROUNDING * envelope_size(self.element, self.times);
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

    fn jacobian(&mut self, cell: &Brick) -> [[Interval; 2]; 2] {
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

    fn evaluate(&self, x: &[f64; 2]) -> Sample<2, OnRim> {
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
            seen: OnRim {
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
        [self.size.slack; 2]
    }
}

/// What the tool does just before or after a pose, as its velocity there: in the tool's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twist {
    pub spin: [f64; 3],
    pub travel: [f64; 3],
}

/// A side of a joint: the motion there, or none at the end of a path. The sign of `g` is then fixed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Moving(Twist),
    /// Beyond the end: `true` counts as `g < 0`.
    Beyond(bool),
}

impl Side {
    fn negative(&self, field: &[Triples; 2], element: &Element) -> Option<bool> {
        match self {
            Self::Beyond(negative) => Some(*negative),
            Self::Moving(twist) => {
                let sum = |v: &[f64; 3]| v.iter().map(|x| x.abs()).sum::<f64>();
                let size = sum(&twist.spin) * element.largest_moment + sum(&twist.travel) * element.largest_normal;
                negative(envelope(&[twist.spin], &[twist.travel], field), ROUNDING * size)
            }
        }
    }

    fn seen(&self, frame: Option<&Frame>) -> Seen {
        match self {
            Self::Beyond(negative) => Seen::Beyond(*negative),
            Self::Moving(twist) => Seen::Moving(Twisted::new(&twist.spin.into(), &twist.travel.into(), frame)),
        }
    }
}

/// A side of a joint as the frame of a patch sees it.
enum Seen {
    Moving(Twisted),
    Beyond(bool),
}

/// A placed patch between two motions: a kink of the path, or a cap at its start or end.
pub(crate) struct Joint<'a> {
    pub element: &'a Element,
    pub cells: &'a mut Cells,
    turn: Matrix3<f64>,
    tip: Vector3<f64>,
    before: Side,
    after: Side,
    size: Size,
    placing: Placing,
    seen: [Seen; 2],
}

impl<'a> Joint<'a> {
    /// A patch turned by `turn`, its tip at `tip`.
    pub fn new(
        element: &'a Element,
        cells: &'a mut Cells,
        (turn, tip): (Matrix3<f64>, Vector3<f64>),
        [before, after]: [Side; 2],
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

    fn row(&self, r: usize) -> [[f64; 3]; 1] {
        [[self.turn[(r, 0)], self.turn[(r, 1)], self.turn[(r, 2)]]]
    }
}

impl ChartMap<2> for Joint<'_> {
    type Cell = u32;
    type Seen = OnJoint;

    fn bounds(&self, cell: &u32) -> [Interval; 2] {
        [0, 1].map(|axis| interval(self.cells.bounds(*cell, axis)))
    }

    fn values(&mut self, cell: &u32) -> Option<[Interval; 2]> {
        let field = self.cells.field(self.element, *cell, 0);
        let before = self.before.negative(&field, self.element);
        if before.is_some() && before == self.after.negative(&field, self.element) {
            return None;
        }
        let position = self.cells.position(self.element, *cell);
        Some([0, 1].map(|r| {
            let (lo, hi) = products(&self.row(r), &position);
            Interval::new(lo + self.tip[r] - self.size.slack, hi + self.tip[r] + self.size.slack)
        }))
    }

    fn jacobian(&mut self, cell: &u32) -> [[Interval; 2]; 2] {
        let slopes = [0, 1].map(|axis| self.cells.slope(self.element, *cell, axis));
        [0, 1].map(|r| [0, 1].map(|axis| interval(products(&self.row(r), &slopes[axis]))))
    }

    fn split(&mut self, cell: &u32, axis: usize) -> [u32; 2] {
        self.cells.split(self.element, *cell, axis)
    }

    fn evaluate(&self, x: &[f64; 2]) -> Sample<2, OnJoint> {
        let near = |side: &Seen, envelopes: &dyn Fn(&Twisted) -> [f64; 3]| match side {
            Seen::Moving(twist) => {
                let [value, in_u, in_v] = envelopes(twist);
                Near {
                    value,
                    slope: [in_u, in_v],
                }
            }
            Seen::Beyond(negative) => Near {
                value: if *negative { -1.0 } else { 1.0 },
                slope: [0.0; 2],
            },
        };
        let (spot, [before, after]) = match &self.element.revolution {
            Some(revolution) => {
                let turned = revolution.at(&self.placing, *x);
                let sides = self
                    .seen
                    .each_ref()
                    .map(|side| near(side, &|twist| turned.envelopes(twist)));
                (turned.spot(), sides)
            }
            None => {
                let (spot, fields) = self.placing.spot(self.element, *x);
                let envelopes = |twist: &Twisted| fields.map(|field| twist.dot(&field));
                (spot, self.seen.each_ref().map(|side| near(side, &envelopes)))
            }
        };
        let [in_u, in_v] = &spot.slopes;
        Sample {
            value: [spot.place[0], spot.place[1]],
            jacobian: [[in_u[0], in_v[0]], [in_u[1], in_v[1]]],
            seen: OnJoint {
                height: Near {
                    value: spot.place[2],
                    slope: [in_u[2], in_v[2]],
                },
                before,
                after,
                normal: vector(&spot.normal),
            },
        }
    }

    fn scales(&self) -> [f64; 2] {
        self.size.spacing
    }

    fn rounding(&self) -> [f64; 2] {
        [self.size.slack; 2]
    }
}
