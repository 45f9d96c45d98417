//! Arcs in tilted planes, turned, scaled and mirrored: those of their chords' points, written out as lines.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Controller, Machine, ReadOptions};

use super::{assert_near, options, program_with, tips};

/// How the coordinates are turned, scaled or mirrored.
const FRAMES: [&str; 7] = [
    "G68.2 X3 Y-1 Z2 I20 J30 K10\n",
    "G68.2 X0 Y0 Z0 I0 J90 K0\n",
    "G68.2 X3 Y-1 Z2 I20 J30 K10\nG68 X1 Y2 R25\n",
    "G68.2 X0 Y0 Z0 I-50 J40 K0\nG51 X1 Y0 Z0 P2.5\n",
    "G68.2 X0 Y0 Z0 I-50 J40 K0\nG51.1 X2\n",
    "G68.2 X0 Y0 Z0 I0 J30 K0\nG53.1\n",
    "G68 X0 Y0 R30\n",
];

/// An arc from (4, 0) in the plane's own directions, about a point 4 before it, with a rise across it.
struct Arc {
    plane: usize,
    angle: f64,
    rise: f64,
}

impl Arc {
    fn directions(&self) -> [usize; 3] {
        [[0, 1, 2], [2, 0, 1], [1, 2, 0]][self.plane]
    }

    fn point(&self, share: f64) -> [f64; 3] {
        let ([u, v, w], (sin, cos)) = (self.directions(), (share * self.angle).sin_cos());
        let mut point = [0.0; 3];
        (point[u], point[v], point[w]) = (4.0 * cos, 4.0 * sin, 1.0 + share * self.rise);
        point
    }

    fn line(&self, share: f64) -> String {
        let [x, y, z] = self.point(share);
        format!("G1 X{x:.12} Y{y:.12} Z{z:.12}\n")
    }

    fn text(&self) -> String {
        let [u, v, _] = self.directions();
        let [x, y, z] = self.point(1.0);
        let mut centre = [0.0; 3];
        (centre[u], centre[v]) = (-4.0, 0.0);
        let [i, j, k] = centre;
        let words = [(i, 'I'), (j, 'J'), (k, 'K')].into_iter().enumerate();
        let mut text = format!(
            "{} {} X{x:.12} Y{y:.12} Z{z:.12}",
            ["G17", "G18", "G19"][self.plane],
            if self.angle > 0.0 { "G3" } else { "G2" }
        );
        for (axis, (word, letter)) in words {
            if axis == u || axis == v {
                let _ = write!(text, " {letter}{word}");
            }
        }
        text + "\n"
    }
}

fn arcs() -> impl Iterator<Item = Arc> {
    let shapes = [(FRAC_PI_2, 0.0), (-PI, 0.0), (4.0, 1.5), (-5.5, -2.0)];
    (0..3).flat_map(move |plane| shapes.map(|(angle, rise)| Arc { plane, angle, rise }))
}

/// Both with a machine and without one.
fn every_case(mut check: impl FnMut(&str, &Arc, &ReadOptions)) {
    for machine in [None, Some("trunnion-ac")] {
        let mut options = options(Controller::Fanuc);
        options.machine = machine.map_or_else(Machine::default, |name| Machine::named(name).unwrap());
        for frame in FRAMES {
            for arc in arcs() {
                check(frame, &arc, &options);
            }
        }
    }
}

#[test]
fn chords_are_those_of_lines() {
    every_case(|frame, arc, options| {
        let start = format!("G21 G90 F100\nG0 X0 Y0 Z50\n{frame}G0 X0 Y0 Z5\n{}", arc.line(0.0));
        let found = tips(&program_with(&format!("{start}{}", arc.text()), options));
        let before = tips(&program_with(&start, options)).len();
        let chords = found.len() - before;
        // Within the tolerance, even if the coordinates are scaled.
        assert!(chords >= 30, "{frame}: {chords}");
        let mut lines = start;
        for chord in 1..=chords {
            lines += &arc.line(chord as f64 / chords as f64);
        }
        assert_near(&found, &tips(&program_with(&lines, options)));
    });
}

#[test]
fn exact_arcs_are_those_of_their_points() {
    every_case(|frame, arc, options| {
        let mut exact = options.clone();
        exact.exact_arcs = true;
        let start = format!("G21 G90 F100\nG0 X0 Y0 Z50\n{frame}G0 X0 Y0 Z5\n{}", arc.line(0.0));
        let found = program_with(&format!("{start}{}", arc.text()), &exact);
        let last = found.poses.iter().next_back().unwrap();
        let TipCourse::Arc(own) = last.way().course else {
            panic!("{frame}: no arc")
        };
        let shares = [0.0, 0.25, 0.5, 1.0];
        let text = shares
            .iter()
            .skip(1)
            .fold(start, |text, share| text + &arc.line(*share));
        let points = tips(&program_with(&text, options));
        let points = &points[points.len() - shares.len()..];
        let (centre, normal) = (own.centre(), own.normal());
        let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k: usize| a[k] - b[k]);
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [0, 1, 2].map(|k: usize| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
        };
        let out = minus(points[0], centre);
        let along = dot(out, normal);
        let out = minus(out, normal.map(|c| along * c));
        let ahead = cross(normal, out);
        let rise = dot(minus(points[shares.len() - 1], points[0]), normal);
        for (share, point) in shares.iter().zip(points) {
            let (sin, cos) = (share * own.angle()).sin_cos();
            let turned: [f64; 3] =
                std::array::from_fn(|k| centre[k] + cos * out[k] + sin * ahead[k] + (along + share * rise) * normal[k]);
            assert_near(&[*point], &[turned]);
        }
    });
}
