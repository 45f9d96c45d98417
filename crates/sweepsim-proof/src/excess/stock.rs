//! What there was before the first cut.

use super::bounding::{Bound, Weights, bounding};
use super::mesh;
use super::patch::Points;
use nalgebra::Vector3;
use smallvec::SmallVec;
use sweepsim_check::Plane;
use sweepsim_dexel::{DistanceTo, MeshError, Stock};

/// A stock, prepared for what is asked of it here: without its skin, so that what ends on its surface is beside it.
pub(crate) struct Before {
    shape: Shape,
    outer: Vec<Outer>,
    margin: f64,
}

/// Something that a stock is within.
enum Outer {
    /// The points with `⟨n, x⟩ ≤ c` for all of some unit vectors `n`.
    Planes(Vec<Bound>),
    Mesh(DistanceTo),
}

/// A cylinder is between so many planes, and a ball between as many in each of half as many turns.
const SIDES: usize = 720;
const SIDES_OF_BALL: usize = 64;
/// Regions are cut at so many of their planes, while there are no more points.
const CUT: usize = 6;
const MOST_POINTS: usize = 48;

/// Convex regions that hold a stock, by the unit normals `n` of planes and the largest `⟨n, x⟩`. `None` of a mesh.
/// `skin`: they are smaller by that.
#[must_use]
pub fn regions(stock: &Stock, skin: f64) -> Option<Vec<Vec<Plane>>> {
    let region = |outer: Outer| match outer {
        Outer::Planes(planes) => Some(planes.into_iter().map(|(n, c)| (n.into(), c)).collect()),
        Outer::Mesh(_) => None,
    };
    outer(stock, skin).ok()?.into_iter().map(region).collect()
}

fn outer(stock: &Stock, skin: f64) -> Result<Vec<Outer>, MeshError> {
    let planes = |all: &mut dyn Iterator<Item = (Vector3<f64>, f64)>| {
        vec![Outer::Planes(all.map(|(n, c)| (n, c - skin)).collect())]
    };
    let between = |low: &[f64; 3], high: &[f64; 3]| {
        let side = |k: usize, c: f64| {
            let n = Vector3::ith(k, 1.0);
            if c > 0.0 { (n, high[k]) } else { (-n, -low[k]) }
        };
        planes(&mut (0..3).flat_map(|k| [side(k, 1.0), side(k, -1.0)]))
    };
    Ok(match stock {
        Stock::Block { min, max } => between(min, max),
        Stock::Cylinder {
            base,
            axis,
            radius,
            height,
        } => {
            let (base, axis) = (Vector3::from(*base), Vector3::from(*axis).normalize());
            let x = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
            let y = axis.cross(&x);
            let side = |k: usize| {
                // Four across each other come first.
                let angle = std::f64::consts::TAU * (k * (SIDES / 4 + 1) % SIDES) as f64 / SIDES as f64;
                let n = x * angle.cos() + y * angle.sin();
                (n, n.dot(&base) + radius)
            };
            let ends = [(axis, axis.dot(&base) + height), (-axis, -axis.dot(&base))];
            planes(&mut ends.into_iter().chain((0..SIDES).map(side)))
        }
        Stock::Ball { centre, radius } => {
            let centre = Vector3::from(*centre);
            let angle = |k: usize| std::f64::consts::TAU * k as f64 / SIDES_OF_BALL as f64;
            let turns = (0..=SIDES_OF_BALL / 2).flat_map(|i| (0..SIDES_OF_BALL).map(move |j| (i, j)));
            let side = |(i, j): (usize, usize)| {
                let [up, around] = [angle(i), angle(j)];
                let n = Vector3::new(up.sin() * around.cos(), up.sin() * around.sin(), up.cos());
                (n, n.dot(&centre) + radius)
            };
            planes(&mut turns.map(side))
        }
        Stock::Mesh(soup) => vec![Outer::Mesh(DistanceTo::new(soup)?)],
        Stock::Union(parts) => {
            let all = parts.iter().map(|part| outer(part, skin));
            all.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect()
        }
        Stock::Intersection(parts) => match parts.first() {
            Some(first) => outer(first, skin)?,
            None => Vec::new(),
        },
        Stock::Difference(whole, _) => outer(whole, skin)?,
        // Dexels, which say nothing of what is between them.
        _ => stock.bounds().map_or(Vec::new(), |[low, high]| between(&low, &high)),
    })
}

enum Shape {
    Block([Vector3<f64>; 2]),
    Cylinder {
        base: Vector3<f64>,
        axis: Vector3<f64>,
        radius: f64,
        height: f64,
    },
    Ball(Vector3<f64>, f64),
    Mesh(DistanceTo),
    /// Something within a box.
    Within([Vector3<f64>; 2]),
    Union(Vec<Self>),
    Intersection(Vec<Self>),
    Difference(Box<Self>, Vec<Self>),
}

impl Before {
    /// `margin`: points are beside it if they are so by this. Its skin is three times as thick, so that a cutter that
    /// reaches its surface holds what is left of it.
    pub fn new(stock: &Stock, margin: f64) -> Result<Self, MeshError> {
        Ok(Self {
            shape: Shape::new(stock)?,
            outer: outer(stock, 3.0 * margin)?,
            margin,
        })
    }

    /// Points whose hull has all of the stock that is in the hull of some points. `middle`: a point among them.
    pub fn within(&self, points: &[Vector3<f64>], middle: &Vector3<f64>) -> Points {
        let mut all = Points::new();
        for outer in &self.outer {
            match outer {
                Outer::Planes(planes) => {
                    let above = |(n, c): &(Vector3<f64>, f64), p: &Vector3<f64>| n.dot(p) - (c + self.margin);
                    if planes.iter().any(|plane| points.iter().all(|p| above(plane, p) > 0.0)) {
                        continue;
                    }
                    let cut = |points: Points, plane| match points.len() {
                        // Each plane may make many points out of few: some of them will do.
                        ..=MOST_POINTS => below(points, |p| above(plane, p)),
                        _ => points,
                    };
                    all.extend(planes.iter().take(CUT).fold(points.iter().copied().collect(), cut));
                }
                Outer::Mesh(distance) => {
                    if !mesh::misses(distance, points, middle, self.margin) {
                        all.extend(points.iter().copied());
                    }
                }
            }
        }
        all
    }

    /// Whether the hull of some points is farther from it than a distance, for certain; or, if that is negative, no
    /// deeper in it. `normal`: a direction away from it, if they are beside it.
    pub fn is_beside(&self, points: &[Vector3<f64>], normal: &Vector3<f64>, distance: f64) -> bool {
        let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        self.shape.misses(points, (&middle, normal), -distance)
    }

    /// Points whose hull has what of the hull of some points is nearer to a block than a distance, or deeper in it.
    pub fn near(&self, mut points: Points, distance: f64) -> Points {
        if let Shape::Block([low, high]) | Shape::Within([low, high]) = &self.shape {
            for k in 0..3 {
                for side in [1.0, -1.0] {
                    let end = if side > 0.0 { high[k] } else { low[k] };
                    if points.len() <= MOST_POINTS {
                        points = below(points, |point| side * (point[k] - end) - distance);
                    }
                }
            }
        }
        points
    }

    /// For each region that holds the stock, some of its planes, each with a weight: the sum has the region below it,
    /// and something above, by a distance. `over`: whether that is so, for a direction and a height along it; `normal`:
    /// the direction that is tried if no plane will do alone. `None` of a mesh, or if it is not so.
    ///
    /// If the distance is negative, something may be `allowed` so deep in the stock: that is so of several regions only
    /// if one direction leads out of all of them that are not farther than that.
    pub fn planes_below(
        &self,
        over: &dyn Fn(&Vector3<f64>, f64) -> bool,
        normal: &Vector3<f64>,
        (distance, allowed): (f64, f64),
    ) -> Option<Vec<Weights>> {
        let mut way: Option<Vector3<f64>> = None;
        let mut one = |outer: &Outer| {
            let Outer::Planes(planes) = outer else { return None };
            let by = |more: f64| move |(_, (n, c)): &(usize, &Bound)| over(n, c + distance + more);
            let along = |(_, (n, _)): &(usize, &Bound)| n.dot(normal);
            let all = || planes.iter().enumerate();
            if let Some((alone, _)) = all().find(by(2.0 * allowed)) {
                return Some(Weights::from_slice(&[(alone, 1.0)]));
            }
            let alone = { all().filter(by(0.0)) }.max_by(|a, b| along(a).total_cmp(&along(b)));
            let (n, sum) = match alone {
                Some((number, (n, _))) => (*n, Weights::from_slice(&[(number, 1.0)])),
                None => {
                    let sum = bounding(planes, normal)?;
                    let of = |(plane, weight): &(usize, f32)| (planes[*plane], f64::from(*weight));
                    let n: Vector3<f64> = sum.iter().map(of).map(|((n, _), weight)| n * weight).sum();
                    let top: f64 = sum.iter().map(of).map(|((_, c), weight)| c * weight).sum();
                    if sum.len() < 2 || !over(&n, top + distance * n.norm()) {
                        return None;
                    }
                    (n, sum)
                }
            };
            (*way.get_or_insert(n) == n).then_some(sum)
        };
        self.outer.iter().map(&mut one).collect()
    }

    /// In how many regions it is.
    pub fn regions(&self) -> usize {
        self.outer.len()
    }

    /// Whether all of these are between planes.
    pub fn is_between_planes(&self) -> bool {
        self.outer.iter().all(|outer| matches!(outer, Outer::Planes(_)))
    }

    /// Whether it is known to be convex.
    pub fn is_convex(&self) -> bool {
        matches!(self.shape, Shape::Block(_) | Shape::Cylinder { .. } | Shape::Ball(..))
    }

    /// Whether all that is nearer to a point than a distance is in it, for certain.
    pub fn holds_around(&self, point: &Vector3<f64>, distance: f64) -> bool {
        self.shape.holds(point, distance)
    }

    /// Whether a point is in it, for certain.
    pub fn holds(&self, point: &Vector3<f64>) -> bool {
        self.shape.holds(point, 0.0)
    }
}

/// Points whose hull is what of the hull of some points is below a plane. `above`: how far one is above it.
fn below(points: Points, above: impl Fn(&Vector3<f64>) -> f64) -> Points {
    let heights: SmallVec<[f64; 12]> = points.iter().map(&above).collect();
    if heights.iter().all(|height| *height <= 0.0) {
        return points;
    }
    let of_sign = |is_above: bool| {
        let all = points.iter().zip(&heights);
        all.filter(move |(_, height)| (**height > 0.0) == is_above)
    };
    let mut kept: Points = of_sign(false).map(|(point, _)| *point).collect();
    for (a, u) in of_sign(false) {
        kept.extend(of_sign(true).map(|(b, v)| a + (b - a) * (-u / (v - u))));
    }
    kept
}

impl Shape {
    fn new(stock: &Stock) -> Result<Self, MeshError> {
        let all = |parts: &[Stock]| parts.iter().map(Self::new).collect::<Result<Vec<_>, _>>();
        Ok(match stock {
            Stock::Block { min, max } => Self::Block([(*min).into(), (*max).into()]),
            Stock::Cylinder {
                base,
                axis,
                radius,
                height,
            } => Self::Cylinder {
                base: (*base).into(),
                axis: Vector3::from(*axis).normalize(),
                radius: *radius,
                height: *height,
            },
            Stock::Ball { centre, radius } => Self::Ball((*centre).into(), *radius),
            Stock::Mesh(soup) => Self::Mesh(DistanceTo::new(soup)?),
            Stock::Union(parts) => Self::Union(all(parts)?),
            Stock::Intersection(parts) => Self::Intersection(all(parts)?),
            Stock::Difference(whole, parts) => Self::Difference(Box::new(Self::new(whole)?), all(parts)?),
            // Dexels, which say nothing of what is between them.
            _ => match stock.bounds() {
                Some(ends) => Self::Within(ends.map(Vector3::from)),
                None => Self::Union(Vec::new()),
            },
        })
    }

    fn misses(&self, points: &[Vector3<f64>], (middle, normal): (&Vector3<f64>, &Vector3<f64>), skin: f64) -> bool {
        let least = |direction: &Vector3<f64>| {
            let values = points.iter().map(|point| point.dot(direction));
            values.fold(f64::INFINITY, f64::min) + skin
        };
        match self {
            Self::Block([low, high]) | Self::Within([low, high]) => {
                let farthest = low.zip_zip_map(high, normal, |low, high, n| n * if n < 0.0 { low } else { high });
                let beyond = |k: usize| {
                    let all = || points.iter().map(|point| point[k]);
                    all().all(|c| c + skin > high[k]) || all().all(|c| c - skin < low[k])
                };
                least(normal) > farthest.sum() || (0..3).any(beyond)
            }
            Self::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                let off = middle - base;
                let across = (off - axis * off.dot(axis)).try_normalize(1e-12);
                let along = normal.dot(axis);
                let farthest = normal.dot(base) + (along * height).max(0.0) + radius * (normal - axis * along).norm();
                least(normal) > farthest
                    || least(axis) > base.dot(axis) + height
                    || least(&-axis) > -base.dot(axis)
                    || across.is_some_and(|across| least(&across) > base.dot(&across) + radius)
            }
            Self::Ball(centre, radius) => {
                let away = (middle - centre).try_normalize(1e-12);
                away.is_some_and(|away| least(&away) > centre.dot(&away) + radius)
            }
            Self::Mesh(distance) => mesh::misses(distance, points, middle, skin),
            Self::Union(parts) => parts.iter().all(|part| part.misses(points, (middle, normal), skin)),
            Self::Intersection(parts) => {
                parts.is_empty() || parts.iter().any(|part| part.misses(points, (middle, normal), skin))
            }
            Self::Difference(whole, _) => whole.misses(points, (middle, normal), skin),
        }
    }

    /// Whether all that is nearer to a point than a distance is in it.
    fn holds(&self, point: &Vector3<f64>, distance: f64) -> bool {
        match self {
            Self::Block([low, high]) => (0..3).all(|k| point[k] - distance > low[k] && point[k] + distance < high[k]),
            Self::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                let off = point - base;
                let along = off.dot(axis);
                along > distance && along + distance < *height && (off - axis * along).norm() + distance < *radius
            }
            Self::Ball(centre, radius) => (point - centre).norm() + distance < *radius,
            Self::Mesh(surface) => {
                let nearest = surface.nearest((*point).into());
                nearest.is_some_and(|nearest| nearest.distance < -distance)
            }
            Self::Within(_) => false,
            Self::Union(parts) => parts.iter().any(|part| part.holds(point, distance)),
            Self::Intersection(parts) => !parts.is_empty() && parts.iter().all(|part| part.holds(point, distance)),
            Self::Difference(whole, parts) => {
                whole.holds(point, distance)
                    && parts
                        .iter()
                        .all(|part| part.misses(&[*point], (point, &Vector3::z()), -distance))
            }
        }
    }
}
