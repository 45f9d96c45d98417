//! How far inside a convex solid of revolution a point is.

use super::Convex;
use super::convex::ConvexArc;

/// Normals that differ by less are the same.
const SAME: f64 = 1e-9;

/// The planes and arcs between which a convex solid lies, in the half-plane `(ρ, ζ)`.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    /// Unit normals with a first part of at least 0, and the largest value along them.
    planes: Vec<([f64; 2], f64)>,
    arcs: Vec<ConvexArc>,
    corners: Vec<[f64; 2]>,
}

impl Level {
    pub fn new(solid: &Convex) -> Self {
        let next = solid.corners.iter().cycle().skip(1);
        let edges = solid.corners.iter().zip(next).filter_map(|(a, b)| {
            let (x, y) = (b[1] - a[1], a[0] - b[0]);
            let length = x.hypot(y);
            (length > 0.0).then(|| [x / length, y / length])
        });
        let ends = solid.arcs.iter().flat_map(|arc| arc.normals);
        // Only the axis has the other side; rounding may turn what is level.
        let planes = edges.chain(ends).filter(|normal| normal[0] > -SAME);
        // What is not a side of the solid does no harm: it is farther out.
        let planes = planes.map(|normal| (normal, solid.meridian_support(normal).0));
        Self {
            planes: planes.collect(),
            arcs: solid.arcs.clone(),
            corners: solid.corners.clone(),
        }
    }

    /// No more than how far `(ρ, ζ)` is outside of the solid; negative inside, and there it is minus the distance from
    /// the surface. It is convex, and does not fall with `ρ`.
    pub fn at(&self, point: [f64; 2]) -> f64 {
        let planes = self.planes.iter();
        let mut level = planes
            .map(|(normal, top)| normal[0] * point[0] + normal[1] * point[1] - top)
            .fold(f64::NEG_INFINITY, f64::max);
        for arc in &self.arcs {
            let off = [point[0] - arc.centre[0], point[1] - arc.centre[1]];
            let [from, to] = arc.normals;
            if from[0] * off[1] - from[1] * off[0] >= 0.0 && off[0] * to[1] - off[1] * to[0] >= 0.0 {
                level = level.max((off[0] * off[0] + off[1] * off[1]).sqrt() - arc.radius);
            }
        }
        level
    }

    /// How far `(ρ, ζ)` is outside of the solid, or minus how far it is inside. It is convex, and does not fall with
    /// `ρ`.
    pub fn signed(&self, point: [f64; 2]) -> f64 {
        let level = self.at(point);
        if level > 0.0 {
            level.max(self.distance(point))
        } else {
            level
        }
    }

    /// How far `(ρ, ζ)` is from the solid: 0 inside.
    pub fn distance(&self, point: [f64; 2]) -> f64 {
        if self.at(point) <= 0.0 {
            return 0.0;
        }
        let next = self.corners.iter().cycle().skip(1);
        let of_edge = |(a, b): (&[f64; 2], &[f64; 2])| {
            let (way, off) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
            let length = way[0] * way[0] + way[1] * way[1];
            let part = if length > 0.0 {
                ((off[0] * way[0] + off[1] * way[1]) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (off[0] - part * way[0]).hypot(off[1] - part * way[1])
        };
        // The chord of an arc is inside of the solid, and farther.
        let edges = self.corners.iter().zip(next).map(of_edge);
        let arcs = self.arcs.iter().filter_map(|arc| {
            let off = [point[0] - arc.centre[0], point[1] - arc.centre[1]];
            let [from, to] = arc.normals;
            let beside = from[0] * off[1] - from[1] * off[0] >= 0.0 && off[0] * to[1] - off[1] * to[0] >= 0.0;
            beside.then(|| off[0].hypot(off[1]) - arc.radius)
        });
        edges.chain(arcs).fold(f64::INFINITY, f64::min).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::cover;
    use sweepsim_motion::Tool;

    #[test]
    fn it_is_the_distance_from_a_bull_nose() {
        let (radius, corner, length) = (3.0, 1.0, 10.0);
        let solids = cover(&Tool::bull(radius, corner, length).expect("a tool"), 1e-3);
        let level = Level::new(&solids[0]);
        let mut inside = 0;
        for i in 0..80 {
            for j in 0..120 {
                let (rho, zeta) = (f64::from(i) * 0.0501, f64::from(j) * 0.1003 - 1.0);
                let (right, down) = (rho - (radius - corner), corner - zeta);
                let round = right.max(0.0).hypot(down.max(0.0)) - corner;
                let flat = (rho - radius).max(zeta - length).max(-zeta);
                let own = if right > 0.0 && down > 0.0 { round } else { flat };
                let found = level.at([rho, zeta]);
                if own < 0.0 {
                    assert!((found - own).abs() < 1e-12, "({rho}, {zeta}): {found} {own}");
                    inside += 1;
                } else {
                    let beside = (rho - radius).max(0.0).hypot((zeta - length).max(0.0));
                    let own = if down > 0.0 { round } else { beside };
                    assert!(found >= -1e-12 && found <= own + 1e-12);
                    let distance = level.distance([rho, zeta]);
                    // Below the flat of the nose, down is the way.
                    assert!((distance - own).abs() < 1e-12, "({rho}, {zeta}): {distance} {own}");
                }
            }
        }
        assert!(inside > 5000);
    }
}
