//! The motion of an arc (straight tip, turn about one axis) cut into pieces of `t`: the simplest motion, in its lowest degrees.

use crate::algebra::nodes::{Divided, Recent};
use crate::time::moment::Moment;
use crate::time::pieces::{Sizes, back_size};
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Segment, turned_back};
use sweepsim_solve::CUT;

type Rows = [[f64; 3]; 3];

/// A piece of the motion: rows of `A(t)` over its weight, per Bernstein coefficient in `t`.
#[derive(Clone, Debug)]
pub(super) struct TimePiece {
    lower: f64,
    upper: f64,
    parts: u32,
    turns: [Matrix3<f64>; 3],
    weights: [f64; 3],
    /// Control rows of `A`.
    rows: [Rows; 3],
    /// Control rows of `[κk]× A` for X and for Y.
    spin_rows: [Rows; 2],
    /// Coefficients of `Âᵀ b′`, and of its derivative in `t`.
    travel: Rows,
    travel_slope: [[f64; 3]; 2],
    /// Range of `1/w`.
    pace: (f64, f64),
}

impl Divided for TimePiece {
    fn forget_parts(&mut self, from: u32) {
        if self.parts >= from {
            self.parts = u32::MAX;
        }
    }
}

/// The pieces of one segment, created on demand.
#[derive(Clone, Debug)]
pub(crate) struct ArcTimes {
    pub(super) nodes: Vec<TimePiece>,
    pub(super) recent: Recent,
    /// Coefficients in `t`: 1 or 3.
    pub count: usize,
    /// `κ A₀ᵀ k`.
    pub spin: [[f64; 3]; 1],
    pub tips: [Vector3<f64>; 2],
    pub velocity: Vector3<f64>,
    /// `κ k`.
    pace: Vector3<f64>,
    /// Bounds of the components of `κ A₀ᵀ k` and of `Âᵀ b′`.
    pub sizes: Sizes,
}

impl ArcTimes {
    pub fn new(segment: &Segment) -> Self {
        let count = segment.turns().len();
        let mut turns = [Matrix3::zeros(); 3];
        let mut weights = [1.0; 3];
        turns[..count].copy_from_slice(segment.turns());
        weights[..count].copy_from_slice(segment.weights());
        let mut times = Self {
            nodes: Vec::with_capacity(64),
            recent: Recent::default(),
            count,
            spin: [(segment.start().transpose() * Vector3::from(segment.spin())).into()],
            tips: segment.tips().map(Vector3::from),
            velocity: segment.travel().into(),
            pace: segment.spin().into(),
            sizes: [[0.0; 3]; 2],
        };
        let root = times.node(0.0, 1.0, turns, weights);
        times.sizes = [
            back_size(&turns[..1], &times.pace, count > 1),
            back_size(&turns[..count], &times.velocity, count > 1),
        ];
        times.nodes.push(root);
        times
    }

    pub fn place(&mut self, lower: f64, upper: f64) -> u32 {
        let root = &self.nodes[0];
        let (mut turns, mut weights) = (root.turns, root.weights);
        if self.count == 3 {
            // Values of the blossoms at (lower, lower), (lower, upper), (upper, upper).
            for (i, [a, b]) in [[lower, lower], [lower, upper], [upper, upper]].into_iter().enumerate() {
                let mix = [(1.0 - a) * (1.0 - b), (1.0 - a) * b + a * (1.0 - b), a * b];
                turns[i] = root.turns[0] * mix[0] + root.turns[1] * mix[1] + root.turns[2] * mix[2];
                weights[i] = root.weights[0] * mix[0] + root.weights[1] * mix[1] + root.weights[2] * mix[2];
            }
        }
        let node = self.node(lower, upper, turns, weights);
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    fn node(&self, lower: f64, upper: f64, turns: [Matrix3<f64>; 3], weights: [f64; 3]) -> TimePiece {
        let row = |m: &Matrix3<f64>, r: usize| [m[(r, 0)], m[(r, 1)], m[(r, 2)]];
        let mut node = TimePiece {
            lower,
            upper,
            parts: u32::MAX,
            turns,
            weights,
            rows: [[[0.0; 3]; 3]; 3],
            spin_rows: [[[0.0; 3]; 3]; 2],
            travel: [[0.0; 3]; 3],
            travel_slope: [[0.0; 3]; 2],
            pace: (f64::INFINITY, 0.0),
        };
        for i in 0..self.count {
            let turn = turns[i] / weights[i];
            let spin = self.pace.cross_matrix() * turn;
            for r in 0..3 {
                node.rows[r][i] = row(&turn, r);
            }
            for r in 0..2 {
                node.spin_rows[r][i] = row(&spin, r);
            }
            node.travel[i] = match self.nodes.first() {
                // Without rotation it is constant.
                Some(root) if self.count == 1 => root.travel[0],
                _ => turned_back(&turns[i], &self.velocity).into(),
            };
            node.pace.0 = node.pace.0.min(1.0 / weights[i]);
            node.pace.1 = node.pace.1.max(1.0 / weights[i]);
        }
        for i in 1..self.count {
            for k in 0..3 {
                node.travel_slope[i - 1][k] = 2.0 * (node.travel[i][k] - node.travel[i - 1][k]) / (upper - lower);
            }
        }
        node
    }

    pub fn bounds(&self, piece: u32) -> (f64, f64) {
        let node = &self.nodes[piece as usize];
        (node.lower, node.upper)
    }

    pub fn split(&mut self, piece: u32) -> [u32; 2] {
        let node = &self.nodes[piece as usize];
        if node.parts != u32::MAX {
            return [node.parts, node.parts + 1];
        }
        let (mut turns, mut weights) = ([node.turns, node.turns], [node.weights, node.weights]);
        if self.count == 3 {
            let (t, w) = (node.turns, node.weights);
            let mix = |a: Matrix3<f64>, b: Matrix3<f64>| a + (b - a) * CUT;
            let blend = |a: f64, b: f64| a + (b - a) * CUT;
            let (t0, t1, w0, w1) = (mix(t[0], t[1]), mix(t[1], t[2]), blend(w[0], w[1]), blend(w[1], w[2]));
            let (middle, weight) = (mix(t0, t1), blend(w0, w1));
            turns = [[t[0], t0, middle], [middle, t1, t[2]]];
            weights = [[w[0], w0, weight], [weight, w1, w[2]]];
        }
        let (lower, upper) = (node.lower, node.upper);
        let at = lower + CUT * (upper - lower);
        let parts = [
            self.node(lower, at, turns[0], weights[0]),
            self.node(at, upper, turns[1], weights[1]),
        ];
        let first = self.nodes.len() as u32;
        self.nodes.extend(parts);
        self.nodes[piece as usize].parts = first;
        [first, first + 1]
    }

    /// Control rows of the coordinate `r` of `A`.
    pub fn rows(&self, piece: u32, r: usize) -> &[[f64; 3]] {
        &self.nodes[piece as usize].rows[r][..self.count]
    }

    /// Control rows of the coordinate `r` of `[κk]× A`, and the range of `1/w` by which they must still be multiplied.
    pub fn spin_rows(&self, piece: u32, r: usize) -> (&[[f64; 3]], (f64, f64)) {
        let node = &self.nodes[piece as usize];
        (&node.spin_rows[r][..self.count], node.pace)
    }

    /// Coefficients of `Âᵀ b′`.
    pub fn travel(&self, piece: u32) -> &[[f64; 3]] {
        &self.nodes[piece as usize].travel[..self.count]
    }

    /// Coefficients of the derivative of `Âᵀ b′`.
    pub fn travel_slope(&self, piece: u32) -> &[[f64; 3]] {
        &self.nodes[piece as usize].travel_slope[..self.count - 1]
    }

    /// Where the tip is at both ends of a piece, in the plane of `X` and `Y`.
    pub fn chord(&self, piece: u32) -> [[f64; 2]; 2] {
        let node = &self.nodes[piece as usize];
        [node.lower, node.upper].map(|t| [0, 1].map(|r: usize| self.tips[0][r] + t * self.velocity[r]))
    }

    /// The range of the coordinate `r` of the tip.
    pub fn tip(&self, piece: u32, r: usize) -> (f64, f64) {
        let [a, b] = self.chord(piece).map(|end| end[r]);
        (a.min(b), a.max(b))
    }

    /// `κ k`.
    pub fn pace(&self) -> Vector3<f64> {
        self.pace
    }

    /// For the whole motion: `Â`, its weight and `Âᵀ b′`.
    pub fn coefficients(&self) -> impl Iterator<Item = (Matrix3<f64>, f64, Vector3<f64>)> {
        let root = &self.nodes[0];
        (0..self.count).map(|i| (root.turns[i], root.weights[i], root.travel[i].into()))
    }

    /// The motion at `t`.
    pub fn at(&self, t: f64) -> Moment {
        let root = &self.nodes[0];
        let tip = self.tips[0] + self.velocity * t;
        if self.count == 1 {
            let travel = Vector3::from(root.travel[0]);
            return Moment {
                turn: root.turns[0],
                tip,
                travel,
                travel_slope: Vector3::zeros(),
                spin: Vector3::zeros(),
                velocity: self.velocity,
                own_spin: self.spin[0].into(),
                own_spin_slope: None,
            };
        }
        let s = 1.0 - t;
        let (b, d) = ([s * s, 2.0 * s * t, t * t], [-2.0 * s, 2.0 * (s - t), 2.0 * t]);
        let mut weight = 0.0;
        let mut turn = Matrix3::zeros();
        let (mut travel, mut slope) = (Vector3::zeros(), Vector3::zeros());
        for i in 0..3 {
            weight += b[i] * root.weights[i];
            turn += root.turns[i] * b[i];
            travel += Vector3::from(root.travel[i]) * b[i];
            slope += Vector3::from(root.travel[i]) * d[i];
        }
        let turn = turn / weight;
        Moment {
            turn,
            tip,
            travel,
            travel_slope: slope,
            spin: self.pace / weight,
            velocity: self.velocity,
            own_spin: self.spin[0].into(),
            own_spin_slope: None,
        }
    }
}
