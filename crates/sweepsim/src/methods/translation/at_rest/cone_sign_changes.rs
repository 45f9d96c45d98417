//! Where on a cone the sign of `g` is not the same before and after a placement: between a few azimuths.

use super::leaning::AtRestSide;
use std::f64::consts::PI;

/// Wedges are wider than they need to be by this angle on both sides.
const MARGIN: f64 = 1e-6;
/// Of a cosine: nearer to 1 than this, it does not determine an angle well, and wedges are as wide as [`BLUR`].
const STEEP: f64 = 1e-6;
const BLUR: f64 = 2e-3;

/// A range of azimuths: its middle, and half of its width.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wedge {
    middle: f64,
    half: f64,
    /// Of the middle.
    cosine: f64,
    sine: f64,
    /// Cosine of the half.
    least: f64,
}

impl Wedge {
    fn new(low: f64, high: f64) -> Self {
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).min(PI));
        let (sine, cosine) = middle.sin_cos();
        Self {
            middle,
            half,
            cosine,
            sine,
            least: half.cos(),
        }
    }

    /// Whether it has an azimuth.
    pub fn holds(&self, cosine: f64, sine: f64) -> bool {
        self.half >= PI || cosine * self.cosine + sine * self.sine >= self.least
    }

    /// The range of the sine of the azimuth less an angle.
    fn sines(&self, angle: f64) -> [f64; 2] {
        let [low, high] = [self.middle - self.half, self.middle + self.half].map(|end| end - angle);
        let ends = [low.sin(), high.sin()];
        let passes = |place: f64| ((low - place) / (2.0 * PI)).ceil() <= ((high - place) / (2.0 * PI)).floor();
        [
            if passes(-0.5 * PI) { -1.0 } else { ends[0].min(ends[1]) },
            if passes(0.5 * PI) { 1.0 } else { ends[0].max(ends[1]) },
        ]
    }

    /// The range of `b`, for radii in a range.
    pub fn across(&self, [inner, outer]: [f64; 2]) -> [f64; 2] {
        let [low, high] = self.sines(0.0);
        [(inner * low).min(outer * low), (inner * high).max(outer * high)]
    }

    /// The range of `q = s ζ − k a` along a line of the meridian, given `s` and `k`.
    pub fn along(&self, ends: [[f64; 2]; 2], [s, k]: [f64; 2]) -> [f64; 2] {
        let cosines = self.sines(-0.5 * PI);
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for [radius, height] in ends {
            for cosine in cosines {
                let q = s * height - k * radius * cosine;
                range = [range[0].min(q), range[1].max(q)];
            }
        }
        range
    }
}

/// The azimuths at which the sign of `g` on a line of the meridian changes, or may change.
pub(super) fn wedges(normal: [f64; 2], sides: &[AtRestSide; 2]) -> Vec<Wedge> {
    wedges_between([normal; 2], sides)
}

/// The same on an arc of the meridian between two normals, which are on one side of the axis and not along it.
pub(super) fn wedges_between(normals: [[f64; 2]; 2], sides: &[AtRestSide; 2]) -> Vec<Wedge> {
    let [[n, m], last] = normals;
    let mut borders: Vec<f64> = Vec::with_capacity(10);
    let mut ranges: Vec<[f64; 2]> = Vec::with_capacity(12);
    for side in sides {
        let AtRestSide::Along([da, db, dc]) = *side else {
            continue;
        };
        // g = size cos(φ − towards) + offset
        let ratios = normals.map(|[n, m]| {
            let (size, offset) = (n.abs() * da.hypot(db), m * dc);
            if size > 0.0 {
                -offset / size
            } else {
                -offset.signum() * f64::INFINITY
            }
        });
        if ratios.iter().all(|ratio| *ratio > 1.0 + STEEP) || ratios.iter().all(|ratio| *ratio < -1.0 - STEEP) {
            continue;
        }
        let towards = (n * db).atan2(n * da);
        let opens = ratios.map(|ratio| ratio.clamp(-1.0, 1.0).acos());
        for open in opens {
            borders.extend([towards - open, towards + open]);
        }
        if normals[0] != last {
            // On either side of the direction, the border is somewhere between.
            let [near, far] = [opens[0].min(opens[1]) - MARGIN, opens[0].max(opens[1]) + MARGIN];
            ranges.extend([[towards + near, towards + far], [towards - far, towards - near]]);
        }
        for ratio in ratios {
            if ratio.abs() > 1.0 - STEEP {
                let middle = if ratio > 0.0 { towards } else { towards + PI };
                ranges.push([middle - BLUR, middle + BLUR]);
            }
        }
    }
    let negative = |angle: f64| {
        let [before, after] = [0, 1].map(|k| match sides[k] {
            AtRestSide::Beyond(negative) => negative,
            AtRestSide::Along([da, db, dc]) => n * (da * angle.cos() + db * angle.sin()) + m * dc < 0.0,
        });
        before != after
    };
    if borders.is_empty() {
        return if negative(0.0) {
            vec![Wedge::new(-PI, PI)]
        } else {
            Vec::new()
        };
    }
    let turned = |angle: f64| angle - 2.0 * PI * (angle / (2.0 * PI)).floor();
    for border in &mut borders {
        *border = turned(*border);
    }
    borders.sort_by(f64::total_cmp);
    borders.push(borders[0] + 2.0 * PI);
    for pair in borders.windows(2) {
        if pair[1] > pair[0] && negative(0.5 * (pair[0] + pair[1])) {
            ranges.push([pair[0] - MARGIN, pair[1] + MARGIN]);
        }
    }
    // Each begins in the first turn; those that overlap are one.
    for range in &mut ranges {
        let first = turned(range[0]);
        *range = [first, first + range[1] - range[0]];
    }
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::with_capacity(ranges.len());
    for range in ranges {
        match joined.last_mut() {
            Some(last) if range[0] <= last[1] => last[1] = last[1].max(range[1]),
            _ => joined.push(range),
        }
    }
    // The last may reach into the first.
    while let [first, .., last] = joined[..]
        && last[1] - 2.0 * PI >= first[0]
    {
        joined.remove(0);
        let end = joined.len() - 1;
        joined[end][1] = last[1].max(first[1] + 2.0 * PI);
    }
    if joined.iter().any(|[low, high]| high - low >= 2.0 * PI - MARGIN) {
        return vec![Wedge::new(-PI, PI)];
    }
    joined.into_iter().map(|[low, high]| Wedge::new(low, high)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::test_runner::TestCaseResult;
    use sweepsim_props::*;

    fn side() -> impl Strategy<Value = AtRestSide> {
        let moving = ([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], -12..1i32);
        prop_oneof![
            4 => moving.prop_map(|([a, b, c], size)| {
                let size = 10f64.powi(size);
                AtRestSide::Along([a * size, b * size, c])
            }),
            1 => any::<bool>().prop_map(AtRestSide::Beyond),
        ]
    }

    /// At most one wedge holds an azimuth, and one does where the signs differ.
    fn check(wedges: &[Wedge], [n, m]: [f64; 2], sides: &[AtRestSide; 2], azimuth: f64) -> TestCaseResult {
        let (sine, cosine) = azimuth.sin_cos();
        let negative = sides.map(|side| match side {
            AtRestSide::Beyond(negative) => negative,
            AtRestSide::Along([a, b, c]) => n * (a * cosine + b * sine) + m * c < 0.0,
        });
        let held = wedges.iter().filter(|wedge| wedge.holds(cosine, sine)).count();
        prop_assert!(held <= 1, "{wedges:?} {azimuth}");
        prop_assert!(held == 1 || negative[0] == negative[1], "{wedges:?} {azimuth}");
        Ok(())
    }

    proptest! {
        /// Azimuths at which the signs differ are in one wedge, others in one at most.
        #[test]
        fn wedges_hold_all_changes(angle in 0.0..2.0 * PI, sides in [side(), side()], near in any::<bool>(), off in -1e-7..1e-7_f64) {
            let (m, n) = f64::sin_cos(angle);
            let wedges = wedges([n, m], &sides);
            // Some where one of the signs changes.
            let border = match sides[0] {
                AtRestSide::Along([a, b, c]) if near => {
                    let ratio = -m * c / (n.abs() * a.hypot(b));
                    Some((n * b).atan2(n * a) + ratio.clamp(-1.0, 1.0).acos() + off)
                }
                _ => None,
            };
            for azimuth in (0..200).map(|k| 0.0314 * f64::from(k)).chain(border) {
                check(&wedges, [n, m], &sides, azimuth)?;
            }
            // Points on a circle are where the ranges say.
            for wedge in &wedges {
                for share in [-1.0, -0.3, 0.0, 0.6, 1.0] {
                    let (sine, cosine) = (wedge.middle + share * wedge.half).sin_cos();
                    let ([low, high], [back, front]) =
                        (wedge.across([1.0, 2.0]), wedge.along([[1.0, 0.0], [2.0, 3.0]], [0.6, 0.8]));
                    for [radius, height] in [[1.0, 0.0], [2.0, 3.0]] {
                        let (b, q) = (radius * sine, 0.6 * height - 0.8 * radius * cosine);
                        prop_assert!(b >= low - 1e-9 && b <= high + 1e-9 && q >= back - 1e-9 && q <= front + 1e-9);
                    }
                }
            }
        }

        /// The same between two normals.
        #[test]
        fn wedges_of_an_arc_hold_all_changes(ends in [-1.55..1.55_f64, -1.55..1.55], inner in any::<bool>(), share in 0.0..1.0_f64, sides in [side(), side()]) {
            let out = if inner { -1.0 } else { 1.0 };
            let normal = |angle: f64| [out * angle.cos(), angle.sin()];
            let wedges = wedges_between(ends.map(normal), &sides);
            let [n, m] = normal(ends[0] + share * (ends[1] - ends[0]));
            for azimuth in (0..200).map(|k| 0.0314 * f64::from(k)) {
                check(&wedges, [n, m], &sides, azimuth)?;
            }
        }
    }
}
