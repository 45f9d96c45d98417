//! The first example of the paper: the outside of half the body of the Utah teapot, cut by a flat end.
//!
//! The body is Martin Newell's: three cubic Bézier profiles, revolved by cubic quarter circles (which are no exact
//! circles: that is how the teapot has been since 1975). It lies on its side: the axis of the body along `x`, the half
//! with `z ≥ 0` is cut. The tool follows the iso-parametric curves around the body, the centre of its bottom on the
//! surface, its axis along the normal. Where the surface is hollow (the rim, the foot) a flat bottom would cut into it;
//! there the tool is lifted along its axis until it does not.
//!
//! Only `+ − × ÷ √` are used, so that every machine writes the same bytes.

use super::toolpath::{Accuracy, BlockJob, Placement, csv, sample};
use nalgebra::{Vector2, Vector3};

/// Newell's profile of the body, `(radius, height)`, from the rim to the foot; three cubics.
pub(super) const PROFILE: [[[f64; 2]; 4]; 3] = [
    [[1.4, 2.25], [1.3375, 2.38125], [1.4375, 2.38125], [1.5, 2.25]],
    [[1.5, 2.25], [1.75, 1.725], [2.0, 1.2], [2.0, 0.75]],
    [[2.0, 0.75], [2.0, 0.3], [1.5, 0.075], [1.5, 0.0]],
];

/// Newell's quarter circle: the inner control points of a cubic, in parts of the radius (0.5523 would be closest to a
/// circle).
const QUARTER: f64 = 0.56;

/// Millimetres per unit of Newell's.
pub(super) const SCALE: f64 = 15.0;

/// The flat end.
const RADIUS: f64 = 2.5;
const LENGTH: f64 = 40.0;

/// The block: `(min, max)`. It ends just before the two facing passes would leave a wall standing.
const STOCK: [[f64; 3]; 2] = [[-4.5, -40.0, -4.0], [39.5, 40.0, 31.0]];

/// Three orders of magnitude below the radius of the body.
const ACCURACY: Accuracy = Accuracy {
    chord: 0.02,
    turn: 0.15,
};

/// Height of the ridges between neighbouring passes, and the widest step between them.
const SCALLOP: f64 = 0.015;
const WIDEST_STEP: f64 = 1.0;

/// The axis leans at most so far to the side.
const LEAST_NORMAL_Z: f64 = 0.08;

/// Between the body and the two facing passes.
const CLEARANCE: f64 = 0.01;

/// How far the tool leaves along its axis before and after a pass: clear of the block.
const RETRACT: f64 = 35.0;

/// The job and its path.
pub fn files() -> Vec<(&'static str, String)> {
    vec![
        ("jobs/teapot-exterior.ron", job()),
        ("paths/teapot-exterior.csv", csv(&path())),
    ]
}

fn job() -> String {
    BlockJob {
        heading: "\
// Half the body of the Utah teapot, lying on its side, out of a block, by a flat end: the paper's first example.
// Written by `cargo xtask generate` (xtask/src/generate/teapot.rs).",
        stock: STOCK,
        cells: [300, 300],
        tool: format!("Flat(radius: {RADIUS:?}, length: {LENGTH:?})"),
        path: "../paths/teapot-exterior.csv",
    }
    .text()
}

/// A point of the profile as `(x along the body, radius)` in mm, and the unit normal out of the body in the same plane.
pub(super) fn profile(parameter: f64) -> (Vector2<f64>, Vector2<f64>) {
    let piece = (parameter as usize).min(PROFILE.len() - 1);
    let (point, derivative) = cubic(PROFILE[piece].map(Vector2::from), parameter - piece as f64);
    // The profile runs from the rim down to the foot: outside is on its left, seen with the radius to the right, the
    // height up.
    let outward = Vector2::new(derivative.x, -derivative.y).normalize();
    (Vector2::new(point.y, point.x) * SCALE, outward)
}

/// The quarter circle's point and its normal, `(y, z)`, radius 1: `u` runs over `[0, 2]` from `+y` over `+z` to `−y`.
pub(super) fn around(u: f64) -> (Vector2<f64>, Vector2<f64>) {
    let quarter = [
        Vector2::new(1.0, 0.0),
        Vector2::new(1.0, QUARTER),
        Vector2::new(QUARTER, 1.0),
        Vector2::new(0.0, 1.0),
    ];
    let second = u > 1.0;
    let (point, derivative) = cubic(quarter, if second { u - 1.0 } else { u });
    let normal = Vector2::new(derivative.y, -derivative.x);
    if second {
        (Vector2::new(-point.y, point.x), Vector2::new(-normal.y, normal.x))
    } else {
        (point, normal)
    }
}

/// Value and derivative of a cubic Bézier curve.
fn cubic(control: [Vector2<f64>; 4], t: f64) -> (Vector2<f64>, Vector2<f64>) {
    let mix = |a: Vector2<f64>, b: Vector2<f64>| a + (b - a) * t;
    let [a, b, c, d] = control;
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
    (mix(abc, bcd), (bcd - abc) * 3.0)
}

/// The tool on the surface: its bottom touches at `(x, radius)` of a profile with normal `outward`, at `u` around.
///
/// `S = (x, ρ c_y, ρ c_z)`, so the normal `S_v × S_u` is along `(n_x (c × c′), n_ρ (c′_z, −c′_y))`.
fn touching((point, outward): (Vector2<f64>, Vector2<f64>), u: f64) -> Placement {
    let (circle, normal) = around(u);
    Placement {
        tip: Vector3::new(point.x, point.y * circle.x, point.y * circle.y),
        axis: Vector3::new(
            outward.x * circle.dot(&normal),
            outward.y * normal.x,
            outward.y * normal.y,
        )
        .normalize(),
    }
}

/// Whether the tool stays clear of the floor `z = 0` and does not lean too far.
fn above_floor(placement: &Placement) -> bool {
    let z = placement.axis.z;
    z >= LEAST_NORMAL_Z && placement.tip.z >= RADIUS * (1.0 - z * z).sqrt()
}

/// The smallest `u` at which the tool is above the floor; the pass goes from there to `2 − u`.
fn lowest(curve: &dyn Fn(f64) -> Placement) -> f64 {
    let (mut below, mut above) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (below + above);
        if above_floor(&curve(middle)) {
            above = middle;
        } else {
            below = middle;
        }
    }
    above
}

/// The body as points, to keep the tool out of it: some neighbours each, in a ball around the first.
struct Body(Vec<(Vec<Vector3<f64>>, f64)>);

impl Body {
    fn new() -> Self {
        let (along, around_it) = (240, 320);
        let points: Vec<Vector3<f64>> = (0..=along)
            .flat_map(|a| (0..=around_it).map(move |b| (a, b)))
            .map(|(a, b)| {
                let v = PROFILE.len() as f64 * f64::from(a) / f64::from(along);
                touching(profile(v), 2.0 * f64::from(b) / f64::from(around_it)).tip
            })
            .collect();
        let ball = |points: &[Vector3<f64>]| {
            let radius = points
                .iter()
                .map(|point| (point - points[0]).norm())
                .fold(0.0, f64::max);
            (points.to_vec(), radius)
        };
        Self(points.chunks(20).map(ball).collect())
    }

    /// How far the tool must be lifted along its axis so that no point of the body is inside it.
    fn lift(&self, tool: &Placement) -> f64 {
        // The height of a point, if it is in the tool but for a distance.
        let inside = |point: &Vector3<f64>, distance: f64| {
            let from_tip = point - tool.tip;
            let height = from_tip.dot(&tool.axis);
            let off = from_tip.norm_squared() - height * height;
            (height > -distance && off < (RADIUS + distance).powi(2)).then_some(height)
        };
        let near = self
            .0
            .iter()
            .filter(|(points, radius)| inside(&points[0], *radius).is_some());
        near.flat_map(|(points, _)| points)
            .filter_map(|point| inside(point, 0.0))
            .fold(0.0, f64::max)
    }
}

/// The profile parameters of the passes: as far apart as the ridges between them allow. A flat bottom leaves `s²/8ρ`
/// between two passes `s` apart on a profile of radius of curvature `ρ`.
fn passes() -> Vec<f64> {
    let (first, last) = (1.0, 3.0);
    let small = 1e-3;
    let mut parameters = vec![first];
    let mut at = first;
    loop {
        let ((p, n), (q, m)) = (profile(at), profile((at + small).min(last)));
        let length = (q - p).norm();
        let curvature = (m - n).norm() / length;
        let step = (8.0 * SCALLOP / curvature).sqrt().min(WIDEST_STEP);
        at += small * step / length;
        if at >= last {
            return parameters;
        }
        parameters.push(at);
    }
}

/// The whole path: upright along both ends of the block, then around the body from the rim to the foot, to and fro.
fn path() -> Vec<Placement> {
    let body = Body::new();
    let mut path = facing();
    let passes = passes();
    for (count, &v) in passes.iter().enumerate() {
        let curve = |u: f64| {
            let tool = touching(profile(v), u);
            tool.lifted(body.lift(&tool))
        };
        let low = lowest(&curve);
        let (from, to) = if count % 2 == 0 {
            (low, 2.0 - low)
        } else {
            (2.0 - low, low)
        };
        let pass = sample(&curve, from, to, ACCURACY);
        if count == 0 {
            path.push(pass[0].lifted(RETRACT));
        }
        path.extend(&pass);
        if count + 1 == passes.len() {
            path.push(pass[pass.len() - 1].lifted(RETRACT));
        }
    }
    path
}

/// Along the foot and back along the rim, on the floor: three-axis moves that free both ends of the body. Ends on the
/// side where the passes around it begin.
fn facing() -> Vec<Placement> {
    let rim_top = (0..=100).map(|k| profile(f64::from(k) / 100.0).0.x).fold(0.0, f64::max);
    let (foot, rim) = (-RADIUS - CLEARANCE, rim_top + RADIUS + CLEARANCE);
    let outside = STOCK[1][1] + RADIUS + 1.0;
    let upright = |x: f64, y: f64| Placement {
        tip: Vector3::new(x, y, 0.0),
        axis: Vector3::z(),
    };
    let turns = [(foot, outside), (foot, -outside), (rim, -outside), (rim, outside)].map(|(x, y)| upright(x, y));
    let mut path = turns.to_vec();
    path.insert(0, turns[0].lifted(RETRACT));
    path.push(turns[3].lifted(RETRACT));
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_perpendicular_to_the_surface() {
        let step = 1e-6;
        for (v, u) in [(1.3, 0.2), (1.9, 0.9), (2.2, 1.4), (2.6, 1.8)] {
            let at = |v: f64, u: f64| touching(profile(v), u);
            let tool = at(v, u);
            for neighbour in [at(v + step, u), at(v, u + step)] {
                let slope = (neighbour.tip - tool.tip).normalize().dot(&tool.axis);
                assert!(slope.abs() < 1e-5, "the axis leans by {slope} at v = {v}, u = {u}");
            }
            assert!(
                tool.axis.dot(&tool.tip) > 0.0 || v > 2.5,
                "the axis points inwards at v = {v}, u = {u}"
            );
        }
    }

    #[test]
    fn the_tool_stays_out_of_the_body_and_above_the_floor() {
        let body = Body::new();
        let path = path();
        assert!((2_000..4_000).contains(&path.len()), "{} poses", path.len());
        for tool in &path {
            assert!(above_floor(tool), "too low: {tool:?}");
            let lift = body.lift(tool);
            assert!(lift < 1e-9, "{lift} deep in the body: {tool:?}");
        }
        for pair in path.windows(2) {
            assert!(pair[0].axis.dot(&pair[1].axis) > -0.5, "almost opposite axes");
        }
    }
}
