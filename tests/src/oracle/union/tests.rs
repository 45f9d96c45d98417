use super::*;
use crate::tools;
use sweepsim_motion::{Pose, Tool};

fn line(tool: &Tool, poses: &[([f64; 3], [f64; 3])], x: f64, y: f64) -> SweptLine {
    let poses: Vec<Pose> = poses.iter().map(|p| Pose::new(p.0, p.1).unwrap()).collect();
    swept_line(
        &Outline::new(tool.profile().expect("a solid of revolution")),
        &Motion::new(&poses),
        x,
        y,
        Sampling::number(200),
    )
}

fn assert_spans(found: &SweptLine, expected: &[[f64; 2]]) {
    assert_eq!(found.spans.len(), expected.len(), "{found:?} for {expected:?}");
    for (span, ends) in found.spans.iter().zip(expected) {
        for (z, e, error) in [(span.low, ends[0], span.error[0]), (span.high, ends[1], span.error[1])] {
            assert!(error <= 1e-9, "{found:?}");
            assert!((z - e).abs() <= error, "{found:?} for {expected:?}");
        }
    }
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn a_ball_along_a_slope_is_a_capsule_below() {
    let (radius, from, to) = (3.0_f64, [0.0, 0.0, 0.0], [20.0, 4.0, 10.0]);
    let tool = Tool::ball(radius, 50.0).unwrap();
    // The lowest z with distance `radius` from the centres' line c(λ) = from + λ d + (0, 0, radius).
    let d = Vector3::from(to) - Vector3::from(from);
    for (x, y) in [(5.0, 1.0), (10.3, 3.0), (14.0, 1.2), (9.0, 0.0)] {
        // With e = (x, y, z − radius) and |e|² − (e·d)²/|d|² = r²: a quadratic in ζ = z − radius.
        let (flat, dd): (f64, f64) = (x * d.x + y * d.y, d.norm_squared());
        let a = 1.0 - d.z * d.z / dd;
        let b = -2.0 * flat * d.z / dd;
        let c = x * x + y * y - flat * flat / dd - radius * radius;
        let lower = (-b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
        let foot = (flat + lower * d.z) / dd;
        assert!((0.1..0.9).contains(&foot), "the case must lie between the ends");
        // Above: the top of the shank at the last instant that covers the line.
        let along = d.xy().normalize();
        let side = along.perp(&nalgebra::Vector2::new(x, y));
        let last = (along.dot(&nalgebra::Vector2::new(x, y)) + (radius * radius - side * side).sqrt()) / d.xy().norm();
        let found = line(&tool, &[(from, UP), (to, UP)], x, y);
        assert_spans(&found, &[[lower + radius, 50.0 + 10.0 * last]]);
    }
}

#[test]
fn a_vertical_cylinder_moved_sideways_is_a_slab() {
    let tool = Tool::flat(2.0, 30.0).unwrap();
    let poses = [([-5.0, 0.0, 1.0], UP), ([5.0, 0.0, 1.0], UP)];
    assert_spans(&line(&tool, &poses, 0.7, 1.999), &[[1.0, 31.0]]);
    assert_spans(&line(&tool, &poses, 6.9, 0.1), &[[1.0, 31.0]]);
    assert_spans(&line(&tool, &poses, 0.7, 2.001), &[]);
    assert_spans(&line(&tool, &poses, 7.1, 0.0), &[]);
}

#[test]
fn a_plunge_is_one_long_cylinder() {
    let tool = Tool::flat(2.0, 3.0).unwrap();
    assert_spans(
        &line(&tool, &[([0.0; 3], UP), ([0.0, 0.0, -17.0], UP)], 1.0, 1.0),
        &[[-17.0, 3.0]],
    );
}

#[test]
fn a_zero_move_is_the_tool() {
    let tool = Tool::ball(2.0, 9.0).unwrap();
    let low = 2.0 - 3.0_f64.sqrt();
    assert_spans(&line(&tool, &[([0.0; 3], UP), ([0.0; 3], UP)], 1.0, 0.0), &[[low, 9.0]]);
    assert_spans(&line(&tool, &[([0.0; 3], UP)], 1.0, 0.0), &[[low, 9.0]]);
}

#[test]
fn a_tilted_cylinder_along_itself() {
    // Moved along its own axis by 20 it is a cylinder of length 60.
    let (s, c) = (0.6, 0.8);
    let tool = Tool::flat(2.0, 40.0).unwrap();
    let axis = [s, 0.0, c];
    let found = line(&tool, &[([0.0; 3], axis), ([20.0 * s, 0.0, 20.0 * c], axis)], 15.0, 1.0);
    let half = 3.0_f64.sqrt();
    assert_spans(&found, &[[(15.0 * c - half) / s, (15.0 * c + half) / s]]);
}

#[test]
fn a_long_cylinder_turned_in_place_is_a_sector() {
    // In the plane y = 0 it turns about the tip from −60° to +60°: a fan of radius √(L² + R²) above,
    // the flank's lines below.
    let (radius, length) = (1.0_f64, 30.0_f64);
    let tool = Tool::flat(radius, length).unwrap();
    let (s, c) = 60.0_f64.to_radians().sin_cos();
    let poses = [([0.0; 3], [-s, 0.0, c]), ([0.0; 3], [s, 0.0, c])];
    let (x, y) = (10.0, 0.25);
    // The flank of the last placement from below, where x c − z s = half its chord at y; the rim's sphere on top.
    let half = (radius * radius - y * y).sqrt();
    let top = (length * length + half * half - x * x).sqrt();
    assert_spans(&line(&tool, &poses, x, y), &[[(x * c - half) / s, top]]);
}

#[test]
fn two_visits_leave_a_gap_and_a_third_closes_it() {
    let tool = Tool::ball(1.0, 3.0).unwrap();
    let at = |z: f64| [([-9.0, 0.0, z], UP), ([9.0, 0.0, z], UP)];
    let mut poses = at(0.0).to_vec();
    poses.extend(at(10.0).iter().rev());
    let side = Tool::ball(1.0, 3.0).unwrap();
    assert_spans(&line(&side, &poses, 0.0, 0.0), &[[0.0, 3.0], [10.0, 13.0]]);
    poses.extend(at(5.0));
    poses.extend([([0.0, 0.0, 5.0], UP), ([0.0, 0.0, 9.0], UP)]);
    let found = line(&tool, &poses, 0.0, 0.0);
    assert_spans(&found, &[[0.0, 3.0], [5.0, 13.0]]);
    assert!(!found.ambiguous);
}

#[test]
fn the_ends_do_not_depend_on_the_density() {
    let poses: Vec<Pose> = [
        ([0.0, 0.0, 0.0], [0.1, 0.2, 1.0]),
        ([14.0, 5.0, -3.0], [0.7, -0.4, 0.6]),
    ]
    .map(|(tip, axis)| Pose::new(tip, axis).unwrap())
    .to_vec();
    let motion = Motion::new(&poses);
    let mut clear = 0;
    for tool in tools::zoo() {
        let outline = Outline::new(tool.profile().expect("a solid of revolution"));
        for k in 0..49 {
            let (x, y) = (-8.0 + 5.17 * f64::from(k % 7), -11.0 + 4.03 * f64::from(k / 7));
            let coarse = swept_line(&outline, &motion, x, y, Sampling::number(97));
            let fine = swept_line(&outline, &motion, x, y, Sampling::number(1000));
            if coarse.ambiguous || fine.ambiguous {
                continue;
            }
            clear += usize::from(!fine.spans.is_empty());
            assert_eq!(coarse.spans.len(), fine.spans.len(), "({x}, {y})");
            for (a, b) in coarse.spans.iter().zip(&fine.spans) {
                assert!((a.low - b.low).abs() <= a.error[0] + b.error[0], "{coarse:?} {fine:?}");
                assert!(
                    (a.high - b.high).abs() <= a.error[1] + b.error[1],
                    "{coarse:?} {fine:?}"
                );
            }
        }
    }
    assert!(clear > 60, "{clear} lines compared");
}
