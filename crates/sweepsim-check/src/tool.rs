//! Tools of revolution, as convex solids that cover them, and what is certainly inside of a tool.
//!
//! **Cover.** A point of a tool has a point of the outline as high and no nearer to the axis. So it is in the hull of
//! any set that holds that part of the outline, and of the axis beside it, turned about the axis. A certificate says
//! which curves of the outline make one solid, or into how many parts a curve is cut; the solids are made here.
//!
//! **Inside.** Of what it holds, a tool may have convex polygons, turned about the axis. If the outline never falls,
//! the tool is all that is nearer to the axis than it: where consecutive lines and arcs of it turn left, the tool
//! beside them is convex, and what is between points in it is in it.

use crate::scene::Curve;
use crate::vector::{EPS, MORE, V3, dot, norm, scaled, sub};
use std::f64::consts::{FRAC_PI_2, PI};

pub(crate) type P2 = [f64; 2];

/// The hull of corners and arcs `(ρ, ζ)`, turned about the axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Body {
    corners: Vec<P2>,
    arcs: Vec<Arc>,
    /// No point is farther from the tip.
    pub reach: f64,
    /// The lowest and the highest `ζ`.
    pub heights: [f64; 2],
    /// Its part of the outline, from the tip to the top.
    pub pieces: Vec<Piece>,
    /// What it is between, if it is part of the tool.
    sides: Option<Sides>,
}

/// An arc, or a corner with a radius of 0: its centre, its radius, and the unit normals at its ends, counter-clockwise.
#[derive(Clone, Debug)]
struct Arc(P2, f64, [P2; 2]);

/// Arcs and corners, and lines: points on them, and their normals.
type Sides = (Vec<Arc>, Vec<(P2, P2)>);

/// A part of an outline.
#[derive(Clone, Debug)]
pub(crate) enum Piece {
    /// In the hull of some points: two are a line.
    Points(Vec<P2>),
    /// An arc of at most 90° around the first, with a radius, between two angles.
    Arc(P2, f64, P2),
}

/// The solids of something that cuts, its path, and the motions on which it does: numbers of the path's.
pub(crate) type Cutting<'a> = (&'a [Body], usize, Vec<usize>);

fn dot2(a: P2, b: P2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross2(a: P2, b: P2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The solids of an outline, for each entry of a cover: so many curves together, or one in so many parts.
pub(crate) fn bodies(outline: &[Curve], cover: &[[usize; 2]]) -> Result<Vec<Body>, String> {
    let (mut all, mut at) = (Vec::new(), 0_usize);
    let rises = outline
        .iter()
        .all(|curve| directions(curve).is_some_and(|ends| ends.iter().all(|d| d[1] >= -STRAIGHT)));
    for [count, parts] in cover {
        let end = at.saturating_add(*count);
        let curves = outline.get(at..end).ok_or("a cover has more curves than its tool")?;
        for part in 0..*parts {
            let mut body = Body::default();
            for curve in curves {
                body.add(curve, part, *parts)
                    .ok_or("a curve of a tool is none, or is not cut into enough parts")?;
            }
            let mut body = body.closed().ok_or("a solid of a tool is none")?;
            if *parts == 1 && rises && turns_left(curves) {
                body.sides = sides(curves);
            }
            all.push(body);
        }
        at = if *parts == 1 || *parts > 1 && *count == 1 {
            end
        } else {
            usize::MAX
        };
    }
    (at == outline.len() && !all.is_empty())
        .then_some(all)
        .ok_or("a cover does not cover its tool".into())
}

/// Convex solids, of their corners.
pub(crate) fn cores(all: &[Vec<P2>]) -> Result<Vec<Body>, String> {
    let core = |corners: &Vec<P2>| {
        let line = |ends: &[P2]| Curve::Bezier(ends.iter().map(|end| (*end, 1.0)).collect());
        let lines: Vec<Curve> = corners.windows(2).map(line).collect();
        let body = bodies(&lines, &[[lines.len(), 1]]).ok()?.pop()?;
        let is_whole = corners.len() > 2 && corners[0][0] == 0.0 && corners.last()?[0] == 0.0;
        // Nothing leads from one into another.
        (is_whole && body.sides.is_some()).then(|| Body {
            pieces: Vec::new(),
            ..body
        })
    };
    let all = all.iter().map(core).collect::<Option<_>>();
    all.ok_or("a core of a tool is not convex".into())
}

/// A cylinder between two solids is narrower than the tool by this part.
const NARROWER: f64 = 1e-9;

/// The solids of a tool, and cylinders that lead from one of them into the next. Both ends of what is below the cut are
/// in the one solid, both ends of what is above in the other: so all of a cylinder is in the tool.
pub(crate) fn bridged(mut bodies: Vec<Body>) -> Vec<Body> {
    let bridges: Vec<Body> = bodies
        .windows(2)
        .filter_map(|pair| bridge(&pair[0], &pair[1]))
        .collect();
    bodies.extend(bridges);
    bodies
}

fn bridge(below: &Body, above: &Body) -> Option<Body> {
    let [rho, seam] = match above.pieces.first()? {
        Piece::Points(points) => *points.first()?,
        Piece::Arc(centre, radius, [angle, _]) => [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()],
    };
    let radius = rho * (1.0 - NARROWER);
    let end = |body: &Body, far: f64| {
        let holds = |z: &f64| body.level([radius, *z]).is_some_and(|level| level <= 0.0);
        let mut ends = (0..16).map(|k| seam + (far - seam) * 0.5_f64.powi(k));
        holds(&seam).then(|| ends.find(holds)).flatten()
    };
    let (low, high) = (end(below, below.heights[0])?, end(above, above.heights[1])?);
    let lines = vec![
        ([radius, seam], [1.0, 0.0]),
        ([0.0, low], [0.0, -1.0]),
        ([0.0, high], [0.0, 1.0]),
    ];
    Some(Body {
        reach: below.reach.max(above.reach),
        sides: Some((Vec::new(), lines)),
        ..Body::default()
    })
}

/// Angles that differ by less are the same: what this is off by is within any [margin](crate::Scene::margin).
const STRAIGHT: f64 = 1e-9;

/// The directions of a line, or of an arc, at its ends.
fn directions(curve: &Curve) -> Option<[P2; 2]> {
    match curve {
        Curve::Bezier(controls) => {
            let [(from, _), (to, _)] = controls[..] else {
                return None;
            };
            let way = [to[0] - from[0], to[1] - from[1]];
            let length = way[0].hypot(way[1]);
            (length > 0.0).then_some([way.map(|c| c / length); 2])
        }
        Curve::Hull(_) => None,
        Curve::Arc { angles, .. } => {
            let way = (angles[1] - angles[0]).signum();
            ((angles[1] - angles[0]).abs() <= PI + STRAIGHT).then_some(angles.map(|a| [-way * a.sin(), way * a.cos()]))
        }
    }
}

/// Whether lines and arcs turn left all the way. They never fall, so their directions go from 0° to 180°.
fn turns_left(curves: &[Curve]) -> bool {
    let ends: Option<Vec<P2>> = curves
        .iter()
        .map(directions)
        .collect::<Option<Vec<_>>>()
        .map(|all| all.concat());
    let rising = |curve: &Curve| !matches!(curve, Curve::Arc { angles, .. } if angles[1] <= angles[0]);
    ends.is_some_and(|all| all.windows(2).all(|pair| cross2(pair[0], pair[1]) >= -STRAIGHT))
        && curves.iter().all(rising)
}

/// What is beside some curves is between their arcs and the lines at their ends. Where they meet, it ends at a corner,
/// and it lies between their lowest and highest points.
fn sides(curves: &[Curve]) -> Option<Sides> {
    let (mut arcs, mut before) = (Vec::new(), [0.0, -1.0]);
    let mut lines: Vec<(P2, P2)> = Vec::new();
    let mut last = [0.0; 2];
    for curve in curves {
        let normals = directions(curve)?.map(|way| [way[1], -way[0]]);
        let ends = match curve {
            Curve::Bezier(controls) => [controls[0].0, controls[1].0],
            Curve::Arc { centre, radius, .. } => normals.map(|n| [0, 1].map(|k| centre[k] + radius * n[k])),
            Curve::Hull(_) => return None,
        };
        if let Curve::Arc { centre, radius, .. } = curve {
            arcs.push(Arc(*centre, *radius, normals));
        }
        lines.extend([(ends[0], before), (ends[0], normals[0]), (ends[1], normals[1])]);
        arcs.push(Arc(ends[0], 0.0, [before, normals[0]]));
        (before, last) = (normals[1], ends[1]);
    }
    arcs.push(Arc(last, 0.0, [before, [0.0, 1.0]]));
    lines.push((last, [0.0, 1.0]));
    Some((arcs, lines))
}

impl Body {
    /// One of the parts of a curve.
    fn add(&mut self, curve: &Curve, part: usize, parts: usize) -> Option<()> {
        let [from, to] = [part, part + 1].map(|k| k as f64 / parts as f64);
        match curve {
            Curve::Bezier(controls) => {
                let last = if to == 1.0 {
                    controls.clone()
                } else {
                    halves(controls, to)[0].clone()
                };
                let own = if from == 0.0 {
                    last
                } else {
                    halves(&last, from / to)[1].clone()
                };
                self.piece(own.iter().map(|(point, _)| *point).collect());
                (!own.is_empty() && controls.iter().all(|(_, weight)| *weight > 1e-6)).then_some(())
            }
            Curve::Hull(points) => {
                self.piece(points.clone());
                (parts == 1).then_some(())
            }
            Curve::Arc { centre, radius, angles } => {
                let at = |angle: f64, r: f64| [centre[0] + r * angle.cos(), centre[1] + r * angle.sin()];
                let [from, to] = [from, to].map(|t| angles[0] + (angles[1] - angles[0]) * t);
                if to <= from {
                    // It is between its chord and the lines that touch it at its ends.
                    let (middle, half) = (0.5 * (from + to), 0.5 * (from - to));
                    self.piece(vec![
                        at(from, *radius),
                        at(middle, radius / half.cos()),
                        at(to, *radius),
                    ]);
                    return (half < 0.8 && *radius > 0.0).then_some(());
                }
                let count = ((to - from) / FRAC_PI_2 - 1e-9).ceil().max(1.0);
                for k in 0..count.min(5.0) as usize {
                    let angles = [k, k + 1].map(|k| from + (to - from) * k as f64 / count);
                    self.pieces.push(Piece::Arc(*centre, *radius, angles));
                    let normals = angles.map(|angle| [angle.cos(), angle.sin()]);
                    self.corners
                        .extend(normals.map(|n| [0, 1].map(|i| centre[i] + radius * n[i])));
                    self.arcs.push(Arc(*centre, *radius, normals));
                }
                (count < 5.0 && *radius > 0.0).then_some(())
            }
        }
    }

    fn piece(&mut self, points: Vec<P2>) {
        self.corners.extend(&points);
        self.pieces.push(Piece::Points(points));
    }

    /// With the axis beside it.
    fn closed(mut self) -> Option<Self> {
        let corners = self.corners.iter().map(|p| p[0].hypot(p[1]));
        let arcs = self
            .arcs
            .iter()
            .map(|Arc(centre, radius, _)| centre[0].hypot(centre[1]) + radius);
        self.reach = corners.chain(arcs).fold(0.0, f64::max) * MORE;
        self.heights = [-self.meridian([0.0, -1.0], 1.0), self.meridian([0.0, 1.0], 1.0)];
        self.corners.extend(self.heights.map(|height| [0.0, height]));
        let is_good = self.reach.is_finite() && self.corners.iter().all(|p| p[0] >= -8.0 * EPS * self.reach);
        is_good.then_some(self)
    }

    /// How far it reaches along `n`, from the tip: not less than the largest `⟨n, x⟩`. `error`: of the axis.
    ///
    /// With the parts `α` along and `β ≥ 0` across the axis, that is the largest `β ρ + α ζ`. It changes no
    /// faster than `reach` times the direction; `α` and `β` are off by twice the error of the axis, and by
    /// roundings, as the corners are.
    pub fn support_up(&self, n: &V3, axis: &V3, error: f64) -> f64 {
        let along = dot(n, axis);
        let length = norm(n);
        let own = [norm(&sub(n, &scaled(axis, along))), along];
        self.meridian(own, length) + self.reach * length * (4.0 * error + 96.0 * EPS)
    }

    fn meridian(&self, d: P2, length: f64) -> f64 {
        let corners = self.corners.iter().map(|corner| dot2(d, *corner));
        let mut best = corners.fold(f64::NEG_INFINITY, f64::max);
        for Arc(centre, radius, [from, to]) in &self.arcs {
            let [from, to] = [*from, *to];
            let near = -1e-12 * length;
            // The whole circle reaches at least as far: the test need not be exact, if it is wide enough.
            if cross2(from, d) >= near && cross2(d, to) >= near && dot2(d, from) + dot2(d, to) > 0.0 {
                best = best.max(dot2(d, *centre) + radius * length);
            }
        }
        best
    }

    /// How far a point is outside, or minus how far it is inside. `None` of a solid that is no part of the tool.
    ///
    /// That is the largest `⟨n, p⟩ − h(n)` over all unit normals `n` of a convex set with the support `h`: those of
    /// lines, and those between the ends of an arc or at a corner, of which the one towards the point is the best.
    pub fn level(&self, p: P2) -> Option<f64> {
        let (arcs, lines) = self.sides.as_ref()?;
        let from = |q: P2| [p[0] - q[0], p[1] - q[1]];
        let beyond = lines.iter().map(|(q, n)| dot2(*n, from(*q)));
        let around = arcs.iter().filter_map(|Arc(centre, radius, [first, last])| {
            let (off, [first, last]) = (from(*centre), [*first, *last]);
            let is_ahead = dot2(first, off) >= 0.0 || dot2(last, off) >= 0.0;
            let is_between = cross2(first, off) >= 0.0 && cross2(off, last) >= 0.0;
            (is_ahead && is_between).then(|| off[0].hypot(off[1]) - radius)
        });
        Some(beyond.chain(around).fold(f64::NEG_INFINITY, f64::max))
    }
}

/// Both parts of a rational Bézier curve (de Casteljau).
fn halves(controls: &[(P2, f64)], t: f64) -> [Vec<(P2, f64)>; 2] {
    let (mut row, mut low, mut high) = (controls.to_vec(), Vec::new(), Vec::new());
    while let (Some(first), Some(last)) = (row.first(), row.last()) {
        low.push(*first);
        high.push(*last);
        let between = |pair: &[(P2, f64)]| {
            let [(p, v), (q, w)] = [pair[0], pair[1]];
            let [v, w] = [v * (1.0 - t), w * t];
            ([0, 1].map(|k| (p[k] * v + q[k] * w) / (v + w)), v + w)
        };
        row = row.windows(2).map(between).collect();
    }
    high.reverse();
    [low, high]
}
