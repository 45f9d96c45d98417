//! Charts, and preimages on the faces between them, which rounding puts on either side.

use crate::support::targets::{Answer, List};
use sweepsim_props::*;
use sweepsim_solve::{ChartMap, ChartOptions, ChartSolver, Enclosure, Sample};

type Box2 = [Enclosure; 2];

/// `(eˣ′ + eʸ′/2, eˣ′/2 + eʸ′)` with `x′ = 3x`, `y′ = 3y`: one to one, and far from linear. Values are off by up to [`ROUNDING`], as a hash of the place tells.
struct Noisy {
    seed: u64,
}

const ROUNDING: f64 = 1e-12;
const GROWTH: f64 = 3.0;
const CUT: f64 = 0.492;

impl Noisy {
    fn noise(&self, x: &[f64; 2], row: u64) -> f64 {
        let mut state = self.seed ^ row.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        for part in x {
            state = (state ^ part.to_bits()).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            state ^= state >> 29;
        }
        0.9 * ROUNDING * (2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
    }
}

fn exact([x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b] = [x, y].map(|x| (GROWTH * x).exp());
    [a + 0.5 * b, 0.5 * a + b]
}

impl ChartMap<2> for Noisy {
    type Cell = Box2;
    type Seen = ();

    fn bounds(&self, cell: &Box2) -> Box2 {
        *cell
    }

    fn values(&mut self, cell: &Box2) -> Option<Box2> {
        let [low, high] = [exact(cell.map(|x| x.lo())), exact(cell.map(|x| x.hi()))];
        Some([0, 1].map(|k| Enclosure::hull(low[k] - ROUNDING, high[k] + ROUNDING)))
    }

    fn jacobian(&mut self, cell: &Box2) -> [[Enclosure; 2]; 2] {
        let slope = |x: &Enclosure, factor: f64| {
            let [lo, hi] = [x.lo(), x.hi()].map(|x| factor * GROWTH * (GROWTH * x).exp());
            Enclosure::hull(lo - 1e-13, hi + 1e-13)
        };
        let [x, y] = cell;
        [[slope(x, 1.0), slope(y, 0.5)], [slope(x, 0.5), slope(y, 1.0)]]
    }

    fn split(&mut self, cell: &Box2, axis: usize) -> [Box2; 2] {
        let at = cell[axis].lo() + CUT * (cell[axis].hi() - cell[axis].lo());
        let (mut lower, mut upper) = (*cell, *cell);
        lower[axis] = Enclosure::hull(cell[axis].lo(), at);
        upper[axis] = Enclosure::hull(at, cell[axis].hi());
        [lower, upper]
    }

    fn evaluate(&self, x: &[f64; 2]) -> Sample<2, ()> {
        let [a, b] = x.map(|x| (GROWTH * x).exp());
        let value = exact(*x);
        Sample {
            value: [0, 1].map(|k| value[k] + self.noise(x, k as u64)),
            jacobian: [[GROWTH * a, 0.5 * GROWTH * b], [0.5 * GROWTH * a, GROWTH * b]],
            seen: (),
        }
    }

    fn scales(&self) -> [f64; 2] {
        [1.0; 2]
    }

    fn rounding(&self) -> [f64; 2] {
        [ROUNDING; 2]
    }
}

/// A face between two boxes: where the interval to which these turns lead is cut.
fn face(turns: &[bool]) -> f64 {
    let (mut lower, mut upper) = (0.0, 1.0);
    for turn in turns {
        let at = lower + CUT * (upper - lower);
        if *turn {
            lower = at;
        } else {
            upper = at;
        }
    }
    lower + CUT * (upper - lower)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// However near to faces of boxes, in one direction or both, each preimage is found once.
    #[test]
    fn preimages_at_faces_are_found_once(
        turns in [collection::vec(any::<bool>(), 0..4), collection::vec(any::<bool>(), 0..4)],
        off in [-4e-13..4e-13_f64, -4e-13..4e-13], at_faces in 1..4_usize, elsewhere in [0.01..0.99_f64, 0.01..0.99], others in collection::vec([0.0..1.0_f64, 0.0..1.0], 0..30), seed in any::<u64>(),
    ) {
        let place = [0, 1].map(|k| if at_faces & (k + 1) != 0 { face(&turns[k]) + off[k] } else { elsewhere[k] });
        let places: Vec<[f64; 2]> = std::iter::once(place).chain(others).collect();
        let targets: Vec<[f64; 2]> = places.iter().map(|place| exact(*place)).collect();
        let mut solver = ChartSolver::new(ChartOptions::default());
        let mut answer = Answer::default();
        let root = [Enclosure::UNIT; 2];
        solver.solve(&mut Noisy { seed }, root, &List(targets), &mut answer, &());
        prop_assert!(answer.open.is_empty(), "{:?}", answer.open);
        for (number, place) in places.iter().enumerate() {
            let found: Vec<_> = answer.found.iter().filter(|found| found.target == number).collect();
            prop_assert!(found.len() == 1, "{number}: {place:?} {found:?}");
            prop_assert!((0..2).all(|k| (found[0].x[k] - place[k]).abs() < 4.0 * ROUNDING), "{place:?} {found:?}");
        }
    }
}
