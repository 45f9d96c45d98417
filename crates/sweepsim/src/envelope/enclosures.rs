//! Enclosures of `X`, `Y` and `g`, and of their derivatives, over a cell of a patch or an edge and a piece of time.

pub(crate) use crate::algebra::ranges::ROUNDING;
use crate::algebra::ranges::{products, shifted_products};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::time::pieces::{Sizes, Times};
use sweepsim_solve::Enclosure;

/// `[lo, hi] · [a, b]` for `0 < a ≤ b`.
fn scaled((lo, hi): (f64, f64), (a, b): (f64, f64)) -> (f64, f64) {
    (
        if lo < 0.0 { lo * b } else { lo * a },
        if hi > 0.0 { hi * b } else { hi * a },
    )
}

#[inline]
pub(super) fn interval((lo, hi): (f64, f64)) -> Enclosure {
    Enclosure::hull(lo, hi)
}

/// Length scales: which differences count as large, and the size of rounding errors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    /// Distance between neighbouring lines.
    pub spacing: [f64; 2],
    /// The rounding error of a coordinate that all systems allow for.
    pub system_rounding: f64,
}

/// A function near a point: its value and its derivatives there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near<const N: usize> {
    pub value: f64,
    pub slope: [f64; N],
}

impl<const N: usize> Near<N> {
    /// The value at `x`, to first order from the point `from`.
    pub fn at(&self, x: &[f64; N], from: &[f64; N]) -> f64 {
        (0..N).fold(self.value, |sum, k| sum + self.slope[k] * (x[k] - from[k]))
    }
}

/// A cell of an element in a piece of time.
pub(crate) type Brick = (u32, u32);

pub(crate) const ROOT: Brick = (0, 0);

/// A bound of `|g|`: component by component, since a bottom that slides along itself has the sign of a displacement that is a tiny part of the velocity.
pub(super) fn envelope_size(element: &PatchForms, times: &Times) -> f64 {
    product_size(&times.sizes(), &element.largest)
}

/// A bound of the rounding error of `g` on a cell.
pub(super) fn envelope_error_in(element: &PatchForms, cells: &Cells, times: &Times, cell: u32) -> f64 {
    let [u, v] = [0, 1].map(|axis| cells.bounds(cell, axis));
    ROUNDING * product_size(&times.sizes(), element.rounding_in([u.0, v.0], [u.1, v.1]))
}

/// A bound of the rounding error of `g`.
pub(super) fn envelope_error(element: &PatchForms, times: &Times) -> f64 {
    ROUNDING * product_size(&times.sizes(), &element.rounding)
}

/// The range of a function that a form bounds up to an error.
#[inline]
pub(super) fn widened((lo, hi): (f64, f64), error: f64) -> (f64, f64) {
    (lo - error, hi + error)
}

/// A bound of `⟨s, M⟩ + ⟨b, N⟩`.
pub(super) fn product_size(twist: &Sizes, fields: &Sizes) -> f64 {
    let pairs = twist.as_flattened().iter().zip(fields.as_flattened());
    pairs.map(|(a, b)| a * b).sum()
}

/// The largest of each component of some vectors.
#[inline]
pub(super) fn largest(rows: &[[f64; 3]]) -> [f64; 3] {
    let mut largest = [0.0_f64; 3];
    for row in rows {
        for (size, x) in largest.iter_mut().zip(row) {
            *size = size.max(x.abs());
        }
    }
    largest
}

/// Bounds of the components of angular and linear velocities, whose roundings are relative to `sizes`.
pub(super) fn speeds(spins: &[[f64; 3]], travels: &[[f64; 3]], sizes: &Sizes) -> Sizes {
    let [spin, travel] = [largest(spins), largest(travels)];
    let with = |own: [f64; 3], of: &[f64; 3]| std::array::from_fn(|k| own[k] + ROUNDING * of[k]);
    [with(spin, &sizes[0]), with(travel, &sizes[1])]
}

/// Ranges of X and Y.
pub(super) fn plane_values(
    element: &PatchForms,
    cells: &Cells,
    times: &Times,
    (cell, piece): Brick,
    size: &Size,
) -> [Enclosure; 2] {
    let position = cells.position(element, cell);
    [0, 1].map(|r| {
        if let Some([offsets, _]) = times.offsets(piece, r) {
            let (lo, hi) = shifted_products(times.rows(piece, r), offsets, &position);
            return Enclosure::hull(lo - size.system_rounding, hi + size.system_rounding);
        }
        let (lo, hi) = products(times.rows(piece, r), &position);
        let (a, b) = times.tip(piece, r);
        Enclosure::hull(lo + a - size.system_rounding, hi + b + size.system_rounding)
    })
}

/// Ranges of `∂X/∂t` and `∂Y/∂t`: `b′ + A′ F`.
pub(super) fn turning(element: &PatchForms, cells: &Cells, times: &Times, (cell, piece): Brick) -> [Enclosure; 2] {
    let position = cells.position(element, cell);
    [0, 1].map(|r| {
        let (rows, pace) = times.spin_rows(piece, r);
        if let Some([_, offsets]) = times.offsets(piece, r) {
            return interval(shifted_products(rows, offsets, &position));
        }
        let (lo, hi) = scaled(products(rows, &position), pace);
        let (slowest, fastest) = times.velocity(piece, r);
        Enclosure::hull(lo + slowest, hi + fastest)
    })
}

/// The sign of `g` over a cell: `Some(true)` negative, `Some(false)` not negative, `None` both or unclear.
pub(super) fn negative((lo, hi): (f64, f64), error: f64) -> Option<bool> {
    if hi < -error {
        Some(true)
    } else if lo > error || (lo == 0.0 && hi == 0.0) {
        Some(false)
    } else {
        None
    }
}
