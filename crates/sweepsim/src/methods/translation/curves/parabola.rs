//! The squared distance of a grazing curve from a line beside the tool, where it is a quadratic function of `p`.

/// `s = base − 2 σ R p + bow p²`, with `σ R p` given as a signed number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parabola {
    pub base: f64,
    /// At least 0.
    pub bow: f64,
    /// The least value of `s`, where `bow` is not 0: it would be lost in the difference of the other two.
    pub least: f64,
    /// `R`.
    pub radius: f64,
}

impl Parabola {
    /// `σp` where `s` is least.
    pub fn turn(&self) -> Option<f64> {
        (self.bow > 0.0).then(|| self.radius / self.bow)
    }

    /// `σp` at a value of `s`, before the turn or beyond it, and whether that is so near to the turn that it is as accurate as a coordinate if `√s` is.
    pub fn invert(&self, s: f64, beyond: bool) -> (f64, bool) {
        let Self {
            base,
            bow,
            least,
            radius,
        } = *self;
        if bow == 0.0 {
            return (0.5 * (base - s) / radius, false);
        }
        // R² − bow (base − s)
        let root = (bow * (s - least)).max(0.0).sqrt();
        if root < 0.5 * radius {
            let root = if beyond { root } else { -root };
            ((radius + root) / bow, true)
        } else if beyond {
            ((radius + root) / bow, false)
        } else {
            ((base - s) / (radius + root), false)
        }
    }
}
