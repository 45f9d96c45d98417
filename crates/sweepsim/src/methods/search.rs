//! All crossings of dexel lines with the boundary of a stretch of path: envelope, edges, kinks and the two caps.

use crate::cutter::Cutter;
use crate::cutter::cells::Cells;
use crate::envelope::AnyBox;
use crate::envelope::systems::{EdgeMotion, PatchMotion, PlacedPatch, Plane};
use crate::envelope::{EdgeMap, Near, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap, ROOT, Side, Size, Twist};
use crate::methods::lattice::Lattice;
use crate::methods::lines::Bundles;
use crate::methods::planes::Slicer;
use crate::time::framed::FramedMotion;
use crate::time::path_parts::PathPart;
use crate::time::pieces::Times;
use nalgebra::{Const, DimMin, Matrix3, ToTypenum, Vector3};
use sweepsim_dexel::{Crossing, Source};
use sweepsim_motion::{Segment, SegmentEnd, Tool};
use sweepsim_solve::{
    BundleSolver, ChartMap, ChartOptions, ChartSolver, ChartStatistics, Preimage, Reason, Sink, SolveOptions,
    SurfaceSolver, System, SystemError, Undecided,
};

/// What one worker keeps from segment to segment.
pub(crate) struct Workspace {
    pub faces: Vec<Cells>,
    pub rims: Vec<Cells>,
    pub bricks: ChartSolver<(u32, u32)>,
    pub placed: ChartSolver<u32>,
    pub slicer: Slicer,
    pub bundles: BundleSolver,
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
            slicer: Slicer::new(),
            bundles: BundleSolver::new(options),
        }
    }
}

/// How the maps of a search are solved.
#[derive(Clone, Copy, Debug)]
pub(crate) enum How<'a> {
    /// By charts, from the whole domain.
    Charts,
    /// By curves in the lattice's one plane `x = const`: Algorithm 3. The forms of each part.
    Planes(&'a [Forms]),
    /// By charts within the boxes of the envelope surfaces: Algorithm 1.
    Surface,
    /// Line by line, in bundles: Algorithm 4. The systems of each part.
    Lines(&'a [Bundles]),
}

/// What a part needs to be solved so.
#[derive(Clone, Copy)]
struct Means<'a> {
    forms: Option<&'a Forms>,
    bundles: Option<&'a Bundles>,
    surface: Option<&'a Segment>,
}

/// A tool under one motion, and at rest at its start and end.
#[derive(Clone, Debug)]
pub(crate) struct Forms {
    faces: Vec<PatchMotion>,
    rims: Vec<EdgeMotion>,
    placed: [Vec<PlacedPatch>; 2],
}

impl Forms {
    pub fn new(tool: &Tool, segment: &Segment) -> Self {
        let [first, last] = segment.tips();
        let at_rest = |turn: Matrix3<f64>, tip: &Vector3<f64>| {
            let patches = tool.patches().iter();
            patches.map(|patch| PlacedPatch::new(patch, &turn, tip)).collect()
        };
        Self {
            faces: tool
                .patches()
                .iter()
                .map(|patch| PatchMotion::new(patch, segment))
                .collect(),
            rims: tool.edges().iter().map(|edge| EdgeMotion::new(edge, segment)).collect(),
            placed: [at_rest(segment.start(), first), at_rest(segment.end(), last)],
        }
    }
}

/// How flat the surface is in the boxes of Algorithm 1, in parts of the parameters' ranges.
const FLATNESS: f64 = 0.02;
/// Boxes of an envelope surface. Those without trouble need some ten to a thousand.
const BOXES: u64 = 2_000;

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

/// Makes crossings of preimages as they come.
struct Reaper<'a, F> {
    crossings: &'a mut Vec<Numbered>,
    open: &'a mut Vec<(u32, Reason)>,
    make: F,
}

impl<const N: usize, S, F: Fn(&Preimage<N, S>) -> Option<Crossing>> Sink<N, S> for Reaper<'_, F> {
    fn found(&mut self, preimage: Preimage<N, S>) {
        if let Some(crossing) = (self.make)(&preimage) {
            self.crossings.push((preimage.target as u32, crossing));
        }
    }

    fn mark(&self) -> usize {
        self.crossings.len()
    }

    fn forget(&mut self, mark: usize) {
        self.crossings.truncate(mark);
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
struct Placement {
    turn: Matrix3<f64>,
    tip: Vector3<f64>,
    before: Side,
    after: Side,
    source: Source,
    /// Of [`Forms`].
    end: usize,
}

/// The velocity at one end of a segment, in the coordinates of a tool turned by `turn`.
pub(crate) fn twist(segment: &Segment, end: SegmentEnd, turn: &Matrix3<f64>) -> Side {
    let back = turn.transpose();
    let [spin, travel] = segment.velocity(end);
    Side::Moving(Twist {
        spin: (back * spin).into(),
        travel: (back * travel).into(),
    })
}

/// What moves before and after a placement of the part: that at its start (0), or that at its end (1), the last of the path.
pub(crate) fn sides(parts: &[PathPart], at: usize, end: usize) -> [Side; 2] {
    let segment = &parts[at].segment;
    if end == 1 {
        return [twist(segment, SegmentEnd::Finish, &segment.end()), Side::Beyond(true)];
    }
    let turn = segment.start();
    let before = at.checked_sub(1).map_or(Side::Beyond(false), |k| {
        twist(&parts[k].segment, SegmentEnd::Finish, &turn)
    });
    [before, twist(segment, SegmentEnd::Start, &turn)]
}

/// A search of some lines along some segments.
pub(crate) struct Search<'a> {
    pub tool: &'a Tool,
    pub cutter: &'a Cutter,
    pub how: How<'a>,
    pub lattice: &'a Lattice<'a>,
    pub size: Size,
    pub path: u16,
}

impl Search<'_> {
    /// The crossings of `parts[at]`: its envelope and edges, the joint at its start, and the cap at the end of the last.
    pub fn part(&self, parts: &[PathPart], at: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let PathPart {
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
        let mut means = Means {
            forms: None,
            bundles: None,
            surface: None,
        };
        match self.how {
            How::Charts => {}
            How::Planes(forms) => means.forms = Some(&forms[at]),
            How::Lines(bundles) => means.bundles = Some(&bundles[at]),
            How::Surface => means.surface = Some(segment),
        }
        self.faces(&mut times, means, &source, space, harvest);
        self.rims(&mut times, means, &source, space, harvest);
        let turn = segment.start();
        let [before, after] = sides(parts, at, 0);
        let placed = Placement {
            turn,
            tip: segment.tips()[0],
            before,
            after,
            source: source(0.0),
            end: 0,
        };
        self.joint(&placed, means, space, harvest);
        if at + 1 == parts.len() {
            let [before, after] = sides(parts, at, 1);
            let placed = Placement {
                turn: segment.end(),
                tip: segment.tips()[1],
                before,
                after,
                source: source(1.0),
                end: 1,
            };
            self.joint(&placed, means, space, harvest);
        }
        harvest.count_slices(&mut space.slicer);
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

    /// The plane of a lattice with one `x`.
    fn plane(&self) -> Plane {
        Plane::x(self.lattice.coordinate(0, self.lattice.i[0]))
    }

    /// Solves a map by the curves in the lattice's plane; by charts, where that does not decide it.
    fn slice<const N: usize, M: AnyBox<N>>(
        &self,
        map: &mut M,
        system: impl FnOnce() -> Result<System, SystemError>,
        (slicer, charts): (&mut Slicer, &mut ChartSolver<M::Cell>),
        sink: &mut impl Sink<N, M::Seen>,
    ) where
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        // Most planes miss most patches.
        let root = map.root();
        let touches = map.values(&root).is_some_and(|values| {
            self.lattice.numbers(0, values[0]).is_some() && self.lattice.numbers(1, values[1]).is_some()
        });
        if touches && !slicer.solve(map, system(), self.lattice, charts.options.accept, sink) {
            charts.solve(map, root, self.lattice, sink, &());
        }
    }

    fn faces(
        &self,
        times: &mut Times,
        means: Means,
        source: &dyn Fn(f64) -> Source,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        for (number, (element, cells)) in self.cutter.faces.iter().zip(&mut space.faces).enumerate() {
            let mut map = PatchMap {
                motion: FramedMotion::new(times, element.frame()),
                element,
                cells,
                times,
                size: self.size,
            };
            let mut sink = harvest.reaper(|found: &Preimage<3, OnPatch>| {
                Some(Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: found.orientation,
                    normal: unit(found.seen.normal),
                    source: source(found.x[2]),
                })
            });
            if let Some(bundle) = means.bundles.and_then(|bundles| bundles.face(number)) {
                space.bundles.solve(bundle, &map, self.lattice, &mut sink, &());
            } else if let Some(forms) = means.forms {
                let system = || forms.faces[number].section(&self.plane());
                self.slice(&mut map, system, (&mut space.slicer, &mut space.bricks), &mut sink);
            } else if let Some(segment) = means.surface {
                self.within_surface(&mut map, number, segment, &mut space.bricks, &mut sink);
            } else {
                space.bricks.solve(&mut map, ROOT, self.lattice, &mut sink, &());
            }
        }
        harvest.count(&mut space.bricks.statistics);
    }

    /// Solves a patch's map within the boxes that hold its envelope surface.
    fn within_surface(
        &self,
        map: &mut PatchMap,
        number: usize,
        segment: &Segment,
        charts: &mut ChartSolver<(u32, u32)>,
        sink: &mut impl Sink<3, OnPatch>,
    ) {
        let touches = map
            .values(&ROOT)
            .is_some_and(|v| self.lattice.numbers(0, v[0]).is_some() && self.lattice.numbers(1, v[1]).is_some());
        if !touches {
            return;
        }
        let domain = map.bounds(&ROOT);
        let motion = PatchMotion::new(&self.tool.patches()[number], segment);
        let options = SolveOptions {
            boxes: BOXES,
            unresolved: 0,
            ..SurfaceSolver::new(FLATNESS).options
        };
        let surface = motion
            .envelope()
            .ok()
            .and_then(|system| SurfaceSolver::with_options(FLATNESS, options).solve(&system, &()).ok())
            .filter(|surface| surface.unresolved.is_empty());
        let Some(surface) = surface else {
            // No equation (the patch slides along itself), or a singular one: the whole domain is the box.
            charts.solve(map, ROOT, self.lattice, sink, &());
            return;
        };
        for bounds in surface.boxes {
            let mark = map.mark();
            let part = map.place(&bounds);
            charts.solve_part(map, part, &domain, self.lattice, sink, &());
            map.release(mark);
        }
    }

    fn rims(
        &self,
        times: &mut Times,
        means: Means,
        source: &dyn Fn(f64) -> Source,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        for (number, (element, cells)) in self.cutter.rims.iter().zip(&mut space.rims).enumerate() {
            let mut map = EdgeMap {
                motion: FramedMotion::new(times, None),
                element,
                cells,
                times,
                size: self.size,
            };
            let mut sink = harvest.reaper(|found: &Preimage<2, OnEdge>| {
                let [a, b] = found.seen.sides.map(|side| side.at(&found.x, &found.from));
                if (a < 0.0) == (b < 0.0) {
                    return None;
                }
                // The envelope's normal lies in the fan of the two faces, where g = 0.
                let [n, m] = found.seen.normals;
                let lengths = n.norm() * m.norm();
                Some(Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: if a < 0.0 { -found.orientation } else { found.orientation },
                    normal: unit(n * (b.abs() / lengths) + m * (a.abs() / lengths)),
                    source: source(found.x[1]),
                })
            });
            if let Some(bundle) = means.bundles.and_then(|bundles| bundles.rim(number)) {
                space.bundles.solve(bundle, &map, self.lattice, &mut sink, &());
            } else if let Some(forms) = means.forms {
                let system = || forms.rims[number].section(&self.plane());
                self.slice(&mut map, system, (&mut space.slicer, &mut space.bricks), &mut sink);
            } else {
                space.bricks.solve(&mut map, ROOT, self.lattice, &mut sink, &());
            }
        }
        harvest.count(&mut space.bricks.statistics);
    }

    fn joint(&self, placed: &Placement, means: Means, space: &mut Workspace, harvest: &mut Harvest) {
        for (number, (element, cells)) in self.cutter.faces.iter().zip(&mut space.faces).enumerate() {
            let pose = (placed.turn, placed.tip);
            let mut map = PlacedMap::new(element, cells, pose, [placed.before, placed.after], self.size);
            let mut sink = harvest.reaper(|found: &Preimage<2, OnPlaced>| {
                let negative = |side: Near<2>| i8::from(side.at(&found.x, &found.from) < 0.0);
                let change = negative(found.seen.after) - negative(found.seen.before);
                (change != 0).then(|| Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: -found.orientation * change,
                    normal: unit(found.seen.normal),
                    source: placed.source,
                })
            });
            if let Some(bundle) = means.bundles.and_then(|bundles| bundles.placed(placed.end, number)) {
                space.bundles.solve(bundle, &map, self.lattice, &mut sink, &());
            } else if let Some(forms) = means.forms {
                let system = || forms.placed[placed.end][number].section(&self.plane());
                self.slice(&mut map, system, (&mut space.slicer, &mut space.placed), &mut sink);
            } else {
                space.placed.solve(&mut map, 0, self.lattice, &mut sink, &());
            }
        }
        harvest.count(&mut space.placed.statistics);
        harvest.count(&mut space.bundles.statistics);
    }
}

impl Harvest {
    /// Receives preimages, of which `make` makes crossings.
    fn reaper<F>(&mut self, make: F) -> Reaper<'_, F> {
        Reaper {
            crossings: &mut self.crossings,
            open: &mut self.open,
            make,
        }
    }

    /// Counts what the slicer did since the last time.
    fn count_slices(&mut self, slicer: &mut Slicer) {
        self.statistics.boxes += std::mem::take(&mut slicer.boxes);
        self.statistics.charts += std::mem::take(&mut slicer.regular);
        self.statistics.evaluations += std::mem::take(&mut slicer.evaluations);
    }

    fn count(&mut self, statistics: &mut ChartStatistics) {
        self.statistics.boxes += statistics.boxes;
        self.statistics.charts += statistics.charts;
        self.statistics.evaluations += statistics.evaluations;
        *statistics = ChartStatistics::default();
    }
}
