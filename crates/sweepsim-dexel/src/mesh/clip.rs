//! Triangles inside and outside of a box.

use super::TriangleSoup;

/// A convex polygon.
type Polygon = Vec<[f64; 3]>;

/// The parts of a convex polygon with coordinate `axis` below a limit, and above it (Sutherland and Hodgman 1974).
fn split(polygon: &Polygon, axis: usize, limit: f64) -> [Polygon; 2] {
    let mut parts = [Polygon::new(), Polygon::new()];
    for (k, &p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        if p[axis] <= limit {
            parts[0].push(p);
        }
        if p[axis] >= limit {
            parts[1].push(p);
        }
        if (p[axis] < limit) != (q[axis] < limit) && p[axis] != limit && q[axis] != limit {
            // From the lower end, so that both triangles at an edge get the same point.
            let (a, b) = if p[axis] < limit { (p, q) } else { (q, p) };
            let share = (limit - a[axis]) / (b[axis] - a[axis]);
            let mut cut = [0, 1, 2].map(|j| a[j] + share * (b[j] - a[j]));
            cut[axis] = limit;
            parts.iter_mut().for_each(|part| part.push(cut));
        }
    }
    parts
}

fn fan(polygon: &Polygon, triangles: &mut Vec<[[f64; 3]; 3]>) {
    for k in 2..polygon.len() {
        let triangle = [polygon[0], polygon[k - 1], polygon[k]];
        if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
            triangles.push(triangle);
        }
    }
}

impl TriangleSoup {
    /// What of the surface is inside a box along the axes, and what is outside; triangles that cross its sides are cut.
    ///
    /// ```
    /// use sweepsim_dexel::TriangleSoup;
    /// let flat = TriangleSoup { triangles: vec![[[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]] };
    /// let [inside, outside] = flat.split_by_box([-1.0, -1.0, -1.0], [1.0, 9.0, 1.0]);
    /// let area = |soup: &TriangleSoup| -> f64 {
    ///     let area = |[a, b, c]: &[[f64; 3]; 3]| 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    ///     soup.triangles.iter().map(area).sum()
    /// };
    /// assert_eq!([area(&inside), area(&outside)], [3.5, 4.5]);
    /// ```
    #[must_use]
    pub fn split_by_box(&self, min: [f64; 3], max: [f64; 3]) -> [Self; 2] {
        let [mut inside, mut outside] = [Self::default(), Self::default()];
        for triangle in &self.triangles {
            let mut rest = triangle.to_vec();
            let mut away = Vec::new();
            for axis in 0..3 {
                // What lies in a side of the box is inside.
                let [below, above] = split(&rest, axis, min[axis]);
                away.push(if below.iter().any(|p| p[axis] < min[axis]) {
                    below
                } else {
                    Polygon::new()
                });
                let [below, above] = split(&above, axis, max[axis]);
                away.push(if above.iter().any(|p| p[axis] > max[axis]) {
                    above
                } else {
                    Polygon::new()
                });
                rest = below;
            }
            let cut_off = away.iter().any(|part| part.len() > 2);
            if !cut_off {
                inside.triangles.push(*triangle);
            } else if rest.len() < 3 {
                outside.triangles.push(*triangle);
            } else {
                fan(&rest, &mut inside.triangles);
                away.iter().for_each(|part| fan(part, &mut outside.triangles));
            }
        }
        [inside, outside]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{cross, sub};
    use sweepsim_props::*;

    fn area([a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
        cross(sub(*b, *a), sub(*c, *a)).map(|c| 0.5 * c)
    }

    fn sum(soup: &TriangleSoup) -> [f64; 3] {
        let areas = soup.triangles.iter().map(area);
        areas.fold([0.0; 3], |s, a| [0, 1, 2].map(|k| s[k] + a[k]))
    }

    proptest! {
        /// Nothing is lost or turned over, and everything is on its side.
        #[test]
        fn parts_make_up_the_whole(
            triangles in collection::vec(prop::array::uniform3(prop::array::uniform3(-4i8..5)), 1..8),
            corner in prop::array::uniform3(-3i8..3), size in prop::array::uniform3(1i8..5),
        ) {
            // On a grid of halves, so that corners and edges often lie in sides.
            let half = |p: [i8; 3]| p.map(|c| 0.5 * f64::from(c));
            let soup = TriangleSoup { triangles: triangles.iter().map(|t| t.map(half)).collect() };
            let min = half(corner);
            let max = [0, 1, 2].map(|k| min[k] + 0.5 * f64::from(size[k]));
            let [inside, outside] = soup.split_by_box(min, max);
            for own in &inside.triangles {
                prop_assert!(own.iter().all(|p| (0..3).all(|k| min[k] - 1e-12 <= p[k] && p[k] <= max[k] + 1e-12)), "{own:?}");
            }
            for own in &outside.triangles {
                // No point of it is inside.
                for (u, v) in (0..=12).flat_map(|u| (0..=12 - u).map(move |v| (f64::from(u) / 12.0, f64::from(v) / 12.0))) {
                    let at = |k: usize| own[0][k] + u * (own[1][k] - own[0][k]) + v * (own[2][k] - own[0][k]);
                    let within = |k: usize| min[k] + 1e-9 < at(k) && at(k) < max[k] - 1e-9;
                    prop_assert!(!(0..3).all(within), "{own:?}");
                }
            }
            let [a, b, all] = [sum(&inside), sum(&outside), sum(&soup)];
            prop_assert!((0..3).all(|k| (a[k] + b[k] - all[k]).abs() < 1e-11), "{a:?} {b:?} {all:?}");
        }
    }
}
