//! What there was before the first cut.

use super::surface::Points;
use nalgebra::Vector3;
use smallvec::SmallVec;
use sweepsim_dexel::{DistanceTo, MeshError, Stock};

/// A stock, prepared for what is asked of it here: without its skin, so that what ends on its surface is beside it.
pub(crate) struct Before {
    shape: Shape,
    /// How thick the skin is: far below any tolerance.
    skin: f64,
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
    pub fn new(stock: &Stock, skin: f64) -> Result<Self, MeshError> {
        let shape = Shape::new(stock)?;
        Ok(Self { shape, skin })
    }

    /// Points whose hull has all of the stock that is in the hull of some points. `middle`: a point among them;
    /// `normal`: a direction away from the stock, if they are beside it.
    pub fn within(&self, mut points: Points, middle: &Vector3<f64>, normal: &Vector3<f64>) -> Points {
        if self.shape.misses(&points, (middle, normal), self.skin) {
            points.clear();
        }
        if let Shape::Block([low, high]) | Shape::Within([low, high]) = &self.shape {
            for k in 0..3 {
                points = below(points, |point| point[k] - (high[k] - self.skin));
                points = below(points, |point| low[k] + self.skin - point[k]);
            }
        }
        points
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
                points = below(points, |point| point[k] - (high[k] + distance));
                points = below(points, |point| low[k] - distance - point[k]);
            }
        }
        points
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
            Self::Mesh(distance) => {
                let size = points.iter().map(|point| (point - middle).norm());
                let size = size.fold(0.0, f64::max);
                let nearest = distance.nearest((*middle).into());
                nearest.is_none_or(|nearest| nearest.distance + skin > size * (1.0 + 1e-9) + 1e-12)
            }
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
