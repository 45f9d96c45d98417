//! What operators and functions give.
//!
//! Source: Siemens, *Job planning, Programming Manual*, 03/2006 (6FC5398-2BP10-1BA0), 1.7 Comparison and logical operations.

use crate::text::error::NcProblem;

/// Whether two numbers are the same to comparisons: within 1e-12 of their size. So are those of `<` and `>`, unless a machine says otherwise.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}

pub(super) fn binary(operator: &str, a: f64, b: f64) -> Result<f64, NcProblem> {
    if matches!(operator, "/" | "DIV" | "MOD") && b == 0.0 {
        return Err(NcProblem::syntax("a division by 0"));
    }
    // Bits of whole numbers of at most 32 bits, as the control has them.
    let bits = |value: f64| value as i32;
    Ok(match operator {
        "+" => a + b,
        "-" => a - b,
        "*" => a * b,
        "/" => a / b,
        "DIV" => (a / b).trunc(),
        "MOD" => a % b,
        "==" => f64::from(same(a, b)),
        "<>" => f64::from(!same(a, b)),
        "<" => f64::from(a < b && !same(a, b)),
        ">" => f64::from(a > b && !same(a, b)),
        "<=" => f64::from(a <= b || same(a, b)),
        ">=" => f64::from(a >= b || same(a, b)),
        "AND" => f64::from(a != 0.0 && b != 0.0),
        "OR" => f64::from(a != 0.0 || b != 0.0),
        "XOR" => f64::from((a != 0.0) != (b != 0.0)),
        "B_AND" => f64::from(bits(a) & bits(b)),
        "B_OR" => f64::from(bits(a) | bits(b)),
        _ => f64::from(bits(a) ^ bits(b)),
    })
}

pub(super) fn function(name: &str, values: &[f64]) -> Result<f64, NcProblem> {
    Ok(match (name, values) {
        ("SIN", [x]) => x.to_radians().sin(),
        ("COS", [x]) => x.to_radians().cos(),
        ("TAN", [x]) => x.to_radians().tan(),
        ("ASIN", [x]) if x.abs() <= 1.0 => x.asin().to_degrees(),
        ("ACOS", [x]) if x.abs() <= 1.0 => x.acos().to_degrees(),
        // 0 has no sign.
        ("ATAN2", [y, x]) => (y + 0.0).atan2(*x).to_degrees(),
        ("SQRT", [x]) if *x >= 0.0 => x.sqrt(),
        ("POT", [x]) => x * x,
        ("ABS", [x]) => x.abs(),
        ("TRUNC", [x]) => x.trunc(),
        ("ROUND", [x]) => x.round(),
        ("ROUNDUP", [x]) => x.ceil(),
        ("LN", [x]) if *x > 0.0 => x.ln(),
        ("EXP", [x]) => x.exp(),
        ("MINVAL", [a, b]) => a.min(*b),
        ("MAXVAL", [a, b]) => a.max(*b),
        ("BOUND", [low, high, x]) => x.max(*low).min(*high),
        _ => {
            let arguments: Vec<String> = values.iter().map(f64::to_string).collect();
            return Err(NcProblem::value(
                "this function",
                format!("{name}({})", arguments.join(", ")),
                "one that is known, with arguments in its range",
            ));
        }
    })
}
