//! Moves without rotation of tools of any shape, by their grazing curves, against charts.

use crate::freeform::block;
use crate::translations::{TOLERANCE, agree, cases, path, same};
use sweepsim::nalgebra::{Rotation3, Vector3};
use sweepsim::{Method, Options, SweepError, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::{Patch, Path, Pose, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;
use sweepsim_spline::{Bernstein, KnotVector, RationalSpline};

fn bicubic(point: impl Fn(f64, f64) -> [f64; 3]) -> Patch {
    let third = |k: usize| k as f64 / 3.0;
    let form = |axis: usize| {
        let values = (0..16).map(|k| point(third(k % 4), third(k / 4))[axis]);
        Bernstein::new(&[3, 3], values.collect()).expect("a form")
    };
    let one = Bernstein::new(&[3, 3], vec![1.0; 16]).expect("a form");
    Patch::new([form(0), form(1), form(2)], one).expect("a patch")
}

/// A cushion with a sharp seam: two bicubic patches over a square, without any symmetry.
fn cushion() -> Tool {
    let at = |side: f64| {
        move |u: f64, v: f64| {
            let rim = u * (1.0 - u) * v * (1.0 - v);
            let seam = 0.5 * (2.0 * u - v) + 2.5;
            let [x, y] = if side > 0.0 { [u, v] } else { [v, u] };
            let seam = if side > 0.0 { seam } else { 0.5 * (2.0 * v - u) + 2.5 };
            let bulge = rim * side * (18.0 + 25.0 * x - 14.0 * y);
            [5.0 * x - 2.4 + 0.6 * y, 4.0 * y - 1.9, seam + bulge]
        }
    };
    Tool::from_patches(vec![bicubic(at(1.0)), bicubic(at(-1.0))], 1e-9).expect("a tool")
}

/// A body of revolution made oval and sheared, as rational patches with poles: nothing is round. `pieces` of the
/// meridian are lists of homogeneous `(ρ, ζ, w)`.
pub fn oval(pieces: &[Vec<[f64; 3]>]) -> Tool {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let mut patches = Vec::new();
    for piece in pieces {
        for quarter in 0..4 {
            let at = |half_turns: f64| {
                let angle = 0.3 + half_turns * std::f64::consts::FRAC_PI_4;
                [angle.cos(), angle.sin()]
            };
            let start = 2.0 * f64::from(quarter);
            let [from, middle, to] = [at(start), at(start + 1.0), at(start + 2.0)];
            let circle = [[from[0], from[1], 1.0], [middle[0], middle[1], h], [to[0], to[1], 1.0]];
            let products = piece.iter().flat_map(|m| circle.iter().map(move |c| (c, m)));
            let points: Vec<[f64; 4]> = products
                .map(|(c, m)| {
                    let [x, y, z] = [c[0] * m[0], c[1] * m[0], c[2] * m[1]];
                    [1.3 * x + 0.1 * z, 0.8 * y - 0.2 * x, z, c[2] * m[2]]
                })
                .collect();
            let form = |k: usize| {
                let values = points.iter().map(|point| point[k]).collect();
                Bernstein::new(&[2, piece.len() - 1], values).expect("a form")
            };
            patches.push(Patch::new([form(0), form(1), form(2)], form(3)).expect("a patch"));
        }
    }
    Tool::from_patches(patches, 1e-9).expect("a tool")
}

pub fn straight(from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 3]> {
    vec![[from[0], from[1], 1.0], [to[0], to[1], 1.0]]
}

/// A round end, a neck, a shoulder.
pub fn bud() -> Tool {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let round = vec![[0.0, 0.0, 1.0], [2.0 * h, 0.0, h], [2.0, 2.0, 1.0]];
    let waist = vec![[2.0, 2.0, 1.0], [2.0, 4.0, 1.0], [0.8, 3.4, 1.0], [1.4, 5.5, 1.0]];
    oval(&[
        round,
        waist,
        straight([1.4, 5.5], [2.1, 6.0]),
        straight([2.1, 6.0], [2.1, 8.0]),
        straight([2.1, 8.0], [0.0, 8.0]),
    ])
}

/// As flat in the middle of its end as a router bit of one B-spline surface: its height grows with the third power of
/// the distance.
pub fn pad() -> Tool {
    let end = vec![[0.0, 0.0, 1.0], [0.7, 0.0, 1.0], [1.4, 0.0, 1.0], [2.0, 0.3, 1.0]];
    oval(&[end, straight([2.0, 0.3], [2.0, 7.0]), straight([2.0, 7.0], [0.0, 7.0])])
}

/// A bit as one bicubic B-spline surface that closes smoothly around its axis: not quite round, with ten patches about
/// each pole, as flat there as a cubic is.
pub fn bit() -> Tool {
    const DISTINCT: usize = 10;
    const PROFILE: [[f64; 2]; 8] = [
        [0.0, 0.0],
        [0.7, 0.0],
        [1.4, 0.0],
        [2.0, 0.3],
        [2.0, 3.0],
        [2.0, 7.0],
        [1.0, 7.0],
        [0.0, 7.0],
    ];
    let around = KnotVector::new(3, (-3..=13).map(f64::from).collect()).expect("knots");
    let up = KnotVector::new(3, (-3_i32..=8).map(|k| f64::from(k.clamp(0, 5))).collect()).expect("knots");
    let points = PROFILE.iter().flat_map(|[radius, height]| {
        (0..DISTINCT + 3).flat_map(move |k| {
            let angle = std::f64::consts::TAU * (k % DISTINCT) as f64 / DISTINCT as f64;
            [radius * angle.cos(), radius * angle.sin(), *height]
        })
    });
    let points: Vec<f64> = points.collect();
    let weights = vec![1.0; points.len() / 3];
    let surface = RationalSpline::new(vec![around, up], 3, &points, &weights).expect("a surface");
    Tool::from_surfaces(&[surface], 1e-9).expect("a tool")
}

pub fn tools() -> [(&'static str, Tool); 3] {
    [
        ("cushion", cushion()),
        ("bud", bud()),
        ("block", block([-1.5, -0.5, 0.0], [1.0, 1.0, 3.0])),
    ]
}

/// A tool of no symmetry in a constant orientation.
pub fn carried(tips: &[[f64; 3]], turn: [f64; 3]) -> Path {
    let turn = Rotation3::new(Vector3::from(turn));
    let pose = |tip: &[f64; 3]| Pose::with_side(*tip, (turn * Vector3::z()).into(), (turn * Vector3::x()).into());
    Path::new(tips.iter().map(|tip| pose(tip).expect("a pose")).collect()).expect("a path")
}

fn grid(cells: [usize; 2]) -> Grid {
    Grid::new([-9.97, -10.03], [10.06, 9.94], cells).expect("a grid")
}

fn tip() -> impl Strategy<Value = [f64; 3]> {
    [-6.0..6.0, -6.0..6.0, -3.0..3.0]
}

fn turn() -> impl Strategy<Value = [f64; 3]> {
    [-1.2..1.2, -1.2..1.2, -1.2..1.2]
}

/// The same, with hardly any line that needs the general method, and fewer boxes.
fn agree_cheaply(number: usize, path: &Path, grid: &Grid) -> TestCaseResult {
    let (name, tool) = &tools()[number];
    let [curves, charts] = agree(name, tool, path, grid, TOLERANCE)?;
    let [own, other] = [&curves.statistics, &charts.statistics];
    prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
    let off = own.crossings.abs_diff(other.crossings);
    prop_assert!(off <= 4 + other.crossings / 100, "{name}: {own:?} {other:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Moves in all directions, in any orientation, on grids in any frame.
    #[test]
    fn any_moves(number in 0..3usize, turn in turn(), x in turn(), y in turn(), turned in any::<bool>(), tips in collection::vec(tip(), 2..5)) {
        let mut grid = grid([29, 31]);
        if turned {
            let frame = Frame::new([0.3, -0.2, 0.1], x, [y[1], -y[0], y[2]]);
            prop_assume!(frame.is_ok());
            grid = grid.in_frame(frame.expect("a frame"));
        }
        agree_cheaply(number, &carried(&tips, turn), &grid)?;
    }

    /// Level moves, moves along the grid and plunges, of tools that stand or lean: many lines are in walls of the
    /// block. No line is over the pole of the bud.
    #[test]
    fn moves_along_the_axes(number in 0..3usize, turn in turn(), stands in any::<bool>(), start in [-4..4, -4..4, -2..2],
        steps in collection::vec((0..3usize, -4..5), 1..6)) {
        let mut tips = vec![start.map(f64::from)];
        for (axis, step) in steps {
            let mut next = tips[tips.len() - 1];
            next[axis] += f64::from(step);
            tips.push(next);
        }
        let (name, tool) = &tools()[number];
        let [x, y] = if *name == "bud" { [0.11, 0.17] } else { [0.0; 2] };
        let grid = Grid::new([x - 10.25, y - 10.25], [x + 10.25, y + 10.25], [41, 41]).expect("a grid");
        agree(name, tool, &carried(&tips, if stands { [0.0; 3] } else { turn }), &grid, TOLERANCE)?;
    }

    /// Many short moves, back and forth: cells serve both ways, and each time they are divided further.
    #[test]
    fn short_moves(number in 0..3usize, turn in turn(), heading in 0.0..6.3, rise in -0.4..0.4, exponent in -5..0i32, rows in 1..4usize) {
        let step = 10f64.powi(exponent);
        let (c, s) = (f64::cos(heading), f64::sin(heading));
        let mut tips = Vec::new();
        for row in 0..rows {
            for k in 0..6 {
                let along = if row % 2 == 0 { f64::from(k) } else { f64::from(5 - k) };
                let across = row as f64 * 0.7;
                tips.push([c * along * step - s * across, s * along * step + c * across, rise * along * step]);
            }
        }
        agree_cheaply(number, &carried(&tips, turn), &grid([25, 27]))?;
    }

    /// Moves in the tangent plane of the bud's pole, or almost, whose tip passes over a line, or almost: the grazing
    /// curve passes through the pole.
    #[test]
    fn poles_over_lines(turn in turn(), stands in any::<bool>(), heading in 0.0..6.3_f64, along in -3.0..3.0_f64, beside in 0.0..13.0_f64, slope in 0.0..13.0_f64, line in [0..29usize, 0..31usize], back in any::<bool>()) {
        let turn = if stands { [0.0; 3] } else { turn };
        let small = |digits: f64| if digits > 12.0 { 0.0 } else { 10f64.powf(-digits) };
        let grid = grid([29, 31]);
        let way = Rotation3::new(Vector3::from(turn)) * Vector3::new(heading.cos(), heading.sin(), small(slope));
        let over = Vector3::new(grid.x(line[0]), grid.y(line[1]) + small(beside), 0.0);
        let mut tips = vec![(over + along * way).into(), (over + (along + 4.0) * way).into()];
        if back {
            tips.push((over + (along - 1.0) * way).into());
        }
        agree("bud", &bud(), &carried(&tips, turn), &grid, TOLERANCE)?;
    }

    /// Grids on which many lines lie over one chart, so that its curve is divided before its lines are looked at.
    #[test]
    fn many_lines_over_a_chart(number in 0..3usize, turn in turn(), tips in collection::vec(tip(), 2..4), narrow in any::<bool>()) {
        let cells = if narrow { [23, 397] } else { [151, 149] };
        agree_cheaply(number, &carried(&tips, turn), &grid(cells))?;
    }

    /// Moves far beyond the grid, and the least tolerance.
    #[test]
    fn far_and_fine(number in 0..3usize, turn in turn(), length in 1.0..5.0f64, heading in 0.0..6.3, rise in -0.2..0.2f64, fine in any::<bool>()) {
        let (name, tool) = &tools()[number];
        let far = 10f64.powf(length);
        let tips = [[0.7, -0.2, 0.1], [far * f64::cos(heading), far * f64::sin(heading), rise * far]];
        let moves = carried(&tips, turn);
        let grid = grid([17, 19]);
        let least = match sweep(tool, &moves, &grid, &Options::new(1e-300), &()) {
            Err(SweepError::TooFine { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        agree(name, tool, &moves, &grid, if fine { least } else { least.max(TOLERANCE) })?;
    }
}

/// Nearly vertical moves, from a plunge to a ramp.
#[test]
fn steep_moves() {
    for (name, tool) in &tools() {
        for exponent in [-12, -9, -7, -5, -3, -1] {
            let off = 10f64.powi(exponent);
            let moves = carried(
                &[[0.2, -0.3, 1.0], [0.2 + off, -0.3 + 0.4 * off, -1.0]],
                [0.3, -0.2, 0.5],
            );
            agree(name, tool, &moves, &grid([19, 17]), TOLERANCE).expect("the same");
        }
    }
}

/// The result does not depend on which moves were made before on the same thread.
#[test]
fn the_same_bytes_whatever_came_before() {
    let tool = bud();
    let moves = carried(
        &[[-3.0, 0.0, 0.0], [2.0, 1.0, 0.5], [-1.0, -2.0, 0.3], [4.0, -1.0, 0.8]],
        [0.4, 0.1, 0.0],
    );
    let grid = grid([151, 150]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            sweep(&tool, &moves, &grid, &Options::new(TOLERANCE), &())
                .expect("a sweep")
                .volume
        })
    };
    assert_eq!(on(1), on(4));
}

/// Fewer boxes than charts take, which solve the joints in both.
#[test]
fn few_boxes_along_a_raster() {
    let mut tips = Vec::new();
    for row in 0..4 {
        for k in 0..9 {
            let x = if row % 2 == 0 { f64::from(k) } else { f64::from(8 - k) };
            tips.push([x - 4.0, 1.5 * f64::from(row) - 2.0, 0.0]);
        }
    }
    for (name, tool) in &tools()[..2] {
        let moves = path(&tips, [0.0, 0.0, 1.0]);
        let [curves, charts] = agree(name, tool, &moves, &grid([41, 43]), TOLERANCE).expect("the same");
        let [own, other] = [&curves.statistics, &charts.statistics];
        assert!(3 * own.boxes < 2 * other.boxes, "{name}: {own:?} {other:?}");
        assert_eq!(own.crossings, other.crossings, "{name}");
    }
}

/// Level moves whose tip passes over lines, exactly or almost: the pole of the round end touches the envelope all the
/// way there. All methods find the same, and the search is not at the mercy of the distance.
#[test]
fn poles_that_pass_over_lines() {
    let tool = bud();
    let grid = Grid::new([-3.0, -3.0], [3.0, 3.0], [15, 15]).expect("a grid");
    let boxes_and_dexels = |tips: [[f64; 3]; 2], method, tolerance| {
        let options = Options::new(tolerance).method(method);
        let done = sweep(&tool, &carried(&tips, [0.0; 3]), &grid, &options, &()).expect("a sweep");
        assert!(
            done.statistics.unresolved.is_empty(),
            "{tips:?} {method}: {:?}",
            done.statistics
        );
        (done.statistics, done.volume)
    };
    let along = |off: f64| [[-4.0, off, 0.0], [4.0, off, 0.0]];
    let diagonal = |off: f64| [[-4.0 - off, -4.0 + off, 0.0], [4.0 - off, 4.0 + off, 0.0]];
    let another = |off: f64| [[-4.0, -2.0 + off, 0.0], [4.0, 2.0 + off, 0.0]];
    let ways = [
        ("over a row", along(0.0), along(0.1)),
        ("a row begins", [[-0.1, 0.0, 0.0], [4.0, 0.0, 0.0]], along(0.1)),
        ("beside a row", along(1e-8), along(0.1)),
        ("farther beside it", along(1e-5), along(0.1)),
        ("hardly rising", [[-4.0, 0.0, 0.0], [4.0, 0.0, 1e-8]], along(0.1)),
        ("along a diagonal", diagonal(0.0), diagonal(0.13)),
        ("along another", another(0.0), another(0.03)),
    ];
    for (name, tips, neighbour) in ways {
        const METHODS: [Method; 4] = [Method::General, Method::Mixed, Method::Planes, Method::Lines];
        let [generic, found] =
            [neighbour, tips].map(|tips| METHODS.map(|method| boxes_and_dexels(tips, method, TOLERANCE)));
        let (_, own) = &found[0];
        for (method, ((beside, _), (exact, other))) in METHODS.iter().zip(generic.iter().zip(&found)) {
            assert!(
                exact.boxes < 3 * beside.boxes && exact.repaired == 0,
                "{name}, {method}: {exact:?} {beside:?}"
            );
            for line in 0..grid.len() {
                let [a, b] = [own, other].map(|volume| volume.at(line).to_vec());
                assert!(same(&a, &b, TOLERANCE), "{name}, {method}: {line}: {a:?} {b:?}");
            }
        }
        for tolerance in [1e-3, 1e-8] {
            boxes_and_dexels(tips, Method::Mixed, tolerance);
        }
    }
}

/// The flat end of a tool of patches that moves level is left to a displacement, however small: two components of its
/// normals are 0 without any error.
#[test]
fn flat_ends_at_fine_tolerances() {
    let tool = bud();
    let grid = Grid::new([-3.0, -3.0], [3.0, 3.0], [15, 15]).expect("a grid");
    let moves = carried(&[[-4.0, 0.137, 0.0], [4.0, 0.137, 0.0]], [0.0; 3]);
    for method in [Method::General, Method::Mixed] {
        let [coarse, fine] = [1e-6, 1e-9].map(|tolerance| {
            let done = sweep(&tool, &moves, &grid, &Options::new(tolerance).method(method), &()).expect("a sweep");
            assert!(done.statistics.unresolved.is_empty() && done.statistics.repaired == 0);
            done.statistics.boxes
        });
        assert!(fine < 2 * coarse, "{method}: {fine} {coarse}");
    }
}
