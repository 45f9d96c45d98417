//! Rotating, scaling, translating, permuting variables and multiplying equations by positive constants changes no answer.

use crate::support;

use dashu_ratio::RBig;
use support::expression::{Polynomial, exact, parse};
use support::planted::Random;
use sweepsim_solve::{CurveSolver, Enclosure, Equation, PointSolver, Points, SurfaceSolver, System};

/// `p(x₀, x₁, …)` with polynomials for the variables.
fn substitute(p: &Polynomial, x: &[Polynomial]) -> Polynomial {
    let n = x.len();
    let mut sum = Polynomial::default();
    for (exponents, c) in &p.0 {
        let start = Polynomial::constant(c.clone(), n);
        let term = exponents
            .iter()
            .zip(x)
            .fold(start, |t, (e, x)| (0..*e).fold(t, |t, _| t.mul(x)));
        sum = sum.add(&term);
    }
    sum
}

/// An affine change of variables `x = factor · rotation(permutation(y)) + shift`, exact.
struct Change {
    name: &'static str,
    /// `y` in terms of `x` is needed to move roots: the inverse's rows, and the shift taken off before.
    forward: Vec<Vec<RBig>>,
    shift: Vec<RBig>,
    /// The box `[−1, 1]ⁿ` of `x` is a box of `y`; otherwise only what lies in the unit ball can be compared.
    keeps_boxes: bool,
}

impl Change {
    fn all(n: usize) -> Vec<Self> {
        let identity = || -> Vec<Vec<RBig>> {
            let entry = |i: usize, j: usize| if i == j { RBig::ONE } else { RBig::ZERO };
            (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
        };
        let none = || vec![RBig::ZERO; n];
        let times = |factor: f64| -> Vec<Vec<RBig>> {
            identity()
                .into_iter()
                .map(|row| row.into_iter().map(|x| x * exact(factor)).collect())
                .collect()
        };
        let mut rotation = identity();
        let (c, s) = (RBig::from(3) / RBig::from(5), RBig::from(4) / RBig::from(5));
        (rotation[0][0], rotation[0][1]) = (c.clone(), -s.clone());
        (rotation[1][0], rotation[1][1]) = (s, c);
        let mut permutation = identity();
        permutation.rotate_left(1);
        let mut mirror = identity();
        mirror[0][0] = -RBig::ONE;
        let change = |name, forward, shift, keeps_boxes| Self {
            name,
            forward,
            shift,
            keeps_boxes,
        };
        vec![
            change("rotated", rotation, none(), false),
            change("permuted", permutation, none(), true),
            change("mirrored", mirror, none(), true),
            change("shrunk", times(1024.0), none(), true),
            change("stretched", times(1.0 / 512.0), none(), true),
            change(
                "moved",
                identity(),
                vec![exact(2.5), exact(-7.0), exact(0.375)][..n].to_vec(),
                true,
            ),
        ]
    }

    /// `x` in terms of `y`.
    fn x(&self) -> Vec<Polynomial> {
        let n = self.shift.len();
        (0..n)
            .map(|i| {
                (0..n).fold(Polynomial::constant(self.shift[i].clone(), n), |p, j| {
                    p.add(&Polynomial::variable(j, n).scale(&self.forward[i][j]))
                })
            })
            .collect()
    }

    /// The box of `y` with the image `[−1, 1]ⁿ`; for a rotation, `[−1, 1]ⁿ` again.
    fn bounds(&self) -> Vec<Enclosure> {
        let n = self.shift.len();
        let unit = vec![Enclosure::new(-1.0, 1.0).unwrap(); n];
        if !self.keeps_boxes {
            return unit;
        }
        // One entry a row and column.
        (0..n)
            .map(|j| {
                let i = (0..n).find(|i| self.forward[*i][j] != RBig::ZERO).unwrap();
                let end = |x: f64| ((exact(x) - &self.shift[i]) / &self.forward[i][j]).to_f64().value();
                let (a, b) = (end(-1.0), end(1.0));
                Enclosure::new(a.min(b), a.max(b)).unwrap()
            })
            .collect()
    }

    fn image(&self, y: &[f64]) -> Vec<f64> {
        let row = |i: usize| -> f64 {
            let terms = self.forward[i].iter().zip(y);
            let sum: f64 = terms.map(|(a, y)| a.to_f64().value() * y).sum();
            sum + self.shift[i].to_f64().value()
        };
        (0..y.len()).map(row).collect()
    }
}

fn equations(polynomials: &[Polynomial], bounds: &[Enclosure], factors: &[f64]) -> Vec<Equation> {
    let scaled = polynomials.iter().zip(factors).map(|(p, f)| p.scale(&exact(*f)));
    scaled.map(|p| p.equation(bounds)).collect()
}

const POSITIVE: [f64; 3] = [3.7e-6, 5.1e4, 0.3];

fn points(polynomials: &[Polynomial], bounds: &[Enclosure], factors: &[f64]) -> Points {
    let system = System::mapped(bounds, equations(polynomials, bounds, factors)).unwrap();
    PointSolver::default().solve(&system, &()).unwrap()
}

/// A random polynomial of total degree 3 with short coefficients.
fn random_cubic(n: usize, random: &mut Random) -> Polynomial {
    let mut p = Polynomial::default();
    for code in 0..4usize.pow(n as u32) {
        let exponents: Vec<u32> = (0..n).map(|j| (code / 4usize.pow(j as u32) % 4) as u32).collect();
        if exponents.iter().sum::<u32>() <= 3 {
            p.0.insert(exponents, exact(random.direction()));
        }
    }
    p
}

#[test]
fn points_stay_the_same() {
    let mut random = Random(31);
    let mut compared = 0;
    for number in 0..60 {
        let n = 2 + usize::from(number % 3 == 2);
        let polynomials: Vec<Polynomial> = (0..n).map(|_| random_cubic(n, &mut random)).collect();
        let plain = points(&polynomials, &vec![Enclosure::new(-1.0, 1.0).unwrap(); n], &[1.0; 3]);
        assert!(plain.unresolved.is_empty(), "{number}");
        for change in Change::all(n) {
            let x = change.x();
            let moved: Vec<Polynomial> = polynomials.iter().map(|p| substitute(p, &x)).collect();
            let found = points(&moved, &change.bounds(), &POSITIVE);
            assert!(found.unresolved.is_empty(), "{number} {}", change.name);
            let images: Vec<Vec<f64>> = found.roots.iter().map(|r| change.image(&r.point)).collect();
            if change.keeps_boxes {
                assert_eq!(found.roots.len(), plain.roots.len(), "{number} {}", change.name);
            }
            let inside = |x: &[f64]| change.keeps_boxes || x.iter().map(|c| c * c).sum::<f64>() < 0.99;
            let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
            for root in plain.roots.iter().filter(|r| inside(&r.point)) {
                let same = images.iter().filter(|x| near(x, &root.point)).count();
                assert_eq!(same, 1, "{number} {}: {root:?}", change.name);
                compared += 1;
            }
            for image in images.iter().filter(|x| inside(x)) {
                let same = plain.roots.iter().filter(|r| near(image, &r.point)).count();
                assert_eq!(same, 1, "{number} {}: {image:?}", change.name);
            }
        }
    }
    assert!(compared > 200, "{compared}");
}

fn named(text: &str, n: usize) -> Polynomial {
    let names = ["x", "y", "z"].map(String::from);
    Polynomial::of(&parse(text, &names[..n]), n).unwrap()
}

#[test]
fn curves_stay_the_same() {
    // Equations with curves within the unit ball, loops and all; and some that leave the box.
    let cases: [(&[&str], usize, bool); 7] = [
        (&["x**2+2*y**2-0.3"], 2, true),
        (&["((x-0.3)**2+y**2-0.05)*((x+0.3)**2+y**2-0.04)"], 2, true),
        (&["(x**2+y**2)**2-0.5*(x**2-y**2)+0.01"], 2, true),
        (&["y-x**3+0.1*x"], 2, false),
        (&["x**2+y**2+z**2-0.5", "x**2+y**2-0.2"], 3, true),
        (&["x**2+y**2+z**2-0.5", "(x-0.4)**2+z**2-0.2"], 3, true),
        (&["x*y-z", "x+y+z-0.2"], 3, false),
    ];
    for (texts, n, closed) in cases {
        let polynomials: Vec<Polynomial> = texts.iter().map(|t| named(t, n)).collect();
        let topology = |p: &[Polynomial], bounds: &[Enclosure], factors: &[f64]| {
            let tolerance = 1e-2 * bounds.iter().fold(f64::INFINITY, |m: f64, b| m.min(b.radius()));
            let system = System::mapped(bounds, equations(p, bounds, factors)).unwrap();
            let curves = CurveSolver::new(tolerance).solve(&system, &()).unwrap();
            assert!(curves.singular.is_empty(), "{texts:?}");
            (curves.loops().count(), curves.arcs().count())
        };
        let plain = topology(&polynomials, &vec![Enclosure::new(-1.0, 1.0).unwrap(); n], &[1.0; 3]);
        assert!(
            plain.0 + plain.1 > 0 && (plain.1 == 0) == closed,
            "{texts:?}: {plain:?}"
        );
        for change in Change::all(n).iter().filter(|c| c.keeps_boxes || closed) {
            let x = change.x();
            let moved: Vec<Polynomial> = polynomials.iter().map(|p| substitute(p, &x)).collect();
            assert_eq!(
                topology(&moved, &change.bounds(), &POSITIVE),
                plain,
                "{texts:?} {}",
                change.name
            );
        }
    }
}

#[test]
fn surfaces_stay_the_same() {
    for (text, closed) in [
        ("x**2+2*y**2+3*z**2-0.4", true),
        ("(x**2+y**2+z**2+0.25-0.04)**2-(x**2+y**2)", true),
        ("((x-0.35)**2+y**2+z**2-0.1)*((x+0.35)**2+y**2+z**2-0.08)", true),
        ("x**2+y**2-z**2-0.1", false),
    ] {
        let polynomial = named(text, 3);
        let topology = |p: &Polynomial, bounds: &[Enclosure], factor: f64| {
            let tolerance = 0.1 * bounds.iter().fold(f64::INFINITY, |m: f64, b| m.min(b.radius()));
            let system = System::mapped(bounds, equations(std::slice::from_ref(p), bounds, &[factor])).unwrap();
            let surface = SurfaceSolver::new(tolerance).solve(&system, &()).unwrap();
            assert!(surface.unresolved.is_empty(), "{text}");
            assert_eq!(surface.boundary().is_empty(), closed, "{text}");
            (surface.euler_characteristic(), surface.components())
        };
        let plain = topology(&polynomial, &[Enclosure::new(-1.0, 1.0).unwrap(); 3], 1.0);
        for change in Change::all(3).iter().filter(|c| c.keeps_boxes || closed) {
            let moved = substitute(&polynomial, &change.x());
            for factor in POSITIVE {
                assert_eq!(
                    topology(&moved, &change.bounds(), factor),
                    plain,
                    "{text} {}",
                    change.name
                );
            }
        }
    }
}
