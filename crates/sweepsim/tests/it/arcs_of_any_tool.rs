//! Level arcs and helices with which a tool of any shape turns, which charts solve: against the roots on each line,
//! charts alone, which also solve joints and straight moves, and samples in time.

use crate::arcs_in_closed_form::{Arc, agree_cheaply, assert_same_bytes, grid, small};
use crate::displaced::agree_with;
use crate::grazing_curves::tools;
use crate::translations::{TOLERANCE, UP, agree, cases};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use sweepsim::{Method, Options, SweepError, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::{Move, Path, Pose, TipArc};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

/// A chain of straight moves and of arcs with which the tool turns.
struct Chain {
    poses: Vec<Pose>,
    moves: Vec<Move>,
    tip: [f64; 3],
    /// How far the tool has turned about its axis.
    stands: f64,
    /// In which axes the path is: the tool stands along the last.
    axes: [[f64; 3]; 3],
}

const WORLD: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], UP];

impl Chain {
    fn new(tip: [f64; 3], stands: f64, axes: [[f64; 3]; 3]) -> Self {
        let mut chain = Self {
            poses: Vec::new(),
            moves: Vec::new(),
            tip,
            stands,
            axes,
        };
        chain.pose();
        chain
    }

    fn seen(&self, v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| (0..3).map(|axis| v[axis] * self.axes[axis][k]).sum())
    }

    fn pose(&mut self) {
        let side = [self.stands.cos(), self.stands.sin(), 0.0];
        let pose = Pose::with_side(self.seen(self.tip), self.axes[2], self.seen(side));
        self.poses.push(pose.expect("a pose"));
    }

    fn straight(mut self, way: [f64; 3]) -> Self {
        self.tip = std::array::from_fn(|k| self.tip[k] + way[k]);
        self.pose();
        self.moves.push(Move::default());
        self
    }

    fn arc(mut self, [radius, from, angle, rise]: Arc) -> Self {
        let centre = [
            self.tip[0] - radius * from.cos(),
            self.tip[1] - radius * from.sin(),
            self.tip[2],
        ];
        let to = from + angle;
        self.tip = [
            centre[0] + radius * to.cos(),
            centre[1] + radius * to.sin(),
            centre[2] + rise,
        ];
        self.stands += angle;
        self.pose();
        let arc = TipArc::new(self.seen(centre), self.axes[2], angle).expect("an arc");
        self.moves.push(Move::arc(arc));
        self
    }

    fn path(self) -> Path {
        Path::with_moves(self.poses, self.moves).expect("a path")
    }
}

fn turning(start: [f64; 3], stands: f64, arcs: &[Arc], way: [f64; 3]) -> Path {
    let start = Chain::new(start, stands, WORLD);
    arcs.iter()
        .fold(start, |chain, arc| chain.arc(*arc).straight(way))
        .path()
}

/// Against the roots on each line.
fn by_lines(number: usize, path: &Path) -> TestCaseResult {
    let (name, tool) = &tools()[number];
    agree_with(Method::Lines, name, tool, path, (&grid([13, 11]), TOLERANCE)).map(|_| ())
}

fn check(number: usize, path: &Path, grid: &Grid) -> TestCaseResult {
    let (name, tool) = &tools()[number];
    agree_cheaply(name, tool, path, grid)
}

/// Less than half a turn: the poses do not tell of more.
fn arcs(rise: f64) -> impl Strategy<Value = Vec<Arc>> {
    let one = [0.3..6.0_f64, -PI..PI, -PI..PI, -1.0..1.0_f64].prop_filter("short", |arc| arc[2].abs() > 0.1);
    collection::vec(
        one.prop_map(move |[radius, from, angle, up]| [radius, from, angle, rise * up]),
        1..3,
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases() / 4, ..ProptestConfig::default() })]

    /// Level arcs, wider and narrower than the tool, in both directions.
    #[test]
    fn level(number in 0_usize..3, start in small(3.0), stands in -PI..PI, way in small(2.0), arcs in arcs(0.0)) {
        by_lines(number, &turning(start, stands, &arcs, way))?;
    }

    /// Helices.
    #[test]
    fn helices(number in 0_usize..3, start in small(3.0), stands in -PI..PI, way in small(2.0), arcs in arcs(1.5)) {
        by_lines(number, &turning(start, stands, &arcs, way))?;
    }

    /// Many lines over each chart.
    #[test]
    fn many_lines(number in 0_usize..3, start in small(3.0), stands in -PI..PI, way in small(2.0), arcs in arcs(0.7), narrow in any::<bool>()) {
        let cells = if narrow { [19, 307] } else { [91, 89] };
        check(number, &turning(start, stands, &arcs, way), &grid(cells))?;
    }

    /// Dexels along any axis, with the tool along them.
    #[test]
    fn along_all_axes(number in 0_usize..3, start in small(3.0), stands in -PI..PI, way in small(2.0), arcs in arcs(0.7), first in 0..3_usize) {
        let axes = [0, 1, 2].map(|k| WORLD[(first + k) % 3]);
        let path = arcs.iter().fold(Chain::new(start, stands, axes), |chain, arc| chain.arc(*arc).straight(way)).path();
        let frame = Frame::new([0.0; 3], axes[0], axes[1]).expect("a frame");
        check(number, &path, &grid([23, 21]).in_frame(frame))?;
    }

    /// About dexel lines, about the tool's own tip or a line through it, along the grid, with full turns. The bud turns
    /// about lines beside them: its rational normals are too inexact for a line within a billionth of a millimetre of a
    /// point of its surface that does not move.
    #[test]
    fn degenerate(number in 0_usize..3, radius in 0..4_usize, stands in 0..4_i32, parts in 3..5_i32, left in any::<bool>(), place in [0..3_i32, 0..3_i32], rise in 0..3_usize) {
        let lines = grid([23, 21]);
        let side = if left { 1.0 } else { -1.0 };
        let radius = [1e-9, 1.0, 0.5, 3.0][radius];
        let beside = if number == 1 { 0.01 } else { 0.0 };
        let centre = [lines.x(11) + f64::from(place[0]) + beside, lines.y(10) + f64::from(place[1])];
        let start = [centre[0] + radius, centre[1], 0.4];
        let angle = side * TAU / f64::from(parts);
        let rise = [0.0, 1e-7, 0.8][rise];
        let mut chain = Chain::new(start, f64::from(stands) * FRAC_PI_2, WORLD);
        for n in 0..parts {
            chain = chain.arc([radius, f64::from(n) * angle, angle, rise]);
        }
        let (name, tool) = &tools()[number];
        agree(name, tool, &chain.path(), &lines, TOLERANCE)?;
    }

    /// Coarse and fine, near the origin and far from it, and at the least tolerance.
    #[test]
    fn all_tolerances(number in 0_usize..3, start in small(2.0), stands in -PI..PI, arcs in arcs(0.6), digits in 3..9_i32, far in 0..3_usize) {
        let away = [0.0, 50.0, 1234.5][far];
        let lines = Grid::new([away - 9.97, -away - 10.03], [away + 10.06, -away + 9.94], [19, 17]).expect("a grid");
        let path = turning([away + start[0], -away + start[1], start[2]], stands, &arcs, [0.4, -0.3, 0.2]);
        let (name, tool) = &tools()[number];
        let least = match sweep(tool, &path, &lines, &Options::new(1e-300), &()) {
            Err(SweepError::TooFine { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        agree(name, tool, &path, &lines, least.max(10_f64.powi(-digits)))?;
    }

    /// Radii from a hundredth of the tool's to a hundred times as much.
    #[test]
    fn all_radii(number in 0_usize..3, logarithm in -4.6..5.7_f64, start in small(2.0), stands in -PI..PI, from in -PI..PI, length in 1.0..5.0_f64, rise in -0.5..0.5_f64, left in any::<bool>()) {
        let radius = logarithm.exp();
        let angle = (length / radius).min(3.1) * if left { 1.0 } else { -1.0 };
        check(number, &turning(start, stands, &[[radius, from, angle, rise]], [0.5, 0.4, 0.0]), &grid([23, 21]))?;
    }

    /// Tools that turn a little more or less than the arc, or the other way.
    #[test]
    fn almost_with_the_arc(number in 0_usize..3, start in small(2.0), stands in -PI..PI, arc in [0.5..5.0_f64, -PI..PI, 0.3..2.5_f64, -0.5..0.5_f64], digits in 1..16_i32, opposite in any::<bool>()) {
        let [radius, from, angle, rise] = arc;
        let mut chain = Chain::new(start, stands, WORLD);
        chain.stands += if opposite { -2.0 * angle } else { 10_f64.powi(-digits) };
        chain = chain.arc([radius, from, angle, rise]);
        let (name, tool) = &tools()[number];
        let mut path = chain.straight([0.3, 0.2, 0.0]);
        // The first pose was made before.
        path.poses[0] = Pose::with_side(start, UP, [stands.cos(), stands.sin(), 0.0]).expect("a pose");
        agree(name, tool, &path.path(), &grid([17, 15]), TOLERANCE)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// A block covers the lines that it covers at closely spaced times, at the same heights.
    #[test]
    fn blocks_are_where_samples_are(start in small(3.0), stands in -PI..PI, arc in [0.1..6.0_f64, -PI..PI, 0.3..3.1_f64, -2.0..2.0_f64], left in any::<bool>()) {
        const SAMPLES: usize = 4000;
        const HEIGHT: f64 = 3.0;
        let [radius, from, angle, rise] = arc;
        let angle = if left { angle } else { -angle };
        let (lines, path) = (grid([23, 21]), Chain::new(start, stands, WORLD).arc([radius, from, angle, rise]).path());
        let (_, tool) = &tools()[2];
        let found = sweep(tool, &path, &lines, &Options::new(TOLERANCE), &()).expect("a sweep");
        prop_assert!(found.statistics.unresolved.is_empty(), "{:?}", found.statistics);
        for index in 0..lines.len() {
            let (i, j) = lines.place(index);
            // How far inside the block the line is, and how high the tip.
            let seen = |share: f64| {
                let at = from + angle * share;
                let tip = [start[0] + radius * (at.cos() - from.cos()), start[1] + radius * (at.sin() - from.sin())];
                let (s, c) = (stands + angle * share).sin_cos();
                let [x, y] = [lines.x(i) - tip[0], lines.y(j) - tip[1]];
                let [x, y] = [c * x + s * y, c * y - s * x];
                ([x + 1.5, 1.0 - x, y + 0.5, 1.0 - y].into_iter().fold(f64::INFINITY, f64::min), start[2] + rise * share)
            };
            let samples: Vec<_> = (0..=SAMPLES).map(|k| seen(k as f64 / SAMPLES as f64)).collect();
            let deepest = samples.iter().map(|(depth, _)| *depth).fold(f64::NEG_INFINITY, f64::max);
            let own = found.volume.at(index).to_vec();
            // Sides of the block pass over a line by less than this from one sample to the next.
            let step = (radius + 2.0) * angle.abs() / SAMPLES as f64;
            if deepest.abs() < step {
                continue;
            }
            prop_assert_eq!(own.len(), usize::from(deepest > 0.0), "{:?} {}", (i, j), deepest);
            let inside = || samples.iter().filter(|(depth, _)| *depth > 0.0).map(|(_, z)| *z);
            if let [only] = own[..] {
                let (low, high) = (inside().fold(f64::INFINITY, f64::min), inside().fold(f64::NEG_INFINITY, f64::max) + HEIGHT);
                let error = 2.0 * rise.abs() / SAMPLES as f64 + 2.0 * TOLERANCE;
                prop_assert!((only.lower.z - low).abs() < error && (only.upper.z - high).abs() < error, "{:?}: {only:?} {low} {high}", (i, j));
            }
        }
    }
}

/// The result does not depend on which arcs were made before on the same thread.
#[test]
fn the_same_bytes_whatever_came_before() {
    let (_, tool) = &tools()[1];
    let arcs: Vec<Arc> = (0..9)
        .map(|k| [2.0 + 1e-7 * f64::from(k), 0.6 * f64::from(k), 2.5, 0.1])
        .collect();
    let path = turning([1.1, 0.3, 0.2], -0.7, &arcs, [0.5, 0.2, 0.0]);
    assert_same_bytes(tool, &path);
}
