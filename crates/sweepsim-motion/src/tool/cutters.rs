//! The usual cutters.

use super::{Dovetail, Lollipop, Tool};
use crate::profile::{Profile, ProfileError, ProfileSegment, Turn};

/// Checks a measure, which must also be finite.
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

    /// A lollipop: a ball on a thinner neck.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < neck < radius` and the top is above the ball's joint with the neck.
    pub fn lollipop(measures: Lollipop) -> Result<Self, ProfileError> {
        let Lollipop { radius, neck, length } = measures;
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

    /// A dovetail cutter: widest at its flat bottom, with flanks that lean inwards, then a neck.
    ///
    /// ```
    /// use sweepsim_motion::{Dovetail, ProfileError, Tool};
    /// let measures = Dovetail { radius: 8.0, angle: 60.0, height: 5.0, neck: 3.0, length: 40.0 };
    /// assert!(Tool::dovetail(measures).is_ok());
    /// let thick = Dovetail { neck: 7.0, ..measures };
    /// assert!(matches!(Tool::dovetail(thick), Err(ProfileError::Measure { what: "neck", .. })));
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless all are positive, `angle` below 90, `length` above `height`, and the neck no
    /// thicker than the flanks at their top.
    pub fn dovetail(measures: Dovetail) -> Result<Self, ProfileError> {
        let Dovetail {
            radius,
            angle,
            height,
            neck,
            length,
        } = measures;
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
}
