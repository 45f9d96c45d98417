//! Circle-segment cutters, which touch tangentially where radii differ a hundredfold, judged by brute force.

use crate::brute_force::judge::{judge_sweep, same_sweeps, swept_along};
use crate::brute_force::named_motions::{grid, motions};
use crate::brute_force::sample::sample;
use rayon::prelude::*;
use sweepsim::Method;
use sweepsim_motion::{Barrel, Lens, Oval, Taper, Tool};

#[test]
fn circle_segment_cutters_along_motions_of_every_kind() {
    let tools = [
        (
            "oval",
            Tool::oval(Oval {
                radius: 2.0,
                tip: 0.5,
                flank: 40.0,
                length: 14.0,
            }),
        ),
        (
            "oval, almost a ball",
            Tool::oval(Oval {
                radius: 2.0,
                tip: 1.9999,
                flank: 2.01,
                length: 9.0,
            }),
        ),
        (
            "taper",
            Tool::taper(Taper {
                radius: 2.0,
                tip: 0.3,
                flank: 150.0,
                angle: 20.0,
                length: 9.0,
            }),
        ),
        (
            "barrel",
            Tool::barrel(Barrel {
                radius: 2.0,
                flank: 15.0,
                height: 6.0,
                corner: 0.4,
                length: 8.0,
            }),
        ),
        (
            "lens",
            Tool::lens(Lens {
                radius: 2.0,
                bottom: 9.0,
                corner: 0.3,
                length: 8.0,
            }),
        ),
    ]
    .map(|(name, tool)| (name, tool.expect("a cutter")));
    let motions = motions();
    let cases: Vec<(usize, usize)> = (0..motions.len()).map(|m| (m % tools.len(), m)).collect();
    let cases = sample("circle-segment cutters", &cases, 10);
    let errors: Vec<String> = cases
        .par_iter()
        .filter_map(|&(t, m)| {
            let ((name, tool), named) = (&tools[t], &motions[m]);
            let grid = grid(m, &named.path);
            let profile = tool.profile().expect("a solid of revolution");
            let check = || {
                let charts = swept_along(tool, &named.path, &grid, Method::Mixed)?;
                let lines = swept_along(tool, &named.path, &grid, Method::Lines)?;
                let tally = judge_sweep(&charts, profile, &named.motion, &grid, Method::Mixed)?;
                same_sweeps(profile, &named.motion, &grid, &charts, &lines)?;
                let enough = tally.covered > 10;
                enough.then_some(()).ok_or(format!("{tally:?}"))
            };
            check().err().map(|error| format!("{name}: {}: {error}", named.name))
        })
        .collect();
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}
