//! Systems with planted roots: products of hyperplanes, whose roots rational arithmetic knows, and what must hold of an answer.

use super::expression::{Polynomial, exact};
use dashu_ratio::RBig;
use sweepsim_solve::{Enclosure, Points, RootLocation};
use sweepsim_spline::Bernstein;

/// SplitMix64: seeded numbers.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// An odd multiple of 1/64 in (−1, 1): never 0.
    pub fn direction(&mut self) -> f64 {
        let k = 2 * self.below(32) + 1;
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        sign * k as f64 / 64.0
    }

    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A coordinate in `[0,1]`: often on a face, on a cut, or a short binary fraction.
    pub fn coordinate(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 => 1.0,
            2 => 0.492,
            3 => 0.492 * 0.492,
            4 => 0.5,
            _ => self.below(1024) as f64 / 1024.0,
        }
    }
}

/// `a · x − b`, exact.
pub struct Plane {
    a: Vec<RBig>,
    b: RBig,
}

impl Plane {
    /// `Σ a (x − p)`.
    pub fn at(a: &[f64], p: &[f64]) -> Self {
        let a: Vec<RBig> = a.iter().map(|a| exact(*a)).collect();
        let b = a.iter().zip(p).fold(RBig::ZERO, |s, (a, x)| s + a * exact(*x));
        Self { a, b }
    }

    pub fn through(point: &[f64], random: &mut Random) -> Self {
        let a: Vec<RBig> = point.iter().map(|_| exact(random.direction())).collect();
        let b = a.iter().zip(point).fold(RBig::ZERO, |s, (a, x)| s + a * exact(*x));
        Self { a, b }
    }

    pub fn polynomial(&self) -> Polynomial {
        let n = self.a.len();
        self.a
            .iter()
            .enumerate()
            .fold(Polynomial::constant(-self.b.clone(), n), |p, (j, a)| {
                p.add(&Polynomial::variable(j, n).scale(a))
            })
    }
}

/// The one common point of `n` planes; `None` if there is not exactly one.
pub fn meet(planes: &[&Plane]) -> Option<Vec<RBig>> {
    let n = planes.len();
    let mut rows: Vec<Vec<RBig>> = planes
        .iter()
        .map(|p| p.a.iter().cloned().chain([p.b.clone()]).collect())
        .collect();
    for c in 0..n {
        let pivot = (c..n).find(|r| rows[*r][c] != RBig::ZERO)?;
        rows.swap(c, pivot);
        let first = rows[c].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            if r != c && row[c] != RBig::ZERO {
                let factor = &row[c] / &first[c];
                for (x, y) in row.iter_mut().zip(&first) {
                    *x = &*x - &factor * y;
                }
            }
        }
    }
    Some((0..n).map(|r| &rows[r][n] / &rows[r][r]).collect())
}

pub struct Case {
    pub forms: Vec<Bernstein>,
    /// All roots in the unit box, exactly, and whether they are multiple.
    pub roots: Vec<(Vec<RBig>, bool)>,
}

/// Equation `i` is the product of one plane through each point.
pub fn case(points: &[Vec<f64>], random: &mut Random) -> Case {
    let n = points[0].len();
    let planes: Vec<Vec<Plane>> = (0..n)
        .map(|_| points.iter().map(|p| Plane::through(p, random)).collect())
        .collect();
    let unit = vec![Enclosure::UNIT; n];
    let forms = planes
        .iter()
        .map(|factors| {
            let one = Polynomial::constant(RBig::ONE, n);
            factors.iter().fold(one, |p, f| p.mul(&f.polynomial())).bernstein(&unit)
        })
        .collect();
    let mut roots: Vec<(Vec<RBig>, bool)> = Vec::new();
    let r = points.len();
    for choice in 0..r.pow(n as u32) {
        let chosen: Vec<&Plane> = (0..n).map(|i| &planes[i][choice / r.pow(i as u32) % r]).collect();
        let Some(root) = meet(&chosen) else { continue };
        if root.iter().any(|x| *x < RBig::ZERO || *x > RBig::ONE) {
            continue;
        }
        match roots.iter_mut().find(|(x, _)| *x == root) {
            Some((_, multiple)) => *multiple = true,
            None => roots.push((root, false)),
        }
    }
    Case { forms, roots }
}

/// Whether the box holds the point, exactly.
pub fn holds(bounds: &[Enclosure], x: &[RBig]) -> bool {
    bounds
        .iter()
        .zip(x)
        .all(|(b, x)| exact(b.lo()) <= *x && *x <= exact(b.hi()))
}

/// No root is lost, none is certified twice, no certified box holds two.
pub fn audit(case: &Case, points: &Points, what: &str) {
    for (x, multiple) in &case.roots {
        let certified = points.roots.iter().filter(|r| holds(&r.enclosure, x)).count();
        let open = points.unresolved.iter().filter(|u| holds(&u.bounds, x)).count();
        assert!(certified + open >= 1, "{what}: lost {x:?}\n{points:#?}");
        assert!(certified <= 1, "{what}: {x:?} twice");
        assert!(!(*multiple && certified > 0), "{what}: certified a multiple root {x:?}");
    }
    for root in &points.roots {
        let inside = case.roots.iter().filter(|(x, _)| holds(&root.unique_in, x)).count();
        let here = case.roots.iter().filter(|(x, _)| holds(&root.enclosure, x)).count();
        // A root in the enclosure may lie outside the region only where that is on the boundary.
        let may_be_outside = root.location == RootLocation::Boundary;
        assert!(inside <= 1, "{what}: {inside} roots in a box of uniqueness");
        assert!(
            here == 1 || (here == 0 && may_be_outside),
            "{what}: no root in {root:?}"
        );
    }
}
