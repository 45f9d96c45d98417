//! Solids given in another frame.

use super::Stock;
use crate::grid::Frame;
use crate::mesh::TriangleSoup;

/// The corners of a box: bit `k` of a number says whether the corner is at the upper end along axis `k`.
const SIDES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

impl Stock {
    /// The same solid, if its coordinates are those of `frame`. A block whose sides are then not along the axes becomes
    /// a mesh. `None` for dexels: their lines would have other directions.
    ///
    /// ```
    /// use sweepsim_dexel::{Frame, Stock};
    /// // Upside down: z points down.
    /// let frame = Frame::new([0.0, 0.0, 10.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0])?;
    /// let clamp = Stock::Block { min: [0.0, 0.0, 0.0], max: [5.0, 4.0, 3.0] };
    /// assert_eq!(clamp.placed(&frame), Some(Stock::Block { min: [0.0, -4.0, 7.0], max: [5.0, 0.0, 10.0] }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn placed(&self, frame: &Frame) -> Option<Self> {
        let all = |parts: &[Self]| parts.iter().map(|part| part.placed(frame)).collect::<Option<Vec<_>>>();
        Some(match self {
            Self::Block { min, max } => block(*min, *max, frame),
            Self::Cylinder {
                base,
                axis,
                radius,
                height,
            } => Self::Cylinder {
                base: frame.to_world(*base),
                axis: frame.turn_to_world(*axis),
                radius: *radius,
                height: *height,
            },
            Self::Ball { centre, radius } => Self::Ball {
                centre: frame.to_world(*centre),
                radius: *radius,
            },
            Self::Mesh(soup) => Self::Mesh(TriangleSoup {
                triangles: soup.triangles.iter().map(|t| t.map(|p| frame.to_world(p))).collect(),
            }),
            Self::Dexels(_) | Self::TriDexels(_) if frame.is_world() => self.clone(),
            Self::Dexels(_) | Self::TriDexels(_) => return None,
            Self::Union(parts) => Self::Union(all(parts)?),
            Self::Intersection(parts) => Self::Intersection(all(parts)?),
            Self::Difference(whole, parts) => Self::Difference(whole.placed(frame)?.into(), all(parts)?),
        })
    }
}

fn block(min: [f64; 3], max: [f64; 3], frame: &Frame) -> Stock {
    let corner = |n: usize| frame.to_world([0, 1, 2].map(|k| if n >> k & 1 == 0 { min[k] } else { max[k] }));
    let along = |axis: [f64; 3]| axis.iter().filter(|c| **c != 0.0).count() == 1;
    if frame.axes().into_iter().all(along) {
        let (a, b) = (corner(0), corner(7));
        return Stock::Block {
            min: [0, 1, 2].map(|k| a[k].min(b[k])),
            max: [0, 1, 2].map(|k| a[k].max(b[k])),
        };
    }
    let triangles = SIDES.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Stock::Mesh(TriangleSoup {
        triangles: triangles.map(|t| t.map(|n| corner(*n))).collect(),
    })
}
