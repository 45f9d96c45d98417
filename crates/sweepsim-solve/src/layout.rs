//! Where the coefficients of a system lie, and what can be read off them: ranges, slopes, affine enclosures, values, each
//! with its rounding.
//!
//! An equation is a sum of *parts* in disjoint sets of variables, each a flat tensor. Bounds of such a sum are sums of bounds
//! and lose nothing, because the parts vary independently; `p(x) + q(y)` of degree 6 needs 14 coefficients, not 49.
//!
//! Errors come in two kinds. *Noise* bounds the difference of each equation's coefficients from those of a polynomial: a
//! derivative then errs by at most `2 d · noise`. The *remainder* bounds the difference of the polynomial from the function that it
//! stands for, and of its derivatives from that function's; it does not change under subdivision (but derivatives scale).

use crate::double::{self, Double};
use crate::matrix::{MAX_UNKNOWNS, Row, Square, ZERO};
use crate::part::{evaluate_part, hull_zeros, rest_range};
use crate::program::{AffineForm, Doubt, Jet, Model, Program, Range, Value};
use crate::tensor;
use smallvec::SmallVec;

/// `2⁻⁵²`: twice the unit roundoff.
pub(crate) const EPSILON: f64 = f64::EPSILON;

/// The highest degree in one variable.
pub const MAX_DEGREE: usize = 63;

/// A variable that a part depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub variable: usize,
    pub degree: usize,
    /// Coefficients between neighbours along this axis.
    pub inner: usize,
}

/// One summand of an equation (or of a leaf of one).
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// The row that it belongs to: an equation, or where equations are combined from leaves, a leaf.
    pub equation: usize,
    pub offset: usize,
    pub len: usize,
    /// Fastest first.
    pub axes: SmallVec<[Axis; 4]>,
}

impl Part {
    fn of<'a>(&self, c: &'a [f64]) -> &'a [f64] {
        &c[self.offset..self.offset + self.len]
    }

    fn of_mut<'a>(&self, c: &'a mut [f64]) -> &'a mut [f64] {
        &mut c[self.offset..self.offset + self.len]
    }

    fn axis(&self, variable: usize) -> Option<Axis> {
        self.axes.iter().copied().find(|a| a.variable == variable)
    }
}

/// All parts of a system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    /// Variables.
    pub n: usize,
    /// Equations.
    pub m: usize,
    pub parts: Vec<Part>,
    /// Coefficients in all.
    pub len: usize,
    /// Value remainder of each equation.
    pub remainder: Row,
    /// Remainder of each equation's derivatives with respect to coordinates in which the domain is `[0,1]ⁿ`.
    pub slope_remainder: Row,
    /// Largest degree sum of an equation: for the rounding of values.
    pub degrees: usize,
    /// The first coefficients, and their noise.
    pub first: Vec<f64>,
    pub first_noise: Row,
    /// What each equation was multiplied by: a power of two.
    pub factor: Row,
    /// How rows make equations; absent where each row is one.
    pub program: Option<Program>,
}

/// A box with the coefficients of all equations over it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    /// In coordinates in which the domain is `[0,1]ⁿ`; exact.
    pub lo: Row,
    pub hi: Row,
    /// Error of each equation's coefficients.
    pub noise: Row,
    /// Bound of their sizes.
    pub scale: Row,
    pub c: Vec<f64>,
}

/// An affine function with a bound of the rest, per equation: `fᵢ(z) ∈ constant + Σ slope·z ± radius` for `z ∈ [−½, ½]ⁿ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Affine {
    pub constant: Row,
    pub slope: Square,
    pub radius: Row,
}

/// Ranges of all first derivatives over a cell, in coordinates in which it is `[0,1]ⁿ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes {
    pub lo: Square,
    pub hi: Square,
}

impl Layout {
    /// Equations, or leaves of which these are combined: what has coefficients, noise, remainder.
    pub(crate) fn rows(&self) -> usize {
        self.program.as_ref().map_or(self.m, |p| p.leaves)
    }

    /// A cell that holds the first coefficients.
    pub(crate) fn root(&self) -> Cell {
        let mut cell = Cell {
            lo: [0.0; MAX_UNKNOWNS],
            hi: [1.0; MAX_UNKNOWNS],
            noise: self.first_noise,
            scale: [0.0; MAX_UNKNOWNS],
            c: self.first.clone(),
        };
        self.ranges(&mut cell);
        cell
    }

    /// Enclosures of the equations' values; also brings the cell's `scale` up to date.
    pub(crate) fn ranges(&self, cell: &mut Cell) -> (Row, Row) {
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        cell.scale = [0.0; MAX_UNKNOWNS];
        for part in &self.parts {
            let (l, h) = tensor::range(part.of(&cell.c));
            let e = part.equation;
            lo[e] += l;
            hi[e] += h;
            cell.scale[e] += tensor::greater(l.abs(), h.abs());
        }
        for e in 0..self.rows() {
            // Sums of a few parts: a rounding each.
            let pad = cell.noise[e] + self.remainder[e] + 4.0 * EPSILON * cell.scale[e];
            lo[e] -= pad;
            hi[e] += pad;
        }
        match &self.program {
            Some(program) => self.combined_ranges(program, cell, &(lo, hi)),
            None => (lo, hi),
        }
    }

    /// The equations' ranges by those of their leaves, and by their affine enclosures.
    fn combined_ranges(&self, program: &Program, cell: &Cell, rows: &(Row, Row)) -> (Row, Row) {
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        let affine = self.affine(cell, ZERO);
        for e in 0..self.m {
            let range = program.run(e, |row| Range {
                lo: rows.0[row],
                hi: rows.1[row],
            });
            let slopes: f64 = affine.slope[e].iter().map(|s| s.abs()).sum();
            let size = affine.constant[e].abs() + slopes;
            let reach = (0.5 * slopes + affine.radius[e]) * (1.0 + 16.0 * EPSILON) + 4.0 * EPSILON * size;
            lo[e] = range.lo.max(affine.constant[e] - reach);
            hi[e] = range.hi.min(affine.constant[e] + reach);
        }
        (lo, hi)
    }

    /// Whether some row's coefficients are mostly noise, and might be less so if computed anew.
    pub(crate) fn noisy(&self, cell: &Cell, totals: &(Row, Row), share: f64) -> bool {
        (0..self.rows()).any(|e| {
            let size = match self.program {
                Some(_) => cell.scale[e],
                None => totals.0[e].abs().max(totals.1[e].abs()),
            };
            cell.noise[e] > share * size && cell.noise[e] > 4.0 * self.first_noise[e]
        })
    }

    /// Whether an equation is zero on the cell, up to noise.
    pub(crate) fn vanishes(&self, cell: &Cell, totals: &(Row, Row), equation: usize) -> bool {
        let size = totals.0[equation].abs().max(totals.1[equation].abs());
        match self.program {
            Some(_) => size.is_finite() && size <= 2.5 * self.value_error(cell, equation),
            None => {
                let error = cell.noise[equation] + self.remainder[equation];
                size <= 2.5 * error + 64.0 * EPSILON * cell.scale[equation]
            }
        }
    }

    /// A bound of an equation's size on the cell (if it is finite).
    pub(crate) fn size(&self, cell: &Cell, equation: usize) -> f64 {
        match &self.program {
            Some(program) => program
                .run(equation, |row| Range {
                    lo: -cell.scale[row],
                    hi: cell.scale[row],
                })
                .magnitude(),
            None => cell.scale[equation],
        }
    }

    /// Whether an equation has a variable.
    pub(crate) fn depends(&self, equation: usize, variable: usize) -> bool {
        let has = |row: usize| {
            let mut own = self.parts.iter().filter(|p| p.equation == row);
            own.any(|p| p.axis(variable).is_some())
        };
        match &self.program {
            Some(program) => program.any(equation, has),
            None => has(equation),
        }
    }

    /// Whether an equation is zero on the whole domain, up to its noise.
    pub(crate) fn nothing(&self, equation: usize) -> bool {
        let zero = |row: usize| {
            let own = self.parts.iter().filter(|p| p.equation == row);
            let size: f64 = own
                .map(|p| tensor::range(p.of(&self.first)))
                .map(|(l, h)| tensor::greater(l.abs(), h.abs()))
                .sum();
            size <= 8.0 * (self.first_noise[row] + self.remainder[row])
        };
        match &self.program {
            Some(program) => program.any(equation, zero),
            None => zero(equation),
        }
    }

    /// Restricts along one variable; the new ends may lie outside the old ones.
    pub(crate) fn restrict(&self, cell: &mut Cell, variable: usize, lo: f64, hi: f64) {
        let (old_lo, old_hi) = (cell.lo[variable], cell.hi[variable]);
        let upper_first = lo - old_lo <= old_hi - lo;
        let width = old_hi - old_lo;
        // Two cuts, each as computed shares (s, t) of the exact sides.
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
        let mut grown = [1.0; MAX_UNKNOWNS];
        for part in &self.parts {
            let Some(axis) = part.axis(variable) else { continue };
            let c = part.of_mut(&mut cell.c);
            if upper_first && cut_upper {
                tensor::keep_upper(c, axis.degree, axis.inner, upper.0, upper.1);
            }
            if cut_lower {
                tensor::keep_lower(c, axis.degree, axis.inner, lower.0, lower.1);
            }
            if !upper_first && cut_upper {
                tensor::keep_upper(c, axis.degree, axis.inner, upper.0, upper.1);
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
            grown[e] = tensor::greater(grown[e], growth);
        }
        for e in 0..self.rows() {
            cell.scale[e] *= grown[e];
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
                    tensor::split(c, low, axis.degree, axis.inner, s, t);
                    let e = part.equation;
                    cell.noise[e] += 4.0 * EPSILON * axis.degree as f64 * cell.scale[e];
                }
                None => low.copy_from_slice(c),
            }
        }
        (lower.lo, lower.hi, lower.noise, lower.scale) = (cell.lo, cell.hi, cell.noise, cell.scale);
        lower.hi[variable] = at;
        cell.lo[variable] = at;
    }

    /// Computes the cell's coefficients anew from the first ones, in twice the precision. Cells may leave the domain a little: restriction to
    /// `[−a, 1 + b]` makes errors of degree `d` at most `((1 + 2a)(1 + 2b))ᵈ` times as large.
    ///
    /// Parts of one equation may be large where their sum is small: constants move to the first part, so that what is rounded is small.
    pub(crate) fn refresh(&self, cell: &mut Cell, buffer: &mut Vec<Double>) {
        let mut carried = [Double::default(); MAX_UNKNOWNS];
        // Last parts first: the first part of each equation takes what the others give away.
        for (number, part) in self.parts.iter().enumerate().rev() {
            let e = part.equation;
            buffer.clear();
            buffer.extend(part.of(&self.first).iter().map(|x| Double::new(*x)));
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
        cell.noise = self.first_noise.map(|e| e * growth);
        self.ranges(cell);
        for part in &self.parts {
            let e = part.equation;
            let steps: usize = part.axes.iter().map(|a| a.degree).sum();
            // Coefficients are normalised to at most 2 at first; the rounding to single precision is local.
            cell.noise[e] += 2f64.powi(-94) * (steps + 4) as f64 * growth + EPSILON * cell.scale[e];
        }
    }

    /// The equations on the face `variable = lo` (or `hi`) of the cell, as a layout in the other variables over that face.
    ///
    /// Coefficients are taken over as they are, but for a power of two.
    pub(crate) fn face(&self, cell: &Cell, variable: usize, upper: bool) -> Layout {
        let others = |j: usize| if j < variable { j } else { j - 1 };
        let mut face = Layout {
            n: self.n - 1,
            m: self.m,
            degrees: self.degrees,
            program: self.program.clone(),
            ..Layout::default()
        };
        let mut factor = [1.0; MAX_UNKNOWNS];
        for e in 0..self.rows() {
            if cell.scale[e] > 0.0 {
                factor[e] = 2f64.powi(-(cell.scale[e].log2().floor().clamp(-900.0, 900.0) as i32));
            }
            face.first_noise[e] = cell.noise[e] * factor[e];
            face.remainder[e] = self.remainder[e] * factor[e];
            if let Some(program) = &mut face.program {
                program.scale[e] /= factor[e];
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
            face.parts.push(Part {
                equation: part.equation,
                offset,
                len: inner,
                axes,
            });
        }
        face.len = face.first.len();
        face
    }

    /// The mean of each derivative over the cell (not rigorous; what uses it bounds the rest).
    pub(crate) fn mean_slopes(&self, c: &[f64]) -> Square {
        let rows = self.mean_row_slopes(c);
        let Some(program) = &self.program else { return rows };
        let mut means = [0.0; MAX_UNKNOWNS];
        for part in &self.parts {
            let values = part.of(c);
            means[part.equation] += values.iter().sum::<f64>() / values.len() as f64;
        }
        let mut slope = ZERO;
        for (e, row) in slope.iter_mut().enumerate().take(self.m) {
            let leaf = |r: usize| Value {
                value: means[r],
                gradient: rows[r],
            };
            *row = program.run(e, leaf).gradient;
        }
        slope
    }

    fn mean_row_slopes(&self, c: &[f64]) -> Square {
        let mut slope = ZERO;
        for part in &self.parts {
            let values = part.of(c);
            for axis in &part.axes {
                slope[part.equation][axis.variable] = tensor::mean_slope(values, axis.degree, axis.inner);
            }
        }
        slope
    }

    /// An affine enclosure of each equation, with the given slopes unless equations are combined of leaves.
    pub(crate) fn affine(&self, cell: &Cell, slope: Square) -> Affine {
        let Some(program) = &self.program else {
            return self.affine_rows(cell, slope);
        };
        let rows = self.affine_rows(cell, self.mean_row_slopes(&cell.c));
        let mut affine = Affine {
            constant: [0.0; MAX_UNKNOWNS],
            slope: ZERO,
            radius: [0.0; MAX_UNKNOWNS],
        };
        for e in 0..self.m {
            let form = program.run(e, |r| AffineForm {
                constant: rows.constant[r],
                slope: rows.slope[r],
                radius: rows.radius[r],
            });
            (affine.constant[e], affine.slope[e], affine.radius[e]) = (form.constant, form.slope, form.radius);
        }
        affine
    }

    fn affine_rows(&self, cell: &Cell, slope: Square) -> Affine {
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        for part in &self.parts {
            let (l, h) = rest_range(part, part.of(&cell.c), &slope[part.equation]);
            lo[part.equation] += l;
            hi[part.equation] += h;
        }
        let (mut constant, mut radius) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        for e in 0..self.rows() {
            let slopes: f64 = slope[e][..self.n].iter().map(|s| s.abs()).sum();
            // Slopes' shares round, their sum does, and the difference.
            let rounding = EPSILON * (2 * self.n + 8) as f64 * (cell.scale[e] + slopes);
            constant[e] = 0.5 * (lo[e] + hi[e]);
            radius[e] = 0.5 * (hi[e] - lo[e]) + rounding + cell.noise[e] + self.remainder[e];
        }
        Affine {
            constant,
            slope,
            radius,
        }
    }

    /// Enclosures of all derivatives over the cell.
    pub(crate) fn slopes(&self, cell: &Cell) -> Slopes {
        let (mut lo, mut hi) = (ZERO, ZERO);
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
        let Some(program) = &self.program else {
            return Slopes { lo, hi };
        };
        let rows = Slopes { lo, hi };
        for e in 0..self.m {
            let jet = program.run(e, |r| Jet {
                value: self.row_range(cell, r),
                slopes: std::array::from_fn(|j| Range {
                    lo: rows.lo[r][j],
                    hi: rows.hi[r][j],
                }),
            });
            for j in 0..self.n {
                (lo[e][j], hi[e][j]) = (jet.slopes[j].lo, jet.slopes[j].hi);
            }
        }
        Slopes { lo, hi }
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
        for part in &self.parts {
            let (v, gradient) = evaluate_part(part, part.of(c), s, buffer);
            value[part.equation] += v;
            for (axis, g) in part.axes.iter().zip(gradient) {
                jacobian[part.equation][axis.variable] += g;
            }
        }
        let Some(program) = &self.program else {
            return (value, jacobian);
        };
        let (rows, slopes) = (value, jacobian);
        for e in 0..self.m {
            let leaf = |r: usize| Value {
                value: rows[r],
                gradient: slopes[r],
            };
            let whole = program.run(e, leaf);
            (value[e], jacobian[e]) = (whole.value, whole.gradient);
        }
        (value, jacobian)
    }

    /// What [`evaluate`](Self::evaluate)'s values can be wrong by, for `s` within `[0,1]ⁿ`.
    pub(crate) fn value_error(&self, cell: &Cell, equation: usize) -> f64 {
        let steps = (4 * self.degrees + 8 * self.n + 8) as f64;
        let own = |row: usize| cell.noise[row] + self.remainder[row] + EPSILON * steps * cell.scale[row];
        match &self.program {
            Some(program) => {
                let leaf = |row: usize| Doubt {
                    range: self.row_range(cell, row),
                    error: own(row),
                };
                program.run(equation, leaf).error
            }
            None => own(equation),
        }
    }

    /// Where along `variable` an equation can vanish, by the convex hulls of its slabs' ranges: calls `found` with each
    /// equation's interval in `[0,1]`, or `None` where it cannot.
    pub(crate) fn project(
        &self,
        cell: &Cell,
        part_ranges: &[(f64, f64)],
        totals: &(Row, Row),
        variable: usize,
        window: &mut (f64, f64),
    ) {
        if self.program.is_some() {
            // Hulls of leaves do not make hulls of products.
            return;
        }
        let (mut low, mut high) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        for (part, own) in self.parts.iter().zip(part_ranges) {
            let Some(axis) = part.axis(variable) else { continue };
            let e = part.equation;
            tensor::envelope(part.of(&cell.c), axis.degree, axis.inner, &mut low, &mut high);
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
    pub(crate) fn part_ranges(&self, cell: &Cell, out: &mut Vec<(f64, f64)>) {
        out.clear();
        out.extend(self.parts.iter().map(|p| tensor::range(p.of(&cell.c))));
    }
}
