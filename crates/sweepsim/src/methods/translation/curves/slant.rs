//! The grazing curve of a cone or cylinder: two straight lines.

use super::graph::{End, Graph, GraphPoint, Turned};
use super::{Heading, Local};

/// Where `sin² φ` is below this, the two lines almost coincide, and rounding would blur them.
const BLURRED: f64 = 1e-9;

/// A straight grazing line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slant {
    ends: [Local; 2],
    span: [f64; 2],
    margin: f64,
    jump: i8,
    normal: Local,
    slope: f64,
    rise: f64,
}

/// The grazing lines of a meridian line between two points with this normal: those of which `p` changes, and ends of the others. `None` if rounding blurs them.
pub(crate) fn slants(heading: &Heading, [from, to]: [[f64; 2]; 2], normal: [f64; 2]) -> Option<Vec<Slant>> {
    let [n_rho, n_zeta] = normal;
    if n_rho == 0.0 {
        return Some(Vec::new());
    }
    let c = -heading.along * n_zeta;
    let width = heading.across * n_rho;
    // |cos φ| > 1: the whole cone moves outwards, or inwards.
    if c.abs() > width.abs() * (1.0 + BLURRED) {
        return Some(Vec::new());
    }
    let cosine = c / width;
    let square = (1.0 - cosine) * (1.0 + cosine);
    if !(square > BLURRED) {
        return None;
    }
    let sine = square.sqrt();
    let line = |side: f64| {
        let towards = [cosine, side * sine];
        let ends = [from, to].map(|[rho, zeta]| heading.point(rho, towards, zeta));
        let run = ends[1][1] - ends[0][1];
        let up = if run > 0.0 { 1.0 } else { -1.0 };
        Slant {
            ends,
            span: [ends[0][1].min(ends[1][1]), ends[0][1].max(ends[1][1])],
            margin: heading.slack * (1.0 + 1.0 / sine),
            jump: if n_rho * side * up > 0.0 { 1 } else { -1 },
            normal: heading.point(n_rho, towards, n_zeta),
            slope: (ends[1][0] - ends[0][0]) / run,
            rise: (ends[1][2] - ends[0][2]) / run,
        }
    };
    Some(vec![line(1.0), line(-1.0)])
}

impl Slant {
    #[inline]
    fn place(&self, p: f64) -> [f64; 2] {
        let from = &self.ends[0];
        let run = p - from[1];
        [from[0] + run * self.slope, from[2] + run * self.rise]
    }
}

impl Graph for Slant {
    fn at(&self, p: f64) -> GraphPoint {
        let [q, z] = self.place(p);
        GraphPoint {
            q,
            z,
            slope: self.slope,
            jump: self.jump,
            normal: self.normal,
            certain: true,
        }
    }

    fn span(&self) -> [f64; 2] {
        self.span
    }

    fn margins(&self) -> [f64; 2] {
        [self.margin; 2]
    }

    fn reach(&self) -> [f64; 2] {
        let [a, b] = [self.ends[0][0], self.ends[1][0]];
        [a.min(b), a.max(b)]
    }

    fn jump(&self, _: [f64; 2]) -> Option<i8> {
        Some(self.jump)
    }

    fn steepest(&self, _: [f64; 2]) -> Option<f64> {
        Some(self.slope.abs())
    }

    fn many_q(&self, p: &[f64], q: &mut [f64], _: &mut [f64]) {
        for (p, q) in p.iter().zip(q) {
            *q = self.place(*p)[0];
        }
    }

    fn many(&self, p: &[f64], _: &[f64], z: &mut [f64], normal: [&mut [f64]; 3]) {
        for (p, z) in p.iter().zip(z) {
            *z = self.place(*p)[1];
        }
        for (all, own) in normal.into_iter().zip(self.normal) {
            all.fill(own);
        }
    }
}

impl Turned for Slant {
    fn ends(&self) -> [End; 2] {
        let [a, b] = &self.ends;
        let end = |end: &Local| End {
            q: end[0],
            blur: Some(self.margin),
        };
        if a[1] <= b[1] {
            [end(a), end(b)]
        } else {
            [end(b), end(a)]
        }
    }
}
