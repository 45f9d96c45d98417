//! The lines over a chart: one unknown, `p`, for all of them.

use super::super::Collector;
use super::super::rows::{Floor, Row, rows};
use super::chart::{Chart, Region, Witness, solved};
use super::course::Course;
use super::face::{Face, Sight};
use super::knot::{Knot, Quintic, Seen};
use sweepsim_dexel::Source;

/// The most steps of Newton's method, which takes two to four.
const STEPS: usize = 32;
/// As in `charts/`: if a point can only be in a part of the chart no larger than this (besides rounding), Newton's result decides whether it is there.
const ON_FACE: f64 = 1e-11;
/// This close to a side of the chart, Newton's method is as accurate as if the chart were all of the patch.
const NEAR_FACE: f64 = 1e-4;
/// The last step is never longer than this.
const LONGEST: f64 = 1e-3;
/// The last step to a point between which and others the curve is interpolated.
const POLISHED: f64 = 1e-8;
/// So many lines or fewer are solved one by one.
const FEW: usize = 8;

/// A line, in the coordinates of the move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    p: f64,
    q: f64,
    line: u32,
}

/// What became of a line.
enum Verdict {
    Settled,
    Unsure,
}

/// The search of lines over charts.
pub(super) struct Lines<'a, 'b, S> {
    pub face: &'a Face<'a>,
    pub course: &'a Course,
    pub collector: &'a mut Collector<'b>,
    pub source: &'a S,
    /// Heights this close are the same.
    pub near: f64,
    /// The longest last step of Newton's method, in parts of the patch.
    pub last: f64,
    pub evaluations: u64,
    pub targets: Vec<Target>,
}

/// The lines of one chart.
struct Over<'a, 'b, 'c, S> {
    lines: &'c mut Lines<'a, 'b, S>,
    targets: &'c [Target],
    chart: &'c Chart,
    centre: Witness,
    /// The longest last step, inside and near a side.
    accept: [f64; 2],
}

impl<S: Fn(f64) -> Source> Lines<'_, '_, S> {
    pub fn floor(&self) -> Floor {
        Floor {
            tip: self.course.from,
            ahead: self.course.ahead,
            slack: self.course.slack,
        }
    }

    /// The ranges of `p` and `q` of the lines that a cell may meet on its way.
    pub fn reach(&self, [p, q]: [(f64, f64); 2]) -> [[f64; 2]; 2] {
        [[p.0, p.1], [q.0, q.1 + self.course.length]]
    }

    /// Calls `visit` with the lines of a window.
    fn visit(&mut self, window: [[f64; 2]; 2], mut visit: impl FnMut(&mut Collector, Target)) {
        let floor = self.floor();
        let lattice = self.collector.lines;
        let [[p_low, p_high], [q_low, q_high]] = window;
        let [ux, uy] = floor.ahead;
        let collector = &mut *self.collector;
        rows(lattice, &floor, window, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - floor.tip[1];
                let (p, q) = (ux * y - uy * x, ux * x + uy * y);
                // NaN is inside.
                let outside = p < p_low || p > p_high || q < q_low || q > q_high;
                if !outside && lattice.asks(i, j) {
                    let line = lattice.line(i, j) as u32;
                    visit(collector, Target { p, q, line });
                }
            }
        });
    }

    /// Leaves the lines of a window open.
    pub fn leave(&mut self, window: [[f64; 2]; 2]) {
        self.visit(window, |collector, target| collector.open(target.line as usize));
    }

    /// The lines over a chart.
    pub fn chart(&mut self, chart: &Chart, window: [[f64; 2]; 2]) {
        let centre = self.face.at(chart.point([0.0; 2]));
        self.evaluations += 1;
        let centre = witness([0.0; 2], &centre);
        let length = self.course.length;
        let mut targets = std::mem::take(&mut self.targets);
        targets.clear();
        self.visit(window, |_, target| {
            let region = chart.region(&centre, [target.p, 0.0], &Region::WHOLE);
            if !region.is_empty() && meets(chart.q(&centre, &region), target.q, length) {
                targets.push(target);
            }
        });
        if !targets.is_empty() {
            targets.sort_unstable_by(|a, b| a.p.total_cmp(&b.p).then(a.line.cmp(&b.line)));
            let part = chart.half.map(|half| 2.0 * half).into_iter().fold(0.0, f64::max);
            // As in `charts/`: `R` bounds how much the derivatives change over the chart.
            let inside = self.last / (part * part.max(chart.norm())).sqrt();
            let mut over = Over {
                targets: &targets,
                chart,
                centre,
                accept: [inside.min(LONGEST).max(self.last), self.last],
                lines: self,
            };
            over.all();
        }
        self.targets = targets;
    }
}

fn witness(at: [f64; 2], sight: &Sight) -> Witness {
    Witness {
        at,
        value: [sight.place[1], sight.g[0]],
        q: sight.place[0],
    }
}

/// Whether a line may be met by points with these `q`.
fn meets((lo, hi): (f64, f64), q: f64, length: f64) -> bool {
    // NaN may.
    !(q - lo < 0.0 || q - hi > length)
}

impl<S: Fn(f64) -> Source> Over<'_, '_, '_, S> {
    fn all(&mut self) {
        let last = self.targets.len() - 1;
        let polished = last > FEW;
        let first = self.one(0, [&Seen::default(); 2], polished);
        if last > 0 {
            let end = self.one(last, [&first, &Seen::default()], polished);
            self.between([1, last], [&first, &end], None);
        }
    }

    /// The lines from one number to another, between two others. `larger`: the polynomial through the knots of both and another one.
    fn between(&mut self, [low, high]: [usize; 2], ends: [&Seen; 2], larger: Option<&Quintic>) {
        if low >= high {
            return;
        }
        let middle = usize::midpoint(low, high);
        let polished = high - low > FEW;
        let found = self.one(middle, ends, polished);
        let mut through = None;
        let parts = [
            ([low, middle], [ends[0], &found]),
            ([middle + 1, high], [&found, ends[1]]),
        ];
        if polished && let [Some(a), Some(knot), Some(b)] = [&ends[0].knot, &found.knot, &ends[1].knot] {
            through = Quintic::through(a, knot, b);
            if let (Some(larger), Some(own)) = (larger, &through)
                && self.is_smooth(larger, knot)
            {
                for ([low, high], ends) in parts {
                    for n in low..high {
                        if !self.interpolated(n, ends, own) {
                            self.one(n, ends, false);
                        }
                    }
                }
                return;
            }
        }
        for (numbers, ends) in parts {
            self.between(numbers, ends, through.as_ref());
        }
    }

    /// Whether the curve is close to a polynomial at a knot between two of its own: those through two of these three and this one are off by no more than a third of the difference,
    /// and by a sixtieth where the knots are at equal distances.
    fn is_smooth(&self, larger: &Quintic, found: &Knot) -> bool {
        const LESS: f64 = 12.0;
        let [[q, _], [z, _]] = larger.at(found.p);
        let course = self.lines.course;
        let steepness = course.way[2].abs() / course.length;
        let off = (z - found.place[1]).abs() + (1.0 + steepness) * (q - found.place[0]).abs();
        off <= LESS * self.lines.near
    }

    /// Settles a line between two knots without an evaluation, if all decisions are certain.
    fn interpolated(&mut self, n: usize, ends: [&Seen; 2], curve: &Quintic) -> bool {
        let Target { p, q, line } = self.targets[n];
        let [Some(a), Some(b)] = ends.map(|end| end.knot.as_ref()) else {
            return false;
        };
        let nearest = if p - a.p < b.p - p { a } else { b };
        let region = self.chart.region(&nearest.witness, [p, 0.0], &Region::WHOLE);
        if region.is_empty() {
            return true;
        }
        let range = self.chart.q(&nearest.witness, &region);
        let (course, margin) = (self.lines.course, 4.0 * self.lines.course.slack);
        if !meets((range.0 - margin, range.1 + margin), q, course.length) {
            return true;
        }
        let met = q - range.1 > margin && q - range.0 < course.length - margin;
        if !(met && region.is_inside()) {
            return false;
        }
        let [[own, dq], [z, dz]] = curve.at(p);
        let [length, rise] = [course.length, course.way[2]];
        // Across the curve and the way.
        let normal = [-rise, rise * dq - length * dz, length];
        let outwards = (0..3).map(|k| normal[k] * nearest.normal[k]).sum::<f64>() >= 0.0;
        let normal = if outwards { normal } else { normal.map(|x| -x) };
        self.put(line, q - own, z, normal);
        true
    }

    fn put(&mut self, line: u32, ahead: f64, z: f64, [q, p, up]: [f64; 3]) {
        let course = self.lines.course;
        let share = (ahead / course.length).clamp(0.0, 1.0);
        let z = course.from[2] + share * course.way[2] + z;
        let [x, y] = course.ahead;
        let normal = [x * q - y * p, y * q + x * p, up];
        let size = normal.iter().map(|c| c * c).sum::<f64>();
        let scale = if size > 0.0 { size.sqrt().recip() } else { 1.0 };
        let normal = normal.map(|c| (c * scale) as f32);
        let source = (self.lines.source)(course.time(share));
        let jump = self.chart.jump;
        self.lines.collector.crossing(line as usize, z, jump, normal, source);
    }

    /// One line, between two others.
    fn one(&mut self, n: usize, ends: [&Seen; 2], polished: bool) -> Seen {
        let mut latest = None;
        let knot = self.solve(n, ends, polished, &mut latest);
        let p = self.targets[n].p;
        let witness = match &knot {
            Some(knot) => Some(knot.witness),
            None => latest.or_else(|| Seen::nearest(ends, p)),
        };
        Seen { witness, knot }
    }

    /// One line; the point of the curve, if it has one in the chart. `latest`: where that was evaluated last.
    fn solve(&mut self, n: usize, ends: [&Seen; 2], polished: bool, latest: &mut Option<Witness>) -> Option<Knot> {
        let chart = self.chart;
        let Target { p, q, line } = self.targets[n];
        let length = self.lines.course.length;
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
        let slack = 4.0 * self.lines.course.slack;
        if let Some(knot) = nearest {
            let (lo, hi) = chart.q(&knot.witness, &within);
            // A knot is of use to other lines.
            if !polished && !meets((lo - slack, hi + slack), q, length) {
                return None;
            }
            // So near that it needs no other point.
            let next = knot.along(p);
            let from = [next[0] - knot.witness.at[0], next[1] - knot.witness.at[1]];
            if self.is_close(from, next) && chart.owns(next) && within.is_inside() {
                let verdict = self.decide((q, line), &knot.witness, next, knot.place_at(p), knot.normal, p);
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
            let sight = self.lines.face.at(chart.point(s));
            self.lines.evaluations += 1;
            let here = witness(s, &sight);
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
                    if let Verdict::Settled = self.decide((q, line), &here, next, place, sight.normal, p) {
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
                        self.lines.collector.open(line as usize);
                        return None;
                    }
                }
            }
            within = chart.region(&here, [p, 0.0], &within);
            if within.is_empty() {
                return None;
            }
            let own = chart.slack();
            if within.is_within(own.map(|own| ON_FACE + 4.0 * own)) {
                // As close as rounding allows.
                if let Some(step) = step {
                    let next = [s[0] + step[0], s[1] + step[1]];
                    let rests = (0..2).all(|i| step[i].abs() <= self.accept[1].max(2.0 * own[i]));
                    if chart.owns(next) {
                        let place = [0, 2].map(|k| sight.place[k]);
                        if let Verdict::Settled = self.decide((q, line), &here, next, place, sight.normal, p) {
                            return None;
                        }
                    } else if rests {
                        return None;
                    }
                }
                self.lines.collector.open(line as usize);
                return None;
            }
            s = step.map_or_else(
                || chart.prediction(&here, [p, 0.0]).0,
                |step| [s[0] + step[0], s[1] + step[1]],
            );
        }
        self.lines.collector.open(line as usize);
        None
    }

    /// Whether a step is a last one.
    fn is_close(&self, step: [f64; 2], next: [f64; 2]) -> bool {
        let near_face = next[0].abs().max(next[1].abs()) > 1.0 - NEAR_FACE;
        step[0].abs().max(step[1].abs()) <= self.accept[usize::from(near_face)]
    }

    /// Puts a crossing if the line is met at the place `(q, z)` of the curve, reached from a witness. Unsure if the witness is too far away to tell.
    fn decide(
        &mut self,
        (q, line): (f64, u32),
        witness: &Witness,
        next: [f64; 2],
        place: [f64; 2],
        normal: [f64; 3],
        p: f64,
    ) -> Verdict {
        let (predicted, reach) = self.chart.prediction(witness, [p, 0.0]);
        let off = [0, 1].map(|i: usize| (predicted[i] - next[i]).abs() + reach[i]);
        let error = self.chart.change(off) + 4.0 * self.lines.course.slack;
        let ahead = q - place[0];
        let length = self.lines.course.length;
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
