//! Stretches of a grazing curve as polynomials: where a move goes over many lines, most of them are settled by a comparison of numbers.

use super::chart::{Chart, Range, Witness};
use super::knot::{Knot, KnownLine, Quintic};

/// What is known of the curve of a chart over a range of `p`.
pub(super) struct Span {
    pub range: [f64; 2],
    pub known: Known,
}

pub(super) enum Known {
    /// It is not in the chart.
    Absent,
    /// Points that were looked at near both ends of the range.
    Witnesses([Option<Witness>; 2]),
    Graph(Box<Graph>),
}

/// The curve as a polynomial of degree 5 through three knots.
pub(super) struct Graph {
    pub curve: Quintic,
    knots: [Knot; 3],
    /// For the values of `p` nearest to each knot: where `q` is, if the curve is certainly inside the chart for all of these.
    q: [Option<Range>; 3],
}

impl Graph {
    pub fn new(chart: &Chart, knots: [Knot; 3], curve: Quintic) -> Self {
        let [a, b, c] = knots.each_ref().map(|knot| knot.p);
        let (left, right) = (0.5 * (a + b), 0.5 * (b + c));
        let parts = [[a, left], [left, right], [right, c]];
        let q = [0, 1, 2].map(|k: usize| {
            let witness = &knots[k].witness;
            let region = chart.region_along(witness, parts[k]);
            region.is_inside().then(|| chart.q(witness, &region))
        });
        Self { curve, knots, q }
    }

    /// The nearest knot, and where `q` is all about it.
    #[inline]
    pub fn near(&self, p: f64) -> (&Knot, Option<Range>) {
        let [a, b, c] = &self.knots;
        let k = usize::from(p > 0.5 * (a.p + b.p)) + usize::from(p > 0.5 * (b.p + c.p));
        (&self.knots[k], self.q[k])
    }
}

/// The curve of a chart, divided into spans in ascending order.
pub(super) struct Spans {
    list: Vec<Span>,
    /// The latest one asked for.
    at: usize,
}

impl Spans {
    /// Spans in ascending order.
    pub fn new(list: Vec<Span>) -> Self {
        Self { list, at: 0 }
    }

    /// The range of `p` of all spans in which the curve may be in the chart.
    pub fn reach(&self) -> Option<[f64; 2]> {
        let mut present = self.list.iter().filter(|span| !matches!(span.known, Known::Absent));
        let first = present.next()?;
        let last = present.next_back().unwrap_or(first);
        Some([first.range[0], last.range[1]])
    }

    /// The span that holds `p`. Values close to the latest one are found at once.
    #[inline]
    pub fn find(&mut self, p: f64) -> Option<&Span> {
        let holds = |span: &&Span| p >= span.range[0] && p <= span.range[1];
        if self.list.get(self.at).filter(holds).is_none() {
            self.at = self.list.partition_point(|span| span.range[1] < p);
        }
        self.list.get(self.at).filter(holds)
    }
}

/// Whether the curve is nowhere in the chart over a range of `p`, as points that were looked at near its ends tell.
pub(super) fn is_absent(chart: &Chart, centre: &Witness, ends: [&KnownLine; 2], range: [f64; 2]) -> bool {
    let mut region = chart.region_along(centre, range);
    for witness in ends.into_iter().filter_map(|end| end.witness.as_ref()) {
        region.intersect(&chart.region_along(witness, range));
    }
    region.is_empty()
}
