//! Arbitrary systems, domains, options and texts to every public solver: none panics or overruns its budget of boxes.
//!
//! A sample always runs. For a million calls of each:
//! `FUZZ_CALLS=1000000 cargo test --release -p sweepsim-solve --test it fuzz -- --ignored --nocapture`
//! (`FUZZ_SOLVERS=formulas,splines`: only these.)

use crate::bundles::Forms;
use crate::monitors::Fold;
use crate::support::planted;
use crate::support::targets::{Answer, List};
use std::time::{Duration, Instant};
use sweepsim_solve::{
    BSpline, Bernstein, Bundle, BundleSolver, ChartOptions, ChartSolver, CurveSolver, Enclosure, Equation, Expression,
    Formula, KnotVector, Pieces, PointSolver, Points, SolveOptions, SurfaceSolver, System,
};

struct Random(planted::Random);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0.below(n as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        self.0.unit()
    }
}

/// No call, whose boxes are limited, may take longer. Calls take far less than a second; the machine may be busy.
const LIMIT: Duration = Duration::from_secs(20);

/// Numbers as they occur, and as they should not.
fn number(random: &mut Random) -> f64 {
    const ODD: [f64; 14] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        1e-300,
        -1e300,
        1e308,
        5e-324,
        1e-17,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        3.0,
    ];
    match random.below(12) {
        0 => ODD[random.below(ODD.len())],
        1 => (random.unit() - 0.5) * 10f64.powi(random.below(600) as i32 - 300),
        _ => 4.0 * random.unit() - 2.0,
    }
}

fn side(random: &mut Random) -> Enclosure {
    match random.below(8) {
        0 => Enclosure::hull(number(random), number(random)),
        1 => {
            let at = number(random);
            Enclosure::hull(at, at + 10f64.powi(-(random.below(30) as i32)))
        }
        _ => Enclosure::UNIT,
    }
}

fn form(random: &mut Random, n: usize) -> Bernstein {
    let degrees: Vec<usize> = (0..n).map(|_| random.below(if n > 3 { 3 } else { 5 })).collect();
    let plain = random.below(3) > 0;
    let coefficients = degrees.iter().map(|d| d + 1).product();
    let values = (0..coefficients)
        .map(|_| match (plain, random.below(6)) {
            (true, 0) => 0.0,
            (true, _) => 2.0 * random.unit() - 1.0,
            _ => number(random),
        })
        .collect();
    let made = match random.below(6) {
        0 => Bernstein::with_error(&degrees, values, number(random)),
        _ => Bernstein::new(&degrees, values),
    };
    made.unwrap_or_else(|_| Bernstein::variable(n, random.below(n)))
}

fn expression(random: &mut Random, n: usize, depth: usize) -> Expression {
    if depth == 0 || random.below(4) == 0 {
        return match random.below(4) {
            0 => Expression::constant(number(random)),
            _ => Expression::from(form(random, n)),
        };
    }
    let a = expression(random, n, depth - 1);
    match random.below(12) {
        0 => a + expression(random, n, depth - 1),
        1 => a - expression(random, n, depth - 1),
        2 => a * expression(random, n, depth - 1),
        3 => a / expression(random, n, depth - 1),
        4 => a.sin(),
        5 => a.cos(),
        6 => a.tan(),
        7 => a.exp(),
        8 => a.ln(),
        9 => a.sqrt(),
        10 => a.atan(),
        _ => a.powi(random.below(9) as u32),
    }
}

fn equation(random: &mut Random, n: usize) -> Equation {
    match random.below(4) {
        0 => Equation::sum((0..random.below(4)).map(|_| form(random, n)).collect()),
        1 => Equation::from(form(random, n)).with_remainder(number(random).abs() * 1e-6, number(random).abs() * 1e-6),
        2 => expression(random, n, 2).into(),
        _ => form(random, n).into(),
    }
}

fn system(random: &mut Random, n: usize, m: usize) -> Option<System> {
    let domain: Vec<Enclosure> = (0..n).map(|_| side(random)).collect();
    let equations: Vec<Equation> = (0..m).map(|_| equation(random, n)).collect();
    System::mapped(&domain, equations).ok()
}

fn options(random: &mut Random) -> SolveOptions {
    let options = SolveOptions::default()
        .boxes([0, 1, 10, 300, 1_000][random.below(5)])
        .unresolved([0, 3, 64][random.below(3)])
        .vertices([0, 10, 2_000][random.below(3)])
        .depth([0, 5, 2_000][random.below(3)]);
    match random.below(4) {
        0 => options.smallest(number(random)),
        1 => options.time(Some(Duration::from_micros(random.below(2_000) as u64))),
        _ => options.smallest(10f64.powi(-(random.below(14) as i32))),
    }
}

fn checked(points: &Points, limits: &SolveOptions) {
    assert!(points.statistics.boxes <= limits.boxes);
    for root in &points.roots {
        let ends = root.enclosure.iter().zip(&root.unique_in);
        assert!(
            ends.clone()
                .all(|(e, u)| e.lo().is_finite() && u.lo() <= e.lo() && e.hi() <= u.hi()),
            "{root:?}"
        );
    }
}

fn points(random: &mut Random) -> bool {
    let n = 1 + random.below(4);
    let Some(system) = system(random, n, n) else {
        return false;
    };
    let limits = options(random);
    let Ok(found) = PointSolver::new(limits.clone()).solve(&system, &()) else {
        return false;
    };
    checked(&found, &limits);
    true
}

fn curves(random: &mut Random) -> bool {
    let n = 2 + random.below(2);
    let Some(system) = system(random, n, n - 1) else {
        return false;
    };
    let tolerance = if random.below(8) == 0 {
        number(random)
    } else {
        10f64.powi(-(random.below(8) as i32))
    };
    let limits = options(random);
    let mut solver = CurveSolver::with_options(tolerance, limits.clone());
    if random.below(3) == 0 {
        solver = solver.cubics();
    }
    let Ok(found) = solver.solve(&system, &()) else {
        return false;
    };
    assert!(found.statistics.boxes <= limits.boxes);
    let vertices: usize = found.curves.iter().map(|c| c.points.len()).sum();
    assert!(vertices <= limits.vertices, "{vertices}");
    for curve in &found.curves {
        for p in &curve.points {
            assert!(p.point.iter().chain(&p.tangent).all(|x| x.is_finite()), "{p:?}");
        }
    }
    true
}

fn surfaces(random: &mut Random) -> bool {
    let Some(system) = system(random, 3, 1) else {
        return false;
    };
    let tolerance = if random.below(8) == 0 {
        number(random)
    } else {
        10f64.powi(-(random.below(4) as i32))
    };
    let limits = options(random);
    let Ok(found) = SurfaceSolver::with_options(tolerance, limits.clone()).solve(&system, &()) else {
        return false;
    };
    assert!(found.vertices.len() <= limits.vertices);
    assert!(found.vertices.iter().flatten().all(|x| x.is_finite()));
    true
}

fn expressions(random: &mut Random) -> bool {
    let n = 1 + random.below(3);
    let equations: Vec<Expression> = (0..n).map(|_| expression(random, n, 4)).collect();
    let domain: Vec<Enclosure> = (0..n).map(|_| side(random)).collect();
    let Ok(system) = System::mapped(&domain, equations) else {
        return false;
    };
    let limits = options(random);
    let Ok(found) = PointSolver::new(limits.clone()).solve(&system, &()) else {
        return false;
    };
    checked(&found, &limits);
    true
}

fn formula(random: &mut Random, depth: usize) -> Formula {
    if depth == 0 {
        return match random.below(3) {
            0 => Formula::constant(number(random)),
            _ => Formula::variable(random.below(3)),
        };
    }
    let a = formula(random, depth - 1);
    match random.below(13) {
        0 | 1 => a + formula(random, depth - 1),
        2 => a - formula(random, depth - 1),
        3 | 4 => a * formula(random, depth - 1),
        5 => a / formula(random, depth - 1),
        6 => a.sin(),
        7 => a.tan(),
        8 => a.exp(),
        9 => a.ln(),
        10 => a.sqrt(),
        11 => a.pow(formula(random, depth - 1)),
        _ => a.powi(random.below(15) as i32 - 7),
    }
}

fn formulas(random: &mut Random) -> bool {
    let n = 1 + random.below(3);
    let domain: Vec<Enclosure> = (0..n).map(|_| side(random)).collect();
    let formulas: Vec<Formula> = (0..n).map(|_| formula(random, 1 + n)).collect();
    let Ok(system) = System::of_formulas(&domain, formulas) else {
        return false;
    };
    let limits = options(random);
    let Ok(found) = PointSolver::new(limits.clone()).solve(&system, &()) else {
        return false;
    };
    checked(&found, &limits);
    true
}

fn splines(random: &mut Random) -> bool {
    let n = 1 + random.below(2);
    let mut all = Vec::new();
    for _ in 0..n {
        let mut knots = Vec::new();
        for _ in 0..n {
            let degree = 1 + random.below(3);
            let mut inner: Vec<f64> = (0..random.below(4)).map(|_| random.unit()).collect();
            inner.sort_by(f64::total_cmp);
            let ends = degree + 1;
            let vector = vec![0.0; ends]
                .into_iter()
                .chain(inner)
                .chain(vec![1.0; ends])
                .collect();
            let Ok(vector) = KnotVector::new(degree, vector) else {
                return false;
            };
            knots.push(vector);
        }
        let count = knots.iter().map(KnotVector::count).product();
        let values: Vec<f64> = (0..count).map(|_| 2.0 * random.unit() - 1.0).collect();
        let Ok(spline) = BSpline::new(knots, 1, values) else {
            return false;
        };
        all.push(spline);
    }
    let Ok(pieces) = Pieces::new(&all) else { return false };
    let limits = options(random);
    PointSolver::new(limits).solve_pieces(&pieces, &()).is_ok()
}

fn targets(random: &mut Random) -> List<2> {
    List((0..random.below(6)).map(|_| [number(random), number(random)]).collect())
}

fn chart_options(random: &mut Random) -> ChartOptions {
    let exponent = |random: &mut Random| 10f64.powi(-(random.below(16) as i32));
    ChartOptions::default()
        .boxes([0, 1, 30, 500][random.below(4)])
        .smallest(if random.below(6) == 0 {
            number(random)
        } else {
            exponent(random)
        })
        .accept(if random.below(6) == 0 {
            number(random)
        } else {
            exponent(random)
        })
}

fn bundles(random: &mut Random) -> bool {
    let zeros = random.below(2);
    let map = Forms::<2> {
        numerators: (zeros..2).map(|_| form(random, 2)).collect(),
        weight: if random.below(3) == 0 {
            form(random, 2)
        } else {
            Bernstein::constant(2, 1.0)
        },
        zeros: (0..zeros).map(|_| form(random, 2)).collect(),
    };
    let Ok(bundle) = Bundle::<2>::new(map.numerators.clone(), &map.weight, map.zeros.clone()) else {
        return false;
    };
    let mut targets = targets(random);
    for q in &mut targets.0 {
        // The other coordinates of a target are those of the forms that are zero.
        q[2 - zeros..].fill(0.0);
    }
    let mut solver = BundleSolver::new(chart_options(random));
    solver.solve(&bundle, &map, &targets, &mut Answer::default(), &());
    true
}

fn charts(random: &mut Random) -> bool {
    let region = [0, 1].map(|_| Enclosure::hull(random.unit(), random.unit()));
    let mut answer = Answer::default();
    let mut solver = ChartSolver::new(chart_options(random));
    solver.solve(&mut Fold, region, &targets(random), &mut answer, &());
    assert!(answer.found.iter().all(|found| found.x.iter().all(|x| x.is_finite())));
    true
}

/// One call; whether its input was valid.
type Call = fn(&mut Random) -> bool;

/// So many calls of each solver (or of the wanted ones); prints how many were valid, and the longest.
fn run(calls: u64, seed: u64, wanted: &str) {
    let solvers: [(&str, Call); 8] = [
        ("points", points),
        ("curves", curves),
        ("surfaces", surfaces),
        ("charts", charts),
        ("bundles", bundles),
        ("expressions", expressions),
        ("formulas", formulas),
        ("splines", splines),
    ];
    for (name, call) in solvers {
        if !(wanted.is_empty() || wanted.split(',').any(|w| w == name)) {
            continue;
        }
        let (mut valid, mut longest, start) = (0, Duration::ZERO, Instant::now());
        for number in 0..calls {
            let mut random = Random(planted::Random(seed.wrapping_mul(1_000_003).wrapping_add(number)));
            let begin = Instant::now();
            valid += u64::from(call(&mut random));
            let took = begin.elapsed();
            assert!(took < LIMIT, "{name}, seed {seed}, call {number}: {took:?}");
            longest = longest.max(took);
        }
        println!(
            "{name}: {calls} calls, {valid} of valid input, {:?}, the longest {longest:?}",
            start.elapsed()
        );
        assert!(
            valid > calls / 4,
            "{name}: only {valid} of {calls} calls were of valid input"
        );
    }
}

#[test]
fn no_input_makes_a_solver_panic() {
    run(150, 1, "");
}

#[test]
#[ignore = "a million calls of each solver take hours"]
fn a_million_inputs_make_no_solver_panic() {
    let calls = std::env::var("FUZZ_CALLS").ok().and_then(|calls| calls.parse().ok());
    let wanted = std::env::var("FUZZ_SOLVERS").unwrap_or_default();
    run(calls.unwrap_or(1_000_000), 2, &wanted);
}
