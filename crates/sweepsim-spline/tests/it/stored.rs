//! What is stored comes back, and what is not a form does not.
#![cfg(feature = "serde")]

use sweepsim_spline::{
    BSpline, Bernstein, BernsteinMap, Cone, KnotVector, LinearBound, RationalBernstein, RationalSpline,
};

fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug>(value: &T) {
    let text = ron::ser::to_string_pretty(value, ron::ser::PrettyConfig::default()).expect("stored");
    let back: T = ron::from_str(&text).expect("read again");
    assert_eq!(&back, value, "{text}");
}

#[test]
fn everything_comes_back() {
    let form = Bernstein::new(&[2, 1], vec![0.1, -2.0, 1e-300, 4.0, 1.0 / 3.0, 6.0]).expect("a form");
    let form = form.mul(&form);
    round_trip(&form);
    round_trip(&BernsteinMap::new(vec![form.clone(), form.derivative(0)]));
    round_trip(&RationalBernstein::arc(0.1, 1.0).expect("an arc"));
    let knots = KnotVector::open(2, &[0.0, 0.1, 0.7]).expect("knots");
    round_trip(&knots);
    round_trip(&BSpline::new(vec![knots], 1, vec![1.0, 0.1, 2.0, 3.0]).expect("a spline"));
    round_trip(&RationalSpline::circle([1.0, 2.0], 3.0).expect("a circle"));
    let cone: Option<Cone> = Bernstein::linear(0.0, &[1.0, 2.0]).gradient_cone();
    round_trip(&cone);
    let bound: LinearBound = form.linear_bound();
    round_trip(&bound);
}

#[test]
fn fixtures() {
    let read = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/fixtures")
            .join(name);
        std::fs::read_to_string(path).expect("a fixture")
    };
    let surface: BSpline = ron::from_str(&read("saddle.ron")).expect("a spline");
    assert_eq!(surface.evaluate(&[0.5, 1.0]), [0.5, 1.0, 0.5]);
    let arc: RationalSpline = ron::from_str(&read("quarter.ron")).expect("an arc");
    let p = arc.evaluate(&[0.5]);
    assert!((p[0].hypot(p[1]) - 1.0).abs() < 1e-15);
    let bad = ron::from_str::<BSpline>(&read("bad-knots.ron")).expect_err("descending knots");
    assert!(bad.to_string().contains("knot 2"), "{bad}");
}

#[test]
fn bad_input_says_what_is_wrong() {
    for (text, why) in [
        ("(degree: 1, knots: [0.0, 0.0, NaN, 1.0])", "knot 2"),
        ("(degree: 1, knots: [0.0, 1.0])", "at least 4"),
        ("(degree: 1, knots: [0.0, 0.0, 0.0, 1.0])", "more than 2 times"),
    ] {
        let error = ron::from_str::<KnotVector>(text).expect_err("not a knot vector");
        assert!(error.to_string().contains(why), "{error}");
    }
    let error = ron::from_str::<Bernstein>("(degrees: [2], coefficients: [1.0])").expect_err("too few");
    assert!(error.to_string().contains("need 3"), "{error}");
    let weight = "(numerators: [], weight: (degrees: [0], coefficients: [0.0]))";
    let error = ron::from_str::<RationalBernstein>(weight).expect_err("weight 0");
    assert!(error.to_string().contains("weight 0"), "{error}");
}

#[test]
fn what_a_person_reads() {
    let knots = KnotVector::open(2, &[0.0, 0.5, 1.0]).expect("knots");
    assert_eq!(knots.to_string(), "degree 2, open: 0×3 0.5 1×3");
    let line = BSpline::line(&[0.0, 1.0], &[2.0, 3.0]).expect("a line");
    assert_eq!(
        line.to_string(),
        "B-spline R^1 → R^2\n  knots 0: degree 1, open: 0×2 1×2\n  0 1\n  2 3"
    );
    let form = Bernstein::new(&[1, 1], vec![0.0, 1.0, 2.0, 3.5]).expect("a form");
    assert_eq!(form.to_string(), "Bernstein form of degree [1, 1]\n  0 1\n  2 3.5");
}
