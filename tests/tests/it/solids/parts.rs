//! What one tool leaves on one path, of every kind of surface.

use super::{check, job, path};
use std::f64::consts::PI;

const BLOCK: f64 = 60.0 * 40.0 * 15.0;
const FLAT: &str = "1: Flat(radius: 5, length: 30)";

/// A full or half circle of radius 10, 3 deep.
fn ring(to: f64) -> String {
    let pose = |x: f64, z: f64| format!("(({x}, 20, {z}), (0, 0, 1))");
    format!(
        "Path(tool: 1, moves: [Start({}), Line({}), Arc(to: {}, centre: (30, 20, 0), normal: (0, 0, 1), turn: Ccw), Line({})])",
        pose(40.0, 30.0),
        pose(40.0, 12.0),
        pose(to, 12.0),
        pose(to, 30.0)
    )
}

#[test]
fn slot_of_a_flat_end() {
    let slot = path(&[
        [15.0, 20.0, 30.0],
        [15.0, 20.0, 9.0],
        [45.0, 20.0, 9.0],
        [45.0, 20.0, 30.0],
    ]);
    let removed = (30.0 * 10.0 + PI * 25.0) * 6.0;
    // The block's six, the floor and two walls.
    check(&job(FLAT, &slot), 1, &[("plane", 9), ("cylinder", 2)], BLOCK - removed);
}

#[test]
fn cut_in_two() {
    let through = path(&[[30.0, -10.0, -1.0], [30.0, 50.0, -1.0]]);
    check(&job(FLAT, &through), 2, &[("plane", 12)], BLOCK - 10.0 * 40.0 * 15.0);
}

/// Four surfaces touch in one point, at each corner of the bottom.
#[test]
fn deep_slot_of_a_ball() {
    let slot = path(&[
        [15.0, 20.0, 30.0],
        [15.0, 20.0, 6.0],
        [45.0, 20.0, 6.0],
        [45.0, 20.0, 30.0],
    ]);
    let below = 30.0 * PI * 25.0 / 2.0 + 2.0 / 3.0 * PI * 125.0;
    let above = (30.0 * 10.0 + PI * 25.0) * 4.0;
    let ball = "1: Ball(radius: 5, length: 30)";
    let faces = [("plane", 8), ("cylinder", 3), ("sphere", 2)];
    check(&job(ball, &slot), 1, &faces, BLOCK - below - above);
}

/// A blind hole with the cone of its drill, and one right through.
#[test]
fn drilled_holes() {
    let drill = "1: Profile(start: (0, 0), segments: [Line((3, 1.8)), Line((3, 30)), Line((0, 30))])";
    let holes = path(&[
        [20.0, 20.0, 30.0],
        [20.0, 20.0, 5.0],
        [20.0, 20.0, 30.0],
        [40.0, 20.0, 30.0],
        [40.0, 20.0, -4.0],
        [40.0, 20.0, 30.0],
    ]);
    let removed = PI * 9.0 * (8.2 + 0.6 + 15.0);
    // Each wall and the cone in two halves.
    let faces = [("plane", 6), ("cylinder", 4), ("cone", 2)];
    check(&job(drill, &holes), 1, &faces, BLOCK - removed);
}

#[test]
fn groove_of_a_ball_along_a_circle() {
    let removed = 2.0 * PI * 10.0 * (16.0 * 0.25_f64.acos() - 15_f64.sqrt());
    let ball = "1: Ball(radius: 4, length: 30)";
    let faces = [("plane", 7), ("torus", 2)];
    check(&job(ball, &ring(40.0)), 1, &faces, BLOCK - removed);
}

#[test]
fn groove_of_a_bull_nose_along_a_circle() {
    let section = 8.0 * 3.0 - 2.0 * (1.0 - PI / 4.0) * 1.5 * 1.5;
    let bull = "1: Bull(radius: 4, corner: 1.5, length: 30)";
    // The block's six and the middle, and the floor; two walls and two roundings, each in halves.
    let faces = [("plane", 8), ("cylinder", 4), ("torus", 4)];
    check(&job(bull, &ring(40.0)), 1, &faces, BLOCK - 2.0 * PI * 10.0 * section);
}

/// Half a circle: at its ends half of the tool, which has a torus beside the tori of the groove.
#[test]
fn half_a_groove_of_a_bull_nose() {
    let (corner, flat) = (1.5, 2.5);
    let section = 8.0 * 3.0 - 2.0 * (1.0 - PI / 4.0) * corner * corner;
    // The volume of the tool's lower 3 mm: the disc, a quarter circle about the axis, and the cylinder above it.
    let rounding = PI * flat * flat * corner + PI * PI / 2.0 * corner * corner * flat + 2.0 / 3.0 * PI * corner.powi(3);
    let tool = rounding + PI * 16.0 * (3.0 - corner);
    let bull = "1: Bull(radius: 4, corner: 1.5, length: 30)";
    let faces = [("plane", 7), ("cylinder", 4), ("torus", 4)];
    check(&job(bull, &ring(20.0)), 1, &faces, BLOCK - PI * 10.0 * section - tool);
}

/// Passes 8 mm apart with a flat bottom 7 mm wide leave ridges, where cylinders of one radius cross in ellipses.
#[test]
fn pocket_with_ridges() {
    let pocket = path(&[
        [15.0, 12.0, 30.0],
        [15.0, 12.0, 9.0],
        [45.0, 12.0, 9.0],
        [45.0, 28.0, 9.0],
        [15.0, 28.0, 9.0],
        [15.0, 12.0, 9.0],
        [15.0, 20.0, 9.0],
        [45.0, 20.0, 9.0],
        [45.0, 20.0, 30.0],
    ]);
    let bull = "1: Bull(radius: 5, corner: 1.5, length: 30)";
    let depth = |x: f64, y: f64| {
        // How far a point is from the nearest axis, and how much of the corner is above the floor there.
        let along = |value: f64, low: f64, high: f64| (low - value).max(value - high).max(0.0);
        let rows = [12.0, 20.0, 28.0].map(|at| along(x, 15.0, 45.0).hypot(y - at));
        let columns = [15.0, 45.0].map(|at| along(y, 12.0, 28.0).hypot(x - at));
        let far = rows.into_iter().chain(columns).fold(f64::INFINITY, f64::min);
        let out = far - 3.5;
        match far {
            far if far > 5.0 => 0.0,
            _ if out <= 0.0 => 6.0,
            _ => 6.0 - 1.5 + (1.5_f64.powi(2) - out * out).sqrt(),
        }
    };
    let faces = [("plane", 11), ("cylinder", 16), ("torus", 4)];
    // The ridges are 1 mm wide.
    let fine = job(bull, &pocket).replace("(80, 55)", "(120, 80)");
    check(&fine, 1, &faces, BLOCK - integral([10.0, 50.0], [7.0, 33.0], depth));
}

/// A flat end that goes down obliquely: the rim leaves a cylinder over an ellipse, as a ruled sheet.
#[test]
fn ramp_of_a_flat_end() {
    let ramp = path(&[
        [15.0, 20.0, 30.0],
        [15.0, 20.0, 12.0],
        [45.0, 20.0, 8.0],
        [45.0, 20.0, 30.0],
    ]);
    let depth = |x: f64, y: f64| {
        let wide = (25.0 - (y - 20.0).powi(2)).max(0.0).sqrt();
        // The last place where the disc covers the point: it is the lowest.
        let last = (x + wide).min(45.0);
        let covered = wide > 0.0 && last >= 15.0 && x - wide <= 45.0;
        if covered {
            15.0 - (12.0 - 4.0 * (last - 15.0) / 30.0)
        } else {
            0.0
        }
    };
    let faces = [("plane", 9), ("cylinder", 2), ("extruded surface", 1)];
    let flat = job(FLAT, &ramp);
    check(&flat, 1, &faces, BLOCK - integral([10.0, 50.0], [15.0, 25.0], depth));
}

/// By the midpoint rule, fine enough for a millionth of the block.
fn integral([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    const STEPS: usize = 4000;
    let (dx, dy) = ((x1 - x0) / STEPS as f64, (y1 - y0) / STEPS as f64);
    let mut sum = 0.0;
    for i in 0..STEPS {
        let x = x0 + (i as f64 + 0.5) * dx;
        sum += (0..STEPS).map(|j| f(x, y0 + (j as f64 + 0.5) * dy)).sum::<f64>();
    }
    sum * dx * dy
}
