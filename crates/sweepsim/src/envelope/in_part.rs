//! A map over a part of its domain, as if that were all of it: for methods whose forms are those of the part.

use crate::envelope::any_box::AnyBox;
use crate::time::over::DyadicInterval;
use sweepsim_solve::{Affine, ChartMap, Enclosure, Preimage, Sample, Sink, UnresolvedTarget};

/// A map over a part of its domain: its variables are the shares of the part.
pub(crate) struct InPart<'m, const N: usize, M> {
    map: &'m mut M,
    part: [DyadicInterval; N],
}

impl<'m, const N: usize, M> InPart<'m, N, M> {
    pub fn new(map: &'m mut M, part: [DyadicInterval; N]) -> Self {
        Self { map, part }
    }

    /// Derivatives, with what each variable of the map is in parts of another one.
    fn scaled(&self, jacobian: &[[Enclosure; N]; N], factor: impl Fn(&DyadicInterval) -> f64) -> [[Enclosure; N]; N] {
        jacobian.map(|row| {
            std::array::from_fn(|j| {
                let factor = factor(&self.part[j]);
                Enclosure::hull(row[j].lo() * factor, row[j].hi() * factor)
            })
        })
    }
}

/// The place in the domain of one in a part.
fn place<const N: usize>(part: &[DyadicInterval; N], x: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|j| part[j].time(x[j]))
}

/// The same for boxes.
fn whole<const N: usize>(part: &[DyadicInterval; N], bounds: &[Enclosure; N]) -> [Enclosure; N] {
    std::array::from_fn(|j| Enclosure::hull(part[j].time(bounds[j].lo()), part[j].time(bounds[j].hi())))
}

impl<const N: usize, M: AnyBox<N>> ChartMap<N> for InPart<'_, N, M> {
    type Cell = M::Cell;
    type Seen = M::Seen;

    fn bounds(&self, cell: &M::Cell) -> [Enclosure; N] {
        let bounds = self.map.bounds(cell);
        std::array::from_fn(|j| {
            let share = |x: f64| self.part[j].share(x);
            Enclosure::hull(share(bounds[j].lo()), share(bounds[j].hi()))
        })
    }

    fn values(&mut self, cell: &M::Cell) -> Option<[Enclosure; N]> {
        self.map.values(cell)
    }

    fn jacobian(&mut self, cell: &M::Cell) -> [[Enclosure; N]; N] {
        let jacobian = self.map.jacobian(cell);
        self.scaled(&jacobian, |part| part.length)
    }

    fn split(&mut self, cell: &M::Cell, axis: usize) -> [M::Cell; 2] {
        self.map.split(cell, axis)
    }

    fn sides(&self, cell: &M::Cell) -> Option<[Affine<N>; 2]> {
        self.map.sides(cell)
    }

    fn is_absent(&mut self, cell: &M::Cell, target: &[f64; N]) -> bool {
        self.map.is_absent(cell, target)
    }

    fn part(&mut self, cell: &M::Cell, values: &[Enclosure; N], jacobian: &[[Enclosure; N]; N]) -> Option<M::Cell> {
        let own = self.scaled(jacobian, |part| part.length.recip());
        self.map.part(cell, values, &own)
    }

    fn drop_part(&mut self, part: M::Cell) {
        self.map.drop_part(part);
    }

    fn begin(&mut self) {
        self.map.begin();
    }

    fn is_full(&self) -> bool {
        self.map.is_full()
    }

    fn keep(&mut self, cells: &mut [M::Cell]) {
        self.map.keep(cells);
    }

    fn evaluate(&self, x: &[f64; N]) -> Sample<N, M::Seen> {
        let mut sample = self.map.evaluate(&place(&self.part, x));
        for row in &mut sample.jacobian {
            for (slope, part) in row.iter_mut().zip(&self.part) {
                *slope *= part.length;
            }
        }
        sample
    }

    fn scales(&self) -> [f64; N] {
        self.map.scales()
    }

    fn rounding(&self) -> [f64; N] {
        self.map.rounding()
    }

    fn rounding_in(&self, cell: &Self::Cell) -> [f64; N] {
        self.map.rounding_in(cell)
    }
}

impl<const N: usize, M: AnyBox<N>> AnyBox<N> for InPart<'_, N, M> {
    fn root(&mut self) -> M::Cell {
        self.place(&[Enclosure::UNIT; N])
    }

    fn place(&mut self, bounds: &[Enclosure; N]) -> M::Cell {
        self.map.place(&whole(&self.part, bounds))
    }

    fn mark(&self) -> [usize; 2] {
        self.map.mark()
    }

    fn release(&mut self, mark: [usize; 2]) {
        self.map.release(mark);
    }
}

/// Passes solutions on, with their places in the whole domain.
pub(crate) struct OfPart<'s, const N: usize, K> {
    pub sink: &'s mut K,
    pub part: [DyadicInterval; N],
}

impl<const N: usize, S, K: Sink<N, S>> Sink<N, S> for OfPart<'_, N, K> {
    fn found(&mut self, mut preimage: Preimage<N, S>) {
        for x in [&mut preimage.x, &mut preimage.from] {
            *x = place(&self.part, x);
        }
        self.sink.found(preimage);
    }

    fn mark(&self) -> usize {
        self.sink.mark()
    }

    fn forget(&mut self, mark: usize) {
        self.sink.forget(mark);
    }

    fn forget_targets(&mut self, mark: usize, targets: &[usize]) {
        self.sink.forget_targets(mark, targets);
    }

    fn unresolved(&mut self, mut target: UnresolvedTarget<N>) {
        target.bounds = whole(&self.part, &target.bounds);
        self.sink.unresolved(target);
    }
}
