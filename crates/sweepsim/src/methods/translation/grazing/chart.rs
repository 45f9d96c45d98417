//! Cells of a patch in which `(p, g)` is injective: the mean value theorem of `charts/` in `sweepsim-solve`, in two variables and in closed form.

/// A range of numbers.
pub(super) type Range = (f64, f64);
type Square = [[f64; 2]; 2];

/// A cell is a chart if the spectral radius of `|I − K J|` is below this.
const LIMIT: f64 = 0.7;

/// This close to a side of the chart, Newton's method is as accurate as if the chart were all of the patch.
const NEAR_FACE: f64 = 1e-4;

/// A cell in which a value of `p` has at most one point of the grazing curve, in coordinates `s ∈ [−1, 1]²`.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    pub lower: [f64; 2],
    pub upper: [f64; 2],
    centre: [f64; 2],
    pub half: [f64; 2],
    /// `K`: inverse of the scaled Jacobian in the middle.
    inverse: Square,
    /// `R`, a bound of `|I − K J|`.
    rest: Square,
    /// `R(I − R)⁻¹`, and the rounding error of a prediction times `(I − R)⁻¹`.
    spread: Square,
    variable_rounding: [f64; 2],
    /// Of all points of the curve: the sign of `∂(p, g)/∂(u, v)`.
    pub jump: i8,
    /// Ranges of the derivatives of `q`.
    slopes: [Range; 2],
}

/// What a cell is that is no chart.
pub(super) struct Rough {
    /// How much each variable contributes to `R`; `None` if there is no linearisation at all.
    pub smear: Option<[f64; 2]>,
    /// The part of the spectral radius, at least, that is due to the spread of directions.
    pub blurred: bool,
}

/// A point of a cell, and the values there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Witness {
    pub at: [f64; 2],
    /// `p` and `g`, or `X` and `Y`.
    pub value: [f64; 2],
    pub q: f64,
}

/// A rectangle in the coordinates of a chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub lo: [f64; 2],
    pub hi: [f64; 2],
}

fn times(m: &Square, v: [f64; 2]) -> [f64; 2] {
    [m[0][0] * v[0] + m[0][1] * v[1], m[1][0] * v[0] + m[1][1] * v[1]]
}

/// The inverse and the determinant; not finite if there is none.
fn inverted(m: &Square) -> (Square, f64) {
    let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let inverse = [[m[1][1], -m[0][1]], [-m[1][0], m[0][0]]];
    (inverse.map(|row| row.map(|x| x / determinant)), determinant)
}

/// `A⁻¹ b`, if it is finite.
pub(super) fn solved(a: &Square, b: [f64; 2]) -> Option<[f64; 2]> {
    let (inverse, _) = inverted(a);
    let x = times(&inverse, b);
    x.iter().all(|x| x.is_finite()).then_some(x)
}

/// The larger number; NaN if one of them is.
fn larger(a: f64, b: f64) -> f64 {
    if a >= b { a + 0.0 * b } else { b + 0.0 * a }
}

fn middle((lo, hi): Range) -> f64 {
    0.5 * lo + 0.5 * hi
}

fn radius((lo, hi): Range) -> f64 {
    0.5 * hi - 0.5 * lo
}

pub(super) fn widened((lo, hi): Range, by: f64) -> Range {
    (lo - by, hi + by)
}

pub(super) fn magnitude((lo, hi): Range) -> f64 {
    lo.abs().max(hi.abs())
}

fn finite(m: &Square) -> bool {
    m.as_flattened().iter().all(|x| x.is_finite())
}

impl Region {
    pub const WHOLE: Self = Self {
        lo: [-1.0; 2],
        hi: [1.0; 2],
    };

    pub fn around(place: [f64; 2], reach: [f64; 2]) -> Self {
        Self {
            lo: [place[0] - reach[0], place[1] - reach[1]],
            hi: [place[0] + reach[0], place[1] + reach[1]],
        }
    }

    /// NaN ends do not restrict it.
    pub fn intersect(&mut self, other: &Self) {
        for i in 0..2 {
            if other.lo[i] > self.lo[i] {
                self.lo[i] = other.lo[i];
            }
            if other.hi[i] < self.hi[i] {
                self.hi[i] = other.hi[i];
            }
        }
    }

    pub fn is_empty(&self) -> bool {
        (0..2).any(|i| self.lo[i] > self.hi[i])
    }

    /// Whether all of it is inside the chart beyond rounding.
    pub fn is_inside(&self) -> bool {
        const NEAR: f64 = 1.0 - 1e-9;
        (0..2).all(|i| self.lo[i] > -NEAR && self.hi[i] < NEAR)
    }

    /// Whether both sides are shorter than this.
    pub fn is_within(&self, size: [f64; 2]) -> bool {
        (0..2).all(|i| self.hi[i] - self.lo[i] < size[i])
    }

    /// The nearest position; the centre for NaN.
    pub fn clamp(&self, s: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| {
            if s[i].is_nan() {
                0.5 * (self.lo[i] + self.hi[i])
            } else {
                s[i].clamp(self.lo[i], self.hi[i])
            }
        })
    }
}

impl Chart {
    /// On a cell with ranges of the derivatives of `p` and `g` in `(u, v)`, of which `blur` at most is due to the spread of directions, with the rounding errors of both, and ranges of
    /// the derivatives of `q`.
    pub fn new(
        [lower, upper]: [[f64; 2]; 2],
        jacobian: &[[Range; 2]; 2],
        blur: &Square,
        rounding: [f64; 2],
        slopes: [Range; 2],
    ) -> Result<Self, Rough> {
        let half = [0, 1].map(|j| 0.5 * (upper[j] - lower[j]));
        let mid = [0, 1].map(|i: usize| [0, 1].map(|j: usize| middle(jacobian[i][j]) * half[j]));
        let (inverse, determinant) = inverted(&mid);
        if !(finite(&inverse) && determinant != 0.0) {
            return Err(Rough {
                smear: None,
                blurred: false,
            });
        }
        let (mut rest, mut smear, mut blurred) = ([[0.0; 2]; 2], [0.0; 2], 0.0_f64);
        for i in 0..2 {
            for j in 0..2 {
                let (mut product, mut spread, mut rounding, mut of_directions) = (0.0, 0.0, 0.0, 0.0);
                for k in 0..2 {
                    let factor = inverse[i][k];
                    product += factor * mid[k][j];
                    spread += factor.abs() * radius(jacobian[k][j]) * half[j];
                    rounding += factor.abs() * magnitude(jacobian[k][j]) * half[j];
                    of_directions += factor.abs() * blur[k][j] * half[j];
                }
                let unit = if i == j { 1.0 } else { 0.0 };
                rest[i][j] = (product - unit).abs() + spread + 16.0 * f64::EPSILON * rounding;
                smear[j] += spread;
                blurred = blurred.max(of_directions);
            }
        }
        // The larger eigenvalue of a nonnegative matrix.
        let [[a, b], [c, d]] = rest;
        let spectral = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * c).sqrt();
        let rough = || {
            let smear = smear.iter().all(|x| x.is_finite()).then_some(smear);
            let blurred = blurred > 0.1;
            Rough { smear, blurred }
        };
        // NaN is no chart.
        if !(spectral < LIMIT) {
            return Err(rough());
        }
        // Both eigenvalues of I − R are at least 1 − LIMIT, so that only a few dozen roundings are lost.
        let grown = 1.0 + 1e-12;
        let determinant = (1.0 - a) * (1.0 - d) - b * c;
        let sum = [[1.0 - d, b], [c, 1.0 - a]].map(|row| row.map(|x| grown * x / determinant));
        let product = |i: usize, j: usize| grown * (rest[i][0] * sum[0][j] + rest[i][1] * sum[1][j]);
        let spread = [[product(0, 0), product(0, 1)], [product(1, 0), product(1, 1)]];
        let own = inverse.map(|row| row[0].abs() * rounding[0] + row[1].abs() * rounding[1] + 16.0 * f64::EPSILON);
        let variable_rounding = times(&sum, own).map(|x| grown * x);
        let known =
            variable_rounding.iter().all(|x| x.is_finite()) && slopes.iter().all(|slope| magnitude(*slope).is_finite());
        if !(finite(&spread) && known) {
            return Err(rough());
        }
        Ok(Self {
            lower,
            upper,
            centre: [0, 1].map(|j| 0.5 * (lower[j] + upper[j])),
            half,
            inverse,
            rest,
            spread,
            variable_rounding,
            jump: if inverted(&mid).1 > 0.0 { 1 } else { -1 },
            slopes: [0, 1].map(|j| (slopes[j].0 * half[j], slopes[j].1 * half[j])),
        })
    }

    /// The largest row sum of `R`.
    pub fn norm(&self) -> f64 {
        let [a, b] = self.rest.map(|row| row[0] + row[1]);
        a.max(b)
    }

    pub fn point(&self, s: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|j| self.centre[j] + s[j] * self.half[j])
    }

    /// Where the map has these values, as predicted from a witness, and how far from there that can be.
    #[inline]
    pub fn prediction(&self, witness: &Witness, target: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let step = times(
            &self.inverse,
            [target[0] - witness.value[0], target[1] - witness.value[1]],
        );
        let spread = times(&self.spread, step.map(f64::abs));
        let place = [witness.at[0] + step[0], witness.at[1] + step[1]];
        (
            place,
            [
                spread[0] + self.variable_rounding[0],
                spread[1] + self.variable_rounding[1],
            ],
        )
    }

    /// The part of a region in which the map can have these values.
    #[inline]
    pub fn region(&self, witness: &Witness, target: [f64; 2], within: &Region) -> Region {
        let (place, reach) = self.prediction(witness, target);
        let mut region = *within;
        region.intersect(&Region::around(place, reach));
        // Not farther from the place than R times the largest distance from the witness.
        let far = [0, 1].map(|i: usize| (within.hi[i] - witness.at[i]).max(witness.at[i] - within.lo[i]));
        let spread = times(&self.rest, far);
        region.intersect(&Region::around(
            place,
            [
                spread[0] + self.variable_rounding[0],
                spread[1] + self.variable_rounding[1],
            ],
        ));
        region
    }

    /// The same of the grazing curve, for all values of `p` in a range: predictions and reaches are convex between its ends.
    pub fn region_along(&self, witness: &Witness, range: [f64; 2]) -> Region {
        let [(a, near), (b, far)] = range.map(|p| self.prediction(witness, [p, 0.0]));
        let mut region = Region::WHOLE;
        // Not farther from the place than R times the largest distance from the witness.
        let most = times(&self.rest, witness.at.map(|s| 1.0 + s.abs()));
        let reach = [0, 1].map(|i: usize| larger(near[i], far[i]).min(most[i] + self.variable_rounding[i]));
        region.intersect(&Region {
            lo: [0, 1].map(|i: usize| -larger(-a[i], -b[i]) - reach[i]),
            hi: [0, 1].map(|i: usize| larger(a[i], b[i]) + reach[i]),
        });
        region
    }

    /// The range of `q` in a region.
    #[inline]
    pub fn q(&self, witness: &Witness, region: &Region) -> Range {
        let mut range = (witness.q, witness.q);
        for j in 0..2 {
            let (a, b) = (region.lo[j] - witness.at[j], region.hi[j] - witness.at[j]);
            let (lo, hi) = self.slopes[j];
            let ends = [a * lo, a * hi, b * lo, b * hi];
            range.0 += ends.iter().copied().fold(f64::INFINITY, f64::min);
            range.1 += ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        }
        range
    }

    /// How much `q` may change over these distances.
    pub fn change(&self, distances: [f64; 2]) -> f64 {
        distances[0] * magnitude(self.slopes[0]) + distances[1] * magnitude(self.slopes[1])
    }

    /// Whether a step is a last one: as short as accuracy asks (inside, and near a side), and so short that its error, which is less than its square, leaves no doubt on which side of each side of the chart it ends.
    pub fn is_close(&self, step: [f64; 2], next: [f64; 2], accept: [f64; 2]) -> bool {
        let near_face = next[0].abs().max(next[1].abs()) > 1.0 - NEAR_FACE;
        let long = step[0].abs().max(step[1].abs());
        let variable_rounding = self.variable_rounding();
        let tells_sides = (0..2).all(|i| (1.0 - next[i].abs()).abs() > long * long || long <= variable_rounding[i]);
        long <= accept[usize::from(near_face)] && tells_sides
    }

    /// The rounding error of a position.
    pub fn variable_rounding(&self) -> [f64; 2] {
        self.variable_rounding
    }

    /// Whether a point is in the cell. Only its lower sides, and upper sides on the patch's boundary, belong to it.
    pub fn owns(&self, s: [f64; 2]) -> bool {
        let x = self.point(s);
        (0..2).all(|i| {
            let (lo, hi) = (self.lower[i], self.upper[i]);
            x[i] >= lo && (x[i] < hi || (x[i] <= hi && hi == 1.0))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// The region for a range of `p` holds those for all of its values.
        #[test]
        fn regions_along_the_curve_hold_all_others(
            middles in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0, -1.0..1.0], spread in 0.0..0.4_f64, at in [-1.0..1.0, -1.0..1.0],
            value in [-2.0..2.0, -0.5..0.5], range in [-3.0..3.0, 0.0..3.0], share in 0.0..1.0_f64,
        ) {
            let entry = |k: usize| (middles[k] - spread * middles[k].abs(), middles[k] + spread * middles[k].abs());
            let jacobian = [[entry(0), entry(1)], [entry(2), entry(3)]];
            let chart = Chart::new([[0.0; 2], [1.0; 2]], &jacobian, &[[0.0; 2]; 2], [1e-12; 2], [(0.0, 1.0); 2]);
            let Ok(chart) = chart else { return Ok(()) };
            let witness = Witness { at, value, q: 0.0 };
            let [low, length] = range;
            let all = chart.region_along(&witness, [low, low + length]);
            let one = chart.region(&witness, [low + share * length, 0.0], &Region::WHOLE);
            for i in 0..2 {
                prop_assert!(one.is_empty() || (all.lo[i] <= one.lo[i] + 1e-12 && all.hi[i] >= one.hi[i] - 1e-12), "{all:?} {one:?}");
            }
        }
    }
}
