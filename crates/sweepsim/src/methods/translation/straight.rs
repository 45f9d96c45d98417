//! The lines over the strips that grazing curves and edges sweep.

mod lanes;

use super::curves::{Graph, Heading, ring, slant, torus};
use super::rows::{Floor, Row, rows};
use crate::cutter::outline::{Outline, Piece, Rim, Shape};
use crate::methods::harvest::Collector;
use crate::methods::sheets::numbers;
use lanes::{LANES, Lanes};
use sweepsim_dexel::{Crossing, Source};

/// A strip narrower than this many margins is not searched: its lines are open.
const NARROW: f64 = 16.0;
/// The most parts of a span that are searched one by one.
const PARTS: f64 = 16.0;
/// A part is about as long as the way, or this many lines.
const LINES: f64 = 6.0;

/// A sweep of the grazing curves and edges of a tool along one move. `source` gives the source at a time.
pub(crate) fn sweep_straight(
    outline: &Outline,
    heading: &Heading,
    (lines, highest): (&mut Collector, f64),
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) {
    let mut strip = Strip {
        heading,
        spacing: lines.lines.spacing(),
        lines,
        source,
        highest,
        lanes: Lanes::default(),
    };
    outline.settle(&mut strip, Strip::piece, Strip::rim, done);
}

/// The search along one move.
struct Strip<'a, 'b, S> {
    heading: &'a Heading,
    lines: &'a mut Collector<'b>,
    source: S,
    spacing: f64,
    /// What is this high above the tip is above the ceiling at all times.
    highest: f64,
    lanes: Lanes,
}

/// What part of a strip is searched.
struct StripPart {
    /// The range of `p`, with the ends of the span a little wider, and a little narrower.
    wide: [f64; 2],
    sure: [f64; 2],
    /// The range of `p` over the whole span.
    span: [f64; 2],
    /// How far `q` may be off next to the ends of the span.
    blurs: [f64; 2],
    /// The jump of all its points, if it is known.
    jump: Option<i8>,
    /// The error of the way to a line; `None` if each point has to tell.
    error: Option<f64>,
}

fn floor(heading: &Heading) -> Floor {
    Floor {
        tip: heading.tip,
        ahead: heading.ahead,
        rounding: heading.slack,
    }
}

impl<S: Fn(f64) -> Source> Strip<'_, '_, S> {
    /// `None` if there is no closed form.
    fn piece(&mut self, piece: &Piece) -> Option<()> {
        let heading = self.heading;
        let poles = [piece.from[0] == 0.0, piece.to[0] == 0.0];
        if piece.heights()[0] > self.highest {
            return Some(());
        }
        match piece.shape {
            Shape::Line { normal } => {
                let graphs = slant::slants(heading, piece.below(self.highest), normal)?;
                self.all(&graphs);
            }
            Shape::Arc {
                centre,
                radius,
                angles,
                out,
            } => {
                if centre[0] == 0.0 {
                    let poles = if out > 0.0 { poles } else { [poles[1], poles[0]] };
                    let graphs = ring::ball(heading, [centre[1], radius], angles, poles, out)?;
                    self.all(&graphs);
                } else if heading.upright {
                    let graphs = torus::stretches(heading, centre, radius, angles, out)?;
                    self.all(&graphs);
                } else {
                    // By the grazing curves of its patches.
                    return None;
                }
            }
        }
        Some(())
    }

    fn rim(&mut self, rim: &Rim) -> Option<()> {
        if rim.height > self.highest {
            return Some(());
        }
        let graphs = ring::rim(self.heading, rim)?;
        self.all(&graphs);
        Some(())
    }

    fn all<G: Graph>(&mut self, graphs: &[G]) {
        for graph in graphs {
            self.graph(graph);
        }
    }

    fn graph<G: Graph>(&mut self, graph: &G) {
        let [low, high] = graph.span();
        let margins = graph.margins();
        let [back, front] = graph.reach();
        if !(high - low > NARROW * (margins[0] + margins[1])) {
            self.sliver([low - margins[0], high + margins[1]], [back, front]);
            return;
        }
        let length = self.heading.length.max(LINES * self.spacing);
        let count = ((front - back) / length).ceil().clamp(1.0, PARTS);
        let mut a = low;
        for n in 1..=count as usize {
            let b = if n == count as usize {
                high
            } else {
                graph.part(n as f64 / count)
            };
            self.part(graph, [a, b]);
            a = b;
        }
    }

    /// The lines with `p` in one part of the span.
    fn part<G: Graph>(&mut self, graph: &G, [a, b]: [f64; 2]) {
        if graph.jump([a, b]) == Some(0) {
            return;
        }
        let [low, high] = graph.span();
        let margins = graph.margins();
        let heading = self.heading;
        let [back, front] = graph.between([a, b]);
        // At the ends of the span, `p` may belong to it or not.
        let (below, above) = (a == low, b == high);
        let wide = [
            if below { a - margins[0] } else { a },
            if above { b + margins[1] } else { b },
        ];
        let sure = [
            if below { a + margins[0] } else { a },
            if above { b - margins[1] } else { b },
        ];
        // How far q may be off in the margins.
        let blur = |end: f64, inner: f64| 2.0 * (graph.at(end).q - graph.at(inner).q).abs() + 4.0 * heading.slack;
        let blurs = [blur(low, low + 2.0 * margins[0]), blur(high, high - 2.0 * margins[1])];
        let blur = if below { blurs[0] } else { 0.0 }.max(if above { blurs[1] } else { 0.0 });
        let reach = [
            back - blur - heading.slack,
            front + blur + heading.slack + heading.length,
        ];
        let jump = graph.jump(sure);
        let part = StripPart {
            wide,
            sure,
            span: [low, high],
            blurs,
            jump,
            error: jump.and_then(|_| {
                let steepest = graph.steepest(sure)?;
                Some(heading.slack * (2.0 + steepest))
            }),
        };
        let (lattice, floor) = (self.lines.lines, floor(heading));
        let Some([lowest, highest]) = numbers(lattice, 1, floor.extent(1, [wide, reach])) else {
            return;
        };
        // Of all columns.
        let y: Vec<f64> = (lowest..=highest)
            .map(|j| lattice.coordinate(1, j) - heading.tip[1])
            .collect();
        let [ux, uy] = heading.ahead;
        rows(lattice, &floor, [wide, reach], |Row { i, j, x }| {
            let (p_base, q_base) = (-uy * x, ux * x);
            let place = |y: f64| [p_base + ux * y, q_base + uy * y];
            let (mut next, end) = (j[0].max(lowest), (j[1] + 1).min(highest + 1));
            while next < end {
                let line = lattice.line(i, next) as u32;
                next += self.lanes.add(line, &y[next - lowest..end - lowest], place);
                if self.lanes.count == LANES {
                    self.settle(graph, &part);
                }
            }
        });
        self.settle(graph, &part);
    }

    /// The lines that have been added.
    fn settle<G: Graph>(&mut self, graph: &G, part: &StripPart) {
        let heading = self.heading;
        let StripPart { wide, sure, .. } = part;
        let count = std::mem::take(&mut self.lanes.count);
        let (Some(error), Some(jump)) = (part.error, part.jump) else {
            for k in 0..count {
                let [p, q] = [self.lanes.p[k], self.lanes.q[k]];
                if p >= wide[0] && p < wide[1] {
                    self.one(graph, part, self.lanes.line[k], [p, q]);
                }
            }
            return;
        };
        let lanes = &mut self.lanes;
        let (p, q, ahead, met) = (
            &lanes.p[..count],
            &lanes.q[..count],
            &mut lanes.ahead[..count],
            &mut lanes.met[..count],
        );
        graph.many_q(p, ahead, &mut lanes.own[..count]);
        let doubt = error.max(part.blurs[0]).max(part.blurs[1]);
        let (end, near, far) = (heading.length - error, -doubt, heading.length + doubt);
        let mut doubtful = 0;
        for (((p, q), ahead), met) in p.iter().zip(q).zip(&mut *ahead).zip(met) {
            *ahead = q - *ahead;
            *met = (*ahead > error) & (*ahead < end) & (*p >= sure[0]) & (*p < sure[1]);
            // NaN is close.
            let close = !(*ahead <= near) & !(*ahead >= far) & (*p >= wide[0]) & (*p < wide[1]);
            doubtful += usize::from(close & !*met);
        }
        if doubtful > 0 {
            for k in 0..count {
                let (ahead, [p, q]) = (self.lanes.ahead[k], [self.lanes.p[k], self.lanes.q[k]]);
                let close = !(ahead <= near || ahead >= far) && p >= wide[0] && p < wide[1];
                if close && !self.lanes.met[k] {
                    self.one(graph, part, self.lanes.line[k], [p, q]);
                }
            }
        }
        if jump == 0 {
            return;
        }
        let lattice = self.lines.lines;
        if !lattice.asks_for_all() {
            for k in 0..count {
                self.lanes.met[k] &= lattice.asks_for(self.lanes.line[k]);
            }
        }
        self.met(graph, jump, count);
    }

    /// The crossings of those lines that the strip meets, with this jump.
    fn met<G: Graph>(&mut self, graph: &G, jump: i8, count: usize) {
        let heading = self.heading;
        let lanes = &mut self.lanes;
        let mut met = 0;
        for k in 0..count {
            // Written always, kept if it is met.
            (lanes.line[met], lanes.p[met]) = (lanes.line[k], lanes.p[k]);
            (lanes.ahead[met], lanes.own[met]) = (lanes.ahead[k], lanes.own[k]);
            met += usize::from(lanes.met[k]);
        }
        let Lanes {
            p, own, ahead, t, z, ..
        } = lanes;
        let [q, left, up] = &mut lanes.normal;
        let [q, left, up] = [&mut q[..met], &mut left[..met], &mut up[..met]];
        let [a, b, c] = &mut lanes.unit;
        let (t, z) = (&mut t[..met], &mut z[..met]);
        graph.many(&p[..met], &own[..met], z, [q, left, up]);
        let rate = heading.length.recip();
        for (t, ahead) in t.iter_mut().zip(ahead) {
            *t = *ahead * rate;
        }
        for (z, t) in z.iter_mut().zip(&*t) {
            *z += heading.tip[2] + t * heading.way[2];
        }
        let units = a.iter_mut().zip(b).zip(c);
        for (((q, left), up), ((a, b), c)) in q.iter().zip(left).zip(up).zip(units) {
            [*a, *b, *c] = heading.unit_in_space([*q, *left, *up]);
        }
        let ([a, b, c], source) = (&lanes.unit, &self.source);
        let crossings = lanes.line[..met].iter().enumerate().map(|(k, line)| {
            let crossing = Crossing {
                z: lanes.z[k],
                jump,
                normal: [a[k], b[k], c[k]],
                source: source(lanes.t[k]),
            };
            (*line, crossing)
        });
        self.lines.harvest.crossings.extend(crossings);
    }

    /// One line, which may be near an end of the span, or of the way.
    fn one<G: Graph>(&mut self, graph: &G, part: &StripPart, line: u32, [p, q]: [f64; 2]) {
        let heading = self.heading;
        let lattice = self.lines.lines;
        let StripPart {
            sure,
            span: [low, high],
            blurs,
            ..
        } = part;
        if p < sure[0] || p >= sure[1] {
            let end = usize::from(p >= sure[0]);
            let ahead = q - graph.at(p.clamp(*low, *high)).q;
            if ahead > -blurs[end] && ahead < heading.length + blurs[end] && lattice.asks_for(line) {
                self.lines.open(line as usize);
            }
            return;
        }
        let point = graph.at(p);
        let ahead = q - point.q;
        let error = heading.slack * (2.0 + point.slope.abs());
        if ahead < -error || ahead > heading.length + error || (point.jump == 0 && point.certain) {
            return;
        }
        if !lattice.asks_for(line) {
            return;
        }
        let line = line as usize;
        // NaN is uncertain.
        if !(point.certain && ahead > error && ahead < heading.length - error) {
            self.lines.open(line);
            return;
        }
        let t = ahead / heading.length;
        let z = heading.tip[2] + t * heading.way[2] + point.z;
        let normal = heading.unit_in_space(point.normal);
        self.lines.crossing(line, z, point.jump, normal, (self.source)(t));
    }

    /// Leaves the lines of a strip that is too narrow open.
    fn sliver(&mut self, p: [f64; 2], [back, front]: [f64; 2]) {
        let heading = self.heading;
        let margin = 2.0 * heading.slack;
        let reach = [back - margin, front + margin + heading.length];
        let lattice = self.lines.lines;
        let [ux, uy] = heading.ahead;
        let collector = &mut *self.lines;
        rows(lattice, &floor(heading), [p, reach], |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - heading.tip[1];
                let (own, q) = (ux * y - uy * x, ux * x + uy * y);
                let inside = own >= p[0] && own <= p[1] && q >= reach[0] && q <= reach[1];
                if inside && lattice.asks(i, j) {
                    collector.open(lattice.line(i, j));
                }
            }
        });
    }
}
