//! Equations as people write them: by operators ([`Formula`]) or as text ([`System::parse`](crate::System::parse)), in the domain's own coordinates.
//!
//! What is polynomial becomes Bernstein forms over the domain, computed in double-double precision with a bound of the error; products are not
//! expanded into powers, so that `(x − 1)(x − 2)…` on `[0, 20]` keeps its accuracy. Anything else becomes an [`Expression`](crate::Expression) of such
//! forms, whose bounds the solvers compute cell by cell.

mod compile;
mod error;
mod formula;
mod lexer;
mod numbers;
mod parse;
mod polynomial;

pub use error::{FormulaError, FormulaProblem};
pub use formula::Formula;

use crate::{Enclosure, System, SystemError};

impl System {
    /// The system of these formulas, each equal to 0, over a domain. The formulas' variables are the domain's coordinates.
    ///
    /// ```
    /// use sweepsim_solve::{Enclosure, Formula, PointSolver, System};
    ///
    /// // x² + y² = 1 and y = x³ on [−2, 2]².
    /// let [x, y] = [Formula::variable(0), Formula::variable(1)];
    /// let circle = x.powi(2) + y.powi(2) - 1.0;
    /// let system = System::of_formulas(&[Enclosure::new(-2.0, 2.0)?; 2], [circle, y - x.powi(3)])?;
    /// let points = PointSolver::default().solve(&system, &())?;
    /// assert_eq!((points.roots.len(), points.unresolved.len()), (2, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SystemError`], as for [`System::mapped`]. [`SystemError::FormVariables`] if a formula has a variable that the domain does not have.
    pub fn of_formulas(domain: &[Enclosure], formulas: impl IntoIterator<Item = Formula>) -> Result<Self, SystemError> {
        Self::check_domain(domain)?;
        let equations: Result<Vec<_>, SystemError> = formulas
            .into_iter()
            .enumerate()
            .map(|(number, formula)| compile::equation(&formula, number, domain))
            .collect();
        Self::mapped(domain, equations?)
    }

    /// The system of these equations as text, in the variables of these names, over a domain with one enclosure per variable.
    ///
    /// An equation is `left = right`, or one side alone that is to be 0. There are numbers, names, `+ - * /`, powers `^` (or `**`), parentheses,
    /// `pi`, `e`, and the functions `sin cos tan exp ln sqrt atan`. Multiplication needs its sign. Numbers stand for what they say: `0.1` is a tenth, not the closest
    /// floating-point number. Powers with whole exponents are defined for any base, others (`exp(b ln a)`) for positive ones.
    ///
    /// ```
    /// use sweepsim_solve::{Enclosure, PointSolver, System};
    ///
    /// let domain = [Enclosure::new(-2.0, 2.0)?; 2];
    /// let system = System::parse(&["x^2 + y^2 = 1", "y = sin(3*x)"], &["x", "y"], &domain)?;
    /// let points = PointSolver::default().solve(&system, &())?;
    /// assert_eq!((points.roots.len(), points.unresolved.len()), (6, 0));
    ///
    /// let error = System::parse(&["x^2 + = 1"], &["x"], &domain[..1]).unwrap_err();
    /// assert_eq!(error.to_string(), "equation 1:1:7: found `=`, expected a number, a name, `(` or a sign");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`FormulaError`], with the equation, the line and the column where the text is at fault.
    pub fn parse<S: AsRef<str>, N: AsRef<str>>(
        equations: &[S],
        names: &[N],
        domain: &[Enclosure],
    ) -> Result<Self, FormulaError> {
        let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        parse::check_names(&names, domain.len())?;
        let mut formulas = Vec::with_capacity(equations.len());
        for (number, text) in equations.iter().enumerate() {
            formulas.push(parse::equation(text.as_ref(), &names).map_err(|e| e.in_equation(number))?);
        }
        Self::of_formulas(domain, formulas).map_err(FormulaError::from)
    }
}
