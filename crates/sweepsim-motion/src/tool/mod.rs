//! Tools and their boundary.

mod apt;
mod circle_segment;
mod surfaces;

pub use apt::{Apt, AptError, AptWarning};

use crate::boundary::{self, Edge, Patch, ToolError};
use crate::profile::{Profile, ProfileError, ProfileSegment, Turn};
use nalgebra::Vector3;
use sweepsim_spline::RationalSpline;

/// A milling tool: a solid with an exact B-spline boundary. Its origin is the tip, its `+z` runs along the axis to the holder.
#[derive(Clone, Debug)]
pub struct Tool {
    profile: Option<Profile>,
    patches: Vec<Patch>,
    edges: Vec<Edge>,
}

/// A measure that must be good and finite.
pub(crate) fn check(what: &'static str, value: f64, good: bool, expected: &'static str) -> Result<(), ProfileError> {
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

    /// A lollipop: a ball of `radius` on a thinner neck of radius `neck`, `length` from the tip to the top.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < neck < radius` and the top is above the ball's joint with the neck.
    pub fn lollipop(radius: f64, neck: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check(
            "neck",
            neck,
            neck > 0.0 && neck < radius,
            "positive and less than the radius",
        )?;
        let joint = radius + ((radius - neck) * (radius + neck)).sqrt();
        check(
            "length",
            length,
            length > joint,
            "greater than the height of the joint of ball and neck",
        )?;
        let segments = vec![
            ProfileSegment::Arc {
                to: [neck, joint],
                centre: [0.0, radius],
                turn: Turn::Ccw,
            },
            ProfileSegment::Line { to: [neck, length] },
            ProfileSegment::Line { to: [0.0, length] },
        ];
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// A dovetail cutter: widest at its flat bottom, of `radius` there, with flanks that lean inwards at `angle` degrees above the horizontal up to
    /// `height`, then a neck of radius `neck`.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless all are positive, `angle` below 90, `length` above `height`, and the neck no thicker than the flanks leave it.
    pub fn dovetail(radius: f64, angle: f64, height: f64, neck: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check("angle", angle, angle > 0.0 && angle < 90.0, "between 0 and 90 degrees")?;
        check("height", height, height > 0.0, "positive")?;
        let top = radius - height / angle.to_radians().tan();
        check(
            "neck",
            neck,
            neck > 0.0 && neck <= top,
            "positive and no more than the flanks leave at their top",
        )?;
        check("length", length, length > height, "greater than the height")?;
        let line = |rho: f64, zeta: f64| ProfileSegment::Line { to: [rho, zeta] };
        let mut segments = vec![line(radius, 0.0), line(top, height)];
        if neck < top {
            segments.push(line(neck, height));
        }
        segments.extend([line(neck, length), line(0.0, length)]);
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// A barrel cutter: its flank is an arc of radius `flank`, from the flat bottom up to `height`, widest in the middle, of `radius` there. Above it the
    /// shank is as thick as the bottom.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless all are positive, the arc is less than half a circle and leaves a bottom, and `length` is above `height`.
    pub fn barrel(radius: f64, flank: f64, height: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check("height", height, height > 0.0, "positive")?;
        check("flank", flank, 2.0 * flank > height, "more than half the height")?;
        let half = 0.5 * height;
        let bottom = radius - flank + ((flank - half) * (flank + half)).sqrt();
        check(
            "flank",
            flank,
            bottom > 0.0,
            "so large that the arc ends outside of the axis",
        )?;
        check("length", length, length > height, "greater than the height")?;
        let segments = vec![
            ProfileSegment::Line { to: [bottom, 0.0] },
            ProfileSegment::Arc {
                to: [bottom, height],
                centre: [radius - flank, half],
                turn: Turn::Ccw,
            },
            ProfileSegment::Line { to: [bottom, length] },
            ProfileSegment::Line { to: [0.0, length] },
        ];
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// A lens cutter: a bottom that is part of a ball of radius `bottom`, with a sharp rim of `radius`, and a shank above it.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < radius < bottom` and `length` is above the rim.
    pub fn lens(radius: f64, bottom: f64, length: f64) -> Result<Self, ProfileError> {
        check("radius", radius, radius > 0.0, "positive")?;
        check("bottom", bottom, bottom > radius, "greater than the radius")?;
        let rim = bottom - ((bottom - radius) * (bottom + radius)).sqrt();
        check("length", length, length > rim, "greater than the height of the rim")?;
        let segments = vec![
            ProfileSegment::Arc {
                to: [radius, rim],
                centre: [0.0, bottom],
                turn: Turn::Ccw,
            },
            ProfileSegment::Line { to: [radius, length] },
            ProfileSegment::Line { to: [0.0, length] },
        ];
        Ok(Self::from_profile(Profile::new([0.0, 0.0], segments)?))
    }

    /// The seven-parameter cutter of APT, and what is odd about it.
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
        Self {
            patches: boundary::patches_of_profile(&profile),
            edges: boundary::edges_of_profile(&profile),
            profile: Some(profile),
        }
    }

    /// A tool of any shape: the solid that `patches` enclose, in any order.
    ///
    /// Every part of a side of a patch must join a part of one other side (of another patch, or of the same one at a seam), within
    /// `tolerance`: one side may join several, and at another pace. Sides that are points are poles. Where the normals differ along a joint
    /// there is a sharp edge.
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
            edges: boundary::edges_of_patches(&patches, tolerance)?,
            patches,
            profile: None,
        })
    }

    /// A tool that is enclosed by B-spline surfaces, each with `F_u × F_v` pointing out of it. They are taken apart at their knots.
    ///
    /// # Errors
    /// As [`Tool::from_patches`], and when a surface is none or has a fold.
    pub fn from_surfaces(surfaces: &[RationalSpline], tolerance: f64) -> Result<Self, ToolError> {
        Self::from_patches(surfaces::patches(surfaces)?, tolerance)
    }

    /// The outline of a solid of revolution; none for tools of other shapes.
    #[must_use]
    pub fn profile(&self) -> Option<&Profile> {
        self.profile.as_ref()
    }

    /// No point of the tool is farther from its tip.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let control = |patch: &Patch| {
            let weights = patch.weight().coefficients();
            let point = |i: usize| Vector3::from([0, 1, 2].map(|k| patch.position()[k].coefficients()[i] / weights[i]));
            (0..weights.len()).map(|i| point(i).norm()).fold(0.0, f64::max)
        };
        self.patches.iter().map(control).fold(0.0, f64::max)
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
