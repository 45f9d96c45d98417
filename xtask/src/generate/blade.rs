//! The third example of the paper (Figure 13): a blade of an impeller, carved by a ball end in 2,700 SLERP motions,
//! seen in a rectangle about it.
//!
//! The blade is one of [`impeller`](super::impeller), out of a dome. The ball end runs in and out of the channels on
//! both sides of it, first near the dome, then deeper and deeper down to the hub, in layers that all have the shape of
//! the hub.

use super::impeller::{BLADES, CHANNEL_BALL, HUB, LENGTH, RADIUS, Revolved, SAFE, in_channel};
use super::toolpath::{Placement, csv, decimals};
use libm::{cos, sin};
use std::f64::consts::TAU;

/// The motions of the paper's example.
const MOTIONS: usize = 2_700;
/// Layers, their distance along `z`, and passes in a channel and layer: an even number, so that each ends outside.
const LAYERS: usize = 5;
const LAYER: f64 = 2.2;
const PASSES: usize = 10;

/// The middle of the blade, around the axis of the impeller; all is turned back by it.
const MIDDLE: f64 = 0.36;
/// The rectangle of the grid: `(min, max)`.
const AREA: [[f64; 2]; 2] = [[6.5, -6.0], [30.5, 6.0]];
/// The dome: the ball that rounds the cylinder, its centre below the origin and its radius.
const DOME: [f64; 2] = [18.64, 39.8];

/// The job and its path.
pub fn files() -> Vec<(&'static str, String)> {
    vec![
        ("jobs/impeller-blade.ron", job()),
        ("paths/impeller-blade.csv", csv(&path())),
    ]
}

fn job() -> String {
    let [[x0, y0], [x1, y1]] = AREA;
    let [below, dome] = DOME;
    format!(
        "\
// A blade of an impeller, carved by a ball end in {MOTIONS} motions: the paper's third example.
// Written by `cargo xtask generate` (xtask/src/generate/blade.rs).
Job(
    units: Mm,
    tolerance: 1e-6,
    grid: Grid(min: ({x0:?}, {y0:?}), max: ({x1:?}, {y1:?}), cells: (600, 300)),
    stock: Intersection([
        Cylinder(base: (0, 0, 0), axis: (0, 0, 1), radius: {RADIUS:?}, height: 24),
        Ball(centre: (0, 0, -{below}), radius: {dome}),
    ]),
    tools: {{
        1: Ball(radius: {}, length: {LENGTH:?}),
    }},
    paths: [
        Path(tool: 1, file: \"../paths/impeller-blade.csv\"),
    ],
)
",
        decimals(CHANNEL_BALL),
    )
}

/// Exactly [`MOTIONS`] motions: layer after layer, first the channel behind the blade, then the one before it.
fn path() -> Vec<Placement> {
    let groups = 2 * LAYERS;
    let cutting = MOTIONS + 1 - 2 * groups;
    let all = groups * PASSES;
    let mut path = Vec::new();
    let mut number = 0;
    for layer in (0..LAYERS).rev() {
        let floor = Revolved {
            low: HUB.low + LAYER * layer as f64,
            ..HUB
        };
        for channel in [-1.0, 0.0] {
            let angle = channel * TAU / BLADES as f64 - MIDDLE;
            let turn = (cos(angle), sin(angle));
            let mut group = Vec::new();
            for pass in 0..PASSES {
                let across = pass as f64 / (PASSES - 1) as f64;
                // As many poses in each pass, up to one.
                let poses = cutting * (number + 1) / all - cutting * number / all;
                number += 1;
                group.extend((0..poses).map(|k| {
                    let along = k as f64 / (poses - 1) as f64;
                    let along = if pass % 2 == 0 { 1.0 - along } else { along };
                    in_channel(&floor, across, along).turned(turn)
                }));
            }
            path.push(group[0].lifted(SAFE));
            path.extend(&group);
            path.push(group[group.len() - 1].lifted(SAFE));
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_motions_as_in_the_paper() {
        let path = path();
        assert_eq!(path.len(), MOTIONS + 1);
        // Equal neighbours would be written once.
        assert_eq!(csv(&path).lines().count(), MOTIONS + 2);
    }

    #[test]
    fn the_tool_stays_clear_of_the_middle_of_the_blade() {
        // The tool stays clear of the blade's middle, from its inner to its outer end, at all heights above the hub.
        let path = path();
        for r in [11.0, 15.0, 20.0, 25.0, 29.0] {
            let angle = super::super::impeller::blade(r) - MIDDLE;
            let (x, y) = (r * cos(angle), r * sin(angle));
            // Its outer end sweeps out of the grid.
            assert!(r > 25.0 || y.abs() < 0.75 * AREA[1][1], "{x} {y}");
            for k in 0..20 {
                let z = HUB.height(r) + 0.5 * f64::from(k);
                let point = nalgebra::Vector3::new(x, y, z);
                for tool in &path {
                    let along = (point - tool.tip).dot(&tool.axis).clamp(CHANNEL_BALL, LENGTH);
                    let off = (point - tool.tip - tool.axis * along).norm() - CHANNEL_BALL;
                    assert!(off > 0.2, "{off} from the tool at {point}");
                }
            }
        }
    }
}
