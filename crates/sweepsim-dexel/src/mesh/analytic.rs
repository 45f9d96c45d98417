//! Surfaces that triangles approximate: where a file tells them, distances need not be those of their chords.

use super::DistanceTo;
use crate::vector::{along, dot, length, sub};

/// The surface of a face as its file describes it. Directions are unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AnalyticSurface {
    /// A plane.
    Plane {
        /// A point of it.
        origin: [f64; 3],
        /// Its normal, to either side.
        normal: [f64; 3],
    },
    /// An infinite cylinder.
    Cylinder {
        /// A point of its axis.
        origin: [f64; 3],
        /// The direction of its axis.
        axis: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// One nappe of a cone.
    Cone {
        /// Its apex.
        apex: [f64; 3],
        /// From the apex into the nappe.
        axis: [f64; 3],
        /// The angle between axis and surface, in radians, below a right angle.
        angle: f64,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        centre: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A torus.
    Torus {
        /// Its centre.
        centre: [f64; 3],
        /// The direction of its axis.
        axis: [f64; 3],
        /// The radius of the circle in its middle.
        major: f64,
        /// The radius of its tube.
        minor: f64,
    },
}

impl AnalyticSurface {
    /// The signed distance of a point from the whole surface, and the direction in which it grows: on a plane along the
    /// normal, on all others away from the axis or the centre. `None` where every direction is as good: on an axis, in
    /// a centre, or beyond the apex of a cone.
    ///
    /// ```
    /// use sweepsim_dexel::AnalyticSurface;
    /// let hole = AnalyticSurface::Cylinder { origin: [1.0, 0.0, 0.0], axis: [0.0, 0.0, 1.0], radius: 5.0 };
    /// assert_eq!(hole.distance([4.0, 4.0, 7.0]), Some((0.0, [0.6, 0.8, 0.0])));
    /// ```
    #[must_use]
    pub fn distance(&self, p: [f64; 3]) -> Option<(f64, [f64; 3])> {
        // From the axis: how far, in which direction, and how high above a point of it.
        let about = |origin: [f64; 3], axis: [f64; 3]| {
            let off = sub(p, origin);
            let height = dot(off, axis);
            let out = along(off, -height, axis);
            let far = length(out);
            (far > 0.0).then(|| (far, out.map(|c| c / far), height))
        };
        match *self {
            Self::Plane { origin, normal } => Some((dot(sub(p, origin), normal), normal)),
            Self::Cylinder { origin, axis, radius } => {
                let (far, out, _) = about(origin, axis)?;
                Some((far - radius, out))
            }
            Self::Cone { apex, axis, angle } => {
                let (far, out, height) = about(apex, axis)?;
                let (sine, cosine) = angle.sin_cos();
                let beyond = far * sine + height * cosine <= 0.0;
                let grows = along(out.map(|c| cosine * c), -sine, axis);
                (!beyond).then_some((far * cosine - height * sine, grows))
            }
            Self::Sphere { centre, radius } => {
                let off = sub(p, centre);
                let far = length(off);
                (far > 0.0).then(|| (far - radius, off.map(|c| c / far)))
            }
            Self::Torus {
                centre,
                axis,
                major,
                minor,
            } => {
                let (far, out, height) = about(centre, axis)?;
                let off = along(out.map(|c| (far - major) * c), height, axis);
                let size = length(off);
                (size > 0.0).then(|| (size - minor, off.map(|c| c / size)))
            }
        }
    }

    /// The point of the whole surface nearest to another; that itself where every direction is as good.
    #[must_use]
    pub fn nearest(&self, p: [f64; 3]) -> [f64; 3] {
        self.distance(p)
            .map_or(p, |(distance, grows)| along(p, -distance, grows))
    }

    /// The surface after a rigid motion: `place` moves points, `turn` directions.
    #[must_use]
    pub fn moved(&self, place: impl Fn([f64; 3]) -> [f64; 3], turn: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let mut moved = *self;
        match &mut moved {
            Self::Plane { origin, normal } => (*origin, *normal) = (place(*origin), turn(*normal)),
            Self::Cylinder { origin, axis, .. } => (*origin, *axis) = (place(*origin), turn(*axis)),
            Self::Cone { apex, axis, .. } => (*apex, *axis) = (place(*apex), turn(*axis)),
            Self::Sphere { centre, .. } => *centre = place(*centre),
            Self::Torus { centre, axis, .. } => (*centre, *axis) = (place(*centre), turn(*axis)),
        }
        moved
    }
}

/// The surfaces of the faces of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FaceSurfaces {
    /// Of each triangle the number of its face.
    pub face_of: Vec<u32>,
    /// Of each face its surface, if that is known.
    pub surfaces: Vec<Option<AnalyticSurface>>,
    /// No triangle is farther from its surface than this.
    pub chord: f64,
}

impl FaceSurfaces {
    /// For each triangle the number of its face, for each face its surface, and how far they are from each other.
    #[must_use]
    pub fn new(face_of: Vec<u32>, surfaces: Vec<Option<AnalyticSurface>>, chord: f64) -> Self {
        Self {
            face_of,
            surfaces,
            chord,
        }
    }

    /// The same after a rigid motion: `place` moves points, `turn` directions.
    #[must_use]
    pub fn moved(&self, place: impl Fn([f64; 3]) -> [f64; 3], turn: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let moved = |surface: &Option<AnalyticSurface>| surface.map(|surface| surface.moved(&place, &turn));
        Self {
            surfaces: self.surfaces.iter().map(moved).collect(),
            ..self.clone()
        }
    }

    /// The surface of a triangle, if it is known.
    #[must_use]
    pub fn of_triangle(&self, triangle: usize) -> Option<&AnalyticSurface> {
        let face = *self.face_of.get(triangle)? as usize;
        self.surfaces.get(face)?.as_ref()
    }
}

impl DistanceTo {
    /// Distances are those from the surfaces of the faces, where these are known: from that of the nearest triangle,
    /// unless it is further than the chord error from the distance of that triangle, as beside the edges of a face.
    /// What nearest triangles are does not change.
    #[must_use]
    pub fn with_surfaces(mut self, faces: FaceSurfaces) -> Self {
        self.surfaces = Some(faces);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriangleSoup;
    use sweepsim_props::*;

    fn unit(v: [f64; 3]) -> [f64; 3] {
        v.map(|c| c / length(v))
    }

    proptest! {
        /// The nearest point is on the surface, and the way there is as long as the distance, along its gradient.
        #[test]
        fn nearest_points_are_on_the_surface(
            p in prop::array::uniform3(-9.0_f64..9.0),
            origin in prop::array::uniform3(-2.0_f64..2.0),
            axis in prop::array::uniform3(-1.0_f64..1.0).prop_filter("long", |v| length(*v) > 0.2),
            (r, s) in (0.5_f64..3.0, 0.1_f64..0.45),
        ) {
            let axis = unit(axis);
            let surfaces = [
                AnalyticSurface::Plane { origin, normal: axis },
                AnalyticSurface::Cylinder { origin, axis, radius: r },
                AnalyticSurface::Cone { apex: origin, axis, angle: s },
                AnalyticSurface::Sphere { centre: origin, radius: r },
                AnalyticSurface::Torus { centre: origin, axis, major: r, minor: s },
            ];
            let mut tried = 0;
            for surface in surfaces {
                let Some((distance, grows)) = surface.distance(p) else { continue };
                let near = surface.nearest(p);
                prop_assert!(surface.distance(near).is_some_and(|(rest, _)| rest.abs() < 1e-12), "{surface:?}");
                prop_assert!((length(sub(near, p)) - distance.abs()).abs() < 1e-12);
                prop_assert!((length(grows) - 1.0).abs() < 1e-12);
                // By a difference.
                let step = along(p, 1e-6, grows);
                let grown = surface.distance(step).map_or(f64::NAN, |(d, _)| d - distance);
                prop_assert!((grown - 1e-6).abs() < 1e-10, "{surface:?} {grown}");
                tried += 1;
            }
            prop_assert!(tried >= 4);
        }
    }

    /// A drum of a few sides is measured as the cylinder that it approximates, outside and inside.
    #[test]
    fn a_coarse_drum_is_round() {
        let (radius, sides) = (5.0, 16);
        let at = |k: usize, z: f64| {
            let (s, c) = (k as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
            [radius * c, radius * s, z]
        };
        let (mut triangles, mut face_of) = (Vec::new(), Vec::new());
        for k in 0..sides {
            let [a, b, c, d] = [at(k, 0.0), at(k + 1, 0.0), at(k + 1, 4.0), at(k, 4.0)];
            triangles.extend([[a, b, c], [a, c, d], [[0.0; 3], b, a], [[0.0, 0.0, 4.0], d, c]]);
            face_of.extend([0, 0, 1, 2]);
        }
        let plane = |z: f64| AnalyticSurface::Plane {
            origin: [0.0, 0.0, z],
            normal: [0.0, 0.0, 1.0],
        };
        let side = AnalyticSurface::Cylinder {
            origin: [0.0; 3],
            axis: [0.0, 0.0, 1.0],
            radius,
        };
        let chord = radius * (1.0 - (std::f64::consts::PI / sides as f64).cos());
        assert!(chord > 0.09);
        let faces = FaceSurfaces::new(
            face_of,
            vec![Some(side), Some(plane(0.0)), Some(plane(4.0))],
            1.01 * chord,
        );
        let tree = DistanceTo::new(&TriangleSoup { triangles })
            .unwrap()
            .with_surfaces(faces);
        for n in 0..200 {
            let (turn, far) = (f64::from(n) * 0.37, 4.2 + f64::from(n % 17) * 0.1);
            let p = [far * turn.cos(), far * turn.sin(), 1.5 + 0.005 * f64::from(n)];
            let near = tree.nearest(p).unwrap();
            assert!(
                (near.distance - (far - radius)).abs() < 1e-12,
                "{p:?} {}",
                near.distance
            );
            assert!((length(sub(near.place, p)) - near.distance.abs()).abs() < 1e-12);
            let out = dot(near.normal, [turn.cos(), turn.sin(), 0.0]);
            assert!((out - 1.0).abs() < 1e-12);
        }
        assert_eq!(tree.nearest([1.0, 0.5, 4.25]).unwrap().distance, 0.25);
        assert_eq!(tree.nearest([1.0, 0.5, 3.75]).unwrap().distance, -0.25);
    }
}
