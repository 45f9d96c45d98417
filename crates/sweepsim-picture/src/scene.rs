//! The mesh to draw: checked, clipped at the sections, and scaled.

use crate::base::vector::{Vector, cross, sub, unit};
use crate::view::{CuttingPlane, Drawing};
use sweepsim_dexel::Mesh;

/// Triangles in the unit ball.
#[derive(Default)]
pub(crate) struct Scene {
    pub positions: Vec<Vector>,
    pub normals: Vec<Vector>,
    /// The drawing's values, from −1 to 1; without any, 1 where a tool cut and 0 elsewhere.
    pub values: Vec<f32>,
    /// Whether the drawing has values.
    pub valued: bool,
    pub triangles: Vec<[u32; 3]>,
    /// The first triangle of the tool, after all those of the part.
    pub tool: u32,
    /// What the camera must see: corners of the box that was asked for, or else all positions.
    pub corners: Vec<Vector>,
    /// The section planes: normal towards what is removed, and distance from the centre.
    pub sections: Vec<(Vector, f32)>,
    /// The mesh's size for a unit of the scene.
    pub radius: f64,
    /// Height of the plane that the part lies on.
    pub ground: f32,
}

/// A vertex in the mesh's coordinates.
#[derive(Clone, Copy)]
struct Vertex {
    place: [f64; 3],
    normal: Option<[f32; 3]>,
    value: f32,
}

/// What is left of a mesh: triangles, and the vertices that they use.
#[derive(Default)]
struct ClippedMesh {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
}

impl ClippedMesh {
    /// Keeps the triangles that can be drawn.
    fn new(drawing: &Drawing<'_>) -> Self {
        let mesh: &Mesh = drawing.mesh;
        let with_normals = mesh.normals.len() == mesh.vertices.len();
        let good = |t: &[u32; 3]| {
            t.iter().all(|v| {
                mesh.vertices
                    .get(*v as usize)
                    .is_some_and(|p| p.iter().all(|c| c.is_finite() && c.abs() < 1e150))
            })
        };
        // Vertices without a triangle must not affect the camera.
        let mut numbers = vec![u32::MAX; mesh.vertices.len()];
        let mut clipped = Self::default();
        for t in mesh.triangles.iter().filter(|t| good(t)) {
            let corners = t.map(|v| {
                let number = &mut numbers[v as usize];
                if *number == u32::MAX {
                    *number = clipped.vertices.len() as u32;
                    let cut = || f32::from(u8::from(mesh.cut.get(v as usize).copied().unwrap_or(false)));
                    clipped.vertices.push(Vertex {
                        place: mesh.vertices[v as usize],
                        normal: with_normals.then(|| mesh.normals[v as usize]),
                        value: match drawing.values {
                            [] => cut(),
                            values => values
                                .get(v as usize)
                                .map_or(f32::NAN, |value| (value / drawing.range).clamp(-1.0, 1.0)),
                        },
                    });
                }
                *number
            });
            clipped.triangles.push(corners);
        }
        clipped
    }

    /// Adds another mesh.
    fn append(&mut self, other: Self) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        self.triangles
            .extend(other.triangles.into_iter().map(|t| t.map(|v| first + v)));
    }

    /// Removes the side of a section where `side · (place − at)` is positive.
    fn cut_off(self, section: &CuttingPlane, side: f64) -> Self {
        let height = |v: u32| side * (self.vertices[v as usize].place[section.axis.index()] - section.at);
        let mut kept = Self::default();
        let mut numbers = vec![u32::MAX; self.vertices.len()];
        for t in &self.triangles {
            // The corners of what is left of the triangle, in order.
            let mut polygon: [u32; 4] = [0; 4];
            let mut count = 0;
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let (from, to) = (height(a), height(b));
                let mut push = |v: u32| {
                    polygon[count] = v;
                    count += 1;
                };
                if from <= 0.0 {
                    let number = &mut numbers[a as usize];
                    if *number == u32::MAX {
                        *number = kept.vertices.len() as u32;
                        kept.vertices.push(self.vertices[a as usize]);
                    }
                    push(*number);
                }
                if (from <= 0.0) != (to <= 0.0) {
                    push(kept.vertices.len() as u32);
                    // From the lower end, so that both triangles of an edge are cut at the same point.
                    let (a, b, s) = if from <= 0.0 {
                        (a, b, from / (from - to))
                    } else {
                        (b, a, to / (to - from))
                    };
                    let [a, b] = [a, b].map(|v| self.vertices[v as usize]);
                    kept.vertices.push(between(a, b, s, section));
                }
            }
            for k in 2..count {
                kept.triangles.push([polygon[0], polygon[k - 1], polygon[k]]);
            }
        }
        kept
    }
}

fn between(a: Vertex, b: Vertex, s: f64, section: &CuttingPlane) -> Vertex {
    let t = s as f32;
    let mut place = [0, 1, 2].map(|k| a.place[k] + s * (b.place[k] - a.place[k]));
    place[section.axis.index()] = section.at;
    let normals = a.normal.zip(b.normal);
    Vertex {
        place,
        normal: normals.map(|(a, b)| [0, 1, 2].map(|k| a[k] + t * (b[k] - a[k]))),
        value: a.value + t * (b.value - a.value),
    }
}

impl Scene {
    /// `towards` is the direction of the viewer; everything between the viewer and a section is removed.
    pub fn new(drawing: &Drawing<'_>, towards: [f64; 3]) -> Self {
        let mut clipped = ClippedMesh::new(drawing);
        let sections: Vec<(&CuttingPlane, f64)> = drawing
            .sections
            .iter()
            .filter(|section| section.at.is_finite())
            .map(|section| (section, if towards[section.axis.index()] < 0.0 { -1.0 } else { 1.0 }))
            .collect();
        for (section, side) in &sections {
            clipped = clipped.cut_off(section, *side);
        }
        // The tool does not count for the camera, unless there is nothing else.
        let part = clipped.triangles.len();
        let mut counted = clipped.vertices.len();
        if let Some(tool) = drawing.tool {
            clipped.append(ClippedMesh::new(&Drawing::new(tool)));
        }
        if part == 0 {
            counted = clipped.vertices.len();
        }
        let wanted = drawing.within.filter(|[low, high]| {
            let good = |k: usize| low[k] <= high[k] && low[k].abs() < 1e150 && high[k].abs() < 1e150;
            (0..3).all(good)
        });
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in clipped.vertices[..counted].iter().map(|v| v.place) {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        if clipped.triangles.is_empty() && wanted.is_none() {
            return Self::default();
        }
        if let Some(wanted) = wanted {
            [low, high] = wanted;
        }
        let centre = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let radius = 0.5 * (0..3).map(|k| (high[k] - low[k]).powi(2)).sum::<f64>().sqrt();
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let scaled = |place: [f64; 3]| [0, 1, 2].map(|k| ((place[k] - centre[k]) / radius) as f32);
        let positions: Vec<Vector> = clipped.vertices.iter().map(|v| scaled(v.place)).collect();
        let corner = |n: usize| scaled([0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] }));
        let mut flat = vec![[0.0, 0.0, 1.0]; positions.len()];
        for t in &clipped.triangles {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            for v in t {
                flat[*v as usize] = unit(cross(sub(b, a), sub(c, a)));
            }
        }
        let normals = clipped.vertices.iter().zip(flat);
        Self {
            normals: normals.map(|(v, flat)| v.normal.map_or(flat, unit)).collect(),
            values: clipped.vertices.iter().map(|v| v.value).collect(),
            valued: !drawing.values.is_empty(),
            tool: part as u32,
            corners: match wanted {
                Some(_) => (0..8).map(corner).collect(),
                None => positions[..counted].to_vec(),
            },
            radius,
            ground: ((low[2] - centre[2]) / radius) as f32,
            sections: sections
                .iter()
                .map(|(section, side)| {
                    let mut normal = [0.0; 3];
                    normal[section.axis.index()] = *side as f32;
                    (
                        normal,
                        (side * (section.at - centre[section.axis.index()]) / radius) as f32,
                    )
                })
                .collect(),
            positions,
            triangles: clipped.triangles,
        }
    }
}
