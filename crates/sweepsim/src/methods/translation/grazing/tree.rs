//! The cells of a patch along the grazing curves of a family of directions, divided as far as lines have asked for.

use super::chart::{Chart, Range, Rough, magnitude, widened};
use super::directed_motion::Directions;
use crate::algebra::ranges::{ROUNDING, Triples, products};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::{at_pole, pole};

/// Cells with sides smaller than this are not divided.
const SMALLEST: f64 = 1e-14;
/// Nor are those over which `p` changes by fewer roundings than this.
const FLAT: f64 = 8.0;

/// A cell, and where it is in the coordinates `(q, p, z)` from the tip.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub cell: u32,
    depth: u32,
    pub p: Range,
    pub q: Range,
    pub lowest: f64,
    state: State,
}

#[derive(Clone, Copy, Debug)]
enum State {
    Fresh,
    Empty,
    /// Number of the chart.
    Chart(u32),
    /// Number of the first part.
    Parts(u32),
    /// Number of the only part that holds points of the curve.
    Rest(u32),
    /// Not the same for all directions.
    Mixed,
    /// As small as rounding allows.
    Least,
}

/// What is known of a cell.
pub(super) enum Known<'a> {
    Empty,
    Chart(&'a Chart),
    /// The numbers of its parts.
    Parts([u32; 2]),
    /// The number of its only part, which is a cell of its own.
    Rest(u32),
    /// Each direction has to tell by itself.
    Mixed,
    /// The curve may be anywhere in it.
    Least,
}

/// The cells of a patch that were examined for a family of directions.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    charts: Vec<Chart>,
    pub blur: Blur,
}

/// How much the values may differ over the directions of a family.
#[derive(Clone, Debug, Default)]
pub(super) struct Blur {
    pub place: f64,
    /// Of derivatives of the place, and of those of `g`, in each variable.
    pub slopes: [f64; 2],
    pub g: f64,
    pub g_slopes: [f64; 2],
}

/// The sizes of vectors, component by component.
fn sizes(list: &Triples) -> [f64; 3] {
    let most = |list: &[f64]| {
        // NaN stays.
        let larger = |most: f64, x: &f64| {
            if most.is_nan() || x.abs() <= most {
                most
            } else {
                x.abs()
            }
        };
        list.iter().fold(0.0, larger)
    };
    [most(list.x), most(list.y), most(list.z)]
}

/// `Σ |aₖ| bₖ`.
fn total(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|k| a[k].abs() * b[k]).sum()
}

impl Blur {
    fn new((element, cells): (&PatchForms, &mut Cells), cell: u32, directions: &Directions) -> Self {
        if directions.spread == 0.0 {
            return Self::default();
        }
        cells.prepare(element, cell);
        let one = [directions.spread; 3];
        let missing = cells.missing(cell);
        Self {
            place: total(&one, &sizes(&cells.position(element, cell))),
            slopes: [0, 1].map(|axis| {
                total(&one, &sizes(&cells.slope(element, cell, axis))) + total(&one, &missing.tangents[axis])
            }),
            g: total(&one, &element.largest[1]),
            g_slopes: [0, 1].map(|axis| {
                let [normals, _] = cells.field_slope(cell, 0, axis);
                total(&one, &sizes(&normals)) + total(&one, &missing.slopes[axis][1])
            }),
        }
    }
}

/// The bound of the rounding error of `g` on a cell of a patch.
fn error(element: &PatchForms, [u, v]: [Range; 2], directions: &Directions) -> f64 {
    let rounding = element.rounding_in([u.0, v.0], [u.1, v.1]);
    ROUNDING * total(&directions.way, &rounding[1])
}

/// The range of `⟨way, N⟩` over all coefficients of `N`, and what these lack.
fn envelope_of([normals, _]: &[Triples; 2], [_, missing]: &[[f64; 3]; 2], directions: &Directions) -> Range {
    widened(products(&[directions.way], normals), total(&directions.way, missing))
}

/// The range of `g` on a cell, but for rounding.
fn g(element: &PatchForms, cells: &Cells, cell: u32, directions: &Directions) -> Range {
    let fields = cells.field(element, cell, 0);
    envelope_of(&fields, &cells.missing(cell).value, directions)
}

/// The ranges of its derivatives on a prepared cell, for all directions that differ by so much.
fn slopes_of_g(cells: &Cells, cell: u32, directions: &Directions, blur: &[f64; 2]) -> [Range; 2] {
    [0, 1].map(|axis| {
        let fields = cells.field_slope(cell, 0, axis);
        let range = envelope_of(&fields, &cells.missing(cell).slopes[axis], directions);
        widened(range, blur[axis])
    })
}

/// The direction in which a small cell at a pole is divided. Across it, what is left at the pole would have to be divided again and again: as `p` and `g` have the distance from the pole as a
/// factor, the cell becomes no more regular by that.
fn towards_pole(element: &PatchForms, bounds: [Range; 2]) -> Option<usize> {
    /// Of the patch's sides: towards the pole, and across.
    const SMALL: [f64; 2] = [1.0 / 16.0, 0.25];
    let side = |axis: usize| bounds[axis].1 - bounds[axis].0;
    pole(&element.poles, bounds).filter(|axis| side(*axis) < SMALL[0] && side(1 - axis) <= SMALL[1])
}

impl Tree {
    /// Of all of a cell.
    pub fn new(
        element: &PatchForms,
        cells: &mut Cells,
        cell: u32,
        directions: &Directions,
        system_rounding: f64,
    ) -> Self {
        let blur = Blur::new((element, cells), cell, directions);
        let mut tree = Self {
            nodes: Vec::new(),
            charts: Vec::new(),
            blur,
        };
        tree.put((element, cells), (cell, 0), directions, system_rounding);
        tree
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn node(&self, number: u32) -> &Node {
        &self.nodes[number as usize]
    }

    fn put(
        &mut self,
        (element, cells): (&PatchForms, &Cells),
        (cell, depth): (u32, u32),
        directions: &Directions,
        system_rounding: f64,
    ) {
        let position = cells.position(element, cell);
        let off = self.blur.place + system_rounding;
        let [q, p] = [0, 1].map(|k| widened(products(&[directions.rows[k]], &position), off));
        let (lowest, _) = products(&[directions.rows[2]], &position);
        let node = Node {
            cell,
            depth,
            q,
            p,
            lowest: lowest - self.blur.place - system_rounding,
            state: State::Fresh,
        };
        self.nodes.push(node);
    }

    /// What is known of a cell, after a look at it if there was none; `looks` counts these.
    pub fn known(
        &mut self,
        number: u32,
        (element, cells): (&PatchForms, &mut Cells),
        (directions, system_rounding): (&Directions, f64),
        looks: &mut u64,
    ) -> Known<'_> {
        if let State::Fresh = self.nodes[number as usize].state {
            *looks += 1;
            let state = self.examined(number, (element, cells), directions, system_rounding);
            self.nodes[number as usize].state = state;
        }
        match self.nodes[number as usize].state {
            State::Fresh | State::Least => Known::Least,
            State::Empty => Known::Empty,
            State::Chart(chart) => Known::Chart(&self.charts[chart as usize]),
            State::Parts(first) => Known::Parts([first, first + 1]),
            State::Rest(rest) => Known::Rest(rest),
            State::Mixed => Known::Mixed,
        }
    }

    fn examined(
        &mut self,
        number: u32,
        (element, cells): (&PatchForms, &mut Cells),
        directions: &Directions,
        system_rounding: f64,
    ) -> State {
        let Node { cell, depth, p, .. } = self.nodes[number as usize];
        let (lo, hi) = g(element, cells, cell, directions);
        let bounds = [0, 1].map(|axis| cells.bounds(cell, axis));
        let (error, blur_of_g) = (error(element, bounds, directions), self.blur.g);
        let within = error + blur_of_g;
        // Where g is exactly 0, it counts as not negative.
        let zero = lo == 0.0 && hi == 0.0;
        if lo > within || hi < -within || (zero && directions.spread == 0.0) {
            return State::Empty;
        }
        if lo > error || hi < -error || zero {
            return State::Mixed;
        }
        cells.prepare(element, cell);
        let Blur {
            slopes: place_slopes,
            g_slopes,
            ..
        } = &self.blur;
        let of_place = [0, 1].map(|axis| directions.slopes((element, cells, cell), (axis, place_slopes[axis])));
        let [[q_u, p_u], [q_v, p_v]] = of_place;
        let of_g = slopes_of_g(cells, cell, directions, g_slopes);
        let jacobian = [[p_u, p_v], of_g];
        let (lower, upper) = (bounds.map(|b| b.0), bounds.map(|b| b.1));
        let blur = [*place_slopes, *g_slopes];
        let rough = match Chart::new([lower, upper], &jacobian, &blur, [system_rounding, error], [q_u, q_v]) {
            Ok(chart) => return self.chart(chart),
            Err(rough) => rough,
        };
        let rest = at_pole(&element.poles, bounds, (widened((lo, hi), within), of_g), |[u, v]| {
            let part = cells.place(element, [u.0, v.0], [u.1, v.1]);
            let (lo, hi) = g(element, cells, part, directions);
            let within = self::error(element, [u, v], directions) + blur_of_g;
            let found = (lo <= within && hi >= -within).then(|| {
                cells.prepare(element, part);
                (
                    widened((lo, hi), within),
                    slopes_of_g(cells, part, directions, g_slopes),
                )
            });
            cells.release(part as usize);
            found
        });
        if let Some([u, v]) = rest {
            let part = cells.place(element, [u.0, v.0], [u.1, v.1]);
            self.put((element, cells), (part, depth + 1), directions, system_rounding);
            return State::Rest(self.nodes.len() as u32 - 1);
        }
        let sides = [0, 1].map(|axis| upper[axis] - lower[axis]);
        let small = sides.iter().all(|side| *side < SMALLEST);
        if directions.spread > 0.0 && (rough.blurred || small) {
            return State::Mixed;
        }
        if small || p.1 - p.0 - 2.0 * system_rounding < FLAT * system_rounding {
            return State::Least;
        }
        let axis = towards_pole(element, bounds).unwrap_or_else(|| divided(&jacobian, sides, depth, &rough));
        self.divide((element, cells), (cell, depth, axis), directions, system_rounding)
    }

    fn chart(&mut self, chart: Chart) -> State {
        self.charts.push(chart);
        State::Chart(self.charts.len() as u32 - 1)
    }

    fn divide(
        &mut self,
        (element, cells): (&PatchForms, &mut Cells),
        (cell, depth, axis): (u32, u32, usize),
        directions: &Directions,
        system_rounding: f64,
    ) -> State {
        let parts = cells.split(element, cell, axis);
        let first = self.nodes.len() as u32;
        for part in parts {
            self.put((element, cells), (part, depth + 1), directions, system_rounding);
        }
        State::Parts(first)
    }
}

/// The direction in which a cell is divided: as in `charts/`, the one that contributes most to `R`, every third time the one in which the values change most; but not the one in which it has
/// almost no length.
pub(super) fn divided(jacobian: &[[Range; 2]; 2], sides: [f64; 2], depth: u32, rough: &Rough) -> usize {
    let larger = |[a, b]: [f64; 2]| usize::from(b > a);
    let sizes = jacobian.map(|row| [0, 1].map(|j: usize| magnitude(row[j]) * sides[j]));
    let share = |row: [f64; 2], j: usize| {
        let most = row[0].max(row[1]);
        if most > 0.0 { row[j] / most } else { 0.0 }
    };
    let widest = larger([0, 1].map(|j| share(sizes[0], j) + share(sizes[1], j)));
    let collapses = |axis: usize| {
        (0..2).all(|i| {
            let most = sizes[i][0].max(sizes[i][1]);
            let least = jacobian[i][axis].0.max(-jacobian[i][axis].1).max(0.0) * sides[axis];
            sizes[i][axis] < 0.25 * most && least < 1e-3 * most
        })
    };
    let wanted = match rough.smear {
        Some(smear) if depth % 3 != 2 => larger(smear),
        _ => widest,
    };
    let axis = if collapses(wanted) { 1 - wanted } else { wanted };
    // One side may be as short as it can be.
    if sides[axis] < SMALLEST { 1 - axis } else { axis }
}
