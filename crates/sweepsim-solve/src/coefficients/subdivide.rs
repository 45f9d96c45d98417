//! Restricting, splitting and recomputing the coefficients of a cell, and extracting those of a face.

use super::layout::{Axis, Cell, Layout, MAX_DEGREE, Summand};
use crate::numbers::double::{self, Double};
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row, RowList};
use smallvec::SmallVec;
use sweepsim_spline::kernel;

/// The error of a value, relative to coefficients of size 2, for each step of evaluation; each step errs by `2⁻¹⁰⁰` or so.
const STEP_ERROR: f64 = f64::from_bits((1023 - 92) << 52);

impl Layout {
    /// Restricts along one variable; the new ends may lie outside the old ones.
    pub(crate) fn restrict(&self, cell: &mut Cell, variable: usize, lo: f64, hi: f64) {
        let (old_lo, old_hi) = (cell.lo[variable], cell.hi[variable]);
        let upper_first = lo - old_lo <= old_hi - lo;
        let width = old_hi - old_lo;
        // Two cuts, each with computed weights (s, t) of the exact sides.
        let (upper, lower) = if upper_first {
            let rest = old_hi - lo;
            (
                ((old_hi - lo) / width, (lo - old_lo) / width),
                ((old_hi - hi) / rest, (hi - lo) / rest),
            )
        } else {
            let rest = hi - old_lo;
            (
                ((hi - lo) / rest, (lo - old_lo) / rest),
                ((old_hi - hi) / width, (hi - old_lo) / width),
            )
        };
        let (cut_upper, cut_lower) = (lo != old_lo, hi != old_hi);
        let growth_upper = if cut_upper { upper.0.abs() + upper.1.abs() } else { 1.0 };
        let growth_lower = if cut_lower { lower.0.abs() + lower.1.abs() } else { 1.0 };
        let passes = f64::from(u8::from(cut_upper) + u8::from(cut_lower));
        for part in &self.parts {
            let Some(axis) = part.axis(variable) else { continue };
            let c = part.of_mut(&mut cell.c);
            if upper_first && cut_upper {
                kernel::keep_upper(c, axis.degree, axis.inner, upper.0, upper.1);
            }
            if cut_lower {
                kernel::keep_lower(c, axis.degree, axis.inner, lower.0, lower.1);
            }
            if !upper_first && cut_upper {
                kernel::keep_upper(c, axis.degree, axis.inner, upper.0, upper.1);
            }
            let growth = (growth_upper * growth_lower).max(1.0);
            let growth = if growth < 1.0 + 1e-12 {
                1.0 + 1e-14
            } else {
                growth.powi(axis.degree as i32)
            };
            let e = part.equation;
            let added = 4.0 * EPSILON * axis.degree as f64 * passes * cell.scale[e];
            cell.noise[e] = (cell.noise[e] + added) * growth;
            // No other part of the row depends on this variable.
            cell.scale[e] *= growth;
        }
        cell.lo[variable] = lo;
        cell.hi[variable] = hi;
    }

    /// Splits across a variable at `at`: the upper part stays in `cell`, the lower one goes to `lower`.
    pub(crate) fn split(&self, cell: &mut Cell, lower: &mut Cell, variable: usize, at: f64) {
        let (lo, hi) = (cell.lo[variable], cell.hi[variable]);
        let width = hi - lo;
        let (s, t) = ((hi - at) / width, (at - lo) / width);
        lower.c.resize(self.len, 0.0);
        for part in &self.parts {
            let c = part.of_mut(&mut cell.c);
            let low = &mut lower.c[part.offset..part.offset + part.len];
            match part.axis(variable) {
                Some(axis) => {
                    kernel::split(c, low, axis.degree, axis.inner, s, t);
                    let e = part.equation;
                    cell.noise[e] += 4.0 * EPSILON * axis.degree as f64 * cell.scale[e];
                }
                None => low.copy_from_slice(c),
            }
        }
        (lower.lo, lower.hi) = (cell.lo, cell.hi);
        lower.noise.clone_from(&cell.noise);
        lower.scale.clone_from(&cell.scale);
        lower.hi[variable] = at;
        cell.lo[variable] = at;
    }

    /// The original coefficients of a part.
    pub(crate) fn originals(&self, part: &Summand, out: &mut Vec<Double>) {
        out.clear();
        out.extend(part.of(&self.first).iter().map(|x| Double::new(*x)));
        if !self.second.is_empty() {
            for (x, low) in out.iter_mut().zip(part.of(&self.second)) {
                x.lo = *low;
            }
        }
    }

    /// The equations' values at a point of the domain, with bounds of their errors; `None` if rows are combined by a tape, or outside.
    pub(crate) fn residual(&self, x: &Row, buffer: &mut Vec<Double>) -> Option<(Row, Row)> {
        let inside = x[..self.n].iter().all(|x| (0.0..=1.0).contains(x));
        if self.tape.is_some() || !inside {
            return None;
        }
        let mut sums = [Double::default(); MAX_UNKNOWNS];
        let mut errors = [0.0; MAX_UNKNOWNS];
        for (e, error) in errors[..self.m].iter_mut().enumerate() {
            *error = self.first_noise[e] + self.remainder[e];
        }
        let mut weights = [Double::default(); MAX_DEGREE + 1];
        for part in &self.parts {
            self.originals(part, buffer);
            let mut steps = 4;
            let mut single = self.second.is_empty();
            // The slowest axis first: the first slab becomes the sum of all with the weights of the basis. For each degree, a weight rounds by a few
            // operations, and a sum by two more: far less than a step.
            for axis in part.axes.iter().rev() {
                double::basis(axis.degree, x[axis.variable], &mut weights);
                let (sum, others) = buffer.split_at_mut(axis.inner);
                for x in &mut *sum {
                    *x = weights[0].mul(*x);
                }
                for (slab, weight) in others.chunks_exact(axis.inner).zip(&weights[1..=axis.degree]) {
                    for (x, c) in sum.iter_mut().zip(slab) {
                        let term = if single { weight.times(c.hi) } else { weight.mul(*c) };
                        *x = x.add(term);
                    }
                }
                single = false;
                steps += axis.degree;
            }
            let e = part.equation;
            sums[e] = sums[e].add(buffer[0]);
            errors[e] += STEP_ERROR * steps as f64;
        }
        let mut values = [0.0; MAX_UNKNOWNS];
        for e in 0..self.m {
            values[e] = sums[e].hi;
            errors[e] += f64::EPSILON * sums[e].hi.abs();
        }
        Some((values, errors))
    }

    /// Recomputes the cell's coefficients from the original ones, in double-double precision. Cells may extend slightly beyond the domain: restriction to
    /// `[−a, 1 + b]` magnifies errors of degree `d` by at most `((1 + 2a)(1 + 2b))ᵈ`.
    ///
    /// Parts of one equation may be large where their sum is small: constants move to the first part, so that the rounded numbers are small.
    pub(crate) fn refresh(&self, cell: &mut Cell, buffer: &mut Vec<Double>) {
        let mut carried: SmallVec<[Double; MAX_UNKNOWNS]> = SmallVec::from_elem(Double::default(), self.rows());
        // Last parts first: the first part of each equation absorbs the constants of the others.
        for (number, part) in self.parts.iter().enumerate().rev() {
            let e = part.equation;
            self.originals(part, buffer);
            for axis in &part.axes {
                let (lo, hi) = (cell.lo[axis.variable], cell.hi[axis.variable]);
                if lo != 0.0 || hi != 1.0 {
                    double::restrict(buffer, axis.degree, axis.inner, lo, hi);
                }
            }
            let is_first = !self.parts[..number].iter().any(|p| p.equation == e);
            let shift = if is_first {
                carried[e]
            } else {
                let away = buffer[part.len / 2];
                carried[e] = carried[e].add(away);
                Double::default().sub(away)
            };
            for (x, d) in part.of_mut(&mut cell.c).iter_mut().zip(buffer.iter()) {
                *x = d.add(shift).hi;
            }
        }
        let beyond = (0..self.n).fold(1.0, |g: f64, j| {
            g.max((1.0 + 2.0 * (-cell.lo[j]).max(0.0)) * (1.0 + 2.0 * (cell.hi[j] - 1.0).max(0.0)))
        });
        let growth = if beyond > 1.0 {
            beyond.powi(self.degrees as i32)
        } else {
            1.0
        };
        cell.noise.resize(self.rows());
        cell.scale.resize(self.rows());
        for e in 0..self.rows() {
            cell.noise[e] = self.first_noise[e] * growth;
        }
        self.ranges(cell);
        for part in &self.parts {
            let e = part.equation;
            let steps: usize = part.axes.iter().map(|a| a.degree).sum();
            // Coefficients are initially normalised to at most 2; the rounding to single precision is local.
            cell.noise[e] += 2f64.powi(-94) * (steps + 4) as f64 * growth + EPSILON * cell.scale[e];
        }
    }

    /// The equations on the face `variable = lo` (or `hi`) of the cell, as a layout in the other variables over that face.
    ///
    /// Coefficients are copied unchanged, except for a power of two.
    pub(crate) fn face(&self, cell: &Cell, variable: usize, upper: bool) -> Layout {
        let others = |j: usize| if j < variable { j } else { j - 1 };
        let mut face = Layout {
            n: self.n - 1,
            m: self.m,
            degrees: self.degrees,
            tape: self.tape.clone(),
            ..Layout::default()
        };
        let mut factor = RowList::filled(1.0, self.rows());
        face.make_room(self.rows());
        for e in 0..self.rows() {
            if cell.scale[e] > 0.0 {
                factor[e] = 2f64.powi(-(cell.scale[e].log2().floor().clamp(-900.0, 900.0) as i32));
            }
            face.first_noise[e] = cell.noise[e] * factor[e];
            face.remainder[e] = self.remainder[e] * factor[e];
            if let Some(tape) = &mut face.tape {
                tape.scale[e] /= factor[e];
            }
            let widest = (0..self.n).fold(0.0, |m: f64, j| m.max(cell.hi[j] - cell.lo[j]));
            face.slope_remainder[e] = self.slope_remainder[e] * factor[e] * widest * (1.0 + 4.0 * EPSILON);
        }
        for part in &self.parts {
            let c = part.of(&cell.c);
            let offset = face.first.len();
            let scaled = |x: &f64| x * factor[part.equation];
            match part.axis(variable) {
                Some(axis) => {
                    let from = if upper { axis.degree * axis.inner } else { 0 };
                    for block in c.chunks_exact((axis.degree + 1) * axis.inner) {
                        face.first.extend(block[from..from + axis.inner].iter().map(scaled));
                    }
                }
                None => face.first.extend(c.iter().map(scaled)),
            }
            let mut axes = SmallVec::new();
            let mut inner = 1;
            for axis in part.axes.iter().filter(|a| a.variable != variable) {
                axes.push(Axis {
                    variable: others(axis.variable),
                    degree: axis.degree,
                    inner,
                });
                inner *= axis.degree + 1;
            }
            face.parts.push(Summand {
                equation: part.equation,
                offset,
                len: inner,
                axes,
            });
        }
        face.len = face.first.len();
        face
    }
}
