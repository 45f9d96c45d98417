//! Tools of revolution and their boundary.

use crate::boundary::{self, Edge, Patch};
use crate::profile::{Profile, ProfileError, ProfileSegment, Turn};

/// A milling tool: a solid with an exact B-spline boundary. Its origin is the tip, its `+z` runs along the axis to the holder.
#[derive(Clone, Debug)]
pub struct Tool {
    profile: Profile,
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
            profile,
        }
    }

    /// The outline.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
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
