//! The solid that must not be cut.

mod cell;
mod outside;
mod polygon;
mod way;

pub(crate) use cell::{Cell, MOST_PIECES, MOST_PLANES, MOST_WAYS, Near};
pub(crate) use outside::is_outside;
pub(crate) use way::{Normal, Triangle, Way, Written};

use nalgebra::Vector3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{PoisonError, RwLock};
use sweepsim_dexel::{DistanceTo, MeshError, TriangleSoup};

/// A solid between closed triangles, prepared for proofs.
#[derive(Debug)]
pub struct Target {
    pub(crate) triangles: Vec<Triangle>,
    root: RwLock<Cell>,
    /// The cube that is divided: its centre, and half of its size.
    cube: (Vector3<f64>, f64),
    lift: f64,
    pub(crate) distance: DistanceTo,
    /// How many more cells there may be.
    pub(crate) cells_left: AtomicUsize,
    /// Whether some part of a work had hardly enough of them.
    crowded: AtomicBool,
    /// A bound of all coordinates.
    pub(crate) size: f64,
    /// Whether all triangles have an area.
    pub(crate) is_whole: bool,
}

/// At most as many cells, of some 600 bytes each; pieces count as further ones.
const MOST_CELLS: usize = 2_000_000;
/// No more of them are kept for the next parts of a work.
const KEPT: usize = 200_000;
/// So many parts of a work are done together, or some for each thread; in between, cells may be forgotten.
const TOGETHER: usize = 16;
const OF_A_THREAD: usize = 4;

impl Target {
    /// `lift`: how far something may have to be lifted out of it, about: a few times a limit of depths. It does not
    /// matter for what is proven, but for how fast.
    ///
    /// # Errors
    /// The triangles do not enclose a solid.
    pub fn new(soup: &TriangleSoup, lift: f64) -> Result<Self, MeshError> {
        let (closed, distance) = rayon::join(|| soup.check_closed(), || DistanceTo::new(soup));
        closed?;
        Ok(Self::of_closed(soup, lift, distance?))
    }

    /// The same of triangles that are known to enclose a solid, with the distance to just these.
    #[must_use]
    pub fn of_closed(soup: &TriangleSoup, lift: f64, distance: DistanceTo) -> Self {
        let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        let mut triangles = Vec::with_capacity(soup.triangles.len());
        for (number, corners) in (0..).zip(&soup.triangles) {
            let corners = corners.map(Vector3::from);
            for corner in &corners {
                low = low.inf(corner);
                high = high.sup(corner);
            }
            // A triangle without area has no side; what it covers belongs to its neighbours' edges.
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            if let Some(normal) = normal.try_normalize(0.0) {
                triangles.push(Triangle {
                    number,
                    corners,
                    normal,
                });
            }
        }
        let all = Near::Many((0..triangles.len() as u32).collect());
        let size = low.amax().max(high.amax());
        let (centre, half) = root(&low, &high);
        Self {
            root: RwLock::new(Cell::new((centre, half), lift, &all, &triangles, &distance)),
            cube: (centre, half),
            lift,
            is_whole: triangles.len() == soup.triangles.len(),
            triangles,
            distance,
            cells_left: AtomicUsize::new(MOST_CELLS),
            crowded: AtomicBool::new(false),
            size,
        }
    }

    /// The cube that is divided: its centre and half of its size.
    #[must_use]
    pub fn root(&self) -> ([f64; 3], f64) {
        (self.cube.0.into(), self.cube.1)
    }

    /// How far something may have to be lifted, about.
    #[must_use]
    pub fn lift(&self) -> f64 {
        self.lift
    }

    /// Does a work in groups of parts, and forgets cells in between when they are many. `None` if one of the parts is
    /// none. What is `known` of a group is not looked for, and `keep` gets what is found of others.
    pub(crate) fn each<'a, T: Sync + 'a, U: Send>(
        &self,
        groups: impl Iterator<Item = &'a [T]>,
        (known, keep): (impl Fn(&[T]) -> Option<Vec<U>>, impl Fn(&[T], &[U])),
        work: impl Fn(&Cell, &T) -> Option<U> + Sync,
    ) -> Option<Vec<U>> {
        let mut all = Vec::new();
        for some in groups {
            if let Some(own) = known(some) {
                all.extend(own);
                continue;
            }
            let (first, mut enough) = (all.len(), true);
            for some in some.chunks(TOGETHER.max(OF_A_THREAD * rayon::current_num_threads())) {
                let own: Option<Vec<U>> = {
                    let root = self.root.read().unwrap_or_else(PoisonError::into_inner);
                    some.par_iter().with_max_len(1).map(|part| work(&root, part)).collect()
                };
                all.extend(own?);
                let cells = MOST_CELLS - self.cells_left.load(Ordering::Relaxed);
                // Whether there were enough cells must not depend on what was known before.
                enough &= cells < MOST_CELLS - 2 * KEPT;
                if cells > KEPT {
                    let mut root = self.root.write().unwrap_or_else(PoisonError::into_inner);
                    let left = MOST_CELLS.saturating_sub(root.prune());
                    self.cells_left.store(left, Ordering::Relaxed);
                }
            }
            if enough {
                keep(some, &all[first..]);
            } else {
                self.crowded.store(true, Ordering::Relaxed);
            }
        }
        Some(all)
    }

    /// Whether a work on it nearly ran out of room. What is found then may depend on what was
    /// [known before](crate::Recall).
    #[must_use]
    pub fn is_crowded(&self) -> bool {
        self.crowded.load(Ordering::Relaxed)
    }

    /// How deep a point lies in the solid; negative outside.
    #[must_use]
    pub fn depth(&self, point: [f64; 3]) -> f64 {
        cell::depth(&self.distance, &point.into())
    }
}

/// A cube around a box, by its centre and half of its size. These have so few digits that the cubes into which it is
/// divided have exact centres.
fn root(low: &Vector3<f64>, high: &Vector3<f64>) -> (Vector3<f64>, f64) {
    /// Of so many parts of the size.
    const PARTS: f64 = 65536.0;
    let half = 0.5 * (high - low).max();
    let unit = (half.max(f64::MIN_POSITIVE) / PARTS).log2().ceil().exp2();
    let centre = (0.5 * (low + high)).map(|c| (c / unit).round() * unit);
    // The centre is off by half a unit at most.
    (centre, ((half / unit).ceil() + 1.0) * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of many triangles: cells pay for all pieces that they hold, and those that are forgotten hold none.
    #[test]
    fn what_is_remembered_of_many_triangles_is_counted() {
        let at = |u: usize, v: usize| {
            let [a, b] = [u as f64 / 64.0, 2.0 * (v % 128) as f64 / 128.0].map(|part| part * std::f64::consts::PI);
            [a.sin() * b.cos(), a.sin() * b.sin(), a.cos()].map(|c| if [0, 64].contains(&u) { c.round() } else { c })
        };
        let square = |(u, v): (usize, usize)| {
            let [a, b, c, d] = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
            [[a, b, c], [a, c, d]]
        };
        let all = (0..64).flat_map(|u| (0..128).map(move |v| (u, v))).flat_map(square);
        let triangles = all.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let target = Target::new(&TriangleSoup { triangles }, 0.01).expect("closed");
        fn pieces(cell: &Cell, target: &Target) -> usize {
            let child = |n| cell.child(n, &target.triangles, &target.distance, &target.cells_left);
            match cell.near {
                Near::Many(_) => (0..8).filter_map(child).map(|part| pieces(part, target)).sum(),
                _ => cell.pieces().len(),
            }
        }
        let held = pieces(&target.root.read().unwrap(), &target);
        let paid = MOST_CELLS - target.cells_left.load(Ordering::Relaxed);
        assert!(held > 16_000 && paid >= held / 4, "{paid} cells for {held} pieces");
        let mut root = target.root.write().unwrap();
        let left = root.prune();
        assert!(0 < left && left < paid / 10, "{left} of {paid} cells are left");
        target.cells_left.store(MOST_CELLS - left, Ordering::Relaxed);
        drop(root);
        assert_eq!(pieces(&target.root.read().unwrap(), &target), held);
    }
}
