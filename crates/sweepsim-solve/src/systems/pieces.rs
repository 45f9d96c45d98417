//! Systems of splines: one Bernstein system for each polynomial piece.

use super::{Equation, System, SystemError};
use crate::Enclosure;
use sweepsim_spline::{BSpline, RationalSpline, SplineError};
use thiserror::Error;

/// Why a system of splines is invalid.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PiecesError {
    /// No spline was given.
    #[error("a system needs a spline")]
    NoSplines,
    /// Splines differ in their number of variables.
    #[error("spline {spline} has {variables} variables, the first one {expected}")]
    Variables {
        /// The spline's number.
        spline: usize,
        /// Its variables.
        variables: usize,
        /// Those of the first.
        expected: usize,
    },
    /// Splines differ in their domain.
    #[error("spline {spline} has a different domain in variable {variable}")]
    Domain {
        /// The spline's number.
        spline: usize,
        /// The variable.
        variable: usize,
    },
    /// A piece could not be extracted.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// A piece does not form a valid system.
    #[error(transparent)]
    System(#[from] SystemError),
}

/// Systems side by side over the boxes of a grid of knots.
#[derive(Clone, Debug)]
pub struct Pieces {
    pub(crate) systems: Vec<System>,
    pub(crate) domain: Vec<Enclosure>,
}

impl Pieces {
    /// All components of all splines as equations. Degrees and knots may differ, domains may not.
    ///
    /// # Errors
    ///
    /// See [`PiecesError`].
    pub fn new(splines: &[BSpline]) -> Result<Self, PiecesError> {
        Self::of(splines, false)
    }

    /// All coordinates of all rational splines as equations: their numerators, since weights are positive.
    ///
    /// # Errors
    ///
    /// See [`PiecesError`].
    pub fn rational(splines: &[RationalSpline]) -> Result<Self, PiecesError> {
        let homogeneous: Vec<BSpline> = splines.iter().map(|s| s.homogeneous().clone()).collect();
        Self::of(&homogeneous, true)
    }

    fn of(splines: &[BSpline], drop_last: bool) -> Result<Self, PiecesError> {
        let first = splines.first().ok_or(PiecesError::NoSplines)?;
        let domain = first.domain();
        for (spline, s) in splines.iter().enumerate() {
            if s.variables() != first.variables() {
                return Err(PiecesError::Variables {
                    spline,
                    variables: s.variables(),
                    expected: first.variables(),
                });
            }
            if let Some(variable) = s.domain().iter().zip(&domain).position(|(a, b)| a != b) {
                return Err(PiecesError::Domain { spline, variable });
            }
        }
        // Boxes with the equations so far, cut further by each spline's knots.
        let mut boxes: Vec<(Vec<Enclosure>, Vec<sweepsim_spline::Bernstein>)> =
            vec![(domain.iter().map(|d| Enclosure::hull(d.0, d.1)).collect(), Vec::new())];
        for spline in splines {
            let pieces = spline.pieces()?;
            let mut cut = Vec::new();
            for (bounds, forms) in &boxes {
                for piece in &pieces {
                    let common: Option<Vec<Enclosure>> = bounds
                        .iter()
                        .zip(&piece.ranges)
                        .map(|(b, r)| b.intersection(Enclosure::hull(r.0, r.1)).filter(|c| c.lo() < c.hi()))
                        .collect();
                    let Some(common) = common else {
                        continue;
                    };
                    let share = |b: &[Enclosure], r: &[(f64, f64)]| -> Vec<(f64, f64)> {
                        let ratio = |(c, (lo, hi)): (&Enclosure, &(f64, f64))| {
                            ((c.lo() - lo) / (hi - lo), (c.hi() - lo) / (hi - lo))
                        };
                        b.iter().zip(r).map(ratio).collect()
                    };
                    let old: Vec<(f64, f64)> = bounds.iter().map(|b| (b.lo(), b.hi())).collect();
                    let restricted = |f: &sweepsim_spline::Bernstein, shares: &[(f64, f64)]| {
                        if shares.iter().all(|s| *s == (0.0, 1.0)) {
                            f.clone()
                        } else {
                            f.restrict_box(shares)
                        }
                    };
                    let mut all: Vec<_> = forms.iter().map(|f| restricted(f, &share(&common, &old))).collect();
                    let components = piece.map.components();
                    let used = components.len() - usize::from(drop_last);
                    let own = share(&common, &piece.ranges);
                    all.extend(components[..used].iter().map(|f| restricted(f, &own)));
                    cut.push((common, all));
                }
            }
            boxes = cut;
        }
        let systems: Result<Vec<System>, SystemError> = boxes
            .into_iter()
            .map(|(bounds, forms)| System::mapped(&bounds, forms.into_iter().map(Equation::from)))
            .collect();
        Ok(Self {
            systems: systems?,
            domain: domain.iter().map(|d| Enclosure::hull(d.0, d.1)).collect(),
        })
    }

    /// The systems, one per piece.
    #[must_use]
    pub fn systems(&self) -> &[System] {
        &self.systems
    }

    /// The domain of all of them together.
    #[must_use]
    pub fn domain(&self) -> &[Enclosure] {
        &self.domain
    }
}
