//! Leading forms: the homogeneous parts of series that outweigh all others on the boundary of the polydisc `abs(tₖ) ≤ 1`.
//!
//! If forms of degrees `k₁, …, kₘ` have no common zero but 0, the origin is a zero of multiplicity `k₁ ⋯ kₘ` (Bézout). If one of them outweighs the rest of its
//! series at each point of the boundary, the series have as many zeros (Rouché: `form + s · rest` never vanishes there, for `s` from 0 to 1). A common phase of all `tₖ`
//! changes no form's absolute value, so on the part of the boundary where `abs(tᵢ) = 1`, `tᵢ = 1` will do.

use super::series::{MOST, Powers, Series};

/// A row leads with a degree if the coefficient that is left of it, after the rows before it were taken away, is at least this part of its largest.
const LEADS: f64 = 0.1;
/// The most pieces of the boundary.
const PIECES: usize = 20_000;
/// The boundary of the real square is halved this often at most.
const HALVINGS: u32 = 12;

/// The degrees with which combinations of rows lead, and the combinations.
pub(super) fn degrees(powers: &Powers, rows: &[Series]) -> ([u8; MOST], [[f64; MOST]; MOST]) {
    let m = rows.len();
    let mut left: Vec<Vec<f64>> = rows.iter().map(|r| r.c.iter().map(|c| c.hi).collect()).collect();
    let mut mix = [[0.0; MOST]; MOST];
    for (i, row) in mix.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    let mut found = [0; MOST];
    let mut open: Vec<usize> = (0..m).collect();
    let top = powers.degree(powers.len() - 1);
    for degree in 0..=top {
        let numbers = || (0..powers.len()).filter(|k| powers.degree(*k) == degree);
        loop {
            let mut pivot = (0.0, 0, 0);
            for i in &open {
                let largest = left[*i].iter().fold(0.0, |w: f64, c| w.max(c.abs()));
                for k in numbers() {
                    if left[*i][k].abs() > pivot.0 && left[*i][k].abs() >= LEADS * largest {
                        pivot = (left[*i][k].abs(), *i, k);
                    }
                }
            }
            let (size, row, number) = pivot;
            if size == 0.0 {
                break;
            }
            open.retain(|i| *i != row);
            found[row] = degree;
            // The others without this power. Factors of at most 1, lest rounding spoil the combinations.
            for i in &open {
                let factor = left[*i][number] / left[row][number];
                if factor.abs() > 1.0 {
                    continue;
                }
                for k in 0..powers.len() {
                    let share = factor * left[row][k];
                    left[*i][k] -= share;
                }
                for k in 0..m {
                    let share = factor * mix[row][k];
                    mix[*i][k] -= share;
                }
            }
        }
    }
    (found, mix)
}

/// A row's leading form, and a bound of the row's rest on the polydisc.
#[derive(Debug)]
pub(super) struct Form {
    terms: Vec<([u8; MOST], f64)>,
    rest: f64,
}

impl Form {
    /// The part of this degree; `more` bounds what the series does not know of.
    pub(super) fn new(powers: &Powers, row: &Series, degree: u8, more: f64) -> Self {
        let own = |k: &usize| powers.degree(*k) == degree;
        let terms: Vec<_> = (0..powers.len())
            .filter(own)
            .map(|k| (powers.exponents[k], row.c[k].hi))
            .collect();
        let rounding: f64 = terms.iter().map(|t| t.1.abs()).sum::<f64>() * 1e-14;
        let rest = (row.size_of(|k| !own(&k)) + more + rounding) * (1.0 + 1e-12);
        Self { terms, rest }
    }

    /// Whether it is surely larger than the rest within `radius` of a point, in each variable.
    fn outweighs(&self, point: &[(f64, f64); MOST], radius: &[f64; MOST]) -> Option<(f64, f64)> {
        let (mut sum, mut variation) = ((0.0, 0.0), 0.0);
        for (exponents, c) in &self.terms {
            let (mut value, mut size, mut larger) = ((*c, 0.0), c.abs(), c.abs());
            for k in 0..MOST {
                let (re, im) = point[k];
                for _ in 0..exponents[k] {
                    value = (value.0 * re - value.1 * im, value.0 * im + value.1 * re);
                    size *= re.hypot(im);
                    larger *= re.hypot(im) + radius[k];
                }
            }
            sum = (sum.0 + value.0, sum.1 + value.1);
            variation += larger - size;
        }
        // Roundings are far below the rest's, which has 1e-14 of all terms.
        (f64::hypot(sum.0, sum.1) > variation * (1.0 + 1e-9) + self.rest).then_some(sum)
    }
}

/// Whether one of the forms outweighs its rest at each point of the polydisc's boundary.
pub(super) fn dominate(forms: &[Form]) -> bool {
    let m = forms.len();
    let mut pieces = 0;
    (0..m).all(|fixed| {
        // Squares of half width `radius / √2` about a point, one for each variable.
        let mut start = ([(0.0, 0.0); MOST], [0.0; MOST]);
        for k in 0..m {
            start.1[k] = 2f64.sqrt();
        }
        (start.0[fixed], start.1[fixed]) = ((1.0, 0.0), 0.0);
        let mut waiting = vec![start];
        while let Some((point, radius)) = waiting.pop() {
            pieces += 1;
            if pieces > PIECES {
                return false;
            }
            let outside = (0..m).any(|k| f64::hypot(point[k].0, point[k].1) - radius[k] > 1.0 + 1e-9);
            if outside || forms.iter().any(|f| f.outweighs(&point, &radius).is_some()) {
                continue;
            }
            let widest = (0..m).fold(0, |best, k| if radius[k] > radius[best] { k } else { best });
            if radius[widest] < 1e-6 {
                return false;
            }
            let step = 0.5 * radius[widest] / 2f64.sqrt();
            for (x, y) in [(-step, -step), (-step, step), (step, -step), (step, step)] {
                let (mut point, mut radius) = (point, radius);
                point[widest] = (point[widest].0 + x, point[widest].1 + y);
                radius[widest] *= 0.5;
                waiting.push((point, radius));
            }
        }
        true
    })
}

/// The degree of one or two forms that dominate, as a map of the real plane; `None` for more.
pub(super) fn real_degree(forms: &[Form]) -> Option<i32> {
    let at = |form: &Form, x: f64, y: f64, reach: [f64; 2]| {
        let point = [(x, 0.0), (y, 0.0), (0.0, 0.0)];
        form.outweighs(&point, &[reach[0], reach[1], 0.0]).map(|v| v.0)
    };
    if let [form] = forms {
        let (below, above) = (at(form, -1.0, 0.0, [0.0; 2])?, at(form, 1.0, 0.0, [0.0; 2])?);
        return Some((above.signum() - below.signum()) as i32 / 2);
    }
    let [first, second] = forms else { return None };
    let mut labels = Vec::new();
    // Anticlockwise, from the lower left corner.
    for (corner, way) in [
        ((-1.0, -1.0), (1.0, 0.0)),
        ((1.0, -1.0), (0.0, 1.0)),
        ((1.0, 1.0), (-1.0, 0.0)),
        ((-1.0, 1.0), (0.0, -1.0)),
    ] {
        let mut waiting = vec![(0.0, 2.0, 0)];
        while let Some((from, to, halvings)) = waiting.pop() {
            let (middle, reach): (f64, f64) = (0.5 * (from + to), 0.5 * (to - from));
            let (x, y) = (corner.0 + middle * way.0, corner.1 + middle * way.1);
            let spread = [reach * f64::abs(way.0), reach * f64::abs(way.1)];
            let sign = |form, label: u8| at(form, x, y, spread).map(|v| if v > 0.0 { label } else { label + 2 });
            match sign(first, 0).or_else(|| sign(second, 1)) {
                Some(label) => labels.push(label),
                None if halvings == HALVINGS => return None,
                None => {
                    waiting.push((middle, to, halvings + 1));
                    waiting.push((from, middle, halvings + 1));
                }
            }
        }
    }
    turns(&labels)
}

/// How often two values turn about 0, anticlockwise, from the half planes in which they lie one after the other: 0 where the first is positive, 1 where the
/// second is, 2 and 3 where they are negative. Neighbours share a point.
pub(crate) fn turns(labels: &[u8]) -> Option<i32> {
    let mut quarters = 0;
    for (k, label) in labels.iter().enumerate() {
        let next = labels[(k + 1) % labels.len()];
        // The shared point lies in both half planes: they are the same or adjacent.
        match (4 + next - label) % 4 {
            0 => {}
            1 => quarters += 1,
            3 => quarters -= 1,
            _ => return None,
        }
    }
    Some(quarters / 4)
}
