//! Random surfaces with a known Euler characteristic.

use crate::many::{Outcome, ball, unit};
use crate::support::expression::{Polynomial, exact};
use crate::support::planted::Random;
use dashu_ratio::RBig;
use sweepsim_solve::{Surface, SurfaceSolver, System};
use sweepsim_spline::Bernstein;

/// Spheres apart from or within one another, and tori: closed surfaces with a known Euler characteristic.
pub fn planted_surfaces(number: u64) -> Outcome {
    let mut random = Random(number ^ 0x5FCE);
    let (product, euler, components) = if number.is_multiple_of(3) {
        // (|x|² + R² − r²)² = 4 R² (x² + y²) about an axis through the middle.
        let (large, small) = (0.25 + 0.05 * random.unit(), 0.05 + 0.1 * random.unit());
        let axis = random.below(3) as usize;
        let centre = [0, 1, 2].map(|_| 0.5 + 0.05 * random.direction());
        let squares: Vec<Polynomial> = (0..3)
            .map(|j| {
                let x = Polynomial::variable(j, 3).add(&Polynomial::constant(-exact(centre[j]), 3));
                x.mul(&x)
            })
            .collect();
        let (r, s) = (exact(large), exact(small));
        let shift = Polynomial::constant(&r * &r - &s * &s, 3);
        let sum = squares.iter().fold(shift, |p, x| p.add(x));
        let ring = (0..3)
            .filter(|j| *j != axis)
            .fold(Polynomial::default(), |p, j| p.add(&squares[j]));
        let torus = sum.mul(&sum).add(&ring.scale(&(-RBig::from(4) * &r * &r)));
        (torus, 0, 1)
    } else {
        let mut spheres: Vec<([f64; 3], f64)> = Vec::new();
        for _ in 0..40 {
            let radius = 0.08 + 0.25 * random.unit();
            let centre = [0, 1, 2].map(|_| radius + 0.03 + (0.94 - 2.0 * radius) * random.unit());
            let away = |c: &([f64; 3], f64)| {
                let d = (0..3).map(|j| (c.0[j] - centre[j]).powi(2)).sum::<f64>().sqrt();
                d > c.1 + radius + 0.01 || d < (c.1 - radius).abs() - 0.01
            };
            if spheres.iter().all(away) {
                spheres.push((centre, radius));
            }
            if spheres.len() == 2 {
                break;
            }
        }
        let one = Polynomial::constant(RBig::ONE, 3);
        let product = spheres.iter().fold(one, |p, (c, r)| p.mul(&ball(c, *r)));
        (product, 2 * spheres.len() as i64, spheres.len())
    };
    let system = System::new(&unit(3), [product.bernstein(&unit(3))]).unwrap();
    let surface = SurfaceSolver::new(0.2).solve(&system, &()).unwrap();
    assert!(surface.boundary().is_empty(), "case {number}");
    compare_surface(&surface, euler, number, Some(components))
}

fn compare_surface(surface: &Surface, euler: i64, number: u64, components: Option<usize>) -> Outcome {
    if !surface.unresolved.is_empty() {
        return Outcome::Open;
    }
    assert_eq!(surface.euler_characteristic(), euler, "case {number}");
    assert!(components.is_none_or(|c| c == surface.components()), "case {number}");
    Outcome::Settled
}

/// Level sets of random forms against Euler characteristics of a triangulated grid: with `R = {f ≤ 0}`, the boundary of `R` is the surface
/// and a part of the cube's, joined along curves, so `χ(surface) = 2 χ(R) − χ(R on the cube's boundary)`.
pub fn random_surfaces(number: u64) -> Outcome {
    let mut random = Random(number ^ 0x12A5);
    let degrees = [0, 1, 2].map(|_| 1 + random.below(2) as usize);
    let form = Bernstein::from_fn(&degrees, |_| 2.0 * random.unit() - 1.0).unwrap();
    let system = System::new(&unit(3), [&form]).unwrap();
    let surface = SurfaceSolver::new(1.0).solve(&system, &()).unwrap();
    let own = surface.euler_characteristic();
    let mut euler = euler_on_grid(&form, 13);
    if euler != own || euler_on_grid(&form, 24) != own {
        // Thin handles slip through coarse grids.
        euler = euler_on_grid(&form, 60);
        if euler_on_grid(&form, 150) != euler {
            return Outcome::Skipped;
        }
    }
    compare_surface(&surface, euler, number, None)
}

/// The surface's Euler characteristic by the full subcomplex of Kuhn's triangulation of a grid on the points where `f ≤ 0`.
fn euler_on_grid(form: &Bernstein, n: usize) -> i64 {
    let at = |i: usize| i as f64 / n as f64;
    let side = n + 1;
    let inside: Vec<bool> = (0..side * side * side)
        .map(|p| form.evaluate(&[at(p % side), at(p / side % side), at(p / side / side)]) <= 0.0)
        .collect();
    // A simplex of Kuhn's triangulation is a corner and a chain of growing sets of axes to step along.
    let mut chains: Vec<Vec<usize>> = vec![vec![]];
    let mut start = 0;
    for _ in 0..3 {
        let end = chains.len();
        for c in start..end {
            let last = chains[c].last().copied().unwrap_or(0);
            for next in 1..8usize {
                if next & last == last && next != last {
                    let mut longer = chains[c].clone();
                    longer.push(next);
                    chains.push(longer);
                }
            }
        }
        start = end;
    }
    let (mut all, mut boundary) = (0, 0);
    for p in 0..inside.len() {
        let corner = [p % side, p / side % side, p / side / side];
        if !inside[p] {
            continue;
        }
        for chain in &chains {
            let reach = chain.last().copied().unwrap_or(0);
            if (0..3).any(|j| reach >> j & 1 == 1 && corner[j] == n) {
                continue;
            }
            let step = |set: usize| (set & 1) + (set >> 1 & 1) * side + (set >> 2 & 1) * side * side;
            if chain.iter().all(|s| inside[p + step(*s)]) {
                let sign = if chain.len().is_multiple_of(2) { 1 } else { -1 };
                all += sign;
                let on_face = (0..3).any(|j| reach >> j & 1 == 0 && (corner[j] == 0 || corner[j] == n));
                boundary += if on_face { sign } else { 0 };
            }
        }
    }
    2 * all - boundary
}
