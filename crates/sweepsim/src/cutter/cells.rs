//! The cells that a patch or an edge is cut into, on demand.

use crate::algebra::nodes::{Divided, Recent, drop_from};
use crate::algebra::ranges::{Triples, all_or_none, products};
use crate::cutter::patch_forms::{PatchForms, Slot};
use crate::cutter::reduced::Missing;
use crate::cutter::tangents::Tangents;
use sweepsim_solve::CUT;
use sweepsim_spline::kernel;

const NONE: u32 = u32::MAX;

#[derive(Clone, Debug)]
struct CellNode {
    lower: [f64; 2],
    upper: [f64; 2],
    /// First of the two parts, per axis.
    parts: [u32; 2],
    /// The homogeneous tensors.
    c: Vec<f64>,
    /// Control points of position and slopes, in the places of their numerators in `c`; derivatives of the fields.
    points: Vec<f64>,
    /// Whether slopes and derivatives are there: see [`Cells::prepare`].
    prepared: bool,
    /// Whether the fields are those of [`PatchForms::sample`], and no parts of them are needed.
    sampled: bool,
    /// What reduced fields lack.
    missing: Missing,
}

impl Divided for CellNode {
    fn forget_parts(&mut self, from: u32) {
        self.parts = self.parts.map(|part| if part < from { part } else { NONE });
    }
}

/// The lists of a cell.
#[derive(Clone, Debug, Default)]
struct Buffers {
    c: Vec<f64>,
    points: Vec<f64>,
}

/// The cells of one element, created on demand and kept.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    nodes: Vec<CellNode>,
    recent: Recent,
    /// The memory of released cells.
    spare: Vec<Buffers>,
    /// Per field and axis, the position and length of the derivatives of N and M in `points`.
    derivatives: Vec<[(usize, usize); 2]>,
    points: usize,
}

/// The memory of so many released cells is kept: most of them are parts of others, which take none of it.
const SPARE: usize = 16;
/// Cells beyond this number are not kept for the next search.
const KEPT: usize = 4096;

impl Cells {
    pub fn new(element: &PatchForms) -> Self {
        let layout = &element.layout;
        let mut points = layout.fields.first().map_or(layout.len, |slot| slot.start);
        if element.tangents.is_some() {
            points += layout.slopes.len() * 3 * Tangents::POINTS;
        }
        let derivatives = layout
            .fields
            .iter()
            .map(|slot| {
                [0, 1].map(|axis| {
                    let mut degrees = slot.degrees;
                    degrees[axis] = degrees[axis].saturating_sub(1);
                    let len = (degrees[0] + 1) * (degrees[1] + 1);
                    let start = points;
                    if axis < layout.slopes.len() {
                        points += 6 * len;
                    }
                    (start, len)
                })
            })
            .collect();
        let mut cells = Self {
            nodes: Vec::new(),
            recent: Recent::default(),
            spare: Vec::new(),
            derivatives,
            points,
        };
        let whole = Buffers {
            c: element.whole.clone(),
            points: Vec::new(),
        };
        let root = cells.node(element, [0.0; 2], [1.0; 2], whole, None);
        cells.nodes.push(root);
        cells
    }

    /// Drops cells if there are many, and returns whether it does.
    pub fn trim(&mut self) -> bool {
        let is_long = self.nodes.len() > KEPT;
        if is_long {
            drop_from(&mut self.nodes, 1);
        }
        is_long
    }

    /// A search begins.
    pub fn begin(&mut self) {
        self.recent = Recent::begin(self.nodes.len());
    }

    /// Whether the search has made too many cells.
    pub fn is_full(&self) -> bool {
        self.recent.is_full(self.nodes.len())
    }

    /// Drops the cells that the search has made, except for those that it still needs: see [`Recent::keep`].
    pub fn keep<'a>(&mut self, needed: impl Iterator<Item = &'a mut u32>) {
        self.recent.keep(&mut self.nodes, needed);
    }

    /// A separate cell over any box, kept until it is [released](Self::release).
    pub fn place(&mut self, element: &PatchForms, lower: [f64; 2], upper: [f64; 2]) -> u32 {
        let layout = &element.layout;
        let mut spare = self.spare.pop().unwrap_or_default();
        spare.c.resize(layout.len, 0.0);
        // Reduced slopes and fields are not parts of the whole patch's.
        for (slot, count) in layout.tensors(element.tangents.is_none(), element.reduced.is_none()) {
            let range = slot.start..slot.start + count * slot.len();
            kernel::restrict_rectangle(
                &element.whole[range.clone()],
                slot.degrees,
                lower,
                upper,
                &mut spare.c[range],
            );
        }
        let node = self.node(element, lower, upper, spare, None);
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// The number of cells, as a mark for releasing later ones.
    pub fn mark(&self) -> usize {
        self.nodes.len()
    }

    /// Drops the cells created since the mark: placed ones, and their parts.
    pub fn release(&mut self, mark: usize) {
        let released = self.nodes.drain(mark.min(self.nodes.len())..);
        let room = SPARE.saturating_sub(self.spare.len());
        self.spare.extend(released.take(room).map(|node| Buffers {
            c: node.c,
            points: node.points,
        }));
    }

    /// The cell with these homogeneous tensors, its control points put into the other buffer. `missing`: of reduced fields that are parts of a larger cell's;
    /// they are reduced again if that is too much.
    fn node(
        &mut self,
        element: &PatchForms,
        lower: [f64; 2],
        upper: [f64; 2],
        buffers: Buffers,
        missing: Option<Missing>,
    ) -> CellNode {
        let layout = &element.layout;
        let Buffers { mut c, mut points } = buffers;
        let mut own = missing.unwrap_or_default();
        let widths = [0, 1].map(|axis| upper[axis] - lower[axis]);
        let mut sampled = None;
        if let Some(tangents) = &element.tangents {
            let start = layout.slopes[0].start;
            points.resize(start + layout.slopes.len() * 3 * Tangents::POINTS, 0.0);
            sampled = element.sample((lower, upper), &mut c[layout.fields[0].start..], &mut points[start..]);
            for slot in &layout.slopes {
                all_or_none(&mut points[slot.start..][..3 * slot.len()]);
            }
            own = sampled.unwrap_or(own);
            own.tangents = tangents.missing(lower, upper);
        } else {
            points.resize(layout.position.start + 3 * layout.position.len(), 0.0);
        }
        if let (Some(reduced), [slot], None) = (&element.reduced, &layout.fields[..], sampled) {
            let forms = &mut c[slot.start..][..6 * slot.len()];
            if missing.is_none_or(|missing| missing.is_coarse(forms, slot.degrees, widths, reduced.vanishes)) {
                own = Missing {
                    tangents: own.tangents,
                    ..reduced.on(lower, upper, forms)
                };
            }
        }
        for slot in &layout.fields {
            all_or_none(&mut c[slot.start..][..6 * slot.len()]);
        }
        control_points(&layout.position, &c, &mut points);
        CellNode {
            lower,
            upper,
            parts: [NONE; 2],
            c,
            points,
            prepared: false,
            sampled: sampled.is_some(),
            missing: own,
        }
    }

    /// Computes the control points of slopes and the derivatives of fields of a cell: many cells are dropped without them.
    pub fn prepare(&mut self, element: &PatchForms, cell: u32) {
        let layout = &element.layout;
        let CellNode {
            lower,
            upper,
            c,
            points,
            prepared,
            ..
        } = &mut self.nodes[cell as usize];
        if *prepared {
            return;
        }
        *prepared = true;
        points.resize(self.points, 0.0);
        if element.tangents.is_none() {
            for slot in &layout.slopes {
                control_points(slot, c, points);
            }
        }
        for (slot, derivatives) in layout.fields.iter().zip(&self.derivatives) {
            for (axis, (start, len)) in derivatives.iter().enumerate().take(layout.slopes.len()) {
                let p = slot.degrees[0];
                let n = slot.degrees[axis];
                if n == 0 {
                    continue;
                }
                let factor = n as f64 / (upper[axis] - lower[axis]);
                let tensors = c[slot.start..][..6 * slot.len()].chunks_exact(slot.len());
                for (tensor, out) in tensors.zip(points[*start..][..6 * len].chunks_exact_mut(*len)) {
                    if axis == 0 {
                        for (line, out) in tensor.chunks_exact(p + 1).zip(out.chunks_exact_mut(p)) {
                            for (out, pair) in out.iter_mut().zip(line.windows(2)) {
                                *out = factor * (pair[1] - pair[0]);
                            }
                        }
                    } else {
                        for ((out, next), this) in out.iter_mut().zip(&tensor[p + 1..]).zip(tensor) {
                            *out = factor * (next - this);
                        }
                    }
                }
            }
        }
    }

    pub fn bounds(&self, cell: u32, axis: usize) -> (f64, f64) {
        let node = &self.nodes[cell as usize];
        (node.lower[axis], node.upper[axis])
    }

    /// The two parts of a cell.
    pub fn split(&mut self, element: &PatchForms, cell: u32, axis: usize) -> [u32; 2] {
        let first = self.nodes[cell as usize].parts[axis];
        if first != NONE {
            return [first, first + 1];
        }
        let node = &self.nodes[cell as usize];
        let (mut lower, mut upper) = (node.c.clone(), node.c.clone());
        let points = self.points;
        // With room for what `prepare` adds.
        let buffers = |c| Buffers {
            c,
            points: Vec::with_capacity(points),
        };
        let layout = &element.layout;
        for (slot, count) in layout.tensors(element.tangents.is_none(), !node.sampled) {
            let range = slot.start..slot.start + count * slot.len();
            let (low, high) = (&mut lower[range.clone()], &mut upper[range.clone()]);
            let inner = if axis == 0 { 1 } else { slot.degrees[0] + 1 };
            kernel::split_at(high, low, slot.degrees[axis], inner, CUT);
        }
        let at = node.lower[axis] + CUT * (node.upper[axis] - node.lower[axis]);
        let (mut low_end, mut high_start) = (node.upper, node.lower);
        low_end[axis] = at;
        high_start[axis] = at;
        let (start, end, missing) = (node.lower, node.upper, node.missing);
        let low = self.node(element, start, low_end, buffers(lower), Some(missing));
        let high = self.node(element, high_start, end, buffers(upper), Some(missing));
        let first = self.nodes.len() as u32;
        self.nodes.push(low);
        self.nodes.push(high);
        self.nodes[cell as usize].parts[axis] = first;
        [first, first + 1]
    }

    /// Control points of the position.
    pub fn position<'a>(&'a self, element: &PatchForms, cell: u32) -> Triples<'a> {
        let slot = &element.layout.position;
        Triples::new(&self.nodes[cell as usize].points, slot.start, slot.len())
    }

    /// The weights of these points, and their degrees.
    pub fn weights(&self, element: &PatchForms, cell: u32) -> (&[f64], [usize; 2]) {
        let slot = &element.layout.position;
        let len = slot.len();
        let c = &self.nodes[cell as usize].c;
        (&c[slot.start + 3 * len..][..len], slot.degrees)
    }

    /// The range of products of rows with the derivative of the position, in a [prepared](Self::prepare) cell.
    pub fn slope_products(&self, element: &PatchForms, cell: u32, axis: usize, rows: &[[f64; 3]]) -> (f64, f64) {
        let (lo, hi) = products(rows, &self.slope(element, cell, axis));
        if element.tangents.is_none() {
            return (lo, hi);
        }
        let lacking = self.nodes[cell as usize].missing.tangents[axis];
        let by = |row: &[f64; 3]| row[0].abs() * lacking[0] + row[1].abs() * lacking[1] + row[2].abs() * lacking[2];
        let error = rows.iter().map(by).fold(0.0, f64::max);
        (lo - error, hi + error)
    }

    /// Control points of the derivative of the position, up to what [`missing`](Self::missing) tells, in a [prepared](Self::prepare) cell.
    pub fn slope<'a>(&'a self, element: &PatchForms, cell: u32, axis: usize) -> Triples<'a> {
        debug_assert!(self.nodes[cell as usize].prepared);
        let slot = &element.layout.slopes[axis];
        Triples::new(&self.nodes[cell as usize].points, slot.start, slot.len())
    }

    /// Coefficients of `N` and `M` of a field.
    pub fn field<'a>(&'a self, element: &PatchForms, cell: u32, field: usize) -> [Triples<'a>; 2] {
        let slot = &element.layout.fields[field];
        let c = &self.nodes[cell as usize].c;
        [
            Triples::new(c, slot.start, slot.len()),
            Triples::new(c, slot.start + 3 * slot.len(), slot.len()),
        ]
    }

    /// What the forms of reduced fields lack: their ranges hold those of the fields when widened by it.
    pub fn missing(&self, cell: u32) -> &Missing {
        &self.nodes[cell as usize].missing
    }

    /// Coefficients of the derivatives of `N` and `M` of a field, in a [prepared](Self::prepare) cell.
    pub fn field_slope(&self, cell: u32, field: usize, axis: usize) -> [Triples<'_>; 2] {
        debug_assert!(self.nodes[cell as usize].prepared);
        let (start, len) = self.derivatives[field][axis];
        let points = &self.nodes[cell as usize].points;
        [
            Triples::new(points, start, len),
            Triples::new(points, start + 3 * len, len),
        ]
    }
}

/// The control points of a slot, from its homogeneous tensors.
fn control_points(slot: &Slot, c: &[f64], points: &mut [f64]) {
    let len = slot.len();
    let of = &c[slot.start..][..4 * len];
    let out = &mut points[slot.start..][..3 * len];
    let (x, rest) = out.split_at_mut(len);
    let (y, z) = rest.split_at_mut(len);
    for i in 0..len {
        let inverse = 1.0 / of[3 * len + i];
        x[i] = of[i] * inverse;
        y[i] = of[len + i] * inverse;
        z[i] = of[2 * len + i] * inverse;
    }
    all_or_none(&mut points[slot.start..][..3 * len]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::Tool;

    /// A search that narrows many boxes, and divides what is left of each, keeps the memory of a few only.
    #[test]
    fn memory_of_released_cells_does_not_grow() {
        let (patches, _) = PatchForms::all(&Tool::ball(2.0, 7.0).unwrap());
        for element in &patches {
            let mut cells = Cells::new(element);
            for round in 0..100 {
                let mark = cells.mark();
                let mut cell = cells.place(element, [0.25; 2], [0.5; 2]);
                for axis in [0, 1, 0, 1] {
                    [cell, _] = cells.split(element, cell, axis);
                }
                cells.release(mark);
                assert!(cells.spare.len() <= SPARE && cells.nodes.len() == mark, "{round}");
            }
        }
    }
}
