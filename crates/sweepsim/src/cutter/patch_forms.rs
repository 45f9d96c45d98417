//! Patches and edges of a tool as forms, prepared once per tool.
//!
//! Nothing here depends on the motion: the cells of `(u, v)` serve all segments of a path. Each cell keeps the *control
//! points* (coefficient over weight) of `F`, `F_u`, `F_v`, so that a rotated coordinate is bounded by dot products, and the
//! coefficients of the normals `N`, their moments `M = F × N`, and the derivatives of both.

use crate::algebra::bivariate::factors;
use crate::algebra::quad::{Quad, add, cross, quad, vector};
use crate::algebra::ranges::ROUNDING;
use crate::algebra::table::{Table, position};
use crate::cutter::direct::{Direct, Site};
use crate::cutter::reduced::{Missing, Reduced, nodes, through};
use crate::cutter::revolution::{PatchPoint, Revolution};
use crate::cutter::tangents::Tangents;
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
    /// Bounds of what reductions of the slopes lack, if cells hold those.
    pub(super) tangents: Option<Tangents>,
    /// The largest coefficients of each component of `M` and of `N`.
    pub largest: Sizes,
    /// The same, or more: their rounding errors are below [`ROUNDING`] times this.
    pub rounding: Sizes,
    /// A faster evaluation of its points, if there is one, arranged for the inner loop.
    pub revolution: Option<Revolution>,
    /// Another one, of any patch.
    direct: Option<Direct>,
    frame: Option<LocalFrame>,
    /// The sides of a patch that have shrunk to a point, in each variable the lower and the upper one, where normals are not of revolution.
    pub poles: [[bool; 2]; 2],
    /// Homogeneous position, arranged for the inner loop.
    pub places: Table,
    /// All fields, one after another, arranged for the inner loop.
    pub normals: Table,
}

/// The tensors of a cell: position x, y, z, weight; then for each variable the same for the derivative; then for each field N, M.
///
/// If slopes are reduced, they are only among the control points, and the fields follow the position.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub position: Slot,
    pub slopes: Vec<Slot>,
    pub fields: Vec<Slot>,
    pub len: usize,
}

impl Layout {
    /// The position, and if asked for, the slopes and the fields, each with its number of tensors.
    pub fn tensors(&self, slopes: bool, fields: bool) -> impl Iterator<Item = (&Slot, usize)> {
        let slopes = self.slopes.iter().filter(move |_| slopes);
        let fields = self.fields.iter().filter(move |_| fields);
        let rational = std::iter::once(&self.position).chain(slopes);
        rational.map(|slot| (slot, 4)).chain(fields.map(|slot| (slot, 6)))
    }
}

impl PatchForms {
    pub fn all(tool: &Tool) -> (Vec<Self>, Vec<Self>) {
        (
            Self::of_patches(tool.patches()),
            tool.edges().iter().map(Self::edge).collect(),
        )
    }

    pub fn of_patches(patches: &[Patch]) -> Vec<Self> {
        patches.iter().map(Self::patch).collect()
    }

    fn patch(patch: &Patch) -> Self {
        let direct = Direct::new(patch);
        let tangents = direct.as_ref().and_then(|direct| Tangents::new(patch, direct));
        let element = Self::new(patch.position(), patch.weight(), &[patch.field()], 2, tangents);
        let mut rounding = element.largest;
        if let Some(direct) = &direct {
            let errors = direct.rounding.as_flattened();
            for (size, error) in rounding.as_flattened_mut().iter_mut().zip(errors) {
                *size = size.max(error / ROUNDING);
            }
        }
        Self {
            poles: patch.shrunk_sides(),
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
        Self::new(edge.position(), edge.weight(), &[edge.before(), edge.after()], 1, None)
    }

    /// `tangents`: for slopes that may be reduced, if the fields are.
    fn new(
        point: &[Bernstein; 3],
        weight: &Bernstein,
        fields: &[&NormalField],
        variables: usize,
        tangents: Option<Tangents>,
    ) -> Self {
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
        let tangents = tangents.filter(|_| Reduced::lowers(common_degrees(&forms_of(fields))) == Some([2; 2]));
        let slopes = (0..variables)
            .map(|axis| match &tangents {
                Some(_) => {
                    let degrees = [2; 2];
                    let start = position.start + 4 * position.len() + axis * 3 * Tangents::POINTS;
                    Slot { degrees, start }
                }
                None => put(&slope(point, weight, axis).each_ref()),
            })
            .collect();
        let mut largest = [[0.0_f64; 3]; 2];
        let mut reduced = None;
        let mut all: Vec<&Bernstein> = Vec::new();
        let mut fields: Vec<Slot> = fields
            .iter()
            .map(|field| {
                let forms = forms_of(&[field]);
                for (k, form) in forms.iter().enumerate() {
                    let largest = &mut largest[1 - k / 3][k % 3];
                    *largest = largest.max(form.magnitude());
                }
                all.extend_from_slice(&forms);
                put(&forms)
            })
            .collect();
        let normals = match &fields[..] {
            [field] => Table::of_tensors(&whole[field.start..], field.degrees),
            _ => table(&all),
        };
        if let [field] = &mut fields[..]
            && let Some(own) = Reduced::new(&whole[field.start..], field.degrees)
        {
            field.degrees = own.low();
            whole.truncate(field.start + 6 * field.len());
            reduced = Some(own);
        }
        let places = Table::of_tensors(&whole[position.start..][..4 * position.len()], position.degrees);
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
            tangents,
            rounding: largest,
            largest,
            revolution: None,
            poles: [[false; 2]; 2],
            direct: None,
            frame: None,
            places,
            normals,
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
    pub fn point(&self, placing: &Placing, at: [f64; 2]) -> (PatchPoint, Fields) {
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
        let point = PatchPoint {
            place: add(&turned(&place), &placing.origin),
            slopes: slopes.each_ref().map(turned),
            normal: turned(&normal),
        };
        (point, fields)
    }

    /// The place of a point of a placed patch alone; `None` if [`point`](Self::point) costs hardly more.
    #[inline]
    pub fn place(&self, placing: &Placing, at: [f64; 2]) -> Option<Quad> {
        let place = self.direct.as_ref()?.place(at)?;
        Some(add(&placing.turned(&vector(&place)), &placing.origin))
    }

    /// The place of a point of a placed patch, and `⟨spin, M⟩ + ⟨travel, N⟩` there, without derivatives; `None` if [`point`](Self::point) costs hardly more.
    #[inline]
    pub fn value(&self, placing: &Placing, twist: &Twisted, at: [f64; 2]) -> Option<(Quad, f64)> {
        let direct = self.direct.as_ref().filter(|direct| direct.covers(at))?;
        let (place, g) = direct.value(at, twist)?;
        Some((add(&placing.turned(&vector(&place)), &placing.origin), g))
    }

    /// Computes the reduced field of a cell, and its reduced slopes, from values at nine points; what they lack.
    ///
    /// `None` if one of the points is close to a pole, where `M` and `N` are left to their own forms: only the slopes are computed.
    pub(super) fn sample(
        &self,
        (lower, upper): ([f64; 2], [f64; 2]),
        fields: &mut [f64],
        slopes: &mut [f64],
    ) -> Option<Missing> {
        let (direct, reduced) = (self.direct.as_ref()?, self.reduced.as_ref()?);
        let widths = [0, 1].map(|axis| upper[axis] - lower[axis]);
        let [in_u, in_v] = [0, 1].map(|axis| nodes(lower[axis], widths[axis]));
        let mut values = [[[[0.0; 4]; 3]; 3]; 4];
        for (j, v) in in_v.into_iter().enumerate() {
            for (i, u) in in_u.into_iter().enumerate() {
                let (place, [fu, fv], normal) = direct.tangent([u, v]);
                let all = [fu, fv, normal, cross(&place, &normal)];
                for (form, value) in values.iter_mut().zip(all) {
                    form[j][i] = value;
                }
            }
        }
        let write = |out: &mut [f64], of: &[[[Quad; 3]; 3]]| {
            for (out, values) in out.chunks_exact_mut(3 * Tangents::POINTS).zip(of) {
                for (at, point) in through(values).as_flattened().iter().enumerate() {
                    for (k, x) in point[..3].iter().enumerate() {
                        out[k * Tangents::POINTS + at] = *x;
                    }
                }
            }
        };
        write(slopes, &values[..2]);
        if !(direct.covers(lower) && direct.covers(upper)) {
            return None;
        }
        write(fields, &values[2..]);
        Some(reduced.missing((lower, upper), direct.rounding, fields))
    }

    /// [`rounding`](Self::rounding) on a cell: less where all of it is close to a pole, and normals are taken from their forms.
    pub fn rounding_in(&self, lower: [f64; 2], upper: [f64; 2]) -> &Sizes {
        match &self.direct {
            Some(direct) if direct.is_at_pole(lower, upper) => &self.largest,
            _ => &self.rounding,
        }
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

/// `N` and `M` of some fields.
fn forms_of<'a>(fields: &[&'a NormalField]) -> Vec<&'a Bernstein> {
    let forms = |field: &&'a NormalField| field.normal().iter().chain(field.moment());
    fields.iter().flat_map(forms).collect()
}

/// The derivative of `point / weight` along an axis: three numerators, and the denominator.
fn slope(point: &[Bernstein; 3], weight: &Bernstein, axis: usize) -> [Bernstein; 4] {
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
    [x, y, z, denominator]
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
