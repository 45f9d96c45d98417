//! The families of [`near_degenerate`](crate::near_degenerate) at more distances, close to each other: a scale of its
//! own may hide between two powers of ten, such as the chord that a line cuts off a tool which it all but touches.

use crate::near_degenerate::{
    Family, GENERIC, METHODS, MOST, about_a_line, around, cost, families, leaning, pose, through, tools, work,
};
use sweepsim::{Method, Options, sweep};
use sweepsim_motion::{Law, Tool};

/// From `most` down by a constant factor.
fn scales(most: f64, factor: f64, count: i32) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| most * factor.powi(k))
}

/// The line touches the ball at its tip at all times, but for its displacement, by which it cuts off a chord of 3e-5. A
/// tip that rises by as much during the turn passes the ends of the chord: at two rises, within half a hundredth of
/// each, where the line touches its way, it is solved again.
#[test]
fn a_ball_that_rises_by_a_chord_while_it_turns_about_a_line() {
    let tool = Tool::ball(2.0, 7.0).unwrap();
    for method in METHODS {
        let boxes = |rise: f64| {
            let (path, grid) = about_a_line(0.0, rise, 0.0);
            let found = cost(method, &tool, &(path, grid));
            assert!(found.unresolved.is_empty() && found.repaired <= 1, "{method}, {rise}");
            work(method, &found, &grid)
        };
        let neighbour = boxes(23.0);
        for rise in scales(1e-4, 0.8, 20) {
            let times = boxes(rise) / neighbour;
            assert!(times < MOST, "{method}, {rise}: {times}");
        }
    }
}

/// A flat bottom's speed along the axis is that of the displacement of tips, and of a turn by 1e-10. Where both cancel,
/// a torus touches its envelope within 1e-12 of the bottom, and on one side of their joint only.
#[test]
fn a_bottom_that_stops_beside_a_torus() {
    let tool = Tool::bull(2.0, 0.5, 7.0).unwrap();
    for axis_change in scales(3e-10, 0.97, 60) {
        let poses = vec![
            pose([-2.0, -0.7, 0.0], leaning(0.0)),
            pose([2.0, 0.9, 0.0], leaning(axis_change)),
        ];
        let path = through(poses, Law::Slerp);
        for method in [Method::General, Method::Mixed, Method::Lines] {
            let options = Options::default().method(method);
            let found = sweep(&tool, &path, &around([0.0137, -0.0211]), &options, &()).unwrap();
            let unresolved = found.statistics.unresolved;
            assert!(unresolved.is_empty(), "{method}, {axis_change:e}: {unresolved:?}");
        }
    }
}

#[test]
#[ignore = "takes minutes"]
fn almost_degenerate_input_is_cheap_at_all_scales() {
    let mut wrong = Vec::new();
    for method in METHODS {
        for (what, family) in families() {
            for (name, tool) in tools() {
                wrong.extend(dear(method, (what, family), (name, &tool)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The members of a family that cost too much or are not resolved.
fn dear(method: Method, (what, family): Family, (name, tool): (&str, &Tool)) -> Vec<String> {
    let input = family(GENERIC);
    let generic = work(method, &cost(method, tool, &input), &input.1);
    // At 0.2 from the axis, another row of lines would be in the wall, which is a family of its own.
    scales(0.19, 0.75, 90)
        .filter_map(|distance| {
            let input = family(distance);
            let found = cost(method, tool, &input);
            let times = work(method, &found, &input.1) / generic;
            let unresolved = found.unresolved.len();
            (times > MOST || unresolved > 0)
                .then(|| format!("{method}, {what}, {name}, {distance:e}: {times:.2} times, {unresolved} unresolved"))
        })
        .collect()
}
