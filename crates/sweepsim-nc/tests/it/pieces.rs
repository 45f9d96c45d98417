//! Contours of lines and arcs, their distances, and the moves of programs beside them.

use std::f64::consts::TAU;

use sweepsim_motion::TipCourse;
use sweepsim_nc::Program;

/// A piece of a programmed contour.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    Line([f64; 2], [f64; 2]),
    /// From, to, centre, counter-clockwise.
    Arc([f64; 2], [f64; 2], [f64; 2], bool),
}

pub fn distance_to_point(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

impl Piece {
    pub fn distance(&self, p: [f64; 2]) -> f64 {
        match *self {
            Self::Line(a, b) => {
                let d = [b[0] - a[0], b[1] - a[1]];
                let t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
                let t = t.clamp(0.0, 1.0);
                distance_to_point(p, [a[0] + t * d[0], a[1] + t * d[1]])
            }
            Self::Arc(a, b, c, ccw) => {
                let angle = |q: [f64; 2]| (q[1] - c[1]).atan2(q[0] - c[0]);
                let (from, to) = if ccw {
                    (angle(a), angle(b))
                } else {
                    (angle(b), angle(a))
                };
                let span = (to - from).rem_euclid(TAU);
                let span = if span < 1e-9 { TAU } else { span };
                if (angle(p) - from).rem_euclid(TAU) <= span {
                    (distance_to_point(p, c) - distance_to_point(a, c)).abs()
                } else {
                    distance_to_point(p, a).min(distance_to_point(p, b))
                }
            }
        }
    }

    /// A block of G-code.
    pub fn block(&self) -> String {
        match *self {
            Self::Line(_, b) => format!("G1 X{:.9} Y{:.9}\n", b[0], b[1]),
            Self::Arc(a, b, c, ccw) => format!(
                "G{} X{:.9} Y{:.9} I{:.9} J{:.9}\n",
                if ccw { 3 } else { 2 },
                b[0],
                b[1],
                c[0] - a[0],
                c[1] - a[1]
            ),
        }
    }
}

/// Points of the moves of a program from one pose to another, densely.
pub fn samples(program: &Program, poses: std::ops::Range<usize>) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for pair in program.poses[poses].windows(2) {
        let before = points.len();
        let (a, b): ([f64; 3], [f64; 3]) = (pair[0].pose.tip(), pair[1].pose.tip());
        for k in 0..=20 {
            let s = f64::from(k) / 20.0;
            points.push(match pair[1].way().course {
                TipCourse::Arc(arc) => {
                    let (c, turn) = (arc.centre(), s * arc.angle() * arc.normal()[2].signum());
                    let (x, y) = (a[0] - c[0], a[1] - c[1]);
                    [
                        c[0] + x * turn.cos() - y * turn.sin(),
                        c[1] + x * turn.sin() + y * turn.cos(),
                    ]
                }
                _ => [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])],
            });
        }
        assert!(points.len() > before);
        let last = points[points.len() - 1];
        assert!(
            distance_to_point(last, [b[0], b[1]]) < 1e-6,
            "the move of line {} ends in {last:?}, the next begins in {b:?}",
            pair[1].line
        );
    }
    points
}

/// A closed polygon, from the middle of its first side.
pub fn polygon(points: &[[f64; 2]]) -> Vec<Piece> {
    let n = points.len();
    let middle = [0, 1].map(|k| 0.5 * (points[0][k] + points[1][k]));
    let mut pieces = vec![Piece::Line(middle, points[1])];
    pieces.extend((1..n).map(|k| Piece::Line(points[k], points[(k + 1) % n])));
    pieces.push(Piece::Line(points[0], middle));
    pieces
}

/// A polygon round the origin, not convex in general.
pub fn star(radii: &[f64]) -> Vec<[f64; 2]> {
    let n = radii.len() as f64;
    let point = |(k, r): (usize, &f64)| {
        let (sin, cos) = (TAU * k as f64 / n).sin_cos();
        // As the program says it.
        [r * cos, r * sin].map(|x| (x * 1e9).round() / 1e9)
    };
    radii.iter().enumerate().map(point).collect()
}

/// A rectangle of 40 by 30 mm with rounded corners, counter-clockwise, from the middle of its lower side. With `bulge`, that side has a half circle
/// with sharp corners: outside (to the right) or inside.
pub fn rounded_rectangle(corner: f64, bulge: Option<bool>) -> Vec<Piece> {
    let r = (corner * 1e6).round() / 1e6;
    let (w, h) = (40.0, 30.0);
    let arc = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| Piece::Arc(a, b, c, true);
    let mut pieces = vec![
        Piece::Line([20.0, 0.0], [w - r, 0.0]),
        arc([w - r, 0.0], [w, r], [w - r, r]),
        Piece::Line([w, r], [w, h - r]),
        arc([w, h - r], [w - r, h], [w - r, h - r]),
        Piece::Line([w - r, h], [r, h]),
        arc([r, h], [0.0, h - r], [r, h - r]),
        Piece::Line([0.0, h - r], [0.0, r]),
        arc([0.0, r], [r, 0.0], [r, r]),
    ];
    if let Some(outside) = bulge {
        pieces.push(Piece::Line([r, 0.0], [12.0, 0.0]));
        pieces.push(Piece::Arc([12.0, 0.0], [18.0, 0.0], [15.0, 0.0], outside));
        pieces.push(Piece::Line([18.0, 0.0], [20.0, 0.0]));
    } else {
        pieces.push(Piece::Line([r, 0.0], [20.0, 0.0]));
    }
    pieces
}
