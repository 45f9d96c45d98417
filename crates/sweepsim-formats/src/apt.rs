//! The seven-parameter cutter of APT as a profile.
//!
//! `d` diameter: twice the radius where bottom line and side line meet; `r` radius of the corner; `e`, `f` place of the corner's centre:
//! from the axis and above the tip; `a` angle of the bottom line above the horizontal; `b` angle of the side line outwards from the
//! axis' direction; `h` height. Angles in degrees.
//!
//! The outline runs from the tip along the bottom line to the corner, round it, and along the side line to the height. Where the corner's
//! circle touches a line, it is left or joined there; where it cuts the line (barrels, lenses), at the farther of the two points.

use sweepsim_motion::{Profile, ProfileSegment, Turn};

use crate::error::Problem;

/// The parameters; lengths in millimetres, angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Apt {
    pub d: f64,
    pub r: f64,
    pub e: f64,
    pub f: f64,
    pub a: f64,
    pub b: f64,
    pub h: f64,
}

/// A circle that misses a line by no more than this part of the cutter's size touches it: parameters have few digits.
const TOUCHES: f64 = 1e-6;

impl Apt {
    /// The outline. The error's first part is the parameter that is to blame.
    pub fn profile(&self) -> Result<Profile, (&'static str, Problem)> {
        let check = |name: &'static str, value: f64, good: bool, expected: &str| {
            if good && value.is_finite() {
                Ok(())
            } else {
                Err((
                    name,
                    Problem::value(format!("`{name}` of the APT cutter"), value, expected),
                ))
            }
        };
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
            let missing = |line: &str| {
                let message = format!(
                    "the corner of the APT cutter (r, e, f) does not reach its {line} line: expected it to touch or cut it"
                );
                ("r", Problem::syntax(message))
            };
            let leave = circle.farther(&bottom).ok_or_else(|| missing("bottom"))?;
            let join = circle.farther(&side).ok_or_else(|| missing("side"))?;
            outline.line(leave);
            outline.arc(join, circle.centre);
        } else {
            outline.line(meet);
        }
        let top = side.from[0] + (self.h - side.from[1]) * sin_b / cos_b;
        outline.line([top, self.h]);
        outline.line([0.0, self.h]);
        Profile::new([0.0, 0.0], outline.segments)
            .map_err(|error| ("", Problem::syntax(format!("the APT cutter: {error}"))))
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
    /// The point where the line touches the circle, or the farther one where it cuts.
    fn farther(&self, line: &Line) -> Option<[f64; 2]> {
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
        s.is_finite().then(|| [line.from[0] + s * dx, line.from[1] + s * dy])
    }
}

/// Segments one after another, without those that have no length.
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

    /// A radius that is 0 but for rounding is 0.
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
        let count = |parameters| apt(parameters).profile().unwrap().segments().len();
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, 0.0, 0.0, 30.0]), 3, "flat");
        assert_eq!(count([10.0, 5.0, 0.0, 5.0, 0.0, 0.0, 30.0]), 3, "ball");
        assert_eq!(count([10.0, 1.0, 4.0, 1.0, 0.0, 0.0, 30.0]), 4, "bull");
        assert_eq!(count([10.0, 0.0, 5.0, 0.0, 31.0, 0.0, 30.0]), 3, "drill");
        assert_eq!(count([12.0, 20.0, -14.0, 10.0, 0.0, 0.0, 40.0]), 4, "barrel");
    }

    #[test]
    fn a_tapered_ball() {
        // Radius 2, 5 degrees: the side line touches the ball, and meets the bottom line at rho = d/2.
        let (sin, cos) = 5.0_f64.to_radians().sin_cos();
        let d = 2.0 * (2.0 * cos - (2.0 - 2.0 * sin) * sin / cos);
        let profile = apt([d, 2.0, 0.0, 2.0, 0.0, 5.0, 30.0]).profile().unwrap();
        match profile.segments() {
            [ProfileSegment::Arc { to, .. }, ..] => {
                assert!((to[0] - 2.0 * cos).abs() < 1e-9 && (to[1] - (2.0 - 2.0 * sin)).abs() < 1e-9);
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn bad_ones_name_the_parameter() {
        let blame = |parameters| apt(parameters).profile().unwrap_err().0;
        assert_eq!(blame([10.0, -1.0, 4.0, 1.0, 0.0, 0.0, 30.0]), "r");
        assert_eq!(blame([10.0, 1.0, 4.0, 1.0, 90.0, 0.0, 30.0]), "a");
        assert_eq!(blame([10.0, 1.0, 4.0, 1.0, 0.0, 0.0, f64::NAN]), "h");
        assert_eq!(
            blame([10.0, 1.0, 2.0, 1.0, 0.0, 0.0, 30.0]),
            "r",
            "does not reach the side"
        );
    }
}
