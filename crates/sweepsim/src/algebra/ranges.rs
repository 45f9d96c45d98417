//! Ranges of forms over boxes: minima and maxima of sums of products of control rows and control points.
//!
//! Points are processed four at a time, which compilers vectorise.

use smallvec::SmallVec;

const LANES: usize = 4;

/// Sums of products of a few numbers are accurate to within this fraction of the sum of their absolute values.
pub(crate) const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A vector-valued list of coefficients, with x, y and z stored separately.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triples<'a> {
    pub x: &'a [f64],
    pub y: &'a [f64],
    pub z: &'a [f64],
}

impl<'a> Triples<'a> {
    #[inline]
    pub fn new(list: &'a [f64], start: usize, len: usize) -> Self {
        let (x, rest) = list[start..start + 3 * len].split_at(len);
        let (y, z) = rest.split_at(len);
        Self { x, y, z }
    }

    /// `⟨a, cᵢ⟩`.
    #[inline]
    pub fn dot(&self, a: &[f64; 3], i: usize) -> f64 {
        a[0] * self.x[i] + a[1] * self.y[i] + a[2] * self.z[i]
    }

    #[inline]
    pub fn len(&self) -> usize {
        self.x.len()
    }
}

/// The minimum and maximum of the numbers seen, ignoring NaN: see [`all_or_none`].
struct Band {
    lo: [f64; LANES],
    hi: [f64; LANES],
}

impl Band {
    fn new() -> Self {
        Self {
            lo: [f64::INFINITY; LANES],
            hi: [f64::NEG_INFINITY; LANES],
        }
    }

    #[inline(always)]
    fn take(&mut self, values: &[f64; LANES]) {
        for k in 0..LANES {
            self.lo[k] = if values[k] < self.lo[k] { values[k] } else { self.lo[k] };
            self.hi[k] = if values[k] > self.hi[k] { values[k] } else { self.hi[k] };
        }
    }

    fn take_one(&mut self, value: f64) {
        self.lo[0] = if value < self.lo[0] { value } else { self.lo[0] };
        self.hi[0] = if value > self.hi[0] { value } else { self.hi[0] };
    }

    fn range(&self) -> (f64, f64) {
        let lo = self.lo.iter().fold(f64::INFINITY, |a, b| if *b < a { *b } else { a });
        let hi = self
            .hi
            .iter()
            .fold(f64::NEG_INFINITY, |a, b| if *b > a { *b } else { a });
        if lo <= hi { (lo, hi) } else { UNKNOWN }
    }
}

/// The range of an unknown quantity: it excludes no box.
const UNKNOWN: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// Sets all numbers of a list to NaN if one of them is not finite.
///
/// [`Band`] ignores NaN, which costs nothing in the inner loop. A list that is finite or NaN throughout has its true range, or [`UNKNOWN`]; one
/// with a single NaN would have too small a range, and solutions would be lost.
pub(crate) fn all_or_none(list: &mut [f64]) {
    // The sum of zeros, or NaN.
    let mut sums = [0.0; LANES];
    let (fours, rest) = list.as_chunks::<LANES>();
    for four in fours {
        for k in 0..LANES {
            sums[k] += 0.0 * four[k];
        }
    }
    let sum = rest.iter().map(|x| 0.0 * x).sum::<f64>() + sums.iter().sum::<f64>();
    if sum.is_nan() {
        list.fill(f64::NAN);
    }
}

/// The range of some numbers, [`UNKNOWN`] if one of them is NaN.
pub(crate) fn range_of(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        if value.is_nan() {
            return UNKNOWN;
        }
        (lo, hi) = (lo.min(value), hi.max(value));
    }
    if lo <= hi { (lo, hi) } else { UNKNOWN }
}

/// Four points, component by component.
type Four<'a> = [&'a [f64; LANES]; 3];

impl<'a> Triples<'a> {
    /// The points in groups of four; the last group may repeat some. None of fewer than four.
    #[inline(always)]
    fn fours(&self) -> impl Iterator<Item = Four<'a>> {
        let (x, rest) = self.x.as_chunks::<LANES>();
        let (y, z) = (self.y.as_chunks::<LANES>().0, self.z.as_chunks::<LANES>().0);
        let last = if rest.is_empty() { None } else { self.last() };
        x.iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).chain(last)
    }

    #[inline(always)]
    fn last(&self) -> Option<Four<'a>> {
        Some([self.x.last_chunk()?, self.y.last_chunk()?, self.z.last_chunk()?])
    }

    /// The points, if there are fewer than four.
    fn few(&self) -> std::ops::Range<usize> {
        0..if self.len() < LANES { self.len() } else { 0 }
    }
}

#[inline(always)]
fn dots(row: &[f64; 3], [x, y, z]: Four) -> [f64; LANES] {
    std::array::from_fn(|k| row[0] * x[k] + row[1] * y[k] + row[2] * z[k])
}

#[inline(always)]
fn sum(a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Range of `⟨row, point⟩` over all rows and points.
pub(crate) fn products(rows: &[[f64; 3]], points: &Triples) -> (f64, f64) {
    if let [row] = rows {
        return products_of_one(row, points);
    }
    // The loop over three rows, those of an arc, is unrolled.
    match <&[[f64; 3]; 3]>::try_from(rows) {
        Ok(three) => products_of(three, points),
        Err(_) => products_of(rows, points),
    }
}

/// Of a tool that does not turn.
fn products_of_one(row: &[f64; 3], points: &Triples) -> (f64, f64) {
    let mut band = Band::new();
    let (x, rest) = points.x.as_chunks::<LANES>();
    let (y, z) = (points.y.as_chunks::<LANES>().0, points.z.as_chunks::<LANES>().0);
    for ((x, y), z) in x.iter().zip(y).zip(z) {
        band.take(&dots(row, [x, y, z]));
    }
    if !rest.is_empty()
        && let Some(last) = points.last()
    {
        band.take(&dots(row, last));
    }
    for i in points.few() {
        band.take_one(points.dot(row, i));
    }
    band.range()
}

#[inline(always)]
fn products_of<'r>(rows: impl IntoIterator<Item = &'r [f64; 3]> + Copy, points: &Triples) -> (f64, f64) {
    let mut band = Band::new();
    for four in points.fours() {
        for row in rows {
            band.take(&dots(row, four));
        }
    }
    for i in points.few() {
        for row in rows {
            band.take_one(points.dot(row, i));
        }
    }
    band.range()
}

/// Range of `⟨row, point⟩ + offset` over all rows with their offsets, and all points.
pub(crate) fn shifted_products(rows: &[[f64; 3]], offsets: &[f64], points: &Triples) -> (f64, f64) {
    let mut band = Band::new();
    for four in points.fours() {
        for (row, offset) in rows.iter().zip(offsets) {
            band.take(&dots(row, four).map(|x| x + offset));
        }
    }
    for i in points.few() {
        for (row, offset) in rows.iter().zip(offsets) {
            band.take_one(points.dot(row, i) + offset);
        }
    }
    band.range()
}

/// Range of `⟨spin, Mᵢ⟩ + ⟨row, Nᵢ⟩` over all pairs of a spin and a row and all coefficients; a single spin is paired with all rows.
pub(crate) fn envelope(spins: &[[f64; 3]], rows: &[[f64; 3]], fields: &[Triples; 2]) -> (f64, f64) {
    let [constant] = spins else {
        let [n, m] = fields;
        let mut band = Band::new();
        for (of_n, of_m) in n.fours().zip(m.fours()) {
            for (spin, row) in spins.iter().zip(rows) {
                band.take(&sum(dots(spin, of_m), dots(row, of_n)));
            }
        }
        for i in n.few() {
            for (spin, row) in spins.iter().zip(rows) {
                band.take_one(m.dot(spin, i) + n.dot(row, i));
            }
        }
        return band.range();
    };
    match <&[[f64; 3]; 3]>::try_from(rows) {
        Ok(three) => envelope_of(constant, three, fields),
        Err(_) => envelope_of(constant, rows, fields),
    }
}

#[inline(always)]
fn envelope_of<'r>(
    spin: &[f64; 3],
    rows: impl IntoIterator<Item = &'r [f64; 3]> + Copy,
    [n, m]: &[Triples; 2],
) -> (f64, f64) {
    let mut band = Band::new();
    for (of_n, of_m) in n.fours().zip(m.fours()) {
        let fixed = dots(spin, of_m);
        for row in rows {
            band.take(&sum(fixed, dots(row, of_n)));
        }
    }
    for i in n.few() {
        let fixed = m.dot(spin, i);
        for row in rows {
            band.take_one(fixed + n.dot(row, i));
        }
    }
    band.range()
}

/// `⟨spin, Mᵢ⟩ + ⟨row, Nᵢ⟩` for all coefficients, for one pair of a spin and a row after the other; a single spin is paired with all rows.
pub(crate) fn envelope_coefficients(
    spins: &[[f64; 3]],
    rows: &[[f64; 3]],
    [n, m]: &[Triples; 2],
) -> SmallVec<[f64; 32]> {
    let all = rows.iter().zip(spins.iter().cycle());
    all.flat_map(|(row, spin)| (0..n.len()).map(|i| m.dot(spin, i) + n.dot(row, i)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    #[test]
    fn what_is_not_a_number_is_unknown() {
        for len in 1..14 {
            for bad in 0..3 * len {
                let mut list: Vec<f64> = (0..3 * len).map(|k| k as f64).collect();
                list[bad] = f64::NAN;
                all_or_none(&mut list);
                let points = Triples::new(&list, 0, len);
                let row = [[1.0, 2.0, 3.0]];
                assert_eq!(products(&row, &points), UNKNOWN);
                assert_eq!(shifted_products(&row, &[1.0], &points), UNKNOWN);
                assert_eq!(envelope(&row, &row, &[points, points]), UNKNOWN);
                assert_eq!(range_of(list), UNKNOWN);
            }
        }
        let mut finite = [1.0, 2.0, 3.0, 4.0, 5.0];
        all_or_none(&mut finite);
        assert_eq!(finite, [1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(range_of([1.0, f64::NAN, 3.0]), UNKNOWN);
    }

    proptest! {
        /// Points in fours and the rest: the range is that of all, one by one.
        #[test]
        fn ranges_are_those_of_all_points(
            points in collection::vec((-9.0..9.0, -9.0..9.0, -9.0..9.0), 1..14),
            rows in collection::vec((-9.0..9.0, -9.0..9.0, -9.0..9.0), 1..4),
        ) {
            let triple = |p: &(f64, f64, f64)| [p.0, p.1, p.2];
            let list = |k: usize| points.iter().map(|p| triple(p)[k]).collect::<Vec<f64>>();
            let (x, y, z) = (list(0), list(1), list(2));
            let triples = Triples { x: &x, y: &y, z: &z };
            let rows: Vec<[f64; 3]> = rows.iter().map(triple).collect();
            let offsets: Vec<f64> = (0..rows.len()).map(|k| k as f64).collect();
            let range = |value: &dyn Fn(usize, usize) -> f64| {
                let all = (0..rows.len()).flat_map(|r| (0..points.len()).map(move |i| (r, i)));
                let values: Vec<f64> = all.map(|(r, i)| value(r, i)).collect();
                (values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
            };
            prop_assert_eq!(products(&rows, &triples), range(&|r, i| triples.dot(&rows[r], i)));
            prop_assert_eq!(shifted_products(&rows, &offsets, &triples), range(&|r, i| triples.dot(&rows[r], i) + offsets[r]));
            let both = [triples, triples];
            prop_assert_eq!(envelope(&rows, &rows, &both), range(&|r, i| {
                // One spin goes with all rows, here the same one row.
                triples.dot(&rows[r], i) + triples.dot(&rows[r], i)
            }));
            let one = [rows[0]];
            prop_assert_eq!(envelope(&one, &rows, &both), range(&|r, i| triples.dot(&rows[0], i) + triples.dot(&rows[r], i)));
        }
    }
}
