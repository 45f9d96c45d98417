//! Curves: Bézier curves of `G5` and `G5.1`, and the rational B-splines of `G5.2` and `G5.3`.
//!
//! Source: *LinuxCNC G-code reference*, Cubic Spline, Quadratic Spline, NURBS Block; for what the reference leaves open, LinuxCNC's
//! `interp_convert.cc` and `nurbs_additional_functions.cc`: the knots are open and uniform, the order is 3 unless `L` is greater, the current point is the first
//! control point, with the weight `P` of a `G5.2` without coordinates, or 1.

use sweepsim_spline::{BSpline, KnotVector};

use crate::drive::Stroke;
use crate::gcode::run::interpreter::Reader;
use crate::gcode::syntax::block::Block;
use crate::text::error::NcProblem;

/// The least order of a curve, and the one without `L`.
const LEAST_ORDER: usize = 3;
/// The greatest: degree 9.
const MOST_ORDER: f64 = 10.0;
/// The most control points of a curve.
const MOST_POINTS: usize = 100_000;
/// The most chords of a curve.
const MOST_CHORDS: usize = 1_000_000;
/// The most times a piece of a curve is halved.
const MOST_HALVINGS: usize = 40;

/// The control points of a curve so far.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nurbs {
    order: usize,
    /// In the plane, in millimetres, with their weights.
    points: Vec<([f64; 2], f64)>,
}

impl Nurbs {
    /// Points on the curve after its start, in its plane, such that the chords between them are within `tolerance` of it, and it of them.
    fn chords(&self, tolerance: f64) -> Result<Vec<[f64; 2]>, NcProblem> {
        let wrong = |error: String| NcProblem::syntax(format!("this curve: {error}"));
        let spans = self.points.len() - self.order + 1;
        let knots =
            KnotVector::uniform(self.order - 1, spans, 0.0, spans as f64).map_err(|error| wrong(error.to_string()))?;
        // Homogeneous coordinates.
        let points: Vec<[f64; 3]> = self.points.iter().map(|([u, v], w)| [u * w, v * w, *w]).collect();
        let spline = BSpline::from_points(vec![knots], &points).map_err(|error| wrong(error.to_string()))?;
        let pieces = spline.pieces().map_err(|error| wrong(error.to_string()))?;
        let mut chords = Vec::new();
        for piece in &pieces {
            let [x, y, w] = [0, 1, 2].map(|k| piece.map.components()[k].coefficients());
            let control = (0..w.len()).map(|i| [x[i], y[i], w[i]]).collect();
            flatten(control, tolerance, MOST_HALVINGS, &mut chords)?;
        }
        Ok(chords)
    }
}

/// Chords of a rational Bézier curve: halved until all control points are within `tolerance` of the chord. The weights are positive, so that the
/// curve is in the hull of the control points.
fn flatten(
    control: Vec<[f64; 3]>,
    tolerance: f64,
    halvings: usize,
    chords: &mut Vec<[f64; 2]>,
) -> Result<(), NcProblem> {
    let flat = |[x, y, w]: [f64; 3]| [x / w, y / w];
    let (start, end) = (flat(control[0]), flat(control[control.len() - 1]));
    let chord = [end[0] - start[0], end[1] - start[1]];
    let square = chord[0] * chord[0] + chord[1] * chord[1];
    let near = |point: [f64; 3]| {
        let [x, y] = flat(point);
        let out = [x - start[0], y - start[1]];
        let along = if square > 0.0 {
            ((out[0] * chord[0] + out[1] * chord[1]) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (out[0] - along * chord[0]).hypot(out[1] - along * chord[1]) <= tolerance
    };
    if halvings == 0 || control.iter().all(|point| near(*point)) {
        if chords.len() >= MOST_CHORDS {
            return Err(NcProblem::value(
                "the number of chords of this curve",
                chords.len() + 1,
                "at most 1000000",
            ));
        }
        chords.push(end);
        return Ok(());
    }
    // De Casteljau: the first points of all levels, and the last ones.
    let (mut level, mut left, mut right) = (control, Vec::new(), Vec::new());
    while let (Some(&first), Some(&last)) = (level.first(), level.last()) {
        left.push(first);
        right.push(last);
        level = level
            .windows(2)
            .map(|pair| std::array::from_fn(|k| 0.5 * (pair[0][k] + pair[1][k])))
            .collect();
    }
    right.reverse();
    flatten(left, tolerance, halvings - 1, chords)?;
    flatten(right, tolerance, halvings - 1, chords)
}

impl Reader {
    /// A block of `G5.2`: a control point.
    pub(crate) fn control_point(&mut self, block: &Block) -> Result<(), NcProblem> {
        self.refuse_compensation("a spline")?;
        let [u, v, w] = self.modes.plane;
        let letter = |k: usize| ['X', 'Y', 'Z'][k];
        if let Some(word) = block.first("ABCIJKQR").or(block.word(letter(w))) {
            return Err(NcProblem::unsupported(
                format!("{} in a curve of G5.2 is", word.letter),
                format!("expected {} and {}, P and L", letter(u), letter(v)),
            ));
        }
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let weight = block.get('P');
        if let Some(weight) = weight.filter(|weight| !(*weight > 0.0 && weight.is_finite())) {
            return Err(NcProblem::value(
                "the weight P of a control point",
                weight,
                "a positive number",
            ));
        }
        let order = match block.get('L') {
            Some(order) if order.fract() == 0.0 && (0.0..=MOST_ORDER).contains(&order) => order as usize,
            Some(order) => {
                return Err(NcProblem::value(
                    "the order L of a curve",
                    order,
                    "a whole number up to 10",
                ));
            }
            None => 0,
        };
        let Some(start) = self.track.known() else {
            if self.seen.uncertain {
                return Ok(());
            }
            return Err(NcProblem::syntax(
                "a curve from an unknown position: expected a move to X, Y and Z before it",
            ));
        };
        let alone = words[u].is_none() && words[v].is_none();
        let curve = self.pending.nurbs.get_or_insert_with(|| Nurbs {
            order: LEAST_ORDER,
            points: Vec::new(),
        });
        if curve.points.is_empty() {
            let first = if alone { weight.unwrap_or(1.0) } else { 1.0 };
            curve.points.push(([start[u], start[v]], first));
        } else if alone && weight.is_some() {
            return Err(NcProblem::syntax(format!(
                "P without {} and {}, after the first control point: expected them with it",
                letter(u),
                letter(v)
            )));
        }
        curve.order = curve.order.max(order);
        if alone {
            return Ok(());
        }
        let (Some(x), Some(y), Some(weight)) = (words[u], words[v], weight) else {
            return Err(NcProblem::syntax(format!(
                "a control point without {}, {} or P: expected all of them",
                letter(u),
                letter(v)
            )));
        };
        if curve.points.len() >= MOST_POINTS {
            return Err(NcProblem::value(
                "the number of control points",
                MOST_POINTS,
                "smaller: divide the curve",
            ));
        }
        // Increments count from the start of the curve.
        let from = if self.modes.absolute {
            [0.0; 2]
        } else {
            [start[u], start[v]]
        };
        curve.points.push(([from[0] + x, from[1] + y], weight));
        for k in [u, v] {
            self.offsets.know(k)?;
        }
        Ok(())
    }

    /// `G5.3`: the curve through the control points so far.
    pub(crate) fn end_curve(&mut self) -> Result<(), NcProblem> {
        self.modes.motion = None;
        let Some(curve) = self.pending.nurbs.take() else {
            if self.seen.uncertain {
                return Ok(());
            }
            return Err(NcProblem::syntax("G5.3 without a curve: expected G5.2 before it"));
        };
        if curve.points.len() < curve.order {
            return Err(NcProblem::value(
                "the number of control points of this curve",
                curve.points.len(),
                format!("at least its order, {}", curve.order),
            ));
        }
        let Some(start) = self.track.known() else {
            return Ok(());
        };
        self.track
            .note("splines are divided into chords within the tolerance of arcs");
        let [u, v, _] = self.modes.plane;
        let chords = curve.chords(self.track.arc_tolerance)?;
        let count = chords.len();
        for [x, y] in chords {
            let mut end = start;
            (end[u], end[v]) = (x, y);
            let stroke = self.stroke_to(end, self.track.abc, false).share_of(count);
            self.give(stroke)?;
        }
        Ok(())
    }

    /// An end of the program, or another kind of move: a curve must have ended.
    pub(crate) fn check_curve(&mut self) -> Result<(), NcProblem> {
        match self.pending.nurbs.take() {
            None => Ok(()),
            Some(_) => Err(NcProblem::syntax("the curve of G5.2 has no end: expected G5.3")),
        }
    }

    /// G5 and G5.1: a Bézier curve, divided into chords within the tolerance of arcs.
    ///
    /// Source: *LinuxCNC G-code reference, Cubic Spline, Quadratic Spline*. A chord over 1/n of a curve leaves it by at most |B″| / (8 n²).
    pub(super) fn curve(
        &mut self,
        cubic: bool,
        start: [f64; 3],
        stroke: Stroke,
        block: &Block,
    ) -> Result<(), NcProblem> {
        self.refuse_compensation("a spline")?;
        let name = if cubic { "G5" } else { "G5.1" };
        if self.modes.plane != [0, 1, 2] || block.has('Z') || stroke.abc != self.track.abc {
            return Err(NcProblem::unsupported(
                format!("{name} outside of the plane XY is"),
                "expected X and Y in G17",
            ));
        }
        let length = |letter: char| block.get(letter).map(|value| value * self.unit());
        let [ij, pq] = [('I', 'J'), ('P', 'Q')].map(|(a, b)| match (length(a), length(b)) {
            (Some(a), Some(b)) => Some([a, b]),
            (None, None) => None,
            (a, b) if !cubic => Some([a.unwrap_or(0.0), b.unwrap_or(0.0)]),
            _ => None,
        });
        let before = self.modes.curve_tangent.take();
        let end = [stroke.end[0], stroke.end[1]];
        let from = [start[0], start[1]];
        let plus = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        let points = match (cubic, ij.or(before.map(|[x, y]| [-x, -y])), pq) {
            (true, Some(ij), Some(pq)) => {
                self.modes.curve_tangent = Some(pq);
                vec![from, plus(from, ij), plus(end, pq), end]
            }
            (false, Some(_), _) if ij.is_some() => vec![from, plus(from, ij.unwrap_or_default()), end],
            (true, ..) => {
                return Err(NcProblem::syntax(
                    "a spline without its control points: expected I and J (unless it goes on from another one), P and Q",
                ));
            }
            _ => return Err(NcProblem::syntax("a spline without its control point: expected I or J")),
        };
        let degree = points.len() - 1;
        let bend = points
            .windows(3)
            .map(|p| (p[0][0] - 2.0 * p[1][0] + p[2][0]).hypot(p[0][1] - 2.0 * p[1][1] + p[2][1]))
            .fold(0.0, f64::max);
        let second = (degree * (degree - 1)) as f64 * bend;
        let chords = (second / (8.0 * self.track.arc_tolerance)).sqrt().ceil().max(1.0);
        if chords > 1e6 {
            return Err(NcProblem::value(
                "the number of chords of this spline",
                chords,
                "at most 1000000",
            ));
        }
        self.track
            .note("splines are divided into chords within the tolerance of arcs");
        for k in 1..=chords as usize {
            let t = k as f64 / chords;
            let mut level = points.clone();
            // De Casteljau.
            while level.len() > 1 {
                level = level
                    .windows(2)
                    .map(|p| [p[0][0] + t * (p[1][0] - p[0][0]), p[0][1] + t * (p[1][1] - p[0][1])])
                    .collect();
            }
            let mut piece = stroke.share_of(chords as usize);
            if k < chords as usize {
                piece.end = [level[0][0], level[0][1], start[2]];
            }
            self.give(piece)?;
        }
        Ok(())
    }
}
