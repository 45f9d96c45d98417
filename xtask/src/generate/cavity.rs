//! The second example of the paper: the inside of half the body of the Utah teapot, cut by a ball end "through a
//! point".
//!
//! The same [body](super::teapot), lying on its side, seen from within: the half with `z ≤ 0` is a cavity in a block.
//! The centre of the ball follows the iso-parametric curves of the body's offset by the ball's radius, to and fro
//! around the body, and then circles over its floor; the tool's axis always passes one point in front of the opening.
//! So the rod behind the ball sweeps what lies between the wall and that point.
//!
//! Only `+ − × ÷ √` are used, so that every machine writes the same bytes.

use super::teapot::{PROFILE, SCALE, around, profile};
use super::toolpath::{Accuracy, BlockJob, Placement, csv, sample};
use nalgebra::{Vector2, Vector3};

/// The ball end.
const RADIUS: f64 = 2.5;
const LENGTH: f64 = 60.0;

/// Height of the opening's rim along `x`, and how far before it the common point of all axes is: the rod beyond that
/// point is then clear of the block.
const RIM: f64 = 2.25 * SCALE;
const BEFORE: f64 = 6.0;

/// The block: `(min, max)`. It ends with the rim, and on top with the cutting plane through the body.
const STOCK: [[f64; 3]; 2] = [[-4.5, -36.0, -36.0], [RIM, 36.0, 0.0]];

/// Three orders of magnitude below the radius of the body.
const ACCURACY: Accuracy = Accuracy {
    chord: 0.02,
    turn: 0.15,
};

/// Height of the ridges between neighbouring passes: `s²/8r` on a plane.
const SCALLOP: f64 = 0.03;

/// How far the tool leaves along its axis before and after: clear of the block.
const RETRACT: f64 = 40.0;

/// The job and its path.
pub fn files() -> Vec<(&'static str, String)> {
    vec![
        ("jobs/teapot-interior.ron", job()),
        ("paths/teapot-interior.csv", csv(&path())),
    ]
}

fn job() -> String {
    BlockJob {
        heading: "\
// The inside of half the body of the Utah teapot, lying on its side, by a ball end whose axis always passes one point
// before the opening: the paper's second example. Written by `cargo xtask generate` (xtask/src/generate/cavity.rs).",
        stock: STOCK,
        cells: [180, 300],
        tool: format!("Ball(radius: {RADIUS:?}, length: {LENGTH:?})"),
        path: "../paths/teapot-interior.csv",
    }
    .text()
}

/// The point that all axes pass.
fn common() -> Vector3<f64> {
    Vector3::new(RIM + BEFORE, 0.0, 0.0)
}

/// The tool with the centre of its ball at a point.
fn through(centre: Vector3<f64>) -> Placement {
    let axis = (common() - centre).normalize();
    Placement {
        tip: centre - axis * RADIUS,
        axis,
    }
}

/// The tool with its ball touching the body from within at `(x, radius)` of a profile with normal `outward`, at `u`
/// around.
fn touching((point, outward): (Vector2<f64>, Vector2<f64>), u: f64) -> Placement {
    let (circle, across) = around(u);
    let normal = Vector3::new(
        outward.x * circle.dot(&across),
        outward.y * across.x,
        outward.y * across.y,
    )
    .normalize();
    let centre = Vector3::new(point.x, point.y * circle.x, point.y * circle.y) - normal * RADIUS;
    through(Vector3::new(centre.x, centre.y, -centre.z))
}

/// The tool with its ball on the floor `x = 0`, at `u` around a circle.
fn floor(radius: f64, u: f64) -> Placement {
    let (circle, _) = around(u);
    through(Vector3::new(RADIUS, radius * circle.x, -radius * circle.y))
}

/// Where the centre of the ball touching the profile is, `(x, radius)`.
fn offset(v: f64) -> Vector2<f64> {
    let (point, outward) = profile(v);
    point - outward * RADIUS
}

/// Profile parameters of the passes, as far apart as the ridges allow, from the rim to where the ball meets the floor.
fn passes() -> Vec<f64> {
    let (step, small) = (distance(), 1e-4);
    let mut parameters = vec![1.0];
    let (mut at, mut gone) = (1.0, 0.0);
    while at < PROFILE.len() as f64 - small {
        let next = at + small;
        if offset(next).x < RADIUS {
            break;
        }
        gone += (offset(next) - offset(at)).norm();
        at = next;
        if gone >= step {
            parameters.push(at);
            gone = 0.0;
        }
    }
    parameters.push(at);
    parameters
}

/// Between neighbouring passes.
fn distance() -> f64 {
    (8.0 * SCALLOP * RADIUS).sqrt()
}

/// Around the body from the rim to the floor, then over the floor to its middle.
fn path() -> Vec<Placement> {
    let parameters = passes();
    let mut path = Vec::new();
    let mut pass = |curve: &dyn Fn(f64) -> Placement| {
        let forth = path.len().is_multiple_of(2);
        let (from, to) = if forth { (0.0, 2.0) } else { (2.0, 0.0) };
        path.push(sample(curve, from, to, ACCURACY));
    };
    for v in &parameters {
        pass(&|u| touching(profile(*v), u));
    }
    let widest = offset(parameters[parameters.len() - 1]).y;
    let circles = (widest / distance()).ceil();
    let mut circle = circles - 1.0;
    while circle > 0.0 {
        pass(&|u| floor(widest * circle / circles, u));
        circle -= 1.0;
    }
    let mut path: Vec<Placement> = path.into_iter().flatten().collect();
    path.push(floor(0.0, 1.0));
    path.insert(0, path[0].lifted(RETRACT));
    path.push(path[path.len() - 1].lifted(RETRACT));
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_axes_pass_the_common_point() {
        for tool in path() {
            let off = (common() - tool.tip).cross(&tool.axis.normalize()).norm();
            assert!(off < 1e-12 * 40.0, "{tool:?} is {off} off");
        }
    }

    #[test]
    fn the_tool_stays_within_the_body() {
        let path = path();
        assert!((2_000..6_000).contains(&path.len()), "{} poses", path.len());
        // Points of the body, floor included.
        let mut body = Vec::new();
        for b in 0..=100 {
            let (circle, _) = around(f64::from(b) / 50.0);
            for a in 0..=120 {
                let p = profile(1.0 + 2.0 * f64::from(a) / 120.0).0;
                body.push(Vector3::new(p.x, p.y * circle.x, -p.y * circle.y));
                let r = 22.5 * f64::from(a) / 120.0;
                body.push(Vector3::new(0.0, r * circle.x, -r * circle.y));
            }
        }
        for tool in path.iter().step_by(3) {
            let centre = tool.tip + tool.axis * RADIUS;
            for point in &body {
                let along = (point - centre).dot(&tool.axis);
                let nearest = centre + tool.axis * along.clamp(0.0, LENGTH - RADIUS);
                let depth = RADIUS - (point - nearest).norm();
                // The rim ends at the side where the tool comes in.
                assert!(depth < 1e-9, "{depth} deep at {point:?}: {tool:?}");
            }
        }
    }

    #[test]
    fn the_ball_touches_the_body() {
        let step = 1e-6;
        for (v, u) in [(1.3, 0.2), (1.9, 0.9), (2.2, 1.4)] {
            let at = |v: f64, u: f64| {
                let tool = touching(profile(v), u);
                tool.tip + tool.axis * RADIUS
            };
            let (p, _) = profile(v);
            let (circle, _) = around(u);
            let foot = Vector3::new(p.x, p.y * circle.x, -p.y * circle.y);
            assert!(((at(v, u) - foot).norm() - RADIUS).abs() < 1e-12);
            // An offset is parallel to its surface.
            for neighbour in [at(v + step, u), at(v, u + step)] {
                let slope = (neighbour - at(v, u)).normalize().dot(&(at(v, u) - foot).normalize());
                assert!(slope.abs() < 1e-5, "{slope} at v = {v}, u = {u}");
            }
        }
    }
}
