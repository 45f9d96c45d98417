//! A ball along an arc in a plane along the dexels: two circles in the section of each line.

use super::{ArcPlace, Directions, Rolling};
use crate::cutter::outline::Ball;
use sweepsim_dexel::Source;

/// The products of two ranges.
fn products(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    all.into_iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| {
            [low.min(c), high.max(c)]
        })
}

pub(super) fn ball<S: Fn(f64) -> Source>(rolling: &mut Rolling<S>, ball: &Ball) {
    let (arc, [aq, ap, az]) = (rolling.arc, rolling.axis);
    let [ux, uy] = arc.ahead;
    let (q, p) = (ball.centre * aq, ball.centre * ap);
    let [x, y, z] = arc.centre;
    // Where the ball's centre is when the tip is at that of the arc.
    let middle = [x + ux * q - uy * p, y + uy * q + ux * p, z + ball.centre * az];
    let (r, big) = (arc.radius, ball.radius);
    let [cosines, sines] = rolling.directions;
    for side in [1.0, -1.0] {
        let radii = if side > 0.0 { [r, r + big] } else { [r - big, r] };
        // Of an upright tool, `ν sin α` is the height: it may be on the other half all the time.
        if aq == 0.0 && ap == 0.0 {
            let along = products(sines.map(|sine| side * az * sine), [0.0, big]);
            let margin = 8.0 * rolling.slack;
            if along[1] < ball.ends[0] - margin || along[0] > ball.ends[1] + margin {
                continue;
            }
        }
        let ranges = [[-big, big], products(radii, cosines)];
        rolling.each(middle, ranges, |own, place, line| {
            circle(own, ball, (middle[2], side), place, line)
        });
    }
}

/// The circle of radius `r + side ρ` in the section of a line.
#[inline]
fn circle<S: Fn(f64) -> Source>(
    rolling: &mut Rolling<S>,
    ball: &Ball,
    (level, side): (f64, f64),
    (i, j): (usize, usize),
    [q, p]: [f64; 2],
) {
    let (slack, r, big) = (rolling.slack, rolling.arc.radius, ball.radius);
    let half_chord_sq = (big - p) * (big + p);
    let line = rolling.lines.lines.line(i, j);
    // Coordinates that are off by `slack` change it by this much.
    let doubt = 8.0 * slack * (big + slack);
    if half_chord_sq < -doubt {
        return;
    }
    if !(half_chord_sq > 64.0 * doubt) {
        // Both circles are almost that of the centre.
        let wide = (66.0 * doubt).sqrt() + slack;
        let range = products([r - wide, r + wide], rolling.directions[0]);
        if q > range[0] - 2.0 * slack && q < range[1] + 2.0 * slack {
            rolling.lines.open(line);
        }
        return;
    }
    let rho = half_chord_sq.sqrt();
    let (nu, off) = (side * rho, 2.0 * slack * (1.0 + p.abs() / rho));
    let s = r + nu;
    if !(s.abs() > 16.0 * off) {
        // About a point.
        if q.abs() <= 32.0 * off {
            rolling.lines.open(line);
        }
        return;
    }
    let cosine = q / s;
    let error = (2.0 * slack + cosine.abs() * off) / s.abs();
    let (sine, error) = match rolling.directions(cosine, error) {
        Directions::None | Directions::Level(false) => return,
        Directions::Level(true) => {
            rolling.lines.open(line);
            return;
        }
        Directions::Pair(sine, error) => (sine, error),
    };
    let [aq, ap, az] = rolling.axis;
    for sine in [sine, -sine] {
        let place = rolling.place([cosine, sine], error);
        if matches!(place, ArcPlace::Outside) {
            continue;
        }
        let normal = [nu * cosine, p, nu * sine];
        let along = normal[0] * aq + normal[1] * ap + normal[2] * az;
        let doubt = off + rho * error + 2.0 * slack;
        let [low, high] = ball.ends;
        if along < low - doubt || along > high + doubt {
            continue;
        }
        match place {
            ArcPlace::Inside(share) if along > low + doubt && along < high - doubt => {
                let jump = if (normal[2] > 0.0) == (s > 0.0) { -1 } else { 1 };
                let source = (rolling.source)(share);
                let normal = rolling.in_space(normal);
                rolling.lines.crossing(line, level + s * sine, jump, normal, source);
            }
            _ => {
                rolling.lines.open(line);
                return;
            }
        }
    }
}
