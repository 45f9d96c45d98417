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

/// The planes between which a convex region is that reach least far in a direction together: it is their sum, with
/// weights.
///
/// From a point of the region, one goes as far as possible in that direction, along the planes that are in the way; one
/// against which the sum would not push is left.
pub(super) fn bounding(planes: &[Bound], normal: &Vector3<f64>) -> Option<Weights> {
    let (mut at, mut active) = (middle(planes), SmallVec::<[usize; 3]>::new());
    for _ in 0..MOST_STEPS {
        let normals: Vec<Vector3<f64>> = active.iter().map(|plane| planes[*plane].0).collect();
        let weights: Vec<f64> = match normals.len() {
            0 => Vec::new(),
            _ => {
                let svd = DMatrix::from_fn(3, normals.len(), |row, column| normals[column][row]).svd(true, true);
                let own = svd.solve(&DVector::from_column_slice(normal.as_slice()), EDGE).ok()?;
                own.iter().copied().collect()
            }
        };
        let sum: Vector3<f64> = normals.iter().zip(&weights).map(|(n, weight)| n * *weight).sum();
        let way = normal - sum;
        if way.norm() < EDGE || active.len() == 3 {
            let worst = (0..weights.len()).min_by(|a, b| weights[*a].total_cmp(&weights[*b]))?;
            if weights[worst] < 0.0 {
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
        // Across each other come first.
        if let Some((_, other)) = opposite(n).filter(|_| known.iter().all(|k| k.dot(n).abs() < EDGE)) {
            middle += n * (0.5 * (c - other));
            known.push(*n);
        }
        if known.len() == 3 {
            break;
        }
    }
    middle
}
