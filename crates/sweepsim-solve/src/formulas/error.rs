//! What is wrong with equations as text, and where.

use crate::{MAX_UNKNOWNS, SystemError};
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::fmt;
use thiserror::Error;

/// Longer lines are cut in excerpts.
const MAX_EXCERPT: usize = 160;

/// What is wrong, without the place.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FormulaProblem {
    /// The text does not follow the grammar.
    #[error("found {found}, expected {expected}")]
    Syntax {
        /// What is there.
        found: String,
        /// What could be there.
        expected: &'static str,
    },
    /// A name is neither that of a variable nor that of a constant.
    #[error("`{name}` is unknown, expected one of {expected}")]
    UnknownName {
        /// The name.
        name: String,
        /// The names that are known.
        expected: String,
    },
    /// A name before a parenthesis is not that of a function.
    #[error("`{name}` is not a function, expected one of {expected}")]
    UnknownFunction {
        /// The name.
        name: String,
        /// The functions that are known.
        expected: String,
    },
    /// A number cannot be represented.
    #[error("the number {number} is too large, expected one below 1.8e308")]
    NumberTooLarge {
        /// The number.
        number: String,
    },
    /// Parentheses, signs and powers are nested too deeply.
    #[error("nested too deeply, expected at most {most} levels")]
    TooDeep {
        /// The number of levels allowed.
        most: usize,
    },
    /// A name given for a variable is not a name, that of a function, or another variable's.
    #[error("`{name}` cannot name variable {variable}, expected letters, digits and `_` that name nothing else")]
    VariableName {
        /// The variable, counted from 1.
        variable: usize,
        /// The name.
        name: String,
    },
    /// There are not as many names as sides of the domain.
    #[error("{names} names for a domain with {sides} sides, expected 1 to {MAX_UNKNOWNS} of either")]
    VariableCount {
        /// The number of names.
        names: usize,
        /// The number of sides.
        sides: usize,
    },
    /// The equations do not form a system over the domain.
    #[error(transparent)]
    System(#[from] SystemError),
}

/// Equations as text that cannot be read: what is wrong, in which equation, and where, as far as each is known.
///
/// Its `Display` is one line, `equation number:line:column: what is wrong, and what was expected`; [`render`](Self::render) adds the text with
/// the place marked.
///
/// ```
/// use sweepsim_solve::{Enclosure, System};
///
/// let error = System::parse(&["x + (y - 1"], &["x", "y"], &[Enclosure::UNIT; 2]).unwrap_err();
/// assert_eq!(error.to_string(), "equation 1:1:11: found the end, expected an operator or `)`");
/// assert!(error.render(false).contains("x + (y - 1\n"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FormulaError(Box<Inner>);

#[derive(Clone, Debug, PartialEq)]
struct Inner {
    equation: Option<usize>,
    position: Option<Position>,
    problem: FormulaProblem,
}

#[derive(Clone, Debug, PartialEq)]
struct Position {
    line: usize,
    column: usize,
    width: usize,
    excerpt: String,
}

impl FormulaError {
    pub(super) fn new(problem: FormulaProblem) -> Self {
        Self(Box::new(Inner {
            equation: None,
            position: None,
            problem,
        }))
    }

    /// The problem at these bytes of the text, which begin and end between characters.
    pub(super) fn at(text: &str, bytes: std::ops::Range<usize>, problem: FormulaProblem) -> Self {
        let line_start = text[..bytes.start].rfind('\n').map_or(0, |byte| byte + 1);
        let line = 1 + text[..line_start].bytes().filter(|byte| *byte == b'\n').count();
        let column = 1 + text[line_start..bytes.start].chars().count();
        let width = text[bytes].lines().next().unwrap_or("").chars().count().max(1);
        let whole = text[line_start..].lines().next().unwrap_or("");
        let kept = MAX_EXCERPT.max(column + MAX_EXCERPT / 4);
        let mut error = Self::new(problem);
        error.0.position = Some(Position {
            line,
            column,
            width,
            excerpt: whole.chars().take(kept).collect(),
        });
        error
    }

    pub(super) fn in_equation(mut self, number: usize) -> Self {
        self.0.equation = Some(number);
        self
    }

    /// The number of the equation, counted from 0, if the problem lies in one.
    #[must_use]
    pub fn equation(&self) -> Option<usize> {
        self.0.equation
    }

    /// The line in the equation's text, counted from 1.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        self.0.position.as_ref().map(|p| p.line)
    }

    /// The column of the first character, counted from 1, in characters.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        self.0.position.as_ref().map(|p| p.column)
    }

    /// What is wrong.
    #[must_use]
    pub fn problem(&self) -> &FormulaProblem {
        &self.0.problem
    }

    /// The message, and the line of the text with the place marked, optionally in colour for terminals.
    #[must_use]
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let title = Level::ERROR.primary_title(self.0.problem.to_string());
        let place = self.0.equation.map(|number| format!("equation {}", number + 1));
        let Some(position) = &self.0.position else {
            return renderer.render(&[title.elements(place.map(annotate_snippets::Origin::path))]);
        };
        let bytes = |characters: usize| {
            let mut places = position.excerpt.char_indices();
            places.nth(characters).map_or(position.excerpt.len(), |(byte, _)| byte)
        };
        let span = bytes(position.column - 1)..bytes(position.column - 1 + position.width);
        let mut snippet = Snippet::source(position.excerpt.as_str())
            .line_start(position.line)
            .annotation(AnnotationKind::Primary.span(span));
        if let Some(place) = place {
            snippet = snippet.path(place);
        }
        renderer.render(&[title.element(snippet)])
    }
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(equation) = self.0.equation {
            write!(f, "equation {}:", equation + 1)?;
        }
        if let Some(position) = &self.0.position {
            write!(f, "{}:{}:", position.line, position.column)?;
        }
        if self.0.equation.is_some() || self.0.position.is_some() {
            f.write_str(" ")?;
        }
        write!(f, "{}", self.0.problem)
    }
}

impl std::error::Error for FormulaError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        std::error::Error::source(&self.0.problem)
    }
}

impl From<SystemError> for FormulaError {
    fn from(error: SystemError) -> Self {
        Self::new(FormulaProblem::System(error))
    }
}
