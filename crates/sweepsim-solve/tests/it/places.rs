//! Domains of any place and scale: what is returned holds in the domain's own numbers.

use crate::support::expression::{Polynomial, exact};
use crate::support::planted::Random;
use dashu_ratio::RBig;
use sweepsim_solve::{Enclosure, Formula, PointSolver, Points, System};

/// Roots of the returned answer are consistent: the point in the enclosure, that in the box without another root, no other enclosure in it.
fn consistent(points: &Points, what: &str) {
    for (number, root) in points.roots.iter().enumerate() {
        for ((x, e), u) in root.point.iter().zip(&root.enclosure).zip(&root.unique_in) {
            assert!(e.contains(*x), "{what}: {root:?}");
            assert!(u.lo() <= e.lo() && e.hi() <= u.hi(), "{what}: {root:?}");
        }
        for (other, next) in points.roots.iter().enumerate() {
            let meets = next
                .enclosure
                .iter()
                .zip(&root.unique_in)
                .all(|(e, u)| e.lo() <= u.hi() && u.lo() <= e.hi());
            let within = next
                .enclosure
                .iter()
                .zip(&root.unique_in)
                .all(|(e, u)| u.lo() <= e.lo() && e.hi() <= u.hi());
            assert!(number == other || !(meets && within), "{what}: {root:?} {next:?}");
        }
    }
}

/// A domain's side: near 0, far from it, thin, huge.
fn side(random: &mut Random) -> Enclosure {
    let width = 10f64.powf(match random.below(5) {
        0 => 0.0,
        1 => -200.0 * random.unit(),
        2 => 150.0 * random.unit(),
        3 => -8.0 * random.unit(),
        _ => 8.0 * random.unit(),
    });
    // From none to 10¹³ sides from 0.
    let away = match random.below(4) {
        0 => 0.0,
        1 => -random.unit() * width,
        _ => random.direction() * width * 10f64.powf(13.0 * random.unit()),
    };
    let width = width.max(512.0 * f64::EPSILON * away.abs());
    Enclosure::new(away, away + width).unwrap()
}

/// `(x − lo)/(hi − lo)`, exactly.
fn relative(x: f64, side: &Enclosure) -> RBig {
    (exact(x) - exact(side.lo())) / (exact(side.hi()) - exact(side.lo()))
}

#[test]
fn boxes_without_another_root_hold_exactly_one_wherever_the_domain_lies() {
    hold_exactly_one(1_500);
}

#[test]
#[ignore = "slow: half a minute"]
fn so_do_those_of_many_more_domains() {
    hold_exactly_one(36_000);
}

fn hold_exactly_one(cases: usize) {
    let mut random = Random(12);
    let (mut certified, mut planted, mut open) = (0, 0, 0);
    for case in 0..cases {
        let n = 1 + case % 3;
        let domain: Vec<Enclosure> = (0..n).map(|_| side(&mut random)).collect();
        // Roots at dyadic fractions of the sides; sums along the variables rotate them: xᵢ + xᵢ₊₁/4 takes two values.
        let unit = vec![Enclosure::UNIT; n];
        let count = 1 + random.below(3) as usize;
        let gap = [1.0 / 64.0, 2f64.powi(-9), 2f64.powi(-30)][random.below(3) as usize];
        let first: Vec<f64> = (0..n).map(|_| random.below(48) as f64 / 64.0).collect();
        let forms: Vec<_> = (0..n)
            .map(|i| {
                let coupled = |root: f64| {
                    let x = Polynomial::variable(i, n).add(&Polynomial::constant(-exact(root), n));
                    if i + 1 < n {
                        let y = Polynomial::variable(i + 1, n).add(&Polynomial::constant(-exact(first[i + 1]), n));
                        x.add(&y.scale(&exact(0.25)))
                    } else {
                        x
                    }
                };
                let mut p = coupled(first[i]);
                for k in 1..count {
                    p = p.mul(&coupled(first[i] + gap * k as f64));
                }
                p.bernstein(&unit)
            })
            .collect();
        let system = System::mapped(&domain, &forms).unwrap();
        let points = PointSolver::default().solve(&system, &()).unwrap();
        let what = format!("case {case}: {domain:?}");
        consistent(&points, &what);
        // The data tell roots apart if the domain's numbers are fine enough for it, and rounded coefficients.
        let fine = |d: &Enclosure| gap * (d.hi() - d.lo()) > 400.0 * f64::EPSILON * d.magnitude();
        let clear = gap >= 1.0 / 64.0 && domain.iter().all(fine);
        // All roots of the product system, exactly: choose a factor for each equation.
        for choice in 0..count.pow(n as u32) {
            let factor = |i: usize| choice / count.pow(i as u32) % count;
            let mut root = vec![RBig::ZERO; n];
            for i in (0..n).rev() {
                let mut x = exact(first[i] + gap * factor(i) as f64);
                if i + 1 < n {
                    x -= (root[i + 1].clone() - exact(first[i + 1])) * exact(0.25);
                }
                root[i] = x;
            }
            if root.iter().any(|x| *x < RBig::ZERO || *x > RBig::ONE) {
                continue;
            }
            planted += 1;
            let holds = |bounds: &[Enclosure]| {
                bounds
                    .iter()
                    .zip(&domain)
                    .zip(&root)
                    .all(|((b, d), x)| relative(b.lo(), d) <= *x && *x <= relative(b.hi(), d))
            };
            let enclosing = points.roots.iter().filter(|r| holds(&r.enclosure)).count();
            let unique = points.roots.iter().filter(|r| holds(&r.unique_in)).count();
            let left = points.unresolved.iter().any(|u| holds(&u.bounds));
            assert!(
                enclosing <= 1 && (enclosing == 1 || left),
                "{what}: {root:?} {points:?}"
            );
            // A box without another root that holds this one belongs to it.
            assert!(unique == enclosing, "{what}: {root:?} {points:?}");
            certified += enclosing;
            open += usize::from(enclosing == 0);
            assert!(!clear || enclosing == 1, "{what}: gap {gap}, {root:?} {points:?}");
        }
    }
    println!("{planted} planted, {certified} certified, {open} in open boxes");
    assert!(certified * 2 > planted, "{certified} of {planted}");
}

#[test]
fn a_square_far_from_the_origin() {
    // Two circles of radius 1/2 about points 1/4 apart on [10⁸, 10⁸ + 1]².
    let domain = [Enclosure::new(1e8, 1e8 + 1.0).unwrap(); 2];
    let unit = [Enclosure::UNIT; 2];
    let circle = |a: f64| {
        let x = Polynomial::variable(0, 2).add(&Polynomial::constant(-exact(a), 2));
        let y = Polynomial::variable(1, 2).add(&Polynomial::constant(-exact(0.5), 2));
        x.mul(&x)
            .add(&y.mul(&y))
            .add(&Polynomial::constant(-exact(0.125), 2))
            .bernstein(&unit)
    };
    let system = System::mapped(&domain, [circle(0.375), circle(0.625)]).unwrap();
    let points = PointSolver::default().solve(&system, &()).unwrap();
    assert_eq!((points.roots.len(), points.unresolved.len()), (2, 0));
    consistent(&points, "far away");
}

#[test]
fn differences_far_from_the_origin_lose_nothing() {
    // (x − a)(x − b)(x − c)(x − d) on [10⁹, 10⁹ + 1]: `x` and the numbers are large, and only their differences matter.
    let domain = [Enclosure::new(1e9, 1e9 + 1.0).unwrap(); 2];
    let product = |j: usize| {
        let factors =
            (0..4).map(|k| Formula::variable(j) - (1e9 + 0.125 + 0.25 * f64::from(k)) + Formula::variable(1 - j) * 0.0);
        factors.reduce(|product, f| product * f).unwrap()
    };
    let tied = product(0) + (Formula::variable(1) - (1e9 + 0.5)).powi(2) * 1e-3;
    let system = System::of_formulas(&domain, [tied, product(1)]).unwrap();
    let points = PointSolver::default().solve(&system, &()).unwrap();
    assert_eq!((points.roots.len(), points.unresolved.len()), (16, 0));
}
