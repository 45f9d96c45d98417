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

/// At most as many cells, of some hundred bytes each; of one with pieces, every eight count as another.
const MOST_CELLS: usize = 2_000_000;
/// No more of them are kept for the next parts of a work.
const KEPT: usize = 100_000;

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

    /// Does a work in groups of parts, with the cells in between, and forgets these when they are many. What remains
    /// known does not depend on threads. `None` if one of the parts is none. What is `known` of a group is not looked
    /// for, and `keep` gets what is found of others.
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
            let own: Option<Vec<U>> = {
                let root = self.root.read().unwrap_or_else(PoisonError::into_inner);
                some.par_iter().with_max_len(1).map(|part| work(&root, part)).collect()
            };
            let own = own?;
            // Whether there were enough cells must not depend on what was known before.
            if MOST_CELLS - self.cells_left.load(Ordering::Relaxed) < MOST_CELLS - 2 * KEPT {
                keep(some, &own);
            } else {
                self.crowded.store(true, Ordering::Relaxed);
            }
            all.extend(own);
            if MOST_CELLS - self.cells_left.load(Ordering::Relaxed) > KEPT {
                let mut root = self.root.write().unwrap_or_else(PoisonError::into_inner);
                self.cells_left
                    .store(MOST_CELLS.saturating_sub(root.prune()), Ordering::Relaxed);
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
