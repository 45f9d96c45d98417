//! Sharp edges of free-form tools along moves without rotation, which charts solve: against the general method, which
//! also solves patches and joints, and line by line.

use crate::displaced::agree_with;
use crate::freeform::block;
use crate::grazing_curves::{bud, carried};
use crate::translations::{TOLERANCE, agree, cases};
use sweepsim::nalgebra::{Rotation3, Vector3};
use sweepsim::{Method, Options, SweepError, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::{Edge, Patch, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;
use sweepsim_spline::Bernstein;

/// Numbers between −1 and 1 that look random.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Two dented blocks side by side: ten bicubic patches, none of them plane, whose edges bend in all directions. Those
/// between both blocks are convex in one place and concave in another.
fn pebble(seed: u64) -> Tool {
    let mut noise = noise(seed);
    let mut control = [[[[0.0; 3]; 2]; 4]; 7];
    for (i, plane) in control.iter_mut().enumerate() {
        for (j, column) in plane.iter_mut().enumerate() {
            for (k, point) in column.iter_mut().enumerate() {
                let place = [0.7 * i as f64 - 2.0, 1.2 * j as f64 - 1.9, 3.0 * k as f64];
                *point = place.map(|x| x + 0.24 * noise());
            }
        }
    }
    // Walls are straight between both layers.
    let at = |i: usize, j: usize, k: usize| {
        let [low, high] = control[i][j];
        let share = k as f64 / 3.0;
        [0, 1, 2].map(|a| (1.0 - share) * low[a] + share * high[a])
    };
    let face = |point: &dyn Fn(usize, usize) -> [f64; 3]| {
        let form = |axis: usize| {
            let values = (0..16).map(|n| point(n % 4, n / 4)[axis]);
            Bernstein::new(&[3, 3], values.collect()).expect("a form")
        };
        let one = Bernstein::new(&[3, 3], vec![1.0; 16]).expect("a form");
        Patch::new([form(0), form(1), form(2)], one).expect("a patch")
    };
    let mut patches = Vec::new();
    for first in [0, 3] {
        patches.push(face(&|u, v| at(first + v, u, 0)));
        patches.push(face(&|u, v| at(first + u, v, 3)));
        patches.push(face(&|u, v| at(first + u, 0, v)));
        patches.push(face(&|u, v| at(first + v, 3, u)));
    }
    patches.push(face(&|u, v| at(0, v, u)));
    patches.push(face(&|u, v| at(6, u, v)));
    Tool::from_patches(patches, 1e-9).expect("a tool")
}

/// One of the tools; those of no fixed shape by their seed.
fn tool(number: u64) -> (String, Tool) {
    match number {
        0 => ("bud".into(), bud()),
        1 => ("block".into(), block([-1.5, -0.5, 0.0], [1.0, 1.0, 3.0])),
        seed => (format!("pebble {seed}"), pebble(seed)),
    }
}

/// A point of an edge, its tangent, and the normals of both faces.
fn on_edge(edge: &Edge, r: f64) -> [Vector3<f64>; 4] {
    let weight = edge.weight();
    let value = |form: &Bernstein| form.evaluate(&[r]);
    let slope = |form: &Bernstein| form.derivative(0).evaluate(&[r]);
    let place = edge.position().each_ref().map(|form| value(form) / value(weight));
    let tangent = [0, 1, 2].map(|k| (slope(&edge.position()[k]) - place[k] * slope(weight)) / value(weight));
    let normals = [edge.before(), edge.after()].map(|field| field.normal().each_ref().map(value));
    [place, tangent, normals[0], normals[1]].map(Vector3::from)
}

fn grid(cells: [usize; 2]) -> Grid {
    Grid::new([-9.97, -10.03], [10.06, 9.94], cells).expect("a grid")
}

fn tip() -> impl Strategy<Value = [f64; 3]> {
    [-6.0..6.0, -6.0..6.0, -3.0..3.0]
}

fn turn() -> impl Strategy<Value = [f64; 3]> {
    [-1.5..1.5, -1.5..1.5, -1.5..1.5]
}

/// A number that is 0, or small by any number of digits.
fn small() -> impl Strategy<Value = f64> {
    (0.0..14.0_f64, any::<bool>()).prop_map(|(digits, negative)| match (digits > 13.0, negative) {
        (true, _) => 0.0,
        (_, true) => -10f64.powf(-digits),
        (_, false) => 10f64.powf(-digits),
    })
}

/// The same as by the general method, with hardly any more lines that are solved again.
fn agree_cheaply(number: u64, tips: &[[f64; 3]], turn: [f64; 3], grid: &Grid) -> TestCaseResult {
    let (name, tool) = tool(number);
    let [curves, general] = agree(&name, &tool, &carried(tips, turn), grid, TOLERANCE)?;
    let [own, other] = [&curves.statistics, &general.statistics];
    prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
    let off = own.crossings.abs_diff(other.crossings);
    prop_assert!(off <= 4 + other.crossings / 100, "{name}: {own:?} {other:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Moves in all directions, in any orientation, on grids in any frame.
    #[test]
    fn any_moves(number in 0..10_000_u64, turn in turn(), x in turn(), y in turn(), turned in any::<bool>(), tips in collection::vec(tip(), 2..5)) {
        let mut grid = grid([29, 31]);
        if turned {
            let frame = Frame::new([0.3, -0.2, 0.1], x, [y[1], -y[0], y[2]]);
            prop_assume!(frame.is_ok());
            grid = grid.in_frame(frame.expect("a frame"));
        }
        agree_cheaply(number, &tips, turn, &grid)?;
    }

    /// Level moves, moves along the grid and plunges, of tools that stand or lean.
    #[test]
    fn moves_along_the_axes(number in prop_oneof![Just(1), 1..10_000_u64], turn in turn(), stands in any::<bool>(), start in [-4..4, -4..4, -2..2],
        steps in collection::vec((0..3usize, -4..5), 1..6)) {
        let mut tips = vec![start.map(f64::from)];
        for (axis, step) in steps {
            let mut next = tips[tips.len() - 1];
            next[axis] += f64::from(step);
            tips.push(next);
        }
        let (name, tool) = tool(number);
        let grid = Grid::new([-10.25, -10.25], [10.25, 10.25], [41, 41]).expect("a grid");
        agree(&name, &tool, &carried(&tips, if stands { [0.0; 3] } else { turn }), &grid, TOLERANCE)?;
    }

    /// Many short moves, back and forth, whose directions are those of one family or of a few.
    #[test]
    fn short_moves(number in 0..10_000_u64, turn in turn(), heading in 0.0..6.3, rise in -0.4..0.4, exponent in -5..0i32, off in small()) {
        let step = 10f64.powi(exponent);
        let (c, s) = (f64::cos(heading), f64::sin(heading));
        let mut tips = Vec::new();
        for row in 0..3 {
            for k in 0..6 {
                let along = if row % 2 == 0 { f64::from(k) } else { f64::from(5 - k) };
                let across = f64::from(row) * 0.7 + off * f64::from(k * k) * step;
                tips.push([c * along * step - s * across, s * along * step + c * across, rise * along * step]);
            }
        }
        agree_cheaply(number, &tips, turn, &grid([25, 27]))?;
    }

    /// Lines under a point of an edge or under its end at some time, exactly or almost, where the tip goes any way,
    /// along the edge, or along one of its faces, or almost: that is where `p` turns, and where signs of `g` change.
    #[test]
    fn lines_under_edges(number in 0..10_000_u64, turn in turn(), stands in any::<bool>(), which in any::<prop::sample::Index>(), r in 0.0..1.0_f64, end in 0..4u8, way in 0..5u8,
        free in [-1.0..1.0, -1.0..1.0, -1.0..1.0], beside in small(), slope in small(), before in 0.0..3.0_f64, line in [0..29usize, 0..31usize]) {
        let turn = if stands { [0.0; 3] } else { turn };
        let (name, tool) = tool(number);
        let edges = tool.edges();
        let r = match end { 0 => 0.0, 1 => 1.0, _ => r };
        let rotation = Rotation3::new(Vector3::from(turn));
        let [place, tangent, a, b] = on_edge(&edges[which.index(edges.len())], r).map(|v| rotation * v);
        let free = Vector3::from(free);
        let along = |normal: Vector3<f64>| free.cross(&normal);
        // The last one goes the way of the edge as seen along the dexels, at another slope.
        let way = match way {
            0 => free,
            1 => tangent,
            2 => along(a),
            3 => along(b),
            _ => Vector3::new(tangent.x, tangent.y, free.z),
        };
        let way = way.normalize() + slope * free;
        prop_assume!(way.norm() > 0.1);
        let grid = grid([29, 31]);
        let over = Vector3::new(grid.x(line[0]), grid.y(line[1]) + beside, 0.0) - place;
        let moves = carried(&[over - before * way, over + (before + 2.0) * way].map(Into::into), turn);
        let [own, other] = [Method::Mixed, Method::General].map(|method| {
            let options = Options::new(TOLERANCE).method(method);
            sweep(&tool, &moves, &grid, &options, &()).expect("a sweep").statistics
        });
        prop_assert!(own.unresolved.is_empty(), "{name}: {own:?}");
        // The general method uses up its budget below a cusp of the projected edge, where `p` turns at its end.
        prop_assume!(other.unresolved.is_empty());
        agree(&name, &tool, &moves, &grid, TOLERANCE)?;
    }

    /// Nearly vertical moves, from a plunge to a ramp.
    #[test]
    fn steep_moves(number in 0..10_000_u64, turn in turn(), start in tip(), off in [small(), small()], height in -4.0..4.0_f64) {
        let tips = [start, [start[0] + off[0], start[1] + off[1], start[2] + height]];
        let (name, tool) = tool(number);
        agree(&name, &tool, &carried(&tips, turn), &grid([29, 31]), TOLERANCE)?;
    }

    /// Grids on which many lines lie over one chart, so that its curve is divided before its lines are looked at.
    #[test]
    fn many_lines_over_a_chart(number in 0..10_000_u64, turn in turn(), tips in collection::vec(tip(), 2..4), narrow in any::<bool>()) {
        let cells = if narrow { [23, 397] } else { [151, 149] };
        agree_cheaply(number, &tips, turn, &grid(cells))?;
    }

    /// Moves far beyond the grid, and the least tolerance.
    #[test]
    fn far_and_fine(number in 0..10_000_u64, turn in turn(), length in 1.0..5.0f64, heading in 0.0..6.3, rise in -0.2..0.2f64, fine in any::<bool>()) {
        let (name, tool) = tool(number);
        let far = 10f64.powf(length);
        let tips = [[0.7, -0.2, 0.1], [far * f64::cos(heading), far * f64::sin(heading), rise * far]];
        let moves = carried(&tips, turn);
        let grid = grid([17, 19]);
        let least = match sweep(&tool, &moves, &grid, &Options::new(1e-300), &()) {
            Err(SweepError::TooFine { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        agree(&name, &tool, &moves, &grid, if fine { least } else { least.max(TOLERANCE) })?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Against a method that solves each line by itself: edges are left to charts, with which the tests above compare.
    #[test]
    fn as_line_by_line(number in 0..10_000_u64, turn in turn(), tips in collection::vec(tip(), 2..4)) {
        let (name, tool) = tool(number);
        agree_with(Method::Lines, &name, &tool, &carried(&tips, turn), (&grid([13, 11]), TOLERANCE))?;
    }
}
