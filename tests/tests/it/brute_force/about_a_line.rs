//! A level tool whose tip goes around a dexel line, exactly or almost: the line keeps grazing the tool at the same
//! height.

use crate::brute_force::judge::{judge_sweep, same_sweeps, swept_along};
use crate::brute_force::named_motions::pose;
use crate::brute_force::sample::sample;
use rayon::prelude::*;
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Apt, Move, Path, TipArc, Tool};
use sweepsim_tests::oracle::Motion;

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn leaning(angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    [0.6_f64.cos() * s, 0.6_f64.sin() * s, c]
}

#[test]
fn arcs_and_helices_about_a_dexel_line() {
    let drill = Apt {
        d: 4.0,
        r: 0.0,
        e: 2.0,
        f: 0.0,
        a: 31.0,
        b: 0.0,
        h: 7.0,
    };
    let tools = [
        ("ball", Tool::ball(2.0, 7.0).expect("a tool")),
        ("flat", Tool::flat(2.0, 7.0).expect("a tool")),
        ("bull", Tool::bull(2.0, 0.5, 7.0).expect("a tool")),
        ("drill", Tool::apt(&drill).expect("a tool").0),
    ];
    let mut cases = Vec::new();
    for d in [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1] {
        // Radius of the arc, rise, axes, place of the line.
        cases.push((1.3, 0.0, [UP; 2], [0.8 * d, 0.6 * d]));
        cases.push((1.3, d, [UP; 2], [0.0; 2]));
        cases.push((1.3, 0.0, [leaning(d); 2], [0.0; 2]));
        cases.push((1.3, 0.0, [UP, leaning(d)], [0.0; 2]));
        cases.push((1.3, d, [leaning(d), leaning(-d)], [0.0; 2]));
        cases.push((2.0 - d, 0.0, [UP; 2], [0.0; 2]));
        cases.push((1.3, 0.0, [[0.0, 0.0, -1.0]; 2], [d, 0.0]));
    }
    let all: Vec<(usize, usize)> = (0..cases.len())
        .flat_map(|case| (0..tools.len()).map(move |tool| (case, tool)))
        .collect();
    let all = sample("about a line", &all, 10);
    let wrong: Vec<String> = all
        .par_iter()
        .filter_map(|&(case, number)| {
            let ((radius, rise, [a, b], [x, y]), (name, tool)) = (cases[case], &tools[number]);
            let angle = if case.is_multiple_of(2) { 1.745_f64 } else { 4.0 };
            let (s, c) = angle.sin_cos();
            let (from, to) = ([radius, 0.0, 0.0], [radius * c, radius * s, rise]);
            let arc = TipArc::between(from, to, [0.0; 3], UP, 1).expect("an arc");
            let (poses, moves) = (vec![pose(from, a), pose(to, b)], vec![Move::arc(arc)]);
            let motion = Motion::of_moves(&poses, &moves);
            let path = Path::with_moves(poses, moves).expect("a path");
            let grid = Grid::new([x - 4.5, y - 4.5], [x + 4.5, y + 4.5], [7, 7]).expect("a grid");
            let profile = tool.profile().expect("a solid of revolution");
            let check = || {
                let charts = swept_along(tool, &path, &grid, Method::Mixed)?;
                let tally = judge_sweep(&charts, profile, &motion, &grid, Method::Mixed)?;
                if tally.covered < 10 || tally.repaired > 0 {
                    return Err(format!("{tally:?}"));
                }
                let lines = swept_along(tool, &path, &grid, Method::Lines)?;
                same_sweeps(profile, &motion, &grid, &charts, &lines)
            };
            check().err().map(|error| format!("{name}, {:?}: {error}", cases[case]))
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "{} of {}:\n{}",
        wrong.len(),
        all.len(),
        wrong.join("\n")
    );
}
