//! Material on some lines of a grid: as heights, which is all that the search for events needs.

use crate::sweep::heights::{Box3, window};
use smallvec::SmallVec;
use sweepsim_dexel::{Dexels, Grid, Interval};

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

    /// The lines with the longest intervals, so many of them.
    pub fn deepest(&self, count: usize) -> Self {
        let longest = |heights: &Heights| heights.iter().map(|[lower, upper]| upper - lower).fold(0.0, f64::max);
        let mut order: Vec<(f64, usize)> = self.0.iter().map(|(_, h)| longest(h)).zip(0..).collect();
        // The first of equally long ones.
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut chosen: Vec<usize> = order.into_iter().take(count).map(|(_, n)| n).collect();
        chosen.sort_unstable();
        Self(chosen.into_iter().map(|n| self.0[n].clone()).collect())
    }

    /// At most so many lines, spread evenly over all.
    pub fn sample(&self, count: usize) -> Self {
        let step = self.0.len().div_ceil(count).max(1);
        Self(self.0.iter().skip(step / 2).step_by(step).cloned().collect())
    }

    /// The material on the lines of a window of columns and rows that reaches between two heights.
    pub fn near(&self, grid: &Grid, reach: Option<Box3>) -> Self {
        let Some((window, z)) = reach.and_then(|reach| Some((window(grid, &reach)?, reach[2]))) else {
            return Self::default();
        };
        let rows = grid.cells()[1] as u32;
        let [columns, rows_near] = window.map(|(first, last)| first as u32..last as u32 + 1);
        let from = self.0.partition_point(|(line, _)| *line < columns.start * rows);
        let to = self.0.partition_point(|(line, _)| *line < columns.end * rows);
        let is_near = |(line, heights): &&(u32, Heights)| {
            let reaches = |heights: &Heights| {
                let ends = heights.first().zip(heights.last());
                ends.is_some_and(|(first, last)| first[0] <= z[1] && last[1] >= z[0])
            };
            rows_near.contains(&(line % rows)) && reaches(heights)
        };
        Self(self.0[from..to].iter().filter(is_near).cloned().collect())
    }

    /// Takes away what is swept. Lines may be left without material.
    pub fn remove(&mut self, swept: &[(u32, Vec<Interval>)]) {
        for (line, cut) in swept {
            if let Ok(at) = self.0.binary_search_by_key(line, |(at, _)| *at) {
                let heights = &mut self.0[at].1;
                *heights = difference(heights, cut.iter().map(|c| [c.lower.z, c.upper.z]));
            }
        }
    }

    /// The material on some lines.
    pub fn on_lines_where(&self, is: impl Fn(u32) -> bool) -> Self {
        Self(self.0.iter().filter(|(line, _)| is(*line)).cloned().collect())
    }

    /// Whether the neighbour of a line on one side, 0 … 3 for the lines before and after it along `x` and along `y`, has material at heights of the line's.
    pub fn has_neighbour(&self, grid: &Grid, line: u32, side: usize) -> bool {
        let (i, j) = grid.place(line as usize);
        let [columns, rows] = grid.cells();
        let place = match side {
            0 => i.checked_sub(1).map(|i| (i, j)),
            1 => Some((i + 1, j)).filter(|(i, _)| *i < columns),
            2 => j.checked_sub(1).map(|j| (i, j)),
            _ => Some((i, j + 1)).filter(|(_, j)| *j < rows),
        };
        let heights = |line: u32| {
            let at = self.0.binary_search_by_key(&line, |(at, _)| *at).ok()?;
            Some(&self.0[at].1)
        };
        let other = place
            .and_then(|(i, j)| grid.index(i, j))
            .and_then(|line| heights(line as u32));
        let (Some(own), Some(other)) = (heights(line), other) else {
            return false;
        };
        let shared = |[lower, upper]: &[f64; 2]| other.iter().any(|[a, b]| a < upper && lower < b);
        own.iter().all(shared)
    }

    /// The material of `others` on their lines in place of the own, which may leave nothing there.
    pub fn replaced(&self, lines: &Self, others: &Self) -> Self {
        let kept = self.minus_lines(lines);
        let mut all = [kept.0, others.0.clone()].concat();
        all.sort_by_key(|(line, _)| *line);
        Self(all)
    }

    fn minus_lines(&self, lines: &Self) -> Self {
        self.merged(&lines.0, true, |_, _| Heights::new())
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

    /// What is in one of both.
    pub fn united(&self, other: &Self) -> Self {
        let mut out = self.minus_lines(other).0;
        for (line, more) in &other.0 {
            let mut all: Vec<[f64; 2]> = self
                .of_line(*line)
                .0
                .iter()
                .flat_map(|(_, heights)| heights.to_vec())
                .collect();
            all.extend(more);
            all.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let mut heights = Heights::new();
            for [lower, upper] in all {
                match heights.last_mut() {
                    Some(last) if last[1] >= lower => last[1] = last[1].max(upper),
                    _ => heights.push([lower, upper]),
                }
            }
            out.push((*line, heights));
        }
        out.sort_by_key(|(line, _)| *line);
        Self(out)
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
    use sweepsim_props::*;

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
        fn operations_hold_point_by_point(a in collection::vec(0_u8..40, 0..12), b in collection::vec(0_u8..40, 0..12)) {
            let (a, b) = (heights(&a), heights(&b));
            let lines = |heights: &Heights| Lines(if heights.is_empty() { vec![] } else { vec![(3, heights.clone())] });
            let all = lines(&a).united(&lines(&b));
            let all = all.0.first().map_or_else(Heights::new, |(_, heights)| heights.clone());
            let (both, less) = (intersection(&a, b.iter().copied(), 0.0), difference(&a, b.iter().copied()));
            for k in 0..80 {
                let z = f64::from(k) / 2.0 + 0.25;
                prop_assert_eq!(inside(&both, z), inside(&a, z) && inside(&b, z));
                prop_assert_eq!(inside(&all, z), inside(&a, z) || inside(&b, z));
                prop_assert_eq!(inside(&less, z), inside(&a, z) && !inside(&b, z));
            }
            prop_assert!(both.iter().chain(&less).chain(&all).all(|[lower, upper]| lower < upper));
        }
    }
}
