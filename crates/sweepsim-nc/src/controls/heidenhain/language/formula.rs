//! Formulas of Q parameters.

use crate::text::error::NcProblem;

/// Where numbers and parameters get their values from.
type Lookup<'a> = &'a dyn Fn(&str) -> Result<f64, NcProblem>;

/// The deepest nesting of a formula.
const DEEPEST: usize = 60;

/// The value of a formula.
pub(in crate::controls::heidenhain) fn value(text: &str, lookup: Lookup) -> Result<f64, NcProblem> {
    let depth = 0;
    let mut parser = Parser { text, lookup, depth };
    let value = parser.sum()?;
    match parser.text.trim() {
        "" => Ok(value),
        rest => Err(NcProblem::syntax(format!(
            "{rest:?} here: expected an operator or the end of the block"
        ))),
    }
}

struct Parser<'a> {
    text: &'a str,
    lookup: Lookup<'a>,
    depth: usize,
}

impl Parser<'_> {
    fn take(&mut self, symbol: char) -> bool {
        self.text = self.text.trim_start();
        match self.text.strip_prefix(symbol) {
            Some(rest) => {
                self.text = rest;
                true
            }
            None => false,
        }
    }

    fn sum(&mut self) -> Result<f64, NcProblem> {
        let mut sum = self.product()?;
        loop {
            if self.take('+') {
                sum += self.product()?;
            } else if self.take('-') {
                sum -= self.product()?;
            } else {
                return Ok(sum);
            }
        }
    }

    fn product(&mut self) -> Result<f64, NcProblem> {
        let mut product = self.power()?;
        loop {
            if self.take('*') {
                product *= self.power()?;
            } else if self.take('/') {
                let divisor = self.power()?;
                if divisor == 0.0 {
                    return Err(NcProblem::syntax("a division by 0"));
                }
                product /= divisor;
            } else if self.take('%') {
                let divisor = self.power()?;
                if divisor == 0.0 {
                    return Err(NcProblem::syntax("a division by 0"));
                }
                product %= divisor;
            } else {
                return Ok(product);
            }
        }
    }

    fn power(&mut self) -> Result<f64, NcProblem> {
        let base = self.atom()?;
        Ok(if self.take('^') { base.powf(self.atom()?) } else { base })
    }

    fn atom(&mut self) -> Result<f64, NcProblem> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(NcProblem::syntax("a formula that is nested too deeply"));
        }
        let value = self.nested();
        self.depth -= 1;
        value
    }

    fn nested(&mut self) -> Result<f64, NcProblem> {
        if self.take('-') {
            return Ok(-self.atom()?);
        }
        if self.take('+') {
            return self.atom();
        }
        if self.take('(') {
            let value = self.sum()?;
            return if self.take(')') {
                Ok(value)
            } else {
                Err(NcProblem::syntax("a parenthesis that is not closed: expected `)`"))
            };
        }
        let end = self
            .text
            .find(|c: char| !(c.is_ascii_alphanumeric() || c == '.'))
            .unwrap_or(self.text.len());
        let (word, rest) = self.text.split_at(end);
        self.text = rest;
        let angle = |x: f64| x.to_radians();
        Ok(match word {
            "PI" => std::f64::consts::PI,
            "SIN" => angle(self.atom()?).sin(),
            "COS" => angle(self.atom()?).cos(),
            "TAN" => angle(self.atom()?).tan(),
            "ASIN" => self.atom()?.asin().to_degrees(),
            "ACOS" => self.atom()?.acos().to_degrees(),
            "ATAN" => self.atom()?.atan().to_degrees(),
            "SQRT" => self.atom()?.sqrt(),
            "SQ" => self.atom()?.powi(2),
            "SGN" => {
                let value = self.atom()?;
                if value == 0.0 { 0.0 } else { value.signum() }
            }
            "LN" => self.atom()?.ln(),
            "LOG" => self.atom()?.log10(),
            "EXP" => self.atom()?.exp(),
            "ABS" => self.atom()?.abs(),
            "NEG" => -self.atom()?,
            "INT" => self.atom()?.trunc(),
            "FRAC" => self.atom()?.fract(),
            "" => {
                return Err(NcProblem::syntax(
                    "the formula ends too early, or has a sign that is not understood",
                ));
            }
            word => (self.lookup)(word)?,
        })
    }
}
