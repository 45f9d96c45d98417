//! A motion of any degree cut into pieces of `t`.
//!
//! Each piece keeps the Bernstein coefficients of `Â, ŵ`, of `b`, of the rates `A′, b′` as numerators and denominators, and of the twist
//! (the velocity in the tool's frame, times one positive factor). Coefficients over weights are control values: the smallest and largest
//! bound a rational form, because it is a convex combination of them.

use crate::algebra::bivariate::MOST;
use crate::algebra::nodes::{Divided, Recent};
use crate::algebra::ranges::{all_or_none, range_of};
use crate::time::moment::{Moment, Rows};
use crate::time::pieces::{PRODUCT, Sizes};
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::Segment;
use sweepsim_solve::CUT;
use sweepsim_spline::kernel;

/// Coefficients of forms of one degree in `t`, one after another: `width` numbers each.
#[derive(Clone, Debug)]
struct Channel {
    width: usize,
    c: Vec<f64>,
}

impl Channel {
    fn new<'a>(rows: impl Iterator<Item = (&'a [f64], Option<f64>)>) -> Self {
        let (mut width, mut c) = (0, Vec::new());
        for (row, weight) in rows {
            let before = c.len();
            c.extend_from_slice(row);
            c.extend(weight);
            width = c.len() - before;
        }
        Self { width, c }
    }

    fn len(&self) -> usize {
        self.c.len() / self.width
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.c[i * self.width..][..self.width]
    }

    fn split(&self, at: f64) -> [Self; 2] {
        let (mut lower, mut upper) = (self.clone(), self.clone());
        kernel::split_at(&mut upper.c, &mut lower.c, self.len() - 1, self.width, at);
        [lower, upper]
    }

    /// Value and derivative of component `k`, given the polynomials of this degree.
    fn at(&self, t: f64) -> [Vec<f64>; 2] {
        let (mut values, mut slopes) = ([0.0; MOST], [0.0; MOST]);
        kernel::basis_with_slopes(self.len() - 1, t, &mut values, &mut slopes);
        [values, slopes].map(|factors| {
            let mut sum = vec![0.0; self.width];
            for i in 0..self.len() {
                for (sum, c) in sum.iter_mut().zip(self.row(i)) {
                    *sum += factors[i] * c;
                }
            }
            sum
        })
    }
}

const TURN: usize = 0;
const TURN_RATE: usize = 1;
const TIP: usize = 2;
const TIP_RATE: usize = 3;
const SPIN: usize = 4;
const TRAVEL: usize = 5;

#[derive(Clone, Debug)]
pub(super) struct TimePiece {
    lower: f64,
    upper: f64,
    parts: u32,
    channels: [Channel; 6],
    rows: [Vec<[f64; 3]>; 3],
    spin_rows: [Vec<[f64; 3]>; 2],
    tip: [(f64, f64); 2],
    velocity: [(f64, f64); 2],
    /// Control values of `b` and of `b′`, if they have the same weights as those of `A` and `A′`.
    offsets: Option<[[Vec<f64>; 2]; 2]>,
    twist: [Vec<[f64; 3]>; 2],
    twist_slope: [Vec<[f64; 3]>; 2],
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
pub(crate) struct CurveTimes {
    pub(super) nodes: Vec<TimePiece>,
    pub(super) recent: Recent,
    pub sizes: Sizes,
    /// Whether orientation and tip have the same weights: then `X` is a convex combination of sums of control values.
    joint: bool,
}

/// Bounds of the components of some vectors `Aᵀ v` in the tool's frame, which hold their rounding, too: a component may be a small difference of products, but only of those that it is
/// a sum of, which `|A|ᵀ |A|` times the largest components bounds. A face that slides along itself has the sign of a component that is a tiny part of the whole. As in [`back_size`],
/// nothing cancels if there is only one `A`.
///
/// [`back_size`]: crate::time::pieces::back_size
fn component_sizes(segment: &Segment, list: &[Vector3<f64>]) -> [f64; 3] {
    let own = list.iter().fold(Vector3::zeros(), |most, v| most.sup(&v.abs()));
    if segment.turns().len() == 1 {
        return own.into();
    }
    let controls = segment.turns().iter().zip(segment.weights());
    let turned = controls.fold(Matrix3::zeros(), |most, (turn, weight)| {
        most.sup(&(turn.abs() / *weight))
    });
    (own + turned.transpose() * (turned * own) * PRODUCT).into()
}

fn triples(channel: &Channel) -> Vec<[f64; 3]> {
    let triple = |i: usize| [0, 1, 2].map(|k| channel.row(i)[k]);
    certain((0..channel.len()).map(triple).collect())
}

/// Rows whose ranges may be computed: see [`all_or_none`].
fn certain(mut rows: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    all_or_none(rows.as_flattened_mut());
    rows
}

fn slopes(channel: &Channel, width: f64) -> Vec<[f64; 3]> {
    let factor = (channel.len() - 1) as f64 / width;
    let slope = |i: usize| [0, 1, 2].map(|k| factor * (channel.row(i + 1)[k] - channel.row(i)[k]));
    (0..channel.len() - 1).map(slope).collect()
}

/// Row `r` of matrices over their weights.
fn control_rows(channel: &Channel, r: usize) -> Vec<[f64; 3]> {
    let row = |i: usize| {
        let c = channel.row(i);
        [0, 1, 2].map(|k| c[r + 3 * k] / c[9])
    };
    certain((0..channel.len()).map(row).collect())
}

/// The range of component `r` of vectors over their weights.
fn range(channel: &Channel, r: usize) -> (f64, f64) {
    range_of(values(channel, r))
}

impl CurveTimes {
    pub fn new(segment: &Segment) -> Self {
        let matrices = |turns: &[Matrix3<f64>], weights: &[f64]| {
            Channel::new(
                turns
                    .iter()
                    .map(Matrix3::as_slice)
                    .zip(weights.iter().copied().map(Some)),
            )
        };
        let vectors = |points: &[Vector3<f64>], weights: &[f64]| {
            Channel::new(
                points
                    .iter()
                    .map(Vector3::as_slice)
                    .zip(weights.iter().copied().map(Some)),
            )
        };
        let bare = |vectors: &[Vector3<f64>]| Channel::new(vectors.iter().map(|v| (v.as_slice(), None)));
        let (turn_rate, tip, tip_rate) = (segment.turn_rate(), segment.points(), segment.tip_rate());
        let (spins, travels) = segment.twist();
        let channels = [
            matrices(segment.turns(), segment.weights()),
            matrices(&turn_rate.0, &turn_rate.1),
            vectors(&tip.0, &tip.1),
            vectors(&tip_rate.0, &tip_rate.1),
            bare(&spins),
            bare(&travels),
        ];
        let joint = segment.weights() == tip.1 && turn_rate.1 == tip_rate.1;
        let mut times = Self {
            joint,
            nodes: Vec::with_capacity(32),
            recent: Recent::default(),
            sizes: [component_sizes(segment, &spins), component_sizes(segment, &travels)],
        };
        times.nodes.push(node(0.0, 1.0, channels, joint));
        times
    }

    /// A piece over any interval, `lower ≤ upper`, in the motion or a little beyond it.
    pub fn place(&mut self, lower: f64, upper: f64) -> u32 {
        let channels = self.nodes[0].channels.each_ref().map(|channel| {
            // Two cuts, the second in what remains after the first, which must not be short since we divide by its length.
            if upper >= 0.5 {
                let [below, _] = channel.split(upper);
                let [_, part] = below.split(lower / upper);
                part
            } else {
                let [_, above] = channel.split(lower);
                let [part, _] = above.split((upper - lower) / (1.0 - lower));
                part
            }
        });
        self.nodes.push(node(lower, upper, channels, self.joint));
        self.nodes.len() as u32 - 1
    }

    pub fn bounds(&self, piece: u32) -> (f64, f64) {
        let node = &self.nodes[piece as usize];
        (node.lower, node.upper)
    }

    pub fn split(&mut self, piece: u32) -> [u32; 2] {
        let source = &self.nodes[piece as usize];
        if source.parts != u32::MAX {
            return [source.parts, source.parts + 1];
        }
        let (lower, upper) = (source.lower, source.upper);
        let at = lower + CUT * (upper - lower);
        let halves = source.channels.each_ref().map(|channel| channel.split(CUT));
        let [low, high] = [0, 1].map(|half| halves.each_ref().map(|pair| pair[half].clone()));
        let first = self.nodes.len() as u32;
        self.nodes.push(node(lower, at, low, self.joint));
        self.nodes.push(node(at, upper, high, self.joint));
        self.nodes[piece as usize].parts = first;
        [first, first + 1]
    }

    pub fn rows(&self, piece: u32, r: usize) -> Rows<'_> {
        &self.nodes[piece as usize].rows[r]
    }

    pub fn spin_rows(&self, piece: u32, r: usize) -> Rows<'_> {
        &self.nodes[piece as usize].spin_rows[r]
    }

    pub fn twist(&self, piece: u32) -> (Rows<'_>, Rows<'_>) {
        let [spins, travels] = &self.nodes[piece as usize].twist;
        (spins, travels)
    }

    pub fn twist_slope(&self, piece: u32) -> (Rows<'_>, Rows<'_>) {
        let [spins, travels] = &self.nodes[piece as usize].twist_slope;
        (spins, travels)
    }

    pub fn tip(&self, piece: u32, r: usize) -> (f64, f64) {
        self.nodes[piece as usize].tip[r]
    }

    pub fn velocity(&self, piece: u32, r: usize) -> (f64, f64) {
        self.nodes[piece as usize].velocity[r]
    }

    /// Control values of the coordinate `r` of `b`, and of `b′`, that go with the rows of `A` and `A′`.
    pub fn offsets(&self, piece: u32, r: usize) -> Option<[&[f64]; 2]> {
        let offsets = self.nodes[piece as usize].offsets.as_ref()?;
        Some([&offsets[0][r], &offsets[1][r]])
    }

    pub fn at(&self, t: f64) -> Moment {
        let channels = &self.nodes[0].channels;
        let vector = |c: &[f64]| Vector3::new(c[0], c[1], c[2]);
        let over = |channel: usize| {
            let [value, _] = channels[channel].at(t);
            vector(&value) / value[3]
        };
        let [turn, _] = channels[TURN].at(t);
        let turn = Matrix3::from_column_slice(&turn[..9]) / turn[9];
        let [rate, _] = channels[TURN_RATE].at(t);
        // [ω]× = A′ Aᵀ
        let m = Matrix3::from_column_slice(&rate[..9]) / rate[9] * turn.transpose();
        let spin = Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5;
        let [own_spin, own_spin_slope] = channels[SPIN].at(t);
        let [travel, travel_slope] = channels[TRAVEL].at(t);
        Moment {
            turn,
            tip: over(TIP),
            spin,
            velocity: over(TIP_RATE),
            own_spin: vector(&own_spin),
            own_spin_slope: (channels[SPIN].len() > 1).then(|| vector(&own_spin_slope)),
            travel: vector(&travel),
            travel_slope: vector(&travel_slope),
        }
    }
}

/// Component `r` of vectors over their weights.
fn values(channel: &Channel, r: usize) -> Vec<f64> {
    let value = |i: usize| channel.row(i)[r] / channel.row(i)[3];
    let mut values: Vec<f64> = (0..channel.len()).map(value).collect();
    all_or_none(&mut values);
    values
}

fn node(lower: f64, upper: f64, channels: [Channel; 6], joint: bool) -> TimePiece {
    let width = upper - lower;
    TimePiece {
        offsets: joint.then(|| [TIP, TIP_RATE].map(|k| [0, 1].map(|r| values(&channels[k], r)))),
        rows: [0, 1, 2].map(|r| control_rows(&channels[TURN], r)),
        spin_rows: [0, 1].map(|r| control_rows(&channels[TURN_RATE], r)),
        tip: [0, 1].map(|r| range(&channels[TIP], r)),
        velocity: [0, 1].map(|r| range(&channels[TIP_RATE], r)),
        twist: [SPIN, TRAVEL].map(|k| triples(&channels[k])),
        twist_slope: [SPIN, TRAVEL].map(|k| slopes(&channels[k], width)),
        lower,
        upper,
        parts: u32::MAX,
        channels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::path_parts::parts;
    use crate::tolerances::Tolerances;
    use sweepsim_motion::{Move, Path, Pose, TipArc};
    use sweepsim_props::*;

    /// A tip on a quarter of a circle, and an axis that leans on the way.
    fn times() -> CurveTimes {
        let pose = |tip: [f64; 3], lean: f64| Pose::new(tip, [lean, 0.0, 1.0]).unwrap();
        let poses = vec![pose([10.0, 0.0, 0.0], 0.0), pose([0.0, 10.0, 0.0], 0.3)];
        let arc = TipArc::new([0.0; 3], [0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2).unwrap();
        let path = Path::with_moves(poses, vec![Move::arc(arc)]).unwrap();
        let parts = parts(
            (&path, 0..path.moves()),
            &sweepsim_dexel::Frame::WORLD,
            crate::time::path_parts::Kind {
                symmetric: true,
                closed: false,
            },
            40.0,
            &Tolerances::new(1e-6, 100.0).unwrap(),
        );
        CurveTimes::new(&parts[0].segment)
    }

    fn check(lower: f64, upper: f64) -> Result<(), TestCaseError> {
        let mut times = times();
        let piece = times.place(lower, upper);
        for r in 0..2 {
            let numbers = times.rows(piece, r).iter().chain(times.spin_rows(piece, r)).flatten();
            let (tip, velocity) = (times.tip(piece, r), times.velocity(piece, r));
            let ranges = [tip.0, tip.1, velocity.0, velocity.1];
            prop_assert!(numbers.chain(&ranges).all(|x| x.is_finite()), "{lower} {upper}");
            for part in [0.0, 0.3, 1.0] {
                let moment = times.at(lower + part * (upper - lower));
                prop_assert!(tip.0 - 1e-12 <= moment.tip[r] && moment.tip[r] <= tip.1 + 1e-12);
                let place = moment.velocity[r];
                prop_assert!(velocity.0 - 1e-11 <= place && place <= velocity.1 + 1e-11);
            }
        }
        // The ends of the piece are those of the motion.
        for (t, row) in [(lower, 0), (upper, times.rows(piece, 0).len() - 1)] {
            let turn = times.at(t).turn;
            for k in 0..3 {
                prop_assert!((times.rows(piece, 0)[row][k] - turn[(0, k)]).abs() < 1e-13);
            }
        }
        Ok(())
    }

    #[test]
    fn pieces_may_end_at_the_start_of_the_motion() {
        for (lower, upper) in [
            (0.0, 0.0),
            (-1e-3, 0.0),
            (-1e-3, 1e-300),
            (0.0, 1e-320),
            (1e-320, 2e-320),
            (1.0, 1.0),
            (1.0, 1.001),
        ] {
            check(lower, upper).unwrap();
        }
    }

    proptest! {
        #[test]
        fn pieces_anywhere_hold_the_motion(lower in -0.01..1.0, width in prop_oneof![Just(0.0), 0.0..1e-9, 0.0..1.0]) {
            check(lower, f64::min(lower + width, 1.01))?;
        }
    }
}
