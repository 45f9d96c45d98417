//! Whether a point is within what triangles enclose.

use crate::shape::{Body, Convex};
use nalgebra::Vector3;

/// Whether a ray from a point leaves the surface of a body more often than it enters it. Of bodies without triangles,
/// never.
pub(crate) fn holds(body: &Body, point: &Vector3<f64>) -> bool {
    // A direction of no symmetry.
    let ray = Vector3::new(0.401_7, 0.287_3, 0.869_6);
    let crossing = |solid: &Convex| {
        let Convex::Triangle(corners) = solid else {
            return 0;
        };
        let [a, b, c] = corners.map(|corner| Vector3::from(corner) - point);
        // The signs of the volumes that the ray spans with each side: all the same if it goes through.
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| ray.dot(&p.cross(&q)));
        let through = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
        let normal = (b - a).cross(&(c - a));
        let ahead = normal.dot(&a) / normal.dot(&ray) > 0.0;
        match through && ahead {
            true if normal.dot(&ray) > 0.0 => 1,
            true => -1,
            false => 0,
        }
    };
    body.solids().map(crossing).sum::<i32>() > 0
}
