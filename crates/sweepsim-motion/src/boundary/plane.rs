//! Recognises patches that are pieces of a plane: their normals are those of the plane, times the weight.
//!
//! `F_u × F_v` is `n` times a function of many times the patch's degree, each of whose coefficients is rounded in all
//! three components. `N = w n` and `M = P × n` have the degree of the patch, and components that are 0 wherever the
//! plane is parallel to an axis.

use super::NormalField;
use super::normals::{ControlPoints, POLE, constant, cross};
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// How often a factor is divided that has coefficients of both signs.
const DEPTH: usize = 8;

/// What a patch's own control points may be off by besides, in halves of a rounding: three products with the rows of a
/// rotation and two sums, and as many in the sums here.
const OWN: f64 = 10.0;

/// A plane is known well enough if its points extend so many times as far as they may be off.
const WIDE: f64 = 1024.0;

/// The vector `n` of a flat patch's normals `N = w n`, of which the largest coefficient is 1, and the field; `N = n` if
/// the weight is constant. `None` if the patch is not flat up to rounding, or if its `own` normals, which may be
/// divided by distances from shrunk sides, are not certain to point to one side of it.
pub(super) fn field(
    position: &[Bernstein; 3],
    weight: &Bernstein,
    own: &[Bernstein; 3],
) -> Option<([f64; 3], NormalField)> {
    let normal = normal(&ControlPoints::new(position, weight))?;
    let along = (0..3).fold(Bernstein::constant(2, 0.0), |sum, k| sum.add(&own[k].scale(normal[k])));
    let sense = sign(along)?;
    let polynomial = constant(weight);
    let heaviest = polynomial.map_or(weight.magnitude(), |_| 1.0);
    let vector = normal * (sense / (normal.amax() * heaviest));
    // No -0.
    let vector = [0, 1, 2].map(|k| vector[k] + 0.0);
    let across = cross(position, &vector.map(|x| Bernstein::constant(2, x)));
    let (normal, moment) = match polynomial {
        Some(first) => (
            vector.map(|x| Bernstein::constant(2, x)),
            across.map(|form| form.scale(1.0 / first)),
        ),
        None => (vector.map(|x| weight.scale(x)), across),
    };
    let exact = |forms: [Bernstein; 3]| forms.map(Bernstein::assumed_exact);
    Some((
        vector,
        NormalField {
            normal: exact(normal),
            moment: exact(moment),
        },
    ))
}

/// A vector normal to the plane of control points, if they are all in one: along an axis or across it, exactly, if such
/// a plane holds them as well.
fn normal(control: &ControlPoints) -> Option<Vector3<f64>> {
    let all = &control.points;
    let first = Vector3::from(all.each_ref().map(|x| x[0]));
    let steps: Vec<Vector3<f64>> = (0..all[0].len())
        .map(|i| Vector3::from(all.each_ref().map(|x| x[i])) - first)
        .collect();
    let longest = |of: &dyn Fn(&Vector3<f64>) -> Vector3<f64>| {
        let all = steps.iter().map(of);
        all.max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
    };
    let along = longest(&|step| *step)?.try_normalize(0.0)?;
    let rest = |step: &Vector3<f64>| step - along * along.dot(step);
    // Once more: what is left may be much shorter.
    let across = longest(&|step| rest(&rest(step)))?;
    let size = all.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let off = control.off + 0.5 * OWN * f64::EPSILON * size;
    if !(across.norm() > WIDE * off) {
        return None;
    }
    let general = along.cross(&across).try_normalize(0.0)?;
    // With the longest step a, and b, the farthest from its line, a point is first + s a + t b with |s| ≤ 2, |t| ≤ 1
    // and |1 − s − t| ≤ 4: it and these may be off by 8 times as much.
    let holds = |normal: &Vector3<f64>| {
        let allowed = 8.0 * off * normal.lp_norm(1);
        steps.iter().all(|step| step.dot(normal).abs() <= allowed)
    };
    let axes = (0..3).map(|k| Vector3::ith(k, 1.0));
    let least = general.iamin();
    let parallel = || {
        let flat = |step: &Vector3<f64>| {
            let mut step = *step;
            step[least] = 0.0;
            step
        };
        longest(&flat)?.cross(&Vector3::ith(least, 1.0)).try_normalize(0.0)
    };
    axes.chain(parallel()).chain([general]).find(holds)
}

/// The sign of a form that has one on all of the unit square, but for rounding; `None` if it is not certain.
fn sign(form: Bernstein) -> Option<f64> {
    let allowed = POLE * f64::EPSILON * form.magnitude();
    let mut found = None;
    let mut open = vec![(form, 0)];
    while let Some((form, depth)) = open.pop() {
        let has = |sign: f64| form.coefficients().iter().all(|c| sign * c >= -allowed);
        match [1.0, -1.0].into_iter().find(|sign| has(*sign)) {
            // Coefficients that are all 0 but for rounding have both.
            Some(_) if form.magnitude() <= allowed => {}
            Some(sign) if found.is_none_or(|found| found == sign) => found = Some(sign),
            None if depth < DEPTH => {
                let (low, high) = form.split(depth % 2, 0.5);
                open.extend([(low, depth + 1), (high, depth + 1)]);
            }
            _ => return None,
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::normals::normals;
    use crate::{Patch, PatchError};
    use sweepsim_props::*;

    /// How a plane lies to the axes.
    #[derive(Clone, Copy, Debug)]
    enum Plane {
        Across(usize),
        Parallel(usize, f64),
        General([f64; 3]),
    }

    impl Plane {
        /// Two orthogonal directions in it, and its normal.
        fn directions(self) -> [Vector3<f64>; 3] {
            let axis = |k: usize| Vector3::ith(k % 3, 1.0);
            let [a, b] = match self {
                Self::Across(k) => [axis(k + 1), axis(k + 2)],
                Self::Parallel(k, angle) => [axis(k), axis(k + 1) * angle.cos() + axis(k + 2) * angle.sin()],
                Self::General(angles) => {
                    let [a, b, c] = angles;
                    let turn = nalgebra::Rotation3::from_euler_angles(a, b, c);
                    [turn * axis(0), turn * axis(1)]
                }
            };
            [a, b, a.cross(&b)]
        }

        /// The components of normals that are 0.
        fn zeros(self) -> Vec<usize> {
            match self {
                Self::Across(k) => vec![(k + 1) % 3, (k + 2) % 3],
                Self::Parallel(k, _) => vec![k],
                Self::General(_) => Vec::new(),
            }
        }
    }

    fn planes() -> impl Strategy<Value = Plane> {
        prop_oneof![
            (0_usize..3).prop_map(Plane::Across),
            (0_usize..3, 0.1..1.4).prop_map(|(k, angle)| Plane::Parallel(k, angle)),
            [0.2..1.3, 0.2..1.3, 0.2..1.3].prop_map(Plane::General),
        ]
    }

    /// A net in the plane about `centre`, its lower or upper side in `v` a point if there is a pole, with points off in
    /// the plane by `bumps` and out of it by `lift`, which is for one point.
    fn patch(
        ([p, q], pole): ([usize; 2], Option<bool>),
        (plane, centre): (Plane, [f64; 3]),
        (bumps, weights): (&[f64], &[f64]),
        lift: f64,
    ) -> ([Bernstein; 3], Bernstein) {
        let [a, b, up] = plane.directions();
        let points: Vec<Vector3<f64>> = (0..(p + 1) * (q + 1))
            .map(|i| {
                let along = (i % (p + 1)) as f64 / p as f64;
                let across = (i / (p + 1)) as f64 / q as f64;
                let far = match pole {
                    None => 1.0,
                    Some(false) => across,
                    Some(true) => 1.0 - across,
                };
                let near = if far == 0.0 { 0.0 } else { 1.0 };
                let s = far * (3.0 * along - 1.0) + near * bumps[2 * i];
                let t = across + near * bumps[2 * i + 1];
                Vector3::from(centre) + a * s + b * t + if i + 1 == p { up * lift } else { Vector3::zeros() }
            })
            .collect();
        let form =
            |value: &dyn Fn(usize) -> f64| Bernstein::new(&[p, q], (0..points.len()).map(value).collect()).unwrap();
        let position = [0, 1, 2].map(|k| form(&|i| points[i][k] * weights[i]));
        (position, form(&|i| weights[i]))
    }

    fn at(forms: &[Bernstein; 3], place: &[f64]) -> Vector3<f64> {
        Vector3::from([0, 1, 2].map(|k| forms[k].evaluate(place)))
    }

    proptest! {
        /// Flat patches have the normals of their plane: exact zeros where it is parallel to an axis, on the same side
        /// as `F_u × F_v`, with sides shrunk to a point or without.
        #[test]
        fn flat_patches_have_the_normals_of_their_planes(
            degrees in [1_usize..5, 1_usize..5], pole in prop::option::of(any::<bool>()), plane in planes(), centre in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
            bumps in collection::vec(-0.02..0.02, 50), weights in collection::vec(0.8..1.25, 25), rational in any::<bool>(), swapped in any::<bool>(),
            places in collection::vec([0.05..0.95, 0.05..0.95], 4),
        ) {
            let weights = if rational { weights } else { vec![1.5; 25] };
            let (mut position, mut weight) = patch((degrees, pole), (plane, centre), (&bumps, &weights), 0.0);
            if swapped {
                let turn = |form: &Bernstein| form.extend(2, &[1, 0]).unwrap();
                (position, weight) = (position.each_ref().map(turn), turn(&weight));
            }
            let patch = Patch::new(position.clone(), weight.clone()).unwrap();
            let vector = Vector3::from(patch.plane().expect("a plane"));
            prop_assert!(patch.product().is_none());
            patch.field.check(&patch.position, &patch.weight).unwrap();
            // Along the normal, as far as the points are: off by 8 times as much as each of them at a distance of at
            // least 1.
            let [.., up] = plane.directions();
            let off = 8.0 * 0.5 * (2.0 * (degrees[0] + degrees[1] + 3) as f64 + OWN) * f64::EPSILON * 54.0;
            let sense = if swapped { -1.0 } else { 1.0 };
            prop_assert!((vector.normalize() - up * sense).norm() <= 4.0 * off, "{vector} {up}");
            for k in 0..3 {
                prop_assert_eq!(vector[k] == 0.0, plane.zeros().contains(&k));
                for (normal, weight) in patch.field.normal[k].coefficients().iter().zip(patch.weight.coefficients()) {
                    prop_assert_eq!(*normal, vector[k] * if rational { *weight } else { 1.0 });
                }
            }
            let largest = patch.field.normal.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
            prop_assert!((largest - 1.0).abs() <= 4.0 * f64::EPSILON);
            if let Plane::Across(k) = plane {
                prop_assert!(patch.field.moment[k].magnitude() == 0.0);
            }
            let (product, sides) = normals(&position, &weight);
            prop_assert_eq!(patch.shrunk_sides(), sides);
            let shrunk = sides.as_flattened().iter().filter(|side| **side).count();
            prop_assert_eq!(shrunk, usize::from(pole.is_some()));
            for place in &places {
                let (own, other) = (at(&patch.field.normal, place), at(&product.normal, place));
                prop_assert!(own.dot(&other) > 0.999 * own.norm() * other.norm());
                let point = at(&position, place) / weight.evaluate(place);
                prop_assert!((point.cross(&own) - at(&patch.field.moment, place)).amax() <= 64.0 * f64::EPSILON * 54.0);
            }
        }

        /// A point that is off by more than rounding makes no plane.
        #[test]
        fn others_are_left_alone(
            degrees in [2_usize..5, 2_usize..5], plane in planes(), weights in collection::vec(0.8..1.25, 25), digits in 1.0..11.0_f64,
        ) {
            let lift = 10_f64.powf(-digits);
            let (position, weight) = patch((degrees, None), (plane, [3.0, -2.0, 5.0]), (&[0.0; 50], &weights), lift);
            let patch = Patch::new(position, weight).unwrap();
            prop_assert!(patch.plane().is_none() && patch.product().is_some());
        }
    }

    /// Whatever lies in a plane, but folded, is no patch, and a sliver no plane.
    #[test]
    fn folds_and_slivers() {
        let form = |c: [f64; 6]| Bernstein::new(&[2, 1], c.to_vec()).unwrap();
        let one = || Bernstein::constant(2, 1.0).elevated_to(&[2, 1]);
        let sheet = |x: [f64; 3], width: f64| {
            let [a, b, c] = x;
            let position = [
                form([a, b, c, a, b, c]),
                form([0.0, 0.0, 0.0, width, width, width]),
                form([a, b, c, a, b, c]),
            ];
            Patch::new(position, one())
        };
        assert!(sheet([0.0, 1.0, 2.0], 1.0).unwrap().plane().is_some());
        assert!(matches!(sheet([0.0, 2.0, 1.0], 1.0), Err(PatchError::NoNormal { .. })));
        assert!(sheet([0.0, 1.0, 2.0], 1e-12).unwrap().plane().is_none());
    }

    /// A sign is certain if it is that of all coefficients, if need be after division, up to rounding.
    #[test]
    fn signs() {
        let form = |c: [f64; 4]| Bernstein::new(&[1, 1], c.to_vec()).unwrap();
        assert_eq!(sign(form([1.0, 2.0, 0.0, -1e-17])), Some(1.0));
        assert_eq!(sign(form([-1.0, -2.0, -0.5, -1.0])), Some(-1.0));
        assert_eq!(sign(form([1.0, 2.0, 3.0, -1e-3])), None);
        assert_eq!(sign(form([0.0; 4])), None);
        // (x − 1/2)² + 1/100, whose coefficient in the middle is negative.
        let parabola = Bernstein::new(&[2], vec![0.26, -0.24, 0.26]).unwrap();
        assert_eq!(sign(parabola.extend(2, &[0]).unwrap()), Some(1.0));
    }
}
