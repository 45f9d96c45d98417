//! Findings in sentences.

use super::words::{capital, measure, setup_name};
use sweepsim_formats::{Report, ReportedFinding};

/// What happens, in a few words: `Rapid move through material`.
#[must_use]
pub fn title(finding: &ReportedFinding) -> String {
    let part = finding.body.as_deref().unwrap_or("cutter");
    let part = capital(part);
    match finding.kind.as_str() {
        "machine" if finding.near => "Bodies of the machine too near to each other".to_owned(),
        "machine" => "Collision of the machine".to_owned(),
        "fixture" if finding.near => format!("{part} too near to a fixture"),
        _ if finding.near => format!("{part} too near to the workpiece"),
        "collision" => format!("{part} hits the workpiece"),
        "fixture" => format!("{part} hits a fixture"),
        "rapid" => "Rapid move through material".to_owned(),
        "gouge" => "Cuts into the part".to_owned(),
        "excess" => "Material left on the part".to_owned(),
        "spindle" => "Cuts with the spindle stopped".to_owned(),
        "feed" => "Cuts without a feed".to_owned(),
        "limit" => "Beyond the machine's limits".to_owned(),
        kind => kind.to_owned(),
    }
}

/// By what, how deep, where and when it happens.
#[must_use]
pub fn harm(finding: &ReportedFinding, report: &Report) -> String {
    let mut text = String::new();
    if let Some(name) = setup_name(report, finding.setup) {
        text += &format!("set-up {name}, ");
    }
    if let Some(tool) = finding.tool {
        let part = finding.body.as_deref().unwrap_or("cutter");
        text += &match &finding.detail {
            Some(_) => format!("tool {tool}, "),
            None => format!("{part} of tool {tool}, "),
        };
    }
    let [x, y, z] = finding.place.map(|c| format!("{c:.3}"));
    match &finding.detail {
        Some(detail) => text += &format!("{detail}, with the tip at ({x}, {y}, {z})"),
        None if finding.near => text += &format!("too near at ({x}, {y}, {z})"),
        None => {
            let way = if finding.kind == "excess" { "high" } else { "deep" };
            text += &format!("{} mm {way} at ({x}, {y}, {z})", measure(finding.depth));
        }
    }
    if let Some(face) = &finding.face {
        text += &format!(" on face {face}");
    }
    text += match finding.courses.as_deref() {
        Some("straight") => ", if the rapid is straight",
        Some("dog-leg") => ", if the rapid is a dog-leg",
        _ => "",
    };
    if finding.between {
        text += ", seen between the lines";
    }
    if let Some(time) = finding.time {
        // Between the lines, it may have begun before.
        let when = if finding.between { "at" } else { "from" };
        text += &format!(", {when} {:.1} % of the move", 100.0 * time);
    }
    text
}
