//! Products of tensors.
//!
//! The coefficients are `c_k = Σ_{i+j=k} C(a,i) C(b,j) / C(a+b,k) · a_i b_j` in each variable: scale both
//! operands by their binomials, convolve, divide. The convolution runs over rows of the first variable and, where that
//! pays, of the first two laid out with the product's stride, so that the inner loop is long and contiguous.

use super::{accumulate, binomials};
use smallvec::SmallVec;

/// The degree in a variable; 0 for variables that do not exist.
pub(crate) fn degree_of(degrees: &[usize], axis: usize) -> usize {
    degrees.get(axis).copied().unwrap_or(0)
}

type Scratch = SmallVec<[f64; 256]>;

/// The coefficients times (`INVERSE`: divided by) the binomials of every variable, in place.
fn scale_by_binomials<const INVERSE: bool>(coefficients: &mut [f64], degrees: &[usize]) {
    let mut inner = 1;
    for &degree in degrees {
        if degree >= 2 {
            let row = binomials(degree);
            let factors: SmallVec<[f64; 32]> = row.iter().map(|&c| if INVERSE { 1.0 / c } else { c }).collect();
            for block in coefficients.chunks_exact_mut(inner * (degree + 1)) {
                if inner == 1 {
                    block.iter_mut().zip(&factors).for_each(|(c, &factor)| *c *= factor);
                    continue;
                }
                for (slice, &factor) in block.chunks_exact_mut(inner).zip(&factors) {
                    slice.iter_mut().for_each(|c| *c *= factor);
                }
            }
        }
        inner *= degree + 1;
    }
}

/// The product of two tensors of Bernstein coefficients, into `product`, which holds zeros and has the sums of the
/// degrees.
pub(crate) fn multiply(
    (degrees_a, a): (&[usize], &[f64]),
    (degrees_b, b): (&[usize], &[f64]),
    degrees: &[usize],
    product: &mut [f64],
) {
    let mut scaled_a = Scratch::from_slice(a);
    let mut scaled_b = Scratch::from_slice(b);
    scale_by_binomials::<false>(&mut scaled_a, degrees_a);
    scale_by_binomials::<false>(&mut scaled_b, degrees_b);
    convolve((degrees_a, &scaled_a), (degrees_b, &scaled_b), degrees, product);
    scale_by_binomials::<true>(product, degrees);
}

/// Adds the convolution of two scaled tensors to `product`.
fn convolve(
    (degrees_a, a): (&[usize], &[f64]),
    (degrees_b, b): (&[usize], &[f64]),
    degrees: &[usize],
    product: &mut [f64],
) {
    // Lay the second operand's rows out with the product's first stride: planes become long rows.
    let (row_a, row_b) = (degree_of(degrees_a, 0) + 1, degree_of(degrees_b, 0) + 1);
    let (rows_b, stride) = (degree_of(degrees_b, 1) + 1, degree_of(degrees, 0) + 1);
    let plane = stride * (rows_b - 1) + row_b;
    let mut padded = Scratch::from_elem(0.0, plane * (b.len() / (row_b * rows_b)));
    for (to, from) in padded.chunks_exact_mut(plane).zip(b.chunks_exact(row_b * rows_b)) {
        for (j, row) in from.chunks_exact(row_b).enumerate() {
            to[j * stride..j * stride + row_b].copy_from_slice(row);
        }
    }
    let offsets_b = offsets(degrees_b, degrees, 2);
    let offsets_a = offsets(degrees_a, degrees, 1);
    for (row, &base) in a.chunks_exact(row_a).zip(&offsets_a) {
        for (from, &offset) in padded.chunks_exact(plane).zip(&offsets_b) {
            let start = base + offset;
            for (i, &factor) in row.iter().enumerate() {
                accumulate(&mut product[start + i..start + i + plane], from, factor);
            }
        }
    }
}

/// Where in a tensor of `degrees` each entry of a form of degrees `own` goes that has index 0 in the first `skip`
/// variables.
fn offsets(own: &[usize], degrees: &[usize], skip: usize) -> SmallVec<[usize; 64]> {
    let mut offsets = SmallVec::from_slice(&[0]);
    let mut stride = 1;
    for (axis, &degree) in degrees.iter().enumerate() {
        if axis >= skip {
            let count = offsets.len();
            for i in 1..=degree_of(own, axis) {
                for k in 0..count {
                    let offset = offsets[k] + i * stride;
                    offsets.push(offset);
                }
            }
        }
        stride *= degree + 1;
    }
    offsets
}
