//! What almost degenerate input costs with free-form tools, whose normals vanish at poles but for one component: as in
//! [`near_degenerate`](crate::near_degenerate).
//!
//! `cargo test -p sweepsim --release --test it near_poles -- --include-ignored --nocapture` prints the table.

use crate::grazing_curves::{bit, bud, carried, pad};
use crate::near_degenerate::{
    DISTANCES, Family, METHODS, UP, arc, around, families, is_cheap, leaning, pose, through, turning_about_its_axis,
};
use crate::rational_bits::{burr, ring};
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Law, Path, SplineMotion, Turning};
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};

/// Level moves of a free-form tool whose tip passes over lines: `d` beside a row of them, beside a diagonal, or rising
/// by `d` over a row.
pub fn over_poles() -> Vec<Family> {
    fn tip_over(tips: [[f64; 3]; 2]) -> (Path, Grid) {
        (
            carried(&tips, [0.0; 3]),
            Grid::new([-3.0, -3.0], [3.0, 3.0], [15, 15]).expect("a grid"),
        )
    }
    vec![
        ("line from the way of a pole, in a row", |d| {
            tip_over([[-4.0, d, 0.0], [4.0, d, 0.0]])
        }),
        ("line from the way of a pole, on a diagonal", |d| {
            let off = d * std::f64::consts::FRAC_1_SQRT_2;
            tip_over([[-4.0 - off, -4.0 + off, 0.0], [4.0 - off, 4.0 + off, 0.0]])
        }),
        ("line from the way of a pole, on the other diagonal", |d| {
            let off = d * std::f64::consts::FRAC_1_SQRT_2;
            tip_over([[-4.0 - off, 4.0 - off, 0.0], [4.0 - off, -4.0 - off, 0.0]])
        }),
        ("line from the way of a pole, on every second diagonal", |d| {
            tip_over([[-4.0, -2.0 + 0.1 * d, 0.0], [4.0, 2.0 + 0.1 * d, 0.0]])
        }),
        ("line from the way of a pole, on every second steep diagonal", |d| {
            tip_over([[-2.0 + 0.1 * d, 4.0, 0.0], [2.0 + 0.1 * d, -4.0, 0.0]])
        }),
        ("start of a level move from a line", |d| {
            tip_over([[0.6 * d, 0.8 * d, 0.0], [-2.8, 1.6, 0.0]])
        }),
        ("end of a level move from a line", |d| {
            tip_over([[-2.8, 1.6, 0.0], [0.6 * d, -0.8 * d, 0.0]])
        }),
        ("rise of a pole over a row of lines", |d| {
            tip_over([[-4.0, 0.0, 0.0], [4.0, 0.0, d]])
        }),
    ]
}

/// Moves of a tool whose tip passes near a line on a curve, or while the tool turns.
pub fn over_poles_on_curves() -> Vec<Family> {
    fn over_the_arc(d: f64) -> Grid {
        let (s, c) = 0.8_f64.sin_cos();
        around([(1.3 + d) * c, (1.3 + d) * s])
    }
    const LEVEL: [[f64; 3]; 2] = [[-1.0, -0.4, 0.0], [1.0, 0.4, 0.0]];
    /// A cubic through the origin, rising, along which the tool turns.
    fn spline(rise: f64, turn: [f64; 3]) -> Path {
        let [a, b, c] = turn;
        let knots = || vec![KnotVector::new(3, [[0.0; 4], [1.0; 4]].concat()).expect("knots")];
        let turns = [
            [1.0, -a, -b, -c],
            [1.0, 0.2 * a, 0.1 * b, 0.0],
            [1.0, a, b, -c],
            [1.0, a, -b, c],
        ];
        let turn = BSpline::new(knots(), 4, turns.concat()).expect("a curve");
        let tips = [
            [-1.4, -0.4, -rise],
            [-0.5, -0.5, 0.0],
            [0.5, 0.5, 0.0],
            [1.4, 0.4, rise],
        ];
        let tip = RationalSpline::new(knots(), 3, &tips.concat(), &[1.0; 4]).expect("a curve");
        Path::along(SplineMotion::from_quaternions(&turn, &tip).expect("a motion"))
    }
    vec![
        ("line from a level arc", |d| {
            (arc(1.3, 0.0, [UP; 2], Turning::Even), over_the_arc(d))
        }),
        ("rise of an arc over a line", |d| {
            (arc(1.3, d, [UP; 2], Turning::Even), over_the_arc(0.0))
        }),
        ("tilt on an arc over a line", |d| {
            (arc(1.3, 0.0, [leaning(d); 2], Turning::Even), over_the_arc(0.0))
        }),
        ("axis change on an arc over a line", |d| {
            (arc(1.3, 0.0, [UP, leaning(d)], Turning::Even), over_the_arc(0.0))
        }),
        ("axis change on a level move over a line", |d| {
            let poses = vec![pose([-2.0, -0.7, 0.0], UP), pose([2.0, 0.9, 0.0], leaning(d))];
            (through(poses, Law::Slerp), around([0.0, 0.1]))
        }),
        ("tilt of a level move over a line", |d| {
            let poses = [-1.0, 1.0].map(|far| pose([2.0 * far, 0.8 * far, 0.0], leaning(d)));
            (through(poses.into(), Law::Slerp), around([0.0; 2]))
        }),
        ("line from a level spline", |d| {
            (spline(0.0, [0.0; 3]), around([0.371 * d, -0.928 * d]))
        }),
        ("rise of a spline over a line", |d| {
            (spline(d, [0.0; 3]), around([0.0; 2]))
        }),
        ("line from a level spline along which the tool turns", |d| {
            (spline(0.0, [0.1, 0.2, 0.3]), around([0.371 * d, -0.928 * d]))
        }),
        ("turn along a level spline over a line", |d| {
            (spline(0.0, [0.3 * d, -0.7 * d, 0.5 * d]), around([0.0; 2]))
        }),
        ("line from a level move that turns", |d| {
            let poses = vec![
                pose([-2.0, -0.7, 0.0], leaning(0.3)),
                pose([2.0, 0.7, 0.0], leaning(-0.2)),
            ];
            (through(poses, Law::Slerp), around([-0.33 * d, 0.94 * d]))
        }),
        ("line from a level move that turns about the own axis", |d| {
            (turning_about_its_axis(LEVEL, 0.0), around([-0.371 * d, 0.928 * d]))
        }),
        ("tilt of a level move that turns about the own axis, over a line", |d| {
            (turning_about_its_axis(LEVEL, d), around([0.0; 2]))
        }),
    ]
}

#[test]
fn poles_over_lines_cost_at_most_thrice_their_generic_neighbour() {
    let (mut wrong, tool) = (Vec::new(), ("bud", bud()));
    for method in METHODS {
        wrong.extend(
            over_poles()
                .into_iter()
                .filter_map(|family| is_cheap(method, family, &tool, &[1e-9, 0.0]).err()),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The first few free-form tools, all but the first as flat at their poles as a cubic is, on what is asked of tools of
/// revolution, and with poles over lines.
fn free_form_is_cheap(tools: usize, methods: &[Method], list: &[Family], distances: &[f64]) {
    let mut wrong = Vec::new();
    let all = [
        ("bud", bud()),
        ("pad", pad()),
        ("bit", bit()),
        ("ring", ring()),
        ("burr", burr()),
    ];
    for tool in all.into_iter().take(tools) {
        for method in methods {
            let families = list.iter().filter(|(what, _)| !is_dear(*method, what, tool.0));
            wrong.extend(families.filter_map(|family| is_cheap(*method, *family, &tool, distances).err()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What costs more, as the docs say: the tool turns about a line within 2e-9 mm of a dexel, or a pole that is as flat
/// as a cubic slides straight along a line.
fn is_dear(method: Method, what: &str, name: &str) -> bool {
    let slides: &[&str] = match method {
        Method::General => &["tilt of a level move", "line from the way of a pole", "rise of a pole"],
        Method::Surface | Method::Lines => &["line from the way of a pole", "rise of a pole"],
        Method::Planes if name == "burr" => &["rise of a pole"],
        _ => &[],
    };
    what == "tilt while turning about the own axis"
        || name != "bud" && slides.iter().any(|start| what.starts_with(start))
}

#[test]
fn moves_on_curves_cost_at_most_thrice_their_generic_neighbour() {
    free_form_is_cheap(2, &METHODS[1..2], &over_poles_on_curves(), &[1e-9]);
}

#[test]
#[ignore = "takes more than a minute"]
fn so_do_all_families() {
    let list = [families(), over_poles(), over_poles_on_curves()].concat();
    free_form_is_cheap(5, &METHODS[..2], &list, &DISTANCES);
    let over_all = [over_poles(), over_poles_on_curves()].concat();
    free_form_is_cheap(5, &METHODS[2..], &over_all, &DISTANCES);
}
