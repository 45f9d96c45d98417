//! Parameters of surfaces: angles and heights, as files have them.

use crate::surface::Surface;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use sweepsim_dexel::AnalyticSurface as A;

/// A surface with the side of it on which there is no material.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub surface: Surface,
    /// Whether distances from the surface grow out of the material.
    pub outward: bool,
    /// Of spheres, the direction of a pole that is not on the face.
    pub pole: Option<Vector3<f64>>,
}

/// A surface with a place where its angles begin.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    pub surface: Surface,
    pub origin: Vector3<f64>,
    /// Right-handed; the last is the axis or the normal.
    pub axes: [Vector3<f64>; 3],
}

/// Closer to an axis than this, in parts of the surface's size, a point has no angle.
const NO_ANGLE: f64 = 1e-9;

/// A direction across another, the same for all that are nearly the same.
pub(crate) fn across(axis: Vector3<f64>) -> Vector3<f64> {
    let least = if axis.x.abs() <= 0.6 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    (least - axis * axis.dot(&least)).normalize()
}

/// The difference of two angles, from −π to π.
pub(crate) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Chart {
    pub fn new(label: &Label) -> Self {
        let (origin, axis) = match &label.surface {
            Surface::Analytic(A::Plane { origin, normal }) => (*origin, *normal),
            Surface::Analytic(A::Cylinder { origin, axis, .. }) => (*origin, *axis),
            Surface::Analytic(A::Cone { apex, axis, .. }) => (*apex, *axis),
            Surface::Analytic(A::Sphere { centre, .. }) => (*centre, label.pole.unwrap_or(Vector3::z()).into()),
            Surface::Analytic(A::Torus { centre, axis, .. }) => (*centre, *axis),
            Surface::Analytic(_) => ([0.0; 3], [0.0, 0.0, 1.0]),
            Surface::Elliptic(sheet) => {
                return Self {
                    surface: label.surface.clone(),
                    origin: sheet.centre(),
                    axes: sheet.axes,
                };
            }
            Surface::Swept(sheet) => (sheet.middle().into(), [0.0, 0.0, 1.0]),
        };
        let axis = Vector3::from(axis);
        let x = across(axis);
        Self {
            surface: label.surface.clone(),
            origin: origin.into(),
            axes: [x, axis.cross(&x), axis],
        }
    }

    /// Which of the two parameters are angles.
    pub fn periodic(&self) -> [bool; 2] {
        match &self.surface {
            Surface::Analytic(A::Plane { .. }) => [false, false],
            Surface::Analytic(A::Torus { .. }) => [true, true],
            Surface::Swept(sheet) => [sheet.is_round(), false],
            _ => [true, false],
        }
    }

    /// The angle about the axis; none on it.
    fn turn(&self, off: Vector3<f64>) -> Option<f64> {
        let [x, y] = [0, 1].map(|k| self.axes[k].dot(&off));
        let far = x.hypot(y);
        (far > NO_ANGLE * (1.0 + off.norm())).then(|| y.atan2(x))
    }

    /// The parameters of a point: none where it has no angle.
    pub fn uv(&self, p: Vector3<f64>) -> [Option<f64>; 2] {
        let off = p - self.origin;
        let [x, y, z] = self.axes.map(|axis| axis.dot(&off));
        match &self.surface {
            Surface::Analytic(A::Plane { .. }) => [Some(x), Some(y)],
            Surface::Analytic(A::Sphere { .. }) => {
                let lies = z.atan2(x.hypot(y));
                [self.turn(off), Some(lies)]
            }
            Surface::Analytic(A::Torus { major, .. }) => {
                let out = x.hypot(y) - major;
                let tube = (out.hypot(z) > NO_ANGLE * major).then(|| z.atan2(out));
                [self.turn(off), tube]
            }
            Surface::Elliptic(sheet) => {
                let (angle, height) = sheet.angle(p);
                [Some(angle), Some(height)]
            }
            Surface::Swept(sheet) => sheet.uv(p).map_or([None; 2], |uv| uv.map(Some)),
            Surface::Analytic(_) => [self.turn(off), Some(z)],
        }
    }

    /// Parameters in lengths rather than in angles, near a point.
    pub fn scale(&self) -> [f64; 2] {
        match &self.surface {
            Surface::Analytic(A::Cylinder { radius, .. }) => [*radius, 1.0],
            Surface::Analytic(A::Sphere { radius, .. }) => [*radius, *radius],
            Surface::Analytic(A::Torus { major, minor, .. }) => [*major, *minor],
            Surface::Swept(sheet) => sheet.scale(),
            _ => [1.0, 1.0],
        }
    }

    /// Turns the chart so that an angle becomes half a turn: the farthest from where angles begin and end.
    pub fn turned_to(mut self, middle: f64) -> Self {
        if let Surface::Elliptic(_) | Surface::Swept(_) | Surface::Analytic(A::Plane { .. }) = self.surface {
            return self;
        }
        let (s, c) = (middle - PI).sin_cos();
        let [x, y, _] = self.axes;
        self.axes[0] = x * c + y * s;
        self.axes[1] = y * c - x * s;
        self
    }

    /// The half planes through the axis at an angle and opposite, together.
    pub fn through_axis(&self, angle: f64) -> Surface {
        let (s, c) = angle.sin_cos();
        let across = match &self.surface {
            Surface::Elliptic(sheet) => {
                let along = sheet.point(angle, 0.0) - self.origin;
                self.axes[2].cross(&along).normalize()
            }
            _ => self.axes[1] * c - self.axes[0] * s,
        };
        plane(self.origin, across)
    }

    /// The plane across the axis.
    pub fn across_axis(&self) -> Surface {
        plane(self.origin, self.axes[2])
    }
}

fn plane(origin: Vector3<f64>, normal: Vector3<f64>) -> Surface {
    Surface::Analytic(A::Plane {
        origin: origin.into(),
        normal: normal.into(),
    })
}
