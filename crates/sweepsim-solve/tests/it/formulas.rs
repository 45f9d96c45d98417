//! Formulas and equations as text, against an evaluation that shares no code with them.

use sweepsim_props::*;
use sweepsim_solve::{
    Bernstein, CurveSolver, Enclosure, Formula, FormulaProblem, PointSolver, Points, SurfaceSolver, System, SystemError,
};

fn side(lo: f64, hi: f64) -> Enclosure {
    Enclosure::new(lo, hi).unwrap()
}

pub fn parse(equations: &[&str], names: &[&str], domain: &[(f64, f64)]) -> System {
    let domain: Vec<Enclosure> = domain.iter().map(|d| side(d.0, d.1)).collect();
    System::parse(equations, names, &domain).unwrap_or_else(|e| panic!("{e}"))
}

fn solve(equations: &[&str], names: &[&str], domain: &[(f64, f64)]) -> Points {
    PointSolver::default()
        .solve(&parse(equations, names, domain), &())
        .unwrap()
}

/// All roots are found, and nothing is left.
fn roots(equations: &[&str], names: &[&str], domain: &[(f64, f64)]) -> Vec<Vec<f64>> {
    let points = solve(equations, names, domain);
    assert!(points.unresolved.is_empty(), "{equations:?}: {:?}", points.unresolved);
    points.roots.into_iter().map(|r| r.point).collect()
}

#[test]
fn equations_are_solved_as_they_are_written() {
    let found = roots(&["x^2 + y^2 = 1", "y = x^3"], &["x", "y"], &[(-2.0, 2.0), (-2.0, 2.0)]);
    assert_eq!(found.len(), 2);
    for p in &found {
        assert!((p[0].powi(2) + p[1].powi(2) - 1.0).abs() < 1e-14 && (p[1] - p[0].powi(3)).abs() < 1e-14);
    }
    // The counts of zeros on bounded intervals are known: k π, solutions of tan x = x, of x = cos x, of eˣ = 3 x, of x ln x = 1.
    for (text, interval, count) in [
        ("sin(x) = 0", (-10.0, 10.0), 7),
        ("tan(x) = x", (1.0, 20.0), 5),
        ("x = cos(x)", (-5.0, 5.0), 1),
        ("exp(x) = 3*x", (-5.0, 5.0), 2),
        ("x*ln(x) = 1", (0.001, 5.0), 1),
        ("sqrt(x) = x^2 - 1", (-5.0, 5.0), 1),
        ("atan(x) = x/2", (-5.0, 5.0), 3),
        ("1/x = 1/(x^2 + 1) + 1", (-5.0, 5.0), 1),
        ("x^x = 2", (0.001, 5.0), 1),
        ("sin(1/x) = 0", (0.02, 1.0), 15),
        ("x^-2 = 4", (-5.0, 5.0), 2),
        ("2^x = 8", (-5.0, 5.0), 1),
        ("(x - 1)*(x - 2)*(x - 3)*(x - 4)*(x - 5)*(x - 6) = 0", (0.0, 6.5), 6),
    ] {
        let found = roots(&[text], &["x"], &[interval]);
        assert_eq!(found.len(), count, "{text}: {found:?}");
    }
    // IntervalRootFinding.jl's examples: a rotated, a transcendental and a large domain.
    let found = roots(&["x^2 + y^2 - 1", "y - 2*x"], &["x", "y"], &[(-1e6, 1e6), (-1e6, 1e6)]);
    assert_eq!(found.len(), 2);
    let found = roots(
        &["exp(x) = y", "x + y = sin(3*y)"],
        &["x", "y"],
        &[(-4.0, 3.0), (-4.0, 3.0)],
    );
    for p in &found {
        assert!((p[0].exp() - p[1]).abs() < 1e-13 && (p[0] + p[1] - (3.0 * p[1]).sin()).abs() < 1e-13);
    }
    assert!(!found.is_empty());
}

#[test]
fn forms_on_a_domain_other_than_theirs_are_an_error() {
    // Taken for the coordinates of [−2, 2]², the unit box's variables would give one root at (0.43…, 0.43…)·4 − 2, which is wrong.
    let [x, y] = [0, 1].map(|j| Bernstein::variable(2, j));
    let circle = x.mul(&x).add(&y.mul(&y)).sub(&Bernstein::constant(2, 1.0));
    let cubic = y.sub(&x.mul(&x).mul(&x));
    let wide = [side(-2.0, 2.0); 2];
    let error = System::new(&wide, [&circle, &cubic]).unwrap_err();
    assert_eq!(error, SystemError::FormDomain { variable: 0 });
    let expression = sweepsim_solve::Expression::from(circle.clone());
    let error = System::new(&[Enclosure::UNIT, wide[1]], [expression]).unwrap_err();
    assert_eq!(error, SystemError::FormDomain { variable: 1 });
    assert!(System::new(&[Enclosure::UNIT; 2], [&circle, &cubic]).is_ok());
    // The same by formulas, on the domain by construction.
    let [x, y] = [Formula::variable(0), Formula::variable(1)];
    let system = System::of_formulas(&wide, [x.powi(2) + y.powi(2) - 1.0, y - x.powi(3)]).unwrap();
    assert_eq!(PointSolver::default().solve(&system, &()).unwrap().roots.len(), 2);
}

#[test]
fn curves_and_surfaces_are_found_from_text() {
    let system = parse(&["sin(x)^2 + y^2 = 1/4"], &["x", "y"], &[(-5.0, 5.0), (-2.0, 2.0)]);
    let curves = CurveSolver::new(1e-2).solve(&system, &()).unwrap();
    assert_eq!(
        (curves.loops().count(), curves.curves.len(), curves.singular.len()),
        (3, 3, 0)
    );
    let system = parse(
        &["x^2 + y^2 + z^2 = 1 + 0.1*sin(5*x)"],
        &["x", "y", "z"],
        &[(-1.6, 1.5), (-1.5, 1.6), (-1.5, 1.5)],
    );
    let surface = SurfaceSolver::new(0.2).solve(&system, &()).unwrap();
    assert_eq!(
        (
            surface.euler_characteristic(),
            surface.components(),
            surface.unresolved.len()
        ),
        (2, 1, 0)
    );
}

#[test]
fn numbers_stand_for_what_they_say() {
    // The root is a tenth, which is not a floating-point number: the enclosure holds a tenth and not only its neighbour.
    let found = solve(&["10*x = 1"], &["x"], &[(0.0, 1.0)]);
    let tenth = solve(&["x = 0.1"], &["x"], &[(0.0, 1.0)]);
    for points in [&found, &tenth] {
        let enclosure = points.roots[0].enclosure[0];
        // 0.1 as a floating-point number is above a tenth, the one below it is under it.
        let holds = enclosure.lo() <= 0.1f64.next_down() && enclosure.hi() >= 0.1;
        assert!(holds && enclosure.radius() < 1e-14, "{enclosure:?}");
    }
    let pi = solve(&["x = pi"], &["x"], &[(3.0, 4.0)]);
    let enclosure = pi.roots[0].enclosure[0];
    assert!(enclosure.lo() <= std::f64::consts::PI && enclosure.hi() >= std::f64::consts::PI.next_up());
}

#[test]
fn wilkinson_factors_keep_their_accuracy() {
    let text = (1..=20).map(|k| format!("(x - {k})")).collect::<Vec<_>>().join("*");
    let points = solve(&[&text], &["x"], &[(0.5, 21.0)]);
    assert_eq!((points.roots.len(), points.unresolved.len()), (20, 0));
    for (k, root) in points.roots.iter().enumerate() {
        let (enclosure, k) = (root.enclosure[0], (k + 1) as f64);
        let near = (root.point[0] - k).abs() < 1e-8 && enclosure.radius() < 1e-3;
        assert!(near && enclosure.contains(k), "{root:?}");
    }
}

#[test]
fn shared_and_long_formulas_are_compiled_once() {
    // 2⁶⁰ uses of x, and a sum of 20,000 terms.
    let mut shared = Formula::variable(0).sin();
    for _ in 0..60 {
        shared = (&shared + &shared) * 0.5;
    }
    let domain = [side(0.5, 4.0)];
    let system = System::of_formulas(&domain, [shared]).unwrap();
    let points = PointSolver::default().solve(&system, &()).unwrap();
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    let long = (0..20_000).fold(Formula::constant(-20_000.0), |sum, _| sum + Formula::variable(0));
    let system = System::of_formulas(&domain, [long]).unwrap();
    assert_eq!(PointSolver::default().solve(&system, &()).unwrap().roots.len(), 1);
    // A million levels are dropped without a deep call stack, and are too many for a system.
    let deep = (0..1_000_000).fold(Formula::variable(0), |f, _| f.sin());
    let error = System::of_formulas(&domain, [deep]).unwrap_err();
    assert!(matches!(error, SystemError::TooManySteps { equation: 0, .. }));
}

#[test]
fn errors_name_the_place_and_what_was_expected() {
    let error = |text: &str| System::parse(&["x = y", text], &["x", "y"], &[Enclosure::UNIT; 2]).unwrap_err();
    for (text, message) in [
        (
            "",
            "equation 2:1:1: found the end, expected a number, a name, `(` or a sign",
        ),
        (
            "x +",
            "equation 2:1:4: found the end, expected a number, a name, `(` or a sign",
        ),
        (
            "x + * y",
            "equation 2:1:5: found `*`, expected a number, a name, `(` or a sign",
        ),
        ("2 x", "equation 2:1:3: found `x`, expected an operator, `=` or the end"),
        (
            "x = y = 1",
            "equation 2:1:7: found `=`, expected an operator or the end",
        ),
        (
            "x\n + (y\n",
            "equation 2:3:1: found the end, expected an operator or `)`",
        ),
        (
            "x ) y",
            "equation 2:1:3: found `)`, expected an operator, `=` or the end",
        ),
        ("x + z", "equation 2:1:5: `z` is unknown, expected one of x, y, pi, e"),
        (
            "foo(x)",
            "equation 2:1:1: `foo` is not a function, expected one of sin, cos, tan, exp, ln, sqrt, atan",
        ),
        (
            "sin x",
            "equation 2:1:5: found `x`, expected `(` after a function's name",
        ),
        (
            "x # y",
            "equation 2:1:3: found `#`, expected an operator, `=`, `)` or the end",
        ),
        (
            "1e999 * x",
            "equation 2:1:1: the number 1e999 is too large, expected one below 1.8e308",
        ),
        (
            "x + . 5",
            "equation 2:1:5: found `.` without digits, expected a number such as 0.5",
        ),
        (
            "é + \u{1F600}",
            "equation 2:1:1: `é` is unknown, expected one of x, y, pi, e",
        ),
    ] {
        assert_eq!(error(text).to_string(), message);
        assert!(error(text).render(false).contains("equation 2"), "{text}");
    }
    let nested = format!("{}x{}", "(".repeat(100_000), ")".repeat(100_000));
    let signs = format!("{}x", "-".repeat(100_001));
    let powers = vec!["x"; 100_000].join("^");
    assert!(matches!(error(&nested).problem(), FormulaProblem::TooDeep { .. }));
    assert!(matches!(error(&powers).problem(), FormulaProblem::TooDeep { .. }));
    assert!(System::parse(&[&signs], &["x"], &[Enclosure::UNIT]).is_ok());
    let names = |names: &[&str]| {
        System::parse(&["1"], names, &[Enclosure::UNIT; 2])
            .unwrap_err()
            .to_string()
    };
    assert!(names(&["x", "x"]).contains("`x` cannot name variable 2"));
    assert!(names(&["sin", "x"]).contains("`sin` cannot name variable 1"));
    assert!(names(&["x y", "x"]).contains("cannot name variable 1"));
    assert!(names(&["x"]).contains("1 names for a domain with 2 sides"));
    let overdetermined = System::parse(&["x", "x"], &["x"], &[Enclosure::UNIT]).unwrap_err();
    assert!(matches!(
        overdetermined.problem(),
        FormulaProblem::System(SystemError::TooManyEquations { .. })
    ));
}

proptest! {
    /// Operators need no parentheses where precedence says the same.
    #[test]
    fn precedence_is_that_of_mathematics(a in 1u32..9, b in 1u32..9, c in 1u32..9, x in 0.5f64..2.0) {
        let (p, q, r) = (f64::from(a), f64::from(b), f64::from(c));
        for (text, value) in [
            (format!("{a} - {b} - {c}*x"), p - q - r * x),
            (format!("{a}/{b}/{c}*x"), p / q / r * x),
            (format!("-x^2*{a} + {b}"), -(x * x) * p + q),
            (format!("{a}*-x**2^1 - -{b}"), p * -(x * x) + q),
            (format!("x^-{}", a % 3 + 1), x.powi(-(a as i32 % 3 + 1))),
            (format!("(x + {a})·{b} − {c}"), (x + p) * q - r),
        ] {
            let found = roots(&[&format!("y = {text}"), &format!("x = {x:?}")], &["x", "y"], &[(0.4, 2.1), (-400.0, 400.0)]);
            prop_assert_eq!(found.len(), 1, "{}", text);
            prop_assert!((found[0][1] - value).abs() < 1e-11 * (1.0 + value.abs()), "{} {} {:?}", text, value, found);
        }
    }

    /// Text of any kind is a system or an error whose place lies in it.
    #[test]
    fn malformed_text_is_an_error_with_a_place(
        words in collection::vec(prop::sample::select(vec![
            "x", "y", "z", "sin", "(", ")", "(", ")", "+", "-", "*", "/", "^", "**", "=", "1", "2.5e", ".", "1e400", "e3", "é", "\n", " ", "€", "pi", "1e-5", "_a", "\u{0}",
        ]), 0..24),
    ) {
        let text = words.concat();
        match System::parse(&[&text], &["x", "y"], &[Enclosure::UNIT; 2]) {
            Ok(_) => {}
            Err(error) if matches!(error.problem(), FormulaProblem::System(_)) => {}
            Err(error) => {
                let (line, column) = (error.line().unwrap(), error.column().unwrap());
                prop_assert_eq!(error.equation(), Some(0));
                // The place is that of a character, or just beyond the last one of a line.
                let lines: Vec<&str> = text.split('\n').collect();
                prop_assert!(line <= lines.len() && column <= lines[line - 1].chars().count() + 1, "{text:?} {error}");
                prop_assert!(error.to_string().contains("expected"), "{}", error);
                prop_assert!(!error.render(false).is_empty());
            }
        }
    }

    #[test]
    fn any_text_is_read_without_panic(text in "\\PC{0,60}") {
        let _ = System::parse(&[&text], &["x"], &[Enclosure::UNIT]);
    }
}
