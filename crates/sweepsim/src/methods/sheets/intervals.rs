//! Arithmetic of ranges. Rounding is left to margins.

pub(crate) type Range = [f64; 2];

/// The smaller of two numbers, by one instruction: `f64::min` takes five for NaN. Here, NaN on one side may be dropped
/// as well.
#[inline]
fn low(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater of two numbers.
#[inline]
fn high(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline]
pub(crate) fn hull(a: f64, b: f64) -> Range {
    [low(a, b), high(a, b)]
}

#[inline]
pub(crate) fn add(a: Range, b: Range) -> Range {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline]
pub(crate) fn sub(a: Range, b: Range) -> Range {
    [a[0] - b[1], a[1] - b[0]]
}

#[inline]
pub(crate) fn mul(a: Range, b: Range) -> Range {
    let [p, q, r, s] = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    [low(low(p, q), low(r, s)), high(high(p, q), high(r, s))]
}

/// By a range without 0.
#[inline]
pub(crate) fn divided(a: Range, b: Range) -> Range {
    mul(a, [b[1].recip(), b[0].recip()])
}

#[inline]
pub(crate) fn scaled(factor: f64, a: Range) -> Range {
    hull(factor * a[0], factor * a[1])
}

#[inline]
pub(crate) fn square(a: Range) -> Range {
    let [least, most] = hull(a[0].abs(), a[1].abs());
    let least = if a[0] <= 0.0 && a[1] >= 0.0 { 0.0 } else { least };
    [least * least, most * most]
}

/// Of what is positive.
#[inline]
pub(crate) fn square_root(a: Range) -> Range {
    [high(a[0], 0.0).sqrt(), high(a[1], 0.0).sqrt()]
}

/// What two ranges share, if they do.
#[inline]
pub(crate) fn shared(a: Range, b: Range) -> Range {
    [high(a[0], b[0]), low(a[1], b[1])]
}

/// The smallest range that holds both, wider by a margin.
#[inline]
pub(crate) fn joined(a: Range, b: Range, margin: f64) -> Range {
    [low(a[0], b[0]) - margin, high(a[1], b[1]) + margin]
}

#[inline]
pub(crate) fn wider(a: Range, margin: f64) -> Range {
    [a[0] - margin, a[1] + margin]
}

/// What is certain of the sign of a function on a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sign {
    /// There is no point of the sheet.
    Absent,
    Positive,
    Negative,
    Unknown,
}

impl Sign {
    /// Of a range, beyond a doubt.
    #[inline]
    pub fn of(range: Range, doubt: f64) -> Self {
        if range[0] > doubt {
            Self::Positive
        } else if range[1] < -doubt {
            Self::Negative
        } else {
            Self::Unknown
        }
    }
}

/// The range of a function with these values at the ends of a span, that changes at most by this much over all of it.
#[inline]
pub(crate) fn between(a: f64, b: f64, change: f64) -> Range {
    let (middle, half) = (0.5 * (a + b), 0.5 * high(change, (a - b).abs()));
    [middle - half, middle + half]
}
