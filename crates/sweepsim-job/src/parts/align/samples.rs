//! Points of a surface, spread evenly over its area.

use nalgebra::{Point3, Unit, Vector3};
use sweepsim_dexel::Mesh;

/// A point of a surface with its normal; each stands for the same area.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub place: Point3<f64>,
    pub normal: Vector3<f64>,
}

/// So many points, the same for the same mesh; those with a normal that is not wanted are left out.
pub(super) fn spread(mesh: &Mesh, count: usize, wanted: impl Fn(&Vector3<f64>) -> bool) -> Vec<Sample> {
    let corners = |t: &[u32; 3]| t.map(|v| Point3::from(mesh.vertices[v as usize]));
    let cross = |[a, b, c]: &[Point3<f64>; 3]| (b - a).cross(&(c - a));
    let total: f64 = mesh.triangles.iter().map(|t| cross(&corners(t)).norm()).sum();
    let mut samples = Vec::with_capacity(count);
    let (mut area, mut next) = (0.0, 0_usize);
    for triangle in &mesh.triangles {
        let corners = corners(triangle);
        let normal = cross(&corners);
        area += normal.norm();
        while next < count && (next as f64 + 0.5) * total <= area * count as f64 {
            next += 1;
            let Some(normal) = Unit::try_new(normal, 0.0).filter(|normal| wanted(normal)) else {
                continue;
            };
            // A sequence that fills the unit square evenly (Roberts 2018), folded onto the triangle.
            let [u, v] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2].map(|step| (next as f64 * step).fract());
            let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            samples.push(Sample {
                place: corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v,
                normal: normal.into_inner(),
            });
        }
    }
    samples
}

/// Their middle, and the mean distance from it (the root of the mean square).
pub(super) fn middle(samples: &[Sample]) -> (Point3<f64>, f64) {
    let count = samples.len().max(1) as f64;
    let centre = Point3::from(samples.iter().map(|s| s.place.coords).sum::<Vector3<f64>>() / count);
    let square: f64 = samples.iter().map(|s| (s.place - centre).norm_squared()).sum();
    (centre, (square / count).sqrt().max(f64::MIN_POSITIVE))
}
