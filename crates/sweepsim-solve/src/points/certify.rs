//! The certificate of a root: a box that holds exactly one root, and a bound on its distance from a point.

use crate::coefficients::{Affine, Cell, Layout};
use crate::numbers::{Double, EPSILON, MAX_UNKNOWNS, Row, Square, ZERO, apply, inverse};

/// Roots that are known less well than this, in sides of the domain, are refined in double-double precision: `2⁻⁴⁰`.
const BLUNT: f64 = f64::from_bits((1023 - 40) << 52);
/// Refinement ends below this, in sides of the domain: `2⁻⁴⁸`.
const SHARP: f64 = f64::from_bits((1023 - 48) << 52);
/// The most steps of that refinement: it usually takes two.
const MORE_STEPS: u32 = 8;

/// A certified root in inner coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub point: Row,
    pub lo: Row,
    pub hi: Row,
    pub unique_lo: Row,
    pub unique_hi: Row,
    pub orientation: i8,
    /// Whether the enclosure leaves the box that it was found from.
    pub straddles: bool,
    pub boundary: bool,
}

/// Centre and half widths of the box that holds all roots of the cell, from its centre, in its sides.
pub(crate) fn newton_box(affine: &Affine, k: &Square, n: usize) -> (Row, Row) {
    let (mut centre, mut half) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
    for i in 0..n {
        let (mut sum, mut size) = (0.0, 0.0);
        for e in 0..n {
            sum -= k[i][e] * affine.constant[e];
            size += k[i][e].abs() * affine.constant[e].abs();
            half[i] += k[i][e].abs() * affine.radius[e];
        }
        // |I − K A| on z within ±½, with the rounding of its entries.
        let mut rest = 0.0;
        for j in 0..n {
            let (mut entry, mut entries) = (if i == j { -1.0 } else { 0.0 }, 1.0);
            for e in 0..n {
                entry += k[i][e] * affine.slope[e][j];
                entries += (k[i][e] * affine.slope[e][j]).abs();
            }
            rest += 0.5 * (f64::abs(entry) + 16.0 * EPSILON * entries);
        }
        centre[i] = sum;
        half[i] = (half[i] + rest) * (1.0 + 32.0 * EPSILON) + 16.0 * EPSILON * (size + 1.0);
    }
    (centre, half)
}

/// Proves that the cell holds exactly one root, and encloses it; `None` if that cannot be proved.
pub(crate) fn unique_root(
    layout: &Layout,
    cell: &mut Cell,
    buffer: &mut Vec<f64>,
    doubles: &mut Vec<Double>,
) -> Option<Found> {
    let n = layout.n;
    layout.ranges(cell);
    let mean = layout.mean_slopes(&cell.c);
    let (k, orientation) = inverse(&mean, n)?;
    let affine = layout.affine(cell, mean);
    let (centre, half) = newton_box(&affine, &k, n);
    if !(0..n).all(|j| centre[j].abs() + half[j] < 0.5) {
        return None;
    }
    // |I − K J| over the cell.
    let slopes = layout.slopes(cell);
    let mut rest = ZERO;
    let mut contraction: f64 = 0.0;
    for i in 0..n {
        let mut row = 0.0;
        for j in 0..n {
            let (mut middle, mut radius, mut size) = (if i == j { -1.0 } else { 0.0 }, 0.0, 1.0);
            for e in 0..n {
                let (lo, hi) = (slopes.lo[e][j], slopes.hi[e][j]);
                middle += k[i][e] * (0.5 * (lo + hi));
                radius += k[i][e].abs() * (0.5 * (hi - lo));
                size += k[i][e].abs() * lo.abs().max(hi.abs());
            }
            rest[i][j] = f64::abs(middle) + radius + 32.0 * EPSILON * size;
            row += rest[i][j];
        }
        // Row by row, since `max` would drop the NaN of an unbounded derivative.
        let contracts = row < 0.999;
        if !contracts {
            return None;
        }
        contraction = contraction.max(row);
    }
    // Newton's method inside the cell; the error of its last point is bounded in any case.
    let mut s = [0.0; MAX_UNKNOWNS];
    for j in 0..n {
        s[j] = 0.5 + centre[j];
    }
    let mut before = f64::INFINITY;
    let mut value;
    let mut steps = 0;
    let mut newton = k;
    loop {
        let jacobian;
        (value, jacobian) = layout.evaluate(&cell.c, &s, buffer);
        if let Some((k, _)) = inverse(&jacobian, n) {
            newton = k;
        }
        let step = apply(&newton, &value, n);
        let size = step[..n].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        steps += 1;
        // Quadratic convergence: the step after one of 1e-9 would be below rounding, but the value at the end is needed.
        let progress = size < before;
        if size == 0.0 || !progress || steps > 30 {
            break;
        }
        before = size;
        let mut moved = false;
        for j in 0..n {
            let next = (s[j] - step[j]).clamp(0.0, 1.0);
            moved |= next != s[j];
            s[j] = next;
        }
        if !moved {
            break;
        }
        if size < 1e-8 {
            value = layout.values(&cell.c, &s, buffer);
            break;
        }
    }
    let mut value_errors = [0.0; MAX_UNKNOWNS];
    for (e, error) in value_errors[..n].iter_mut().enumerate() {
        *error = layout.value_error(cell, e);
    }
    let side = |i: usize| cell.hi[i] - cell.lo[i];
    let mut point = [0.0; MAX_UNKNOWNS];
    for i in 0..n {
        point[i] = cell.lo[i] + s[i] * side(i);
    }
    let mut errors = distances(&k, &rest, contraction, &value, &value_errors, n);
    let sharp = errors.is_some_and(|errors| (0..n).all(|i| errors[i] * side(i) <= BLUNT));
    // Unless the equations themselves are known no better.
    let known_better = |e: usize| value_errors[e] > 4.0 * (layout.first_noise[e] + layout.remainder[e]);
    if !sharp && (0..n).any(known_better) {
        // The equations are nearly singular, or their values mostly noise: values in double-double precision, from the original coefficients.
        let mut better = point;
        for _ in 0..MORE_STEPS {
            let Some((value, value_errors)) = layout.residual(&better, doubles) else {
                break;
            };
            let own = distances(&k, &rest, contraction, &value, &value_errors, n);
            if let (Some(own), Some(old)) = (own, errors)
                && !(0..n).any(|i| own[i] < 0.5 * old[i])
            {
                break;
            }
            if own.is_some() {
                (errors, point) = (own, better);
            }
            if own.is_some_and(|own| (0..n).all(|i| own[i] * side(i) <= SHARP)) {
                break;
            }
            let step = apply(&newton, &value, n);
            for i in 0..n {
                better[i] = (better[i] - step[i] * side(i)).clamp(cell.lo[i], cell.hi[i]);
            }
        }
    }
    let errors = errors?;
    let mut found = Found {
        point: [0.0; MAX_UNKNOWNS],
        lo: [0.0; MAX_UNKNOWNS],
        hi: [0.0; MAX_UNKNOWNS],
        unique_lo: cell.lo,
        unique_hi: cell.hi,
        orientation,
        straddles: false,
        boundary: false,
    };
    for i in 0..n {
        let x = point[i];
        let pad = errors[i] * side(i) * (1.0 + 8.0 * EPSILON) + 2.0 * EPSILON * (x.abs() + side(i));
        found.point[i] = x;
        found.lo[i] = (x - pad).max(cell.lo[i]);
        found.hi[i] = (x + pad).min(cell.hi[i]);
    }
    Some(found)
}

/// Bounds of a root's distance from a point with these values of the equations, in sides of the cell, entry by entry; `None` if they are no
/// less than the cell. `rest` bounds `|I − K J|` on the cell, and its row sums are at most `contraction`.
fn distances(k: &Square, rest: &Square, contraction: f64, value: &Row, value_errors: &Row, n: usize) -> Option<Row> {
    let mut direct = [0.0; MAX_UNKNOWNS];
    let mut largest: f64 = 0.0;
    for i in 0..n {
        let (mut sum, mut error) = (0.0, 0.0);
        for e in 0..n {
            sum += k[i][e] * value[e];
            error += k[i][e].abs() * (value_errors[e] + 16.0 * EPSILON * f64::abs(value[e]));
        }
        direct[i] = f64::abs(sum) + error;
        if !direct[i].is_finite() {
            return None;
        }
        largest = largest.max(direct[i]);
    }
    let all = largest / (1.0 - contraction) * (1.0 + 8.0 * EPSILON);
    let useful = all <= 1.0;
    if !useful {
        return None;
    }
    // Error ≤ direct + rest · error, entry by entry: a few iterations turn the common bound into one for each entry.
    let mut errors = [all; MAX_UNKNOWNS];
    for _ in 0..60 {
        let mut better = direct;
        for i in 0..n {
            for j in 0..n {
                better[i] += rest[i][j] * errors[j];
            }
            better[i] *= 1.0 + 16.0 * EPSILON;
        }
        let done = (0..n).all(|i| better[i] > 0.9 * errors[i]);
        errors = better;
        if done {
            break;
        }
    }
    Some(errors)
}
