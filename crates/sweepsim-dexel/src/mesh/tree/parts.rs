//! Triangles in parts, for trees of boxes.
//!
//! The box of a long and narrow triangle that lies aslant is almost empty, and those of its neighbours in a fan or
//! along a shaft are almost the same: a tree of them tells nothing apart. Such triangles are cut across into parts,
//! each with its own box (*early split clipping*; Ernst, Greiner 2007).

/// The box of a triangle, or of a part of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrianglePart {
    /// The number of the triangle.
    pub face: u32,
    pub low: [f64; 3],
    pub high: [f64; 3],
    /// The sum of the triangle's corners, or three times the middle of the part's box.
    pub place: [f64; 3],
}

/// A triangle is cut if half the surface of its box is more than so many times its area. Of half a rectangle across an
/// axis, it is twice the area.
const EMPTY: f64 = 32.0;
/// So many parts for one whose box is just as empty as that, and twice as many where it is twice as empty, on average
/// up to a number; and the most of one and of all.
const PARTS: f64 = 12.0;
const EACH: f64 = 64.0;
const MOST: f64 = 512.0;
const ALL: f64 = (1 << 20) as f64;

type Triangle = [[f64; 3]; 3];

fn hull(points: impl Iterator<Item = [f64; 3]>) -> [[f64; 3]; 2] {
    points.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[low, high], p| {
        [
            [0, 1, 2].map(|k| low[k].min(p[k])),
            [0, 1, 2].map(|k| high[k].max(p[k])),
        ]
    })
}

/// The root of half the surface of a triangle's box, and into how many parts it is worth to be cut; of others, 0.
fn width(triangle: &Triangle) -> [f64; 2] {
    let [low, high] = hull(triangle.iter().copied());
    let [a, b, c] = [0, 1, 2].map(|k| high[k] - low[k]);
    let surface = a * b + b * c + c * a;
    let normal = crate::vector::normal_of(*triangle);
    let area = 0.5 * crate::vector::length(normal);
    if surface > EMPTY * area && surface.is_finite() {
        [surface.sqrt(), (PARTS * surface / (EMPTY * area)).min(EACH)]
    } else {
        [0.0; 2]
    }
}

/// The parts of all triangles: of most, one.
///
/// The sum of the boxes' surfaces is least if there are as many parts of a triangle as the root of its own is large.
pub(super) fn of(triangles: impl Iterator<Item = Triangle> + Clone) -> Vec<TrianglePart> {
    let (mut sum, mut all, mut count) = (0.0, 0.0_f64, 0);
    for [width, share] in triangles.clone().map(|triangle| width(&triangle)) {
        sum += width;
        all += share;
        count += 1;
    }
    let all = all.min(ALL);
    let mut parts = Vec::with_capacity(count + all as usize);
    for (face, triangle) in triangles.enumerate() {
        let [width, _] = width(&triangle);
        let share = if width > 0.0 {
            (all * width / sum).clamp(1.0, MOST) as usize
        } else {
            1
        };
        let [low, high] = hull(triangle.iter().copied());
        if share <= 1 {
            let place = [0, 1, 2].map(|k| triangle.iter().map(|p| p[k]).sum());
            let face = face as u32;
            parts.push(TrianglePart { face, low, high, place });
            continue;
        }
        let axis = (0..3).fold(0, |a, k| if high[k] - low[k] > high[a] - low[a] { k } else { a });
        let at = |n: usize| low[axis] + (high[axis] - low[axis]) * (n as f64 / share as f64);
        parts.extend((0..share).map(|n| slab(face as u32, &triangle, axis, [at(n), at(n + 1)])));
    }
    parts
}

/// The part of a triangle between two heights along an axis.
fn slab(face: u32, triangle: &Triangle, axis: usize, [from, to]: [f64; 2]) -> TrianglePart {
    let sides = (0..3).map(|k| [triangle[k], triangle[(k + 1) % 3]]);
    let crossings = sides.flat_map(|[a, b]| {
        [from, to].into_iter().filter_map(move |height| {
            let part = (height - a[axis]) / (b[axis] - a[axis]);
            (0.0..=1.0)
                .contains(&part)
                .then(|| [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k])))
        })
    });
    let corners = triangle.iter().copied().filter(|p| from <= p[axis] && p[axis] <= to);
    let [mut low, mut high] = hull(crossings.chain(corners));
    // Crossings are rounded, and so are the heights: a box too large does no harm.
    let size = triangle.iter().flatten().fold(0.0_f64, |size, c| size.max(c.abs()));
    let rounding = 16.0 * f64::EPSILON * size;
    for k in 0..3 {
        (low[k], high[k]) = (low[k] - rounding, high[k] + rounding);
    }
    let place = [0, 1, 2].map(|k| 1.5 * (low[k] + high[k]));
    TrianglePart { face, low, high, place }
}
