//! What a cell's coefficients tell about its equations: ranges, affine enclosures, derivatives, values.
//!
//! What treats rows is compiled twice, for systems with and without expressions, and must be inlined: it costs two instructions in a hundred otherwise.

use super::layout::{Affine, Cell, Layout, MAX_DEGREE, Slopes};
use super::models::{AffineForm, Doubt, Jet, Value};
use super::range::Range;
use super::summand::{evaluate_part, hull_zeros, part_value, rest_range};
use super::tape::{Model, Tape};
use super::tensor;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row, Square, ZERO};

impl Layout {
    /// Enclosures of the equations' values; also brings the cell's `scale` up to date.
    pub(crate) fn ranges(&self, cell: &mut Cell) -> (Row, Row) {
        if let Some(tape) = &self.tape {
            let (mut lo, mut hi) = (vec![0.0; tape.leaves], vec![0.0; tape.leaves]);
            self.row_ranges(cell, &mut lo, &mut hi);
            return self.combined_ranges(tape, cell, &lo, &hi);
        }
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        self.row_ranges(cell, &mut lo, &mut hi);
        (lo, hi)
    }

    /// The rows' ranges.
    #[inline(always)]
    fn row_ranges(&self, cell: &mut Cell, lo: &mut [f64], hi: &mut [f64]) {
        cell.scale.clear();
        for part in &self.parts {
            let (l, h) = tensor::range(part.of(&cell.c));
            let e = part.equation;
            lo[e] += l;
            hi[e] += h;
            cell.scale[e] += tensor::greater(l.abs(), h.abs());
        }
        for e in 0..self.rows() {
            // Sums of a few parts: one rounding each.
            let pad = cell.noise[e] + self.remainder[e] + 4.0 * EPSILON * cell.scale[e];
            lo[e] -= pad;
            hi[e] += pad;
        }
    }

    /// The equations' ranges by those of their leaves, and by their affine enclosures.
    fn combined_ranges(&self, tape: &Tape, cell: &Cell, low: &[f64], high: &[f64]) -> (Row, Row) {
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        let affine = self.affine(cell, ZERO);
        for e in 0..self.m {
            let range = tape.run(e, |row| Range {
                lo: low[row],
                hi: high[row],
            });
            if range.divided() && range.misses_zero() {
                // No solution near the pole, or none where a function is not defined.
                (lo[e], hi[e]) = (f64::INFINITY, f64::INFINITY);
                continue;
            }
            let range = range.interval();
            let slopes: f64 = affine.slope[e].iter().map(|s| s.abs()).sum();
            let size = affine.constant[e].abs() + slopes;
            let reach = (0.5 * slopes + affine.radius[e]) * (1.0 + 16.0 * EPSILON) + 4.0 * EPSILON * size;
            lo[e] = range.lo.max(affine.constant[e] - reach);
            hi[e] = range.hi.min(affine.constant[e] + reach);
        }
        (lo, hi)
    }

    /// The mean of each derivative over the cell (not rigorous; its users bound the rest).
    #[inline(always)]
    pub(crate) fn mean_slopes(&self, c: &[f64]) -> Square {
        let mut slope = ZERO;
        match &self.tape {
            None => self.mean_row_slopes(c, &mut slope),
            Some(tape) => self.combined_mean_slopes(tape, c, &mut slope),
        }
        slope
    }

    fn combined_mean_slopes(&self, tape: &Tape, c: &[f64], slope: &mut Square) {
        let mut rows = vec![[0.0; MAX_UNKNOWNS]; tape.leaves];
        self.mean_row_slopes(c, &mut rows);
        let mut means = vec![0.0; tape.leaves];
        for part in &self.parts {
            let values = part.of(c);
            means[part.equation] += values.iter().sum::<f64>() / values.len() as f64;
        }
        for (e, row) in slope.iter_mut().enumerate().take(self.m) {
            let leaf = |r: usize| Value {
                value: means[r],
                gradient: rows[r],
            };
            *row = tape.run(e, leaf).gradient;
        }
    }

    #[inline(always)]
    fn mean_row_slopes(&self, c: &[f64], slope: &mut [Row]) {
        for part in &self.parts {
            let values = part.of(c);
            if values.len() >= tensor::MANY {
                let mut axes = part.axes.iter().rev();
                let shape = part.axes.iter().map(|a| (a.degree, a.inner));
                tensor::mean_slopes(values, shape, |mean| {
                    if let Some(axis) = axes.next() {
                        slope[part.equation][axis.variable] = mean;
                    }
                });
                continue;
            }
            for axis in &part.axes {
                slope[part.equation][axis.variable] = tensor::mean_slope(values, axis.degree, axis.inner);
            }
        }
    }

    /// An affine enclosure of each equation, with the given slopes unless equations are combined from leaves.
    #[inline(always)]
    pub(crate) fn affine(&self, cell: &Cell, slope: Square) -> Affine {
        let mut affine = Affine {
            constant: [0.0; MAX_UNKNOWNS],
            slope,
            radius: [0.0; MAX_UNKNOWNS],
        };
        let Some(tape) = &self.tape else {
            let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
            self.affine_rows(
                cell,
                &affine.slope,
                [&mut lo, &mut hi],
                &mut affine.constant,
                &mut affine.radius,
            );
            return affine;
        };
        self.combined_affine(tape, cell, &mut affine);
        affine
    }

    fn combined_affine(&self, tape: &Tape, cell: &Cell, affine: &mut Affine) {
        let leaves = tape.leaves;
        let mut slopes = vec![[0.0; MAX_UNKNOWNS]; leaves];
        self.mean_row_slopes(&cell.c, &mut slopes);
        let (mut constant, mut radius) = (vec![0.0; leaves], vec![0.0; leaves]);
        let (mut lo, mut hi) = (vec![0.0; leaves], vec![0.0; leaves]);
        self.affine_rows(cell, &slopes, [&mut lo, &mut hi], &mut constant, &mut radius);
        for e in 0..self.m {
            let form = tape.run(e, |r| AffineForm {
                constant: constant[r],
                slope: slopes[r],
                radius: radius[r],
            });
            (affine.constant[e], affine.slope[e], affine.radius[e]) = (form.constant, form.slope, form.radius);
        }
    }

    /// Affine enclosures of rows with these slopes; `lo` and `hi` are working memory, zero at first.
    #[inline(always)]
    fn affine_rows(
        &self,
        cell: &Cell,
        slope: &[Row],
        [lo, hi]: [&mut [f64]; 2],
        constant: &mut [f64],
        radius: &mut [f64],
    ) {
        for part in &self.parts {
            let (l, h) = rest_range(part, part.of(&cell.c), &slope[part.equation]);
            lo[part.equation] += l;
            hi[part.equation] += h;
        }
        for e in 0..self.rows() {
            let slopes: f64 = slope[e][..self.n].iter().map(|s| s.abs()).sum();
            // Slopes' shares round, their sum does, and the difference.
            let rounding = EPSILON * (2 * self.n + 8) as f64 * (cell.scale[e] + slopes);
            constant[e] = 0.5 * (lo[e] + hi[e]);
            radius[e] = 0.5 * (hi[e] - lo[e]) + rounding + cell.noise[e] + self.remainder[e];
        }
    }

    /// Enclosures of all derivatives over the cell.
    pub(crate) fn slopes(&self, cell: &Cell) -> Slopes {
        let (mut lo, mut hi) = (ZERO, ZERO);
        let Some(tape) = &self.tape else {
            self.row_slopes(cell, &mut lo, &mut hi);
            return Slopes { lo, hi };
        };
        let zero = [0.0; MAX_UNKNOWNS];
        let (mut low, mut high) = (vec![zero; tape.leaves], vec![zero; tape.leaves]);
        self.row_slopes(cell, &mut low, &mut high);
        for e in 0..self.m {
            let jet = tape.run(e, |r| Jet {
                value: self.row_range(cell, r),
                slopes: std::array::from_fn(|j| Range {
                    lo: low[r][j],
                    hi: high[r][j],
                }),
            });
            for j in 0..self.n {
                (lo[e][j], hi[e][j]) = (jet.slopes[j].lo, jet.slopes[j].hi);
            }
        }
        Slopes { lo, hi }
    }

    /// Whether all derivatives are bounded on the cell.
    pub(crate) fn differentiable(&self, cell: &Cell) -> bool {
        let slopes = self.slopes(cell);
        let bounded = |rows: &Square| rows[..self.m].iter().flatten().all(|x| x.is_finite());
        bounded(&slopes.lo) && bounded(&slopes.hi)
    }

    /// Enclosures of the rows' derivatives.
    #[inline(always)]
    fn row_slopes(&self, cell: &Cell, lo: &mut [Row], hi: &mut [Row]) {
        for part in &self.parts {
            let values = part.of(&cell.c);
            let e = part.equation;
            for axis in &part.axes {
                let (l, h) = tensor::slopes(values, axis.degree, axis.inner);
                let pad = 2.0 * axis.degree as f64 * (cell.noise[e] + 2.0 * EPSILON * cell.scale[e]);
                lo[e][axis.variable] = l - pad;
                hi[e][axis.variable] = h + pad;
            }
        }
        for e in 0..self.rows() {
            if self.slope_remainder[e] > 0.0 {
                for j in 0..self.n {
                    let pad = self.slope_remainder[e] * (cell.hi[j] - cell.lo[j]) * (1.0 + 4.0 * EPSILON);
                    lo[e][j] -= pad;
                    hi[e][j] += pad;
                }
            }
        }
    }

    /// The range of one row.
    fn row_range(&self, cell: &Cell, row: usize) -> Range {
        let mut range = Range::constant(0.0);
        let mut size = 0.0;
        for part in self.parts.iter().filter(|p| p.equation == row) {
            let (l, h) = tensor::range(part.of(&cell.c));
            range.lo += l;
            range.hi += h;
            size += tensor::greater(l.abs(), h.abs());
        }
        let pad = cell.noise[row] + self.remainder[row] + 4.0 * EPSILON * size;
        Range {
            lo: range.lo - pad,
            hi: range.hi + pad,
        }
    }

    /// Value and derivatives of each equation at `s` (in coordinates in which the cell is `[0,1]ⁿ`), without error bounds.
    pub(crate) fn evaluate(&self, c: &[f64], s: &Row, buffer: &mut Vec<f64>) -> (Row, Square) {
        let mut value = [0.0; MAX_UNKNOWNS];
        let mut jacobian = ZERO;
        let Some(tape) = &self.tape else {
            self.evaluate_rows(c, s, buffer, &mut value, &mut jacobian);
            return (value, jacobian);
        };
        let (mut rows, mut slopes) = (vec![0.0; tape.leaves], vec![[0.0; MAX_UNKNOWNS]; tape.leaves]);
        self.evaluate_rows(c, s, buffer, &mut rows, &mut slopes);
        for e in 0..self.m {
            let leaf = |r: usize| Value {
                value: rows[r],
                gradient: slopes[r],
            };
            let whole = tape.run(e, leaf);
            (value[e], jacobian[e]) = (whole.value, whole.gradient);
        }
        (value, jacobian)
    }

    #[inline(always)]
    fn evaluate_rows(&self, c: &[f64], s: &Row, buffer: &mut Vec<f64>, value: &mut [f64], jacobian: &mut [Row]) {
        for part in &self.parts {
            let (v, gradient) = evaluate_part(part, part.of(c), s, buffer);
            value[part.equation] += v;
            for (axis, g) in part.axes.iter().zip(gradient) {
                jacobian[part.equation][axis.variable] += g;
            }
        }
    }

    /// The values of [`evaluate`](Self::evaluate) alone.
    pub(crate) fn values(&self, c: &[f64], s: &Row, buffer: &mut Vec<f64>) -> Row {
        if self.tape.is_some() {
            return self.evaluate(c, s, buffer).0;
        }
        let mut values = [0.0; MAX_UNKNOWNS];
        for part in &self.parts {
            values[part.equation] += part_value(part, part.of(c), s, buffer);
        }
        values
    }

    /// A bound on the error of the values of [`evaluate`](Self::evaluate), for `s` in `[0,1]ⁿ`.
    pub(crate) fn value_error(&self, cell: &Cell, equation: usize) -> f64 {
        let steps = (4 * self.degrees + 8 * self.n + 8) as f64;
        let own = |row: usize| cell.noise[row] + self.remainder[row] + EPSILON * steps * cell.scale[row];
        match &self.tape {
            Some(tape) => {
                let leaf = |row: usize| Doubt {
                    range: self.row_range(cell, row),
                    error: own(row),
                };
                tape.run(equation, leaf).error
            }
            None => own(equation),
        }
    }

    /// Where along `variable` an equation can vanish, by the convex hulls of its slabs' ranges: calls `found` with each
    /// equation's interval in `[0,1]`, or `None` where it cannot.
    pub(crate) fn project(
        &self,
        cell: &Cell,
        part_ranges: &PartRanges,
        totals: &(Row, Row),
        variable: usize,
        window: &mut (f64, f64),
    ) {
        if self.tape.is_some() {
            // Hulls of leaves do not combine to hulls of products.
            return;
        }
        let (mut low, mut high) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let mut ends = &part_ranges.ends[..];
        for (part, own) in self.parts.iter().zip(&part_ranges.whole) {
            let mut envelopes = ends;
            if part.len >= tensor::MANY {
                (envelopes, ends) = ends.split_at(part.axes.iter().map(|a| a.degree + 1).sum());
            }
            let Some(axis) = part.axis(variable) else { continue };
            let e = part.equation;
            if part.len >= tensor::MANY {
                // The slowest axis comes first.
                let before = part.axes.iter().rev().take_while(|a| a.variable != variable);
                let start: usize = before.map(|a| a.degree + 1).sum();
                for (k, (l, h)) in envelopes[start..=start + axis.degree].iter().enumerate() {
                    (low[k], high[k]) = (*l, *h);
                }
            } else {
                tensor::envelope(part.of(&cell.c), axis.degree, axis.inner, &mut low, &mut high);
            }
            // The other parts' ranges: the equation's (padded) less this part's.
            let pad = 8.0 * EPSILON * cell.scale[e];
            let (below, above) = (totals.0[e] - own.0 - pad, totals.1[e] - own.1 + pad);
            for k in 0..=axis.degree {
                low[k] += below;
                high[k] += above;
            }
            hull_zeros(&low[..=axis.degree], &high[..=axis.degree], window);
            if window.0 > window.1 {
                return;
            }
        }
    }

    /// Ranges of the parts, for [`project`](Self::project).
    pub(crate) fn part_ranges(&self, cell: &Cell, out: &mut PartRanges) {
        out.whole.clear();
        out.ends.clear();
        for part in &self.parts {
            let values = part.of(&cell.c);
            out.whole.push(tensor::range(values));
            if part.len >= tensor::MANY {
                let shape = part.axes.iter().map(|a| (a.degree, a.inner));
                tensor::envelopes(values, shape, |l, h| out.ends.push((l, h)));
            }
        }
    }
}

/// Ranges of parts: of each as a whole and, of large ones, of the slabs along each axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct PartRanges {
    whole: Vec<(f64, f64)>,
    /// Of one large part after the other, the slowest axis first.
    ends: Vec<(f64, f64)>,
}
