//! From signed crossings to intervals: the coverage count and its audit.
//!
//! Fix a line. In the strip of time `t` and height `z` let `S` be where the moving tool is, and `c(z)` the number of
//! connected components of `S` at height `z`. The swept volume meets the line exactly where `c ≥ 1`; `c` is 0 far below
//! and far above, and each crossing says by how much it jumps, going up. So the jumps add up to 0, and no partial sum is
//! negative: a crossing lost or found twice breaks the audit (unless a second error of opposite sign hides it).

use crate::interval::{End, Interval, Source};
use thiserror::Error;

/// A point of a line where the coverage count jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Height.
    pub z: f64,
    /// By how much the count changes, going up.
    pub jump: i8,
    /// Unit normal of the envelope, out of the tool.
    pub normal: [f32; 3],
    /// Which motion made it.
    pub source: Source,
}

/// Crossings of a line do not add up.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the coverage count does not close: it ends at {sum}, and falls to {lowest} at z = {z}")]
pub struct AuditFailure {
    /// Sum of all jumps: 0 when right.
    pub sum: i32,
    /// Lowest partial sum: 0 when right.
    pub lowest: i32,
    /// Height at which the lowest is reached.
    pub z: f64,
}

/// Sorts the crossings of one line and writes the intervals where at least one component covers it.
///
/// Crossings at the same height count together.
///
/// # Errors
/// [`AuditFailure`]: the jumps do not add up to 0, or a partial sum is negative. `intervals` is then empty.
pub fn cover(crossings: &mut [Crossing], intervals: &mut Vec<Interval>) -> Result<(), AuditFailure> {
    crossings.sort_by(|a, b| {
        let source = |c: &Crossing| (c.source.path, c.source.segment, c.source.t.to_bits());
        a.z.total_cmp(&b.z)
            .then(b.jump.cmp(&a.jump))
            .then_with(|| source(a).cmp(&source(b)))
    });
    intervals.clear();
    let (mut sum, mut lowest, mut place) = (0_i32, 0_i32, f64::NAN);
    let mut lower: Option<End> = None;
    for (index, crossing) in crossings.iter().enumerate() {
        sum += i32::from(crossing.jump);
        let end = End {
            z: crossing.z,
            normal: crossing.normal,
            source: crossing.source,
        };
        if sum > 0 && lower.is_none() {
            lower = Some(end);
        }
        let more = crossings.get(index + 1).is_some_and(|next| next.z == crossing.z);
        if more {
            continue;
        }
        if sum < lowest {
            (lowest, place) = (sum, crossing.z);
        }
        if sum <= 0
            && let Some(lower) = lower.take()
            && lower.z < end.z
        {
            intervals.push(Interval { lower, upper: end });
        }
    }
    if sum == 0 && lowest == 0 {
        Ok(())
    } else {
        intervals.clear();
        Err(AuditFailure { sum, lowest, z: place })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn crossing(z: f64, jump: i8) -> Crossing {
        Crossing {
            z,
            jump,
            normal: [0.0, 0.0, 1.0],
            source: Source::STOCK,
        }
    }

    proptest! {
        /// Random components, as overlapping intervals: their crossings, shuffled, give their union.
        #[test]
        fn the_count_gives_the_union(
            (parts, order) in proptest::collection::vec((0..60i32, 1..20i32), 0..8)
                .prop_flat_map(|parts| { let n = 2 * parts.len(); (Just(parts), Just((0..n).collect::<Vec<_>>()).prop_shuffle()) })
        ) {
            let all: Vec<_> = parts.iter()
                .flat_map(|(z, d)| [crossing(f64::from(*z), 1), crossing(f64::from(z + d), -1)]).collect();
            let mut shuffled: Vec<_> = order.iter().map(|k| all[*k]).collect();
            let mut intervals = Vec::new();
            prop_assert!(cover(&mut shuffled, &mut intervals).is_ok());
            for k in 0..90 {
                let z = f64::from(k) + 0.5;
                let covered = parts.iter().any(|(a, d)| f64::from(*a) < z && z < f64::from(a + d));
                prop_assert_eq!(covered, intervals.iter().any(|i| i.lower.z < z && z < i.upper.z));
            }
            prop_assert!(intervals.windows(2).all(|w| w[0].upper.z < w[1].lower.z));
            // One crossing lost: found out.
            if !shuffled.is_empty() {
                let lost = shuffled.len() / 2;
                shuffled.remove(lost);
                prop_assert!(cover(&mut shuffled, &mut intervals).is_err());
            }
        }
    }

    #[test]
    fn nested_starts_are_one_interval() {
        // `start start end start end end`: where the paper's Algorithm 2 returns two.
        let mut crossings =
            [(0.0, 1), (1.0, 1), (2.0, -1), (3.0, 1), (4.0, -1), (5.0, -1)].map(|(z, j)| crossing(z, j));
        let mut intervals = Vec::new();
        cover(&mut crossings, &mut intervals).unwrap();
        assert_eq!(intervals.len(), 1);
        assert_eq!((intervals[0].lower.z, intervals[0].upper.z), (0.0, 5.0));
    }

    #[test]
    fn failures_say_where() {
        let mut intervals = Vec::new();
        let failure = cover(&mut [crossing(2.0, -1), crossing(3.0, 1)], &mut intervals).unwrap_err();
        assert_eq!((failure.sum, failure.lowest, failure.z), (0, -1, 2.0));
    }
}
