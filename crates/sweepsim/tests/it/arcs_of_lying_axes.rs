//! Arcs of tools that lie in the plane of the arc, along the dexels or across them, as dexels along x and y see those
//! of `G18` and `G19`: in closed form, against charts and against samples in time.

use crate::arcs_along_dexels::{angles, least_of, starts, tool};
use crate::arcs_in_closed_form::{check, check_boxes, check_in_general, check_near_material, grid, small};
use crate::arcs_of_lying_tools::seen;
use crate::translations::{TOLERANCE, agree, cases, tools};
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim::{Options, SweepError, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Move, Path, Pose, TipArc};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

/// An arc: radius, angle of its start, angle.
type Arc = [f64; 3];

/// How arcs and tool lie: the tool along x or along y, to either side; the arcs along the dexels, or level.
#[derive(Clone, Copy, Debug)]
struct Lie {
    y: bool,
    positive: bool,
    level: bool,
}

impl Lie {
    fn axis(self) -> [f64; 3] {
        let sign = if self.positive { 1.0 } else { -1.0 };
        if self.y { [0.0, sign, 0.0] } else { [sign, 0.0, 0.0] }
    }

    /// The directions from the centre of an arc at 0° and 90°: the axis' without its sign, and that of the dexels, or
    /// the third one.
    fn plane(self) -> [[f64; 3]; 2] {
        let along @ [x, y, _] = self.axis().map(f64::abs);
        [along, if self.level { [y, x, 0.0] } else { [0.0, 0.0, 1.0] }]
    }

    /// From the centre.
    fn out(self, radius: f64, angle: f64) -> [f64; 3] {
        let [u, v] = self.plane();
        std::array::from_fn(|k| radius * (u[k] * angle.cos() + v[k] * angle.sin()))
    }

    fn normal(self) -> [f64; 3] {
        let [[a, b, c], [d, e, f]] = self.plane();
        [b * f - c * e, c * d - a * f, a * e - b * d]
    }

    /// Arcs one after the other from a point, each followed by a straight move of this vector.
    fn path(self, start: [f64; 3], arcs: &[Arc], way: [f64; 3]) -> Path {
        let mut tip = start;
        let mut poses = vec![Pose::new(tip, self.axis()).unwrap()];
        let mut moves = Vec::new();
        for [radius, from, angle] in arcs {
            let [out, to] = [*from, from + angle].map(|angle| self.out(*radius, angle));
            let centre: [f64; 3] = std::array::from_fn(|k| tip[k] - out[k]);
            tip = std::array::from_fn(|k| {
                if self.normal()[k] == 0.0 {
                    centre[k] + to[k]
                } else {
                    tip[k]
                }
            });
            poses.push(Pose::new(tip, self.axis()).unwrap());
            moves.push(Move::arc(TipArc::new(centre, self.normal(), *angle).unwrap()));
            if way != [0.0; 3] {
                tip = std::array::from_fn(|k| tip[k] + way[k]);
                poses.push(Pose::new(tip, self.axis()).unwrap());
                moves.push(Move::default());
            }
        }
        Path::with_moves(poses, moves).unwrap()
    }

    /// Without its part out of the arcs' plane.
    fn within(self, way: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| if self.normal()[k] == 0.0 { way[k] } else { 0.0 })
    }
}

fn lies() -> impl Strategy<Value = Lie> {
    (any::<bool>(), any::<bool>(), any::<bool>()).prop_map(|(y, positive, level)| Lie { y, positive, level })
}

fn arcs(count: usize, radius: std::ops::Range<f64>) -> impl Strategy<Value = Vec<Arc>> {
    let arc = (radius, starts(), angles()).prop_map(|(radius, from, angle)| [radius, from, angle]);
    collection::vec(arc, 1..=count)
}

/// Level arcs are displaced within their plane for closed forms only, so that there may be other crossings within the
/// tool.
fn compare(lie: Lie, number: usize, path: &Path) -> TestCaseResult {
    if !lie.level {
        return check_in_general(number, path);
    }
    let [closed, charts] = check(number, path)?;
    let [own, other] = [&closed.statistics, &charts.statistics];
    prop_assert!(own.repaired <= other.repaired + 2, "{own:?} {other:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2 * cases(), ..ProptestConfig::default() })]

    /// Wider and narrower than the tool, in both directions, more than a half turn among them; joined by straight ways
    /// in their plane, or out of it.
    #[test]
    fn in_plane(lie in lies(), number in 0_usize..13, start in small(3.0), way in small(2.0), inside in any::<bool>(), arcs in arcs(3, 0.3..6.0)) {
        let way = if inside { lie.within(way) } else { way };
        compare(lie, number, &lie.path(start, &arcs, way))?;
    }

    /// One after the other.
    #[test]
    fn joined(lie in lies(), number in 0_usize..13, start in small(3.0), arcs in arcs(3, 0.3..6.0)) {
        compare(lie, number, &lie.path(start, &arcs, [0.0; 3]))?;
    }

    /// Tiny and wide arcs.
    #[test]
    fn sizes(lie in lies(), number in 0_usize..13, start in small(3.0), from in starts(), size in -4.0..3.5_f64, part in 0.05..1.0_f64, left in any::<bool>()) {
        let radius = 10.0_f64.powf(size);
        let angle = (part * 6.0).min(8.0 * part / radius);
        let arc = [radius, from, if left { angle } else { -angle }];
        check(number, &lie.path(start, &[arc], [0.5, 0.2, 0.1]))?;
    }

    /// With the radius of the tool, full circles, each twice, over rows of dexels in the arc's plane, through tips and
    /// in walls. No row is in the plane of a face where it turns back, for which charts take minutes: see
    /// [`in_planes_of_faces`].
    #[test]
    fn degenerate(lie in lies(), number in 0_usize..13, which in 0_usize..4, quarter in 0..4_i32, turns in 1..5_i32, left in any::<bool>()) {
        let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).expect("a grid");
        let radius = [3.0, 1.0, 4.5, 2.0][which];
        let side = if left { 1.0 } else { -1.0 };
        let arc = [radius, f64::from(quarter) * FRAC_PI_2, side * f64::from(turns) * FRAC_PI_2];
        let [u, v] = lie.plane();
        // Level arcs are extreme across the axis, too.
        let off = if lie.level { 0.4 } else { 0.0 };
        let start = std::array::from_fn(|k| 0.3 * u[k] + off * v[k]);
        let (name, tool, _) = &tools()[number];
        agree(name, tool, &lie.path(start, &[arc, arc], [0.0; 3]), &lines, TOLERANCE)?;
    }

    /// Only what comes near material is computed: the part is the same.
    #[test]
    fn near_material(lie in lies(), number in 0_usize..13, start in small(3.0), way in small(2.0), inside in any::<bool>(), arcs in arcs(3, 0.3..6.0)) {
        let way = if inside { lie.within(way) } else { way };
        check_near_material(number, &lie.path(start, &arcs, way))?;
    }

    /// At the least tolerance, and far from the origin.
    #[test]
    fn far_and_fine(lie in lies(), number in 0_usize..13, start in small(3.0), far in prop_oneof![Just(0.0), Just(1e3), Just(1e5)], arcs in arcs(2, 0.3..6.0)) {
        let (name, tool, _) = &tools()[number];
        let lines = Grid::new([far - 9.97, -10.03], [far + 10.06, 9.94], [23, 21]).expect("a grid");
        let path = lie.path([start[0] + far, start[1], start[2]], &arcs, [0.3, 0.2, 0.1]);
        let tolerance = 1e-8_f64.max(3e-10 * far);
        let least = match sweep(tool, &path, &lines, &Options::new(1e-14), &()) {
            Err(SweepError::TooFine { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        agree(name, tool, &path, &lines, (1.001 * least).max(tolerance))?;
    }
}

/// Such arcs are solved without charts.
#[test]
fn hardly_a_box() {
    // The last two are narrower than the tools.
    let arcs = [[4.0, 0.3, 5.0], [3.5, 1.0, -4.0], [2.4, 2.0, 3.0], [1.1, 0.0, -3.0]];
    for level in [false, true] {
        let lie = Lie {
            y: level,
            positive: true,
            level,
        };
        let path = lie.path([1.1, 0.3, 0.2], &arcs, lie.within([0.5, 0.5, 0.1]));
        let some = tools()
            .into_iter()
            .filter(|(name, ..)| ["flat", "ball", "bull", "form"].contains(name));
        check_boxes(some.map(|(_, tool, _)| tool), &path);
    }
}

/// Compares the lowest point over each line with that of the tool, sampled in time.
fn lowest(lie: Lie, pointed: bool, start: [f64; 3], [radius, from, angle]: Arc, lines: &Grid) -> TestCaseResult {
    let [ax, ay, _] = lie.axis();
    let (tool, _) = tool(pointed);
    let path = lie.path(start, &[[radius, from, angle]], [0.0; 3]);
    let found = sweep(&tool, &path, lines, &Options::new(TOLERANCE), &()).unwrap();
    prop_assert!(found.statistics.unresolved.is_empty(), "{:?}", found.statistics);
    let before = lie.out(radius, from);
    for index in 0..lines.len() {
        let (i, j) = lines.place(index);
        // How far the line is inside, and the lowest point.
        let at = |share: f64| {
            let out = lie.out(radius, from + angle * share);
            let tip: [f64; 3] = std::array::from_fn(|k| start[k] + out[k] - before[k]);
            let [x, y] = [lines.x(i) - tip[0], lines.y(j) - tip[1]];
            seen(pointed, tip[2], ax * x + ay * y, ax * y - ay * x)
        };
        let [inside, lowest] = least_of(|share| {
            let [depth, lowest] = at(share);
            [-depth, lowest]
        });
        let deepest = -inside;
        let own = found.volume.at(index).to_vec();
        let Some(first) = own.first() else {
            prop_assert!(deepest < 1e-6, "{:?} {deepest}", (i, j));
            continue;
        };
        let steep = f64::from(first.lower.normal[2]).abs().max(1e-3);
        // The tool has to be seen in its narrow time over a line, too.
        let seen = deepest > 1e-3;
        let off = (first.lower.z - lowest).abs();
        prop_assert!(
            !seen || off <= 2.0 * TOLERANCE / steep,
            "{:?}: {first:?} {lowest}",
            (i, j)
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// The lowest point over each line is that of the tool, sampled in time.
    #[test]
    fn lowest_points(lie in lies(), pointed in any::<bool>(), start in small(3.0), arcs in arcs(1, 0.3..9.0)) {
        lowest(lie, pointed, start, arcs[0], &grid([10, 9]))?;
    }
}

/// Rows of dexels in the planes of faces at the ends of arcs, and where the tool turns back, through tips and in walls:
/// hardly a box, where charts alone take minutes.
#[test]
fn in_planes_of_faces() {
    let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).expect("a grid");
    for level in [false, true] {
        for quarters in 0..16 {
            let lie = Lie {
                y: quarters % 2 == 0,
                positive: quarters % 3 == 0,
                level,
            };
            let arc = |radius| {
                [
                    radius,
                    f64::from(quarters % 4) * FRAC_PI_2,
                    f64::from(quarters / 4 + 1) * FRAC_PI_2,
                ]
            };
            for (number, (name, tool, _)) in tools().iter().enumerate() {
                if ["flat", "bull", "drill", "lollipop"].contains(name) {
                    let radius = [3.0, 1.0, 2.5, 4.0][(number + quarters as usize) % 4];
                    let path = lie.path([0.0; 3], &[arc(radius)], [0.0; 3]);
                    let swept = sweep(tool, &path, &lines, &Options::new(TOLERANCE), &()).unwrap();
                    assert_eq!(swept.statistics.unresolved, [], "{name}: {:?}", swept.statistics);
                    assert!(
                        swept.statistics.boxes < 100_000,
                        "{name} {lie:?}: {:?}",
                        swept.statistics
                    );
                }
            }
        }
    }
}

/// Circles of the radius of the tool.
#[test]
fn circles_of_the_radius_of_the_tool() {
    for (number, radius) in [(0, 3.0), (1, 3.0), (3, 2.5), (11, 1.0), (11, 3.0)] {
        let (_, tool, _) = &tools()[number];
        for level in [false, true] {
            let lie = Lie {
                y: !level,
                positive: level,
                level,
            };
            let arcs = [[radius, 0.0, 2.0 * PI], [radius, 0.0, -2.0 * PI]];
            let path = lie.path([0.0; 3], &arcs, [0.0; 3]);
            let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).unwrap();
            let swept = sweep(tool, &path, &lines, &Options::new(TOLERANCE), &()).unwrap();
            assert_eq!(
                swept.statistics.unresolved,
                [],
                "{number} {radius}: {:?}",
                swept.statistics
            );
        }
    }
}
