//! From Bernstein forms to a layout: normalised, and separated into parts that share no variables.

use super::{Equation, MAX_SYSTEM, SystemError};
use crate::coefficients::{Axis, Layout, MAX_DEGREE, Summand};
use crate::numbers::{Double, EPSILON};
use smallvec::SmallVec;
use sweepsim_spline::Bernstein;

/// Adds the parts of an equation, or of a leaf of it, as a row, normalised by a power of two.
pub(crate) fn add(layout: &mut Layout, row: usize, equation: usize, given: &Equation) -> Result<(), SystemError> {
    let n = layout.n;
    let not_finite = SystemError::NotFinite { equation };
    if given.terms.is_empty() {
        return Err(SystemError::EmptySum { equation });
    }
    let bounds_valid = |x: f64| x.is_finite() && x >= 0.0;
    if !bounds_valid(given.remainder) || !bounds_valid(given.slope_remainder) {
        return Err(not_finite);
    }
    let mut magnitude: f64 = 0.0;
    for term in &given.terms {
        if term.variables() != n {
            return Err(SystemError::FormVariables {
                equation,
                variables: term.variables(),
                expected: n,
            });
        }
        if !bounds_valid(term.error()) {
            return Err(not_finite);
        }
        let (lo, hi) = crate::coefficients::tensor::range(term.coefficients());
        if !(lo.is_finite() && hi.is_finite()) || term.coefficients().iter().any(|c| c.is_nan()) {
            return Err(not_finite);
        }
        magnitude = magnitude.max(lo.abs()).max(hi.abs());
        let degree = term.degrees().iter().copied().max().unwrap_or(0);
        let coefficients = layout.len + term.coefficients().len();
        if degree > MAX_DEGREE || coefficients > MAX_SYSTEM {
            return Err(SystemError::TooLarge {
                equation,
                degree,
                coefficients,
            });
        }
    }
    // A power of two: no rounding. Two factors, since one may overflow.
    let exponent = if magnitude > 0.0 {
        -(magnitude.log2().floor().clamp(-1074.0, 1023.0) as i32)
    } else {
        0
    };
    let (half, rest) = (2f64.powi(exponent / 2), 2f64.powi(exponent - exponent / 2));
    let scaled = |x: f64| x * half * rest;
    layout.factor[row] = scaled(1.0);
    let mut noise = 0.0;
    let mut remainder = scaled(given.remainder);
    let mut slope_remainder = scaled(given.slope_remainder);
    let mut degrees = 0;
    for term in &given.terms {
        let coefficients: Vec<f64> = term.coefficients().iter().map(|c| scaled(*c)).collect();
        noise += scaled(term.error());
        degrees += term.degrees().iter().sum::<usize>();
        if let Some(low) = &given.low {
            // Neither split nor rounded: a part of its own.
            append(layout, row, term.degrees(), &coefficients);
            layout.second.resize(layout.first.len() - coefficients.len(), 0.0);
            layout.second.extend(low.coefficients().iter().map(|c| scaled(*c)));
            let (lo, hi) = crate::coefficients::tensor::range(low.coefficients());
            layout.missing[row] += scaled(lo.abs().max(hi.abs()));
            continue;
        }
        let separated = separate(term.degrees(), coefficients);
        // The residual is one of coefficients; slightly beyond the domain it is at most (1 + 1/32)^(degrees) times as large.
        let top = term.degrees().iter().copied().max().unwrap_or(0) as f64;
        let all: usize = term.degrees().iter().sum();
        let residual = separated.residual * (1.0f64 + 1.0 / 32.0).powi(all as i32);
        remainder += residual;
        slope_remainder += 2.0 * top * residual;
        for (degrees, block) in separated.blocks {
            push(layout, row, &degrees, &block);
        }
    }
    // `push` may add to these. Underflow in the scaling: below any normal number's rounding.
    layout.first_noise[row] += noise + 1e-290;
    layout.remainder[row] += remainder;
    layout.slope_remainder[row] = slope_remainder;
    layout.degrees = layout.degrees.max(degrees);
    Ok(())
}

/// Adds a part. Parts of one equation must not share variables: one that does is added to the part that it shares them with.
fn push(layout: &mut Layout, equation: usize, degrees: &[usize], block: &[f64]) {
    let shares = |part: &Summand| part.equation == equation && part.axes.iter().any(|a| degrees[a.variable] > 0);
    let constant = degrees.iter().all(|d| *d == 0);
    let own = layout.parts.iter().position(|p| p.equation == equation);
    if constant && let Some(own) = own {
        // A constant joins the first part.
        let part = &layout.parts[own];
        for x in &mut layout.first[part.offset..part.offset + part.len] {
            *x += block[0];
        }
        layout.first_noise[equation] += 4.0 * EPSILON * (block[0].abs() + 2.0);
        return;
    }
    let Some(sharing) = layout.parts.iter().position(shares) else {
        append(layout, equation, degrees, block);
        return;
    };
    // Elevate both to a common degree and add.
    let part = layout.parts.remove(sharing);
    let mut own = vec![0; layout.n];
    for axis in &part.axes {
        own[axis.variable] = axis.degree;
    }
    let place = part.offset..part.offset + part.len;
    let old: Vec<f64> = layout.first.drain(place.clone()).collect();
    if !layout.second.is_empty() {
        layout.second.drain(place);
    }
    for other in &mut layout.parts {
        if other.offset > part.offset {
            other.offset -= part.len;
        }
    }
    layout.len -= part.len;
    let sum = Bernstein::new(&own, old)
        .and_then(|a| Bernstein::new(degrees, block.to_vec()).map(|b| a.add(&b)))
        .ok();
    let Some(sum) = sum else { return };
    layout.first_noise[equation] += sum.error();
    let (degrees, coefficients) = (sum.degrees().to_vec(), sum.coefficients().to_vec());
    layout.remainder[equation] += sum.error();
    push(layout, equation, &degrees, &coefficients);
}

fn append(layout: &mut Layout, equation: usize, degrees: &[usize], block: &[f64]) {
    let mut axes = SmallVec::new();
    let mut inner = 1;
    for (variable, &degree) in degrees.iter().enumerate() {
        if degree > 0 {
            axes.push(Axis {
                variable,
                degree,
                inner,
            });
            inner *= degree + 1;
        }
    }
    layout.parts.push(Summand {
        equation,
        offset: layout.first.len(),
        len: block.len(),
        axes,
    });
    layout.first.extend_from_slice(block);
    layout.len = layout.first.len();
    if !layout.second.is_empty() {
        layout.second.resize(layout.len, 0.0);
    }
}

/// A tensor as a sum of tensors in disjoint variables.
struct Separated {
    blocks: Vec<(Vec<usize>, Vec<f64>)>,
    /// Bound of the difference, coefficient by coefficient in the full basis.
    residual: f64,
}

/// Finds variables on which a tensor does not depend, and groups of variables between which it does not mix, up to a few
/// roundings of its largest coefficient (which is at most 2).
fn separate(degrees: &[usize], coefficients: Vec<f64>) -> Separated {
    let n = degrees.len();
    let tolerance = 8.0 * EPSILON * coefficients.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let mut residual = 0.0;
    let mut degrees = degrees.to_vec();
    let mut c = coefficients;
    // Variables that have no effect.
    for j in 0..n {
        if degrees[j] == 0 {
            continue;
        }
        let inner: usize = degrees[..j].iter().map(|d| d + 1).product();
        let block = inner * (degrees[j] + 1);
        let mut change: f64 = 0.0;
        for b in c.chunks_exact(block) {
            for (i, x) in b.iter().enumerate() {
                change = change.max((x - b[i % inner]).abs());
            }
        }
        if change <= tolerance {
            residual += change * (1.0 + 4.0 * EPSILON);
            c = c.chunks_exact(block).flat_map(|b| b[..inner].iter().copied()).collect();
            degrees[j] = 0;
        }
    }
    // Groups of variables that mix.
    let active: Vec<usize> = (0..n).filter(|j| degrees[*j] > 0).collect();
    let stride = |j: usize| degrees[..j].iter().map(|d| d + 1).product::<usize>();
    let mut group: Vec<usize> = (0..n).collect();
    for (a, &j) in active.iter().enumerate() {
        for &k in &active[a + 1..] {
            if group[j] == group[k] {
                continue;
            }
            let (sj, sk) = (stride(j), stride(k));
            let mixes = (0..c.len()).any(|i| {
                let room = (i / sj) % (degrees[j] + 1) < degrees[j] && (i / sk) % (degrees[k] + 1) < degrees[k];
                room && (c[i + sj + sk] - c[i + sj] - c[i + sk] + c[i]).abs() > tolerance
            });
            if mixes {
                let (from, to) = (group[k], group[j]);
                for g in &mut group {
                    if *g == from {
                        *g = to;
                    }
                }
            }
        }
    }
    let mut groups: Vec<usize> = active.iter().map(|j| group[*j]).collect();
    groups.sort_unstable();
    groups.dedup();
    if groups.len() <= 1 {
        return Separated {
            blocks: vec![(degrees, c)],
            residual,
        };
    }
    let mut blocks: Vec<(Vec<usize>, Vec<f64>)> = Vec::new();
    for (number, g) in groups.iter().enumerate() {
        let own: Vec<usize> = (0..n).map(|j| if group[j] == *g { degrees[j] } else { 0 }).collect();
        let block: Vec<f64> = (0..c.len())
            .filter(|i| (0..n).all(|j| own[j] > 0 || degrees[j] == 0 || (i / stride(j)) % (degrees[j] + 1) == 0))
            .map(|i| if number == 0 { c[i] } else { c[i] - c[0] })
            .collect();
        blocks.push((own, block));
    }
    let mut worst: f64 = 0.0;
    let mut size: f64 = 0.0;
    for (i, x) in c.iter().enumerate() {
        // In double-double precision: if nothing was rounded, the residual is almost 0.
        let mut sum = Double::new(-x);
        for (own, block) in &blocks {
            let (mut at, mut step) = (0, 1);
            for j in 0..n {
                if own[j] > 0 {
                    at += step * ((i / stride(j)) % (degrees[j] + 1));
                    step *= own[j] + 1;
                }
            }
            sum = sum.add(Double::new(block[at]));
            size = size.max(block[at].abs());
        }
        worst = worst.max(sum.hi.abs());
    }
    if worst > 8.0 * tolerance {
        return Separated {
            blocks: vec![(degrees, c)],
            residual,
        };
    }
    // The sums above also round a little.
    residual += worst * (1.0 + 1e-12) + 2f64.powi(-98) * blocks.len() as f64 * size;
    Separated { blocks, residual }
}
