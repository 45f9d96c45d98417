//! Triangles over dexels: the paper's §6, with walls where neighbours differ.
//!
//! Each square of four neighbouring lines is cut into two triangles of three lines. Over such a triangle, intervals that
//! overlap belong together, and what belongs together on all three lines is a *prism*: its upper and lower faces join the
//! intervals' ends, with the exact normals that the ends know. Gaps between the intervals of a prism are prisms of air in it,
//! by the same rule. The sides of a prism that its neighbour does not share become vertical walls; so every prism is closed,
//! and the volume that the triangles enclose is the sum of the prisms.

use crate::dexels::Dexels;
use crate::interval::{End, Source};
use crate::mesh::Mesh;
use rayon::prelude::*;
use smallvec::SmallVec;

/// Where the exact normal of an end and that of a triangle enclose more than this (as cosine), the triangle is a wall or
/// bridges an edge of the part: its corner is shaded flat.
const CREASE: f64 = 0.6;

/// The surface of the material as triangles, counter-clockwise seen from outside.
///
/// The first vertices are the ends of all intervals, in the order of the lines and from below; others follow where shading has a
/// crease. Between the lines the triangles know nothing: an edge of the part is as sharp as the grid is fine.
///
/// ```
/// use sweepsim_dexel::{Grid, Stock, surface};
/// let grid = Grid::new([0.0, 0.0], [3.0, 3.0], [3, 3])?;
/// let block = Stock::Block { min: [0.0; 3], max: [3.0, 3.0, 1.0] }.dexels(&grid)?;
/// let mesh = surface(&block);
/// // Four squares above and below, two triangles each; eight walls round about.
/// assert_eq!(mesh.triangles.len(), 2 * 4 * 2 + 8 * 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn surface(dexels: &Dexels) -> Mesh {
    let [columns, rows] = dexels.grid().cells();
    let mut mesh = Mesh::default();
    let mut first = Vec::with_capacity(dexels.grid().len());
    for index in 0..dexels.grid().len() {
        first.push(mesh.vertices.len() as u32);
        for k in 0..2 * dexels.at(index).len() {
            let end = end(dexels, index, k);
            mesh.vertices.push(position(dexels, index, &end));
            mesh.normals.push(end.normal);
            mesh.cut.push(is_cut(&end));
        }
    }
    let mut lattice = Squares {
        dexels,
        first,
        diagonals: Vec::new(),
        stock: mesh.cut.contains(&false),
    };
    lattice.diagonals = (0..(columns - 1) * (rows - 1))
        .into_par_iter()
        .map(|square| lattice.diagonal(square / (rows - 1), square % (rows - 1)))
        .collect();
    let strips: Vec<Strip> = (0..columns).into_par_iter().map(|i| lattice.strip(i)).collect();
    let mut walls = Vec::new();
    for strip in strips {
        walls.extend(strip.walls);
        let offset = mesh.vertices.len() as u32;
        mesh.vertices.extend(strip.vertices);
        mesh.normals.extend(strip.normals);
        mesh.cut.extend(strip.cut);
        mesh.triangles.extend(strip.triangles.into_iter().map(|corners| {
            corners.map(|corner| match corner {
                Corner::End(vertex) => vertex,
                Corner::Own(vertex) => offset + vertex,
            })
        }));
    }
    add_walls(&mut mesh, &walls);
    mesh
}

/// End `k` of a line, counted from below.
fn end(dexels: &Dexels, index: usize, k: usize) -> End {
    let interval = dexels.at(index)[k / 2];
    if k.is_multiple_of(2) {
        interval.lower
    } else {
        interval.upper
    }
}

fn position(dexels: &Dexels, index: usize, end: &End) -> [f64; 3] {
    let (i, j) = dexels.grid().place(index);
    [dexels.grid().x(i), dexels.grid().y(j), end.z]
}

fn is_cut(end: &End) -> bool {
    end.source.path != Source::STOCK.path
}

/// A vertex: the end of an interval, or one of the strip's own.
#[derive(Clone, Copy)]
enum Corner {
    End(u32),
    Own(u32),
}

/// What one row of squares gives.
#[derive(Default)]
struct Strip {
    vertices: Vec<[f64; 3]>,
    normals: Vec<[f32; 3]>,
    cut: Vec<bool>,
    triangles: Vec<[Corner; 3]>,
    walls: Vec<Wall>,
}

/// A vertical wall over the line from one dexel to another.
struct Wall {
    lines: [usize; 2],
    /// Lower and upper end on each line.
    places: [[[f64; 3]; 2]; 2],
    normal: [f64; 3],
    length: f64,
    cut: bool,
    /// Whether the material is to the left.
    solid: bool,
}

impl Strip {
    fn vertex(&mut self, place: [f64; 3], normal: [f64; 3], cut: bool) -> Corner {
        self.vertices.push(place);
        self.normals.push(normal.map(|c| c as f32));
        self.cut.push(cut);
        Corner::Own(self.vertices.len() as u32 - 1)
    }
}

/// Intervals (or gaps) of three lines that belong together: on each line from one end to another, counted from below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Prism {
    solid: bool,
    ends: [[usize; 2]; 3],
}

type Prisms = SmallVec<[Prism; 2]>;

/// What is seen of a prism on the side over two lines.
type Side = (bool, [[usize; 2]; 2]);

struct Squares<'a> {
    dexels: &'a Dexels,
    /// Number of the vertex of each line's lowest end.
    first: Vec<u32>,
    /// Of each square, whether the diagonal from its first corner is the cut; otherwise the other one is.
    diagonals: Vec<bool>,
    /// Whether any of the material's boundary is that of a stock.
    stock: bool,
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (subtract(b, a), subtract(c, a));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = dot(n, n).sqrt();
    if length > 0.0 { n.map(|c| c / length) } else { n }
}

impl Squares<'_> {
    /// The corners of a square, counter-clockwise from above.
    fn corners(&self, i: usize, j: usize) -> [usize; 4] {
        let index = |i, j| self.dexels.grid().index(i, j);
        [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]
    }

    /// Whether the first diagonal joins what is more alike.
    fn diagonal(&self, i: usize, j: usize) -> bool {
        let [a, b, c, d] = self.corners(i, j);
        let difference = |p, q| {
            let (p, q) = (self.dexels.at(p), self.dexels.at(q));
            match (p, q) {
                ([], []) => 0.0,
                ([], _) | (_, []) => f64::INFINITY,
                ([p0, ..], [q0, ..]) => {
                    let (p1, q1) = (&p[p.len() - 1], &q[q.len() - 1]);
                    (p0.lower.z - q0.lower.z).abs() + (p1.upper.z - q1.upper.z).abs()
                }
            }
        };
        difference(a, c) <= difference(b, d)
    }

    /// The triangles of a square: counter-clockwise from above.
    fn triangles(&self, i: usize, j: usize) -> [[usize; 3]; 2] {
        let [a, b, c, d] = self.corners(i, j);
        let [_, rows] = self.dexels.grid().cells();
        if self.diagonals[i * (rows - 1) + j] {
            [[a, b, c], [a, c, d]]
        } else {
            [[a, b, d], [b, c, d]]
        }
    }

    /// The triangle of a square, if there is such a square, that has the side from `p` to `q`.
    fn beside(&self, i: Option<usize>, j: Option<usize>, p: usize, q: usize) -> Option<[usize; 3]> {
        let [columns, rows] = self.dexels.grid().cells();
        let (i, j) = (i?, j?);
        if i + 1 >= columns || j + 1 >= rows {
            return None;
        }
        self.triangles(i, j)
            .into_iter()
            .find(|triangle| triangle.contains(&p) && triangle.contains(&q))
    }

    fn z(&self, index: usize, k: usize) -> f64 {
        let interval = &self.dexels.at(index)[k / 2];
        if k.is_multiple_of(2) {
            interval.lower.z
        } else {
            interval.upper.z
        }
    }

    /// The prisms over a triangle.
    fn prisms(&self, triangle: [usize; 3]) -> Prisms {
        let mut prisms = Prisms::new();
        let counts = triangle.map(|index| self.dexels.at(index).len());
        if counts.iter().all(|count| *count > 0) {
            self.group(triangle, counts.map(|count| [0, 2 * count]), true, &mut prisms);
        }
        prisms
    }

    /// The prisms of slabs: pairs of successive ends in the given ranges of ends.
    fn group(&self, triangle: [usize; 3], ranges: [[usize; 2]; 3], solid: bool, prisms: &mut Prisms) {
        if ranges.iter().any(|range| range[0] >= range[1]) {
            return;
        }
        // Line, first end, group.
        let mut slabs: SmallVec<[(usize, usize, usize); 6]> = SmallVec::new();
        for (line, range) in ranges.iter().enumerate() {
            for first in (range[0]..range[1]).step_by(2) {
                slabs.push((line, first, slabs.len()));
            }
        }
        for p in 0..slabs.len() {
            for q in p + 1..slabs.len() {
                let ((line, first, a), (other, second, b)) = (slabs[p], slabs[q]);
                let z = |line: usize, k: usize| self.z(triangle[line], k);
                let overlap = z(line, first) < z(other, second + 1) && z(other, second) < z(line, first + 1);
                if line != other && a != b && overlap {
                    slabs.iter_mut().filter(|slab| slab.2 == b).for_each(|slab| slab.2 = a);
                }
            }
        }
        for group in 0..slabs.len() {
            let mut ends = [[usize::MAX, 0]; 3];
            for (line, first, _) in slabs.iter().filter(|slab| slab.2 == group) {
                ends[*line][0] = ends[*line][0].min(*first);
                ends[*line][1] = ends[*line][1].max(first + 1);
            }
            if ends.iter().all(|range| range[0] < range[1]) {
                prisms.push(Prism { solid, ends });
                self.group(triangle, ends.map(|[lo, hi]| [lo + 1, hi]), !solid, prisms);
            }
        }
    }

    /// The sides that the prisms over a triangle show over its side from `p` to `q`.
    fn sides(&self, triangle: Option<[usize; 3]>, p: usize, q: usize) -> SmallVec<[Side; 2]> {
        let Some(triangle) = triangle else {
            return SmallVec::new();
        };
        let place = |index| triangle.iter().position(|corner| *corner == index).unwrap_or(0);
        let (p, q) = (place(p), place(q));
        let side = |prism: Prism| (prism.solid, [prism.ends[p], prism.ends[q]]);
        self.prisms(triangle).into_iter().map(side).collect()
    }

    /// What lies between the columns `i` and `i + 1`, and the walls along column `i`.
    fn strip(&self, i: usize) -> Strip {
        let [columns, rows] = self.dexels.grid().cells();
        let index = |i, j| self.dexels.grid().index(i, j);
        let mut strip = Strip::default();
        for j in 0..rows {
            if j + 1 < rows {
                let (p, q) = (index(i, j), index(i, j + 1));
                let left = self.beside(i.checked_sub(1), Some(j), p, q);
                self.walls(p, q, left, self.beside(Some(i), Some(j), p, q), &mut strip);
            }
            if i + 1 == columns {
                continue;
            }
            let (p, q) = (index(i, j), index(i + 1, j));
            // From p to q, the square of greater j is on the left.
            let right = self.beside(Some(i), j.checked_sub(1), p, q);
            self.walls(p, q, self.beside(Some(i), Some(j), p, q), right, &mut strip);
            if j + 1 == rows {
                continue;
            }
            let triangles = self.triangles(i, j);
            for triangle in triangles {
                for prism in self.prisms(triangle) {
                    self.faces(triangle, &prism, &mut strip);
                }
            }
            let [a, b, c, d] = self.corners(i, j);
            let first = self.diagonals[i * (rows - 1) + j];
            let (p, q) = if first { (a, c) } else { (b, d) };
            // The left of a → c has d, the left of b → d has a.
            let [one, other] = triangles;
            let (left, right) = if first { (other, one) } else { (one, other) };
            self.walls(p, q, Some(left), Some(right), &mut strip);
        }
        strip
    }

    /// The upper and the lower face of a prism.
    fn faces(&self, triangle: [usize; 3], prism: &Prism, strip: &mut Strip) {
        for (level, up) in [(1, prism.solid), (0, !prism.solid)] {
            let order = if up { [0, 1, 2] } else { [0, 2, 1] };
            let ends = order.map(|k| (triangle[k], prism.ends[k][level]));
            let places = ends.map(|(index, k)| position(self.dexels, index, &end(self.dexels, index, k)));
            let flat = unit_normal(places);
            // What joins a cut and an uncut place is a wall that the cut left.
            let cut = ends.iter().any(|(index, k)| is_cut(&end(self.dexels, *index, *k)));
            let corners = [0, 1, 2].map(|k| {
                let (index, number) = ends[k];
                let end = end(self.dexels, index, number);
                if dot(end.normal.map(f64::from), flat) < CREASE {
                    strip.vertex(places[k], flat, cut)
                } else {
                    Corner::End(self.first[index] + number as u32)
                }
            });
            strip.triangles.push(corners);
        }
    }

    /// Closes the sides over the line from `p` to `q` that only one of the triangles to its left and right has.
    fn walls(&self, p: usize, q: usize, left: Option<[usize; 3]>, right: Option<[usize; 3]>, strip: &mut Strip) {
        let single = |triangle: [usize; 3]| {
            let [a, b, c] = triangle.map(|index| self.dexels.at(index));
            let over = |a: &[_], b: &[_]| a.len() == 1 && b.len() == 1;
            over(a, b) && over(b, c)
        };
        // The usual case: nothing to compare.
        if let (Some(left), Some(right)) = (left, right)
            && single(left)
            && single(right)
            && self.prisms(left).len() == 1
            && self.prisms(right).len() == 1
        {
            return;
        }
        let (on_left, on_right) = (self.sides(left, p, q), self.sides(right, p, q));
        for side in on_left.iter().filter(|side| !on_right.contains(side)) {
            strip.walls.push(self.wall(p, q, side, on_right.is_empty()));
        }
        for (solid, [a, b]) in on_right.iter().filter(|side| !on_left.contains(side)) {
            strip
                .walls
                .push(self.wall(q, p, &(*solid, [*b, *a]), on_left.is_empty()));
        }
    }

    /// The side over the line from `p` to `q` of a prism on its left; `outside` when there is no prism on its right.
    fn wall(&self, p: usize, q: usize, (solid, ends): &Side, outside: bool) -> Wall {
        let at = |index: usize, k: usize| {
            let end = end(self.dexels, index, k);
            position(self.dexels, index, &end)
        };
        let [lower_p, upper_p] = ends[0].map(|k| at(p, k));
        let [lower_q, upper_q] = ends[1].map(|k| at(q, k));
        let along = subtract(lower_q, lower_p);
        let length = along[0].hypot(along[1]);
        let sign = if *solid { 1.0 / length } else { -1.0 / length };
        // A tool made the sides of what it hollowed out; the outside of stock is its own.
        let mut between = [(p, ends[0]), (q, ends[1])]
            .into_iter()
            .flat_map(|(index, [lo, hi])| (lo..=hi).map(move |k| is_cut(&end(self.dexels, index, k))));
        let cut = if outside && *solid {
            !self.stock
        } else {
            between.any(|cut| cut)
        };
        Wall {
            lines: [p, q],
            places: [[lower_p, upper_p], [lower_q, upper_q]],
            normal: [along[1] * sign, -along[0] * sign, 0.0],
            length,
            cut,
            solid: *solid,
        }
    }
}

/// Adds the walls. Those that meet at a small angle are stairs of a round or slanted wall, and are shaded as one.
fn add_walls(mesh: &mut Mesh, walls: &[Wall]) {
    let mut at: Vec<(usize, usize)> = walls
        .iter()
        .enumerate()
        .flat_map(|(number, wall)| wall.lines.map(|line| (line, number)))
        .collect();
    at.sort_unstable();
    let starts: Vec<&[(usize, usize)]> = at.chunk_by(|a, b| a.0 == b.0).collect();
    let range = |wall: &Wall, line: usize| {
        let [lower, upper] = wall.places[usize::from(wall.lines[1] == line)];
        (lower[2], upper[2])
    };
    for wall in walls {
        let normals = wall.lines.map(|line| {
            let group = starts.binary_search_by_key(&line, |group| group[0].0).unwrap_or(0);
            let (lower, upper) = range(wall, line);
            let mut sum = [0.0; 3];
            for other in starts[group].iter().map(|(_, number)| &walls[*number]) {
                let (low, high) = range(other, line);
                if dot(other.normal, wall.normal) > CREASE && low < upper && lower < high {
                    sum = [0, 1, 2].map(|k| sum[k] + other.normal[k] * other.length);
                }
            }
            let length = dot(sum, sum).sqrt();
            sum.map(|c| (c / length) as f32)
        });
        let first = mesh.vertices.len() as u32;
        for (places, normal) in wall.places.iter().zip(normals) {
            for place in places {
                mesh.vertices.push(*place);
                mesh.normals.push(normal);
                mesh.cut.push(wall.cut);
            }
        }
        // Lower and upper at p, lower and upper at q.
        let quad = if wall.solid {
            [[0, 2, 3], [0, 3, 1]]
        } else {
            [[0, 3, 2], [0, 1, 3]]
        };
        mesh.triangles.extend(quad.map(|t| t.map(|k| first + k)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Grid, Interval};
    use proptest::prelude::*;

    fn grid(cells: [usize; 2]) -> Grid {
        Grid::new([0.0, 0.0], cells.map(|n| n as f64), cells).unwrap()
    }

    /// Six times the volume that the triangles enclose.
    fn volume(mesh: &Mesh) -> f64 {
        let six: f64 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|k| mesh.vertices[k as usize]);
                a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0])
            })
            .sum();
        six / 6.0
    }

    /// Whether every edge is used as often one way as the other, by places.
    fn is_closed(mesh: &Mesh) -> bool {
        let triangles = mesh.triangles.iter();
        let soup = crate::TriangleSoup {
            triangles: triangles.map(|t| t.map(|k| mesh.vertices[k as usize])).collect(),
        };
        soup.triangles.is_empty() || soup.check_closed().is_ok()
    }

    fn filled(cells: [usize; 2], intervals: impl Fn(usize, usize) -> Vec<(f64, f64)>) -> Dexels {
        let mut dexels = Dexels::empty(grid(cells));
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                let line: Vec<Interval> = intervals(i, j).iter().map(|(a, b)| Interval::between(*a, *b)).collect();
                dexels.set(dexels.grid().index(i, j), &line);
            }
        }
        dexels
    }

    #[test]
    fn nothing_gives_nothing() {
        assert_eq!(surface(&Dexels::empty(grid([4, 5]))), Mesh::default());
        // One line alone spans no triangle.
        assert!(surface(&filled([1, 1], |_, _| vec![(0.0, 1.0)])).triangles.is_empty());
    }

    #[test]
    fn a_step_a_hole_and_a_cavity_are_closed() {
        let step = surface(&filled([4, 3], |i, _| vec![(0.0, if i < 2 { 1.0 } else { 3.0 })]));
        assert!(is_closed(&step));
        // Lines at i = 0, 1 of height 1, then 3 at 2, 3: 1·1 + 2·1 + 3·1, times 2 along y.
        assert!((volume(&step) - 12.0).abs() < 1e-12);
        let hole = surface(&filled([5, 5], |i, j| {
            if (i, j) == (2, 2) { vec![] } else { vec![(0.0, 1.0)] }
        }));
        assert!(is_closed(&hole));
        assert!((volume(&hole) - (16.0 - 2.0)).abs() < 1e-12, "{}", volume(&hole));
        let inside = |i: usize| (1..4).contains(&i);
        let cavity = surface(&filled([5, 5], |i, j| {
            if inside(i) && inside(j) {
                vec![(0.0, 1.0), (2.0, 3.0)]
            } else {
                vec![(0.0, 3.0)]
            }
        }));
        assert!(is_closed(&cavity));
        assert!(
            (volume(&cavity) - (16.0 * 3.0 - 4.0)).abs() < 1e-12,
            "{}",
            volume(&cavity)
        );
    }

    proptest! {
        /// Whatever the dexels: closed, of the prisms' volume, and facing out of the material.
        #[test]
        fn random_dexels(lines in proptest::collection::vec(proptest::collection::btree_set(0..12_u32, 0..7), 20)) {
            let dexels = filled([5, 4], |i, j| {
                let heights: Vec<f64> = lines[i * 4 + j].iter().map(|z| f64::from(*z)).collect();
                heights.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
            });
            let mesh = surface(&dexels);
            prop_assert!(is_closed(&mesh));
            let squares = Squares { dexels: &dexels, first: vec![], diagonals: vec![true; 12], stock: false };
            let diagonals: Vec<bool> = (0..12).map(|square| squares.diagonal(square / 3, square % 3)).collect();
            let squares = Squares { diagonals, ..squares };
            let mut expected = 0.0;
            for triangle in (0..12).flat_map(|square| squares.triangles(square / 3, square % 3)) {
                for prism in squares.prisms(triangle) {
                    let heights = [0, 1, 2].map(|k| squares.z(triangle[k], prism.ends[k][1]) - squares.z(triangle[k], prism.ends[k][0]));
                    let part = heights.iter().sum::<f64>() / 6.0;
                    expected += if prism.solid { part } else { -part };
                }
            }
            prop_assert!((volume(&mesh) - expected).abs() < 1e-9, "{} {}", volume(&mesh), expected);
            for triangle in &mesh.triangles {
                let flat = unit_normal(triangle.map(|k| mesh.vertices[k as usize]));
                for k in triangle {
                    prop_assert!(dot(flat, mesh.normals[*k as usize].map(f64::from)) >= CREASE - 1e-6 || flat == [0.0; 3]);
                }
            }
        }
    }
}
