//! 0-D: all solutions of `n` equations in `n` unknowns.
//!
//! For each box, the cheapest tests come first:
//!
//! 1. *Sign*: an equation whose coefficients (with their rounding bound) have one sign excludes the box.
//! 2. *Linear*: with the mean Jacobian `A`, each equation is `constant + A z + rest`, `|rest| ≤ r`, over the box (`z` from its
//!    centre). With `K ≈ A⁻¹`, every root lies in `N = (I − K A) Z − K constant ± |K| r`. If `N` misses the box, it has none.
//! 3. *Certificate*: if `N` is small, take a box `C` around it (which may extend beyond the box's faces). If `‖I − K J(C)‖∞ < 1`, the map is
//!    injective on `C`; if `N(C) ⊂ C`, the map `z ↦ z − K f(z)` takes `C` into itself, so by Brouwer there is a root. Newton's method
//!    finds it, and the same `K` bounds its error. All roots of the box lie in `C`: the box is settled.
//! 4. *Projection*: where the convex hull of an equation's coefficient ranges along an axis meets 0 (Sherbrooke, Patrikalakis 1993).
//! 5. Reduce, or split a little off the middle, in the direction in which the Jacobian varies most.
//!
//! A box at the smallest size stays unresolved. A root on a face between two boxes is found from both. The two are identified because each is the
//! only root in a box `C` that contains the other, never because they are close.

mod certify;
mod count;
mod degree;
mod drowned;
mod flood;
#[cfg(feature = "rayon")]
mod parallel;
mod pieces;
mod represent;
mod solver;
mod treat;

use crate::Enclosure;
use crate::search::{SolveStatistics, UnresolvedBox};
pub use solver::PointSolver;

/// Where a certified root lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RootLocation {
    /// Inside the region.
    Inside,
    /// On the boundary of the region, or so close that the enclosure touches it. Certified on a larger box.
    Boundary,
}

/// A root with its certificate.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Root {
    /// The root, to machine precision.
    pub point: Vec<f64>,
    /// A box that contains the root.
    pub enclosure: Vec<Enclosure>,
    /// A box with no other root; it holds the enclosure. It may extend beyond the domain.
    pub unique_in: Vec<Enclosure>,
    /// The sign of `det ∂f/∂x` at the root (and wherever the root is unique).
    pub orientation: i8,
    /// Inside or on the boundary.
    pub location: RootLocation,
}

/// All roots of a system in a region: each lies in the enclosure of one of `roots`, or in one of `unresolved`.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Points {
    /// Simple roots, each certified, in lexicographic order.
    pub roots: Vec<Root>,
    /// Boxes that could not be resolved.
    pub unresolved: Vec<UnresolvedBox>,
    /// Statistics of the search.
    pub statistics: SolveStatistics,
}
