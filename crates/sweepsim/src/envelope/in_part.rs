//! A map over a part of a motion, as if that were all of it: for methods whose forms are those of the part.

use crate::envelope::any_box::AnyBox;
use crate::time::over::Part;
use sweepsim_solve::{Affine, ChartMap, Enclosure, Preimage, Sample, Sink, UnresolvedTarget};

/// A map whose last variable is the time, over a part of it: the variable is the share of the part.
pub(crate) struct InPart<'m, M> {
    map: &'m mut M,
    part: Part,
}

impl<'m, M> InPart<'m, M> {
    pub fn new(map: &'m mut M, part: Part) -> Self {
        Self { map, part }
    }
}

impl<const N: usize, M: AnyBox<N>> ChartMap<N> for InPart<'_, M> {
    type Cell = M::Cell;
    type Seen = M::Seen;

    fn bounds(&self, cell: &M::Cell) -> [Enclosure; N] {
        let mut bounds = self.map.bounds(cell);
        let time = bounds[N - 1];
        bounds[N - 1] = Enclosure::hull(self.part.share(time.lo()), self.part.share(time.hi()));
        bounds
    }

    fn values(&mut self, cell: &M::Cell) -> Option<[Enclosure; N]> {
        self.map.values(cell)
    }

    fn jacobian(&mut self, cell: &M::Cell) -> [[Enclosure; N]; N] {
        let mut jacobian = self.map.jacobian(cell);
        for row in &mut jacobian {
            let slope = row[N - 1];
            row[N - 1] = Enclosure::hull(slope.lo() * self.part.length, slope.hi() * self.part.length);
        }
        jacobian
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
        let mut own = *jacobian;
        for row in &mut own {
            let slope = row[N - 1];
            row[N - 1] = Enclosure::hull(slope.lo() / self.part.length, slope.hi() / self.part.length);
        }
        self.map.part(cell, values, &own)
    }

    fn drop_part(&mut self, part: M::Cell) {
        self.map.drop_part(part);
    }

    fn evaluate(&self, x: &[f64; N]) -> Sample<N, M::Seen> {
        let mut at = *x;
        at[N - 1] = self.part.time(x[N - 1]);
        let mut sample = self.map.evaluate(&at);
        for row in &mut sample.jacobian {
            row[N - 1] *= self.part.length;
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

impl<const N: usize, M: AnyBox<N>> AnyBox<N> for InPart<'_, M> {
    fn root(&mut self) -> M::Cell {
        self.place(&[Enclosure::UNIT; N])
    }

    fn place(&mut self, bounds: &[Enclosure; N]) -> M::Cell {
        let mut own = *bounds;
        let share = own[N - 1];
        own[N - 1] = Enclosure::hull(self.part.time(share.lo()), self.part.time(share.hi()));
        self.map.place(&own)
    }

    fn mark(&self) -> [usize; 2] {
        self.map.mark()
    }

    fn release(&mut self, mark: [usize; 2]) {
        self.map.release(mark);
    }
}

/// Passes solutions on, with the times of the whole motion.
pub(crate) struct OfPart<'s, K> {
    pub sink: &'s mut K,
    pub part: Part,
}

impl<const N: usize, S, K: Sink<N, S>> Sink<N, S> for OfPart<'_, K> {
    fn found(&mut self, mut preimage: Preimage<N, S>) {
        for x in [&mut preimage.x, &mut preimage.from] {
            x[N - 1] = self.part.time(x[N - 1]);
        }
        self.sink.found(preimage);
    }

    fn mark(&self) -> usize {
        self.sink.mark()
    }

    fn forget(&mut self, mark: usize) {
        self.sink.forget(mark);
    }

    fn unresolved(&mut self, mut target: UnresolvedTarget<N>) {
        let share = target.bounds[N - 1];
        target.bounds[N - 1] = Enclosure::hull(self.part.time(share.lo()), self.part.time(share.hi()));
        self.sink.unresolved(target);
    }
}
