//! Courses of edges between their ends: a line, a circle or an ellipse where one fits, otherwise a spline.

use super::curve::{Curve, Edge, hermite};
use crate::chart::wrapped;
use crate::solve::{Condition, meet, sine, tangent};
use crate::surface::Surface;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, TAU};
use sweepsim_dexel::AnalyticSurface as A;

/// Parts in which a course is compared with its surfaces.
const CHECKED: usize = 16;
/// How often the steps along a spline are halved.
const FINER: usize = 5;
/// The most steps along a spline.
const MOST_STEPS: usize = 20_000;
/// Where the sine between surfaces is less, it does not tell the direction of their curve; this far from there, in
/// cells, it does.
const PARALLEL: f64 = 1e-2;
const BESIDE: f64 = 0.02;

/// Points of a curve with its unit tangents.
type PointsAndTangents = (Vec<Vector3<f64>>, Vec<Vector3<f64>>);

/// An edge to be: two surfaces, two ends, and points on its way.
pub(super) struct Course<'a> {
    pub surfaces: [&'a Surface; 2],
    /// Whether they touch there rather than cross.
    pub touch: bool,
    pub vertices: [u32; 2],
    pub ends: [Vector3<f64>; 2],
    /// Points on both surfaces, in order from end to end, up to about a cell.
    pub guides: Vec<Vector3<f64>>,
    /// The length of the chain of edges of the mesh.
    pub length: f64,
    pub cell: f64,
    /// How far it may be from either surface.
    pub tolerance: f64,
}

impl<'a> Course<'a> {
    fn conditions(&self) -> Vec<Condition<'a>> {
        let [a, b] = self.surfaces;
        let mut all = vec![Condition::On(a), Condition::On(b)];
        if self.touch {
            all.push(Condition::Touch(a, b));
        }
        all
    }

    fn is_closed(&self) -> bool {
        self.vertices[0] == self.vertices[1]
    }

    /// The edge, if one is found.
    pub fn edge(&self) -> Option<Edge> {
        let exact = || self.line().or_else(|| self.circle()).or_else(|| self.ellipse());
        exact().or_else(|| self.spline())
    }

    fn with(&self, curve: Curve) -> Edge {
        Edge {
            vertices: self.vertices,
            ends: self.ends,
            curve,
        }
    }

    /// The edge with a curve, if that is on both surfaces.
    fn checked(&self, curve: Curve) -> Option<Edge> {
        let edge = self.with(curve);
        let near = (0..=CHECKED).all(|k| {
            let p = edge.at(k as f64 / CHECKED as f64);
            self.surfaces.iter().all(|surface| surface.off(p) <= self.tolerance)
        });
        near.then_some(edge)
    }

    fn line(&self) -> Option<Edge> {
        let [from, to] = self.ends;
        let along = (to - from).try_normalize(1e-9 * self.cell)?;
        let straight = self.guides.iter().all(|guide| {
            let off = guide - from;
            (off - along * along.dot(&off)).norm() <= 0.2 * self.cell
        });
        if straight { self.checked(Curve::Line) } else { None }
    }

    /// The guide in the middle of the way, or a point made for it.
    fn middle(&self) -> Option<Vector3<f64>> {
        let [from, to] = self.ends;
        let nearest = |p: &Vector3<f64>| (p - from).norm().min((p - to).norm());
        let best = self.guides.iter().max_by(|a, b| nearest(a).total_cmp(&nearest(b)));
        match best.filter(|guide| nearest(guide) > 0.2 * (to - from).norm()) {
            Some(guide) => Some(*guide),
            None => meet((from + to) * 0.5, &self.conditions(), self.cell).map(|(p, _)| p),
        }
    }

    /// How far the way turns in a plane about a centre, with x towards its start: with sign.
    fn turning(&self, centre: Vector3<f64>, x: Vector3<f64>, y: Vector3<f64>, stretch: f64) -> Option<f64> {
        let angle = |p: &Vector3<f64>| {
            let off = p - centre;
            (y.dot(&off) * stretch).atan2(x.dot(&off))
        };
        let way = self.guides.iter().chain([&self.ends[1]]);
        let (mut last, mut total) = (angle(&self.ends[0]), 0.0);
        for p in way {
            let next = angle(p);
            total += wrapped(next - last);
            last = next;
        }
        if self.is_closed() {
            // The guides went round once.
            return (total.abs() > 0.75 * TAU).then_some(TAU.copysign(total));
        }
        let ends = wrapped(angle(&self.ends[1]) - angle(&self.ends[0]));
        let whole = ends + TAU * ((total - ends) / TAU).round();
        (whole.abs() < TAU && (whole - total).abs() < FRAC_PI_2).then_some(whole)
    }

    /// Three points of the way, the first of them its start.
    fn three(&self) -> Option<[Vector3<f64>; 3]> {
        let [from, to] = self.ends;
        if self.is_closed() {
            let third = self.guides.len() / 3;
            Some([from, *self.guides.get(third)?, *self.guides.get(2 * third)?])
        } else {
            Some([from, self.middle()?, to])
        }
    }

    fn circle(&self) -> Option<Edge> {
        let [from, b, c] = self.three()?;
        // The centre of the circle through three points.
        let (u, v) = (b - from, c - from);
        let normal = u.cross(&v);
        let square = normal.norm_squared();
        let small = 1e-9 * u.norm_squared() * v.norm_squared();
        if !(square > small) {
            return None;
        }
        let off = (normal.cross(&u) * v.norm_squared() + v.cross(&normal) * u.norm_squared()) / (2.0 * square);
        let (centre, radius) = (from + off, off.norm());
        let (towards, axis) = (-off / radius, normal.normalize());
        let angle = self.turning(centre, towards, axis.cross(&towards), 1.0)?;
        let axis = if angle < 0.0 { -axis } else { axis };
        self.checked(Curve::Circle {
            centre,
            axis,
            towards,
            radius,
            angle: angle.abs(),
        })
        .filter(|edge| (edge.at(1.0) - self.ends[1]).norm() <= self.tolerance)
    }

    /// Where a plane cuts a cylinder: one of the surfaces, or that of the edge itself, as where cylinders of one radius
    /// cross.
    fn ellipse(&self) -> Option<Edge> {
        let [a, b] = self.surfaces.map(|surface| match surface {
            Surface::Analytic(surface) => Some(*surface),
            _ => None,
        });
        let (normal, of, cylinder) = match (a?, b?) {
            (A::Plane { origin, normal }, cylinder) | (cylinder, A::Plane { origin, normal }) => {
                (Vector3::from(normal), Vector3::from(origin), cylinder)
            }
            (cylinder, A::Cylinder { .. }) => {
                let [from, b, c] = self.three()?;
                (
                    (b - from)
                        .cross(&(c - from))
                        .try_normalize(1e-9 * self.cell * self.cell)?,
                    from,
                    cylinder,
                )
            }
            _ => return None,
        };
        let A::Cylinder { origin, axis, radius } = cylinder else {
            return None;
        };
        let (origin, axis) = (Vector3::from(origin), Vector3::from(axis));
        let cosine = normal.dot(&axis);
        let long = (axis - normal * cosine).try_normalize(1e-9)?;
        if cosine.abs() < 1e-6 {
            return None;
        }
        let centre = origin + axis * (normal.dot(&(of - origin)) / cosine);
        let half = [radius / cosine.abs(), radius];
        let stretch = half[0] / half[1];
        let angle = self.turning(centre, long, normal.cross(&long), stretch)?;
        let normal = if angle < 0.0 { -normal } else { normal };
        let off = self.ends[0] - centre;
        let start = (normal.cross(&long).dot(&off) * stretch).atan2(long.dot(&off));
        self.checked(Curve::Ellipse {
            centre,
            axis: normal,
            long,
            half,
            range: [start, start + angle.abs()],
        })
        .filter(|edge| (edge.at(1.0) - self.ends[1]).norm() <= self.tolerance)
    }

    fn spline(&self) -> Option<Edge> {
        let mut step = 0.5 * self.cell;
        for _ in 0..FINER {
            if let Some((points, tangents)) = self.trace(step)
                && let Some(edge) = self.checked_spline(&points, &tangents)
            {
                return Some(edge);
            }
            step *= 0.5;
        }
        None
    }

    fn checked_spline(&self, points: &[Vector3<f64>], tangents: &[Vector3<f64>]) -> Option<Edge> {
        let near = |guide: &Vector3<f64>| points.iter().any(|p| (p - guide).norm() <= self.cell);
        if !self.guides.iter().all(near) {
            return None;
        }
        let curve = hermite(points, tangents);
        let Curve::Spline { knots, .. } = &curve else {
            return None;
        };
        let last = *knots.last()?;
        let middles: Vec<f64> = knots.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]) / last).collect();
        let edge = self.with(curve);
        let fits = middles.iter().all(|part| {
            let p = edge.at(*part);
            self.surfaces.iter().all(|surface| surface.off(p) <= self.tolerance)
        });
        fits.then_some(edge)
    }

    /// The direction of the curve at an end, away from it. Where the surfaces touch at the end only, their normals do
    /// not tell, but those a little farther on.
    fn way_at(&self, end: Vector3<f64>, ahead: Vector3<f64>) -> Option<Vector3<f64>> {
        let conditions = self.conditions();
        let way_at = |p: Vector3<f64>| {
            let way = tangent(p, &conditions, self.cell)?;
            Some(if way.dot(&ahead) < 0.0 { -way } else { way })
        };
        let [a, b] = self.surfaces;
        if self.touch || sine(a, b, end).is_some_and(|sine| sine >= PARALLEL) {
            return way_at(end);
        }
        let off = ahead.try_normalize(0.0)? * (BESIDE * self.cell);
        let (near, _) = meet(end + off, &conditions, self.cell)?;
        let (far, _) = meet(near + (near - end), &conditions, self.cell)?;
        (way_at(near)? * 2.0 - way_at(far)?).try_normalize(0.5)
    }

    /// Points of the curve with its tangents, from end to end.
    fn trace(&self, step: f64) -> Option<PointsAndTangents> {
        let conditions = self.conditions();
        let [from, to] = self.ends;
        let most = (4.0 * self.length / step) as usize + 20;
        let ahead = self
            .guides
            .iter()
            .chain([&to])
            .find(|guide| (*guide - from).norm() > 0.75 * self.cell);
        let ahead = ahead.unwrap_or(&to) - from;
        let mut way = self.way_at(from, ahead)?;
        let (mut points, mut tangents) = (vec![from], vec![way]);
        let mut p = from;
        while points.len() < most.min(MOST_STEPS) {
            let rest = to - p;
            let far = rest.norm();
            if (points.len() > 4 || !self.is_closed()) && far <= 1.3 * step && rest.dot(&way) >= 0.0 {
                let last = -self.way_at(to, p - to)?;
                // Where the end is all but reached already, it takes the place of the last point.
                if far < 0.2 * step && points.len() > 1 {
                    points.pop();
                    tangents.pop();
                }
                points.push(to);
                tangents.push(last);
                return Some((points, tangents));
            }
            let (next, off) = meet(p + way * step, &conditions, step)?;
            let gone = (next - p).norm();
            if off > self.tolerance || !(gone > 0.3 * step && gone < 2.0 * step) {
                return None;
            }
            let turned = tangent(next, &conditions, self.cell)?;
            way = if turned.dot(&way) < 0.0 { -turned } else { turned };
            p = next;
            points.push(p);
            tangents.push(way);
        }
        None
    }
}
