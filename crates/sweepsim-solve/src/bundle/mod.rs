//! Bundles: the points of many systems that differ in their right-hand sides, each with a certificate of its own.
//!
//! Of `n` unknowns, `pᵢ / w = qᵢ` for some polynomials `pᵢ` over a positive weight `w`, and further polynomials are zero. Each target
//! `q` makes a system, `F(z) = (p − q w, …) = 0`. The systems share their coefficients, so they go down one subdivision together: a box keeps
//! those targets that lie in the range of `p / w` over it.
//!
//! Over a box, let `H` bound the second derivatives of `F` (of all targets in it), read off the Bernstein coefficients. For one target, at
//! any point `s` of the box with `v = p/w − q` and its Jacobian `J` there, and `K = J⁻¹`, Taylor's theorem says that each root `z` in the box has
//!
//! ```text
//! z − (s − K v) = −K v (∇w / w)(z − s) − ½ K H* (z − s)² / w,        |H*| ≤ H
//! ```
//!
//! Three tests follow, for each target by itself (`line.rs`):
//!
//! - *no root*: the right side is bounded over the part of the box where roots may be; what is farther from the Newton step is cut away, and when
//!   nothing is left, there is none;
//! - *existence*, by Brouwer: if the same bound, over a small ball about `s`, keeps the Newton step's image inside of the ball;
//! - *single solution* (Newton and Kantorovich): if `|K| (H/2) |z − z*| / w < 1` about a root `z*` over what is left of the box, it is the only one.
//!
//! Targets that a box leaves undecided, and only these, go on to its halves. A root on a face between boxes is found from both; two finds of one
//! target are one root where they are so near that the single-solution test, with second derivatives of the whole domain, leaves room for one only.
//!
//! This is another way to what [charts](crate::ChartSolver) find: other coefficients (of polynomials in all unknowns), second derivatives rather than
//! ranges of first ones, a certificate a root rather than one a box.

mod cell;
mod line;
mod taylor;

use crate::charts::{ChartMap, ChartOptions, ChartStatistics, Preimage, Reason, Sink, Target, Targets, Undecided};
use crate::charts::{all_of, collapses, largest, widest};
use crate::trail::Trail;
use crate::{Interval, Monitor};
use cell::{Blocks, Frame};
use line::{Found, Outcome, Window};
use sweepsim_spline::Bernstein;
use taylor::Taylor;
use thiserror::Error;

/// Boxes that are not good for certificates yet have each of at most this many targets tested before they are split.
const FEW: usize = 6;
/// Targets are tried on a box where the bound of the single-solution test about its centre is at most this.
const GOOD: f64 = 1.0;

/// What is wrong with the forms of a bundle.
///
/// ```
/// use sweepsim_solve::{Bundle, BundleError};
/// use sweepsim_spline::Bernstein;
///
/// let (x, y, one) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1), Bernstein::constant(2, 1.0));
/// let bundle = |numerators: Vec<Bernstein>, weight: &Bernstein| Bundle::<2>::new(numerators, weight, vec![]);
/// assert!(bundle(vec![x.clone(), y.clone()], &one).is_ok());
/// assert_eq!(bundle(vec![x.clone()], &one).unwrap_err(), BundleError::Count { found: 1, expected: 2 });
/// let line = Bernstein::variable(1, 0);
/// assert_eq!(bundle(vec![x.clone(), line], &one).unwrap_err(), BundleError::Variables { form: 1, found: 1, expected: 2 });
/// assert_eq!(bundle(vec![x.clone(), y.clone()], &x).unwrap_err(), BundleError::Weight);
/// let high = Bernstein::from_fn(&[64, 0], |_| 1.0).unwrap();
/// assert_eq!(bundle(vec![high, y], &one).unwrap_err(), BundleError::Degree { form: 0, degree: 64 });
/// let unknown = Bernstein::constant(2, f64::NAN);
/// assert_eq!(bundle(vec![x, unknown], &one).unwrap_err(), BundleError::NotFinite { form: 1 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BundleError {
    /// Numerators and zeros are not as many as unknowns.
    #[error("{found} equations in {expected} unknowns")]
    Count {
        /// Given.
        found: usize,
        /// Unknowns.
        expected: usize,
    },
    /// A form (numerators first, then the weight, then zeros and conditions) has another number of variables.
    #[error("form {form} has {found} variables, not {expected}")]
    Variables {
        /// Its number.
        form: usize,
        /// Its variables.
        found: usize,
        /// The unknowns.
        expected: usize,
    },
    /// A degree is above [`MAX_DEGREE`](crate::MAX_DEGREE).
    #[error("form {form} is of degree {degree}")]
    Degree {
        /// Its number.
        form: usize,
        /// Its largest degree.
        degree: usize,
    },
    /// A coefficient or error bound is infinite or NaN.
    #[error("form {form} has a coefficient or bound that is not a finite number")]
    NotFinite {
        /// Its number.
        form: usize,
    },
    /// A coefficient of the weight is not positive, beyond its error.
    #[error("the weight is not positive")]
    Weight,
}

/// Systems `pᵢ = qᵢ w`, `zⱼ = 0` in `N` unknowns (2 or 3) over `[0, 1]ᴺ`, one for each target `q`.
#[derive(Clone, Debug)]
pub struct Bundle<const N: usize> {
    blocks: Blocks<N>,
}

impl<const N: usize> Bundle<N> {
    /// The systems `numeratorsᵢ / weight = qᵢ`, `zerosⱼ = 0`.
    ///
    /// # Errors
    ///
    /// [`BundleError`]
    pub fn new(numerators: Vec<Bernstein>, weight: &Bernstein, zeros: Vec<Bernstein>) -> Result<Self, BundleError> {
        let blocks = Blocks::new(numerators, weight, zeros)?;
        Ok(Self { blocks })
    }

    /// Asks only for solutions where exactly one of two forms is negative. Where both are or neither is may still be handed out.
    ///
    /// # Errors
    ///
    /// [`BundleError`]
    pub fn where_signs_differ(mut self, first: Bernstein, second: Bernstein) -> Result<Self, BundleError> {
        self.blocks.set_conditions([first, second])?;
        Ok(self)
    }

    /// Whether some equation is exactly zero everywhere: it has no isolated solutions.
    #[must_use]
    pub fn vanishes(&self) -> bool {
        self.blocks.vanishes()
    }
}

/// A root near a face between boxes, which the neighbour may have found too.
struct Straddler<const N: usize, S> {
    preimage: Preimage<N, S>,
    error: [f64; N],
}

/// The search, with its memory kept from one call to the next.
#[derive(Debug)]
pub struct BundleSolver {
    /// Limits; [`accept`](ChartOptions::accept) is in half sides of boxes.
    pub options: ChartOptions,
    /// What all calls together did; `charts` counts boxes on which targets were tried.
    pub statistics: ChartStatistics,
    coefficients: Vec<f64>,
    scratch: Vec<f64>,
}

impl BundleSolver {
    /// A search with these limits.
    #[must_use]
    pub fn new(options: ChartOptions) -> Self {
        Self {
            options,
            statistics: ChartStatistics::default(),
            coefficients: Vec::new(),
            scratch: Vec::new(),
        }
    }

    /// Finds, for every target, all solutions in `[0, 1]ᴺ`.
    ///
    /// Of the map only values at points are asked for, and its scales: it must be the one that the bundle's forms say. Each solution is
    /// handed to `sink` once, or the box where it may hide is.
    pub fn solve<const N: usize, M, T, S>(
        &mut self,
        bundle: &Bundle<N>,
        map: &M,
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) where
        M: ChartMap<N>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
    {
        let blocks = &bundle.blocks;
        if blocks.vanishes() {
            return;
        }
        let (mut coefficients, mut scratch) = (
            std::mem::take(&mut self.coefficients),
            std::mem::take(&mut self.scratch),
        );
        coefficients.clear();
        coefficients.extend_from_slice(&blocks.first);
        let mut search = Search {
            blocks,
            map,
            targets,
            monitor,
            options: self.options,
            statistics: &mut self.statistics,
            coefficients,
            scratch: &mut scratch,
            lines: Vec::new(),
            straddlers: Vec::new(),
        };
        search.run(sink);
        self.coefficients = search.coefficients;
        self.scratch = scratch;
    }
}

struct Search<'a, const N: usize, M: ChartMap<N>, T: ?Sized> {
    blocks: &'a Blocks<N>,
    map: &'a M,
    targets: &'a T,
    monitor: &'a dyn Monitor,
    options: ChartOptions,
    statistics: &'a mut ChartStatistics,
    /// Of the boxes on the stack, one after another.
    coefficients: Vec<f64>,
    scratch: &'a mut Vec<f64>,
    /// Targets that boxes on the stack are left with.
    lines: Vec<Target<N>>,
    straddlers: Vec<Straddler<N, M::Seen>>,
}

impl<const N: usize, M, T> Search<'_, N, M, T>
where
    M: ChartMap<N>,
    T: Targets<N> + ?Sized,
{
    fn run<S: Sink<N, M::Seen>>(&mut self, sink: &mut S) {
        let len = self.blocks.len;
        let mut budget = self.options.boxes;
        let mut stack = vec![self.blocks.root()];
        while let Some(frame) = stack.pop() {
            // The frame's coefficients are the last ones; its targets, if it has its own, too.
            self.lines.truncate(frame.lines.map_or(0, |(_, end)| end));
            self.statistics.boxes += 1;
            match self.visit(&frame, &mut budget, sink) {
                Some((axis, lines)) => {
                    let parts = self.blocks.split(&frame, axis, &mut self.coefficients);
                    stack.extend(parts.map(|part| Frame { lines, ..part }));
                }
                None => self.coefficients.truncate(stack.len() * len),
            }
        }
        self.identify(sink);
    }

    /// Treats a box; where to split it, and for which of its own targets, if that is needed.
    fn visit<S: Sink<N, M::Seen>>(
        &mut self,
        frame: &Frame<N>,
        budget: &mut u64,
        sink: &mut S,
    ) -> Option<(usize, Option<(usize, usize)>)> {
        let start = self.coefficients.len() - self.blocks.len;
        let c = &self.coefficients[start..];
        let values = self.blocks.values(frame, c)?;
        let inside = |q: &[f64; N]| (0..N).all(|i| values[i].contains(q[i]));
        let holds_any = match frame.lines {
            None => self.targets.count(&values) > 0,
            Some((from, to)) => self.lines[from..to].iter().any(|target| inside(&target.value)),
        };
        if !holds_any {
            return None;
        }
        let taylor = Taylor::new(self.blocks, frame, c, &values, self.map, self.scratch);
        self.statistics.evaluations += 1;
        let bounds: [Interval; N] = std::array::from_fn(|j| Interval::new(frame.lo[j], frame.hi[j]));
        let slopes = taylor.slopes();
        let small = |j: usize| frame.hi[j] - frame.lo[j] <= self.options.smallest;
        let idle = |j: usize| (0..N).all(|i| slopes[i][j].magnitude() == 0.0);
        let tiny = (0..N).all(|j| small(j) || idle(j));
        let reason = if tiny {
            Some(Reason::Smallest)
        } else if *budget == 0 {
            Some(Reason::Budget)
        } else {
            self.monitor.cancelled().then_some(Reason::Cancelled)
        };
        if let Some(reason) = reason {
            self.each(frame, &values, &mut |_, target| {
                sink.undecided(Undecided {
                    target: target.number,
                    bounds,
                    reason,
                });
                true
            });
            return None;
        }
        *budget -= 1;
        let domain = [Interval::new(0.0, 1.0); N];
        let mut axis = widest(&bounds, &domain, &slopes, &self.map.scales());
        let mut lines = frame.lines;
        if let Some(inverse) = &taylor.inverse {
            let rest = if taylor.bend(inverse) <= GOOD {
                self.statistics.charts += 1;
                Some(self.lines(frame, &values, &taylor, sink))
            } else {
                self.few(frame, &values, &taylor)
            };
            match rest {
                Some((from, to)) if from == to => return None,
                Some(rest) => lines = Some(rest),
                None => {}
            }
            let smear = largest(&taylor.smear(inverse));
            if frame.depth % 3 != 2 && !collapses(&bounds, &slopes, smear) {
                axis = smear;
            }
        }
        if frame.hi[axis] - frame.lo[axis] <= self.options.smallest {
            let sides: [f64; N] = std::array::from_fn(|j| frame.hi[j] - frame.lo[j]);
            axis = largest(&sides);
        }
        Some((axis, lines))
    }

    /// Calls `visit` with the box's targets until it returns `false`.
    fn each(&mut self, frame: &Frame<N>, values: &[Interval; N], visit: &mut dyn FnMut(&mut Self, Target<N>) -> bool) {
        match frame.lines {
            None => {
                let targets = self.targets;
                targets.visit(values, &all_of, &mut |target| visit(self, *target));
            }
            Some((from, to)) => {
                for at in from..to {
                    let target = self.lines[at];
                    if (0..N).all(|i| values[i].contains(target.value[i])) && !visit(self, target) {
                        return;
                    }
                }
            }
        }
    }

    /// Decides the box's targets; which are left, as a range of `lines`.
    fn lines<S: Sink<N, M::Seen>>(
        &mut self,
        frame: &Frame<N>,
        values: &[Interval; N],
        taylor: &Taylor<N>,
        sink: &mut S,
    ) -> (usize, usize) {
        let before = self.lines.len();
        let mut trail = Trail::new();
        self.each(frame, values, &mut |search, target| {
            if search.monitor.cancelled() {
                // Left to the box's halves, which will not be looked at.
                search.lines.push(target);
                return true;
            }
            let q = &target.value;
            let Some((window, first)) = taylor.window(q) else {
                return true;
            };
            let guess = trail.guess(target.place).map_or(first, Into::into);
            match search.line(taylor, window, guess, q) {
                Outcome::Found(found) => {
                    trail.push(target.place, found.s.into());
                    search.put(frame, taylor, target.number, found, sink);
                }
                Outcome::Absent => {}
                Outcome::Unclear => search.lines.push(target),
            }
            true
        });
        (before, self.lines.len())
    }

    fn line(
        &mut self,
        taylor: &Taylor<N>,
        window: Window<N>,
        guess: nalgebra::SVector<f64, N>,
        q: &[f64; N],
    ) -> Outcome<N, M::Seen> {
        line::solve(
            self.map,
            taylor,
            window,
            guess,
            (q, self.options.accept),
            &mut self.statistics.evaluations,
        )
    }

    /// The targets of a box that has few, without those that the bounds about its centre exclude.
    fn few(&mut self, frame: &Frame<N>, values: &[Interval; N], taylor: &Taylor<N>) -> Option<(usize, usize)> {
        let before = self.lines.len();
        let mut count = 0;
        self.each(frame, values, &mut |search, target| {
            count += 1;
            if taylor.window(&target.value).is_some() {
                search.lines.push(target);
            }
            count <= FEW
        });
        if count <= FEW {
            return Some((before, self.lines.len()));
        }
        self.lines.truncate(before);
        None
    }

    /// Hands a root on, unless a neighbouring box may have it as well.
    fn put<S: Sink<N, M::Seen>>(
        &mut self,
        frame: &Frame<N>,
        taylor: &Taylor<N>,
        target: usize,
        found: Found<N, M::Seen>,
        sink: &mut S,
    ) {
        let x = taylor.point(&found.s);
        let error: [f64; N] = std::array::from_fn(|j| found.error[j] * taylor.half[j] + 2.0 * f64::EPSILON);
        let preimage = Preimage {
            target,
            x,
            from: found.from,
            seen: found.seen,
            orientation: found.orientation,
        };
        let mut straddles = false;
        for j in 0..N {
            // The domain's own faces have no other side, and what lies beyond belongs to somebody else.
            if x[j] < 0.0 || x[j] > 1.0 {
                return;
            }
            straddles |= x[j] - error[j] <= frame.lo[j] && frame.lo[j] > 0.0;
            straddles |= x[j] + error[j] >= frame.hi[j] && frame.hi[j] < 1.0;
        }
        if straddles {
            self.straddlers.push(Straddler { preimage, error });
        } else {
            sink.found(preimage);
        }
    }

    /// Hands on the roots near faces, once each.
    fn identify<S: Sink<N, M::Seen>>(&mut self, sink: &mut S) {
        let mut found = std::mem::take(&mut self.straddlers);
        found.sort_by_key(|straddler| straddler.preimage.target);
        for group in found.chunk_by(|a, b| a.preimage.target == b.preimage.target) {
            for (k, one) in group.iter().enumerate() {
                let near = |other: &&Straddler<N, M::Seen>| {
                    (0..N).all(|j| {
                        (one.preimage.x[j] - other.preimage.x[j]).abs() <= 2.0 * (one.error[j] + other.error[j])
                    })
                };
                match group[..k].iter().find(near) {
                    None => sink.found(one.preimage.clone()),
                    Some(other) => {
                        if !self.same(one, other) {
                            sink.undecided(Undecided {
                                target: one.preimage.target,
                                bounds: std::array::from_fn(|j| {
                                    let (x, pad) = (one.preimage.x[j], 4.0 * (one.error[j] + other.error[j]));
                                    Interval::new(x - pad, x + pad)
                                }),
                                reason: Reason::Smallest,
                            });
                        }
                    }
                }
            }
        }
    }

    /// Whether two roots of one target must be one, by second derivatives of the whole domain.
    fn same(&mut self, a: &Straddler<N, M::Seen>, b: &Straddler<N, M::Seen>) -> bool {
        let root = self.blocks.root();
        let Some(values) = self.blocks.values(&root, &self.blocks.first) else {
            return false;
        };
        let whole = Taylor::new(self.blocks, &root, &self.blocks.first, &values, self.map, self.scratch);
        let x = &a.preimage.x;
        let sample = self.map.evaluate(x);
        self.statistics.evaluations += 1;
        let distance = std::array::from_fn(|j| {
            let apart = (x[j] - b.preimage.x[j]).abs() + a.error[j] + b.error[j];
            (apart + a.error[j]) / whole.half[j]
        });
        whole.single(&sample, &distance)
    }
}
