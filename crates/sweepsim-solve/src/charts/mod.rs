//! Charts: one subdivision for a whole family of systems `Φ(x) = q`.
//!
//! A box on which `Φ: R^N → R^N` is injective is a *chart*: it holds at most one preimage of each target `q`, and a
//! certificate found once serves all targets. The search
//!
//! 1. drops a box whose image holds no target;
//! 2. encloses the Jacobian over the box and preconditions it with the inverse `K` of its midpoint. With `R = |I − K J(box)|`
//!    (entrywise bound, in coordinates scaled to the box) every preimage `x` in the box satisfies, by the mean value theorem
//!    around the centre `m`, `|x − m + K(Φ(m) − q)| ≤ R·1` componentwise: targets that fail this have no preimage in the box;
//! 3. if the spectral radius of `R` is below 1, the box is a chart: two preimages `p, q` of one target would give `(I − K J*)(p − q) = p − q`, so
//!    that `|p − q| ≤ Rⁿ|p − q|` for all `n`. Newton's
//!    method finds the preimage, or the interval iteration of step 2 around ever better centres proves that there is none;
//! 4. otherwise splits the box.
//!
//! No preimage is lost: boxes too small to split further are reported as [`UnresolvedTarget`] with their targets.
//! Faces between boxes are half-open: a preimage belongs to the box above the face (so that, up to rounding, it is found once).

mod about;
mod chart;
mod faces;
mod linear;
mod narrow;
#[cfg(test)]
mod narrow_test;
mod neighbours;
mod region;
mod sides;
mod solver;
mod split;
mod wanted;

use crate::{Cause, Enclosure};
pub use sides::Affine;
pub(crate) use solver::BETWEEN;
pub use solver::ChartSolver;
pub(crate) use split::{collapses, largest, widest};

/// A map `R^N → R^N` with enclosures over boxes.
pub trait ChartMap<const N: usize> {
    /// A box, with any data that the map keeps for it.
    type Cell: Clone;

    /// Additional data at a point where the map was evaluated.
    type Seen: Clone;

    /// The box, one enclosure per variable.
    fn bounds(&self, cell: &Self::Cell) -> [Enclosure; N];

    /// Encloses `Φ` over the box; `None` if no solution in the box is of interest.
    fn values(&mut self, cell: &Self::Cell) -> Option<[Enclosure; N]>;

    /// Encloses `∂Φᵢ/∂xⱼ` over the box, as `[i][j]`.
    fn jacobian(&mut self, cell: &Self::Cell) -> [[Enclosure; N]; N];

    /// The two parts of the box, cut across `axis`; the first is the lower one.
    fn split(&mut self, cell: &Self::Cell, axis: usize) -> [Self::Cell; 2];

    /// Two functions over the box, if only those solutions are of interest where exactly one of them is negative (0 is not). Others need not be found.
    fn sides(&self, _cell: &Self::Cell) -> Option<[Affine<N>; 2]> {
        None
    }

    /// Whether the box certainly holds no preimage of this target, by a bound that is better than that of [`values`](Self::values) where `∂Φ` is
    /// singular. Asked for boxes that hold few targets.
    fn is_absent(&mut self, _cell: &Self::Cell, _target: &[f64; N]) -> bool {
        false
    }

    /// A part of the box that holds the preimages of all targets, kept until it is [dropped](Self::drop_part), where that is much smaller than the box. Asked for boxes
    /// that hold few targets and where `∂Φ` may be singular, with their enclosures.
    fn part(
        &mut self,
        _cell: &Self::Cell,
        _values: &[Enclosure; N],
        _jacobian: &[[Enclosure; N]; N],
    ) -> Option<Self::Cell> {
        None
    }

    /// A part of the box that holds the preimages of all targets, however many they are, if it is much smaller than the box. It is searched instead. Asked for boxes
    /// where `∂Φ` may be singular, with their enclosures.
    fn remainder(
        &mut self,
        _cell: &Self::Cell,
        _values: &[Enclosure; N],
        _jacobian: &[[Enclosure; N]; N],
    ) -> Option<[Enclosure; N]> {
        None
    }

    /// Drops the last part asked for.
    fn drop_part(&mut self, _part: Self::Cell) {}

    /// A part of the box that holds the preimages of all targets in the range, by a bound that is better than that of derivatives where `∂Φ` is singular. A face of the
    /// part is one of the box, or farther from all preimages than rounding can tell. Asked for boxes that hold few targets and where `∂Φ` may be singular.
    fn clipped(&mut self, _cell: &Self::Cell, _range: &[Enclosure; N]) -> Option<[Enclosure; N]> {
        None
    }

    /// A separate cell over a part of the box, kept until it is [dropped](Self::drop_narrowed), if the map has such cells. Asked for boxes that hold few targets and where
    /// `∂Φ` may be singular, and for parts that hold all their preimages.
    fn narrowed(&mut self, _cell: &Self::Cell, _part: &[Enclosure; N]) -> Option<Self::Cell> {
        None
    }

    /// Drops the last of these cells, and the parts that it was split into.
    fn drop_narrowed(&mut self, _cell: Self::Cell) {}

    /// A search begins.
    fn begin(&mut self) {}

    /// Whether so many cells have been made since the search [began](Self::begin) that [`keep`](Self::keep) is to be called.
    fn is_full(&self) -> bool {
        false
    }

    /// Drops the cells made since the search began, except for these, which are all that it still needs. They may be replaced by others over the same boxes, with the same
    /// order of creation.
    fn keep(&mut self, _cells: &mut [Self::Cell]) {}

    /// Encloses the product of `matrix` and `∂Φ` over the box, if that can be done more closely than by multiplying enclosures, because values depend on each
    /// other. Asked for boxes that hold few targets and where `∂Φ` is nearly singular. Rounding may be left out.
    fn combined_jacobian(&mut self, _cell: &Self::Cell, _matrix: &[[f64; N]; N]) -> Option<[[Enclosure; N]; N]> {
        None
    }

    /// Encloses the derivatives over the box of another function with the same zeros as `Φ − q` for one target `q`, if they are known more closely: of `C(x) (Φ(x) − q)`, where `C` has a positive
    /// determinant all over the box, and is the identity at the point `at` of it. Asked for boxes that hold one target and where `∂Φ` may be singular.
    fn jacobian_about(
        &mut self,
        _cell: &Self::Cell,
        _target: &[f64; N],
        _at: &[f64; N],
    ) -> Option<[[Enclosure; N]; N]> {
        None
    }

    /// `q + C(x) (Φ(x) − q)` at a point, with its derivatives: see [`jacobian_about`](Self::jacobian_about).
    fn evaluate_about(&self, x: &[f64; N], _target: &[f64; N], _at: &[f64; N]) -> Sample<N, Self::Seen> {
        self.evaluate(x)
    }

    /// `Φ` at a point, if it costs much less without derivatives. As accurate as by [`evaluate`](Self::evaluate).
    fn value(&self, _x: &[f64; N]) -> Option<[f64; N]> {
        None
    }

    /// `Φ` and `∂Φᵢ/∂xⱼ` at a point, which may lie a little outside the domain.
    fn evaluate(&self, x: &[f64; N]) -> Sample<N, Self::Seen>;

    /// A typical size of each value, for choosing the direction of splits.
    fn scales(&self) -> [f64; N];

    /// How far each value of [`ChartMap::evaluate`] may be off by rounding.
    fn rounding(&self) -> [f64; N];

    /// The same in one cell, if less is known of it.
    fn rounding_in(&self, _cell: &Self::Cell) -> [f64; N] {
        self.rounding()
    }
}

/// A map at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const N: usize, S> {
    /// `Φ`.
    pub value: [f64; N],
    /// `∂Φᵢ/∂xⱼ` as `[i][j]`.
    pub jacobian: [[f64; N]; N],
    /// Additional data.
    pub seen: S,
}

/// A right-hand side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartTarget<const N: usize> {
    /// Its number.
    pub number: usize,
    /// Row and position in the row. Evenly spaced neighbours are solved faster.
    pub place: [usize; 2],
    /// `q`.
    pub value: [f64; N],
}

/// A set of right-hand sides with a range query, in rows: the targets of a row differ only in their second value.
pub trait Targets<const N: usize> {
    /// The number of targets in the range.
    fn count(&self, range: &[Enclosure; N]) -> usize;

    /// Calls `visit` with each target in the range, row by row and upwards in each row, until it returns `false`. For each row, `narrow` is
    /// called with the lowest target, and returns the range of second values that are needed, if any.
    fn visit(
        &self,
        range: &[Enclosure; N],
        narrow: &dyn Fn(&[f64; N]) -> Option<Enclosure>,
        visit: &mut dyn FnMut(&ChartTarget<N>) -> bool,
    );
}

/// Does not narrow rows.
pub(crate) fn all_of<const N: usize>(_: &[f64; N]) -> Option<Enclosure> {
    Some(Enclosure::WHOLE)
}

/// A solution `Φ(x) = q` of one target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preimage<const N: usize, S = ()> {
    /// The target's number.
    pub target: usize,
    /// The solution.
    pub x: [f64; N],
    /// The previous iterate of Newton's method.
    pub from: [f64; N],
    /// Additional data of the map there.
    pub seen: S,
    /// The sign of `det ∂Φ` there: 1 or −1.
    pub orientation: i8,
}

/// A box that may hold further solutions for a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnresolvedTarget<const N: usize> {
    /// The target's number.
    pub target: usize,
    /// The box.
    pub bounds: [Enclosure; N],
    /// Why.
    pub cause: Cause,
}

/// Receives the results of a search.
pub trait Sink<const N: usize, S = ()> {
    /// A solution.
    fn found(&mut self, preimage: Preimage<N, S>);
    /// A mark for [`forget`](Sink::forget).
    fn mark(&self) -> usize;
    /// Discards the solutions since the mark: their box is searched again in parts.
    fn forget(&mut self, mark: usize);
    /// Discards the solutions of these targets (in order) since the mark: they are searched for in another way.
    fn forget_targets(&mut self, mark: usize, targets: &[usize]);
    /// A box that may hold further solutions for a target.
    fn unresolved(&mut self, target: UnresolvedTarget<N>);
}

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ChartOptions {
    /// The maximum number of boxes per call.
    pub boxes: u64,
    /// Boxes whose sides are all smaller than this fraction of the domain are not split further.
    pub smallest: f64,
    /// Newton's method ends with a step that leaves an error of about the square of this, in parts of the domain.
    pub accept: f64,
}

impl Default for ChartOptions {
    fn default() -> Self {
        Self {
            boxes: 400_000,
            smallest: 1e-14,
            accept: 1e-8,
        }
    }
}

impl ChartOptions {
    /// Sets [`boxes`](Self::boxes).
    #[must_use]
    pub const fn boxes(mut self, boxes: u64) -> Self {
        self.boxes = boxes;
        self
    }

    /// Sets [`smallest`](Self::smallest).
    #[must_use]
    pub const fn smallest(mut self, smallest: f64) -> Self {
        self.smallest = smallest;
        self
    }

    /// Sets [`accept`](Self::accept).
    #[must_use]
    pub const fn accept(mut self, accept: f64) -> Self {
        self.accept = accept;
        self
    }
}

/// What a search did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ChartStatistics {
    /// Boxes examined.
    pub boxes: u64,
    /// Of these, the number that were charts.
    pub charts: u64,
    /// Evaluations of the map.
    pub evaluations: u64,
}
