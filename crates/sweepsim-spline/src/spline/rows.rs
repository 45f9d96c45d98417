//! Linear maps along one axis, and their accuracy.
//!
//! Knot insertion, degree elevation, the way to Bernstein pieces and back: each makes every new coefficient a short
//! linear combination of old ones. The combinations are found by running the algorithm (Boehm's insertion, de
//! Casteljau's blossom, elevation) on *rows* instead of on control points, starting from unit rows, and are then
//! applied once, along any axis. A row carries the data needed to bound the error of the result; the proof is in
//! `docs/error-bounds.md`.

use crate::kernel::{Along, accumulate};
use crate::knots::KnotVector;
use crate::rounding::{UNDERFLOW, gamma, up};
use smallvec::SmallVec;

/// One new coefficient: `Σ weights[j] · old[start + j]`.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    pub start: usize,
    pub weights: SmallVec<[f64; 8]>,
    /// At least the sum of the absolute values of all terms that went into the weights, so at least `Σ |weights|`.
    pub growth: f64,
    /// The weights are within `γ(roundings) · growth`, in sum, of the exact ones.
    pub roundings: usize,
    /// Whether the sum of the exact weights is 1: equal coefficients give the same one, to the bit.
    pub is_affine: bool,
}

/// The roundings of a step `s a + t b` with `s = (v − x)/(v − w)`: three in `s`, one product, one sum.
const STEP: usize = 5;

impl Row {
    pub fn unit(index: usize) -> Self {
        Self {
            start: index,
            weights: SmallVec::from_slice(&[1.0]),
            growth: 1.0,
            roundings: 0,
            is_affine: true,
        }
    }

    pub fn zero() -> Self {
        Self {
            start: 0,
            weights: SmallVec::new(),
            growth: 0.0,
            roundings: 0,
            is_affine: false,
        }
    }

    /// `s a + t b`, `s` and `t` with up to three roundings each, and a sum of 1.
    pub fn blend(a: &Self, s: f64, b: &Self, t: f64) -> Self {
        if t == 0.0 && s == 1.0 {
            return a.clone();
        }
        if s == 0.0 && t == 1.0 {
            return b.clone();
        }
        let start = a.start.min(b.start);
        let end = (a.start + a.weights.len()).max(b.start + b.weights.len());
        let mut weights: SmallVec<[f64; 8]> = SmallVec::from_elem(0.0, end - start);
        for (i, w) in a.weights.iter().enumerate() {
            weights[a.start - start + i] = s * w;
        }
        for (i, w) in b.weights.iter().enumerate() {
            weights[b.start - start + i] += t * w;
        }
        Self {
            start,
            weights,
            growth: up(s.abs() * a.growth + t.abs() * b.growth),
            roundings: a.roundings.max(b.roundings) + STEP,
            is_affine: a.is_affine && b.is_affine,
        }
    }

    fn is_copy(&self) -> bool {
        self.weights.len() == 1 && self.weights[0] == 1.0 && self.roundings == 0
    }
}

/// Applies `rows` along an axis: the new coefficients, and their error bound.
///
/// `size` and `error` are the old coefficients' magnitude and error bound. `view.len` is the old length.
pub(crate) fn apply(rows: &[Row], data: &[f64], view: Along, size: f64, error: f64) -> (Vec<f64>, f64) {
    let Along { inner, len, .. } = view;
    let mut out = vec![0.0; view.outer * rows.len() * inner];
    if rows.is_empty() || inner == 0 {
        return (out, error);
    }
    for (to, from) in out
        .chunks_exact_mut(rows.len() * inner)
        .zip(data.chunks_exact(len * inner))
    {
        for (target, row) in to.chunks_exact_mut(inner).zip(rows) {
            if row.is_copy() {
                target.copy_from_slice(&from[row.start * inner..(row.start + 1) * inner]);
                continue;
            }
            for (j, &weight) in row.weights.iter().enumerate() {
                let at = (row.start + j) * inner;
                accumulate(target, &from[at..at + inner], weight);
            }
            if row.is_affine {
                // A pole stays a point, and a face flat.
                for (k, value) in target.iter_mut().enumerate() {
                    let mut used = (row.start..row.start + row.weights.len()).map(|j| from[j * inner + k]);
                    let first = used.next();
                    if let Some(first) = first.filter(|first| used.all(|other| other == *first)) {
                        *value = first;
                    }
                }
            }
        }
    }
    let mut bound: f64 = 0.0;
    for row in rows {
        let own = if row.is_copy() {
            error
        } else {
            let rounding = if size == 0.0 {
                0.0
            } else {
                let terms = row.weights.len();
                let underflow = (row.roundings + terms) as f64 * UNDERFLOW;
                gamma(row.roundings + terms + 1) * size * row.growth + underflow * (1.0 + size) * (1.0 + row.growth)
            };
            up(row.growth * error + rounding)
        };
        bound = if own > bound { own } else { bound };
    }
    (out, bound)
}

/// Inserts `x` once into `knots` (degree `p`), with the rows of the coefficients. `t_p ≤ x ≤ t_n`, of multiplicity ≤ p.
pub(crate) fn insert(knots: &mut Vec<f64>, p: usize, rows: &mut Vec<Row>, x: f64) {
    let up_to = knots.partition_point(|&t| t <= x);
    let multiplicity = up_to - knots.partition_point(|&t| t < x);
    let k = up_to - 1;
    // Coefficients k−p+1 … k−multiplicity are blends of neighbours; from the top down, the old are still there.
    let first = k + 1 - p;
    let last = k - multiplicity;
    let duplicate = rows[last.min(rows.len() - 1)].clone();
    let mut fresh: SmallVec<[Row; 8]> = SmallVec::new();
    for i in first..=last {
        let (t, v) = (knots[i], knots[i + p]);
        fresh.push(Row::blend(&rows[i - 1], (v - x) / (v - t), &rows[i], (x - t) / (v - t)));
    }
    // Old coefficients up to k−p stay, from k−multiplicity on they move up by one.
    rows.insert(last, duplicate);
    for (slot, row) in rows[first..].iter_mut().zip(fresh) {
        *slot = row;
    }
    knots.insert(up_to, x);
}

/// The rows that insert `values` (sorted or not, each of a total multiplicity ≤ the order), and the finer knots.
pub(crate) fn refinement(vector: &KnotVector, values: &[f64]) -> (Vec<f64>, Vec<Row>) {
    let mut knots = vector.knots().to_vec();
    let mut rows: Vec<Row> = (0..vector.count()).map(Row::unit).collect();
    for &x in values {
        insert(&mut knots, vector.degree(), &mut rows, x);
    }
    (knots, rows)
}

/// The rows of the Bernstein coefficients, `degree + 1` for each span between neighbouring `breakpoints`.
///
/// `breakpoints` are sorted, without repetition, and contain those of `vector`. Coefficient `j` on `[a, b]` is the
/// blossom at `a` (`p − j` times) and `b` (`j` times), by de Boor's algorithm: as `[a, b]` is within one span of the
/// knots, every step is a convex combination.
pub(crate) fn extraction(vector: &KnotVector, breakpoints: &[f64]) -> Vec<Row> {
    let p = vector.degree();
    let mut pieces = Vec::with_capacity((breakpoints.len() - 1) * (p + 1));
    for ends in breakpoints.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        let span = vector.span(a);
        // `from_a` after `p − j` steps at `a`; from there `j` steps at `b`. So j falls from p to 0.
        let mut from_a: SmallVec<[Row; 8]> = (span - p..=span).map(Row::unit).collect();
        let first = pieces.len();
        for done in 0..=p {
            let mut local = from_a.clone();
            for step in done..p {
                blossom_step(vector.knots(), span, p, step, &mut local, b);
            }
            pieces.push(local.swap_remove(0));
            if done < p {
                blossom_step(vector.knots(), span, p, done, &mut from_a, a);
            }
        }
        pieces[first..].reverse();
    }
    pieces
}

/// Step `step` (from 0) of de Boor's algorithm at `u`: `p + 1 − step` rows become one fewer.
fn blossom_step(knots: &[f64], span: usize, p: usize, step: usize, rows: &mut SmallVec<[Row; 8]>, u: f64) {
    for j in 0..p - step {
        let i = span + j + 1 + step - p;
        let (t, v) = (knots[i], knots[i + p - step]);
        rows[j] = Row::blend(&rows[j], (v - u) / (v - t), &rows[j + 1], (u - t) / (v - t));
    }
    rows.truncate(p - step);
}

/// Elevates the rows of Bernstein pieces of `degree` by `by`.
pub(crate) fn elevation(pieces: &[Row], degree: usize, by: usize) -> Vec<Row> {
    let mut current = pieces.to_vec();
    for d in degree..degree + by {
        let mut next = Vec::with_capacity(current.len() / (d + 1) * (d + 2));
        for piece in current.chunks_exact(d + 1) {
            let order = (d + 1) as f64;
            next.push(piece[0].clone());
            for k in 1..=d {
                next.push(if d == 0 {
                    piece[0].clone()
                } else {
                    Row::blend(&piece[k - 1], k as f64 / order, &piece[k], (order - k as f64) / order)
                });
            }
            next.push(piece[d].clone());
        }
        current = next;
    }
    current
}

/// The rows of the coefficients on `target` of the function whose Bernstein pieces between `breakpoints` are `pieces`.
///
/// Coefficient `j` is the blossom of any one piece in its support at the knots `t_{j+1}, …, t_{j+p}`: of all the piece
/// where that grows least. `None` if some support has no piece. The function must have the target's continuity.
pub(crate) fn join(pieces: &[Row], breakpoints: &[f64], target: &KnotVector) -> Option<Vec<Row>> {
    let p = target.degree();
    let knots = target.knots();
    let mut rows = Vec::with_capacity(target.count());
    for j in 0..target.count() {
        let (from, to) = (knots[j], knots[j + p + 1]);
        let arguments = &knots[j + 1..j + 1 + p];
        let growth = |s: usize| {
            let (a, b) = (breakpoints[s], breakpoints[s + 1]);
            arguments
                .iter()
                .fold(1.0, |g, &u| g * (((b - u).abs() + (u - a).abs()) / (b - a)))
        };
        let first = breakpoints.partition_point(|&b| b < from);
        let mut best: Option<(usize, f64)> = None;
        for s in first..breakpoints.len() - 1 {
            if breakpoints[s + 1] > to {
                break;
            }
            let g = growth(s);
            if best.is_none_or(|(_, least)| g < least) {
                best = Some((s, g));
            }
        }
        let (span, _) = best?;
        let (a, b) = (breakpoints[span], breakpoints[span + 1]);
        let mut local: SmallVec<[Row; 8]> = pieces[span * (p + 1)..(span + 1) * (p + 1)].into();
        for (r, &u) in arguments.iter().enumerate() {
            let (s, t) = ((b - u) / (b - a), (u - a) / (b - a));
            for i in 0..p - r {
                local[i] = Row::blend(&local[i], s, &local[i + 1], t);
            }
        }
        rows.push(local.swap_remove(0));
    }
    Some(rows)
}

/// The rows from the coefficients on `from` to those on `to`, of the same domain and no lower degree.
///
/// `None` if `to` lacks a place where `from` is only so smooth, or a support of `to` is outside the domain.
pub(crate) fn conversion(from: &KnotVector, to: &KnotVector) -> Option<Vec<Row>> {
    let by = to.degree().checked_sub(from.degree())?;
    if by == 0
        && let Some(missing) = missing_knots(from.knots(), to.knots())
        && missing.iter().all(|&x| from.domain().0 <= x && x <= from.domain().1)
    {
        let (knots, rows) = refinement(from, &missing);
        // Clamping leaves knots beyond the domain that the target does not have.
        let skip = knots.partition_point(|&t| t < to.knots()[0]);
        let rows = rows.get(skip..skip + to.count())?;
        return Some(rows.to_vec());
    }
    let mut breakpoints = from.breakpoints();
    breakpoints.extend(to.breakpoints());
    breakpoints.sort_by(f64::total_cmp);
    breakpoints.dedup();
    let pieces = elevation(&extraction(from, &breakpoints), from.degree(), by);
    join(&pieces, &breakpoints, to)
}

/// The knots of `to` that `from` lacks, if `to` has all those of `from` that lie between its own first and last.
fn missing_knots(from: &[f64], to: &[f64]) -> Option<Vec<f64>> {
    let (first, last) = (to[0], to[to.len() - 1]);
    let mut missing = Vec::new();
    let mut rest = from.iter().copied().filter(|&t| t >= first && t <= last).peekable();
    for &t in to {
        match rest.peek() {
            Some(&s) if s == t => {
                rest.next();
            }
            Some(&s) if s < t => return None,
            _ => missing.push(t),
        }
    }
    rest.next().is_none().then_some(missing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// Of refinement, extraction, elevation and the way back.
        #[test]
        fn equal_coefficients_stay_equal(value in -50.0..50.0, gaps in collection::vec(0.1..3.0, 5..9), degree in 1..5_usize, clamped in any::<bool>()) {
            let inner = gaps.iter().scan(0.0, |at: &mut f64, gap| { *at += gap; Some(*at) });
            let mut knots: Vec<f64> = inner.collect();
            if clamped {
                let (first, last) = (knots[0], knots[knots.len() - 1]);
                knots = [vec![first; degree], knots, vec![last; degree]].concat();
            }
            let Ok(vector) = KnotVector::new(degree, knots) else { return Ok(()) };
            let breakpoints = vector.breakpoints();
            let pieces = extraction(&vector, &breakpoints);
            let back = join(&pieces, &breakpoints, &vector).unwrap();
            let middle = 0.3 * breakpoints[0] + 0.7 * breakpoints[1];
            let (_, finer) = refinement(&vector, &[middle, middle]);
            for rows in [pieces.clone(), elevation(&pieces, degree, 2), back, finer] {
                // Another component, which differs.
                let data: Vec<f64> = (0..vector.count()).flat_map(|k| [value, k as f64]).collect();
                let view = Along { outer: 1, len: vector.count(), inner: 2 };
                let (found, _) = apply(&rows, &data, view, 50.0, 0.0);
                prop_assert!(found.chunks(2).all(|pair| pair[0] == value), "{found:?}");
            }
        }
    }
}
