//! What is swept: patches and edges of a tool, prepared once per tool, and cut into cells on demand.
//!
//! Only the tool enters here, no motion: the cells of `(u, v)` serve all segments of a path. Each cell keeps the *control
//! points* (coefficient over weight) of `F`, `F_u`, `F_v`, so that a rotated coordinate is bounded by dot products, and the
//! coefficients of the normals `N`, their moments `M = F × N`, and the derivatives of both.

use crate::form::{Form, MOST, basis, cut};
use nalgebra::Vector3;
use sweepsim_motion::{Edge, NormalField, Patch, Tool};

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
        Self::new(&patch.position, &patch.weight, &[&patch.field], 2)
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
        }
    }

    /// Position, its derivatives, and per field `N`, `M` and their derivatives, at a point.
    pub fn evaluate(&self, x: &[f64]) -> Point {
        let mut point = Point::default();
        let at = [x[0], x.get(1).copied().unwrap_or(0.0)];
        let variables = self.layout.slopes.len();
        let mut sums = [[0.0; 3]; 6];
        self.sums::<4>(&self.layout.position, at, &mut sums);
        let weight = sums[3];
        for k in 0..3 {
            point.position[k] = sums[k][0] / weight[0];
            for axis in 0..variables {
                point.slopes[axis][k] = (sums[k][axis + 1] - point.position[k] * weight[axis + 1]) / weight[0];
            }
        }
        for (index, slot) in self.layout.fields.iter().enumerate() {
            self.sums::<6>(slot, at, &mut sums);
            let field = &mut point.fields[index];
            for k in 0..3 {
                for d in 0..=variables {
                    field.normal[d][k] = sums[k][d];
                    field.moment[d][k] = sums[k + 3][d];
                }
            }
        }
        point
    }

    /// Value and both derivatives of `COUNT` tensors in a row.
    fn sums<const COUNT: usize>(&self, slot: &Slot, at: [f64; 2], sums: &mut [[f64; 3]; 6]) {
        let [p, q] = slot.degrees;
        let c = &self.whole[slot.start..][..COUNT * slot.len()];
        match (p, q) {
            (2, 0) => sums_of::<COUNT, 3, 1>(c, at, sums),
            (2, 1) => sums_of::<COUNT, 3, 2>(c, at, sums),
            (2, 2) => sums_of::<COUNT, 3, 3>(c, at, sums),
            _ => sums_in_general::<COUNT>(c, slot.degrees, at, sums),
        }
    }
}

/// As [`sums_in_general`], for degrees `P − 1` and `Q − 1` known to the compiler.
fn sums_of<const COUNT: usize, const P: usize, const Q: usize>(c: &[f64], at: [f64; 2], sums: &mut [[f64; 3]; 6]) {
    let ([a, da], [b, db]) = (small_basis::<P>(at[0]), small_basis::<Q>(at[1]));
    for (sum, c) in sums.iter_mut().zip(c.chunks_exact(P * Q)) {
        *sum = [0.0; 3];
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
fn sums_in_general<const COUNT: usize>(c: &[f64], [p, q]: [usize; 2], at: [f64; 2], sums: &mut [[f64; 3]; 6]) {
    let mut bases = [[0.0; MOST]; 4];
    let [a, da, b, db] = &mut bases;
    basis(p, at[0], a, da);
    basis(q, at[1], b, db);
    for (sum, c) in sums.iter_mut().zip(c.chunks_exact((p + 1) * (q + 1))) {
        *sum = [0.0; 3];
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
}

/// An element at one parameter point: index 0 the value, 1 and 2 the derivatives.
#[derive(Clone, Debug, Default)]
pub(crate) struct Point {
    pub position: Vector3<f64>,
    pub slopes: [Vector3<f64>; 2],
    pub fields: [FieldPoint; 2],
}

#[derive(Clone, Debug, Default)]
pub(crate) struct FieldPoint {
    pub normal: [Vector3<f64>; 3],
    pub moment: [Vector3<f64>; 3],
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

/// The cells of one element, made on demand and kept.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    nodes: Vec<Node>,
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
            derivatives,
            points,
        };
        let root = cells.node(element, [0.0; 2], [1.0; 2], element.whole.clone());
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

    fn node(&self, element: &Element, lower: [f64; 2], upper: [f64; 2], c: Vec<f64>) -> Node {
        let layout = &element.layout;
        let mut points = vec![0.0; self.points];
        for slot in std::iter::once(&layout.position).chain(&layout.slopes) {
            let len = slot.len();
            let weights = &c[slot.start + 3 * len..][..len];
            for k in 0..3 {
                for i in 0..len {
                    let place = slot.start + k * len + i;
                    points[place] = c[place] / weights[i];
                }
            }
        }
        for (slot, derivatives) in layout.fields.iter().zip(&self.derivatives) {
            for (axis, (start, len)) in derivatives.iter().enumerate().take(layout.slopes.len()) {
                let [p, q] = slot.degrees;
                let n = slot.degrees[axis];
                if n == 0 {
                    continue;
                }
                let factor = n as f64 / (upper[axis] - lower[axis]);
                let (rows, columns, next) = if axis == 0 { (q + 1, p, 1) } else { (q, p + 1, p + 1) };
                for k in 0..6 {
                    let tensor = &c[slot.start + k * slot.len()..][..slot.len()];
                    let out = &mut points[start + k * len..][..*len];
                    for j in 0..rows {
                        for i in 0..columns {
                            let place = i + (p + 1) * j;
                            out[i + columns * j] = factor * (tensor[place + next] - tensor[place]);
                        }
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
        let low = self.node(element, start, low_end, lower);
        let high = self.node(element, high_start, end, upper);
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
