//! Derivatives of `X` and `Y` for an observer who turns about a line with the tool.
//!
//! If a tool turns about a line that touches it, the points of a cell beside the line move by as much as they are away from there, and `∂(X, Y)/∂t` is known only to
//! within the size of the cell, though a point that is on the line hardly moves. But let `C(t)` be the rotation in the plane of `X` and `Y` that takes the turn of the tool
//! about the dexels' direction since the time `t_c` back. `C (X − x, Y − y)` has the same zeros. With the angular velocity `ω`, the vector `a` from the tip to the point of the line `(x, y)` at the height `Z`, and
//! the rows `A_h` of `A` for `X` and `Y`, `A_z` for `Z`, its derivatives are
//!
//! ```text
//! ∂/∂u = C A_h F_u,        (C A_h)′ = C (ω_y, −ω_x) A_z,
//! ∂/∂t = C (ω × a + b′)_h:
//! ```
//!
//! the first does not change with time but for the tilt of the axis, and the second is the velocity of the tool at the line, on which the cell counts by its heights only.

use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::absent::{Range, arm};
use crate::envelope::enclosures::{Brick, ROUNDING, Size, interval, widened};
use crate::time::pieces::Times;
use nalgebra::Vector3;
use sweepsim_solve::{Enclosure, Sample};

/// Encloses the derivatives in `u`, `v` and `t` of both components of `C (X − x, Y − y)` over a [prepared](Cells::prepare) cell; `C` is the identity at the time `at`.
///
/// `None` if the direction of the tool's turn changes, or if it does not turn about the dexels' direction at all: `C` would be the identity.
pub(super) fn about_a_line(
    (element, cells): (&PatchForms, &Cells),
    (times, size): (&Times, &Size),
    (cell, piece): Brick,
    line: [f64; 2],
    at: f64,
) -> Option<[[Enclosure; 3]; 2]> {
    let (spin, pace) = times.spin(piece).filter(|(spin, _)| spin.z != 0.0)?;
    let (start, end) = times.bounds(piece);
    // The time since `at`, and with it the largest turn and the largest tilt.
    let span = f64::max(at - start, end - at) * pace.1;
    let (turn, tilt) = (span * spin.z.abs(), span * spin.x.hypot(spin.y));
    let axes = times.at(at).turn;
    let mut rows = [[Enclosure::hull(0.0, 0.0); 3]; 2];
    for axis in 0..2 {
        let magnitude = |(lo, hi): Range| f64::max(-lo, hi);
        let by = |rows: &[[f64; 3]]| cells.slope_products(element, cell, axis, rows);
        let length: f64 = [0, 1, 2].map(|k| magnitude(by(&[unit(k)]))).iter().sum();
        let error = tilt * magnitude(by(times.rows(piece, 2))) + ROUNDING * length;
        for (r, row) in rows.iter_mut().enumerate() {
            row[axis] = interval(widened(by(&[[0, 1, 2].map(|k| axes[(r, k)])]), error));
        }
    }
    let arm = arm(
        &cells.position(element, cell),
        (times, size),
        piece,
        line.map(|x| (x, x)),
    );
    let turned = |j: usize, k: usize| {
        // The component of `ω × a` along the third axis.
        let (lo, hi) = difference(times_range(spin[j], arm[k]), times_range(spin[k], arm[j]));
        let (a, b) = pace;
        let moved = (
            if lo < 0.0 { lo * b } else { lo * a },
            if hi > 0.0 { hi * b } else { hi * a },
        );
        let terms = [(j, k), (k, j)].map(|(j, k)| spin[j].abs() * arm[k].0.abs().max(arm[k].1.abs()));
        widened(moved, ROUNDING * b * (terms[0] + terms[1]))
    };
    let velocity = [turned(1, 2), turned(2, 0)];
    let velocity = [0, 1].map(|r| {
        let (slowest, fastest) = times.velocity(piece, r);
        (velocity[r].0 + slowest, velocity[r].1 + fastest)
    });
    let speed: f64 = velocity.iter().map(|(lo, hi)| f64::max(-lo, *hi)).sum();
    for (row, own) in rows.iter_mut().zip(velocity) {
        // `|C v − v| ≤ |turn| |v|`.
        row[2] = interval(widened(own, (turn + ROUNDING) * speed));
    }
    Some(rows)
}

/// Makes of `(X, Y)` and its derivatives at the time `t` those of `(x, y) + C (X − x, Y − y)`.
pub(super) fn turn_back<S>(sample: &mut Sample<3, S>, times: &Times, [t, at]: [f64; 2], line: &[f64; 3]) {
    let [now, then] = [t, at].map(|t| times.at(t));
    let turn = now.turn * then.turn.transpose();
    let Some(axis) = now.spin.try_normalize(0.0) else {
        return;
    };
    let sine = Vector3::new(
        turn[(2, 1)] - turn[(1, 2)],
        turn[(0, 2)] - turn[(2, 0)],
        turn[(1, 0)] - turn[(0, 1)],
    );
    let angle = sine.dot(&axis).atan2(turn.trace() - 1.0);
    let (s, c) = (-axis.z * angle).sin_cos();
    let back = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
    let [x, y] = [0, 1].map(|r| sample.value[r] - line[r]);
    let [of_x, of_y, _] = &mut sample.jacobian;
    of_x[2] += now.spin.z * y;
    of_y[2] -= now.spin.z * x;
    for (a, b) in of_x.iter_mut().zip(of_y) {
        [*a, *b] = back([*a, *b]);
    }
    let turned = back([x, y]);
    for r in 0..2 {
        sample.value[r] = line[r] + turned[r];
    }
}

fn unit(k: usize) -> [f64; 3] {
    let mut unit = [0.0; 3];
    unit[k] = 1.0;
    unit
}

fn times_range(factor: f64, (lo, hi): Range) -> Range {
    let (a, b) = (factor * lo, factor * hi);
    if a <= b { (a, b) } else { (b, a) }
}

fn difference(a: Range, b: Range) -> Range {
    (a.0 - b.1, a.1 - b.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::envelope::{AnyBox, PatchMap};
    use sweepsim_motion::{Law, Path, Pose, Tool};
    use sweepsim_props::*;
    use sweepsim_solve::ChartMap;

    const SIZE: Size = Size {
        spacing: [0.1; 2],
        system_rounding: 64.0 * f64::EPSILON * 10.0,
    };

    proptest! {
        /// At any point that is on the line, derivatives of the turned system are in their enclosures; anywhere, they are what differences of its values say.
        #[test]
        fn derivatives_of_the_turned_system(
            tips in [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0], axes in [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0], kind in 0..3_usize, patch in 0..8_usize,
            place in [0.0..1.0_f64, 0.0..1.0, 0.0..1.0], share in [0.0..1.0_f64, 0.0..1.0, 0.0..1.0], size in -8.0..0.0_f64, level in any::<bool>(),
        ) {
            let tool = [Tool::ball(2.0, 7.0), Tool::bull(2.0, 0.5, 7.0), Tool::flat(2.0, 7.0)][kind].clone().unwrap();
            let tilt = |x: f64| if level { 0.0 } else { x };
            let pose = |tip: &[f64], axis: &[f64]| Pose::new([tip[0], tip[1], tip[2]], [axis[0], 1.2, tilt(axis[1])]).unwrap();
            let poses = vec![pose(&tips[..3], &axes[..2]), pose(&tips[3..], &axes[2..])];
            let segment = Path::with_law(poses, Law::Slerp).unwrap().segments(0, 10.0, 1e-6).remove(0);
            let elements = PatchForms::all(&tool).0;
            let element = &elements[patch % elements.len()];
            let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
            let mut map = PatchMap::new(element, &mut cells, &mut times, SIZE);
            let width = 10_f64.powf(size);
            let bounds: [Enclosure; 3] = std::array::from_fn(|k| {
                let lower = (place[k] - share[k] * width).max(0.0);
                Enclosure::hull(lower, (lower + width).min(1.0).max(place[k]))
            });
            let cell = map.place(&bounds);
            let line = map.evaluate(&place).value;
            let middle = bounds.map(Enclosure::mid);
            let Some(all) = map.jacobian_about(&cell, &line, &middle) else { return Ok(()) };
            let own = map.evaluate_about(&place, &line, &middle);
            for (ranges, row) in all.iter().zip(&own.jacobian) {
                for k in 0..3 {
                    let (range, x) = (&ranges[k], row[k]);
                    // Derivatives over small cells are quotients of rounded differences.
                    let slack = 1e-12 * (1.0 + x.abs()) + 1e-14 / bounds[k].radius();
                    prop_assert!(range.lo() - slack <= x && x <= range.hi() + slack, "{k}: {range:?} {x}");
                }
            }
            // The line is another one here.
            let beside = [line[0] + 0.3, line[1] - 0.2, 0.0];
            let sample = map.evaluate_about(&place, &beside, &middle);
            prop_assert!(map.evaluate_about(&middle, &beside, &middle).value[..2].iter().zip(map.evaluate(&middle).value).all(|(a, b)| (a - b).abs() < 1e-12));
            const STEP: f64 = 1e-5;
            for k in 0..3 {
                let at = |by: f64| {
                    let mut x = place;
                    x[k] += by;
                    map.evaluate_about(&x, &beside, &middle).value
                };
                let (ahead, behind) = (at(STEP), at(-STEP));
                for r in 0..2 {
                    let slope = (ahead[r] - behind[r]) / (2.0 * STEP);
                    prop_assert!((slope - sample.jacobian[r][k]).abs() < 1e-5, "{r} {k}: {slope} {}", sample.jacobian[r][k]);
                }
            }
        }
    }
}
