//! Preconditioned coefficients: those of `gᵢ = Σ Kᵢₑ fₑ`, and where their hulls meet 0 along the variable that `gᵢ` singles out.
//!
//! An affine enclosure of `gᵢ` adds up the rests of the equations with the sizes of the factors, although most of them cancel; in many variables little
//! else is left. The combined coefficients keep the cancellation. Equations are sums of parts in sets of variables; parts with the same set (or one
//! not much smaller) are raised to common degrees and combined, and the bounds of different sets are added.

use super::layout::{Axis, Cell, Layout, MAX_DEGREE};
use super::summand::hull_zeros;
use super::tensor;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Square};
use smallvec::SmallVec;
use sweepsim_spline::kernel;

/// From this number of unknowns on, combined coefficients save more boxes than they cost.
const LEAST_UNKNOWNS: usize = 4;
/// A part in fewer variables is raised to a set with at most this many times as many coefficients.
const LARGER: usize = 4;
/// If the combined coefficients are this many times as many as those of the equations, degrees differ too much.
const MOST: usize = 8;

/// A set of variables, with the parts that depend on no others.
#[derive(Clone, Debug)]
struct Support {
    axes: SmallVec<[Axis; 8]>,
    len: usize,
    /// Numbers of parts.
    members: Vec<usize>,
}

/// How a system's parts are combined.
#[derive(Clone, Debug)]
pub(crate) struct Blend {
    supports: Vec<Support>,
    /// The common degree in each variable.
    degrees: [usize; MAX_UNKNOWNS],
    /// The most steps by which a part's degrees are raised.
    raises: usize,
    /// Whether no part's degrees are: then the parts are combined as they are.
    plain: bool,
}

impl Blend {
    /// The plan for a system with as many equations as unknowns; `None` if combined coefficients would not help.
    pub(crate) fn new(layout: &Layout) -> Option<Self> {
        if layout.n < LEAST_UNKNOWNS || layout.m != layout.n || layout.tape.is_some() {
            return None;
        }
        let mut degrees = [0; MAX_UNKNOWNS];
        for axis in layout.parts.iter().flat_map(|p| &p.axes) {
            degrees[axis.variable] = degrees[axis.variable].max(axis.degree);
        }
        let mut order: Vec<usize> = (0..layout.parts.len()).collect();
        order.sort_by_key(|p| std::cmp::Reverse(layout.parts[*p].axes.len()));
        let mut supports: Vec<Support> = Vec::new();
        for number in order {
            let part = &layout.parts[number];
            let len: usize = part.axes.iter().map(|a| degrees[a.variable] + 1).product();
            let within = |s: &Support| {
                let has = |a: &Axis| s.axes.iter().any(|b| a.variable == b.variable);
                s.len <= LARGER * len && part.axes.iter().all(has)
            };
            if let Some(own) = supports.iter_mut().find(|s| within(s)) {
                own.members.push(number);
                continue;
            }
            let (mut axes, mut inner) = (SmallVec::new(), 1);
            for axis in &part.axes {
                let (variable, degree) = (axis.variable, degrees[axis.variable]);
                axes.push(Axis {
                    variable,
                    degree,
                    inner,
                });
                inner *= degree + 1;
            }
            supports.push(Support {
                axes,
                len: inner,
                members: vec![number],
            });
        }
        let combined: usize = supports.iter().map(|s| s.len * s.members.len()).sum();
        let worthwhile = combined <= MOST * layout.len;
        let plain = supports
            .iter()
            .all(|s| s.members.iter().all(|p| layout.parts[*p].len == s.len));
        worthwhile.then_some(Self {
            supports,
            degrees,
            raises: degrees.iter().sum(),
            plain,
        })
    }

    /// The parts with common degrees, one after the other.
    fn raised(&self, layout: &Layout, cell: &Cell, out: &mut Vec<f64>) {
        for support in &self.supports {
            for number in &support.members {
                let part = &layout.parts[*number];
                let start = out.len();
                let source = part.of(&cell.c);
                out.resize(start + support.len, 0.0);
                let c = &mut out[start..];
                c[..source.len()].copy_from_slice(source);
                // Axis by axis, the fastest first: the rows of this axis move apart to make room.
                let mut inner = 1;
                let mut len = source.len();
                for axis in &support.axes {
                    let own = part.axis(axis.variable).map_or(0, |a| a.degree);
                    let (from, to) = ((own + 1) * inner, (axis.degree + 1) * inner);
                    if own < axis.degree {
                        for block in (0..len / from).rev() {
                            c.copy_within(block * from..(block + 1) * from, block * to);
                            for degree in own..axis.degree {
                                kernel::elevate(&mut c[block * to..(block + 1) * to], degree, inner);
                            }
                        }
                        len = len / from * to;
                    }
                    inner = to;
                }
            }
        }
    }

    /// Intersects each variable's window with where its preconditioned equation can vanish; stops at an empty window.
    pub(crate) fn project(
        &self,
        layout: &Layout,
        cell: &Cell,
        k: &Square,
        scratch: &mut Vec<f64>,
        window: &mut [(f64, f64); MAX_UNKNOWNS],
    ) {
        let n = layout.n;
        scratch.clear();
        if !self.plain {
            self.raised(layout, cell, scratch);
        }
        let len = scratch.len();
        let longest = self.supports.iter().map(|s| s.len).max().unwrap_or(0);
        scratch.resize(len + longest, 0.0);
        let (raised, sum) = scratch.split_at_mut(len);
        for i in 0..n {
            let degree = self.degrees[i];
            let (mut low, mut high) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
            let (mut below, mut above) = (0.0, 0.0);
            let mut rest = &*raised;
            for support in &self.supports {
                let sum = &mut sum[..support.len];
                sum.fill(0.0);
                for number in &support.members {
                    let part = &layout.parts[*number];
                    let own = if self.plain {
                        part.of(&cell.c)
                    } else {
                        let (own, others) = rest.split_at(support.len);
                        rest = others;
                        own
                    };
                    kernel::accumulate(sum, own, k[i][part.equation]);
                }
                match support.axes.iter().find(|a| a.variable == i) {
                    Some(axis) => {
                        let (mut l, mut h) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
                        tensor::envelope(sum, degree, axis.inner, &mut l, &mut h);
                        for j in 0..=degree {
                            low[j] += l[j];
                            high[j] += h[j];
                        }
                    }
                    None => {
                        let (l, h) = tensor::range(sum);
                        below += l;
                        above += h;
                    }
                }
            }
            // Raising a degree rounds by 4 ε of the largest coefficient a step, the combination by one unit a term.
            let rounding = EPSILON * (4 * self.raises + 4 * n + 4 * self.supports.len() + 8) as f64;
            let mut pad = 0.0;
            for e in 0..n {
                let error = cell.noise[e] + layout.remainder[e] + rounding * cell.scale[e];
                pad += k[i][e].abs() * error;
            }
            pad *= 1.0 + 16.0 * EPSILON;
            if !pad.is_finite() {
                continue;
            }
            for j in 0..=degree {
                low[j] += below - pad;
                high[j] += above + pad;
            }
            if degree == 0 {
                if low[0] > 0.0 || high[0] < 0.0 {
                    window[i] = (1.0, 0.0);
                }
            } else {
                hull_zeros(&low[..=degree], &high[..=degree], &mut window[i]);
            }
            if window[i].0 > window[i].1 {
                return;
            }
        }
    }
}
