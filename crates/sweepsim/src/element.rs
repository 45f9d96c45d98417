//! What is swept: patches and edges of a tool, prepared once per tool, and cut into cells on demand.
//!
//! Only the tool enters here, no motion: the cells of `(u, v)` serve all segments of a path. Each cell keeps the *control
//! points* (coefficient over weight) of `F`, `F_u`, `F_v`, so that a rotated coordinate is bounded by dot products, and the
//! coefficients of the normals `N`, their moments `M = F × N`, and the derivatives of both.

use crate::form::{Form, MOST, basis, cut, restrict};
use crate::point::{FacePoint, FieldPoint, RimPoint, revolved};
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Edge, NormalField, Patch, Revolved, Tool};

/// Cuts are off the middle, so that what is symmetric does not lie on them.
pub(crate) const CUT: f64 = 0.492;

/// Degrees and place of a coefficient tensor in a cell's list.
#[derive(Clone, Copy, Debug)]
struct Slot {
    degrees: [usize; 2],
    start: usize,
}

impl Slot {
    fn len(&self) -> usize {
        (self.degrees[0] + 1) * (self.degrees[1] + 1)
    }

    fn range(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.len()
    }
}

/// A patch (two variables, one field of normals) or an edge (one variable, the normals of both its faces).
#[derive(Clone, Debug)]
pub(crate) struct Element {
    /// Homogeneous tensors of the whole element: see [`Layout`].
    whole: Vec<f64>,
    layout: Layout,
    /// Largest coefficients of `N` and `M`.
    pub largest_normal: f64,
    pub largest_moment: f64,
    /// A shorter way to its points, where there is one.
    revolved: Option<Revolved>,
}

/// The tensors of a cell: position x, y, z, weight; then per variable the same of the derivative; then per field N, M.
#[derive(Clone, Debug)]
struct Layout {
    position: Slot,
    slopes: Vec<Slot>,
    fields: Vec<Slot>,
    len: usize,
}

impl Element {
    pub fn all(tool: &Tool) -> (Vec<Self>, Vec<Self>) {
        (
            tool.patches().iter().map(Self::patch).collect(),
            tool.edges().iter().map(Self::edge).collect(),
        )
    }

    fn patch(patch: &Patch) -> Self {
        let element = Self::new(&patch.position, &patch.weight, &[&patch.field], 2);
        Self {
            revolved: patch.revolved.clone(),
            ..element
        }
    }

    fn edge(edge: &Edge) -> Self {
        Self::new(&edge.position, &edge.weight, &[&edge.before, &edge.after], 1)
    }

    fn new(
        position: &[sweepsim_spline::Bernstein; 3],
        weight: &sweepsim_spline::Bernstein,
        fields: &[&NormalField],
        variables: usize,
    ) -> Self {
        let point = [0, 1, 2].map(|k| Form::of(&position[k]));
        let weight = Form::of(weight);
        let mut whole = Vec::new();
        let mut put = |forms: &[Form]| {
            let degrees = [0, 1].map(|a| forms.iter().map(|f| f.degrees[a]).max().unwrap_or(0));
            let start = whole.len();
            for form in forms {
                whole.extend(form.raised(degrees).c);
            }
            Slot { degrees, start }
        };
        let [x, y, z] = point.clone();
        let position = put(&[x, y, z, weight.clone()]);
        let slopes = (0..variables)
            .map(|axis| {
                // With ω = ω₁(u) ω₂(v): F_u = (F̂_u ω₁ − F̂ ω₁′) / (ω₁² ω₂).
                let (own, other) = match weight.factors() {
                    Some([in_u, in_v]) if axis == 0 => (in_u, Some(in_v)),
                    Some([in_u, in_v]) => (in_v, Some(in_u)),
                    None => (weight.clone(), None),
                };
                let numerator = |f: &Form| f.derivative(axis).times(&own).minus(&f.times(&own.derivative(axis)));
                let square = own.times(&own);
                let denominator = other.map_or(square.clone(), |o| square.times(&o));
                put(&[
                    numerator(&point[0]),
                    numerator(&point[1]),
                    numerator(&point[2]),
                    denominator,
                ])
            })
            .collect();
        let mut largest = [0.0_f64; 2];
        let fields = fields
            .iter()
            .map(|field| {
                let forms: Vec<Form> = field.normal.iter().chain(&field.moment).map(Form::of).collect();
                for (k, form) in forms.iter().enumerate() {
                    largest[k / 3] = largest[k / 3].max(form.largest());
                }
                put(&forms)
            })
            .collect();
        let layout = Layout {
            position,
            slopes,
            fields,
            len: whole.len(),
        };
        Self {
            whole,
            layout,
            largest_normal: largest[0],
            largest_moment: largest[1],
            revolved: None,
        }
    }

    /// A point of a patch, in the frame of [`Element::frame`].
    pub fn face(&self, [u, v]: [f64; 2]) -> FacePoint {
        match &self.revolved {
            Some(revolution) => revolved(revolution, u, v),
            None => self.face_in_general([u, v]),
        }
    }

    /// The frame of the points of [`Element::face`] in the tool; `None` when it is the tool's.
    pub fn frame(&self) -> Option<&(Matrix3<f64>, Vector3<f64>)> {
        self.revolved.as_ref().and_then(|revolution| revolution.frame.as_ref())
    }

    /// The point of a patch, from its tensors.
    fn face_in_general(&self, at: [f64; 2]) -> FacePoint {
        let (position, slopes) = self.position_at(at);
        FacePoint {
            position,
            slopes,
            field: self.field_at(0, at),
        }
    }

    /// The point of an edge.
    pub fn rim(&self, r: f64) -> RimPoint {
        let at = [r, 0.0];
        let (position, slopes) = self.position_at(at);
        RimPoint {
            position,
            slope: slopes[0],
            fields: [self.field_at(0, at), self.field_at(1, at)],
        }
    }

    fn position_at(&self, at: [f64; 2]) -> (Vector3<f64>, [Vector3<f64>; 2]) {
        let sums = self.sums::<4>(&self.layout.position, at);
        let value = Vector3::new(sums[0][0], sums[1][0], sums[2][0]) / sums[3][0];
        let slope = |d: usize| (Vector3::new(sums[0][d], sums[1][d], sums[2][d]) - value * sums[3][d]) / sums[3][0];
        (value, [slope(1), slope(2)])
    }

    fn field_at(&self, field: usize, at: [f64; 2]) -> FieldPoint {
        let sums = self.sums::<6>(&self.layout.fields[field], at);
        let vector = |first: usize, d: usize| Vector3::new(sums[first][d], sums[first + 1][d], sums[first + 2][d]);
        FieldPoint {
            normal: [0, 1, 2].map(|d| vector(0, d)),
            moment: [0, 1, 2].map(|d| vector(3, d)),
        }
    }

    /// Value and both derivatives of `COUNT` tensors in a row.
    fn sums<const COUNT: usize>(&self, slot: &Slot, at: [f64; 2]) -> [[f64; 3]; COUNT] {
        let [p, q] = slot.degrees;
        let c = &self.whole[slot.start..][..COUNT * slot.len()];
        match (p, q) {
            (2, 0) => sums_of::<COUNT, 3, 1>(c, at),
            (2, 1) => sums_of::<COUNT, 3, 2>(c, at),
            (2, 2) => sums_of::<COUNT, 3, 3>(c, at),
            _ => sums_in_general::<COUNT>(c, slot.degrees, at),
        }
    }
}

/// As [`sums_in_general`], for degrees `P − 1` and `Q − 1` known to the compiler.
fn sums_of<const COUNT: usize, const P: usize, const Q: usize>(c: &[f64], at: [f64; 2]) -> [[f64; 3]; COUNT] {
    let mut sums = [[0.0; 3]; COUNT];
    let ([a, da], [b, db]) = (small_basis::<P>(at[0]), small_basis::<Q>(at[1]));
    for (sum, c) in sums.iter_mut().zip(c.chunks_exact(P * Q)) {
        for j in 0..Q {
            let (mut value, mut slope) = (0.0, 0.0);
            for i in 0..P {
                value += a[i] * c[i + P * j];
                slope += da[i] * c[i + P * j];
            }
            sum[0] += b[j] * value;
            sum[1] += b[j] * slope;
            sum[2] += db[j] * value;
        }
    }
    sums
}

/// Bernstein polynomials of degree `N − 1 ≤ 2` and their derivatives.
fn small_basis<const N: usize>(x: f64) -> [[f64; N]; 2] {
    let y = 1.0 - x;
    let mut both = [[0.0; N]; 2];
    let (values, slopes): (&[f64], &[f64]) = match N {
        1 => (&[1.0], &[0.0]),
        2 => (&[y, x], &[-1.0, 1.0]),
        _ => (&[y * y, 2.0 * x * y, x * x], &[-2.0 * y, 2.0 * (y - x), 2.0 * x]),
    };
    both[0].copy_from_slice(values);
    both[1].copy_from_slice(slopes);
    both
}

/// Value and both derivatives of `COUNT` tensors of any degrees.
fn sums_in_general<const COUNT: usize>(c: &[f64], [p, q]: [usize; 2], at: [f64; 2]) -> [[f64; 3]; COUNT] {
    let mut sums = [[0.0; 3]; COUNT];
    let mut bases = [[0.0; MOST]; 4];
    let [a, da, b, db] = &mut bases;
    basis(p, at[0], a, da);
    basis(q, at[1], b, db);
    for (sum, c) in sums.iter_mut().zip(c.chunks_exact((p + 1) * (q + 1))) {
        for (j, row) in c.chunks_exact(p + 1).enumerate() {
            let (mut value, mut slope) = (0.0, 0.0);
            for i in 0..=p {
                value += a[i] * row[i];
                slope += da[i] * row[i];
            }
            sum[0] += b[j] * value;
            sum[1] += b[j] * slope;
            sum[2] += db[j] * value;
        }
    }
    sums
}

/// A vector-valued list of coefficients: x, y and z apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triples<'a> {
    pub x: &'a [f64],
    pub y: &'a [f64],
    pub z: &'a [f64],
}

impl<'a> Triples<'a> {
    fn new(list: &'a [f64], start: usize, len: usize) -> Self {
        let (x, rest) = list[start..start + 3 * len].split_at(len);
        let (y, z) = rest.split_at(len);
        Self { x, y, z }
    }

    /// `⟨a, cᵢ⟩`.
    pub fn dot(&self, a: &[f64; 3], i: usize) -> f64 {
        a[0] * self.x[i] + a[1] * self.y[i] + a[2] * self.z[i]
    }

    pub fn len(&self) -> usize {
        self.x.len()
    }
}

const NONE: u32 = u32::MAX;

#[derive(Clone, Debug)]
struct Node {
    lower: [f64; 2],
    upper: [f64; 2],
    /// First of the two parts, per axis.
    parts: [u32; 2],
    /// The homogeneous tensors.
    c: Vec<f64>,
    /// Control points of position and slopes, in the places of their numerators in `c`; derivatives of the fields.
    points: Vec<f64>,
}

/// The lists of a cell.
#[derive(Clone, Debug, Default)]
struct Buffers {
    c: Vec<f64>,
    points: Vec<f64>,
}

/// The cells of one element, made on demand and kept.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    nodes: Vec<Node>,
    /// Of released cells.
    spare: Vec<Buffers>,
    /// Per field and axis, where the derivatives of N and M stand in `points`, and how long each is.
    derivatives: Vec<[(usize, usize); 2]>,
    points: usize,
}

/// More cells than this are not kept for the next segment.
const KEPT: usize = 4096;

impl Cells {
    pub fn new(element: &Element) -> Self {
        let layout = &element.layout;
        let mut points = layout.fields.first().map_or(layout.len, |slot| slot.start);
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
            spare: Vec::new(),
            derivatives,
            points,
        };
        let whole = Buffers {
            c: element.whole.clone(),
            points: Vec::new(),
        };
        let root = cells.node(element, [0.0; 2], [1.0; 2], whole);
        cells.nodes.push(root);
        cells
    }

    /// Forgets cells when there are many.
    pub fn trim(&mut self) {
        if self.nodes.len() > KEPT {
            self.nodes.truncate(1);
            self.nodes[0].parts = [NONE; 2];
        }
    }

    /// A cell of its own, over any box; it is kept until it is [released](Self::release).
    pub fn place(&mut self, element: &Element, lower: [f64; 2], upper: [f64; 2]) -> u32 {
        let layout = &element.layout;
        let mut spare = self.spare.pop().unwrap_or_default();
        spare.c.resize(layout.len, 0.0);
        let rational = std::iter::once(&layout.position)
            .chain(&layout.slopes)
            .map(|slot| (slot, 4));
        for (slot, count) in rational.chain(layout.fields.iter().map(|slot| (slot, 6))) {
            let range = slot.start..slot.start + count * slot.len();
            restrict(
                &element.whole[range.clone()],
                slot.degrees,
                lower,
                upper,
                &mut spare.c[range],
            );
        }
        let node = self.node(element, lower, upper, spare);
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// How many cells there are, to release those that come after.
    pub fn mark(&self) -> usize {
        self.nodes.len()
    }

    /// Forgets the cells made since the mark: placed ones, and what they were split into.
    pub fn release(&mut self, mark: usize) {
        let released = self.nodes.drain(mark..);
        self.spare.extend(released.map(|node| Buffers {
            c: node.c,
            points: node.points,
        }));
    }

    /// The cell with these homogeneous tensors, its control points put into the other buffer.
    fn node(&self, element: &Element, lower: [f64; 2], upper: [f64; 2], buffers: Buffers) -> Node {
        let layout = &element.layout;
        let Buffers { c, mut points } = buffers;
        points.resize(self.points, 0.0);
        for slot in std::iter::once(&layout.position).chain(&layout.slopes) {
            let len = slot.len();
            let (numerators, weights) = c[slot.start..][..4 * len].split_at(3 * len);
            let own = &mut points[slot.start..][..3 * len];
            for (points, numerators) in own.chunks_exact_mut(len).zip(numerators.chunks_exact(len)) {
                for ((point, numerator), weight) in points.iter_mut().zip(numerators).zip(weights) {
                    *point = numerator / weight;
                }
            }
        }
        for (slot, derivatives) in layout.fields.iter().zip(&self.derivatives) {
            for (axis, (start, len)) in derivatives.iter().enumerate().take(layout.slopes.len()) {
                let n = slot.degrees[axis];
                if n == 0 {
                    continue;
                }
                let factor = n as f64 / (upper[axis] - lower[axis]);
                let tensors = &c[slot.start..][..6 * slot.len()];
                // Along the first axis neighbours are next to each other, along the second a row apart.
                let (row, next) = if axis == 0 {
                    (n + 1, 1)
                } else {
                    (slot.len(), slot.degrees[0] + 1)
                };
                let out = points[*start..][..6 * len].chunks_exact_mut(row - next);
                for (out, row) in out.zip(tensors.chunks_exact(row)) {
                    for ((out, a), b) in out.iter_mut().zip(row).zip(&row[next..]) {
                        *out = factor * (b - a);
                    }
                }
            }
        }
        Node {
            lower,
            upper,
            parts: [NONE; 2],
            c,
            points,
        }
    }

    pub fn bounds(&self, cell: u32, axis: usize) -> (f64, f64) {
        let node = &self.nodes[cell as usize];
        (node.lower[axis], node.upper[axis])
    }

    /// The two parts of a cell.
    pub fn split(&mut self, element: &Element, cell: u32, axis: usize) -> [u32; 2] {
        let first = self.nodes[cell as usize].parts[axis];
        if first != NONE {
            return [first, first + 1];
        }
        let node = &self.nodes[cell as usize];
        let (mut lower, mut upper) = (vec![0.0; node.c.len()], vec![0.0; node.c.len()]);
        let buffers = |c| Buffers { c, points: Vec::new() };
        let layout = &element.layout;
        let rational = std::iter::once(&layout.position)
            .chain(&layout.slopes)
            .map(|slot| (slot, 4));
        for (slot, count) in rational.chain(layout.fields.iter().map(|slot| (slot, 6))) {
            for k in 0..count {
                let range = slot.range();
                let (start, end) = (range.start + k * slot.len(), range.end + k * slot.len());
                let (low, high) = (&mut lower[start..end], &mut upper[start..end]);
                cut(&node.c[start..end], slot.degrees, axis, CUT, low, high);
            }
        }
        let at = node.lower[axis] + CUT * (node.upper[axis] - node.lower[axis]);
        let (mut low_end, mut high_start) = (node.upper, node.lower);
        low_end[axis] = at;
        high_start[axis] = at;
        let (start, end) = (node.lower, node.upper);
        let low = self.node(element, start, low_end, buffers(lower));
        let high = self.node(element, high_start, end, buffers(upper));
        let first = self.nodes.len() as u32;
        self.nodes.push(low);
        self.nodes.push(high);
        self.nodes[cell as usize].parts[axis] = first;
        [first, first + 1]
    }

    /// Control points of the position.
    pub fn position<'a>(&'a self, element: &Element, cell: u32) -> Triples<'a> {
        let slot = &element.layout.position;
        Triples::new(&self.nodes[cell as usize].points, slot.start, slot.len())
    }

    /// Control points of the derivative of the position.
    pub fn slope<'a>(&'a self, element: &Element, cell: u32, axis: usize) -> Triples<'a> {
        let slot = &element.layout.slopes[axis];
        Triples::new(&self.nodes[cell as usize].points, slot.start, slot.len())
    }

    /// Coefficients of `N` and `M` of a field.
    pub fn field<'a>(&'a self, element: &Element, cell: u32, field: usize) -> [Triples<'a>; 2] {
        let slot = &element.layout.fields[field];
        let c = &self.nodes[cell as usize].c;
        [
            Triples::new(c, slot.start, slot.len()),
            Triples::new(c, slot.start + 3 * slot.len(), slot.len()),
        ]
    }

    /// Coefficients of the derivatives of `N` and `M` of a field.
    pub fn field_slope(&self, cell: u32, field: usize, axis: usize) -> [Triples<'_>; 2] {
        let (start, len) = self.derivatives[field][axis];
        let points = &self.nodes[cell as usize].points;
        [
            Triples::new(points, start, len),
            Triples::new(points, start + 3 * len, len),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The short way to the points of surfaces of revolution is the general one, turned into their frame.
        #[test]
        fn products_agree_with_tensors(u in 0.0..1.0, v in 0.0..1.0, radius in 0.5..20.0) {
            let tools = [Tool::ball(radius, 3.0 * radius), Tool::bull(radius, 0.3 * radius, 2.0 * radius)];
            for element in tools.into_iter().flat_map(|tool| Element::all(&tool.unwrap()).0) {
                let (short, long) = (element.face([u, v]), element.face_in_general([u, v]));
                let (turn, shift) = element.frame().copied().unwrap_or((Matrix3::identity(), Vector3::zeros()));
                // A few dozen roundings of numbers of the size of the tool, its normals (of size 1) and their slopes.
                let near = |a: Vector3<f64>, b: Vector3<f64>, size: f64| (a - b).amax() <= 1e-14 * size;
                let size = 10.0 * radius;
                prop_assert!(near(turn * short.position + shift, long.position, size));
                for axis in 0..2 {
                    prop_assert!(near(turn * short.slopes[axis], long.slopes[axis], 10.0 * size));
                }
                for d in 0..3 {
                    let normal = turn * short.field.normal[d];
                    let moment = turn * short.field.moment[d] + shift.cross(&normal);
                    prop_assert!(near(normal, long.field.normal[d], 100.0));
                    prop_assert!(near(moment, long.field.moment[d], 10.0 * size));
                }
            }
        }
    }
}
