//! Cubes of space, with what of the surface is near them.
//!
//! A cell is a cube `H` around a centre, of half the size `h`. Its surroundings `H′` are the cube around the
//! same centre of half the size `AROUND (h + l)`: what is lifted from `H` by no more than `l` is in them, which is what
//! the certificate wants, but for `h/8 ≤ l ≤ h`. A cell knows all of the surface in `H′`: the triangles, clipped to the
//! somewhat larger cube of half the size `CLIP (h + l)`.
//!
//! Clipping rounds. For each polygon that is kept there is one in the plane of its triangle whose corners are not
//! farther than `error` from those kept, and which holds all of the triangle within the cube, shrunk by `error`: a
//! corner that is left out is beyond a plane of the cube, and a new corner is on an edge of that polygon, at the plane;
//! so what is cut off is the hull of points beyond the plane, but for `error`. Each clipping adds a few roundings to
//! the error, which stays much below the difference between `CLIP` and `AROUND`.

use crate::surface::Surface;
use crate::vector::{EPS, MORE, V3, add, dot_down, dot_up, norm_up, scaled, sub, sum_up, unit};
use std::sync::OnceLock;
use std::sync::atomic::Ordering;

const AROUND: f64 = 1.0 + 7e-4;
const CLIP: f64 = 1.0 + 9e-4;
/// Cells with more triangles near them keep the numbers of these only.
const MOST_PIECES: usize = 1024;

/// Nothing is lifted above more planes together.
pub(crate) const MOST_PLANES: usize = 8;

/// What is near a cell.
enum Near {
    /// The corners of polygons, and where each polygon ends.
    Pieces {
        corners: Vec<V3>,
        ends: Vec<u32>,
    },
    Many,
    /// Nothing; and whether all of the surroundings are outside, if that can be told.
    Nothing(Option<bool>),
}

pub(crate) struct Cell {
    pub centre: V3,
    pub half: f64,
    /// What is wanted to be lifted.
    wanted: f64,
    near: Near,
    /// The triangle of each piece.
    triangles: Vec<u32>,
    /// How far corners may be from where they should be.
    error: f64,
    /// Whether each corner of the surroundings is outside.
    outside: [OnceLock<bool>; 8],
    middle: OnceLock<f64>,
    children: OnceLock<Box<[OnceLock<Self>; 8]>>,
}

impl Cell {
    /// The cube that is divided; `lift`: what may have to be lifted, so far.
    pub fn root(centre: V3, half: f64, lift: f64, surface: &Surface) -> Self {
        let all = (0..surface.triangles.len() as u32).collect::<Vec<_>>();
        Self::new((centre, half, lift), surface, None, &all, 0.0)
    }

    /// Nothing is lifted farther.
    pub fn lift(&self) -> f64 {
        self.wanted.clamp(0.125 * self.half, self.half)
    }

    /// `pieces`: of the cell that it is in; otherwise whole triangles.
    fn new(
        (centre, half, lift): (V3, f64, f64),
        surface: &Surface,
        pieces: Option<(&[V3], &[u32])>,
        triangles: &[u32],
        error: f64,
    ) -> Self {
        let own = Self::with((centre, half, lift), Near::Many, Vec::new(), 0.0);
        let reach = (half + own.lift()) * CLIP;
        let (mut corners, mut ends, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for (k, number) in triangles.iter().enumerate() {
            let before = corners.len();
            match pieces {
                Some((all, ends)) => {
                    let first = k.checked_sub(1).map_or(0, |k| ends[k] as usize);
                    clip(&all[first..ends[k] as usize], &centre, reach, &mut corners);
                }
                None => clip(&surface.triangles[*number as usize], &centre, reach, &mut corners),
            }
            if corners.len() > before {
                ends.push(corners.len() as u32);
                kept.push(*number);
            }
        }
        // Each of the six planes adds some four roundings of a coordinate.
        let error = error + 32.0 * EPS * surface.size;
        let near = match kept.len() {
            0 => Near::Nothing(surface.is_outside(&centre)),
            1..=MOST_PIECES => Near::Pieces { corners, ends },
            _ => Near::Many,
        };
        Self::with((centre, half, lift), near, kept, error)
    }

    fn with((centre, half, wanted): (V3, f64, f64), near: Near, triangles: Vec<u32>, error: f64) -> Self {
        Self {
            centre,
            half,
            wanted,
            near,
            triangles,
            error,
            outside: Default::default(),
            middle: OnceLock::new(),
            children: OnceLock::new(),
        }
    }

    /// The centre of one of its eight parts, if it is exact: then the parts cover the cell.
    pub fn centre_of_child(&self, octant: usize) -> Option<V3> {
        let quarter = 0.5 * self.half;
        let mut centre = self.centre;
        for (k, c) in centre.iter_mut().enumerate() {
            let step = if octant >> k & 1 == 0 { -quarter } else { quarter };
            let moved = *c + step;
            if moved - *c != step || moved - step != *c {
                return None;
            }
            *c = moved;
        }
        Some(centre)
    }

    /// One of its parts, or why there is none.
    pub fn child(&self, octant: usize, surface: &Surface) -> Result<&Self, &'static str> {
        let centre = self
            .centre_of_child(octant)
            .ok_or("the cell is too small to be divided")?;
        let child = &self.children.get_or_init(Box::default)[octant];
        let corners = match &self.near {
            Near::Pieces { corners, .. } => corners.len(),
            Near::Many => self.triangles.len(),
            Near::Nothing(_) => 0,
        };
        // Clipping must not be as inexact as the surroundings are larger.
        let error = self.error + 32.0 * EPS * surface.size;
        if 0.5 * self.half * (CLIP - AROUND) < 4.0 * error && corners > 0 {
            return Err("the cell is too small to be divided");
        }
        if child.get().is_none() && surface.cells_left.load(Ordering::Relaxed) == 0 {
            return Err("the proof takes too many cells");
        }
        Ok(child.get_or_init(|| {
            let own = (centre, 0.5 * self.half, self.wanted);
            let own = match &self.near {
                Near::Nothing(outside) => Self::with(own, Near::Nothing(*outside), Vec::new(), 0.0),
                Near::Many => Self::new(own, surface, None, &self.triangles, 0.0),
                Near::Pieces { corners, ends } => {
                    Self::new(own, surface, Some((corners, ends)), &self.triangles, self.error)
                }
            };
            // Of some hundred bytes each; every sixteen corners count as another.
            let corners = match &own.near {
                Near::Pieces { corners, .. } => corners.len(),
                _ => own.triangles.len() / 4,
            };
            let take = |left: usize| Some(left.saturating_sub(1 + corners / 16));
            let _ = surface
                .cells_left
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, take);
            own
        }))
    }

    /// Whether nothing of the surface is in the surroundings; and whether they are outside.
    pub fn is_clear(&self) -> (bool, bool) {
        (
            matches!(self.near, Near::Nothing(_)),
            matches!(self.near, Near::Nothing(Some(true))),
        )
    }

    /// How far the cell reaches along `n`.
    pub fn support_up(&self, n: &V3) -> f64 {
        dot_up(n, &self.centre) + self.half * sum_up(n)
    }

    /// How far the surface in the surroundings reaches along `n`; `None` if that is not known.
    pub fn top_up(&self, n: &V3) -> Option<f64> {
        let Near::Pieces { corners, .. } = &self.near else {
            return None;
        };
        Some(self.top_of(corners, n))
    }

    fn top_of(&self, corners: &[V3], n: &V3) -> f64 {
        let top = corners.iter().map(|corner| dot_up(n, corner));
        let top = top.fold(f64::NEG_INFINITY, f64::max) + self.error * norm_up(n);
        top + 4.0 * EPS * top.abs()
    }

    /// For each piece of the surface in the surroundings, how far it reaches along each normal.
    pub fn tops_up<'a>(&'a self, normals: &'a [V3]) -> Option<impl Iterator<Item = [f64; MOST_PLANES]> + 'a> {
        let Near::Pieces { corners, ends } = &self.near else {
            return None;
        };
        let starts = std::iter::once(0).chain(ends.iter().copied());
        Some(starts.zip(ends).map(move |(from, to)| {
            let own = &corners[from as usize..*to as usize];
            let mut tops = [f64::NEG_INFINITY; MOST_PLANES];
            for (top, n) in tops.iter_mut().zip(normals) {
                *top = self.top_of(own, n);
            }
            tops
        }))
    }

    /// Half the size of the surroundings, from below.
    pub fn around(&self) -> f64 {
        (self.half + self.lift()) * AROUND * (2.0 - MORE)
    }

    /// Whether what of the surroundings is above a plane, where there is no surface, is outside: as that corner is
    /// which is farthest along `n`. If even that is below the plane, there is nothing.
    pub fn is_outside_above(&self, (n, top): (&V3, f64), surface: &Surface) -> bool {
        let around = self.around();
        let octant = (0..3).filter(|k| n[*k] > 0.0).fold(0, |octant, k| octant | 1 << k);
        let corner: V3 = std::array::from_fn(|k| self.centre[k] + if octant >> k & 1 == 1 { around } else { -around });
        let is_outside = || *self.outside[octant].get_or_init(|| surface.is_outside(&corner) == Some(true));
        dot_up(n, &corner) <= top || dot_down(n, &corner) > top && is_outside()
    }

    /// No point of the cell is deeper: depths change no faster than places.
    ///
    /// From a middle inside, a place just beyond the nearest of the surface is tried, and one beside its triangle,
    /// where what is nearest is the edge of a notch that leans: if it is outside, the middle is no deeper than it is
    /// far. From one outside, all nearer than the surface are outside.
    pub fn depth_by_middle(&self, surface: &Surface) -> f64 {
        *self.middle.get_or_init(|| {
            let diagonal = 3_f64.sqrt() * self.half * MORE;
            let (distance, near, triangle) = surface.nearest(&self.centre);
            match surface.is_outside(&self.centre) {
                Some(true) => diagonal - distance,
                Some(false) => {
                    let way = sub(&near, &self.centre);
                    let far = norm_up(&way) + 1e-11 * surface.size;
                    let beyond = unit(&way).map(|unit| add(&self.centre, &scaled(&unit, far)));
                    let places = [beyond, surface.beside(&near, triangle)].into_iter().flatten();
                    let outside = { places }.find(|place| surface.is_outside(place) == Some(true));
                    outside.map_or(f64::INFINITY, |place| norm_up(&sub(&place, &self.centre)) + diagonal)
                }
                None => f64::INFINITY,
            }
        })
    }

    /// A place in the surroundings, off the centre.
    pub fn place(&self, off: &V3) -> Option<V3> {
        let around = self.around();
        let place: V3 = std::array::from_fn(|k| self.centre[k] + off[k]);
        let is_near = sub(&place, &self.centre)
            .iter()
            .all(|c| c.abs() < around * (1.0 - 1e-12));
        is_near.then_some(place)
    }
}

/// What of a convex polygon is within a cube.
fn clip(polygon: &[V3], centre: &V3, half: f64, into: &mut Vec<V3>) {
    let off = |p: &V3, k: usize| p[k] - centre[k];
    let (mut all, mut some) = (true, true);
    for k in 0..3 {
        let low = polygon.iter().map(|p| off(p, k)).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(|p| off(p, k)).fold(f64::NEG_INFINITY, f64::max);
        some &= low <= half && high >= -half;
        all &= low >= -half && high <= half;
    }
    if !some {
        return;
    }
    if all {
        return into.extend_from_slice(polygon);
    }
    let (mut from, mut to) = (polygon.to_vec(), Vec::with_capacity(polygon.len() + 6));
    for k in 0..3 {
        for side in [1.0, -1.0] {
            to.clear();
            for (i, a) in from.iter().enumerate() {
                let b = &from[(i + 1) % from.len()];
                let (u, v) = (side * off(a, k) - half, side * off(b, k) - half);
                if u <= 0.0 {
                    to.push(*a);
                }
                if (u < 0.0 && v > 0.0) || (u > 0.0 && v < 0.0) {
                    let step = scaled(&sub(b, a), u / (u - v));
                    to.push([a[0] + step[0], a[1] + step[1], a[2] + step[2]]);
                }
            }
            std::mem::swap(&mut from, &mut to);
        }
    }
    into.append(&mut from);
}
