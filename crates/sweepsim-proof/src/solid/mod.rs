//! The solid that must not be cut.

mod cell;
mod near;
mod outside;
mod pieces;
mod way;

pub(crate) use cell::{Cell, MOST_PLANES, MOST_WAYS};
pub(crate) use near::Near;
pub(crate) use outside::is_outside;
pub(crate) use way::{Normal, Triangle, Way, Written};

use cell::Grain;
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
    /// How much memory more cells may take.
    bytes_left: AtomicUsize,
    /// Whether there was too little of it since it was last asked.
    starved: AtomicBool,
    /// Whether some part of a work had too little of it for itself.
    crowded: AtomicBool,
    /// A bound of all coordinates.
    pub(crate) size: f64,
    /// Whether all triangles have an area.
    pub(crate) is_whole: bool,
}

/// Cells with more pieces than this are divided before they are looked at, but not before they are as small as what
/// may have to be lifted: of dense triangles, these may have so many.
const MOST_PIECES: usize = 256;
const MOST_DENSE_PIECES: usize = 1024;
/// So much memory cells may take.
const MOST_BYTES: usize = 256_000_000;
/// No more of it is kept for the next parts of a work.
const KEPT: usize = MOST_BYTES / 8;
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
        let (mut triangles, mut area) = (Vec::with_capacity(soup.triangles.len()), 0.0);
        for (number, corners) in (0..).zip(&soup.triangles) {
            let corners = corners.map(Vector3::from);
            for corner in &corners {
                low = low.inf(corner);
                high = high.sup(corner);
            }
            // A triangle without area has no side; what it covers belongs to its neighbours' edges.
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            area += 0.5 * normal.norm();
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
        // Two sheets through the surroundings of a cell of this size.
        let sheets = 2.0 * (4.0 * lift).powi(2);
        let dense = triangles.len() as f64 * sheets / area;
        let grain = Grain {
            lift,
            pieces: (dense as usize).clamp(MOST_PIECES, MOST_DENSE_PIECES),
        };
        Self {
            root: RwLock::new(Cell::new((centre, half), grain, &all, &triangles, &distance)),
            cube: (centre, half),
            lift,
            is_whole: triangles.len() == soup.triangles.len(),
            triangles,
            distance,
            bytes_left: AtomicUsize::new(MOST_BYTES),
            starved: AtomicBool::new(false),
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
            let first = all.len();
            for some in some.chunks(TOGETHER.max(OF_A_THREAD * rayon::current_num_threads())) {
                all.extend(self.all_of(some, &work)?);
            }
            // What was found with too little memory may depend on what was known before.
            if !self.crowded.load(Ordering::Relaxed) {
                keep(some, &all[first..]);
            }
        }
        Some(all)
    }

    /// Some parts together; if there is not enough memory for all of their cells, in halves.
    fn all_of<T: Sync, U: Send>(&self, some: &[T], work: &(impl Fn(&Cell, &T) -> Option<U> + Sync)) -> Option<Vec<U>> {
        let own: Option<Vec<U>> = {
            let root = self.root.read().unwrap_or_else(PoisonError::into_inner);
            some.par_iter().with_max_len(1).map(|part| work(&root, part)).collect()
        };
        let is_starved = self.starved.swap(false, Ordering::Relaxed);
        if is_starved || MOST_BYTES - self.bytes_left.load(Ordering::Relaxed) > KEPT {
            let mut root = self.root.write().unwrap_or_else(PoisonError::into_inner);
            let left = MOST_BYTES.saturating_sub(root.prune());
            self.bytes_left.store(left, Ordering::Relaxed);
        }
        if !is_starved {
            return own;
        }
        if let [_] = some {
            self.crowded.store(true, Ordering::Relaxed);
            return own;
        }
        let (some, others) = some.split_at(some.len() / 2);
        let mut all = self.all_of(some, work)?;
        all.extend(self.all_of(others, work)?);
        Some(all)
    }

    /// Whether a work on it ran out of memory. What is found then may depend on what was
    /// [known before](crate::Recall).
    #[must_use]
    pub fn is_crowded(&self) -> bool {
        self.crowded.load(Ordering::Relaxed)
    }

    /// A part of a cell. `None` if there is no memory left for it.
    pub(crate) fn child<'a>(&self, cell: &'a Cell, octant: usize) -> Option<&'a Cell> {
        let child = cell.child(octant, &self.triangles, &self.distance, &self.bytes_left);
        if child.is_none() {
            self.starved.store(true, Ordering::Relaxed);
        }
        child
    }

    /// How deep a point lies in the solid; negative outside.
    #[must_use]
    pub fn depth(&self, point: [f64; 3]) -> f64 {
        depth(&self.distance, &point.into())
    }
}

/// How deep a point is in the solid; negative outside.
fn depth(distance: &DistanceTo, point: &Vector3<f64>) -> f64 {
    let nearest = distance.nearest((*point).into());
    nearest.map_or(f64::NEG_INFINITY, |near| -near.distance)
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
            let child = |n| target.child(cell, n);
            match cell.near {
                Near::Many(_) => (0..8).filter_map(child).map(|part| pieces(part, target)).sum(),
                _ => cell.pieces(&target.triangles).len(),
            }
        }
        let held = pieces(&target.root.read().unwrap(), &target);
        let paid = MOST_BYTES - target.bytes_left.load(Ordering::Relaxed);
        assert!(held > 16_000 && paid >= 50 * held, "{paid} bytes for {held} pieces");
        let mut root = target.root.write().unwrap();
        let left = root.prune();
        assert!(0 < left && left < paid / 10, "{left} of {paid} bytes are left");
        target.bytes_left.store(MOST_BYTES - left, Ordering::Relaxed);
        drop(root);
        assert_eq!(pieces(&target.root.read().unwrap(), &target), held);
    }
}
