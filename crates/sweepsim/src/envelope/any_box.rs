//! Maps over arbitrary boxes, not just those created by subdivision.

use crate::envelope::edge_map::EdgeMap;
use crate::envelope::enclosures::ROOT;
use crate::envelope::patch_map::PatchMap;
use crate::envelope::placed_map::PlacedMap;
use sweepsim_solve::{ChartMap, Enclosure};

/// A map that can be enclosed over any box of its domain.
pub(crate) trait AnyBox<const N: usize>: ChartMap<N> {
    /// The cell over the whole domain.
    fn root(&mut self) -> Self::Cell;

    /// A cell over any box, kept until it is released.
    fn place(&mut self, bounds: &[Enclosure; N]) -> Self::Cell;

    /// The number of cells, as a mark for releasing later ones.
    fn mark(&self) -> [usize; 2];

    /// Drops the cells placed since the mark.
    fn release(&mut self, mark: [usize; 2]);
}

impl AnyBox<3> for PatchMap<'_> {
    fn root(&mut self) -> Self::Cell {
        ROOT
    }

    fn place(&mut self, [u, v, t]: &[Enclosure; 3]) -> Self::Cell {
        let cell = self.cells.place(self.element, [u.lo(), v.lo()], [u.hi(), v.hi()]);
        (cell, self.times.place(t.lo(), t.hi()))
    }

    fn mark(&self) -> [usize; 2] {
        [self.cells.mark(), self.times.mark()]
    }

    fn release(&mut self, [cells, times]: [usize; 2]) {
        self.cells.release(cells);
        self.times.release(times);
    }
}

impl AnyBox<2> for EdgeMap<'_> {
    fn root(&mut self) -> Self::Cell {
        ROOT
    }

    fn place(&mut self, [r, t]: &[Enclosure; 2]) -> Self::Cell {
        let cell = self.cells.place(self.element, [r.lo(), 0.0], [r.hi(), 1.0]);
        (cell, self.times.place(t.lo(), t.hi()))
    }

    fn mark(&self) -> [usize; 2] {
        [self.cells.mark(), self.times.mark()]
    }

    fn release(&mut self, [cells, times]: [usize; 2]) {
        self.cells.release(cells);
        self.times.release(times);
    }
}

impl AnyBox<2> for PlacedMap<'_> {
    fn root(&mut self) -> Self::Cell {
        0
    }

    fn place(&mut self, [u, v]: &[Enclosure; 2]) -> Self::Cell {
        self.cells.place(self.element, [u.lo(), v.lo()], [u.hi(), v.hi()])
    }

    fn mark(&self) -> [usize; 2] {
        [self.cells.mark(), 0]
    }

    fn release(&mut self, [cells, _]: [usize; 2]) {
        self.cells.release(cells);
    }
}
