//! Every operation on B-splines against exact rational arithmetic.

use crate::common;

use common::{Exact, Random, exact, within};
use dashu_ratio::RBig;
use proptest::prelude::*;
use sweepsim_spline::{BSpline, Bernstein, BernsteinMap, KnotVector, SplineError};

/// The value of component `k`, exactly, by the recurrence of de Boor and Cox.
fn value(spline: &BSpline, k: usize, point: &[f64]) -> RBig {
    let mut values: Vec<RBig> = spline.points().map(|p| exact(p[k])).collect();
    for (vector, &x) in spline.knots().iter().zip(point) {
        let span = vector.span(x);
        let (p, t) = (vector.degree(), vector.knots());
        let x = exact(x);
        let mut basis = vec![RBig::ONE];
        for j in 1..=p {
            let mut saved = RBig::ZERO;
            for r in 0..j {
                let (below, above) = (exact(t[span + 1 + r - j]), exact(t[span + 1 + r]));
                let share = &basis[r] / (&above - &below);
                basis[r] = &saved + (&above - &x) * &share;
                saved = (&x - &below) * &share;
            }
            basis.push(saved);
        }
        values = values
            .chunks(vector.count())
            .map(|line| {
                let own = &line[span - p..=span];
                own.iter().zip(&basis).fold(RBig::ZERO, |sum, (c, b)| sum + c * b)
            })
            .collect();
    }
    values.swap_remove(0)
}

/// Open, floating or periodic knots with few bits, on `[0, end]`.
fn knots(random: &mut Random, degree: usize, end: usize) -> KnotVector {
    let mut inner = Vec::new();
    for _ in 0..random.below(4) {
        let x = (1 + random.below(8 * end - 1)) as f64 / 8.0;
        for _ in 0..1 + random.below(degree + 1) {
            if inner.iter().filter(|&&y| y == x).count() <= degree {
                inner.push(x);
            }
        }
    }
    inner.sort_by(f64::total_cmp);
    let mut list = vec![0.0];
    list.extend(inner);
    list.push(end as f64);
    let open = KnotVector::open(degree, &list).expect("knots");
    match random.below(4) {
        0 => {
            let mut knots = open.knots().to_vec();
            let last = knots.len() - 1;
            for i in 0..degree {
                knots[i] -= (degree - i) as f64 / 4.0;
                knots[last - i] += (degree - i) as f64 / 4.0;
            }
            KnotVector::new(degree, knots).expect("knots")
        }
        1 => KnotVector::periodic(degree, &[0.0, 0.25, end as f64]).expect("knots"),
        _ => open,
    }
}

fn spline(random: &mut Random, variables: usize, most: usize, dimension: usize) -> BSpline {
    let knots: Vec<KnotVector> = (0..variables)
        .map(|axis| {
            let degree = random.below(most + 1);
            knots(random, degree, axis + 1)
        })
        .collect();
    let count = knots.iter().map(KnotVector::count).product::<usize>() * dimension;
    let coefficients = random.coefficients(count);
    BSpline::new(knots, dimension, coefficients).expect("a spline")
}

/// A point of the domain with few bits.
fn point(random: &mut Random, spline: &BSpline) -> Vec<f64> {
    spline
        .domain()
        .iter()
        .map(|&(lo, hi)| lo + (hi - lo) * random.below(65) as f64 / 64.0)
        .collect()
}

fn assert_is(spline: &BSpline, random: &mut Random, what: &str, truth: impl Fn(&[f64], usize) -> RBig) {
    assert!(spline.is_finite(), "{what}: nothing known of {spline}");
    for _ in 0..3 {
        let p = point(random, spline);
        for k in 0..spline.dimension() {
            let (a, b) = (value(spline, k, &p), truth(&p, k));
            assert!(
                within(&a, &b, spline.error()),
                "{what} at {p:?}: off by {:e}, bound {:e}\n{spline}",
                (&a - &b).to_f64().value(),
                spline.error()
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn evaluation(seed: u64) {
        let mut random = Random(seed);
        let (n, m) = (1 + random.below(3), 1 + random.below(3));
        let f = spline(&mut random, n, 5, m);
        for outside in [false, true] {
            let mut p = point(&mut random, &f);
            if outside {
                p[0] = random.below(160) as f64 / 16.0 - 5.0;
            }
            let (found, error) = f.evaluate_with_error(&p);
            for (k, &x) in found.iter().enumerate() {
                prop_assert!(within(&exact(x), &value(&f, k, &p), error));
            }
            let mut again = vec![0.0; m];
            f.evaluate_batch(&p, &mut again);
            prop_assert_eq!(&again, &found);
            // Derivatives by three ways agree: tables, Jacobian, derivative splines.
            let all = f.derivatives(&p, 2);
            let jacobian = f.jacobian(&p);
            for axis in 0..n {
                let mut orders = vec![0; n];
                orders[axis] = 1;
                let slope = all.get(&orders).expect("of order 1");
                let derived = f.derivative(axis).expect("a variable");
                let (by_spline, error) = derived.evaluate_with_error(&p);
                for k in 0..m {
                    let scale = 1e-11 * (1.0 + derived.magnitude() + f.magnitude() * 64.0) + error;
                    let slack = if outside { 1e6 * scale } else { scale };
                    prop_assert!((slope[k] - jacobian[(k, axis)]).abs() <= slack);
                    // A jump or kink at a knot: the values there may be those of the other side.
                    let smooth = f.knots()[axis].multiplicity(p[axis]) == 0 || f.knots()[axis].domain().0 == p[axis];
                    if !outside && smooth {
                        prop_assert!((slope[k] - by_spline[k]).abs() <= scale, "{} {} {}", slope[k], by_spline[k], scale);
                    }
                }
            }
        }
    }

    #[test]
    fn knots_in_and_out(seed: u64) {
        let mut random = Random(seed);
        let n = 1 + random.below(3);
        let f = spline(&mut random, n, 5, 2);
        let axis = random.below(n);
        let x = f.domain()[axis].1 * (1 + random.below(30)) as f64 / 32.0;
        let times = random.below(f.degree(axis) + 2 - f.knots()[axis].multiplicity(x).min(f.degree(axis) + 1));
        let fine = f.insert_knot(axis, x, times).expect("inside");
        assert_is(&fine, &mut random, "inserted", |p, k| value(&f, k, p));
        let mut back = fine;
        for _ in 0..times {
            back = back.remove_knot(axis, x).expect("was inserted");
        }
        prop_assert_eq!(back.knots(), f.knots());
        for (a, b) in back.coefficients().iter().zip(f.coefficients()) {
            prop_assert!((a - b).abs() <= back.error());
        }
        let open = f.open(axis).expect("a variable");
        assert_is(&open, &mut random, "opened", |p, k| value(&f, k, p));
    }

    #[test]
    fn degrees_up_and_down(seed: u64) {
        let mut random = Random(seed);
        let n = 1 + random.below(2);
        let f = spline(&mut random, n, 4, 1);
        let axis = random.below(n);
        let by = 1 + random.below(3);
        let high = f.elevate(axis, by).expect("a variable");
        assert_is(&high, &mut random, "elevated", |p, k| value(&f, k, p));
        let mut low = high;
        for _ in 0..by {
            low = low.reduce(axis).expect("was elevated");
        }
        assert_is(&low, &mut random, "reduced again", |p, k| value(&f, k, p));
        prop_assert_eq!(low.degree(axis), f.degree(axis));
    }

    #[test]
    fn pieces_and_back(seed: u64) {
        let mut random = Random(seed);
        let n = 1 + random.below(3);
        let f = spline(&mut random, n, 4, 2);
        let pieces = f.pieces().expect("small");
        for piece in &pieces {
            let local: Vec<f64> = (0..n).map(|_| random.below(9) as f64 / 8.0).collect();
            // Inside the box, so that the exact value is of this piece.
            let p: Vec<f64> = local.iter().zip(&piece.ranges).map(|(s, (lo, hi))| lo + (hi - lo) * (0.125 + 0.75 * s)).collect();
            let q: Vec<f64> = local.iter().map(|s| 0.125 + 0.75 * s).collect();
            for (k, component) in piece.map.components().iter().enumerate() {
                prop_assert!(within(&Exact::from(component).value(&q), &value(&f, k, &p), component.error()));
            }
        }
        let maps: Vec<BernsteinMap> = pieces.into_iter().map(|p| p.map).collect();
        let back = BSpline::from_pieces(f.knots().to_vec(), &maps).expect("its own pieces");
        for (a, b) in back.coefficients().iter().zip(f.coefficients()) {
            prop_assert!((a - b).abs() <= back.error());
        }
        // On smoother knots they are not welcome.
        let vector = &f.knots()[0];
        if let Some(&x) = vector.breakpoints().get(1).filter(|&&x| x < vector.domain().1) {
            match f.remove_knot(0, x) {
                Ok(smoother) => assert_is(&smoother, &mut random, "removed", |p, k| value(&f, k, p)),
                Err(error) => {
                    let not_exact = matches!(error, SplineError::NotExact { .. });
                    prop_assert!(not_exact, "{}", error);
                }
            }
        }
    }

    #[test]
    fn algebra(seed: u64) {
        let mut random = Random(seed);
        let n = 1 + random.below(2);
        let m = 1 + random.below(3);
        let (f, g) = (spline(&mut random, n, 3, m), spline(&mut random, n, 3, m));
        let v = |s: &BSpline, p: &[f64], k: usize| value(s, k, p);
        assert_is(&f.add(&g).expect("alike"), &mut random, "f + g", |p, k| v(&f, p, k) + v(&g, p, k));
        assert_is(&f.sub(&g).expect("alike"), &mut random, "f − g", |p, k| v(&f, p, k) - v(&g, p, k));
        assert_is(&f.mul(&g).expect("alike"), &mut random, "f g", |p, k| v(&f, p, k) * v(&g, p, k));
        assert_is(&f.dot(&g).expect("alike"), &mut random, "f · g", |p, _| {
            (0..m).fold(RBig::ZERO, |sum, k| sum + v(&f, p, k) * v(&g, p, k))
        });
        assert_is(&f.square_norm().expect("small"), &mut random, "|f|²", |p, _| {
            (0..m).fold(RBig::ZERO, |sum, k| sum + v(&f, p, k) * v(&f, p, k))
        });
        assert_is(&f.scale(0.3), &mut random, "0.3 f", |p, k| v(&f, p, k) * exact(0.3));
        let both = f.tensor_product(&g).expect("alike");
        assert_is(&both, &mut random, "f ⊗ g", |p, k| v(&f, &p[..n], k) * v(&g, &p[n..], k));
        let stacked = BSpline::stack(&[f.clone(), g.clone()]).expect("alike");
        assert_is(&stacked, &mut random, "(f, g)", |p, k| if k < m { v(&f, p, k) } else { v(&g, p, k - m) });
        let rows = vec![(vec![0.1; m], 0.7), (vec![-2.0; m], 0.0)];
        assert_is(&f.transform(&rows).expect("rows"), &mut random, "A f + b", |p, k| {
            (0..m).fold(exact(rows[k].1), |sum, i| sum + v(&f, p, i) * exact(rows[k].0[i]))
        });
        let (a, b) = (spline(&mut random, n, 2, 3), spline(&mut random, n, 2, 3));
        let cross = a.cross(&b).expect("three components");
        assert_is(&cross, &mut random, "a × b", |p, k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            v(&a, p, i) * v(&b, p, j) - v(&a, p, j) * v(&b, p, i)
        });
        prop_assert!(cross.dot(&a).expect("alike").may_vanish());
        let c = spline(&mut random, n, 1, 3);
        let triple = BSpline::determinant(&[a.clone(), b.clone(), c.clone()]).expect("square");
        assert_is(&triple, &mut random, "det", |p, _| {
            (0..3).fold(RBig::ZERO, |sum, k| sum + {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (v(&a, p, i) * v(&b, p, j) - v(&a, p, j) * v(&b, p, i)) * v(&c, p, k)
            })
        });
    }

    #[test]
    fn calculus(seed: u64) {
        let mut random = Random(seed);
        let n = 1 + random.below(2);
        let f = spline(&mut random, n, 4, 1);
        let axis = random.below(n);
        let integral = f.integral(axis).expect("a variable");
        // ∂∫f = f (with open ends), and the integral at the start is 0.
        let back = integral.derivative(axis).expect("a variable");
        assert_is(&back, &mut random, "∂∫f", |p, k| value(&f, k, p));
        prop_assert_eq!(integral.face(axis, false).expect("a face").magnitude(), 0.0);
        // The whole integral is the mean of the pieces' coefficients times the volumes.
        let (whole, error) = f.integral_over_domain().expect("small");
        let sum = f.pieces().expect("small").iter().fold((0.0, 0.0), |(sum, off), piece| {
            let volume: f64 = piece.ranges.iter().map(|(a, b)| b - a).product();
            let (mean, error) = piece.map.components()[0].mean();
            (sum + mean * volume, off + error * volume)
        });
        prop_assert!((whole[0] - sum.0).abs() <= error + sum.1 + 1e-13 * sum.0.abs());
        // The derivative: the exact one piece by piece.
        let derivative = f.derivative(axis).expect("a variable");
        let pieces = derivative.pieces().expect("small");
        for (own, whole) in pieces.iter().zip(f.pieces().expect("small")) {
            let length = whole.ranges[axis].1 - whole.ranges[axis].0;
            let truth = whole.map.components()[0].derivative(axis).scale(1.0 / length);
            prop_assert!(truth.sub(&own.map.components()[0]).may_vanish() || f.degree(axis) == 0);
        }
        // The product rule, and ∂∂ symmetric.
        let g = spline(&mut random, n, 3, 1);
        if f.degree(axis) > 0 && g.degree(axis) > 0 {
            let product = f.mul(&g).expect("alike").derivative(axis).expect("a variable");
            let rule = f.derivative(axis).expect("").mul(&g).expect("").add(&f.mul(&g.derivative(axis).expect("")).expect("")).expect("");
            prop_assert!(product.sub(&rule).expect("").may_vanish());
        }
        if n == 2 {
            let (xy, yx) = (
                f.derivative(0).expect("").derivative(1).expect(""),
                f.derivative(1).expect("").derivative(0).expect(""),
            );
            prop_assert!(xy.sub(&yx).expect("").may_vanish());
        }
    }

    #[test]
    fn domains(seed: u64) {
        let mut random = Random(seed);
        let n = 1 + random.below(3);
        let f = spline(&mut random, n, 4, 2);
        let axis = random.below(n);
        let at = f.domain()[axis].1 * (1 + random.below(31)) as f64 / 32.0;
        let (left, right) = f.split(axis, at).expect("inside");
        let smooth = f.knots()[axis].multiplicity(at) <= f.degree(axis);
        assert_is(&right, &mut random, "right", |p, k| value(&f, k, p));
        if smooth && f.degree(axis) > 0 {
            assert_is(&left, &mut random, "left", |p, k| value(&f, k, p));
            let mut joined = left.join(&right, axis).expect("halves");
            let times = f.degree(axis) - f.knots()[axis].multiplicity(at);
            for _ in 0..times {
                joined = joined.remove_knot(axis, at).expect("smooth");
            }
            assert_is(&joined, &mut random, "joined", |p, k| value(&f, k, p));
        }
        let (start, end) = f.domain()[axis];
        let part = f.restrict(axis, start + (end - start) / 4.0, at.max(start + (end - start) / 2.0)).expect("inside");
        if f.degree(axis) > 0 && part.knots()[axis].domain().1 < end && f.knots()[axis].multiplicity(part.knots()[axis].domain().1) <= f.degree(axis) {
            assert_is(&part, &mut random, "part", |p, k| value(&f, k, p));
        }
        let slice = f.slice(axis, at).expect("inside");
        assert_is(&slice, &mut random, "slice", |p, k| {
            let mut p = p.to_vec();
            p.insert(axis, at);
            value(&f, k, &p)
        });
        let line = KnotVector::bernstein(random.below(3), -1.0, 1.0).expect("knots");
        let wide = f.extend(axis, line).expect("room");
        prop_assert_eq!(wide.error(), 0.0);
        assert_is(&wide, &mut random, "wide", |p, k| {
            let mut p = p.to_vec();
            p.remove(axis);
            value(&f, k, &p)
        });
        let mut axes: Vec<usize> = (0..n).collect();
        axes.rotate_left(random.below(n));
        assert_is(&f.permute(&axes).expect("axes"), &mut random, "permuted", |p, k| {
            let mut q = vec![0.0; n];
            for (i, &axis) in axes.iter().enumerate() {
                q[axis] = p[i];
            }
            value(&f, k, &q)
        });
        // Knots with few bits: reversing and doubling the domain are exact.
        let reversed = f.reverse(axis).expect("few bits");
        prop_assert_eq!(&reversed.reverse(axis).expect("few bits"), &f);
        let far = f.reparametrise(axis, 2.0 * start + 8.0, 2.0 * end + 8.0).expect("few bits");
        assert_is(&far, &mut random, "reparametrised", |p, k| {
            let mut p = p.to_vec();
            p[axis] = (p[axis] - 8.0) / 2.0;
            value(&f, k, &p)
        });
    }

    #[test]
    fn composition(seed: u64) {
        let mut random = Random(seed);
        let f = spline(&mut random, 2, 3, 2);
        let piece = f.pieces().expect("small").swap_remove(0);
        let curve: Vec<Bernstein> = piece
            .ranges
            .iter()
            .map(|&(lo, hi)| {
                let inside = |s: usize| lo + (hi - lo) * s as f64 / 16.0;
                let points = (0..3).map(|_| inside(random.below(17))).collect();
                Bernstein::new(&[2], points).expect("a form")
            })
            .collect();
        let on_curve = f.compose(&BernsteinMap::new(curve.clone())).expect("in one span");
        let t = [0.25];
        let p: Vec<f64> = curve.iter().map(|c| Exact::from(c).value(&t).to_f64().value()).collect();
        // At the far end of a span the other piece has the say, and may be another where f jumps.
        if p.iter().zip(&piece.ranges).all(|(x, (_, hi))| x < hi) {
            for (k, component) in on_curve.components().iter().enumerate() {
                prop_assert!(within(&Exact::from(component).value(&t), &value(&f, k, &p), component.error()));
            }
        }
    }

    #[test]
    fn uneven_knots(seed: u64) {
        // Distances over many orders of magnitude, arguments of all bits.
        let mut random = Random(seed);
        let degree = 1 + random.below(4);
        let mut list = vec![-0.3];
        for _ in 0..random.below(5) {
            let last = list[list.len() - 1];
            list.push(last + random.unit() * (-(random.below(24) as f64)).exp2() + 1e-9);
        }
        let mut of = |list: &[f64], degree: usize| {
            let vector = KnotVector::open(degree, &[list, &[5.1]].concat()).expect("knots");
            let count = vector.count();
            BSpline::new(vec![vector], 1, random.coefficients(count)).expect("a spline")
        };
        let (f, g) = (of(&list, degree), of(&list[..1 + list.len() / 2], 2));
        let random = &mut random;
        let x = random.between(-0.2, 5.0);
        let halves = f.split(0, x).expect("inside");
        let smooth = |h: Result<BSpline, SplineError>| h.expect("of a variable");
        assert_is(&smooth(f.mul(&g)), random, "f g", |p, k| value(&f, k, p) * value(&g, k, p));
        assert_is(&smooth(f.add(&g)), random, "f + g", |p, k| value(&f, k, p) + value(&g, k, p));
        assert_is(&smooth(f.elevate(0, 2)), random, "elevated", |p, k| value(&f, k, p));
        assert_is(&smooth(f.elevate(0, 1).and_then(|h| h.reduce(0))), random, "reduced", |p, k| value(&f, k, p));
        assert_is(&smooth(f.insert_knot(0, x, 1)), random, "inserted", |p, k| value(&f, k, p));
        assert_is(&smooth(f.insert_knot(0, x, 1).and_then(|h| h.remove_knot(0, x))), random, "removed", |p, k| value(&f, k, p));
        assert_is(&halves.1, random, "right", |p, k| value(&f, k, p));
        assert_is(&smooth(f.integral(0).and_then(|h| h.derivative(0))), random, "∂∫f", |p, k| value(&f, k, p));
        // Errors that come in go on: (f g)² with what f g was off by.
        let product = smooth(f.mul(&g));
        assert_is(&smooth(product.mul(&product)), random, "(f g)²", |p, k| {
            let v = value(&f, k, p) * value(&g, k, p);
            &v * &v
        });
    }

    #[test]
    fn enclosures(seed: u64) {
        let mut random = Random(seed);
        let f = spline(&mut random, 2, 3, 2);
        let f = f.mul(&f).expect("alike");
        let ranges = f.enclosure();
        for _ in 0..4 {
            let p = point(&mut random, &f);
            for (k, &(lo, hi)) in ranges.iter().enumerate() {
                let v = value(&f, k, &p);
                prop_assert!(exact(lo) <= v && v <= exact(hi));
            }
        }
    }
}

/// High degree in one variable, many variables of low degree.
#[test]
fn degree_eight_and_four_variables() {
    let mut random = Random(11);
    for _ in 0..6 {
        let of = |random: &mut Random| {
            let vector = knots(random, 8, 1);
            let count = vector.count();
            BSpline::new(vec![vector], 1, random.coefficients(count)).expect("a spline")
        };
        let (f, g) = (of(&mut random), of(&mut random));
        assert_is(&f.mul(&g).expect("alike"), &mut random, "f g", |p, k| {
            value(&f, k, p) * value(&g, k, p)
        });
        assert_is(&f.add(&g).expect("alike"), &mut random, "f + g", |p, k| {
            value(&f, k, p) + value(&g, k, p)
        });
        assert_is(&f.elevate(0, 2).expect("small"), &mut random, "elevated", |p, k| {
            value(&f, k, p)
        });
    }
    let (f, g) = (spline(&mut random, 4, 1, 1), spline(&mut random, 4, 1, 1));
    assert_is(&f.mul(&g).expect("alike"), &mut random, "f g", |p, k| {
        value(&f, k, p) * value(&g, k, p)
    });
    assert_is(&f.sub(&g).expect("alike"), &mut random, "f − g", |p, k| {
        value(&f, k, p) - value(&g, k, p)
    });
}

/// Values and derivatives of a periodic spline are the same at both ends, up to the last that is continuous.
#[test]
fn periodic_splines_close() {
    let mut random = Random(3);
    for degree in 1..6 {
        let vector = KnotVector::periodic(degree, &[0.0, 0.5, 1.25, 2.0, 4.0]).expect("knots");
        let closed = BSpline::periodic(vec![vector], 2, &random.coefficients(8)).expect("a spline");
        let scale = 1e-12 * (1.0 + closed.magnitude());
        let (start, end) = (
            closed.derivatives(&[0.0], degree - 1),
            closed.derivatives(&[4.0], degree - 1),
        );
        for r in 0..degree {
            let (a, b) = (start.get(&[r]).expect("low"), end.get(&[r]).expect("low"));
            assert!(
                a.iter()
                    .zip(b)
                    .all(|(x, y)| (x - y).abs() <= scale * 1e3f64.powi(r as i32)),
                "{a:?} {b:?}"
            );
        }
    }
}
