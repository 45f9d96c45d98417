//! A closed surface of triangles around dexels.
//!
//! The paper (section 6) spans two triangles over the upper and two over the lower ends of every square of four
//! neighbouring dexels, with the envelope's normals at the corners. We do the same wherever the surface is
//! smooth. Elsewhere a dexel represents the cell around it:
//!
//! 1. **Along every grid edge** the ends of its two dexels are [joined](edge): two ends belong together if the line
//!    between them is compatible with their normals, so sheets are continued by tangents rather than by overlap. A join
//!    is smooth or a *crease*, where the tangents meet at an angle. An end left over is a *step*.
//! 2. **Creases and steps draw an outline** on the grid: a polyline with one vertex in every square that it passes
//!    through and one on every grid edge that it crosses. A crease crosses where the tangents meet. A step may be
//!    anywhere between its dexels, so its [outline] is relaxed to a smooth line that keeps its corners.
//! 3. **In every square** faces extend from the dexels to the outline along their tangents. On the outline stand
//!    vertical walls, wherever there is material on one side only.
//!
//! The grid is surrounded by dexels without material. So the surface of any dexels is closed: every edge is used
//! equally often in both directions. The mesh of a block that fills whole cells is that block.

mod batch;
mod edge;
mod outline;
mod sources;
mod square;
mod steps;
mod wall;

use crate::dexels::Dexels;
use crate::intervals::{End, Interval, Source};
use crate::mesh::{MOST_VERTICES, Mesh, MeshError, check_vertices};
use crate::vector::{dot, normal_of};
use batch::TriangleBatch;
use edge::{Class, Edge};
use outline::Outline;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
pub(crate) use sources::sources_in;
use square::Square;
pub use steps::{Step, steps};

/// Cosine of 40°: a triangle does not share a vertex whose normal is farther than this from its own.
const CRISP: f64 = 0.766;

impl Dexels {
    /// The closed surface of the material, as triangles with normals, in world coordinates.
    ///
    /// Vertices lie at the ends of the intervals, and on outlines between dexels where there is a step or a crease;
    /// there each side has its own vertex. At the ends the normals are those of the dexels. A vertex is marked as cut
    /// if a tool made the end. A wall is marked as cut if a tool made the end that bounds the space in front of it;
    /// beside a dexel without material, if it is inside a hole or both ends of the interval behind it were cut.
    /// [`Dexels::sources`] tells which cuts.
    ///
    /// The mesh is the same for any number of threads.
    ///
    /// ```
    /// use sweepsim_dexel::{Dexels, Grid, Interval};
    /// let grid = Grid::new([0.0, 0.0], [2.0, 2.0], [2, 2])?;
    /// let dexels = Dexels::from_fn(grid, |_, line| line.push(Interval::between(0.0, 5.0)))?;
    /// let mesh = dexels.surface()?;
    /// let highest = mesh.vertices.iter().map(|v| v[2]).fold(f64::MIN, f64::max);
    /// assert_eq!(highest, 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn surface(&self) -> Result<Mesh, MeshError> {
        surface_within(self, MOST_VERTICES)
    }

    /// For each vertex of a mesh of this material, the source of the surface there: for vertices marked as cut, the
    /// source of the nearest interval end that a tool made; for the others, the stock.
    ///
    /// On steep walls the nearest end may be far away; [`TriDexels::sources`](crate::TriDexels::sources) is more
    /// accurate there.
    ///
    /// ```
    /// use sweepsim_dexel::{Grid, Interval, Source, Stock};
    /// let grid = Grid::new([0.0, 0.0], [4.0, 4.0], [4, 4])?;
    /// let mut part = Stock::Block { min: [0.0; 3], max: [4.0, 4.0, 3.0] }.dexels(&grid)?;
    /// let mut cut = Interval::between(2.0, 9.0);
    /// cut.lower.source = Source::Cut { path: 0, segment: 7, t: 0.5 };
    /// part.subtract(5, &[cut])?;
    /// let sources = part.sources(&part.surface()?);
    /// assert!(sources.contains(&cut.lower.source) && sources.contains(&Source::Stock));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn sources(&self, mesh: &Mesh) -> Vec<Source> {
        sources_in(&[self], mesh)
    }
}

/// The surface, if it needs at most this many vertices.
pub fn surface_within(dexels: &Dexels, most: usize) -> Result<Mesh, MeshError> {
    check_vertices(2 * dexels.count(), most)?;
    let field = Field::new(dexels);
    let outline = Outline::new(&field);
    let parts: Vec<TriangleBatch> = (0..=field.cells[0])
        .into_par_iter()
        .map(|si| {
            let mut part = TriangleBatch::new(field.ends());
            for sj in 0..=field.cells[1] {
                Square::emit(&field, &outline, [si, sj], &mut part);
            }
            part
        })
        .collect();
    assemble(&field, parts, most)
}

/// Dexels with a rim of empty ones around them, and the joins between neighbours.
///
/// Square `[si, sj]` has the dexels of columns `si − 1, si` and rows `sj − 1, sj`.
struct Field<'a> {
    dexels: &'a Dexels,
    /// The unpacked intervals of all dexels, since they are used many times.
    intervals: Vec<Interval>,
    cells: [usize; 2],
    spacing: [f64; 2],
    /// The number of the first end of each dexel.
    first: Vec<u32>,
    /// For each square, the classes of the edge along `x` on its lower side and the edge along `y` on its left.
    classes: Vec<[Class; 2]>,
    /// Dexels without material that are connected to the border through such dexels.
    outside: Vec<bool>,
    /// Whether any of the boundary belongs to a stock; if so, the outer walls do, too.
    stock: bool,
}

/// A dexel of a [`Field`].
#[derive(Clone, Copy)]
struct Dexel<'a> {
    line: &'a [Interval],
    at: [f64; 2],
    first: u32,
    /// Outside the stock: walls that face it belong to the stock.
    outside: bool,
}

/// End number `e` of a line, going up.
fn end(line: &[Interval], e: usize) -> &End {
    let interval = &line[e / 2];
    if e.is_multiple_of(2) {
        &interval.lower
    } else {
        &interval.upper
    }
}

fn is_cut(end: &End) -> bool {
    end.source.is_cut()
}

impl<'a> Field<'a> {
    fn new(dexels: &'a Dexels) -> Self {
        let grid = dexels.grid();
        let mut first = Vec::with_capacity(grid.len() + 1);
        let mut count = 0_usize;
        for index in 0..grid.len() {
            first.push(count as u32);
            count += 2 * dexels.at(index).len();
        }
        first.push(count as u32);
        let mut field = Self {
            dexels,
            intervals: dexels.iter().flat_map(|(_, line)| line).collect(),
            cells: grid.cells(),
            spacing: grid.spacing(),
            first,
            classes: Vec::new(),
            outside: outside(dexels),
            stock: dexels
                .iter()
                .any(|(_, line)| line.iter().any(|i| !is_cut(&i.lower) || !is_cut(&i.upper))),
        };
        let [columns, rows] = field.cells;
        field.classes = (0..columns + 2)
            .into_par_iter()
            .flat_map_iter(|si| (0..rows + 2).map(move |sj| [si, sj]))
            .map(|s| [0, 1].map(|axis| field.classify(s, axis)))
            .collect();
        field
    }

    /// The number of ends.
    fn ends(&self) -> u32 {
        self.first.last().copied().unwrap_or(0)
    }

    /// The intervals of dexel `index`.
    fn line(&self, index: usize) -> &[Interval] {
        let [from, to] = [index, index + 1].map(|k| self.first[k] as usize / 2);
        self.intervals.get(from..to).unwrap_or_default()
    }

    fn dexel(&self, si: usize, sj: usize) -> Dexel<'_> {
        let grid = self.dexels.grid();
        let place = |k: usize, s: usize| grid.min()[k] + (s as f64 - 0.5) * self.spacing[k];
        if si == 0 || sj == 0 || si > self.cells[0] || sj > self.cells[1] {
            return Dexel {
                line: &[],
                at: [place(0, si), place(1, sj)],
                first: 0,
                outside: self.stock,
            };
        }
        let index = grid.number(si - 1, sj - 1);
        Dexel {
            line: self.line(index),
            at: [grid.x(si - 1), grid.y(sj - 1)],
            first: self.first[index],
            outside: self.stock && self.outside[index],
        }
    }

    /// Dexel `q` of a square, counter-clockwise from its lower left.
    fn corner(&self, [si, sj]: [usize; 2], q: usize) -> Dexel<'_> {
        self.dexel(si + usize::from(q == 1 || q == 2), sj + usize::from(q >= 2))
    }

    /// The square which has edge `k` of a square as its lower or left edge, and the edge's direction.
    fn edge_home([si, sj]: [usize; 2], k: usize) -> ([usize; 2], usize) {
        match k {
            0 => ([si, sj], 0),
            1 => ([si + 1, sj], 1),
            2 => ([si, sj + 1], 0),
            _ => ([si, sj], 1),
        }
    }

    fn slot(&self, [si, sj]: [usize; 2]) -> usize {
        si * (self.cells[1] + 2) + sj
    }

    /// Class of edge `k` of a square: from its corner `k` to the next.
    fn class(&self, s: [usize; 2], k: usize) -> Class {
        let (home, axis) = Self::edge_home(s, k);
        self.classes[self.slot(home)][axis]
    }

    /// The two dexels of an edge, in the direction of growing `x` or `y`.
    fn edge_dexels(&self, [si, sj]: [usize; 2], axis: usize) -> [Dexel<'_>; 2] {
        [self.dexel(si, sj), self.dexel(si + 1 - axis, sj + axis)]
    }

    fn classify(&self, [si, sj]: [usize; 2], axis: usize) -> Class {
        if [si, sj][axis] > self.cells[axis] {
            return Class::Smooth;
        }
        let [a, b] = self.edge_dexels([si, sj], axis);
        Edge::class(a.line, b.line, axis, self.spacing[axis])
    }
}

/// Marks dexels without material that are connected to the border of the grid through such dexels.
fn outside(dexels: &Dexels) -> Vec<bool> {
    let grid = dexels.grid();
    let [columns, rows] = grid.cells();
    let mut outside = vec![false; grid.len()];
    let mut open = Vec::new();
    let mut reach = |i: usize, j: usize, open: &mut Vec<(usize, usize)>| {
        let index = grid.number(i, j);
        if !outside[index] && dexels.at(index).is_empty() {
            outside[index] = true;
            open.push((i, j));
        }
    };
    for i in 0..columns {
        reach(i, 0, &mut open);
        reach(i, rows - 1, &mut open);
    }
    for j in 0..rows {
        reach(0, j, &mut open);
        reach(columns - 1, j, &mut open);
    }
    while let Some((i, j)) = open.pop() {
        if i > 0 {
            reach(i - 1, j, &mut open);
        }
        if i + 1 < columns {
            reach(i + 1, j, &mut open);
        }
        if j > 0 {
            reach(i, j - 1, &mut open);
        }
        if j + 1 < rows {
            reach(i, j + 1, &mut open);
        }
    }
    outside
}

/// Appends the parts of all columns to the vertices of the ends.
fn assemble(field: &Field<'_>, parts: Vec<TriangleBatch>, most: usize) -> Result<Mesh, MeshError> {
    let ends = field.ends() as usize;
    let vertices = ends + parts.iter().map(|p| p.vertices.len()).sum::<usize>();
    check_vertices(vertices, most)?;
    let mut mesh = Mesh {
        vertices: Vec::with_capacity(vertices),
        normals: Vec::with_capacity(vertices),
        cut: Vec::with_capacity(vertices),
        triangles: Vec::with_capacity(parts.iter().map(|p| p.triangles.len()).sum()),
    };
    let grid = field.dexels.grid();
    for index in 0..grid.len() {
        let (i, j) = grid.place(index);
        let line = field.line(index);
        for e in 0..2 * line.len() {
            let end = end(line, e);
            mesh.vertices.push([grid.x(i), grid.y(j), end.z]);
            mesh.normals.push(end.normal);
            mesh.cut.push(is_cut(end));
        }
    }
    let mut creased = Vec::new();
    for part in parts {
        let shift = mesh.vertices.len() - ends;
        let before = mesh.triangles.len();
        creased.extend(
            part.creased
                .iter()
                .map(|(t, c)| (before + *t as usize, usize::from(*c))),
        );
        let moved = |v: u32| {
            if (v as usize) < ends {
                v
            } else {
                v.wrapping_add(shift as u32)
            }
        };
        mesh.triangles.extend(part.triangles.iter().map(|t| t.map(moved)));
        mesh.vertices.extend(part.vertices);
        mesh.normals.extend(part.normals);
        mesh.cut.extend(part.cut);
    }
    split(&mut mesh, &creased);
    check_vertices(mesh.vertices.len(), most)?;
    mesh.move_to_world(grid.frame());
    Ok(mesh)
}

/// If the normal of an end does not suit a triangle, the triangle's corner gets a new vertex with a normal that does:
/// the mean of all such triangles around the end, or the triangle's own.
fn split(mesh: &mut Mesh, creased: &[(usize, usize)]) {
    let across = |mesh: &Mesh, t: usize| normal_of(mesh.triangles[t].map(|v| mesh.vertices[v as usize]));
    // Only used for lookups, so its order does not matter.
    let mut sums: FxHashMap<u32, ([f64; 3], Option<u32>)> = FxHashMap::default();
    for (t, c) in creased {
        let sum = &mut sums.entry(mesh.triangles[*t][*c]).or_insert(([0.0; 3], None)).0;
        let n = across(mesh, *t);
        *sum = [0, 1, 2].map(|k| sum[k] + n[k]);
    }
    for (t, c) in creased {
        let old = mesh.triangles[*t][*c];
        let Some((sum, shared)) = sums.get_mut(&old) else {
            continue;
        };
        let (own, mean) = (unit(across(mesh, *t)), unit(*sum));
        let fits = dot(own, mean) > CRISP;
        let vertex = match *shared {
            Some(vertex) if fits => vertex,
            _ => {
                let vertex = mesh.vertices.len() as u32;
                mesh.vertices.push(mesh.vertices[old as usize]);
                mesh.normals.push(if fits { mean } else { own }.map(|c| c as f32));
                mesh.cut.push(mesh.cut[old as usize]);
                if fits {
                    *shared = Some(vertex);
                }
                vertex
            }
        };
        mesh.triangles[*t][*c] = vertex;
    }
}

/// The unit vector; up for a zero vector.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    if length > 0.0 {
        v.map(|c| c / length)
    } else {
        [0.0, 0.0, 1.0]
    }
}
