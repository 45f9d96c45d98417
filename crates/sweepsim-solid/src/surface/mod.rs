//! Surfaces that faces can be parts of.

mod elliptic;
mod swept;
mod tensor;

pub use elliptic::EllipticSheet;
use nalgebra::Vector3;
use sweepsim_dexel::AnalyticSurface;
pub use swept::{SweptPiece, SweptSheet};
pub(crate) use tensor::TensorSpline;

/// A surface that a face can be part of.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Surface {
    /// A plane, cylinder, cone, sphere or torus.
    Analytic(AnalyticSurface),
    /// What a circle, or the torus around one, leaves along a straight line.
    Elliptic(EllipticSheet),
    /// What a piece of a tool leaves on a way on which it turns, or winds: written as a B-spline.
    Swept(SweptSheet),
}

/// Surfaces are looked at this far around a point, in parts of a length, to see how they bend.
const STEP: f64 = 1e-4;

impl Surface {
    /// The signed distance of a point, and the direction in which it grows, a unit vector.
    pub(crate) fn at(&self, p: Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
        match self {
            Self::Analytic(surface) => surface.distance(p.into()).map(|(d, grows)| (d, grows.into())),
            Self::Elliptic(sheet) => sheet.distance(p),
            Self::Swept(sheet) => sheet.at(p),
        }
    }

    /// How far a point is from the surface: from the tip of a cone where it is there or beyond it.
    pub(crate) fn off(&self, p: Vector3<f64>) -> f64 {
        match (self.at(p), self) {
            (Some((distance, _)), _) => distance.abs(),
            (None, Self::Analytic(AnalyticSurface::Cone { apex, .. })) => (p - Vector3::from(*apex)).norm(),
            (None, _) => f64::INFINITY,
        }
    }

    /// How the direction changes along each axis, by differences over a part of a length.
    pub(crate) fn bend(&self, p: Vector3<f64>, length: f64) -> Option<[Vector3<f64>; 3]> {
        let step = STEP * length;
        let mut bend = [Vector3::zeros(); 3];
        for (axis, along) in bend.iter_mut().enumerate() {
            let off = Vector3::ith(axis, step);
            let (_, after) = self.at(p + off)?;
            let (_, before) = self.at(p - off)?;
            *along = (after - before) / (2.0 * step);
        }
        Some(bend)
    }

    /// What it is called.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Analytic(AnalyticSurface::Plane { .. }) => "plane",
            Self::Analytic(AnalyticSurface::Cylinder { .. }) => "cylinder",
            Self::Analytic(AnalyticSurface::Cone { .. }) => "cone",
            Self::Analytic(AnalyticSurface::Sphere { .. }) => "sphere",
            Self::Analytic(AnalyticSurface::Torus { .. }) => "torus",
            Self::Analytic(_) => "surface",
            Self::Elliptic(_) => "sheet",
            Self::Swept(_) => "spline",
        }
    }

    /// Whether another surface is nowhere farther than `limit` from this one, within `size` of a point of both.
    pub(crate) fn same(&self, other: &Self, near: Vector3<f64>, size: f64, limit: f64) -> bool {
        use AnalyticSurface::{Cone, Cylinder, Plane, Sphere, Torus};
        let apart = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
        // The sine between directions, either way.
        let turned = |a: [f64; 3], b: [f64; 3]| Vector3::from(a).cross(&Vector3::from(b)).norm();
        match (self, other) {
            (Self::Analytic(a), Self::Analytic(b)) => match (*a, *b) {
                (Plane { normal, .. }, Plane { normal: m, .. }) => {
                    let off = |s: &Self| s.at(near).map_or(f64::INFINITY, |(d, _)| d.abs());
                    off(self).max(off(other)) + turned(normal, m) * size <= limit
                }
                (
                    Cylinder { origin, axis, radius },
                    Cylinder {
                        origin: o,
                        axis: x,
                        radius: r,
                    },
                ) => {
                    // Where the axes are nearest to the point.
                    let foot = |origin: [f64; 3], axis: [f64; 3]| {
                        let (origin, axis) = (Vector3::from(origin), Vector3::from(axis));
                        origin + axis * axis.dot(&(near - origin))
                    };
                    let off = (foot(origin, axis) - foot(o, x)).norm();
                    off + turned(axis, x) * size + (radius - r).abs() <= limit
                }
                (
                    Cone { apex, axis, angle },
                    Cone {
                        apex: p,
                        axis: x,
                        angle: g,
                    },
                ) => {
                    let along = Vector3::from(axis).dot(&Vector3::from(x)) > 0.0;
                    along && apart(apex, p) + (turned(axis, x) + (angle - g).abs()) * size <= limit
                }
                (Sphere { centre, radius }, Sphere { centre: c, radius: r }) => {
                    apart(centre, c) + (radius - r).abs() <= limit
                }
                (
                    Torus {
                        centre,
                        axis,
                        major,
                        minor,
                    },
                    Torus {
                        centre: c,
                        axis: x,
                        major: m,
                        minor: n,
                    },
                ) => apart(centre, c) + turned(axis, x) * m + (major - m).abs() + (minor - n).abs() <= limit,
                _ => false,
            },
            (Self::Elliptic(a), Self::Elliptic(b)) => a.same(b, near, size, limit),
            (Self::Swept(a), Self::Swept(b)) => a == b,
            _ => false,
        }
    }
}
