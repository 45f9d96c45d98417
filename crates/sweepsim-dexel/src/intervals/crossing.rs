//! From signed crossings to intervals: the coverage count and its audit.
//!
//! Fix a line. Let `S` be the part of the strip of times `t` and heights `z` that the moving tool covers, and `c(z)`
//! the number of connected components of `S` at height `z`. The swept volume meets the line exactly where `c ≥ 1`. Far
//! below and far above, `c` is 0; each crossing says by how much `c` jumps, going up. So the jumps add up to 0 and no
//! partial sum is negative. A crossing that is lost or found twice breaks this audit, unless a second error of opposite
//! sign hides it.

use super::interval::{End, Interval, Source};
use super::operations::merge;
use std::cmp::Ordering;
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
    /// What made it.
    pub source: Source,
}

/// The crossings of a line do not add up.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the coverage count does not close: it ends at {sum} and falls to {lowest} at z = {z}")]
pub struct AuditFailure {
    /// Sum of all jumps; must be 0.
    pub sum: i32,
    /// Lowest partial sum; must be 0.
    pub lowest: i32,
    /// Height at which the lowest partial sum is reached, if it is negative; otherwise that of the highest crossing,
    /// where the sum should be 0. Not finite only if a crossing's height is not.
    pub z: f64,
}

/// Writes the intervals where at least one component covers a line, from its crossings, which may be put in another
/// order.
///
/// Heights have some error, so consecutive crossings at most `same` apart form a group: the order of a coincident start
/// and end is unknown, and a gap or a negative count between them means nothing. Intervals begin at the lowest and end
/// at the highest crossing of a group. A chain of crossings can make a group longer than `same`; inside it the count
/// continues from crossing to crossing, so no wall or gap thicker than `same` is lost. A `same` that is negative or no
/// number counts as 0.
///
/// # Errors
/// [`AuditFailure`]: the jumps do not add up to 0, a sum between groups is negative, or a height is not finite.
/// `intervals` is then empty.
pub fn cover(crossings: &mut [Crossing], same: f64, intervals: &mut Vec<Interval>) -> Result<(), AuditFailure> {
    // Crossings at one height always form a group: no interval is without length.
    let same = same.max(0.0);
    if let [a, b] = crossings
        && let Some(interval) = between(a, b, same)
    {
        intervals.clear();
        intervals.push(interval);
        return Ok(());
    }
    if cover_few(crossings, same, intervals).is_some() {
        return Ok(());
    }
    cover_any(crossings, same, intervals)
}

/// What two crossings cover, as most lines have two; `None` if they are close or do not add up.
fn between(a: &Crossing, b: &Crossing, same: f64) -> Option<Interval> {
    let (lower, upper) = if a.z < b.z { (a, b) } else { (b, a) };
    let height = upper.z - lower.z;
    let counted = lower.jump > 0 && i32::from(lower.jump) + i32::from(upper.jump) == 0;
    // NaN is close.
    (counted && height > same && height.is_finite()).then(|| Interval {
        lower: end(lower),
        upper: end(upper),
    })
}

/// The most crossings that are sorted by insertion.
const FEW: usize = 24;

/// What [`cover_any`] does for a few crossings without a chain that pass their audit: heights are sorted, and crossings
/// stay where they are. `None` for all others.
fn cover_few(crossings: &[Crossing], same: f64, intervals: &mut Vec<Interval>) -> Option<()> {
    intervals.clear();
    let mut heights = [(0.0_f64, 0_u8, 0_i8); FEW];
    let heights = heights.get_mut(..crossings.len())?;
    for (n, crossing) in crossings.iter().enumerate() {
        let z = crossing.z;
        if !z.is_finite() {
            return None;
        }
        let mut at = n;
        while at > 0 && {
            let (below, number, _) = heights[at - 1];
            below > z || (below == z && order(&crossings[usize::from(number)], crossing).is_gt())
        } {
            heights[at] = heights[at - 1];
            at -= 1;
        }
        heights[at] = (z, n as u8, crossing.jump);
    }
    let end = |number: u8| end(&crossings[usize::from(number)]);
    let (mut sum, mut lower) = (0_i32, None);
    // Of a group: its lowest height, the first crossing that begins something and the last one that ends something.
    let mut bottom = heights.first().map_or(0.0, |(z, ..)| *z);
    let (mut rises, mut falls) = (None, None);
    let mut above = heights.iter().skip(1).map(|(z, ..)| *z);
    for (z, number, jump) in &*heights {
        sum += i32::from(*jump);
        if *jump > 0 {
            rises = rises.or(Some(*number));
        } else if *jump < 0 {
            falls = Some(*number);
        }
        let next = above.next();
        if let Some(next) = next
            && next - z <= same
        {
            // Chains are counted otherwise.
            if next - bottom > same {
                intervals.clear();
                return None;
            }
            continue;
        }
        if sum < 0 {
            break;
        }
        if sum > 0 {
            lower = lower.or(rises);
        } else if let Some(lower) = lower.take()
            && let Some(upper) = falls
        {
            intervals.push(Interval {
                lower: end(lower),
                upper: end(upper),
            });
        }
        bottom = next.unwrap_or(bottom);
        (rises, falls) = (None, None);
    }
    if sum == 0 {
        return Some(());
    }
    intervals.clear();
    None
}

fn cover_any(crossings: &mut [Crossing], same: f64, intervals: &mut Vec<Interval>) -> Result<(), AuditFailure> {
    crossings.sort_by(order);
    intervals.clear();
    // Sorted: heights that are no numbers, or infinite, are the first or the last.
    let odd = [crossings.first(), crossings.last()]
        .into_iter()
        .flatten()
        .find(|c| !c.z.is_finite());
    if let Some(odd) = odd {
        let sum = crossings.iter().map(|crossing| i32::from(crossing.jump)).sum();
        return Err(AuditFailure {
            sum,
            lowest: sum.min(0),
            z: odd.z,
        });
    }
    let (mut sum, mut lowest) = (0_i32, 0_i32);
    let mut place = crossings.last().map_or(0.0, |highest| highest.z);
    let mut lower: Option<End> = None;
    let mut chains = false;
    for group in crossings.chunk_by(|a, b| b.z - a.z <= same) {
        let before = sum;
        sum += group.iter().map(|crossing| i32::from(crossing.jump)).sum::<i32>();
        if sum < lowest {
            (lowest, place) = (sum, group[0].z);
        }
        if group[group.len() - 1].z - group[0].z > same {
            chains = true;
            chain(group, before, &mut lower, intervals);
        } else if sum > 0 {
            lower = lower.or_else(|| group.iter().find(|crossing| crossing.jump > 0).map(end));
        } else if let Some(lower) = lower.take()
            && let Some(upper) = group.iter().rfind(|crossing| crossing.jump < 0).map(end)
        {
            intervals.push(Interval { lower, upper });
        }
    }
    if sum == 0 && lowest == 0 {
        if chains {
            merge(intervals, same);
        }
        Ok(())
    } else {
        intervals.clear();
        Err(AuditFailure { sum, lowest, z: place })
    }
}

/// From below; of those at one height, what begins comes first, then what was made first.
fn order(a: &Crossing, b: &Crossing) -> Ordering {
    a.z.total_cmp(&b.z)
        .then(b.jump.cmp(&a.jump))
        .then_with(|| a.source.rank().cmp(&b.source.rank()))
}

fn end(crossing: &Crossing) -> End {
    End {
        z: crossing.z,
        normal: crossing.normal,
        source: crossing.source,
    }
}

/// Counts from crossing to crossing. Where the order of crossings is wrong, the result has intervals or gaps that are
/// too thin.
fn chain(group: &[Crossing], mut sum: i32, lower: &mut Option<End>, intervals: &mut Vec<Interval>) {
    for crossing in group {
        sum += i32::from(crossing.jump);
        if sum > 0 && crossing.jump > 0 {
            lower.get_or_insert(end(crossing));
        } else if sum <= 0
            && let Some(lower) = lower.take()
        {
            let upper = end(crossing);
            intervals.push(Interval { lower, upper });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    fn crossing(z: f64, jump: i8) -> Crossing {
        Crossing {
            z,
            jump,
            normal: [0.0, 0.0, 1.0],
            source: Source::Stock,
        }
    }

    proptest! {
        /// Random components, as overlapping intervals: their crossings, shuffled, give their union.
        #[test]
        fn the_count_gives_the_union(
            (parts, order) in collection::vec((0..60i32, 1..20i32), 0..8)
                .prop_flat_map(|parts| { let n = 2 * parts.len(); (Just(parts), Just((0..n).collect::<Vec<_>>()).prop_shuffle()) })
        ) {
            let all: Vec<_> = parts.iter()
                .flat_map(|(z, d)| [crossing(f64::from(*z), 1), crossing(f64::from(z + d), -1)]).collect();
            let mut shuffled: Vec<_> = order.iter().map(|k| all[*k]).collect();
            let mut intervals = Vec::new();
            prop_assert!(cover(&mut shuffled, 0.0, &mut intervals).is_ok());
            for k in 0..90 {
                let z = f64::from(k) + 0.5;
                let covered = parts.iter().any(|(a, d)| f64::from(*a) < z && z < f64::from(a + d));
                prop_assert_eq!(covered, intervals.iter().any(|i| i.lower.z < z && z < i.upper.z));
            }
            prop_assert!(intervals.windows(2).all(|w| w[0].upper.z < w[1].lower.z));
            // One crossing lost: detected.
            if !shuffled.is_empty() {
                let lost = shuffled.len() / 2;
                shuffled.remove(lost);
                prop_assert!(cover(&mut shuffled, 0.0, &mut intervals).is_err());
            }
        }
    }

    proptest! {
        /// Few crossings are counted as many are, whether they add up or not.
        #[test]
        fn few_are_counted_as_any(
            all in collection::vec((0..40i32, 0..3i32, prop::sample::select(vec![-2_i8, -1, 0, 1, 1, 2])), 0..30),
            same in 0.0..0.5, close in any::<bool>()
        ) {
            let mut sum = 0;
            let mut list: Vec<_> = all.iter().map(|(z, d, jump)| {
                sum += i32::from(*jump);
                crossing(f64::from(*z) + 0.2 * f64::from(*d), *jump)
            }).collect();
            for n in 0..sum.unsigned_abs() * u32::from(close) {
                // Those that are missing, at the end where they are missing.
                let z = f64::from(n) + if sum > 0 { 50.0 } else { -50.0 };
                list.push(crossing(z, -sum.signum() as i8));
            }
            let (mut few, mut any) = (list.clone(), list);
            let (mut own, mut other) = (vec![Interval::between(0.0, 1.0)], Vec::new());
            let (a, b) = (cover(&mut few, same, &mut own), cover_any(&mut any, same, &mut other));
            prop_assert_eq!(a, b);
            prop_assert_eq!(own, other);
        }
    }

    /// All lists of up to four crossings at three heights, with any `same`: what is not refused is sorted, and every
    /// interval has a length.
    #[test]
    fn intervals_have_a_length_whatever_is_the_same() {
        let (heights, jumps) = ([-1.0, 0.0, 0.5], [-2_i8, -1, 1, 2]);
        let kinds: Vec<_> = heights
            .iter()
            .flat_map(|z| jumps.map(|jump| crossing(*z, jump)))
            .collect();
        let mut intervals = Vec::new();
        let mut counted = 0;
        for code in 0..kinds.len().pow(4) {
            for number in 1..=4_u32 {
                let list: Vec<_> = (0..number)
                    .map(|k| kinds[code / kinds.len().pow(k) % kinds.len()])
                    .collect();
                for same in [-1.0, -f64::INFINITY, f64::NAN, 0.0, 0.5, 1.0, f64::INFINITY] {
                    let found = cover(&mut list.clone(), same, &mut intervals);
                    // By the path for any number of crossings, too.
                    let mut other = Vec::new();
                    let any = cover_any(&mut list.clone(), same.max(0.0), &mut other);
                    assert_eq!((found, &intervals), (any, &other), "{list:?}, same {same}");
                    if found.is_err() {
                        assert!(intervals.is_empty());
                        continue;
                    }
                    counted += 1;
                    let ends: Vec<f64> = intervals.iter().flat_map(|i| [i.lower.z, i.upper.z]).collect();
                    assert!(ends.windows(2).all(|w| w[0] < w[1]), "{list:?}, same {same}: {ends:?}");
                }
            }
        }
        assert!(counted > 10_000, "{counted}");
    }

    #[test]
    fn nested_starts_are_one_interval() {
        // `start start end start end end`: where the paper's Algorithm 2 returns two.
        let mut crossings =
            [(0.0, 1), (1.0, 1), (2.0, -1), (3.0, 1), (4.0, -1), (5.0, -1)].map(|(z, j)| crossing(z, j));
        let mut intervals = Vec::new();
        cover(&mut crossings, 0.0, &mut intervals).unwrap();
        assert_eq!(intervals.len(), 1);
        assert_eq!((intervals[0].lower.z, intervals[0].upper.z), (0.0, 5.0));
    }

    #[test]
    fn failures_say_where() {
        let mut intervals = Vec::new();
        let failure = cover(&mut [crossing(2.0, -1), crossing(3.0, 1)], 0.0, &mut intervals).unwrap_err();
        assert_eq!((failure.sum, failure.lowest, failure.z), (0, -1, 2.0));
        // One that begins and never ends.
        let all = &mut [crossing(2.0, 1), crossing(3.0, 1), crossing(4.0, -1)];
        let failure = cover(all, 0.0, &mut intervals).unwrap_err();
        assert_eq!((failure.sum, failure.lowest, failure.z), (1, 0, 4.0));
    }

    #[test]
    fn walls_in_a_chain_are_kept() {
        // Each crossing within 1 of the next, but material from 0 to 2.7 and a gap from 3.2 to 6.
        let all = [
            (0.0, 1),
            (0.9, 1),
            (1.8, -1),
            (2.7, -1),
            (3.2, 1),
            (3.3, -1),
            (6.0, 1),
            (9.0, -1),
        ];
        let mut crossings = all.map(|(z, j)| crossing(z, j));
        let mut intervals = Vec::new();
        cover(&mut crossings, 1.0, &mut intervals).unwrap();
        let found: Vec<[f64; 2]> = intervals.iter().map(|i| [i.lower.z, i.upper.z]).collect();
        assert_eq!(found, [[0.0, 3.3], [6.0, 9.0]]);
    }

    #[test]
    fn crossings_at_one_height_have_no_order() {
        // If a component ends where another begins, up to rounding, there is no gap. If one begins and ends there,
        // there is no interval.
        let ulp = f64::EPSILON;
        let mut crossings = [
            (0.0, 1),
            (1.0 - ulp, -1),
            (1.0, 1),
            (2.0, -1),
            (3.0, -1),
            (3.0 + 2.0 * ulp, 1),
        ]
        .map(|(z, j)| crossing(z, j));
        let mut intervals = Vec::new();
        assert!(cover(&mut crossings, 0.0, &mut intervals).is_err());
        cover(&mut crossings, 8.0 * ulp, &mut intervals).unwrap();
        assert_eq!(intervals.len(), 1);
        assert_eq!((intervals[0].lower.z, intervals[0].upper.z), (0.0, 2.0));
    }
}
