//! Ranges tighter than the hull of the coefficients, and where a zero may be.

use crate::bernstein::Bernstein;
use crate::rounding::{gamma, up};

impl Bernstein {
    /// A range that holds every value on `[0,1]ⁿ`, by subdivision: at most `splits` times the part with the lowest or
    /// the highest bound is halved, across the variable along which its coefficients vary most.
    ///
    /// Never wider than [`enclosure`](Self::enclosure); with growing `splits` it converges to the true range,
    /// quadratically in the size of the parts. Cost: one split each.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let bump = Bernstein::new(&[2], vec![0.0, 1.0, 0.0])?; // 2x(1−x), at most 1/2
    /// assert_eq!(bump.enclosure(), (0.0, 1.0));
    /// let (lo, hi) = bump.tight_enclosure(20);
    /// assert!(lo <= 0.0 && (0.5..0.501).contains(&hi));
    /// # Ok(()) }
    /// ```
    pub fn tight_enclosure(&self, splits: usize) -> (f64, f64) {
        let whole = self.enclosure();
        if !self.is_finite() || self.coefficients().len() == 1 {
            return whole;
        }
        let mut parts = vec![(whole, self.clone())];
        let worst = |parts: &[((f64, f64), Self)], high: bool| {
            let key = |i: &usize| if high { -parts[*i].0.1 } else { parts[*i].0.0 };
            (0..parts.len()).min_by(|a, b| key(a).total_cmp(&key(b))).unwrap_or(0)
        };
        for turn in 0..splits {
            let at = worst(&parts, turn % 2 == 0);
            let axis = parts[at].1.liveliest_axis();
            let mut left = Self::constant(0, 0.0);
            parts[at].1.split_into(axis, 0.5, &mut left);
            parts[at].0 = parts[at].1.enclosure();
            parts.push((left.enclosure(), left));
        }
        let lo = parts.iter().map(|p| p.0.0).fold(f64::INFINITY, f64::min);
        let hi = parts.iter().map(|p| p.0.1).fold(f64::NEG_INFINITY, f64::max);
        (lo.max(whole.0), hi.min(whole.1))
    }

    /// A range that holds every value on `[0,1]ⁿ`, from the coefficients with every degree above 0 elevated by `by`.
    ///
    /// Converges as `1/by`, so subdivision is better except for small `by`.
    pub fn elevated_enclosure(&self, by: usize) -> (f64, f64) {
        let (lo, hi) = self.enclosure();
        let degrees: Vec<usize> = self
            .degrees()
            .iter()
            .map(|&d| if d == 0 { 0 } else { d.saturating_add(by) })
            .collect();
        let (low, high) = self.elevated_to(&degrees).enclosure();
        (lo.max(low), hi.min(high))
    }

    /// The variable along which neighbouring coefficients differ most; 0 for a constant.
    pub fn liveliest_axis(&self) -> usize {
        let mut best = (0, -1.0);
        for (axis, &degree) in self.degrees().iter().enumerate() {
            if degree == 0 {
                continue;
            }
            let view = crate::kernel::along(self.degrees().iter().map(|d| d + 1), axis, 1);
            let mut most: f64 = 0.0;
            for block in self.coefficients().chunks_exact(view.inner * view.len) {
                let pairs = block.iter().zip(&block[view.inner..]);
                most = pairs.fold(most, |m, (a, b)| m.max((b - a).abs()));
            }
            let variation = most * degree as f64;
            if variation > best.1 {
                best = (axis, variation);
            }
        }
        best.0
    }

    /// An interval of `x_axis` outside which the form has no zero on `[0,1]ⁿ`; `None` if it has none at all.
    ///
    /// The convex hull of the points `(i/d, c)`, `c` running over the coefficients with index `i` in that variable, cut
    /// with the axis (Sherbrooke and Patrikalakis: projected polyhedra); rounded outwards.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = Bernstein::new(&[2], vec![-1.0, 0.0, 3.0])?;
    /// let (lo, hi) = f.zero_interval(0).ok_or("there is one")?;
    /// assert!(0.24 < lo && lo <= 0.4142 && 0.4142 <= hi && hi < 0.51);
    /// assert_eq!(Bernstein::new(&[1], vec![1.0, 2.0])?.zero_interval(0), None);
    /// # Ok(()) }
    /// ```
    pub fn zero_interval(&self, axis: usize) -> Option<(f64, f64)> {
        if self.excludes_zero() {
            return None;
        }
        let degree = self.degree(axis);
        if degree == 0 || !self.is_finite() {
            return Some((0.0, 1.0));
        }
        let view = crate::kernel::along(self.degrees().iter().map(|d| d + 1), axis, 1);
        let mut hull = vec![(f64::INFINITY, f64::NEG_INFINITY); degree + 1];
        for block in self.coefficients().chunks_exact(view.inner * view.len) {
            for (slice, (lo, hi)) in block.chunks_exact(view.inner).zip(&mut hull) {
                for &c in slice {
                    *lo = lo.min(c);
                    *hi = hi.max(c);
                }
            }
        }
        if self.error() > 0.0 {
            for (lo, hi) in &mut hull {
                *lo = (*lo - self.error()).next_down();
                *hi = (*hi + self.error()).next_up();
            }
        }
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        let at = |i: usize| i as f64 / degree as f64;
        // The hull meets the axis where segments do that join a point on or below it with one on or above.
        let points: Vec<(f64, f64)> = (0..=degree)
            .flat_map(|i| [(at(i), hull[i].0), (at(i), hull[i].1)])
            .collect();
        for &(x, lo) in points.iter().filter(|p| p.1 <= 0.0) {
            for &(y, hi) in points.iter().filter(|p| p.1 >= 0.0) {
                let height = hi - lo;
                let crossings = if height == 0.0 {
                    [x, y]
                } else if height.is_finite() {
                    // Neither term is negative: five roundings, relative.
                    [x * (hi / height) + y * (-lo / height); 2]
                } else {
                    [x, y]
                };
                for crossing in crossings {
                    from = from.min(crossing);
                    to = to.max(crossing);
                }
            }
        }
        if from > to {
            return None;
        }
        let slack = gamma(8);
        Some((
            (from * (1.0 - slack) - f64::MIN_POSITIVE).max(0.0),
            up(to * (1.0 + slack)).min(1.0),
        ))
    }
}
