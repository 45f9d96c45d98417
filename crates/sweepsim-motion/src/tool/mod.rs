//! Tools and their boundary.

mod apt;
mod below;
mod circle_segment;
fn reach(patches: &[Patch]) -> f64 {
    let control = |patch: &Patch| {
        let weights = patch.weight().coefficients();
        let point = |i: usize| Vector3::from([0, 1, 2].map(|k| patch.position()[k].coefficients()[i] / weights[i]));
        (0..weights.len()).map(|i| point(i).norm()).fold(0.0, f64::max)
    };
    patches.iter().map(control).fold(0.0, f64::max)
}

fn bounding_cylinder(profile: Option<&Profile>, patches: &[Patch]) -> BoundingCylinder {
    let mut bound = BoundingCylinder {
        radius: 0.0,
        z: [f64::INFINITY, f64::NEG_INFINITY],
    };
    let mut add = |rho: f64, z: f64| {
        bound.radius = bound.radius.max(rho);
        bound.z = [bound.z[0].min(z), bound.z[1].max(z)];
    };
    // Control points: their hull holds the surface, as weights are positive.
    if let Some(profile) = profile {
        for curve in profile.pieces().iter().flat_map(|piece| piece.curves()) {
            curve.points.iter().for_each(|point| add(point.x, point.y));
        }
        return bound;
    }
    for patch in patches {
        let weights = patch.weight().coefficients();
        for (i, w) in weights.iter().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|k| patch.position()[k].coefficients()[i] / w);
            add(x.hypot(y), z);
        }
    }
    bound
}

mod bounds;
#[cfg(test)]
mod circle_segment_tests;
mod cutters;
mod measures;
mod meridian;
mod surfaces;

pub use apt::{Apt, AptError, AptWarning};
pub use bounds::Bounds;
pub use measures::{Barrel, Dovetail, Lens, Lollipop, Oval, Taper};
pub use meridian::{MeridianCurve, MeridianShape};

use crate::boundary::{self, Edge, Patch, ToolError};
use crate::profile::{Profile, ProfileError, ProfileSegment};
use nalgebra::Vector3;
use std::sync::{Arc, OnceLock};
use sweepsim_spline::RationalSpline;

/// A cylinder about the tool's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BoundingCylinder {
    /// Its radius.
    pub radius: f64,
    /// Its lowest and highest `z`, in the tool's frame.
    pub z: [f64; 2],
}

/// Chords of a curve of the profile: an arc of at most half a turn deviates from its chords by 3e-5 of its radius.
const RADIUS_CHORDS: usize = 200;

/// A milling tool: a solid with an exact B-spline boundary. The origin is its tip; `+z` points along its axis to the
/// holder.
#[derive(Clone, Debug)]
pub struct Tool {
    profile: Option<Profile>,
    patches: Vec<Patch>,
    edges: Vec<Edge>,
    reach: f64,
    cylinder: BoundingCylinder,
    /// Within which patches join.
    tolerance: f64,
    /// Computed when they are asked for.
    bounds: Arc<OnceLock<Bounds>>,
}

impl Tool {
    /// Its reach and its cylinder are asked for in every move, and are sums over all control points.
    fn new(profile: Option<Profile>, patches: Vec<Patch>, edges: Vec<Edge>, tolerance: f64) -> Self {
        Self {
            tolerance,
            bounds: Arc::default(),
            reach: reach(&patches),
            cylinder: bounding_cylinder(profile.as_ref(), &patches),
            profile,
            patches,
            edges,
        }
    }

    /// The seven-parameter APT cutter, with warnings about unusual parameters.
    ///
    /// # Errors
    /// [`AptError`]: as [`Apt::profile`].
    pub fn apt(parameters: &Apt) -> Result<(Self, Vec<AptWarning>), AptError> {
        let (profile, warnings) = parameters.profile()?;
        Ok((Self::from_profile(profile), warnings))
    }

    /// The solid of revolution of a profile.
    #[must_use]
    pub fn from_profile(profile: Profile) -> Self {
        let (patches, edges) = (
            boundary::patches_of_profile(&profile),
            boundary::edges_of_profile(&profile),
        );
        Self::new(Some(profile), patches, edges, 0.0)
    }

    /// A tool of any shape: the solid that `patches` enclose, in any order.
    ///
    /// Every part of a side of a patch must join part of exactly one other side (of another patch, or of the same one
    /// at a seam), within `tolerance`. One side may join several, with a different parametrisation. Sides that are
    /// points are poles. If the normals differ along a joint, there is a sharp edge.
    ///
    /// # Errors
    /// [`ToolError`]: an open boundary, patches that face in different directions, more than two sides along one curve,
    /// a boundary that is inside out.
    ///
    /// ```
    /// use sweepsim_motion::{Patch, Tool};
    /// use sweepsim_spline::Bernstein;
    ///
    /// // A cutter with a square section, 2 by 2 and 10 long: the six faces of a box. Corners in the order (u, v) = 00, 10, 01, 11.
    /// let corner = |k: usize| [if k & 1 == 0 { -1.0 } else { 1.0 }, if k & 2 == 0 { -1.0 } else { 1.0 }, if k & 4 == 0 { 0.0 } else { 10.0 }];
    /// let face = |corners: [usize; 4]| {
    ///     let form = |axis: usize| Bernstein::new(&[1, 1], corners.map(|k| corner(k)[axis]).to_vec());
    ///     Patch::new([form(0)?, form(1)?, form(2)?], Bernstein::new(&[1, 1], vec![1.0; 4])?).map_err(Box::<dyn std::error::Error>::from)
    /// };
    /// let faces = [[0, 2, 1, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 6, 3, 7], [0, 4, 2, 6], [1, 3, 5, 7]];
    /// let patches: Result<Vec<Patch>, _> = faces.into_iter().map(face).collect();
    /// let tool = Tool::from_patches(patches?, 1e-9)?;
    /// assert_eq!(tool.edges().len(), 12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_patches(patches: Vec<Patch>, tolerance: f64) -> Result<Self, ToolError> {
        let edges = boundary::edges_of_patches(&patches, tolerance)?;
        Ok(Self::new(None, patches, edges, tolerance))
    }

    /// The tool enclosed by B-spline surfaces, each with `F_u × F_v` pointing out of it. They are split at their knots.
    ///
    /// # Errors
    /// As [`Tool::from_patches`], and if a surface is invalid or has a fold.
    pub fn from_surfaces(surfaces: &[RationalSpline], tolerance: f64) -> Result<Self, ToolError> {
        Self::from_patches(surfaces::patches(surfaces)?, tolerance)
    }

    /// The outline of a solid of revolution; `None` for tools of other shapes.
    #[must_use]
    pub fn profile(&self) -> Option<&Profile> {
        self.profile.as_ref()
    }

    /// A bound on the distance of all points of the tool from its tip.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// A cylinder about the axis that holds the tool. For lines and arcs of a profile it is the smallest, up to the
    /// corners of the arcs' control polygons.
    #[must_use]
    pub fn bounding_cylinder(&self) -> BoundingCylinder {
        self.cylinder
    }

    /// The solid of all points no farther than `distance` from this one ([`Profile::offset`]). Of tools without a
    /// profile, from the cylinder that holds them, which is larger.
    ///
    /// # Errors
    /// [`ProfileError`] as of [`Profile::offset`].
    pub fn offset(&self, distance: f64) -> Result<Self, ProfileError> {
        if distance == 0.0 {
            return Ok(self.clone());
        }
        let cylinder = |bound: BoundingCylinder| {
            let [low, high] = bound.z;
            let corners = [[bound.radius, low], [bound.radius, high], [0.0, high]];
            let lines = corners.map(|to| ProfileSegment::Line { to });
            Profile::new([0.0, low], lines.into())
        };
        let profile = match &self.profile {
            Some(profile) => profile.offset(distance)?,
            None => cylinder(self.bounding_cylinder())?.offset(distance)?,
        };
        Ok(Self::from_profile(profile))
    }

    /// The largest radius of the part of the tool below `height`, to within 1e-4 of the tool's own: half the width of a
    /// groove of this depth. 0 below the tip. For tools of patches, the largest radius of the whole tool.
    ///
    /// ```
    /// use sweepsim_motion::{Profile, ProfileSegment, Tool};
    /// // 60° between the flanks.
    /// let corners = [[3.0, 3.0 * 3f64.sqrt()], [3.0, 20.0], [0.0, 20.0]];
    /// let lines = corners.map(|to| ProfileSegment::Line { to });
    /// let engraver = Tool::from_profile(Profile::new([0.0, 0.0], lines.into())?);
    /// assert!((engraver.radius_below(0.5) - 0.5 / 3f64.sqrt()).abs() < 1e-12);
    /// assert!((Tool::ball(5.0, 30.0)?.radius_below(1.0) - 3.0).abs() < 3e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn radius_below(&self, height: f64) -> f64 {
        let Some(profile) = &self.profile else {
            return self.bounding_cylinder().radius;
        };
        let mut radius: f64 = 0.0;
        for curve in profile.pieces().iter().flat_map(|piece| piece.curves()) {
            let chords = if curve.points.len() == 2 { 1 } else { RADIUS_CHORDS };
            let place = |n: usize| curve.at(n as f64 / chords as f64);
            for n in 0..chords {
                let (mut low, mut high) = (place(n), place(n + 1));
                if low.y > high.y {
                    std::mem::swap(&mut low, &mut high);
                }
                if low.y <= height {
                    radius = radius.max(low.x);
                    let share = if high.y > height {
                        (height - low.y) / (high.y - low.y)
                    } else {
                        1.0
                    };
                    radius = radius.max(low.x + share * (high.x - low.x));
                }
            }
        }
        radius
    }

    /// Whether the tool is symmetric about its axis.
    #[must_use]
    pub fn is_revolved(&self) -> bool {
        self.profile.is_some()
    }

    /// The smooth patches of the boundary.
    #[must_use]
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The sharp edges between the patches.
    #[must_use]
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }
}
