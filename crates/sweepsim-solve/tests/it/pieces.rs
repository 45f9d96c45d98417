//! Splines: roots on knots counted once, knots inserted anywhere change nothing, kinks are handled.

use sweepsim_solve::{Pieces, PiecesError, PointSolver, Points, RootLocation};
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    }
}

fn solve(splines: &[BSpline]) -> Points {
    PointSolver::default()
        .solve_pieces(&Pieces::new(splines).unwrap(), &())
        .unwrap()
}

fn random_spline(random: &mut Random, degrees: [usize; 2], spans: [usize; 2]) -> BSpline {
    let knots: Vec<KnotVector> = (0..2)
        .map(|j| KnotVector::uniform(degrees[j], spans[j], 0.0, 3.0).unwrap())
        .collect();
    let count = knots.iter().map(KnotVector::count).product::<usize>();
    BSpline::new(knots, 1, (0..count).map(|_| random.unit()).collect()).unwrap()
}

#[test]
fn a_root_on_a_knot_is_one() {
    // A line as a cubic spline: x − 2 on [0, 4] with knots at 1, 2, 3 (Greville abscissae as coefficients).
    let knots = KnotVector::uniform(3, 4, 0.0, 4.0).unwrap();
    let coefficients = knots.greville().iter().map(|x| x - 2.0).collect();
    let line = BSpline::new(vec![knots], 1, coefficients).unwrap();
    let found = solve(&[line]);
    assert_eq!((found.roots.len(), found.unresolved.len()), (1, 0), "{found:?}");
    assert!(found.roots[0].enclosure[0].contains(2.0));
    assert_eq!(found.roots[0].location, RootLocation::Inside);
}

#[test]
fn a_kink_through_zero_is_one_root() {
    // Slopes 1 and 3: broken at x = 1, value 0 there.
    let knots = KnotVector::open(1, &[0.0, 1.0, 2.0]).unwrap();
    let broken = BSpline::new(vec![knots.clone()], 1, vec![-1.0, 0.0, 3.0]).unwrap();
    let found = solve(&[broken]);
    assert_eq!((found.roots.len(), found.unresolved.len()), (1, 0), "{found:?}");
    // Slopes −1 and 1: it touches zero. No certificate.
    let touching = BSpline::new(vec![knots], 1, vec![1.0, 0.0, 1.0]).unwrap();
    let found = solve(&[touching]);
    assert_eq!((found.roots.len(), found.unresolved.len()), (0, 1), "{found:?}");
}

#[test]
fn inserted_knots_change_no_answer() {
    let mut random = Random(3);
    let mut total = 0;
    for number in 0..30 {
        let splines = [
            random_spline(&mut random, [2, 3], [3, 2]),
            random_spline(&mut random, [3, 2], [2, 3]),
        ];
        let plain = solve(&splines);
        assert!(plain.unresolved.is_empty(), "{number}");
        total += plain.roots.len();
        // At random places, and exactly through a root.
        let through = plain.roots.first().map_or([1.1, 2.2], |r| [r.point[0], r.point[1]]);
        let mut refined = splines.clone();
        for s in &mut refined {
            *s = s.insert_knot(0, 0.77, 1).unwrap().insert_knot(1, 2.9, 1).unwrap();
            *s = s
                .insert_knot(0, through[0], 1)
                .unwrap()
                .insert_knot(1, through[1], 1)
                .unwrap();
        }
        let again = solve(&refined);
        assert_eq!(
            (again.roots.len(), again.unresolved.len()),
            (plain.roots.len(), 0),
            "{number}"
        );
        for (a, b) in plain.roots.iter().zip(&again.roots) {
            assert!(
                a.point.iter().zip(&b.point).all(|(x, y)| (x - y).abs() < 1e-12),
                "{number}"
            );
            assert_eq!(a.orientation, b.orientation);
        }
        // Every root is a zero of the splines.
        for root in &plain.roots {
            assert!(splines.iter().all(|s| s.evaluate(&root.point)[0].abs() < 1e-12));
        }
    }
    assert!(total > 30, "{total}");
}

#[test]
fn rational_splines_are_solved_by_their_numerators() {
    // A circle of radius 1 as four rational quadratic arcs, less (0.6, 0.8)·s: where does it meet the ray? Unknowns: t and s.
    let w = 0.5f64.sqrt();
    let ring = [
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [0.0, -1.0],
        [1.0, -1.0],
        [1.0, 0.0],
    ];
    let weights: Vec<f64> = (0..9).map(|k| if k % 2 == 0 { 1.0 } else { w }).collect();
    let t = KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0]).unwrap();
    let s = KnotVector::bernstein(1, 0.0, 2.0).unwrap();
    let mut points = Vec::new();
    let mut all_weights = Vec::new();
    for end in [0.0, 2.0] {
        for (p, w) in ring.iter().zip(&weights) {
            points.extend([p[0] - 0.6 * end, p[1] - 0.8 * end]);
            all_weights.push(*w);
        }
    }
    let spline = RationalSpline::new(vec![t, s], 2, &points, &all_weights).unwrap();
    let pieces = Pieces::rational(&[spline]).unwrap();
    assert_eq!(pieces.systems().len(), 4);
    let found = PointSolver::default().solve_pieces(&pieces, &()).unwrap();
    assert_eq!((found.roots.len(), found.unresolved.len()), (1, 0));
    assert!((found.roots[0].point[1] - 1.0).abs() < 1e-14);
}

#[test]
fn splines_are_checked() {
    assert_eq!(Pieces::new(&[]).unwrap_err(), PiecesError::NoSplines);
    let mut random = Random(9);
    let a = random_spline(&mut random, [2, 2], [1, 1]);
    let b = a.reparametrise(1, 0.0, 4.0).unwrap();
    assert_eq!(
        Pieces::new(&[a.clone(), b]).unwrap_err(),
        PiecesError::Domain { spline: 1, variable: 1 }
    );
    let line = BSpline::new(vec![KnotVector::bernstein(1, 0.0, 3.0).unwrap()], 1, vec![0.0, 1.0]).unwrap();
    let error = PiecesError::Variables {
        spline: 1,
        variables: 1,
        expected: 2,
    };
    assert_eq!(Pieces::new(&[a, line]).unwrap_err(), error);
}
