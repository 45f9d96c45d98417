//! What the reductions of a patch's forms lack, on cells near a pole.
//!
//! Where a side of a patch has shrunk to a point, most components of its normals vanish on it, and lines beside the pole are only told from it by what is left of them
//! there. So bounds of third derivatives and of rounding errors have to vanish like the components themselves: with a bound for the whole patch, cells about the pole of
//! a ball end that passes over a line would have to be as narrow as the third root of the line's distance.

/// Bounds of one form.
#[derive(Clone, Debug)]
pub(super) struct Size {
    /// Of the form, with the other variable as in [`Bound`], times the roundings of a reduced coefficient.
    roundings: [Bound; 2],
    /// Of the third derivatives in each variable.
    thirds: [Bound; 2],
    /// Of the derivatives of these in the other variable.
    mixed: [Bound; 2],
}

/// Bounds of a form on a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The rounding of a reduced coefficient.
    pub rounding: f64,
    /// Of the third derivatives in each variable, and of the derivatives of these in the other variable.
    pub third: [f64; 2],
    pub mixed: [f64; 2],
}

impl Size {
    /// `combined`: how many times as large as the values at the nodes the coefficients of a reduction are, at most.
    pub fn new(form: &[f64], degrees: [usize; 2], combined: f64) -> Self {
        let along = |axis: usize| {
            let (n, rows) = (degrees[axis], degrees[1 - axis]);
            let at = move |i: usize, row: usize| {
                form[if axis == 0 {
                    row * (n + 1) + i
                } else {
                    i * (rows + 1) + row
                }]
            };
            // In each variable, 1.5 n roundings of Bernstein polynomials, 3n that the nodes are off by, and n/2 + 1 of a sum of products.
            let roundings = combined * (5 * (n + rows) + 8) as f64 * f64::EPSILON;
            let cubic = (n * n.saturating_sub(1) * n.saturating_sub(2)) as f64;
            let third =
                |i: usize, row: usize| cubic * (at(i + 3, row) - 3.0 * (at(i + 2, row) - at(i + 1, row)) - at(i, row));
            let count = (n + 1).saturating_sub(3);
            let thirds: Vec<Vec<f64>> = (0..=rows)
                .map(|row| (0..count).map(|i| third(i, row)).collect())
                .collect();
            // The step from the last row to itself is 0: forms of one row have no derivative in the other variable.
            let step = |row: usize| {
                let next = thirds[(row + 1).min(rows)].iter();
                largest(next.zip(&thirds[row]).map(|(next, this)| rows as f64 * (next - this)))
            };
            let bound = |of: &dyn Fn(usize) -> f64, count: usize| Bound::new(&(0..count).map(of).collect::<Vec<f64>>());
            [
                bound(&|row| largest((0..=n).map(|i| roundings * at(i, row))), rows + 1),
                bound(&|row| largest(thirds[row].iter().copied()), rows + 1),
                bound(&step, rows.max(1)),
            ]
        };
        let [[rounding_u, third_u, mixed_u], [rounding_v, third_v, mixed_v]] = [0, 1].map(along);
        Self {
            roundings: [rounding_u, rounding_v],
            thirds: [third_u, third_v],
            mixed: [mixed_u, mixed_v],
        }
    }

    pub fn vanishes(&self) -> bool {
        self.thirds.iter().any(Bound::vanishes)
    }

    /// The bounds on a cell.
    pub fn on(&self, lower: [f64; 2], upper: [f64; 2]) -> Bounds {
        let on = |[in_u, in_v]: &[Bound; 2]| [in_u.between(lower[1], upper[1]), in_v.between(lower[0], upper[0])];
        let [u, v] = on(&self.roundings);
        Bounds {
            rounding: u.min(v),
            third: on(&self.thirds),
            mixed: on(&self.mixed),
        }
    }

    /// The same anywhere.
    #[inline]
    pub fn anywhere(&self) -> Bounds {
        Bounds {
            rounding: self.roundings[0].most,
            third: self.thirds.each_ref().map(|third| third.most),
            mixed: self.mixed.each_ref().map(|mixed| mixed.most),
        }
    }
}

/// Whether a cell is near a side, where some bounds may be less than anywhere.
pub(super) fn is_near_side(lower: [f64; 2], upper: [f64; 2]) -> bool {
    (0..2).any(|axis| upper[axis] <= Bound::NEAR || 1.0 - lower[axis] <= Bound::NEAR)
}

/// A bound of a form in one variable, on ranges of the other.
#[derive(Clone, Debug)]
struct Bound {
    /// On the whole patch.
    most: f64,
    /// For the lower and the upper side of the other variable, if the form is small there: bounds of the coefficients of the powers of the distance from that side.
    towards: [Option<Vec<f64>>; 2],
}

impl Bound {
    /// How far from a side its own bound is used, and how small it is there, relative to the largest.
    const NEAR: f64 = 1.0 / 16.0;
    const SMALL: f64 = 1e-3;

    /// From bounds of the coefficients in one variable, for each coefficient in the other.
    fn new(of_rows: &[f64]) -> Self {
        let (most, degree) = (largest(of_rows.iter().copied()), of_rows.len() - 1);
        let towards = [0, 1].map(|side| {
            let from_side = |j: usize| of_rows[if side == 0 { j } else { degree - j }];
            let mut binomial = 1.0;
            let powers = (0..=degree).map(|j| {
                // The Bernstein polynomial is at most (n over j) xʲ.
                let bound = binomial * from_side(j);
                binomial *= (degree - j) as f64 / (j + 1) as f64;
                bound
            });
            (from_side(0) < Self::SMALL * most).then(|| powers.collect())
        });
        Self { most, towards }
    }

    fn vanishes(&self) -> bool {
        self.towards.iter().any(Option::is_some)
    }

    /// A bound where the other variable is in this range.
    fn between(&self, from: f64, to: f64) -> f64 {
        let mut most = self.most;
        for (powers, distance) in self.towards.iter().zip([to, 1.0 - from]) {
            if let Some(powers) = powers
                && distance <= Self::NEAR
            {
                most = most.min(powers.iter().rev().fold(0.0, |sum, c| sum * distance + c));
            }
        }
        most
    }
}

/// The largest absolute value; NaN if one of them is.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    // NaN is larger than any number in this order, and stays.
    values.fold(0.0, |most: f64, x| {
        if most.is_nan() || x.abs() <= most {
            most
        } else {
            x.abs()
        }
    })
}
