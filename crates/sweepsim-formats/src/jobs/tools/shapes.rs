//! The shapes of tools.

use sweepsim_motion::{
    Apt, AptError, AptWarning, Barrel, Dovetail, Lens, Lollipop, Oval, Profile, ProfileError, ProfileSegment,
    SplineFault, Taper, Tool, Turn,
};

use crate::error::Problem;
use crate::jobs::place::{Fault, Step};
use crate::jobs::schema;

/// A tool, and warnings about it.
pub(crate) struct Made {
    pub tool: Tool,
    pub warnings: Vec<AptWarning>,
}

impl From<Tool> for Made {
    fn from(tool: Tool) -> Self {
        Self {
            tool,
            warnings: Vec::new(),
        }
    }
}

/// Builds tool `number`. Lengths are multiplied by `unit`.
pub(crate) fn tool(number: u32, raw: &schema::Tool, unit: f64) -> Result<Made, Fault> {
    let made = match *raw {
        schema::Tool::Ball { radius, length } => Tool::ball(radius * unit, length * unit),
        schema::Tool::Flat { radius, length } => Tool::flat(radius * unit, length * unit),
        schema::Tool::Bull { radius, corner, length } => Tool::bull(radius * unit, corner * unit, length * unit),
        schema::Tool::Apt { d, r, e, f, a, b, h } => {
            let [d, r, e, f, h] = [d, r, e, f, h].map(|length| length * unit);
            return Tool::apt(&Apt { d, r, e, f, a, b, h })
                .map(|(tool, warnings)| Made {
                    tool,
                    warnings: warnings.into_iter().map(|warning| in_units(warning, unit)).collect(),
                })
                .map_err(|error| {
                    let (problem, field) = match error {
                        AptError::Parameter { name, value, expected } => (
                            Problem::value(format!("`{name}` of the APT cutter"), value, expected),
                            Some(name),
                        ),
                        AptError::Misses { .. } => (Problem::syntax(error.to_string()), Some("r")),
                        _ => (Problem::syntax(error.to_string()), None),
                    };
                    Fault {
                        problem,
                        field: field.into_iter().map(Step::from).collect(),
                    }
                });
        }
        schema::Tool::Lollipop { radius, neck, length } => Tool::lollipop(Lollipop {
            radius: radius * unit,
            neck: neck * unit,
            length: length * unit,
        }),
        schema::Tool::Dovetail {
            radius,
            angle,
            height,
            neck,
            length,
        } => Tool::dovetail(Dovetail {
            radius: radius * unit,
            angle,
            height: height * unit,
            neck: neck * unit,
            length: length * unit,
        }),
        schema::Tool::Barrel {
            radius,
            flank,
            height,
            corner,
            length,
        } => {
            let [radius, flank, height, corner, length] = [radius, flank, height, corner, length].map(|c| c * unit);
            Tool::barrel(Barrel {
                radius,
                flank,
                height,
                corner,
                length,
            })
        }
        schema::Tool::Lens {
            radius,
            bottom,
            corner,
            length,
        } => {
            let [radius, bottom, corner, length] = [radius, bottom, corner, length].map(|c| c * unit);
            Tool::lens(Lens {
                radius,
                bottom,
                corner,
                length,
            })
        }
        schema::Tool::Oval {
            radius,
            tip,
            flank,
            length,
        } => Tool::oval(Oval {
            radius: radius * unit,
            tip: tip * unit,
            flank: flank * unit,
            length: length * unit,
        }),
        schema::Tool::Taper {
            radius,
            tip,
            flank,
            angle,
            length,
        } => Tool::taper(Taper {
            radius: radius * unit,
            tip: tip * unit,
            flank: flank * unit,
            angle,
            length: length * unit,
        }),
        schema::Tool::Profile { start, ref segments } => profile(start, segments, unit),
        schema::Tool::Surface(ref name) => {
            return Err(Fault {
                problem: Problem::syntax(format!("the surfaces of {name} are read from their file")),
                field: vec![],
            });
        }
    };
    made.map(Made::from).map_err(|error| {
        let field = match error {
            ProfileError::Measure { what, .. } => vec![what.into()],
            ProfileError::Open { which, .. } if which.contains("start") => vec!["start".into()],
            ProfileError::NotFinite { segment }
            | ProfileError::AcrossAxis { segment, .. }
            | ProfileError::NoLength { segment }
            | ProfileError::NoArc { segment, .. }
            | ProfileError::SelfCrossing { second: segment, .. } => vec!["segments".into(), Step::Item(segment)],
            ProfileError::Spline { segment, fault } => {
                let mut place = vec!["segments".into(), Step::Item(segment)];
                place.extend(in_spline(&fault));
                place
            }
            ProfileError::TooManySegments { .. } => vec!["segments".into()],
            ProfileError::Open { .. } | ProfileError::UpsideDown { .. } => last(raw),
            _ => vec![],
        };
        Fault {
            problem: Problem::Tool {
                number,
                source: unscaled(error, unit),
            },
            field,
        }
    })
}

/// The field of a spline that has a fault.
fn in_spline(fault: &SplineFault) -> Vec<Step> {
    match *fault {
        SplineFault::Degree { .. } => vec!["degree".into()],
        SplineFault::Points { .. } => vec!["points".into()],
        SplineFault::Start { .. } => vec!["points".into(), Step::Item(0)],
        SplineFault::Weights { .. } => vec!["weights".into()],
        SplineFault::Weight { index, .. } => vec!["weights".into(), Step::Item(index)],
        SplineFault::KnotCount { .. } | SplineFault::Knots(_) | SplineFault::Clamped | SplineFault::Jump { .. } => {
            vec!["knots".into()]
        }
        _ => vec![],
    }
}

/// The last segment of a profile.
fn last(raw: &schema::Tool) -> Vec<Step> {
    match raw {
        schema::Tool::Profile { segments, .. } if !segments.is_empty() => {
            vec!["segments".into(), Step::Item(segments.len() - 1)]
        }
        _ => vec![],
    }
}

/// A warning with its lengths in units of the job.
fn in_units(warning: AptWarning, unit: f64) -> AptWarning {
    match warning {
        AptWarning::NotTangent { line, distance } => AptWarning::NotTangent {
            line,
            distance: distance / unit,
        },
        other => other,
    }
}

/// An error with its lengths in units of the job.
fn unscaled(error: ProfileError, unit: f64) -> ProfileError {
    match error {
        ProfileError::Measure { what, value, expected } => ProfileError::Measure {
            what,
            value: if what == "angle" { value } else { value / unit },
            expected,
        },
        ProfileError::Spline { segment, fault } => ProfileError::Spline {
            segment,
            fault: match fault {
                SplineFault::Start { found, expected } => SplineFault::Start {
                    found: found.map(|c| c / unit),
                    expected: expected.map(|c| c / unit),
                },
                SplineFault::Stops { near } => SplineFault::Stops {
                    near: near.map(|c| c / unit),
                },
                other => other,
            },
        },
        other => other,
    }
}

fn profile(start: [f64; 2], segments: &[schema::Segment], unit: f64) -> Result<Tool, ProfileError> {
    let scaled = |point: [f64; 2]| point.map(|c| c * unit);
    let mut made = Vec::with_capacity(segments.len());
    for segment in segments {
        made.push(match *segment {
            schema::Segment::Line(to) => ProfileSegment::Line { to: scaled(to) },
            schema::Segment::Arc { to, centre, turn } => ProfileSegment::Arc {
                to: scaled(to),
                centre: scaled(centre),
                turn: match turn {
                    schema::Turn::Cw => Turn::Cw,
                    schema::Turn::Ccw => Turn::Ccw,
                },
            },
            schema::Segment::Spline {
                degree,
                ref points,
                ref knots,
                ref weights,
            } => ProfileSegment::Spline {
                degree,
                knots: knots.clone(),
                points: points.iter().copied().map(scaled).collect(),
                weights: weights.clone(),
            },
        });
    }
    Profile::new(scaled(start), made).map(Tool::from_profile)
}
