//! Circle-segment cutters: a flank or bottom that is an arc of large radius, tangent to the neighbouring arcs and lines.
//!
//! | form | outline, from the tip |
//! | --- | --- |
//! | oval | ball of radius `tip`, flank that is tangent to it and to the shank |
//! | taper | the same, but the flank still leans outwards by `angle` where it reaches the shank's radius |
//! | barrel | bottom, corner, flank that is widest in the middle, shank |
//! | lens | bottom that is an arc about a point of the axis, corner, shank |
//!
//! Two circles touch from inside if the distance of their centres is the difference of their radii; the point of contact is on the line through both centres.

use super::cutters::check;
use super::{Barrel, Lens, Oval, Taper, Tool};
use crate::profile::{Profile, ProfileError, ProfileSegment, Turn};

fn line(rho: f64, zeta: f64) -> ProfileSegment {
    ProfileSegment::Line { to: [rho, zeta] }
}

fn arc(to: [f64; 2], centre: [f64; 2]) -> ProfileSegment {
    ProfileSegment::Arc {
        to,
        centre,
        turn: Turn::Ccw,
    }
}

/// Where the circle about `small`, of radius `radius`, touches the one about `large` from inside.
fn touch(small: [f64; 2], radius: f64, large: [f64; 2]) -> [f64; 2] {
    let [dx, dy] = [small[0] - large[0], small[1] - large[1]];
    let scale = radius / dx.hypot(dy);
    [small[0] + dx * scale, small[1] + dy * scale]
}

fn made(segments: Vec<ProfileSegment>) -> Result<Tool, ProfileError> {
    Profile::new([0.0, 0.0], segments).map(Tool::from_profile)
}

impl Tool {
    /// An oval form cutter (tangential barrel): a ball, a flank that is tangent to it, and a shank that is tangent to the flank.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < tip < radius < flank` and `length` is above the flank.
    pub fn oval(measures: Oval) -> Result<Self, ProfileError> {
        let Oval {
            radius,
            tip,
            flank,
            length,
        } = measures;
        Self::taper(Taper {
            radius,
            tip,
            flank,
            angle: 0.0,
            length,
        })
    }

    /// A taper form cutter (conical barrel): as [`oval`](Self::oval), but the flank still leans outwards where it reaches the shank.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < tip < radius < flank · cos(angle)`, `0 ≤ angle < 90`, and `length` is above the flank.
    pub fn taper(measures: Taper) -> Result<Self, ProfileError> {
        let Taper {
            radius,
            tip,
            flank,
            angle,
            length,
        } = measures;
        check("radius", radius, radius > 0.0, "positive")?;
        let expected = "positive and less than the radius";
        check("tip", tip, tip > 0.0 && tip < radius, expected)?;
        let expected = "at least 0 and less than 90 degrees";
        check("angle", angle, (0.0..90.0).contains(&angle), expected)?;
        let (sine, cosine) = angle.to_radians().sin_cos();
        // The flank's centre is as far from its end as `flank`, square to the direction there.
        let beyond = flank * cosine - radius;
        let expected = "so large that its centre lies beyond the axis, times the cosine of the angle";
        check("flank", flank, beyond > 0.0, expected)?;
        // Neither factor is negative: flank − tip > flank·cos − radius.
        let rise = ((flank - tip - beyond) * (flank - tip + beyond)).sqrt();
        let (ball, centre) = ([0.0, tip], [-beyond, tip + rise]);
        let top = centre[1] - flank * sine;
        check("length", length, length > top, "greater than the height of the flank")?;
        made(vec![
            arc(touch(ball, tip, centre), ball),
            arc([radius, top], centre),
            line(radius, length),
            line(0.0, length),
        ])
    }

    /// A barrel cutter: a flat bottom, a flank that is an arc, widest in the middle of its height, and a shank above it that is as thick as the flank
    /// leaves it. The rim between the bottom and the flank is sharp, or an arc that is tangent to both.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless all are positive (`corner` may be 0), the arc is less than half a circle and leaves a bottom, `corner` is below half the height and
    /// leaves a bottom, and `length` is above `height`.
    pub fn barrel(measures: Barrel) -> Result<Self, ProfileError> {
        let Barrel {
            radius,
            flank,
            height,
            corner,
            length,
        } = measures;
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
        if corner == 0.0 {
            return made(vec![
                line(bottom, 0.0),
                arc([bottom, height], [radius - flank, half]),
                line(bottom, length),
                line(0.0, length),
            ]);
        }
        let expected = "0 for a sharp rim, or positive and less than half the height";
        check("corner", corner, corner > 0.0 && corner < half, expected)?;
        let centre = [radius - flank, half];
        let reach = (flank - half) * (flank + half - 2.0 * corner);
        let rim = [centre[0] + reach.sqrt(), corner];
        check("corner", corner, rim[0] > 0.0, "so small that it leaves a bottom")?;
        let neck = centre[0] + ((flank - half) * (flank + half)).sqrt();
        made(vec![
            line(rim[0], 0.0),
            arc(touch(rim, corner, centre), rim),
            arc([neck, height], centre),
            line(neck, length),
            line(0.0, length),
        ])
    }

    /// A lens cutter: a bottom that is part of a ball, and a shank. The rim between them is sharp, or an arc that is tangent to both.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < radius < bottom`, `0 ≤ corner < radius`, and `length` is above the rim.
    pub fn lens(measures: Lens) -> Result<Self, ProfileError> {
        let Lens {
            radius,
            bottom,
            corner,
            length,
        } = measures;
        check("radius", radius, radius > 0.0, "positive")?;
        check("bottom", bottom, bottom > radius, "greater than the radius")?;
        if corner == 0.0 {
            let rim = bottom - ((bottom - radius) * (bottom + radius)).sqrt();
            check("length", length, length > rim, "greater than the height of the rim")?;
            return made(vec![
                arc([radius, rim], [0.0, bottom]),
                line(radius, length),
                line(0.0, length),
            ]);
        }
        let expected = "0 for a sharp rim, or positive and less than the radius";
        check("corner", corner, corner > 0.0 && corner < radius, expected)?;
        let centre = [0.0, bottom];
        let down = ((bottom - radius) * (bottom + radius - 2.0 * corner)).sqrt();
        let rim = [radius - corner, bottom - down];
        check(
            "length",
            length,
            length > rim[1],
            "greater than the height of the corner",
        )?;
        made(vec![
            arc(touch(rim, corner, centre), centre),
            arc([radius, rim[1]], rim),
            line(radius, length),
            line(0.0, length),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segments(tool: &Tool) -> Vec<ProfileSegment> {
        tool.profile().expect("a solid of revolution").segments().to_vec()
    }

    /// Directions on either side of every joint below the top, as unit vectors, from the definition of the segments alone.
    fn joints(tool: &Tool) -> Vec<[[f64; 2]; 2]> {
        let unit = |v: [f64; 2]| v.map(|c| c / v[0].hypot(v[1]));
        let mut from = tool.profile().expect("a solid of revolution").start();
        let mut ends = Vec::new();
        for segment in segments(tool) {
            let (to, directions) = match segment {
                ProfileSegment::Line { to } => (to, [unit([to[0] - from[0], to[1] - from[1]]); 2]),
                ProfileSegment::Arc { to, centre, .. } => {
                    let around = |p: [f64; 2]| unit([centre[1] - p[1], p[0] - centre[0]]);
                    (to, [around(from), around(to)])
                }
                ProfileSegment::Spline { .. } => unreachable!("no circle-segment cutter has splines"),
            };
            ends.push(directions);
            from = to;
        }
        ends.windows(2).map(|pair| [pair[0][1], pair[1][0]]).collect()
    }

    fn angle([a, b]: [[f64; 2]; 2]) -> f64 {
        (a[0] * b[1] - a[1] * b[0])
            .atan2(a[0] * b[0] + a[1] * b[1])
            .to_degrees()
    }

    #[test]
    fn everything_that_is_to_be_tangent_is() {
        let sizes = [(4.0, 1.0, 85.0), (8.0, 2.0, 1500.0), (3.0, 0.2, 3.5)];
        for (radius, tip, flank) in sizes {
            let oval = Tool::oval(Oval {
                radius,
                tip,
                flank,
                length: 200.0,
            })
            .expect("a cutter");
            let turns: Vec<f64> = joints(&oval).into_iter().map(angle).collect();
            assert!(turns[..2].iter().all(|turn| turn.abs() < 1e-10), "{turns:?}");
            // No sharp edge but the rim of the top: as a ball end has.
            let ball = Tool::ball(radius, 200.0).expect("a cutter");
            assert_eq!(oval.edges().len(), ball.edges().len(), "{radius} {tip} {flank}");
            let taper = Tool::taper(Taper {
                radius,
                tip,
                flank,
                angle: 12.0,
                length: 200.0,
            })
            .expect("a cutter");
            let turns: Vec<f64> = joints(&taper).into_iter().map(angle).collect();
            assert!(turns[0].abs() < 1e-10 && (turns[1] - 12.0).abs() < 1e-10, "{turns:?}");
            let lens = Tool::lens(Lens {
                radius,
                bottom: 2.0 * flank,
                corner: tip,
                length: 200.0,
            })
            .expect("a cutter");
            let turns: Vec<f64> = joints(&lens).into_iter().map(angle).collect();
            assert!(turns[..2].iter().all(|turn| turn.abs() < 1e-10), "{turns:?}");
            let barrel = Tool::barrel(Barrel {
                radius,
                flank: 2.0 * flank,
                height: 3.0 * tip,
                corner: tip,
                length: 200.0,
            })
            .expect("a cutter");
            let turns: Vec<f64> = joints(&barrel).into_iter().map(angle).collect();
            assert!(turns[..2].iter().all(|turn| turn.abs() < 1e-10), "{turns:?}");
        }
    }

    #[test]
    fn measures_are_those_that_were_asked_for() {
        let ends = |tool: &Tool| -> Vec<[f64; 2]> {
            let end = |segment: &ProfileSegment| match *segment {
                ProfileSegment::Line { to } | ProfileSegment::Arc { to, .. } => to,
                ProfileSegment::Spline { .. } => [f64::NAN; 2],
            };
            segments(tool).iter().map(end).collect()
        };
        // A right-angled triangle with sides 3, 4, 5: flank − tip = 5, flank − radius = 4.
        let oval = Tool::oval(Oval {
            radius: 2.0,
            tip: 1.0,
            flank: 6.0,
            length: 20.0,
        })
        .expect("a cutter");
        let [touch, top, ..] = ends(&oval)[..] else {
            panic!("{oval:?}")
        };
        assert!(
            (touch[0] - 0.8).abs() < 1e-14 && (touch[1] - 0.4).abs() < 1e-14,
            "{touch:?}"
        );
        assert_eq!(top, [2.0, 4.0]);
        // The same triangle: bottom − corner = 5, radius − corner = 3.
        let lens = Tool::lens(Lens {
            radius: 4.0,
            bottom: 6.0,
            corner: 1.0,
            length: 20.0,
        })
        .expect("a cutter");
        let [touch, rim, ..] = ends(&lens)[..] else {
            panic!("{lens:?}")
        };
        assert!(
            (touch[0] - 3.6).abs() < 1e-14 && (touch[1] - 1.2).abs() < 1e-14,
            "{touch:?}"
        );
        assert_eq!(rim, [4.0, 2.0]);
        // A barrel's widest point is in the middle of its height.
        let barrel = Tool::barrel(Barrel {
            radius: 5.0,
            flank: 40.0,
            height: 20.0,
            corner: 1.0,
            length: 50.0,
        })
        .expect("a cutter");
        let plain = Tool::barrel(Barrel {
            radius: 5.0,
            flank: 40.0,
            height: 20.0,
            corner: 0.0,
            length: 50.0,
        })
        .expect("a cutter");
        assert_eq!(ends(&barrel)[2], ends(&plain)[1]);
    }

    #[test]
    fn what_fits_no_cutter_is_named() {
        let blame = |made: Result<Tool, ProfileError>| match made {
            Err(ProfileError::Measure { what, .. }) => what,
            other => panic!("{other:?}"),
        };
        assert_eq!(
            blame(Tool::oval(Oval {
                radius: 2.0,
                tip: 2.0,
                flank: 6.0,
                length: 20.0
            })),
            "tip"
        );
        assert_eq!(
            blame(Tool::oval(Oval {
                radius: 2.0,
                tip: 1.0,
                flank: 2.0,
                length: 20.0
            })),
            "flank"
        );
        assert_eq!(
            blame(Tool::oval(Oval {
                radius: 2.0,
                tip: 1.0,
                flank: 6.0,
                length: 4.0
            })),
            "length"
        );
        assert_eq!(
            blame(Tool::oval(Oval {
                radius: f64::NAN,
                tip: 1.0,
                flank: 6.0,
                length: 4.0
            })),
            "radius"
        );
        assert_eq!(
            blame(Tool::oval(Oval {
                radius: 2.0,
                tip: 1.0,
                flank: f64::INFINITY,
                length: 4.0
            })),
            "flank"
        );
        assert_eq!(
            blame(Tool::taper(Taper {
                radius: 2.0,
                tip: 1.0,
                flank: 6.0,
                angle: 90.0,
                length: 20.0
            })),
            "angle"
        );
        assert_eq!(
            blame(Tool::taper(Taper {
                radius: 2.0,
                tip: 1.0,
                flank: 6.0,
                angle: 75.0,
                length: 20.0
            })),
            "flank"
        );
        assert_eq!(
            blame(Tool::barrel(Barrel {
                radius: 5.0,
                flank: 40.0,
                height: 20.0,
                corner: 10.0,
                length: 50.0
            })),
            "corner"
        );
        assert_eq!(
            blame(Tool::barrel(Barrel {
                radius: 5.0,
                flank: 9.0,
                height: 20.0,
                corner: 1.0,
                length: 50.0
            })),
            "flank"
        );
        assert_eq!(
            blame(Tool::lens(Lens {
                radius: 4.0,
                bottom: 6.0,
                corner: 4.0,
                length: 20.0
            })),
            "corner"
        );
        assert_eq!(
            blame(Tool::lens(Lens {
                radius: 4.0,
                bottom: 6.0,
                corner: 1.0,
                length: 2.0
            })),
            "length"
        );
    }
}
