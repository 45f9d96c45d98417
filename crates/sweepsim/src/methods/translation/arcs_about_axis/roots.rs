//! The zeros of a convex or concave function: no more than two, told from its values and slopes at both ends.

/// A minimum is looked for by so many tangents at most, and a zero by so many steps.
const STEPS: usize = 60;

/// What is left to the general method.
pub(super) struct Open;

/// A function on an interval.
pub(super) struct Arch<F> {
    /// Value and slope.
    pub function: F,
    pub ends: [f64; 2],
    /// Whether it is convex, otherwise it is concave.
    pub convex: bool,
    /// By how much values may be off: at both ends, and between them.
    pub doubt: [f64; 3],
    /// Zeros may be off by this: they are to be improved.
    pub enough: f64,
}

#[derive(Clone, Copy)]
struct ArchPoint {
    x: f64,
    value: f64,
    slope: f64,
}

impl<F: Fn(f64) -> [f64; 2]> Arch<F> {
    /// As of a convex function.
    fn at(&self, x: f64) -> ArchPoint {
        let [value, slope] = (self.function)(x);
        let sign = if self.convex { 1.0 } else { -1.0 };
        ArchPoint {
            x,
            value: sign * value,
            slope: sign * slope,
        }
    }

    /// All zeros, about.
    pub fn zeros(&self, mut found: impl FnMut(f64) -> Result<(), Open>) -> Result<(), Open> {
        if !(self.ends[0] < self.ends[1]) {
            return Ok(());
        }
        let [mut a, mut b] = self.ends.map(|x| self.at(x));
        // NaN is in doubt.
        if !(a.value.abs() > self.doubt[0] && b.value.abs() > self.doubt[1]) {
            return Err(Open);
        }
        match (a.value > 0.0, b.value > 0.0) {
            (false, false) => return Ok(()),
            (true, false) => return found(self.zero(a, b)),
            (false, true) => return found(self.zero(b, a)),
            (true, true) => {}
        }
        for _ in 0..STEPS {
            if a.slope >= 0.0 || b.slope <= 0.0 {
                return Ok(());
            }
            // Above both tangents.
            let crossing = (b.value - a.value + a.slope * a.x - b.slope * b.x) / (a.slope - b.slope);
            if a.value + a.slope * (crossing - a.x) > self.doubt[2] {
                return Ok(());
            }
            let x = if crossing > a.x && crossing < b.x {
                crossing
            } else {
                0.5 * (a.x + b.x)
            };
            let middle = self.at(x);
            if middle.value < -self.doubt[2] {
                found(self.zero(a, middle))?;
                return found(self.zero(b, middle));
            }
            if !(middle.value > self.doubt[2]) {
                return Err(Open);
            }
            if middle.slope < 0.0 { a = middle } else { b = middle }
        }
        Err(Open)
    }

    /// The zero between a point where the function is positive and one where it is negative.
    fn zero(&self, mut above: ArchPoint, mut below: ArchPoint) -> f64 {
        let mut x = below.x + (above.x - below.x) * (below.value / (below.value - above.value));
        for _ in 0..STEPS {
            let at = self.at(x);
            let step = at.value / at.slope;
            if step.abs() <= self.enough {
                return x - step;
            }
            if at.value > 0.0 {
                above = at
            } else {
                below = at
            }
            let [low, high] = [above.x.min(below.x), above.x.max(below.x)];
            let next = x - step;
            // NaN is in the middle.
            x = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
        }
        x
    }
}
