//! 1-D: the curves of `n − 1` equations in `n` unknowns, with the right connectivity.
//!
//! A cell is settled when, for some variable `x_k`, the equations with `x_k` fixed have at most one solution in it: with `J_k` the
//! Jacobian with respect to the other variables and `K ≈ J_k⁻¹`, when `‖I − K J_k‖∞ < 1` over the cell. Then the curve in the cell
//! is a graph over a part of the `x_k` axis: there is no loop, its pieces follow one another in `x_k`, and their ends are the curve's
//! crossings of the cell's faces. Sorted by `x_k`, the crossings are first end, second end, first end, and so on: nothing is joined by distance.
//!
//! Crossings are 0-D solutions on faces, each certified simple, hence transversal. The face between two cells is searched **once**, when
//! a split creates it; both cells get the same points. A split avoids all known crossings, and is moved if the search on it leaves
//! boxes open (at a tangency, or at a singular point on it).
//!
//! Where the curve is tangent to the region's own boundary, or passes through one of its edges or corners, the region is enlarged by a skin
//! (see [`Curves::skin`]); pieces that lie only in the skin are replaced by boxes of [`Cause::Skin`] where they may touch the region.
//!
//! Cells at the smallest size stay open. They are singular points (nodes, cusps, isolated points), whose branches are the crossings of their outer faces.

mod assemble;
mod cubic;
mod faces;
mod graph;
#[cfg(feature = "rayon")]
mod parallel;
mod strand;
mod subdivide;
mod trace;

use crate::numbers::MAX_UNKNOWNS;
use crate::points::PointSolver;
use crate::search::{Cause, SolveError, SolveOptions, SolveStatistics};
use crate::{Enclosure, Monitor, System};
use std::time::Instant;
use subdivide::Search;
use trace::Tracer;

/// A point of a polyline.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CurvePoint {
    /// The point.
    pub point: Vec<f64>,
    /// The unit tangent, in the polyline's direction.
    pub tangent: Vec<f64>,
}

/// Where an arc ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveEnd {
    /// On the region's boundary.
    Boundary,
    /// At the singular or unresolved box with this number.
    Singular(usize),
}

/// A component of the curve without its singular points, as a polyline within the tolerance.
///
/// Its direction is that of the wedge product of the equations' gradients (`∇f × ∇g` for two equations in three unknowns, `(f_y, −f_x)` for
/// one in two).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Curve {
    /// The vertices, on the curve up to rounding. The first vertex of a loop is not repeated at its end.
    pub points: Vec<CurvePoint>,
    /// For [`CurveShape::Cubics`], one for each segment between vertices: the distances of its two inner control points from its ends. Empty for chords.
    pub handles: Vec<[f64; 2]>,
    /// `None` for a loop.
    pub ends: Option<[CurveEnd; 2]>,
}

impl Curve {
    /// The number of segments.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.points.len().saturating_sub(usize::from(self.ends.is_some()))
    }

    /// The control points of the cubic Bézier curve from a vertex to the next one; `None` for chords, or if there is no such segment.
    #[must_use]
    pub fn cubic(&self, segment: usize) -> Option<[Vec<f64>; 4]> {
        let [first, second] = *self.handles.get(segment)?;
        let (from, to) = (
            self.points.get(segment)?,
            &self.points[(segment + 1) % self.points.len()],
        );
        let along = |p: &CurvePoint, by: f64| p.point.iter().zip(&p.tangent).map(|(x, t)| x + by * t).collect();
        Some([
            from.point.clone(),
            along(from, first),
            along(to, -second),
            to.point.clone(),
        ])
    }
}

/// What curves are made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveShape {
    /// Chords between vertices: as many as the square root of the inverse tolerance.
    #[default]
    Chords,
    /// Cubic Bézier curves between vertices, with common tangents there: far fewer, between the fourth and the sixth root.
    Cubics,
}

/// A piece of the curve in one box of the subdivision.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CurvePiece {
    /// Numbers of its two end points. Each is shared with at most one other piece.
    pub ends: [usize; 2],
    /// The vertices, both ends among them, in the direction of the curve.
    pub points: Vec<CurvePoint>,
    /// As in [`Curve::handles`].
    pub handles: Vec<[f64; 2]>,
}

/// A box in which the curve may be singular, or could not be resolved.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Singular {
    /// The box. Adjacent boxes are merged.
    pub bounds: Vec<Enclosure>,
    /// Why it is open.
    pub cause: Cause,
    /// The arcs that end here, with `true` if it is the arc's last vertex. If there are none, the box holds an isolated point or nothing.
    pub branches: Vec<(usize, bool)>,
}

/// All curves of a system in its region.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Curves {
    /// The components.
    pub curves: Vec<Curve>,
    /// Singular and unresolved boxes. Outside these, `curves` is complete.
    pub singular: Vec<Singular>,
    /// The fraction of the domain by which the region was enlarged because the curve touches its boundary. Usually 0.
    pub skin: f64,
    /// Statistics of the search.
    pub statistics: SolveStatistics,
}

impl Curves {
    /// The closed components.
    pub fn loops(&self) -> impl Iterator<Item = &Curve> {
        self.curves.iter().filter(|c| c.ends.is_none())
    }

    /// The components with ends.
    pub fn arcs(&self) -> impl Iterator<Item = &Curve> {
        self.curves.iter().filter(|c| c.ends.is_some())
    }
}

/// The 1-D solver.
///
/// ```
/// use sweepsim_solve::{Bernstein, CurveSolver, Enclosure, System};
///
/// // x² + y² = 1/4 on [−1, 1]². In u = (x + 1)/2: x² = 4 u² − 4 u + 1 has coefficients 1, −1, 1.
/// let square = |axis| Bernstein::from_fn(&[2, 2], |i| [1.0, -1.0, 1.0][i[axis]]).unwrap();
/// let circle = square(0).add(&square(1)).sub(&Bernstein::constant(2, 0.25));
/// let system = System::mapped(&[Enclosure::new(-1.0, 1.0)?; 2], [&circle])?;
/// let curves = CurveSolver::new(1e-3).solve(&system, &())?;
/// assert_eq!((curves.loops().count(), curves.arcs().count()), (1, 0));
/// for p in &curves.curves[0].points {
///     assert!((p.point[0].hypot(p.point[1]) - 0.5).abs() < 1e-14);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct CurveSolver {
    /// Limits. [`smallest`](SolveOptions::smallest) is the size at which a cell counts as singular; 1e-9 by default here.
    /// [`vertices`](SolveOptions::vertices) is 2²⁰ by default here; [`for_each_piece`](Self::for_each_piece) counts only those of one piece.
    pub options: SolveOptions,
    /// The largest distance of the polylines from the curve, and of the curve from them, in the domain's units; plus the amount by which rounding
    /// errors (and stated errors) of the coefficients move the curve.
    pub tolerance: f64,
    /// Chords or cubics between vertices.
    pub shape: CurveShape,
    points: PointSolver,
}

impl CurveSolver {
    /// Creates a solver with the default limits and this tolerance for the polylines.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        let options = SolveOptions {
            smallest: 1e-9,
            vertices: 1 << 20,
            ..SolveOptions::default()
        };
        Self::with_options(tolerance, options)
    }

    /// Creates a solver with this tolerance and these limits.
    #[must_use]
    pub fn with_options(tolerance: f64, options: SolveOptions) -> Self {
        Self {
            options,
            tolerance,
            shape: CurveShape::default(),
            points: PointSolver::default(),
        }
    }

    /// Makes the curves of cubics instead of chords.
    ///
    /// ```
    /// use sweepsim_solve::{CurveSolver, Enclosure, System};
    ///
    /// let domain = [Enclosure::new(-2.0, 2.0)?; 2];
    /// let system = System::parse(&["x^2 + y^2 = 1"], &["x", "y"], &domain)?;
    /// let curves = CurveSolver::new(1e-10).cubics().solve(&system, &())?;
    /// let circle = &curves.curves[0];
    /// assert!(circle.segments() < 400);
    /// let [a, b, c, d] = circle.cubic(0).ok_or("no segment")?;
    /// // Its middle is within the tolerance of the circle.
    /// let middle = |j: usize| (a[j] + 3.0 * b[j] + 3.0 * c[j] + d[j]) / 8.0;
    /// assert!((middle(0).hypot(middle(1)) - 1.0).abs() < 1e-10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn cubics(mut self) -> Self {
        self.shape = CurveShape::Cubics;
        self
    }

    /// All curves of the system in its region.
    ///
    /// # Errors
    ///
    /// [`SolveError::Variables`] unless there are 2 to [`MAX_UNKNOWNS`](crate::MAX_UNKNOWNS) variables, [`SolveError::Equations`] unless
    /// there is one equation fewer, [`SolveError::Smallest`] for an invalid size or tolerance.
    pub fn solve(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Curves, SolveError> {
        self.check(system)?;
        let mut search = self.search(system, monitor);
        let (root, first, skin) = search.boundary(monitor);
        search.run((root, 0), first, monitor, &mut |_, _| {});
        Ok(search.assemble(skin))
    }

    /// Checks that the system and the limits are valid.
    fn check(&self, system: &System) -> Result<(), SolveError> {
        let (n, m) = (system.layout.n, system.layout.m);
        if n < 2 {
            return Err(SolveError::Variables {
                variables: n,
                least: 2,
                most: MAX_UNKNOWNS,
            });
        }
        if m != n - 1 {
            return Err(SolveError::Equations {
                equations: m,
                variables: n,
                expected: n - 1,
            });
        }
        let possible = (1e-14..=1.0).contains(&self.options.smallest) && self.tolerance > 0.0;
        if !possible {
            return Err(SolveError::Smallest);
        }
        Ok(())
    }

    fn search<'a>(&'a mut self, system: &'a System, monitor: &'a dyn Monitor) -> Search<'a> {
        self.points.options = SolveOptions {
            smallest: 1e-8,
            boxes: self.options.boxes.min(20_000),
            unresolved: 64,
            ..SolveOptions::default()
        };
        Search {
            system,
            options: self.options.clone(),
            points: &mut self.points,
            tracer: Tracer::new(system, (self.tolerance, self.shape), &self.options, monitor),
            crossings: Vec::new(),
            pieces: Vec::new(),
            open: Vec::new(),
            statistics: SolveStatistics::default(),
            ranges: crate::coefficients::PartRanges::default(),
            deadline: self.options.time.and_then(|t| Instant::now().checked_add(t)),
        }
    }

    /// As [`solve`](Self::solve), but calls `visit` with each component.
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn for_each(
        &mut self,
        system: &System,
        monitor: &dyn Monitor,
        mut visit: impl FnMut(&Curve),
    ) -> Result<Vec<Singular>, SolveError> {
        let curves = self.solve(system, monitor)?;
        curves.curves.iter().for_each(&mut visit);
        Ok(curves.singular)
    }

    /// As [`solve`](Self::solve), but calls `visit` with each piece as soon as it is found, so that polylines need not be stored. Pieces come in no
    /// particular order. Ends with the same number in [`CurvePiece::ends`] are the same point, which tells how to join pieces.
    ///
    /// The result holds only unresolved boxes, without branches, and the statistics. If its [`skin`](Curves::skin) is not 0, pieces may leave the
    /// region by that much.
    ///
    /// ```
    /// use sweepsim_solve::{Bernstein, CurveSolver, Enclosure, System};
    ///
    /// let square = |axis| Bernstein::from_fn(&[2, 2], |i| [1.0, -1.0, 1.0][i[axis]]).unwrap();
    /// let circle = square(0).add(&square(1)).sub(&Bernstein::constant(2, 0.25));
    /// let system = System::mapped(&[Enclosure::new(-1.0, 1.0)?; 2], [&circle])?;
    /// let mut length = 0.0;
    /// let rest = CurveSolver::new(1e-4).for_each_piece(&system, &(), |piece| {
    ///     for p in piece.points.windows(2) {
    ///         length += (p[0].point[0] - p[1].point[0]).hypot(p[0].point[1] - p[1].point[1]);
    ///     }
    /// })?;
    /// assert!((length - std::f64::consts::PI).abs() < 1e-3 && rest.singular.is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn for_each_piece(
        &mut self,
        system: &System,
        monitor: &dyn Monitor,
        mut visit: impl FnMut(CurvePiece),
    ) -> Result<Curves, SolveError> {
        self.check(system)?;
        let mut search = self.search(system, monitor);
        let (root, first, skin) = search.boundary(monitor);
        search.run((root, 0), first, monitor, &mut |tracer, pieces| {
            for piece in pieces.drain(..) {
                tracer.room += piece.trace.vertices.len();
                visit(CurvePiece {
                    ends: piece.ends,
                    points: piece.trace.vertices.iter().map(|v| tracer.outer(v)).collect(),
                    handles: piece.trace.handles,
                });
            }
        });
        Ok(search.assemble(skin))
    }
}
