//! Set operations on sorted lists of intervals.
//!
//! Lists are in *normal form*: sorted, each interval of positive length, each gap of positive length. Every operation
//! takes two lists in normal form and appends one to `out`, whose earlier content it leaves alone. They run in one
//! pass.

use super::interval::{Endpoint, Interval};

/// An operation: takes two lists, appends to the third.
pub(crate) type Run<E> = fn(&[Interval<E>], &[Interval<E>], &mut Vec<Interval<E>>);

/// `a ∖ b`. New ends are those of `b`, flipped.
pub(crate) fn difference<E: Endpoint>(a: &[Interval<E>], b: &[Interval<E>], out: &mut Vec<Interval<E>>) {
    let mut first = 0;
    for piece in a {
        while first < b.len() && b[first].upper.height() <= piece.lower.height() {
            first += 1;
        }
        let mut lower = piece.lower;
        for cut in &b[first..] {
            if cut.lower.height() >= piece.upper.height() {
                break;
            }
            if cut.lower.height() > lower.height() {
                let upper = cut.lower.flipped();
                out.push(Interval { lower, upper });
            }
            lower = cut.upper.flipped();
        }
        if lower.height() < piece.upper.height() {
            let upper = piece.upper;
            out.push(Interval { lower, upper });
        }
    }
}

/// `a ∪ b`; intervals that touch become one. Of two ends at the same height, that of `a` is kept.
///
/// `a` and `b` need only be sorted by their lower ends: intervals that overlap in one of them are joined as well.
pub(crate) fn union<E: Endpoint>(a: &[Interval<E>], b: &[Interval<E>], out: &mut Vec<Interval<E>>) {
    let start = out.len();
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let take_a = j == b.len() || (i < a.len() && a[i].lower.height() <= b[j].lower.height());
        let next = if take_a { a[i] } else { b[j] };
        if take_a {
            i += 1;
        } else {
            j += 1;
        }
        match out[start..].last_mut() {
            Some(last) if next.lower.height() <= last.upper.height() => {
                let (new, old) = (next.upper.height(), last.upper.height());
                if new > old || (take_a && new == old) {
                    last.upper = next.upper;
                }
            }
            _ => out.push(next),
        }
    }
}

/// `a ∩ b`. Of two ends at the same height, that of `a` is kept.
pub(crate) fn intersection<E: Endpoint>(a: &[Interval<E>], b: &[Interval<E>], out: &mut Vec<Interval<E>>) {
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        let lower = if b[j].lower.height() > a[i].lower.height() {
            b[j].lower
        } else {
            a[i].lower
        };
        let a_ends = a[i].upper.height() <= b[j].upper.height();
        let upper = if a_ends { a[i].upper } else { b[j].upper };
        if lower.height() < upper.height() {
            out.push(Interval { lower, upper });
        }
        if a_ends {
            i += 1;
        } else {
            j += 1;
        }
    }
}

/// Brings intervals in any order, overlapping or empty, into normal form.
pub(crate) fn normalise<E: Endpoint>(pieces: &mut Vec<Interval<E>>) {
    // Comparisons with NaN are false, so such intervals are dropped.
    pieces.retain(|piece| piece.lower.height() < piece.upper.height());
    let apart = |w: &[Interval<E>]| w[0].upper.height() < w[1].lower.height();
    if !pieces.windows(2).all(apart) {
        pieces.sort_by(|a, b| a.lower.height().total_cmp(&b.lower.height()));
        let sorted = std::mem::take(pieces);
        union(&sorted, &[], pieces);
    }
}

/// Fills gaps of at most `tolerance`, then drops intervals of at most `tolerance`: see
/// [`IntervalSet::merged`](crate::IntervalSet::merged).
pub(crate) fn merge<E: Endpoint>(pieces: &mut Vec<Interval<E>>, tolerance: f64) {
    pieces.dedup_by(|next, last| {
        let join = next.lower.height() - last.upper.height() <= tolerance;
        if join {
            last.upper = next.upper;
        }
        join
    });
    pieces.retain(|piece| piece.length() > tolerance);
}
