//! Convex solids of revolution by their support functions, and the check that they cover a tool.

use crate::scene::{Curve, Outline};
use crate::vector::{EPS, MORE, V3, dot, norm, scaled, sub};
use serde::{Deserialize, Serialize};

/// The hull of points and arcs `(ρ, ζ)`, turned about the axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Points, `ρ ≥ 0`.
    pub corners: Vec<[f64; 2]>,
    /// Arcs of at most 90°.
    #[serde(default)]
    pub arcs: Vec<SolidArc>,
}

/// An arc of a [`Solid`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidArc {
    /// The centre.
    pub centre: [f64; 2],
    /// The radius.
    pub radius: f64,
    /// The unit normals at its ends, counter-clockwise.
    pub normals: [[f64; 2]; 2],
}

/// A solid that is ready for use.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    solid: Solid,
    /// No point is farther from the tip.
    pub reach: f64,
    /// Taken larger by this: what it covers may be this far off.
    slack: f64,
}

type P2 = [f64; 2];

fn dot2(a: P2, b: P2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross2(a: P2, b: P2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn apart(a: P2, b: P2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

impl Body {
    /// `None` if it is no such solid.
    fn new(solid: &Solid) -> Option<Self> {
        let mut solid = solid.clone();
        for arc in &solid.arcs {
            let [from, to] = arc.normals;
            let are_units = [from, to].iter().all(|n| (dot2(*n, *n) - 1.0).abs() < 1e-14);
            if !are_units || cross2(from, to) < 0.0 || dot2(from, to) < -1e-9 || !(arc.radius > 0.0) {
                return None;
            }
            // The ends of arcs are points, too.
            let end = |n: P2| [0, 1].map(|k| arc.centre[k] + arc.radius * n[k]);
            solid.corners.extend([end(from), end(to)]);
        }
        let corners = solid.corners.iter().map(|p| p[0].hypot(p[1]));
        let arcs = solid
            .arcs
            .iter()
            .map(|arc| arc.centre[0].hypot(arc.centre[1]) + arc.radius);
        let reach = corners.chain(arcs).fold(0.0, f64::max) * MORE;
        // What is as near as rounding is one point, within the slack.
        let mut kept: Vec<P2> = Vec::new();
        for corner in &solid.corners {
            if kept.iter().all(|other| apart(*other, *corner) > 8.0 * EPS * reach) {
                kept.push(*corner);
            }
        }
        solid.corners = kept;
        let is_good = reach.is_finite() && solid.corners.iter().all(|p| p[0] >= -8.0 * EPS * reach);
        (is_good && !solid.corners.is_empty()).then_some(Self {
            solid,
            reach,
            slack: 32.0 * EPS * reach,
        })
    }

    /// How far it reaches along `n`, from the tip: not less than the largest `⟨n, x⟩`. `error`: of the axis.
    ///
    /// With the parts `α` along and `β ≥ 0` across the axis, that is the largest `β ρ + α ζ`. It changes no
    /// faster than `reach` times the direction; `α` and `β` are off by twice the error of the axis, and by
    /// roundings.
    pub fn support_up(&self, n: &V3, axis: &V3, error: f64) -> f64 {
        let along = dot(n, axis);
        let across = sub(n, &scaled(axis, along));
        let length = norm(n);
        let own = [norm(&across), along];
        let off = self.reach * length * (4.0 * error + 64.0 * EPS);
        self.meridian(own, length) + off + self.slack * length
    }

    fn meridian(&self, d: P2, length: f64) -> f64 {
        let corners = self.solid.corners.iter().map(|corner| dot2(d, *corner));
        let mut best = corners.fold(f64::NEG_INFINITY, f64::max);
        for arc in &self.solid.arcs {
            let [from, to] = arc.normals;
            let near = -1e-12 * length;
            // The whole circle reaches at least as far: the test need not be exact, if it is wide enough.
            if cross2(from, d) >= near && cross2(d, to) >= near && dot2(d, from) + dot2(d, to) > 0.0 {
                best = best.max(dot2(d, arc.centre) + arc.radius * length);
            }
        }
        best
    }

    /// How far a point is from the hull of the corners: any triangle of corners is in it.
    fn off(&self, p: P2) -> f64 {
        let corners = &self.solid.corners;
        let (first, last) = (corners[0], corners[corners.len() - 1]);
        let edges = corners.windows(2).map(|pair| to_segment(p, pair[0], pair[1]));
        let nearest = edges.fold(to_segment(p, last, first), f64::min);
        let inside = corners.windows(2).skip(1).any(|pair| {
            let sides = [(first, pair[0]), (pair[0], pair[1]), (pair[1], first)];
            let sides = sides.map(|(a, b)| cross2([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        });
        if inside { 0.0 } else { nearest }
    }
}

fn to_segment(p: P2, a: P2, b: P2) -> f64 {
    let (along, off) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let part = (dot2(off, along) / dot2(along, along).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (off[0] - along[0] * part).hypot(off[1] - along[1] * part)
}

/// A part of a curve of an outline.
#[derive(Clone)]
enum Part {
    Points(Vec<(P2, f64)>),
    Arc { centre: P2, radius: f64, angles: [f64; 2] },
}

impl Part {
    /// Points whose hull holds it.
    fn around(&self) -> Vec<P2> {
        match self {
            Self::Points(controls) => controls.iter().map(|(point, _)| *point).collect(),
            Self::Arc { centre, radius, angles } => {
                let at = |angle: f64, r: f64| [centre[0] + r * angle.cos(), centre[1] + r * angle.sin()];
                let [from, to] = *angles;
                let apex = radius / (0.5 * (to - from)).cos();
                vec![at(from, *radius), at(0.5 * (from + to), apex), at(to, *radius)]
            }
        }
    }

    fn halves(&self) -> [Self; 2] {
        match self {
            Self::Points(controls) => {
                // de Casteljau, with weights.
                let (mut row, mut low, mut high) = (controls.clone(), Vec::new(), Vec::new());
                while let (Some(first), Some(last)) = (row.first(), row.last()) {
                    low.push(*first);
                    high.push(*last);
                    row = row
                        .windows(2)
                        .map(|pair| {
                            let [(p, v), (q, w)] = [pair[0], pair[1]];
                            let weight = 0.5 * (v + w);
                            ([0, 1].map(|k| 0.5 * (p[k] * v + q[k] * w) / weight), weight)
                        })
                        .collect();
                }
                high.reverse();
                [Self::Points(low), Self::Points(high)]
            }
            Self::Arc { centre, radius, angles } => {
                let middle = 0.5 * (angles[0] + angles[1]);
                [[angles[0], middle], [middle, angles[1]]].map(|angles| Self::Arc {
                    centre: *centre,
                    radius: *radius,
                    angles,
                })
            }
        }
    }
}

/// Parts of curves are halved so often.
const HALVINGS: usize = 48;

/// The solids, ready for use, if they cover a tool; otherwise what is wrong.
///
/// Every point of a tool of revolution has a point of the outline beside it, as high and no nearer to the axis. So it
/// is in a convex solid that holds that part of the outline, and the axis as high as that. Each part of the outline is
/// looked for in the solids, with the hull of its control points, or, if it is an arc, among the arcs of the solids.
/// What is off by less than 1e-12 of the tool is added to the solids.
pub(crate) fn covering(outline: &Outline, solids: &[Solid]) -> Result<Vec<Body>, String> {
    let bodies: Option<Vec<Body>> = solids.iter().map(Body::new).collect();
    let mut bodies = bodies.ok_or("a solid of a tool is none")?;
    let reach = bodies.iter().map(|body| body.reach).fold(0.0, f64::max);
    let mut cover = Cover {
        bodies: &bodies,
        near: 1e-12 * reach,
        slack: 0.0,
    };
    let points: Vec<_> = outline.points.iter().map(|p| (*p, 1.0)).collect();
    if outline.curves.is_empty() {
        // They are not those of a curve: not to be halved.
        let is_held = !points.is_empty() && cover.holds(&Part::Points(points), HALVINGS);
        is_held.then_some(()).ok_or("a tool is not in its solid")?;
    }
    let mut before: P2 = [0.0; 2];
    for (number, curve) in outline.curves.iter().enumerate() {
        let [from, to] = ends(curve).ok_or("a curve of a tool has no points")?;
        let joins = if number == 0 { from[0] } else { apart(before, from) };
        if !(joins.abs() <= 1e-9 * reach) {
            return Err("the outline of a tool has a gap".into());
        }
        before = to;
        if !cover.holds_curve(curve) {
            return Err(format!(
                "the outline of a tool is not covered near ({}, {})",
                from[0], from[1]
            ));
        }
    }
    if !outline.curves.is_empty() && !(before[0].abs() <= 1e-9 * reach) {
        return Err("the outline of a tool does not end on its axis".into());
    }
    let slack = cover.slack * MORE;
    bodies.iter_mut().for_each(|body| body.slack += slack);
    Ok(bodies)
}

fn ends(curve: &Curve) -> Option<[P2; 2]> {
    Some(match curve {
        Curve::Line(ends) | Curve::Arc { ends, .. } => *ends,
        Curve::Bezier(controls) => [controls.first()?.0, controls.last()?.0],
    })
}

struct Cover<'a> {
    bodies: &'a [Body],
    near: f64,
    /// The largest distance so far.
    slack: f64,
}

impl Cover<'_> {
    fn holds_curve(&mut self, curve: &Curve) -> bool {
        match curve {
            Curve::Line(ends) => self.holds(&Part::Points(ends.map(|end| (end, 1.0)).to_vec()), 0),
            Curve::Bezier(controls) => {
                controls.iter().all(|(_, weight)| *weight > 0.0) && self.holds(&Part::Points(controls.clone()), 0)
            }
            Curve::Arc {
                ends,
                centre,
                radius,
                start,
                sweep,
            } => {
                let at = |angle: f64| [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()];
                let off = apart(at(*start), ends[0]).max(apart(at(start + sweep), ends[1]));
                // Rounding of large circles, and of what a program says.
                if !(off <= 1e-9 * (1.0 + radius) && sweep.abs() < 6.3) {
                    return false;
                }
                self.has_arc(*centre, *radius, [*start, start + sweep]) || {
                    let count = (sweep.abs() / 1.5).ceil().max(1.0);
                    (0..count as usize).all(|k| {
                        let angles = [k, k + 1].map(|k| start + sweep * k as f64 / count);
                        let (centre, radius) = (*centre, *radius);
                        self.holds(&Part::Arc { centre, radius, angles }, 0)
                    })
                }
            }
        }
    }

    /// Whether a part, and the axis beside it, are in one of the solids, or its halves are.
    fn holds(&mut self, part: &Part, halvings: usize) -> bool {
        let points = part.around();
        let best = self.bodies.iter().map(|body| off_with_axis(body, &points));
        let best = best.fold(f64::INFINITY, f64::min);
        if best <= self.near {
            self.slack = self.slack.max(best);
            return true;
        }
        halvings < HALVINGS && part.halves().iter().all(|half| self.holds(half, halvings + 1))
    }

    /// Whether an arc consists of arcs of the solids, one after the other.
    fn has_arc(&mut self, centre: P2, radius: f64, [from, to]: [f64; 2]) -> bool {
        let direction = |angle: f64| [angle.cos(), angle.sin()];
        let (mut at, end) = (direction(from), direction(to));
        let (mut slack, mut turned) = (0.0_f64, 0.0);
        for step in 0..8 {
            if step > 0 && apart(at, end) * radius <= self.near && (turned - (to - from)).abs() < 1e-6 {
                self.slack = self.slack.max(slack + apart(at, end) * radius);
                return true;
            }
            let next = self.bodies.iter().find_map(|body| {
                body.solid.arcs.iter().find_map(|arc| {
                    let off =
                        apart(arc.centre, centre) + (arc.radius - radius).abs() + radius * apart(arc.normals[0], at);
                    let heights = heights(arc);
                    let axis = off_with_axis(body, &heights.map(|height| [0.0, height]));
                    (off.max(axis) <= self.near).then_some((off + axis, arc.normals[1]))
                })
            });
            let Some((off, next)) = next else { return false };
            turned += cross2(at, next).atan2(dot2(at, next));
            (slack, at) = (slack.max(off), next);
        }
        false
    }
}

/// The lowest and the highest point of an arc.
fn heights(arc: &SolidArc) -> [f64; 2] {
    let [from, to] = arc.normals;
    let mut all = [from[1].min(to[1]), from[1].max(to[1])];
    // Straight down or up between its ends, which are at most 90° apart.
    for (k, way) in [(0, [0.0, -1.0]), (1, [0.0, 1.0])] {
        if cross2(from, way) >= 0.0 && cross2(way, to) >= 0.0 && dot2(way, from) + dot2(way, to) > 0.0 {
            all[k] = way[1];
        }
    }
    all.map(|height| arc.centre[1] + arc.radius * height)
}

/// How far points, and the axis beside them, are from a solid.
fn off_with_axis(body: &Body, points: &[P2]) -> f64 {
    let low = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let high = points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
    let own = points.iter().copied().chain([[0.0, low], [0.0, high]]);
    own.map(|p| body.off(p)).fold(0.0, f64::max)
}

/// How far a point is from a tool, at most: 0 if it is inside. Not known of curves other than lines and arcs.
pub(crate) fn off_tool(outline: &Outline, [rho, zeta]: P2) -> f64 {
    let (nearest, is_inside) = beside(outline, [rho, zeta]);
    // Where curves meet at this height, they might be counted wrong: not a little above and below as well.
    let near = 1e-9 * (rho.abs() + zeta.abs());
    let all = [zeta - near, zeta + near]
        .iter()
        .all(|zeta| beside(outline, [rho, *zeta]).1);
    if is_inside && all { 0.0 } else { nearest }
}

/// How far the outline is from a point, and whether it is an odd number of times beyond it at the same height.
fn beside(outline: &Outline, [rho, zeta]: P2) -> (f64, bool) {
    let (mut nearest, mut beyond) = (f64::INFINITY, 0);
    for curve in &outline.curves {
        match curve {
            Curve::Line([from, to]) => {
                nearest = nearest.min(to_segment([rho, zeta], *from, *to));
                if (from[1] <= zeta) != (to[1] <= zeta) {
                    let part = (zeta - from[1]) / (to[1] - from[1]);
                    beyond += usize::from(from[0] + (to[0] - from[0]) * part > rho);
                }
            }
            Curve::Arc {
                ends,
                centre,
                radius,
                start,
                sweep,
            } => {
                let off = [rho - centre[0], zeta - centre[1]];
                let turned = |angle: f64| ((angle - start) * sweep.signum()).rem_euclid(std::f64::consts::TAU);
                nearest = nearest
                    .min(apart([rho, zeta], ends[0]))
                    .min(apart([rho, zeta], ends[1]));
                if turned(off[1].atan2(off[0])) <= sweep.abs() {
                    nearest = nearest.min((off[0].hypot(off[1]) - radius).abs());
                }
                // Both places where the circle is as high.
                let height = off[1] / radius;
                if height.abs() < 1.0 {
                    let angle = height.asin();
                    for angle in [angle, std::f64::consts::PI - angle] {
                        let is_on = turned(angle) < sweep.abs();
                        beyond += usize::from(is_on && centre[0] + radius * angle.cos() > rho);
                    }
                }
            }
            Curve::Bezier(_) => return (f64::INFINITY, false),
        }
    }
    (nearest, beyond % 2 == 1)
}
