//! How far two surfaces are from each other, along their normals, and what of it is not known.
//!
//! A [`Surface`] is that of triangles, of dexels along three axes, or of dexels along one. The last do not tell where a
//! wall is between a line with material and one without, so distances from it, and of it, are [ranges](DistanceRange):
//! they hold the distance wherever the wall is.

mod lines;
mod samples;
mod summary;

use crate::dexels::Dexels;
use crate::mesh::{DistanceTo, FaceSurfaces, MeshError, TriangleSoup};
use crate::tri::TriDexels;
use lines::LineSurface;
use samples::{SampleDeviation, SurfaceSample};
pub use summary::{DeviationAt, SurfaceDeviations, SurfacePoint};

/// A signed distance, positive outside: it is in this range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceRange {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl DistanceRange {
    /// A distance that is known.
    #[must_use]
    pub const fn exactly(distance: f64) -> Self {
        Self {
            low: distance,
            high: distance,
        }
    }

    /// The smallest range that holds both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The value that is nearest to 0.
    #[must_use]
    pub fn nearest_to_0(self) -> f64 {
        // Not `clamp`, which panics on a NaN.
        self.low.max(0.0) + self.high.min(0.0)
    }

    /// The least and the most that its absolute value may be.
    #[must_use]
    pub fn size(self) -> [f64; 2] {
        [self.nearest_to_0().abs(), self.high.abs().max(self.low.abs())]
    }
}

/// The surface of a part, prepared to be compared with others.
///
/// ```
/// use sweepsim_dexel::{Grid, Stock, Surface, TriangleSoup};
/// let block = |side: f64| TriangleSoup::block([-side, -4.0, 0.0], [side, 4.0, 2.0]);
/// let grid = Grid::new([-9.0; 2], [9.0; 2], [36, 36])?;
/// let (wide, narrow) = (block(6.1), block(6.0));
/// let dexels = Stock::Mesh(wide.clone()).dexels(&grid)?;
/// let (part, target) = (Surface::of_triangles(&wide)?, Surface::of_triangles(&narrow)?);
/// let found = part.deviations_from(&target, 0.5, 1e-6);
/// let most = found.outside.unwrap();
/// assert!((most.least - 0.1).abs() < 1e-12 && most.least == most.most);
/// // Dexels have lines at 5.75 and 6.25: the wall is somewhere between them.
/// let found = Surface::of_dexels(&dexels)?.deviations_from(&target, 0.5, 1e-6);
/// let [least, most] = found.largest();
/// assert!(least < 0.1 && 0.1 < most && most < 0.6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Surface<'a> {
    kind: SurfaceKind<'a>,
    /// The surface as triangles; of dexels as likely as any.
    tree: DistanceTo,
}

#[derive(Debug)]
enum SurfaceKind<'a> {
    Triangles(&'a TriangleSoup, Option<&'a FaceSurfaces>),
    Tri(&'a TriDexels),
    Lines(Box<LineSurface<'a>>),
}

impl<'a> Surface<'a> {
    /// The surface of triangles.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn of_triangles(soup: &'a TriangleSoup) -> Result<Self, MeshError> {
        Ok(Self {
            kind: SurfaceKind::Triangles(soup, None),
            tree: DistanceTo::new(soup)?,
        })
    }

    /// The surface of triangles whose faces are known: measured from what these are, and at points of it.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn of_faces(soup: &'a TriangleSoup, faces: &'a FaceSurfaces) -> Result<Self, MeshError> {
        Ok(Self {
            kind: SurfaceKind::Triangles(soup, Some(faces)),
            tree: DistanceTo::new(soup)?.with_surfaces(faces.clone()),
        })
    }

    /// The number of the triangle nearest to a point, of the surface as triangles.
    #[must_use]
    pub fn nearest_triangle(&self, p: [f64; 3]) -> Option<usize> {
        self.tree.nearest(p).map(|near| near.triangle)
    }

    /// The surface of dexels along three axes: exact at their ends, and as [`TriDexels::surface`] between them.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn of_tri_dexels(solid: &'a TriDexels) -> Result<Self, MeshError> {
        let soup = solid.surface()?.soup().unwrap_or_default();
        Ok(Self {
            kind: SurfaceKind::Tri(solid),
            tree: DistanceTo::new(&soup)?,
        })
    }

    /// The surface of dexels along one axis: exact at their ends, as [`Dexels::surface`] on faces that run from one
    /// line to the next, and anywhere between a line with material and one without on walls.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn of_dexels(dexels: &'a Dexels) -> Result<Self, MeshError> {
        let (lines, tree) = LineSurface::new(dexels)?;
        Ok(Self {
            kind: SurfaceKind::Lines(Box::new(lines)),
            tree,
        })
    }

    /// The distance of a point from the surface; `None` if that has no triangles.
    #[must_use]
    pub fn distance(&self, p: [f64; 3]) -> Option<DistanceRange> {
        let near = self.tree.nearest(p)?.distance;
        match &self.kind {
            SurfaceKind::Triangles(..) => Some(DistanceRange::exactly(near)),
            SurfaceKind::Tri(solid) => {
                let spacing = solid.sets()[2].grid().spacing();
                if near.abs() > spacing[0].max(spacing[1]) {
                    return Some(DistanceRange::exactly(near));
                }
                // The ends are exact, the triangles between them are not.
                let away = solid.sets().iter().fold(near.abs(), |best, set| {
                    set.nearest_of(p, best, |_| true).map_or(best, |end| end.distance)
                });
                Some(DistanceRange::exactly(away.copysign(near)))
            }
            SurfaceKind::Lines(lines) => lines.distance(p, near),
        }
    }

    /// How far this surface is from another: at all ends of dexels; at all corners of triangles, and so that no point
    /// of them is farther than `spacing` from a sample, as far as two million allow; and on walls that may be anywhere
    /// between two lines, from one to the other. Distances up to `tolerance` count as 0.
    #[must_use]
    pub fn deviations_from(&self, other: &Self, spacing: f64, tolerance: f64) -> SurfaceDeviations {
        let of = |sample: &SurfaceSample| sample.deviation(|p| other.distance(p));
        self.sampled(spacing, tolerance, of)
    }

    /// As [`deviations_from`](Self::deviations_from), but where this solid is missing from a part, at most by as much
    /// as it is thick there, along its normal or an axis. So a web that is missing altogether is missing by its
    /// thickness, however far what remains is from it.
    #[must_use]
    pub fn missing_from(&self, part: &Self, spacing: f64, tolerance: f64) -> SurfaceDeviations {
        self.sampled(spacing, tolerance, |sample| {
            let mut found = sample.deviation(|p| part.distance(p))?;
            let inner = *sample.places.first()?;
            let size = 1.0 + inner.iter().map(|c| c.abs()).fold(0.0, f64::max);
            let DistanceRange { low, high } = &mut found.range;
            if *high > 1e-6 * size {
                let thickness = self.tree.thickness(inner, sample.normal, size, *high);
                // Where a wall is not known, neither is how thick that is.
                (*low, *high) = (low.min(thickness), high.min(thickness + 2.0 * sample.stretch()));
            }
            Some(found)
        })
    }

    fn sampled(
        &self,
        spacing: f64,
        tolerance: f64,
        of: impl Fn(&SurfaceSample) -> Option<SampleDeviation> + Sync,
    ) -> SurfaceDeviations {
        let found = match &self.kind {
            SurfaceKind::Triangles(soup, faces) => samples::on_triangles(soup, *faces, spacing, of),
            SurfaceKind::Tri(solid) => samples::at_tri_ends(solid, of),
            SurfaceKind::Lines(lines) => lines.samples(of),
        };
        SurfaceDeviations::of(found, tolerance)
    }
}
