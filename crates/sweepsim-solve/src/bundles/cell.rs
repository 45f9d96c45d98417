//! Boxes of a bundle: the layout of their coefficients, how they are split, and the ranges they give.

use super::BundleError;
use crate::coefficients::tensor;
use crate::numbers::{CUT, EPSILON};
use crate::{Enclosure, MAX_DEGREE};
use sweepsim_spline::Bernstein;
use sweepsim_spline::kernel;

/// The most forms of a bundle: numerators and weight, zeros, conditions. No more than three equations have no more than four forms.
const FORMS: usize = 6;

/// Forms of the same degree, stored one after another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block<const N: usize> {
    pub start: usize,
    pub count: usize,
    pub degrees: [usize; N],
    /// Coefficients of a form.
    pub len: usize,
    /// Number of the first form in the bundle.
    pub first: usize,
}

impl<const N: usize> Block<N> {
    /// The stride between neighbours along an axis, in coefficients.
    pub fn inner(&self, axis: usize) -> usize {
        self.degrees[..axis].iter().map(|d| d + 1).product()
    }

    pub fn range(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.count * self.len
    }

    /// The coefficients of one form.
    pub fn form<'a>(&self, c: &'a [f64], number: usize) -> &'a [f64] {
        &c[self.start + number * self.len..][..self.len]
    }
}

/// The blocks, by number.
pub(super) const POSITION: usize = 0;
pub(super) const ZEROS: usize = 1;
pub(super) const CONDITIONS: usize = 2;

/// Forms of a bundle over its whole domain: numerators and weight, zeros, conditions.
#[derive(Clone, Debug)]
pub(super) struct Blocks<const N: usize> {
    pub blocks: [Block<N>; 3],
    pub first: Vec<f64>,
    /// Of each form, the error of the first coefficients, and their size.
    noise: [f64; FORMS],
    sizes: [f64; FORMS],
    pub len: usize,
}

/// A box on the stack.
#[derive(Clone, Copy, Debug)]
pub(super) struct StackedBox<const N: usize> {
    pub lo: [f64; N],
    pub hi: [f64; N],
    /// Error of the coefficients of each form.
    pub noise: [f64; FORMS],
    pub depth: u32,
    /// The targets that remain, as a range in a list; `None` for all that lie in its range.
    pub lines: Option<(usize, usize)>,
}

impl<const N: usize> Blocks<N> {
    pub fn new(numerators: Vec<Bernstein>, weight: &Bernstein, zeros: Vec<Bernstein>) -> Result<Self, BundleError> {
        let found = numerators.len() + zeros.len();
        if found != N {
            return Err(BundleError::Count { found, expected: N });
        }
        let empty = Block {
            start: 0,
            count: 0,
            degrees: [0; N],
            len: 0,
            first: 0,
        };
        let mut blocks = Self {
            blocks: [empty; 3],
            first: Vec::new(),
            noise: [0.0; FORMS],
            sizes: [0.0; FORMS],
            len: 0,
        };
        let count = numerators.len() + 1;
        let mut position = numerators;
        position.push(weight.clone());
        blocks.put(POSITION, &position, 0)?;
        if !weight.coefficients().iter().all(|w| *w > 2.0 * weight.error()) {
            return Err(BundleError::Weight);
        }
        blocks.put(ZEROS, &zeros, count)?;
        Ok(blocks)
    }

    pub fn set_conditions(&mut self, conditions: [Bernstein; 2]) -> Result<(), BundleError> {
        self.first
            .truncate(self.blocks[CONDITIONS].start.max(self.blocks[ZEROS].range().end));
        self.put(CONDITIONS, &conditions, N + 1)
    }

    /// Adds a block at the end; `before` forms precede it.
    fn put(&mut self, number: usize, forms: &[Bernstein], before: usize) -> Result<(), BundleError> {
        let mut degrees = [0; N];
        for (k, form) in forms.iter().enumerate() {
            let form_number = before + k;
            if form.variables() != N {
                return Err(BundleError::Variables {
                    form: form_number,
                    found: form.variables(),
                    expected: N,
                });
            }
            let finite = form.error().is_finite() && form.coefficients().iter().all(|c| c.is_finite());
            if !finite {
                return Err(BundleError::NotFinite { form: form_number });
            }
            for j in 0..N {
                degrees[j] = degrees[j].max(form.degrees()[j]);
                if degrees[j] > MAX_DEGREE {
                    return Err(BundleError::Degree {
                        form: form_number,
                        degree: degrees[j],
                    });
                }
            }
        }
        let start = self.first.len();
        for (k, form) in forms.iter().enumerate() {
            let raised = form.elevated_to(&degrees);
            self.noise[before + k] = raised.error();
            self.sizes[before + k] = raised.coefficients().iter().fold(0.0, |m, c| m.max(c.abs()));
            self.first.extend_from_slice(raised.coefficients());
        }
        self.blocks[number] = Block {
            start,
            count: forms.len(),
            degrees,
            len: degrees.iter().map(|d| d + 1).product(),
            first: before,
        };
        self.len = self.first.len();
        Ok(())
    }

    /// Whether a form that must be zero is zero everywhere.
    pub fn vanishes(&self) -> bool {
        let zeros = &self.blocks[ZEROS];
        (0..zeros.count).any(|k| zeros.form(&self.first, k).iter().all(|c| *c == 0.0))
    }

    /// The number of equations with targets; the others must be zero.
    pub fn targeted(&self) -> usize {
        self.blocks[POSITION].count - 1
    }

    pub fn root(&self) -> StackedBox<N> {
        StackedBox {
            lo: [0.0; N],
            hi: [1.0; N],
            noise: self.noise,
            depth: 0,
            lines: None,
        }
    }

    /// Splits the last box of the stack: the upper part takes its place, the lower one comes after it.
    pub fn split(&self, frame: &StackedBox<N>, axis: usize, coefficients: &mut Vec<f64>) -> [StackedBox<N>; 2] {
        let end = coefficients.len();
        coefficients.resize(end + self.len, 0.0);
        let (own, lower) = coefficients.split_at_mut(end);
        let upper = &mut own[end - self.len..];
        let at = frame.lo[axis] + CUT * (frame.hi[axis] - frame.lo[axis]);
        let width = frame.hi[axis] - frame.lo[axis];
        let (s, t) = ((frame.hi[axis] - at) / width, (at - frame.lo[axis]) / width);
        let mut parts = [*frame; 2];
        for block in self.blocks.iter().filter(|block| block.count > 0) {
            let (degree, inner) = (block.degrees[axis], block.inner(axis));
            kernel::split(
                &mut upper[block.range()],
                &mut lower[block.range()],
                degree,
                inner,
                s,
                t,
            );
            // A pass over degree d adds 4 d ε times the largest coefficient: see `tensor.rs`.
            for part in &mut parts {
                for form in block.first..block.first + block.count {
                    part.noise[form] += 4.0 * EPSILON * degree as f64 * self.sizes[form];
                }
            }
        }
        parts[0].lo[axis] = at;
        parts[1].hi[axis] = at;
        for part in &mut parts {
            part.depth += 1;
        }
        parts
    }

    /// The range of each equation's left side over the box; `None` where a form that must be zero is not, or where the conditions have the same sign.
    pub fn values(&self, frame: &StackedBox<N>, c: &[f64]) -> Option<[Enclosure; N]> {
        let [position, zeros, conditions] = &self.blocks;
        let mut values = [Enclosure::hull(0.0, 0.0); N];
        let targeted = self.targeted();
        for k in 0..zeros.count {
            let (lo, hi) = tensor::range(zeros.form(c, k));
            let noise = frame.noise[zeros.first + k];
            if lo > noise || hi < -noise {
                return None;
            }
            values[targeted + k] = Enclosure::hull(lo - noise, hi + noise);
        }
        if conditions.count == 2 {
            let negative = |k: usize| {
                let (lo, hi) = tensor::range(conditions.form(c, k));
                let noise = frame.noise[conditions.first + k];
                if hi < -noise {
                    Some(true)
                } else if lo > noise || (lo == 0.0 && hi == 0.0) {
                    Some(false)
                } else {
                    None
                }
            };
            let first = negative(0);
            if first.is_some() && first == negative(1) {
                return None;
            }
        }
        let weights = position.form(c, targeted);
        let (least, _) = tensor::range(weights);
        for k in 0..targeted {
            let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
            for (a, w) in position.form(c, k).iter().zip(weights) {
                let value = a / w;
                lo = tensor::lesser(lo, value);
                hi = tensor::greater(hi, value);
            }
            let pad = self.pad(frame, k, lo.abs().max(hi.abs()), least);
            values[k] = Enclosure::hull(lo - pad, hi + pad);
        }
        Some(values)
    }

    /// By how much a quotient of this size may be off: both its numerator and its weight may, by their noise.
    fn pad(&self, frame: &StackedBox<N>, k: usize, size: f64, least: f64) -> f64 {
        let [noise, doubt] = [frame.noise[k], frame.noise[self.targeted()]];
        (noise + doubt * size) / (least - doubt) * (1.0 + 1e-12) + EPSILON * size
    }

    /// About how much each of the [`values`](Self::values) may be off.
    pub fn noise(&self, frame: &StackedBox<N>, c: &[f64], values: &[Enclosure; N]) -> [f64; N] {
        let targeted = self.targeted();
        let (least, _) = tensor::range(self.blocks[POSITION].form(c, targeted));
        std::array::from_fn(|k| {
            if k < targeted {
                self.pad(frame, k, values[k].magnitude(), least)
            } else {
                frame.noise[self.blocks[ZEROS].first + k - targeted]
            }
        })
    }
}
