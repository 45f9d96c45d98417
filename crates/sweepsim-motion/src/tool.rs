//! Tools and their boundary.

use crate::boundary::{self, Edge, Patch};
use crate::freeform::{self, ToolError};
use crate::profile::{Profile, ProfileError, ProfileSegment, Turn};
use sweepsim_spline::RationalSpline;

/// A milling tool: a solid with an exact B-spline boundary. Its origin is the tip, its `+z` runs along the axis to the holder.
#[derive(Clone, Debug)]
pub struct Tool {
    profile: Option<Profile>,
    patches: Vec<Patch>,
    edges: Vec<Edge>,
}

fn check(what: &'static str, value: f64, good: bool, expected: &'static str) -> Result<(), ProfileError> {
    if good && value.is_finite() {
        Ok(())
    } else {
        Err(ProfileError::Measure { what, value, expected })
    }
}

impl Tool {
    /// A ball end: a half ball of `radius` with a shank of the same radius, `length` from the tip to the top.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < radius < length`.
    pub fn ball(radius: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check("length", length, length > radius, "greater than the radius")?;
        let segments = vec![
            ProfileSegment::Arc {
                to: [radius, radius],
                centre: [0.0, radius],
                turn: Turn::Ccw,
            },
            ProfileSegment::Line { to: [radius, length] },
            ProfileSegment::Line { to: [0.0, length] },
        ];
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// A flat end: a cylinder of `radius` and `length`.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless both are positive.
    pub fn flat(radius: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check("length", length, length > 0.0, "positive")?;
        let segments = vec![
            ProfileSegment::Line { to: [radius, 0.0] },
            ProfileSegment::Line { to: [radius, length] },
            ProfileSegment::Line { to: [0.0, length] },
        ];
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// A bull nose: a flat end whose rim is rounded with radius `corner`.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < corner < radius` and `corner < length`.
    pub fn bull(radius: f64, corner: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check(
            "corner",
            corner,
            corner > 0.0 && corner < radius,
            "positive and less than the radius",
        )?;
        check("length", length, length > corner, "greater than the corner radius")?;
        let segments = vec![
            ProfileSegment::Line {
                to: [radius - corner, 0.0],
            },
            ProfileSegment::Arc {
                to: [radius, corner],
                centre: [radius - corner, corner],
                turn: Turn::Ccw,
            },
            ProfileSegment::Line { to: [radius, length] },
            ProfileSegment::Line { to: [0.0, length] },
        ];
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// The solid of revolution of a profile.
    #[must_use]
    pub fn from_profile(profile: Profile) -> Self {
        Self {
            patches: boundary::patches(&profile),
            edges: boundary::edges(&profile),
            profile: Some(profile),
        }
    }

    /// A tool of any shape: the solid that `patches` enclose, in any order.
    ///
    /// Each side of a patch must join one side of another patch (or of the same one, at a seam), at the same pace and within
    /// `tolerance`; sides that are points are poles. Where the normals differ along a joint there is a sharp edge.
    ///
    /// # Errors
    /// [`ToolError`]: open, patches that face different ways, more than two sides at one place, inside out.
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
        Ok(Self {
            edges: freeform::edges(&patches, tolerance)?,
            patches,
            profile: None,
        })
    }

    /// A tool that is enclosed by B-spline surfaces, each with `F_u × F_v` pointing out of it. They are taken apart at their knots.
    ///
    /// # Errors
    /// As [`Tool::from_patches`], and when a surface is none or has a fold.
    pub fn from_surfaces(surfaces: &[RationalSpline], tolerance: f64) -> Result<Self, ToolError> {
        Self::from_patches(freeform::pieces(surfaces)?, tolerance)
    }

    /// The outline of a solid of revolution; none for tools of other shapes.
    #[must_use]
    pub fn profile(&self) -> Option<&Profile> {
        self.profile.as_ref()
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
