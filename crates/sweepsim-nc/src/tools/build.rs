//! From a tool's description to its solids.

use sweepsim_motion::{Apt, AptError, Body, Dovetail, Lollipop, Profile, ProfileError, ProfileSegment, Tool, Turn};
use thiserror::Error;

use crate::model::tool::{CutterKind, ToolDescription};

/// The solids of a tool.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BuiltTool {
    /// The part that cuts.
    pub cutter: Tool,
    /// Shank and holder, as far as they are described.
    pub bodies: Vec<Body>,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// Why a description is not enough for a solid.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ToolProblem {
    /// A measure is missing.
    #[error("the {0} is missing")]
    Missing(&'static str),
    /// The kind of the tool is not supported.
    #[error("the shape of this tool, {0:?}, is not supported: describe it in a job with `Profile`")]
    Kind(String),
    /// A measure is out of range.
    #[error("the {what} is {value}, but must be {expected}")]
    Measure {
        /// Its name.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// The outline is invalid.
    #[error("{0}")]
    Profile(#[from] ProfileError),
    /// The seven parameters are invalid.
    #[error("{0}")]
    Apt(#[from] AptError),
}

/// A cutter with all its measures, in the shapes that jobs have.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cutter {
    Flat {
        radius: f64,
        length: f64,
    },
    Ball {
        radius: f64,
        length: f64,
    },
    Bull {
        radius: f64,
        corner: f64,
        length: f64,
    },
    Lollipop(Lollipop),
    Dovetail(Dovetail),
    Apt(Apt),
    Profile {
        start: [f64; 2],
        segments: Vec<ProfileSegment>,
    },
}

/// The kind whose solid is the envelope of a tool of another kind: threads and edges of taps and boring bars are within a cylinder, a probe ends in a ball.
fn envelope(name: &str) -> Option<CutterKind> {
    let lower = name.to_ascii_lowercase().replace(['-', '_'], " ");
    let has = |words: &[&str]| words.iter().any(|word| lower.contains(word));
    let taps = lower
        .split(|c: char| !c.is_ascii_alphabetic())
        .any(|word| word == "tap");
    match () {
        () if has(&["probe"]) => Some(CutterKind::Ball),
        () if taps || has(&["thread mill", "threadmill", "boring", "reamer"]) => Some(CutterKind::Flat),
        () => None,
    }
}

fn needed(what: &'static str, value: Option<f64>) -> Result<f64, ToolProblem> {
    match value {
        None => Err(ToolProblem::Missing(what)),
        Some(value) => positive(what, value),
    }
}

fn positive(what: &'static str, value: f64) -> Result<f64, ToolProblem> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        let expected = "a positive number";
        Err(ToolProblem::Measure { what, value, expected })
    }
}

fn angle(what: &'static str, value: Option<f64>) -> Result<f64, ToolProblem> {
    match value {
        None => Err(ToolProblem::Missing(what)),
        Some(value) if value > 0.0 && value < 90.0 => Ok(value),
        Some(value) => Err(ToolProblem::Measure {
            what,
            value,
            expected: "between 0 and 90 degrees",
        }),
    }
}

fn line(to: [f64; 2]) -> ProfileSegment {
    ProfileSegment::Line { to }
}

impl ToolDescription {
    /// The cutter, its shank and its holder as solids, in millimetres, with the tip at the origin and the axis along +z.
    ///
    /// # Errors
    /// [`ToolProblem`]: what is missing, by name, and measures that make no solid.
    pub fn build(&self) -> Result<BuiltTool, ToolProblem> {
        let mut notes = self.notes.clone();
        if let Some(CutterKind::Other(name)) = &self.kind {
            notes.push(format!("a {name}: the solid is its envelope"));
        }
        let cutter = match self.cutter()? {
            Cutter::Flat { radius, length } => Tool::flat(radius, length)?,
            Cutter::Ball { radius, length } => Tool::ball(radius, length)?,
            Cutter::Bull { radius, corner, length } => Tool::bull(radius, corner, length)?,
            Cutter::Lollipop(measures) => Tool::lollipop(measures)?,
            Cutter::Dovetail(measures) => Tool::dovetail(measures)?,
            Cutter::Apt(apt) => {
                let (tool, warnings) = Tool::apt(&apt)?;
                notes.extend(warnings.iter().map(ToString::to_string));
                tool
            }
            Cutter::Profile { start, segments } => Tool::from_profile(Profile::new(start, segments)?),
        };
        let bodies = self.outlines()?.into_iter().map(|outline| {
            let segments = outline.to.iter().copied().map(line).collect();
            Ok(Body {
                kind: outline.kind,
                solid: Tool::from_profile(Profile::new(outline.start, segments)?),
            })
        });
        let bodies = bodies.collect::<Result<_, ProfileError>>()?;
        Ok(BuiltTool { cutter, bodies, notes })
    }

    /// The seven parameters `d, r, e, f, a, b, h` of APT, if they can describe the cutter.
    #[must_use]
    pub fn seven_parameters(&self) -> Option<[f64; 7]> {
        match self.cutter().ok()? {
            Cutter::Flat { radius, length } => Some([2.0 * radius, 0.0, radius, 0.0, 0.0, 0.0, length]),
            Cutter::Ball { radius, length } => Some([2.0 * radius, radius, 0.0, radius, 0.0, 0.0, length]),
            Cutter::Bull { radius, corner, length } => {
                Some([2.0 * radius, corner, radius - corner, corner, 0.0, 0.0, length])
            }
            Cutter::Apt(Apt { d, r, e, f, a, b, h }) => Some([d, r, e, f, a, b, h]),
            Cutter::Lollipop(_) | Cutter::Dovetail(_) | Cutter::Profile { .. } => match self.kind {
                Some(CutterKind::Drill) if self.tip_diameter.unwrap_or(0.0) == 0.0 => {
                    let (radius, point) = (0.5 * self.diameter?, 90.0 - 0.5 * self.point_angle?);
                    let length = self.flute_length?;
                    Some([
                        2.0 * radius,
                        0.0,
                        radius,
                        radius * point.to_radians().tan(),
                        point,
                        0.0,
                        length,
                    ])
                }
                _ => None,
            },
        }
    }

    /// The cutter with all its measures.
    pub(crate) fn cutter(&self) -> Result<Cutter, ToolProblem> {
        let kind = self.kind.as_ref().ok_or(ToolProblem::Missing("shape"))?;
        let kind = match kind {
            CutterKind::Other(name) => &envelope(name).ok_or_else(|| ToolProblem::Kind(name.clone()))?,
            kind => kind,
        };
        if let CutterKind::Apt(apt) = kind {
            let mut apt = *apt;
            if let Some(length) = self.flute_length {
                apt.h = positive("flute length", length)?;
            }
            return Ok(Cutter::Apt(apt));
        }
        let diameter = needed("diameter", self.diameter)?;
        let radius = 0.5 * diameter;
        let length = || needed("flute length", self.flute_length);
        Ok(match kind {
            CutterKind::Flat => Cutter::Flat {
                radius,
                length: length()?,
            },
            CutterKind::Ball => Cutter::Ball {
                radius,
                length: length()?,
            },
            CutterKind::Bull => {
                let corner = needed("corner radius", self.corner_radius)?;
                let length = length()?;
                if corner >= radius * (1.0 - 1e-9) {
                    Cutter::Ball { radius, length }
                } else {
                    Cutter::Bull { radius, corner, length }
                }
            }
            CutterKind::Tapered => self.tapered(radius, length()?)?,
            CutterKind::Chamfer => {
                let taper = angle("taper angle", self.taper_angle)?;
                let tip = 0.5 * self.tip_diameter.unwrap_or(0.0);
                pointed(tip, radius, (radius - tip) / taper.to_radians().tan(), length()?)?
            }
            CutterKind::Drill => {
                let included = match self.point_angle {
                    None => return Err(ToolProblem::Missing("point angle")),
                    Some(value) if value > 0.0 && value <= 180.0 => value,
                    Some(value) => {
                        let expected = "between 0 and 180 degrees";
                        return Err(ToolProblem::Measure {
                            what: "point angle",
                            value,
                            expected,
                        });
                    }
                };
                let length = length()?;
                if included == 180.0 {
                    Cutter::Flat { radius, length }
                } else {
                    let tip = 0.5 * self.tip_diameter.unwrap_or(0.0);
                    pointed(
                        tip,
                        radius,
                        (radius - tip) / (0.5 * included).to_radians().tan(),
                        length,
                    )?
                }
            }
            CutterKind::Lollipop => Cutter::Lollipop(Lollipop {
                radius,
                neck: 0.5 * needed("neck diameter", self.neck_diameter.or(self.shoulder_diameter))?,
                length: length()?,
            }),
            CutterKind::Dovetail => Cutter::Dovetail(Dovetail {
                radius,
                // Libraries measure it from the axis.
                angle: 90.0 - angle("taper angle", self.taper_angle)?,
                height: length()?,
                neck: 0.5 * needed("neck diameter", self.neck_diameter.or(self.shoulder_diameter))?,
                length: needed("shoulder length", self.shoulder_length)?,
            }),
            CutterKind::Apt(_) | CutterKind::Other(_) => return Err(ToolProblem::Kind(kind.name().to_owned())),
        })
    }

    /// A cone with a flat, rounded or spherical end. `radius` is that of the tip, where the corner's circle and the flank's line would
    /// meet the bottom if it were sharp. A corner of the same radius is a ball on the axis.
    fn tapered(&self, radius: f64, length: f64) -> Result<Cutter, ToolProblem> {
        let taper = angle("taper angle", self.taper_angle)?;
        let corner = self.corner_radius.unwrap_or(0.0);
        if corner == 0.0 {
            let top = radius + length * taper.to_radians().tan();
            return Ok(Cutter::Profile {
                start: [0.0, 0.0],
                segments: vec![line([radius, 0.0]), line([top, length]), line([0.0, length])],
            });
        }
        // The corner touches the bottom and the flank: its centre is `corner` above the bottom and `corner` from the flank.
        let half = (0.5 * (90.0 - taper)).to_radians();
        // Numbers have few digits.
        let is_ball = (corner - radius).abs() <= 1e-3 * radius;
        let centre = [if is_ball { 0.0 } else { radius - corner * half.tan() }, corner];
        if centre[0] < -1e-9 * corner {
            let expected = "at most what fits between the axis and the flank";
            return Err(ToolProblem::Measure {
                what: "corner radius",
                value: corner,
                expected,
            });
        }
        let centre = [centre[0].max(0.0), corner];
        let (sin, cos) = taper.to_radians().sin_cos();
        let touch = [centre[0] + corner * cos, centre[1] - corner * sin];
        if touch[1] >= length {
            let expected = "greater than the height of the corner";
            return Err(ToolProblem::Measure {
                what: "flute length",
                value: length,
                expected,
            });
        }
        let top = touch[0] + (length - touch[1]) * sin / cos;
        let arc = ProfileSegment::Arc {
            to: touch,
            centre,
            turn: Turn::Ccw,
        };
        let mut segments = Vec::new();
        if centre[0] > 0.0 {
            segments.push(line([centre[0], 0.0]));
        }
        segments.extend([arc, line([top, length]), line([0.0, length])]);
        Ok(Cutter::Profile {
            start: [0.0, 0.0],
            segments,
        })
    }
}

/// A cone from `tip` to `radius` over `height`, with a cylinder above it up to `length`.
fn pointed(tip: f64, radius: f64, height: f64, length: f64) -> Result<Cutter, ToolProblem> {
    if !(tip >= 0.0 && tip < radius) {
        return Err(ToolProblem::Measure {
            what: "tip diameter",
            value: 2.0 * tip,
            expected: "0 or greater, and less than the diameter",
        });
    }
    let mut segments = Vec::new();
    if tip > 0.0 {
        segments.push(line([tip, 0.0]));
    }
    if height < length * (1.0 - 1e-9) {
        segments.extend([line([radius, height]), line([radius, length])]);
        segments.push(line([0.0, length]));
    } else {
        // The flutes end within the cone.
        let part = (length / height).min(1.0);
        let reached = if part > 1.0 - 1e-9 {
            radius
        } else {
            tip + (radius - tip) * part
        };
        segments.extend([line([reached, length]), line([0.0, length])]);
    }
    Ok(Cutter::Profile {
        start: [0.0, 0.0],
        segments,
    })
}
