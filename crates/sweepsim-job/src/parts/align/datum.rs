//! Three-two-one: the part lies on three planes, one after another, as on an inspector's table.

use super::best::Fit;
use super::samples::Sample;
use nalgebra::{Isometry3, Matrix3, Point3, SymmetricEigen, Translation3, UnitQuaternion, Vector3};

/// A plane of the target, and the samples of the part that belong to it.
pub(super) struct Datum {
    pub name: String,
    pub origin: Point3<f64>,
    pub normal: Vector3<f64>,
    pub samples: Vec<Sample>,
}

/// Directions that are nearer to each other than this sine (3°) are parallel.
const PARALLEL: f64 = 0.05;
/// The turn about the first normal is found step by step, until a step is smaller than this.
const TURNS: usize = 50;
const STILL: f64 = 1e-15;

/// Whether three normals can hold a part: an error names those that cannot.
pub(super) fn check(datums: &[Datum; 3]) -> Result<(), String> {
    let [first, second, third] = datums;
    for datum in datums {
        if datum.samples.len() < 3 {
            let name = &datum.name;
            return Err(format!(
                "no surface of the part is near face {name}: expected a part that lies roughly on the target"
            ));
        }
    }
    if first.normal.cross(&second.normal).norm() < PARALLEL {
        return Err(format!(
            "{} and {} are parallel: expected faces that are not",
            first.name, second.name
        ));
    }
    let volume = first.normal.cross(&second.normal).normalize().dot(&third.normal).abs();
    if volume < PARALLEL {
        let [a, b, c] = [first, second, third].map(|datum| &datum.name);
        return Err(format!(
            "{c} is parallel to the edge of {a} and {b}: expected a face that crosses it"
        ));
    }
    Ok(())
}

/// The motion that lays the part's points of the first plane onto it (three degrees of freedom), then those of the
/// second as far as the first allows (two), then those of the third (one). Each by least squares of all its points.
pub(super) fn lay(datums: &[Datum; 3]) -> Isometry3<f64> {
    let [first, second, third] = datums;
    // Points are turned with what is known already.
    let places = |datum: &Datum, turn: &UnitQuaternion<f64>| -> Vec<Point3<f64>> {
        datum.samples.iter().map(|sample| turn * sample.place).collect()
    };
    let mean = |places: &[Point3<f64>]| {
        Point3::from(places.iter().map(|p| p.coords).sum::<Vector3<f64>>() / places.len().max(1) as f64)
    };
    // The first: the plane with the least squares of distances.
    let own = places(first, &UnitQuaternion::identity());
    let centre = mean(&own);
    let spread: Matrix3<f64> = own.iter().map(|p| (p - centre) * (p - centre).transpose()).sum();
    let eigen = SymmetricEigen::new(spread);
    let least = eigen.eigenvalues.imin();
    let fitted = eigen.eigenvectors.column(least).into_owned();
    let outwards: Vector3<f64> = first.samples.iter().map(|sample| sample.normal).sum();
    let fitted = fitted * fitted.dot(&outwards).signum();
    let turn = UnitQuaternion::rotation_between(&fitted, &first.normal)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
    // The second: a turn about the first's normal, so that its points are level along the edge of both planes.
    let across = (second.normal - first.normal * second.normal.dot(&first.normal)).normalize();
    let along = first.normal.cross(&across);
    let slope = second.normal.dot(&first.normal) / second.normal.dot(&across);
    let mut spin = UnitQuaternion::identity();
    for _ in 0..TURNS {
        let own = places(second, &(spin * turn));
        let centre = mean(&own);
        let (mut rise, mut square) = (0.0, 0.0);
        for p in &own {
            let off = p - centre;
            // Distances from the plane, over the way along the edge.
            rise += off.dot(&along) * (off.dot(&across) + slope * off.dot(&first.normal));
            square += off.dot(&along) * off.dot(&along);
        }
        let angle = if square > 0.0 { (rise / square).atan() } else { 0.0 };
        spin = UnitQuaternion::from_scaled_axis(first.normal * angle) * spin;
        if angle.abs() < STILL {
            break;
        }
    }
    let turn = spin * turn;
    // The shift: the means of all three lie in their planes.
    let rows = Matrix3::from_rows(&[
        first.normal.transpose(),
        second.normal.transpose(),
        third.normal.transpose(),
    ]);
    let off = datums
        .each_ref()
        .map(|datum| datum.normal.dot(&(datum.origin - mean(&places(datum, &turn)))));
    let shift = rows.lu().solve(&Vector3::from(off)).unwrap_or_default();
    Isometry3::from_parts(Translation3::from(shift), turn)
}

/// What is left on the three planes.
pub(super) fn left(datums: &[Datum; 3], motion: Isometry3<f64>) -> Fit {
    let distances = datums.iter().flat_map(|datum| {
        let distance = |sample: &Sample| datum.normal.dot(&(motion * sample.place - datum.origin));
        datum.samples.iter().map(distance)
    });
    let distances: Vec<f64> = distances.collect();
    let square: f64 = distances.iter().map(|d| d * d).sum();
    Fit {
        motion,
        rms: (square / distances.len().max(1) as f64).sqrt(),
        largest: distances.iter().fold(0.0, |most, d| f64::max(most, d.abs())),
        count: distances.len(),
        free: Vec::new(),
    }
}
