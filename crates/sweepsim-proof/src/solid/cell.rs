//! Cubes of space, with what of a solid's surface is near them.
//!
//! A cell is a cube `H`; its surroundings `H′` are a larger cube around the same centre, which holds whatever is lifted
//! from `H` as far as it may be. It knows the triangles that meet `H′`, clipped to it. Its parts are made when they are
//! asked for.

use super::depth;
use super::near::Near;
use super::outside::is_outside;
use super::pieces::{Piece, Pieces};
use super::way::{Normal, Triangle, Way};
use nalgebra::Vector3;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_dexel::DistanceTo;

/// What is found out of a cell with some of the surface near it, when it is first looked at.
#[derive(Debug)]
struct Known {
    /// The corners of the pieces, each once.
    corners: Vec<Vector3<f64>>,
    ways: Vec<Way>,
    /// The normals of all triangles, if they are few and some of the surface is in front of others.
    faces: Vec<Normal>,
    /// Whether all triangles look about the same way.
    is_smooth: bool,
    /// No point of the cell is deeper, and the way that says so.
    depth: (f64, usize),
}

#[derive(Debug)]
pub(crate) struct Cell {
    pub centre: Vector3<f64>,
    pub half: f64,
    /// So far something may be lifted off the cell: as far as is wanted, if that is neither little nor much for it.
    pub lift: f64,
    grain: Grain,
    pub near: Near,
    known: OnceLock<Known>,
    deepest: OnceLock<f64>,
    children: OnceLock<Box<Children>>,
}

type Children = [OnceLock<Cell>; 8];

/// What is found out of a cell, but for the corners.
const KNOWN: usize = MOST_WAYS * size_of::<Way>();
/// As many directions are tried.
pub(crate) const MOST_WAYS: usize = 8;
/// A hollow is deeper than this part of what may have to be lifted.
const HOLLOW: f64 = 0.02;
/// Nothing is lifted above more planes together.
pub(crate) const MOST_PLANES: usize = 8;
/// Normals whose cosine is larger count as one direction.
const SAME_WAY: f64 = 0.999;
/// Normals whose cosine with their mean is larger, all of them, make a smooth surface.
const SMOOTH: f64 = 0.9;
/// A solid may be lifted by as much as is wanted, but by no less, and no more, than so many halves of a cell's size.
const LIFT: [f64; 2] = [0.125, 1.0];
/// Surroundings are a little larger than what may be lifted into, for rounding.
const MARGIN: f64 = 1e-3;

/// How a solid is divided into cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grain {
    /// So far something may have to be lifted.
    pub lift: f64,
    /// Cells with more pieces are divided before they are looked at.
    pub pieces: usize,
}

impl Cell {
    /// `around`: what is near a cell that this one is in.
    pub fn new(
        (centre, half): (Vector3<f64>, f64),
        grain: Grain,
        around: &Near,
        triangles: &[Triangle],
        distance: &DistanceTo,
    ) -> Self {
        let mut cell = Self {
            centre,
            half,
            lift: grain.lift.clamp(LIFT[0] * half, LIFT[1] * half),
            grain,
            near: Near::Outside,
            known: OnceLock::new(),
            deepest: OnceLock::new(),
            children: OnceLock::new(),
        };
        cell.near = around.within((&centre, cell.around()), grain.pieces, triangles, distance);
        cell
    }

    /// Half the size of the surroundings.
    fn around(&self) -> f64 {
        (self.half + self.lift) * (1.0 + MARGIN)
    }

    /// How many triangles are near.
    pub fn count(&self) -> usize {
        self.near.count()
    }

    /// Whether it has so many of them that it is divided before it is looked at.
    pub fn has_many(&self) -> bool {
        matches!(self.near, Near::Many(_))
    }

    pub fn pieces<'a>(&'a self, triangles: &'a [Triangle]) -> impl ExactSizeIterator<Item = Piece<'a>> + Clone {
        static NONE: Pieces = Pieces::none();
        match &self.near {
            Near::Surface(pieces) => pieces.iter(triangles),
            _ => NONE.iter(triangles),
        }
    }

    /// No point of the cell is deeper in the solid: depths change no faster than places.
    pub fn deepest(&self, distance: &DistanceTo) -> f64 {
        *self
            .deepest
            .get_or_init(|| depth(distance, &self.centre) + 3_f64.sqrt() * self.half)
    }

    /// Where each of the eight cells is that it consists of; all have half its size.
    pub fn centre_of_child(&self, octant: usize) -> Vector3<f64> {
        let half = 0.5 * self.half;
        self.centre + Vector3::from_fn(|k, _| if octant >> k & 1 == 0 { -half } else { half })
    }

    /// One of them. `None` if there is no memory left for it.
    pub fn child(
        &self,
        octant: usize,
        triangles: &[Triangle],
        distance: &DistanceTo,
        bytes_left: &AtomicUsize,
    ) -> Option<&Self> {
        let take = |bytes: usize| {
            let take = |left: usize| left.checked_sub(bytes);
            bytes_left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take).ok()
        };
        if self.children.get().is_none() {
            take(size_of::<Children>())?;
        }
        let child = &self.children.get_or_init(Box::default)[octant];
        if let Some(child) = child.get() {
            return Some(child);
        }
        // Until it is known, it may take as much as its parent.
        let most = self.bytes();
        take(most)?;
        let own = (self.centre_of_child(octant), 0.5 * self.half);
        let child = child.get_or_init(|| Self::new(own, self.grain, &self.near, triangles, distance));
        let give_back = |left: usize| Some((left + most).saturating_sub(child.bytes()));
        let _ = bytes_left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, give_back);
        Some(child)
    }

    /// About how much memory it takes, together with what may be found out of it, and without its parts.
    fn bytes(&self) -> usize {
        let near = self.near.bytes();
        near + if matches!(self.near, Near::Surface(_)) {
            KNOWN + near
        } else {
            0
        }
    }

    /// Forgets all parts with few triangles: how much memory the others take.
    pub fn prune(&mut self) -> usize {
        let Some(children) = self.children.get_mut() else {
            return 0;
        };
        let mut bytes = size_of::<Children>();
        for child in children.iter_mut() {
            match child.get_mut() {
                Some(part) if part.has_many() => bytes += part.bytes() + part.prune(),
                _ => drop(child.take()),
            }
        }
        bytes
    }

    /// Directions to try: the mean normal, and those of the triangles.
    pub fn ways(&self, triangles: &[Triangle]) -> &[Way] {
        &self.known(triangles).ways
    }

    /// The normals of all triangles near it, those of about the same way once; none if they are many, or no hollow.
    pub fn faces(&self, triangles: &[Triangle]) -> &[Normal] {
        &self.known(triangles).faces
    }

    /// Whether all triangles near it look about the same way.
    pub fn is_smooth(&self, triangles: &[Triangle]) -> bool {
        self.known(triangles).is_smooth
    }

    /// No point of the cell is deeper than this in the solid, as far as the directions to try say, and which of them
    /// says so.
    pub fn depth(&self, triangles: &[Triangle]) -> (f64, Option<&Way>) {
        let known = self.known(triangles);
        (known.depth.0, known.ways.get(known.depth.1))
    }

    fn known(&self, triangles: &[Triangle]) -> &Known {
        self.known.get_or_init(|| {
            let own = self.pieces(triangles).flat_map(|piece| piece.corners);
            let mut corners: Vec<Vector3<f64>> = own.copied().collect();
            let bits = |p: &Vector3<f64>| [p.x, p.y, p.z].map(f64::to_bits);
            corners.sort_unstable_by_key(bits);
            corners.dedup_by_key(|p| bits(p));
            let (normals, mut faces, is_smooth) = self.normals(triangles);
            if !self.is_hollow(&faces, triangles, &corners) {
                faces.clear();
            }
            let mut known = Known {
                corners,
                ways: Vec::new(),
                faces,
                is_smooth,
                depth: (f64::INFINITY, 0),
            };
            for normal in normals {
                let way = self.way_above(normal, triangles, &known.corners);
                let depth = way.top + self.support(&-normal.vector);
                if way.out && depth <= self.lift && depth < known.depth.0 {
                    known.depth = (depth, known.ways.len());
                }
                known.ways.push(way);
            }
            known
        })
    }

    /// The mean normal and those of the triangles, as far as they differ; the latter alone if these are all; and
    /// whether all are nearly the same.
    fn normals(&self, triangles: &[Triangle]) -> (Vec<Normal>, Vec<Normal>, bool) {
        let mut clusters: Vec<(Normal, f64)> = Vec::new();
        for piece in self.pieces(triangles) {
            let normal = Normal::of(&triangles[piece.triangle as usize]);
            let area = piece.area();
            let same = |(other, _): &&mut (Normal, f64)| other.vector.dot(&normal.vector) > SAME_WAY;
            match clusters.iter_mut().find(same) {
                Some((_, sum)) => *sum += area,
                None => clusters.push((normal, area)),
            }
        }
        let sum: Vector3<f64> = clusters.iter().map(|(normal, area)| normal.vector * *area).sum();
        let mean = sum.try_normalize(1e-300).filter(|_| clusters.len() > 1);
        let is_smooth = mean.is_none_or(|mean| {
            let normal = |piece: Piece| triangles[piece.triangle as usize].normal;
            self.pieces(triangles).all(|piece| normal(piece).dot(&mean) > SMOOTH)
        });
        // A stable sort: the largest first. Of a smooth surface, one is enough.
        clusters.sort_by(|a, b| b.1.total_cmp(&a.1));
        let faces = match clusters.len() {
            2..=MOST_PLANES => clusters.iter().map(|(normal, _)| *normal).collect(),
            _ => Vec::new(),
        };
        clusters.truncate(if is_smooth { 1 } else { MOST_WAYS });
        let own = clusters.iter().map(|(normal, _)| *normal);
        let mean = mean.and_then(|mean| Normal::near(&mean));
        (mean.into_iter().chain(own).collect(), faces, is_smooth)
    }

    /// Whether some of the surface is in front of the plane of other of it, by more than does not matter.
    fn is_hollow(&self, faces: &[Normal], triangles: &[Triangle], corners: &[Vector3<f64>]) -> bool {
        faces.iter().any(|face| {
            let is_own = |piece: &Piece| face.written == Normal::of(&triangles[piece.triangle as usize]).written;
            let level = |own: Piece| face.vector.dot(&own.corners[0]) + HOLLOW * self.grain.lift;
            let own = self.pieces(triangles).find(is_own).map(level);
            own.is_some_and(|level| highest(corners, &face.vector).0 > level)
        })
    }

    /// What is known of a direction.
    pub fn way(&self, normal: Normal, triangles: &[Triangle]) -> Way {
        self.way_above(normal, triangles, &self.known(triangles).corners)
    }

    fn way_above(&self, normal: Normal, triangles: &[Triangle], corners: &[Vector3<f64>]) -> Way {
        let Normal {
            vector: normal,
            written,
        } = normal;
        let top = highest(corners, &normal).0;
        let is_out = || {
            let above = self.middle_of_top((&normal, top), triangles) + normal * (0.5 * self.half * MARGIN);
            // Beyond the surroundings, there may be triangles that are not known here.
            let is_near = (above - self.centre).amax() <= self.around();
            is_near && is_outside(&above, self.pieces(triangles), triangles) == Some(true)
        };
        let out = self.faces_up(triangles, (&normal, top)) || is_out();
        Way {
            normal,
            written,
            top,
            out,
        }
    }

    /// Whether no triangle faces down, and from one that faces up, a line along the normal leads above all of them
    /// within the surroundings: coming down such a line, the first triangle is met from outside.
    fn faces_up(&self, triangles: &[Triangle], (normal, top): (&Vector3<f64>, f64)) -> bool {
        let cosine = |piece: &Piece| triangles[piece.triangle as usize].normal.dot(normal);
        let leads_up = |piece: &Piece| {
            let middle = piece.corners.iter().sum::<Vector3<f64>>() / piece.corners.len() as f64;
            let above = middle + normal * (top - normal.dot(&middle) + 0.5 * self.half * MARGIN);
            (above - self.centre).amax() <= self.around()
        };
        let mut pieces = self.pieces(triangles);
        pieces.clone().all(|piece| cosine(&piece) >= 0.0)
            && pieces.any(|piece| cosine(&piece) > 0.01 && leads_up(&piece))
    }

    /// The highest value of the surface along a direction, and where.
    pub fn top(&self, direction: &Vector3<f64>, triangles: &[Triangle]) -> (f64, Vector3<f64>) {
        let (top, number) = highest(&self.known(triangles).corners, direction);
        (top, self.known(triangles).corners[number])
    }

    /// The middle of the corners of one piece that are as high as the highest.
    fn middle_of_top(&self, (direction, top): (&Vector3<f64>, f64), triangles: &[Triangle]) -> Vector3<f64> {
        let near = top - 1e-6 * self.half;
        let highest = |piece: Piece| {
            let high = || piece.corners.iter().filter(|corner| direction.dot(corner) >= near);
            (high().count(), high().sum::<Vector3<f64>>())
        };
        let all = self.pieces(triangles).map(highest);
        let most = all.max_by_key(|(count, _)| *count);
        most.filter(|(count, _)| *count > 0)
            .map_or(self.centre, |(count, sum)| sum / count as f64)
    }

    /// The largest `⟨direction, x⟩` in the cell.
    pub fn support(&self, direction: &Vector3<f64>) -> f64 {
        direction.dot(&self.centre) + self.half * direction.lp_norm(1)
    }
}

/// The highest value of points along a direction, and the number of the first that is as high.
fn highest(points: &[Vector3<f64>], direction: &Vector3<f64>) -> (f64, usize) {
    let mut best = (f64::NEG_INFINITY, 0);
    for (number, point) in points.iter().enumerate() {
        let value = direction.dot(point);
        if value > best.0 {
            best = (value, number);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Target;
    use sweepsim_dexel::TriangleSoup;

    /// A face passes below the cell and hardly looks up: what is above it, within the surroundings, is inside.
    #[test]
    fn above_a_face_is_not_outside_if_no_line_leads_there() {
        let face = Vector3::new(0.72, 0.0, -0.694).normalize();
        let turned = |[x, y, z]: [f64; 3]| [x * face.x - z * face.z, y, x * face.z + z * face.x];
        let mut soup = TriangleSoup::block([-20.0; 3], [1.2, 20.0, 20.0]);
        soup.triangles
            .as_flattened_mut()
            .iter_mut()
            .for_each(|corner| *corner = turned(*corner));
        let target = Target::new(&soup, 0.5).expect("closed");
        let all = Near::Many((0..12).collect());
        let grain = Grain { lift: 0.5, pieces: 256 };
        let cell = Cell::new(
            (Vector3::zeros(), 0.5),
            grain,
            &all,
            &target.triangles,
            &target.distance,
        );
        let out = |direction: Vector3<f64>| {
            let normal = Normal::near(&direction).expect("a direction");
            cell.way(normal, &target.triangles).out
        };
        assert!(face.dot(&Vector3::new(1.0, 0.0, 1.0)) > 0.02 && out(face));
        assert!(!out(Vector3::new(1.0, 0.0, 1.0)));
    }
}
