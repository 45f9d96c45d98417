//! How far a convex region reaches in a direction, by some of the planes that bound it.

use nalgebra::{DMatrix, DVector, Vector3};
use smallvec::SmallVec;

/// A unit normal `n`, and the largest `⟨n, x⟩` of a region.
pub(super) type Bound = (Vector3<f64>, f64);
/// The numbers of some planes, each with its weight in a sum.
pub(crate) type Weights = SmallVec<[(usize, f32); 3]>;

/// Steps towards the farthest point between planes.
const MOST_STEPS: usize = 64;
/// Directions that differ by less are the same.
const EDGE: f64 = 1e-9;
/// Weights have short numbers: less does not count.
const NOTHING: f64 = 1e-7;

/// The planes between which a convex region is that reach least far in a direction together: it is their sum, with
/// weights.
///
/// From a point of the region, one goes as far as possible in that direction, along the planes that are in the way; one
/// against which the sum would not push is left.
pub(super) fn bounding(planes: &[Bound], normal: &Vector3<f64>) -> Option<Weights> {
    let (mut at, mut active) = (middle(planes), SmallVec::<[usize; 3]>::new());
    for step in 0..MOST_STEPS {
        let normals: Vec<Vector3<f64>> = active.iter().map(|plane| planes[*plane].0).collect();
        let weights: Vec<f64> = match normals.len() {
            0 => Vec::new(),
            _ => {
                // The least squares.
                let own = DMatrix::from_fn(normals.len(), normals.len(), |i, j| normals[i].dot(&normals[j]));
                let along = DVector::from_fn(normals.len(), |i, _| normals[i].dot(normal));
                own.lu().solve(&along)?.iter().copied().collect()
            }
        };
        let sum: Vector3<f64> = normals.iter().zip(&weights).map(|(n, weight)| n * *weight).sum();
        let way = normal - sum;
        if way.norm() < NOTHING || active.len() == 3 {
            let worst = (0..weights.len()).min_by(|a, b| weights[*a].total_cmp(&weights[*b]))?;
            if weights[worst] < -NOTHING && step + 1 < MOST_STEPS {
                active.remove(worst);
                continue;
            }
            let all = active
                .iter()
                .zip(&weights)
                .map(|(plane, weight)| (*plane, *weight as f32));
            return Some(all.filter(|(_, weight)| *weight > 0.0).collect());
        }
        let far = |(number, (n, c)): (usize, &Bound)| {
            let is_ahead = n.dot(&way) > EDGE && !active.contains(&number);
            is_ahead.then(|| ((c - n.dot(&at)).max(0.0) / n.dot(&way), number))
        };
        let (far, plane) = { planes.iter().enumerate().filter_map(far) }.min_by(|a, b| a.0.total_cmp(&b.0))?;
        at += way * far;
        active.push(plane);
    }
    None
}

/// A point between planes, of which some are opposite to each other.
fn middle(planes: &[Bound]) -> Vector3<f64> {
    let opposite = |n: &Vector3<f64>| planes.iter().find(|(other, _)| (n + other).norm() < EDGE);
    let mut middle = Vector3::zeros();
    let mut known: SmallVec<[Vector3<f64>; 3]> = SmallVec::new();
    for (n, c) in planes {
        if known.iter().any(|other| other.dot(n).abs() > EDGE) {
            continue;
        }
        if let Some((_, other)) = opposite(n) {
            middle += n * (0.5 * (c - other));
            known.push(*n);
        }
    }
    middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::excess::regions;
    use sweepsim_dexel::Stock;

    type Reach<'a> = &'a dyn Fn(&Vector3<f64>) -> f64;

    /// How far the planes reach: never less far than the stock, and hardly farther.
    #[test]
    fn planes_reach_as_far_as_what_is_between_them() {
        let (base, axis) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.3, -0.2, 1.0).normalize());
        let (low, high) = (Vector3::new(-3.0, 1.0, 2.0), Vector3::new(5.0, 4.0, 9.0));
        let of_block = |n: &Vector3<f64>| (0..3).map(|k| (n[k] * low[k]).max(n[k] * high[k])).sum::<f64>();
        let of_cylinder = |n: &Vector3<f64>| {
            let along = n.dot(&axis);
            n.dot(&base) + (7.0 * along).max(0.0) + 4.0 * (n - axis * along).norm()
        };
        let of_ball = |n: &Vector3<f64>| n.dot(&base) + 4.0;
        let stocks: [(Stock, Reach, f64); 3] = [
            (
                Stock::Block {
                    min: low.into(),
                    max: high.into(),
                },
                &of_block,
                1e-5,
            ),
            (
                Stock::Cylinder {
                    base: base.into(),
                    axis: axis.into(),
                    radius: 4.0,
                    height: 7.0,
                },
                &of_cylinder,
                1e-4,
            ),
            (
                Stock::Ball {
                    centre: base.into(),
                    radius: 4.0,
                },
                &of_ball,
                0.02,
            ),
        ];
        for (stock, reach, more) in &stocks {
            let planes = regions(stock, 0.0).expect("no mesh").remove(0);
            let planes: Vec<Bound> = planes.into_iter().map(|(n, c)| (n.into(), c)).collect();
            let mut counts = [0; 4];
            for k in 0..400 {
                let angle = f64::from(k) * 2.4;
                let up = f64::from(k) / 199.5 - 1.0;
                let across = (1.0 - up * up).max(0.0).sqrt();
                let n = Vector3::new(across * angle.cos(), across * angle.sin(), up);
                let all = bounding(&planes, &n).expect("a sum");
                assert!(all.iter().all(|(_, weight)| *weight > 0.0));
                let of = |(plane, weight): &(usize, f32)| (planes[*plane].0, planes[*plane].1, f64::from(*weight));
                let sum: Vector3<f64> = all.iter().map(of).map(|(own, _, weight)| own * weight).sum();
                let top: f64 = all.iter().map(of).map(|(_, c, weight)| c * weight).sum();
                assert!((sum - n).norm() < 1e-6, "{stock:?} {n}");
                assert!(
                    top >= reach(&sum) - 1e-9 && top <= reach(&sum) + more,
                    "{stock:?} {n} {top}"
                );
                counts[all.len()] += 1;
            }
            assert!(counts[3] > 300 && counts[0] == 0, "{counts:?}");
        }
    }
}
