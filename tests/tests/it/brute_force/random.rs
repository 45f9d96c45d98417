//! Random tools, outlines of splines among them, along random motions of every kind: all methods agree, and
//! transformations that must not change the volume do not.
//!
//! `cargo xtask brute-force random` draws many more.

use crate::brute_force::cases::{Cutter, axis, pose};
use crate::brute_force::drawn_tools::{spline_tools, tools};
use crate::brute_force::judge::{Tally, same_sweeps, swept_along};
use crate::brute_force::sample::times;
use crate::brute_force::splines::Splines;
use nalgebra::{Matrix3, Vector3};
use std::fmt;
use sweepsim::{Method, Sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Move, Path, Pose, RotaryTable, TableTurns, TipArc, TipCourse, Tool, Turning};
use sweepsim_props::test_runner::{Config, RngSeed, TestCaseError, TestRunner};
use sweepsim_props::*;
use sweepsim_tests::oracle::Motion;

/// A motion of one kind.
#[derive(Clone, Debug)]
enum Drawn {
    Moves(Vec<Pose>, Vec<Move>),
    Splines(Splines),
}

impl Drawn {
    fn path(&self) -> Path {
        match self {
            Self::Moves(poses, moves) => Path::with_moves(poses.clone(), moves.clone()).expect("a path"),
            Self::Splines(splines) => splines.path(),
        }
    }

    fn motion(&self) -> Motion {
        match self {
            Self::Moves(poses, moves) => Motion::of_moves(poses, moves),
            Self::Splines(splines) => splines.motion(),
        }
    }

    fn reversed(&self) -> Self {
        match self {
            Self::Moves(poses, moves) => Self::Moves(
                poses.iter().rev().copied().collect(),
                moves.iter().rev().map(Move::reversed).collect(),
            ),
            Self::Splines(splines) => Self::Splines(splines.reversed()),
        }
    }

    /// With one move more, where `part` of the first (of the splines' range) has passed.
    fn cut(&self, part: f64) -> Self {
        let (poses, moves) = match self {
            Self::Splines(splines) => return Self::Splines(splines.cut(part)),
            Self::Moves(poses, moves) => (poses, moves),
        };
        let middle = self.motion().at(0, part);
        let turning = match moves[0].turning {
            Turning::Rotary { table, from, to } => {
                let at = [0, 1].map(|k| from[k] + (to[k] - from[k]) * part);
                [(from, at), (at, to)].map(|(from, to)| Turning::Rotary { table, from, to })
            }
            other => [other; 2],
        };
        let course = [[0.0, part], [part, 1.0]].map(|times| moves[0].course.during(times));
        let axis = match turning[0] {
            Turning::Rotary { table, to, .. } => table.axis(to),
            _ => middle.axis.into(),
        };
        let mut poses = poses.clone();
        poses.insert(1, pose(middle.tip.into(), axis));
        let halves = [0, 1].map(|k| Move {
            course: course[k],
            turning: turning[k],
        });
        Self::Moves(poses, halves.into_iter().chain(moves[1..].iter().copied()).collect())
    }

    /// The path shifted.
    fn shifted(&self, by: Vector3<f64>) -> Path {
        match self {
            Self::Splines(splines) => Path::along(
                splines
                    .solved()
                    .moved(&Matrix3::identity(), by)
                    .expect("a rigid motion"),
            ),
            Self::Moves(poses, moves) => {
                let place = |p: &Pose| pose((Vector3::from(p.tip()) + by).into(), p.axis());
                let shift = |way: &Move| Move {
                    course: way.course.moved(&Matrix3::identity(), by),
                    turning: way.turning,
                };
                Path::with_moves(poses.iter().map(place).collect(), moves.iter().map(shift).collect()).expect("a path")
            }
        }
    }
}

/// A tool, a motion and a grid, and the parameters of the test.
#[derive(Clone)]
struct Case {
    cutter: Cutter,
    drawn: Drawn,
    grid: Grid,
    part: f64,
    shift: [f64; 3],
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (grid, name) = (&self.grid, &self.cutter.name);
        write!(
            f,
            "{name}\n{:#?}\n{grid:?}, {}, {:?}",
            self.drawn, self.part, self.shift
        )
    }
}

fn place() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-2.5..2.5)
}

fn moves() -> impl Strategy<Value = Drawn> {
    let places = collection::vec((place(), axis(0.0..60.0)), 2..4);
    let even = places.prop_map(|places| {
        let poses: Vec<Pose> = places.into_iter().map(|(tip, axis)| pose(tip, axis)).collect();
        let moves = vec![Move::straight(Turning::Even); poses.len() - 1];
        Drawn::Moves(poses, moves)
    });
    let angles = prop::array::uniform2((-50.0..50.0, -120.0..120.0));
    let arc = || (place(), prop_oneof![Just([0.0, 0.0, 1.0]), axis(0.0..90.0)], -5.0..5.0);
    let rotary = (any::<bool>(), place(), place(), angles, prop::option::of((arc(), 0..3))).prop_map(
        |(tilts, from, to, angles, arc)| {
            let table = if tilts { RotaryTable::Ac } else { RotaryTable::Bc };
            let [a, b] = angles.map(|(tilt, round): (f64, f64)| [tilt, round]);
            let poses = vec![pose(from, table.axis(a)), pose(to, table.axis(b))];
            let turning = Turning::Rotary { table, from: a, to: b };
            let course = arc.map_or(TipCourse::Straight, |((centre, normal, angle), kind)| {
                let arc = TipArc::new(centre, normal, angle).expect("an arc");
                let table = TableTurns::new(arc);
                match kind {
                    0 => TipCourse::Arc(arc),
                    1 => TipCourse::Carried(table),
                    _ => {
                        TipCourse::Carried(table.on(TipArc::new(from, [1.0, 0.5, -0.3], 0.4 * angle).expect("an arc")))
                    }
                }
            });
            // The difference at the end of an arc takes a different course when reversed.
            let poses = match course {
                TipCourse::Straight | TipCourse::Carried(_) => poses,
                TipCourse::Arc(arc) => vec![poses[0], pose(on(&arc, from), table.axis(b))],
            };
            Drawn::Moves(poses, vec![Move { course, turning }])
        },
    );
    let tilt = || prop_oneof![2 => Just([0.0, 0.0, 1.0]), 1 => axis(0.0..2.0), 2 => axis(0.0..60.0)];
    let round = (place(), tilt(), tilt(), arc(), prop_oneof![Just(0.0), -2.0..2.0]).prop_map(
        |(from, a, b, (centre, normal, angle), rise)| {
            let arc = TipArc::new(centre, normal, angle).expect("an arc");
            let end = Vector3::from(on(&arc, from)) + Vector3::from(arc.normal()) * rise;
            Drawn::Moves(vec![pose(from, a), pose(end.into(), b)], vec![Move::arc(arc)])
        },
    );
    prop_oneof![even, rotary, round]
}

/// Where an arc ends.
fn on(arc: &TipArc, from: [f64; 3]) -> [f64; 3] {
    let turn =
        nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_unchecked(Vector3::from(arc.normal())), arc.angle());
    (Vector3::from(arc.centre()) + turn * (Vector3::from(from) - Vector3::from(arc.centre()))).into()
}

fn splines() -> impl Strategy<Value = Drawn> {
    let turn = prop::array::uniform4(-0.35..0.35).prop_map(|[w, x, y, z]: [f64; 4]| [1.0 + w, x, y, z]);
    let turns = collection::vec(turn, 2..5);
    let tips = collection::vec((place(), 0.6..1.6), 2..5);
    (turns, tips, any::<bool>(), any::<bool>()).prop_map(|(turns, tips, inner_turn, inner_tip)| {
        // With an inner knot the degree is one less.
        let knots = |count: usize, inner: bool, at: f64| {
            let inner = inner && count > 2;
            let degree = count - 1 - usize::from(inner);
            let middle = if inner { vec![at] } else { Vec::new() };
            [vec![0.0; degree + 1], middle, vec![1.0; degree + 1]].concat()
        };
        let (tips, weights): (Vec<[f64; 3]>, Vec<f64>) = tips.into_iter().unzip();
        Drawn::Splines(Splines {
            tip_knots: knots(tips.len(), inner_tip, 0.7),
            turn_knots: knots(turns.len(), inner_turn, 0.4),
            tips,
            weights,
            turns,
        })
    })
}

fn cases() -> impl Strategy<Value = Case> {
    let drawn = prop_oneof![2 => moves(), 1 => splines()];
    let grid = (prop::array::uniform2(-1.0..1.0), 3.0..5.0, 5_usize..8);
    (tools(), drawn, grid, 0.05..0.95, prop::array::uniform3(-9.0..9.0)).prop_map(
        |(cutter, drawn, (middle, half, lines), part, shift)| {
            let half = half * f64::max(1.0, 0.5 * cutter.radius);
            let corner = |sign: f64| middle.map(|c: f64| c + sign * half);
            let grid = Grid::new(corner(-1.0), corner(1.0), [lines, lines]).expect("a grid");
            Case {
                cutter,
                drawn,
                grid,
                part,
                shift,
            }
        },
    )
}

fn for_all<S>(cases: u32, strategy: impl Strategy<Value = S>, check: impl Fn(&S) -> Result<Tally, String>)
where
    S: fmt::Debug,
{
    let config = Config {
        cases: cases * times(),
        rng_seed: RngSeed::Fixed(0xa11),
        failure_persistence: None,
        max_shrink_iters: 60,
        ..Config::default()
    };
    let covered = std::cell::Cell::new(0);
    let checked = |case: S| {
        let tally = check(&case).map_err(TestCaseError::fail)?;
        covered.set(covered.get() + tally.covered);
        Ok(())
    };
    if let Err(error) = TestRunner::new(config).run(&strategy, checked) {
        panic!("{error}");
    }
    assert!(
        covered.get() > 3 * cases as usize,
        "the grids must meet the tools: {}",
        covered.get()
    );
}

impl Case {
    fn swept(&self, path: &Path, grid: &Grid, method: Method) -> Result<Sweep, String> {
        swept_along(&self.cutter.tool, path, grid, method)
    }

    /// The volume along another path, on another grid that has the same lines, is the same.
    fn same(&self, one: &Sweep, other: &Sweep) -> Result<Tally, String> {
        let profile = self.cutter.tool.profile().expect("a solid of revolution");
        same_sweeps(profile, &self.drawn.motion(), &self.grid, one, other)
    }

    fn methods(&self) -> Result<Tally, String> {
        let path = self.drawn.path();
        let one = self.swept(&path, &self.grid, Method::Mixed)?;
        let mut tally = Tally::default();
        for method in [Method::Lines, Method::Planes, Method::Surface] {
            let other = self.swept(&path, &self.grid, method)?;
            tally = self.same(&one, &other).map_err(|error| format!("{method}: {error}"))?;
        }
        Ok(tally)
    }

    fn relations(&self) -> Result<Tally, String> {
        let charts = |path: &Path, grid: &Grid| self.swept(path, grid, Method::Mixed);
        let one = charts(&self.drawn.path(), &self.grid)?;
        let told = |what: &'static str| move |error: String| format!("{what}: {error}");
        let other = charts(&self.drawn.reversed().path(), &self.grid)?;
        self.same(&one, &other).map_err(told("backwards"))?;
        let other = charts(&self.drawn.cut(self.part).path(), &self.grid)?;
        self.same(&one, &other).map_err(told("cut in two"))?;
        let ([x, y, z], grid) = (self.shift, &self.grid);
        let moved = |corner: [f64; 2]| [corner[0] + x, corner[1] + y];
        let there = Grid::new(moved(grid.min()), moved(grid.max()), grid.cells()).expect("a grid");
        let mut other = charts(&self.drawn.shifted(self.shift.into()), &there)?;
        other.volume = back(&one, &other, |i, j| (i, j), -z);
        self.same(&one, &other).map_err(told("moved"))?;
        let fine = Grid::new(grid.min(), grid.max(), grid.cells().map(|n| 3 * n)).expect("a grid");
        let mut other = charts(&self.drawn.path(), &fine)?;
        other.volume = back(&one, &other, |i, j| (3 * i + 1, 3 * j + 1), 0.0);
        self.same(&one, &other).map_err(told("refined"))
    }
}

/// The second volume on the grid of the first, lifted.
fn back(
    one: &Sweep,
    other: &Sweep,
    place: impl Fn(usize, usize) -> (usize, usize),
    lift: f64,
) -> sweepsim_dexel::Dexels {
    let mut volume = one.volume.clone();
    for index in 0..volume.grid().len() {
        let (i, j) = volume.grid().place(index);
        let (k, l) = place(i, j);
        let mut intervals = other.volume.intervals(k, l).to_vec();
        for interval in &mut intervals {
            interval.lower.z += lift;
            interval.upper.z += lift;
        }
        volume.set(index, &intervals).unwrap();
    }
    volume
}

/// A tool sweeps the union of what its parts sweep.
fn union((tools, case): &([Tool; 3], Case)) -> Result<Tally, String> {
    let path = case.drawn.path();
    let [whole, body, neck] = [0, 1, 2].map(|k| swept_along(&tools[k], &path, &case.grid, Method::Mixed));
    let (whole, mut parts) = (whole?, body?);
    parts.volume.unite_all(&neck?.volume).expect("the same grid");
    let profile = tools[0].profile().expect("a solid of revolution");
    same_sweeps(profile, &case.drawn.motion(), &case.grid, &whole, &parts)
}

#[test]
fn the_methods_agree() {
    for_all(3, cases(), Case::methods);
}

#[test]
fn what_must_not_change_the_volume_does_not() {
    for_all(7, cases(), Case::relations);
}

#[test]
fn a_tool_of_two_parts_sweeps_their_union() {
    for_all(5, (spline_tools(), cases()), union);
}

#[test]
#[ignore = "takes many minutes"]
fn many_more() {
    for_all(200, cases(), Case::relations);
    for_all(160, cases(), Case::methods);
    for_all(150, (spline_tools(), cases()), union);
}
