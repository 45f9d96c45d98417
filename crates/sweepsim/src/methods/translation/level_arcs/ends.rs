//! Where the squared distance of a curve from the centre is monotone, and where a line lies along the way of a point of it.

use super::LevelArcSearch;
use crate::methods::translation::arc_place::ArcPlace;
use crate::methods::translation::curves::{Graph, Turned, TurnedPoint};
use sweepsim_dexel::Source;

/// What rounding may move a point of a curve by, in the rounding errors of a coordinate.
const OFF: f64 = 8.0;

/// A stretch of a graph over which `s` is monotone.
pub(super) struct Bend {
    /// `p` where `s` is least, and where it is greatest.
    pub p: [f64; 2],
    pub s: [f64; 2],
    pub margins: [f64; 2],
    /// By which the jumps of the graph are multiplied.
    pub sense: i8,
}

impl<S: Fn(f64) -> Source> LevelArcSearch<'_, '_, S> {
    /// Whether lines at this squared distance are much nearer to the centre than the axis is. There, distances are as accurate as coordinates are, however small.
    pub(super) fn is_near(&self, s: f64) -> bool {
        2.0 * s.sqrt() < self.arc.radius
    }

    /// `s` at a point of a graph.
    fn square(&self, q: f64, p: f64) -> f64 {
        let out = self.arc.radius - self.side * p;
        out * out + q * q
    }

    /// A span over which `s` is known to be monotone. `turn` gives `s` where it is near, and turns.
    pub(super) fn bend<G: Turned>(&self, graph: &G, span: [f64; 2], turn: impl Fn(f64) -> f64) -> Bend {
        let slack = self.heading.slack;
        let whole = graph.span();
        let own = graph.margins();
        let squares = |near: f64, s: f64| near * (2.0 * s.sqrt() + near);
        let end = |k: usize| {
            let p = span[k];
            if p == whole[k] {
                let end = graph.ends()[k];
                let s = self.square(end.q, p);
                let near = self.is_near(s);
                if let Some(blur) = end.blur.filter(|_| near) {
                    return (p, s, squares(OFF * slack + blur, s));
                }
                // Where the graph ends, it may end elsewhere.
                let inner = span[k] + if k == 0 { 2.0 } else { -2.0 } * own[k];
                let shift = 2.0 * (s - self.square(graph.at(inner).q, inner)).abs();
                let off = if near {
                    squares(OFF * slack, s)
                } else {
                    OFF * slack * (self.arc.radius + p.abs() + end.q.abs())
                };
                return (p, s, shift + off);
            }
            let point = graph.at(p);
            let s = self.square(point.q, p);
            if self.is_near(s) {
                let s = turn(p).max(0.0);
                (p, s, squares(OFF * slack, s))
            } else {
                // Where s turns, the distance from the centre is as accurate as coordinates are.
                (p, s, squares(OFF * slack * (1.0 + point.slope.abs()), s))
            }
        };
        let ends = [end(0), end(1)];
        let falls = ends[1].1 < ends[0].1;
        let [a, b] = if falls { [ends[1], ends[0]] } else { ends };
        // The left of the tool is inside for arcs that turn left.
        let sense = if falls == (self.side > 0.0) { 1 } else { -1 };
        Bend {
            p: [a.0, b.0],
            s: [a.1, b.1],
            margins: [a.2, b.2],
            sense,
        }
    }

    /// The point of a graph at `p`, for a value of `s`. `near`: `p` is as accurate as the distance.
    pub(super) fn seen<G: Graph>(&self, graph: &G, bend: &Bend, s: f64, (p, near): (f64, bool)) -> TurnedPoint {
        let (arc, side, slack) = (self.arc, self.side, self.heading.slack);
        let p = p.clamp(bend.p[0].min(bend.p[1]), bend.p[0].max(bend.p[1]));
        let point = graph.at(p);
        let out = arc.radius - side * p;
        let far = arc.radius + p.abs() + point.q.abs();
        let distance = s.sqrt();
        // Of the point, and of s; then of p, and of the angle.
        let (own, square) = if near {
            let own = slack * (8.0 + 4.0 * point.slope.abs());
            (own, own * (distance + own))
        } else {
            (4.0 * slack, 4.0 * slack * (far + distance))
        };
        let off = square / (2.0 * (p - side * arc.radius + point.q * point.slope)).abs();
        let error = own / distance + off * (out * point.slope + side * point.q).abs() / s;
        TurnedPoint { out, point, error }
    }

    /// Where a line lies along the arc of a point that starts at `(out, ahead)` from the centre. `error`: of angles.
    pub(super) fn place(&self, [x, y]: [f64; 2], [out, ahead]: [f64; 2], s: f64, error: f64) -> ArcPlace<[f64; 2]> {
        let [fx, fy] = self.arc.from;
        let own = [x * fx + y * fy, self.side * (y * fx - x * fy)];
        // The angle from the point to the line, as a complex number.
        let c = own[0] * out + own[1] * ahead;
        let n = own[1] * out - own[0] * ahead;
        ArcPlace::new([c, n], self.end, error * s, || [c / s, n / s])
    }
}
