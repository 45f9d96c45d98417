//! Systems of equations: Bernstein forms, sums and combinations of them, and splines.

mod error;
mod expression;
mod pieces;
mod separate;
mod system;

pub use error::SystemError;
pub(crate) use expression::ExpressionBuilder;
pub use expression::{Expression, MAX_STEPS};
pub use pieces::{Pieces, PiecesError};
pub use system::{Equation, MAX_SYSTEM, System};
