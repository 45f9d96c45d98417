//! Tools as entries of a job.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use sweepsim_motion::{BodyKind, ProfileSegment, Turn};

use super::build::{Cutter, ToolProblem};
use crate::model::tool::ToolDescription;
use crate::text::numbers::shortest;

/// A number as RON reads it back.
fn number(value: f64) -> String {
    let text = shortest(value);
    if text.contains(['.', 'e', 'n', 'i']) {
        text
    } else {
        text + ".0"
    }
}

fn pair([a, b]: [f64; 2]) -> String {
    format!("({}, {})", number(a), number(b))
}

/// A constructor with named fields.
fn fields(name: &str, fields: &[(&str, f64)]) -> String {
    let fields: Vec<String> = fields
        .iter()
        .map(|&(name, value)| format!("{name}: {}", number(value)))
        .collect();
    format!("{name}({})", fields.join(", "))
}

fn profile(start: [f64; 2], segments: &[String]) -> String {
    format!("Profile(start: {}, segments: [{}])", pair(start), segments.join(", "))
}

impl ToolDescription {
    /// The cutter as a tool of a job, in millimetres.
    ///
    /// # Errors
    /// [`ToolProblem`], as [`build`](Self::build).
    pub fn cutter_ron(&self) -> Result<String, ToolProblem> {
        // What cannot be built must not be written.
        self.build()?;
        Ok(match self.cutter()? {
            Cutter::Flat { radius, length } => fields("Flat", &[("radius", radius), ("length", length)]),
            Cutter::Ball { radius, length } => fields("Ball", &[("radius", radius), ("length", length)]),
            Cutter::Bull { radius, corner, length } => {
                fields("Bull", &[("radius", radius), ("corner", corner), ("length", length)])
            }
            Cutter::Lollipop(m) => fields(
                "Lollipop",
                &[("radius", m.radius), ("neck", m.neck), ("length", m.length)],
            ),
            Cutter::Dovetail(m) => fields(
                "Dovetail",
                &[
                    ("radius", m.radius),
                    ("angle", m.angle),
                    ("height", m.height),
                    ("neck", m.neck),
                    ("length", m.length),
                ],
            ),
            Cutter::Apt(m) => fields(
                "Apt",
                &[
                    ("d", m.d),
                    ("r", m.r),
                    ("e", m.e),
                    ("f", m.f),
                    ("a", m.a),
                    ("b", m.b),
                    ("h", m.h),
                ],
            ),
            Cutter::Profile { start, segments } => {
                let segments: Vec<String> = segments
                    .iter()
                    .filter_map(|segment| match segment {
                        ProfileSegment::Line { to } => Some(format!("Line({})", pair(*to))),
                        ProfileSegment::Arc { to, centre, turn } => Some(format!(
                            "Arc(to: {}, centre: {}, turn: {})",
                            pair(*to),
                            pair(*centre),
                            if *turn == Turn::Cw { "Cw" } else { "Ccw" }
                        )),
                        // No cutter here has any other segment.
                        _ => None,
                    })
                    .collect();
                profile(start, &segments)
            }
        })
    }

    /// Shank and holder as bodies of a job, in millimetres; empty if none is described.
    ///
    /// # Errors
    /// [`ToolProblem`], as [`build`](Self::build).
    pub fn bodies_ron(&self) -> Result<Vec<String>, ToolProblem> {
        self.build()?;
        let outlines = self.outlines()?;
        let body = |outline: &super::bodies::Outline| {
            let segments: Vec<String> = outline.to.iter().map(|to| format!("Line({})", pair(*to))).collect();
            let kind = if outline.kind == BodyKind::Shank {
                "Shank"
            } else {
                "Holder"
            };
            format!("{kind}({})", profile(outline.start, &segments))
        };
        Ok(outlines.iter().map(body).collect())
    }
}

/// The fields `tools:` and `bodies:` of a job, in millimetres, and the tools that could not be written with the reason.
#[must_use]
pub fn to_ron(tools: &BTreeMap<u32, ToolDescription>) -> (String, Vec<(u32, ToolProblem)>) {
    let (mut text, mut bodies, mut problems) = (String::from("tools: {\n"), String::new(), Vec::new());
    for (&number, tool) in tools {
        let written = tool.cutter_ron().and_then(|cutter| Ok((cutter, tool.bodies_ron()?)));
        match written {
            Ok((cutter, solids)) => {
                let name = tool.name.as_deref().map(one_line).unwrap_or_default();
                let comment = if name.is_empty() {
                    name
                } else {
                    format!("    // {name}")
                };
                let _ = writeln!(text, "    {number}: {cutter},{comment}");
                if !solids.is_empty() {
                    let _ = writeln!(bodies, "    {number}: [{}],", solids.join(", "));
                }
            }
            Err(problem) => problems.push((number, problem)),
        }
    }
    text.push_str("},\n");
    if !bodies.is_empty() {
        let _ = write!(text, "bodies: {{\n{bodies}}},\n");
    }
    (text, problems)
}

/// A text that fits into a comment.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect::<String>()
        .trim()
        .to_owned()
}
