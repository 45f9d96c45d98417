//! Operators and functions of expressions.

use crate::text::error::NcProblem;

/// A value: `None` is that of a variable without one, on controls that know such (Fanuc's `#0`).
pub(crate) type Value = Option<f64>;

/// Numbers closer than this are equal to `EQ` and `NE`, as on LinuxCNC.
const EQUAL: f64 = 1e-6;

/// What stands between two values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operator {
    Power,
    Times,
    Over,
    Modulo,
    Plus,
    Minus,
    And,
    Or,
    Xor,
    Equal,
    Different,
    Greater,
    AtLeast,
    Less,
    AtMost,
}

impl Operator {
    /// Operators with larger numbers bind tighter.
    pub(crate) fn precedence(self, fanuc: bool) -> u8 {
        match self {
            Self::Power => 6,
            Self::Times | Self::Over | Self::Modulo => 5,
            Self::Plus | Self::Minus => 4,
            Self::And if fanuc => 5,
            Self::Or | Self::Xor if fanuc => 4,
            Self::And | Self::Or | Self::Xor => 2,
            _ => 3,
        }
    }
}

/// `left operator right`.
pub(crate) fn apply(operator: Operator, left: Value, right: Value, fanuc: bool) -> Result<Value, NcProblem> {
    let vacant = (left.is_none(), right.is_none());
    let (a, b) = (left.unwrap_or(0.0), right.unwrap_or(0.0));
    let truth = |yes: bool| if yes { 1.0 } else { 0.0 };
    let equal = match vacant {
        (true, true) => true,
        (false, false) => (a - b).abs() < EQUAL,
        _ => false,
    };
    let bits = |f: fn(i64, i64) -> i64| f(a.round() as i64, b.round() as i64) as f64;
    let result = match operator {
        Operator::Power if a < 0.0 && b.fract() != 0.0 => {
            return Err(NcProblem::syntax(format!(
                "a negative number to a power that is not whole: {a} ** {b}"
            )));
        }
        Operator::Power => a.powf(b),
        Operator::Times => a * b,
        Operator::Over | Operator::Modulo if b == 0.0 => {
            return Err(NcProblem::syntax("this divides by zero"));
        }
        Operator::Over => a / b,
        // Always positive, as on LinuxCNC.
        Operator::Modulo if fanuc => a % b,
        Operator::Modulo => a.rem_euclid(b),
        Operator::Plus => a + b,
        Operator::Minus => a - b,
        Operator::And if fanuc => bits(|a, b| a & b),
        Operator::Or if fanuc => bits(|a, b| a | b),
        Operator::Xor if fanuc => bits(|a, b| a ^ b),
        Operator::And => truth(a != 0.0 && b != 0.0),
        Operator::Or => truth(a != 0.0 || b != 0.0),
        Operator::Xor => truth((a != 0.0) != (b != 0.0)),
        Operator::Equal => truth(equal),
        Operator::Different => truth(!equal),
        Operator::Greater => truth(a > b),
        Operator::AtLeast => truth(a >= b),
        Operator::Less => truth(a < b),
        Operator::AtMost => truth(a <= b),
    };
    finite(result).map(Some)
}

/// `name[a]`, or `name[a]/[b]`.
pub(crate) fn call(name: &str, a: f64, b: Option<f64>, fanuc: bool) -> Result<f64, NcProblem> {
    let domain = |inside: bool| {
        if inside {
            Ok(())
        } else {
            Err(NcProblem::syntax(format!("{name} of {a} has no value")))
        }
    };
    let result = match (name, b) {
        ("SIN", _) => a.to_radians().sin(),
        ("COS", _) => a.to_radians().cos(),
        ("TAN", _) => a.to_radians().tan(),
        ("ASIN", _) => {
            domain((-1.0..=1.0).contains(&a))?;
            a.asin().to_degrees()
        }
        ("ACOS", _) => {
            domain((-1.0..=1.0).contains(&a))?;
            a.acos().to_degrees()
        }
        // From 0 to 360, as bit 0 of parameter 6004 has it unless it is set.
        ("ATAN", Some(b)) => match a.atan2(b).to_degrees() {
            angle if angle < 0.0 && fanuc => angle + 360.0,
            angle => angle,
        },
        ("ATAN", None) if fanuc => a.atan().to_degrees(),
        ("ATAN" | "POW", None) => {
            return Err(NcProblem::syntax(format!(
                "{name} has one argument: expected two, {name}[a]/[b]"
            )));
        }
        ("POW", Some(b)) => return apply(Operator::Power, Some(a), Some(b), fanuc).map(|value| value.unwrap_or(0.0)),
        ("SQRT" | "SQR", _) => {
            domain(a >= 0.0)?;
            a.sqrt()
        }
        ("ABS", _) => a.abs(),
        ("EXP", _) => a.exp(),
        ("LN", _) => {
            domain(a > 0.0)?;
            a.ln()
        }
        ("ROUND" | "RND", _) => (a + 0.5 * a.signum()).trunc(),
        ("FIX", _) if fanuc => a.trunc(),
        ("FUP", _) if fanuc => a.abs().ceil() * a.signum(),
        ("FIX", _) => a.floor(),
        ("FUP", _) => a.ceil(),
        _ => {
            return Err(NcProblem::unsupported(
                format!("the function {name} is"),
                "expected one of ABS, ACOS, ASIN, ATAN, COS, EXISTS, EXP, FIX, FUP, LN, POW, ROUND, SIN, SQRT, TAN",
            ));
        }
    };
    finite(result)
}

fn finite(value: f64) -> Result<f64, NcProblem> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(NcProblem::syntax("the result of this expression is too large"))
    }
}
