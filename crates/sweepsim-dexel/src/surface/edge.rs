//! Matches the ends of two neighbouring dexels.

use super::end;
use crate::intervals::{End, Interval};
use smallvec::SmallVec;

/// What happens along a grid edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// Both dexels have the same number of ends, all joined smoothly.
    Smooth,
    /// Some end has no partner.
    Step,
    /// Some partners meet at an angle, or two faces of one dexel do. There may also be steps.
    Crease,
}

/// How an end is joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Link {
    /// Nothing.
    None,
    /// To this end of the neighbour, smoothly.
    Smooth(usize),
    /// To this end of the neighbour, at an angle.
    Crease(usize),
}

pub(super) type Links = SmallVec<[Link; 4]>;
pub(super) type Heights = SmallVec<[f64; 4]>;

/// The joins along a grid edge, from its first dexel to its second.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// The joins of each dexel's ends.
    pub links: [Links; 2],
    /// Where the first crease or wedge meets the edge: from 0 to 1.
    pub crease: Option<f64>,
    /// Whether an end without a partner ends in a wedge: its face meets that of a neighbour of its own dexel.
    pub wedges: [SmallVec<[bool; 4]>; 2],
}

/// How close to its dexels an outline may cross an edge.
const MARGIN: f64 = 0.05;
/// Normals that differ by more than this (in radians) do not belong to one smooth face.
const ANGLE: f64 = 0.7;
/// Normals that differ by more than this may or may not belong to one smooth face.
const FAINT: f64 = 0.35;
/// The steepest slope that is trusted.
const STEEPEST: f64 = 1e3;

/// Slopes `∂z/∂x`, `∂z/∂y` of the surface at an end.
pub(super) fn slopes(end: &End, upper: bool) -> [f64; 2] {
    let n = end.normal.map(f64::from);
    let nz = if upper {
        n[2].max(1.0 / STEEPEST)
    } else {
        n[2].min(-1.0 / STEEPEST)
    };
    [0, 1].map(|k| {
        let slope = -n[k] / nz;
        if slope.is_finite() { slope } else { 0.0 }
    })
}

/// How far a face at `z` goes up over `run` along a slope that ends at an outline: little where that adds material,
/// unless there is already material behind the outline.
pub(super) fn rise(slope: f64, run: f64, upper: bool, z: f64, behind: &[Interval]) -> f64 {
    let shrink = 3.0 * run.abs();
    let rise = (slope * run).clamp(-shrink, shrink);
    let (low, high) = (z.min(z + rise), z.max(z + rise));
    if behind.iter().any(|i| i.lower.z <= low && high <= i.upper.z) {
        return rise;
    }
    let grow = 0.5 * run.abs();
    if upper {
        rise.clamp(-shrink, grow)
    } else {
        rise.clamp(-grow, shrink)
    }
}

/// Rounds a height to about 2⁻³⁰ of the dexel spacing, so that outlines that meet agree to the bit.
pub(super) fn snap(z: f64, distance: f64) -> f64 {
    let quantum = distance.log2().floor().exp2() * 2.0_f64.powi(-30);
    let snapped = (z / quantum).round() * quantum;
    if snapped.is_finite() { snapped } else { z }
}

/// Whether ends can be joined: how well (1 to 2), and where they meet if they do so at an angle.
fn join(a: &End, b: &End, upper: bool, axis: usize, distance: f64) -> Option<(f64, Option<f64>)> {
    let (ga, gb) = (slopes(a, upper)[axis], slopes(b, upper)[axis]);
    let chord = (b.z - a.z) / distance;
    let cosine = (0..3)
        .map(|k| f64::from(a.normal[k]) * f64::from(b.normal[k]))
        .sum::<f64>();
    if cosine > 0.9 && (chord - ga).abs() < 0.1 && (chord - gb).abs() < 0.1 {
        return Some((2.0, None));
    }
    let [ta, tb, tc] = [ga, gb, chord].map(f64::atan);
    // On a smooth surface, the direction of the chord lies between those of the tangents, apart from changes of
    // curvature.
    let between = cosine.clamp(-1.0, 1.0).acos();
    let allowed = 0.2 + 0.5 * between.min(1.2);
    let beyond = (ta.min(tb) - tc).max(tc - ta.max(tb));
    if beyond.is_nan() || beyond > allowed {
        return None;
    }
    let quality = 2.0 - (tc - 0.5 * (ta + tb)).abs() / std::f64::consts::PI;
    // Tangents that meet at an angle do so between the dexels.
    let meet = (chord - gb) / (ga - gb);
    if between < ANGLE {
        let ridge = between > FAINT && beyond < 0.02 && MARGIN < meet && meet < 1.0 - MARGIN;
        return Some((quality, ridge.then_some(meet)));
    }
    if beyond > 0.1 {
        return None;
    }
    let meet = if meet.is_finite() { meet } else { 0.5 };
    Some((quality, Some(meet.clamp(MARGIN, 1.0 - MARGIN))))
}

impl Edge {
    /// How the ends of two dexels are joined that are this far apart along `x` (axis 0) or `y` (axis 1).
    pub fn class(a: &[Interval], b: &[Interval], axis: usize, distance: f64) -> Class {
        if a.is_empty() && b.is_empty() {
            return Class::Smooth;
        }
        let edge = Self::new(a, b, axis, distance);
        let smooth = |links: &Links| links.iter().enumerate().all(|(e, l)| *l == Link::Smooth(e));
        if edge.crease.is_some() {
            Class::Crease
        } else if edge.links.iter().all(smooth) {
            Class::Smooth
        } else {
            Class::Step
        }
    }

    /// Joins the ends of two dexels, in order, as many and as well as possible.
    pub fn new(a: &[Interval], b: &[Interval], axis: usize, distance: f64) -> Self {
        let (m, n) = (2 * a.len(), 2 * b.len());
        let mut edge = Self {
            links: [SmallVec::from_elem(Link::None, m), SmallVec::from_elem(Link::None, n)],
            crease: None,
            wedges: [SmallVec::from_elem(false, m), SmallVec::from_elem(false, n)],
        };
        let joined = |p: usize, q: usize| {
            (p % 2 == q % 2)
                .then(|| join(end(a, p), end(b, q), p % 2 == 1, axis, distance))
                .flatten()
        };
        if m == 2 && n == 2 {
            for e in 0..2 {
                if let Some((_, meet)) = joined(e, e) {
                    edge.put(e, e, meet);
                }
            }
        } else if m > 0 && n > 0 {
            // best[p][q]: the best joins of the ends from p and q on.
            let mut best = vec![0.0_f64; (m + 1) * (n + 1)];
            let at = |p: usize, q: usize| p * (n + 1) + q;
            for p in (0..m).rev() {
                for q in (0..n).rev() {
                    let with = joined(p, q).map_or(0.0, |(quality, _)| quality + best[at(p + 1, q + 1)]);
                    best[at(p, q)] = with.max(best[at(p + 1, q)]).max(best[at(p, q + 1)]);
                }
            }
            let (mut p, mut q) = (0, 0);
            while p < m && q < n {
                if best[at(p, q)] == best[at(p + 1, q)] {
                    p += 1;
                } else if best[at(p, q)] == best[at(p, q + 1)] {
                    q += 1;
                } else {
                    if let Some((_, meet)) = joined(p, q) {
                        edge.put(p, q, meet);
                    }
                    (p, q) = (p + 1, q + 1);
                }
            }
        }
        edge.find_wedges([a, b], axis, distance);
        edge
    }

    /// Finds pairs of neighbouring ends on a dexel, both without partners, whose tangents meet before the other dexel:
    /// the material or gap between them ends there. If there is also a plain step, that takes precedence.
    fn find_wedges(&mut self, lines: [&[Interval]; 2], axis: usize, distance: f64) {
        let (mut first, mut count) = (None, 0);
        for side in 0..2 {
            let sign = if side == 0 { distance } else { -distance };
            let mut e = 1;
            while e < self.links[side].len() {
                if self.links[side][e - 1] == Link::None && self.links[side][e] == Link::None {
                    let [low, high] = [e - 1, e].map(|e| {
                        let end = end(lines[side], e);
                        (end.z, sign * slopes(end, e % 2 == 1)[axis])
                    });
                    let run = (high.0 - low.0) / (low.1 - high.1);
                    if MARGIN < run && run < 1.0 - MARGIN {
                        (self.wedges[side][e - 1], self.wedges[side][e]) = (true, true);
                        first = first.or(Some(if side == 0 { run } else { 1.0 - run }));
                        count += 2;
                        e += 1;
                    }
                }
                e += 1;
            }
        }
        let alone = self.links.iter().flatten().filter(|l| **l == Link::None).count();
        if count == alone {
            self.crease = self.crease.or(first);
        } else {
            self.wedges.iter_mut().flatten().for_each(|wedge| *wedge = false);
        }
    }

    fn put(&mut self, p: usize, q: usize, meet: Option<f64>) {
        let link = if meet.is_some() { Link::Crease } else { Link::Smooth };
        self.links[0][p] = link(q);
        self.links[1][q] = link(p);
        self.crease = self.crease.or(meet);
    }

    /// Where an outline crosses the edge if it would ideally cross at `s`.
    pub fn crossing(&self, s: f64) -> f64 {
        self.crease.unwrap_or(s).clamp(MARGIN, 1.0 - MARGIN)
    }

    /// Heights at `s` of the faces of the first and the second dexel: the same for partners.
    pub fn heights(&self, lines: [&[Interval]; 2], axis: usize, distance: f64, s: f64) -> [Heights; 2] {
        let run = [s * distance, (s - 1.0) * distance];
        let height = |side: usize, e: usize| {
            let end = end(lines[side], e);
            let slope = slopes(end, e % 2 == 1)[axis];
            (end.z, slope)
        };
        let mut heights = [0, 1].map(|side: usize| -> Heights {
            (0..2 * lines[side].len())
                .map(|e| match self.links[side][e] {
                    Link::None => {
                        let (z, slope) = height(side, e);
                        let rise = if self.wedges[side][e] {
                            slope * run[side]
                        } else {
                            rise(slope, run[side], e % 2 == 1, z, lines[1 - side])
                        };
                        snap(z + rise, distance)
                    }
                    Link::Smooth(f) | Link::Crease(f) => {
                        // Computed from the first dexel's side, so that both sides get the same bits.
                        let (p, q) = if side == 0 { (e, f) } else { (f, e) };
                        let ((za, ga), (zb, gb)) = (height(0, p), height(1, q));
                        let (low, high) = (za.min(zb), za.max(zb));
                        let z = if matches!(self.links[side][e], Link::Smooth(_)) {
                            za + s * (zb - za)
                        } else if ga.abs() < gb.abs() {
                            za + ga * run[0]
                        } else {
                            zb + gb * run[1]
                        };
                        snap(z.clamp(low - distance, high + distance), distance)
                    }
                })
                .collect()
        });
        for side in 0..2 {
            put_in_order(&mut heights[side], |e| self.links[side][e] != Link::None);
        }
        heights
    }
}

/// Makes heights increase by moving those that are not fixed.
fn put_in_order(heights: &mut [f64], fixed: impl Fn(usize) -> bool) {
    let mut from = 0;
    while from < heights.len() {
        if fixed(from) {
            from += 1;
            continue;
        }
        let to = (from..heights.len()).find(|e| fixed(*e)).unwrap_or(heights.len());
        let low = if from > 0 { heights[from - 1] } else { f64::NEG_INFINITY };
        let high = heights.get(to).copied().unwrap_or(f64::INFINITY);
        let run = &mut heights[from..to];
        for _ in 0..run.len().min(8) {
            for e in 1..run.len() {
                if run[e - 1] > run[e] {
                    let mean = 0.5 * (run[e - 1] + run[e]);
                    (run[e - 1], run[e]) = (mean, mean);
                }
            }
        }
        let mut least = low;
        for z in run {
            least = z.max(least).min(high.max(low));
            *z = least;
        }
        from = to;
    }
}
