//! One chart: Newton's method in it, and where preimages can be.

use super::about::Points;
use super::faces::{BoxPlace, Searched};
use super::linear::{Contraction, Linear};
use super::neighbours::{Neighbours, Solution};
use super::region::{Region, Witness};
use super::sides::Sides;
use super::solver::{BETWEEN, CLOSE};
use super::{ChartSolver, Preimage, Sink, Targets};
use crate::{Enclosure, Monitor};
use nalgebra::{SMatrix, SVector, Vector3};

/// Steps in a chart before the box is split instead.
const STEPS: usize = 32;
/// If a preimage can only lie in a part of the box no larger than this, relative to half its sides (besides rounding), Newton's result decides whether there is one.
const ON_FACE: f64 = 1e-11;

/// With rounding of more than this part of half the side, one step does not tell where a preimage is: Newton's method has to come to rest, perhaps beyond the box.
const HIDDEN: f64 = 0.25;
/// It does when its steps are no longer than this part of the rounding.
const RESTS: f64 = 1.0 / 16.0;
/// A preimage is expected in the box if its first guess is no farther from the centre, in half sides.
const BESIDE: f64 = 1.0;

type Square<const N: usize> = SMatrix<f64, N, N>;

/// The outcome for a target in a chart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    Settled,
    Unclear,
}

/// A box on which the map is injective.
pub(crate) struct Chart<'a, const N: usize> {
    linear: &'a Linear<N>,
    contraction: &'a Contraction<N>,
    bounds: &'a [Enclosure; N],
    searched: &'a Searched<'a, N>,
    /// The longest last step of Newton's method, in half sides: well inside the box, and near a face.
    accept: [f64; 2],
}

/// This close to a face, relative to half the side, Newton's method is as accurate as if the box were the whole domain.
const NEAR_FACE: f64 = 1e-4;
/// The last step is never longer than this.
const LONGEST: f64 = 1e-3;

impl<'a, const N: usize> Chart<'a, N> {
    pub fn new(
        linear: &'a Linear<N>,
        contraction: &'a Contraction<N>,
        bounds: &'a [Enclosure; N],
        searched: &'a Searched<'a, N>,
        accept: f64,
    ) -> Self {
        // ‖R‖ bounds how much the Jacobian changes over the box, so that a step of δ leaves an error of about ‖R‖δ² half sides; the map's
        // other data are off by about the square of the step. In parts of the domain both are to be at most the square of `accept`.
        let part = (0..N)
            .map(|i| bounds[i].radius() / searched.domain[i].radius())
            .fold(0.0, f64::max);
        let scale = (part * part.max(linear.norm())).sqrt();
        let inside = (accept / scale).min(LONGEST).max(accept);
        Self {
            linear,
            contraction,
            bounds,
            searched,
            accept: [inside, accept],
        }
    }

    /// Predicts from a position where a preimage of `q` is, and the region that must contain it if it is in the box.
    pub fn region(&self, witness: &Witness<N>, q: &[f64; N]) -> (SVector<f64, N>, Region<N>) {
        let step = self.linear.inverse * SVector::<f64, N>::from_fn(|i, _| q[i] - witness.value[i]);
        let reach = self.contraction.rest * step.abs() + self.contraction.error;
        let place = witness.at + step;
        (place, Region::around(&place, &reach))
    }

    /// Newton's method from `guess`. Each point that it evaluates in the box also bounds, by the mean value theorem about it,
    /// where in the box a preimage can be; when nothing is left, there is none.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    pub fn solve<P: Points<N>>(
        &self,
        map: &P,
        guess: SVector<f64, N>,
        mut region: Region<N>,
        q: &[f64; N],
        witness: &mut Option<Witness<N>>,
        evaluations: &mut u64,
        found: &mut impl FnMut(SVector<f64, N>, BoxPlace, &Square<N>, [f64; N], P::Seen),
    ) -> Outcome {
        let linear = self.linear;
        let mut s = guess;
        let clamped = region.clamp(&s);
        // Probably there is none, and the value alone tells.
        let value = if s.amax() > BESIDE {
            map.value(&linear.point(&clamped))
        } else {
            None
        };
        if let Some(value) = value {
            let here = Witness { at: clamped, value };
            *evaluations += 1;
            *witness = Some(here);
            let predicted = self.narrow(&here, q, &mut region);
            if region.is_empty() {
                return Outcome::Settled;
            }
            s = predicted;
        }
        // Whether rounding leaves so much of the box that Newton's method has to come to rest, perhaps beyond it.
        let mut is_hidden = false;
        for _ in 0..STEPS {
            s = if is_hidden {
                self.within_rounding(&s)
            } else {
                region.clamp(&s)
            };
            let from = linear.point(&s);
            let sample = map.evaluate(&from);
            *evaluations += 1;
            let here = Witness {
                at: s,
                value: sample.value,
            };
            *witness = Some(here);
            let scaled = Square::<N>::from_fn(|i, j| sample.jacobian[i][j] * linear.half[j]);
            let rest = SVector::<f64, N>::from_fn(|i, _| sample.value[i] - q[i]);
            let next = solve_linear(&scaled, &rest).map(|step| s - step);
            let step = next.map_or(f64::INFINITY, |next| (next - s).amax());
            if let Some(next) = next {
                let near_face = next.amax() > 1.0 - NEAR_FACE;
                let is_last = if is_hidden {
                    (0..N).all(|i| (next[i] - s[i]).abs() <= LONGEST.max(RESTS * linear.variable_rounding[i]))
                } else {
                    step <= self.accept[usize::from(near_face)] && self.tells_sides(&next, step)
                };
                if is_last {
                    let place = self.place(&next);
                    if place != BoxPlace::Outside {
                        found(next, place, &scaled, from, sample.seen);
                        return Outcome::Settled;
                    }
                    if is_hidden {
                        return Outcome::Settled;
                    }
                }
            }
            if is_hidden {
                let Some(next) = next else {
                    return Outcome::Unclear;
                };
                s = next;
                continue;
            }
            let predicted = self.narrow(&here, q, &mut region);
            if region.is_empty() {
                return Outcome::Settled;
            }
            if (0..N).all(|i| region.hi[i] - region.lo[i] < ON_FACE + 4.0 * linear.variable_rounding[i]) {
                // As close as rounding allows: a smaller box would not help.
                let Some(next) = next else {
                    return Outcome::Unclear;
                };
                let is_near =
                    (0..N).all(|i| (next[i] - s[i]).abs() <= self.accept[1].max(2.0 * linear.variable_rounding[i]));
                match self.place(&next) {
                    BoxPlace::Outside if is_near => return Outcome::Settled,
                    BoxPlace::Outside => return Outcome::Unclear,
                    _ if linear.variable_rounding.amax() > HIDDEN => is_hidden = true,
                    place => {
                        found(next, place, &scaled, from, sample.seen);
                        return Outcome::Settled;
                    }
                }
            }
            s = next.unwrap_or(predicted);
        }
        Outcome::Unclear
    }

    /// The nearest position in the domain that is no farther beyond the box than rounding.
    #[cold]
    fn within_rounding(&self, s: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|i, _| {
            let part = &self.searched.part[i];
            let end = |x: f64| (x - self.linear.centre[i]) / self.linear.half[i];
            let most = 1.0 + 2.0 * self.contraction.error[i];
            s[i].max(end(part.lo()).max(-most)).min(end(part.hi()).min(most))
        })
    }

    /// Leaves of a region what can hold a preimage of `q`, and predicts it.
    fn narrow(&self, here: &Witness<N>, q: &[f64; N], region: &mut Region<N>) -> SVector<f64, N> {
        let (predicted, own) = self.region(here, q);
        let far = SVector::from_fn(|i, _| f64::max(region.hi[i] - here.at[i], here.at[i] - region.lo[i]));
        region.intersect(&own);
        region.intersect(&Region::around(
            &predicted,
            &(self.linear.rest * far + self.linear.variable_rounding),
        ));
        predicted
    }

    /// Whether a point that is reached by a step of this length is certainly on the right side of each face: its error is less than the square of the step. Two boxes, of patches that meet smoothly, say, would both own a
    /// point near their common face, or neither, if each came to it from its own side.
    fn tells_sides(&self, next: &SVector<f64, N>, step: f64) -> bool {
        (0..N).all(|i| (1.0 - next[i].abs()).abs() > step * step || step <= self.linear.variable_rounding[i])
    }

    fn place(&self, s: &SVector<f64, N>) -> BoxPlace {
        BoxPlace::of(s, self.linear, self.bounds, self.searched)
    }
}

impl<C: Clone> ChartSolver<C> {
    /// Solves all targets of a chart; `false` if one stayed undecided (then none was reported).
    #[allow(clippy::too_many_arguments)]
    pub(super) fn chart<const N: usize, P, T, S>(
        &mut self,
        map: &P,
        sides: Option<&Sides<N>>,
        linear: &Linear<N>,
        contraction: &Contraction<N>,
        bounds: &[Enclosure; N],
        searched: &Searched<N>,
        value: &[f64; N],
        values: &[Enclosure; N],
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) -> bool
    where
        P: Points<N>,
        T: Targets<N> + ?Sized,
        S: Sink<N, P::Seen>,
    {
        let reach = SVector::<f64, N>::from_fn(|i, _| linear.reach(i));
        let centre = Witness {
            at: SVector::zeros(),
            value: *value,
        };
        let whole = Region::around(&centre.at, &SVector::repeat(1.0));
        let close = linear.radius < CLOSE;
        let mut known = Neighbours::new();
        let mut clear = true;
        let Self {
            options,
            statistics,
            faces,
            ..
        } = self;
        let mark = (sink.mark(), faces.mark());
        let chart = Chart::new(linear, contraction, bounds, searched, options.accept);
        // Of the last target examined, and of the first one found in the row.
        let (mut last, mut first): (Option<Witness<N>>, Option<Witness<N>>) = (None, None);
        let mut row = usize::MAX;
        let mut asked = 0_usize;
        let strips = linear.strips(value);
        let window = |q: &[f64; N]| {
            let own = strips.window(q)?;
            match sides {
                Some(sides) => own.intersection(sides.window(linear, value, q)?),
                None => Some(own),
            }
        };
        targets.visit(values, &window, &mut |target| {
            asked += 1;
            if asked.is_multiple_of(BETWEEN) && monitor.cancelled() {
                clear = false;
                return false;
            }
            let q = &target.value;
            if target.place[0] != row {
                row = target.place[0];
                last = first.take().or(last);
            }
            let (near, mut region) = chart.region(last.as_ref().unwrap_or(&centre), q);
            region.intersect(&whole);
            // A close guess needs no second prediction.
            if (!close || last.is_none()) && !region.is_empty() {
                let start = linear.predict(&centre.at, value, q);
                region.intersect(&Region::around(&start, &reach));
            }
            if region.is_empty() || sides.is_some_and(|sides| sides.agree(&region)) {
                return true;
            }
            let first_two = if N == 1 { [0.0, q[0]] } else { [q[0], q[1]] };
            let guess = known.guess(target.place, &first_two).map_or(near, SVector::from);
            let (mut witness, mut hit) = (None, false);
            let outcome = chart.solve(
                map,
                guess,
                region,
                q,
                &mut witness,
                &mut statistics.evaluations,
                &mut |s, place, jacobian, from, seen| {
                    if let Some(slopes) = first_columns(jacobian) {
                        let solution = Solution {
                            s: s.into(),
                            q: first_two,
                            slopes,
                        };
                        known.push(target.place, solution);
                    }
                    hit = true;
                    let x = linear.point(&s);
                    if faces.is_new(target.number, &x, linear, place) {
                        sink.found(Preimage {
                            target: target.number,
                            x,
                            from,
                            seen,
                            orientation: linear.orientation,
                        });
                    }
                },
            );
            if hit {
                first = first.or(witness);
            }
            last = witness.or(last);
            clear = outcome == Outcome::Settled;
            clear
        });
        if !clear {
            sink.forget(mark.0);
            faces.forget(mark.1);
        }
        clear
    }
}

/// The first two columns of `A⁻¹`; for `N = 1` zeros, and the only one.
fn first_columns<const N: usize>(matrix: &Square<N>) -> Option<[[f64; N]; 2]> {
    if N == 3 {
        let column = |j: usize| Vector3::new(matrix[(0, j)], matrix[(1, j)], matrix[(2, j)]);
        let (x, y, z) = (column(0), column(1), column(2));
        let rows = [y.cross(&z), z.cross(&x), x.cross(&y)];
        let inverse = 1.0 / x.dot(&rows[0]);
        return inverse
            .is_finite()
            .then(|| [0, 1].map(|k| std::array::from_fn(|i| rows[i][k] * inverse)));
    }
    let column = |k: usize| solve_linear(matrix, &SVector::from_fn(|i, _| f64::from(u8::from(i == k))));
    match N {
        1 => Some([[0.0; N], column(0)?.into()]),
        _ => Some([column(0)?.into(), column(1)?.into()]),
    }
}

/// `A⁻¹ b` for a small matrix.
fn solve_linear<const N: usize>(matrix: &Square<N>, b: &SVector<f64, N>) -> Option<SVector<f64, N>> {
    if N == 3 {
        // Cramer's rule: Newton's method makes up for its errors.
        let column = |j: usize| Vector3::new(matrix[(0, j)], matrix[(1, j)], matrix[(2, j)]);
        let (x, y, z, b) = (column(0), column(1), column(2), Vector3::new(b[0], b[1], b[2]));
        let (yz, xb) = (y.cross(&z), x.cross(&b));
        let determinant = x.dot(&yz);
        let inverse = 1.0 / determinant;
        let solution = [b.dot(&yz) * inverse, z.dot(&xb) * inverse, -y.dot(&xb) * inverse];
        return (inverse.is_finite() && solution.iter().all(|x| x.is_finite()))
            .then(|| SVector::from_fn(|i, _| solution[i]));
    }
    let mut a = *matrix;
    let mut x = *b;
    for k in 0..N {
        let pivot = (k..N).max_by(|i, j| a[(*i, k)].abs().total_cmp(&a[(*j, k)].abs()))?;
        if a[(pivot, k)] == 0.0 || !a[(pivot, k)].is_finite() {
            return None;
        }
        a.swap_rows(k, pivot);
        x.swap_rows(k, pivot);
        for i in k + 1..N {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..N {
                a[(i, j)] -= factor * a[(k, j)];
            }
            x[i] -= factor * x[k];
        }
    }
    for k in (0..N).rev() {
        for j in k + 1..N {
            x[k] -= a[(k, j)] * x[j];
        }
        x[k] /= a[(k, k)];
    }
    Some(x)
}
