//! No public function panics, whatever numbers it is given; constructors say what was wrong.

use crate::common;

use common::Random;
use sweepsim_props::*;
use sweepsim_spline::{BSpline, Bernstein, BernsteinMap, KnotVector, RationalBernstein, RationalSpline};

/// Any number there is: not finite, huge, tiny, or quite ordinary.
fn anything(random: &mut Random) -> f64 {
    match random.below(14) {
        0 => f64::NAN,
        1 => f64::INFINITY,
        2 => f64::NEG_INFINITY,
        3 => 1e308,
        4 => -1e308,
        5 => 5e-324,
        6 => f64::from_bits(random.bits()),
        7 => 0.0,
        8 => 1.0,
        _ => random.between(-2.0, 2.0),
    }
}

fn list(random: &mut Random, most: usize) -> Vec<f64> {
    (0..random.below(most + 1)).map(|_| anything(random)).collect()
}

/// Finite, but of any size.
fn finite(random: &mut Random) -> f64 {
    let x = anything(random);
    if x.is_finite() { x } else { 0.5 }
}

fn form(random: &mut Random) -> Bernstein {
    let degrees: Vec<usize> = (0..random.below(4)).map(|_| random.below(4)).collect();
    let count = degrees.iter().map(|d| d + 1).product();
    let coefficients = (0..count).map(|_| finite(random)).collect();
    let form = Bernstein::new(&degrees, coefficients).expect("finite");
    // Sometimes one of which nothing is known.
    if random.below(8) == 0 {
        form.scale(f64::INFINITY)
    } else {
        form
    }
}

fn spline(random: &mut Random, dimension: usize) -> BSpline {
    let knots: Vec<KnotVector> = (0..random.below(4))
        .map(|_| {
            let degree = random.below(4);
            let mut list: Vec<f64> = (0..2 * degree + 2 + random.below(4)).map(|_| finite(random)).collect();
            list.sort_by(f64::total_cmp);
            KnotVector::new(degree, list).unwrap_or_else(|_| KnotVector::uniform(degree, 2, -1.0, 1.0).expect("knots"))
        })
        .collect();
    let count = knots.iter().map(KnotVector::count).product::<usize>() * dimension;
    BSpline::new(knots, dimension, (0..count).map(|_| finite(random)).collect()).expect("a spline")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(400), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forms(seed in any::<u64>()) {
        let random = &mut Random(seed);
        let (f, g) = (form(random), form(random));
        let (axis, x, y) = (random.below(5), anything(random), anything(random));
        let point = list(random, 5);
        let all = [
            f.add(&g), f.sub(&g), f.mul(&g), f.square(), f.scale(x), f.tensor_product(&g),
            f.elevate(axis, random.below(4)), f.elevate(usize::MAX, 1), f.elevate(0, usize::MAX),
            f.derivative(axis), f.integral(axis), f.integral(usize::MAX), f.reverse(axis),
            f.restrict(axis, x, y), f.restrict_box(&[(x, y), (y, x)]), f.slice(axis, x),
            f.substitute(axis, &g), f.lowest_degrees(), f.clone().assumed_exact(),
            Bernstein::linear(x, &point), Bernstein::constant(axis, x), Bernstein::variable(axis, axis / 2),
        ];
        for h in &all {
            let _ = (h.enclosure(), h.range(), h.tight_enclosure(3), h.elevated_enclosure(1), h.linear_bound());
            let _ = (h.zero_interval(axis), h.gradient_cone(), h.excludes_zero(), h.may_vanish(), h.mean());
            let _ = (h.evaluate(&point), h.evaluate_with_error(&point), h.hessian(&point).sum());
            let _ = (h.derivatives(&point, 3), h.reduce(axis), h.split(axis, x), h.gradient(), h.to_string());
            let (mut values, mut gradients) = (vec![0.0; 3], vec![0.0; 7]);
            h.evaluate_gradient(&point, &mut gradients);
            h.gradient_errors(&point, &mut gradients);
            h.evaluate_gradient_batch(&point, &mut values, &mut gradients);
            h.evaluate_batch(&point, &mut values);
            let (mut right, mut left) = (h.clone(), g.clone());
            right.split_into(axis, x, &mut left);
            // A bound is never NaN, and a form with a coefficient that is not finite is known to be unknown.
            prop_assert!(h.error() >= 0.0);
            prop_assert!(h.magnitude().is_finite() || h.error() == f64::INFINITY);
            prop_assert!(right.magnitude().is_finite() || right.error() == f64::INFINITY);
        }
        let _ = (f.compose(&[g.clone(), f.clone()]), f.compose(&vec![g.clone(); f.variables()]));
        let _ = (f.compose_affine(&[(point.clone(), x)]), f.extend(axis, &[1, 0]), f.extend(usize::MAX, &[]));
        let _ = f.restrict_to_hyperplane(axis, &point, x);
        let _ = Bernstein::with_error(&[axis, 2], list(random, 9), x);
        let _ = Bernstein::new(&[usize::MAX, 3], vec![]);
        let map = BernsteinMap::new(all[..random.below(4)].to_vec());
        let other = BernsteinMap::new(vec![g.clone(), f.clone(), g.clone()]);
        let _ = (map.cone(), map.normal_cone(), map.excludes_zero(), map.enclosure(), map.jacobian(&point).sum());
        let _ = (map.add(&other), map.sub(&map), map.dot(&map), map.cross(&other), map.component_product(&map));
        let _ = (map.square_norm(), map.jacobian_determinant(), map.derivatives(&point, 2), map.to_string());
        let _ = (map.compose(&other), map.transform(&[(point.clone(), x)]), map.split(axis, x), map.slice(axis, x));
        let _ = (BernsteinMap::determinant(&[other.clone(), map.clone(), other.clone()]), BernsteinMap::determinant(&[]));
        let _ = BernsteinMap::from_points(&[axis, 1], random.below(3), &point);
        let _ = RationalBernstein::arc(x, y);
        if let Ok(map) = RationalBernstein::new(vec![f.clone(), g.clone()], g.square().add(&Bernstein::constant(0, 1.0))) {
            let _ = (map.evaluate(&point), map.derivative(axis), map.derivatives(&point, 2), map.enclosure());
            let _ = (map.add(&map), map.dot(&map), map.cross(&map), map.split(axis, x), map.slice(axis, y), map.to_string());
        }
    }

    #[test]
    fn splines(seed in any::<u64>()) {
        let random = &mut Random(seed);
        let dimension = 1 + random.below(3);
        let (f, g) = (spline(random, dimension), spline(random, dimension));
        let (axis, x, y) = (random.below(4), anything(random), anything(random));
        let point = list(random, 5);
        // Half of the time somewhere in the domain.
        let x = match f.domain().get(axis) {
            Some(&(lo, hi)) if random.below(2) == 0 => lo + (hi - lo) * random.unit(),
            _ => x,
        };
        let mut values = vec![0.0; 4];
        let _ = (f.evaluate(&point), f.evaluate_with_error(&point), f.jacobian(&point).sum());
        let _ = (f.derivatives(&point, 3), f.hessian(axis, &point).sum(), f.to_string(), f.enclosure());
        let _ = (f.evaluate_batch(&point, &mut values), f.evaluate_jacobian_batch(&point, &mut values, &mut [0.0; 5]));
        let results = [
            f.add(&g), f.sub(&f), f.mul(&f), f.mul(&g), f.dot(&f), f.cross(&f), f.square_norm(), f.tensor_product(&g),
            f.insert_knot(axis, x, random.below(4)), f.refine(axis, &point), f.remove_knot(axis, x),
            f.insert_knot(axis, x, 1).and_then(|s| s.remove_knot(axis, x)),
            f.elevate(axis, random.below(3)), f.elevate(axis, usize::MAX), f.reduce(axis), f.open(axis),
            f.derivative(axis), f.integral(axis), f.restrict(axis, x, y), f.restrict_box(&[(x, y)]),
            f.split(axis, x).map(|s| s.0), f.split(axis, x).and_then(|s| s.0.join(&s.1, axis)), f.join(&g, axis),
            f.slice(axis, x), f.face(axis, true), f.reverse(axis), f.reparametrise(axis, x, y), f.permute(&[1, 0]),
            f.component(axis), f.transform(&[(point.clone(), x), (vec![y; dimension], x)]), Ok(f.scale(y)),
            BSpline::stack(&[f.clone(), g.clone()]), BSpline::determinant(&[f.clone(), g.clone(), f.clone()]),
            f.jacobian_determinant(), f.ruled(&f), f.extrude(&point), BSpline::line(&point, &point),
            BSpline::plane(&point, &point, &[x, y]), f.with_knots(axis, &KnotVector::uniform(3, 3, -1.0, 1.0).expect("knots")),
            f.remove_knot_within(axis, x, y).map(|r| r.0),
        ];
        for h in results.iter().flatten() {
            prop_assert!(h.error() >= 0.0);
            prop_assert!(h.magnitude().is_finite() || h.error() == f64::INFINITY);
            let _ = (h.evaluate(&point), h.cone());
        }
        let _ = (f.integral_over_domain(), f.gradient_cone(), f.normal_cone(), f.first_derivatives());
        if let Ok(pieces) = f.pieces() {
            let maps: Vec<BernsteinMap> = pieces.iter().map(|p| p.map.clone()).collect();
            let _ = (BSpline::from_pieces(f.knots().to_vec(), &maps), BSpline::from_pieces(f.knots().to_vec(), &maps[1..]));
            if let Some(piece) = pieces.first() {
                let _ = (BSpline::from_bernstein(&piece.map, &piece.ranges), BSpline::from_bernstein(&piece.map, &[(x, y)]));
                let _ = (piece.local(&point), f.compose(&piece.map));
            }
        }
        if let Ok(rational) = RationalSpline::from_polynomial(&f) {
            let _ = (rational.evaluate(&point), rational.evaluate_with_error(&point), rational.derivatives(&point, 2));
            let _ = (rational.add(&rational), rational.derivative(axis), rational.normal(), rational.pieces(), rational.enclosure());
            let _ = (rational.revolve([x, y, 0.0], [y, 0.0, x], y), rational.extrude(&point), rational.to_string());
        }
    }

    #[test]
    fn constructors(seed in any::<u64>()) {
        let random = &mut Random(seed);
        let degree = random.below(5);
        let mut numbers = list(random, 14);
        let _ = KnotVector::new(degree, numbers.clone());
        numbers.sort_by(f64::total_cmp);
        for knots in [
            KnotVector::new(degree, numbers.clone()),
            KnotVector::open(degree, &numbers),
            KnotVector::periodic(degree, &numbers),
            KnotVector::uniform(degree, random.below(5), anything(random), anything(random)),
            KnotVector::new(usize::MAX, numbers.clone()),
        ]
        .into_iter()
        .flatten()
        {
            let x = anything(random);
            let _ = (knots.span(x), knots.basis(x), knots.basis_derivatives(x, 3), knots.wrap(x), knots.kind());
            let _ = (knots.greville(), knots.breakpoints(), knots.to_string(), knots.mapped(x, anything(random)), knots.reversed());
            let dimension = random.below(3);
            let data = list(random, 20);
            let _ = BSpline::new(vec![knots.clone()], dimension, data.clone());
            let _ = BSpline::periodic(vec![knots.clone()], dimension, &data);
            let _ = BSpline::with_error(vec![knots.clone()], 1, vec![0.0; knots.count()], x);
            let _ = BSpline::interpolate(vec![knots.clone()], &[knots.greville()], 1, &vec![0.5; knots.count()]);
            let _ = BSpline::approximate(vec![knots.clone()], std::slice::from_ref(&data), 1, &data);
            let _ = BSpline::interpolate_function(vec![knots.clone()], 1, |p, y| y[0] = p[0] * x);
            let _ = RationalSpline::new(vec![knots.clone()], dimension, &data, &list(random, 8));
            let _ = RationalSpline::new(vec![knots.clone()], 1, &vec![1.0; knots.count()], &vec![x; knots.count()]);
        }
        let points: Vec<[f64; 2]> = (0..random.below(6)).map(|_| [anything(random), anything(random)]).collect();
        let _ = BSpline::curve_through(&points, degree);
        let (x, y) = (anything(random), anything(random));
        let _ = (RationalSpline::circle([x, y], anything(random)), RationalSpline::arc(&[x], &[y], &[1.0], x, y));
        let _ = RationalSpline::arc(&[0.0], &[1.0], &[1.0], x, anything(random));
    }
}
