//! Numbers, Q parameters and FN functions.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::formula;
use super::line::Line;
use crate::text::error::{Located, NcProblem};

/// The most Q parameters.
const MOST: usize = 100_000;

/// What an FN asks for besides a value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::controls::heidenhain) enum Jump {
    None,
    /// To a label.
    To(String),
    /// A parameter gets what only the control knows: its name, and what that is.
    Read(String, String),
    /// An error of the program, with its number: it ends here.
    Stop(String),
    /// Something that moves nothing, by its number.
    Ignored(u32),
}

/// Q parameters.
#[derive(Clone, Debug, Default)]
pub(in crate::controls::heidenhain) struct Parameters {
    values: BTreeMap<String, f64>,
    /// Whether those that nothing sets are an error: else they are 0, and asked for.
    strict: bool,
    asked: RefCell<BTreeSet<String>>,
}

impl Parameters {
    pub fn new(strict: bool) -> Self {
        Self {
            strict,
            ..Self::default()
        }
    }

    /// Those that have been asked for since, and nothing has set.
    pub fn asked(&mut self) -> BTreeSet<String> {
        std::mem::take(self.asked.get_mut())
    }

    /// Takes the parameters of one program alone (`QL`), which is called or has ended.
    pub fn take_locals(&mut self) -> Vec<(String, f64)> {
        let local = |name: &str| name.starts_with("QL");
        let taken = self.values.iter().filter(|(name, _)| local(name));
        let taken = taken.map(|(name, value)| (name.clone(), *value)).collect();
        self.values.retain(|name, _| !local(name));
        taken
    }

    /// Gives them back to the program that goes on.
    pub fn give_locals(&mut self, locals: Vec<(String, f64)>) {
        self.take_locals();
        self.values.extend(locals);
    }

    /// A number, or a parameter with or without a sign: `+10.5`, `-Q12`, `QL3`.
    pub fn value(&self, text: &str) -> Result<f64, NcProblem> {
        let (sign, rest) = match text.strip_prefix('-') {
            Some(rest) => (-1.0, rest),
            None => (1.0, text.strip_prefix('+').unwrap_or(text)),
        };
        if rest.starts_with('Q') {
            return match self.values.get(rest) {
                Some(value) => Ok(sign * value),
                None if self.strict || !is_name(rest) => Err(NcProblem::syntax(format!(
                    "{rest} has no value here: expected {rest} = a number before it"
                ))),
                None => {
                    self.asked.borrow_mut().insert(rest.to_owned());
                    Ok(0.0)
                }
            };
        }
        // Decimal commas are as good as points.
        let plain = rest.replace(',', ".");
        let digits = plain.bytes().all(|b| b.is_ascii_digit() || b == b'.');
        match plain.parse::<f64>() {
            Ok(value) if digits && value.is_finite() => Ok(sign * value),
            _ => Err(NcProblem::value(
                "this",
                format!("{text:?}"),
                "a number or a Q parameter",
            )),
        }
    }

    pub fn set(&mut self, name: &str, value: f64) -> Result<(), NcProblem> {
        if !is_name(name) {
            return Err(NcProblem::value(
                "this",
                format!("{name:?}"),
                "the name of a Q parameter: Q1, QL1, QR1",
            ));
        }
        if !value.is_finite() {
            return Err(NcProblem::value(format!("the value of {name}"), value, "finite"));
        }
        if self.values.len() < MOST || self.values.contains_key(name) {
            self.values.insert(name.to_owned(), value);
        }
        Ok(())
    }

    /// `Q1 = +5`, with any of `+ - * / ^ ( )` and functions, as newer controls have it.
    pub fn formula(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let text: String = line
            .tokens
            .iter()
            .map(|token| token.text.as_str())
            .collect::<Vec<_>>()
            .join(" ");
        let Some((name, formula)) = text.split_once('=') else {
            return Err(whole(NcProblem::syntax(format!("{text:?}: expected Q1 = a value"))));
        };
        let value = formula::value(formula, &|name| self.value(name)).map_err(whole)?;
        self.set(name.trim(), value).map_err(whole)
    }

    /// `FN 1: Q1 = +Q2 + +3`, and what else it asks for.
    pub fn function(&mut self, line: &Line) -> Result<Jump, Located> {
        let whole = |problem| (problem, line.all());
        let fail = |message: &str| Err((NcProblem::syntax(message.to_owned()), line.all()));
        let mut words: Vec<String> = Vec::new();
        for token in &line.tokens[1..] {
            // `Q1=+5` and `1:` may stand without blanks.
            for piece in token.text.split_inclusive(['=', ':']) {
                let (head, mark) = match piece.char_indices().next_back() {
                    Some((at, mark @ ('=' | ':'))) => (&piece[..at], Some(mark)),
                    _ => (piece, None),
                };
                if !head.is_empty() {
                    words.push(head.to_owned());
                }
                words.extend(mark.map(String::from));
            }
        }
        let number: u32 = match words.first().and_then(|word| word.parse().ok()) {
            Some(number) if words.get(1).is_some_and(|word| word == ":") => number,
            _ => return fail("FN without its number: expected FN 0: to FN 12:"),
        };
        let rest: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        let value = |text: &str| self.value(text).map_err(whole);
        if (9..=12).contains(&number) {
            let (["IF", a, operator, b, "GOTO", "LBL", label] | ["IF", a, operator, b, "GOTO", label]) = rest[..]
            else {
                return fail("expected FN 9: IF +Q1 EQU +0 GOTO LBL 1");
            };
            // LBL7 is LBL 7.
            let label = match rest.len() {
                7 => label,
                _ => label.strip_prefix("LBL").unwrap_or_default(),
            };
            if label.is_empty() {
                return fail("expected FN 9: IF +Q1 EQU +0 GOTO LBL 1");
            }
            let (a, b) = (value(a)?, value(b)?);
            let goes = match (number, operator) {
                (9, "EQU") => a == b,
                (10, "NE") => a != b,
                (11, "GT") => a > b,
                (12, "LT") => a < b,
                _ => return fail("expected EQU with FN 9, NE with 10, GT with 11, LT with 12"),
            };
            return Ok(if goes { Jump::To(label.to_owned()) } else { Jump::None });
        }
        let result = match (number, &rest[..]) {
            (0, [_, "=", a]) => value(a)?,
            (1, [_, "=", a, "+", b]) => value(a)? + value(b)?,
            (2, [_, "=", a, "-", b]) => value(a)? - value(b)?,
            (3, [_, "=", a, "*", b]) => value(a)? * value(b)?,
            (4, [_, "=", a, "DIV" | "/", b]) => {
                let divisor = value(b)?;
                if divisor == 0.0 {
                    return fail("a division by 0");
                }
                value(a)? / divisor
            }
            (5, [_, "=", "SQRT", a]) if value(a)? >= 0.0 => value(a)?.sqrt(),
            (6, [_, "=", "SIN", a]) => value(a)?.to_radians().sin(),
            (7, [_, "=", "COS", a]) => value(a)?.to_radians().cos(),
            (8, [_, "=", a, "LEN", b]) => value(a)?.hypot(value(b)?),
            // From 0 to 360 degrees.
            (13, [_, "=", a, "ANG", b]) => value(a)?.atan2(value(b)?).to_degrees().rem_euclid(360.0),
            (0..=8 | 13, _) => return fail("this FN has other words: expected such as FN 1: Q1 = +Q2 + +3"),
            // What the control knows: data of the system, of a table, of the PLC.
            (18 | 28, _) => {
                let name = rest.iter().find(|word| is_name(word));
                let Some(name) = name.map(|name| (*name).to_owned()) else {
                    return fail("expected FN 18: SYSREAD Q1 = ID… or FN 28: TABREAD Q1 = …");
                };
                let of = rest.iter().skip_while(|word| **word != "=").skip(1);
                let of: Vec<&str> = of.copied().collect();
                return Ok(Jump::Read(name, of.join(" ")));
            }
            (14, _) => return Ok(Jump::Stop(rest.last().map(ToString::to_string).unwrap_or_default())),
            // Texts, files, tables, and what goes to the PLC or waits for it.
            (15..=17 | 19..=27 | 29..=38, _) => return Ok(Jump::Ignored(number)),
            _ => {
                let problem = NcProblem::unsupported(format!("FN {number} is"), "expected FN 0 to FN 38");
                return Err(whole(problem));
            }
        };
        let name = rest[0].to_owned();
        self.set(&name, result).map_err(whole)?;
        Ok(Jump::None)
    }
}

fn is_name(name: &str) -> bool {
    let rest = name.strip_prefix('Q').unwrap_or("");
    let digits = rest.trim_start_matches(['L', 'R']);
    !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) && rest.len() - digits.len() <= 1
}

#[cfg(test)]
mod tests {
    use super::super::line::line;
    use super::*;

    #[test]
    fn functions_and_formulas() {
        let mut parameters = Parameters::new(true);
        for (text, name, expected) in [
            ("FN 0: Q1 = +5", "Q1", 5.0),
            ("FN0: Q2=-Q1", "Q2", -5.0),
            ("FN 1: Q3 = +Q1 + +7", "Q3", 12.0),
            ("FN 2: Q3 = +Q1 - -7", "Q3", 12.0),
            ("FN 3: Q3 = +Q1 * +Q1", "Q3", 25.0),
            ("FN 4: Q3 = +Q1 DIV +2", "Q3", 2.5),
            ("FN 5: Q3 = SQRT +16", "Q3", 4.0),
            ("FN 6: Q3 = SIN +30", "Q3", 0.5),
            ("FN 8: Q3 = +3 LEN +4", "Q3", 5.0),
            ("Q4 = (Q1 + 1) * SIN 30 - 2 ^ 3", "Q4", -5.0),
            ("QL7 = -Q1/2", "QL7", -2.5),
        ] {
            let block = line(&text.replace("FN0:", "FN 0:"));
            if text.starts_with("FN") {
                assert_eq!(parameters.function(&block).unwrap(), Jump::None);
            } else {
                parameters.formula(&block).unwrap();
            }
            assert!((parameters.value(name).unwrap() - expected).abs() < 1e-12, "{text}");
        }
        assert_eq!(
            parameters.function(&line("FN 9: IF +Q1 EQU +5 GOTO LBL 3")).unwrap(),
            Jump::To("3".into())
        );
        assert_eq!(
            parameters.function(&line("FN 11: IF +Q1 GT +9 GOTO LBL 3")).unwrap(),
            Jump::None
        );
        for (text, message) in [
            ("FN 4: Q1 = +1 DIV +0", "a division by 0"),
            (
                "FN 1: Q1 = +Q99 + +1",
                "Q99 has no value here: expected Q99 = a number before it",
            ),
            ("FN 39: Q1 = 2", "FN 39 is not supported yet: expected FN 0 to FN 38"),
        ] {
            assert_eq!(parameters.function(&line(text)).unwrap_err().0.to_string(), message);
        }
        assert!(
            parameters
                .formula(&line(&format!("Q1 = {}1", "-".repeat(9999))))
                .is_err()
        );
    }
}
