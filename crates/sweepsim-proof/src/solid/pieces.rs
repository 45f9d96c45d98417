//! What of a surface is in a cube: parts of triangles.

use super::way::Triangle;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Part of a triangle: a convex polygon.
#[derive(Clone, Copy)]
pub(crate) struct Piece<'a> {
    pub triangle: u32,
    pub corners: &'a [Vector3<f64>],
    /// Whether it is all of the triangle.
    is_whole: bool,
}

impl<'a> Piece<'a> {
    pub fn all_of(number: u32, triangles: &'a [Triangle]) -> Self {
        Self {
            triangle: number,
            corners: &triangles[number as usize].corners,
            is_whole: true,
        }
    }

    pub fn area(&self) -> f64 {
        let corners = self.corners;
        let fan = corners.windows(2).skip(1);
        let twice: Vector3<f64> = fan
            .map(|pair| (pair[0] - corners[0]).cross(&(pair[1] - corners[0])))
            .sum();
        0.5 * twice.norm()
    }
}

/// Pieces. Of whole triangles only the number is kept.
#[derive(Clone, Debug)]
pub(crate) struct Pieces {
    pieces: Vec<Kept>,
    corners: Vec<Vector3<f64>>,
}

#[derive(Clone, Copy, Debug)]
struct Kept {
    triangle: u32,
    /// Its corners: the first, and how many. None of its own if it is the whole triangle.
    first: u32,
    count: u32,
}

impl Pieces {
    /// What of some pieces is in a cube.
    pub fn within<'a>(all: impl Iterator<Item = Piece<'a>>, cube: (&Vector3<f64>, f64)) -> Self {
        let mut own = Self::none();
        for piece in all {
            let first = own.corners.len() as u32;
            match extent(piece.corners, cube) {
                Extent::Outside => continue,
                Extent::Inside if piece.is_whole => {}
                Extent::Inside => own.corners.extend_from_slice(piece.corners),
                Extent::Across => {
                    let corners = clipped(piece.corners, cube);
                    if corners.is_empty() {
                        continue;
                    }
                    own.corners.extend(corners);
                }
            }
            own.pieces.push(Kept {
                triangle: piece.triangle,
                first,
                count: own.corners.len() as u32 - first,
            });
        }
        own.pieces.shrink_to_fit();
        own.corners.shrink_to_fit();
        own
    }

    pub const fn none() -> Self {
        Self {
            pieces: Vec::new(),
            corners: Vec::new(),
        }
    }

    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// How much memory they take.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.pieces[..]) + size_of_val(&self.corners[..])
    }

    pub fn iter<'a>(&'a self, triangles: &'a [Triangle]) -> impl ExactSizeIterator<Item = Piece<'a>> + Clone {
        self.pieces.iter().map(|kept| {
            let own = &self.corners[kept.first as usize..][..kept.count as usize];
            match own {
                [] => Piece::all_of(kept.triangle, triangles),
                _ => Piece {
                    triangle: kept.triangle,
                    corners: own,
                    is_whole: false,
                },
            }
        })
    }
}

/// Whether some of a convex polygon is in a cube: its centre, and half of its size.
pub(super) fn meets(corners: &[Vector3<f64>], cube: (&Vector3<f64>, f64)) -> bool {
    match extent(corners, cube) {
        Extent::Outside => false,
        Extent::Inside => true,
        Extent::Across => !clipped(corners, cube).is_empty(),
    }
}

/// Where the box around a polygon is.
enum Extent {
    Outside,
    Inside,
    Across,
}

fn extent(corners: &[Vector3<f64>], (centre, half): (&Vector3<f64>, f64)) -> Extent {
    let (mut all, mut some) = (true, true);
    for k in 0..3 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for corner in corners {
            low = low.min(corner[k] - centre[k]);
            high = high.max(corner[k] - centre[k]);
        }
        some &= low <= half && high >= -half;
        all &= low >= -half && high <= half;
    }
    match (some, all) {
        (false, _) => Extent::Outside,
        (_, true) => Extent::Inside,
        _ => Extent::Across,
    }
}

/// What of a convex polygon is in a cube.
fn clipped(corners: &[Vector3<f64>], (centre, half): (&Vector3<f64>, f64)) -> SmallVec<[Vector3<f64>; 8]> {
    let mut polygon: SmallVec<[Vector3<f64>; 8]> = corners.iter().copied().collect();
    for k in 0..3 {
        for side in [1.0, -1.0] {
            let above = |p: &Vector3<f64>| side * (p[k] - centre[k]) - half;
            let mut kept = SmallVec::new();
            for (i, a) in polygon.iter().enumerate() {
                let b = &polygon[(i + 1) % polygon.len()];
                let (u, v) = (above(a), above(b));
                if u <= 0.0 {
                    kept.push(*a);
                }
                if (u < 0.0 && v > 0.0) || (u > 0.0 && v < 0.0) {
                    kept.push(a + (b - a) * (u / (u - v)));
                }
            }
            polygon = kept;
            if polygon.is_empty() {
                return polygon;
            }
        }
    }
    polygon
}
