//! The lines of a lattice in the coordinates `(q, p)` of a move: along a straight way and across it, or about the centre of an arc.

use super::{Floor, Row, Sector, search};
use crate::methods::lattice::Lattice;
use std::f64::consts::{PI, TAU};

/// The plane across the dexels about the centre of an arc that turns left. `p` is how much nearer to the centre a point is than the tip, and `q` its angle ahead of the tip at the start.
#[derive(Clone, Copy, Debug)]
pub(in crate::methods::translation) struct Ring {
    pub centre: [f64; 2],
    /// Of the tip.
    pub radius: f64,
    /// The direction from the centre to the tip at the start.
    pub from: [f64; 2],
    /// The rounding error of coordinates.
    pub rounding: f64,
}

/// What `p` and `q` of lines are.
#[derive(Clone, Copy, Debug)]
pub(in crate::methods::translation) enum Ground {
    Floor(Floor),
    Ring(Ring),
}

/// Ranges of `p` and of `q`. About a centre, those of `q` are unbounded or shorter than a turn.
type Window = [[f64; 2]; 2];

/// Angles are counted from this much before a window on.
const BEFORE: f64 = 0.5;

impl Ring {
    /// From the centre, as seen in the direction of the tip at the start: outwards and ahead.
    fn seen(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.from;
        [x * c + y * s, y * c - x * s]
    }

    fn sector(&self, [p, q]: Window) -> Sector {
        let start = self.from[1].atan2(self.from[0]);
        let angles = if q[1] - q[0] < TAU {
            q.map(|q| start + q)
        } else {
            [-PI, PI]
        };
        Sector {
            centre: self.centre,
            radii: [p[1], p[0]].map(|p| (self.radius - p).max(0.0)),
            angles,
        }
    }
}

impl Ground {
    /// Where `x` and `y` of rows are measured from.
    fn origin(&self) -> [f64; 2] {
        match self {
            Self::Floor(Floor { tip: [x, y, _], .. }) => [*x, *y],
            Self::Ring(ring) => ring.centre,
        }
    }

    fn rounding(&self) -> f64 {
        match self {
            Self::Floor(Floor { rounding, .. }) | Self::Ring(Ring { rounding, .. }) => *rounding,
        }
    }

    /// How far it is along the way from one value of `q` to the next whole one.
    #[inline]
    pub fn scale(&self, p: f64) -> f64 {
        match self {
            Self::Floor(_) => 1.0,
            Self::Ring(ring) => ring.radius - p,
        }
    }

    /// What rounding may change differences of `q` by.
    #[inline]
    pub fn error(&self, p: f64) -> f64 {
        // Of a line at the centre, nothing is known: infinite, or negative by rounding.
        4.0 * self.rounding() / self.scale(p).max(0.0)
    }

    /// The value of `q`, of a point with this one or another that is a whole turn away, which is nearest to a given one.
    #[inline]
    pub fn near(&self, q: f64, to: f64) -> f64 {
        match self {
            Self::Floor(_) => q,
            Self::Ring(_) => q + TAU * ((to - q) / TAU).round(),
        }
    }

    /// A direction at an angle: ahead, to the left and up there.
    #[inline]
    pub fn in_space(&self, q: f64, [ahead, left, up]: [f64; 3]) -> [f64; 3] {
        let [x, y] = match self {
            Self::Floor(floor) => floor.ahead,
            Self::Ring(ring) => {
                let ([c, s], (sine, cosine)) = (ring.from, q.sin_cos());
                [-s * cosine - c * sine, c * cosine - s * sine]
            }
        };
        [x * ahead - y * left, y * ahead + x * left, up]
    }

    /// `p` and `q` of a line from the origin, if they are in a window that is wider by so many times the rounding error. NaN is inside.
    #[inline]
    fn place_in(&self, [x, y]: [f64; 2], [p, q]: Window, margins: f64) -> Option<[f64; 2]> {
        let off = |own: f64, [low, high]: [f64; 2], margin: f64| own < low - margin || own > high + margin;
        let margin = margins * self.rounding();
        match self {
            Self::Floor(floor) => {
                let [ux, uy] = floor.ahead;
                let own = [ux * y - uy * x, ux * x + uy * y];
                let outside = off(own[0], p, margin) || off(own[1], q, margin);
                (!outside).then_some(own)
            }
            Self::Ring(ring) => {
                let distance = x.hypot(y);
                let nearer = ring.radius - distance;
                if off(nearer, p, margin) {
                    return None;
                }
                let [out, ahead] = ring.seen([x, y]);
                let mut angle = ahead.atan2(out);
                let first = q[0] - BEFORE;
                if first.is_finite() {
                    angle += TAU * ((first - angle) / TAU).ceil();
                }
                (!off(angle, q, margin / distance)).then_some([nearer, angle])
            }
        }
    }

    /// Visits rows of lines in a window, and a few others, until `visit` returns true.
    #[inline]
    fn search(&self, lines: &Lattice, window: Window, visit: impl FnMut(Row) -> bool) -> bool {
        match self {
            Self::Floor(floor) => search(lines, floor, window, visit),
            Self::Ring(ring) => ring.sector(window).search(lines, ring.rounding, visit),
        }
    }

    /// Calls `each` with the lines that are asked for in a window, and their `p` and `q`.
    #[inline]
    pub fn each(&self, lines: &Lattice, window: Window, mut each: impl FnMut(usize, [f64; 2])) {
        let [_, oy] = self.origin();
        self.search(lines, window, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lines.coordinate(1, j) - oy;
                if let Some(place) = self.place_in([x, y], window, 0.0)
                    && lines.asks(i, j)
                {
                    each(lines.line(i, j), place);
                }
            }
            false
        });
    }

    /// Whether lines that are asked for are in a window, up to rounding. It may be narrower than what [`numbers`](super::numbers) adds to it, so each line is looked at:
    /// otherwise a cell that shrinks to a point would seem to have lines over it until rounding ends that.
    pub fn meets(&self, lines: &Lattice, window: Window) -> bool {
        let [_, oy] = self.origin();
        self.search(lines, window, |Row { i, j, x }| {
            (j[0]..=j[1]).any(|j| {
                let y = lines.coordinate(1, j) - oy;
                self.place_in([x, y], window, 2.0).is_some() && lines.asks(i, j)
            })
        })
    }

    /// Whether at least so many lines that are asked for are in a window, or a little beside.
    pub fn are_many(&self, lines: &Lattice, window: Window, many: usize) -> bool {
        let mut count = 0;
        self.search(lines, window, |Row { i, j, .. }| {
            count += (j[0]..=j[1]).filter(|j| lines.asks(i, *j)).count();
            count >= many
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sweepsim_dexel::Grid;

    proptest! {
        /// A window has lines if one is in it, however narrow the window is, and however near to others.
        #[test]
        fn only_lines_in_a_window_count(
            angle in 0.0..6.2, tip in [-3.0..3.0, -3.0..3.0], shift in [-0.1..0.1, -0.1..0.1], start in [-3.0..3.0, -3.0..3.0],
            logarithm in -9.0..0.5, length in 0.0..8.0, chosen in prop::option::of((0_usize..7, 0_usize..9)),
        ) {
            let grid = Grid::new([-3.0, -2.0], [4.0, 3.0], [7, 9]).unwrap();
            let lines = Lattice::all(&grid, shift);
            let (uy, ux) = f64::sin_cos(angle);
            let ground = Ground::Floor(Floor { tip: [tip[0], tip[1], 0.0], ahead: [ux, uy], rounding: 1e-14 });
            let place = |(i, j): (usize, usize)| {
                let [x, y] = [lines.coordinate(0, i) - tip[0], lines.coordinate(1, j) - tip[1]];
                [ux * y - uy * x, ux * x + uy * y]
            };
            let width = f64::exp(2.3 * logarithm);
            // Beside or over one of the lines.
            let [p, q] = chosen.map_or(start, |line| [place(line)[0] + (start[0] - 1.5) * width, place(line)[1] + start[1]]);
            let window = [[p, p + width], [q, q + length]];
            let all = (0..7).flat_map(|i| (0..9).map(move |j| (i, j)));
            let off = |line: (usize, usize)| {
                let own = place(line);
                let beyond = |k: usize| f64::max(window[k][0] - own[k], own[k] - window[k][1]);
                f64::max(beyond(0), beyond(1))
            };
            let least = all.map(off).fold(f64::INFINITY, f64::min);
            prop_assume!(least.abs() > 1e-13);
            prop_assert_eq!(ground.meets(&lines, window), least < 0.0);
        }

        /// The lines about a centre are visited once each, with their distance and angle.
        #[test]
        fn windows_about_a_centre_hold_their_lines(
            centre in [-3.0..4.0_f64, -3.0..4.0], start in -3.1..3.1_f64, radius in 0.01..6.0_f64, p in -4.0..6.0_f64, width in 0.0..3.0_f64, q in -3.1..3.1_f64, length in 0.0..4.7_f64,
            unbounded in any::<bool>(),
        ) {
            let grid = Grid::new([-3.0, -2.0], [4.0, 3.0], [7, 9]).unwrap();
            let lines = Lattice::all(&grid, [0.01, -0.02]);
            let ring = Ring { centre, radius, from: [f64::cos(start), f64::sin(start)], rounding: 1e-14 };
            let ground = Ground::Ring(ring);
            let window = [[p, p + width], if unbounded { [f64::NEG_INFINITY, f64::INFINITY] } else { [q, q + length] }];
            let mut expected = Vec::new();
            for (i, j) in (0..7).flat_map(|i| (0..9).map(move |j| (i, j))) {
                let [x, y] = [lines.coordinate(0, i) - centre[0], lines.coordinate(1, j) - centre[1]];
                let own: f64 = radius - f64::hypot(x, y);
                let mut angle: f64 = f64::atan2(y, x) - start;
                while angle > q { angle -= TAU; }
                while angle < q { angle += TAU; }
                prop_assume!((own - p).abs() > 1e-9 && (own - p - width).abs() > 1e-9);
                prop_assume!(unbounded || (angle - q).abs() > 1e-9 && (angle - q - length).abs() > 1e-9);
                if own > p && own < p + width && (unbounded || angle < q + length) {
                    expected.push((lines.line(i, j), own, angle));
                }
            }
            let mut found = Vec::new();
            ground.each(&lines, window, |line, [p, q]| found.push((line, p, q)));
            prop_assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(&expected) {
                prop_assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-12, "{:?} {:?}", a, b);
                prop_assert!(unbounded || (a.2 - b.2).abs() < 1e-12, "{:?} {:?}", a, b);
            }
            prop_assert_eq!(ground.meets(&lines, window), !expected.is_empty());
        }
    }
}
