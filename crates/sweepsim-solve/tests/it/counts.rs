//! Numbers of roots in unresolved boxes, against planted multiplicities.

use crate::support::expression::{Polynomial, exact, parse};
use crate::support::planted::Random;
use sweepsim_solve::{Enclosure, PointSolver, RootCount, System};

fn polynomial(text: &str, n: usize) -> Polynomial {
    let names = ["x", "y", "z", "w"].map(str::to_owned);
    Polynomial::of(&parse(text, &names[..n]), n).unwrap()
}

/// The count of the only unresolved box, which holds the point.
fn count(polynomials: &[Polynomial], point: &[f64], what: &str) -> RootCount {
    let domain = vec![Enclosure::new(-2.0, 2.0).unwrap(); point.len()];
    let system = System::mapped(&domain, polynomials.iter().map(|p| p.equation(&domain))).unwrap();
    let points = PointSolver::default().solve(&system, &()).unwrap();
    assert_eq!(points.unresolved.len(), 1, "{what}: {points:?}");
    let open = &points.unresolved[0];
    let count = open.count.clone().unwrap_or_else(|| panic!("{what}: {points:?}"));
    let inside = open.bounds.iter().zip(&count.within);
    assert!(inside.into_iter().all(|(b, w)| w.lo() <= b.lo() && b.hi() <= w.hi()));
    assert!(
        open.bounds.iter().zip(point).all(|(b, x)| b.contains(*x)),
        "{what}: {open:?}"
    );
    count
}

#[test]
fn multiplicities_in_one_unknown() {
    let mut random = Random(4);
    for m in 2..=6u32 {
        for _ in 0..20 {
            let (r, s) = (random.direction(), 1.0 + random.unit().floor() + 0.25);
            let x = |a: f64| Polynomial::variable(0, 1).add(&Polynomial::constant(-exact(a), 1));
            let power = (0..m).fold(x(s), |p, _| p.mul(&x(r)));
            let count = count(&[power], &[r], &format!("multiplicity {m} at {r}"));
            assert_eq!((count.zeros, count.degree), (Some(m), None));
        }
    }
    // Complex pairs count as well: (x² + 10⁻³⁰)(x − 1) is, within its rounding, a double root.
    let near = polynomial("x**2 + 1e-30", 1).mul(&polynomial("x - 1", 1));
    assert_eq!(count(&[near], &[0.0], "complex").zeros, Some(2));
}

#[test]
fn degrees_in_two_unknowns() {
    for m in 2..=6u32 {
        let u = polynomial("x - y/4 - 3/8", 2);
        let v = polynomial("y + x/4", 2);
        let power = (0..m).fold(Polynomial::constant(exact(1.0), 2), |p, _| p.mul(&u));
        let first = power.mul(&u.clone().add(&polynomial("0 - 1/4", 2))).add(&v);
        let second = v.mul(&polynomial("1 + x**2", 2));
        // v = 0 and u = 0: y = −x/4, 17/16 x = 3/8; the first equation is −uᵐ/4 there.
        let root = [6.0 / 17.0, -1.5 / 17.0];
        let degree = if m % 2 == 1 { -1 } else { 0 };
        let own = count(&[first.clone(), second.clone()], &root, "turned");
        assert_eq!((own.zeros, own.degree), (Some(m), Some(degree)), "{m}");
        // Exchanged equations turn it round.
        let own = count(&[second, first], &root, "exchanged");
        assert_eq!((own.zeros, own.degree), (Some(m), Some(-degree)), "{m}");
    }
    // zᵐ as a complex number: m-fold with degree m.
    let (mut re, mut im) = (polynomial("x", 2), polynomial("y", 2));
    for m in 2..=5i32 {
        let (x, y) = (polynomial("x", 2), polynomial("y", 2));
        let minus = |p: &Polynomial| p.scale(&exact(-1.0));
        (re, im) = (re.mul(&x).add(&minus(&im.mul(&y))), re.mul(&y).add(&im.mul(&x)));
        let count = count(&[re.clone(), im.clone()], &[0.0, 0.0], "complex power");
        // Of two forms of degree m, the complex multiplicity is m².
        assert_eq!((count.degree, count.zeros), (Some(m), Some(m.unsigned_abs().pow(2))));
    }
}

#[test]
fn degrees_in_three_and_four_unknowns() {
    // Complex powers have their exponent as degree; products of orientations, their product; an even root along a line has none.
    let cases: [(&[&str], u32, i32); 10] = [
        (&["x**2 - y**2", "2*x*y", "z"], 4, 2),
        (&["2*x*y", "x**2 - y**2", "z"], 4, -2),
        (&["x**3 - 3*x*y**2", "3*x**2*y - y**3", "z - x*y"], 9, 3),
        (&["z", "x**3 - 3*x*y**2", "3*x**2*y - y**3"], 9, 3),
        (&["x**2 - y**2 + x*z", "2*x*y + y*z", "0 - z"], 4, -2),
        (&["x", "y", "z**3"], 3, 1),
        (&["x", "y - x**2", "0 - z**5"], 5, -1),
        // A sphere and its tangent plane.
        (&["x**2 + y**2 + (z - 1)**2 - 1", "z", "x - y"], 2, 0),
        (&["(x + y - z)**2", "x - 2*y", "z + x"], 2, 0),
        (&["x**2 - y**2", "2*x*y", "z - x*w", "w"], 4, 2),
    ];
    let mut random = Random(19);
    for (texts, zeros, degree) in cases {
        let n = texts.len();
        // A shift by a dyadic point, so that no cut passes through the root.
        let at: Vec<f64> = (0..n).map(|_| 0.5 * random.direction()).collect();
        let shifted: Vec<Polynomial> = texts
            .iter()
            .map(|text| {
                let mut text = (*text).to_owned();
                for (name, a) in ["x", "y", "z", "w"].iter().zip(&at) {
                    let sign = if *a < 0.0 { "+" } else { "-" };
                    text = text.replace(name, &format!("({name} {sign} {})", a.abs()));
                }
                polynomial(&text, n)
            })
            .collect();
        let count = count(&shifted, &at, &format!("{texts:?}"));
        assert_eq!((count.zeros, count.degree), (Some(zeros), Some(degree)), "{texts:?}");
    }
}
