//! The seven-parameter cutter of APT as a profile.
//!
//! `d` diameter: twice the radius where bottom line and side line meet; `r` radius of the corner; `e`, `f` position of
//! the corner's centre, from the axis and above the tip; `a` angle of the bottom line above the horizontal; `b` angle
//! of the side line outwards from the axis' direction; `h` height. Angles in degrees.
//!
//! The outline runs from the tip along the bottom line to the corner, around it, and along the side line to the height.
//! If the corner's circle touches a line, the outline passes between them at that point; if it cuts the line (barrels,
//! lenses), at the farther of the two points.

use crate::profile::{Profile, ProfileError, ProfileSegment, Turn};
use thiserror::Error;

/// The parameters of the cutter: lengths in one unit, angles in degrees.
///
/// ```
/// use sweepsim_motion::{Apt, Tool};
/// let drill = Apt { d: 10.0, r: 0.0, e: 5.0, f: 0.0, a: 31.0, b: 0.0, h: 40.0 };
/// let (tool, warnings) = Tool::apt(&drill)?;
/// assert!(warnings.is_empty() && tool.profile().is_some_and(|profile| profile.segments().len() == 3));
/// # Ok::<(), sweepsim_motion::AptError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apt {
    /// Diameter: twice the radius where the bottom line and the side line meet.
    pub d: f64,
    /// Radius of the corner.
    pub r: f64,
    /// Distance of the corner's centre from the axis; negative beyond it, for barrels.
    pub e: f64,
    /// Height of the corner's centre above the tip.
    pub f: f64,
    /// Angle of the bottom line above the horizontal; negative for a hollow end.
    pub a: f64,
    /// Angle of the side line outwards from the axis' direction; negative for dovetails.
    pub b: f64,
    /// Height.
    pub h: f64,
}

/// Why a cutter's parameters are invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum AptError {
    /// A parameter is out of its range.
    #[error("`{name}` of the APT cutter is {value}, but must be {expected}")]
    Parameter {
        /// Its letter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// The corner's circle and a line have no point in common.
    #[error("the corner of the APT cutter (r, e, f) does not reach its {line} line: expected it to touch or cut it")]
    Misses {
        /// `"bottom"` or `"side"`.
        line: &'static str,
    },
    /// The outline is invalid.
    #[error("the APT cutter: {0}")]
    Profile(ProfileError),
}

/// Something unusual about a cutter.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum AptWarning {
    /// The corner cuts a line instead of touching it: there is a sharp edge.
    #[error(
        "the corner (r, e, f) is not tangent to the {line} line, which passes its centre at {distance}: there is a sharp edge"
    )]
    NotTangent {
        /// `"bottom"` or `"side"`.
        line: &'static str,
        /// The distance of the corner's centre from the line.
        distance: f64,
    },
}

/// A circle that misses a line by at most this fraction of the cutter's size counts as touching it, since parameters
/// have few digits.
const TOUCHES: f64 = 1e-6;

impl Apt {
    /// The outline, with warnings about unusual parameters.
    ///
    /// # Errors
    /// [`AptError`]: a parameter out of range, a corner that misses a line, an outline that crosses itself.
    pub fn profile(&self) -> Result<(Profile, Vec<AptWarning>), AptError> {
        let check = |name: &'static str, value: f64, good: bool, expected: &'static str| {
            if good && value.is_finite() {
                Ok(())
            } else {
                Err(AptError::Parameter { name, value, expected })
            }
        };
        let mut warnings = Vec::new();
        check("d", self.d, self.d >= 0.0, "0 or greater")?;
        check("r", self.r, self.r >= 0.0, "0 or greater")?;
        check("e", self.e, true, "finite")?;
        check("f", self.f, true, "finite")?;
        check("a", self.a, self.a.abs() < 90.0, "between -90 and 90 degrees")?;
        check("b", self.b, self.b.abs() < 90.0, "between -90 and 90 degrees")?;
        check("h", self.h, self.h > 0.0, "positive")?;
        let (sin_a, cos_a) = self.a.to_radians().sin_cos();
        let (sin_b, cos_b) = self.b.to_radians().sin_cos();
        // Where the two lines meet.
        let meet = [0.5 * self.d, 0.5 * self.d * sin_a / cos_a];
        let bottom = Line {
            from: [0.0, 0.0],
            direction: [cos_a, sin_a],
        };
        let side = Line {
            from: meet,
            direction: [sin_b, cos_b],
        };
        let mut outline = Outline {
            at: [0.0, 0.0],
            segments: Vec::new(),
            smallest: 1e-9 * (self.d + self.r + self.h),
        };
        if self.r > 0.0 {
            let circle = Circle {
                centre: [self.e, self.f],
                radius: self.r,
                slack: TOUCHES * (self.d + self.r),
            };
            let mut ends = [[0.0; 2]; 2];
            for (end, (line, name)) in ends.iter_mut().zip([(&bottom, "bottom"), (&side, "side")]) {
                let (point, distance) = circle.farther(line).ok_or(AptError::Misses { line: name })?;
                *end = point;
                if (distance - self.r).abs() > circle.slack {
                    warnings.push(AptWarning::NotTangent { line: name, distance });
                }
            }
            let [leave, join] = ends;
            outline.line(leave);
            outline.arc(join, circle.centre);
        } else {
            outline.line(meet);
        }
        let top = side.from[0] + (self.h - side.from[1]) * sin_b / cos_b;
        outline.line([top, self.h]);
        outline.line([0.0, self.h]);
        let profile = Profile::new([0.0, 0.0], outline.segments).map_err(AptError::Profile)?;
        Ok((profile, warnings))
    }
}

struct Line {
    from: [f64; 2],
    direction: [f64; 2],
}

struct Circle {
    centre: [f64; 2],
    radius: f64,
    slack: f64,
}

impl Circle {
    /// The point where the line touches the circle, or the farther one if it cuts the circle; and the line's distance
    /// from the centre.
    fn farther(&self, line: &Line) -> Option<([f64; 2], f64)> {
        let to = [self.centre[0] - line.from[0], self.centre[1] - line.from[1]];
        let [dx, dy] = line.direction;
        let along = to[0] * dx + to[1] * dy;
        let height = (to[0] * dy - to[1] * dx).abs();
        let half = if (height - self.radius).abs() <= self.slack {
            0.0
        } else {
            // NaN where they miss each other.
            (self.radius * self.radius - height * height).sqrt()
        };
        let s = along + half;
        s.is_finite()
            .then(|| ([line.from[0] + s * dx, line.from[1] + s * dy], height))
    }
}

/// The segments in order, without those of length zero.
struct Outline {
    at: [f64; 2],
    segments: Vec<ProfileSegment>,
    smallest: f64,
}

impl Outline {
    fn moves(&mut self, to: [f64; 2]) -> bool {
        let far = (to[0] - self.at[0]).hypot(to[1] - self.at[1]) > self.smallest;
        if far {
            self.at = to;
        }
        far
    }

    /// Sets a radius that is 0 up to rounding to 0.
    fn clean(&self, to: [f64; 2]) -> [f64; 2] {
        if to[0].abs() <= self.smallest { [0.0, to[1]] } else { to }
    }

    fn line(&mut self, to: [f64; 2]) {
        let to = self.clean(to);
        if self.moves(to) {
            self.segments.push(ProfileSegment::Line { to });
        }
    }

    fn arc(&mut self, to: [f64; 2], centre: [f64; 2]) {
        let to = self.clean(to);
        if self.moves(to) {
            self.segments.push(ProfileSegment::Arc {
                to,
                centre,
                turn: Turn::Ccw,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apt([d, r, e, f, a, b, h]: [f64; 7]) -> Apt {
        Apt { d, r, e, f, a, b, h }
    }

    #[test]
    fn the_usual_cutters() {
        let count = |parameters| {
            let (profile, warnings) = apt(parameters).profile().unwrap();
            assert!(warnings.is_empty(), "{warnings:?}");
            profile.segments().len()
        };
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, 0.0, 0.0, 30.0]), 3, "flat");
        assert_eq!(count([10.0, 5.0, 0.0, 5.0, 0.0, 0.0, 30.0]), 3, "ball");
        assert_eq!(count([10.0, 1.0, 4.0, 1.0, 0.0, 0.0, 30.0]), 4, "bull");
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, 31.0, 0.0, 30.0]), 3, "drill");
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, -10.0, 0.0, 30.0]), 3, "hollow end");
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, 0.0, -8.0, 30.0]), 3, "dovetail");
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, 20.0, 6.0, 30.0]), 3, "taper with a point");
    }

    #[test]
    fn corners_that_cut_are_sharp_and_said_to_be() {
        // A barrel: its flank of radius 20 cuts the bottom plane and the side line.
        let (profile, warnings) = apt([12.0, 20.0, -14.0, 10.0, 0.0, 0.0, 40.0]).profile().unwrap();
        assert_eq!(profile.segments().len(), 4);
        assert_eq!(
            warnings,
            [AptWarning::NotTangent {
                line: "bottom",
                distance: 10.0
            }]
        );
    }

    #[test]
    fn a_tapered_ball() {
        // Radius 2, 5 degrees: the side line touches the ball, and meets the bottom line at rho = d/2.
        let (sin, cos) = 5.0_f64.to_radians().sin_cos();
        let d = 2.0 * (2.0 * cos - (2.0 - 2.0 * sin) * sin / cos);
        let (profile, warnings) = apt([d, 2.0, 0.0, 2.0, 0.0, 5.0, 30.0]).profile().unwrap();
        assert!(warnings.is_empty());
        match profile.segments() {
            [ProfileSegment::Arc { to, .. }, ..] => {
                assert!((to[0] - 2.0 * cos).abs() < 1e-9 && (to[1] - (2.0 - 2.0 * sin)).abs() < 1e-9);
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn bad_ones_name_the_parameter() {
        let blame = |parameters| match apt(parameters).profile().unwrap_err() {
            AptError::Parameter { name, .. } => name,
            AptError::Misses { line } => line,
            AptError::Profile(_) => "profile",
        };
        assert_eq!(blame([10.0, -1.0, 4.0, 1.0, 0.0, 0.0, 30.0]), "r");
        assert_eq!(blame([10.0, 1.0, 4.0, 1.0, 90.0, 0.0, 30.0]), "a");
        assert_eq!(blame([10.0, 1.0, 4.0, 1.0, 0.0, 0.0, f64::NAN]), "h");
        assert_eq!(blame([10.0, 1.0, 2.0, 1.0, 0.0, 0.0, 30.0]), "side");
        assert_eq!(
            blame([10.0, 0.0, 5.0, 0.0, 0.0, -45.0, 30.0]),
            "profile",
            "the side line crosses the axis"
        );
    }
}
