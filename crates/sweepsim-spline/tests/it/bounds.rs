//! Enclosures, cones and linear bounds hold exactly, for random forms and any point.

use crate::common;

use common::{Exact, Random, exact};
use dashu_ratio::RBig;
use sweepsim_props::*;
use sweepsim_spline::{Bernstein, BernsteinMap, Cone};

/// Whether the exact vector is in the cone: `|v|²|a|² − (v·a)² ≤ τ² (v·a)²` and `v·a ≥ 0`.
fn contains(cone: &Cone, vector: &[RBig]) -> bool {
    let axis: Vec<RBig> = cone.axis().iter().map(|&a| exact(a)).collect();
    let dot = |a: &[RBig], b: &[RBig]| a.iter().zip(b).fold(RBig::ZERO, |sum, (x, y)| sum + x * y);
    let along = dot(vector, &axis);
    let square = &along * &along;
    let tangent = exact(cone.tangent());
    along >= RBig::ZERO && dot(vector, vector) * dot(&axis, &axis) - &square <= &tangent * &tangent * square
}

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn ranges(seed in any::<u64>()) {
        let mut random = Random(seed);
        let f = random.form(120);
        let e = Exact::from(&f);
        let whole = f.enclosure();
        let tight = f.tight_enclosure(12);
        let elevated = f.elevated_enclosure(2);
        prop_assert!(tight.0 >= whole.0 && tight.1 <= whole.1 && elevated.0 >= whole.0 && elevated.1 <= whole.1);
        for _ in 0..4 {
            let v = e.value(&random.point(f.variables()));
            for (lo, hi) in [whole, tight, elevated] {
                prop_assert!(exact(lo) <= v && v <= exact(hi));
            }
        }
    }

    #[test]
    fn zero_intervals(seed in any::<u64>()) {
        let mut random = Random(seed);
        let f = random.form(60);
        // Made to vanish at a known place.
        let p = random.point(f.variables());
        let at = Exact::from(&f).value(&p).to_f64().value();
        let g = f.sub(&Bernstein::constant(f.variables(), at));
        // The constant was rounded.
        let more = g.error() + f64::EPSILON * at.abs() + f64::MIN_POSITIVE;
        let g = Bernstein::with_error(g.degrees(), g.coefficients().to_vec(), more).expect("finite");
        for (axis, &x) in p.iter().enumerate() {
            let (lo, hi) = g.zero_interval(axis).expect("it has a zero");
            prop_assert!(lo <= x && x <= hi, "{} not in [{}, {}]", x, lo, hi);
        }
    }

    #[test]
    fn linear_bounds(seed in any::<u64>()) {
        let mut random = Random(seed);
        let f = random.form(120);
        let bound = f.linear_bound();
        let e = Exact::from(&f);
        for _ in 0..4 {
            let p = random.point(f.variables());
            let mut line = exact(bound.constant);
            for (s, x) in bound.slopes.iter().zip(&p) {
                line += exact(*s) * exact(*x);
            }
            let rest = e.value(&p) - line;
            prop_assert!(exact(bound.lower) <= rest && rest <= exact(bound.upper));
        }
    }

    #[test]
    fn cones(seed in any::<u64>()) {
        let mut random = Random(seed);
        let n = 1 + random.below(3);
        let wide = [1e-14, 1e-6, 0.1, 1.0][random.below(4)];
        let centre: Vec<f64> = (0..3).map(|_| random.between(-1.0, 1.0)).collect();
        let components: Vec<Bernstein> = centre
            .iter()
            .map(|&c| {
                let degrees: Vec<usize> = (0..n).map(|_| random.below(4)).collect();
                let count = degrees.iter().map(|d| d + 1).product();
                let coefficients = (0..count).map(|_| c + wide * random.between(-1.0, 1.0)).collect();
                Bernstein::new(&degrees, coefficients).expect("a form")
            })
            .collect();
        let map = BernsteinMap::new(components);
        let cone = map.cone().ok_or_else(|| TestCaseError::reject("no cone"))?;
        prop_assert!(cone.angle() < 1.5707964);
        let exacts: Vec<Exact> = map.components().iter().map(Exact::from).collect();
        for _ in 0..4 {
            let p = random.point(n);
            let v: Vec<RBig> = exacts.iter().map(|e| e.value(&p)).collect();
            prop_assert!(contains(&cone, &v));
        }
    }

    #[test]
    fn gradient_and_normal_cones(seed in any::<u64>()) {
        let mut random = Random(seed);
        // Nearly linear, so that there is a cone.
        let noise = random.form_of(&[2, 3]);
        let size = noise.magnitude().max(1e-300);
        let f = Bernstein::linear(0.0, &[1.0, -2.0]).add(&noise.scale(0.05 / size));
        let f = f.assumed_exact();
        let cone = f.gradient_cone();
        let e = Exact::from(&f);
        let (u, v) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1));
        let surface = BernsteinMap::new(vec![u, v, f.clone()]);
        let normals = surface.normal_cone().expect("a surface in space");
        for _ in 0..3 {
            let p = random.point(2);
            let (fu, fv) = (e.derivative(0).value(&p), e.derivative(1).value(&p));
            if let Some(normals) = &normals {
                prop_assert!(contains(normals, &[-fu.clone(), -fv.clone(), RBig::ONE]));
            }
            if let Some(cone) = &cone {
                prop_assert!(contains(cone, &[fu, fv]));
            }
        }
        // The normal is perpendicular to both tangents, identically up to its error bound.
        let normal = surface.derivative(0).cross(&surface.derivative(1)).expect("in space");
        for axis in 0..2 {
            prop_assert!(normal.dot(&surface.derivative(axis)).expect("in space").may_vanish());
        }
    }
}

#[test]
fn cones_of_opposite_directions_are_not_acute() {
    let cone = |x: f64, y: f64| {
        BernsteinMap::new(vec![Bernstein::constant(1, x), Bernstein::constant(1, y)])
            .cone()
            .expect("one direction")
    };
    assert!(cone(1.0, 0.0).is_acute_with(&cone(1.0, 0.5)));
    assert!(!cone(1.0, 0.0).is_acute_with(&cone(-1.0, 0.5)));
    assert!(!cone(1.0, 0.0).is_acute_with(&cone(0.0, 1.0)));
}
