//! Level arcs and helices exactly or almost as wide as a wall or an edge of the tool, as cycles for holes of twice its
//! diameter have them: lines next to the centre touch the tool all along. In closed form, against charts and against
//! samples in time.

use crate::translations::{TOLERANCE, UP, agree, same, tools};
use std::f64::consts::PI;
use sweepsim::{Cut, Method, Options, simulate, sweep};
use sweepsim_dexel::{Grid, Stock};
use sweepsim_motion::{Move, Path, Pose, TipArc, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

/// Radii of walls, edges and necks of the [`tools`].
const RADII: [f64; 7] = [3.0, 2.5, 1.0, 1.1, 2.2, 2.4, 0.7];

/// How far the radii, and the line nearest to the centre, are from degenerate.
fn distance() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        (4.0..16.0_f64, any::<bool>()).prop_map(|(digits, wider)| {
            let size = 10_f64.powf(-digits);
            if wider { size } else { -size }
        })
    ]
}

/// An arc about a place beside the middle line of a grid, and the grid.
#[derive(Clone, Debug)]
struct Case {
    radius: f64,
    off: [f64; 2],
    from: f64,
    angle: f64,
    rise: f64,
}

impl Case {
    fn grid(lines: usize) -> Grid {
        Grid::new([-6.3, -6.3], [6.3, 6.3], [lines, lines]).expect("a grid")
    }

    fn path(&self) -> Path {
        let centre = [self.off[0], self.off[1], 0.3];
        let at = |angle: f64, rise: f64| {
            let tip = [
                centre[0] + self.radius * angle.cos(),
                centre[1] + self.radius * angle.sin(),
                centre[2] + rise,
            ];
            Pose::new(tip, UP).expect("a pose")
        };
        let arc = TipArc::new(centre, UP, self.angle).expect("an arc");
        let poses = vec![at(self.from, 0.0), at(self.from + self.angle, self.rise)];
        Path::with_moves(poses, vec![Move::arc(arc)]).expect("a path")
    }
}

fn cases() -> impl Strategy<Value = Case> {
    let near = prop_oneof![
        Just([0.0; 2]),
        (distance(), 0.0..6.2).prop_map(|(far, angle): (f64, f64)| [far * angle.cos(), far * angle.sin()]),
        [-0.3..0.3, -0.3..0.3],
    ];
    let angle = prop_oneof![Just(2.0 * PI), Just(-PI), Just(0.5 * PI), -6.2..-0.2, 0.2..6.2];
    let rise = prop_oneof![2 => Just(0.0), 1 => distance(), 1 => -1.0..1.0];
    let from = prop_oneof![Just(0.0), Just(0.5 * PI), 0.0..6.2];
    let radius = (prop::sample::select(&RADII[..]), distance()).prop_map(|(radius, by)| radius * (1.0 + by));
    (radius, near, from, angle, rise).prop_map(|(radius, off, from, angle, rise)| Case {
        radius,
        off,
        from,
        angle,
        rise,
    })
}

fn check(number: usize, case: &Case, tolerance: f64) -> TestCaseResult {
    // The form tool has a face that ends level at an edge, where almost level helices have gaps shorter than the
    // tolerance.
    prop_assume!(number != 11 || case.rise == 0.0 || case.rise.abs() > 1e-2);
    let (name, tool, _) = &tools()[number];
    let [closed, _] = agree(name, tool, &case.path(), &Case::grid(21), tolerance)?;
    let own = &closed.statistics;
    // Some are in walls where quarters of a circle meet.
    prop_assert!(tolerance < 1e-7 || own.repaired <= 8, "{name}: {own:?}");
    // Concave tori may be left to charts.
    prop_assert!(number > 4 || own.boxes == 0 || own.repaired > 0, "{name}: {own:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::translations::cases(), ..ProptestConfig::default() })]

    #[test]
    fn as_by_charts(number in 0_usize..13, case in cases(), tolerance in prop::sample::select(&[1e-3, 1e-5, TOLERANCE, TOLERANCE, 1e-8, 2e-9][..])) {
        check(number, &case, tolerance)?;
    }
}

/// A line that a ball touches at the start only, where rounding leaves gaps of less than the tolerance.
#[test]
fn touched_at_the_start() {
    let case = Case {
        radius: 2.4,
        off: [0.0; 2],
        from: 0.0,
        angle: -PI,
        rise: 0.0,
    };
    check(9, &case, 2e-9).expect("as by charts");
}

/// The lowest height above the tip at a distance from the axis.
type Bottom = fn(f64) -> f64;

/// Tools of radius 3, with their bottoms.
fn bottoms() -> [(&'static str, Tool, Bottom); 3] {
    fn round(radius: f64, out: f64) -> f64 {
        radius - ((radius - out) * (radius + out)).max(0.0).sqrt()
    }
    [
        ("flat", Tool::flat(3.0, 10.0).expect("a tool"), |_| 0.0),
        ("ball", Tool::ball(3.0, 10.0).expect("a tool"), |out| round(3.0, out)),
        ("bull", Tool::bull(3.0, 0.8, 10.0).expect("a tool"), |out| {
            round(0.8, (out - 2.2).max(0.0))
        }),
    ]
}

/// The lowest ends of lines about the centre of an arc of the tool's radius, against samples in time: lines that the
/// tool does not reach for certain have none.
#[test]
fn as_by_samples() {
    const SAMPLES: u32 = 20_000;
    for (name, tool, bottom) in bottoms() {
        for (angle, rise, by) in [
            (2.0 * PI, 0.0, 0.0),
            (-1.9, 0.0, 1e-15),
            (1.3, 0.0, -1e-9),
            (2.5, 0.4, 0.0),
            (-2.0 * PI, -0.7, 1e-12),
        ] {
            let case = Case {
                radius: 3.0 + by,
                off: [0.0; 2],
                from: 0.4,
                angle,
                rise,
            };
            // Lines at 1.4e-3 and more from the centre.
            let grid = Grid::new([-8e-3, -8e-3], [8e-3, 8e-3], [8, 8]).expect("a grid");
            let swept = sweep(&tool, &case.path(), &grid, &Options::new(TOLERANCE), &()).expect("a sweep");
            let statistics = &swept.statistics;
            assert!(
                statistics.unresolved.is_empty() && statistics.repaired == 0,
                "{name}: {statistics:?}"
            );
            for index in 0..grid.len() {
                let (i, j) = grid.place(index);
                let samples = (0..=SAMPLES).map(|k| {
                    let share = f64::from(k) / f64::from(SAMPLES);
                    let turned = case.from + angle * share;
                    let [x, y] = [
                        case.radius * turned.cos() - grid.x(i),
                        case.radius * turned.sin() - grid.y(j),
                    ];
                    (x.hypot(y), 0.3 + rise * share)
                });
                let within = |radius: f64| {
                    let heights = samples.clone().filter(|(out, _)| *out <= radius);
                    heights.map(|(out, z)| z + bottom(out)).fold(f64::INFINITY, f64::min)
                };
                let [surely, perhaps] = [within(3.0 - 1e-7), within(3.0 + 1e-7)];
                let lowest = swept
                    .volume
                    .at(index)
                    .first()
                    .map_or(f64::INFINITY, |first| first.lower.z);
                // From one sample to the next, and where a bottom is steep.
                let near = 1e-3;
                assert!(
                    lowest <= surely + near && lowest >= perhaps - near,
                    "{name}, {case:?}, {:?}: {lowest}, {surely} {perhaps}",
                    (i, j)
                );
            }
        }
    }
}

/// Near material, only what may cut it is computed.
#[test]
fn a_bored_hole_takes_closed_forms() {
    for (name, tool, _) in bottoms() {
        for rise in [0.0, -0.9] {
            let case = Case {
                radius: 3.0,
                off: [0.0; 2],
                from: 0.0,
                angle: 2.0 * PI,
                rise,
            };
            let grid = Case::grid(31);
            let block = Stock::Block {
                min: [-6.2, -6.2, -4.0],
                max: [6.2, 6.2, 1.0],
            }
            .dexels(&grid)
            .expect("a block");
            let path = case.path();
            let part =
                simulate(block.clone(), &[Cut::new(&tool, &path)], &Options::new(TOLERANCE), &()).expect("a part");
            assert!(
                part.statistics.unresolved.is_empty() && part.statistics.boxes == 0,
                "{name}: {:?}",
                part.statistics
            );
            let options = Options::new(TOLERANCE).method(Method::General);
            let whole = sweep(&tool, &path, &grid, &options, &()).expect("a sweep");
            let mut expected = block;
            expected.remove_all(&whole.volume, TOLERANCE).expect("the same grid");
            for index in 0..grid.len() {
                let [a, b] = [&part.remaining, &expected].map(|dexels| dexels.at(index).to_vec());
                // At the centre of a helix, heights change with the direction of the displacement of a line.
                let central = rise != 0.0 && grid.place(index) == (15, 15);
                assert!(central || same(&a, &b, TOLERANCE), "{name}: {a:?} {b:?}");
            }
        }
    }
}
