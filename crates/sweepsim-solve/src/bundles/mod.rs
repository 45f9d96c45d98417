//! Bundles: the points of many systems that differ in their right-hand sides, each with its own certificate.
//!
//! In `n` unknowns, `pᵢ / w = qᵢ` for some polynomials `pᵢ` over a positive weight `w`, and further polynomials are zero. Each target
//! `q` defines a system, `F(z) = (p − q w, …) = 0`. The systems share their coefficients, so one subdivision serves all of them: a box keeps
//! those targets that lie in the range of `p / w` over it.
//!
//! Over a box, let `H` bound the second derivatives of `F` (of all targets in it), read off the Bernstein coefficients. For one target, at
//! any point `s` of the box with `v = p/w − q` and its Jacobian `J` there, and `K = J⁻¹`, Taylor's theorem says that each root `z` in the box has
//!
//! ```text
//! z − (s − K v) = −K v (∇w / w)(z − s) − ½ K H* (z − s)² / w,        |H*| ≤ H
//! ```
//!
//! This gives three tests for each target (`line.rs`):
//!
//! - *no root*: the right side is bounded over the part of the box where roots may be; whatever is farther from the Newton step is cut away, and
//!   if nothing is left, there is no root;
//! - *existence*, by Brouwer: there is a root if the same bound, over a small ball about `s`, keeps the image of the Newton step inside the ball;
//! - *single solution* (Newton and Kantorovich): if `|K| (H/2) |z − z*| / w < 1` about a root `z*` over what is left of the box, it is the only one.
//!
//! Targets that a box leaves undecided, and only these, go on to its halves. A root on a face between boxes is found from both; two finds of one
//! target are the same root if they are so close that the single-solution test, with second derivatives of the whole domain, allows only one.
//!
//! Bundles find the same solutions as [charts](crate::ChartSolver), but use polynomials in all unknowns, second derivatives instead of ranges of first
//! derivatives, and a certificate for each root instead of each box.

mod cell;
mod line;
mod search;
mod taylor;
mod trail;

use crate::Monitor;
use crate::charts::{ChartMap, ChartOptions, ChartStatistics, Sink, Targets};
use cell::Blocks;
use search::Search;
use std::collections::BTreeMap;
use sweepsim_spline::Bernstein;
use thiserror::Error;

/// Why a bundle is invalid.
///
/// ```
/// use sweepsim_solve::{Bernstein, Bundle, BundleError};
///
/// let (x, y, one) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1), Bernstein::constant(2, 1.0));
/// let bundle = |numerators: Vec<Bernstein>, weight: &Bernstein| Bundle::<2>::new(numerators, weight, vec![]);
/// assert!(bundle(vec![x.clone(), y.clone()], &one).is_ok());
/// assert_eq!(bundle(vec![x.clone()], &one).unwrap_err(), BundleError::Count { found: 1, expected: 2 });
/// let line = Bernstein::variable(1, 0);
/// assert_eq!(bundle(vec![x.clone(), line], &one).unwrap_err(), BundleError::Variables { form: 1, found: 1, expected: 2 });
/// assert_eq!(bundle(vec![x.clone(), y.clone()], &x).unwrap_err(), BundleError::Weight);
/// let high = Bernstein::from_fn(&[64, 0], |_| 1.0).unwrap();
/// assert_eq!(bundle(vec![high, y], &one).unwrap_err(), BundleError::Degree { form: 0, degree: 64 });
/// let unknown = Bernstein::constant(2, f64::NAN);
/// assert_eq!(bundle(vec![x, unknown], &one).unwrap_err(), BundleError::NotFinite { form: 1 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BundleError {
    /// The number of numerators and zeros differs from the number of unknowns.
    #[error("{found} equations in {expected} unknowns")]
    Count {
        /// The number of equations given.
        found: usize,
        /// The number of unknowns.
        expected: usize,
    },
    /// A form (numerators first, then the weight, then zeros and conditions) has the wrong number of variables.
    #[error("form {form} has {found} variables, not {expected}")]
    Variables {
        /// The form's number.
        form: usize,
        /// The form's number of variables.
        found: usize,
        /// The number of unknowns.
        expected: usize,
    },
    /// A degree is above [`MAX_DEGREE`](crate::MAX_DEGREE).
    #[error("form {form} is of degree {degree}")]
    Degree {
        /// The form's number.
        form: usize,
        /// The form's largest degree.
        degree: usize,
    },
    /// A coefficient or error bound is infinite or NaN.
    #[error("form {form} has a coefficient or bound that is not a finite number")]
    NotFinite {
        /// The form's number.
        form: usize,
    },
    /// A coefficient of the weight is not positive, beyond its error.
    #[error("the weight is not positive")]
    Weight,
}

/// Systems `pᵢ = qᵢ w`, `zⱼ = 0` in `N` unknowns (2 or 3) over `[0, 1]ᴺ`, one for each target `q`.
#[derive(Clone, Debug)]
pub struct Bundle<const N: usize> {
    blocks: Blocks<N>,
}

impl<const N: usize> Bundle<N> {
    /// The systems `numeratorsᵢ / weight = qᵢ`, `zerosⱼ = 0`.
    ///
    /// # Errors
    ///
    /// [`BundleError`]
    pub fn new(numerators: Vec<Bernstein>, weight: &Bernstein, zeros: Vec<Bernstein>) -> Result<Self, BundleError> {
        let blocks = Blocks::new(numerators, weight, zeros)?;
        Ok(Self { blocks })
    }

    /// Restricts the search to solutions where exactly one of two forms is negative. Others may still be reported.
    ///
    /// # Errors
    ///
    /// [`BundleError`]
    pub fn where_signs_differ(mut self, first: Bernstein, second: Bernstein) -> Result<Self, BundleError> {
        self.blocks.set_conditions([first, second])?;
        Ok(self)
    }

    /// Whether some equation is exactly zero everywhere: it has no isolated solutions.
    #[must_use]
    pub fn vanishes(&self) -> bool {
        self.blocks.vanishes()
    }
}

/// Solves bundles. It reuses its memory from one call to the next.
#[derive(Debug)]
pub struct BundleSolver {
    /// Limits; [`accept`](ChartOptions::accept) is relative to half the side of a box.
    pub options: ChartOptions,
    /// Totals over all calls; `charts` counts boxes on which targets were tried.
    pub statistics: ChartStatistics,
    /// A target that so many boxes have left undecided, each having tested it on its own, is reported as unresolved and not searched for any further.
    pub patience: u32,
    coefficients: Vec<f64>,
    scratch: Vec<f64>,
}

impl BundleSolver {
    /// Creates a solver with these limits.
    #[must_use]
    pub fn new(options: ChartOptions) -> Self {
        Self {
            options,
            statistics: ChartStatistics::default(),
            patience: u32::MAX,
            coefficients: Vec::new(),
            scratch: Vec::new(),
        }
    }

    /// Finds, for every target, all solutions in `[0, 1]ᴺ`.
    ///
    /// Only [`evaluate`](ChartMap::evaluate) and [`scales`](ChartMap::scales) of the map are used; it must be the map that the bundle's forms define.
    /// Each solution is reported to `sink` once; boxes that may hold unreported solutions are reported as unresolved. If such a box is so small that rounding
    /// hides what is in it, no further solutions of its target are searched for: it is open in any case.
    pub fn solve<const N: usize, M, T, S>(
        &mut self,
        bundle: &Bundle<N>,
        map: &M,
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) where
        M: ChartMap<N>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
    {
        let blocks = &bundle.blocks;
        if blocks.vanishes() {
            return;
        }
        let (mut coefficients, mut scratch) = (
            std::mem::take(&mut self.coefficients),
            std::mem::take(&mut self.scratch),
        );
        coefficients.clear();
        coefficients.extend_from_slice(&blocks.first);
        let mut search = Search {
            blocks,
            map,
            targets,
            monitor,
            options: self.options,
            statistics: &mut self.statistics,
            coefficients,
            scratch: &mut scratch,
            lines: Vec::new(),
            straddlers: Vec::new(),
            open: Vec::new(),
            patience: self.patience,
            undecided: BTreeMap::new(),
        };
        search.run(sink);
        self.coefficients = search.coefficients;
        self.scratch = scratch;
    }
}
