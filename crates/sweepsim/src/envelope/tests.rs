//! Searches that drop cells on their way: they find the same, in bounded memory.

use super::{OnPatch, PatchMap, ROOT, Size};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::methods::lattice::Lattice;
use crate::time::pieces::Times;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Law, Path, Pose, Segment, Tool};
use sweepsim_props::*;
use sweepsim_solve::{
    CancelOnly, ChartMap, ChartOptions, ChartSolver, ChartTarget, Enclosure, Preimage, Sample, Sink, Targets,
    UnresolvedTarget,
};

type Brick = (u32, u32);
type Sides = [Enclosure; 3];

/// A map that drops what it can before each box, or never.
struct Forgetting<'a> {
    map: PatchMap<'a>,
    always: bool,
}

impl ChartMap<3> for Forgetting<'_> {
    type Cell = Brick;
    type Seen = OnPatch;

    fn bounds(&self, cell: &Brick) -> Sides {
        self.map.bounds(cell)
    }

    fn values(&mut self, cell: &Brick) -> Option<Sides> {
        self.map.values(cell)
    }

    fn jacobian(&mut self, cell: &Brick) -> [Sides; 3] {
        self.map.jacobian(cell)
    }

    fn split(&mut self, cell: &Brick, axis: usize) -> [Brick; 2] {
        self.map.split(cell, axis)
    }

    fn is_absent(&mut self, cell: &Brick, target: &[f64; 3]) -> bool {
        self.map.is_absent(cell, target)
    }

    fn part(&mut self, cell: &Brick, values: &Sides, jacobian: &[Sides; 3]) -> Option<Brick> {
        self.map.part(cell, values, jacobian)
    }

    fn remainder(&mut self, cell: &Brick, values: &Sides, jacobian: &[Sides; 3]) -> Option<Sides> {
        self.map.remainder(cell, values, jacobian)
    }

    fn drop_part(&mut self, part: Brick) {
        self.map.drop_part(part);
    }

    fn clipped(&mut self, cell: &Brick, range: &Sides) -> Option<Sides> {
        self.map.clipped(cell, range)
    }

    fn narrowed(&mut self, cell: &Brick, part: &Sides) -> Option<Brick> {
        self.map.narrowed(cell, part)
    }

    fn drop_narrowed(&mut self, cell: Brick) {
        self.map.drop_narrowed(cell);
    }

    fn begin(&mut self) {
        self.map.begin();
    }

    fn is_full(&self) -> bool {
        self.always
    }

    fn keep(&mut self, cells: &mut [Brick]) {
        let before: Vec<Sides> = cells.iter().map(|cell| self.bounds(cell)).collect();
        self.map.keep(cells);
        assert!(
            cells
                .iter()
                .zip(before)
                .all(|(cell, before)| self.bounds(cell) == before)
        );
        assert!(
            [self.map.cells.mark(), self.map.times.mark()]
                .iter()
                .all(|count| *count <= cells.len() + 1)
        );
    }

    fn value(&self, x: &[f64; 3]) -> Option<[f64; 3]> {
        self.map.value(x)
    }

    fn evaluate(&self, x: &[f64; 3]) -> Sample<3, OnPatch> {
        self.map.evaluate(x)
    }

    fn scales(&self) -> [f64; 3] {
        self.map.scales()
    }

    fn rounding(&self) -> [f64; 3] {
        self.map.rounding()
    }

    fn rounding_in(&self, cell: &Brick) -> [f64; 3] {
        self.map.rounding_in(cell)
    }
}

#[derive(Debug, Default, PartialEq)]
struct Found {
    preimages: Vec<(usize, [u64; 3])>,
    open: Vec<UnresolvedTarget<3>>,
}

impl Sink<3, OnPatch> for Found {
    fn found(&mut self, preimage: Preimage<3, OnPatch>) {
        self.preimages.push((preimage.target, preimage.x.map(f64::to_bits)));
    }

    fn mark(&self) -> usize {
        self.preimages.len()
    }

    fn forget(&mut self, mark: usize) {
        self.preimages.truncate(mark);
    }

    fn forget_targets(&mut self, _: usize, targets: &[usize]) {
        unreachable!("{targets:?}");
    }

    fn unresolved(&mut self, target: UnresolvedTarget<3>) {
        self.open.push(target);
    }
}

fn segment(ends: [[f64; 6]; 2]) -> Segment {
    let poses = ends.map(|[x, y, z, i, j, k]| Pose::new([x, y, z], [i, j, k]).unwrap());
    let path = Path::with_law(poses.into(), Law::Slerp).unwrap();
    path.segments(0, 10.0, 1e-6).remove(0)
}

fn size() -> Size {
    Size {
        spacing: [0.5; 2],
        system_rounding: 64.0 * f64::EPSILON * 50.0,
    }
}

/// What a search finds, and its numbers of boxes, charts and evaluations.
fn searched(element: &PatchForms, segment: &Segment, lines: &Lattice, always: bool) -> (Found, [u64; 3]) {
    let (mut times, mut cells) = (Times::new(segment), Cells::new(element));
    let map = PatchMap::new(element, &mut cells, &mut times, size());
    let mut solver = ChartSolver::new(ChartOptions::default().boxes(20_000));
    let mut found = Found::default();
    let mut map = Forgetting { map, always };
    solver.solve(&mut map, ROOT, lines, &mut found, &CancelOnly(&()));
    let statistics = solver.statistics;
    (found, [statistics.boxes, statistics.charts, statistics.evaluations])
}

/// Lines everywhere.
struct Everywhere;

impl Targets<3> for Everywhere {
    fn count(&self, _: &Sides) -> usize {
        usize::MAX
    }

    fn visit(&self, _: &Sides, _: &dyn Fn(&[f64; 3]) -> Option<Enclosure>, _: &mut dyn FnMut(&ChartTarget<3>) -> bool) {
    }
}

/// A map as it would be if nothing were known but that its values change in one direction: no box is ever dropped.
struct Endless<'a> {
    map: PatchMap<'a>,
    direction: usize,
}

impl ChartMap<3> for Endless<'_> {
    type Cell = Brick;
    type Seen = OnPatch;

    fn bounds(&self, cell: &Brick) -> Sides {
        self.map.bounds(cell)
    }

    fn values(&mut self, _: &Brick) -> Option<Sides> {
        Some([Enclosure::UNIT; 3])
    }

    fn jacobian(&mut self, cell: &Brick) -> [Sides; 3] {
        self.map.jacobian(cell);
        let mut row = [Enclosure::hull(0.0, 0.0); 3];
        row[self.direction] = Enclosure::hull(-1.0, 1.0);
        [row; 3]
    }

    fn split(&mut self, cell: &Brick, axis: usize) -> [Brick; 2] {
        self.map.split(cell, axis)
    }

    fn begin(&mut self) {
        self.map.begin();
    }

    fn is_full(&self) -> bool {
        self.map.is_full()
    }

    fn keep(&mut self, cells: &mut [Brick]) {
        self.map.keep(cells);
    }

    fn evaluate(&self, x: &[f64; 3]) -> Sample<3, OnPatch> {
        self.map.evaluate(x)
    }

    fn scales(&self) -> [f64; 3] {
        self.map.scales()
    }

    fn rounding(&self) -> [f64; 3] {
        self.map.rounding()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Whatever is dropped on the way, a search takes the same course.
    #[test]
    fn dropped_cells_change_nothing(
        start in [-4.0..4.0, -4.0..4.0, -1.0..1.0, -0.5..0.5, -0.5..0.5, 0.5..1.0], end in [-4.0..4.0, -4.0..4.0, -1.0..1.0, -0.5..0.5, -0.5..0.5, 0.5..1.0],
        turns in any::<bool>(), tool in 0..3_usize, cells in 2..9_usize,
    ) {
        let tool = [Tool::ball(2.0, 7.0), Tool::flat(2.0, 7.0), Tool::bull(2.0, 0.5, 7.0)][tool].clone().unwrap();
        let mut end = end;
        if !turns {
            end[3..].copy_from_slice(&start[3..]);
        }
        let segment = segment([start, end]);
        let grid = Grid::new([-3.0; 2], [3.0; 2], [cells; 2]).unwrap();
        let lines = Lattice::all(&grid, [1e-9, 2e-9]);
        for element in &PatchForms::all(&tool).0 {
            let [kept, dropped] = [false, true].map(|always| searched(element, &segment, &lines, always));
            prop_assert_eq!(kept, dropped);
        }
    }
}

/// A search that uses up its budget takes as much memory as one of a few thousand boxes.
#[test]
fn memory_of_a_long_search_is_bounded() {
    const BOXES: u64 = 20_000;
    let segment = segment([[-3.0, 0.1, 0.2, 0.1, 0.05, 1.0], [3.0, 0.4, 0.0, -0.3, 0.2, 1.0]]);
    let element = &PatchForms::all(&Tool::ball(2.0, 7.0).unwrap()).0[0];
    for direction in 0..3 {
        let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
        let map = PatchMap::new(element, &mut cells, &mut times, size());
        let mut map = Endless { map, direction };
        let mut solver = ChartSolver::new(ChartOptions::default().boxes(BOXES));
        solver.solve(&mut map, ROOT, &Everywhere, &mut Found::default(), &CancelOnly(&()));
        let counts = [cells.mark(), times.mark()];
        assert!(solver.statistics.boxes > BOXES);
        assert!(counts.iter().all(|count| *count < 3000), "{counts:?}");
    }
}
