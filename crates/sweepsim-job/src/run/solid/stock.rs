//! The surfaces of a stock.

use sweepsim_dexel::{AnalyticSurface, DistanceTo, Stock, SurfaceEnd};
use sweepsim_solid::Surface;

use super::surfaces::{cross, dot, plane, sub, unit};

/// What an end of the stock may be on.
pub(super) struct StockSurfaces {
    /// The faces of blocks, cylinders and balls.
    simple: Vec<Surface>,
    meshes: Vec<DistanceTo>,
    /// Whether results of earlier runs are part of it.
    earlier: bool,
    /// The box of the dexels.
    bounds: [[f64; 3]; 2],
}

impl StockSurfaces {
    pub fn new(stock: &Stock, bounds: [[f64; 3]; 2]) -> Self {
        let mut all = Self {
            simple: Vec::new(),
            meshes: Vec::new(),
            earlier: false,
            bounds,
        };
        all.add(stock);
        all
    }

    fn add(&mut self, stock: &Stock) {
        match stock {
            Stock::Block { min, max } => self.simple.extend(sides(*min, *max)),
            Stock::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                let Some(axis) = unit(*axis) else { return };
                let top = [0, 1, 2].map(|k| base[k] + height * axis[k]);
                self.simple.extend([plane(*base, axis), plane(top, axis)]);
                self.simple.push(Surface::Analytic(AnalyticSurface::Cylinder {
                    origin: *base,
                    axis,
                    radius: *radius,
                }));
            }
            Stock::Ball { centre, radius } => self.simple.push(Surface::Analytic(AnalyticSurface::Sphere {
                centre: *centre,
                radius: *radius,
            })),
            Stock::Mesh(soup) => self.meshes.extend(DistanceTo::new(soup).ok()),
            Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().for_each(|part| self.add(part)),
            Stock::Difference(whole, parts) => {
                self.add(whole);
                parts.iter().for_each(|part| self.add(part));
            }
            _ => self.earlier = true,
        }
    }

    /// The surfaces that an end may be on.
    pub fn near(&self, end: &SurfaceEnd) -> Vec<Surface> {
        if end.at_box {
            return sides(self.bounds[0], self.bounds[1]).to_vec();
        }
        let mut all = self.simple.clone();
        for mesh in &self.meshes {
            let Some(near) = mesh.nearest_triangle(end.place) else {
                continue;
            };
            let [a, b, c] = near.corners;
            all.extend(unit(cross(sub(b, a), sub(c, a))).map(|normal| plane(a, normal)));
        }
        // Of an earlier run only ends and normals are known: those along an axis, exactly.
        if let (true, Some(normal)) = (self.earlier, end.normal) {
            let along = (0..3).find(|k| normal[*k].abs() > 1.0 - 1e-12);
            if let Some(axis) = along {
                let mut flat = [0.0; 3];
                flat[axis] = 1.0;
                let mut origin = [0.0; 3];
                origin[axis] = dot(end.place, flat);
                all.push(plane(origin, flat));
            }
        }
        all
    }
}

/// The planes of a box.
fn sides(min: [f64; 3], max: [f64; 3]) -> [Surface; 6] {
    [0, 1, 2, 3, 4, 5].map(|side| {
        let (mut origin, mut normal) = ([0.0; 3], [0.0; 3]);
        let corner = if side < 3 { min } else { max };
        origin[side % 3] = corner[side % 3];
        normal[side % 3] = 1.0;
        plane(origin, normal)
    })
}
