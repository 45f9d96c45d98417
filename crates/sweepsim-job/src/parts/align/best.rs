//! The rigid motion with the least squares of the distances of a part's surface from its target's: iterated closest
//! points, each step by the distances along their gradients (Chen, Medioni 1992), from several starts.

use super::motion::NormalEquations;
use super::samples::{Sample, middle};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3, Vector6};
use rayon::prelude::*;
use sweepsim_dexel::{AnalyticSurface, DistanceTo, FaceSurfaces};

/// Steps from each start, with few samples, and of the best with all.
const FIRST: usize = 40;
pub(super) const LAST: usize = 100;
/// The samples of the first steps: every so manyth.
const SPARSE: usize = 10;
/// Points belong to a face if their normals are within 30° of its normal.
pub(super) const FACING: f64 = 0.866;
/// A step that is this share of the part is none.
const STILL: f64 = 1e-13;

/// Which points of a target count, and how.
pub(super) enum Counted<'a> {
    /// All, by their distance.
    Surface,
    /// All, by their distance from what faces the same way: so the sides of a web are told apart from further away.
    Facing,
    /// Those of planes and cylinders, whatever the radius of a cylinder of the part is.
    Features(&'a FaceSurfaces),
}

/// Where a fit has come to.
#[derive(Clone)]
pub(super) struct Fit {
    pub motion: Isometry3<f64>,
    /// The root of the mean square of what is left, over the samples that count.
    pub rms: f64,
    pub largest: f64,
    /// How many samples count.
    pub count: usize,
    pub free: Vec<String>,
}

/// A sample that counts: where it is, how far from the target, in which direction that grows, and its cylinder.
type Pair = (Point3<f64>, f64, Vector3<f64>, Option<u32>);

pub(super) struct Target<'a> {
    pub tree: &'a DistanceTo,
    pub counted: Counted<'a>,
}

impl Target<'_> {
    fn pairs(&self, samples: &[Sample], motion: &Isometry3<f64>) -> Vec<Pair> {
        let pair = |sample: &Sample| -> Option<Pair> {
            let place = motion * sample.place;
            let normal = motion * sample.normal;
            let near = match self.counted {
                Counted::Surface => self.tree.nearest(place.coords.into())?,
                _ => self
                    .tree
                    .nearest_facing(place.coords.into(), normal.into(), f64::INFINITY)?,
            };
            let off = place - Point3::from(near.place);
            let far = off.norm();
            match &self.counted {
                Counted::Surface | Counted::Facing => {
                    // On the surface itself the distance grows along the normal.
                    let small = far <= 1e-9 * (1.0 + place.coords.amax());
                    let grows = if small {
                        near.normal.into()
                    } else {
                        off * (near.distance.signum() / far)
                    };
                    Some((place, near.distance, grows, None))
                }
                Counted::Features(faces) => {
                    // Beside the edge of a face another one may be as near.
                    if normal.dot(&Vector3::from(near.normal)) < FACING {
                        return None;
                    }
                    let face = *faces.face_of.get(near.triangle)?;
                    let surface = faces.of_triangle(near.triangle)?;
                    let round = match surface {
                        AnalyticSurface::Plane { .. } => None,
                        AnalyticSurface::Cylinder { .. } => Some(face),
                        _ => return None,
                    };
                    let (distance, grows) = surface.distance(place.coords.into())?;
                    Some((place, distance, grows.into(), round))
                }
            }
        };
        samples.par_iter().filter_map(pair).collect()
    }

    /// Steps until nothing moves any more.
    pub fn fit(&self, samples: &[Sample], start: Isometry3<f64>, most: usize) -> Fit {
        let mut motion = start;
        for _ in 0..most {
            let (_, size) = middle(samples);
            let solution = self.equations(&self.pairs(samples, &motion)).0.solve();
            motion = solution.motion * motion;
            if solution.step <= STILL * (1.0 + size) {
                break;
            }
        }
        let pairs = self.pairs(samples, &motion);
        let (equations, left) = self.equations(&pairs);
        let square: f64 = left.iter().map(|distance| distance * distance).sum();
        Fit {
            motion,
            rms: (square / left.len().max(1) as f64).sqrt(),
            largest: left.iter().fold(0.0, |most, distance| f64::max(most, distance.abs())),
            count: left.len(),
            free: equations.words(&equations.solve().free),
        }
    }

    /// The equations of the next step, and what is left of each distance. The radius of a cylinder is free: only what
    /// differs from the mean of its samples counts.
    fn equations(&self, pairs: &[Pair]) -> (NormalEquations, Vec<f64>) {
        let places: Vec<Sample> = pairs
            .iter()
            .map(|(place, _, normal, _)| Sample {
                place: *place,
                normal: *normal,
            })
            .collect();
        let (centre, size) = middle(&places);
        let mut equations = NormalEquations::about(centre, size);
        let mut means: std::collections::BTreeMap<u32, (Vector6<f64>, f64, f64)> = std::collections::BTreeMap::new();
        for (place, distance, grows, round) in pairs {
            if let Some(round) = round {
                let mean = means.entry(*round).or_default();
                mean.0 += equations.row(place, grows);
                mean.1 += distance;
                mean.2 += 1.0;
            }
        }
        let mut left = Vec::with_capacity(pairs.len());
        for (place, distance, grows, round) in pairs {
            let mean = round.and_then(|round| means.get(&round));
            let (row, distance) = match mean {
                Some((row, sum, count)) => (equations.row(place, grows) - row / *count, distance - sum / count),
                None => (equations.row(place, grows), *distance),
            };
            equations.add(&row, distance, 1.0);
            left.push(distance);
        }
        (equations, left)
    }
}

/// The best of all starts: as the part lies, and with its principal axes along those of the target. Of those that are
/// as good, as for a part with a symmetry, the one that moves least.
pub(super) fn best(tree: &DistanceTo, samples: &[Sample], goal: &[Sample]) -> Fit {
    let few: Vec<Sample> = samples.iter().step_by(SPARSE).copied().collect();
    let [facing, all] = [Counted::Facing, Counted::Surface].map(|counted| Target { tree, counted });
    let starts = std::iter::once(Isometry3::identity()).chain(by_axes(samples, goal));
    let found: Vec<Fit> = starts.map(|start| facing.fit(&few, start, FIRST)).collect();
    // A fit of a few samples is none of the others.
    let rating = |fit: &Fit| {
        if 2 * fit.count < few.len() {
            f64::INFINITY
        } else {
            fit.rms
        }
    };
    let best = found.iter().map(rating).fold(f64::INFINITY, f64::min);
    let (_, size) = middle(samples);
    let good = found.iter().filter(|fit| !(rating(fit) > 1.05 * best + 1e-6 * size));
    let least = good.min_by(|a, b| moved(&a.motion, samples).total_cmp(&moved(&b.motion, samples)));
    let start = least.map_or_else(Isometry3::identity, |fit| fit.motion);
    all.fit(samples, start, LAST)
}

/// How far the samples move in the mean.
fn moved(motion: &Isometry3<f64>, samples: &[Sample]) -> f64 {
    samples
        .iter()
        .step_by(SPARSE)
        .map(|s| (motion * s.place - s.place).norm())
        .sum()
}

/// The four turns that bring the principal axes of a surface onto those of another one.
fn by_axes(samples: &[Sample], goal: &[Sample]) -> Vec<Isometry3<f64>> {
    let axes = |samples: &[Sample]| {
        let (centre, _) = middle(samples);
        let spread: Matrix3<f64> = samples
            .iter()
            .map(|s| (s.place - centre) * (s.place - centre).transpose())
            .sum();
        let eigen = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let [x, y] = [order[0], order[1]].map(|k| eigen.eigenvectors.column(k).into_owned());
        (centre, Matrix3::from_columns(&[x, y, x.cross(&y)]))
    };
    if samples.is_empty() || goal.is_empty() {
        return Vec::new();
    }
    let ((from, own), (to, wanted)) = (axes(samples), axes(goal));
    let flips = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let start = |[x, y]: [f64; 2]| {
        let flip = Matrix3::from_diagonal(&Vector3::new(x, y, x * y));
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&(wanted * flip * own.transpose())));
        Isometry3::from_parts(Translation3::from(to - turn * from), turn)
    };
    flips.map(start).into()
}
