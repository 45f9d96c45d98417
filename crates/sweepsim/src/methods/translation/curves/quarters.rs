//! The grazing curve of a leaning torus, cut into stretches over which `p` is monotone: see [`oblique`](super::oblique).

use super::oblique::Oblique;
use super::{Heading, dot};
use std::f64::consts::FRAC_PI_2;

/// Ways less steep than this against the plane across the axis, but not in it, are left to the general method: angles have no more digits.
const FLATTEST: f64 = 1e-14;
/// Below this `κ`, small `δ` are replaced by `ψ`.
const SMALL: f64 = 0.1;
/// Below this `a`, a move is rather along the axis.
const STEEP: f64 = 0.7;
/// Curves whose ends rounding blurs by more than this many of its errors are left to the general method.
const BLURRED: f64 = 1e6;

/// A cut of a quarter: `δ`, how far rounding may have moved it, and whether `p` is extreme there.
type Cut = (f64, f64, bool);

/// The stretches of an arc about `centre` between two ascending angles, which is traversed in the direction of `out`.
/// `None` if rounding would blur them.
pub(crate) fn stretches(
    heading: &Heading,
    centre: [f64; 2],
    radius: f64,
    angles: [f64; 2],
    out: f64,
) -> Option<Vec<Oblique>> {
    let [a, kappa] = [heading.across / heading.speed, heading.along / heading.speed];
    if kappa != 0.0 && kappa.abs() < FLATTEST * a {
        return None;
    }
    let mut stretches = Vec::new();
    // Quarters of the meridian's circle.
    let first = (angles[0] / FRAC_PI_2).floor();
    let mut number = first;
    while number * FRAC_PI_2 < angles[1] {
        let quarter = [number, number + 1.0].map(|n| n * FRAC_PI_2);
        let range = [angles[0].max(quarter[0]), angles[1].min(quarter[1])];
        let turn = (number as i64).rem_euclid(4);
        let (sigma, g) = (
            if turn == 0 || turn == 3 { 1.0 } else { -1.0 },
            if turn < 2 { 1.0 } else { -1.0 },
        );
        // |e| and |f| at both ends; 0 and 1 are exact.
        let mut ends = [0, 1].map(|k| {
            let exact = if (turn + k as i64) % 2 == 0 {
                [1.0, 0.0]
            } else {
                [0.0, 1.0]
            };
            if range[k] == quarter[k] {
                exact
            } else {
                [range[k].cos().abs(), range[k].sin().abs()]
            }
        });
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        number += 1.0;
        if !(range[1] > range[0]) {
            continue;
        }
        for side in [1.0, -1.0] {
            let whole = Oblique::quarter(heading, [centre[1], radius, sigma * centre[0]], [g, side], out);
            whole.parts(heading, ends, sigma, &mut stretches)?;
        }
    }
    Some(stretches)
}

impl Oblique {
    /// A quarter of the circle, without its ends.
    fn quarter(heading: &Heading, [height, radius, offset]: [f64; 3], [g, side]: [f64; 2], out: f64) -> Self {
        let [a, kappa] = [heading.across / heading.speed, heading.along / heading.speed];
        let [e, f, axis] = &heading.axes;
        let back = if kappa < 0.0 { g } else { -g };
        Self {
            first: [0, 1, 2].map(|k| g * (a * axis[k] - kappa * e[k])),
            second: f.map(|c| side * c),
            ahead: e.map(|c| back * c),
            centre: axis.map(|c| height * c),
            way: heading.local_way().map(|c| c / heading.speed),
            slope: kappa.abs(),
            drift: kappa * g * a,
            radius,
            offset,
            turning: false,
            ends: [0.0; 2],
            extreme: [false; 2],
            span: [0.0; 2],
            margins: [0.0; 2],
            jump: 0,
            out,
        }
    }

    /// The parts between two normals of the meridian.
    fn parts(&self, heading: &Heading, ends: [[f64; 2]; 2], sigma: f64, out: &mut Vec<Self>) -> Option<()> {
        let kappa = self.slope;
        let a = heading.across / heading.speed;
        let size = self.radius + self.offset.abs();
        let rounding = 4.0 * f64::EPSILON + heading.slack / size;
        // δ where the normal of the meridian is (e, f): sin² δ = (e² − κ²)/a², cos δ = f/a, of which the latter is accurate for moves along the axis.
        let angle = |[e, f]: [f64; 2]| -> Cut {
            let exact = e == 0.0 || e == 1.0;
            let square = (e - kappa) * (e + kappa);
            let (sine, cosine, error) = if a < STEEP {
                let cosine = (f / a).min(1.0);
                let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
                (sine, cosine, rounding * e / (a * sine).max(f64::MIN_POSITIVE))
            } else {
                let (sine, cosine) = ((square.max(0.0).sqrt() / a).min(1.0), f / a);
                let slow = (sine * cosine * a * a).max(f64::MIN_POSITIVE);
                (sine, cosine, rounding * e / slow)
            };
            if exact || sine == 0.0 {
                return (sine.atan2(cosine), 0.0, false);
            }
            (sine.atan2(cosine), error.min((2.0 * rounding).sqrt() / a), false)
        };
        let [low, high] = ends.map(angle);
        let mut cuts = vec![low, high];
        let mut add = |cut: Cut| {
            if cut.0 > low.0 && cut.0 < high.0 {
                cuts.push(cut);
            }
        };
        // n along ± p.
        if self.first[1] * self.second[1] > 0.0 {
            add((self.second[1].abs().atan2(self.first[1].abs()), 0.0, true));
        }
        if self.offset < 0.0 {
            let cusp = (-self.offset * kappa * kappa / self.radius).cbrt();
            if cusp < 1.0 {
                add((angle([cusp, ((1.0 - cusp) * (1.0 + cusp)).sqrt()]).0, 0.0, true));
            }
        }
        let split = if kappa < SMALL { kappa.sqrt().atan() } else { 0.0 };
        add((split, 0.0, false));
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in cuts.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            if !(to.0 > from.0) {
                continue;
            }
            let turning = to.0 <= split;
            let part = Self { turning, ..*self };
            let middle = part.site(part.parameter(0.5 * (from.0 + to.0)));
            let rises = dot(&part.normal(&middle), &[0.0, 0.0, 1.0]);
            let bent = sigma * part.cubic(&middle);
            let mut ends = [from, to].map(|(delta, error, extreme)| {
                let s = part.parameter(delta);
                let site = part.site(s);
                let rate = (part.rate(&site)).abs();
                (
                    s,
                    part.place(&site)[1],
                    4.0 * heading.slack + 2.0 * rate * error,
                    extreme,
                )
            });
            if ends.iter().any(|end| !(end.2 < BLURRED * heading.slack)) {
                return None;
            }
            if ends[0].1 > ends[1].1 {
                ends.swap(0, 1);
            }
            out.push(Self {
                ends: ends.map(|end| end.0),
                span: ends.map(|end| end.1),
                margins: ends.map(|end| end.2),
                extreme: ends.map(|end| end.3),
                jump: if (rises > 0.0) == (bent > 0.0) { -1 } else { 1 },
                ..part
            });
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::translation::curves::{Graph, Local};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    /// A move along `way`, level ahead, of a tool with this axis.
    fn heading(way: [f64; 3], axis: Vector3<f64>) -> Heading {
        let d = Vector3::from(way);
        let length = way[0].hypot(way[1]);
        let ahead = [way[0] / length, way[1] / length];
        let along = d.dot(&axis);
        let across = d - axis * along;
        let e = across.normalize();
        let local =
            |v: Vector3<f64>| -> Local { [ahead[0] * v.x + ahead[1] * v.y, ahead[0] * v.y - ahead[1] * v.x, v.z] };
        Heading {
            tip: [0.0; 3],
            way,
            ahead,
            length,
            speed: d.norm(),
            axes: [local(e), local(axis.cross(&e)), local(axis)],
            across: across.norm(),
            along,
            upright: false,
            slack: 1e-14,
        }
    }

    proptest! {
        /// Points lie on the torus, where it is parallel to the way; `p` rises from one end to the other, and `q` is in its range.
        #[test]
        fn stretches_graze(
            way in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], lean in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
            centre in [-2.0..3.0_f64, -1.0..1.0], radius in 0.3..4.0_f64, start in -3.2..3.2_f64, sweep in 0.1..3.0_f64,
            flat in prop::option::of(-9..0i32)
        ) {
            let axis = Vector3::from(lean);
            prop_assume!(axis.norm() > 0.1 && way[0].hypot(way[1]) > 0.1);
            let axis = axis.normalize();
            // Some almost across the axis.
            let way = match flat {
                Some(exponent) => {
                    let d = Vector3::from(way);
                    (d - axis * d.dot(&axis) + axis * 10f64.powi(exponent)).into()
                }
                None => way,
            };
            prop_assume!(way[0].hypot(way[1]) > 0.1);
            let angles = [start, start + sweep];
            let heading = heading(way, axis);
            let Some(stretches) = stretches(&heading, centre, radius, angles, 1.0) else { return Ok(()) };
            let local = |k: usize| Vector3::from(heading.axes[k]);
            let direction = Vector3::from(heading.local_way()).normalize();
            for stretch in &stretches {
                let [low, high] = stretch.span();
                let reach = stretch.reach();
                let mut last = f64::NEG_INFINITY;
                for n in 0..=40 {
                    let share = f64::from(n) / 40.0;
                    let site = stretch.site(stretch.ends[0] + share * (stretch.ends[1] - stretch.ends[0]));
                    let (place, normal) = (Vector3::from(stretch.place(&site)), Vector3::from(stretch.normal(&site)));
                    prop_assert!((normal.norm() - 1.0).abs() < 1e-12 && normal.dot(&direction).abs() < 1e-12);
                    // From its circle of centres: radius and height there.
                    let tube = place - normal * radius;
                    let (height, radial) = (tube.dot(&local(2)), (tube.dot(&local(0))).hypot(tube.dot(&local(1))));
                    prop_assert!((height - centre[1]).abs() < 1e-9 && (radial - centre[0].abs()).abs() < 1e-9);
                    // The normal of the meridian is in the arc.
                    let outward = tube - local(2) * height;
                    if radial > 0.1 {
                        let e = normal.dot(&outward) / radial * centre[0].signum();
                        let angle = normal.dot(&local(2)).atan2(e);
                        let turned = angle - 2.0 * std::f64::consts::PI * ((angle - angles[0] + 1e-6) / (2.0 * std::f64::consts::PI)).floor();
                        prop_assert!(turned <= angles[1] + 1e-6, "{angle} {angles:?}");
                    }
                    prop_assert!(place[1] >= last - 1e-12 && place[1] >= low - 1e-12 && place[1] <= high + 1e-12, "{place} {last}");
                    prop_assert!(place[0] >= reach[0] - 1e-9 && place[0] <= reach[1] + 1e-9);
                    last = place[1];
                    // And back.
                    let point = stretch.at(place[1].clamp(low, high));
                    prop_assert!(point.certain);
                    prop_assert!((point.q - place[0]).abs() < 1e-9 * (1.0 + point.slope.abs()) + 1e-6, "{point:?} {place}");
                }
            }
        }
    }
}
