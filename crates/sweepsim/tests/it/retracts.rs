//! Moves along the tool's own axis: all of its wall slides along itself.

use crate::translations::{TOLERANCE, UP, cases, path, tools};
use std::sync::LazyLock;
use sweepsim::nalgebra::Vector3;
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::{Grid, Interval};
use sweepsim_motion::{Apt, Path, Pose, Tool};
use sweepsim_props::test_runner::{TestCaseError, TestCaseResult};
use sweepsim_props::*;

const METHODS: [Method; 5] = [
    Method::General,
    Method::Mixed,
    Method::Planes,
    Method::Lines,
    Method::Surface,
];

/// The direction in which tips are displaced (`WAYS` in `tolerances.rs`), where the tool's axis isn't almost across it.
const DISPLACED: [f64; 3] = [0.569_840_290_998, 0.331_172_830_617, 0.752_022_194_331];

/// A move along the tool's own axis meets hardly any line: none that it passes by is left open.
#[test]
fn retracts_open_no_line_beside_the_tool() {
    let grid = Grid::new([-6.546, -6.546], [97.143, 94.023], [300, 300]).expect("a grid");
    let tool = Tool::ball(3.0, 37.5).expect("a ball end");
    for k in 0..60 {
        let [x, y] = [15.5 + f64::from(k % 8) / 3.0, 1.5 + 2.0 * f64::from(k) / 3.0];
        let moves = path(&[[x, y, -19.506], [x, y, 1.0]], UP);
        let done = sweep(&tool, &moves, &grid, &Options::new(TOLERANCE), &()).expect("a sweep");
        assert!(
            done.statistics.unresolved.is_empty() && done.statistics.repaired == 0,
            "{k}"
        );
    }
}

/// Along a tilted axis the wall slides along itself, and the displacement of tips alone decides where `g` vanishes on
/// it: at a ruling, all of which passes beside the lines next to it at all times. They cost no more than others.
#[test]
fn lines_beside_a_ruling_that_slides_along_itself() {
    let axis = [0.3, 0.2, 1.0];
    let tip = [15.5, 37.0 / 3.0 - 1.0 / 6.0, -19.506];
    let way = 19.0 / Vector3::from(axis).norm();
    let moves = path(&[tip, [0, 1, 2].map(|k| tip[k] + way * axis[k])], axis);
    // A line within 1e-6 of the ruling, and the direction across it. Lines within 2e-5 may be solved again up to five
    // times, for rounding decides what they meet.
    let (near, across) = ([18.512_170_6, 17.758_181_7], [-0.5547, 0.832_05]);
    let drill = Apt {
        d: 6.0,
        r: 0.0,
        e: 3.0,
        f: 0.0,
        a: 31.0,
        b: 0.0,
        h: 10.0,
    };
    let tools = [
        Tool::ball(3.0, 10.0).expect("a ball end"),
        Tool::bull(3.0, 0.8, 10.0).expect("a bull nose"),
        Tool::apt(&drill).expect("a drill").0,
    ];
    for tool in &tools {
        for method in &METHODS[..4] {
            let boxes = |off: f64| {
                let [x, y] = [0, 1].map(|k| near[k] + off * across[k]);
                let grid = Grid::new([x - 0.1, y - 0.1], [x + 0.1, y + 0.1], [1, 1]).expect("a grid");
                let options = Options::new(TOLERANCE).method(*method);
                let done = sweep(tool, &moves, &grid, &options, &()).expect("a sweep");
                assert!(done.statistics.unresolved.is_empty(), "{method}, {off}");
                done.statistics.boxes
            };
            let beside = boxes(0.11).max(boxes(-0.11)).max(40);
            for off in [1e-2, 1e-3, 3e-4, 1e-4, 5e-5, 2e-5] {
                for off in [off, -off] {
                    let own = boxes(off);
                    assert!(own <= 3 * beside, "{method}, {off}: {own} {beside}");
                }
            }
        }
    }
}

static TOOLS: LazyLock<Vec<(&str, Tool, bool)>> = LazyLock::new(tools);

/// How a line passes by a ruling.
#[derive(Clone, Debug)]
struct Beside {
    /// How far up the wall and the way, as a fraction of both.
    height: f64,
    /// The distance from the ruling, in parts of a unit.
    off: f64,
    /// Which of the two rulings.
    side: f64,
}

fn beside() -> impl Strategy<Value = Beside> {
    let off = (prop_oneof![-13.0..-2.0, -7.0..-4.0], any::<bool>()).prop_map(|(power, left): (f64, bool)| {
        if left {
            -(10.0_f64.powf(power))
        } else {
            10.0_f64.powf(power)
        }
    });
    let side = any::<bool>().prop_map(|left| if left { -1.0 } else { 1.0 });
    (-0.2..1.2, off, side).prop_map(|(height, off, side)| Beside { height, off, side })
}

/// A move of a tool along its own tilted axis, or almost.
#[derive(Clone, Debug)]
struct Retract {
    /// Among all tools.
    number: usize,
    axis: Vector3<f64>,
    tip: Vector3<f64>,
    way: f64,
    down: bool,
    tolerance: f64,
    /// The radius of the wall whose ruling the lines pass by: often the tool's.
    radius: f64,
    /// How much the way leaves the axis, and the axis turns: the powers of ten and the directions.
    leaves: Option<[f64; 2]>,
    turns: Option<[f64; 2]>,
}

fn retract() -> impl Strategy<Value = Retract> {
    let tilt = [-1.0..1.0, -1.0..1.0];
    let rise = prop_oneof![Just(0.01), Just(0.3), 0.0..1.0_f64];
    let axis = (tilt, rise)
        .prop_map(|([x, y], z)| Vector3::new(x, y, z))
        .prop_filter("tilted", |axis| axis.norm() > 0.1 && axis.xy().norm() > 0.01)
        .prop_map(|axis| axis.normalize());
    let tip = [-20.0..20.0, -20.0..20.0, -20.0..5.0].prop_map(Vector3::from);
    let radius = prop_oneof![Just(3.0), Just(2.5), 2.0..3.1];
    let aside = || (-16.0..-1.0, 0.0..6.2).prop_map(|(power, angle)| [power, angle]);
    (
        0..13_usize,
        axis,
        (tip, 13.0..40.0, any::<bool>()),
        -8.0..-4.0,
        radius,
        [aside(), aside()],
    )
        .prop_map(
            |(number, axis, (tip, way, down), power, radius, [leaves, turns])| Retract {
                number,
                axis,
                tip,
                way,
                down,
                tolerance: 10.0_f64.powf(power),
                radius,
                leaves: Some(leaves),
                turns: Some(turns),
            },
        )
}

impl Retract {
    fn aside(&self, aside: Option<[f64; 2]>) -> Vector3<f64> {
        let Some([power, angle]) = aside else {
            return Vector3::zeros();
        };
        let across = self.axis.cross(&Vector3::from(DISPLACED)).normalize();
        (across * angle.cos() + self.axis.cross(&across) * angle.sin()) * 10.0_f64.powf(power)
    }

    fn path(&self) -> Path {
        let ahead = self.axis + self.aside(self.leaves);
        let pose = |tip: Vector3<f64>, axis: Vector3<f64>| Pose::new(tip.into(), axis.into()).expect("a pose");
        let mut poses = vec![
            pose(self.tip, self.axis),
            pose(self.tip + ahead * self.way, self.axis + self.aside(self.turns)),
        ];
        if self.down {
            poses.reverse();
        }
        Path::new(poses).expect("a path")
    }

    /// The turn in place first, and then straight along the axis.
    fn turned_before(&self) -> Path {
        let axis = (self.axis + self.aside(self.turns)).normalize();
        let pose = |tip: Vector3<f64>, axis: Vector3<f64>| Pose::new(tip.into(), axis.into()).expect("a pose");
        let end = self.tip + axis * self.way;
        Path::new(vec![pose(self.tip, self.axis), pose(self.tip, axis), pose(end, axis)]).expect("a path")
    }

    /// Where a line passes by a ruling.
    fn place(&self, Beside { height, off, side }: &Beside) -> Vector3<f64> {
        let slide = self.aside(self.leaves) * self.way + Vector3::from(DISPLACED) * (0.01 * self.tolerance / 61.0);
        let out = self.axis.cross(&slide).normalize();
        let across = Vector3::new(-self.axis.y, self.axis.x, 0.0).normalize();
        self.tip + out * (side * self.radius) + self.axis * (height * self.way) + across * *off
    }

    /// As [`swept_along`](Self::swept_along) its own path.
    fn swept(&self, at: &Vector3<f64>) -> Result<Vec<(Method, Vec<Interval>)>, TestCaseError> {
        self.swept_along(&self.path(), at)
    }

    /// The intervals of a line by all methods, each of which settles it.
    fn swept_along(&self, path: &Path, at: &Vector3<f64>) -> Result<Vec<(Method, Vec<Interval>)>, TestCaseError> {
        let (name, tool, _) = &TOOLS[self.number];
        let grid = Grid::new([at.x - 0.1, at.y - 0.1], [at.x + 0.1, at.y + 0.1], [1, 1]).expect("a grid");
        let of = |method| {
            let options = Options::new(self.tolerance).method(method);
            let done = sweep(tool, path, &grid, &options, &()).expect("a sweep");
            let unresolved = &done.statistics.unresolved;
            prop_assert!(unresolved.is_empty(), "{name}, {method}: {unresolved:?}");
            Ok((method, done.volume.at(0).to_vec()))
        };
        METHODS.into_iter().map(of).collect()
    }

    /// The radius of what is cut at a height above the first tip, as long as the tool's top is above it, and how
    /// accurate that is.
    fn width(&self, along: f64) -> (f64, f64) {
        let (name, tool, _) = &TOOLS[self.number];
        let corner: f64 = match *name {
            "ball" => 3.0,
            "flat" => 0.0,
            "bull" => 0.8,
            _ => return (tool.radius_below(along), 1e-3),
        };
        let inside = (corner - along).max(0.0);
        let width = 3.0 - corner + (corner * corner - inside * inside).sqrt();
        (width, 0.5 * self.tolerance)
    }

    /// Whether a point has been inside the tool.
    fn cuts(&self, point: &Vector3<f64>) -> bool {
        let along = (point - self.tip).dot(&self.axis);
        let off = (point - self.tip - along * self.axis).norm();
        (0.0..self.way).contains(&along) && off <= self.width(along).0
    }

    /// Compares the intervals of a line with the tool's profile.
    fn compare(&self, at: &Vector3<f64>, line: &[Interval]) -> TestCaseResult {
        let on = |z: f64| Vector3::new(at.x, at.y, z);
        let is_below_top = |z: f64| (on(z) - self.tip).dot(&self.axis) < self.way - 1.0;
        let ends = line.iter().flat_map(|interval| [interval.lower.z, interval.upper.z]);
        for end in ends.clone().filter(|end| is_below_top(*end)) {
            let margin = self.width(0.0).1;
            let radial = (on(end) - self.tip).cross(&self.axis).cross(&self.axis).normalize();
            let near = [Vector3::x(), Vector3::y(), Vector3::z(), self.axis, radial].map(|way| way * margin);
            let seen = near
                .map(|by| [self.cuts(&(on(end) + by)), self.cuts(&(on(end) - by))])
                .concat();
            prop_assert!(seen.contains(&true) && seen.contains(&false), "{end}");
        }
        for k in 0..200 {
            let z = self.tip.z - 5.0 + (self.way + 10.0) * f64::from(k) / 200.0;
            if is_below_top(z) && ends.clone().all(|end| (end - z).abs() > 1e-2) {
                let inside = line
                    .iter()
                    .any(|interval| (interval.lower.z..interval.upper.z).contains(&z));
                prop_assert_eq!(inside, self.cuts(&on(z)), "{}", z);
            }
        }
        Ok(())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Lines within roundings of the ruling on which the displacement of tips lets `g` vanish: each is settled, by all
    /// methods, and ends where the tool has been.
    #[test]
    fn lines_on_a_ruling_that_slides_along_itself(retract in retract(), lines in collection::vec(beside(), 6)) {
        let retract = Retract { leaves: None, turns: None, ..retract };
        for line in &lines {
            let at = retract.place(line);
            for (method, swept) in retract.swept(&at)? {
                // A hollow end doesn't cut what is inside.
                if TOOLS[retract.number].0 != "hollow" {
                    retract.compare(&at, &swept).map_err(|error| TestCaseError::fail(format!("{method}: {error}")))?;
                }
            }
        }
    }

    /// The same for moves that leave the axis, or turn, by little: a turn by less than 1e-13 counts as none.
    #[test]
    fn moves_almost_along_the_axis_are_settled(retract in retract(), turning in any::<bool>(), lines in collection::vec(beside(), 6)) {
        let retract = Retract { turns: retract.turns.filter(|_| turning), ..retract };
        let moves_by = (retract.aside(retract.leaves).norm() + retract.aside(retract.turns).norm()) * 50.0;
        for line in &lines {
            let at = retract.place(line);
            for (method, swept) in retract.swept(&at)? {
                if TOOLS[retract.number].0 != "hollow" && moves_by < 0.1 * retract.tolerance {
                    retract.compare(&at, &swept).map_err(|error| TestCaseError::fail(format!("{method}: {error}")))?;
                }
            }
        }
    }

    /// A turn in place, however small, before a retract along the axis: a neck and a ball, and any tool.
    #[test]
    fn retracts_after_a_turn_are_settled(retract in retract(), is_lollipop in any::<bool>(), lines in collection::vec(beside(), 6)) {
        let retract = Retract { leaves: None, ..retract };
        let retract = if is_lollipop { Retract { number: 9, radius: 1.1, ..retract } } else { retract };
        for line in &lines {
            let at = retract.place(line);
            retract.swept_along(&retract.turned_before(), &at)?;
        }
    }
}
