//! Intervals on lines of any direction.

use sweepsim::nalgebra::{Rotation3, Vector3};
use sweepsim::prelude::*;
use sweepsim::{Ray, RayError, probe};
use sweepsim_props::*;

fn tool() -> Tool {
    Tool::bull(4.0, 1.0, 20.0).unwrap()
}

fn poses(turn: &Rotation3<f64>) -> Path {
    let given = [
        ([-12.0, 3.0, 0.0], [0.3, 0.0, 1.0]),
        ([0.0, 0.0, 2.0], [0.0, 0.2, 1.0]),
        ([12.0, -5.0, 1.0], [-0.2, 0.2, 1.0]),
    ];
    let moved = given.map(|(tip, axis)| {
        let [tip, axis] = [tip, axis].map(|v| <[f64; 3]>::from(turn * Vector3::from(v)));
        Pose::new(tip, axis).unwrap()
    });
    Path::new(moved.to_vec()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Everything turned together: the distances stay, and the normals turn too.
    #[test]
    fn probes_turn_with_what_they_probe(
        angles in [-3.0..3.0, -3.0..3.0, -3.0..3.0f64], origin in [-9.0..9.0, -4.0..4.0, -5.0..5.0f64],
        direction in [-1.0..1.0, -1.0..1.0, 0.2..1.0f64],
    ) {
        let turn = Rotation3::new(Vector3::from(angles));
        let ray = Ray::new(origin, direction).unwrap();
        let [at, along] = [origin, direction].map(|v| <[f64; 3]>::from(turn * Vector3::from(v)));
        let turned = Ray::new(at, along).unwrap();
        let options = Options::new(1e-6);
        let own = probe(&tool(), &poses(&Rotation3::identity()), &[ray], &options, &()).unwrap();
        let other = probe(&tool(), &poses(&turn), &[turned], &options, &()).unwrap();
        let (own, other) = (own[0].as_ref().unwrap(), other[0].as_ref().unwrap());
        prop_assert_eq!(own.len(), other.len());
        for (a, b) in own.iter().zip(other) {
            for (a, b) in [(a.lower, b.lower), (a.upper, b.upper)] {
                let normal = Vector3::from(a.normal.map(f64::from));
                let steep = normal.dot(&Vector3::from(ray.direction())).abs();
                prop_assert!((a.z - b.z).abs() * steep < 2e-6, "{} {}", a.z, b.z);
                if steep > 0.1 {
                    let back = turn.inverse() * Vector3::from(b.normal.map(f64::from));
                    // Each is stored to 6.5e-5.
                    prop_assert!((back - normal).norm() < 1.4e-4);
                }
            }
        }
    }

    /// Whatever the numbers: an error, or a ray whose direction has length one.
    #[test]
    fn rays_are_valid_or_refused(origin in prop::array::uniform3(any::<f64>()), direction in prop::array::uniform3(any::<f64>())) {
        match Ray::new(origin, direction) {
            Ok(ray) => {
                prop_assert!((Vector3::from(ray.direction()).norm() - 1.0).abs() < 1e-14);
                prop_assert!(ray.origin().iter().all(|x| x.is_finite()));
            }
            Err(RayError::Origin(at)) => prop_assert!(!at.iter().all(|x| x.is_finite())),
            Err(error) => prop_assert!(!direction.iter().all(|x| x.is_finite()) || direction == [0.0; 3], "{error}"),
        }
    }
}

#[test]
fn behind_the_origin_distances_are_negative() {
    let up = [0.0, 0.0, 1.0];
    let path = Path::new(vec![
        Pose::new([0.0; 3], up).unwrap(),
        Pose::new([10.0, 0.0, 0.0], up).unwrap(),
    ])
    .unwrap();
    let ray = Ray::new([5.0, 0.0, 50.0], [0.0, 0.0, 2.0]).unwrap();
    let down = Ray::new([5.0, 0.0, 50.0], [0.0, 0.0, -1.0]).unwrap();
    let found = probe(&tool(), &path, &[ray, down], &Options::new(1e-6), &()).unwrap();
    let ends = |n: usize| {
        let all = found[n].as_ref().unwrap();
        (all.len(), all[0].lower.z, all[0].upper.z)
    };
    let ((one, a, b), (other, c, d)) = (ends(0), ends(1));
    assert_eq!((one, other), (1, 1));
    assert!((a + 50.0).abs() < 1e-6 && (b + 30.0).abs() < 1e-6, "{a} {b}");
    assert!((c - 30.0).abs() < 1e-6 && (d - 50.0).abs() < 1e-6, "{c} {d}");
}
