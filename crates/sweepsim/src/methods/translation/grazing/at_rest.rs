//! A patch at rest between two moves: charts of `(X, Y)` that serve all joints of moves in one orientation.
//!
//! The tool's placement counts where `g` has different signs before and after. Between similar moves that is a thin lune, around which cells are divided until
//! they hold few lines or the signs are known; what they are certified for depends on the orientation only.

use super::chart::{Chart, Range, Region, Witness, magnitude, solved};
use super::tree::divided;
use crate::envelope::{OnPlaced, PlacedMap};
use crate::methods::lattice::Lattice;
use sweepsim_solve::{Affine, ChartMap, Enclosure, Monitor, Sample, Targets};

/// Charts with more lines, on which `g` has no certain sign, are divided,
const FEW: usize = 4;
/// unless they were divided so often.
const DEPTH: u32 = 10;
/// Cells with sides smaller than this are not divided at all.
const SMALLEST: f64 = 1e-14;
/// Nor are those over which `X` and `Y` change by fewer roundings than this.
const FLAT: f64 = 8.0;
/// A patch that takes more looks at cells is left to charts.
const MOST: u64 = 20_000;
/// As along moves.
const STEPS: usize = 32;
const ON_FACE: f64 = 1e-11;
const LONGEST: f64 = 1e-3;

/// What is known of the cells of a patch in one orientation.
#[derive(Clone, Debug)]
pub(super) struct Still {
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
struct Node {
    cell: u32,
    depth: u32,
    known: Option<Known>,
    /// The first of its two parts.
    parts: Option<u32>,
}

/// A cell as a chart, or the direction in which it is divided.
#[derive(Clone, Debug)]
struct Known {
    /// With `X` and `Y` in the middle, from the tip.
    chart: Option<Box<(Chart, [f64; 2])>>,
    axis: usize,
    /// The ranges of `X` and `Y`, from the tip.
    place: [Range; 2],
}

/// There are too many cells.
pub(super) struct TooMany;

/// Receives what is found.
pub(super) trait Finds {
    /// A point of the patch over a line, with the sign of `∂(X, Y)/∂(u, v)`.
    fn found(&mut self, line: usize, from: [f64; 2], at: [f64; 2], seen: &OnPlaced, orientation: i8);
    fn open(&mut self, line: usize);
}

/// The search of the lines over a patch.
pub(super) struct Search<'a, 'b> {
    pub map: &'a mut PlacedMap<'b>,
    pub lines: &'a Lattice<'a>,
    pub tip: [f64; 2],
    /// The longest last step of Newton's method, in parts of the patch.
    pub last: f64,
    pub monitor: &'a dyn Monitor,
    pub looks: u64,
    pub evaluations: u64,
}

impl Still {
    pub fn new() -> Self {
        Self {
            nodes: vec![Node::new(0, 0)],
        }
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Looks at all cells with lines over which the signs may differ.
    pub fn walk(&mut self, search: &mut Search, finds: &mut impl Finds) -> Result<(), TooMany> {
        let mut stack = vec![0_u32];
        let mut visits = 0;
        while let Some(number) = stack.pop() {
            visits += 1;
            if search.monitor.cancelled() {
                return Ok(());
            }
            if visits > 4 * MOST || search.looks > MOST {
                return Err(TooMany);
            }
            let Node { cell, depth, .. } = self.nodes[number as usize];
            let known = &mut self.nodes[number as usize].known;
            let known = known.get_or_insert_with(|| search.examined(cell, depth));
            let values = search.placed(known.place);
            let count = search.lines.count(&values);
            if count == 0 {
                continue;
            }
            let [before, after] = search.map.signs(cell);
            let certain = before.is_some() && after.is_some();
            if certain && before == after {
                continue;
            }
            let divisible = depth < DEPTH && count > FEW && !certain;
            match &known.chart {
                Some(known) if !divisible => {
                    search.chart(known, cell, &values, finds);
                    continue;
                }
                None if search.is_least(cell, &values) => {
                    search.each(&values, |line, _| finds.open(line));
                    continue;
                }
                _ => {}
            }
            let axis = known.axis;
            let first = match self.nodes[number as usize].parts {
                Some(first) => first,
                None => {
                    let first = self.nodes.len() as u32;
                    let parts = search.map.split(&cell, axis);
                    self.nodes.extend(parts.map(|part| Node::new(part, depth + 1)));
                    self.nodes[number as usize].parts = Some(first);
                    first
                }
            };
            stack.extend([first + 1, first]);
        }
        Ok(())
    }
}

impl Node {
    fn new(cell: u32, depth: u32) -> Self {
        Self {
            cell,
            depth,
            known: None,
            parts: None,
        }
    }
}

impl Search<'_, '_> {
    /// Ranges from the tip, in space.
    fn placed(&self, place: [Range; 2]) -> [Enclosure; 2] {
        let range = |k: usize| Enclosure::hull(place[k].0 + self.tip[k], place[k].1 + self.tip[k]);
        [range(0), range(1)]
    }

    fn examined(&mut self, cell: u32, depth: u32) -> Known {
        self.looks += 1;
        let rounding = self.map.rounding();
        // All of this is the same wherever the tip is, so that it does not depend on where it was first.
        let place = self.map.ranges(cell);
        let jacobian = self
            .map
            .jacobian(&cell)
            .map(|row| row.map(|range| (range.lo(), range.hi())));
        let bounds = self.map.bounds(&cell);
        let corners = [bounds.map(Enclosure::lo), bounds.map(Enclosure::hi)];
        let sides = bounds.map(|side| 2.0 * side.radius());
        match Chart::new(corners, &jacobian, &[[0.0; 2]; 2], rounding, jacobian[0]) {
            Ok(chart) => {
                let centre = self.map.seen_from_tip(chart.point([0.0; 2]));
                let across = |axis: usize| {
                    jacobian
                        .iter()
                        .map(|row| magnitude(row[axis]) * sides[axis])
                        .sum::<f64>()
                };
                Known {
                    axis: usize::from(across(1) > across(0)),
                    chart: Some(Box::new((chart, centre))),
                    place,
                }
            }
            Err(rough) => Known {
                axis: divided(&jacobian, sides, depth, &rough),
                chart: None,
                place,
            },
        }
    }

    /// Whether the parts of a cell would be no smaller, but for rounding.
    fn is_least(&self, cell: u32, values: &[Enclosure; 2]) -> bool {
        let rounding = self.map.rounding();
        let flat = (0..2).all(|k| values[k].radius() < FLAT * rounding[k]);
        flat || self.map.bounds(&cell).iter().all(|side| 2.0 * side.radius() < SMALLEST)
    }

    /// Calls `visit` with the lines of a window.
    fn each(&self, values: &[Enclosure; 2], visit: impl FnMut(usize, [f64; 2])) {
        each(self.lines, values, visit);
    }

    /// The lines over a chart.
    fn chart(
        &mut self,
        (chart, centre): &(Chart, [f64; 2]),
        cell: u32,
        values: &[Enclosure; 2],
        finds: &mut impl Finds,
    ) {
        let Some(sides) = self.map.sides(&cell) else { return };
        let part = chart.half.map(|half| 2.0 * half).into_iter().fold(0.0, f64::max);
        let inside = self.last / (part * part.max(chart.norm())).sqrt();
        let mut over = Over {
            map: self.map,
            chart,
            sides,
            accept: [inside.min(LONGEST).max(self.last), self.last],
            evaluations: 0,
            latest: None,
        };
        let centre = Witness {
            at: [0.0; 2],
            value: [centre[0] + self.tip[0], centre[1] + self.tip[1]],
            q: 0.0,
        };
        each(self.lines, values, |line, place| {
            over.line((line, place), &centre, finds)
        });
        self.evaluations += over.evaluations;
    }
}

fn each(lines: &Lattice, values: &[Enclosure; 2], mut visit: impl FnMut(usize, [f64; 2])) {
    let (Some(is), Some(js)) = (lines.numbers(0, values[0]), lines.numbers(1, values[1])) else {
        return;
    };
    for i in is.0..=is.1 {
        let x = lines.coordinate(0, i);
        for j in js.0..=js.1 {
            if lines.asks(i, j) {
                visit(lines.line(i, j), [x, lines.coordinate(1, j)]);
            }
        }
    }
}

/// The lines of one chart.
struct Over<'a, 'b> {
    map: &'a PlacedMap<'b>,
    chart: &'a Chart,
    /// `g` before and after.
    sides: [Affine<2>; 2],
    /// The longest last step, inside and near a side.
    accept: [f64; 2],
    evaluations: u64,
    latest: Option<Witness>,
}

impl Over<'_, '_> {
    fn at(&mut self, s: [f64; 2]) -> (Witness, Sample<2, OnPlaced>) {
        let sample = self.map.evaluate(&self.chart.point(s));
        self.evaluations += 1;
        let witness = Witness {
            at: s,
            value: sample.value,
            q: 0.0,
        };
        (witness, sample)
    }

    /// Whether both signs are the same all over a region.
    fn agree(&self, region: &Region) -> bool {
        let [a, b] = self
            .sides
            .each_ref()
            .map(|side| side.is_negative(&region.lo, &region.hi));
        a.is_some() && a == b
    }

    /// One line.
    fn line(&mut self, (line, place): (usize, [f64; 2]), centre: &Witness, finds: &mut impl Finds) {
        let chart = self.chart;
        let mut within = chart.region(centre, place, &Region::WHOLE);
        let mut s = chart.prediction(centre, place).0;
        if let Some(latest) = &self.latest {
            within = chart.region(latest, place, &within);
            s = chart.prediction(latest, place).0;
        }
        for _ in 0..STEPS {
            if within.is_empty() || self.agree(&within) {
                return;
            }
            s = within.clamp(s);
            let (here, sample) = self.at(s);
            self.latest = Some(here);
            let jacobian = sample
                .jacobian
                .map(|row| [row[0] * chart.half[0], row[1] * chart.half[1]]);
            let step = solved(&jacobian, [place[0] - here.value[0], place[1] - here.value[1]]);
            let next = step.map(|step| [s[0] + step[0], s[1] + step[1]]);
            let found = |next: [f64; 2], finds: &mut dyn Finds| {
                finds.found(line, chart.point(s), chart.point(next), &sample.seen, chart.jump);
            };
            if let (Some(step), Some(next)) = (step, next)
                && chart.is_close(step, next, self.accept)
                && chart.owns(next)
            {
                return found(next, finds);
            }
            within = chart.region(&here, place, &within);
            let own = chart.variable_rounding();
            if !within.is_empty() && within.is_within(own.map(|own| ON_FACE + 4.0 * own)) {
                // As close as rounding allows.
                return match (step, next) {
                    (Some(_), Some(next)) if chart.owns(next) => found(next, finds),
                    (Some(step), _) if (0..2).all(|i| step[i].abs() <= self.accept[1].max(2.0 * own[i])) => {}
                    _ => finds.open(line),
                };
            }
            s = next.unwrap_or_else(|| chart.prediction(&here, place).0);
        }
        finds.open(line);
    }
}
