//! Tools of any shape: user-defined patches, with and without symmetry.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use sweepsim::{Options, sweep};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::{Patch, Path, Pose, Tool};
use sweepsim_props::*;
use sweepsim_spline::Bernstein;

const TOLERANCE: f64 = 1e-6;

/// A solid of revolution as patches that know nothing of it, with poles on the axis. The meridian's pieces are lists of
/// homogeneous `(ρ, ζ, w)`, from the tip up.
fn revolved(pieces: &[Vec<[f64; 3]>]) -> Tool {
    weighted(pieces, 0.0)
}

/// The same surfaces with all homogeneous coordinates multiplied by `1 + bend u v`: where it is not 0, nothing in their
/// forms tells that they are round.
fn weighted(pieces: &[Vec<[f64; 3]>], bend: f64) -> Tool {
    let factor = Bernstein::new(&[1, 1], vec![1.0, 1.0, 1.0, 1.0 + bend]).unwrap();
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let mut patches = Vec::new();
    for piece in pieces {
        for quarter in 0..4 {
            let at = |half_turns: f64| {
                let angle = 0.3 + half_turns * std::f64::consts::FRAC_PI_4;
                [angle.cos(), angle.sin(), 1.0]
            };
            let start = 2.0 * f64::from(quarter);
            // Tangents meet at 1/cos 45°, with the weight cos 45°.
            let middle = at(start + 1.0);
            let circle = [at(start), [middle[0], middle[1], h], at(start + 2.0)];
            let form = |value: &dyn Fn([f64; 3], [f64; 3]) -> f64| {
                let coefficients = piece.iter().flat_map(|m| circle.iter().map(|c| value(*c, *m)));
                let form = Bernstein::new(&[2, piece.len() - 1], coefficients.collect()).unwrap();
                if bend == 0.0 {
                    form
                } else {
                    form.mul(&factor).assumed_exact()
                }
            };
            let position = [
                form(&|c, m| c[0] * m[0]),
                form(&|c, m| c[1] * m[0]),
                form(&|c, m| c[2] * m[1]),
            ];
            patches.push(Patch::new(position, form(&|c, m| c[2] * m[2])).unwrap());
        }
    }
    Tool::from_patches(patches, 1e-9).unwrap()
}

fn line(from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 3]> {
    vec![[from[0], from[1], 1.0], [to[0], to[1], 1.0]]
}

/// A quarter of a circle whose tangents meet at `corner`.
fn quarter(from: [f64; 2], corner: [f64; 2], to: [f64; 2]) -> Vec<[f64; 3]> {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    vec![
        [from[0], from[1], 1.0],
        [corner[0] * h, corner[1] * h, h],
        [to[0], to[1], 1.0],
    ]
}

/// Ball, flat and bull of radius 2 and length 9, and their numbers of sharp edges.
fn with_and_without(which: usize) -> (Tool, Tool, usize) {
    let (wall, top) = (|from: f64| line([2.0, from], [2.0, 9.0]), line([2.0, 9.0], [0.0, 9.0]));
    match which {
        0 => {
            let round = quarter([0.0, 0.0], [2.0, 0.0], [2.0, 2.0]);
            (Tool::ball(2.0, 9.0).unwrap(), revolved(&[round, wall(2.0), top]), 4)
        }
        1 => (
            Tool::flat(2.0, 9.0).unwrap(),
            revolved(&[line([0.0, 0.0], [2.0, 0.0]), wall(0.0), top]),
            8,
        ),
        _ => {
            let corner = quarter([1.3, 0.0], [2.0, 0.0], [2.0, 0.7]);
            let floor = line([0.0, 0.0], [1.3, 0.0]);
            (
                Tool::bull(2.0, 0.7, 9.0).unwrap(),
                revolved(&[floor, corner, wall(0.7), top]),
                4,
            )
        }
    }
}

fn assert_same(a: &Dexels, b: &Dexels) -> Result<(), TestCaseError> {
    for index in 0..a.grid().len() {
        let (x, y) = (a.at(index), b.at(index));
        // Films thinner than the tolerance may be missing.
        let thick = |line: sweepsim_dexel::Line<'_>| {
            let keep = |i: &sweepsim_dexel::Interval| i.length() > 10.0 * TOLERANCE;
            line.iter()
                .filter(keep)
                .map(|i| [i.lower.z, i.upper.z])
                .collect::<Vec<_>>()
        };
        let (x, y) = (thick(x), thick(y));
        prop_assert_eq!(x.len(), y.len(), "line {}: {:?} {:?}", index, x, y);
        for (p, q) in x.iter().flatten().zip(y.iter().flatten()) {
            prop_assert!((p - q).abs() <= 2.0 * TOLERANCE, "line {}: {} {}", index, p, q);
        }
    }
    Ok(())
}

fn pose() -> impl Strategy<Value = Pose> {
    (prop::array::uniform3(-6.0..6.0), prop::array::uniform2(-1.0..1.0))
        .prop_map(|(tip, [a, b])| Pose::new(tip, [a, b, 1.0]).unwrap())
}

/// The corners of the faces of a block: bit `a` of a corner's number tells at which end of axis `a` it is.
pub const FACES: [[usize; 4]; 6] = [
    [0, 2, 1, 3],
    [4, 5, 6, 7],
    [0, 1, 4, 5],
    [2, 6, 3, 7],
    [0, 4, 2, 6],
    [1, 3, 5, 7],
];

/// A block from `min` to `max` as six bilinear patches.
pub fn block(min: [f64; 3], max: [f64; 3]) -> Tool {
    let corner = |k: usize| [0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] });
    let patches = FACES.map(|face| {
        let form = |a: usize| Bernstein::new(&[1, 1], face.map(|k| corner(k)[a]).to_vec()).unwrap();
        Patch::new(
            [form(0), form(1), form(2)],
            Bernstein::new(&[1, 1], vec![1.0; 4]).unwrap(),
        )
        .unwrap()
    });
    Tool::from_patches(patches.to_vec(), 1e-9).unwrap()
}

/// Where the line through `(x, y)` along z is inside a block that stands at `place`, turned by `turn`.
fn through_block(
    min: [f64; 3],
    max: [f64; 3],
    turn: &Matrix3<f64>,
    place: &Vector3<f64>,
    [x, y]: [f64; 2],
) -> Option<[f64; 2]> {
    let (origin, direction) = (
        turn.tr_mul(&(Vector3::new(x, y, 0.0) - place)),
        turn.tr_mul(&Vector3::z()),
    );
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for k in 0..3 {
        let ends = [min[k], max[k]].map(|side| (side - origin[k]) / direction[k]);
        if direction[k].abs() < 1e-12 {
            if origin[k] < min[k] || origin[k] > max[k] {
                return None;
            }
            continue;
        }
        range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
    }
    (range[0] < range[1]).then_some(range)
}

/// The motion law, written anew: the angle of a rational arc at `t`.
fn angle_at(angle: f64, t: f64) -> f64 {
    if angle > std::f64::consts::FRAC_PI_2 {
        let half = 0.5 * angle;
        return if t < 0.5 {
            angle_at(half, 2.0 * t)
        } else {
            half + angle_at(half, 2.0 * t - 1.0)
        };
    }
    let (b0, b1, b2) = ((1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t);
    let (half_sine, half_cosine) = (0.5 * angle).sin_cos();
    (b1 * half_sine + b2 * angle.sin()).atan2(b0 + b1 * half_cosine + b2 * angle.cos())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The general path and the closed forms of surfaces of revolution agree.
    #[test]
    fn patches_agree_with_revolution(poses in collection::vec(pose(), 2..4), which in 0..3_usize) {
        let (tool, general, edges) = with_and_without(which);
        prop_assert_eq!(general.edges().len(), edges);
        prop_assert!(general.profile().is_none());
        let path = Path::new(poses).unwrap();
        let grid = Grid::new([-9.0, -8.0], [9.0, 10.0], [12, 12]).unwrap();
        let options = Options::new(TOLERANCE);
        let a = sweep(&tool, &path, &grid, &options, &()).unwrap();
        let b = sweep(&general, &path, &grid, &options, &()).unwrap();
        prop_assert!(a.statistics.unresolved.is_empty() && b.statistics.unresolved.is_empty());
        assert_same(&a.volume, &b.volume)?;
    }

    /// Patches of high degree, with poles, are swept like the round tools that they are: their normals are reduced on
    /// cells, and evaluated from derivatives.
    #[test]
    fn patches_of_no_special_form(poses in collection::vec(pose(), 2..3), ball in any::<bool>(), bend in 0.2..0.6) {
        let (wall, top) = (|from: f64| line([2.0, from], [2.0, 9.0]), line([2.0, 9.0], [0.0, 9.0]));
        let (tool, pieces) = if ball {
            let round = quarter([0.0, 0.0], [2.0, 0.0], [2.0, 2.0]);
            (Tool::ball(2.0, 9.0).unwrap(), vec![round, wall(2.0), top])
        } else {
            let (floor, corner) = (line([0.0, 0.0], [1.3, 0.0]), quarter([1.3, 0.0], [2.0, 0.0], [2.0, 0.7]));
            (Tool::bull(2.0, 0.7, 9.0).unwrap(), vec![floor, corner, wall(0.7), top])
        };
        let general = weighted(&pieces, bend);
        let degree = |patch: &Patch| patch.field().moment()[0].degrees().to_vec();
        // The flat ones have normals of their own.
        prop_assert!(general.patches().iter().all(|patch| degree(patch).into_iter().max() > Some(4) || patch.plane().is_some()));
        let flat = general.patches().iter().filter(|patch| patch.plane().is_some()).count();
        prop_assert_eq!(flat, if ball { 4 } else { 8 });
        // All are evaluated from derivatives, those with a pole that are not flat only at some distance from it.
        let poles = general.patches().iter().filter(|patch| patch.shrunk_sides() != [[false; 2]; 2]).count();
        prop_assert!(general.patches().iter().all(|patch| patch.product().is_some() != patch.plane().is_some()));
        prop_assert!(0 < poles && poles < general.patches().len());
        let path = Path::new(poses).unwrap();
        let grid = Grid::new([-9.0, -8.0], [9.0, 10.0], [12, 12]).unwrap();
        let options = Options::new(TOLERANCE);
        let a = sweep(&tool, &path, &grid, &options, &()).unwrap();
        let b = sweep(&general, &path, &grid, &options, &()).unwrap();
        prop_assert!(a.statistics.unresolved.is_empty() && b.statistics.unresolved.is_empty());
        assert_same(&a.volume, &b.volume)?;
    }

    /// A block that turns about any axis while it moves: no sample in time is outside of the volume, and every place of
    /// the volume is near one.
    #[test]
    fn a_block_in_full_orientation(
        tips in prop::array::uniform2(prop::array::uniform3(-3.0..3.0)),
        turn in prop::array::uniform3(-1.0..1.0),
        axis in prop::array::uniform3(-1.0..1.0),
        angle in 0.0..2.9,
    ) {
        prop_assume!(Vector3::from(axis).norm() > 0.1);
        let (min, max) = ([-1.0, -0.6, 0.0], [1.3, 0.6, 3.0]);
        let tool = block(min, max);
        let start = Rotation3::new(Vector3::from(turn));
        let k = Unit::new_normalize(Vector3::from(axis));
        let pose = |tip: [f64; 3], turn: Rotation3<f64>| {
            Pose::with_side(tip, (turn * Vector3::z()).into(), (turn * Vector3::x()).into()).unwrap()
        };
        let end = Rotation3::from_axis_angle(&k, angle) * start;
        let path = Path::new(vec![pose(tips[0], start), pose(tips[1], end)]).unwrap();
        let grid = Grid::new([-6.0, -6.0], [6.0, 6.0], [14, 14]).unwrap();
        let swept = sweep(&tool, &path, &grid, &Options::new(TOLERANCE), &()).unwrap();
        prop_assert!(swept.statistics.unresolved.is_empty(), "{:?}", swept.statistics.unresolved);
        const SAMPLES: usize = 2000;
        let [from, to] = tips.map(Vector3::from);
        // No point moves farther between samples: the angular speed of the arc is at most 4/3 of its mean for 90°.
        let step = ((to - from).norm() + 1.34 * angle * 3.5) / SAMPLES as f64;
        let states: Vec<_> = (0..=SAMPLES)
            .map(|n| {
                let t = n as f64 / SAMPLES as f64;
                let turn = Rotation3::from_axis_angle(&k, angle_at(angle, t)) * start;
                (turn.into_inner(), from + (to - from) * t)
            })
            .collect();
        let grown = |by: f64| (min.map(|c| c - by), max.map(|c| c + by));
        let (least, most) = grown(step);
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            let line = [grid.x(i), grid.y(j)];
            let found: Vec<[f64; 2]> = swept.volume.at(index).iter().map(|n| [n.lower.z, n.upper.z]).collect();
            let mut near = Vec::new();
            for (turn, place) in &states {
                if let Some([lo, hi]) = through_block(min, max, turn, place, line) {
                    let inside = hi - lo < 1e-4 || found.iter().any(|n| n[0] <= lo + 2e-5 && hi - 2e-5 <= n[1]);
                    prop_assert!(inside, "line {}: {:?} not in {:?}", index, [lo, hi], found);
                }
                near.extend(through_block(least, most, turn, place, line));
            }
            for [lo, hi] in found {
                for n in 0..=20 {
                    let z = lo + (hi - lo) * f64::from(n) / 20.0;
                    let covered = near.iter().any(|n| n[0] <= z + TOLERANCE && z - TOLERANCE <= n[1]);
                    prop_assert!(covered, "line {}: {} of {:?} is far from all samples", index, z, [lo, hi]);
                }
            }
        }
    }

    /// A tool that is not symmetric is carried along by poses that only say its axis: turning all of them about an axis
    /// changes nothing else.
    #[test]
    fn carried_tools_do_not_turn_about_their_axis(poses in collection::vec(pose(), 2..5)) {
        let path = Path::new(poses).unwrap();
        let grid = Grid::new([-9.0, -9.0], [9.0, 9.0], [14, 14]).unwrap();
        let options = Options::new(TOLERANCE);
        let carried = sweep(&block([-1.0, -0.5, 0.0], [1.0, 0.5, 4.0]), &path, &grid, &options, &()).unwrap();
        prop_assert!(carried.statistics.unresolved.is_empty(), "{:?}", carried.statistics.unresolved);
        // It stays within the cylinder around it, and holds the one inside it.
        let wide = sweep(&Tool::flat(1.25_f64.sqrt() + 1e-3, 4.001).unwrap(), &path, &grid, &options, &()).unwrap();
        let narrow = sweep(&Tool::flat(0.499, 4.0 - 1e-3).unwrap(), &path, &grid, &options, &()).unwrap();
        let mut outside = carried.volume.clone();
        outside.subtract_all(&wide.volume).unwrap();
        let mut missing = narrow.volume.clone();
        missing.subtract_all(&carried.volume).unwrap();
        // The lower faces of the three are in one plane.
        let films = |dexels: &Dexels| dexels.iter().all(|(_, line)| line.iter().all(|i| i.length() < 1e-4));
        prop_assert!(films(&outside) && films(&missing));
    }
}
