//! The lines over a chart: one unknown, `p`, for all of them.

use super::chart::{Chart, Region, Witness};
use super::directed_motion::DirectedMotion;
use super::face::{Face, Sight};
use super::knot::{Knot, KnownLine, Quintic};
use super::span::{Graph, Known, Span, Spans, is_absent};
use crate::methods::harvest::Collector;
use sweepsim_dexel::Source;

/// The last step is never longer than this.
const LONGEST: f64 = 1e-3;
/// So many lines or fewer are solved one by one.
const FEW: usize = 8;
/// Over charts with as many lines the curve is divided into [spans](Span) first. Found by trial.
const MANY: usize = 100;
/// Into no more than about so many.
const SPANS: f64 = 1024.0;

/// A line, in the coordinates of the move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    p: f64,
    q: f64,
    line: u32,
}

/// The search of lines over charts.
pub(super) struct Lines<'a, 'b, S> {
    pub face: &'a Face<'a>,
    pub motion: &'a DirectedMotion,
    pub collector: &'a mut Collector<'b>,
    pub source: &'a S,
    /// Heights this close are the same.
    pub height_tolerance: f64,
    /// The longest last step of Newton's method, in parts of the patch.
    pub last: f64,
    pub evaluations: u64,
    pub targets: Vec<Target>,
}

/// The lines of one chart.
pub(super) struct Over<'a, 'b, 'c, S> {
    pub lines: &'c mut Lines<'a, 'b, S>,
    /// Those that are solved one by one, in the order of `p`.
    targets: Vec<Target>,
    pub chart: &'c Chart,
    pub centre: Witness,
    /// The longest last step, inside and near a side.
    pub accept: [f64; 2],
}

impl<S: Fn(f64) -> Source> Lines<'_, '_, S> {
    /// The ranges of `p` and `q` of the lines that a cell may meet on its way.
    pub fn reach(&self, [p, q]: [(f64, f64); 2]) -> [[f64; 2]; 2] {
        [[p.0, p.1], [q.0, q.1 + self.motion.length]]
    }

    /// Leaves the lines of a window open.
    pub fn leave(&mut self, window: [[f64; 2]; 2]) {
        let lines = self.collector.lines;
        self.motion
            .floor
            .each(lines, window, 0.0, |line, _| self.collector.open(line));
    }

    /// A point of a chart.
    pub fn sight(&mut self, chart: &Chart, at: [f64; 2]) -> (Sight, Witness) {
        let sight = self.face.at(chart.point(at));
        self.evaluations += 1;
        let witness = Witness {
            at,
            value: [sight.place[1], sight.g[0]],
            q: sight.place[0],
        };
        (sight, witness)
    }

    /// The lines over a chart.
    pub fn chart(&mut self, chart: &Chart, window: [[f64; 2]; 2]) {
        let (_, centre) = self.sight(chart, [0.0; 2]);
        let part = chart.half.map(|half| 2.0 * half).into_iter().fold(0.0, f64::max);
        // As in `charts/`: `R` bounds how much the derivatives change over the chart.
        let inside = self.last / (part * part.max(chart.norm())).sqrt();
        let mut over = Over {
            targets: std::mem::take(&mut self.targets),
            chart,
            centre,
            accept: [inside.min(LONGEST).max(self.last), self.last],
            lines: self,
        };
        over.window(window);
        let targets = over.targets;
        self.targets = targets;
    }
}

/// Whether a line may be met by points with these `q`.
pub(super) fn meets((lo, hi): (f64, f64), q: f64, length: f64) -> bool {
    // NaN may.
    !(q - lo < 0.0 || q - hi > length)
}

impl<S: Fn(f64) -> Source> Over<'_, '_, '_, S> {
    /// The lines of a window.
    fn window(&mut self, mut window: [[f64; 2]; 2]) {
        let (lines, floor) = (self.lines.collector.lines, &self.lines.motion.floor);
        self.targets.clear();
        let mut spans = None;
        if floor.are_many(lines, window, MANY) {
            let found = Spans::new(self.spans(window));
            let Some(reach) = found.reach() else { return };
            window[0] = reach;
            spans = Some(found);
        }
        floor.each(lines, window, 0.0, |line, [p, q]| {
            let line = line as u32;
            let target = Target { p, q, line };
            let span = spans.as_mut().and_then(|spans| spans.find(target.p));
            if span.is_some_and(|span| self.over(span, target)) {
                return;
            }
            let region = self.chart.region(&self.centre, [target.p, 0.0], &Region::WHOLE);
            if !region.is_empty() && meets(self.chart.q(&self.centre, &region), target.q, self.lines.motion.length) {
                self.targets.push(target);
            }
        });
        self.targets
            .sort_unstable_by(|a, b| a.p.total_cmp(&b.p).then(a.line.cmp(&b.line)));
        self.all();
    }

    /// The curve over a window of many lines.
    fn spans(&mut self, [p, [q_low, q_high]]: [[f64; 2]; 2]) -> Vec<Span> {
        let lines = self.lines.collector.lines;
        let density = lines.scale(0).1 * lines.scale(1).1 * (q_high - q_low);
        let least = f64::max(FEW as f64 / density, (p[1] - p[0]) / SPANS);
        let mut spans = Vec::new();
        self.divide(p, [&KnownLine::default(); 2], None, least, &mut spans);
        spans
    }

    /// Divides a range of `p` until the curve is smooth there, or not in the chart, or the part is `least`. `larger`: the polynomial over a part twice as large.
    fn divide(
        &mut self,
        [low, high]: [f64; 2],
        ends: [&KnownLine; 2],
        larger: Option<&Quintic>,
        least: f64,
        spans: &mut Vec<Span>,
    ) {
        let range = [low, high];
        if is_absent(self.chart, &self.centre, ends, range) {
            return spans.push(Span {
                range,
                known: Known::Absent,
            });
        }
        // Not a number is the least, too.
        if !(high - low > least) {
            let witnesses = ends.map(|end| end.witness);
            return spans.push(Span {
                range,
                known: Known::Witnesses(witnesses),
            });
        }
        let middle = 0.5 * (low + high);
        let found = self.seen(middle, None, ends, true);
        let mut through = None;
        if let [Some(a), Some(knot), Some(b)] = [ends[0].knot, found.knot, ends[1].knot] {
            through = Quintic::through(&a, &knot, &b);
            if let Some(own) = through.take_if(|_| larger.is_some_and(|larger| self.is_smooth(larger, &knot))) {
                let known = Known::Graph(Box::new(Graph::new(self.chart, [a, knot, b], own)));
                return spans.push(Span { range, known });
            }
        }
        self.divide([low, middle], [ends[0], &found], through.as_ref(), least, spans);
        self.divide([middle, high], [&found, ends[1]], through.as_ref(), least, spans);
    }

    /// Settles a line over a span, if all decisions are certain.
    fn over(&mut self, span: &Span, target: Target) -> bool {
        let Target { p, q, line } = target;
        let graph = match &span.known {
            Known::Absent => return true,
            Known::Witnesses(witnesses) => {
                let mut within = Region::WHOLE;
                for witness in witnesses.iter().flatten() {
                    within = self.chart.region(witness, [p, 0.0], &within);
                }
                return within.is_empty();
            }
            Known::Graph(graph) => graph,
        };
        let (knot, range) = graph.near(p);
        if let Some((lo, hi)) = range {
            let (length, margin) = (self.lines.motion.length, self.lines.motion.floor.error());
            if q - lo < -margin || q - hi > length + margin {
                return true;
            }
            if q - hi > margin && q - lo < length - margin {
                self.follow(&graph.curve, (p, q, line), knot.normal);
                return true;
            }
        }
        self.interpolated(target, knot, &graph.curve)
    }

    fn all(&mut self) {
        let Some(last) = self.targets.len().checked_sub(1) else {
            return;
        };
        let polished = last > FEW;
        let first = self.one(0, [&KnownLine::default(); 2], polished);
        if last > 0 {
            let end = self.one(last, [&first, &KnownLine::default()], polished);
            self.between([1, last], [&first, &end], None);
        }
    }

    /// The lines from one number to another, between two others. `larger`: the polynomial through the knots of both and another one.
    fn between(&mut self, [low, high]: [usize; 2], ends: [&KnownLine; 2], larger: Option<&Quintic>) {
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
                        let target = self.targets[n];
                        let nearest = match ends.map(|end| end.knot.as_ref()) {
                            [Some(a), Some(b)] if target.p - a.p < b.p - target.p => Some(a),
                            [a, b] => b.or(a),
                        };
                        if !nearest.is_some_and(|knot| self.interpolated(target, knot, own)) {
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
        let motion = self.lines.motion;
        let steepness = motion.rise.abs() / motion.length;
        let off = (z - found.place[1]).abs() + (1.0 + steepness) * (q - found.place[0]).abs();
        off <= LESS * self.lines.height_tolerance
    }

    /// Settles a line near a knot without an evaluation, if all decisions are certain.
    fn interpolated(&mut self, Target { p, q, line }: Target, nearest: &Knot, curve: &Quintic) -> bool {
        let region = self.chart.region(&nearest.witness, [p, 0.0], &Region::WHOLE);
        if region.is_empty() {
            return true;
        }
        let range = self.chart.q(&nearest.witness, &region);
        let motion = self.lines.motion;
        let margin = motion.floor.error();
        if !meets((range.0 - margin, range.1 + margin), q, motion.length) {
            return true;
        }
        let met = q - range.1 > margin && q - range.0 < motion.length - margin;
        if !(met && region.is_inside()) {
            return false;
        }
        self.follow(curve, (p, q, line), nearest.normal);
        true
    }

    /// Puts a crossing of a line that is met by a polynomial; `outside`: a normal nearby.
    fn follow(&mut self, curve: &Quintic, (p, q, line): (f64, f64, u32), outside: [f64; 3]) {
        let motion = self.lines.motion;
        let [[own, dq], [z, dz]] = curve.at(p);
        let [length, rise] = [motion.length, motion.rise];
        // Across the curve and the way.
        let normal = [-rise, rise * dq - length * dz, length];
        let is_outwards = (0..3).map(|k| normal[k] * outside[k]).sum::<f64>() >= 0.0;
        let normal = if is_outwards { normal } else { normal.map(|x| -x) };
        self.put(line, q - own, z, normal);
    }

    pub fn put(&mut self, line: u32, ahead: f64, z: f64, normal: [f64; 3]) {
        let motion = self.lines.motion;
        let share = (ahead / motion.length).clamp(0.0, 1.0);
        let z = motion.from + share * motion.rise + z;
        let normal = motion.floor.in_space(normal);
        let size = normal.iter().map(|c| c * c).sum::<f64>();
        let scale = if size > 0.0 { size.sqrt().recip() } else { 1.0 };
        let normal = normal.map(|c| (c * scale) as f32);
        let source = (self.lines.source)(motion.time(share));
        let jump = self.chart.jump;
        self.lines.collector.crossing(line as usize, z, jump, normal, source);
    }

    /// One line, between two others.
    fn one(&mut self, n: usize, ends: [&KnownLine; 2], polished: bool) -> KnownLine {
        let Target { p, q, line } = self.targets[n];
        self.seen(p, Some((q, line)), ends, polished)
    }

    /// The curve at `p` between two other places, and the line that is there.
    fn seen(&mut self, p: f64, line: Option<(f64, u32)>, ends: [&KnownLine; 2], polished: bool) -> KnownLine {
        let mut latest = None;
        let knot = self.solve((p, line), ends, polished, &mut latest);
        let witness = match &knot {
            Some(knot) => Some(knot.witness),
            None => latest.or_else(|| KnownLine::nearest(ends, p)),
        };
        KnownLine { witness, knot }
    }
}
