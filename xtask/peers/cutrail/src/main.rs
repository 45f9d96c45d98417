//! A program milled with the mesh booleans of `cutrail`: `cutrail-mill WORK TOLERANCE ANSWER`. Answers the corners of
//! the triangles.

#[path = "../../work.rs"]
mod work;

use cutrail::{Engine, EngineOptions, ManifoldKernel, MotionSegment, Pose, StockShape, Tool};
use work::{Work, answer, seconds};

/// Edge of the tiles, in mm, as in the package's own examples.
const TILE: f64 = 10.0;

fn main() {
    let (work, tolerance) = (Work::read(), Work::setting());
    let options = EngineOptions { sweep_tolerance: tolerance, ..EngineOptions::default() }.with_tile_size(TILE);
    let stock = StockShape::Box { min: work.min, max: work.max };
    let diameter = 2.0 * work.radius;
    let tool = if work.ball { Tool::ball_end_mill(diameter, work.length) } else { Tool::flat_end_mill(diameter, work.length) };
    let poses: Vec<Pose> = work.poses.iter().map(|(tip, axis)| Pose::new(*tip, *axis)).collect();
    let start = seconds();
    let mut engine = Engine::new(ManifoldKernel, &[stock], options).expect("a block");
    for pair in poses.windows(2) {
        engine.cut(&tool, &MotionSegment::linear(pair[0], pair[1])).expect("a move");
    }
    let mesh = engine.combined_mesh();
    let took = seconds() - start;
    let corners = mesh.triangles.iter().flatten().flat_map(|corner| mesh.positions[*corner as usize]);
    answer(took, corners);
}
