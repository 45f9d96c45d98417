//! A tool as convex solids of revolution that cover it.
//!
//! The outline is cut where it turns back: at reflex corners, and along concave arcs and splines at points so near to
//! each other that chords do. The hull of each stretch and of its projection to the axis covers all of the tool that is
//! nearer to the axis at the heights of the stretch, and every point of the tool is. For a tool whose outline rises all
//! the way and has no concave curves, the hulls are the tool.

use super::convex::{Convex, ConvexArc, Piece};
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim_motion::{MeridianCurve, MeridianShape, Tool};

/// Two directions closer than this, in radians, are one.
const SAME: f64 = 1e-9;

/// The convex solids that cover a tool, with nothing farther than `tolerance` from it where its outline is concave.
///
/// A tool without a profile is covered by [hulls](sweepsim_motion::Bounds::hulls) of its surface.
#[must_use]
pub fn cover(tool: &Tool, tolerance: f64) -> Vec<Convex> {
    let curves = tool.meridians();
    if curves.is_empty() {
        return hulls(tool);
    }
    // If it does, something may be between the outline and the axis that is none of the tool.
    let falls = curves.iter().any(falls);
    let mut cover: Vec<Convex> = Vec::new();
    let mut stretch = Stretch::new(curves[0].from);
    let mut before: Option<[f64; 2]> = None;
    for curve in &curves {
        if before.is_some_and(|before| turn(before, curve.directions[0]) < -SAME) {
            cover.extend(stretch.close());
            stretch = Stretch::new(curve.from);
        }
        if is_convex(curve) {
            stretch.add(curve);
        } else {
            cover.extend(stretch.close());
            let all = pieces(curve, tolerance);
            let count = all.len();
            for points in all {
                stretch = Stretch::new(points[0]);
                stretch.convex.corners.extend(&points);
                stretch.convex.pieces = vec![Piece::Points(points)];
                (stretch.convex.exact, stretch.convex.cut) = (false, [1, count]);
                cover.extend(stretch.close());
            }
            stretch = Stretch::new(curve.to);
        }
        before = Some(curve.directions[1]);
    }
    cover.extend(stretch.close());
    cover.iter_mut().for_each(|convex| convex.exact &= !falls);
    cover
}

/// Whether a curve leads down again somewhere.
fn falls(curve: &MeridianCurve) -> bool {
    let is_below = |d: &[f64; 2]| d[1] < -SAME;
    match curve.shape {
        // Its direction may turn beyond those at its ends.
        MeridianShape::Arc { sweep, .. } => curve.directions.iter().any(is_below) || sweep.abs() > PI + SAME,
        MeridianShape::Line => curve.directions.iter().any(is_below),
        _ => true,
    }
}

/// By how much the direction turns to the left, in radians.
fn turn(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

fn is_convex(curve: &MeridianCurve) -> bool {
    match curve.shape {
        MeridianShape::Line => true,
        MeridianShape::Arc { sweep, .. } => sweep > 0.0,
        _ => false,
    }
}

/// A stretch of the outline that turns left all the way.
struct Stretch {
    convex: Convex,
}

impl Stretch {
    fn new(from: [f64; 2]) -> Self {
        let convex = Convex {
            corners: vec![from],
            exact: true,
            cut: [0, 1],
            ..Convex::default()
        };
        Self { convex }
    }

    fn add(&mut self, curve: &MeridianCurve) {
        let convex = &mut self.convex;
        convex.corners.push(curve.to);
        convex.cut[0] += 1;
        let MeridianShape::Arc {
            centre,
            radius,
            start,
            sweep,
        } = curve.shape
        else {
            convex.pieces.push(Piece::Line([curve.from, curve.to]));
            return;
        };
        // An arc is not divided for the sake of rounding.
        let count = (sweep / FRAC_PI_2 - SAME).ceil().max(1.0);
        for part in 0..count as usize {
            let angles = [part, part + 1].map(|k| start + sweep * k as f64 / count);
            convex.pieces.push(Piece::Arc { centre, radius, angles });
            let normals = angles.map(|angle| [angle.cos(), angle.sin()]);
            convex.arcs.push(ConvexArc {
                centre,
                radius,
                normals,
            });
            let join = start + sweep * (part + 1) as f64 / count;
            convex
                .corners
                .push([centre[0] + radius * join.cos(), centre[1] + radius * join.sin()]);
        }
    }

    /// The hull with the axis at the same heights; nothing of a stretch without length.
    fn close(&mut self) -> Option<Convex> {
        let mut convex = std::mem::take(&mut self.convex);
        if convex.corners.len() < 2 {
            return None;
        }
        let [low, high] = convex.heights();
        convex.corners.extend([[0.0, low], [0.0, high]]);
        // Points inside the hull of the others cost time: the support of a hull is that of its extreme points.
        convex.corners = extreme(convex.corners);
        Some(convex)
    }
}

/// The corners of the hull of points, counter-clockwise (Andrew's monotone chain).
fn extreme(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                let area = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                // Only what is certainly inside is left out.
                if area >= 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    let mut above = half(&mut points.iter().rev().copied());
    // Both begin and end at the same two points.
    hull.pop();
    above.pop();
    hull.extend(above);
    hull
}

/// Points whose hulls cover a curve, in equal parts, none wider than the tolerance.
fn pieces(curve: &MeridianCurve, tolerance: f64) -> Vec<Vec<[f64; 2]>> {
    match curve.shape {
        MeridianShape::Arc {
            centre,
            radius,
            start,
            sweep,
        } => {
            // The material is outside of the circle, and so are the chords' ends; between them, chords are inside.
            let step = 2.0 * (1.0 - (tolerance / radius).min(1.0)).acos();
            let count = (sweep.abs() / step.min(1.5)).ceil().clamp(1.0, MOST_PARTS as f64);
            let at = |k: f64, r: f64| {
                let angle = start + sweep * k / count;
                [centre[0] + r * angle.cos(), centre[1] + r * angle.sin()]
            };
            // The lines that touch the arc at both ends of a part meet at this distance.
            let apex = radius / (0.5 * sweep / count).cos();
            let part = |k: f64| vec![at(k, radius), at(k + 0.5, apex), at(k + 1.0, radius)];
            (0..count as usize).map(|k| part(k as f64)).collect()
        }
        _ => {
            let points = |piece: &Vec<Control>| piece.iter().map(|(point, _)| *point).collect::<Vec<_>>();
            let mut all = vec![curve.controls.clone()];
            while all.len() < MOST_PARTS && all.iter().any(|piece| thickness(&points(piece)) > tolerance) {
                let halves = |piece: &Vec<Control>| <[_; 2]>::from(halves(piece));
                all = all.iter().flat_map(halves).collect();
            }
            all.iter().map(points).collect()
        }
    }
}

/// A curve has no more parts.
const MOST_PARTS: usize = 1 << 12;

/// How far the points are from the line between the first and the last.
fn thickness(points: &[[f64; 2]]) -> f64 {
    let (a, b) = (points[0], points[points.len() - 1]);
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]);
    let off = |p: &[f64; 2]| {
        let p = [p[0] - a[0], p[1] - a[1]];
        (along[0] * p[1] - along[1] * p[0]).abs() / length
    };
    if length > 0.0 {
        points.iter().map(off).fold(0.0, f64::max)
    } else {
        PI
    }
}

type Control = ([f64; 2], f64);

/// Both halves of a rational Bézier curve (de Casteljau).
fn halves(controls: &[Control]) -> (Vec<Control>, Vec<Control>) {
    let middle = |(p, v): &Control, (q, w): &Control| {
        let weight = 0.5 * (v + w);
        ([0, 1].map(|k| 0.5 * (p[k] * v + q[k] * w) / weight), weight)
    };
    let mut row = controls.to_vec();
    let (mut low, mut high) = (vec![row[0]], vec![row[row.len() - 1]]);
    while row.len() > 1 {
        row = row.windows(2).map(|pair| middle(&pair[0], &pair[1])).collect();
        low.push(row[0]);
        high.push(row[row.len() - 1]);
    }
    high.reverse();
    (low, high)
}

/// A tool whose hulls are wider than its cores by more than this part is not known well.
const WIDER: f64 = 0.01;

/// The solids that hold a tool without a profile.
fn hulls(tool: &Tool) -> Vec<Convex> {
    let bounds = tool.bounds();
    let widest = |all: &[Vec<[f64; 2]>]| all.iter().flatten().map(|p| p[0]).fold(0.0, f64::max);
    let loose = widest(&bounds.cores) < (1.0 - WIDER) * widest(&bounds.hulls);
    let hull = |corners: &Vec<[f64; 2]>| Convex {
        corners: corners.clone(),
        loose,
        cut: [corners.len() - 1, 1],
        pieces: corners.windows(2).map(|ends| Piece::Line([ends[0], ends[1]])).collect(),
        ..Convex::default()
    };
    bounds.hulls.iter().map(hull).collect()
}

/// The solids that [cover] a tool that cuts, and convex ones that it holds, if those do not say all of that.
#[must_use]
pub fn cover_and_cores(tool: &Tool, tolerance: f64) -> Vec<Convex> {
    [cover(tool, tolerance), cores(tool)].concat()
}

pub(crate) fn cores(tool: &Tool) -> Vec<Convex> {
    let curves = tool.meridians();
    if !curves.is_empty() && curves.iter().all(|curve| is_convex(curve) && !falls(curve)) {
        return Vec::new();
    }
    let core = |corners: &Vec<[f64; 2]>| Convex {
        corners: corners.clone(),
        exact: true,
        core: true,
        ..Convex::default()
    };
    tool.bounds().cores.iter().map(core).collect()
}
