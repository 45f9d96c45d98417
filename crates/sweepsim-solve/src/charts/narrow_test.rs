//! Narrowing, on quadratic maps with planted preimages.

use super::narrow::{Narrowed, narrowed};
use super::{ChartMap, ChartOptions, ChartSolver, ChartTarget, Preimage, Sample, Sink, Targets, UnresolvedTarget};
use crate::{CUT, CancelOnly, Enclosure};
use nalgebra::{Matrix3, Vector3};
use sweepsim_props::strategy::ValueTree;
use sweepsim_props::test_runner::TestRunner;
use sweepsim_props::*;

type Box3 = [Enclosure; 3];

/// `Φᵢ = ⟨Lᵢ, d⟩ + ⟨d, Hᵢ d⟩/2` with `d = x − x₀`. Its enclosures are exact up to rounding.
struct Quadratic {
    origin: Vector3<f64>,
    linear: Matrix3<f64>,
    hessians: [Matrix3<f64>; 3],
    can_narrow: bool,
    /// The narrowed cells that have not been dropped.
    kept: usize,
}

impl Quadratic {
    /// `P ψ(L d)`, where `P` and `L` are near the identity, with `ψ = (w₁ + c w₃², w₂ + e w₃², w₃² + f w₁w₂)`.
    fn fold(origin: Vector3<f64>, [outer, inner]: [Matrix3<f64>; 2], [c, e, f]: [f64; 3]) -> Self {
        let slopes = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
        let mut hessians = [Matrix3::zeros(); 3];
        for (hessian, curvature) in hessians.iter_mut().zip([c, e, 1.0]) {
            hessian[(2, 2)] = 2.0 * curvature;
        }
        hessians[2][(0, 1)] = f;
        hessians[2][(1, 0)] = f;
        let own = hessians.map(|hessian| inner.transpose() * hessian * inner);
        Self {
            origin,
            linear: outer * slopes * inner,
            hessians: std::array::from_fn(|i| (0..3).map(|k| own[k] * outer[(i, k)]).sum()),
            can_narrow: true,
            kept: 0,
        }
    }
}

fn middle(cell: &Box3) -> [f64; 3] {
    cell.map(Enclosure::mid)
}

impl ChartMap<3> for Quadratic {
    type Cell = Box3;
    type Seen = ();

    fn bounds(&self, cell: &Box3) -> Box3 {
        *cell
    }

    fn values(&mut self, cell: &Box3) -> Option<Box3> {
        let Sample { value, jacobian, .. } = self.evaluate(&middle(cell));
        let half = Vector3::from(cell.map(Enclosure::radius));
        Some(std::array::from_fn(|i| {
            let slopes = Vector3::from(jacobian[i]).abs();
            let reach = slopes.dot(&half) + 0.5 * half.dot(&(self.hessians[i].abs() * half)) + 1e-14;
            Enclosure::hull(value[i] - reach, value[i] + reach)
        }))
    }

    fn jacobian(&mut self, cell: &Box3) -> [[Enclosure; 3]; 3] {
        let own = self.evaluate(&middle(cell)).jacobian;
        let half = Vector3::from(cell.map(Enclosure::radius));
        std::array::from_fn(|i| {
            let reach = self.hessians[i].abs() * half;
            std::array::from_fn(|j| Enclosure::hull(own[i][j] - reach[j], own[i][j] + reach[j]))
        })
    }

    fn split(&mut self, cell: &Box3, axis: usize) -> [Box3; 2] {
        let at = cell[axis].lo() + CUT * (cell[axis].hi() - cell[axis].lo());
        let (mut lower, mut upper) = (*cell, *cell);
        lower[axis] = Enclosure::hull(cell[axis].lo(), at);
        upper[axis] = Enclosure::hull(at, cell[axis].hi());
        [lower, upper]
    }

    fn narrowed(&mut self, _: &Box3, part: &Box3) -> Option<Box3> {
        self.kept += usize::from(self.can_narrow);
        self.can_narrow.then_some(*part)
    }

    fn drop_narrowed(&mut self, _: Box3) {
        self.kept -= 1;
    }

    fn evaluate(&self, x: &[f64; 3]) -> Sample<3, ()> {
        let d = Vector3::from(*x) - self.origin;
        let bent = self.hessians.map(|hessian| hessian * d);
        Sample {
            value: std::array::from_fn(|i| (self.linear * d)[i] + 0.5 * bent[i].dot(&d)),
            jacobian: std::array::from_fn(|i| std::array::from_fn(|j| self.linear[(i, j)] + bent[i][j])),
            seen: (),
        }
    }

    fn scales(&self) -> [f64; 3] {
        [1.0; 3]
    }

    fn rounding(&self) -> [f64; 3] {
        [1e-14; 3]
    }
}

/// One target.
struct One([f64; 3]);

impl Targets<3> for One {
    fn count(&self, range: &Box3) -> usize {
        usize::from((0..3).all(|k| range[k].contains(self.0[k])))
    }

    fn visit(
        &self,
        range: &Box3,
        narrow: &dyn Fn(&[f64; 3]) -> Option<Enclosure>,
        visit: &mut dyn FnMut(&ChartTarget<3>) -> bool,
    ) {
        let value = self.0;
        if self.count(range) > 0 && narrow(&value).is_some_and(|window| window.contains(value[1])) {
            let (number, place) = (0, [0, 0]);
            visit(&ChartTarget { number, place, value });
        }
    }
}

#[derive(Default)]
struct Found {
    places: Vec<[f64; 3]>,
    open: usize,
}

impl Sink<3> for Found {
    fn found(&mut self, preimage: Preimage<3>) {
        self.places.push(preimage.x);
    }

    fn mark(&self) -> usize {
        self.places.len()
    }

    fn forget(&mut self, mark: usize) {
        self.places.truncate(mark);
    }

    fn forget_targets(&mut self, _: usize, targets: &[usize]) {
        unreachable!("{targets:?}");
    }

    fn unresolved(&mut self, _: UnresolvedTarget<3>) {
        self.open += 1;
    }
}

/// The preimages of a target in the unit cube, and the number of boxes.
fn solve(map: &mut Quadratic, target: [f64; 3]) -> (Found, u64) {
    let mut solver = ChartSolver::new(ChartOptions::default());
    let mut found = Found::default();
    solver.solve(map, [Enclosure::UNIT; 3], &One(target), &mut found, &CancelOnly(&()));
    assert_eq!(map.kept, 0, "narrowed cells are dropped");
    (found, solver.statistics.boxes)
}

fn matrix(entries: &[f64]) -> Matrix3<f64> {
    Matrix3::from_row_slice(entries)
}

fn entries() -> impl Strategy<Value = Vec<f64>> {
    collection::vec(-1.0..1.0, 9)
}

/// A box of this size that holds a place.
fn around(place: [f64; 3], shares: [f64; 3], sizes: [f64; 3]) -> Box3 {
    std::array::from_fn(|k| Enclosure::hull(place[k] - sizes[k] * shares[k], place[k] + sizes[k] * (1.0 - shares[k])))
}

/// Whether the part to which a box is narrowed holds the places in it whose values were asked for; `None` if it is not narrowed.
fn keeps(map: &mut Quadratic, cell: &Box3, places: &[[f64; 3]]) -> Option<bool> {
    let values: Vec<[f64; 3]> = places.iter().map(|place| map.evaluate(place).value).collect();
    let range = std::array::from_fn(|k| {
        let own = values.iter().map(|value| value[k]);
        Enclosure::hull(
            own.clone().fold(f64::INFINITY, f64::min),
            own.fold(f64::NEG_INFINITY, f64::max),
        )
    });
    let jacobian = map.jacobian(cell);
    match narrowed(map, cell, (cell, &jacobian), &range, &mut 0)? {
        Narrowed::Empty => Some(false),
        Narrowed::To(part) => Some(places.iter().all(|place| (0..3).all(|k| part[k].contains(place[k])))),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The part to which a box is narrowed holds the preimages of all targets, however singular the map is there.
    #[test]
    fn parts_hold_all_preimages(
        outer in entries(), inner in entries(), bent in collection::vec(-1.0..1.0, 27), rank in 0..3_usize, flat in 0..14_i32,
        origin in [0.0..1.0, 0.0..1.0, 0.0..1.0], shares in [0.0..1.0, 0.0..1.0, 0.0..1.0], size in 0..24_i32, slim in [0..12_i32, 0..12_i32, 0..12_i32],
        other in [0.0..1.0, 0.0..1.0, 0.0..1.0], near in 0..40_i32,
    ) {
        let mut scale = Matrix3::identity();
        for k in rank..3 {
            scale[(k, k)] = 0.1_f64.powi(flat);
        }
        let symmetric = |of: &[f64]| (matrix(of) + matrix(of).transpose()) * 0.5;
        let hessians = [symmetric(&bent[..9]), symmetric(&bent[9..18]), symmetric(&bent[18..])];
        let mut map = Quadratic {
            origin: origin.into(), linear: matrix(&outer) * scale * matrix(&inner), hessians, can_narrow: true, kept: 0,
        };
        let sizes = slim.map(|slim| 0.5_f64.powi(size + slim));
        let place: [f64; 3] = std::array::from_fn(|k| origin[k] + sizes[k] * 0.3 * (shares[k] - 0.5));
        let cell = around(place, shares, sizes);
        // The second target's preimage is anywhere in the box, or very near the first.
        let other: [f64; 3] = std::array::from_fn(|k| {
            place[k] + 0.5_f64.powi(near) * (cell[k].lo() + other[k] * (cell[k].hi() - cell[k].lo()) - place[k])
        });
        prop_assert_ne!(keeps(&mut map, &cell, &[place]), Some(false));
        prop_assert_ne!(keeps(&mut map, &cell, &[place, other]), Some(false));
    }

    /// At a fold, `(0, 0, δ)` has exactly two preimages if `δ > 0` and none if `δ < 0`.
    #[test]
    fn preimages_at_folds_are_told_from_none(case in folds()) {
        let boxes = case.solve()?;
        // Of three million cases none took more than 579; a search that halves all three variables for each bit of δ takes millions.
        prop_assert!(boxes < 5000, "{} boxes", boxes);
    }
}

/// A fold, and a target at a distance `δ` from its values.
#[derive(Clone, Debug)]
struct Fold {
    outer: Vec<f64>,
    inner: Vec<f64>,
    bends: [f64; 3],
    origin: [f64; 3],
    digits: f64,
    is_above: bool,
}

fn folds() -> impl Strategy<Value = Fold> {
    let bends = [-0.4..0.4, -0.4..0.4, -0.4..0.4];
    let origin = [0.3..0.7, 0.3..0.7, 0.3..0.7];
    (entries(), entries(), bends, origin, 2.0..12.0_f64, any::<bool>()).prop_map(
        |(outer, inner, bends, origin, digits, is_above)| Fold {
            outer,
            inner,
            bends,
            origin,
            digits,
            is_above,
        },
    )
}

impl Fold {
    /// Checks the preimages, and returns the number of boxes.
    fn solve(&self) -> Result<u64, TestCaseError> {
        let near = |of: &[f64]| Matrix3::identity() + matrix(of) * 0.3;
        let (outer, inner, bends) = (near(&self.outer), near(&self.inner), self.bends);
        let mut map = Quadratic::fold(self.origin.into(), [outer, inner], bends);
        let size = 10.0_f64.powf(-self.digits);
        let delta = if self.is_above { size } else { -size };
        // With s = w₃² the equations give w₁ = c(δ − s), w₂ = e(δ − s) and (δ − s)(1 − f c e (δ − s)) = 0, of which the second factor is positive for |w| ≤ 2.
        let target = outer * Vector3::new(bends[0] * delta, bends[1] * delta, delta);
        let (found, boxes) = solve(&mut map, target.into());
        prop_assert_eq!(found.open, 0);
        prop_assert_eq!(found.places.len(), if self.is_above { 2 } else { 0 });
        for place in &found.places {
            let w = inner * (Vector3::from(*place) - map.origin);
            let off = (w.x.abs() + w.y.abs()).max((w.z.abs() - size.sqrt()).abs());
            prop_assert!(off < 1e-9 + 1e-12 / size.sqrt(), "{off:e}");
        }
        Ok(boxes)
    }
}

/// The same folds each time, so that their number of boxes is not a matter of luck.
#[test]
fn folds_take_few_boxes_on_average() {
    let mut runner = TestRunner::deterministic();
    let cases = 500;
    let boxes: u64 = (0..cases)
        .map(|_| folds().new_tree(&mut runner).expect("a fold").current())
        .map(|fold| fold.solve().expect("its preimages"))
        .sum();
    assert!(boxes < 90 * cases, "{boxes} boxes for {cases} folds");
}

/// Narrowing is not idle: without it, a fold takes more than twice as many boxes.
#[test]
fn folds_take_less_than_half_of_the_boxes() {
    let outer = Matrix3::new(1.0, 0.2, -0.1, 0.1, 1.0, 0.2, -0.2, 0.1, 1.0);
    let boxes = [true, false].map(|can_narrow| {
        let fold = Quadratic::fold(
            Vector3::new(0.43, 0.52, 0.61),
            [outer, outer.transpose()],
            [0.3, -0.2, 0.4],
        );
        let mut map = Quadratic { can_narrow, ..fold };
        let (found, boxes) = solve(&mut map, (outer * Vector3::new(0.3e-10, -0.2e-10, 1e-10)).into());
        assert_eq!((found.places.len(), found.open), (2, 0));
        boxes
    });
    assert!(2 * boxes[0] < boxes[1], "{boxes:?}");
}
