//! Whether something is beside a solid between triangles.

use nalgebra::Vector3;
use sweepsim_dexel::DistanceTo;

/// Whether the hull of some points is outside of a mesh, or no deeper in it than its skin; if that is negative, so far
/// away.
///
/// It is in a ball around its middle. If that has no surface, or each triangle there is below a plane that has the hull
/// above it, the hull is outside as its middle is: the plane is across the way to the surface, or that of the triangle.
pub(super) fn misses(mesh: &DistanceTo, points: &[Vector3<f64>], middle: &Vector3<f64>, skin: f64) -> bool {
    let size = points.iter().map(|point| (point - middle).norm()).fold(0.0, f64::max);
    let size = size * (1.0 + 1e-9) + 1e-12;
    let Some(nearest) = mesh.nearest((*middle).into()) else {
        return true;
    };
    if nearest.distance + skin > size {
        return true;
    }
    let away = (-skin).max(0.0);
    let least = |normal: &Vector3<f64>| {
        points
            .iter()
            .map(|point| point.dot(normal))
            .fold(f64::INFINITY, f64::min)
    };
    let normal = (middle - Vector3::from(nearest.place)).normalize();
    let own = least(&normal);
    let is_below = |corners: &[[f64; 3]; 3], face: [f64; 3]| {
        let below = |normal: &Vector3<f64>, least: f64| {
            let mut corners = corners.iter();
            corners.all(|corner| Vector3::from(*corner).dot(normal) + away <= least - 1e-12)
        };
        let face = Vector3::from(face);
        below(&normal, own) || below(&face, least(&face))
    };
    nearest.distance > 1e-12 && mesh.all_within((*middle).into(), size + away, is_below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use sweepsim_dexel::TriangleSoup;
    use sweepsim_props::test_runner::{Config, TestRunner};
    use sweepsim_props::*;

    /// A ball with hills and valleys: an octahedron that is divided twice, its corners at some of these distances.
    fn star(radii: &[f64]) -> TriangleSoup {
        let at = |x: f64, y: f64, z: f64| Vector3::new(x, y, z);
        let mut triangles = Vec::new();
        for (x, y, z) in [-1.0, 1.0]
            .iter()
            .flat_map(|x| [(*x, -1.0, -1.0), (*x, 1.0, -1.0), (*x, -1.0, 1.0), (*x, 1.0, 1.0)])
        {
            let own = [at(x, 0.0, 0.0), at(0.0, y, 0.0), at(0.0, 0.0, z)];
            triangles.push(if x * y * z > 0.0 { own } else { [own[1], own[0], own[2]] });
        }
        for _ in 0..2 {
            let parts = |[a, b, c]: [Vector3<f64>; 3]| {
                let [p, q, r] = [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
                [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
            };
            triangles = triangles.into_iter().flat_map(parts).collect();
        }
        let place = |corner: Vector3<f64>| {
            let number = (16.0 * corner.x + 7.0 * 16.0 * corner.y + 49.0 * 16.0 * corner.z) as i64;
            let radius = radii[number.rem_euclid(radii.len() as i64) as usize];
            (corner.normalize() * radius).into()
        };
        let triangles = triangles.into_iter().map(|corners| corners.map(place)).collect();
        TriangleSoup { triangles }
    }

    fn missed(
        radii: &[f64],
        (place, size): ([f64; 3], f64),
        off: [[f64; 3]; 3],
        skin: f64,
    ) -> Result<[bool; 2], TestCaseError> {
        let soup = star(radii);
        prop_assert!(soup.check_closed().is_ok() && soup.volume() > 0.0);
        let mesh = DistanceTo::new(&soup).expect("few vertices");
        let points = off.map(|off| Vector3::from(place) + Vector3::from(off) * size);
        let middle = (points[0] + points[1] + points[2]) / 3.0;
        if !misses(&mesh, &points, &middle, skin) {
            return Ok([false; 2]);
        }
        let distance = |p: Vector3<f64>| mesh.nearest(p.into()).expect("a surface").distance;
        for (i, j) in (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| f64::from(k) / 12.0);
            let p = points[0] * (1.0 - u - v) + points[1] * u + points[2] * v;
            prop_assert!(distance(p) + skin >= -1e-9, "{} {}", distance(p), skin);
        }
        let far = points.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
        Ok([true, distance(middle) + skin <= far])
    }

    #[test]
    fn what_is_said_to_miss_a_mesh_does() {
        let cases = (
            collection::vec(1.0..2.0_f64, 11),
            ([-3.0..3.0_f64, -3.0..3.0, -3.0..3.0], 0.05..1.5_f64),
            [
                [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
                [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
                [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
            ],
            -0.2..0.1_f64,
        );
        let counts = Cell::new([0; 2]);
        let mut runner = TestRunner::new(Config {
            failure_persistence: None,
            ..Config::with_cases(4000)
        });
        let run = runner.run(&cases, |(radii, place, off, skin)| {
            let found = missed(&radii, place, off, skin)?;
            let [all, beyond] = counts.get();
            counts.set([all + u32::from(found[0]), beyond + u32::from(found[1])]);
            Ok(())
        });
        run.unwrap_or_else(|error| panic!("{error}"));
        let [all, beyond] = counts.get();
        assert!(
            all > 1000 && beyond > 100,
            "{all} are missed, {beyond} not by the ball around them"
        );
    }
}
