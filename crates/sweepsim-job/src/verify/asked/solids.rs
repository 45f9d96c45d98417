//! Solids as triangles, for proofs about them.

use std::f64::consts::PI;
use sweepsim_dexel::{DistanceTo, MeshFault, Stock, TriangleSoup};
use sweepsim_proof::{Recall, Target};

/// As many faults of a solid are named.
const FAULTS: usize = 3;
/// Cylinders and balls are taken larger by no more than this, in millimetres, where that takes few triangles.
const CHORDS: f64 = 0.005;
/// The most sides of a cylinder.
const SIDES: f64 = 720.0;

/// A solid between triangles, or why it is none. `what`: its name; `lift`: how far something may have to be lifted out
/// of it, about; `known`: the distance to it, if that was prepared, and what earlier runs know of it.
pub(in crate::verify) fn of_mesh(
    mesh: &TriangleSoup,
    what: &str,
    lift: f64,
    (distance, recall): (Option<&DistanceTo>, &dyn Recall),
) -> Result<Target, String> {
    let sound = recall.digest(b"without faults");
    let is_sound = recall.recall(&sound).is_some();
    let closed = || if is_sound { Ok(()) } else { mesh.check_closed() };
    let distance = || distance.cloned().map_or_else(|| DistanceTo::new(mesh), Ok);
    let (closed, distance) = rayon::join(closed, distance);
    let distance = closed.and(distance);
    let distance = distance.map_err(|error| format!("{what} is no solid: {error}"))?;
    if !is_sound && mesh.volume() <= 0.0 {
        return Err(format!("{what} is inside out"));
    }
    let solid = Target::of_closed(mesh, lift, distance);
    if is_sound {
        return Ok(solid);
    }
    if let Some(faults) = faulty(mesh, what) {
        return Err(faults);
    }
    recall.keep(&sound, Vec::new());
    Ok(solid)
}

/// What is wrong with the triangles of a solid, with some of the places.
fn faulty(solid: &TriangleSoup, what: &str) -> Option<String> {
    let faults = solid.faults(FAULTS + 1);
    if faults.is_empty() {
        return None;
    }
    let place = |fault: &MeshFault| {
        let (what, at) = match fault {
            MeshFault::Doubled(at) => ("has a face twice", at),
            MeshFault::Crossing(at) => ("intersects itself", at),
            _ => return "is no solid".to_owned(),
        };
        let [x, y, z] = at.map(|c| format!("{c:.3}"));
        format!("{what} at ({x}, {y}, {z})")
    };
    let mut named: Vec<String> = faults.iter().take(FAULTS).map(place).collect();
    if faults.len() > FAULTS {
        named.push("…".to_owned());
    }
    Some(format!("{what} {}", named.join(", ")))
}

/// Triangles of solids that cover a fixture, or why there are none.
pub(in crate::verify) fn around(fixture: &Stock, what: &str) -> Result<Vec<TriangleSoup>, String> {
    match fixture {
        Stock::Block { min, max } => Ok(vec![TriangleSoup::block(*min, *max)]),
        Stock::Cylinder {
            base,
            axis,
            radius,
            height,
        } => Ok(vec![prism(*base, *axis, *radius, *height)]),
        Stock::Ball { centre, radius } => {
            let low = centre.map(|c| c - radius);
            let high = centre.map(|c| c + radius);
            Ok(vec![TriangleSoup::block(low, high)])
        }
        Stock::Mesh(mesh) => Ok(vec![mesh.clone()]),
        Stock::Union(parts) => {
            let all = parts.iter().map(|part| around(part, what));
            Ok(all.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
        }
        Stock::Intersection(parts) => match parts.first() {
            Some(first) => around(first, what),
            None => Ok(Vec::new()),
        },
        Stock::Difference(whole, _) => around(whole, what),
        _ => Err(format!("{what} is known on the lines of its dexels only")),
    }
}

/// A prism around a cylinder.
fn prism(base: [f64; 3], axis: [f64; 3], radius: f64, height: f64) -> TriangleSoup {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let z = axis.map(|c| c / length);
    let least = (0..3).fold(0, |a, k| if z[k].abs() < z[a].abs() { k } else { a });
    let mut x = z.map(|c| -c * z[least]);
    x[least] += 1.0;
    let across = x.iter().map(|c| c * c).sum::<f64>().sqrt();
    let x = x.map(|c| c / across);
    let y = [0, 1, 2].map(|k| z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3]);
    let sides = (PI / (radius / (radius + CHORDS)).acos()).ceil().clamp(8.0, SIDES) as usize;
    // Its sides touch the cylinder.
    let around = radius / (PI / sides as f64).cos();
    let at = |k: usize, up: f64| {
        let angle = 2.0 * PI * (k % sides) as f64 / sides as f64;
        let (c, s) = (around * angle.cos(), around * angle.sin());
        [0, 1, 2].map(|i| base[i] + x[i] * c + y[i] * s + z[i] * up)
    };
    let mut triangles = Vec::with_capacity(4 * sides);
    for k in 0..sides {
        let [a, b, c, d] = [at(k, 0.0), at(k + 1, 0.0), at(k + 1, height), at(k, height)];
        triangles.extend([[a, b, c], [a, c, d]]);
        if k + 2 < sides {
            triangles.push([at(0, 0.0), at(k + 2, 0.0), at(k + 1, 0.0)]);
            triangles.push([at(0, height), at(k + 1, height), at(k + 2, height)]);
        }
    }
    TriangleSoup { triangles }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prism_holds_its_cylinder_and_little_more() {
        let (base, axis, radius, height) = ([1.0, -2.0, 3.0], [0.3, -1.0, 0.5], 7.0, 11.0);
        let solid = of_mesh(&prism(base, axis, radius, height), "it", 0.0, (None, &())).expect("a solid");
        let z = nalgebra::Vector3::from(axis).normalize();
        for k in 0..500 {
            let (angle, up) = (f64::from(k) * 0.1, f64::from(k % 10) / 9.0 * height);
            let x = z.cross(&nalgebra::Vector3::x()).normalize();
            let off = (x * angle.cos() + z.cross(&x) * angle.sin()) * radius + z * up;
            let place = nalgebra::Vector3::from(base) + off;
            assert!((-1e-9..=CHORDS).contains(&solid.depth(place.into())));
        }
    }
}
