//! Collects triangles as they are generated.

use super::{CRISP, dot, normal_of, unit};

/// Cosine of 60°: anything steeper is nearly a wall.
const STEEP: f64 = 0.5;

/// Triangles of some squares. Vertex numbers below `ends` belong to ends; the others count up from there.
pub(super) struct TriangleBatch {
    ends: u32,
    pub vertices: Vec<[f64; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub cut: Vec<bool>,
    pub triangles: Vec<[u32; 3]>,
    /// Triangles, and their corners at ends, that need another normal.
    pub creased: Vec<(u32, u8)>,
}

/// A corner of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// Its number, if it has one.
    pub vertex: Option<u32>,
    pub at: [f64; 3],
    pub normal: [f32; 3],
    pub cut: bool,
}

impl TriangleBatch {
    pub fn new(ends: u32) -> Self {
        Self {
            ends,
            vertices: Vec::new(),
            normals: Vec::new(),
            cut: Vec::new(),
            triangles: Vec::new(),
            creased: Vec::new(),
        }
    }

    pub fn push(&mut self, corner: Corner) -> u32 {
        let number = self.ends.wrapping_add(self.vertices.len() as u32);
        self.vertices.push(corner.at);
        self.normals.push(corner.normal);
        self.cut.push(corner.cut);
        number
    }

    /// A triangle, unless two of its corners are in the same place. Corners with an unsuitable normal become its own.
    fn triangle(&mut self, corners: [Corner; 3]) {
        let [a, b, c] = corners.map(|corner| corner.at);
        if a == b || b == c || c == a {
            return;
        }
        let across = normal_of([a, b, c]);
        let length = dot(across, across).sqrt();
        let steep = across[2].abs() < STEEP * length;
        let flat = unit(across).map(|c| c as f32);
        let triangle = self.triangles.len() as u32;
        let mut numbers = [0; 3];
        for (k, corner) in corners.iter().enumerate() {
            // Which way a steep triangle leans is arbitrary; the normal of its dexel is more reliable.
            let crisp = if steep && f64::from(corner.normal[2].abs()) < STEEP {
                0.0
            } else {
                CRISP
            };
            let suits = dot(across, corner.normal.map(f64::from)) >= crisp * length;
            numbers[k] = match corner.vertex {
                Some(vertex) if suits => vertex,
                Some(vertex) if vertex < self.ends => {
                    self.creased.push((triangle, k as u8));
                    vertex
                }
                _ => self.push(Corner {
                    normal: if suits { corner.normal } else { flat },
                    ..*corner
                }),
            };
        }
        self.triangles.push(numbers);
    }

    /// A triangle of an upper or lower face, given counter-clockwise as seen from above.
    pub fn face(&mut self, upper: bool, [a, b, c]: [Corner; 3]) {
        self.triangle(if upper { [a, b, c] } else { [a, c, b] });
    }

    /// A triangle of a wall, with its normals as given.
    pub fn wall(&mut self, forward: bool, [a, b, c]: [Corner; 3]) {
        if a.at == b.at || b.at == c.at || c.at == a.at {
            return;
        }
        let corners = if forward { [a, b, c] } else { [a, c, b] };
        let numbers = corners.map(|corner| self.push(corner));
        self.triangles.push(numbers);
    }

    /// Two triangles over four corners, along the better diagonal: the one for which the normals are closer to those of
    /// the triangles.
    pub fn quad(&mut self, upper: bool, q: [Corner; 4]) {
        let fit = |corners: [usize; 3]| {
            let n = unit(normal_of(corners.map(|k| q[k].at)));
            let sign = if upper { 1.0 } else { -1.0 };
            corners
                .iter()
                .map(|k| sign * dot(n, q[*k].normal.map(f64::from)))
                .sum::<f64>()
        };
        let flat = q[0].at[2] == q[1].at[2] && q[1].at[2] == q[2].at[2] && q[2].at[2] == q[3].at[2];
        if flat || fit([0, 1, 2]) + fit([0, 2, 3]) >= fit([0, 1, 3]) + fit([1, 2, 3]) {
            self.face(upper, [q[0], q[1], q[2]]);
            self.face(upper, [q[0], q[2], q[3]]);
        } else {
            self.face(upper, [q[0], q[1], q[3]]);
            self.face(upper, [q[1], q[2], q[3]]);
        }
    }
}
