//! The way of the tools, their shapes, solids and programs.

use super::arrays::{Arrays, Scale, octahedron};
use crate::scene::{ProgramText, Solid, SolidKind, ToolPart, ToolShape, Track};
use serde::Serialize;

/// Steps of the clock and of tips: a single-precision number of the page holds each exactly.
const STEPS: u32 = 1 << 24;

#[derive(Clone, Debug, Serialize)]
pub(crate) struct TrackHead {
    unit: String,
    clock: Scale,
    tip: [Scale; 3],
}

pub(crate) fn track(track: &Track) -> (TrackHead, Arrays) {
    let points = &track.points;
    let mut arrays = Arrays::default();
    let clock = Scale::over(points.iter().map(|point| point.clock), STEPS);
    let clocks: Vec<u32> = points.iter().map(|point| clock.steps(point.clock, STEPS)).collect();
    arrays.u32("track.clock", &clocks);
    let tip = [0, 1, 2].map(|k| Scale::over(points.iter().map(|point| point.tip[k]), STEPS));
    for (k, name) in ["track.x", "track.y", "track.z"].into_iter().enumerate() {
        let steps: Vec<u32> = points.iter().map(|point| tip[k].steps(point.tip[k], STEPS)).collect();
        arrays.u32(name, &steps);
    }
    let axes: Vec<[f64; 2]> = points.iter().map(|point| octahedron(point.axis)).collect();
    for (k, name) in ["track.u", "track.v"].into_iter().enumerate() {
        let own: Vec<i16> = axes.iter().map(|axis| (axis[k] * 32_767.0).round() as i16).collect();
        arrays.i16(name, &own);
    }
    let numbers: Vec<u32> = points.iter().map(|point| point.number).collect();
    arrays.u32("track.move", &numbers);
    let flags = |rapid: bool, begins: bool| u16::from(rapid) | u16::from(begins) << 1;
    let flags: Vec<u16> = points.iter().map(|point| flags(point.rapid, point.begins)).collect();
    arrays.u16("track.flags", &flags);
    let tools: Vec<u16> = points.iter().map(|point| point.tool).collect();
    arrays.u16("track.tool", &tools);
    let files: Vec<u16> = track.lines.iter().map(|(file, _)| *file).collect();
    arrays.u16("moves.file", &files);
    let lines: Vec<u32> = track.lines.iter().map(|(_, line)| *line).collect();
    arrays.u32("moves.line", &lines);
    let head = TrackHead {
        unit: track.unit.clone(),
        clock,
        tip,
    };
    (head, arrays)
}

/// A shape: its profile as it is, or the numbers of vertices and triangles in the arrays.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShapeHead {
    Profile(Vec<[f64; 2]>),
    Mesh { vertices: usize, triangles: usize },
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct ToolHead {
    name: String,
    cutter: Vec<ShapeHead>,
    bodies: Vec<ShapeHead>,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct SolidHead {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    setup: Option<u16>,
    #[serde(skip_serializing_if = "Option::is_none")]
    link: Option<u16>,
    vertices: usize,
    triangles: usize,
}

/// All meshes behind each other.
#[derive(Default)]
struct Meshes {
    vertices: Vec<[f64; 3]>,
    corners: Vec<u32>,
}

impl Meshes {
    fn push(&mut self, vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> (usize, usize) {
        let good = |triangle: &&[u32; 3]| triangle.iter().all(|v| (*v as usize) < vertices.len());
        let before = self.corners.len();
        self.corners.extend(triangles.iter().filter(good).flatten());
        self.vertices.extend_from_slice(vertices);
        (vertices.len(), (self.corners.len() - before) / 3)
    }

    fn shapes(&mut self, shapes: &[ToolShape]) -> Vec<ShapeHead> {
        let head = |shape: &ToolShape| match shape {
            ToolShape::Profile(points) => ShapeHead::Profile(points.clone()),
            ToolShape::Mesh { vertices, triangles } => {
                let (vertices, triangles) = self.push(vertices, triangles);
                ShapeHead::Mesh { vertices, triangles }
            }
        };
        shapes.iter().map(head).collect()
    }
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct MeshHead {
    tools: Vec<ToolHead>,
    solids: Vec<SolidHead>,
    places: [Scale; 3],
}

/// Meshes of tools, then of solids.
pub(crate) fn meshes(tools: &[ToolPart], solids: &[Solid]) -> (MeshHead, Arrays) {
    let mut meshes = Meshes::default();
    let tools = tools
        .iter()
        .map(|tool| ToolHead {
            name: tool.name.clone(),
            cutter: meshes.shapes(&tool.cutter),
            bodies: meshes.shapes(&tool.bodies),
        })
        .collect();
    let solids = solids
        .iter()
        .map(|solid| {
            let (vertices, triangles) = meshes.push(&solid.vertices, &solid.triangles);
            let kind = match solid.kind {
                SolidKind::Stock => "stock",
                SolidKind::Target => "target",
                SolidKind::Fixture => "fixture",
                SolidKind::Body { .. } => "body",
            };
            let link = match solid.kind {
                SolidKind::Body { link } => Some(link),
                _ => None,
            };
            SolidHead {
                kind,
                setup: solid.setup,
                link,
                vertices,
                triangles,
            }
        })
        .collect();
    let places = [0, 1, 2].map(|k| Scale::over(meshes.vertices.iter().map(|v| v[k]), u32::from(u16::MAX)));
    let mut arrays = Arrays::default();
    for (k, name) in ["mesh.x", "mesh.y", "mesh.z"].into_iter().enumerate() {
        let steps = |v: &[f64; 3]| places[k].steps(v[k], u32::from(u16::MAX)) as u16;
        let own: Vec<u16> = meshes.vertices.iter().map(steps).collect();
        arrays.u16(name, &own);
    }
    arrays.u32("mesh.corners", &meshes.corners);
    (MeshHead { tools, solids, places }, arrays)
}

/// Names, and all texts with a character between them that none holds.
pub(crate) fn programs(programs: &[ProgramText]) -> (Vec<String>, Arrays) {
    let names = programs.iter().map(|program| program.name.clone()).collect();
    let texts: Vec<String> = programs.iter().map(|program| program.text.replace('\0', " ")).collect();
    let mut arrays = Arrays::default();
    arrays.text("programs", texts.join("\0").into_bytes());
    (names, arrays)
}
