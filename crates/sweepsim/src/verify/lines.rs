//! Material on some lines of a grid: as heights, which is all that the search for events needs.

use smallvec::SmallVec;
use sweepsim_dexel::{Dexels, Interval};

/// Intervals of one line as `[lower, upper]`: sorted, disjoint, of positive length.
pub(super) type Heights = SmallVec<[[f64; 2]; 2]>;

/// Material on some lines, sorted by line; no line without any.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines(pub Vec<(u32, Heights)>);

impl Lines {
    /// All the material of `dexels` on these lines.
    pub fn of(dexels: &Dexels, lines: impl Iterator<Item = u32>) -> Self {
        let all = lines.map(|line| (line, dexels.at(line as usize).heights().collect::<Heights>()));
        Self(all.filter(|(_, heights)| !heights.is_empty()).collect())
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn numbers(&self) -> impl Iterator<Item = u32> + '_ {
        self.0.iter().map(|(line, _)| *line)
    }

    /// The total length.
    pub fn length(&self) -> f64 {
        let lengths = self.0.iter().flat_map(|(_, heights)| heights);
        // An empty sum of floats is −0.
        lengths.map(|[lower, upper]| upper - lower).sum::<f64>() + 0.0
    }

    /// The longest interval, and its line.
    pub fn longest(&self) -> Option<(u32, [f64; 2])> {
        let all = self
            .0
            .iter()
            .flat_map(|(line, heights)| heights.iter().map(move |h| (*line, *h)));
        // The first of equally long ones.
        all.fold(None, |best: Option<(u32, [f64; 2])>, (line, h)| match best {
            Some((_, [lower, upper])) if upper - lower >= h[1] - h[0] => best,
            _ => Some((line, h)),
        })
    }

    /// For each line of both, what `operation` makes of them; lines of `self` alone are kept if `rest`.
    fn merged<T>(&self, other: &[(u32, T)], rest: bool, operation: impl Fn(&Heights, &T) -> Heights) -> Self {
        let mut others = other.iter().peekable();
        let mut out = Vec::new();
        for (line, heights) in &self.0 {
            while others.peek().is_some_and(|(at, _)| at < line) {
                others.next();
            }
            let made = match others.peek() {
                Some((at, more)) if at == line => operation(heights, more),
                _ if rest => heights.clone(),
                _ => continue,
            };
            if !made.is_empty() {
                out.push((*line, made));
            }
        }
        Self(out)
    }

    /// What is in both, in pieces longer than `least`.
    pub fn common(&self, swept: &[(u32, Vec<Interval>)], least: f64) -> Self {
        self.merged(swept, false, |own, other| {
            let other = other.iter().map(|interval| [interval.lower.z, interval.upper.z]);
            intersection(own, other, least)
        })
    }

    /// What is in both.
    pub fn intersection(&self, other: &Self, least: f64) -> Self {
        self.merged(&other.0, false, |own, other| {
            intersection(own, other.iter().copied(), least)
        })
    }

    /// The material that is not swept.
    pub fn without(&self, swept: &[(u32, Vec<Interval>)]) -> Self {
        self.merged(swept, true, |own, cut| {
            difference(own, cut.iter().map(|c| [c.lower.z, c.upper.z]))
        })
    }

    /// The material that is not in `other`.
    pub fn minus(&self, other: &Self) -> Self {
        self.merged(&other.0, true, |own, cut| difference(own, cut.iter().copied()))
    }

    /// The intervals longer than `least`.
    pub fn longer_than(mut self, least: f64) -> Self {
        for (_, heights) in &mut self.0 {
            heights.retain(|[lower, upper]| *upper - *lower > least);
        }
        self.0.retain(|(_, heights)| !heights.is_empty());
        self
    }

    /// The material on one line.
    pub fn of_line(&self, line: u32) -> Self {
        let at = self.0.binary_search_by_key(&line, |(at, _)| *at);
        Self(at.map(|at| self.0[at].clone()).into_iter().collect())
    }

    /// The material on all other lines.
    pub fn without_line(mut self, line: u32) -> Self {
        self.0.retain(|(at, _)| *at != line);
        self
    }

    /// The material on the lines of `other`.
    pub fn on_lines_of(&self, other: &Self) -> Self {
        self.merged(&other.0, false, |own, _| own.clone())
    }
}

fn intersection(own: &Heights, other: impl Iterator<Item = [f64; 2]>, least: f64) -> Heights {
    let mut out = Heights::new();
    let mut from = 0;
    for [lower, upper] in other {
        while from < own.len() && own[from][1] <= lower {
            from += 1;
        }
        for piece in &own[from..] {
            if piece[0] >= upper {
                break;
            }
            let both = [piece[0].max(lower), piece[1].min(upper)];
            if both[1] - both[0] > least {
                out.push(both);
            }
        }
    }
    out
}

fn difference(own: &Heights, cut: impl Iterator<Item = [f64; 2]>) -> Heights {
    let mut out = Heights::new();
    let mut cut = cut.peekable();
    for piece in own {
        let [mut lower, upper] = *piece;
        while let Some([below, above]) = cut.peek().copied() {
            if below >= upper {
                break;
            }
            if below > lower {
                out.push([lower, below]);
            }
            lower = lower.max(above);
            if above >= upper {
                break;
            }
            cut.next();
        }
        if lower < upper {
            out.push([lower, upper]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn heights(marks: &[u8]) -> Heights {
        let mut sorted: Vec<u8> = marks.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        sorted
            .chunks_exact(2)
            .map(|pair| [f64::from(pair[0]), f64::from(pair[1])])
            .collect()
    }

    fn inside(heights: &Heights, z: f64) -> bool {
        heights.iter().any(|[lower, upper]| *lower < z && z < *upper)
    }

    proptest! {
        #[test]
        fn operations_hold_point_by_point(a in prop::collection::vec(0_u8..40, 0..12), b in prop::collection::vec(0_u8..40, 0..12)) {
            let (a, b) = (heights(&a), heights(&b));
            let (both, less) = (intersection(&a, b.iter().copied(), 0.0), difference(&a, b.iter().copied()));
            for k in 0..80 {
                let z = f64::from(k) / 2.0 + 0.25;
                prop_assert_eq!(inside(&both, z), inside(&a, z) && inside(&b, z));
                prop_assert_eq!(inside(&less, z), inside(&a, z) && !inside(&b, z));
            }
            prop_assert!(both.iter().chain(&less).all(|[lower, upper]| lower < upper));
        }
    }
}
