//! Verification against brute force: the tool placed at dense times, on the same lines.
//!
//! All solids here are cylinders, whose intersection with a line at any pose is a formula. For each program two bounds
//! are computed: `sure`, with what must not touch a little smaller and what removes material a little larger, and
//! `possible`, the other way round. What is sure must be found, and what is found must be possible; first times lie
//! between theirs.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use sweepsim::dexel::TriangleSoup;
use sweepsim::motion::{Assembly, BodyKind, Move, Profile, ProfileSegment};
use sweepsim::nalgebra::{Matrix3, Vector3};
use sweepsim::prelude::*;
use sweepsim::verify::{Finding, FindingKind, MoveState, Scene, Target, ToolPath, VerifyOptions, verify};

/// Cylinders and boxes differ by this between the two bounds.
const MARGIN: f64 = 0.03;
/// Times at which the tool is placed in each move.
pub const STEPS: usize = 300;

/// A cylinder about the tool's axis.
#[derive(Clone, Copy)]
pub struct Cylinder {
    pub radius: f64,
    pub z: [f64; 2],
}

impl Cylinder {
    pub fn grown(self, by: f64) -> Self {
        Self {
            radius: self.radius + by,
            z: [self.z[0] - by, self.z[1] + by],
        }
    }

    pub fn tool(self) -> Tool {
        let [low, high] = self.z;
        let line = |rho, zeta| ProfileSegment::Line { to: [rho, zeta] };
        let outline = vec![line(self.radius, low), line(self.radius, high), line(0.0, high)];
        Tool::from_profile(Profile::new([0.0, low], outline).unwrap())
    }

    /// Where the vertical line through `(x, y)` is inside.
    pub fn on_line(self, placed: &Placement, x: f64, y: f64) -> Option<[f64; 2]> {
        let tip = placed.tip;
        // In the tool's frame the line is p + z q.
        let p = placed.back * Vector3::new(x - tip[0], y - tip[1], -tip[2]);
        let q = placed.back * Vector3::z();
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        // |p_xy + z q_xy|² ≤ r².
        let (a, b) = (q[0] * q[0] + q[1] * q[1], p[0] * q[0] + p[1] * q[1]);
        let c = p[0] * p[0] + p[1] * p[1] - self.radius * self.radius;
        if a < 1e-18 {
            if c > 0.0 {
                return None;
            }
        } else {
            let d = b * b - a * c;
            if d <= 0.0 {
                return None;
            }
            range = [(-b - d.sqrt()) / a, (-b + d.sqrt()) / a];
        }
        // z₀ ≤ p_z + z q_z ≤ z₁.
        if q[2].abs() < 1e-15 {
            if p[2] < self.z[0] || p[2] > self.z[1] {
                return None;
            }
        } else {
            let ends = self.z.map(|z| (z - p[2]) / q[2]);
            range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
        }
        (range[0] < range[1]).then_some(range)
    }
}

/// The tool at one time of a move.
pub struct Placement {
    pub number: usize,
    pub state: MoveState,
    pub time: f64,
    /// From the world to the tool.
    pub back: Matrix3<f64>,
    pub tip: [f64; 3],
}

pub type Intervals = Vec<[f64; 2]>;

pub fn subtract(list: &mut Intervals, [low, high]: [f64; 2]) {
    let mut out = Vec::new();
    for [a, b] in list.iter().copied() {
        if high <= a || low >= b {
            out.push([a, b]);
            continue;
        }
        if a < low {
            out.push([a, low]);
        }
        if high < b {
            out.push([high, b]);
        }
    }
    *list = out;
}

pub fn meets(list: &Intervals, [low, high]: [f64; 2]) -> bool {
    list.iter().any(|[a, b]| a.max(low) < b.min(high))
}

/// A program of one tool on a block.
pub struct Case {
    pub cutter: Cylinder,
    pub holder: Cylinder,
    pub poses: Vec<Pose>,
    /// How the tool gets from pose to pose: by SLERP if empty.
    pub moves: Vec<Move>,
    pub states: Vec<MoveState>,
    pub stock: [[f64; 3]; 2],
    pub clamp: Option<[[f64; 3]; 2]>,
    /// A box below, with the limit for gouges.
    pub target: Option<([[f64; 3]; 2], f64)>,
}

pub type Key = (FindingKind, usize, Option<usize>);

impl Case {
    pub fn grid(&self) -> Grid {
        let [min, max] = self.stock;
        Grid::new([min[0], min[1]], [max[0], max[1]], [23, 19]).unwrap()
    }

    /// Fixtures have a grid of their own, with about the spacing of the stock's.
    fn clamp_grid(&self, [min, max]: [[f64; 3]; 2]) -> Grid {
        let spacing = self.grid().spacing();
        let cells = [0, 1].map(|k| ((max[k] - min[k]) / spacing[k]).ceil() as usize);
        Grid::new([min[0], min[1]], [max[0], max[1]], cells).unwrap()
    }

    fn placements(&self) -> Vec<Placement> {
        let mut all = Vec::new();
        let path = self.path();
        for number in 0..path.moves() {
            let segments = path.segments(number, 50.0, 1e-6);
            for step in 0..=STEPS {
                let time = step as f64 / STEPS as f64;
                let local = time * segments.len() as f64;
                let n = (local as usize).min(segments.len() - 1);
                let segment = &segments[n];
                let (turn, tip) = segment.at(segment.at_time(local - n as f64));
                all.push(Placement {
                    number,
                    state: self.states[number],
                    time,
                    back: turn.transpose(),
                    tip,
                });
            }
        }
        all
    }

    /// Findings of some tools one after the other, by brute force, with the number of the tool and their first times.
    /// Stock, clamp and target are those of the first.
    pub fn by_force(cases: &[Self], sure: bool) -> BTreeMap<(usize, Key), f64> {
        let sign = if sure { -1.0 } else { 1.0 };
        let first = &cases[0];
        let solids: Vec<[Cylinder; 3]> = cases
            .iter()
            .map(|case| {
                let eater = if sure { case.cutter.grown(MARGIN) } else { case.cutter };
                [
                    case.cutter.grown(sign * MARGIN),
                    case.holder.grown(sign * MARGIN),
                    eater,
                ]
            })
            .collect();
        let mut found = BTreeMap::new();
        let boxed = |solid: [[f64; 3]; 2], x: f64, y: f64| -> Intervals {
            let [min, max] = solid;
            let inside = min[0] < x && x < max[0] && min[1] < y && y < max[1];
            if inside { vec![[min[2], max[2]]] } else { Vec::new() }
        };
        let mut note = |case: usize, kind, number, body, time: f64| {
            let first = found.entry((case, (kind, number, body))).or_insert(time);
            *first = first.min(time);
        };
        let placements: Vec<(usize, Placement)> = (0..)
            .zip(cases)
            .flat_map(|(n, case)| case.placements().into_iter().map(move |placed| (n, placed)))
            .collect();
        let grid = first.grid();
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            let (x, y) = (grid.x(i), grid.y(j));
            let mut stock = boxed(first.stock, x, y);
            let core = first.target.map(|([min, max], limit)| {
                let limit = limit - sign * MARGIN;
                boxed([min.map(|c| c + limit), max.map(|c| c - limit)], x, y)
            });
            for (case, placed) in &placements {
                let [probe, holder, eater] = &solids[*case];
                if stock.is_empty() {
                    break;
                }
                let Placement {
                    number, state, time, ..
                } = *placed;
                if let Some(cut) = probe.on_line(placed, x, y) {
                    if state.rapid && meets(&stock, cut) {
                        note(*case, FindingKind::Rapid, number, None, time);
                    } else if state.spindle_stopped && meets(&stock, cut) {
                        note(*case, FindingKind::Spindle, number, None, time);
                    }
                    let both = core.iter().flatten().map(|[a, b]| [a.max(cut[0]), b.min(cut[1])]);
                    if both
                        .into_iter()
                        .any(|range| range[0] < range[1] && meets(&stock, range))
                    {
                        note(*case, FindingKind::Gouge, number, None, time);
                    }
                }
                if let Some(cut) = eater.on_line(placed, x, y) {
                    subtract(&mut stock, cut);
                }
                if holder.on_line(placed, x, y).is_some_and(|range| meets(&stock, range)) {
                    note(*case, FindingKind::Collision, number, Some(0), time);
                }
            }
        }
        if let Some(clamp) = first.clamp {
            let grid = first.clamp_grid(clamp);
            for index in 0..grid.len() {
                let (i, j) = grid.place(index);
                let (x, y) = (grid.x(i), grid.y(j));
                let material = boxed(clamp, x, y);
                if material.is_empty() {
                    continue;
                }
                for (case, placed) in &placements {
                    let [probe, holder, _] = &solids[*case];
                    for (body, solid) in [(None, probe), (Some(0), holder)] {
                        if solid.on_line(placed, x, y).is_some_and(|range| meets(&material, range)) {
                            note(*case, FindingKind::Fixture, placed.number, body, placed.time);
                        }
                    }
                }
            }
        }
        found
    }

    pub fn path(&self) -> Path {
        if self.moves.is_empty() {
            Path::new(self.poses.clone()).unwrap()
        } else {
            Path::with_moves(self.poses.clone(), self.moves.clone()).unwrap()
        }
    }

    pub fn verified(&self) -> Vec<Finding> {
        let (grid, [min, max]) = (self.grid(), self.stock);
        let stock = Stock::Block { min, max }.dexels(&grid).unwrap();
        let assembly = Assembly::new(self.cutter.tool()).with(BodyKind::Holder, self.holder.tool());
        let path = self.path();
        let program = [ToolPath::new(&assembly, &path).with_states(&self.states)];
        let clamp = self
            .clamp
            .map(|[min, max]| Stock::Block { min, max }.dexels(&self.clamp_grid([min, max])).unwrap());
        let target = self
            .target
            .map(|(solid, limit)| Target::new(&box_mesh(solid), &grid, limit, limit).unwrap());
        let mut scene = Scene::new(stock);
        if let Some(clamp) = &clamp {
            scene = scene.with_fixtures(clamp);
        }
        if let Some(target) = &target {
            scene = scene.with_target(target);
        }
        let mut streamed = Vec::new();
        let result = verify(
            scene,
            &program,
            &VerifyOptions::default(),
            &mut |finding| {
                streamed.push(*finding);
                ControlFlow::Continue(())
            },
            &(),
        )
        .unwrap();
        assert_eq!(result.findings, streamed);
        assert!(result.unresolved.is_empty(), "{:?}", result.unresolved);
        assert!(result.undecided.is_empty(), "{:?}", result.undecided);
        streamed
    }

    pub fn check(&self, name: &str) -> usize {
        let found: BTreeMap<Key, Finding> = self
            .verified()
            .iter()
            .map(|f| ((f.kind, f.number, f.body), *f))
            .collect();
        let of_one = |sure| -> BTreeMap<Key, f64> {
            let found = Self::by_force(std::slice::from_ref(self), sure).into_iter();
            found.map(|((_, key), time)| (key, time)).collect()
        };
        let (sure, possible) = (of_one(true), of_one(false));
        let step = 1.0 / STEPS as f64;
        for (key, time) in &sure {
            let finding = found
                .get(key)
                .unwrap_or_else(|| panic!("{name}: {key:?} at {time} is missed; found {found:#?}"));
            assert!(finding.time <= time + step, "{name}: {finding:?} is late: {time}");
            assert!(finding.depth > 0.0 && finding.volume > 0.0, "{name}: {finding:?}");
        }
        for (key, finding) in &found {
            let time = possible
                .get(key)
                .unwrap_or_else(|| panic!("{name}: {finding:?} is impossible: {possible:?}"));
            assert!(finding.time >= time - step, "{name}: {finding:?} is early: {time}");
        }
        sure.len()
    }
}

/// A closed box, with all faces outwards.
pub fn box_mesh([min, max]: [[f64; 3]; 2]) -> TriangleSoup {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] });
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
    TriangleSoup {
        triangles: triangles.map(|t| t.map(corner)).collect(),
    }
}

pub fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).unwrap()
}
