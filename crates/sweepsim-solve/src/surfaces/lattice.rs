//! The planes across which the octree is cut.

use super::octree::{FINEST, OctreeNode};
use crate::coefficients::Cell;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row};
use crate::{Enclosure, System};

/// The lattice of the octree's planes over a system's region.
pub(crate) struct PlaneLattice<'a> {
    pub system: &'a System,
    pub lo: [f64; 3],
    pub hi: [f64; 3],
    /// The original coefficients, for values anywhere.
    pub first: Cell,
}

impl<'a> PlaneLattice<'a> {
    /// The lattice over a system's region.
    pub(crate) fn new(system: &'a System) -> Self {
        let root = system.root();
        Self {
            system,
            lo: [root.lo[0], root.lo[1], root.lo[2]],
            hi: [root.hi[0], root.hi[1], root.hi[2]],
            first: system.layout.root(),
        }
    }

    /// The position of a lattice plane, in the domain's inner coordinates: nearly evenly spaced, with exact ends.
    pub(crate) fn place(&self, axis: usize, at: u32) -> f64 {
        if at == 0 {
            return self.lo[axis];
        }
        if at == 1 << FINEST {
            return self.hi[axis];
        }
        let s = f64::from(at) / f64::from(1u32 << FINEST);
        let bend = -0.0313 + 0.0047 * axis as f64;
        self.lo[axis] + (s + bend * s * (1.0 - s)) * (self.hi[axis] - self.lo[axis])
    }

    /// A node's box in inner coordinates.
    pub(crate) fn bounds(&self, node: &OctreeNode) -> (Row, Row) {
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        for j in 0..3 {
            lo[j] = self.place(j, node.corner[j]);
            hi[j] = self.place(j, node.corner[j] + node.side());
        }
        (lo, hi)
    }

    /// The sign of the equation at a point, 0 if it is not certain.
    pub(crate) fn sign(&self, x: &Row, buffer: &mut Vec<f64>) -> i8 {
        let value = self.system.layout.values(&self.first.c, x, buffer);
        let error = self.system.layout.value_error(&self.first, 0) + 4.0 * EPSILON * value[0].abs();
        if value[0] > error {
            1
        } else if value[0] < -error {
            -1
        } else {
            0
        }
    }

    /// A point in the domain's coordinates.
    pub(crate) fn outer(&self, x: &Row) -> [f64; 3] {
        let p = self.system.outer_point(x);
        [p[0], p[1], p[2]]
    }

    /// The system's domain.
    pub(crate) fn domain(&self) -> &[Enclosure] {
        self.system.domain()
    }
}
