//! Tests of the models against the operations that they stand for.

use super::functions::Function;
use super::models::*;
use super::range::Range;
use super::tape::Model;
use crate::numbers::MAX_UNKNOWNS;

/// SplitMix64, to numbers in −1 … 1.
fn numbers(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn operate<M: Model>(operation: usize, a: M, b: M) -> M {
    match operation {
        0 => a.add(b),
        1 => a.multiply(b),
        _ => a.divide(b),
    }
}

#[test]
fn models_enclose_what_they_stand_for() {
    let mut next = numbers(1);
    let mut bounded = 0;
    for case in 0..3_000 {
        let mut form = || {
            let mut slope = [0.0; MAX_UNKNOWNS];
            slope[0] = next();
            slope[1] = 0.3 * next();
            AffineForm {
                constant: 3.0 * next(),
                slope,
                radius: 0.1 * next().abs(),
            }
        };
        let forms = [form(), form()];
        let operation = case % 3;
        let result = operate(operation, forms[0], forms[1]);
        if !result.radius.is_finite() {
            assert_eq!(operation, 2);
            continue;
        }
        bounded += 1;
        let ranges = forms.map(|f| {
            let reach = f.reach() + f.radius;
            Range::outward(f.constant - reach, f.constant + reach)
        });
        let range = operate(operation, ranges[0], ranges[1]);
        for _ in 0..20 {
            let z = [0.5 * next(), 0.5 * next()];
            let mut at = |f: &AffineForm| f.constant + f.slope[0] * z[0] + f.slope[1] * z[1] + f.radius * next();
            let (a, b) = (at(&forms[0]), at(&forms[1]));
            let truth = [a + b, a * b, a / b][operation];
            let middle = result.constant + result.slope[0] * z[0] + result.slope[1] * z[1];
            assert!((truth - middle).abs() <= result.radius, "{case}: {forms:?} {a} {b}");
            assert!(range.lo <= truth && truth <= range.hi, "{case}");
        }
    }
    assert!(bounded > 2_000, "{bounded}");
}

#[test]
fn a_quotient_with_a_divisor_that_may_vanish_is_unbounded() {
    let one = AffineForm::constant(1.0);
    let mut through = AffineForm::constant(0.2);
    through.slope[0] = 1.0;
    assert!(one.divide(through).radius.is_infinite());
    let range = Range::constant(1.0).divide(Range { lo: -0.3, hi: 0.7 });
    assert!(range.hi < -3.33 && range.hi > -3.34 && range.lo > 1.42 && range.lo < 1.43);
    let doubt = Doubt {
        range: Range { lo: 0.1, hi: 0.2 },
        error: 0.2,
    };
    assert!(Doubt::constant(1.0).divide(doubt).error.is_infinite());
}

#[test]
fn derivatives_follow_the_rules() {
    let jet = |value: f64, slope: f64| {
        let mut jet = Jet::constant(value);
        jet.slopes[0] = Range::constant(slope);
        jet
    };
    let point = |value: f64, slope: f64| {
        let mut point = Value::constant(value);
        point.gradient[0] = slope;
        point
    };
    // f = 3, f' = 2, g = −4, g' = 5: (fg)' = 15 − 8, (f/g)' = (2·(−4) − 3·5)/16.
    for (operation, slope) in [(0, 7.0), (1, 7.0), (2, -23.0 / 16.0)] {
        let found = operate(operation, jet(3.0, 2.0), jet(-4.0, 5.0)).slopes[0];
        assert!(found.lo <= slope && slope <= found.hi && found.hi - found.lo < 1e-13);
        let value = operate(operation, point(3.0, 2.0), point(-4.0, 5.0));
        assert!((value.gradient[0] - slope).abs() < 1e-14);
    }
}

#[test]
fn models_of_functions_enclose_them() {
    type Example = (Function, fn(f64) -> f64);
    let functions: [Example; 9] = [
        (Function::Sine, f64::sin),
        (Function::Cosine, f64::cos),
        (Function::Tangent, f64::tan),
        (Function::Exponential, f64::exp),
        (Function::Logarithm, f64::ln),
        (Function::SquareRoot, f64::sqrt),
        (Function::ArcTangent, f64::atan),
        (Function::Power(2), |x| x * x),
        (Function::Power(5), |x| x.powi(5)),
    ];
    let mut next = numbers(2);
    let (mut bounded, mut curved) = (0, 0);
    for case in 0..20_000 {
        let (function, truth) = functions[case % functions.len()];
        let size = 10f64.powf(3.0 * next());
        let mut slope = [0.0; MAX_UNKNOWNS];
        slope[0] = size * next();
        slope[1] = 0.3 * size * next();
        let form = AffineForm {
            constant: 8.0 * next(),
            slope,
            radius: 0.1 * size * next().abs(),
        };
        let reach = (form.reach() + form.radius) * (1.0 + 1e-15);
        let argument = Range {
            lo: form.constant - reach,
            hi: form.constant + reach,
        };
        let (model, range) = (form.apply(function), argument.apply(function));
        let (first, second) = (function.slope(argument), function.curvature(argument));
        bounded += usize::from(model.radius.is_finite());
        for _ in 0..10 {
            let z = [0.5 * next(), 0.5 * next()];
            let x = form.constant + slope[0] * z[0] + slope[1] * z[1] + form.radius * next();
            let y = truth(x);
            if y.is_nan() {
                continue;
            }
            let within = |r: Range, y: f64| {
                if r.lo <= r.hi {
                    r.lo <= y && y <= r.hi
                } else {
                    y <= r.hi || y >= r.lo
                }
            };
            assert!(within(range, y), "{function:?} {argument:?} {range:?} {x} {y}");
            let middle = model.constant + model.slope[0] * z[0] + model.slope[1] * z[1];
            assert!((y - middle).abs() <= model.radius, "{function:?} {form:?} {x} {y}");
            // Difference quotients, in quadruple of the step's error.
            let h = 1e-4 * x.abs().max(1e-2);
            if within(argument, x - h) && within(argument, x + h) && first != Range::WHOLE {
                let quotient = (truth(x + h) - truth(x - h)) / (2.0 * h);
                let doubt = 1e-5 * (1.0 + first.magnitude());
                let padded = Range {
                    lo: first.lo - doubt,
                    hi: first.hi + doubt,
                };
                assert!(
                    within(padded, quotient),
                    "{function:?} {argument:?} {first:?} {quotient}"
                );
            }
            if within(argument, x - h) && within(argument, x + h) && second != Range::WHOLE {
                curved += 1;
                let quotient = (truth(x + h) - 2.0 * y + truth(x - h)) / (h * h);
                let doubt = 1e-3 * (1.0 + second.magnitude()) + 1e-15 * y.abs() / (h * h);
                let padded = Range {
                    lo: second.lo - doubt,
                    hi: second.hi + doubt,
                };
                assert!(
                    within(padded, quotient),
                    "{function:?} {argument:?} {second:?} {quotient}"
                );
            }
        }
    }
    assert!(bounded > 15_000 && curved > 50_000, "{bounded} {curved}");
}

#[test]
fn computed_values_of_functions_are_within_their_errors() {
    let functions = [
        Function::Sine,
        Function::Cosine,
        Function::Tangent,
        Function::Exponential,
        Function::Logarithm,
        Function::SquareRoot,
        Function::ArcTangent,
        Function::Power(7),
    ];
    let mut next = numbers(3);
    for case in 0..4_000 {
        let function = functions[case % functions.len()];
        let (x, error) = (4.0 * next(), 0.01 * next().abs());
        let doubt = Doubt {
            range: Range::constant(x),
            error,
        }
        .apply(function);
        let truth = function.value(x);
        if truth.is_nan() {
            continue;
        }
        let computed = function.value(x + error * next());
        assert!(!((computed - truth).abs() > doubt.error), "{function:?} {x} {error}");
    }
}

#[test]
fn ranges_beyond_a_pole_keep_their_gap() {
    // 1/[−1, 2] + 1, times −3: beyond −3·(−1 … 1.5).
    let around = Range { lo: -1.0, hi: 2.0 };
    let gap = Range::constant(1.0).divide(around);
    let moved = gap.add(Range::constant(1.0)).multiply(Range::constant(-3.0));
    assert!(moved.lo < 0.0 && moved.lo > -1e-12 && moved.hi < -4.5 + 1e-12 && moved.hi >= -4.5);
    assert!(!moved.misses_zero());
    let missed = gap.add(Range::constant(0.25)).multiply(Range { lo: 1.0, hi: 100.0 });
    assert!(missed.misses_zero());
    // Products and sums of two of them tell nothing, nor do factors around zero.
    assert_eq!(gap.add(gap), Range::WHOLE);
    assert_eq!(gap.multiply(around), Range::WHOLE);
    // Half-lines, and nothing at all.
    let half = Range::constant(1.0).divide(Range { lo: 0.0, hi: 4.0 });
    assert!(half.lo < 0.25 && half.lo > 0.2499 && half.add(Range::constant(-0.2)).misses_zero());
    let nowhere = Range { lo: -2.0, hi: -1.0 }.apply(Function::SquareRoot);
    assert!(nowhere.empty() && nowhere.add(gap).empty() && Range::constant(0.0).multiply(nowhere).empty());
}
