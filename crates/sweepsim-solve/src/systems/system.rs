//! Systems of equations in Bernstein form over a box, checked once and brought into the solvers' inner form.

use super::error::SystemError;
use super::expression::{Expression, Rows};
use crate::Enclosure;
use crate::coefficients::{Blend, Cell, Layout};
use crate::numbers::{DomainSide, Double, EPSILON, MAX_UNKNOWNS, Row};
use smallvec::SmallVec;
use sweepsim_spline::{Bernstein, BernsteinError, RationalBernstein};

/// The maximum number of coefficients of a system.
pub const MAX_SYSTEM: usize = 1 << 24;

/// One equation `f = 0`: a sum of Bernstein forms, with a bound on how much the sum differs from `f`.
///
/// Every form has as many variables as the system, on `[0,1]ⁿ` (see [`System::new`] and [`System::mapped`]). A form's own
/// [`error`](Bernstein::error) counts as an error of its coefficients.
#[derive(Clone, Debug)]
pub struct Equation {
    pub(crate) terms: Vec<Bernstein>,
    pub(crate) remainder: f64,
    pub(crate) slope_remainder: f64,
    /// The coefficients' second parts, for the only term.
    pub(crate) low: Option<Bernstein>,
    /// Instead of terms: a combination of equations.
    pub(crate) expression: Option<Expression>,
}

impl Equation {
    /// The sum of the forms. If the forms depend on different variables, bounds are sharper and cheaper to compute.
    #[must_use]
    pub fn sum(terms: Vec<Bernstein>) -> Self {
        Self {
            terms,
            remainder: 0.0,
            slope_remainder: 0.0,
            low: None,
            expression: None,
        }
    }

    /// A form whose coefficients are sums `high + low` of two numbers, each within `error` of the one meant: for polynomials whose expansion
    /// cancels, such as one with many roots close together. Coefficients are in the order of [`Bernstein::new`]. The search recomputes small boxes
    /// from both parts, in double-double precision.
    ///
    /// ```
    /// use sweepsim_solve::{Enclosure, Equation, PointSolver, System};
    ///
    /// // (x − 1/3)² − 2⁻⁶⁰ has coefficients 1/9 − 2⁻⁶⁰, −2/9 − 2⁻⁶⁰ and 4/9 − 2⁻⁶⁰, which a single number cannot hold well enough.
    /// let ninth = (1.0 / 9.0, 1.0 / 9.0 * 2f64.powi(-54));
    /// let pair = |k: f64| (k * ninth.0, k * ninth.1 - 2f64.powi(-60));
    /// let equation = Equation::of_pairs(&[2], &[pair(1.0), pair(-2.0), pair(4.0)], 1e-31)?;
    /// let system = System::new(&[Enclosure::UNIT], [equation])?;
    /// let points = PointSolver::default().solve(&system, &())?;
    /// assert_eq!((points.roots.len(), points.unresolved.len()), (2, 0));
    /// let apart = points.roots[1].point[0] - points.roots[0].point[0];
    /// assert!((apart / 2f64.powi(-29) - 1.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Bernstein::with_error`].
    pub fn of_pairs(degrees: &[usize], coefficients: &[(f64, f64)], error: f64) -> Result<Self, BernsteinError> {
        let whole: Vec<Double> = coefficients
            .iter()
            .map(|(high, low)| Double::of_sum(*high, *low))
            .collect();
        let high = whole.iter().map(|c| c.hi).collect();
        let low = whole.iter().map(|c| c.lo).collect();
        Ok(Self {
            low: Some(Bernstein::new(degrees, low)?),
            ..Self::sum(vec![Bernstein::with_error(degrees, high, error)?])
        })
    }

    /// `f` is any continuously differentiable function that differs from the forms' sum by at most `remainder` on the domain, and
    /// whose derivatives, with respect to coordinates in which the domain is `[0,1]ⁿ`, differ from the sum's by at most
    /// `slope_remainder`.
    #[must_use]
    pub fn with_remainder(mut self, remainder: f64, slope_remainder: f64) -> Self {
        self.remainder = remainder;
        self.slope_remainder = slope_remainder;
        self
    }

    /// The zeros of a component of a rational function are those of its numerator, since its weight is positive.
    #[must_use]
    pub fn component(rational: &RationalBernstein, component: usize) -> Option<Self> {
        rational.numerators().get(component).cloned().map(Self::from)
    }
}

impl From<Bernstein> for Equation {
    fn from(form: Bernstein) -> Self {
        Self::sum(vec![form])
    }
}

impl From<&Bernstein> for Equation {
    fn from(form: &Bernstein) -> Self {
        Self::sum(vec![form.clone()])
    }
}

/// Equations over a box, ready to be solved.
#[derive(Clone, Debug)]
pub struct System {
    pub(crate) layout: Layout,
    pub(crate) domain: SmallVec<[Enclosure; 4]>,
    sides: SmallVec<[DomainSide; 4]>,
    /// The region to search, in coordinates in which the domain is `[0,1]ⁿ`.
    pub(crate) region: (Row, Row),
    /// Whether some equation is known only on the domain.
    bounded: bool,
}

impl System {
    /// The system of these equations over a domain, given by one enclosure per variable. Forms live on `[0,1]ⁿ`, so that is the only domain
    /// allowed here. To write equations in the coordinates of another one, use [`of_formulas`](Self::of_formulas) or [`parse`](Self::parse); for forms
    /// whose coefficients already are those over another domain, [`mapped`](Self::mapped).
    ///
    /// # Errors
    ///
    /// See [`SystemError`]; [`SystemError::FormDomain`] for any domain other than `[0,1]ⁿ`.
    pub fn new<E: Into<Equation>>(
        domain: &[Enclosure],
        equations: impl IntoIterator<Item = E>,
    ) -> Result<Self, SystemError> {
        Self::check_domain(domain)?;
        if let Some(variable) = domain.iter().position(|side| *side != Enclosure::UNIT) {
            return Err(SystemError::FormDomain { variable });
        }
        Self::mapped(domain, equations)
    }

    /// The system of these equations over a domain to which `[0,1]ⁿ` is mapped: the forms' variables are `u = (x − lo)/(hi − lo)`, not the domain's
    /// coordinates `x`. Their coefficients are control values over the domain, as those of a spline's piece are.
    ///
    /// ```
    /// use sweepsim_solve::{Bernstein, Enclosure, PointSolver, System};
    ///
    /// // x² − 1 on [−2, 2] is 16 u² − 16 u + 3 in u = (x + 2)/4, with the control values 3, −5, 3.
    /// let form = Bernstein::new(&[2], vec![3.0, -5.0, 3.0])?;
    /// let system = System::mapped(&[Enclosure::new(-2.0, 2.0)?], [form])?;
    /// let points = PointSolver::default().solve(&system, &())?;
    /// assert!(points.roots[0].enclosure[0].contains(-1.0) && points.roots[1].enclosure[0].contains(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// See [`SystemError`].
    pub fn mapped<E: Into<Equation>>(
        domain: &[Enclosure],
        equations: impl IntoIterator<Item = E>,
    ) -> Result<Self, SystemError> {
        let n = domain.len();
        Self::check_domain(domain)?;
        let mut layout = Layout { n, ..Layout::default() };
        let mut rows = Rows::default();
        for (equation, given) in equations.into_iter().enumerate() {
            let given: Equation = given.into();
            if equation >= n {
                return Err(SystemError::TooManyEquations {
                    equations: equation + 1,
                    variables: n,
                });
            }
            rows.add(&mut layout, equation, &given)?;
            layout.m = equation + 1;
        }
        let bounded = rows.finish(&mut layout);
        if layout.m == 0 {
            return Err(SystemError::NoEquations);
        }
        layout.blend = Blend::new(&layout);
        Ok(Self {
            layout,
            domain: domain.into(),
            sides: domain.iter().map(|side| DomainSide::new(*side)).collect(),
            region: ([0.0; MAX_UNKNOWNS], [1.0; MAX_UNKNOWNS]),
            bounded,
        })
    }

    /// Checks that a domain has sides, neither too many nor empty or infinite ones.
    pub(crate) fn check_domain(domain: &[Enclosure]) -> Result<(), SystemError> {
        let n = domain.len();
        if n == 0 || n > MAX_UNKNOWNS {
            return Err(SystemError::Variables { variables: n });
        }
        for (variable, side) in domain.iter().enumerate() {
            let width = side.hi() - side.lo();
            let magnitude = side.lo().abs().max(side.hi().abs());
            if !(width.is_finite() && width > 64.0 * EPSILON * magnitude && width > f64::MIN_POSITIVE) {
                return Err(SystemError::Domain { variable });
            }
        }
        Ok(())
    }

    /// Restricts the search to a part of the domain. Roots on the boundary of that part count as boundary roots.
    ///
    /// # Errors
    ///
    /// [`SystemError::Region`], [`SystemError::Variables`].
    pub fn within(mut self, region: &[Enclosure]) -> Result<Self, SystemError> {
        if region.len() != self.domain.len() {
            return Err(SystemError::Variables {
                variables: region.len(),
            });
        }
        for (variable, (part, whole)) in region.iter().zip(&self.domain).enumerate() {
            let width = whole.hi() - whole.lo();
            let (lo, hi) = ((part.lo() - whole.lo()) / width, (part.hi() - whole.lo()) / width);
            if !(lo >= 0.0 && hi <= 1.0 && lo < hi) {
                return Err(SystemError::Region { variable });
            }
            self.region.0[variable] = lo;
            self.region.1[variable] = hi;
        }
        Ok(self)
    }

    /// A system over a face of a cell, in coordinates in which the face is `[0,1]ⁿ`.
    pub(crate) fn on_face(&self, cell: &Cell, variable: usize, upper: bool) -> Self {
        let layout = self.layout.face(cell, variable, upper);
        let n = layout.n;
        Self {
            layout,
            domain: SmallVec::from_elem(Enclosure::UNIT, n),
            sides: SmallVec::from_elem(DomainSide::UNIT, n),
            region: ([0.0; MAX_UNKNOWNS], [1.0; MAX_UNKNOWNS]),
            bounded: self.bounded,
        }
    }

    /// The number of variables.
    #[must_use]
    pub fn variables(&self) -> usize {
        self.layout.n
    }

    /// The number of equations.
    #[must_use]
    pub fn equations(&self) -> usize {
        self.layout.m
    }

    /// The domain, one enclosure per variable.
    #[must_use]
    pub fn domain(&self) -> &[Enclosure] {
        &self.domain
    }

    /// The number of coefficients that the solvers subdivide, after separating parts that depend on different variables.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        self.layout.len
    }

    /// A cell over the region.
    pub(crate) fn root(&self) -> Cell {
        let mut cell = self.layout.root();
        for j in 0..self.layout.n {
            self.layout.restrict(&mut cell, j, self.region.0[j], self.region.1[j]);
        }
        cell
    }

    /// An inner box in the domain's coordinates, rounded outwards.
    pub(crate) fn outward(&self, lo: &Row, hi: &Row) -> Vec<Enclosure> {
        let bounds = |(j, side): (usize, &DomainSide)| Enclosure::hull(side.below(lo[j]), side.above(hi[j]));
        self.sides.iter().enumerate().map(bounds).collect()
    }

    /// An inner box in the domain's coordinates, rounded inwards; `None` if no numbers are left on some side.
    pub(crate) fn inward(&self, lo: &Row, hi: &Row) -> Option<Vec<Enclosure>> {
        let bounds = |(j, side): (usize, &DomainSide)| Enclosure::new(side.above(lo[j]), side.below(hi[j])).ok();
        self.sides.iter().enumerate().map(bounds).collect()
    }

    /// Length of a side of the domain.
    pub(crate) fn domain_width(&self, variable: usize) -> f64 {
        self.domain[variable].hi() - self.domain[variable].lo()
    }

    /// Whether nothing is known outside the domain.
    pub(crate) fn bounded(&self) -> bool {
        self.bounded
    }

    /// An inner point in the domain's coordinates.
    pub(crate) fn outer_point(&self, s: &Row) -> Vec<f64> {
        let place = |(j, side): (usize, &Enclosure)| side.lo() + s[j] * (side.hi() - side.lo());
        self.domain.iter().enumerate().map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(n: usize) -> Vec<Enclosure> {
        vec![Enclosure::UNIT; n]
    }

    #[test]
    fn dense_sums_are_separated() {
        let p = Bernstein::from_fn(&[8, 0], |i| ((i[0] * 5) % 7) as f64 - 3.0).unwrap();
        let q = Bernstein::from_fn(&[0, 8], |i| ((i[1] * 3) % 5) as f64 - 2.0).unwrap();
        let dense = p.elevated_to(&[8, 8]).add(&q.elevated_to(&[8, 8]));
        let system = System::new(&unit(2), [&dense]).unwrap();
        assert_eq!(system.coefficients(), 18);
        let alone = System::new(&unit(2), [&p.elevated_to(&[8, 8])]).unwrap();
        assert_eq!(alone.coefficients(), 9);
    }

    #[test]
    fn mixed_forms_stay_whole() {
        let xy = Bernstein::new(&[1, 1, 0], vec![0.0, 0.0, 0.0, 1.0]).unwrap();
        let z = Bernstein::variable(3, 2);
        let system = System::new(&unit(3), [&xy.add(&z)]).unwrap();
        assert_eq!(system.coefficients(), 6);
        let as_sum = System::new(&unit(3), [Equation::sum(vec![xy.clone(), z, xy])]).unwrap();
        assert_eq!(as_sum.coefficients(), 6);
    }

    #[test]
    fn extreme_scales_are_normalised() {
        for factor in [1e-300, 1e300, 5e-324] {
            let x = Bernstein::new(&[1], vec![-factor, factor]).unwrap();
            let system = System::new(&unit(1), [&x]).unwrap();
            assert!(system.layout.first.iter().all(|c| (0.5..=2.0).contains(&c.abs())));
        }
    }
}
