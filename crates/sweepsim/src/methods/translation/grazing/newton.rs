//! One point of a grazing curve by Newton's method, and what it decides.

use super::chart::{Region, Witness, solved};
use super::knot::{Knot, KnownLine};
use super::lines::{Over, meets};
use sweepsim_dexel::Source;

/// The most steps of Newton's method, which takes two to four.
const STEPS: usize = 32;
/// As in `charts/`: if a point can only be in a part of the chart no larger than this (besides rounding), Newton's result decides whether it is there.
const ON_FACE: f64 = 1e-11;
/// The last step to a point between which and others the curve is interpolated.
const POLISHED: f64 = 1e-8;

/// What became of a line.
enum Verdict {
    Settled,
    Unsure,
}

impl<S: Fn(f64) -> Source> Over<'_, '_, '_, S> {
    /// The point of the curve, if it has one in the chart, and the line that is there. `latest`: where that was evaluated last.
    pub fn solve(
        &mut self,
        (p, line): (f64, Option<(f64, u32)>),
        ends: [&KnownLine; 2],
        polished: bool,
        latest: &mut Option<Witness>,
    ) -> Option<Knot> {
        let chart = self.chart;
        let length = self.lines.motion.length;
        let mut within = chart.region(&self.centre, [p, 0.0], &Region::WHOLE);
        // Where the curve has left the chart, the points that were looked at there tell.
        for witness in ends.into_iter().filter_map(|end| end.witness.as_ref()) {
            within = chart.region(witness, [p, 0.0], &within);
        }
        if within.is_empty() {
            return None;
        }
        let knots = ends.map(|end| end.knot.as_ref());
        let nearest = match knots {
            [Some(a), Some(b)] if (b.p - p).abs() < (a.p - p).abs() => Some(b),
            [a, b] => a.or(b),
        };
        let error = self.lines.motion.floor.error();
        if let (Some(knot), Some((q, _))) = (nearest, line) {
            let (lo, hi) = chart.q(&knot.witness, &within);
            // A knot is of use to other lines.
            if !polished && !meets((lo - error, hi + error), q, length) {
                return None;
            }
            // So near that it needs no other point.
            let next = knot.along(p);
            let from = [next[0] - knot.witness.at[0], next[1] - knot.witness.at[1]];
            if self.is_close(from, next) && chart.owns(next) && within.is_inside() {
                let verdict = self.decide(line, &knot.witness, next, knot.place_at(p), knot.normal, p);
                if let Verdict::Settled = verdict {
                    return Some(*knot);
                }
            }
        }
        let mut s = match (knots, nearest) {
            ([Some(a), Some(b)], _) if a.p < b.p => Knot::position(a, b, p),
            (_, Some(knot)) => knot.along(p),
            _ => chart.prediction(&self.centre, [p, 0.0]).0,
        };
        for _ in 0..STEPS {
            s = within.clamp(s);
            let (sight, here) = self.lines.sight(chart, s);
            *latest = Some(here);
            let scaled = |row: [f64; 2]| [row[0] * chart.half[0], row[1] * chart.half[1]];
            let [in_u, in_v] = sight.slopes;
            let jacobian = [scaled([in_u[1], in_v[1]]), scaled([sight.g[1], sight.g[2]])];
            let step = solved(&jacobian, [p - here.value[0], -here.value[1]]);
            if let Some(step) = step {
                let next = [s[0] + step[0], s[1] + step[1]];
                let long = step[0].abs().max(step[1].abs());
                if self.is_close(step, next) && chart.owns(next) && (!polished || long <= POLISHED) {
                    let along = |k: usize, d: [f64; 2]| in_u[k] * chart.half[0] * d[0] + in_v[k] * chart.half[1] * d[1];
                    let place = [0, 2].map(|k| sight.place[k] + along(k, step));
                    if let Verdict::Settled = self.decide(line, &here, next, place, sight.normal, p) {
                        let rate = solved(&jacobian, [1.0, 0.0])?;
                        return Some(Knot {
                            witness: here,
                            p,
                            at: next,
                            rate,
                            place,
                            slope: [along(0, rate), along(2, rate)],
                            normal: sight.normal,
                        });
                    }
                    if long <= ON_FACE {
                        self.leave(line, &here, &within);
                        return None;
                    }
                }
            }
            let own = chart.variable_rounding();
            let least = own.map(|own| ON_FACE + 4.0 * own);
            // The point was in that region already: where the map is almost linear, one look from far away leaves as little.
            let is_least = within.is_within(least);
            within = chart.region(&here, [p, 0.0], &within);
            if within.is_empty() {
                return None;
            }
            if is_least {
                // As close as rounding allows.
                if let Some(step) = step {
                    let next = [s[0] + step[0], s[1] + step[1]];
                    let rests = (0..2).all(|i| step[i].abs() <= self.accept[1].max(2.0 * own[i]));
                    if chart.owns(next) {
                        let place = [0, 2].map(|k| sight.place[k]);
                        if let Verdict::Settled = self.decide(line, &here, next, place, sight.normal, p) {
                            return None;
                        }
                    } else if rests {
                        return None;
                    }
                }
                self.leave(line, &here, &within);
                return None;
            }
            s = step.map_or_else(
                || chart.prediction(&here, [p, 0.0]).0,
                |step| [s[0] + step[0], s[1] + step[1]],
            );
        }
        if let Some(latest) = latest {
            self.leave(line, latest, &within);
        }
        None
    }

    /// Leaves a line open, unless no point of the region meets it on its way, as seen from a witness.
    fn leave(&mut self, line: Option<(f64, u32)>, witness: &Witness, within: &Region) {
        let Some((q, line)) = line else { return };
        let error = self.lines.motion.floor.error();
        let (lo, hi) = self.chart.q(witness, within);
        if meets((lo - error, hi + error), q, self.lines.motion.length) {
            self.lines.collector.open(line as usize);
        }
    }

    /// Whether a step is a last one.
    fn is_close(&self, step: [f64; 2], next: [f64; 2]) -> bool {
        self.chart.is_close(step, next, self.accept)
    }

    /// Puts a crossing if the line, if any, is met at the place `(q, z)` of the curve, reached from a witness. Unsure if the witness is too far away to tell.
    fn decide(
        &mut self,
        line: Option<(f64, u32)>,
        witness: &Witness,
        next: [f64; 2],
        place: [f64; 2],
        normal: [f64; 3],
        p: f64,
    ) -> Verdict {
        let Some((q, line)) = line else {
            return Verdict::Settled;
        };
        let (predicted, reach) = self.chart.prediction(witness, [p, 0.0]);
        let off = [0, 1].map(|i: usize| (predicted[i] - next[i]).abs() + reach[i]);
        let error = self.chart.change(off) + self.lines.motion.floor.error();
        let ahead = q - place[0];
        let length = self.lines.motion.length;
        if ahead < -error || ahead > length + error {
            return Verdict::Settled;
        }
        // NaN is unsure.
        if !(ahead > error && ahead < length - error) {
            return Verdict::Unsure;
        }
        self.put(line, ahead, place[1], normal);
        Verdict::Settled
    }
}
