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
    /// Of a turn from the start, as a complex number of any length, on an arc by a positive angle. `error`: of the sine.
    #[inline]
    pub fn new([cosine, sine]: [f64; 2], angle: f64, error: f64, inside: impl FnOnce() -> T) -> Self {
        // Seen from the end.
        let (end_sine, end_cosine) = angle.sin_cos();
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

impl ArcPlace {
    /// The same, with the share of the way.
    #[inline]
    pub fn share([cosine, sine]: [f64; 2], angle: f64, error: f64) -> Self {
        Self::new([cosine, sine], angle, error, || sine.atan2(cosine) / angle)
    }
}
