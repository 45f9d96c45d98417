//! Circle-segment cutters: a flank or bottom that is an arc of large radius, tangent to the neighbouring arcs and
//! lines.
//!
//! | form | outline, from the tip |
//! | --- | --- |
//! | oval | ball of radius `tip`, flank that is tangent to it and to the shank |
//! | taper | the same, but the flank still leans outwards by `angle` where it reaches the shank's radius |
//! | barrel | bottom, corner, flank that is widest in the middle, shank |
//! | lens | bottom that is an arc about a point of the axis, corner, shank |
//!
//! Two circles touch from inside if the distance of their centres is the difference of their radii; the point of
//! contact is on the line through both centres.

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

/// Where the circle about `small` of radius `radius` touches the one about `large` from inside.
fn touch(small: [f64; 2], radius: f64, large: [f64; 2]) -> [f64; 2] {
    let [dx, dy] = [small[0] - large[0], small[1] - large[1]];
    let scale = radius / dx.hypot(dy);
    [small[0] + dx * scale, small[1] + dy * scale]
}

fn made(segments: Vec<ProfileSegment>) -> Result<Tool, ProfileError> {
    Profile::new([0.0, 0.0], segments).map(Tool::from_profile)
}

impl Tool {
    /// An oval form cutter (tangential barrel): a ball, a flank that is tangent to it, and a shank that is tangent to
    /// the flank.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < tip < radius < flank` and `length` reaches above the flank.
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

    /// A taper form cutter (conical barrel): as [`oval`](Self::oval), but the flank still leans outwards where it
    /// reaches the shank.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < tip < radius < flank · cos(angle)`, `0 ≤ angle < 90`, and `length` reaches
    /// above the flank.
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

    /// A barrel cutter: a flat bottom, a flank that is an arc, widest in the middle of its height, and a shank above it
    /// with the radius of the flank's top. The rim between the bottom and the flank is sharp, or an arc that is tangent
    /// to both.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless all are positive (`corner` may be 0), the arc is less than half a circle and
    /// leaves a bottom, `corner` is below half the height and leaves a bottom, and `length` is above `height`.
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

    /// A lens cutter: a bottom that is part of a ball, and a shank. The rim between them is sharp, or an arc that is
    /// tangent to both.
    ///
    /// # Errors
    /// [`ProfileError::Measure`] unless `0 < radius < bottom`, `0 ≤ corner < radius`, and `length` reaches above the
    /// rim.
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
