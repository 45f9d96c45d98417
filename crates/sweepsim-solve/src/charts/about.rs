//! Evaluations of a map in a chart: of the map itself, or of another one with the same solutions for one target.

use super::faces::Searched;
use super::linear::Linear;
use super::solver::LIMIT;
use super::wanted::only;
use super::{ChartMap, ChartSolver, Sample, Sink, Targets};
use crate::{Enclosure, Monitor};
use nalgebra::{Const, DimMin, ToTypenum};

/// What Newton's method in a chart asks for.
pub(super) trait Points<const N: usize> {
    /// As of [`ChartMap`].
    type Seen: Clone;

    /// As [`ChartMap::value`].
    fn value(&self, x: &[f64; N]) -> Option<[f64; N]>;

    /// As [`ChartMap::evaluate`].
    fn evaluate(&self, x: &[f64; N]) -> Sample<N, Self::Seen>;
}

impl<const N: usize, M: ChartMap<N>> Points<N> for M {
    type Seen = M::Seen;

    #[inline(always)]
    fn value(&self, x: &[f64; N]) -> Option<[f64; N]> {
        ChartMap::value(self, x)
    }

    #[inline(always)]
    fn evaluate(&self, x: &[f64; N]) -> Sample<N, M::Seen> {
        ChartMap::evaluate(self, x)
    }
}

/// `q + C (Φ − q)` for one target `q`, in place of `Φ`: see [`ChartMap::jacobian_about`].
pub(super) struct About<'a, const N: usize, M> {
    pub map: &'a M,
    pub target: [f64; N],
    /// Where `C` is the identity.
    pub at: [f64; N],
}

impl<const N: usize, M: ChartMap<N>> Points<N> for About<'_, N, M> {
    type Seen = M::Seen;

    fn value(&self, _: &[f64; N]) -> Option<[f64; N]> {
        None
    }

    fn evaluate(&self, x: &[f64; N]) -> Sample<N, M::Seen> {
        self.map.evaluate_about(x, &self.target, &self.at)
    }
}

impl<C: Clone> ChartSolver<C> {
    /// Solves the only target of a box in a chart of the other system; `false` if there are more targets, if the box is no such chart, or if the target stays undecided.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn about<const N: usize, M, T, S>(
        &mut self,
        map: &mut M,
        cell: &C,
        bounds: &[Enclosure; N],
        searched: &Searched<N>,
        values: &[Enclosure; N],
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) -> bool
    where
        M: ChartMap<N, Cell = C>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let Some(target) = only(targets, values) else {
            return false;
        };
        let at = bounds.map(Enclosure::mid);
        let Some(slopes) = map.jacobian_about(cell, &target, &at) else {
            return false;
        };
        let linear = Linear::new(bounds, &slopes, &map.rounding_in(cell)).filter(|linear| linear.radius < LIMIT);
        let Some((linear, contraction)) = linear.and_then(|linear| linear.contraction().map(|own| (linear, own)))
        else {
            return false;
        };
        let points = About { map: &*map, target, at };
        let value = points.evaluate(&at).value;
        self.statistics.evaluations += 1;
        let is_settled = self.chart(
            &points,
            None,
            &linear,
            &contraction,
            bounds,
            searched,
            &value,
            values,
            targets,
            sink,
            monitor,
        );
        self.statistics.charts += u64::from(is_settled);
        is_settled
    }
}
