//! Pieces of tools, and surfaces by their measures.

use sweepsim_dexel::AnalyticSurface;
use sweepsim_solid::Surface;

/// A piece of a tool's outline, in distances from its axis and heights above its tip.
#[derive(Clone, Copy, Debug)]
pub(super) enum Piece {
    Line([f64; 2], [f64; 2]),
    Arc {
        centre: [f64; 2],
        radius: f64,
    },
    /// Where two pieces meet.
    Rim([f64; 2]),
}

/// Radii below this, in millimetres, are none.
const LEAST: f64 = 1e-9;

pub(super) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

/// `p + t d`
pub(super) fn along(p: [f64; 3], t: f64, d: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| p[k] + t * d[k])
}

pub(super) fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(v, v).sqrt();
    (length > 0.0 && length.is_finite()).then(|| v.map(|c| c / length))
}

pub(super) fn plane(origin: [f64; 3], normal: [f64; 3]) -> Surface {
    Surface::Analytic(AnalyticSurface::Plane { origin, normal })
}

pub(super) fn cylinder(origin: [f64; 3], axis: [f64; 3], radius: f64) -> Option<Surface> {
    (radius > LEAST).then_some(Surface::Analytic(AnalyticSurface::Cylinder { origin, axis, radius }))
}

pub(super) fn sphere(centre: [f64; 3], radius: f64) -> Surface {
    Surface::Analytic(AnalyticSurface::Sphere { centre, radius })
}

/// A torus that does not cross itself, or the sphere if its middle circle is a point.
pub(super) fn torus(centre: [f64; 3], axis: [f64; 3], major: f64, minor: f64) -> Option<Surface> {
    let major = major.abs();
    if major < LEAST {
        return Some(sphere(centre, minor));
    }
    (major > minor * (1.0 + 1e-9)).then_some(Surface::Analytic(AnalyticSurface::Torus {
        centre,
        axis,
        major,
        minor,
    }))
}

/// What a line from one distance and height to another leaves on its way round an axis through a point: a plane, a
/// cylinder or a cone. Distances may be negative: on the other side of the axis.
pub(super) fn revolved_line(point: [f64; 3], axis: [f64; 3], [r, z]: [f64; 2], [s, w]: [f64; 2]) -> Option<Surface> {
    let (out, up) = (s - r, w - z);
    let size = out.hypot(up);
    if size < LEAST {
        return None;
    }
    if up.abs() < 1e-12 * size {
        return Some(plane(along(point, z, axis), axis));
    }
    if out.abs() < 1e-12 * size {
        return cylinder(point, axis, r.abs());
    }
    // Where the line meets the axis.
    let tip = z - r * up / out;
    let apex = along(point, tip, axis);
    // The half of the line away from there, on whichever side of the axis.
    let middle = 0.5 * (z + w);
    let axis = if middle > tip { axis } else { axis.map(|c| -c) };
    Some(Surface::Analytic(AnalyticSurface::Cone {
        apex,
        axis,
        angle: (out / up).abs().atan(),
    }))
}
