//! Bundles against the solver of single systems, target by target; roots on faces between boxes; solutions that are not isolated are reported.

use crate::support;

use support::planted::Random;
use support::targets::{Answer, List};
use sweepsim_solve::{
    Bundle, BundleSolver, ChartMap, ChartOptions, Enclosure, PointSolver, Preimage, Sample, Sink, System,
};
use sweepsim_spline::Bernstein;

/// A rational map by its forms: numerators over a weight, then forms that must be zero.
pub struct Forms<const N: usize> {
    pub numerators: Vec<Bernstein>,
    pub weight: Bernstein,
    pub zeros: Vec<Bernstein>,
}

impl<const N: usize> Forms<N> {
    fn bundle(&self) -> Bundle<N> {
        Bundle::new(self.numerators.clone(), &self.weight, self.zeros.clone()).unwrap()
    }

    /// The system of one target.
    fn system(&self, q: &[f64; N]) -> System {
        let numerators = self.numerators.iter().zip(q);
        let equations = numerators.map(|(p, q)| p.sub(&self.weight.scale(*q)));
        System::new(&[Enclosure::UNIT; N], equations.chain(self.zeros.iter().cloned())).unwrap()
    }
}

impl<const N: usize> ChartMap<N> for Forms<N> {
    type Cell = ();
    type Seen = ();

    fn bounds(&self, (): &()) -> [Enclosure; N] {
        [Enclosure::UNIT; N]
    }

    fn values(&mut self, (): &()) -> Option<[Enclosure; N]> {
        unreachable!("bundles ask for points only")
    }

    fn jacobian(&mut self, (): &()) -> [[Enclosure; N]; N] {
        unreachable!("bundles ask for points only")
    }

    fn split(&mut self, (): &(), _: usize) -> [(); 2] {
        unreachable!("bundles ask for points only")
    }

    fn evaluate(&self, x: &[f64; N]) -> Sample<N, ()> {
        let w = self.weight.evaluate(x);
        let mut sample = Sample {
            value: [0.0; N],
            jacobian: [[0.0; N]; N],
            seen: (),
        };
        for (i, p) in self.numerators.iter().enumerate() {
            sample.value[i] = p.evaluate(x) / w;
            for j in 0..N {
                let slope = p.derivative(j).evaluate(x) - sample.value[i] * self.weight.derivative(j).evaluate(x);
                sample.jacobian[i][j] = slope / w;
            }
        }
        for (i, zero) in (self.numerators.len()..).zip(&self.zeros) {
            sample.value[i] = zero.evaluate(x);
            sample.jacobian[i] = std::array::from_fn(|j| zero.derivative(j).evaluate(x));
        }
        sample
    }

    fn scales(&self) -> [f64; N] {
        [1.0; N]
    }

    fn rounding(&self) -> [f64; N] {
        [1e-14; N]
    }
}

fn solve<const N: usize>(forms: &Forms<N>, targets: &List<N>, boxes: u64) -> Answer<N> {
    patiently(forms, targets, boxes, u32::MAX)
}

fn patiently<const N: usize>(forms: &Forms<N>, targets: &List<N>, boxes: u64, patience: u32) -> Answer<N> {
    let mut answer = Answer {
        found: Vec::new(),
        open: Vec::new(),
    };
    let mut solver = BundleSolver::new(ChartOptions::default().boxes(boxes));
    solver.patience = patience;
    solver.solve(&forms.bundle(), forms, targets, &mut answer, &());
    answer
}

fn form(degrees: &[usize], random: &mut Random) -> Bernstein {
    Bernstein::from_fn(degrees, |_| 2.0 * random.unit() - 1.0).unwrap()
}

fn weight(degrees: &[usize], random: &mut Random) -> Bernstein {
    Bernstein::from_fn(degrees, |_| 0.5 + random.unit()).unwrap()
}

/// Every target's roots, beside those of the single systems: as many, in the same places, of the same orientation.
fn compare<const N: usize>(forms: &Forms<N>, targets: &List<N>) -> usize {
    let answer = solve(forms, targets, 400_000);
    assert!(answer.open.is_empty(), "{:?}", answer.open);
    let mut count = 0;
    for (number, q) in targets.0.iter().enumerate() {
        let points = PointSolver::default().solve(&forms.system(q), &()).unwrap();
        assert!(points.unresolved.is_empty());
        let own: Vec<_> = answer.found.iter().filter(|found| found.target == number).collect();
        assert_eq!(own.len(), points.roots.len(), "target {q:?}");
        for root in &points.roots {
            // Steps of Newton's method of at most 1e-8 of a box leave the square of it, times the condition.
            let near = |found: &&&Preimage<N>| (0..N).all(|j| (found.x[j] - root.point[j]).abs() < 1e-9);
            let found = own
                .iter()
                .find(near)
                .unwrap_or_else(|| panic!("{q:?}: {root:?} not among {own:?}"));
            assert_eq!(found.orientation, root.orientation, "{q:?}");
        }
        count += own.len();
    }
    count
}

#[test]
fn all_targets_of_random_maps_of_the_plane_have_their_roots() {
    let mut random = Random(11);
    let mut roots = 0;
    for number in 0..60 {
        let degrees = [[2, 2], [3, 1], [2, 4], [4, 4]][number % 4];
        let forms = Forms::<2> {
            numerators: vec![form(&degrees, &mut random), form(&degrees, &mut random)],
            weight: if number % 3 == 0 {
                Bernstein::constant(2, 1.0)
            } else {
                weight(&[2, 1], &mut random)
            },
            zeros: vec![],
        };
        let targets = List((0..40).map(|_| [0, 1].map(|_| 1.2 * random.unit() - 0.6)).collect());
        roots += compare(&forms, &targets);
    }
    // Not vacuous.
    assert!(roots > 1_000, "{roots}");
}

#[test]
fn all_targets_of_random_maps_with_an_equation_have_their_roots() {
    let mut random = Random(12);
    let mut roots = 0;
    for number in 0..40 {
        let degrees = [[2, 2, 1], [2, 2, 3], [1, 3, 2]][number % 3];
        let forms = Forms::<3> {
            numerators: vec![form(&degrees, &mut random), form(&degrees, &mut random)],
            weight: weight(&[2, 1, 2], &mut random),
            zeros: vec![form(&[2, 2, 1], &mut random)],
        };
        let targets = List(
            (0..25)
                .map(|_| [1.0 * random.unit() - 0.5, 1.0 * random.unit() - 0.5, 0.0])
                .collect(),
        );
        roots += compare(&forms, &targets);
    }
    assert!(roots > 200, "{roots}");
}

/// `(x², y) + a little of both`: boxes are split, and roots lie on the cuts exactly.
#[test]
fn roots_on_faces_between_boxes_are_found_once() {
    // x ↦ 3 x² − 3 x has a fold at ½, so the domain must be split; its cuts are at 0.492 of what was there before.
    let x = Bernstein::new(&[2, 0], vec![0.0, -1.5, 0.0]).unwrap();
    let forms = Forms::<2> {
        numerators: vec![x, Bernstein::variable(2, 1)],
        weight: Bernstein::constant(2, 1.0),
        zeros: vec![],
    };
    let mut cuts = vec![0.492];
    for _ in 0..6 {
        let (first, last) = (cuts[0], cuts[cuts.len() - 1]);
        cuts.insert(0, 0.492 * first);
        cuts.push(last + 0.492 * (1.0 - last));
    }
    let places: Vec<[f64; 2]> = cuts.iter().flat_map(|x| cuts.iter().map(move |y| [*x, *y])).collect();
    let targets = List(places.iter().map(|[x, y]| [3.0 * x * x - 3.0 * x, *y]).collect());
    let answer = solve(&forms, &targets, 400_000);
    assert!(answer.open.is_empty(), "{:?}", answer.open);
    for (number, [x, y]) in places.iter().enumerate() {
        let mut own: Vec<_> = answer
            .found
            .iter()
            .filter(|found| found.target == number)
            .map(|f| f.x)
            .collect();
        own.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let expected = [x.min(1.0 - x), x.max(1.0 - x)];
        assert_eq!(own.len(), 2, "{x} {y}: {own:?}");
        for (found, x) in own.iter().zip(expected) {
            assert!((found[0] - x).abs() < 1e-9 && (found[1] - y).abs() < 1e-9, "{found:?}");
        }
    }
}

#[test]
fn a_double_root_is_left_open() {
    let forms = Forms::<2> {
        numerators: vec![
            Bernstein::new(&[2, 0], vec![0.0, -1.5, 0.0]).unwrap(),
            Bernstein::variable(2, 1),
        ],
        weight: Bernstein::constant(2, 1.0),
        zeros: vec![],
    };
    let answer = solve(&forms, &List(vec![[-0.75, 0.3], [-0.76, 0.3]]), 20_000);
    assert!(answer.found.is_empty());
    assert!(!answer.open.is_empty());
    for open in &answer.open {
        assert_eq!(open.target, 0);
        assert!((open.bounds[0].mid() - 0.5).abs() < 1e-5 && open.bounds[1].radius() < 0.5);
    }
}

/// Solutions where both conditions have one sign may be left out, others may not.
#[test]
fn conditions_leave_out_nothing_else() {
    let mut random = Random(13);
    let mut kept = 0;
    for _ in 0..30 {
        let forms = Forms::<2> {
            numerators: vec![form(&[2, 2], &mut random), form(&[2, 2], &mut random)],
            weight: weight(&[1, 1], &mut random),
            zeros: vec![],
        };
        let conditions = [form(&[2, 2], &mut random), form(&[1, 2], &mut random)];
        let targets = List((0..40).map(|_| [0, 1].map(|_| random.unit() - 0.5)).collect());
        let all = solve(&forms, &targets, 400_000);
        let mut some = Answer {
            found: Vec::new(),
            open: Vec::new(),
        };
        let [first, second] = conditions.clone();
        let bundle = forms.bundle().where_signs_differ(first, second).unwrap();
        BundleSolver::new(ChartOptions::default()).solve(&bundle, &forms, &targets, &mut some, &());
        assert!(some.open.is_empty() && some.found.len() <= all.found.len());
        for found in &all.found {
            let [a, b] = [0, 1].map(|k| conditions[k].evaluate(&found.x));
            let near = |other: &&Preimage<2>| {
                other.target == found.target && (0..2).all(|j| (other.x[j] - found.x[j]).abs() < 1e-9)
            };
            if (a < 0.0) != (b < 0.0) {
                assert_eq!(some.found.iter().filter(near).count(), 1, "{found:?}");
                kept += 1;
            }
        }
    }
    assert!(kept > 50, "{kept}");
}

#[test]
fn a_budget_leaves_targets_open() {
    let mut random = Random(14);
    let forms = Forms::<2> {
        numerators: vec![form(&[4, 4], &mut random), form(&[4, 4], &mut random)],
        weight: weight(&[2, 2], &mut random),
        zeros: vec![],
    };
    let targets = List((0..40).map(|_| [0, 1].map(|_| random.unit() - 0.5)).collect());
    let (all, few) = (solve(&forms, &targets, 400_000), solve(&forms, &targets, 5));
    assert!(all.open.is_empty());
    for found in &all.found {
        let covered = few
            .open
            .iter()
            .any(|open| open.target == found.target && (0..2).all(|j| open.bounds[j].contains(found.x[j])));
        let near = |other: &Preimage<2>| {
            other.target == found.target && (0..2).all(|j| (other.x[j] - found.x[j]).abs() < 1e-9)
        };
        assert!(covered || few.found.iter().any(near), "{found:?}");
    }
}

/// Without patience, a target's solutions are all found unless it is open, whatever the box.
#[test]
fn targets_that_are_given_up_are_open() {
    let mut random = Random(15);
    let (mut given_up, mut solved) = (0, 0);
    for _ in 0..20 {
        let forms = Forms::<2> {
            numerators: vec![form(&[3, 3], &mut random), form(&[3, 3], &mut random)],
            weight: weight(&[2, 2], &mut random),
            zeros: vec![],
        };
        let targets = List((0..40).map(|_| [0, 1].map(|_| random.unit() - 0.5)).collect());
        let all = solve(&forms, &targets, 400_000);
        for patience in 0..4 {
            let mut answer = patiently(&forms, &targets, 400_000, patience);
            let mut open: Vec<usize> = answer.open.iter().map(|open| open.target).collect();
            open.sort_unstable();
            answer.forget_targets(0, &open);
            let closed = |found: &&Preimage<2>| open.binary_search(&found.target).is_err();
            assert_eq!(answer.found.len(), all.found.iter().filter(closed).count());
            (given_up, solved) = (given_up + open.len(), solved + answer.found.len());
        }
    }
    assert!(given_up > 50 && solved > 200, "{given_up} {solved}");
}

/// A map whose values are known to be rounded more coarsely than they are.
struct Coarse<'a>(&'a Forms<2>, f64);

impl ChartMap<2> for Coarse<'_> {
    type Cell = ();
    type Seen = ();

    fn bounds(&self, (): &()) -> [Enclosure; 2] {
        [Enclosure::UNIT; 2]
    }

    fn values(&mut self, (): &()) -> Option<[Enclosure; 2]> {
        unreachable!("bundles ask for points only")
    }

    fn jacobian(&mut self, (): &()) -> [[Enclosure; 2]; 2] {
        unreachable!("bundles ask for points only")
    }

    fn split(&mut self, (): &(), _: usize) -> [(); 2] {
        unreachable!("bundles ask for points only")
    }

    fn evaluate(&self, x: &[f64; 2]) -> Sample<2, ()> {
        self.0.evaluate(x)
    }

    fn scales(&self) -> [f64; 2] {
        [1.0; 2]
    }

    fn rounding(&self) -> [f64; 2] {
        [self.1; 2]
    }
}

/// Pairs of roots beside a fold, planted nearer and nearer to each other, down to less than what rounding tells apart: both are found, or the target is open,
/// and the search ends either way.
#[test]
fn roots_that_rounding_cannot_tell_apart_leave_their_targets_open_at_once() {
    let fold = 0.437;
    // X = u, Y = (v − fold)².
    let (u, v) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1));
    let away = v.sub(&Bernstein::constant(2, fold));
    let forms = Forms::<2> {
        numerators: vec![u, away.mul(&away)],
        weight: Bernstein::constant(2, 1.0),
        zeros: vec![],
    };
    let (mut sure, mut open) = (0, 0);
    for rounding in [1e-7, 1e-10, 1e-13] {
        for exponent in 1..13 {
            let half = 0.4 * 10.0_f64.powi(-exponent);
            let targets = List((0..12).map(|k| [0.05 + 0.07 * f64::from(k), half * half]).collect());
            let mut answer = Answer {
                found: Vec::new(),
                open: Vec::new(),
            };
            let mut solver = BundleSolver::new(ChartOptions::default().accept(1e-6));
            solver.solve(&forms.bundle(), &Coarse(&forms, rounding), &targets, &mut answer, &());
            for (number, target) in targets.0.iter().enumerate() {
                if answer.open.iter().any(|open| open.target == number) {
                    open += 1;
                    assert!(
                        half * half < 1e3 * rounding,
                        "half a distance of {half}, rounding {rounding}"
                    );
                    continue;
                }
                for v in [fold - half, fold + half] {
                    let near =
                        |x: &[f64; 2]| (x[0] - target[0]).abs() < 1e-9 && (x[1] - v).abs() < 1e-9 + rounding / half;
                    let found = answer
                        .found
                        .iter()
                        .filter(|found| found.target == number && near(&found.x));
                    assert_eq!(found.count(), 1, "{target:?}, rounding {rounding}");
                }
                sure += 1;
            }
            let each = solver.statistics.boxes / targets.0.len() as u64;
            assert!(
                each < 400,
                "{each} boxes a target, half a distance of {half}, rounding {rounding}"
            );
        }
    }
    assert!(sure > 100 && open > 50, "{sure} {open}");
}
