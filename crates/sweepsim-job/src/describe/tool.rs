//! Tools in words.

use crate::base::words::{counted, measure};
use sweepsim_motion::{ProfileSegment, Tool, Turn};
use sweepsim_nc::{CutterKind, ToolDescription};

/// A tool's size and shape in a few words.
#[must_use]
pub fn tool_in_words(tool: &Tool) -> String {
    let Some(profile) = tool.profile() else {
        return format!(
            "{}, {}",
            counted(tool.patches().len() as u64, "patch"),
            counted(tool.edges().len() as u64, "sharp edge")
        );
    };
    let mut points = vec![profile.start()];
    let (mut arcs, mut splines) = (0, 0);
    for segment in profile.segments() {
        match segment {
            ProfileSegment::Line { to } => points.push(*to),
            &ProfileSegment::Arc { to, centre, turn } => {
                arcs += 1;
                // An arc may reach further out than its ends.
                let from = points[points.len() - 1];
                let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
                let outwards = match turn {
                    Turn::Ccw => from[1] <= centre[1] && to[1] >= centre[1],
                    Turn::Cw => from[1] >= centre[1] && to[1] <= centre[1],
                };
                if outwards {
                    points.push([centre[0] + radius, centre[1]]);
                }
                points.push(to);
            }
            ProfileSegment::Spline { points: own, .. } => {
                splines += 1;
                points.extend(own.last());
            }
            // Curves of any other kind are sampled as splines are.
            _ => splines += 1,
        }
    }
    // A spline may reach further out than its ends, but not as far as its control points: sample the patches.
    if splines > 0 {
        let places = tool
            .patches()
            .iter()
            .flat_map(|patch| (0..=64).map(|k| patch.point(0.0, f64::from(k) / 64.0)));
        points.extend(places.map(|[x, y, z]| [x.hypot(y), z]));
    }
    let radius = points.iter().map(|p| p[0]).fold(0.0, f64::max);
    let length = points.iter().map(|p| p[1]).fold(0.0, f64::max);
    let lines = profile.segments().len() - arcs - splines;
    let mut kinds = vec![counted(lines as u64, "line"), counted(arcs as u64, "arc")];
    if splines > 0 {
        kinds.push(counted(splines as u64, "spline"));
    }
    format!(
        "radius {}, length {} mm ({})",
        measure(radius),
        measure(length),
        kinds.join(", ")
    )
}

/// A tool as a library or a program describes it, and what is missing for a simulation.
pub(crate) fn described_tool(tool: &ToolDescription) -> String {
    let mut words = vec![tool.kind.as_ref().map_or("tool", CutterKind::name).to_owned()];
    let measures = [
        ("diameter", tool.diameter),
        ("corner", tool.corner_radius),
        ("flutes", tool.flute_length),
        ("shank", tool.shank_diameter),
        ("stick-out", tool.stick_out),
    ];
    for (name, value) in measures {
        if let Some(value) = value {
            words.push(format!("{name} {}", measure(value)));
        }
    }
    let angles = [("point", tool.point_angle), ("taper", tool.taper_angle)];
    for (name, value) in angles {
        if let Some(value) = value {
            words.push(format!("{name} {}°", measure(value)));
        }
    }
    if !tool.holder.is_empty() {
        words.push(format!("holder of {}", counted(tool.holder.len() as u64, "segment")));
    }
    if let Some(name) = &tool.name {
        words.push(format!("{name:?}"));
    }
    let mut text = words.join(", ");
    if let Err(problem) = tool.build() {
        text.push_str(&format!(" — {problem}"));
    }
    text
}
