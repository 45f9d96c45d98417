//! Splitting, joining, slicing, extending, composing B-splines, against exact rational arithmetic.

use crate::common;

use common::splines::{assert_is, spline, value};
use common::{Exact, Random, within};
use sweepsim_props::*;
use sweepsim_spline::{BSpline, Bernstein, BernsteinMap, KnotVector, SplineError};

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn domains(seed in any::<u64>()) {
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
    fn composition(seed in any::<u64>()) {
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
    fn uneven_knots(seed in any::<u64>()) {
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
}
