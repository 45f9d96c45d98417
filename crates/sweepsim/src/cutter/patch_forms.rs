//! Patches and edges of a tool as forms, prepared once per tool.
//!
//! Nothing here depends on the motion: the cells of `(u, v)` serve all segments of a path. Each cell keeps the *control
//! points* (coefficient over weight) of `F`, `F_u`, `F_v`, so that a rotated coordinate is bounded by dot products, and the
//! coefficients of the normals `N`, their moments `M = F × N`, and the derivatives of both.

use crate::algebra::bivariate::factors;
use crate::algebra::quad::{Quad, add, quad, vector};
use crate::algebra::ranges::ROUNDING;
use crate::algebra::table::{Table, position};
use crate::cutter::direct::{Direct, Site};
use crate::cutter::reduced::Reduced;
use crate::cutter::revolution::{Revolution, Spot};
use crate::time::pieces::Sizes;
use crate::time::placement::{LocalFrame, Placing, Twisted};
use nalgebra::Vector3;
use sweepsim_motion::{Edge, NormalField, Patch, Revolved, Tool};
use sweepsim_spline::Bernstein;

/// Degrees and place of a coefficient tensor in a cell's list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub degrees: [usize; 2],
    pub start: usize,
}

impl Slot {
    pub fn len(&self) -> usize {
        (self.degrees[0] + 1) * (self.degrees[1] + 1)
    }
}

/// A patch (two variables, one field of normals) or an edge (one variable, the normals of both its faces).
#[derive(Clone, Debug)]
pub(crate) struct PatchForms {
    /// Homogeneous tensors of the whole element: see [`Layout`].
    pub(super) whole: Vec<f64>,
    pub(super) layout: Layout,
    /// The forms of which the cells hold reductions, if their degrees are high.
    pub(super) reduced: Option<Reduced>,
    /// The largest coefficients of each component of `M` and of `N`.
    pub largest: Sizes,
    /// The same, or more: their rounding errors are below [`ROUNDING`] times this.
    pub rounding: Sizes,
    /// A faster evaluation of its points, if there is one, arranged for the inner loop.
    pub revolution: Option<Revolution>,
    /// Another one, of any patch.
    direct: Option<Direct>,
    frame: Option<LocalFrame>,
    /// Homogeneous position, arranged for the inner loop.
    pub places: Table,
    /// All fields, one after another, arranged for the inner loop.
    pub normals: Table,
}

/// The tensors of a cell: position x, y, z, weight; then for each variable the same for the derivative; then for each field N, M.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub position: Slot,
    pub slopes: Vec<Slot>,
    pub fields: Vec<Slot>,
    pub len: usize,
}

impl PatchForms {
    pub fn all(tool: &Tool) -> (Vec<Self>, Vec<Self>) {
        (
            tool.patches().iter().map(Self::patch).collect(),
            tool.edges().iter().map(Self::edge).collect(),
        )
    }

    fn patch(patch: &Patch) -> Self {
        let element = Self::new(patch.position(), patch.weight(), &[patch.field()], 2);
        let direct = Direct::new(patch);
        let mut rounding = element.largest;
        if let Some(direct) = &direct {
            let errors = direct.rounding.as_flattened();
            for (size, error) in rounding.as_flattened_mut().iter_mut().zip(errors) {
                *size = size.max(error / ROUNDING);
            }
        }
        Self {
            direct,
            rounding,
            revolution: patch.revolved().map(Revolution::new),
            frame: patch
                .revolved()
                .and_then(Revolved::frame)
                .map(|(turn, origin)| (turn, origin.into())),
            ..element
        }
    }

    fn edge(edge: &Edge) -> Self {
        Self::new(edge.position(), edge.weight(), &[edge.before(), edge.after()], 1)
    }

    fn new(point: &[Bernstein; 3], weight: &Bernstein, fields: &[&NormalField], variables: usize) -> Self {
        let mut whole = Vec::new();
        let mut put = |forms: &[&Bernstein]| {
            let degrees = common_degrees(forms);
            let start = whole.len();
            for form in forms {
                whole.extend_from_slice(form.elevated_to(&degrees).coefficients());
            }
            Slot { degrees, start }
        };
        let [x, y, z] = point;
        let position = put(&[x, y, z, weight]);
        let slopes = (0..variables)
            .map(|axis| {
                // With ω = ω₁(u) ω₂(v): F_u = (F̂_u ω₁ − F̂ ω₁′) / (ω₁² ω₂).
                let (own, other) = match factors(weight) {
                    Some([in_u, in_v]) if axis == 0 => (in_u, Some(in_v)),
                    Some([in_u, in_v]) => (in_v, Some(in_u)),
                    None => (weight.clone(), None),
                };
                let numerator = |f: &Bernstein| f.derivative(axis).mul(&own).sub(&f.mul(&own.derivative(axis)));
                let square = own.square();
                let denominator = other.map_or(square.clone(), |o| square.mul(&o));
                let [x, y, z] = point.each_ref().map(numerator);
                put(&[&x, &y, &z, &denominator])
            })
            .collect();
        let mut largest = [[0.0_f64; 3]; 2];
        let mut reduced = None;
        let mut all: Vec<&Bernstein> = Vec::new();
        let mut fields: Vec<Slot> = fields
            .iter()
            .map(|field| {
                let forms: Vec<&Bernstein> = field.normal().iter().chain(field.moment()).collect();
                for (k, form) in forms.iter().enumerate() {
                    let largest = &mut largest[1 - k / 3][k % 3];
                    *largest = largest.max(form.magnitude());
                }
                all.extend_from_slice(&forms);
                put(&forms)
            })
            .collect();
        if let [field] = &mut fields[..]
            && let Some(own) = Reduced::new(&whole[field.start..], field.degrees)
        {
            field.degrees = own.low();
            whole.truncate(field.start + 6 * field.len());
            reduced = Some(own);
        }
        let layout = Layout {
            position,
            slopes,
            fields,
            len: whole.len(),
        };
        Self {
            whole,
            layout,
            reduced,
            rounding: largest,
            largest,
            revolution: None,
            direct: None,
            frame: None,
            places: table(&[x, y, z, weight]),
            normals: table(&all),
        }
    }

    /// A point of a patch in the tool's frame, with its normal and the normal's moment.
    pub fn face(&self, at: [f64; 2]) -> (Vector3<f64>, [Vector3<f64>; 2]) {
        let [value, ..] = self.places.at::<4>(at);
        let [fields, ..] = self.normals.at::<6>(at);
        let [place] = position(&[value]);
        (place, [0, 3].map(|k| triple(&fields[k..])))
    }

    /// A point of an edge in the tool's frame, with the normals of both faces and their moments.
    pub fn rim(&self, r: f64) -> (Vector3<f64>, [[Vector3<f64>; 2]; 2]) {
        let [value, _] = self.places.along::<4>(r);
        let [fields, _] = self.normals.along::<12>(r);
        let [place] = position(&[value]);
        (place, [0, 6].map(|side| [side, side + 3].map(|k| triple(&fields[k..]))))
    }

    /// A point of a placed patch, and its fields.
    #[inline]
    pub fn spot(&self, placing: &Placing, at: [f64; 2]) -> (Spot, Fields) {
        let (place, slopes, normal, fields) =
            if let Some(direct) = self.direct.as_ref().filter(|direct| direct.covers(at)) {
                let site = direct.at(at);
                (site.place, site.slopes, site.normal, Fields::Direct(site))
            } else {
                let [place, in_u, in_v] = position(&self.places.at::<4>(at)).map(|v| quad(&v));
                let fields = self.normals.at::<6>(at);
                let [x, y, z, ..] = fields[0];
                (place, [in_u, in_v], [x, y, z, 0.0], Fields::Lists(fields))
            };
        let turned = |direction: &Quad| placing.turned(&vector(direction));
        let spot = Spot {
            place: add(&turned(&place), &placing.origin),
            slopes: slopes.each_ref().map(turned),
            normal: turned(&normal),
        };
        (spot, fields)
    }

    /// The place of a point of a placed patch, and `⟨spin, M⟩ + ⟨travel, N⟩` there, without derivatives; `None` if [`spot`](Self::spot) costs hardly more.
    #[inline]
    pub fn value(&self, placing: &Placing, twist: &Twisted, at: [f64; 2]) -> Option<(Quad, f64)> {
        let direct = self.direct.as_ref().filter(|direct| direct.covers(at))?;
        let (place, g) = direct.value(at, twist)?;
        Some((add(&placing.turned(&vector(&place)), &placing.origin), g))
    }

    /// The number of coefficients of a cell's field along the first variable.
    pub fn field_length(&self, field: usize) -> usize {
        self.layout.fields[field].degrees[0] + 1
    }

    /// The frame of [`PatchForms::revolution`] in the tool; `None` if it is the tool's frame.
    pub fn frame(&self) -> Option<&LocalFrame> {
        self.frame.as_ref()
    }
}

/// `N` and `M` at a point of a patch, and their derivatives.
pub(crate) enum Fields {
    Direct(Site),
    /// Both one after the other: values, derivatives in `u` and in `v`.
    Lists([[f64; 6]; 3]),
}

impl Fields {
    /// `⟨spin, M⟩ + ⟨travel, N⟩` of a velocity.
    #[inline]
    pub fn envelope(&self, twist: &Twisted) -> f64 {
        match self {
            Self::Direct(site) => site.envelope(twist),
            Self::Lists([values, ..]) => twist.dot(values),
        }
    }

    /// The same, and its derivatives in `u` and in `v`.
    #[inline]
    pub fn envelopes(&self, twist: &Twisted) -> [f64; 3] {
        match self {
            Self::Direct(site) => site.envelopes(twist),
            Self::Lists(lists) => lists.each_ref().map(|list| twist.dot(list)),
        }
    }
}

fn triple(list: &[f64]) -> Vector3<f64> {
    Vector3::new(list[0], list[1], list[2])
}

/// The largest degree in each variable.
fn common_degrees(forms: &[&Bernstein]) -> [usize; 2] {
    [0, 1].map(|axis| forms.iter().map(|form| form.degree(axis)).max().unwrap_or(0))
}

/// Forms raised to common degrees.
fn table(forms: &[&Bernstein]) -> Table {
    let degrees = common_degrees(forms);
    let raised: Vec<Bernstein> = forms.iter().map(|form| form.elevated_to(&degrees)).collect();
    Table::new(&raised, degrees)
}
