//! A program milled with the dexels of `BREP_cam`: `brep-cam-mill WORK STEP ANSWER [z]`. With `z`, by Z-dexels (three
//! axes only), else by tri-dexels. Answers the height of the highest material of each column along z, row by row.

#[path = "../../work.rs"]
mod work;

use brep_cam::cutter::{Cutter, ToolProfile};
use brep_cam::multiaxis::sim::tridexel::{TriDexel, TriDexelOptions};
use brep_cam::stock_sim::removal::{RemovalOptions, simulate};
use brep_cam::stock_sim::{Column, DexelGrid};
use brep_cam::{Feed, Motion, MotionKind, NullSink, Point3, Runner, Tolerance};
use work::{Work, answer, seconds};

/// The chord error of the profiles of ball ends over the square of the step: its default, 0.01, at half a millimetre,
/// and as much smaller as what steps leave.
const CHORD: f64 = 0.04;

fn main() {
    let (work, step) = (Work::read(), Work::setting());
    let point = |[x, y, z]: [f64; 3]| Point3::new(x, y, z);
    let diameter = 2.0 * work.radius;
    let cutter = if work.ball { Cutter::ball(diameter, work.length, 0.0) } else { Cutter::flat(diameter, work.length, 0.0) };
    let motions: Vec<Motion> = (work.poses.iter().enumerate())
        .map(|(n, (tip, axis))| {
            let to = point(*tip);
            let kind = if n == 0 { MotionKind::Rapid { to } } else { MotionKind::Cut { to } };
            Motion { tool_axis: Some(point(*axis)), ..Motion::new(kind, Feed::RAPID) }
        })
        .collect();
    let cells = work.cells as u32;
    let cell = (work.max[0] - work.min[0]) / work.cells as f64;
    let mut grid = DexelGrid {
        origin: point(work.min),
        cell_x: cell,
        cell_y: cell,
        nx: cells,
        ny: cells,
        columns: vec![Column::full(work.min[2], work.max[2]); work.cells * work.cells],
        z_range: [work.min[2], work.max[2]],
    };
    let mut sink = NullSink;
    let mut runner = Runner::detached(&mut sink);
    let tolerance = Tolerance::default();
    let start;
    if std::env::args().nth(4).as_deref() == Some("z") {
        start = seconds();
        simulate(&mut grid, &cutter, &motions, &tolerance, &RemovalOptions::default(), &mut runner).expect("not cancelled");
    } else {
        let options = TriDexelOptions {
            cell,
            step,
            // Two degrees at half a millimetre, as by default, and less with smaller steps.
            max_axis_step_deg: 4.0 * step,
            max_work: u64::MAX,
            ..TriDexelOptions::default()
        };
        // A hair larger than the block: rounding up makes no more columns than asked for.
        let options = TriDexelOptions { cell: options.cell * (1.0 + 1e-12), ..options };
        let profile = ToolProfile::new(&cutter, None, CHORD * step * step);
        let bounds = brep_cam::Bounds3::new(point(work.min), point(work.max));
        let mut dexels = TriDexel::empty(&bounds, &options).expect("a block");
        for grid in &mut dexels.grids {
            let range = grid.range;
            grid.columns.fill(Column::full(range[0], range[1]));
        }
        start = seconds();
        dexels.simulate(&profile, &motions, &options, &tolerance, &mut runner).expect("a program");
        grid = dexels.to_dexel_grid();
    }
    let took = seconds() - start;
    answer(took, grid.columns.iter().map(|column| column.top().unwrap_or(f64::NAN)));
}
