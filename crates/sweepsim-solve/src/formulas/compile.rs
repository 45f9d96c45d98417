//! From a formula to an equation over a domain: polynomial parts become forms, the rest is left to the solvers.

use super::formula::{Formula, Node};
use super::numbers::Real;
use super::polynomial::Polynomial;
use crate::coefficients::{Function, value_range};
use crate::numbers::{Double, EPSILON};
use crate::systems::ExpressionBuilder;
use crate::{Enclosure, Equation, MAX_STEPS, SystemError};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// A formula as a polynomial plus anything else, the latter a step of the expression.
#[derive(Clone)]
struct SplitFormula {
    polynomial: Option<Rc<Polynomial>>,
    rest: Option<usize>,
}

impl SplitFormula {
    fn polynomial(polynomial: Polynomial) -> Self {
        Self {
            polynomial: Some(Rc::new(polynomial)),
            rest: None,
        }
    }

    fn rest(step: usize) -> Self {
        Self {
            polynomial: None,
            rest: Some(step),
        }
    }

    /// The polynomial, if there is nothing else.
    fn pure(&self) -> Option<&Polynomial> {
        self.polynomial.as_deref().filter(|_| self.rest.is_none())
    }

    fn number(&self) -> Option<Real> {
        self.pure().and_then(Polynomial::number)
    }
}

struct Compiler<'a> {
    domain: &'a [Enclosure],
    equation: usize,
    builder: ExpressionBuilder,
}

/// The equation `formula = 0` over the domain.
pub(super) fn equation(formula: &Formula, equation: usize, domain: &[Enclosure]) -> Result<Equation, SystemError> {
    let mut compiler = Compiler {
        domain,
        equation,
        builder: ExpressionBuilder::default(),
    };
    let mut known: BTreeMap<*const Node, SplitFormula> = BTreeMap::new();
    let mut waiting = vec![formula];
    let mut last = None;
    while let Some(next) = waiting.last().copied() {
        let place = Arc::as_ptr(&next.0);
        if !known.contains_key(&place) {
            let operands = next.0.operands();
            let mut ready = true;
            for operand in operands.into_iter().flatten() {
                if !known.contains_key(&Arc::as_ptr(&operand.0)) {
                    waiting.push(operand);
                    ready = false;
                }
            }
            if !ready {
                continue;
            }
            let parts = operands.map(|o| o.and_then(|o| known.get(&Arc::as_ptr(&o.0))).cloned());
            let part = compiler.node(&next.0, parts)?;
            known.insert(place, part);
            if known.len() > MAX_STEPS {
                return Err(SystemError::TooManySteps {
                    equation,
                    steps: known.len(),
                });
            }
        }
        last = Some(place);
        waiting.pop();
    }
    let part = last.and_then(|place| known.remove(&place));
    let Some(part) = part else {
        return Err(SystemError::NoEquations);
    };
    if let Some(polynomial) = part.pure() {
        return compiler.forms(polynomial);
    }
    let whole = compiler.step(&part)?;
    Ok(compiler.builder.finish(whole).into())
}

impl Compiler<'_> {
    fn node(&mut self, node: &Node, operands: [Option<SplitFormula>; 2]) -> Result<SplitFormula, SystemError> {
        let n = self.domain.len();
        match (node, operands) {
            (Node::Variable(number), _) if *number >= n => Err(SystemError::FormVariables {
                equation: self.equation,
                variables: number.saturating_add(1),
                expected: n,
            }),
            (Node::Variable(number), _) => Ok(SplitFormula::polynomial(Polynomial::variable(*number, self.domain))),
            (Node::Constant(number), _) if !(number.value.hi + number.value.lo).is_finite() => Err(self.not_finite()),
            (Node::Constant(number), _) => Ok(SplitFormula::polynomial(Polynomial::constant(n, *number))),
            (Node::Add(..), [Some(a), Some(b)]) => self.add(&a, &b),
            (Node::Multiply(..), [Some(a), Some(b)]) => self.multiply(&a, &b),
            (Node::Divide(..), [Some(a), Some(b)]) => self.divide(&a, &b),
            (Node::Apply(function, _), [Some(a), _]) => self.apply(*function, &a),
            _ => Err(SystemError::EmptySum {
                equation: self.equation,
            }),
        }
    }

    fn not_finite(&self) -> SystemError {
        SystemError::NotFinite {
            equation: self.equation,
        }
    }

    fn forms(&self, polynomial: &Polynomial) -> Result<Equation, SystemError> {
        polynomial.equation().ok_or_else(|| self.not_finite())
    }

    /// The part as one step of the expression.
    fn step(&mut self, part: &SplitFormula) -> Result<usize, SystemError> {
        let Some(polynomial) = part.polynomial.as_deref() else {
            return Ok(part.rest.unwrap_or(0));
        };
        let own = match polynomial.number() {
            Some(number) if number.error == 0.0 && number.value.lo == 0.0 => self.builder.constant(number.value.hi),
            _ => {
                let forms = self.forms(polynomial)?;
                self.builder.form(forms)
            }
        };
        Ok(match part.rest {
            Some(rest) => self.builder.add(own, rest),
            None => own,
        })
    }

    fn add(&mut self, a: &SplitFormula, b: &SplitFormula) -> Result<SplitFormula, SystemError> {
        let polynomial = match (&a.polynomial, &b.polynomial) {
            (Some(p), Some(q)) => match p.add(q) {
                Some(sum) => Some(Rc::new(sum)),
                None => {
                    let (a, b) = (self.step(a)?, self.step(b)?);
                    return Ok(SplitFormula::rest(self.builder.add(a, b)));
                }
            },
            (p, q) => p.clone().or_else(|| q.clone()),
        };
        let rest = match (a.rest, b.rest) {
            (Some(a), Some(b)) => Some(self.builder.add(a, b)),
            (a, b) => a.or(b),
        };
        Ok(SplitFormula { polynomial, rest })
    }

    fn multiply(&mut self, a: &SplitFormula, b: &SplitFormula) -> Result<SplitFormula, SystemError> {
        if let (Some(p), Some(q)) = (a.pure(), b.pure())
            && let Some(product) = p.multiply(q)
        {
            return Ok(SplitFormula::polynomial(product));
        }
        // A factor that is a number goes to either part.
        for (factor, other) in [(a, b), (b, a)] {
            let (Some(number), Some(polynomial), Some(rest)) = (factor.number(), &other.polynomial, other.rest) else {
                continue;
            };
            let Some(product) = polynomial.multiply(&Polynomial::constant(self.domain.len(), number)) else {
                continue;
            };
            let number = self.step(factor)?;
            return Ok(SplitFormula {
                polynomial: Some(Rc::new(product)),
                rest: Some(self.builder.multiply(number, rest)),
            });
        }
        let (a, b) = (self.step(a)?, self.step(b)?);
        Ok(SplitFormula::rest(self.builder.multiply(a, b)))
    }

    fn divide(&mut self, a: &SplitFormula, b: &SplitFormula) -> Result<SplitFormula, SystemError> {
        if let (Some(p), Some(number)) = (a.pure(), b.number())
            && let Some(quotient) = p.divide(number)
        {
            return Ok(SplitFormula::polynomial(quotient));
        }
        let (a, b) = (self.step(a)?, self.step(b)?);
        Ok(SplitFormula::rest(self.builder.divide(a, b)))
    }

    fn apply(&mut self, function: Function, a: &SplitFormula) -> Result<SplitFormula, SystemError> {
        if let (Some(p), Function::Power(exponent)) = (a.pure(), function)
            && let Some(power) = p.power(exponent)
        {
            return Ok(SplitFormula::polynomial(power));
        }
        if let Some(number) = a.number()
            && let Some(value) = function_of(function, number)
        {
            return Ok(SplitFormula::polynomial(Polynomial::constant(self.domain.len(), value)));
        }
        let a = self.step(a)?;
        Ok(SplitFormula::rest(self.builder.apply(function, a)))
    }
}

/// A function of a number, where it is defined.
fn function_of(function: Function, number: Real) -> Option<Real> {
    let x = number.value.hi;
    let mut reach = (number.value.lo.abs() + number.error) * (1.0 + 4.0 * EPSILON);
    if reach > 0.0 {
        // The ends of the argument round as well.
        reach += EPSILON * x.abs();
    }
    let (lo, hi) = value_range(function, x - reach, x + reach)?;
    let middle = 0.5 * (lo + hi);
    Some(Real {
        value: Double::new(middle),
        error: (0.5 * (hi - lo) + EPSILON * middle.abs()) * (1.0 + 4.0 * EPSILON),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_spline::Bernstein;

    fn side(lo: f64, hi: f64) -> Enclosure {
        Enclosure::new(lo, hi).unwrap()
    }

    #[test]
    fn polynomials_become_forms() {
        let (x, y) = (Formula::variable(0), Formula::variable(1));
        let formula = (&x - 1.0).powi(2) * &y + &x / 2.0;
        let equation = equation(&formula, 0, &[side(-2.0, 2.0), side(0.0, 3.0)]).unwrap();
        assert!(equation.expression.is_none());
        let value = |u: f64, v: f64| -> f64 { equation.terms.iter().map(|t: &Bernstein| t.evaluate(&[u, v])).sum() };
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, 0.25)] {
            let (a, b) = (4.0 * u - 2.0, 3.0 * v);
            assert!((value(u, v) - ((a - 1.0) * (a - 1.0) * b + a / 2.0)).abs() < 1e-14);
        }
    }
}
