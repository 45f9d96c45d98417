//! 100,000 systems with planted roots in 1 to 8 unknowns, on domains of random place and scale: thin, far from the origin, huge; variables of
//! 1e-100 … 1e100, values of 1e-300 … 1e300.
//!
//! Equations are products of planes, written as formulas in the domain's coordinates or as control values over the domain. Rational arithmetic knows all roots.
//! A small part always runs. All:
//! `cargo test -p sweepsim-solve --test it many_domains -- --ignored --nocapture`

use crate::support::planted::{Plane, Random, holds, meet};
use dashu_ratio::RBig;
use std::time::{Duration, Instant};
use sweepsim_solve::{Enclosure, Formula, PointSolver, Points, System};

/// A domain's side.
fn side(random: &mut Random) -> Enclosure {
    let width = 10f64.powf(match random.below(4) {
        0 => 0.0,
        1 => -100.0 * random.unit(),
        2 => 100.0 * random.unit(),
        _ => 16.0 * random.unit() - 8.0,
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

/// One factor of an equation: `Σ a (x − p)`, with numbers in the domain's coordinates.
struct Factor {
    a: Vec<f64>,
    p: Vec<f64>,
}

impl Factor {
    /// A plane through a point, in these variables, as steep along each of the domain's sides.
    fn through(p: &[f64], support: &[usize], domain: &[Enclosure], random: &mut Random) -> Self {
        let mut a = vec![0.0; p.len()];
        for &j in support {
            let side = domain[j].hi() - domain[j].lo();
            a[j] = random.direction() * 2f64.powi(-side.log2().round() as i32);
        }
        Self { a, p: p.to_vec() }
    }

    fn formula(&self) -> Formula {
        let terms = (0..self.a.len()).filter(|j| self.a[*j] != 0.0);
        terms
            .map(|j| (Formula::variable(j) - self.p[j]) * self.a[j])
            .reduce(|sum, term| sum + term)
            .unwrap()
    }

    fn plane(&self) -> Plane {
        Plane::at(&self.a, &self.p)
    }
}

/// A system, all its roots anywhere, and whether each is multiple.
struct Planted {
    domain: Vec<Enclosure>,
    system: System,
    roots: Vec<(Vec<RBig>, bool)>,
    /// Whether its points are far from each other, and no side of the domain has fewer than 2²⁴ numbers or so.
    apart: bool,
}

fn unknowns(random: &mut Random) -> usize {
    match random.below(100) {
        0..10 => 1,
        10..45 => 2,
        45..70 => 3,
        70..82 => 4,
        82..90 => 5,
        90..95 => 6,
        95..98 => 7,
        _ => 8,
    }
}

/// `None` if some of its planes do not meet in a point.
fn planted(random: &mut Random) -> Option<Planted> {
    let n = unknowns(random);
    let domain: Vec<Enclosure> = (0..n).map(|_| side(random)).collect();
    let place = |j: usize, u: f64| {
        let side = &domain[j];
        (side.lo() + u * (side.hi() - side.lo())).clamp(side.lo(), side.hi())
    };
    let gap = [1.0, 1.0, 1.0, 2f64.powi(-9), 2f64.powi(-30)][random.below(5) as usize];
    let first: Vec<f64> = (0..n).map(|_| random.coordinate()).collect();
    let most = [5, 4, 3, 2, 1, 1, 1, 1][n - 1];
    let mut counts: Vec<usize> = (0..n).map(|_| 1 + random.below(most) as usize).collect();
    if n > 4 {
        counts[0] += random.below(3) as usize;
        counts[n / 2] += random.below(3) as usize;
    }
    let factors: Vec<Vec<Factor>> = (0..n)
        .map(|i| {
            // Beyond four unknowns, three a equation.
            let support: Vec<usize> = if n > 4 {
                let mut some = vec![i, (i + 1) % n, random.below(n as u64) as usize];
                some.sort_unstable();
                some.dedup();
                some
            } else {
                (0..n).collect()
            };
            (0..counts[i])
                .map(|k| {
                    let p: Vec<f64> = (0..n)
                        .map(|j| match (k, gap == 1.0) {
                            (0, _) => place(j, first[j]),
                            (_, true) => place(j, random.coordinate()),
                            _ => place(j, first[j] + gap * k as f64 * random.direction()),
                        })
                        .collect();
                    Factor::through(&p, &support, &domain, random)
                })
                .collect()
        })
        .collect();
    let planes: Vec<Vec<Plane>> = factors.iter().map(|f| f.iter().map(Factor::plane).collect()).collect();
    let mut roots: Vec<(Vec<RBig>, bool)> = Vec::new();
    for choice in 0..counts.iter().product() {
        let mut rest: usize = choice;
        let chosen: Vec<&Plane> = planes
            .iter()
            .map(|own| {
                let plane = &own[rest % own.len()];
                rest /= own.len();
                plane
            })
            .collect();
        let root = meet(&chosen)?;
        match roots.iter_mut().find(|(x, _)| *x == root) {
            Some((_, multiple)) => *multiple = true,
            None => roots.push((root, false)),
        }
    }
    let formulas: Vec<Formula> = factors
        .iter()
        .map(|own| {
            let scale = match random.below(3) {
                0 => 1.0,
                1 => 2f64.powi(990),
                _ => 2f64.powi(-990),
            };
            own.iter()
                .map(Factor::formula)
                .fold(Formula::constant(scale), |product, f| product * f)
        })
        .collect();
    let system = System::of_formulas(&domain, formulas).unwrap();
    let fine = |d: &Enclosure| d.hi() - d.lo() > 2f64.powi(-28) * d.magnitude();
    Some(Planted {
        apart: gap == 1.0 && domain.iter().all(fine),
        domain,
        system,
        roots,
    })
}

/// No root is lost, none is certified twice, no certified box holds none or two. Returns the numbers of simple roots in the domain, and of certified ones.
fn audit(case: &Planted, points: &Points, what: &str) -> (usize, usize) {
    let (mut inside, mut certified) = (0, 0);
    let mut enclosed = vec![0; points.roots.len()];
    for (x, multiple) in &case.roots {
        let within = holds(&case.domain, x);
        let simple = within && !*multiple;
        let mut here = 0;
        for (root, enclosed) in points.roots.iter().zip(&mut enclosed) {
            let own = holds(&root.enclosure, x);
            assert!(own || !holds(&root.unique_in, x), "{what}: {x:?} beside {root:?}");
            *enclosed += usize::from(own);
            here += usize::from(own);
        }
        let open = points.unresolved.iter().any(|u| holds(&u.bounds, x));
        assert!(here > 0 || open || !within, "{what}: lost {x:?}\n{points:#?}");
        assert!(here <= 1, "{what}: {x:?} twice");
        assert!(!(*multiple && here > 0), "{what}: certified a multiple root {x:?}");
        inside += usize::from(simple);
        certified += usize::from(simple && here > 0);
    }
    for (root, enclosed) in points.roots.iter().zip(enclosed) {
        assert!(enclosed == 1, "{what}: {enclosed} roots in {root:?}");
    }
    (inside, certified)
}

fn everything(systems: usize) {
    let start = Instant::now();
    let (mut random, mut made) = (Random(41), 0);
    let (mut solving, mut slowest) = (Duration::ZERO, (Duration::ZERO, 0));
    // Systems, roots and certified roots by the number of unknowns, and those whose planted points are apart.
    let mut counts = [[0usize; 5]; 9];
    while made < systems {
        let seed = random.next();
        let Some(case) = planted(&mut Random(seed)) else {
            continue;
        };
        made += 1;
        let n = case.domain.len();
        let begin = Instant::now();
        let points = PointSolver::default().solve(&case.system, &()).unwrap();
        let took = begin.elapsed();
        solving += took;
        slowest = slowest.max((took, seed));
        let what = format!("seed {seed:#x}, {:?}", case.domain);
        let (inside, certified) = audit(&case, &points, &what);
        let apart = usize::from(case.apart);
        for (sum, x) in counts[n]
            .iter_mut()
            .zip([1, inside, certified, apart * inside, apart * certified])
        {
            *sum += x;
        }
    }
    println!(
        "{made} systems in {:?}, solved in {solving:?}, the slowest {slowest:?}",
        start.elapsed()
    );
    println!("unknowns; systems, simple roots, certified; of these, of points apart: simple roots, certified");
    for (n, c) in counts.iter().enumerate().skip(1) {
        println!("{n} {c:?}");
        // Some are close to others by chance.
        assert!(c[4] * 100 >= c[3] * 95 || systems < 10_000, "{n} unknowns: {c:?}");
    }
}

#[test]
fn random_systems_on_random_domains_are_solved_right() {
    everything(300);
}

#[test]
#[ignore = "100,000 systems take minutes"]
fn all_random_systems_on_random_domains_are_solved_right() {
    everything(100_000);
}
