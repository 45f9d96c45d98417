//! Clusters of known multiplicity, planted in two to eight unknowns: whatever number is claimed is right.

use crate::support::expression::{Polynomial, exact};
use crate::support::planted::Random;
use dashu_ratio::RBig;
use sweepsim_solve::{Enclosure, PointSolver, Points, System};

/// Coordinates in which a system is planted: `uᵢ = (xᵢ − aᵢ) + cᵢ (xᵢ₊₁ − aᵢ₊₁)`, exactly invertible.
fn coordinates(n: usize, at: &[f64], random: &mut Random) -> Vec<Polynomial> {
    let x = |j: usize| Polynomial::variable(j, n).add(&Polynomial::constant(-exact(at[j]), n));
    let slopes: Vec<f64> = (0..n).map(|_| 0.5 * random.direction()).collect();
    (0..n)
        .map(|i| x(i).add(&x((i + 1) % n).scale(&exact(slopes[i]))))
        .collect()
}

/// Equations that determine all coordinates but the last `m` by these: `uᵢ + bᵢ uₙ² + cᵢ uᵢ uₙ = 0`, of which only `uᵢ = −bᵢ uₙ² / (1 + cᵢ uₙ)` is a solution.
fn regular(u: &[Polynomial], m: usize, random: &mut Random) -> Vec<Polynomial> {
    let n = u.len();
    let last = &u[n - 1];
    let bent = |u: &Polynomial, random: &mut Random| {
        let square = last.mul(last).scale(&exact(random.direction()));
        let mixed = u.mul(last).scale(&exact(0.25 * random.direction()));
        u.clone().add(&square).add(&mixed)
    };
    u[..n - m].iter().map(|u| bent(u, random)).collect()
}

/// Each equation with a part of the next one: no equation shows the cluster alone. Zeros and multiplicities stay the same.
fn mixed(equations: &[Polynomial], random: &mut Random) -> Vec<Polynomial> {
    let n = equations.len();
    let mut mixed: Vec<Polynomial> = equations.to_vec();
    for i in 0..n - 1 {
        let share = equations[i + 1].scale(&exact(random.direction()));
        mixed[i] = mixed[i].clone().add(&share);
    }
    mixed[n - 1] = mixed[n - 1].clone().add(&mixed[0].scale(&exact(0.5)));
    mixed
}

fn solve(equations: &[Polynomial]) -> Points {
    let domain = vec![Enclosure::new(-1.0, 1.0).unwrap(); equations.len()];
    let system = System::mapped(&domain, equations.iter().map(|p| p.equation(&domain))).unwrap();
    PointSolver::default().solve(&system, &()).unwrap()
}

/// The number of roots near the point: certified, and claimed for open boxes; `None` if some open box there has no number.
fn number(points: &Points, at: &[f64], what: &str) -> Option<u32> {
    let near = |b: &[Enclosure]| {
        let mut sides = b.iter().zip(at);
        sides.all(|(b, x)| b.lo() <= x + 0.11 && b.hi() >= x - 0.11)
    };
    let mut number = points.roots.iter().filter(|r| near(&r.enclosure)).count() as u32;
    for open in points.unresolved.iter().filter(|u| near(&u.bounds)) {
        let count = open.count.as_ref()?;
        let zeros = count.zeros?;
        // Complex zeros come in pairs; each real one is counted with its orientation.
        if let Some(degree) = count.degree {
            assert!(
                degree.unsigned_abs() <= zeros && (zeros - degree.unsigned_abs()) % 2 == 0,
                "{what}: {count:?}"
            );
        }
        assert!(
            open.bounds
                .iter()
                .zip(&count.within)
                .all(|(b, w)| w.lo() <= b.lo() && b.hi() <= w.hi())
        );
        number += zeros;
    }
    Some(number)
}

fn somewhere(n: usize, random: &mut Random) -> Vec<f64> {
    (0..n).map(|_| 0.5 * random.direction()).collect()
}

/// `Π (uₙ − δⱼ) (uₙ − 1/2)` beside equations that are regular: as many zeros as `δ`, whatever their distances.
#[test]
fn multiplicities_two_to_six_in_two_to_eight_unknowns() {
    let mut random = Random(31);
    for n in 2..=8 {
        // In three unknowns, higher multiplicities take seconds to search: noise hides a place a hundredth of the domain wide.
        let highest = [6, 4, 6, 6, 4, 4, 4][n - 2];
        for m in 2..=highest {
            let at = somewhere(n, &mut random);
            let u = coordinates(n, &at, &mut random);
            let mut equations = regular(&u, 1, &mut random);
            let power = (0..m).fold(Polynomial::constant(RBig::ONE, n), |p, _| p.mul(&u[n - 1]));
            let far = Polynomial::constant(-exact(0.5), n).add(&u[n - 1]);
            equations.push(power.mul(&far));
            let what = format!("multiplicity {m} in {n} unknowns at {at:?}");
            let points = solve(&mixed(&equations, &mut random));
            assert_eq!(number(&points, &at, &what), Some(m), "{what}: {points:?}");
            // Of odd multiplicity, its orientation remains.
            let [open] = points.unresolved.as_slice() else {
                panic!("{what}: {points:?}")
            };
            let degree = open.count.as_ref().and_then(|c| c.degree);
            assert_eq!(degree.map(i32::abs), Some((m % 2) as i32), "{what}");
        }
    }
}

#[test]
fn pairs_at_any_distance_are_two() {
    let mut random = Random(32);
    for n in 2..=8 {
        for k in 5..=50 {
            if n > 4 && k % 5 != 0 {
                continue;
            }
            for sign in [1.0, -1.0] {
                let at = somewhere(n, &mut random);
                let u = coordinates(n, &at, &mut random);
                let mut equations = regular(&u, 1, &mut random);
                // Two real roots, or two complex ones, 2⁻ᵏ from each other.
                let gap = exact(-0.25 * sign * 0.25f64.powi(k));
                equations.push(u[n - 1].mul(&u[n - 1]).add(&Polynomial::constant(gap, n)));
                let what = format!("a pair 2^-{k} apart, {sign}, in {n} unknowns at {at:?}");
                let points = solve(&mixed(&equations, &mut random));
                let number = number(&points, &at, &what);
                let complex = sign < 0.0 && points.unresolved.is_empty();
                assert_eq!(number, Some(if complex { 0 } else { 2 }), "{what}: {points:?}");
            }
        }
    }
}

/// Two directions in which the Jacobian vanishes: the product of the forms' degrees, if these have no common zero but the root.
#[test]
fn two_directions_at_once() {
    let mut random = Random(33);
    // Forms in u and v, of which the second is added to the first where that changes nothing; their multiplicity by Bézout's theorem or, where leading forms share a zero, by
    // hand: u v = 0 = u² + v³ is 2 for v = 0 and 3 for u = 0.
    let kinds: [(u32, bool); 5] = [(4, true), (4, true), (6, true), (9, true), (5, false)];
    for n in 2..=8 {
        for (kind, (multiplicity, counted)) in kinds.into_iter().enumerate() {
            if n > 5 && kind > 2 {
                continue;
            }
            let at = somewhere(n, &mut random);
            let coordinates = coordinates(n, &at, &mut random);
            let (u, v) = (&coordinates[n - 2], &coordinates[n - 1]);
            let (uu, uv, vv) = (u.mul(u), u.mul(v), v.mul(v));
            let minus = |p: &Polynomial| p.scale(&-RBig::ONE);
            let (first, second) = match kind {
                0 => (uu.add(&minus(&vv)), uv),
                1 => (uu.clone().add(&vv.mul(v)), vv.add(&minus(&uu.mul(u)))),
                2 => (
                    uv.clone().mul(&u.clone().add(&minus(v))),
                    uu.add(&vv.scale(&exact(2.0))),
                ),
                3 => {
                    let three = exact(-3.0);
                    (
                        uu.mul(u).add(&u.mul(&vv).scale(&three)),
                        vv.mul(v).add(&v.mul(&uu).scale(&three)),
                    )
                }
                _ => (uv, uu.add(&vv.mul(v))),
            };
            let mut equations = regular(&coordinates, 2, &mut random);
            equations.push(first);
            equations.push(second);
            let what = format!("kind {kind} in {n} unknowns at {at:?}");
            let points = solve(&mixed(&equations, &mut random));
            let found = number(&points, &at, &what);
            assert!(
                found == Some(multiplicity) || (found.is_none() && !counted),
                "{what}: {found:?} {points:?}"
            );
        }
    }
}
