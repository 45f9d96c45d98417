//! Where a direction is on an arc, as far as that is certain.

/// Where a direction is on an arc.
#[derive(Clone, Copy, Debug)]
pub(super) enum ArcPlace<T = f64> {
    Outside,
    /// Too close to an end to tell.
    Near,
    /// With the share of the way, or whatever else is known there.
    Inside(T),
}

impl<T> ArcPlace<T> {
    /// The turn on an arc from its start to its end, as a complex number.
    pub fn end(angle: f64) -> [f64; 2] {
        let (sine, cosine) = angle.abs().sin_cos();
        [cosine, sine]
    }

    /// Of a turn from the start, as a complex number of any length, on an arc with this [`end`](Self::end). `error`: of
    /// the sine.
    #[inline]
    pub fn new(
        [cosine, sine]: [f64; 2],
        [end_cosine, end_sine]: [f64; 2],
        error: f64,
        inside: impl FnOnce() -> T,
    ) -> Self {
        // Seen from the end.
        let end = sine * end_cosine - cosine * end_sine;
        if sine < -error || end > error {
            Self::Outside
        } else if sine > error && end < -error {
            Self::Inside(inside())
        } else {
            Self::Near
        }
    }
}
