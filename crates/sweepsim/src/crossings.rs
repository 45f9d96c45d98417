//! All crossings of dexel lines with the boundary of a stretch of path: envelope, edges, kinks and the two caps.

use crate::element::{Cells, Element};
use crate::envelope::{Face, Joint, Near, ROOT, Rim, Side, Size, Twist};
use crate::generic::Part;
use crate::lattice::Lattice;
use crate::time::Times;
use nalgebra::{Matrix3, Vector3};
use sweepsim_dexel::{Crossing, Source};
use sweepsim_motion::{End, Segment, Tool};
use sweepsim_solve::{ChartOptions, ChartSolver, ChartStatistics, Preimage, Reason, Sink, Undecided};

/// A tool, prepared.
pub(crate) struct Cutter {
    pub faces: Vec<Element>,
    pub rims: Vec<Element>,
    /// No point of the tool is farther from its tip.
    pub reach: f64,
}

impl Cutter {
    pub fn new(tool: &Tool) -> Self {
        let (faces, rims) = Element::all(tool);
        let reach = tool
            .patches()
            .iter()
            .flat_map(|patch| {
                let weights = patch.weight.coefficients();
                (0..weights.len()).map(move |i| {
                    Vector3::from([0, 1, 2].map(|k| patch.position[k].coefficients()[i] / weights[i])).norm()
                })
            })
            .fold(0.0, f64::max);
        Self { faces, rims, reach }
    }
}

/// What one worker keeps from segment to segment.
pub(crate) struct Workspace {
    pub faces: Vec<Cells>,
    pub rims: Vec<Cells>,
    pub bricks: ChartSolver<(u32, u32)>,
    pub placed: ChartSolver<u32>,
}

impl Workspace {
    /// `accept`: see [`ChartOptions`].
    pub fn new(cutter: &Cutter, accept: f64) -> Self {
        let options = ChartOptions {
            accept,
            ..ChartOptions::default()
        };
        Self {
            faces: cutter.faces.iter().map(Cells::new).collect(),
            rims: cutter.rims.iter().map(Cells::new).collect(),
            bricks: ChartSolver::new(options),
            placed: ChartSolver::new(options),
        }
    }
}

/// A crossing and the number of its line.
pub(crate) type Numbered = (u32, Crossing);

/// What a search found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Harvest {
    pub crossings: Vec<Numbered>,
    /// Lines with a box that could not be decided.
    pub open: Vec<(u32, Reason)>,
    pub statistics: ChartStatistics,
}

/// Preimages of one map.
pub(crate) struct Collector<const N: usize, S> {
    pub found: Vec<Preimage<N, S>>,
    pub open: Vec<(u32, Reason)>,
}

impl<const N: usize, S> Collector<N, S> {
    pub fn new() -> Self {
        Self {
            found: Vec::new(),
            open: Vec::new(),
        }
    }
}

impl<const N: usize, S> Sink<N, S> for Collector<N, S> {
    fn found(&mut self, preimage: Preimage<N, S>) {
        self.found.push(preimage);
    }

    fn undecided(&mut self, undecided: Undecided<N>) {
        self.open.push((undecided.target as u32, undecided.reason));
    }
}

fn unit(normal: Vector3<f64>) -> [f32; 3] {
    let length = normal.norm();
    let normal = if length > 0.0 { normal / length } else { normal };
    [normal.x as f32, normal.y as f32, normal.z as f32]
}

/// A placement between two motions.
struct Placed {
    turn: Matrix3<f64>,
    tip: Vector3<f64>,
    before: Side,
    after: Side,
    source: Source,
}

/// The velocity at one end of a segment, in the coordinates of a tool turned by `turn`.
pub(crate) fn twist(segment: &Segment, end: End, turn: &Matrix3<f64>) -> Side {
    let back = turn.transpose();
    let [spin, travel] = segment.velocity(end);
    Side::Moving(Twist {
        spin: (back * spin).into(),
        travel: (back * travel).into(),
    })
}

/// A search of some lines along some segments.
pub(crate) struct Search<'a> {
    pub cutter: &'a Cutter,
    pub lattice: &'a Lattice<'a>,
    pub size: Size,
    pub path: u16,
}

impl Search<'_> {
    /// The crossings of `parts[at]`: its envelope and edges, the joint at its start, and the cap at the end of the last.
    pub fn part(&self, parts: &[Part], at: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let Part {
            segment,
            number,
            start,
            share,
        } = &parts[at];
        if !self.reaches(segment) {
            return;
        }
        let source = |t: f64| Source {
            path: self.path,
            segment: *number,
            t: start + share * segment.time(t) as f32,
        };
        let mut times = Times::new(segment);
        self.faces(&mut times, &source, space, harvest);
        self.rims(&mut times, &source, space, harvest);
        let turn = segment.start();
        let before = at
            .checked_sub(1)
            .map_or(Side::Beyond(false), |k| twist(&parts[k].segment, End::Finish, &turn));
        let placed = Placed {
            turn,
            tip: segment.tips()[0],
            before,
            after: twist(segment, End::Start, &turn),
            source: source(0.0),
        };
        self.joint(&placed, space, harvest);
        if at + 1 == parts.len() {
            let turn = segment.end();
            let placed = Placed {
                turn,
                tip: segment.tips()[1],
                before: twist(segment, End::Finish, &turn),
                after: Side::Beyond(true),
                source: source(1.0),
            };
            self.joint(&placed, space, harvest);
        }
        for cells in space.faces.iter_mut().chain(&mut space.rims) {
            cells.trim();
        }
    }

    /// Whether any line passes near the segment.
    fn reaches(&self, segment: &Segment) -> bool {
        let (points, weights) = segment.points();
        let place = |k: usize, n: usize| points[n][k] / weights[n];
        let window = [self.lattice.i, self.lattice.j];
        (0..2).all(|k| {
            let grid = self.lattice.grid;
            let at = |n: usize| if k == 0 { grid.x(n) } else { grid.y(n) };
            let margin =
                self.cutter.reach + self.size.spacing[k] * 1e-6 + self.size.slack + self.lattice.shift[k].abs();
            let coordinates = || (0..points.len()).map(|n| place(k, n));
            let (low, high) = (
                coordinates().fold(f64::INFINITY, f64::min),
                coordinates().fold(f64::NEG_INFINITY, f64::max),
            );
            low - margin <= at(window[k][1]) && high + margin >= at(window[k][0])
        })
    }

    fn faces(&self, times: &mut Times, source: &dyn Fn(f64) -> Source, space: &mut Workspace, harvest: &mut Harvest) {
        for (element, cells) in self.cutter.faces.iter().zip(&mut space.faces) {
            let mut map = Face {
                element,
                cells,
                times,
                size: self.size,
            };
            let mut sink = Collector::new();
            space.bricks.solve(&mut map, ROOT, self.lattice, &mut sink);
            for found in sink.found {
                let crossing = Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: found.orientation,
                    normal: unit(found.seen.normal),
                    source: source(found.x[2]),
                };
                harvest.crossings.push((found.target as u32, crossing));
            }
            harvest.open.extend(sink.open);
        }
        harvest.count(&mut space.bricks.statistics);
    }

    fn rims(&self, times: &mut Times, source: &dyn Fn(f64) -> Source, space: &mut Workspace, harvest: &mut Harvest) {
        for (element, cells) in self.cutter.rims.iter().zip(&mut space.rims) {
            let mut map = Rim {
                element,
                cells,
                times,
                size: self.size,
            };
            let mut sink = Collector::new();
            space.bricks.solve(&mut map, ROOT, self.lattice, &mut sink);
            for found in sink.found {
                let [a, b] = found.seen.sides.map(|side| side.at(&found.x, &found.from));
                if (a < 0.0) == (b < 0.0) {
                    continue;
                }
                // The envelope's normal lies in the fan of the two faces, where g = 0.
                let [n, m] = found.seen.normals;
                let (n, m) = (n / n.norm() * (b.abs() / m.norm()), m / m.norm() * (a.abs() / n.norm()));
                let crossing = Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: if a < 0.0 { -found.orientation } else { found.orientation },
                    normal: unit(n + m),
                    source: source(found.x[1]),
                };
                harvest.crossings.push((found.target as u32, crossing));
            }
            harvest.open.extend(sink.open);
        }
        harvest.count(&mut space.bricks.statistics);
    }

    fn joint(&self, placed: &Placed, space: &mut Workspace, harvest: &mut Harvest) {
        for (element, cells) in self.cutter.faces.iter().zip(&mut space.faces) {
            let mut map = Joint {
                element,
                cells,
                turn: placed.turn,
                tip: placed.tip,
                before: placed.before,
                after: placed.after,
                size: self.size,
            };
            let mut sink = Collector::new();
            space.placed.solve(&mut map, 0, self.lattice, &mut sink);
            for found in sink.found {
                let negative = |side: Near<2>| i8::from(side.at(&found.x, &found.from) < 0.0);
                let change = negative(found.seen.after) - negative(found.seen.before);
                if change == 0 {
                    continue;
                }
                let crossing = Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: -found.orientation * change,
                    normal: unit(found.seen.normal),
                    source: placed.source,
                };
                harvest.crossings.push((found.target as u32, crossing));
            }
            harvest.open.extend(sink.open);
        }
        harvest.count(&mut space.placed.statistics);
    }
}

impl Harvest {
    fn count(&mut self, statistics: &mut ChartStatistics) {
        self.statistics.boxes += statistics.boxes;
        self.statistics.charts += statistics.charts;
        self.statistics.evaluations += statistics.evaluations;
        *statistics = ChartStatistics::default();
    }
}
