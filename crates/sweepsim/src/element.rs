//! What is swept: patches and edges of a tool, prepared once per tool, and cut into cells on demand.
//!
//! Only the tool enters here, no motion: the cells of `(u, v)` serve all segments of a path. Each cell keeps the *control
//! points* (coefficient over weight) of `F`, `F_u`, `F_v`, so that a rotated coordinate is bounded by dot products, and the
//! coefficients of the normals `N`, their moments `M = F × N`, and the derivatives of both.

use crate::form::{Form, cut, restrict};
use crate::instant::{Frame, Revolution, Table, position};
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
    /// A shorter way to its points, where there is one, arranged for the inner loop.
    pub revolution: Option<Revolution>,
    frame: Option<Frame>,
    /// Homogeneous position, arranged for it.
    pub places: Table,
    /// All fields one after another, arranged for it.
    pub normals: Table,
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
            revolution: patch.revolved.as_ref().map(Revolution::new),
            frame: patch.revolved.as_ref().and_then(|revolved| revolved.frame),
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
        let mut all: Vec<Form> = Vec::new();
        let fields = fields
            .iter()
            .map(|field| {
                let forms: Vec<Form> = field.normal.iter().chain(&field.moment).map(Form::of).collect();
                for (k, form) in forms.iter().enumerate() {
                    largest[k / 3] = largest[k / 3].max(form.largest());
                }
                all.extend_from_slice(&forms);
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
            revolution: None,
            frame: None,
            places: table(point.iter().chain([&weight])),
            normals: table(all.iter()),
        }
    }

    /// A point of a patch in the tool, its normal and the moment of that.
    pub fn face(&self, at: [f64; 2]) -> (Vector3<f64>, [Vector3<f64>; 2]) {
        let [value, ..] = self.places.at::<4>(at);
        let [fields, ..] = self.normals.at::<6>(at);
        let [place] = position(&[value]);
        (place, [0, 3].map(|k| triple(&fields[k..])))
    }

    /// A point of an edge in the tool, the normals of both faces and the moments of those.
    pub fn rim(&self, r: f64) -> (Vector3<f64>, [[Vector3<f64>; 2]; 2]) {
        let [value, _] = self.places.along::<4>(r);
        let [fields, _] = self.normals.along::<12>(r);
        let [place] = position(&[value]);
        (place, [0, 6].map(|side| [side, side + 3].map(|k| triple(&fields[k..]))))
    }

    /// The frame of [`Element::revolution`] in the tool; `None` when it is the tool's.
    pub fn frame(&self) -> Option<&Frame> {
        self.frame.as_ref()
    }
}

fn triple(list: &[f64]) -> Vector3<f64> {
    Vector3::new(list[0], list[1], list[2])
}

/// Forms raised to common degrees.
fn table<'a>(forms: impl Iterator<Item = &'a Form> + Clone) -> Table {
    let degrees = [0, 1].map(|axis| forms.clone().map(|form| form.degrees[axis]).max().unwrap_or(0));
    Table::new(&forms.map(|form| form.raised(degrees)).collect::<Vec<_>>(), degrees)
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
            let range = slot.start..slot.start + count * slot.len();
            let (low, high) = (&mut lower[range.clone()], &mut upper[range.clone()]);
            cut(&node.c[range], slot.degrees, axis, CUT, low, high);
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
