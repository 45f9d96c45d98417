//! Degenerate places beside simple roots: nothing hides, and what stays open lies where the degenerate place is. Roots are planted exactly.

use crate::support::expression::{Polynomial, exact, parse};
use crate::support::planted::Random;
use dashu_ratio::RBig;
use sweepsim_solve::{Cause, Enclosure, PointSolver, Points, SolveOptions, System};

fn names(n: usize) -> Vec<String> {
    ["x", "y", "z", "u", "v", "w", "s", "t"][..n]
        .iter()
        .map(|s| (*s).to_owned())
        .collect()
}

fn polynomial(text: &str, n: usize) -> Polynomial {
    Polynomial::of(&parse(text, &names(n)), n).unwrap()
}

fn solve(polynomials: &[Polynomial], side: [f64; 2]) -> Points {
    let domain = vec![Enclosure::new(side[0], side[1]).unwrap(); polynomials.len()];
    let equations = polynomials.iter().map(|p| p.equation(&domain));
    let system = System::mapped(&domain, equations).unwrap();
    let points = PointSolver::default().solve(&system, &()).unwrap();
    assert!(points.unresolved.len() <= SolveOptions::default().unresolved);
    points
}

fn solve_texts(texts: &[&str], side: [f64; 2]) -> Points {
    let polynomials: Vec<Polynomial> = texts.iter().map(|t| polynomial(t, texts.len())).collect();
    solve(&polynomials, side)
}

fn holds(bounds: &[Enclosure], root: &[f64]) -> bool {
    bounds.iter().zip(root).all(|(b, x)| b.contains(*x))
}

/// Roots known to a few units in the last place.
fn near(bounds: &[Enclosure], root: &[f64]) -> bool {
    let slack = |x: f64| 1e-14 * (1.0 + x.abs());
    bounds
        .iter()
        .zip(root)
        .all(|(b, x)| b.lo() - slack(*x) <= *x && *x <= b.hi() + slack(*x))
}

fn widest(bounds: &[Enclosure]) -> f64 {
    bounds.iter().fold(0.0, |w: f64, b| w.max(2.0 * b.radius()))
}

/// The simple roots are certified, and nothing else is.
fn certified(points: &Points, roots: &[Vec<f64>], what: &str) {
    assert_eq!(points.roots.len(), roots.len(), "{what}: {points:?}");
    for root in roots {
        let found = points.roots.iter().filter(|r| near(&r.enclosure, root)).count();
        assert_eq!(found, 1, "{what}: {root:?} {points:?}");
    }
}

#[test]
fn a_multiple_root_hides_no_simple_one() {
    let points = solve_texts(&["(29/16*x**3 - 2*x*y)*(x - 1)", "(y - x**2)*(y - 1/2)"], [-2.0, 2.0]);
    let half = (16.0f64 / 29.0).sqrt();
    let simple = [[0.0, 0.5], [half, 0.5], [-half, 0.5], [1.0, 0.5], [1.0, 1.0]];
    certified(&points, &simple.map(|r| r.to_vec()), "hidden");
    // The triple root is in one box, as small as the coefficients' rounding lets it be.
    assert_eq!(points.unresolved.len(), 1, "{points:?}");
    let open = &points.unresolved[0];
    assert!(
        holds(&open.bounds, &[0.0, 0.0]) && widest(&open.bounds) < 1e-3,
        "{open:?}"
    );
    assert_eq!((open.cause, open.parts.len()), (Cause::Vanishing, open.boxes));
}

#[test]
fn a_curve_of_solutions_hides_no_simple_root() {
    // f g = f h = 0: the curve f = 0, and the root of g = h = 0.
    let curves = ["x - y", "x**2 + y**2 - 1", "y - x**3", "x*y - 1/4"];
    let mut random = Random(8);
    for (number, curve) in curves.iter().enumerate() {
        for _ in 0..2 {
            let f = polynomial(curve, 2);
            let planted = loop {
                let p = [random.direction() * 1.5, random.direction() * 1.5];
                // At least 1/100 from the curve, by its slopes of at most 16.
                if f.value(&p.map(exact)).to_f64().value().abs() > 0.16 {
                    break p;
                }
            };
            let line = |random: &mut Random| {
                let (a, b) = (random.direction(), random.direction());
                let at = a * planted[0] + b * planted[1];
                polynomial(&format!("({a})*x + ({b})*y - ({at})").replace("(-", "(0-"), 2)
            };
            let (g, h) = (line(&mut random), line(&mut random));
            let slope = |p: &Polynomial, j: usize| {
                p.0.get(&vec![usize::from(j == 0) as u32, usize::from(j == 1) as u32])
                    .cloned()
                    .unwrap_or(RBig::ZERO)
            };
            if slope(&g, 0) * slope(&h, 1) == slope(&g, 1) * slope(&h, 0) {
                continue;
            }
            let points = solve(&[f.mul(&g), f.mul(&h)], [-2.0, 2.0]);
            certified(&points, &[planted.to_vec()], curve);
            // The curve is covered: points where it crosses lines, to a rounding.
            let mut crossings = 0;
            for k in -40..=40 {
                let x = f64::from(k) / 20.0 + 1e-3;
                let at = match number {
                    0 => x,
                    1 => (1.0 - x * x).sqrt(),
                    2 => x * x * x,
                    _ => 0.25 / x,
                };
                if at.abs() <= 2.0 && x.abs() <= 2.0 {
                    crossings += 1;
                    assert!(
                        points.unresolved.iter().any(|u| near(&u.bounds, &[x, at])),
                        "{curve}: {x} {at}"
                    );
                }
            }
            assert!(crossings > 20);
            // Little else is: no box reaches farther than a hundredth of the domain.
            let raw = points.unresolved.iter().map(|u| u.parts.len().max(1)).sum::<usize>();
            let boxes: usize = points.unresolved.iter().map(|u| u.boxes).sum();
            assert_eq!(raw, boxes);
            for part in points.unresolved.iter().flat_map(|u| &u.parts) {
                let middle: Vec<RBig> = part.iter().map(|b| exact(b.mid())).collect();
                let value = f.value(&middle).to_f64().value().abs();
                assert!(widest(part) < 4e-3 && value <= 16.0 * widest(part), "{part:?}");
            }
        }
    }
}

#[test]
fn equations_that_vanish_leave_the_rest_of_the_system() {
    let zero = "0*x";
    // Nothing decides between the points of the circle, of the sphere's section, of the whole square.
    for texts in [
        vec!["x**2 + y**2 - 1", zero],
        vec![zero, "x**2 + y**2 + z**2 - 1", "z - x/2"],
    ] {
        let points = solve_texts(&texts, [-2.0, 2.0]);
        assert!(points.roots.is_empty());
        for k in 0..50 {
            let angle = f64::from(k) * 0.3;
            // On z = x/2 the sphere is 5/4 x² + y² = 1.
            let scale = if texts.len() == 2 { 1.0 } else { 0.8f64.sqrt() };
            let (x, y) = (scale * angle.cos(), angle.sin());
            assert!(
                points
                    .unresolved
                    .iter()
                    .any(|u| near(&u.bounds, &[x, y, x / 2.0][..texts.len()]))
            );
        }
        // Boxes of less than a hundredth of the square.
        assert!(points.unresolved.iter().all(|u| widest(&u.bounds) < 0.4));
    }
    let points = solve_texts(&[zero, zero], [0.0, 1.0]);
    assert!(points.roots.is_empty() && !points.unresolved.is_empty());
}

/// `(x − r)^m (x − s)` in one unknown, and turned, beside `v = 0`, in two.
#[test]
fn multiplicities_two_to_six() {
    for m in 2..=6u32 {
        for (r, s) in [(0.375, 0.75), (-0.5, 0.25), (0.0, -0.875)] {
            let line = polynomial(&format!("(x - ({r}))**{m} * (x - ({s}))").replace("(-", "(0-"), 1);
            let points = solve(&[line], [-1.0, 1.0]);
            certified(&points, &[vec![s]], &format!("multiplicity {m}"));
            assert_eq!(points.unresolved.len(), 1, "{m}: {points:?}");
            let open = &points.unresolved[0];
            assert!(
                holds(&open.bounds, &[r]) && widest(&open.bounds) < 0.04,
                "{m}: {open:?}"
            );

            // u = x − y/4 − r, v = y + x/4: u^m (u − d) + v = 0 and v (1 + x²) = 0.
            let u = polynomial(&format!("x - y/4 - ({r})").replace("(-", "(0-"), 2);
            let v = polynomial("y + x/4", 2);
            let d = polynomial("1/4", 2);
            let power = (0..m).fold(Polynomial::constant(RBig::ONE, 2), |p, _| p.mul(&u));
            let first = power.mul(&u.clone().add(&d.scale(&-RBig::ONE))).add(&v);
            let second = v.mul(&polynomial("1 + x**2", 2));
            let points = solve(&[first, second], [-2.0, 2.0]);
            // v = 0: y = −x/4, u = 17/16 x − r.
            let at = |u: f64| vec![(u + r) * 16.0 / 17.0, -(u + r) * 4.0 / 17.0];
            certified(&points, &[at(0.25)], &format!("multiplicity {m}, turned"));
            assert_eq!(points.unresolved.len(), 1, "{m}: {points:?}");
            let open = &points.unresolved[0];
            assert!(
                near(&open.bounds, &at(0.0)) && widest(&open.bounds) < 0.04,
                "{m}: {open:?}"
            );
        }
    }
}

#[test]
fn pairs_of_every_distance_are_told_apart_or_named() {
    for k in 5..=50 {
        let gap = 2f64.powi(-k);
        for r in [0.375, 0.5, 0.0, 0.8125] {
            let pair = polynomial("x", 1).add(&Polynomial::constant(-exact(r), 1));
            let pair = pair.mul(&pair.clone().add(&Polynomial::constant(-exact(gap), 1)));
            let points = solve(std::slice::from_ref(&pair), [0.0, 1.0]);
            let mut open = 0;
            for root in [r, r + gap] {
                let certified = points.roots.iter().filter(|x| holds(&x.enclosure, &[root])).count();
                let left = points.unresolved.iter().any(|u| holds(&u.bounds, &[root]));
                assert!(certified <= 1 && (certified == 1 || left), "2^-{k} at {r}: {points:?}");
                open += usize::from(certified == 0);
            }
            assert!(points.roots.len() <= 2);
            // Down to 2⁻²⁵ even rounded coefficients tell the roots apart.
            assert!(open == 0 || k > 24, "2^-{k} at {r}: {points:?}");
            assert!(
                points.unresolved.iter().all(|u| widest(&u.bounds) < 1e-6),
                "2^-{k} at {r}: {points:?}"
            );
        }
    }
}

#[test]
fn circles_that_almost_touch() {
    for k in 4..=14 {
        for sign in [1.0, -1.0] {
            let gap = sign * 10f64.powi(-k);
            // Radius 1 about (0, 0) and about (2 − gap, 0).
            let circle = |centre: RBig| {
                let x = Polynomial::variable(0, 2).add(&Polynomial::constant(-centre, 2));
                x.mul(&x).add(&polynomial("y*y - 1", 2))
            };
            let centre = exact(2.0) - exact(gap);
            let points = solve(&[circle(RBig::ZERO), circle(centre)], [-2.0, 2.0]);
            if gap < 0.0 {
                assert!(points.roots.is_empty(), "{gap}: {points:?}");
            } else {
                let root = [1.0 - gap / 2.0, (gap - gap * gap / 4.0).sqrt()];
                for root in [root, [root[0], -root[1]]] {
                    let found = points.roots.iter().filter(|r| near(&r.enclosure, &root)).count();
                    let left = points.unresolved.iter().any(|u| near(&u.bounds, &root));
                    assert!(found <= 1 && (found == 1 || left), "{gap}: {root:?} {points:?}");
                    assert!(found == 1 || k > 12, "{gap}: {points:?}");
                }
                assert!(points.roots.len() <= 2);
            }
            for open in &points.unresolved {
                assert!(near(&open.bounds, &[1.0 - gap / 2.0, 0.0]) || gap > 0.0);
                assert!(widest(&open.bounds) < 1e-5, "{gap}: {open:?}");
            }
        }
    }
}

#[test]
fn wilkinson_and_mignotte() {
    for degree in [20, 25, 30, 35, 40] {
        let factor = |k: u32| polynomial(&format!("x - {k}/{}", degree + 1), 1);
        let product = (1..=degree).fold(Polynomial::constant(RBig::ONE, 1), |p, k| p.mul(&factor(k)));
        let points = solve(std::slice::from_ref(&product), [0.0, 1.0]);
        for k in 1..=degree {
            let root = RBig::from(k) / RBig::from(degree + 1);
            let inside = |b: &Enclosure| exact(b.lo()) <= root && root <= exact(b.hi());
            let found = points.roots.iter().filter(|r| inside(&r.enclosure[0])).count();
            let left = points.unresolved.iter().any(|u| inside(&u.bounds[0]));
            assert!(found <= 1 && (found == 1 || left), "{degree}: {k}");
        }
        assert!(points.roots.len() <= degree as usize);
        assert!(degree > 25 || points.unresolved.is_empty(), "{degree}: {points:?}");
        crossed(&product, &points);
    }
    // x^d − 2 (a x − 1)²: two roots about a^(−d/2 − 1) on either side of 1/a.
    for (degree, a) in [(5, 8), (9, 8), (13, 8), (17, 4), (21, 4)] {
        let p = polynomial(&format!("x**{degree} - 2*({a}*x - 1)**2"), 1);
        let points = solve(std::slice::from_ref(&p), [0.0, 1.0]);
        let gap = f64::from(a).powf(-0.5 * f64::from(degree) - 1.0) / 2f64.sqrt();
        for root in [1.0 / f64::from(a) - gap, 1.0 / f64::from(a) + gap] {
            let slack = 2.0 * gap * gap * f64::from(degree * a) + 1e-15;
            let inside = |b: &Enclosure| b.lo() - slack <= root && root <= b.hi() + slack;
            let found = points.roots.iter().any(|r| inside(&r.enclosure[0]));
            assert!(
                found || points.unresolved.iter().any(|u| inside(&u.bounds[0])),
                "{degree} {a}: {points:?}"
            );
        }
        assert!(
            points.unresolved.iter().all(|u| widest(&u.bounds) < 1e-5),
            "{degree} {a}: {points:?}"
        );
        crossed(&p, &points);
    }
}

/// Every certified root in one unknown is a change of sign in exact arithmetic.
fn crossed(p: &Polynomial, points: &Points) {
    for root in &points.roots {
        let at = |x: f64| p.value(&[exact(x)]);
        let (below, above) = (at(root.unique_in[0].lo()), at(root.unique_in[0].hi()));
        assert!(below * above < RBig::ZERO, "{root:?}");
    }
}

#[test]
fn lines_that_are_almost_parallel() {
    for k in 1..=60 {
        // x = y and x = (1 + 2⁻ᵏ) y − 2⁻ᵏ/4 meet at (1/4, 1/4). All coefficients are exact.
        let texts = ["x - y".to_owned(), format!("x - (1 + 2**-{k})*y + 2**-{k}/4")];
        let (one, e) = (RBig::ONE, exact(2f64.powi(-k)));
        let x = Polynomial::variable(0, 2);
        let y = Polynomial::variable(1, 2);
        let first = x.clone().add(&y.scale(&-one.clone()));
        let second = x
            .add(&y.scale(&-(one + &e)))
            .add(&Polynomial::constant(e * exact(0.25), 2));
        let points = solve(&[first, second], [-2.0, 2.0]);
        let root = [0.25, 0.25];
        let found = points.roots.iter().filter(|r| holds(&r.enclosure, &root)).count();
        assert_eq!(found, points.roots.len(), "{texts:?}");
        assert!(
            found == 1 || points.unresolved.iter().any(|u| holds(&u.bounds, &root)),
            "{texts:?}"
        );
        assert!(found == 1 || k > 40, "{texts:?}: {points:?}");
        if found == 1 {
            // Roots that are known to less than 2⁻⁴⁰ of the side of 4 are refined. Values then err by at most 2⁻⁸⁸ (a few steps of 2⁻⁹² each, for
            // coefficients of at most 2), which the inverse magnifies by up to 2ᵏ⁺² on this side, and the enclosure is widened by units in the last place.
            let refined = 2f64.powi(k + 4 - 88) + 16.0 * f64::EPSILON;
            let bound = 4.0 * 2.0 * 2f64.powi(-40).max(refined);
            let width = widest(&points.roots[0].enclosure);
            assert!(width <= bound, "2^-{k}: {width:e} of {bound:e}");
        }
    }
}

#[test]
fn planted_roots_in_two_to_eight_unknowns() {
    let mut random = Random(3);
    for n in 2..=8usize {
        for _ in 0..if n < 7 { 4 } else { 1 } {
            // (xᵢ − aᵢ)(xᵢ + xᵢ₊₁/8 − bᵢ) = 0, the last without coupling: 2ⁿ roots, known exactly by back substitution.
            let side = |random: &mut Random| random.below(15) as f64 / 32.0 - 0.75;
            let a: Vec<f64> = (0..n).map(|_| side(&mut random)).collect();
            let b: Vec<f64> = (0..n).map(|i| a[i] + 0.5 + random.below(8) as f64 / 32.0).collect();
            let system: Vec<Polynomial> = (0..n)
                .map(|i| {
                    let x = |value: f64| Polynomial::variable(i, n).add(&Polynomial::constant(-exact(value), n));
                    let second = if i + 1 < n {
                        x(b[i]).add(&Polynomial::variable(i + 1, n).scale(&exact(0.125)))
                    } else {
                        x(b[i])
                    };
                    x(a[i]).mul(&second)
                })
                .collect();
            let mut roots = Vec::new();
            for choice in 0..1u32 << n {
                let mut root = vec![0.0; n];
                for i in (0..n).rev() {
                    let next = if i + 1 < n { root[i + 1] / 8.0 } else { 0.0 };
                    root[i] = if choice >> i & 1 == 0 { a[i] } else { b[i] - next };
                }
                roots.push(root);
            }
            // Dyadic fractions of few bits: the roots are exact.
            roots.retain(|r| r.iter().all(|x| x.abs() < 1.0));
            let points = solve(&system, [-1.0, 1.0]);
            let what = format!("{n} unknowns: {a:?} {b:?}");
            certified(&points, &roots, &what);
            assert!(points.unresolved.is_empty(), "{what}");
        }
    }
}
